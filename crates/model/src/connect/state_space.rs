//! Systems in state space, and how they are connected to one.

use super::matrices::{beside, block_diagonal, product, solve};
use super::modulators::periods_agree;
use super::rates::{Hyperperiod, Lifted};
use super::realise::realised;
use crate::complex::names_of_parts;
use crate::definition::{Dynamics, Form, Model};
use crate::error::{Code, Diagnostic, Span};
use crate::evaluate::values::{BlockValues, PortValues, Row, Values, Wiring};
use crate::evaluate::walk::Failure;
use crate::symbols::Symbols;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use std::cell::RefCell;

/// Why there is no closed loop.
pub(crate) enum NotConnected {
    /// The loop is undefined for these values of the parameters.
    Undefined(Box<Diagnostic>),
    /// What the model asks for has no meaning at these values.
    Refused(Box<Diagnostic>),
    /// The budget ran out.
    Exhausted(Exhausted),
}

impl From<Exhausted> for NotConnected {
    fn from(exhausted: Exhausted) -> Self {
        NotConnected::Exhausted(exhausted)
    }
}

impl From<NotConnected> for Failure {
    fn from(stop: NotConnected) -> Self {
        match stop {
            NotConnected::Undefined(diagnostic) | NotConnected::Refused(diagnostic) => Failure::Wrong(diagnostic),
            NotConnected::Exhausted(exhausted) => Failure::Exhausted(exhausted),
        }
    }
}

/// Sets parameters to values; `None` where that divides by zero.
pub(crate) type Substitution<'s> = dyn Fn(&RationalFunction) -> Option<RationalFunction> + 's;

/// A realised system; all parts have entries in the kept parameters only.
#[derive(Clone, Debug)]
pub(crate) struct System {
    pub a: RationalMatrix,
    pub b: RationalMatrix,
    pub c: RationalMatrix,
    pub d: RationalMatrix,
}

/// What the connection of blocks needs beside their values.
pub(crate) struct Connecting<'a> {
    /// Puts numbers in the place of the parameters that have a value.
    pub set: &'a Substitution<'a>,
    /// Without symbols blocks behind a hold are replaced by systems that pass on at once what they do: enough for checks of what
    /// divides by zero.
    pub symbols: Option<&'a RefCell<Symbols>>,
    /// The sample at which the hyperperiod of a loop with several rates begins, where that matters.
    pub start: Option<u64>,
    pub budget: &'a Budget,
}

/// A closed loop and where it is undefined beyond its expressions.
pub(crate) struct Assembled {
    pub system: System,
    pub states: Vec<String>,
    pub poles: Vec<MultiPoly>,
    /// What the characteristic polynomial of the matrix is to be multiplied by so that nothing is divided out.
    pub leading: RationalFunction,
}

pub(super) fn undefined(message: String, span: Span) -> NotConnected {
    NotConnected::Undefined(Box::new(Diagnostic::error(Code::DivisionByZero, message).at(span, "undefined")))
}

pub(super) fn substituted(
    f: &RationalFunction,
    substitution: &Substitution<'_>,
) -> Result<RationalFunction, NotConnected> {
    substitution(f)
        .ok_or_else(|| undefined("division by zero at these values of the parameters".into(), Span::default()))
}

pub(super) fn substituted_matrix(
    m: &RationalMatrix,
    substitution: &Substitution<'_>,
) -> Result<RationalMatrix, NotConnected> {
    m.try_map(|f| substituted(f, substitution))
}

