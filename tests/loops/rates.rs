//! Loops whose blocks run at several rates. Numbers of the tables were computed with mpmath at 45 digits: events stepped one by one, and
//! eigenvalues on both sides of each end.

use crate::helpers::loops::agrees_with_radius;
use crate::helpers::model::{example_text, read};
use crate::helpers::number::number;
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, tried};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::error::{Code, Source};
use jurist_engine::model::Model;
use jurist_engine::stability::{Range, StableSet};
use nalgebra::DMatrix;

fn set(text: &str, name: &str) -> StableSet {
    read(text).ask().free(name).stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value()
}

/// The ends of the only interval, in so many digits, with their causes.
fn ends(set: &StableSet, digits: usize) -> [(String, String); 2] {
    let [interval] = set.intervals() else { panic!("{set:?}") };
    assert!(set.undecided().is_empty(), "{:?}", set.undecided());
    [&interval.lower, &interval.upper].map(|end| {
        end.as_ref().map_or(("none".into(), "none".into()), |end| (end.value.decimal(digits), end.causes.to_string()))
    })
}

/// A slow position loop around a fast one for the speed.
pub(crate) fn position(rate: &str) -> String {
    format!(
        "time = 'discrete'\nsample_time = 1\n[parameters]\nK_p = {{ nominal = 0.1, min = 0 }}\nK_v = 1\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'slow'\ninput = 'r - y'\noutput = 'w_ref'\ngain = 'K_p'\n{rate}\n[[block]]\nname = 'fast'\n\
         input = 'w_ref - w'\noutput = 'u'\ngain = 'K_v'\n[[block]]\nname = 'plant'\ninput = 'u'\noutput = ['y', 'w']\n\
         A = [[0, 1], [0, 0]]\nB = [[0], [1]]\ndiscretize = 'zoh'\n"
    )
}

/// The drive with its speed loop slower than the current loop.
fn drive(every: usize, method: &str) -> String {
    let text = example_text("drive-hold");
    let slow = format!("\"(K_ps + K_is*{every}*T/2*(z + 1)/(z - 1))/z\"\nevery = {every}");
    let text = text.replacen("\"(K_ps + K_is*T/2*(z + 1)/(z - 1))/z\"", &slow, 1);
    text.replace("discretize = \"zoh\"", &format!("discretize = \"{method}\""))
}

#[test]
fn a_slow_position_loop_around_a_fast_one() {
    let domain = ("0".to_owned(), "z=1+domain".to_owned());
    for (rate, end, cause) in [
        ("every = 1", "2", "complex pair"),
        ("every = 2", "2", "z=-1"),
        ("every = 2\nphase = 1", "2", "z=-1"),
        ("every = 4", "0.66666666666666666667", "z=-1"),
        ("every = 4\nphase = 3", "0.66666666666666666667", "z=-1"),
        ("sample_time = 4", "0.66666666666666666667", "z=-1"),
    ] {
        assert_eq!(ends(&set(&position(rate), "K_p"), 20), [domain.clone(), (end.into(), cause.into())], "{rate}");
    }
    // The fast root passes -1, where its square passes 1.
    assert_eq!(ends(&set(&position("every = 2"), "K_v"), 20)[1], ("2".to_owned(), "z=1".to_owned()));
}

#[test]
#[ignore = "long: CI runs it"]
fn the_drive_with_its_speed_loop_slower_than_its_current_loop() {
    for (every, method, end) in [
        (2, "zoh", "454.070200551737157240952115"),
        (5, "zoh", "244.813981424953313676018011"),
        (10, "zoh", "144.269326892427300624075708"),
        (20, "zoh", "79.5201528903021036102847692"),
        (10, "forward", "140.390843340065813026287874"),
    ] {
        assert_eq!(ends(&set(&drive(every, method), "K_ps"), 27)[1].0, end, "{every} {method}");
    }
    // A gain of the fast loop.
    let fast = ends(&set(&drive(2, "zoh"), "K_pwm"), 12);
    assert_eq!(fast.map(|(value, _)| value), ["0.0382515735080", "551.459983270"]);
    // Integral gains; without them an integrator is left that nobody reads.
    for (name, end) in [("K_is", "911.398818129"), ("K_ii", "61020.5684189"), ("K_pi", "50.2143917019")] {
        assert_eq!(ends(&set(&drive(5, "zoh"), name), 12)[1].0, end, "{name}");
    }
    // Ten and twenty factors of it: with exact polynomials the one took seconds, and the other did not end.
    let fast = ends(&set(&drive(10, "zoh"), "K_pwm"), 26);
    assert_eq!(fast.map(|(value, _)| value), ["0.039363295654287949254582346", "551.16384161823060903428475"]);
    let [(lower, _), (upper, _)] = ends(&set(&drive(20, "zoh"), "K_pwm"), 12);
    assert_eq!([lower.as_str(), upper.as_str()], ["0.0407902243088", "551.238894408"]);
}

