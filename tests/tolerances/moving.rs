//! Boxes of parameters inside of functions: constants of plants behind a hold, and sample times.

use crate::helpers::model::{example, load};
use crate::helpers::number::number;
use crate::helpers::thorough::{count, is_thorough};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::ball::{Ball, exp};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::answer::{Answer, BoxRequest, MapMethod, MapOrBoxes, ToleranceAnswer, ToleranceRequest, Verdict};
use jurist_engine::error::{Code, Error};
use jurist_engine::model::Model;
use jurist_engine::stability::boxes::BoxDecision;
use jurist_engine::stability::plane::boxes::BoxVerdict;
use jurist_engine::stability::{AtPoint, Range};
use proptest::prelude::*;

/// `K` times a plant behind a hold, fed back.
fn held(parameters: &str, plant: &str) -> Model {
    load(&format!(
        "time = 'discrete'\nsample_time = 'T'\n[parameters]\n{parameters}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'gain'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
         [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\ndiscretize = 'zoh'\n"
    ))
}

/// `1/(tau s + 1)`: stable while `K < (1 + p)/(1 - p)`, `p = exp(-T/tau)`.
fn first_order() -> Model {
    held("K = { nominal = 3 }\ntau = { nominal = 2 }\nT = { nominal = 1 }", "1/(tau*s + 1)")
}

fn asked(model: &Model, list: &[(&str, &str)], gap: &str) -> Answer<ToleranceAnswer> {
    let request = ToleranceRequest::new(list.iter().map(|(name, t)| (*name, t.parse().unwrap()))).gap(number(gap));
    model.ask().tolerance(&request, &Budget::unlimited()).unwrap()
}

fn verdict_at(answer: &Answer<ToleranceAnswer>, point: &[Rational]) -> Verdict {
    let problem = answer.problem();
    let names = problem.free().iter().map(|free| free.name.clone());
    let question = problem.model().ask().set_all(names.zip(point.iter().cloned()));
    // Without a positive sample time there is no loop.
    question.verdict(&Budget::unlimited()).map_or(Verdict::Undefined, |answer| answer.value().verdict)
}

/// The bracket is as narrow as asked for; its witness is not stable; the corners, and some points, of its proved box are.
fn holds_at_points(answer: &Answer<ToleranceAnswer>, gap: &str, shares: &[u64]) {
    let factor = answer.value().factor.as_ref().unwrap();
    let upper = factor.upper.as_ref().expect("a worst point");
    assert!(factor.lower < *upper && upper - &factor.lower <= upper * &number(gap), "{} {upper}", factor.lower);
    let witness = factor.witness.as_ref().unwrap();
    assert_ne!(verdict_at(answer, &witness.point), Verdict::Stable);
    let sides: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(&factor.lower)).collect();
    let outermost: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(upper)).collect();
    assert!(outermost.iter().zip(&witness.point).all(|([low, high], x)| low <= x && x <= high));
    let inner =
        (0..1usize << sides.len()).map(|mask| (0..sides.len()).map(|i| ((mask >> i & 1) * 1000) as u64).collect());
    let points: Vec<Vec<u64>> = inner.chain(shares.chunks(sides.len()).map(<[u64]>::to_vec)).collect();
    for point in points.iter().filter(|point| point.len() == sides.len()) {
        let at = |([low, high], share): (&[Rational; 2], &u64)| {
            low + &(&(high - low) * &Rational::new((*share as i64).into(), 1000.into()))
        };
        let point: Vec<Rational> = sides.iter().zip(point).map(at).collect();
        assert_eq!(verdict_at(answer, &point), Verdict::Stable, "{point:?}");
    }
}

#[test]
fn three_constants_of_a_held_motor_are_proved_and_refuted() {
    let answer = asked(&example("drive-hold"), &[("R_a", "20%"), ("L_a", "20%"), ("J", "20%")], "1e-4");
    assert!(answer.value().decision.is_stable());
    holds_at_points(&answer, "1e-4", &[500, 3, 700, 20, 20, 980]);
    // All of the mechanism is known: a pair at a sixth of the sampling frequency.
    let worst = answer.value().worst.as_ref().expect("the end of the line");
    assert_eq!(worst.end.causes.to_string(), "complex pair");
    let shares = answer.value().factor.as_ref().unwrap().shares.as_ref().unwrap();
    let largest = answer.problem().free().iter().zip(shares).max_by_key(|(_, share)| *share).unwrap();
    assert_eq!(largest.0.name, "L_a");
}

