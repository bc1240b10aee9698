//! `jurist sweep`: rows are the answers of `intervals` and `verdict`; a run that was cut goes on.

use crate::helpers::program::{json, jurist};
use serde_json::Value;
use std::fs;

const GRID: &[&str] = &["sweep", "--param", "K_pwm", "--over", "T=1e-4,3e-4,2e-4"];

fn rows(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).expect("JSON lines")).collect()
}

#[test]
fn rows_are_the_answers_in_the_order_of_the_values() {
    let run = jurist(GRID);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let found = rows(&run.stdout);
    let values: Vec<_> = found.iter().map(|row| row["p.T"].as_str().unwrap()).collect();
    assert_eq!(values, ["1/10000", "1/5000", "3/10000"]);
    for row in &found {
        let set = format!("T={}", row["p.T"].as_str().unwrap());
        let answer = json(&["intervals", "--json", "--param", "K_pwm", "--digits", "17", "--set", &set]);
        let upper = &answer["stable"][0]["upper"];
        assert_eq!((&row["upper_decimal"], &row["upper_polynomial"]), (&upper["decimal"], &upper["polynomial"]));
        assert_eq!(row["upper_causes"], serde_json::json!(["complex pair"]));
        let nearest: f64 = upper["decimal"].as_str().unwrap().parse().unwrap();
        assert_eq!(row["upper"].as_f64(), Some(nearest));
    }
}

#[test]
fn without_a_parameter_the_verdict_is_asked_for() {
    let run = jurist(&["sweep", "--over", "K_pwm=110..551:2"]);
    let verdicts: Vec<_> = rows(&run.stdout).iter().map(|row| row["verdict"].clone()).collect();
    assert_eq!(verdicts, ["stable", "unstable"]);
}

#[test]
fn a_run_that_was_cut_goes_on_and_ends_with_the_same_bytes() {
    let folder = std::env::temp_dir().join(format!("jurist-sweep-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    for ending in ["jsonl", "csv"] {
        let path = |name: &str| folder.join(format!("{name}.{ending}")).to_str().unwrap().to_owned();
        let (whole, cut) = (path("whole"), path("cut"));
        assert_eq!(jurist(&[GRID, &["-o", &whole]].concat()).status, 0);
        // What an interrupted run leaves: a question, and a part of another one. Its row is told from an own answer by its name.
        let line = jurist(&["sweep", "--param", "K_pwm", "--over", "T=1e-4"]).stdout;
        let kept = line.trim_end().replacen("\"decided\"", "\"refused\"", 1);
        fs::write(format!("{cut}.part"), format!("{kept}\n\n{{\"key\": \"un")).unwrap();
        assert_eq!(jurist(&[GRID, &["-o", &cut, "--resume"]].concat()).status, 0);
        let (whole, cut) = (fs::read_to_string(&whole).unwrap(), fs::read_to_string(&cut).unwrap());
        assert_ne!(whole, cut, "the row that was kept was asked again");
        assert_eq!(whole, cut.replace("refused", "decided"));
        assert!(!fs::exists(format!("{}.part", path("cut"))).unwrap());
    }
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_file_of_another_sweep_is_not_resumed() {
    let folder = std::env::temp_dir().join(format!("jurist-sweep-other-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let model = folder.join("other.toml").to_str().unwrap().to_owned();
    let drive = fs::read_to_string("examples/drive.toml").unwrap();
    fs::write(&model, drive + "# another text is another model\n").unwrap();
    for ending in ["jsonl", "csv"] {
        let file = folder.join(format!("rows.{ending}")).to_str().unwrap().to_owned();
        assert_eq!(jurist(&[GRID, &["-o", &file]].concat()).status, 0);
        let before = fs::read_to_string(&file).unwrap();
        let refused = |arguments: &[&str]| {
            let run = jurist(&[arguments, &["-o", &file, "--resume"]].concat());
            assert_eq!(run.status, 2, "{}", run.stderr);
            assert!(run.stderr.contains("error[E-resume]"), "{}", run.stderr);
            assert_eq!(fs::read_to_string(&file).unwrap(), before, "nothing is lost");
        };
        refused(&["sweep", &model, "--param", "K_pwm", "--over", "T=1e-4,3e-4,2e-4"]);
        refused(&["sweep", "--param", "K_pwm", "--over", "T=1e-4,3e-4,4e-4"]);
        refused(&["sweep", "--over", "T=1e-4,3e-4,2e-4"]);
        // A grid that holds the old one goes on.
        let run = jurist(&["sweep", "--param", "K_pwm", "--over", "T=1e-4..3e-4:5", "-o", &file, "--resume"]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        // What another program wrote, and what a run of another sweep left beside the file.
        fs::write(&file, "my notes\n").unwrap();
        assert!(jurist(&[GRID, &["-o", &file, "--resume"]].concat()).stderr.contains("E-resume"));
        fs::remove_file(&file).unwrap();
        let row = jurist(&["sweep", "--over", "K_pwm=110,111"]).stdout.replace('\n', "\n\n");
        fs::write(format!("{file}.part"), &row).unwrap();
        assert!(jurist(&[GRID, &["-o", &file, "--resume"]].concat()).stderr.contains("E-resume"));
        assert_eq!(fs::read_to_string(format!("{file}.part")).unwrap(), row);
    }
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn failures_are_rows_and_undecided_ones_give_the_status() {
    let run = jurist(&["sweep", "--param", "K_pwm", "--over", "T=0,1e-4", "--each", "0"]);
    assert_eq!(run.status, 3);
    let statuses: Vec<_> = rows(&run.stdout).iter().map(|row| row["status"].clone()).collect();
    assert!(statuses.iter().all(|s| s == "undecided"), "{statuses:?}");
    assert!(run.stderr.contains("2 of 2 questions"), "{}", run.stderr);
}

#[test]
fn mistakes_are_refused_before_any_question() {
    for (arguments, code) in [
        (&["--over", "T"][..], "E-option-value"),
        (&["--over", "T=1..2"], "E-option-value"),
        (&["--over", "T=1,x"], "E-number"),
        (&["--over", "T_=1,2"], "E-unknown-parameter"),
        (&["--over", "T=1,2", "--over", "T=3,4"], "E-set-twice"),
        (&["--over", "T=1,2", "--param", "T"], "E-set-twice"),
        (&["--over", "T=1,2", "-o", "rows.txt"], "E-output-format"),
        (&["--over", "T=1,2", "--resume"], "E-usage"),
        (&[], "E-usage"),
    ] {
        let run = jurist(&[&["sweep"], arguments].concat());
        assert_eq!(run.status, 2, "{arguments:?}");
        assert!(run.stderr.contains(code), "{arguments:?}: {}", run.stderr);
    }
}
