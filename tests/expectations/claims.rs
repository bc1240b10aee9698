//! `jurist test`: each kind of claim, held and not held, on a loop whose limits are known by hand.

use crate::helpers::folder::{Folder, lines_of};
use crate::helpers::schema::fits;
use serde_json::Value;

/// z - 1 + K: stable for 0 < K < 2, margin of the gain 2/K; in the series it is c K.
const LOOP: &str = "time = 'discrete'\nsample_time = 1\n[constants]\nc = { value = 1, tolerance = '50%' }\n[parameters]\nK = { nominal = 0.5, min = -20, max = 20 }\n\
    [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = 'c*K/(z - 1)'\n";

fn lines(expectations: &str) -> (i32, Vec<(String, String, Value)>) {
    let folder = Folder::new(&[("loop.toml", &format!("{LOOP}{expectations}")), ("cases.csv", "c\n1\n3\n2\n")]);
    let run = folder.jurist(&["test", "loop.toml", "--json"]);
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{}", run.stderr));
    fits(&document).unwrap();
    let tests = document["files"][0]["tests"].as_array().unwrap().clone();
    let text = |test: &Value, key: &str| test[key].as_str().unwrap().to_owned();
    (run.status, tests.iter().map(|t| (text(t, "status"), text(t, "text"), t["margin_percent"].clone())).collect())
}

#[test]
fn each_claim_is_held_or_not_with_what_is_left() {
    for (claim, status, found, margin) in [
        ("verdict = 'stable'", "passed", "stable: the root is inside the unit circle", None),
        ("verdict = 'marginal'", "failed", "stable: the root is inside the unit circle", None),
        ("verdict = 'marginal'\nset = { K = 2 }", "passed", "marginal", None),
        ("verdict = 'unstable'\nset = { K = 3 }", "passed", "unstable", None),
        ("verdict = 'unstable'\nset = { K = 30 }", "passed", "; outside of its domain: K", None),
        // The end is 2, half of it is left; at 1.9 it is 5 % of 2.
        ("param = 'K'\nstable = [0.1, 1]", "passed", "for 0 < K < 2", Some(50.0)),
        ("param = 'K'\nstable = [0.1, 1.9]", "passed", "for 0 < K < 2", Some(5.0)),
        ("param = 'K'\nstable = [0.1, 2]", "failed", "for 0 < K < 2", Some(0.0)),
        ("param = 'K'\nstable = [0, 1]", "failed", "for 0 < K < 2", Some(0.0)),
        ("param = 'K'\nstable = [0.5, 4]", "failed", "for 0 < K < 2", Some(-50.0)),
        ("param = 'K'\nstable = ['-inf', 1]", "failed", "for 0 < K < 2", None),
        ("param = 'K'\nstable = [0.1, 'inf']", "failed", "for 0 < K < 2", None),
        ("param = 'c'\nstable = [1, 3]", "passed", "for 0 < c < 4", Some(25.0)),
        ("param = 'K'\nset = { c = 4 }\nstable = [0.1, 1]", "failed", "for 0 < K < 0.5", Some(-50.0)),
        // Two intervals, and none about the nominal value: the nearest end.
        ("param = 'c'\nset = { K = 2 }\nupper = 1\nwithin = '1%'", "passed", "is 1", Some(100.0)),
        // Of 1 % of 2 a half is used.
        ("param = 'K'\nupper = 2.02\nwithin = 0.04", "passed", "is 2 (z=-1), moved by", Some(50.0)),
        ("param = 'K'\nupper = 2.02\nwithin = 0.02", "passed", "is 2", Some(0.0)),
        ("param = 'K'\nupper = 2.02\nwithin = 0.01", "failed", "is 2", Some(-100.0)),
        ("param = 'K'\nupper = 1.99\nwithin = '1%'", "passed", "is 2", None),
        ("param = 'K'\nupper = 1.9\nwithin = '1%'", "failed", "is 2", None),
        ("param = 'K'\nlower = 0\nwithin = 0.001", "passed", "is 0 (z=1)", Some(100.0)),
        ("param = 'K'\nlower = '-inf'\nwithin = '1%'", "failed", "is 0", None),
        ("param = 'c'\nupper = 'inf'\nwithin = '1%'", "failed", "is 4", None),
        ("require = { gain_margin = 2 }", "passed", "is 4", Some(100.0)),
        ("require = { gain_margin = 4 }", "failed", "is 4", Some(0.0)),
        ("require = { gain_margin = 5 }", "failed", "is 4", Some(-20.0)),
        ("require = { gain_margin = '12 dB' }", "passed", "is 4", None),
        ("require = { damping = 0.3 }", "passed", "met", None),
        ("require = { radius = 0.6 }", "passed", "met", None),
        ("require = { radius = 0.4 }", "failed", "not met", None),
        // The box reaches c = 4 at six times 50 %, and c = 0 at twice.
        ("tolerance = 1", "passed", "they can grow by", None),
        ("tolerance = 1.9", "passed", "they can grow by", None),
        ("tolerance = 1.9999999", "passed", "they can grow by", None),
        ("tolerance = 2", "failed", "they can grow by", None),
        ("tolerance = 2.1", "failed", "they can grow by", None),
        // Row 2 has c = 3.
        ("cases = 'cases.csv'\nverdict = 'stable'", "passed", "the worst of 3 operating points is row", None),
        (
            "cases = 'cases.csv'\nparam = 'K'\nstable = [0.1, 0.5]",
            "passed",
            "row 2 (c = 3): stable for 0 < K < 0.666667",
            Some(25.0),
        ),
        (
            "cases = 'cases.csv'\nset = { K = 0.8 }\nverdict = 'stable'",
            "failed",
            "not so at 1 of 3 operating points, the worst is row 2",
            None,
        ),
        ("cases = 'cases.csv'\nrequire = { gain_margin = 1.3 }", "passed", "row 2 (c = 3): is 1.33333", None),
    ] {
        let (exit, lines) = lines(&format!("[[expect]]\n{claim}\n"));
        let [(got, text, left)] = lines.as_slice() else { panic!("{claim}: {lines:?}") };
        assert_eq!((got.as_str(), exit), (status, i32::from(status == "failed")), "{claim}: {text}");
        assert!(text.contains(found), "{claim}: {text}");
        if let Some(margin) = margin {
            let left = left.as_f64().unwrap_or_else(|| panic!("{claim}: no margin"));
            assert!((left - margin).abs() < 1e-3, "{claim}: {left}");
        }
    }
}

