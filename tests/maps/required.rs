//! Regions of two parameters in which requirements are met, against decisions at points and sets on lines.

use crate::helpers::model::{keeping, load};
use crate::helpers::number::{number, ratio};
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::required::{Known, is_met};
use crate::helpers::schema::fits;
use crate::helpers::thorough::tried;
use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::model::Model;
use jurist_engine::response::{RequiredEnd, Requirement, Requirements};
use jurist_engine::stability::UndecidedBracket;
use serde_json::Value;

/// A PI controller and a lag with a slow sensor.
const PI: &str = "time = 'continuous'
[parameters]
K_p = { nominal = 1, min = 0 }
K_i = { nominal = 0.5, min = 0 }
[loop]
inputs = ['r']
outputs = ['y']
[[block]]
name = 'controller'
input = 'r - y'
output = 'u'
transfer = 'K_p + K_i/s'
[[block]]
name = 'plant'
input = 'u'
output = 'y'
transfer = '2/((s + 1)*(s + 2))'
";

/// A gain and a zero against a double integrator of samples.
const SAMPLED: &str = "time = 'discrete'
[parameters]
K = { nominal = 0.2, min = 0 }
b = { nominal = 0.8, min = 0, max = 1 }
[loop]
inputs = ['r']
outputs = ['y']
[[block]]
name = 'L'
input = 'r - y'
output = 'y'
transfer = 'K*(z - b)/(z - 1)^2'
";

fn required(model: &Model, names: &[&str], requirements: &[Requirement]) -> Answer<Map> {
    let budget = Budget::unlimited();
    let map = keeping(model, names).map(6, &budget).unwrap();
    map.with_requirements(requirements, None, &budget).unwrap_or_else(|e| panic!("{e}"))
}

/// The numbers of the requirements that are met at a point; `None` on curves and walls.
fn met(answer: &Answer<Map>, x: &Rational, y: &Rational) -> Option<Vec<usize>> {
    let found = answer.value().required.as_ref().unwrap();
    let domain = &answer.problem().axes()[1].domain;
    found.all().map.locate(x, y, domain, &Budget::unlimited()).unwrap().map(|cell| found.met(cell))
}

#[test]
#[ignore = "long: CI runs it"]
fn cells_of_a_map_agree_with_a_second_decision_at_random_points() {
    let mut random = Random::new(12);
    for (text, names, scales) in tried([(PI, ["K_p", "K_i"], [6, 9]), (SAMPLED, ["K", "b"], [2, 1])], 2) {
        let model = load(text);
        let known = [
            Known::Gain(number("3/2")),
            Known::Phase(ratio(1, 3)),
            Known::Circle([1, 0], number("1/2")),
            Known::Circle([0, 1], number("2/3")),
            Known::Circle([1, -1], number("1/4")),
        ];
        let requirements = [
            Requirement::gain_margin(&number("3/2")).unwrap(),
            Requirement::phase_margin(&number("60")).unwrap(),
            Requirement::modulus_margin(number("1/2")).unwrap(),
            Requirement::complementary_peak(number("3/2")).unwrap(),
            Requirement::disk_margin(number("1/2")).unwrap(),
        ];
        let answer = required(&model, &names, &requirements);
        let mut seen = [0; 2];
        for _ in 0..25 {
            let [x, y] = scales.map(|scale| ratio(1 + random.below(9_999) as i64 * scale, 10_000));
            let Some(met) = met(&answer, &x, &y) else { continue };
            for (k, known) in known.iter().enumerate() {
                let expected = is_met(&model, &[(names[0], &x), (names[1], &y)], None, known);
                assert_eq!(met.contains(&k), expected, "{} at {x}, {y}", requirements[k].text());
                seen[usize::from(expected)] += 1;
            }
        }
        assert!(seen[0] > 5 && seen[1] > 5, "{seen:?}");
    }
}

