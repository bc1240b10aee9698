//! The walk over a program, which makes statements of it.

use super::helpers::{fitting, rounding};
use super::names::Names;
use super::numbers;
use super::statements::{Code, Constant, Expression, Helper, Kind, Operator, Statement, WIDE};
use super::syntax::Syntax;
use super::{Arithmetic, Shipped, TooWide};
use crate::program::{Operand, Program, Term};
use crate::run::{FixedProgram, FloatProgram};
use jurist_algebra::number::{Integer, Rational};
use std::collections::BTreeMap;

/// The statements of a controller.
///
/// Cost: linear in the terms, quadratic in the states.
///
/// # Errors
/// [`TooWide`] where 64 bits are not enough for a sum, or 63 for a signal.
pub(super) fn code(shipped: &Shipped<'_>, name: &str, syntax: &dyn Syntax) -> Result<Code, TooWide> {
    let program = shipped.arithmetic.program();
    let mut walk = Walk::new(program, Names::of(name), syntax);
    let signal = match shipped.arithmetic {
        Arithmetic::Fixed(fixed) => {
            fits(fixed)?;
            walk.fixed(fixed)
        }
        Arithmetic::Float(float) => walk.float(float),
    };
    walk.outputs(signal);
    walk.updates(signal);
    walk.unused();
    let Walk { inputs, states, outputs, constants, helpers, step, .. } = walk;
    let outputs = outputs.into_iter().map(|(name, _)| name).collect();
    Ok(Code { signal, constants, states, inputs, outputs, helpers, step })
}

/// Whether no sum can overflow 64 bits.
fn fits(fixed: &FixedProgram<'_>) -> Result<(), TooWide> {
    if fixed.signal.bits > 63 {
        return Err(TooWide { node: None, bits: fixed.signal.bits.into() });
    }
    for (at, node) in fixed.program.nodes.iter().enumerate() {
        let bits = fixed.greatest_sum(at).bit_length() + 1;
        if bits > 64 {
            return Err(TooWide { node: Some(node.name.clone()), bits });
        }
    }
    Ok(())
}

struct Walk<'p> {
    program: &'p Program,
    syntax: &'p dyn Syntax,
    names: Names,
    inputs: Vec<String>,
    /// What operands of inputs are read from: the input, or what was made to fit.
    read_inputs: Vec<String>,
    states: Vec<String>,
    nodes: Vec<String>,
    /// The name of an output, and whether it is that of its node.
    outputs: Vec<(String, bool)>,
    constants: Vec<Constant>,
    helpers: Vec<Helper>,
    step: Vec<Statement>,
}

/// A name for each of so many inputs or outputs.
pub(crate) fn numbered(name: &str, count: usize) -> Vec<String> {
    if count == 1 { vec![name.into()] } else { (1..=count).map(|k| format!("{name}_{k}")).collect() }
}

