//! What a model says, as plain data.

use super::discretization::{Edges, Method};
use super::expectation::Expectation;
use super::shipping::Shipping;
use super::text::{Expression, Node};
use super::tolerance::Tolerance;
use super::tuning::Tuning;
use crate::error::{Source, Span};
use jurist_algebra::number::{Rational, parse_number, to_decimal};
use std::collections::HashMap;
use std::sync::Arc;

/// Whether the loop runs in steps or continuously.
///
/// ```
/// use jurist_model::Time;
/// assert_eq!((Time::Discrete.variable(), Time::Continuous.name()), ("z", "continuous"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Time {
    /// Polynomial variable z, stable inside the unit circle.
    Discrete,
    /// Polynomial variable s, stable in the left half plane.
    Continuous,
}

impl Time {
    /// `z` or `s`.
    pub fn variable(self) -> &'static str {
        match self {
            Time::Discrete => "z",
            Time::Continuous => "s",
        }
    }

    /// `discrete` or `continuous`, as model files say it.
    pub fn name(self) -> &'static str {
        match self {
            Time::Discrete => "discrete",
            Time::Continuous => "continuous",
        }
    }
}

/// A name and where it is given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The name.
    pub name: String,
    /// Its place in the source text.
    pub span: Span,
}

/// A named value that does not change. One that is given as a number can be replaced by another number or freed:
/// see `Question` of the engine.
///
/// ```
/// use jurist_model::Model;
/// let drive = Model::drive();
/// let inductance = drive.constant("L_a").unwrap();
/// assert_eq!(inductance.number.as_ref().unwrap().to_string(), "23/500");
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Constant {
    /// The name.
    pub name: String,
    /// The place of the name.
    pub span: Span,
    /// The value, in terms of other constants and parameters.
    pub expression: Expression,
    /// The value, if it is given as a number; such a constant can become a parameter.
    pub number: Option<Rational>,
    /// How far the number may be from this value.
    pub tolerance: Option<Tolerance>,
}

/// A quantity that stays free.
///
/// ```
/// use jurist_model::Model;
/// let drive = Model::drive();
/// let gain = drive.parameter("K_pwm").unwrap();
/// assert!(gain.contains(&550.into()) && !gain.contains(&0.into()));
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Parameter {
    /// The name.
    pub name: String,
    /// The place of the name.
    pub span: Span,
    /// The value it has when nothing else is said; of a formula, that for the model's own numbers.
    pub nominal: Option<Rational>,
    /// The nominal value as it is written, where that is a formula in constants and other parameters.
    pub nominal_formula: Option<Expression>,
    /// The lower bound of its domain.
    pub min: Option<Rational>,
    /// The upper bound of its domain.
    pub max: Option<Rational>,
    /// Whether these bounds themselves belong to the domain.
    pub closed: bool,
    /// Its unit, for people.
    pub unit: Option<String>,
    /// What it is, for people.
    pub description: Option<String>,
    /// How far it may be from its nominal value.
    pub tolerance: Option<Tolerance>,
}

impl Parameter {
    /// A parameter of which nothing but the name is known.
    pub(crate) fn named(name: String, span: Span) -> Self {
        Parameter {
            name,
            span,
            nominal: None,
            nominal_formula: None,
            min: None,
            max: None,
            closed: false,
            unit: None,
            description: None,
            tolerance: None,
        }
    }

    /// Whether `value` lies in the domain.
    pub fn contains(&self, value: &Rational) -> bool {
        let is_bound = [&self.min, &self.max].into_iter().flatten().any(|bound| bound == value);
        let is_inside =
            self.min.as_ref().is_none_or(|min| min <= value) && self.max.as_ref().is_none_or(|max| value <= max);
        is_inside && (self.closed || !is_bound)
    }
}

/// A rectangle of expressions.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// The rows, all of the same length.
    pub rows: Vec<Vec<Expression>>,
    /// Where it stands.
    pub span: Span,
}

impl Matrix {
    /// Rows and columns.
    pub fn size(&self) -> (usize, usize) {
        (self.rows.len(), self.rows.first().map_or(0, Vec::len))
    }

    /// The entries, row by row.
    pub fn entries(&self) -> impl Iterator<Item = &Expression> {
        self.rows.iter().flatten()
    }
}

/// A response: a linear expression in states or signals, and its text as its name.
#[derive(Clone, Debug)]
pub struct Output {
    /// The text it is given as.
    pub name: Name,
    /// What it is.
    pub expression: Expression,
}

