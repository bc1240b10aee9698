//! The tolerance of one name beside functions and dead time: the sets of its values tell it whole.

use super::decide::volume;
use super::family_box::{FamilyBox, Growth};
use super::{ExactFactor, RequiredBox, ToleranceAnswer, WorstEnd};
use crate::answer::Answer;
use crate::error::Error;
use crate::problem::Problem;
use crate::response::{RequiredEnd, RequiredInterval, Requirement, enclosed, within};
use crate::stability::boxes::{BoxDecision, BoxProof, Family, LargestFactor, Side, Witness, ray};
use crate::stability::{AtPoint, Cause, End, Range};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// The line is asked for up to these factors, one after another, until it ends.
const REACHES: [i64; 3] = [4, 64, 1024];

/// The part of the time that the lines may take before boxes are asked.
const LINE_SHARE: (u32, u32) = (1, 2);

impl<F: Family> FamilyBox<'_, F> {
    /// The answer about a box with one side that holds a stable nominal value; `None` of other boxes, and where a line is not decided.
    ///
    /// Cost: that of the stable set on either side of the nominal value.
    pub(super) fn of_one_name(&self, at: &AtPoint) -> Result<Option<Answer<ToleranceAnswer>>, Error> {
        let request = self.request();
        let [side] = self.sides else { return Ok(None) };
        // Requirements over constants have long families.
        let is_plain = self.truth.is_exact() || request.requirements.is_empty();
        // Of complex loops boxes know no requirements.
        let needs_line = !request.requirements.is_empty() && self.problem.is_complex();
        let is_of_boxes = self.p.as_polynomial().is_some() && is_plain && !needs_line;
        if is_of_boxes || request.limit.is_some() || !side.grows() {
            return Ok(None);
        }
        let domain_factor = self.problem.domain_factor(self.sides);
        // What lies beyond the domain is no part of a stable set.
        if domain_factor.as_ref().is_some_and(|most| *most <= Rational::ONE) {
            return Ok(None);
        }
        let found = match self.nearest_end(side, domain_factor.as_ref())? {
            NearestEnd::Undecided => return Ok(None),
            NearestEnd::None => {
                let farthest = Rational::from(REACHES[REACHES.len() - 1]);
                let up_to = domain_factor.clone().map_or(farthest.clone(), |most| most.min(farthest));
                let factor = Some(LargestFactor::at_least(up_to, &request.gap));
                ToleranceAnswer { factor, ..self.problem.bare(self.sides.to_vec(), at.clone(), stable()) }
            }
            NearestEnd::At(direction, worst) => self.up_to_end(at, direction, *worst)?,
        };
        let found = ToleranceAnswer { domain_factor, ..found };
        Ok(self.with_requirements(side, found)?.map(|found| self.answer_of_one(found)))
    }

    /// The answer with the requirements, where the set of values that meet each of them is known around the nominal value.
    fn with_requirements(&self, side: &Side, found: ToleranceAnswer) -> Result<Option<ToleranceAnswer>, Error> {
        let requirements = &self.request().requirements;
        if requirements.is_empty() {
            return Ok(Some(found));
        }
        let mut grown = Growth::of(found.decision.clone(), found.factor.clone());
        for requirement in requirements {
            let Some(own) = self.required_line(requirement, side, found.domain_factor.as_ref())? else {
                return Ok(None);
            };
            grown.add(own);
        }
        let Growth { decision, factor, required, binding } = grown;
        let is_stability = binding.is_none() && factor.is_some();
        let (worst, exact) = if is_stability { (found.worst, found.exact) } else { (None, None) };
        Ok(Some(ToleranceAnswer { decision, factor, required, binding, worst, exact, ..found }))
    }

    /// How far one requirement is met around the nominal value; `None` where that is not told.
    fn required_line(
        &self,
        requirement: &Requirement,
        side: &Side,
        most: Option<&Rational>,
    ) -> Result<Option<RequiredBox>, Error> {
        let part = self.budget.share(LINE_SHARE.0, LINE_SHARE.1);
        let (nominal, mut found) = (side.nominal(), RequiredBox { cells: 1, ..RequiredBox::new(requirement) });
        if let Some(witness) = self.breaks(requirement, std::slice::from_ref(nominal))? {
            found.decision = BoxDecision::NotStable { witness: Some(witness) };
            return Ok(Some(found));
        }
        let requirements = std::slice::from_ref(requirement);
        let set = match self.problem.required_set(requirements, self.request().at.as_deref(), &part) {
            Ok(set) => set.into_value(),
            Err(Error::Refused(_)) => return Ok(None),
            Err(Error::Stopped(_)) if self.budget.check().is_ok() => return Ok(None),
            Err(error) => return Err(error),
        };
        let Some(around) = set.intervals.iter().find(|interval| interval.contains(nominal)) else { return Ok(None) };
        let farthest = Rational::from(REACHES[REACHES.len() - 1]);
        let up_to = most.map_or(farthest.clone(), |most| farthest.min(most.clone()));
        found.decision = stable();
        match self.nearest_of(around, side)? {
            Some(RequiredEndAt { factor: end, direction, is_known })
                if self.budget.enter(|| end.compare_rational(&up_to).is_lt())? =>
            {
                if !is_known {
                    return Ok(None);
                }
                let Some(mut factor) = self.required_up_to(requirement, &end, direction)? else { return Ok(None) };
                // A requirement that is met at its end is met on the edge of a box that ends there; of another one the witness is on that edge.
                match factor.upper.as_ref().is_some_and(|upper| *upper <= Rational::ONE) {
                    true => found.decision = BoxDecision::NotStable { witness: factor.witness.clone() },
                    false => factor.lower = factor.lower.max(Rational::ONE),
                }
                found.factor = Some(factor);
            }
            _ => found.factor = Some(LargestFactor::at_least(up_to, &self.request().gap)),
        }
        Ok(Some(found))
    }

    /// The nearer end of the values around the nominal one that meet a requirement; `None` where they have no end in the domain.
    fn nearest_of(&self, around: &RequiredInterval, side: &Side) -> Result<Option<RequiredEndAt>, Error> {
        let mut nearest: Option<RequiredEndAt> = None;
        for ((end, width), sign) in [&around.lower, &around.upper].into_iter().zip(side.widths()).zip([-1, 1]) {
            let Some(end) = end.as_ref().filter(|_| !width.is_zero()) else { continue };
            let is_known = match end {
                RequiredEnd::Stability(end) if end.causes.contains(Cause::Undecided) => false,
                RequiredEnd::Stability(end) if !end.causes.is_limit() => continue,
                _ => true,
            };
            let factor = self.budget.enter(|| factor_of(&end.value(), side.nominal(), width, sign))?;
            let is_nearer = match &nearest {
                None => true,
                Some(known) => factor.compare(&known.factor, self.budget)?.is_lt(),
            };
            if is_nearer {
                nearest = Some(RequiredEndAt { factor, direction: Rational::from(sign), is_known });
            }
        }
        Ok(nearest)
    }

    /// The bracket of a factor at which a requirement ceases to be met; `None` where no point just beyond shows it.
    fn required_up_to(
        &self,
        requirement: &Requirement,
        end: &Real,
        direction: Rational,
    ) -> Result<Option<LargestFactor>, Error> {
        let gap = &self.request().gap;
        let (base, step) = ray(self.sides, std::slice::from_ref(&direction));
        let mut factor = self.budget.enter(|| LargestFactor::before(end, vec![direction], gap))?;
        let Some(at) = factor.upper.clone() else { return Ok(None) };
        // At the end itself the requirement may be met.
        for upper in [at.clone(), &at + &(&at * gap)] {
            let point: Vec<Rational> = base.iter().zip(&step).map(|(b, s)| b + &(s * &upper)).collect();
            if let Some(witness) = self.breaks(requirement, &point)? {
                (factor.upper, factor.witness) = (Some(upper), Some(witness));
                return Ok(Some(factor));
            }
        }
        Ok(None)
    }

    /// Which end of the two lines is the nearer one.
    fn nearest_end(&self, side: &Side, most: Option<&Rational>) -> Result<NearestEnd, Error> {
        let part = self.budget.share(LINE_SHARE.0, LINE_SHARE.1);
        let mut nearest: Option<(Rational, Box<WorstEnd>)> = None;
        for (width, direction) in side.widths().iter().zip([-Rational::ONE, Rational::ONE]) {
            if width.is_zero() {
                continue;
            }
            let worst = match self.problem.end_of_line(side, &direction, most, &part) {
                Ok(LineEnd::Free) => continue,
                Ok(LineEnd::Ends(worst)) => worst,
                Ok(LineEnd::Undecided) | Err(Error::Refused(_)) => return Ok(NearestEnd::Undecided),
                Err(Error::Stopped(_)) if self.budget.check().is_ok() => return Ok(NearestEnd::Undecided),
                Err(error) => return Err(error),
            };
            let is_nearer = match &nearest {
                None => true,
                Some((_, known)) => worst.end.value.compare(&known.end.value, self.budget)?.is_lt(),
            };
            if is_nearer {
                nearest = Some((direction, worst));
            }
        }
        Ok(nearest.map_or(NearestEnd::None, |(direction, worst)| NearestEnd::At(direction, worst)))
    }

    /// The answer where a line ends.
    fn up_to_end(&self, at: &AtPoint, direction: Rational, worst: WorstEnd) -> Result<ToleranceAnswer, Error> {
        let (request, end) = (self.request(), &worst.end.value);
        let mut factor = self.budget.enter(|| LargestFactor::before(end, vec![direction], &request.gap))?;
        let (base, step) = ray(self.sides, factor.direction.as_deref().unwrap_or_default());
        let beyond = factor.upper.as_ref().map(|upper| base.iter().zip(&step).map(|(b, s)| b + &(s * upper)).collect());
        // Where stability is only touched, no point beyond shows it.
        let confirmed = |point| self.truth.confirmed(self.p, Witness::uncounted(point), self.budget);
        factor.witness = match beyond.map(confirmed) {
            Some(Err(Error::Stopped(_))) | None => None,
            Some(found) => found?,
        };
        let decision = match end.compare_rational(&Rational::ONE).is_gt() {
            true => stable(),
            false => BoxDecision::NotStable { witness: factor.witness.clone() },
        };
        let exact = ExactFactor { value: end.clone(), proof: None };
        Ok(ToleranceAnswer {
            factor: Some(factor),
            exact: request.exact.then_some(exact),
            worst: Some(worst),
            ..self.problem.bare(self.sides.to_vec(), at.clone(), decision)
        })
    }

    /// The answer, without what was not asked for, and with the volume where that was.
    fn answer_of_one(&self, found: ToleranceAnswer) -> Answer<ToleranceAnswer> {
        let volume = volume(self.p, &self.truth.beside(&found.sides), self.request(), self.budget);
        let found = ToleranceAnswer { volume, ..found };
        let value = match self.request().factor {
            true => found,
            false => ToleranceAnswer { factor: None, worst: None, domain_factor: None, ..found },
        };
        Answer::new(Arc::clone(self.problem), value)
    }
}

