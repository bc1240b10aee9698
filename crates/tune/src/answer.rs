//! The answer: no gains at all, or the best ones.

use crate::asked::{Asked, Gain, Objective};
use crate::conflict::conflict;
use crate::lines::Lines;
use crate::plants::plants_of_model;
use crate::typed::{Typed, typed};
use crate::{many_gains, one_gain, two_gains};
use jurist_algebra::limits::{Budget, Exhausted, apart};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::real::Real;
use jurist_engine::coverage::CoefficientRing;
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::problem::{Problem, Question};
use jurist_engine::response::{AllOf, Level, Requirements};
use std::sync::Arc;

/// The part of the budget for the search.
const SEARCH: (u32, u32) = (9, 10);

/// The best gains of a loop, or that there are none.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TuneAnswer {
    /// The question with all gains free.
    pub problem: Arc<Problem>,
    /// What was asked.
    pub asked: Asked,
    /// What was found.
    pub outcome: Outcome,
    /// Numerator and denominator of an expression that is to be best, in the gains.
    pub formula: Option<[MultiPoly; 2]>,
    /// Whether the search ended early and would be shorter with bounds.
    pub(crate) are_bounds_missing: bool,
}

/// What was found.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// No gains meet what is required: the names of requirements and bounds that exclude each other, each of them needed for that.
    Infeasible {
        /// The names.
        conflict: Vec<String>,
        /// So many boxes of gains prove it; `None` where sets or maps do.
        cells: Option<usize>,
    },
    /// The best.
    Optimum(Box<Optimum>),
    /// The work ended before it was known whether there are any gains.
    Open {
        /// Why.
        stopped: Exhausted,
        /// No gains have a better value of the objective than this; `None` where nothing bounds it.
        proved: Option<Rational>,
    },
}

/// The best value and its gains.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Optimum {
    /// The best value: of a gain, or of a level in its scale.
    pub value: Best,
    /// The gains there, in the order in which they were asked for.
    pub at: Vec<Place>,
    /// Whether gains have the best value; they come as near as you like else. `None` where that is not known.
    pub attained: Option<bool>,
    /// What binds: names of requirements, causes of a limit of stability, `bound`.
    pub binding: Vec<String>,
    /// Gains that meet all requirements.
    pub found: Vec<Rational>,
    /// A value that these have at least: of the objective, or of the level in its scale.
    pub found_value: Option<Rational>,
    /// The gains that are typed in.
    pub typed: Option<Typed>,
    /// Why the bracket is wider than the gap, or something else is not known.
    pub stopped: Option<Exhausted>,
    /// So many boxes of gains prove the bracket; `None` where sets or maps do.
    pub cells: Option<usize>,
}

impl Optimum {
    /// A best value with gains that meet what is required; nothing more is known of it.
    pub(crate) fn new(value: Best, at: Vec<Place>, found: Vec<Rational>, found_value: Option<Rational>) -> Optimum {
        Optimum {
            value,
            at,
            attained: None,
            binding: Vec::new(),
            found,
            found_value,
            typed: None,
            stopped: None,
            cells: None,
        }
    }

    /// Gains that meet what is required, where the best ones are not known.
    pub(crate) fn some(found: Vec<Rational>) -> Optimum {
        Optimum::new(Best::Nothing, Vec::new(), found, None)
    }
}

impl Outcome {
    /// Nothing is known of any gains.
    pub(crate) fn open(stopped: Exhausted) -> Outcome {
        Outcome::Open { stopped, proved: None }
    }
}

impl From<Optimum> for Outcome {
    fn from(optimum: Optimum) -> Outcome {
        Outcome::Optimum(Box::new(optimum))
    }
}

/// A best value.
#[derive(Clone, Debug)]
pub enum Best {
    /// Exactly.
    Exact(Real),
    /// There is none: it grows without end.
    Unbounded,
    /// Zero, which the scale of a peak has at its far end.
    Zero,
    /// Some gains have the first one, none the second one.
    Between([Rational; 2]),
    /// Nothing was to be best.
    Nothing,
}

/// The value of a gain at the optimum.
#[derive(Clone, Debug)]
pub enum Place {
    /// Exactly.
    Exact(Real),
    /// Between two numbers.
    Between([Rational; 2]),
    /// Everywhere from one number to another; `None` is no end.
    From((Option<Rational>, Option<Rational>)),
    /// It grows without end.
    Unbounded,
}

