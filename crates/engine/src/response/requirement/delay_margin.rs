//! The delay margin: stable with all less dead time at the cut, at the input of a plant behind a hold and in continuous time; else with
//! so much delay in whole samples.

use super::{Found, Meaning, Requirement, RequirementKind, RequirementOption, Rule, refused};
use crate::error::Error;
use crate::model::requirements::DELAY_MARGIN;
use jurist_algebra::number::Rational;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: DELAY_MARGIN.name,
    about: DELAY_MARGIN.about,
    option: Some(RequirementOption { value: "TIME", help: "Asks for a delay margin: dead time in units of time" }),
    is_listed: false,
    sense: ">=",
    units: &[],
    meaning: |written| Ok(Meaning::Requirement(Requirement::delay_margin(written.value.clone())?)),
    found: |margins, _| Some(Found::Enclosed(Box::new(|bits| margins.delay_seconds(bits)))),
};

impl Requirement {
    /// By a dead time above 0, in units of time.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn delay_margin(least: Rational) -> Result<Requirement, Error> {
        if !least.sign().is_gt() {
            return Err(refused("a delay margin is above 0"));
        }
        Ok(Requirement { kind: &KIND, asked: least.to_string(), rule: Rule::DeadTime(least) })
    }
}