#[test]
fn without_expectations_requirements_or_the_nominal_point_are_tried() {
    let required = LOOP.to_owned() + "[require]\ngain_margin = 5\n";
    let folder = Folder::new(&[("a.toml", LOOP), ("b.toml", &required)]);
    let run = folder.jurist(&["test", "a.toml"]);
    assert_eq!(
        run.stdout,
        "a.toml\n  passed    verdict stable: stable: the root is inside the unit circle\n1 passed, 0 failed\n"
    );
    let run = folder.jurist(&["test", "b.toml"]);
    assert_eq!(run.status, 1);
    assert_eq!(
        run.stdout,
        "b.toml\n  FAILED    gain_margin > 5: is 4 (12.04 dB), 20 % too little (line 15)\n0 passed, 1 failed\n"
    );
}

#[test]
fn folders_are_searched_and_files_of_expectations_speak_of_models_elsewhere() {
    let tests = "model = 'plants/loop.toml'\n[[expect]]\nname = 'one'\nverdict = 'stable'\n[[expect]]\nparam = 'K'\nstable = [1, 3]\n";
    let folder = Folder::new(&[
        ("plants/loop.toml", LOOP),
        ("jurist-tests.toml", tests),
        ("other/Cargo.toml", "[package]\nname = 'x'\n"),
        (".hidden/loop.toml", "[[expect]]\n"),
    ]);
    let run = folder.jurist(&["test", ".", "--junit", "out.xml", "--sarif", "out.sarif", "--only-bad"]);
    assert_eq!(run.status, 1, "{}", run.stderr);
    let line = "  FAILED    stable for 1 <= K <= 3: stable for 0 < K < 2, 33.3 % too little (line 7)\n";
    assert_eq!(lines_of(&run), format!("jurist-tests.toml\n{line}1 passed, 1 failed\n"));
    let xml = folder.read("out.xml");
    assert!(xml.contains("tests=\"2\" failures=\"1\" errors=\"0\"") && xml.contains("(line 7)"), "{xml}");
    let log: Value = serde_json::from_str(&folder.read("out.sarif")).unwrap();
    let results = log["runs"][0]["results"].as_array().unwrap();
    let region = &results[0]["locations"][0]["physicalLocation"];
    assert_eq!((results.len(), &results[0]["ruleId"]), (1, &"E-expect".into()));
    assert_eq!(
        (&region["artifactLocation"]["uri"], &region["region"]["startLine"]),
        (&"jurist-tests.toml".into(), &7.into())
    );
}

