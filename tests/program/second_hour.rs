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
