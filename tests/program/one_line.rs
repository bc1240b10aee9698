//! A loop in one line in place of a model file.

use crate::helpers::program::{json, jurist, jurist_with_input, refused};
use proptest::prelude::*;
use serde_json::Value;

/// The document, without its title.
fn document(text: &str) -> Value {
    let mut document: Value = serde_json::from_str(text).expect("the program writes JSON");
    document.as_object_mut().unwrap().remove("title");
    document
}

/// A line answers as the model file does that says the same.
fn same(command: &[&str], line: &[&str], model: &str) {
    let asked = [command, line, &["--json"]].concat();
    let of_line = jurist(&asked);
    let of_file = jurist_with_input(&[command, &["-", "--json"]].concat(), model.as_bytes());
    assert_eq!(of_line.status, of_file.status, "{asked:?}: {}{}", of_line.stderr, of_file.stderr);
    assert_eq!(document(&of_line.stdout), document(&of_file.stdout), "{asked:?}");
}

const BLOCK: &str =
    "[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'open loop'\ninput = 'r - y'\noutput = 'y'\n";

#[test]
fn a_line_answers_as_the_model_file_does() {
    let continuous =
        format!("time = 'continuous'\n[parameters]\nK = {{}}\n{BLOCK}transfer = 'K*10/(s*(s + 1)*(s + 2))'");
    for line in ["K*10/(s*(s + 1)*(s + 2))", "10K/(s(s+1)(s+2))"] {
        same(&["intervals", "--param", "K"], &[line], &continuous);
        same(&["margins", "--set", "K=1/2"], &[line], &continuous);
        same(&["margins", "--set", "K=2"], &[line], &continuous);
        same(&["verdict", "--set", "K=0.6"], &[line], &continuous);
        same(&["charpoly"], &[line], &continuous);
    }
    let polynomial = "time = 'discrete'\nloop.characteristic = 'z^2 + z + 1/2'";
    for line in ["z^2 + z + 1/2", "z^2+z+0.5=0", " z^2 + z + 1/2 = 0 "] {
        same(&["jury"], &[line], polynomial);
        same(&["verdict"], &[line], polynomial);
    }
    let delayed = format!("time = 'continuous'\n[parameters]\nK = {{}}\n{BLOCK}transfer = 'K/(s + 1)*exp(-s/2)'");
    same(&["intervals", "--param", "K"], &["K/(s+1)", "--delay", "1/2"], &delayed);
    let held = format!(
        "time = 'discrete'\nsample_time = 1\n[parameters]\nK = {{}}\n{}transfer = 'K/(s*(s + 1))'\ndiscretize = {{ method = 'zoh', T = 1, delay = 0.5 }}",
        BLOCK.replace("open loop", "plant")
    );
    same(&["intervals", "--param", "K"], &["K/(s(s+1))", "--hold", "1", "--delay", "0.5"], &held);
}

#[test]
fn a_line_alone_is_answered() {
    for (arguments, answer) in [
        (&["K*10/(s*(s+1)*(s+2))"][..], "0 < K < 0.6\n"),
        (&["K/(s*(s+1))", "--hold", "1"], "0 < K < 2.39221119118\n"),
        (&["K/(s*(s+1))", "--hold", "T", "--set", "T=1"], "0 < K < 2.39221119118\n"),
        (&["--", "-K/(s+1)"], "K < 1\n"),
        (&["K_p*(1+1/(T_i*s))/(s+1)^2", "--set", "T_i=1/4"], "0 < K_p < 1\n"),
        (&["K_p*(1+1/(T_i*s))/(s+1)^2", "--param", "T_i", "--set=K_p=2"], "T_i > 0.333333333333\n"),
        (&["K/(s+1)", "--set", "K=5"], "stable: the root is left"),
        (&["z^2 - 1/4 = 0"], "stable: all 2 roots are inside"),
        (&["norm", "1/(s + 1)", "r", "y"], "peak gain from r to y: 0.5 "),
        (&["r*y/(s + 1)", "--param", "r", "--set", "y=1"], "r > -1\n"),
    ] {
        let run = jurist(arguments);
        assert!(run.stdout.contains(answer), "{arguments:?}: {}{}", run.stdout, run.stderr);
        let title = arguments.iter().find(|a| !["--", "norm"].contains(a)).unwrap();
        assert!(run.stdout.starts_with(*title), "{arguments:?}: {}", run.stdout);
    }
    let several = refused(&["K_p*(1+1/(T_i*s))/(s+1)^2"], "E-usage");
    assert!(several.stderr.contains("'--param K_p', '--param T_i'"), "{}", several.stderr);
    let missing = refused(&["margins", "K/(s+1)"], "E-no-value");
    assert!(missing.stderr.contains("<line>:1:1") && missing.stderr.contains("--set K=..."), "{}", missing.stderr);
}

