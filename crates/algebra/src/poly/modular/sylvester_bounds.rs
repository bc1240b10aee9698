//! Bounds of a resultant that see which entries of Sylvester's matrix are small: degree, order at zero, and
//! height.
//!
//! A determinant's terms take one entry of each row and each column, so with any number added to each column the sum of the
//! rows' greatest entries, less what was added, bounds every term. Good numbers come from the Newton polygons: with the
//! concave envelopes `A`, `B` of the entries of both polynomials, `-max (A(i) + B(j))` over `i + j = k` for column `k`.

use super::prime_field::primes_for_bits;
use super::resultant::DensePair;
use crate::number::Integer;

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

/// What is known of a resultant before it is computed.
pub(super) struct Frame {
    /// For each variable the least exponent, and how many there are from that on.
    pub ranges: Vec<(usize, usize)>,
    /// A number that divides all coefficients.
    pub divisor: Integer,
    /// All coefficients, divided by that, are below `2^bits` in magnitude.
    pub bits: u64,
}

/// The bounds are looked for where at least so many products of residues would be computed without them: with fewer they
/// cost what they save.
const MIN_PRODUCTS: usize = 1 << 12;

impl Frame {
    /// `None` where the resultant is zero for certain.
    pub fn new(pair: &DensePair<'_>) -> Option<Frame> {
        let plain = Frame {
            ranges: pair.lengths().into_iter().map(|length| (0, length)).collect(),
            divisor: Integer::ONE,
            bits: pair.height_bits(),
        };
        let products = plain.points() * primes_for_bits(plain.bits) * pair.degrees.0 * pair.degrees.1;
        if products < MIN_PRODUCTS {
            return Some(plain);
        }
        let ranges: Option<Vec<_>> = (0..pair.terms.len()).map(|axis| exponents(pair, axis)).collect();
        let divisor = known_divisor(pair);
        let bits = (height_bits(pair).min(plain.bits) + 1).saturating_sub(divisor.bit_length());
        Some(Frame { ranges: ranges?, divisor, bits })
    }

    /// The number of points of the grid.
    pub fn points(&self) -> usize {
        self.ranges.iter().map(|range| range.1).product()
    }
}

/// The greatest of the weights of the monomials of each coefficient; a weight gets the number of the integer.
fn weights(pair: &DensePair<'_>, weight: impl Fn(usize, &Integer) -> i64) -> [Vec<Option<i64>>; 2] {
    let rows = pair.degrees.0 + pair.degrees.1 + 2;
    let mut out = vec![None; rows];
    for (k, c) in pair.coefficients.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
        let place = &mut out[k % rows];
        *place = (*place).max(Some(weight(k, c) * SCALE));
    }
    let b = out.split_off(pair.degrees.0 + 1);
    [out, b]
}

fn bound(weights: &[Vec<Option<i64>>; 2]) -> Option<i64> {
    Entries { a: &weights[0], b: &weights[1] }.bound().map(|bound| bound.div_euclid(SCALE))
}

/// The least exponent of a variable and the number of exponents from that on; `None` where the resultant is zero.
fn exponents(pair: &DensePair<'_>, axis: usize) -> Option<(usize, usize)> {
    let inner = pair.terms[axis + 1..].iter().product::<usize>() * (pair.degrees.0 + pair.degrees.1 + 2);
    let exponent = |k: usize| (k / inner % pair.terms[axis]) as i64;
    let greatest = bound(&weights(pair, |k, _| exponent(k)))?;
    let least = -bound(&weights(pair, |k, _| -exponent(k)))?;
    (least <= greatest).then(|| (least.max(0) as usize, (greatest - least.max(0)) as usize + 1))
}

/// A number that divides every coefficient of the resultant: its prime factors are small, its exponents those that the
/// valuations of the entries leave no choice about.
fn known_divisor(pair: &DensePair<'_>) -> Integer {
    let (n, m) = pair.degrees;
    // One residue tells for all odd primes at once which of them divide.
    let residues: Vec<u64> = pair.coefficients.iter().map(|c| c.mod_u64(ODD_PRODUCT)).collect();
    let divides = |prime: u64, k: usize| {
        if prime == 2 { pair.coefficients[k].is_even() } else { residues[k].is_multiple_of(prime) }
    };
    let mut divisor = Integer::ONE;
    for prime in DIVIDING_PRIMES {
        // The terms a_n^m b_0^n and a_0^m b_m^n of the determinant are the first that need not be divisible.
        let all = |row: usize| (row..residues.len()).step_by(n + m + 2).all(|k| divides(prime, k));
        if (!all(n) && !all(n + 1)) || (!all(0) && !all(n + m + 1)) {
            continue;
        }
        let valuation = |k: usize, c: &Integer| if divides(prime, k) { valuation(c, prime) } else { 0 };
        if let Some(bound) = bound(&weights(pair, |k, c| -valuation(k, c))) {
            divisor *= Integer::from(prime).pow((-bound).max(0) as u64);
        }
    }
    divisor
}

/// Numbers of three digits, written with a decimal point, have such denominators.
const DIVIDING_PRIMES: [u64; 11] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31];

/// The product of the odd ones.
const ODD_PRODUCT: u64 = 3 * 5 * 7 * 11 * 13 * 17 * 19 * 23 * 29 * 31;

/// How often a prime divides a number that is not zero.
fn valuation(x: &Integer, prime: u64) -> i64 {
    if prime == 2 {
        return x.trailing_zeros().unwrap_or(0) as i64;
    }
    let (mut rest, mut count) = (x.clone(), 0);
    while rest.mod_u64(prime) == 0 {
        rest = rest.div_exact(&Integer::from(prime));
        count += 1;
    }
    count
}

/// `e` such that every coefficient of the resultant is below `2^e` in magnitude: Hadamard's bound
/// ([Hadamard1893](crate::bibliography#hadamard1893)) where all variables have modulus 1, columns first multiplied by powers of
/// two.
fn height_bits(pair: &DensePair<'_>) -> u64 {
    let mut norms_a = pair.norms();
    let norms_b = norms_a.split_off(pair.degrees.0 + 1);
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
    use crate::poly::modular::multimodular_resultant::dense;
    use crate::poly::{Poly, UniPoly, resultant_subresultant};

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
            let (a, b) = (Poly::new(side(degree_a)), Poly::new(side(degree_b)));
            let (Some(n), Some(m)) = (a.degree(), b.degree()) else { continue };
            let pair = dense(&a, n, &b, m);
            let exact = resultant_subresultant(&a, &b, &Budget::unlimited()).unwrap();
            let Some((least, count)) = exponents(&pair, 0) else {
                assert!(exact.coeffs().is_empty());
                continue;
            };
            let greatest = least + count - 1;
            let Some(order) = exact.coeffs().iter().position(|c| !c.is_zero()) else { continue };
            let degree = exact.coeffs().len() - 1;
            let (divisor, bits) = (known_divisor(&pair), height_bits(&pair));
            assert!(least <= order && degree <= greatest, "{least} {order} {degree} {greatest}");
            assert!(exact.coeffs().iter().all(|c| c.divisible_by(&divisor) && c.bit_length() <= bits));
            all += 1;
            let few = exact.coeffs().iter().map(|c| c.bit_length()).max() >= bits.checked_sub(12);
            tight += usize::from(least == order && degree == greatest && few);
        }
        assert!(all > 200 && 2 * tight > all, "{tight} of {all}");
    }
}
