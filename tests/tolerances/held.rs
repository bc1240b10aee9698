//! Boxes of a loop whose motor is behind a hold: constants that are exponentials of fixed times.

use crate::helpers::model::example;
use crate::helpers::number::number;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest, Verdict};
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