impl<'p> Walk<'p> {
    fn new(program: &'p Program, mut names: Names, syntax: &'p dyn Syntax) -> Walk<'p> {
        let inputs: Vec<String> = numbered("u", program.inputs).iter().map(|name| names.free(name)).collect();
        // An output that is a node of its name is that node.
        let mut nodes: BTreeMap<usize, String> = BTreeMap::new();
        let mut outputs = Vec::new();
        for (name, operand) in numbered("y", program.outputs.len()).iter().zip(&program.outputs) {
            let free = names.free(name);
            let node = match operand {
                Operand::Node(at) if program.nodes[*at].name == *name && !nodes.contains_key(at) => Some(*at),
                _ => None,
            };
            nodes.extend(node.map(|at| (at, free.clone())));
            outputs.push((free, node.is_some()));
        }
        let mut named = |(at, node): (usize, &crate::program::Node)| {
            nodes.get(&at).cloned().unwrap_or_else(|| names.free(&node.name))
        };
        let nodes = program.nodes.iter().enumerate().map(&mut named).collect();
        let states = program.states.iter().map(|name| names.free(name)).collect();
        Walk {
            program,
            syntax,
            names,
            read_inputs: inputs.clone(),
            inputs,
            states,
            nodes,
            outputs,
            constants: Vec::new(),
            helpers: Vec::new(),
            step: Vec::new(),
        }
    }

    fn read(&self, operand: Operand) -> Expression {
        match operand {
            Operand::Input(at) => Expression::Name(self.read_inputs[at].clone()),
            Operand::State(at) => Expression::State(self.states[at].clone()),
            Operand::Node(at) => Expression::Name(self.nodes[at].clone()),
        }
    }

    /// The name of the constant of a term that has a coefficient; one that is there already where it is the same number.
    fn constant(&mut self, term: &Term, value: &Rational, kind: Kind, by: &str) -> Option<String> {
        let coefficient = &self.program.coefficients[term.coefficient?];
        let remark = format!("{}{by} = {}{by}", coefficient.name, numbers::exact(&coefficient.exact));
        let same = |constant: &&Constant| constant.remark == remark && constant.value == *value;
        if let Some(constant) = self.constants.iter().find(same) {
            return Some(constant.name.clone());
        }
        let name = self.names.free(&coefficient.name).to_ascii_uppercase();
        self.constants.push(Constant { name: name.clone(), kind, value: value.clone(), remark });
        Some(name)
    }

    fn fixed(&mut self, fixed: &FixedProgram<'_>) -> Kind {
        let width = self.syntax.width(fixed.signal.bits);
        let signal = Kind::Integer(width);
        let fit = self.names.free("fit");
        let fit = self.syntax.function(&fit);
        self.helpers.push(fitting(fit.clone(), &fixed.signal, fixed.overflow));
        if width != fixed.signal.bits {
            for at in 0..self.inputs.len() {
                let name = self.names.free(&format!("{}_fitted", self.inputs[at]));
                let input = Expression::Name(self.inputs[at].clone()).converted(signal, WIDE);
                let value = Expression::Call(fit.clone(), Box::new(input)).converted(WIDE, signal);
                self.step.push(Statement::Let { name: name.clone(), kind: signal, value });
                self.read_inputs[at] = name;
            }
        }
        let mut rounders: BTreeMap<u32, String> = BTreeMap::new();
        for at in 0..self.nodes.len() {
            let sum = self.fixed_sum(fixed, at, signal);
            let name = self.names.free(&format!("{}_sum", self.nodes[at]));
            let mut value = Expression::Name(name.clone());
            self.step.push(Statement::Let { name, kind: WIDE, value: sum });
            let right = fixed.sums[at].right;
            if right > 0 {
                let rounder = rounders.entry(right).or_insert_with(|| {
                    let name = self.syntax.function(&self.names.free(&format!("round{right}")));
                    self.helpers.push(rounding(name.clone(), fixed.signal.rounding, right));
                    name
                });
                value = Expression::Call(rounder.clone(), Box::new(value));
            }
            let value = Expression::Call(fit.clone(), Box::new(value)).converted(WIDE, signal);
            self.step.push(Statement::Let { name: self.nodes[at].clone(), kind: signal, value });
        }
        signal
    }

    /// The sum of a node: each stored integer times the operand times a power of two, which negative numbers have no shift for.
    fn fixed_sum(&mut self, fixed: &FixedProgram<'_>, at: usize, signal: Kind) -> Expression {
        let mut terms = Vec::new();
        for (term, factor) in self.program.nodes[at].terms.iter().zip(&fixed.sums[at].factors) {
            let stored = term.coefficient.map_or(Integer::ONE, |at| fixed.stored[at].clone());
            let zeros = |value: &Integer| value.trailing_zeros().unwrap_or(0);
            let shift = zeros(factor) - zeros(&stored);
            let bits = if stored.abs().bit_length() < 32 { 32 } else { 64 };
            let kind = Kind::Integer(self.syntax.width(bits));
            let operand = self.read(term.operand).converted(signal, WIDE);
            let mut product = match self.constant(term, &stored.into(), kind, "") {
                Some(name) => Expression::Constant(name).converted(kind, WIDE).with(Operator::Times, operand),
                None => operand,
            };
            if shift > 0 {
                product = product.with(Operator::Times, Expression::Whole(Integer::ONE << shift));
            }
            terms.push((term.is_negative, product));
        }
        Expression::sum(terms).unwrap_or(Expression::Whole(Integer::ZERO))
    }

    fn float(&mut self, float: &FloatProgram<'_>) -> Kind {
        let signal = Kind::Float(float.format);
        for at in 0..self.nodes.len() {
            let mut terms = Vec::new();
            for (term, factor) in self.program.nodes[at].terms.iter().zip(&float.factors[at]) {
                let by =
                    if term.shift == 0 { String::new() } else { format!(" * {}", numbers::power(term.shift.into())) };
                let operand = self.read(term.operand);
                let product = match self.constant(term, factor, signal, &by) {
                    Some(name) => Expression::Constant(name).with(Operator::Times, operand),
                    None if factor.is_one() => operand,
                    None => Expression::Real(float.format, factor.clone()).with(Operator::Times, operand),
                };
                terms.push((term.is_negative, product));
            }
            let value = Expression::sum(terms).unwrap_or(Expression::Real(float.format, Rational::ZERO));
            self.step.push(Statement::Let { name: self.nodes[at].clone(), kind: signal, value });
        }
        signal
    }

    /// Outputs that are no nodes of their name, while states are the old ones.
    fn outputs(&mut self, kind: Kind) {
        for ((name, is_node), operand) in self.outputs.iter().zip(&self.program.outputs) {
            if !is_node {
                self.step.push(Statement::Let { name: name.clone(), kind, value: self.read(*operand) });
            }
        }
    }

    /// The new states: one is written when none that waits still reads it. Where states wait for each other in a circle one is kept.
    fn updates(&mut self, kind: Kind) {
        let mut open: Vec<(usize, Operand)> = self.program.updates.iter().copied().enumerate().collect();
        open.retain(|(state, operand)| *operand != Operand::State(*state));
        let mut kept: BTreeMap<usize, String> = BTreeMap::new();
        while !open.is_empty() {
            let is_read = |state: usize| {
                let reads = |(_, operand): &(usize, Operand)| *operand == Operand::State(state);
                !kept.contains_key(&state) && open.iter().any(reads)
            };
            let Some(next) = (0..open.len()).find(|k| !is_read(open[*k].0)) else {
                let state = open[0].0;
                let name = self.names.free(&format!("{}_old", self.states[state]));
                let value = self.read(Operand::State(state));
                self.step.push(Statement::Let { name: name.clone(), kind, value });
                kept.insert(state, name);
                continue;
            };
            let (state, operand) = open.remove(next);
            let value = match operand {
                Operand::State(of) if kept.contains_key(&of) => Expression::Name(kept[&of].clone()),
                _ => self.read(operand),
            };
            self.step.push(Statement::Set { state: self.states[state].clone(), value });
        }
    }

    /// Inputs and nodes that nothing reads: compilers would warn of them.
    fn unused(&mut self) {
        let program = self.program;
        let of_nodes = program.nodes.iter().flat_map(|node| node.terms.iter().map(|term| term.operand));
        let read: Vec<Operand> =
            of_nodes.chain(program.updates.iter().copied()).chain(program.outputs.clone()).collect();
        let inputs = self.read_inputs.iter().enumerate().map(|(at, name)| (Operand::Input(at), name));
        let nodes = self.nodes.iter().enumerate().map(|(at, name)| (Operand::Node(at), name));
        let unused = inputs.chain(nodes).filter(|(operand, _)| !read.contains(operand));
        self.step.extend(unused.map(|(_, name)| Statement::Unused(name.clone())));
    }
}
