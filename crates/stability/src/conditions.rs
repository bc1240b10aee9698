//! The classical conditions on the parameter, each solved to its own exact solution set: Jury's in
//! discrete time, Routh's in continuous time.

use super::interval_set::{cells, merge_points, zeros_in};
use super::{
    IntervalSet, JuryTable, ParametricPolynomial, Range, RouthTable, Shape, UNDIVIDED_ORDER, jury_table_with,
    routh_table,
};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, UniPoly};

/// A strict inequality between polynomials in the parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Inequality {
    /// `f > 0`.
    Positive(ScaledPoly),
    /// `|left| > |right|`.
    Dominates {
        /// The entry that has to be larger in magnitude.
        left: ScaledPoly,
        /// The entry that has to be smaller in magnitude.
        right: ScaledPoly,
    },
}

/// A polynomial with rational coefficients: a positive rational times an integer polynomial.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledPoly {
    /// The positive factor.
    pub scale: Rational,
    /// The integer polynomial.
    pub polynomial: UniPoly,
}

/// One condition with its exact solution set in the parameter's range.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, classical_test};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let test = classical_test(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// let condition = &test.conditions[2];
/// assert_eq!(condition.name, "|a_0| < a_1"); // |K - 1| < 1
/// assert!(condition.solution.contains(&1.into()) && !condition.solution.contains(&2.into()));
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Condition {
    /// The condition in the field's notation, e.g. `|b_0| > |b_5|`.
    pub name: String,
    /// The inequality it stands for.
    pub inequality: Inequality,
    /// Where it holds.
    pub solution: IntervalSet,
}

/// The table of a loop with one parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Table {
    /// Discrete time.
    Jury(JuryTable<UniPoly>),
    /// Continuous time.
    Routh(RouthTable<UniPoly>),
    /// None, of a loop with complex coefficients: its conditions are on the minors of a Hermitian matrix of this order.
    Hermitian(usize),
}

/// The classical test of a loop with one parameter: table, conditions, their intersection.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, classical_test};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let test = classical_test(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// assert_eq!(test.conditions.len(), 3);
/// assert_eq!(test.intersection.intervals().len(), 1); // 0 < K < 2
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ClassicalTest {
    /// The table, each row up to the positive factor in `scales`.
    pub table: Table,
    /// What each row has to be multiplied by to be the textbook's.
    pub scales: Vec<Rational>,
    /// What the coefficients were multiplied by to clear denominators that depend on the parameter.
    pub cleared_by: Option<UniPoly>,
    /// The conditions in their usual order.
    pub conditions: Vec<Condition>,
    /// Where all conditions hold and the loop is defined.
    pub intersection: IntervalSet,
}

/// Builds the table of `p`, solves each condition exactly over `range`, and intersects.
///
/// The intersection is the stable set, found without the boundary polynomials: the two ways are
/// each other's oracle.
///
/// Jury's conditions are those of [JuryBlanchard1961](jurist_algebra::bibliography#juryblanchard1961), Routh's
/// those of [Routh1877](jurist_algebra::bibliography#routh1877) without fractions.
///
/// Cost: a table, `O(n^2)` operations on polynomials in the parameter, and isolation of the real zeros of two
/// polynomials for each row of Jury's, of one for each of Routh's. With coefficients of degree `d` the textbook's
/// rows of Jury, printed up to order 8, reach degree `2^(n-2) d`; solved are divided rows, of degree `2 i d` in row
/// `i`. So this way is slower than [`stable_set`](super::stable_set), and its oracle.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, classical_test, stable_set};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let (all, budget) = (Range::all(), Budget::unlimited());
/// let test = classical_test(&p, &all, Shape::UnitDisc, &budget).unwrap();
/// let set = stable_set(&p, &all, Shape::UnitDisc, &budget).unwrap();
/// assert!(test.intersection.same_as(&set.to_interval_set().unwrap()));
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn classical_test(
    p: &ParametricPolynomial,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<ClassicalTest, Exhausted> {
    let n = p.formal_degree();
    let (base, scale) = without_content(p);
    budget.step("the table");
    let (table, scales, inequalities) = match region {
        Shape::UnitDisc => jury_inequalities(&base, n, scale, budget)?,
        Shape::LeftHalfPlane => routh_inequalities(&base, n, scale, budget)?,
    };
    let mut conditions = Vec::with_capacity(inequalities.len());
    let poles = p.poles().iter().chain([p.denominator()]);
    let poles = poles.map(|pole| zeros_in(pole, range, budget)).collect::<Result<Vec<_>, _>>()?;
    let poles = merge_points(poles, budget)?;
    // A polynomial without conditions (order 0) is stable where it is not zero.
    let mut intersection: IntervalSet = if n == 0 {
        solve_positive(&base.coeff(0).times(&base.coeff(0)), range, budget)?
    } else {
        cells(range, &[]).into_iter().collect()
    };
    intersection = intersection.intersection(&cells(range, &poles).into_iter().collect());
    // The textbook's rows have factors that earlier rows solve at a fraction of the degree.
    let divided = match &table {
        Table::Jury(table) if !table.is_divided() => Some(budget.enter(|| jury_table_with(&base, n, true))?),
        _ => None,
    };
    for (i, (name, inequality)) in inequalities.into_iter().enumerate() {
        budget.step(&format!("condition {}", i + 1));
        let row = i.checked_sub(VALUE_CONDITIONS).and_then(|row| Some((divided.as_ref()?, row)));
        let known = row.map(|(table, row)| solve_divided_row(table, row, range, budget)).transpose()?.flatten();
        let solution = known.map_or_else(|| solve(&inequality, range, budget), Ok)?;
        intersection = intersection.intersection(&solution);
        conditions.push(Condition { name, inequality, solution });
    }
    Ok(ClassicalTest {
        table,
        scales,
        cleared_by: (!p.denominator().is_constant()).then(|| p.denominator().clone()),
        conditions,
        intersection,
    })
}

/// The polynomial without the integers that all its coefficients have in common, and what it is to be multiplied by to be the given one.
fn without_content(p: &ParametricPolynomial) -> (Poly<UniPoly>, Rational) {
    let full = p.polynomial().scaled(p.content());
    let content = full.coeffs().iter().fold(Integer::ZERO, |g, c| Domain::gcd(&g, &c.content()));
    if content.is_zero() {
        return (full, Rational::ONE);
    }
    let base = full.map(|c| c.div_exact_scalar(&content).expect("the content divides"));
    let denominator = if p.denominator().is_constant() { p.denominator().coeff(0) } else { Integer::ONE };
    (base, Rational::new(content, denominator))
}

/// The exact solution set of one inequality over a range.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn solve(inequality: &Inequality, range: &Range, budget: &Budget) -> Result<IntervalSet, Exhausted> {
    match inequality {
        Inequality::Positive(f) => solve_positive(&f.polynomial, range, budget),
        Inequality::Dominates { left, right } => {
            // The rational scales are brought together first.
            let ratio = &right.scale / &left.scale;
            let l = left.polynomial.scaled(&ratio.denominator());
            let r = right.polynomial.scaled(&ratio.numerator());
            solve_dominates(&l, &r, Vec::new(), range, budget)
        }
    }
}

