//! Certificates of where roots are (damping, radius) and of delay margins: requirements of `jurist/certificate/10` of their own.

use crate::helpers::certificates::checkers::{accept, python, reject, reject_in_rust};
use crate::helpers::certificates::{mutations, with};
use crate::helpers::model::read;
use crate::helpers::number::{number, ratio};
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, tried};
use jurist::Ask;
use jurist::certified::{certify_required_intervals, certify_requirements, certify_tolerance};
use jurist::{Budget, Rational, Requirement, ToleranceRequest};
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

fn budget() -> Budget {
    Budget::unlimited()
}

fn loop_of(time: &str, plant: &str) -> String {
    let step = if time == "discrete" { "sample_time = '1/4'\n" } else { "" };
    format!(
        "time = '{time}'\n{step}parameters.K = {{ nominal = 1, min = 0, max = 10 }}\nloop = {{ inputs = ['r'], outputs = ['y'] }}\n\
         [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = '{plant}'\n"
    )
}

/// `s^2 + s + K`: the damping is `1/(2 sqrt(K))`.
fn second_order() -> String {
    loop_of("continuous", "K/(s*(s + 1))")
}

fn damping(least: &str) -> Requirement {
    Requirement::damping(number(least)).unwrap()
}

fn delay(least: &str) -> Requirement {
    Requirement::delay_margin(number(least)).unwrap()
}

/// A certificate that the loop at a gain meets a requirement, or does not; an error where the checkers do not see that.
fn certified(text: &str, gain: &str, requirement: &Requirement, met: bool) -> Result<String, jurist::Error> {
    let problem = read(text).ask().set("K", number(gain)).problem().unwrap();
    certify_requirements(&problem, std::slice::from_ref(requirement), None, met, &budget())
}

#[test]
fn points_are_certified_on_both_sides_of_known_numbers() {
    // K/s bears pi/(2 K); z^2 - z + K has roots of the modulus sqrt(K).
    let (integrator, sampled) = (loop_of("continuous", "K/s"), loop_of("discrete", "K/(z*(z - 1))"));
    let settling = |time: &str| Requirement::settling_time(number(time), &number("1/4")).unwrap();
    let complex = loop_of("continuous", "K/(s + j)");
    let points = [
        // 1/(2 sqrt(25/9)) = 3/10, 1/(2 sqrt(25/36)) = 3/5.
        (second_order(), "25/9", damping("299/1000"), damping("301/1000")),
        (second_order(), "25/36", damping("599/1000"), damping("601/1000")),
        // exp(-1/time) against 1/2: ln 2 = 0.6931.
        (sampled, "1/4", settling("1.4429"), settling("1.4425")),
        (integrator, "1", delay("1.5707"), delay("1.5709")),
        // The only root is -K - j, and no conjugate stands with it: 3/5 of a root with the modulus 5/4.
        (complex, "3/4", damping("599/1000"), damping("601/1000")),
    ];
    for (text, gain, met, not_met) in tried(points, 2) {
        for (requirement, is_met) in [(met, true), (not_met, false)] {
            let certificate = certified(&text, gain, &requirement, is_met).unwrap();
            accept(&text, &certificate);
            assert!(certified(&text, gain, &requirement, !is_met).is_err(), "{}", requirement.text());
        }
    }
}

/// Proofs need strict inequalities: a damping that is met with equality has a certificate neither of yes nor of no. A number next to it has the true one.
#[test]
fn at_the_edge_there_is_no_certificate() {
    for met in [true, false] {
        assert!(certified(&second_order(), "25/9", &damping("3/10"), met).is_err());
        assert!(certified(&second_order(), "1/4", &damping("999/1000"), met).is_ok() == met);
    }
}

#[test]
fn sets_and_boxes_are_certified() {
    let sets = [
        (second_order(), damping("1/2"), "1"),
        (loop_of("continuous", "K/s"), delay("1"), "1.5707963"),
        (loop_of("discrete", "K/z^2"), Requirement::settling_time(number("2"), &number("1/4")).unwrap(), "0.36787944"),
    ];
    for (text, requirement, end) in tried(sets, 2) {
        let requirements = [requirement];
        let problem = read(&text).ask().free("K").problem().unwrap();
        let answer = problem.required_set(&requirements, None, &budget()).unwrap();
        let found = certify_required_intervals(&answer, &requirements, None, &budget()).unwrap();
        accept(&text, &found.text);
        assert!(found.proved > number("999/1000"), "{found:?}");
        let statement = check(&text, &found.text, &LIMITS).unwrap().statement;
        assert!(statement.contains("and not so for any value in"), "{statement}");
        let request = ToleranceRequest::new([("K", "10%".parse().unwrap())]).require(requirements, None);
        let half = &number(end) * &ratio(1, 2);
        let answer = read(&text).ask().set("K", half).tolerance(&request, &budget()).unwrap();
        let found = certify_tolerance(&answer, None, &budget()).unwrap();
        // The box grows tenfold: from half of the end to the end.
        assert!((found.factor.unwrap() - Rational::from(10)).abs() < number("1/10"));
        assert!(found.text.contains("\"not\""), "a point beyond: {}", found.text);
        accept(&text, &found.text);
    }
}

