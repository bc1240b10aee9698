//! Models that are wrong: an error with file, line, column, the source line and a caret, status 2,
//! never a panic.

use crate::helpers::program::{Run, jurist_with_input, refused_model};

/// A model with this characteristic polynomial.
fn with_polynomial(text: &str) -> String {
    format!("time = 'discrete'\nparameters.K = {{ nominal = 1 }}\nloop.characteristic = '{text}'\n")
}

/// Refused with a place, a caret and the source line.
fn refused_with_place(model: &str, code: &str) -> Run {
    let run = refused_model(model.as_bytes(), code);
    assert!(run.stderr.contains("--> <stdin>:") && run.stderr.contains('^'), "{code}: {}", run.stderr);
    run
}

#[test]
fn names() {
    let run = refused_with_place(&with_polynomial("z - k"), "E-unknown-name");
    assert!(run.stderr.contains("<stdin>:3:") && run.stderr.contains("did you mean 'K'?"), "{}", run.stderr);
    refused_with_place(
        "time = 'discrete'\n[constants]\na = 'b'\nb = 'a'\n[loop]\ncharacteristic = 'z - a'\n",
        "E-cycle",
    );
    refused_with_place("time = 'discrete'\n[loop]\ncharacterstic = 'z'\n", "E-unknown-key");
}

#[test]
fn arithmetic() {
    refused_with_place(&with_polynomial("z - 1/(K - K)"), "E-division-by-zero");
    refused_with_place(&with_polynomial("z^(1/2)"), "E-exponent");
    refused_with_place(&with_polynomial("z^K"), "E-exponent");
    refused_with_place(&with_polynomial("z^99999999999999999999"), "E-exponent");
    refused_with_place(&with_polynomial("z + * 2"), "E-syntax");
    refused_with_place(&with_polynomial("2z"), "E-number");
}

#[test]
fn shapes() {
    let head = "time = 'discrete'\n[loop]\n";
    refused_with_place(&format!("{head}matrix = [[1, 2, 3], [4, 5, 6]]\n"), "E-size");
    refused_with_place(&format!("{head}matrix = [[1, 2], [3]]\n"), "E-size");
    refused_with_place(&format!("{head}A = [[1, 0], [0, 1]]\nB = [[1]]\nC = [[1, 0]]\nK = [[1]]\n"), "E-size");
}

#[test]
fn domains() {
    let model = "time = 'discrete'\nparameters.K = { min = 2, max = 1 }\nloop.characteristic = 'z - K'\n";
    refused_with_place(model, "E-empty-domain");
}

#[test]
fn texts() {
    refused_model(b"time = 'discrete'\nloop.characteristic = 'z \xff'\n", "E-utf8");
    refused_model(b"\xff\xfe\x00", "E-utf8");
    refused_with_place("time = 'discrete\n", "E-toml");
    refused_with_place("[loop\n", "E-toml");
    refused_model(b"", "E-missing");
}

#[test]
fn several_mistakes_are_reported_in_one_run() {
    let model = "time = 'discrete'\n[parameters]\nK_pwm = {}\nT = {}\n[loop]\n\
                 characteristic = 'z^2 + K_pmw*z + T1 + Kpwm'\n";
    let run = refused_with_place(model, "E-unknown-name");
    assert_eq!(run.stderr.matches("error[E-unknown-name]").count(), 3, "{}", run.stderr);
}

#[test]
fn monsters_are_answered() {
    let digits = "7".repeat(1_000_000);
    let nested = format!("{}z{}", "(".repeat(100_000), ")".repeat(100_000));
    let arrays = format!("time = 'discrete'\nloop.matrix = {}{}\n", "[".repeat(100_000), "]".repeat(100_000));
    let power = "((z^1000)^1000)^1000";
    let expansion = "(z + K + 1)^9999 - (z - K)^9999";
    let models = [
        with_polynomial(&format!("z - {digits}")),
        with_polynomial(&nested),
        arrays,
        with_polynomial(power),
        with_polynomial(expansion),
        with_polynomial("z - 1e999999999999"),
        with_polynomial(&format!("z - 1{}", "*1".repeat(200_000))),
    ];
    for model in models {
        let run = jurist_with_input(&["verdict", "-", "--timeout", "1"], model.as_bytes());
        let shown = &model[..model.len().min(120)];
        assert!((0..=3).contains(&run.status), "{shown}: {} {}", run.status, run.stderr);
        assert!(!run.stderr.contains("E-internal") && run.stderr.len() < 20_000, "{shown}: {}", run.stderr);
    }
}