/// Where `|l| > |r|`, which is `(l - r)(l + r) > 0`, except at the given points.
fn solve_dominates(
    l: &UniPoly,
    r: &UniPoly,
    mut except: Vec<Vec<RealAlgebraic>>,
    range: &Range,
    budget: &Budget,
) -> Result<IntervalSet, Exhausted> {
    let (difference, sum) = (l.minus(r), l.plus(r));
    if difference.is_zero() || sum.is_zero() {
        return Ok(IntervalSet::default());
    }
    except.push(zeros_in(&difference, range, budget)?);
    except.push(zeros_in(&sum, range, budget)?);
    let points = merge_points(except, budget)?;
    IntervalSet::from_cells(range, &points, budget, |x| difference.sign_at(x) == sum.sign_at(x))
}

/// The condition of a row that the textbook leaves undivided, solved on the table with division; `None`
/// for the first three rows, where nothing is divided, and where a divisor is identically zero.
///
/// With `R_i` the textbook's row and `D_i` the divided one, `R_i = f_i D_i` with `f_2 = 1` and
/// `f_(i+1) = f_i^2 D_(i-1),0`. So the condition on `R_i` is that on `D_i`, except where an entry
/// `D_k,0` with `1 <= k <= i - 2` is zero: there both sides vanish.
fn solve_divided_row(
    table: &JuryTable<UniPoly>,
    row: usize,
    range: &Range,
    budget: &Budget,
) -> Result<Option<IntervalSet>, Exhausted> {
    let rows = table.rows.get(3..=row).unwrap_or_default();
    let Some((last, _)) = rows.split_last().filter(|_| rows.iter().all(|r| r.divisor.is_some())) else {
        return Ok(None);
    };
    let factors = table.rows[1..=row - 2].iter().map(|r| zeros_in(&r.entries[0], range, budget));
    let factors = factors.collect::<Result<Vec<_>, _>>()?;
    let (left, right) = (&last.entries[0], &last.entries[last.entries.len() - 1]);
    solve_dominates(left, right, factors, range, budget).map(Some)
}

pub(super) fn solve_positive(f: &UniPoly, range: &Range, budget: &Budget) -> Result<IntervalSet, Exhausted> {
    if f.is_zero() {
        return Ok(IntervalSet::default());
    }
    let points = zeros_in(f, range, budget)?;
    IntervalSet::from_cells(range, &points, budget, |x| f.sign_at(x).is_gt())
}

/// Jury's conditions on `Q(1)` and `Q(-1)` come before those on the rows.
const VALUE_CONDITIONS: usize = 2;

type Inequalities = (Table, Vec<Rational>, Vec<(String, Inequality)>);

fn is_positive_constant(p: &UniPoly) -> bool {
    p.degree() == Some(0) && p.coeff(0).sign().is_gt()
}