/// Connects the parts of the model's form. `Characteristic` has no parts and gives order 0. A loop of several rates is that of a
/// hyperperiod.
pub(crate) fn assemble(
    model: &Model,
    wiring: &Wiring<'_>,
    values: &Values,
    how: &Connecting<'_>,
) -> Result<Assembled, NotConnected> {
    let substitution = how.set;
    let set = |m: &RationalMatrix| substituted_matrix(m, substitution);
    let named = |n: usize| match &model.form {
        Form::Matrix { ports, .. } | Form::OutputFeedback { ports, .. } if ports.states.len() == n => {
            ports.states.iter().map(|s| s.name.clone()).collect()
        }
        Form::Matrix { ports, .. } | Form::OutputFeedback { ports, .. }
            if 2 * ports.states.len() == n && wiring.is_complex =>
        {
            names_of_parts(ports.states.iter().map(|s| s.name.clone()))
        }
        _ if wiring.is_complex => names_of_parts((1..=n / 2).map(|i| format!("x_{i}"))),
        _ => (1..=n).map(|i| format!("x_{i}")).collect::<Vec<String>>(),
    };
    let with_ports = |a: RationalMatrix, ports: &PortValues| -> Result<Assembled, NotConnected> {
        let n = a.rows();
        let b = match &ports.input_matrix {
            Some(e) => set(e)?,
            None => RationalMatrix::zeros(n, 0),
        };
        // A matrix without rows does not know its columns.
        let b = if n == 0 { RationalMatrix::zeros(0, wiring.inputs.len()) } else { b };
        let c = part(&ports.outputs, 0, n, substitution)?;
        let d = RationalMatrix::zeros(c.rows(), b.columns());
        Ok(Assembled {
            system: System { a, b, c, d },
            states: named(n),
            poles: Vec::new(),
            leading: RationalFunction::one(),
        })
    };
    match values {
        Values::Characteristic(_) => {
            let empty = || RationalMatrix::zeros(0, 0);
            let system = System { a: empty(), b: empty(), c: empty(), d: empty() };
            Ok(Assembled { system, states: Vec::new(), poles: Vec::new(), leading: RationalFunction::one() })
        }
        Values::Matrix { matrix, ports } => with_ports(set(matrix)?, ports),
        Values::Feedback { a, b, c, k, ports } => {
            let (a, b, c, k) = (set(a)?, set(b)?, set(c)?, set(k)?);
            let closed = if a.rows() == 0 || b.columns() == 0 || c.rows() == 0 {
                a
            } else {
                &a - &product(&product(&b, &k), &c)
            };
            with_ports(closed, ports)
        }
        Values::Blocks { blocks, outputs } => connect(model, wiring, blocks, outputs, how),
    }
}

/// The matrix of the coefficients of signals `from .. from + n`.
pub(crate) fn part(
    rows: &[Row],
    from: usize,
    n: usize,
    substitution: &Substitution<'_>,
) -> Result<RationalMatrix, NotConnected> {
    let mut out = RationalMatrix::zeros(rows.len(), n);
    for (i, row) in rows.iter().enumerate() {
        for (&j, c) in row.range(from..from + n) {
            out[(i, j - from)] = substituted(c, substitution)?;
        }
    }
    Ok(out)
}

fn connect(
    model: &Model,
    wiring: &Wiring<'_>,
    blocks: &[BlockValues],
    outputs: &[Row],
    how: &Connecting<'_>,
) -> Result<Assembled, NotConnected> {
    let Connecting { set, symbols, start, budget } = *how;
    let (mut poles, mut leading) = (Vec::new(), RationalFunction::one());
    periods_agree(blocks, how)?;
    let systems = realised(blocks, how, &mut poles, &mut leading)?;
    let named = |(i, block): (usize, &BlockValues)| match wiring.is_complex {
        true => names_of_parts(state_names(model, i, block, systems[i][0].a.rows() / 2)),
        false => state_names(model, i, block, systems[i][0].a.rows()),
    };
    let mut states: Vec<Vec<String>> = blocks.iter().enumerate().map(named).collect();
    let mut closed = |systems: &[System]| -> Result<System, NotConnected> {
        let (system, determinant) = closed(wiring, blocks, systems, outputs, set, budget)?;
        poles.push(determinant.numerator().clone());
        leading = &leading * &determinant;
        Ok(system)
    };
    if model.hyperperiod() == 1 || symbols.is_none() {
        let first: Vec<System> = systems.into_iter().map(|mut of_samples| of_samples.swap_remove(0)).collect();
        let system = closed(&first)?;
        return Ok(Assembled { system, states: states.concat(), poles, leading });
    }
    let of = Hyperperiod::new(&systems, blocks, model.hyperperiod(), start);
    let Lifted { system, keeps_registers } = of.lifted(symbols, budget, closed)?;
    let Form::Blocks(diagram) = &model.form else { unreachable!("blocks are those of a diagram") };
    for ((states, block), _) in states.iter_mut().zip(&diagram.blocks).zip(keeps_registers).filter(|(_, keeps)| *keeps)
    {
        let held = block.outputs.iter().map(|output| format!("{} held", output.name));
        states.extend(if wiring.is_complex { names_of_parts(held) } else { held.collect() });
    }
    Ok(Assembled { system, states: states.concat(), poles, leading })
}

