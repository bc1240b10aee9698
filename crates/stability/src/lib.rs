//! From a polynomial to an answer about stability.
//!
//! Discrete time asks whether all roots lie in the open unit disc, continuous time whether they
//! lie in the open left half plane ([`Shape`]). Both questions are reduced to a pair of
//! polynomials of half the degree on an interval of the real line ([`HalfSizePair`]), which gives
//! the exact count of roots ([`count_roots`]) and the boundary in parameter space.
//!
//! Knows polynomials and their coefficients, and neither models nor texts.
//!
//! | room | what it does |
//! |---|---|
//! | the crate's root | root counts, tables of Jury and Routh, boundary polynomials, stable sets of one parameter |
//! | [`plane`] | the exact stable regions of two parameters |
//! | [`boxes`] | boxes of any number of parameters: proofs, counterexamples, largest factors |
//! | [`dead_time`] | quasi-polynomials: dead times, gains, other parameters |
//! | [`sector`] | the sector of at least a damping |
//! | [`subdivision`] | the loop that halves boxes until every part is decided |

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod boundary;
pub mod boxes;
mod cause;
mod conditions;
pub mod dead_time;
mod half_size;
mod hermitian;
mod impulse_response;
mod intersection;
mod interval_set;
mod jury;
mod line;
mod pair_location;
mod parametric;
pub mod plane;
mod precisions;
mod root_count;
mod routh;
pub mod sector;
mod stable_set;
#[cfg(feature = "strategies")]
pub mod strategies;
pub mod subdivision;
mod symbolic;

pub use boundary::{Boundary, boundary_polynomials};
pub use cause::{Cause, Causes};
pub use conditions::{ClassicalTest, Condition, Inequality, ScaledPoly, Table, classical_test, row_name, solve};
pub use half_size::HalfSizePair;
pub use hermitian::{hermitian_minors, hermitian_test};
pub use impulse_response::{AbsoluteSum, ImpulseResponse};
pub use interval_set::zeros_in;
pub use interval_set::{AlgebraicInterval, IntervalSet, Range, RealInterval};
pub use jury::{JuryRow, JuryTable, UNDIVIDED_ORDER, is_schur_jury, jury_table, jury_table_with};
pub use line::{Bracket, end_at, stable_set};
use pair_location::complex_pair_at;
pub use pair_location::{ComplexPair, Side};
pub use parametric::{AtPoint, ParametricPolynomial};
pub use root_count::{RootCount, count_roots, is_stable};
pub use routh::{RouthTable, is_hurwitz_routh, routh_table};
pub use stable_set::{Cells, End, StableInterval, StableSet, UndecidedBracket};
pub use symbolic::{
    Comparison, EnclosedCondition, EnclosedRow, EnclosedTable, RealIntervals, Rounding, SymbolicCondition,
    SymbolicPlane, SymbolicPolynomial, SymbolicRow, SymbolicTest, symbolic_stable_set,
};
pub use symbolic::{EnclosedLoop, open_equation, stable_set_of_parts, told_apart, zeros_of_functions};

/// Where the roots of the characteristic polynomial of a stable loop lie.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::{Shape, is_stable};
/// let p = UniPoly::from_i64(&[-1, 2]); // the root 1/2
/// assert!(is_stable(&p, Shape::UnitDisc) && !is_stable(&p, Shape::LeftHalfPlane));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// The open unit disc, `|z| < 1`: discrete time.
    UnitDisc,
    /// The open left half plane, `Re s < 0`: continuous time.
    LeftHalfPlane,
}
