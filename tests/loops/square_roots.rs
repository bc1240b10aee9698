//! Parameters under square roots: the loop has a value on one side of an end only.

use crate::helpers::loops::stable_set_of;
use crate::helpers::model::{continuous, discrete, keeping};
use crate::helpers::number::ratio;
use crate::helpers::program::jurist;
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist_engine::stability::{Cause, StableSet};

fn set_of(characteristic: &str) -> StableSet {
    stable_set_of(keeping(&continuous(characteristic, ""), &["k"]))
}

fn ends(set: &StableSet) -> Vec<(String, String)> {
    let ends = set.intervals().iter().flat_map(|interval| [&interval.lower, &interval.upper]).flatten();
    ends.map(|end| (end.value.decimal(9), end.causes.to_string())).collect()
}

fn end(value: &str, causes: &str) -> (String, String) {
    (value.to_owned(), causes.to_owned())
}

/// At 0 the root has a value: it is no pole, and the loop is stable there. What is negative is outside of the question.
#[test]
fn at_the_zero_of_a_square_root_the_loop_is_defined() {
    let set = set_of("s + 1 + sqrt(k)");
    assert_eq!(ends(&set)[0], end("0", "square root"));
    assert!(set.undecided().iter().all(|bracket| bracket.lower.as_ref().is_some_and(|x| *x > ratio(100, 1))));
    let run = jurist(&["intervals", "sqrt(k)/(s+1)"]);
    assert!(run.stdout.contains("square root: the number under it is negative beyond"), "{}", run.stdout);
    assert!(!run.stdout.contains("pole") && !run.stdout.contains("undecided up to"), "{}", run.stdout);
    // Below 0 nothing is undecided either where the limit is elsewhere.
    let set = set_of("s^2 + s + sqrt(k) - 2");
    assert_eq!(ends(&set)[0], end("4", "s=0"));
    assert!(set.undecided().iter().all(|bracket| bracket.lower.as_ref().is_some_and(|x| *x > ratio(100, 1))));
}

#[test]
fn between_two_square_roots_all_is_decided() {
    let set = set_of("s + 1 + sqrt(k - 1)*sqrt(5 - k)");
    assert_eq!(ends(&set), [end("1", "square root"), end("5", "square root")]);
    assert!(set.undecided().is_empty());
    let set = set_of("s + sqrt(-2 - k^2)");
    assert!(set.is_empty() && set.undecided().is_empty());
}

/// The zero is a whole number of 41 bits: compared with itself it once took 34 GB.
#[test]
fn a_large_rational_zero_is_told_from_its_neighbours() {
    let set = set_of("s + sqrt(k - 10^12) - 1");
    assert_eq!(set.intervals()[0].lower.as_ref().unwrap().value.exact(), Some(ratio(1_000_000_000_001, 1)));
    // Where nothing is decided the headline does not say that nothing is stable.
    let run = jurist(&["intervals", "s + sqrt(k) - 10^20"]);
    assert!(run.stdout.contains("stable nowhere outside of what is undecided"), "{}", run.stdout);
}

/// Arguments with functions in them are negative at numbers that no polynomial shows.
#[test]
#[ignore = "long: CI runs it"]
fn a_transcendental_argument_has_a_beginning() {
    let set = set_of("s + 1 + sqrt(exp(k) - 2)");
    assert!(set.contains(&ratio(7, 10)) && !set.contains(&ratio(69, 100)) && !set.contains(&ratio(-1, 1)));
}

