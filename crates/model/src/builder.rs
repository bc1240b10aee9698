//! Loops built in Rust.
//!
//! A builder writes the model file that says the same. So both ways mean the same by
//! construction, errors point into readable text, and every built loop can be saved.

use super::definition::{Model, Time};
use crate::error::{Diagnostic, Diagnostics, Source};
use std::fmt::Write;

/// A loop in the making.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::{BlockBuilder, Model, ParameterBuilder, Time};
///
/// let (model, _) = Model::builder(Time::Discrete)
///     .title("integrator under proportional control")
///     .parameter(ParameterBuilder::new("K").nominal("1/2").min("0"))
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("K"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/(z - 1)"))
///     .build()?;
/// let problem = model.ask().free("K").problem()?;
/// let p = problem.algebra(&Budget::unlimited())?.polynomial().unwrap();
/// // z - 1 + K
/// assert_eq!(p.coefficients[0].display(&p.variables).to_string(), "K - 1");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ModelBuilder {
    time: Time,
    title: Option<String>,
    sample_time: Option<String>,
    constants: String,
    parameters: String,
    form: String,
    blocks: String,
}

/// A parameter in the making.
///
/// ```
/// use jurist_model::{Model, ParameterBuilder, Time};
/// let gain = ParameterBuilder::new("K").nominal("1/2").min("0").unit("V/A");
/// let (model, _) = Model::builder(Time::Discrete).parameter(gain).characteristic("z - 1 + K").build()?;
/// let gain = model.parameter("K").unwrap();
/// assert_eq!(gain.nominal.as_ref().unwrap().to_string(), "1/2");
/// assert!(!gain.contains(&0.into()));
/// # Ok::<(), jurist_model::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct ParameterBuilder {
    name: String,
    keys: Vec<(&'static str, String)>,
    is_closed: bool,
}

/// A block in the making.
///
/// ```
/// use jurist_model::{BlockBuilder, Model, Time};
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("sample", "u", "v").delay(1))
///     .block(BlockBuilder::new("plant", "v", "y").ratio(["1"], ["1", "-1"]))
///     .build()?;
/// assert_eq!(model.outputs().len(), 1);
/// # Ok::<(), jurist_model::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct BlockBuilder {
    text: String,
}

/// A TOML string; also right as a key.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            c if c.is_control() => write!(out, "\\u{:04X}", u32::from(c)).expect("a string takes all text"),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

fn array<S: AsRef<str>>(items: impl IntoIterator<Item = S>) -> String {
    let items: Vec<String> = items.into_iter().map(|s| quoted(s.as_ref())).collect();
    format!("[{}]", items.join(", "))
}

fn matrix(rows: &[&[&str]]) -> String {
    let rows: Vec<String> = rows.iter().map(|row| array(row.iter())).collect();
    format!("[{}]", rows.join(", "))
}

impl Model {
    /// Begins a loop.
    pub fn builder(time: Time) -> ModelBuilder {
        ModelBuilder {
            time,
            title: None,
            sample_time: None,
            constants: String::new(),
            parameters: String::new(),
            form: String::new(),
            blocks: String::new(),
        }
    }
}

impl ModelBuilder {
    /// The title.
    pub fn title(mut self, title: &str) -> Self {
        self.title = Some(title.into());
        self
    }

    /// The sample time, as an expression.
    pub fn sample_time(mut self, expression: &str) -> Self {
        self.sample_time = Some(expression.into());
        self
    }

    /// A constant, as an expression.
    pub fn constant(mut self, name: &str, expression: &str) -> Self {
        self.constants.push_str(&format!("{} = {}\n", quoted(name), quoted(expression)));
        self
    }

    /// A parameter.
    pub fn parameter(mut self, parameter: ParameterBuilder) -> Self {
        let mut keys: Vec<String> = parameter.keys.iter().map(|(k, v)| format!("{k} = {}", quoted(v))).collect();
        keys.extend(parameter.is_closed.then(|| "closed = true".to_owned()));
        let keys = if keys.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", keys.join(", ")) };
        self.parameters.push_str(&format!("{} = {keys}\n", quoted(&parameter.name)));
        self
    }

