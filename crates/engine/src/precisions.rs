//! The precisions of this crate: bits of the first attempt and most bits, with the reason.
//!
//! What is only ever asked of numbers that differ needs no last precision (`until_shown`) and is not here. The bytes of
//! undecided answers depend on these numbers: a change of one is a change for users.

use jurist_algebra::limits::Precisions;

/// The sign of a polynomial in constants at a number. It may be zero by a common factor, which no bits show.
pub(crate) const SIGN_AT_NUMBER: Precisions = Precisions::new(128, 1 << 13);

/// The order of a delay and the required one, which may be equal.
pub(crate) const REQUIRED_DELAY: Precisions = Precisions::new(64, 1 << 12);

/// The argument along a spiral of constant damping. Roots may be on it.
pub(crate) const ROOTS_IN_SPIRAL: Precisions = Precisions::new(128, 1 << 10);

/// Roots of a polynomial with enclosed coefficients. Equal ones are told apart by no bits.
pub(crate) const ROOTS: Precisions = Precisions::new(256, 1 << 12);

/// Entries of matrices that are rounded for other programs. Of one that may be zero no bits tell.
pub(crate) const ROUNDED_ENTRIES: Precisions = Precisions::new(256, 1 << 12);

/// On which side of the real axis a complex loop's root is. It may have one on either side at once, which no bits show.
pub(crate) const SIDE_OF_ROOT: Precisions = Precisions::new(128, 1 << 11);

/// A loop behind holds as numbers alone. A loop that these bits do not decide is so near to the boundary that exact algebra
/// has to be asked.
pub(crate) const LOOP_IN_NUMBERS: Precisions = Precisions::new(128, 1 << 11);
