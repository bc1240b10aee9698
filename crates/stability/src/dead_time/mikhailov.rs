//! How many roots a loop with dead time has to the right of the imaginary axis: the principle of the argument with
//! certified bounds.

use super::dyadic::{Dyadic, Step};
use super::family_function::{exponential, upper_exponential};
use super::turn::{Fixed, turned};
use super::{Kind, QuasiPolynomial};
use crate::precisions::ARGUMENT_ALONG_AXIS;
use crate::{Shape, count_roots};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};

/// Why there is no count.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotCounted {
    /// The budget ran out.
    Stopped(Exhausted),
    /// A loop of neutral type with several delays in the highest power of `s`, whose sum is not below what is undelayed.
    Neutral,
}

impl From<Exhausted> for NotCounted {
    fn from(exhausted: Exhausted) -> Self {
        NotCounted::Stopped(exhausted)
    }
}

/// The order of the Taylor polynomials.
const TERMS: usize = 3;

/// The number of roots to the right of the imaginary axis at a rational dead time: exactly.
///
/// The function is to have no root on the axis but those at `s = 0`, whose number is given, and the coefficient without
/// delay is to outweigh the others in its difference operator. Beyond a bound the highest power of `s` then outweighs the
/// rest in the closed right half plane. Up to it the axis is covered by intervals in which a Taylor polynomial with a bound
/// of its remainder keeps the function in a cone about its value in the middle, so that its argument is followed from
/// quarter turn to quarter turn: integers come out, nothing is rounded.
///
/// Cost: an evaluation of the function and two derivatives on each interval, whose length is in proportion to the
/// function's distance from zero.
///
/// # Errors
/// [`NotCounted`].
pub(super) fn roots_right(
    p: &QuasiPolynomial,
    tau: &Rational,
    at_zero: usize,
    budget: &Budget,
) -> Result<usize, NotCounted> {
    let n = p.order();
    if p.delays() == 0 || tau.is_zero() {
        return Ok(count_roots(&p.without_delay(), Shape::LeftHalfPlane).outside);
    }
    if !p.is_dominated() {
        return Err(NotCounted::Neutral);
    }
    Ok(budget.enter(|| Walk::new(p, tau, n, &Rational::ZERO).follow(at_zero, budget))??)
}

/// The same from another line: `z = exp(growth - tau s)`; `None` for infinitely many.
///
/// # Errors
/// [`NotCounted`]; with a growth a root on the line shows as precision that does not suffice.
pub(super) fn roots_right_of_line(
    p: &QuasiPolynomial,
    tau: &Rational,
    growth: &Rational,
    budget: &Budget,
) -> Result<Option<usize>, NotCounted> {
    if growth.is_zero() || p.delays() == 0 {
        return roots_right(p, tau, 0, budget).map(Some);
    }
    if p.kind() == Kind::Advanced {
        return Ok(None);
    }
    let walk = budget.enter(|| Walk::new(p, tau, p.order(), growth))?;
    if !walk.is_dominated() {
        return Err(NotCounted::Neutral);
    }
    Ok(Some(budget.enter(|| walk.follow(0, budget))??))
}

/// The derivatives by `s`: the parts of `sum P_k z^k` become `P_k' - k tau P_k`, over a power of the denominator of tau.
pub(super) fn derivatives(p: &QuasiPolynomial, tau: &Rational, orders: usize) -> Vec<Vec<UniPoly>> {
    let (a, d) = (tau.numerator(), tau.denominator());
    let mut out = vec![p.parts().to_vec()];
    for j in 0..orders {
        let next = out[j]
            .iter()
            .enumerate()
            .map(|(k, part)| part.derivative().scaled(&d).minus(&part.scaled(&(&a * &Integer::from(k as i64)))));
        let next = next.collect();
        out.push(next);
    }
    out
}

