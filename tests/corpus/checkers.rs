//! The corpus and the certificates of the library: both checkers accept them, and what they prove is what is expected.

use crate::helpers::certificates::checkers::accept;
use crate::helpers::corpus::{Case, Expectation, Found, FoundEnd, ask_all};
use crate::helpers::model::read;
use crate::helpers::number::number;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::UniPoly;
use jurist_check::format::Json;

fn certificate(case: &Case, expectation: &Expectation) -> Result<String, String> {
    let (question, budget) = (expectation.question(&read(&case.model)), Budget::unlimited());
    let certificate = match &expectation.parameter {
        Some(_) => question.stable_set(&budget).and_then(|answer| answer.certificate(&budget)),
        None => question.verdict(&budget).and_then(|answer| answer.certificate(&budget)),
    };
    certificate.map_err(|e| e.to_string())
}

/// The statement of a certificate, as an answer.
fn statement(certificate: &str) -> Found {
    let json = Json::parse(certificate).unwrap();
    let statement = json.get("statement").expect("a statement");
    if let Some(verdict) = statement.get("verdict") {
        let roots = ["inside", "on", "outside", "infinite"].map(|key| match statement.get(key) {
            Some(Json::Count(n)) => u64::from(*n),
            _ => 0,
        });
        return Found::Verdict { verdict: text(verdict).to_owned(), roots };
    }
    let Some(Json::List(intervals)) = statement.get("stable") else { panic!("{certificate}") };
    let side = |interval: &Json, key: &str| end(interval.get(key).expect("two ends"));
    Found::Stable(intervals.iter().map(|i| [side(i, "lower"), side(i, "upper")]).collect())
}

fn text(json: &Json) -> &str {
    match json {
        Json::Text(text) => text,
        other => panic!("{other:?} is no text"),
    }
}

fn end(json: &Json) -> Option<FoundEnd> {
    let list = |key: &str| match json.get(key) {
        Some(Json::List(items)) => items.iter().map(|item| number(text(item))).collect::<Vec<_>>(),
        _ => Vec::new(),
    };
    let (exact, enclosure, polynomial) = match json {
        Json::Null => return None,
        Json::Text(value) => {
            let value = number(value);
            let polynomial = UniPoly::new(vec![-value.numerator(), value.denominator()]);
            (Some(value.clone()), [value.clone(), value], polynomial)
        }
        _ => {
            let between: [_; 2] = list("between").try_into().expect("two numbers");
            (None, between, UniPoly::new(list("polynomial").iter().map(|c| c.numerator()).collect()))
        }
    };
    Some(FoundEnd { exact, enclosure, polynomial, causes: None, frequencies: None })
}

#[test]
fn both_checkers_prove_what_is_expected() {
    ask_all(3, |case, expectation| {
        if !case.is_proved {
            return Ok(());
        }
        let certificate = certificate(case, expectation)?;
        accept(&case.model, &certificate);
        expectation.answer.compare(&statement(&certificate))
    });
}
