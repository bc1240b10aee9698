//! Blocks that run at multiples of the loop's sample time, and modulators whose edges alternate: the loop over one hyperperiod.
//!
//! Each output of a slower block has a register that holds it until the block is active again. With these registers among the states,
//! each sample has a system of its own, and the product of their matrices is the loop from one hyperperiod to the next: its
//! eigenvalues do not depend on where the hyperperiod begins, but for zeros [Kranc1957].

use super::matrices::product;
use super::state_space::{NotConnected, System};
use crate::definition::Rate;
use crate::evaluate::values::BlockValues;
use crate::symbols::Symbols;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::RationalFunction;
use std::cell::RefCell;

/// The blocks of a loop over a hyperperiod.
pub(super) struct Hyperperiod<'s> {
    systems: &'s [Vec<System>],
    rates: Vec<Rate>,
    steps: u64,
    /// The sample at which it begins.
    start: u64,
}

/// Samples in a row in which the loop is the same.
pub(super) struct Run {
    /// The first one.
    pub sample: u64,
    /// How many these are.
    pub length: u64,
    /// Which blocks are active, and at last whether the sample is odd where that matters: systems are the same where these are.
    pub active: Vec<bool>,
}

impl<'s> Hyperperiod<'s> {
    /// It begins at a sample, or where most registers are overwritten at once.
    pub fn new(systems: &'s [Vec<System>], blocks: &[BlockValues], steps: u64, start: Option<u64>) -> Self {
        let rates: Vec<Rate> = blocks.iter().map(|block| block.rate).collect();
        let overwritten = |k: u64| -> usize {
            let slow = systems.iter().zip(&rates).filter(|(_, rate)| rate.every > 1 && rate.is_active(k));
            slow.map(|(s, _)| s[0].d.rows()).sum()
        };
        let fewest_registers = || (0..steps).max_by_key(|&k| (overwritten(k), steps - k)).unwrap_or(0);
        let start = start.unwrap_or_else(fewest_registers);
        Hyperperiod { systems, rates, steps, start }
    }

    /// The systems of blocks at a sample, with the registers of slower blocks behind their states: those that are active compute, the others
    /// show what they hold.
    pub fn at_sample(&self, sample: u64) -> Vec<System> {
        let at = |(of_samples, rate): (&Vec<System>, &Rate)| {
            let s = &of_samples[sample as usize % of_samples.len()];
            match (rate.every, rate.is_active(sample)) {
                (1, _) => s.clone(),
                (_, true) => computing(s),
                (_, false) => holding(s),
            }
        };
        self.systems.iter().zip(&self.rates).map(at).collect()
    }

    /// The loop from one hyperperiod to the next; `connect` makes one system of those of all blocks.
    ///
    /// Cost: products of matrices, as many as blocks change between being active and not, each with the logarithm of the samples between.
    pub fn lifted(
        &self,
        symbols: Option<&RefCell<Symbols>>,
        budget: &Budget,
        mut connect: impl FnMut(&[System]) -> Result<System, NotConnected>,
    ) -> Result<Lifted, NotConnected> {
        let mut known: Vec<(Vec<bool>, System)> = Vec::new();
        let (mut whole, mut first): (Option<System>, Option<System>) = (None, None);
        for Run { sample, length, active } in self.runs() {
            budget.check()?;
            let system = match known.iter().find(|(pattern, _)| *pattern == active) {
                Some((_, system)) => system.clone(),
                None => {
                    let system = shortened(connect(&self.at_sample(sample))?, symbols);
                    known.push((active, system.clone()));
                    system
                }
            };
            first.get_or_insert_with(|| system.clone());
            let run = power(&system, length, symbols, budget)?;
            whole = Some(match whole {
                None => run,
                Some(before) => shortened(after(&run, &before), symbols),
            });
        }
        let (whole, first) = (whole.expect("a hyperperiod has a sample"), first.expect("a hyperperiod has a sample"));
        let places = self.kept_places();
        let kept: Vec<usize> = (0..places.len()).filter(|&k| places[k].is_some()).collect();
        let n = kept.len();
        let system = System {
            a: whole.a.principal(&kept),
            b: RationalMatrix::from_fn(n, whole.b.columns(), |i, j| whole.b[(kept[i], j)].clone()),
            c: RationalMatrix::from_fn(first.c.rows(), n, |i, j| first.c[(i, kept[j])].clone()),
            d: first.d,
        };
        let keeps_registers = |rate: &Rate| rate.every > 1 && !rate.is_active(self.start);
        Ok(Lifted { system, keeps_registers: self.rates.iter().map(keeps_registers).collect() })
    }