#[test]
fn on_a_line_the_map_says_what_the_set_of_one_parameter_says() {
    let budget = Budget::unlimited();
    let model = load(PI);
    let requirements =
        [Requirement::phase_margin(&number("45")).unwrap(), Requirement::modulus_margin(number("2/3")).unwrap()];
    let answer = required(&model, &["K_p", "K_i"], &requirements);
    let all = &answer.value().required.as_ref().unwrap().all().map;
    for value in ["5/17", "19/16"] {
        let slice = all.slice(&number(value), &answer.problem().axes()[1].domain, &budget).unwrap().unwrap();
        // Ends of cells that go on in the next one are no ends of the set.
        let mut ends: Vec<Real> = Vec::new();
        for end in slice.iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
            let end = end.clone();
            match ends.last() {
                Some(last) if last.is_same(&end) => drop(ends.pop()),
                _ => ends.push(end),
            }
        }
        let problem = model.ask().set("K_p", number(value)).free("K_i").problem().unwrap();
        let line = problem.required_set(&requirements, None, &budget).unwrap();
        let expected: Vec<Real> = line
            .value()
            .intervals
            .iter()
            .flat_map(|i| [&i.lower, &i.upper])
            .flatten()
            .map(RequiredEnd::value)
            .collect();
        assert_eq!(ends.len(), expected.len(), "K_p = {value}");
        for (a, b) in ends.iter().zip(&expected) {
            assert!(a.compare(b, &budget).unwrap().is_eq(), "K_p = {value}: {} {}", a.decimal(12), b.decimal(12));
        }
    }
}

/// `|1 + K/(s + a)|^2 - 1` is `K (K + 2 a)` over a positive number: all frequencies pass a modulus margin of 1 at once.
#[test]
fn a_modulus_margin_ends_where_all_frequencies_pass_it_at_once() {
    let text = "time = 'continuous'\n[parameters]\nK = { nominal = 1 }\na = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\n\
                outputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s + a)'\n";
    let answer = required(&load(text), &["K", "a"], &[Requirement::modulus_margin(number("1")).unwrap()]);
    for (k, is_required) in [("-1/2", false), ("-1/1000", false), ("1/1000", true), ("3", true)] {
        assert_eq!(met(&answer, &number(k), &number("1")), Some(if is_required { vec![0] } else { Vec::new() }), "{k}");
    }
}

/// `s^2 + a s + b` has damping `a/(2 sqrt b)`: 1/2 for `b = a^2`.
#[test]
fn a_damping_is_a_parabola() {
    let text = "time = 'continuous'\n[parameters]\na = { nominal = 1, min = 0 }\nb = { nominal = 1, min = 0 }\n[loop]\n\
                characteristic = 's^2 + a*s + b'\n";
    let answer = required(&load(text), &["a", "b"], &[Requirement::damping(number("1/2")).unwrap()]);
    let found = answer.value().required.as_ref().unwrap();
    assert_eq!(found.all().map.regions.len(), 1);
    assert!(answer.text(6).contains("damping >= 1/2: met in 1 region"), "{}", answer.text(6));
    for (a, b, expected) in [("1", "99/100", true), ("1", "101/100", false), ("3", "8", true), ("3", "10", false)] {
        let found = met(&answer, &number(a), &number(b)).unwrap();
        assert_eq!(!found.is_empty(), expected, "{a} {b}");
    }
}

#[test]
fn a_damping_beside_a_decay_rate_is_that_of_the_roots_themselves() {
    // s = -2 +- 2j has damping 0.707 and a decay of 2; from s = -1 on the same roots would have 0.447.
    let text = "time = 'continuous'\n[parameters]\nK = { nominal = 8, min = 0 }\n[loop]\n\
                characteristic = 's^2 + 4*s + K'\n[require]\ndamping = 0.6\ndecay = 1\n";
    let model = load(text);
    let budget = Budget::unlimited();
    let asked = Requirements::of(&model, &[], &[], &budget).unwrap();
    let question = model.ask().within(asked.region.clone().unwrap());
    let found = question.clone().problem().unwrap().requirements_met(&asked.list, None, &budget).unwrap();
    assert!(found[0].met);
    // 4/(2 sqrt K) >= 3/5 for K <= 100/9, and s = -1 at K = 3.
    let answer = question.free("K").problem().unwrap().required_set(&asked.list, None, &budget).unwrap();
    let [only] = answer.value().intervals.as_slice() else { panic!("{answer:?}") };
    let ends = [&only.lower, &only.upper].map(|end| end.as_ref().unwrap().value().exact().unwrap());
    assert_eq!(ends, [number("3"), number("100/9")]);
}

