//! The disk margin: stable with every factor `(1 + delta/2)/(1 - delta/2)`, `|delta| < alpha`, at the cut.

use super::{Circle, Found, Meaning, Requirement, RequirementKind, RequirementOption, Rule, refused};
use crate::error::Error;
use crate::model::requirements::DISK_MARGIN;
use jurist_algebra::number::Rational;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: DISK_MARGIN.name,
    about: DISK_MARGIN.about,
    option: Some(RequirementOption {
        value: "ALPHA",
        help: "Asks for a balanced disk margin: the least 2 |1 + L|/|1 - L|",
    }),
    is_listed: true,
    sense: ">=",
    units: &[],
    meaning: |written| Ok(Meaning::Requirement(Requirement::disk_margin(written.value.clone())?)),
    found: |_, stable| Some(Found::Number(stable.disk.alpha.clone()?)),
};

impl Requirement {
    /// By the size of the balanced disk, above 0.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn disk_margin(alpha: Rational) -> Result<Requirement, Error> {
        if !alpha.sign().is_gt() {
            return Err(refused("a disk margin is above 0"));
        }
        let half = &alpha * &Rational::new(1.into(), 2.into());
        Ok(Requirement { kind: &KIND, asked: alpha.to_string(), rule: Rule::Circle(Circle::new([1, -1], half, alpha)) })
    }
}
