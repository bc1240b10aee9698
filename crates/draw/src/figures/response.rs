//! Frequency responses: Bode diagrams of the open loop, and the crossings that are marked on these and on Nyquist curves.
//!
//! The curves are sampled; crossings and margins are those of the answer.

use super::frequency::{FrequencyResponse, ResponsePoint, binding, middle, rate, unit_of};
use super::panel::{Corner, Curve, Mark, Panel, Shape, Text, stacked};
use super::{COLOURS, Figure, Scale};
use jurist_engine::answer::Answer;
use jurist_engine::response::{Margins, PhaseMargin, Place};
use jurist_show::layout::visible;

/// A picture's size.
const SIZE: (f64, f64) = (720.0, 300.0);

/// More words than these would hide each other.
pub(super) const MOST_WORDS: usize = 4;

/// The name of a loop in one line, which says nothing.
const UNNAMED: &str = "open loop";

pub(super) fn title(answer: &Answer<Margins>) -> String {
    let title = answer.problem().title().map(visible);
    match (title, answer.value().open_loop.cut().name()) {
        (title, UNNAMED) => title.unwrap_or_else(|| UNNAMED.into()).into_owned(),
        (Some(title), cut) => format!("{title}: open loop at '{}'", visible(cut)),
        (None, cut) => format!("open loop at '{}'", visible(cut)),
    }
}

/// A number with two decimals and the unit; minus signs are as long as plus signs.
fn shown(value: f64, unit: &str) -> String {
    format!("{value:.2}{unit}").replace('-', "\u{2212}")
}

/// The margins of a stable loop in a line; nothing of another one.
pub(super) fn margins_line(margins: &Margins) -> Vec<String> {
    let Some(stable) = &margins.stable else { return Vec::new() };
    let ends = [&stable.gain.lower, &stable.gain.upper].into_iter().flatten();
    let factors = ends.map(|end| {
        let (lo, hi) = end.value.refined_to_digits(9).enclosure();
        lo.midpoint(&hi).to_f64_approximate()
    });
    let factors: Vec<String> = factors.filter(|f| *f > 0.0).map(|f| shown(20.0 * f.log10(), " dB")).collect();
    let gain = (!factors.is_empty()).then(|| format!("gain margin {}", factors.join(" and ")));
    let is_bounded = !matches!(stable.phase, PhaseMargin::Unbounded);
    let degrees = stable.phase.degrees(60).filter(|_| is_bounded);
    let phase = degrees.map(|d| format!("phase margin {}", shown(middle(&d), "°")));
    let words: Vec<String> = gain.into_iter().chain(phase).collect();
    if words.is_empty() { Vec::new() } else { vec![words.join(", ")] }
}

fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) =
        values.filter(|v| v.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if low > high {
        return (-1.0, 1.0);
    }
    let room = (0.06 * (high - low)).max(1.0);
    (low - room, high + room)
}

/// A mark on an exact crossing.
pub(super) struct Crossing {
    pub at: ResponsePoint,
    /// Whether the modulus is one there; else the open loop is real and negative.
    pub is_gain: bool,
    /// Whether a margin may bind there.
    pub is_binding: bool,
    pub words: String,
}

/// The crossings in the range that is drawn; and of the negative real axis that at frequency 0, and without end.
pub(super) fn crossings(margins: &Margins, response: &FrequencyResponse) -> Vec<Crossing> {
    let (_, unit) = unit_of(margins);
    let binding = binding(margins);
    let mark = |place: &Place, is_gain: bool, words: String| {
        let at = *response.nearest(rate(margins, place)? * unit)?;
        let is_binding = binding.iter().any(|known| std::ptr::eq(*known, place));
        Some(Crossing { at, is_gain, is_binding, words })
    };
    let gain = margins.crossings.gain.iter().filter_map(|c| {
        let degrees = middle(&c.phase(60)).to_degrees();
        mark(&c.place, true, format!("PM {}", shown(degrees, "°")))
    });
    let phase = margins.crossings.phase.iter().filter_map(|c| {
        let factor = middle(&c.factor.enclosure(60));
        let words = format!("GM {}", shown(20.0 * factor.log10(), " dB"));
        if rate(margins, &c.place).is_some() {
            return mark(&c.place, false, words);
        }
        let is_binding = binding.iter().any(|known| std::ptr::eq(*known, &c.place));
        let at = ResponsePoint { frequency: 0.0, real: -1.0 / factor, imaginary: 0.0, phase: -180.0 };
        Some(Crossing { at, is_gain: false, is_binding, words })
    });
    gain.chain(phase).collect()
}

