//! A loop of several rates, sample by sample: blocks that are not active show what they computed last.

use super::sampled::{Excitation, SAMPLES_BETWEEN_CHECKS, simulation_error};
use super::{SampledModel, Trace};
use jurist_algebra::limits::Budget;
use jurist_engine::error::Error;
use jurist_engine::model::{Form, Rate};
use jurist_engine::problem::{Problem, RoundedSystem};
use nalgebra::{DMatrix, DVector, Dyn, LU};
use std::collections::HashMap;

/// A block in numbers.
struct Part {
    /// For all samples, or for even and for odd ones.
    systems: Vec<System>,
    rate: Rate,
    /// Where its states, its inputs and its outputs begin among those of all blocks.
    from: [usize; 3],
}

struct System {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

/// A loop whose blocks run at several rates, in floating point.
pub(super) struct SeveralRates {
    parts: Vec<Part>,
    /// Of the inputs of blocks by signals that blocks drive, and by external ones.
    connection: DMatrix<f64>,
    entry: DMatrix<f64>,
    /// Of the outputs, likewise.
    shown: DMatrix<f64>,
    direct: DMatrix<f64>,
    /// Names of states and of outputs.
    states: Vec<String>,
    outputs: Vec<String>,
    /// At which sample a run begins, that of the loop over its hyperperiod.
    start: u64,
    /// Seconds between two samples, or 1.
    pub sample_time: f64,
}

fn matrix(rows: &[Vec<f64>], (m, n): (usize, usize)) -> DMatrix<f64> {
    DMatrix::from_fn(m, n, |i, j| rows[i][j])
}

impl SeveralRates {
    /// Of a problem whose loop over the hyperperiod is `lifted`; `None` where all blocks run at one rate, or registers are among the states.
    pub fn of(problem: &Problem, lifted: &SampledModel, budget: &Budget) -> Result<Option<SeveralRates>, Error> {
        let model = problem.model();
        let (steps, Form::Blocks(diagram)) = (model.hyperperiod(), model.form()) else { return Ok(None) };
        if steps == 1 {
            return Ok(None);
        }
        let Some(wiring) = problem.rounded_wiring(budget)? else { return Ok(None) };
        let (mut parts, mut at) = (Vec::new(), [0; 3]);
        for (block, systems) in diagram.blocks.iter().zip(problem.rounded_blocks(budget)?) {
            let (n, inputs, outputs) = (systems[0].a.len(), block.inputs.len(), block.outputs.len());
            let system = |s: &RoundedSystem| System {
                a: matrix(&s.a, (n, n)),
                b: matrix(&s.b, (n, inputs)),
                c: matrix(&s.c, (outputs, n)),
                d: matrix(&s.d, (outputs, inputs)),
            };
            parts.push(Part { systems: systems.iter().map(system).collect(), rate: block.rate, from: at });
            at = [at[0] + n, at[1] + inputs, at[2] + outputs];
        }
        let has_time = problem.closed_loop_in_numbers(budget)?.2.is_some();
        let [states, inputs, driven] = at;
        if lifted.states.len() != states {
            return Ok(None);
        }
        let (external, outputs) = (lifted.inputs.len(), lifted.outputs.len());
        let columns =
            |rows: &[Vec<f64>], m: usize, from: usize, n: usize| DMatrix::from_fn(m, n, |i, j| rows[i][from + j]);
        let overwritten = |k: u64| {
            let slow = diagram.blocks.iter().filter(|b| b.rate.every > 1 && b.rate.is_active(k));
            slow.map(|b| b.outputs.len()).sum::<usize>()
        };
        Ok(Some(SeveralRates {
            parts,
            connection: columns(&wiring.inputs, inputs, 0, driven),
            entry: columns(&wiring.inputs, inputs, driven, external),
            shown: columns(&wiring.outputs, outputs, 0, driven),
            direct: columns(&wiring.outputs, outputs, driven, external),
            states: lifted.states.clone(),
            outputs: lifted.outputs.clone(),
            start: (0..steps).max_by_key(|&k| (overwritten(k), steps - k)).unwrap_or(0),
            sample_time: if has_time { lifted.sample_time / steps as f64 } else { 1.0 },
        }))
    }

