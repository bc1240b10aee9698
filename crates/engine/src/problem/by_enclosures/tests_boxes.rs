//! Coefficients by values against exact ones, on loops that are short enough for both.

use super::*;
use crate::answer::{BoxRequest, MapMethod, MapOrBoxes, ToleranceRequest, Verdict};
use crate::model::{Cut, Model};
use crate::problem::{Algebra, Ask, parametric_symbols};
use crate::stability::boxes::MovingLooks;
use crate::stability::plane::boxes::BoxVerdict;
use crate::stability::{AtPoint, Range};
use jurist_algebra::ball::Series;

/// So many modes in a row or side by side behind a hold, with an integrating controller.
fn model(modes: &[(&str, &str)], joined: &str) -> Arc<Model> {
    let names = modes.iter().enumerate().map(|(i, (w, d))| {
        format!("w{i} = {{ nominal = \"{w}\", min = \"1/10\" }}\nd{i} = {{ nominal = \"{d}\", min = 0 }}\n")
    });
    let plant = (0..modes.len()).map(|i| format!("w{i}^2/(s^2 + 2*d{i}*w{i}*s + w{i}^2)"));
    let text = format!(
        r#"
        time = "discrete"
        sample_time = "T"
        [parameters]
        T = {{ nominal = "1/20", min = 0 }}
        K = {{ nominal = "1/5", min = 0 }}
        Ki = {{ nominal = "1/10", min = 0 }}
        {}
        [loop]
        inputs = ["r"]
        outputs = ["y"]
        [[block]]
        input = "r - y"
        output = "u"
        transfer = "K + Ki*T/(z - 1)"
        [[block]]
        input = "u"
        output = "y"
        transfer = "{}"
        discretize = {{ method = "zoh" }}
        "#,
        names.collect::<String>(),
        plant.collect::<Vec<_>>().join(joined)
    );
    Arc::new(Model::from_toml(&crate::error::Source::new("loop.toml", &text)).unwrap().0)
}

fn number(text: &str) -> Rational {
    text.parse().unwrap()
}

fn free(model: &Arc<Model>, names: &[&str]) -> Arc<Problem> {
    names.iter().fold(model.ask(), |ask, name| ask.free(*name)).problem().unwrap()
}

/// The coefficients of the monic polynomial at a point.
pub(super) fn at(algebra: &Algebra, point: &[&str]) -> Vec<Ball> {
    let symbols = parametric_symbols(algebra.symbols()).unwrap();
    let point: Vec<Series> = point.iter().map(|x| Series::constant(&Ball::from_rational(&number(x), 256), 1)).collect();
    let values = symbols.values(&point).unwrap();
    let value = |p: &MultiPoly| symbols.value(p, &values).coefficients()[0].clone();
    let polynomial = algebra.polynomial().unwrap();
    let all = |f: &RationalFunction| value(f.numerator()).div(&value(f.denominator())).unwrap();
    polynomial.coefficients.iter().map(all).collect()
}

#[test]
fn coefficients_by_values_are_the_exact_ones() {
    let budget = Budget::unlimited();
    let one = model(&[("3", "1/5")], " + ");
    let two = model(&[("3", "1/5"), ("5", "3/10")], " * ");
    for (model, names, points) in [
        (&one, vec!["K", "Ki"], [["1/3", "2"], ["0", "-1"]]),
        (&one, vec!["K", "w0"], [["1/3", "2"], ["5", "7/2"]]),
        (&one, vec!["T", "d0"], [["1/3", "1/2"], ["2", "3"]]),
        (&two, vec!["w1", "Ki"], [["4", "1/7"], ["1/2", "3"]]),
    ] {
        let problem = free(model, &names);
        for radius in ["1", "3/4"] {
            let within = Region::disc(number(radius)).unwrap();
            let asked = names.iter().fold(model.ask().within(within), |ask, name| ask.free(*name)).problem().unwrap();
            let exact = asked.algebra_over_symbols(&budget).unwrap();
            let by_values = problem.coefficients_by_values(&number(radius), &budget).unwrap().expect("of this form");
            assert_eq!(
                (by_values.formal_degree(), by_values.sample_time()),
                (exact.formal_degree(), exact.sample_time())
            );
            for point in &points {
                let (exact, found) = (at(exact, point), at(&by_values, point));
                let lead = exact.last().unwrap().clone();
                for (a, b) in exact.iter().zip(&found) {
                    let a = a.div(&lead).unwrap();
                    assert!(a.intersection(b).is_some() && b.width_units().bit_length() < 80, "{names:?} {point:?}");
                }
            }
        }
    }
}

