//! Time responses of continuous loops with dead time, step by step.

mod past;
#[cfg(test)]
mod tests;
mod weights;

use super::sampled::{Excitation, SAMPLES_BETWEEN_CHECKS};
use super::trace::Trace;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::model::{Symbols, value_approximate};
use jurist_engine::problem::Problem;
use nalgebra::{DMatrix, DVector};
use past::Past;
use std::ops::Range;

/// A linear loop with dead times in `f64`: `x'(t) = sum A_j x(t - d_j) + E_j r(t - d_j)`,
/// `y(t) = sum C_j x(t - d_j) + D_j r(t - d_j)`. Before time 0 it is at rest.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_draw::simulate::{DelayedModel, Excitation};
/// use jurist_engine::error::Source;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// // y' = -y(t - 1), y(0) = 1: constant for one second, then a straight line, then a parabola.
/// let text = "time = 'continuous'\n[loop]\noutputs = ['y']\n\
///     [[block]]\ninput = '-v'\noutput = 'y'\ntransfer = '1/s'\n[[block]]\ninput = 'y'\noutput = 'v'\ndelay = 1\n";
/// let problem = Model::from_toml(&Source::new("model.toml", text))?.0.ask().problem()?;
/// let model = DelayedModel::from_loop(&problem, 0.5, &Budget::unlimited())?.expect("there is dead time");
/// let drive = Excitation { initial: vec![1.0], ..Excitation::default() };
/// let y = model.simulate_within(&drive, 4, &Budget::unlimited())?.points("y");
/// assert!((y[3].1 - 0.5).abs() < 1e-12 && y[4].1.abs() < 1e-12);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct DelayedModel {
    /// What acts at once, then what acts after one dead time each.
    taps: Vec<Tap>,
    /// Names of the states.
    pub states: Vec<String>,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// Time between two points of a trace.
    pub step: f64,
}

/// What acts after a dead time.
#[derive(Clone, Debug)]
struct Tap {
    delay: f64,
    a: DMatrix<f64>,
    e: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

impl Tap {
    fn zero(delay: f64, sizes: [(usize, usize); 4]) -> Tap {
        let [a, e, c, d] = sizes.map(|(rows, columns)| DMatrix::zeros(rows, columns));
        Tap { delay, a, e, c, d }
    }
}

/// How many dead times a jump is followed through: each smooths it by one derivative.
const FOLLOWED: usize = 4;
/// No more jumps are followed.
const MOST_JUMPS: usize = 4096;
/// A step is at most this share of the least dead time, and of the time constant of the fastest root of what acts at once.
const SHARE: f64 = 0.25;
/// Steps between two points of a trace at least.
const LEAST_STEPS: f64 = 2.0;
/// Longer runs are refused: their past would fill the memory.
const MOST_STEPS: f64 = 2e6;
/// Times that differ by less than this share of a step are the same.
const SAME: f64 = 1e-9;

impl DelayedModel {
    /// The closed loop of a problem at a point; `None` without dead time. A trace has its points `step` apart.
    ///
    /// # Errors
    /// [`Error`] as for the closed loop; `E-dead-time` where dead time acts at once on itself, as in loops of neutral type.
    pub fn from_loop(problem: &Problem, step: f64, budget: &Budget) -> Result<Option<DelayedModel>, Error> {
        let (closed, symbols, _) = problem.closed_loop_in_numbers(budget)?;
        if symbols.delays().is_empty() {
            return Ok(None);
        }
        let matrices = [&closed.a, &closed.e, &closed.c, &closed.d];
        let sizes = matrices.map(|m| (m.rows(), m.columns()));
        let reader = Reader::new(symbols);
        let mut taps = vec![Tap::zero(0.0, sizes)];
        for (which, matrix) in matrices.into_iter().enumerate() {
            for part in reader.parts(matrix)? {
                let at = taps.iter().position(|tap| tap.delay == part.delay).unwrap_or_else(|| {
                    taps.push(Tap::zero(part.delay, sizes));
                    taps.len() - 1
                });
                let Tap { a, e, c, d, .. } = &mut taps[at];
                [a, e, c, d][which][part.place] += part.value;
            }
        }
        let (states, inputs, outputs) = (closed.states.clone(), closed.inputs.clone(), closed.outputs.clone());
        Ok(Some(DelayedModel { taps, states, inputs, outputs, step }))
    }

