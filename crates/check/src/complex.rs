//! Complex coefficients: the imaginary unit is one more variable, whose square is -1. A loop in which it is left becomes a real one of twice the size.

use super::blocks::Ordered;
use super::characteristic::Form;
use super::clock::Clock;
use super::coefficient::Ring;
use super::expression::Scope;
use super::moving::Function;
use super::multivariate::{Fraction, Multi};
use super::number::{Q, Z};
use super::same_characteristic;
use super::univariate::Uni;
use num_traits::{One, Zero};
use std::collections::BTreeSet;

/// The real and the imaginary part of a polynomial, in which a variable of this number is the imaginary unit.
pub(super) fn parts(m: &Multi, unit: usize) -> [Multi; 2] {
    let mut out = [Multi::default(), Multi::default()];
    for (e, c) in &m.0 {
        let k = e.get(unit).copied().unwrap_or(0);
        let mut e = e.clone();
        if k > 0 {
            e[unit] = 0;
        }
        out[k as usize % 2].add(e, if k % 4 < 2 { c.clone() } else { -c });
    }
    out
}

pub(super) fn has_unit(m: &Multi, unit: usize) -> bool {
    m.degree(unit) > 0
}

fn joined([x, y]: [Multi; 2], unit: usize, clock: &Clock) -> Result<Multi, String> {
    Ok(if y.is_zero() { x } else { x.plus(&y.times(&Multi::variable(unit), clock)?) })
}

/// Without powers of the unit.
pub(super) fn short(m: &Multi, unit: usize, clock: &Clock) -> Result<Multi, String> {
    if m.degree(unit) < 2 { Ok(m.clone()) } else { joined(parts(m, unit), unit, clock) }
}

fn conjugated(m: &Multi, unit: usize, clock: &Clock) -> Result<Multi, String> {
    let [x, y] = parts(m, unit);
    joined([x, y.scaled(&-Z::one())], unit, clock)
}

/// `x^2 + y^2`.
pub(super) fn square(m: &Multi, unit: usize, clock: &Clock) -> Result<Multi, String> {
    let [x, y] = parts(m, unit);
    Ok(x.times(&x, clock)?.plus(&y.times(&y, clock)?))
}

impl Fraction {
    fn each(&self, of: impl Fn(&Multi) -> Result<Multi, String>) -> Result<Fraction, String> {
        Ok(Fraction { numerator: of(&self.numerator)?, denominator: of(&self.denominator)?, scalar: of(&self.scalar)? })
    }

    /// Whether no imaginary unit is in it.
    pub fn is_real(&self, unit: usize) -> bool {
        ![&self.numerator, &self.denominator, &self.scalar].into_iter().any(|m| has_unit(m, unit))
    }

    /// With `j^2 = -1`.
    pub fn with_unit(self, unit: usize, clock: &Clock) -> Result<Fraction, String> {
        let most = [&self.numerator, &self.denominator, &self.scalar].into_iter().map(|m| m.degree(unit)).max();
        if most < Some(2) { Ok(self) } else { self.each(|m| short(m, unit, clock)) }
    }

    pub fn conjugate(&self, unit: usize, clock: &Clock) -> Result<Fraction, String> {
        self.each(|m| conjugated(m, unit, clock))
    }

    /// The real and the imaginary part of what has no loop's variable in a divisor.
    pub fn parts(&self, unit: usize, clock: &Clock) -> Result<[Fraction; 2], String> {
        if self.is_real(unit) {
            return Ok([self.clone(), Multi::default().into()]);
        }
        let below = self.whole_denominator(clock)?;
        let top = self.numerator.times(&conjugated(&below, unit, clock)?, clock)?;
        let below = square(&below, unit, clock)?;
        Ok(parts(&top, unit).map(|numerator| Fraction::over(numerator, below.clone())))
    }
}

