//! The stable region in three parameters: exact maps of two of them at values of the third.

mod extent;

pub use extent::{Extreme, Extremes, Stretch, StretchEnd};

use super::{Answer, Map};
use crate::coverage::{self, Coverage};
use crate::error::{Code, Diagnostic, Error};
use crate::problem::{Problem, Question, range_text};
use crate::stability::RealInterval;
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::{Rational, evenly_spaced};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The part of the time that maps may take, so that some is left to write them.
const MAPS: (u32, u32) = (9, 10);

/// The values of a third parameter at which the plane of two others is asked about.
///
/// ```
/// use jurist_engine::answer::SliceValues;
/// let slices = SliceValues::evenly("K", &0.into(), &1.into(), 4)?;
/// assert_eq!(slices.values()[1].to_string(), "1/3");
/// assert!(SliceValues::evenly("K", &1.into(), &0.into(), 4).is_err());
/// # Ok::<(), jurist_engine::error::Diagnostic>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SliceValues {
    name: String,
    values: Vec<Rational>,
}

impl SliceValues {
    /// More slices than this are refused: each is a whole map.
    pub const MOST: usize = 100;

    /// So many values of a parameter at equal distances from the lower to the upper one, both included; exact.
    ///
    /// # Errors
    /// `E-option-value` for fewer than two values, more than [`SliceValues::MOST`], and where the lower one is not below the
    /// upper one.
    pub fn evenly(
        name: impl Into<String>,
        lower: &Rational,
        upper: &Rational,
        count: usize,
    ) -> Result<SliceValues, Diagnostic> {
        let most = SliceValues::MOST;
        if !(2..=most).contains(&count) {
            let message = format!("the number of slices is {count}");
            return Err(Diagnostic::error(Code::OptionValue, message)
                .help(format!("it is 2 to {most}: each slice is a whole map")));
        }
        if lower >= upper {
            let error = Diagnostic::error(Code::OptionValue, "the range of the slices is empty");
            return Err(error.help("the lower end has to be below the upper end; both are slices"));
        }
        Ok(SliceValues { name: name.into(), values: evenly_spaced(lower, upper, count) })
    }

    /// The name of the third parameter.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its values, ascending, at least two.
    pub fn values(&self) -> &[Rational] {
        &self.values
    }

    /// From the first to the last value.
    pub fn width(&self) -> Rational {
        self.last() - &self.values[0]
    }

    fn last(&self) -> &Rational {
        self.values.last().expect("there are two values")
    }
}

/// The map at one value of the third parameter.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BodySlice {
    /// The value.
    pub value: Rational,
    /// The map, the same as that of a question with this value set; stopped where the budget ended before.
    pub map: Result<Answer<Map>, Exhausted>,
    /// How far its regions together reach in either parameter; `None` without a region and without a map.
    pub extent: Option<[RealInterval; 2]>,
}

impl BodySlice {
    /// Whether there are stable points; `None` where that is not known.
    ///
    /// Stability is strict and the degree is kept, so the stable points are an open set: without an open region there is none.
    pub fn has_stable_points(&self) -> Option<bool> {
        self.map.as_ref().ok().map(|map| !map.value().decomposition.regions.is_empty())
    }
}

/// The stable points in three parameters as far as slices tell: what is said holds on the slices, and nothing is said of what
/// lies between them but that some point between two values is the end of stability.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::SliceValues;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("a").nominal("0"))
///     .parameter(ParameterBuilder::new("b").nominal("0"))
///     .parameter(ParameterBuilder::new("c").nominal("0"))
///     .characteristic("(z^2 + a*z + b)*(z - 2*c)")
///     .build()?;
/// let slices = SliceValues::evenly("c", &0.into(), &1.into(), 5)?;
/// let answer = model.ask().free("a").free("b").body(&slices, &"1/100".parse().unwrap(), 6, &Budget::unlimited())?;
/// let stable: Vec<_> = answer.value().slices.iter().map(|s| s.has_stable_points().unwrap()).collect();
/// assert_eq!(stable, [true, true, false, false, false]); // |c| < 1/2
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Body {
    /// The slices by ascending values of the third parameter.
    pub slices: Vec<BodySlice>,
    /// The least and the greatest value of the other two over the slices; `None` where no slice has stable points.
    pub extremes: Result<Option<Extremes>, Exhausted>,
    /// Where slices with stable points follow each other, ascending.
    pub stretches: Vec<Stretch>,
    /// How wide the brackets of the ends of stretches were to become.
    pub narrow: Rational,
}

impl Body {
    /// The slices that the budget did not allow.
    pub fn open_slices(&self) -> impl Iterator<Item = &BodySlice> {
        self.slices.iter().filter(|slice| slice.map.is_err())
    }

    /// The first thing that the budget did not allow, if there is one: a slice, an extreme value, the narrowing of a bracket.
    pub fn stopped(&self) -> Option<&Exhausted> {
        let slices = self.slices.iter().filter_map(|slice| slice.map.as_ref().err());
        let ends = self.stretches.iter().flat_map(|stretch| &stretch.ends).filter_map(StretchEnd::stopped);
        slices.chain(self.extremes.as_ref().err()).chain(ends).next()
    }
}

