//! Resultants of polynomials whose coefficients are enclosed: determinants of half the size of Sylvester's.

use super::{Ball, Series};
use crate::number::Integer;

/// What determinants of enclosed numbers are made of: balls, series of balls, and the like.
pub trait Enclosed: Clone {
    /// Zero, of the same kind as this value.
    fn nothing(&self) -> Self;
    /// The sum.
    fn plus(&self, other: &Self) -> Self;
    /// The difference.
    fn minus(&self, other: &Self) -> Self;
    /// The product.
    fn times(&self, other: &Self) -> Self;
    /// The quotient; `None` where the divisor may vanish.
    fn over(&self, other: &Self) -> Option<Self>;
    /// Whether it is zero for certain.
    fn is_nothing(&self) -> bool;
    /// How far from zero it is at least; zero where it may vanish.
    fn least(&self) -> Integer;
    /// The sum of products, of the same kind as this value; factors that are zero cost nothing.
    fn sum_of_products<'a>(&self, pairs: impl Iterator<Item = (&'a Self, &'a Self)>) -> Self
    where
        Self: 'a,
    {
        let products = pairs.filter(|(a, b)| !a.is_nothing() && !b.is_nothing()).map(|(a, b)| a.times(b));
        products.reduce(|s, t| s.plus(&t)).unwrap_or_else(|| self.nothing())
    }
}

impl Enclosed for Ball {
    fn nothing(&self) -> Ball {
        Ball::zero(self.bits())
    }
    fn plus(&self, other: &Ball) -> Ball {
        self.add(other)
    }
    fn minus(&self, other: &Ball) -> Ball {
        self.sub(other)
    }
    fn times(&self, other: &Ball) -> Ball {
        self.mul(other)
    }
    fn over(&self, other: &Ball) -> Option<Ball> {
        self.div(other)
    }
    fn is_nothing(&self) -> bool {
        self.is_zero()
    }
    fn least(&self) -> Integer {
        self.least_magnitude_units()
    }
}

impl Enclosed for Series {
    fn nothing(&self) -> Series {
        Series::constant(&Ball::zero(self.coefficients()[0].bits()), self.terms())
    }
    fn plus(&self, other: &Series) -> Series {
        self.add(other)
    }
    fn minus(&self, other: &Series) -> Series {
        self.sub(other)
    }
    fn times(&self, other: &Series) -> Series {
        self.mul(other)
    }
    fn over(&self, other: &Series) -> Option<Series> {
        self.div(other)
    }
    fn is_nothing(&self) -> bool {
        self.coefficients().iter().all(Ball::is_zero)
    }
    fn least(&self) -> Integer {
        self.coefficients()[0].least_magnitude_units()
    }
}

/// The hybrid matrix of Bezout and Sylvester of two polynomials, given by all coefficients for their formal degrees `m >= n`
/// from the constant term up: row `j < n` is Bezout's `a_j x^(m-n) b - a b_j` with `a_j`, `b_j` the leading `j + 1`
/// coefficients, reduced below degree `m`, the other `m - n` rows are shifts of `b`. Columns are the powers of `x` from the
/// highest down. Its determinant is the resultant for the formal degrees up to the sign, and a common root `x` gives the
/// vector `(x^(m-1), .., x, 1)` of its kernel ([DiazTocaGonzalezVega2004](crate::bibliography#diaztocagonzalezvega2004)).
///
/// Cost: `O(m^2 n)` products.
///
/// # Panics
/// When `m < n` or a list is empty.
pub fn hybrid_bezout<R: Enclosed>(a: &[R], b: &[R]) -> Vec<Vec<R>> {
    assert!(!b.is_empty() && a.len() >= b.len(), "the formal degrees descend");
    let (m, n) = (a.len() - 1, b.len() - 1);
    let zero = a[0].nothing();
    let mut rows = Vec::with_capacity(m);
    for j in 0..n {
        // By power of x: (leading part of a) x^(m-n) (tail of b) - (tail of a)(leading part of b).
        let mut row = vec![zero.clone(); m];
        for lead in 0..=j {
            for (tail, coefficient) in b[..n - j].iter().enumerate() {
                let at = lead + tail + (m - n);
                row[at] = row[at].plus(&a[m - j + lead].times(coefficient));
            }
            for (tail, coefficient) in a[..m - j].iter().enumerate() {
                let at = lead + tail;
                row[at] = row[at].minus(&coefficient.times(&b[n - j + lead]));
            }
        }
        row.reverse();
        rows.push(row);
    }
    for shift in 0..m - n {
        let mut row = vec![zero.clone(); m];
        for (k, c) in b.iter().enumerate() {
            row[m - 1 - (k + shift)] = c.clone();
        }
        rows.push(row);
    }
    rows
}