    fn key(mut self, key: &str, value: &str) -> Self {
        self.form.push_str(&format!("{key} = {value}\n"));
        self
    }

    /// The characteristic polynomial as it is.
    pub fn characteristic(self, expression: &str) -> Self {
        self.key("characteristic", &quoted(expression))
    }

    /// The closed-loop matrix.
    pub fn matrix(self, rows: &[&[&str]]) -> Self {
        self.key("matrix", &matrix(rows))
    }

    /// `u = -K y`, `y = C x`: the closed loop is `A - B K C`.
    pub fn feedback(self, a: &[&[&str]], b: &[&[&str]], c: &[&[&str]], k: &[&[&str]]) -> Self {
        self.key("A", &matrix(a)).key("B", &matrix(b)).key("C", &matrix(c)).key("K", &matrix(k))
    }

    /// The names of the states of a loop of matrices.
    pub fn states<S: AsRef<str>>(self, names: impl IntoIterator<Item = S>) -> Self {
        self.key("states", &array(names))
    }

    /// The names of the external inputs.
    pub fn inputs<S: AsRef<str>>(self, names: impl IntoIterator<Item = S>) -> Self {
        self.key("inputs", &array(names))
    }

    /// How the inputs enter a loop of matrices.
    pub fn input_matrix(self, rows: &[&[&str]]) -> Self {
        self.key("E", &matrix(rows))
    }

    /// The responses: linear expressions in states or signals.
    pub fn outputs<S: AsRef<str>>(self, expressions: impl IntoIterator<Item = S>) -> Self {
        self.key("outputs", &array(expressions))
    }

    /// A block of a diagram.
    pub fn block(mut self, block: BlockBuilder) -> Self {
        self.blocks.push_str(&format!("\n[[block]]\n{}", block.text));
        self
    }

    /// The model file that says the same.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        if let Some(title) = &self.title {
            text.push_str(&format!("title = {}\n", quoted(title)));
        }
        text.push_str(&format!("time = {}\n", quoted(self.time.name())));
        if let Some(expression) = &self.sample_time {
            text.push_str(&format!("sample_time = {}\n", quoted(expression)));
        }
        for (header, body) in [("constants", &self.constants), ("parameters", &self.parameters)] {
            if !body.is_empty() {
                text.push_str(&format!("\n[{header}]\n{body}"));
            }
        }
        text.push_str(&format!("\n[loop]\n{}{}", self.form, self.blocks));
        text
    }

    /// The loop, with warnings.
    ///
    /// Cost: that of [`Model::from_toml`].
    ///
    /// # Errors
    /// As [`Model::from_toml`], pointing into the text of [`ModelBuilder::to_toml`].
    pub fn build(&self) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
        Model::from_toml(&Source::new("<built loop>", self.to_toml()))
    }
}

impl ParameterBuilder {
    /// A parameter without a nominal value, unit or bounds.
    pub fn new(name: &str) -> Self {
        ParameterBuilder { name: name.into(), keys: Vec::new(), is_closed: false }
    }

    fn key(mut self, key: &'static str, value: &str) -> Self {
        self.keys.push((key, value.into()));
        self
    }

    /// The value it has when nothing else is said: a number, or a formula in constants and other parameters.
    pub fn nominal(self, value: &str) -> Self {
        self.key("nominal", value)
    }

    /// The lower bound of its domain.
    pub fn min(self, value: &str) -> Self {
        self.key("min", value)
    }

    /// The upper bound of its domain.
    pub fn max(self, value: &str) -> Self {
        self.key("max", value)
    }

    /// With bounds that themselves belong to the domain.
    pub fn closed(mut self) -> Self {
        self.is_closed = true;
        self
    }

