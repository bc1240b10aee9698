//! Boxes that touch, shrink or leave what is defined: each with its answer.

use crate::helpers::model::load;
use crate::helpers::number::number;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{ToleranceAnswer, ToleranceRequest};
use jurist_engine::stability::AtPoint;
use jurist_engine::stability::boxes::{BoxDecision, Witness};

fn answer(parameters: &str, characteristic: &str) -> ToleranceAnswer {
    let with_volume = |request: ToleranceRequest| request.exact().volume(number("1/100"));
    answer_to(parameters, characteristic, with_volume)
}

fn answer_to(
    parameters: &str,
    characteristic: &str,
    asked: impl Fn(ToleranceRequest) -> ToleranceRequest,
) -> ToleranceAnswer {
    let text =
        format!("time = 'continuous'\n[parameters]\n{parameters}\n[loop]\ncharacteristic = '{characteristic}'\n");
    let model = load(&text);
    let request = asked(ToleranceRequest::of_model(&model));
    model.ask().tolerance(&request, &Budget::unlimited()).unwrap().into_value()
}

fn witness(answer: &ToleranceAnswer) -> &Witness {
    match &answer.decision {
        BoxDecision::NotStable { witness: Some(witness) } => witness,
        other => panic!("a witness is expected: {other:?}"),
    }
}

/// Roots inside, on and outside.
fn counts(witness: &Witness) -> (usize, usize, usize) {
    match witness.at {
        Some(AtPoint::Defined { count, .. }) => (count.inside, count.on, count.outside),
        ref other => panic!("{other:?}"),
    }
}

fn bracket_holds(answer: &ToleranceAnswer, value: &str) {
    let factor = answer.factor.as_ref().unwrap();
    let value = number(value);
    assert!(factor.lower <= value, "{} is proved", factor.lower);
    assert!(factor.upper.as_ref().is_some_and(|upper| value <= *upper), "{:?} is refuted", factor.upper);
    assert!(&value - &factor.lower <= &value * &number("1/1000000"), "{} is close", factor.lower);
}

#[test]
fn a_box_that_touches_at_a_corner_has_a_marginal_witness_there() {
    let real =
        answer("a = { nominal = 1, tolerance = '100%' }\nb = { nominal = 2, tolerance = '10%' }", "s^2 + b*s + a");
    assert_eq!(witness(&real).point[0], Rational::ZERO);
    assert_eq!(counts(witness(&real)), (1, 1, 0));
    bracket_holds(&real, "1");
    let pair = answer("a = { nominal = 1, tolerance = '100%' }", "s^2 + a*s + 2");
    assert_eq!((witness(&pair).point[0].clone(), counts(witness(&pair))), (Rational::ZERO, (0, 2, 0)));
    bracket_holds(&pair, "1");
}

#[test]
fn a_box_that_ends_just_before_the_boundary_is_stable() {
    let near =
        answer("a = { nominal = 1, tolerance = '0.999999' }\nb = { nominal = 2, tolerance = 1 }", "s^2 + a*s + b");
    assert!(near.decision.is_stable());
}

#[test]
fn a_division_by_zero_in_the_box_is_not_stable() {
    let pole = answer("a = { nominal = 1, tolerance = '100%' }", "s + 1/a");
    assert_eq!(witness(&pole).at, Some(AtPoint::Undefined));
    assert_eq!(witness(&pole).point, [Rational::ZERO]);
    bracket_holds(&pole, "1");
    assert_eq!(pole.worst.unwrap().end.causes.to_string(), "pole");
}

/// A square keeps its sign where it vanishes; its square root does not.
#[test]
fn a_division_by_the_square_of_what_vanishes_is_not_stable() {
    let square = answer("a = { nominal = 1, tolerance = '50%' }", "s + 1 + 1/(a*a)");
    assert!(square.decision.is_stable());
    bracket_holds(&square, "2");
    assert_eq!(square.factor.unwrap().witness.unwrap().at, Some(AtPoint::Undefined));
    let wide = answer("a = { nominal = 1, tolerance = '100%' }", "s + 1 + 1/(a*a)");
    assert_eq!(witness(&wide).point, [Rational::ZERO]);
    // a^2 = 1/7 at an irrational a: 1 - a = 0.62203552699077...
    let irrational = answer("a = { nominal = 1, tolerance = 1 }", "s + 1 + 1/(a*a - 1/7)^2");
    assert!(!irrational.decision.is_stable());
    bracket_holds(&irrational, "0.62203552699077277278");
}

