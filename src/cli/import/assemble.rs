//! From arrays with names to a system whose sizes fit.

use super::number::Number;
use super::{DELAYS, DESCRIPTOR, MAX_SIDE, Matrix, Shape, StateSpace, Time, Variable, Variables, refused};
use jurist_engine::error::Diagnostic;
use std::cmp::Ordering;

impl Shape {
    fn shown(self) -> String {
        match self {
            Shape::Scalar => "a single number".to_owned(),
            Shape::Vector(length) => format!("a vector of {length}"),
            Shape::Matrix(rows, columns) => format!("{rows} by {columns}"),
        }
    }

    fn is_empty(self) -> bool {
        matches!(self, Shape::Vector(0) | Shape::Matrix(0, _) | Shape::Matrix(_, 0))
    }
}

impl Matrix {
    pub(super) fn identity(size: usize) -> Matrix {
        let entry = |k: usize| if k / size == k % size { Number::one() } else { Number::zero() };
        Matrix { rows: size, columns: size, entries: (0..size * size).map(entry).collect() }
    }

    fn is_identity(&self) -> bool {
        let is_own = |(k, entry): (usize, &Number)| match k / self.columns == k % self.columns {
            true => entry.to_string() == "1",
            false => entry.sign() == Ordering::Equal,
        };
        self.entries.iter().enumerate().all(is_own)
    }

    pub(super) fn zero(rows: usize, columns: usize) -> Matrix {
        Matrix { rows, columns, entries: vec![Number::zero(); rows * columns] }
    }

    /// Its rows.
    pub(super) fn each_row(&self) -> impl Iterator<Item = &[Number]> {
        self.entries.chunks(self.columns.max(1))
    }
}

impl Variable {
    /// The error, at the place of this array.
    fn wrong(&self, message: impl Into<String>) -> Diagnostic {
        let error = refused(message);
        match self.span {
            Some(span) => error.at(span, self.shape.shown()),
            None => error,
        }
    }

    fn is_zero(&self) -> bool {
        self.entries.iter().all(|entry| entry.sign() == Ordering::Equal)
    }

    /// As a matrix of this size, if it can be one: a single number is 1 by 1, and a vector is a row or a column.
    fn sized(&self, rows: usize, columns: usize) -> Option<Matrix> {
        let fits = match self.shape {
            Shape::Scalar => (rows, columns) == (1, 1),
            Shape::Vector(length) => rows * columns == length && (rows == 1 || columns == 1),
            Shape::Matrix(own_rows, own_columns) => (own_rows, own_columns) == (rows, columns),
        };
        fits.then(|| Matrix { rows, columns, entries: self.entries.clone() })
    }

    /// The other side of a matrix with so many rows or columns.
    fn other_side(&self, side: usize) -> Option<usize> {
        match self.shape {
            Shape::Scalar => (side == 1).then_some(1),
            Shape::Vector(length) if length == side => Some(1),
            Shape::Vector(length) => (side == 1).then_some(length),
            Shape::Matrix(..) => None,
        }
    }
}

impl Variables {
    fn get(&self, name: &str) -> Option<&Variable> {
        self.list.iter().find(|variable| variable.name == name)
    }
}

/// The system of what a file holds, with the sample time that the command line gives.
pub(in crate::cli) fn assemble(variables: Variables, sample_time: Option<Time>) -> Result<StateSpace, Diagnostic> {
    refuse_other_systems(&variables)?;
    let a = state_matrix(&variables)?;
    let mut remarks = Vec::new();
    let inputs = beside_states(&variables, "B", a.rows)?;
    let c = beside_states(&variables, "C", a.rows)?;
    if c.is_none() && inputs.is_some() {
        remarks.push("the file has no C: the outputs are the states".to_owned());
    }
    let c = c.unwrap_or_else(|| Matrix::identity(a.rows));
    let d = direct_matrix(&variables, c.rows, inputs.as_ref().map_or(0, |b| b.columns))?;
    let time = sample_time.map_or_else(|| time_of(&variables), Ok)?;
    Ok(StateSpace { a, inputs: inputs.zip(d), c, time, names: variables.names, remarks })
}

/// Dead times and descriptor matrices are not left out in silence.
fn refuse_other_systems(variables: &Variables) -> Result<(), Diagnostic> {
    let nonzero = |name: &str| variables.get(name).filter(|variable| !variable.is_zero());
    let side = variables.get("A").map_or(0, |a| match a.shape {
        Shape::Matrix(rows, _) => rows,
        _ => 1,
    });
    // Another E is none of the system's.
    let is_of_system = |e: &&Variable| e.sized(side, side).is_some_and(|e| !e.is_identity());
    if let Some(matrix) = nonzero(DESCRIPTOR).filter(is_of_system) {
        let message = "the matrix E makes it a descriptor system, which is not imported";
        return Err(matrix.wrong(message).help("in MATLAB: ss(sys, 'explicit')"));
    }
    if let Some(delay) = DELAYS.iter().find_map(|name| nonzero(name)) {
        let message = format!("{} makes it a system with dead time, which is not imported", delay.name);
        let help = "import it without, and write the dead time into the model: a block with delay = \"..\"";
        return Err(delay.wrong(message).help(help));
    }
    Ok(())
}