    /// Which state a name means: a state, or an output that is one state now and nothing else.
    pub fn state_named(&self, name: &str) -> Option<usize> {
        let own = self.states.iter().position(|s| s == name);
        own.or_else(|| {
            let row = self.outputs.iter().position(|o| o == name)?;
            let is_empty = |m: &DMatrix<f64>| m.row(row).iter().all(|v| *v == 0.0);
            let now = &self.taps[0];
            if !is_empty(&now.d) || self.taps[1..].iter().any(|tap| !is_empty(&tap.c) || !is_empty(&tap.d)) {
                return None;
            }
            let mut entries = (0..self.states.len()).filter(|&j| now.c[(row, j)] != 0.0);
            let only = entries.next().filter(|&j| now.c[(row, j)] == 1.0)?;
            entries.next().is_none().then_some(only)
        })
    }

    /// States and outputs at points 0 to `points`, a step apart.
    ///
    /// By the method of steps ([`bibliography`](jurist_algebra::bibliography#bellmancooke1963)): what acts after a dead time is
    /// known, is replaced by a cubic between two jumps, and drives what acts at once, which is exact. The run ends early where
    /// a value leaves the range of `f64`.
    ///
    /// Cost: with `n` states, `O(n^2)` for each dead time and each step; steps end at every jump and are shorter than the
    /// least dead time and the least time constant.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; `E-simulation` for more steps than fit into the memory.
    pub fn simulate_within(&self, drive: &Excitation, points: usize, budget: &Budget) -> Result<Trace, Error> {
        let new_outputs: Vec<usize> =
            (0..self.outputs.len()).filter(|&k| !self.states.contains(&self.outputs[k])).collect();
        let names: Vec<String> =
            self.states.iter().chain(new_outputs.iter().map(|&k| &self.outputs[k])).cloned().collect();
        let mut trace = Trace::with_names(&names);
        let end = self.step * points as f64;
        let most = self.longest_step(end)?;
        let stops = self.jumps(drive, end, most);
        let mut stops = stops.iter().copied().peekable();
        let mut past = Past::new(self, drive, SAME * most);
        let mut taken = 0usize;
        for n in 0..=points {
            budget.advance(n as u64, points as u64);
            let point = n as f64 * self.step;
            while past.time() < point {
                while stops.next_if(|stop| *stop <= past.time() + SAME * most).is_some() {}
                let goal = stops.peek().copied().filter(|stop| *stop < point - SAME * most).unwrap_or(point);
                let from = past.time();
                let steps = ((goal - from) / most).ceil().max(1.0);
                for k in 1..=steps as usize {
                    if taken.is_multiple_of(SAMPLES_BETWEEN_CHECKS) {
                        budget.check()?;
                    }
                    taken += 1;
                    past.advance((goal - from) / steps, from + (goal - from) * (k as f64 / steps));
                }
            }
            let y = self.output(&past, point);
            if past.last().iter().chain(y.iter()).any(|v| !v.is_finite()) {
                break;
            }
            trace.push(point, past.last().iter().copied().chain(new_outputs.iter().map(|&k| y[k])));
        }
        Ok(trace)
    }

    /// States and outputs that stay under constant inputs, with their names; none where there are none.
    pub fn final_values(&self, inputs: &DVector<f64>) -> Vec<(String, f64)> {
        let (a, e) = (self.sum(|t| &t.a), self.sum(|t| &t.e));
        let (c, d) = (self.sum(|t| &t.c), self.sum(|t| &t.d));
        let Some(x) = a.lu().solve(&(-(e * inputs))).filter(|x| x.iter().all(|v| v.is_finite())) else {
            return Vec::new();
        };
        let y = c * &x + d * inputs;
        let values = x.iter().chain(y.iter()).copied();
        self.states.iter().chain(&self.outputs).cloned().zip(values).collect()
    }

    /// The matrix `sum A_j` of the loop without its dead times.
    pub(super) fn without_dead_time(&self) -> DMatrix<f64> {
        self.sum(|tap| &tap.a)
    }

    /// The largest dead time.
    pub(super) fn longest_dead_time(&self) -> f64 {
        self.taps.iter().map(|tap| tap.delay).fold(0.0, f64::max)
    }

    fn sum(&self, of: impl Fn(&Tap) -> &DMatrix<f64>) -> DMatrix<f64> {
        self.taps[1..].iter().fold(of(&self.taps[0]).clone(), |sum, tap| sum + of(tap))
    }

