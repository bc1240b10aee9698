//! Where the roots of a loop with dead time lie, at a point.

use super::mikhailov::{NotCounted, roots_right, roots_right_of_line, zero_at_origin};
use super::{Kind, QuasiPolynomial};
use crate::{Shape, count_roots};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// Roots on the imaginary axis and to the right of it, with multiplicity; those to the left are infinitely many.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::dead_time::{QuasiPolynomial, count_delayed_roots};
/// // s + 2 exp(-tau s): stable up to tau = pi/4
/// let p = QuasiPolynomial::new(vec![UniPoly::from_i64(&[0, 1]), UniPoly::from_i64(&[2])]).unwrap();
/// let at = |tau: &str| count_delayed_roots(&p, &tau.parse().unwrap(), &Budget::unlimited()).unwrap();
/// assert!(at("785/1000").is_stable());
/// assert_eq!(at("786/1000").right, Some(2));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DelayCount {
    /// Roots on the imaginary axis.
    pub on: usize,
    /// Roots to the right of it; `None` where the difference operator has a zero in the closed unit disc: then infinitely
    /// many roots lie to the right of the axis, or come as near to it as one likes.
    pub right: Option<usize>,
}

impl DelayCount {
    /// Whether no root lies on the axis or to the right of it, nor comes as near to it as one likes.
    pub fn is_stable(&self) -> bool {
        self.on == 0 && self.right == Some(0)
    }
}

/// The exact count at a dead time that is a rational number and not negative.
///
/// At a rational dead time other than zero a root on the axis is `s = 0`, or does not depend on the dead time at all: for
/// any other the dead time is a quotient of a logarithm of an algebraic number and an algebraic number, which is
/// transcendental by the theorem of Lindemann ([Baker1975](jurist_algebra::bibliography#baker1975)).
///
/// Cost: an exact count for the common factor of the parts, and a walk along the axis for the rest.
///
/// # Errors
/// [`NotCounted`]: the budget, or a neutral loop that is not decided.
///
/// # Panics
/// When the dead time is negative.
pub fn count_delayed_roots(p: &QuasiPolynomial, tau: &Rational, budget: &Budget) -> Result<DelayCount, NotCounted> {
    assert!(!tau.is_negative(), "a dead time is not negative");
    if tau.is_zero() || p.delays() == 0 {
        let polynomial = p.without_delay();
        if polynomial.coeffs().is_empty() {
            return Ok(DelayCount { on: 0, right: None });
        }
        let count = count_roots(&polynomial, Shape::LeftHalfPlane);
        return Ok(DelayCount { on: count.on, right: Some(count.outside) });
    }
    let content = count_roots(&p.content(), Shape::LeftHalfPlane);
    let rest = p.primitive();
    let infinite = rest.kind() == Kind::Advanced || !rest.has_stable_difference();
    let at_zero = if rest.without_delay().coeff(0).is_zero() { zero_at_origin(&rest, tau).0 } else { 0 };
    let on = content.on + at_zero;
    if infinite {
        return Ok(DelayCount { on, right: None });
    }
    let right = content.outside + roots_right(&rest, tau, at_zero, budget)?;
    Ok(DelayCount { on, right: Some(right) })
}

/// The same from another line: `z = exp(growth - tau s)`, `s` being counted from the line.
///
/// # Errors
/// [`NotCounted`]; a root on the line that depends on the dead time shows as precision that does not suffice.
pub(super) fn count_from_line(
    p: &QuasiPolynomial,
    tau: &Rational,
    growth: &Rational,
    budget: &Budget,
) -> Result<DelayCount, NotCounted> {
    if growth.is_zero() || p.delays() == 0 {
        return count_delayed_roots(p, tau, budget);
    }
    let content = count_roots(&p.content(), Shape::LeftHalfPlane);
    let right = roots_right_of_line(&p.primitive(), tau, growth, budget)?;
    Ok(DelayCount { on: content.on, right: right.map(|right| right + content.outside) })
}
