//! A loop in one line: an open loop, or a characteristic polynomial.
//!
//! The line becomes a model file like any other, by the builder, so it has no meaning of its own.

use super::builder::{BlockBuilder, ModelBuilder, ParameterBuilder, quoted};
use super::definition::{Model, Time};
use super::evaluate::work::constant_value;
use super::text::{Expression, Factor, Function, Node, PI, Text, UNIT, parse_implied};
use crate::error::{Code, Diagnostic, Diagnostics, Origin, Source, Span};
use jurist_algebra::number::Rational;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// A loop in one line: the transfer function of an open loop that is closed with unity negative feedback, or a
/// characteristic polynomial, which ends in `= 0` or is a polynomial in `z` or `s`. All names are parameters without a value.
///
/// Products may be written without an operator: `2z`, `K(s + 1)`, `(s + 1)(s + 2)`.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::LoopLine;
/// let (model, _) = LoopLine::read("10K/(s(s + 1)(s + 2))", None, None)?.model()?;
/// let answer = model.ask().free("K").stable_set(&Budget::unlimited())?;
/// assert_eq!(answer.value().intervals()[0].upper.as_ref().unwrap().value.decimal(12), "0.6");
/// let error = LoopLine::read("K/s(s + 1)", None, None).unwrap_err();
/// assert_eq!(error.to_string(), "<line>:1:4: error[E-syntax]: this product can be read in two ways");
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct LoopLine {
    source: Arc<Source>,
    /// What is not compared with zero.
    expression: Expression,
    /// Where the expression ends.
    end: usize,
    /// Where factors begin that have no operator in front.
    implied: Vec<usize>,
    variable: Variable,
    is_transfer: bool,
    hold: Option<(String, Expression)>,
    delay: Option<(String, Expression)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Variable {
    S,
    Z,
}

impl Variable {
    fn name(self) -> &'static str {
        match self {
            Variable::S => "s",
            Variable::Z => "z",
        }
    }
}

impl LoopLine {
    /// Reads a line; `hold` is the sample time of a zero-order hold in front of a plant in `s`, `delay` a dead time in units of
    /// time. Both are numbers or expressions.
    ///
    /// Cost: linear in the texts, but for the conversion of their numbers.
    ///
    /// # Errors
    /// Those of [`Expression::parse`], pointing into `line`, `hold` or `delay`; `E-syntax` where it is not clear what is meant;
    /// `E-discretize` and `E-dead-time` where the loop has no place for a hold or a delay.
    pub fn read(line: &str, hold: Option<&str>, delay: Option<&str>) -> Result<LoopLine, Diagnostics> {
        // Such characters are no part of an expression; as blanks they need no escapes in the model file.
        let line: String =
            line.chars().map(|c| if c.is_control() { " ".repeat(c.len_utf8()) } else { c.into() }).collect();
        let source = Source::new("<line>", line);
        let read = || {
            let (end, is_equation) = left_side(&source.text)?;
            let (expression, implied) = parse_implied(&Text::verbatim(&source.text[..end], 0))?;
            let variable = variable_of(&expression, end)?;
            let is_transfer = is_transfer(&expression, variable, is_equation)?;
            Ok((end, expression, implied, variable, is_transfer))
        };
        let (end, expression, implied, variable, is_transfer) =
            read().map_err(|error| Diagnostics::new(Some(Arc::clone(&source)), vec![error]))?;
        let hold = hold.map(|text| quantity(text, HOLD)).transpose()?;
        let delay = delay.map(|text| quantity(text, DELAY)).transpose()?;
        let line = LoopLine { source, expression, end, implied, variable, is_transfer, hold, delay };
        line.check_hold().map_err(|error| error.in_source(&line.source))?;
        Ok(line)
    }