/// Of the first-order plant the worst corner has the greatest gain and the least time constant.
#[test]
fn the_limit_of_a_first_order_plant_is_that_of_its_formula() {
    let answer = asked(&first_order(), &[("K", "20%"), ("tau", "20%")], "1e-6");
    let factor = answer.value().factor.as_ref().unwrap();
    // K (1 - p) - (1 + p), increasing along the line.
    let beyond = |f: &Rational| {
        let part = f * &number("0.2");
        let (gain, time) = (number("3") * (&Rational::ONE + &part), number("2") * (&Rational::ONE - &part));
        let p = exp(&Ball::from_rational(&-(&time.recip().unwrap()), 128));
        let one = Ball::from_integer(&Integer::ONE, 128);
        let excess = Ball::from_rational(&gain, 128).mul(&one.sub(&p)).sub(&one.add(&p));
        excess.sign().expect("not at the limit itself").is_gt()
    };
    assert!(!beyond(&factor.lower) && beyond(factor.upper.as_ref().unwrap()));
    assert!(matches!(answer.value().decision, BoxDecision::NotStable { witness: Some(_) }));
    holds_at_points(&answer, "1e-6", &[]);
}

#[test]
#[ignore = "long: CI runs it"]
fn one_constant_agrees_with_its_stable_set() {
    for (model, name, tolerance, domain) in [
        (example("drive-hold"), "T", "-10%..+90%", ("0", "0.01")),
        (first_order(), "tau", "-60%..+10%", ("0.1", "10")),
        (
            held("K = { nominal = 2 }\na = { nominal = 2 }\nT = { nominal = 1 }", "1/(s^2 + a*s + 1)"),
            "a",
            "40%",
            ("0", "9"),
        ),
    ] {
        let answer = asked(&model, &[(name, tolerance)], "1e-6");
        let range = Range::between(Some(number(domain.0)), Some(number(domain.1)));
        let set = model.ask().free(name).domain(name, range).stable_set(&Budget::unlimited()).unwrap();
        let side = &answer.value().sides[0];
        let stable = set.value().intervals().iter().find(|i| i.contains(side.nominal())).expect("stable there").clone();
        let inside = |x: &Rational| stable.contains(x);
        let factor = answer.value().factor.as_ref().unwrap();
        assert!(side.at(&factor.lower).iter().all(inside), "{name}");
        assert!(!side.at(factor.upper.as_ref().unwrap()).iter().all(inside), "{name}");
        holds_at_points(&answer, "1e-6", &[]);
    }
}

#[test]
fn two_tolerances_agree_with_the_map() {
    let model = example("dc-servo");
    let answer = asked(&model, &[("K", "50%"), ("T", "50%")], "1e-3");
    let factor = answer.value().factor.as_ref().unwrap();
    let sides: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(&factor.lower)).collect();
    let window = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([window("1", "200"), window("0.0005", "0.01")], number("0.3"));
    let problem = model.ask().free("K").free("T").plane_problem().unwrap();
    let map = match problem.map_by(MapMethod::Auto, &request, 6, &Budget::unlimited()).unwrap() {
        MapOrBoxes::Boxes(answer) => answer.into_value().boxes,
        MapOrBoxes::Exact(_) => panic!("boxes were expected"),
    };
    let order: Vec<usize> =
        ["K", "T"].iter().map(|n| answer.problem().free().iter().position(|f| f.name == *n).unwrap()).collect();
    let overlaps = |a: &[Rational; 2], b: &[Rational; 2]| a[0] < b[1] && b[0] < a[1];
    let mut seen = 0;
    for b in map.boxes.iter().filter(|b| matches!(b.verdict, BoxVerdict::Unstable { .. })) {
        assert!(!overlaps(&b.window.x, &sides[order[0]]) || !overlaps(&b.window.y, &sides[order[1]]), "{b:?}");
        seen += 1;
    }
    assert!(seen > 0);
    let witness = &factor.witness.as_ref().expect("a worst point").point;
    let there = map.locate(&witness[order[0]], &witness[order[1]]);
    assert!(there.is_none_or(|b| b.verdict != BoxVerdict::Stable));
}

/// `s^2 + 2 s + 1` at the nominal point: real modes on one side of it, an oscillation on the other.
#[test]
fn modes_may_turn_from_real_to_oscillating_within_the_box() {
    let model = held(
        "K = { nominal = 0.4 }\na = { nominal = 2 }\nb = { nominal = 1 }\nT = { nominal = 1 }",
        "1/(s^2 + a*s + b)",
    );
    let answer = asked(&model, &[("K", "50%"), ("a", "50%"), ("b", "50%")], "1e-4");
    assert!(answer.value().decision.is_stable());
    holds_at_points(&answer, "1e-4", &[500, 500, 500, 1, 999, 500]);
}

