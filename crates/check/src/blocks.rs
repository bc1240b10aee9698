//! Block diagrams as one polynomial system matrix.
//!
//! The unknowns are the states of all state-space blocks and all driven signals. A block `num/den` gives the row
//! `den y - num u = 0`, a state-space block the rows `z x - A x - B u = 0` and `y - C x - D u = 0`, with `u`
//! written out in signals. The determinant is, up to a factor without `z`, the product of all
//! denominators times `det(I - G L)`: every mode counts, nothing cancels \[Rosenbrock1970\].

#![expect(clippy::needless_range_loop, reason = "matrix indices, as in the formulas")]

mod cut;
mod hold_rows;
mod prewarp;
mod pulses;
mod rates;

use super::characteristic::Form;
use super::clock::Clock;
use super::declarations::Declarations;
use super::exponentials::without_exponentials;
use super::expression::{Base, Names, Scope, number};
use super::factor::Cut;
use super::hold::{Hold, MovingHold};
use super::model::{Ports, matrix, names, outputs, sized};
use super::moving::Moving;
use super::multivariate::{Fraction, Multi};
use super::number::{Q, Z, shorten};
use super::symbols::Table;
use super::toml::Toml;
use hold_rows::is_hold;
use num_traits::{One, ToPrimitive, Zero};
use rates::{Rate, Rates};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Delays of more samples are refused.
const MAX_DELAY: u32 = 2000;

/// Transfer functions of higher orders are refused.
const MAX_ORDER: usize = 2000;

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
    let mut called = BTreeSet::new();
    if let Some(name) = blocks.iter().filter_map(|b| b.get("name")?.text().ok()).find(|name| !called.insert(*name)) {
        return Err(format!("two blocks are called '{}'", shorten(name)));
    }
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
    let cut = scope.factor.as_ref().filter(|factor| !matches!(factor.cut, Cut::Parameter(_))).map(|_| driven.len());
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
    for block in blocks {
        let own = &driven[first..first + names(block, "output")?.len()];
        if block.get("A").is_some() && block.get("C").is_none() {
            states.extend(own);
        }
        diagram.rate = Rate::of(block, declared.discrete, diagram.scope.clock)?;
        diagram.block(block, first..first + own.len())?;
        diagram.rates.note(diagram.rate, first..first + own.len(), diagram.rows.len(), diagram.unknowns - unknowns);
        first += own.len();
    }
    diagram.factor(driven.len(), unknowns)?;
    diagram.lift(unknowns)?;
    let outputs = outputs(table, &diagram.signals, diagram.scope)?;
    Ok((diagram.form()?, Ports { inputs, states, signals: driven, outputs }))
}

