//! Blocks realised in state space, made discrete, and connected.
//!
//! The controllable canonical form of a numerator and a denominator keeps every mode, common
//! factors included: its characteristic polynomial is the denominator.

use super::hold::held;
use super::modulators::periods_agree;
use super::rates::{Lifted, lifted};
use crate::error::{Code, Diagnostic, Span};
use crate::model::complex::{Lift, lifted_system, names_of_parts, ports_as_written, realised_ratio, seen_from};
use crate::model::definition::{Dynamics, Form, Model, Rate};
use crate::model::discretization::Rule;
use crate::model::evaluate::symbolic::{
    BlockValues, DiscretizationValues, DynamicValues, Hold, PortValues, Row, Values, Wiring,
};
use crate::model::evaluate::walk::Failure;
use crate::model::evaluate::work::count_work;
use crate::model::evaluate::zpoly::ZPoly;
use crate::model::presupposed::{Presupposed, Presupposition};
use crate::model::symbols::Symbols;
use crate::model::text::names::shorten;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Enclosure;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use std::cell::RefCell;

/// Why there is no closed loop.
pub(in crate::model) enum NotConnected {
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
pub(in crate::model) type Substitution<'s> = dyn Fn(&RationalFunction) -> Option<RationalFunction> + 's;

/// A realised system; all parts have entries in the kept parameters only.
#[derive(Clone, Debug)]
pub(in crate::model) struct System {
    pub a: RationalMatrix,
    pub b: RationalMatrix,
    pub c: RationalMatrix,
    pub d: RationalMatrix,
}

/// What the connection of blocks needs beside their values.
pub(in crate::model) struct Connecting<'a> {
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
pub(in crate::model) struct Assembled {
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

fn substituted_matrix(m: &RationalMatrix, substitution: &Substitution<'_>) -> Result<RationalMatrix, NotConnected> {
    let mut entries = Vec::with_capacity(m.entries().len());
    for f in m.entries() {
        entries.push(substituted(f, substitution)?);
    }
    let columns = m.columns();
    Ok(RationalMatrix::from_fn(m.rows(), columns, |i, j| entries[i * columns + j].clone()))
}

/// Connects the parts of the model's form. `Characteristic` has no parts and gives order 0. A loop of several rates is that of a
/// hyperperiod.
pub(in crate::model) fn assemble(
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
        let c = selection(&ports.outputs, n, substitution)?;
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

/// The matrix of linear expressions in the first `n` signals.
fn selection(rows: &[Row], n: usize, substitution: &Substitution<'_>) -> Result<RationalMatrix, NotConnected> {
    part(rows, 0, n, substitution)
}

/// The matrix of the coefficients of signals `from .. from + n`.
pub(in crate::model) fn part(
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

/// The controllable canonical form.
fn realise(
    numerator: &ZPoly,
    denominator: &ZPoly,
    block: &BlockValues,
    set: &Substitution<'_>,
    poles: &mut Vec<MultiPoly>,
) -> Result<System, NotConnected> {
    let n = denominator.degree();
    let leading = substituted(&denominator.coefficient(n), set)?;
    let Some(inverse) = leading.recip() else { return Err(loses_order(block)) };
    poles.push(leading.numerator().clone());
    let monic = |p: &ZPoly, k: usize| substituted(&p.coefficient(k), set).map(|c| &c * &inverse);
    let direct = monic(numerator, n)?;
    let mut a = RationalMatrix::zeros(n, n);
    let mut b = RationalMatrix::zeros(n, 1);
    let mut c = RationalMatrix::zeros(1, n);
    for k in 0..n {
        let d = monic(denominator, k)?;
        c[(0, k)] = &monic(numerator, k)? - &(&direct * &d);
        a[(n - 1, k)] = -&d;
        if k + 1 < n {
            a[(k, k + 1)] = RationalFunction::one();
        }
    }
    if n > 0 {
        b[(n - 1, 0)] = RationalFunction::one();
    }
    Ok(System { a, b, c, d: RationalMatrix::from_fn(1, 1, |_, _| direct.clone()) })
}

/// The same of a ratio with complex coefficients.
fn complex_ratio(
    numerator: &[ZPoly; 2],
    denominator: &[ZPoly; 2],
    block: &BlockValues,
    set: &Substitution<'_>,
    poles: &mut Vec<MultiPoly>,
) -> Result<System, NotConnected> {
    let n = denominator.iter().map(ZPoly::degree).max().unwrap_or(0);
    let list = |p: &ZPoly| (0..=n).map(|k| substituted(&p.coefficient(k), set)).collect::<Result<Vec<_>, _>>();
    let numerator = [list(&numerator[0])?, list(&numerator[1])?];
    let denominator = [list(&denominator[0])?, list(&denominator[1])?];
    let Some((system, square)) = realised_ratio(&numerator, &denominator) else { return Err(loses_order(block)) };
    poles.push(square.numerator().clone());
    Ok(system)
}

fn loses_order(block: &BlockValues) -> NotConnected {
    let name = shorten(&block.name);
    let message = format!("the leading coefficient of the denominator of '{name}' is zero: the block loses its order");
    undefined(message, block.span)
}

/// Refuses an angle `w T` that is a number and not below pi.
fn below_half_the_sampling_rate(angle: &RationalFunction, span: Span) -> Result<(), NotConnected> {
    let Some(angle) = angle.as_constant() else { return Ok(()) };
    // A rational number is no multiple of pi but 0.
    let is_below =
        (1..).map(|k| Enclosure::pi(64 * k)).find(|pi| !pi.contains(&angle)).is_some_and(|pi| angle < *pi.lower());
    if is_below && !angle.is_negative() && !angle.is_zero() {
        return Ok(());
    }
    let angle = Presupposition { of: Presupposed::Angle, function: angle.into(), span };
    let error = if is_below { angle.not_positive() } else { angle.too_fast() };
    Err(NotConnected::Refused(Box::new(error)))
}

/// The discrete system that the rule makes of a continuous one.
fn discretised(
    s: System,
    rule: Rule,
    value: &RationalFunction,
    block: &BlockValues,
    poles: &mut Vec<MultiPoly>,
    budget: &Budget,
) -> Result<System, NotConnected> {
    if s.a.rows() == 0 {
        return Ok(s);
    }
    rule(s, value, &mut |matrix: &RationalMatrix| {
        let Some((inverse, determinant)) = solve(matrix, &RationalMatrix::identity(matrix.rows()), budget)? else {
            let message = format!(
                "the discretisation of '{}' divides by zero: the map meets a pole of the block",
                shorten(&block.name)
            );
            return Err(undefined(message, block.span));
        };
        poles.push(determinant.numerator().clone());
        Ok(inverse)
    })
}

/// `M^-1 R` and `det M` by elimination over the field of rational functions; `None` when `M` is
/// singular. Zero entries cost nothing, so a sparse diagram stays cheap.
pub(in crate::model) fn solve(
    m: &RationalMatrix,
    right: &RationalMatrix,
    budget: &Budget,
) -> Result<Option<(RationalMatrix, RationalFunction)>, Exhausted> {
    let n = m.rows();
    let columns = right.columns();
    let mut rows: Vec<Vec<RationalFunction>> = (0..n)
        .map(|i| (0..n).map(|j| m[(i, j)].clone()).chain((0..columns).map(|j| right[(i, j)].clone())).collect())
        .collect();
    let mut determinant = RationalFunction::one();
    for k in 0..n {
        budget.check()?;
        // The simplest pivot keeps the entries small.
        let size = |f: &RationalFunction| f.numerator().terms().len() + f.denominator().terms().len();
        let candidates = (k..n).filter(|&i| !rows[i][k].is_zero());
        let Some(pivot) = candidates.min_by_key(|&i| size(&rows[i][k])) else { return Ok(None) };
        if pivot != k {
            rows.swap(pivot, k);
            determinant = -determinant;
        }
        determinant = &determinant * &rows[k][k];
        let Some(inverse) = rows[k][k].recip() else { return Ok(None) };
        if !inverse.is_one() {
            for f in rows[k].iter_mut().filter(|f| !f.is_zero()) {
                count_work(f, &inverse);
                *f = &*f * &inverse;
            }
        }
        let pivot_row = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            if row[k].is_zero() {
                continue;
            }
            let factor = row[k].clone();
            assert!(i != k);
            for (f, p) in row.iter_mut().zip(&pivot_row).filter(|(_, p)| !p.is_zero()) {
                count_work(&factor, p);
                *f = &*f - &(&factor * p);
            }
        }
    }
    let solution = RationalMatrix::from_fn(n, columns, |i, j| rows[i][n + j].clone());
    Ok(Some((solution, determinant)))
}

/// `left * right`, whose work is counted.
pub(in crate::model) fn product(left: &RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    for (i, k) in (0..left.rows()).flat_map(|i| (0..left.columns()).map(move |k| (i, k))) {
        let a = &left[(i, k)];
        if !a.is_zero() {
            (0..right.columns()).map(|j| &right[(k, j)]).filter(|b| !b.is_zero()).for_each(|b| count_work(a, b));
        }
    }
    left * right
}

fn block_diagonal(parts: &[&RationalMatrix]) -> RationalMatrix {
    let rows = parts.iter().map(|m| m.rows()).sum();
    let columns = parts.iter().map(|m| m.columns()).sum();
    let mut out = RationalMatrix::zeros(rows, columns);
    let (mut top, mut left) = (0, 0);
    for m in parts {
        for i in 0..m.rows() {
            for j in 0..m.columns() {
                out[(top + i, left + j)] = m[(i, j)].clone();
            }
        }
        top += m.rows();
        left += m.columns();
    }
    out
}

/// A block before it is made discrete.
pub(super) fn as_written(
    block: &BlockValues,
    set: &Substitution<'_>,
    poles: &mut Vec<MultiPoly>,
) -> Result<System, NotConnected> {
    match &block.dynamics {
        DynamicValues::Ratio(ratio) => realise(&ratio.numerator, &ratio.denominator, block, set, poles),
        DynamicValues::ComplexRatio { numerator, denominator } => {
            complex_ratio(numerator, denominator, block, set, poles)
        }
        DynamicValues::StateSpace { a, b, c, d } => {
            let set = |m| substituted_matrix(m, set);
            Ok(System { a: set(a)?, b: set(b)?, c: set(c)?, d: set(d)? })
        }
    }
}

/// The blocks of a diagram, each as a system of its own: one for all samples, or one for the even and one for the odd ones.
pub(in crate::model) fn realised(
    blocks: &[BlockValues],
    how: &Connecting<'_>,
    poles: &mut Vec<MultiPoly>,
    leading: &mut RationalFunction,
) -> Result<Vec<Vec<System>>, NotConnected> {
    let Connecting { set, symbols, budget, .. } = *how;
    let mut systems = Vec::with_capacity(blocks.len());
    for block in blocks {
        budget.check()?;
        if let DynamicValues::Ratio(ratio) = &block.dynamics {
            *leading = &*leading * &substituted(&ratio.denominator.leading(), set)?;
            if let Lift::AfterHold = block.lift {
                *leading = &*leading * &substituted(&ratio.denominator.leading(), set)?;
            }
        }
        let mut system = as_written(block, set, poles)?;
        let mut of_samples: Vec<System> = Vec::new();
        match &block.discretization {
            None => {}
            Some(DiscretizationValues::Rule { rule, value, prewarp }) => {
                if let Some(prewarp) = prewarp {
                    below_half_the_sampling_rate(&substituted(&prewarp.angle, set)?, prewarp.span)?;
                }
                system = discretised(system, *rule, &substituted(value, set)?, block, poles, budget)?;
            }
            Some(DiscretizationValues::Hold(hold)) => {
                of_samples = held(system.clone(), hold, block, set, symbols, budget)?
            }
        }
        if of_samples.is_empty() {
            of_samples.push(system);
        }
        with_sizes(&mut of_samples, ports_as_written(block));
        if let Lift::AfterHold = block.lift {
            of_samples = of_samples.iter().map(lifted_system).collect();
        }
        if let Some(DiscretizationValues::Hold(Hold { frame: Some(frame), .. })) = &block.discretization {
            let frame = frame.try_map(&|f| substituted(f, set))?;
            of_samples = of_samples.into_iter().map(|system| seen_from(system, &frame)).collect();
        }
        with_sizes(&mut of_samples, (block.inputs.len(), block.outputs));
        systems.push(of_samples);
    }
    Ok(systems)
}

/// Matrices without rows or columns do not remember their other size.
fn with_sizes(systems: &mut [System], (inputs, outputs): (usize, usize)) {
    for system in systems.iter_mut().filter(|system| system.a.rows() == 0) {
        system.b = RationalMatrix::zeros(0, inputs);
        system.c = RationalMatrix::zeros(outputs, 0);
    }
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
    let rates: Vec<Rate> = blocks.iter().map(|block| block.rate).collect();
    let mut closed = |systems: &[System]| -> Result<System, NotConnected> {
        let (system, determinant) = closed(wiring, blocks, systems, outputs, set, budget)?;
        poles.push(determinant.numerator().clone());
        leading = &leading * &determinant;
        Ok(system)
    };
    let first = || systems.iter().map(|of_samples| of_samples[0].clone()).collect::<Vec<System>>();
    if model.hyperperiod() == 1 || symbols.is_none() {
        let system = closed(&first())?;
        return Ok(Assembled { system, states: states.concat(), poles, leading });
    }
    let Lifted { system, keeps_registers } =
        lifted(&systems, &rates, model.hyperperiod(), start, symbols, budget, closed)?;
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
    let from_states = RationalMatrix::from_fn(rows.len(), n, |i, j| u[(i, j)].clone());
    let from_inputs = RationalMatrix::from_fn(rows.len(), m.columns(), |i, j| u[(i, n + j)].clone());
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

fn beside(left: &RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    RationalMatrix::from_fn(left.rows(), left.columns() + right.columns(), |i, j| {
        if j < left.columns() { left[(i, j)].clone() } else { right[(i, j - left.columns())].clone() }
    })
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
