//! The tolerance of one name beside functions and dead time: the stable sets up and down from the nominal value tell it whole.

use super::decide::volume;
use super::family_box::FamilyBox;
use super::{ExactFactor, ToleranceAnswer, WorstEnd};
use crate::answer::Answer;
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::boxes::{BoxDecision, BoxProof, Family, LargestFactor, Side, Witness, ray};
use crate::stability::{AtPoint, End, Range};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
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
        if self.p.as_polynomial().is_some() || request.limit.is_some() || !request.requirements.is_empty() {
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
        Ok(Some(self.answer_of_one(ToleranceAnswer { domain_factor, ..found })))
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

/// Where a line from the nominal value ends.
enum LineEnd {
    /// Not up to the domain's end or the farthest factor that is asked for.
    Free,
    /// Stability is lost.
    Ends(Box<WorstEnd>),
    /// What happens next is not known.
    Undecided,
}

fn stable() -> BoxDecision {
    BoxDecision::Stable(BoxProof::of_line())
}
