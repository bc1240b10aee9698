//! The pair of half the degree that describes the boundary.

use super::clock::Clock;
use super::coefficient::Ring;
use num_bigint::BigInt;

/// A polynomial in `x`, coefficients from the constant term up, each a polynomial in the parameter.
pub(super) type InX<P> = Vec<P>;

/// `A`, `B` and their formal degrees, for a characteristic polynomial of degree at least 1.
///
/// Discrete, `D# = z^n D(1/z)`, `x = z + 1/z`: for `n = 2k`, `z^k A = D + D#` and `z^(k-1) (z^2 - 1) B = D - D#`;
/// for `n = 2k + 1`, `z^k (z + 1) A = D + D#` and `z^k (z - 1) B = D - D#`.
/// Continuous, `x = s^2`: `D = A(s^2) + s B(s^2)`.
pub(super) fn pair<P: Ring>(d: &[P], discrete: bool) -> (InX<P>, usize, InX<P>, usize) {
    let n = d.len() - 1;
    let k = n / 2;
    let degree_b = if n.is_multiple_of(2) { k - 1 } else { k };
    if !discrete {
        let part = |from: usize| d.iter().skip(from).step_by(2).cloned().collect();
        return (part(0), k, part(1), degree_b);
    }
    let sum: Vec<P> = (0..=n).map(|i| d[i].plus(&d[n - i])).collect();
    let difference: Vec<P> = (0..=n).map(|i| d[i].minus(&d[n - i])).collect();
    let zero = d[0].zero();
    if n.is_multiple_of(2) {
        // Division by z^2 - 1, from the constant term up: q_i = q_(i-2) - c_i.
        let mut q: Vec<P> = Vec::new();
        for i in 0..n - 1 {
            let before = if i >= 2 { q[i - 2].clone() } else { zero.clone() };
            q.push(before.minus(&difference[i]));
        }
        (in_x(&sum, k), k, in_x(&q, k - 1), degree_b)
    } else {
        let (mut a, mut b): (Vec<P>, Vec<P>) = (Vec::new(), Vec::new());
        for i in 0..n {
            // Division by z + 1: q_i = c_i - q_(i-1); by z - 1: q_i = q_(i-1) - c_i.
            let (before_a, before_b) = (a.last().unwrap_or(&zero).clone(), b.last().unwrap_or(&zero).clone());
            a.push(sum[i].minus(&before_a));
            b.push(before_b.minus(&difference[i]));
        }
        (in_x(&a, k), k, in_x(&b, k), degree_b)
    }
}

/// `z^-m S` in `x` for a symmetric `S` of degree `2m`: takes off `s_2m (z + 1/z)^m`, whose expansion is
/// binomial, and goes on with the rest.
fn in_x<P: Ring>(s: &[P], m: usize) -> InX<P> {
    let mut rest = s.to_vec();
    let mut out = vec![s[0].zero(); m + 1];
    for j in (0..=m).rev() {
        let top = rest[m + j].clone();
        if !top.is_zero() {
            let mut binomial = BigInt::from(1);
            for i in 0..=j {
                let place = m + j - 2 * i;
                rest[place] = rest[place].minus(&top.scaled(&binomial));
                binomial = binomial * BigInt::from(j - i) / BigInt::from(i + 1);
            }
        }
        out[j] = top;
    }
    out
}

/// The product of two polynomials in `x`.
pub(super) fn times<P: Ring>(a: &InX<P>, b: &InX<P>, clock: &Clock) -> Result<InX<P>, String> {
    let (Some(first), false) = (a.first(), b.is_empty()) else { return Ok(Vec::new()) };
    let mut out = vec![first.zero(); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        for (j, y) in b.iter().enumerate().filter(|(_, y)| !y.is_zero()) {
            out[i + j].add(&x.times(y, clock)?);
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::univariate::Uni;
    use num_bigint::BigInt as Z;

    /// `4 D(z) D(1/z) = A^2 + (4 - x^2) B^2`, or `(2 + x) A^2 + (2 - x) B^2`, at `x = 5/2`, `z = 2`.
    #[test]
    fn the_square_identity_holds() {
        for d in [
            vec![3, 1],
            vec![5, -7, 2],
            vec![1, 4, -1, 6],
            vec![2, 0, 3, -5, 7],
            vec![1, 2, 3, 4, 5, 6],
            vec![9, 1, 0, 2, 0, 3, 1],
        ] {
            let n = d.len() - 1;
            let coefficients: Vec<Uni> = d.iter().map(|&c| Uni::constant(Z::from(c))).collect();
            let (a, ka, b, kb) = pair(&coefficients, true);
            assert!(a.len() == ka + 1 && b.len() == kb + 1);
            // All values times a power of 2: x = 5/2, z = 2.
            let at = |c: &InX<Uni>| {
                c.iter()
                    .enumerate()
                    .map(|(k, c)| c.at(0) * Z::from(5).pow(k as u32) * Z::from(2).pow((20 - k) as u32))
                    .sum::<Z>()
            };
            let (va, vb) = (at(&a), at(&b));
            let dz: Z = d.iter().enumerate().map(|(k, &c)| Z::from(c) * Z::from(2).pow(k as u32)).sum();
            let dw: Z = d.iter().enumerate().map(|(k, &c)| Z::from(c) * Z::from(2).pow((n - k) as u32)).sum();
            // 4 D(2) D(1/2) = 4 dz dw / 2^n, with 2^40 on the right.
            let left: Z = Z::from(16) * dz * dw * Z::from(2).pow((40 - n) as u32);
            let right: Z = if n % 2 == 0 {
                Z::from(4) * &va * &va - Z::from(9) * &vb * &vb
            } else {
                Z::from(18) * &va * &va - Z::from(2) * &vb * &vb
            };
            assert_eq!(left, right, "{d:?}");
        }
    }
}
