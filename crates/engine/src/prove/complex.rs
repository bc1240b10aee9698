//! Certificates of loops with complex coefficients: what the checkers do not read of them.

use super::no_certificate;
use crate::error::Error;
use crate::model::{Dynamics, Expression, Form, Model};
use crate::problem::Problem;
use std::collections::BTreeSet;

/// The imaginary unit.
const UNIT: &str = "j";

/// Refuses loops whose plant behind a hold may be complex in itself: the checkers take exponentials of real matrices.
///
/// # Errors
/// `E-no-certificate`.
pub(super) fn refuse_complex_plants(problem: &Problem) -> Result<(), Error> {
    let (model, Form::Blocks(diagram)) = (problem.model(), problem.model().form()) else { return Ok(()) };
    if !problem.is_written_complex() {
        return Ok(());
    }
    let held = diagram.blocks.iter().filter(|block| block.discretization.as_ref().is_some_and(|d| d.method.is_hold()));
    for block in held {
        let all: Vec<&Expression> = match &block.dynamics {
            Dynamics::StateSpace { a, .. } => a.rows.iter().flatten().collect(),
            Dynamics::Transfer(transfer) => vec![transfer],
            Dynamics::Ratio { denominator, .. } => denominator.iter().collect(),
            _ => Vec::new(),
        };
        if all.iter().any(|e| has_unit(model, e)) {
            return Err(no_certificate(
                "no certificate: a plant behind a hold has complex coefficients, and the checkers take exponentials of real matrices",
            ));
        }
    }
    Ok(())
}

/// Whether the unit is in an expression, or in constants that it uses.
fn has_unit(model: &Model, expression: &Expression) -> bool {
    let mut seen: BTreeSet<&str> = expression.names();
    let mut open: Vec<&str> = seen.iter().copied().collect();
    while let Some(name) = open.pop() {
        let Some(constant) = model.constants().iter().find(|constant| constant.name == name) else { continue };
        open.extend(constant.expression.names().into_iter().filter(|name| seen.insert(name)));
    }
    seen.contains(UNIT)
}

/// How often the checkers count each root of the model's polynomial: they double a complex one.
pub(super) fn times(problem: &Problem) -> usize {
    if problem.is_complex() { 2 } else { 1 }
}

/// Whether a plant is held in a frame of its own: cosines and sines are read by enclosures alone.
pub(super) fn has_frames(problem: &Problem) -> bool {
    let Form::Blocks(diagram) = problem.model().form() else { return false };
    diagram.blocks.iter().filter_map(|block| block.discretization.as_ref()).any(|d| d.frame.is_some())
}
