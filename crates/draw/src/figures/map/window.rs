//! Which part of the plane is shown, and on what scales.

use super::super::axes::{Axis, Scale};
use super::super::engineering::unit_text;
use super::trace::approximate_real;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::{Answer, Map};
use jurist_engine::problem::Free;
use jurist_engine::stability::{Range, RealInterval};
use jurist_show::layout::visible;

/// A positive range of values is drawn on a logarithmic axis from this ratio on.
const LOGARITHMIC_RATIO: f64 = 100.0;

/// One axis of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisWindow {
    /// The left or lower end.
    pub lower: Rational,
    /// The right or upper end.
    pub upper: Rational,
    /// Whether the axis is logarithmic; both ends are positive then.
    pub logarithmic: bool,
}

/// What is asked of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WindowRequest {
    /// The lower end, if it is not to be chosen.
    pub lower: Option<Rational>,
    /// The upper end, if it is not to be chosen.
    pub upper: Option<Rational>,
    /// Logarithmic, linear, or to be chosen.
    pub logarithmic: Option<bool>,
}

impl AxisWindow {
    /// Where a value is: 0 at the lower end, 1 at the upper end; minus infinity for what a logarithm has not.
    pub fn place(&self, value: f64) -> f64 {
        let (lo, hi) = self.ends();
        if self.logarithmic {
            if value <= 0.0 { f64::NEG_INFINITY } else { (value / lo).ln() / (hi / lo).ln() }
        } else {
            (value - lo) / (hi - lo)
        }
    }

    /// The value at a place.
    pub fn value(&self, place: f64) -> f64 {
        let (lo, hi) = self.ends();
        if self.logarithmic { lo * (hi / lo).powf(place) } else { lo + (hi - lo) * place }
    }

    /// The axis of a parameter over this window.
    pub(super) fn axis(&self, free: &Free) -> Axis {
        let unit = unit_text(&visible(free.unit.as_deref().unwrap_or_default()));
        let scale = if self.logarithmic { Scale::Logarithmic } else { Scale::Linear };
        Axis { name: free.name.clone(), unit, range: self.ends(), scale }
    }

    /// Both ends in floating point.
    pub fn ends(&self) -> (f64, f64) {
        (self.lower.to_f64_approximate(), self.upper.to_f64_approximate())
    }
}

/// The windows of both axes: what is asked for, else so that everything bounded shows.
pub fn choose_windows(answer: &Answer<Map>, marks: &[(f64, f64)], requests: &[WindowRequest; 2]) -> [AxisWindow; 2] {
    common_windows(&[answer], marks, requests)
}

/// The windows that several maps of the same two parameters share; what shows is chosen by those with stable points, if there are
/// any.
///
/// # Panics
/// Without a map.
pub fn common_windows(
    answers: &[&Answer<Map>],
    marks: &[(f64, f64)],
    requests: &[WindowRequest; 2],
) -> [AxisWindow; 2] {
    let with_regions = answers.iter().copied().filter(|a| !a.value().decomposition.regions.is_empty());
    let mut shown: Vec<&Answer<Map>> = with_regions.collect();
    if shown.is_empty() {
        shown = answers.to_vec();
    }
    [0, 1].map(|parameter| {
        let mut values: Vec<f64> = marks.iter().map(|m| if parameter == 0 { m.0 } else { m.1 }).collect();
        let mut open = [false; 2];
        for answer in &shown {
            let [lower, upper] = shown_values(answer, parameter, &mut values);
            open = [open[0] || lower, open[1] || upper];
        }
        values.retain(|v| v.is_finite() && v.abs() < 1e300 && (*v == 0.0 || v.abs() > 1e-300));
        window_of(&values, open, &shown[0].problem().free()[parameter].domain, &requests[parameter])
    })
}

