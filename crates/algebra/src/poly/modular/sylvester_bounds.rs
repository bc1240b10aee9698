//! Bounds of a resultant over `Z[x]` that see which entries of Sylvester's matrix are small: degree, order at zero, and
//! height.
//!
//! A determinant's terms take one entry of each row and each column, so with any number added to each column the sum of the
//! rows' greatest entries, less what was added, bounds every term. Good numbers come from the Newton polygons: with the
//! concave envelopes `A`, `B` of the entries of both polynomials, `-max (A(i) + B(j))` over `i + j = k` for column `k`.

use crate::number::Integer;
use crate::poly::UniPoly;

/// Weights are multiplied by this, so that the values of the envelopes lose little in integers.
const SCALE: i64 = 64;

/// The entries of the two polynomials of Sylvester's matrix, from the constant term up; `None` for zero.
struct Entries<'e> {
    a: &'e [Option<i64>],
    b: &'e [Option<i64>],
}

impl Entries<'_> {
    fn columns(&self) -> usize {
        self.a.len() + self.b.len() - 2
    }

    /// What to add to each column.
    fn potentials(&self) -> Vec<i64> {
        let (a, b) = (envelope(self.a), envelope(self.b));
        let mut out = vec![None; self.columns() + 1];
        for (i, x) in a.iter().enumerate() {
            for (j, y) in b.iter().enumerate() {
                if let (Some(x), Some(y)) = (x, y) {
                    out[i + j] = out[i + j].max(Some(x + y));
                }
            }
        }
        out.truncate(self.columns());
        out.into_iter().map(|m| -m.unwrap_or(0)).collect()
    }

    /// An upper bound of the sum of entries of any term of the determinant; `None` if a row is zero.
    fn greatest(&self, potentials: &[i64]) -> Option<i64> {
        let mut sum = -potentials.iter().sum::<i64>();
        for (row, shifts) in [(self.a, self.b.len() - 1), (self.b, self.a.len() - 1)] {
            for shift in 0..shifts {
                sum += row.iter().zip(&potentials[shift..]).filter_map(|(w, c)| w.map(|w| w + c)).max()?;
            }
        }
        Some(sum)
    }

    fn bound(&self) -> Option<i64> {
        self.greatest(&self.potentials())
    }
}

/// The least concave function above the given values; `None` outside of them.
fn envelope(values: &[Option<i64>]) -> Vec<Option<i64>> {
    let mut hull: Vec<(i64, i64)> = Vec::new();
    for (k, y) in values.iter().enumerate().filter_map(|(k, y)| y.map(|y| (k as i64, y))) {
        while let [.., p, q] = hull[..]
            && (q.1 - p.1) * (k - q.0) <= (y - q.1) * (q.0 - p.0)
        {
            hull.pop();
        }
        hull.push((k, y));
    }
    let mut out = vec![None; values.len()];
    for pair in hull.windows(2) {
        let ((k0, y0), (k1, y1)) = (pair[0], pair[1]);
        for k in k0..=k1 {
            out[k as usize] = Some(y0 + ((y1 - y0) * (k - k0)).div_euclid(k1 - k0));
        }
    }
    if let [(k, y)] = hull[..] {
        out[k as usize] = Some(y);
    }
    out
}

fn weights(side: &[UniPoly], weight: impl Fn(&[Integer]) -> Option<i64>) -> Vec<Option<i64>> {
    side.iter().map(|c| weight(c.coeffs()).map(|w| w * SCALE)).collect()
}

/// The least exponent and the greatest that the resultant can have, given the coefficients of both polynomials from the constant
/// term up; `None` where it is zero.
pub(super) fn exponents(a: &[UniPoly], b: &[UniPoly]) -> Option<(usize, usize)> {
    let degree = |c: &[Integer]| c.iter().rposition(|x| !x.is_zero()).map(|k| k as i64);
    let order = |c: &[Integer]| c.iter().position(|x| !x.is_zero()).map(|k| -(k as i64));
    let greatest = Entries { a: &weights(a, degree), b: &weights(b, degree) }.bound()?.div_euclid(SCALE);
    let least = -Entries { a: &weights(a, order), b: &weights(b, order) }.bound()?.div_euclid(SCALE);
    (least <= greatest).then(|| (least.max(0) as usize, greatest as usize))
}

/// A number that divides every coefficient of the resultant: its prime factors are small, its exponents those that the
/// valuations of the entries leave no choice about.
pub(super) fn known_divisor(a: &[UniPoly], b: &[UniPoly]) -> Integer {
    let mut divisor = Integer::ONE;
    for prime in DIVIDING_PRIMES {
        let valuation = |c: &[Integer]| c.iter().filter_map(|x| valuation(x, prime)).min().map(|v| -v);
        if let Some(bound) = (Entries { a: &weights(a, valuation), b: &weights(b, valuation) }).bound() {
            divisor *= Integer::from(prime).pow((-bound.div_euclid(SCALE)).max(0) as u64);
        }
    }
    divisor
}

