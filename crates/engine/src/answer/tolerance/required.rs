//! Requirements over a box: each is the stability of a family of polynomials over the box with one side more.

use super::bounds::agreed;
use super::decide::too_many;
use super::family_box::FamilyBox;
use super::{RequiredBox, ToleranceRequest};
use crate::coverage::refusals::NOT_OVER_A_BOX;
use crate::error::Error;
use crate::problem::Ask;
use crate::response::{DelayAsked, DelayBoxes, DelayedLoops, RequiredFamily, Requirement, RequirementBoxes, Rule};
use crate::stability::boxes::{BoxDecision, Family, LargestFactor, OpenReason, Side, ToleranceProblem, Witness};
use crate::stability::{AtPoint, Shape};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// A bracket by Taylor models is not narrower than one part in so many.
const LEAST_GAP: i64 = 10_000;

impl<F: Family> FamilyBox<'_, F> {
    /// Whether a requirement is met at every point of a box, and by how much the box can grow, up to `most`.
    ///
    /// What is proved is proved of a number that asks for a little more where the required one is irrational; a point that does not
    /// meet the requirement is confirmed with the required number itself.
    pub(super) fn required_box(
        &self,
        requirement: &Requirement,
        most: Option<&Rational>,
    ) -> Result<RequiredBox, Error> {
        self.problem.refuse_complex_requirements(self.budget)?;
        Requirement::refuse_signals(std::slice::from_ref(requirement))?;
        let is_on_spiral = matches!(requirement.rule(), Rule::Sector(_)) && self.problem.shape() == Shape::UnitDisc;
        let breaks = |point: &[Rational]| self.breaks(requirement, &point[..self.sides.len()]);
        let found = RequiredBox::new(requirement);
        let mut asked =
            BoxAsked { sides: self.sides, request: self.request(), most, breaks: &breaks, budget: self.budget, found };
        match requirement.rule() {
            Rule::DeadTime(least) => self.by_delays(least, &mut asked)?,
            _ if self.p.as_polynomial().is_none() || is_on_spiral => self.by_looks(&mut asked)?,
            _ => self.by_families(&mut asked)?,
        }
        Ok(asked.found)
    }

    /// By loops with a dead time at the cut.
    fn by_delays(&self, least: &Rational, asked: &mut BoxAsked<'_>) -> Result<(), Error> {
        let requirement = asked.found.requirement.clone();
        let (cut, near) = (requirement.cut(self.problem, self.request().at.as_deref())?, self.nominal());
        let whole = self.problem.without_region();
        let delay = DelayBoxes::of(DelayAsked { problem: &whole, least, cut: &cut, near: &near }, self.budget)?;
        let delay = delay.ok_or_else(|| not_over_a_box(&requirement, "ask 'verdict' at points"))?;
        if asked.is_broken_at(&near)? {
            return Ok(());
        }
        asked.add_delays(&delay)
    }

    /// By Taylor models of the open loop.
    fn by_looks(&self, asked: &mut BoxAsked<'_>) -> Result<(), Error> {
        let requirement = asked.found.requirement.clone();
        let at = self.request().at.as_deref();
        let boxes = RequirementBoxes::of(self.problem, &requirement, at, &self.nominal(), self.budget)?;
        let boxes = boxes.ok_or_else(|| not_over_a_box(&requirement, "ask 'verdict' at points"))?;
        let family = RequiredFamily::new(boxes, self.sides.len(), self.budget);
        let breaks = asked.breaks;
        // A point whose margins are not told is no witness.
        let told = |point: &[Rational]| match breaks(point) {
            Err(Error::Stopped(stopped)) if stopped.stop.is_precision() => Ok(None),
            told => told,
        };
        let mut told = BoxAsked { breaks: &told, found: asked.found.clone(), ..*asked };
        told.add(&family, self.sides.to_vec())?;
        asked.found = told.found;
        Ok(())
    }

    /// By polynomials whose stability is what is required.
    fn by_families(&self, asked: &mut BoxAsked<'_>) -> Result<(), Error> {
        let requirement = asked.found.requirement.clone();
        let beside = self.truth.beside(self.sides);
        let at = self.request().at.as_deref();
        let families = self.problem.families(&requirement, at, beside.len(), self.budget)?;
        // An open loop that crosses a circle nowhere over the box can lie on its wrong side.
        if matches!(requirement.rule(), Rule::Circle(_)) && asked.is_broken_at(&self.nominal())? {
            return Ok(());
        }
        for (p, own) in &families {
            let all: Vec<Side> = beside.iter().chain(own).cloned().collect();
            if let Some(boxes) = ToleranceProblem::new(p, all.clone()).filter(|boxes| boxes.coefficients().is_none()) {
                return Err(too_many(&boxes));
            }
            if !asked.add(p, all)? {
                break;
            }
        }
        Ok(())
    }

    /// The point as a witness, if a requirement is not met there.
    pub(super) fn breaks(&self, requirement: &Requirement, point: &[Rational]) -> Result<Option<Witness>, Error> {
        let (problem, budget) = (self.problem, self.budget);
        if problem.positive().iter().any(|p| !p.eval(point).sign().is_gt()) {
            return Ok(Some(Witness::new(point.to_vec(), AtPoint::Undefined)));
        }
        let names = problem.free().iter().map(|free| free.name.clone());
        let question = problem.model().ask().set_all(problem.set().to_vec()).set_all(names.zip(point.iter().cloned()));
        let is_met = match question.problem()?.meets(requirement, self.request().at.as_deref(), budget) {
            Err(Error::Undefined(_)) => false,
            met => met?,
        };
        if is_met {
            return Ok(None);
        }
        Ok(Some(Witness::new(point.to_vec(), self.truth.at(self.p, point, budget)?)))
    }
}

