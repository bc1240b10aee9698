//! The command line itself: options, exit statuses, streams, errors.

use crate::helpers::program::{command, json, jurist, jurist_with_input, refused};
use crate::helpers::thorough::tried;
use serde_json::Value;
use std::process::Stdio;

#[test]
fn wrong_usage_is_status_2() {
    for (arguments, code) in [
        (&["--no-such-option"][..], "E-usage"),
        (&["intervals"], "E-usage"),
        (&["intervalls"], "E-usage"),
        (&["analyze", "a.toml", "b.toml"], "E-usage"),
        (&["intervals", "--param", "K_pwm", "--digits", "0"], "E-usage"),
        (&["intervals", "--param", "K_pwm", "--digits", "many"], "E-usage"),
        (&["intervals", "--param", "K_pwm", "--timeout", "-1"], "E-usage"),
        (&["verdict", "--radius", "1", "--decay", "1"], "E-usage"),
        (&["charpoly", "--format", "xml"], "E-usage"),
        (&["charpoly", "--format", "csv", "--json"], "E-usage"),
        (&["completions", "tcl"], "E-usage"),
        (&["verdict", "--set", "K_pwm"], "E-option-value"),
        (&["verdict", "--set", "=1"], "E-option-value"),
        (&["verdict", "--set", "K_pwm=1,5"], "E-number"),
        (&["verdict", "--set", "K_pwm=nan"], "E-number"),
        (&["verdict", "--set", "K_pwm=1/0"], "E-number"),
        (&["verdict", "--set", "K_pwm=1", "--set", "K_pwm=2"], "E-set-twice"),
        (&["verdict", "--set", "K_pmw=1"], "E-unknown-parameter"),
        (&["intervals", "--param", "K_pmw"], "E-unknown-parameter"),
        (&["jury", "--param", "K_pmw"], "E-unknown-parameter"),
        (&["charpoly", "--keep", "K_pmw"], "E-unknown-parameter"),
        (&["intervals", "--param", "K_pwm", "--domain", "K_pmw=0.."], "E-unknown-parameter"),
        (&["intervals", "--param", "K_pwm", "--domain", "K_pwm=1"], "E-option-value"),
        (&["intervals", "--param", "K_pwm", "--domain", "K_pwm=2..1"], "E-empty-domain"),
        (&["intervals", "--param", "K_pwm", "--set", "K_pwm=1"], "E-kept-and-set"),
        (&["charpoly", "--keep", "T", "--set", "T=1"], "E-kept-and-set"),
        (&["intervals", "--param", "decay"], "E-region"),
        (&["intervals", "--param", "radius", "--radius", "1/2"], "E-kept-and-set"),
        (&["verdict", "--decay", "1"], "E-region"),
        (&["verdict", "--radius", "0"], "E-region"),
        (&["charpoly", "--root-locus-form", "T"], "E-no-root-locus"),
        (&["charpoly", "--transfer", "speed", "omega"], "E-unknown-signal"),
        (&["charpoly", "-o", "q.svg"], "E-output-format"),
        (&["intervals", "--param", "T", "-o", "q.png"], "E-output-format"),
        (&["verdict", "no/such/file.toml"], "E-read"),
        (&["verdict", "."], "E-read"),
        (&["verdict", "-o", "no/such/folder/answer.json"], "E-write"),
        (&["explain", "E-no-such-code"], "E-unknown-code"),
    ] {
        refused(arguments, code);
    }
}

#[cfg(unix)]
#[test]
fn usage_names_the_program_and_the_command_that_was_meant() {
    use std::os::unix::process::CommandExt;
    let output = command(&["intervals"]).arg0("another-name").output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(!error.contains("another-name"), "{error}");
    let output = command(&["intervals", "-h"]).arg0("another-name").output().unwrap();
    assert!(String::from_utf8(output.stdout).unwrap().contains("Usage: jurist intervals"));
    let output = command(&["-h"]).arg0("another-name").output().unwrap();
    assert!(String::from_utf8(output.stdout).unwrap().contains("Usage: jurist [OPTIONS]"));
    let run = refused(&["--set", "K_pwm=1"], "E-usage");
    assert!(run.stderr.contains("'jurist analyze --set ...'") && run.stderr.contains("verdict"), "{}", run.stderr);
    let run = refused(&["--param", "K_pwm"], "E-usage");
    assert!(run.stderr.contains("'jurist intervals --param ...'"), "{}", run.stderr);
    let run = refused(&["model.toml"], "E-read");
    assert!(run.stderr.contains("model.toml"), "{}", run.stderr);
}

