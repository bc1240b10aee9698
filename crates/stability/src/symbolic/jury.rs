//! The tables of Jury and of Routh of a loop whose coefficients are numbers over symbols, with enclosed entries.

use super::{SymbolicCondition, SymbolicPolynomial, SymbolicRow, SymbolicTest, Table};
use crate::precisions::JURY_TABLE;
use crate::{Range, Shape, UNDIVIDED_ORDER, row_name};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_algebra::symbols::Symbols;

/// How two sides of a condition compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// The left side is greater.
    Greater,
    /// The left side has the greater absolute value.
    GreaterAbsolute,
    /// The left side has the smaller absolute value.
    SmallerAbsolute,
}

/// A row of the table.
#[derive(Clone, Debug)]
pub struct EnclosedRow {
    /// `a`, `b`, ...
    pub name: String,
    /// The entries, for `z^0` first.
    pub entries: Vec<Enclosure>,
    /// The entry that the row was divided by, such as `a_0`.
    pub divided_by: Option<String>,
}

/// A condition, decided.
#[derive(Clone, Debug)]
pub struct EnclosedCondition {
    /// As textbooks write it.
    pub name: String,
    /// How the sides are to compare.
    pub comparison: Comparison,
    /// The left side.
    pub left: Enclosure,
    /// The right side.
    pub right: Enclosure,
    /// The row that it is on; none for the values at 1 and -1.
    pub row: Option<usize>,
    /// Whether it holds, for certain.
    pub holds: bool,
}

/// Jury's table with its conditions, each entry enclosed and each condition decided.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct EnclosedTable {
    /// The rows.
    pub rows: Vec<EnclosedRow>,
    /// The conditions, in the order of [`classical_test`](crate::classical_test).
    pub conditions: Vec<EnclosedCondition>,
}

impl EnclosedTable {
    /// Whether all conditions hold: the loop is stable.
    pub fn holds(&self) -> bool {
        self.conditions.iter().all(|c| c.holds)
    }
}

impl From<SymbolicTest> for EnclosedTable {
    /// Of a test without parameter.
    fn from(test: SymbolicTest) -> EnclosedTable {
        let zero = Enclosure::from_rational(Rational::ZERO);
        let number = |p: &Vec<Enclosure>| p.first().unwrap_or(&zero).clone();
        let row = |row: SymbolicRow| EnclosedRow {
            entries: row.entries.iter().map(number).collect(),
            name: row.name,
            divided_by: row.divided_by,
        };
        let condition = |c: SymbolicCondition| EnclosedCondition {
            comparison: c.comparison,
            left: number(&c.left),
            right: number(&c.right),
            row: c.row,
            holds: !c.solution.intervals.is_empty(),
            name: c.name,
        };
        let rows = test.rows.into_iter().map(row).collect();
        EnclosedTable { rows, conditions: test.conditions.into_iter().map(condition).collect() }
    }
}

/// Rows with more terms are not looked through for entries that are zero.
const MOST_TERMS: usize = 400;

impl SymbolicPolynomial {
    /// Jury's table of a discrete loop without parameter, whose entries are enclosed to a relative width of `10^-(digits + 2)`;
    /// `None` where the loop is undefined, or its degree lost.
    ///
    /// A condition holds, or does not, where the enclosures of its sides are apart; values at 1 and -1 that are zero are
    /// recognised, and zero entries of rows that are short over the symbols. As in [`jury_table`](crate::jury_table), rows are divided by their known factors above order 8.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Model, Time};
    /// use jurist_engine::problem::Ask;
    /// // z^2 - exp(-1) z + 1/2
    /// let (model, _) = Model::builder(Time::Discrete).characteristic("z^2 - exp(-1)*z + 1/2").build()?;
    /// let budget = Budget::unlimited();
    /// let p = model.ask().problem()?.symbolic(&budget)?.unwrap();
    /// let table = p.jury_table(12, &budget)?.unwrap();
    /// assert!(table.holds() && table.conditions.len() == 3);
    /// assert!(table.rows[0].entries[1].contains(&"-0.36787944117144232159552377".parse().unwrap()));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// Cost: `O(n^2)` products of enclosures, with twice as many bits until all is certain.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where a condition is not told from an equality.
    pub fn jury_table(&self, digits: usize, budget: &Budget) -> Result<Option<EnclosedTable>, Exhausted> {
        let Table::Fixed(symbols) = &self.symbols else { unreachable!("without parameter symbols are numbers") };
        budget.step("the table");
        if self.is_undefined_without_parameter(budget)? {
            return Ok(None);
        }
        let number = |p: &MultiPoly| p.map_variables(|i| i.saturating_sub(1));
        let mut at_ends = Vec::new();
        for z in [1, -1] {
            let value = number(&self.polynomial.eval(&MultiPoly::constant(Integer::from(z))));
            at_ends.push(if symbols.is_zero(&value, budget)? { MultiPoly::constant(Integer::ZERO) } else { value });
        }
        let mut zeros = Vec::new();
        let table = JURY_TABLE.decide("the conditions of the table", |bits| {
            budget.check()?;
            let table = budget.enter(|| self.enclosed_table(symbols, &at_ends, &zeros, digits, bits))?;
            if table.is_none() && zeros.is_empty() {
                zeros = self.zero_entries(symbols, budget)?;
            }
            Ok::<_, Exhausted>(table)
        })?;
        Ok(Some(table))
    }

