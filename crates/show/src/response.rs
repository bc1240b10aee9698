//! Margins and norms for people.

use super::bounded::at_least;
use super::intervals::heading;
use super::layout::{Columns, short, visible};
use super::margins::margin;
use super::verdict::verdict_line;
use super::{intervals, real};
use crate::Text;
use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal, to_decimal};
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, Frequency};
use jurist_engine::model::{Cut, Time};
use jurist_engine::problem::Problem;
use jurist_engine::response::{
    self, DelayMargin, Direction, Extreme, GainCrossing, HeldDelay, Margins, Norm, OneSided, PeakToPeak, PhaseMargin,
    Place, Rotation, StableMargins,
};
use jurist_engine::stability::{AbsoluteSum, End, Shape};

/// Digits of frequencies and decibels.
const PLACES: usize = 7;

/// Characters of a fraction that is written out.
const MOST_OF_A_FRACTION: usize = 40;

/// A name and a sentence for each margin, for a report; nothing for a loop that is not stable.
pub fn margin_sentences(answer: &Answer<Margins>, digits: usize) -> Vec<(&'static str, String)> {
    let margins = answer.value();
    margins.stable.as_ref().map(|stable| Writer { margins, digits }.sentences(stable)).unwrap_or_default()
}

impl Text for Answer<Margins> {
    /// The margins for people: a sentence for each, and the crossings.
    fn text(&self, digits: usize) -> String {
        let (problem, margins) = (self.problem(), self.value());
        let place = cut_text(margins.open_loop.cut());
        let mut out = format!("{}\ncut {place}\n{}\n\n", heading(problem), verdict_line(problem, &margins.verdict));
        if problem.model().hyperperiod() > 1 {
            out.push_str(&format!("a sample is one step of {} samples here\n", problem.model().hyperperiod()));
        }
        let writer = Writer { margins, digits };
        match &margins.stable {
            None => out.push_str("no margins: only a stable loop has them\n"),
            Some(stable) => {
                for (name, sentence) in writer.sentences(stable) {
                    out.push_str(&format!("{name}: {sentence}\n"));
                }
                let set = intervals::stable_lines("factor", &stable.gain.set, digits.min(PLACES));
                out.push_str(&format!("stable factors at the cut: {}\n", set.join("; ")));
            }
        }
        out.push_str(&writer.crossings());
        out
    }
}

/// Where the loop is cut.
pub(super) fn cut_text(cut: &Cut) -> String {
    let name = visible(cut.name()).into_owned();
    match cut {
        Cut::Signal(_) => format!("at the signal '{name}'"),
        Cut::Input(_) => format!("at the input of '{name}'"),
        Cut::PlantInput => format!("at the plant's input {name} = -K y"),
        Cut::Gain(_) => format!("at the gain '{name}'"),
        Cut::Between(_) => format!("between '{name}'"),
    }
}

struct Writer<'a> {
    margins: &'a Margins,
    digits: usize,
}

/// A decimal of what enclosures tell.
fn decimal(digits: usize, enclose: impl FnMut(u64) -> Option<Enclosure>) -> String {
    real::enclosed(digits, enclose).unwrap_or_default()
}

/// `12.5 Hz, 78.53982 rad/s`; the angle instead of the rate in discrete time.
fn frequency_text(at: impl Fn(u64) -> Option<Frequency>) -> Option<String> {
    Some(real::ShownFrequency::new(PLACES, at)?.words(PLACES, "rad per sample").join(", "))
}

