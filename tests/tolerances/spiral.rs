//! The damping of discrete loops over boxes: roots inside of a logarithmic spiral, for all points of a box at once.

use crate::helpers::model::load;
use crate::helpers::number::number;
use crate::helpers::thorough::{count, is_thorough, tried};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{BoxRequest, MapBoxes, MapMethod, MapOrBoxes, ToleranceAnswer, ToleranceRequest};
use jurist_engine::model::Model;
use jurist_engine::response::{AllOf, MapForAll, Requirement};
use jurist_engine::stability::Range;
use jurist_engine::stability::boxes::BoxDecision;
use proptest::prelude::*;
use std::f64::consts::PI;

fn model(parameters: &str, characteristic: &str) -> Model {
    load(&format!("time = 'discrete'\n[parameters]\n{parameters}\n[loop]\ncharacteristic = '{characteristic}'\n"))
}

fn damping(text: &str) -> Requirement {
    Requirement::damping(number(text)).unwrap()
}

fn map(model: &Model, names: [&str; 2], sides: [[&str; 2]; 2], least: &str, undecided: &str) -> MapBoxes {
    let ranges = sides.map(|[low, high]| Range::between(Some(number(low)), Some(number(high))));
    let request = BoxRequest::new(ranges, number(undecided));
    let problem = model.ask().free(names[0]).free(names[1]).plane_problem().unwrap();
    let asked = [damping(least)];
    let found = problem.required_map_by((MapMethod::Auto, &request), (&asked, None), 6, &Budget::unlimited());
    match found.unwrap() {
        MapOrBoxes::Boxes(boxes) => boxes.value().clone(),
        other => panic!("boxes were expected: {other:?}"),
    }
}

fn tolerance(model: &Model, list: &[(&str, &str)], least: &str) -> ToleranceAnswer {
    let request = ToleranceRequest::new(list.iter().map(|(name, t)| (*name, t.parse().unwrap())));
    let gap = if is_thorough() { "1e-4" } else { "1e-2" };
    let request = request.gap(number(gap)).require([damping(least)], None);
    model.ask().tolerance(&request, &Budget::unlimited()).unwrap().into_value()
}

/// The root `-a b` has the damping of 3/5 while `a b <= exp(-3 pi/4)`.
const PRODUCT: &str = "a = { nominal = '1/4' }\nb = { nominal = '1/4' }";

#[test]
fn a_negative_root_has_the_damping_below_a_hyperbola() {
    let boxes = map(&model(PRODUCT, "z + a*b"), ["a", "b"], [["0.1", "1"], ["0.1", "1"]], "3/5", "1/25");
    let areas = &boxes.required.as_ref().expect("asked for").areas;
    let [met, undecided] = [&areas.met, &areas.undecided].map(Rational::to_f64_approximate);
    // From a = 10 e to 1 the least of e/a and 1, less 0.1.
    let e = (-0.75 * PI).exp();
    let area = e * (1.0f64 / 0.1).ln() - 0.1 * (10.0 * e - 0.1);
    assert!(met <= area && area <= met + undecided && undecided < 0.04, "{met} {area} {undecided}");
}

/// Over rational numbers and constants: the factor of the box from the formula of the root.
#[test]
#[ignore = "long: CI runs it"]
fn the_factor_of_a_box_is_that_of_the_root() {
    let e = (-0.75 * PI).exp();
    let products = [
        // (1/4 + f/40)^2 = e
        (PRODUCT, "z + a*b", ["a", "b"], 40.0 * (e.sqrt() - 0.25)),
        // a b exp(-1/10) = e
        (PRODUCT, "z + a*b*exp(-1/10)", ["a", "b"], 40.0 * ((e * 0.1f64.exp()).sqrt() - 0.25)),
    ];
    for (parameters, characteristic, list, known) in tried(products, 2) {
        let found = tolerance(&model(parameters, characteristic), &list.map(|name| (name, "10%")), "3/5");
        let factor = found.factor.expect("a factor");
        let [low, high] = [&factor.lower, &factor.upper.expect("an end")].map(Rational::to_f64_approximate);
        assert!(
            low <= known && known <= high + 1e-9 && high - low < 1e-3 * count(50, 1) as f64,
            "{characteristic}: {low} {known} {high}"
        );
        assert!(found.decision.is_stable() && found.binding == Some(0));
    }
}

/// The same over functions.
#[test]
#[ignore = "long: CI runs it"]
fn the_factor_of_a_box_over_functions_is_that_of_the_root() {
    let e = (-0.75 * PI).exp();
    // K - exp(-a) <= e, both a tenth of a half of their nominal values away.
    let functions = model("K = { nominal = '1/2' }\na = { nominal = '3/4' }", "z + K - exp(-a)");
    let found = tolerance(&functions, &[("K", "10%"), ("a", "10%")], "3/5");
    let factor = found.factor.expect("a factor");
    let left = |f: &Rational| {
        let f = f.to_f64_approximate();
        e - (0.5 + 0.05 * f - (-0.75 - 0.075 * f).exp())
    };
    let upper = factor.upper.expect("an end");
    assert!(left(&factor.lower) > 0.0 && left(&upper) < 1e-9, "{} {upper}", factor.lower);
    assert!(&upper - &factor.lower < number("1e-3"));
}

