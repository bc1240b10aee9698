//! Certificates of loops with complex coefficients: how the checkers read them.

use jurist_engine::problem::Problem;
use jurist_model::Form;

/// How often the checkers count each root of the model's polynomial: they double a complex one.
pub(super) fn times(problem: &Problem) -> usize {
    if problem.is_complex() { 2 } else { 1 }
}

/// Whether a plant is held in a frame of its own: cosines and sines are read by enclosures alone.
pub(super) fn has_frames(problem: &Problem) -> bool {
    let Form::Blocks(diagram) = problem.model().form() else { return false };
    diagram.blocks.iter().filter_map(|block| block.discretization.as_ref()).any(|d| d.frame.is_some())
}
