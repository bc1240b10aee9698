//! Shares of a box that are stable, and its largest factor as a number, where coefficients are functions of the parameters or have dead time.

use crate::helpers::model::load;
use crate::helpers::number::number;
use crate::helpers::thorough::{count, is_thorough, tried};
use jurist::Ask;
use jurist_algebra::limits::{Budget, Stop};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use jurist_engine::answer::{ToleranceAnswer, ToleranceRequest, Verdict};
use jurist_engine::model::Model;
use jurist_engine::stability::boxes::{BoxLook, BoxVolume, DelayedFunction, Family};
use jurist_engine::stability::subdivision::BoxPart;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, LN_2};

fn model(time: &str, parameters: &str, characteristic: &str) -> Model {
    load(&format!("time = '{time}'\n[parameters]\n{parameters}\n[loop]\ncharacteristic = '{characteristic}'\n"))
}

/// `z - exp(-a) + K`: stable while `exp(-a) - 1 < K < 1 + exp(-a)`.
fn first_order() -> Model {
    model("discrete", "K = { nominal = '3/2' }\na = { nominal = '1/2' }\nT = { nominal = 1 }", "z - exp(-a*T) + K")
}

/// `s + K exp(-theta s)`: stable while `0 < K theta < pi/2`; where the dead time is negative there is no loop.
fn integrator() -> Model {
    model("continuous", "K = { nominal = 1 }\ntheta = { nominal = 1 }", "s + K*exp(-theta*s)")
}

fn request(list: &[(&str, &str)]) -> ToleranceRequest {
    ToleranceRequest::new(list.iter().map(|(name, t)| (*name, t.parse().unwrap())))
}

fn asked(model: &Model, request: &ToleranceRequest) -> ToleranceAnswer {
    model.ask().tolerance(request, &Budget::unlimited()).unwrap().into_value()
}

/// The share of a rectangle below a curve that goes from its lower to its upper edge, or above it.
fn share_of([low, high]: [f64; 2], [bottom, top]: [f64; 2], stable: impl Fn(f64) -> [f64; 2]) -> f64 {
    let steps = 20_000;
    let inside = |k: u32| {
        let [from, to] = stable(low + (high - low) * (f64::from(k) + 0.5) / f64::from(steps));
        (to.min(top) - from.max(bottom)).max(0.0)
    };
    (0..steps).map(inside).sum::<f64>() / f64::from(steps) / (top - bottom)
}

fn holds(volume: &BoxVolume, share: f64, goal: &Rational) {
    let [stable, unstable, undecided] =
        [&volume.stable, &volume.unstable, &volume.undecided].map(Rational::to_f64_approximate);
    assert_eq!(&(&volume.stable + &volume.unstable) + &volume.undecided, Rational::ONE);
    assert!(volume.undecided <= *goal && volume.stopped.is_none(), "{volume:?}");
    assert!(stable <= share + 1e-6 && share <= stable + undecided + 1e-6, "{stable} {share} {unstable}");
}

#[test]
fn the_stable_share_of_a_box_of_functions_is_that_below_the_curve() {
    let goal = number("1/50");
    // a from 0.1 to 0.9, K from 0.5 to 2.5.
    let found = asked(&first_order(), &request(&[("a", "0.4"), ("K", "1")]).volume(goal.clone()));
    let share = share_of([0.1, 0.9], [0.5, 2.5], |a| [(-a).exp() - 1.0, 1.0 + (-a).exp()]);
    holds(found.volume.as_ref().unwrap(), share, &goal);
    // One name alone: a < ln 2.
    let found = asked(&first_order(), &request(&[("a", "0.4")]).volume(goal.clone()));
    holds(found.volume.as_ref().unwrap(), (LN_2 - 0.1) / 0.8, &goal);
    // The nominal point is not stable.
    let request = request(&[("K", "1"), ("a", "0.4")]).volume(goal.clone());
    let found =
        first_order().ask().set("K", number("2.75")).tolerance(&request, &Budget::unlimited()).unwrap().into_value();
    assert!(found.factor.is_none() && !found.decision.is_stable());
    let share = share_of([0.1, 0.9], [1.75, 3.75], |a| [(-a).exp() - 1.0, 1.0 + (-a).exp()]);
    holds(found.volume.as_ref().unwrap(), share, &goal);
}

#[test]
#[ignore = "long: CI runs it"]
fn three_names_inside_of_functions_have_a_share_as_well() {
    let goal = number("1/10");
    let found = asked(&first_order(), &request(&[("a", "0.4"), ("K", "1"), ("T", "0.5")]).volume(goal.clone()));
    let steps = 400;
    let of_time = |k: u32| {
        let time = 0.5 + (f64::from(k) + 0.5) / f64::from(steps);
        share_of([0.1, 0.9], [0.5, 2.5], |a| [(-a * time).exp() - 1.0, 1.0 + (-a * time).exp()])
    };
    holds(found.volume.as_ref().unwrap(), (0..steps).map(of_time).sum::<f64>() / f64::from(steps), &goal);
}

