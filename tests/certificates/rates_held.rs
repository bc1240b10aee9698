//! Certificates of plants behind holds beside several rates: exact ones of few samples, and by enclosures of the coefficients.

use crate::helpers::certificates::checkers::{PYTHON_EVERY, accept, python, reject};
use crate::helpers::certificates::{emitted, is_true, mutations, with_count_changed};
use crate::helpers::model::{example_text, read};
use crate::helpers::number::number;
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, is_tried, tried};
use jurist::Certificate;
use jurist::certified::certify_intervals;
use jurist::{Ask, Budget};
use jurist_algebra::number::Rational;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::stability::StableSet;
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

/// Real and complex modes, an integrator, modes of third order, dead time, a first-order hold, pulses, direct feedthrough.
const PLANTS: [&str; 8] = [
    "transfer = '1/(s + 1)'\ndiscretize = 'zoh'",
    "transfer = '1/(s*(s + 1))'\ndiscretize = { method = 'zoh', delay = '0.3*T' }",
    "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = 'zoh'",
    "transfer = '1/(s^3 + 2*s^2 + s + 1)'\ndiscretize = 'zoh'",
    "transfer = '1/(s + 1)'\ndiscretize = { method = 'foh', delay = '1.25*T' }",
    "transfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = '1/3' }",
    "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = { method = 'pwm', edge = 'double', duty = '2/5', delay = '0.6*T' }",
    "A = [[0, 1], [-5, -2]]\nB = [[0], [1]]\nC = [[1, '1/7']]\nD = [[1]]\ndiscretize = 'zoh'",
];

/// A controller, an inner gain and a plant, with what the first two say of their rates.
fn cascade(plant: &str, [outer, inner]: [&str; 2]) -> String {
    format!(
        "time = 'discrete'\nsample_time = 'T'\nconstants.T = '1/5'\nparameters.K = {{ nominal = '1/3', min = '1/50' }}\nparameters.b = '1/2'\n\
         [loop]\n[[block]]\ninput = '-y'\noutput = 'w'\ntransfer = 'K*(z + 1/3)/(z - b/3)'\n{outer}\n\
         [[block]]\ninput = 'w - y/9'\noutput = 'u'\ntransfer = '1/z'\n{inner}\n[[block]]\ninput = 'u'\noutput = 'y'\n{plant}\n"
    )
}