/// How a loop of matrices is connected to the outside.
#[derive(Clone, Debug, Default)]
pub struct Ports {
    /// The names of the states; none, or as many as the order.
    pub states: Vec<Name>,
    /// The names of the inputs.
    pub inputs: Vec<Name>,
    /// How the inputs enter: one row for each state, one column for each input.
    pub input_matrix: Option<Matrix>,
    /// The responses.
    pub outputs: Vec<Output>,
}

/// What the loop is made of.
#[derive(Clone, Debug)]
pub enum Form {
    /// A characteristic polynomial as it is written.
    Characteristic(Expression),
    /// The matrix of the closed loop.
    Matrix {
        /// The square matrix.
        matrix: Matrix,
        /// States, inputs, outputs.
        ports: Ports,
    },
    /// `u = -K y`, `y = C x`: the closed loop is `A - B K C`.
    OutputFeedback {
        /// State matrix, n x n.
        a: Matrix,
        /// Input matrix, n x m.
        b: Matrix,
        /// Output matrix, p x n.
        c: Matrix,
        /// Feedback matrix, m x p.
        k: Matrix,
        /// States, inputs, outputs.
        ports: Ports,
    },
    /// A block diagram.
    Blocks(Diagram),
}

/// Blocks wired by the names of their signals.
#[derive(Clone, Debug)]
pub struct Diagram {
    /// The external signals.
    pub inputs: Vec<Name>,
    /// The responses.
    pub outputs: Vec<Output>,
    /// The blocks.
    pub blocks: Vec<Block>,
}

impl Diagram {
    /// The signals that blocks drive, in order, each with its block.
    pub(super) fn driven(&self) -> impl Iterator<Item = (&Name, &Block)> {
        self.blocks.iter().flat_map(|b| b.outputs.iter().map(move |o| (o, b)))
    }
}

/// A block of a diagram.
#[derive(Clone, Debug)]
pub struct Block {
    /// Its name, for people.
    pub name: String,
    /// Where it begins.
    pub span: Span,
    /// Linear expressions in signals.
    pub inputs: Vec<Expression>,
    /// The signals it drives.
    pub outputs: Vec<Name>,
    /// What it does.
    pub dynamics: Dynamics,
    /// How a continuous block is made discrete.
    pub discretization: Option<Discretization>,
    /// At which samples it is active.
    pub rate: Rate,
    /// Its own sample time, if it is given so.
    pub sample_time: Option<Expression>,
    /// What a switched simulation needs to know of a pulse-width modulator.
    pub pwm: Option<Pwm>,
}

/// What a block does to its inputs.
#[derive(Clone, Debug)]
pub enum Dynamics {
    /// A rational expression in the variable.
    Transfer(Expression),
    /// Numerator and denominator, coefficients of the highest power first, taken as written.
    Ratio {
        /// Numerator.
        numerator: Vec<Expression>,
        /// Denominator.
        denominator: Vec<Expression>,
    },
    /// A factor.
    Gain(Expression),
    /// A number of samples: a whole number that does not depend on parameters.
    Delay(Expression),
    /// Dead time in a continuous loop, in units of time.
    DeadTime(Expression),
    /// State space; a missing matrix has its usual meaning.
    StateSpace {
        /// State matrix.
        a: Matrix,
        /// Input matrix.
        b: Matrix,
        /// Output matrix; the identity when missing.
        c: Option<Matrix>,
        /// Direct matrix; zero when missing.
        d: Option<Matrix>,
    },
    /// A constant matrix from inputs to outputs.
    Static(Matrix),
}

/// At which of the loop's samples a block is active.
///
/// ```
/// use jurist_model::Rate;
/// let slow = Rate { every: 10, phase: 3 };
/// assert!(slow.is_active(13) && !slow.is_active(10));
/// assert_eq!(slow.with(4), 20);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    /// Once in so many samples.
    pub every: u64,
    /// At which of them.
    pub phase: u64,
}

impl Default for Rate {
    fn default() -> Self {
        Rate { every: 1, phase: 0 }
    }
}

impl Rate {
    /// The rate in words: `every 10`, or `every 10, phase 3`.
    pub fn words(&self) -> String {
        match self.phase {
            0 => format!("every {}", self.every),
            phase => format!("every {}, phase {phase}", self.every),
        }
    }

    /// True if the block computes its outputs at this sample of the loop, counted from 0; at other samples it holds them.
    pub fn is_active(&self, sample: u64) -> bool {
        sample % self.every == self.phase
    }

