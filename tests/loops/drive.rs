//! The paper's drive, through the public library: every value the paper could have had.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::parse_number;
use jurist_engine::answer::{Answer, Verdict};
use jurist_engine::model::Loop;
use jurist_engine::stability::{End, StableSet};

fn only_interval(parameter: &str) -> (Answer<StableSet>, Option<End>, Option<End>) {
    let answer = Loop::drive().ask().free(parameter).stable_set(&Budget::unlimited()).unwrap();
    let set = answer.value();
    assert_eq!(set.intervals().len(), 1);
    let interval = set.intervals()[0].clone();
    (answer, interval.lower, interval.upper)
}

#[test]
fn limits_of_the_amplitude() {
    let (answer, lower, upper) = only_interval("K_pwm");
    let (lower, upper) = (lower.unwrap(), upper.unwrap());
    assert!(lower.value.decimal(30).starts_with("0.0381005333482991622339946374"));
    assert!(upper.value.decimal(30).starts_with("550.94116668667457553963753092"));
    assert_eq!(lower.causes.to_string(), "complex pair");
    assert_eq!(upper.causes.to_string(), "complex pair");
    let hertz = |end: &End| answer.problem().frequency(end, 60).unwrap().hertz.unwrap().decimal(6).unwrap();
    assert_eq!(hertz(&lower), "0.505696");
    assert_eq!(hertz(&upper), "1664.07");
}

#[test]
fn limits_of_the_period() {
    let (answer, lower, upper) = only_interval("T");
    let (lower, upper) = (lower.unwrap(), upper.unwrap());
    assert_eq!(lower.value.decimal(30), "0");
    assert_eq!(lower.causes.to_string(), "z=1+domain");
    assert!(upper.value.decimal(30).starts_with("0.00049693974510687222576676814702"));
    assert_eq!(upper.causes.to_string(), "complex pair");
    let hertz = answer.problem().frequency(&upper, 60).unwrap().hertz.unwrap().decimal(6).unwrap();
    assert_eq!(hertz, "332.766");
}

#[test]
fn test_points_of_the_paper() {
    let at = |name: &str, value: &str| {
        let question = Loop::drive().ask().set(name, parse_number(value).unwrap());
        question.verdict(&Budget::unlimited()).unwrap().into_value()
    };
    assert_eq!(at("K_pwm", "545").verdict, Verdict::Stable);
    assert_eq!(at("K_pwm", "555").verdict, Verdict::Unstable);
    assert_eq!(at("K_pwm", "555").count.unwrap().outside, 2);
    assert_eq!(at("T", "1/2020").verdict, Verdict::Stable);
    assert_eq!(at("T", "1/2010").verdict, Verdict::Unstable);
    let zero = at("T", "0");
    assert_eq!((zero.verdict, zero.count.unwrap().on), (Verdict::Marginal, 4));
}

#[test]
fn jury_conditions_intersect_in_the_stable_set() {
    for parameter in ["K_pwm", "T"] {
        let answer = Loop::drive().ask().free(parameter).parametric_table(&Budget::unlimited()).unwrap();
        let test = answer.value().test.as_ref().unwrap();
        assert_eq!(test.conditions.len(), 7);
        assert!(test.intersection.same_as(&answer.value().stable.to_interval_set()));
    }
}
