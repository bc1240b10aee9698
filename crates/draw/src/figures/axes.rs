//! The axes of all figures: scales, ticks, and the frame with its grid.

use super::engineering::{power_of_ten, prefix, takes_prefix, thousands};
use super::{FRAME, GRID, INK};
use crate::scene::{Anchor, Colour, Point, Rectangle, Scene, Stroke, Words, width};

/// How values lie on an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in their logarithms; both ends are positive.
    Logarithmic,
}

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where, from 0 to 1.
    pub place: f64,
    /// What is written there; small ticks have nothing.
    pub label: Option<String>,
}

/// An axis: what it shows, from where to where, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub name: String,
    /// Its unit as it is printed; empty for numbers.
    pub unit: String,
    /// Both ends.
    pub range: (f64, f64),
    /// How values lie between them.
    pub scale: Scale,
}

impl Axis {
    /// An axis from its label: a unit stands in parentheses at its end, `time (s)`. A unit alone, ` (s)`, makes an axis without a title
    /// whose numbers have that unit.
    ///
    /// ```
    /// use jurist_draw::figures::{Axis, Scale};
    /// let axis = Axis::labelled("time (s)", (0.0, 0.05), Scale::Linear);
    /// assert_eq!(axis.title(), "time (ms)");
    /// assert_eq!(axis.ticks(5.0)[1].label.as_deref(), Some("10"));
    /// ```
    pub fn labelled(label: &str, range: (f64, f64), scale: Scale) -> Axis {
        let unit = label.strip_suffix(')').and_then(|l| l.rsplit_once(" ("));
        let (name, unit) = unit.unwrap_or((label, ""));
        Axis { name: name.into(), unit: unit.into(), range, scale }
    }

    /// Where a value is: 0 at the lower end, 1 at the upper end; minus infinity for what a logarithm has not.
    pub fn place(&self, value: f64) -> f64 {
        let (lo, hi) = self.range;
        match self.scale {
            Scale::Linear => (value - lo) / (hi - lo),
            Scale::Logarithmic if value <= 0.0 => f64::NEG_INFINITY,
            Scale::Logarithmic => (value / lo).ln() / (hi / lo).ln(),
        }
    }

    /// The power of 1000 that the numbers at the ticks are given in: on a linear axis of a unit with prefixes.
    fn thousands(&self) -> i32 {
        match self.scale {
            Scale::Linear => thousands(self.range.0.abs().max(self.range.1.abs()), &self.unit),
            Scale::Logarithmic => 0,
        }
    }

    /// Quantity and unit: `T (ms)`.
    pub fn title(&self) -> String {
        match self.unit.as_str() {
            _ if self.name.is_empty() => String::new(),
            "" => self.name.clone(),
            unit => format!("{} ({}{unit})", self.name, prefix(self.thousands())),
        }
    }

    /// About `count` labelled ticks.
    pub fn ticks(&self, count: f64) -> Vec<Tick> {
        let ticks = if self.scale == Scale::Logarithmic { self.logarithmic(count) } else { Vec::new() };
        if ticks.iter().filter(|t| t.label.is_some()).count() >= 2 { ticks } else { self.linear(count) }
    }

    fn linear(&self, count: f64) -> Vec<Tick> {
        let (lo, hi) = self.range;
        let step = match self.unit.as_str() {
            "°" => step_among(&[5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0], self.range, count),
            "dB" => step_among(&[5.0, 10.0, 20.0, 40.0, 60.0, 80.0, 100.0], self.range, count),
            _ => tick_step(self.range, count),
        };
        let factor = 1000f64.powi(-self.thousands());
        let largest = factor * lo.abs().max(hi.abs());
        // Numbers on a linear part of a logarithmic axis are few and have their own prefix.
        let decimals = (-(factor * step).log10() - 1e-9).ceil().max(0.0) as usize;
        let precise = (largest.log10().floor() - (factor * step).log10() - 1e-9).ceil().clamp(0.0, 15.0) as usize;
        let mut out = Vec::new();
        let mut k = (lo / step - 1e-9).ceil();
        while k * step <= hi + 1e-9 * step && out.len() < 50 {
            let value = k * step * factor;
            let label = match () {
                () if k == 0.0 => "0".to_owned(),
                () if !(1e-2..1e6).contains(&largest) || decimals > 6 => power_of_ten(value, precise),
                () => format!("{value:.decimals$}").replace('-', "\u{2212}"),
            };
            out.push(Tick { place: self.place(k * step).clamp(0.0, 1.0), label: Some(label) });
            k += 1.0;
        }
        out
    }

