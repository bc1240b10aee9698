//! Certificates of one parameter by boxes: where the parameter is inside of functions.

use crate::helpers::certificates::checkers::{PYTHON_EVERY, accept, reject, reject_in_rust};
use crate::helpers::model::{path, read};
use crate::helpers::number::number;
use crate::helpers::program::{jurist, jurist_with_input};
use jurist::certified::certify_intervals;
use jurist::{Ask, Budget};
use jurist_algebra::number::Rational;
use jurist_check::{Limits, Step, check};
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

/// `z - X + K (1 - X)` with `X = exp(-T)`: stable while `X > (K - 1)/(K + 1)`.
const LAG: &str = "time = 'discrete'\n[parameters]\nT = { nominal = 0.1, min = 0 }\nK = { nominal = 3 }\n[loop]\ninputs = ['r']\n\
    [[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
    [[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = { method = 'zoh', T = 'T' }\n";

fn certified(text: &str, parameter: &str) -> jurist::certified::CertifiedIntervals {
    let answer = read(text).ask().free(parameter).stable_set(&Budget::unlimited()).unwrap();
    certify_intervals(&answer, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"))
}

/// The ranges of a statement that are stable, and those that are not.
fn ranges(statement: &str) -> [Vec<[Rational; 2]>; 2] {
    let (_, said) = statement.split_once(" stable for ").unwrap();
    let (stable, rest) = said.split_once(", and not stable for any value in ").unwrap();
    let unstable = rest.split_once(". Nothing").unwrap().0;
    [stable, unstable].map(|list| {
        let ranges = list.split(" and ").filter_map(|range| {
            let mut ends = range.split(" <= ");
            let (low, _, high) = (ends.next()?, ends.next()?, ends.next()?);
            Some([number(low), number(high)])
        });
        ranges.collect()
    })
}

#[test]
fn the_sample_time_of_a_held_lag_is_certified_up_to_a_narrow_gap() {
    let found = certified(LAG, "T");
    accept(LAG, &found.text);
    let [low, high] = found.window.clone().unwrap();
    assert!(low.is_zero() && high > number("13/10") && found.proved > number("999999/1000000"), "{found:?}");
    let [stable, unstable] = ranges(&check(LAG, &found.text, &LIMITS).unwrap().statement);
    // The end is log 2.
    let end = number("0.69314718055994530941");
    let gap = number("1/1000000");
    assert_eq!((stable.len(), unstable.len()), (1, 1));
    assert!(stable[0][0] < gap && stable[0][1] < end && &stable[0][1] + &gap > end, "{stable:?}");
    assert!(unstable[0][0] > end && unstable[0][0] < &end + &gap && unstable[0][1] == high, "{unstable:?}");
}

#[test]
fn sample_times_that_only_powers_have_are_certified() {
    // z - 1 + K T: no function is left, but the checkers compute exponentials of numbers only.
    let integrator = LAG.replace("1/(s + 1)", "1/s");
    let found = certified(&integrator, "T");
    accept(&integrator, &found.text);
    let [stable, unstable] = ranges(&check(&integrator, &found.text, &LIMITS).unwrap().statement);
    let (end, gap) = (number("2/3"), number("1/1000000"));
    assert!(stable[0][1] < end && &stable[0][1] + &gap > end && unstable[0][0] > end, "{stable:?}");
    // A domain that goes beyond: nothing is proved where no loop is.
    let beyond = integrator.replace("min = 0", "min = -1");
    let found = certified(&beyond, "T");
    accept(&beyond, &found.text);
    assert!(found.window.is_some_and(|[low, _]| low.is_zero()));
}

#[test]
#[ignore = "long: CI runs it"]
fn certificates_of_one_parameter_that_lie_are_rejected() {
    let text = certified(LAG, "T").text;
    let tree = text.split("\"tree\": \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    let with = |other: &str| text.replace(&format!("\"tree\": \"{tree}\""), &format!("\"tree\": \"{other}\""));
    assert!(tree.contains('+') && tree.contains('-') && tree.contains('?') && !tree.contains('y'), "{tree}");
    for (i, letter) in tree.char_indices() {
        let mut others = vec!["+", "-"];
        others.retain(|other| !other.starts_with(letter));
        // A side that has no width is not halved.
        let (others, step) = if letter == 'x' { (vec!["y"], Step::Line) } else { (others, Step::Stable) };
        for other in others {
            let mut lie = tree.clone();
            lie.replace_range(i..=i, other);
            match i % PYTHON_EVERY {
                0 => reject(LAG, &with(&lie), step),
                _ => reject_in_rust(LAG, &with(&lie), step),
            }
        }
    }
    // Another value of the other parameter: from 4 on the limit is below that of 3.
    reject(LAG, &text.replace("\"y\": [\"3\", \"3\"]", "\"y\": [\"4\", \"4\"]"), Step::Stable);
    assert_ne!(text, text.replace("\"y\": [\"3\", \"3\"]", "\"y\": [\"4\", \"4\"]"));
    // The parameter in question has to have a width.
    let [_, high] = certified(LAG, "T").window.unwrap();
    let point = text.replace("\"x\": [\"0\", ", &format!("\"x\": [\"{high}\", "));
    assert_ne!(text, point);
    reject(LAG, &point, Step::Statement);
}

#[test]
fn exact_certificates_stay_exact() {
    let found = certified(LAG, "K");
    accept(LAG, &found.text);
    assert!(found.window.is_none() && found.proved.is_one());
    assert!(!found.text.contains("tree"));
    // Where there is no other name with a value boxes have one side.
    let alone = LAG.replace("K = { nominal = 3 }\n", "").replace("gain = 'K'", "gain = 3");
    let found = certified(&alone, "T");
    accept(&alone, &found.text);
    assert!(found.window.is_some() && found.proved > number("0.9999"), "{}", found.proved);
}

/// A constant is asked about, and a parameter is the dead time beside it.
#[test]
fn constants_beside_dead_time_are_certified() {
    let process = "time = 'continuous'\n[constants]\nk = 5\n[parameters]\ntheta = { nominal = 0.5, min = 0 }\n[loop]\ninputs = ['r']\n\
        [[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ngain = 'k'\n\
        [[block]]\nname = 'P'\ninput = 'u'\noutput = 'v'\ntransfer = '1/(4*s + 1)'\n\
        [[block]]\nname = 'D'\ninput = 'v'\noutput = 'y'\ndelay = 'theta'\n";
    let found = certified(process, "k");
    accept(process, &found.text);
    assert!(found.window.is_none());
}

#[test]
fn the_program_says_how_much_a_certificate_by_boxes_proves() {
    let folder = std::env::temp_dir().join(format!("jurist-line-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("line.json").to_str().unwrap().to_owned();
    let servo = path("examples/dc-servo.toml").to_str().unwrap().to_owned();
    let run = jurist(&["intervals", &servo, "--param", "T", "--certificate", &file]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(
        run.stderr.starts_with("note: the certificate proves 99.99") && !run.stderr.contains("warning"),
        "{}",
        run.stderr
    );
    let proved = jurist(&["verify", &servo, &file, "--timeout", "inf"]);
    assert!(
        proved.status == 0 && proved.stdout.contains("with K = 4, T_m = 1/20, the loop is stable for "),
        "{}",
        proved.stdout
    );
    // A name is not needed beside it.
    let alone = LAG.replace("K = { nominal = 3 }\n", "").replace("gain = 'K'", "gain = 3");
    let found = jurist_with_input(&["intervals", "-", "--param", "T", "--certificate", &file], alone.as_bytes());
    assert!(found.status == 0 && found.stderr.starts_with("note: the certificate proves 99.99"), "{}", found.stderr);
    std::fs::remove_dir_all(&folder).unwrap();
}
