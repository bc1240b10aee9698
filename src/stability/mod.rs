//! From a polynomial to an answer about stability.
//!
//! Discrete time asks whether all roots lie in the open unit disc, continuous time whether they
//! lie in the open left half plane ([`Region`]). Both questions are reduced to a pair of
//! polynomials of half the degree on an interval of the real line ([`HalfSizePair`]), which gives
//! the exact count of roots ([`count_roots`]) and the boundary in parameter space.

mod half_size;
mod jury;
mod root_count;
mod routh;

pub use half_size::HalfSizePair;
pub use jury::{JuryRow, JuryTable, is_schur_jury, jury_table};
pub use root_count::{RootCount, count_roots, count_roots_cauchy_index, is_stable};
pub use routh::{RouthTable, is_hurwitz_routh, routh_table};

/// Where the roots of the characteristic polynomial of a stable loop lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Region {
    /// The open unit disc, `|z| < 1`: discrete time.
    UnitDisc,
    /// The open left half plane, `Re s < 0`: continuous time.
    LeftHalfPlane,
}