    fn logarithmic(&self, count: f64) -> Vec<Tick> {
        let (lo, hi) = self.range;
        let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
        let every = (f64::from(last - first) / count).ceil().max(1.0) as i32;
        let within = (hi / lo).log10();
        let mut out = Vec::new();
        for exponent in first..=last {
            for digit in 1..10 {
                let value = f64::from(digit) * 10f64.powi(exponent);
                let place = self.place(value);
                if !(-1e-9..=1.0 + 1e-9).contains(&place) {
                    continue;
                }
                let named = match digit {
                    1 => exponent.rem_euclid(every) == 0,
                    2 | 5 => within < 0.4 * count && within < 2.0,
                    _ => false,
                };
                if named || within < 9.0 || digit == 1 {
                    let label = named.then(|| self.decade_label(digit, exponent));
                    out.push(Tick { place: place.clamp(0.0, 1.0), label });
                }
            }
        }
        out
    }

    /// A digit times a power of ten: with its unit where that takes prefixes, `20 µs`.
    fn decade_label(&self, digit: i32, exponent: i32) -> String {
        if takes_prefix(&self.unit) && (-12..12).contains(&exponent) {
            let number = format!("{digit}e{exponent}");
            return super::engineering::quantity(&number, &self.unit);
        }
        let value = f64::from(digit) * 10f64.powi(exponent);
        match exponent {
            -3..=-1 => format!("{value:.*}", exponent.unsigned_abs() as usize),
            0..=3 => format!("{value:.0}"),
            _ => power_of_ten(value, 0),
        }
    }
}

/// A distance between ticks from the series 1, 2, 5 that gives about `count` of them.
pub(super) fn tick_step(range: (f64, f64), count: f64) -> f64 {
    let raw = ((range.1 - range.0) / count).abs().max(f64::MIN_POSITIVE);
    let decade = 10f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * decade >= raw * 0.999).unwrap_or(10.0);
    factor * decade
}

/// A distance between ticks from a series, such as parts of a turn, or decibels of decades; finer and coarser ones are those of other axes.
fn step_among(series: &[f64], range: (f64, f64), count: f64) -> f64 {
    let raw = ((range.1 - range.0) / count).abs();
    match (series.first(), series.last()) {
        (Some(first), Some(last)) if raw > 0.4 * first && raw > *last => (raw / last).ceil() * last,
        (Some(first), _) if raw > 0.4 * first => series.iter().copied().find(|p| *p >= raw).unwrap_or(*first),
        _ => tick_step(range, count),
    }
}

/// Sizes of letters: at ticks, and of the titles of axes.
const TICK_SIZE: f64 = 11.0;
const TITLE_SIZE: f64 = 12.0;

/// Fewer labelled ticks than these are few on an axis along y; how far apart two are at least.
const FEW_TICKS: usize = 5;
const LEAST_BETWEEN: f64 = 15.0;

/// What the words at a tick keep free of the edge of the figure.
const EDGE: f64 = 4.0;
/// Below the axes: numbers and the title.
pub(super) const BELOW: f64 = 44.0;

/// Two axes in a rectangle of a scene.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub x: Axis,
    pub y: Axis,
    pub plot: Rectangle,
    /// Whether both axes have ticks equally far apart.
    pub equal: bool,
}

impl Frame {
    /// Where a pair of values is in the scene.
    pub fn at(&self, (x, y): Point) -> Point {
        self.at_places((self.x.place(x), self.y.place(y)))
    }

    /// Where a pair of places from 0 to 1 is in the scene.
    pub fn at_places(&self, (u, v): Point) -> Point {
        (self.plot.left + u * self.plot.width, self.plot.top + (1.0 - v) * self.plot.height)
    }

    fn y_ticks(&self) -> Vec<Tick> {
        if self.equal {
            return self.y.ticks((self.plot.width / 80.0).max(2.0));
        }
        // More of them where there are few and they have room.
        let count = (self.plot.height / 40.0).max(2.0);
        let labelled = |ticks: &[Tick]| ticks.iter().filter(|t| t.label.is_some()).count();
        let mut ticks = self.y.ticks(count);
        for times in [1.4, 2.0, 2.6] {
            let finer = self.y.ticks(times * count);
            if labelled(&ticks) >= FEW_TICKS || self.plot.height < LEAST_BETWEEN * labelled(&finer) as f64 {
                break;
            }
            ticks = finer;
        }
        ticks
    }