impl RequiredBox {
    pub(super) fn new(requirement: &Requirement) -> RequiredBox {
        RequiredBox {
            requirement: requirement.clone(),
            decision: BoxDecision::Undecided { why: OpenReason::Untried, cell: Vec::new() },
            factor: None,
            cells: 0,
        }
    }
}

/// The point as a witness, if the requirement is not met there.
type Breaks<'a> = &'a dyn Fn(&[Rational]) -> Result<Option<Witness>, Error>;

/// What is asked of a requirement over a box, and what is found so far.
struct BoxAsked<'a> {
    sides: &'a [Side],
    request: &'a ToleranceRequest,
    most: Option<&'a Rational>,
    breaks: Breaks<'a>,
    budget: &'a Budget,
    found: RequiredBox,
}

impl BoxAsked<'_> {
    fn nominal(&self) -> Vec<Rational> {
        self.sides.iter().map(|side| side.nominal().clone()).collect()
    }

    /// Whether the nominal point does not meet the requirement: that is the decision then.
    fn is_broken_at(&mut self, nominal: &[Rational]) -> Result<bool, Error> {
        let Some(witness) = (self.breaks)(nominal)? else { return Ok(false) };
        self.found.decision = BoxDecision::NotStable { witness: Some(witness) };
        Ok(true)
    }

    /// Asks one more family whose stability is required, over these sides: its own parameters may follow. False where its nominal point
    /// is not stable.
    fn add<F: Family>(&mut self, p: &F, all: Vec<Side>) -> Result<bool, Error> {
        let is_first = matches!(self.found.decision, BoxDecision::Undecided { why: OpenReason::Untried, .. });
        let Some(boxes) = self.budget.enter(|| ToleranceProblem::new(p, all))? else {
            self.found.decision = match (self.breaks)(&self.nominal())? {
                Some(witness) => BoxDecision::NotStable { witness: Some(witness) },
                None => BoxDecision::Undecided { why: OpenReason::NoRoom, cell: Vec::new() },
            };
            self.found.factor = None;
            return Ok(false);
        };
        let search = boxes.searched(self.budget)?;
        let refuted = match boxes.refuted(&search, &Rational::ONE) {
            Some(witness) => (self.breaks)(&witness.point)?,
            None => None,
        };
        let at_edge = || BoxDecision::Undecided { why: OpenReason::Edge, cell: Vec::new() };
        let decision = match refuted {
            Some(witness) => BoxDecision::NotStable { witness: Some(witness) },
            None => match boxes.decide(&Rational::ONE, self.budget)? {
                BoxDecision::NotStable { witness: Some(witness) } => match (self.breaks)(&witness.point)? {
                    Some(witness) => BoxDecision::NotStable { witness: Some(witness) },
                    None => at_edge(),
                },
                BoxDecision::NotStable { witness: None } => at_edge(),
                BoxDecision::Undecided { why, mut cell } => {
                    cell.truncate(self.sides.len());
                    BoxDecision::Undecided { why, cell }
                }
                stable => stable,
            },
        };
        if let BoxDecision::Stable(proof) = &decision {
            self.found.cells += proof.cells();
        }
        let nearest = self.found.factor.as_ref().and_then(|factor| factor.upper.as_ref());
        let most = self.most.into_iter().chain(nearest).min().cloned();
        let gap = |_: &Rational| match p.as_polynomial() {
            Some(_) => self.request.gap.clone(),
            None => self.request.gap.clone().max(Rational::new(1.into(), LEAST_GAP.into())),
        };
        let bracket = boxes.bracket(search, None, &gap, most.as_ref(), self.budget)?;
        let bracket = of_parameters(&boxes, bracket, self.sides.len(), self.breaks)?;
        let decision = agreed(decision, &bracket, None);
        self.found.factor = Some(match self.found.factor.take() {
            None => bracket,
            Some(known) => nearer(known, bracket).0,
        });
        self.found.decision = match is_first {
            true => decision,
            false => worse(self.found.decision.clone(), decision),
        };
        Ok(true)
    }
}

