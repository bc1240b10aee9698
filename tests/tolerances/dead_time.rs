//! Boxes of loops with dead time: proved by Taylor models in frequency and parameters, refuted by exact counts.

use crate::helpers::model::{example, load};
use crate::helpers::number::number;
use crate::helpers::thorough::{is_thorough, tried};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, BoxRequest, MapMethod, MapOrBoxes, ToleranceAnswer, ToleranceRequest, Verdict};
use jurist_engine::error::{Code, Error};
use jurist_engine::model::Model;
use jurist_engine::problem::Region;
use jurist_engine::stability::boxes::BoxDecision;
use jurist_engine::stability::plane::boxes::BoxVerdict;
use jurist_engine::stability::{AtPoint, Range};
use proptest::prelude::*;

/// A loop given by its characteristic function.
fn function(parameters: &str, characteristic: &str) -> Model {
    load(&format!("time = 'continuous'\n[parameters]\n{parameters}\n[loop]\ncharacteristic = '{characteristic}'\n"))
}

/// `K exp(-theta s)/(T s + 1)`, fed back.
fn first_order() -> Model {
    function("K = { nominal = 2 }\nT = { nominal = 1 }\ntheta = { nominal = 0.5 }", "T*s + 1 + K*exp(-theta*s)")
}

/// Whether the loop of [`first_order`] is stable: `w^2 = (K^2 - 1)/T^2` at its limit, where `w theta + atan(w T) = pi`.
fn first_order_is_stable([k, t, theta]: [f64; 3]) -> bool {
    let w = (k * k - 1.0).sqrt() / t;
    w * theta + (w * t).atan() < std::f64::consts::PI
}

fn request(list: &[(&str, &str)], gap: &str) -> ToleranceRequest {
    ToleranceRequest::new(list.iter().map(|(name, t)| (*name, t.parse().unwrap()))).gap(number(gap))
}

fn asked(model: &Model, list: &[(&str, &str)], gap: &str) -> Answer<ToleranceAnswer> {
    model.ask().tolerance(&request(list, gap), &Budget::unlimited()).unwrap()
}

fn verdict_at(answer: &Answer<ToleranceAnswer>, point: &[Rational]) -> Result<Verdict, Error> {
    let names = answer.problem().free().iter().map(|free| free.name.clone());
    let question = answer.problem().model().ask().set_all(names.zip(point.iter().cloned()));
    Ok(question.verdict(&Budget::unlimited())?.value().verdict)
}

/// The sides of the box of a factor, by name.
fn sides(answer: &Answer<ToleranceAnswer>, names: &[&str], factor: &Rational) -> Vec<[Rational; 2]> {
    let place = |name: &&str| answer.problem().free().iter().position(|free| free.name == *name).unwrap();
    names.iter().map(|name| answer.value().sides[place(name)].at(factor)).collect()
}

/// The bracket is as narrow as asked for; its witness is in the box of its upper end and not stable; the corners of its proved box, and some
/// of its points, are stable.
fn holds_at_points(answer: &Answer<ToleranceAnswer>, gap: &str, shares: &[u64]) {
    let factor = answer.value().factor.as_ref().unwrap();
    let upper = factor.upper.as_ref().unwrap_or_else(|| panic!("no worst point: {factor:?}"));
    assert!(factor.lower < *upper && upper - &factor.lower <= upper * &number(gap), "{} {upper}", factor.lower);
    let witness = factor.witness.as_ref().unwrap();
    assert_ne!(verdict_at(answer, &witness.point).unwrap_or(Verdict::Undefined), Verdict::Stable);
    let outermost = answer.value().sides.iter().map(|side| side.at(upper));
    assert!(outermost.zip(&witness.point).all(|([low, high], x)| low <= *x && *x <= high));
    let inner: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(&factor.lower)).collect();
    let corners =
        (0..1usize << inner.len()).map(|mask| (0..inner.len()).map(|i| ((mask >> i & 1) * 16) as u64).collect());
    let points: Vec<Vec<u64>> = corners.chain(shares.chunks_exact(inner.len()).map(<[u64]>::to_vec)).collect();
    for point in points {
        let at = |([low, high], share): (&[Rational; 2], &u64)| {
            low + &(&(high - low) * &Rational::new((*share as i64).into(), 16.into()))
        };
        let point: Vec<Rational> = inner.iter().zip(&point).map(at).collect();
        assert_eq!(verdict_at(answer, &point).unwrap(), Verdict::Stable, "{point:?}");
    }
}

