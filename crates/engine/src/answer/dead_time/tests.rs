//! Loops with dead time from their files: limits found another way, in floating point with 45 digits, and what is refused.

use crate::answer::Verdict;
use crate::error::{Code, Error, Source};
use crate::model::Model;
use crate::problem::{Ask, Question};
use crate::stability::{End, Range, StableInterval};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn load(text: &str) -> Model {
    Model::from_toml(&Source::new("model.toml", text)).unwrap_or_else(|e| panic!("{e}\n{text}")).0
}

macro_rules! example {
    ($name:literal) => {
        load(include_str!(concat!("../../../../../examples/", $name, ".toml")))
    };
}

/// `lower cause .. upper cause` of each interval.
fn stable(question: Question, digits: usize) -> Vec<String> {
    let answer = question.stable_set(&Budget::unlimited()).unwrap();
    let text = |end: &Option<End>| match end {
        None => "inf".to_owned(),
        Some(end) => format!("{} {}", end.value.decimal(digits), end.causes),
    };
    answer.value().intervals().iter().map(|i| format!("{} .. {}", text(&i.lower), text(&i.upper))).collect()
}

fn of(model: &Model, parameter: &str, digits: usize) -> Vec<String> {
    stable(model.ask().free(parameter), digits)
}

#[test]
fn a_process_with_dead_time_under_pi() {
    let model = example!("dead-time-pi");
    assert_eq!(of(&model, "K_c", 33), ["0 s=0+domain .. 2.51357550285993310960993247657737 complex pair"]);
    assert_eq!(of(&model, "theta", 33), ["0 domain .. 7.03533180240499885362906516078883 complex pair"]);
    assert_eq!(of(&model, "T_i", 31), ["2.375784199948079302446349181993 complex pair .. inf"]);
}

#[test]
fn a_process_with_dead_time_under_pid() {
    let model = example!("dead-time-pid");
    assert_eq!(of(&model, "K", 33), ["0 s=0+domain .. 15.6433147019815560408616923829436 complex pair"]);
    assert_eq!(of(&model, "theta", 33), ["0 domain .. 3.28009131133422268417788907862137 complex pair"]);
}

#[test]
fn a_smith_predictor_with_a_wrong_dead_time() {
    let model = example!("smith-predictor");
    assert_eq!(of(&model, "K", 33), ["0 domain .. 3.55035313431965223201287823332935 complex pair"]);
}

#[test]
fn an_oscillator_with_delayed_feedback_has_three_windows() {
    let model = example!("delayed-oscillator");
    assert_eq!(
        of(&model, "tau", 33),
        [
            "0 complex pair+domain .. 2.86786860477273822091832340362727 complex pair",
            "7.02481473104072639315637464320489 complex pair .. 8.60360581431821466275497021088180 complex pair",
            "14.0496294620814527863127492864098 complex pair .. 14.3393430238636911045916170181363 complex pair",
        ]
    );
}

#[test]
fn a_loop_of_neutral_type() {
    let model = example!("neutral-loop");
    assert_eq!(of(&model, "K", 33), ["-0.25 s=0 .. 0.572196101583350712476961654724196 complex pair"]);
    assert_eq!(of(&model, "tau", 33), ["0 domain .. 1.24904577239825442582991707728109 complex pair"]);
}

#[test]
fn a_verdict_counts_the_roots_to_the_right() {
    let model = example!("delayed-oscillator");
    let at = |tau: &str| model.ask().set("tau", number(tau)).verdict(&Budget::unlimited()).unwrap().into_value();
    let counted = |tau: &str| {
        let answer = at(tau);
        let delayed = answer.delayed.expect("dead time");
        (answer.verdict, delayed.on, delayed.right)
    };
    assert_eq!(counted("1"), (Verdict::Stable, 0, Some(0)));
    assert_eq!(counted("3"), (Verdict::Unstable, 0, Some(2)));
    assert_eq!(counted("20.5"), (Verdict::Unstable, 0, Some(4)));
    // Without delay it is a polynomial: s^2 + 0.8.
    let none = at("0");
    assert_eq!((none.verdict, none.count.unwrap().on), (Verdict::Marginal, 2));
}

