//! The characteristic polynomial of a matrix of rational functions by evaluation modulo primes, or by minors where these are few.

use super::RationalMatrix;
use super::expansion::{SparseRows, Terms};
use super::hessenberg::{determinants_by_elimination, from_hessenberg, invert_and_scale_rows, reduce_to_hessenberg};
use super::rational::least_common_multiple;
use crate::limits::{Budget, Exhausted, claim};
use crate::number::Integer;
use crate::poly::modular::chinese::{Chinese, Limbs};
use crate::poly::modular::grid::Grid;
use crate::poly::modular::prime_field::{PrimeField, primes_for_bits};
use crate::poly::{Domain, Monomial, MultiPoly, Poly};

/// The greatest number of points of a grid; beyond, the recursion of Faddeev and LeVerrier is used.
const MAX_POINTS: usize = 1 << 16;

/// Primes are distributed over the threads when points times cubed order times primes reach
/// this: some milliseconds of work.
const PARALLEL_MIN_PRODUCTS: usize = 1 << 21;

/// One product of terms of minors takes at most as long as so many products of residues (orders 2 to 14, 0 to 6 variables, entries of 8 and of
/// 60 bits: the shorter way whenever there are so many fewer).
const RESIDUES_PER_PRODUCT: usize = 8;

/// As [`characteristic_polynomial_multimodular`], and by minors where a sparse matrix has so few that this is less work.
///
/// Cost: that of the shorter way.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When the matrix is not square.
pub fn characteristic_polynomial_over_rows(
    m: &RationalMatrix,
    budget: &Budget,
) -> Result<Option<(Poly<MultiPoly>, MultiPoly)>, Exhausted> {
    assert!(m.is_square(), "the characteristic polynomial of a square matrix");
    budget.enter(|| {
        Rows::new(m).map(|rows| {
            let most = rows.residues() / RESIDUES_PER_PRODUCT;
            rows.by_minors(most).unwrap_or_else(|| rows.characteristic())
        })
    })
}

/// `(P, d)` with `det(zI - M) = P / d`, where `d` is the product of the least common denominators of the
/// rows; `None` when the parameters would need too large a grid.
///
/// With row `i` brought to the denominator `q_i`, `P = det(z Q - N)` for `Q = diag(q_i)`. Its degrees are at most
/// the sums over the rows (or columns) of the greatest degrees, its coefficients at most the product of the
/// Euclidean lengths of the rows (or columns), every entry replaced by the sum of the magnitudes of its
/// coefficients ([Hadamard1893](crate::bibliography#hadamard1893) on the torus of parameters of modulus 1). `Q^-1 N` is reduced to the form of
/// Hessenberg at each point of a grid modulo each prime, `O(n^3)` products of residues, and where `Q` is
/// singular there, determinants are interpolated in `z`: no point and no prime is unlucky.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When the matrix is not square.
pub fn characteristic_polynomial_multimodular(
    m: &RationalMatrix,
    budget: &Budget,
) -> Result<Option<(Poly<MultiPoly>, MultiPoly)>, Exhausted> {
    assert!(m.is_square(), "the characteristic polynomial of a square matrix");
    budget.enter(|| Rows::new(m).map(|rows| rows.characteristic()))
}

/// A matrix `Q^-1 N` in rows, only entries that are not zero.
struct Rows {
    n: usize,
    /// Row, column and numerator.
    entries: Vec<(usize, usize, MultiPoly)>,
    denominators: Vec<MultiPoly>,
    /// The variables that occur, the exponents of each in the entries (one more than the degree), and
    /// in the result.
    variables: Vec<usize>,
    terms: Vec<usize>,
    lengths: Vec<usize>,
}

impl Rows {
    fn new(m: &RationalMatrix) -> Option<Rows> {
        let n = m.rows();
        let mut entries = Vec::new();
        let mut denominators = Vec::with_capacity(n);
        for i in 0..n {
            let row = (0..n).map(|j| &m[(i, j)]).filter(|e| !e.is_zero());
            let denominator = row.fold(MultiPoly::one(), |q, e| least_common_multiple(&q, e.denominator()));
            for j in 0..n {
                let entry = &m[(i, j)];
                if !entry.is_zero() {
                    let factor = denominator.div_exact(entry.denominator()).expect("a common multiple");
                    entries.push((i, j, entry.numerator().times(&factor)));
                }
            }
            denominators.push(denominator);
        }
        let mut rows = Rows { n, entries, denominators, variables: Vec::new(), terms: Vec::new(), lengths: Vec::new() };
        rows.bound_degrees()?;
        Some(rows)
    }

