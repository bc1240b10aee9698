//! A frequency at which a loop with dead time can have roots on the imaginary axis, enclosed.

use super::clock::Clock;
use super::interval::Interval;
use super::number::{Q, Z};
use super::univariate::Uni;
use num_bigint::Sign;
use num_traits::{One, Signed};

/// A root `i omega` of `P_0 + P_1 z`, `|z| = 1`, simple in `omega^2`.
pub(super) struct Crossing {
    /// Whether roots move to the right there while the dead time grows, or to the left.
    pub is_gain: bool,
    /// Whether `z = 1` exactly.
    pub is_one: bool,
    pub omega: Interval,
    /// The angle of `1/z` in `[0, 2 pi)`.
    theta: Interval,
    /// `2 pi`.
    pub turn: Interval,
    bits: usize,
}

impl Crossing {
    /// The one between `a` and `b`, where `f(omega^2) = |P_0|^2 - |P_1|^2` changes its sign.
    pub fn new(p: [&Uni; 2], f: &Uni, a: &Q, b: &Q, bits: usize, clock: &Clock) -> Result<Self, String> {
        let (below, above) = (f.numerator_at(a, clock)?.sign(), f.numerator_at(b, clock)?.sign());
        if !a.is_positive() || below == Sign::NoSign || above == Sign::NoSign || below == above {
            return Err("there is no change of sign between the ends".into());
        }
        let (lo, hi) = (Interval::rational(a, bits).lo, Interval::rational(b, bits).hi);
        let omega = Interval { lo: (&lo << bits).sqrt(), hi: (&hi << bits).sqrt() + 1 };
        let square = Interval { lo, hi };
        // z = -P_0/P_1: the angle of 1/z is that of x + i omega y.
        let [(e0, o0), (e1, o1)] = p.map(even_odd);
        let x = e0.times(&e1).plus(&o0.times(&o1).shifted_up(1)).scaled(&-Z::one());
        let y = o0.times(&e1).minus(&e0.times(&o1));
        let value = |g: &Uni| {
            let coefficients = g.0.iter().rev();
            coefficients.fold(Interval::zero(), |sum, c| sum.times(&square, bits).plus(&Interval::integer(c, bits)))
        };
        let (at_x, at_y) = (value(&x), value(&y).times(&omega, bits));
        let pi = inverse_tangent(&(Z::one() << bits), bits).scaled(&Z::from(4));
        let turn = pi.scaled(&Z::from(2));
        let half = pi.narrowed(1);
        let unknown = || "the angle of a crossing is not certain".to_owned();
        let quotient = |a: &Interval, b: &Interval| a.divided(b, bits).ok_or_else(unknown).map(|t| arc(&t, bits));
        let mut is_one = false;
        let theta = match (at_x.sign(), at_y.sign()) {
            // z is 1 or -1, by an identity.
            (Some(Sign::Plus), _) if y.is_zero() => {
                is_one = true;
                Interval::zero()
            }
            (Some(Sign::Minus), _) if y.is_zero() => pi,
            (Some(Sign::Minus), _) => pi.plus(&quotient(&at_y, &at_x)?),
            (Some(Sign::Plus), Some(Sign::Plus)) => quotient(&at_y, &at_x)?,
            (Some(Sign::Plus), Some(Sign::Minus)) => turn.plus(&quotient(&at_y, &at_x)?),
            (_, Some(Sign::Plus)) => half.minus(&quotient(&at_x, &at_y)?),
            (_, Some(Sign::Minus)) => pi.plus(&half).minus(&quotient(&at_x, &at_y)?),
            _ => return Err(unknown()),
        };
        Ok(Crossing { is_gain: above == Sign::Plus, is_one, omega, theta, turn, bits })
    }

    /// `(theta + 2 pi k)/omega`.
    pub fn dead_time(&self, k: usize) -> Result<Interval, String> {
        let angle = self.theta.plus(&self.turn.scaled(&Z::from(k)));
        angle.divided(&self.omega, self.bits).ok_or_else(|| "a frequency is not told from zero".to_owned())
    }
}

