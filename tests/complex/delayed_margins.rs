//! Margins of complex loops with dead time: closed forms, machines seen from frames that turn, random loops against fine grids, and verdicts beside each margin.

use super::margins::Open;
use crate::helpers::model::read;
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::thorough;
use jurist::certified::certify_requirements;
use jurist::{Ask, Limits, Requirement, check};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::real::Real;
use jurist_engine::answer::Verdict;
use jurist_engine::error::Error;
use jurist_engine::response::{DelayMargin, Direction, Margins, PhaseMargin, Place, StableMargins};

type C = nalgebra::Complex<f64>;

/// A loop with a factor `K` and a further dead time `x`.
fn loop_of(transfer: &str) -> String {
    format!(
        "time = 'continuous'\n[parameters]\nK = 1\nx = 0\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\n\
         output = 'y'\ntransfer = 'K*exp(-x*s)*{transfer}'\n"
    )
}

fn margins(text: &str) -> Margins {
    let answer = read(text).ask().margins(None, &Rational::ZERO, &Budget::unlimited());
    answer.unwrap_or_else(|e| panic!("{e}\n{text}")).into_value()
}

fn stable(margins: &Margins) -> &StableMargins {
    margins.stable.as_ref().expect("a stable loop")
}

fn decimal(enclose: impl Fn(u64) -> Option<Enclosure>) -> String {
    enclose(100).unwrap().decimal(20).unwrap()
}

fn rate(margins: &Margins, place: &Place) -> f64 {
    let rate = margins.frequency(place, 60).unwrap().radians_per_second.unwrap();
    rate.lower().midpoint(rate.upper()).to_f64_approximate()
}

/// The least turns of a lag and of a lead in degrees, to twenty digits.
fn turns(margins: &Margins) -> [String; 2] {
    let both = stable(margins).one_sided.as_ref().unwrap();
    [&both.lag, &both.lead].map(|r| decimal(|bits| Some(r.as_ref().unwrap().degrees(bits))))
}

/// All that does not depend on where the frequency 0 is: gain margins, modulus, peak of `T`, disk.
fn without_frequencies(margins: &Margins) -> Vec<String> {
    let found = stable(margins);
    let ends = [&found.gain.upper, &found.gain.lower].map(|end| end.as_ref().map(|e| e.value.decimal(20)));
    let others = [&found.modulus, &found.peak_complementary, found.disk.alpha.as_ref().unwrap()];
    ends.into_iter().flatten().chain(others.map(|x| x.decimal(20))).collect()
}

/// `3/2 exp(-s/2)/(s - j)`: the modulus is one at `1 + 3/2` and `1 - 3/2`, the phase -90 degrees less that of the dead time above `j`, and 90 degrees
/// less it below.
#[test]
fn an_integrator_in_a_frame_by_hand() {
    let found = margins(&loop_of("3/2*exp(-s/2)/(s - j)"));
    assert_eq!(turns(&found), ["18.380275608647098904", "75.676055121729419781"]);
    // (pi - 1)/(3/2), (pi/2 - 5/4)/(5/2), and extremes by mpmath.
    let upper = stable(&found).gain.upper.as_ref().unwrap();
    assert_eq!(decimal(|bits| found.frequency_of(upper, bits)?.radians_per_second), "3.1415926535897932385");
    assert_eq!(decimal(|bits| found.delay_seconds(bits)), "0.12831853071795864769");
    let expected =
        ["1.4277284357265288256", "0", "0.22809615376459616837", "3.7221040514774594690", "0.24896439934489784345"];
    assert_eq!(without_frequencies(&found), expected);
    let places = [stable(&found).modulus_at.place(), stable(&found).complementary_at.place()];
    let places = places.map(|place| rate(&found, place.unwrap()));
    assert!((places[0] - 2.8009423206).abs() < 1e-9 && (places[1] - 2.7326222338).abs() < 1e-9, "{places:?}");
    // At the open loop's pole the factor is 0.
    let lower = stable(&found).gain.lower.as_ref().unwrap();
    assert_eq!((lower.causes.to_string(), lower.value.exact()), ("complex root".into(), Some(Rational::ZERO)));
    assert_eq!(decimal(|bits| found.frequency_of(lower, bits)?.radians_per_second), "1");
}

