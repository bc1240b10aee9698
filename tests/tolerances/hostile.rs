//! Questions that are too large or too wide: an answer or a clear refusal, within the budget.

use crate::helpers::model::load;
use crate::helpers::program::{jurist_with_input, within_address_space};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use jurist_engine::error::Error;
use jurist_engine::stability::boxes::BoxDecision;
use std::fmt::Write;

fn text(parameters: &[(&str, &str)], characteristic: &str) -> String {
    let mut text = "time = 'continuous'\n[parameters]\n".to_owned();
    for (i, (nominal, tolerance)) in parameters.iter().enumerate() {
        writeln!(text, "p{i} = {{ nominal = {nominal}, tolerance = {tolerance} }}").unwrap();
    }
    writeln!(text, "[loop]\ncharacteristic = '{characteristic}'").unwrap();
    text
}

fn asked(text: &str, budget: &Budget) -> Result<Answer<ToleranceAnswer>, Error> {
    let model = load(text);
    model.ask().tolerance(&ToleranceRequest::of_model(&model), budget)
}

#[test]
fn thirty_parameters_of_degree_nine_are_refused_with_the_reason() {
    let sum: Vec<String> = (0..30).map(|i| format!("p{i}^9")).collect();
    let text = text(&[("1", "'1%'"); 30], &format!("s^3 + 9*s^2 + ({})*s + 1", sum.join(" + ")));
    let Error::Refused(why) = asked(&text, &Budget::unlimited()).unwrap_err() else { panic!("refused") };
    assert!(why.to_string().contains("30 tolerances have too many Bernstein coefficients"), "{why}");
}

/// What divides and cancels is not in the polynomial, but must not vanish in the box.
#[test]
fn a_divisor_of_degree_nine_in_thirty_parameters_is_refused_though_it_cancels() {
    let sum: Vec<String> = (0..30).map(|i| format!("p{i}^9")).collect();
    let divisor = format!("(1 + {})", sum.join(" + "));
    let text = text(&[("1", "'1%'"); 30], &format!("s + p0 + {divisor}/{divisor}"));
    let Error::Refused(why) = asked(&text, &Budget::unlimited()).unwrap_err() else { panic!("refused") };
    assert!(why.to_string().contains("30 tolerances have too many Bernstein coefficients"), "{why}");
}

#[test]
fn degree_nine_in_four_parameters_is_answered() {
    let text = text(&[("1", "'2%'"); 4], "s^3 + (1 + p0^9 + p1^9)*s^2 + (2 + p1^9*p2^9)*s + p2^9*p3^9");
    assert!(asked(&text, &Budget::unlimited()).unwrap().value().decision.is_stable());
}

#[test]
fn a_box_that_is_a_million_times_the_nominal_has_a_witness() {
    let text = text(&[("1", "'100000000%'"), ("1", "'10%'")], "s^2 + p1*s + p0");
    let answer = asked(&text, &Budget::unlimited()).unwrap();
    assert!(matches!(answer.value().decision, BoxDecision::NotStable { witness: Some(_) }));
}

#[test]
fn a_nominal_point_at_the_edge_of_stability_has_no_factor() {
    let text = text(&[("1", "'10%'"), ("1", "'10%'")], "s^3 + p0*s^2 + s + p1");
    let answer = asked(&text, &Budget::unlimited()).unwrap();
    assert!(answer.value().factor.is_none() && !answer.value().decision.is_stable());
}

#[test]
fn a_nominal_point_just_beside_the_edge_has_a_small_factor() {
    let text = text(&[("1.000001", "'10%'"), ("1", "'10%'")], "s^3 + p0*s^2 + s + p1");
    let answer = asked(&text, &Budget::unlimited()).unwrap();
    let factor = answer.value().factor.as_ref().unwrap();
    let upper = factor.upper.as_ref().unwrap();
    assert!(factor.lower.sign().is_gt() && *upper < "1/100000".parse().unwrap());
    assert!(&(upper - &factor.lower) * &1_000_000.into() <= *upper);
}

