//! The classical table: numeric at a point, or in one parameter with its conditions solved.

use super::prepare::prepare;
use super::question::{Settings, in_region, one_parameter, region_of};
use super::{Decision, Failure, OneParameter};
use crate::error::Diagnostic;
use crate::limits::Budget;
use crate::model::{Loop, Question, Time};
use crate::number::Rational;
use crate::poly::Poly;
use crate::stability::{
    ClassicalTest, JuryTable, Region, RouthTable, StableSet, classical_test, jury_table, routh_table, stable_set,
};

/// The table of a loop with one parameter, its conditions, and the check against the boundary way.
#[derive(Clone, Debug)]
pub struct TableAnswer {
    /// The question.
    pub question: OneParameter,
    /// The table and the solved conditions; `None` when the loop is undefined for every value.
    pub test: Decision<Option<ClassicalTest>>,
    /// The stable set found independently, from the boundary polynomials. Its ends are those of the
    /// conditions' intersection: a difference is a defect and refuses the answer.
    pub stable: Decision<StableSet>,
}

/// The table with polynomial entries and each condition's own exact solution set.
///
/// The intersection of the conditions is compared with the stable set from the boundary polynomials,
/// each time.
///
/// # Errors
/// [`Failure`] when the question is refused, or the two ways disagree (a defect of this program).
pub fn parametric_table(
    lp: &Loop,
    settings: &Settings,
    parameter: &str,
    budget: &Budget,
) -> Result<TableAnswer, Failure> {
    let question = one_parameter(lp, settings, parameter, budget)?;
    let Some(p) = &question.polynomial else {
        let (test, stable) = (Decision::Decided(None), Decision::Decided(StableSet::default()));
        return Ok(TableAnswer { question, test, stable });
    };
    let stable = Decision::from_result(stable_set(p, &question.domain, question.region, budget), budget);
    let test = classical_test(p, &question.domain, question.region, budget).map(Some);
    let test = Decision::from_result(test, budget);
    if let (Some(Some(test)), Some(set)) = (test.decided(), stable.decided())
        && !test.intersection.same_as(&set.to_interval_set())
    {
        return Err(Diagnostic::error("E-internal", "the table's conditions and the boundary polynomials disagree")
            .help("this is a defect of jurist: please report it with the model")
            .into());
    }
    Ok(TableAnswer { question, test, stable })
}

/// The table at a point.
#[derive(Clone, Debug)]
pub struct NumericTable {
    /// The loop's title.
    pub title: Option<String>,
    /// Discrete or continuous time.
    pub time: Time,
    /// The values of all parameters.
    pub set: Vec<(String, Rational)>,
    /// The coefficients from the constant term up.
    pub coefficients: Vec<Rational>,
    /// The table in discrete time.
    pub jury: Option<JuryTable<Rational>>,
    /// The table in continuous time.
    pub routh: Option<RouthTable<Rational>>,
}

/// The table with every parameter at its set or nominal value; `None` where the loop is undefined.
///
/// # Errors
/// [`Failure`] when the question is refused or the budget runs out.
pub fn numeric_table(lp: &Loop, settings: &Settings, budget: &Budget) -> Result<Option<NumericTable>, Failure> {
    let region = region_of(lp, settings)?;
    let question = Question { keep: Vec::new(), set: settings.set.clone() };
    let answer = prepare(lp, &question, budget)?;
    let Some(d) = answer.polynomial else { return Ok(None) };
    let d = in_region(d, settings);
    let Some(coefficients) = d.at(&[]) else { return Ok(None) };
    let n = d.formal_degree;
    let polynomial = Poly::new(coefficients.clone());
    Ok(Some(NumericTable {
        title: lp.title().map(str::to_string),
        time: lp.time(),
        set: answer.values,
        coefficients,
        jury: (region == Region::UnitDisc).then(|| jury_table(&polynomial, n)),
        routh: (region == Region::LeftHalfPlane).then(|| routh_table(&polynomial, n)),
    }))
}
