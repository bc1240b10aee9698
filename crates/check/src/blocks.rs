//! Block diagrams as one polynomial system matrix.
//!
//! The unknowns are the states of all state-space blocks and all driven signals. A block `num/den` gives the row
//! `den y - num u = 0`, a state-space block the rows `z x - A x - B u = 0` and `y - C x - D u = 0`, with `u`
//! written out in signals. The determinant is, up to a factor without `z`, the product of all
//! denominators times `det(I - G L)`: every mode counts, nothing cancels \[Rosenbrock1970\].

mod cut;
mod hold_rows;
mod prewarp;
mod pulses;
mod rates;
mod state_space;
mod transfer;

use super::characteristic::Form;
use super::clock::Clock;
use super::declarations::Declarations;
use super::expression::{Base, Scope};
use super::factor::{Cut, PutIn};
use super::hold::{Hold, MovingHold};
use super::model::{Ports, names, outputs};
use super::multivariate::{Fraction, Multi};
use super::number::Q;
use super::symbols::Table;
use super::toml::Toml;
use rates::{Rate, Rates};
use std::collections::BTreeMap;
use std::ops::Range;

/// `s = top/bottom` with `top`, `bottom` in the variable; both are without denominators.
struct Substitution {
    top: Multi,
    bottom: Multi,
}

/// How a continuous block is made discrete.
enum Rule {
    Quotient(Substitution),
    Hold(Hold),
    /// A hold whose numbers depend on the parameters of a box.
    Moving(MovingHold),
    /// Only what is written is looked at.
    Unknown,
}

/// What the parameters and symbols are, beside which exponentials are taken.
#[derive(Clone, Copy)]
pub(super) struct Values<'v> {
    /// The values of the variables from 2 on; those of a box follow, then the symbols.
    pub numbers: &'v [Q],
    /// The variable of the first symbol.
    pub first: usize,
    pub table: &'v Table,
    /// The base of all dead times.
    pub base: Option<Base<'v>>,
}

impl Values<'_> {
    /// The variable that is the imaginary unit: the last of those with a value.
    fn unit(&self) -> usize {
        self.numbers.len() - 1
    }
}

/// The matrices of a state-space block.
type Matrices = [Vec<Vec<Fraction>>; 4];

type Row = BTreeMap<usize, Fraction>;

struct Diagram<'s, 'c> {
    scope: &'s mut Scope<'c>,
    declared: &'s Declarations<'s>,
    signals: BTreeMap<String, usize>,
    rows: Vec<Row>,
    /// The number of unknowns so far: driven signals first, then states.
    unknowns: usize,
    degree: usize,
    /// The blocks alone.
    alone: Vec<Ordered>,
    sample_time: Option<&'s Toml>,
    values: Option<Values<'s>>,
    rates: Rates,
    /// The rate of the block that is read.
    rate: Rate,
    /// Where a factor is put in: the number of the signal behind it, and what enters it once that is known.
    cut: Option<usize>,
    cut_input: Option<Row>,
    /// `exp(jwT)` of the frame from which it is seen, and the factor of its inputs.
    frame: Option<[Fraction; 2]>,
}

pub(super) use rates::has_several as has_several_rates;

/// A matrix and the degree of its determinant unless a block loses its order.
pub(super) type Ordered = (Vec<Vec<Multi>>, usize);

/// The system matrix with the degree its determinant has when the connection is well posed; and those of all
/// blocks alone: direct feedthrough may keep up the degree of the whole where a block loses its order.
pub(super) fn system_matrix<'t>(
    table: &'t Toml,
    blocks: &'t [Toml],
    declared: &Declarations<'_>,
    scope: &mut Scope<'_>,
    sample_time: Option<&Toml>,
    values: Option<Values<'_>>,
) -> Result<(Form, Ports<'t>), String> {
    let called = cut::called(blocks)?;
    let inputs = names(table, "inputs")?;
    let mut driven = Vec::new();
    for block in blocks {
        driven.extend(names(block, "output")?);
    }
    let all: Vec<&str> = driven.iter().chain(&inputs).copied().collect();
    declared.distinct(&all)?;
    // External signals are zero: their numbers lie beyond all unknowns.
    let external = inputs.iter().enumerate().map(|(i, name)| (*name, usize::MAX - i));
    let numbered = driven.iter().enumerate().map(|(i, name)| (*name, i)).chain(external);
    let signals = numbered.map(|(name, i)| (name.to_owned(), i)).collect();
    // Behind a factor a signal is another one.
    let is_signal = |factor: &&PutIn| matches!(factor.cut, Cut::Signal(_) | Cut::Input(_));
    let cut = scope.factor.as_ref().filter(is_signal).map(|_| driven.len());
    let unknowns = driven.len() + usize::from(cut.is_some());
    let (rows, alone) = (Vec::new(), Vec::new());
    let (rates, rate) = (Rates::default(), Rate { every: 1, phase: 0 });
    let mut diagram = Diagram {
        scope,
        declared,
        signals,
        rows,
        unknowns,
        degree: 0,
        alone,
        sample_time,
        values,
        rates,
        rate,
        cut,
        cut_input: None,
        frame: None,
    };
    let mut first = 0;
    let mut states = Vec::new();
    for (block, called) in blocks.iter().zip(&called) {
        let own = &driven[first..first + names(block, "output")?.len()];
        if block.get("A").is_some() && block.get("C").is_none() {
            states.extend(own);
        }
        diagram.rate = Rate::of(block, declared.discrete, diagram.scope.clock)?;
        diagram.block((block, called), first..first + own.len())?;
        diagram.rates.note(diagram.rate, first..first + own.len(), diagram.rows.len(), diagram.unknowns - unknowns);
        first += own.len();
    }
    diagram.factor(driven.len(), unknowns)?;
    diagram.lift(unknowns)?;
    let outputs = outputs(table, &diagram.signals, diagram.scope)?;
    Ok((diagram.form()?, Ports { inputs, states, signals: driven, outputs }))
}