#[test]
fn a_first_order_process_has_the_factor_of_its_formula() {
    let all = [("K", "10%"), ("T", "10%"), ("theta", "10%")];
    let answer = asked(&first_order(), &all, "1e-6");
    assert!(answer.value().decision.is_stable());
    holds_at_points(&answer, "1e-6", &[3, 15, 8, 1, 7, 16]);
    let factor = answer.value().factor.as_ref().unwrap();
    let at = |factor: &Rational| {
        let sides = sides(&answer, &["K", "T", "theta"], factor);
        (0..8usize).all(|mask| first_order_is_stable([0, 1, 2].map(|i| sides[i][mask >> i & 1].to_f64_approximate())))
    };
    assert!(at(&(&factor.lower * &number("0.999999"))) && !at(&(factor.upper.as_ref().unwrap() * &number("1.000001"))));
    let worst = answer.value().worst.as_ref().expect("the end of the line");
    assert_eq!(worst.end.causes.to_string(), "complex pair");
    let shares = factor.shares.as_ref().unwrap();
    assert!(shares.iter().all(|share| share.sign().is_gt()));
}

/// Also the delay margin: the distance of the dead time from its limit.
#[test]
#[ignore = "long: CI runs it"]
fn one_tolerance_has_the_factor_of_the_parameters_limit() {
    let loops = [
        (example("dead-time-pi"), "theta", "-1%..+10%", ("0", "20")),
        (example("dead-time-pi"), "K_c", "-1%..+10%", ("0", "20")),
        (example("dead-time-pi"), "T_i", "-90%..0%", ("0.1", "20")),
        (example("chatter"), "T", "5%", ("5.5", "8")),
        (example("chatter"), "k_c", "30%", ("0", "3")),
        (example("neutral-loop"), "K", "10%", ("-1", "0.9")),
        (example("smith-predictor"), "K", "50%", ("0", "20")),
    ];
    for (model, name, tolerance, domain) in tried(loops, 2) {
        let answer = asked(&model, &[(name, tolerance)], "1e-6");
        let range = Range::between(Some(number(domain.0)), Some(number(domain.1)));
        let set = model.ask().free(name).domain(name, range).stable_set(&Budget::unlimited()).unwrap();
        let side = &answer.value().sides[0];
        let stable = set.value().intervals().iter().find(|i| i.contains(side.nominal())).expect("stable there").clone();
        let factor = answer.value().factor.as_ref().unwrap();
        let inside = |factor: &Rational| side.at(factor).iter().all(|x| stable.contains(x));
        assert!(inside(&factor.lower) && !inside(factor.upper.as_ref().expect("a worst point")), "{name}");
        holds_at_points(&answer, "1e-6", &[]);
    }
}

#[test]
fn two_tolerances_agree_with_the_map() {
    let model = example("dead-time-pi");
    let answer = asked(&model, &[("T_p", "20%"), ("K_p", "20%")], "1e-4");
    holds_at_points(&answer, "1e-4", &[3, 5]);
    let factor = answer.value().factor.as_ref().unwrap();
    let proved = sides(&answer, &["T_p", "K_p"], &factor.lower);
    let window = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([window("1", "20"), window("0.1", "10")], number("0.2"));
    let problem = model.ask().free("T_p").free("K_p").plane_problem().unwrap();
    let map = match problem.map_by(MapMethod::Auto, &request, 6, &Budget::unlimited()).unwrap() {
        MapOrBoxes::Boxes(answer) => answer.into_value().boxes,
        MapOrBoxes::Exact(_) => panic!("boxes were expected"),
    };
    let overlaps = |a: &[Rational; 2], b: &[Rational; 2]| a[0] < b[1] && b[0] < a[1];
    let unstable: Vec<_> =
        map.boxes.iter().filter(|b| matches!(b.verdict, BoxVerdict::Unstable { .. })).map(|b| &b.window).collect();
    assert!(!unstable.is_empty() && !unstable.iter().any(|w| overlaps(&w.x, &proved[0]) && overlaps(&w.y, &proved[1])));
    let point = &factor.witness.as_ref().expect("a worst point").point;
    let at = |name: &str| &point[answer.problem().free().iter().position(|free| free.name == name).unwrap()];
    assert!(map.locate(at("T_p"), at("K_p")).is_none_or(|found| found.verdict != BoxVerdict::Stable));
}

/// `s + K exp(-s)` is stable up to `K = pi/2`.
#[test]
fn a_box_may_end_next_to_the_limit() {
    let model = function("K = { nominal = 1 }", "s + K*exp(-s)");
    assert!(asked(&model, &[("K", "0%..57.0796326%")], "1e-3").value().decision.is_stable());
    let beyond = asked(&model, &[("K", "0%..57.0796327%")], "1e-3");
    let BoxDecision::NotStable { witness: Some(witness) } = &beyond.value().decision else { panic!("a witness") };
    assert!(witness.at == Some(AtPoint::Delayed { on: 0, right: Some(2) }), "{witness:?}");
}