/// A real loop seen from a frame that turns: the same but for frequencies and the delay margin; peaks are at two frequencies at once.
#[test]
#[ignore = "long: CI runs it"]
fn margins_of_a_real_loop_seen_from_a_frame() {
    for (real, seen) in [
        ("3/2*exp(-s/2)/s", "3/2*exp(j/2)*exp(-s/2)/(s - j)"),
        ("(s + 2)*exp(-s/2)/s/(s + 1)", "(s + 2 + 2*j)*exp(-j)*exp(-s/2)/(s + 2*j)/(s + 1 + 2*j)"),
    ] {
        let (real, seen) = (margins(&loop_of(real)), margins(&loop_of(seen)));
        assert_eq!(without_frequencies(&real), without_frequencies(&seen));
        let degrees = decimal(|bits| stable(&real).phase.degrees(bits));
        assert_eq!(turns(&seen), [degrees.clone(), degrees.clone()]);
        assert_eq!(decimal(|bits| stable(&seen).phase.degrees(bits)), degrees);
        let count = |margins: &Margins| margins.crossings.gain.len();
        assert_eq!(count(&seen), 2 * count(&real));
    }
}

/// Nothing is left of the imaginary unit around the loop, and no dead time where it is 0.
#[test]
fn units_and_dead_times_that_are_not_there() {
    let printed = |text: &str| jurist_with_input(&["margins", "-", "--json"], text.as_bytes()).stdout;
    let real = loop_of("3/2*exp(-s/2)/s/(s + 1)");
    assert_eq!(printed(&real.replace("3/2*", "-j^2*3/2*")), printed(&real));
    let complex = loop_of("3/2/(s - j)/(s + 1)");
    assert_eq!(printed(&complex.replace("3/2/", "3/2*exp(-(1 - 1)*s)/")), printed(&complex));
}

#[test]
fn a_negated_unit_is_the_mirror_image() {
    let of = |unit: &str| margins(&loop_of(&format!("(2 + {unit}/3)*exp(-s/2)/(s - {unit})/(s + 2)")));
    let (own, mirrored) = (of("j"), of("(-j)"));
    let [lag, lead] = turns(&own);
    assert_eq!((without_frequencies(&own), [lead, lag]), (without_frequencies(&mirrored), turns(&mirrored)));
    let places = |margins: &Margins| {
        let gain = margins.crossings.gain.iter().map(|c| rate(margins, &c.place));
        gain.chain(margins.crossings.phase.iter().map(|c| rate(margins, &c.place))).collect::<Vec<f64>>()
    };
    let (mut own, mut other) = (places(&own), places(&mirrored).iter().map(|x| -x).collect::<Vec<f64>>());
    own.sort_by(f64::total_cmp);
    other.sort_by(f64::total_cmp);
    assert!(own.len() == other.len() && own.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-9));
}

