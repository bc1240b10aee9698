//! `duty = "steady"`: the duty ratio of the periodic orbit.

use super::pwm::{ends, set};
use crate::helpers::model::{example_text, read};
use crate::helpers::program::jurist_with_input;
use crate::helpers::thorough::{is_thorough, tried};
use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::parse_number;
use jurist_engine::answer::Verdict;
use jurist_engine::error::{Code, Error, Source};
use jurist_engine::model::Model;
use jurist_engine::stability::{Cause, Range};

fn drive(edge: &str) -> String {
    let text = example_text("drive-pwm");
    text.replace("\"trailing\", duty = \"V_0/K_pwm\"", &format!("\"{edge}\", duty = \"steady\""))
}

fn verdict(text: &str, name: &str, value: &str) -> Result<Verdict, Error> {
    let answer = read(text).ask().set(name, parse_number(value).unwrap()).verdict(&Budget::unlimited())?;
    Ok(answer.into_value().verdict)
}

/// The limits were computed with mpmath at 45 digits, from the roots of the orbit's equation and eigenvalues of the map over a period.
#[test]
fn the_drive_at_the_duty_ratio_of_its_orbit() {
    let text = drive("trailing");
    for (name, below, above) in [
        ("K_pwm", "551.741369816005655902495907523", "551.741369816005655902495907525"),
        ("T", "0.000499220684161587476415875791645", "0.000499220684161587476415875791647"),
    ] {
        let found = [below, above].map(|value| verdict(&text, name, value).unwrap());
        assert_eq!(found, [Verdict::Stable, Verdict::Unstable], "{name}");
    }
    // The mean voltage at 80 rad/s is 2484/55 V.
    for (value, expected) in [("2484/55", "duty 1 of 'motor'"), ("45", "duty 276/275 of 'motor'")] {
        let model = read(&text);
        let answer = model.ask().set("K_pwm", parse_number(value).unwrap()).verdict(&Budget::unlimited()).unwrap();
        assert_eq!(answer.value().verdict, Verdict::Undefined, "{value}");
        assert!(answer.text(12).contains(expected), "{}", answer.text(12));
    }
}

/// A leaky integrator, integral control and a reference 1: `pulse` is the integral of `exp(-3 (T - t))` over the pulse, times 3, so that the orbit
/// has the duty ratio for which the height is written here.
fn leaky(how: &str, pulse: &str) -> String {
    format!(
        "time = 'discrete'\nsample_time = 'T'\n[constants]\nT = '1/2'\nV = '3*(1 - exp(-3*T))/({pulse})'\n[parameters]\nK = 1\n[loop]\n\
         inputs = ['r']\n[[block]]\ninput = 'r - y'\noutput = 'c'\ntransfer = 'K/(z - 1)'\n[[block]]\ninput = 'c'\noutput = 'u'\ngain = 1\n\
         pwm = {{ amplitude = 'V', carrier = 1, period = 'T' }}\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 3)'\n\
         discretize = {{ method = 'pwm', {how} }}\n[simulation]\ninputs = {{ r = 1 }}\n"
    )
}

#[test]
fn orbits_whose_duty_ratio_is_known_by_construction() {
    // From the end of the period: the pulse is on between these times before it.
    let between = |from: &str, to: &str| format!("exp(-3*{from}*T) - exp(-3*{to}*T)");
    let orbits = [
        ("trailing", "0", between("(7/10)", "1")),
        ("leading", "0", between("0", "(3/10)")),
        ("double", "0", between("(7/20)", "(13/20)")),
        ("double-ends", "0", format!("{} + {}", between("(17/20)", "1"), between("0", "(3/20)"))),
        ("trailing", "T", between("(7/10)", "1")),
        ("trailing", "T/2", between("(1/5)", "(1/2)")),
        // It goes on in the next period.
        ("trailing", "9*T/10", format!("{} + {}", between("0", "(1/10)"), between("(4/5)", "1"))),
        ("leading", "T/2", between("(1/2)", "(4/5)")),
    ];
    for (edge, delay, pulse) in tried(orbits, 3) {
        let how = |duty: &str| format!("edge = '{edge}', duty = '{duty}', delay = '{delay}'");
        let [own, given] = ["steady", "3/10"].map(|duty| ends(&set(&leaky(&how(duty), &pulse), "K"), 40));
        assert_eq!(own, given, "{edge}, {delay}");
    }
}

/// The limits of the contract of the paper's drive as sets: the duty ratio moves with what is asked for.
#[test]
fn the_height_of_the_pulses_and_the_period_are_questions() {
    let model = read(&drive("trailing"));
    let within = |name: &str, lower: &str, upper: &str| {
        let domain = Range::between(Some(parse_number(lower).unwrap()), Some(parse_number(upper).unwrap()));
        let question = model.ask().free(name).domain(name, domain);
        question.stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value()
    };
    let gain = within("K_pwm", "1", "1000");
    assert_eq!(ends(&gain, 27), ["45.1636363636363636363636364", "551.741369816005655902495908"]);
    assert!(gain.intervals()[0].lower.as_ref().unwrap().causes.contains(Cause::Duty));
    if is_thorough() {
        assert_eq!(ends(&within("T", "1/10000", "1/1000"), 27)[1], "0.000499220684161587476415875792");
    }
}

