//! A family of loops over a box of tolerances, and the steps of its answer.

use super::bounds::{agreed, bounded_by};
use super::decide::{Asked, too_many, volume};
use super::held::Truth;
use super::required::{nearer, worse};
use super::{ExactFactor, RequiredBox, ToleranceAnswer, ToleranceRequest};
use crate::answer::Answer;
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::AtPoint;
use crate::stability::boxes::{BoxDecision, Family, LargestFactor, OpenReason, Search, Side, ToleranceProblem};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// The part of the time that may be spent on the bracket of the largest factor.
const BRACKET_SHARE: (u32, u32) = (4, 5);

/// A question about tolerances: the family of loops, the box, and the request.
pub(super) struct FamilyBox<'a, F> {
    pub problem: &'a Arc<Problem>,
    pub p: &'a F,
    /// It counts the roots at a point.
    pub truth: &'a Truth<'a>,
    pub sides: &'a [Side],
    pub asked: Asked<'a>,
    pub budget: &'a Budget,
}

impl<F: Family> FamilyBox<'_, F> {
    pub fn nominal(&self) -> Vec<Rational> {
        self.sides.iter().map(|side| side.nominal().clone()).collect()
    }

    pub fn request(&self) -> &ToleranceRequest {
        self.asked.request
    }

    pub fn answer(&self) -> Result<Answer<ToleranceAnswer>, Error> {
        if let Some(spoilt) = self.spoilt_by_ranges()? {
            return Ok(spoilt);
        }
        let (problem, budget) = (self.problem, self.budget);
        let all = self.truth.beside(self.sides);
        let degree = problem.algebra_over_symbols(budget)?.formal_degree();
        let at = self.truth.at(self.p, &self.nominal(), budget)?;
        let is_stable = at.is_stable(degree);
        if is_stable && let Some(answer) = self.of_one_name(&at)? {
            return Ok(answer);
        }
        let boxes = match is_stable {
            true => budget.enter(|| ToleranceProblem::new(self.p, all.clone()))?,
            false => None,
        };
        let Some(boxes) = boxes else {
            let decision = match is_stable {
                false => BoxDecision::not_stable_at(self.nominal(), at.clone()),
                true => BoxDecision::Undecided { why: OpenReason::Constants, cell: Vec::new() },
            };
            let bare = problem.bare(self.sides.to_vec(), at, decision);
            let volume = volume(self.p, &all, self.request(), budget);
            return Ok(Answer::new(Arc::clone(problem), ToleranceAnswer { volume, ..bare }));
        };
        let polynomial = self.p.as_polynomial().and_then(|p| ToleranceProblem::new(p, all.clone()));
        if let Some(polynomial) = polynomial.as_ref().filter(|boxes| boxes.coefficients().is_none()) {
            return Err(too_many(polynomial));
        }
        StableBox { of: self, at, all, boxes, polynomial }.answer()
    }

    /// The answer where not even the nominal values of the tolerances are good for all values of the other names' ranges.
    fn spoilt_by_ranges(&self) -> Result<Option<Answer<ToleranceAnswer>>, Error> {
        if self.sides.iter().all(Side::grows) {
            return Ok(None);
        }
        let request = ToleranceRequest {
            tolerances: Vec::new(),
            for_all: Vec::new(),
            limit: None,
            exact: false,
            volume: None,
            factor: !self.request().requirements.is_empty(),
            ..self.request().clone()
        };
        let sides: Vec<Side> = self.sides.iter().map(Side::without_tolerance).collect();
        let ranges = FamilyBox { sides: &sides, asked: Asked { request: &request, told: &|_| () }, ..*self };
        let ToleranceAnswer { decision, required, nominal, .. } = ranges.answer()?.into_value();
        if decision.is_stable() {
            return Ok(None);
        }
        let value = ToleranceAnswer { required, ..self.problem.bare(self.sides.to_vec(), nominal, decision) };
        Ok(Some(Answer::new(Arc::clone(self.problem), value)))
    }
}

/// A box around a nominal point that is stable.
struct StableBox<'a, F> {
    of: &'a FamilyBox<'a, F>,
    /// What is true of the nominal point.
    at: AtPoint,
    /// The sides, and those of constants that are known as enclosures.
    all: Vec<Side>,
    boxes: ToleranceProblem<'a, F>,
    /// The same of a polynomial.
    polynomial: Option<ToleranceProblem<'a>>,
}

/// By how much the box can grow, so far.
pub(super) struct Growth {
    pub decision: BoxDecision,
    /// `None` where one of the requirements has none.
    pub factor: Option<LargestFactor>,
    pub required: Vec<RequiredBox>,
    /// The requirement that ends the largest box; `None` where stability does.
    pub binding: Option<usize>,
}

