//! What independent programs can check: certificates, statements for SMT solvers, theorems for Coq.

mod boxes;
mod cofactors;
mod complex;
mod coq;
mod dead_time;
mod digest;
mod emit;
mod enclosed;
mod for_all;
mod gain;
mod held;
mod line;
mod map;
mod map_boxes;
mod over_symbols;
mod smt2;
mod statement;
mod text;
mod tuned;

use crate::coverage::refusals::{NO_CERTIFICATE, NOT_ALGEBRAIC};
use crate::error::{Code, Diagnostic, Error};
use crate::problem::{Bound, Problem};
use crate::stability::StableSet;

pub use emit::SCHEMA;
pub use for_all::ForAllClaim;
pub use tuned::{BestOf, FoundClaim, TuneClaim};

/// Certificates are made of polynomials over the integers.
fn refuse_transcendental(set: &StableSet, what: &str) -> Result<(), Error> {
    if set.is_algebraic() {
        return Ok(());
    }
    Err(NOT_ALGEBRAIC.diagnostic(&[("what", what)]).into())
}

/// Boxes and maps of a model with requirements may be of these: the checkers prove stability alone.
fn refuse_requirements(problem: &Problem) -> Result<(), Error> {
    match problem.model().require().is_empty() {
        true => Ok(()),
        false => Err(no_certificate("no certificate: nothing proves the requirements of the model")),
    }
}

/// Boxes and maps are of a region whose bound is a number.
fn refuse_free_bound(problem: &Problem) -> Result<(), Error> {
    match problem.region().bound() {
        Bound::Free => Err(no_certificate("no certificate of a map on which the bound of the region is free")),
        Bound::Number(_) => Ok(()),
    }
}

fn no_certificate(why: impl Into<String>) -> Error {
    Diagnostic::error(Code::NoCertificate, why).help(NO_CERTIFICATE.help).into()
}
