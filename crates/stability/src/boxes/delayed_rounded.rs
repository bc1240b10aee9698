//! A loop with dead time in floating point, for the search alone: what is found with it is counted exactly afterwards.

use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::Sign;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps along the imaginary axis after which a count is given up.
const MOST_STEPS: usize = 4000;

/// A step turns the function by at most so much.
const LARGEST_TURN: f64 = 0.7;

/// A neutral loop whose delayed highest power has more than this share of the undelayed one is taken for lost: it has roots of every
/// frequency near the axis.
const LARGEST_DELAYED_SHARE: f64 = 0.98;

/// Steps of Newton's method.
const NEWTON_STEPS: usize = 30;

#[derive(Clone, Copy, Debug)]
struct Complex(f64, f64);

impl Complex {
    fn plus(self, other: Complex) -> Complex {
        Complex(self.0 + other.0, self.1 + other.1)
    }

    fn times(self, other: Complex) -> Complex {
        Complex(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }

    fn scaled(self, x: f64) -> Complex {
        Complex(self.0 * x, self.1 * x)
    }

    /// How far this is turned from another one.
    fn turned_from(self, other: Complex) -> f64 {
        let Complex(re, im) = self.times(Complex(other.0, -other.1));
        im.atan2(re)
    }

    fn size(self) -> f64 {
        self.0.hypot(self.1)
    }

    /// The part across a direction, times its length.
    fn across(self, direction: Complex) -> f64 {
        direction.0 * self.1 - direction.1 * self.0
    }
}

/// A polynomial in the parameters: coefficients with what is multiplied, and how often.
#[derive(Clone, Debug)]
struct Rounded(Vec<(f64, Vec<(usize, i32)>)>);

impl Rounded {
    fn of(p: &MultiPoly) -> Rounded {
        let powers = |e: &[u32]| e.iter().enumerate().filter(|(_, e)| **e > 0).map(|(i, &e)| (i, e as i32)).collect();
        Rounded(p.terms().iter().map(|(m, c)| (c.to_f64_approximate(), powers(m.exponents()))).collect())
    }

    fn at(&self, x: &[f64]) -> f64 {
        self.0.iter().map(|(c, powers)| powers.iter().fold(*c, |product, &(i, e)| product * x[i].powi(e))).sum()
    }

    /// The derivative by a parameter.
    fn slope(&self, x: &[f64], by: usize) -> f64 {
        let one = |(c, powers): &(f64, Vec<(usize, i32)>)| {
            let Some(&(_, own)) = powers.iter().find(|(i, _)| *i == by) else { return 0.0 };
            let rest = powers.iter().filter(|(i, _)| *i != by).fold(*c, |product, &(i, e)| product * x[i].powi(e));
            rest * f64::from(own) * x[by].powi(own - 1)
        };
        self.0.iter().map(one).sum()
    }
}

/// A quotient.
#[derive(Clone, Debug)]
struct Quotient([Rounded; 2]);

impl Quotient {
    fn of(f: &RationalFunction) -> Quotient {
        Quotient([f.numerator(), f.denominator()].map(Rounded::of))
    }

    fn at(&self, x: &[f64]) -> f64 {
        self.0[0].at(x) / self.0[1].at(x)
    }

    fn slope(&self, x: &[f64], by: usize) -> f64 {
        let [n, d] = &self.0;
        let (value, below) = (n.at(x), d.at(x));
        (n.slope(x, by) * below - value * d.slope(x, by)) / (below * below)
    }
}

/// The loop in all its parameters.
#[derive(Clone, Debug)]
pub(super) struct RoundedLoop {
    terms: Vec<(Quotient, Vec<Rounded>)>,
    times: Vec<Quotient>,
    certain: Vec<Rounded>,
}

impl RoundedLoop {
    /// Of the dead times with the coefficients of the powers of `s`, the dead times that are not to be negative, and what must not vanish.
    pub fn of(
        terms: &[(RationalFunction, Vec<MultiPoly>)],
        times: &[RationalFunction],
        certain: &[MultiPoly],
    ) -> RoundedLoop {
        let one = |(time, part): &(RationalFunction, Vec<MultiPoly>)| {
            (Quotient::of(time), part.iter().map(Rounded::of).collect())
        };
        RoundedLoop {
            terms: terms.iter().map(one).collect(),
            times: times.iter().map(Quotient::of).collect(),
            certain: certain.iter().map(Rounded::of).collect(),
        }
    }