/// Ends that enclosures found had no frequency: 2.111250332 rad in ten samples are 336.0 Hz, an alias of 1664 Hz.
#[test]
#[ignore = "long: CI runs it"]
fn ends_of_several_rates_have_their_frequency() {
    for (name, frequency) in [("K_pwm", 336.0159), ("K_ps", 0.8077485 / (2e-3 * std::f64::consts::PI))] {
        let run = jurist_with_input(&["intervals", "-", "--param", name, "--json"], drive(10, "zoh").as_bytes());
        let document: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        let found = document["stable"][0]["upper"]["frequency_hz"].as_f64().unwrap_or_else(|| panic!("{name}"));
        assert!((found - frequency).abs() < 1e-3, "{name}: {found}");
    }
}

#[test]
fn one_rate_for_all_controllers_is_a_longer_sample_time() {
    let text = example_text("drive-hold");
    let longer = text.replace("T     = { nominal = 1e-4", "T     = { nominal = 3e-4");
    let all = text
        .replace("transfer = \"(K_ps", "every = 3\ntransfer = \"(K_ps")
        .replace("transfer = \"(K_pi", "every = 3\ntransfer = \"(K_pi")
        .replace("gain = \"K_pwm/E_sw\"", "gain = \"K_pwm/E_sw\"\nevery = 3")
        .replace("K_is*T/2", "K_is*3*T/2")
        .replace("K_ii*T/2", "K_ii*3*T/2");
    assert_ne!(all, text);
    assert_eq!(ends(&set(&longer, "K_pwm"), 30), ends(&set(&all, "K_pwm"), 30));
    let phases = all.replace("every = 3", "every = 3\nphase = 2");
    assert_eq!(ends(&set(&phases, "K_pwm"), 30), ends(&set(&all, "K_pwm"), 30));
}

#[test]
fn a_rule_of_a_slow_controller_has_its_own_period() {
    let controller = |how: &str| {
        position("every = 3").replace("gain = 'K_p'", &format!("transfer = '{}'\n{how}", "K_p*(s + 1/5)/(s + 2)"))
    };
    let own = controller("discretize = 'tustin'");
    let said = controller("discretize = { method = 'tustin', T = 3 }");
    assert_eq!(ends(&set(&own, "K_p"), 30), ends(&set(&said, "K_p"), 30));
}

#[test]
#[ignore = "long: CI runs it"]
fn margins_are_those_of_signals_that_are_used_once() {
    let budget = Budget::unlimited();
    let model = read(&drive(10, "zoh"));
    for at in tried(["i_ref", "speed controller"], 2) {
        let margins = model.ask().margins(Some(at), &Rational::ZERO, &budget).unwrap_or_else(|e| panic!("{e}"));
        let upper = margins.value().stable.as_ref().unwrap().gain.upper.clone().unwrap();
        // The factor is one of K_ps and K_is alike.
        assert_eq!(upper.value.decimal(9), "143.650250", "{at}");
    }
    for at in ["e_c", "current controller", "i_a"] {
        let refused = model.ask().margins(Some(at), &Rational::ZERO, &budget);
        let Err(jurist_engine::error::Error::Refused(diagnostics)) = refused else { panic!("{at}") };
        assert_eq!(diagnostics.code(), Code::RateMargin, "{at}");
        assert!(diagnostics.diagnostics()[0].help.as_deref().is_some_and(|help| help.contains("i_ref")), "{at}");
    }
}

#[test]
fn what_is_not_asked_of_several_rates_is_refused_in_words() {
    let text = position("every = 4");
    let run = |arguments: &[&str]| jurist_with_input(arguments, text.as_bytes());
    for (arguments, code) in [
        (&["verdict", "-", "--radius", "0.9"][..], "E-rate"),
        (&["norm", "-", "r", "y"], "E-rate-margin"),
        (&["intervals", "-", "--param", "radius"], "E-rate"),
    ] {
        let found = run(arguments);
        assert_eq!(found.status, 2, "{arguments:?}: {}", found.stderr);
        assert!(found.stderr.contains(&format!("error[{code}]")), "{arguments:?}: {}", found.stderr);
    }
    let answer = run(&["intervals", "-", "--param", "K_p", "--json"]);
    let document: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(document["hyperperiod"]["steps"], 4);
    assert!(run(&["intervals", "-", "--param", "K_p"]).stdout.contains("slow: every 4; z is one step of 4 samples"));
}