    /// Routh's table of a continuous loop without parameter, whose entries are enclosed to a relative width of `10^-(digits + 2)`;
    /// `None` where the loop is undefined, or its degree lost.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Model, Time};
    /// use jurist_engine::problem::Ask;
    /// let (model, _) = Model::builder(Time::Continuous).characteristic("s^2 + pi*s + sqrt(2)").build()?;
    /// let budget = Budget::unlimited();
    /// let p = model.ask().problem()?.symbolic(&budget)?.unwrap();
    /// let table = p.routh_table(12, &budget)?.unwrap();
    /// assert!(table.holds() && table.conditions.len() == 2);
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// Cost: that of [`SymbolicPolynomial::classical_test`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn routh_table(&self, digits: usize, budget: &Budget) -> Result<Option<EnclosedTable>, Exhausted> {
        if self.is_undefined_without_parameter(budget)? {
            return Ok(None);
        }
        Ok(Some(self.classical_test(&Range::all(), Shape::LeftHalfPlane, digits, budget)?.into()))
    }

    /// Whether a loop without parameter is undefined, or its degree lost.
    pub(super) fn is_undefined_without_parameter(&self, budget: &Budget) -> Result<bool, Exhausted> {
        let Table::Fixed(symbols) = &self.symbols else { unreachable!("without parameter symbols are numbers") };
        for pole in self.poles.iter().chain([&self.degree_loss]) {
            if symbols.is_zero(&pole.map_variables(|i| i.saturating_sub(1)), budget)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Which entries of the first rows are zero: no enclosure shows that. As far as rows that are not divided stay short.
    fn zero_entries(&self, symbols: &Symbols, budget: &Budget) -> Result<Vec<Vec<bool>>, Exhausted> {
        let number = |k: usize| self.polynomial.coeff(k).map_variables(|i| i.saturating_sub(1));
        let mut row: Vec<MultiPoly> = (0..=self.formal_degree).map(number).collect();
        let mut zeros = Vec::new();
        loop {
            let is_zero = |entry: &MultiPoly| match symbols.is_zero(entry, budget) {
                Err(stopped) if stopped.stop.is_precision() => Ok(false),
                found => found,
            };
            zeros.push(row.iter().map(is_zero).collect::<Result<Vec<bool>, Exhausted>>()?);
            let terms: usize = row.iter().map(|entry| entry.terms().len()).sum();
            if row.len() <= 3 || terms > MOST_TERMS {
                return Ok(zeros);
            }
            let m = row.len() - 1;
            let entry = |k: usize| row[0].times(&row[k]).minus(&row[m].times(&row[m - k]));
            row = budget.enter(|| (0..m).map(entry).collect())?;
        }
    }

    fn enclosed_table(
        &self,
        symbols: &Symbols,
        at_ends: &[MultiPoly],
        zeros: &[Vec<bool>],
        digits: usize,
        bits: u64,
    ) -> Option<EnclosedTable> {
        let n = self.formal_degree;
        let denominator = symbols.enclose(&self.poles[0].map_variables(|i| i.saturating_sub(1)), bits);
        let rows = self.enclosed_rows(symbols, zeros, &denominator, bits)?;
        let power = Integer::from(10).pow(digits as u64 + 2);
        let is_narrow = |b: &Ball| b.is_zero() || b.width_units() * &power <= b.least_magnitude_units();
        let shown = |b: &Ball| is_narrow(b).then(|| shortened(b, digits).to_enclosure());
        let mut conditions = Vec::new();
        if n > 0 {
            let lead = &rows[0][n];
            let is_positive = lead.sign()?.is_gt();
            for (value, end) in at_ends.iter().zip(["Q(1)".to_owned(), format!("(-1)^{n}*Q(-1)")]) {
                let value = symbols.enclose(value, bits).div(&denominator)?;
                let value = if end != "Q(1)" && n % 2 == 1 { value.neg() } else { value };
                let (name, value) = if is_positive { (end, value) } else { (format!("a_{n}*{end}"), value.mul(lead)) };
                let (name, comparison, holds) = (format!("{name} > 0"), Comparison::Greater, value.sign()?.is_gt());
                let (left, right) = (shown(&value)?, shown(&Ball::zero(bits))?);
                conditions.push(EnclosedCondition { name, comparison, left, right, row: None, holds });
            }
            for (i, row) in rows.iter().enumerate() {
                let (first, last, letter) = (&row[0], &row[row.len() - 1], row_name(i));
                let is_smaller = is_smaller(first, last)?;
                let (name, comparison, holds) = match (i, is_positive) {
                    (0, true) => (format!("|a_0| < a_{n}"), Comparison::SmallerAbsolute, is_smaller),
                    (0, false) => (format!("|a_0| < |a_{n}|"), Comparison::SmallerAbsolute, is_smaller),
                    _ => (format!("|{letter}_0| > |{letter}_{}|", n - i), Comparison::GreaterAbsolute, !is_smaller),
                };
                let (left, right) = (shown(first)?, shown(last)?);
                conditions.push(EnclosedCondition { name, comparison, left, right, row: Some(i), holds });
            }
        }
        let row = |(i, entries): (usize, &Vec<Ball>)| {
            let divided_by = (n > UNDIVIDED_ORDER && i >= 3).then(|| format!("{}_0", row_name(i - 2)));
            let entries = entries.iter().map(shown).collect::<Option<_>>()?;
            Some(EnclosedRow { name: row_name(i), entries, divided_by })
        };
        let rows = rows.iter().enumerate().map(row).collect::<Option<_>>()?;
        Some(EnclosedTable { rows, conditions })
    }

    /// The rows of Jury's table; entries that are zero are so.
    fn enclosed_rows(
        &self,
        symbols: &Symbols,
        zeros: &[Vec<bool>],
        denominator: &Ball,
        bits: u64,
    ) -> Option<Vec<Vec<Ball>>> {
        let n = self.formal_degree;
        let number = |p: &MultiPoly| symbols.enclose(&p.map_variables(|i| i.saturating_sub(1)), bits);
        let known = |row: Vec<Ball>, i: usize| -> Vec<Ball> {
            let is_zero = |k: usize| zeros.get(i).is_some_and(|row| row[k]);
            row.into_iter().enumerate().map(|(k, b)| if is_zero(k) { Ball::zero(bits) } else { b }).collect()
        };
        let first =
            (0..=n).map(|k| number(&self.polynomial.coeff(k)).div(denominator)).collect::<Option<Vec<Ball>>>()?;
        let mut rows = vec![known(first, 0)];
        while rows[rows.len() - 1].len() > 3 {
            let last = &rows[rows.len() - 1];
            let m = last.len() - 1;
            let entry = |k: usize| last[0].mul(&last[k]).sub(&last[m].mul(&last[m - k]));
            let entries = (0..m).map(entry);
            let next = if n > UNDIVIDED_ORDER && rows.len() >= 3 {
                let factor = &rows[rows.len() - 2][0];
                entries.map(|e| e.div(factor)).collect::<Option<Vec<Ball>>>()?
            } else {
                entries.collect()
            };
            rows.push(known(next, rows.len()));
        }
        Some(rows)
    }
}

/// Whether a number has a smaller modulus than another; `None` where that is not certain.
fn is_smaller(a: &Ball, b: &Ball) -> Option<bool> {
    if a.magnitude_units() < b.least_magnitude_units() {
        return Some(true);
    }
    (a.least_magnitude_units() > b.magnitude_units()).then_some(false)
}

/// The ball with no more bits than its digits need.
pub(super) fn shortened(b: &Ball, digits: usize) -> Ball {
    let least = b.least_magnitude_units();
    if least.is_zero() {
        return b.clone();
    }
    // log2(10) < 10/3; two digits more, and one for each rounding.
    let needed = (digits as u64 + 3) * 10 / 3 + 8;
    let known = least.bit_length();
    if known > needed { b.with_bits(b.bits().saturating_sub(known - needed)) } else { b.clone() }
}
