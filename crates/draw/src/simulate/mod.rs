//! Floating point pictures of a loop: time responses, poles, root locus.
//!
//! Nothing here decides. What these functions return are observations in `f64`: times, states,
//! pole positions. No type of this module turns into a verdict; verdicts come from exact algebra
//! alone, and where a picture and a verdict meet, the picture is given the exact values to show.
//!
//! - [`SampledModel`]: the sampled linear model, `x(n+1) = A x(n) + E r(n)`; [`exact_response`] is
//!   the same recursion over the rationals, for short runs.
//! - [`DelayedModel`]: a continuous loop with dead time, by the method of steps.
//! - [`SwitchedModel`]: the circuit itself, with its switching instants, ripple and saturation.
//! - [`roots`]: all complex roots of an exact polynomial, right to plotting accuracy.
//! - [`RootLocus`]: the roots as one parameter moves, followed by continuity.

mod assignment;
mod course;
mod delayed;
mod exact;
mod exponential;
mod fixed;
mod from_loop;
mod root_locus;
mod roots;
mod sampled;
mod several_rates;
mod step;
mod switched;
mod trace;

pub use course::{Course, LinearRun};
pub use delayed::DelayedModel;
pub use exact::exact_response;
pub use exponential::{Exponential, StateIntegral};
pub use from_loop::{excitation, is_sampled, signal_unit};
pub use root_locus::{Branch, Crossing, LocusOptions, LocusSample, ParameterScale, RootLocus, trace_root_locus};
pub use roots::{ApproximateRoot, roots};
pub use sampled::{Excitation, SampledModel, Step};
pub use step::{StepMeasures, natural_duration};
pub use switched::{
    Controller, Growth, Operating, Plant, Pulse, Pwm, Record, SwitchedModel, SwitchedRun, SwitchedState, growth_limit,
};
pub use trace::{Signal, Trace};

/// Eigenvalues of a square matrix, largest magnitude first; `None` when the iteration does not
/// converge or an entry is not finite.
///
/// ```
/// use nalgebra::DMatrix;
/// let values = jurist_draw::simulate::eigenvalues(&DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -0.25, 0.0])).unwrap();
/// assert!((values[0].norm() - 0.5).abs() < 1e-12);
/// ```
pub fn eigenvalues(matrix: &nalgebra::DMatrix<f64>) -> Option<Vec<nalgebra::Complex<f64>>> {
    if !matrix.is_square() || matrix.iter().any(|v| !v.is_finite()) {
        return None;
    }
    if matrix.is_empty() {
        return Some(Vec::new());
    }
    let schur = nalgebra::linalg::Schur::try_new(matrix.clone(), f64::EPSILON, 10_000)?;
    let mut values: Vec<_> = schur.complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.re.total_cmp(&a.re)).then(b.im.total_cmp(&a.im)));
    Some(values)
}
