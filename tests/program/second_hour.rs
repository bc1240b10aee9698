//! What a user meets after the first limit: words, places and helps that were found wanting when models of one's own were tried.

use crate::helpers::program::{jurist, jurist_with_input, refused, refused_model};

/// The text of the answer to a question about a model on standard input.
fn text(arguments: &[&str], model: &str) -> String {
    let run = jurist_with_input(arguments, model.as_bytes());
    assert!(run.status <= 1, "{arguments:?}: {}", run.stderr);
    run.stdout
}

/// Two loops, one inside of the other: without a word about the cut it is not clear where margins are taken.
const CASCADE: &str = "time = 'discrete'\nsample_time = 1e-3\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'outer'\ninput = 'r - y'\noutput = 'c'\ntransfer = '1/20'\n\
    [[block]]\nname = 'inner'\ninput = 'c - i'\noutput = 'u'\ntransfer = '1/2'\n\
    [[block]]\nname = 'fast'\ninput = 'u'\noutput = 'i'\ntransfer = '1/(z - 1)'\n\
    [[block]]\nname = 'slow'\ninput = 'i'\noutput = 'y'\ntransfer = '1/(z - 1)'\n";

#[test]
fn margins_and_diagrams_are_taken_where_require_says() {
    let required = format!("{CASCADE}[require]\nphase_margin = '30 deg'\nat = 'u'\n");
    assert!(text(&["margins", "-"], &required).contains("\ncut at the signal 'u'\n"));
    assert!(text(&["margins", "-", "--at", "i"], &required).contains("\ncut at the signal 'i'\n"));
    for command in ["bode", "nyquist"] {
        let run = jurist_with_input(&[command, "-", "-o", "-", "--format", "json"], required.as_bytes());
        let run = if run.status == 2 { jurist_with_input(&[command, "-"], required.as_bytes()) } else { run };
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert_eq!(jurist_with_input(&[command, "-"], CASCADE.as_bytes()).status, 2);
    }
    let nowhere = required.replace("at = 'u'", "at = 'w'");
    let run = jurist_with_input(&["margins", "-"], nowhere.as_bytes());
    assert!(run.stderr.contains("the loop has no signal 'w' to cut"), "{}", run.stderr);
}

#[test]
fn a_word_comes_before_the_code_that_ends_like_it_and_joined_causes_are_all_explained() {
    for (asked, begins) in [
        ("domain", "domain\n\nThe interval of values"),
        ("nominal", "nominal\n\nThe value of a parameter"),
        ("E-cut", "E-cut\n"),
        ("W-domain", "W-domain\n"),
        ("coq", "E-coq\n"),
        ("GM", "GM\n\nThe factor by which a gain may grow"),
        ("quasi-polynomial", "quasi-polynomial\n"),
    ] {
        let said = jurist(&["explain", asked]);
        assert!(said.status == 0 && said.stdout.starts_with(begins), "{asked}: {}", said.stdout);
    }
    let said = jurist(&["explain", "infinity+pole+domain"]).stdout;
    assert!(["infinity\n\n", "\n\npole\n\n", "\n\ndomain\n\n"].iter().all(|part| said.contains(part)), "{said}");
    refused(&["explain", "z=1+nonsense"], "E-unknown-code");
}

#[test]
fn keys_in_the_wrong_table_are_told_their_place() {
    let run = refused_model(b"time = 'discrete'\ncharacteristic = 'z - 1/2'\n", "E-unknown-key");
    assert!(run.stderr.contains("it belongs below a line '[loop]'"), "{}", run.stderr);
    assert!(!run.stderr.contains("E-missing"), "{}", run.stderr);
    let run = refused_model(b"time = 'discrete'\ntransfer = '1/z'\n[loop]\ninputs = ['r']\n", "E-unknown-key");
    assert!(run.stderr.contains("it belongs below a line '[[block]]'"), "{}", run.stderr);
    let run = jurist_with_input(&["check", "-"], b"[loop]\ntime = 'discrete'\ncharacteristic = 'z - 1/2'\n");
    assert!(run.stderr.contains("it belongs at the top of the file"), "{}", run.stderr);
}

#[test]
fn the_sample_time_is_asked_about_by_a_name() {
    let run = jurist_with_input(&["intervals", "-", "--param", "sample_time"], CASCADE.as_bytes());
    assert!(run.status == 2 && run.stderr.contains("sample_time = \"T\", and a constant T"), "{}", run.stderr);
}

#[test]
fn times_that_cannot_be_are_told_of_the_option() {
    for (option, value, message) in [
        ("--hold", "0", "the sample time of a hold is positive"),
        ("--hold", "1/3-1", "the sample time of a hold is positive"),
        ("--delay", "-1", "a dead time is not negative"),
    ] {
        let run = refused(&["K/(s+1)", &format!("{option}={value}")], "E-value");
        assert!(run.stderr.contains(message) && run.stderr.contains(option), "{}", run.stderr);
        assert!(!run.stderr.contains("model of the line"), "{}", run.stderr);
    }
    assert_eq!(jurist(&["K/(s+1)", "--delay", "0"]).status, 0);
}

#[test]
fn imaginary_units_are_parameters_and_the_line_says_so() {
    let run = jurist(&["verdict", "2*j/(s+1)", "--set", "j=1"]);
    assert!(run.status == 0 && run.stderr.contains("'j' is a parameter, not the imaginary unit"), "{}", run.stderr);
    assert!(!jurist(&["verdict", "2*j/(s+1)", "--set", "j=1", "-q"]).stderr.contains("imaginary"));
    assert!(!jurist(&["verdict", "2*k/(s+1)", "--set", "k=1"]).stderr.contains("imaginary"));
}
