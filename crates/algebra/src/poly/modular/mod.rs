//! Fast ways for polynomials over the integers through their residues modulo primes that fit a machine word, or modulo a
//! power of two, chosen in one place for the integers as a [`Domain`](super::Domain).

pub mod chinese;
pub mod gcd;
pub mod gcd_by_values;
pub mod grid;
pub mod kronecker;
mod minors;
pub mod multimodular_resultant;
pub mod prime_field;
pub mod resultant;
pub mod square_free_resultant;
mod sylvester_bounds;
