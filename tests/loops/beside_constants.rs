//! Dead time beside constants that are not rational: limits in closed form, and the sets of loops with rational numbers beside the constants.

use crate::helpers::model::{keeping, read};
use crate::helpers::number::{number, ratio};
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::{Budget, Stop};
use jurist_algebra::number::Rational;
use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes, Verdict};
use jurist_engine::error::{Code, Error};
use jurist_engine::model::Model;
use jurist_engine::stability::plane::boxes::BoxVerdict;
use jurist_engine::stability::{Range, StableSet};

/// Unity feedback of `transfer` with a gain `K`, beside a parameter `L`.
fn feedback(transfer: &str) -> Model {
    read(&format!(
        "time = 'continuous'\n[parameters]\nK = {{ nominal = 1, min = 0 }}\nL = {{ nominal = 1, min = '1/10' }}\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'plant'\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '{transfer}'\n"
    ))
}

fn set(model: &Model, name: &str) -> StableSet {
    keeping(model, &[name]).stable_set(&Budget::unlimited()).unwrap().into_value()
}

fn within(model: &Model, name: &str, [low, high]: [&str; 2]) -> StableSet {
    let question = keeping(model, &[name]).domain(name, Range::between(Some(number(low)), Some(number(high))));
    question.stable_set(&Budget::unlimited()).unwrap().into_value()
}

/// The finite ends of all intervals.
fn ends(set: &StableSet) -> Vec<String> {
    assert!(set.undecided().is_empty());
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    ends.map(|end| end.value.decimal(7)).map(|text| number(&text).to_string()).collect()
}

#[test]
fn an_integrator_with_a_gain_of_pi_has_its_limit_at_a_rational_number() {
    // K pi/s exp(-s/2): stable below pi/(2/2)
    let model = feedback("pi*exp(-s/2)/s");
    let found = set(&model, "K");
    assert_eq!(ends(&found), ["0", "1"]);
    let at = |value: Rational| model.ask().set("K", value).verdict(&Budget::unlimited());
    let near = number("1e-40");
    assert_eq!(at(Rational::ONE - &near).unwrap().value().verdict, Verdict::Stable);
    assert_eq!(at(Rational::ONE + &near).unwrap().value().verdict, Verdict::Unstable);
    // No bits of pi tell that a root is on the axis.
    match at(Rational::ONE) {
        Err(Error::Stopped(stopped)) => assert!(matches!(stopped.stop, Stop::Precision(_))),
        other => panic!("{:?}", other.map(|verdict| verdict.value().verdict)),
    }
}

/// A transfer function with a square root in it, and the same with a number in its place, `L` being a zero or a pole; and whether the gain may grow
/// without end.
fn random_transfer(random: &mut Random) -> ([String; 2], bool) {
    // The roots with eleven digits.
    let (square, value) =
        [(2, "1.4142135624"), (3, "1.7320508076"), (5, "2.2360679775"), (7, "2.6457513111")][random.below(4)];
    let tau = ratio(1 + random.below(12) as i64, 10);
    let (a, b) = (1 + random.below(4), ratio(1 + random.below(8) as i64, 4));
    let (shape, is_open) = match random.below(4) {
        0 => (format!("exp(-{tau}*s)*#/((s + {a})*(s + #))"), true),
        1 => (format!("exp(-{tau}*s)*(s + L)/(s*(s^2 + {b}*#*s + {a}))"), true),
        2 => (format!("(1 + #*exp(-{tau}*s))/((L*s + 1)*(s + {b}))"), false),
        _ => (format!("exp(-{tau}*s)*L/((#*s - 1)*(s/{a} + 3))"), true),
    };
    ([&format!("sqrt({square})"), value].map(|value| shape.replace('#', value)), is_open)
}

#[test]
fn sets_are_those_of_numbers_beside_the_constants() {
    let mut random = Random::new(20_261_128);
    for _ in 0..count(6, 60) {
        let (transfers, is_open) = random_transfer(&mut random);
        let models = transfers.each_ref().map(|transfer| feedback(transfer));
        let gains = models.each_ref().map(|model| match is_open {
            true => set(model, "K"),
            false => within(model, "K", ["1/100", "20"]),
        });
        assert_eq!(ends(&gains[0]), ends(&gains[1]), "{transfers:?}");
        let zeros = models.each_ref().map(|model| within(model, "L", ["1/5", "8"]));
        assert_eq!(ends(&zeros[0]), ends(&zeros[1]), "{transfers:?}");
    }
}

#[test]
fn boxes_and_tolerances_agree_with_decisions_at_points() {
    let model = feedback("2*pi*exp(-s/4)/(s*(s/(2*pi*L) + 1))");
    let side = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([side("1/10", "2"), side("1/2", "3")], ratio(1, 5));
    let problem = keeping(&model, &["K", "L"]).plane_problem().unwrap();
    let MapOrBoxes::Boxes(map) = problem.map_by(MapMethod::Auto, &request, 6, &Budget::unlimited()).unwrap() else {
        panic!("boxes were expected")
    };
    let mut seen = [0, 0];
    for cell in &map.value().boxes.boxes {
        let middle = [&cell.window.x, &cell.window.y].map(|[low, high]| low.midpoint(high));
        let verdict = model.ask().set("K", middle[0].clone()).set("L", middle[1].clone()).verdict(&Budget::unlimited());
        let stable = verdict.unwrap().value().verdict == Verdict::Stable;
        match cell.verdict {
            BoxVerdict::Stable => assert!(stable, "{middle:?}"),
            BoxVerdict::Unstable { .. } => assert!(!stable, "{middle:?}"),
            _ => continue,
        }
        seen[usize::from(stable)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 2), "{seen:?}");
}

#[test]
fn functions_of_a_free_name_and_margins_are_refused() {
    let model = feedback("exp(-s/2)/(s + sqrt(L + 1))");
    let refused = |found: Result<(), Error>| match found {
        Err(Error::Refused(refused)) => assert_eq!(refused.code(), Code::DeadTime),
        other => panic!("{other:?}"),
    };
    let budget = Budget::unlimited();
    refused(keeping(&model, &["L"]).stable_set(&budget).map(|_| ()));
    refused(model.ask().margins(None, &Rational::ZERO, &budget).map(|_| ()));
    assert!(keeping(&model, &["K"]).stable_set(&budget).is_ok());
}
