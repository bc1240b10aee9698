//! Boxes of a loop whose motor is behind a hold: constants that are exponentials of fixed times.

use crate::helpers::model::{example, keeping, read};
use crate::helpers::number::number;
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest, Verdict};
use jurist_engine::response::{RequiredEnd, Requirement};
use jurist_engine::stability::boxes::BoxDecision;

fn held(names: &[&str], tolerance: &str) -> Answer<ToleranceAnswer> {
    let request = ToleranceRequest::new(names.iter().map(|name| (*name, tolerance.parse().unwrap())));
    example("drive-hold").ask().tolerance(&request, &Budget::unlimited()).unwrap()
}

fn verdict_at(answer: &Answer<ToleranceAnswer>, point: &[Rational]) -> Verdict {
    let problem = answer.problem();
    let names = problem.free().iter().map(|free| free.name.clone());
    let question = problem.model().ask().set_all(names.zip(point.iter().cloned()));
    question.verdict(&Budget::unlimited()).unwrap().value().verdict
}

#[test]
fn gains_around_a_held_motor_are_proved_and_refuted() {
    let answer = held(&["K_pwm", "E_sw", "k_1", "K_pi"], "20%");
    assert!(answer.value().decision.is_stable());
    let factor = answer.value().factor.as_ref().unwrap();
    let upper = factor.upper.as_ref().expect("found");
    assert!(upper - &factor.lower <= upper * &number("1e-6"), "{} {upper}", factor.lower);
    let witness = factor.witness.as_ref().unwrap();
    assert_eq!(witness.point.len(), 4);
    assert_ne!(verdict_at(&answer, &witness.point), Verdict::Stable);
    // All corners of the proved box.
    let sides: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(&factor.lower)).collect();
    for mask in 0..16 {
        let corner: Vec<Rational> = (0..4).map(|i| sides[i][mask >> i & 1].clone()).collect();
        assert_eq!(verdict_at(&answer, &corner), Verdict::Stable, "{mask}");
    }
}

#[test]
fn one_gain_agrees_with_its_stable_set() {
    let answer = held(&["K_pwm"], "50%");
    let set = example("drive-hold").ask().free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
    let stable = &set.value().intervals()[0];
    let factor = answer.value().factor.as_ref().unwrap();
    let side = &answer.value().sides[0];
    let [low, high] = side.at(&factor.lower);
    let below = |e: &jurist_engine::stability::End, x: &Rational| e.value.compare_rational(x).is_lt();
    assert!(below(stable.lower.as_ref().unwrap(), &low) && !below(stable.upper.as_ref().unwrap(), &high));
    let [low, high] = side.at(factor.upper.as_ref().unwrap());
    assert!(!below(stable.lower.as_ref().unwrap(), &low) || below(stable.upper.as_ref().unwrap(), &high));
}

#[test]
fn a_box_beyond_the_limit_has_a_witness() {
    let answer = held(&["K_pwm", "k_1"], "500%");
    let BoxDecision::NotStable { witness: Some(witness) } = &answer.value().decision else { panic!("a witness") };
    assert_ne!(verdict_at(&answer, &witness.point), Verdict::Stable);
}

/// They were undecided, or took half a minute.
#[test]
#[ignore = "long: CI runs it"]
fn one_name_behind_a_hold_has_the_factor_of_its_required_set() {
    let line = |k: &str, a: &str, b: &str| {
        read(&format!(
            "time = 'discrete'\n[parameters]\nK = {{ nominal = '{k}' }}\na = {{ nominal = '{a}', min = '1/10', max = 10 }}\nb = {{ nominal = '{b}' }}\n\
             [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\n\
             transfer = 'K*a/((s + a)*(s + b))'\ndiscretize = {{ method = 'zoh', T = '7/20' }}\n"
        ))
    };
    let lines = [(line("14/5", "3", "3/5"), "a", "103/200"), (line("5/2", "3", "19/10"), "K", "1/5")];
    for (model, name, least) in tried(lines, 2) {
        let requirement = Requirement::modulus_margin(number(least)).unwrap();
        let set = keeping(&model, &[name]).problem().unwrap();
        let set =
            set.required_set(std::slice::from_ref(&requirement), None, &Budget::unlimited()).unwrap().into_value();
        let request = ToleranceRequest::new([(name, "10%".parse().unwrap())]).require([requirement], None);
        let answer = model.ask().tolerance(&request, &Budget::unlimited()).unwrap();
        let found = answer.value();
        assert!(found.decision.is_stable() && found.binding.is_some());
        let (factor, side) = (found.factor.as_ref().unwrap(), &found.sides[0]);
        let around = set.intervals.iter().find(|interval| interval.contains(side.nominal())).unwrap();
        let ends = [&around.lower, &around.upper].into_iter().flatten();
        let distances = ends.filter(|end| matches!(end, RequiredEnd::Requirement { .. })).map(|end| {
            let end = end.value().refined_to_digits(12).enclosure().0;
            ((end - side.nominal()).abs() / &side.widths()[0]).to_f64_approximate()
        });
        let nearest = distances.fold(f64::INFINITY, f64::min);
        let [low, high] = [&factor.lower, factor.upper.as_ref().unwrap()].map(Rational::to_f64_approximate);
        assert!(low <= nearest + 1e-9 && nearest <= high + 1e-9 && high - low < 1e-3 * high, "{low} {nearest} {high}");
    }
}

/// A box that ended where the gain margin is just not met was called good.
#[test]
fn a_box_that_ends_with_a_requirement_is_good_where_it_is_met_at_its_end() {
    let lag = |plant: &str, k: &str| {
        read(&format!(
            "time = 'discrete'\n[parameters]\nK = {{ nominal = '{k}' }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'plant'\n\
             input = 'r - y'\noutput = 'y'\ntransfer = '{plant}'\ndiscretize = {{ method = 'zoh', T = '7/20' }}\n"
        ))
    };
    // More than 2 for K > -1/2; at least 1/5 for K >= -1.52.
    let gain = (lag("K/(s + 1)", "1/2"), Requirement::gain_margin(&number("2")).unwrap(), ["1", "1.01"]);
    let circle = Requirement::modulus_margin(number("1/5")).unwrap();
    let circle = (lag("3*K/((s + 3)*(s + 19/10))", "5/2"), circle, ["4.02", "4.03"]);
    for (is_closed, (model, requirement, [tie, beyond])) in [(false, gain), (true, circle)] {
        for (width, is_good) in [(tie, is_closed), (beyond, false)] {
            let request = ToleranceRequest::new([("K", width.parse().unwrap())]);
            let request = request.require([requirement.clone()], None);
            let answer = model.ask().tolerance(&request, &Budget::unlimited()).unwrap();
            let found = answer.value();
            assert_eq!(found.decision.is_stable(), is_good, "{width}: {found:?}");
            let factor = found.factor.as_ref().unwrap();
            assert_eq!(factor.lower >= Rational::ONE, is_good, "{width}: {factor:?}");
        }
    }
}
