//! The classical conditions of a loop over symbols, each solved for the parameter.

use super::basis::{Boundary, Split, Unexpanded, Way};
use super::jury::Comparison;
use super::minors::{EnclosedMinor, Minor};
use super::rows::{Asked, EnclosedRows, SymbolicRow, enclosed_rows, plus, shown, times};
use super::statements::{Conditions, Rule, Stated};
use super::{SymbolicPolynomial, Table};
use crate::interval_set::real_cells;
use crate::precisions::SIGN_OF_DETERMINANT;
use crate::{Cause, Range, RealInterval, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, SquareFree, UniPoly};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{SymbolicPoly, Symbols};
use std::sync::Arc;

/// Determinants with no more terms than this are expanded: order 6 over two symbols takes 30 ms, order 7 over three ten seconds.
pub(super) const MOST_EXPANDED: u64 = 800;

/// A union of disjoint open intervals, ascending. Two may share an end, which is then not in the set.
#[derive(Clone, Debug, Default)]
pub struct RealIntervals {
    /// The ends of each, `None` where there is none.
    pub intervals: Vec<[Option<Real>; 2]>,
}

impl RealIntervals {
    /// Whether both have the same ends to so many bits after the point.
    ///
    /// Cost: that of refining all ends.
    pub fn agree(&self, other: &RealIntervals, bits: u64) -> bool {
        let width = Rational::dyadic(&Integer::ONE, bits);
        let same = |(a, b): (&Option<Real>, &Option<Real>)| match (a, b) {
            (None, None) => true,
            (Some(a), Some(b)) => {
                let [(lo, hi), (least, most)] = [a, b].map(|x| x.refined(&width).enclosure());
                lo <= most && least <= hi
            }
            _ => false,
        };
        let pairs = self.intervals.iter().flatten().zip(other.intervals.iter().flatten());
        self.intervals.len() == other.intervals.len() && pairs.into_iter().all(same)
    }

    /// Whether the value lies in the set.
    pub fn contains(&self, value: &Rational) -> bool {
        let inside = |[lower, upper]: &[Option<Real>; 2]| {
            lower.as_ref().is_none_or(|l| l.compare_rational(value).is_lt())
                && upper.as_ref().is_none_or(|u| u.compare_rational(value).is_gt())
        };
        self.intervals.iter().any(inside)
    }
}

/// A condition on polynomials in the parameter with enclosed coefficients, from the constant term up.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SymbolicCondition {
    /// As textbooks write it.
    pub name: String,
    /// How the sides are to compare.
    pub comparison: Comparison,
    /// The left side.
    pub left: Vec<Enclosure>,
    /// The right side.
    pub right: Vec<Enclosure>,
    /// The row that it is on; none for the values at 1 and -1.
    pub row: Option<usize>,
    /// Where it holds.
    pub solution: RealIntervals,
}

/// The classical test of a loop over symbols with one parameter.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SymbolicTest {
    /// The degree the table was built for.
    pub order: usize,
    /// The rows.
    pub rows: Vec<SymbolicRow>,
    /// What the coefficients were multiplied by to clear denominators that depend on the parameter.
    pub cleared_by: Option<Vec<Enclosure>>,
    /// The conditions, in the order of [`classical_test`](crate::classical_test).
    pub conditions: Vec<SymbolicCondition>,
    /// Where all conditions hold and the loop is defined.
    pub intersection: RealIntervals,
}

