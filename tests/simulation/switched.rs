//! The switched circuit: steady state, linearisation, limits, and the averaged model as T goes to 0.

use crate::helpers::budget::{cancelled_after, spent};
use crate::helpers::drive::{E_SW, K_A, L_A, names, sampled_drive, switched_drive};
use crate::helpers::thorough::is_tried;
use jurist_draw::simulate::{Excitation, Pulse, Record, Step, SwitchedModel, SwitchedState, eigenvalues, growth_limit};
use nalgebra::{DMatrix, DVector};

fn inputs() -> DVector<f64> {
    DVector::from_vec(vec![80.0, 0.0])
}

fn reference_step() -> Excitation {
    Excitation { initial: vec![], steps: vec![Step { sample: 0, input: 0, value: 80.0 }] }
}

/// The largest magnitude of an eigenvalue of the linearised map.
fn magnitude(k_pwm: f64, t: f64, pulse: Pulse) -> Option<f64> {
    Some(switched_drive(k_pwm, t, pulse).small_signal_eigenvalues(&inputs())?[0].norm())
}

fn four_digits(found: f64, expected: f64) -> bool {
    (found - expected).abs() < 5e-5 * expected
}

#[test]
fn the_steady_state_repeats_itself_at_the_reference_speed() {
    for pulse in [Pulse::Beginning, Pulse::End, Pulse::Centre, Pulse::Ends] {
        let drive = switched_drive(110.0, 1e-4, pulse);
        let operating = drive.periodic_steady_state(&inputs()).unwrap();
        assert!(operating.residual < 1e-11);
        let average = drive.period_average(&operating.state, &inputs());
        // The speed is sampled at the period's beginning, its ripple is tiny; the back EMF and the
        // resistive drop (friction 0.64 Nm) ask for this duty ratio.
        assert!((operating.state.plant[1] - 80.0).abs() < 1e-6);
        let current = 0.008 * 80.0 / K_A;
        assert!((average[0] - current).abs() < 1e-6, "{}", average[0]);
        assert!((operating.duty[0] - (K_A * 80.0 + current) / 110.0).abs() < 1e-6);
    }
}

#[test]
fn a_voltage_below_the_back_emf_has_no_unclamped_steady_state() {
    assert!(switched_drive(40.0, 1e-4, Pulse::Beginning).periodic_steady_state(&inputs()).is_none());
}

#[test]
fn the_linearised_map_is_the_derivative() {
    for pulse in [Pulse::Beginning, Pulse::End, Pulse::Centre, Pulse::Ends] {
        let drive = switched_drive(300.0, 3e-4, pulse);
        let state = drive.periodic_steady_state(&inputs()).unwrap().state;
        let base = state.stacked();
        let map = drive.linearised(&state, &inputs());
        for j in 0..base.len() {
            let h = 1e-5;
            let shifted = |s: f64| {
                let mut z = base.clone();
                z[j] += s;
                drive.next_period(&SwitchedState::unstacked(&z, 2), &inputs()).stacked()
            };
            let slope = (shifted(h) - shifted(-h)) / (2.0 * h);
            assert!((slope - map.column(j)).norm() < 1e-6 * map.column(j).norm().max(1.0), "{pulse:?} {j}");
        }
    }
}

