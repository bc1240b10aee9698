//! Characteristic polynomials of matrices modulo a prime, many matrices of one size at a time.
//!
//! Matrices are stored row by row, one after the other; `which` lists those that are meant.

use crate::limits::{checkpoint, claim};
use crate::poly::modular::prime_field::PrimeField;

/// In matrices of at least this size rows are counted one by one.
const COUNTED_SIZE: usize = 64;

/// Divides row `i` of each matrix by entry `i` of its diagonal, none of which is zero.
pub(super) fn invert_and_scale_rows(
    f: &PrimeField,
    matrices: &mut [u64],
    diagonals: &mut [u64],
    n: usize,
    which: &[usize],
) {
    if diagonals.iter().all(|&q| q == f.one()) {
        return;
    }
    f.invert_all(diagonals);
    for &point in which {
        let matrix = &mut matrices[point * n * n..(point + 1) * n * n];
        for (row, &inverse) in matrix.chunks_exact_mut(n).zip(&diagonals[point * n..]) {
            if inverse != f.one() {
                for x in row.iter_mut().filter(|x| **x != 0) {
                    *x = f.mul(*x, inverse);
                }
            }
        }
    }
}

/// Similarity transformations to zeros below the first subdiagonal: `O(n^3)` products for each
/// matrix. The matrices advance together, so that one inversion serves all of them.
pub(super) fn reduce_to_hessenberg(f: &PrimeField, matrices: &mut [u64], n: usize, which: &[usize]) {
    let mut pivots = vec![0; which.len()];
    for k in 1..n.saturating_sub(1) {
        checkpoint((which.len() * n) as u64);
        // The pivot is brought to row k, column k - 1; zero means that nothing is left to do there.
        for (&point, pivot) in which.iter().zip(&mut pivots) {
            let matrix = &mut matrices[point * n * n..(point + 1) * n * n];
            *pivot = 0;
            let Some(last) = (k..n).rev().find(|&i| matrix[i * n + k - 1] != 0) else { continue };
            if last == k {
                continue;
            }
            if matrix[k * n + k - 1] == 0 {
                for j in 0..n {
                    matrix.swap(k * n + j, last * n + j);
                }
                for row in matrix.chunks_exact_mut(n) {
                    row.swap(k, last);
                }
            }
            *pivot = matrix[k * n + k - 1];
        }
        f.invert_all(&mut pivots);
        for (&point, &inverse) in which.iter().zip(&pivots).filter(|(_, inverse)| **inverse != 0) {
            if n < COUNTED_SIZE {
                checkpoint((n * n) as u64);
            }
            eliminate(f, &mut matrices[point * n * n..(point + 1) * n * n], n, k, inverse);
        }
    }
}

/// Clears column `k - 1` below row `k`.
fn eliminate(f: &PrimeField, matrix: &mut [u64], n: usize, k: usize, inverse: u64) {
    for i in k + 1..n {
        let entry = matrix[i * n + k - 1];
        if entry == 0 {
            continue;
        }
        if n >= COUNTED_SIZE {
            checkpoint(n as u64 / 2);
        }
        let factor = f.mul(entry, inverse);
        let negated = f.negated(factor);
        let (above, below) = matrix.split_at_mut(i * n);
        for (x, &y) in below[k - 1..n].iter_mut().zip(&above[k * n + k - 1..(k + 1) * n]) {
            if y != 0 {
                *x = f.add(*x, f.mul(negated, y));
            }
        }
        for row in matrix.chunks_exact_mut(n) {
            if row[i] != 0 {
                row[k] = f.add(row[k], f.mul(factor, row[i]));
            }
        }
    }
}