fn certified(text: &str) -> (jurist::certified::CertifiedIntervals, StableSet) {
    let answer = read(text).ask().free("K").stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let certified = certify_intervals(&answer, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    (certified, answer.into_value())
}

fn verdict_at(text: &str, value: &str) -> String {
    let answer = read(text).ask().set("K", number(value)).verdict(&Budget::unlimited()).unwrap();
    answer.certificate(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// What a tree in one parameter says of ranges.
fn leaves(certificate: &Json) -> Vec<(char, [Rational; 2])> {
    let statement = certificate.get("statement").unwrap();
    let Some(Json::Text(tree)) = statement.get("tree") else { panic!("a tree") };
    let Some(Json::List(ends)) = statement.get("window").and_then(|window| window.get("x")) else { panic!("a window") };
    let end = |json: &Json| match json {
        Json::Text(text) => number(text),
        _ => panic!("a number"),
    };
    let (mut stack, mut out) = (vec![[end(&ends[0]), end(&ends[1])]], Vec::new());
    for letter in tree.chars() {
        let [low, high] = stack.pop().unwrap();
        match letter {
            'x' => {
                let middle = low.midpoint(&high);
                stack.extend([[middle.clone(), high], [low, middle]]);
            }
            leaf => out.push((leaf, [low, high])),
        }
    }
    out
}

/// Whether a leaf is true of a set.
fn is_true_of(set: &StableSet, (letter, [low, high]): &(char, [Rational; 2])) -> bool {
    let before = |end: &Option<jurist_engine::stability::End>, x: &Rational| {
        end.as_ref().is_none_or(|end| end.value.compare_rational(x).is_lt())
    };
    let behind = |end: &Option<jurist_engine::stability::End>, x: &Rational| {
        end.as_ref().is_none_or(|end| end.value.compare_rational(x).is_gt())
    };
    match letter {
        '+' => set.intervals().iter().any(|i| before(&i.lower, low) && behind(&i.upper, high)),
        '-' => !set.intervals().iter().any(|i| before(&i.lower, high) && behind(&i.upper, low)),
        _ => true,
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn the_drive_at_ten_rates_is_certified() {
    let text = example_text("drive-two-rates");
    let answer = read(&text).ask().free("K_ps").stable_set(&Budget::unlimited()).unwrap();
    let found = certify_intervals(&answer, &Budget::with_work(20_000_000_000)).unwrap();
    accept(&text, &found.text);
    assert!(found.proved > number("9999999/10000000") && found.text.contains("jurist/certificate/7"));
    // 144.269...: one of the two beside it is not stable.
    for (value, is_stable) in [("1", true), ("144.2693", true), ("144.2694", false)] {
        let verdict = read(&text).ask().set("K_ps", number(value)).verdict(&Budget::unlimited()).unwrap();
        let certificate = verdict.certificate(&Budget::unlimited()).unwrap();
        assert_eq!(certificate.contains("\"unstable\""), !is_stable);
        accept(&text, &certificate);
        // At other rates, or at one, the loop has other limits: 664.99 and 79.5.
        let others = [("every = 10", "every = 9"), ("every = 10", "every = 20"), ("every = 10\n", "\n")];
        for (from, to) in others {
            let other = text.replace(from, to);
            assert_ne!(other, text);
            let is_proved = check(&other, &certificate, &LIMITS).is_ok();
            assert_eq!(is_proved, is_true(&other, &Json::parse(&certificate).unwrap()), "{value} {to}");
        }
    }
    // At each second sample the polynomials are short, and the answer is proved exactly.
    let second = text.replace("every = 10", "every = 2").replace("K_is*10*T", "K_is*2*T");
    let exact = emitted(&second, "K_ps");
    assert!(exact.contains("jurist/certificate/2"));
    accept(&second, &exact);
    assert!(check(&text, &exact, &LIMITS).is_err());
}

#[test]
#[ignore = "long: CI runs it"]
fn plants_of_all_kinds_are_certified_at_all_rates() {
    let (mut random, mut exact) = (Random::new(5), 0);
    for (k, plant) in PLANTS.iter().enumerate().filter(|(k, _)| is_tried(*k, 3)) {
        let [q, r] = [2 + random.below(4), 1 + random.below(3)];
        let outer = format!("every = {q}\nphase = {}", random.below(q));
        let inner = format!("every = {r}\nphase = {}", random.below(r));
        let text = cascade(plant, [&outer, if k % 2 == 0 { "" } else { &inner }]);
        let (found, set) = certified(&text);
        accept(&text, &found.text);
        if found.window.is_some() {
            let all = leaves(&Json::parse(&found.text).unwrap());
            assert!(all.iter().all(|leaf| is_true_of(&set, leaf)), "{text}");
            assert!(found.proved > number("99999/100000"), "{text}\n{found:?}");
        } else {
            exact += 1;
        }
        for value in ["1/10", "1", "30"] {
            accept(&text, &verdict_at(&text, value));
        }
    }
    assert!(exact < count(PLANTS.len().div_ceil(3), PLANTS.len()));
}

/// Whatever the rates of another model are, of two checkers that accept a verdict each is right.
#[test]
#[ignore = "long: CI runs it"]
fn a_verdict_is_about_these_rates() {
    let mut random = Random::new(77);
    let (mut rejected, mut accepted) = (0, 0);
    for k in 0..60 {
        let mut rate = || {
            let q = 1 + random.below(4);
            format!("every = {q}\nphase = {}", random.below(q))
        };
        let [own, other] =
            [[rate(), rate()], [rate(), rate()]].map(|[a, b]| cascade(PLANTS[k % PLANTS.len()], [&a, &b]));
        let value = ["1/10", "1/3", "1", "3"][k / PLANTS.len() % 4];
        if !own.contains("every = 2") && !own.contains("every = 3") && !own.contains("every = 4") {
            continue;
        }
        let certificate = verdict_at(&own, value);
        let verdict = check(&other, &certificate, &LIMITS);
        if k % PYTHON_EVERY == 0
            && let Some(found) = python(&other, &certificate)
        {
            assert_eq!(found.is_ok(), verdict.is_ok(), "{found:?} {verdict:?}\n{other}\n{certificate}");
        }
        match verdict {
            Err(_) => rejected += 1,
            Ok(_) => {
                assert!(is_true(&other, &Json::parse(&certificate).unwrap()), "{other}\n{certificate}");
                accepted += 1;
            }
        }
    }
    assert!(rejected > 10 && accepted > 0, "{rejected} {accepted}");
}

#[test]
#[ignore = "long: CI runs it"]
fn certificates_by_enclosures_that_lie_are_rejected() {
    let text = cascade(PLANTS[2], ["every = 3\nphase = 1", "every = 2"]);
    for value in tried(["1/10", "30"], 2) {
        let certificate = verdict_at(&text, value);
        for key in ["degree", "inside", "on", "outside", "infinite"] {
            reject(&text, &with_count_changed(&certificate, key), Step::Stable);
        }
        let verdict = if value == "30" { ["unstable", "stable"] } else { ["stable", "unstable"] };
        let [from, to] = verdict.map(|word| format!("\"verdict\": \"{word}\""));
        assert!(certificate.contains(&from));
        reject(&text, &certificate.replace(&from, &to), Step::Stable);
        reject(
            &text,
            &certificate.replace("\"verdict\": ", "\"verdict\" : ").replace(&from, &to).replace("1024", "63"),
            Step::Format,
        );
        reject(&text, &certificate.replace("\"radius\": \"1\"", "\"radius\": \"9/10\""), Step::Model);
        // Too few bits tell nothing.
        for (k, changed) in mutations(&Json::parse(&certificate).unwrap()).one_in(count(5, 1)).enumerate() {
            let changed_text = changed.to_text();
            let found = check(&text, &changed_text, &LIMITS);
            if k % PYTHON_EVERY == 0
                && let Some(other) = python(&text, &changed_text)
            {
                assert_eq!(found.is_ok(), other.is_ok(), "{found:?} {other:?}\n{changed_text}");
            }
            assert!(found.is_err() || is_true(&text, &changed), "{changed_text}");
        }
    }
    let (found, set) = certified(&text);
    let tree = found.text.split("\"tree\": \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    for (i, letter) in tree.char_indices().filter(|(_, letter)| "+-".contains(*letter)) {
        let mut lie = tree.clone();
        lie.replace_range(i..=i, if letter == '+' { "-" } else { "+" });
        let lie = found.text.replace(&format!("\"tree\": \"{tree}\""), &format!("\"tree\": \"{lie}\""));
        assert!(!leaves(&Json::parse(&lie).unwrap()).iter().all(|leaf| is_true_of(&set, leaf)));
        assert_eq!(check(&text, &lie, &LIMITS).unwrap_err().step, Step::Stable);
        if i % PYTHON_EVERY == 0 {
            reject(&text, &lie, Step::Stable);
        }
    }
}

/// Functions that are written in the model are enclosed as well, at one rate and at several.
#[test]
fn verdicts_of_loops_with_written_functions_are_certified() {
    for written in ["exp(-1)", "sqrt(2)/5", "pi/9", "sin(1/3) + cos(2)"] {
        for rates in [["", ""], ["every = 3\nphase = 1", "every = 2"]] {
            let text = cascade(PLANTS[0], rates).replace("b/3", &format!("b/3*({written})"));
            accept(&text, &verdict_at(&text, "1/10"));
            let flat = format!("time = 'discrete'\nparameters.K = 1\nloop.characteristic = 'z^2 - K*z/9 + {written}'");
            accept(&flat, &verdict_at(&flat, "1"));
            reject(&text, &verdict_at(&flat, "1"), Step::Model);
        }
    }
}