#[test]
fn limits_of_the_linearised_circuit() {
    // Independently: Newton's method and eigenvalues of the period map with 40 digits, its
    // derivative by differences (mpmath).
    let known = [(Pulse::Beginning, 551.741_369_8, 2_003.122_13), (Pulse::End, 551.012_244_8, 2_005.924_894)];
    for (pulse, k_pwm, f) in known {
        let voltage = growth_limit(545.0, 560.0, 1e-7, |k| magnitude(k, 1e-4, pulse)).unwrap();
        let frequency = growth_limit(2020.0, 1990.0, 1e-7, |f| magnitude(110.0, 1.0 / f, pulse)).unwrap();
        assert!((voltage - k_pwm).abs() < 1e-5, "{pulse:?}: {voltage}");
        assert!((frequency - f).abs() < 1e-5, "{pulse:?}: {frequency}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn perturbed_runs_have_their_limit_where_the_eigenvalues_say() {
    let growth =
        |k: f64, t: f64, pulse| switched_drive(k, t, pulse).perturbed_growth(&inputs(), 2_000, 4_000).map(|g| g.factor);
    let limits = [(Pulse::Beginning, 551.741, 2003.12), (Pulse::End, 551.012, 2005.92)];
    // By default the amplitude of the one and the frequency of the other.
    for (number, (pulse, k_pwm, f)) in limits.into_iter().enumerate() {
        if is_tried(number, 2) {
            let k = growth_limit(k_pwm - 0.2, k_pwm + 0.2, 0.02, |k| growth(k, 1e-4, pulse)).unwrap();
            assert!(four_digits(k, k_pwm), "{pulse:?}: {k}");
        }
        if is_tried(number + 1, 2) {
            let found = growth_limit(f + 0.8, f - 0.8, 0.08, |f| growth(110.0, 1.0 / f, pulse)).unwrap();
            assert!(four_digits(found, f), "{pulse:?}: {found}");
        }
    }
}

#[test]
fn growth_of_perturbed_runs_equals_the_dominant_eigenvalue() {
    for (k, t) in [(560.0, 1e-4), (570.0, 1e-4), (110.0, 1.0 / 1980.0)] {
        let drive = switched_drive(k, t, Pulse::Beginning);
        let expected = magnitude(k, t, Pulse::Beginning).unwrap().ln();
        let seen = drive.perturbed_growth(&inputs(), 8_000, 8_000).unwrap().factor.ln();
        assert!((expected - seen).abs() < 2e-3 * expected.abs(), "{k} {t}: {expected:e} {seen:e}");
    }
}

#[test]
fn at_2010_hz_the_sampled_model_is_unstable_and_the_circuit_is_not() {
    let t = 1.0 / 2010.0;
    assert!(eigenvalues(&sampled_drive(110.0, t).transition).unwrap()[0].norm() > 1.0);
    assert!(magnitude(110.0, t, Pulse::Beginning).unwrap() < 1.0);
}

#[test]
fn from_rest_the_circuit_saturates_and_stays_bounded_even_where_the_sampled_model_grows() {
    let drive = switched_drive(555.0, 1e-4, Pulse::Beginning);
    let run = drive.simulate(&drive.rest(), &reference_step(), 20_000, Record::Samples);
    assert!(run.clamped > 100);
    assert!(run.trace.peak("V_a.control") > 10.0 * E_SW);
    assert!(run.trace.peak("omega") < 160.0);
    assert!(run.trace.signal("V_a.duty").unwrap().values.iter().all(|d| (0.0..=1.0).contains(d)));
}

#[test]
fn the_ripple_is_the_triangle_of_the_two_topologies() {
    let (k_pwm, t) = (110.0, 1e-4);
    let drive = switched_drive(k_pwm, t, Pulse::Beginning);
    let operating = drive.periodic_steady_state(&inputs()).unwrap();
    let run = drive.simulate(&operating.state, &reference_step(), 3, Record::Waveform(8));
    let current = &run.trace.signal("i_a").unwrap().values;
    let (low, high) = current.iter().fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
    let duty = operating.duty[0];
    // Without losses: K_pwm d (1 - d) T / L_a.
    let triangle = k_pwm * duty * (1.0 - duty) * t / L_A;
    assert!(((high - low) / triangle - 1.0).abs() < 1e-3, "{} {triangle}", high - low);
    assert!(run.trace.time.windows(2).all(|w| w[0] <= w[1]));
    assert!((run.trace.time.last().unwrap() - 3.0 * t).abs() < 1e-15);
}

/// The averaged circuit at t = 0.04 s, sources replaced by their mean voltage in each period, started
/// at the same state.
fn averaged_end(start: &SwitchedState, k_pwm: f64, t: f64, periods: usize) -> DVector<f64> {
    let model = sampled_drive(k_pwm, t);
    let order = [0, 1, 2, 3, 4, 5];
    let mut x = DVector::from_iterator(6, order.iter().map(|&i| start.stacked()[i]));
    for _ in 0..periods {
        x = &model.transition * &x + &model.input * inputs();
    }
    x
}

#[test]
fn the_period_average_approaches_the_averaged_model_with_first_order() {
    let k_pwm = 110.0;
    let horizon = 0.04;
    let errors: Vec<f64> = [400usize, 800, 1600, 3200]
        .iter()
        .map(|&periods| {
            let t = horizon / periods as f64;
            let drive = switched_drive(k_pwm, t, Pulse::Beginning);
            let mut start = drive.periodic_steady_state(&inputs()).unwrap().state;
            start.plant[0] += 0.2;
            start.plant[1] -= 0.3;
            let run = drive.simulate(&start, &reference_step(), periods, Record::Samples);
            assert_eq!(run.clamped, 0);
            let average = drive.period_average(&run.end, &inputs());
            let linear = averaged_end(&start, k_pwm, t, periods);
            (average - linear.rows(0, 2)).norm()
        })
        .collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 1.0).abs() < 0.15, "{errors:?}: order {order}");
    }
}

/// A run of more samples than there is memory for ends where it is told to.
#[test]
fn a_budget_ends_a_run() {
    let (circuit, sampled) = (switched_drive(110.0, 1e-4, Pulse::Beginning), sampled_drive(110.0, 1e-4));
    for reports in [0, 3] {
        let budget = || if reports == 0 { spent() } else { cancelled_after(reports) };
        let run = circuit.simulate_within(&circuit.rest(), &reference_step(), usize::MAX, Record::Samples, &budget());
        assert!(run.is_err());
        assert!(sampled.simulate_within(&reference_step(), usize::MAX, &budget()).is_err());
    }
}

#[test]
fn shapes_and_signs_are_checked() {
    let drive = switched_drive(110.0, 1e-4, Pulse::Beginning);
    assert_eq!(drive.plant_states().len(), 2);
    let plant = jurist_draw::simulate::Plant {
        matrix: DMatrix::zeros(2, 2),
        source: DMatrix::zeros(2, 0),
        input: DMatrix::zeros(1, 1),
    };
    let controller = jurist_draw::simulate::Controller {
        transition: DMatrix::zeros(0, 0),
        from_plant: DMatrix::zeros(0, 2),
        from_input: DMatrix::zeros(0, 1),
        output: DMatrix::zeros(0, 0),
        direct_plant: DMatrix::zeros(0, 2),
        direct_input: DMatrix::zeros(0, 1),
    };
    let names = || [names(&["a", "b"]), vec![], names(&["r"])];
    let bad = SwitchedModel::new(1.0, plant.clone(), vec![], controller.clone(), names());
    assert!(bad.unwrap_err().to_string().contains("W is 1 x 1"));
    let good = jurist_draw::simulate::Plant { input: DMatrix::zeros(2, 1), ..plant };
    assert!(SwitchedModel::new(0.0, good.clone(), vec![], controller.clone(), names()).is_err());
    assert!(SwitchedModel::new(1.0, good, vec![], controller, names()).is_ok());
}
