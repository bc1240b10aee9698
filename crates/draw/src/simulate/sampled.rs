//! The sampled linear model, step by step.

use super::trace::Trace;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_engine::error::{Code, Diagnostic, Diagnostics};
use nalgebra::{DMatrix, DVector};

/// How many samples are computed between two looks at the clock.
pub(super) const SAMPLES_BETWEEN_CHECKS: usize = 1 << 10;

/// A sampled linear model in `f64`: `x(n+1) = A x(n) + E r(n)`, `y(n) = C x(n) + D r(n)`.
///
/// The closed loop: there is no controller apart from it and nothing saturates.
#[derive(Clone, Debug)]
pub struct SampledModel {
    /// `A`, states by states.
    pub transition: DMatrix<f64>,
    /// `E`, states by inputs.
    pub input: DMatrix<f64>,
    /// `C`, outputs by states.
    pub output: DMatrix<f64>,
    /// `D`, outputs by inputs.
    pub feedthrough: DMatrix<f64>,
    /// Names of the states.
    pub states: Vec<String>,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// Seconds between two samples; 1 where the model names none.
    pub sample_time: f64,
}

/// An input takes a new value from some sample on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The first sample with the new value.
    pub sample: usize,
    /// Which input.
    pub input: usize,
    /// The new value.
    pub value: f64,
}

/// What drives a run: the initial state, and steps of the inputs (which are 0 before their first).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Excitation {
    /// The state at sample 0; missing entries are 0.
    pub initial: Vec<f64>,
    /// The steps, in any order; of two at the same sample the later in the list holds.
    pub steps: Vec<Step>,
}

/// Two matrices side by side, row by row.
struct Rows {
    entries: Vec<f64>,
    width: usize,
}

impl Rows {
    fn new(left: &DMatrix<f64>, right: &DMatrix<f64>) -> Self {
        let row = |k: usize| left.row(k).iter().chain(right.row(k).iter()).copied().collect::<Vec<_>>();
        Rows { entries: (0..left.nrows()).flat_map(row).collect(), width: left.ncols() + right.ncols() }
    }

    /// One entry of the product with a vector, summed from the left.
    fn times(&self, row: usize, vector: &[f64]) -> f64 {
        let entries = &self.entries[row * self.width..(row + 1) * self.width];
        entries.iter().zip(vector).map(|(a, x)| a * x).sum()
    }
}

impl Excitation {
    /// The inputs at `sample`.
    pub fn inputs_at(&self, sample: usize, count: usize) -> DVector<f64> {
        let mut latest: Vec<Option<Step>> = vec![None; count];
        for step in self.steps.iter().filter(|s| s.sample <= sample && s.input < count) {
            let slot = &mut latest[step.input];
            if slot.is_none_or(|old| old.sample <= step.sample) {
                *slot = Some(*step);
            }
        }
        DVector::from_iterator(count, latest.iter().map(|s| s.map_or(0.0, |s| s.value)))
    }

    /// The samples at which an input changes.
    pub(super) fn changes(&self) -> Vec<usize> {
        let mut samples: Vec<usize> = self.steps.iter().map(|s| s.sample).collect();
        samples.sort_unstable();
        samples.dedup();
        samples
    }
}

impl SampledModel {
    /// The model, if the shapes of its matrices and lists agree.
    ///
    /// # Errors
    /// `E-simulation` names the first shape that does not fit, or a sample time that is not positive.
    pub fn checked(self) -> Result<SampledModel, Diagnostics> {
        let (n, m, p) = (self.states.len(), self.inputs.len(), self.outputs.len());
        let shapes = [
            ("A", self.transition.shape(), (n, n)),
            ("E", self.input.shape(), (n, m)),
            ("C", self.output.shape(), (p, n)),
            ("D", self.feedthrough.shape(), (p, m)),
        ];
        for (name, found, expected) in shapes {
            if found != expected {
                return Err(simulation_error(format!(
                    "{name} is {} x {}, where {} x {} is expected",
                    found.0, found.1, expected.0, expected.1
                )));
            }
        }
        if !(self.sample_time.is_finite() && self.sample_time > 0.0) {
            return Err(simulation_error("the sample time must be positive"));
        }
        Ok(self)
    }

