//! Tolerances for all values of other names, against the sets of one parameter for all these values, and against points.

use crate::helpers::certificates::checkers::accept;
use crate::helpers::model::load;
use crate::helpers::number::{number, ratio};
use crate::helpers::program::{jurist_with_input, refused};
use crate::helpers::random::Random;
use crate::helpers::thorough::tried;
use jurist::certified::certify_tolerance;
use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest, Verdict};
use jurist_engine::model::Model;
use jurist_engine::response::{AllOf, MapForAll};
use jurist_engine::stability::boxes::BoxDecision;
use jurist_show::required_text;

/// `K/(s (c s + 1)(s + 1))`, a lag that is held, a lag with dead time, and an integrator that is held for a sample time `c`.
const LOOPS: [&str; 4] = [
    "time = 'continuous'\nparameters = { K = '1/4', c = 1 }\nloop.characteristic = 's*(c*s + 1)*(s + 1) + K'\n",
    "time = 'discrete'\nsample_time = '1/2'\nparameters = { K = '1/4', c = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
     [[block]]\nname = 'P'\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '2*c/(s + c)'\ndiscretize = 'zoh'\n",
    "time = 'continuous'\nparameters = { K = '1/4', c = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
     [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = '2*K*exp(-s)/(c*s + 1)'\n",
    "time = 'discrete'\nsample_time = 'c'\nparameters = { K = '1/4', c = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
     [[block]]\nname = 'P'\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/(s*(s + 1))'\ndiscretize = 'zoh'\n",
];

fn all(least: &Rational, greatest: &Rational) -> Vec<AllOf> {
    vec![AllOf::new("c", least.clone(), greatest.clone()).expect("a range")]
}

fn asked(model: &Model, request: &ToleranceRequest) -> Answer<ToleranceAnswer> {
    model.ask().tolerance(request, &Budget::unlimited()).unwrap()
}

fn upwards() -> ToleranceRequest {
    ToleranceRequest::new([("K", "-0%..+100%".parse().unwrap())]).gap(number("1/1000"))
}

/// The greatest gain for all values of a range is told by boxes of one parameter too, in another way.
#[test]
fn a_gain_grows_to_the_end_of_its_set_for_all_values() {
    for text in tried(LOOPS, 4) {
        let model = load(text);
        let mut random = Random::new(7);
        for _ in tried(0..6, 2) {
            let least = ratio(2 + random.below(9) as i64, 10);
            let greatest = &least + &ratio(1 + random.below(12) as i64, 10);
            let ranges = all(&least, &greatest);
            let answer = asked(&model, &upwards().for_all(ranges.clone()));
            let set = MapForAll::new(ranges).intervals(model.ask().free("K"), &Budget::unlimited()).unwrap();
            let nominal = number("1/4");
            let holds = |at: &Rational| {
                set.value().intervals.iter().any(|interval| {
                    let below = interval.lower.as_ref().is_none_or(|end| end.value().compare_rational(at).is_lt());
                    below && interval.upper.as_ref().is_none_or(|end| end.value().compare_rational(at).is_gt())
                })
            };
            let factor = answer.value().factor.as_ref().expect("the loop is stable for all values");
            let upper = factor.upper.as_ref().expect("no gain is good without end");
            let at = |factor: &Rational| &nominal + &(&nominal * factor);
            assert!(holds(&at(&factor.lower)), "{factor:?}\n{}", required_text(&set, &[], 9));
            assert!(!holds(&at(&(upper * &number("1.001")))), "{factor:?}\n{}", required_text(&set, &[], 9));
            assert!(upper - &factor.lower < upper * &number("1/100"), "{factor:?}");
            assert_eq!(answer.value().ranges(answer.problem()).len(), 1);
        }
    }
}

/// No point of the largest box is unstable, the point beyond is, and both checkers agree.
#[test]
#[ignore = "long: CI runs it"]
fn points_of_the_largest_box_are_stable() {
    let mut random = Random::new(11);
    for text in LOOPS {
        let model = load(text);
        let request =
            ToleranceRequest::new([("K", "50%".parse().unwrap())]).for_all(all(&number("1/2"), &number("3/2")));
        let answer = asked(&model, &request);
        let factor = answer.value().factor.as_ref().unwrap();
        let verdict = |point: &[Rational]| {
            let names = answer.problem().free().iter().map(|free| free.name.clone());
            let question = model.ask().set_all(names.zip(point.iter().cloned()));
            question.verdict(&Budget::unlimited()).unwrap().into_value().verdict
        };
        for _ in 0..10 {
            let point: Vec<Rational> = answer
                .value()
                .sides
                .iter()
                .map(|side| {
                    let [low, high] = side.at(&factor.lower);
                    &low + &(&(&high - &low) * &ratio(random.below(1001) as i64, 1000))
                })
                .collect();
            assert_eq!(verdict(&point), Verdict::Stable, "{point:?}\n{text}");
        }
        let beyond = factor.witness.as_ref().expect("no gain is good without end");
        assert_ne!(verdict(&beyond.point), Verdict::Stable, "{text}");
        accept(text, &certify_tolerance(&answer, None, &Budget::unlimited()).unwrap().text);
    }
}

/// `s^3 + (1 + c)/c s^2 + s/c + K/c`: stable for `K < (1 + c)/c`, which is least at the greatest `c`.
#[test]
fn the_exact_factor_is_that_of_the_worst_value() {
    let model = load(LOOPS[0]);
    let answer = asked(&model, &upwards().for_all(all(&number("1/2"), &number("4"))).exact());
    let exact = answer.value().exact.as_ref().expect("a corner is the worst point");
    // 5/4 = 1/4 + 4/4.
    assert_eq!(exact.value.exact(), Some(4.into()));
    let limit = asked(&model, &upwards().for_all(all(&number("1/2"), &number("4"))).limit("K"));
    let upper = limit.value().limit.as_ref().unwrap().sides[1].as_ref().unwrap();
    assert!(upper.safe < number("5/4") && upper.safe > number("1.249"), "{}", upper.safe);
}

/// Where the range alone spoils the loop no factor is good.
#[test]
fn a_range_that_is_not_good_alone_has_no_factor() {
    for text in LOOPS {
        let model = load(&text.replace("K = '1/4'", "K = '9/4'"));
        let answer = asked(&model, &upwards().for_all(all(&number("1/10"), &number("20"))));
        assert!(matches!(answer.value().decision, BoxDecision::NotStable { witness: Some(_) }), "{}", answer.text(6));
        assert!(answer.value().factor.is_none());
    }
}

/// A phase margin is to be there for all values too: that of `K/(s (c s + 1))` is 45 degrees where `K = sqrt(2)/c`.
#[test]
fn requirements_hold_for_all_values() {
    let text = "time = 'continuous'\nparameters = { K = '1/4', c = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
        [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(c*s + 1))'\n";
    let options = ["tolerance", "-", "--tol", "K=-0%..+10%", "--for-all", "c=1/2..2", "--phase-margin", "45"];
    let run = jurist_with_input(&options, text.as_bytes());
    let first = "for all c from 0.5 to 2: 1 tolerance: stable, and meets all requirements, for all values";
    assert!(run.stdout.contains(first), "{}", run.stdout);
    // 18.284271 = (sqrt(2)/2 - 1/4)/(1/40).
    assert!(run.stdout.contains("grow    18.2842") && run.stdout.contains("<= 18.2842"), "{}", run.stdout);
    let spoilt = jurist_with_input(&[&options[..5], &["c=1/2..8"], &options[6..]].concat(), text.as_bytes());
    assert!(spoilt.status == 1 && !spoilt.stdout.contains("factor"), "{}", spoilt.stdout);
}

/// The margin of `K exp(-c s)/s` is `90 - 180 K c/pi` degrees: `K < pi/8` at `c = 2`.
#[test]
#[ignore = "long: CI runs it"]
fn requirements_with_dead_time_hold_for_all_values() {
    let text = "time = 'continuous'\nparameters = { K = '1/4', c = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
        [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*exp(-c*s)/s'\n";
    let options = ["tolerance", "-", "--tol", "K=-0%..+10%", "--for-all", "c=1/2..2", "--phase-margin", "45"];
    let run = jurist_with_input(&options, text.as_bytes());
    assert!(run.stdout.contains("grow    5.707") && run.stdout.contains("<= 5.7079"), "{}", run.stdout);
}

#[test]
fn ranges_that_cannot_be_asked() {
    let refused =
        |options: &[&str], code: &str| refused(&[&["tolerance", "examples/drive.toml"], options].concat(), code).stderr;
    assert!(
        refused(&["--for-all", "T=1/4000..1/1000"], "E-tolerance").contains("'--tol T=1/4000..1/1000 --only' asks")
    );
    let both = refused(&["--tol", "T=10%", "--for-all", "T=1/4000..1/1000"], "E-option-value");
    assert!(both.contains("'T' is what is asked about"), "{both}");
    refused(&["--tol", "R_a=10%", "--for-all", "T=0..-1"], "E-option-value");
    refused(&["--tol", "R_a=10%", "--for-all", "T=-1..1"], "E-empty-domain");
}
