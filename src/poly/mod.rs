//! Polynomials: dense univariate [`Poly`] over any [`Domain`], their greatest common divisors,
//! resultants and subresultants.
//!
//! [`UniPoly`] is a univariate polynomial over the integers; nesting gives polynomials whose
//! coefficients are polynomials in a parameter. [`MultiPoly`] is sparse in any number of variables,
//! [`RationalFunction`] a quotient of two.

mod arithmetic;
mod dense;
mod division;
mod domain;
mod gcd;
pub mod multivariate;
mod rational_function;
mod subresultant;

pub use dense::{Poly, UniPoly};
pub use domain::Domain;
pub use multivariate::{Monomial, MultiPoly};
pub use rational_function::{DisplayRationalFunction, RationalFunction};
pub use subresultant::{discriminant, resultant, resultant_formal, subresultant_chain};