/// The systems of all blocks at one sample as one, and the determinant that is divided by for it.
pub(super) fn closed(
    wiring: &Wiring<'_>,
    blocks: &[BlockValues],
    systems: &[System],
    outputs: &[Row],
    set: &Substitution<'_>,
    budget: &Budget,
) -> Result<(System, RationalFunction), NotConnected> {
    let diagonal = |part: fn(&System) -> &RationalMatrix| block_diagonal(&systems.iter().map(part).collect::<Vec<_>>());
    let (a, b, c, d) = (diagonal(|s| &s.a), diagonal(|s| &s.b), diagonal(|s| &s.c), diagonal(|s| &s.d));
    let rows: Vec<Row> = blocks.iter().flat_map(|b| b.inputs.iter().cloned()).collect();
    // u = L y + M r, y = C x + D u:  (I - L D) u = L C x + M r.
    let l = part(&rows, 0, wiring.driven, set)?;
    let m = part(&rows, wiring.driven, wiring.inputs.len(), set)?;
    let n = a.rows();
    let left = &RationalMatrix::identity(rows.len()) - &product(&l, &d);
    let lc = product(&l, &c);
    let right = beside(&lc, &m);
    let Some((u, determinant)) = solve(&left, &right, budget)? else {
        return Err(algebraic_loop(blocks, systems));
    };
    let (from_states, from_inputs) = (u.block(0..rows.len(), 0..n), u.block(0..rows.len(), n..u.columns()));
    // All signals, the external ones last.
    let y_states = &c + &product(&d, &from_states);
    let y_inputs = product(&d, &from_inputs);
    let s = part(outputs, 0, wiring.driven, set)?;
    let direct = part(outputs, wiring.driven, wiring.inputs.len(), set)?;
    let system = System {
        a: &a + &product(&b, &from_states),
        b: product(&b, &from_inputs),
        c: product(&s, &y_states),
        d: &product(&s, &y_inputs) + &direct,
    };
    Ok((system, determinant))
}

/// States that are outputs have their names; others are numbered.
fn state_names(model: &Model, i: usize, values: &BlockValues, n: usize) -> Vec<String> {
    if let Form::Blocks(diagram) = &model.form
        && let Some(block) = diagram.blocks.get(i)
        && matches!(block.dynamics, Dynamics::StateSpace { c: None, .. })
        && block.discretization.as_ref().is_none_or(|d| d.method.keeps_states)
    {
        let own = block.outputs.iter().map(|o| o.name.clone());
        return own.chain((block.outputs.len() + 1..=n).map(|k| format!("{}.{k}", values.name))).collect();
    }
    (1..=n).map(|k| format!("{}.{k}", values.name)).collect()
}

fn algebraic_loop(blocks: &[BlockValues], systems: &[System]) -> NotConnected {
    /// Blocks that are pointed at.
    const SHOWN: usize = 5;
    let direct = |s: &&(&BlockValues, &System)| s.1.d.entries().iter().any(|f| !f.is_zero());
    let pairs: Vec<(&BlockValues, &System)> = blocks.iter().zip(systems).collect();
    let mut members = pairs.iter().filter(direct).map(|(b, _)| b.span);
    let error = Diagnostic::error(Code::AlgebraicLoop, "an algebraic loop that is not well posed");
    let mut error = error.at(members.next().unwrap_or_default(), "passes its input on at once");
    for span in members.take(SHOWN) {
        error = error.also(span, "and so does this");
    }
    let help = "around the loop the gain without delay is 1, so the signals have no unique value; change a gain or add a delay";
    NotConnected::Undefined(Box::new(error.help(help)))
}