/// The determinant of a square matrix: elimination as long as there is a pivot that certainly does not vanish, and what is
/// left by expansion, without a division.
///
/// Cost: `O(n^3)` products; `n 2^n` where no pivot is certain.
///
/// # Panics
/// When the matrix has no rows.
pub fn determinant_enclosed<R: Enclosed>(mut rows: Vec<Vec<R>>) -> R {
    assert!(!rows.is_empty(), "a matrix with entries");
    let mut product: Option<R> = None;
    let times = |product: Option<R>, x: &R| Some(product.map_or_else(|| x.clone(), |p| p.times(x)));
    let mut negative = false;
    while rows.len() > 1 {
        let n = rows.len();
        // By column from the left, the row whose entry is farthest from zero.
        let best = |column: usize| {
            (0..n)
                .map(|i| (rows[i][column].least(), i))
                .max_by(|x, y| x.0.cmp(&y.0))
                .filter(|(least, _)| !least.is_zero())
        };
        let Some((column, row)) = (0..n).find_map(|column| best(column).map(|(_, row)| (column, row))) else { break };
        negative ^= (column + row) % 2 == 1;
        let pivot_row = rows.remove(row);
        let pivot = &pivot_row[column];
        for other in &mut rows {
            let entry = other.remove(column);
            if entry.is_nothing() {
                continue;
            }
            let factor = entry.over(pivot).expect("the pivot does not vanish");
            let rest = pivot_row.iter().enumerate().filter(|(k, _)| *k != column);
            for (x, (_, y)) in other.iter_mut().zip(rest) {
                if !y.is_nothing() {
                    *x = x.minus(&factor.times(y));
                }
            }
        }
        product = times(product, pivot);
    }
    let rest = determinant_by_minors(&rows);
    let value = product.map_or_else(|| rest.clone(), |p| p.times(&rest));
    if negative { value.nothing().minus(&value) } else { value }
}

/// The determinant by expansion along the rows, each minor of the first rows once.
pub(super) fn determinant_by_minors<R: Enclosed>(rows: &[Vec<R>]) -> R {
    let n = rows.len();
    let zero = rows[0][0].nothing();
    let mut minors: Vec<Option<R>> = vec![None; 1 << n];
    for columns in 1usize..1 << n {
        let row = columns.count_ones() as usize - 1;
        let mut sum: Option<R> = None;
        for column in (0..n).filter(|c| columns >> c & 1 == 1) {
            let entry = &rows[row][column];
            if entry.is_nothing() {
                continue;
            }
            let before = columns & !(1 << column);
            let part = match (before, &minors[before]) {
                (0, _) => entry.clone(),
                (_, Some(minor)) => entry.times(minor),
                (_, None) => continue,
            };
            // The columns after this one are behind it in the last row.
            let is_negative = (before >> column).count_ones() % 2 == 1;
            let sum_so_far = sum.unwrap_or_else(|| zero.clone());
            sum = Some(if is_negative { sum_so_far.minus(&part) } else { sum_so_far.plus(&part) });
        }
        minors[columns] = sum;
    }
    minors.pop().flatten().unwrap_or(zero)
}

/// The resultant of two polynomials for their formal degrees, up to the sign.
///
/// ```
/// use jurist_algebra::ball::{Ball, enclosed_resultant};
/// let list = |c: &[i64]| c.iter().map(|&c| Ball::from_integer(&c.into(), 64)).collect::<Vec<Ball>>();
/// // x^2 - 3 x + 2 and x - 5: (5 - 1)(5 - 2)
/// let value = enclosed_resultant(&list(&[2, -3, 1]), &list(&[-5, 1]));
/// assert!(value.contains(&12.into()) || value.contains(&(-12).into()));
/// ```
///
/// Cost: that of [`hybrid_bezout`] and [`determinant_enclosed`].
///
/// # Panics
/// When a list is empty, or both are constants.
pub fn enclosed_resultant<R: Enclosed>(a: &[R], b: &[R]) -> R {
    let (a, b) = if a.len() >= b.len() { (a, b) } else { (b, a) };
    determinant_enclosed(hybrid_bezout(a, b))
}

/// As [`enclosed_resultant`], by minors: no quotient of wide numbers grows from step to step.
///
/// Cost: `m 2^m` products, `m` the greater degree.
///
/// # Panics
/// When a list is empty, or both are constants.
pub fn enclosed_resultant_by_minors<R: Enclosed>(a: &[R], b: &[R]) -> R {
    let (a, b) = if a.len() >= b.len() { (a, b) } else { (b, a) };
    determinant_by_minors(&hybrid_bezout(a, b))
}