/// `E`, `O` in `omega^2` with `p(i omega) = E + i omega O`.
pub(super) fn even_odd(p: &Uni) -> (Uni, Uni) {
    let part = |from: usize| {
        let signed = |(k, c): (usize, &Z)| if k % 2 == 1 { -c } else { c.clone() };
        Uni::new(p.0.iter().skip(from).step_by(2).enumerate().map(signed).collect())
    };
    (part(0), part(1))
}

/// `|p(i omega)|^2` in `omega^2`.
pub(super) fn square_of_modulus(p: &Uni) -> Uni {
    let (e, o) = even_odd(p);
    e.times(&e).plus(&o.times(&o).shifted_up(1))
}

fn arc(x: &Interval, bits: usize) -> Interval {
    Interval { lo: inverse_tangent(&x.lo, bits).lo, hi: inverse_tangent(&x.hi, bits).hi }
}

/// The arctangent of a number over `2^bits`. The argument is made small by `atan x = 2 atan(x/(1 + sqrt(1 + x^2)))`; the
/// terms of the alternating series then fall, and what is left out is less than the first of them.
fn inverse_tangent(x: &Z, bits: usize) -> Interval {
    const HALVINGS: usize = 8;
    let one = Z::one() << bits;
    let (mut lo, mut hi) = (x.abs(), x.abs());
    for _ in 0..HALVINGS {
        let below = &one + (&one * &one + &lo * &lo).sqrt() + 1;
        let above = &one + (&one * &one + &hi * &hi).sqrt();
        lo = (lo << bits) / below;
        hi = ((hi << bits) + &above - 1) / above;
    }
    let mut power = Interval { lo, hi };
    let square = power.times(&power, bits);
    let mut sum = Interval::zero();
    let mut k = 1_u64;
    loop {
        let divisor = Z::from(k);
        let term = Interval { lo: &power.lo / &divisor, hi: (&power.hi + &divisor - 1) / &divisor };
        sum = if k % 4 == 1 { sum.plus(&term) } else { sum.minus(&term) };
        power = power.times(&square, bits);
        k += 2;
        if power.hi <= Z::one() {
            break;
        }
    }
    sum.lo -= 2;
    sum.hi += 2;
    let sum = Interval { lo: sum.lo << HALVINGS, hi: sum.hi << HALVINGS };
    if x.is_negative() { sum.negated() } else { sum }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn four_times_the_angle_of_one_is_pi() {
        let pi = inverse_tangent(&(Z::one() << 128_usize), 128).scaled(&Z::from(4));
        let digits: Z = "314159265358979323846264338327950288".parse().unwrap();
        let scale = Z::from(10).pow(35);
        assert!(&pi.lo * &scale <= (&digits + 1) << 128_usize && &pi.hi * &scale >= digits << 128_usize);
        assert!(&pi.hi - &pi.lo < Z::one() << 20_usize);
    }

    /// `s^2 + 1 - z/5`: `z = 1` at `omega^2 = 4/5`, `z = -1` at `6/5`.
    #[test]
    fn exact_angles_are_exact() {
        let clock = Clock::new(Duration::MAX);
        let uni = |c: &[i64]| Uni::new(c.iter().map(|&c| Z::from(c)).collect());
        let (p, q) = (uni(&[5, 0, 5]), uni(&[-1]));
        let f = square_of_modulus(&p).minus(&square_of_modulus(&q));
        let ratio = |n: i64, d: i64| Q::new(n.into(), d.into());
        let at = |a: Q, b: Q| Crossing::new([&p, &q], &f, &a, &b, 128, &clock).unwrap();
        let (one, minus) = (at(ratio(7, 10), ratio(9, 10)), at(ratio(11, 10), ratio(3, 2)));
        assert!(one.is_one && !one.is_gain && one.theta == Interval::zero());
        assert!(!minus.is_one && minus.is_gain && minus.theta.scaled(&Z::from(2)) == minus.turn);
        assert!(Crossing::new([&p, &q], &f, &ratio(1, 10), &ratio(2, 10), 128, &clock).is_err());
    }
}
