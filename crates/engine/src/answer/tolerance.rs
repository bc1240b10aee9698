//! Tolerances: whether every point of a box is stable, and by how much the box can grow.

use super::Answer;
use crate::error::{Diagnostic, Error};
use crate::model::{Model, Tolerance};
use crate::problem::{Problem, Question};
use crate::stability::boxes::{
    BoxDecision, BoxPolynomial, BoxVolume, ExactProof, LargestFactor, MOST_PARAMETERS, Side, ToleranceProblem, ray,
};
use crate::stability::{AtPoint, End, Range};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::RealAlgebraic;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The part of the time that may be spent on the exact end of the worst line.
const END_SHARE: (u32, u32) = (1, 3);

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
    /// The root count at the nominal point.
    pub nominal: AtPoint,
    /// Whether every point of the box is stable.
    pub decision: BoxDecision,
    /// By how much all tolerances can be scaled; `None` where the nominal point is not stable.
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
    /// Cost: that of [`ToleranceProblem::decide`] and [`ToleranceProblem::largest_factor`].
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
    pub fn tolerance(mut self, request: &ToleranceRequest, budget: &Budget) -> Result<Answer<ToleranceAnswer>, Error> {
        if request.tolerances.is_empty() {
            return Err(Diagnostic::error("E-tolerance", "no parameter has a tolerance")
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
            self = self.free((*name).clone());
        }
        let problem = self.problem()?;
        let nominal_of = |name: &String| -> Result<Rational, Error> {
            let found = problem.free().iter().find(|free| free.name == *name).and_then(|free| free.nominal.clone());
            set.get(name).cloned().flatten().or(found).ok_or_else(|| {
                Diagnostic::error("E-no-value", format!("the parameter '{name}' has no value"))
                    .help(format!("give it a nominal value, or set it: --set {name}=..."))
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
                    Error::from(Diagnostic::error("E-tolerance", format!("the tolerance of '{}': {why}", free.name)))
                })?,
            };
            sides.push(Side::scaled(nominal, widths));
        }
        Problem::tolerance(&problem, sides, request, budget)
    }
}

impl Problem {
    fn tolerance(
        self: &Arc<Self>,
        sides: Vec<Side>,
        request: &ToleranceRequest,
        budget: &Budget,
    ) -> Result<Answer<ToleranceAnswer>, Error> {
        let Some(d) = self.algebra(budget)?.polynomial() else {
            let decision = BoxDecision::NotStable { witness: None };
            return Ok(self.answered(sides, AtPoint::Undefined, decision));
        };
        let p = budget.enter(|| BoxPolynomial::new(d, self.shape()))?;
        let nominal: Vec<Rational> = sides.iter().map(|side| side.nominal().clone()).collect();
        let at = budget.enter(|| p.at(&nominal))?;
        let Some(boxes) = budget.enter(|| ToleranceProblem::new(&p, sides.clone()))? else {
            let decision = BoxDecision::not_stable_at(nominal, at.clone());
            return Ok(self.answered(sides, at, decision));
        };
        if boxes.coefficients().is_none() {
            return Err(too_many(&boxes));
        }
        let domain_factor = self.domain_factor(&sides);
        let decision = boxes.decide(&Rational::ONE, budget)?;
        let factor = boxes.largest_factor(&request.gap, domain_factor.as_ref(), budget)?;
        let (worst, cells) = self.worst_end(&sides, &factor, budget)?.unzip();
        let limit = match &request.limit {
            None => None,
            Some(name) => Some(self.tolerance_limit(&p, &sides, name, request, budget)?),
        };
        let exact = match (&worst, &cells) {
            (Some(worst), Some(cells)) if request.exact => boxes.exact(&factor, &worst.end, cells, budget)?,
            _ => None,
        };
        let volume = match &request.volume {
            None => None,
            Some(_) if boxes.parameters() > MOST_PARAMETERS => {
                let message = format!("the volume of a box is found for up to {MOST_PARAMETERS} parameters");
                return Err(Diagnostic::error("E-tolerance", message)
                    .help("leave some out with --fix; the shares of the margin are found for any number")
                    .into());
            }
            Some(undecided) => Some(boxes.volume(&Rational::ONE, undecided, budget)?),
        };
        let decision = agreed(decision, &factor, worst.as_ref().filter(|_| exact.is_some()));
        let value = ToleranceAnswer {
            sides,
            nominal: at,
            decision,
            factor: Some(factor),
            worst,
            exact,
            domain_factor,
            limit,
            volume,
        };
        Ok(Answer::new(Arc::clone(self), value))
    }

    fn answered(
        self: &Arc<Self>,
        sides: Vec<Side>,
        nominal: AtPoint,
        decision: BoxDecision,
    ) -> Answer<ToleranceAnswer> {
        let value = ToleranceAnswer {
            sides,
            nominal,
            decision,
            factor: None,
            worst: None,
            exact: None,
            domain_factor: None,
            limit: None,
            volume: None,
        };
        Answer::new(Arc::clone(self), value)
    }