impl TuneAnswer {
    /// The best gains.
    ///
    /// Cost: of one gain and an objective that is a gain, one set of requirements; of a level, one for each halving of the critical values, or of the
    /// bracket. Of two gains and an objective that is a gain, one map; of a level, one for each halving of the bracket. Of more, boxes: from some hundred
    /// to some ten thousand, each as [`RequirementBoxes::look`](jurist_engine::response::RequirementBoxes::look).
    ///
    /// # Errors
    /// `E-tune-bounds` where boxes are searched and a gain has no bounds; as [`Problem::required_set`], and [`Answer::with_requirements`](jurist_engine::answer::Answer::with_requirements) for two gains.
    pub fn of(question: &Question, asked: Asked, budget: &Budget) -> Result<TuneAnswer, Error> {
        let mut asked = asked;
        let own = Lines::new(question, &asked, budget)?.own_region();
        asked.requirements.region = asked.requirements.region.or(own);
        if asked.objective == Objective::SettlingTime(Level::Radius) {
            asked.sample_time = Some(sample_time(question, &asked, budget)?);
        }
        let lines = Lines::new(question, &asked, budget)?;
        let problem = lines.problem()?;
        problem.refuse_written_complex().map_err(|_| of_complex_loops())?;
        if asked.between().is_some() && problem.coefficient_ring(budget)? == CoefficientRing::DeadTime {
            return Err(of_norms_with_dead_time());
        }
        if matches!(asked.objective, Objective::Tolerance(_)) && !asked.for_all.is_empty() {
            let error = Diagnostic::error(Code::TuneObjective, "a tolerance of the gains is not asked for all plants");
            return Err(error.help("ask for another number, or leave out --for-all and --robust").into());
        }
        // What is left is for gains of few digits.
        let share = budget.share(SEARCH.0, SEARCH.1);
        let searched = lines.with_budget(&share);
        let found = match searched.part(|| best(&searched)) {
            // Bounds hold without any work.
            Err(Error::Stopped(stopped)) => Outcome::open(stopped),
            found => found?,
        };
        let are_bounds_missing =
            matches!(&found, Outcome::Open { .. }) && lines.part(|| lines.are_bounds_missing()).unwrap_or(false);
        let found = match found {
            Outcome::Open { stopped, proved } => nominal(&lines, stopped, proved)?,
            found => found,
        };
        let outcome = match found {
            Outcome::Infeasible { cells, .. } => Outcome::Infeasible { conflict: conflict(&lines, cells)?, cells },
            Outcome::Optimum(mut optimum) => {
                // A decay without bound.
                if matches!((&asked.objective, &optimum.value), (Objective::SettlingTime(_), Best::Unbounded)) {
                    optimum.value = Best::Zero;
                }
                if asked.objective != Objective::Anything {
                    optimum.typed = match lines.part(|| typed(&lines, &optimum)) {
                        // What is known is an answer without them.
                        Err(Error::Stopped(stopped)) => {
                            optimum.stopped.get_or_insert(stopped);
                            None
                        }
                        found => found?,
                    };
                }
                no_smaller_radius(&asked, &mut optimum);
                Outcome::Optimum(optimum)
            }
            Outcome::Open { stopped, proved } => {
                Outcome::Open { stopped, proved: proved.or_else(|| apart(|| within_bounds(&lines))) }
            }
        };
        let formula = lines.formula.as_ref().map(|formula| formula.parts().map(Clone::clone));
        Ok(TuneAnswer { problem, outcome, asked, formula, are_bounds_missing })
    }

    /// The best gains as the section `[tune]` of the model asks for them, with the values of the question for all other names.
    ///
    /// # Errors
    /// As [`TuneAnswer::of`]; `E-tune-free` for a model without such a section, or with one that frees no gain.
    pub fn of_model(question: &Question, budget: &Budget) -> Result<TuneAnswer, Error> {
        let model = question.model();
        let gains = model.tuning().into_iter().flat_map(|tuning| &tuning.free).map(|name| name.name.clone());
        let gains: Vec<Gain> = gains.map(Gain::new).collect();
        let for_all = plants_of_model(question, &gains)?;
        let middle = |all: &AllOf| (all.name.clone(), all.range[0].midpoint(&all.range[1]));
        let question = &question.clone().set_all(for_all.iter().map(middle));
        let free = gains.iter().fold(question.clone(), |question, gain| question.without_value(&gain.name));
        let requirements = Requirements::of(model, &[], &values(&free), budget)?;
        let mut asked = Asked::of_model(model, gains, requirements)?;
        asked.for_all = for_all;
        TuneAnswer::of(&free, asked, budget)
    }

    /// Whether some gains meet what is required; `None` where it is open.
    pub fn is_feasible(&self) -> Option<bool> {
        match &self.outcome {
            Outcome::Infeasible { .. } => Some(false),
            Outcome::Optimum(_) => Some(true),
            Outcome::Open { .. } => None,
        }
    }

    /// So many boxes of gains prove the answer; `None` where sets or maps do.
    pub fn cells(&self) -> Option<usize> {
        match &self.outcome {
            Outcome::Optimum(optimum) => optimum.cells,
            Outcome::Infeasible { cells, .. } => *cells,
            Outcome::Open { .. } => None,
        }
    }

    /// Why something is open.
    pub fn stopped(&self) -> Option<&Exhausted> {
        match &self.outcome {
            Outcome::Optimum(optimum) => optimum.stopped.as_ref(),
            Outcome::Open { stopped, .. } => Some(stopped),
            Outcome::Infeasible { .. } => None,
        }
    }
}