/// Under a square a root may be defined at one number and nowhere near: a cell is not decided there.
#[test]
fn a_number_at_which_alone_a_square_root_is_defined_decides_no_cell() {
    for (characteristic, expected) in [
        ("s + 2 + sqrt(-(k - 1)^2)", vec![]),
        ("z + sqrt(-k^2)", vec![]),
        ("s + 3 + sqrt(k^3 - k^2)", vec!["1"]),
        ("s + 2 + sqrt((k - 1)^2*(k - 3))", vec!["3"]),
        ("s^2 + (1 + sqrt(4*k - k^2 - 4))*s + 1", vec![]),
    ] {
        let set = match characteristic.starts_with('z') {
            true => stable_set_of(keeping(&discrete(characteristic, ""), &["k"])),
            false => set_of(characteristic),
        };
        let found = ends(&set);
        assert_eq!(found.is_empty(), expected.is_empty(), "{characteristic}: {found:?}");
        for value in expected {
            assert_eq!(found[0].0, value, "{characteristic}");
        }
        assert!(found.iter().all(|(_, causes)| !causes.is_empty()), "{characteristic}: {found:?}");
    }
    // Where it is defined on both sides it is no end, though the number itself may stay undecided.
    let set = set_of("s + 1 + 3*sqrt((k - 1)^2) - k/2");
    assert!(set.contains(&ratio(1, 2)) && set.contains(&ratio(3, 2)));
    assert!(ends(&set).iter().all(|(_, causes)| causes != "square root"), "{set:?}");
}

/// A root in front of all other factors is zero at its end, which is an end for this reason too.
#[test]
fn a_factor_that_is_a_square_root_names_both_causes() {
    let set = set_of("s^2 + 2*sqrt(k)*s + k");
    assert_eq!(ends(&set)[0], end("0", "s=0+square root"));
    let set = set_of("s + sqrt(k - 1/3)*exp(-k)");
    let first = set.intervals()[0].lower.clone().unwrap();
    assert!(first.causes.contains(Cause::RootAtZero) && first.causes.contains(Cause::SquareRoot));
    assert_eq!(first.value.exact(), Some(ratio(1, 3)));
}

/// A function, and its value.
type Part = (&'static str, fn(f64) -> f64);

const PARTS: [Part; 6] = [
    ("sqrt(k + 2)", |k| (k + 2.0).sqrt()),
    ("sqrt(3 - k)", |k| (3.0 - k).sqrt()),
    ("sqrt(k^2 - 2)", |k| (k * k - 2.0).sqrt()),
    ("exp(-k)", |k| (-k).exp()),
    ("k", |k| k),
    ("k^2", |k| k * k),
];

/// Every value of `k` on a grid is decided by hand: `s^2 + p s + q` is stable where `p` and `q` have values and are positive.
#[test]
#[ignore = "long: CI runs it"]
fn stable_sets_agree_with_the_coefficients_at_points() {
    let mut random = Random::new(20_261_124);
    let (mut decided, mut open) = (0, 0);
    for _ in 0..count(3, 12) {
        let mut coefficient = || {
            let [i, j] = [random.below(PARTS.len()), random.below(PARTS.len())];
            let mut factor = || [-3, -2, -1, 1, 2, 3][random.below(6)];
            let (a, b, c) = (factor(), factor(), factor());
            let ((first, f), (second, g)) = (PARTS[i], PARTS[j]);
            let text = format!("({a})*{first} + ({b})*{first}*{second} + ({c})/2");
            let value = move |k: f64| {
                let (x, y) = (f(k), g(k));
                Some(f64::from(a) * x + f64::from(b) * x * y + f64::from(c) / 2.0).filter(|value| !value.is_nan())
            };
            (text, value)
        };
        let ((p_text, p), (q_text, q)) = (coefficient(), coefficient());
        let characteristic = format!("s^2 + ({p_text})*s + {q_text}");
        let set = set_of(&characteristic);
        for n in -90..=90 {
            // Never one of the ends, which are in no interval.
            let (k, value) = (ratio(4 * n + 1, 74), f64::from(4 * n as i32 + 1) / 74.0);
            let values = [p(value), q(value)];
            if values.iter().flatten().any(|x| x.abs() < 1e-9) {
                continue;
            }
            let is_stable = values.iter().all(|x| x.is_some_and(|x| x > 0.0));
            let is_open = set.undecided().iter().any(|bracket| {
                bracket.lower.as_ref().is_none_or(|x| *x <= k) && bracket.upper.as_ref().is_none_or(|x| k <= *x)
            });
            *(if is_open { &mut open } else { &mut decided }) += 1;
            assert!(is_open || set.contains(&k) == is_stable, "{characteristic} at k = {k}: {set:?}");
        }
    }
    assert!(decided > 20 * open, "{decided} points decided, {open} open");
}
