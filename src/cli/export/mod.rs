//! A loop as a script of another program: what is in it, whatever the program, and a writer for each program.

mod blocks;
mod connection;
mod forms;
mod formula;
mod formula_text;
mod fraction;
mod head;
pub(super) mod matlab;
mod names;
pub(super) mod python_control;
mod refusals;
mod target;
mod text;

use super::status::Error;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Span};
use jurist_engine::model::{Expression, Form, Model};
use jurist_engine::problem::Problem;
pub(super) use target::Target;

/// A script, its names already those of the program that reads it.
pub(super) struct Script {
    /// What stands above everything, line by line.
    head: Vec<String>,
    /// Parameters and constants, each after those it uses.
    variables: Vec<Variable>,
    /// The time from one sample to the next.
    step: Step,
    body: Body,
}

/// A parameter or a constant.
struct Variable {
    name: String,
    value: Expression,
    remark: String,
}

/// The time from one sample to the next.
enum Step {
    /// There are no samples.
    Continuous,
    /// The model names none.
    Unknown,
    Time(Expression),
}

/// What a loop is made of.
enum Body {
    /// The coefficients of the characteristic polynomial, the highest power first, and what is said of it.
    Polynomial {
        coefficients: Vec<Expression>,
        remark: String,
    },
    /// The closed loop, and what is said of it.
    ClosedLoop {
        system: Matrices,
        remark: String,
    },
    /// `A - B K C`.
    OutputFeedback {
        matrices: [(&'static str, Grid); 4],
        entries: Grid,
        outputs: Grid,
    },
    Diagram(Diagram),
}

/// Blocks and how they are connected: block inputs are `connection` times block outputs and `entries` times external inputs, and the
/// loop's outputs `selection` times block outputs and `direct` times external inputs.
struct Diagram {
    blocks: Vec<Block>,
    /// The names of the external signals and of the responses, for people.
    inputs: Vec<String>,
    outputs: Vec<String>,
    connection: Grid,
    entries: Option<Grid>,
    selection: Option<Grid>,
    direct: Option<Grid>,
}

/// A block.
struct Block {
    name: String,
    remark: String,
    system: System,
}

/// What a block does.
enum System {
    /// Its inputs times a matrix.
    Gain(Grid),
    /// Numerator and denominator as products of polynomials, the highest power first; the numerator is as long as the denominator.
    Transfer {
        numerator: Vec<Vec<Expression>>,
        denominator: Vec<Vec<Expression>>,
    },
    StateSpace(Matrices),
    /// A continuous system that is made discrete.
    Sampled(Box<System>, Sampling),
}

/// How a continuous system is made discrete.
enum Sampling {
    /// By a hold, or the rule with this word, over the loop's sample time.
    Named(&'static str),
    /// The forward rule with this sample time.
    Forward(Expression),
    /// The backward rule with this sample time.
    Backward(Expression),
    /// The bilinear rule with this factor.
    Bilinear(Expression),
}

/// A system in state space.
struct Matrices {
    a: Grid,
    b: Grid,
    c: Grid,
    d: Grid,
}

/// A matrix of formulas, which may have no rows or no columns.
#[derive(Clone)]
struct Grid {
    rows: usize,
    columns: usize,
    entries: Vec<Vec<Expression>>,
}

impl Grid {
    fn from_fn(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> Expression) -> Grid {
        let entries = (0..rows).map(|i| (0..columns).map(|j| entry(i, j)).collect()).collect();
        Grid { rows, columns, entries }
    }

    fn identity(n: usize) -> Grid {
        Grid::from_fn(n, n, |i, j| formula::whole(i64::from(i == j)))
    }

    fn zeros(rows: usize, columns: usize) -> Grid {
        Grid::from_fn(rows, columns, |_, _| formula::whole(0))
    }

    /// A matrix of numbers, of this size even where it has no rows.
    fn of_numbers(numbers: &[Vec<f64>], rows: usize, columns: usize) -> Grid {
        Grid::from_fn(rows, columns, |i, j| number(numbers[i][j]))
    }

    fn is_zero(&self) -> bool {
        self.entries.iter().flatten().all(formula::is_zero)
    }
}

/// A floating-point number as a formula: the shortest decimal that is read as this number.
fn number(value: f64) -> Expression {
    let exact = jurist_algebra::number::parse_number(&format!("{value:e}"));
    Expression::number(exact.unwrap_or_default())
}

/// Whether a number is neither lost nor infinite in floating point.
fn fits(value: &Rational) -> bool {
    let near = value.to_f64_approximate();
    near.is_finite() && (near != 0.0 || value.is_zero())
}

/// A refusal that points into the model.
fn refused(model: &Model, span: Span, message: impl Into<String>, label: &str, help: &str) -> Error {
    let error = Diagnostic::error(Code::Export, message).at(span, label).help(help);
    Diagnostics::new(Some(model.source().clone()), vec![error]).into()
}

impl Script {
    /// The script of a loop whose parameters all have values.
    ///
    /// # Errors
    /// `E-export` for what the other program has no exact form of; as [`Problem::closed_loop_over_symbols`].
    pub fn of(problem: &Problem, target: &dyn Target, budget: &Budget) -> Result<Script, Error> {
        let model = problem.model();
        refusals::refuse_dead_time(model)?;
        refusals::refuse_numbers(problem)?;
        problem.refuse_written_complex()?;
        let names = names::Names::of(model, target);
        let (step, body) = match model.form() {
            Form::Blocks(diagram) if model.hyperperiod() > 1 => connection::lifted(problem, diagram, budget)?,
            Form::Blocks(diagram) => connection::connected(problem, diagram, budget)?,
            _ => (forms::step(model), forms::body(problem, budget)?),
        };
        let script = Script { head: head::head(problem, target), variables: head::variables(problem), step, body };
        Ok(names.renamed(script.checked()?))
    }

    /// The script as a text.
    pub fn text(&self, target: &dyn Target) -> String {
        text::text(self, target)
    }
}
