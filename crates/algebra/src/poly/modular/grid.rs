//! Values of polynomials on grids of small integers modulo a prime, and interpolation from them.

use super::prime_field::PrimeField;
use crate::limits::{checkpoint, claim};

/// Work of so many steps is counted by row; less is counted at once, which costs nothing beside it.
const LONG: usize = 1 << 16;

fn is_long(steps: usize) -> bool {
    steps >= LONG
}

/// The grid `0..lengths[0] x 0..lengths[1] x ...` together with the tables of one prime; or, on all axes, from another
/// first point on.
///
/// Data over a grid are stored with the last axis fastest. The prime must exceed every length.
pub struct Grid<'a> {
    field: &'a PrimeField,
    /// The forms of neighbouring integers.
    points: Vec<u64>,
    /// The forms of 1/0!, 1/1!, ...
    inverse_factorials: Vec<u64>,
}

impl<'a> Grid<'a> {
    /// For axes of at most `longest` points; interpolation needs [`Grid::prepare_interpolation`] first.
    ///
    /// # Panics
    /// When the prime is not above the number of points.
    pub fn new(field: &'a PrimeField, longest: usize) -> Self {
        Self::starting_at(field, 0, longest)
    }

    /// The same with another point in place of 0.
    ///
    /// # Panics
    /// When the prime is not above the number of points.
    pub fn starting_at(field: &'a PrimeField, first: u64, longest: usize) -> Self {
        assert!((longest as u64) < field.prime(), "the points are distinct modulo the prime");
        let mut points = Vec::with_capacity(longest);
        let mut point = field.residue(first);
        for _ in 0..longest {
            points.push(point);
            point = field.add(point, field.one());
        }
        Grid { field, points, inverse_factorials: Vec::new() }
    }

    /// The factorial of the number of points less one, whose inverse [`Grid::prepare_interpolation`] takes: so the
    /// caller can invert it together with other elements.
    pub fn factorial(&self) -> u64 {
        let f = self.field;
        let (mut product, mut number) = (f.one(), f.one());
        for _ in 2..self.points.len() {
            number = f.add(number, f.one());
            product = f.mul(product, number);
        }
        product
    }

    /// Makes the tables of interpolation from the inverse of [`Grid::factorial`].
    pub fn prepare_interpolation(&mut self, inverse_factorial: u64) {
        let f = self.field;
        let mut inverse = inverse_factorial;
        let mut number = f.residue(self.points.len() as u64);
        self.inverse_factorials = vec![inverse; self.points.len()];
        for place in self.inverse_factorials.iter_mut().rev() {
            *place = inverse;
            number = f.sub(number, f.one());
            inverse = f.mul(inverse, number);
        }
    }