fn state_matrix(variables: &Variables) -> Result<Matrix, Diagnostic> {
    let Some(a) = variables.get("A") else {
        let present: Vec<String> = variables.present.iter().take(20).map(|name| format!("'{name}'")).collect();
        let help = match present.is_empty() {
            true => "the matrices are named A, B, C and D, the sample time Ts or dt".to_owned(),
            false => format!(
                "there is {}; the matrices are named A, B, C and D, the sample time Ts or dt",
                present.join(", ")
            ),
        };
        return Err(refused("there is no matrix A").help(help));
    };
    if a.shape.is_empty() {
        let message = format!("A is empty ({}): a system without states has no limit of stability", a.shape.shown());
        return Err(a.wrong(message));
    }
    let side = match a.shape {
        Shape::Scalar | Shape::Vector(1) => 1,
        Shape::Matrix(rows, columns) if rows == columns => rows,
        _ => return Err(a.wrong(format!("A is {}, not square", a.shape.shown()))),
    };
    within(a, side, "states")?;
    Ok(Matrix { rows: side, columns: side, entries: a.entries.clone() })
}

fn within(variable: &Variable, side: usize, what: &str) -> Result<(), Diagnostic> {
    if side > MAX_SIDE {
        let message =
            format!("{} is {}: at most {MAX_SIDE} {what} are imported", variable.name, variable.shape.shown());
        return Err(variable.wrong(message));
    }
    Ok(())
}

/// B, the input matrix, which has a row for each state, or C, the output matrix, which has a column for each; none where it is empty.
fn beside_states(variables: &Variables, name: &str, states: usize) -> Result<Option<Matrix>, Diagnostic> {
    let Some(found) = variables.get(name) else { return Ok(None) };
    let is_input = name == "B";
    let turned = |rows: usize, columns: usize| if is_input { (rows, columns) } else { (columns, rows) };
    let side = match found.shape {
        Shape::Matrix(rows, columns) if turned(rows, columns) == (states, 0) => return Ok(None),
        Shape::Matrix(rows, columns) if turned(rows, columns).0 == states => Some(turned(rows, columns).1),
        _ if found.shape.is_empty() => {
            let message = format!("{name} is empty ({}), but A is {states} by {states}", found.shape.shown());
            return Err(found.wrong(message).help(match is_input {
                true => "leave B out of a system without inputs",
                false => "leave C out where the outputs are the states",
            }));
        }
        _ => found.other_side(states),
    };
    let sized = |side: usize| {
        let (rows, columns) = turned(states, side);
        Some((side, found.sized(rows, columns)?))
    };
    let Some((side, matrix)) = side.and_then(sized) else {
        let message = format!("{name} is {}, but A is {states} by {states}", found.shape.shown());
        let help = if is_input { "B has a row for each state" } else { "C has a column for each state" };
        return Err(found.wrong(message).help(help));
    };
    within(found, side, if is_input { "inputs" } else { "outputs" })?;
    Ok(Some(matrix))
}

/// The direct matrix of a system with inputs. A single zero is zero of any size.
fn direct_matrix(variables: &Variables, outputs: usize, inputs: usize) -> Result<Option<Matrix>, Diagnostic> {
    let found = variables.get("D");
    let zero = (inputs > 0).then(|| Matrix::zero(outputs, inputs));
    let Some(d) = found else { return Ok(zero) };
    let is_none = d.shape == Shape::Scalar && d.is_zero() || d.shape == Shape::Matrix(1, 1) && d.is_zero();
    if is_none || inputs == 0 && d.shape.is_empty() {
        return Ok(zero);
    }
    match d.sized(outputs, inputs).filter(|_| inputs > 0) {
        Some(matrix) => Ok(Some(matrix)),
        None if inputs == 0 => Err(d.wrong(format!("D is {}, but there is no B", d.shape.shown()))),
        None => {
            let message = format!("D is {}, but there are {outputs} outputs and {inputs} inputs", d.shape.shown());
            Err(d.wrong(message).help("D has a row for each output and a column for each input; left out, it is zero"))
        }
    }
}

/// What the file says of time: nothing and 0 are continuous, -1 is MATLAB's and python-control's unknown sample time.
fn time_of(variables: &Variables) -> Result<Time, Diagnostic> {
    let is_given = |variable: &&Variable| !variable.shape.is_empty();
    let Some(found) = ["Ts", "dt"].iter().find_map(|name| variables.get(name).filter(is_given)) else {
        return Ok(Time::Continuous);
    };
    if let Some(other) = variables.get("dt").filter(|other| is_given(other) && other.entries != found.entries) {
        return Err(other.wrong("Ts and dt are two sample times").help("'--sample-time T' replaces both"));
    }
    let [number] = found.entries.as_slice() else {
        return Err(found.wrong(format!("{} is {}, not one number", found.name, found.shape.shown())));
    };
    match number.sign() {
        Ordering::Equal => Ok(Time::Continuous),
        Ordering::Greater => Ok(Time::Discrete(Some(number.to_string()))),
        Ordering::Less if number.to_string() == "-1" => Ok(Time::Discrete(None)),
        Ordering::Less => Err(found.wrong(format!("the sample time {} is {number}", found.name))
            .help("a sample time is positive, 0 for continuous time, or -1 where it is not known; '--sample-time T' replaces it")),
    }
}
