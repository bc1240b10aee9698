//! Sturm sequences: the exact count of distinct real roots in an interval.

use super::sign_variations::sign_variations;
use crate::limits::{Budget, Exhausted};
use crate::number::{Integer, Rational, Sign};
use crate::poly::{Domain, Poly, UniPoly};

/// An end of an interval on the real line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound<'a> {
    /// No end: minus infinity on the left, plus infinity on the right.
    Unbounded,
    /// The end itself is left out.
    Open(&'a Rational),
    /// The end itself belongs to the interval.
    Closed(&'a Rational),
}

/// The Sturm sequence `p, p', -rem(p, p'), ...`, each member divided by its positive content.
///
/// Empty for zero, one member for a constant. `O(n^2)` operations on growing integers, removed
/// content keeps them near the size of subresultants [BasuPollackRoy2006](crate::bibliography#basupollackroy2006).
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn sturm_sequence(p: &UniPoly, budget: &Budget) -> Result<Vec<UniPoly>, Exhausted> {
    budget.enter(|| signed_remainder_sequence(p, &p.derivative()))
}

/// `S_0 = a`, `S_1 = b`, `S_(i+1) = -rem(S_(i-1), S_i)`, each divided by its positive content, without the final zero:
/// what Sturm's theorem counts with, and the index of Cauchy of `b / a`
/// ([BasuPollackRoy2006](crate::bibliography#basupollackroy2006)). Empty where `a` is zero.
///
/// `O(n^2)` operations on integers of about the size of subresultants. Runs within the budget that holds on the thread.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::real_roots::signed_remainder_sequence;
/// let (a, b) = (UniPoly::from_i64(&[-1, 0, 1]), UniPoly::from_i64(&[0, 1]));
/// let sequence = signed_remainder_sequence(&a, &b); // x^2 - 1, x, 1
/// assert_eq!(sequence[2], UniPoly::from_i64(&[1]));
/// ```
pub fn signed_remainder_sequence(a: &UniPoly, b: &UniPoly) -> Vec<UniPoly> {
    signed_remainder_sequence_by(
        positive_primitive(a),
        positive_primitive(b),
        |p| positive_primitive(&p),
        Integer::sign,
    )
}

/// The same over any domain with signs: `normalised` divides by a positive factor (or takes another representative of
/// the coefficients), `sign` tells the sign of a leading coefficient. Both polynomials are to be normalised.
pub fn signed_remainder_sequence_by<R: Domain>(
    a: Poly<R>,
    b: Poly<R>,
    normalised: impl Fn(Poly<R>) -> Poly<R>,
    sign: impl Fn(&R) -> Sign,
) -> Vec<Poly<R>> {
    let mut sequence: Vec<Poly<R>> = Vec::new();
    let (mut previous, mut next) = (a, b);
    while let Some(lead) = next.leading() {
        // The pseudo-remainder is lead^exponent times the remainder.
        let exponent = (previous.coeffs().len() + 1).saturating_sub(next.coeffs().len());
        let flipped = exponent % 2 == 1 && sign(lead).is_lt();
        let remainder = previous.pseudo_rem(&next);
        let negative = normalised(if flipped { remainder } else { remainder.negated() });
        sequence.push(std::mem::replace(&mut previous, std::mem::replace(&mut next, negative)));
    }
    if !previous.is_zero() {
        sequence.push(previous);
    }
    sequence
}

/// The polynomial divided by its positive content: the signs stay.
fn positive_primitive(p: &UniPoly) -> UniPoly {
    if p.is_zero() {
        return p.clone();
    }
    p.div_exact_scalar(&p.content()).expect("the content divides every coefficient")
}

/// The number of distinct real roots of `p` in an interval (Sturm's theorem [Sturm1829](crate::bibliography#sturm1829)); a
/// multiple root counts once, also at an end. Zero for a constant, for the zero polynomial (none
/// of whose roots is isolated) and for an empty interval.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::real_roots::{Bound, count_roots_sturm};
/// let p = UniPoly::from_i64(&[0, -1, 0, 1]); // x^3 - x
/// let zero = Rational::ZERO;
/// let budget = Budget::unlimited();
/// assert_eq!(count_roots_sturm(&p, Bound::Unbounded, Bound::Unbounded, &budget).unwrap(), 3);
/// assert_eq!(count_roots_sturm(&p, Bound::Open(&zero), Bound::Unbounded, &budget).unwrap(), 1);
/// assert_eq!(count_roots_sturm(&p, Bound::Closed(&zero), Bound::Unbounded, &budget).unwrap(), 2);
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn count_roots_sturm(p: &UniPoly, lo: Bound, hi: Bound, budget: &Budget) -> Result<usize, Exhausted> {
    if let (Bound::Open(a) | Bound::Closed(a), Bound::Open(b) | Bound::Closed(b)) = (lo, hi) {
        let both_closed = matches!((lo, hi), (Bound::Closed(_), Bound::Closed(_)));
        if a > b || (a == b && !both_closed) {
            return Ok(0);
        }
    }
    // Multiple roots: V(a) - V(b) counts the distinct roots in (a, b] when neither end is a
    // multiple root; dividing by the gcd first removes that condition.
    let sequence = budget.enter(|| p.square_free_part()).and_then(|part| sturm_sequence(&part, budget))?;
    budget.enter(|| count_with_sequence(&sequence, lo, hi))
}

/// The count from the Sturm sequence of a square-free polynomial, on a non-empty interval.
pub fn count_with_sequence(sequence: &[UniPoly], lo: Bound, hi: Bound) -> usize {
    let Some(p) = sequence.first() else { return 0 };
    let at = |x: &Rational| sign_variations(sequence.iter().map(|f| f.sign_at(x)));
    let leading = |f: &UniPoly| f.leading().map_or(Sign::Equal, |c| c.sign());
    let is_root = |x: &Rational| usize::from(p.sign_at(x).is_eq());
    // V(a) - V(b) is the number of roots in (a, b].
    let (left, at_left) = match lo {
        Bound::Unbounded => {
            let odd = |f: &UniPoly| f.degree().is_some_and(|n| n % 2 == 1);
            let sign = |f: &UniPoly| if odd(f) { leading(f).reverse() } else { leading(f) };
            (sign_variations(sequence.iter().map(sign)), 0)
        }
        Bound::Open(a) => (at(a), 0),
        Bound::Closed(a) => (at(a), is_root(a)),
    };
    let (right, at_right) = match hi {
        Bound::Unbounded => (sign_variations(sequence.iter().map(leading)), 0),
        Bound::Open(b) => (at(b), is_root(b)),
        Bound::Closed(b) => (at(b), 0),
    };
    (left + at_left).saturating_sub(right + at_right)
}
