//! Resultants of plane curves by values and interpolation.

use crate::limits::{Budget, Exhausted};
use crate::number::Integer;
use crate::poly::{Domain, Poly, UniPoly, resultant_formal};

/// The resultant in `y` of two polynomials over `Z[x]`, equal to that by subresultants: it is a polynomial
/// in `x` of bounded degree, known by its values at 0, 1, 2, ..., each a resultant over the integers.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn resultant_by_values(f: &Poly<UniPoly>, g: &Poly<UniPoly>, budget: &Budget) -> Result<UniPoly, Exhausted> {
    let (Some(n), Some(m)) = (f.degree(), g.degree()) else { return Ok(UniPoly::zero()) };
    let degree_in_x = |p: &Poly<UniPoly>| p.coeffs().iter().filter_map(Poly::degree).max().unwrap_or(0);
    let bound = degree_in_x(f) * m + degree_in_x(g) * n;
    let mut values = Vec::with_capacity(bound + 1);
    for k in 0..=bound {
        budget.check()?;
        let x = Integer::from(k as u64);
        // Formal degrees: the value is right also where a leading coefficient vanishes.
        values.push(resultant_formal(&f.map(|c| c.eval(&x)), n, &g.map(|c| c.eval(&x)), m, budget)?);
    }
    Ok(interpolated(values))
}

/// The discriminant in `y` up to sign, for a degree of at least 2.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn discriminant_by_values(f: &Poly<UniPoly>, budget: &Budget) -> Result<UniPoly, Exhausted> {
    let r = resultant_by_values(f, &f.derivative(), budget)?;
    Ok(r.div_exact(f.leading().expect("the degree is at least 2")).expect("the leading coefficient divides"))
}

/// The polynomial of degree below `values.len()` with these values at 0, 1, 2, ..., by Newton's formula;
/// divided differences of an integer polynomial at integers are integers.
fn interpolated(mut values: Vec<Integer>) -> UniPoly {
    for order in 1..values.len() {
        let divisor = Integer::from(order as u64);
        for i in (order..values.len()).rev() {
            let difference = &values[i] - &values[i - 1];
            values[i] = difference.div_exact(&divisor);
        }
    }
    let mut out = UniPoly::zero();
    for (k, value) in values.into_iter().enumerate().rev() {
        let factor = UniPoly::new(vec![-Integer::from(k as u64), Integer::ONE]);
        out = out.times(&factor).plus(&UniPoly::constant(value));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::{discriminant, resultant};

    fn curve(rows: &[&[i64]]) -> Poly<UniPoly> {
        Poly::new(rows.iter().map(|r| UniPoly::from_i64(r)).collect())
    }

    #[test]
    fn equal_to_subresultants() {
        let budget = Budget::unlimited();
        let all = [
            curve(&[&[-4, 0, 1], &[0, 3], &[1]]),
            // The leading coefficients vanish at nodes: x (x - 1) and x - 2.
            curve(&[&[1, 2, 3], &[7], &[-5, 1], &[0, -1, 1]]),
            curve(&[&[1], &[3, 0, 0, 2], &[-2, 1]]),
            curve(&[&[5, 1], &[1]]),
            curve(&[&[0, 1]]),
        ];
        for f in &all {
            for g in &all {
                assert_eq!(resultant_by_values(f, g, &budget), resultant(f, g, &budget));
            }
            if f.degree() > Some(1) {
                let expected = discriminant(f, &budget).unwrap();
                let found = discriminant_by_values(f, &budget).unwrap();
                assert!(found == expected || found == expected.negated());
            }
        }
    }
}
