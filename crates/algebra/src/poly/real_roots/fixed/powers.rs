//! Roots of `q(x^h)` from those of `q`.

use super::super::bracket::Bracket;
use super::super::rational_roots::{linear, without_rational_roots};
use super::super::square_free::SquareFree;
use super::halves;
use crate::number::{Integer, Rational};
use crate::poly::UniPoly;

/// The real roots of a polynomial in a power.
pub struct Roots {
    /// The rational ones, in any order.
    pub rational: Vec<Rational>,
    /// The polynomial without their factors.
    pub rest: UniPoly,
    /// Strictly disjoint brackets, ascending, of its roots.
    pub brackets: Vec<Bracket>,
}

/// The real roots of a square-free `p(x) = q(x^h)`, `h > 1`, that is not 0 at 0, refined to
/// `2^-relative` of the root.
pub fn roots(p: &UniPoly, h: usize, relative: u64) -> Roots {
    let q = UniPoly::new(p.coeffs().iter().step_by(h).cloned().collect());
    let (ys, irrational) = without_rational_roots(&SquareFree::known(q.primitive_part()));
    let even = h.is_multiple_of(2);
    let (mut rational, mut powers) = (Vec::new(), Vec::new());
    let mut rest = p.clone();
    for y in ys {
        match exact_root(&y.abs(), h as u64) {
            Some(_) if even && y.is_negative() => {}
            Some(x) if even => rational.extend([-&x, x]),
            Some(x) => rational.push(if y.is_negative() { -x } else { x }),
            None => powers.push(y),
        }
    }
    for x in &rational {
        rest = rest.div_exact_poly(&linear(x)).expect("it is a root");
    }
    let mirror = |b: Bracket| Bracket { lo: -b.hi, hi: -b.lo, ..b };
    let mut positive = roots_of_positive(irrational.poly(), &powers, h, relative);
    let mut brackets: Vec<Bracket> = if even {
        // p is even: its negative roots mirror the positive ones.
        positive.iter().rev().cloned().map(mirror).collect()
    } else {
        let powers: Vec<Rational> = powers.iter().map(|y| -y).collect();
        let negative = roots_of_positive(&irrational.poly().negated_argument(), &powers, h, relative);
        negative.into_iter().rev().map(mirror).collect()
    };
    brackets.append(&mut positive);
    // All roots are simple and all are here: the signs alternate from root to root, and beyond the
    // last the sign is that of the leading coefficient.
    let mut rising = rest.coeffs().last().is_some_and(|c| c.sign().is_gt());
    for b in brackets.iter_mut().rev() {
        b.rising = rising;
        rising = !rising;
    }
    Roots { rational, rest, brackets }
}

/// The `h`-th root of a non-negative number, if it is rational.
fn exact_root(y: &Rational, h: u64) -> Option<Rational> {
    let root = |n: Integer| Some(n.root_floor(h)).filter(|r| r.pow(h) == n);
    Some(Rational::new(root(y.numerator())?, root(y.denominator())?))
}

/// The positive `h`-th roots of the positive roots of `q`, which has no rational roots, and of the positive ones
/// of some rational numbers; which of them rise is left to the caller.
fn roots_of_positive(q: &UniPoly, powers: &[Rational], h: usize, relative: u64) -> Vec<Bracket> {
    let mut more = 4 + u64::from(usize::BITS - h.leading_zeros());
    loop {
        let ys = positive_roots(q, powers, relative + more);
        let roots: Vec<Bracket> = ys.iter().map(|y| root_of(y, h as u64, relative + more)).collect();
        let apart = |a: &Bracket, b: &Bracket| {
            let bits = a.bits.max(b.bits);
            (&a.hi << (bits - a.bits)) < (&b.lo << (bits - b.bits))
        };
        // Each enclosure holds the root that it was made from: apart, it holds no other.
        if roots.windows(2).all(|w| apart(&w[0], &w[1])) {
            return roots;
        }
        more = 2 * (more + relative);
    }
}

/// Brackets of the positive roots of a square-free `q` without rational roots and of the positive ones of some rational
/// numbers, ascending; the latter, which are of relative width `2^-relative` too, may end at the root.
/// Only the ends are meant.
fn positive_roots(q: &UniPoly, powers: &[Rational], relative: u64) -> Vec<Bracket> {
    let mut out = halves::brackets(q, false, relative);
    for y in powers.iter().filter(|y| y.sign().is_gt()) {
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
    out
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
