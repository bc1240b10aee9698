//! The tests of `check.py` that are written in Python: certificates for all values, by `tests/for_all.py`.

use std::process::{Command, Stdio};

#[test]
#[ignore = "long: CI runs it"]
fn certificates_for_all_values_are_read_by_check_py_alone() {
    let there = Command::new("python3").args(["-c", "import tomllib"]).stderr(Stdio::null()).status();
    if !there.is_ok_and(|status| status.success()) {
        println!("skipped: python3 with tomllib is not there");
        return;
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/for_all.py");
    let output = Command::new("python3").arg(script).output().expect("python3 is there");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
