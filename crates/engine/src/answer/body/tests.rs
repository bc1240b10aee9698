//! Bodies that are known by hand.

use super::*;
use crate::model::{Model, ParameterBuilder, Time};
use crate::problem::Ask;
use jurist_algebra::number::parse_number;

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn loop_of(characteristic: &str) -> Model {
    let parameter = |name: &str| ParameterBuilder::new(name).nominal("0");
    let builder = Model::builder(Time::Discrete).parameter(parameter("a")).parameter(parameter("b"));
    builder.parameter(parameter("c")).characteristic(characteristic).build().unwrap().0
}

fn asked(characteristic: &str, slices: (&str, &str, usize), narrow: &str) -> Answer<Body> {
    let values = SliceValues::evenly("c", &number(slices.0), &number(slices.1), slices.2).unwrap();
    let question = loop_of(characteristic).ask().free("a").free("b");
    question.body(&values, &number(narrow), 8, &Budget::unlimited()).unwrap()
}

fn between(end: &StretchEnd) -> (Rational, Rational) {
    let StretchEnd::Between { stable, none, stopped: None } = end else { panic!("{end:?}") };
    (stable.clone(), none.clone())
}

/// The triangle of `z^2 + a z + b` where `c^2 < 1/2`.
#[test]
fn ends_in_the_third_parameter_are_bracketed() {
    let answer = asked("(z^2 + a*z + b)*(z - 2*c^2)", ("-1", "1", 5), "1/100");
    let body = answer.value();
    let stable: Vec<bool> = body.slices.iter().map(|s| s.has_stable_points().unwrap()).collect();
    assert_eq!(stable, [false, true, true, true, false]);
    let [stretch] = body.stretches.as_slice() else { panic!("one stretch") };
    assert_eq!((stretch.first, stretch.last), (1, 3));
    for (end, sign) in stretch.ends.iter().zip([-1, 1]) {
        let (stable, none) = between(end);
        let square = |v: &Rational| v * v;
        assert!(square(&stable) < number("1/2") && square(&none) >= number("1/2"));
        assert!((&stable - &none).abs() <= number("1/100") && stable.sign() == Rational::from(sign).sign());
    }
}

/// `c (c - 1)(c + 1) > 0` is needed: a gap in the middle of the slices.
#[test]
fn a_gap_is_told() {
    let answer = asked("(z^2 + a*z + b)*(z - 1 + c*(c - 1)*(c + 1))", ("-5/4", "5/4", 11), "1/64");
    let body = answer.value();
    let runs: Vec<(usize, usize)> = body.stretches.iter().map(|s| (s.first, s.last)).collect();
    // -3/4, -1/2, -1/4 and 5/4; at -1, 0 and 1 a root stays at z = 1.
    assert_eq!(runs, [(2, 4), (10, 10)]);
    assert!(matches!(body.stretches[1].ends[1], StretchEnd::Range));
    let (stable, none) = between(&body.stretches[0].ends[1]);
    assert!(stable.is_negative() && none.sign().is_ge());
    let (stable, none) = between(&body.stretches[1].ends[0]);
    assert!(stable > Rational::ONE && none <= Rational::ONE);
}

/// Stable for `|a| < 1 + b`, `b < 1` and `|c| < 1`, where in the slice at `c` the parameter `b` is `c b`.
#[test]
fn extremes_name_the_slices_that_reach_them() {
    let answer = asked("z^2 + a*z + b - c^2", ("-1", "1", 3), "1/10");
    let extremes = answer.value().extremes.as_ref().unwrap().as_ref().unwrap();
    let said = |e: &Extreme| (e.value.as_ref().unwrap().decimal(5), e.slices.clone());
    assert_eq!(extremes.ends[0].each_ref().map(said), [("-2".into(), vec![0, 1, 2]), ("2".into(), vec![0, 1, 2])]);
    assert_eq!(extremes.ends[1].each_ref().map(said), [("-1".into(), vec![1]), ("2".into(), vec![0, 2])]);
    assert_eq!(extremes.ends[1][1].limit.as_ref().unwrap().limit.causes.to_string(), "complex pair");
    let [stretch] = answer.value().stretches.as_slice() else { panic!("one stretch") };
    assert!(stretch.ends.iter().all(|end| matches!(end, StretchEnd::Range)));
}

