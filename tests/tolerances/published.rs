//! Published problems: the largest factor of their tolerances, each confirmed a second way.

use crate::helpers::model::{example, example_text, load};
use crate::helpers::number::number;
use crate::helpers::thorough::{count, tried};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::Domain;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest, Verdict};
use jurist_engine::model::Model;
use jurist_engine::stability::boxes::{BoxDecision, Place};

fn asked(model: &Model, request: &ToleranceRequest) -> Answer<ToleranceAnswer> {
    model.ask().tolerance(request, &Budget::unlimited()).unwrap()
}

/// The answer with the tolerances of an example, its exact factor asked for.
fn of_example(name: &str) -> Answer<ToleranceAnswer> {
    let model = example(name);
    asked(&model, &ToleranceRequest::of_model(&model).exact())
}

/// The verdict at a point by the question for one point, which knows nothing of boxes.
fn verdict_at(answer: &Answer<ToleranceAnswer>, point: &[Rational]) -> Verdict {
    let problem = answer.problem();
    let names = problem.free().iter().map(|free| free.name.clone());
    let question = problem.model().ask().set_all(problem.set().to_vec()).set_all(names.zip(point.iter().cloned()));
    question.verdict(&Budget::unlimited()).unwrap().value().verdict
}

/// The first digits of the factor lie in the bracket, the witness is not stable, all corners of the proved box are.
fn confirm(answer: &Answer<ToleranceAnswer>, digits: &str) {
    let factor = answer.value().factor.as_ref().unwrap();
    let (lower, upper) = (&factor.lower, factor.upper.as_ref().unwrap());
    let value = number(digits);
    assert!(*lower <= value && value <= *upper, "{digits}: {lower} {upper}");
    assert!(&(upper - lower) * &Rational::from(1_000_000) <= *upper, "{digits}: the bracket is narrow");
    let witness = factor.witness.as_ref().expect("a point beyond");
    assert_ne!(verdict_at(answer, &witness.point), Verdict::Stable);
    let sides: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(lower)).collect();
    for mask in 0..1usize << sides.len().min(6) {
        let corner: Vec<Rational> =
            sides.iter().enumerate().map(|(i, side)| side[mask >> (i % 6) & 1].clone()).collect();
        assert_eq!(verdict_at(answer, &corner), Verdict::Stable);
    }
    let worst = answer.value().worst.as_ref().expect("an end");
    let places = digits.chars().filter(char::is_ascii_digit).count();
    assert!(
        worst.end.value.decimal(places + 2).starts_with(&digits[..digits.len() - 1]),
        "{}",
        worst.end.value.decimal(places + 2)
    );
}

#[test]
fn de_gaston_and_safonov_1988() {
    let answer = of_example("de-gaston-safonov");
    confirm(&answer, "3.41739553123723210518");
    assert!(answer.value().decision.is_stable());
    assert!(answer.value().exact.is_some());
    let end = &answer.value().worst.as_ref().unwrap().end;
    let polynomial = end.value.algebraic().unwrap().polynomial();
    let quoted = [-428_800_000i64, 114_000_000, 3_380_000, -5000, -450, 9];
    let quoted = jurist_algebra::poly::UniPoly::from_i64(&quoted);
    assert!(polynomial.gcd(&quoted).degree() == Some(5), "the published corner's polynomial of degree 5");
    // The printed factor is beyond the true one.
    let model = example("de-gaston-safonov");
    let printed = ToleranceRequest::new(
        ToleranceRequest::of_model(&model).tolerances.into_iter().zip(answer.value().sides.iter()).map(
            |((name, _), side)| {
                let width = &side.widths()[0] * &number("3.436");
                (name, width.to_string().parse().unwrap())
            },
        ),
    );
    assert!(matches!(asked(&model, &printed).value().decision, BoxDecision::NotStable { witness: Some(_) }));
}

#[test]
fn vicino_tesi_and_milanese_1990() {
    let answer = of_example("vicino-tesi-milanese");
    confirm(&answer, "6.27463433653790895");
    assert!(answer.value().decision.is_stable());
    assert!(answer.value().exact.is_some());
}

#[test]
fn the_bus_is_not_stable_over_its_whole_range() {
    let answer = of_example("bus-steering");
    confirm(&answer, "0.98877122828155173794");
    assert!(answer.value().exact.is_some());
    let BoxDecision::NotStable { witness: Some(witness) } = &answer.value().decision else { panic!("a witness") };
    assert_eq!(verdict_at(&answer, &witness.point), Verdict::Unstable);
}

#[test]
#[ignore = "long: CI runs it"]
fn the_engine_is_stable_over_its_operating_range() {
    let answer = of_example("fiat-dedra");
    assert!(answer.value().decision.is_stable());
    confirm(&answer, "1.463330048511604");
    assert_eq!(answer.value().worst.as_ref().unwrap().end.causes.to_string(), "s=0");
}

#[test]
fn an_unstable_disc_that_lines_miss_is_found() {
    let answer = of_example("unstable-disc");
    let factor = answer.value().factor.as_ref().unwrap();
    let exact = number("3/11");
    // The point of the disc (q1 - 1)^2 + (q2 - 1)^2 <= 1/100 that is nearest is (11/10, 1), inside of a side of the box.
    assert_eq!(factor.upper.as_ref(), Some(&exact));
    assert!(factor.lower < exact && &exact - &factor.lower <= &exact * &number("1e-6"), "{}", factor.lower);
    assert_eq!(factor.witness.as_ref().unwrap().point, [number("11/10"), number("1")]);
    assert!(!answer.value().decision.is_stable());
    assert!(answer.value().sides[0].at(&factor.lower)[0] > number("11/10"));
}

