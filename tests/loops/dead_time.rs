//! The program about loops with dead time; their limits are in the corpus and in the library's own tests.

use crate::helpers::program::jurist;
use serde_json::Value;

#[test]
fn the_program_says_which_crossing_an_end_is() {
    let run = jurist(&["intervals", "examples/delayed-oscillator.toml", "--param", "tau", "--json"]);
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|e| panic!("{e}: {}", run.stderr));
    let end = &document["stable"][1]["lower"];
    assert_eq!((&end["kind"], &end["exact"]), (&Value::from("transcendental"), &Value::Null));
    assert_eq!((&end["over"]["k"], &end["over"]["direction"]), (&Value::from(1), &Value::from("-")));
    assert_eq!(end["over"]["omega2"]["enclosure"][0], "4/5");
    let verdict = jurist(&["verdict", "examples/delayed-oscillator.toml", "--set", "tau=3", "--json"]);
    let document: Value = serde_json::from_str(&verdict.stdout).unwrap();
    assert_eq!((&document["inside"], &document["outside"]), (&Value::Null, &Value::from(2)));
    assert!(jurist(&["analyze", "examples/dead-time-pi.toml"]).stdout.contains("7.0353318"));
    assert!(jurist(&["charpoly", "examples/dead-time-pi.toml"]).stdout.contains("exp(-theta*s)"));
}

#[test]
fn other_commands_say_that_they_do_not_know_dead_time_yet() {
    for arguments in [
        vec!["jury", "examples/dead-time-pi.toml", "--param", "K_c"],
        vec!["map", "examples/dead-time-pi.toml", "-x", "K_c", "-y", "theta"],
        vec!["simulate", "examples/dead-time-pi.toml"],
        vec!["verdict", "examples/dead-time-pi.toml", "--decay", "1/10"],
    ] {
        let run = jurist(&arguments);
        assert!(run.stderr.contains("E-dead-time"), "{arguments:?}: {}", run.stderr);
    }
}