#[test]
fn mistakes_of_rates_are_shown_where_they_stand() {
    for (rate, what) in [
        ("every = 2.5", "whole number"),
        ("every = 0", "whole number"),
        ("every = 4\nphase = 4", "not below"),
        ("every = 4\nphase = -1", "whole number"),
        ("every = 4\nsample_time = 4", "twice"),
        ("sample_time = '3/2'", "no whole multiple"),
        ("sample_time = 'K_v'", "no whole multiple"),
        ("every = 100003", "comes again"),
    ] {
        let found = Model::from_toml(&Source::new("model.toml", position(rate)));
        let Err(diagnostics) = found else { panic!("{rate} is accepted") };
        assert_eq!(diagnostics.code(), Code::Rate, "{rate}: {diagnostics}");
        assert!(diagnostics.to_string().contains(what), "{rate}: {diagnostics}");
    }
    let held = position("every = 4").replace("discretize = 'zoh'", "discretize = 'zoh'\nevery = 2");
    assert_eq!(Model::from_toml(&Source::new("model.toml", held)).unwrap_err().code(), Code::Rate);
    let continuous = "time = 'continuous'\n[parameters]\nK = 1\n[loop]\n[[block]]\ninput = '-y'\noutput = 'y'\ntransfer = 'K/s'\nevery = 2\n";
    assert_eq!(Model::from_toml(&Source::new("model.toml", continuous)).unwrap_err().code(), Code::Rate);
}

/// A cascade of first-order blocks with random rates and phases.
pub(crate) struct Cascade {
    /// Pole and gain of each discrete block, in tenths; each block reads a mixture of all outputs.
    blocks: Vec<[i64; 2]>,
    mixture: Vec<Vec<i64>>,
    rates: Vec<[u64; 2]>,
}

impl Cascade {
    pub(crate) fn random(random: &mut Random) -> Cascade {
        let n = 2 + random.below(3);
        let mut entry = |bound: usize| random.below(2 * bound + 1) as i64 - bound as i64;
        let blocks = (0..n).map(|_| [entry(9), entry(6)]).collect();
        let mixture = (0..n).map(|_| (0..n).map(|_| entry(2)).collect()).collect();
        let rates = (0..n)
            .map(|_| {
                let every = [1, 1, 2, 3, 4][random.below(5)];
                [every, random.below(every as usize) as u64]
            })
            .collect();
        Cascade { blocks, mixture, rates }
    }

    /// Tenths: `b/10/(z - a/10)`, the first block with the gain K.
    pub(crate) fn text(&self) -> String {
        let mut text = "time = 'discrete'\nsample_time = 1\n[parameters]\nK = 1\n[loop]\n".to_owned();
        for (i, [a, b]) in self.blocks.iter().enumerate() {
            let sum: Vec<String> = self.mixture[i].iter().enumerate().map(|(j, c)| format!("({c})*y_{j}")).collect();
            let gain = if i == 0 { "K*" } else { "" };
            let [every, phase] = self.rates[i];
            text += &format!(
                "[[block]]\ninput = '{}'\noutput = 'y_{i}'\ntransfer = '{gain}({b}/10)/(z - ({a}/10))'\nevery = {every}\nphase = {phase}\n",
                sum.join(" + ")
            );
        }
        text
    }

    /// The largest modulus of a root of a hyperperiod, by stepping every event: each column is the course from a unit vector.
    fn radius(&self, gain: f64) -> f64 {
        let n = self.blocks.len();
        let steps = self.rates.iter().fold(1, |l, [every, _]| (1..).map(|k| k * l).find(|m| m % every == 0).unwrap());
        let course = |start: usize| -> Vec<f64> {
            let mut state = vec![0.0; 2 * n];
            state[start] = 1.0;
            for k in 0..steps {
                let active = |i: usize| k % self.rates[i][0] == self.rates[i][1];
                // No block passes its input on at once.
                let y: Vec<f64> = (0..n)
                    .map(|i| match active(i) {
                        true => self.blocks[i][1] as f64 / 10.0 * if i == 0 { gain } else { 1.0 } * state[i],
                        false => state[n + i],
                    })
                    .collect();
                for i in (0..n).filter(|&i| active(i)) {
                    let u: f64 = self.mixture[i].iter().zip(&y).map(|(c, y)| *c as f64 * y).sum();
                    state[i] = self.blocks[i][0] as f64 / 10.0 * state[i] + u;
                }
                state[n..].copy_from_slice(&y);
            }
            state
        };
        let columns: Vec<Vec<f64>> = (0..2 * n).map(course).collect();
        let matrix = DMatrix::from_fn(2 * n, 2 * n, |i, j| columns[j][i]);
        matrix.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
    }
}

