//! The circuit with its switches: a linear plant fed by pulse width modulated sources, controllers
//! that sample once per period.
//!
//! A source is a class-C chopper: two topologies, its full voltage or none. Its on-time follows from
//! the controller's output against a sawtooth, clamped to the period. Between two switching instants
//! the plant is linear, so its state there is a matrix exponential; the instants themselves are
//! computed, not met by a grid.

mod limit;
mod linearise;
mod period;
mod run;

pub use limit::{Growth, growth_limit};
pub use run::{Record, SwitchedRun};

use super::exponential::Exponential;
use super::sampled::simulation_error;
use jurist_engine::error::Diagnostics;
use nalgebra::{DMatrix, DVector};

/// Where in the period the pulse lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pulse {
    /// On from the period's beginning: a falling switch-off edge that moves.
    #[default]
    Beginning,
    /// On until the period's end: a switch-on edge that moves.
    End,
    /// Around the middle: both edges move, by half as much.
    Centre,
    /// Halves at the beginning and at the end of the period: both edges move, by half as much.
    Ends,
}

/// A pulse width modulated source.
#[derive(Clone, Debug, PartialEq)]
pub struct Pwm {
    /// Name of its output.
    pub name: String,
    /// Voltage while on; 0 while off.
    pub amplitude: f64,
    /// Height of the sawtooth, positive: the controller output that means "on all the time".
    pub carrier: f64,
    /// Where the pulse lies.
    pub pulse: Pulse,
}

/// The continuous part: `x' = A x + B v + W r`, `v` the sources' voltages, `r` the inputs.
#[derive(Clone, Debug)]
pub struct Plant {
    /// `A`, states by states.
    pub matrix: DMatrix<f64>,
    /// `B`, states by sources.
    pub source: DMatrix<f64>,
    /// `W`, states by inputs.
    pub input: DMatrix<f64>,
}

/// The sampled part: at every period's beginning `e = H q + Dx x + Dr r` goes to the comparators,
/// and `q` becomes `F q + Gx x + Gr r`.
#[derive(Clone, Debug)]
pub struct Controller {
    /// `F`, controller states by controller states.
    pub transition: DMatrix<f64>,
    /// `Gx`, controller states by plant states.
    pub from_plant: DMatrix<f64>,
    /// `Gr`, controller states by inputs.
    pub from_input: DMatrix<f64>,
    /// `H`, sources by controller states.
    pub output: DMatrix<f64>,
    /// `Dx`, sources by plant states.
    pub direct_plant: DMatrix<f64>,
    /// `Dr`, sources by inputs.
    pub direct_input: DMatrix<f64>,
}

/// The switched circuit with its controllers.
#[derive(Clone, Debug)]
pub struct SwitchedModel {
    period: f64,
    plant: Plant,
    flow: Exponential,
    sources: Vec<Pwm>,
    controller: Controller,
    plant_states: Vec<String>,
    controller_states: Vec<String>,
    inputs: Vec<String>,
}

/// The state at a period's beginning.
#[derive(Clone, Debug, PartialEq)]
pub struct SwitchedState {
    /// The plant's states.
    pub plant: DVector<f64>,
    /// The controllers' states.
    pub controller: DVector<f64>,
}

/// The periodic steady state under constant inputs.
#[derive(Clone, Debug)]
pub struct Operating {
    /// The state at every period's beginning.
    pub state: SwitchedState,
    /// Share of the period each source is on, 0 to 1.
    pub duty: Vec<f64>,
    /// Largest change of a state over one period that is left, relative to the state's norm.
    pub residual: f64,
}

impl SwitchedState {
    /// All entries, the plant's first.
    pub fn stacked(&self) -> DVector<f64> {
        let n = self.plant.len() + self.controller.len();
        DVector::from_iterator(n, self.plant.iter().chain(self.controller.iter()).copied())
    }

    /// The state whose stacked form this is; `plant` is the number of plant states.
    pub fn unstacked(stacked: &DVector<f64>, plant: usize) -> SwitchedState {
        let rest = stacked.len() - plant;
        SwitchedState { plant: stacked.rows(0, plant).into_owned(), controller: stacked.rows(plant, rest).into_owned() }
    }

    fn is_finite(&self) -> bool {
        self.plant.iter().chain(self.controller.iter()).all(|v| v.is_finite())
    }
}

impl SwitchedModel {
    /// The circuit; `names` are those of the plant's states, the controllers' states and the inputs.
    ///
    /// # Errors
    /// `E-simulation` when shapes do not agree, or a period or a carrier is not positive.
    pub fn new(
        period: f64,
        plant: Plant,
        sources: Vec<Pwm>,
        controller: Controller,
        names: [Vec<String>; 3],
    ) -> Result<SwitchedModel, Diagnostics> {
        let [plant_states, controller_states, inputs] = names;
        let (n, q, r, m) = (plant_states.len(), controller_states.len(), inputs.len(), sources.len());
        let shapes = [
            ("the plant's A", plant.matrix.shape(), (n, n)),
            ("the plant's B", plant.source.shape(), (n, m)),
            ("the plant's W", plant.input.shape(), (n, r)),
            ("the controller's F", controller.transition.shape(), (q, q)),
            ("the controller's Gx", controller.from_plant.shape(), (q, n)),
            ("the controller's Gr", controller.from_input.shape(), (q, r)),
            ("the controller's H", controller.output.shape(), (m, q)),
            ("the controller's Dx", controller.direct_plant.shape(), (m, n)),
            ("the controller's Dr", controller.direct_input.shape(), (m, r)),
        ];
        for (name, found, expected) in shapes {
            if found != expected {
                return Err(simulation_error(format!(
                    "{name} is {} x {}, where {} x {} is expected",
                    found.0, found.1, expected.0, expected.1
                )));
            }
        }
        let positive = |v: f64| v.is_finite() && v > 0.0;
        if !positive(period) {
            return Err(simulation_error("the switching period must be positive"));
        }
        if let Some(source) = sources.iter().find(|s| !positive(s.carrier) || !s.amplitude.is_finite()) {
            return Err(simulation_error(format!("the carrier of '{}' must be positive", source.name)));
        }
        let flow = Exponential::new(plant.matrix.clone());
        Ok(SwitchedModel { period, plant, flow, sources, controller, plant_states, controller_states, inputs })
    }

    /// Seconds from one sample to the next, which is also the sawtooth's period.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Names of the plant's states.
    pub fn plant_states(&self) -> &[String] {
        &self.plant_states
    }

    /// Names of the inputs.
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }

    /// Everything at rest.
    pub fn rest(&self) -> SwitchedState {
        SwitchedState {
            plant: DVector::zeros(self.plant_states.len()),
            controller: DVector::zeros(self.controller_states.len()),
        }
    }
}