impl Problem {
    /// Where the line in a direction ends.
    fn end_of_line(
        self: &Arc<Self>,
        side: &Side,
        direction: &Rational,
        most: Option<&Rational>,
        budget: &Budget,
    ) -> Result<LineEnd, Error> {
        let (base, step) = ray(std::slice::from_ref(side), std::slice::from_ref(direction));
        let is_at =
            |end: &Option<End>, x: &Rational| end.as_ref().is_some_and(|end| end.value.exact().as_ref() == Some(x));
        for reach in REACHES.map(Rational::from) {
            let reach = most.map_or(reach.clone(), |most| reach.min(most.clone()));
            let range = Range::between(Some(Rational::ZERO), Some(reach.clone()));
            let problem = Arc::new(self.on_ray("factor", &base, &step, range, budget)?);
            let set = problem.stable_set(budget)?.into_value();
            let first = set.intervals().first().filter(|first| is_at(&first.lower, &Rational::ZERO));
            let Some(end) = first.and_then(|first| first.upper.clone()) else { return Ok(LineEnd::Undecided) };
            if end.value.exact().as_ref() != Some(&reach) {
                // Nothing is known to happen at an undecided bracket.
                let is_limit = end.causes.is_limit();
                return Ok(if is_limit {
                    LineEnd::Ends(Box::new(WorstEnd { problem, end }))
                } else {
                    LineEnd::Undecided
                });
            }
            if most == Some(&reach) {
                break;
            }
        }
        Ok(LineEnd::Free)
    }
}