impl Writer<'_> {
    fn shape(&self) -> Shape {
        self.margins.open_loop.shape()
    }

    /// `at 12.5 Hz, ...`.
    fn at(&self, place: Option<&Place>) -> String {
        match place {
            None => "at all frequencies".to_owned(),
            Some(Place::Highest) if self.shape() == Shape::LeftHalfPlane => {
                "as the frequency grows without end".to_owned()
            }
            Some(place) => match (place, frequency_text(|bits| self.margins.frequency(place, bits))) {
                (Place::Highest, Some(text)) => format!("at half the sampling frequency, {text}"),
                (Place::Lowest, _) => "at frequency 0".to_owned(),
                (_, text) => format!("at {}", text.unwrap_or_default()),
            },
        }
    }

    fn number(&self, x: &Real) -> String {
        real::rounded(x, self.digits).decimal
    }

    fn end(&self, end: &End) -> String {
        let decibels = margin(&end.value, Some(&Rational::ONE), PLACES).and_then(|m| m.decibels);
        let decibels = decibels.map(|d| format!(" ({d} dB)")).unwrap_or_default();
        let place = frequency_text(|bits| self.margins.frequency_of(end, bits));
        let place = place.map(|p| format!(" at {p}")).unwrap_or_default();
        format!("{}{decibels}: {}{place}", real::rounded(&end.value, self.digits).decimal, end.causes)
    }

    /// What can be pasted into a review.
    fn sentences(&self, margins: &StableMargins) -> Vec<(&'static str, String)> {
        let digits = self.digits;
        let upper = match &margins.gain.upper {
            None => "none, every greater gain is stable".to_owned(),
            Some(end) => self.end(end),
        };
        let lower = match &margins.gain.lower {
            None => "none, every lower gain is stable, down to the open loop".to_owned(),
            Some(end) if end.value.sign().is_eq() => "none, every lower gain above 0 is stable".to_owned(),
            Some(end) => self.end(end),
        };
        let phase = match (&margins.phase, &margins.one_sided) {
            (PhaseMargin::Angle { .. }, Some(OneSided { lag: Some(lag), lead: Some(lead), .. })) => {
                format!("{}; {}", self.rotation(lag, "lag"), self.rotation(lead, "lead"))
            }
            (PhaseMargin::Unbounded, _) => "none, the open loop's magnitude is nowhere 1".to_owned(),
            (angle @ PhaseMargin::Angle { place, .. }, _) => {
                format!("{} degrees {}", decimal(digits, |bits| angle.degrees(bits)), self.at(place.as_ref()))
            }
        };
        let modulus = format!(
            "{} {}; the peak of the sensitivity is {}",
            self.number(&margins.modulus),
            self.extreme(&margins.modulus_at),
            self.number(&margins.peak_sensitivity)
        );
        let complementary =
            format!("{} {}", self.number(&margins.peak_complementary), self.extreme(&margins.complementary_at));
        vec![
            ("upper gain margin", upper),
            ("lower gain margin", lower),
            ("phase margin", phase),
            ("delay margin", self.delay(&margins.delay)),
            ("modulus margin", modulus),
            ("peak of the complementary sensitivity", complementary),
            ("disk margin", self.disk(&margins.disk)),
        ]
    }

    fn rotation(&self, rotation: &Rotation, sense: &str) -> String {
        let degrees = decimal(self.digits, |bits| Some(rotation.degrees(bits)));
        format!("{degrees} degrees of {sense} {}", self.at(rotation.place.as_ref()))
    }

    fn extreme(&self, extreme: &Extreme) -> String {
        match extreme {
            Extreme::At { attained: false, .. } => "approached as the frequency grows without end".to_owned(),
            other => self.at(other.place()),
        }
    }

    fn delay(&self, delay: &DelayMargin) -> String {
        let samples = |m: u64| if m == 1 { "1 sample".to_owned() } else { format!("{m} samples") };
        let whole = match delay {
            DelayMargin::Unbounded if delay.is_in_samples(&self.margins.open_loop) => {
                "none, the loop is stable with any number of whole samples".to_owned()
            }
            DelayMargin::Unbounded => "none, the loop is stable with any delay".to_owned(),
            DelayMargin::Zero => "0, the open loop's magnitude does not fall below 1 at high frequencies".to_owned(),
            DelayMargin::SamplesAtLeast(m) => format!("at least {}", samples(*m)),
            DelayMargin::Samples(0) => "0 samples; with one more sample of delay the loop is not stable".to_owned(),
            DelayMargin::Samples(m) => {
                let time = self.margins.open_loop.sample_time();
                let time =
                    time.map(|t| format!(" ({} s)", short(&(t * &Rational::from(*m as i64))))).unwrap_or_default();
                format!("{}{time}; with one more the loop is not stable", samples(*m))
            }
            DelayMargin::DeadTime(i) => {
                let crossing = &self.margins.crossings.gain[*i];
                let seconds = decimal(self.digits, |bits| crossing.delay(self.margins.open_loop.frequencies(), bits));
                format!("less than {seconds} s of dead time, {}", self.at(Some(&crossing.place)))
            }
        };
        self.margins.held_delay.as_ref().map_or(whole.clone(), |held| format!("{whole}; {}", self.held(held)))
    }

    fn held(&self, held: &HeldDelay) -> String {
        let block = visible(&held.block);
        let Some(seconds) = real::enclosed(self.digits, |bits| held.seconds(bits)) else {
            return format!("any dead time up to {} samples at the input of '{block}'", HeldDelay::MOST);
        };
        let place = match held.is_on_edge {
            true => ", where a sample falls on an edge of its pulse and the model is undefined".to_owned(),
            false => frequency_text(|bits| held.frequency(bits)).map(|p| format!(", at {p}")).unwrap_or_default(),
        };
        format!("less than {seconds} s of dead time at the input of '{block}'{place}")
    }

    fn disk(&self, disk: &response::DiskMargin) -> String {
        let Some(alpha) = &disk.alpha else { return "none, no factor of the disk makes the loop unstable".to_owned() };
        let greatest = real::enclosed(PLACES, |bits| disk.gains(bits).1);
        let place = disk.extreme.as_ref().map(|e| self.extreme(e)).unwrap_or_default();
        let skew = if disk.skew.is_zero() { String::new() } else { format!(" (skew {})", short(&disk.skew)) };
        format!(
            "{}{skew} {place}; gains alone from {} to {}, phases alone up to {} degrees",
            self.number(alpha),
            decimal(PLACES, |bits| Some(disk.gains(bits).0)),
            greatest.unwrap_or_else(|| "infinity".to_owned()),
            decimal(PLACES, |bits| Some(disk.degrees(bits))),
        )
    }

    /// The phase divided by the frequency, in samples and in seconds.
    fn delay_at(&self, c: &GainCrossing) -> Option<String> {
        let delay = |bits| c.delay(self.margins.open_loop.frequencies(), bits);
        let narrow = delay(real::bits_for(PLACES) + 16)?;
        let text = real::enclosed_in(PLACES, &narrow, delay)?;
        if self.shape() == Shape::LeftHalfPlane {
            return Some(format!("PM/omega {text} s"));
        }
        let Some(period) = self.margins.open_loop.sample_time() else {
            return Some(format!("PM/omega {text} samples"));
        };
        let period = Enclosure::from_rational(period.clone());
        let narrow = narrow.mul(&period, real::bits_for(PLACES));
        let seconds = real::enclosed_in(PLACES, &narrow, |bits| Some(delay(bits + 16)?.mul(&period, bits)))?;
        Some(format!("PM/omega {text} samples = {seconds} s"))
    }

    fn crossings(&self) -> String {
        let crossings = &self.margins.crossings;
        let mut columns = Columns::new("    ");
        if crossings.gain_everywhere {
            columns.row(["magnitude 1".to_owned(), "at all frequencies".to_owned()]);
        }
        for c in &crossings.gain {
            let margin = decimal(PLACES, |bits| Some(response::degrees(&c.phase(bits + 16), bits)));
            let delay = self.delay_at(c).unwrap_or_default();
            let way = match c.direction {
                Direction::Falling => "falling",
                Direction::Rising => "rising",
                Direction::Touching => "touching",
            };
            columns.row([
                "magnitude 1".to_owned(),
                self.at(Some(&c.place)),
                format!("PM {margin} degrees"),
                delay,
                way.to_owned(),
            ]);
        }
        if crossings.phase_everywhere {
            columns.row(["real".to_owned(), "at all frequencies".to_owned()]);
        }
        for c in &crossings.phase {
            let factor = decimal(PLACES, |bits| Some(c.factor.enclosure(bits)));
            columns.row(["phase -180".to_owned(), self.at(Some(&c.place)), format!("factor {factor}")]);
        }
        let is_delayed = self.margins.open_loop.dead_time().is_some();
        match columns.is_empty() {
            // Its phase turns without end, so that there are crossings where the open loop is small.
            true if is_delayed => {
                "crossings of the open loop: none that is listed, its magnitude is too small\n".to_owned()
            }
            true => "no crossings\n".to_owned(),
            false => format!("crossings of the open loop\n{columns}"),
        }
    }
}