/// The exact order of the zero at `s = 0` and the sign of the first derivative that does not vanish there.
pub(super) fn zero_at_origin(p: &QuasiPolynomial, tau: &Rational) -> (usize, bool) {
    // Of n + 1 parts' values at most (n + 1)(q + 1) - 1 derivatives vanish together.
    let most = (p.order() + 1) * (p.delays() + 1);
    let mut parts = derivatives(p, tau, 0).remove(0);
    let (a, d) = (tau.numerator(), tau.denominator());
    for order in 0..=most {
        let value = parts.iter().fold(Integer::ZERO, |sum, part| sum + part.coeff(0));
        if !value.is_zero() {
            return (order, value.is_negative());
        }
        parts = parts
            .iter()
            .enumerate()
            .map(|(k, part)| part.derivative().scaled(&d).minus(&part.scaled(&(&a * &Integer::from(k as i64)))))
            .collect();
    }
    unreachable!("an exponential polynomial that is not zero has a zero of finite order")
}

/// The way along the axis.
struct Walk<'p> {
    p: &'p QuasiPolynomial,
    tau: &'p Rational,
    n: usize,
    derivatives: Vec<Vec<UniPoly>>,
    scale: u64,
    /// `z = exp(growth - tau s)`.
    growth: &'p Rational,
    /// Upper bounds of `|z^k|` on the axis.
    weights: Vec<Rational>,
}

impl<'p> Walk<'p> {
    fn new(p: &'p QuasiPolynomial, tau: &'p Rational, n: usize, growth: &'p Rational) -> Self {
        let one = if growth.is_zero() { Rational::ONE } else { upper_exponential(growth) };
        let weights = (0..p.parts().len()).map(|k| one.pow(k as i64).expect("not zero")).collect();
        Walk { p, tau, n, derivatives: derivatives(p, tau, TERMS), scale: ARGUMENT_ALONG_AXIS.first, growth, weights }
    }

    /// Whether the coefficient without delay outweighs the sum of the others in the difference operator, on the line.
    fn is_dominated(&self) -> bool {
        let top = self.p.difference();
        let weighted = |(c, weight): (&Integer, &Rational)| Rational::from(&c.abs()) * weight;
        let rest = top.coeffs().iter().zip(&self.weights).skip(1).map(weighted).fold(Rational::ZERO, |sum, x| sum + x);
        rest < Rational::from(&top.coeff(0).abs())
    }

    fn follow(mut self, at_zero: usize, budget: &Budget) -> Result<usize, Exhausted> {
        budget.step("counting roots along the imaginary axis");
        let top = self.p.difference().coeff(0);
        let bound = self.bound();
        let (start, order, negative) = self.start(at_zero, &bound)?;
        assert_eq!(order, at_zero);
        let first = if negative { 2 } else { 0 };
        let mut direction = first + order as i64;
        let mut at = start;
        let mut step = Step(bound.bit_length() as i64 - 4);
        let end = Rational::from(&bound);
        while at.rational() < end {
            budget.check()?;
            let middle = at.plus(step, 1);
            match self.cone(&middle, step)? {
                Some(next) => {
                    // Less than half a turn from the last direction: nearer by quarters than by any other way.
                    let turn = (next - direction).rem_euclid(4);
                    direction += match turn {
                        0 => 0,
                        1 => 1,
                        3 => -1,
                        _ => unreachable!("neighbouring cones are less than half a turn apart"),
                    };
                    at = at.plus(step, 0);
                    step = Step(step.0 + 1);
                }
                None => step = Step(step.0 - 1),
            }
        }
        // Beyond the bound the function is in the open half plane about the highest power.
        let highest = (self.n as i64 + if top.is_negative() { 2 } else { 0 }).rem_euclid(4);
        direction += match (highest - direction).rem_euclid(4) {
            0 => 0,
            1 => 1,
            3 => -1,
            _ => unreachable!("the last cone is less than half a turn from the highest power"),
        };
        let twice = self.n as i64 - direction + first;
        assert!(twice >= 0 && twice % 2 == 0, "the argument grows by whole half turns");
        Ok((twice / 2) as usize)
    }

