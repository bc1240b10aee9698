//! How a limit moves with the number of bits, against limits by hand and by another program.

use crate::helpers::folder::Folder;
use crate::helpers::number::{number, ratio};
use jurist_algebra::number::Rational;
use jurist_ship::format::{Fixed, Rounding};
use serde_json::Value;
use std::path::Path;

fn rows(run: &str) -> Vec<(i64, Vec<Value>)> {
    let document: Value = serde_json::from_str(run).expect("a document");
    let row = |row: &Value| (row["fraction"].as_i64().unwrap(), row["stable"].as_array().unwrap().clone());
    document["limits"]["rows"].as_array().unwrap().iter().map(row).collect()
}

/// `z - 1/2 + K b` has its root within the disc where `-1/2 < K b < 3/2`.
#[test]
fn limits_behind_a_stored_gain_are_those_by_hand() {
    let model = "time = 'discrete'\n[parameters]\nK = { nominal = 1 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\nname = 'controller'\ninput = 'r - y'\noutput = 'u'\ngain = 0.3\n\
        [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = 'K/(z - 1/2)'\n";
    let folder = Folder::new(&[("loop.toml", model)]);
    for rounding in Rounding::ALL {
        let options = ["--block", "controller", "--format", "Q0.10", "--round", rounding.name(), "--param", "K"];
        let run = folder.jurist(&[&["ship", "loop.toml", "--json"], &options[..]].concat());
        let rows = rows(&run.stdout);
        assert_eq!(rows.last().map(|row| row.0), Some(16), "{} {}", rounding.name(), run.stderr);
        for (bits, stable) in rows {
            let fixed = Fixed { bits: 64, fraction: bits as i32, scale: 0, rounding };
            let stored = fixed.value(&fixed.rounded(&ratio(3, 10)));
            let [range] = &stable[..] else { panic!("{bits} {stable:?}") };
            if stored.is_zero() {
                assert!(range["lower"].is_null() && range["upper"].is_null(), "{bits} {range}");
                continue;
            }
            for (end, by_hand) in [("lower", ratio(-1, 2)), ("upper", ratio(3, 2))] {
                let by_hand = by_hand.checked_div(&stored).unwrap();
                assert_eq!(range[end]["exact"], by_hand.to_string(), "{bits} {}", rounding.name());
            }
        }
    }
}

/// Limits of the drive by mpmath: the characteristic polynomial of the stored loop from matrix exponentials with 60 digits, its limits by bisection of
/// the greatest modulus.
#[test]
#[ignore = "long: CI runs it"]
fn limits_of_the_drive_are_those_of_mpmath() {
    let by_mpmath = [
        (12, "0.03488787801543025291798", "551.37661861809064555576"),
        (14, "0.03488787801543025291798", "551.37661861809064555576"),
        (16, "0.03488787801543025291798", "551.37661861809064555576"),
        (17, "0.03908950352138699736301", "551.37662237989809112703"),
    ];
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/drive-ship.toml");
    let folder = Folder::new(&[("drive.toml", &std::fs::read_to_string(model).unwrap())]);
    let rows = rows(&folder.jurist(&["ship", "drive.toml", "--param", "K_pwm", "--json"]).stdout);
    let near = number("1e-20");
    for (bits, lower, upper) in by_mpmath {
        let (_, stable) = rows.iter().find(|row| row.0 == bits).expect("a row");
        for (end, expected) in [("lower", lower), ("upper", upper)] {
            let enclosure = &stable[0][end]["enclosure"];
            let [low, high] = [0, 1].map(|k| enclosure[k].as_str().unwrap().parse::<Rational>().unwrap());
            let expected = number(expected);
            assert!(low <= &expected + &near && &expected - &near <= high, "{bits} {end}: {enclosure}");
        }
    }
    assert!(rows.iter().all(|(bits, stable)| (*bits >= 11) != stable.is_empty()), "the sum is lost below 11 bits");
}
