//! A delay margin over values of parameters: known by hand, and against the stable set of the dead time itself and counts of roots.

use crate::helpers::model::{keeping, read};
use crate::helpers::number::{number, ratio};
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::model::Model;
use jurist_engine::response::{DelayMargin, RequiredEnd, RequiredSet, Requirement};
use jurist_engine::stability::Range;

/// Unity feedback of a plant behind a gain `K`; what begins the text, and what the plant is beside its transfer function.
fn series(head: &str, plant: &str, further: &str) -> Model {
    read(&format!(
        "{head}\n[parameters]\nK = {{ nominal = 1 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
         [[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\n{further}"
    ))
}

const SAMPLED: &str = "time = 'discrete'\nsample_time = 0.1";

fn continuous(plant: &str) -> Model {
    series("time = 'continuous'", plant, "")
}

fn delay(least: &str) -> Requirement {
    Requirement::delay_margin(number(least)).unwrap()
}

fn set(model: &Model, least: &str) -> RequiredSet {
    let range = Range::between(Some(number("-20")), Some(number("20")));
    let problem = model.ask().free("K").domain("K", range).problem().unwrap();
    problem.required_set(&[delay(least)], Some("u"), &Budget::unlimited()).unwrap().into_value()
}

/// The only interval's upper end, where the delay margin binds, and whether the value itself is met.
fn upper(found: &RequiredSet) -> (String, bool) {
    assert!(found.undecided.is_empty(), "{found:?}");
    let [interval] = found.intervals.as_slice() else { panic!("{found:?}") };
    let Some(RequiredEnd::Requirement { value, names, closed }) = &interval.upper else { panic!("{interval:?}") };
    assert_eq!(names, &["delay_margin"]);
    (value.decimal(25), *closed)
}

/// `K/s` crosses one at `K`, 90 degrees before -1: it bears `pi/(2 K)`.
#[test]
fn an_integrator_by_hand() {
    let model = continuous("1/s");
    for (least, end) in [("1", "1.570796326794896619231322"), ("1/2", "3.141592653589793238462643")] {
        assert_eq!(upper(&set(&model, least)), (end.to_owned(), true));
    }
    // Beside dead time of its own.
    assert_eq!(upper(&set(&continuous("exp(-s/4)/s"), "3/4")).0, "1.570796326794896619231322");
}

/// `K/(s + 1)` is nowhere above one for `K` up to 1: then any delay is borne.
#[test]
#[ignore = "long: CI runs it"]
fn a_lag_whose_delay_has_no_bound() {
    let found = set(&continuous("1/(s + 1)"), "1000");
    let (end, _) = upper(&found);
    let end = number(&end);
    assert!(end > number("1") && end < number("1.00001"), "{end}");
    // w = sqrt(K^2 - 1), and (pi - atan w)/w is what is borne.
    let found = upper(&set(&continuous("1/(s + 1)"), "1")).0;
    let k = number(&found).to_f64_approximate();
    let w = (k * k - 1.0).sqrt();
    assert!(((std::f64::consts::PI - w.atan()) / w - 1.0).abs() < 1e-12, "{found}");
}

/// `K (s + 2)/(s + 1)` goes to `K` at high frequencies: from 1 on no delay is borne at all, and of less any up to one that goes to 0.
#[test]
#[ignore = "long: CI runs it"]
fn an_open_loop_that_does_not_fall() {
    let found = set(&continuous("(s + 2)/(s + 1)"), "1/10");
    let end = number(&upper(&found).0);
    assert!(end > number("0.99") && end < number("1"), "{end}");
    assert!(found.intervals[0].contains(&number("-1/4")) && !found.intervals[0].contains(&number("5")));
}

/// `|K/(s^2 + s/10 + 1)|` is greatest near 1, where a lag of less than 1.7 leads to -1: with the gain at which the peak comes to one the margin
/// falls at once. There `K^2 = 399/40000`, and the value itself is not met.
#[test]
fn a_crossing_that_appears_at_once() {
    let (end, closed) = upper(&set(&continuous("1/(s^2 + s/10 + 1)"), "17/10"));
    let end = number(&end);
    assert!(!closed && (&(&end * &end) - &number("0.009975")).abs() < number("1e-20"), "{end}");
    // Less is borne by all up to another gain.
    let (end, closed) = upper(&set(&continuous("1/(s^2 + s/10 + 1)"), "1"));
    assert!(closed && number(&end) > number("0.1"), "{end}");
}

/// With each number of samples: `z^m (z - 1) + K` has roots on the circle at `2 sin(pi/(2 (2 m + 1)))`, and they are not stable.
#[test]
fn whole_samples_by_hand() {
    let model = series(SAMPLED, "1/(z - 1)", "");
    for (least, m) in [("1/10", 1_i32), ("3/20", 2), ("1/5", 2), ("3/10", 3)] {
        let (end, closed) = upper(&set(&model, least));
        let expected = 2.0 * (std::f64::consts::PI / f64::from(2 * (2 * m + 1))).sin();
        assert!(!closed && (number(&end).to_f64_approximate() - expected).abs() < 1e-12, "{least}: {end} {expected}");
    }
}

/// Whether a loop `K N/D exp(-tau s)` is stable with all dead times below one, by the windows of the dead time.
fn bears(plant: &str, gain: &Rational, least: &Rational) -> bool {
    let text = format!(
        "time = 'continuous'\n[parameters]\ntau = {{ nominal = 1 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = '({gain})*({plant})*exp(-tau*s)'\n"
    );
    let range = Range::between(Some(Rational::ZERO), Some(least.clone()));
    let model = read(&text);
    let windows = model.ask().free("tau").domain("tau", range).stable_set(&Budget::unlimited()).unwrap();
    let without = model.ask().set("tau", Rational::ZERO).verdict(&Budget::unlimited()).unwrap();
    let reaches = |end: &Option<jurist_engine::stability::End>, to: &Rational| {
        end.as_ref().is_none_or(|end| end.value.compare_rational(to).is_eq())
    };
    let mut all = windows.value().intervals().iter();
    without.value().verdict == Verdict::Stable
        && all.any(|i| reaches(&i.lower, &Rational::ZERO) && reaches(&i.upper, least))
}

/// Ends, and values around them, against the windows of the dead time, which are found without any open loop.
#[test]
#[ignore = "long: CI runs it"]
fn random_loops_against_the_windows_of_the_dead_time() {
    let mut random = Random::new(37);
    let mut seen = [0, 0];
    for _ in 0..count(30, 300) {
        let mut number = |below: usize| ratio(1 + random.below(below) as i64, 4);
        let (a, b, c, d) = (number(8), number(8), number(4), number(10));
        let plants = [
            format!("(s + {d})/((s + {a})*(s^2 + {c}*s + {b}))"),
            format!("1/((s - {c})*(s + {a}))*(s + {d})"),
            format!("1/(s*(s + {a}))"),
            format!("(s + {d})/(2*s + {a})"),
        ];
        let plant = &plants[random.below(plants.len())];
        let least = ratio(1 + random.below(20) as i64, 20);
        let found = set(&continuous(plant), &least.to_string());
        assert!(found.undecided.is_empty(), "{plant} {least}: {found:?}");
        let ends = found.intervals.iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
        let near = |end: &RequiredEnd| {
            let [low, high] =
                [end.value().decimal(12), end.value().decimal(12)].map(|text| crate::helpers::number::number(&text));
            let step = ratio(1, 100_000);
            [low - &step, high + &step]
        };
        let mut values: Vec<Rational> = ends.flat_map(near).collect();
        values.extend((0..4).map(|_| ratio(random.below(800) as i64 - 200, 97)));
        values.retain(|value| value.abs() < ratio(20, 1));
        for value in values {
            let expected = bears(plant, &value, &least);
            let said = found.intervals.iter().any(|interval| interval.contains(&value));
            assert_eq!(said, expected, "{plant}, K = {value}, {least}: {found:?}");
            seen[usize::from(said)] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 15), "{seen:?}");
}

/// Each number of samples counts the roots of one polynomial.
#[test]
fn random_loops_against_a_count_for_each_number_of_samples() {
    let mut random = Random::new(38);
    let mut seen = [0, 0];
    for _ in 0..count(40, 300) {
        let [a, b, c] = [0, 0, 0].map(|_| ratio(random.below(9) as i64 - 3, 6));
        let samples = 1 + random.below(4);
        let least = ratio(samples as i64, 10) - &ratio(random.below(2) as i64, 40);
        let found = set(&series(SAMPLED, &format!("(z + {b})/((z - {a})*(z - {c}))"), ""), &least.to_string());
        assert!(found.undecided.is_empty(), "{found:?}");
        for _ in 0..8 {
            let value = ratio(random.below(300) as i64 - 100, 101);
            let is_stable = |m: usize| {
                let text = format!("z^{m}*(z - {a})*(z - {c}) + ({value})*(z + {b})");
                let model = read(&format!("time = 'discrete'\nloop.characteristic = '{text}'\n"));
                model.ask().verdict(&Budget::unlimited()).unwrap().value().verdict == Verdict::Stable
            };
            let expected = (0..=samples).all(is_stable);
            let said = found.intervals.iter().any(|interval| interval.contains(&value));
            assert_eq!(said, expected, "{a} {b} {c}, K = {value}, {least}");
            seen[usize::from(said)] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 15), "{seen:?}");
}

/// Behind a hold the dead time need not be whole samples: a short bracket, on whose sides the margins at points say what the set says.
#[test]
#[ignore = "long: CI runs it"]
fn dead_time_behind_a_hold() {
    let model = series("time = 'discrete'", "1/(s + 1)", "discretize = { method = 'zoh', T = 0.5 }\n");
    let range = Range::between(Some(number("1")), Some(number("8")));
    let problem = model.ask().free("K").domain("K", range).problem().unwrap();
    let found = problem.required_set(&[delay("0.6")], Some("u"), &Budget::unlimited()).unwrap().into_value();
    let [interval] = found.intervals.as_slice() else { panic!("{found:?}") };
    let [bracket] = found.undecided.as_slice() else { panic!("{found:?}") };
    let [low, high] = [&bracket.lower, &bracket.upper].map(|end| end.clone().unwrap());
    assert!(high.clone() - low.clone() < number("1e-6") && interval.upper.as_ref().unwrap().value().exact().is_some());
    let met = |value: &Rational| {
        let problem = model.ask().set("K", value.clone()).problem().unwrap();
        problem.requirements_met(&[delay("0.6")], Some("u"), &Budget::unlimited()).unwrap()[0].met
    };
    assert!(met(&low) && !met(&high), "{low} {high}");
}

/// In discrete time the margin is in the unit of the sample time: there has to be one, and it may not be what is asked for.
#[test]
fn what_is_not_known_is_refused() {
    let refused = |model: &Model, name: &str, least: &str| {
        let problem = keeping(model, &[name]).problem().unwrap();
        problem.required_set(&[delay(least)], Some("u"), &Budget::unlimited()).unwrap_err().to_string()
    };
    assert!(refused(&series("time = 'discrete'", "1/(z - 1)", ""), "K", "1").contains("needs its sample time"));
    assert!(refused(&series(SAMPLED, "1/(z - 1)", ""), "K", "100").contains("more than 24 samples"));
    assert!(refused(&continuous("1/(s + sqrt(K + 1))"), "K", "1").contains("decided at points only"));
    let held = read(
        "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = 0.5, min = 0.1, max = 1 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\ninput = 'r - y'\noutput = 'u'\ngain = 1\n\
         [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = 'zoh'\n",
    );
    assert!(refused(&held, "T", "1").contains("names that are not in its sample time"));
}

/// Whole samples hide a resonance near to the sampling frequency: any number of them is borne. Dead time of half a sample is not.
#[test]
#[ignore = "long: CI runs it"]
fn a_resonance_that_whole_samples_hide_bounds_the_dead_time_behind_a_hold() {
    let with = |hold: &str| {
        read(&format!(
            "time = 'discrete'\nsample_time = 1\nparameters = {{ K = 0.9 }}\nloop = {{ inputs = ['r'], outputs = ['y'] }}\n\
             [[block]]\ninput = 'K*(r - y)'\noutput = 'u'\ngain = 1\n[[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\n\
             transfer = '39.5/(s^2 + 0.1*s + 39.5)'\ndiscretize = {hold}\n"
        ))
    };
    let budget = Budget::unlimited();
    let model = with("'zoh'");
    let problem = model.ask().problem().unwrap();
    let margins = problem.margins(Some("P"), &Rational::ZERO, &budget).unwrap();
    assert!(matches!(margins.value().stable.as_ref().unwrap().delay, DelayMargin::Unbounded));
    let bound = margins.value().held_delay.as_ref().unwrap().seconds(64).unwrap();
    assert!(*bound.lower() > number("0.2667") && *bound.upper() < number("0.2668"), "{bound:?}");
    assert!(
        margins.text(6).contains("any number of whole samples; less than 0.266728 s of dead time at the input of 'P'")
    );
    for (time, is_borne) in [("0.2667", true), ("0.2668", false), ("0.6", false)] {
        // The second way: the loop with this dead time.
        let other = with(&format!("{{ method = 'zoh', delay = {time} }}")).ask().verdict(&budget).unwrap();
        assert_eq!(other.value().verdict == Verdict::Stable, is_borne, "{time}");
        let met = problem.requirements_met(&[delay(time)], Some("P"), &budget).unwrap()[0].met;
        assert_eq!(met, is_borne, "{time}");
    }
    // Beyond what is looked at nothing is said.
    let lag = read(
        "time = 'discrete'\nsample_time = '1/1000'\nparameters = { K = 0.5 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
         [[block]]\ninput = 'K*(r - y)'\noutput = 'u'\ngain = 1\n[[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\n\
         transfer = '1/(s + 1)'\ndiscretize = 'zoh'\n",
    );
    let refused =
        lag.ask().problem().unwrap().requirements_met(&[delay("0.5")], Some("P"), &budget).unwrap_err().to_string();
    assert!(refused.contains("more than 64 samples at the input of a plant behind a hold"), "{refused}");
}