#[test]
#[ignore = "long: CI runs it"]
fn singular_cases() {
    // The modulus only touches one, at j: L = exp(-j/2) = -exp(j (pi - 1/2)).
    let found = margins(&loop_of("exp(-s/2)/(s + 1 - j)"));
    assert_eq!(turns(&found), ["151.35211024345883956", "208.64788975654116044"]);
    let [touching] = &found.crossings.gain[..] else { panic!("{:?}", found.crossings) };
    assert_eq!((touching.direction, rate(&found, &touching.place)), (Direction::Touching, 1.0));
    assert_eq!(decimal(|bits| found.delay_seconds(bits)), "2.6415926535897932385");
    // It is nowhere one.
    let found = margins(&loop_of("(s - 2*j)*exp(-s/2)/(s - j + 2)/(s + 1)"));
    assert!(matches!(stable(&found).phase, PhaseMargin::Unbounded) && found.crossings.gain.is_empty());
    assert!(matches!(stable(&found).delay, DelayMargin::Unbounded));
    // It is one at the frequency 0, which dead time does not turn: L = 3/5 j + 4/5 j^2.
    let found = margins(&loop_of("(3 + 4*j)/5*exp(-s/2)/(s - j)"));
    assert_eq!(turns(&found)[1], "36.869897645844021297");
    assert!(rate(&found, &found.crossings.gain[0].place) == 0.0);
    // Of an unstable loop only crossings are listed.
    let found = margins(&loop_of("8*exp(-s/2)/(s - j)"));
    assert!(found.stable.is_none() && found.crossings.gain.len() == 2);
    // A pole at pi j: the phase is -90 degrees less omega/3, so it is real and negative at 3 pi/2 with the modulus 1/(2 pi).
    let found = margins(&loop_of("exp(-s/3)/(s - pi*j)/4"));
    let upper = stable(&found).gain.upper.as_ref().unwrap();
    assert_eq!(upper.value.decimal(12), "6.28318530718");
}

/// What enclosures do not tell ends: a pole where the open loop would be real, and an open loop of 1, half a turn from -1.
#[test]
fn coincidences_with_constants_end_by_precision() {
    for transfer in ["exp(-s/2)/(s - pi*j)/4", "j*exp(-s/2)/(s - pi*j + 1)"] {
        let answer = read(&loop_of(transfer)).ask().margins(None, &Rational::ZERO, &Budget::unlimited());
        let Err(Error::Stopped(stopped)) = answer else { panic!("{transfer}: {answer:?}") };
        assert!(stopped.stop.is_precision(), "{stopped:?}");
    }
}

/// The modulus goes to a limit: a quarter is far enough from one for a factor that is not stable to be found, and more is not.
#[test]
#[ignore = "long: CI runs it"]
fn open_loops_that_do_not_fall_to_zero() {
    let found = margins(&loop_of("j*(s + 1)*exp(-s/2)/(s - j + 2)/4"));
    let upper = stable(&found).gain.upper.as_ref().unwrap();
    let near = |more: &str| {
        let factor = upper.value.refined_to_digits(12).enclosure().0 + more.parse::<Rational>().unwrap();
        let model = read(&loop_of("j*(s + 1)*exp(-s/2)/(s - j + 2)/4"));
        model.ask().set("K", factor).verdict(&Budget::unlimited()).unwrap().value().verdict
    };
    assert_eq!([near("-1/1000000"), near("1/1000000")].map(|v| v == Verdict::Stable), [true, false]);
    let answer = read(&loop_of("(1 + j)*(s + 1)*exp(-s/2)/(s - j + 2)/4")).ask();
    let Err(Error::Refused(refused)) = answer.margins(None, &Rational::ZERO, &Budget::unlimited()) else {
        panic!("its greatest factor is found")
    };
    assert!(refused.to_string().contains("the greatest stable factor"), "{refused}");
}

/// An open loop with dead time, in a form that can be computed with.
struct Delayed {
    of: Open,
    tau: f64,
    text: String,
}

impl Delayed {
    fn random(random: &mut Random) -> Delayed {
        let of = Open::random(random, false);
        let (written, tau) = [("1/10", 0.1), ("1/2", 0.5), ("3/2", 1.5)][random.below(3)];
        let text = of.text(1).replace("K = 1\n", "K = 1\nx = 0\nphi = 0\n");
        let text = text.replace("'K*(", &format!("'K*exp(j*phi)*exp(-({written} + x)*s)*("));
        Delayed { of, tau, text }
    }

    fn at(&self, omega: f64) -> C {
        self.of.at(omega) * C::from_polar(1.0, -omega * self.tau)
    }

    fn is_stable(&self, name: &str, value: Rational) -> bool {
        let verdict = read(&self.text).ask().set(name, value).verdict(&Budget::unlimited());
        verdict.unwrap_or_else(|e| panic!("{e}\n{}", self.text)).into_value().verdict == Verdict::Stable
    }

