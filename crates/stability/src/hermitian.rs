//! The leading principal minors of the Hermitian matrix of a polynomial with complex coefficients: all are positive where the polynomial is stable, and
//! only there. In discrete time it is the matrix of Schur and Cohn, in continuous time that of Hermite, to which Bilharz gave the determinants.

use super::conditions::solve_positive;
use super::interval_set::{cells, merge_points, zeros_in};
use super::{ClassicalTest, Condition, Inequality, IntervalSet, ParametricPolynomial, Range, ScaledPoly, Shape, Table};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, Poly, UniPoly};

/// A complex number as its real and its imaginary part.
type Complex<R> = [R; 2];

/// A matrix by its rows.
type Rows<R> = Vec<Vec<Complex<R>>>;

/// The minors of order 1 to `n` of a polynomial of formal degree `n`, by the real and the imaginary parts of its coefficients.
///
/// With coefficients `a_k` the matrix of the unit disc has the entries
/// `sum over k of a_(n-i+k) conj(a_(n-j+k)) - conj(a_(i-k)) a_(j-k)`, `i` and `j` from 1 on. That of the left half plane has the coefficients of
/// `(D(x) conj(D(y)) - conj(D(-conj x)) D(-conj y))/(2 (x + conj y))`, the highest powers first.
///
/// Cost: an elimination without fractions, `O(n^3)` products; a minor that is zero makes each later one an elimination of its own.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Integer;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::{Shape, hermitian_minors};
/// // z^2 - j z/2, times 2
/// let (re, im) = (UniPoly::from_i64(&[0, 0, 2]), UniPoly::from_i64(&[0, -1]));
/// let minors = hermitian_minors(&re, &im, 2, Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// assert_eq!(minors, [4, 12].map(Integer::from)); // |a_2|^2 - |a_0|^2; the second is |a_2|^2 (|a_2|^2 - |a_1|^2)
/// // s + 3 - 4j
/// let (re, im) = (UniPoly::from_i64(&[3, 1]), UniPoly::from_i64(&[-4]));
/// let minors = hermitian_minors(&re, &im, 1, Shape::LeftHalfPlane, &Budget::unlimited()).unwrap();
/// assert_eq!(minors, [3].map(Integer::from));
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn hermitian_minors<R: Domain>(
    re: &Poly<R>,
    im: &Poly<R>,
    n: usize,
    region: Shape,
    budget: &Budget,
) -> Result<Vec<R>, Exhausted> {
    let a: Vec<Complex<R>> = (0..=n).map(|k| [re.coeff(k), im.coeff(k)]).collect();
    let matrix = match region {
        Shape::UnitDisc => schur_cohn(&a),
        Shape::LeftHalfPlane => hermite(&a),
    };
    budget.enter(|| leading_minors(matrix))
}

/// The conditions of a loop with complex coefficients: that the leading principal minors of its Hermitian matrix are positive, each solved exactly over
/// `range`, and the intersection. `p` has the loop's poles, and the coefficients have been multiplied by `below`.
///
/// Cost: isolation of the real zeros of each minor.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn hermitian_test(
    minors: Vec<UniPoly>,
    below: &UniPoly,
    p: &ParametricPolynomial,
    range: &Range,
    budget: &Budget,
) -> Result<ClassicalTest, Exhausted> {
    let order = minors.len();
    let poles = p.poles().iter().chain([p.denominator()]);
    let poles = poles.map(|pole| zeros_in(pole, range, budget)).collect::<Result<Vec<_>, _>>()?;
    let mut intersection: IntervalSet = cells(range, &merge_points(poles, budget)?).into_iter().collect();
    let square = Rational::from(below.coeff(0).pow(2));
    let scale = Rational::ONE.checked_div(&square).filter(|_| below.is_constant()).unwrap_or(Rational::ONE);
    let mut conditions = Vec::with_capacity(order);
    let mut power = Rational::ONE;
    for (k, polynomial) in minors.into_iter().enumerate() {
        budget.step(&format!("condition {}", k + 1));
        power *= &scale;
        let solution = solve_positive(&polynomial, range, budget)?;
        intersection = intersection.intersection(&solution);
        let inequality = Inequality::Positive(ScaledPoly { scale: power.clone(), polynomial });
        conditions.push(Condition { name: minor_name(k), inequality, solution });
    }
    Ok(ClassicalTest {
        table: Table::Hermitian(order),
        scales: Vec::new(),
        cleared_by: (!below.is_constant()).then(|| below.clone()),
        conditions,
        intersection,
    })
}

/// The condition on the minor of this number, from 0 on.
pub(crate) fn minor_name(k: usize) -> String {
    format!("H_{} > 0", k + 1)
}

fn schur_cohn<R: Domain>(a: &[Complex<R>]) -> Rows<R> {
    let n = a.len() - 1;
    let entry = |i: usize, j: usize| {
        let term = |sum: Complex<R>, k: usize| {
            let more = times_conjugate(&a[n - i + k], &a[n - j + k]);
            minus(&plus(&sum, &more), &times_conjugate(&a[j - k], &a[i - k]))
        };
        (1..=i.min(j)).fold(zero(), term)
    };
    (1..=n).map(|i| (1..=n).map(|j| entry(i, j)).collect()).collect()
}

fn hermite<R: Domain>(a: &[Complex<R>]) -> Rows<R> {
    let n = a.len() - 1;
    let mut h: Rows<R> = vec![vec![zero(); n]; n];
    for p in 0..n {
        for q in 1..=n {
            let [re, im] = times_conjugate(&a[p], &a[q]);
            let own = if (p + q) % 2 == 1 { [re, R::zero()] } else { [R::zero(), im] };
            h[p][q - 1] = match p.checked_sub(1).filter(|_| q < n) {
                Some(before) => minus(&own, &h[before][q]),
                None => own,
            };
        }
    }
    h.iter_mut().for_each(|row| row.reverse());
    h.reverse();
    h
}

