//! The classical conditions on the parameter, each solved to its own exact solution set: Jury's in
//! discrete time, Routh's in continuous time.

use super::interval_set::{cells, merge_points, zeros_in};
use super::{IntervalSet, JuryTable, ParametricPolynomial, Range, Region, RouthTable, jury_table, routh_table};
use crate::limits::{Budget, Exhausted};
use crate::number::{Integer, Rational};
use crate::poly::{Domain, Poly, UniPoly};

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
#[derive(Clone, Debug)]
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
}

/// The classical test of a loop with one parameter: table, conditions, their intersection.
#[derive(Clone, Debug)]
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
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn classical_test(
    p: &ParametricPolynomial,
    range: &Range,
    region: Region,
    budget: &Budget,
) -> Result<ClassicalTest, Exhausted> {
    let n = p.formal_degree();
    let full = p.polynomial().scaled(p.content());
    let integer_content = full.coeffs().iter().fold(Integer::ZERO, |g, c| Domain::gcd(&g, &c.content()));
    let base = if integer_content.is_zero() {
        full
    } else {
        full.map(|c| c.div_exact_scalar(&integer_content).expect("the content divides"))
    };
    let constant_denominator = p.denominator().is_constant();
    let scale = match (integer_content.is_zero(), constant_denominator) {
        (true, _) => Rational::ONE,
        (false, true) => Rational::new(integer_content, p.denominator().coeff(0)),
        (false, false) => Rational::from(integer_content),
    };
    budget.step("the table");
    let (table, scales, inequalities) = match region {
        Region::UnitDisc => jury_inequalities(&base, n, scale),
        Region::LeftHalfPlane => routh_inequalities(&base, n, scale),
    };
    let mut conditions = Vec::with_capacity(inequalities.len());
    let mut poles = Vec::new();
    for pole in p.poles().iter().chain([p.denominator()]) {
        poles.push(zeros_in(pole, range, budget)?);
    }
    let poles = merge_points(poles);
    // A polynomial without conditions (order 0) is stable where it is not zero.
    let mut intersection: IntervalSet = if n == 0 {
        solve_positive(&base.coeff(0).times(&base.coeff(0)), range, budget)?
    } else {
        cells(range, &[]).into_iter().collect()
    };
    intersection = intersection.intersection(&cells(range, &poles).into_iter().collect());
    for (i, (name, inequality)) in inequalities.into_iter().enumerate() {
        budget.step(&format!("condition {}", i + 1));
        let solution = solve(&inequality, range, budget)?;
        intersection = intersection.intersection(&solution);
        conditions.push(Condition { name, inequality, solution });
    }
    Ok(ClassicalTest {
        table,
        scales,
        cleared_by: (!constant_denominator).then(|| p.denominator().clone()),
        conditions,
        intersection,
    })
}

/// The exact solution set of one inequality over a range.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn solve(inequality: &Inequality, range: &Range, budget: &Budget) -> Result<IntervalSet, Exhausted> {
    match inequality {
        Inequality::Positive(f) => solve_positive(&f.polynomial, range, budget),
        Inequality::Dominates { left, right } => {
            // |l| > |r| is (l - r)(l + r) > 0; the rational scales are brought together first.
            let ratio = &right.scale / &left.scale;
            let l = left.polynomial.scaled(&ratio.denominator());
            let r = right.polynomial.scaled(&ratio.numerator());
            let (difference, sum) = (l.minus(&r), l.plus(&r));
            if difference.is_zero() || sum.is_zero() {
                return Ok(IntervalSet::default());
            }
            let points = merge_points(vec![zeros_in(&difference, range, budget)?, zeros_in(&sum, range, budget)?]);
            IntervalSet::from_cells(range, &points, budget, |x| difference.sign_at(x) == sum.sign_at(x))
        }
    }
}

fn solve_positive(f: &UniPoly, range: &Range, budget: &Budget) -> Result<IntervalSet, Exhausted> {
    if f.is_zero() {
        return Ok(IntervalSet::default());
    }
    let points = zeros_in(f, range, budget)?;
    IntervalSet::from_cells(range, &points, budget, |x| f.sign_at(x).is_gt())
}

type Inequalities = (Table, Vec<Rational>, Vec<(String, Inequality)>);

fn is_positive_constant(p: &UniPoly) -> bool {
    p.degree() == Some(0) && p.coeff(0).sign().is_gt()
}

/// The conditions of Jury's test in the order of the textbook: the values at 1 and -1, then one for
/// each row. They are stated for a positive leading coefficient; where that is not a positive constant,
/// the two values are multiplied by it.
fn jury_inequalities(base: &Poly<UniPoly>, n: usize, scale: Rational) -> Inequalities {
    let table = jury_table(base, n);
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
        let alternating = if n % 2 == 0 { at_minus_one } else { at_minus_one.negated() };
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
    (Table::Jury(table), scales, list)
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
fn routh_inequalities(base: &Poly<UniPoly>, n: usize, scale: Rational) -> Inequalities {
    let table = routh_table(base, n);
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
    (Table::Routh(table), scales, list)
}