    /// States and outputs at samples 0 to `samples`, signals named after both.
    ///
    /// The run ends early where a value leaves the range of `f64`. O(samples * n^2).
    ///
    /// # Example
    /// ```
    /// use jurist_draw::simulate::{Excitation, SampledModel, Step};
    /// use nalgebra::DMatrix;
    /// let model = SampledModel {
    ///     transition: DMatrix::from_row_slice(1, 1, &[0.5]),
    ///     input: DMatrix::from_row_slice(1, 1, &[1.0]),
    ///     output: DMatrix::from_row_slice(1, 1, &[3.0]),
    ///     feedthrough: DMatrix::from_row_slice(1, 1, &[0.0]),
    ///     states: vec!["x".into()],
    ///     inputs: vec!["r".into()],
    ///     outputs: vec!["y".into()],
    ///     sample_time: 0.1,
    /// };
    /// let step = Excitation { steps: vec![Step { sample: 0, input: 0, value: 1.0 }], ..Excitation::default() };
    /// let run = model.simulate(&step, 3);
    /// assert_eq!(run.signal("x").unwrap().values, vec![0.0, 1.0, 1.5, 1.75]);
    /// assert_eq!(run.signal("y").unwrap().values[3], 5.25);
    /// ```
    pub fn simulate(&self, excitation: &Excitation, samples: usize) -> Trace {
        self.simulate_within(excitation, samples, &Budget::unlimited()).expect("an unlimited budget does not run out")
    }

    /// The same within a budget, which is told how far the run is.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn simulate_within(
        &self,
        excitation: &Excitation,
        samples: usize,
        budget: &Budget,
    ) -> Result<Trace, Exhausted> {
        let names: Vec<String> =
            self.states.iter().chain(self.outputs.iter().filter(|o| !self.states.contains(o))).cloned().collect();
        let new_outputs: Vec<usize> =
            (0..self.outputs.len()).filter(|&k| !self.states.contains(&self.outputs[k])).collect();
        let mut trace = Trace::with_names(&names);
        // Products by rows that lie one behind the other: a run has millions of steps.
        let next = Rows::new(&self.transition, &self.input);
        let shown = Rows::new(&self.output, &self.feedthrough);
        let (n_states, n_inputs) = (self.states.len(), self.inputs.len());
        let changes = excitation.changes();
        let mut at = self.initial_state(excitation).as_slice().to_vec();
        at.extend_from_slice(excitation.inputs_at(0, n_inputs).as_slice());
        let mut moved = vec![0.0; n_states];
        for n in 0..=samples {
            if n % SAMPLES_BETWEEN_CHECKS == 0 {
                budget.check()?;
                budget.advance(n as u64, samples as u64);
            }
            if changes.binary_search(&n).is_ok() {
                at[n_states..].copy_from_slice(excitation.inputs_at(n, n_inputs).as_slice());
            }
            if at[..n_states].iter().any(|v| !v.is_finite()) {
                break;
            }
            let outputs = new_outputs.iter().map(|&k| shown.times(k, &at));
            trace.push(n as f64 * self.sample_time, at[..n_states].iter().copied().chain(outputs));
            for (k, value) in moved.iter_mut().enumerate() {
                *value = next.times(k, &at);
            }
            at[..n_states].copy_from_slice(&moved);
        }
        Ok(trace)
    }

    /// The state at sample 0.
    pub fn initial_state(&self, excitation: &Excitation) -> DVector<f64> {
        let given = excitation.initial.iter().copied().chain(std::iter::repeat(0.0));
        DVector::from_iterator(self.states.len(), given.take(self.states.len()))
    }

    /// The state that repeats itself under constant inputs; `None` where `I - A` is singular.
    pub fn steady_state(&self, inputs: &DVector<f64>) -> Option<DVector<f64>> {
        let n = self.states.len();
        if n == 0 {
            // Gains alone: the solver takes no matrix without rows.
            return Some(DVector::zeros(0));
        }
        let matrix = DMatrix::identity(n, n) - &self.transition;
        matrix.lu().solve(&(&self.input * inputs)).filter(|x| x.iter().all(|v| v.is_finite()))
    }

    /// States and outputs of [`SampledModel::steady_state`] with their names; none where there is no such state.
    pub fn final_values(&self, inputs: &DVector<f64>) -> Vec<(String, f64)> {
        let Some(x) = self.steady_state(inputs) else { return Vec::new() };
        let y = &self.output * &x + &self.feedthrough * inputs;
        let values = x.iter().chain(y.iter()).copied();
        self.states.iter().chain(&self.outputs).cloned().zip(values).collect()
    }

    /// The factor by which a deviation grows per sample, measured on the run itself: the geometric
    /// mean over the last `measured` samples, after `settling` samples that let the other modes die.
    ///
    /// The deviation is rescaled now and then, which a linear model does not notice. For a complex
    /// pair choose `measured` much longer than its period. `None` if the deviation vanishes.
    pub fn observed_growth(&self, settling: usize, measured: usize) -> Option<f64> {
        let n = self.states.len();
        let mut x = DVector::from_fn(n, |i, _| 1.0 / (1.0 + i as f64));
        let mut log = 0.0;
        // The line through (k, log of the deviation): with a complex pair the deviation also
        // oscillates, and a fit over many periods averages that away as 1/measured^2.
        let (mut sum, mut moment) = (0.0, 0.0);
        let middle = (measured as f64 - 1.0) / 2.0;
        for k in 0..settling + measured {
            x = &self.transition * &x;
            let norm = x.norm();
            if norm == 0.0 || !norm.is_finite() {
                return None;
            }
            log += norm.ln();
            x /= norm;
            if k >= settling {
                let t = (k - settling) as f64 - middle;
                sum += t * log;
                moment += t * t;
            }
        }
        (moment > 0.0).then(|| (sum / moment).exp())
    }
}

