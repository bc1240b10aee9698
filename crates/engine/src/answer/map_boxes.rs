//! The stable region in two parameters by boxes, and the choice between that and the exact decomposition.

use super::{Answer, Map};
use crate::error::{Diagnostic, Error};
use crate::problem::Problem;
use crate::stability::Range;
use crate::stability::plane::boxes::{BoxMap, Window, stability_boxes};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// The part of the time that boxes may take, so that some is left to write them.
const SUBDIVISION: (u32, u32) = (9, 10);

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
    /// window is bounded.
    #[default]
    Auto,
}

/// What the boxes are to cover, and how well.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_engine::answer::{BoxRequest, MapMethod};
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
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
    /// far from the nominal value as the other one, or as 0.
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
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes};
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
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
}

/// A map by either method.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes};
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
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

impl Problem {
    /// Whether a map by this method comes to boxes at last, when the exact decomposition takes too long.
    pub fn ends_in_boxes(&self, method: MapMethod, request: &BoxRequest) -> bool {
        method != MapMethod::Exact && window_of(self, request).is_ok()
    }

    /// The stable region in the plane of the two free parameters by a method of choice.
    ///
    /// Loops with dead time or with other functions, as behind a hold, have boxes only.
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
            let exact = |part: &Budget| {
                let map = self.described(part.enter(|| self.decomposed(part))??, digits, budget)?;
                Ok(MapOrBoxes::Exact(Box::new(map)))
            };
            let share = || budget.share(SUBDIVISION.0, SUBDIVISION.1);
            let found = |boxes: BoxMap| {
                let value = MapBoxes { goal: request.undecided.clone(), boxes };
                MapOrBoxes::Boxes(Box::new(Answer::new(Arc::clone(self), value)))
            };
            if method != MapMethod::Exact {
                let share = share();
                if let Some(plane) = self.delayed_plane(budget)? {
                    return Ok(found(plane.boxes(&window_around(self, request)?, &request.undecided, &share)?));
                }
                if let Some(plane) = self.symbolic_plane(budget)? {
                    return Ok(found(plane.boxes(&window_around(self, request)?, &request.undecided, &share)?));
                }
            }
            let window = match (method, window_of(self, request)) {
                (MapMethod::Exact, _) => return exact(budget),
                (MapMethod::Boxes, Err(refusal)) => return Err(refusal),
                (_, window) => window,
            };
            let plane = self.plane(budget)?;
            let (Ok(window), Some(p)) = (window, plane) else {
                // Without a window, or undefined everywhere: that needs no boxes.
                return exact(budget);
            };
            if method == MapMethod::Auto {
                match exact(&budget.share(1, 2)) {
                    Err(Error::Stopped(_)) => {}
                    answered => return answered,
                }
            }
            Ok(found(stability_boxes(p, &window, self.shape(), &request.undecided, &share())?))
        })?
    }
}

/// [`window_of`], where there is nothing but boxes: a side without an end reaches as far from the nominal value as the other end, or 0, or one.
fn window_around(question: &Problem, request: &BoxRequest) -> Result<Window, Error> {
    let mut wanted = request.clone();
    for (range, axis) in wanted.windows.iter_mut().zip(question.free()) {
        let lower = range.lower.clone().max(axis.domain.lower.clone());
        let upper = range.upper.iter().chain(&axis.domain.upper).min().cloned();
        let Some(nominal) = &axis.nominal else { continue };
        let reach = match (&lower, &upper) {
            (Some(lower), None) => nominal - lower,
            (None, Some(upper)) => upper - nominal,
            _ => nominal.abs(),
        };
        let reach = if reach.sign().is_gt() { reach } else { Rational::ONE };
        range.lower = Some(lower.unwrap_or_else(|| nominal - &reach));
        range.upper = Some(upper.unwrap_or_else(|| nominal + &reach));
    }
    window_of(question, &wanted)
}

/// The part of the domain that the boxes are to cover.
fn window_of(question: &Problem, request: &BoxRequest) -> Result<Window, Error> {
    let side = |k: usize| {
        let (domain, wanted) = (&question.free()[k].domain, &request.windows[k]);
        let lower = wanted.lower.clone().max(domain.lower.clone());
        let upper = match (&wanted.upper, &domain.upper) {
            (Some(a), Some(b)) => Some(a.min(b).clone()),
            (a, b) => a.clone().or_else(|| b.clone()),
        };
        Range::between(lower, upper)
    };
    let sides = [side(0), side(1)];
    for (range, axis) in sides.iter().zip(question.free()) {
        if range.lower.is_none() || range.upper.is_none() {
            return Err(Diagnostic::error("E-usage", format!("boxes need a window of '{}' with two ends", axis.name))
                .help(format!("say which values are to be covered, such as '-x {}=0..1'", axis.name))
                .into());
        }
        if range.is_empty() {
            return Err(Diagnostic::error(
                "E-empty-domain",
                format!("the window of '{}' is outside its domain", axis.name),
            )
            .help("boxes cover the part of the window that is in the domain")
            .into());
        }
    }
    Ok(Window::new(&sides[0], &sides[1]).expect("both sides are bounded and not empty"))
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_held;