/// The common root of two polynomials that are known to have one, by the kernel of their hybrid matrix; `None` where it is
/// not seen to be the only one.
///
/// Cost: `O(m)` determinants of size `m - 1`.
///
/// # Panics
/// When a list is empty, or both are constants.
pub fn common_root(a: &[Ball], b: &[Ball]) -> Option<Ball> {
    let (a, b) = if a.len() >= b.len() { (a, b) } else { (b, a) };
    if let ([constant, leading], _) = (a, b) {
        let other = (b.len() == 2).then(|| b[0].neg().div(&b[1])).flatten();
        return constant.neg().div(leading).or(other);
    }
    let rows = hybrid_bezout(a, b);
    let size = rows.len();
    // Without one row, the kernel is one line where the minor without the last column does not vanish.
    (0..size).rev().find_map(|left_out| {
        let minor = |column: usize| {
            let kept = rows.iter().enumerate().filter(|(i, _)| *i != left_out);
            let without = |row: &Vec<Ball>| {
                row.iter().enumerate().filter(|(k, _)| *k != column).map(|(_, x)| x.clone()).collect::<Vec<Ball>>()
            };
            determinant_enclosed(kept.map(|(_, row)| without(row)).collect())
        };
        let last = minor(size - 1);
        if last.contains_zero() {
            return None;
        }
        // Neighbouring cofactors have opposite signs.
        minor(size - 2).neg().div(&last)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Budget;
    use crate::number::Rational;
    use crate::poly::{Domain, UniPoly, resultant_formal};

    fn balls(p: &[i64], bits: u64) -> Vec<Ball> {
        p.iter().map(|&c| Ball::from_integer(&c.into(), bits)).collect()
    }

    fn numbers(count: usize, seed: &mut u64) -> Vec<i64> {
        let mut next = || {
            *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*seed >> 59) as i64 - 16
        };
        (0..count).map(|_| next()).collect()
    }

    #[test]
    fn the_determinant_is_the_resultant_for_the_formal_degrees_up_to_the_sign() {
        let mut seed = 7;
        for (m, n) in [(1, 0), (1, 1), (2, 1), (2, 2), (3, 1), (4, 3), (5, 5), (6, 2)] {
            for lost in 0..3 {
                let (mut a, mut b) = (numbers(m + 1, &mut seed), numbers(n + 1, &mut seed));
                match lost {
                    1 => a[m] = 0,
                    2 => b[n] = 0,
                    _ => {}
                }
                let (p, q) = (UniPoly::from_i64(&a), UniPoly::from_i64(&b));
                let expected = resultant_formal(&p, m, &q, n, &Budget::unlimited()).unwrap();
                let found = enclosed_resultant(&balls(&a, 200), &balls(&b, 200));
                let holds = [expected.clone(), expected.negated()].iter().any(|e| found.contains(&Rational::from(e)));
                assert!(holds && found.width_units().bit_length() < 150, "{a:?} {b:?}: {found:?} {expected}");
            }
        }
    }

    #[test]
    fn determinants_by_expansion_are_those_by_elimination() {
        let mut seed = 3;
        for n in 1..7 {
            let rows: Vec<Vec<Ball>> = (0..n).map(|_| balls(&numbers(n, &mut seed), 160)).collect();
            let (x, y) = (determinant_enclosed(rows.clone()), determinant_by_minors(&rows));
            assert!(x.intersection(&y).is_some() && x.union(&y).width_units().bit_length() < 120, "{x:?} {y:?}");
            // No pivot is certain where every entry may vanish; the determinant is enclosed all the same.
            let wide: Vec<Vec<Ball>> = rows.iter().map(|r| r.iter().map(|x| x.union(&x.neg())).collect()).collect();
            let all = determinant_enclosed(wide);
            assert!(all.union(&x) == all, "{n}");
        }
    }

    #[test]
    fn the_common_root_is_found_where_it_is_the_only_one() {
        // (x - 3)(x^2 + 1)(x + 7) and (x - 3)(x - 4)(x + 1)
        let a = UniPoly::from_i64(&[-3, 1]).times(&UniPoly::from_i64(&[1, 0, 1])).times(&UniPoly::from_i64(&[7, 1]));
        let b = UniPoly::from_i64(&[-3, 1]).times(&UniPoly::from_i64(&[-4, 1])).times(&UniPoly::from_i64(&[1, 1]));
        let list = |p: &UniPoly| p.coeffs().iter().map(|c| Ball::from_integer(c, 128)).collect::<Vec<Ball>>();
        let root = common_root(&list(&a), &list(&b)).unwrap();
        assert!(root.contains(&3.into()) && root.width_units().bit_length() < 40);
        assert!(common_root(&balls(&[-6, 2], 64), &balls(&[5], 64)).unwrap().contains(&3.into()));
        // Two in common.
        assert!(common_root(&list(&a.times(&UniPoly::from_i64(&[-9, 1]))), &list(&a)).is_none());
    }
}
