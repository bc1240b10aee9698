//! What independent programs can check: certificates, statements for SMT solvers, theorems for Coq.
//!
//! A certificate is made of the answer that is printed, from the zeros and cells that decided it ([`Certificate`]). Where there is none,
//! and of requirements, the answer is cut into boxes, and what the check sees judges each box ([`certified`]).

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod boxes;
pub mod certified;
mod cofactors;
mod complex;
mod coq;
mod dead_time;
mod emit;
mod enclosed;
mod for_all;
mod gain;
mod held;
mod line;
mod map;
mod map_boxes;
mod over_symbols;
mod precisions;
mod smt2;
mod statement;
mod text;
mod tuned;

use jurist_algebra::limits::Budget;
use jurist_engine::coverage::{NO_CERTIFICATE, NOT_ALGEBRAIC};
use jurist_engine::problem::{Bound, Problem};
use jurist_model::error::{Code, Diagnostic, Error};
use jurist_stability::StableSet;

pub use emit::SCHEMA;
pub use for_all::{ForAllClaim, for_all_certificate};
pub use map::refuse_map_certificate;
pub use map_boxes::boxes_certificate;
pub use smt2::smt2;
pub use tuned::{BestOf, FoundClaim, TuneClaim, tune_certificate};

/// What the checkers `jurist verify` and `check.py` are given of an answer.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_prove::Certificate;
/// let (drive, budget) = (Model::drive(), Budget::unlimited());
/// let certificate = drive.ask().set("K_pwm", 551).verdict(&budget)?.certificate(&budget)?;
/// assert!(check(&drive.source().text, &certificate, &Limits::default()).is_ok());
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
pub trait Certificate {
    /// The certificate of this answer.
    ///
    /// Cost: greatest common divisors of the polynomials that decided the answer; no root is counted or isolated again.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where there is none.
    fn certificate(&self, budget: &Budget) -> Result<String, Error>;
}

/// What Coq is given of an answer.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_prove::Theorem;
/// let (drive, budget) = (Model::drive(), Budget::unlimited());
/// let file = drive.ask().free("K_pwm").stable_set(&budget)?.coq(&budget)?;
/// assert!(file.contains("<-> lower_limit < K_pwm < upper_limit."));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
pub trait Theorem {
    /// A file for Coq that proves this answer, with the library in `proofs/`.
    ///
    /// Cost: a table of the conditions, as for [`jury_table`](jurist_stability::jury_table), and the signs of their coefficients.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where there is none.
    fn coq(&self, budget: &Budget) -> Result<String, Error>;
}

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