    /// The factor at which the first parameter reaches the end of its open domain.
    fn domain_factor(&self, sides: &[Side]) -> Option<Rational> {
        let mut factors = Vec::new();
        for (free, side) in self.free().iter().zip(sides) {
            let rooms = [
                free.domain.lower.as_ref().map(|low| side.nominal() - low),
                free.domain.upper.as_ref().map(|high| high - side.nominal()),
            ];
            for (room, width) in rooms.into_iter().zip(side.widths()) {
                factors.extend(room.and_then(|room| room.checked_div(width)).filter(|f| f.sign().is_gt()));
            }
        }
        factors.into_iter().min()
    }

    /// The exact end of the first stable interval on the worst line, where the time allows it.
    fn worst_end(
        self: &Arc<Self>,
        sides: &[Side],
        factor: &LargestFactor,
        budget: &Budget,
    ) -> Result<Option<(WorstEnd, Vec<RealAlgebraic>)>, Error> {
        let (Some(direction), Some(upper)) = (&factor.direction, &factor.upper) else { return Ok(None) };
        let (base, step) = ray(sides, direction);
        let range = Range::between(Some(Rational::ZERO), Some(upper * &Rational::from(2)));
        let part = budget.share(END_SHARE.0, END_SHARE.1);
        let problem = Arc::new(self.on_ray("factor", &base, &step, range, &part)?);
        let set = match problem.stable_set(&part) {
            Ok(set) => set,
            Err(Error::Stopped(_)) => return Ok(None),
            Err(error) => return Err(error),
        };
        let first =
            set.value().intervals().first().filter(|i| i.lower.as_ref().is_none_or(|end| end.value.sign().is_eq()));
        let end = first.and_then(|i| i.upper.clone());
        let zeros = set.value().cells().map(|cells| cells.zeros.clone()).unwrap_or_default();
        Ok(end.map(|end| (WorstEnd { problem, end }, zeros)))
    }

    /// How far one parameter may go on either side while the others keep their tolerances.
    fn tolerance_limit(
        self: &Arc<Self>,
        p: &BoxPolynomial,
        sides: &[Side],
        name: &str,
        request: &ToleranceRequest,
        budget: &Budget,
    ) -> Result<ToleranceLimit, Error> {
        let at = self.free().iter().position(|free| free.name == name).expect("the limit's parameter is free");
        let nominal = sides[at].nominal().clone();
        let unit = if nominal.is_zero() { Rational::ONE } else { nominal.abs() };
        let mut found = [None, None];
        for (upward, slot) in found.iter_mut().enumerate() {
            let mut own: Vec<Side> =
                sides.iter().map(|s| Side::fixed(s.nominal().clone(), s.widths().clone())).collect();
            let mut widths = [Rational::ZERO, Rational::ZERO];
            widths[upward] = unit.clone();
            own[at] = Side::scaled(nominal.clone(), widths);
            let Some(boxes) = ToleranceProblem::new(p, own.clone()) else { continue };
            if !boxes.decide(&Rational::ZERO, budget)?.is_stable() {
                continue;
            }
            let signed = if upward == 1 { unit.clone() } else { -&unit };
            let value = |factor: &Rational| &nominal + &(&signed * factor);
            let domain = &self.free()[at].domain;
            let end = if upward == 1 { &domain.upper } else { &domain.lower };
            let most = end.as_ref().and_then(|end| (end - &nominal).checked_div(&signed));
            // The gap is one of the parameter's value, not of how far it has moved.
            let gap = |factor: &Rational| {
                let moved = &unit * factor;
                let share = value(factor).abs().checked_div(&moved).unwrap_or(Rational::ONE);
                (&request.gap * &share).min(request.gap.clone())
            };
            let factor = boxes.bracket(&gap, most.as_ref(), budget)?;
            let worst = self.worst_end(&own, &factor, budget)?.map(|(worst, _)| worst);
            *slot = Some(LimitSide {
                safe: value(&factor.lower),
                unsafe_at: factor.upper.as_ref().map(value),
                factor,
                worst,
            });
        }
        Ok(ToleranceLimit { parameter: name.to_owned(), nominal, sides: found })
    }
}

/// The decision about the box itself, where the bracket says more.
fn agreed(decision: BoxDecision, factor: &LargestFactor, exact: Option<&WorstEnd>) -> BoxDecision {
    match decision {
        BoxDecision::Stable(_) => decision,
        // The exact factor is in the bracket around 1, and not above 1.
        BoxDecision::Undecided { .. }
            if exact.is_some_and(|w| w.end.value.compare_rational(&Rational::ONE).is_le()) =>
        {
            BoxDecision::NotStable { witness: None }
        }
        _ if factor.upper.as_ref().is_some_and(|upper| *upper <= Rational::ONE) => {
            let known = match decision {
                BoxDecision::NotStable { witness } => witness,
                _ => None,
            };
            BoxDecision::NotStable { witness: factor.witness.clone().or(known) }
        }
        _ => decision,
    }
}

fn too_many(boxes: &ToleranceProblem) -> Error {
    let message = format!("{} tolerances have too many Bernstein coefficients", boxes.parameters());
    Diagnostic::error("E-tolerance", message)
        .help("leave some out with --fix, or give a product of parameters that only occur together one tolerance")
        .into()
}