#[test]
fn open_loops_by_values_are_the_exact_ones() {
    let budget = Budget::unlimited();
    let model = model(&[("3", "1/5")], " + ");
    let opened = |names: &[&str], cut: Cut| free(&model, names).opened_by_values(&cut, &budget).unwrap();
    for names in [["K", "Ki"], ["K", "w0"], ["T", "d0"]] {
        let found = opened(&names, Cut::Signal("u".to_owned())).expect("of this form");
        let symbols = parametric_symbols(&found.symbols).unwrap();
        for point in [["1/3", "2"], ["5", "7/2"]] {
            let series: Vec<Series> =
                point.iter().map(|x| Series::constant(&Ball::from_rational(&number(x), 256), 1)).collect();
            let values = symbols.values(&series).unwrap();
            let value = |p: &MultiPoly| symbols.value(p, &values).coefficients()[0].clone();
            // The closed loop is D0 + N; without gains there is D0 alone.
            let exact = |off: &[&str]| {
                let others = off.iter().filter(|name| !names.contains(name));
                let question = others.fold(model.ask(), |ask, name| ask.set(*name, 0));
                let problem = names.iter().fold(question, |ask, name| ask.free(*name)).problem().unwrap();
                let there: Vec<&str> =
                    names.iter().zip(point).map(|(name, x)| if off.contains(name) { "0" } else { x }).collect();
                at(problem.algebra_over_symbols(&budget).unwrap(), &there)
            };
            let (closed, open) = (exact(&[]), exact(&["K", "Ki"]));
            for k in 0..closed.len() {
                let [d, n] = [&found.denominator, &found.numerator].map(|p| value(&p.coeff(k)));
                assert!(d.intersection(&open[k]).is_some() && d.add(&n).intersection(&closed[k]).is_some());
            }
        }
    }
    assert!(opened(&["K", "T"], Cut::Gain("Ki".to_owned())).is_none());
}

/// A map and a box of tolerances by values; exact algebra tells the points, and where it is short all boxes.
#[test]
#[ignore = "long: CI runs it"]
fn boxes_by_values_are_those_of_exact_coefficients() {
    let budget = Budget::unlimited();
    let model = model(&[("3", "1/5"), ("5", "3/10")], " + ");
    // Some of the boxes by default, all in CI.
    let every = if std::env::var_os("JURIST_THOROUGH").is_some() { 1 } else { 40 };
    for (names, sides) in [(["K", "Ki"], [("0", "6"), ("0", "6")]), (["K", "w0"], [("0", "6"), ("2", "4")])] {
        let plane = names.iter().fold(model.ask(), |ask, name| ask.free(*name)).plane_problem().unwrap();
        let radius = Rational::ONE;
        let by_values = plane.with_algebra(plane.coefficients_by_values(&radius, &budget).unwrap().unwrap());
        plane.in_boxes.get_or_init(|| Some(Arc::new(by_values)));
        let side = |(low, high)| Range::between(Some(number(low)), Some(number(high)));
        let request = BoxRequest::new(sides.map(side), number("1/12"));
        let map = plane.map_by(MapMethod::Boxes, &request, 6, &budget).unwrap();
        let MapOrBoxes::Boxes(map) = map else { panic!("boxes") };
        let found = &map.value().boxes;
        assert!(found.areas.stable.sign().is_gt() && found.areas.unstable.sign().is_gt() && found.stopped.is_none());
        for one in found.boxes.iter().filter(|b| b.verdict != BoxVerdict::Undecided).step_by(every) {
            let point =
                [&one.window.x, &one.window.y].map(|[low, high]| &(low + low) * &number("1/6") + high * &number("2/3"));
            let asked = names.iter().zip(point).fold(model.ask(), |ask, (name, x)| ask.set(*name, x));
            let exactly = asked.problem().unwrap().verdict_exactly(&budget).unwrap();
            let outside = exactly.count.unwrap().outside;
            match one.verdict {
                BoxVerdict::Stable => assert_eq!(exactly.verdict, Verdict::Stable),
                BoxVerdict::Unstable { outside: Some(count) } => assert_eq!(count, outside),
                _ => assert_ne!(exactly.verdict, Verdict::Stable),
            }
        }
    }
}

