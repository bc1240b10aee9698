//! The questions that the search asks the engine: along one gain, in the plane of two, at a point. Each answer says where the loop is stable and meets
//! its requirements.

use crate::asked::{Asked, Objective};
use crate::formula::Formula;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, PointVerdict, Verdict};
use jurist_engine::coverage::CoefficientRing;
use jurist_engine::error::{Code, Error};
use jurist_engine::problem::{Ask, Bound, Free, Problem, Question, Region};
use jurist_engine::response::{AllOf, Level, LevelAsked, RequiredSet, Requirement, RequirementMet};
use jurist_stability::Range;
use jurist_stability::plane::Strip;
use std::sync::Arc;

/// Bits of a margin.
const BITS: u64 = 64;

/// The question in which every name has a value, except the gains.
pub(crate) struct Lines<'a> {
    pub asked: &'a Asked,
    /// The question; no gain is set or free.
    base: Question,
    /// The domains of the gains.
    ranges: Vec<Range>,
    region: Region,
    /// What is to be best, where that is an expression.
    pub formula: Option<Formula>,
    pub budget: &'a Budget,
}

impl<'a> Lines<'a> {
    pub fn new(question: &Question, asked: &'a Asked, budget: &'a Budget) -> Result<Lines<'a>, Error> {
        let names = || asked.gains.iter().map(|gain| gain.name.as_str());
        let base = names().fold(question.clone(), Question::without_value);
        // Where one plant stands for all of them.
        let middle = |base: Question, all: &AllOf| base.set(&all.name, all.range[0].midpoint(&all.range[1]));
        let base = asked.for_all.iter().fold(base, middle);
        let whole = names().fold(base.clone(), |question, name| question.free(name)).problem()?;
        let within = |gain: &crate::asked::Gain, range: &Range| {
            let [low, high] = gain.bounds.clone();
            Range::between(low.or(range.lower.clone()), high.or(range.upper.clone()))
        };
        let ranges = asked.gains.iter().zip(whole.free()).map(|(gain, free)| within(gain, &free.domain)).collect();
        let region = asked.requirements.region.clone().unwrap_or_else(|| whole.region().clone());
        let formula = match &asked.objective {
            Objective::Formula { .. } => Some(Formula::of(&asked.objective_text(), &asked.gains, &base)?),
            _ => None,
        };
        Ok(Lines { asked, base, ranges, region, formula, budget })
    }

    /// The same with other requirements and bounds.
    pub fn with<'b>(&self, asked: &'b Asked) -> Result<Lines<'b>, Error>
    where
        'a: 'b,
    {
        Lines::new(&self.base.clone().within(Region::of(self.base.model().time())), asked, self.budget)
    }

    /// The same with ends for a gain that has none: beyond them nothing is asked for.
    pub fn within(&self, gain: usize, [low, high]: [Option<Rational>; 2]) -> Lines<'a> {
        let mut ranges = self.ranges.clone();
        let own = ranges[gain].clone();
        ranges[gain] = Range::between(own.lower.or(low), own.upper.or(high));
        let (base, region, formula) = (self.base.clone(), self.region.clone(), self.formula.clone());
        Lines { asked: self.asked, base, ranges, region, formula, budget: self.budget }
    }

    /// The region that is asked for, where it is smaller than that of plain stability.
    pub fn own_region(&self) -> Option<Region> {
        let plain = Region::of(self.base.model().time());
        (self.region != plain).then(|| self.region.clone())
    }

    /// The domain of a gain.
    pub fn range(&self, gain: usize) -> &Range {
        &self.ranges[gain]
    }

    /// The bound of the region that is asked for in any case.
    pub fn least_bound(&self) -> Option<&Rational> {
        match self.region.bound() {
            Bound::Number(bound) => Some(bound),
            Bound::Free => None,
        }
    }

    /// What is asked of a point, at a value of the level's scale.
    fn asks(&self, scale: Option<&Rational>) -> Result<(Vec<Requirement>, Region), Error> {
        let mut list = self.asked.requirements.list.clone();
        let mut region = self.region.clone();
        if let (Some(level), Some(scale)) = (self.asked.level(), scale) {
            match level.asked_between(scale, self.asked.between())? {
                LevelAsked::Region(asked) => region = asked,
                LevelAsked::Requirement(requirement) => list.push(requirement),
            }
        }
        Ok((list, region))
    }

    /// Work after whose end by the budget something is known all the same.
    ///
    /// # Errors
    /// Those of the work, and the end of the budget.
    pub fn part<T>(&self, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        self.budget.enter(work)?
    }

    fn free(&self, question: Question, gain: usize) -> Question {
        let name = &self.asked.gains[gain].name;
        question.free(name).domain(name, self.ranges[gain].clone())
    }

    /// All gains free, and behind them the names whose values are all of a range.
    pub fn problem(&self) -> Result<Arc<Problem>, Error> {
        self.problem_within(self.region.clone())
    }

    /// The same in another region.
    pub fn problem_within(&self, region: Region) -> Result<Arc<Problem>, Error> {
        let question = (0..self.asked.gains.len()).fold(self.base.clone(), |question, gain| self.free(question, gain));
        let all = |question: Question, all: &AllOf| {
            let [least, greatest] = all.range.clone().map(Some);
            question.without_value(&all.name).free(&all.name).domain(&all.name, Range::between(least, greatest))
        };
        self.asked.for_all.iter().fold(question, all).within(region).problem()
    }

    /// The values of a gain that meet what is asked, with a value for the other one.
    pub fn set(
        &self,
        gain: usize,
        other: Option<(usize, &Rational)>,
        scale: Option<&Rational>,
    ) -> Result<Answer<RequiredSet>, Error> {
        let (list, region) = self.asks(scale)?;
        let mut question = self.free(self.base.clone(), gain);
        if let Some((other, value)) = other {
            question = question.set(self.asked.gains[other].name.clone(), value.clone());
        }
        question.within(region).problem()?.required_set(&list, self.at(), self.budget)
    }

    /// The strips of two gains, the first one being the one that is named; what is asked is met in their stable cells.
    pub fn strips(&self, first: usize, scale: Option<&Rational>) -> Result<Vec<Strip>, Error> {
        /// Digits of what is not looked at.
        const DIGITS: usize = 6;
        let (list, region) = self.asks(scale)?;
        let question = self.free(self.free(self.base.clone(), first), 1 - first);
        let map = question.within(region).map(DIGITS, self.budget)?;
        if list.is_empty() {
            return Ok(map.into_value().decomposition.strips);
        }
        let map = map.with_requirements(&list, self.at(), self.budget)?.into_value();
        let required = map.required.expect("requirements were asked for");
        Ok(required.all().map.strips.clone())
    }

    /// What a point has of what is required, and its verdict.
    pub fn point(
        &self,
        values: &[(String, Rational)],
        scale: Option<&Rational>,
    ) -> Result<(Answer<PointVerdict>, Vec<RequirementMet>), Error> {
        let (list, region) = self.asks(scale)?;
        let problem = self.base.clone().set_all(values.iter().cloned()).within(region).problem()?;
        Ok((problem.verdict(self.budget)?, problem.requirements_met(&list, self.at(), self.budget)?))
    }

    /// Whether a point meets what is asked.
    pub fn is_met(&self, values: &[(String, Rational)], scale: Option<&Rational>) -> Result<bool, Error> {
        let (verdict, met) = self.point(values, scale)?;
        Ok(verdict.value().verdict == Verdict::Stable && met.iter().all(|found| found.met))
    }

    /// The same, without a look at requirements where the point is not stable.
    pub fn is_met_in_order(&self, values: &[(String, Rational)], scale: Option<&Rational>) -> Result<bool, Error> {
        let (list, region) = self.asks(scale)?;
        let problem = self.base.clone().set_all(values.iter().cloned()).within(region).problem()?;
        if problem.verdict(self.budget)?.value().verdict != Verdict::Stable {
            return Ok(false);
        }
        Ok(problem.requirements_met(&list, self.at(), self.budget)?.iter().all(|found| found.met))
    }

    /// Whether boxes of gains are searched: for all plants, of three gains or more, and of two behind a hold where the map takes minutes, and of
    /// two with dead time, where there is none; of an expression, of a peak gain, and of a delay margin.
    pub fn are_boxes_asked(&self) -> Result<bool, Error> {
        if !self.asked.for_all.is_empty() || self.is_delay_margin_asked() {
            return Ok(true);
        }
        if self.asked.gains.len() != 2 || self.asked.by_boxes || self.formula.is_some() {
            return Ok(self.asked.gains.len() > 1);
        }
        if self.asked.between().is_some() || matches!(self.asked.objective, Objective::Tolerance(_)) {
            return Ok(true);
        }
        Ok(self.is_bounded() && self.are_maps_long()?)
    }

    /// Whether boxes would be searched if all of two gains had bounds.
    pub fn are_bounds_missing(&self) -> Result<bool, Error> {
        Ok(self.asked.gains.len() == 2 && !self.is_bounded() && self.are_maps_long()?)
    }

    fn is_bounded(&self) -> bool {
        self.ranges.iter().all(|range| range.lower.is_some() && range.upper.is_some())
    }

    /// Whether a map of two gains with all that is asked takes minutes.
    fn are_maps_long(&self) -> Result<bool, Error> {
        if self.asked.requirements.list.is_empty() && self.asked.level().is_none() {
            return Ok(false);
        }
        let ring = self.problem()?.coefficient_ring(self.budget)?;
        Ok(matches!(ring, CoefficientRing::Constants | CoefficientRing::Functions | CoefficientRing::DeadTime))
    }

    /// The nominal values of the gains, if all have one and they meet what is asked; not beside other plants.
    pub fn nominal(&self) -> Result<Option<Vec<Rational>>, Error> {
        if !self.asked.for_all.is_empty() {
            return Ok(None);
        }
        let within = |(free, range): (&Free, &Range)| {
            let bounds = Range::between(range.lower.clone(), range.upper.clone());
            free.nominal.clone().filter(|x| bounds.contains(x))
        };
        let problem = self.problem()?;
        let values: Option<Vec<Rational>> = problem.free().iter().zip(&self.ranges).map(within).collect();
        let Some(values) = values else { return Ok(None) };
        let names = self.asked.gains.iter().map(|gain| gain.name.clone());
        let named: Vec<(String, Rational)> = names.zip(values.iter().cloned()).collect();
        Ok(self.is_met_in_order(&named, None)?.then_some(values))
    }

    /// The same with another budget.
    pub fn with_budget<'b>(&self, budget: &'b Budget) -> Lines<'b>
    where
        'a: 'b,
    {
        let (base, ranges, region) = (self.base.clone(), self.ranges.clone(), self.region.clone());
        Lines { asked: self.asked, base, ranges, region, formula: self.formula.clone(), budget }
    }

    /// Whether a delay margin is required, or to be best, and no set of one gain tells it. No map does.
    fn is_delay_margin_asked(&self) -> bool {
        let name = Level::DelayMargin.name();
        let is_end_of_set =
            matches!(self.asked.objective, Objective::Greatest(_) | Objective::Least(_) | Objective::Anything);
        let is_required = self.asked.requirements.list.iter().any(|requirement| requirement.name() == name);
        self.asked.level() == Some(Level::DelayMargin) || is_required && !(is_end_of_set && self.asked.gains.len() == 1)
    }

    /// Where margins are taken.
    pub fn at(&self) -> Option<&str> {
        self.asked.requirements.at.as_deref()
    }

    /// The margin that a point has, enclosed; `None` where it has no bound, and of levels that are no margins.
    pub fn level_at(&self, values: &[(String, Rational)], level: Level) -> Result<Option<Enclosure>, Error> {
        let problem = self.base.clone().set_all(values.iter().cloned()).within(self.region.clone()).problem()?;
        match problem.level_at((level, self.asked.between()), self.at(), BITS, self.budget) {
            // A gain of zero opens the loop: it has no margins.
            Err(Error::Refused(_)) => Ok(None),
            found => found,
        }
    }

    /// Whether a margin of a stable point has no bound: none limits it, or its gains open the loop.
    pub fn has_no_bound(&self, values: &[(String, Rational)], level: Level) -> Result<bool, Error> {
        let problem = self.base.clone().set_all(values.iter().cloned()).within(self.region.clone()).problem()?;
        match problem.level_at((level, self.asked.between()), self.at(), BITS, self.budget) {
            // What is refused for another reason is not known.
            Err(Error::Refused(found)) => Ok(found.diagnostics().iter().all(|one| one.code == Code::Cut)),
            found => Ok(found?.is_none()),
        }
    }

    /// The best bound of the region in which the roots of a point lie: its decay rate, or its radius.
    pub fn bound_at(&self, values: &[(String, Rational)], level: Level) -> Result<Option<Real>, Error> {
        let question = unbounded(self.base.clone()).set_all(values.iter().cloned()).free(level.name());
        let set = question.stable_set(self.budget)?.into_value();
        let interval = if level.is_rising() { set.intervals().first() } else { set.intervals().last() };
        let end = interval.and_then(|i| if level.is_rising() { i.upper.as_ref() } else { i.lower.as_ref() });
        Ok(end.map(|end| end.value.clone()))
    }
}

/// The question without the region that was asked for.
fn unbounded(question: Question) -> Question {
    let names: Vec<String> = question.free_names().to_vec();
    let mut out = question.model().ask();
    for (name, value) in question.values_set() {
        out = out.set(name.clone(), value.clone());
    }
    names.into_iter().fold(out, |out, name| out.free(name))
}