    /// The least common multiple of the block's period and another one, both in samples; the greatest number where it is too large.
    ///
    /// Cost: Euclid's algorithm on machine integers.
    pub fn with(&self, steps: u64) -> u64 {
        let (mut a, mut b) = (steps, self.every);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        (steps / a).saturating_mul(self.every)
    }
}

/// How a continuous block is made discrete.
#[derive(Clone, Debug)]
pub struct Discretization {
    /// The rule or the hold.
    pub method: &'static Method,
    /// The sample time; that of the loop where the block names none. Tustin's rule with a factor needs none.
    pub sample_time: Option<Expression>,
    /// Whether that is the loop's.
    pub is_sample_time_of_loop: bool,
    /// The factor of the bilinear map, `2/T` when missing.
    pub factor: Option<Expression>,
    /// The angular frequency at which the bilinear map is exact: its factor is `w/tan(w T/2)`.
    pub prewarp: Option<Expression>,
    /// The dead time of the inputs of a held block, in units of time.
    pub delay: Option<Expression>,
    /// The speed of the frame from which a held block is seen, against the frame in which its inputs are held.
    pub frame: Option<Expression>,
    /// The angle by which commands are turned ahead on their way into that frame.
    pub advance: Option<Expression>,
    /// The pulses of a block behind a modulator.
    pub pulses: Option<Pulses>,
    /// Where it stands.
    pub span: Span,
}

impl Discretization {
    /// The method in words, with what a modulator's pulses are, `PWM, trailing edge, duty 0.41`, and the frame in which a held block stands:
    /// `zero-order hold in the frame of omega_e`.
    ///
    /// ```
    /// use jurist_model::error::Source;
    /// use jurist_model::{Form, Model};
    /// let text = "time = 'discrete'\nsample_time = 1\n[parameters]\nK = 1\n[loop]\n[[block]]\ninput = '-K*y'\noutput = 'y'\n\
    ///     transfer = '1/s'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = 0.41 }\n";
    /// let words = |text: &str| {
    ///     let (model, _) = Model::from_toml(&Source::new("loop.toml", text)).unwrap();
    ///     let Form::Blocks(diagram) = model.form() else { panic!() };
    ///     diagram.blocks[0].discretization.as_ref().unwrap().words()
    /// };
    /// assert_eq!(words(text), "PWM, trailing edge, duty 0.41");
    /// assert_eq!(words(&text.replace("0.41", "'K/3'")), "PWM, trailing edge, duty K/3");
    /// let turning = text.replace("method = 'pwm', edge = 'trailing', duty = 0.41", "method = 'zoh', frame = 'K'");
    /// assert_eq!(words(&turning), "zero-order hold in the frame of K");
    /// ```
    pub fn words(&self) -> String {
        let turns = self.frame.as_ref().filter(|speed| !matches!(&speed.node, Node::Number(zero) if zero.is_zero()));
        let words = self.words_at_rest();
        turns.map_or(words.clone(), |speed| format!("{words} in the frame of {speed}"))
    }

    fn words_at_rest(&self) -> String {
        let Some(pulses) = &self.pulses else { return self.method.words.to_owned() };
        // A number as a decimal where it is a short one.
        let decimal = |duty: &Expression| match &duty.node {
            Node::Number(value) => Some(to_decimal(value, 15)).filter(|d| parse_number(d).as_ref() == Ok(value)),
            _ => None,
        };
        let text = |duty: &Expression| decimal(duty).unwrap_or_else(|| duty.to_string());
        let mut edges: Vec<&str> = pulses.edges.iter().map(|edges| edges.map_or("held", |edges| edges.words)).collect();
        edges.dedup();
        let mut duties: Vec<String> = pulses.duties.iter().map(text).collect();
        duties.dedup();
        format!("PWM, {}, duty {}", edges.join("; "), duties.join("; "))
    }
}

/// The pulses of the inputs of a block behind a modulator.
#[derive(Clone, Debug)]
pub struct Pulses {
    /// Which edges move, once for all inputs or for each; `None` for an input that is held.
    pub edges: Vec<Option<&'static Edges>>,
    /// Duty ratios, one for all inputs or one for each; the word `steady` alone where they follow from the orbit.
    pub duties: Vec<Expression>,
    /// Whether the duty ratio is that of the loop at rest, with the inputs of `[simulation]`.
    pub is_steady: bool,
    /// Where the edges stand.
    pub span: Span,
}

/// A pulse-width modulator: what a switched simulation needs beside its gain.
#[derive(Clone, Debug)]
pub struct Pwm {
    /// The height of the pulses.
    pub amplitude: Expression,
    /// The height of the carrier.
    pub carrier: Expression,
    /// The period.
    pub period: Expression,
}

