//! Fast ways for polynomials over the integers, hooked into [`Domain`](super::Domain).

pub mod chinese;
pub mod gcd;
pub mod gcd_by_values;
pub mod grid;
pub mod kronecker;
pub mod modular;
pub mod multimodular_resultant;
pub mod resultant;
