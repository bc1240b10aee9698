//! The sampled simulation: against the exact rational run, the exact poles, and the steady state.

use crate::helpers::drive::{drive_polynomial, sampled_drive};
use crate::helpers::number::ratio;
use crate::helpers::thorough::tried;
use jurist_algebra::number::Rational;
use jurist_draw::simulate::{Excitation, Step, eigenvalues, exact_response, roots};
use nalgebra::DVector;

fn reference_step() -> Excitation {
    Excitation { initial: vec![], steps: vec![Step { sample: 0, input: 0, value: 80.0 }] }
}

fn dominant(k: &Rational, t: &Rational) -> f64 {
    roots(&drive_polynomial(k, t)).iter().map(|r| r.value.norm()).fold(0.0, f64::max)
}

/// The drive's matrices over the rationals, for T = 1/10000 and K_pwm = 110.
fn exact_matrices() -> (Vec<Vec<Rational>>, Vec<Vec<Rational>>) {
    let z = || ratio(0, 1);
    // K_pwm T / (L_a E_sw) = 110/10000 / (0.046 * 12)
    let g = ratio(110, 10_000).checked_div(&(ratio(46, 1000) * ratio(12, 1))).unwrap();
    let h = ratio(1, 20_000);
    let a = vec![
        vec![
            ratio(1, 1) - ratio(1, 460),
            -ratio(55, 100) * ratio(1, 460),
            &g * &ratio(10, 1),
            &g * &ratio(500, 1),
            z(),
            z(),
        ],
        vec![ratio(55, 100) * ratio(1, 930), ratio(1, 1) - ratio(8, 930_000), z(), z(), z(), z()],
        vec![ratio(-1, 1), z(), z(), z(), ratio(1, 1), ratio(5, 1)],
        vec![-&h, z(), h.clone(), ratio(1, 1), h.clone(), &h * &ratio(5, 1)],
        vec![z(), ratio(-1, 1), z(), z(), z(), z()],
        vec![z(), -&h, z(), z(), h.clone(), ratio(1, 1)],
    ];
    let e = vec![
        vec![z(), z()],
        vec![z(), -ratio(1, 930)],
        vec![z(), z()],
        vec![z(), z()],
        vec![ratio(1, 1), z()],
        vec![h.clone(), z()],
    ];
    (a, e)
}

#[test]
fn short_runs_agree_with_the_exact_rational_run() {
    let (a, e) = exact_matrices();
    let model = sampled_drive(110.0, 1e-4);
    let excitation = Excitation {
        initial: vec![0.5, 10.0],
        steps: vec![Step { sample: 0, input: 0, value: 80.0 }, Step { sample: 0, input: 1, value: 3.0 }],
    };
    let mut initial = vec![ratio(1, 2), ratio(10, 1)];
    initial.resize(6, ratio(0, 1));
    let exact = exact_response(&a, &e, &initial, &[ratio(80, 1), ratio(3, 1)], 60);
    let run = model.simulate(&excitation, 60);
    for (n, state) in exact.iter().enumerate() {
        for (k, value) in state.iter().enumerate() {
            let (value, found) = (value.to_f64_approximate(), run.signals[k].values[n]);
            assert!((value - found).abs() <= 1e-12 * (1.0 + value.abs()), "n = {n}, state {k}: {value} {found}");
        }
    }
}

#[test]
fn eigenvalues_are_the_roots_of_the_exact_polynomial() {
    for (k, t) in
        [(ratio(110, 1), ratio(1, 10_000)), (ratio(545, 1), ratio(1, 10_000)), (ratio(110, 1), ratio(1, 2010))]
    {
        let model = sampled_drive(k.to_f64_approximate(), t.to_f64_approximate());
        let found = eigenvalues(&model.transition).unwrap();
        for root in roots(&drive_polynomial(&k, &t)) {
            assert!(found.iter().any(|z| (z - root.value).norm() < 1e-7), "{root:?} {found:?}");
        }
    }
}

#[test]
fn growth_of_runs_equals_the_dominant_eigenvalue() {
    let nominal = ratio(1, 10_000);
    let cases = [
        (ratio(545, 1), nominal.clone()),
        (ratio(555, 1), nominal),
        (ratio(110, 1), ratio(1, 2010)),
        (ratio(110, 1), ratio(1, 2020)),
    ];
    for (k, t) in tried(cases, 2) {
        let model = sampled_drive(k.to_f64_approximate(), t.to_f64_approximate());
        let expected = dominant(&k, &t);
        let observed = model.observed_growth(100_000, 400_000).unwrap();
        // Three digits of the growth rate itself, which is the small distance from 1.
        let (rate, seen) = (expected.ln(), observed.ln());
        assert!((rate - seen).abs() < 5e-4 * rate.abs(), "K = {k}, T = {t}: {rate:e} {seen:e}");
    }
}

#[test]
fn stable_runs_settle_at_the_reference_and_unstable_ones_grow() {
    for (k, t, stable) in
        [(545.0, 1e-4, true), (555.0, 1e-4, false), (110.0, 1.0 / 2020.0, true), (110.0, 1.0 / 2010.0, false)]
    {
        let model = sampled_drive(k, t);
        let samples = (12.0 / t) as usize;
        let run = model.simulate(&reference_step(), samples);
        let speed = &run.signal("omega").unwrap().values;
        let deviation = |from: f64| {
            speed[(from * speed.len() as f64) as usize..].iter().fold(0.0f64, |m, v| m.max((v - 80.0).abs()))
        };
        if stable {
            assert_eq!(speed.len(), samples + 1);
            assert!(deviation(0.9) < 1e-3, "K = {k}: {}", deviation(0.9));
        } else {
            let current = &run.signal("i_a").unwrap().values;
            let third = current.len() / 3;
            let peak = |part: &[f64]| part.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            assert!(peak(&current[2 * third..]) > 2.0 * peak(&current[third..2 * third]), "K = {k}");
        }
    }
}

#[test]
fn the_unclamped_control_voltage_reaches_about_807_from_rest() {
    let run = sampled_drive(110.0, 1e-4).simulate(&reference_step(), 20_000);
    assert!((run.peak("E_c") - 807.0).abs() < 1.0, "{}", run.peak("E_c"));
}

#[test]
fn a_load_step_is_answered_and_the_speed_comes_back() {
    let model = sampled_drive(110.0, 1e-4);
    let mut excitation = reference_step();
    excitation.steps.push(Step { sample: 50_000, input: 1, value: 5.0 });
    let run = model.simulate(&excitation, 100_000);
    let speed = &run.signal("omega").unwrap().values;
    let dip = speed[50_000..].iter().fold(f64::INFINITY, |m, v| m.min(*v));
    assert!(dip < 79.0 && dip > 70.0, "{dip}");
    assert!((speed[100_000] - 80.0).abs() < 1e-3);
    let steady = model.steady_state(&DVector::from_vec(vec![80.0, 5.0])).unwrap();
    assert!((steady[1] - 80.0).abs() < 1e-6);
    assert!((run.signal("i_a").unwrap().values[100_000] - steady[0]).abs() < 1e-3);
}
