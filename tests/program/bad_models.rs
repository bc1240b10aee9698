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
        let run = jurist_with_input(&["verdict", "-", "--timeout", "0.25"], model.as_bytes());
        let shown = &model[..model.len().min(120)];
        assert!((0..=3).contains(&run.status), "{shown}: {} {}", run.status, run.stderr);
        assert!(!run.stderr.contains("E-internal") && run.stderr.len() < 20_000, "{shown}: {}", run.stderr);
    }
}

/// What is said of a small loop in which one line is wrong in a way that people get it wrong.
#[test]
fn mistakes_of_beginners_have_remedies() {
    let good = "title = \"t\"\ntime = \"discrete\"\nsample_time = 0.0001\n\n[constants]\nT = 0.0001\nKi = 5\n\n[parameters]\nKp = { nominal = 2, min = 0 }\n\n\
        [loop]\ninputs = [\"r\"]\noutputs = [\"y\"]\n\n[[block]]\nname = \"PI\"\ninput = \"r - y\"\noutput = \"u\"\ntransfer = \"Kp + Ki*T/(z-1)\"\n\n\
        [[block]]\nname = \"plant\"\ninput = \"u\"\noutput = \"y\"\ntransfer = \"0.1/(z-0.9)\"\n";
    assert_eq!(jurist_with_input(&["analyze", "-"], good.as_bytes()).status, 0);
    // (what stands there, what is written in its place, code, the message, the remedy)
    let cases = [
        ("sample_time = 0.0001", "sample_time = 0.0001 s", "E-toml", "must be quoted", "a number has no unit"),
        ("T = 0.0001\nKi", "T = \"100 us\"\nKi", "E-syntax", "before the name 'us'", "100 us is 100e-6"),
        ("0.1/(z-0.9)", "0,1/(z-0,9)", "E-syntax", "','", "the decimal point is '.'"),
        ("nominal = 2,", "nominal = 2,5,", "E-toml", "inline table", "the decimal point is '.'"),
        ("\"0.1/(z-0.9)\"", "0.1/(z-0.9)", "E-toml", "float", "go in quotes: transfer = \"0.1/(z-0.9)\""),
        ("\"0.1/(z-0.9)\"", "\"0.1/(2z-0.9)\"", "E-number", "not a number", "'2*K', not '2K'"),
        ("0.1/(z-0.9)", "0.1/(z**2-0.9*z)", "E-syntax", "'**'", "powers are written with '^'"),
        ("Ki*T", "Ki T", "E-syntax", "an operator is missing", "'a*b', not 'a b'"),
        ("T = 0.0001\nKi", "T = 1\u{b7}10^-4\nKi", "E-toml", "must be quoted", "1e-4"),
        ("title = \"t\"", "% my model", "E-toml", "key", "comments begin with '#'"),
        ("title = \"t\"", "s = tf('s');", "E-toml", "not valid TOML", "this looks like MATLAB"),
        ("Ki = 5", "\u{3c9}_0 = 5", "E-toml", "key", "letters a-z"),
        ("\"r - y\"", "\u{201c}r - y\u{201d}", "E-toml", "must be quoted", "straight quotes"),
        ("\"r - y\"", "\"r - y", "E-toml", "string", "a string ends with the quote"),
        ("r - y", "r \u{2212} y", "E-syntax", "'\u{2212}'", "write the minus sign as '-'"),
        ("[[block]]\nname = \"plant\"", "[block]\nname = \"plant\"", "E-duplicate-key", "twice", "[[block]]"),
        ("sample_time = 0.0001", "sample_rate = 10000", "E-unknown-key", "'sample_rate'", "1 over the rate"),
        ("sample_time = 0.0001", "sample_time = -0.0001", "E-value", "must be positive", "-1/10000"),
        (
            "transfer = \"0.1/(z-0.9)\"",
            "num = \"[0.1]\"\nden = \"[1 -0.9]\"",
            "E-type",
            "list of coefficients",
            "den = [1,",
        ),
        ("0.1/(z-0.9)", "0.1/(s+1)", "E-unknown-name", "'s'", "a block in s has discretize = \"zoh\""),
        ("0.1/(z-0.9)", "e^(-Ki)/(z-0.9)", "E-exponent", "whole number", "is written 'exp(x)'"),
        ("name = \"plant\"", "delay = 2", "E-two-forms", "given twice", "a block of its own"),
        ("Kp + ", "kp + ", "E-unknown-name", "'kp'", "did you mean 'Kp'?"),
        ("outputs =", "output =", "E-unknown-key", "'output'", "did you mean 'outputs'?"),
        ("\"discrete\"", "\"discret\"", "E-value", "'discret'", "did you mean 'discrete'?"),
        ("Ki = 5", "Ki = nan", "E-number", "nan", "leave the key out"),
        ("0.1/(z-0.9)", "0.1/(z-0.9)^Ki", "E-exponent", "whole number", "fix the order"),
        ("output = \"u\"", "output = \"y\"", "E-two-drivers", "'y'", "driven by a block"),
    ];
    for (from, to, code, message, remedy) in cases {
        let model = good.replacen(from, to, 1);
        assert_ne!(model, good, "{from}");
        let run = refused_with_place(&model, code);
        assert!(run.stderr.contains(message) && run.stderr.contains(remedy), "{to}: {}", run.stderr);
    }
    let rows = refused_with_place("time = 'continuous'\n[loop]\nmatrix = ['0 1; -k -2']\n", "E-type");
    assert!(rows.stderr.contains("[[0, 1], [\"-k\", -2]]"), "{}", rows.stderr);
    let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(good.bytes().flat_map(|b| [b, 0])).collect();
    let run = refused_model(&utf16, "E-utf8");
    assert!(run.stderr.contains("UTF-16") && run.stderr.contains("Set-Content"), "{}", run.stderr);
    let run = jurist_with_input(&["verdict", "-"], good.replacen("r - y", "r + y", 1).as_bytes());
    assert!(run.stdout.contains("a real root beyond z = 1: is a sign of the feedback missing?"), "{}", run.stdout);
    // So with a plant behind a hold, where the numbers are transcendental.
    let held = good.replacen("\"0.1/(z-0.9)\"", "\"1/(s+1)\"\ndiscretize = { method = \"zoh\", T = 0.1 }", 1);
    let [wrong, right] = [("r - y", "r + y"), ("r - y", "r - y")]
        .map(|(from, to)| jurist_with_input(&["verdict", "-"], held.replacen(from, to, 1).as_bytes()));
    assert!(wrong.stdout.contains("a real root beyond z = 1: is a sign"), "{held}: {}{}", wrong.stdout, wrong.stderr);
    assert!(right.status == 0 && !right.stdout.contains("is a sign"), "{}", right.stdout);
}