/// An error of this module.
pub(super) fn simulation_error(message: impl Into<String>) -> Diagnostics {
    Diagnostic::error(Code::Simulation, message).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    fn scalar(a: f64) -> SampledModel {
        SampledModel {
            transition: DMatrix::from_row_slice(1, 1, &[a]),
            input: DMatrix::from_row_slice(1, 1, &[1.0]),
            output: DMatrix::from_row_slice(1, 1, &[1.0]),
            feedthrough: DMatrix::from_row_slice(1, 1, &[0.0]),
            states: vec!["x".into()],
            inputs: vec!["r".into()],
            outputs: vec!["x".into()],
            sample_time: 1.0,
        }
    }

    #[test]
    fn steps_hold_until_the_next() {
        let at = |sample, value| Step { sample, input: 0, value };
        let e = Excitation { initial: vec![], steps: vec![at(5, 2.0), at(1, 1.0), at(5, 3.0)] };
        let values: Vec<f64> = [0, 1, 4, 5, 9].iter().map(|&n| e.inputs_at(n, 1)[0]).collect();
        assert_eq!(values, vec![0.0, 1.0, 1.0, 3.0, 3.0]);
    }

    #[test]
    fn a_run_that_diverges_ends_early_and_finite() {
        let e = Excitation { initial: vec![1e300], steps: vec![] };
        let run = scalar(1e6).simulate(&e, 100);
        assert_eq!(run.time.len(), 2);
        assert!(run.signals[0].values.iter().all(|v| v.is_finite()));
    }

    #[test]
    fn shapes_are_checked() {
        let mut model = scalar(0.5);
        model.input = DMatrix::from_row_slice(1, 2, &[1.0, 2.0]);
        assert_eq!(model.checked().unwrap_err().code(), Code::Simulation);
        let mut model = scalar(0.5);
        model.sample_time = 0.0;
        assert!(model.checked().is_err());
    }

    #[test]
    fn the_steady_state_repeats_itself_and_a_free_integrator_has_none() {
        let r = DVector::from_element(1, 3.0);
        assert_eq!(scalar(0.5).steady_state(&r).map(|x| x[0]), Some(6.0));
        assert!(scalar(1.0).steady_state(&r).is_none());
    }
}
