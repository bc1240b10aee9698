//! Loops that are no block diagrams, and what no script can say.

use super::connection::rows;
use super::fraction::polynomial;
use super::{Body, Grid, Matrices, Script, Step, fits, refused};
use crate::cli::status::Error;
use jurist_algebra::limits::Budget;
use jurist_engine::error::{Code, Diagnostic};
use jurist_engine::model::{Dynamics, Expression, Form, Function, Matrix, Model, Name, Node, Output, Ports, Time};
use jurist_engine::problem::Problem;

/// The step of a loop whose blocks say nothing of it.
pub(super) fn step(model: &Model) -> Step {
    match (model.time(), model.sample_time_expression()) {
        (Time::Continuous, _) => Step::Continuous,
        (Time::Discrete, None) => Step::Unknown,
        (Time::Discrete, Some(time)) => Step::Time(time.clone()),
    }
}

/// Refuses dead time in continuous time: neither program has a loop with it.
pub(super) fn refuse_dead_time(model: &Model) -> Result<(), Error> {
    let help = "a rational approximation in the model itself can be written, such as (1 - tau*s/2)/(1 + tau*s/2)";
    let refuse = |message: String, span| Err(refused(model, span, message, "dead time", help));
    if model.time() == Time::Discrete {
        return Ok(());
    }
    match model.form() {
        Form::Characteristic(e) if has_exponential(e) => {
            refuse("a characteristic function with dead time has no exact form in the other program".into(), e.span)
        }
        Form::Blocks(diagram) => {
            let delayed = diagram.blocks.iter().find_map(|block| match &block.dynamics {
                Dynamics::DeadTime(e) => Some((block, e.span)),
                Dynamics::Transfer(e) if has_exponential(e) => Some((block, e.span)),
                _ => None,
            });
            let Some((block, span)) = delayed else { return Ok(()) };
            refuse(format!("the dead time of '{}' has no exact form in the other program", block.name), span)
        }
        _ => Ok(()),
    }
}

/// Whether an exponential of `s` occurs.
pub(super) fn has_exponential(e: &Expression) -> bool {
    match &e.node {
        Node::Call(Function::Exp, inner) if inner.names().contains("s") => true,
        Node::Number(_) | Node::Name(_) => false,
        Node::Negative(inner) | Node::Power(inner, _) | Node::Call(_, inner) => has_exponential(inner),
        Node::Sum(terms) => terms.iter().any(|(_, e)| has_exponential(e)),
        Node::Product(factors) => factors.iter().any(|(_, e)| has_exponential(e)),
    }
}

/// Refuses values beyond the range of floating point.
pub(super) fn refuse_numbers(problem: &Problem) -> Result<(), Error> {
    let model = problem.model();
    let constants = model.constants().iter().filter_map(|c| Some((&c.name, c.span, c.number.clone()?)));
    let parameters = model.parameters().iter().map(|p| (&p.name, p.span));
    let set = |name: &str| problem.set().iter().find(|(n, _)| n == name).map(|(_, value)| value.clone());
    let parameters = parameters.filter_map(|(name, span)| Some((name, span, set(name)?)));
    for (name, span, value) in constants.chain(parameters) {
        if !fits(&set(name).unwrap_or(value)) {
            let message = format!("the value of '{name}' is beyond the range of floating point");
            return Err(refused(model, span, message, "too large or too small", "give the model other units"));
        }
    }
    Ok(())
}

impl Script {
    /// Refuses numbers of formulas beyond the range of floating point.
    pub(super) fn checked(self) -> Result<Script, Error> {
        let first = self.variables.iter().map(|v| &v.value).chain(self.body.expressions()).find_map(first_lost);
        match first {
            None => Ok(self),
            Some(number) => {
                let shown: String = number.chars().take(60).collect();
                let message = format!("a number of the loop is beyond the range of floating point: {shown}");
                Err(Diagnostic::error(Code::Export, message).help("give the model other units").into())
            }
        }
    }
}

fn first_lost(e: &Expression) -> Option<String> {
    match &e.node {
        Node::Number(value) => (!fits(value)).then(|| value.to_string()),
        Node::Name(_) => None,
        Node::Negative(inner) | Node::Power(inner, _) | Node::Call(_, inner) => first_lost(inner),
        Node::Sum(terms) => terms.iter().find_map(|(_, e)| first_lost(e)),
        Node::Product(factors) => factors.iter().find_map(|(_, e)| first_lost(e)),
    }
}

