//! `jurist tolerance` as people and other programs see it.

use crate::helpers::program::{jurist, jurist_with_input, refused};
use crate::helpers::schema::fits;
use crate::helpers::thorough::is_thorough;
use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use jurist_engine::model::Model;
use serde_json::Value;
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

const EIGHT: &str = "R_a,L_a,J,B_v,K_a,k_1,k_2,E_sw=20%";

fn document(arguments: &[&str], status: i32) -> Value {
    let run = jurist(&[arguments, &["--json"]].concat());
    assert_eq!(run.status, status, "{arguments:?}: {}", run.stderr);
    let document = serde_json::from_str(&run.stdout).expect("the program writes JSON");
    fits(&document).unwrap_or_else(|why| panic!("{arguments:?}: {why}"));
    document
}

#[test]
fn the_drive_in_words() {
    let run = jurist(&["tolerance", "--tol", EIGHT]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    for part in [
        "8 tolerances of 20 %: stable for all values (proof: ",
        "they can grow    2.2998",
        " < factor <= 2.29980475",
        "complex pair at 1664.067 Hz",
        "2 roots outside just beyond",
        "L_a 42.2 %",
        "E_sw 42.2 %",
        "k_1 15.6 %",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
}

/// At `l = 0` two roots are at infinity, and beyond one of them is right of the axis: the words are those of the point.
#[test]
fn roots_at_infinity_are_called_that() {
    let crane = "l*s^4 + 3*l*s^3 + (l + 40)*s^2 + 27*s + 5";
    let run = jurist(&["tolerance", crane, "--set", "l=12", "--tol", "l=8..16"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("infinity, 2 roots at infinity there\n"), "{}", run.stdout);
    assert!(!run.stdout.contains("just beyond"), "{}", run.stdout);
}

/// Nothing bounds the factor, or the values above: no number that is only where the search ended looks like a limit.
#[test]
fn where_no_end_was_found_the_words_say_so() {
    let run = jurist(&["tolerance", "s + 1 + a^2", "--set", "a=1", "--tol", "a=50%", "--exact"]);
    assert!(run.stdout.contains("they can grow    1024 <= factor; no worse point was found\n"), "{}", run.stdout);
    let words = "note: the factor is not proved as an exact number: no point was found that bounds it";
    assert!(run.stderr.contains(words), "{}", run.stderr);
    let asked = ["tolerance", "s + K*b", "--set", "K=1", "--set", "b=1", "--tol", "b=10%", "--limit", "K"];
    let run = jurist(&asked);
    assert!(run.stdout.contains("    above 1025: no value was found that is not stable\n"), "{}", run.stdout);
    let run = jurist(&[&asked[..], &["--domain", "K=..8"]].concat());
    assert!(run.stdout.contains("; its domain ends at 8\n"), "{}", run.stdout);
}

#[test]
fn the_drive_as_a_document() {
    let document = document(&["tolerance", "--tol", EIGHT], 0);
    assert_eq!(document["verdict"], "stable");
    assert_eq!(document["box"]["L_a"], serde_json::json!(["23/625", "69/1250"]));
    assert_eq!(document["worst"]["signs"]["L_a"], "-");
    assert_eq!(document["worst"]["cause"], "complex pair");
    assert!(document["cells"].as_u64().is_some_and(|cells| cells < 100));
    assert_eq!(document["undecided"], Value::Null);
    assert!(document["factor"]["exact"].is_null());
    let outside = &document["witness"]["outside"];
    assert_eq!(outside, 2);
}

#[test]
fn an_exact_factor_has_its_polynomial() {
    let document = document(&["tolerance", "examples/de-gaston-safonov.toml", "--exact"], 0);
    let exact = &document["factor"]["exact"];
    assert!(exact["decimal"].as_str().unwrap().starts_with("3.4173955312"), "{exact}");
    assert!(exact["polynomial"].as_array().unwrap().len() >= 6);
}

#[test]
fn the_bus_has_a_witness_and_status_one() {
    let document = document(&["tolerance", "examples/bus-steering.toml"], 1);
    assert_eq!(document["verdict"], "not stable");
    assert!(document["witness"]["outside"].as_u64().unwrap() > 0);
    let run = jurist(&["tolerance", "examples/bus-steering.toml"]);
    assert!(run.stdout.contains("not stable for all values") && run.stdout.contains("0.98877"), "{}", run.stdout);
}

#[test]
fn a_limit_has_both_sides() {
    if is_thorough() {
        let document = document(&["tolerance", "--tol", EIGHT, "--limit", "K_pwm"], 0);
        let limit = &document["limit"];
        assert_eq!(limit["parameter"], "K_pwm");
        for side in ["lower", "upper"] {
            assert!(limit[side].as_array().unwrap().iter().all(Value::is_string), "{limit}");
        }
    }
    let run = jurist(&["tolerance", "--tol", EIGHT, "--limit", "K_pwm"]);
    // What is proved is rounded inwards.
    assert!(run.stdout.contains("0.17398") && run.stdout.contains("<= K_pwm <= 293.73"), "{}", run.stdout);
}

#[test]
fn tolerances_of_the_model_of_all_and_of_the_command_line() {
    let model = "time = 'continuous'\nparameters.a = { nominal = 1, tolerance = '10%' }\nconstants.b = { value = 2, tolerance = 0.5 }\n\
        constants.c = 3\nloop.characteristic = 's^3 + c*s^2 + b*s + a'\n";
    let boxes = |arguments: &[&str]| {
        let run = jurist_with_input(&[&["tolerance", "-", "--json"], arguments].concat(), model.as_bytes());
        assert_eq!(run.status, 0, "{arguments:?}: {}", run.stderr);
        let document: Value = serde_json::from_str(&run.stdout).unwrap();
        document["box"].clone()
    };
    assert_eq!(boxes(&[]), serde_json::json!({"b": ["3/2", "5/2"], "a": ["9/10", "11/10"]}));
    assert_eq!(boxes(&["--tol", "a=-20%..+30%", "--fix", "b"]), serde_json::json!({"a": ["4/5", "13/10"]}));
    assert_eq!(
        boxes(&["--all", "1%", "--fix", "a"]),
        serde_json::json!({"b": ["99/50", "101/50"], "c": ["297/100", "303/100"]})
    );
    assert_eq!(boxes(&["--set", "a=2", "--fix", "b"]), serde_json::json!({"a": ["9/5", "11/5"]}));
}

#[test]
fn mistakes_point_at_their_place() {
    refused(&["tolerance"], "E-tolerance");
    refused(&["tolerance", "--tol", "L_a"], "E-option-value");
    refused(&["tolerance", "--tol", "L_a=10 percent"], "E-tolerance");
    refused(&["tolerance", "--tol", "L_x=10%"], "E-unknown-parameter");
    refused(&["tolerance", "--tol", "L_a=1..2"], "E-tolerance");
    refused(&["tolerance", "--all", "-5%"], "E-tolerance");
    refused(&["tolerance", "--tol", "L_a=1%", "--limit", "nothing"], "E-unknown-parameter");
}

#[test]
fn no_time_is_undecided() {
    let run = jurist(&["tolerance", "--tol", EIGHT, "--timeout", "0", "--json"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    fits(&document).unwrap();
    assert!(document["undecided"]["budget"].is_string());
}

/// Bars of the shares, the locus on the way to the worst point, the response there beside the nominal one.
#[test]
fn a_picture_has_bars_the_locus_and_the_worst_response() {
    let folder = std::env::temp_dir().join(format!("jurist-tolerances-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("worst.svg");
    let run = jurist(&["tolerance", "--tol", EIGHT, "-o", file.to_str().unwrap()]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let svg = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    for part in [
        "share of the margin that each tolerance uses",
        ">42.2 %<",
        ">15.6 %<",
        "Root locus in factor",
        ">nominal<",
        ">worst point<",
    ] {
        assert!(svg.contains(part), "{part}");
    }
}

#[test]
fn the_volume_is_for_up_to_six_parameters() {
    refused(&["tolerance", "--tol", "R_a,L_a,J,B_v,K_a,k_1,k_2=20%", "--volume"], "E-tolerance");
    let run = jurist(&["tolerance", "--tol", "R_a,L_a=20%", "--volume"]);
    assert!(run.stdout.contains("of the box       100 % stable, 0 % not, 0 % undecided"), "{}", run.stdout);
}

#[test]
fn a_box_that_leaves_a_domain_is_answered_with_a_warning() {
    let model = "time = 'continuous'\nparameters.a = { nominal = 1, min = 0.95, tolerance = '10%' }\nloop.characteristic = 's + a'\n";
    let run = jurist_with_input(&["tolerance", "-"], model.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("W-outside-domain"), "{}", run.stderr);
}

#[test]
#[ignore = "long: CI runs it"]
fn tolerances_inside_of_functions_are_answered_and_certified() {
    let asked = ["tolerance", "examples/drive-hold.toml", "--tol", "R_a,L_a,J=20%"];
    let document = document(&[&asked[..], &["--digits", "3"]].concat(), 0);
    assert_eq!((&document["verdict"], &document["worst"]["cause"]), (&"stable".into(), &"complex pair".into()));
    let frequency = document["worst"]["frequency_hz"].as_f64().unwrap();
    assert!(1650.0 < frequency && frequency < 1670.0, "{frequency}");
    let run = jurist(&[&asked[..], &["--certificate", "-"]].concat());
    let (text, certificate) = run.stdout.split_at(run.stdout.find('{').unwrap());
    assert!(run.status == 0 && text.contains("complex pair"), "{}", run.stderr);
    assert!(!is_thorough() || text == jurist(&asked).stdout, "{text}");
    let model = crate::helpers::model::example_text("drive-hold");
    crate::helpers::certificates::checkers::accept(&model, certificate);
}

/// A proof of the box is told before the larger boxes are looked at, and its text is how the whole text begins.
#[test]
fn a_proof_is_told_as_soon_as_it_stands() {
    let tolerances = [("R_a", "20%".parse().unwrap()), ("L_a", "20%".parse().unwrap())];
    let request = ToleranceRequest::new(tolerances);
    let told = RefCell::new(Vec::new());
    let tell = |answer: &Answer<ToleranceAnswer>| told.borrow_mut().push(answer.text(9));
    let whole = Model::drive().ask().tolerance_told(&request, &tell, &Budget::unlimited()).unwrap();
    assert_eq!(told.borrow().len(), 1);
    assert!(whole.text(9).starts_with(&told.borrow()[0]) && whole.text(9) != told.borrow()[0], "{told:?}");
    assert!(told.borrow()[0].contains("\n2 tolerances of 20 %: stable for all values (proof: "), "{told:?}");
    // What comes after it may be ended: the proof stands.
    let flag = Arc::new(AtomicBool::new(false));
    let stopped = Model::drive().ask().tolerance_told(
        &request,
        &|_| flag.store(true, Ordering::Relaxed),
        &Budget::unlimited().cancelled_by(Arc::clone(&flag)),
    );
    assert!(flag.load(Ordering::Relaxed) && stopped.is_ok_and(|answer| answer.value().decision.is_stable()));
    // The program prints the same text, in two parts.
    let run = jurist(&["tolerance", "--tol", "R_a,L_a=20%"]);
    assert_eq!(run.stdout, whole.text(9), "{}", run.stderr);
}

/// A tolerance of 10 around 110 is no short number of per cent.
#[test]
fn a_tolerance_in_per_cent_is_a_decimal() {
    let run = jurist(&["tolerance", "--tol", "K_pwm=10"]);
    assert!(run.stdout.contains("1 tolerance of about 9.091 %: stable"), "{}", run.stdout);
    // One part in 10^12 of the margin is told as what it is.
    let run = jurist(&["tolerance", "s + K + b/10^9", "--set", "K=1", "--set", "b=1", "--tol", "K,b=10%"]);
    assert!(run.stdout.contains("K 100 %   b below 0.0001 %"), "{}", run.stdout);
}
