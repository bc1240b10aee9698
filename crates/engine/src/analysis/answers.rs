//! Verdicts at a point and exact stable sets.

use super::prepare::prepare;
use super::question::{Settings, in_region, nominal, one_parameter_or_stopped, parametric, region_of};
use super::{Failure, OneParameter, Point, RADIUS};
use crate::error::Diagnostic;
use crate::model::{Loop, Question, Time};
use crate::stability::{AtPoint, Cause, RootCount, StableSet, stable_set};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;

/// An exact answer, or the budget that ran out before it and what had been reached.
#[derive(Clone, Debug)]
pub enum Decision<T> {
    /// The answer.
    Decided(T),
    /// None within the budget.
    Undecided {
        /// Which budget.
        budget: String,
        /// The last step begun.
        reached: String,
    },
}

impl<T> Decision<T> {
    /// The answer, if there is one.
    pub fn decided(&self) -> Option<&T> {
        match self {
            Decision::Decided(value) => Some(value),
            Decision::Undecided { .. } => None,
        }
    }

    pub(super) fn from_result(result: Result<T, Exhausted>, budget: &Budget) -> Self {
        match result {
            Ok(value) => Decision::Decided(value),
            Err(exhausted) => Decision::Undecided { budget: exhausted.budget, reached: budget.reached() },
        }
    }
}

/// For which values of one parameter the loop is stable.
#[derive(Clone, Debug)]
pub struct Intervals {
    /// The question.
    pub question: OneParameter,
    /// The exact stable set.
    pub stable: Decision<StableSet>,
}

/// The exact stable set of one parameter, all others at their set or nominal values.
///
/// ```
/// use jurist_engine::analysis::{Settings, intervals};
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::Loop;
/// let answer = intervals(&Loop::drive(), &Settings::default(), "K_pwm", &Budget::unlimited()).unwrap();
/// let set = answer.stable.decided().unwrap();
/// let lower = set.intervals()[0].lower.as_ref().unwrap();
/// assert_eq!(lower.value.decimal(10), "0.03810053335");
/// ```
///
/// # Errors
/// [`Failure::Refused`] when the question is refused. A budget that ends is a [`Decision::Undecided`].
pub fn intervals(lp: &Loop, settings: &Settings, parameter: &str, budget: &Budget) -> Result<Intervals, Failure> {
    let question = match one_parameter_or_stopped(lp, settings, parameter, budget)? {
        Ok(question) => question,
        Err((question, stopped)) => {
            return Ok(Intervals { question, stable: Decision::from_result(Err(stopped), budget) });
        }
    };
    let stable = match &question.polynomial {
        None => Decision::Decided(StableSet::default()),
        Some(p) => {
            let set = stable_set(p, &question.domain, question.region, budget);
            Decision::from_result(set.map(|set| own_causes(set, &question)), budget)
        }
    };
    Ok(Intervals { question, stable })
}

/// `D(r z)` is a constant at `r = 0`: that is of the substitution's making, no root of the loop is lost.
fn own_causes(mut set: StableSet, question: &OneParameter) -> StableSet {
    if question.parameter == RADIUS && question.time == Time::Discrete {
        for end in set.ends_mut().filter(|end| end.value.sign().is_eq()) {
            end.causes.remove(Cause::DegreeLost);
        }
    }
    set
}

/// The verdict on a loop whose parameters all have values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// All roots strictly inside.
    Stable,
    /// None outside, at least one on the boundary.
    Marginal,
    /// At least one root outside or at infinity.
    Unstable,
    /// An expression of the model divides by zero, a block loses its order, or the loop is not well posed.
    Undefined,
}

impl Verdict {
    /// The name used in all output.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Stable => "stable",
            Verdict::Marginal => "marginal",
            Verdict::Unstable => "unstable",
            Verdict::Undefined => "undefined",
        }
    }
}

/// The verdict at one point, with the exact root count.
#[derive(Clone, Debug)]
pub struct PointVerdict {
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
    /// The verdict.
    pub verdict: Verdict,
    /// Why the loop is undefined at the point, where that is known.
    pub undefined: Option<String>,
    /// The degree of the polynomial in all parameters.
    pub degree: usize,
    /// Finite roots by place; `None` at an undefined point.
    pub count: Option<RootCount>,
    /// Roots that have left through infinity.
    pub infinite: usize,
    /// Remarks on the question.
    pub warnings: Vec<Diagnostic>,
}

