//! The answer about a box, step by step: a point that is not stable, a proof, the largest factor.

use super::bounds::{agreed, bounded_by};
use super::held::Truth;
use super::required::{nearer, worse};
use super::{ExactFactor, ToleranceAnswer, ToleranceRequest, WorstEnd};
use crate::answer::Answer;
use crate::coverage::refusals::DECAY;
use crate::error::{Code, Diagnostic, Error};
use crate::problem::Problem;
use crate::response::Requirement;
use crate::stability::boxes::{
    BoxDecision, BoxPolynomial, BoxVolume, Family, LargestFactor, MOST_PARAMETERS, OpenReason, Side, ToleranceProblem,
    ray,
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

/// The part of the time that may be spent on the bracket of the largest factor.
const BRACKET_SHARE: (u32, u32) = (4, 5);

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
            return self.tolerance_of(&p, &truth, sides, asked, budget);
        }
        if let Some(p) = self.moving_family(budget)? {
            return self.tolerance_of(&p, &Truth::of_points(self), sides, asked, budget);
        }
        let truth = Truth::of(self, budget)?;
        let poles = d.poles.iter().cloned().chain(self.positive()).collect();
        let d = &CharacteristicPolynomial { poles, ..d.clone() };
        let p = budget.enter(|| BoxPolynomial::over(d, truth.beside(&sides).len(), self.shape()))?;
        self.tolerance_of(&p, &truth, sides, asked, budget)
    }

    /// The answer where not even the nominal values of the tolerances are good for all values of the other names' ranges.
    fn spoilt_by_ranges<F: Family>(
        self: &Arc<Self>,
        (p, truth): (&F, &Truth),
        sides: &[Side],
        asked: Asked<'_>,
        budget: &Budget,
    ) -> Result<Option<Answer<ToleranceAnswer>>, Error> {
        if sides.iter().all(Side::grows) {
            return Ok(None);
        }
        let request = ToleranceRequest {
            tolerances: Vec::new(),
            for_all: Vec::new(),
            limit: None,
            exact: false,
            volume: None,
            factor: !asked.request.requirements.is_empty(),
            ..asked.request.clone()
        };
        let ranges = sides.iter().map(Side::without_tolerance).collect();
        let found = self.tolerance_of(p, truth, ranges, Asked { request: &request, told: &|_| () }, budget)?;
        let ToleranceAnswer { decision, required, nominal, .. } = found.into_value();
        if decision.is_stable() {
            return Ok(None);
        }
        let value = ToleranceAnswer { required, ..self.bare(sides.to_vec(), nominal, decision) };
        Ok(Some(Answer::new(Arc::clone(self), value)))
    }

    /// The answer about a family of loops.
    fn tolerance_of<F: Family>(
        self: &Arc<Self>,
        p: &F,
        truth: &Truth,
        sides: Vec<Side>,
        asked: Asked<'_>,
        budget: &Budget,
    ) -> Result<Answer<ToleranceAnswer>, Error> {
        if let Some(spoilt) = self.spoilt_by_ranges((p, truth), &sides, asked, budget)? {
            return Ok(spoilt);
        }
        let request = asked.request;
        let all = truth.beside(&sides);
        let degree = self.algebra_over_symbols(budget)?.formal_degree();
        let nominal: Vec<Rational> = sides.iter().map(|side| side.nominal().clone()).collect();
        let at = truth.at(p, &nominal, budget)?;
        if let [side] = sides.as_slice()
            && at.is_stable(degree)
            && p.as_polynomial().is_none()
            && request.limit.is_none()
            && request.requirements.is_empty()
            && let Some(answer) = self.tolerance_of_one(p, truth, (side, &at), asked, budget)?
        {
            return Ok(answer);
        }
        let boxes = match at.is_stable(degree) {
            true => budget.enter(|| ToleranceProblem::new(p, all.clone()))?,
            false => None,
        };
        let Some(boxes) = boxes else {
            let decision = match at.is_stable(degree) {
                false => BoxDecision::not_stable_at(nominal, at.clone()),
                true => BoxDecision::Undecided { why: OpenReason::Constants, cell: Vec::new() },
            };
            let bare = self.bare(sides, at, decision);
            let volume = volume(p, &all, request, budget);
            return Ok(Answer::new(Arc::clone(self), ToleranceAnswer { volume, ..bare }));
        };
        let polynomial = p.as_polynomial().and_then(|p| ToleranceProblem::new(p, all.clone()));
        if let Some(polynomial) = polynomial.as_ref().filter(|boxes| boxes.coefficients().is_none()) {
            return Err(too_many(polynomial));
        }
        if !request.factor {
            let decision = truth.decision(p, boxes.decide(&Rational::ONE, budget)?, budget)?;
            if decision.is_stable() {
                return Ok(self.answered(sides, at, decision));
            }
        }
        let domain_factor = self.domain_factor(&sides);
        let search = boxes.searched(budget)?;
        let refuted = boxes.refuted(&search, &Rational::ONE).map(|witness| truth.confirmed(p, witness, budget));
        let decision = match refuted.transpose()?.flatten() {
            Some(witness) => BoxDecision::NotStable { witness: Some(witness) },
            None => truth.decision(p, boxes.decide(&Rational::ONE, budget)?, budget)?,
        };
        let known = match &decision {
            BoxDecision::Stable(proof) => Some(proof.clone()),
            _ => None,
        };
        // A proof stands, whatever is found of larger boxes.
        if decision.is_stable() && request.requirements.is_empty() {
            (asked.told)(&self.answered(sides.clone(), at.clone(), decision.clone()));
        }
        let part = budget.share(BRACKET_SHARE.0, BRACKET_SHARE.1);
        // Of functions a requirement is decided sooner than stability is lost: no box beyond its end is asked for.
        let is_first = p.as_polynomial().is_none();
        let mut earlier = Vec::new();
        for requirement in request.requirements.iter().filter(|_| is_first) {
            earlier.push(self.required_box(
                requirement,
                (&sides, truth),
                request,
                domain_factor.as_ref(),
                p,
                budget,
            )?);
        }
        let ends = earlier.iter().filter_map(|found| found.factor.as_ref()?.upper.as_ref());
        let most = ends.chain(&domain_factor).min().cloned();
        let mut earlier = earlier.into_iter();
        let factor = boxes.bracket(search, known, &|_| request.gap.clone(), most.as_ref(), &part)?;
        let factor = truth.factor(&boxes, p, factor, budget)?;
        let decision = agreed(decision, &factor, None);
        let factor = bounded_by(&decision, factor, &sides);
        let (mut decision, mut factor) = (decision, Some(factor));
        let (mut required, mut binding) = (Vec::new(), None);
        for (k, requirement) in request.requirements.iter().enumerate() {
            let nearest = factor.as_ref().and_then(|factor| factor.upper.as_ref());
            let most = nearest.into_iter().chain(&domain_factor).min().cloned();
            let found = match earlier.next() {
                Some(found) => found,
                None => self.required_box(requirement, (&sides, truth), request, most.as_ref(), p, budget)?,
            };
            decision = worse(decision, found.decision.clone());
            factor = match (factor, found.factor.clone()) {
                (Some(known), Some(own)) => {
                    let (nearest, is_own) = nearer(known, own);
                    binding = if is_own { Some(k) } else { binding };
                    Some(nearest)
                }
                _ => None,
            };
            required.push(found);
        }
        let Some(factor) = factor else {
            let value = ToleranceAnswer { required, ..self.bare(sides, at, decision) };
            return Ok(Answer::new(Arc::clone(self), value));
        };
        let (worst, cells) = match binding {
            None => self.worst_end(&sides, &factor, budget)?.unzip(),
            Some(_) => (None, None),
        };
        let limit = match &request.limit {
            None => None,
            Some(name) => Some(self.tolerance_limit(p, &sides, truth, name, request, budget)?),
        };
        let exact = match (&worst, &cells, &polynomial) {
            (Some(worst), Some(cells), Some(boxes)) if request.exact && truth.is_exact() => {
                boxes.exact(&factor, &worst.end, cells, budget)?.map(ExactFactor::from)
            }
            _ => None,
        };
        let volume = volume(p, &all, request, budget);
        let decision = agreed(decision, &factor, exact.as_ref());
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
            required,
            binding,
        };
        Ok(Answer::new(Arc::clone(self), value))
    }

    fn answered(
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
