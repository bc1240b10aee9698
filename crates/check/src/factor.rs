//! A factor at a cut of a loop: what a requirement on a margin asks the loop to bear.

use super::clock::Clock;
use super::complex::{short, square};
use super::moving::Moving;
use super::multivariate::{Fraction, Multi};
use super::number::{Q, Z};
use super::over_symbols::primitive;
use std::ops::Range;

/// Where a factor is put in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// Wherever a signal is used in an input of a block.
    Signal(String),
    /// At the only input of a block.
    Input(String),
    /// Wherever a parameter stands.
    Parameter(String),
    /// At the variable of the characteristic polynomial: the requirement is one on its roots.
    Variable,
}

/// The factors, by one or two names of their own: the last is `t`, or the factor itself. With `d = r (1 + j t)/(1 - j t)`:
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// `k`.
    Gain,
    /// `(1 - j t)/(1 + j t)`.
    Turn,
    /// `1/(1 - m d)`.
    Modulus(Q),
    /// `(1 + a d/2)/(1 - a d/2)`.
    Disk(Q),
    /// `1 + d/M`.
    Complementary(Q),
    /// `exp(-T s)`, a dead time `T`.
    Delay,
    /// `1 + j t`: of the variable, for roots in a sector.
    Sector,
    /// `r`: of the variable, for roots in a disc.
    Disc,
}

/// A factor in a model.
#[derive(Clone, Debug)]
pub(super) struct PutIn {
    pub cut: Cut,
    pub value: Fraction,
    /// The variables that are its own names.
    pub names: Range<usize>,
    is_complex: bool,
    is_delay: bool,
}

impl PutIn {
    /// Its own names are the variables from `first` on.
    pub fn new(of: &Factor, first: usize, unit: usize, clock: &Clock) -> Result<Self, String> {
        let [numerator, scalar] = of.family.quotient(first, unit, clock)?;
        // Of a dead time it is the time, until exponentials are read.
        let value = Fraction::over(numerator, scalar);
        let names = first..first + of.family.names();
        let is_delay = of.family == Family::Delay;
        Ok(PutIn { cut: of.cut.clone(), value, names, is_complex: of.family.is_complex(), is_delay })
    }

    /// With the exponential of a dead time in its place.
    pub fn with_dead_time(self, moving: Option<&mut Moving>) -> Result<Self, String> {
        if !self.is_delay {
            return Ok(self);
        }
        let moving = moving.ok_or("a dead time at a cut is read with functions alone")?;
        Ok(PutIn { value: moving.delayed(self.value)?, ..self })
    }

    /// Whether it is complex, and occurs.
    pub fn is_in(&self, f: &Fraction) -> bool {
        let occurs = |m: &Multi| self.names.clone().any(|name| m.degree(name) > 0);
        self.is_complex && [&f.numerator, &f.denominator, &f.scalar].into_iter().any(occurs)
    }
}

/// A family of factors at a cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Factor {
    pub cut: Cut,
    pub family: Family,
}

impl Factor {
    /// Whether the loop has to be linear in the parameter that is cut: everywhere but where another number stands for it.
    pub fn needs_linear_parameter(&self) -> bool {
        self.family != Family::Gain && matches!(self.cut, Cut::Parameter(_))
    }

    /// `D(f x)` for a polynomial `D(x)`, if the cut is at the variable.
    pub fn of_variable(&self, d: Vec<Multi>, first: usize, unit: usize, clock: &Clock) -> Result<Vec<Multi>, String> {
        if self.cut != Cut::Variable {
            return Ok(d);
        }
        let [factor, _] = self.family.quotient(first, unit, clock)?;
        let mut power = Multi::one();
        let mut out = Vec::with_capacity(d.len());
        for c in d {
            let c = c.times(&power, clock)?;
            out.push(if self.family.is_complex() { short(&c, unit, clock)? } else { c });
            power = power.times(&factor, clock)?;
            power = if self.family.is_complex() { short(&power, unit, clock)? } else { power };
        }
        Ok(out)
    }
}

impl Family {
    /// The number of its own names.
    pub fn names(&self) -> usize {
        match self {
            Family::Gain | Family::Turn | Family::Delay | Family::Sector | Family::Disc => 1,
            Family::Modulus(_) | Family::Disk(_) | Family::Complementary(_) => 2,
        }
    }

    pub fn is_complex(&self) -> bool {
        !matches!(self, Family::Gain | Family::Delay | Family::Disc)
    }