/// Adds the values of a map that are to be seen; whether a region has no lower and no upper end.
fn shown_values(answer: &Answer<Map>, parameter: usize, values: &mut Vec<f64>) -> [bool; 2] {
    let axis = &answer.problem().free()[parameter];
    let regions = &answer.value().decomposition.regions;
    let extents: Vec<&RealInterval> = regions.iter().map(|r| if parameter == 0 { &r.x } else { &r.y }).collect();
    values.extend(extents.iter().flat_map(|e| [&e.lower, &e.upper]).flatten().map(approximate_real));
    values.extend(axis.nominal.as_ref().map(Rational::to_f64_approximate));
    for (_, set) in answer.value().slices.iter().filter(|(line, _)| line.parameter().name == axis.name) {
        let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
        values.extend(ends.map(|e| approximate_real(&e.value)));
    }
    let limits = answer.value().limits();
    let places = limits.iter().flat_map(|l| l.ends[1 - parameter].iter().flatten()).flat_map(|l| &l.limit.at);
    values.extend(
        places
            .map(|at| &at[parameter])
            .filter(|e| e.lower().sign() == e.upper().sign())
            .map(|e| e.lower().to_f64_approximate()),
    );
    if regions.is_empty() {
        values.extend(values_without_regions(answer, parameter));
    }
    [extents.iter().any(|e| e.lower.is_none()), extents.iter().any(|e| e.upper.is_none())]
}

/// Without a region the boundary curves are what there is to see.
fn values_without_regions(answer: &Answer<Map>, parameter: usize) -> Vec<f64> {
    let map = &answer.value().decomposition;
    if parameter == 0 {
        map.strips.iter().flat_map(|s| [&s.x.lower, &s.x.upper]).flatten().map(approximate_real).collect()
    } else {
        map.strips.iter().flat_map(|s| &s.cells).map(|c| c.sample.to_f64_approximate()).collect()
    }
}

fn window_of(values: &[f64], open: [bool; 2], domain: &Range, request: &WindowRequest) -> AxisWindow {
    let asked = [&request.lower, &request.upper].map(|end| end.as_ref().map(Rational::to_f64_approximate));
    let positive: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
    let reaches_zero = values.contains(&0.0) || open[0];
    let possible = request.lower.as_ref().is_none_or(|l| l.sign().is_gt())
        && request.upper.as_ref().is_none_or(|u| u.sign().is_gt());
    let least = |v: &[f64]| v.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = |v: &[f64]| v.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let from = asked[0].unwrap_or_else(|| least(&positive));
    let to = asked[1].unwrap_or_else(|| greatest(&positive));
    let wide = from > 0.0 && to / from >= LOGARITHMIC_RATIO && values.iter().all(|v| *v >= 0.0);
    let logarithmic = possible && request.logarithmic.unwrap_or(wide);
    let (lo, hi) = if logarithmic {
        let (from, to) = if from.is_finite() && to.is_finite() && from < to {
            (from, to)
        } else {
            let middle = if from.is_finite() { from } else { 1.0 };
            (middle / 10.0, middle * 10.0)
        };
        let room = (to / from).log10().max(0.5) * 0.06;
        let beyond = |open: bool| 10f64.powf(room + if open { 1.0 } else { 0.0 });
        (from / beyond(reaches_zero), to * beyond(open[1]))
    } else {
        let mut all = values.to_vec();
        all.extend(asked.iter().flatten());
        let (from, to) = (least(&all), greatest(&all));
        let (from, to) = match from < to {
            true => (from, to),
            false if from.is_finite() => (from - from.abs().max(1.0), from + from.abs().max(1.0)),
            false => (-1.0, 1.0),
        };
        let span = to - from;
        let beyond = |open: bool| span * if open { 0.6 } else { 0.08 };
        (from - beyond(open[0]), to + beyond(open[1]))
    };
    let mut lower = request.lower.clone().unwrap_or_else(|| rounded(lo));
    let mut upper = request.upper.clone().unwrap_or_else(|| rounded(hi));
    // There is nothing to see outside the domain.
    if request.lower.is_none()
        && let Some(end) = domain.lower.as_ref().filter(|end| lower < **end)
    {
        lower = end.clone();
    }
    if request.upper.is_none()
        && let Some(end) = domain.upper.as_ref().filter(|end| upper > **end)
    {
        upper = end.clone();
    }
    if lower >= upper {
        // A window that is asked for on one side only, beyond everything chosen on the other.
        let width = lower.abs().max(Rational::ONE);
        if request.upper.is_some() { lower = &upper - &width } else { upper = &lower + &width }
    }
    let logarithmic = logarithmic && lower.sign().is_gt();
    AxisWindow { lower, upper, logarithmic }
}

/// Three significant digits.
fn rounded(value: f64) -> Rational {
    parse_number(&format!("{value:.2e}")).unwrap_or(Rational::ZERO)
}
