//! What a simulation is given, and the run of the linear loop under it.

use super::sampled::simulation_error;
use super::several_rates::SeveralRates;
use super::{DelayedModel, SampledModel, Trace, excitation, natural_duration, signal_unit};
use jurist_algebra::limits::Budget;
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::model::Model;
use jurist_engine::problem::Problem;

/// Longer runs are refused: they would fill the memory.
const MOST_SAMPLES: f64 = 2e7;

/// Samples of a continuous loop over the duration.
const CONTINUOUS_SAMPLES: f64 = 2000.0;

/// Samples where nobody names a duration and the time that the roots ask for has fewer.
const LEAST_SAMPLES: f64 = 50.0;

/// Inputs, initial values and the duration of a simulation.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_draw::simulate::Course;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// let (problem, budget) = (Model::drive().ask().problem()?, Budget::unlimited());
/// let course = Course::of(&problem, Some(0.01), &budget)?;
/// assert_eq!(course.inputs[0], ("omega_ref".to_owned(), 0.0, 80.0));
/// let run = course.run(&problem, &budget)?;
/// assert_eq!((run.trace.time.len(), run.is_complete), (101, true));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Name, time from which on, value.
    pub inputs: Vec<(String, f64, f64)>,
    /// Name and value of states at the beginning.
    pub initial: Vec<(String, f64)>,
    /// In seconds, or in samples where the loop has no sample time.
    pub duration: f64,
    /// Fewer samples are too few to see; 1 where a duration was asked for.
    pub least_samples: f64,
}

/// A run of the linear loop.
#[derive(Clone, Debug)]
pub struct LinearRun {
    /// The signals, with the units that the model names.
    pub trace: Trace,
    /// Seconds between two samples; `None` for a continuous loop or without a sample time.
    pub sample_time: Option<f64>,
    /// Where the signals go if the loop is stable; empty where inputs change on the way.
    pub finals: Vec<(String, f64)>,
    /// Whether it reached the end within the range of floating point.
    pub is_complete: bool,
}

impl Course {
    /// What the model says in its section `[simulation]`, with another duration where one is given; where neither names
    /// one, it is as long as the roots ask for ([`natural_duration`]).
    ///
    /// # Errors
    /// `E-simulation` for a duration that is not positive; [`Error`] as [`natural_duration`].
    pub fn of(problem: &Problem, duration: Option<f64>, budget: &Budget) -> Result<Course, Error> {
        let defaults = problem.model().simulation();
        let asked = duration.or_else(|| defaults.duration.as_ref().map(|d| d.to_f64_approximate()));
        let duration = match asked {
            Some(duration) => duration,
            None => natural_duration(problem, budget)?.unwrap_or(1.0),
        };
        if !(duration.is_finite() && duration > 0.0) {
            return Err(simulation_error("the duration has to be positive").into());
        }
        let inputs = defaults.inputs.iter().map(|(n, v)| (n.name.clone(), 0.0, v.to_f64_approximate())).collect();
        let initial = defaults.initial.iter().map(|(n, v)| (n.name.clone(), v.to_f64_approximate())).collect();
        let least_samples = if asked.is_some() { 1.0 } else { LEAST_SAMPLES };
        Ok(Course { inputs, initial, duration, least_samples })
    }

    /// Whether the model or the caller named the duration.
    pub fn is_duration_asked(&self) -> bool {
        self.least_samples < LEAST_SAMPLES
    }

    /// Whether nothing moves the loop.
    pub fn is_at_rest(&self) -> bool {
        self.inputs.is_empty() && self.initial.is_empty()
    }

    /// Adds a unit step of the model's first input; its name, if there is one.
    pub fn step_first_input<'m>(&mut self, model: &'m Model) -> Option<&'m str> {
        let first = model.inputs().first()?;
        self.inputs.push((first.name.clone(), 0.0, 1.0));
        Some(&first.name)
    }

    /// Inputs as steps at samples `period` apart.
    pub fn steps(&self, period: f64) -> Vec<(String, usize, f64)> {
        let sample = |t: f64| (t / period - 1e-9).ceil().max(0.0) as usize;
        self.inputs.iter().map(|(name, t, v)| (name.clone(), sample(*t), *v)).collect()
    }

    /// The number of samples `period` apart.
    ///
    /// # Errors
    /// `E-simulation` for more than fit into the memory.
    pub fn samples(&self, period: f64) -> Result<usize, Error> {
        self.samples_within(period, MOST_SAMPLES)
    }

    fn samples_within(&self, period: f64, most: f64) -> Result<usize, Error> {
        let count = (self.duration / period).round().max(self.least_samples);
        if count > most {
            let message = format!("{count:e} samples are too many for a simulation");
            return Err(Diagnostic::error(Code::Simulation, message).help("shorten it with --duration").into());
        }
        Ok(count as usize)
    }

    /// The run of the linear loop, sampled finely where the loop is continuous; of a loop of several rates each sample of the fastest.
    ///
    /// # Errors
    /// [`Error`] as [`SampledModel::from_loop`], [`DelayedModel::from_loop`], [`excitation`] and [`Course::samples`]; stopped.
    pub fn run(&self, problem: &Problem, budget: &Budget) -> Result<LinearRun, Error> {
        self.run_within(problem, MOST_SAMPLES, budget)
    }

    /// The same, refused where it has more samples than `most`.
    ///
    /// # Errors
    /// [`Error`] as [`Course::run`].
    pub fn run_within(&self, problem: &Problem, most: f64, budget: &Budget) -> Result<LinearRun, Error> {
        let step = self.duration / CONTINUOUS_SAMPLES;
        if let Some(system) = DelayedModel::from_loop(problem, step, budget)? {
            return self.run_delayed(problem, &system, budget);
        }
        let system = SampledModel::from_loop(problem, step, budget)?;
        let several = SeveralRates::of(problem, &system, budget)?;
        let sample_time = several.as_ref().map_or(system.sample_time, |several| several.sample_time);
        let at = |name: &str| system.state_named(name);
        let steps = self.steps(sample_time);
        let drive = excitation(at, system.states.len(), &system.inputs, &self.initial, &steps)?;
        let samples = self.samples_within(sample_time, most)?;
        let trace = match &several {
            Some(several) => several.simulate(&drive, samples, budget)?,
            None => system.simulate_within(&drive, samples, budget)?,
        };
        let is_complete = trace.time.len() > samples;
        let sampled = problem.closed_loop_in_numbers(budget)?.2.is_some();
        let constant = drive.steps.iter().all(|s| s.sample == 0);
        let finals = if constant { system.final_values(&drive.inputs_at(0, system.inputs.len())) } else { Vec::new() };
        let trace = trace.with_units(|name| signal_unit(problem.model(), name));
        Ok(LinearRun { trace, sample_time: sampled.then_some(sample_time), finals, is_complete })
    }

    fn run_delayed(&self, problem: &Problem, system: &DelayedModel, budget: &Budget) -> Result<LinearRun, Error> {
        let at = |name: &str| system.state_named(name);
        let steps = self.steps(system.step);
        let drive = excitation(at, system.states.len(), &system.inputs, &self.initial, &steps)?;
        let points = self.samples(system.step)?;
        let trace = system.simulate_within(&drive, points, budget)?;
        let is_complete = trace.time.len() > points;
        let constant = drive.steps.iter().all(|s| s.sample == 0);
        let finals = if constant { system.final_values(&drive.inputs_at(0, system.inputs.len())) } else { Vec::new() };
        let trace = trace.with_units(|name| signal_unit(problem.model(), name));
        Ok(LinearRun { trace, sample_time: None, finals, is_complete })
    }
}