impl Scope<'_> {
    /// With `j^2 = -1`.
    pub(super) fn short(&self, f: Fraction) -> Result<Fraction, String> {
        match self.unit {
            Some(unit) => f.with_unit(unit, self.clock),
            None => Ok(f),
        }
    }

    /// Refuses what has a complex factor: it is one of the loop and not of a part of it.
    pub(super) fn without_factor(&self, f: &Fraction) -> Result<(), String> {
        match &self.factor {
            Some(factor) if factor.is_in(f) => Err("the complex factor of a cut is inside of a function".into()),
            _ => Ok(()),
        }
    }

    /// Refuses what has an imaginary unit.
    pub(super) fn real(&self, f: Fraction) -> Result<Fraction, String> {
        self.without_factor(&f)?;
        match self.unit {
            Some(unit) if !f.is_real(unit) => Err("what has to be real is complex".into()),
            _ => Ok(f),
        }
    }

    /// `exp(j angle)`.
    pub(super) fn rotation(&mut self, angle: &Fraction) -> Result<Fraction, String> {
        let one = Fraction::number(&Q::one());
        if angle.numerator.is_zero() {
            return Ok(one);
        }
        let unit = self.unit.ok_or("'j' has another meaning here")?;
        let moving = self.moving.as_mut().ok_or("cosines and sines of a frame are read by enclosures alone")?;
        let [cosine, sine] = [Function::Cosine, Function::Sine].map(|f| moving.of(f, angle.clone()));
        cosine?.plus(&sine?.times(&Fraction::variable(unit), self.clock)?, self.clock)
    }

    /// `conj(f)`, `re(f)` or `im(f)`.
    pub(super) fn of_complex(&self, name: &str, f: &Fraction) -> Result<Fraction, String> {
        self.without_factor(f)?;
        if f.numerator.degree(0) > 0 || f.denominator.degree(0) > 0 {
            return Err("a function of the loop's variable".into());
        }
        let Some(unit) = self.unit else {
            return Ok(if name == "im" { Fraction::number(&Q::zero()) } else { f.clone() });
        };
        let [re, im] = f.parts(unit, self.clock)?;
        Ok(match name {
            "conj" => f.conjugate(unit, self.clock)?,
            "re" => re,
            _ => im,
        })
    }

    /// A function that is read as a variable; of a complex argument `exp` alone.
    pub(super) fn of_function(&mut self, function: Function, f: Fraction) -> Result<Fraction, String> {
        self.without_factor(&f)?;
        if let (Some(unit), Function::Exponential) = (self.unit, function)
            && !f.is_real(unit)
            && f.numerator.degree(0) == 0
            && f.denominator.degree(0) == 0
        {
            let [re, im] = f.parts(unit, self.clock)?;
            let turn = self.rotation(&im)?;
            if re.numerator.is_zero() {
                return Ok(turn);
            }
            return self.of_function(function, re)?.times(&turn, self.clock);
        }
        let f = self.real(f)?;
        self.moving.as_mut().ok_or("internal: no functions are read")?.of(function, f)
    }
}

/// The square of a polynomial by its coefficients, where a doubled polynomial may be one: has the given one not as many coefficients as the model's
/// it is to be its root. `None` where it is to be the polynomial itself.
pub(super) fn square_of_root<P: Ring>(
    given: &[P],
    own: &[P],
    is_doubled: bool,
    clock: &Clock,
) -> Result<Option<Vec<P>>, String> {
    let Some(first) = given.first().filter(|_| is_doubled && given.len() != own.len()) else { return Ok(None) };
    let mut square = vec![first.zero(); 2 * given.len() - 1];
    for (i, x) in given.iter().enumerate() {
        for (k, y) in given.iter().enumerate() {
            square[i + k].add(&x.times(y, clock)?);
        }
    }
    Ok(Some(square))
}

/// Which polynomial is meant: the model's own, or the root of a doubled one; the latter has the degree of the model's polynomial.
pub(super) fn meant(given: &[Uni], own: &[Uni], is_doubled: bool, clock: &Clock) -> Result<Meant, String> {
    let Some(square) = square_of_root(given, own, is_doubled, clock)? else {
        return same_characteristic(given, own).map(|()| if is_doubled { Meant::Doubled } else { Meant::Own });
    };
    let minus: Vec<Uni> = square.iter().map(|c| c.scaled(&-Z::one())).collect();
    if square == own || minus == own {
        Ok(Meant::Root)
    } else {
        Err("it is not that of the model, nor its root".into())
    }
}

