//! Requirements over values of one parameter of complex loops: real loops seen from frames that turn, mirrored loops, and random loops against verdicts and grids.

use super::margins::Open;
use crate::helpers::model::read;
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::thorough;
use jurist::{Ask, Requirement};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::model::Between;
use jurist_engine::response::{RequiredEnd, RequiredSet};

fn number(x: &str) -> Rational {
    x.parse().unwrap()
}

/// With the name of what is required.
fn asked() -> Vec<Requirement> {
    let all = [
        Requirement::modulus_margin(number("1/2")),
        Requirement::phase_margin(&number("40")),
        Requirement::gain_margin(&number("3/2")),
        Requirement::disk_margin(number("3/5")),
        Requirement::complementary_peak(number("3/2")),
        Requirement::norm(Between::new("r", "y"), number("5/4")),
        Requirement::damping(number("1/5")),
    ];
    all.map(Result::unwrap).into()
}

fn set(text: &str, requirement: &Requirement) -> RequiredSet {
    let problem = read(text).ask().free("K").problem().unwrap();
    let found = problem.required_set(std::slice::from_ref(requirement), None, &Budget::unlimited());
    found.unwrap_or_else(|e| panic!("{e}\n{requirement:?}\n{text}")).into_value()
}

fn ends(set: &RequiredSet) -> Vec<&RequiredEnd> {
    set.intervals.iter().flat_map(|i| [&i.lower, &i.upper]).flatten().collect()
}

/// All that does not depend on where the frequency 0 is.
fn written(set: &RequiredSet) -> Vec<String> {
    let end = |end: &RequiredEnd| {
        let names = match end {
            RequiredEnd::Requirement { names, closed, .. } => format!("{names:?} {closed}"),
            _ => String::new(),
        };
        format!("{} {names}", end.value().decimal(20).trim_end_matches('0'))
    };
    // Far out a damping of a discrete loop is not looked at.
    let is_far = |end: &Option<Rational>| end.as_ref().is_none_or(|x| x.abs() >= Rational::from(1000));
    assert!(set.undecided.iter().all(|open| is_far(&open.lower) && is_far(&open.upper)), "{:?}", set.undecided);
    ends(set).into_iter().map(end).collect()
}

/// Damping is about where the frequency 0 is, and so it is left out.
#[test]
fn real_loops_seen_from_frames() {
    let loop_of = |time: &str, transfer: &str| {
        format!(
            "time = '{time}'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n\
             transfer = 'K*{transfer}'\n"
        )
    };
    let mut different = 0;
    for (time, real, seen) in [
        ("continuous", "(s + 2)/s/(s + 1)/(s + 3)", "(s + 2 - 2*j)/(s - 2*j)/(s + 1 - 2*j)/(s + 3 - 2*j)"),
        ("continuous", "(s + 3)/(s - 1)/(s + 4)", "(s + 3 + j)/(s - 1 + j)/(s + 4 + j)"),
        ("continuous", "(s + 1)/(s + 2)", "(s + 1 + 3*j)/(s + 2 + 3*j)"),
        // z (3 + 4 j)/5 for z.
        ("discrete", "(z + 1/2)/(z - 1)/z", "((3 + 4*j)/5*z + 1/2)/((3 + 4*j)/5*z - 1)/((3 + 4*j)/5*z)"),
    ] {
        for requirement in asked().iter().filter(|r| r.name() != "damping") {
            let [real, seen] = [real, seen].map(|transfer| written(&set(&loop_of(time, transfer), requirement)));
            assert_eq!(real, seen, "{requirement:?}");
            different += usize::from(seen.iter().any(|end| end.contains(requirement.name())));
        }
    }
    assert!(different > 12, "{different} sets have an end of their requirement");
}

/// Values beside each end and between them: verdicts at these.
fn places(set: &RequiredSet) -> Vec<Rational> {
    let near = Rational::dyadic(&Integer::ONE, 30);
    let mut places: Vec<Rational> = (-6..=6).map(|k| Rational::new((7 * k + 3).into(), 8.into())).collect();
    for end in ends(set) {
        let (lo, hi) = end.value().refined(&near).enclosure();
        places.extend([&lo - &near, &hi + &near]);
    }
    places.retain(|k| k.abs() < Rational::from(1000));
    places
}

/// Whether a point meets a requirement, by its margins.
fn is_met(text: &str, requirement: &Requirement, k: &Rational) -> bool {
    let problem = read(text).ask().set("K", k.clone()).problem().unwrap();
    let found = problem.requirements_met(std::slice::from_ref(requirement), None, &Budget::unlimited());
    found.unwrap_or_else(|e| panic!("{e}\n{k} of {text}"))[0].met
}

