//! The stable region in two parameters by boxes, and the choice between that and the exact decomposition.

use super::{Answer, Map};
use crate::coverage::{Asked, CoefficientRing};
use crate::error::Error;
use crate::problem::Problem;
use crate::response::{AllOf, RequiredBoxes, Requirement};
use crate::stability::Range;
use crate::stability::plane::boxes::{BoxMap, BoxVerdict, Window, stability_boxes};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::Rational;
use std::sync::Arc;
use window::{window_around, window_of};

/// The part of the time that boxes may take, so that some is left to write them.
const SUBDIVISION: (u32, u32) = (9, 10);

/// An exact map over symbols is tried first where the curve of complex pairs has no more terms. Up to here it takes some ten seconds at
/// most (4400 terms: the drive of `examples/drive-hold.toml`), beyond soon minutes.
const MOST_TERMS: u64 = 6000;

/// The same beside requirements, whose curves are longer.
const MOST_TERMS_WITH_REQUIREMENTS: u64 = 400;

/// How a map is made.
///
/// ```
/// use jurist_engine::answer::MapMethod;
/// assert_eq!(MapMethod::default(), MapMethod::Auto);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum MapMethod {
    /// The exact decomposition of the whole domain.
    Exact,
    /// Boxes of a window, proved stable, proved unstable or left undecided.
    Boxes,
    /// The exact decomposition; boxes when it is not finished after half of a limited time and the
    /// window is bounded, and of a bounded window also where a loop over transcendental constants has a long boundary.
    #[default]
    Auto,
}

/// What the boxes are to cover, and how well.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_engine::answer::{BoxRequest, MapMethod};
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// use jurist_engine::stability::Range;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("a").nominal("0"))
///     .parameter(ParameterBuilder::new("b").nominal("0"))
///     .characteristic("z^2 + a*z + b")
///     .build()?;
/// let side = Range::between(Some((-3).into()), Some(3.into()));
/// let request = BoxRequest::new([side.clone(), side], Rational::new(1.into(), 4.into()));
/// let problem = model.ask().free("a").free("b").plane_problem()?;
/// assert!(problem.ends_in_boxes(MapMethod::Boxes, &request));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BoxRequest {
    /// Of either parameter; the domain is the window where an end is left out. Of a loop that has only boxes an end that neither says is as
    /// far from the nominal value as the other one, or as 0; an upper one farther, until the loop is unstable there, where it is soon.
    pub windows: [Range; 2],
    /// The share of the window's area that may stay undecided.
    pub undecided: Rational,
}

impl BoxRequest {
    /// Boxes of a window of which a share of the area may stay undecided.
    pub fn new(windows: [Range; 2], undecided: Rational) -> BoxRequest {
        BoxRequest { windows, undecided }
    }
}

/// A window of two parameters cut into boxes.
///
/// ```
/// use jurist_algebra::limits::{Budget, Exhausted, Stop};
/// use jurist_algebra::number::Rational;
/// use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes};
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// use jurist_engine::stability::Range;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("a").nominal("0"))
///     .parameter(ParameterBuilder::new("b").nominal("0"))
///     .characteristic("z^2 + a*z + b")
///     .build()?;
/// let side = Range::between(Some((-3).into()), Some(3.into()));
/// let request = BoxRequest::new([side.clone(), side], Rational::new(1.into(), 4.into()));
/// let problem = model.ask().free("a").free("b").plane_problem()?;
/// let map = problem.map_by(MapMethod::Boxes, &request, 6, &Budget::unlimited())?;
/// let MapOrBoxes::Boxes(answer) = map else { panic!("boxes were asked for") };
/// let (goal, areas) = (&answer.value().goal, &answer.value().boxes.areas);
/// assert_eq!(&areas.stable + &areas.unstable + &areas.undecided, 36.into());
/// assert!(areas.undecided <= goal * &Rational::from(36));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MapBoxes {
    /// The share of the window's area that was allowed to stay undecided.
    pub goal: Rational,
    /// The boxes.
    pub boxes: BoxMap,
    /// Why there is no exact map, where that was looked for first.
    pub no_exact_map: Option<Exhausted>,
    /// The stable boxes by whether requirements are met, where that was asked.
    pub required: Option<RequiredBoxes>,
    /// Names for all of whose values in these ranges it holds what is said of the boxes: a box that is not stable has, for each of its points,
    /// values for which the loop is not.
    pub for_all: Vec<AllOf>,
}