    /// The names without a value, in the order of the line, then those of the hold and of the delay.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        let mut seen = HashSet::from([PI, UNIT, self.variable.name()]);
        let others = self.hold.iter().chain(&self.delay).map(|(_, expression)| expression);
        for expression in std::iter::once(&self.expression).chain(others) {
            expression.each_name(&mut |name, _| {
                if seen.insert(name) {
                    names.push(name);
                }
            });
        }
        names
    }

    /// True if the line is the transfer function of an open loop, false if it is a characteristic polynomial.
    pub fn is_open_loop(&self) -> bool {
        self.is_transfer
    }

    /// The model that the line means, with warnings; its title is the line.
    ///
    /// # Errors
    /// As [`Model::from_toml`]; what is wrong with the expression points into the line.
    pub fn model(&self) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
        let (expression, text) = (self.written_out(), self.builder().to_toml());
        // The expression stands in the title, too, which is the first line.
        let start = text.rfind(&expression).unwrap_or_default();
        let copy = Span::new(start, start + expression.len());
        let names = self.places_of_names(&text);
        let origin = Origin { source: Arc::clone(&self.source), copy, added: self.implied.clone(), names };
        Model::from_toml(&Source::copied("<model of the line>", text, origin))
    }

    /// Where the model file defines the names of the line, and where each first stands in the line.
    fn places_of_names(&self, text: &str) -> Vec<(Span, Span)> {
        let mut first: HashMap<&str, Span> = HashMap::new();
        self.expression.each_name(&mut |name, span| {
            first.entry(name).or_insert(span);
        });
        // They are defined in this order.
        let mut from = 0;
        let place = |name: &str| {
            let key = quoted(name);
            let at = from + text[from..].find(&format!("\n{key} = "))? + 1;
            from = at;
            Some((Span::new(at, at + key.len()), *first.get(name)?))
        };
        self.names().into_iter().filter_map(place).collect()
    }

    /// The expression with all its operators.
    fn written_out(&self) -> String {
        let mut text = String::new();
        let mut from = 0;
        for &at in &self.implied {
            text.push_str(&self.source.text[from..at]);
            text.push('*');
            from = at;
        }
        text + &self.source.text[from..self.end]
    }

    fn builder(&self) -> ModelBuilder {
        let is_held = self.hold.is_some();
        let time = if self.variable == Variable::Z || is_held { Time::Discrete } else { Time::Continuous };
        let mut builder = Model::builder(time).title(&self.title());
        for name in self.names() {
            builder = builder.parameter(ParameterBuilder::new(name));
        }
        if !self.is_transfer {
            return builder.characteristic(&self.written_out());
        }
        let [input, output] = self.signals();
        let block =
            BlockBuilder::new(if is_held { "plant" } else { "open loop" }, &format!("{input} - {output}"), &output);
        let delay = self.delay.as_ref().map(|(text, _)| text.as_str());
        let block = match (&self.hold, delay) {
            (Some((period, _)), Some(delay)) => block.transfer(&self.written_out()).held(period, delay),
            (Some((period, _)), None) => block.transfer(&self.written_out()).discretize("zoh", period),
            (None, Some(delay)) => block.transfer(&format!("({})*exp(-({delay})*s)", self.written_out())),
            (None, None) => block.transfer(&self.written_out()),
        };
        let builder = match &self.hold {
            Some((period, _)) => builder.sample_time(period),
            None => builder,
        };
        builder.inputs([input.as_str()]).outputs([output.as_str()]).block(block)
    }

    /// The line, with what stands in front of its plant.
    fn title(&self) -> String {
        let mut title = self.source.text.trim().to_owned();
        if let Some((text, _)) = &self.hold {
            title.push_str(" behind a hold");
            // The name says it already.
            if text.trim() != "T" {
                title.push_str(&format!(", T = {}", text.trim()));
            }
        }
        if let Some((text, _)) = &self.delay {
            title.push_str(&format!(", dead time {}", text.trim()));
        }
        title
    }

    /// What the input and the output are called: `r` and `y`, where the line leaves these names free.
    fn signals(&self) -> [String; 2] {
        let names = self.names();
        ["r", "y"].map(|signal| {
            let mut name = signal.to_owned();
            while names.contains(&name.as_str()) {
                name.push('_');
            }
            name
        })
    }

    fn check_hold(&self) -> Result<(), Diagnostics> {
        let whole = Span::new(0, self.end);
        let refused = |code, message: &str, label: &str, help: &str| {
            Err(Diagnostic::error(code, message).at(whole, label).help(help).into())
        };
        if self.hold.is_some() && !self.is_transfer {
            let help = "a plant is a fraction, such as 'K/(s*(s + 1))'";
            return refused(
                Code::Discretize,
                "a hold stands in front of a plant, and this is a characteristic polynomial",
                "no plant",
                help,
            );
        }
        if self.hold.is_some() && self.variable == Variable::Z {
            let help = "write the plant in 's', or leave the hold out";
            return refused(
                Code::Discretize,
                "a hold stands in front of a continuous plant, and this loop is discrete",
                "a loop in 'z'",
                help,
            );
        }
        if self.delay.is_some() && !self.is_transfer {
            let help = "write it as a factor 'exp(-tau*s)' where it belongs";
            return refused(
                Code::DeadTime,
                "it is not clear where a characteristic polynomial has its dead time",
                "no plant",
                help,
            );
        }
        if self.delay.is_some() && self.variable == Variable::Z {
            let help = "a delay of two samples is a factor '1/z^2'";
            return refused(Code::DeadTime, "a loop in 'z' has no unit of time for a dead time", "a loop in 'z'", help);
        }
        Ok(())
    }
}

/// Where the expression ends that is compared with zero, and if anything is.
fn left_side(line: &str) -> Result<(usize, bool), Diagnostic> {
    let Some(equals) = line.find('=') else { return Ok((line.trim_end().len(), false)) };
    if line[equals + 1..].trim() == "0" {
        return Ok((line[..equals].trim_end().len(), true));
    }
    let error =
        Diagnostic::error(Code::Syntax, "an equation ends in '= 0'").at(Span::new(equals, line.len()), "not zero");
    Err(error.help("write all of it on the left, such as 'z^2 + z + 1/2 = 0'; a transfer function stands without '='"))
}