/// Where the gains that are typed in have the radius 0, no gains are better.
fn no_smaller_radius(asked: &Asked, optimum: &mut Optimum) {
    let is_radius = matches!(asked.level(), Some(Level::Radius));
    let Some(typed) = optimum.typed.as_ref().filter(|_| is_radius && matches!(optimum.value, Best::Between(_))) else {
        return;
    };
    if typed.value.as_ref().is_none_or(|value| !value.upper().is_zero()) {
        return;
    }
    optimum.found.clone_from(&typed.values);
    optimum.at = typed.values.iter().map(|x| Place::Exact(x.clone().into())).collect();
    (optimum.value, optimum.found_value) = (Best::Exact(Rational::ZERO.into()), Some(Rational::ZERO));
    (optimum.attained, optimum.stopped, optimum.cells) = (Some(true), None, None);
    optimum.binding.clear();
}

fn of_complex_loops() -> Error {
    let message = "the best gains of a loop with complex coefficients are not known";
    let help = "'jurist intervals' says which values of one gain are good, 'jurist map' which of two; in real form, with two signals for each \
                complex one, the loop has best gains";
    Diagnostic::error(Code::Complex, message).help(help).into()
}

/// The nominal gains, where the search found none and these meet what is required.
fn nominal(lines: &Lines<'_>, stopped: Exhausted, proved: Option<Rational>) -> Result<Outcome, Error> {
    match lines.part(|| lines.nominal()) {
        Ok(Some(point)) => {
            let own = match (&lines.asked.objective, &lines.formula) {
                (Objective::Greatest(gain) | Objective::Least(gain), _) => Some(point[*gain].clone()),
                (Objective::Formula { .. }, Some(formula)) => formula.at(&point),
                _ => None,
            };
            let proved = proved.or_else(|| apart(|| within_bounds(lines)));
            let optimum = match (own, proved) {
                (Some(own), Some(proved)) if own != proved => {
                    let places = point.iter().map(|x| Place::Exact(x.clone().into())).collect();
                    let bracket = Best::Between([own.clone(), proved]);
                    Optimum { cells: Some(0), ..Optimum::new(bracket, places, point, Some(own)) }
                }
                _ => Optimum::some(point),
            };
            Ok(Optimum { stopped: Some(stopped), ..optimum }.into())
        }
        Ok(None) | Err(Error::Stopped(_)) => Ok(Outcome::Open { stopped, proved }),
        Err(error) => Err(error),
    }
}

fn of_norms_with_dead_time() -> Error {
    let message = "the least peak gain between two signals is not known of loops with dead time";
    let help = "'jurist norm' says the peak gain of given gains; make a margin best, such as 'max modulus_margin', the inverse of the peak of the sensitivity";
    Diagnostic::error(Code::DeadTime, message).help(help).into()
}

/// The sample time that a settling time is counted in.
fn sample_time(question: &Question, asked: &Asked, budget: &Budget) -> Result<Rational, Error> {
    let problem = Lines::new(question, asked, budget)?.problem()?;
    let refused = |message: &str, help: &str| Diagnostic::error(Code::TuneObjective, message).help(help);
    let help = "make the radius small: 'min radius'";
    match problem.algebra_over_symbols(budget)?.sample_time() {
        None => Err(refused("a settling time needs the loop's sample time", help).into()),
        Some(time) => time.as_constant().ok_or_else(|| {
            refused("a settling time needs a number as the sample time; this sample time depends on a gain", help)
                .into()
        }),
    }
}

/// The values that were set.
fn values(question: &Question) -> Vec<(String, Rational)> {
    question.values_set().iter().map(|(name, value)| (name.clone(), value.clone())).collect()
}

/// A value of the objective that the bounds of the gains alone do not let be better.
fn within_bounds(lines: &Lines<'_>) -> Option<Rational> {
    match (&lines.asked.objective, &lines.formula) {
        (Objective::Greatest(gain), _) => lines.range(*gain).upper.clone(),
        (Objective::Least(gain), _) => lines.range(*gain).lower.clone(),
        (Objective::Formula { is_greatest, .. }, Some(formula)) => {
            let ends = |gain: usize| Some([lines.range(gain).lower.clone()?, lines.range(gain).upper.clone()?]);
            let sides: Vec<[Rational; 2]> = (0..lines.asked.gains.len()).map(ends).collect::<Option<_>>()?;
            formula.range(&sides).map(|ends| ends[usize::from(*is_greatest)].clone())
        }
        _ => None,
    }
}

/// The best of what is asked, by the method that fits.
fn best(lines: &Lines<'_>) -> Result<Outcome, Error> {
    match lines.asked.gains.len() {
        _ if lines.are_boxes_asked()? => many_gains::best(lines),
        1 => one_gain::best(lines),
        _ => two_gains::best(lines),
    }
}
