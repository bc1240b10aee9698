//! The duty ratio of a loop at rest, and what is asked of numbers that depend on it.

use super::{Definition, Symbols, beside, quotient_at};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::symbols::{DutyRatio, EnclosedNumber};

/// Bits with which the place of an edge is looked at that depends on the duty ratio of a loop at rest.
const PLACE_BITS: u64 = 512;

impl Symbols {
    /// The whole part of a number in symbols that do not depend on kept names; `None` of another function, and where the number may be whole.
    pub(crate) fn whole_part(&self, f: &RationalFunction) -> Option<Rational> {
        let fixed = self.of_fixed().filter(|_| !self.moves(f))?;
        let value = quotient_at(&beside(f, self.first())?, &fixed.enclosed(PLACE_BITS)?, PLACE_BITS)?;
        let whole = value.lower().floor();
        (value.upper().floor() == whole).then(|| whole.into())
    }

    /// The duty ratio of a loop at rest as a function of kept names.
    pub(crate) fn duty(&mut self, duty: DutyRatio) -> RationalFunction {
        self.intern(Definition::Duty(Box::new(duty)))
    }

    /// What the variables of another table with the same kept names are here; `None` where a function has no value.
    pub(crate) fn import(&mut self, other: &Symbols) -> Option<Vec<RationalFunction>> {
        let mut images: Vec<RationalFunction> = (0..self.kept.len()).map(RationalFunction::variable).collect();
        for symbol in &other.table {
            let meaning = symbol.meaning.try_map(|f| f.compose(&images))?;
            images.push(self.intern_again(meaning)?);
        }
        Some(images)
    }

    /// A number that is known by enclosures alone.
    pub(crate) fn enclosed_number(&mut self, number: EnclosedNumber) -> RationalFunction {
        self.intern(Definition::Enclosed(number))
    }
}
