//! Gains of complex loops with dead time, in domains with ends and without: closed forms, real loops seen from frames that turn, and random loops against counts of
//! roots in floating point.

use crate::helpers::model::read;
use crate::helpers::random::Random;
use crate::helpers::thorough;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::stability::{End, Side, StableSet};

type C = nalgebra::Complex<f64>;

fn text(parameter: &str, characteristic: &str) -> String {
    format!("time = 'continuous'\n[parameters]\nK = {{ {parameter} }}\n[loop]\ncharacteristic = '{characteristic}'\n")
}

fn set(parameter: &str, characteristic: &str) -> StableSet {
    let text = text(parameter, characteristic);
    let answer = read(&text).ask().free("K").stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert!(answer.value().undecided().is_empty(), "{text}");
    answer.into_value()
}

/// The ends of all intervals with their causes.
fn ends(set: &StableSet) -> Vec<String> {
    let written = |end: &Option<End>| match end {
        Some(end) => format!("{} {}", end.value.decimal(16), end.causes),
        None => "none".to_owned(),
    };
    set.intervals().iter().flat_map(|i| [written(&i.lower), written(&i.upper)]).collect()
}

fn rate(end: &Option<End>) -> f64 {
    let rate = end.as_ref().unwrap().pair.as_ref().unwrap().angular_frequency(60).unwrap();
    rate.lower().midpoint(rate.upper()).to_f64_approximate()
}

const ANY: &str = "nominal = 1";

/// Of `s - j + K exp(-s/2)` a root is at `j omega` with `K = (omega - 1) sin(omega/2)` where the cosine of `omega/2` is 0, and at the pole with `K = 0`.
#[test]
fn an_integrator_in_a_frame_by_hand() {
    let found = set(ANY, "s - j + K*exp(-s/2)");
    let expected = ["0 complex root", "2.141592653589793 complex root"];
    assert_eq!(ends(&found), expected);
    assert_eq!(rate(&found.intervals()[0].lower), 1.0);
    assert!((rate(&found.intervals()[0].upper) - std::f64::consts::PI).abs() < 1e-15);
    // In other units of the gain, and with its other sign.
    for (unit, upper) in [("1000000000", "2.141592653589793e-9"), ("1/1000000000", "2141592653.589793")] {
        let found = set(ANY, &format!("s - j + K*{unit}*exp(-s/2)"));
        assert_eq!(found.intervals()[0].upper.as_ref().unwrap().value.decimal(16), upper);
    }
    let negative = ["-2.141592653589793 complex root", "0 complex root"];
    assert_eq!(ends(&set("nominal = -1", "s - j - K*exp(-s/2)")), negative);
    // The mirrored loop has its roots on the other side.
    let mirrored = set(ANY, "s + j + K*exp(-s/2)");
    assert_eq!(ends(&mirrored), expected);
    let side = |set: &StableSet| set.intervals()[0].upper.as_ref().unwrap().pair.as_ref().unwrap().side();
    assert_eq!([side(&found), side(&mirrored)], [Side::Upper, Side::Lower]);
    // With a gain that is turned by a quarter K = (1 - omega) cos(omega/2) where the sine is 0.
    assert_eq!(ends(&set(ANY, "s - j + j*K*exp(-s/2)")), ["0 complex root", "1 s=0"]);
    // No gain keeps the root of a factor without gain on the left.
    assert_eq!(ends(&set(ANY, "(s - j)*(s - j + K*exp(-s/2))")), Vec::<String>::new());
}

/// The domain ends before a crossing, at one, and after it.
#[test]
fn ends_of_domains() {
    let within = |domain: &str| ends(&set(domain, "s - j + j*K*exp(-s/2)"));
    assert_eq!(within("nominal = 0.4, min = 0.25, max = 0.5"), ["0.25 domain", "0.5 domain"]);
    assert_eq!(within("nominal = 0.5, min = 0, max = 1"), ["0 complex root+domain", "1 s=0+domain"]);
    assert_eq!(within("nominal = 1, min = 0.5"), ["0.5 domain", "1 s=0"]);
    assert_eq!(within("nominal = 0, max = 0.5"), ["0 complex root", "0.5 domain"]);
    assert_eq!(within("nominal = 2, min = 1"), Vec::<String>::new());
    assert_eq!(within("nominal = -2, max = -1"), Vec::<String>::new());
    // A pole of the model is where nothing is defined.
    let found = set("nominal = 1", "s - j + j*K*exp(-s/2) + (K - K)/(2*K - 1)");
    assert_eq!(ends(&found), ["0 complex root", "0.5 pole", "0.5 pole", "1 s=0"]);
}

/// Roots of either sign cross at one gain: the set is that of the real loop, but for the frequencies.
#[test]
#[ignore = "long: CI runs it"]
fn real_loops_seen_from_frames() {
    for (real, seen) in [
        ("s + K*exp(-s/2)", "s - 2*j + K*exp(j)*exp(-s/2)"),
        ("s*(s + 1) + K*(s + 2)*exp(-s/2)", "(s + 2*j)*(s + 1 + 2*j) + K*(s + 2 + 2*j)*exp(-j)*exp(-s/2)"),
        // Stable in two intervals: the open loop is not.
        ("(s - 1/2)*(s + 3) + K*exp(-s/4)", "(s - 1/2 - j)*(s + 3 - j) + K*exp(j/4)*exp(-s/4)"),
        ("(s^2 + 1)*(s + 1) - K*exp(-s)", "((s - 3*j)^2 + 1)*(s + 1 - 3*j) - K*exp(3*j)*exp(-s)"),
        // One controller gain of two, with the dead time beside the other one.
        ("s*(s + 1) + (K*s + 1)*exp(-s/2)", "(s - j)*(s + 1 - j) + (K*(s - j) + 1)*exp(j/2)*exp(-s/2)"),
    ] {
        let [real, seen] = [real, seen].map(|characteristic| set(ANY, characteristic));
        // A number that is rational has no more digits.
        let short = |end: &String| {
            end.split(' ')
                .next()
                .unwrap()
                .trim_end_matches(".000000000000000")
                .trim_end_matches("00000000000000")
                .to_owned()
        };
        let values = |set: &StableSet| ends(set).iter().map(short).collect();
        let [real, seen]: [Vec<String>; 2] = [values(&real), values(&seen)];
        assert_eq!(real, seen);
    }
}

