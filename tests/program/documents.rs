//! The JSON documents: each fits the schema that it names, and is read by its type without loss.

use crate::helpers::program::{Run, jurist};
use crate::helpers::schema::{fits, folder};
use crate::helpers::thorough::is_tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_draw::document::{FrequencyResponse, Locus, Simulation};
use jurist_drive::document::Main;
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_ship::document::Ship;
use jurist_show::documents::through_its_type;
use jurist_tune::document::Tune;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// The document that a command writes, checked; the statuses are those of an answer.
fn document(arguments: &[&str]) -> Value {
    document_of(arguments, &jurist(&[arguments, &["--json"]].concat()))
}

fn document_of(arguments: &[&str], run: &Run) -> Value {
    assert!([0, 1, 3].contains(&run.status), "{arguments:?}: {}", run.stderr);
    let document: Value = serde_json::from_str(&run.stdout).expect("the program writes JSON");
    fits(&document).unwrap_or_else(|why| panic!("{arguments:?}: {why}"));
    assert_eq!(read_and_written(&document).as_ref(), Ok(&document), "{arguments:?}");
    document
}

/// A document once through its type.
fn read_and_written(document: &Value) -> Result<Value, String> {
    fn through<T: Serialize + DeserializeOwned>(document: &Value) -> Result<Value, String> {
        let typed: T = serde_json::from_value(document.clone()).map_err(|e| e.to_string())?;
        serde_json::to_value(typed).map_err(|e| e.to_string())
    }
    if let Some(read) = through_its_type(document) {
        return read.map_err(|e| e.to_string());
    }
    match document["schema"].as_str().expect("a schema") {
        "jurist/frequency-response/1" => through::<FrequencyResponse>(document),
        "jurist/locus/1" => through::<Locus>(document),
        "jurist/main/1" => through::<Main>(document),
        "jurist/ship/1" => through::<Ship>(document),
        "jurist/simulate/1" => through::<Simulation>(document),
        "jurist/tune/1" => through::<Tune>(document),
        other => panic!("the schema {other}"),
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn every_document_of_the_examples_fits_its_schema() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let models: BTreeSet<_> = files.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert!(models.len() > 10);
    for path in models.into_iter().enumerate().filter(|(i, _)| is_tried(*i, 7)).map(|(_, path)| path) {
        let file = path.to_str().unwrap();
        let (model, _) = Model::from_toml(&Source::new(file, std::fs::read_to_string(&path).unwrap())).unwrap();
        for command in ["charpoly", "verdict"] {
            document(&[command, file]);
        }
        // Tables of loops behind a hold or with dead time are not known yet, and their limits may take long: a document that
        // says that nothing was begun has its schema too.
        let problem = model.ask().problem();
        let has_table = problem.map_or(true, |p| p.algebra(&Budget::unlimited()).is_ok());
        let time: &[&str] = if has_table { &[] } else { &["--timeout", "0"] };
        document(&[&["analyze", file], time].concat());
        if has_table {
            document(&["jury", file]);
        }
        for parameter in model.parameters() {
            // A parameter inside of a function needs a bounded domain.
            let arguments = [&["intervals", file, "--param", &parameter.name], time].concat();
            let run = jurist(&[&arguments[..], &["--json"]].concat());
            if run.status != 2 || has_table {
                document_of(&arguments, &run);
            } else {
                assert!(run.stderr.contains("E-function") || run.stderr.contains("E-dead-time"), "{}", run.stderr);
            }
            if has_table {
                document(&["jury", file, "--param", &parameter.name]);
            }
        }
    }
}

/// Commands that together write every kind of document, and every form of it.
const FORMS: &[&[&str]] = &[
    &[],
    &["analyze"],
    &["check"],
    &["test", "examples/drive.toml"],
    &["tolerance", "examples/de-gaston-safonov.toml"],
    &["tolerance", "examples/de-gaston-safonov.toml", "--explain"],
    &["intervals", "--param", "K_pwm", "--explain"],
    &["map", "-x", "T", "-y", "K_pwm", "--explain"],
    &["verdict", "examples/dc-servo.toml", "--explain"],
    &["charpoly", "--digits", "5"],
    &["charpoly", "--root-locus-form", "K_pwm"],
    &["charpoly", "examples/drive-blocks.toml", "--transfer", "omega_ref", "omega"],
    &["intervals", "--param", "K_pwm", "--radius", "9/10"],
    &["intervals", "--param", "radius"],
    &["jury", "--param", "T", "--radius", "9/10"],
    &["locus", "--param", "K_pwm"],
    &["map", "-x", "T", "-y", "K_pwm"],
    &["map", "-x", "T", "-y", "K_pwm", "--radius", "99/100"],
    &["map", "-x", "T=0..1/100", "-y", "K_pwm=0..600", "--method", "boxes", "--undecided", "1/5"],
    &["map", "examples/pid-body.toml", "-x", "K_i", "-y", "K_d", "-z", "K_p=-1..2:7"],
    &["bode", "examples/drive-blocks.toml", "--at", "i_ref"],
    &["margins"],
    &["margins", "examples/drive-blocks.toml", "--at", "speed controller", "--skew", "1"],
    &["margins", "examples/drive-blocks.toml", "--at", "i_a", "--set", "K_pwm=551"],
    &["margins", "--timeout", "0"],
    &["margins", "K/(s*(s+1))", "--param", "K"],
    &["margins", "K/(s*(s+1))", "--for-all", "K=1..2"],
    &["margins", "--param", "K_pwm", "--timeout", "0"],
    &["norm", "examples/drive-blocks.toml", "omega_ref", "i_a"],
    &["norm", "examples/drive-blocks.toml", "omega_ref", "omega", "--timeout", "0"],
    &["norm", "examples/dc-servo.toml", "r", "y", "--l1"],
    &["norm", "examples/dc-servo.toml", "r", "y", "--l1", "--timeout", "0"],
    &["roots"],
    &["roots", "examples/dc-servo.toml", "--explain"],
    &["roots", "--timeout", "0"],
    &["ship", "examples/drive-blocks.toml", "--block", "speed controller", "--format", "Q4.12", "--signal", "Q8.16"],
    &["ship", "examples/drive-blocks.toml", "--block", "current controller", "--format", "float32", "--param", "K_pwm"],
    &["tune", "examples/pi-sensitivity.toml"],
    &["tune", "examples/pi-sensitivity.toml", "--bound", "ki=1..2"],
    &["tune", "examples/dc-servo.toml", "--free", "K", "--objective", "min radius"],
    &["roots", "examples/dead-time-pi.toml", "--rightmost", "2"],
    &["roots", "examples/neutral-loop.toml", "--explain"],
    &["simulate", "--duration", "0.01"],
    &["simulate", "--switched", "--duration", "0.01"],
    &["verdict", "--set", "K_pwm=551"],
    &["--timeout", "0"],
    &["analyze", "--timeout", "0"],
    &["charpoly", "--timeout", "0"],
    &["charpoly", "--root-locus-form", "K_pwm", "--timeout", "0"],
    &["intervals", "--param", "T", "--timeout", "0"],
    &["jury", "--timeout", "0"],
    &["jury", "--param", "T", "--timeout", "0"],
    &["map", "-x", "T", "-y", "K_pwm", "--timeout", "0"],
    &["map", "examples/pid-body.toml", "-x", "K_i", "-y", "K_d", "-z", "K_p=-1..2:7", "--timeout", "0"],
    &["map", "-x", "T=0..1", "-y", "K_pwm=0..600", "--method", "boxes", "--timeout", "0"],
    &["verdict", "--timeout", "0"],
];

#[test]
#[ignore = "long: CI runs it"]
fn every_kind_of_document_fits_its_schema_and_every_schema_is_used() {
    let mut used = BTreeSet::new();
    for arguments in FORMS {
        let name = document(arguments)["schema"].as_str().unwrap().to_owned();
        used.insert(format!("{}.schema.json", name.trim_start_matches("jurist/").replace('/', "-")));
    }
    // A lock is a document whatever is asked for.
    let lock = ["lock", "examples/drive.toml", "--param", "K_pwm", "--output", "-"];
    document_of(&lock, &jurist(&lock));
    used.insert("lock-1.schema.json".to_owned());
    let files = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let published: BTreeSet<String> = files.filter(|name| name != "model.schema.json").collect();
    assert_eq!(used, published);
    let shown = include_str!("../../src/_documentation/schemas.rs");
    for name in &published {
        let stem = name.trim_end_matches(".schema.json");
        assert!(shown.contains(&format!("\"{stem}\";")), "{stem} is not in the documentation");
    }
}

#[test]
fn a_document_with_a_fault_does_not_fit() {
    let good = document(&["intervals", "--param", "K_pwm"]);
    let faulty = |fault: &dyn Fn(&mut Value)| {
        let mut bad = good.clone();
        fault(&mut bad);
        assert_ne!(bad, good);
        assert!(fits(&bad).is_err(), "{bad}");
    };
    faulty(&|d| d["schema"] = "jurist/intervals/2".into());
    faulty(&|d| d["schema"] = "jurist/verdict/1".into());
    faulty(&|d| d["tittle"] = "".into());
    faulty(&|d| d["time"] = "discret".into());
    faulty(&|d| d["set"]["T"] = 0.0001.into());
    faulty(&|d| d["set"]["T"] = "0.0001".into());
    faulty(&|d| d["domain"]["lower"] = "1/".into());
    faulty(&|d| d["radius"] = 1.into());
    faulty(&|d| d["stable"] = Value::Null);
    faulty(&|d| d["undecided"] = serde_json::json!({ "budget": "", "reached": "" }));
    faulty(&|d| d["stable"][0]["lower"]["decimal"] = 1.5.into());
    faulty(&|d| d["stable"][0]["lower"]["frequency_hz"] = "1".into());
    faulty(&|d| d["stable"][0]["lower"]["closed"] = Value::Null);
    faulty(&|d| d["stable"][0]["lower"]["caus"] = "z=1".into());
    for key in ["schema", "title", "unit", "set", "stable"] {
        faulty(&|d| drop(d.as_object_mut().unwrap().remove(key)));
    }
    for key in ["exact", "enclosure", "cause", "angle", "margin_db"] {
        faulty(&|d| drop(d["stable"][0]["lower"].as_object_mut().unwrap().remove(key)));
    }
    faulty(&|d| drop(d["stable"][0]["lower"]["enclosure"].as_array_mut().unwrap().pop()));
}