/// A loop given by matrices or by its characteristic polynomial.
pub(super) fn body(problem: &Problem, budget: &Budget) -> Result<Body, Error> {
    match problem.model().form() {
        Form::Characteristic(e) => characteristic(problem, e, budget),
        Form::Matrix { matrix, ports } => {
            let (entries, outputs) = connected(ports, matrix.rows.len());
            let d = Grid::zeros(outputs.rows, entries.columns);
            let system = Matrices { a: grid(matrix), b: entries, c: outputs, d };
            Ok(Body::ClosedLoop { system, remark: ports_remark(ports) })
        }
        Form::OutputFeedback { a, b, c, k, ports } => {
            let (entries, outputs) = connected(ports, a.rows.len());
            let matrices = [("A", grid(a)), ("B", grid(b)), ("C", grid(c)), ("K", grid(k))];
            Ok(Body::OutputFeedback { matrices, entries, outputs })
        }
        Form::Blocks(_) => unreachable!("block diagrams are connected"),
    }
}

fn ports_remark(ports: &Ports) -> String {
    let list = |names: Vec<&str>| names.join(", ");
    let inputs = list(ports.inputs.iter().map(|name: &Name| name.name.as_str()).collect());
    let outputs = list(ports.outputs.iter().map(|output: &Output| output.name.name.as_str()).collect());
    let or = |text: String, other: &str| if text.is_empty() { other.to_owned() } else { text };
    format!("The closed loop. Inputs: {}. Outputs: {}.", or(inputs, "one for each state"), or(outputs, "the states"))
}

pub(super) fn grid(matrix: &Matrix) -> Grid {
    let (rows, columns) = matrix.size();
    Grid::from_fn(rows, columns, |i, j| matrix.rows[i][j].clone())
}

/// How inputs enter and what the outputs are; an input for each state where there are none, and each state where there are no outputs.
fn connected(ports: &Ports, order: usize) -> (Grid, Grid) {
    let entries = match &ports.input_matrix {
        Some(e) if !ports.inputs.is_empty() => grid(e),
        _ => Grid::identity(order),
    };
    let states: Vec<&str> = ports.states.iter().map(|name| name.name.as_str()).collect();
    let outputs = match ports.outputs.is_empty() {
        true => Grid::identity(order),
        false => rows(ports.outputs.iter().map(|output| &output.expression), &states),
    };
    (entries, outputs)
}

/// The coefficients as they are written, or as numbers where their degree is not the one that is written.
fn characteristic(problem: &Problem, e: &Expression, budget: &Budget) -> Result<Body, Error> {
    let model = problem.model();
    let algebra = problem.algebra_over_symbols(budget)?;
    let degree = algebra.formal_degree();
    if let Some(message) = algebra.undefined() {
        return Err(Error::Undefined(message.to_owned()));
    }
    let written = polynomial(e, model.time().variable()).filter(|p| p.len() == degree + 1);
    match written {
        Some(coefficients) => Ok(Body::Polynomial(coefficients.into_iter().rev().collect())),
        None => {
            let help = "write the polynomial so that no powers of the variable cancel";
            let message = "the degree of the characteristic polynomial is not the one that is written";
            Err(refused(model, e.span, message, "powers cancel here", help))
        }
    }
}

impl Body {
    /// All formulas.
    fn expressions(&self) -> Box<dyn Iterator<Item = &Expression> + '_> {
        fn of_grid(grid: &Grid) -> impl Iterator<Item = &Expression> {
            grid.entries.iter().flatten()
        }
        match self {
            Body::Polynomial(list) => Box::new(list.iter()),
            Body::ClosedLoop { system, .. } => Box::new(system.grids().into_iter().flat_map(of_grid)),
            Body::OutputFeedback { matrices, entries, outputs } => {
                Box::new(matrices.iter().map(|(_, grid)| grid).chain([entries, outputs]).flat_map(of_grid))
            }
            Body::Diagram(diagram) => {
                let more = [&diagram.entries, &diagram.selection, &diagram.direct].into_iter().flatten();
                let grids = more.chain([&diagram.connection]).flat_map(of_grid);
                Box::new(diagram.blocks.iter().flat_map(|block| block.system.expressions()).chain(grids))
            }
        }
    }
}

impl Matrices {
    pub(super) fn grids(&self) -> [&Grid; 4] {
        [&self.a, &self.b, &self.c, &self.d]
    }
}
