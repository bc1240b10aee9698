//! Frequency responses: Bode and Nyquist diagrams of the open loop.
//!
//! The curves are sampled: at each frequency the open loop's value is computed exactly, or with many bits, and then rounded. Crossings and margins
//! are those of the answer.

use super::panel::{Corner, Curve, Mark, Panel, Shape, Text, stacked};
use super::{COLOURS, Figure, Scale};
use crate::simulate::roots;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Poly, UniPoly};
use jurist_engine::answer::Answer;
use jurist_engine::response::{Margins, PhaseMargin, Place};
use jurist_engine::show::layout::visible;
use jurist_engine::stability;

/// A frequency response in floating point, by ascending frequency.
#[derive(Clone, Debug, Default)]
pub struct FrequencyResponse {
    /// Whether frequencies are in hertz; else in radians per sample.
    pub hertz: bool,
    /// The samples.
    pub points: Vec<ResponsePoint>,
}

/// The open loop at one frequency.
#[derive(Clone, Copy, Debug)]
pub struct ResponsePoint {
    /// The frequency.
    pub frequency: f64,
    /// The real part.
    pub real: f64,
    /// The imaginary part.
    pub imaginary: f64,
    /// The phase in degrees, continued from point to point.
    pub phase: f64,
}

impl ResponsePoint {
    /// The modulus in decibels.
    pub fn decibels(&self) -> f64 {
        20.0 * self.real.hypot(self.imaginary).log10()
    }
}

/// Bits of constants that are not rational.
const BITS: u64 = 128;

/// Frequencies that are sampled.
const SAMPLES: usize = 900;

/// A picture's size.
const SIZE: (f64, f64) = (720.0, 300.0);

fn middle(e: &Enclosure) -> f64 {
    e.lower().midpoint(e.upper()).to_f64_approximate()
}

/// The unit of frequency: angles per sample, or radians per unit of time, times this.
fn unit_of(margins: &Margins) -> (bool, f64) {
    let turn = 2.0 * std::f64::consts::PI;
    match (margins.open_loop.shape(), margins.open_loop.sample_time()) {
        (stability::Shape::LeftHalfPlane, _) => (true, 1.0 / turn),
        (stability::Shape::UnitDisc, Some(t)) => (true, 1.0 / (turn * t.to_f64_approximate())),
        (stability::Shape::UnitDisc, None) => (false, 1.0),
    }
}

/// Angle or radians per unit of time at a place, if it is positive.
fn rate(margins: &Margins, place: &Place) -> Option<f64> {
    let frequency = margins.frequency(place, 60)?;
    let rate = middle(frequency.angle.as_ref().or(frequency.radians_per_second.as_ref())?);
    (rate > 0.0).then_some(rate)
}

/// From where to where the curves go: around the crossings and the corners of the open loop.
fn range(margins: &Margins) -> (f64, f64) {
    let crossings = &margins.crossings;
    let places = crossings.gain.iter().map(|c| &c.place).chain(crossings.phase.iter().map(|c| &c.place));
    let mut features: Vec<f64> = places.filter_map(|place| rate(margins, place)).collect();
    let is_disc = margins.open_loop.shape() == stability::Shape::UnitDisc;
    let half_turn = std::f64::consts::PI;
    for coefficients in margins.open_loop.coefficients(BITS) {
        for root in roots(&UniPoly::from_rational_poly(&Poly::new(coefficients)).1) {
            // The corner of a pole z = exp(s T) is about at |s T|.
            let corner = if is_disc { root.value.ln().norm() } else { root.value.norm() };
            features.extend(Some(corner).filter(|c| c.is_finite() && *c > 1e-12));
        }
    }
    let least = features.iter().copied().fold(f64::INFINITY, f64::min);
    let most = features.iter().copied().fold(0.0, f64::max);
    match (is_disc, least.is_finite()) {
        (true, true) => ((least / 30.0).min(half_turn / 1e3), half_turn),
        (true, false) => (half_turn / 1e3, half_turn),
        (false, true) => (least / 30.0, most * 30.0),
        (false, false) => (1e-2, 1e2),
    }
}

/// The open loop's values at angles or frequencies: exact at the nearest binary number, then rounded. `None` at a pole.
fn values(margins: &Margins, rates: &[f64]) -> Vec<Option<(f64, f64)>> {
    let shape = margins.open_loop.shape();
    let place = |&rate: &f64| match shape {
        // 2 - 4 sin^2(theta/2) keeps the digits near z = 1.
        stability::Shape::UnitDisc => Rational::from(2) - finite(4.0 * (rate / 2.0).sin().powi(2)),
        stability::Shape::LeftHalfPlane => -finite(rate * rate),
    };
    let places: Vec<Rational> = rates.iter().map(place).collect();
    let factors = rates.iter().map(|&rate| if shape == stability::Shape::UnitDisc { rate.sin() } else { rate });
    let found = margins.open_loop.values_at(&places, BITS);
    let rounded = found.iter().zip(factors).map(|(value, factor)| {
        let (real, imaginary) = value.as_ref()?;
        Some((middle(real), middle(imaginary) * factor)).filter(|v| v.0.is_finite() && v.1.is_finite())
    });
    rounded.collect()
}

