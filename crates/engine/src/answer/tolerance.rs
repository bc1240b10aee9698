//! Tolerances: whether every point of a box is stable, and by how much the box can grow.

mod decide;
mod held;
mod limit;
mod one_name;
mod required;

pub(crate) use held::{SYMBOL_BITS, Truth};

use super::Answer;
use crate::error::{Code, Diagnostic, Error};
use crate::model::{Model, Tolerance};
use crate::problem::{Problem, Question};
use crate::response::Requirement;
use crate::stability::boxes::{BoxDecision, BoxVolume, ExactProof, LargestFactor, Side};
use crate::stability::{AtPoint, End};
use decide::Asked;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What is asked about tolerances.
///
/// ```
/// use jurist_engine::answer::ToleranceRequest;
/// let request = ToleranceRequest::new([("R", "10%".parse()?), ("L", "-20%..+30%".parse()?)]).gap("1/1000".parse().unwrap());
/// assert_eq!(request.tolerances.len(), 2);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ToleranceRequest {
    /// The tolerance of each name.
    pub tolerances: Vec<(String, Tolerance)>,
    /// The relative width of the bracket of the largest factor.
    pub gap: Rational,
    /// The parameter whose safe range is asked for, for all values of the others.
    pub limit: Option<String>,
    /// Whether the largest factor is to be proved as an exact number.
    pub exact: bool,
    /// The share of the box's volume that may stay undecided, where its stable share is asked for.
    pub volume: Option<Rational>,
    /// Whether the largest factor is asked for, or the box alone.
    pub factor: bool,
    /// What has to be met at every point beside stability.
    pub requirements: Vec<Requirement>,
    /// Where margins are taken.
    pub at: Option<String>,
}

impl ToleranceRequest {
    /// The tolerances of a box.
    pub fn new<S: Into<String>>(tolerances: impl IntoIterator<Item = (S, Tolerance)>) -> Self {
        ToleranceRequest {
            tolerances: tolerances.into_iter().map(|(name, t)| (name.into(), t)).collect(),
            gap: Rational::new(Integer::ONE, Integer::from(1_000_000)),
            limit: None,
            exact: false,
            volume: None,
            factor: true,
            requirements: Vec::new(),
            at: None,
        }
    }

    /// The tolerances that stand in the model.
    pub fn of_model(model: &Model) -> Self {
        let parameters = model.parameters().iter().map(|p| (&p.name, &p.tolerance));
        let constants = model.constants().iter().map(|c| (&c.name, &c.tolerance));
        ToleranceRequest::new(constants.chain(parameters).filter_map(|(name, t)| Some((name.clone(), t.clone()?))))
    }

    /// The same with another relative width of the bracket.
    pub fn gap(mut self, gap: Rational) -> Self {
        self.gap = gap;
        self
    }

    /// The same, asking also for the largest factor as an exact number.
    pub fn exact(mut self) -> Self {
        self.exact = true;
        self
    }

    /// The same, asking also which share of the box is stable, up to an undecided share.
    pub fn volume(mut self, undecided: Rational) -> Self {
        self.volume = Some(undecided);
        self
    }

    /// The same, asking for the box alone and not for the largest factor: the fastest answer.
    pub fn box_alone(mut self) -> Self {
        self.factor = false;
        self
    }

    /// The same, with requirements to be met at every point, margins being taken at a cut.
    pub fn require(mut self, requirements: impl IntoIterator<Item = Requirement>, at: Option<String>) -> Self {
        self.requirements.extend(requirements);
        self.at = at;
        self
    }

    /// The same, asking also how far one parameter may go while the others have their tolerances.
    pub fn limit(mut self, name: impl Into<String>) -> Self {
        self.limit = Some(name.into());
        self
    }
}

/// What is known of a box of tolerances.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::ToleranceRequest;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// let (model, _) = Model::builder(Time::Continuous)
///     .parameter(ParameterBuilder::new("a").nominal("1").tolerance("10%"))
///     .characteristic("s^2 + a*s + 1")
///     .build()?;
/// let answer = model.ask().tolerance(&ToleranceRequest::of_model(&model).exact(), &Budget::unlimited())?;
/// let end = &answer.value().worst.as_ref().unwrap().end; // a = 0
/// assert_eq!((end.value.exact(), answer.value().exact.is_some()), (Some(10.into()), true));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ToleranceAnswer {
    /// The tolerances, each a side of the box, in the order of the problem's free parameters.
    pub sides: Vec<Side>,
    /// The root count at the nominal point. Of a complex loop each root is counted with its conjugate.
    pub nominal: AtPoint,
    /// Whether every point of the box is stable.
    pub decision: BoxDecision,
    /// By how much all tolerances can be scaled; `None` where the nominal point is not stable, and where it was not asked for.
    pub factor: Option<LargestFactor>,
    /// Where stability is lost on the line to the worst point; `None` where none was found.
    pub worst: Option<WorstEnd>,
    /// Why the end of that line is the largest factor, where that was asked for and proved.
    pub exact: Option<ExactProof>,
    /// The factor at which the first parameter reaches the end of its domain.
    pub domain_factor: Option<Rational>,
    /// The range of one parameter that is safe for all values of the others.
    pub limit: Option<ToleranceLimit>,
    /// Which share of the box is stable, where that was asked for.
    pub volume: Option<BoxVolume>,
    /// The requirements, each over the box; with them the decision and the factor are those of stability and all of them.
    pub required: Vec<RequiredBox>,
    /// The requirement that bounds the factor, if one does so before stability is lost.
    pub binding: Option<usize>,
}