/// One name alone: the box goes as far as the set of the requirement, which is found along the spiral by itself.
#[test]
#[ignore = "long: CI runs it"]
fn the_box_of_one_name_ends_where_its_set_does() {
    let model = model("K = { nominal = '1/20' }\nq = { nominal = '1/2' }", "(z - 1)*(z - 3/5)*z + K*(z + q)");
    let found = tolerance(&model, &[("K", "-0%..+10%")], "1/2");
    let factor = found.factor.expect("a factor");
    let problem = model.ask().free("K").problem().unwrap();
    let set = problem.required_set(&[damping("1/2")], None, &Budget::unlimited()).unwrap();
    let upper = set.value().intervals[0].upper.as_ref().expect("an end").value();
    let [proved, refuted] = [&factor.lower, factor.upper.as_ref().unwrap()].map(|f| found.sides[0].at(f)[1].clone());
    assert!(upper.compare_rational(&proved).is_gt() && upper.compare_rational(&refuted).is_le(), "{proved} {refuted}");
    assert!(&refuted - &proved < number("1e-4"));
}

#[test]
#[ignore = "long: CI runs it"]
fn a_box_that_has_not_the_damping_is_refuted_by_a_point() {
    let loop_of = model(PRODUCT, "z + a*b");
    let found = tolerance(&loop_of, &[("a", "50%"), ("b", "50%")], "3/5");
    let BoxDecision::NotStable { witness: Some(witness) } = found.decision else { panic!("{:?}", found.decision) };
    let product = &witness.point[0] * &witness.point[1];
    assert!(product.to_f64_approximate() > (-0.75 * PI).exp() - 1e-12);
    // And where the nominal point is not good enough.
    let found = tolerance(&loop_of, &[("a", "5%"), ("b", "5%")], "7/10");
    assert!(matches!(found.decision, BoxDecision::NotStable { witness: Some(_) }) && found.factor.is_none());
}

/// For all `b` up to 1/2: `a <= 2 exp(-3 pi/4)`.
#[test]
fn a_damping_holds_for_all_values_of_another_name() {
    let model = model(&format!("{PRODUCT}\nc = {{ nominal = 0 }}"), "z + a*b + c");
    let side = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([side("0", "1"), side("-1/1000", "0")], number("1/20"));
    let for_all = MapForAll::new(vec![AllOf::new("b", number("1/4"), number("1/2")).unwrap()]);
    let for_all = for_all.with_requirements(vec![damping("3/5")], None);
    let found = for_all.boxes(model.ask().free("a").free("c"), &request, &Budget::unlimited()).unwrap().into_value();
    let e = (-0.75 * PI).exp();
    // The root is -(a/2 + c).
    let area = 1e-3 * (2.0 * e + 1e-3);
    let areas = &found.required.expect("asked for").areas;
    let [met, undecided] = [&areas.met, &areas.undecided].map(Rational::to_f64_approximate);
    assert!(met <= area && area <= met + undecided, "{met} {area} {undecided}");
}

/// The least damping of the roots of `z^2 + p z + q`, in floating point.
fn least_damping([p, q]: [f64; 2]) -> f64 {
    let of = |modulus: f64, angle: f64| -modulus.ln() / modulus.ln().hypot(angle);
    let square = p * p / 4.0 - q;
    if square < 0.0 {
        let modulus = q.sqrt();
        return of(modulus, (-p / 2.0 / modulus).acos());
    }
    let roots = [-p / 2.0 + square.sqrt(), -p / 2.0 - square.sqrt()];
    roots.map(|r| of(r.abs(), if r < 0.0 { PI } else { 0.0 })).into_iter().fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// Of a quadratic polynomial: points drawn in boxes have the damping that the boxes say, by their roots.
    #[test]
    fn points_of_boxes_have_the_damping_of_their_roots(
        p in -15i64..10, q in -8i64..8, least in 1i64..9, shares in prop::array::uniform2(1i64..=9),
    ) {
        let model = model("p = { nominal = 0 }\nq = { nominal = 0 }", "z^2 + p*z + q");
        let tenths = |n: i64| format!("{n}/10");
        let [low, high] = [tenths(p), tenths(p + 6)];
        let [bottom, top] = [tenths(q), tenths(q + 4)];
        let sides = [[low.as_str(), high.as_str()], [bottom.as_str(), top.as_str()]];
        let boxes = map(&model, ["p", "q"], sides, &tenths(least), "1/10");
        for found in &boxes.required.expect("asked for").boxes {
            let Some(is_met) = found.met else { continue };
            let at = |([low, high], share): (&[Rational; 2], i64)| {
                (low + &(&(high - low) * &Rational::new(share.into(), 10.into()))).to_f64_approximate()
            };
            let point = [at((&found.window.x, shares[0])), at((&found.window.y, shares[1]))];
            let own = least_damping(point);
            let asked = least as f64 / 10.0;
            prop_assert!(if is_met { own > asked - 1e-9 } else { own < asked + 1e-9 }, "{:?} {} {}", point, own, is_met);
        }
    }
}