#[test]
fn an_integrator_beside_a_lag_is_proved_and_refuted() {
    let model = held("K = { nominal = 0.4 }\ntau = { nominal = 2 }\nT = { nominal = 1 }", "1/(s*(tau*s + 1))");
    let answer = asked(&model, &[("K", "30%"), ("tau", "10%"), ("T", "30%")], "1e-3");
    assert!(answer.value().decision.is_stable());
    holds_at_points(&answer, "1e-3", &[250, 750, 250]);
}

/// `1/(s + a)` with `a` from 0: the exponential's argument is zero at the edge; at `a = -K` a root is at `z = 1`.
#[test]
fn an_argument_may_be_zero_within_the_box() {
    let model = held("K = { nominal = 0.4 }\na = { nominal = 1 }\nT = { nominal = 1 }", "1/(s + a)");
    let answer = asked(&model, &[("a", "100%")], "1e-6");
    assert!(answer.value().decision.is_stable());
    let factor = answer.value().factor.as_ref().unwrap();
    assert_eq!(factor.upper, Some(number("1.4")));
    holds_at_points(&answer, "1e-6", &[]);
    assert!(asked(&model, &[("a", "120%")], "1e-3").value().decision.is_stable());
    assert!(!asked(&model, &[("a", "140%")], "1e-3").value().decision.is_stable());
}

#[test]
fn a_side_without_width_changes_nothing() {
    let one = asked(&first_order(), &[("K", "20%")], "1e-6");
    let two = asked(&first_order(), &[("K", "20%"), ("tau", "0%")], "1e-6");
    let ends = |answer: &Answer<ToleranceAnswer>| {
        let factor = answer.value().factor.clone().unwrap();
        (factor.lower, factor.upper.unwrap())
    };
    let ((low, high), (own_low, own_high)) = (ends(&one), ends(&two));
    assert!(low < own_high && own_low < high, "{low} {high} {own_low} {own_high}");
    let none = asked(&first_order(), &[("tau", "0%")], "1e-6");
    assert!(none.value().decision.is_stable() && none.value().factor.as_ref().unwrap().upper.is_none());
}

/// `1/s` with `K T = 2`: a root at `z = -1`.
#[test]
fn a_nominal_point_on_the_edge_is_the_witness() {
    let model = held("K = { nominal = 2 }\nT = { nominal = 1 }", "1/s");
    let answer = asked(&model, &[("T", "10%")], "1e-3");
    let BoxDecision::NotStable { witness: Some(witness) } = &answer.value().decision else { panic!("a witness") };
    assert_eq!(witness.point, [number("1")]);
    assert!(answer.value().factor.is_none());
    // With an exponential as well: K = (1 + p)/(1 - p) is no rational number, the nominal point is beyond it.
    let beyond = load(&first_order().source().text.replace("nominal = 3", "nominal = 5"));
    assert!(matches!(asked(&beyond, &[("tau", "10%")], "1e-3").value().decision, BoxDecision::NotStable { .. }));
}

#[test]
fn a_sample_time_that_is_not_positive_has_no_loop() {
    let model = held("K = { nominal = 0.4 }\ntau = { nominal = 2 }\nT = { nominal = 1 }", "1/(s*(tau*s + 1))");
    let answer = asked(&model, &[("T", "-30%..+1%")], "1e-6");
    let factor = answer.value().factor.as_ref().unwrap();
    assert_eq!(factor.upper, Some(number("10/3")));
    assert!(factor.witness.as_ref().unwrap().at == Some(AtPoint::Undefined));
}

#[test]
fn a_limit_holds_for_all_constants_of_the_plant() {
    let request = ToleranceRequest::new([("tau", "20%".parse().unwrap())]).limit("K").gap(number("1e-4"));
    let answer = first_order().ask().tolerance(&request, &Budget::unlimited()).unwrap();
    let [lower, upper] = answer.value().limit.as_ref().unwrap().sides.clone().map(|side| side.unwrap());
    // (1 + p)/(1 - p) with p = exp(-1/1.6) is 3.302...
    assert!(upper.safe > number("3.30") && upper.unsafe_at.unwrap() < number("3.31"), "{}", upper.safe);
    // K = -1: a root at z = 1, whatever tau is.
    assert!(lower.safe < number("-0.999") && lower.unsafe_at.unwrap() <= number("-1"), "{}", lower.safe);
    assert_eq!(upper.worst.unwrap().end.causes.to_string(), "z=-1");
}