#[test]
fn a_block_of_dead_time_and_an_exponential_are_the_same() {
    let block = load(
        "time = 'continuous'\n[parameters]\nK = {}\ntau = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\n\
         [[block]]\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
         [[block]]\ninput = 'u'\noutput = 'v'\ndelay = 'tau'\n\
         [[block]]\ninput = 'v'\noutput = 'y'\ntransfer = '1/(s + 1)'",
    );
    let exponential = load(
        "time = 'continuous'\n[parameters]\nK = {}\ntau = { nominal = 1, min = 0 }\n\
         [loop]\ncharacteristic = 's + 1 + K*exp(-tau*s)'",
    );
    let limit = "-1 s=0 .. 2.261826334114651437542573924426004 complex pair";
    for model in [&block, &exponential] {
        assert_eq!(of(model, "K", 34), [limit]);
    }
    let windows = |model: &Model| stable(model.ask().set("K", 2).free("tau"), 25);
    assert_eq!(windows(&block), windows(&exponential));
}

#[test]
fn dead_times_that_are_multiples_of_one_are_treated_together() {
    let model = load(
        "time = 'continuous'\n[parameters]\nK = { nominal = 1 }\ntau = { nominal = 1, min = 0 }\n\
         [loop]\ncharacteristic = 's + 1 + K*exp(-tau*s) + exp(-2*tau*s)/2 + exp(-tau*s/2)/4'",
    );
    let found = of(&model, "tau", 12);
    assert!(!found.is_empty());
    let found = stable(model.ask().free("K").domain("K", Range::between(Some(number("-10")), Some(number("10")))), 12);
    assert_eq!(found.len(), 1, "{found:?}");
}

