//! The precisions of this crate: bits of the first attempt and most bits, with the reason.

use crate::limits::Precisions;

/// The sign of a polynomial in symbols. Numbers that are not zero mostly show it with 128 bits; a thousand that do not show it
/// make zero worth a proof of its own ([`PROOF_OF_ZERO`]), and far more bits are for what that proof does not reach.
pub(crate) const SIGN_OF_CONSTANT: Precisions = Precisions::new(128, 1 << 13);

/// Bits from which on zero is worth a proof of its own.
pub(crate) const PROOF_OF_ZERO: u64 = 1024;

/// The zeros of a polynomial with enclosed coefficients: as for signs, since neighbouring zeros must separate.
pub(crate) const ZEROS_OVER_SYMBOLS: Precisions = Precisions::new(128, 1 << 13);

/// The sign of a resultant at a number before it is expanded: what a thousand bits do not show is mostly zero.
pub(crate) const RESULTANT_AT_NUMBER: Precisions = Precisions::new(128, 1024);

/// The order of two real numbers that are no roots of rational polynomials, whose equality nothing proves.
pub(crate) const ORDER_OF_REALS: Precisions = Precisions::new(64, 1 << 14);

/// Bits with which the direction of a polynomial over symbols through a zero is looked for first.
pub(crate) const DIRECTION: u64 = 128;

/// Bits with which a transcendental number is enclosed first.
pub(crate) const FIRST_PLACE: u64 = 32;