impl Question {
    /// The exact maps of the two free parameters at values of a third, and how far their stable regions reach together. Where a
    /// slice with stable points is beside one without any, a third value between them is decided until both are not farther
    /// apart than `narrow`.
    ///
    /// Each slice is asked as a question of its own with the value set, not as a specialisation of one polynomial in three
    /// parameters: a constant that is set is another number, and only one that is free counts in the degree
    /// ([`Question::set`]). The evaluation, which is repeated so, is a small part of a map: less than 1 of 22 ms on the built-in drive, 2
    /// of 256 ms with six filters in its current feedback.
    ///
    /// Cost: that of [`Problem::map`] for each slice, on as many threads as there are, and that of a decomposition
    /// for each halving of a bracket.
    ///
    /// # Errors
    /// [`Error::Refused`] as [`Question::plane_problem`], with `E-usage` where the third parameter is on an axis, `E-value`
    /// where a slice is not in its domain, `E-function` for loops whose maps are made of boxes. A budget that runs out
    /// ends the answer early and is told in it.
    ///
    /// # Panics
    /// Unless two parameters are free and `narrow` is positive.
    pub fn body(
        self,
        slices: &SliceValues,
        narrow: &Rational,
        digits: usize,
        budget: &Budget,
    ) -> Result<Answer<Body>, Error> {
        assert!(narrow.sign().is_gt(), "no bracket becomes narrower than 0");
        let problem = self.clone().body_problem(slices)?;
        let asked = Asked { question: self, name: slices.name(), digits, budget: budget.share(MAPS.0, MAPS.1) };
        let slices = asked.slices(slices.values(), budget)?;
        let extremes = budget.enter(|| Extremes::of(&slices));
        let stretches = asked.stretches(&slices, narrow, budget)?;
        let body = Body { slices, extremes, stretches, narrow: narrow.clone() };
        Ok(Answer::new(problem, body))
    }

    /// The problem of slices: three parameters are free, the third last.
    ///
    /// # Errors
    /// As [`Question::problem`]; `E-usage` where a name is on two axes; `E-value` where a slice is not in the domain of its
    /// parameter.
    ///
    /// # Panics
    /// Unless two other parameters are free.
    pub fn body_problem(self, slices: &SliceValues) -> Result<Arc<Problem>, Error> {
        let (third, names) = (slices.name(), self.free_names());
        let twice = names.iter().find(|name| *name == third || names.iter().filter(|other| other == name).count() > 1);
        if let Some(name) = twice {
            return Err(Diagnostic::error(Code::Usage, format!("'{name}' is asked for on two axes"))
                .help("name three different parameters with '-x', '-y' and '-z'")
                .into());
        }
        let problem = self.free(third).problem()?;
        assert_eq!(problem.free().len(), 3, "two parameters are free beside that of the slices");
        let (domain, closed) = (&problem.free()[2].domain, problem.free()[2].closed);
        let is_end = |value: &Rational| {
            (closed[0] && domain.lower.as_ref() == Some(value)) || (closed[1] && domain.upper.as_ref() == Some(value))
        };
        match slices.values().iter().find(|value| !domain.contains(value) && !is_end(value)) {
            None => Ok(problem),
            Some(value) => {
                let text = range_text(third, domain, [false; 2], Rational::to_string);
                let message = format!("the slice at {third} = {value} is outside the domain, {text}");
                let help =
                    format!("both ends are slices: begin and end inside, or change the domain: '--domain {third}=..'");
                Err(Diagnostic::error(Code::Value, message).help(help).into())
            }
        }
    }
}

/// What is asked at each value of the third parameter.
struct Asked<'a> {
    question: Question,
    name: &'a str,
    digits: usize,
    /// For the maps.
    budget: Budget,
}

impl Asked<'_> {
    fn problem(&self, value: &Rational) -> Result<Arc<Problem>, Error> {
        self.question.clone().set(self.name, value.clone()).plane_problem()
    }

    /// The slices; what is refused of one is refused of all.
    fn slices(&self, values: &[Rational], told: &Budget) -> Result<Vec<BodySlice>, Error> {
        told.step("slices");
        let done = AtomicU64::new(0);
        let found: Vec<Result<BodySlice, Error>> = parallel_map(values, |value| {
            let slice = self.slice(value);
            if slice.as_ref().is_ok_and(|slice| slice.map.is_ok()) {
                told.advance(done.fetch_add(1, Ordering::Relaxed) + 1, values.len() as u64);
            }
            slice
        });
        found.into_iter().collect()
    }

    fn slice(&self, value: &Rational) -> Result<BodySlice, Error> {
        let budget = self.budget.silent();
        let open = |stopped| BodySlice { value: value.clone(), map: Err(stopped), extent: None };
        let problem = self.problem(value)?;
        let map = problem.map(self.digits, &budget).map_err(|error| self.by_boxes(error, &problem, value));
        let found = map.and_then(|map| {
            let extent = budget.enter(|| extent::of_regions(&map.value().decomposition.regions))?;
            Ok(BodySlice { value: value.clone(), map: Ok(map), extent })
        });
        match found {
            Err(failure) => failure.stopped().map(open),
            found => found,
        }
    }

    /// Whether there are stable points at a value.
    fn has_stable_points(&self, value: &Rational) -> Result<bool, Error> {
        let budget = self.budget.silent();
        let problem = self.problem(value)?;
        let map = budget.enter(|| problem.decomposed(&budget))??;
        Ok(!map.regions.is_empty())
    }

    /// What to do where a map is made of boxes; other refusals stay as they are.
    fn by_boxes(&self, error: Error, problem: &Problem, value: &Rational) -> Error {
        let (Error::Refused(_), [x, y]) = (&error, self.question.free_names()) else { return error };
        let Ok(ring) = problem.coefficient_ring(&self.budget) else { return error };
        if !matches!(coverage::Asked::BoxMap.over(ring), Coverage::ByBoxes(_)) {
            return error;
        }
        let Coverage::Refused(refusal) = coverage::Asked::Slices.over(ring) else { return error };
        let slice = format!("map -x {x}=LO..HI -y {y}=LO..HI --set {}={value}", self.name);
        refusal.diagnostic(&[("slice", &slice)]).into()
    }
}

#[cfg(test)]
mod tests;
