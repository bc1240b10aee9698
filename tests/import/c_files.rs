//! C files of DSVerifier: imported, shipped, and refused with their places.

use super::{asked, file, imported, imported_text, is_clean};
use crate::helpers::program::{jurist, jurist_with_input, refused};
use serde_json::Value;

/// A loop whose lists have different lengths: `regression/cbmc/closed-loop/stability_closedloop_feedback_dslib_02` of DSVerifier.
const UNEVEN: &str = "digital_system controller = { .b = { 0.15 }, .b_size = 1, .a = { 1.0 }, .a_size = 1, .sample_time = 0.01 };
implementation impl = { .int_bits = 3, .frac_bits = 16, .delta = 0.25, .max = 1.0, .min = -1.0, .scale = 1 };
digital_system plant = { .b = { 2.0, -4.0 }, .b_size = 2, .a = { 1.0, -0.1, -0.3 }, .a_size = 3, .a_uncertainty = { 0, 0, 1 } };
";

/// The document of a verdict, which may be that it is not stable.
fn verdict(model: &str) -> Value {
    let run = jurist_with_input(&["verdict", "-", "--json"], model.as_bytes());
    serde_json::from_str(&run.stdout).expect("a document")
}

#[test]
fn a_loop_is_a_model_and_is_shipped() {
    let printed = imported("pendulum.c", &[]).stdout;
    is_clean(&printed);
    // Two of the roots have the modulus 1.034266 by numpy, and 1.034752 as DSVerifier stores the controller.
    let stored = imported("pendulum.c", &["--stored"]).stdout;
    is_clean(&stored);
    for (model, fraction) in [(&printed, "0.88965"), (&stored, "113/128")] {
        let verdict = verdict(model);
        assert_eq!(
            (verdict["verdict"].as_str(), verdict["outside"].as_u64()),
            (Some("unstable"), Some(2)),
            "{verdict}"
        );
        assert!(model.contains(fraction), "{model}");
    }
    let run = jurist(&["ship", "--from", &file("pendulum.c")]);
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(
        run.stderr.contains("note: all coefficients are divided by the leading one of the denominator, 0.88965"),
        "{}",
        run.stderr
    );
    let options = ["--round", "nearest", "--realisation", "df2t", "--json", "-q"];
    let run = jurist(&[&["ship", "--from", &file("pendulum.c")], options.as_slice()].concat());
    let document: Value = serde_json::from_str(&run.stdout).expect("a document");
    assert_eq!(
        (document["realisation"].as_str(), document["format"]["round"].as_str()),
        (Some("df2t"), Some("nearest")),
        "{document}"
    );
}

#[test]
fn readings() {
    let run = imported_text(UNEVEN, &[]);
    is_clean(&run.stdout);
    assert!(run.stderr.contains("W-dsv-reading") && run.stderr.contains("<stdin>:3"), "{}", run.stderr);
    assert_eq!(verdict(&run.stdout)["verdict"], "unstable");
    let delays = imported_text(UNEVEN, &["--reading", "z^-1"]);
    assert_eq!(delays.stderr, "");
    assert_eq!(verdict(&delays.stdout)["verdict"], "stable");
    assert!(
        delays.stdout.contains("num = [2.0, -4.0, 0]")
            && delays.stdout.contains("plant_a2 = { value = -0.3, tolerance = \"1%\" }")
    );
    assert_eq!(asked(&["tolerance", "--only"], &delays.stdout)["verdict"], "stable");
    let run = jurist_with_input(&["ship", "--from", "-", "--reading", "z^-1"], UNEVEN.as_bytes());
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{}", run.stdout);
}

#[test]
fn conditions_are_defined_on_the_command_line() {
    let text = format!("#if DS_ID == 7\n{UNEVEN}#endif\n");
    assert_eq!(imported_text(&text, &["-D", "DS_ID=7", "-q"]).stdout, imported_text(UNEVEN, &["-q"]).stdout);
    let run = jurist_with_input(&["import", "-"], text.as_bytes());
    assert!(run.status == 2 && run.stderr.contains("add -D DS_ID=7"), "{}", run.stderr);
}

#[test]
fn options_that_do_not_go_together() {
    let name = file("pendulum.c");
    refused(&["import", &name, "--open"], "E-usage");
    refused(&["import", &file("servo.mat"), "--stored"], "E-usage");
    refused(&["import", &name, "--reading", "w"], "E-usage");
    refused(&["import", &name, "-D", "DS_ID"], "E-option-value");
    refused(&["import", &name, "--round", "up"], "E-option-value");
    refused(&["ship", "--from", &file("is-not-there.c")], "E-read");
    refused(&["ship", "--from", &file("servo.mat")], "E-utf8");
}
