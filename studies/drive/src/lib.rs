//! The paper once more: what it prints against what is exactly true.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod diagrams;
pub mod document;
mod errata;
mod facts;
mod latex;
mod limits;
mod main_job;
mod printed;
mod published;
mod report;
mod runs;
mod tables;

pub use diagrams::{chopper, current_controller, drive_blocks, pwm_signal, speed_controller, tracker};
pub use errata::{Comparison, Match, compare, compare_all};
pub use main_job::{MainJob, main_job, main_job_json, main_job_text, main_job_undecided};
pub use printed::{EQUATION_23, EQUATION_37, LIST_AFTER_36, Printed};
pub use published::published_limits;
pub use report::{NamedFigure, PaperReport, paper_report};
pub use tables::errata;

use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_show::notation::Coefficient;

/// The coefficient of `z^power_of_z` times `parameter^power_of_parameter` of a polynomial in one
/// parameter, whose denominators are numbers; 0 where there is none.
pub fn coefficient(p: &CharacteristicPolynomial, power_of_z: usize, power_of_parameter: usize) -> Rational {
    let Some(c) = p.coefficients.get(power_of_z) else { return Rational::ZERO };
    let wanted = |e: &[u32]| e.first().map_or(0, |e| *e as usize) == power_of_parameter;
    let terms = Coefficient::new(c, 1).numerator;
    terms.into_iter().find(|(e, _)| wanted(e)).map_or(Rational::ZERO, |(_, value)| value)
}