/// A requirement as it is written in the section `[require]` of a model file; what it means is found out when it is
/// asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RequirementText {
    /// Its key.
    pub name: String,
    /// The value's text.
    pub text: String,
    /// Where the value stands.
    pub span: Span,
}

/// Defaults of a time response, and units for its axes: the section `[simulation]` of a model file.
///
/// Nothing of it enters a verdict.
///
/// ```
/// use jurist_model::error::Source;
/// use jurist_model::Model;
/// let text = "
///     time = 'discrete'
///     [parameters]
///     k = { nominal = 0.5, min = 0 }
///     [loop]
///     matrix = [['1 - k']]
///     states = ['speed']
///     inputs = ['reference']
///     E = [['k']]
///     [simulation]
///     inputs = { reference = 80 }
///     duration = 20
///     units = { speed = 'rad/s' }
/// ";
/// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
/// assert_eq!(model.unit("speed"), Some("rad/s"));
/// assert_eq!(model.unit("reference"), None);
/// # Ok::<(), jurist_model::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Simulation {
    /// Constant values of inputs; others are zero.
    pub inputs: Vec<(Name, Rational)>,
    /// Initial values of states or signals; others are zero.
    pub initial: Vec<(Name, Rational)>,
    /// The time to be simulated: seconds, or samples when the loop has no sample time.
    pub duration: Option<Rational>,
    /// Units of inputs, states, signals and outputs, for people; the program does not calculate with them.
    pub units: Vec<(Name, String)>,
}

/// A model: what its text says, checked.
///
/// ```
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_algebra::limits::Budget;
/// let problem = Model::drive().ask().free("K_pwm").problem()?;
/// let p = problem.algebra(&Budget::unlimited())?.polynomial().unwrap();
/// assert_eq!(p.formal_degree, 6);
/// assert_eq!(p.coefficients[5], jurist_algebra::number::parse_number("-21378329/5347500")?.into());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) source: Arc<Source>,
    pub(super) title: Option<String>,
    pub(super) time: Time,
    pub(super) sample_time: Option<Expression>,
    /// In the order of the text.
    pub(super) constants: Vec<Constant>,
    /// Constants, and parameters whose nominal value is a formula, each after those it uses.
    pub(super) order: Vec<Position>,
    pub(super) parameters: Vec<Parameter>,
    pub(super) form: Form,
    pub(super) simulation: Simulation,
    pub(super) require: Vec<RequirementText>,
    pub(super) expect: Vec<Expectation>,
    pub(super) shipping: Option<Shipping>,
    pub(super) tuning: Option<Tuning>,
    /// Positions of constants and parameters by name.
    pub(super) index: HashMap<String, Position>,
    /// Whether the imaginary unit is in an expression.
    pub(super) has_unit: bool,
}

/// Where a name is defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Position {
    Constant(usize),
    Parameter(usize),
}

impl Model {
    /// The text the model was read from.
    pub fn source(&self) -> &Arc<Source> {
        &self.source
    }

    /// The title, if it has one.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// Discrete or continuous.
    pub fn time(&self) -> Time {
        self.time
    }

    /// The sample time as it is written.
    pub fn sample_time_expression(&self) -> Option<&Expression> {
        self.sample_time.as_ref()
    }

    /// The constants in the order of the text.
    pub fn constants(&self) -> &[Constant] {
        &self.constants
    }

