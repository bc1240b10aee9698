//! The paper's drive as plain matrices, for the tests of the simulation.

use super::number::ratio;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Poly, UniPoly};
use jurist_draw::simulate::{Controller, Plant, Pulse, Pwm, SampledModel, SwitchedModel};
use nalgebra::DMatrix;

pub const R_A: f64 = 1.0;
pub const L_A: f64 = 46e-3;
pub const INERTIA: f64 = 0.093;
pub const B_V: f64 = 0.008;
pub const K_A: f64 = 0.55;
pub const E_SW: f64 = 12.0;
pub const K_PI: f64 = 10.0;
pub const K_II: f64 = 500.0;
pub const K_PS: f64 = 1.0;
pub const K_IS: f64 = 5.0;

pub fn matrix<const R: usize, const C: usize>(rows: [[f64; C]; R]) -> DMatrix<f64> {
    DMatrix::from_fn(R, C, |i, j| rows[i][j])
}

pub fn names(list: &[&str]) -> Vec<String> {
    list.iter().map(|s| s.to_string()).collect()
}

/// The six-state Euler model, with the control voltage as an output.
pub fn sampled_drive(k_pwm: f64, t: f64) -> SampledModel {
    let g = k_pwm * t / (L_A * E_SW);
    SampledModel {
        transition: matrix([
            [1.0 - R_A * t / L_A, -K_A * t / L_A, g * K_PI, g * K_II, 0.0, 0.0],
            [K_A * t / INERTIA, 1.0 - B_V * t / INERTIA, 0.0, 0.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0, 0.0, K_PS, K_IS],
            [-t / 2.0, 0.0, t / 2.0, 1.0, t / 2.0 * K_PS, t / 2.0 * K_IS],
            [0.0, -1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, -t / 2.0, 0.0, 0.0, t / 2.0, 1.0],
        ]),
        input: matrix([[0.0, 0.0], [0.0, -t / INERTIA], [0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [t / 2.0, 0.0]]),
        output: matrix([[0.0, 0.0, K_PI, K_II, 0.0, 0.0]]),
        feedthrough: DMatrix::zeros(1, 2),
        states: names(&["i_a", "omega", "eps_1i", "eps_2i", "eps_1s", "eps_2s"]),
        inputs: names(&["omega_ref", "T_L"]),
        outputs: names(&["E_c"]),
        sample_time: t,
    }
    .checked()
    .unwrap()
}

/// The same drive as a circuit.
pub fn switched_drive(k_pwm: f64, t: f64, pulse: Pulse) -> SwitchedModel {
    let plant = Plant {
        matrix: matrix([[-R_A / L_A, -K_A / L_A], [K_A / INERTIA, -B_V / INERTIA]]),
        source: matrix([[1.0 / L_A], [0.0]]),
        input: matrix([[0.0, 0.0], [0.0, -1.0 / INERTIA]]),
    };
    let controller = Controller {
        transition: matrix([
            [0.0, 0.0, K_PS, K_IS],
            [t / 2.0, 1.0, t / 2.0 * K_PS, t / 2.0 * K_IS],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, t / 2.0, 1.0],
        ]),
        from_plant: matrix([[-1.0, 0.0], [-t / 2.0, 0.0], [0.0, -1.0], [0.0, -t / 2.0]]),
        from_input: matrix([[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [t / 2.0, 0.0]]),
        output: matrix([[K_PI, K_II, 0.0, 0.0]]),
        direct_plant: DMatrix::zeros(1, 2),
        direct_input: DMatrix::zeros(1, 2),
    };
    let source = Pwm { name: "V_a".into(), amplitude: k_pwm, carrier: E_SW, pulse };
    SwitchedModel::new(
        t,
        plant,
        vec![source],
        controller,
        [names(&["i_a", "omega"]), names(&["eps_1i", "eps_2i", "eps_1s", "eps_2s"]), names(&["omega_ref", "T_L"])],
    )
    .unwrap()
}

/// The drive's exact characteristic polynomial (a positive multiple with integer coefficients).
pub fn drive_polynomial(k: &Rational, t: &Rational) -> UniPoly {
    let power = |e: i64| t.pow(e).unwrap();
    let sum = |terms: &[(Rational, Rational)]| terms.iter().fold(Rational::ZERO, |s, (a, b)| s + a * b);
    let one = ratio(1, 1);
    let kc = |n: i64, d: i64| ratio(n, d) * k;
    let a0 = sum(&[(kc(42_968_750, 6417), power(4)), (kc(-18_906_250, 6417), power(3)), (kc(687_500, 6417), power(2))]);
    let a1 = sum(&[
        (kc(85_937_500, 6417), power(4)),
        (kc(-250_000, 6417), power(3)),
        (kc(1_541_250, 6417), power(2)),
        (kc(-116_250, 6417), power(1)),
    ]);
    let a2 = sum(&[
        (kc(42_968_750, 6417), power(4)),
        (kc(18_906_250, 6417), power(3)),
        (kc(-248_750, 713) + ratio(2250, 31), power(2)),
        (kc(1250, 23) - ratio(46_684, 2139), power(1)),
        (one.clone(), one.clone()),
    ]);
    let a3 = sum(&[
        (kc(250_000, 6417), power(3)),
        (kc(-2_896_250, 6417) - ratio(4500, 31), power(2)),
        (kc(-1250, 23) + ratio(46_684, 713), power(1)),
        (ratio(-4, 1), one.clone()),
    ]);
    let a4 = sum(&[
        (kc(31_250, 69) + ratio(2250, 31), power(2)),
        (kc(1250, 69) - ratio(46_684, 713), power(1)),
        (ratio(6, 1), one.clone()),
    ]);
    let a5 = ratio(46_684, 2139) * t - ratio(4, 1);
    UniPoly::from_rational_poly(&Poly::new(vec![a0, a1, a2, a3, a4, a5, one])).1
}
