//! A closed end of a domain belongs to the question: the answer includes it where the loop is stable there.

use crate::helpers::number::number;
use jurist::{Ask, Document, Text};
use jurist_algebra::limits::Budget;
use jurist_engine::error::{Code, Source};
use jurist_engine::model::{Model, ParameterBuilder, Time};
use jurist_engine::problem::Question;
use jurist_engine::stability::Range;

/// A loop that is stable for `0 < K < 2`.
fn text(parameter: &str) -> String {
    format!("time = 'discrete'\n[parameters]\nK = {parameter}\n[loop]\ncharacteristic = 'z - 1 + K'\n")
}

fn model(text: &str) -> Model {
    let (model, warnings) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    assert_eq!(warnings, []);
    model
}

fn stable(question: Question) -> String {
    let answer = question.stable_set(&Budget::unlimited()).unwrap();
    let text = answer.text(6);
    text.lines().skip(1).take_while(|line| *line != "ends").map(str::trim).collect::<Vec<_>>().join("; ")
}

fn of(parameter: &str) -> String {
    stable(model(&text(parameter)).ask().free("K"))
}

#[test]
fn a_closed_end_is_in_the_answer_where_the_loop_is_stable_there() {
    assert_eq!(of("{ min = 0.5, max = 1 }"), "K, domain 0.5 < K < 1: stable for; 0.5 < K < 1");
    assert_eq!(of("{ min = 0.5, max = 1, closed = true }"), "K, domain 0.5 <= K <= 1: stable for; 0.5 <= K <= 1");
    assert_eq!(of("{ domain = [0.5, '2/2'] }"), "K, domain 0.5 <= K <= 1: stable for; 0.5 <= K <= 1");
    assert_eq!(of("{ min = 0.5, closed = true }"), "K, domain K >= 0.5: stable for; 0.5 <= K < 2");
    assert_eq!(of("{ max = 1, closed = true }"), "K, domain K <= 1: stable for; 0 < K <= 1");
    assert_eq!(of("{ min = 0.5, closed = false }"), "K, domain K > 0.5: stable for; 0.5 < K < 2");
    // At 0 and at 2 a root is on the boundary.
    assert_eq!(of("{ domain = [0, 2] }"), "K, domain 0 <= K <= 2: stable for; 0 < K < 2");
    assert_eq!(of("{ domain = [2, 3] }"), "K, domain 2 <= K <= 3: stable nowhere");
}

#[test]
fn documents_say_which_ends_belong_to_the_domain_and_to_the_answer() {
    let model = model(&text("{ nominal = 1, min = 1, max = 5, closed = true }"));
    let document =
        serde_json::to_value(model.ask().free("K").stable_set(&Budget::unlimited()).unwrap().json(6)).unwrap();
    assert_eq!(document["domain_closed"], serde_json::json!({ "lower": true, "upper": true }));
    let interval = &document["stable"][0];
    assert_eq!((&interval["lower"]["closed"], &interval["upper"]["closed"]), (&true.into(), &false.into()));
    assert_eq!(interval["lower"]["cause"], "domain");
    let open = model.ask().free("K").domain("K", Range::between(Some(1.into()), Some(5.into())));
    let document = serde_json::to_value(open.stable_set(&Budget::unlimited()).unwrap().json(6)).unwrap();
    assert!(document.get("domain_closed").is_none());
    assert_eq!(document["stable"][0]["lower"]["closed"], false);
}

#[test]
fn an_end_at_which_the_model_has_no_meaning_is_in_no_answer() {
    // Division by zero at 1.
    let divides = text("{ domain = [0.5, 1] }").replace("1 + K", "1/2 + 0*K/(K - 1)");
    assert_eq!(stable(model(&divides).ask().free("K")), "K, domain 0.5 <= K <= 1: stable for; 0.5 <= K < 1");
    // A sample time of zero, behind a hold.
    let held = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = 1, domain = [0, 1.5] }\n[loop]\ninputs = ['r']\n\
        outputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = '1/s'\ndiscretize = 'zoh'\n";
    assert_eq!(stable(model(held).ask().free("T")), "T, domain 0 <= T <= 1.5: stable for; 0 < T <= 1.5");
}

#[test]
fn a_dead_time_of_zero_is_asked_about_where_the_domain_says_so() {
    let text = |domain: &str| {
        format!(
            "time = 'continuous'\n[parameters]\ntau = {{ nominal = 1, {domain} }}\n[loop]\n\
             inputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = '1/s*exp(-tau*s)'\n"
        )
    };
    let found = |domain: &str| stable(model(&text(domain)).ask().free("tau"));
    assert_eq!(found("min = 0"), "tau, domain tau > 0: stable for; 0 < tau < 1.57080");
    assert_eq!(found("min = 0, closed = true"), "tau, domain tau >= 0: stable for; 0 <= tau < 1.57080");
    assert_eq!(found("domain = [0, 1.5]"), "tau, domain 0 <= tau <= 1.5: stable for; 0 <= tau <= 1.5");
}

