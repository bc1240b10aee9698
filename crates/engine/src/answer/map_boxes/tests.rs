//! Boxes of loops with dead time: their slices are the stable sets of one parameter.

use super::*;
use crate::error::Source;
use crate::model::Model;
use crate::problem::Ask;
use crate::stability::plane::boxes::BoxVerdict;
use jurist_algebra::number::parse_number;

pub(super) fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

pub(super) fn load(text: &str) -> Model {
    Model::from_toml(&Source::new("model.toml", text)).unwrap_or_else(|e| panic!("{e}\n{text}")).0
}

pub(super) type Side<'a> = (&'a str, &'a str, &'a str);

pub(super) fn boxes(model: &Model, [x, y]: [Side; 2], undecided: &str) -> BoxMap {
    let side = |(_, low, high): Side| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([side(x), side(y)], number(undecided));
    let problem = model.ask().free(x.0).free(y.0).plane_problem().unwrap();
    match problem.map_by(MapMethod::Boxes, &request, 6, &Budget::unlimited()).unwrap() {
        MapOrBoxes::Boxes(answer) => answer.into_value().boxes,
        MapOrBoxes::Exact(_) => panic!("boxes were expected"),
    }
}

/// At values of `y`, every box that is decided agrees with the stable set of `x` near both of its ends and between.
pub(super) fn slices_are_stable_sets(model: &Model, sides: [Side; 2], undecided: &str, values: &[&str]) {
    let map = boxes(model, sides, undecided);
    let whole = map.window.area();
    assert!(map.areas.undecided <= &whole * &number(undecided), "{}", map.areas.undecided.to_f64_approximate());
    assert!(map.stopped.is_none() && map.areas.stable.sign().is_gt() && map.areas.unstable.sign().is_gt());
    let [(x, low, high), (y, ..)] = sides;
    for value in values.iter().map(|v| number(v)) {
        let domain = Range::between(Some(number(low)), Some(number(high)));
        let question = model.ask().set(y, value.clone()).free(x).domain(x, domain);
        let set = question.stable_set(&Budget::unlimited()).unwrap().into_value();
        let on_line = map.boxes.iter().filter(|b| b.window.y[0] < value && value < b.window.y[1]);
        let mut seen = 0;
        for b in on_line.filter(|b| b.verdict != BoxVerdict::Undecided) {
            let [from, to] = &b.window.x;
            let near = (to - from) * Rational::new(1.into(), 1000.into());
            for at in [from + &near, from.midpoint(to), to - &near] {
                assert_eq!(set.contains(&at), b.verdict == BoxVerdict::Stable, "{x} = {at}, {y} = {value}");
                seen += 1;
            }
        }
        assert!(seen > 0, "{value}");
    }
}

#[test]
fn slices_of_a_map_of_a_gain_and_a_dead_time_are_stable_sets() {
    let model = load(include_str!("../../../../../examples/dead-time-pi.toml"));
    let sides = [("K_c", "0.1", "5"), ("theta", "0.5", "8")];
    slices_are_stable_sets(&model, sides, "0.3", &["0.7", "3", "7.1"]);
    let turned = [sides[1], sides[0]];
    slices_are_stable_sets(&model, turned, "0.3", &["0.4", "1", "4"]);
}

#[test]
fn slices_of_a_map_of_two_gains_are_stable_sets() {
    let model = load(include_str!("../../../../../examples/dead-time-pi.toml"));
    slices_are_stable_sets(&model, [("K_c", "0.1", "5"), ("T_i", "1", "12")], "0.3", &["1.7", "8"]);
}

#[test]
fn the_lobes_of_a_map_of_chatter_are_windows() {
    let model = load(include_str!("../../../../../examples/chatter.toml"));
    slices_are_stable_sets(&model, [("T", "1", "8"), ("k_c", "0.1", "1.5")], "0.6", &["0.3", "0.7"]);
}

