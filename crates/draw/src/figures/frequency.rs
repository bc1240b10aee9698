//! Frequency responses as samples.
//!
//! At each frequency the open loop's value is computed exactly, or with many bits, and then rounded. Its phase is that of the loop without
//! dead time, of which the quarter of a turn is known by proof, less the angle of the dead time: samples may be as far apart as
//! they like.

use crate::simulate::roots;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Poly, UniPoly};
use jurist_engine::response::{Frequencies, Margins, Place, Turning};
use jurist_engine::stability::Shape;

/// A frequency response in floating point, by ascending frequency.
#[derive(Clone, Debug, Default)]
pub struct FrequencyResponse {
    /// Whether frequencies are in hertz; else in radians per sample.
    pub hertz: bool,
    /// The samples at positive frequencies.
    pub points: Vec<ResponsePoint>,
    /// Those at negative frequencies, of a loop with complex coefficients, from the highest frequency on; of a real loop these are the mirror images of
    /// the others.
    pub negative: Vec<ResponsePoint>,
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
    /// The phase in degrees, continued from the lowest frequency on.
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

/// A loop with dead time is drawn so many times as far as the last crossing that matters.
const BEYOND: f64 = 5.0;

/// Radians by which a dead time turns at most from sample to sample, and the most samples that this may take.
const TURN: f64 = 0.1;
const MOST_TURNS: f64 = 6000.0;

pub(super) fn middle(e: &Enclosure) -> f64 {
    e.lower().midpoint(e.upper()).to_f64_approximate()
}

/// The unit of frequency: angles per sample, or radians per unit of time, times this.
pub(super) fn unit_of(margins: &Margins) -> (bool, f64) {
    let turn = 2.0 * std::f64::consts::PI;
    match (margins.open_loop.shape(), margins.open_loop.sample_time()) {
        (Shape::LeftHalfPlane, _) => (true, 1.0 / turn),
        (Shape::UnitDisc, Some(t)) => (true, 1.0 / (turn * t.to_f64_approximate())),
        (Shape::UnitDisc, None) => (false, 1.0),
    }
}

/// Angle or radians per unit of time at a place, if it is not 0.
pub(super) fn rate(margins: &Margins, place: &Place) -> Option<f64> {
    let frequency = margins.frequency(place, 60)?;
    let rate = middle(frequency.angle.as_ref().or(frequency.radians_per_second.as_ref())?);
    (rate != 0.0).then_some(rate)
}

/// The crossings that matter: all of modulus one, and of those of the negative real axis the ones whose factors are nearest to 1,
/// from above and from below.
pub(super) fn binding(margins: &Margins) -> Vec<&Place> {
    let factors = margins.crossings.phase.iter().map(|c| (middle(&c.factor.enclosure(60)).ln(), &c.place));
    let (above, below): (Vec<_>, Vec<_>) = factors.partition(|(factor, _)| *factor >= 0.0);
    let nearest = [above, below].map(|list| list.into_iter().min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())));
    let gain = margins.crossings.gain.iter().map(|c| &c.place);
    gain.chain(nearest.into_iter().flatten().map(|(_, place)| place)).collect()
}

/// From where to where the curves go: around the crossings and the corners of the open loop; with dead time, which turns a loop without
/// end, not much beyond the last crossing that matters.
fn range(margins: &Margins) -> (f64, f64) {
    let (crossings, delay) = (&margins.crossings, dead_time(margins));
    let places = crossings.gain.iter().map(|c| &c.place).chain(crossings.phase.iter().map(|c| &c.place));
    let places: Vec<&Place> = if delay > 0.0 { binding(margins) } else { places.collect() };
    let mut features: Vec<f64> = places.into_iter().filter_map(|place| rate(margins, place)).map(f64::abs).collect();
    let last = features.iter().copied().fold(0.0, f64::max);
    let is_disc = margins.open_loop.shape() == Shape::UnitDisc;
    let half_turn = std::f64::consts::PI;
    for coefficients in margins.open_loop.coefficients(BITS) {
        for root in roots(&UniPoly::from_rational_poly(&Poly::new(coefficients)).1) {
            // The corner of a pole z = exp(s T) is about at |s T|.
            let corner = if is_disc { root.value.ln().norm() } else { root.value.norm() };
            features.extend(Some(corner).filter(|c| c.is_finite() && *c > 1e-12));
        }
    }
    if delay > 0.0 && features.is_empty() {
        features.push(1.0 / delay);
    }
    let least = features.iter().copied().fold(f64::INFINITY, f64::min);
    let most = features.iter().copied().fold(0.0, f64::max);
    match (is_disc, least.is_finite()) {
        (true, true) => ((least / 30.0).min(half_turn / 1e3), half_turn),
        (true, false) => (half_turn / 1e3, half_turn),
        (false, true) if delay > 0.0 => (least / 30.0, BEYOND * if last > 0.0 { last } else { most }),
        (false, true) => (least / 30.0, most * 30.0),
        (false, false) => (1e-2, 1e2),
    }
}

fn dead_time(margins: &Margins) -> f64 {
    margins.open_loop.dead_time().map_or(0.0, Rational::to_f64_approximate)
}