/// Leading principal minors are real, and so are the pivots of an elimination without exchanges.
fn leading_minors<R: Domain>(matrix: Rows<R>) -> Vec<R> {
    let n = matrix.len();
    let mut rows = matrix.clone();
    let mut minors: Vec<R> = Vec::with_capacity(n);
    for k in 0..n {
        let pivot = rows[k][k][0].clone();
        let is_zero = pivot.is_zero();
        minors.push(pivot);
        if is_zero {
            minors.extend((k + 2..=n).map(|size| determinant(&matrix, size)));
            break;
        }
        eliminate(&mut rows, k, &[minors[k].clone(), R::zero()], &before(&minors, k));
    }
    minors
}

/// The pivot before the `k`-th.
fn before<R: Domain>(minors: &[R], k: usize) -> Complex<R> {
    let last = k.checked_sub(1).map_or_else(R::one, |k| minors[k].clone());
    [last, R::zero()]
}

/// The determinant of a leading part of a Hermitian matrix, with exchanges of rows.
fn determinant<R: Domain>(matrix: &Rows<R>, size: usize) -> R {
    let mut rows: Rows<R> = matrix[..size].iter().map(|row| row[..size].to_vec()).collect();
    let (mut last, mut is_negative) = ([R::one(), R::zero()], false);
    for k in 0..size {
        let Some(found) = (k..size).find(|i| !is_zero(&rows[*i][k])) else { return R::zero() };
        is_negative ^= found != k;
        rows.swap(k, found);
        let pivot = rows[k][k].clone();
        eliminate(&mut rows, k, &pivot, &last);
        last = pivot;
    }
    let [re, _] = last;
    if is_negative { re.negated() } else { re }
}

/// A step of the elimination without fractions: all later entries are divided by the pivot before, which leaves no remainder.
fn eliminate<R: Domain>(rows: &mut Rows<R>, k: usize, pivot: &Complex<R>, before: &Complex<R>) {
    let n = rows.len();
    let below = rows.split_off(k + 1);
    let first = &rows[k];
    let changed = below.into_iter().map(|mut row| {
        for j in k + 1..n {
            let cross = minus(&times(pivot, &row[j]), &times(&row[k], &first[j]));
            row[j] = quotient(&cross, before);
        }
        row
    });
    let changed: Rows<R> = changed.collect();
    rows.extend(changed);
}

fn zero<R: Domain>() -> Complex<R> {
    [R::zero(), R::zero()]
}

fn is_zero<R: Domain>(x: &Complex<R>) -> bool {
    x.iter().all(R::is_zero)
}

fn plus<R: Domain>(x: &Complex<R>, y: &Complex<R>) -> Complex<R> {
    [x[0].plus(&y[0]), x[1].plus(&y[1])]
}

fn minus<R: Domain>(x: &Complex<R>, y: &Complex<R>) -> Complex<R> {
    [x[0].minus(&y[0]), x[1].minus(&y[1])]
}

fn times<R: Domain>(x: &Complex<R>, y: &Complex<R>) -> Complex<R> {
    [x[0].times(&y[0]).minus(&x[1].times(&y[1])), x[0].times(&y[1]).plus(&x[1].times(&y[0]))]
}

fn times_conjugate<R: Domain>(x: &Complex<R>, y: &Complex<R>) -> Complex<R> {
    times(x, &[y[0].clone(), y[1].negated()])
}

/// The quotient of two numbers; the second divides the first.
fn quotient<R: Domain>(x: &Complex<R>, y: &Complex<R>) -> Complex<R> {
    let (above, below) = match y[1].is_zero() {
        true => (x.clone(), y[0].clone()),
        false => (times_conjugate(x, y), times_conjugate(y, y)[0].clone()),
    };
    above.map(|part| part.div_exact(&below).expect("an elimination without fractions leaves no remainder"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::Integer;

    fn minors(re: &[i64], im: &[i64], n: usize, region: Shape) -> Vec<i64> {
        let (re, im) = (UniPoly::from_i64(re), UniPoly::from_i64(im));
        let found = hermitian_minors(&re, &im, n, region, &Budget::unlimited()).unwrap();
        found.iter().map(|m: &Integer| m.to_i64().unwrap()).collect()
    }

    /// `z^2 + a z + b` has its roots inside for `|b| < 1` and `|a - conj(a) b| < 1 - |b|^2`, times powers of 2 and 4.
    #[test]
    fn a_polynomial_of_second_order_by_hand() {
        // a = 1/2 + j/2, b = j/4: |a - conj(a) b|^2 = |3/8 + 3j/8|^2 = 9/32; (1 - 1/16)^2 - 9/32 = 153/256
        assert_eq!(minors(&[0, 2, 4], &[1, 2], 2, Shape::UnitDisc), [15, 153]);
        // b = j: conj(a) b = a, and both minors are zero.
        assert_eq!(minors(&[0, 2, 4], &[4, 2], 2, Shape::UnitDisc), [0, 0]);
    }

    /// Of real coefficients they are Hurwitz' determinants, up to earlier ones: `s^3 + 2 s^2 + 3 s + 1`.
    #[test]
    fn real_coefficients_in_continuous_time() {
        // a_2 a_3; then a_2 (a_2 a_1 - a_3 a_0) and a_0 times that square.
        let found = minors(&[1, 3, 2, 1], &[], 3, Shape::LeftHalfPlane);
        assert!(found.iter().all(|m| *m > 0), "{found:?}");
        assert!(minors(&[7, 3, 2, 1], &[], 3, Shape::LeftHalfPlane).iter().any(|m| *m <= 0));
    }
}
