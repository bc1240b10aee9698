//! Boxes whose boundary is touched, or is several boundaries at once: brackets close, and their factors are exact.

use crate::helpers::model::load;
use crate::helpers::number::number;
use jurist::{Ask, Document, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use jurist_engine::stability::AtPoint;
use jurist_engine::stability::boxes::BoxDecision;
use proptest::prelude::*;

/// Names with a nominal value and an absolute tolerance.
type Names<'n> = [(&'n str, &'n str, &'n str)];

fn answer(time: &str, characteristic: &str, names: &Names) -> Answer<ToleranceAnswer> {
    let name = |(name, nominal, width): &(&str, &str, &str)| {
        format!("{name} = {{ nominal = '{nominal}', tolerance = '{width}' }}\n")
    };
    let parameters: String = names.iter().map(name).collect();
    let text = format!("time = '{time}'\n[parameters]\n{parameters}[loop]\ncharacteristic = '{characteristic}'\n");
    let model = load(&text);
    let request = ToleranceRequest::of_model(&model).exact();
    model.ask().tolerance(&request, &Budget::unlimited()).unwrap()
}

/// The bracket holds the factor and is as narrow as it was asked for.
fn closes(answer: &Answer<ToleranceAnswer>, truth: &Rational) {
    let factor = answer.value().factor.as_ref().unwrap();
    let upper = factor.upper.as_ref().expect("an end");
    assert!(factor.lower < *truth && truth <= upper, "{} < {truth} <= {upper}", factor.lower);
    assert!(upper - &factor.lower <= upper * &number("1/500000"), "{} to {upper}", factor.lower);
    assert!(factor.open.is_none(), "{:?}", factor.open);
}

fn is_exactly(answer: &Answer<ToleranceAnswer>, truth: &str) {
    closes(answer, &number(truth));
    assert_eq!(answer.value().exact.as_ref().expect("an exact factor").value.exact(), Some(number(truth)));
}

#[test]
fn an_unstable_region_that_no_line_to_a_corner_meets_is_found() {
    let characteristic = "s^4 + (2.8 + b^2/4)*s^3 + (3.3 + a^2/4)*s^2 + 3.3*s + 1.5 + c/20";
    let names = [("a", "1.5", "1.5"), ("b", "-1.5", "0.75"), ("c", "-1.8", "1.8")];
    let found = answer("continuous", characteristic, &names);
    // a = 0 inside of its side, b and c at their ends.
    let exact = found.value().exact.as_ref().expect("an exact factor");
    assert_eq!(exact.value.decimal(12), "2.37007440150");
    closes(&found, &exact.value.refined_to_digits(12).enclosure().0);
    // (a, b, c) = (1.5, -6, 9) is in the box six times as large.
    let names = [("a", "1.5", "9"), ("b", "-1.5", "4.5"), ("c", "-1.8", "10.8")];
    let found = answer("continuous", characteristic, &names);
    assert!(
        matches!(found.value().decision, BoxDecision::NotStable { witness: Some(_) }),
        "{:?}",
        found.value().decision
    );
}

#[test]
fn roots_that_only_touch_the_axis_bound_the_factor() {
    let line = "s^2 + (a - b)^2*s + 1";
    is_exactly(&answer("continuous", line, &[("a", "3", "1"), ("b", "1", "0.5")]), "4/3");
    // The box holds points of the line a = b.
    let found = answer("continuous", line, &[("a", "3", "3"), ("b", "1", "1.5")]);
    is_exactly(&found, "4/9");
    let BoxDecision::NotStable { witness: Some(witness) } = &found.value().decision else {
        panic!("{:?}", found.value().decision)
    };
    assert!(matches!(&witness.at, Some(AtPoint::Defined { count, .. }) if (count.on, count.outside) == (2, 0)));
    let beside = "(s^2 + (a - b)^2*s + 1)*(s + a)";
    is_exactly(&answer("continuous", beside, &[("a", "3", "1"), ("b", "1", "0.5")]), "4/3");
    // The sum of squares vanishes without a change of its sign.
    let names = [("a", "3", "1"), ("b", "1", "0.5"), ("c", "2", "0.9")];
    let found = answer("continuous", "s^2 + ((a - b)^2 + (c - 1)^2)*s + 1", &names);
    closes(&found, &number("4/3"));
    // The product of the roots is 1 at a = b.
    let discrete = "z^2 - (1 - (a - b)^2/100)*z + 1 - (a - b)^2/100";
    is_exactly(&answer("discrete", discrete, &[("a", "3", "1"), ("b", "1", "0.5")]), "4/3");
}