/// Those of these that are labelled: all where they are few, else the ones that matter.
pub(super) fn labelled<'a>(chosen: &[&'a Crossing]) -> Vec<&'a Crossing> {
    let said: Vec<&Crossing> = match chosen.len() <= MOST_WORDS {
        true => chosen.to_vec(),
        false => chosen.iter().copied().filter(|m| m.is_binding).collect(),
    };
    if said.len() <= MOST_WORDS { said } else { Vec::new() }
}

/// The line at -180 degrees, but for whole turns, that a phase is nearest to.
fn nearest_level(phase: f64) -> f64 {
    360.0 * ((phase + 180.0) / 360.0).round() - 180.0
}

/// The lines at -180 degrees, but for whole turns, that the crossings that matter are nearest to; else the first that the curve meets.
fn critical_levels(marked: &[Crossing], (low, high): (f64, f64)) -> Vec<f64> {
    let mut levels: Vec<f64> = marked.iter().filter(|m| m.is_binding).map(|m| nearest_level(m.at.phase)).collect();
    if levels.is_empty() {
        let highest = 360.0 * ((high + 180.0) / 360.0).floor() - 180.0;
        levels.extend(Some(highest).filter(|level| (low..=high).contains(level)));
    }
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

/// One of the two panels.
struct Half<'a> {
    response: &'a FrequencyResponse,
    marked: &'a [Crossing],
    value: fn(&ResponsePoint) -> f64,
    /// The line that a mark is measured from.
    base: fn(&ResponsePoint) -> f64,
    /// Whether the marks are at the crossings of modulus one.
    of_gain: bool,
}

impl Half<'_> {
    fn panel(&self, y_label: &str, levels: &[f64]) -> Panel {
        let (points, value) = (&self.response.points, self.value);
        let negative = &self.response.negative;
        let first = points.first().map_or(0.1, |p| p.frequency);
        let last = points.last().map_or(10.0, |p| p.frequency).max(first * 1.01);
        let range = extent(self.response.all().map(value).chain(levels.iter().copied()));
        let chosen: Vec<&Crossing> = self.marked.iter().filter(|m| m.is_gain == self.of_gain).collect();
        let mark = |m: &&Crossing| Mark {
            at: (m.at.frequency.abs(), value(&m.at)),
            shape: Shape::Diamond,
            colour: COLOURS[1].to_owned(),
            label: None,
        };
        let step = 0.1 * (range.1 - range.0);
        let text = |m: &&Crossing| {
            let (x, y) = (m.at.frequency.abs(), value(&m.at));
            let at = (x * (last / first).powf(0.04), (y + step).min(range.1 - 0.5 * step));
            Text { text: m.words.clone(), at, target: Some((x, y)) }
        };
        let curve =
            |points, colour: &str, width| Curve { points, colour: colour.to_owned(), width, ..Curve::default() };
        let along = |points: &[ResponsePoint]| points.iter().map(|p| (p.frequency.abs(), value(p))).collect();
        let mut curves = vec![curve(along(points), COLOURS[0], 1.8)];
        if !negative.is_empty() {
            let named = |curve, label: &str| Curve { label: Some(label.to_owned()), ..curve };
            let below = Curve { dashed: true, ..curve(along(negative), COLOURS[4], 1.4) };
            curves = vec![named(curve(along(points), COLOURS[0], 1.8), "ω > 0"), named(below, "ω < 0")];
        }
        // The margins themselves: from the line to the curve.
        curves.extend(chosen.iter().filter(|m| m.is_binding).map(|m| {
            let x = m.at.frequency.abs();
            curve(vec![(x, (self.base)(&m.at)), (x, value(&m.at))], COLOURS[1], 1.6)
        }));
        Panel {
            y_label: y_label.to_owned(),
            x: (first, last),
            x_scale: Scale::Logarithmic,
            y: range,
            curves,
            marks: chosen.iter().map(mark).collect(),
            texts: labelled(&chosen).iter().map(text).collect(),
            levels: levels.iter().map(|level| (*level, String::new())).collect(),
            verticals: self.verticals(),
            ..Panel::default()
        }
    }

    /// The crossings that matter, of both kinds, in both panels; none where they would be a hedge.
    fn verticals(&self) -> Vec<(f64, String)> {
        let binding: Vec<f64> = self.marked.iter().filter(|m| m.is_binding).map(|m| m.at.frequency.abs()).collect();
        if binding.len() > 2 * MOST_WORDS {
            return Vec::new();
        }
        binding.into_iter().map(|f| (f, String::new())).collect()
    }
}

