//! The peak of the complementary sensitivity: `|L/(1 + L)|` is nowhere above a number.

use super::{Circle, Found, Meaning, Requirement, RequirementKind, RequirementOption, Rule, refused};
use crate::error::Error;
use crate::model::requirements::COMPLEMENTARY_PEAK;
use jurist_algebra::number::Rational;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: COMPLEMENTARY_PEAK.name,
    about: COMPLEMENTARY_PEAK.about,
    option: Some(RequirementOption { value: "M", help: "Asks for a peak of |L/(1 + L)| of at most this" }),
    is_listed: true,
    sense: "<=",
    units: &[],
    meaning: |written| Ok(Meaning::Requirement(Requirement::complementary_peak(written.value.clone())?)),
    found: |_, stable| Some(Found::Number(stable.peak_complementary.clone())),
};

impl Requirement {
    /// By the greatest value of `|L/(1 + L)|`, above 0.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn complementary_peak(most: Rational) -> Result<Requirement, Error> {
        let Some(least) = most.recip().filter(|least| least.sign().is_gt()) else {
            return Err(refused("a peak of the complementary sensitivity is above 0"));
        };
        Ok(Requirement { kind: &KIND, asked: most.to_string(), rule: Rule::Circle(Circle::new([0, 1], least, most)) })
    }
}