fn variable_of(expression: &Expression, end: usize) -> Result<Variable, Diagnostic> {
    let mut first = [None, None];
    expression.each_name(&mut |name, span| {
        for (variable, first) in [Variable::S, Variable::Z].iter().zip(&mut first) {
            if name == variable.name() {
                first.get_or_insert(span);
            }
        }
    });
    match first {
        [Some(_), None] => Ok(Variable::S),
        [None, Some(_)] => Ok(Variable::Z),
        [Some(s), Some(z)] => {
            let error = Diagnostic::error(Code::Syntax, "the line contains both 's' and 'z'").at(z, "discrete time");
            Err(error.also(s, "continuous time").help("a plant behind a hold is written in 's', with '--hold T'"))
        }
        [None, None] => {
            let names = expression.names();
            let help = match names.iter().find(|name| ["S", "Z"].contains(name)) {
                Some(name) => format!("write '{}' in place of '{name}'", name.to_lowercase()),
                None => "write a transfer function such as 'K/(s*(s + 1))', or a polynomial such as 'z^2 + z + 1/2'"
                    .to_owned(),
            };
            let error = Diagnostic::error(Code::Syntax, "the line contains neither 's' nor 'z', so it is no loop");
            Err(error.at(Span::new(0, end), "no loop").help(help))
        }
    }
}

/// True for the transfer function of an open loop, false for a characteristic polynomial.
fn is_transfer(expression: &Expression, variable: Variable, is_equation: bool) -> Result<bool, Diagnostic> {
    let variable = variable.name();
    let denominator = denominator_in(expression, variable);
    match (denominator, is_equation) {
        (Some(place), true) => {
            let message = format!("a characteristic polynomial does not divide by '{variable}'");
            let help = "multiply by the denominator; or write the open loop alone, without '1 +' and '= 0'";
            Err(Diagnostic::error(Code::NotPolynomial, message).at(place, "a denominator").help(help))
        }
        (Some(_), false) => Ok(true),
        (None, true) => Ok(false),
        (None, false) => match exponential_in(expression, variable) {
            None => Ok(false),
            Some(place) => {
                let message = "this can be an open loop or a characteristic polynomial";
                let help = "write '= 0' behind a characteristic polynomial; an open loop has a denominator";
                Err(Diagnostic::error(Code::Syntax, message).at(place, "not rational").help(help))
            }
        },
    }
}

/// The first denominator that contains the variable.
fn denominator_in(e: &Expression, variable: &str) -> Option<Span> {
    let contains = |e: &Expression| e.names().contains(variable);
    match &e.node {
        Node::Number(_) | Node::Name(_) | Node::Call(..) => None,
        Node::Negative(inner) => denominator_in(inner, variable),
        Node::Power(base, exponent) if *exponent < 0 && contains(base) => Some(e.span),
        Node::Power(base, _) => denominator_in(base, variable),
        Node::Sum(terms) => terms.iter().find_map(|(_, term)| denominator_in(term, variable)),
        Node::Product(factors) => factors.iter().find_map(|(factor, e)| match factor {
            Factor::Over if contains(e) => Some(e.span),
            _ => denominator_in(e, variable),
        }),
    }
}

/// The first exponential of the variable.
fn exponential_in(e: &Expression, variable: &str) -> Option<Span> {
    match &e.node {
        Node::Number(_) | Node::Name(_) => None,
        Node::Call(Function::Exp, inner) if inner.names().contains(variable) => Some(e.span),
        Node::Negative(inner) | Node::Power(inner, _) | Node::Call(_, inner) => exponential_in(inner, variable),
        Node::Sum(terms) => terms.iter().find_map(|(_, e)| exponential_in(e, variable)),
        Node::Product(factors) => factors.iter().find_map(|(_, e)| exponential_in(e, variable)),
    }
}

/// What the texts of the options are called where something is wrong with them.
const HOLD: &str = "--hold";
const DELAY: &str = "--delay";

/// A time as it was written, and as it is read.
fn quantity(text: &str, name: &str) -> Result<(String, Expression), Diagnostics> {
    let in_option = |d: Vec<Diagnostic>| Diagnostics::new(Some(Source::new(name, text)), d);
    let expression = Expression::parse(text).map_err(|e| in_option(e.diagnostics().to_vec()))?;
    if let Some(variable) = expression.names().iter().find(|n| ["s", "z"].contains(n)) {
        let error = Diagnostic::error(Code::Syntax, format!("a time does not contain '{variable}'"));
        let error = error.at(Span::new(0, text.len()), "not a time");
        return Err(in_option(vec![error.help("give a number such as 0.1, or a name such as T")]));
    }
    let (is_hold, whole) = (name == HOLD, Span::new(0, text.len()));
    if let Ok(value) = constant_value(&expression)
        && (value < Rational::ZERO || is_hold && value.is_zero())
    {
        let (message, label) = match is_hold {
            true => ("the sample time of a hold is positive", "not positive"),
            false => ("a dead time is not negative: the loop would look ahead", "negative"),
        };
        return Err(in_option(vec![Diagnostic::error(Code::Value, message).at(whole, label)]));
    }
    Ok((text.to_owned(), expression))
}
