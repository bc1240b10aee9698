//! Polynomials: dense univariate [`Poly`] over any [`Domain`], their greatest common divisors,
//! resultants and subresultants.
//!
//! [`UniPoly`] is a univariate polynomial over the integers; nesting gives polynomials whose
//! coefficients are polynomials in a parameter.

pub mod algebraic;
mod arithmetic;
mod dense;
mod division;
mod domain;
mod gcd;
pub mod real_roots;
mod subresultant;

pub use dense::{Poly, UniPoly};
pub use domain::Domain;
pub use subresultant::{discriminant, resultant, resultant_formal, subresultant_chain};
