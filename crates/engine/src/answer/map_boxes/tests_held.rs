//! Boxes of loops with plants behind a hold: their slices are the stable sets of one parameter.

use super::tests::{boxes, load, number, slices_are_stable_sets};
use super::*;
use crate::answer::Verdict;
use crate::problem::Ask;
use crate::stability::plane::boxes::{BoxVerdict, PlaneBox};

#[test]
fn slices_of_a_map_of_two_gains_behind_a_hold_are_stable_sets() {
    let model = load(include_str!("../../../../../examples/two-mass-drive.toml"));
    slices_are_stable_sets(&model, [("K_p", "0.1", "6"), ("K_i", "1", "300")], "0.4", &["20", "200"]);
}

#[test]
fn slices_of_a_map_of_a_gain_and_the_sample_time_are_stable_sets() {
    let model = load(include_str!("../../../../../examples/dc-servo.toml"));
    let (gain, time) = (("K", "1", "200"), ("T", "0.0005", "0.01"));
    slices_are_stable_sets(&model, [gain, time], "0.3", &["0.001", "0.004"]);
    slices_are_stable_sets(&model, [time, gain], "0.3", &["40"]);
}

#[test]
fn slices_of_a_map_of_a_gain_and_a_constant_of_the_plant_are_stable_sets() {
    let model = load(include_str!("../../../../../examples/dc-servo.toml"));
    slices_are_stable_sets(&model, [("K", "1", "200"), ("T_m", "0.01", "0.1")], "0.3", &["0.03", "0.07"]);
}

#[test]
fn the_map_of_the_held_drive_knows_its_limits() {
    let model = load(include_str!("../../../../../examples/drive-hold.toml"));
    let map = boxes(&model, [("K_pwm", "10", "800"), ("T", "0.0001", "0.0009")], "0.25");
    // At K_pwm = 110 the limit is T = 0.00049887..., at T = 1e-4 it is K_pwm = 551.37....
    assert!(map.areas.stable.sign().is_gt() && map.areas.unstable.sign().is_gt());
    let is_beyond = |b: &&PlaneBox| b.window.x[1] > number("552") && b.window.y[0] == number("0.0001");
    assert!(map.boxes.iter().filter(is_beyond).all(|b| b.verdict != BoxVerdict::Stable));
    for b in map.boxes.iter().filter(|b| b.window.x[0] < number("110.1") && number("110.1") < b.window.x[1]) {
        let is_beyond = b.window.y[0] >= number("0.0005");
        let is_below = b.window.y[1] <= number("0.000498");
        assert!(b.verdict != BoxVerdict::Stable || is_below, "{b:?}");
        assert!(
            !matches!(b.verdict, BoxVerdict::Unstable { .. }) || is_beyond || b.window.y[1] > number("0.000498"),
            "{b:?}"
        );
    }
}

#[test]
fn a_pole_that_is_no_rational_number_is_in_no_box() {
    // z + 1/(K - exp(-1)): undefined at K = 0.3678..., stable beyond 1.3678... and below -0.6321...
    let text = "time = 'discrete'\n[parameters]\nK = {}\na = {}\n[loop]\ncharacteristic = 'z + a/(K - exp(-1))'";
    let map = boxes(&load(text), [("K", "-1", "2"), ("a", "1/2", "1")], "0.2");
    let pole = number("0.36787944117144232159552377");
    for b in &map.boxes {
        let holds = b.window.x[0] < pole && pole < b.window.x[1];
        let says_nothing = matches!(b.verdict, BoxVerdict::Undecided | BoxVerdict::Unstable { outside: None });
        assert!(!holds || says_nothing, "{b:?}");
        let is_far = b.window.x[0] > number("1.37") || b.window.x[1] < number("-0.64");
        assert!(b.verdict == BoxVerdict::Undecided || !is_far || b.verdict == BoxVerdict::Stable, "{b:?}");
    }
    assert!(map.areas.stable.sign().is_gt() && map.areas.unstable.sign().is_gt());
}

#[test]
fn a_root_that_stays_on_the_circle_leaves_nothing_stable() {
    let text = "time = 'discrete'\n[parameters]\nK = {}\na = {}\n[loop]\ncharacteristic = '(z - 1)*(z - exp(-1)*K*a)'";
    let map = boxes(&load(text), [("K", "0", "1"), ("a", "0", "1")], "0.2");
    assert_eq!(map.areas.unstable, map.window.area());
}

#[test]
fn a_root_that_stays_on_the_circle_leaves_nothing_stable_where_functions_have_parameters() {
    for text in ["(z - 1)*(z - exp(-a)*K)", "(z - 1)*(z - exp(-a)*K*exp(-K))"] {
        let text = format!("time = 'discrete'\n[parameters]\nK = {{}}\na = {{}}\n[loop]\ncharacteristic = '{text}'");
        let map = boxes(&load(&text), [("K", "1/2", "1"), ("a", "0", "1")], "0.2");
        assert_eq!(map.areas.unstable, map.window.area(), "{text}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn slices_of_a_map_of_two_parameters_inside_of_functions_are_stable_sets() {
    let model = load(include_str!("../../../../../examples/drive-hold.toml"));
    let (constant, time) = (("L_a", "0.002", "0.2"), ("T", "0.0001", "0.001"));
    slices_are_stable_sets(&model, [constant, time], "0.2", &["0.0004"]);
    slices_are_stable_sets(&model, [time, constant], "0.2", &["0.01"]);
}

/// Points at random in decided boxes, counted by the loop's own polynomial there.
#[test]
#[ignore = "long: CI runs it"]
fn points_of_boxes_have_their_root_count() {
    let model = load(include_str!("../../../../../examples/drive-hold.toml"));
    for names in [["K_pwm", "L_a"], ["L_a", "T"]] {
        let ends = |name: &str| match name {
            "K_pwm" => ("10", "900"),
            "L_a" => ("0.002", "0.2"),
            _ => ("0.0001", "0.001"),
        };
        let axes = names.map(|name| (name, ends(name).0, ends(name).1));
        let map = boxes(&model, axes, "0.1");
        let mut seen = [0, 0];
        // Some of the boxes by default, all in CI.
        let (every, least) = if std::env::var_os("JURIST_THOROUGH").is_some() { (1, 6) } else { (4, 1) };
        for (k, b) in map.boxes.iter().enumerate().step_by(every) {
            let inner = |[low, high]: &[Rational; 2], share: usize| {
                low + &(&(high - low) * &Rational::new((share as i64).into(), 101.into()))
            };
            let point = [inner(&b.window.x, 1 + k * 37 % 100), inner(&b.window.y, 1 + k * 53 % 100)];
            let question = model.ask().set_all(names.iter().map(|n| (*n).to_owned()).zip(point));
            let found = question.verdict(&Budget::unlimited()).unwrap();
            match b.verdict {
                BoxVerdict::Undecided => continue,
                BoxVerdict::Stable => assert_eq!(found.value().verdict, Verdict::Stable, "{b:?}"),
                BoxVerdict::Unstable { .. } => assert_ne!(found.value().verdict, Verdict::Stable, "{b:?}"),
            }
            seen[usize::from(b.verdict == BoxVerdict::Stable)] += 1;
        }
        assert!(seen.iter().all(|n| *n >= least), "{names:?} {seen:?}");
    }
}
