//! Greatest common divisors.

use super::lines::are_coprime_in;
use super::{Monomial, MultiPoly};
use crate::number::Integer;
use crate::poly::{Domain, Poly, UniPoly};
use std::collections::BTreeMap;

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
        several => {
            if let Some(g) = gcd_in_fewer_variables(a, b, several) {
                return g;
            }
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

/// The gcd of polynomials of integer content 1 in the same variables, where lines show that some of these do not occur in
/// it: it divides the coefficients of both as polynomials in these.
pub(super) fn gcd_in_fewer_variables(a: &MultiPoly, b: &MultiPoly, variables: &[usize]) -> Option<MultiPoly> {
    let left: Vec<usize> = variables.iter().copied().filter(|&j| !are_coprime_in(a, b, j)).collect();
    if left.len() == variables.len() {
        return None;
    }
    if left.is_empty() {
        return Some(MultiPoly::one());
    }
    let mut coefficients = coefficients_over(a, &left);
    coefficients.extend(coefficients_over(b, &left));
    coefficients.sort_by_key(|c| c.terms().len());
    let mut g = MultiPoly::zero();
    for c in coefficients {
        g = g.gcd(&c);
        if g.is_constant() {
            return Some(MultiPoly::one());
        }
    }
    Some(g.primitive_over_integers())
}

/// The coefficients of a polynomial in the variables that are not in a list, polynomials in those of the list.
fn coefficients_over(p: &MultiPoly, list: &[usize]) -> Vec<MultiPoly> {
    let mut groups: BTreeMap<Vec<u32>, Vec<(Vec<u32>, Integer)>> = BTreeMap::new();
    for (monomial, c) in p.terms() {
        let outside = list.iter().fold(monomial.clone(), |m: Monomial, &i| m.with_exponent(i, 0));
        let inside = monomial.checked_div(&outside).expect("a part of it");
        groups.entry(outside.exponents().to_vec()).or_default().push((inside.exponents().to_vec(), c.clone()));
    }
    groups.into_values().map(MultiPoly::from_terms).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::gcd::primitive_gcd_subresultant;

    /// Common factors in one, two and three of four variables, with other factors in all, against the subresultant sequence.
    #[test]
    fn a_divisor_in_fewer_variables_is_found_among_the_coefficients() {
        let [x, y, z, w] = [0, 1, 2, 3].map(MultiPoly::variable);
        let one = MultiPoly::one();
        let common = [
            x.minus(&MultiPoly::constant(Integer::from(2))),
            y.times(&y).plus(&one),
            x.times(&y).plus(&MultiPoly::constant(Integer::from(3))),
            x.times(&z).minus(&y).plus(&one),
            one.clone(),
        ];
        let a = x.times(&y).plus(&z.times(&w)).plus(&one);
        let b = x.times(&x).times(&w).minus(&y.times(&z)).plus(&w);
        for f in &common {
            for g in &common {
                let expected = f.times(g).primitive_over_integers();
                let (a, b) = (a.times(&expected), b.times(&expected));
                assert_eq!(gcd(&a, &b), if expected.needs_negation() { expected.negated() } else { expected.clone() });
                // The same as polynomials in x with coefficients in the others, which are numbered from 0.
                let dense = |p: &MultiPoly| p.as_poly_in(0).map(|c| c.map_variables(|i| i - 1));
                let (a, b) = (dense(&a).primitive_part(), dense(&b).primitive_part());
                let found = Domain::gcd(&a, &b).primitive_part();
                assert_eq!(found, primitive_gcd_subresultant(&a, &b).primitive_part());
                assert!(MultiPoly::primitive_gcd_fast(&a, &b).is_some_and(|g| g.primitive_part() == found));
            }
        }
    }
}
