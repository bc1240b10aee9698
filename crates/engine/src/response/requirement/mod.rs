//! The requirements on a loop: one list, of which the keys of `[require]`, the command line's options, the documents, Python's
//! keywords and the documentation's table are made.
//!
//! Each requirement is a file with a [`RequirementKind`]: its words, how a number in a text becomes a [`Rule`], and which margin of a loop
//! answers it. Its key stands in [`crate::model::requirements`]. A rule says what is decided; several requirements can share one.

mod circle;
mod complementary_peak;
mod damping;
mod decay;
mod delay_margin;
mod disk_margin;
mod gain_margin;
#[cfg(test)]
mod lists;
mod modulus_margin;
mod norm;
mod phase_margin;
mod radius;
mod settling_time;

pub use circle::Circle;

pub use settling_time::radius_below;

use super::{Margins, StableMargins};
use crate::coverage::refusals::REQUIREMENT_NOT_CERTIFIED;
use crate::error::{Code, Diagnostic, Error};
use crate::model::requirements::ALL as KEYS;
use crate::model::{Between, Cut, Time};
use crate::problem::{Problem, Region};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational, parse_number, to_decimal};
use jurist_algebra::poly::RealAlgebraic;
use jurist_algebra::real::Real;

/// All requirements, in the order of the keys of `[require]`.
const LIST: [&RequirementKind; KEYS.len()] = [
    &gain_margin::KIND,
    &phase_margin::KIND,
    &modulus_margin::KIND,
    &complementary_peak::KIND,
    &disk_margin::KIND,
    &delay_margin::KIND,
    &damping::KIND,
    &decay::KIND,
    &radius::KIND,
    &settling_time::KIND,
];

/// An entry of the list of requirements.
///
/// ```
/// use jurist_engine::response::RequirementKind;
/// let names: Vec<&str> = RequirementKind::all().iter().map(|kind| kind.name).collect();
/// assert!(names.contains(&"phase_margin") && names.contains(&"settling_time"));
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct RequirementKind {
    /// Its key in `[require]` and its name in documents; with dashes its option.
    pub name: &'static str,
    /// The number that it takes, for people.
    pub about: &'static str,
    /// The option of commands that decide requirements; `None` of a region, which has an option on every command.
    pub option: Option<RequirementOption>,
    /// Whether a map takes several at once.
    pub is_listed: bool,
    /// How the loop's number compares with the required one: `>=`, `<=`, or `>` where the number itself is too little.
    sense: &'static str,
    /// Units that may follow the number.
    units: &'static [&'static str],
    /// The meaning of a number.
    meaning: fn(&Written<'_>) -> Result<Meaning, Error>,
    /// The loop's own number.
    found: for<'a> fn(&'a Margins, &'a StableMargins) -> Option<Found<'a>>,
}

impl RequirementKind {
    /// The whole list, in the order in which requirements are decided.
    pub fn all() -> &'static [&'static RequirementKind] {
        const { &LIST }
    }

    /// The number of a text, and the unit that follows it.
    pub(super) fn split<'t>(&self, text: &'t str) -> (&'t str, Option<&'static str>) {
        let text = text.trim();
        let with = self.units.iter().find_map(|unit| Some((text.strip_suffix(unit)?.trim_end(), *unit)));
        with.map_or((text, None), |(number, unit)| (number, Some(unit)))
    }

    /// True if a unit may follow the number.
    pub(super) fn needs_unit(&self) -> bool {
        !self.units.is_empty()
    }

    /// What a number asks for.
    pub(super) fn meaning(&self, written: &Written<'_>) -> Result<Meaning, Error> {
        (self.meaning)(written)
    }
}

/// How a requirement is asked for on the command line.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct RequirementOption {
    /// The value's name in the help.
    pub value: &'static str,
    /// The help.
    pub help: &'static str,
}

/// A number that is required, with what it is read beside.
pub(super) struct Written<'a> {
    pub value: Rational,
    pub unit: Option<&'static str>,
    pub time: Time,
    /// The region that is asked for so far.
    pub region: Option<&'a Region>,
    /// The loop's sample time, if it has one.
    pub sample_time: &'a dyn Fn() -> Result<Option<Rational>, Error>,
    pub budget: &'a Budget,
}

/// What a required number means.
pub(super) enum Meaning {
    Requirement(Requirement),
    /// A smaller region for all roots.
    Region(Region),
}

/// The number of a loop that a requirement is about.
pub enum Found<'a> {
    /// As a number.
    Number(Real),
    /// By enclosures of so many bits; `None` where there is no bound.
    Enclosed(Box<dyn Fn(u64) -> Option<Enclosure> + 'a>),
}

/// What is required of a loop beyond its stability.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_engine::response::Requirement;
/// let half = Requirement::phase_margin(&Rational::from(60)).unwrap();
/// assert_eq!(half.name(), "phase_margin");
/// assert!(Requirement::damping(Rational::from(2)).is_err());
/// ```
#[derive(Clone, Debug)]
pub struct Requirement {
    kind: &'static RequirementKind,
    /// How it was asked for.
    asked: String,
    rule: Rule,
}

/// What is decided.
#[derive(Clone, Debug)]
pub enum Rule {
    /// Stable for all factors from the inverse of this to itself; above 1.
    Factors(RealAlgebraic),
    /// Stable however the open loop is turned by less than the angle with this as twice its cosine.
    Turned {
        /// Twice the cosine of the angle.
        twice_cosine: RealAlgebraic,
    },
    /// The open loop keeps to one side of a circle.
    Circle(Circle),
    /// Stable with all less dead time at the cut.
    DeadTime(Rational),
    /// All roots, in discrete time their logarithms, make an angle with the negative real axis whose cosine is at least this.
    Sector(Rational),
    /// All roots have a modulus of at most the exponential of this.
    Modulus {
        /// The logarithm of the modulus.
        exponent: Rational,
    },
}