#[test]
fn a_file_wins_and_then_a_command() {
    assert!(jurist(&["./examples/drive.toml"]).stdout.contains("PWM DC motor"));
    refused(&["verdict", "no-such/model-s.toml"], "E-read");
    refused(&["verdict", "no-such"], "E-read");
    refused(&["verdict", "1/0"], "E-read");
    refused(&["verdict", "z"], "E-read");
    refused(&["verdict", ""], "E-read");
    refused(&["verdict", "examples/drive.toml", "--hold", "1"], "E-usage");
    refused(&["verdict", "--delay", "1"], "E-usage");
}

/// Each is refused, at this column of the line.
#[test]
fn mistakes_point_into_the_line() {
    for (line, code, column) in [
        ("2*K", "E-syntax", 1),
        ("s*z", "E-syntax", 3),
        ("K/(S + 1)", "E-syntax", 1),
        ("K/s(s + 1)", "E-syntax", 4),
        ("1/2z + 1", "E-syntax", 4),
        ("G(s)/(s + 1)", "E-syntax", 1),
        ("ln(2)/(s + 1)", "E-syntax", 1),
        ("K s^2", "E-syntax", 3),
        ("2 3*z", "E-syntax", 3),
        ("z \u{2212} 1/2", "E-syntax", 3),
        ("z = 1", "E-syntax", 3),
        ("z = 0 = 0", "E-syntax", 3),
        ("= 0", "E-syntax", 1),
        ("1 + K/(s(s + 1)) = 0", "E-not-polynomial", 7),
        ("K*exp(-s)", "E-syntax", 3),
        ("0x10*z", "E-number", 1),
        ("2e*z", "E-number", 1),
        ("1/0*s", "E-division-by-zero", 3),
        // Behind two operators that are not written.
        ("2K(s + 1)/((s + 2)(s - s))", "E-division-by-zero", 11),
        ("s^3/(s + 1)", "E-improper", 1),
        ("radius/(s + 1)", "E-reserved-name", 1),
        ("z^1001", "E-exponent", 3),
    ] {
        let run = refused(&["verdict", "--set", "K=1", "--", line], code);
        let place = format!("<line>:1:{column}\n");
        assert!(run.stderr.contains(&place), "{line}: {place}{}", run.stderr);
    }
    let deep = format!("{}z{}", "(".repeat(300), ")".repeat(300));
    refused(&["verdict", &deep], "E-too-deep");
    for (arguments, code) in [
        (&["K/(z - 1)", "--hold", "1"][..], "E-discretize"),
        (&["s^2 + K", "--hold", "1"], "E-discretize"),
        (&["K/(z - 1)", "--delay", "1"], "E-dead-time"),
        (&["s^2 + K", "--delay", "1"], "E-dead-time"),
        (&["K/(s + 1)", "--hold", "s"], "E-syntax"),
        (&["K/(s + 1)", "--hold", ""], "E-syntax"),
        (&["K/(s + 1)", "--hold", "-1"], "E-value"),
    ] {
        refused(arguments, code);
    }
}