#[test]
fn tolerances_by_values_are_those_of_exact_coefficients() {
    let budget = Budget::unlimited();
    let model = model(&[("3", "1/5")], " + ");
    let request = ToleranceRequest::new(["w0", "K"].map(|name| (name, "10%".parse().unwrap()))).gap(number("1/100"));
    let exact = model.ask().set("K", 1).tolerance(&request, &budget).unwrap();
    let problem = free(&model, &["w0", "K"]);
    let by_values =
        Arc::new(problem.with_algebra(problem.coefficients_by_values(&Rational::ONE, &budget).unwrap().unwrap()));
    let family = by_values.moving_family(&budget).unwrap().expect("functions");
    let factor = exact.value().factor.as_ref().unwrap();
    let sides: Vec<_> = exact.value().sides.clone();
    let boxes = crate::stability::boxes::ToleranceProblem::new(&family, sides).unwrap();
    let again = boxes.largest_factor(&number("1/100"), None, &budget).unwrap();
    let (low, high) = (factor.upper.as_ref().unwrap(), again.upper.as_ref().unwrap());
    assert!(again.lower <= *low && factor.lower <= *high, "{factor:?} {again:?}");
}

/// Without work left for exact algebra, the whole way of an answer.
#[test]
fn long_loops_are_asked_by_values() {
    let budget = Budget::unlimited();
    let modes = [("3", "1/5"), ("5", "3/10"), ("8", "1/4")];
    let long = model(&modes, " * ");
    let plane = long.ask().free("K").free("w1").plane_problem().unwrap();
    let in_boxes = plane.in_boxes(&budget).unwrap();
    assert!(in_boxes.algebra_over_symbols(&budget).unwrap().symbols().has_families());
    // A short one keeps its exact algebra, and so does one that is known.
    let short = model(&modes[..1], " + ").ask().free("K").free("w0").plane_problem().unwrap();
    assert!(Arc::ptr_eq(&short, &short.in_boxes(&budget).unwrap()));
    assert!(Arc::ptr_eq(&in_boxes, &in_boxes.in_boxes(&budget).unwrap()));
}

/// At rest the loop is open where the integrating part is switched off: a root at 1 that no enclosure tells.
#[test]
fn a_root_at_rest_is_told_by_numbers() {
    let budget = Budget::unlimited();
    let model = model(&[("3", "1/5"), ("5", "3/10")], " * ");
    let asked = |k: &str| model.ask().set("Ki", 0).set("K", number(k)).problem().unwrap();
    for (gain, verdict) in [("1/5", Verdict::Marginal), ("50", Verdict::Unstable)] {
        let problem = asked(gain);
        let found = problem.roots_in_numbers(&budget).unwrap();
        let Some(crate::problem::FromNumbers::Known { at: AtPoint::Defined { count, infinite: 0 }, .. }) = found else {
            panic!("{found:?}")
        };
        let exact = problem.verdict_exactly(&budget).unwrap();
        assert_eq!((exact.count, exact.verdict), (Some(count), verdict));
    }
}

/// The ends of a sample time and of constants of the plant by values, as exact polynomials have them; beside a bounded part nothing is said.
#[test]
#[ignore = "long: CI runs it"]
fn stable_sets_by_values_are_those_of_exact_coefficients() {
    let budget = Budget::unlimited();
    let model = model(&[("3", "1/5"), ("5", "3/10")], " + ");
    let all =
        [("K", "3/5", "T", "1/100", "3", 3), ("Ki", "2", "w0", "1/2", "20", 2), ("Ki", "2", "d1", "1/20", "2", 2)];
    // One of them by default, all in CI.
    let every = if std::env::var_os("JURIST_THOROUGH").is_some() { 1 } else { 3 };
    for (gain, value, name, low, high, ends) in all.into_iter().step_by(every) {
        let domain = Range::between(Some(number(low)), Some(number(high)));
        let asked = || model.ask().set(gain, number(value)).free(name).domain(name, domain.clone()).problem().unwrap();
        let (exact, long) = (asked(), asked());
        let by_values = long.with_algebra(long.coefficients_by_values(&Rational::ONE, &budget).unwrap().unwrap());
        long.in_boxes.get_or_init(|| Some(Arc::new(by_values)));
        let [expected, found] = [exact, long].map(|problem| problem.stable_set(&budget).unwrap().into_value());
        assert!(found.undecided().is_empty() && found.intervals().len() == expected.intervals().len(), "{name}");
        let all = |set: &crate::stability::StableSet| -> Vec<(String, crate::stability::Causes)> {
            let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
            ends.map(|end| (end.value.decimal(30), end.causes.clone())).collect()
        };
        assert_eq!(all(&found), all(&expected), "{name}");
        let limits = all(&found).iter().filter(|(_, causes)| !causes.contains(crate::stability::Cause::Domain)).count();
        assert_eq!(limits, ends, "{name}");
    }
}