    /// How much room the numbers and the title on the left need.
    pub fn left_of(y: &Axis, height: f64) -> f64 {
        let plot = Rectangle { left: 0.0, top: 0.0, width: height, height };
        let frame = Frame { x: y.clone(), y: y.clone(), plot, equal: false };
        let labels = frame.y_ticks();
        let widest = labels.iter().flat_map(|t| &t.label).map(|l| width(l, TICK_SIZE)).fold(0.0, f64::max);
        (widest + 34.0).max(48.0).ceil()
    }

    /// Grid, frame, ticks, numbers and titles.
    pub fn draw(&self, scene: &mut Scene) {
        let (left, right, top, bottom) = (self.plot.left, self.plot.right(), self.plot.top, self.plot.bottom());
        let x_ticks = self.x.ticks((self.plot.width / 80.0).max(2.0));
        let y_ticks = self.y_ticks();
        let length = |t: &Tick| if t.label.is_some() { 5.0 } else { 3.0 };
        let inside = |t: &Tick| t.place > 0.002 && t.place < 0.998;
        let grid = |t: &Tick| Stroke::new(GRID, if t.label.is_some() { 0.8 } else { 0.4 });
        let shown = |axis: &Axis, t: &Tick| inside(t) && (t.label.is_some() || axis.scale == Scale::Logarithmic);
        for t in x_ticks.iter().filter(|t| shown(&self.x, t)) {
            let x = left + t.place * self.plot.width;
            scene.line((x, top), (x, bottom), grid(t));
        }
        for t in y_ticks.iter().filter(|t| shown(&self.y, t)) {
            let y = bottom - t.place * self.plot.height;
            scene.line((left, y), (right, y), grid(t));
        }
        let ink = |w: f64| Stroke::new(FRAME, w);
        let mut last = f64::NEG_INFINITY;
        for t in &x_ticks {
            let x = left + t.place * self.plot.width;
            scene.line((x, bottom), (x, bottom + length(t)), ink(1.0));
            let Some(label) = &t.label else { continue };
            let half = width(label, TICK_SIZE) / 2.0;
            // One at the end of the axis may be wider than the margin.
            let x = x.min(scene.width - half - EDGE).max(half + EDGE);
            if x - half > last + 6.0 {
                scene.words(Words::new(label, (x, bottom + 18.0), TICK_SIZE, INK).anchored(Anchor::Middle));
                last = x + half;
            }
        }
        let mut widest = 0.0f64;
        for t in &y_ticks {
            let y = bottom - t.place * self.plot.height;
            scene.line((left - length(t), y), (left, y), ink(1.0));
            if let Some(label) = &t.label {
                widest = widest.max(width(label, TICK_SIZE));
                scene.words(Words::new(label, (left - 8.0, y + 4.0), TICK_SIZE, INK).anchored(Anchor::End));
            }
        }
        scene.rectangle(&self.plot, None, Some(ink(1.0)));
        let middle = (left + self.plot.width / 2.0, bottom + 37.0);
        scene.words(Words::new(self.x.title(), middle, TITLE_SIZE, INK).anchored(Anchor::Middle));
        let middle = ((left - widest - 16.0).max(12.0), top + self.plot.height / 2.0);
        scene.words(Words::new(self.y.title(), middle, TITLE_SIZE, INK).anchored(Anchor::Middle).turned());
    }
}

/// What a heading says: the title, and lines of smaller words below it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Heading {
    /// The title.
    pub title: String,
    /// The smaller words.
    pub notes: Vec<String>,
}

impl Heading {
    /// Draws it from the top of the scene, in lines of the scene's width; returns where it ends.
    pub(super) fn draw(&self, scene: &mut Scene) -> f64 {
        let middle = scene.width / 2.0;
        let narrow = scene.width < 500.0;
        let mut y = 6.0;
        let mut lines = |text: &str, size: f64, colour: Colour| {
            for line in broken(text, scene.width - 20.0, size) {
                y += size + 5.0;
                scene.words(Words::new(line, (middle, y), size, colour).anchored(Anchor::Middle));
            }
        };
        if !self.title.is_empty() {
            lines(&self.title, if narrow { 13.0 } else { 14.0 }, INK);
        }
        for note in self.notes.iter().filter(|n| !n.is_empty()) {
            lines(note, 11.0, super::FAINT_INK);
        }
        y + 4.0
    }
}

