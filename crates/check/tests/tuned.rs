//! Certificates of best gains: sentences, forgeries, and random changes whose truth is sampled.

#[path = "agreement/python.rs"]
mod python;
#[path = "for_all/samples.rs"]
mod samples;

#[path = "tuned/changes.rs"]
mod changes;
#[path = "tuned/truth.rs"]
mod truth;
#[path = "tuned/writer.rs"]
mod writer;

use jurist_check::{Step, check};
use python::Python;
use writer::{Asked, LIMITS, at_input, one, two};

/// That both checkers accept a certificate, with the same sentence.
fn accepted(asked: &Asked) -> String {
    let certificate = asked.written().expect("the judge sees it");
    let proved = check(&asked.plant.model, &certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{certificate}"));
    assert_eq!(proved.kind, "tune");
    assert!(truth::is_true(&asked.plant, &certificate), "{}", proved.statement);
    if let Some(mut python) = Python::start() {
        let (word, said) = python.judge(&asked.plant.model, &certificate);
        assert_eq!((word.as_str(), said.as_str()), ("accepted", proved.statement.as_str()), "{certificate}");
    }
    proved.statement
}

/// That both checkers reject a text.
fn rejected(model: &str, certificate: &str, step: Step) {
    match check(model, certificate, &LIMITS) {
        Ok(proved) => panic!("accepted: {}\n{certificate}", proved.statement),
        Err(e) => assert_eq!(e.step, step, "{e}\n{certificate}"),
    }
    if let Some(mut python) = Python::start() {
        let (word, said) = python.judge(model, certificate);
        assert_eq!(word, "rejected", "{said}\n{certificate}");
    }
}

/// `K/(s (s + 1) (s + 2))` is stable up to 6, with a gain margin of 2 up to 3.
#[test]
fn the_statement_is_a_sentence_about_the_whole_box() {
    let greatest = |proved: &str| format!(r#"{{"greatest": {}, "proved": "{proved}"}}"#, writer::GAIN);
    let best = one().objective(&greatest("601/100")).found("5", "null");
    assert_eq!(
        accepted(&best),
        "For no K from 1/8 to 20 with K >= 601/100, the loop is stable. At K = 5 it is, and K is 5 there."
    );
    let required = one().require(&at_input("gain_margin", "2"));
    assert_eq!(
        accepted(&required.clone().objective(&greatest("301/100")).found("2", "null")),
        "For no K from 1/8 to 20 with K >= 301/100, the loop is stable, with a gain margin of at least 2 both ways at the input of 'plant'. At K = 2 it is, and \
         K is 2 there."
    );
    assert_eq!(
        accepted(&required.clone().between("31/10", "20")),
        "For no K from 31/10 to 20, the loop is stable, with a gain margin of at least 2 both ways at the input of 'plant'."
    );
    let formula =
        r#"{"least": {"above": [["-3"], ["2", 1, 1], ["-1", 0, 2]], "below": [["1", 1], ["1"]]}, "proved": "-200"}"#;
    let words = accepted(&two().objective(formula).found_at(&["1", "1"], "null"));
    assert!(words.contains("(2*K*a - a^2 - 3)/(K + 1) <= -200, the loop"), "{words}");
    // (s + 1/2)(s + 1/2 + j ...): the rightmost roots are at least right of -1/2.
    let level = r#"{"level": {"decay": "9/20"}}"#;
    assert_eq!(
        accepted(&one().objective(level).found("3/8", r#"{"decay": "1/10"}"#)),
        "For no K from 1/8 to 20, the loop is stable with all Re s < -9/20. At K = 3/8 it is, with all Re s < -1/10 instead."
    );
    let level = format!(r#"{{"level": {}}}"#, at_input("gain_margin", "50"));
    assert_eq!(
        accepted(&one().objective(&level).found("1/2", &at_input("gain_margin", "11"))),
        "For no K from 1/8 to 20, the loop is stable, with a gain margin of at least 50 both ways at the input of 'plant'. At K = 1/2 it is, with a gain margin of \
         at least 11 both ways at the input of 'plant' instead."
    );
}

/// Of a certificate `find` becomes `put`.
fn forged(asked: &Asked, find: &str, put: &str, step: Step) {
    let certificate = asked.written().expect("the judge sees it");
    let text = certificate.replace(find, put);
    assert_ne!(text, certificate, "{find}");
    rejected(&asked.plant.model, &text, step);
}

#[test]
fn forgeries_are_rejected() {
    let greatest = format!(r#"{{"greatest": {}, "proved": "601/100"}}"#, writer::GAIN);
    let best = one().objective(&greatest).found("5", "null");
    // The point is outside of the box, or is not good, or has another number of gains.
    forged(&best, r#""point": ["5"]"#, r#""point": ["21"]"#, Step::Statement);
    forged(&best, r#""point": ["5"]"#, r#""point": ["7"]"#, Step::Stable);
    forged(&best, r#""point": ["5"]"#, r#""point": ["5", "5"]"#, Step::Statement);
    forged(&best, r#""proof": "."#, r#""proof": ""#, Step::Line);
    forged(&best, r#""proof": "."#, r#""proof": ".."#, Step::Line);
    // What is proved is below what is found, or the other side of it.
    forged(&best, "601/100", "4", Step::Stable);
    forged(&best, "greatest", "least", Step::Stable);
    // Bounds in reverse, an empty box, a name twice, names that the model has not.
    forged(&best, r#"["1/8", "20"]"#, r#"["20", "1/8"]"#, Step::Statement);
    forged(&best, r#"["1/8", "20"]"#, r#"["20", "20"]"#, Step::Statement);
    let range = r#"{"name": "K", "between": ["1/8", "20"]}"#;
    forged(&best, range, &format!("{range}, {range}"), Step::Statement);
    forged(&best, range, &range.replace('K', "L"), Step::Model);
    forged(&best, r#""set": {}"#, r#""set": {"K": "1"}"#, Step::Model);
    forged(&best, r#""set": {}"#, r#""set": {"L": "1"}"#, Step::Model);
    // Unknown keys, and kinds that the version has not.
    forged(&best, r#""found": "#, r#""free": [], "found": "#, Step::Statement);
    forged(&best, r#""proved": "#, r#""bound": "1", "proved": "#, Step::Statement);
    forged(&best, "certificate/11", "certificate/10", Step::Statement);
    forged(&best, r#""level": null"#, r#""level": {"decay": "1/10"}"#, Step::Statement);
    // Leaves that are none.
    for tree in
        ["", "o", "+.", "?", "-1.", "-0", "-0..", "s0.", "s1000;0.", "s-3:0.", "b-0.-0.", "-0la.", "a-0.", "s100;0."]
    {
        let certificate = best.certificate(tree, ".");
        assert!(check(&best.plant.model, &certificate, &LIMITS).is_err(), "{tree}");
        if let Some(mut python) = Python::start() {
            assert_ne!(python.judge(&best.plant.model, &certificate).0, "accepted", "{tree}");
        }
    }
    // The count is zero there: the loop is stable up to 6.
    let none = one().between("1", "5");
    rejected(&none.plant.model, &none.certificate("-0.", ""), Step::Stable);
    rejected(&none.plant.model, &none.certificate("s-4;0.", ""), Step::Stable);
    // The denominator has a zero in the box.
    let formula = r#"{"greatest": {"above": [["1"]], "below": [["1", 1], ["-4"]]}, "proved": "1000"}"#;
    let pole = one().between("1", "5").objective(formula);
    rejected(&pole.plant.model, &pole.certificate("o", ""), Step::Stable);
    let defined = one().between("1", "3").objective(formula);
    assert!(check(&defined.plant.model, &defined.certificate("o", ""), &LIMITS).is_ok());
    // Of two levels the one of which there is none asks for more, and both are of one kind.
    let level = format!(r#"{{"level": {}}}"#, at_input("gain_margin", "50"));
    for other in [
        at_input("gain_margin", "51"),
        at_input("modulus_margin", "1/10"),
        r#"{"decay": "1/10"}"#.to_owned(),
        "null".to_owned(),
    ] {
        let asked = one().objective(&level).found("1/2", &other);
        rejected(&asked.plant.model, &asked.certificate("-0.", ".."), Step::Statement);
    }
    // A loop that only the gains that are found have is no reason.
    let asked = one().objective(&level).found("1/2", &at_input("gain_margin", "11"));
    rejected(&asked.plant.model, &asked.certificate("-2<b.", ".."), Step::Line);
}

/// Sections that change nothing of the loop do not matter.
#[test]
fn a_section_of_the_model_about_gains_does_not_matter() {
    let asked = one().between("61/10", "20");
    let certificate = asked.written().unwrap();
    let model =
        format!("{}\n[tune]\nfree = ['K']\nobjective = 'max K'\nbounds = {{ K = [0, 1] }}\n", asked.plant.model);
    let known = check(&asked.plant.model, &certificate, &LIMITS).unwrap();
    assert_eq!(check(&model, &certificate, &LIMITS).unwrap(), known);
    if let Some(mut python) = Python::start() {
        assert_eq!(python.judge(&model, &certificate), ("accepted".to_owned(), known.statement));
    }
}
