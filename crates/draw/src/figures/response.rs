//! Frequency responses: Bode and Nyquist diagrams of the open loop.
//!
//! The curves are sampled; crossings and margins are those of the answer.

use super::frequency::{FrequencyResponse, ResponsePoint, binding, middle, rate, unit_of};
use super::panel::{Corner, Curve, Mark, Panel, Shape, Text, stacked};
use super::{COLOURS, Figure, Scale};
use jurist_engine::answer::Answer;
use jurist_engine::response::{Margins, PhaseMargin, Place};
use jurist_engine::show::layout::visible;

/// A picture's size.
const SIZE: (f64, f64) = (720.0, 300.0);

/// More words than these would hide each other.
const MOST_WORDS: usize = 4;

fn title(answer: &Answer<Margins>) -> String {
    let name = answer.problem().title().map(visible).unwrap_or_else(|| "open loop".into());
    let cut = answer.value().open_loop.cut();
    format!("{name}: open loop at '{}'", visible(cut.name()))
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
struct Crossing {
    at: ResponsePoint,
    /// Whether the modulus is one there; else the open loop is real and negative.
    is_gain: bool,
    /// Whether a margin may bind there.
    is_binding: bool,
    words: String,
}

/// The crossings in the range that is drawn.
fn crossings(margins: &Margins, response: &FrequencyResponse) -> Vec<Crossing> {
    let (_, unit) = unit_of(margins);
    let binding = binding(margins);
    let mark = |place: &Place, is_gain: bool, words: String| {
        let at = *response.nearest(rate(margins, place)? * unit)?;
        let is_binding = binding.iter().any(|known| std::ptr::eq(*known, place));
        Some(Crossing { at, is_gain, is_binding, words })
    };
    let gain = margins.crossings.gain.iter().filter_map(|c| {
        let degrees = middle(&c.phase(60)).to_degrees();
        mark(&c.place, true, format!("PM {degrees:.2}°"))
    });
    let phase = margins.crossings.phase.iter().filter_map(|c| {
        let decibels = 20.0 * middle(&c.factor.enclosure(60)).log10();
        mark(&c.place, false, format!("GM {decibels:.2} dB"))
    });
    gain.chain(phase).collect()
}

/// The lines at -180 degrees, but for whole turns, at which the crossings that matter are; else the first that the curve meets.
fn critical_levels(marked: &[Crossing], (low, high): (f64, f64)) -> Vec<f64> {
    let nearest = |phase: f64| 360.0 * ((phase + 180.0) / 360.0).round() - 180.0;
    let inside = |level: &f64| (low..=high).contains(level);
    let mut levels: Vec<f64> =
        marked.iter().filter(|m| m.is_binding).map(|m| nearest(m.at.phase)).filter(inside).collect();
    if levels.is_empty() {
        let highest = 360.0 * ((high + 180.0) / 360.0).floor() - 180.0;
        levels.extend(Some(highest).filter(inside));
    }
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

/// Modulus and phase over the logarithm of the frequency, the exact crossings marked.
pub fn bode(answer: &Answer<Margins>, response: &FrequencyResponse) -> Figure {
    let margins = answer.value();
    let curve = |y: fn(&ResponsePoint) -> f64| Curve {
        points: response.points.iter().map(|p| (p.frequency, y(p))).collect(),
        colour: COLOURS[0].to_owned(),
        width: 1.8,
        ..Curve::default()
    };
    let first = response.points.first().map_or(0.1, |p| p.frequency);
    let last = response.points.last().map_or(10.0, |p| p.frequency);
    let marked = crossings(margins, response);
    let panel = |y: fn(&ResponsePoint) -> f64, y_label: &str, of_gain: bool| {
        let range = extent(response.points.iter().map(y).chain(of_gain.then_some(0.0)));
        let chosen: Vec<&Crossing> = marked.iter().filter(|m| m.is_gain != of_gain).collect();
        let mark = |m: &&Crossing| Mark {
            at: (m.at.frequency, y(&m.at)),
            shape: Shape::Diamond,
            colour: COLOURS[1].to_owned(),
            label: None,
        };
        let step = 0.1 * (range.1 - range.0);
        let text = |m: &&Crossing| {
            let (x, y) = (m.at.frequency, y(&m.at));
            Text {
                text: m.words.clone(),
                at: (x * (last / first).powf(0.04), (y + step).min(range.1 - 0.5 * step)),
                target: Some((x, y)),
            }
        };
        let said: Vec<&Crossing> = match chosen.len() <= MOST_WORDS {
            true => chosen.clone(),
            false => chosen.iter().copied().filter(|m| m.is_binding).collect(),
        };
        let texts = if said.len() <= MOST_WORDS { said.iter().map(text).collect() } else { Vec::new() };
        Panel {
            y_label: y_label.to_owned(),
            x: (first, last.max(first * 1.01)),
            x_scale: Scale::Logarithmic,
            y: range,
            curves: vec![curve(y)],
            marks: chosen.iter().map(mark).collect(),
            texts,
            ..Panel::default()
        }
    };
    let magnitude = Panel {
        title: title(answer),
        x_label: if response.hertz { " (Hz)" } else { "" }.to_owned(),
        levels: vec![(0.0, String::new())],
        ..panel(ResponsePoint::decibels, "magnitude (dB)", true)
    };
    let phase = panel(|p| p.phase, "phase (degrees)", false);
    let levels = critical_levels(&marked, phase.y).into_iter().map(|level| (level, String::new())).collect();
    stacked(&[magnitude, Panel { levels, x_label: response.label().to_owned(), ..phase }], SIZE.0, SIZE.1)
}

/// The curve of the open loop around -1, its mirror image for negative frequencies dashed, with the exact crossings.
pub fn nyquist(answer: &Answer<Margins>, response: &FrequencyResponse) -> Figure {
    /// Half the width of the picture, in units of the distance from 0 to -1.
    const REACH: f64 = 2.6;
    let margins = answer.value();
    let side = |sign: f64| response.points.iter().map(|p| (p.real, sign * p.imaginary)).collect::<Vec<_>>();
    let curve = |points, colour: &str, label: &str, dashed| Curve {
        points,
        colour: colour.to_owned(),
        width: 1.8,
        dashed,
        label: Some(label.to_owned()),
    };
    let turn = 2.0 * std::f64::consts::PI;
    let circle = |centre: f64, r: f64| {
        (0..=240).map(|i| f64::from(i) * turn / 240.0).map(|a| (centre + r * a.cos(), r * a.sin())).collect::<Vec<_>>()
    };
    let mut curves = vec![
        curve(circle(0.0, 1.0), "#999999", "magnitude 1", true),
        curve(side(1.0), COLOURS[0], "positive frequencies", false),
        curve(side(-1.0), COLOURS[4], "negative frequencies", true),
    ];
    if let Some(stable) = &margins.stable {
        let (lo, hi) = stable.modulus.refined_to_digits(9).enclosure();
        curves.push(curve(circle(-1.0, lo.midpoint(&hi).to_f64_approximate()), COLOURS[2], "modulus margin", true));
    }
    let exact = crossings(margins, response);
    let mut marks =
        vec![Mark { at: (-1.0, 0.0), shape: Shape::Cross, colour: COLOURS[1].to_owned(), label: Some("−1".into()) }];
    let are_few = exact.len() <= 2 * MOST_WORDS;
    marks.extend(exact.iter().filter(|m| are_few || m.is_binding).map(|m| Mark {
        at: (m.at.real, m.at.imaginary),
        shape: Shape::Diamond,
        colour: COLOURS[1].to_owned(),
        label: None,
    }));
    let mut words = Vec::new();
    if let Some(stable) = &margins.stable {
        if let Some(degrees) = stable.phase.degrees(60).filter(|_| !matches!(stable.phase, PhaseMargin::Unbounded)) {
            words.push(format!("PM {:.2}°", middle(&degrees)));
        }
        if let Some(upper) = &stable.gain.upper {
            let (lo, hi) = upper.value.refined_to_digits(9).enclosure();
            words.push(format!("GM {:.2} dB", 20.0 * lo.midpoint(&hi).to_f64_approximate().log10()));
        }
    }
    let heading = if words.is_empty() { title(answer) } else { format!("{} ({})", title(answer), words.join(", ")) };
    let panel = Panel {
        title: heading,
        x_label: "real part".to_owned(),
        y_label: "imaginary part".to_owned(),
        x: (-REACH, REACH),
        y: (-REACH, REACH),
        curves,
        marks,
        equal: true,
        legend: Some(Corner::TopRight),
        ..Panel::default()
    };
    panel.figure(640.0, 640.0)
}

#[cfg(test)]
mod tests {
    use super::super::frequency::frequency_response;
    use super::*;
    use jurist_algebra::limits::Budget;
    use jurist_algebra::number::Rational;
    use jurist_engine::model::{BlockBuilder, Model, Time};

    /// `K exp(-s)/(s + 1)` in unity feedback.
    fn delayed(gain: &str) -> Answer<Margins> {
        let plant = BlockBuilder::new("P", "r - y", "y").transfer(&format!("{gain}*exp(-s)/(s + 1)"));
        let (model, _) = Model::builder(Time::Continuous).inputs(["r"]).outputs(["y"]).block(plant).build().unwrap();
        model.ask().margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap()
    }

    /// At each sample, however far it is from the last.
    #[test]
    fn the_phase_of_a_loop_with_dead_time_is_exact() {
        for gain in ["1", "2", "1/1000", "20"] {
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