#[test]
fn an_unbounded_slice_has_no_extreme() {
    let answer = asked("z - a*c", ("-1", "1", 3), "1/10");
    let extremes = answer.value().extremes.as_ref().unwrap().as_ref().unwrap();
    assert!(extremes.ends[0].iter().all(|e| e.value.is_none() && e.slices == [1]));
    assert!(extremes.ends[1].iter().all(|e| e.value.is_none() && e.slices == [0, 1, 2]));
}

#[test]
fn no_stable_slice_has_no_extent() {
    let answer = asked("(z - 2)*(z - a*b*c)", ("0", "1", 2), "1/10");
    assert!(answer.value().extremes.as_ref().unwrap().is_none() && answer.value().stretches.is_empty());
}

#[test]
fn what_the_budget_did_not_allow_is_told() {
    let values = SliceValues::evenly("c", &number("-1"), &number("1"), 5).unwrap();
    let ask = |work: u64| {
        let question = loop_of("(z^2 + a*z + b)*(z - 2*c^2)").ask().free("a").free("b");
        question.body(&values, &number("1/100"), 8, &Budget::with_work(work)).unwrap()
    };
    let none = ask(0);
    assert_eq!(none.value().open_slices().count(), 5);
    assert!(none.value().stopped().is_some());
    // However far it comes: nothing is dropped, and what is not known is not said to be empty.
    let complete = ask(u64::MAX);
    assert!(complete.value().stopped().is_none());
    let inside = |v: &Rational| v * v < number("1/2");
    for work in [3, 10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000] {
        let answer = ask(work);
        let body = answer.value();
        assert_eq!(body.slices.len(), 5);
        for (slice, full) in body.slices.iter().zip(&complete.value().slices) {
            assert!(slice.has_stable_points().is_none_or(|known| Some(known) == full.has_stable_points()));
        }
        for stretch in &body.stretches {
            for (end, beside) in stretch.ends.iter().zip([stretch.first.checked_sub(1), Some(stretch.last + 1)]) {
                let beside = beside.and_then(|k| body.slices.get(k)).map(BodySlice::has_stable_points);
                match end {
                    StretchEnd::Range => assert_eq!(beside, None),
                    StretchEnd::Open => assert_eq!(beside, Some(None)),
                    StretchEnd::Between { stable, none, .. } => {
                        assert!(inside(stable) && !inside(none) && beside == Some(Some(false)));
                    }
                }
            }
        }
    }
}

#[test]
fn wrong_slices_are_refused() {
    let of = |count: usize| SliceValues::evenly("c", &Rational::ZERO, &Rational::ONE, count);
    assert!(of(1).is_err() && of(SliceValues::MOST + 1).is_err() && of(SliceValues::MOST).is_ok());
    let code = |question: Question, values: &SliceValues| match question.body_problem(values) {
        Err(Error::Refused(refused)) => refused.code(),
        other => panic!("{other:?}"),
    };
    let ask = || loop_of("z^2 + a*z + b*c").ask();
    let values = of(3).unwrap();
    assert_eq!(code(ask().free("a").free("c"), &values), Code::Usage);
    assert_eq!(code(ask().free("a").free("a"), &values), Code::Usage);
    let domain = crate::stability::Range::between(Some(Rational::ZERO), None);
    assert_eq!(code(ask().free("a").free("b").domain("c", domain), &values), Code::Value);
    assert_eq!(code(ask().free("a").free("b").set("c", 1), &values), Code::KeptAndSet);
}
