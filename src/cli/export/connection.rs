//! How the blocks of a diagram are connected.

use super::blocks::{block, step_of};
use super::formula::{is_one, is_zero, negative, power, product, quotient, sum, whole};
use super::{Body, Diagram, Grid, Matrices, Step};
use crate::cli::status::Error;
use jurist_algebra::limits::Budget;
use jurist_engine::model::{self, Expression, Factor, Name, Node, Sign};
use jurist_engine::problem::Problem;
use std::collections::BTreeMap;

/// The coefficients of signals, by their numbers, and a part without signals.
struct Linear {
    constant: Expression,
    coefficients: BTreeMap<usize, Expression>,
}

impl Linear {
    fn constant(constant: Expression) -> Linear {
        Linear { constant, coefficients: BTreeMap::new() }
    }

    fn plus(mut self, sign: Sign, other: Linear) -> Linear {
        self.constant = sum(self.constant, sign, other.constant);
        for (i, c) in other.coefficients {
            let entry = self.coefficients.entry(i).or_insert_with(|| whole(0));
            *entry = sum(std::mem::replace(entry, whole(0)), sign, c);
        }
        self
    }

    fn scaled(self, by: impl Fn(Expression) -> Expression) -> Linear {
        let coefficients = self.coefficients.into_iter().map(|(i, c)| (i, by(c))).collect();
        Linear { constant: by(self.constant), coefficients }
    }

    fn times(self, other: Linear) -> Linear {
        match self.coefficients.is_empty() {
            true => other.scaled(|c| product(self.constant.clone(), c)),
            false => self.scaled(|c| product(c, other.constant.clone())),
        }
    }
}

/// A linear expression, which the engine has found to be one.
fn linear(e: &Expression, signals: &[&str]) -> Linear {
    let of = |e: &Expression| linear(e, signals);
    match &e.node {
        Node::Number(_) | Node::Call(..) => Linear::constant(e.clone()),
        Node::Name(name) => match signals.iter().position(|signal| signal == name) {
            Some(i) => Linear { constant: whole(0), coefficients: BTreeMap::from([(i, whole(1))]) },
            None => Linear::constant(e.clone()),
        },
        Node::Negative(inner) => of(inner).scaled(negative),
        Node::Sum(terms) => {
            terms.iter().fold(Linear::constant(whole(0)), |all, (sign, term)| all.plus(*sign, of(term)))
        }
        Node::Product(factors) => factors.iter().fold(Linear::constant(whole(1)), |all, (factor, e)| match factor {
            Factor::Times => all.times(of(e)),
            Factor::Over => {
                let divisor = of(e).constant;
                all.scaled(|c| quotient(c, divisor.clone()))
            }
        }),
        Node::Power(base, exponent) => match of(base) {
            base if base.coefficients.is_empty() => Linear::constant(power(base.constant, *exponent)),
            base => base,
        },
    }
}

/// A row for each linear expression in these signals.
pub(super) fn rows<'e>(list: impl Iterator<Item = &'e Expression>, signals: &[&str]) -> Grid {
    let rows: Vec<Linear> = list.map(|e| linear(e, signals)).collect();
    let entry = |i: usize, j: usize| rows[i].coefficients.get(&j).cloned().unwrap_or_else(|| whole(0));
    Grid::from_fn(rows.len(), signals.len(), entry)
}

fn columns(of: &Grid, from: usize, count: usize) -> Grid {
    Grid::from_fn(of.rows, count, |i, j| of.entries[i][from + j].clone())
}

/// The blocks and their connection.
pub(super) fn connected(problem: &Problem, diagram: &model::Diagram, budget: &Budget) -> Result<(Step, Body), Error> {
    // A loop that is not well posed has no closed loop, and says so.
    problem.rounded_closed_loop(budget)?;
    let numbers = problem.rounded_blocks(budget)?;
    let step = step_of(problem.model(), diagram);
    let blocks: Vec<_> =
        diagram.blocks.iter().zip(&numbers).map(|(b, numbers)| block(problem.model(), b, &numbers[0], &step)).collect();
    let name = |n: &Name| n.name.clone();
    let driven: Vec<&str> =
        diagram.blocks.iter().flat_map(|b| b.outputs.iter().map(|output| output.name.as_str())).collect();
    let external: Vec<&str> = diagram.inputs.iter().map(|input| input.name.as_str()).collect();
    let signals = [driven.clone(), external.clone()].concat();
    let of_blocks = rows(diagram.blocks.iter().flat_map(|b| &b.inputs), &signals);
    let of_outputs = rows(diagram.outputs.iter().map(|output| &output.expression), &signals);
    let (inputs, outputs) = (!external.is_empty(), !diagram.outputs.is_empty());
    let direct = columns(&of_outputs, driven.len(), external.len());
    let body = Diagram {
        blocks,
        inputs: diagram.inputs.iter().map(name).collect(),
        outputs: diagram.outputs.iter().map(|output| output.name.name.clone()).collect(),
        connection: columns(&of_blocks, 0, driven.len()),
        entries: inputs.then(|| columns(&of_blocks, driven.len(), external.len())),
        selection: outputs.then(|| columns(&of_outputs, 0, driven.len())),
        direct: (inputs && outputs && !direct.is_zero()).then_some(direct),
    };
    Ok((step, Body::Diagram(body)))
}

/// A loop of several rates: the whole closed loop over its hyperperiod, in numbers.
pub(super) fn lifted(problem: &Problem, diagram: &model::Diagram, budget: &Budget) -> Result<(Step, Body), Error> {
    let model = problem.model();
    let found = problem.rounded_closed_loop(budget)?.expect("a diagram has a closed loop");
    let (n, m, p) = (found.a.len(), diagram.inputs.len(), diagram.outputs.len());
    let b = if m > 0 { Grid::of_numbers(&found.b, n, m) } else { Grid::identity(n) };
    let c = if p > 0 { Grid::of_numbers(&found.c, p, n) } else { Grid::identity(n) };
    let d = if m > 0 && p > 0 { Grid::of_numbers(&found.d, p, m) } else { Grid::zeros(c.rows, b.columns) };
    let samples = model.hyperperiod();
    let step = match step_of(model, diagram) {
        Step::Time(time) => Step::Time(product(whole(samples as i64), time)),
        step => step,
    };
    let remark = format!(
        "The closed loop from one hyperperiod of {samples} samples to the next: {}. jurist computed its entries at the values above, \
         and they do not follow changes.",
        model.rules()
    );
    let system = Matrices { a: Grid::of_numbers(&found.a, n, n), b, c, d };
    Ok((step, Body::ClosedLoop { system, remark }))
}

impl Grid {
    /// Whether it is the identity.
    pub(super) fn is_identity(&self) -> bool {
        let is_right = |(i, row): (usize, &Vec<Expression>)| {
            row.iter().enumerate().all(|(j, e)| if i == j { is_one(e) } else { is_zero(e) })
        };
        self.rows == self.columns && self.entries.iter().enumerate().all(is_right)
    }
}
