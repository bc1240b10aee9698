//! What a picture says of the question: title, fixed values, rules of discretisation.

use super::axes::Heading;
use super::engineering::quantity;
use jurist_algebra::number::Rational;
use jurist_engine::model::{Form, Model};
use jurist_engine::problem::Problem;
use jurist_show::layout::{called, short, visible};

/// The values that are fixed, and how continuous blocks were made discrete; a line each, none where there is none.
///
/// ```
/// use jurist_draw::figures::facts;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// let problem = Model::drive().ask().free("K_pwm").problem().unwrap();
/// assert_eq!(facts(&problem), ["T = 100 µs"]);
/// ```
pub fn facts(problem: &Problem) -> Vec<String> {
    let model = problem.model();
    let unit = |name: &str| model.parameters().iter().find(|p| p.name == name).and_then(|p| p.unit.as_deref());
    let values: Vec<String> = problem
        .set()
        .iter()
        .map(|(name, v)| format!("{name} = {}", value(v, unit(name).unwrap_or_default())))
        .collect();
    let mut out = Vec::new();
    if !values.is_empty() {
        out.push(values.join(", "));
    }
    out.extend(rules(model));
    out
}

/// The heading of a picture of a problem: `what: title of the model`, and its facts.
pub fn heading(what: &str, problem: &Problem) -> Heading {
    let title = match problem.title() {
        Some(_) => format!("{what}: {}", called(problem.title())),
        None => what.to_owned(),
    };
    Heading { title, notes: facts(problem) }
}

/// A value with its unit, in few digits where it has few.
fn value(value: &Rational, unit: &str) -> String {
    quantity(&short(value), &visible(unit))
}

/// `motor, filter: Tustin's rule`, for each rule that is used.
fn rules(model: &Model) -> Vec<String> {
    let Form::Blocks(diagram) = model.form() else { return Vec::new() };
    let mut used: Vec<(String, Vec<&str>)> = Vec::new();
    for block in &diagram.blocks {
        let Some(discretization) = &block.discretization else { continue };
        let words = discretization.words();
        match used.iter_mut().find(|u| u.0 == words) {
            Some(u) => u.1.push(&block.name),
            None => used.push((words, vec![&block.name])),
        }
    }
    let line = |(words, blocks): &(String, Vec<&str>)| {
        let names: Vec<String> = blocks.iter().map(|b| visible(b).into_owned()).collect();
        format!("{} made discrete by: {words}", names.join(", "))
    };
    used.iter().map(line).collect()
}