/// With the height of the pulses as a function of `d` for which the orbit has the duty ratio `d`.
#[test]
#[ignore = "long: CI runs it"]
fn a_duty_ratio_that_moves_is_that_which_is_known_by_construction() {
    let cases = [
        ("trailing", "exp(-3*(1 - d)*T) - exp(-3*T)"),
        ("leading", "1 - exp(-3*d*T)"),
        ("double", "exp(-3*(1 - d)/2*T) - exp(-3*(1 + d)/2*T)"),
    ];
    for (edge, pulse) in tried(cases, 3) {
        let text = |duty: &str| {
            let text = leaky(&format!("edge = '{edge}', duty = '{duty}'"), pulse);
            text.replace("K = 1", "K = 3\nd = { nominal = 0.5, min = 0.05, max = 0.95 }")
        };
        let [own, given] = ["steady", "d"].map(|duty| set(&text(duty), "d"));
        assert_eq!(ends(&own, 25), ends(&given, 25), "{edge}");
    }
}

#[test]
fn an_integrator_has_the_mean_as_its_duty_ratio() {
    // Without integral control: K (r - y) is what is commanded, and at rest nothing, but for a load.
    let text = |duty: &str| {
        format!(
            "time = 'discrete'\nsample_time = 1\n[parameters]\nK = {{ nominal = 0.5, min = 0 }}\n[loop]\ninputs = ['r', 'load']\n[[block]]\n\
             input = 'K*(r - y)'\noutput = 'u'\ngain = 1\npwm = {{ amplitude = 8, carrier = 1, period = 1 }}\n[[block]]\n\
             input = ['u', 'load']\noutput = 'y'\nA = [[0]]\nB = [[1, -1]]\n\
             discretize = {{ method = 'pwm', edge = 'trailing', duty = '{duty}' }}\n[simulation]\ninputs = {{ load = 2 }}\n"
        )
    };
    assert_eq!(ends(&set(&text("steady"), "K"), 20), ends(&set(&text("1/4"), "K"), 20));
}

#[test]
fn the_switched_orbit_has_that_duty_ratio() {
    let text = drive("leading");
    let run = jurist_with_input(
        &["simulate", "-", "--switched", "--steady", "--json", "--duration", "0.001"],
        text.as_bytes(),
    );
    let document: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    let duty = document["steady_state"]["duty"][0].as_f64().unwrap();
    assert!((duty - 0.410579).abs() < 1e-5, "{duty}");
}

#[test]
fn what_a_steady_duty_ratio_is_not_known_of_is_refused_in_words() {
    let text = leaky("edge = 'trailing', duty = 'steady'", "1");
    let with = |from: &str, to: &str| text.replace(from, to);
    for (text, what) in [
        (with("pwm = { amplitude = 'V', carrier = 1, period = 'T' }", ""), "how high the pulses are"),
        (with("'trailing'", "'alternating'"), "two duty ratios"),
        (with("1/(s + 3)", "(s + 4)/(s + 3)"), "at once"),
    ] {
        let Err(Error::Refused(diagnostics)) = read(&text).ask().verdict(&Budget::unlimited()) else {
            panic!("{what}")
        };
        assert_eq!(diagnostics.code(), Code::Duty, "{what}");
        assert!(diagnostics.to_string().contains(what), "{diagnostics}");
    }
    // Nothing is commanded, whatever the gain is: the duty ratio is 0.
    let idle = verdict(&with("r = 1", "r = 0"), "K", "1");
    assert!(matches!(&idle, Err(Error::Undefined(why)) if why.contains("duty 0")), "{idle:?}");
}

/// There is one pulse in each sample time: another period was passed over, and the switched simulation refused it.
#[test]
fn pulses_of_another_period_are_refused_where_they_are_read() {
    let text = leaky("edge = 'trailing', duty = 'steady'", "exp(-3*(7/10)*T) - exp(-3*T)");
    for (text, duty) in [(text.clone(), "steady"), (text.replace("'steady'", "'3/10'"), "3/10")] {
        assert!(Model::from_toml(&Source::new("model.toml", text.clone())).is_ok(), "{duty}");
        for other in ["2*T", "1/3"] {
            let text = text.replace("period = 'T'", &format!("period = '{other}'"));
            let found = Model::from_toml(&Source::new("model.toml", text)).unwrap_err();
            assert_eq!(found.code(), Code::Discretize, "{duty}, {other}: {found}");
            assert!(found.to_string().contains("another period"), "{found}");
        }
        // A number that is the sample time as long as nobody sets that.
        let model = read(&text.replace("period = 'T'", "period = 0.5"));
        assert!(model.ask().verdict(&Budget::unlimited()).is_ok(), "{duty}");
        let other = model.ask().set("T", parse_number("0.4").unwrap()).verdict(&Budget::unlimited());
        let Err(Error::Refused(diagnostics)) = other else { panic!("{duty}: {other:?}") };
        assert_eq!(diagnostics.code(), Code::Discretize, "{duty}");
    }
}

