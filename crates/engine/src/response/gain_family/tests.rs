use super::*;
use crate::error::Source;
use crate::model::Model;
use crate::problem::Ask;
use crate::response::over_symbols::SymbolicFamily;
use jurist_algebra::number::parse_number;
use std::sync::Arc;

/// A unity feedback loop with a gain `K`, and the plant behind a hold.
fn problem(controller: &str, plant: &str, sample_time: &str) -> Arc<Problem> {
    let text = format!(
        "time = 'discrete'\nsample_time = '{sample_time}'\n[parameters]\nK = {{ nominal = 1 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ntransfer = '{controller}'\n\
         [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\ndiscretize = 'zoh'\n"
    );
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    model.ask().free("K").problem().unwrap()
}

fn cut() -> Cut {
    Cut::Input("C".to_owned())
}

fn required() -> Vec<Requirement> {
    let number = |text| parse_number(text).unwrap();
    vec![
        Requirement::phase_margin(&number("40")).unwrap(),
        Requirement::phase_margin(&number("90")).unwrap(),
        Requirement::gain_margin(&number("1.5")).unwrap(),
        Requirement::modulus_margin(number("0.4")).unwrap(),
        Requirement::modulus_margin(number("1")).unwrap(),
        Requirement::complementary_peak(number("1.5")).unwrap(),
        Requirement::disk_margin(number("0.6")).unwrap(),
    ]
}

/// Ends to twelve digits, with whether they are met themselves.
fn ends(set: &RequiredSet) -> Vec<[Option<(String, bool)>; 2]> {
    assert!(set.undecided.is_empty(), "{:?}", set.undecided);
    let shown =
        |end: &Option<crate::response::RequiredEnd>| end.as_ref().map(|end| (end.value().decimal(12), end.is_closed()));
    set.intervals.iter().map(|i| [shown(&i.lower), shown(&i.upper)]).collect()
}

#[test]
#[ignore = "long: CI runs it"]
fn zeros_in_the_frequency_give_the_ends_that_resultants_give() {
    let budget = Budget::unlimited();
    for (controller, plant, time) in
        [("K", "2/(s + 2)", "1/5"), ("K", "1/(s*(s + 1))", "1/2"), ("K*(z - 9/10)/(z - 1)", "1/(s + 1)", "1/4")]
    {
        let problem = problem(controller, plant, time);
        let stable = problem.stable_set(&budget).unwrap().into_value();
        let fast = GainFamily::of(&problem, &cut(), &budget).unwrap().expect("a multiple of K");
        let slow = SymbolicFamily::of(&problem, cut(), &budget).unwrap().expect("over constants");
        for requirement in required() {
            let list = std::slice::from_ref(&requirement);
            let found = ends(&fast.required_set(list, &stable, &budget).unwrap());
            let known = ends(&slow.required_set(list, &stable, &budget).unwrap());
            assert_eq!(found, known, "{controller} {plant} {}", requirement.name());
        }
    }
}

#[test]
fn only_multiples_of_the_gain_are_such_families() {
    let budget = Budget::unlimited();
    let is =
        |controller: &str| GainFamily::of(&problem(controller, "1/(s + 1)", "1/4"), &cut(), &budget).unwrap().is_some();
    assert!(is("K") && is("K*(z - 1/2)/(z - 1)") && is("K/(z - 1)"));
    assert!(!is("K + 1/(z - 1)") && !is("1 + K/(z - 1)") && !is("1/(z - K)") && !is("K^2/z") && !is("1/(z/K)"));
}
