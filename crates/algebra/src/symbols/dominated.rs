//! That a function has no zero for all large values of a parameter which occurs by itself and inside of exponentials that die
//! away.
//!
//! From a value on, `T^J` times each exponential is bounded. With `T^-J` times that bound in its place a function is a sum of
//! powers of `T` whose coefficients are balls, the highest of them without exponentials.

use super::beyond::{BITS, decay, linear};
use super::{Definition, Function, MovingSymbols};
use crate::ball::{Ball, Enclosed, enclosed_resultant};
use crate::number::{Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};
use std::collections::BTreeMap;

/// Powers above this are not bounded.
const MOST_POWER: i64 = 200;

/// A sum of powers, by their exponents.
#[derive(Clone)]
struct Powers(BTreeMap<i64, Ball>);

impl Powers {
    fn power(exponent: i64, c: Ball) -> Powers {
        Powers(if c.is_zero() { BTreeMap::new() } else { BTreeMap::from([(exponent, c)]) })
    }

    fn add(&mut self, exponent: i64, c: &Ball) {
        let sum = self.0.get(&exponent).map_or_else(|| c.clone(), |before| before.add(c));
        if sum.is_zero() {
            self.0.remove(&exponent);
        } else {
            self.0.insert(exponent, sum);
        }
    }

    /// Whether the highest power outweighs all others from `start`, at least 1, on.
    fn is_dominated(&self, start: &Ball) -> bool {
        let mut descending = self.0.iter().rev();
        let Some((&highest, leading)) = descending.next() else { return false };
        let mut rest = Integer::ZERO;
        for (&exponent, c) in descending {
            let Some(part) = magnitude(c).div(&start.power(highest.abs_diff(exponent))) else { return false };
            rest += part.magnitude_units();
        }
        leading.least_magnitude_units() > rest
    }
}

fn magnitude(c: &Ball) -> Ball {
    let units = c.magnitude_units();
    Ball::from_units(units.clone(), units, BITS)
}

impl Enclosed for Powers {
    fn nothing(&self) -> Powers {
        Powers(BTreeMap::new())
    }
    fn plus(&self, other: &Powers) -> Powers {
        let mut out = self.clone();
        other.0.iter().for_each(|(k, c)| out.add(*k, c));
        out
    }
    fn minus(&self, other: &Powers) -> Powers {
        let mut out = self.clone();
        other.0.iter().for_each(|(k, c)| out.add(*k, &c.neg()));
        out
    }
    fn times(&self, other: &Powers) -> Powers {
        let mut out = self.nothing();
        for (j, x) in &self.0 {
            for (k, y) in &other.0 {
                out.add(j + k, &x.mul(y));
            }
        }
        out
    }
    fn over(&self, _other: &Powers) -> Option<Powers> {
        None
    }
    fn is_nothing(&self) -> bool {
        self.0.is_empty()
    }
    fn least(&self) -> Integer {
        // Quotients are not sums of powers.
        Integer::ZERO
    }
}