/// The sizes of the frequencies of the samples: evenly on a logarithmic axis, and so near to one another that the dead time turns little between them.
fn rates(margins: &Margins) -> Vec<f64> {
    let (low, high) = range(margins);
    let mut rates: Vec<f64> =
        (0..=SAMPLES).map(|i| low * (high / low).powf(i as f64 / SAMPLES as f64)).map(|r| r.min(high)).collect();
    let delay = dead_time(margins);
    if delay > 0.0 {
        let step = (TURN / delay).max(high / MOST_TURNS);
        let from = step / ((high / low).powf(1.0 / SAMPLES as f64) - 1.0);
        rates.extend((0..).map(|i| from + f64::from(i) * step).take_while(|rate| *rate < high));
    }
    let crossings = &margins.crossings;
    let places = crossings.gain.iter().map(|c| &c.place).chain(crossings.phase.iter().map(|c| &c.place));
    rates.extend(places.filter_map(|place| rate(margins, place)).map(f64::abs).filter(|r| (low..=high).contains(r)));
    rates.sort_by(f64::total_cmp);
    rates.dedup();
    rates
}

/// The point of the boundary at an angle or a frequency: exact at the nearest binary number.
fn point(rate: f64, frequencies: Frequencies) -> Rational {
    match frequencies {
        // 2 - 4 sin^2(theta/2) keeps the digits near z = 1.
        Frequencies::Positive(Shape::UnitDisc) => Rational::from(2) - finite(4.0 * (rate / 2.0).sin().powi(2)),
        Frequencies::Positive(Shape::LeftHalfPlane) => -finite(rate * rate),
        Frequencies::Signed(Shape::UnitDisc) => finite((rate / 2.0).tan()),
        Frequencies::Signed(Shape::LeftHalfPlane) => finite(rate),
    }
}

fn finite(x: f64) -> Rational {
    Rational::from_f64(x).expect("frequencies are finite")
}

/// The open loop over the frequencies that matter.
///
/// Cost: that of [`Turning::of`], and one or two values at each of about a thousand frequencies, up to seven thousand where a long dead
/// time turns the loop.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn frequency_response(margins: &Margins, budget: &Budget) -> Result<FrequencyResponse, Exhausted> {
    let open_loop = &margins.open_loop;
    let (hertz, unit) = unit_of(margins);
    budget.step("frequency response");
    let turning = Turning::of(open_loop, budget)?;
    budget.enter(|| {
        let rates = rates(margins);
        let points = sampled(margins, &turning, &rates, unit);
        let negative = match open_loop.frequencies().are_signed() {
            true => sampled(margins, &turning, &rates.iter().rev().map(|rate| -rate).collect::<Vec<_>>(), unit),
            false => Vec::new(),
        };
        FrequencyResponse { hertz, points, negative }
    })
}

/// The open loop at these angles or frequencies.
fn sampled(margins: &Margins, turning: &Turning, rates: &[f64], unit: f64) -> Vec<ResponsePoint> {
    let open_loop = &margins.open_loop;
    let places: Vec<Rational> = rates.iter().map(|&rate| point(rate, open_loop.frequencies())).collect();
    let rounded = |values: Vec<Option<(Enclosure, Enclosure)>>| -> Vec<Option<(f64, f64)>> {
        let factors = rates.iter().map(|&rate| match open_loop.frequencies() {
            Frequencies::Positive(Shape::UnitDisc) => rate.sin(),
            Frequencies::Positive(Shape::LeftHalfPlane) => rate,
            Frequencies::Signed(_) => 1.0,
        });
        let value = |(value, factor): (Option<(Enclosure, Enclosure)>, f64)| {
            let (real, imaginary) = value?;
            Some((middle(&real), middle(&imaginary) * factor)).filter(|v| v.0.is_finite() && v.1.is_finite())
        };
        values.into_iter().zip(factors).map(value).collect()
    };
    let undelayed = rounded(open_loop.undelayed_values_at(&places, BITS));
    let delay = dead_time(margins);
    let values = if delay > 0.0 { rounded(open_loop.values_at(&places, BITS)) } else { undelayed.clone() };
    let mut points = Vec::with_capacity(rates.len());
    for (i, rate) in rates.iter().enumerate() {
        let (Some((real, imaginary)), Some((re, im))) = (values[i], undelayed[i]) else { continue };
        let own = im.atan2(re).to_degrees();
        let turns = ((turning.middle(&places[i]) as f64 - own) / 360.0).round();
        let phase = own + 360.0 * turns - (rate * delay).to_degrees();
        points.push(ResponsePoint { frequency: rate * unit, real, imaginary, phase });
    }
    points
}

impl FrequencyResponse {
    /// The samples as a table.
    pub fn to_csv(&self) -> String {
        let unit = if self.hertz { "hz" } else { "rad_per_sample" };
        let mut out = format!("frequency_{unit},real,imaginary,magnitude_db,phase_degrees\n");
        for p in self.all() {
            out.push_str(&format!("{},{},{},{},{}\n", p.frequency, p.real, p.imaginary, p.decibels(), p.phase));
        }
        out
    }

    /// All samples by ascending frequency.
    pub fn all(&self) -> impl Iterator<Item = &ResponsePoint> {
        self.negative.iter().chain(&self.points)
    }

    pub(super) fn label(&self) -> &'static str {
        if self.hertz { "frequency (Hz)" } else { "angle (rad per sample)" }
    }

    /// The sample nearest to a frequency, `None` outside of the range that is drawn.
    pub(super) fn nearest(&self, frequency: f64) -> Option<&ResponsePoint> {
        let points = if frequency < 0.0 { &self.negative } else { &self.points };
        let (first, last) = (self.points.first()?.frequency, self.points.last()?.frequency);
        if !(first * 0.999..=last * 1.001).contains(&frequency.abs()) {
            return None;
        }
        let distance = |p: &&ResponsePoint| (p.frequency / frequency).ln().abs();
        points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}
