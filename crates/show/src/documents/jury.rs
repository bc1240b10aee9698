//! The document `jurist/jury/1`: in one parameter, or at a point.

use super::end::{Bounds, End, PlainEnd};
use super::number::{Enclosure, enclosure};
use super::question::title;
use super::schema_name;
use super::{Answered, Exact, Named, Open, ParameterQuestion, PointQuestion, RegionBound};
use crate::Document;
use crate::table::{coefficients, order, rows};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, RealAlgebraic, UniPoly};
use jurist_algebra::real::Real;
use jurist_engine::answer::{self, Answer, ParametricTable};
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;
use jurist_engine::stability::{
    ClassicalTest, Comparison, EnclosedCondition, EnclosedRow, Inequality, ScaledPoly, SymbolicCondition, SymbolicRow,
    SymbolicTest, Table, row_name,
};
use serde::{Deserialize, Serialize};

schema_name!(JuryName, "jurist/jury/1");

/// The table of Jury or Routh with its conditions, in one parameter or at a point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Jury {
    /// In one parameter.
    InParameter(JuryInParameter),
    /// At a point.
    AtPoint(JuryAtPoint),
}

/// The table with polynomial entries in one parameter, and each condition's own exact solution set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JuryInParameter {
    /// The kind of document.
    pub schema: JuryName,
    /// What was asked.
    #[serde(flatten)]
    pub question: ParameterQuestion,
    /// Whose table it is.
    pub table: TableKind,
    /// The table and its conditions.
    #[serde(flatten)]
    pub answer: Answered<TableInParameter, TableOpen>,
}

/// The table with numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum JuryAtPoint {
    /// The table.
    Known(PointTable<Exact>),
    /// The table of a loop with functions, as behind a hold: lower and upper bounds of the entries.
    Enclosed(PointTable<Enclosure>),
    /// The budget did not allow it.
    Undecided {
        /// The kind of document.
        schema: JuryName,
        /// What was asked.
        #[serde(flatten)]
        question: PointQuestion,
        /// Why there is no answer.
        #[serde(flatten)]
        open: Open<RowsOpen>,
    },
}

/// Whose table it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum TableKind {
    /// Discrete time.
    Jury,
    /// Continuous time.
    Routh,
    /// Discrete time and complex coefficients: no rows, and the conditions are that the leading principal minors of the Hermitian matrix of Schur and Cohn
    /// are positive.
    #[serde(rename = "Schur-Cohn")]
    SchurCohn,
    /// Continuous time and complex coefficients: the same of the Hermitian matrix of Hermite.
    Hermite,
}

impl From<&Problem> for TableKind {
    fn from(problem: &Problem) -> Self {
        match (problem.time(), problem.is_complex()) {
            (Time::Discrete, false) => TableKind::Jury,
            (Time::Continuous, false) => TableKind::Routh,
            (Time::Discrete, true) => TableKind::SchurCohn,
            (Time::Continuous, true) => TableKind::Hermite,
        }
    }
}

impl TableKind {
    /// Whether there is a table, and not conditions alone.
    pub fn has_rows(self) -> bool {
        matches!(self, TableKind::Jury | TableKind::Routh)
    }

    /// The name used in all output.
    pub fn name(self) -> &'static str {
        match self {
            TableKind::Jury => "Jury",
            TableKind::Routh => "Routh",
            TableKind::SchurCohn => "Schur-Cohn",
            TableKind::Hermite => "Hermite",
        }
    }
}

/// A table in one parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum TableInParameter {
    /// The table.
    Exact(SolvedTable<Exact>),
    /// The table of a loop with functions of constants, as behind a hold: lower and upper bounds of the coefficients.
    Enclosed(SolvedTable<Enclosure>),
}

/// A table in one parameter; all lists are empty where the loop is undefined for every value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "SolvedTableOf{E}"))]
#[serde(bound(deserialize = "E: Deserialize<'de>"))]
pub struct SolvedTable<E> {
    /// The rows; an entry is a polynomial in the parameter, coefficients from the constant term up.
    pub rows: Vec<Row<Vec<E>>>,
    /// The polynomial in the parameter that the loop's coefficients were multiplied by to clear their denominators; left
    /// out where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cleared_by: Option<Vec<E>>,
    /// The conditions of stability.
    pub conditions: Vec<Condition<Vec<E>, Solution>>,
    /// Where all conditions hold: the stable set.
    pub intersection: Vec<Bounds<End>>,
}

/// No table.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TableOpen {
    /// Not known.
    pub rows: (),
    /// Not known.
    pub conditions: (),
    /// Not known.
    pub intersection: (),
}

/// A table at a point; rows and conditions are empty where the loop is undefined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "PointTableOf{E}"))]
pub struct PointTable<E> {
    /// The kind of document.
    pub schema: JuryName,
    /// The model's title; empty where it has none.
    pub title: String,
    /// The kind of time.
    pub time: Time,
    /// Whose table it is.
    pub table: TableKind,
    /// None is in question.
    pub parameter: (),
    /// The values of the parameters, and of constants that were replaced.
    pub set: Named<Exact>,
    /// The region.
    #[serde(flatten)]
    pub region: RegionBound,
    /// The rows.
    pub rows: Vec<Row<E>>,
    /// The conditions of stability.
    pub conditions: Vec<Condition<E, Holds>>,
    /// Whether all conditions hold: the loop is defined and stable.
    pub holds: bool,
}