/// A map by either method.
///
/// ```
/// use jurist_algebra::limits::{Budget, Exhausted, Stop};
/// use jurist_algebra::number::Rational;
/// use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes};
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// use jurist_engine::stability::Range;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("a").nominal("0"))
///     .parameter(ParameterBuilder::new("b").nominal("0"))
///     .characteristic("z^2 + a*z + b")
///     .build()?;
/// let side = Range::between(Some((-3).into()), Some(3.into()));
/// let request = BoxRequest::new([side.clone(), side], Rational::new(1.into(), 4.into()));
/// let problem = model.ask().free("a").free("b").plane_problem()?;
/// let map = problem.map_by(MapMethod::Auto, &request, 6, &Budget::unlimited())?;
/// assert!(matches!(map, MapOrBoxes::Exact(_)), "there was time enough");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub enum MapOrBoxes {
    /// The exact decomposition.
    Exact(Box<Answer<Map>>),
    /// Boxes.
    Boxes(Box<Answer<MapBoxes>>),
}

impl MapBoxes {
    /// Why a subdivision, of the window or of its stable boxes, stopped before its goal: `None` when none did.
    pub fn stopped(&self) -> Option<&Stop> {
        self.boxes.stopped.as_ref().or_else(|| self.required.as_ref()?.stopped.as_ref())
    }
}

impl Problem {
    /// Whether a map by this method comes to boxes at last, when the exact decomposition takes too long.
    pub fn ends_in_boxes(&self, method: MapMethod, request: &BoxRequest) -> bool {
        method != MapMethod::Exact && window_of(self, request).is_ok()
    }