impl Text for Answer<Norm> {
    /// The norm for people.
    fn text(&self, digits: usize) -> String {
        format!("{}\n{}\n", heading(self.problem()), norm_line(self.problem(), self.value(), digits))
    }
}

fn norm_line(problem: &Problem, norm: &Norm, digits: usize) -> String {
    let Some(peak) = &norm.peak else {
        return format!("{}\nno norm: only a stable loop has one", verdict_line(problem, &norm.verdict));
    };
    let place = match &peak.extreme {
        Extreme::At { attained: false, .. } => "approached as the frequency grows without end".to_owned(),
        Extreme::Constant(_) => "at all frequencies".to_owned(),
        Extreme::At { place: Place::Lowest, .. } => "at frequency 0".to_owned(),
        _ => format!("at {}", frequency_text(|bits| norm.frequency(bits)).unwrap_or_default()),
    };
    let value = real::rounded(&peak.value, digits).decimal;
    let decibels = margin(&peak.value, Some(&Rational::ONE), PLACES).and_then(|m| m.decibels);
    let decibels = decibels.map(|d| format!(" ({d} dB)")).unwrap_or_default();
    let (input, output) = (visible(&norm.input), visible(&norm.output));
    format!("peak gain from {input} to {output}: {value}{decibels} {place}")
}

