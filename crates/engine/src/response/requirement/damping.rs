//! The damping of all roots: `cos` of the angle that they, or in discrete time `ln(z)`, make with the negative real axis.

use super::{Meaning, Requirement, RequirementKind, RequirementOption, Rule, refused};
use crate::error::Error;
use crate::model::requirements::DAMPING;
use jurist_algebra::number::Rational;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: DAMPING.name,
    about: DAMPING.about,
    option: Some(RequirementOption {
        value: "NUMBER",
        help: "Asks for a damping of all roots, in discrete time of the roots ln(z)/T",
    }),
    is_listed: true,
    sense: ">=",
    units: &[],
    meaning: |written| Ok(Meaning::Requirement(Requirement::damping(written.value.clone())?)),
    found: |_, _| None,
};

impl Requirement {
    /// By the damping, above 0 and below 1.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn damping(least: Rational) -> Result<Requirement, Error> {
        if !least.sign().is_gt() || least >= Rational::ONE {
            return Err(refused("a damping is above 0 and below 1"));
        }
        Ok(Requirement { kind: &KIND, asked: least.to_string(), rule: Rule::Sector(least) })
    }
}