#[test]
fn statements_that_ask_for_something_else_are_rejected() {
    let text = second_order();
    let certificate = certified(&text, "25/49", &damping("3/5"), true).unwrap();
    // 3/4 is the tangent: 3^2 + 4^2 = 5^2. The damping is 7/10.
    assert!(certificate.contains("\"slopes\": [\"3/4\", \"3/4\"]"), "{certificate}");
    for (from, to, step) in [
        ("\"bound\": \"3/5\"", "\"bound\": \"61/100\"", Step::Statement),
        ("\"bound\": \"3/5\"", "\"bound\": \"1\"", Step::Statement),
        ("\"bound\": \"3/5\"", "\"bound\": \"-3/5\"", Step::Statement),
        ("[\"3/4\", \"3/4\"]", "[\"4/5\", \"4/5\"]", Step::Statement),
        ("[\"3/4\", \"3/4\"]", "[\"1/2\", \"1/2\"]", Step::Statement),
        ("[\"3/4\", \"3/4\"]", "[\"0\", \"3/4\"]", Step::Statement),
        ("[\"3/4\", \"3/4\"]", "[\"1/2\", \"9\"]", Step::Stable),
        ("\"kind\": \"damping\"", "\"kind\": \"damping\", \"at\": {\"signal\": \"y\"}", Step::Statement),
        ("\"time\": \"continuous\"", "\"time\": \"discrete\"", Step::Statement),
        ("\"K\": \"25/49\"", "\"K\": \"30\"", Step::Stable),
        ("\"+", "\"-0>a", Step::Stable),
    ] {
        reject(&text, &with(&certificate, from, to), step);
    }
    // A wider pair around proves as much.
    accept(&text, &with(&certificate, "[\"3/4\", \"3/4\"]", "[\"1/2\", \"4/5\"]"));
    let sampled = loop_of("discrete", "K/(z*(z - 1))");
    let settling = Requirement::settling_time(number("2"), &number("1/4")).unwrap();
    let certificate = certified(&sampled, "1/4", &settling, true).unwrap();
    for (from, to) in [("\"bound\": \"-1/2\"", "\"bound\": \"-3/5\""), ("\"bound\": \"-1/2\"", "\"bound\": \"1/2\"")] {
        reject(&sampled, &with(&certificate, from, to), Step::Statement);
    }
    let certificate = certified(&loop_of("continuous", "K/s"), "1", &delay("1"), true).unwrap();
    for (from, to) in [("\"1\"", "\"8/5\""), ("transfer = 'K/s'", "transfer = 'K/s^2'")] {
        let (text, changed) = match from.contains("transfer") {
            true => (with(&loop_of("continuous", "K/s"), from, to), certificate.clone()),
            false => {
                let bound = certificate.replace("\"bound\": \"1\"", &format!("\"bound\": {to}"));
                (loop_of("continuous", "K/s"), bound)
            }
        };
        reject(&text, &changed, Step::Stable);
    }
}

/// Of a complex loop one edge of the sector tells nothing of roots at the other one.
#[test]
fn both_edges_of_a_sector_are_looked_at() {
    for (plant, gain) in [("K/(s + j)", "2"), ("K/(s - j)", "2")] {
        let text = loop_of("continuous", plant);
        let certificate = certified(&text, gain, &damping("1/2"), true).unwrap();
        accept(&text, &certificate);
        assert!(certificate.contains("\"+..\""), "{certificate}");
        reject(&text, &with(&certificate, "\"+..\"", "\"+.\""), Step::Line);
        // -1/2 -+ j has the damping 0.447.
        reject(&text, &with(&certificate, "\"K\": \"2\"", "\"K\": \"1/2\""), Step::Stable);
    }
}

/// The characteristic function of a loop with dead time is no polynomial: its roots turn with the factor, its exponentials do not.
#[test]
fn roots_beside_dead_time_are_refused() {
    let text = second_order();
    let certificate = certified(&text, "1/2", &damping("1/2"), true).unwrap();
    let delayed = with(&text, "'K/(s*(s + 1))'", "'K*exp(-s/100)/(s*(s + 1))'");
    reject(&delayed, &certificate, Step::Model);
}

