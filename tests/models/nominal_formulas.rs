//! A nominal value may be a formula in constants and other parameters; it follows what is set.

use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::ToleranceRequest;
use jurist_engine::error::{Code, Diagnostic, Error, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::Question;

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

/// A loop with these constants and parameters, which all enter.
fn text(constants: &str, parameters: &str) -> String {
    let names = |lines: &str| -> Vec<String> {
        lines.lines().filter_map(|l| l.split_once('=')).map(|(name, _)| name.trim().to_owned()).collect()
    };
    let sum = [names(constants), names(parameters)].concat().join(" + ");
    format!(
        "time = 'discrete'\n[constants]\n{constants}\n[parameters]\n{parameters}\n[loop]\ncharacteristic = 'z + ({sum})/1000'\n"
    )
}

fn model(constants: &str, parameters: &str) -> Model {
    let (model, warnings) = Model::from_toml(&Source::new("model.toml", text(constants, parameters))).unwrap();
    assert_eq!(warnings, []);
    model
}

/// Everything that is wrong, with the words that are marked.
fn wrong(constants: &str, parameters: &str) -> Vec<(Code, String, Vec<String>)> {
    let text = text(constants, parameters);
    let refused = Model::from_toml(&Source::new("model.toml", text.clone())).unwrap_err();
    let at = |d: &Diagnostic| {
        let spans = d.primary.iter().chain(&d.secondary).map(|l| text[l.span.start..l.span.end].to_owned());
        (d.code, d.message.clone(), spans.collect())
    };
    refused.diagnostics().iter().map(at).collect()
}

fn values(question: Question) -> Vec<(String, String)> {
    let problem = question.problem().unwrap();
    problem.set().iter().map(|(name, value)| (name.clone(), value.to_string())).collect()
}

fn pair(name: &str, value: &str) -> (String, String) {
    (name.to_owned(), value.to_owned())
}

#[test]
fn a_formula_in_constants_has_a_value() {
    let model = model("L_n = '8/1000'\nT_s = 'L_n/40'", "K = { nominal = 'L_n/(3*T_s)', min = 0 }");
    let parameter = model.parameter("K").unwrap();
    assert_eq!(parameter.nominal, Some(number("40/3")));
    assert_eq!(parameter.nominal_formula.as_ref().unwrap().to_string(), "L_n/(3*T_s)");
    assert_eq!(values(model.ask()), [pair("K", "40/3")]);
    assert_eq!(model.ask().free("K").problem().unwrap().parameter().nominal, Some(number("40/3")));
}

#[test]
fn a_formula_follows_what_is_set_and_a_value_that_is_set_does_not() {
    let model = model("L = 6", "T = 2\nM = 'L/T'\nK = 'M + 1'");
    assert_eq!(values(model.ask()), [pair("T", "2"), pair("M", "3"), pair("K", "4")]);
    let set = model.ask().set("L", 10);
    assert_eq!(values(set.clone()), [pair("T", "2"), pair("M", "5"), pair("K", "6"), pair("L", "10")]);
    assert_eq!(values(set.set("M", 1)), [pair("T", "2"), pair("M", "1"), pair("K", "2"), pair("L", "10")]);
    assert_eq!(model.ask().set("T", 3).nominal("K").unwrap(), Some(3.into()));
    let kept = model.ask().with_nominal_values().unwrap().set("L", 10);
    assert_eq!(values(kept), [pair("T", "2"), pair("M", "3"), pair("K", "4"), pair("L", "10")]);
    // By way of a constant that depends on a parameter.
    let model = self::model("c = '2*T'", "T = 5\nK = 'c + 1'");
    assert_eq!(values(model.ask().set("T", 1)), [pair("T", "1"), pair("K", "3")]);
}

#[test]
fn a_formula_keeps_its_value_while_what_it_depends_on_varies_and_the_question_says_so() {
    let model = model("L = 6\nd = 'L + 1'", "K = 'd/7'");
    let problem = model.ask().free("L").problem().unwrap();
    assert_eq!(problem.set(), [("K".to_owned(), 1.into())]);
    let warnings: Vec<_> = problem.warnings().iter().map(|d| (d.code, d.message.as_str())).collect();
    assert_eq!(warnings, [(Code::NominalWarning, "K keeps its nominal value 1 while L varies")]);
    assert!(model.ask().set("K", 1).free("L").problem().unwrap().warnings().is_empty());
    assert!(model.ask().free("K").free("L").problem().unwrap().warnings().is_empty());
    // A tolerance is around the value that is set, and the formula belongs to that value.
    let request = ToleranceRequest::new([("L", "10%".parse().unwrap())]);
    let answer = model.ask().set("L", 13).tolerance(&request, &Budget::unlimited()).unwrap();
    assert_eq!(answer.problem().set(), [("K".to_owned(), 2.into())]);
}

#[test]
fn a_formula_that_needs_a_parameter_without_a_value_has_none_until_that_is_set() {
    let model = model("", "T = {}\nK = '1/T'");
    assert_eq!(model.parameter("K").unwrap().nominal, None);
    assert_eq!(values(model.ask().set("T", 4)), [pair("T", "4"), pair("K", "1/4")]);
    for question in [model.ask(), model.ask().free("T")] {
        let Err(Error::Refused(refused)) = question.problem() else { panic!("no value") };
        let last = refused.diagnostics().last().unwrap();
        assert_eq!((last.code, last.message.as_str()), (Code::NoValue, "the parameter 'K' has no value"));
        assert_eq!(last.primary.as_ref().unwrap().text, "needs the nominal value of 'T'");
    }
    assert_eq!(values(model.ask().free("T").set("K", 1)), [pair("K", "1")]);
}

#[test]
fn division_by_zero_is_found_in_the_model_and_in_the_question() {
    let found = wrong("c = 1", "K = '2/(c - 1)'");
    assert_eq!(found, [(Code::DivisionByZero, "division by zero".to_owned(), vec!["(c - 1)".to_owned()])]);
    // In a constant that the formula needs; both places are shown, and once.
    let found = wrong("c = '1/(T - 1)'", "T = 1\nK = '2*c'\nM = '3*c'");
    let places = vec!["(T - 1)".to_owned(), "2*c".to_owned()];
    assert_eq!(found, [(Code::DivisionByZero, "division by zero".to_owned(), places)]);
    let model = model("c = 1", "K = '2/c'");
    let Err(Error::Refused(refused)) = model.ask().set("c", 0).problem() else { panic!("divides by zero") };
    let error = &refused.diagnostics()[0];
    assert_eq!(
        (error.code, error.help.as_deref()),
        (Code::DivisionByZero, Some("here c = 0; set the parameter itself, too"))
    );
    // Nobody needs the formula where the parameter is set or free.
    assert!(model.ask().set("c", 0).set("K", 1).problem().is_ok());
    assert_eq!(model.ask().set("c", 0).free("K").problem().unwrap().parameter().nominal, None);
}

#[test]
fn names_that_are_unknown_or_mean_something_else_are_refused() {
    assert_eq!(wrong("c = 1", "K = 'd'"), [(Code::UnknownName, "unknown name 'd'".to_owned(), vec!["d".to_owned()])]);
    assert_eq!(wrong("c = 1", "K = '2*z'"), [(Code::UnknownName, "unknown name 'z'".to_owned(), vec!["z".to_owned()])]);
    let matrix = wrong("c = 1", "K = 'M'").len();
    assert_eq!(matrix, 1);
    let text = "time = 'discrete'\nconstants.M = [[1]]\nparameters.K = 'M'\n[loop]\nmatrix = [['K']]\n";
    let refused = Model::from_toml(&Source::new("model.toml", text)).unwrap_err();
    assert_eq!(refused.code(), Code::Type);
}

#[test]
fn a_cycle_is_shown_at_all_its_places() {
    let message = |path: &str| format!("nominal values are defined by each other: {path}");
    assert_eq!(
        wrong("", "K = 'M + 1'\nM = '2*K'"),
        [(Code::Cycle, message("K -> M -> K"), vec!["M + 1".to_owned(), "2*K".to_owned()])]
    );
    assert_eq!(wrong("", "K = '0*K'"), [(Code::Cycle, message("K -> K"), vec!["0*K".to_owned()])]);
    let by_constant = wrong("c = '2*K'", "K = { nominal = 'c' }");
    let words = "constants and nominal values are defined by each other: c -> K -> c".to_owned();
    assert_eq!(by_constant, [(Code::Cycle, words, vec!["c".to_owned(), "c".to_owned()])]);
}

#[test]
fn a_formula_without_a_rational_value_is_refused_with_a_number_that_is_near() {
    for (formula, near) in
        [("2*pi", "6.28318530717958"), ("sqrt(2)*c", "1.41421356237309"), ("exp(-c)", "0.36787944117144")]
    {
        let text = text("c = 1", &format!("K = '{formula}'"));
        let refused = Model::from_toml(&Source::new("model.toml", text)).unwrap_err();
        let error = &refused.diagnostics()[0];
        assert_eq!(error.code, Code::NotANumber, "{formula}");
        let help = error.help.as_deref().unwrap();
        assert!(help.starts_with(&format!("write a number, such as {near}")), "{help}");
    }
    assert_eq!(model("c = 9", "K = 'sqrt(c)'").parameter("K").unwrap().nominal, Some(3.into()));
}

#[test]
fn a_value_of_many_digits_stays_exact() {
    let long = "7".repeat(500);
    let model = model(&format!("c = {long}"), "K = 'c/3'");
    assert_eq!(model.parameter("K").unwrap().nominal, Some(number(&format!("{long}/3"))));
    let heavy = wrong("c = 1.234567890123456789", "K = '(c^1000 + 1)^1000 + (c^999 + 1)^1000'");
    assert_eq!(heavy[0].0, Code::TooLarge);
}

#[test]
fn a_value_outside_the_domain_is_remarked_upon() {
    let text = text("c = 1", "K = { nominal = 'c', min = 1 }");
    let (model, warnings) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    let [warning] = warnings.as_slice() else { panic!("{warnings:?}") };
    assert_eq!(warning.code, Code::OutsideDomainWarning);
    assert_eq!(warning.primary.as_ref().unwrap().text, "1 is not in the open domain");
    let codes = |question: Question| -> Vec<String> {
        question.problem().unwrap().warnings().iter().map(|d| d.message.clone()).collect()
    };
    assert!(codes(model.ask()).is_empty(), "it has been said already");
    assert!(codes(model.ask().set("c", 2)).is_empty());
    assert_eq!(codes(model.ask().set("c", number("1/2"))), ["K = 1/2 is outside its domain"]);
}
