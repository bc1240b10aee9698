//! Polynomials in a power of the variable: the roots of `q(x^h)` from those of `q`.

use super::bracket::{Bracket, eval_dyadic};
use super::isolate::by_bisection;
use super::square_free::{SquareFree, deflation};
use crate::limits::until_shown;
use crate::number::{Integer, Rational, Sign};
use crate::poly::UniPoly;
use crate::poly::algebraic::RealAlgebraic;

/// Brackets of the roots of a square-free polynomial `q(x^h)`, `h > 1`, without rational roots,
/// at least of those between `lo` and `hi`.
pub(super) fn brackets(p: &UniPoly, lo: Option<&Rational>, hi: Option<&Rational>) -> Vec<Bracket> {
    let h = deflation(p.coeffs());
    let mut out = Vec::new();
    for negative in [true, false] {
        // The roots of the mirrored polynomial between `from` and `to`, both positive.
        let (from, to) = if negative { (hi.map(|x| -x), lo.map(|x| -x)) } else { (lo.cloned(), hi.cloned()) };
        let from = from.unwrap_or(Rational::ZERO).max(Rational::ZERO);
        if to.as_ref().is_some_and(|to| *to <= from) {
            continue;
        }
        let half = if negative { p.negated_argument() } else { p.clone() };
        let q = UniPoly::new(half.coeffs().iter().step_by(h).cloned().collect()).primitive_part();
        let power = |x: &Rational| x.pow(h as i64).expect("the exponent is positive");
        let (from, to) = (power(&from), to.as_ref().map(power));
        let ys = by_bisection(&SquareFree::known(q.clone()), Some(&from), to.as_ref());
        for bracket in roots_of_roots(&half, h, &from, to.as_ref(), &ys) {
            out.push(if negative { mirrored(bracket) } else { bracket });
        }
    }
    out
}

/// The brackets of the positive `h`-th roots of `ys`, which are all positive roots of `q` between
/// `from` and `to`, ascending and with disjoint enclosures.
fn roots_of_roots(p: &UniPoly, h: usize, from: &Rational, to: Option<&Rational>, ys: &[RealAlgebraic]) -> Vec<Bracket> {
    let mut out = Vec::new();
    for (i, y) in ys.iter().enumerate() {
        // Numbers on both sides of y with no other root in between; the sides of y decide signs.
        let (lo, hi) = y.enclosure();
        let left = i.checked_sub(1).map_or_else(|| from.clone(), |before| ys[before].enclosure().1.midpoint(&lo));
        let right = match (ys.get(i + 1), to) {
            (Some(after), _) => hi.midpoint(&after.enclosure().0),
            (None, Some(to)) => to.clone(),
            (None, None) => &hi + &hi,
        };
        out.push(root_of_root(p, h, y, &left, &right));
    }
    out
}

/// A bracket of the `h`-th root of `y`, between those of `left < y` and `right > y`.
fn root_of_root(p: &UniPoly, h: usize, y: &RealAlgebraic, left: &Rational, right: &Rational) -> Bracket {
    let power = h as u64;
    until_shown(8, |bits| {
        // Rounded inwards, so that no other root can get in.
        let lo = scaled_root(left, power, bits) + Integer::ONE;
        let hi = scaled_root(right, power, bits);
        let raised = |a: &Integer| Rational::dyadic(&a.pow(power), bits * power);
        if lo >= hi || y.compare_rational(&raised(&lo)).is_le() || y.compare_rational(&raised(&hi)).is_ge() {
            return None;
        }
        // No dyadic number is a root.
        let rising = eval_dyadic(p, &hi, bits).sign() == Sign::Greater;
        Some(Bracket { lo, hi, bits, rising })
    })
}

/// `floor(2^bits x^(1/power))` for `x >= 0`.
fn scaled_root(x: &Rational, power: u64, bits: u64) -> Integer {
    let quotient = (&x.numerator() << (bits * power)).div_mod_floor(&x.denominator()).0;
    quotient.root_floor(power)
}

fn mirrored(b: Bracket) -> Bracket {
    // p(-x) rises where p falls; its bracket is that of p mirrored.
    Bracket { lo: -b.hi, hi: -b.lo, bits: b.bits, rising: !b.rising }
}