/// `(a - 1)^2 + (b - 1)^2` vanishes at one point, which no line from the nominal point through a corner shows.
#[test]
fn a_division_by_what_vanishes_at_one_point_is_not_stable() {
    let point = answer(
        "a = { nominal = 3, tolerance = 4 }\nb = { nominal = 2, tolerance = 4 }",
        "s + 1 + 1/((a - 1)^2 + (b - 1)^2)",
    );
    assert_eq!(witness(&point).point, [Rational::ONE, Rational::ONE]);
    assert_eq!(witness(&point).at, Some(AtPoint::Undefined));
}

/// Of `s^3 + (a + b + 1) s^2 + (a + b + 3) s + 2 a b + 6 a + 6 b + 1` only the point (1, 1) is not stable.
#[test]
fn a_single_point_that_is_not_stable_is_found() {
    let single = answer(
        "a = { nominal = 1.4, tolerance = 1.1 }\nb = { nominal = 0.85, tolerance = 0.85 }",
        "s^3 + (a + b + 1)*s^2 + (a + b + 3)*s + 2*a*b + 6*a + 6*b + 1",
    );
    assert_eq!(witness(&single).point, [Rational::ONE, Rational::ONE]);
    assert_eq!(counts(witness(&single)), (1, 2, 0));
    bracket_holds(&single, "4/11");
    assert_eq!(single.factor.unwrap().upper, Some(number("4/11")));
}

/// `a + (b^2 - 2)^2` vanishes only at `a = 0`, `b = sqrt(2)`: no rational point of the box is not stable, and none proves it stable.
#[test]
fn a_box_that_touches_at_an_irrational_point_is_undecided_with_the_cell() {
    let parameters = "a = { nominal = 1, tolerance = 1 }\nb = { nominal = 1.4, tolerance = 0.5 }";
    let real = answer(parameters, "s + a + (b^2 - 2)^2");
    let BoxDecision::Undecided { cell, .. } = &real.decision else { panic!("{:?}", real.decision) };
    let root = number("1.41421356237309504880");
    assert!(cell[1][0] <= &root + &number("1e-20") && cell[1][1] >= root && &cell[1][1] - &cell[1][0] < number("1e-6"));
    bracket_holds(&real, "1");
    // Of a pair of roots the factor is proved to be exactly 1 instead, without a rational witness.
    let pair = answer(parameters, "s^2 + (a + (b^2 - 2)^2)*s + 2");
    assert!(matches!(&pair.decision, BoxDecision::NotStable { witness: None }), "{:?}", pair.decision);
    bracket_holds(&pair, "1");
    assert_eq!(pair.exact.unwrap().value.exact(), Some(Rational::ONE));
}

/// `s + (a - u)^2 + (b - v)^2`, also with sides that are askew, is marginal at one point inside of the box and stable at all others.
#[test]
fn a_point_inside_that_is_touched_bounds_the_factor() {
    let parameters = "a = { nominal = 0, tolerance = 1 }\nb = { nominal = 0, tolerance = 1 }";
    for characteristic in
        ["s + (a - 1/3)^2 + (b - 1/3)^2", "s + (a - b/2 - 1/6)^2 + (b - 1/3)^2", "s + (a - 1/3)^2 + (b + 1/7)^2"]
    {
        let touched = answer(parameters, characteristic);
        assert!(!touched.decision.is_stable(), "{characteristic}");
        bracket_holds(&touched, "1/3");
        let upper = touched.factor.as_ref().and_then(|f| f.upper.clone()).unwrap();
        assert!(upper < number("0.33334"), "{characteristic}: {upper} is refuted");
        let volume = touched.volume.as_ref().unwrap();
        assert!(volume.unstable.is_zero() && volume.undecided <= number("1/100"), "{characteristic}: {volume:?}");
    }
    // Where the point has no rational coordinates, what is below it is proved all the same: sqrt(1/8) = 0.35355339...
    let irrational = answer(parameters, "s + (8*a^2 - 1)^2 + (b - a)^2");
    let factor = irrational.factor.as_ref().unwrap();
    assert!(factor.lower > number("0.353") && factor.lower < number("0.35356"), "{} is proved", factor.lower);
}