#[test]
#[ignore = "long: CI runs it"]
fn a_dead_time_may_be_zero_at_an_edge_of_the_box() {
    let answer = asked(&example("dead-time-pi"), &[("theta", "-100%..+10%"), ("K_c", "10%")], "1e-3");
    assert!(answer.value().decision.is_stable());
    // Below zero there is no loop.
    assert_eq!(answer.value().domain_factor, Some(Rational::ONE));
    assert_eq!(answer.value().factor.as_ref().unwrap().lower, Rational::ONE);
    let down = asked(&first_order(), &[("theta", "-100%..0%")], "1e-3");
    assert!(down.value().decision.is_stable());
    assert_eq!(down.value().factor.as_ref().unwrap().witness.as_ref().unwrap().at, Some(AtPoint::Undefined));
    // Without dead time the oscillator is not damped.
    let oscillator = asked(&example("delayed-oscillator"), &[("tau", "100%")], "1e-3");
    let BoxDecision::NotStable { witness: Some(witness) } = &oscillator.value().decision else { panic!("a witness") };
    assert_eq!(
        (witness.point.as_slice(), verdict_at(&oscillator, &witness.point).unwrap()),
        ([Rational::ZERO].as_slice(), Verdict::Marginal)
    );
}

/// Roots are to the right in the middle of the box alone, between two windows of the dead time.
#[test]
fn what_happens_inside_of_the_box_is_seen() {
    // Stable below pi/sqrt(1.2) = 2.87 and between 2 pi/sqrt(0.8) = 7.02 and 3 pi/sqrt(1.2) = 8.60.
    let answer = asked(&example("delayed-oscillator"), &[("tau", "0%..620%")], "1e-3");
    let BoxDecision::NotStable { witness: Some(witness) } = &answer.value().decision else { panic!("a witness") };
    assert!(number("2.86") < witness.point[0] && witness.point[0] < number("7.03"), "{}", witness.point[0]);
    let factor = answer.value().factor.as_ref().unwrap();
    assert!(factor.upper.as_ref().unwrap() < &number("0.303"));
}

/// `(a + b) x < pi/2` where both dead times are `x`; the greatest of both is the worst.
#[test]
fn two_dead_times_vary_each_on_its_own() {
    let parameters = "a = { nominal = 0.5 }\nb = { nominal = 0.5 }\nx = { nominal = 1 }\ny = { nominal = 1 }";
    let model = function(parameters, "s + a*exp(-x*s) + b*exp(-y*s)");
    let answer = asked(&model, &["a", "b", "x", "y"].map(|name| (name, "25%")), "1e-6");
    assert!(answer.value().decision.is_stable());
    let factor = answer.value().factor.as_ref().unwrap();
    // (1 + f/4)^2 = pi/2.
    assert!(
        factor.lower > number("1.01325") && factor.upper.as_ref().unwrap() < &number("1.01326"),
        "{}",
        factor.lower
    );
    // Dead times without a common divisor are counted all the same.
    let point = ["0.5", "0.5", "1.234567", "1.7654321"].map(number);
    assert!(matches!(verdict_at(&answer, &point), Err(Error::Refused(_))));
    let apart = asked(&model, &[("x", "23.4567%"), ("y", "276.54321%")], "1e-3");
    assert!(matches!(&apart.value().decision, BoxDecision::NotStable { witness: Some(_) }));
}

#[test]
fn multiples_and_quotients_of_parameters_are_dead_times() {
    let model = function("K = { nominal = 0.4 }\nx = { nominal = 1 }", "s + K*exp(-x*s) + K*exp(-2*x*s)");
    let answer = asked(&model, &[("K", "10%"), ("x", "10%")], "1e-5");
    assert!(answer.value().decision.is_stable());
    holds_at_points(&answer, "1e-5", &[5, 9]);
    let parameters = "K = { nominal = 1 }\nL = { nominal = 2 }\nv = { nominal = 2.5 }";
    let belt = asked(&function(parameters, "s + K*exp(-L/v*s)"), &["K", "L", "v"].map(|name| (name, "10%")), "1e-5");
    assert!(belt.value().decision.is_stable());
    // 0.8 (1 + f/10)^2/(1 - f/10) = pi/2: f = 2.297...
    holds_at_points(&belt, "1e-5", &[]);
    let factor = belt.value().factor.as_ref().unwrap();
    assert!(number("2.297") < factor.lower && factor.lower < number("2.298"), "{}", factor.lower);
}