/// What both checkers accept of changed certificates is true: the damping or the dead time that is claimed is the loop's own or less, or it is refuted rightly.
#[test]
fn mutations_are_rejected_unless_the_statement_stays_true() {
    let cases = [(second_order(), damping("2/5"), "1"), (loop_of("continuous", "K/s"), delay("3/2"), "1")];
    let mut accepted = 0;
    for (text, requirement, gain) in cases {
        let certificate = certified(&text, gain, &requirement, true).unwrap();
        for mutant in mutations(&Json::parse(&certificate).unwrap()).one_in(1) {
            let (changed, is_damping) = (mutant.to_text(), requirement.name() == "damping");
            let in_rust = check(&text, &changed, &LIMITS);
            if let Some(in_python) = python(&text, &changed) {
                assert_eq!(in_rust.is_ok(), in_python.is_ok(), "{in_python:?}\n{changed}");
            }
            let Ok(proved) = in_rust else { continue };
            accepted += 1;
            let statement = mutant.get("statement").unwrap();
            let of = |json: Option<&Json>| match json {
                Some(Json::Text(text)) => number(text),
                other => panic!("{other:?}"),
            };
            let gain = of(statement.get("set").unwrap().get("K"));
            let Some(Json::List(require)) = statement.get("require") else { panic!("{changed}") };
            let Some(bound) = require.first().map(|own| of(own.get("bound"))) else {
                // Stability is left.
                assert!(gain.sign().is_gt(), "{changed}");
                continue;
            };
            // 1/(2 sqrt(K)) or pi/(2 K) against the bound.
            let is_met = match is_damping {
                true => &(&bound * &bound) * &(&gain * &Rational::from(4)) < Rational::ONE,
                false => &bound * &gain < number("1.5707963"),
            };
            let says_met = !proved.statement.contains("not");
            assert!(says_met == is_met || proved.statement.contains("nothing is said"), "{}", proved.statement);
        }
    }
    assert!(accepted > 5, "{accepted}");
}

/// Random loops: the certificate of the engine's verdict is accepted, and there is none of the opposite.
#[test]
#[ignore = "long: CI runs it"]
fn random_loops_are_certified_as_the_engine_decides() {
    let mut random = Random::new(0x0dab);
    let (mut met, mut not_met) = (0, 0);
    for round in 0..count(4, 36) {
        let mut any = |least: i64, most: i64| least + random.below((most - least + 1) as usize) as i64;
        let (a, b, c) = (any(1, 9), any(1, 9), any(-2, 9));
        let (time, plant) = match round % 3 {
            2 => ("discrete", format!("K*(z + 1/{b})/(z*(z - 1/{})*10)", a + 1)),
            _ => ("continuous", format!("K*({c}*s + {b})/(s*(s^2 + {a}*s + {b}))")),
        };
        let (text, tenths) = (loop_of(time, &plant), ratio(any(1, 9), 10));
        let requirement = match round % 3 {
            0 => Requirement::damping(tenths),
            1 => Requirement::delay_margin(tenths),
            _ => Requirement::settling_time(tenths * Rational::from(4), &number("1/4")),
        };
        let (requirement, gain) = (requirement.unwrap(), ratio(any(1, 20), 10));
        let problem = read(&text).ask().set("K", gain.clone()).problem().unwrap();
        let one = std::slice::from_ref(&requirement);
        let found = problem.requirements_met(one, None, &budget()).unwrap()[0].met;
        let at = |says: bool| certified(&text, &gain.to_string(), &requirement, says);
        let certificate = at(found).unwrap_or_else(|why| panic!("{text} {gain} {}: {why}", requirement.text()));
        accept(&text, &certificate);
        assert!(at(!found).is_err(), "{text} {gain} {}", requirement.text());
        *(if found { &mut met } else { &mut not_met }) += 1;
    }
    assert!(met > count(0, 6) && not_met > count(0, 6), "{met} {not_met}");
}

/// A damping and a delay margin of a sampled loop are no stability of a factor that the checkers know.
#[test]
fn requirements_of_another_time_are_rejected() {
    let certificate = certified(&second_order(), "1", &damping("2/5"), true).unwrap();
    let sampled = loop_of("discrete", "K/(z*(z - 1))");
    let changed = with(&with(&certificate, "continuous", "discrete"), "\"decay\": \"0\"", "\"radius\": \"1\"");
    reject_in_rust(&sampled, &changed, Step::Statement);
    for requirement in [damping("2/5"), delay("2/5")] {
        assert!(certified(&sampled, "1/4", &requirement, true).unwrap_err().to_string().contains("no certificate of"));
    }
}
