//! Requirements on roots (damping, settling time) whatever the coefficients are made of. Ends were computed with mpmath at forty digits.

use crate::helpers::model::{continuous, discrete, keeping, load};
use crate::helpers::number::{number, ratio};
use crate::helpers::program::jurist;
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::model::Model;
use jurist_engine::response::{RequiredEnd, RequiredSet, Requirement};
use jurist_engine::stability::Range;

fn set_on(model: &Model, name: &str, domain: [&str; 2], requirement: &Requirement) -> RequiredSet {
    let range = Range::between(Some(number(domain[0])), Some(number(domain[1])));
    let problem = keeping(model, &[name]).domain(name, range).problem().unwrap();
    let answer = problem.required_set(std::slice::from_ref(requirement), None, &Budget::unlimited());
    answer.unwrap_or_else(|e| panic!("{e}")).into_value()
}

fn ends(set: &RequiredSet, digits: usize) -> Vec<[String; 2]> {
    assert!(set.undecided.is_empty(), "{:?}", set.undecided);
    let end = |end: &Option<RequiredEnd>| end.as_ref().unwrap().value().decimal(digits);
    set.intervals.iter().map(|i| [end(&i.lower), end(&i.upper)]).collect()
}

fn is_binding(end: &Option<RequiredEnd>, name: &str) -> bool {
    matches!(end, Some(RequiredEnd::Requirement { closed: true, names, .. }) if names == &[name])
}

/// One loop three times: its gain is `K`, `sqrt(2) K` and `exp(K)`.
#[test]
fn the_damping_of_a_discrete_loop_over_three_coefficient_rings() {
    let requirement = Requirement::damping(number("2/5")).unwrap();
    let loops = [
        ("k", "0", "7.286368919065204252291676"),
        ("k*sqrt(2)", "0", "5.152240872897900191668349"),
        ("exp(k)", "-4", "1.986005331268996552197335"),
    ];
    for (gain, least, expected) in tried(loops, 3) {
        let model = discrete(&format!("1000*z^4 - 1900*z^3 + 900*z^2 + ({gain})*(11*z - 10)"), "");
        let set = set_on(&model, "k", [least, "100"], &requirement);
        assert_eq!(ends(&set, 25), [[least.to_owned(), expected.to_owned()]], "{gain}");
        assert!(is_binding(&set.intervals[0].upper, "damping"), "{gain}");
    }
}

/// `z - gain`: the modulus is to be `exp(-4 T/t) = exp(-1/2)` at most.
#[test]
fn the_settling_time_over_three_coefficient_rings() {
    let requirement = Requirement::settling_time(number("4/5"), &number("1/10")).unwrap();
    let loops = [
        ("K", ["-1", "2"], ["-0.606530659713", "0.606530659713"]),
        ("K*sqrt(2)", ["-1", "2"], ["-0.428881942480", "0.428881942480"]),
        ("exp(-K)", ["0", "1"], ["0.5", "1"]),
    ];
    for (gain, domain, expected) in loops {
        let model = load(&format!(
            "time = 'discrete'\nsample_time = '1/10'\nparameters.K = {{}}\nloop.characteristic = 'z - ({gain})'\n"
        ));
        let set = set_on(&model, "K", domain, &requirement);
        assert_eq!(ends(&set, 12), [expected.map(str::to_owned)], "{gain}");
    }
}

/// `s^2 + 2 s + gain` has the damping `1/sqrt(gain)`.
#[test]
fn the_damping_of_a_continuous_loop_over_three_coefficient_rings() {
    let requirement = Requirement::damping(number("1/2")).unwrap();
    for (gain, least, expected) in
        [("k", "0", "4"), ("k*sqrt(2)", "0", "2.82842712475"), ("exp(k)", "-1", "1.38629436112")]
    {
        let set = set_on(&continuous(&format!("s^2 + 2*s + {gain}"), ""), "k", [least, "9"], &requirement);
        assert_eq!(ends(&set, 12), [[least.to_owned(), expected.to_owned()]], "{gain}");
        assert!(is_binding(&set.intervals[0].upper, "damping"), "{gain}");
    }
}

