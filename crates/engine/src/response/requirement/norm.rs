//! The peak gain of a transfer function of the closed loop. No key of `[require]` asks for it yet: it is made as small as it can be.

use super::{Circle, Requirement, RequirementKind, Rule, refused};
use crate::error::Error;
use crate::model::Between;
use jurist_algebra::number::Rational;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: "norm",
    about: "the greatest modulus of a transfer function of the closed loop",
    option: None,
    is_listed: false,
    sense: "<=",
    units: &[],
    meaning: |_| Err(refused("a peak gain needs an input and an output")),
    found: |_, _| None,
};

impl Requirement {
    /// By the greatest modulus of the transfer function between two signals, above 0.
    ///
    /// The transfer function `T` is `L/(1 + L)` of a loop with `L = T/(1 - T)`, so this is a peak of a complementary sensitivity.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn norm(between: Between, most: Rational) -> Result<Requirement, Error> {
        let Some(least) = most.recip().filter(|least| least.sign().is_gt()) else {
            return Err(refused("a peak gain is above 0"));
        };
        let circle = Circle::new([0, 1], least, most.clone()).between(between);
        Ok(Requirement { kind: &KIND, asked: most.to_string(), rule: Rule::Circle(circle) })
    }
}
