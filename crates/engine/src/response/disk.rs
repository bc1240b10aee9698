//! The disk margin: gain and phase at once.

use super::extreme::extreme_over;
use super::ground::Ground;
use super::open_loop::OpenLoop;
use super::parts::{Parts, with_parts};
use super::value::square_root;
use super::{Extreme, Value};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::Domain;
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// The greatest `alpha` such that the loop is stable with every factor
/// `(1 + (1 - skew)/2 delta) / (1 - (1 + skew)/2 delta)`, `|delta| < alpha`, at the cut.
///
/// Its inverse is the greatest value of `|S + (skew - 1)/2|` over all frequencies, with the sensitivity `S = 1/(1 + L)`
/// ([SeilerPackardGahinet2020](jurist_algebra::bibliography#seilerpackardgahinet2020)).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DiskMargin {
    /// The skew; 0 is the balanced disk.
    pub skew: Rational,
    /// The margin; `None` where no factor of this form makes the loop unstable.
    pub alpha: Option<Real>,
    /// Where it binds: the extreme of the square of `alpha`.
    pub extreme: Option<Extreme>,
}

impl DiskMargin {
    /// Of a stable loop.
    pub(super) fn of(open_loop: &OpenLoop, skew: &Rational, budget: &Budget) -> Result<DiskMargin, Exhausted> {
        with_parts!(open_loop, parts => DiskMargin::over(parts, skew, budget))
    }

    fn over<G: Ground>(parts: &Parts<G>, skew: &Rational, budget: &Budget) -> Result<DiskMargin, Exhausted> {
        // alpha^2 = min 4 |D0 + N|^2 / |(1 + skew) D0 - (1 - skew) N|^2, both multiplied by the denominator of the skew.
        let r = &parts.reduced;
        let (p, q) = (skew.numerator(), skew.denominator());
        let number = |n: Integer| G::Number::from_integer(&n);
        let below = r.combined_squared(&(&q + &p), &(&p - &q));
        let skew = skew.clone();
        if below.is_zero() {
            return Ok(DiskMargin { skew, alpha: None, extreme: None });
        }
        let above = r.sum_squared.scaled(&number(Integer::from(4) * &(&q * &q)));
        let common = |a: &_, b: &_| r.common(a, b);
        let extreme = extreme_over(&parts.ground, [&above, &below], &common, r.frequencies, Ordering::Less, budget)?;
        let alpha = match extreme.value() {
            None => None,
            Some(value) => Some(square_root(&value.number(budget)?, budget)?),
        };
        Ok(DiskMargin { skew, alpha, extreme: Some(extreme) })
    }

    /// The real factors of the disk: the least, not below 0, and the greatest, `None` where there is none.
    pub fn gains(&self, bits: u64) -> (Enclosure, Option<Enclosure>) {
        let number = |value: Rational| Enclosure::from_rational(value);
        let Some(alpha) = &self.alpha else { return (number(Rational::ZERO), None) };
        let working = bits + 16;
        let size = Value::Number(alpha.clone()).enclosure(working);
        let two = number(Rational::from(2));
        let (less, more) = (number(Rational::ONE - &self.skew), number(Rational::ONE + &self.skew));
        let (less, more) = (size.mul(&less, working), size.mul(&more, working));
        let zero = || number(Rational::ZERO);
        let least = two.sub(&less, working).div(&two.add(&more, working), bits).unwrap_or_else(zero);
        let least = if least.lower().is_negative() { zero() } else { least };
        (least, two.add(&less, working).div(&two.sub(&more, working), bits).filter(|e| !e.lower().is_negative()))
    }

    /// The phase in degrees that the disk allows for, at most 180: `tan(phi/2)^2 = alpha^2 / (4 - (alpha skew)^2)`.
    pub fn degrees(&self, bits: u64) -> Enclosure {
        let working = bits + 16;
        let straight = || Enclosure::from_rational(Rational::from(180));
        let Some(alpha) = &self.alpha else { return straight() };
        let size = Value::Number(alpha.clone()).enclosure(working);
        let skewed = size.mul(&Enclosure::from_rational(self.skew.clone()), working);
        let below = Enclosure::from_rational(Rational::from(4)).sub(&skewed.mul(&skewed, working), working);
        let Some(tangent) = size.mul(&size, working).div(&below, working).filter(|t| !t.lower().is_negative()) else {
            return straight();
        };
        degrees(&tangent.sqrt(working).atan(working).mul(&Enclosure::from_rational(Rational::from(2)), working), bits)
    }
}

/// Radians as degrees.
///
/// ```
/// use jurist_algebra::number::Enclosure;
/// use jurist_engine::response::degrees;
/// assert!(degrees(&Enclosure::pi(64), 64).contains(&180.into()));
/// ```
pub fn degrees(radians: &Enclosure, bits: u64) -> Enclosure {
    let working = bits + 16;
    let scaled = radians.mul(&Enclosure::from_rational(Rational::from(180)), working);
    scaled.div(&Enclosure::pi(working), bits).expect("pi is not zero")
}