    /// Stable on one side of a value, and not on the other one.
    fn check_limit(&self, name: &str, value: &Enclosure, sign: i64, is_upper: bool) {
        let near: Rational = "1/1000000".parse().unwrap();
        let middle = value.lower().midpoint(value.upper());
        let [less, more] = [&middle - &near, &middle + &near].map(|x| x * Rational::from(sign));
        let found = [self.is_stable(name, less), self.is_stable(name, more)];
        assert_eq!(found, [is_upper, !is_upper], "{name} at {middle} of {}", self.text);
    }

    /// A frequency beyond which the open loop is small, and a grid up to it.
    fn grid(&self) -> Vec<f64> {
        const POINTS: i32 = 20_000;
        let end = (0..)
            .map(|k| 2f64.powi(k))
            .find(|w| [1.0, 2.0, 4.0].iter().all(|f| self.at(w * f).norm() < 0.02 && self.at(-w * f).norm() < 0.02));
        let end = end.unwrap();
        let even = (-POINTS..=POINTS).map(|k| end * f64::from(k) / f64::from(POINTS));
        let near = (1..2000).flat_map(|k| [1.0, -1.0].map(|sign| sign * end * 0.99f64.powi(k)));
        let mut all: Vec<f64> = even.chain(near).filter(|w| self.at(*w).is_finite()).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

fn value(x: &Real) -> f64 {
    let (lo, hi) = x.refined_to_digits(17).enclosure();
    lo.midpoint(&hi).to_f64_approximate()
}

fn check_extremes(of: &Delayed, found: &StableMargins) {
    let grid = of.grid();
    let extreme = |f: &dyn Fn(C) -> f64| grid.iter().map(|w| f(of.at(*w))).fold(0.0, f64::max);
    for (found, of_grid) in [
        (value(&found.peak_sensitivity), extreme(&|l| 1.0 / (l + 1.0).norm())),
        (value(&found.peak_complementary), extreme(&|l| (l / (l + 1.0)).norm())),
        (1.0 / value(found.disk.alpha.as_ref().unwrap()), extreme(&|l| (0.5 - 1.0 / (l + 1.0)).norm())),
    ] {
        let missed = 1e-3 * (1.0 + found * found);
        assert!(
            of_grid <= found * (1.0 + 1e-9) && of_grid >= found * (1.0 - missed),
            "{found} {of_grid} of {}",
            of.text
        );
    }
}

/// Crossings that a grid sees are listed, and the least turns and delays are theirs.
fn check_crossings(of: &Delayed, found: &Margins) {
    let grid = of.grid();
    let pairs = || grid.iter().zip(&grid[1..]).map(|(a, b)| [of.at(*a), of.at(*b)]);
    let changes = pairs().filter(|[a, b]| (a.norm() > 1.0) != (b.norm() > 1.0)).count();
    let gain = &found.crossings.gain;
    assert_eq!(changes, gain.iter().filter(|c| c.direction != Direction::Touching).count(), "{}", of.text);
    let is_negative = |[a, b]: &[C; 2]| a.re < 0.0 && b.re < 0.0 && (a.im > 0.0) != (b.im > 0.0);
    let listed = pairs().filter(is_negative).filter(|[a, _]| (0.03..20.0).contains(&a.norm())).count();
    let factor = |c: &jurist_engine::response::PhaseCrossing| c.factor.enclosure(60).lower().to_f64_approximate();
    let known = found.crossings.phase.iter().filter(|c| (0.05..1.0 / 0.03).contains(&factor(c))).count();
    assert!(listed.abs_diff(known) <= 1, "{listed} {known} of {}", of.text);
    for c in &found.crossings.phase {
        let product = of.at(rate(found, &c.place)) * factor(c);
        assert!((product + 1.0).norm() < 1e-6, "{product} of {}", of.text);
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn margins_of_random_loops_agree_with_grids_and_verdicts() {
    let count = std::env::var("JURIST_COMPLEX_LOOPS").ok().and_then(|n| n.parse().ok());
    let count = count.unwrap_or(thorough::count(2, 8));
    let (mut checked, mut below, mut random) = (0, 0, Random::new(1958));
    while checked < count {
        let of = Delayed::random(&mut random);
        if of.of.n.iter().all(|c| *c == [0, 0]) || !of.is_stable("K", Rational::ONE) {
            continue;
        }
        checked += 1;
        let found = margins(&of.text);
        let own = stable(&found);
        check_extremes(&of, own);
        check_crossings(&of, &found);
        for (end, is_upper) in [(&own.gain.upper, true), (&own.gain.lower, false)] {
            let Some(end) = end else { continue };
            let (lo, hi) = end.value.refined_to_digits(12).enclosure();
            of.check_limit("K", &Enclosure::new(lo, hi), 1, is_upper);
        }
        let turn = Enclosure::pi(60).div(&Enclosure::from_rational(180.into()), 60).unwrap();
        if let Some(both) = &own.one_sided.as_ref().filter(|both| both.lag.is_some()) {
            for (rotation, sign) in [(&both.lag, -1), (&both.lead, 1)] {
                let degrees = rotation.as_ref().unwrap().degrees(60);
                of.check_limit("phi", &degrees.mul(&turn, 60), sign, true);
            }
        }
        if let Some(delay) = found.delay_seconds(60) {
            of.check_limit("x", &delay, 1, true);
            let DelayMargin::DeadTime(i) = own.delay else { panic!("{:?}", own.delay) };
            below += usize::from(rate(&found, &found.crossings.gain[i].place) < 0.0);
        }
    }
    assert!(count < 8 || below > 0, "{below} delay margins at negative frequencies");
}

/// The peak gain of the closed loop, whose denominator has the dead time, and that of the sensitivity's other way.
#[test]
fn norms_are_peaks_of_the_loop() {
    let text = loop_of("(2 + j/3)*exp(-s/2)/(s - j)/(s + 2)");
    let norm = read(&text).ask().norm("r", "y", &Budget::unlimited()).unwrap().into_value();
    let peak = norm.peak.as_ref().unwrap();
    let found = margins(&text);
    assert_eq!(peak.value.decimal(20), stable(&found).peak_complementary.decimal(20));
    let [own, other] = [norm.frequency(60), found.frequency(stable(&found).complementary_at.place().unwrap(), 60)];
    assert_eq!(
        own.unwrap().radians_per_second.unwrap().decimal(9),
        other.unwrap().radians_per_second.unwrap().decimal(9)
    );
    // The mirrored loop has it at the opposite frequency.
    let mirrored =
        read(&text.replace('j', "(-j)").replace("(-j)urist", "jurist")).ask().norm("r", "y", &Budget::unlimited());
    let mirrored = mirrored.unwrap().into_value();
    assert_eq!(mirrored.peak.as_ref().unwrap().value.decimal(20), peak.value.decimal(20));
    let sum =
        [&norm, &mirrored].map(|n| n.frequency(60).unwrap().radians_per_second.unwrap().lower().to_f64_approximate());
    assert!((sum[0] + sum[1]).abs() < 1e-9, "{sum:?}");
}

/// Two dead times in the denominator: no peak of a fine grid is above the norm, and the nearest is close to it.
#[test]
fn a_norm_with_two_dead_times_is_that_of_a_grid() {
    let text = "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - v'\noutput = 'y'\n\
                transfer = '(1 + j)*exp(-s/2)/(s + 1 - j)'\n[[block]]\ninput = 'y'\noutput = 'v'\n\
                transfer = 'exp(-s/4)/2 + exp(-s/2)*j/4'\n";
    let norm = read(text).ask().norm("r", "y", &Budget::unlimited()).unwrap().into_value();
    let peak = value(&norm.peak.as_ref().unwrap().value);
    let gain = |omega: f64| {
        let s = C::new(0.0, omega);
        let open = C::new(1.0, 1.0) * (-s / 2.0).exp() / (s + 1.0 - C::i());
        let back = (-s / 4.0).exp() / 2.0 + (-s / 2.0).exp() * C::i() / 4.0;
        (open / (open * back + 1.0)).norm()
    };
    let greatest = (-40_000..=40_000).map(|k| gain(f64::from(k) / 1000.0)).fold(0.0, f64::max);
    assert!(greatest <= peak * (1.0 + 1e-9) && greatest > peak * (1.0 - 1e-6), "{greatest} {peak}");
    let place = norm.frequency(60).unwrap().radians_per_second.unwrap().lower().to_f64_approximate();
    assert!((gain(place) - peak).abs() < 1e-9, "{place}");
}

/// A curve of both signs has the values of the open loop.
#[test]
fn responses_at_frequencies_of_both_signs() {
    let text = loop_of("(2 + j/3)*exp(-s/2)/(s - j)/(s + 2)");
    let run = jurist_with_input(&["nyquist", "-", "--json"], text.as_bytes());
    let document: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    let list = |key: &str| document[key].as_array().unwrap().clone();
    let number = |x: &serde_json::Value| x.as_f64().unwrap();
    let (frequency, response) = (list("frequency"), list("response"));
    let frequency: Vec<f64> = frequency.iter().map(number).collect();
    assert!(frequency[0] < -0.5 && *frequency.last().unwrap() > 0.5 && frequency.len() > 1000);
    for (f, value) in frequency.iter().zip(response) {
        let [re, im] = [&value[0], &value[1]].map(number);
        let s = C::new(0.0, 2.0 * std::f64::consts::PI * f);
        let expected = C::new(2.0, 1.0 / 3.0) * (-s / 2.0).exp() / (s - C::i()) / (s + 2.0);
        assert!((C::new(re, im) - expected).norm() < 1e-9 * (1.0 + expected.norm()), "{f}: {re} {im} {expected}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn requirements_at_a_point() {
    let text = loop_of("3/2*exp(-s/2)/(s - j)");
    let asked = |option: &str, number: &str| {
        let run = jurist_with_input(&["verdict", "-", option, number], text.as_bytes());
        let is_met = run.stdout.contains(": met");
        assert!(is_met != run.stdout.contains(": not met"), "{}{}", run.stdout, run.stderr);
        is_met
    };
    for (option, met, unmet) in [
        ("--modulus-margin", "0.22809", "0.2281"),
        ("--phase-margin", "15", "20"),
        ("--gain-margin", "1.4277", "1.4278"),
        ("--delay-margin", "0.1283", "0.1284"),
        ("--disk-margin", "0.24896", "0.24897"),
    ]
    .into_iter()
    .step_by(if thorough::is_thorough() { 1 } else { 2 })
    {
        assert!(asked(option, met) && !asked(option, unmet), "{option}");
    }
}

/// The checkers count roots for all turns, factors or dead times at the cut: another way to the same margins.
#[test]
#[ignore = "long: CI runs it"]
fn margins_are_certified() {
    let (text, budget) = (loop_of("3/2*exp(-s/2)/(s - j)"), Budget::unlimited());
    let problem = read(&text).ask().set("K", 1).set("x", 0).problem().unwrap();
    let number = |x: &str| x.parse::<Rational>().unwrap();
    for (requirement, met) in [
        (Requirement::phase_margin(&number("15")), true),
        (Requirement::phase_margin(&number("20")), false),
        (Requirement::delay_margin(number("1/8")), true),
        (Requirement::modulus_margin(number("1/4")), false),
    ]
    .into_iter()
    .step_by(if thorough::is_thorough() { 1 } else { 3 })
    {
        let one = [requirement.unwrap()];
        assert_eq!(problem.requirements_met(&one, None, &budget).unwrap()[0].met, met);
        let certificate = certify_requirements(&problem, &one, None, met, &budget).unwrap();
        check(&text, &certificate, &Limits::default()).unwrap();
        assert!(certify_requirements(&problem, &one, None, !met, &budget).is_err());
    }
}
