//! Blocks that are active at each so many samples of the loop: the equations of a hyperperiod.
//!
//! A signal has an unknown for each sample of the hyperperiod, a state one for each sample at which its block is active; `w` goes from one hyperperiod
//! to the next. The equations of a block stand at its active samples, a power `z^m` being `m` of its own steps. At other samples an output is what it was
//! one sample before.

use super::{Diagram, Row};
use crate::clock::Clock;
use crate::expression::number;
use crate::multivariate::{Fraction, Multi};
use crate::number::Q;
use crate::toml::Toml;
use num_traits::{One, ToPrimitive};
use std::ops::Range;

/// Hyperperiods with more unknowns are refused.
const MAX_UNKNOWNS: u64 = 400;

/// At which samples a block is active.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rate {
    /// Once in so many samples.
    pub every: u64,
    /// At which of them.
    pub phase: u64,
}

impl Rate {
    pub const ALWAYS: Rate = Rate { every: 1, phase: 0 };

    /// What a block says of it.
    pub fn of(block: &Toml, discrete: bool, clock: &Clock) -> Result<Rate, String> {
        let get = |key: &str, usual: u64| -> Result<u64, String> {
            let Some(value) = block.get(key) else { return Ok(usual) };
            if !discrete {
                return Err(format!("'{key}' in a continuous loop"));
            }
            let found = Some(number(value, clock)?).filter(Q::is_integer).and_then(|q| q.to_integer().to_u64());
            found.ok_or_else(|| format!("'{key}' is not a number of samples"))
        };
        let rate = Rate { every: get("every", 1)?, phase: get("phase", 0)? };
        if rate.phase < rate.every { Ok(rate) } else { Err("'phase' is not below 'every'".into()) }
    }

    fn is_active(self, sample: u64) -> bool {
        sample % self.every == self.phase
    }
}

/// Whether a block of a model is slower than the loop.
pub(crate) fn has_several(model: &Toml) -> bool {
    let is_slow = |block: &Toml| block.get("every").is_some_and(|every| every.expression() != Ok("1"));
    model.get("block").and_then(|blocks| blocks.list().ok()).is_some_and(|blocks| blocks.iter().any(is_slow))
}

/// The rates of rows, of unknowns, and of the blocks with the numbers of their outputs.
#[derive(Default)]
pub(super) struct Rates {
    rows: Vec<Rate>,
    states: Vec<Rate>,
    blocks: Vec<(Rate, Range<usize>)>,
}

impl Rates {
    /// Notes a block that has made the rows and the unknowns up to these numbers; the first `driven` unknowns are signals.
    pub fn note(&mut self, rate: Rate, outputs: Range<usize>, rows: usize, states: usize) {
        self.rows.resize(rows, rate);
        self.states.resize(states, rate);
        self.blocks.push((rate, outputs));
    }

    /// Samples of a hyperperiod.
    fn steps(&self) -> Result<u64, String> {
        let mut steps = 1u64;
        for (rate, _) in &self.blocks {
            let (mut a, mut b) = (steps, rate.every);
            while b > 0 {
                (a, b) = (b, a % b);
            }
            steps = (steps / a).saturating_mul(rate.every);
        }
        let unknowns = steps.saturating_mul((self.rows.len() + self.states.len()) as u64);
        if steps > 1 && unknowns > MAX_UNKNOWNS {
            return Err("a hyperperiod is too long for the check".into());
        }
        Ok(steps)
    }

    /// The first sample at which most outputs of slow blocks are computed: there the fewest are held.
    fn start(&self, steps: u64) -> u64 {
        let computed = |k: u64| -> usize {
            let slow = self.blocks.iter().filter(|(rate, _)| rate.every > 1 && rate.is_active(k));
            slow.map(|(_, outputs)| outputs.len()).sum()
        };
        (0..steps).max_by_key(|&k| (computed(k), steps - k)).unwrap_or(0)
    }
}

impl Diagram<'_, '_> {
    /// Puts the equations of a hyperperiod in the place of those of a sample.
    pub(super) fn lift(&mut self, driven: usize) -> Result<(), String> {
        let steps = self.rates.steps()?;
        if steps == 1 {
            return Ok(());
        }
        let start = self.rates.start(steps);
        // The unknown of a signal or a state at a sample of the hyperperiod.
        let mut places: Vec<Vec<Option<usize>>> = Vec::new();
        let mut next = 0;
        for unknown in 0..self.unknowns {
            let rate = if unknown < driven { Rate::ALWAYS } else { self.rates.states[unknown - driven] };
            let place = |t: u64| {
                let is_there = rate.is_active(start + t);
                next += usize::from(is_there);
                is_there.then(|| next - 1)
            };
            places.push((0..steps).map(place).collect());
        }
        let mut rows = Vec::new();
        for (row, rate) in self.rows.iter().zip(&self.rates.rows) {
            for t in (0..steps).filter(|t| rate.is_active(start + t)) {
                rows.push((t, self.at_sample(row, t, *rate, steps, &places)?));
            }
        }
        for (rate, outputs) in &self.rates.blocks {
            for output in outputs.clone() {
                let at = |t: u64| places[output][t as usize].ok_or("internal: a signal has no unknown");
                for t in (0..steps).filter(|t| !rate.is_active(start + t)) {
                    let (before, now) = match t {
                        0 => (at(steps - 1)?, Fraction::variable(0)),
                        t => (at(t - 1)?, Fraction::number(&Q::one())),
                    };
                    rows.push((t, Row::from([(at(t)?, now), (before, Fraction::number(&-Q::one()))])));
                }
                self.degree += usize::from(!rate.is_active(start));
            }
        }
        // Samples that follow each other share signals: so a minor of the first rows takes few sets of columns.
        rows.sort_by_key(|(t, _)| *t);
        (self.rows, self.unknowns) = (rows.into_iter().map(|(_, row)| row).collect(), next);
        Ok(())
    }

    /// An equation of a block at a sample.
    fn at_sample(
        &self,
        row: &Row,
        t: u64,
        rate: Rate,
        steps: u64,
        places: &[Vec<Option<usize>>],
    ) -> Result<Row, String> {
        let mut out = Row::new();
        for (unknown, f) in row.iter().filter(|(unknown, _)| **unknown < places.len()) {
            if f.denominator != Multi::one() {
                return Err("internal: a coefficient of a signal contains the variable".into());
            }
            for (m, c) in f.numerator.coefficients(0).into_iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                let later = t + m as u64 * rate.every;
                let place = places[*unknown][(later % steps) as usize].ok_or("internal: a state has no unknown")?;
                let turns = Multi::variable(0).power((later / steps) as u32, self.scope.clock)?;
                let numerator = c.times(&turns, self.scope.clock)?;
                let term = Fraction::over(numerator, f.scalar.clone());
                let sum = match out.remove(&place) {
                    Some(known) => known.plus(&term, self.scope.clock)?,
                    None => term,
                };
                out.insert(place, sum);
            }
        }
        Ok(out)
    }
}