#[test]
fn errors_point_into_the_command_line_and_suggest() {
    let run = refused(&["verdict", "--set", "K_pmw=1"], "E-unknown-parameter");
    assert!(run.stderr.contains("jurist verdict --set K_pmw=1"), "{}", run.stderr);
    assert!(run.stderr.contains("                     ^^^^^"), "{}", run.stderr);
    assert!(run.stderr.contains("did you mean 'K_pwm'?"), "{}", run.stderr);
    let run = refused(&["verdict", "--set", "A=1", "--set", "B=x"], "E-number");
    assert!(!run.stderr.contains('\u{1b}'), "no colours away from a terminal");
}

#[test]
fn warnings_go_to_standard_error_unless_quiet() {
    let run = jurist(&["verdict", "--set", "K_pwm=-1"]);
    assert!(run.stderr.contains("warning[W-outside-domain]") && !run.stdout.contains("warning"));
    assert_eq!(jurist(&["verdict", "--set", "K_pwm=-1", "-q"]).stderr, "");
    assert_eq!(jurist(&["intervals", "--param", "T"]).stderr, "", "no progress away from a terminal");
    assert!(jurist(&["intervals", "--param", "T", "-v"]).stderr.contains("isolating"));
}

#[test]
fn no_time_is_undecided() {
    for arguments in [&["intervals", "--param", "K_pwm"][..], &["analyze"], &["verdict"], &["jury"], &["charpoly"], &[]]
    {
        let run = jurist(&[arguments, &["--timeout", "0"]].concat());
        // Questions about one parameter say for themselves that they are open.
        let open = run.stdout.is_empty() || run.stdout.contains("undecided, the budget ran out: time (0 s)");
        assert!(run.status == 3 && open, "{arguments:?}: {}", run.stdout);
        assert!(run.stderr.contains("undecided: the budget ran out: time (0 s)"), "{}", run.stderr);
    }
    let run = jurist(&["intervals", "--param", "K_pwm", "--timeout", "0", "--json"]);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((run.status, &document["stable"]), (3, &Value::Null));
    assert_eq!(document["undecided"]["budget"], "time (0 s)");
    assert!(document["undecided"]["reached"].is_string());
}

#[test]
fn a_reader_that_stops_reading_is_no_error() {
    for arguments in [&["charpoly"][..], &["--help"], &["completions", "bash"], &["jury", "--param", "K_pwm", "--json"]]
    {
        let mut child =
            command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program runs");
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]), "{arguments:?}");
    }
}

#[test]
fn a_model_comes_from_standard_input_or_a_file() {
    let model = std::fs::read("examples/drive.toml").unwrap();
    let from_input = jurist_with_input(&["intervals", "-", "--param", "T"], &model);
    assert_eq!(from_input.stdout, jurist(&["intervals", "--param", "T"]).stdout);
    assert_eq!(from_input.stdout, jurist(&["intervals", "examples/drive.toml", "--param", "T"]).stdout);
}

