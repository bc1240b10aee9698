//! The head of a script: what it is, and its variables.

use super::{Script, Target, Variable};
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::model::{Expression, Model, Node};
use jurist_engine::problem::Problem;
use std::collections::BTreeMap;
use std::path::Path;

/// Lines that say what the script is.
pub(super) fn head(problem: &Problem, target: &dyn Target) -> Vec<String> {
    let model = problem.model();
    let name = &model.source().name;
    let is_file = name.ends_with(".toml") || Path::new(name).exists();
    let file = Path::new(name).file_name().filter(|_| is_file).map(|file| file.to_string_lossy().into_owned());
    let mut head: Vec<String> = model.title().iter().map(|title| one_line(title)).collect();
    let version = env!("CARGO_PKG_VERSION");
    head.push(format!(
        "Written by jurist {version} from {} for {}.",
        one_line(&file.unwrap_or_else(|| name.trim_matches(['<', '>']).to_owned())),
        target.words()
    ));
    head.push("This script computes in floating point. The answers of jurist are exact.".into());
    head
}

/// A text without line breaks and control characters.
pub(super) fn one_line(text: &str) -> String {
    text.split(|c: char| c.is_control() || c == '\u{2028}' || c == '\u{2029}')
        .collect::<Vec<_>>()
        .join(" ")
        .trim()
        .to_owned()
}

/// Constants and parameters, each after those it uses: formulas where the model has them and nothing else is set.
pub(super) fn variables(problem: &Problem) -> Vec<Variable> {
    let model = problem.model();
    let mut open: Vec<Variable> = Vec::new();
    let set: BTreeMap<&str, &Rational> = problem.set().iter().map(|(name, value)| (name.as_str(), value)).collect();
    for parameter in model.parameters() {
        let value = set.get(parameter.name.as_str()).copied();
        let formula = parameter.nominal_formula.as_ref().filter(|_| value == parameter.nominal.as_ref());
        let what = [parameter.description.as_deref(), parameter.unit.as_deref()];
        let what: Vec<String> = what.into_iter().flatten().map(one_line).collect();
        open.push(variable(&parameter.name, formula, value, what.join(", ")));
    }
    for constant in model.constants() {
        let value = set.get(constant.name.as_str()).copied().or(constant.number.as_ref());
        let formula = Some(&constant.expression).filter(|_| value.is_none());
        open.push(variable(&constant.name, formula, value, String::new()));
    }
    ordered(open, model)
}

fn variable(name: &str, formula: Option<&Expression>, value: Option<&Rational>, what: String) -> Variable {
    let exact = value.filter(|value| formula.is_none() && !is_exact(value)).map(|value| format!("exactly {value}"));
    let remark =
        [Some(what).filter(|what| !what.is_empty()), exact].into_iter().flatten().collect::<Vec<_>>().join("; ");
    let value = formula.cloned().unwrap_or_else(|| Expression::number(value.cloned().unwrap_or_default()));
    Variable { name: name.to_owned(), value, remark }
}

/// Whether the decimal that is written is the number itself.
fn is_exact(value: &Rational) -> bool {
    parse_number(&format!("{:e}", value.to_f64_approximate())).is_ok_and(|written| written == *value)
}

/// The variables, each after those it uses.
fn ordered(mut open: Vec<Variable>, model: &Model) -> Vec<Variable> {
    let mut done: Vec<Variable> = Vec::with_capacity(open.len());
    while !open.is_empty() {
        let is_open = |name: &str| open.iter().any(|v| v.name == name);
        let is_ready = |v: &Variable| match &v.value.node {
            Node::Number(_) => true,
            _ => !v.value.names().into_iter().any(is_open),
        };
        let next =
            open.iter().position(is_ready).unwrap_or_else(|| unreachable!("{} has no cycle", model.source().name));
        done.push(open.remove(next));
    }
    done
}

impl Script {
    /// The width of the longest name of a variable.
    pub(super) fn width(&self) -> usize {
        self.variables.iter().map(|v| v.name.len()).max().unwrap_or(0)
    }
}
