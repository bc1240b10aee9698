//! The periodic steady state, and the period map linearised about a state without approximation.

use super::{Operating, SwitchedModel, SwitchedState};
use nalgebra::{DMatrix, DVector};

impl SwitchedModel {
    /// The derivative of the state after one period by the state before it, plant states first.
    ///
    /// Exact for the switched circuit: an edge at time `t` that moves later by `dt` changes the end
    /// state by `e^(A (T - t)) B V dt`, with a minus sign for a rising edge. A clamped source does
    /// not answer to its controller at all.
    pub fn linearised(&self, state: &SwitchedState, inputs: &DVector<f64>) -> DMatrix<f64> {
        let (n, q) = (self.plant_states.len(), self.controller_states.len());
        let c = &self.controller;
        let mut map = DMatrix::zeros(n + q, n + q);
        map.view_mut((0, 0), (n, n)).copy_from(&self.flow.transition(self.period));
        map.view_mut((n, 0), (q, n)).copy_from(&c.from_plant);
        map.view_mut((n, n), (q, q)).copy_from(&c.transition);
        let output = self.controller_output(state, inputs);
        let zero = DVector::zeros(n);
        for (k, source) in self.sources.iter().enumerate() {
            let duty = output[k] / source.carrier;
            if !(duty > 0.0 && duty < 1.0) {
                continue;
            }
            let column = self.plant.source.column(k) * source.amplitude;
            let (rise, fall) = source.pulse.edges(duty * self.period, self.period);
            let (rise_slope, fall_slope) = source.pulse.edge_slopes();
            let mut answer = DVector::zeros(n);
            for (edge, slope) in [(rise, -rise_slope), (fall, fall_slope)] {
                if slope != 0.0 {
                    answer += self.flow.advance(&column, &zero, self.period - edge) * slope;
                }
            }
            answer *= self.period / source.carrier;
            let mut by_plant = map.view_mut((0, 0), (n, n));
            by_plant += &answer * c.direct_plant.row(k);
            let mut by_controller = map.view_mut((0, n), (n, q));
            by_controller += &answer * c.output.row(k);
        }
        map
    }

    /// The state that repeats itself every period, by Newton's method on the period map.
    ///
    /// Newton starts from the averaged circuit's equilibrium (every source replaced by its mean
    /// voltage). `None` when the averaged circuit has no equilibrium, when a source would have to be
    /// on for less than nothing or more than all of the period, or when Newton does not settle.
    pub fn periodic_steady_state(&self, inputs: &DVector<f64>) -> Option<Operating> {
        let n = self.plant_states.len();
        let mut z = self.averaged_equilibrium(inputs)?;
        let mut best = f64::INFINITY;
        for _ in 0..50 {
            let state = SwitchedState::unstacked(&z, n);
            let gap = self.next_period(&state, inputs).stacked() - &z;
            let residual = gap.amax() / z.amax().max(f64::MIN_POSITIVE);
            if residual.is_nan() {
                return None;
            }
            if residual < f64::EPSILON || (residual < 1e-11 && residual >= best) {
                let output = self.controller_output(&state, inputs);
                let unclamped = self.sources.iter().zip(output.iter()).all(|(s, e)| *e >= 0.0 && *e <= s.carrier);
                return unclamped.then(|| Operating { duty: self.duty(&state, inputs), state, residual });
            }
            best = best.min(residual);
            let jacobian = self.linearised(&state, inputs) - DMatrix::identity(z.len(), z.len());
            z -= jacobian.lu().solve(&gap)?;
        }
        None
    }

    /// Eigenvalues of the linearised period map about the periodic steady state, largest first.
    pub fn small_signal_eigenvalues(&self, inputs: &DVector<f64>) -> Option<Vec<nalgebra::Complex<f64>>> {
        let operating = self.periodic_steady_state(inputs)?;
        crate::simulate::eigenvalues(&self.linearised(&operating.state, inputs))
    }

    /// Equilibrium with every source replaced by its mean voltage: `A x + B V d + W r = 0`,
    /// `q = F q + ...`, `d = e / carrier`, one linear system.
    fn averaged_equilibrium(&self, inputs: &DVector<f64>) -> Option<DVector<f64>> {
        let (n, q) = (self.plant_states.len(), self.controller_states.len());
        let c = &self.controller;
        let gains = DVector::from_iterator(self.sources.len(), self.sources.iter().map(|s| s.amplitude / s.carrier));
        let source = &self.plant.source * DMatrix::from_diagonal(&gains);
        let mut matrix = DMatrix::zeros(n + q, n + q);
        matrix.view_mut((0, 0), (n, n)).copy_from(&(&self.plant.matrix + &source * &c.direct_plant));
        matrix.view_mut((0, n), (n, q)).copy_from(&(&source * &c.output));
        matrix.view_mut((n, 0), (q, n)).copy_from(&c.from_plant);
        matrix.view_mut((n, n), (q, q)).copy_from(&(&c.transition - DMatrix::identity(q, q)));
        let mut drive = DVector::zeros(n + q);
        drive.rows_mut(0, n).copy_from(&((&self.plant.input + &source * &c.direct_input) * inputs));
        drive.rows_mut(n, q).copy_from(&(&c.from_input * inputs));
        matrix.lu().solve(&-drive).filter(|z| z.iter().all(|v| v.is_finite()))
    }
}