/// No table.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RowsOpen {
    /// Not known.
    pub rows: (),
}

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "RowOf{E}"))]
pub struct Row<E> {
    /// `a`, `b`, ... of Jury's table, `s^n`, ... of Routh's.
    pub name: String,
    /// The entries from the left.
    pub entries: Vec<E>,
    /// The entry that the row was divided by, such as `a_0`; `null` where it was not.
    pub divided_by: Option<String>,
}

/// How the sides of a condition compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Relation {
    /// The left side is greater.
    #[serde(rename = "left > right")]
    Greater,
    /// The left side has the greater absolute value.
    #[serde(rename = "|left| > |right|")]
    GreaterAbsolute,
    /// The left side has the smaller absolute value.
    #[serde(rename = "|left| < |right|")]
    SmallerAbsolute,
}

impl From<Comparison> for Relation {
    fn from(comparison: Comparison) -> Self {
        match comparison {
            Comparison::Greater => Relation::Greater,
            Comparison::GreaterAbsolute => Relation::GreaterAbsolute,
            Comparison::SmallerAbsolute => Relation::SmallerAbsolute,
        }
    }
}

/// A condition of stability.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "ConditionWith{R}"))]
pub struct Condition<E, R> {
    /// As textbooks write it.
    pub name: String,
    /// How the sides compare.
    pub relation: Relation,
    /// The left side.
    pub left: E,
    /// The right side.
    pub right: E,
    /// The row of the table that it is on; `null` for the values at 1 and -1, and for minors.
    pub row: Option<String>,
    /// Where it holds.
    #[serde(flatten)]
    pub result: R,
}

/// Where a condition holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Solution {
    /// The values of the parameter for which it holds, as intervals in ascending order; empty: never.
    pub solution: Vec<Bounds<PlainEnd>>,
}

impl From<Vec<Bounds<PlainEnd>>> for Solution {
    fn from(solution: Vec<Bounds<PlainEnd>>) -> Self {
        Solution { solution }
    }
}

/// Whether a condition holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Holds {
    /// Whether it holds at the point.
    pub holds: bool,
}

/// A polynomial in the parameter.
fn polynomial(p: &ScaledPoly) -> Vec<Exact> {
    let mut list: Vec<Exact> = coefficients(p).iter().map(Exact::from).collect();
    if list.is_empty() {
        list.push((&Rational::ZERO).into());
    }
    list
}

/// A polynomial that is a number.
fn constant(p: &ScaledPoly) -> Exact {
    polynomial(p).swap_remove(0)
}

fn table_rows<E>(test: &ClassicalTest, entry: fn(&ScaledPoly) -> E) -> Vec<Row<E>> {
    let row = |r: crate::table::Row| Row {
        name: r.name,
        entries: r.entries.iter().map(entry).collect(),
        divided_by: r.divided_by,
    };
    rows(test).into_iter().map(row).collect()
}

/// The row of the table that a condition is on; none for the values at 1 and -1.
fn condition_row(test: &ClassicalTest, index: usize) -> Option<String> {
    match &test.table {
        Table::Jury(_) => index.checked_sub(2).map(row_name),
        Table::Routh(_) => Some(format!("s^{}", order(test).saturating_sub(index + 1))),
        Table::Hermitian(_) => None,
    }
}

fn conditions<E, R>(
    test: &ClassicalTest,
    entry: fn(&ScaledPoly) -> E,
    result: impl Fn(&jurist_engine::stability::Condition) -> R,
) -> Vec<Condition<E, R>> {
    let condition = |(index, condition): (usize, &jurist_engine::stability::Condition)| {
        let (relation, left, right) = match &condition.inequality {
            Inequality::Positive(f) => {
                let zero = ScaledPoly { scale: Rational::ONE, polynomial: UniPoly::zero() };
                (Relation::Greater, entry(f), entry(&zero))
            }
            // Textbooks write the first row's condition the other way round: |a_0| < a_n.
            Inequality::Dominates { left, right } if condition.name.contains('<') => {
                (Relation::SmallerAbsolute, entry(right), entry(left))
            }
            Inequality::Dominates { left, right } => (Relation::GreaterAbsolute, entry(left), entry(right)),
        };
        let (name, row) = (condition.name.clone(), condition_row(test, index));
        Condition { name, relation, left, right, row, result: result(condition) }
    };
    test.conditions.iter().enumerate().map(condition).collect()
}

