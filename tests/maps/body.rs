//! Maps at values of a third parameter: slices against verdicts, against the loop in three parameters, and against polygons that are
//! known by hand.

use crate::helpers::model::{example, read};
use crate::helpers::number::number;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::Domain;
use jurist_engine::answer::{Answer, Body, SliceValues, StretchEnd, Verdict};
use jurist_engine::model::Model;
use proptest::prelude::*;

fn body(model: &Model, [x, y]: [&str; 2], slices: (&str, &str, &str, usize)) -> Answer<Body> {
    let (name, lower, upper, count) = slices;
    let values = SliceValues::evenly(name, &number(lower), &number(upper), count).unwrap();
    let narrow = values.width() / Rational::from(1000);
    model.ask().free(x).free(y).body(&values, &narrow, 8, &Budget::unlimited()).unwrap()
}

fn ratio(p: i64, q: i64) -> Rational {
    Rational::new(p.into(), q.into())
}

/// The stabilising gains of `examples/pid-body.toml` by hand, where `root^2 = 6 - 4 K_p`.
///
/// `D(z)/z` is real on the circle at the angles where `4 c^2 - 2 c - 5/4 + K_p = 0`, at 0 and at pi, and all four roots are inside
/// exactly where it turns by three half turns: where it is positive at 0 and then changes its sign from each of these points to the
/// next.
fn is_stabilising(root: &Rational, [k_i, k_d]: [&Rational; 2]) -> bool {
    let k_p = (Rational::from(6) - root * root) / Rational::from(4);
    if k_p <= ratio(-3, 4) || k_p >= ratio(3, 2) {
        return false;
    }
    let quarter = ratio(1, 4);
    let [first, second] = [Rational::ONE + root, Rational::ONE - root].map(|c| c * &quarter);
    let real_part = |c: &Rational| {
        let cubic = ((ratio(4, 1) * c - ratio(2, 1)) * c - ratio(13, 4)) * c + ratio(5, 4);
        cubic + (&k_p + Rational::from(2) * k_d) * (c - Rational::ONE) + k_i
    };
    let at_minus_one = ratio(3, 2) + Rational::from(2) * &k_p - k_i + Rational::from(4) * k_d;
    k_i.sign().is_gt()
        && at_minus_one.sign().is_gt()
        && real_part(&first).is_negative()
        && real_part(&second).sign().is_gt()
}