/// The verdict with every parameter at its set or nominal value.
///
/// # Errors
/// [`Failure`] when the question is refused or the budget runs out.
pub fn verdict(lp: &Loop, settings: &Settings, budget: &Budget) -> Result<PointVerdict, Failure> {
    let region = region_of(lp, settings)?;
    budget.step("characteristic polynomial");
    let answer = prepare(lp, &Question { keep: Vec::new(), set: settings.set.clone() }, budget)?;
    let at = match answer.polynomial {
        None => AtPoint::Undefined,
        Some(d) => {
            budget.step("counting the roots");
            parametric(&in_region(d, settings)).at_within(&Rational::ZERO, region, budget)?
        }
    };
    let degree = answer.formal_degree;
    let (verdict, count, infinite) = match at {
        AtPoint::Undefined => (Verdict::Undefined, None, 0),
        AtPoint::Zero => (Verdict::Unstable, Some(RootCount::default()), degree),
        AtPoint::Defined { count, infinite } => {
            let verdict = match (count.outside + infinite, count.on) {
                (0, 0) => Verdict::Stable,
                (0, _) => Verdict::Marginal,
                _ => Verdict::Unstable,
            };
            (verdict, Some(count), infinite)
        }
    };
    Ok(PointVerdict {
        title: lp.title().map(str::to_string),
        time: lp.time(),
        set: answer.values,
        radius: settings.radius.clone(),
        decay: settings.decay.clone(),
        verdict,
        undefined: answer.undefined,
        degree,
        count,
        infinite,
        warnings: settings.warnings(lp, &[]),
    })
}

/// The verdict at the nominal point and the stable set of each parameter, the others nominal.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// At the set or nominal values; `None` when one of them is missing.
    pub verdict: Option<Decision<PointVerdict>>,
    /// What the verdict is about; `None` when a value is missing.
    pub point: Option<Point>,
    /// One for each parameter that is not set and whose companions all have values.
    pub intervals: Vec<Intervals>,
    /// Remarks on the question.
    pub warnings: Vec<Diagnostic>,
}

impl Analysis {
    /// What is known of the questions before any work.
    pub fn undecided(point: Option<Point>, questions: Vec<OneParameter>, budget: &str, reached: &str) -> Self {
        fn open<T>(budget: &str, reached: &str) -> Decision<T> {
            Decision::Undecided { budget: budget.into(), reached: reached.into() }
        }
        let intervals = questions.into_iter().map(|question| Intervals { question, stable: open(budget, reached) });
        Analysis {
            verdict: point.is_some().then(|| open(budget, reached)),
            point,
            intervals: intervals.collect(),
            warnings: Vec::new(),
        }
    }
}

/// Everything that can be said about a loop one parameter at a time.
///
/// # Errors
/// [`Failure::Refused`] when a question is refused. A budget that ends is a [`Decision::Undecided`].
pub fn analyze(lp: &Loop, settings: &Settings, budget: &Budget) -> Result<Analysis, Failure> {
    let free: Vec<&str> =
        lp.parameters().iter().map(|p| p.name.as_str()).filter(|name| !settings.set.contains_key(*name)).collect();
    let without_value: Vec<&str> = free.iter().copied().filter(|name| nominal(lp, name).is_none()).collect();
    let point = if without_value.is_empty() { Some(Point::of(lp, settings, &[])?) } else { None };
    let verdict = match &point {
        None => None,
        Some(_) => Some(match verdict(lp, settings, budget) {
            Ok(verdict) => Decision::Decided(verdict),
            Err(Failure::Undecided(stopped)) => Decision::from_result(Err(stopped), budget),
            Err(refused) => return Err(refused),
        }),
    };
    let mut answers = Vec::new();
    for name in free {
        if without_value.iter().all(|missing| *missing == name) {
            answers.push(intervals(lp, settings, name, budget)?);
        }
    }
    if verdict.is_none() && answers.is_empty() {
        // Two parameters without values: the question of the first names what is missing.
        intervals(lp, settings, without_value[0], budget)?;
    }
    Ok(Analysis { verdict, point, intervals: answers, warnings: settings.warnings(lp, &[]) })
}