#[test]
fn a_division_by_what_keeps_its_sign_is_no_obstacle() {
    let quotient =
        answer("a = { nominal = 2, tolerance = '40%' }\nb = { nominal = 1, tolerance = '40%' }", "s^2 + s/a + b/a");
    assert!(quotient.decision.is_stable());
}

#[test]
fn a_lost_degree_is_the_end_of_stability() {
    let lost = answer("tau = { nominal = 1, tolerance = { low = 0.75, high = 1.5 } }", "tau*s^2 + s + 1");
    assert!(lost.decision.is_stable());
    bracket_holds(&lost, "4");
    assert_eq!(lost.worst.as_ref().unwrap().end.causes.to_string(), "infinity");
}

/// In discrete time a root that goes to infinity has left the circle before.
#[test]
fn a_degree_that_is_lost_in_discrete_time_is_within_a_box_that_is_not_stable() {
    let text = "time = 'discrete'\n[parameters]\na = { nominal = 2, tolerance = '100%' }\n[loop]\ncharacteristic = 'a*z - 1/2'\n";
    let model = load(text);
    let answer = model.ask().tolerance(&ToleranceRequest::of_model(&model).exact(), &Budget::unlimited()).unwrap();
    assert!(matches!(&answer.value().decision, BoxDecision::NotStable { witness: Some(_) }));
    bracket_holds(answer.value(), "3/4");
    assert_eq!(answer.value().worst.as_ref().unwrap().end.causes.to_string(), "z=1");
    let lost = model.ask().set("a", Rational::ZERO).verdict(&Budget::unlimited()).unwrap();
    assert_eq!(lost.value().infinite, 1);
}

#[test]
fn a_share_that_does_not_matter_is_a_number_all_the_same() {
    let small = answer(
        "a = { nominal = 1, tolerance = '50%' }\nb = { nominal = 1, tolerance = '50%' }",
        "s^2 + (a + b/1000000000)*s + 1",
    );
    bracket_holds(&small, "2");
    let shares = small.factor.as_ref().unwrap().shares.as_ref().unwrap();
    assert!((&shares[1] - number("1/1000000001")).abs() < number("1e-15"), "{}", shares[1]);
}

#[test]
fn roots_that_leave_through_zero_and_infinity_at_once() {
    let both = answer("q = { nominal = 1, tolerance = '50%' }", "q*s^2 + s + q");
    assert!(both.decision.is_stable());
    bracket_holds(&both, "2");
    assert_eq!(both.worst.as_ref().unwrap().end.causes.to_string(), "s=0+infinity");
    assert_eq!(both.exact.as_ref().unwrap().value.exact(), Some(number("2")), "two causes at once");
}

#[test]
fn a_domain_that_ends_first_is_named_and_bounds_the_factor() {
    let left = answer("a = { nominal = 1, min = 0.5, tolerance = '20%' }", "s + a");
    assert_eq!(left.domain_factor, Some(number("5/2")));
    let factor = left.factor.as_ref().unwrap();
    assert!(factor.lower < number("5/2") && factor.lower > number("2.4999"));
    assert!(
        factor.upper.as_ref().is_none_or(|upper| *upper >= number("5")),
        "a crossing is not before the domain's end"
    );
}

