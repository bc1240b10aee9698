//! The question about a box, and which family of loops answers it.

use super::family_box::FamilyBox;
use super::held::Truth;
use super::{ToleranceAnswer, ToleranceRequest, WorstEnd};
use crate::answer::Answer;
use crate::coverage::refusals::DECAY;
use crate::error::{Code, Diagnostic, Error};
use crate::problem::Problem;
use crate::response::Requirement;
use crate::stability::boxes::{
    BoxDecision, BoxPolynomial, BoxVolume, Family, LargestFactor, MOST_PARAMETERS, Side, ToleranceProblem, ray,
};
use crate::stability::{AtPoint, Range};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RealAlgebraic;
use jurist_algebra::real::Real;
use std::sync::Arc;

/// The part of the time that may be spent on the exact end of the worst line.
const END_SHARE: (u32, u32) = (1, 3);

/// The part of the time that may be spent on the volume: what was found has to be said.
const VOLUME_SHARE: (u32, u32) = (9, 10);

/// What is asked, and who is told of the box before the rest is known.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub request: &'a ToleranceRequest,
    pub told: &'a dyn Fn(&Answer<ToleranceAnswer>),
}

impl Problem {
    pub(super) fn tolerance(
        self: &Arc<Self>,
        sides: Vec<Side>,
        asked: Asked<'_>,
        budget: &Budget,
    ) -> Result<Answer<ToleranceAnswer>, Error> {
        let request = asked.request;
        refuse_beside_requirements(request)?;
        refuse_volume(sides.len(), request)?;
        let nominal: Vec<Rational> = sides.iter().map(|side| side.nominal().clone()).collect();
        if self.positive().iter().any(|p| !p.eval(&nominal).sign().is_gt()) {
            let decision = BoxDecision::NotStable { witness: None };
            return Ok(self.answered(sides, AtPoint::Undefined, decision));
        }
        let algebra = self.algebra_over_symbols(budget)?;
        let Some(d) = algebra.polynomial() else {
            let decision = BoxDecision::NotStable { witness: None };
            return Ok(self.answered(sides, AtPoint::Undefined, decision));
        };
        if !algebra.symbols().delays().is_empty() {
            self.refuse_undamped(&request.requirements, budget)?;
            refuse_beside_dead_time(request)?;
            let Some((p, constants)) = self.delayed_family_in_region(&nominal, budget)? else {
                let decision = BoxDecision::NotStable { witness: None };
                return Ok(self.answered(sides, AtPoint::Zero, decision));
            };
            let truth = Truth::beside_constants(self, &constants);
            return FamilyBox { problem: self, p: &p, truth: &truth, sides: &sides, asked, budget }.answer();
        }
        if let Some(p) = self.moving_family(budget)? {
            let truth = Truth::of_points(self);
            return FamilyBox { problem: self, p: &p, truth: &truth, sides: &sides, asked, budget }.answer();
        }
        let truth = Truth::of(self, budget)?;
        let poles = d.poles.iter().cloned().chain(self.positive()).collect();
        let d = &CharacteristicPolynomial { poles, ..d.clone() };
        let p = budget.enter(|| BoxPolynomial::over(d, truth.beside(&sides).len(), self.shape()))?;
        FamilyBox { problem: self, p: &p, truth: &truth, sides: &sides, asked, budget }.answer()
    }

    pub(super) fn answered(
        self: &Arc<Self>,
        sides: Vec<Side>,
        nominal: AtPoint,
        decision: BoxDecision,
    ) -> Answer<ToleranceAnswer> {
        let value = self.bare(sides, nominal, decision);
        Answer::new(Arc::clone(self), value)
    }

    pub(super) fn bare(&self, sides: Vec<Side>, nominal: AtPoint, decision: BoxDecision) -> ToleranceAnswer {
        ToleranceAnswer {
            sides,
            nominal,
            decision,
            factor: None,
            worst: None,
            exact: None,
            domain_factor: None,
            limit: None,
            volume: None,
            required: Vec::new(),
            binding: None,
        }
    }

