//! The phase of an open loop, continued exactly, against the sum of the angles of all its factors in floating point.

use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_engine::response::{OpenLoop, Turning};
use jurist_engine::stability::Shape;
use proptest::prelude::*;
use std::f64::consts::PI;

/// Roots of a polynomial: real ones `p/q`, pairs `(a +- j b)/q`.
type Roots = (Vec<(i64, i64)>, Vec<(i64, i64, i64)>);

fn polynomial((real, pairs): &Roots, variable: &str) -> String {
    let line = |&(p, q): &(i64, i64)| format!("*({q}*{variable} - ({p}))");
    let pair = |&(a, b, q): &(i64, i64, i64)| {
        format!("*({}*{variable}^2 - ({})*{variable} + {})", q * q, 2 * a * q, a * a + b * b)
    };
    real.iter().map(line).chain(pairs.iter().map(pair)).fold("1".to_owned(), |all, p| all + &p)
}

/// `N/D0` with these roots, cut at its gain.
fn open_loop(zeros: &Roots, poles: &Roots, negative: bool, shape: Shape) -> OpenLoop {
    let (time, variable) = match shape {
        Shape::UnitDisc => ("discrete", "z"),
        Shape::LeftHalfPlane => ("continuous", "s"),
    };
    let (n, d, sign) = (polynomial(zeros, variable), polynomial(poles, variable), if negative { "-" } else { "+" });
    let text = format!("time = '{time}'\nparameters.k = 1\nloop.characteristic = '{d} {sign} k*({n})'\n");
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    OpenLoop::of(&model.ask().problem().unwrap(), Some("k"), &Budget::unlimited()).unwrap()
}

/// The angle of `p - root` at `s = j omega`, continued; a root on the axis is left of it.
fn left_of_axis((re, im): (f64, f64), omega: f64) -> f64 {
    let height = omega - im;
    match re {
        0.0 => PI.copysign(height) / 2.0,
        re if re < 0.0 => height.atan2(-re),
        re => PI - height.atan2(re),
    }
}

/// The same at `z = exp(j theta)`; a root on the circle is inside.
fn inside_of_circle((re, im): (f64, f64), theta: f64) -> f64 {
    let size = re.hypot(im);
    let angle = theta - im.atan2(re);
    if (size - 1.0).abs() < 1e-12 {
        // exp(j theta) - exp(j alpha) turns by half of the angle, and by half a turn where it vanishes.
        let turned = angle - 2.0 * PI * (angle / (2.0 * PI)).floor();
        return im.atan2(re) + angle / 2.0 + PI / 2.0 * if turned == angle { 1.0 } else { -1.0 };
    }
    if size < 1.0 {
        return theta + (size * angle.sin()).atan2(1.0 - size * angle.cos());
    }
    (-im).atan2(-re) + (-angle.sin() / size).atan2(1.0 - angle.cos() / size)
}

/// The phase as a sum over all factors.
fn by_factors(roots: &Roots, at: f64, shape: Shape) -> f64 {
    let one = |root| match shape {
        Shape::LeftHalfPlane => left_of_axis(root, at),
        Shape::UnitDisc => inside_of_circle(root, at),
    };
    let real = roots.0.iter().map(|&(p, q)| one((p as f64 / q as f64, 0.0)));
    let pair = |&(a, b, q): &(i64, i64, i64)| {
        let (a, b) = (a as f64 / q as f64, b as f64 / q as f64);
        one((a, b)) + one((a, -b))
    };
    real.chain(roots.1.iter().map(pair)).sum()
}

/// Roots on the boundary among them: `(3 +- 4 j)/5`.
fn roots() -> impl Strategy<Value = Roots> {
    let real = prop::collection::vec(((-6i64..=6), (1i64..=5)), 0..4);
    let pair = prop_oneof![
        4 => ((-6i64..=6), (1i64..=6), (1i64..=5)),
        1 => Just((3, 4, 5)),
        1 => Just((0, 2, 1)),
    ];
    (real, prop::collection::vec(pair, 0..4))
}