#[test]
fn the_files_ending_chooses_the_format() {
    let folder = std::env::temp_dir().join(format!("jurist-cli-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (ending, beginning) in [
        ("json", "{"),
        ("csv", "polynomial,"),
        ("tex", "% PWM"),
        ("m", "% PWM"),
        ("py", "# PWM"),
        ("rs", "// PWM"),
        ("txt", "Q(z)"),
    ] {
        let file = folder.join(format!("q.{ending}"));
        let run = jurist(&["charpoly", "-o", file.to_str().unwrap()]);
        assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
        assert!(std::fs::read_to_string(file).unwrap().starts_with(beginning), "{ending}");
    }
    let file = folder.join("t.json");
    assert_eq!(jurist(&["intervals", "--param", "T", "-o", file.to_str().unwrap()]).status, 0);
    let written: Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    assert_eq!(written, json(&["intervals", "--param", "T", "--json"]));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn colours_are_never_forced_on() {
    let output = command(&["verdict", "--set", "X=1"]).env("NO_COLOR", "1").output().unwrap();
    assert!(!output.stderr.contains(&0x1b));
    let output = command(&["--help"]).env("NO_COLOR", "1").output().unwrap();
    assert!(!output.stdout.contains(&0x1b));
}

#[test]
fn every_code_is_explained() {
    for code in tried(jurist_engine::error::Code::ALL.iter().map(|code| code.as_str()), 8) {
        let run = jurist(&["explain", code]);
        assert_eq!(run.status, 0);
        assert!(run.stdout.starts_with(code) && run.stdout.len() > code.len() + 20, "{code}");
    }
    assert!(jurist(&["explain"]).stdout.contains("E-usage"));
    assert!(refused(&["explain", "E-unknown-nam"], "E-unknown-code").stderr.contains("'E-unknown-name'"));
}

#[test]
fn every_shell_has_completions() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let run = jurist(&["completions", shell]);
        assert!(run.status == 0 && run.stdout.contains("intervals"), "{shell}");
    }
}

#[test]
fn relative_stability_and_freed_constants() {
    let radius = json(&["intervals", "--param", "radius", "--json"]);
    assert_eq!(radius["domain"]["lower"], "0");
    let end = &radius["stable"][0]["lower"];
    assert!(end["decimal"].as_str().unwrap().starts_with("0.99970010495"));
    // The verdict on either side of the exact smallest radius.
    assert_eq!(jurist(&["verdict", "--radius", "0.99970010496"]).status, 0);
    assert_eq!(jurist(&["verdict", "--radius", "0.99970010494"]).status, 1);
    let freed = json(&["intervals", "--param", "L_a", "--json"]);
    assert_eq!(freed["nominal"], "23/500");
    // An inductance is positive, unless negative ones are asked for.
    assert_eq!((&freed["domain"]["lower"], &freed["domain"]["upper"]), (&Value::from("0"), &Value::Null));
    let all = json(&["intervals", "--param", "L_a", "--domain", "L_a=..", "--json"]);
    assert_eq!(all["domain"]["lower"], Value::Null);
    assert_eq!(freed["stable"].as_array().unwrap().len(), 1);
}