#[test]
fn the_factor_of_the_disc_is_exact_though_its_point_is_not_a_corner() {
    let answer = of_example("unstable-disc");
    let exact = answer.value().exact.as_ref().expect("closed");
    assert_eq!(exact.value.exact(), Some(number("3/11")));
    let proof = exact.proof.as_ref().expect("by cells");
    assert_eq!(proof.place, [Place::Low, Place::Inside]);
}

/// The disc of `unstable-disc` with another radius.
fn disc(radius: &str) -> Answer<ToleranceAnswer> {
    let text = example_text("unstable-disc");
    let constant = number("1") + &number(radius) * &number(radius);
    let model = load(&text.replace("101/100", &constant.to_string()));
    asked(&model, &ToleranceRequest::of_model(&model))
}

#[test]
fn discs_of_every_radius_are_found_and_kept_clear_of() {
    for (radius, exact) in tried([("1/1000", "399/1100"), ("1/1000000", "399999/1100000"), ("0", "4/11")], 2) {
        let answer = disc(radius);
        let factor = answer.value().factor.as_ref().unwrap();
        let exact = number(exact);
        let upper = factor.upper.as_ref().unwrap();
        assert!(factor.lower < exact && exact <= *upper, "{radius}: {} {upper}", factor.lower);
        assert!(upper - &factor.lower <= upper * &number("1e-6"), "{radius}: {} {upper}", factor.lower);
        assert_ne!(verdict_at(&answer, &factor.witness.as_ref().unwrap().point), Verdict::Stable);
    }
}

/// Tolerances of 20 % of the drive's components.
fn drive(names: &[&str]) -> Answer<ToleranceAnswer> {
    let tolerances = names.iter().map(|name| (*name, "20%".parse().unwrap()));
    asked(&Model::drive(), &ToleranceRequest::new(tolerances))
}

#[test]
fn the_drive_with_four_eight_and_twelve_tolerances() {
    let names = ["R_a", "L_a", "J", "B_v", "K_a", "k_1", "k_2", "E_sw", "K_pi", "K_ii", "K_ps", "K_is"];
    // Twelve take as long as all others.
    for (many, digits) in
        [(8, "2.2998047407519"), (4, "4.0014443545063"), (12, "1.9111019153889")].into_iter().take(count(2, 3))
    {
        let answer = drive(&names[..many]);
        assert!(answer.value().decision.is_stable(), "{many}");
        confirm(&answer, digits);
        let shares = answer.value().factor.as_ref().unwrap().shares.as_ref().unwrap();
        let sum = shares.iter().fold(Rational::ZERO, |sum, share| sum + share);
        assert!((&sum - &Rational::ONE).abs() < number("1e-12"), "{many}: {sum}");
    }
}

#[test]
fn the_drive_has_a_range_of_its_gain_for_all_tolerances() {
    let names = ["R_a", "L_a", "J", "B_v", "K_a", "k_1", "k_2", "E_sw"];
    let request = ToleranceRequest::new(names.iter().map(|name| (*name, "20%".parse().unwrap()))).limit("K_pwm");
    let answer = asked(&Model::drive(), &request);
    let limit = answer.value().limit.as_ref().unwrap();
    let [Some(lower), Some(upper)] = &limit.sides else { panic!("both sides") };
    for (side, digits, next) in
        [(lower, "0.1739825807710", "0.1739825807711"), (upper, "293.7387687938", "293.7387687939")]
    {
        let (first, last) = (number(digits), number(next));
        let unsafe_at = side.unsafe_at.as_ref().unwrap();
        let (low, high) = if side.safe < *unsafe_at { (&side.safe, unsafe_at) } else { (unsafe_at, &side.safe) };
        assert!(*low <= last && first <= *high, "{digits}: {low} {high}");
        assert!(&(high - low) * &Rational::from(1_000_000) <= *high, "six digits");
        let witness = side.factor.witness.as_ref().expect("a witness just outside");
        assert_ne!(verdict_at(&answer, &witness.point), Verdict::Stable);
    }
}

/// The shares are the derivatives of the factor's logarithm by those of the widths.
#[test]
fn shares_are_what_difference_quotients_say() {
    let model = example("de-gaston-safonov");
    let request = ToleranceRequest::of_model(&model);
    let upper = |request: &ToleranceRequest| asked(&model, request).value().worst.as_ref().unwrap().end.value.clone();
    let base = upper(&request).refined_to_digits(20).enclosure().0;
    let answer = asked(&model, &request);
    let shares = answer.value().factor.as_ref().unwrap().shares.clone().unwrap();
    let step = number("1/10000");
    for (i, side) in answer.value().sides.iter().enumerate() {
        let mut wider = request.clone();
        let width = &side.widths()[0] * &(&Rational::ONE + &step);
        wider.tolerances[i].1 = width.to_string().parse().unwrap();
        let moved = upper(&wider).refined_to_digits(20).enclosure().0;
        let quotient = (&base - &moved).checked_div(&(&base * &step)).unwrap();
        assert!((&quotient - &shares[i]).abs() < number("0.0005"), "{i}: {quotient} {}", shares[i]);
    }
}