    /// The factor at which the first parameter reaches the end of its domain.
    pub(super) fn domain_factor(&self, sides: &[Side]) -> Option<Rational> {
        let mut factors = Vec::new();
        for (free, side) in self.free().iter().zip(sides).filter(|(_, side)| side.grows()) {
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
    pub(super) fn worst_end(
        self: &Arc<Self>,
        sides: &[Side],
        factor: &LargestFactor,
        budget: &Budget,
    ) -> Result<Option<(WorstEnd, Vec<RealAlgebraic>)>, Error> {
        let (Some(direction), Some(upper)) = (&factor.direction, &factor.upper) else { return Ok(None) };
        let (base, step) = ray(sides, direction);
        let is_rational = self.algebra_over_symbols(budget)?.symbols().is_empty();
        let is_undefined = factor.witness.as_ref().is_some_and(|w| w.at == Some(AtPoint::Undefined));
        if is_undefined && !is_rational {
            return Ok(None);
        }
        // Functions are looked at near the end alone: the box before it is stable.
        let range = match is_rational {
            true => Range::between(Some(Rational::ZERO), Some(upper * &Rational::from(2))),
            false => Range::between(Some(factor.lower.clone()), Some(upper + &(upper - &factor.lower))),
        };
        let part = budget.share(END_SHARE.0, END_SHARE.1);
        let problem = match self.on_ray("factor", &base, &step, range.clone(), &part) {
            Ok(problem) => Arc::new(problem),
            Err(Error::Stopped(_)) => return Ok(None),
            Err(error) => return Err(error),
        };
        let set = match problem.stable_set(&part) {
            Ok(set) => set,
            Err(Error::Stopped(_)) => return Ok(None),
            Err(error) if is_rational => return Err(error),
            // The end is known as a bracket all the same.
            Err(_) => return Ok(None),
        };
        let first = set.value().intervals().first().filter(|i| {
            i.lower
                .as_ref()
                .is_none_or(|end| range.lower.as_ref().is_some_and(|low| end.value.exact().as_ref() == Some(low)))
        });
        let end = first.and_then(|i| i.upper.clone()).filter(|end| end.causes.is_limit());
        let cells = set.value().cells().filter(|_| set.value().is_algebraic());
        let zeros = cells.iter().flat_map(|cells| &cells.zeros).filter_map(Real::algebraic).cloned().collect();
        Ok(end.map(|end| (WorstEnd { problem, end }, zeros)))
    }
}

/// The share of the box that is stable, where that is asked for.
pub(super) fn volume(
    p: &impl Family,
    sides: &[Side],
    request: &ToleranceRequest,
    budget: &Budget,
) -> Option<BoxVolume> {
    let part = budget.share(VOLUME_SHARE.0, VOLUME_SHARE.1);
    request.volume.as_ref().map(|undecided| BoxVolume::of(p, sides, &Rational::ONE, undecided, &part))
}

/// The volume of a box of many parameters, refused before any work.
fn refuse_volume(parameters: usize, request: &ToleranceRequest) -> Result<(), Error> {
    if request.volume.is_none() || parameters <= MOST_PARAMETERS {
        return Ok(());
    }
    let message = format!("the volume of a box is found for up to {MOST_PARAMETERS} parameters");
    Err(Diagnostic::error(Code::Tolerance, message)
        .help("leave some out with --fix; the shares of the margin are found for any number")
        .into())
}

/// What is not asked of loops with dead time.
fn refuse_beside_dead_time(request: &ToleranceRequest) -> Result<(), Error> {
    if request.requirements.iter().all(Requirement::needs_cut) {
        return Ok(());
    }
    Err(DECAY.diagnostic(&[("what", "tolerances")]).into())
}

/// Requirements are not looked at by these questions.
fn refuse_beside_requirements(request: &ToleranceRequest) -> Result<(), Error> {
    let what = match (&request.limit, &request.volume) {
        _ if request.requirements.is_empty() => return Ok(()),
        (Some(_), _) => "the range of one parameter",
        (_, Some(_)) => "the volume of a box",
        _ if !request.factor => "a box alone, without its factor,",
        _ => return Ok(()),
    };
    let help = "of a box with requirements the program finds the largest factor: leave out '--only', '--limit' and '--volume', or the requirements";
    let message = format!("{what} is not decided with requirements on margins, damping or settling");
    Err(Diagnostic::error(Code::Require, message).help(help).into())
}

pub(super) fn too_many(boxes: &ToleranceProblem) -> Error {
    let message = format!("{} tolerances have too many Bernstein coefficients", boxes.parameters());
    Diagnostic::error(Code::Tolerance, message)
        .help("leave some out with --fix, or give a product of parameters that only occur together one tolerance")
        .into()
}
