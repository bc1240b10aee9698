//! A map of two parameters for all values of others in given ranges: a point belongs to it where the loop is stable, or meets what is required, for
//! every one of these values.
//!
//! A box of the plane is proved where parts that cover the ranges are, each together with the box. It is refuted where one part is refuted as a
//! whole, such as a single value of each of the others. The parts that are proved of a box are so of its halves, which look at the rest.

use super::required_boxes::RequiredBoxes;
use super::requirement::Requirement;
use super::requirement_boxes::{OverPoints, RequirementBoxes};
use crate::answer::{Answer, BoxRequest, MapBoxes};
use crate::coverage::refusals::{COMPLEX_FOR_ALL, NOT_FOR_ALL};
use crate::error::{Code, Diagnostic, Error};
use crate::problem::{Problem, Question};
use crate::stability::Range;
use crate::stability::plane::boxes::{BoxVerdict, Place, Window, boxes_of, refined};
use crate::stability::subdivision::{BoxPart, Halves, Look};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// More names than this have no ranges: each has two ends that are looked at with those of the others.
pub const MOST_RANGES: usize = 4;

/// The ranges are halved so much oftener than the sides of a box, each.
const FINER: u32 = 3;

/// A box with more open parts is halved first.
const MOST_PARTS: usize = 512;

/// Of the time, the part that stability may take where requirements follow.
const STABILITY: (u32, u32) = (1, 2);

/// A name and the closed range of its values, for all of which something is to hold.
///
/// ```
/// use jurist_engine::response::AllOf;
/// let all = AllOf::new("L", 0.into(), 1.into()).unwrap();
/// assert_eq!((all.name.as_str(), &all.range[1]), ("L", &1.into()));
/// assert!(AllOf::new("L", 1.into(), 1.into()).is_none());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AllOf {
    /// The name.
    pub name: String,
    /// The least and the greatest value.
    pub range: [Rational; 2],
}

impl AllOf {
    /// `None` where the least value is not below the greatest.
    pub fn new(name: impl Into<String>, least: Rational, greatest: Rational) -> Option<AllOf> {
        (least < greatest).then(|| AllOf { name: name.into(), range: [least, greatest] })
    }

    /// That the range lies in the domain of its name, which is free.
    pub(crate) fn inside_domain(&self, problem: &Problem) -> Result<(), Error> {
        let own = problem.free().iter().find(|free| free.name == self.name).expect("it is free");
        let Range { lower, upper } = &own.domain;
        let is_outside = lower.as_ref().is_some_and(|end| self.range[0] < *end)
            || upper.as_ref().is_some_and(|end| self.range[1] > *end);
        if is_outside {
            let message = format!("the range of '{}' reaches beyond its domain", self.name);
            return Err(Diagnostic::error(Code::EmptyDomain, message)
                .help("a range for all values lies in the domain that the model declares")
                .into());
        }
        Ok(())
    }
}

/// What is to hold for all values of some names.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct MapForAll {
    /// The names with their ranges.
    pub all: Vec<AllOf>,
    /// What is required beside stability.
    pub requirements: Vec<Requirement>,
    /// Where margins are taken.
    pub at: Option<String>,
}

impl MapForAll {
    /// Stability for all values of these names.
    pub fn new(all: Vec<AllOf>) -> MapForAll {
        MapForAll { all, requirements: Vec::new(), at: None }
    }

    /// Requirements as well, margins being taken at a cut.
    pub fn with_requirements(self, requirements: Vec<Requirement>, at: Option<String>) -> MapForAll {
        MapForAll { requirements, at, ..self }
    }