/// `RATE_CASES=2000 cargo test --release --test it random_rates -- --nocapture` asks for so many.
#[test]
fn random_rates_against_events_stepped_one_by_one() {
    let cases = std::env::var("RATE_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(count(24, 60));
    let (mut random, mut looked_at, mut ends) = (Random::new(8), 0, 0);
    for _ in 0..cases {
        let case = Cascade::random(&mut random);
        let model = read(&case.text());
        let set = model.ask().free("K").stable_set(&Budget::unlimited()).unwrap().into_value();
        let gains = (0..6).map(|_| random.below(8001) as f64 / 400.0 - 10.0).collect();
        let [new_ends, new_gains] = agrees_with_radius(&model, &set, gains, 1e-3, |gain| case.radius(gain));
        (ends, looked_at) = (ends + new_ends, looked_at + new_gains);
    }
    println!("{cases} cases, {ends} ends, {looked_at} gains");
    assert!(looked_at > cases);
}

/// The rate was that of the file, whatever was set.
#[test]
fn a_sample_time_of_a_block_is_a_multiple_whatever_constants_are() {
    let text = |own: &str| {
        format!(
            "time = 'discrete'\nsample_time = 'T'\n[constants]\nT = 0.1\nN = 10\nT_s = '10*T'\n[parameters]\nK = 1\n[loop]\n[[block]]\n\
             input = '-y'\noutput = 'u'\ngain = 'K + N*0'\nsample_time = '{own}'\n[[block]]\ninput = 'u'\noutput = 'y'\n\
             transfer = '1/s'\ndiscretize = 'zoh'\n"
        )
    };
    for own in ["N*T", "1", "T + 0.9"] {
        let found = Model::from_toml(&Source::new("model.toml", text(own)));
        assert_eq!(found.unwrap_err().code(), Code::Rate, "{own}");
    }
    for own in ["10*T", "T_s"] {
        let model = read(&text(own));
        for (time, end) in [("0.1", "2"), ("0.2", "1")] {
            let answer =
                model.ask().set("T", time.parse::<Rational>().unwrap()).free("K").stable_set(&Budget::unlimited());
            assert_eq!(ends(&answer.unwrap().into_value(), 6)[1].0, end, "{own}, {time}");
        }
    }
    let other = read(&text("T_s")).ask().set("T_s", Rational::from(3)).free("K").stable_set(&Budget::unlimited());
    let Err(jurist_engine::error::Error::Refused(diagnostics)) = other else { panic!("{other:?}") };
    assert_eq!(diagnostics.code(), Code::NotANumber, "a constant that depends on another one is not set");
    let unknown = Model::from_toml(&Source::new("model.toml", text("10*Ts")));
    assert_eq!(unknown.unwrap_err().code(), Code::UnknownName);
}

/// A constant of the plant of a cascade at two rates did not end. Ends were found by events in floating point, stepped one by one.
#[test]
fn a_constant_of_the_plant_of_a_cascade_at_two_rates_has_its_set() {
    let text = example_text("drive-two-rates");
    for (name, [unstable, stable]) in [("J", ["0.01288694", "0.01288696"]), ("L_a", ["0.0091555", "0.0091556"])] {
        let question = read(&text).ask().set("K_ps", 20).free(name);
        let domain = ["0.006", "0.3"].map(number);
        let set = question.domain(name, Range::between(Some(domain[0].clone()), Some(domain[1].clone())));
        let set = set.stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value();
        assert!(set.undecided().is_empty() && set.intervals().len() == 1, "{name}: {set:?}");
        assert_eq!([unstable, stable, "0.2"].map(|x| set.contains(&number(x))), [false, true, true], "{name}");
        for x in [unstable, stable] {
            let verdict = read(&text).ask().set("K_ps", 20).set(name, number(x)).verdict(&Budget::unlimited()).unwrap();
            assert_eq!(verdict.value().verdict == Verdict::Stable, x == stable, "{name} = {x}");
        }
    }
}