impl Requirement {
    /// Its name in model files and documents.
    pub fn name(&self) -> &'static str {
        self.kind.name
    }

    /// What is required, as it was asked for.
    pub fn required(&self) -> String {
        self.asked.clone()
    }

    /// `phase_margin >= 45 deg`.
    pub fn text(&self) -> String {
        format!("{} {} {}", self.name(), self.kind.sense, self.asked)
    }

    /// The required number in the unit of the loop's own: a factor, degrees, a dead time; rounded where it is not rational. `None` of
    /// roots.
    pub fn required_number(&self, digits: usize) -> Option<Rational> {
        match &self.rule {
            Rule::Factors(factor) => parse_number(&factor.decimal(digits)).ok(),
            Rule::Turned { .. } => parse_number(self.kind.split(self.asked.split(ROUNDED).next()?).0).ok(),
            Rule::Circle(circle) => Some(circle.asked().clone()),
            Rule::DeadTime(least) => Some(least.clone()),
            Rule::Sector(_) | Rule::Modulus { .. } => None,
        }
    }

    /// What is decided.
    pub fn rule(&self) -> &Rule {
        &self.rule
    }

    /// The number of a stable loop that it is about; `None` where it is not about margins.
    pub(crate) fn found<'a>(&self, margins: &'a Margins, stable: &'a StableMargins) -> Option<Found<'a>> {
        (self.kind.found)(margins, stable)
    }

    /// Whether the loop's number is to be at least the required one, not at most.
    pub fn is_least(&self) -> bool {
        self.kind.sense.starts_with('>')
    }

    /// The signals between which it is, where it is not about the loop at a cut.
    pub(crate) fn signals(&self) -> Option<&Between> {
        let Rule::Circle(circle) = &self.rule else { return None };
        circle.signals()
    }

    /// Where the loop is cut for it.
    pub(crate) fn cut(&self, problem: &Problem, at: Option<&str>) -> Result<Cut, Error> {
        Ok(match self.signals() {
            Some(between) => Cut::Between(between.clone()),
            None => problem.model().cut(at)?,
        })
    }

    /// A refusal of requirements that are not about the loop at a cut.
    pub(crate) fn refuse_signals(list: &[Requirement]) -> Result<(), Error> {
        match list.iter().find(|requirement| requirement.signals().is_some()) {
            Some(requirement) => Err(super::required_set::not_decided(requirement)),
            None => Ok(()),
        }
    }

    /// The refusal of a certificate of a requirement that has none.
    ///
    /// # Errors
    /// `E-no-certificate` unless the requirement is stability for all factors at a cut, or of the variable.
    ///
    /// ```
    /// use jurist_engine::model::Time;
    /// use jurist_engine::response::Requirement;
    /// let half = Requirement::delay_margin("1/2".parse().unwrap()).unwrap();
    /// assert!(half.refuse_uncertified(Time::Continuous).is_ok());
    /// assert!(half.refuse_uncertified(Time::Discrete).is_err());
    /// ```
    pub fn refuse_uncertified(&self, time: Time) -> Result<(), Error> {
        let has_certificate = match self.rule {
            Rule::Factors(_) | Rule::Turned { .. } | Rule::Circle(_) => self.signals().is_none(),
            Rule::DeadTime(_) | Rule::Sector(_) => time == Time::Continuous,
            Rule::Modulus { .. } => true,
        };
        match has_certificate {
            true => Ok(()),
            false => Err(REQUIREMENT_NOT_CERTIFIED.diagnostic(&[("asked", &self.text())]).into()),
        }
    }

    /// Whether it is about the dead time that the loop bears.
    pub fn is_delay_margin(&self) -> bool {
        matches!(self.rule, Rule::DeadTime(_))
    }

    /// Whether it begins or ceases to be met on a curve that is not algebraic: a map of it is made of boxes.
    pub(crate) fn has_no_curve(&self, time: Time) -> bool {
        match self.rule {
            Rule::DeadTime(_) | Rule::Modulus { .. } => true,
            Rule::Sector(_) => time == Time::Discrete,
            Rule::Factors(_) | Rule::Turned { .. } | Rule::Circle(_) => false,
        }
    }

    /// Whether it is about the open loop at a cut.
    pub(crate) fn needs_cut(&self) -> bool {
        !matches!(self.rule, Rule::Sector(_) | Rule::Modulus { .. })
    }
}

/// Polynomials of greater degree are not made of an angle or of decibels.
const MOST_DEGREE: usize = 24;

/// What is said of a number that is rounded, since the exact one is of a higher degree or not algebraic.
const ROUNDED: &str = " (rounded up by less than 1e-30)";

/// A number as it was written: a decimal where that is short.
fn as_written(number: &Rational) -> String {
    let decimal = to_decimal(number, DIGITS_WRITTEN);
    match parse_number(&decimal) {
        Ok(same) if same == *number => decimal,
        _ => number.to_string(),
    }
}

/// Decimals of more digits stay fractions.
const DIGITS_WRITTEN: usize = 20;

fn refused(message: &str) -> Error {
    Diagnostic::error(Code::Require, message).into()
}

/// The refusal of a number, or of what is missing beside it.
pub(super) fn not_understood(name: &str, why: &str) -> Error {
    Diagnostic::error(Code::Require, format!("{name}: {why}")).into()
}