fn lag(parameters: &str) -> Model {
    load(&format!(
        "time = 'discrete'\nsample_time = 'T'\n[parameters]\n{parameters}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'gain'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
         [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '1/(a*s + 1)'\ndiscretize = 'zoh'\n"
    ))
}

/// A lag behind a hold has the root `x - K (1 - x)`, `x = exp(-T/a)`. A negative root of modulus `r` has a damping of 3/5 for
/// `r = exp(-3 pi/4)`.
#[test]
#[ignore = "long: CI runs it"]
fn a_negative_root_of_a_lag_behind_a_hold() {
    let model = lag("K = { nominal = 12 }\nT = { nominal = '1/10' }\na = { nominal = 1 }");
    let requirement = Requirement::damping(number("3/5")).unwrap();
    let sets = [
        ("K", ["0", "12"], ["0", "10.50431400921682719905550"]),
        ("T", ["1/100", "1/5"], ["0.01", "0.08797241694906395944991322"]),
        ("a", ["1/2", "3"], ["1.136719934134582350501647", "3"]),
    ];
    for (name, domain, expected) in sets {
        let mut question = keeping(&model, &[name]);
        for (other, value) in [("K", "12"), ("T", "1/10"), ("a", "1")] {
            question = if other == name { question } else { question.set(other, number(value)) };
        }
        let range = Range::between(Some(number(domain[0])), Some(number(domain[1])));
        let problem = question.domain(name, range).problem().unwrap();
        let answer = problem.required_set(std::slice::from_ref(&requirement), None, &Budget::unlimited()).unwrap();
        assert_eq!(ends(answer.value(), 25), [expected.map(str::to_owned)], "{name}");
        // The same at points on either side.
        for (value, met) in [("9", true), ("21/2", true), ("10.505", false)] {
            let question = model.ask().set("K", number(value)).set("T", ratio(1, 10)).set("a", ratio(1, 1));
            let found = question.problem().unwrap();
            let found = found.requirements_met(std::slice::from_ref(&requirement), None, &Budget::unlimited()).unwrap();
            assert_eq!(found[0].met, met, "K = {value}");
        }
    }
}

/// With the short sample time of a drive all roots are near to 1, and those of the closed speed loop nearest.
#[test]
#[ignore = "long: CI runs it"]
fn a_drive_with_a_short_sample_time_has_a_required_damping() {
    let run = jurist(&["intervals", "--param", "K_pwm", "--damping", "0.3", "--digits", "9"]);
    assert!(
        run.stdout.contains("0.227337999748 <= K_pwm <= 321.886425762")
            || run.stdout.contains("0.227338000 <= K_pwm <= 321.886426"),
        "{}",
        run.stdout
    );
    let held = jurist(&["verdict", "examples/drive-hold.toml", "--damping", "0.3", "--settling-time", "0.5"]);
    assert_eq!(held.status, 1, "{}", held.stdout);
    assert!(held.stdout.contains("damping >= 3/10: met") && held.stdout.contains("settling_time <= 1/2: not met"));
}

/// A root whose modulus is the required one by an identity: `exp(-4 T/t)` is met. `verdict` and `intervals` say the same.
#[test]
fn a_settling_time_is_met_at_equality() {
    let model = load(
        "time = 'discrete'\nsample_time = '1/10'\nconstants.c = '(1 - exp(-1/5))*10'\nparameters.K = { nominal = 1, min = 0 }\n\
         [loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'gain'\ninput = 'r - y'\noutput = 'u'\ngain = 'c*K'\n\
         [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '1/s'\ndiscretize = 'zoh'\n",
    );
    let requirement = Requirement::settling_time(number("2"), &number("1/10")).unwrap();
    let list = std::slice::from_ref(&requirement);
    let met = model.ask().problem().unwrap().requirements_met(list, None, &Budget::unlimited()).unwrap();
    assert!(met[0].met);
    let set = set_on(&model, "K", ["0", "100"], &requirement);
    // 1 - (1 - x) K = x and = -x with x = exp(-1/5)
    assert_eq!(ends(&set, 12), [["1".to_owned(), "10.0333111323".to_owned()]]);
    assert!(set.intervals[0].contains(&number("1")));
}

/// A factor of the loop whose root is on the required circle whatever the gain is: no boundary function tells anything.
#[test]
fn a_root_that_is_always_on_the_boundary_is_refused() {
    let text = "time = 'discrete'\nsample_time = '1/10'\nparameters.K = {}\n\
                loop.characteristic = '(z - exp(-1/5))*(z - K)'\n";
    let requirement = Requirement::settling_time(number("2"), &number("1/10")).unwrap();
    let problem = keeping(&load(text), &["K"]).problem().unwrap();
    let refused = problem.required_set(std::slice::from_ref(&requirement), None, &Budget::unlimited()).unwrap_err();
    assert!(refused.to_string().contains("settling_time is not decided for this loop"), "{refused}");
}

/// At `s = 0` stability ends at the same transcendental number for the sector as for the half plane.
#[test]
fn an_end_of_stability_is_no_end_of_a_damping() {
    let requirement = Requirement::damping(number("1/2")).unwrap();
    // s^2 + s + pi + k: the damping is 1/(2 sqrt(pi + k))
    let set = set_on(&continuous("s^2 + s + pi + k", ""), "k", ["-9", "9"], &requirement);
    assert_eq!(ends(&set, 12), [["-3.14159265359".to_owned(), "-2.14159265359".to_owned()]]);
}

/// At the gain 0 the damping is the plant's own, which is the required one. No identity of the coefficients says so.
#[test]
#[ignore = "long: CI runs it"]
fn a_damping_that_is_met_with_equality_is_a_bracket() {
    let model = load(
        "time = 'discrete'\nsample_time = '1/10'\nparameters.K = {}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'gain'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
         [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s^2 + s + 1)'\ndiscretize = 'zoh'\n",
    );
    let set = set_on(&model, "K", ["-1/2", "1"], &Requirement::damping(number("1/2")).unwrap());
    let [bracket] = set.undecided.as_slice() else { panic!("{:?}", set.undecided) };
    let (lower, upper) = (bracket.lower.clone().unwrap(), bracket.upper.clone().unwrap());
    assert!(lower < ratio(0, 1) && upper > ratio(0, 1) && upper - lower < ratio(1, 1_000_000_000));
    assert!(set.intervals.iter().any(|i| i.contains(&number("-1/10"))));
    assert!(!set.intervals.iter().any(|i| i.contains(&number("1/10"))));
}

/// The damping `1/sqrt(4 + (k - 1)^2)` reaches 1/2 at one value; `verdict` says the same there.
#[test]
fn a_damping_that_is_reached_once_is_met_at_that_value() {
    let requirement = Requirement::damping(number("1/2")).unwrap();
    for square in ["(k - 1)^2", "sqrt(2)*(k - 1)^2"] {
        let model = continuous(&format!("s^2 + 2*s + 4 + {square}"), "");
        let set = set_on(&model, "k", ["-5", "5"], &requirement);
        assert_eq!(ends(&set, 9), [["1".to_owned(), "1".to_owned()]], "{square}");
        assert!(set.intervals[0].contains(&number("1")) && !set.intervals[0].contains(&number("1.01")));
        let point = model.ask().set("k", number("1")).problem().unwrap();
        assert!(point.requirements_met(std::slice::from_ref(&requirement), None, &Budget::unlimited()).unwrap()[0].met);
    }
}