#[test]
fn a_line_with_a_minus_is_not_taken_for_an_option_in_silence() {
    for line in ["-K/(s+1)", "-0.5*(s+3)/(s^2+s+1)"] {
        let run = refused(&["verdict", line, "--set", "K=1"], "E-usage");
        assert!(run.stderr.contains(&format!("'{line}' begins with a minus")), "{}", run.stderr);
        assert!(run.stderr.contains("after '--'"), "{}", run.stderr);
    }
    let run = refused(&["verdict", "-q", "--nothing", "K/(s+1)"], "E-usage");
    assert!(!run.stderr.contains("minus"), "{}", run.stderr);
}

/// The help said to write it behind '--', where it is no value.
#[test]
fn a_negative_value_is_written_behind_an_equals_sign() {
    let run = refused(&["verdict", "1/(s+1)^4", "--gain-margin", "-3"], "E-usage");
    assert!(run.stderr.contains("'--gain-margin=-3'"), "{}", run.stderr);
}

#[test]
fn a_certificate_of_a_line_is_checked_against_the_line() {
    let file = std::env::temp_dir().join(format!("jurist-line-{}.json", std::process::id()));
    let file = file.to_str().unwrap();
    let line = "10K/(s(s+1)(s+2))";
    assert_eq!(jurist(&[line, "--certificate", file]).status, 0);
    let verified = jurist(&["verify", line, file]);
    let other = jurist(&["verify", "11K/(s(s+1)(s+2))", file]);
    std::fs::remove_file(file).unwrap();
    assert!(verified.stdout.contains("stable exactly for 0 < K < 3/5"), "{}", verified.stdout);
    assert_eq!((verified.status, other.status), (0, 4));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Whatever stands in a line: a model, or an error about the line.
    #[test]
    fn any_line_is_read_or_refused(line in "[sz2K+*/^()=. e-]{0,24}", hold in "|1|T|1/2") {
        use jurist_engine::model::LoopLine;
        let hold = Some(hold.as_str()).filter(|hold| !hold.is_empty());
        if let Err(error) = LoopLine::read(&line, hold, None).and_then(|line| line.model()) {
            prop_assert!(!error.to_string().contains("E-internal"));
            prop_assert!(error.diagnostics().iter().all(|d| d.primary.is_some()), "{error}");
        }
    }

    /// A product without operators is the product with them.
    #[test]
    fn implied_products_are_products(factors in proptest::collection::vec("\\((s|K|K\\*s|s\\^2|s [+-] [1-9])\\)", 1..6)) {
        use jurist_engine::model::LoopLine;
        prop_assume!(factors.iter().any(|f| f.contains('s')));
        let form = |by: &str| {
            let line = LoopLine::read(&format!("2{by}{}", factors.join(by)), None, None).unwrap();
            line.model().unwrap().0.source().text.lines().last().map(str::to_owned)
        };
        prop_assert_eq!(form(""), form("*"));
    }
}

/// A sample time that is called `T` is not said to be equal to itself.
#[test]
fn a_title_says_no_name_twice() {
    let title =
        |hold: &str| json(&["verdict", "K/(s*(s+1))", "--hold", hold, "--set", "K=1", "--set", "T=1", "--json"]);
    assert_eq!(title("T")["title"], "K/(s*(s+1)) behind a hold");
    assert_eq!(title("2*T")["title"], "K/(s*(s+1)) behind a hold, T = 2*T");
}

/// A denominator inside of a fraction is a mode of its own. Where it keeps the loop from being stable, the answer names the root.
#[test]
fn a_root_that_stays_is_named() {
    for (line, root) in [
        ("K*(1+1/s)/(s+1/s)", "s = 0"),
        ("K*(1+1/s)*exp(-6/5*s)/(s+1+K*(1+1/s)*(1-exp(-s)))", "s = 0"),
        ("(z-1)*(z-K)", "z = 1"),
        ("(z+1)*(z-K)", "z = -1"),
    ] {
        let run = jurist(&[line, "--param", "K"]);
        assert!(run.stdout.contains(&format!("K: stable nowhere: a root stays at {root}\n")), "{}", run.stdout);
    }
    for line in ["s^2 + K", "z^2 - 2*K*z + 1"] {
        assert!(jurist(&[line, "--param", "K"]).stdout.contains("K: stable nowhere\n"), "{line}");
    }
}
