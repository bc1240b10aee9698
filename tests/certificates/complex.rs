//! Certificates of loops with complex coefficients: both checkers read the imaginary unit and frames, double the loop, and say what is true of it.

use crate::complex::oracle::Loop;
use crate::complex::table::machine;
use crate::helpers::certificates::checkers::{PYTHON_EVERY, accept, python, reject, reject_or_find_true};
use crate::helpers::certificates::forgeries::forgeries;
use crate::helpers::certificates::{emitted, is_true, verdict_emitted, with_count_changed};
use crate::helpers::model::{example_text, read};
use crate::helpers::number::number;
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, is_thorough, is_tried, tried};
use jurist::Certificate;
use jurist::certified::certify_intervals;
use jurist::{Ask, Budget};
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::answer::ToleranceRequest;
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

/// A loop in `K` and `b`.
fn model(time: &str, form: &str) -> String {
    format!(
        "time = '{time}'\nparameters.K = {{ nominal = '1/2' }}\nparameters.b = {{ nominal = '1/3' }}\n[loop]\n{form}\n"
    )
}

/// Written polynomials, matrices, a feedback, blocks in both times, at one rate and at two, behind a hold; roots that cross at 1 alone, that touch, a
/// degree that is lost, divisors that vanish, a unit that cancels.
fn models() -> Vec<String> {
    let blocks = |first: &str, rest: &str| {
        format!(
            "inputs = ['r']\n[[block]]\ninput = 'r - y'\noutput = 'u'\n{first}\n[[block]]\ninput = 'u'\noutput = 'y'\n{rest}"
        )
    };
    let written = |text: &str| format!("characteristic = '{text}'");
    let plant = "A = [[-1, 'j'], ['K/2', '-2 - j']]\nB = [[1], ['j']]\nC = [[1, 're(2 + j)/(1 + 3*j)']]";
    let sampled = "sample_time = '1/10'\n";
    vec![
        model("discrete", &written("z^2 - (1 + j/4)*z*b + K*(1/2 - j/3)")),
        model("continuous", &written("s^2 + (2 + j)*s + (K + j*b)/(1 + j)")),
        model("discrete", &written("(z - 1 + K)*(z - j*b)")),
        model("discrete", &written("j*z + K*b")),
        model("discrete", &written("j*z^2 + j*K*z + 1/4")),
        model("discrete", &written("(K - 1 + j*(K - 1))*z^2 + z + j*K*b")),
        model("discrete", &written("z + b*K/(K - 1 + j*(K^2 - 1))")),
        model("discrete", &written("z^2 + j*(1 - K^2)")),
        model("discrete", "matrix = [['K*j', 'b'], ['j - K', 'conj(1/2 + j)/4']]"),
        model("discrete", "matrix = [['K', 'j*b'], ['-j/3', '1/2']]"),
        model("continuous", "A = [['-1 + j', 1], [0, -2]]\nB = [[1], ['j']]\nC = [[1, 'b*j']]\nK = [['K']]"),
        model("continuous", &blocks("transfer = 'K*(1 + j*b)/(s + 1 - 2*j)'", plant)),
        model("discrete", &blocks("transfer = 'K*(z + j/3)/(z - b*j)'\nevery = 2", "transfer = '(1 + j)/(3*z)'")),
        model(
            "discrete",
            &blocks(
                "gain = 'K*im(b + 2*j)'",
                "transfer = '1/(s + 1 + j)'\ndiscretize = { method = 'tustin', T = '1/2' }",
            ),
        ),
        sampled.to_owned()
            + &model(
                "discrete",
                &blocks("transfer = 'K*(1 + j*b)/(z - j/2)'", "transfer = '1/(s + 1)'\ndiscretize = 'zoh'"),
            ),
    ]
}

#[test]
fn sets_and_verdicts_of_complex_loops_are_certified() {
    for (number, text) in models().into_iter().enumerate() {
        accept(&text, &emitted(&text, "K"));
        let values = ["0", "1", "-1", "1/2", "2", "-2", "7/3"].into_iter().enumerate();
        for (_, value) in values.filter(|(k, _)| is_tried(number + k, 2)) {
            accept(&text, &verdict_emitted(&text, "K", value));
        }
    }
}

