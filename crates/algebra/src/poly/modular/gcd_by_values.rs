//! Greatest common divisors of polynomials over `Z[x]` through their values at integers `x`.

use crate::limits::checkpoint;
use crate::number::Integer;
use crate::poly::{Domain, Poly, UniPoly};

/// The subresultant sequence is used up to this degree of the smaller polynomial.
pub const VALUES_MIN_DEGREE: usize = 1;

/// [`primitive_gcd_by_values`]; `None` where the subresultant sequence is expected to be faster.
pub(in crate::poly) fn primitive_gcd(a: &Poly<UniPoly>, b: &Poly<UniPoly>) -> Option<Poly<UniPoly>> {
    (a.coeffs().len().min(b.coeffs().len()) > VALUES_MIN_DEGREE + 1).then(|| primitive_gcd_by_values(a, b))
}

/// A greatest common divisor of two non-zero polynomials over `Z[x]` that are primitive, up to sign, by values at
/// integers ([Brown1971](crate::bibliography#brown1971)).
///
/// Where not both leading coefficients vanish, the divisor of the values is never of too low a degree;
/// so values of degree 0 prove that there is no common divisor, and a common divisor of the degree of
/// the values is a greatest one: two divisions prove it. Divided differences of a polynomial over the
/// integers at integers are integers.
///
/// With `d` the degree in `x` this takes `d + 1` divisors over the integers and `O(d^2)` operations for each
/// coefficient.
///
/// # Panics
/// When one of them is zero.
pub fn primitive_gcd_by_values(a: &Poly<UniPoly>, b: &Poly<UniPoly>) -> Poly<UniPoly> {
    let leading = a.leading().expect("not zero").gcd(b.leading().expect("not zero"));
    let degree = |p: &Poly<UniPoly>| p.coeffs().iter().map(|c| c.coeffs().len()).max().unwrap_or(0);
    // The divisor times `leading / lc(divisor)` is what the values interpolate.
    let count = degree(a).min(degree(b)) + leading.coeffs().len();
    let (mut nodes, mut values): (Vec<Integer>, Vec<UniPoly>) = (Vec::new(), Vec::new());
    for k in 0i64.. {
        let x = Integer::from(if k % 2 == 0 { k / 2 } else { -(k + 1) / 2 });
        let scale = leading.eval(&x);
        if scale.is_zero() {
            continue;
        }
        let at = |p: &Poly<UniPoly>| p.map(|c| c.eval(&x)).primitive_part();
        let value = at(a).gcd(&at(b));
        if value.is_constant() {
            return Poly::one();
        }
        let lead = value.leading().expect("not zero").clone();
        if !scale.divisible_by(&lead) {
            continue;
        }
        if let Some(known) = values.first() {
            if value.coeffs().len() > known.coeffs().len() {
                continue;
            }
            if value.coeffs().len() < known.coeffs().len() {
                // All points so far were unlucky.
                nodes.clear();
                values.clear();
            }
        }
        values.push(value.scaled(&scale.div_exact(&lead)));
        nodes.push(x);
        if nodes.len() < count {
            continue;
        }
        if let Some(candidate) = interpolated(&nodes, &values).map(|c| c.primitive_part())
            && Domain::div_exact(a, &candidate).is_some()
            && Domain::div_exact(b, &candidate).is_some()
        {
            return candidate;
        }
        nodes.clear();
        values.clear();
    }
    unreachable!("there are finitely many unlucky points")
}

/// The polynomial over `Z[x]` with these values at the nodes, by Newton's formula; `None` when its
/// coefficients are no integers.
fn interpolated(nodes: &[Integer], values: &[UniPoly]) -> Option<Poly<UniPoly>> {
    let length = values[0].coeffs().len();
    let coefficient = |j: usize| {
        let mut differences: Vec<Integer> = values.iter().map(|v| v.coeff(j)).collect();
        for order in 1..nodes.len() {
            checkpoint(8 * (nodes.len() - order) as u64);
            for i in (order..nodes.len()).rev() {
                let difference = &differences[i] - &differences[i - 1];
                let step = &nodes[i] - &nodes[i - order];
                differences[i] = difference.divisible_by(&step).then(|| difference.div_exact(&step))?;
            }
        }
        let mut out: Vec<Integer> = Vec::new();
        for (node, value) in nodes.iter().zip(differences).rev() {
            // out = out (x - node) + value
            checkpoint(4 * out.len() as u64);
            out.insert(0, value);
            for k in 1..out.len() {
                let (low, high) = out.split_at_mut(k);
                low[k - 1].sub_mul_assign(&high[0], node);
            }
        }
        Some(UniPoly::new(out))
    };
    (0..length).map(coefficient).collect::<Option<Vec<_>>>().map(Poly::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::gcd::primitive_gcd_subresultant;

    fn rows(rows: &[&[i64]]) -> Poly<UniPoly> {
        Poly::new(rows.iter().map(|r| UniPoly::from_i64(r)).collect())
    }

    fn same(a: &Poly<UniPoly>, b: &Poly<UniPoly>) -> bool {
        *a == *b || *a == b.negated()
    }

    /// Products of small factors with leading coefficients that vanish at the first nodes, in all
    /// combinations, against the subresultant sequence.
    #[test]
    fn equal_to_subresultants() {
        let factors = [
            rows(&[&[-4, 0, 1], &[0, 3], &[1]]),
            rows(&[&[1, 2, 3], &[7], &[-5, 1], &[0, -1, 1]]),
            rows(&[&[1], &[3, 0, 0, 2], &[-2, 1]]),
            rows(&[&[5, 1], &[1]]),
            rows(&[&[2, 0, 9], &[0, 1]]),
        ];
        for i in 0..32usize {
            for j in 0..32usize {
                let product = |set: usize| {
                    (0..5).filter(|k| set >> k & 1 == 1).fold(Poly::one(), |p: Poly<UniPoly>, k| p.times(&factors[k]))
                };
                let (a, b) = (product(i), product(j));
                let found = primitive_gcd_by_values(&a, &b).primitive_part();
                assert!(same(&found, &product(i & j).primitive_part()), "{i} {j}: {found:?}");
                assert!(same(&found, &primitive_gcd_subresultant(&a, &b).primitive_part()), "{i} {j}");
            }
        }
    }

    /// `y - x` and `y - x - x (x - 1) (x + 1)` agree at the first three nodes.
    #[test]
    fn unlucky_points_do_not_harm() {
        let common = rows(&[&[1, 1], &[0, 1], &[3, 0, 5]]);
        let a = common.times(&rows(&[&[0, -1], &[1]]));
        let b = common.times(&rows(&[&[0, 0, 0, -1], &[1]]));
        assert!(same(&primitive_gcd_by_values(&a, &b), &common));
        assert_eq!(primitive_gcd_by_values(&rows(&[&[0, -1], &[1]]), &rows(&[&[0, 0, 0, -1], &[1]])), Poly::one());
    }
}