impl MovingSymbols {
    /// Whether it is shown that a function has no zero from a value of the parameter, at least 1, on.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
    /// use jurist_algebra::symbols::{Definition, MovingSymbols};
    /// let minus = -&RationalFunction::variable(0);
    /// let symbols = MovingSymbols::new(vec![("X".into(), Definition::Exponential(minus))]);
    /// let [t, x] = [0, 1].map(MultiPoly::variable);
    /// // T - 100 T^2 exp(-T): zeros at about 0.01 and 6.5
    /// let f = t.minus(&t.times(&t).times(&x).scaled_by(&100.into())).into();
    /// assert!(!symbols.has_no_zero_beyond(&f, &Rational::from(2)));
    /// assert!(symbols.has_no_zero_beyond(&f, &Rational::from(64)));
    /// ```
    ///
    /// Cost: exponentials of small matrices, and a determinant over sums of powers.
    pub fn has_no_zero_beyond(&self, f: &Function, start: &Rational) -> bool {
        if *start < Rational::ONE {
            return false;
        }
        let degree = |list: &[MultiPoly]| list.iter().map(|p| i64::from(p.degree_in(0))).max().unwrap_or(0);
        let highest = match f {
            Function::Polynomial(p) => i64::from(p.degree_in(0)),
            Function::Resultant { a, b } => (b.len() as i64 - 1) * degree(a) + (a.len() as i64 - 1) * degree(b),
        };
        if highest > MOST_POWER {
            return false;
        }
        let values: Option<Vec<Powers>> = self.table().iter().map(|(_, d)| bound(d, highest, start)).collect();
        let Some(values) = values else { return false };
        let at = |p: &MultiPoly| {
            let mut sum = Powers(BTreeMap::new());
            for (monomial, c) in p.terms() {
                let mut term = Powers::power(i64::from(monomial.exponent(0)), Ball::from_integer(c, BITS));
                for (i, value) in values.iter().enumerate() {
                    for _ in 0..monomial.exponent(i + 1) {
                        term = term.times(value);
                    }
                }
                sum = sum.plus(&term);
            }
            sum
        };
        let value = match f {
            Function::Polynomial(p) => at(p),
            Function::Resultant { a, b } => {
                let at = |list: &[MultiPoly]| list.iter().map(at).collect::<Vec<Powers>>();
                enclosed_resultant(&at(a), &at(b))
            }
        };
        value.is_dominated(&Ball::from_rational(start, BITS))
    }
}

/// What a symbol is from `start` on: a number, or `T^-power` times a bound.
fn bound(definition: &Definition, power: i64, start: &Rational) -> Option<Powers> {
    let symmetric = |b: Ball| Powers::power(-power, b.neg().union(&b));
    match definition {
        Definition::Exponential(x) => {
            let (slope, constant) = linear(x)?;
            let exponential = |t: &Rational| crate::ball::exp(&Ball::from_rational(&(&(&slope * t) + &constant), BITS));
            if slope.is_zero() {
                return Some(Powers::power(0, exponential(start)));
            }
            // T^power exp(slope T) falls from here on.
            if !slope.is_negative() || (-&slope * start) < Rational::from(power) {
                return None;
            }
            let at_start = Ball::from_rational(start, BITS).power(power.unsigned_abs());
            Some(symmetric(magnitude(&exponential(start).mul(&at_start))))
        }
        Definition::Fundamental { polynomial, time, .. } => {
            let (slope, constant) = linear(time)?;
            if slope.sign().is_le() || constant.is_negative() {
                return None;
            }
            let n = polynomial.len() - 1;
            let c: Vec<Rational> = polynomial[..n].iter().map(RationalFunction::as_constant).collect::<Option<_>>()?;
            let time = &(&slope * start) + &constant;
            let (q, within) = decay(&c, &time)?;
            // From j to j + 1 times that time, T^power is at most ((j + 1) time/slope)^power, and q^j of it falls.
            let falls = Ball::from_rational(&Rational::new(Integer::from(2), Integer::from(3)), BITS);
            if q.upper() >= falls.power(power.unsigned_abs()).lower() || q.upper() >= Rational::dyadic(&Integer::ONE, 1)
            {
                return None;
            }
            let twice = &(&time + &time) / &slope;
            let most = Ball::from_rational(&twice, BITS).power(power.unsigned_abs());
            Some(symmetric(magnitude(&most.mul(&q).mul(&within))))
        }
        Definition::Root(x) => {
            let root = Ball::from_rational(&x.as_constant()?, BITS).sqrt()?;
            Some(Powers::power(0, root))
        }
        Definition::Algebraic(x) => Some(Powers::power(0, Definition::enclosed(x, BITS))),
        Definition::Enclosed(x) => Some(Powers::power(0, x.at(BITS))),
        Definition::Pi | Definition::Tangent { .. } | Definition::Duty(_) | Definition::Family(_) => None,
    }
}
