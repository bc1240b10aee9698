//! Sturm's theorem for a polynomial whose coefficients are polynomials in an algebraic number.

use crate::limits::{Budget, Exhausted};
use crate::number::{Integer, Rational, Sign};
use crate::poly::{Domain, Poly, RealAlgebraic, UniPoly};
use std::cmp::Ordering;

/// How many distinct real roots `f(c, y)` has in an open interval of `y` with rational or infinite ends,
/// for an algebraic number `c`; `None` when `f(c, y)` vanishes identically.
///
/// A signed remainder sequence whose coefficients are reduced modulo the polynomial of `c`; a
/// coefficient is zero when its exact sign at `c` is.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn count_distinct_roots_at(
    f: &Poly<UniPoly>,
    c: &RealAlgebraic,
    lower: Option<&Rational>,
    upper: Option<&Rational>,
    budget: &Budget,
) -> Result<Option<usize>, Exhausted> {
    let mut first = reduced(f, c);
    for end in [lower, upper].into_iter().flatten() {
        // A root at an end is not inside; the quotient by its linear factor has the other roots.
        while !first.is_constant() && sign_at(&first, c, end).is_eq() {
            first = reduced(&without_root(&first, end), c);
        }
    }
    if first.is_zero() {
        return Ok(None);
    }
    let mut sequence = vec![first.clone()];
    let mut next = reduced(&first.derivative(), c);
    while !next.is_zero() {
        budget.check()?;
        let previous = &sequence[sequence.len() - 1];
        let exponent = (previous.coeffs().len() + 1).saturating_sub(next.coeffs().len());
        let lead = c.sign_of(next.leading().expect("not zero"));
        let mut r = reduced(&previous.pseudo_rem(&next), c);
        if !(exponent % 2 == 1 && lead.is_lt()) {
            r = r.negated();
        }
        sequence.push(next);
        next = r;
    }
    let variations = |sign: &dyn Fn(&Poly<UniPoly>) -> Sign| {
        let mut last = Ordering::Equal;
        let mut count = 0;
        for s in sequence.iter().map(sign).filter(|s| s.is_ne()) {
            count += usize::from(last.is_ne() && s != last);
            last = s;
        }
        count
    };
    let at_infinity = |p: &Poly<UniPoly>, negative: bool| {
        let sign = p.leading().map_or(Ordering::Equal, |l| c.sign_of(l));
        if negative && p.coeffs().len() % 2 == 0 { sign.reverse() } else { sign }
    };
    let low = variations(&|p| lower.map_or_else(|| at_infinity(p, true), |x| sign_at(p, c, x)));
    let high = variations(&|p| upper.map_or_else(|| at_infinity(p, false), |x| sign_at(p, c, x)));
    Ok(Some(low - high))
}

/// The sign of `p(c, y)` at a rational `y`.
fn sign_at(p: &Poly<UniPoly>, c: &RealAlgebraic, y: &Rational) -> Sign {
    let (a, q) = (y.numerator(), y.denominator());
    let mut acc = UniPoly::zero();
    let mut power = Integer::ONE;
    for coefficient in p.coeffs().iter().rev() {
        acc = acc.scaled(&a).plus(&coefficient.scaled(&power));
        power = &power * &q;
    }
    c.sign_of(&acc)
}

/// The quotient of `q^d p` by `q y - a` up to a positive factor, for a root `a/q` of `p(c, y)`.
fn without_root(p: &Poly<UniPoly>, root: &Rational) -> Poly<UniPoly> {
    let (a, q) = (root.numerator(), root.denominator());
    let divisor = Poly::new(vec![UniPoly::constant(-a), UniPoly::constant(q)]);
    p.pseudo_div_rem(&divisor).0
}

/// The same values at `c` up to one positive factor: coefficients reduced modulo the polynomial of `c`,
/// those at the top that vanish at `c` dropped, integer content removed.
fn reduced(p: &Poly<UniPoly>, c: &RealAlgebraic) -> Poly<UniPoly> {
    let modulus = c.polynomial();
    let m = modulus.coeffs().len();
    let longest = p.coeffs().iter().map(|k| k.coeffs().len()).max().unwrap_or(0);
    let mut coeffs = p.coeffs().to_vec();
    if longest >= m {
        // Pseudo-division multiplies by a power of the leading coefficient, which is positive; all
        // coefficients are to be multiplied by the same power.
        let lead = modulus.leading().expect("not zero");
        let steps = longest - m + 1;
        for k in &mut coeffs {
            let own = (k.coeffs().len() + 1).saturating_sub(m);
            *k = k.pseudo_rem(modulus).scaled(&lead.pow((steps - own) as u64));
        }
    }
    while coeffs.last().is_some_and(|k| c.sign_of(k).is_eq()) {
        coeffs.pop();
    }
    let content = coeffs.iter().fold(Integer::ZERO, |g, k| g.gcd(&k.content()));
    if !content.is_zero() && !content.is_one() {
        for k in &mut coeffs {
            *k = k.div_exact_scalar(&content).expect("the content divides");
        }
    }
    Poly::new(coeffs)
}
