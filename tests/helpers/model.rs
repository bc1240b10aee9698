//! Models from text, from files, and from one polynomial.

use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_engine::error::{Code, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use std::path::PathBuf;

/// A model that loads, with or without warnings.
pub fn read(text: &str) -> Model {
    Model::from_toml(&Source::new("model.toml", text)).unwrap_or_else(|e| panic!("{e}\n{text}")).0
}

/// A model that loads without a warning, but for the remark on rules in the place of holds.
pub fn load(text: &str) -> Model {
    let (model, mut warnings) =
        Model::from_toml(&Source::new("model.toml", text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    warnings.retain(|w| w.code != Code::RuleWarning);
    assert_eq!(warnings, []);
    model
}

/// A path inside the repository.
pub fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The text of a file of `examples/`.
pub fn example_text(name: &str) -> String {
    let path = path(&format!("examples/{name}.toml"));
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// A file of `examples/`.
pub fn example(name: &str) -> Model {
    load(&example_text(name))
}

/// A discrete loop given by its polynomial, with one parameter `k` whose table entry is `parameter`.
pub fn discrete(characteristic: &str, parameter: &str) -> Model {
    load(&format!(
        "time = 'discrete'\n[parameters]\nk = {{ {parameter} }}\n[loop]\ncharacteristic = '{characteristic}'"
    ))
}

/// As [`discrete`], in continuous time.
pub fn continuous(characteristic: &str, parameter: &str) -> Model {
    load(&format!(
        "time = 'continuous'\n[parameters]\nk = {{ {parameter} }}\n[loop]\ncharacteristic = '{characteristic}'"
    ))
}

/// A question with several names free.
pub fn keeping(lp: &Model, names: &[&str]) -> Question {
    names.iter().fold(lp.ask(), |question, name| question.free(*name))
}

/// The characteristic polynomial in what is free.
pub fn characteristic(question: Question) -> CharacteristicPolynomial {
    let problem = question.problem().unwrap_or_else(|e| panic!("{e}"));
    let algebra = problem.algebra(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"));
    algebra.polynomial().unwrap_or_else(|| panic!("{:?}", algebra.undefined())).clone()
}
