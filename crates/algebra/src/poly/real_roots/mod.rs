//! Real roots of integer polynomials: bounds, counts, isolation.
//!
//! [`isolate_real_roots`] gives every real root of a [`SquareFree`] polynomial as a
//! [`RealAlgebraic`](crate::poly::algebraic::RealAlgebraic), rational roots exactly.

mod bounds;
mod bracket;
mod deflated;
mod descartes;
mod fixed;
mod isolate;
mod modular;
mod rational_roots;
mod sign_variations;
mod square_free;
mod sturm;

pub use bounds::{negative_root_bound_bits, positive_root_bound_bits, root_bound_bits};
pub use fixed::isolate_real_roots_fixed;
pub use isolate::{isolate_real_roots, isolate_real_roots_descartes, isolate_real_roots_in};
pub use rational_roots::rational_roots;
pub use sign_variations::{budan_fourier_bound, descartes_sign_variations, sign_variations};
pub use square_free::SquareFree;
pub use sturm::{Bound, count_roots_sturm, count_with_sequence, sturm_sequence};

pub(crate) use bracket::Bracket;
pub(crate) use modular::coprime_modulo_some_prime;
pub(crate) use rational_roots::linear;