#[test]
fn a_nominal_point_that_is_not_stable_has_no_factor() {
    for characteristic in ["s - a", "s^2 + a", "(s^2 + 1)*(s + a)"] {
        // Where all points are marginal, halving the box for its volume ends with the number of boxes.
        let answer = answer_to("a = { nominal = 1, tolerance = '1%' }", characteristic, ToleranceRequest::exact);
        assert!(answer.factor.is_none(), "{characteristic}");
        assert_eq!(witness(&answer).point, [Rational::ONE], "{characteristic}");
    }
}

#[test]
fn a_nominal_point_on_the_boundary_of_its_box() {
    let one_sided = answer(
        "a = { nominal = 1, tolerance = ['-0%', '+50%'] }\nb = { nominal = 1, tolerance = ['-80%', '+0%'] }",
        "s^2 + b*s + a",
    );
    assert!(one_sided.decision.is_stable());
    bracket_holds(&one_sided, "5/4");
}

#[test]
fn a_tolerance_of_no_width_changes_nothing() {
    let none = answer("a = { nominal = 1, tolerance = 0 }\nb = { nominal = 1, tolerance = '50%' }", "s^2 + b*s + a");
    assert!(none.decision.is_stable());
    bracket_holds(&none, "2");
    let only = answer("a = { nominal = 1, tolerance = 0 }", "s + a");
    assert!(only.decision.is_stable() && only.factor.unwrap().upper.is_none());
}

#[test]
fn a_parameter_without_influence_has_no_share() {
    let without =
        answer("a = { nominal = 1, tolerance = '50%' }\nb = { nominal = 1, tolerance = '50%' }", "s^2 + a*s + 1 + 0*b");
    bracket_holds(&without, "2");
    assert_eq!(without.factor.unwrap().shares.unwrap()[1], Rational::ZERO);
}

#[test]
fn a_loop_that_is_always_stable_has_no_upper_end() {
    let always = answer("a = { nominal = 1, tolerance = '50%' }", "s + 1 + a^2");
    assert!(always.decision.is_stable());
    let factor = always.factor.unwrap();
    assert!(factor.upper.is_none() && factor.lower >= number("1000"));
}

#[test]
fn a_box_a_million_times_the_nominal_is_answered() {
    let wide = answer(
        "a = { nominal = 1, tolerance = { low = '1/2', high = 1000000 } }\nb = { nominal = 1, tolerance = { low = '1/2', high = 1000000 } }",
        "s^2 + a*s + b",
    );
    assert!(wide.decision.is_stable());
}

#[test]
fn too_many_tolerances_are_refused_with_the_reason() {
    let parameters: String = (0..30).map(|i| format!("p{i} = {{ nominal = 1, tolerance = '1%' }}\n")).collect();
    let product: Vec<String> = (0..30).map(|i| format!("p{i}")).collect();
    let text = format!(
        "time = 'continuous'\n[parameters]\n{parameters}[loop]\ncharacteristic = 's + {}'\n",
        product.join("*")
    );
    let model = load(&text);
    let refused = model.ask().tolerance(&ToleranceRequest::of_model(&model), &Budget::unlimited());
    assert!(refused.unwrap_err().to_string().contains("E-tolerance"));
}

/// Wei and Yedavalli: at the factor 9/8 the constant coefficient vanishes at a corner.
#[test]
fn a_factor_that_is_a_fraction_is_the_upper_end_itself() {
    let fraction =
        answer("a = { nominal = 1.5, tolerance = 1 }\nb = { nominal = 2, tolerance = 1 }", "s^2 + b*s + a - 3/8");
    assert_eq!(fraction.factor.as_ref().unwrap().upper, Some(number("9/8")));
    assert_eq!(counts(fraction.factor.as_ref().unwrap().witness.as_ref().unwrap()), (1, 1, 0));
    assert!(fraction.exact.is_some());
}

#[test]
fn a_high_degree_in_each_parameter_is_answered() {
    let high = answer(
        "a = { nominal = 1, tolerance = '5%' }\nb = { nominal = 1, tolerance = '5%' }",
        "s^3 + (1 + a^9)*s^2 + (2 + b^9)*s + a^9*b^9",
    );
    assert!(high.decision.is_stable());
}