impl SymbolicPolynomial {
    /// The classical conditions, each solved over a range, with rows whose coefficients are enclosed to a relative width of
    /// `10^-(digits + 2)`.
    ///
    /// The signs of rows are those of products of Jury's inner determinants ([Jury1964](jurist_algebra::bibliography#jury1964)), or of Hurwitz'
    /// determinants: polynomials in the parameter whose zeros are isolated with enclosed coefficients. One rational number in
    /// each gap between the zeros of all of them decides all conditions there.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Model, ParameterBuilder, Time};
    /// use jurist_engine::problem::Ask;
    /// use jurist_stability::{Range, Shape};
    /// let (model, _) = Model::builder(Time::Discrete)
    ///     .parameter(ParameterBuilder::new("K").nominal("1"))
    ///     .characteristic("z - exp(-1) + K")
    ///     .build()?;
    /// let budget = Budget::unlimited();
    /// let p = model.ask().free("K").problem()?.symbolic(&budget)?.unwrap();
    /// let test = p.classical_test(&Range::all(), Shape::UnitDisc, 12, &budget)?;
    /// let [lower, upper] = &test.conditions[0].solution.intervals[0]; // Q(1) > 0
    /// assert_eq!((lower.as_ref().unwrap().decimal(6), upper.is_none()), ("-0.632121".into(), true));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// Cost: determinants of polynomials in the parameter and the symbols while they are short, else their values at as many
    /// numbers as their degree in the parameter; and the zeros of each, of degree up to `n - 1` times that of a coefficient.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where zeros are not told apart with some thousand bits.
    ///
    /// # Panics
    /// When symbols depend on the parameter.
    pub fn classical_test(
        &self,
        range: &Range,
        region: Shape,
        digits: usize,
        budget: &Budget,
    ) -> Result<SymbolicTest, Exhausted> {
        let Table::Fixed(symbols) = &self.symbols else { panic!("symbols depend on the parameter") };
        // Zeros that coincide show in expanded determinants.
        Way::in_order(symbols, MOST_EXPANDED, |way| self.classical_test_with(range, region, digits, way, budget))
    }

    /// The same as [`SymbolicPolynomial::classical_test`], in one way.
    pub(super) fn classical_test_with(
        &self,
        range: &Range,
        region: Shape,
        digits: usize,
        way: Way,
        budget: &Budget,
    ) -> Result<SymbolicTest, Exhausted> {
        let Table::Fixed(symbols) = &self.symbols else { panic!("symbols depend on the parameter") };
        budget.step("the conditions");
        let conditions = self.stated_conditions(symbols, region, budget)?;
        let (solved, degrees) = solved(self, &conditions, symbols, range, way, budget)?;
        budget.step("the table");
        let divisors = conditions.divisors.iter().map(|of| of.iter().map(|&f| degrees[f]).sum()).collect();
        let asked = Asked { region, rows: conditions.rows, divisors, digits };
        let table = enclosed_rows(self, symbols, &asked, budget)?;
        Ok(self.shown_test(conditions, solved, &table, region, digits))
    }

    fn shown_test(
        &self,
        conditions: Conditions,
        solved: Solutions,
        table: &EnclosedRows,
        region: Shape,
        digits: usize,
    ) -> SymbolicTest {
        let (solutions, intersection) = solved;
        let n = self.formal_degree;
        let side = |stated: &Stated, left: bool| {
            let bits = table.rows[0].iter().flatten().next().map_or(0, |b| b.bits());
            let lead = |p: super::rows::Enclosed| {
                if conditions.is_plain || (region == Shape::LeftHalfPlane && stated.row.is_some_and(|k| k % 2 == 0)) {
                    p
                } else {
                    times(&p, if region == Shape::UnitDisc { &table.rows[0][n] } else { &table.rows[0][0] }, bits)
                }
            };
            let found = match (region, stated.row, left) {
                (Shape::UnitDisc, Some(row), _) => {
                    let entries = &table.rows[row];
                    let at = if left { 0 } else { entries.len() - 1 };
                    entries[at].clone()
                }
                (Shape::LeftHalfPlane, Some(row), true) => lead(table.rows[row][0].clone()),
                (Shape::UnitDisc, None, true) => {
                    // The values at 1 and (-1)^n times at -1.
                    let at_one = stated.name.contains("Q(1)");
                    let signed = |(k, c): (usize, &super::rows::Enclosed)| {
                        let negative = !at_one && (n - k) % 2 == 1;
                        if negative { c.iter().map(|b| b.neg()).collect() } else { c.clone() }
                    };
                    let terms = table.rows[0].iter().enumerate().map(signed);
                    lead(terms.fold(Vec::new(), |sum, c| plus(&sum, &c, bits)))
                }
                _ => Vec::new(),
            };
            shown(&found, digits)
        };
        let condition = |(stated, solution): (&Stated, RealIntervals)| SymbolicCondition {
            name: stated.name.clone(),
            comparison: stated.comparison,
            left: side(stated, true),
            right: side(stated, false),
            row: stated.row,
            solution,
        };
        SymbolicTest {
            order: n,
            rows: table.named(region, n, digits),
            cleared_by: table.cleared_by.as_ref().map(|p| shown(p, digits)),
            conditions: conditions.stated.iter().zip(solutions).map(condition).collect(),
            intersection,
        }
    }
}