    fn at(&self, x: &[f64]) -> RoundedPoint {
        let one = |(time, part): &(Quotient, Vec<Rounded>)| (time.at(x), part.iter().map(|c| c.at(x)).collect());
        RoundedPoint { terms: self.terms.iter().map(one).collect() }
    }

    /// The derivative of the function by a parameter.
    fn by_parameter(&self, x: &[f64], w: f64, by: usize) -> Complex {
        let one = |(time, part): &(Quotient, Vec<Rounded>)| {
            let (tau, slope) = (time.at(x), time.slope(x, by));
            let own = polynomial(part.iter().map(|c| c.slope(x, by)), w);
            let turned = polynomial(part.iter().map(|c| c.at(x)), w).times(Complex(0.0, -w * slope));
            own.plus(turned).times(Complex((w * tau).cos(), -(w * tau).sin()))
        };
        self.terms.iter().map(one).fold(Complex(0.0, 0.0), Complex::plus)
    }

    /// Whether the loop seems stable at a point, with these signs of what must not vanish, and the frequency at which it is nearest
    /// to the limit.
    pub fn stable_approximate(&self, x: &[f64], signs: &[Sign]) -> (bool, f64) {
        let (right, nearest) = self.at(x).right();
        let kept = self.certain.iter().zip(signs).all(|(f, sign)| f.at(x).partial_cmp(&0.0) == Some(*sign));
        (kept && right == Some(0) && self.times.iter().all(|time| time.at(x) >= 0.0), nearest)
    }

    /// The frequency at which a point is nearest to the limit.
    pub fn nearest_approximate(&self, x: &[f64]) -> f64 {
        self.at(x).right().1
    }

    /// Which of what must not vanish has another sign.
    pub fn changed_approximate(&self, x: &[f64], signs: &[Sign]) -> Option<usize> {
        self.certain.iter().zip(signs).position(|(f, sign)| f.at(x).partial_cmp(&0.0) != Some(*sign))
    }

    /// The gradient of what must not vanish.
    pub fn gradient_approximate(&self, x: &[f64], which: usize) -> Vec<f64> {
        (0..x.len()).map(|i| self.certain[which].slope(x, i)).collect()
    }

    /// At a root on the axis how the parameters move it across.
    pub fn motion_approximate(&self, x: &[f64], w: f64) -> Vec<f64> {
        let along = self.at(x).by_frequency(w);
        (0..x.len()).map(|i| self.by_parameter(x, w, i).across(along)).collect()
    }

    /// The gradients of the square of the modulus at some frequencies.
    pub fn pulls_approximate(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let point = self.at(x);
        let Some(end) = point.bound() else { return Vec::new() };
        let (_, nearest) = point.right();
        let frequencies = (0..10).map(|k| end * 0.5f64.powi(k)).chain([nearest]).filter(|w| *w > 0.0);
        let gradient = |w: f64| {
            let Complex(re, im) = point.value(w).0;
            let by = |i: usize| {
                let slope = self.by_parameter(x, w, i);
                re * slope.0 + im * slope.1
            };
            (0..x.len()).map(by).collect()
        };
        frequencies.map(gradient).collect()
    }

    /// A root on the axis near a frequency and a place of the line `base + t step`: both, refined.
    pub fn crossing_approximate(&self, base: &[f64], step: &[f64], near: (f64, f64)) -> Option<(f64, f64)> {
        let (mut w, mut t) = near;
        for _ in 0..NEWTON_STEPS {
            let x = on_line(base, step, t);
            let point = self.at(&x);
            let (value, by_w) = (point.value(w).0, point.by_frequency(w));
            let moving = step.iter().enumerate().filter(|(_, s)| **s != 0.0);
            let by_t = moving.fold(Complex(0.0, 0.0), |sum, (i, s)| sum.plus(self.by_parameter(&x, w, i).scaled(*s)));
            let determinant = by_t.across(by_w);
            let (dw, dt) = (-by_t.across(value) / determinant, value.across(by_w) / determinant);
            if !dw.is_finite() || !dt.is_finite() {
                return None;
            }
            (w, t) = (w + dw, t - dt);
            if dw.abs() <= 1e-14 * w.abs() && dt.abs() <= 1e-14 * t.abs() {
                return (w > 0.0).then_some((w, t));
            }
        }
        None
    }
}

/// The point of a line.
pub(super) fn on_line(base: &[f64], step: &[f64], t: f64) -> Vec<f64> {
    base.iter().zip(step).map(|(b, s)| b + s * t).collect()
}

/// `p(i w)`.
fn polynomial(coefficients: impl DoubleEndedIterator<Item = f64>, w: f64) -> Complex {
    coefficients.rev().fold(Complex(0.0, 0.0), |sum, c| Complex(c - w * sum.1, w * sum.0))
}

/// The loop at one point: dead times with the coefficients of the powers of `s`, that of zero first.
struct RoundedPoint {
    terms: Vec<(f64, Vec<f64>)>,
}

impl RoundedPoint {
    /// The value, and the sum of the moduli of its terms.
    fn value(&self, w: f64) -> (Complex, f64) {
        self.terms.iter().fold((Complex(0.0, 0.0), 0.0), |(sum, size), (tau, part)| {
            let own = polynomial(part.iter().copied(), w);
            let turned = own.times(Complex((w * tau).cos(), -(w * tau).sin()));
            (sum.plus(turned), size + own.size())
        })
    }

