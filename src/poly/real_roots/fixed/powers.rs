//! Roots of `q(x^h)` from those of `q`.

use super::super::bracket::Bracket;
use super::super::rational_roots::rational_roots;
use super::super::square_free::SquareFree;
use super::halves;
use crate::limits::{Budget, Exhausted};
use crate::number::Integer;
use crate::poly::UniPoly;

/// Strictly disjoint brackets, ascending, of the roots of a square-free `p(x) = q(x^h)`, `h > 1`,
/// without rational roots, refined to `2^-relative` of the root.
pub fn brackets(p: &UniPoly, h: usize, relative: u64, budget: &Budget) -> Result<Vec<Bracket>, Exhausted> {
    let q = UniPoly::new(p.coeffs().iter().step_by(h).cloned().collect());
    let even = h.is_multiple_of(2);
    let mirror = |b: Bracket| Bracket { lo: -b.hi, hi: -b.lo, ..b };
    let mut positive = roots_of_positive(&q, h, relative, budget)?;
    let mut out: Vec<Bracket> = if even {
        // p is even: its negative roots mirror the positive ones.
        positive.iter().rev().cloned().map(mirror).collect()
    } else {
        let negative = roots_of_positive(&q.negated_argument(), h, relative, budget)?;
        negative.into_iter().rev().map(mirror).collect()
    };
    out.append(&mut positive);
    // All roots are simple and all are here: the signs alternate from root to root, and beyond the
    // last the sign is that of the leading coefficient.
    let mut rising = p.coeffs().last().is_some_and(|c| c.sign().is_gt());
    for b in out.iter_mut().rev() {
        b.rising = rising;
        rising = !rising;
    }
    Ok(out)
}

/// The positive `h`-th roots of the positive roots of `q`; which of them rise is left to the caller.
fn roots_of_positive(q: &UniPoly, h: usize, relative: u64, budget: &Budget) -> Result<Vec<Bracket>, Exhausted> {
    let mut more = 4 + u64::from(usize::BITS - h.leading_zeros());
    loop {
        let ys = positive_roots(q, relative + more, budget)?;
        let roots: Vec<Bracket> = ys.iter().map(|y| root_of(y, h as u64, relative + more)).collect();
        let apart = |a: &Bracket, b: &Bracket| {
            let bits = a.bits.max(b.bits);
            (&a.hi << (bits - a.bits)) < (&b.lo << (bits - b.bits))
        };
        // Each enclosure holds the root that it was made from: apart, it holds no other.
        if roots.windows(2).all(|w| apart(&w[0], &w[1])) {
            return Ok(roots);
        }
        more = 2 * (more + relative);
    }
}

/// Brackets of the positive roots of a square-free `q`, ascending; those of rational roots, which
/// are of relative width `2^-relative` too, may end at the root. Only the ends are meant.
fn positive_roots(q: &UniPoly, relative: u64, budget: &Budget) -> Result<Vec<Bracket>, Exhausted> {
    let q = SquareFree::known(q.primitive_part());
    let (rational, rest) = rational_roots(&q, budget)?;
    let mut out = halves::brackets(rest.poly(), false, relative, budget)?;
    for y in rational.into_iter().filter(|y| y.sign().is_gt()) {
        let exponent = y.numerator().bit_length() as i64 - y.denominator().bit_length() as i64 - 1;
        let bits = (relative as i64 - exponent).max(0) as u64;
        let lo = (&y.numerator() << bits).div_mod_floor(&y.denominator()).0;
        let hi = &lo + &Integer::ONE;
        out.push(Bracket { lo, hi, bits, rising: true });
    }
    out.sort_by(|a, b| {
        let bits = a.bits.max(b.bits);
        (&a.lo << (bits - a.bits)).cmp(&(&b.lo << (bits - b.bits)))
    });
    Ok(out)
}

/// The `h`-th root of a bracket, rounded outwards by less than `2^-relative` of the root.
fn root_of(y: &Bracket, h: u64, relative: u64) -> Bracket {
    // x has its first bit at the exponent of y divided by h.
    let exponent = (y.lo.bit_length() as i64 - 1 - y.bits as i64).div_euclid(h as i64);
    let bits = (relative as i64 + 3 - exponent).max(0) as u64;
    let raised = |a: &Integer| {
        let shift = (bits * h) as i64 - y.bits as i64;
        if shift >= 0 { a << shift as u64 } else { a >> shift.unsigned_abs() }
    };
    let lo = raised(&y.lo).root_floor(h);
    let hi = raised(&y.hi).root_floor(h) + Integer::ONE;
    Bracket { lo, hi, bits, rising: y.rising }
}