fn verdict(k_p: &Rational, k_i: &Rational, k_d: &Rational) -> Verdict {
    let question = example("pid-body").ask().set("K_p", k_p.clone()).set("K_i", k_i.clone()).set("K_d", k_d.clone());
    question.verdict(&Budget::unlimited()).unwrap().value().verdict
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(8, 20) as u32))]

    /// 15 points each.
    #[test]
    fn points_of_the_body_have_their_verdict_and_that_of_the_polygon(
        roots in proptest::collection::btree_set(0i64..=14, 2), points in proptest::collection::vec((-60i64..=500, -250i64..=250), 15),
    ) {
        // From -7/8 to 3/2 in steps that make 6 - 4 K_p the square of a quarter.
        let k_p = |root: i64| (Rational::from(6) - ratio(root * root, 16)) / Rational::from(4);
        let mut ends: Vec<i64> = roots.into_iter().collect();
        ends.reverse();
        let model = example("pid-body");
        let values = SliceValues::evenly("K_p", &k_p(ends[0]), &k_p(ends[1]), 2).unwrap();
        let answer = model.ask().free("K_i").free("K_d").body(&values, &Rational::ONE, 6, &Budget::unlimited()).unwrap();
        for (slice, root) in answer.value().slices.iter().zip(ends) {
            let map = slice.map.as_ref().unwrap();
            let decomposition = &map.value().decomposition;
            for (p, q) in &points {
                let (x, y) = (ratio(*p, 200), ratio(*q, 200));
                let stable = is_stabilising(&ratio(root, 4), [&x, &y]);
                prop_assert_eq!(verdict(&slice.value, &x, &y) == Verdict::Stable, stable);
                let domain = &map.problem().axes()[1].domain;
                let place = decomposition.locate(&x, &y, domain, &Budget::unlimited()).unwrap();
                if let Some((strip, cell)) = place {
                    prop_assert_eq!(decomposition.strips[strip].cells[cell].stable, stable);
                } else {
                    prop_assert!(!stable || decomposition.slice(&x, domain, &Budget::unlimited()).unwrap().is_none());
                }
            }
        }
    }

    #[test]
    fn ends_of_the_body_are_in_their_brackets(below in 1i64..40, above in 1i64..40, count in 2usize..6) {
        let (lower, upper) = (ratio(-3, 4) - ratio(below, 16), ratio(3, 2) + ratio(above, 16));
        let values = SliceValues::evenly("K_p", &lower, &upper, count).unwrap();
        let narrow = ratio(1, 50);
        let question = example("pid-body").ask().free("K_i").free("K_d");
        let answer = question.body(&values, &narrow, 6, &Budget::unlimited()).unwrap();
        let inside = |v: &Rational| *v > ratio(-3, 4) && *v < ratio(3, 2);
        for slice in &answer.value().slices {
            prop_assert_eq!(slice.has_stable_points(), Some(inside(&slice.value)));
        }
        for end in answer.value().stretches.iter().flat_map(|s| &s.ends) {
            let StretchEnd::Between { stable, none, stopped: None } = end else { panic!("{end:?}") };
            prop_assert!(inside(stable) && !inside(none) && (stable - none).abs() <= narrow);
        }
    }
}

/// A coefficient in three parameters with few terms.
fn coefficient() -> impl Strategy<Value = String> {
    let term = (-6i64..=6, prop::sample::select(vec!["1", "a", "b", "c", "a*b", "a*c", "b*c", "c^2", "a^2", "b^2*c"]));
    proptest::collection::vec(term, 1..=3)
        .prop_map(|terms| terms.iter().map(|(k, m)| format!("({k})/8*{m}")).collect::<Vec<_>>().join(" + "))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(5, 16) as u32))]

    #[test]
    fn points_of_random_bodies_have_their_verdict(
        low in proptest::collection::vec(coefficient(), 1..=3), continuous: bool, ends in (-30i64..0, 0i64..30), count in 2usize..=4,
        points in proptest::collection::vec((-200i64..=200, 1i64..=60, -200i64..=200), 8),
    ) {
        let (time, z) = if continuous { ("continuous", "s") } else { ("discrete", "z") };
        let powers = low.iter().enumerate().map(|(k, c)| format!("({c})*{z}^{k}")).collect::<Vec<_>>().join(" + ");
        let model = read(&format!(
            "time = '{time}'\n[parameters]\na = {{}}\nb = {{}}\nc = {{}}\n[loop]\ncharacteristic = '{z}^{} + {powers}'\n", low.len()
        ));
        let values = SliceValues::evenly("c", &ratio(ends.0, 7), &(ratio(ends.1, 5) + ratio(1, 9)), count).unwrap();
        let budget = Budget::unlimited();
        let answer = model.ask().free("a").free("b").body(&values, &Rational::ONE, 6, &budget).unwrap();
        for slice in &answer.value().slices {
            let map = slice.map.as_ref().unwrap();
            let (decomposition, domain) = (&map.value().decomposition, &map.problem().axes()[1].domain);
            for (p, q, r) in &points {
                let (x, y) = (ratio(*p, *q), ratio(*r, *q));
                let point = model.ask().set("a", x.clone()).set("b", y.clone()).set("c", slice.value.clone());
                let stable = point.verdict(&budget).unwrap().value().verdict == Verdict::Stable;
                prop_assert!(!stable || slice.has_stable_points() == Some(true));
                if let Some((strip, cell)) = decomposition.locate(&x, &y, domain, &budget).unwrap() {
                    prop_assert_eq!(decomposition.strips[strip].cells[cell].stable, stable);
                }
            }
        }
    }
}

