//! The sum of absolute values as a rational number, where it is known which samples have which sign.
//!
//! Where all poles are 0 there are finitely many samples. Else let `l` be a real pole greater in modulus than `q`, and all others
//! smaller than `q`, as an exact count of roots shows. Then `H = c/(z - l) + G`, so `h_k = c l^(k-1) + g_k` from `k = 1` on, where `G(q z)` has
//! its poles inside of the unit circle: the sum `B` of the absolute values of its impulse response `g_k q^-k` is finite, and `|g_k| <= B q^k`.
//! For positive `l` the sign of `h_k` is that of `c` from the first `k` on at which `|c| l^(k-1) > B q^k`. The samples before that are computed as rational numbers,
//! and the sum is that of all samples, `H(1)` with the sign of `c`, and twice those of the other sign. For negative `l` the same holds of `H(-z)`,
//! whose samples are `(-1)^k h_k`.

use super::bracket::rough_bound;
use super::coefficients::Monic;
use crate::root_count::count_roots;
use crate::{RootCount, Shape};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};
use std::cmp::Ordering;
use std::collections::VecDeque;

/// The most samples that are computed as rational numbers.
const MOST_SAMPLES: usize = 400;

/// The most bits of a sum that is worth to be printed: a thousand digits.
const MOST_BITS: u64 = 3300;

/// The most bits of a sample: more would cost more than the enclosed sum.
const MOST_BITS_OF_SAMPLES: u64 = 40_000;

/// Poles beyond which no pole is looked for that is greater than the others: it would cost more than the enclosed sum.
const MOST_POLES: usize = 24;

/// Trials of a number between the greatest pole and the others: nearer to that pole each time.
const TRIALS: u32 = 7;

/// Bits of what bounds the other poles' part.
const BITS: u64 = 192;

/// The sum, and how many samples were computed; `None` where no proof is found.
pub(super) fn sum(numerator: &UniPoly, denominator: &UniPoly) -> Option<(Rational, usize)> {
    if numerator.is_zero() {
        return Some((Rational::ZERO, 0));
    }
    if denominator.coeffs().iter().rev().skip(1).all(Integer::is_zero) {
        let leading = denominator.leading().expect("the denominator is not zero").abs();
        let above = numerator.coeffs().iter().fold(Integer::ZERO, |sum, c| sum + c.abs());
        return Some((Rational::new(above, leading), denominator.coeffs().len()));
    }
    if denominator.coeffs().len() > MOST_POLES + 1 {
        return None;
    }
    let greatest = greatest_real_pole(denominator)?;
    if greatest.sign().is_gt() {
        return sum_over(numerator, denominator, &greatest);
    }
    let [numerator, denominator] = [numerator, denominator].map(UniPoly::negated_argument);
    sum_over(&numerator, &denominator, &greatest.negated())
}

/// The real pole of greatest modulus; `None` where there is none, or two of them are.
fn greatest_real_pole(denominator: &UniPoly) -> Option<RealAlgebraic> {
    // The budget that was entered ends this.
    let roots = isolate_real_roots(&SquareFree::part_of(denominator)?, &Budget::unlimited()).ok()?;
    let (first, last) = (roots.first()?, roots.last()?);
    let opposite = first.negated();
    match opposite.compare(last) {
        Ordering::Less => Some(last.clone()),
        Ordering::Greater => Some(first.clone()),
        Ordering::Equal => None,
    }
}

/// The sum where a positive pole may be greater than the others.
fn sum_over(numerator: &UniPoly, denominator: &UniPoly, pole: &RealAlgebraic) -> Option<(Rational, usize)> {
    let is_negative = denominator.leading().is_some_and(Integer::is_negative);
    let [numerator, denominator] = &[numerator, denominator].map(|p| if is_negative { p.negated() } else { p.clone() });
    let between = between(denominator, pole)?;
    let parts = Parts::of(numerator, denominator, pole);
    let (sign, count) = parts.first_of_one_sign(pole, &between)?;
    let others = samples_of_other_sign(numerator, denominator, sign, count)?;
    let one = Rational::ONE;
    let all = numerator.eval_rational(&one).checked_div(&denominator.eval_rational(&one));
    let all = all.expect("1 is no pole of a stable transfer function");
    let all = if sign.is_lt() { -all } else { all };
    let sum = all + Rational::from(2) * others;
    let is_short = sum.numerator().bit_length().max(sum.denominator().bit_length()) <= MOST_BITS;
    is_short.then_some((sum, count))
}

/// A number below the pole, above all others in modulus.
fn between(denominator: &UniPoly, pole: &RealAlgebraic) -> Option<Rational> {
    let degree = denominator.coeffs().len() - 1;
    let below = pole.refined_to_digits(12).enclosure().0;
    let wanted = RootCount { inside: degree - 1, on: 0, outside: 1 };
    let trial = |i: u32| {
        let near = &below * &(Rational::ONE - Rational::dyadic(&Integer::ONE, u64::from(i)));
        // Few digits keep the count cheap.
        let bits = 12 + u64::from(i) + near.denominator().bit_length().saturating_sub(near.numerator().bit_length());
        let q = Rational::dyadic(&(&near * &Rational::from(Integer::ONE << bits)).floor(), bits);
        let scaled = in_units_of(denominator, &q);
        (count_roots(&scaled, Shape::UnitDisc) == wanted).then_some(q)
    };
    (1..=TRIALS).find_map(trial)
}

