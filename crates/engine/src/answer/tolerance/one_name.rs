//! The tolerance of one name beside functions and dead time: the stable sets up and down from the nominal value tell it whole.

use super::decide::{Asked, volume};
use super::held::Truth;
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

impl Problem {
    /// The answer about a box with one side that holds a stable nominal value; `None` where a line is not decided.
    ///
    /// Cost: that of the stable set on either side of the nominal value.
    pub(super) fn tolerance_of_one(
        self: &Arc<Self>,
        p: &impl Family,
        truth: &Truth,
        (side, at): (&Side, &AtPoint),
        asked: Asked<'_>,
        budget: &Budget,
    ) -> Result<Option<Answer<ToleranceAnswer>>, Error> {
        let sides = vec![side.clone()];
        let domain = self.domain_factor(&sides);
        // What lies beyond the domain is no part of a stable set.
        if domain.as_ref().is_some_and(|most| *most <= Rational::ONE) {
            return Ok(None);
        }
        let part = budget.share(LINE_SHARE.0, LINE_SHARE.1);
        let mut nearest: Option<(Rational, Box<WorstEnd>)> = None;
        for (width, direction) in side.widths().iter().zip([-Rational::ONE, Rational::ONE]) {
            if width.is_zero() {
                continue;
            }
            let worst = match self.end_of_line(side, &direction, domain.as_ref(), &part) {
                Ok(LineEnd::Free) => continue,
                Ok(LineEnd::Ends(worst)) => worst,
                Ok(LineEnd::Undecided) | Err(Error::Refused(_)) => return Ok(None),
                Err(Error::Stopped(_)) if budget.check().is_ok() => return Ok(None),
                Err(error) => return Err(error),
            };
            let is_nearer = match &nearest {
                None => true,
                Some((_, known)) => worst.end.value.compare(&known.end.value, budget)?.is_lt(),
            };
            if is_nearer {
                nearest = Some((direction, worst));
            }
        }
        let gap = &asked.request.gap;
        let Some((direction, worst)) = nearest else {
            let farthest = Rational::from(REACHES[REACHES.len() - 1]);
            let factor =
                LargestFactor::at_least(domain.clone().map_or(farthest.clone(), |most| most.min(farthest)), gap);
            let found = ToleranceAnswer {
                factor: Some(factor),
                domain_factor: domain,
                ..self.bare(sides, at.clone(), stable())
            };
            return Ok(Some(self.answer_of_one(found, (p, truth), asked, budget)));
        };
        let mut factor = budget.enter(|| LargestFactor::before(&worst.end.value, vec![direction], gap))?;
        let (base, step) = ray(&sides, factor.direction.as_deref().unwrap_or_default());
        let upper = factor.upper.iter();
        let mut beyond = upper.map(|upper| base.iter().zip(&step).map(|(b, s)| b + &(s * upper)).collect());
        // Where stability is only touched, no point beyond shows it.
        factor.witness = match beyond.next().map(|point| truth.confirmed(p, Witness::uncounted(point), budget)) {
            Some(Err(Error::Stopped(_))) | None => None,
            Some(found) => found?,
        };
        let decision = match worst.end.value.compare_rational(&Rational::ONE).is_gt() {
            true => stable(),
            false => BoxDecision::NotStable { witness: factor.witness.clone() },
        };
        let exact = ExactFactor { value: worst.end.value.clone(), proof: None };
        let found = ToleranceAnswer {
            factor: Some(factor),
            exact: asked.request.exact.then_some(exact),
            worst: Some(*worst),
            domain_factor: domain,
            ..self.bare(sides, at.clone(), decision)
        };
        Ok(Some(self.answer_of_one(found, (p, truth), asked, budget)))
    }

    /// The answer, without what was not asked for, and with the volume where that was.
    fn answer_of_one(
        self: &Arc<Self>,
        found: ToleranceAnswer,
        (p, truth): (&impl Family, &Truth),
        asked: Asked<'_>,
        budget: &Budget,
    ) -> Answer<ToleranceAnswer> {
        let volume = volume(p, &truth.beside(&found.sides), asked.request, budget);
        let found = ToleranceAnswer { volume, ..found };
        let value = match asked.request.factor {
            true => found,
            false => ToleranceAnswer { factor: None, worst: None, domain_factor: None, ..found },
        };
        Answer::new(Arc::clone(self), value)
    }

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
