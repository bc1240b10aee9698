//! The settling time: all modes have decayed by `exp(-4)`, to 1.8 %.

use super::{Meaning, Requirement, RequirementKind, RequirementOption, Rule, Written, not_understood, refused};
use crate::error::Error;
use crate::model::Time;
use crate::model::requirements::SETTLING_TIME;
use crate::problem::{Bound, Region};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::symbols::{Definition, Symbols};

pub(super) const KIND: RequirementKind = RequirementKind {
    name: SETTLING_TIME.name,
    about: SETTLING_TIME.about,
    option: Some(RequirementOption {
        value: "TIME",
        help: "Asks for a settling time: a decay of 4 over it, in discrete time a radius of exp(-4 T/time)",
    }),
    is_listed: false,
    sense: "<=",
    units: &[],
    meaning,
    found: |_, _| None,
};

fn meaning(written: &Written<'_>) -> Result<Meaning, Error> {
    let value = &written.value;
    if !value.sign().is_gt() {
        return Err(not_understood(KIND.name, "a settling time is above 0"));
    }
    match written.time {
        Time::Continuous => {
            let rate = Rational::from(4).checked_div(value).expect("positive");
            // Of a decay rate that is asked for too, the greater one counts.
            let least = match written.region.map(Region::bound) {
                Some(Bound::Number(decay)) => decay.clone().max(rate),
                _ => rate,
            };
            Ok(Meaning::Region(Region::half_plane(least)))
        }
        Time::Discrete => {
            let step = match (written.sample_time)() {
                Ok(Some(step)) => step,
                Ok(None) => return Err(not_understood(KIND.name, "a settling time needs the loop's sample time")),
                Err(Error::Undefined(_)) => {
                    let why = "a settling time needs a number as the sample time; this sample time depends on the free parameter";
                    return Err(not_understood(KIND.name, why));
                }
                Err(error) => return Err(error),
            };
            Ok(Meaning::Requirement(Requirement::settling_time(value.clone(), &step)?))
        }
    }
}

impl Requirement {
    /// By the time, above 0, in which all modes of a discrete loop with this sample time have decayed by `exp(-4)`, to 1.8 %.
    ///
    /// # Errors
    /// `E-require` for other numbers.
    pub fn settling_time(time: Rational, step: &Rational) -> Result<Requirement, Error> {
        if !time.sign().is_gt() || !step.sign().is_gt() {
            return Err(refused("a settling time and its sample time are above 0"));
        }
        let exponent = (&Rational::from(-4) * step).checked_div(&time).expect("positive");
        Ok(Requirement { kind: &KIND, asked: time.to_string(), rule: Rule::Modulus { exponent } })
    }
}

/// A rational number of few digits just below `exp(exponent)`, by at most so many binary digits.
pub fn radius_below(exponent: &Rational, bits: u64) -> Rational {
    let mut symbols = Symbols::new();
    let radius = symbols.insert("X", Definition::exponential(exponent.clone()));
    let low = symbols.values(bits + 8)[radius].lower();
    Rational::dyadic(&(low * Rational::from(Integer::ONE << bits)).floor(), bits)
}
