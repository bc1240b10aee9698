//! Requirements over values of one parameter of complex loops with dead time: closed forms, real loops seen from frames that turn, and random loops against verdicts.

use super::margins::Open;
use crate::helpers::model::read;
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::thorough;
use jurist::{Ask, Requirement};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::response::{RequiredEnd, RequiredSet};

fn number(x: &str) -> Rational {
    x.parse().unwrap()
}

fn asked() -> Vec<Requirement> {
    let all = [
        Requirement::modulus_margin(number("1/2")),
        Requirement::phase_margin(&number("45")),
        Requirement::gain_margin(&number("3/2")),
        Requirement::disk_margin(number("3/5")),
        Requirement::complementary_peak(number("3/2")),
        Requirement::phase_margin(&number("90")),
    ];
    all.map(Result::unwrap).into()
}

fn loop_of(transfer: &str) -> String {
    format!(
        "time = 'continuous'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n\
         transfer = '{transfer}'\n"
    )
}

fn set(text: &str, requirement: &Requirement) -> RequiredSet {
    let problem = read(text).ask().free("K").problem().unwrap();
    let found = problem.required_set(std::slice::from_ref(requirement), None, &Budget::unlimited());
    let found = found.unwrap_or_else(|e| panic!("{e}\n{} of {text}", requirement.text())).into_value();
    assert!(found.undecided.is_empty(), "{:?} of {text}", found.undecided);
    found
}

fn ends(set: &RequiredSet) -> Vec<&RequiredEnd> {
    set.intervals.iter().flat_map(|i| [&i.lower, &i.upper]).flatten().collect()
}

fn written(set: &RequiredSet) -> Vec<String> {
    let end = |end: &RequiredEnd| {
        let of = if matches!(end, RequiredEnd::Requirement { .. }) { " required" } else { "" };
        format!("{}{of}{}", end.value().decimal(12), if end.is_closed() { ", itself too" } else { "" })
    };
    ends(set).into_iter().map(end).collect()
}

/// `K exp(-s/2)/(s - j)` has the modulus one at `1 + K` and `1 - K`: of the phase `(1 + K)/2` is taken by the dead time.
#[test]
#[ignore = "long: CI runs it"]
fn an_integrator_in_a_frame_by_hand() {
    let text = loop_of("K*exp(-s/2)/(s - j)");
    let all = asked();
    // pi/2 - 1, and (pi - 1)/(3/2).
    assert_eq!(written(&set(&text, &all[1])), ["0", "0.570796326795 required, itself too"]);
    assert_eq!(written(&set(&text, &all[2])), ["0", "1.42772843573 required"]);
    // At (pi/2 - 1)/3 of a turn less: of 90 degrees nothing is left for the dead time.
    assert_eq!(written(&set(&text, &all[5])), Vec::<String>::new());
    // The peak of the sensitivity by margins at a point.
    let found = set(&text, &all[0]);
    let [_, upper] = ends(&found)[..] else { panic!("it ends") };
    let near = upper.value().refined(&Rational::dyadic(&Integer::ONE, 60)).enclosure().0;
    let found = read(&text).ask().set("K", near).margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap();
    let modulus = &found.value().stable.as_ref().unwrap().modulus;
    assert_eq!(modulus.decimal(12), "0.500000000000");
}

/// Each value is there twice, at two frequencies.
#[test]
#[ignore = "long: CI runs it"]
fn real_loops_seen_from_frames() {
    let cases = [
        ("K*exp(-s/2)/s", "K*exp(j)*exp(-s/2)/(s - 2*j)"),
        ("K*(s + 2)*exp(-s/4)/s/(s + 1)", "K*(s + 2 + 2*j)*exp(-j/2)*exp(-s/4)/(s + 2*j)/(s + 1 + 2*j)"),
        // One gain of two.
        ("(K*s + 1)/s*exp(-s/4)/(s + 1)", "(K*(s - j) + 1)/(s - j)*exp(j/4)*exp(-s/4)/(s + 1 - j)"),
    ];
    for (real, seen) in cases.into_iter().take(if thorough::is_thorough() { 2 } else { 1 }) {
        for requirement in asked()[1..].iter().take(if thorough::is_thorough() { 2 } else { 1 }) {
            let [real, seen] = [real, seen].map(|transfer| written(&set(&loop_of(transfer), requirement)));
            assert_eq!(real, seen, "{}", requirement.text());
        }
    }
}

/// Whether a point meets a requirement, by its margins.
fn is_met(text: &str, requirement: &Requirement, k: &Rational) -> bool {
    let problem = read(text).ask().set("K", k.clone()).problem().unwrap();
    let found = problem.requirements_met(std::slice::from_ref(requirement), None, &Budget::unlimited());
    found.unwrap_or_else(|e| panic!("{e}\n{k} of {text}"))[0].met
}

#[test]
#[ignore = "long: CI runs it"]
fn random_loops_agree_with_verdicts() {
    let count = std::env::var("JURIST_COMPLEX_LOOPS").ok().and_then(|n| n.parse().ok());
    let count = count.unwrap_or(thorough::count(1, 2));
    let (mut random, mut checked, mut of_requirements) = (Random::new(1976), 0, 0);
    while checked < count {
        let of = Open::random(&mut random, false);
        if of.n.iter().all(|c| *c == [0, 0]) {
            continue;
        }
        checked += 1;
        let tau = ["1/10", "1/2", "1"][random.below(3)];
        let text = of.text(1).replace("'K*(", &format!("'K*exp(-{tau}*s)*("));
        let near = Rational::dyadic(&Integer::ONE, 24);
        for requirement in thorough::tried(asked(), 3) {
            let found = set(&text, &requirement);
            of_requirements += ends(&found).iter().filter(|e| matches!(e, RequiredEnd::Requirement { .. })).count();
            let mut places: Vec<Rational> = [-5, -2, -1, 1, 3, 6].map(|k| Rational::new(k.into(), 4.into())).into();
            for end in ends(&found) {
                let (lo, hi) = end.value().refined(&near).enclosure();
                places.extend([&lo - &near, &hi + &near]);
            }
            for k in places {
                let inside = found.intervals.iter().any(|interval| interval.contains(&k));
                assert_eq!(is_met(&text, &requirement, &k), inside, "{} at {k} of {text}", requirement.text());
            }
        }
    }
    assert!(of_requirements > 0, "{of_requirements} ends");
}

#[test]
fn what_is_refused_says_what_to_ask() {
    let run = |transfer: &str, options: &[&str]| {
        let all = [&["intervals", "-", "--param", "K"], options].concat();
        jurist_with_input(&all, loop_of(transfer).as_bytes()).stderr
    };
    // Two factors with dead time, and a square.
    for transfer in ["K*(exp(-s/2) + exp(-s))/(s - j)", "K^2*exp(-s/2)/(s - j)"] {
        let found = run(transfer, &["--modulus-margin", "1/2", "--domain", "K=0.1..0.2"]);
        assert!(found.contains("E-complex") && found.contains("one factor of the open loop"), "{found}");
    }
    let found = run("K*exp(-s/2)/(s - j)", &["--delay-margin", "1/10"]);
    assert!(found.contains("E-complex") && found.contains("delay margin"), "{found}");
}
