//! The modulus margin: `|1 + L|` is nowhere below a number.

use super::{Circle, Found, Meaning, Requirement, RequirementKind, RequirementOption, Rule, refused};
use crate::error::Error;
use crate::model::requirements::MODULUS_MARGIN;
use jurist_algebra::number::Rational;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: MODULUS_MARGIN.name,
    about: MODULUS_MARGIN.about,
    option: Some(RequirementOption { value: "NUMBER", help: "Asks for a modulus margin: the least |1 + L|" }),
    is_listed: true,
    sense: ">=",
    units: &[],
    meaning: |written| Ok(Meaning::Requirement(Requirement::modulus_margin(written.value.clone())?)),
    found: |_, stable| Some(Found::Number(stable.modulus.clone())),
};

impl Requirement {
    /// By the least value of `|1 + L|`, above 0.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn modulus_margin(least: Rational) -> Result<Requirement, Error> {
        if !least.sign().is_gt() {
            return Err(refused("a modulus margin is above 0"));
        }
        Ok(Requirement {
            kind: &KIND,
            asked: least.to_string(),
            rule: Rule::Circle(Circle::new([1, 0], least.clone(), least)),
        })
    }
}