/// `T s + 1 + K exp(-s)` has infinitely many roots to the right for a negative `T`.
#[test]
fn a_lost_degree_ends_the_factor() {
    let model = function("T = { nominal = 1 }\nK = { nominal = 0.5 }", "T*s + 1 + K*exp(-s)");
    let answer = asked(&model, &[("T", "10%")], "1e-2");
    assert!(answer.value().decision.is_stable());
    let factor = answer.value().factor.as_ref().unwrap();
    assert!(factor.lower > number("9.8") && factor.lower < number("10"), "{}", factor.lower);
    assert!(factor.upper.as_ref().is_none_or(|upper| *upper >= number("9.99")));
}

/// `s + K s exp(-s) + 1` is of neutral type: no dead time allows `K = 1`.
#[test]
fn a_loop_of_neutral_type_ends_with_its_difference_operator() {
    let model = function("K = { nominal = 0.5 }\nx = { nominal = 1 }", "s + K*s*exp(-x*s) + 1");
    let answer = asked(&model, &[("K", "10%")], "1e-2");
    assert!(answer.value().decision.is_stable());
    let factor = answer.value().factor.as_ref().unwrap();
    assert!(number("8") < factor.lower && factor.lower < number("10"), "{}", factor.lower);
    assert!(factor.witness.iter().all(|witness| verdict_at(&answer, &witness.point).unwrap() != Verdict::Stable));
}

#[test]
fn a_nominal_point_on_the_axis_or_beyond_is_the_witness() {
    for nominal in ["0", "2"] {
        let model = function(&format!("K = {{ nominal = {nominal} }}"), "s + K*exp(-s)");
        let answer = asked(&model, &[("K", "0.1")], "1e-3");
        let BoxDecision::NotStable { witness: Some(witness) } = &answer.value().decision else { panic!("a witness") };
        assert!(witness.point == [number(nominal)] && answer.value().factor.is_none());
    }
}

#[test]
fn a_limit_holds_for_all_values_of_the_others() {
    let request = request(&[("T", "20%"), ("theta", "20%")], "1e-5").limit("K");
    let answer = first_order().ask().tolerance(&request, &Budget::unlimited()).unwrap();
    let [lower, upper] = answer.value().limit.as_ref().unwrap().sides.clone().map(|side| side.unwrap());
    let stable_for_all =
        |k: f64| [0.8, 1.2].iter().all(|t| [0.4, 0.6].iter().all(|theta| first_order_is_stable([k, *t, *theta])));
    let (safe, beyond) = (upper.safe.to_f64_approximate(), upper.unsafe_at.unwrap().to_f64_approximate());
    assert!(stable_for_all(safe) && !stable_for_all(beyond * 1.000_001) && beyond - safe < 1e-4, "{safe} {beyond}");
    // K = -1: a root at s = 0, whatever the others are.
    assert!(lower.safe > number("-1") && lower.unsafe_at == Some(number("-1")), "{}", lower.safe);
    assert_eq!(upper.worst.unwrap().end.causes.to_string(), "complex pair");
}

