//! Matrices over any domain and their characteristic polynomials.
//!
//! [`Matrix`] is dense over any [`Domain`](crate::poly::Domain); [`RationalMatrix`] has
//! rational functions as entries and is brought to a common denominator.
//! [`faddeev_leverrier`] computes the characteristic polynomial and the adjugate;
//! [`CharacteristicPolynomial`] is the plain value that is handed on.

mod characteristic;
mod decoupled;
mod dense;
mod determinant;
mod expansion;
mod faddeev_leverrier;
mod hessenberg;
mod multimodular;
mod rational;
#[cfg(feature = "strategies")]
pub mod strategies;

pub use characteristic::CharacteristicPolynomial;
pub use dense::Matrix;
pub use determinant::{determinant_bareiss, determinant_leibniz};
pub use faddeev_leverrier::{FaddeevLeVerrier, characteristic_over_denominator, faddeev_leverrier};
pub use multimodular::{characteristic_polynomial_multimodular, characteristic_polynomial_over_rows};
pub use rational::{Cleared, RationalMatrix};
