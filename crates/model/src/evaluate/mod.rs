//! The values of expressions, exact and symbolic in the parameters: of numbers and parameters alone
//! ([`scalar`]), linear in signals ([`linear`]), rational in z or s ([`transfer`]), and of a whole model
//! ([`symbolic`], [`values`]).

mod complex_values;
mod identities;
pub(crate) mod linear;
pub(crate) mod scalar;
pub(crate) mod symbolic;
pub(crate) mod transfer;
pub(crate) mod values;
pub(crate) mod walk;
pub(crate) mod work;
pub(crate) mod zpoly;
