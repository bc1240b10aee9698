//! The precisions of this crate: bits of the first attempt and most bits, with the reason.

use jurist_algebra::limits::Precisions;

/// The signs of a certificate over constants, which both checkers enclose again with as many bits.
pub(crate) const CERTIFICATE_OVER_SYMBOLS: Precisions = Precisions::new(256, 1 << 13);
