//! What the benchmarks share: families of loops and of polynomials.

#![allow(dead_code, reason = "each benchmark uses a part")]

pub mod loops;
pub mod roots;

/// Enclosures of roots are at most `2^-RELATIVE_BITS` times as wide as the root is large: about 38 digits,
/// the precision of PARI's answer.
pub const RELATIVE_BITS: u64 = 128;
