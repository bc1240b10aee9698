//! The least margins for all values of names: beside numbers known by hand, and beside the margins at random values.

use crate::helpers::model::read;
use crate::helpers::number::{number, ratio};
use crate::helpers::program::jurist;
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_engine::model::Model;
use jurist_engine::response::{AllOf, Everywhere, LeastMargins, Level, MapForAll};

fn loop_of(time: &str, transfer: &str, more: &str) -> Model {
    read(&format!(
        "time = '{time}'\n{more}[parameters]\na = 1\nb = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'C'\ninput = 'r - y'\n\
         output = 'u'\ngain = 1\n[[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\n{transfer}\n"
    ))
}

fn least(model: &Model, ranges: &[(&str, &str, &str)]) -> LeastMargins {
    let all = ranges.iter().map(|(name, low, high)| AllOf::new(*name, number(low), number(high)).unwrap());
    MapForAll::new(all.collect()).least_margins(model.ask(), &Budget::unlimited()).unwrap().into_value()
}

/// What is proved, and the bounds of what one value has.
fn bounds(found: &LeastMargins, level: Level) -> (Rational, Enclosure, Vec<Rational>) {
    let margin = found.margins.iter().find(|margin| margin.level == level).unwrap();
    let (value, point) = margin.found.clone().unwrap_or_else(|| panic!("{margin:?}"));
    (margin.proved.clone().unwrap_or_else(|| panic!("{margin:?}")), value, point)
}

#[test]
fn least_margins_that_are_known_by_hand() {
    // a/s^2 with a lead: worst inside of the range, where the gain is 1 + (a - 1)^2 and least at a = 1.
    let model = loop_of("continuous", "transfer = '(1 + (a - 1)^2)*2/(s*(s + 1))'", "");
    let found = least(&model, &[("a", "1/2", "2")]);
    assert_eq!(found.stable, Everywhere::All);
    // The greatest gain, 4 at a = 2, has the least phase margin: w^2 (w^2 + 1) = 16.
    let (proved, value, point) = bounds(&found, Level::PhaseMargin);
    assert_eq!(point, [number("2")]);
    let crossing = ((-1.0 + 65.0_f64.sqrt()) / 2.0).sqrt();
    let expected = (1.0 / crossing).atan().to_degrees();
    assert!((value.lower().to_f64_approximate() - expected).abs() < 1e-9, "{expected}");
    assert!(proved <= *value.lower() && proved > value.lower() * &number("0.98"));
    // K/s bears a dead time of pi/(2 K).
    let model = loop_of("continuous", "transfer = 'a*b/s'", "");
    let found = least(&model, &[("a", "1", "2"), ("b", "1/3", "3/2")]);
    let (proved, value, point) = bounds(&found, Level::DelayMargin);
    assert_eq!(point, [number("2"), number("3/2")]);
    assert!(proved <= *value.lower() && *value.lower() < number("0.5235987756"));
    assert!(number("0.5235987755") < *value.upper() && proved > number("0.51"));
    // Sampled: 1 - a/(z - 1) at z = -1 has the gain margin 2/a and the modulus margin 1 - a/2.
    let model = loop_of("discrete", "transfer = 'a/(z - 1)'", "");
    let found = least(&model, &[("a", "1/2", "4/5")]);
    let (proved, value, _) = bounds(&found, Level::GainMargin);
    assert!(value.lower() <= &number("5/2") && &number("5/2") <= value.upper() && proved > number("2.48"));
    let (proved, value, _) = bounds(&found, Level::ModulusMargin);
    assert!(value.lower() <= &number("3/5") && &number("3/5") <= value.upper() && proved > number("0.59"));
}

/// The margin is least inside of a range, where neither end tells it.
#[test]
fn the_worst_value_may_be_inside() {
    let model = loop_of("continuous", "transfer = '(2 - (a - 1)^2)/(s*(s + 1)*(s + 2))'", "");
    let found = least(&model, &[("a", "1/4", "5/3")]);
    // Gain 2 at a = 1, and 6 is the limit; the middle of the range is 23/24.
    let (proved, value, _) = bounds(&found, Level::GainMargin);
    assert!(proved > number("2.9") && proved <= number("3") && *value.upper() >= number("3"), "{proved} {value:?}");
    assert!(*value.lower() < number("3.02"), "{value:?}");
}

/// At an undamped resonance the open loop is infinite, and everything that tells a crossing is zero there; its gain margin is (2 c - 1)/k.
#[test]
fn a_gain_margin_beside_an_undamped_resonance() {
    let found = least(&crate::helpers::model::example("lcl-active-damping"), &[("k", "1/10", "1/5")]);
    let (proved, value, point) = bounds(&found, Level::GainMargin);
    assert_eq!((point, value.lower(), value.upper()), (vec![number("1/5")], &number("3"), &number("3")));
    assert!(proved > number("2.95") && proved < number("3"));
}