    /// States and outputs at so many samples and at the first.
    ///
    /// # Errors
    /// `E-simulation` where the blocks that are active together have no unique signals; stopped.
    pub fn simulate(&self, drive: &Excitation, samples: usize, budget: &Budget) -> Result<Trace, Error> {
        let names = self.states.iter().chain(self.outputs.iter().filter(|o| !self.states.contains(o)));
        let mut trace = Trace::with_names(&names.cloned().collect::<Vec<_>>());
        let new: Vec<usize> = (0..self.outputs.len()).filter(|&k| !self.states.contains(&self.outputs[k])).collect();
        let given = drive.initial.iter().copied().chain(std::iter::repeat(0.0));
        let mut x = DVector::from_iterator(self.states.len(), given.take(self.states.len()));
        let mut held = DVector::zeros(self.connection.ncols());
        let mut solvers: HashMap<Vec<Option<usize>>, LU<f64, Dyn, Dyn>> = HashMap::new();
        for n in 0..=samples {
            if n % SAMPLES_BETWEEN_CHECKS == 0 {
                budget.check()?;
                budget.advance(n as u64, samples as u64);
            }
            if x.iter().any(|v| !v.is_finite()) {
                break;
            }
            let r = drive.inputs_at(n, self.entry.ncols());
            let active = self.active(self.start + n as u64);
            let solver = solvers.entry(active.clone()).or_insert_with(|| self.solver(&active));
            // Signals without what passes a block at once; those of other blocks are what they hold.
            let mut y = held;
            for (part, system) in self.systems(&active) {
                let states = x.rows(part.from[0], system.a.nrows());
                y.rows_mut(part.from[2], system.c.nrows()).copy_from(&(&system.c * states));
            }
            let known = &self.connection * &y + &self.entry * &r;
            let u = solver.solve(&known).ok_or_else(|| simulation_error("an algebraic loop that is not well posed"))?;
            let before = x.clone();
            for (part, system) in self.systems(&active) {
                let (own, inputs) =
                    (before.rows(part.from[0], system.a.nrows()), u.rows(part.from[1], system.d.ncols()));
                let mut out = y.rows_mut(part.from[2], system.c.nrows());
                out += &system.d * inputs;
                x.rows_mut(part.from[0], system.a.nrows()).copy_from(&(&system.a * own + &system.b * inputs));
            }
            let outputs = &self.shown * &y + &self.direct * &r;
            trace.push(n as f64 * self.sample_time, before.iter().copied().chain(new.iter().map(|&k| outputs[k])));
            held = y;
        }
        Ok(trace)
    }

    /// For each block which of its systems computes at a sample, if one does.
    fn active(&self, sample: u64) -> Vec<Option<usize>> {
        let which = |part: &Part| part.rate.is_active(sample).then(|| sample as usize % part.systems.len());
        self.parts.iter().map(which).collect()
    }

    fn systems<'a>(&'a self, active: &'a [Option<usize>]) -> impl Iterator<Item = (&'a Part, &'a System)> {
        self.parts.iter().zip(active).filter_map(|(part, which)| Some((part, &part.systems[(*which)?])))
    }

    /// The inputs of all blocks, from what they are without what passes a block at once.
    fn solver(&self, active: &[Option<usize>]) -> LU<f64, Dyn, Dyn> {
        let mut through = DMatrix::zeros(self.connection.ncols(), self.connection.nrows());
        for (part, system) in self.systems(active) {
            through.view_mut((part.from[2], part.from[1]), system.d.shape()).copy_from(&system.d);
        }
        let n = self.connection.nrows();
        (DMatrix::identity(n, n) - &self.connection * through).lu()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Course, SampledModel};
    use super::*;
    use jurist_engine::error::Source;
    use jurist_engine::model::Model;
    use jurist_engine::problem::Ask;

    const TEXT: &str = "time = 'discrete'\nsample_time = 0.5\n[parameters]\nK = 0.3\n[loop]\ninputs = ['r']\noutputs = ['y', 'w']\n\
        [[block]]\nname = 'slow'\ninput = 'r - y'\noutput = 'w'\ntransfer = 'K*z/(z - 1/2)'\nevery = 4\nphase = 1\n\
        [[block]]\nname = 'fast'\ninput = 'w - y'\noutput = 'u'\ngain = '1/2'\n\
        [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = 'zoh'\n";

    /// At the ends of hyperperiods it is the lifted loop, and in between the slow block holds its output.
    #[test]
    fn a_loop_of_several_rates_passes_through_its_lifted_loop() {
        let (model, _) = Model::from_toml(&Source::new("model.toml", TEXT)).unwrap();
        let (problem, budget) = (model.ask().problem().unwrap(), Budget::unlimited());
        let mut course = Course::of(&problem, Some(20.0), &budget).unwrap();
        course.inputs.push(("r".into(), 0.0, 1.0));
        let run = course.run(&problem, &budget).unwrap();
        assert_eq!((run.trace.time.len(), run.sample_time), (41, Some(0.5)));
        let lifted = SampledModel::from_loop(&problem, 1.0, &budget).unwrap();
        let drive =
            Excitation { steps: vec![super::super::Step { sample: 0, input: 0, value: 1.0 }], ..Excitation::default() };
        let reference = lifted.simulate(&drive, 10);
        for name in ["y", "w"] {
            let (fine, coarse) = (run.trace.points(name), reference.points(name));
            for (k, (t, value)) in coarse.iter().enumerate() {
                assert!((fine[4 * k].0 - t).abs() < 1e-12 && (fine[4 * k].1 - value).abs() < 1e-12, "{name} at {t}");
            }
        }
        let w = run.trace.points("w");
        assert!((0..41).all(|k| w[k].1 == w[k - k % 4].1), "{w:?}");
        let y = run.trace.points("y");
        assert!((1..20).all(|k| y[k].1 != y[k - 1].1), "{y:?}");
    }
}
