use crate::answer::Verdict;
use crate::error::Source;
use crate::model::Model;
use crate::problem::{Ask, Question};
use crate::response::Requirement;
use crate::stability::{Range, StableSet, symbolic_stable_set};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use proptest::prelude::*;
use std::sync::Arc;

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

/// Two axes of a motor behind one hold, which the speed `w` couples; each has its own controller.
fn axes(r_d: &str, r_q: &str, gain: &str) -> Arc<Model> {
    let controller = |axis: &str| {
        format!(
            "[[block]]\nname = 'PI {axis}'\ninput = 'r - i_{axis}'\noutput = 'v_{axis}'\ntransfer = 'K*(1 + 0.02/(z - 1))'\n\
             [[block]]\nname = 'computation {axis}'\ninput = 'v_{axis}'\noutput = 'u_{axis}'\ndelay = 1\n"
        )
    };
    let text = format!(
        "time = 'discrete'\nsample_time = 'T'\n[constants]\nT = 1e-4\nL = 4e-3\nw = 0\n[parameters]\n\
         K = {{ nominal = {gain}, min = 0 }}\n[loop]\ninputs = ['r']\n{}{}[[block]]\nname = 'motor'\ninput = ['u_d', 'u_q']\n\
         output = ['i_d', 'i_q']\nA = [['-{r_d}/L', 'w'], ['-w', '-{r_q}/L']]\nB = [['1/L', 0], [0, '1/L']]\n\
         C = [[1, 0], [0, 1]]\ndiscretize = 'zoh'\n",
        controller("d"),
        controller("q"),
    );
    Arc::new(Model::from_toml(&Source::new("model.toml", text)).unwrap().0)
}

fn set_of(question: Question) -> StableSet {
    question.stable_set(&Budget::unlimited()).unwrap().into_value()
}

fn is_open(set: &StableSet, x: &Rational) -> bool {
    let above = |lo: &Option<Rational>| lo.as_ref().is_none_or(|lo| lo <= x);
    let below = |hi: &Option<Rational>| hi.as_ref().is_none_or(|hi| x <= hi);
    set.undecided().iter().any(|b| above(&b.lower) && below(&b.upper))
}

/// The whole polynomial at a value, its roots counted: another way than that by which sets are found.
fn is_stable(model: &Arc<Model>, name: &str, x: &Rational) -> bool {
    let answer = model.ask().set(name, x.clone()).verdict(&Budget::unlimited()).unwrap();
    answer.into_value().verdict == Verdict::Stable
}

fn agrees(set: &StableSet, model: &Arc<Model>, name: &str, values: &[Rational]) {
    for x in values.iter().filter(|x| !is_open(set, x)) {
        assert_eq!(set.contains(x), is_stable(model, name, x), "{name} = {x}");
    }
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    for end in ends.filter(|end| end.causes.is_limit()) {
        let (lo, hi) = end.value.refined_to_digits(15).enclosure();
        let share = number("1e-12") * hi.abs();
        let beside = [lo - &share, hi + &share].map(|x| set.contains(&x) == is_stable(model, name, &x));
        assert_eq!(beside, [true, true], "{name} at {}", end.value.decimal(15));
    }
}

/// Both axes reach the circle nearly at once, and so do all products of roots of one with roots of the other.
#[test]
#[ignore = "long: CI runs it"]
fn nearly_equal_axes_are_decided_each_alone_and_the_nominal_value_is_not_in_a_bracket() {
    let model = axes("0.8", "0.8001", "13");
    let set = set_of(model.ask().free("L"));
    assert!(set.contains(&number("4e-3")), "{:?}", set.intervals());
    assert_eq!(set.intervals().len(), 1, "{:?}", set.intervals());
    agrees(&set, &model, "L", &["1e-4", "1.2e-3", "1.4e-3", "2e-3", "4e-3", "0.01", "0.02", "0.1", "1"].map(number));
    let set = set_of(model.ask().free("L").set("w", 500));
    assert!(set.contains(&number("4e-3")), "{:?}", set.intervals());
}

#[test]
#[ignore = "long: CI runs it"]
fn a_parameter_whose_nominal_value_is_zero_is_looked_at_outward_from_there() {
    let model = axes("0.8", "0.9", "13");
    let set = set_of(model.ask().free("w"));
    assert!(["0", "1", "-1", "1000", "-1000"].iter().all(|x| set.contains(&number(x))), "{:?}", set.intervals());
    agrees(&set, &model, "w", &["-9000", "-3000", "3000", "6000", "12000"].map(number));
}

