//! The sign of a number that is given as a polynomial in symbols.

use super::Symbols;
use crate::limits::{Budget, Exhausted, Stop};
use crate::number::Sign;
use crate::poly::{Domain, MultiPoly};

/// Bits of the first attempt.
const FIRST_BITS: u64 = 128;

/// Bits from which on zero is worth a proof of its own.
const PROOF_BITS: u64 = 1024;

/// Bits after which a sign is given up.
const MOST_BITS: u64 = 1 << 13;

impl Symbols {
    /// The sign of a polynomial in symbols.
    ///
    /// A sign other than zero is only ever read off an enclosure. Zero is only ever concluded from an identity: the zero
    /// polynomial, or the normal form of Lindemann and Weierstrass, distinct powers of `e` with algebraic exponents being
    /// linearly independent over the algebraic numbers ([Baker1975](crate::bibliography#baker1975)); or of an algebraic number from
    /// a polynomial that it is a zero of, and whose other zeros are all farther from 0 than it is.
    ///
    /// Cost: enclosures with more and more bits until zero is left aside; the normal form at 1024 bits.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and when neither shows with some thousand bits.
    pub fn sign(&self, p: &MultiPoly, budget: &Budget) -> Result<Sign, Exhausted> {
        if p.is_zero() {
            return Ok(Sign::Equal);
        }
        if let Some(constant) = p.as_constant() {
            return Ok(constant.sign());
        }
        let mut bits = FIRST_BITS;
        while bits <= MOST_BITS {
            budget.check()?;
            if let Some(sign) = budget.enter(|| self.enclose(p, bits))?.sign() {
                return Ok(sign);
            }
            if bits == PROOF_BITS
                && (budget.enter(|| self.is_zero_in_normal_form(p))? || self.is_zero_algebraic_number(p, budget)?)
            {
                return Ok(Sign::Equal);
            }
            bits *= 2;
        }
        Err(Exhausted::new(Stop::Precision(MOST_BITS), "the sign of a constant"))
    }

    /// Whether a polynomial in symbols is zero.
    ///
    /// # Errors
    /// As [`Symbols::sign`].
    pub fn is_zero(&self, p: &MultiPoly, budget: &Budget) -> Result<bool, Exhausted> {
        Ok(self.sign(p, budget)?.is_eq())
    }
}