/// The distance to a circle on a grid, less what is asked; `None` where it is not about one.
fn excess(of: &Open, requirement: &Requirement, k: f64) -> Option<f64> {
    type C = nalgebra::Complex<f64>;
    let ratio = |l: C| match requirement.name() {
        "modulus_margin" => (1.0 + l).norm() - 0.5,
        "disk_margin" => 2.0 * (1.0 + l).norm() / (1.0 - l).norm() - 0.6,
        "complementary_peak" => 1.5 - l.norm() / (1.0 + l).norm(),
        "norm" => 1.25 - l.norm() / (1.0 + l).norm(),
        _ => f64::INFINITY,
    };
    let found = of.grid().map(|x| ratio(of.at(x) * k)).fold(f64::INFINITY, f64::min);
    Some(found).filter(|x| x.is_finite())
}

#[test]
#[ignore = "long: CI runs it"]
fn random_loops_agree_with_verdicts_and_grids() {
    let count = std::env::var("JURIST_COMPLEX_LOOPS").ok().and_then(|n| n.parse().ok());
    let count = count.unwrap_or(thorough::count(2, 6));
    let (mut random, mut checked, mut of_requirements) = (Random::new(1974), 0, 0);
    while checked < count {
        let of = Open::random(&mut random, checked % 2 == 1);
        if of.n.iter().all(|c| *c == [0, 0]) {
            continue;
        }
        checked += 1;
        let text = of.text(1);
        for (i, requirement) in asked().iter().enumerate() {
            let found = set(&text, requirement);
            let mirrored = set(&of.text(-1), requirement);
            assert_eq!(written(&found), written(&mirrored));
            of_requirements += ends(&found).iter().filter(|e| matches!(e, RequiredEnd::Requirement { .. })).count();
            for (at, k) in places(&found).iter().enumerate() {
                if !thorough::is_tried(i + at, 4) && at < 13 || k.is_zero() {
                    continue;
                }
                let inside = found.intervals.iter().any(|interval| interval.contains(k));
                assert_eq!(is_met(&text, requirement, k), inside, "{requirement:?} at {k} of {text}");
                let rough = excess(&of, requirement, k.to_f64_approximate()).filter(|_| inside);
                assert!(rough.is_none_or(|excess| excess > -1e-6), "{requirement:?} at {k}: {rough:?} of {text}");
            }
        }
    }
    assert!(of_requirements > 4 * count, "{of_requirements} ends");
}

/// A gain that stands in the characteristic polynomial is the cut itself.
#[test]
fn a_gain_without_signals() {
    let text =
        "time = 'continuous'\n[parameters]\nK = 1\n[loop]\ncharacteristic = '(s - j)*(s + 1 + 2*j) + K*(s + 2 + j)'\n";
    let block = "time = 'continuous'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\n\
                 transfer = 'K*(s + 2 + j)/(s - j)/(s + 1 + 2*j)'\n";
    for requirement in asked().iter().filter(|r| r.name() != "norm") {
        assert_eq!(written(&set(text, requirement)), written(&set(block, requirement)), "{requirement:?}");
    }
}

/// Behind a hold, and with an angle inside of a function: resultants that are enclosed.
#[test]
fn over_constants_and_functions() {
    let loop_of = |parameters: &str, transfer: &str| {
        format!(
            "time = 'continuous'\n[parameters]\n{parameters}\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\n\
             transfer = '{transfer}'\n"
        )
    };
    let text = loop_of("K = { nominal = 1, min = 0.1, max = 20 }", "K*(s + 2)/(s - pi*j)/(s + 1/2)");
    for requirement in asked().iter().take(if thorough::is_thorough() { 5 } else { 1 }) {
        let found = set(&text, requirement);
        assert!(found.undecided.is_empty() && !found.intervals.is_empty(), "{requirement:?} {:?}", written(&found));
        for k in places(&found)[13..].iter().filter(|k| (number("0.1")..number("20")).contains(k)) {
            let inside = found.intervals.iter().any(|interval| interval.contains(k));
            assert_eq!(is_met(&text, requirement, k), inside, "{requirement:?} at {k}");
        }
    }
    // The angle of 1/s in a frame: the phase margin is 90 degrees less its size.
    let text = loop_of("K = { nominal = 0.1, min = -1.5, max = 1.5 }", "exp(j*K)/(s - j)");
    let found = set(&text, &asked()[1]);
    let expected = (50.0 * std::f64::consts::PI / 180.0).to_string();
    let [lower, upper] = ends(&found)[..] else { panic!("{:?}", written(&found)) };
    assert!(upper.value().decimal(12).starts_with(&expected[..10]));
    assert!(lower.value().decimal(12).starts_with(&format!("-{}", &expected[..10])));
}

#[test]
fn what_is_refused_says_what_to_ask() {
    let text = "time = 'continuous'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\n\
                transfer = 'K/(s - j)'\n";
    let run =
        |options: &[&str]| jurist_with_input(&[&["intervals", "-", "--param", "K"], options].concat(), text.as_bytes());
    let refused = run(&["--delay-margin", "1/10"]);
    assert!(refused.stderr.contains("E-complex"), "{}", refused.stderr);
    let found = run(&["--modulus-margin", "1/2"]);
    assert!(found.stdout.contains("modulus_margin >= 1/2 for"), "{}{}", found.stdout, found.stderr);
}
