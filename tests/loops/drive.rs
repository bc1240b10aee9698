//! The paper's drive, through the public library: every value the paper could have had.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::parse_number;
use jurist_engine::analysis::{Settings, Verdict, frequency, intervals, parametric_table, verdict};
use jurist_engine::model::Loop;
use jurist_engine::stability::End;

fn only_interval(parameter: &str) -> (jurist_engine::analysis::Intervals, Option<End>, Option<End>) {
    let answer = intervals(&Loop::drive(), &Settings::default(), parameter, &Budget::unlimited()).unwrap();
    let set = answer.stable.decided().unwrap();
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
    let hertz = |end: &End| frequency(end, &answer.question, 60).unwrap().hertz.unwrap().decimal(6).unwrap();
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
    let hertz = frequency(&upper, &answer.question, 60).unwrap().hertz.unwrap().decimal(6).unwrap();
    assert_eq!(hertz, "332.766");
}

#[test]
fn test_points_of_the_paper() {
    let at = |name: &str, value: &str| {
        let mut settings = Settings::default();
        settings.set.insert(name.into(), parse_number(value).unwrap());
        verdict(&Loop::drive(), &settings, &Budget::unlimited()).unwrap()
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
        let answer = parametric_table(&Loop::drive(), &Settings::default(), parameter, &Budget::unlimited()).unwrap();
        let test = answer.test.decided().unwrap().as_ref().unwrap();
        assert_eq!(test.conditions.len(), 7);
        assert!(test.intersection.same_as(&answer.stable.decided().unwrap().to_interval_set()));
    }
}