#[test]
fn phase_margins_are_nested_in_the_document_and_in_the_picture() {
    let arguments = ["map", "-", "-x", "K_p", "-y", "K_i", "--phase-margin", "30, 60 deg"];
    let run = jurist_with_input(&[&arguments[..], &["--json"]].concat(), PI.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    fits(&document).unwrap();
    let required = &document["required"];
    let names: Vec<&Value> = required["requirements"].as_array().unwrap().iter().map(|r| &r["required"]).collect();
    assert_eq!(names, ["30 deg", "60 deg"]);
    let cells = |part: &'static str| {
        required["strips"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(move |s| s["cells"].as_array().unwrap())
            .map(move |c| &c[part])
    };
    let mut counted = [0; 3];
    for (met, outside) in cells("met").zip(cells("outside")) {
        let met: Vec<u64> = met.as_array().unwrap().iter().map(|k| k.as_u64().unwrap()).collect();
        assert!([&[][..], &[0], &[0, 1]].contains(&met.as_slice()), "{met:?}");
        assert!(met.is_empty() || *outside == 0);
        counted[met.len()] += 1;
    }
    assert!(counted.iter().all(|n| *n > 0), "{counted:?}");
    let sets = required["sets"].as_array().unwrap();
    assert_eq!(sets.len(), 3);
    assert_eq!(sets[1]["regions"], sets[2]["regions"]);
}

/// The loop of [`PI`] in samples, with one lag behind a hold.
fn held() -> String {
    PI.replace("time = 'continuous'", "time = 'discrete'\nsample_time = '1/10'")
        .replace("min = 0 }", "min = 0, max = 20 }")
        .replace("K_i/s", "K_i/10/(z - 1)")
        .replace("transfer = '2/((s + 1)*(s + 2))'", "transfer = '1/(s + 1)'\ndiscretize = 'zoh'")
}

#[test]
fn regions_over_constants_are_the_sets_on_lines() {
    let held = held();
    let continuous = "time = 'continuous'\nparameters.K_p = { nominal = 1, min = 0, max = 20 }\n\
                      parameters.K_i = { nominal = 1, min = 0, max = 20 }\nloop.characteristic = 's^2 + sqrt(2)*K_i*s + K_p + K_i'\n";
    let cases = [
        (held.as_str(), Requirement::modulus_margin(number("1/2")).unwrap()),
        (held.as_str(), Requirement::gain_margin(&number("2")).unwrap()),
        (continuous, Requirement::damping(number("1/2")).unwrap()),
    ];
    let mut random = Random::new(5);
    for (text, requirement) in tried(cases, 2) {
        let model = load(text);
        let list = std::slice::from_ref(&requirement);
        let answer = required(&model, &["K_p", "K_i"], list);
        let mut seen = [0; 2];
        for _ in 0..4 {
            let x = ratio(1 + random.below(19_999) as i64, 1000);
            let line = keeping(&model, &["K_i"]).set("K_p", x.clone()).problem().unwrap();
            let set = line.required_set(list, None, &Budget::unlimited()).unwrap().into_value();
            // Near 0, and where a zero of the controller cancels the plant's pole.
            let is_short =
                |b: &UndecidedBracket| b.upper.clone().unwrap() - b.lower.clone().unwrap() < ratio(1, 1_000_000);
            assert!(set.undecided.iter().all(is_short), "{:?}", set.undecided);
            for _ in 0..5 {
                let y = ratio(1 + random.below(19_999) as i64, 1000);
                let Some(met) = met(&answer, &x, &y) else { continue };
                let expected = set.intervals.iter().any(|i| i.contains(&y));
                assert_eq!(!met.is_empty(), expected, "{} at {x}, {y}", requirement.text());
                seen[usize::from(expected)] += 1;
            }
        }
        assert!(seen[0] > 0 && seen[1] > 0, "{}: {seen:?}", requirement.text());
    }
}

/// `K (s + a)/((s + 1)(s + 2))`: curves of a requirement that bound nothing, lines `K = 0` and `a = 1` among them, divide no region and cut no extent.
#[test]
fn lines_on_which_a_requirement_does_not_end_are_no_ends_of_its_region() {
    let text = "time = 'continuous'\n[parameters]\nK = { nominal = 1 }\na = { nominal = 1 }\n[loop]\ninputs = ['r']\n\
                outputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*(s + a)/((s + 1)*(s + 2))'\n";
    let model = load(text);
    for requirement in
        [Requirement::phase_margin(&number("45")).unwrap(), Requirement::gain_margin(&number("2")).unwrap()]
    {
        for names in [["K", "a"], ["a", "K"]] {
            let answer = required(&model, &names, std::slice::from_ref(&requirement));
            let regions = &answer.value().required.as_ref().unwrap().all().map.regions;
            assert_eq!(regions.len(), 1, "{} {names:?}", requirement.text());
            let a = if names[0] == "a" { &regions[0].x } else { &regions[0].y };
            assert!(a.lower.is_none() && a.upper.is_none(), "{} {names:?}", requirement.text());
            assert!(is_met(&model, &[("K", &number("1")), ("a", &number("5"))], None, &Known::Phase(number("0.1716"))));
        }
    }
}