fn compare(zeros: &Roots, poles: &Roots, negative: bool, shape: Shape) {
    let turning = Turning::of(&open_loop(zeros, poles, negative, shape), &Budget::unlimited()).unwrap();
    let mut whole: Option<f64> = None;
    for k in 1..60 {
        let (at, x) = match shape {
            Shape::LeftHalfPlane => {
                let omega = 0.013 * 1.17_f64.powi(k);
                (omega, -omega * omega)
            }
            Shape::UnitDisc => {
                let theta = 0.052_3 * f64::from(k);
                (theta, 2.0 * theta.cos())
            }
        };
        let phase = by_factors(zeros, at, shape) - by_factors(poles, at, shape) + if negative { PI } else { 0.0 };
        let middle = turning.middle(&Rational::from_f64(x).unwrap()) as f64;
        // The first is known up to whole turns.
        let difference = middle - phase.to_degrees();
        let whole = *whole.get_or_insert((difference / 360.0).round() * 360.0);
        assert!((difference - whole).abs() < 45.001, "{zeros:?}/{poles:?} at {at}: {middle}, {}", phase.to_degrees());
    }
}

/// How many cases are tried; more by hand.
fn cases() -> u32 {
    std::env::var("JURIST_TURNING_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(24)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn the_phase_is_that_of_all_factors_together(zeros in roots(), poles in roots(), negative: bool, is_disc: bool) {
        compare(&zeros, &poles, negative, if is_disc { Shape::UnitDisc } else { Shape::LeftHalfPlane });
    }
}

#[test]
fn poles_on_the_boundary_take_half_a_turn_each() {
    let none = (Vec::new(), Vec::new());
    for shape in [Shape::UnitDisc, Shape::LeftHalfPlane] {
        compare(&none, &(Vec::new(), vec![(3, 4, 5), (3, 4, 5), (0, 2, 1)]), false, shape);
        compare(&(Vec::new(), vec![(0, 1, 1)]), &(vec![(0, 1), (1, 1), (1, 1)], Vec::new()), true, shape);
    }
    compare(&none, &(vec![(1, 2); 40], Vec::new()), false, Shape::UnitDisc);
}

#[test]
fn a_constant_does_not_turn() {
    let none = (Vec::new(), Vec::new());
    for (shape, negative) in [(Shape::UnitDisc, false), (Shape::UnitDisc, true), (Shape::LeftHalfPlane, true)] {
        compare(&none, &none, negative, shape);
    }
}

/// The middle of the first quarter of a loop cut at its gain `k`, close to `s = 0` or `z = 1`.
fn first_middle(text: &str, low: &str) -> i64 {
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    let budget = Budget::unlimited();
    let open_loop = OpenLoop::of(&model.ask().problem().unwrap(), Some("k"), &budget).unwrap();
    Turning::of(&open_loop, &budget).unwrap().middle(&low.parse().unwrap())
}

/// Close to `s = 0`, as `s^2`, and to `z = 1`, as `z + 1/z`.
const LOW: [&str; 2] = ["-1/1000000000", "1999999999/1000000000"];

/// The phase begins at -90 degrees for each integrator, at 90 with a differentiator, whatever turns it further.
#[test]
fn every_integrator_begins_a_quarter_of_a_turn_lower() {
    let parts = [("continuous", "s", "(s + 1)^5", "(s + 2)^5"), ("discrete", "(z - 1)", "(z - 1/2)^5", "(z - 1/3)^5")];
    for ((time, root, lead, lag), low) in parts.into_iter().zip(LOW) {
        for n in -1..=4 {
            for (above, below, towards) in [(lead, lag, 45), (lag, lead, -45)] {
                let (zeros, poles) = if n < 0 { (-n, 0) } else { (0, n) };
                let text = format!(
                    "time = '{time}'\nparameters.k = 1\n\
                     loop.characteristic = '{root}^{poles}*{below} + k*{root}^{zeros}*{above}'\n"
                );
                assert_eq!(first_middle(&text, low), -90 * n + towards, "{text}");
            }
        }
    }
}

/// Behind a hold the integrators are factors of polynomials in the hold's constants.
#[test]
fn integrators_behind_a_hold_begin_as_others_do() {
    for (plant, middle) in [
        ("1/(s + 1)", -45),
        ("1/s/(s + 1)", -135),
        ("1/s^2/(s + 1)", -225),
        ("1/s^3/(s + 1)", -315),
        ("s/(s + 1)^2", 45),
    ] {
        let text = format!(
            "time = 'discrete'\nsample_time = '1/10'\nparameters.k = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
             [[block]]\nname = 'controller'\ninput = 'r - y'\noutput = 'u'\ngain = 'k'\n\
             [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\ndiscretize = 'zoh'\n"
        );
        assert_eq!(first_middle(&text, LOW[1]), middle, "{plant}");
    }
}