    fn bound_degrees(&mut self) -> Option<()> {
        let all = || self.entries.iter().map(|(_, _, p)| p).chain(&self.denominators);
        let count = all().map(|p| p.degrees().len()).max().unwrap_or(0);
        let mut points = 1usize;
        let (mut variables, mut terms, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
        for v in 0..count {
            let degree = |p: &MultiPoly| p.degree_in(v) as usize;
            let mut by_row: Vec<usize> = self.denominators.iter().map(degree).collect();
            let mut by_column = by_row.clone();
            for (i, j, p) in &self.entries {
                by_row[*i] = by_row[*i].max(degree(p));
                by_column[*j] = by_column[*j].max(degree(p));
            }
            let greatest = by_row.iter().copied().max().unwrap_or(0);
            if greatest > 0 {
                let length = by_row.iter().sum::<usize>().min(by_column.iter().sum()) + 1;
                points = points.checked_mul(length).filter(|&p| p <= MAX_POINTS)?;
                variables.push(v);
                terms.push(greatest + 1);
                lengths.push(length);
            }
        }
        (self.variables, self.terms, self.lengths) = (variables, terms, lengths);
        Some(())
    }

    /// `e` such that every coefficient of `det(z Q - N)` is below `2^e` in magnitude.
    fn height_bits(&self) -> u64 {
        let norm = |p: &MultiPoly| p.terms().iter().fold(Integer::ZERO, |sum, (_, c)| sum + c.abs());
        let n = self.n;
        let mut norms = vec![Integer::ZERO; n * n];
        for (i, j, p) in &self.entries {
            norms[i * n + j] = norm(p);
        }
        for (i, q) in self.denominators.iter().enumerate() {
            norms[i * n + i] += norm(q);
        }
        let bits = |index: &dyn Fn(usize, usize) -> usize| {
            let mut product = Integer::ONE;
            for i in 0..n {
                let mut square = Integer::ZERO;
                for norm in (0..n).map(|j| &norms[index(i, j)]).filter(|norm| !norm.is_zero()) {
                    square.add_mul_assign(norm, norm);
                }
                product *= square;
            }
            product.bit_length().div_ceil(2)
        };
        bits(&|i, j| i * n + j).min(bits(&|i, j| j * n + i))
    }

    fn characteristic(&self) -> (Poly<MultiPoly>, MultiPoly) {
        if self.n == 0 {
            return (Poly::one(), MultiPoly::one());
        }
        let width = self.entries.len() + self.n;
        static ZERO: Integer = Integer::ZERO;
        let mut coefficients = vec![&ZERO; self.terms.iter().product::<usize>() * width];
        let polynomials = self.entries.iter().map(|(_, _, p)| p).chain(&self.denominators);
        for (k, p) in polynomials.enumerate() {
            for (monomial, c) in p.terms() {
                let variables = self.variables.iter().zip(&self.terms);
                let place = variables.fold(0, |place, (&v, &terms)| place * terms + monomial.exponent(v) as usize);
                coefficients[place * width + k] = c;
            }
        }
        let limbs = Limbs::new(coefficients);
        let chinese = Chinese::for_bits(self.height_bits());
        let points: usize = self.lengths.iter().product();
        let image = |f: &PrimeField| self.image(f, limbs.residues(f));
        let products = (points * chinese.fields().len()).saturating_mul(self.n.pow(3));
        let images: Vec<Vec<u64>> = chinese.images(products >= PARALLEL_MIN_PRODUCTS, image);
        let stride = self.n + 1;
        let places = (0..points * stride).rev().filter(|&at| images.iter().any(|image| image[at] != 0));
        self.fraction(places.map(|at| (at, chinese.integer(images.iter().map(|image| image[at])))))
    }

    /// `P / d` from the terms of `P` by place, descending: the exponents of the variables, then that of `z`.
    fn fraction(&self, descending: impl Iterator<Item = (usize, Integer)>) -> (Poly<MultiPoly>, MultiPoly) {
        let stride = self.n + 1;
        let mut exponents = vec![0u32; self.variables.last().map_or(0, |last| last + 1)];
        let mut terms: Vec<Vec<(Monomial, Integer)>> = vec![Vec::new(); stride];
        for (at, c) in descending {
            let mut rest = at / stride;
            for (&v, &length) in self.variables.iter().zip(&self.lengths).rev() {
                exponents[v] = u32::try_from(rest % length).expect("degrees stay below 2^32");
                rest /= length;
            }
            terms[at % stride].push((Monomial::new(&exponents), c));
        }
        let characteristic = Poly::new(terms.into_iter().map(MultiPoly::from_descending).collect());
        let denominator = self.denominators.iter().fold(MultiPoly::one(), |d, q| d.times(q));
        (characteristic, denominator)
    }

    /// About how many products of residues [`Rows::characteristic`] takes.
    fn residues(&self) -> usize {
        let points: usize = self.lengths.iter().product();
        points.saturating_mul(self.n.pow(3)).saturating_mul(primes_for_bits(self.height_bits()))
    }

    /// By minors; `None` where that takes more than so many products of terms.
    fn by_minors(&self, most: usize) -> Option<(Poly<MultiPoly>, MultiPoly)> {
        let stride = self.n + 1;
        let points: usize = self.lengths.iter().product();
        let place = |monomial: &Monomial| {
            let variables = self.variables.iter().zip(&self.lengths);
            variables.fold(0, |place, (&v, &length)| place * length + monomial.exponent(v) as usize) * stride
        };
        // z Q - N
        let mut rows: Vec<Vec<(usize, Terms)>> = vec![Vec::new(); self.n];
        for (i, j, p) in &self.entries {
            rows[*i].push((*j, p.terms().iter().map(|(monomial, c)| (place(monomial), -c)).collect()));
        }
        for (i, q) in self.denominators.iter().enumerate() {
            let with_z = q.terms().iter().map(|(monomial, c)| (place(monomial) + 1, c.clone()));
            match rows[i].iter_mut().find(|(j, _)| *j == i) {
                Some((_, terms)) => terms.extend(with_z),
                None => rows[i].push((i, with_z.collect())),
            }
        }
        let matrix = SparseRows(rows);
        let plan = matrix.plan(most)?;
        Some(self.fraction(matrix.determinant(&plan, points * stride).into_iter().rev()))
    }

    /// The coefficients modulo one prime: `lengths` by `n + 1` powers of `z`.
    fn image(&self, f: &PrimeField, mut data: Vec<u64>) -> Vec<u64> {
        let (n, width) = (self.n, self.entries.len() + self.n);
        let mut grid = Grid::new(f, self.lengths.iter().copied().max().unwrap_or(1).max(n + 1));
        let scale = self.divide_by_numbers(f, &mut grid, &mut data);
        let mut inner = width;
        for (&terms, &length) in self.terms.iter().zip(&self.lengths).rev() {
            data = grid.evaluate(&data, terms, inner, length);
            inner *= length;
        }
        let mut out = self.at_points(f, &grid, &data, scale);
        let mut inner = n + 1;
        for &length in self.lengths.iter().rev() {
            grid.interpolate(&mut out, length, inner);
            inner *= length;
        }
        out
    }

    /// Divides rows whose denominator is a number other than zero here; the product of these numbers.
    fn divide_by_numbers(&self, f: &PrimeField, grid: &mut Grid, data: &mut [u64]) -> u64 {
        let (n, count) = (self.n, self.entries.len());
        let mut numbers = vec![0; n];
        for (i, q) in self.denominators.iter().enumerate().filter(|(_, q)| q.is_constant()) {
            debug_assert!(!q.is_zero());
            numbers[i] = data[count + i];
        }
        let mut inverses = numbers.clone();
        inverses.push(grid.factorial());
        f.invert_all(&mut inverses);
        grid.prepare_interpolation(inverses[n]);
        for block in data.chunks_exact_mut(count + n) {
            for (x, (i, _, _)) in
                block.iter_mut().zip(&self.entries).filter(|(x, (i, _, _))| **x != 0 && numbers[*i] != 0)
            {
                *x = f.mul(*x, inverses[*i]);
            }
        }
        for i in (0..n).filter(|&i| numbers[i] != 0) {
            data[count + i] = f.one();
        }
        numbers.iter().filter(|&&x| x != 0).fold(f.one(), |product, &x| f.mul(product, x))
    }

    /// The coefficients at points, from the values of entries and denominators there.
    fn at_points(&self, f: &PrimeField, grid: &Grid, data: &[u64], scale: u64) -> Vec<u64> {
        let (n, count) = (self.n, self.entries.len());
        let points = data.len() / (count + n);
        claim(8 * (points * n * n) as u64);
        let mut matrices = vec![0; points * n * n];
        for (values, matrix) in data.chunks_exact(count + n).zip(matrices.chunks_exact_mut((n * n).max(1))) {
            for (&x, (i, j, _)) in values.iter().zip(&self.entries) {
                matrix[i * n + j] = x;
            }
        }
        let mut diagonals: Vec<u64> =
            data.chunks_exact(count + n).flat_map(|values| values[count..].iter().copied()).collect();
        let mut out = vec![0; points * (n + 1)];
        let mut factors = vec![scale; points];
        let mut regular = Vec::with_capacity(points);
        for (point, diagonal) in diagonals.chunks_exact(n).enumerate() {
            if diagonal.contains(&0) {
                // Where a denominator vanishes the determinants are interpolated.
                let matrix = &matrices[point * n * n..(point + 1) * n * n];
                let values = &mut out[point * (n + 1)..(point + 1) * (n + 1)];
                determinants_by_elimination(f, matrix, diagonal, &grid.points()[..=n], values);
                grid.interpolate(values, n + 1, 1);
            } else {
                let with = |product, &q| if q == f.one() { product } else { f.mul(product, q) };
                factors[point] = diagonal.iter().fold(scale, with);
                regular.push(point);
            }
        }
        invert_and_scale_rows(f, &mut matrices, &mut diagonals, n, &regular);
        reduce_to_hessenberg(f, &mut matrices, n, &regular);
        let mut room = Vec::new();
        for &point in &regular {
            let matrix = &matrices[point * n * n..(point + 1) * n * n];
            from_hessenberg(f, matrix, n, &mut room, &mut out[point * (n + 1)..(point + 1) * (n + 1)]);
        }
        for (values, &factor) in out.chunks_exact_mut(n + 1).zip(&factors) {
            for v in values {
                *v = f.mul(*v, factor);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::RationalFunction;

    /// Sparse to full, entries of up to three terms in three variables, some with a denominator.
    #[test]
    fn minors_and_residues_agree() {
        let mut state = 5u64;
        let mut next = |limit: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % limit
        };
        let mut lost = 0;
        for round in 0..60 {
            let (n, sparse) = ((round % 6) as usize, 1 + round % 4);
            let m = RationalMatrix::from_fn(n, n, |_, _| {
                if next(1 + sparse) > 1 {
                    return RationalFunction::zero();
                }
                let term = |next: &mut dyn FnMut(u64) -> u64| {
                    let exponents = vec![next(3) as u32, next(2) as u32, next(2) as u32];
                    (exponents, Integer::from(next(19) as i64 - 9).pow(1 + next(20)))
                };
                let terms: Vec<_> = (0..1 + next(3)).map(|_| term(&mut next)).collect();
                let below = MultiPoly::variable(next(3) as usize).plus(&MultiPoly::from(next(3) as i64));
                let below = if next(5) == 0 { below } else { MultiPoly::from(1 + next(9) as i64) };
                RationalFunction::new(MultiPoly::from_terms(terms), below).expect("not zero")
            });
            let rows = Rows::new(&m).expect("a small grid");
            assert_eq!(rows.by_minors(usize::MAX), Some(rows.characteristic()), "{m:?}");
            lost += usize::from(rows.by_minors(1).is_none());
        }
        assert!(lost > 40, "most take more than one product");
    }
}