/// `|cot a| < 2`, whose poles and zeros lie in the domain.
#[test]
fn a_cotangent_is_followed_over_its_poles() {
    let (model, _) = Model::from_toml(&Source::new(
        "model.toml",
        "time = 'discrete'\n[parameters]\nK = 0.5\na = { nominal = 0.7, min = -4, max = 4 }\n[loop]\ncharacteristic = 'z - K/tan(a)'\n",
    ))
    .unwrap();
    let set = set_of(model.ask().free("a"));
    assert!(set.undecided().is_empty() && set.intervals().len() == 4, "{:?}", set.intervals());
    // arctan(1/2) = 0.46364760900080...
    for (inside, outside) in [("0.4636477", "0.4636476"), ("2.6779450", "2.6779451"), ("-0.4636477", "-0.4636476")] {
        assert!(set.contains(&number(inside)) && !set.contains(&number(outside)), "{inside}");
    }
    assert!(!set.contains(&number("3.14159")) && !set.contains(&number("0.0001")));
}

/// Where the margin is met is not cut where a resultant vanishes that means nothing.
#[test]
fn a_phase_margin_holds_over_intervals_of_the_parameter() {
    let model = axes("0.8", "0.9", "13");
    let budget = Budget::unlimited();
    let margin = [Requirement::phase_margin(&Rational::from(45)).unwrap()];
    let cases = [
        ("K", Range::between(Some(Rational::from(5)), Some(40.into()))),
        ("w", Range::between(Some(Rational::ZERO), Some(600.into()))),
    ];
    for (name, domain) in cases {
        let problem = model.ask().free(name).domain(name, domain).problem().unwrap();
        let found = problem.required_set(&margin, Some("v_q"), &budget).unwrap().into_value();
        assert!(found.undecided.is_empty(), "{name}: {:?}", found.undecided);
        assert_eq!(found.intervals.len(), 1, "{name}");
        for x in ["6", "13", "20", "30"].map(number) {
            let point = model.ask().set(name, x.clone()).problem().unwrap();
            let met = point.requirements_met(&margin, Some("v_q"), &budget).unwrap()[0].met;
            assert_eq!(found.intervals[0].contains(&x), met, "{name} = {x}");
        }
    }
}

/// No budget ran out: what is asked is not known, and other questions are.
#[test]
fn a_dead_time_beside_another_one_says_what_to_ask_instead() {
    let text = "time = 'continuous'\n[parameters]\ntheta = { nominal = 4, min = 0 }\n[loop]\n\
        characteristic = 's + 1 + exp(-theta*s)/2 + exp(-4*s)/3'\n";
    let model = Model::from_toml(&Source::new("model.toml", text)).unwrap().0;
    let refused = model.ask().free("theta").stable_set(&Budget::unlimited()).unwrap_err();
    let said = format!("{refused:?}");
    let words = ["DeadTime", "not rational multiples", "'map'", "tolerance --tol", "verdict --set"];
    assert!(words.iter().all(|word| said.contains(word)) && !said.contains("budget"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(
        std::env::var("JURIST_LINES").ok().and_then(|n| n.parse().ok()).unwrap_or(2)
    ))]

    /// Random axes, the parameter outside of functions and inside: at each end and at many points the roots are counted, and where
    /// the whole polynomial tells, it is the same set.
    #[test]
    #[ignore = "long: CI runs it"]
    fn sets_of_random_axes_agree_with_counted_roots(
        (r_d, apart, gain) in (1i64..40, 0i64..30, 1i64..30),
        points in prop::collection::vec(1i64..4000, 30),
    ) {
        let model = axes(&format!("{r_d}/20"), &format!("({r_d}/20 + {apart}/2000)"), &gain.to_string());
        for (name, scale) in [("K", "0.02"), ("L", "1e-5")] {
            // What lies between is the same without bounds, and takes longer.
            let domain = Range::between(Some(number("5e-6")), Some(Rational::from(100)));
            let set = set_of(model.ask().free(name).domain(name, domain));
            let values: Vec<Rational> = points.iter().map(|&n| Rational::from(n) * number(scale)).collect();
            agrees(&set, &model, name, &values);
            let nominal = model.ask().free(name).problem().unwrap().parameter().nominal.clone().unwrap();
            prop_assert!(!is_open(&set, &nominal));
        }
        let budget = Budget::unlimited();
        let problem = model.ask().free("K").problem().unwrap();
        let whole = problem.symbolic(&budget).unwrap().unwrap();
        let whole = symbolic_stable_set(&whole, &problem.parameter().domain, problem.shape(), &budget).unwrap();
        let parts = set_of(model.ask().free("K"));
        let ends = |set: &StableSet| -> Vec<String> {
            set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().map(|e| e.value.decimal(20)).collect()
        };
        prop_assert_eq!(ends(&whole), ends(&parts));
    }
}