/// That was "duty 0 of 'y'".
#[test]
fn an_orbit_of_inputs_without_values_says_what_is_missing() {
    let text = leaky("edge = 'trailing', duty = 'steady'", "1");
    let text = &text[..text.find("[simulation]").unwrap()];
    let asked = [
        read(text).ask().verdict(&Budget::unlimited()).map(|_| ()),
        read(text).ask().free("K").stable_set(&Budget::unlimited()).map(|_| ()),
    ];
    for found in asked {
        let Err(Error::Refused(diagnostics)) = found else { panic!("{found:?}") };
        assert_eq!(diagnostics.code(), Code::Duty);
        let first = &diagnostics.diagnostics()[0];
        assert!(first.message.contains("'r' has no value in [simulation]"), "{first:?}");
        assert!(
            first.help.as_deref().is_some_and(|help| help.contains("[simulation] inputs = { r = 1 }")),
            "{first:?}"
        );
    }
}

/// The duty ratio was the modulator's input over its carrier, whatever its gain was.
#[test]
fn the_switched_pulses_are_as_long_as_the_gain_of_the_modulator_says() {
    let text = leaky("edge = 'trailing', duty = 'steady'", "1");
    // The switched circuit takes rational numbers.
    let height = 3.0 * (1.0 - (-1.5f64).exp()) / ((-1.05f64).exp() - (-1.5f64).exp());
    let text = text.replace("V = '3*(1 - exp(-3*T))/(1)'", &format!("V = '{height}'"));
    // A state of the modulator's is one more sample of delay; at rest it passes on what goes in.
    for (gain, carrier) in [("gain = 1", "1"), ("gain = 3", "1"), ("gain = 1", "5"), ("transfer = '1/z'", "1")] {
        let text = text.replacen("gain = 1", gain, 1).replace("carrier = 1", &format!("carrier = {carrier}"));
        let run = jurist_with_input(
            &["simulate", "-", "--switched", "--steady", "--json", "--set", "K=0.1", "--duration", "1"],
            text.as_bytes(),
        );
        let document: serde_json::Value =
            serde_json::from_str(&run.stdout).unwrap_or_else(|e| panic!("{e}: {}", run.stderr));
        let duty = document["steady_state"]["duty"][0].as_f64().unwrap();
        assert!((duty - 0.3).abs() < 1e-9, "{gain}, {carrier}: {duty}");
        // The multipliers are the roots of the loop that verdicts are about.
        let roots = read(&text).ask().set("K", parse_number("0.1").unwrap()).problem().unwrap();
        let roots = jurist_draw::simulate::SampledModel::from_loop(&roots, 1.0, &Budget::unlimited()).unwrap();
        let largest = roots.transition.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max);
        let multiplier = &document["steady_state"]["multipliers"][0];
        let found = multiplier[0].as_f64().unwrap().hypot(multiplier[1].as_f64().unwrap());
        assert!((found - largest).abs() < 1e-9, "{gain}, {carrier}: {found} and {largest}");
    }
    let none = text.replace("'steady'", "'1/2'").replace("amplitude = 'V'", "amplitude = 0");
    let run = jurist_with_input(&["simulate", "-", "--switched"], none.as_bytes());
    assert!(run.stderr.contains("have no height"), "{}", run.stderr);
}

/// The exponential of a plant over a period of 1e9 took all memory.
#[test]
#[ignore = "long: CI runs it"]
fn a_period_in_which_a_plant_changes_beyond_measure_is_refused_or_undecided() {
    let text = leaky("edge = 'trailing', duty = 'steady'", "1").replace("1/(s + 3)", "1/(s - 3)");
    let text = text.replace("V = '3*(1 - exp(-3*T))/(1)'", "V = 10").replace("r = 1", "r = -1");
    for time in tried(["1e4", "1e9", "1e30"], 3) {
        let Err(Error::Refused(why)) = verdict(&text, "T", time) else { panic!("{time}") };
        assert_eq!(why.code(), Code::Duty, "{time}");
        assert!(why.to_string().contains("change by more than"), "{why}");
    }
    let model = read(&text);
    let far = Range::between(Some(1_000_000.into()), Some(2_000_000.into()));
    let question = model.ask().free("T").domain("T", far);
    match question.stable_set(&Budget::with_work(1_000_000_000)) {
        Ok(set) => assert!(set.value().intervals().is_empty(), "{:?}", set.value()),
        Err(stopped) => assert!(matches!(stopped, Error::Stopped(_) | Error::Refused(_)), "{stopped}"),
    }
}
