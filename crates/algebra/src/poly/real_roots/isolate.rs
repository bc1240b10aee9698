//! From a square-free polynomial to its real roots.

use super::bounds::positive_root_bound_bits;
use super::bracket::{Bracket, eval_dyadic};
use super::deflated;
use super::descartes::{Cell, cells_by_bisection};
use super::fixed::isolate_real_roots_fixed;
use super::rational_roots::without_rational_roots;
use super::separated::separated;
use super::square_free::{SquareFree, deflation};
use crate::limits::{Budget, Exhausted};
use crate::number::{Integer, Rational, Sign};
use crate::poly::UniPoly;
use crate::poly::algebraic::RealAlgebraic;
use std::sync::Arc;

/// How narrow [`isolate_real_roots`] makes enclosures: a few bits more save comparisons later.
const CHOSEN_RELATIVE_BITS: u64 = 8;

/// All distinct real roots, ascending, with pairwise disjoint enclosures; rational roots exactly.
///
/// Any non-zero polynomial is made [`SquareFree`] by [`SquareFree::part_of`], which refuses only
/// the zero polynomial. The chooser among the algorithms of this module.
///
/// Cost: with `n` the degree, a halving of an interval in the Bernstein basis
/// ([LaneRiesenfeld1981](crate::bibliography#laneriesenfeld1981),
/// [CollinsAkritas1976](crate::bibliography#collinsakritas1976)) takes `n^2 / 2` additions of numbers of about a
/// hundred bits, more where signs change often; Newton steps ([Sagraloff2012](crate::bibliography#sagraloff2012))
/// shorten the way to roots that are close together.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::real_roots::{SquareFree, isolate_real_roots};
/// let p = UniPoly::from_i64(&[2, -1, -2, 1]); // (x - 2)(x^2 - 1)
/// let roots = isolate_real_roots(&SquareFree::part_of(&p).unwrap(), &Budget::unlimited()).unwrap();
/// let exact: Vec<_> = roots.iter().map(|r| r.exact().unwrap().to_string()).collect();
/// assert_eq!(exact, ["-1", "1", "2"]);
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn isolate_real_roots(p: &SquareFree, budget: &Budget) -> Result<Vec<RealAlgebraic>, Exhausted> {
    isolate_real_roots_fixed(p, CHOSEN_RELATIVE_BITS, budget)
}

/// The roots in the open interval from `lo` to `hi`, `None` meaning without end; an end that is a
/// root is left out.
///
/// Cost: that of [`isolate_real_roots`], which isolates all roots, and two comparisons for each of them.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::{SquareFree, UniPoly, isolate_real_roots_in};
/// let p = SquareFree::new(UniPoly::from_i64(&[0, -2, 0, 1])).unwrap(); // x^3 - 2 x
/// let roots = isolate_real_roots_in(&p, Some(&Rational::ZERO), None, &Budget::unlimited()).unwrap();
/// assert_eq!((roots.len(), roots[0].decimal(5)), (1, "1.4142".to_owned()));
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn isolate_real_roots_in(
    p: &SquareFree,
    lo: Option<&Rational>,
    hi: Option<&Rational>,
    budget: &Budget,
) -> Result<Vec<RealAlgebraic>, Exhausted> {
    let mut roots = isolate_real_roots(p, budget)?;
    roots.retain(|x| {
        lo.is_none_or(|lo| x.compare_rational(lo).is_gt()) && hi.is_none_or(|hi| x.compare_rational(hi).is_lt())
    });
    Ok(roots)
}

impl RealAlgebraic {
    /// The root of `p` in the open interval from `lo` to `hi`; `None` unless there is exactly one.
    ///
    /// Cost: that of [`isolate_real_roots`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::number::Rational;
    /// use jurist_algebra::poly::{RealAlgebraic, SquareFree, UniPoly};
    /// let p = SquareFree::new(UniPoly::from_i64(&[-2, 0, 1])).unwrap(); // x^2 - 2
    /// let root = RealAlgebraic::in_interval(&p, &Rational::ONE, &2.into(), &Budget::unlimited());
    /// assert_eq!(root.unwrap().unwrap().decimal(6), "1.41421");
    /// ```
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn in_interval(
        p: &SquareFree,
        lo: &Rational,
        hi: &Rational,
        budget: &Budget,
    ) -> Result<Option<RealAlgebraic>, Exhausted> {
        let mut roots = isolate_real_roots_in(p, Some(lo), Some(hi), budget)?;
        Ok(if roots.len() == 1 { roots.pop() } else { None })
    }
}

