//! Requirements that are a circle which the open loop keeps to one side of: answers by hand, and peaks over sampled frequencies.

use crate::helpers::model::{example, load};
use crate::helpers::number::{number, ratio};
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, UniPoly};
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::response::{RequiredSet, Requirement, Requirements};
use jurist_engine::stability::{Range, Shape, is_stable};
use jurist_show::diagnostics::render_error;
use jurist_show::required_value;

/// A single loop; `K` is free.
fn loop_with(time: &str, transfer: &str) -> Model {
    load(&text_of(time, transfer))
}

fn text_of(time: &str, transfer: &str) -> String {
    format!(
        "time = '{time}'\n[parameters]\nK = {{ nominal = '1/10', tolerance = '50%' }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\ntransfer = '{transfer}'\n"
    )
}

fn requirement(model: &Model, name: &str, value: &str) -> Requirement {
    let asked = Requirements::of(model, &[(name, value)], &[], &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"));
    asked.list.into_iter().next().expect("no region")
}

fn required(model: &Model, requirement: &Requirement) -> RequiredSet {
    let problem = model.ask().free("K").problem().unwrap();
    let list = std::slice::from_ref(requirement);
    problem.required_set(list, None, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value()
}

fn contains(set: &RequiredSet, x: &Rational) -> bool {
    set.intervals.iter().any(|interval| interval.contains(x))
}

/// The set as text, with brackets where an end belongs to it.
fn written(set: &RequiredSet) -> String {
    assert!(set.undecided.is_empty());
    let parts: Vec<String> = set
        .intervals
        .iter()
        .map(|i| {
            let value = |end: &jurist_engine::response::RequiredEnd| end.value().decimal(12);
            let (lower, upper) = (i.lower.as_ref().map(value), i.upper.as_ref().map(value));
            let is_in = |end: &Option<jurist_engine::response::RequiredEnd>| {
                end.as_ref().and_then(|end| end.value().exact()).is_some_and(|x| i.contains(&x))
            };
            let is_closed = |end: &Option<jurist_engine::response::RequiredEnd>| match end {
                Some(jurist_engine::response::RequiredEnd::Requirement { closed, .. }) => *closed,
                other => is_in(other),
            };
            format!(
                "{}{}, {}{}",
                if is_closed(&i.lower) { '[' } else { '(' },
                lower.unwrap_or_else(|| "-".to_owned()),
                upper.unwrap_or_else(|| "-".to_owned()),
                if is_closed(&i.upper) { ']' } else { ')' },
            )
        })
        .collect();
    parts.join(" ")
}

const CONTINUOUS: &str = "continuous";
const DISCRETE: &str = "discrete";

/// Sets by hand: time, open loop, requirement, number, set.
const BY_HAND: [(&str, &str, &str, &str, &str); 30] = [
    (CONTINUOUS, "K/(s + 1)", "modulus_margin", "1/2", "[-0.5, -)"),
    // |1 + L|^2 - 1 = (K^2 + 2 K)/(1 + w^2) has one sign at all frequencies.
    (CONTINUOUS, "K/(s + 1)", "modulus_margin", "1", "[0, -)"),
    (CONTINUOUS, "K/s", "modulus_margin", "1", "(0, -)"),
    (CONTINUOUS, "K", "modulus_margin", "2", "(-, -3] [1, -)"),
    (DISCRETE, "K/z", "modulus_margin", "1/2", "[-0.5, 0.5]"),
    (DISCRETE, "K/z", "modulus_margin", "2", ""),
    // T = K/(s + K) has its peak 1 at frequency 0, where L has a pole.
    (CONTINUOUS, "K/s", "complementary_peak", "6/5", "(0, -)"),
    (CONTINUOUS, "K/s", "complementary_peak", "1", "(0, -)"),
    (CONTINUOUS, "K/s", "complementary_peak", "9/10", ""),
    // 2 K/sqrt(4 K - 1) for K > 1/2, else 1: 2 at K = 2 + sqrt(3).
    (CONTINUOUS, "K/(s*(s + 1))", "complementary_peak", "2", "(0, 3.73205080757]"),
    (CONTINUOUS, "K/(s*(s + 1))", "complementary_peak", "1", "(0, 0.5]"),
    (CONTINUOUS, "K/(s*(s + 1))", "complementary_peak", "1/2", ""),
    // |K/(1 + K)| at frequency 0.
    (CONTINUOUS, "K/(s + 1)", "complementary_peak", "1/2", "[-0.333333333333, 1]"),
    (CONTINUOUS, "K/(s + 1)", "complementary_peak", "2", "[-0.666666666667, -)"),
    // Degree 0.
    (CONTINUOUS, "K", "complementary_peak", "2", "(-, -2] [-0.666666666667, -)"),
    (CONTINUOUS, "K", "complementary_peak", "1", "[-0.5, -)"),
    (CONTINUOUS, "K", "complementary_peak", "1/2", "[-0.333333333333, 1]"),
    // |K|/(1 - |K|).
    (DISCRETE, "K/z", "complementary_peak", "1/2", "[-0.333333333333, 0.333333333333]"),
    // K/|z - 1 + K|: 1 at z = 1, K/(2 - K) at z = -1.
    (DISCRETE, "K/(z - 1)", "complementary_peak", "1", "(0, 1]"),
    // |s + K| = |s - K| on the axis.
    (CONTINUOUS, "K/s", "disk_margin", "1", "(0, -)"),
    (CONTINUOUS, "K/s", "disk_margin", "2", "(0, -)"),
    (CONTINUOUS, "K/s", "disk_margin", "21/10", ""),
    // alpha = 2/sqrt(4 K + 1), at the frequency sqrt(K).
    (CONTINUOUS, "K/(s*(s + 1))", "disk_margin", "1", "(0, 0.75]"),
    (CONTINUOUS, "K/(s*(s + 1))", "disk_margin", "2/3", "(0, 2]"),
    (CONTINUOUS, "K/(s*(s + 1))", "disk_margin", "2", ""),
    // 2 (1 + K)/(1 - K) for negative K, and 2 in the limit of high frequencies for positive ones.
    (CONTINUOUS, "K/(s + 1)", "disk_margin", "1", "[-0.333333333333, -)"),
    (CONTINUOUS, "K/(s + 1)", "disk_margin", "2", "[0, -)"),
    // |1 + K| >= 2 |1 - K|, with a margin that has no bound at K = 1.
    (CONTINUOUS, "K", "disk_margin", "4", "[0.333333333333, 3]"),
    // 2 (1 - |K|)/(1 + |K|).
    (DISCRETE, "K/z", "disk_margin", "1", "[-0.333333333333, 0.333333333333]"),
    (DISCRETE, "K/z", "disk_margin", "3", ""),
];

#[test]
fn sets_that_are_known_by_hand() {
    for (time, transfer, name, value, expected) in tried(BY_HAND, 2) {
        let model = loop_with(time, transfer);
        let requirement = requirement(&model, name, value);
        assert_eq!(written(&required(&model, &requirement)), expected, "{transfer}: {}", requirement.text());
    }
}

const SERVO: &str = "K/(s*(s + 1))";

/// At a point, on the command line and from the model file: the value, and the exit status.
#[test]
fn the_program_says_whether_a_point_meets_them() {
    let text = text_of(CONTINUOUS, SERVO);
    // At K = 4 the peak 2 K/sqrt(4 K - 1) is 8/sqrt(15), and the disk margin 2/sqrt(17).
    for (option, key, status, said) in [
        ("--complementary-peak=5/2", "complementary_peak = '5/2'", 0, "complementary_peak <= 5/2: met (2.06559111798)"),
        ("--complementary-peak=2", "complementary_peak = 2", 1, "complementary_peak <= 2: not met (2.06559111798)"),
        ("--disk-margin=2/5", "disk_margin = '2/5'", 0, "disk_margin >= 2/5: met (0.485071250073)"),
        ("--disk-margin=1/2", "disk_margin = 0.5", 1, "disk_margin >= 1/2: not met (0.485071250073)"),
    ] {
        let with_key = format!("{text}[require]\n{key}\n");
        for (words, text) in
            [(vec!["verdict", "-", "--set=K=4", option], &text), (vec!["verdict", "-", "--set=K=4"], &with_key)]
        {
            let run = jurist_with_input(&words, text.as_bytes());
            assert_eq!(run.status, status, "{option}: {}", run.stderr);
            assert!(run.stdout.contains(said), "{said}: {}", run.stdout);
        }
    }
    for option in ["--complementary-peak=0", "--complementary-peak=-1", "--disk-margin=0", "--disk-margin=-1"] {
        let run = jurist_with_input(&["verdict", "-", "--set=K=4", option], text.as_bytes());
        assert!(run.status == 2 && run.stderr.contains("E-require"), "{option}: {}", run.stderr);
    }
}

/// Behind a hold: the margin at the end of the set is the required one.
#[test]
fn sets_of_a_loop_behind_a_hold_end_where_the_margin_is_the_required_one() {
    let model = example("dc-servo");
    for (name, value) in [("modulus_margin", "1/2"), ("complementary_peak", "3/2"), ("disk_margin", "3/5")] {
        let requirement = requirement(&model, name, value);
        let range = Range::between(Some(number("1")), Some(number("200")));
        let problem = model.ask().free("K").domain("K", range).problem().unwrap();
        let list = std::slice::from_ref(&requirement);
        let set = problem.required_set(list, None, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value();
        assert!(set.undecided.is_empty(), "{name}: {:?}", set.undecided);
        let end = set.intervals.last().unwrap().upper.as_ref().unwrap().value();
        let (lo, hi) = end.refined(&number("1e-12")).enclosure();
        let is_met = |value: Rational| {
            let problem = model.ask().set("K", value).problem().unwrap();
            let found = problem.requirements_met(list, None, &Budget::unlimited()).unwrap();
            let value: f64 = required_value(&found[0], 12).unwrap().parse().unwrap();
            assert!((value - number(&requirement.required()).to_f64_approximate()).abs() < 1e-9, "{name}: {value}");
            found[0].met
        };
        assert!(is_met(lo - number("1e-12")) && !is_met(hi + number("1e-12")), "{name}");
    }
}

/// With dead time, at points: against samples of `K exp(-j w/2)/(j w)`.
#[test]
#[ignore = "long: CI runs it"]
fn points_of_a_loop_with_dead_time_are_decided_by_the_margin() {
    let model = loop_with(CONTINUOUS, "K*exp(-s/2)/s");
    for k in tried(["1", "1/2", "2"], 3) {
        let gain = number(k).to_f64_approximate();
        let ratio = |w: f64, [u, v]: [f64; 2]| {
            let l = (-gain / w * (w / 2.0).sin(), -gain / w * (w / 2.0).cos());
            (1.0 + l.0).hypot(l.1) / (u + v * l.0).hypot(v * l.1)
        };
        let margins =
            [("modulus_margin", [1.0, 0.0]), ("disk_margin", [1.0, -1.0]), ("complementary_peak", [0.0, 1.0])];
        for (name, combined) in tried(margins, 2) {
            let least = (1..1_000_000).map(|i| ratio(f64::from(i) / 1e4, combined)).min_by(f64::total_cmp).unwrap();
            let bound = match name {
                "modulus_margin" => least,
                "complementary_peak" => 1.0 / least,
                _ => 2.0 * least,
            };
            for (factor, is_above) in [(0.999, false), (1.001, true)] {
                let requirement = requirement(&model, name, &format!("{:.9}", bound * factor));
                let problem = model.ask().set("K", number(k)).problem().unwrap();
                let list = std::slice::from_ref(&requirement);
                let met = problem.requirements_met(list, None, &Budget::unlimited()).unwrap()[0].met;
                assert_eq!(met, is_above == (name == "complementary_peak"), "K = {k}: {}", requirement.text());
            }
        }
    }
}

/// A requirement, and the least of which ratio of moduli it asks for: `|1 + L|` over `|u + v L|`.
fn asked(which: usize, model: &Model, random: &mut Random) -> (Requirement, [f64; 2], f64) {
    let number = ratio(2 + random.below(14) as i64, 8);
    let value = number.to_f64_approximate();
    let (name, combined, least) = match which {
        0 => ("modulus_margin", [1.0, 0.0], value),
        1 => ("complementary_peak", [0.0, 1.0], 1.0 / value),
        _ => ("disk_margin", [1.0, -1.0], value / 2.0),
    };
    (requirement(model, name, &number.to_string()), combined, least)
}

/// How many requirements [`asked`] knows.
const KINDS: usize = 3;

type Complex = (f64, f64);

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn value_at(p: &[f64], x: Complex) -> Complex {
    p.iter().rev().fold((0.0, 0.0), |sum, c| {
        let (re, im) = times(sum, x);
        (re + c, im)
    })
}

/// The least `|D + N|/|u D + v N|` over frequencies, in floating point: samples, and thirds of what is left around the least one.
fn least_ratio(d: &[f64], n: &[f64], [u, v]: [f64; 2], shape: Shape) -> f64 {
    let ratio = |t: f64| {
        let x = match shape {
            Shape::UnitDisc => ((std::f64::consts::PI * t).cos(), (std::f64::consts::PI * t).sin()),
            Shape::LeftHalfPlane => (0.0, t / (1.0 - t)),
        };
        let (d, n) = (value_at(d, x), value_at(n, x));
        let size = |z: Complex| z.0.hypot(z.1);
        size((d.0 + n.0, d.1 + n.1)) / size((u * d.0 + v * n.0, u * d.1 + v * n.1))
    };
    const SAMPLES: usize = 4000;
    let at = |k: usize| (k as f64 + 0.5) / (SAMPLES as f64 + 1.0);
    let best = (0..SAMPLES).min_by(|a, b| ratio(at(*a)).total_cmp(&ratio(at(*b)))).unwrap();
    let (mut lo, mut hi) = (at(best.saturating_sub(1)), at(best + 1).min(1.0 - 1e-9));
    if best == 0 {
        lo = 1e-9;
    }
    for _ in 0..80 {
        let (a, b) = (lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0);
        if ratio(a) < ratio(b) { hi = b } else { lo = a }
    }
    ratio(lo)
}

/// Random loops and values: `K N/D0`, and `N/(D0 + K)`.
#[test]
#[ignore = "long: CI runs it"]
fn sets_of_random_loops_agree_with_sampled_peaks() {
    let mut random = Random::new(20);
    let mut seen = [[0; 2]; KINDS];
    for round in 0..60 {
        let (time, shape) = [(CONTINUOUS, Shape::LeftHalfPlane), (DISCRETE, Shape::UnitDisc)][round % 2];
        let mut coefficients = |terms: usize, most: usize| -> Vec<i64> {
            (0..terms).map(|_| random.below(2 * most + 1) as i64 - most as i64).collect()
        };
        let mut d = coefficients(3 - round / 30, 4);
        let mut n = coefficients(1 + round / 20, 3);
        d.push(if time == DISCRETE { 9 } else { 5 });
        n[0] += i64::from(n.iter().all(|c| *c == 0));
        let variable = if time == DISCRETE { "z" } else { "s" };
        let terms = |p: &[i64]| {
            let all: Vec<String> = p.iter().enumerate().map(|(i, c)| format!("({c})*{variable}^{i}")).collect();
            all.join(" + ")
        };
        let is_gain = round % 3 != 2;
        let transfer = match is_gain {
            true => format!("K*({})/({})", terms(&n), terms(&d)),
            false => format!("({})/({} + K)", terms(&n), terms(&d)),
        };
        let model = loop_with(time, &transfer);
        for (which, seen) in seen.iter_mut().enumerate() {
            let (requirement, combined, least) = asked(which, &model, &mut random);
            let set = required(&model, &requirement);
            for _ in 0..12 {
                let x = ratio(random.below(4001) as i64 - 2000, 300);
                let factor = x.to_f64_approximate();
                let floats = |p: &[i64]| p.iter().map(|c| *c as f64).collect::<Vec<_>>();
                let (mut df, mut nf) = (floats(&d), floats(&n));
                let (top, bottom) = (x.numerator(), x.denominator());
                let [whole_d, whole_n] = [&d, &n].map(|p| UniPoly::from_i64(p).scaled(&bottom));
                let closed = if is_gain {
                    nf.iter_mut().for_each(|c| *c *= factor);
                    whole_d.plus(&UniPoly::from_i64(&n).scaled(&top))
                } else {
                    df[0] += factor;
                    whole_d.plus(&whole_n).plus(&UniPoly::one().scaled(&top))
                };
                // The degree may fall with the parameter only where numerator and denominator have the same.
                let is_full = closed.degree() == Some(d.len() - 1);
                let found = least_ratio(&df, &nf, combined, shape);
                if (found / least - 1.0).abs() < 1e-3 {
                    continue;
                }
                let expected = is_full && is_stable(&closed, shape) && found > least;
                assert_eq!(contains(&set, &x), expected, "{transfer}, K = {x}: {} {found} {least}", requirement.text());
                seen[usize::from(expected)] += 1;
            }
        }
    }
    assert!(seen.iter().flatten().all(|count| *count > 40), "{seen:?}");
}

/// `K/(s + 1)` at `K = 0`, where `L` is zero: `|1 + L| = 1`, `|L/(1 + L)| = 0`, `2 |1 + L|/|1 - L| = 2`, and every turn, factor and dead time is
/// borne.
#[test]
fn a_gain_of_zero_meets_what_an_open_loop_meets() {
    let model = loop_with(CONTINUOUS, "K/(s + 1)");
    let problem = std::sync::Arc::new(model.ask().set("K", Rational::ZERO).problem().unwrap());
    for (name, value, is_met) in [
        ("modulus_margin", "1", true),
        ("modulus_margin", "1.001", false),
        ("complementary_peak", "1e-6", true),
        ("disk_margin", "2", true),
        ("disk_margin", "2.001", false),
        ("gain_margin", "60 dB", true),
        ("phase_margin", "175 deg", true),
        ("delay_margin", "100", true),
    ] {
        let asked = [requirement(&model, name, value)];
        let met =
            problem.requirements_met(&asked, None, &Budget::unlimited()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(met[0].met, is_met, "{name} {value}");
    }
    // Where no gain is left open, nothing comes back all the same.
    let open = load(&text_of(CONTINUOUS, "K/(s + 1)").replace("'r - y'", "'r'"));
    assert!(open.ask().margins(None, &Rational::ZERO, &Budget::unlimited()).is_err());
}

/// The factor of the box is looked for beyond `K = 0`.
#[test]
fn a_box_that_grows_to_a_gain_of_zero_has_its_requirement_decided() {
    let text = text_of(CONTINUOUS, "K/(s + 1)").replace("'50%'", "'10%'");
    for requirement in [["--complementary-peak", "0.5"], ["--modulus-margin", "0.5"], ["--phase-margin", "30 deg"]] {
        let run = jurist_with_input(&[&["tolerance", "-"][..], &requirement].concat(), text.as_bytes());
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{requirement:?}: {}", run.stdout);
    }
}

#[test]
fn mistakes_in_a_requirement_have_their_place_in_its_text() {
    let model = loop_with(CONTINUOUS, "K/(s + 1)");
    let said =
        |model: &Model, further: &[(&str, &str)]| match Requirements::of(model, further, &[], &Budget::unlimited())
            .unwrap_err()
        {
            Error::Refused(diagnostics) => render_error(&diagnostics, false),
            other => panic!("{other}"),
        };
    let unknown = said(&model, &[("disk_margin", " 2*abc")]);
    assert!(unknown.contains("E-unknown-name") && unknown.contains("disk_margin:1:3"), "{unknown}");
    let zero = said(&model, &[("phase_margin", "1/0 deg")]);
    assert!(zero.contains("phase_margin:1:3"), "{zero}");
    assert!(said(&model, &[("disk_margin", "6 dB")]).contains("disk_margin: a number is needed"));
    assert!(said(&model, &[("gain_margin", "6 V")]).contains("gain_margin: a number with its unit is needed"));
    assert!(said(&model, &[("disk_margin", "K")]).contains("without parameters that have no value"));
    let text = text_of(CONTINUOUS, "K/(s + 1)") + "[require]\ndisk_margin = '2*abc'\n";
    let line = text.lines().count();
    let written = said(&load(&text), &[]);
    assert!(written.contains(&format!("model.toml:{line}:")) && written.contains("2*abc"), "{written}");
}
