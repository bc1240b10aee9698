//! A constant that is set has another number, and nothing else changes; a constant that is kept is a parameter.

use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::ToleranceRequest;
use jurist_engine::error::{Error, Source};
use jurist_engine::model::{Model, Parameter};
use jurist_engine::problem::Question;
use jurist_engine::stability::Range;
use std::path::Path;

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

/// The polynomial, or the code of what is wrong.
fn ask(question: Question) -> Result<CharacteristicPolynomial, String> {
    let budget = Budget::unlimited();
    let asked = question.problem().and_then(|problem| {
        let algebra = problem.algebra(&budget)?;
        algebra.polynomial().cloned().ok_or_else(|| Error::Undefined(algebra.undefined().unwrap_or_default().into()))
    });
    asked.map_err(|failure| match failure {
        Error::Refused(error) => error.code().to_string(),
        other => other.to_string(),
    })
}

/// The question with these names free.
fn free<'n>(model: &Model, names: impl IntoIterator<Item = &'n str>) -> Question {
    names.into_iter().fold(model.ask(), Question::free)
}

fn examples() -> Vec<Model> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut models = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            models.push(Model::from_bytes("model.toml", &std::fs::read(&path).unwrap()).unwrap().0);
        }
    }
    assert!(models.len() > 10);
    models
}

#[test]
#[ignore = "long: CI runs it"]
fn a_constant_set_to_its_own_number_changes_no_answer_of_the_examples() {
    let mut constants = 0;
    for model in examples() {
        let nominal = |p: &&Parameter| p.nominal.is_some();
        let without = model.parameters().iter().filter(|p| !nominal(p)).map(|p| p.name.as_str());
        let one = model.parameters().iter().find(nominal).map(|p| p.name.as_str());
        let plain = free(&model, without.chain(one));
        let time = |question: Question| {
            let problem = question.problem().unwrap();
            problem.algebra_over_symbols(&Budget::unlimited()).unwrap().sample_time().cloned()
        };
        // Some questions about dead time are not answered yet.
        let Ok(expected) = ask(plain.clone()) else { continue };
        for constant in model.constants() {
            let Some(value) = &constant.number else { continue };
            constants += 1;
            let set = plain.clone().set(constant.name.as_str(), value.clone());
            assert_eq!(ask(set.clone()).unwrap(), expected, "{:?}: {}", model.title(), constant.name);
            assert_eq!(time(set), time(plain.clone()));
        }
    }
    assert!(constants > 20, "{constants}");
}

#[test]
fn a_constant_that_is_set_is_another_number_in_the_text() {
    let model = |form: &str, c: &str| {
        let text = format!(
            "time = 'discrete'\n[parameters]\nK = {{ nominal = 1 }}\n[constants]\nc = '{c}'\nd = 'c + K'\n[loop]\n{form}\n"
        );
        Model::from_toml(&Source::new("model.toml", text)).map(|(model, _)| model)
    };
    let mut refused = 0;
    for form in [
        "characteristic = 'c*z^2 + K*z + d/2'",
        "characteristic = 'z^2 + K/c*z + d'",
        "characteristic = 'z - K/(c - 3)'",
        "matrix = [['c', 'K'], [1, 'd/c']]",
        "inputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - K*y'\noutput = 'y'\ntransfer = '(z + d)/(c*z^2 + z)'",
    ] {
        let written = model(form, "1").unwrap();
        for value in ["-2", "0", "1/3", "3"] {
            let expected = match model(form, value) {
                Ok(model) => ask(free(&model, ["K"])),
                Err(error) => {
                    refused += 1;
                    Err(error.code().to_string())
                }
            };
            let found = ask(free(&written, ["K"]).set("c", number(value)));
            assert_eq!(found, expected, "{form} with c = {value}");
        }
    }
    assert!(refused > 0, "some numbers are refused in the text and by the question alike");
}

#[test]
fn the_degree_that_counts_is_that_of_the_number_set() {
    let text =
        "time = 'discrete'\n[constants]\nc = 1\n[parameters]\nK = {}\n[loop]\ncharacteristic = 'c*z^2 + K*z + 1'\n";
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    let degree = |question: Question| ask(question).unwrap().formal_degree;
    assert_eq!(degree(free(&model, ["K"])), 2);
    assert_eq!(degree(free(&model, ["K"]).set("c", number("0"))), 1);
    assert_eq!(degree(free(&model, ["K", "c"])), 2);
}

#[test]
fn a_constant_that_is_kept_is_a_parameter_with_its_number_as_nominal_value() {
    let (model, _) = Model::from_toml(&Source::new(
        "model.toml",
        "time = 'discrete'\n[constants]\nc = '1/3'\n[loop]\ncharacteristic = 'z - 1/c'\n",
    ))
    .unwrap();
    let freed = model.free("c").unwrap();
    assert_eq!((freed.nominal, freed.min, freed.max), (Some(number("1/3")), None, None));
    let kept = ask(free(&model, ["c"])).unwrap();
    assert_eq!(kept.poles.len(), 1);
    // Given as a number, it divides by nothing that could vanish.
    assert_eq!(ask(model.ask()).unwrap().poles.len(), 0);
    assert_eq!(ask(model.ask().set("c", number("5"))).unwrap().poles.len(), 0);
}

#[test]
fn a_constant_that_is_asked_about_alone_keeps_its_sign() {
    let text = "time = 'discrete'\n[constants]\na = '1/3'\nb = -2\nc = 0\n[parameters]\nK = 1\n[loop]\n\
        characteristic = 'z - a*b*K + c'\n";
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    let domain = |question: Question| {
        let problem = question.problem().unwrap();
        let domain = &problem.free()[0].domain;
        [&domain.lower, &domain.upper].map(|end| end.as_ref().map(ToString::to_string))
    };
    let zero = || Some("0".to_owned());
    assert_eq!(domain(model.ask().free("a")), [zero(), None]);
    assert_eq!(domain(model.ask().free("b")), [None, zero()]);
    assert_eq!(domain(model.ask().free("c")), [None, None]);
    assert_eq!(domain(model.ask().free("K")), [None, None]);
    assert_eq!(domain(model.ask().free("a").domain("a", Range::all())), [None, None]);
    // Axes of maps have windows.
    assert_eq!(domain(model.ask().free("a").free("b")), [None, None]);
    let answer = model.ask().free("a").stable_set(&Budget::unlimited()).unwrap().text(6);
    assert!(answer.contains("a, domain a > 0: stable for\n    0 < a < 0.5\n"), "{answer}");
    // Its tolerance says itself how far it goes.
    let request = ToleranceRequest::new([("a", "200%".parse().unwrap())]);
    let tolerance = model.ask().tolerance(&request, &Budget::unlimited()).unwrap();
    assert_eq!(tolerance.value().domain_factor, None);
}