fn refused(question: Question) -> (Code, String) {
    match question.stable_set(&Budget::unlimited()) {
        Err(Error::Refused(list)) => {
            let first = &list.diagnostics()[0];
            (first.code, first.message.clone())
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_cannot_be_asked_of_dead_time_is_refused_with_a_reason() {
    let model = |characteristic: &str| {
        load(&format!(
            "time = 'continuous'\n[parameters]\nK = {{ nominal = 1 }}\ntau = {{ nominal = 1, min = 0 }}\n\
             [loop]\ncharacteristic = '{characteristic}'"
        ))
    };
    for (characteristic, parameter, message) in [
        ("s + tau + K*exp(-tau*s)", "tau", "roots can be on the boundary at frequencies without end"),
        ("s + 1 + K^2*exp(-tau*s)", "K", "roots can be on the boundary at frequencies without end"),
        ("s + 1 + K*exp(-tau*s) + exp(-s)", "tau", "the dead times are not rational multiples of one of them"),
        ("s + 1 + K*exp(-sqrt(2)*s)", "K", "a dead time is a function, or a constant, that is not rational"),
        ("s + 1 + K*exp(-sqrt(tau)*s)", "tau", "a dead time is a function, or a constant, that is not rational"),
        ("s + 1 + K*exp(-tau*s) + K*exp(-2*tau*s)", "K", "'K' enters in several terms with different dead times"),
        ("s^2 + 2*s + 2 + 2*K*s*exp(-tau*s)", "tau", "roots touch the imaginary axis at infinitely many dead times"),
    ] {
        let (code, said) = refused(model(characteristic).ask().free(parameter));
        assert_eq!(code, Code::DeadTime, "{characteristic}");
        assert!(said.starts_with(message), "{characteristic}: {said}");
    }
}

#[test]
fn a_prediction_is_refused_where_it_stands() {
    let text = "time = 'continuous'\n[parameters]\nK = 1\n[loop]\ncharacteristic = 's + 1 + K*exp(2*s)'";
    let refused = Model::from_toml(&Source::new("model.toml", text)).unwrap_err();
    assert_eq!(refused.code(), Code::DeadTime);
    assert!(refused.to_string().contains("looks ahead"), "{refused}");
}

/// A dead time that rises and one that falls, alone and with the parameter elsewhere: below zero there is no loop.
#[test]
fn a_dead_time_is_never_negative_whatever_the_domain_says() {
    for (characteristic, domain, expected) in [
        ("s + 1 + exp(-p*s)/2", ("-1", "1"), Some("0 domain .. 1 domain")),
        ("s + 1 + exp(-(1 - p)*s)/2", ("0", "3"), Some("0 domain .. 1 domain")),
        ("s + 1 + exp(-p*s)/2", ("-1", "0"), None),
        ("s + 1 + exp(-(1 - p)*s)/2", ("1", "3"), None),
        // Stable as long as p (2 - p) < pi/2.
        ("s + (2 - p)*exp(-p*s)", ("-1", "3"), Some("0 domain .. 2 s=0")),
        ("s + p*exp(-(2 - p)*s)", ("-1", "3"), Some("0 s=0 .. 2 domain")),
        ("s + p*exp(-(2 - p)*s)", ("2", "3"), None),
    ] {
        let model =
            load(&format!("time = 'continuous'\nparameters.p = {{}}\nloop.characteristic = '{characteristic}'"));
        let domain = Range::between(Some(number(domain.0)), Some(number(domain.1)));
        let found = stable(model.ask().free("p").domain("p", domain.clone()), 12);
        assert_eq!(found, expected.into_iter().collect::<Vec<_>>(), "{characteristic} {domain:?}");
    }
}

/// `s + 1/2 + exp(-(tau - 2) s)` is `s + 3/2` at 2, and the loop has no meaning below.
#[test]
fn the_value_without_dead_time_belongs_to_the_answer_where_the_domain_goes_beyond() {
    let model = |text: &str| {
        load(&format!("time = 'continuous'\n[parameters]\nK = 0.5\ntau = 3\n[loop]\ncharacteristic = '{text}'\n"))
    };
    let shown = |text: &str, domain: Range| {
        let question = model(text).ask().free("tau").domain("tau", domain);
        let answer = question.stable_set(&Budget::unlimited()).unwrap();
        lines_of(&answer)
    };
    let whole = Range::all();
    assert_eq!(shown("s + K + exp(-(tau-2)*s)", whole.clone()), ["2 <= tau < 4.418"]);
    assert_eq!(shown("s + K + exp(-(2-tau)*s)", whole.clone()), ["-0.4184 < tau <= 2"]);
    assert_eq!(shown("s + K + exp(-(tau-2)*s)", Range::between(Some(number("2")), None)), ["2 < tau < 4.418"]);
    // Advanced: stable without dead time alone. The degree is lost there: not even so.
    assert_eq!(shown("s + 1 + 2*s*exp(-(tau-2)*s)", whole.clone()), ["tau = 2"]);
    assert_eq!(shown("s^2*(1 - exp(-(tau-2)*s)) + s + K", whole.clone()), [""; 0]);
    // A parameter that is elsewhere as well.
    let bounded = Range::between(Some(number("1")), Some(number("5")));
    let lines = shown("s + tau/8 + exp(-(tau-2)*s)", bounded);
    assert!(lines.len() == 1 && lines[0].starts_with("2 <= tau < "), "{lines:?}");
}

/// `2 <= tau < 4.418`, `tau = 2`.
fn lines_of(answer: &crate::answer::Answer<crate::stability::StableSet>) -> Vec<String> {
    let less = |end: &End| if end.closed { "<=" } else { "<" };
    let line = |interval: &StableInterval| {
        let [lower, upper] =
            [&interval.lower, &interval.upper].map(|end| end.as_ref().expect("the windows are bounded"));
        let [l, u] = [lower, upper].map(|end| end.value.decimal(4));
        match l == u {
            true => format!("tau = {l}"),
            false => format!("{l} {} tau {} {u}", less(lower), less(upper)),
        }
    };
    answer.value().intervals().iter().map(line).collect()
}

/// In higher powers the parameter is solved for another way, which knew of the root at zero only.
#[test]
fn the_highest_power_that_vanishes_where_a_root_is_at_zero_is_named_too() {
    for power in ["p", "p^2"] {
        let text = format!(
            "time = 'continuous'\n[parameters]\np = {{ nominal = 0.1, min = -1, max = 1 }}\n[loop]\n\
             characteristic = '{power}*s^2 + s + p*exp(-s)'\n"
        );
        assert_eq!(of(&load(&text), "p", 6), ["0 s=0+infinity .. 1 domain"], "{power}");
    }
}