impl JuryInParameter {
    /// The document, also of a table that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, answer: Result<&ParametricTable, &Exhausted>, digits: usize) -> Self {
        let solved = |answer: &ParametricTable| {
            // The stable set is the conditions' intersection, end by end, and knows the causes.
            let intersection = End::intervals(&answer.stable, problem, digits);
            if let Some(test) = &answer.enclosed {
                return TableInParameter::Enclosed(enclosed_table(test, intersection, digits));
            }
            let test = answer.test.as_ref();
            let solution = |c: &jurist_engine::stability::Condition| {
                let ends = c.solution.intervals().iter();
                let real = |end: &Option<RealAlgebraic>| end.clone().map(Real::from);
                PlainEnd::intervals(ends.map(|i| [real(&i.lower), real(&i.upper)]), digits).into()
            };
            TableInParameter::Exact(SolvedTable {
                rows: test.map(|t| table_rows(t, polynomial)).unwrap_or_default(),
                cleared_by: test.and_then(|t| t.cleared_by.as_ref()).map(Exact::coefficients),
                conditions: test.map(|t| conditions(t, polynomial, solution)).unwrap_or_default(),
                intersection,
            })
        };
        JuryInParameter {
            schema: JuryName::V1,
            // The conditions are solved inside of the domain.
            question: ParameterQuestion { domain_closed: None, ..ParameterQuestion::new(problem) },
            table: problem.into(),
            answer: Answered::of(answer, solved),
        }
    }
}

impl JuryAtPoint {
    /// The document, also of a table that the budget did not allow.
    pub fn new(problem: &Problem, answer: Result<&answer::PointTable, &Exhausted>) -> Self {
        let schema = JuryName::V1;
        let answer = match answer {
            Ok(answer) => answer,
            Err(stopped) => {
                return JuryAtPoint::Undecided { schema, question: PointQuestion::new(problem), open: stopped.into() };
            }
        };
        if let Some(table) = &answer.enclosed {
            let rows = table.rows.iter().map(enclosed_row).collect();
            let conditions = table.conditions.iter().map(|c| enclosed_condition(c, &table.rows)).collect();
            return JuryAtPoint::Enclosed(point_table(problem, rows, conditions, answer.holds()));
        }
        let test = answer.test.as_ref();
        let holds = |c: &jurist_engine::stability::Condition| Holds { holds: !c.solution.intervals().is_empty() };
        let rows = test.map(|t| table_rows(t, constant)).unwrap_or_default();
        let conditions = test.map(|t| conditions(t, constant, holds)).unwrap_or_default();
        JuryAtPoint::Known(point_table(problem, rows, conditions, answer.holds()))
    }
}

fn point_table<E>(
    problem: &Problem,
    rows: Vec<Row<E>>,
    conditions: Vec<Condition<E, Holds>>,
    holds: bool,
) -> PointTable<E> {
    PointTable {
        schema: JuryName::V1,
        title: title(problem),
        time: problem.time(),
        table: problem.into(),
        parameter: (),
        set: problem.set().into(),
        region: problem.into(),
        rows,
        conditions,
        holds,
    }
}

fn bounds(e: &jurist_algebra::number::Enclosure) -> Enclosure {
    enclosure(e.lower(), e.upper())
}

/// A table whose coefficients are enclosed.
fn enclosed_table(test: &SymbolicTest, intersection: Vec<Bounds<End>>, digits: usize) -> SolvedTable<Enclosure> {
    let polynomial = |p: &Vec<jurist_algebra::number::Enclosure>| -> Vec<Enclosure> {
        if p.is_empty() { vec![enclosure(&Rational::ZERO, &Rational::ZERO)] } else { p.iter().map(bounds).collect() }
    };
    let row = |row: &SymbolicRow| Row {
        name: row.name.clone(),
        entries: row.entries.iter().map(polynomial).collect(),
        divided_by: row.divided_by.clone(),
    };
    let condition = |c: &SymbolicCondition| Condition {
        name: c.name.clone(),
        relation: c.comparison.into(),
        left: polynomial(&c.left),
        right: polynomial(&c.right),
        row: c.row.map(|k| test.rows[k].name.clone()),
        result: PlainEnd::intervals(c.solution.intervals.iter().cloned(), digits).into(),
    };
    SolvedTable {
        rows: test.rows.iter().map(row).collect(),
        cleared_by: test.cleared_by.as_ref().map(polynomial),
        conditions: test.conditions.iter().map(condition).collect(),
        intersection,
    }
}

fn enclosed_row(row: &EnclosedRow) -> Row<Enclosure> {
    let entries = row.entries.iter().map(bounds).collect();
    Row { name: row.name.clone(), entries, divided_by: row.divided_by.clone() }
}

fn enclosed_condition(c: &EnclosedCondition, rows: &[EnclosedRow]) -> Condition<Enclosure, Holds> {
    Condition {
        name: c.name.clone(),
        relation: c.comparison.into(),
        left: bounds(&c.left),
        right: bounds(&c.right),
        row: c.row.map(|k| rows[k].name.clone()),
        result: Holds { holds: c.holds },
    }
}

impl Document for Answer<ParametricTable> {
    type Json = JuryInParameter;

    /// The document `jurist/jury/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        JuryInParameter::new(self.problem(), Ok(self.value()), digits)
    }
}

impl Document for Answer<answer::PointTable> {
    type Json = JuryAtPoint;

    /// The document `jurist/jury/1` at a point.
    fn json(&self, _digits: usize) -> Self::Json {
        JuryAtPoint::new(self.problem(), Ok(self.value()))
    }
}