/// `det(zI - H)` for a matrix in the form of Hessenberg into `out`, from the constant term up, by the
/// characteristic polynomials of its leading blocks; `room` is reused.
pub(super) fn from_hessenberg(f: &PrimeField, h: &[u64], n: usize, room: &mut Vec<u64>, out: &mut [u64]) {
    // Row k holds the polynomial of the leading block of size k.
    let width = n + 1;
    room.clear();
    claim(8 * (width * width) as u64);
    room.resize(width * width, 0);
    room[0] = f.one();
    for k in 1..=n {
        if n >= COUNTED_SIZE {
            checkpoint((k * k / 8) as u64);
        }
        let (known, rest) = room.split_at_mut(k * width);
        let current = &mut rest[..=k];
        let previous = &known[(k - 1) * width..(k - 1) * width + k];
        let diagonal = f.negated(h[(k - 1) * n + k - 1]);
        current[1..].copy_from_slice(previous);
        if diagonal != 0 {
            for (x, &y) in current.iter_mut().zip(previous) {
                *x = f.add(*x, f.mul(diagonal, y));
            }
        }
        let mut product = f.one();
        for i in (1..k).rev() {
            product = f.mul(product, h[i * n + i - 1]);
            if product == 0 {
                break;
            }
            let entry = h[(i - 1) * n + k - 1];
            if entry == 0 {
                continue;
            }
            let factor = f.negated(f.mul(product, entry));
            for (x, &y) in current.iter_mut().zip(&known[(i - 1) * width..(i - 1) * width + i]) {
                *x = f.add(*x, f.mul(factor, y));
            }
        }
    }
    out.copy_from_slice(&room[n * width..]);
}

/// `det(z diag(q) - N)` for each `z` in `points`, by elimination.
pub(super) fn determinants_by_elimination(
    f: &PrimeField,
    numerator: &[u64],
    diagonal: &[u64],
    points: &[u64],
    out: &mut [u64],
) {
    let n = diagonal.len();
    for (&z, value) in points.iter().zip(out) {
        let mut m: Vec<u64> = numerator.iter().map(|&x| f.negated(x)).collect();
        for (i, &q) in diagonal.iter().enumerate() {
            m[i * n + i] = f.add(m[i * n + i], f.mul(z, q));
        }
        *value = determinant(f, &mut m, n);
    }
}

fn determinant(f: &PrimeField, m: &mut [u64], n: usize) -> u64 {
    let mut product = f.one();
    for k in 0..n {
        let Some(pivot) = (k..n).find(|&i| m[i * n + k] != 0) else { return 0 };
        if pivot != k {
            for j in 0..n {
                m.swap(k * n + j, pivot * n + j);
            }
            product = f.negated(product);
        }
        product = f.mul(product, m[k * n + k]);
        let inverse = f.inverse(m[k * n + k]);
        for i in k + 1..n {
            let factor = f.negated(f.mul(m[i * n + k], inverse));
            if factor == 0 {
                continue;
            }
            if n >= COUNTED_SIZE {
                checkpoint(n as u64 / 4);
            }
            let (above, below) = m.split_at_mut(i * n);
            for (x, &y) in below[k..n].iter_mut().zip(&above[k * n + k..(k + 1) * n]) {
                *x = f.add(*x, f.mul(factor, y));
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::modular::grid::Grid;
    use crate::poly::modular::prime_field::largest_primes;

    /// Against determinants, modulo primes so small that every pivot vanishes now and then.
    #[test]
    fn hessenberg_and_determinants_agree() {
        let mut state = 9u64;
        for f in [PrimeField::new(11).unwrap(), PrimeField::new(13).unwrap(), largest_primes(1)[0]] {
            for n in 0..8usize {
                let mut grid = Grid::new(&f, n + 1);
                grid.prepare_interpolation(f.inverse(grid.factorial()));
                let count = 30;
                let mut next = |limit: u64| {
                    state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    f.residue((state >> 20) % limit)
                };
                let matrices: Vec<u64> = (0..count * n * n).map(|k| next(2 + (k as u64 % 3) * 5)).collect();
                let which: Vec<usize> = (0..count).filter(|k| k % 4 != 1).collect();
                let mut reduced = matrices.clone();
                reduce_to_hessenberg(&f, &mut reduced, n, &which);
                for &k in &which {
                    let at = k * n * n..(k + 1) * n * n;
                    let mut got = vec![0; n + 1];
                    from_hessenberg(&f, &reduced[at.clone()], n, &mut Vec::new(), &mut got);
                    let mut expected = vec![0; n + 1];
                    let identity = vec![f.one(); n];
                    determinants_by_elimination(&f, &matrices[at], &identity, grid.points(), &mut expected);
                    grid.interpolate(&mut expected, n + 1, 1);
                    assert_eq!(got, expected, "n = {n} modulo {}", f.prime());
                }
                for k in (0..count).filter(|k| k % 4 == 1) {
                    assert_eq!(reduced[k * n * n..(k + 1) * n * n], matrices[k * n * n..(k + 1) * n * n]);
                }
            }
        }
    }
}
