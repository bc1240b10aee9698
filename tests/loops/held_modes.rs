//! Loops of order 7 and more with several lightly damped modes behind a hold, against a grid of frequencies in floating point: the plant as a chain
//! of its factors, one matrix exponential, and eigenvalues.

use crate::helpers::model::load;
use crate::helpers::open_loops::{margins_of, stable};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::parse_number;
use jurist_engine::response::Requirement;
use jurist_show::real;
use nalgebra::{Complex, DMatrix, DVector};

const SAMPLE_TIME: f64 = 0.01;

/// A plant with unit gain at rest, of a pole and modes, each with its frequency and damping, and whether the controller integrates.
struct Loop {
    pole: f64,
    modes: Vec<[f64; 2]>,
    integrates: bool,
}

impl Loop {
    fn text(&self, gain: f64) -> String {
        let mut plant = format!("{0}/(s + {0})", self.pole);
        for [w, zeta] in &self.modes {
            plant += &format!("*{1}/(s^2 + {0}*s + {1})", 2.0 * zeta * w, w * w);
        }
        let controller = if self.integrates { "K*(z - 0.95)/(z - 1)" } else { "K" };
        format!(
            "time = 'discrete'\nsample_time = '{SAMPLE_TIME}'\n[parameters]\nK = {{ nominal = {gain}, min = 0 }}\n[loop]\ninputs = ['r']\n\
             outputs = ['y']\n[[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ntransfer = '{controller}'\n\
             [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\ndiscretize = 'zoh'\n"
        )
    }

    /// The open loop at `K = 1` in state space.
    fn open_loop(&self) -> (DMatrix<f64>, DVector<f64>, DVector<f64>) {
        let n = 1 + 2 * self.modes.len();
        // The last row and column are those of the input that is held.
        let mut a = DMatrix::zeros(n + 1, n + 1);
        (a[(0, 0)], a[(0, n)]) = (-self.pole, self.pole);
        let mut before = 0;
        for (k, [w, zeta]) in self.modes.iter().enumerate() {
            let at = 1 + 2 * k;
            a[(at, at + 1)] = 1.0;
            (a[(at + 1, at)], a[(at + 1, at + 1)], a[(at + 1, before)]) = (-w * w, -2.0 * zeta * w, w * w);
            before = at;
        }
        let held = (a * SAMPLE_TIME).exp();
        let (plant, input) = (held.view((0, 0), (n, n)), held.view((0, n), (n, 1)));
        let order = n + usize::from(self.integrates);
        let (mut a, mut b, mut c) = (DMatrix::zeros(order, order), DVector::zeros(order), DVector::zeros(order));
        a.view_mut((0, 0), (n, n)).copy_from(&plant);
        b.rows_mut(0, n).copy_from(&input);
        if self.integrates {
            // (z - 0.95)/(z - 1) = 1 + 0.05/(z - 1)
            a.view_mut((0, n), (n, 1)).copy_from(&(input * 0.05));
            (a[(n, n)], b[n]) = (1.0, 1.0);
        }
        c[before] = 1.0;
        (a, b, c)
    }
}

/// The largest modulus of a root with a gain.
fn radius((a, b, c): &(DMatrix<f64>, DVector<f64>, DVector<f64>), gain: f64) -> f64 {
    (a - b * c.transpose() * gain).complex_eigenvalues().iter().map(|x| x.norm()).fold(0.0, f64::max)
}

/// The open loop at an angle per sample.
fn response((a, b, c): &(DMatrix<f64>, DVector<f64>, DVector<f64>), angle: f64) -> Complex<f64> {
    let z = DMatrix::from_diagonal_element(a.nrows(), a.nrows(), Complex::from_polar(1.0, angle));
    let complex = |m: &DMatrix<f64>| m.map(|x| Complex::new(x, 0.0));
    let states = (z - complex(a)).lu().solve(&b.map(|x| Complex::new(x, 0.0))).expect("no pole there");
    c.map(|x| Complex::new(x, 0.0)).dot(&states)
}

/// The least gain at which the loop is not stable.
fn limit(system: &(DMatrix<f64>, DVector<f64>, DVector<f64>)) -> f64 {
    let (mut low, mut high) = (0.0, 1e-3);
    while radius(system, high) < 1.0 {
        (low, high) = (high, high * 1.05);
    }
    for _ in 0..50 {
        let middle = (low + high) / 2.0;
        if radius(system, middle) < 1.0 { low = middle } else { high = middle }
    }
    high
}

/// Angles from low ones up, many near to those of the poles.
fn angles(system: &(DMatrix<f64>, DVector<f64>, DVector<f64>)) -> Vec<f64> {
    let mut all: Vec<f64> =
        (0..1500).map(|k| 1e-4 * (std::f64::consts::PI * 1e4).powf(f64::from(k) / 1500.0)).collect();
    for pole in system.0.complex_eigenvalues().iter().filter(|pole| pole.im > 0.0) {
        let width = 1.0 - pole.norm();
        all.extend((-200..=200).map(|k| pole.arg() + width * f64::from(k) / 40.0).filter(|x| (1e-4..3.13).contains(x)));
    }
    all
}

fn close(found: f64, known: f64, by: f64) -> bool {
    (found - known).abs() <= by * known.abs()
}