    /// The parameters in the order of the text.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The parameter of this name.
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        match self.index.get(name)? {
            Position::Parameter(i) => self.parameters.get(*i),
            Position::Constant(_) => None,
        }
    }

    /// The constant of this name.
    pub fn constant(&self, name: &str) -> Option<&Constant> {
        match self.index.get(name)? {
            Position::Constant(i) => self.constants.get(*i),
            Position::Parameter(_) => None,
        }
    }

    /// What the loop is made of.
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// True if the imaginary unit is written somewhere, or a plant is held in another frame. The characteristic polynomial may be real all the
    /// same.
    pub fn is_written_complex(&self) -> bool {
        let Form::Blocks(diagram) = &self.form else { return self.has_unit };
        let frames = diagram.blocks.iter().filter_map(|b| b.discretization.as_ref()).any(|d| d.frame.is_some());
        self.has_unit || frames
    }

    /// True if a block of the diagram is behind a hold.
    pub fn has_holds(&self) -> bool {
        let Form::Blocks(diagram) = &self.form else { return false };
        diagram.blocks.iter().filter_map(|b| b.discretization.as_ref()).any(|d| d.method.is_hold())
    }

    /// The defaults of a time response.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// What is required of the loop beyond stability, as it is written.
    pub fn require(&self) -> &[RequirementText] {
        &self.require
    }

    /// What 'jurist test' is to find.
    pub fn expectations(&self) -> &[Expectation] {
        &self.expect
    }

    /// How the controller is stored and run, as it is written.
    pub fn shipping(&self) -> Option<&Shipping> {
        self.shipping.as_ref()
    }

    /// Which gains are to be best, as it is written.
    pub fn tuning(&self) -> Option<&Tuning> {
        self.tuning.as_ref()
    }

    /// The unit of a signal, where the model names one.
    pub fn unit(&self, signal: &str) -> Option<&str> {
        self.simulation.units.iter().find(|(name, _)| name.name == signal).map(|(_, unit)| unit.as_str())
    }

    /// The external inputs.
    pub fn inputs(&self) -> &[Name] {
        match &self.form {
            Form::Characteristic(_) => &[],
            Form::Matrix { ports, .. } | Form::OutputFeedback { ports, .. } => &ports.inputs,
            Form::Blocks(diagram) => &diagram.inputs,
        }
    }

    /// The responses.
    pub fn outputs(&self) -> &[Output] {
        match &self.form {
            Form::Characteristic(_) => &[],
            Form::Matrix { ports, .. } | Form::OutputFeedback { ports, .. } => &ports.outputs,
            Form::Blocks(diagram) => &diagram.outputs,
        }
    }

    /// By which rule or hold the continuous blocks of a discrete loop are made discrete: `motor: forward rule`. Empty where
    /// there are none.
    ///
    /// ```
    /// use jurist_model::error::Source;
    /// use jurist_model::Model;
    /// let text = "
    ///     time = 'discrete'
    ///     sample_time = 1
    ///     parameters.K = 1
    ///     [loop]
    ///     inputs = ['r']
    ///     [[block]]
    ///     name = 'motor'
    ///     input = 'r - K*y'
    ///     output = 'y'
    ///     transfer = '1/(s + 1)'
    ///     discretize = 'zoh'
    /// ";
    /// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
    /// assert_eq!(model.rules(), "motor: zero-order hold");
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    pub fn rules(&self) -> String {
        /// Blocks of one kind that are named.
        const NAMED: usize = 4;
        let Form::Blocks(diagram) = &self.form else { return String::new() };
        let method = |b: &Block| b.discretization.as_ref().map(Discretization::words);
        let mut methods: Vec<String> = Vec::new();
        for found in diagram.blocks.iter().filter_map(method) {
            if !methods.contains(&found) {
                methods.push(found);
            }
        }
        let group = |m: &String| {
            let blocks: Vec<&str> =
                diagram.blocks.iter().filter(|b| method(b).as_ref() == Some(m)).map(|b| b.name.as_str()).collect();
            let mut text = blocks[..blocks.len().min(NAMED)].join(", ");
            if blocks.len() > NAMED {
                text.push_str(&format!(" and {} more", blocks.len() - NAMED));
            }
            format!("{text}: {m}")
        };
        let slow =
            diagram.blocks.iter().filter(|b| b.rate.every > 1).map(|b| format!("{}: {}", b.name, b.rate.words()));
        let mut all: Vec<String> = methods.iter().map(group).chain(slow.take(NAMED)).collect();
        match self.hyperperiod() {
            1 => {}
            steps => all.push(format!("z is one step of {steps} samples")),
        }
        all.join("; ")
    }

    /// After how many samples everything comes again: 1 unless a block is slower than the loop, or the edges of pulses alternate.
    ///
    /// Cost: one greatest common divisor for each block.
    ///
    /// ```
    /// assert_eq!(jurist_model::Model::drive().hyperperiod(), 1);
    /// ```
    pub fn hyperperiod(&self) -> u64 {
        let Form::Blocks(diagram) = &self.form else { return 1 };
        let pulses = |block: &Block| block.discretization.as_ref().and_then(|d| d.pulses.clone());
        let alternates = |pulses: Pulses| pulses.edges.iter().flatten().any(|edges| edges.alternate());
        let first = if diagram.blocks.iter().filter_map(pulses).any(alternates) { 2 } else { 1 };
        diagram.blocks.iter().fold(first, |steps, block| block.rate.with(steps))
    }

    /// The constants, each after those it uses.
    pub(super) fn ordered_constants(&self) -> impl Iterator<Item = &Constant> {
        self.order.iter().filter_map(|position| match position {
            Position::Constant(i) => Some(&self.constants[*i]),
            Position::Parameter(_) => None,
        })
    }
}
