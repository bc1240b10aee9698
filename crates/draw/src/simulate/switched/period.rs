//! One period: sample, compare, switch.

use super::{Pulse, SwitchedModel, SwitchedState};
use nalgebra::DVector;

/// A stretch of the period in which no switch moves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stretch {
    /// Seconds it lasts.
    pub length: f64,
    /// Which sources are on.
    pub on: Vec<bool>,
}

impl Pulse {
    /// Begin and end of the pulse in a period, for a given on-time.
    pub(super) fn edges(self, on_time: f64, period: f64) -> (f64, f64) {
        match self {
            Pulse::Beginning => (0.0, on_time),
            Pulse::End => (period - on_time, period),
            Pulse::Centre => ((period - on_time) / 2.0, (period + on_time) / 2.0),
            Pulse::Ends => (period - on_time / 2.0, on_time / 2.0),
        }
    }

    /// Whether the source is on at a time of the period, with this begin and end.
    fn is_on(self, (begin, end): (f64, f64), time: f64) -> bool {
        match self {
            Pulse::Ends => time < end || begin < time,
            _ => begin < time && time < end,
        }
    }

    /// How fast begin and end move with the on-time.
    pub(super) fn edge_slopes(self) -> (f64, f64) {
        match self {
            Pulse::Beginning => (0.0, 1.0),
            Pulse::End => (-1.0, 0.0),
            Pulse::Centre | Pulse::Ends => (-0.5, 0.5),
        }
    }
}

impl SwitchedModel {
    /// The controllers' outputs at a period's beginning, before any clamping.
    pub fn controller_output(&self, state: &SwitchedState, inputs: &DVector<f64>) -> DVector<f64> {
        let c = &self.controller;
        &c.output * &state.controller + &c.direct_plant * &state.plant + &c.direct_input * inputs
    }

    /// The share of the coming period each source is on: output over carrier, clamped to 0 .. 1.
    pub fn duty(&self, state: &SwitchedState, inputs: &DVector<f64>) -> Vec<f64> {
        let output = self.controller_output(state, inputs);
        self.sources.iter().zip(output.iter()).map(|(s, e)| (e / s.carrier).clamp(0.0, 1.0)).collect()
    }

    /// The stretches between switching instants, in order; those of no length are left out.
    pub(super) fn stretches(&self, duty: &[f64]) -> Vec<Stretch> {
        let edges: Vec<(f64, f64)> =
            self.sources.iter().zip(duty).map(|(s, d)| s.pulse.edges(d * self.period, self.period)).collect();
        let mut instants = vec![0.0, self.period];
        instants.extend(edges.iter().flat_map(|(a, b)| [*a, *b]));
        instants.sort_by(f64::total_cmp);
        let stretch = |pair: &[f64]| {
            let middle = (pair[0] + pair[1]) / 2.0;
            let on =
                self.sources.iter().zip(&edges).map(|(source, edges)| source.pulse.is_on(*edges, middle)).collect();
            Stretch { length: pair[1] - pair[0], on }
        };
        instants.windows(2).filter(|pair| pair[1] > pair[0]).map(stretch).collect()
    }

    /// The constant right-hand side of a stretch.
    pub(super) fn drive(&self, on: &[bool], inputs: &DVector<f64>) -> DVector<f64> {
        let mut b = &self.plant.input * inputs;
        for (k, source) in self.sources.iter().enumerate().filter(|(k, _)| on[*k]) {
            b += self.plant.source.column(k) * source.amplitude;
        }
        b
    }

    /// The controllers' next state.
    pub(super) fn next_controller(&self, state: &SwitchedState, inputs: &DVector<f64>) -> DVector<f64> {
        let c = &self.controller;
        &c.transition * &state.controller + &c.from_plant * &state.plant + &c.from_input * inputs
    }

    /// The state one period later.
    pub fn next_period(&self, state: &SwitchedState, inputs: &DVector<f64>) -> SwitchedState {
        let mut plant = state.plant.clone();
        for stretch in self.stretches(&self.duty(state, inputs)) {
            plant = self.flow.advance(&plant, &self.drive(&stretch.on, inputs), stretch.length);
        }
        SwitchedState { plant, controller: self.next_controller(state, inputs) }
    }

    /// The mean of the plant's states over the coming period.
    pub fn period_average(&self, state: &SwitchedState, inputs: &DVector<f64>) -> DVector<f64> {
        let mut plant = state.plant.clone();
        let mut sum = DVector::zeros(plant.len());
        for stretch in self.stretches(&self.duty(state, inputs)) {
            let step = self.flow.advance_with_integral(&plant, &self.drive(&stretch.on, inputs), stretch.length);
            plant = step.state;
            sum += step.integral;
        }
        sum / self.period
    }
}