    fn by_frequency(&self, w: f64) -> Complex {
        let one = |(tau, part): &(f64, Vec<f64>)| {
            let turn = Complex((w * tau).cos(), -(w * tau).sin());
            // d/dw p(i w) = i p'(i w).
            let slope = polynomial(part.iter().enumerate().skip(1).map(|(j, c)| c * j as f64), w);
            let own = polynomial(part.iter().copied(), w).times(Complex(0.0, -tau));
            slope.times(Complex(0.0, 1.0)).plus(own).times(turn)
        };
        self.terms.iter().map(one).fold(Complex(0.0, 0.0), Complex::plus)
    }

    fn order(&self) -> usize {
        self.terms.iter().filter_map(|(_, part)| part.iter().rposition(|c| *c != 0.0)).max().unwrap_or(0)
    }

    /// A frequency beyond which the highest undelayed power of `s` outweighs all others.
    fn bound(&self) -> Option<f64> {
        let n = self.order();
        let top = self.terms[0].1.get(n).copied().unwrap_or(0.0).abs();
        let sum = |j: usize| self.terms.iter().filter_map(|(_, part)| part.get(j)).map(|c| c.abs()).sum::<f64>();
        let sums: Vec<f64> = (0..n).map(sum).collect();
        let rest = sum(n) - top;
        let lower = |w: f64| sums.iter().enumerate().map(|(j, c)| c * w.powi(j as i32 - n as i32)).sum::<f64>();
        if rest > LARGEST_DELAYED_SHARE * top {
            return None;
        }
        (-60..200).map(|e| 2f64.powi(e)).find(|w| lower(*w) + rest < top)
    }

    /// How many roots seem to lie to the right of the axis, and the frequency of the value nearest to zero.
    fn right(&self) -> (Option<i64>, f64) {
        let Some(end) = self.bound() else { return (None, 0.0) };
        let slowest = self.terms.iter().map(|(tau, _)| tau.abs()).fold(0.0, f64::max);
        let n = self.order();
        let (mut w, mut step, mut total) = (0.0, end / 64.0, 0.0);
        let (mut value, _) = self.value(0.0);
        if value.0 == 0.0 {
            return (None, 0.0);
        }
        let (mut least, mut nearest) = (f64::INFINITY, 0.0);
        for k in 0..MOST_STEPS {
            if k % 64 == 0 {
                checkpoint(64);
            }
            if w >= end {
                let top = self.terms[0].1[n];
                let powers = [Complex(top, 0.0), Complex(0.0, top), Complex(-top, 0.0), Complex(0.0, -top)];
                total += powers[n % 4].turned_from(value);
                let right = (n as f64 * FRAC_PI_2 - total) / PI;
                return (Some(right.round() as i64), nearest);
            }
            let next = (w + step).min(end);
            let (other, size) = self.value(next);
            let turn = other.turned_from(value);
            if turn.abs() > LARGEST_TURN && step > 1e-14 * next {
                step *= 0.5;
                continue;
            }
            total += turn;
            if other.size() < least * size {
                (least, nearest) = (other.size() / size, next);
            }
            (w, value) = (next, other);
            if turn.abs() < 0.3 {
                step *= 2.0;
            }
            step = step.min(0.5 * w + 1e-6 * end);
            let delayed = size - polynomial(self.terms[0].1.iter().copied(), w).size();
            if 3.0 * delayed > size {
                step = step.min(0.5 / slowest);
            }
        }
        (None, nearest)
    }
}