#[test]
fn frequencies_far_apart_are_walked_over() {
    // Time constants of 1000 s and 10 us around a dead time of 1 ms.
    let text = "time = 'continuous'\n[parameters]\nK = {}\ntau = {}\n[loop]\n\
        characteristic = '(1000*s + 1)*(s/100000 + 1) + K*exp(-tau*s)'";
    let map = boxes(&load(text), [("K", "1", "1000"), ("tau", "0.001", "0.002")], "0.1");
    let (areas, tenth) = (&map.areas, &map.window.area() * &number("0.1"));
    assert!(areas.unstable.is_zero() && areas.undecided <= tenth && map.stopped.is_none(), "{areas:?}");
}

#[test]
fn dead_times_without_a_common_divisor_are_mapped() {
    // The smith predictor's model has five seconds of dead time, whatever the process has.
    let text = include_str!("../../../../../examples/smith-predictor.toml").replace("theta_process = 6\n", "");
    let model = load(&text.replace("[parameters]", "[parameters]\ntheta_process = {}"));
    let (gain, time) = (("K", "1", "7"), ("theta_process", "5.6", "6.5"));
    slices_are_stable_sets(&model, [gain, time], "0.6", &["6"]);
}

#[test]
fn a_loop_of_neutral_type_is_mapped_where_its_difference_operator_is_stable() {
    let model = load(include_str!("../../../../../examples/neutral-loop.toml"));
    let sides = [("K", "-1/2", "3/2"), ("tau", "1/2", "2")];
    let map = boxes(&model, sides, "0.3");
    let verdict = |x: &str, y: &str| map.locate(&number(x), &number(y)).map(|b| b.verdict);
    assert_eq!(verdict("0.0003", "1.0003"), Some(BoxVerdict::Stable));
    // What is delayed outweighs the highest power: infinitely many roots are to the right.
    assert_eq!(verdict("1.2003", "1.0003"), Some(BoxVerdict::Unstable { outside: None }));
}

#[test]
fn poles_and_negative_dead_times_are_never_stable() {
    let text =
        "time = 'continuous'\n[parameters]\nK = {}\ntau = {}\n[loop]\ncharacteristic = 's + 1/(K - 1) + exp(-tau*s)/4'";
    let map = boxes(&load(text), [("K", "0", "3"), ("tau", "-1", "1")], "0.2");
    for b in map.boxes.iter().filter(|b| b.verdict != BoxVerdict::Undecided) {
        let is_loop = b.window.y[0] >= 0.into();
        assert!(is_loop || b.verdict == BoxVerdict::Unstable { outside: None }, "{b:?}");
        // No box holds the pole at K = 1; below it the constant is below -1.
        let below = b.window.x[1] <= 1.into();
        assert!(below || b.window.x[0] >= 1.into() || !is_loop, "{b:?}");
        assert!(!is_loop || !below || b.verdict == BoxVerdict::Unstable { outside: Some(1) }, "{b:?}");
    }
    assert_eq!(map.areas.stable.sign(), std::cmp::Ordering::Greater);
}

#[test]
fn what_boxes_cannot_treat_is_refused() {
    let refused = |characteristic: &str, method: MapMethod| {
        let text = format!(
            "time = 'continuous'\n[parameters]\nK = {{}}\ntau = {{}}\n[loop]\ncharacteristic = '{characteristic}'"
        );
        let side = Range::between(Some(0.into()), Some(1.into()));
        let request = BoxRequest::new([side.clone(), side], number("1/2"));
        let problem = load(&text).ask().free("K").free("tau").plane_problem().unwrap();
        match problem.map_by(method, &request, 6, &Budget::unlimited()) {
            Err(Error::Refused(list)) => list.diagnostics()[0].message.clone(),
            other => panic!("{other:?}"),
        }
    };
    let linear = refused("s + 1 + exp(-K*tau*s)", MapMethod::Auto);
    assert_eq!(linear, "the dead time is not linear in the free parameters");
    let exact = refused("s + K + exp(-tau*s)", MapMethod::Exact);
    assert_eq!(exact, "this cannot be asked of a loop with dead time");
}