    /// A power of two beyond which the highest power of `s` without delay outweighs all other terms.
    fn bound(&self) -> Integer {
        let mut r = Integer::ONE;
        loop {
            let sum = |p: &UniPoly| {
                let absolute = UniPoly::new(p.coeffs().iter().map(Integer::abs).collect());
                absolute.eval(&r)
            };
            let weighted = |(part, weight): (&UniPoly, &Rational)| Rational::from(&sum(part)) * weight;
            let all = self.p.parts().iter().zip(&self.weights).map(weighted).fold(Rational::ZERO, |total, x| total + x);
            let top = self.p.difference().coeff(0).abs() * r.pow(self.n as u64);
            if all < Rational::from(&(&top + &top)) {
                return r;
            }
            r = r << 1;
        }
    }

    /// A point up to which the function stays in a cone about its first power of `s`, that power, and whether its
    /// coefficient is negative.
    fn start(&mut self, at_zero: usize, bound: &Integer) -> Result<(Dyadic, usize, bool), Exhausted> {
        if at_zero == 0 && self.growth.is_zero() {
            let value = self.p.parts().iter().fold(Integer::ZERO, |sum, part| sum + part.coeff(0));
            return Ok((Dyadic::zero(), 0, value.is_negative()));
        }
        if at_zero == 0 {
            loop {
                let value = &self.values(&Dyadic::zero())[0];
                if value.re.abs() > value.error {
                    return Ok((Dyadic::zero(), 0, value.re.is_negative()));
                }
                self.finer()?;
            }
        }
        let (order, negative) = zero_at_origin(self.p, self.tau);
        let sets = derivatives(self.p, self.tau, order + 1);
        let first = sets[order].iter().fold(Integer::ZERO, |sum, part| sum + part.coeff(0)).abs();
        // f(i w)/(i w)^m differs from its value at 0 by at most w max |f^(m+1)|/(m+1)!.
        let factor = Rational::from(&(&self.tau.denominator() * &Integer::from(order as i64 + 1)));
        let mut e = 0u64;
        loop {
            let point = Dyadic { m: Integer::ONE, e };
            let slope = absolute_at(&sets[order + 1], &point.rational());
            if point.rational() <= Rational::from(bound)
                && slope * point.rational() * Rational::from(3) < Rational::from(&(&first + &first)) * &factor
            {
                return Ok((point, order, negative));
            }
            e += 1;
        }
    }

    /// The quarter turn that is within 47 degrees of the function's value in the middle of an interval, if the function
    /// stays within 41.9 degrees of that value on the interval.
    fn cone(&mut self, middle: &Dyadic, step: Step) -> Result<Option<i64>, Exhausted> {
        loop {
            let values = self.values(middle);
            let thirty_two = &values[0].error << 5;
            let (re, im) = (&values[0].re, &values[0].im);
            let (wide, high) = (re.abs(), im.abs());
            let largest = if wide > high { &wide } else { &high };
            if thirty_two > *largest {
                // Too little is known of the value: it may be the function that is small, or the precision.
                self.finer()?;
                continue;
            }
            // |f - f(m)| <= |f'| r + |f''| r^2/2 + max |f'''| r^3/6 with r = 2^(power - 1), in units of 2^-scale.
            let d = self.tau.denominator();
            let half = step.half();
            let over = Rational::from(&d);
            let ratio = &half / &over;
            let r2 = &ratio * &ratio;
            let far = middle.rational() + &half;
            let rest = weighted_at(&self.derivatives[TERMS], &self.weights, &far)
                * Rational::from(&(&Integer::ONE << self.scale));
            let moved = Rational::from(&values[1].at_most()) * &ratio
                + Rational::from(&values[2].at_most()) * &r2 * Rational::dyadic(&Integer::ONE, 1)
                + rest * r2 * ratio * Rational::new(Integer::ONE, Integer::from(6));
            if moved * Rational::from(3) >= Rational::from(&(&values[0].at_least() << 1)) {
                return Ok(None);
            }
            let direction = match (wide > high, re.is_negative(), im.is_negative()) {
                (true, false, _) => 0,
                (false, _, false) => 1,
                (true, true, _) => 2,
                (false, _, true) => 3,
            };
            return Ok(Some(direction));
        }
    }