/// No value has less than what is proved, and one value has what is told.
#[test]
#[ignore = "long: CI runs it"]
fn random_values_have_at_least_what_is_proved() {
    let mut random = Random::new(20_261_128);
    let shapes = [
        ("continuous", "transfer = '2*b/(s*(s + a)*(s + 3))'", ""),
        ("continuous", "transfer = 'b*exp(-s/4)/(s + a)'", ""),
        ("continuous", "transfer = '(s + b)/(s*(s^2 + a*s + 2))'", ""),
        ("discrete", "transfer = 'b/(s*(s + a))'\ndiscretize = 'zoh'", "sample_time = '1/5'\n"),
        ("discrete", "transfer = 'b/5/(z - a/4)'", ""),
    ];
    let mut compared = 0;
    for case in 0..count(5, 40) {
        let (time, transfer, more) = shapes[case % shapes.len()];
        let model = loop_of(time, transfer, more);
        let mut side = || {
            let low = ratio(1 + random.below(20) as i64, 16);
            [low.clone(), low + ratio(1 + random.below(12) as i64, 32)]
        };
        let sides = [side(), side()];
        let all =
            ["a", "b"].into_iter().zip(&sides).map(|(name, [low, high])| AllOf::new(name, low.clone(), high.clone()));
        let names = MapForAll::new(all.map(Option::unwrap).collect());
        // A range that ends near to where a margin is lost takes long.
        let Ok(found) = names.least_margins(model.ask(), &Budget::with_work(20_000_000)) else { continue };
        let found = found.into_value();
        if let Everywhere::NotAt(point) = &found.stable {
            let at = ["a", "b"].map(str::to_owned).into_iter().zip(point.iter().cloned());
            let margins = model.ask().set_all(at).margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap();
            assert!(margins.value().stable.is_none(), "{transfer} {point:?}");
            continue;
        }
        for _ in 0..6 {
            let point = sides.each_ref().map(|[low, high]| low + (high - low) * ratio(random.below(65) as i64, 64));
            let at = ["a", "b"].map(str::to_owned).into_iter().zip(point.iter().cloned());
            let problem = model.ask().set_all(at).problem().unwrap();
            for margin in &found.margins {
                let own = problem.level_at((margin.level, None), None, 64, &Budget::unlimited()).unwrap();
                let (Some(own), Some(proved)) = (own, &margin.proved) else { continue };
                let is_kept =
                    if margin.level.is_greatest_best() { proved <= own.upper() } else { proved >= own.lower() };
                assert!(is_kept, "{transfer} {point:?} {margin:?} {own:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > count(30, 400), "{compared}");
}

#[test]
#[ignore = "long: CI runs it"]
fn the_program_tells_the_least_margins() {
    let run = jurist(&["margins", "--for-all", "T=1e-5..1e-4", "--set", "K_pwm=100"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    for line in [
        "cut at the gain 'K_pwm'\n",
        "for all T from 0.00001 to 0.0001: stable\n",
        "gain margin: at least 5.49; 5.50941166687 at T = 0.0001\n",
    ] {
        assert!(run.stdout.contains(line), "{}", run.stdout);
    }
    let run = jurist(&["margins", "a/(s*(s + 1)*(s + 2))", "--for-all", "a=1..7", "-q"]);
    assert!(run.status == 1 && run.stdout.contains("for all a from 1 to 7: not stable, as at a = 7"), "{}", run.stdout);
    let run = jurist(&["margins", "a/(s + 1)", "--for-all", "a=1..2", "-q"]);
    let unlimited = "\ngain margin: at least 996; no value that was looked at has a limit\n";
    assert!(run.stdout.contains(unlimited), "{}", run.stdout);
    let run = jurist(&["margins", "a/(s + 1)", "--for-all", "a=1..2", "--at", "nowhere", "-q"]);
    assert!(run.status == 2 && run.stderr.contains("E-unknown-signal"), "{} {}", run.status, run.stderr);
    let run = jurist(&["margins", "a/(s + 1)", "--for-all", "b=1..2", "-q"]);
    assert!(run.status == 2 && run.stderr.contains("the model has no parameter 'b'"), "{}", run.stderr);
    let run = jurist(&["margins", "a/(s + 1)", "--for-all", "a=1..2", "--work", "1000", "-q"]);
    assert!(run.status == 3, "{} {}", run.status, run.stdout);
}