#[test]
#[ignore = "long: CI runs it"]
fn the_stable_share_of_a_box_with_dead_time_is_that_below_the_hyperbola() {
    let goal = if is_thorough() { number("1/20") } else { number("1/10") };
    for (theta, sides) in tried([("1/2", [0.5, 1.5]), ("2", [-1.0, 3.0])], 2) {
        let found = asked(&integrator(), &request(&[("K", "2"), ("theta", theta)]).volume(goal.clone()));
        let end = |theta: f64| if theta < 0.0 { [0.0, 0.0] } else { [0.0, FRAC_PI_2 / theta] };
        holds(found.volume.as_ref().unwrap(), share_of(sides, [-1.0, 3.0], end), &goal);
    }
    // One name alone, and a whole box.
    let found = asked(&integrator(), &request(&[("K", "2")]).volume(goal.clone()));
    holds(found.volume.as_ref().unwrap(), FRAC_PI_2 / 4.0, &goal);
    let found = asked(&integrator(), &request(&[("K", "20%"), ("theta", "20%")]).volume(goal.clone()));
    holds(found.volume.as_ref().unwrap(), 1.0, &Rational::ZERO);
}

#[test]
#[ignore = "long: CI runs it"]
fn a_budget_that_ends_leaves_the_share_that_was_reached() {
    for (model, list) in [(first_order(), [("a", "0.4"), ("K", "1")]), (integrator(), [("theta", "1/2"), ("K", "2")])] {
        let exact = request(&list).exact().volume(number("1/100000"));
        let work = count(4_000_000, 40_000_000) as u64;
        let found = model.ask().tolerance(&exact, &Budget::with_work(work)).unwrap().into_value();
        let volume = found.volume.unwrap();
        assert_eq!(volume.stopped, Some(Stop::Work(work)));
        assert!(volume.stable.sign().is_gt() && volume.undecided > number("1/100000"), "{volume:?}");
        assert!(found.factor.unwrap().upper.is_some());
    }
}

/// With one name the end of the line is the largest factor; it has any digits.
#[test]
fn one_name_has_its_factor_as_a_number() {
    // (ln 2 - 1/2)/(1/20), and (pi/2 - 1)/(1/10).
    for (model, name, digits) in [
        (first_order(), "a", "3.86294361119890618834464242916"),
        (integrator(), "K", "5.70796326794896619231321691640"),
    ] {
        let found = asked(&model, &request(&[(name, "10%")]).exact());
        let exact = found.exact.expect("the end");
        assert_eq!(exact.value.decimal(30), digits);
        assert!(exact.proof.is_none());
        assert!(asked(&model, &request(&[(name, "10%")])).exact.is_none(), "not asked for");
    }
}

/// `(1 + f/10)^2 = pi/2`, and `3/2 + 3 f/20 = 1 + exp(-1/2 - f/20)`, to 17 digits.
#[test]
fn the_bracket_of_several_names_is_as_narrow_as_asked_for() {
    for (model, names, digits) in
        [(integrator(), ["K", "theta"], "2.5331413731550025"), (first_order(), ["K", "a"], "0.59222547003014689")]
    {
        let gap = number("1e-15");
        let found = asked(&model, &request(&names.map(|name| (name, "10%"))).gap(gap.clone()).exact());
        let factor = found.factor.expect("a factor");
        let upper = factor.upper.expect("an end");
        assert!(&upper - &factor.lower <= &upper * &gap, "{} {upper}", factor.lower);
        let (known, off) = (number(digits), number("1e-15"));
        assert!(factor.lower < &known + &off && upper > &known - &off, "{} {upper}", factor.lower);
        assert!(found.exact.is_none() && factor.witness.is_some());
    }
}

fn tenth(n: i64) -> Rational {
    Rational::new(n.into(), 10.into())
}

fn verdict(model: &Model, names: &[&str], point: &[Rational]) -> Verdict {
    let values = names.iter().map(|name| (*name).to_owned()).zip(point.iter().cloned());
    model.ask().set_all(values).verdict(&Budget::unlimited()).map_or(Verdict::Undefined, |v| v.value().verdict)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// `s^2 + a s + K exp(-theta s)`: what a look says of a box the verdict says of points drawn in it.
    #[test]
    fn a_look_at_a_box_with_dead_time_is_right_at_its_points(
        at in prop::array::uniform3(-3i64..30), widths in prop::array::uniform3(1i64..12),
        points in prop::collection::vec(prop::array::uniform3(1i64..=9), 6),
    ) {
        let names = ["a", "K", "theta"];
        let [a, k] = [0, 1].map(MultiPoly::variable);
        let (theta, zero) = (RationalFunction::variable(2), RationalFunction::zero());
        let one = MultiPoly::one();
        let terms = vec![(zero, vec![MultiPoly::zero(), a, one]), (theta.clone(), vec![k])];
        let family = DelayedFunction::new(terms, vec![theta], Vec::new(), &[1, 1, 1].map(Rational::from)).unwrap();
        let sides: Vec<[Rational; 2]> =
            at.iter().zip(&widths).map(|(&low, &width)| [tenth(low), tenth(low) + tenth(width) * tenth(2)]).collect();
        let seen = family.looks()(&BoxPart::whole(sides.clone()), &Budget::unlimited()).unwrap();
        let model = model(
            "continuous", "a = { nominal = 1 }\nK = { nominal = 1 }\ntheta = { nominal = 1 }", "s^2 + a*s + K*exp(-theta*s)",
        );
        for shares in &points {
            let point: Vec<Rational> =
                sides.iter().zip(shares).map(|([low, high], &share)| low + &(&(high - low) * &tenth(share))).collect();
            let is_stable = verdict(&model, &names, &point) == Verdict::Stable;
            match seen {
                BoxLook::Stable => prop_assert!(is_stable, "{:?}", point),
                BoxLook::Unstable => prop_assert!(!is_stable, "{:?}", point),
                BoxLook::Open(axis) => prop_assert!(axis < 3),
            }
        }
    }
}