#[test]
fn maps_and_tolerances_of_complex_loops_are_certified() {
    let budget = Budget::unlimited();
    for text in tried(models(), 2) {
        let loop_ = read(&text);
        if loop_.hyperperiod() > 1 {
            continue;
        }
        if !text.contains("zoh") {
            let problem = loop_.ask().free("K").free("b").plane_problem().unwrap();
            accept(
                &text,
                &problem.map(6, &budget).unwrap().certificate(&budget).unwrap_or_else(|e| panic!("{e}\n{text}")),
            );
        }
        let sides = ["K", "b"].map(|name| (name, "20%".parse().unwrap()));
        let request = ToleranceRequest::new(sides).gap(number("1/100"));
        accept(&text, &loop_.ask().tolerance(&request, &budget).unwrap().certificate(&budget).unwrap());
    }
}

/// Of random loops, and of the same with the unit negated: `D` and its conjugate are one doubled polynomial.
#[test]
fn random_loops_and_their_mirror_images_have_one_certificate() {
    let mut random = Random::new(20_261_127);
    for case in 0..count(12, 24) {
        let of = Loop::random(&mut random, case % 2 == 0);
        let (own, mirrored) = (of.text(1), of.text(-1));
        let certificate = emitted(&own, "K");
        accept(&own, &certificate);
        accept(&mirrored, &certificate);
        let verdict = verdict_emitted(&own, "K", "1/3");
        accept(&own, &verdict);
        accept(&mirrored, &verdict);
        for key in ["degree", "inside", "on", "outside", "infinite"] {
            reject(&own, &with_count_changed(&verdict, key), Step::Stable);
        }
        // Without the unit it is another loop, or the same one.
        let other = own.replace("*j", "*0");
        let is_proved = check(&other, &certificate, &LIMITS).is_ok();
        assert!(!is_proved || is_true(&other, &Json::parse(&certificate).unwrap()), "{own}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn changed_certificates_of_complex_loops_are_rejected() {
    for (k, text) in models().iter().enumerate().filter(|(k, _)| [0, 1, 2, 4, 12].contains(k) && is_tried(*k, 2)) {
        let certificate = emitted(text, "K");
        let every = certificate.len() / 600 + 1;
        reject_or_find_true(text, &certificate, every, 20, |changed| is_true(text, changed));
        for forged in forgeries(&Json::parse(&certificate).unwrap()).into_iter().step_by(4) {
            assert!(
                check(text, &forged.to_text(), &LIMITS).is_err() || is_true(text, &forged),
                "{k}\n{}",
                forged.to_text()
            );
        }
        let verdict = verdict_emitted(text, "K", "1/2");
        reject_or_find_true(text, &verdict, 3, 8, |changed| is_true(text, changed));
    }
}

/// A root at 1 alone touches the boundary of the doubled polynomial, which is not negative there: the end is one all the same.
#[test]
fn one_root_that_crosses_at_1_is_an_end() {
    let text = model("discrete", "characteristic = '(z - 1 + K)*(z - j*b)'");
    let certificate = emitted(&text, "K");
    accept(&text, &certificate);
    let statement = check(&text, &certificate, &LIMITS).unwrap().statement;
    assert!(statement.contains("exactly for 0 < K < 2."), "{statement}");
    for value in ["0", "2"] {
        let verdict = verdict_emitted(&text, "K", value);
        assert!(verdict.contains("\"degree\": 2") && verdict.contains("\"on\": 1") && verdict.contains("marginal"));
        accept(&text, &verdict);
    }
    // It only touches: stable on both sides, and no end is left out.
    let touching = model("discrete", "characteristic = '(z - 1 + (K - 1)^2)*(z - j*b)'");
    let certificate = emitted(&touching, "K");
    accept(&touching, &certificate);
    assert!(certificate.contains("{\"at\": \"1\"}"), "{certificate}");
    for forged in forgeries(&Json::parse(&certificate).unwrap()) {
        let forged_text = forged.to_text();
        assert!(check(&touching, &forged_text, &LIMITS).is_err() || is_true(&touching, &forged), "{forged_text}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn a_machine_in_its_frame_is_certified() {
    let text = example_text("pmsm-frame");
    let verdict = |text: &str, speed: &str| verdict_emitted(text, "omega_e", speed);
    for name in ["omega_e", "K_p"] {
        let answer = read(&text).ask().free(name).stable_set(&Budget::unlimited()).unwrap();
        let found = certify_intervals(&answer, &Budget::unlimited()).unwrap();
        assert!(found.proved > number("999999/1000000"), "{name}");
        accept(&text, &found.text);
    }
    // What 'advance' does: 3772.2, 6501.0, 8758.4.
    let advances = ["", ", advance = 'omega_e*T'", ", advance = '1.5*omega_e*T'"];
    for (k, advance) in advances.iter().enumerate() {
        let own = machine(advance);
        let limits = [("3700", 3), ("3800", 2), ("6500", 2), ("6502", 1), ("8758", 1), ("8759", 0)];
        for (speed, limit) in limits.into_iter().enumerate().filter(|(i, _)| is_tried(i + k, 3)).map(|(_, case)| case) {
            let certificate = verdict(&own, speed);
            assert_eq!(certificate.contains("\"stable\""), k + limit >= 3, "{advance} {speed}");
            accept(&own, &certificate);
            for (other_k, other) in advances.iter().enumerate().filter(|(other, _)| *other != k) {
                let other = machine(other);
                match other_k + limit >= 3 {
                    same if same == (k + limit >= 3) => {
                        assert_eq!(
                            check(&other, &certificate, &LIMITS).is_ok(),
                            is_true(&other, &Json::parse(&certificate).unwrap())
                        );
                    }
                    _ => reject(&other, &certificate, Step::Stable),
                }
            }
        }
    }
}

/// Whatever another model says of its frame: what is accepted is true.
#[test]
#[ignore = "long: CI runs it"]
fn certificates_are_about_their_frame() {
    let mut random = Random::new(1963);
    let (mut rejected, mut accepted) = (0, 0);
    for k in 0..count(20, 40) {
        let mut rate = || {
            let (speed, advance) =
                (["w", "-w", "2*w", "w/3"][random.below(4)], ["", "w/5", "3*w/10", "0"][random.below(4)]);
            let (delay, plant) =
                (["0", "T", "T/2", "1.3*T"][random.below(4)], ["1/(s + 1)", "1/(s*(s + 2))"][random.below(2)]);
            let advance = if advance.is_empty() { String::new() } else { format!(", advance = '{advance}'") };
            format!(
                "time = 'discrete'\nsample_time = 'T'\nconstants.T = '1/5'\nparameters.w = {{ nominal = 2 }}\nparameters.K = {{ nominal = 1 }}\n[loop]\n\
                 [[block]]\ninput = '-y'\noutput = 'u'\ntransfer = 'K*(1 + j/9)/z'\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\n\
                 discretize = {{ method = 'zoh', delay = '{delay}', frame = '{speed}'{advance} }}\n"
            )
        };
        let (own, other) = (rate(), rate());
        let gain = ["1/10", "1", "3", "8"][k % 4];
        let answer =
            read(&own).ask().set("K", number(gain)).set("w", number("7/3")).verdict(&Budget::unlimited()).unwrap();
        let certificate = answer.certificate(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{own}"));
        check(&own, &certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{own}"));
        let found = check(&other, &certificate, &LIMITS);
        if k % PYTHON_EVERY == 0 {
            accept(&own, &certificate);
            if let Some(second) = python(&other, &certificate) {
                assert_eq!(second.is_ok(), found.is_ok(), "{second:?} {found:?}\n{other}\n{certificate}");
            }
        }
        let is_true = is_true(&other, &Json::parse(&certificate).unwrap());
        assert_eq!(found.is_ok(), is_true, "{found:?}\n{other}\n{certificate}");
        *(if is_true { &mut accepted } else { &mut rejected }) += 1;
    }
    let enough = count(2, 6);
    assert!(rejected >= enough && accepted >= enough, "{rejected} {accepted}");
}

/// A gain that is turned by an angle: `exp` of a complex number, read by enclosures.
#[test]
fn exponentials_of_complex_numbers_are_enclosed() {
    let text = |angle: &str| {
        format!(
            "time = 'discrete'\nparameters.K = {{ nominal = '1/3' }}\nparameters.b = 7\nconstants.phi = '{angle}'\n[loop]\n[[block]]\ninput = '-y'\noutput = 'y'\n\
             transfer = 'K*exp(j*phi - 1/b)/(z*(z - 1))'\n"
        )
    };
    let angles = [("1/3", "1/3"), ("-1/3", "1/3"), ("2", "1/3"), ("pi/2", "1/9"), ("0", "1/3")];
    for (angle, value) in tried(angles, 3) {
        let certificate = verdict_emitted(&text(angle), "K", value);
        accept(&text(angle), &certificate);
        let other = text("3");
        assert_eq!(
            check(&other, &certificate, &LIMITS).is_ok(),
            is_true(&other, &Json::parse(&certificate).unwrap()),
            "{angle}"
        );
        let answer = read(&text(angle)).ask().free("K").stable_set(&Budget::unlimited()).unwrap();
        accept(&text(angle), &certify_intervals(&answer, &Budget::unlimited()).unwrap().text);
    }
}

/// A complex matrix behind a hold is a real one of twice the size, whose exponential is read back.
#[test]
#[ignore = "long: CI runs it"]
fn complex_plants_behind_holds_are_certified() {
    let text = |plant: &str| {
        let blocks = "[[block]]\ninput = '-y'\noutput = 'u'\ntransfer = 'K*(1 + j*b)/(z - j/2)'\n[[block]]\ninput = 'u'\noutput = 'y'";
        "sample_time = '1/10'\n".to_owned() + &model("discrete", &format!("{blocks}\n{plant}"))
    };
    for (plant, other) in [
        ("transfer = '1/(s + 1 + 2*j)'\ndiscretize = 'zoh'", "transfer = '1/(s + 1 + 9*j)'\ndiscretize = 'zoh'"),
        (
            "A = [[-1, 'j'], [2, '-3 + j']]\nB = [[1], ['j']]\nC = [[1, 'b*j']]\ndiscretize = { method = 'pwm', edge = 'trailing', duty = '1/3' }",
            "A = [[-1, 'j'], [2, '3 + j']]\nB = [[1], ['j']]\nC = [[1, 'b*j']]\ndiscretize = { method = 'pwm', edge = 'trailing', duty = '1/3' }",
        ),
        (
            "transfer = '(s + 2 - j)/((s + 1 + 2*j)*(s + 3))'\ndiscretize = { method = 'foh', delay = '0.13' }",
            "transfer = '(s + 2 - j)/((s + 1 + 2*j)*(s - 3))'\ndiscretize = { method = 'foh', delay = '0.13' }",
        ),
        (
            "transfer = '1/(s + 1 + 2*j)'\ndiscretize = { method = 'zoh', frame = 3, delay = '0.05', advance = '1/5' }",
            "transfer = '1/(s + 1 + 2*j)'\ndiscretize = { method = 'zoh', frame = -3, delay = '0.05', advance = '2' }",
        ),
    ] {
        if plant.contains("foh") && !is_thorough() {
            continue;
        }
        for value in tried(["1/2", "5", "-1/2", "2", "20"], 5) {
            let certificate = verdict_emitted(&text(plant), "K", value);
            accept(&text(plant), &certificate);
            let is_true = is_true(&text(other), &Json::parse(&certificate).unwrap());
            assert_eq!(check(&text(other), &certificate, &LIMITS).is_ok(), is_true, "{plant} {value}");
        }
        // Sets over the constants of two modes and a dead time take long, and so do the checks of two modes.
        if plant.contains("foh") || plant.contains("pwm") && !is_thorough() {
            continue;
        }
        let answer = read(&text(plant)).ask().free("K").stable_set(&Budget::unlimited()).unwrap();
        accept(&text(plant), &certify_intervals(&answer, &Budget::unlimited()).unwrap().text);
    }
}