#[test]
fn the_whole_loop_has_enclosed_coefficients_where_the_parameter_acts_on_all_of_it() {
    let budget = Budget::unlimited();
    let model = model(&[("3", "1/5"), ("5", "3/10")], " + ");
    let problem = free(&model, &["K"]);
    let whole = problem.enclosed_whole(&budget).unwrap().expect("one part");
    let exact = problem.symbolic(&budget).unwrap().unwrap();
    assert_eq!((whole.formal_degree(), whole.usual()), (5, exact.usual()));
    for k in ["-1/2", "1/5", "3", "40"] {
        let [found, expected] = [&whole, &exact].map(|p| p.at(&number(k), problem.shape(), &budget).unwrap());
        assert_eq!(found, expected, "{k}");
    }
    assert!(free(&model, &["T"]).enclosed_whole(&budget).unwrap().is_none());
}

#[test]
fn a_loop_at_values_has_enclosed_coefficients() {
    let budget = Budget::unlimited();
    let model = model(&[("3", "1/5"), ("5", "3/10")], " + ");
    for k in ["1/5", "40"] {
        let problem = model.ask().set("K", number(k)).problem().unwrap();
        let whole = problem.enclosed_whole(&budget).unwrap().expect("it is held");
        let exact = problem.symbolic(&budget).unwrap().unwrap();
        assert_eq!(whole.formal_degree(), exact.formal_degree());
        let [found, expected] = [&whole, &exact].map(|p| p.at(&Rational::ZERO, problem.shape(), &budget).unwrap());
        assert_eq!(found, expected, "{k}");
    }
}

/// What looks at boxes say of all points, exact verdicts say of some: boxes at random, and smaller and smaller ones beside a boundary.
#[test]
fn looks_that_remember_say_what_verdicts_of_points_say() {
    let (budget, model) = (Budget::unlimited(), model(&[("3", "1/5")], " + "));
    let problem = free(&model, &["K", "w0"]);
    let family = problem.moving_family(&budget).unwrap().expect("functions");
    let looks = MovingLooks::of(&family);
    let end = model.ask().free("K").set("w0", 3).stable_set(&budget).unwrap();
    let end = end.value().intervals()[0].upper.as_ref().unwrap().value.refined_to_digits(20).enclosure().0;
    let side = |at: &Rational, width: &Rational| [at.clone(), at + width];
    let mut boxes: Vec<[[Rational; 2]; 2]> = Vec::new();
    for k in 0..24i64 {
        let at = |a: i64, m: i64, over: i64| Rational::new((1 + (k * a) % m).into(), over.into());
        boxes.push([side(&at(7, 25, 1), &at(3, 4, 20)), side(&at(5, 13, 4), &at(11, 5, 40))]);
    }
    for bits in [4, 12, 20, 28] {
        let width = Rational::dyadic(&1.into(), bits);
        let point = [number("3"), number("3")];
        boxes.push([side(&(&end - &(&width + &width)), &width), point.clone()]);
        boxes.push([side(&(&end + &width), &width), point]);
    }
    let mut seen = [0, 0];
    for sides in &boxes {
        let Some(is_stable) = looks.same_stability(sides, &budget).unwrap() else { continue };
        seen[usize::from(is_stable)] += 1;
        for [x, y] in [["0", "1"], ["1", "0"], ["1/3", "2/3"]].map(|shares| shares.map(number)) {
            let point = [(&sides[0], x), (&sides[1], y)].map(|([low, high], share)| low + &(&(high - low) * &share));
            let asked = model.ask().set("K", point[0].clone()).set("w0", point[1].clone());
            let verdict = asked.problem().unwrap().verdict_exactly(&budget).unwrap().verdict;
            assert_eq!(verdict == Verdict::Stable, is_stable, "{sides:?} at {point:?}");
            assert!(looks.is_stable_at(&point).is_none_or(|told| told == is_stable));
        }
    }
    // All of the small ones beside the boundary are seen.
    let beside = boxes[24..].iter().filter(|sides| looks.same_stability(*sides, &budget).unwrap().is_some());
    assert!(seen[0] > 8 && seen[1] > 4 && beside.count() == 8, "{seen:?}");
}