    /// The boxes of a window of the two free names of a question.
    ///
    /// Cost: that of a look at each of about `1/h` boxes of side `h` along each boundary, times the parts of the ranges that are not decided with
    /// larger boxes.
    ///
    /// # Errors
    /// [`Error::Refused`] for a loop with complex coefficients, for a window without ends, for ranges outside of what the model allows, and for
    /// requirements that boxes do not decide; [`Error::Stopped`] when the budget runs out before anything was cut.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::answer::BoxRequest;
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::response::{AllOf, MapForAll};
    /// use jurist_engine::stability::Range;
    /// // s^2 + a s + b - c is stable where a > 0 and b > c.
    /// let text = "time = 'continuous'\nparameters = { a = 1, b = 2, c = 0 }\nloop.characteristic = 's^2 + a*s + b - c'\n";
    /// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
    /// let side = Range::between(Some((-1).into()), Some(3.into()));
    /// let request = BoxRequest::new([side.clone(), side], "1/20".parse()?);
    /// let for_all = MapForAll::new(vec![AllOf::new("c", 0.into(), 1.into()).unwrap()]);
    /// let map = for_all.boxes(model.ask().free("a").free("b"), &request, &Budget::unlimited())?;
    /// // For every c up to 1: b > 1, so that the area is 3 times 2.
    /// let areas = &map.value().boxes.areas;
    /// assert!(areas.stable <= 6.into() && &areas.stable + &areas.undecided >= 6.into());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn boxes(&self, question: Question, request: &BoxRequest, budget: &Budget) -> Result<Answer<MapBoxes>, Error> {
        // For the window alone the other names have some value.
        let middle = |all: &AllOf| (all.name.clone(), all.range[0].midpoint(&all.range[1]));
        let plane = question.clone().set_all(self.all.iter().map(middle)).plane_problem()?;
        match plane.refuse_complex(budget) {
            Err(Error::Refused(_)) => return Err(COMPLEX_FOR_ALL.diagnostic(&[]).into()),
            known => known?,
        }
        let together = self.together(question)?;
        let window = plane.in_boxes(budget)?.window(request, budget)?;
        let middles = [&window.x, &window.y].map(|[low, high]| low.midpoint(high)).into();
        let (stability, requirements) = self.tests(&together, middles, budget)?;
        let part = if requirements.is_empty() { budget.clone() } else { budget.share(STABILITY.0, STABILITY.1) };
        let first = self.parts(&stability);
        let boxes = boxes_of(&window, &request.undecided, first, &part, |place, open| {
            Ok(match self.look(&stability, &sides_of(place, &window), open, &part)? {
                Some(None) => Look::Decided(BoxVerdict::Stable),
                Some(Some(_)) => Look::Decided(BoxVerdict::Unstable { outside: None }),
                None => Look::Cut(place.wider()),
            })
        });
        let stable = boxes.boxes.iter().filter(|b| b.verdict == BoxVerdict::Stable).map(|b| b.window.clone());
        let required = (!requirements.is_empty()).then(|| {
            budget.step("requirements in the stable boxes");
            let stable: Vec<Window> = stable.collect();
            let first = self.parts(&requirements);
            let found = refined(&window, &stable, first, &request.undecided, budget, |place, open| {
                let seen = self.look(&requirements, &sides_of(place, &window), open, budget)?;
                Ok(seen.map_or(Look::Cut(place.wider()), Look::Decided))
            });
            RequiredBoxes::new(&self.requirements, self.at.as_deref(), found)
        });
        let value = MapBoxes {
            goal: request.undecided.clone(),
            boxes,
            no_exact_map: None,
            required,
            for_all: self.all.clone(),
        };
        Ok(Answer::new(plane.without_values_of(|name| self.all.iter().any(|all| all.name == name)), value))
    }

    /// The tests of stability and of each requirement over boxes of all names, made for points near to this one of the axes and the middles of the ranges.
    pub(super) fn tests(
        &self,
        together: &Arc<Problem>,
        mut near: Vec<Rational>,
        budget: &Budget,
    ) -> Result<([RequirementBoxes; 1], Vec<RequirementBoxes>), Error> {
        near.extend(self.all.iter().map(|all| all.range[0].midpoint(&all.range[1])));
        budget.step("coefficients over the window and the ranges");
        let stability = RequirementBoxes::of_stability(together, &near, budget)?;
        let stability =
            [stability.ok_or_else(|| Error::Undefined("the loop has no characteristic function".to_owned()))?];
        let requirement = |r: &Requirement| {
            let found = RequirementBoxes::of(together, r, self.at.as_deref(), &near, budget)?;
            found.ok_or_else(|| NOT_FOR_ALL.diagnostic(&[("name", r.name())]).into())
        };
        let requirements = self.requirements.iter().map(requirement).collect::<Result<Vec<_>, Error>>()?;
        Ok((stability, requirements))
    }

    /// The question in which all names are free.
    pub(super) fn together(&self, question: Question) -> Result<Arc<Problem>, Error> {
        if self.all.len() > MOST_RANGES {
            let message = format!("'for all' takes up to {MOST_RANGES} names");
            return Err(Diagnostic::error(Code::Usage, message).help("give the others values, with '--set'").into());
        }
        let free = |question: Question, all: &AllOf| question.free(&all.name);
        let problem = self.all.iter().fold(question, free).problem()?;
        self.all.iter().try_for_each(|all| all.inside_domain(&problem))?;
        Ok(problem)
    }

    /// The parts that a whole window is looked at with: the corners of the ranges, then all of them.
    pub(super) fn parts(&self, tests: &[RequirementBoxes]) -> Vec<OpenPart> {
        let corners = (0..1usize << self.all.len()).map(|corner| {
            let side = |(k, all): (usize, &AllOf)| {
                let end = &all.range[corner >> k & 1];
                [end.clone(), end.clone()]
            };
            self.all.iter().enumerate().map(side).collect::<Vec<_>>()
        });
        let whole = self.all.iter().map(|all| all.range.clone()).collect();
        let parts: Vec<BoxPart> = corners.chain([whole]).map(BoxPart::whole).collect();
        let of = |test: usize| parts.iter().cloned().map(move |part| OpenPart { test, part });
        (0..tests.len()).flat_map(of).collect()
    }

    /// Whether a box of the axes is decided: the number of a test that it does not pass for some values, or none where it passes all for all values. What is
    /// decided leaves the list.
    pub(super) fn look(
        &self,
        tests: &[RequirementBoxes],
        (axes, halvings): &(Vec<[Rational; 2]>, u32),
        open: &mut Vec<OpenPart>,
        budget: &Budget,
    ) -> Result<Option<Option<usize>>, Exhausted> {
        let most = halvings + FINER;
        let (mut waiting, mut rest) = (std::mem::take(open), Vec::new());
        waiting.reverse();
        while let Some(OpenPart { test, part }) = waiting.pop() {
            budget.check()?;
            let sides: Vec<[Rational; 2]> = axes.iter().cloned().chain(part.sides.clone()).collect();
            match tests[test].short_look(&sides, budget)? {
                OverPoints::All => continue,
                OverPoints::None => return Ok(Some(Some(test))),
                OverPoints::Open { .. } => {}
            }
            let is_wide = |axis: &usize| part.sides[*axis][0] < part.sides[*axis][1] && part.halvings[*axis] < most;
            let axis = (0..part.sides.len()).filter(is_wide).min_by_key(|&axis| part.halvings[axis]);
            let Some(axis) = axis.filter(|_| waiting.len() + rest.len() < MOST_PARTS) else {
                rest.push(OpenPart { test, part });
                continue;
            };
            let pinned = part.sides.iter().map(|[low, high]| [low.midpoint(high), low.midpoint(high)]);
            let pinned: Vec<[Rational; 2]> = axes.iter().cloned().chain(pinned).collect();
            match tests[test].short_look(&pinned, budget)? {
                OverPoints::None => return Ok(Some(Some(test))),
                // With single values the box is open as well: it is the one to be halved.
                OverPoints::Open { .. } => rest.push(OpenPart { test, part }),
                OverPoints::All => {
                    let [low, high] = part.halves(axis);
                    waiting.extend([high, low].map(|part| OpenPart { test, part }));
                }
            }
        }
        *open = rest;
        Ok(open.is_empty().then_some(None))
    }
}

/// The sides of a box of the plane, and how often the window was halved for it.
fn sides_of(place: &Place, window: &Window) -> (Vec<[Rational; 2]>, u32) {
    let Window { x, y } = place.window(window);
    (vec![x, y], place.halvings[0].max(place.halvings[1]))
}

/// A part of the ranges. For its values and the points of a box the test is not decided.
#[derive(Clone, Debug)]
pub(super) struct OpenPart {
    /// The number of the test.
    test: usize,
    part: BoxPart,
}

impl OpenPart {
    /// The values.
    pub(super) fn sides(&self) -> &[[Rational; 2]] {
        &self.part.sides
    }
}
