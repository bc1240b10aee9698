//! Certificates of loops with blocks behind a hold: accepted by both checkers, and by neither when anything is changed.

use crate::helpers::certificates::checkers::{accept, python, reject, reject_in_rust};
use crate::helpers::certificates::forgeries::forgeries;
use crate::helpers::certificates::{emitted, emitted_if_any, mutations, with_count_changed};
use crate::helpers::model::read;
use crate::helpers::number::number;
use crate::helpers::thorough::{count, tried};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::stability::Range;
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

fn example(name: &str) -> String {
    let path = format!("{}/examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("an example")
}

/// A loop of a gain and a held block.
fn loop_of(plant: &str) -> String {
    format!(
        "time = 'discrete'\nsample_time = 'T'\nconstants.T = '1/5'\nparameters.K = {{ nominal = 1 }}\n[loop]\n\
         [[block]]\ninput = '-K*y'\noutput = 'u'\ngain = 1\n[[block]]\ninput = 'u'\noutput = 'y'\n{plant}\n"
    )
}

/// What plants can be like: real, complex and repeated modes, integrators, several rates, modes of third order, dead time, direct
/// feedthrough, matrices by their name.
const PLANTS: [&str; 17] = [
    "transfer = '1/(s + 1)'\ndiscretize = 'zoh'",
    "transfer = '1/(s*(s + 1))'\ndiscretize = { method = 'zoh', T = 1 }",
    "transfer = '1/(s + 1)^2'\ndiscretize = 'zoh'",
    "transfer = '3/((s + 1)*(s + 2)*(s - 3/2))'\ndiscretize = 'zoh'",
    "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = { method = 'zoh', delay = '0.7*T' }",
    "transfer = '1/(s^2 + s/2 - 3)'\ndiscretize = { method = 'zoh', delay = '2*T' }",
    "transfer = '1/(s^3 - 2*s^2 + s + 1)'\ndiscretize = 'zoh'",
    "transfer = '1/(s + 1)'\ndiscretize = 'foh'",
    "transfer = '1/(s*(s^2 + 4))'\ndiscretize = { method = 'foh', delay = '0.3*T' }",
    "transfer = '-(exp(-T*s/4)*(s + 3))/(s + 1)*-exp(-T*s/4)'\ndiscretize = 'zoh'",
    "transfer = '1/(s^2*(s + 1))'\ndiscretize = { method = 'zoh', delay = 'T/2' }",
    "A = [[0, 1], [-5, -2]]\nB = [[0], [1]]\nC = [[1, 'K/7']]\ndiscretize = 'zoh'",
    "transfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = '1/3' }",
    "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = { method = 'pwm', edge = 'double', duty = '2/5', delay = '0.6*T' }",
    "transfer = '1/(s*(s + 1))'\ndiscretize = { method = 'pwm', edge = 'leading', duty = '1/4', delay = '3*T/4' }",
    "transfer = '1/(s + 1)^2'\ndiscretize = { method = 'pwm', edge = 'double-ends', duty = '1/7', delay = '2*T' }",
    // Its own angle and a tenth of it are both symbols.
    "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = { method = 'zoh', delay = 'T/10' }",
];

#[test]
#[ignore = "long: CI runs it"]
fn held_plants_of_all_kinds_are_certified() {
    for plant in tried(PLANTS, 2) {
        let model = loop_of(plant);
        let certificate = emitted(&model, "K");
        assert!(certificate.contains("jurist/certificate/2"), "{plant}");
        accept(&model, &certificate);
        for value in tried(["1", "-1", "1/10", "50"], 2) {
            let answer = read(&model).ask().set("K", number(value)).verdict(&Budget::unlimited()).expect(plant);
            let certificate = match answer.certificate(&Budget::unlimited()) {
                Ok(certificate) => certificate,
                // (1 - X)(1 + K) - 1: no exponential is left where K = -1.
                Err(why) => {
                    assert!(
                        plant == PLANTS[0] && value == "-1" && why.to_string().contains("cancel"),
                        "{plant}: {why}"
                    );
                    continue;
                }
            };
            accept(&model, &certificate);
            // Counts are compared in the same way whatever the value is.
            let keys = if value == "1" { &["degree", "inside", "on", "outside", "infinite"][..] } else { &["inside"] };
            for key in keys {
                let wrong = with_count_changed(&certificate, key);
                assert!(check(&model, &wrong, &LIMITS).is_err(), "{plant} at {value}: {key}");
                // It is the slower one, and counts alike whatever the plant is.
                assert!(
                    plant != PLANTS[0] || python(&model, &wrong).is_none_or(|found| found.is_err()),
                    "{plant} at {value}: {key}"
                );
            }
        }
    }
}

/// A chain of integrators needs no symbol: the certificate is one of rational numbers.
#[test]
fn held_integrators_need_no_symbols() {
    for method in ["zoh", "foh"] {
        let model = loop_of(&format!(
            "A = [[0, 1], [0, 0]]\nB = [[0], [1]]\nC = [[1, 2]]\ndiscretize = {{ method = '{method}', delay = '0.3*T' }}"
        ));
        let certificate = emitted(&model, "K");
        assert!(certificate.contains("jurist/certificate/1"));
        accept(&model, &certificate);
    }
}

#[test]
fn the_examples_behind_a_hold_are_certified() {
    // The identity of the boundary takes minutes for the higher orders of the others: their verdicts only.
    for (name, parameter) in
        [("lcl-inverter", Some("Kp")), ("dc-servo", Some("K")), ("drive-hold", None), ("anti-alias-filter", None)]
    {
        let model = example(name);
        if let Some(parameter) = parameter {
            accept(&model, &emitted(&model, parameter));
        }
        let verdict = read(&model).ask().verdict(&Budget::unlimited()).expect(name);
        accept(&model, &verdict.certificate(&Budget::unlimited()).expect(name));
    }
}

/// Fast modes in short times: the symbols are small, the coefficients before their powers long, and the checkers multiply them last.
#[test]
#[ignore = "long: CI runs it"]
fn long_coefficients_have_their_bits() {
    let plant = "transfer = '1/(s*(s^2/4900000 + s/5000 + 1))'\ndiscretize = { method = 'zoh', delay = '0.3*T' }";
    let model = loop_of(plant).replace("'1/5'", "'1/4000'").replace("gain = 1", "transfer = '1/z'");
    let certificate = emitted(&model, "K");
    accept(&model, &certificate);
    let Some(Json::Count(bits)) = Json::parse(&certificate).expect("JSON").get("bits").cloned() else {
        panic!("no bits")
    };
    reject_in_rust(&model, &certificate.replace(&format!("\"bits\": {bits}"), "\"bits\": 320"), Step::Line);
}

/// What is not a number at fixed times has no certificate yet, and is not given one that would be rejected.
#[test]
fn what_no_checker_knows_gets_no_certificate() {
    for (name, parameter) in
        [("drive-hold", "T"), ("lcl-inverter", "Lg"), ("dc-servo", "T_m"), ("anti-alias-filter", "w_f")]
    {
        let model = read(&example(name));
        let domain = Range::between(Some(number("1/1000")), Some(number("1/500")));
        let asked = model.ask().free(parameter).domain(parameter, domain);
        let Ok(answer) = asked.stable_set(&Budget::unlimited()) else { continue };
        let refused = answer.certificate(&Budget::unlimited()).expect_err(name).to_string();
        assert!(refused.contains("no certificate"), "{name}: {refused}");
    }
    for written in ["gain = 'exp(-1)'", "gain = 'sqrt(2)/5'", "gain = 'pi'"] {
        let model = loop_of(PLANTS[0]).replace("gain = 1", written);
        assert!(emitted_if_any(&model, "K").is_none(), "{written}");
    }
}

/// Another edge, duty ratio or dead time is another loop.
#[test]
fn certificates_of_pulses_are_about_these_pulses() {
    let model = loop_of(
        "transfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'double', duty = '2/5', delay = '0.6*T' }",
    );
    let certificate = emitted(&model, "K");
    accept(&model, &certificate);
    for (part, other) in [
        ("'double'", "'double-ends'"),
        ("'double'", "'trailing'"),
        ("'2/5'", "'3/5'"),
        ("'0.6*T'", "'0.5*T'"),
        ("method = 'pwm', edge = 'double', duty = '2/5',", "method = 'zoh',"),
        (", edge = 'double'", ""),
        (", duty = '2/5'", ", duty = '7/5'"),
        ("delay = '0.6*T'", "delay = '0.6*T', T = 'T'"),
    ] {
        let changed = model.replace(part, other);
        assert_ne!(changed, model, "{part}");
        assert!(check(&changed, &certificate, &LIMITS).is_err(), "{part}");
        assert!(!matches!(python(&changed, &certificate), Some(Ok(_))), "{part}");
    }
}

/// The duty ratio as the question, and the sample time of a plant behind a modulator: by boxes.
#[test]
fn certificates_of_boxes_hold_pulses() {
    let model = loop_of("transfer = '1/(s + 1)^2'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = 'D' }");
    let model = model
        .replace("constants.T = '1/5'", "constants.T = '1/5'\nconstants.D = '2/5'")
        .replace("nominal = 1 ", "nominal = 40 ");
    for (name, domain) in [("D", ["1/10", "9/10"]), ("T", ["1/20", "2/5"])] {
        let domain = Range::between(Some(number(domain[0])), Some(number(domain[1])));
        let answer = read(&model).ask().free(name).domain(name, domain).stable_set(&Budget::unlimited()).expect(name);
        let certified = jurist::certified::certify_intervals(&answer, &Budget::unlimited())
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        let certificate = &certified.text;
        accept(&model, certificate);
        let changed = model.replace("'trailing'", "'leading'");
        assert!(check(&changed, certificate, &LIMITS).is_err(), "{name}");
        assert!(!matches!(python(&changed, certificate), Some(Ok(_))), "{name}");
    }
}

/// Nothing that is changed in a certificate makes another statement pass; and what passes, passes both checkers. Of each
/// certificate a part of the mutations, of the long ones a small one.
#[test]
#[ignore = "long: CI runs it"]
fn no_mutation_of_a_held_certificate_changes_what_is_proved() {
    for (plant, every) in [(PLANTS[0], 6), (PLANTS[4], 94), (PLANTS[7], 94), (PLANTS[12], 12)] {
        let model = loop_of(plant);
        let original = Json::parse(&emitted(&model, "K")).expect("JSON");
        let (mut tried, mut accepted) = (0, 0);
        for mutant in mutations(&original).one_in(every * count(3, 1)) {
            tried += 1;
            let text = mutant.to_text();
            let Ok(proved) = check(&model, &text, &LIMITS) else {
                continue;
            };
            accepted += 1;
            assert_eq!(plain(original.get("statement")), plain(mutant.get("statement")), "{}", proved.statement);
            if let Some(Err(e)) = python(&model, &text) {
                panic!("Python: {e}\n{text}");
            }
        }
        assert!(tried * every * count(3, 1) >= 400 && accepted * 4 < tried, "{accepted} of {tried}");
        for forgery in forgeries(&original).into_iter().step_by(every) {
            if check(&model, &forgery.to_text(), &LIMITS).is_ok() {
                assert_eq!(plain(original.get("statement")), plain(forgery.get("statement")));
            }
        }
    }
}

/// Numbers in lowest terms, the terms of a polynomial in one order.
fn plain(json: Option<&Json>) -> Json {
    match json {
        Some(Json::Text(text)) => {
            jurist_algebra::number::parse_number(text).map_or_else(|_| text.as_str().into(), |q| q.to_string().into())
        }
        Some(Json::List(items)) => {
            let mut items: Vec<Json> = items.iter().map(|item| plain(Some(item))).collect();
            if items.iter().all(|item| matches!(item, Json::List(term) if matches!(term.first(), Some(Json::Text(_)))))
            {
                items.sort_by_key(Json::to_text);
            }
            Json::List(items)
        }
        Some(Json::Object(pairs)) => Json::Object(pairs.iter().map(|(k, v)| (k.clone(), plain(Some(v)))).collect()),
        Some(other) => other.clone(),
        None => Json::Null,
    }
}

/// The same mutations by the other checker, one in three hundred of them.
#[test]
#[ignore = "long: CI runs it"]
fn the_python_checker_rejects_the_same_mutations() {
    let model = loop_of(PLANTS[4]);
    let original = Json::parse(&emitted(&model, "K")).expect("JSON");
    for mutant in mutations(&original).one_in(301) {
        let text = mutant.to_text();
        let Some(found) = python(&model, &text) else { return };
        assert_eq!(found.is_ok(), check(&model, &text, &LIMITS).is_ok(), "{found:?}\n{text}");
    }
}

/// The constants of a model, its times, and the kind of its hold are all in the polynomial.
#[test]
fn certificates_of_other_held_models_are_rejected() {
    let model = loop_of(PLANTS[4]);
    let certificate = emitted(&model, "K");
    for (from, to) in [
        ("'1/5'", "'1/6'"),
        ("2 - s", "2 - 1.0001*s"),
        ("s/2 + 3", "s/2 + 3.0000001"),
        ("0.7*T", "0.71*T"),
        ("0.7*T", "1.7*T"),
        ("0.7*T", "0"),
        ("zoh", "foh"),
        ("-K*y", "-2*K*y"),
        ("time = 'discrete'", "time = 'continuous'"),
    ] {
        assert!(model.contains(from), "{from}");
        let other = model.replacen(from, to, 1);
        assert!(check(&other, &certificate, &LIMITS).is_err(), "{to}");
        assert!(python(&other, &certificate).is_none_or(|found| found.is_err()), "{to}");
    }
}

/// Ends moved by a little more than the enclosure, samples of the wrong side, signs that are not certain.
#[test]
fn held_ends_and_bits_are_checked() {
    let model = loop_of(PLANTS[1]);
    let certificate = emitted(&model, "K");
    let json = Json::parse(&certificate).expect("JSON");
    let Some(Json::Count(bits)) = json.get("bits") else { panic!("no bits") };
    let with = |from: &str, to: &str| {
        assert!(certificate.contains(from), "{from} in\n{certificate}");
        certificate.replace(from, to)
    };
    let bits_are = |n: &str| with(&format!("\"bits\": {bits}"), &format!("\"bits\": {n}"));
    reject(&model, &bits_are("63"), Step::Format);
    reject(&model, &bits_are("999999"), Step::Format);
    // With so few bits an enclosure of a number near zero contains it, or all is still certain.
    let few = bits_are("64");
    let proves = check(&model, &few, &LIMITS).is_ok();
    assert!(python(&model, &few).is_none_or(|found| found.is_ok() == proves));
    reject(&model, &with("certificate/2", "certificate/1"), Step::Format);
}

/// Beside the characteristic polynomial the checkers have a divisor of degree 84 in the tangent of the oscillation: it asks for more bits than that has.
#[test]
fn an_oscillation_with_part_of_a_sample_of_dead_time() {
    let text = "time = 'discrete'\nsample_time = '2/7'\n[parameters]\nK = { nominal = 1, min = -1, max = 6 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
                [[block]]\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s^2 + 16)'\n\
                discretize = { method = 'zoh', delay = '1/3' }\n";
    accept(text, &emitted(text, "K"));
}
