//! Polynomials whose coefficients are polynomials in one fixed real algebraic number.

use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::real_roots::{sign_variations, signed_remainder_sequence_by};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, UniPoly};

/// Without the leading coefficients that vanish at the number.
pub(super) fn trimmed(p: &Poly<UniPoly>, at: &RealAlgebraic) -> Poly<UniPoly> {
    let mut coeffs = p.coeffs().to_vec();
    while coeffs.last().is_some_and(|last| at.sign_of(last).is_eq()) {
        coeffs.pop();
    }
    Poly::new(coeffs)
}

/// A polynomial that at the number is similar to the greatest common divisor of both; zero when both are zero there.
pub(super) fn gcd(a: &Poly<UniPoly>, b: &Poly<UniPoly>, at: &RealAlgebraic) -> Poly<UniPoly> {
    let (mut a, mut b) = (trimmed(a, at), trimmed(b, at));
    while !b.is_zero() {
        if a.coeffs().len() < b.coeffs().len() {
            std::mem::swap(&mut a, &mut b);
            continue;
        }
        // The leading coefficient of b is not zero at the number, nor is the content of what is not.
        let rest = trimmed(&a.pseudo_rem(&b), at);
        a = b;
        b = if rest.is_zero() { rest } else { rest.primitive_part() };
    }
    a
}

/// The quotient of a polynomial by its greatest common divisor with its derivative, at the number: simple roots only.
pub(super) fn square_free(p: &Poly<UniPoly>, at: &RealAlgebraic) -> Poly<UniPoly> {
    let common = gcd(p, &p.derivative(), at);
    if common.is_constant() {
        return p.clone();
    }
    let (quotient, _) = p.pseudo_div_rem(&common);
    trimmed(&quotient, at).primitive_part()
}

/// The quotient by the variable, whose root the polynomial has at the number.
pub(super) fn without_zero_root(p: &Poly<UniPoly>) -> Poly<UniPoly> {
    Poly::new(p.coeffs().iter().skip(1).cloned().collect())
}

/// The exact sign at a rational argument.
pub(super) fn sign_at(p: &Poly<UniPoly>, at: &RealAlgebraic, x: &Rational) -> Sign {
    at.sign_of(&value_at(p, x))
}

/// The polynomial in the number that is the value at a rational argument, times a positive integer.
fn value_at(p: &Poly<UniPoly>, x: &Rational) -> UniPoly {
    let (a, q) = (x.numerator(), x.denominator());
    let n = p.coeffs().len();
    let mut sum = UniPoly::zero();
    for (k, c) in p.coeffs().iter().enumerate() {
        let factor = a.pow(k as u64) * q.pow((n - 1 - k) as u64);
        sum = sum.plus(&c.scaled(&factor));
    }
    sum
}

/// Intervals with rational ends, each around one real root of a polynomial with simple roots at the number, none of which
/// is zero; the ends are no roots, and the interval does not reach zero. Ascending.
pub(super) fn isolate(p: &Poly<UniPoly>, at: &RealAlgebraic) -> Vec<(Rational, Rational)> {
    let normalised = |q: Poly<UniPoly>| {
        let q = trimmed(&q, at);
        if q.is_zero() {
            return q;
        }
        // Divided by the content, whose sign at the number is taken along.
        let content = q.content();
        let part = q.div_exact_scalar(&content).expect("the content divides");
        if at.sign_of(&content).is_lt() { -&part } else { part }
    };
    let sequence =
        signed_remainder_sequence_by(normalised(p.clone()), normalised(p.derivative()), normalised, |c| at.sign_of(c));
    let variations = |x: &Rational| sign_variations(sequence.iter().map(|f| sign_at(f, at, x)));
    let lead = |f: &Poly<UniPoly>| f.leading().map_or(Sign::Equal, |c| at.sign_of(c));
    let above = sign_variations(sequence.iter().map(lead));
    let below = sign_variations(sequence.iter().map(|f| {
        let sign = lead(f);
        if f.coeffs().len() % 2 == 0 { sign.reverse() } else { sign }
    }));
    let two = Rational::from(2);
    let mut bound = Rational::ONE;
    // The counts at the ends are those at infinity once all roots are inside.
    while variations(&bound) != above
        || variations(&-&bound) != below
        || sign_at(p, at, &bound).is_eq()
        || sign_at(p, at, &-&bound).is_eq()
    {
        bound *= two.clone();
    }
    let mut open = [(bound.clone(), above), (Rational::ZERO, variations(&Rational::ZERO)), (-bound, below)];
    open.reverse();
    let mut work: Vec<((Rational, usize), (Rational, usize))> =
        open.windows(2).map(|w| (w[0].clone(), w[1].clone())).collect();
    work.reverse();
    let mut found = Vec::new();
    while let Some(((lo, at_lo), (hi, at_hi))) = work.pop() {
        let roots = at_lo - at_hi;
        if roots == 0 {
            continue;
        }
        if roots == 1 && !lo.is_zero() && !hi.is_zero() {
            found.push((lo, hi));
            continue;
        }
        // A point between that is no root: one of finitely many fails.
        let mut weight = 2i64;
        let split = loop {
            let part = Rational::new(Integer::ONE, Integer::from(weight));
            let x = &lo + &((&hi - &lo) * part);
            if sign_at(p, at, &x).is_ne() {
                break x;
            }
            weight += 1;
        };
        let count = variations(&split);
        work.push(((split.clone(), count), (hi, at_hi)));
        work.push(((lo, at_lo), (split, count)));
    }
    found
}

/// Halves an isolating interval until it is narrower than `2^-bits` times its distance from zero.
pub(super) fn narrowed(
    p: &Poly<UniPoly>,
    at: &RealAlgebraic,
    (mut lo, mut hi): (Rational, Rational),
    bits: u64,
) -> (Rational, Rational) {
    let scale = Rational::from(&Integer::ONE << bits);
    let at_hi = sign_at(p, at, &hi);
    while (&hi - &lo) * scale.clone() > lo.abs().min(hi.abs()) {
        let mid = lo.midpoint(&hi);
        let sign = sign_at(p, at, &mid);
        if sign.is_eq() {
            return (mid.clone(), mid);
        }
        if sign == at_hi {
            hi = mid;
        } else {
            lo = mid;
        }
    }
    (lo, hi)
}

/// An enclosure of the value at an enclosed argument.
pub(super) fn eval(p: &Poly<UniPoly>, at: &Enclosure, x: &Enclosure, bits: u64) -> Enclosure {
    let mut sum = Enclosure::from_rational(Rational::ZERO);
    for c in p.coeffs().iter().rev() {
        sum = sum.mul(x, bits).add(&c.eval_enclosure(at, bits), bits);
    }
    sum
}