/// A coefficient of a power of `s`, or of one of them times the gain, in eighths.
type Coefficients = Vec<[i64; 2]>;

/// `s^n + A(s) + B(s) exp(-2 tau s) + K N(s) exp(-tau s)`.
#[derive(Debug)]
struct Loop {
    parts: [Coefficients; 3],
    tau: i64,
}

impl Loop {
    fn random(random: &mut Random) -> Loop {
        let order = 1 + random.below(3);
        let mut part = |most: i64, shift: i64, count: usize| -> Coefficients {
            let mut one = || random.below(2 * most as usize + 1) as i64 - most;
            (0..count).map(|_| [one() + shift, one()]).collect()
        };
        let beside = part(1, 0, 1)[0][0].max(0) as usize;
        let parts = [part(8, 8, order), part(6, 0, beside), part(12, 0, order)];
        Loop { parts, tau: 1 + random.below(6) as i64 }
    }

    fn text(&self) -> String {
        let written = |p: &Coefficients| {
            let terms = p.iter().enumerate().map(|(k, c)| format!("({} + {}*j)/8*s^{k}", c[0], c[1]));
            terms.chain(["0".to_owned()]).collect::<Vec<_>>().join(" + ")
        };
        let ([a, b, n], tau) = (self.parts.each_ref().map(written), self.tau);
        let order = self.parts[0].len();
        format!("s^{order} + {a} + ({b})*exp(-{tau}*s/2) + K*({n})*exp(-{tau}*s/4)")
    }

    fn at(&self, s: C, k: f64) -> C {
        let value = |p: &Coefficients| {
            p.iter().rev().fold(C::default(), |sum, c| sum * s + C::new(c[0] as f64, c[1] as f64) / 8.0)
        };
        let [a, b, n] = self.parts.each_ref().map(value);
        let z = (-s * self.tau as f64 / 4.0).exp();
        s.powi(self.parts[0].len() as i32) + a + b * z * z + n * z * k
    }

    /// The roots right of the axis, by the turns of the function along it.
    fn right(&self, k: f64) -> i64 {
        let (order, end) = (self.parts[0].len() as f64, 100.0 * (4.0 + k.abs()));
        let at = |omega: f64| self.at(C::new(0.0, omega), k);
        // Halved until the argument turns little.
        fn turned(at: &dyn Fn(f64) -> C, from: f64, to: f64) -> f64 {
            let turn = (at(to) / at(from)).arg();
            let middle = (from + to) / 2.0;
            if to - from < 1e-9 || (to - from < 0.05 + middle.abs() / 20.0 && turn.abs() < 0.2) {
                return turn;
            }
            turned(at, from, middle) + turned(at, middle, to)
        }
        let pieces = 64;
        let place = |i: i32| end * f64::from(i) / f64::from(pieces);
        let turn: f64 = (-pieces..pieces).map(|i| turned(&at, place(i), place(i + 1))).sum();
        ((order * std::f64::consts::PI - turn) / (2.0 * std::f64::consts::PI)).round() as i64
    }
}

fn value(end: &End) -> f64 {
    let (lo, hi) = end.value.refined_to_digits(17).enclosure();
    lo.midpoint(&hi).to_f64_approximate()
}

/// Inside of the intervals and outside, near the ends and in the middle, the argument's turns tell the same.
#[test]
#[ignore = "long: CI runs it"]
fn random_loops_agree_with_turns_of_the_argument() {
    let count = std::env::var("JURIST_COMPLEX_LOOPS").ok().and_then(|n| n.parse().ok());
    let count = count.unwrap_or(thorough::count(5, 40));
    let (mut random, mut checked, mut ends_checked) = (Random::new(1968), 0, 0);
    while checked < count {
        let own = Loop::random(&mut random);
        if own.parts[2].iter().all(|c| *c == [0, 0]) {
            continue;
        }
        checked += 1;
        let found = set(ANY, &own.text());
        let ends = found.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
        let mut places = vec![-40.0];
        for end in ends.map(value).chain([40.0]) {
            let last = *places.last().unwrap();
            let near = 1e-3 * (1.0 + end.abs());
            places.extend([last / 2.0 + end / 2.0, end - near, end + near]);
            ends_checked += 1;
        }
        for k in places {
            let inside = found.intervals().iter().filter(|i| value(i.lower.as_ref().unwrap()) < k);
            let is_inside = inside.last().is_some_and(|i| k < value(i.upper.as_ref().unwrap()));
            assert_eq!(own.right(k) == 0, is_inside, "{k} of {}: {:?}", own.text(), self::ends(&found));
        }
    }
    assert!(ends_checked > 2 * count, "{ends_checked} ends");
}
