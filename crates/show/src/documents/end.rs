//! Ends of intervals.

use super::number::{Enclosure, Exact, Number, enclosure};
use crate::margins::margin;
use crate::real::{self, JSON_NUMBER_DIGITS};
use crate::region;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::answer::Frequency;
use jurist_engine::problem::Problem;
use jurist_engine::stability::{self, Range};
use serde::{Deserialize, Serialize};

/// An interval; `null` where it is unbounded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "BoundsOf{T}"))]
pub struct Bounds<T> {
    /// The lower end; `null` where there is none.
    pub lower: Option<T>,
    /// The upper end; `null` where there is none.
    pub upper: Option<T>,
}

impl From<&Range> for Bounds<Exact> {
    fn from(range: &Range) -> Self {
        Bounds { lower: range.lower.as_ref().map(Exact::from), upper: range.upper.as_ref().map(Exact::from) }
    }
}

/// An end of which only the place is known.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlainEnd {
    /// The value.
    #[serde(flatten)]
    pub number: Number,
    /// Whether the end belongs to the set.
    pub closed: bool,
}

impl PlainEnd {
    pub(super) fn new(value: impl Into<Real>, digits: usize) -> Self {
        PlainEnd { number: Number::new(&value.into(), digits), closed: false }
    }

    /// A union of open intervals.
    pub(super) fn intervals(set: impl Iterator<Item = [Option<Real>; 2]>, digits: usize) -> Vec<Bounds<PlainEnd>> {
        let end = |value: Option<Real>| value.map(|value| PlainEnd::new(value, digits));
        set.map(|[lower, upper]| Bounds { lower: end(lower), upper: end(upper) }).collect()
    }
}

/// Where the complex pair is that reaches the boundary, the lowest frequency if there are several; all `null` where no
/// pair does. Numbers are rounded to the digits asked for, at most 17.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FrequencyOfPair {
    /// In hertz; `null` also in discrete time without a sample time.
    pub frequency_hz: Option<serde_json::Number>,
    /// Certified bounds of the frequency in hertz.
    pub frequency_enclosure: Option<Enclosure>,
    /// In radians per second; `null` also in discrete time without a sample time.
    pub radians_per_second: Option<serde_json::Number>,
    /// The angle of the upper root in radians; `null` also in continuous time. Of one complex root, of a loop with complex coefficients, the
    /// angle and the frequencies have its sign.
    pub angle: Option<serde_json::Number>,
}

impl FrequencyOfPair {
    /// From enclosures as narrow as so many bits.
    pub(super) fn new(digits: usize, at: impl Fn(u64) -> Option<Frequency>) -> Self {
        let places = digits.min(JSON_NUMBER_DIGITS);
        let frequency = real::ShownFrequency::new(digits, at);
        let pick = |part| real::json_number(&frequency.as_ref()?.decimal(places, part)?);
        let hertz = frequency.as_ref().and_then(|f| f.enclosed().hertz.as_ref());
        FrequencyOfPair {
            frequency_hz: pick(|f| f.hertz.clone()),
            frequency_enclosure: hertz.map(|e| enclosure(e.lower(), e.upper())),
            radians_per_second: pick(|f| f.radians_per_second.clone()),
            angle: pick(|f| f.angle.clone()),
        }
    }
}

/// An end of stability.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct End {
    /// The value, in the parameter's unit.
    #[serde(flatten)]
    pub number: Number,
    /// Why stability ends: `z=1`, `z=-1`, `complex pair`, `complex root` (one without its conjugate), `s=0`, `infinity` (the degree is lost), `neutral`
    /// (infinitely many roots reach the boundary), `pole` (undefined there), `square root` (undefined beyond: the
    /// number under a square root is negative), `duty` (no pulse, or no pause, of a modulator is left), `domain`; several are joined by `+` in this order.
    /// `undecided` alone: no limit, but where a bracket begins in which nothing is known.
    pub cause: String,
    /// The same with the points where the loop's own roots are; only where a smaller region is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundary: Option<String>,
    /// The requirements that are not met beyond, joined by `+`; left out where none binds. `cause` is empty where one does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub requirement: Option<String>,
    /// Where the complex pair is.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
    /// Whether the end belongs to the set.
    pub closed: bool,
    /// The end divided by the nominal value: exact where the end is rational, else rounded. `null` without a nominal
    /// value, and where no positive factor leads to the end.
    pub margin_factor: Option<String>,
    /// The factor in decibels, rounded; `null` also for a factor of 0.
    pub margin_db: Option<serde_json::Number>,
}

impl End {
    pub(super) fn new(end: &stability::End, problem: &Problem, digits: usize) -> Self {
        // What is only the end of what is known is no margin.
        let nominal = problem.free().first().and_then(|f| f.nominal.as_ref());
        let nominal = nominal.filter(|_| !end.causes.contains(stability::Cause::Undecided));
        let margin = margin(&end.value, nominal, digits);
        End {
            number: Number::new(&end.value, digits),
            cause: end.causes.to_string(),
            boundary: region::exact_boundary(&end.causes, problem),
            requirement: None,
            frequency: FrequencyOfPair::new(digits, |bits| problem.frequency(end, bits)),
            closed: end.closed,
            margin_db: margin.as_ref().and_then(|m| real::json_number(m.decibels.as_deref()?)),
            margin_factor: margin.map(|m| m.factor),
        }
    }

    /// An end at which requirements bind.
    pub(super) fn of_requirement(value: &Real, names: String, closed: bool, problem: &Problem, digits: usize) -> Self {
        let margin = margin(value, problem.free().first().and_then(|f| f.nominal.as_ref()), digits);
        End {
            number: Number::new(value, digits),
            cause: String::new(),
            boundary: None,
            requirement: Some(names),
            frequency: FrequencyOfPair::default(),
            closed,
            margin_db: margin.as_ref().and_then(|m| real::json_number(m.decibels.as_deref()?)),
            margin_factor: margin.map(|m| m.factor),
        }
    }

    /// An end of the stable factors at a cut, of which 1 is nominal.
    pub(super) fn of_factor(end: &stability::End, digits: usize, at: impl Fn(u64) -> Option<Frequency>) -> Self {
        let margin = margin(&end.value, Some(&Rational::ONE), digits);
        End {
            number: Number::new(&end.value, digits),
            cause: end.causes.to_string(),
            boundary: None,
            requirement: None,
            frequency: FrequencyOfPair::new(digits, at),
            closed: false,
            margin_db: margin.as_ref().and_then(|m| real::json_number(m.decibels.as_deref()?)),
            margin_factor: margin.map(|m| m.factor),
        }
    }

    /// A stable set: each end with its cause, frequency and margin.
    pub(super) fn intervals(set: &stability::StableSet, problem: &Problem, digits: usize) -> Vec<Bounds<End>> {
        let end = |end: &Option<stability::End>| end.as_ref().map(|end| End::new(end, problem, digits));
        let interval = |i: &stability::StableInterval| Bounds { lower: end(&i.lower), upper: end(&i.upper) };
        set.intervals().iter().map(interval).collect()
    }
}