/// Modulus and phase over the logarithm of the frequency, the exact crossings marked: vertical lines through both panels, and the margins
/// as what is missing to 0 dB and to -180 degrees.
pub fn bode(answer: &Answer<Margins>, response: &FrequencyResponse) -> Figure {
    let margins = answer.value();
    let mut marked = crossings(margins, response);
    marked.retain(|m| m.at.frequency != 0.0);
    let marked = &marked[..];
    let magnitude = Half { response, marked, value: ResponsePoint::decibels, base: |_| 0.0, of_gain: false };
    let phase = Half { response, marked, value: |p| p.phase, base: |p| nearest_level(p.phase), of_gain: true };
    let magnitude = Panel {
        title: title(answer),
        notes: margins_line(margins),
        x_label: if response.hertz { " (Hz)" } else { "" }.to_owned(),
        legend: (!response.negative.is_empty()).then_some(Corner::Above),
        ..magnitude.panel("magnitude (dB)", &[0.0])
    };
    let levels = critical_levels(marked, extent(response.all().map(|p| p.phase)));
    let phase = Panel { x_label: response.label().to_owned(), ..phase.panel("phase (°)", &levels) };
    stacked(&[magnitude, phase], SIZE.0, SIZE.1)
}

#[cfg(test)]
mod tests {
    use super::super::frequency::frequency_response;
    use super::*;
    use jurist_algebra::limits::Budget;
    use jurist_algebra::number::Rational;
    use jurist_engine::model::{BlockBuilder, Model, Time};
    use jurist_engine::problem::Ask;

    /// `K exp(-s)/(s + 1)` in unity feedback.
    fn delayed(gain: &str) -> Answer<Margins> {
        let plant = BlockBuilder::new("P", "r - y", "y").transfer(&format!("{gain}*exp(-s)/(s + 1)"));
        let (model, _) = Model::builder(Time::Continuous).inputs(["r"]).outputs(["y"]).block(plant).build().unwrap();
        model.ask().margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap()
    }

    /// At each sample, however far it is from the last.
    #[test]
    fn the_phase_of_a_loop_with_dead_time_is_exact() {
        // Some of the gains by default, all in CI.
        let every = if std::env::var_os("JURIST_THOROUGH").is_some() { 1 } else { 2 };
        for gain in ["1", "2", "1/1000", "20"].into_iter().step_by(every) {
            let answer = delayed(gain);
            let response = frequency_response(answer.value(), &Budget::unlimited()).unwrap();
            for p in &response.points {
                let omega = 2.0 * std::f64::consts::PI * p.frequency;
                let phase = -(omega.atan() + omega).to_degrees();
                assert!((p.phase - phase).abs() < 1e-9 * (1.0 + phase.abs()), "{gain} at {omega}: {} {phase}", p.phase);
                assert!((p.real - p.real.hypot(p.imaginary) * phase.to_radians().cos()).abs() < 1e-9);
            }
        }
    }

    /// The first crossing of -180 degrees is at 2.0288 rad/s.
    #[test]
    #[ignore = "long: CI runs it"]
    fn the_window_ends_soon_after_the_crossings_and_has_one_line() {
        let answer = delayed("2");
        let response = frequency_response(answer.value(), &Budget::unlimited()).unwrap();
        let ends =
            [response.points.first(), response.points.last()].map(|p| p.unwrap().frequency * std::f64::consts::TAU);
        assert!(ends[0] < 0.1 && ends[1] > 4.0 && ends[1] < 20.0, "{ends:?}");
        let marked = crossings(answer.value(), &response);
        let binding: Vec<f64> = marked.iter().filter(|m| m.is_binding).map(|m| m.at.phase.round()).collect();
        assert_eq!(binding.len(), 2, "one of each kind: {binding:?}");
        assert_eq!(critical_levels(&marked, extent(response.points.iter().map(|p| p.phase))), [-180.0]);
    }

    #[test]
    fn lines_are_where_crossings_that_matter_are() {
        let at = |phase| ResponsePoint { frequency: 1.0, real: -1.0, imaginary: 0.0, phase };
        let mark = |phase, is_binding| Crossing { at: at(phase), is_gain: false, is_binding, words: String::new() };
        let marked = [mark(-180.0, false), mark(-540.0, true), mark(-897.0, true), mark(-545.0, true)];
        assert_eq!(critical_levels(&marked, (-1000.0, 0.0)), [-900.0, -540.0]);
        assert_eq!(critical_levels(&marked[..1], (-1000.0, 0.0)), [-180.0], "the first where none matters");
        assert!(critical_levels(&[], (-90.0, 0.0)).is_empty());
    }
}