    /// For each state of a sample, registers among them, which state of the hyperperiod it is; `None` for a register that the first sample
    /// overwrites.
    pub fn kept_places(&self) -> Vec<Option<usize>> {
        let (mut places, mut next) = (Vec::new(), 0);
        for (s, rate) in self.systems.iter().zip(&self.rates) {
            let registers = if rate.every > 1 { s[0].d.rows() } else { 0 };
            for k in 0..s[0].a.rows() + registers {
                let is_state = k < s[0].a.rows() || !rate.is_active(self.start);
                places.push(is_state.then_some(next));
                next += usize::from(is_state);
            }
        }
        places
    }

    /// The samples of the hyperperiod.
    pub fn runs(&self) -> impl Iterator<Item = Run> {
        let alternates = self.systems.iter().any(|of_samples| of_samples.len() > 1);
        let (mut next, end) = (self.start, self.start + self.steps);
        std::iter::from_fn(move || {
            let sample = (next < end).then_some(next)?;
            let length = if alternates { 1 } else { run_length(&self.rates, sample, end) };
            next += length;
            let parity = alternates && sample % 2 == 1;
            let active = self.rates.iter().map(|rate| rate.is_active(sample)).chain([parity]).collect();
            Some(Run { sample, length, active })
        })
    }
}

fn computing(s: &System) -> System {
    let (n, inputs, outputs) = (s.a.rows(), s.d.columns(), s.d.rows());
    let zero = RationalFunction::zero;
    System {
        a: RationalMatrix::from_fn(n + outputs, n + outputs, |i, j| match (i < n, j < n) {
            (_, false) => zero(),
            (true, _) => s.a[(i, j)].clone(),
            (false, _) => s.c[(i - n, j)].clone(),
        }),
        b: RationalMatrix::from_fn(n + outputs, inputs, |i, j| {
            if i < n { s.b[(i, j)].clone() } else { s.d[(i - n, j)].clone() }
        }),
        c: RationalMatrix::from_fn(outputs, n + outputs, |i, j| if j < n { s.c[(i, j)].clone() } else { zero() }),
        d: s.d.clone(),
    }
}

fn holding(s: &System) -> System {
    let (n, inputs, outputs) = (s.a.rows(), s.d.columns(), s.d.rows());
    let unit = |is: bool| if is { RationalFunction::one() } else { RationalFunction::zero() };
    System {
        a: RationalMatrix::identity(n + outputs),
        b: RationalMatrix::zeros(n + outputs, inputs),
        c: RationalMatrix::from_fn(outputs, n + outputs, |i, j| unit(j == n + i)),
        d: RationalMatrix::zeros(outputs, inputs),
    }
}

/// A loop over its hyperperiod.
pub(super) struct Lifted {
    /// The system from one hyperperiod to the next, its outputs those of the first sample; inputs stay what they are for a hyperperiod.
    pub system: System,
    /// For each block, whether its registers are among the states.
    pub keeps_registers: Vec<bool>,
}

/// For how many samples the same blocks are active, up to an end.
fn run_length(rates: &[Rate], sample: u64, end: u64) -> u64 {
    let is_same = |k: &u64| rates.iter().all(|rate| rate.is_active(*k) == rate.is_active(sample));
    (sample..end).take_while(is_same).count() as u64
}

/// What `first` and then `then` do with inputs that stay.
fn after(then: &System, first: &System) -> System {
    System {
        a: product(&then.a, &first.a),
        b: &product(&then.a, &first.b) + &then.b,
        c: first.c.clone(),
        d: first.d.clone(),
    }
}

fn power(of: &System, count: u64, symbols: Option<&RefCell<Symbols>>, budget: &Budget) -> Result<System, NotConnected> {
    let (mut result, mut square, mut rest): (Option<System>, System, u64) = (None, of.clone(), count);
    loop {
        budget.check()?;
        if rest % 2 == 1 {
            result = Some(match result {
                None => square.clone(),
                Some(result) => shortened(after(&square, &result), symbols),
            });
        }
        rest /= 2;
        if rest == 0 {
            return Ok(result.expect("a run has a sample"));
        }
        square = shortened(after(&square, &square), symbols);
    }
}

/// The system with symbols in the place of long entries, where only numbers are asked for.
fn shortened(system: System, symbols: Option<&RefCell<Symbols>>) -> System {
    let Some(symbols) = symbols.filter(|symbols| symbols.borrow().keeps_flows()) else { return system };
    let mut symbols = symbols.borrow_mut();
    let mut short = |m: &RationalMatrix| symbols.shortened_beside_names(m);
    System { a: short(&system.a), b: short(&system.b), c: system.c, d: system.d }
}