/// `p(q z)` times a power of the denominator of `q`.
fn in_units_of(p: &UniPoly, q: &Rational) -> UniPoly {
    let n = p.coeffs().len() as u64;
    let (above, below) = (q.numerator(), q.denominator());
    let term = |(k, c): (usize, &Integer)| c * &(above.pow(k as u64) * below.pow(n - k as u64));
    UniPoly::new(p.coeffs().iter().enumerate().map(term).collect())
}

/// `H = c/(z - l) + G`.
struct Parts {
    factor: Ball,
    numerator: Vec<Ball>,
    denominator: Vec<Ball>,
}

impl Parts {
    /// With `D = (z - l) E`: `c = N(l)/E(l)`, and `G = ((N - c E)/(z - l))/E`.
    fn of(numerator: &UniPoly, denominator: &UniPoly, pole: &RealAlgebraic) -> Parts {
        let balls = |p: &UniPoly| p.coeffs().iter().map(|c| Ball::from_integer(c, BITS)).collect::<Vec<_>>();
        let (lo, hi) = pole.refined(&Rational::dyadic(&Integer::ONE, BITS)).enclosure();
        let pole = Ball::between(&lo, &hi, BITS);
        let (below, _) = divided(&balls(denominator), &pole);
        let above = balls(numerator);
        let (at_pole, below_at_pole) = (divided(&above, &pole).1, divided(&below, &pole).1);
        // A simple pole: where its ball tells nothing, a ball around 0 gives no sign.
        let factor = at_pole.div(&below_at_pole).unwrap_or_else(|| Ball::from_units((-1).into(), 1.into(), BITS));
        let zero = Ball::zero(BITS);
        let longest = above.len().max(below.len());
        let difference = |k: usize| {
            let e = below.get(k).unwrap_or(&zero);
            above.get(k).unwrap_or(&zero).sub(&factor.mul(e))
        };
        let (rest, _) = divided(&(0..longest).map(difference).collect::<Vec<_>>(), &pole);
        Parts { factor, numerator: rest, denominator: below }
    }

    /// The sign of all samples from an index on that is not 0; `None` where that is beyond [`MOST_SAMPLES`], or not told.
    fn first_of_one_sign(&self, pole: &RealAlgebraic, q: &Rational) -> Option<(Sign, usize)> {
        let sign = self.factor.sign().filter(|sign| !sign.is_eq())?;
        let bound = self.bound_of_rest(q)?;
        let l = Ball::from_rational(&pole.refined_to_digits(30).enclosure().0, BITS);
        let ratio = l.div(&Ball::from_rational(q, BITS))?;
        // |c| (l/q)^k > B l, where l < 1.
        let factor = Ball::from_units(self.factor.least_magnitude_units(), self.factor.magnitude_units(), BITS);
        let mut left = factor;
        for k in 0..MOST_SAMPLES {
            if k > 0 && left.lower() > bound {
                return Some((sign, k));
            }
            left = left.mul(&ratio);
        }
        None
    }

    /// The upper bound of the sum of `|g_k| q^-k`.
    fn bound_of_rest(&self, q: &Rational) -> Option<Rational> {
        let q = Ball::from_rational(q, BITS);
        let scaled =
            |p: &[Ball]| -> Vec<Ball> { p.iter().enumerate().map(|(k, c)| c.mul(&q.power(k as u64))).collect() };
        rough_bound(&Monic::of_balls(scaled(&self.numerator), scaled(&self.denominator))?)
    }
}

/// The quotient by `z - l` and the value at `l`, by Horner's scheme.
fn divided(p: &[Ball], l: &Ball) -> (Vec<Ball>, Ball) {
    let mut value = Ball::zero(l.bits());
    let mut quotient = Vec::with_capacity(p.len());
    for c in p.iter().rev() {
        quotient.push(value.clone());
        value = value.mul(l).add(c);
    }
    quotient.reverse();
    quotient.pop();
    (quotient, value)
}

/// The sum of the absolute values of those of the first samples that have the other sign; `None` where they are long.
///
/// With the leading coefficient `d` of the denominator, which is positive, `d^(k+1) h_k` is an integer.
fn samples_of_other_sign(numerator: &UniPoly, denominator: &UniPoly, sign: Sign, count: usize) -> Option<Rational> {
    let n = denominator.coeffs().len() - 1;
    let leading = &denominator.coeffs()[n];
    if leading.bit_length().saturating_mul(count as u64) > MOST_BITS_OF_SAMPLES {
        return None;
    }
    let below: Vec<Integer> = (1..=n).map(|i| denominator.coeff(n - i) * leading.pow(i as u64 - 1)).collect();
    let mut recent: VecDeque<Integer> = VecDeque::new();
    let (mut others, mut power) = (Integer::ZERO, Integer::ONE);
    for k in 0..count {
        checkpoint(4 * n as u64 + power.bit_length() / 16);
        let mut sample = if k <= n { numerator.coeff(n - k) * &power } else { Integer::ZERO };
        below.iter().zip(&recent).for_each(|(a, h)| sample.sub_mul_assign(a, h));
        power *= leading;
        others *= leading;
        if sample.sign() == sign.reverse() {
            others += sample.abs();
        }
        recent.push_front(sample);
        recent.truncate(n);
    }
    Some(Rational::new(others, power))
}