fn finite(x: f64) -> Rational {
    Rational::from_f64(x).expect("frequencies are finite")
}

/// The open loop over the frequencies that matter.
pub fn frequency_response(margins: &Margins) -> FrequencyResponse {
    let (hertz, unit) = unit_of(margins);
    let (low, high) = range(margins);
    let mut rates: Vec<f64> =
        (0..=SAMPLES).map(|i| low * (high / low).powf(i as f64 / SAMPLES as f64)).map(|r| r.min(high)).collect();
    let crossings = &margins.crossings;
    let places = crossings.gain.iter().map(|c| &c.place).chain(crossings.phase.iter().map(|c| &c.place));
    rates.extend(places.filter_map(|place| rate(margins, place)).filter(|r| (low..=high).contains(r)));
    rates.sort_by(f64::total_cmp);
    rates.dedup();
    let mut points: Vec<ResponsePoint> = Vec::with_capacity(rates.len());
    for (rate, value) in rates.iter().zip(values(margins, &rates)) {
        let Some((real, imaginary)) = value else { continue };
        let mut phase = imaginary.atan2(real).to_degrees();
        if let Some(last) = points.last() {
            phase += 360.0 * ((last.phase - phase) / 360.0).round();
        }
        points.push(ResponsePoint { frequency: rate * unit, real, imaginary, phase });
    }
    FrequencyResponse { hertz, points }
}

impl FrequencyResponse {
    /// The samples as a table.
    pub fn to_csv(&self) -> String {
        let unit = if self.hertz { "hz" } else { "rad_per_sample" };
        let mut out = format!("frequency_{unit},real,imaginary,magnitude_db,phase_degrees\n");
        for p in &self.points {
            out.push_str(&format!("{},{},{},{},{}\n", p.frequency, p.real, p.imaginary, p.decibels(), p.phase));
        }
        out
    }

    fn label(&self) -> &'static str {
        if self.hertz { "frequency (Hz)" } else { "angle (rad per sample)" }
    }

    /// The sample nearest to a frequency.
    fn nearest(&self, frequency: f64) -> Option<&ResponsePoint> {
        let distance = |p: &&ResponsePoint| (p.frequency / frequency).ln().abs();
        self.points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

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

/// A mark for each exact crossing: where, its height in both panels, and what it says.
fn crossings(margins: &Margins, response: &FrequencyResponse) -> Vec<(ResponsePoint, bool, String)> {
    let (_, unit) = unit_of(margins);
    let at = |place: &Place| response.nearest(rate(margins, place)? * unit).copied();
    let gain = margins.crossings.gain.iter().filter_map(|c| {
        let degrees = middle(&c.phase(60)).to_degrees();
        Some((at(&c.place)?, true, format!("PM {degrees:.2}°")))
    });
    let phase = margins.crossings.phase.iter().filter_map(|c| {
        let decibels = 20.0 * middle(&c.factor.enclosure(60)).log10();
        Some((at(&c.place)?, false, format!("GM {decibels:.2} dB")))
    });
    gain.chain(phase).collect()
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
        let chosen: Vec<_> = marked.iter().filter(|m| m.1 != of_gain).collect();
        let mark = |m: &&(ResponsePoint, bool, String)| Mark {
            at: (m.0.frequency, y(&m.0)),
            shape: Shape::Diamond,
            colour: COLOURS[1].to_owned(),
            label: None,
        };
        let step = 0.1 * (range.1 - range.0);
        let text = |m: &&(ResponsePoint, bool, String)| {
            let (x, y) = (m.0.frequency, y(&m.0));
            Text {
                text: m.2.clone(),
                at: (x * (last / first).powf(0.04), (y + step).min(range.1 - 0.5 * step)),
                target: Some((x, y)),
            }
        };
        // Beyond a few, words would hide each other.
        let texts = if chosen.len() <= 4 { chosen.iter().map(text).collect() } else { Vec::new() };
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
        ..panel(ResponsePoint::decibels, "modulus (dB)", true)
    };
    let phase = panel(|p| p.phase, "phase (degrees)", false);
    let (low, high) = phase.y;
    let turns = (low / 360.0).floor() as i64 - 1..=(high / 360.0).ceil() as i64 + 1;
    let levels: Vec<_> = turns.map(|k| 360.0 * k as f64 - 180.0).filter(|l| (low..=high).contains(l)).collect();
    let levels = levels.into_iter().map(|l| (l, String::new())).collect();
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
        curve(circle(0.0, 1.0), "#999999", "modulus 1", true),
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
    marks.extend(exact.iter().map(|m| Mark {
        at: (m.0.real, m.0.imaginary),
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