    /// How far it may be from its nominal value: `10%`, `-20%..+30%`, `0.01`, `0.4..0.7`.
    pub fn tolerance(self, value: &str) -> Self {
        self.key("tolerance", value)
    }

    /// Its unit.
    pub fn unit(self, unit: &str) -> Self {
        self.key("unit", unit)
    }

    /// What it is.
    pub fn description(self, text: &str) -> Self {
        self.key("description", text)
    }
}

impl BlockBuilder {
    /// A block with one input, a linear expression in signals, that drives one signal.
    pub fn new(name: &str, input: &str, output: &str) -> Self {
        BlockBuilder::with_signals(name, [input], [output])
    }

    /// A block with several inputs and outputs.
    pub fn with_signals<S: AsRef<str>, R: AsRef<str>>(
        name: &str,
        inputs: impl IntoIterator<Item = S>,
        outputs: impl IntoIterator<Item = R>,
    ) -> Self {
        let text = format!("name = {}\ninput = {}\noutput = {}\n", quoted(name), array(inputs), array(outputs));
        BlockBuilder { text }
    }

    fn key(mut self, key: &str, value: &str) -> Self {
        self.text.push_str(&format!("{key} = {value}\n"));
        self
    }

    /// A rational expression in z or s.
    pub fn transfer(self, expression: &str) -> Self {
        self.key("transfer", &quoted(expression))
    }

    /// Numerator and denominator, coefficients of the highest power first.
    pub fn ratio<S: AsRef<str>, R: AsRef<str>>(
        self,
        numerator: impl IntoIterator<Item = S>,
        denominator: impl IntoIterator<Item = R>,
    ) -> Self {
        self.key("num", &array(numerator)).key("den", &array(denominator))
    }

    /// A factor.
    pub fn gain(self, expression: &str) -> Self {
        self.key("gain", &quoted(expression))
    }

    /// A number of samples.
    pub fn delay(self, samples: usize) -> Self {
        self.key("delay", &samples.to_string())
    }

    /// State space; the outputs are the states.
    pub fn states(self, a: &[&[&str]], b: &[&[&str]]) -> Self {
        self.key("A", &matrix(a)).key("B", &matrix(b))
    }

    /// The output matrix of a state space.
    pub fn output_matrix(self, c: &[&[&str]]) -> Self {
        self.key("C", &matrix(c))
    }

    /// The direct matrix of a state space, or a static block.
    pub fn direct_matrix(self, d: &[&[&str]]) -> Self {
        self.key("D", &matrix(d))
    }

    /// Makes a continuous block discrete: `zoh`, `foh`, `tustin`, `forward` or `backward`.
    pub fn discretize(self, method: &str, sample_time: &str) -> Self {
        let value = format!("{{ method = {}, T = {} }}", quoted(method), quoted(sample_time));
        self.key("discretize", &value)
    }

    /// What a continuous block does behind a pulse-width modulator with this edge and duty ratio.
    ///
    /// ```
    /// use jurist_model::{BlockBuilder, Model, ParameterBuilder, Time};
    /// let plant = BlockBuilder::new("plant", "-K*y", "y").transfer("1/s").modulated("trailing", "1/3");
    /// let builder = Model::builder(Time::Discrete).sample_time("1").parameter(ParameterBuilder::new("K").nominal("1"));
    /// assert_eq!(builder.block(plant).build()?.0.rules(), "plant: PWM, trailing edge, duty 1/3");
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    pub fn modulated(self, edge: &str, duty: &str) -> Self {
        let value = format!("{{ method = \"pwm\", edge = {}, duty = {} }}", quoted(edge), quoted(duty));
        self.key("discretize", &value)
    }

    /// What a continuous block does behind a zero-order hold, its inputs delayed by dead time in units of time.
    pub fn held(self, sample_time: &str, delay: &str) -> Self {
        let value = format!("{{ method = \"zoh\", T = {}, delay = {} }}", quoted(sample_time), quoted(delay));
        self.key("discretize", &value)
    }
}