impl Diagram<'_, '_> {
    fn block(&mut self, (block, called): (&Toml, &str), outputs: Range<usize>) -> Result<(), String> {
        let mut inputs: Vec<Row> = Vec::new();
        for text in block.get("input").map(Toml::one_or_more).unwrap_or_default() {
            inputs.push(self.scope.linear(text, &self.signals)?);
        }
        self.behind_factor(called, &mut inputs)?;
        let (transfer, exponents) = self.without_dead_time(block)?;
        let rule = match block.get("discretize") {
            Some(_) if !self.declared.discrete => return Err("a continuous loop has nothing to discretise".into()),
            Some(how) => Some(self.rule(how, &exponents, &inputs)?),
            None => None,
        };
        for (_, value) in block.section("pwm")? {
            self.scope.scalar(value)?;
        }
        let given = |key: &str| block.get(key).is_some();
        let is_in_states = ["A", "B", "C", "D"].into_iter().any(given);
        let kinds = ["transfer", "gain", "delay"].into_iter().filter(|k| given(k)).count()
            + usize::from(given("num") || given("den"))
            + usize::from(is_in_states);
        if kinds != 1 {
            return Err("a block does not say exactly once what it does".into());
        }
        if is_in_states {
            return self.state_space(block, &inputs, outputs, rule);
        }
        if inputs.len() != 1 || outputs.len() != 1 {
            return Err("a block with one transfer function has one input and one output".into());
        }
        let (num, den) = self.quotient(block, transfer.as_ref(), rule.is_some())?;
        self.transfer_function([num, den], rule, &inputs, outputs)
    }

    /// Adds `factor` times a linear expression to a row.
    fn feed(&mut self, row: &mut Row, factor: &Fraction, input: &Row) -> Result<(), String> {
        for (&signal, c) in input {
            // A signal that stands in an equation over a denominator in z never occurs: scalars only.
            let term = factor.times(c, self.scope.clock)?;
            self.add(row, signal, term)?;
        }
        Ok(())
    }

    fn add(&mut self, row: &mut Row, unknown: usize, term: Fraction) -> Result<(), String> {
        let sum = match row.remove(&unknown) {
            Some(old) => old.plus(&term, self.scope.clock)?,
            None => term,
        };
        row.insert(unknown, sum);
        Ok(())
    }

    /// The rows, each cleared of its scalar denominators, which are divisors noted already.
    fn form(self) -> Result<Form, String> {
        let clock = self.scope.clock;
        let n = self.unknowns;
        let out = self
            .rows
            .iter()
            .map(|row| cleared(row.iter().filter(|(k, _)| **k < n).map(|(k, f)| (*k, f)).collect(), n, clock))
            .collect::<Result<Vec<_>, _>>()?;
        if out.len() != n {
            return Err("the diagram has not as many equations as signals".into());
        }
        Ok(Form::System((out, self.degree), self.alone))
    }
}

/// A row of `n` entries times its least common denominator, which is free of the variable.
pub(super) fn cleared(row: Vec<(usize, &Fraction)>, n: usize, clock: &Clock) -> Result<Vec<Multi>, String> {
    let there = || row.iter().filter(|(_, f)| !f.numerator.is_zero());
    if there().any(|(_, f)| f.denominator != Multi::one()) {
        return Err("internal: a coefficient of a signal contains the variable".into());
    }
    let common = Multi::common_multiple(there().map(|(_, f)| &f.scalar), clock)?;
    let mut entries = vec![Multi::default(); n];
    for (k, f) in there() {
        entries[*k] = f.numerator.times(&common.quotient(&f.scalar, clock)?, clock)?;
    }
    Ok(entries)
}