/// What is known of a requirement over a box.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequiredBox {
    /// What is required.
    pub requirement: Requirement,
    /// Whether it is met at every point (`Stable`), or a point at which it is not.
    pub decision: BoxDecision,
    /// By how much the box can grow while it is met; `None` where it is not met at the nominal point.
    pub factor: Option<LargestFactor>,
    /// The number of cells of the proof.
    pub cells: usize,
}

/// The end of stability on the line to the worst point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct WorstEnd {
    /// The line as a problem in one parameter, the factor.
    pub problem: Arc<Problem>,
    /// The exact end, with its causes.
    pub end: End,
}

/// The range of one parameter that is safe for all values of the others.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ToleranceLimit {
    /// The parameter.
    pub parameter: String,
    /// Its nominal value.
    pub nominal: Rational,
    /// Downwards and upwards; `None` where the box of the others is not stable even at the nominal value.
    pub sides: [Option<LimitSide>; 2],
}

/// How far the parameter may go on one side.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LimitSide {
    /// Proved: all values from the nominal one to this one, for all values of the others.
    pub safe: Rational,
    /// Not stable for some values of the others; `None` where no such value was found.
    pub unsafe_at: Option<Rational>,
    /// The bracket.
    pub factor: LargestFactor,
    /// What happens at the unsafe end.
    pub worst: Option<WorstEnd>,
}

impl Question {
    /// What tolerances do to stability.
    ///
    /// Names with a tolerance are left free; a value that was set is their nominal value.
    ///
    /// Cost: that of the decision of the box and of the bracket of the largest factor.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::answer::ToleranceRequest;
    /// use jurist_engine::model::Model;
    /// let request = ToleranceRequest::new([("R_a", "20%".parse()?), ("L_a", "20%".parse()?)]);
    /// let answer = Model::drive().ask().tolerance(&request, &Budget::unlimited()).unwrap();
    /// assert!(answer.value().decision.is_stable());
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`]: refused (`E-tolerance`, and as [`Question::problem`]), or stopped.
    pub fn tolerance(self, request: &ToleranceRequest, budget: &Budget) -> Result<Answer<ToleranceAnswer>, Error> {
        self.tolerance_told(request, &|_| (), budget)
    }

    /// The same; a proof of the box is told as soon as it stands, as an answer about the box alone. Its text is how the text of
    /// the whole answer begins.
    ///
    /// Cost: that of [`Question::tolerance`].
    ///
    /// # Errors
    /// As [`Question::tolerance`]; what was told stands.
    pub fn tolerance_told(
        mut self,
        request: &ToleranceRequest,
        told: &dyn Fn(&Answer<ToleranceAnswer>),
        budget: &Budget,
    ) -> Result<Answer<ToleranceAnswer>, Error> {
        if request.tolerances.is_empty() {
            return Err(Diagnostic::error(Code::Tolerance, "no parameter has a tolerance")
                .help("give tolerances in the model, or with --tol NAME=10% or --all 10%")
                .into());
        }
        let mut names: Vec<&String> = request.tolerances.iter().map(|(name, _)| name).collect();
        if let Some(limit) = &request.limit
            && !names.contains(&limit)
        {
            names.push(limit);
        }
        let set: BTreeMap<&String, Option<Rational>> = names.iter().map(|name| (*name, self.take_set(name))).collect();
        for name in &names {
            self = self.free((*name).clone()).all_values_of((*name).as_str());
        }
        let problem = self.problem()?;
        let nominal_of = |name: &String| -> Result<Rational, Error> {
            let found = problem.free().iter().find(|free| free.name == *name).and_then(|free| free.nominal.clone());
            set.get(name).cloned().flatten().or(found).ok_or_else(|| {
                Diagnostic::error(Code::NoValue, format!("the parameter '{name}' has no value"))
                    .help(format!("set it: --set {name}=..., or give it a nominal value in the model file"))
                    .into()
            })
        };
        let mut sides = Vec::new();
        for free in problem.free() {
            let nominal = nominal_of(&free.name)?;
            let tolerance = request.tolerances.iter().find(|(name, _)| *name == free.name).map(|(_, t)| t);
            let widths = match tolerance {
                None => [Rational::ZERO, Rational::ZERO],
                Some(tolerance) => tolerance.widths(&nominal).map_err(|why| {
                    Error::from(Diagnostic::error(Code::Tolerance, format!("the tolerance of '{}': {why}", free.name)))
                })?,
            };
            sides.push(Side::scaled(nominal, widths));
        }
        Problem::tolerance(&problem.in_boxes(budget)?, sides, Asked { request, told }, budget)
    }
}