#[test]
fn no_file_that_is_read_is_written_over() {
    let entry = "[[expect]]\nverdict = 'stable'\ncases = 'cases.csv'\n";
    let model = format!("{}{entry}", LOOP.replace("c = {", "d = { from = 'g.h#D' }\nc = {").replace("c*K", "c*d*K"));
    let tests = "model = 'loop.toml'\n[[expect]]\nverdict = 'stable'\n";
    let files = [
        ("loop.toml", model.as_str()),
        ("g.h", "#define D 1\n"),
        ("cases.csv", "c\n1\n"),
        ("jurist-tests.toml", tests),
    ];
    let folder = Folder::new(&files);
    assert_eq!(folder.jurist(&["lock", "loop.toml", "-q"]).status, 0);
    for output in ["loop.toml", "g.h", "cases.csv", "jurist-tests.toml", "loop.lock.json"] {
        for option in ["--junit", "--sarif", "-o"] {
            let run = folder.jurist(&["test", ".", option, output]);
            assert!(run.status == 2 && run.stderr.contains("E-output-name"), "{option} {output}: {}", run.stderr);
        }
    }
    for arguments in [
        &["lock", "loop.toml", "-o", "g.h"][..],
        &["check", "loop.toml", "--resolved", "g.h"],
        &["lock", "loop.toml", "-o", "x.toml"],
    ] {
        assert_eq!(folder.jurist(arguments).status, 2, "{arguments:?}");
    }
    for (name, text) in files {
        assert_eq!(folder.read(name), text);
    }
}

/// However the entries are written, and whatever else is in the folder.
#[test]
fn no_expectation_of_a_folder_is_passed_over() {
    let folder = Folder::new(&[
        ("a.toml", &format!("{LOOP}[[ expect ]]\nverdict = 'stable'\n")),
        ("b.toml", &format!("expect = [{{ verdict = 'stable' }}]\n{LOOP}")),
        ("c.toml", &format!("require = {{ gain_margin = 2 }}\n{LOOP}")),
        ("d.toml", &format!("{LOOP}[ require ]\ngain_margin = 2\n")),
        ("e.toml", "[[expect]\n"),
        ("f.toml", "[package]\nname = 'f'\n"),
        ("g.toml", LOOP),
    ]);
    let run = folder.jurist(&["test", "."]);
    assert!(run.status == 2 && lines_of(&run).ends_with("4 passed, 0 failed, 1 with errors\n"), "{}", run.stdout);
    // A copy with the numbers of other files is not tried: its numbers are old ones.
    let model = format!(
        "{}[[expect]]\nverdict = 'stable'\n",
        LOOP.replace("c = {", "d = { from = 'g.h#D' }\nc = {").replace("c*K", "c*d*K")
    );
    let folder = Folder::new(&[("loop.toml", &model), ("g.h", "#define D 1\n")]);
    assert_eq!(folder.jurist(&["check", "loop.toml", "--resolved", "copy.toml"]).status, 0);
    folder.write("g.h", "#define D 9\n");
    assert!(folder.jurist(&["test", "."]).stdout.ends_with("0 passed, 1 failed\n"));
}

/// The worst status is told first by the exit status: a bad file, then a failure, then what is undecided.
#[test]
fn a_bad_file_goes_before_a_failure_and_a_failure_before_undecided() {
    let failing = format!("{LOOP}[[expect]]\nverdict = 'unstable'\n");
    let folder = Folder::new(&[("bad.toml", "time = 'discrete'\n"), ("failing.toml", &failing), ("good.toml", LOOP)]);
    for (paths, status) in [
        (&["bad.toml", "failing.toml", "good.toml"][..], 2),
        (&["failing.toml", "good.toml"], 1),
        (&["good.toml"], 0),
        (&["good.toml", "--work", "0"], 3),
        (&["missing.toml"], 2),
        (&["good.toml", "--cases", "missing.csv"], 2),
    ] {
        let run = folder.jurist(&[&["test"], paths].concat());
        assert_eq!(run.status, status, "{paths:?}: {}{}", run.stdout, run.stderr);
    }
    let run = folder.jurist(&["test", "bad.toml", "good.toml"]);
    assert!(lines_of(&run).contains("  ERROR     the file: E-missing: "), "{}", run.stdout);
}