impl Text for Answer<PeakToPeak> {
    /// The gain for people, and what it bounds.
    fn text(&self, digits: usize) -> String {
        let (problem, found) = (self.problem(), self.value());
        let Some(gain) = &found.gain else {
            let verdict = verdict_line(problem, &found.verdict);
            return format!("{}\n{verdict}\nno peak-to-peak gain: only a stable loop has one\n", heading(problem));
        };
        let (input, output) = (visible(&found.input), visible(&found.output));
        let (value, bound) = (gain_decimal(gain, digits), at_least(&gain.upper, digits));
        let (exact, how) = match &gain.exact {
            Some(x) if x.is_integer() => (String::new(), String::new()),
            Some(x) if x.to_string().len() <= MOST_OF_A_FRACTION => (format!(", exactly {x}"), String::new()),
            Some(_) => (String::new(), "it is a rational number, which '--json' writes\n".to_owned()),
            None => (
                String::new(),
                match problem.time() {
                    Time::Discrete => {
                        format!("{} samples of the impulse response, and a bound of all that follow\n", gain.terms)
                    }
                    Time::Continuous => {
                        format!("{} steps along the impulse response, and a bound of all that follows\n", gain.terms)
                    }
                },
            ),
        };
        format!(
            "{}\npeak-to-peak gain (l1 norm) from {input} to {output}: {value}{exact}\n\
             from rest |{output}| <= {bound} max |{input}|, and inputs come as near to the gain as wished\n{how}",
            heading(problem)
        )
    }
}

/// The gain correctly rounded; next to a tie either neighbour.
pub(super) fn gain_decimal(gain: &AbsoluteSum, digits: usize) -> String {
    enclosed_decimal(&gain.lower, &gain.upper, digits)
        .unwrap_or_else(|| to_decimal(&gain.lower.midpoint(&gain.upper), digits))
}