/// The margins at a part of the limit, and the gains with a modulus margin of a half.
fn agrees(of: &Loop, share: f64) {
    let system = of.open_loop();
    let limit = limit(&system);
    let gain = (limit * share * 1e6).round() / 1e6;
    let model = load(&of.text(gain));
    let answer = margins_of(&model, None);
    let margins = stable(&answer);
    let number = |x: &jurist_algebra::real::Real| x.decimal(12).parse::<f64>().unwrap();
    let upper = number(&margins.gain.upper.as_ref().expect("a limit").value);
    assert!(close(upper, limit / gain, 1e-6), "{upper} {}", limit / gain);
    let angles = angles(&system);
    let loops: Vec<Complex<f64>> = angles.iter().map(|x| response(&system, *x)).collect();
    let least = |gain: f64| loops.iter().map(|l| (l * gain + 1.0).norm()).fold(f64::INFINITY, f64::min);
    let modulus = number(&margins.modulus);
    assert!(close(modulus, least(gain).min(1.0), 2e-3), "{modulus} {}", least(gain));
    // At each crossing the modulus is one, and the least angle to -1 is the margin.
    let mut angle = f64::INFINITY;
    for crossing in &answer.value().crossings.gain {
        let at = answer.value().frequency(&crossing.place, 60).and_then(|f| f.angle).unwrap();
        let at: f64 = at.decimal(12).unwrap().parse().unwrap();
        let there = response(&system, at) * gain;
        assert!(close(there.norm(), 1.0, 1e-5), "{there}");
        angle = angle.min((-there).arg().abs().to_degrees());
    }
    let is_above = |l: &&Complex<f64>| (**l * gain).norm() > 1.0;
    let has_passed = loops.iter().take(1500).filter(is_above).count();
    assert!(has_passed == 0 || angle.is_finite(), "a crossing is missing");
    match real::enclosed(12, |bits| margins.phase.degrees(bits)) {
        Some(degrees) => assert!(close(degrees.parse().unwrap(), angle, 1e-5), "{degrees} {angle}"),
        None => assert!(answer.value().crossings.gain.is_empty()),
    }
    let half = Requirement::modulus_margin(parse_number("0.5").unwrap()).unwrap();
    let problem = model.ask().free("K").problem().unwrap();
    let set = problem.required_set(&[half], None, &Budget::unlimited()).unwrap().into_value();
    assert!(set.undecided.is_empty());
    for k in 1..40 {
        let gain = limit * f64::from(k) / 40.0;
        let value = parse_number(&format!("{gain:.12}")).unwrap();
        let is_in = set.intervals.iter().any(|interval| interval.contains(&value));
        let distance = least(gain);
        assert!((distance - 0.5).abs() < 2e-3 || is_in == (distance > 0.5), "{gain} {distance}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn loops_with_several_modes_behind_a_hold_agree_with_a_grid_of_frequencies() {
    let integrating = Loop { pole: 4.0, modes: vec![[12.0, 0.03], [63.0, 0.1], [170.0, 0.05]], integrates: true };
    agrees(&integrating, 0.4);
    let without = Loop { pole: 9.0, modes: vec![[23.0, 0.15], [40.0, 0.02], [230.0, 0.07]], integrates: false };
    agrees(&without, 0.7);
}

/// The least damping of a root with a gain.
fn damping((a, b, c): &(DMatrix<f64>, DVector<f64>, DVector<f64>), gain: f64) -> f64 {
    let roots = (a - b * c.transpose() * gain).complex_eigenvalues();
    roots.iter().map(|z| -z.ln().re / z.ln().norm()).fold(f64::INFINITY, f64::min)
}

/// Work of the answer: more is no answer in a second.
const WORK: u64 = 2_000_000_000;

/// The coefficients are enclosed in a gain: expanded ones have thousands of terms.
#[test]
#[ignore = "long: CI runs it"]
fn the_gains_with_a_damping_of_loops_of_order_8_are_those_of_the_eigenvalues() {
    let integrating = Loop { pole: 4.0, modes: vec![[12.0, 0.3], [63.0, 0.1], [170.0, 0.05]], integrates: true };
    let without = Loop { pole: 9.0, modes: vec![[23.0, 0.15], [40.0, 0.02], [230.0, 0.07]], integrates: false };
    for (of, least) in [(integrating, "0.04"), (without, "0.01")] {
        let system = of.open_loop();
        let limit = limit(&system);
        let model = load(&of.text(1.0));
        let required = Requirement::damping(parse_number(least).unwrap()).unwrap();
        let problem = model.ask().free("K").problem().unwrap();
        let budget = Budget::unlimited().within_work(WORK);
        let set = problem.required_set(&[required], None, &budget).unwrap().into_value();
        assert!(set.undecided.is_empty() && !set.intervals.is_empty(), "{set:?}");
        let least: f64 = least.parse().unwrap();
        for k in 1..40 {
            let gain = limit * f64::from(k) / 40.0;
            let value = parse_number(&format!("{gain:.12}")).unwrap();
            let is_in = set.intervals.iter().any(|interval| interval.contains(&value));
            let found = damping(&system, gain);
            assert!((found - least).abs() < 1e-6 || is_in == (found > least), "{gain} {found}");
        }
    }
}