    /// Numerator and denominator, polynomials in the own names, which are the variables from `first` on, and the imaginary unit. The denominator is
    /// nowhere zero for real names, between -1 and 1 where there are two.
    fn quotient(&self, first: usize, unit: usize, clock: &Clock) -> Result<[Multi; 2], String> {
        let [one, last] = [Multi::one(), Multi::variable(first + self.names() - 1)];
        if !self.is_complex() {
            return Ok([last, one]);
        }
        let turned = last.times(&Multi::variable(unit), clock)?;
        let [plus, minus] = [one.plus(&turned), one.minus(&turned)];
        // With d = p/q: q plus and minus a share n/m of p, times m.
        let shares = |share: &Q| -> Result<[Multi; 3], String> {
            let d = plus.times(&Multi::variable(first), clock)?.scaled(share.numer());
            let whole = minus.scaled(share.denom());
            Ok([whole.plus(&d), whole.minus(&d), whole])
        };
        Ok(match self {
            Family::Gain | Family::Delay | Family::Disc | Family::Turn => [minus, plus],
            Family::Sector => [plus, one],
            Family::Modulus(m) => {
                let [_, below, whole] = shares(m)?;
                [whole, below]
            }
            Family::Disk(a) => {
                let [top, below, _] = shares(&(a / Q::from(Z::from(2))))?;
                [top, below]
            }
            Family::Complementary(most) => {
                let [top, _, whole] = shares(&most.recip())?;
                [top, whole]
            }
        })
    }

    /// Polynomials in the own names that are positive wherever the factors are asked about.
    pub fn positive(&self, first: usize, clock: &Clock) -> Result<Vec<Multi>, String> {
        if !self.is_complex() {
            return Ok(Vec::new());
        }
        let unit = first + self.names();
        let [top, below] = self.quotient(first, unit, clock)?;
        let may_vanish = matches!(self, Family::Complementary(_));
        let all = if may_vanish { vec![below] } else { vec![below, top] };
        let mut squares = Vec::with_capacity(all.len());
        for m in all {
            squares.extend(primitive(vec![square(&m, unit, clock)?], clock)?);
        }
        squares.retain(|p| !p.is_constant());
        squares.dedup();
        Ok(squares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_traits::ToPrimitive;
    use std::time::Duration;

    /// At values of the own names.
    fn at(m: &Multi, names: &[f64]) -> [f64; 2] {
        let unit = names.len();
        m.0.iter().fold([0.0, 0.0], |[x, y], (e, c)| {
            let power = |v: usize| e.get(v).copied().unwrap_or(0);
            let size = names.iter().enumerate().fold(c.to_f64().unwrap(), |all, (v, x)| all * x.powi(power(v) as i32));
            match power(unit) % 4 {
                0 => [x + size, y],
                1 => [x, y + size],
                2 => [x - size, y],
                _ => [x, y - size],
            }
        })
    }

    #[test]
    fn factors_are_those_of_the_disc() {
        let clock = Clock::new(Duration::MAX);
        let q = |n: i64, d: i64| Q::new(n.into(), d.into());
        let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
        for family in [
            Family::Turn,
            Family::Modulus(q(3, 4)),
            Family::Disk(q(7, 4)),
            Family::Complementary(q(3, 2)),
            Family::Gain,
            Family::Delay,
            Family::Sector,
            Family::Disc,
        ] {
            let [top, below] = family.quotient(0, family.names(), &clock).unwrap();
            let positive = family.positive(0, &clock).unwrap();
            for k in 0..99_i32 {
                let (r, t) = (f64::from(k % 9) / 4.0 - 1.0, f64::from(k / 9) / 5.0 - 1.0);
                let names: Vec<f64> = if family.names() == 1 { vec![t] } else { vec![r, t] };
                let turn = [2.0 * t.atan()].map(|a| [a.cos(), a.sin()])[0];
                let d = turn.map(|x| x * r);
                let plus = |x: f64, share: f64| [x + share * d[0], share * d[1]];
                let [expected, over] = match family {
                    // Of a dead time it is the time.
                    Family::Gain | Family::Delay | Family::Disc => [[t, 0.0], [1.0, 0.0]],
                    Family::Sector => [[1.0, t], [1.0, 0.0]],
                    Family::Turn => [[turn[0], -turn[1]], [1.0, 0.0]],
                    Family::Modulus(_) => [[1.0, 0.0], plus(1.0, -0.75)],
                    Family::Disk(_) => [plus(1.0, 0.875), plus(1.0, -0.875)],
                    Family::Complementary(_) => [plus(1.0, 1.0 / 1.5), [1.0, 0.0]],
                };
                let (left, right) = (times(at(&top, &names), over), times(at(&below, &names), expected));
                assert!((left[0] - right[0]).abs() < 1e-9 && (left[1] - right[1]).abs() < 1e-9, "{family:?} {r} {t}");
                assert!(positive.iter().all(|p| at(p, &names)[0] > 1e-3), "{family:?} {r} {t}");
            }
        }
    }
}
