//! Runs over many periods.

use super::{SwitchedModel, SwitchedState};
use crate::simulate::sampled::{Excitation, SAMPLES_BETWEEN_CHECKS};
use crate::simulate::trace::Trace;
use jurist_algebra::limits::{Budget, Exhausted};
use nalgebra::DVector;

/// What a run writes down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// The state at every period's beginning.
    Samples,
    /// Also every switching instant, and this many instants inside each stretch between two.
    Waveform(usize),
}

/// A run of the switched circuit.
#[derive(Clone, Debug)]
pub struct SwitchedRun {
    /// Plant states, then one signal per source: its controller's output before clamping, named
    /// `NAME.control`, its duty ratio `NAME.duty`, and its voltage `NAME`, which jumps.
    pub trace: Trace,
    /// The state at the end.
    pub end: SwitchedState,
    /// In how many periods at least one source was clamped.
    pub clamped: usize,
}

impl SwitchedModel {
    /// `periods` periods from `start`, with the inputs stepping as `excitation` says (its samples
    /// are periods; its initial state is not used). Ends early where a value leaves `f64`.
    pub fn simulate(
        &self,
        start: &SwitchedState,
        excitation: &Excitation,
        periods: usize,
        record: Record,
    ) -> SwitchedRun {
        self.simulate_within(start, excitation, periods, record, &Budget::unlimited())
            .expect("an unlimited budget does not run out")
    }

    /// The same within a budget, which is told how far the run is.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn simulate_within(
        &self,
        start: &SwitchedState,
        excitation: &Excitation,
        periods: usize,
        record: Record,
        budget: &Budget,
    ) -> Result<SwitchedRun, Exhausted> {
        let mut names = self.plant_states.clone();
        for source in &self.sources {
            names.extend([source.name.clone() + ".control", source.name.clone() + ".duty", source.name.clone()]);
        }
        let mut trace = Trace::with_names(&names);
        let mut state = start.clone();
        let mut inputs = excitation.inputs_at(0, self.inputs.len());
        let changes = excitation.changes();
        let mut clamped = 0;
        for n in 0..periods {
            if n % SAMPLES_BETWEEN_CHECKS == 0 {
                budget.check()?;
                budget.advance(n as u64, periods as u64);
            }
            if changes.binary_search(&n).is_ok() {
                inputs = excitation.inputs_at(n, self.inputs.len());
            }
            let output = self.controller_output(&state, &inputs);
            let outside = |(s, e): (&super::Pwm, &f64)| *e < 0.0 || *e > s.carrier;
            clamped += usize::from(self.sources.iter().zip(output.iter()).any(outside));
            let plant = self.through_period(n as f64 * self.period, &state, &inputs, record, &mut trace);
            let next = SwitchedState { plant, controller: self.next_controller(&state, &inputs) };
            if !next.is_finite() {
                break;
            }
            state = next;
        }
        Ok(SwitchedRun { trace, end: state, clamped })
    }

    /// The plant at the end of a period, through which it is written down.
    fn through_period(
        &self,
        begin: f64,
        state: &SwitchedState,
        inputs: &DVector<f64>,
        record: Record,
        trace: &mut Trace,
    ) -> DVector<f64> {
        let (output, duty) = (self.controller_output(state, inputs), self.duty(state, inputs));
        let values = |plant: &DVector<f64>, on: &[bool]| {
            let mut row: Vec<f64> = plant.iter().copied().collect();
            for (k, source) in self.sources.iter().enumerate() {
                row.extend([output[k], duty[k], if on[k] { source.amplitude } else { 0.0 }]);
            }
            row
        };
        let (mut plant, mut elapsed) = (state.plant.clone(), 0.0);
        for (k, stretch) in self.stretches(&duty).iter().enumerate() {
            let drive = self.drive(&stretch.on, inputs);
            match record {
                Record::Samples if k == 0 => trace.push(begin, values(&plant, &stretch.on)),
                Record::Samples => {}
                Record::Waveform(inside) => {
                    for j in 0..=inside + 1 {
                        let part = stretch.length * j as f64 / (inside + 1) as f64;
                        let there = self.flow.advance(&plant, &drive, part);
                        trace.push(begin + elapsed + part, values(&there, &stretch.on));
                    }
                }
            }
            plant = self.flow.advance(&plant, &drive, stretch.length);
            elapsed += stretch.length;
        }
        plant
    }
}