/// The polynomial of a slice is that of the loop in three parameters with the value put in.
#[test]
fn slices_are_specialisations_where_the_third_is_a_parameter() {
    let budget = Budget::unlimited();
    for (model, axes, slices) in [
        (example("pid-body"), ["K_i", "K_d"], ("K_p", "-1", "2", 5)),
        (example("drive"), ["K_pi", "K_pwm"], ("T", "1e-5", "3e-4", 3)),
        (example("drive-blocks"), ["K_pwm", "T"], ("R_a", "1", "3", 2)),
    ] {
        let answer = body(&model, axes, slices);
        let whole = answer.problem().algebra(&budget).unwrap().polynomial().unwrap();
        assert_eq!(whole.variables.len(), 3);
        for slice in &answer.value().slices {
            let problem = slice.map.as_ref().unwrap().problem();
            let own = problem.algebra(&budget).unwrap().polynomial().unwrap();
            let put_in: Vec<_> = whole.coefficients.iter().map(|c| c.substitute(2, &slice.value).unwrap()).collect();
            assert_eq!((own.formal_degree, &own.coefficients), (whole.formal_degree, &put_in));
        }
    }
}

/// The corners of the polygons, by hand from the lines of [`is_stabilising`].
#[test]
fn the_polygons_have_their_corners() {
    let corners = [
        ("2", "1/2", vec![("0", "-5/8"), ("1/2", "-1/2"), ("5/4", "1"), ("0", "1/2")]),
        ("1", "5/4", vec![("0", "-1"), ("2", "1"), ("0", "0")]),
        ("5/2", "-1/16", vec![("0", "-11/32"), ("3/8", "-1/4"), ("11/16", "1"), ("0", "3/4")]),
    ];
    for (root, k_p, corners) in corners {
        let answer = body(&example("pid-body"), ["K_i", "K_d"], ("K_p", k_p, "2", 2));
        let slice = &answer.value().slices[0];
        let map = slice.map.as_ref().unwrap().value();
        assert_eq!(map.decomposition.regions.len(), 1, "{k_p}");
        let points: Vec<[Rational; 2]> = corners.iter().map(|(x, y)| [number(x), number(y)]).collect();
        let count = Rational::from(points.len() as i64);
        let sum = |k: usize| points.iter().fold(Rational::ZERO, |s, p| s + &p[k]);
        let centre = [sum(0) / &count, sum(1) / &count];
        for point in &points {
            // Lines through the point: both of complex pairs are one curve.
            let lines = map.decomposition.curves.iter().map(|curve| {
                let mut over = curve.polynomial.substitute(0, &point[0]).0.to_univariate(1).unwrap();
                let mut times = usize::from(over.is_zero());
                while !over.is_zero() && over.sign_at(&point[1]).is_eq() {
                    times += 1;
                    over = over.derivative();
                }
                times
            });
            assert!(lines.sum::<usize>() >= 2, "{k_p}: no two lines meet at {point:?}");
            let towards = |part: &str| [0, 1].map(|k| &point[k] + &((&centre[k] - &point[k]) * number(part)));
            for (part, stable) in [("1e-30", true), ("-1e-30", false)] {
                let [x, y] = towards(part);
                assert_eq!(verdict(&slice.value, &x, &y) == Verdict::Stable, stable, "{k_p} {point:?}");
                assert_eq!(is_stabilising(&number(root), [&x, &y]), stable, "{k_p} {point:?}");
            }
        }
        let ends = |k: usize| {
            let of = points.iter().map(|p| p[k].clone());
            [of.clone().min().unwrap(), of.max().unwrap()]
        };
        for (k, extent) in slice.extent.as_ref().unwrap().iter().enumerate() {
            let found = [&extent.lower, &extent.upper].map(|end| end.as_ref().unwrap().exact().unwrap());
            assert_eq!(found, ends(k), "{k_p}");
        }
    }
}
