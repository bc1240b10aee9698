//! Time responses.

use super::COLOURS;
use super::axes::tick_step;
use super::engineering::{frequency_text, quantity, unit_text};
use super::panel::{Corner, Curve, Mark, Panel, Shape, Text};
use crate::simulate::{StepMeasures, Trace};
use jurist_algebra::number::{parse_number, to_decimal};
use jurist_show::layout::visible;

/// Longest list of points a curve keeps; more would only make the file larger.
const MOST_POINTS: usize = 2400;

/// One signal of a run to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct ResponseCurve<'a> {
    /// The run.
    pub trace: &'a Trace,
    /// The signal's name in it.
    pub signal: &'a str,
    /// Entry in the legend; empty for none.
    pub label: &'a str,
}

/// A panel with signals over time; the axes fit the data. Times are in `time_unit`.
pub fn response_panel(title: &str, time_unit: &str, y_label: &str, curves: &[ResponseCurve<'_>]) -> Panel {
    let drawn: Vec<Curve> = curves
        .iter()
        .enumerate()
        .map(|(k, c)| Curve {
            points: thinned(&c.trace.points(c.signal)),
            label: (!c.label.is_empty()).then(|| c.label.to_string()),
            colour: COLOURS[k % COLOURS.len()].into(),
            width: if k == 0 { 1.3 } else { 1.1 },
            ..Curve::default()
        })
        .collect();
    let all = || drawn.iter().flat_map(|c| c.points.iter());
    let x = rounded_up(extent(all().map(|p| p.0), 0.0));
    let y = extent(all().map(|p| p.1), 0.08);
    let legend = drawn.iter().any(|c| c.label.is_some()).then_some(Corner::BottomRight);
    Panel {
        title: title.into(),
        x_label: axis_label("time", time_unit),
        y_label: y_label.into(),
        x,
        y,
        curves: drawn,
        legend,
        ..Panel::default()
    }
}

/// A quantity with its unit as on an axis: `omega (rad/s)`; the name alone where no unit is known.
pub fn axis_label(name: &str, unit: &str) -> String {
    match (visible(name), unit_text(&visible(unit))) {
        (name, unit) if unit.is_empty() => name.into_owned(),
        (name, unit) => format!("{name} ({unit})"),
    }
}

/// One panel for each of these signals of a run; of those that are `sampled` each value holds until the next.
pub fn response_panels(
    time_unit: &str,
    trace: &Trace,
    signals: &[String],
    sampled: impl Fn(&str) -> bool,
) -> Vec<Panel> {
    let in_stairs = stairs(trace);
    let panel = |name: &String| {
        let held = if sampled(name) { &in_stairs } else { trace };
        let label = axis_label(name, trace.signal(name).map_or("", |s| &s.unit));
        response_panel("", time_unit, &label, &[ResponseCurve { trace: held, signal: name, label: "" }])
    };
    signals.iter().map(panel).collect()
}

/// The run with every value held until the next instant: a jump is two values at one time.
///
/// ```
/// use jurist_draw::figures::stairs;
/// use jurist_draw::simulate::Trace;
/// let mut trace = Trace::with_names(&["x".into()]);
/// (0..2).for_each(|k| trace.push(f64::from(k), [f64::from(k)]));
/// assert_eq!(stairs(&trace).points("x"), [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
/// ```
pub fn stairs(trace: &Trace) -> Trace {
    let mut out = trace.clone();
    let doubled = |values: &[f64], shift: usize| -> Vec<f64> {
        let twice = values.iter().flat_map(|v| [*v, *v]);
        // A time stands twice from the second on, a value twice but for the last.
        twice.skip(shift).take((2 * values.len()).saturating_sub(1)).collect()
    };
    out.time = doubled(&trace.time, 1);
    for signal in &mut out.signals {
        signal.values = doubled(&signal.values, 0);
    }
    out
}

impl Panel {
    /// The panel of a step response with its final value, overshoot and settling time marked.
    pub fn with_step_measures(mut self, measures: &StepMeasures, time_unit: &str, unit: &str) -> Panel {
        let unit = unit_text(&visible(unit));
        let decimal = |v: f64| parse_number(&format!("{v:e}")).map(|v| to_decimal(&v, 4)).unwrap_or_default();
        self.levels.push((measures.last, format!("final value {}", quantity(&decimal(measures.last), &unit))));
        if let Some((time, value)) = measures.peak.filter(|_| measures.overshoot > 0.005) {
            let high = self.y.1 - self.y.0;
            let text = format!("overshoot {} %", frequency_text(100.0 * measures.overshoot, ""));
            // Beyond the peak, where nothing else is.
            let side = if value >= measures.last { 1.0 } else { -1.0 };
            let at = (time + 0.08 * (self.x.1 - self.x.0), value + side * 0.07 * high);
            self.y = (self.y.0.min(value + side * 0.16 * high), self.y.1.max(value + side * 0.16 * high));
            self.texts.push(Text { text, at, target: None });
            let (at, colour) = ((time, value), "#222222".into());
            self.marks.push(Mark { at, shape: Shape::Dot, colour, label: None });
        }
        if let Some(time) = measures.settled.filter(|t| *t > self.x.0 && *t < self.x.1) {
            self.verticals.push((time, format!("within 2 % from {}", quantity(&decimal(time), time_unit))));
        }
        self
    }
}

/// The range with its upper end moved to the next tick where only a sample is missing to it.
fn rounded_up(range: (f64, f64)) -> (f64, f64) {
    let step = tick_step(range, 10.0);
    let end = (range.1 / step).ceil() * step;
    if end - range.1 < 0.01 * (range.1 - range.0) { (range.0, end) } else { range }
}

/// Smallest and largest value, widened by a share of their distance.
fn extent(values: impl Iterator<Item = f64>, margin: f64) -> (f64, f64) {
    let (low, high) =
        values.filter(|v| v.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    let width = high - low;
    if width <= 1e-9 * high.abs().max(low.abs()) {
        let room = if high == 0.0 { 1.0 } else { 0.1 * high.abs() };
        return (low - room, high + room);
    }
    (low - margin * width, high + margin * width)
}

/// A long list of points cut to what a picture can show: of each short stretch its first, lowest,
/// highest and last point, so that no peak is lost.
pub fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    thinned_to(points, MOST_POINTS)
}

/// [`thinned`] to about so many points, at least 4.
pub fn thinned_to(points: &[(f64, f64)], most: usize) -> Vec<(f64, f64)> {
    if points.len() <= most {
        return points.to_vec();
    }
    let stretch = points.len().div_ceil((most / 4).max(1));
    let mut kept = Vec::with_capacity(most + 4);
    for part in points.chunks(stretch) {
        let by_value = |a: &usize, b: &usize| part[*a].1.total_cmp(&part[*b].1);
        let lowest = (0..part.len()).min_by(by_value).unwrap_or(0);
        let highest = (0..part.len()).max_by(by_value).unwrap_or(0);
        let mut chosen = vec![0, lowest, highest, part.len() - 1];
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|k| part[k]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_peaks() {
        let mut points: Vec<(f64, f64)> = (0..100_000).map(|k| (k as f64, (k as f64 * 0.01).sin())).collect();
        points[54_321].1 = 7.0;
        let kept = thinned(&points);
        assert!(kept.len() <= MOST_POINTS + 4);
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[99_999]));
        assert!(kept.contains(&(54_321.0, 7.0)));
        assert!(kept.windows(2).all(|w| w[0].0 < w[1].0));
    }

    #[test]
    fn axes_have_units_where_they_are_known() {
        assert_eq!(axis_label("omega", "rad/s"), "omega (rad/s)");
        assert_eq!(axis_label("i_a", "A"), "i_a (A)");
        assert_eq!(axis_label("x", ""), "x");
        let mut trace = Trace::with_names(&["x".into()]);
        (0..5).for_each(|k| trace.push(1e-4 * f64::from(k), [0.0]));
        let curve = [ResponseCurve { trace: &trace, signal: "x", label: "" }];
        let shown = |unit| response_panel("", unit, "x", &curve).figure(400.0, 200.0).svg();
        assert!(shown("s").contains(">time (µs)<") && shown("samples").contains(">time (samples)<"));
    }

    #[test]
    fn the_time_axis_ends_at_a_tick_that_one_sample_is_missing_to() {
        assert_eq!(rounded_up((0.0, 0.9999)), (0.0, 1.0));
        assert_eq!(rounded_up((0.0, 0.87)), (0.0, 0.87));
    }

    #[test]
    fn an_empty_or_constant_signal_still_has_axes() {
        assert_eq!(extent(std::iter::empty(), 0.1), (0.0, 1.0));
        assert_eq!(extent([0.0, 0.0].into_iter(), 0.1), (-1.0, 1.0));
        assert_eq!(extent([f64::NAN, 80.0].into_iter(), 0.1), (72.0, 88.0));
        assert!(stairs(&Trace::with_names(&["x".into()])).time.is_empty());
    }
}
