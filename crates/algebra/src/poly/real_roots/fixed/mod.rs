//! Isolation in fixed-point arithmetic with certified errors.
//!
//! The Bernstein coefficients of the polynomial on the unit interval (and of its reversal, and of
//! both mirrored) are kept in a few machine words each; one triangle of additions halves an interval.
//! Every coefficient comes with a bound of its error, so that signs are known or known to be
//! unknown; what is unknown is computed again from the polynomial with more bits.

mod evaluate;
mod halves;
mod limbs;
mod newton;
mod piece;
mod powers;
mod refine;
mod search;
mod triangle;
mod variations;

use super::rational_roots::without_rational_roots;
use super::separated::separated;
use super::square_free::{SquareFree, deflation};
use crate::limits::{Budget, Exhausted};
use crate::number::Rational;
use crate::poly::UniPoly;
use crate::poly::algebraic::RealAlgebraic;
use std::sync::Arc;

pub(super) use limbs::write_shifted;
pub(super) use refine::refine_bracket;

/// All distinct real roots, ascending, with pairwise disjoint enclosures, those of irrational roots at
/// most `2^-relative_bits` times as wide as the root is large; rational roots exactly.
///
/// The answer is that of [`isolate_real_roots_descartes`](super::isolate_real_roots_descartes) up to
/// the width of the enclosures. With `n` the degree and `v` the sign variations of an interval, a
/// halving costs `n^2 / 2` additions of numbers of about `60 + 3 v` bits.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::real_roots::{SquareFree, isolate_real_roots_fixed};
/// let p = SquareFree::new(UniPoly::from_i64(&[-2, 0, 0, 1])).unwrap(); // x^3 - 2
/// let roots = isolate_real_roots_fixed(&p, 40, &Budget::unlimited()).unwrap();
/// let (lo, hi) = roots[0].enclosure();
/// assert_eq!(roots.len(), 1);
/// assert!((hi - &lo) * Rational::from(1i64 << 40) <= lo);
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn isolate_real_roots_fixed(
    p: &SquareFree,
    relative_bits: u64,
    budget: &Budget,
) -> Result<Vec<RealAlgebraic>, Exhausted> {
    budget.enter(|| isolated(p, relative_bits))
}

fn isolated(p: &SquareFree, relative_bits: u64) -> Vec<RealAlgebraic> {
    let (zero, nonzero) = match p.poly().coeffs().split_first() {
        Some((c, others)) if c.is_zero() => (true, SquareFree::known(UniPoly::new(others.to_vec()))),
        _ => (false, p.clone()),
    };
    let h = deflation(nonzero.poly().coeffs());
    let (mut rational, poly, brackets) = if h > 1 {
        let powers::Roots { rational, rest, brackets } = powers::roots(nonzero.poly(), h, relative_bits);
        (rational, Arc::new(rest), brackets)
    } else {
        let (rational, rest) = without_rational_roots(&nonzero);
        let poly = rest.shared();
        let brackets = halves::brackets(&poly, true, relative_bits);
        (rational, poly, brackets)
    };
    rational.extend(zero.then_some(Rational::ZERO));
    let mut roots: Vec<RealAlgebraic> =
        brackets.into_iter().map(|b| RealAlgebraic::from_bracket(Arc::clone(&poly), b)).collect();
    if rational.is_empty() {
        return roots;
    }
    let exact = |x: Rational| RealAlgebraic::from_rational(x);
    if rational.iter().all(Rational::is_zero) {
        // No bracket holds or touches zero.
        let at = roots.partition_point(|root| root.sign().is_lt());
        debug_assert!(roots.iter().all(|root| root.enclosure().0.sign() == root.enclosure().1.sign()));
        roots.insert(at, exact(Rational::ZERO));
        return roots;
    }
    roots.extend(rational.into_iter().map(exact));
    separated(roots)
}
