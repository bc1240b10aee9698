//! Certificates that there are none of: the words say which requirement the checkers do not know, and what to ask instead.

use crate::helpers::program::jurist;

fn refused(arguments: &[&str]) -> String {
    let file = std::env::temp_dir().join(format!("jurist-refused-{}.cert", std::process::id()));
    let file = file.to_str().expect("a path");
    let run = jurist(&[arguments, &["--certificate", file, "-q"]].concat());
    assert_eq!(run.status, 2, "{arguments:?}: {}", run.stdout);
    assert!(!std::path::Path::new(file).exists(), "{arguments:?}");
    run.stderr
}

#[test]
fn a_requirement_that_is_no_set_of_factors_is_named() {
    let line = "1/(s*(s + 1))";
    for (option, value, what) in [
        ("--delay-margin", "1/10", "no certificate of 'delay_margin >= 1/10'"),
        ("--damping", "1/10", "no certificate of 'damping >= 1/10'"),
        ("--disk-margin", "2", "disk margins below 2"),
        ("--disk-margin", "3", "no certificate of 'disk_margin >= 3'"),
    ] {
        let said = refused(&["verdict", line, option, value]);
        assert!(said.contains("E-no-certificate") && said.contains(what), "{option}: {said}");
        assert!(!said.contains("behind a hold"), "{option}: {said}");
    }
}

/// What is said of points is said of the values of a parameter, of maps and of tolerances.
#[test]
fn a_delay_margin_over_values_has_no_certificate() {
    let line = "K*L/s";
    let box_of = ["-x", "K=1..2", "-y", "L=1/4..1/2", "--undecided", "0.5"];
    let tolerances = ["--set", "K=1", "--set", "L=1", "--tol", "K=10%", "--tol", "L=10%"];
    let (one, map) = (["intervals", line, "--param", "K", "--set", "L=1"], [&["map", line], &box_of[..]].concat());
    for arguments in [&one[..], &map, &[&["tolerance", line], &tolerances[..]].concat()] {
        let said = refused(&[arguments, &["--delay-margin", "1"]].concat());
        assert!(said.contains("no certificate of 'delay_margin >= 1'"), "{arguments:?}: {said}");
    }
}

#[test]
fn a_box_around_a_point_that_misses_a_requirement_is_not_certified_but_the_point_is() {
    let line = "K/(s*(s + 1))";
    let arguments = ["tolerance", line, "--set", "K=2", "--tol", "K=10%", "--phase-margin", "60 deg"];
    let said = refused(&arguments);
    assert!(said.contains("the nominal point itself misses") && said.contains("verdict --certificate"), "{said}");
}

/// `K L/s` bears `pi/(2 K L)`: a second for all `L` up to 2 as long as `K <= pi/4`.
#[test]
#[ignore = "long: CI runs it"]
fn a_delay_margin_for_all_values_has_no_certificate() {
    let file = std::env::temp_dir().join(format!("jurist-for-all-{}.cert", std::process::id()));
    let arguments = ["intervals", "K*L/s", "--param", "K", "--domain", "K=1/2..1", "--for-all", "L=1..2"];
    let certificate = ["--delay-margin", "1", "--certificate", file.to_str().expect("a path"), "-q"];
    let run = jurist(&[&arguments[..], &certificate].concat());
    assert!(run.status == 2 && run.stdout.contains("0.5 <= K <= 0.785398"), "{} {}", run.stdout, run.stderr);
    assert!(run.stderr.contains("no certificate of 'delay_margin >= 1'") && !file.exists(), "{}", run.stderr);
}
