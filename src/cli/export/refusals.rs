//! What no script can say.

use super::{Script, fits, refused};
use crate::cli::status::Error;
use jurist_engine::error::{Code, Diagnostic};
use jurist_engine::model::{Dynamics, Expression, Form, Function, Matrix, Model, Node, Time};
use jurist_engine::problem::Problem;

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
            return Err(refused(model, span, message, "too large or too small", UNITS));
        }
    }
    match written(model.form()).into_iter().find(|e| first_lost(e).is_some()) {
        None => Ok(()),
        Some(e) => {
            let message = "a number of the loop is beyond the range of floating point";
            Err(refused(model, e.span, message, "has a number that is too large or too small", UNITS))
        }
    }
}

/// What to do about a number beyond the range of floating point.
const UNITS: &str = "give the model other units";

/// The expressions of what a loop is made of.
fn written(form: &Form) -> Vec<&Expression> {
    match form {
        Form::Characteristic(e) => vec![e],
        Form::Matrix { matrix, .. } => matrix.entries().collect(),
        Form::OutputFeedback { a, b, c, k, .. } => [a, b, c, k].into_iter().flat_map(Matrix::entries).collect(),
        Form::Blocks(diagram) => diagram
            .blocks
            .iter()
            .flat_map(|block| match &block.dynamics {
                Dynamics::Transfer(e) | Dynamics::Gain(e) | Dynamics::Delay(e) | Dynamics::DeadTime(e) => vec![e],
                Dynamics::Ratio { numerator, denominator } => numerator.iter().chain(denominator).collect(),
                Dynamics::StateSpace { a, b, c, d } => {
                    [Some(a), Some(b), c.as_ref(), d.as_ref()].into_iter().flatten().flat_map(Matrix::entries).collect()
                }
                Dynamics::Static(matrix) => matrix.entries().collect(),
            })
            .collect(),
    }
}

impl Script {
    /// Refuses coefficients beyond the range of floating point.
    pub(super) fn checked(self) -> Result<Script, Error> {
        let first = self.variables.iter().map(|v| &v.value).chain(self.body.expressions()).find_map(first_lost);
        match first {
            None => Ok(self),
            Some(number) => {
                let shown: String = number.chars().take(60).collect();
                let message = format!("a coefficient of the loop is beyond the range of floating point: {shown}");
                Err(Diagnostic::error(Code::Export, message).help(UNITS).into())
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