/// Lines of at most `room` in width; a single word may be longer.
pub(super) fn broken(text: &str, room: f64, size: f64) -> Vec<String> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().expect("there is a line");
        if !last.is_empty() && width(&format!("{last} {word}"), size) > room {
            lines.push(word.to_owned());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines.retain(|l| !l.is_empty());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(unit: &str, range: (f64, f64), scale: Scale) -> Vec<String> {
        let axis = Axis { name: "x".into(), unit: unit.into(), range, scale };
        axis.ticks(6.0).into_iter().filter_map(|t| t.label).collect()
    }

    #[test]
    fn labels_are_round_numbers() {
        use Scale::{Linear, Logarithmic};
        assert_eq!(labels("", (0.0, 1.0), Linear), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels("", (-2.0, 2.0), Linear), ["\u{2212}2", "\u{2212}1", "0", "1", "2"]);
        assert_eq!(labels("s", (0.0, 0.07), Linear)[..3], ["0", "20", "40"]);
        assert_eq!(labels("Hz", (0.0, 60_000.0), Linear)[1], "10");
        assert_eq!(labels("", (1e-5, 0.1), Logarithmic), ["10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1"]);
        assert_eq!(labels("s", (1e-5, 0.1), Logarithmic), ["10 µs", "100 µs", "1 ms", "10 ms", "0.1 s"]);
        assert_eq!(labels("Hz", (10.0, 1e5), Logarithmic), ["10 Hz", "100 Hz", "1000 Hz", "10 kHz", "100 kHz"]);
        assert_eq!(labels("", (3.0, 7.0), Logarithmic).len(), 5);
        assert_eq!(labels("°", (-190.0, 0.0), Linear), ["\u{2212}180", "\u{2212}135", "\u{2212}90", "\u{2212}45", "0"]);
        assert_eq!(labels("", (1e-30, 1e30), Logarithmic).len(), 7);
        let spaced = |unit, range| labels(unit, range, Linear)[..2].join(" ").replace('\u{2212}', "-");
        assert_eq!(spaced("°", (-290.0, -80.0)), "-270 -225");
        assert_eq!(spaced("°", (-182.0, -138.0)), "-180 -170");
        assert_eq!(spaced("°", (-5000.0, 0.0)), "-4320 -3240");
        assert_eq!([spaced("dB", (-90.0, 45.0)), spaced("dB", (-3.0, 2.0))], ["-80 -40", "-3 -2"]);
    }

    #[test]
    fn a_title_has_its_unit_in_parentheses() {
        let title = |label, range| Axis::labelled(label, range, Scale::Linear).title();
        assert_eq!(title("omega (rad/s)", (0.0, 80.0)), "omega (rad/s)");
        assert_eq!(title("f (Hz)", (0.0, 80_000.0)), "f (kHz)");
        assert_eq!(title("Re z", (0.0, 1.0)), "Re z");
        assert_eq!(title("Re s (1/s)", (0.0, 1e9)), "Re s (1/s)");
    }

    proptest! {
        #[test]
        fn ticks_lie_in_order_inside_and_say_their_values(
            low in -1e3f64..1e3, decades in -9i32..9, span in 0.01f64..10.0, log: bool, count in 2.0f64..12.0,
        ) {
            let size = 10f64.powi(decades);
            let range = if log { (low.abs().max(1e-3) * size, low.abs().max(1e-3) * size * (1.5 + 100.0 * span)) }
                else { (low * size, (low + span) * size) };
            let scale = if log { Scale::Logarithmic } else { Scale::Linear };
            let axis = Axis { name: "x".into(), unit: String::new(), range, scale };
            let ticks = axis.ticks(count);
            prop_assert!(ticks.windows(2).all(|p| p[0].place < p[1].place));
            prop_assert!(ticks.iter().all(|t| (0.0..=1.0).contains(&t.place)));
            let named: Vec<&String> = ticks.iter().filter_map(|t| t.label.as_ref()).collect();
            prop_assert!(named.len() >= 2 || named.len() as f64 >= (count / 2.5).floor(), "{:?} {:?}", range, named);
            prop_assert!(named.len() as f64 <= 3.0 * count + 3.0, "{:?}", named);
            prop_assert!(named.windows(2).all(|p| p[0] != p[1]), "{:?} {:?}", range, named);
            if !log {
                let distances: Vec<f64> = ticks.windows(2).map(|p| p[1].place - p[0].place).collect();
                prop_assert!(distances.iter().all(|d| (d - distances[0]).abs() < 1e-6), "{:?}", distances);
            }
        }
    }
}
