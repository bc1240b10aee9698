//! Roots of closed loops: against the exact counts of the verdict, and by hand.

use crate::helpers::model::{continuous, discrete, example, load};
use crate::helpers::number::number;
use crate::helpers::program::jurist;
use crate::helpers::thorough::tried;
use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::complex_roots;
use jurist_engine::answer::{Answer, ClosedLoopRoot, Roots};
use jurist_engine::error::Error;
use jurist_engine::model::{Model, Time};
use jurist_engine::problem::{Problem, Question, Region};

const BITS: u64 = 200;

fn roots(question: Question) -> Answer<Roots> {
    question.problem().unwrap().roots(12, &Budget::unlimited()).unwrap()
}

/// Whether a root is in the stable region; `None` where its disc crosses the boundary.
fn is_inside(root: &ClosedLoopRoot, time: Time) -> Option<bool> {
    let (x, end) = match time {
        Time::Discrete => (root.magnitude(BITS), Rational::ONE),
        Time::Continuous => (root.real(), Rational::ZERO),
    };
    if *x.upper() < end {
        return Some(true);
    }
    (*x.lower() > end).then_some(false)
}

fn agrees_with_the_verdict(model: &Model, question: Question, what: &str) {
    let verdict = question.clone().verdict(&Budget::unlimited()).unwrap();
    let found = roots(question);
    if let Some(delayed) = verdict.value().delayed {
        return agrees_with_the_count(found.value(), delayed.on, delayed.right, what);
    }
    let Some(count) = verdict.value().count else { return };
    let mut inside = [0; 3];
    for root in &found.value().list {
        let place = is_inside(root, model.time()).map_or(1, |inside| if inside { 0 } else { 2 });
        inside[place] += root.disc.count * if root.disc.is_pair { 2 } else { 1 };
    }
    assert_eq!(inside, [count.inside, count.on, count.outside], "{what}");
    assert_eq!(
        (found.value().infinite, found.value().degree),
        (verdict.value().infinite, verdict.value().degree),
        "{what}"
    );
}

/// Of a loop with dead time, where the line beyond which no roots are listed is left of the axis.
fn agrees_with_the_count(found: &Roots, on: usize, right: Option<usize>, what: &str) {
    let beyond = found.beyond.as_ref().unwrap();
    assert!(beyond.others_left_of.is_negative(), "{what}: {beyond:?}");
    let weight = |root: &ClosedLoopRoot| root.disc.count * if root.disc.is_pair { 2 } else { 1 };
    let number = |place| found.list.iter().filter(|root| is_inside(root, Time::Continuous) == place).map(weight).sum();
    assert_eq!((on, right), (number(None), Some(number(Some(false)))), "{what}");
}

#[test]
fn every_example_has_its_roots_where_the_verdict_counts_them() {
    let entries = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let names: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".toml")).collect();
    assert!(names.len() > 30, "{}", names.len());
    for name in tried(names, 4) {
        let model = example(name);
        match model.ask().problem().unwrap().roots(6, &Budget::unlimited()) {
            Ok(_) => {}
            Err(error) => panic!("{name}: {error}"),
        }
        agrees_with_the_verdict(&model, model.ask(), name);
    }
    let drive = Model::drive();
    for gain in [0, 551, 2000] {
        agrees_with_the_verdict(&drive, drive.ask().set("K_pwm", gain), "the drive");
    }
}

#[test]
fn singular_polynomials() {
    for (text, expected) in [
        ("z^3 + 0*k", vec!["0 (3 times)"]),
        ("z - k", vec!["0.333333333333"]),
        ("(z - 1)^2*(z + 1) + 0*k", vec!["1 (2 times)", "-1"]),
        ("z^2 + 1 + 0*k", vec!["0 (within 1e-17) +- 1.00000000000 j"]),
        ("k*z - 1/3*z + z^2*0 + 2", vec![]),
        ("7 + 0*k", vec![]),
    ] {
        let found = roots(discrete(text, "nominal = 1").ask().set("k", number("1/3")));
        let shown: Vec<String> = found.value().list.iter().map(|root| root.text(12)).collect();
        match text {
            // What is nearly 0 is said to be nearly 0: the bound depends on the precision.
            "z^2 + 1 + 0*k" => assert!(
                shown.len() == 1 && shown[0].starts_with("0") && shown[0].ends_with("1.00000000000 j"),
                "{shown:?}"
            ),
            _ => assert_eq!(shown, expected, "{text}"),
        }
    }
    let lost = roots(discrete("k*z^2 - z + 1/2", "nominal = 1").ask().set("k", 0));
    assert_eq!((lost.value().infinite, lost.value().list.len()), (1, 1));
    let zero = discrete("k*z + k", "nominal = 1").ask().set("k", 0).problem().unwrap().roots(6, &Budget::unlimited());
    assert!(matches!(zero, Err(Error::Undefined(_))));
}