#[test]
fn gain_margins() {
    for (plant, factor, decibels) in
        [("1/2/z", "2", 6.0206), ("1/(z - 1/2)", "3/2", 3.5218), ("0.05/(z - 1)", "40", 32.0412)]
    {
        let model = format!(
            "time = 'discrete'\nparameters.K = {{ nominal = 1, min = 0 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
             [[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*({plant})'\n"
        );
        let run = jurist_with_input(&["intervals", "-", "--param", "K", "--json"], model.as_bytes());
        let answer: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{}", run.stderr));
        let end = &answer["stable"][0]["upper"];
        assert_eq!(end["margin_factor"], factor, "{plant}");
        assert!((end["margin_db"].as_f64().unwrap() - decibels).abs() < 1e-4);
    }
}

/// Every command and option, as the help shows them.
#[test]
fn help() {
    let mut all = String::new();
    for name in ["", "analyze", "intervals", "verdict", "charpoly", "jury", "explain", "completions"] {
        let arguments: Vec<&str> = if name.is_empty() { vec!["-h"] } else { vec![name, "-h"] };
        let run = jurist(&arguments);
        assert_eq!(run.status, 0);
        all.push_str(&format!("$ jurist {}\n{}\n", arguments.join(" "), run.stdout));
    }
    insta::assert_snapshot!("help", all);
}

const BLOCK: &str =
    "[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\n";

/// The answer in words to a question about a model.
fn text(arguments: &[&str], model: &str) -> String {
    let run = jurist_with_input(arguments, model.as_bytes());
    assert!(run.status <= 1, "{}", run.stderr);
    run.stdout
}

#[test]
fn an_undefined_point_says_what_is_undefined() {
    let model = format!("time = 'discrete'\nparameters = {{ p = 0, q = 0 }}\n{BLOCK}transfer = '2*z/(q*p*z + 1)'\n");
    let order = "undefined: the leading coefficient of the denominator of 'plant' is zero: the block loses its order";
    assert!(text(&["verdict", "-"], &model).contains(order));
    let nowhere = text(&["intervals", "-", "--param", "p"], &model);
    assert!(nowhere.contains("stable nowhere, undefined for every p"), "{nowhere}");
    let pole = text(&["intervals", "-", "--param", "p", "--set", "q=1"], &model);
    assert!(pole.contains("pole: the model is undefined here"), "{pole}");
    let run = jurist_with_input(&["intervals", "-", "--param", "p", "--set", "q=1", "--json"], model.as_bytes());
    assert!(run.stdout.contains("\"cause\": \"pole\""), "{}", run.stdout);
    assert!(jurist(&["intervals", "--help"]).stdout.contains("pole: the model is undefined"));
    let divided = "time = 'discrete'\nparameters.p = 0\nloop.characteristic = 'z - 1/p'\n";
    assert!(text(&["verdict", "-"], divided).contains("undefined: division by zero"));
    let looped = format!("time = 'discrete'\nparameters.p = -1\n{BLOCK}transfer = 'p + 1/z'\n");
    assert!(text(&["verdict", "-"], &looped).contains("undefined: an algebraic loop that is not well posed"));
}

#[test]
fn one_root_is_spoken_of_as_one() {
    let model = "time = 'continuous'\nparameters.p = {}\nloop.characteristic = 's + p'\n";
    let at = |value: &str| text(&["verdict", "-", "--set", value], model);
    assert!(at("p=1").contains("stable: the root is left of the imaginary axis"));
    assert!(at("p=-1").contains("unstable: 0 roots left of the imaginary axis, 0 on it, 1 right of it"));
    let analysis = text(&["analyze", "-"], model);
    assert!(analysis.contains("no verdict: parameter p has no nominal value"), "{analysis}");
}

#[test]
fn margins_are_printed_where_they_mean_something() {
    let period = jurist(&["intervals", "--param", "T"]).stdout;
    assert!(period.contains("4.969397 x nominal 0.0001") && !period.contains("dB"), "{period}");
    assert!(!period.contains(" 0 x nominal"), "{period}");
    assert!(jurist(&["intervals", "--param", "K_pwm"]).stdout.contains("(13.99425 dB)"));
}

/// Stable between two numbers that agree in sixteen digits, and beside one of them.
#[test]
fn ends_that_are_close_have_digits_that_tell_them_apart() {
    let model = "time = 'continuous'\nparameters.p = {}\n\
        loop.characteristic = 's - (p^2 - 2)*(p - 1.4142135623)*(p - 1.414213562373095)'\n";
    let narrow = ["intervals", "-", "--param", "p", "--domain", "p=1.41421356236..2"];
    let found = text(&narrow, model);
    assert!(found.contains("    1.414213562373095 < p < 1.41421356237309505\n"), "{found}");
    assert!(found.contains("\n    1.41421356237309505"), "{found}");
    // JSON has the digits that were asked for.
    let run = jurist_with_input(&[&narrow[..], &["--json"]].concat(), model.as_bytes());
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(document["stable"][0]["upper"]["decimal"], "1.41421356237");
}

/// Three ends: the first two differ in the 14th digit, the last two in the 20th.
#[test]
fn close_ends_stay_in_order() {
    let model = "time = 'continuous'\nparameters.p = {}\n\
        loop.characteristic = 's - (p - 1.4142135623730)*(p - 1.4142135623731000002)*(p - 1.4142135623731)'\n";
    let found = text(&["intervals", "-", "--param", "p"], model);
    assert!(found.contains("    p < 1.414213562373\n    1.4142135623731 < p < 1.4142135623731000002\n"), "{found}");
}

#[test]
fn verify_speaks_of_its_own_files_and_status() {
    let run = refused(&["verify", "examples/drive.toml", "no-such-file"], "E-read");
    assert!(run.stderr.contains("no certificate can be read") && !run.stderr.contains("left out"), "{}", run.stderr);
    let run = refused(&["verify", "no-such-file", "no-such-file"], "E-read");
    assert!(run.stderr.contains("no model can be read") && !run.stderr.contains("left out"), "{}", run.stderr);
    let help = jurist(&["verify", "--help"]).stdout;
    assert!(help.contains("exit status 4") && !help.contains("exit status 3"), "{help}");
    assert!(jurist(&["verdict", "--help"]).stdout.contains("exit status 3"));
}

#[test]
fn conditions_name_their_rows_and_sides() {
    let jury = json(&["jury", "--json"]);
    let first = &jury["conditions"][2];
    assert_eq!((&first["name"], &first["relation"]), (&"|a_0| < a_6".into(), &"|left| < |right|".into()));
    assert_eq!((&first["left"], &first["right"]), (&jury["rows"][0]["entries"][0], &jury["rows"][0]["entries"][6]));
    assert_eq!((&first["row"], &jury["conditions"][0]["row"]), (&"a".into(), &Value::Null));
    let second = &jury["conditions"][3];
    assert_eq!((&second["relation"], &second["row"]), (&"|left| > |right|".into(), &jury["rows"][1]["name"]));
    assert_eq!(second["left"], jury["rows"][1]["entries"][0]);
    let model = "time = 'continuous'\nparameters.p = 3\nloop.characteristic = 's^3 + p*s^2 + 2*s + 1'\n";
    let run = jurist_with_input(&["jury", "-", "--json"], model.as_bytes());
    let routh: Value = serde_json::from_str(&run.stdout).unwrap();
    for (k, condition) in routh["conditions"].as_array().unwrap().iter().enumerate() {
        let row = &routh["rows"][k + 1];
        assert_eq!((&condition["row"], &condition["left"]), (&row["name"], &row["entries"][0]));
    }
    assert!(text(&["jury", "-"], model).contains("H_k is the first entry r_k,0 of row k"));
}

#[test]
fn refusals_say_what_to_do() {
    let refused = |arguments: &[&str]| {
        let run = jurist(arguments);
        assert_eq!(run.status, 2, "{arguments:?}");
        run.stderr
    };
    assert!(refused(&["-q", "verdict"]).contains("options stand behind their command: 'jurist verdict --quiet ...'"));
    // A box alone was what had been asked.
    let tolerance = refused(&["tolerance", "--only", "--phase-margin", "45deg", "--tol", "K_pwm=10%"]);
    assert!(tolerance.contains("leave out '--only'") && !tolerance.contains("ask for the box alone"), "{tolerance}");
    for command in ["nyquist", "bode", "margins"] {
        let found = refused(&[command, "2*s + 1"]);
        assert!(found.contains("has no parameter that is a gain: write one"), "{command}: {found}");
    }
}

/// A refusal of the table whose words come with the question was printed as it is there: "the dead time of '{name}'".
#[test]
fn no_message_has_a_word_in_braces() {
    let model = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = '1/2', min = '1/10', max = 10 }\n\
         W = { nominal = 1, min = '1/2', max = 3 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'W*(r - y)'\n\
         output = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = { method = 'zoh', delay = '1/3' }\n";
    for arguments in [
        &["charpoly", "-"][..],
        &["map", "-", "-x", "T", "-y", "W", "--phase-margin", "40deg"],
        &["map", "-", "-x", "T", "-y", "W", "--damping", "0.1", "--explain"],
        &["jury", "-", "--param", "T", "--explain"],
        &["tolerance", "-", "--tol", "T=10%", "--explain"],
    ] {
        let run = jurist_with_input(arguments, model.as_bytes());
        let said = format!("{}{}", run.stdout, run.stderr);
        assert_eq!(run.status, 2, "{arguments:?}: {said}");
        assert!(!said.contains("{name}") && said.contains("is no fixed number of samples"), "{arguments:?}: {said}");
    }
}

#[test]
fn the_readme_has_no_marks_of_a_merge() {
    let readme = std::fs::read_to_string("README.md").unwrap();
    assert!(readme.lines().all(|l| !["<<<<<<<", "=======", ">>>>>>>"].iter().any(|mark| l.starts_with(mark))));
}
