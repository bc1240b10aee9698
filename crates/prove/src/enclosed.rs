//! Certificates of verdicts whose numbers the checkers only enclose: of plants behind holds beside several rates, and of functions in the model.

use super::complex::has_frames;
use super::no_certificate;
use super::statement::{self, about_at_rates, object};
use super::text::to_text;
use jurist_algebra::limits::Budget;
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::problem::Problem;
use jurist_model::Time;
use jurist_model::error::Error;

/// The schema of such certificates.
const SCHEMA: &str = "jurist/certificate/9";

/// The most that the checkers take: a determinant of enclosures takes them little time.
const BITS: u64 = 1024;

/// Whether a verdict is certified so: in discrete time, where polynomials over constants would be long or the constants are written in the model.
pub(super) fn is_enclosed(problem: &Problem, budget: &Budget) -> Result<bool, Error> {
    if problem.time() != Time::Discrete {
        return Ok(false);
    }
    let is_long = has_frames(problem) || problem.model().hyperperiod() > 1 || problem.is_written_complex();
    if is_long && statement::has_held_plant(problem) {
        return Ok(true);
    }
    Ok(problem.algebra_over_symbols(budget)?.symbols().is_written())
}

/// The certificate of a verdict.
pub(super) fn of_verdict(answer: &Answer<PointVerdict>) -> Result<String, Error> {
    let (problem, verdict) = (answer.problem(), answer.value());
    match verdict.count {
        Some(count) if count.on == 0 && verdict.infinite == 0 => {}
        _ => return Err(no_certificate("no certificate: roots are on the circle, or the loop is undefined")),
    }
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about_at_rates(problem)?),
        ("statement", statement::verdict(problem, verdict)),
        ("bits", BITS.into()),
    ])))
}