impl BoxAsked<'_> {
    /// Asks the families of a delay margin: the delay at the cut is one side more, and so is each constant.
    fn add_delays(&mut self, delay: &DelayBoxes) -> Result<(), Error> {
        for family in delay.families().unwrap_or_default() {
            let own = family.delays.map(|[low, high]| Side::fixed(high.clone(), [&high - &low, Rational::ZERO]));
            let mut all: Vec<Side> = self.sides.iter().cloned().chain(own).collect();
            all.extend(family.constants.iter().map(|[low, high]| {
                let middle = low.midpoint(high);
                let widths = [&middle - low, high - &middle];
                Side::fixed(middle, widths)
            }));
            let is_stable = match family.loops {
                DelayedLoops::Delayed(p) => self.add(p, all)?,
                DelayedLoops::Moving(p) => self.add(p, all)?,
                DelayedLoops::Polynomial(p) => {
                    let boxes = ToleranceProblem::new(p, all.clone());
                    if let Some(boxes) = boxes.filter(|boxes| boxes.coefficients().is_none()) {
                        return Err(too_many(&boxes));
                    }
                    self.add(p, all)?
                }
            };
            if !is_stable {
                break;
            }
        }
        Ok(())
    }
}

fn not_over_a_box(requirement: &Requirement, help: &str) -> Error {
    NOT_OVER_A_BOX.diagnostic(&[("name", requirement.name()), ("help", help)]).into()
}

/// The worse of two decisions that both have to be right.
pub(super) fn worse(a: BoxDecision, b: BoxDecision) -> BoxDecision {
    match (&a, &b) {
        (BoxDecision::NotStable { .. }, _) => a,
        (_, BoxDecision::NotStable { .. }) => b,
        (BoxDecision::Undecided { .. }, _) => a,
        _ if b.is_stable() => a,
        _ => b,
    }
}

/// The bracket of two that both bound the box, and whether the second one does so.
pub(super) fn nearer(a: LargestFactor, b: LargestFactor) -> (LargestFactor, bool) {
    let second = match (&a.upper, &b.upper) {
        (Some(a), Some(b)) => b < a,
        (None, Some(_)) => true,
        (_, None) => false,
    };
    let (mut near, far) = if second { (b, a) } else { (a, b) };
    if far.lower < near.lower {
        (near.lower, near.proof) = (far.lower, far.proof);
        near.open = near.open.or(far.open);
    }
    (near, second)
}

/// The bracket without the family's own parameter; its upper end only where the point there, or one just beyond, is confirmed: at the
/// edge itself a requirement may be met.
fn of_parameters<F: Family>(
    boxes: &ToleranceProblem<'_, F>,
    mut bracket: LargestFactor,
    parameters: usize,
    confirmed: impl Fn(&[Rational]) -> Result<Option<Witness>, Error>,
) -> Result<LargestFactor, Error> {
    let beyond = boxes.just_beyond(&bracket);
    bracket.witness = match bracket.witness.take() {
        None => None,
        Some(witness) => confirmed(&witness.point)?,
    };
    if bracket.witness.is_none()
        && let Some((factor, point)) = beyond
    {
        bracket.witness = confirmed(&point)?;
        bracket.upper = Some(factor);
    }
    if bracket.witness.is_none() {
        (bracket.upper, bracket.direction, bracket.shares) = (None, None, None);
    }
    bracket.direction.iter_mut().chain(&mut bracket.shares).for_each(|values| values.truncate(parameters));
    if let Some(shares) = &mut bracket.shares {
        let sum = shares.iter().fold(Rational::ZERO, |sum, share| sum + share);
        shares.iter_mut().for_each(|share| *share = share.checked_div(&sum).unwrap_or(Rational::ZERO));
    }
    if let Some((_, cell)) = &mut bracket.open {
        cell.truncate(parameters);
    }
    Ok(bracket)
}