/// `c s + K exp(-s)` with the decay 1/5: from `K/c = exp(-1/5)/5`, with a real root there, to `exp(-1/5)/(5 cos w)`, `tan w = 5 w`.
#[test]
#[ignore = "long: CI runs it"]
fn a_decay_rate_holds_for_all_values_beside_a_dead_time() {
    let model =
        function("K = { nominal = '1/2' }\nc = { nominal = 1 }\ntheta = { nominal = 1 }", "c*s + K*exp(-theta*s)");
    let decaying = || model.ask().within(Region::half_plane(number("1/5")));
    let w = (0..200).fold(1.4, |w: f64, _| (5.0 * w).atan());
    let ends = [0.2 * (-0.2f64).exp(), 0.2 * (-0.2f64).exp() / w.cos()];
    for (k, c, known) in [
        // (1/2 + f/20)/(1 - f/10), and (1/2 - f/20)/(1 + f/10).
        ("-0%..+10%", "10%", (ends[1] - 0.5) / (0.05 + 0.1 * ends[1])),
        ("-10%..+0%", "10%", (0.5 - ends[0]) / (0.05 + 0.1 * ends[0])),
        ("-10%..+0%", "0%", (0.5 - ends[0]) / 0.05),
    ] {
        let answer = decaying().tolerance(&request(&[("K", k), ("c", c)], "1e-6"), &Budget::unlimited()).unwrap();
        let factor = answer.value().factor.as_ref().expect("a factor");
        let [low, high] = [&factor.lower, factor.upper.as_ref().expect("an end")].map(Rational::to_f64_approximate);
        assert!(low <= known + 1e-9 && known <= high + 1e-9 && high - low < 1e-5, "{low} {known} {high}");
        assert!(factor.witness.is_some());
    }
    if is_thorough() {
        let answer = decaying().tolerance(&request(&[("K", "10%")], "1e-6").exact(), &Budget::unlimited()).unwrap();
        let end = answer.value().exact.as_ref().expect("the end of the line");
        let exact = end.value.refined_to_digits(12).enclosure().0;
        assert!((exact.to_f64_approximate() - (0.5 - ends[0]) / 0.05).abs() < 1e-9, "{exact}");
    }
    // K from 0 to 1, c from 0.8 to 1.2: the share of a rectangle between two lines from the origin.
    let volume = request(&[("K", "100%"), ("c", "20%")], "1e-3").volume(number("1/20"));
    let volume = decaying().tolerance(&volume, &Budget::unlimited()).unwrap().into_value().volume.unwrap();
    let at = |i: u32| 0.8 + 0.4 * (f64::from(i) + 0.5) / 1000.0;
    let share = (0..1000).map(|i| (ends[1] * at(i)).min(1.0) - ends[0] * at(i)).sum::<f64>() / 1000.0;
    let [stable, undecided] = [&volume.stable, &volume.undecided].map(Rational::to_f64_approximate);
    assert!(stable <= share + 1e-6 && share <= stable + undecided + 1e-6, "{stable} {share} {undecided}");
    // The same two lines in a map by boxes.
    let side = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let window = BoxRequest::new([side("0", "1"), side("0.8", "1.2")], number("1/10"));
    let problem = decaying().free("K").free("c").plane_problem().unwrap();
    let MapOrBoxes::Boxes(map) = problem.map_by(MapMethod::Auto, &window, 6, &Budget::unlimited()).unwrap() else {
        panic!("boxes were expected");
    };
    let areas = &map.value().boxes.areas;
    let [stable, undecided] = [&areas.stable, &areas.undecided].map(|area| area.to_f64_approximate() / 0.4);
    assert!(stable <= share + 1e-6 && share <= stable + undecided + 1e-6 && undecided <= 0.1, "{stable} {share}");
    match decaying().tolerance(&request(&[("theta", "5%")], "1e-3"), &Budget::unlimited()) {
        Err(Error::Refused(list)) => assert_eq!(list.diagnostics()[0].code, Code::DeadTime),
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_not_asked_of_dead_time_is_refused() {
    let all = request(&[("T", "5%"), ("K", "5%")], "1e-3");
    let answer = first_order().ask().tolerance(&all.clone().box_alone(), &Budget::unlimited()).unwrap();
    assert!(answer.value().decision.is_stable() && answer.value().factor.is_none());
    match answer.certificate(&Budget::unlimited()) {
        Err(Error::Refused(list)) => assert_eq!(list.diagnostics()[0].code, Code::NoCertificate),
        other => panic!("{other:?}"),
    }
    let other = function("K = { nominal = 1 }\na = { nominal = 1 }", "s + K*exp(-s) + exp(-a*K)");
    match other.ask().tolerance(&request(&[("K", "5%")], "1e-3"), &Budget::unlimited()) {
        Err(Error::Refused(list)) => assert_eq!(list.diagnostics()[0].code, Code::DeadTime),
        other => panic!("{other:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// Of second-order processes with an integrator: the exact count says of the box what the proof says.
    #[test]
    #[ignore = "long: CI runs it"]
    fn boxes_agree_with_counts_at_their_points(
        k in 1i64..12, a in 5i64..30, theta in 1i64..15, share in 2i64..12,
        points in prop::collection::vec(0u64..=16, 6),
    ) {
        let tenth = |n: i64| Rational::new(n.into(), 10.into());
        let parameters = format!(
            "K = {{ nominal = '{}' }}\na = {{ nominal = '{}' }}\ntheta = {{ nominal = '{}' }}", tenth(k), tenth(a), tenth(theta)
        );
        let model = function(&parameters, "s^2 + a*s + K*exp(-theta*s)");
        let tolerance = format!("{}%", 2 * share);
        let answer = asked(&model, &["K", "a", "theta"].map(|name| (name, tolerance.as_str())), "1e-4");
        match &answer.value().factor {
            Some(_) => holds_at_points(&answer, "1e-4", &points),
            None => {
                let nominal: Vec<Rational> = answer.value().sides.iter().map(|side| side.nominal().clone()).collect();
                prop_assert_ne!(verdict_at(&answer, &nominal).unwrap(), Verdict::Stable);
            }
        }
    }
}