#[test]
fn what_is_not_asked_of_functions_is_refused() {
    let all = ToleranceRequest::new([("tau", "20%".parse().unwrap())]);
    let answer = first_order().ask().tolerance(&all, &Budget::unlimited()).unwrap();
    match answer.certificate(&Budget::unlimited()) {
        Err(Error::Refused(list)) => assert_eq!(list.diagnostics()[0].code, Code::NoCertificate),
        other => panic!("{other:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: count(1, 4) as u32, ..ProptestConfig::default() })]

    /// Lags of the second order, real or oscillating, with all constants, gain and sample time uncertain.
    #[test]
    #[ignore = "long: CI runs it"]
    fn points_of_the_proved_box_are_stable_and_the_witness_is_not(
        a in 5i64..40, b in 1i64..30, gain in 1i64..8, percent in 5i64..30, shares in prop::collection::vec(0u64..=1000, 16),
    ) {
        let parameters = format!(
            "K = {{ nominal = '{gain}/10' }}\na = {{ nominal = '{a}/10' }}\nb = {{ nominal = '{b}/10' }}\nT = {{ nominal = '1/2' }}"
        );
        let model = held(&parameters, "1/(s^2 + a*s + b)");
        let percent = format!("{percent}%");
        let gap = if is_thorough() { "1e-2" } else { "5e-2" };
        let answer = asked(&model, &["K", "a", "b", "T"].map(|name| (name, percent.as_str())), gap);
        prop_assert!(answer.value().factor.is_some());
        holds_at_points(&answer, gap, &shares);
    }
}

/// With one name the lines on either side tell all: `K < (1 + p)/(1 - p)` with `K = 3` is `p > 1/2`, so `tau > T/ln(2) = 1.4426950408889634`.
#[test]
#[ignore = "long: CI runs it"]
fn one_name_is_answered_by_its_line() {
    let model = first_order();
    let answer = asked(&model, &[("tau", "10%")], "1/1000000");
    holds_at_points(&answer, "1/1000000", &[0, 500, 1000]);
    let value = answer.value();
    assert!(matches!(&value.decision, BoxDecision::Stable(proof) if proof.cells() == 1));
    let worst = value.worst.as_ref().unwrap();
    // (2 - 1.4426950408889634)/0.2
    assert_eq!(
        (worst.end.value.decimal(14).as_str(), worst.end.causes.to_string().as_str()),
        ("2.7865247955552", "z=-1")
    );
    assert_eq!(value.factor.as_ref().unwrap().direction, Some(vec![number("-1")]));
    // Only upwards nothing ends it.
    let answer = asked(&model, &[("tau", "-0%..+10%")], "1/1000");
    let factor = answer.value().factor.as_ref().unwrap();
    assert!(factor.upper.is_none() && factor.lower > number("1000"), "{}", factor.lower);
    // The box that holds its end is not stable; the factor 1 is never left inside of the bracket.
    for (tolerance, stable) in [("27.8%", true), ("27.9%", false)] {
        let answer = asked(&model, &[("tau", tolerance)], "1/10");
        let factor = answer.value().factor.as_ref().unwrap();
        assert_eq!(answer.value().decision.is_stable(), stable, "{tolerance}");
        assert!(if stable { factor.lower >= number("1") } else { *factor.upper.as_ref().unwrap() <= number("1") });
    }
    // A domain that ends first bounds the factor.
    let bounded = held("K = { nominal = 3 }\ntau = { nominal = 2, min = 1.6 }\nT = { nominal = 1 }", "1/(tau*s + 1)");
    let answer = asked(&bounded, &[("tau", "10%")], "1/1000");
    let factor = answer.value().factor.as_ref().unwrap();
    assert!(factor.upper.is_none() && factor.lower < number("2") && factor.lower > number("1.99"));
    assert_eq!(answer.value().domain_factor, Some(number("2")));
}

/// At the end of the domain there is no loop: the point that shows it bounds the factor.
#[test]
fn a_box_that_ends_where_there_is_no_loop_must_shrink() {
    let model =
        held("K = { nominal = 1 }\ntau = { nominal = '1/2', min = 0 }\nT = { nominal = 0.1 }", "1/(s*(tau*s + 1))");
    let answer = asked(&model, &[("tau", "0..2")], "1/1000");
    let value = answer.value();
    let factor = value.factor.as_ref().unwrap();
    assert!(!value.decision.is_stable() && factor.lower < number("1"));
    assert_eq!(factor.upper, Some(number("1")));
    assert_eq!(factor.witness.as_ref().unwrap().point, [number("0")]);
}