    fn longest_step(&self, end: f64) -> Result<f64, Error> {
        let least = self.taps[1..].iter().map(|tap| tap.delay).fold(f64::INFINITY, f64::min);
        let rates = super::eigenvalues(&self.taps[0].a).unwrap_or_default();
        let fastest = rates.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let most = (self.step / LEAST_STEPS).min(SHARE * least).min(SHARE / fastest);
        if !(most > 0.0 && end / most <= MOST_STEPS) {
            let message = format!("{:.0e} steps are too many for a simulation", end / most);
            let help = "a dead time or a time constant is that much shorter than the run: shorten it with --duration";
            return Err(Diagnostic::error(Code::Simulation, message).help(help).into());
        }
        Ok(most)
    }

    /// Times at which an input jumps, or what is delayed of a jump arrives, in order.
    fn jumps(&self, drive: &Excitation, end: f64, most: f64) -> Vec<f64> {
        let own = drive.steps.iter().map(|step| step.sample as f64 * self.step);
        let mut all: Vec<f64> = std::iter::once(0.0).chain(own).filter(|t| *t <= end).collect();
        let mut newest: Range<usize> = 0..all.len();
        for _ in 0..FOLLOWED {
            let begun: Vec<f64> = all[newest.clone()].to_vec();
            newest.start = all.len();
            for tap in &self.taps[1..] {
                all.extend(begun.iter().map(|t| t + tap.delay).filter(|t| *t <= end));
            }
            all.truncate(MOST_JUMPS);
            newest.end = all.len();
        }
        all.sort_by(f64::total_cmp);
        all.dedup_by(|later, kept| *later - *kept <= SAME * most);
        all
    }

    fn output(&self, past: &Past, t: f64) -> DVector<f64> {
        let mut y = DVector::zeros(self.outputs.len());
        for tap in &self.taps {
            y.gemv(1.0, &tap.c, &past.state(t - tap.delay), 1.0);
            y.gemv(1.0, &tap.d, past.input(t - tap.delay), 1.0);
        }
        y
    }
}

/// What of an entry acts after one dead time.
struct EntryPart {
    place: (usize, usize),
    delay: f64,
    value: f64,
}

/// Reads matrices over symbols as sums of numbers times delays.
struct Reader {
    values: Vec<f64>,
    /// Variables that stand for dead time, and how long it is.
    delays: Vec<(usize, f64)>,
}

impl Reader {
    fn new(symbols: &Symbols) -> Reader {
        let values = symbols.values_approximate(&[]);
        let delays = symbols.delays().into_iter().map(|(v, time)| (v, value_approximate(&time, &values))).collect();
        Reader { values, delays }
    }

    /// The parts of the entries that are not zero.
    fn parts(&self, matrix: &RationalMatrix) -> Result<Vec<EntryPart>, Error> {
        let refused = || {
            let message = "a loop in which dead time acts on itself at once is not simulated";
            Error::from(
                Diagnostic::error(Code::DeadTime, message)
                    .help("these are loops of neutral type; known of them: verdict, intervals, margins, bode, nyquist"),
            )
        };
        let undefined = || Error::Undefined("an entry of the closed loop divides by zero".into());
        let delay_of = |variable: usize| self.delays.iter().find(|(v, _)| *v == variable).map(|(_, time)| *time);
        let mut out = Vec::new();
        for (at, entry) in matrix.entries().iter().enumerate() {
            if entry.denominator().variables().into_iter().any(|v| delay_of(v).is_some()) {
                return Err(refused());
            }
            let bottom =
                entry.denominator().terms().iter().map(|(m, c)| c.to_f64_approximate() * self.product(m.exponents()));
            let bottom: f64 = bottom.sum();
            for (monomial, c) in entry.numerator().terms() {
                let exponents = monomial.exponents();
                let delays = exponents.iter().enumerate().filter_map(|(v, &e)| Some(delay_of(v)? * f64::from(e)));
                let value = c.to_f64_approximate() * self.product(exponents) / bottom;
                if !value.is_finite() {
                    return Err(undefined());
                }
                let place = (at / matrix.columns(), at % matrix.columns());
                out.push(EntryPart { place, delay: delays.sum(), value });
            }
        }
        Ok(out)
    }

    /// The powers of the symbols that are numbers.
    fn product(&self, exponents: &[u32]) -> f64 {
        let is_number = |v: usize| self.delays.iter().all(|(d, _)| *d != v);
        let powers = exponents.iter().enumerate().filter(|(v, e)| **e > 0 && is_number(*v));
        powers.map(|(v, &e)| self.values[v].powi(e as i32)).product()
    }
}
