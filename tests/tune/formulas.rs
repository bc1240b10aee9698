//! `jurist tune` with expressions of the gains as the objective: closed forms, dense scans, random optima that are known.

use crate::helpers::folder::Folder;
use crate::helpers::model::read;
use crate::helpers::number::{number, ratio};
use crate::helpers::schema::fits;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::model::Model;
use jurist_engine::response::Requirements;
use jurist_tune::answer::{Best, Optimum, Outcome, TuneAnswer};
use jurist_tune::asked::{Asked, Gain};
use proptest::prelude::*;
use serde_json::Value;

/// Stable where 0 < K < 6.
const CUBIC: &str = "K/(s*(s+1)*(s+2))";

fn line(text: &str, options: &[&str]) -> Value {
    let folder = Folder::new(&[]);
    let run = folder.jurist(&[&["tune", text, "--free", "K", "--json", "--digits", "12"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}"));
    document
}

#[test]
fn the_best_value_is_at_an_end_or_where_the_slope_is_zero() {
    for (objective, exact, place, attained) in [
        ("max K*(3 - K)", "9/4", "3/2", true),
        ("min (K - 2)^4 + 1", "1", "2", true),
        ("max K^2 - 12*K", "0", "0", false),
        ("min 1/K", "1/6", "6", false),
        ("max K/(K^2 + 4)", "1/4", "2", true),
        // The pole at 8 is beyond the end.
        ("max 1/(8 - K)", "1/2", "6", false),
        // Two flat places of the same value.
        ("max -((K - 1)*(K - 2))^2 + 7", "7", "1", true),
    ] {
        let found = line(CUBIC, &["--objective", objective]);
        let optimum = &found["optimum"];
        let values = (&optimum["value"]["exact"], &optimum["at"]["K"]["value"]["exact"], &optimum["attained"]);
        assert_eq!(values, (&exact.into(), &place.into(), &attained.into()), "{objective}: {found}");
    }
}

#[test]
fn an_irrational_best_value_has_its_polynomial() {
    // At sqrt(2/3): -(4/3) sqrt(2/3).
    let found = line(CUBIC, &["--objective", "min K^3 - 2*K"]);
    let optimum = &found["optimum"];
    assert_eq!(optimum["value"]["polynomial"], serde_json::json!(["-32", "0", "27"]));
    assert_eq!(
        (&optimum["value"]["decimal"], &optimum["at"]["K"]["value"]["decimal"]),
        (&"-1.08866210790".into(), &"0.816496580928".into())
    );
}

#[test]
fn values_without_bound_and_limits() {
    for (text, objective, place) in [
        (CUBIC, "max 1/K", Some("0")),
        (CUBIC, "min 1/(K - 2)^3", Some("2")),
        (CUBIC, "max 1/(K - 2)^2", Some("2")),
        ("K/(s+1)", "max K^2 - K", None),
    ] {
        let found = line(text, &["--objective", objective]);
        let optimum = &found["optimum"];
        assert_eq!((&optimum["value"], &optimum["decimal"]), (&Value::Null, &Value::Null), "{objective}");
        assert_eq!(optimum["at"]["K"]["value"]["exact"].as_str(), place, "{objective}: {found}");
    }
    // A double pole is no best value from below; stable where K > -1, and the limit is 1.
    assert_eq!(line(CUBIC, &["--objective", "min 1/(K - 2)^2"])["optimum"]["value"]["exact"], "1/16");
    let found = line("K/(s+1)", &["--objective", "max K/(K + 2)"]);
    assert_eq!((&found["optimum"]["value"]["exact"], &found["optimum"]["attained"]), (&"1".into(), &false.into()));
}

/// Behind a hold the ends are enclosed, and so is the best value.
#[test]
fn an_expression_behind_a_hold_is_enclosed() {
    let end = line("K/(s*(s+1))", &["--hold", "1/10", "--objective", "max K"]);
    let end = number(end["optimum"]["value"]["decimal"].as_str().unwrap());
    let found = line("K/(s*(s+1))", &["--hold", "1/10", "--objective", "max K^2 + K"]);
    let [least, proved] = [&found["found"]["value"], &found["proved"]].map(|text| number(text.as_str().unwrap()));
    let exact = &end * &end + end;
    assert!(least < exact && &exact - &number("1e-6") < proved && proved < least * ratio(10001, 10000), "{found}");
}

#[test]
fn what_no_objective_is_says_why() {
    let folder = Folder::new(&[]);
    for (objective, words) in [
        ("max K*X", "'X' is no free gain"),
        ("max decay*K", "a number of the loop, which is no part of an expression"),
        ("max 2 + 3", "no free gain"),
        ("max exp(K)", "functions are not known"),
        ("max 1/(K - K)", "divides by zero"),
        ("max K - K", "the same for all gains"),
        ("max K^900", "too large"),
        ("max K)", "E-syntax"),
    ] {
        let run = folder.jurist(&["tune", CUBIC, "--free", "K", "--objective", objective]);
        assert!(run.status == 2 && run.stderr.contains(words), "{objective}: {}", run.stderr);
    }
    let model = "time = 'continuous'\nparameters = { a = 1, b = 1 }\nloop.characteristic = 's^2 + a*s + b'\n";
    let folder = Folder::new(&[("loop.toml", model)]);
    let bounds = ["--free", "a", "--free", "b", "--bound", "a=0..2", "--bound", "b=0..2"];
    let run = folder.jurist(&[&["tune", "loop.toml", "--objective", "max b/a"], &bounds[..]].concat());
    assert!(run.status == 2 && run.stderr.contains("leave out the zeros of a"), "{}", run.stderr);
}

/// Other names of the model have their values.
#[test]
fn an_objective_may_have_constants_and_parameters() {
    let model = "time = 'continuous'\nconstants.c = '2*T'\nparameters = { K = 1, T = 3 }\nloop.characteristic = 's^2 + s + K'\n\
        [tune]\nfree = 'K'\nobjective = 'max c*K - K^2'\n";
    let folder = Folder::new(&[("loop.toml", model)]);
    for (set, best) in [(&[][..], "9"), (&["--set", "T=1"], "1")] {
        let run = folder.jurist(&[&["tune", "loop.toml", "--json"], set].concat());
        let found: Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(found["optimum"]["value"]["exact"], best, "{found}");
    }
}

fn answer(model: &Model, bounds: &[(&str, Rational, Rational)], objective: &str, gap: Rational) -> TuneAnswer {
    let gains = bounds.iter().map(|(name, low, high)| Gain::new(*name).within([Some(low.clone()), Some(high.clone())]));
    let mut asked = Asked::of(model, gains.collect(), objective, Requirements::default()).unwrap();
    asked.gap = gap;
    TuneAnswer::of(&model.ask(), asked, &Budget::unlimited()).unwrap()
}

fn optimum(answer: &TuneAnswer) -> &Optimum {
    match &answer.outcome {
        Outcome::Optimum(optimum) => optimum,
        other => panic!("{other:?}"),
    }
}

/// What was found and what is proved, ascending where more is better.
fn bracket(answer: &TuneAnswer) -> [Rational; 2] {
    match &optimum(answer).value {
        Best::Between(ends) => ends.clone(),
        Best::Exact(x) => [x.exact().unwrap(), x.exact().unwrap()],
        other => panic!("{other:?}"),
    }
}

/// Of `s^4 + s^3 + kd s^2 + kp s + ki`, stable where `kp (kd - kp) > ki > 0`: `ki - kp^2` is below `kp kd - 2 kp^2`, which is 9/32 at `kp = 3/8`.
#[test]
fn three_gains() {
    let text = "time = 'continuous'\nparameters = { kp = 1, ki = 1, kd = 1 }\n\
        loop.characteristic = 's^4 + s^3 + kd*s^2 + kp*s + ki'\n";
    let percent = count(10, 2) as i64;
    let bounds = [("kp", "1"), ("ki", "1"), ("kd", "1.5")].map(|(name, high)| (name, Rational::ZERO, number(high)));
    let found = answer(&read(text), &bounds, "max ki - kp^2", ratio(percent, 100));
    let [least, proved] = bracket(&found);
    let exact = ratio(9, 32);
    assert!(least < exact && exact <= proved && proved < &least * &ratio(101 + percent, 100), "{least} {proved}");
    let typed = optimum(&found).typed.as_ref().unwrap();
    let value = &typed.values[1] - &(&typed.values[0] * &typed.values[0]);
    assert!(typed.value.as_ref().unwrap().contains(&value) && value >= &least * &ratio(99, 100), "{typed:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(10, 24) as u32))]

    /// The distance to a point, of loops that are stable in the quadrant: zero inside, else that to the quadrant within the bounds.
    #[test]
    fn the_nearest_gains_to_a_point(p in -8_i64..24, q in -8_i64..24) {
        let model = read("time = 'continuous'\nparameters = { a = 1, b = 1 }\nloop.characteristic = 's^2 + a*s + b'\n");
        let bounds = ["a", "b"].map(|name| (name, ratio(-1, 1), ratio(2, 1)));
        let (p, q) = (ratio(p, 8), ratio(q, 8));
        let objective = format!("min (a - ({p}))^2 + (b - ({q}))^2 + 1");
        let found = answer(&model, &bounds, &objective, ratio(1, 100));
        let beyond = |x: &Rational| {
            let nearest = x.clone().max(Rational::ZERO).min(ratio(2, 1));
            let distance = x - &nearest;
            &distance * &distance
        };
        let exact = beyond(&p) + beyond(&q) + Rational::ONE;
        let [most, proved] = bracket(&found);
        prop_assert!(proved <= exact && exact <= most && most <= &proved * &ratio(103, 100), "{} {} {}", proved, exact, most);
        let point = &optimum(&found).found;
        let question = model.ask().set("a", point[0].clone()).set("b", point[1].clone());
        let verdict = question.problem().unwrap().verdict(&Budget::unlimited()).unwrap();
        prop_assert_eq!(verdict.value().verdict, Verdict::Stable);
    }

    /// A random quotient over the gains of a cubic loop: no point of a dense scan is better, and points near to the best place are nearly as good.
    #[test]
    fn no_point_of_a_scan_is_better(
        above in proptest::collection::vec(-9_i64..9, 1..5),
        below in proptest::collection::vec(-5_i64..6, 1..4),
        is_greatest: bool,
    ) {
        let formula = |c: &[i64]| {
            let terms: Vec<String> = c.iter().enumerate().map(|(k, c)| format!("({c})*K^{k}")).collect();
            terms.join(" + ")
        };
        let at = |c: &[i64], x: &Rational| c.iter().rev().fold(Rational::ZERO, |sum, c| sum * x + Rational::from(*c));
        let is_constant = |c: &[i64]| c[1..].iter().all(|c| *c == 0);
        prop_assume!(below.iter().any(|c| *c != 0) && !is_constant(&above));
        let model = read("time = 'continuous'\nparameters.K = 1\nloop.characteristic = 's^3 + 3*s^2 + 2*s + K'\n");
        let word = if is_greatest { "max" } else { "min" };
        let objective = format!("{word} ({})/({})", formula(&above), formula(&below));
        let Ok(asked) = Asked::of(&model, vec![Gain::new("K")], &objective, Requirements::default()) else { return Ok(()) };
        // A quotient may be the same for all gains.
        let Ok(found) = TuneAnswer::of(&model.ask(), asked, &Budget::unlimited()) else { return Ok(()) };
        let best = &optimum(&found).value;
        let mut scanned: Option<Rational> = None;
        for k in 1..600 {
            let x = ratio(k, 100);
            let Some(value) = at(&above, &x).checked_div(&at(&below, &x)) else { continue };
            if let Best::Exact(best) = best {
                let order = best.compare_rational(&value);
                prop_assert!(if is_greatest { order.is_ge() } else { order.is_le() }, "{} at {}: {}", value, x, objective);
            }
            let is_better = |known: &Rational| if is_greatest { value > *known } else { value < *known };
            if scanned.as_ref().is_none_or(is_better) {
                scanned = Some(value);
            }
        }
        // What is found is nearly as good as the scan, and the best value is no better than what is found by much.
        let known = optimum(&found).found_value.clone().unwrap();
        if let Best::Exact(best) = best {
            let (low, high) = best.refined_to_digits(9).enclosure();
            let size = &low.abs() + &Rational::ONE;
            prop_assert!((&known - &low).abs() < &size * &ratio(1, 10), "{} has {}, best {}..{}", objective, known, low, high);
        }
    }
}