/// The nearer one of the ends of both lines.
enum NearestEnd {
    /// Neither line ends.
    None,
    /// In this direction.
    At(Rational, Box<WorstEnd>),
    /// What happens on a line is not known.
    Undecided,
}

/// Where the values that meet a requirement end.
struct RequiredEndAt {
    factor: Real,
    direction: Rational,
    /// Whether they end there: else nothing is known of what is beyond.
    is_known: bool,
}

/// Where a line from the nominal value ends.
enum LineEnd {
    /// Not up to the domain's end or the farthest factor that is asked for.
    Free,
    /// Stability is lost.
    Ends(Box<WorstEnd>),
    /// What happens next is not known.
    Undecided,
}

/// The distance of an end from the nominal value, in widths.
fn factor_of(end: &Real, nominal: &Rational, width: &Rational, sign: i64) -> Real {
    let per_width = Rational::from(sign) / width;
    if let Some(exact) = end.exact() {
        return ((exact - nominal) * &per_width).into();
    }
    let (end, nominal) = (end.clone(), nominal.clone());
    enclosed("a factor of a tolerance", move |bits| {
        let at = within(&end, bits);
        let [a, b] = [at.lower(), at.upper()].map(|x| (x - &nominal) * &per_width);
        Some(if a < b { Enclosure::new(a, b) } else { Enclosure::new(b, a) })
    })
}

fn stable() -> BoxDecision {
    BoxDecision::Stable(BoxProof::of_line())
}
