//! Plants behind a hold, against roots in floating point.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::answer::Verdict;
use jurist_engine::model::{Model, source_from_bytes};
use jurist_engine::problem::Ask;
use std::time::Duration;

/// Roots nearer to the circle than this are not told apart in floating point.
const NEAR: f64 = 1e-6;

/// Reads a plant with two real poles, a sample time, a delay of whole samples and gains from bytes; the exact verdicts behind a zero-order hold
/// and the stable set of the gain must be those of the roots in floating point, which are found by partial fractions and Weierstrass' iteration.
///
/// # Panics
/// When the two ways disagree.
pub fn sampled_against_float_roots(data: &[u8]) {
    let [first, second, period, delay, gains @ ..] = data else { return };
    // Poles of which one may be unstable, and never equal.
    let (a, b) = (i64::from(*first) - 32, i64::from(*first) + 1 + i64::from(*second));
    if a == 0 || b == 0 {
        return;
    }
    let (period, delay) = (1 + i64::from(*period % 64), usize::from(delay % 3));
    let text = format!(
        "time = 'discrete'\nsample_time = '{period}/64'\n[parameters]\nK = {{ nominal = 1 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'u'\ntransfer = 'K/z^{delay}'\n\
         [[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\ntransfer = '1/((s + {a}/16)*(s + {b}/16))'\ndiscretize = 'zoh'\n"
    );
    let source = source_from_bytes("fuzz.toml", text.as_bytes()).expect("text");
    let (model, _) = Model::from_toml(&source).expect("a model");
    // What the budget cuts off is no finding.
    let budget = Budget::with_timeout(Duration::from_secs(5));
    let Ok(set) = model.ask().free("K").stable_set(&budget) else { return };
    for pair in gains.chunks_exact(2).take(8) {
        let k = Rational::new(Integer::from(i64::from(pair[0] as i8)), Integer::from(1 + i64::from(pair[1] % 16)));
        let roots = float_roots(&polynomial(a, b, period, delay, k.to_f64_approximate()));
        if roots.iter().any(|r| !r.is_finite() || (r - 1.0).abs() < NEAR) {
            continue;
        }
        let stable = roots.iter().all(|r| *r < 1.0);
        let Ok(verdict) = model.ask().set("K", k.clone()).verdict(&budget) else { return };
        assert_eq!(verdict.value().verdict == Verdict::Stable, stable, "K = {k}: {roots:?}\n{text}");
        assert_eq!(set.value().contains(&k), stable, "K = {k}: {roots:?}\n{text}");
    }
}

/// `z^d (z - p)(z - q) + K/(b - a) (r (z - q) - s (z - p))` from the constant term up, with `p = exp(-a T)` and `r = (1 - p)/a`.
fn polynomial(a: i64, b: i64, period: i64, delay: usize, k: f64) -> Vec<f64> {
    let (a, b, t) = (a as f64 / 16.0, b as f64 / 16.0, period as f64 / 64.0);
    let (p, q) = ((-a * t).exp(), (-b * t).exp());
    let (r, s) = (-(-a * t).exp_m1() / a, -(-b * t).exp_m1() / b);
    let gain = k / (b - a);
    let mut out = vec![0.0; delay + 3];
    out[delay] = p * q;
    out[delay + 1] = -(p + q);
    out[delay + 2] = 1.0;
    out[0] += gain * (s * p - r * q);
    out[1] += gain * (r - s);
    out
}

/// Absolute values of the roots of a monic polynomial; not finite where the iteration does not settle.
fn float_roots(p: &[f64]) -> Vec<f64> {
    type Complex = (f64, f64);
    let times = |x: Complex, y: Complex| (x.0 * y.0 - x.1 * y.1, x.0 * y.1 + x.1 * y.0);
    let over = |x: Complex, y: Complex| {
        let size = y.0 * y.0 + y.1 * y.1;
        ((x.0 * y.0 + x.1 * y.1) / size, (x.1 * y.0 - x.0 * y.1) / size)
    };
    let n = p.len() - 1;
    let radius = 1.0 + p.iter().fold(0.0f64, |most, c| most.max(c.abs()));
    let start = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / n as f64 + 0.4;
        (radius * angle.cos(), radius * angle.sin())
    };
    let mut roots: Vec<Complex> = (0..n).map(start).collect();
    let mut moved = f64::INFINITY;
    for _ in 0..5000 {
        moved = 0.0;
        for i in 0..n {
            let z = roots[i];
            let value = p.iter().rev().fold((0.0, 0.0), |sum, c| {
                let (re, im) = times(sum, z);
                (re + c, im)
            });
            let others = (0..n).filter(|j| *j != i);
            let product = others.fold((1.0, 0.0), |product, j| times(product, (z.0 - roots[j].0, z.1 - roots[j].1)));
            let step = over(value, product);
            roots[i] = (z.0 - step.0, z.1 - step.1);
            moved = moved.max(step.0.hypot(step.1) / (1.0 + z.0.hypot(z.1)));
        }
        if moved < 1e-14 {
            break;
        }
    }
    let settled = moved < 1e-9;
    roots.iter().map(|r| if settled { r.0.hypot(r.1) } else { f64::NAN }).collect()
}