/// The reference algorithm: linear factors first, then [CollinsAkritas1976](crate::bibliography#collinsakritas1976) bisection with exact
/// integers on the positive and the negative half, each scaled to the unit interval by a power of
/// two.
///
/// Every halving costs two Taylor shifts, `O(n^2)` additions of integers that grow by `n` bits.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn isolate_real_roots_descartes(
    p: &SquareFree,
    lo: Option<&Rational>,
    hi: Option<&Rational>,
    budget: &Budget,
) -> Result<Vec<RealAlgebraic>, Exhausted> {
    budget.enter(|| by_bisection(p, lo, hi))
}

/// The same within the budget that holds on the thread.
pub(super) fn by_bisection(p: &SquareFree, lo: Option<&Rational>, hi: Option<&Rational>) -> Vec<RealAlgebraic> {
    let inside = |x: &Rational| lo.is_none_or(|lo| lo < x) && hi.is_none_or(|hi| x < hi);
    let (rational, rest) = without_rational_roots(p);
    let mut roots: Vec<RealAlgebraic> = rational.into_iter().filter(inside).map(RealAlgebraic::from_rational).collect();
    let poly = rest.shared();
    let mut brackets = if deflation(poly.coeffs()) > 1 {
        deflated::brackets(&poly, lo, hi)
    } else {
        let window = |x: &Rational, y: &Rational| lo.is_none_or(|lo| lo < y) && hi.is_none_or(|hi| x < hi);
        let mut brackets = brackets_of_half(&poly, true, &window);
        brackets.append(&mut brackets_of_half(&poly, false, &window));
        brackets
    };
    for bracket in brackets.drain(..) {
        let root = RealAlgebraic::from_bracket(Arc::clone(&poly), bracket);
        let above = lo.is_none_or(|lo| root.compare_rational(lo).is_gt());
        if above && hi.is_none_or(|hi| root.compare_rational(hi).is_lt()) {
            roots.push(root);
        }
    }
    separated(roots)
}

/// Brackets of the positive (or the negative) roots of a square-free polynomial without rational
/// roots, as far as they may lie in the window.
fn brackets_of_half(p: &UniPoly, negative: bool, window: &dyn Fn(&Rational, &Rational) -> bool) -> Vec<Bracket> {
    let half = if negative { p.negated_argument() } else { p.clone() };
    let Some(scale) = positive_root_bound_bits(&half) else { return Vec::new() };
    let scaled = scaled_by_power_of_two(&half, scale);
    let ends = |at: &Integer, depth: u64| {
        let (lo, hi) = (dyadic(at, scale - depth as i64), dyadic(&(at + &Integer::ONE), scale - depth as i64));
        if negative { (-hi, -lo) } else { (lo, hi) }
    };
    let wanted = |at: &Integer, depth: u64| {
        let (lo, hi) = ends(at, depth);
        window(&lo, &hi)
    };
    let cells = cells_by_bisection(&scaled, &wanted);
    cells.into_iter().map(|cell| bracket_of_cell(p, &cell, scale, negative)).collect()
}

fn bracket_of_cell(p: &UniPoly, cell: &Cell, scale: i64, negative: bool) -> Bracket {
    let exponent = scale - cell.depth as i64;
    let up = u64::try_from(exponent).unwrap_or(0);
    let bits = u64::try_from(-exponent).unwrap_or(0);
    let (mut lo, mut hi) = (&cell.at << up, &(&cell.at + &Integer::ONE) << up);
    if negative {
        (lo, hi) = (-hi, -lo);
    }
    let rising = eval_dyadic(p, &hi, bits).sign() == Sign::Greater;
    Bracket { lo, hi, bits, rising }
}

/// `a 2^exponent`.
fn dyadic(a: &Integer, exponent: i64) -> Rational {
    match u64::try_from(exponent) {
        Ok(up) => Rational::from(a << up),
        Err(_) => Rational::dyadic(a, exponent.unsigned_abs()),
    }
}

/// A positive multiple of `p(2^k x)`, without a power of two in its content.
fn scaled_by_power_of_two(p: &UniPoly, k: i64) -> UniPoly {
    let exponent = |i: usize| k * i as i64;
    let common = p.coeffs().iter().enumerate();
    let common = common.filter_map(|(i, c)| c.trailing_zeros().map(|z| z as i64 + exponent(i))).min().unwrap_or(0);
    let shift = |(i, c): (usize, &Integer)| {
        let by = exponent(i) - common;
        if by >= 0 { c << by.unsigned_abs() } else { c >> by.unsigned_abs() }
    };
    UniPoly::new(p.coeffs().iter().enumerate().map(shift).collect())
}