#[test]
fn a_narrow_stripe_is_met() {
    let stripe = "s^2 + ((a - b)^2 - 1/1000000)*s + 1";
    is_exactly(&answer("continuous", stripe, &[("a", "3", "1"), ("b", "1", "0.5")]), "1999/1500");
}

#[test]
fn corners_at_which_several_boundaries_meet_are_exact() {
    let names = [("a", "1", "0.1"), ("b", "1", "0.1")];
    is_exactly(&answer("continuous", "(s + a)*(s + b)", &names), "10");
    let names = [("a", "1", "0.2"), ("b", "1", "0.2"), ("c", "0.5", "0.1")];
    is_exactly(&answer("continuous", "s^3 + a*s^2 + b*s + a*b*c", &names), "5");
}

#[test]
fn a_box_that_ends_just_beyond_the_one_that_was_asked_for_has_a_narrow_bracket() {
    is_exactly(&answer("continuous", "s^2 + a*s + b", &[("a", "1", "0.9998"), ("b", "2", "1")]), "5000/4999");
}

#[test]
fn a_bracket_that_stays_open_says_so_in_its_document() {
    // Touched at b = 1, a^2 = 2 alone: no rational point shows it.
    let names = [("a", "3", "1"), ("b", "2", "0.3")];
    let found = answer("continuous", "s^2 + ((a^2 - 2)^2 + (b - 1)^2)*s + 1", &names);
    let factor = found.value().factor.as_ref().unwrap();
    assert!(factor.lower > number("3.3333") && factor.lower < number("10/3") && factor.upper.is_none());
    let document = serde_json::to_value(found.json(12)).unwrap();
    assert_eq!(document["factor"]["open"]["budget"], "a divisor or a real root near zero");
    assert!(document["factor"]["open"]["reached"].as_str().unwrap().starts_with("a from "));
    assert_eq!((&document["verdict"], &document["undecided"]), (&"stable".into(), &serde_json::Value::Null));
    assert!(found.text(12).contains("a narrower bracket is undecided: a divisor or a real root near zero"));
    let closed = answer("continuous", "s^2 + a*s + b", &names);
    assert!(serde_json::to_value(closed.json(12)).unwrap()["factor"].get("open").is_none());
}

/// A linear function of two parameters around a nominal point, and the factor at which it comes to a number.
fn factor_of([p, q, r]: [i64; 3], at: [i64; 2], widths: [i64; 2], least: &Rational) -> Option<Rational> {
    let value = Rational::from((p * at[0] + q * at[1] - r).abs());
    let reach = Rational::new((p.abs() * widths[0] + q.abs() * widths[1]).into(), 10.into());
    (&value - least).checked_div(&reach).filter(|factor| factor.sign().is_gt())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// `s^2 + (f^2 - e^2) s + 1` times `s + g`, for linear `f` and `g`: stable where `|f| > e` and `g > 0`.
    #[test]
    fn brackets_of_stripes_in_any_direction_close(
        f in [-4i64..=4, -4i64..=4, -9i64..=9],
        g in [-4i64..=4, -4i64..=4, -9i64..=9],
        at in [-5i64..=5, -5i64..=5],
        widths in [1i64..=9, 1i64..=9],
        e in prop_oneof![Just("0"), Just("1/7"), Just("1/1000")],
    ) {
        prop_assume!(g[0] * at[0] + g[1] * at[1] > g[2]);
        let ends = [factor_of(f, at, widths, &number(e)), factor_of(g, at, widths, &Rational::ZERO)];
        let [Some(first), Some(second)] = ends else { return Err(TestCaseError::reject("not stable, or no end")) };
        let linear = |[p, q, r]: [i64; 3]| format!("({p})*a + ({q})*b - ({r})");
        let characteristic = format!("(s^2 + (({})^2 - ({e})^2)*s + 1)*(s + {})", linear(f), linear(g));
        let at = at.map(|x| x.to_string());
        let widths = widths.map(|w| format!("{}.{}", w / 10, w % 10));
        let found = answer("continuous", &characteristic, &[("a", &at[0], &widths[0]), ("b", &at[1], &widths[1])]);
        closes(&found, &first.min(second));
    }
}
