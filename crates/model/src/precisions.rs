//! The precisions of this crate: bits of the first attempt and most bits, with the reason.

use jurist_algebra::limits::Precisions;

/// The duty ratio of a loop at rest beside 0 and 1, which it may be by a relation that no identity shows.
pub(crate) const STEADY_DUTY: Precisions = Precisions::new(128, 1 << 11);
