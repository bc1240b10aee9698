//! Loops that are no block diagrams.

use super::connection::rows;
use super::fraction::polynomial;
use super::{Body, Grid, Matrices, Step, number};
use crate::cli::status::Error;
use jurist_algebra::limits::Budget;
use jurist_engine::model::{Expression, Form, Matrix, Model, Name, Output, Ports, Time};
use jurist_engine::problem::Problem;

/// The step of a loop whose blocks say nothing of it.
pub(super) fn step(model: &Model) -> Step {
    match (model.time(), model.sample_time_expression()) {
        (Time::Continuous, _) => Step::Continuous,
        (Time::Discrete, None) => Step::Unknown,
        (Time::Discrete, Some(time)) => Step::Time(time.clone()),
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

/// The coefficients as they are written, or as numbers where they are long, or powers cancel.
fn characteristic(problem: &Problem, e: &Expression, budget: &Budget) -> Result<Body, Error> {
    let model = problem.model();
    let algebra = problem.algebra_over_symbols(budget)?;
    let degree = algebra.formal_degree();
    if let Some(message) = algebra.undefined() {
        return Err(Error::Undefined(message.to_owned()));
    }
    let mut remark = "The characteristic polynomial, the highest power first.".to_owned();
    let coefficients = match polynomial(e, model.time().variable()).filter(|p| p.len() == degree + 1) {
        Some(written) => written,
        None => {
            remark += " jurist computed its coefficients at the values above, and they do not follow changes.";
            let rounded = problem.rounded_polynomial(budget)?.unwrap_or_default();
            rounded.into_iter().map(number).collect()
        }
    };
    Ok(Body::Polynomial { coefficients: coefficients.into_iter().rev().collect(), remark })
}

impl Body {
    /// All formulas.
    pub(super) fn expressions(&self) -> Box<dyn Iterator<Item = &Expression> + '_> {
        fn of_grid(grid: &Grid) -> impl Iterator<Item = &Expression> {
            grid.entries.iter().flatten()
        }
        match self {
            Body::Polynomial { coefficients, .. } => Box::new(coefficients.iter()),
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