#[test]
fn mistakes_in_expectations_are_shown_where_they_stand() {
    for (expectations, code, place) in [
        ("[[expect]]\nverdict = 'stabel'", "E-value", "'stabel'"),
        ("[[expect]]\nstable = [1, 2]", "E-missing", "stable"),
        ("[[expect]]\nparam = 'Q'\nstable = [1, 2]", "E-unknown-name", "'Q'"),
        ("[[expect]]\nset = { Q = 1 }\nverdict = 'stable'", "E-unknown-name", "Q"),
        ("[[expect]]\nparam = 'K'\nstable = [2, 1]", "E-empty-domain", "[2, 1]"),
        ("[[expect]]\nparam = 'K'\nstable = [1]", "E-size", "[1]"),
        ("[[expect]]\nparam = 'K'\nupper = 1", "E-missing", "upper"),
        ("[[expect]]\nparam = 'K'\nupper = 1\nwithin = '1..2'", "E-tolerance", "'1..2'"),
        ("[[expect]]\nparam = 'K'\nupper = inf\nwithin = 1", "E-not-a-number", "inf"),
        ("[[expect]]\nparam = 'K'\nstable = ['inf', 1]", "E-not-a-number", "'inf'"),
        ("[[expect]]\nparam = 'K'\nupper = 1\nwithin = -1", "E-tolerance", "-1"),
        ("[[expect]]\nverdit = 'stable'", "E-unknown-key", "verdit"),
        ("[[expect]]\nname = 'nothing'", "E-missing", "expect"),
        ("[[expect]]\nmodel = 'x.toml'\nverdict = 'stable'", "E-unknown-key", "'x.toml'"),
        ("[[expect]]\nrequire = { phase = 1 }", "E-unknown-key", "phase"),
        ("[[expect]]\nrequire = false", "E-type", "false"),
        ("[[expect]]\ntolerance = 0", "E-value", "0"),
        ("[expect]\nverdict = 'stable'", "E-type", "expect"),
    ] {
        let text = format!("{LOOP}{expectations}\n");
        let folder = Folder::new(&[("loop.toml", &text)]);
        let run = folder.jurist(&["check", "loop.toml", "--json"]);
        let document: Value = serde_json::from_str(&run.stdout).unwrap();
        let first = &document["diagnostics"][0];
        assert!(first["code"].as_str().unwrap_or_default().starts_with(code), "{expectations}: {document}");
        let (line, from, to) = (&first["place"]["line"], &first["place"]["column"], &first["place"]["end_column"]);
        let [line, from, to] = [line, from, to].map(|n| n.as_u64().unwrap() as usize);
        let marked: String = text.lines().nth(line - 1).unwrap().chars().skip(from - 1).take(to - from).collect();
        assert_eq!(marked, place, "{expectations}");
        assert_eq!(folder.jurist(&["test", "loop.toml"]).status, 2, "{expectations}");
    }
}

/// What is expected changes nothing of the loop: certificates stay true, and neither checker speaks of another text.
#[test]
fn certificates_hold_beside_expectations() {
    let folder = Folder::new(&[("loop.toml", LOOP)]);
    let run = folder.jurist(&["intervals", "loop.toml", "--param", "K", "--certificate", "k.json", "-q"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let entry = "[[expect]]\ncertificate = 'k.json'\nrequire = { gain_margin = 2 }\n[[expect]]\nparam = 'K'\nstable = ['-inf', 1]\n";
    folder.write("loop.toml", &format!("{entry}[simulation]\n"));
    // TOML wants keys of the model before its tables.
    let (head, blocks) = LOOP.split_at(LOOP.find("[loop]").unwrap());
    folder.write("loop.toml", &format!("{head}{entry}{blocks}"));
    let verified = folder.jurist(&["verify", "loop.toml", "k.json"]);
    assert_eq!(verified.status, 0, "{}", verified.stderr);
    assert!(!verified.stdout.contains("another text"), "{}", verified.stdout);
    if let Some(python) =
        crate::helpers::certificates::checkers::python(&folder.read("loop.toml"), &folder.read("k.json"))
    {
        assert!(!python.unwrap().contains("another text"));
    }
    let run = folder.jurist(&["test", "loop.toml"]);
    assert!(lines_of(&run).contains("  passed    certificate k.json: proves: "), "{}", run.stdout);
    folder.write("loop.toml", &format!("{head}{entry}{}", blocks.replace("c*K", "2*c*K")));
    let run = folder.jurist(&["test", "loop.toml"]);
    assert!(lines_of(&run).contains("  FAILED    certificate k.json: the certificate is rejected"), "{}", run.stdout);
}
