//! Values of symbols in floating point, for pictures and simulations only.

use super::{Definition, Symbols};
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_algebra::symbols::DutyRatio;

/// Terms of the series of the exponential of a matrix of norm at most 1/2: the next is below the last bit.
const TERMS: usize = 20;

impl Symbols {
    /// The values of all variables where the kept names have these: kept names, then symbols.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_model::{BlockBuilder, Model, Time};
    /// let (model, _) = Model::builder(Time::Discrete)
    ///     .inputs(["r"])
    ///     .outputs(["y"])
    ///     .block(BlockBuilder::new("plant", "r - y", "y").transfer("1/(s + 1)").held("1/10", "0"))
    ///     .build()?;
    /// let evaluated = model.evaluate(&[], &[], &Budget::unlimited()).unwrap();
    /// assert!((evaluated.symbols.values_approximate(&[])[0] - (-0.1f64).exp()).abs() < 1e-15);
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    ///
    /// # Panics
    /// When `kept` does not give every kept name its value.
    pub fn values_approximate(&self, kept: &[f64]) -> Vec<f64> {
        assert_eq!(kept.len(), self.kept.len(), "every kept name has a value");
        if self.has_flows() {
            return self.values_of_flows_approximate();
        }
        let mut values = kept.to_vec();
        for symbol in &self.table {
            let at = |f: &RationalFunction| value_approximate(f, &values);
            // Dead time is a function of s and has no value.
            let value = symbol.definition().map_or(f64::NAN, |definition| match definition {
                Definition::Pi => std::f64::consts::PI,
                Definition::Algebraic(x) => x.refined_to_digits(17).enclosure().0.to_f64_approximate(),
                Definition::Enclosed(x) => x.value.refined_to_digits(17).enclosure().0.to_f64_approximate(),
                // Pictures are made of the model itself.
                Definition::Family(_) => f64::NAN,
                Definition::Root(x) => at(x).sqrt(),
                Definition::Duty(duty) => duty_approximate(duty, at),
                Definition::Exponential(x) => at(x).exp(),
                Definition::Tangent { square, time } => {
                    let (w, t) = (at(square), at(time));
                    let root = w.abs().sqrt();
                    if w > 0.0 {
                        (root * t).tan() / root
                    } else if w < 0.0 {
                        (root * t).tanh() / root
                    } else {
                        t
                    }
                }
                Definition::Fundamental { polynomial, time, index } => {
                    let polynomial: Vec<f64> = polynomial.iter().map(at).collect();
                    fundamental_approximate(&polynomial, at(time), *index)
                }
            });
            values.push(value);
        }
        values
    }
}

/// The value of a rational function at a point.
pub fn value_approximate(f: &RationalFunction, point: &[f64]) -> f64 {
    let side = |p: &MultiPoly| -> f64 {
        let term = |(m, c): &(jurist_algebra::poly::Monomial, jurist_algebra::number::Integer)| {
            let powers = m.exponents().iter().enumerate().map(|(i, &e)| point[i].powi(e as i32));
            c.to_f64_approximate() * powers.product::<f64>()
        };
        p.terms().iter().map(term).sum()
    };
    side(f.numerator()) / side(f.denominator())
}

/// A duty ratio by halving.
fn duty_approximate(duty: &DutyRatio, at: impl Fn(&RationalFunction) -> f64) -> f64 {
    let weights: Vec<f64> = duty.weights.iter().map(&at).collect();
    let polynomial: Vec<f64> = std::iter::once(0.0).chain(duty.polynomial.iter().map(&at)).chain([1.0]).collect();
    let (mean, time) = (at(&duty.mean), at(&duty.time));
    let integral = |t: f64| -> f64 {
        let term = |k: usize| weights[k - 1] * fundamental_approximate(&polynomial, t, k);
        (1..polynomial.len() - 1).map(term).sum()
    };
    let whole = integral(time);
    let left = |d: f64| -> f64 {
        let before = |[a, b]: [i64; 2]| whole - integral(time * (1.0 - (a as f64 + b as f64 * d) / 2.0));
        let parts: f64 = duty.parts.iter().map(|[begin, end]| before(*end) - before(*begin)).sum();
        mean + parts - d * whole - d
    };
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = (lo + hi) / 2.0;
        if left(middle) > 0.0 { lo = middle } else { hi = middle }
    }
    lo
}

/// Entry `(0, index)` of the exponential of the companion matrix: scaling, series, squaring.
fn fundamental_approximate(polynomial: &[f64], time: f64, index: usize) -> f64 {
    let n = polynomial.len() - 1;
    let entry = |i: usize, j: usize| match (i + 1 == n, j == i + 1) {
        (true, _) => -polynomial[j] * time,
        (false, true) => time,
        _ => 0.0,
    };
    let norm = (0..n).map(|i| (0..n).map(|j| entry(i, j).abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = if norm > 0.5 { (norm * 2.0).log2().ceil() as i32 } else { 0 };
    let scale = 0.5f64.powi(halvings);
    let identity = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let product = |a: &[Vec<f64>], b: &[Vec<f64>]| -> Vec<Vec<f64>> {
        (0..n).map(|i| (0..n).map(|j| (0..n).map(|k| a[i][k] * b[k][j]).sum()).collect()).collect()
    };
    let m: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j) * scale).collect()).collect();
    let mut sum: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| identity(i, j)).collect()).collect();
    let mut term = sum.clone();
    for k in 1..=TERMS {
        term = product(&term, &m);
        term.iter_mut().flatten().for_each(|x| *x /= k as f64);
        for (row, add) in sum.iter_mut().zip(&term) {
            row.iter_mut().zip(add).for_each(|(x, y)| *x += y);
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum[0][index]
}
