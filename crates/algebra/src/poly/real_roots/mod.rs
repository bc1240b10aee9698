//! Real roots of integer polynomials: bounds, counts, isolation.
//!
//! [`isolate_real_roots`] gives every real root of a [`SquareFree`] polynomial as a
//! [`RealAlgebraic`](crate::poly::algebraic::RealAlgebraic), rational roots exactly.

mod all_values;
mod bounds;
mod bracket;
mod deflated;
mod descartes;
mod fixed;
mod isolate;
mod linear_factors;
mod rational_roots;
mod refinement;
mod separated;
mod sign_variations;
mod small_residues;
mod square_free;
mod sturm;

pub use bounds::{negative_root_bound_bits, positive_root_bound_bits, root_bound_bits};
pub use fixed::isolate_real_roots_fixed;
pub use isolate::{isolate_real_roots, isolate_real_roots_descartes, isolate_real_roots_in};
pub use rational_roots::rational_roots;
pub use sign_variations::{
    budan_fourier_bound, descartes_sign_variations, descartes_sign_variations_in, sign_variations,
};
pub use square_free::SquareFree;
pub use sturm::{
    Bound, count_roots_sturm, count_with_sequence, signed_remainder_sequence, signed_remainder_sequence_by,
    sturm_sequence,
};

pub(crate) use bracket::Bracket;
pub(crate) use rational_roots::linear;
