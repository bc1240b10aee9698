//! Greatest common divisors.

use super::MultiPoly;
use super::lines::are_coprime;
use crate::poly::{Domain, Poly, UniPoly};

/// The greatest common divisor over the integers, contents included, with a positive leading
/// coefficient; `gcd(0, 0) = 0`.
pub(super) fn gcd(a: &MultiPoly, b: &MultiPoly) -> MultiPoly {
    let normalise = |p: &MultiPoly| if p.needs_negation() { p.negated() } else { p.clone() };
    if a.is_zero() {
        return normalise(b);
    }
    if b.is_zero() || a == b {
        return normalise(a);
    }
    let content = a.integer_content().gcd(&b.integer_content());
    if a.is_constant() || b.is_constant() {
        return MultiPoly::constant(content);
    }
    // Monomial factors are common enough to be split off, and then do not disturb the rest.
    let (monomial_a, monomial_b) = (a.monomial_content(), b.monomial_content());
    let monomial = monomial_a.gcd(&monomial_b);
    let strip = |p: &MultiPoly, m| p.div_exact_monomial(m).expect("the content divides").primitive_over_integers();
    let g = primitive_gcd(&strip(a, &monomial_a), &strip(b, &monomial_b));
    g.times(&MultiPoly::term(monomial, content))
}

/// For polynomials of integer content 1.
fn primitive_gcd(a: &MultiPoly, b: &MultiPoly) -> MultiPoly {
    if a == b {
        return a.clone();
    }
    let (in_a, in_b) = (a.variables(), b.variables());
    // A common divisor has no variable that occurs in one of them only.
    if let Some(&i) = in_a.iter().find(|i| !in_b.contains(i)) {
        return gcd_with_content(b, a, i);
    }
    if let Some(&i) = in_b.iter().find(|i| !in_a.contains(i)) {
        return gcd_with_content(a, b, i);
    }
    match in_a.as_slice() {
        [] => MultiPoly::one(),
        &[i] => {
            let single = |p: &MultiPoly| p.to_univariate(i).expect("no other variable occurs");
            MultiPoly::from_univariate(&single(a).gcd(&single(b)), i)
        }
        several if are_coprime(a, b, several) => MultiPoly::one(),
        several => {
            if a.terms().len() <= b.terms().len() && b.div_exact(a).is_some() {
                return a.clone();
            }
            if b.terms().len() <= a.terms().len() && a.div_exact(b).is_some() {
                return b.clone();
            }
            // The main variable is the one in which the sequence is shortest.
            let shortest = |i: &&usize| a.degree_in(**i).min(b.degree_in(**i));
            let main = *several.iter().min_by_key(shortest).expect("there are several");
            match several {
                [x, y] => gcd_in_two_variables(a, b, if main == *x { *y } else { *x }, main),
                _ => gcd_in_main_variable(a, b, main),
            }
        }
    }
}

/// The gcd of `a` and the coefficients of `b` as a polynomial in variable `i`, which does not
/// occur in `a`.
fn gcd_with_content(a: &MultiPoly, b: &MultiPoly, i: usize) -> MultiPoly {
    let mut g = a.clone();
    for c in b.as_poly_in(i).coeffs() {
        if g.is_one() {
            break;
        }
        g = g.gcd(c);
    }
    g
}

/// The same as [`gcd_in_main_variable`] with coefficients that are known to be in one other variable.
fn gcd_in_two_variables(a: &MultiPoly, b: &MultiPoly, other: usize, main: usize) -> MultiPoly {
    let dense = |p: &MultiPoly| p.as_poly_in(main).map(|c| c.to_univariate(other).expect("one other variable"));
    let g: Poly<UniPoly> = dense(a).gcd(&dense(b));
    let g = MultiPoly::from_poly_in(&g.map(|c| MultiPoly::from_univariate(c, other)), main);
    if g.needs_negation() { g.negated() } else { g }
}

/// Content and primitive part with respect to one variable, the primitive parts by the
/// subresultant sequence: the reference.
fn gcd_in_main_variable(a: &MultiPoly, b: &MultiPoly, main: usize) -> MultiPoly {
    let (a, b): (Poly<MultiPoly>, Poly<MultiPoly>) = (a.as_poly_in(main), b.as_poly_in(main));
    let g = MultiPoly::from_poly_in(&a.gcd(&b), main);
    if g.needs_negation() { g.negated() } else { g }
}