/// Functions that cut a range.
struct Cutting {
    split: Split,
    /// Which boundary a function is; `None` for one that is zero for every value.
    places: Vec<Option<usize>>,
    /// Their degrees in the parameter.
    degrees: Vec<usize>,
}

fn cutting(functions: &[Minor], symbols: &Arc<Symbols>, way: Way, budget: &Budget) -> Result<Cutting, Exhausted> {
    let most = way.most_expanded();
    let short = |f: &Minor| f.expanded_size() <= most;
    let most = if functions.iter().all(short) || seem_simple(functions, most, budget)? { most } else { u64::MAX };
    let mut expanded = Vec::new();
    let mut enclosed: Vec<(Cause, Arc<dyn Unexpanded>)> = Vec::new();
    let mut places = Vec::with_capacity(functions.len());
    let mut degrees = Vec::with_capacity(functions.len());
    for f in functions {
        budget.check()?;
        // Which boundary it is does not matter: the cause is not shown.
        if f.expanded_size() > most {
            places.push(Some((true, enclosed.len())));
            let minor = EnclosedMinor::new(f.clone(), symbols, budget)?;
            degrees.push(minor.degree());
            enclosed.push((Cause::Undecided, Arc::new(minor)));
            continue;
        }
        let mut polynomial = f.expanded(budget)?;
        degrees.push(degree(&polynomial, symbols, budget)?);
        if let Way::OverNumbers = way {
            polynomial = symbols.square_free_part(&polynomial, budget)?;
        }
        match SymbolicPoly::new(&polynomial, symbols, budget)? {
            Some(polynomial) => {
                places.push(Some((false, expanded.len())));
                expanded.push((Cause::Undecided, polynomial));
            }
            None => places.push(None),
        }
    }
    let first_enclosed = expanded.len();
    let split = way.split(expanded, enclosed, symbols, budget)?;
    let index = |(is_enclosed, at): (bool, usize)| if is_enclosed { first_enclosed + at } else { at };
    Ok(Cutting { split, places: places.into_iter().map(|place| place.map(index)).collect(), degrees })
}

/// The degree in the parameter; 0 also for zero.
fn degree(p: &MultiPoly, symbols: &Symbols, budget: &Budget) -> Result<usize, Exhausted> {
    for (k, c) in p.as_poly_in(0).coeffs().iter().enumerate().rev() {
        if !symbols.is_zero(&c.map_variables(|i| i.saturating_sub(1)), budget)? {
            return Ok(k);
        }
    }
    Ok(0)
}

/// Whether the functions that are not expanded, on lines and apart from powers of the parameter, have no repeated factor, none
/// in common with another, and none without symbols, whose roots would be algebraic numbers. No proof; for one who finds out
/// when it is not so.
fn seem_simple(functions: &[Minor], most: u64, budget: &Budget) -> Result<bool, Exhausted> {
    let mut parts: Vec<(UniPoly, bool)> = Vec::new();
    for f in functions {
        let on_line = |line: u64| {
            let value = f.on_line(line, budget)?;
            let order = value.coeffs().iter().position(|c| !c.is_zero());
            Ok(order.map(|order| UniPoly::new(value.coeffs()[order..].to_vec())))
        };
        let is_long = f.expanded_size() > most;
        let Some(part) = on_line(0)? else { return Ok(false) };
        if is_long && !part.is_constant() {
            let Some(other) = on_line(1)? else { return Ok(false) };
            let is_simple =
                || SquareFree::new(part.clone()).is_some() && (other.is_constant() || part.gcd(&other).is_constant());
            if !budget.enter(is_simple)? {
                return Ok(false);
            }
        }
        let apart =
            |(other, is_other_long): &(UniPoly, bool)| !(is_long || *is_other_long) || part.gcd(other).is_constant();
        if !budget.enter(|| parts.iter().all(apart))? {
            return Ok(false);
        }
        parts.push((part, is_long));
    }
    Ok(true)
}

/// Where each condition holds, and where all do and the loop is defined.
pub(super) type Solutions = (Vec<RealIntervals>, RealIntervals);