    /// The integers modulo the prime.
    pub fn field(&self) -> &'a PrimeField {
        self.field
    }

    /// The points in the form of the field.
    pub fn points(&self) -> &[u64] {
        &self.points
    }

    /// Replaces coefficients by values along one axis.
    ///
    /// `data` has the shape `outer x terms x inner`, the terms being the coefficients of the powers
    /// from the constant up; the result has the shape `outer x count x inner`. A step costs one
    /// addition for each term: the polynomials are continued by their differences.
    pub fn evaluate(&self, data: &[u64], terms: usize, inner: usize, count: usize) -> Vec<u64> {
        let f = self.field;
        let outer = data.len() / (terms * inner);
        claim(8 * (outer * count * inner + terms * inner) as u64);
        let mut out = vec![0; outer * count * inner];
        let direct = terms.min(count);
        let mut differences = vec![0; terms * inner];
        let by_row = is_long(terms * inner * count);
        for (coefficients, values) in data.chunks_exact(terms * inner).zip(out.chunks_exact_mut(count * inner)) {
            if !by_row {
                checkpoint((terms * inner * count / 4) as u64);
            }
            for (row, &x) in values.chunks_exact_mut(inner).zip(&self.points).take(direct) {
                if by_row {
                    checkpoint((terms * inner / 4) as u64);
                }
                row.copy_from_slice(&coefficients[(terms - 1) * inner..]);
                for c in coefficients.chunks_exact(inner).rev().skip(1) {
                    for (v, &c) in row.iter_mut().zip(c) {
                        *v = f.add(f.mul(*v, x), c);
                    }
                }
            }
            if count <= terms {
                continue;
            }
            // The backward differences at the last point: of order 0, 1, ..., terms - 1.
            differences.copy_from_slice(&values[..terms * inner]);
            for order in 1..terms {
                if by_row {
                    checkpoint(((terms - order) * inner / 8) as u64);
                }
                for k in 0..terms - order {
                    for i in 0..inner {
                        let at = k * inner + i;
                        differences[at] = f.sub(differences[at + inner], differences[at]);
                    }
                }
            }
            for row in values.chunks_exact_mut(inner).skip(terms) {
                if by_row {
                    checkpoint((terms * inner / 8) as u64);
                }
                for k in 1..terms {
                    for i in 0..inner {
                        let at = k * inner + i;
                        differences[at] = f.add(differences[at], differences[at - inner]);
                    }
                }
                row.copy_from_slice(&differences[(terms - 1) * inner..]);
            }
        }
        out
    }

    /// Replaces values by coefficients along one axis of data of the shape `outer x count x inner`:
    /// the inverse of [`Grid::evaluate`] with as many terms as points, by Newton's differences.
    pub fn interpolate(&self, data: &mut [u64], count: usize, inner: usize) {
        for block in data.chunks_exact_mut(count * inner) {
            if inner == 1 { self.interpolate_line(block) } else { self.interpolate_block(block, count, inner) }
        }
    }

    fn interpolate_line(&self, v: &mut [u64]) {
        let f = self.field;
        let n = v.len();
        // Both triangles.
        let by_level = is_long(n * n);
        if !by_level {
            checkpoint((n * n / 4) as u64);
        }
        for level in 1..n {
            if by_level {
                checkpoint((n - level) as u64 / 2);
            }
            let mut previous = v[level - 1];
            for x in &mut v[level..] {
                let current = *x;
                *x = f.sub(current, previous);
                previous = current;
            }
        }
        for (x, &inverse) in v.iter_mut().zip(&self.inverse_factorials).skip(2) {
            *x = f.mul(*x, inverse);
        }
        let from = usize::from(self.points.first() == Some(&0));
        for level in (from..n.saturating_sub(1)).rev() {
            let point = self.points[level];
            for j in level..n - 1 {
                v[j] = f.sub(v[j], f.mul(point, v[j + 1]));
            }
        }
    }

    fn interpolate_block(&self, v: &mut [u64], n: usize, inner: usize) {
        let f = self.field;
        // Both triangles.
        let by_level = is_long(n * n * inner);
        if !by_level {
            checkpoint((n * n * inner / 4) as u64);
        }
        for level in 1..n {
            if by_level {
                checkpoint(((n - level) * inner / 2) as u64);
            }
            for k in (level..n).rev() {
                let (before, current) = v[(k - 1) * inner..(k + 1) * inner].split_at_mut(inner);
                for (x, &y) in current.iter_mut().zip(before.iter()) {
                    *x = f.sub(*x, y);
                }
            }
        }
        for (row, &inverse) in v.chunks_exact_mut(inner).zip(&self.inverse_factorials).skip(2) {
            for x in row {
                *x = f.mul(*x, inverse);
            }
        }
        let from = usize::from(self.points.first() == Some(&0));
        for level in (from..n.saturating_sub(1)).rev() {
            let point = self.points[level];
            for j in level..n - 1 {
                let (current, next) = v[j * inner..(j + 2) * inner].split_at_mut(inner);
                for (x, &y) in current.iter_mut().zip(next.iter()) {
                    *x = f.sub(*x, f.mul(point, y));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::prime_field::largest_primes;
    use super::*;

    #[test]
    fn values_and_coefficients() {
        let f = largest_primes(1)[0];
        let shapes = [(1, 1, 1), (1, 5, 1), (2, 2, 3), (3, 4, 2), (1, 12, 1), (2, 7, 1)];
        for (first, (outer, terms, inner)) in [0, 1, 7].into_iter().flat_map(|first| shapes.map(|shape| (first, shape)))
        {
            let mut grid = Grid::starting_at(&f, first, 12);
            grid.prepare_interpolation(f.inverse(grid.factorial()));
            assert_eq!(grid.points()[2], f.residue(first + 2));
            let data: Vec<u64> =
                (0..outer * terms * inner).map(|k| f.residue((k * k * 977 + 31 * k + 5) as u64)).collect();
            for count in [1, 2, terms, 12] {
                let values = grid.evaluate(&data, terms, inner, count);
                for o in 0..outer {
                    for k in 0..count {
                        for i in 0..inner {
                            let c = |j: usize| data[(o * terms + j) * inner + i];
                            let expected = (0..terms).rev().fold(0, |v, j| f.add(f.mul(v, grid.points()[k]), c(j)));
                            assert_eq!(values[(o * count + k) * inner + i], expected);
                        }
                    }
                }
                if count >= terms {
                    let mut back = values;
                    grid.interpolate(&mut back, count, inner);
                    for o in 0..outer {
                        for j in 0..count * inner {
                            let expected = if j < terms * inner { data[o * terms * inner + j] } else { 0 };
                            assert_eq!(back[o * count * inner + j], expected);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_small_prime_suffices_for_few_points() {
        let f = PrimeField::new(7).unwrap();
        let mut grid = Grid::new(&f, 6);
        grid.prepare_interpolation(f.inverse(grid.factorial()));
        let data: Vec<u64> = [3, 1, 4, 1, 5, 2].map(|c| f.residue(c)).to_vec();
        let mut values = grid.evaluate(&data, 6, 1, 6);
        grid.interpolate(&mut values, 6, 1);
        assert_eq!(values, data);
    }
}