    /// The request with both ends of its windows: those that it leaves out are chosen around the nominal point, as they are of loops that have
    /// only boxes.
    ///
    /// Cost: a few verdicts.
    ///
    /// # Errors
    /// [`Error::Refused`] where a parameter has no nominal value, and outside of its domain; [`Error::Stopped`] when the budget runs out.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::answer::BoxRequest;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::stability::Range;
    /// let problem = Model::drive().ask().free("K_pwm").free("T").plane_problem()?;
    /// let request = BoxRequest::new([Range::all(), Range::all()], "1/20".parse()?);
    /// let around = problem.around_nominal(&request, &Budget::unlimited())?;
    /// // It is stable to 550.94 V.
    /// assert_eq!(around.windows[0], Range::between(Some(0.into()), Some(990.into())));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn around_nominal(&self, request: &BoxRequest, budget: &Budget) -> Result<BoxRequest, Error> {
        let Window { x, y } = budget.enter(|| window_around(self, request, budget))??;
        let side = |[lower, upper]: [Rational; 2]| Range::between(Some(lower), Some(upper));
        Ok(BoxRequest::new([side(x), side(y)], request.undecided.clone()))
    }

    /// The stable region in the plane of the two free parameters by a method of choice.
    ///
    /// Loops with dead time, and those with functions, as behind a hold, that one of the parameters is inside of, have boxes only.
    ///
    /// Cost: of the exact decomposition that of [`Problem::map`]; of boxes
    /// ([ZettlerGarloff1998](jurist_algebra::bibliography#zettlergarloff1998)) about `1/h` of side `h` along each
    /// boundary curve, halved at the product of the curve's degrees times their sum.
    ///
    /// # Errors
    /// [`Error::Refused`] for boxes of a window that is not bounded, [`Error::Stopped`] when the budget runs out.
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn map_by(
        self: &Arc<Self>,
        method: MapMethod,
        request: &BoxRequest,
        digits: usize,
        budget: &Budget,
    ) -> Result<MapOrBoxes, Error> {
        budget.enter(|| {
            let exact = |part: &Budget| -> Result<MapOrBoxes, Error> {
                let map = self.described(part.enter(|| self.decomposed(part))??, digits, budget)?;
                Ok(MapOrBoxes::Exact(Box::new(map)))
            };
            if method == MapMethod::Exact {
                return exact(budget);
            }
            let in_boxes = self.in_boxes(budget)?;
            if !Arc::ptr_eq(self, &in_boxes) {
                return self.boxes_by_values(&in_boxes, request, budget);
            }
            let ring = self.coefficient_ring(budget)?;
            let is_exact = Asked::ExactMap.over(ring).is_answered();
            let window = self.window_over(ring, request, budget);
            // A rational loop that is undefined everywhere needs no boxes.
            let has_boxes = window.is_ok() && (ring != CoefficientRing::Rational || self.plane(budget)?.is_some());
            let mut no_exact_map = None;
            if method == MapMethod::Auto && is_exact {
                // Without boxes there is nothing to leave time for.
                let part = if has_boxes { &budget.share(1, 2) } else { budget };
                match self.worth_an_exact_map(ring, has_boxes, budget)?.and_then(|()| exact(part)) {
                    Err(Error::Stopped(stopped)) if has_boxes => no_exact_map = Some(stopped),
                    answered => return answered,
                }
            }
            if is_exact && window.is_ok() && !has_boxes {
                return exact(budget);
            }
            let boxes = self.boxes_over(ring, window, &request.undecided, budget)?;
            let value =
                MapBoxes { goal: request.undecided.clone(), boxes, no_exact_map, required: None, for_all: Vec::new() };
            Ok(MapOrBoxes::Boxes(Box::new(Answer::new(Arc::clone(self), value))))
        })?
    }

    /// Boxes where no exact map is looked for: of the coefficients nothing but values is known.
    fn boxes_by_values(
        self: &Arc<Self>,
        in_boxes: &Problem,
        request: &BoxRequest,
        budget: &Budget,
    ) -> Result<MapOrBoxes, Error> {
        let ring = in_boxes.coefficient_ring(budget)?;
        let window = self.window_over(ring, request, budget);
        let boxes = in_boxes.boxes_over(ring, window, &request.undecided, budget)?;
        let (goal, no_exact_map) = (request.undecided.clone(), None);
        let value = MapBoxes { goal, boxes, no_exact_map, required: None, for_all: Vec::new() };
        Ok(MapOrBoxes::Boxes(Box::new(Answer::new(Arc::clone(self), value))))
    }

    /// The stable region with the parts of it in which requirements are met, margins being taken at a cut; the exact one where that is known
    /// soon, unless a method is asked for.
    ///
    /// Cost: that of [`Problem::map_by`], and of [`Answer::<Map>::with_requirements`] or [`Answer::<MapBoxes>::with_requirements`].
    ///
    /// # Errors
    /// As these.
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn required_map_by(
        self: &Arc<Self>,
        (method, request): (MapMethod, &BoxRequest),
        (requirements, at): (&[Requirement], Option<&str>),
        digits: usize,
        budget: &Budget,
    ) -> Result<MapOrBoxes, Error> {
        if !requirements.is_empty() && self.map_ring(budget)? == CoefficientRing::VaryingOrder {
            // It has maps, but no requirements on them: its algebra says where the order varies.
            self.algebra_over_symbols(budget)?;
        }
        let by = |method: MapMethod, budget: &Budget| match self.map_by(method, request, digits, budget)? {
            found if requirements.is_empty() => Ok(found),
            MapOrBoxes::Exact(map) => {
                map.with_requirements(requirements, at, budget).map(Box::new).map(MapOrBoxes::Exact)
            }
            MapOrBoxes::Boxes(boxes) => {
                boxes.with_requirements(requirements, at, budget).map(Box::new).map(MapOrBoxes::Boxes)
            }
        };
        if method != MapMethod::Auto || requirements.is_empty() {
            return by(method, budget);
        }
        let ring = self.map_ring(budget)?;
        let is_of_boxes = requirements.iter().any(|one| one.has_no_curve(self.time()));
        let has_exact = Asked::ExactMap.over(ring).is_answered() && !is_of_boxes;
        let has_boxes = self.window_over(ring, request, budget).is_ok();
        let is_short = match ring {
            CoefficientRing::Constants => {
                self.plane_over_symbols(budget)?.map_or(0, |p| p.size(self.shape())) <= MOST_TERMS_WITH_REQUIREMENTS
            }
            _ => true,
        };
        match (has_exact && is_short, has_boxes) {
            (true, true) => match by(MapMethod::Exact, &budget.share(1, 2)) {
                Err(Error::Stopped(_)) => by(MapMethod::Boxes, budget),
                answered => answered,
            },
            (false, true) => by(MapMethod::Boxes, budget),
            (_, false) if has_exact => by(MapMethod::Exact, budget),
            (_, false) => by(MapMethod::Boxes, budget),
        }
    }

    /// The ring of the coefficients that a map is made with: functions, where exact polynomials would be long and coefficients are known by their values.
    ///
    /// Cost: that of [`Problem::coefficient_ring`]; of a loop behind holds that of a counted trial of exact polynomials.
    ///
    /// # Errors
    /// As [`Problem::coefficient_ring`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::coverage::CoefficientRing;
    /// use jurist_engine::model::LoopLine;
    /// use jurist_engine::problem::Ask;
    /// let (model, _) = LoopLine::read("K*(s + b)/(s*(s + a))", Some("1"), None)?.model()?;
    /// // Behind a hold: the plant's pole is inside of an exponential, its gain and its zero are not.
    /// let gain_and_zero = model.ask().set("a", 1).free("K").free("b").problem()?;
    /// assert_eq!(gain_and_zero.map_ring(&Budget::unlimited())?, CoefficientRing::Constants);
    /// let gain_and_pole = model.ask().set("b", 1).free("K").free("a").problem()?;
    /// assert_eq!(gain_and_pole.map_ring(&Budget::unlimited())?, CoefficientRing::Functions);
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    pub fn map_ring(self: &Arc<Self>, budget: &Budget) -> Result<CoefficientRing, Error> {
        self.in_boxes(budget)?.coefficient_ring(budget)
    }

    /// What boxes are to cover: of a loop that has an exact map no end is chosen.
    pub(crate) fn window(&self, request: &BoxRequest, budget: &Budget) -> Result<Window, Error> {
        budget.enter(|| self.window_over(self.coefficient_ring(budget)?, request, budget))?
    }

    fn window_over(&self, ring: CoefficientRing, request: &BoxRequest, budget: &Budget) -> Result<Window, Error> {
        match ring {
            CoefficientRing::Rational => window_of(self, request),
            _ => window_around(self, request, budget),
        }
    }

    /// The inner result is an error where an exact map would take long, and there are boxes.
    fn worth_an_exact_map(
        &self,
        ring: CoefficientRing,
        has_boxes: bool,
        budget: &Budget,
    ) -> Result<Result<(), Error>, Error> {
        if ring != CoefficientRing::Constants || !has_boxes {
            return Ok(Ok(()));
        }
        let size = self.plane_over_symbols(budget)?.map_or(0, |p| p.size(self.shape()));
        Ok(if size > MOST_TERMS { Err(too_long(size).into()) } else { Ok(()) })
    }

    /// The boxes of a window, by the family of loops over the ring.
    fn boxes_over(
        &self,
        ring: CoefficientRing,
        window: Result<Window, Error>,
        goal: &Rational,
        budget: &Budget,
    ) -> Result<BoxMap, Error> {
        let mut found = self.boxes_of_family_over(ring, window, goal, budget)?;
        if self.is_complex() {
            // Each root was counted with its conjugate.
            for one in &mut found.boxes {
                if let BoxVerdict::Unstable { outside: Some(outside) } = &mut one.verdict {
                    *outside /= 2;
                }
            }
        }
        Ok(found)
    }

    fn boxes_of_family_over(
        &self,
        ring: CoefficientRing,
        window: Result<Window, Error>,
        goal: &Rational,
        budget: &Budget,
    ) -> Result<BoxMap, Error> {
        let share = || budget.share(SUBDIVISION.0, SUBDIVISION.1);
        match ring {
            CoefficientRing::Rational => {
                let (window, plane) = (window?, self.plane(budget)?.expect("defined somewhere"));
                Ok(stability_boxes(plane, &window, self.shape(), goal, &share())?)
            }
            CoefficientRing::Constants => {
                let plane = self.symbolic_plane(budget)?.expect("a loop over constants");
                Ok(plane.boxes(&window?, goal, &share())?)
            }
            CoefficientRing::Functions => {
                let family = self.moving_family(budget)?.expect("a loop with functions");
                let window = window?;
                let is_of_values = self.algebra_over_symbols(budget)?.symbols().has_families();
                if family.is_inside_of_both() || is_of_values {
                    return Ok(family.boxes(&window, goal, &share(), |_| None));
                }
                let plane = self.symbolic_plane(budget)?.expect("one parameter is inside of functions");
                Ok(family.boxes(&window, goal, &share(), plane.at_lower_end(&window)))
            }
            CoefficientRing::DeadTimeBesideConstants => self.boxes_of_family(&window?, goal, budget),
            CoefficientRing::DeadTime if self.region().decay().is_some() => {
                self.boxes_of_family(&window?, goal, budget)
            }
            CoefficientRing::VaryingOrder => {
                let window = window?;
                let parts = self.parts_by_samples(&window, budget)?;
                let count = parts.len();
                let boxes = |(k, (window, part)): (usize, (Window, Problem))| {
                    // What is left is for this part and all behind it.
                    let own = budget.share(1, (count - k) as u32);
                    part.boxes_over(part.coefficient_ring(&own)?, Ok(window), goal, &own)
                };
                let boxes = parts.into_iter().enumerate().map(boxes).collect::<Result<Vec<_>, _>>()?;
                Ok(BoxMap::joined(window, boxes))
            }
            CoefficientRing::DeadTime | CoefficientRing::DeadTimeBesideFunctions => {
                let plane = self.delayed_plane(budget)?.expect("a loop with dead time");
                Ok(plane.boxes(&window?, goal, &share())?)
            }
        }
    }

    /// The boxes of a loop with dead time beside constants, or factors of a decay rate, that are known by bounds.
    fn boxes_of_family(&self, window: &Window, goal: &Rational, budget: &Budget) -> Result<BoxMap, Error> {
        let middle = [&window.x, &window.y].map(|[low, high]| low.midpoint(high));
        Ok(match self.delayed_family_in_region(&middle, budget)? {
            Some((family, bounds)) => family.boxes(window, &bounds, goal, &budget.share(SUBDIVISION.0, SUBDIVISION.1)),
            None => BoxMap::nowhere_stable(window),
        })
    }
}

fn too_long(terms: u64) -> Exhausted {
    let reached = format!("the curve of complex pairs, with up to {terms} terms in the parameters and the constants");
    Exhausted::by_method(format!("terms of a map by '--method auto' ({MOST_TERMS})"), reached)
}

mod window;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_held;