/// The solutions, and the degrees of the functions.
pub(super) fn solved(
    p: &SymbolicPolynomial,
    conditions: &Conditions,
    symbols: &Arc<Symbols>,
    range: &Range,
    way: Way,
    budget: &Budget,
) -> Result<(Solutions, Vec<usize>), Exhausted> {
    let functions = &conditions.functions;
    let mut all: Vec<Minor> = functions.clone();
    all.extend(p.poles.iter().cloned().map(Minor::of));
    if functions.is_empty() {
        // A polynomial without conditions is stable where it is not zero.
        all.push(Minor::of(p.polynomial.coeff(0)));
    }
    let Cutting { split, places, degrees } = cutting(&all, symbols, way, budget)?;
    budget.step("isolating the zeros of the conditions");
    let zeros = split.zeros(range, budget)?;
    let vanishing = |zero| split.boundaries.iter().map(|b: &Boundary| b.has(zero, budget)).collect();
    let vanishing = zeros.iter().map(vanishing).collect::<Result<Vec<Vec<bool>>, Exhausted>>()?;
    let values: Vec<Real> = zeros.iter().map(|zero| zero.value.clone()).collect();
    let cells = real_cells(range, &values);
    budget.step("testing a sample of each cell");
    let mut signs: Vec<Vec<Sign>> = Vec::with_capacity(cells.len());
    for (i, cell) in cells.iter().enumerate() {
        budget.advance(i as u64, cells.len() as u64);
        let at = cell.sample(budget)?;
        let sign = |f: usize| sign_at(&functions[f], places[f].is_some(), &at, symbols, budget);
        signs.push((0..functions.len()).map(sign).collect::<Result<_, _>>()?);
    }
    let looked = Looked { cells, signs, vanishing, places };
    let holds = |rule: &Rule, signs: &[Sign]| {
        let negative = rule.product.iter().filter(|&&f| signs[f].is_lt()).count() % 2 == 1;
        negative == rule.is_negative
    };
    let solution = |stated: &Stated| {
        let rule = &stated.rule;
        let of: Vec<usize> = rule.product.iter().chain(&rule.other_than_zero).copied().collect();
        looked.set(&of, &|signs| holds(rule, signs))
    };
    let solutions = conditions.stated.iter().map(solution).collect();
    let mut of: Vec<usize> = (functions.len()..all.len()).collect();
    of.extend(conditions.stated.iter().flat_map(|s| s.rule.product.iter().chain(&s.rule.other_than_zero)));
    let intersection = looked.set(&of, &|signs| conditions.stated.iter().all(|s| holds(&s.rule, signs)));
    Ok(((solutions, intersection), degrees))
}

/// Cells of a range, the signs of functions in each, and which boundaries vanish between it and the next.
struct Looked {
    cells: Vec<RealInterval>,
    signs: Vec<Vec<Sign>>,
    vanishing: Vec<Vec<bool>>,
    /// Which boundary a function is; `None` for one that is zero for every value.
    places: Vec<Option<usize>>,
}

impl Looked {
    /// The cells in which `holds` is true, those as one between which none of these functions vanishes.
    fn set(&self, of: &[usize], holds: &dyn Fn(&[Sign]) -> bool) -> RealIntervals {
        let parts: Vec<usize> = of.iter().filter_map(|&f| self.places[f]).collect();
        let is_never = parts.len() < of.len();
        let mut intervals: Vec<[Option<Real>; 2]> = Vec::new();
        let mut goes_on = false;
        for (i, signs) in self.signs.iter().enumerate().filter(|_| !is_never) {
            let cell = &self.cells[i];
            let is_cut = i > 0 && parts.iter().any(|&k| self.vanishing[i - 1][k]);
            let holds = holds(signs);
            goes_on &= !is_cut;
            if holds {
                match intervals.last_mut().filter(|_| goes_on) {
                    Some(last) => last[1] = cell.upper.clone(),
                    None => intervals.push([cell.lower.clone(), cell.upper.clone()]),
                }
            }
            goes_on = holds;
        }
        RealIntervals { intervals }
    }
}

/// The sign of a function that is not zero at a number, or zero everywhere.
fn sign_at(f: &Minor, varies: bool, at: &Rational, symbols: &Symbols, budget: &Budget) -> Result<Sign, Exhausted> {
    if !varies {
        return Ok(Sign::Equal);
    }
    SIGN_OF_DETERMINANT.decide("the sign of a determinant", |bits| {
        budget.check()?;
        Ok(budget.enter(|| f.enclosed_at(at, symbols, bits))?.sign())
    })
}
