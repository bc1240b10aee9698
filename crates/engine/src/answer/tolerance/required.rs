//! Requirements over a box: each is the stability of a family of polynomials over the box with one side more.

use super::bounds::agreed;
use super::decide::too_many;
use super::held::Truth;
use super::{RequiredBox, ToleranceRequest};
use crate::coverage::refusals::{MARGINS_IN_ONE, NOT_OVER_A_BOX};
use crate::error::Error;
use crate::problem::{Ask, Problem};
use crate::response::{
    DelayAsked, DelayBoxes, DelayedLoops, Family, RequiredFamily, Requirement, RequirementBoxes, Rule, half_tangent,
    radius_below,
};
use crate::stability::boxes::{
    BoxDecision, BoxPolynomial, Family as StableFamily, LargestFactor, OpenReason, Side, ToleranceProblem, Witness,
};
use crate::stability::{AtPoint, Shape};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// Required numbers that are not rational are replaced by ones that ask for more, by a part in ten to this.
const DIGITS: usize = 30;

/// A bracket by Taylor models is not narrower than one part in so many.
const LEAST_GAP: i64 = 10_000;

/// The same of exponentials, in binary digits.
const BITS: u64 = 100;

/// A family and the side of its own parameter, the last one, if it has any.
type FamilyOfLoops = (BoxPolynomial, Option<Side>);