impl<F: Family> StableBox<'_, F> {
    fn answer(&self) -> Result<Answer<ToleranceAnswer>, Error> {
        let FamilyBox { problem, asked, budget, .. } = self.of;
        let answered = |decision| problem.answered(self.of.sides.to_vec(), self.at.clone(), decision);
        if !asked.request.factor {
            let decision = self.decided()?;
            if decision.is_stable() {
                return Ok(answered(decision));
            }
        }
        let domain_factor = problem.domain_factor(self.of.sides);
        let search = self.boxes.searched(budget)?;
        let decision = self.decided_after(&search)?;
        // A proof stands, whatever is found of larger boxes.
        if decision.is_stable() && asked.request.requirements.is_empty() {
            (asked.told)(&answered(decision.clone()));
        }
        let grown = self.grown(search, decision, domain_factor.as_ref())?;
        let value = self.with_end(grown, domain_factor)?;
        Ok(Answer::new(Arc::clone(problem), value))
    }

    /// Whether the box itself is stable, by a proof alone.
    fn decided(&self) -> Result<BoxDecision, Error> {
        let FamilyBox { p, truth, budget, .. } = self.of;
        truth.decision(*p, self.boxes.decide(&Rational::ONE, budget)?, budget)
    }

    /// The same after a search for points that are not stable.
    fn decided_after(&self, search: &Search<'_, F>) -> Result<BoxDecision, Error> {
        let FamilyBox { p, truth, budget, .. } = self.of;
        let refuted = self.boxes.refuted(search, &Rational::ONE).map(|witness| truth.confirmed(*p, witness, budget));
        match refuted.transpose()?.flatten() {
            Some(witness) => Ok(BoxDecision::NotStable { witness: Some(witness) }),
            None => self.decided(),
        }
    }

    /// The largest box that is stable and meets each requirement.
    fn grown(
        &self,
        search: Search<'_, F>,
        decision: BoxDecision,
        domain_factor: Option<&Rational>,
    ) -> Result<Growth, Error> {
        let FamilyBox { p, truth, budget, .. } = self.of;
        let request = self.of.request();
        let part = budget.share(BRACKET_SHARE.0, BRACKET_SHARE.1);
        // Of functions a requirement is decided sooner than stability is lost: no box beyond its end is asked for.
        let first = if p.as_polynomial().is_none() { request.requirements.as_slice() } else { &[] };
        let earlier = first.iter().map(|requirement| self.of.required_box(requirement, domain_factor));
        let earlier = earlier.collect::<Result<Vec<_>, Error>>()?;
        let ends = earlier.iter().filter_map(|found| found.factor.as_ref()?.upper.as_ref());
        let most = ends.chain(domain_factor).min().cloned();
        let known = match &decision {
            BoxDecision::Stable(proof) => Some(proof.clone()),
            _ => None,
        };
        let factor = self.boxes.bracket(search, known, &|_| request.gap.clone(), most.as_ref(), &part)?;
        let factor = truth.factor(&self.boxes, *p, factor, budget)?;
        let decision = agreed(decision, &factor, None);
        let factor = Some(bounded_by(&decision, factor, self.of.sides));
        let mut grown = Growth::of(decision, factor);
        let mut earlier = earlier.into_iter();
        for requirement in &request.requirements {
            let found = match earlier.next() {
                Some(found) => found,
                None => {
                    let nearest = grown.factor.as_ref().and_then(|factor| factor.upper.as_ref());
                    let most = nearest.into_iter().chain(domain_factor).min().cloned();
                    self.of.required_box(requirement, most.as_ref())?
                }
            };
            grown.add(found);
        }
        Ok(grown)
    }

    /// What is known of the worst end beyond its bracket, and what else was asked for.
    fn with_end(&self, grown: Growth, domain_factor: Option<Rational>) -> Result<ToleranceAnswer, Error> {
        let FamilyBox { problem, p, truth, sides, budget, .. } = self.of;
        let request = self.of.request();
        let Growth { decision, factor, required, binding } = grown;
        let Some(factor) = factor else {
            let bare = problem.bare(sides.to_vec(), self.at.clone(), decision);
            return Ok(ToleranceAnswer { required, ..bare });
        };
        let (worst, cells) = match binding {
            None => problem.worst_end(sides, &factor, budget)?.unzip(),
            Some(_) => (None, None),
        };
        let limit = request.limit.as_ref().map(|name| self.of.limit(name)).transpose()?;
        let exact = match (&worst, &cells, &self.polynomial) {
            (Some(worst), Some(cells), Some(boxes)) if request.exact && truth.is_exact() => {
                boxes.exact(&factor, &worst.end, cells, budget)?.map(ExactFactor::from)
            }
            _ => None,
        };
        let volume = volume(*p, &self.all, request, budget);
        let decision = agreed(decision, &factor, exact.as_ref());
        Ok(ToleranceAnswer {
            sides: sides.to_vec(),
            nominal: self.at.clone(),
            decision,
            factor: Some(factor),
            worst,
            exact,
            domain_factor,
            limit,
            volume,
            required,
            binding,
        })
    }
}

impl Growth {
    /// Of stability alone.
    pub fn of(decision: BoxDecision, factor: Option<LargestFactor>) -> Growth {
        Growth { decision, factor, required: Vec::new(), binding: None }
    }

    /// With one more requirement, that has to be met as well.
    pub fn add(&mut self, found: RequiredBox) {
        self.decision = worse(self.decision.clone(), found.decision.clone());
        self.factor = match (self.factor.take(), found.factor.clone()) {
            (Some(known), Some(own)) => {
                let (nearest, is_own) = nearer(known, own);
                if is_own {
                    self.binding = Some(self.required.len());
                }
                Some(nearest)
            }
            _ => None,
        };
        self.required.push(found);
    }
}
