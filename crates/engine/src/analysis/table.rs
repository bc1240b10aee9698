//! The classical table: numeric at a point, or in one parameter with its conditions solved.

use super::prepare::prepare;
use super::question::{Settings, in_region, one_parameter_or_stopped, parametric, region_of};
use super::{Decision, Failure, OneParameter};
use crate::error::Diagnostic;
use crate::model::{Loop, Question, Time};
use crate::stability::{ClassicalTest, Range, StableSet, classical_test, stable_set};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

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
/// [`Failure::Refused`] when the question is refused, or the two ways disagree (a defect of this program).
pub fn parametric_table(
    lp: &Loop,
    settings: &Settings,
    parameter: &str,
    budget: &Budget,
) -> Result<TableAnswer, Failure> {
    let question = match one_parameter_or_stopped(lp, settings, parameter, budget)? {
        Ok(question) => question,
        Err((question, stopped)) => {
            let test = Decision::from_result(Err(stopped.clone()), budget);
            return Ok(TableAnswer { question, test, stable: Decision::from_result(Err(stopped), budget) });
        }
    };
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
pub struct PointTable {
    /// The loop's title.
    pub title: Option<String>,
    /// Discrete or continuous time.
    pub time: Time,
    /// The values of all parameters.
    pub set: Vec<(String, Rational)>,
    /// The radius asked for, if any.
    pub radius: Option<Rational>,
    /// The decay rate asked for, if any.
    pub decay: Option<Rational>,
    /// The table with constant entries: each condition holds everywhere or nowhere. `None` where the
    /// loop is undefined.
    pub test: Option<ClassicalTest>,
    /// Remarks on the question.
    pub warnings: Vec<Diagnostic>,
}

impl PointTable {
    /// Whether all conditions hold: the loop is defined and stable.
    pub fn holds(&self) -> bool {
        self.test.as_ref().is_some_and(|test| !test.intersection.intervals().is_empty())
    }
}

/// The table with every parameter at its set or nominal value.
///
/// # Errors
/// [`Failure`] when the question is refused or the budget runs out.
pub fn point_table(lp: &Loop, settings: &Settings, budget: &Budget) -> Result<PointTable, Failure> {
    let region = region_of(lp, settings)?;
    budget.step("characteristic polynomial");
    let answer = prepare(lp, &Question { keep: Vec::new(), set: settings.set.clone() }, budget)?;
    let test = match answer.polynomial {
        None => None,
        Some(d) => {
            let p = parametric(&in_region(d, settings));
            // A coefficient or a pole of a point is a number.
            let undefined = p.is_undefined_at(&Rational::ZERO);
            if undefined { None } else { Some(classical_test(&p, &Range::all(), region, budget)?) }
        }
    };
    Ok(PointTable {
        title: lp.title().map(str::to_string),
        time: lp.time(),
        set: answer.values,
        radius: settings.radius.clone(),
        decay: settings.decay.clone(),
        test,
        warnings: settings.warnings(lp, &[]),
    })
}
