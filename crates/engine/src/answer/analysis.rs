//! Everything that can be said about a loop one parameter at a time.

use super::{Answer, PointVerdict};
use crate::error::{Code, Error};
use crate::problem::{Problem, Question};
use crate::stability::StableSet;
use jurist_algebra::limits::{Budget, Exhausted, apart};
use std::sync::Arc;

/// The verdict at the nominal point and the stable set of each parameter, the others nominal; each is decided or has
/// stopped on its own.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let analysis = model.ask().analyze(&Budget::unlimited())?;
/// let (_, verdict) = analysis.verdict.as_ref().unwrap();
/// assert_eq!(verdict.as_ref().unwrap().verdict.name(), "stable");
/// let (question, set) = &analysis.sets[0];
/// assert_eq!(question.parameter().name, "K");
/// assert_eq!(set.as_ref().unwrap().intervals().len(), 1);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Analysis {
    /// The question at the point, and its verdict; `None` where a value is missing.
    pub verdict: Option<(Arc<Problem>, Result<PointVerdict, Exhausted>)>,
    /// A question for each parameter that is not set and whose companions all have values, and its stable set.
    pub sets: Vec<(Arc<Problem>, Result<StableSet, Exhausted>)>,
}

impl Analysis {
    /// Why the first answer that is missing is missing.
    pub fn stopped(&self) -> Option<&Exhausted> {
        let verdict = self.verdict.as_ref().and_then(|(_, verdict)| verdict.as_ref().err());
        verdict.or_else(|| self.sets.iter().find_map(|(_, set)| set.as_ref().err()))
    }
}

impl Question {
    /// The verdict with every parameter at its set or nominal value, and the stable set of each that is not set.
    ///
    /// Cost: that of [`Question::verdict`], and that of [`Question::stable_set`] for each parameter that is not
    /// set; the model is evaluated for each.
    ///
    /// # Errors
    /// [`Error::Refused`] when a question is refused. What the budget does not allow is noted in its place.
    ///
    /// # Panics
    /// When a name is free.
    pub fn analyze(self, budget: &Budget) -> Result<Analysis, Error> {
        assert!(self.free_names().is_empty(), "an analysis frees one parameter after the other");
        let model = Arc::clone(self.model());
        let open = model.parameters().iter().filter(|p| !self.values_set().contains_key(&p.name));
        let open: Vec<_> = open.collect();
        let mut without_value = Vec::new();
        for parameter in &open {
            if self.nominal(&parameter.name)?.is_none() {
                without_value.push(parameter);
            }
        }
        let verdict = if without_value.is_empty() {
            let problem = self.clone().problem()?;
            let verdict = stopped(Problem::verdict(&problem, budget).map(Answer::into_value))?;
            Some((problem, verdict))
        } else {
            None
        };
        let mut sets = Vec::new();
        for parameter in &open {
            if without_value.iter().all(|missing| missing.name == parameter.name) {
                // A part is named as well where the budget ended before it.
                let problem = apart(|| self.clone().free(&parameter.name).problem())?;
                let set = open_in_functions(Problem::stable_set(&problem, budget).map(Answer::into_value));
                let set = stopped(set)?;
                sets.push((problem, set));
            }
        }
        if verdict.is_none() && sets.is_empty() {
            // Two parameters without values: the question of the first names what is missing.
            self.free(&without_value[0].name).problem()?;
        }
        Ok(Analysis { verdict, sets })
    }
}

/// A parameter inside of a function whose domain is not bounded: this question of the analysis stays open, not the others.
fn open_in_functions<T>(result: Result<T, Error>) -> Result<T, Error> {
    match result {
        Err(Error::Refused(why)) if why.code() == Code::Function => {
            let reason = why.diagnostics().first().map(|d| d.message.clone()).unwrap_or_default();
            Err(Error::Stopped(Exhausted::by_method("the bounds of its domain", reason)))
        }
        other => other,
    }
}

fn stopped<T>(result: Result<T, Error>) -> Result<Result<T, Exhausted>, Error> {
    match result {
        Ok(value) => Ok(Ok(value)),
        // Not every parameter of a loop with dead time can be asked for: the others are.
        Err(Error::Refused(refused)) if refused.diagnostics().iter().all(|d| d.code == Code::DeadTime) => {
            let why = refused.diagnostics().first().map_or_else(String::new, |d| d.message.clone());
            Ok(Err(Exhausted::by_method(why, "dead time")))
        }
        Err(failure) => failure.stopped().map(Err),
    }
}