#[test]
fn little_work_ends_without_an_answer() {
    let text =
        text(&[("1", "'20%'"); 6], "s^5 + (p0 + p1)*s^4 + (4 + p1*p2)*s^3 + (2 + p2*p3)*s^2 + (3 + p4*p5)*s + p0*p5/2");
    match asked(&text, &Budget::with_work(2_000)) {
        Err(error) => assert!(matches!(error, Error::Stopped(_)), "{error}"),
        Ok(answer) => assert!(!matches!(answer.value().decision, BoxDecision::NotStable { .. })),
    }
}

#[test]
fn the_program_refuses_what_is_too_large_within_its_time() {
    let sum: Vec<String> = (0..30).map(|i| format!("p{i}^9")).collect();
    let text = text(&[("1", "'1%'"); 30], &format!("s^3 + 9*s^2 + ({})*s + 1", sum.join(" + ")));
    let run = jurist_with_input(&["tolerance", "-", "--timeout", "60"], text.as_bytes());
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("E-tolerance") && run.stderr.contains("--fix"), "{}", run.stderr);
}

/// The program may not have more address space than this: a tensor of the greatest size that is worked with takes less than half of it, as
/// integers and then in fixed point.
#[cfg(target_os = "linux")]
const KILOBYTES: usize = 1 << 19;

/// The greatest tensors, and questions that would need far more memory: none asks for more than is there.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "long: CI runs it"]
fn memory_is_bounded() {
    let sum = |count: usize| (0..count).map(|i| format!("p{i}")).collect::<Vec<_>>().join(" + ");
    let powers = |count: usize| (0..count).map(|i| format!("p{i}^9")).collect::<Vec<_>>().join(" + ");
    let product = |count: usize| (0..count).map(|i| format!("p{i}")).collect::<Vec<_>>().join("*");
    let million = "'100000000%'";
    let wide = |count: usize| vec![("1", million); count];
    let questions = [
        // 2^20 coefficients.
        (text(&[("1", "'1%'"); 19], &format!("s^3 + 2*s^2 + (9 + {})*s + {}", sum(19), product(19))), 0, "stable"),
        (text(&[("1", "'1%'"); 20], &format!("s^3 + 2*s^2 + (9 + {})*s + {}", sum(20), product(20))), 2, "E-tolerance"),
        (text(&wide(4), "s^3 + (1 + p0^9 + p1^9)*s^2 + (2 + p1^9*p2^9)*s + p2^9*p3^9"), 1, "not stable"),
        (text(&wide(30), &format!("s^3 + 9*s^2 + ({})*s + 1", powers(30))), 2, "E-tolerance"),
        (text(&wide(30), &format!("s^2 + s + (1 + {0})/(1 + {0})", powers(30))), 2, "E-tolerance"),
        (text(&wide(30), &format!("s^2 + s + {}", product(30).replace('*', "^9*"))), 2, "E-tolerance"),
    ];
    for (text, status, part) in questions {
        let run = within_address_space(KILOBYTES, &["tolerance", "-", "--only", "--timeout", "600"], text.as_bytes());
        assert_eq!(run.status, status, "{}: {}", &text[text.len() - 80..], run.stderr);
        assert!(format!("{}{}", run.stdout, run.stderr).contains(part), "{part}: {} {}", run.stdout, run.stderr);
    }
}

/// With an eighth of it the greatest tensor is not answered, a small one is: the limit is felt.
#[cfg(target_os = "linux")]
#[test]
fn less_address_space_is_felt() {
    let ask = |count: usize| {
        let names: Vec<String> = (0..count).map(|i| format!("p{i}")).collect();
        let characteristic = format!("s^3 + 2*s^2 + (9 + {})*s + {}", names.join(" + "), names.join("*"));
        let text = text(&vec![("1", "'1%'"); count], &characteristic);
        within_address_space(KILOBYTES / 8, &["tolerance", "-", "--only"], text.as_bytes()).status
    };
    assert_eq!(ask(2), 0);
    assert_ne!(ask(19), 0);
}