impl Problem {
    /// Whether a requirement is met at every point of a box, and by how much the box can grow, up to `most`.
    ///
    /// What is proved is proved of a number that asks for a little more where the required one is irrational; a point that does not
    /// meet the requirement is confirmed with the required number itself.
    pub(super) fn required_box<F: StableFamily>(
        self: &Arc<Self>,
        requirement: &Requirement,
        (sides, truth): (&[Side], &Truth<'_>),
        request: &ToleranceRequest,
        most: Option<&Rational>,
        base: &F,
        budget: &Budget,
    ) -> Result<RequiredBox, Error> {
        self.refuse_complex_requirements(budget)?;
        Requirement::refuse_signals(std::slice::from_ref(requirement))?;
        let breaks =
            |point: &[Rational]| self.breaks(requirement, &point[..sides.len()], request, (base, truth), budget);
        let mut asked =
            BoxAsked { sides, request, most, breaks: &breaks, budget, found: RequiredBox::new(requirement) };
        if let Rule::DeadTime(least) = requirement.rule() {
            let (cut, near) = (requirement.cut(self, request.at.as_deref())?, asked.nominal());
            let delay =
                DelayBoxes::of(DelayAsked { problem: &self.without_region(), least, cut: &cut, near: &near }, budget)?;
            let delay = delay.ok_or_else(|| not_over_a_box(requirement, "ask 'verdict' at points"))?;
            if let Some(witness) = breaks(&near)? {
                asked.found.decision = BoxDecision::NotStable { witness: Some(witness) };
                return Ok(asked.found);
            }
            asked.add_delays(&delay)?;
            return Ok(asked.found);
        }
        let is_on_spiral = matches!(requirement.rule(), Rule::Sector(_)) && self.shape() == Shape::UnitDisc;
        if base.as_polynomial().is_none() || is_on_spiral {
            let at = request.at.as_deref();
            let boxes = RequirementBoxes::of(self, requirement, at, &asked.nominal(), budget)?;
            let boxes = boxes.ok_or_else(|| not_over_a_box(requirement, "ask 'verdict' at points"))?;
            let family = RequiredFamily::new(boxes, sides.len(), budget);
            // A point whose margins are not told is no witness.
            let told = |point: &[Rational]| match breaks(point) {
                Err(Error::Stopped(stopped)) if stopped.stop.is_precision() => Ok(None),
                told => told,
            };
            let found = RequiredBox::new(requirement);
            let mut asked = BoxAsked { sides, request, most, breaks: &told, budget, found };
            asked.add(&family, sides.to_vec())?;
            return Ok(asked.found);
        }
        let beside = truth.beside(sides);
        let families = self.families(requirement, request.at.as_deref(), beside.len(), budget)?;
        // An open loop that crosses a circle nowhere over the box can lie on its wrong side.
        if matches!(requirement.rule(), Rule::Circle(_))
            && let Some(witness) = breaks(&asked.nominal())?
        {
            asked.found.decision = BoxDecision::NotStable { witness: Some(witness) };
            return Ok(asked.found);
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
        Ok(asked.found)
    }

    /// The point as a witness, if a requirement is not met there.
    fn breaks(
        self: &Arc<Self>,
        requirement: &Requirement,
        point: &[Rational],
        request: &ToleranceRequest,
        (base, truth): (&impl StableFamily, &Truth<'_>),
        budget: &Budget,
    ) -> Result<Option<Witness>, Error> {
        if self.positive().iter().any(|p| !p.eval(point).sign().is_gt()) {
            return Ok(Some(Witness::new(point.to_vec(), AtPoint::Undefined)));
        }
        let names = self.free().iter().map(|free| free.name.clone());
        let question = self.model().ask().set_all(self.set().to_vec()).set_all(names.zip(point.iter().cloned()));
        let is_met = match question.problem()?.meets(requirement, request.at.as_deref(), budget) {
            Err(Error::Undefined(_)) => false,
            met => met?,
        };
        if is_met {
            return Ok(None);
        }
        Ok(Some(Witness::new(point.to_vec(), truth.at(base, point, budget)?)))
    }

    /// The families whose stability over the box is what is required; the parameters are followed by constants that are not rational.
    fn families(
        self: &Arc<Self>,
        requirement: &Requirement,
        at: Option<&str>,
        parameters: usize,
        budget: &Budget,
    ) -> Result<Vec<FamilyOfLoops>, Error> {
        let (whole, shape) = (self.without_region(), self.shape());
        match requirement.rule() {
            Rule::Sector(_) | Rule::Modulus { .. } => {
                let Some(d) = whole.algebra_over_symbols(budget)?.polynomial() else { return Ok(Vec::new()) };
                let (p, denominator) = budget.enter(|| d.cleared())?;
                let undefined: Vec<&MultiPoly> = d.poles.iter().chain([&denominator]).collect();
                let n = d.formal_degree;
                return Ok(vec![budget.enter(|| match requirement.rule() {
                    Rule::Sector(least) => (BoxPolynomial::in_sector(&p, n, &undefined, parameters, least), None),
                    Rule::Modulus { exponent } => {
                        let radius = radius_below(exponent, BITS);
                        let (top, bottom) = (radius.numerator(), radius.denominator());
                        let scale = |k: usize| &top.pow(k as u64) * &bottom.pow((n - k) as u64);
                        let scaled = Poly::new((0..=n).map(|k| p.coeff(k).scaled_by(&scale(k))).collect());
                        (BoxPolynomial::of_parts(scaled, n, undefined, parameters, shape), None)
                    }
                    _ => unreachable!("about roots"),
                })?]);
            }
            _ => {}
        }
        let family: Family<MultiPoly> = Family::of(&whole, at, budget)?;
        if *family.symbols != whole.fixed_symbols(budget)? {
            return Err(MARGINS_IN_ONE.diagnostic(&[]).into());
        }
        let [open, back] = family.parts();
        let undefined = [&family.undefined];
        let closed = open.plus(back);
        let above = |x: &Real| x.exact().unwrap_or_else(|| x.refined_to_digits(DIGITS).enclosure().1);
        let up_to = |t: Rational| Side::fixed(t.clone(), [t, Rational::ZERO]);
        let (list, side) = match requirement.rule() {
            Rule::Factors(factor) => {
                let g = above(&Real::from(factor.clone()));
                let below = &Rational::ONE - &g.recip().expect("a factor above 1");
                let with_factor = open.plus(&back.scaled(&MultiPoly::variable(parameters)));
                let n = open.degree().max(back.degree()).unwrap_or(0);
                let p = budget.enter(|| BoxPolynomial::of_parts(with_factor, n, undefined, parameters + 1, shape))?;
                (vec![p], Side::fixed(Rational::ONE, [below, &g - &Rational::ONE]))
            }
            Rule::Turned { twice_cosine } => {
                let t = above(&half_tangent(twice_cosine, budget)?);
                let turned = [&closed, &back.minus(open)];
                (vec![budget.enter(|| BoxPolynomial::turned(turned, &undefined, parameters, shape))?], up_to(t))
            }
            Rule::Circle(circle) => {
                let scaled = |p: &Poly<MultiPoly>, by: &Integer| p.scaled(&MultiPoly::constant(by.clone()));
                let (least, combined) = (circle.least(), circle.combination(open, back));
                let (m, whole) = (scaled(&combined, &least.numerator()), scaled(&closed, &least.denominator()));
                let both = [[whole.plus(&m), m.minus(&whole)], [whole.minus(&m), m.plus(&whole).negated()]];
                let turned =
                    |[a, b]: &[Poly<MultiPoly>; 2]| BoxPolynomial::turned([a, b], &undefined, parameters, shape);
                (budget.enter(|| both.iter().map(turned).collect())?, up_to(Rational::ONE))
            }
            _ => unreachable!("about the open loop"),
        };
        Ok(list.into_iter().map(|p| (p, Some(side.clone()))).collect())
    }
}

impl RequiredBox {
    fn new(requirement: &Requirement) -> RequiredBox {
        RequiredBox {
            requirement: requirement.clone(),
            decision: BoxDecision::Undecided { why: OpenReason::Untried, cell: Vec::new() },
            factor: None,
            cells: 0,
        }
    }
}

/// What is asked of a requirement over a box, and what is found so far.
struct BoxAsked<'a, B> {
    sides: &'a [Side],
    request: &'a ToleranceRequest,
    most: Option<&'a Rational>,
    /// The point as a witness, if the requirement is not met there.
    breaks: &'a B,
    budget: &'a Budget,
    found: RequiredBox,
}

impl<B: Fn(&[Rational]) -> Result<Option<Witness>, Error>> BoxAsked<'_, B> {
    fn nominal(&self) -> Vec<Rational> {
        self.sides.iter().map(|side| side.nominal().clone()).collect()
    }

    /// Asks one more family whose stability is required, over these sides: its own parameters may follow. False where its nominal point
    /// is not stable.
    fn add<F: StableFamily>(&mut self, p: &F, all: Vec<Side>) -> Result<bool, Error> {
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

impl<B: Fn(&[Rational]) -> Result<Option<Witness>, Error>> BoxAsked<'_, B> {
    /// Asks the families of a delay margin: the delay at the cut is one side more, and so is each constant.
    fn add_delays(&mut self, delay: &DelayBoxes) -> Result<(), Error> {
        for family in delay.families().unwrap_or_default() {
            let own = family.delays.map(|[low, high]| Side::fixed(high.clone(), [&high - &low, Rational::ZERO]));
            let mut all: Vec<Side> = self.sides.iter().cloned().chain(own).collect();
            let is_stable = match family.loops {
                DelayedLoops::Delayed(p) => self.add(p, all)?,
                DelayedLoops::Moving(p) => self.add(p, all)?,
                DelayedLoops::Polynomial(p, constants) => {
                    all.extend(constants.iter().map(|[low, high]| {
                        let middle = low.midpoint(high);
                        let widths = [&middle - low, high - &middle];
                        Side::fixed(middle, widths)
                    }));
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
fn of_parameters<F: StableFamily>(
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
