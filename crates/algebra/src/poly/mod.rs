//! Polynomials: dense univariate [`Poly`] over any [`Domain`], their greatest common divisors,
//! resultants and subresultants.
//!
//! [`UniPoly`] is a univariate polynomial over the integers; nesting gives polynomials whose
//! coefficients are polynomials in a parameter. [`MultiPoly`] is sparse in any number of variables,
//! [`RationalFunction`] a quotient of two.

pub mod algebraic;
mod arithmetic;
mod complex_roots;
mod dense;
mod dispatch;
mod division;
mod domain;
mod factored_resultant;
mod gcd;
pub mod modular;
pub mod multivariate;
mod rational_function;
pub mod real_roots;
mod remainder_sequence;
mod rounded_sign;
#[cfg(feature = "strategies")]
pub mod strategies;
mod subresultant;

pub use algebraic::{RealAlgebraic, rational_between, simplest_between};
pub use complex_roots::{RootDisc, complex_roots, root_discs};
pub use dense::{Poly, UniPoly, bernstein_weights};
pub use domain::Domain;
pub use factored_resultant::resultant_square_free_decomposition;
pub use multivariate::{Monomial, MultiPoly};
pub use rational_function::{DisplayRationalFunction, RationalFunction};
pub use real_roots::{SquareFree, isolate_real_roots, isolate_real_roots_in};
pub use remainder_sequence::{RemainderSequence, Step};
pub use subresultant::{
    discriminant, resultant, resultant_formal, resultant_formal_subresultant, resultant_subresultant,
    subresultant_chain,
};