    /// Twice the bits, while there are any.
    fn finer(&mut self) -> Result<(), Exhausted> {
        self.scale *= 2;
        if self.scale > ARGUMENT_ALONG_AXIS.last {
            return Err(ARGUMENT_ALONG_AXIS.exhausted("counting roots along the imaginary axis"));
        }
        Ok(())
    }

    /// The function and its derivatives but the last at `i omega`, in units of `2^-scale`.
    fn values(&self, omega: &Dyadic) -> Vec<Fixed> {
        let scale = self.scale;
        let mut z = turned(&(omega.rational() * self.tau), scale + 8);
        if !self.growth.is_zero() {
            z = z.times(&exponential(self.growth, scale + 8), scale + 8);
        }
        let mut powers = vec![Fixed::one(scale + 8)];
        for _ in 0..self.p.delays() {
            let last = powers.last().expect("there is a first one");
            powers.push(last.times(&z, scale + 8));
        }
        let at = |parts: &[UniPoly]| {
            let zero = Fixed { re: Integer::ZERO, im: Integer::ZERO, error: Integer::ZERO };
            parts.iter().zip(&powers).fold(zero, |sum, (part, power)| {
                let value = on_axis(part, omega, scale);
                // Powers have eight bits more; the product has the scale of the value.
                sum.plus(&value.times(power, scale + 8))
            })
        };
        self.derivatives[..TERMS].iter().map(|parts| at(parts)).collect()
    }
}

/// `p(i omega)` in units of `2^-scale`.
fn on_axis(p: &UniPoly, omega: &Dyadic, scale: u64) -> Fixed {
    let Some(n) = p.degree() else {
        return Fixed { re: Integer::ZERO, im: Integer::ZERO, error: Integer::ZERO };
    };
    let (mut re, mut im) = (Integer::ZERO, Integer::ZERO);
    let mut power = Integer::ONE;
    for (j, c) in p.coeffs().iter().enumerate() {
        let term = (c * &power) << (omega.e * (n - j) as u64);
        match j % 4 {
            0 => re += term,
            1 => im += term,
            2 => re -= term,
            _ => im -= term,
        }
        power = &power * &omega.m;
    }
    let shift = omega.e * n as u64;
    let scaled = |x: Integer| if shift >= scale { x >> (shift - scale) } else { x << (scale - shift) };
    Fixed { re: scaled(re), im: scaled(im), error: Integer::ONE }
}

/// The sum of the moduli of all terms at `omega`, where `|z| = 1`.
fn absolute_at(parts: &[UniPoly], omega: &Rational) -> Rational {
    let n = parts.iter().filter_map(UniPoly::degree).max().unwrap_or(0);
    let mut sums = vec![Integer::ZERO; n + 1];
    for part in parts {
        for (j, c) in part.coeffs().iter().enumerate() {
            sums[j] = &sums[j] + &c.abs();
        }
    }
    UniPoly::new(sums).eval_rational(omega)
}

/// The sum of the moduli of all terms at `omega`, where `|z^k|` is at most its weight.
fn weighted_at(parts: &[UniPoly], weights: &[Rational], omega: &Rational) -> Rational {
    if weights.iter().all(|w| *w == Rational::ONE) {
        return absolute_at(parts, omega);
    }
    let one = |(part, weight): (&UniPoly, &Rational)| absolute_at(std::slice::from_ref(part), omega) * weight;
    parts.iter().zip(weights).map(one).fold(Rational::ZERO, |sum, x| sum + x)
}