/// How many roots are on the boundary is known exactly: those whose discs are on it are on it, and nothing is "within" of 0.
#[test]
fn roots_on_the_boundary_are_on_it() {
    let shown = |found: Answer<Roots>| -> Vec<String> { found.value().list.iter().map(|root| root.text(12)).collect() };
    let axis = roots(continuous("(s^2 + 2)^2*(s^2 + k)*(s + 1)", "nominal = 3").ask());
    for root in &axis.value().list[..2] {
        assert_eq!(root.real(), Enclosure::from_rational(number("0")));
        assert_eq!(root.damping(60), Some(Enclosure::from_rational(number("0"))));
    }
    let expected = ["0 +- 1.73205080757 j", "0 +- 1.41421356237 j (2 times)", "-1"];
    assert_eq!(shown(axis), expected);
    let circle = roots(discrete("(z^2 - 1)*(z^2 - z + 1)*(2*z - k)", "nominal = 1").ask());
    for root in &circle.value().list[..3] {
        assert_eq!(root.magnitude(60), Enclosure::from_rational(number("1")));
    }
    assert_eq!(shown(circle)[..3], ["1", "0.500000000000 +- 0.866025403784 j", "-1"]);
    // Next to the axis is not on it.
    let beside = roots(continuous("s^2 + k*s + 1", "nominal = 1").ask().set("k", number("1e-40")));
    assert!(beside.value().list[0].real().upper().is_negative());
}

/// -1 +- j sqrt(3) has the natural frequency 2 and the damping 1/2; its exponential is a root of the same loop sampled.
#[test]
fn damping_and_natural_frequency_by_hand() {
    let holds = |x: Enclosure, value: &str| {
        let value = number(value);
        assert!(x.contains(&value), "{} .. {}: {value}", x.lower(), x.upper());
        assert!(x.upper() - x.lower() < number("1e-10"));
    };
    let found = roots(continuous("s^2 + 2*s + k", "nominal = 1").ask().set("k", 4));
    let root = &found.value().list[0];
    holds(root.natural_frequency(BITS).unwrap(), "2");
    holds(root.damping(BITS).unwrap(), "1/2");
    // x'' + 2 x' + 4 x = 0, sampled at 1/10 and behind a hold that nothing drives.
    let sampled = load(
        "time = 'discrete'\nsample_time = '1/10'\n[parameters]\nK = 0\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'p'\n\
         input = 'r - K*y'\noutput = 'y'\ntransfer = '1/(s^2 + 2*s + 4)'\ndiscretize = 'zoh'\n",
    );
    let found = roots(sampled.ask());
    let root = &found.value().list[0];
    assert!(root.disc.is_pair);
    holds(root.natural_frequency(BITS).unwrap(), "2");
    holds(root.damping(BITS).unwrap(), "1/2");
    // A root on the negative axis of z is half the sample rate.
    let negative =
        load("time = 'discrete'\nsample_time = 2\n[parameters]\nK = '1/2'\n[loop]\ncharacteristic = 'z + K'\n");
    let found = roots(negative.ask());
    let root = &found.value().list[0];
    let [pi, ln2] = [Enclosure::pi(BITS), Enclosure::from_rational(Rational::from(2)).ln(BITS).unwrap()];
    let size = pi.mul(&pi, BITS).add(&ln2.mul(&ln2, BITS), BITS).sqrt(BITS);
    let rate = root.natural_frequency(BITS).unwrap();
    assert_eq!(rate.decimal(10), size.div(&Enclosure::from_rational(Rational::from(2)), BITS).unwrap().decimal(10));
}

/// Exact coefficients at the same point, from another command.
#[test]
fn the_command_prints_the_roots_of_the_polynomial() {
    let run = jurist(&["roots", "--json", "--digits", "20"]);
    let document: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    let p = Model::drive().ask().problem().unwrap();
    let p = p.parametric(&Budget::unlimited()).unwrap().unwrap().specialised(&Rational::ZERO);
    let expected = complex_roots(&p, &number("1e-30"), &Budget::unlimited()).unwrap();
    let listed = document["roots"].as_array().unwrap();
    assert_eq!(listed.len(), expected.len());
    for root in listed {
        let bound = |key: &str, i: usize| number(root[key][i].as_str().unwrap());
        let is_in = |key: &str, x: &Rational| bound(key, 0) <= *x && *x <= bound(key, 1);
        assert_eq!(expected.iter().filter(|d| is_in("re_enclosure", &d.re) && is_in("im_enclosure", &d.im)).count(), 1);
    }
    assert_eq!(jurist(&["roots", "--set", "K_pwm=551"]).status, 0);
}

/// The roots are those of the loop, whatever smaller region the question has: they were those of the polynomial with its bound put in.
#[test]
fn a_region_does_not_move_the_roots() {
    let problem = |model: &Model, region: Region| model.ask().within(region).problem().unwrap();
    let list = |problem: std::sync::Arc<Problem>| {
        let found = problem.roots(12, &Budget::unlimited()).unwrap();
        found.value().list.iter().map(|root| root.real().decimal(9).expect("narrow")).collect::<Vec<_>>()
    };
    let sampled = load("time = 'discrete'\nloop.characteristic = '(z - 1/2)*(z + 1/4)'\n");
    assert_eq!(list(problem(&sampled, Region::disc(number("1/2")).unwrap())), ["0.500000000", "-0.250000000"]);
    let slow = load("time = 'continuous'\nloop.characteristic = '(s + 1)*(s + 3)'\n");
    assert_eq!(list(problem(&slow, Region::half_plane(number("1")))), ["-1.00000000", "-3.00000000"]);
    let delayed = load("time = 'continuous'\nloop.characteristic = 's + 1/2*exp(-s/2)'\n");
    let whole = list(delayed.ask().problem().unwrap());
    assert_eq!(list(problem(&delayed, Region::half_plane(number("1/4")))), whole);
}