/// Numbers of three digits, written with a decimal point, have such denominators.
const DIVIDING_PRIMES: [u64; 11] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31];

/// How often a prime divides; `None` for zero.
fn valuation(x: &Integer, prime: u64) -> Option<i64> {
    if prime == 2 {
        return x.trailing_zeros().map(|v| v as i64);
    }
    if x.is_zero() {
        return None;
    }
    let (mut rest, mut count) = (x.clone(), 0);
    while rest.mod_u64(prime) == 0 {
        rest = rest.div_exact(&Integer::from(prime));
        count += 1;
    }
    Some(count)
}

/// `e` such that every coefficient of the resultant is below `2^e` in magnitude: Hadamard's bound
/// ([Hadamard1893](crate::bibliography#hadamard1893)) on the circle `|x| = 1`, columns first multiplied by powers of two.
pub(super) fn height_bits(a: &[UniPoly], b: &[UniPoly]) -> u64 {
    let norms = |side: &[UniPoly]| -> Vec<Integer> {
        side.iter().map(|c| c.coeffs().iter().fold(Integer::ZERO, |sum, x| sum + x.abs())).collect()
    };
    let (norms_a, norms_b) = (norms(a), norms(b));
    let bits = |norms: &[Integer]| -> Vec<Option<i64>> {
        norms.iter().map(|c| (!c.is_zero()).then_some(c.bit_length() as i64 * SCALE)).collect()
    };
    let potentials = Entries { a: &bits(&norms_a), b: &bits(&norms_b) }.potentials();
    let shifts: Vec<i64> = potentials.iter().map(|c| c.div_euclid(SCALE)).collect();
    let lowest = shifts.iter().copied().min().unwrap_or(0);
    let mut square = Integer::ONE;
    for (norms, rows) in [(&norms_a, norms_b.len() - 1), (&norms_b, norms_a.len() - 1)] {
        for row in 0..rows {
            let sum = norms.iter().zip(&shifts[row..]).fold(Integer::ZERO, |mut sum, (c, shift)| {
                let c = c << (shift - lowest) as u64;
                sum.add_mul_assign(&c, &c);
                sum
            });
            square *= sum;
        }
    }
    let added = shifts.iter().map(|s| s - lowest).sum::<i64>() as u64;
    square.bit_length().div_ceil(2).saturating_sub(added)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Budget;
    use crate::poly::{Poly, resultant_subresultant};

    /// Random polynomials, thin at their ends as those of sampled plants are: the bounds hold, and most often they are reached.
    #[test]
    fn exponents_divisor_and_height_bound_the_resultant() {
        let mut state = 5u64;
        let mut next = |below: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % below
        };
        let (mut all, mut tight) = (0, 0);
        for _ in 0..300 {
            let (slope, units, degree_a, degree_b) = (next(3), next(4), 1 + next(4), 1 + next(4));
            let mut side = |degree: u64| -> Vec<UniPoly> {
                let mut coefficients: Vec<UniPoly> = (0..=degree)
                    .map(|k| {
                        let order = slope * (degree - k);
                        let length = order + 1 + next(3);
                        let terms = (0..length).map(|e| {
                            let c = Integer::from(next(19) as i64 - 9) * Integer::from(6).pow(units * k);
                            if e < order { Integer::ZERO } else { c }
                        });
                        UniPoly::new(terms.collect())
                    })
                    .collect();
                while coefficients.last().is_some_and(|c| c.coeffs().is_empty()) {
                    coefficients.pop();
                }
                coefficients
            };
            let (a, b) = (side(degree_a), side(degree_b));
            if a.is_empty() || b.is_empty() {
                continue;
            }
            let exact =
                resultant_subresultant(&Poly::new(a.clone()), &Poly::new(b.clone()), &Budget::unlimited()).unwrap();
            let Some((least, greatest)) = exponents(&a, &b) else {
                assert!(exact.coeffs().is_empty());
                continue;
            };
            let Some(order) = exact.coeffs().iter().position(|c| !c.is_zero()) else { continue };
            let degree = exact.coeffs().len() - 1;
            let (divisor, bits) = (known_divisor(&a, &b), height_bits(&a, &b));
            assert!(least <= order && degree <= greatest, "{least} {order} {degree} {greatest}");
            assert!(exact.coeffs().iter().all(|c| c.divisible_by(&divisor) && c.bit_length() <= bits));
            all += 1;
            let few = exact.coeffs().iter().map(|c| c.bit_length()).max() >= bits.checked_sub(12);
            tight += usize::from(least == order && degree == greatest && few);
        }
        assert!(all > 200 && 2 * tight > all, "{tight} of {all}");
    }
}