/// The conditions of Jury's test in the order of the textbook: the values at 1 and -1, then one for
/// each row. They are stated for a positive leading coefficient; where that is not a positive constant,
/// the two values are multiplied by it.
fn jury_inequalities(
    base: &Poly<UniPoly>,
    n: usize,
    scale: Rational,
    budget: &Budget,
) -> Result<Inequalities, Exhausted> {
    let table = budget.enter(|| jury_table_with(base, n, n > UNDIVIDED_ORDER))?;
    let mut scales: Vec<Rational> = Vec::with_capacity(table.rows.len());
    for (i, row) in table.rows.iter().enumerate() {
        scales.push(match i {
            0 => scale.clone(),
            _ => {
                let squared = &scales[i - 1] * &scales[i - 1];
                if row.divisor.is_some() { squared / &scales[i - 2] } else { squared }
            }
        });
    }
    let mut list = Vec::new();
    if n > 0 {
        let lead = base.coeff(n);
        let plain = is_positive_constant(&lead);
        let value = |x: i64| base.eval(&UniPoly::constant(Integer::from(x)));
        let mut value_condition = |name: &str, v: UniPoly| {
            let (name, f, s) = if plain {
                (format!("{name} > 0"), v, scale.clone())
            } else {
                (format!("a_{n}*{name} > 0"), v.times(&lead), &scale * &scale)
            };
            list.push((name, Inequality::Positive(ScaledPoly { scale: s, polynomial: f })));
        };
        value_condition("Q(1)", value(1));
        let at_minus_one = value(-1);
        let alternating = if n.is_multiple_of(2) { at_minus_one } else { at_minus_one.negated() };
        value_condition(&format!("(-1)^{n}*Q(-1)"), alternating);
        for (i, ((first, last), s)) in table.end_entries().zip(&scales).enumerate() {
            let (row, m) = (row_name(i), n - i);
            let scaled = |p: &UniPoly| ScaledPoly { scale: s.clone(), polynomial: p.clone() };
            list.push(if i == 0 {
                let bound = if plain { format!("a_{n}") } else { format!("|a_{n}|") };
                (format!("|a_0| < {bound}"), Inequality::Dominates { left: scaled(last), right: scaled(first) })
            } else {
                let name = format!("|{row}_0| > |{row}_{m}|");
                (name, Inequality::Dominates { left: scaled(first), right: scaled(last) })
            });
        }
    }
    Ok((Table::Jury(table), scales, list))
}

/// The letters of the table's rows: `a`, `b`, ..., `z`, then `r26`, `r27`, ...
pub fn row_name(index: usize) -> String {
    match u8::try_from(index).ok().filter(|i| *i < 26) {
        Some(i) => char::from(b'a' + i).to_string(),
        None => format!("r{index}"),
    }
}

/// Hurwitz determinants for a positive leading coefficient; where that is not a positive constant, those
/// of odd order are multiplied by it.
fn routh_inequalities(
    base: &Poly<UniPoly>,
    n: usize,
    scale: Rational,
    budget: &Budget,
) -> Result<Inequalities, Exhausted> {
    let table = budget.enter(|| routh_table(base, n))?;
    let lead = base.coeff(n);
    let plain = is_positive_constant(&lead);
    let mut scales = Vec::with_capacity(table.rows.len());
    let mut power = Rational::ONE;
    for k in 0..table.rows.len() {
        // Row k >= 1 has degree k in the coefficients.
        power = if k == 0 { Rational::ONE } else { power * &scale };
        scales.push(if k == 0 { scale.clone() } else { power.clone() });
    }
    let mut list = Vec::new();
    for (k, (first, s)) in table.first_column().zip(&scales).enumerate().skip(1) {
        let (name, f, s) = if plain || k % 2 == 0 {
            (format!("H_{k} > 0"), first.clone(), s.clone())
        } else {
            (format!("a_{n}*H_{k} > 0"), first.times(&lead), s * &scale)
        };
        list.push((name, Inequality::Positive(ScaledPoly { scale: s, polynomial: f })));
    }
    Ok((Table::Routh(table), scales, list))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients `c + d K` from a fixed sequence of small numbers.
    fn example(order: usize, seed: &mut u64) -> ParametricPolynomial {
        let mut next = || {
            *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*seed >> 33) as i64 % 19 - 9
        };
        let mut coefficients: Vec<UniPoly> = (0..order).map(|_| UniPoly::from_i64(&[next(), next()])).collect();
        coefficients.push(UniPoly::from_i64(&[20 + next()]));
        ParametricPolynomial::from_integral(&Poly::new(coefficients), order)
    }

    #[test]
    fn rows_solved_by_division_have_the_textbooks_solutions() {
        let mut seed = 1;
        let range = Range::between(Some(Rational::from(-3)), None);
        for order in [2, 3, 4, 5, 5, 6, 6, 6] {
            let p = example(order, &mut seed);
            let test = classical_test(&p, &range, Shape::UnitDisc, &Budget::unlimited()).unwrap();
            for condition in &test.conditions {
                let textbook = solve(&condition.inequality, &range, &Budget::unlimited()).unwrap();
                assert!(textbook.same_as(&condition.solution), "order {order}: {}", condition.name);
            }
        }
    }
}
