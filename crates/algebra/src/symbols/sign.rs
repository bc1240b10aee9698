//! The sign of a number that is given as a polynomial in symbols.

use super::Symbols;
use crate::limits::{Budget, Exhausted};
use crate::number::Sign;
use crate::poly::{Domain, MultiPoly};
use crate::precisions::{PROOF_OF_ZERO, SIGN_OF_CONSTANT};

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
        SIGN_OF_CONSTANT.decide("the sign of a constant", |bits| {
            budget.check()?;
            let sign = budget.enter(|| self.enclose(p, bits))?.sign();
            if sign.is_some() || bits != PROOF_OF_ZERO {
                return Ok(sign);
            }
            let is_zero =
                budget.enter(|| self.is_zero_in_normal_form(p))? || self.is_zero_algebraic_number(p, budget)?;
            Ok(is_zero.then_some(Sign::Equal))
        })
    }

    /// Whether a polynomial in symbols is zero.
    ///
    /// # Errors
    /// As [`Symbols::sign`].
    pub fn is_zero(&self, p: &MultiPoly, budget: &Budget) -> Result<bool, Exhausted> {
        Ok(self.sign(p, budget)?.is_eq())
    }
}
