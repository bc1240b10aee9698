//! Tolerances: whether every point of a box is stable, and by how much the box can grow.

mod bounds;
mod decide;
mod family_box;
mod held;
mod limit;
mod one_name;
mod required;
mod required_families;

pub use held::{SYMBOL_BITS, Truth};

use super::Answer;
use crate::error::{Code, Diagnostic, Error};
use crate::model::{Model, Tolerance};
use crate::problem::{Free, Problem, Question};
use crate::response::{AllOf, Requirement};
use crate::stability::boxes::{BoxDecision, BoxVolume, ExactProof, LargestFactor, Side};
use crate::stability::{AtPoint, End};
use decide::Asked;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
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
    /// Names with ranges that do not grow with the factor: what is asked of the tolerances is to hold for all of these values.
    pub for_all: Vec<AllOf>,
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
            for_all: Vec::new(),
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

    /// The same, asked for all values of these names as well, whatever the factor of the tolerances is. A tolerance of such a name is left out.
    pub fn for_all(mut self, ranges: Vec<AllOf>) -> Self {
        self.tolerances.retain(|(name, _)| ranges.iter().all(|all| all.name != *name));
        self.for_all = ranges;
        self
    }

    /// The same, asking also how far one parameter may go while the others have their tolerances.
    pub fn limit(mut self, name: impl Into<String>) -> Self {
        self.limit = Some(name.into());
        self
    }
}

impl ToleranceRequest {
    /// The side of the box for a free name that was set to this value, if it was.
    fn side(&self, free: &Free, set: Option<Rational>) -> Result<Side, Error> {
        let name = &free.name;
        let nominal = set.or_else(|| free.nominal.clone());
        if let Some(AllOf { range: [low, high], .. }) = self.for_all.iter().find(|all| all.name == *name) {
            // Where the nominal value is outside of the range, another one of it stands for all.
            let nominal = nominal.filter(|x| low <= x && x <= high).unwrap_or_else(|| low.midpoint(high));
            let widths = [&nominal - low, high - &nominal];
            return Ok(Side::fixed(nominal, widths));
        }
        let nominal = nominal.ok_or_else(|| {
            Diagnostic::error(Code::NoValue, format!("the parameter '{name}' has no value"))
                .help(format!("set it: --set {name}=..., or give it a nominal value in the model file"))
        })?;
        let tolerance = self.tolerances.iter().find(|(known, _)| known == name).map(|(_, tolerance)| tolerance);
        let widths = tolerance.map(|tolerance| tolerance.widths(&nominal)).transpose();
        let widths =
            widths.map_err(|why| Diagnostic::error(Code::Tolerance, format!("the tolerance of '{name}': {why}")))?;
        Ok(Side::scaled(nominal, widths.unwrap_or([Rational::ZERO, Rational::ZERO])))
    }
}

/// What is known of a box of tolerances.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::ToleranceRequest;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
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
    /// The largest factor as a number, where that was asked for and proved.
    pub exact: Option<ExactFactor>,
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

impl ToleranceAnswer {
    /// How much of the margin each tolerance uses, by the number of its free parameter; the shares add up to 1. A range that does not grow has none.
    pub fn shares(&self) -> Option<Vec<(usize, Rational)>> {
        let shares = self.factor.as_ref()?.shares.as_ref()?;
        let growing: Vec<usize> = (0..shares.len()).filter(|&i| self.sides[i].grows()).collect();
        if growing.len() == shares.len() {
            return Some(growing.into_iter().zip(shares.clone()).collect());
        }
        let sum = growing.iter().fold(Rational::ZERO, |sum, &i| sum + &shares[i]);
        let share = |i: usize| shares[i].checked_div(&sum).unwrap_or(Rational::ZERO);
        Some(growing.into_iter().map(|i| (i, share(i))).collect())
    }

    /// The names whose ranges do not grow with the factor.
    pub fn ranges(&self, problem: &Problem) -> Vec<AllOf> {
        let ranges = problem.free().iter().zip(&self.sides).filter(|(_, side)| !side.grows());
        ranges
            .filter_map(|(free, side)| {
                let [low, high] = side.at(&Rational::ZERO);
                AllOf::new(&free.name, low, high)
            })
            .collect()
    }
}

/// The largest factor as a number with any digits.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ExactFactor {
    /// The factor.
    pub value: Real,
    /// Why nothing in the box is worse than a point of the line that ends there; `None` where one name alone has a tolerance, and the lines up and
    /// down from its nominal value are the whole box.
    pub proof: Option<ExactProof>,
}

impl From<ExactProof> for ExactFactor {
    fn from(proof: ExactProof) -> ExactFactor {
        ExactFactor { value: proof.value.clone(), proof: Some(proof) }
    }
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
    /// use jurist_engine::problem::Ask;
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
        if request.tolerances.is_empty() && request.limit.is_none() {
            let help = match request.for_all.first() {
                None => "give tolerances in the model, or with --tol NAME=10% or --all 10%".to_owned(),
                Some(AllOf { name, range: [low, high], .. }) => {
                    format!("'--tol {name}={low}..{high} --only' asks for all values of '{name}'")
                }
            };
            return Err(Diagnostic::error(Code::Tolerance, "no parameter has a tolerance").help(help).into());
        }
        let mut names: Vec<&String> = request.tolerances.iter().map(|(name, _)| name).collect();
        names.extend(request.for_all.iter().map(|all| &all.name));
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
        request.for_all.iter().try_for_each(|all| all.inside_domain(&problem))?;
        let sides = problem.free().iter().map(|free| {
            let value = set.get(&free.name).cloned().flatten();
            request.side(free, value)
        });
        let sides = sides.collect::<Result<Vec<_>, Error>>()?;
        // Work that ends anywhere in it is an answer as well.
        budget.enter(|| Problem::tolerance(&problem.in_boxes(budget)?, sides, Asked { request, told }, budget))?
    }
}