/// See [`meant`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meant {
    Own,
    Doubled,
    Root,
}

/// Rows of `[[x, -y], [y, x]]` for each entry `x + j y`.
fn doubled_rows(rows: &[Vec<Multi>], unit: usize) -> Vec<Vec<Multi>> {
    let mut out = Vec::with_capacity(2 * rows.len());
    for row in rows {
        let (mut real, mut imaginary) = (Vec::with_capacity(2 * row.len()), Vec::with_capacity(2 * row.len()));
        for entry in row {
            let [x, y] = parts(entry, unit);
            real.extend([x.clone(), y.scaled(&-Z::one())]);
            imaginary.extend([y, x]);
        }
        out.extend([real, imaginary]);
    }
    out
}

pub(super) fn doubled_matrix(m: &[Vec<Fraction>], unit: usize, clock: &Clock) -> Result<Vec<Vec<Fraction>>, String> {
    let mut out = Vec::with_capacity(2 * m.len());
    for row in m {
        let (mut real, mut imaginary) = (Vec::with_capacity(2 * row.len()), Vec::with_capacity(2 * row.len()));
        for entry in row {
            let [x, y] = entry.parts(unit, clock)?;
            real.extend([x.clone(), y.clone().negated()]);
            imaginary.extend([y, x]);
        }
        out.extend([real, imaginary]);
    }
    Ok(out)
}

/// Zero where the given ones are, for real parameters.
pub(super) fn real_divisors(divisors: &BTreeSet<Multi>, unit: usize, clock: &Clock) -> Result<BTreeSet<Multi>, String> {
    divisors.iter().map(|m| real_divisor(m, unit, clock)).collect()
}

pub(super) fn real_divisor(m: &Multi, unit: usize, clock: &Clock) -> Result<Multi, String> {
    if has_unit(m, unit) { square(m, unit, clock) } else { Ok(m.clone()) }
}

/// The form and the divisors without the unit, and whether the form is doubled.
pub(super) fn doubled(
    form: Form,
    divisors: &BTreeSet<Multi>,
    unit: usize,
    clock: &Clock,
) -> Result<(Form, BTreeSet<Multi>, bool), String> {
    let divisors = real_divisors(divisors, unit, clock)?;
    let in_matrix = |m: &[Vec<Fraction>]| m.iter().flatten().any(|f| !f.is_real(unit));
    let in_rows = |(rows, _): &Ordered| rows.iter().flatten().any(|m| has_unit(m, unit));
    let is_complex = match &form {
        Form::Written(f) => !f.is_real(unit),
        Form::Matrix(m) => in_matrix(m),
        Form::Feedback(all) => all.iter().any(|m| in_matrix(m)),
        Form::System(whole, alone) => in_rows(whole) || alone.iter().any(in_rows),
    };
    if !is_complex {
        return Ok((form, divisors, false));
    }
    let ordered = |(rows, degree): &Ordered| (doubled_rows(rows, unit), 2 * degree);
    let form = match &form {
        Form::Written(f) => {
            let below = f.whole_denominator(clock)?;
            let [numerator, denominator] = [square(&f.numerator, unit, clock)?, square(&below, unit, clock)?];
            Form::Written(Fraction { numerator, denominator, scalar: Multi::one() })
        }
        Form::Matrix(m) => Form::Matrix(doubled_matrix(m, unit, clock)?),
        Form::Feedback([a, b, c, k]) => {
            let of = |m: &Vec<Vec<Fraction>>| doubled_matrix(m, unit, clock);
            Form::Feedback([of(a)?, of(b)?, of(c)?, of(k)?])
        }
        Form::System(whole, alone) => Form::System(ordered(whole), alone.iter().map(ordered).collect()),
    };
    Ok((form, divisors, true))
}
