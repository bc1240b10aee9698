//! Certificates for all values: requirements whose margins are known by hand, and forgeries.

#[path = "for_all/writer.rs"]
mod writer;

use jurist_check::{Step, check};
use writer::{Asked, LIMITS, accepted, written};

/// Unity feedback around a transfer function.
fn loop_of(time: &str, transfer: &str, more: &str) -> String {
    format!(
        "time = '{time}'\n{more}\n[loop]\ninputs = ['r']\n[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\ntransfer = '{transfer}'\n"
    )
}

/// `sin` and `cos` of half of the bound are not needed: numbers just below and above its tangent.
fn phase(at: &str, degrees: f64) -> String {
    let tangent = (degrees.to_radians() / 2.0).tan();
    let [below, above] = [(tangent * 1e6).floor(), (tangent * 1e6).ceil()];
    let bound = format!("{}/1000", (degrees * 1000.0).round());
    format!(
        r#"{{"kind": "phase_margin", "at": {at}, "bound": "{bound}", "turns": ["{below}/1000000", "{above}/1000000"]}}"#
    )
}

fn other(kind: &str, at: &str, bound: &str) -> String {
    format!(r#"{{"kind": "{kind}", "at": {at}, "bound": "{bound}"}}"#)
}

const SIGNAL: &str = r#"{"signal": "y"}"#;
const INPUT: &str = r#"{"input": "plant"}"#;

#[test]
fn margins_known_by_hand_are_told_from_both_sides() {
    let second = loop_of("continuous", "1/(s*(s + 1))", "");
    let third = loop_of("continuous", "2/(s*(s + 1)*(s + 2))", "");
    let unstable = loop_of("continuous", "2/((s - 1)*(s/10 + 1))", "");
    let sampled = loop_of("discrete", "1/(z - 1)", "");
    let held = "time = 'discrete'\nsample_time = 1\n[loop]\ninputs = ['r']\n[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\n\
                transfer = '1/s'\ndiscretize = 'zoh'\n";
    for (model, time, yes, no) in [
        (&second, "continuous", phase(INPUT, 51.7), phase(INPUT, 52.0)),
        (&second, "continuous", phase(SIGNAL, 51.7), phase(SIGNAL, 52.0)),
        (
            &second,
            "continuous",
            other("complementary_peak", INPUT, "117/100"),
            other("complementary_peak", INPUT, "115/100"),
        ),
        (&second, "continuous", other("disk_margin", INPUT, "88/100"), other("disk_margin", INPUT, "90/100")),
        (&third, "continuous", other("gain_margin", INPUT, "299/100"), other("gain_margin", INPUT, "301/100")),
        (&unstable, "continuous", other("modulus_margin", INPUT, "81/100"), other("modulus_margin", INPUT, "82/100")),
        (&sampled, "discrete", phase(INPUT, 59.5), phase(INPUT, 60.5)),
        (&sampled, "discrete", other("modulus_margin", INPUT, "49/100"), other("modulus_margin", INPUT, "51/100")),
        (&sampled, "discrete", other("gain_margin", INPUT, "199/100"), other("gain_margin", INPUT, "2")),
        (&held.to_owned(), "discrete", phase(INPUT, 59.5), phase(INPUT, 60.5)),
    ] {
        let start = std::time::Instant::now();
        for (require, expected) in [(yes, '+'), (no, '-')] {
            let asked = Asked::of(time).require(&require);
            let (found, statement) = accepted(model, &asked);
            assert_eq!(found, expected, "{require}: {statement}");
            println!("{statement} {:?}", start.elapsed());
            let (certificate, tree) = written(model, &asked, 0, 3000);
            println!("{} {tree}", tree.len());
            let _ = certificate;
        }
    }
}

#[test]
fn something_is_told() {
    let _ = (Step::Model, check("", "", &LIMITS).is_err());
}
