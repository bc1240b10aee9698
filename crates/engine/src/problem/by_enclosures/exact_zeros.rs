//! Exact factors of the numerator of an open loop behind holds.
//!
//! With `B = e c` the coefficient of `K` in `det(z I - A - K B)` is, up to its sign, the determinant of `z I - A` bordered by `e` and `c`,
//! Rosenbrock's system matrix. Laplace's expansion along the rational rows shows that the greatest common divisor of their maximal minors
//! divides this determinant. The divisor contains the zeros of a discrete controller, such as the `z + 1` of Tustin's rule.

use jurist_algebra::limits::checkpoint;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, RationalFunction, UniPoly};

/// Products of a matrix and a column with more products of terms are not looked at.
const MOST_TERMS: usize = 20_000;

/// A row of the pencil: polynomials in `z`.
type Row = Vec<UniPoly>;

/// The place of the first entry that is not zero, row by row.
pub(super) fn first_entry(m: &RationalMatrix) -> Option<(usize, usize)> {
    let columns = m.columns();
    (0..m.rows() * columns).map(|at| (at / columns, at % columns)).find(|&at| !m[at].is_zero())
}

/// A factor of the coefficient of `K` in `det(z I - A - K B)`, with integer coefficients, for an `n x n` matrix `B` of rank one.
///
/// Cost: Euclid's algorithm between the columns of the rational rows, at most `n + 1` of `n + 1` entries.
pub(super) fn exact_zeros(a: &RationalMatrix, b: &RationalMatrix) -> UniPoly {
    let n = a.rows();
    let numbers = |row: &mut dyn Iterator<Item = &RationalFunction>| {
        row.map(RationalFunction::as_constant).collect::<Option<Vec<Rational>>>()
    };
    let Some(pivot) = first_entry(b) else { return UniPoly::one() };
    // c is 1 at the pivot, so that e is the pivot's column.
    let c = (0..n).map(|j| b[(pivot.0, j)].checked_div(&b[pivot])?.as_constant()).collect::<Option<Vec<Rational>>>();
    let Some(c) = c else { return UniPoly::one() };
    let mut rows: Vec<Row> = Vec::new();
    for i in 0..n {
        let (Some(own), Some(e)) = (numbers(&mut (0..n).map(|j| &a[(i, j)])), b[(i, pivot.1)].as_constant()) else {
            continue;
        };
        let mut row: Vec<[Rational; 2]> = own.iter().map(|x| [-x, Rational::ZERO]).collect();
        row[i][1] = Rational::ONE;
        row.push([e, Rational::ZERO]);
        rows.push(integral(row));
    }
    rows.push(integral(c.into_iter().chain([Rational::ZERO]).map(|x| [x, Rational::ZERO]).collect()));
    common_factor(rows)
}

/// `n - 1` less the degree of the coefficient of `K`, for a matrix `B` of rank one: the number of Markov parameters `c e`, `c A e`, .. that are
/// zero before the first other one.
///
/// Cost: products of the matrix and a vector over symbols.
pub(super) fn missing_degrees(a: &RationalMatrix, b: &RationalMatrix) -> usize {
    let n = a.rows();
    let Some(pivot) = first_entry(b) else { return 0 };
    let dot = |row: &mut dyn Iterator<Item = &RationalFunction>, v: &[RationalFunction]| {
        row.zip(v).fold(RationalFunction::zero(), |sum, (x, y)| &sum + &(x * y))
    };
    let mut v: Vec<RationalFunction> = (0..n).map(|i| b[(i, pivot.1)].clone()).collect();
    for found in 0..n {
        if !dot(&mut (0..n).map(|j| &b[(pivot.0, j)]), &v).is_zero() {
            return found;
        }
        // A bound from below is enough, and long products take long: with alternating edges at ten samples they did not end.
        let terms = |f: &RationalFunction| f.numerator().terms().len() + f.denominator().terms().len();
        let (length, of_matrix) = (v.iter().map(terms).sum::<usize>(), a.entries().iter().map(terms).sum::<usize>());
        if length * of_matrix > MOST_TERMS {
            return found + 1;
        }
        checkpoint((length * of_matrix) as u64);
        v = (0..n).map(|i| dot(&mut (0..n).map(|j| &a[(i, j)]), &v)).collect();
    }
    0
}

/// The row of the pencil with these constant and linear coefficients, times a common denominator.
fn integral(row: Vec<[Rational; 2]>) -> Row {
    let common = row.iter().flatten().fold(Integer::ONE, |l, x| l.lcm(&x.denominator()));
    let whole = |x: &Rational| x.numerator() * common.div_exact(&x.denominator());
    row.iter().map(|entry| UniPoly::new(entry.iter().map(whole).collect())).collect()
}

