//! The values of expressions, exact and symbolic in the parameters: of numbers and parameters alone
//! ([`scalar`]), linear in signals ([`linear`]), rational in z or s ([`transfer`]), and of a whole model
//! ([`symbolic`], [`values`]).

mod complex_values;
mod identities;
pub(in crate::model) mod linear;
pub(in crate::model) mod scalar;
pub(in crate::model) mod symbolic;
pub(in crate::model) mod transfer;
pub(in crate::model) mod values;
pub(in crate::model) mod walk;
pub(in crate::model) mod work;
pub(in crate::model) mod zpoly;
