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
    let (line, sampled) = ("1/(s*(s + 1))", "1/(4*z*(z - 1))");
    for (line, option, value, what) in [
        (sampled, "--damping", "1/10", "no certificate of 'damping >= 1/10'"),
        (line, "--disk-margin", "2", "disk margins below 2"),
        (line, "--disk-margin", "3", "no certificate of 'disk_margin >= 3'"),
    ] {
        let said = refused(&["verdict", line, option, value]);
        assert!(said.contains("E-no-certificate") && said.contains(what), "{option}: {said}");
        assert!(!said.contains("behind a hold"), "{option}: {said}");
    }
}

#[test]
fn a_box_around_a_point_that_misses_a_requirement_is_not_certified_but_the_point_is() {
    let line = "K/(s*(s + 1))";
    let arguments = ["tolerance", line, "--set", "K=2", "--tol", "K=10%", "--phase-margin", "60 deg"];
    let said = refused(&arguments);
    assert!(said.contains("the nominal point itself misses") && said.contains("verdict --certificate"), "{said}");
}