#[test]
fn other_parameters_have_no_part_in_it_and_maps_are_about_the_inside() {
    let text = "time = 'discrete'\n[parameters]\na = { nominal = 0, domain = [0, 1] }\nb = { nominal = 0, domain = [0, 1] }\n\
        [loop]\ncharacteristic = 'z^2 + a*z/2 + b/4'\n";
    let model = model(text);
    assert_eq!(stable(model.ask().free("a")), "a, domain 0 <= a <= 1: stable for; 0 <= a <= 1");
    let map = model.ask().free("a").free("b").map(6, &Budget::unlimited()).unwrap().text(6);
    assert!(map.contains("0 < a < 1") && !map.contains("<="), "{map}");
}

#[test]
fn a_nominal_value_at_a_closed_end_is_inside() {
    let warned = |parameter: &str| -> Vec<String> {
        let (_, warnings) = Model::from_toml(&Source::new("model.toml", text(parameter))).unwrap();
        warnings.iter().map(|d| format!("{} {}", d.code, d.primary.as_ref().unwrap().text)).collect()
    };
    assert!(warned("{ nominal = 1, domain = [1, 2] }").is_empty());
    assert!(warned("{ nominal = 2, domain = [1, 2] }").is_empty());
    assert_eq!(warned("{ nominal = 2, min = 1, max = 2 }"), ["W-outside-domain not in the open domain"]);
    assert_eq!(warned("{ nominal = 3, domain = [1, 2] }"), ["W-outside-domain not in the closed domain"]);
    let model = model(&text("{ nominal = 1, domain = [1, 2] }"));
    let warnings = |value: &str| model.ask().set("K", number(value)).problem().unwrap().warnings().len();
    assert_eq!([warnings("1"), warnings("2"), warnings("3"), warnings("1/2")], [0, 0, 1, 1]);
}

#[test]
fn a_domain_that_is_empty_or_unclear_is_refused() {
    let wrong = |parameter: &str| -> Vec<(Code, String, String)> {
        let text = text(parameter);
        let refused = Model::from_toml(&Source::new("model.toml", text.clone())).unwrap_err();
        let said = |d: &jurist_engine::error::Diagnostic| {
            let span = d.primary.as_ref().unwrap().span;
            (d.code, d.message.clone(), text[span.start..span.end].to_owned())
        };
        refused.diagnostics().iter().map(said).collect()
    };
    let one = |code: Code, message: &str, at: &str| vec![(code, message.to_owned(), at.to_owned())];
    let single = "the domain of 'K' is a single value";
    assert_eq!(wrong("{ domain = [2, '4/2'] }"), one(Code::EmptyDomain, single, "'4/2'"));
    assert_eq!(wrong("{ min = 2, max = 2, closed = true }"), one(Code::EmptyDomain, single, "2"));
    let empty = "the domain of 'K' is empty";
    assert_eq!(wrong("{ domain = [3, 2] }"), one(Code::EmptyDomain, empty, "2"));
    assert_eq!(wrong("{ min = 2, max = 2 }"), one(Code::EmptyDomain, empty, "2"));
    assert_eq!(wrong("{ domain = [3] }"), one(Code::Size, "a domain has two ends", "[3]"));
    assert_eq!(wrong("{ domain = 3 }")[0].0, Code::Type);
    assert_eq!(wrong("{ min = 1, closed = 'yes' }")[0].0, Code::Type);
    let twice = "the domain of 'K' is given twice";
    assert_eq!(wrong("{ domain = [1, 2], min = 1 }"), one(Code::TwoForms, twice, "min"));
    assert_eq!(wrong("{ domain = [1, 2], closed = true }"), one(Code::TwoForms, twice, "closed"));
    assert_eq!(
        wrong("{ closed = true }"),
        one(Code::Missing, "the domain of 'K' has no end that could be closed", "true")
    );
    assert_eq!(wrong("{ domain = ['-inf', 2] }").len(), 1);
}

#[test]
fn ends_of_many_digits_and_ends_a_hair_from_the_limit_are_told_apart() {
    let long = |digit: &str| format!("1.{}", digit.repeat(500));
    let answer = |max: &str| {
        let model = model(&text(&format!("{{ min = 1, max = {max}, closed = true }}")));
        model.ask().free("K").stable_set(&Budget::unlimited()).unwrap()
    };
    let below = answer(&long("9"));
    let interval = &below.value().intervals()[0];
    assert!(interval.upper.as_ref().unwrap().closed && interval.contains(&number(&long("9"))));
    assert!(!answer("2").value().intervals()[0].upper.as_ref().unwrap().closed);
}

#[test]
fn a_builder_closes_a_domain() {
    let parameter = ParameterBuilder::new("K").min("1/2").max("1").closed();
    let (model, _) = Model::builder(Time::Discrete).parameter(parameter).characteristic("z - 1 + K").build().unwrap();
    assert_eq!(stable(model.ask().free("K")), "K, domain 0.5 <= K <= 1: stable for; 0.5 <= K <= 1");
}