/// The greatest common divisor of the maximal minors, up to a number; 1 where all of them are zero.
///
/// Column operations keep it up to a number. Euclid's algorithm between columns makes the matrix lower triangular, so that only one maximal
/// minor is left: the product of the diagonal.
fn common_factor(mut rows: Vec<Row>) -> UniPoly {
    let columns = rows.first().map_or(0, Vec::len);
    let mut product = UniPoly::one();
    for at in 0..rows.len() {
        loop {
            let filled = |j: &usize| !rows[at][*j].is_zero();
            let Some(least) = (at..columns).filter(filled).min_by_key(|&j| rows[at][j].degree()) else {
                return UniPoly::one();
            };
            rows.iter_mut().for_each(|row| row.swap(at, least));
            let others: Vec<usize> = (at + 1..columns).filter(|&j| !rows[at][j].is_zero()).collect();
            if others.is_empty() {
                break;
            }
            for j in others {
                reduce(&mut rows, at, j);
            }
        }
        product = product.times(&rows[at][at]);
    }
    product.primitive_part()
}

/// Replaces column `j` by a multiple of it less a multiple of column `at`: row `at` keeps the pseudo-remainder.
fn reduce(rows: &mut [Row], at: usize, j: usize) {
    let divisor = rows[at][at].clone();
    let (q, _) = rows[at][j].pseudo_div_rem(&divisor);
    let steps = (rows[at][j].coeffs().len() + 1).saturating_sub(divisor.coeffs().len());
    let scale = divisor.leading().expect("a filled entry").pow(steps as u64);
    let changed: Vec<UniPoly> = rows.iter().map(|row| row[j].scaled(&scale).minus(&row[at].times(&q))).collect();
    let content = changed.iter().fold(Integer::ZERO, |g, p| g.gcd(&p.content()));
    for (row, p) in rows.iter_mut().zip(changed) {
        row[j] =
            if content.is_zero() { p } else { Poly::new(p.coeffs().iter().map(|c| c.div_exact(&content)).collect()) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[&str]]) -> RationalMatrix {
        let entry = |i: usize, j: usize| {
            let (number, symbol) = rows[i][j].split_once('x').unwrap_or((rows[i][j], ""));
            let number = if number.is_empty() { Rational::ONE } else { number.trim().parse().unwrap() };
            let symbol = symbol.parse().map_or_else(|_| RationalFunction::one(), RationalFunction::variable);
            &RationalFunction::from(number) * &symbol
        };
        RationalMatrix::from_fn(rows.len(), rows.len(), entry)
    }

    /// A plant of one state behind the controller `(z + 1)(2 z - 1)/(z - 1)^2`: its zeros are those of the loop.
    #[test]
    fn zeros_of_a_controller_are_exact() {
        // w1+ = w1 + w2, w2+ = w2 - y, u = 2 (w1 + ..) as 2 + 5/(z - 1) + 2/(z - 1)^2.
        let a = matrix(&[&["1", "1", "0"], &["0", "1", "-1"], &["0", "0", "x0"]]);
        let b = matrix(&[&["0", "0", "0"], &["0", "0", "0"], &["2", "5", "-2"]]);
        assert_eq!(exact_zeros(&a, &b), UniPoly::from_i64(&[-1, 1, 2]));
        // As a factor of the row a symbol belongs to e.
        let b = matrix(&[&["0", "0", "0"], &["0", "0", "0"], &["x1", "5/2 x1", "-1 x1"]]);
        assert_eq!(exact_zeros(&a, &b), UniPoly::from_i64(&[-1, 1, 2]));
        assert_eq!(missing_degrees(&a, &b), 0);
        // With the input a sample late the degree is less by one.
        let late =
            matrix(&[&["1", "1", "0", "0"], &["0", "1", "-1", "0"], &["0", "0", "x0", "x1"], &["0", "0", "0", "0"]]);
        let b_late =
            matrix(&[&["0", "0", "0", "0"], &["0", "0", "0", "0"], &["0", "0", "0", "0"], &["2", "5", "-2", "0"]]);
        assert_eq!((missing_degrees(&late, &b_late), exact_zeros(&late, &b_late)), (1, UniPoly::from_i64(&[-1, 1, 2])));
        // Where c has symbols nothing is known.
        let b = matrix(&[&["0", "0", "0"], &["0", "0", "0"], &["x1", "5", "-2"]]);
        assert_eq!(exact_zeros(&a, &b), UniPoly::one());
    }
}