impl Diagram<'_, '_> {
    fn block(&mut self, block: &Toml, outputs: Range<usize>) -> Result<(), String> {
        let mut inputs: Vec<Row> = Vec::new();
        for text in block.get("input").map(Toml::one_or_more).unwrap_or_default() {
            inputs.push(self.scope.linear(text, &self.signals)?);
        }
        self.behind_factor(block, &mut inputs)?;
        let (mut transfer, mut exponents) = (block.get("transfer").cloned(), Vec::new());
        if let (Some(Toml::Text(text)), Some(how)) = (&transfer, block.get("discretize"))
            && is_hold(how)?
            && !self.scope.knows("exp")
        {
            let (rest, found) = without_exponentials(text);
            exponents = found.iter().map(|e| (*e).to_owned()).collect();
            transfer = Some(Toml::Text(rest));
        }
        let substitution = match block.get("discretize") {
            Some(_) if !self.declared.discrete => return Err("a continuous loop has nothing to discretise".into()),
            Some(how) => Some(self.rule(how, &exponents, &inputs)?),
            None => None,
        };
        let inner = if substitution.is_some() { "s" } else { self.declared.variable() };
        for (_, value) in block.section("pwm")? {
            self.scope.scalar(value)?;
        }
        let given = |key: &str| block.get(key).is_some();
        let kinds = ["transfer", "gain", "delay"].into_iter().filter(|k| given(k)).count()
            + usize::from(given("num") || given("den"))
            + usize::from(["A", "B", "C", "D"].into_iter().any(given));
        if kinds != 1 {
            return Err("a block does not say exactly once what it does".into());
        }
        if ["A", "B", "C", "D"].into_iter().any(given) {
            return self.state_space(block, &inputs, outputs, substitution);
        }
        if inputs.len() != 1 || outputs.len() != 1 {
            return Err("a block with one transfer function has one input and one output".into());
        }
        let clock = self.scope.clock;
        let (num, den) = if let (Some(time), true) = (block.get("delay"), self.scope.dead_time.is_some()) {
            let time = self.scope.scalar(time).and_then(|time| self.scope.real(time))?;
            (self.scope.delayed(&time, 0)?.numerator, Multi::one())
        } else if let Some(time) = block.get("delay")
            && self.scope.moving.as_ref().is_some_and(Moving::is_continuous)
        {
            let time = self.scope.scalar(time).and_then(|time| self.scope.real(time))?;
            let moving = self.scope.moving.as_mut().ok_or("internal: no functions are read")?;
            (moving.delayed(time)?.numerator, Multi::one())
        } else if let Some(samples) = block.get("delay") {
            let samples = number(samples, clock)?;
            let samples = Some(samples).filter(Q::is_integer).and_then(|q| q.to_integer().to_u32());
            let Some(samples) = samples.filter(|&k| k <= MAX_DELAY && inner == "z") else {
                return Err("a delay is not a number of samples".into());
            };
            (Multi::one(), Multi::variable(0).power(samples, clock)?)
        } else if let (Some(num), Some(den)) = (block.get("num"), block.get("den")) {
            let (num, den) = (self.coefficients(num)?, self.coefficients(den)?);
            // Both over the scalar denominators of both.
            (num.numerator.times(&den.scalar, clock)?, den.numerator.times(&num.scalar, clock)?)
        } else {
            let f = if let Some(text) = &transfer {
                // Signals are not known there, constants and parameters are.
                if substitution.is_some() && self.declared.is_taken(inner) {
                    return Err("'s' is the variable of a block and also something else".into());
                }
                self.scope.value(text, Names::Variable(inner))?
            } else {
                self.scope.scalar(block.get("gain").ok_or("a block has no 'num' or no 'den'")?)?
            };
            let den = f.whole_denominator(clock)?;
            (f.numerator, den)
        };
        if den.is_zero() || num.degree(0) > den.degree(0) || den.degree(0) > MAX_ORDER {
            return Err("a transfer function is improper, or of too high an order".into());
        }
        if substitution.is_some() {
            // The order of the continuous block.
            let lead = den.coefficients(0).pop().unwrap_or_default();
            self.alone.push((vec![vec![lead]], 0));
        }
        let substitution = match substitution {
            None | Some(Rule::Unknown) => None,
            Some(Rule::Quotient(substitution)) => Some(substitution),
            Some(Rule::Hold(hold)) => {
                let matrices = self.realised(&num, &den)?;
                let of = self.enclosed(&matrices[0], inputs.len(), &hold)?;
                return self.held(matrices, of, &inputs, outputs);
            }
            Some(Rule::Moving(hold)) => {
                let matrices = self.realised(&num, &den)?;
                let of = self.moving(&matrices[0], inputs.len(), &hold)?;
                return self.held(matrices, of, &inputs, outputs);
            }
        };
        let (num, den, order) = self.substituted(&num, &den, substitution)?;
        self.degree += order;
        self.alone.push((vec![vec![den.clone()]], order));
        let mut row: Row = BTreeMap::new();
        let whole = |m: Multi| Fraction { numerator: m, denominator: Multi::one(), scalar: Multi::one() };
        row.insert(outputs.start, whole(den));
        let minus = whole(num).negated();
        self.feed(&mut row, &minus, &inputs[0])?;
        self.rows.push(row);
        Ok(())
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

    /// A list of coefficients, highest power first, as a polynomial in the variable.
    fn coefficients(&mut self, list: &Toml) -> Result<Fraction, String> {
        let mut sum = Fraction::number(&Q::zero());
        let z = Fraction::variable(0);
        if list.one_or_more().is_empty() {
            return Err("a list has no coefficients".into());
        }
        for c in list.one_or_more() {
            let c = self.scope.scalar(c)?;
            sum = sum.times(&z, self.scope.clock)?.plus(&c, self.scope.clock)?;
        }
        Ok(sum)
    }

    fn substitution(
        &mut self,
        method: &str,
        time: Option<Fraction>,
        factor: Option<Fraction>,
    ) -> Result<Substitution, String> {
        let clock = self.scope.clock;
        let whole = |f: &Fraction| Ok::<_, String>((f.numerator.clone(), f.whole_denominator(clock)?));
        let z = Multi::variable(0);
        let (minus, plus) = (z.minus(&Multi::one()), z.plus(&Multi::one()));
        match (method, &time, &factor) {
            ("forward" | "backward", Some(time), None) => {
                let (n, d) = whole(time)?;
                let bottom = if method == "forward" { n } else { n.times(&z, clock)? };
                Ok(Substitution { top: minus.times(&d, clock)?, bottom })
            }
            ("tustin", _, Some(c)) => {
                let (n, d) = whole(c)?;
                Ok(Substitution { top: minus.times(&n, clock)?, bottom: plus.times(&d, clock)? })
            }
            ("tustin", Some(time), None) => {
                // c = 2/T divides by T.
                if time.numerator.is_zero() {
                    return Err("division by a sample time that is zero".into());
                }
                self.scope.divisors.insert(time.numerator.clone());
                let (n, d) = whole(time)?;
                let top = minus.times(&d.scaled(&Z::from(2)), clock)?;
                Ok(Substitution { top, bottom: plus.times(&n, clock)? })
            }
            _ => Err("'discretize' is not complete".into()),
        }
    }

    /// Numerator and denominator after `s = top/bottom`, times `bottom^order`, and the order.
    fn substituted(
        &self,
        num: &Multi,
        den: &Multi,
        substitution: Option<Substitution>,
    ) -> Result<(Multi, Multi, usize), String> {
        let order = den.degree(0);
        let Some(Substitution { top, bottom }) = substitution else { return Ok((num.clone(), den.clone(), order)) };
        let clock = self.scope.clock;
        let replace = |p: &Multi| -> Result<Multi, String> {
            let mut sum = Multi::default();
            for (k, c) in p.coefficients(0).iter().enumerate() {
                let power = top.power(k as u32, clock)?.times(&bottom.power((order - k) as u32, clock)?, clock)?;
                sum = sum.plus(&c.times(&power, clock)?);
            }
            Ok(sum)
        };
        Ok((replace(num)?, replace(den)?, order))
    }

    fn state_space(
        &mut self,
        block: &Toml,
        inputs: &[Row],
        outputs: Range<usize>,
        rule: Option<Rule>,
    ) -> Result<(), String> {
        let clock = self.scope.clock;
        let mut get = |key: &str| block.get(key).map(|m| matrix(m, self.scope)).transpose();
        let (a, b, c, d) = (get("A")?, get("B")?, get("C")?, get("D")?);
        let (a, b, c) = match (a, b) {
            (Some(a), Some(b)) => (a, b, c),
            (None, None) if c.is_none() => (Vec::new(), Vec::new(), Some(vec![Vec::new(); outputs.len()])),
            _ => return Err("a state-space block needs A and B".into()),
        };
        let n = a.len();
        sized(&a, n, n)?;
        sized(&b, n, inputs.len())?;
        let unit = |i: usize, j: usize| Fraction::number(&if i == j { Q::one() } else { Q::zero() });
        let c = match c {
            Some(c) => c,
            None => (0..n).map(|i| (0..n).map(|j| unit(i, j)).collect()).collect(),
        };
        sized(&c, outputs.len(), n)?;
        if let Some(d) = &d {
            sized(d, outputs.len(), inputs.len())?;
        }
        let of = match &rule {
            Some(Rule::Hold(hold)) => Some(self.enclosed(&a, inputs.len(), hold)?),
            Some(Rule::Moving(hold)) => Some(self.moving(&a, inputs.len(), hold)?),
            _ => None,
        };
        if let Some(of) = of {
            let nothing = || vec![vec![Fraction::number(&Q::zero()); inputs.len()]; outputs.len()];
            return self.held([a, b, c, d.unwrap_or_else(nothing)], of, inputs, outputs);
        }
        let substitution = match rule {
            Some(Rule::Quotient(substitution)) => Some(substitution),
            _ => None,
        };
        let discretised = substitution.is_some();
        let (top, bottom) = match substitution {
            Some(s) => (s.top, s.bottom),
            None => (Multi::variable(0), Multi::one()),
        };
        let whole = |m: Multi| Fraction { numerator: m, denominator: Multi::one(), scalar: Multi::one() };
        let minus_bottom = whole(bottom).negated();
        let first = self.unknowns;
        self.unknowns += n;
        self.degree += n;
        let mut alone = Vec::new();
        for i in 0..n {
            // top x - bottom (A x + B u) = 0
            let mut row = Row::new();
            row.insert(first + i, whole(top.clone()));
            for j in 0..n {
                self.add(&mut row, first + j, a[i][j].times(&minus_bottom, clock)?)?;
            }
            let states = row.iter().map(|(k, f)| (k - first, f)).collect();
            alone.push(cleared(states, n, clock)?);
            for (j, input) in inputs.iter().enumerate() {
                let factor = b[i][j].times(&minus_bottom, clock)?;
                self.feed(&mut row, &factor, input)?;
            }
            self.rows.push(row);
        }
        if discretised {
            self.alone.push((alone, n));
        }
        for (i, output) in outputs.enumerate() {
            // y - C x - D u = 0
            let mut row = Row::new();
            row.insert(output, Fraction::number(&Q::one()));
            for j in 0..n {
                self.add(&mut row, first + j, c[i][j].clone().negated())?;
            }
            for (j, input) in inputs.iter().enumerate() {
                if let Some(d) = &d {
                    let factor = d[i][j].clone().negated();
                    self.feed(&mut row, &factor, input)?;
                }
            }
            self.rows.push(row);
        }
        Ok(())
    }

    /// The rows, each cleared of its scalar denominators, which are divisors noted already.
    fn form(self) -> Result<Form, String> {
        let clock = self.scope.clock;
        let n = self.unknowns;
        let mut out = Vec::with_capacity(n);
        for row in &self.rows {
            out.push(cleared(row.iter().filter(|(k, _)| **k < n).map(|(k, f)| (*k, f)).collect(), n, clock)?);
        }
        if out.len() != n {
            return Err("the diagram has not as many equations as signals".into());
        }
        Ok(Form::System((out, self.degree), self.alone))
    }
}

/// A row of `n` entries times its least common denominator, which is free of the variable.
pub(super) fn cleared(row: Vec<(usize, &Fraction)>, n: usize, clock: &Clock) -> Result<Vec<Multi>, String> {
    let mut common = Multi::one();
    for (_, f) in row.iter().filter(|(_, f)| !f.numerator.is_zero()) {
        if f.denominator != Multi::one() {
            return Err("internal: a coefficient of a signal contains the variable".into());
        }
        let g = common.gcd(&f.scalar, clock)?;
        let rest = f.scalar.divided(&g, clock)?.ok_or("internal: a gcd does not divide")?;
        common = common.times(&rest, clock)?;
    }
    let mut entries = vec![Multi::default(); n];
    for (k, f) in row.into_iter().filter(|(_, f)| !f.numerator.is_zero()) {
        let factor = common.divided(&f.scalar, clock)?.ok_or("internal: a common multiple is none")?;
        entries[k] = f.numerator.times(&factor, clock)?;
    }
    Ok(entries)
}
