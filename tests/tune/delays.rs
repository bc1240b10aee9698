//! The best delay margin.

use crate::helpers::folder::Folder;
use crate::helpers::number::{number, ratio};
use crate::helpers::schema::fits;
use crate::helpers::thorough::{count, is_thorough};
use jurist_algebra::number::Rational;
use proptest::prelude::*;
use serde_json::Value;

const OBJECTIVE: [&str; 2] = ["--objective", "max delay_margin"];

fn tune(options: &[&str]) -> (i32, Value) {
    let run = Folder::new(&[]).jurist(&[&["tune", "--json", "--digits", "15"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}: {document}"));
    (run.status, document)
}

/// The value that was found, and the one that none have.
fn bracket(found: &Value) -> [Rational; 2] {
    [&found["found"]["value"], &found["proved"]].map(|text| number(text.as_str().unwrap_or_else(|| panic!("{found}"))))
}

/// That the bracket holds a number known to ten digits, and is as narrow as the gap.
fn holds(found: &Value, exact: f64, gap: f64) {
    let [low, high] = bracket(found).map(|x| x.to_f64_approximate());
    assert!(low <= exact + 1e-10 && exact <= high + 1e-10 && high <= low * (1.0 + 1.1 * gap), "{exact}: {found}");
}

/// The delay margin of `K/s` is `pi/(2 K)`: best at the least `K`.
#[test]
#[ignore = "long: CI runs it"]
fn of_an_integrator() {
    let (status, found) = tune(&[&["K/s", "--free", "K", "--bound", "K=1..10"], &OBJECTIVE[..]].concat());
    assert_eq!(status, 0);
    holds(&found, std::f64::consts::FRAC_PI_2, 1e-3);
}

/// Dead time of the loop is taken from it.
#[test]
#[ignore = "long: CI runs it"]
fn beside_dead_time() {
    let (_, found) = tune(&[&["exp(-s/10)*K/s", "--free", "K", "--bound", "K=1..10"], &OBJECTIVE[..]].concat());
    holds(&found, std::f64::consts::FRAC_PI_2 - 0.1, 1e-3);
}

/// The gain of `K/(s + 1)` is 1 at `w = sqrt(K^2 - 1)`, where its phase is `-atan w`.
#[test]
#[ignore = "long: CI runs it"]
fn of_a_lag() {
    let (_, found) = tune(&[&["K/(s+1)", "--free", "K", "--bound", "K=2..10"], &OBJECTIVE[..]].concat());
    let w = 3_f64.sqrt();
    holds(&found, (std::f64::consts::PI - w.atan()) / w, 1e-3);
}

/// With `K <= 1` the loop is stable with any delay.
#[test]
fn without_bound() {
    let options = ["K/(s+1)", "--free", "K", "--bound", "K=0.5..10", OBJECTIVE[0], OBJECTIVE[1]];
    if is_thorough() {
        let (status, found) = tune(&options);
        assert!(status == 0 && found["proved"].is_null() && found["optimum"]["unbounded"] == true, "{found}");
    }
    let run = Folder::new(&[]).jurist(&[&["tune"], &options[..]].concat());
    assert!(run.stdout.contains("\nlargest delay_margin: none, the loop is stable with any delay\n"), "{}", run.stdout);
}

/// `K (s + 4)/(s (s + 1)^2)` is stable below `K = 1`, the bound, and marginal there: boxes beside it do not tell.
#[test]
fn of_a_gain_that_is_stable_nowhere_and_marginal_on_its_bound() {
    let options = ["K*(s+4)/(s*(s+1)^2)", "--free", "K", "--bound", "K=1..7", OBJECTIVE[0], OBJECTIVE[1]];
    let (status, found) = tune(&options);
    assert!(status == 1 && found["feasible"] == false, "{found}");
}

/// From `K = 1` on nothing is borne, as the open loop goes to `K` at high frequencies; below a half any delay is.
#[test]
#[ignore = "long: CI runs it"]
fn of_a_box_of_which_only_a_part_bears_any_delay() {
    let options = ["K*(s+2)/(s+1)", "--free", "K", "--bound", "K=0.25..2", OBJECTIVE[0], OBJECTIVE[1]];
    let (status, found) = tune(&options);
    assert!(status == 0 && found["proved"].is_null(), "{found}");
    // Without these it is not decided, and ends.
    let options = ["K*(s+2)/(s+1)", "--free", "K", "--bound", "K=0.6..2", OBJECTIVE[0], OBJECTIVE[1]];
    assert_eq!(tune(&options).0, 3);
}

/// `(kp s + ki)/s^2`: with `w^2` the root of `x^2 = kp^2 x + ki^2` the margin is `atan(kp w/ki)/w`, less where `ki` is more.
#[test]
#[ignore = "long: CI runs it"]
fn of_two_gains() {
    let bounds = ["--free", "kp", "--free", "ki", "--bound", "kp=0.25..4", "--bound", "ki=0.25..2", "--gap", "1%"];
    let (_, found) = tune(&[&["(kp*s+ki)/s/s"], &bounds[..], &OBJECTIVE].concat());
    let ki = 0.25_f64;
    let margin = |kp: f64| {
        let w = ((kp * kp + (kp.powi(4) + 4.0 * ki * ki).sqrt()) / 2.0).sqrt();
        (kp * w / ki).atan() / w
    };
    let best = (0..=40000).map(|k| margin(0.25 + f64::from(k) * 1e-4)).fold(0.0, f64::max);
    let [low, high] = bracket(&found).map(|x| x.to_f64_approximate());
    // The grid is as fine as its steps.
    assert!(low <= best + 1e-6 && best <= high && high <= low * 1.011, "{best}: {found}");
}

/// A delay margin that is required: `pi/(2 K) >= 1/2`. Of one gain its exact set tells the end, with bounds of the gain and without.
#[test]
fn that_is_required() {
    for bounds in [&[][..], &["--bound", "K=1..10"]] {
        let options = ["K/s", "--free", "K", "--objective", "max K", "--delay-margin", "1/2"];
        let (_, found) = tune(&[&options[..], bounds].concat());
        let best = &found["optimum"];
        assert_eq!(best["decimal"], "3.14159265358979", "{found}");
        assert!(best["binding"] == serde_json::json!(["delay_margin"]) && found["cells"].is_null(), "{found}");
    }
    let none = ["K/s", "--free", "K", "--bound", "K=4..10", "--objective", "none", "--delay-margin", "1/2"];
    assert_eq!(tune(&none).0, 1);
}

/// `pi/(2 a K)` for all `a` up to 2: `pi/4` at the least `K`.
#[test]
#[ignore = "long: CI runs it"]
fn for_all_plants() {
    let plant = ["K*a/s", "--free", "K", "--bound", "K=1..4", "--for-all", "a=1..2", "--gap", "10%"];
    let (_, found) = tune(&[&plant[..], &OBJECTIVE].concat());
    holds(&found, std::f64::consts::FRAC_PI_4, 0.1);
}

/// `K z^-k/(z - 1)` is stable with one sample more up to `K = 1`, with two up to `2 sin(pi/10)`.
#[test]
fn of_one_gain_it_is_required_in_samples() {
    let text = "time = 'discrete'\nsample_time = 1\nparameters.K = {}\nloop = { inputs = ['r'], outputs = ['y'] }\n[[block]]\n\
        name = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(z - 1)'\n";
    let folder = Folder::new(&[("loop.toml", text)]);
    for (samples, best) in [("1", 1.0), ("2", 2.0 * (std::f64::consts::PI / 10.0).sin())] {
        let options = ["tune", "loop.toml", "--free", "K", "--objective", "max K", "--json", "--delay-margin", samples];
        let run = folder.jurist(&options);
        let found: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{}", run.stderr));
        let value = found["optimum"]["decimal"].as_str().unwrap_or_else(|| panic!("{found}")).parse::<f64>().unwrap();
        assert!((value - best).abs() < 1e-9, "{samples}: {found}");
    }
}

/// In discrete time it is counted in samples.
#[test]
fn in_discrete_time_it_is_refused() {
    let options = ["tune", "K/(z-1)", "--free", "K", "--bound", "K=0.1..1", OBJECTIVE[0], OBJECTIVE[1]];
    let run = Folder::new(&[]).jurist(&options);
    assert!(run.status == 2 && run.stderr.contains("max phase_margin"), "{}", run.stderr);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(2, 6) as u32))]

    /// No gain of a grid has a margin that none have, and the one that is found has what is said.
    #[test]
    #[ignore = "long: CI runs it"]
    fn as_margins_say(a in 1_i64..6, b in 1_i64..6, k in 1_i64..8) {
        // Where the limit 2 a^3/(b - 2 a) is the lower bound itself no search tells that no gain is stable.
        prop_assume!(b <= 2 * a || 2 * a * a * a != k * (b - 2 * a));
        let line = format!("K*(s + {b})/(s*(s + {a})^2)");
        let bounds = format!("K={k}..{}", k + 6);
        let run = Folder::new(&[]).jurist(&["tune", "--json", "--digits", "15", &line, "--free", "K", "--bound", &bounds, "--gap", "2%", OBJECTIVE[0], OBJECTIVE[1]]);
        let found: Value = serde_json::from_str(&run.stdout).unwrap();
        let margin = |gain: &Rational| -> Option<Rational> {
            let set = format!("K={gain}");
            let run = Folder::new(&[]).jurist(&["margins", &line, "--set", &set, "--json"]);
            let found: Value = serde_json::from_str(&run.stdout).unwrap();
            found["delay"]["enclosure"][0].as_str().map(number)
        };
        if run.status == 1 {
            // No gain is stable.
            for step in 0..=6 {
                prop_assert!(margin(&Rational::from(k + step)).is_none());
            }
            return Ok(());
        }
        prop_assert_eq!(run.status, 0, "{}", &found);
        let [least, proved] = bracket(&found);
        prop_assert!(proved <= &least * &ratio(1021, 1000), "{}", &found);
        for step in 0..=12 {
            let gain = Rational::from(k) + ratio(step, 2);
            if let Some(margin) = margin(&gain) {
                prop_assert!(margin < proved, "K = {}: {} {}", gain, margin, &found);
            }
        }
        let at = number(found["found"]["point"]["K"].as_str().unwrap());
        let own = margin(&at);
        prop_assert!(own.as_ref().is_some_and(|own| own * &ratio(1_000_001, 1_000_000) >= least), "{:?} {}", own, &found);
    }
}

/// The best decay of `s + 1 + K exp(-s)` is 2, that of a double root at `K = exp(-2)`. Roots meet on the line of just this number, where no method tells, and it is one of the first that
/// are asked for; at a decay of 1 an end at K = 0 took all time there is.
#[test]
#[ignore = "long: CI runs it"]
fn the_largest_decay_with_dead_time_is_bracketed_beside_the_number_at_which_roots_meet() {
    let asked = ["K/(s+1)", "--delay", "1", "--free", "K", "--objective", "max decay", "--gap", "0.5"];
    let (status, found) = tune(&asked);
    assert_eq!(status, 0, "{found}");
    holds(&found, 2.0, 1.0);
}
