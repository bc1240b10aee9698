//! Fast ways for polynomials over the integers, hooked into [`Domain`](super::Domain).

pub mod kronecker;
