//! Roots of discrete loops inside the logarithmic spiral of a damping, counted by the principle of the argument.
//!
//! A continuous pair `s = w (-d +- j sqrt(1 - d^2))` is sampled to `z = exp(s T)`: a damping of at least `d` is
//! `|z| <= exp(-c |arg z|)`, `c = d/sqrt(1 - d^2)`. The edge is `z = exp((-c + j) phi)`, `0 <= phi <= pi`, with its conjugate. But
//! for `z = 1` no point of it is algebraic, by the theorem of Gelfond and Schneider (`|z| = exp(j phi)^(j c)`), so that the
//! roots of a polynomial with rational coefficients are never on it: a count at a rational point ends. With other coefficients it may
//! end without an answer.

use super::near_point::Linear;
use super::spiral_over_box::{BoxOnSpiral, Spiral};
use crate::precisions::ROOTS_IN_SPIRAL;
use crate::stability::SymbolicPolynomial;
use jurist_algebra::ball::{Ball, cos_sin, exp};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::symbols::MovingSymbols;
use std::collections::HashMap;
use std::sync::{Arc as Shared, Mutex, PoisonError};

/// A complex number in balls.
#[derive(Clone, Debug)]
pub(super) struct Complex {
    pub re: Ball,
    pub im: Ball,
}

impl Complex {
    pub fn zero(bits: u64) -> Complex {
        Complex { re: Ball::zero(bits), im: Ball::zero(bits) }
    }

    pub fn plus(&self, other: &Complex) -> Complex {
        Complex { re: self.re.add(&other.re), im: self.im.add(&other.im) }
    }

    pub fn times(&self, other: &Complex) -> Complex {
        let re = self.re.mul(&other.re).sub(&self.im.mul(&other.im));
        let im = self.re.mul(&other.im).add(&self.im.mul(&other.re));
        Complex { re, im }
    }

    pub fn scaled(&self, by: &Ball) -> Complex {
        Complex { re: self.re.mul(by), im: self.im.mul(by) }
    }
}

/// A part of the edge: `phi/pi` from `at 2^-level` to `(at + 1) 2^-level`.
#[derive(Clone, Debug)]
pub(super) struct Arc {
    pub at: Integer,
    pub level: u64,
}

impl Arc {
    /// The lower and the upper half.
    pub fn parts(&self) -> [Arc; 2] {
        let first = &self.at << 1;
        let second = &first + &Integer::ONE;
        [first, second].map(|at| Arc { at, level: self.level + 1 })
    }

    /// The ends in parts of `pi`.
    pub fn ends(&self) -> [Rational; 2] {
        [self.at.clone(), &self.at + &Integer::ONE].map(|k| Rational::dyadic(&k, self.level))
    }
}

/// A value of the parameter, or all of an interval.
#[derive(Clone, Debug)]
pub(super) struct Values([Rational; 2]);

impl Values {
    pub fn of(value: &Rational) -> Values {
        Values([value.clone(), value.clone()])
    }

    pub fn between(lower: &Rational, upper: &Rational) -> Values {
        Values([lower.clone(), upper.clone()])
    }
}

/// The function of the angle and the parameter, and its derivatives, with balls of some width.
pub(super) struct Jet {
    pub value: Complex,
    pub by_angle: Complex,
    pub by_parameter: Complex,
}

/// `P(exp((-c + j) phi); K)`.
#[derive(Clone, Debug)]
pub(super) struct OnSpiral {
    /// Of the powers of `z`, and of those of `z - 1`: polynomials in the parameter and symbols. The roots of a loop with a short sample
    /// time are near to 1, where only the second ones tell how small the function is.
    coefficients: [Shared<[MultiPoly]>; 2],
    symbols: Shared<MovingSymbols>,
    damping: Rational,
    usual: Rational,
    /// Terms of the Taylor polynomials in the parameter: with a sample time that goes to 0 all coefficients vanish but one.
    terms: usize,
    /// The edge with so many bits.
    spirals: Shared<Mutex<HashMap<u64, Shared<Spiral>>>>,
}

/// Which number the powers are counted from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    Zero,
    One,
}

impl Origin {
    /// The nearer one to the points at some angles, in parts of pi: of less than a quarter all are nearer to 1.
    pub fn of(angles: &[Rational; 2]) -> Origin {
        if angles[1] <= Rational::dyadic(&Integer::ONE, 2) { Origin::One } else { Origin::Zero }
    }

    /// The distance from it.
    pub fn to(self, z: &Complex) -> Complex {
        let one = Ball::from_integer(&Integer::ONE, z.re.bits());
        match self {
            Origin::Zero => z.clone(),
            Origin::One => Complex { re: z.re.sub(&one), im: z.im.clone() },
        }
    }
}

/// The balls that depend on the precision alone.
#[derive(Debug)]
pub(super) struct Constants {
    pub bits: u64,
    pub pi: Ball,
    /// `c`.
    pub decay: Ball,
}

impl Constants {
    /// Of a damping, with so many bits.
    pub fn new(damping: &Rational, bits: u64) -> Constants {
        let square = damping * damping;
        let ratio = square.checked_div(&(Rational::ONE - &square)).expect("a damping is below 1");
        let decay = Ball::from_rational(&ratio, bits).sqrt().expect("positive");
        Constants { bits, pi: Ball::from_enclosure(&Enclosure::pi(bits + 4), bits), decay }
    }
}

/// The edge is cut into `2^FIRST_LEVEL` arcs at first.
pub(super) const FIRST_LEVEL: u64 = 5;

/// A count at a value cuts the edge into so many arcs at most. Where a root near the edge needs more arcs, the count is tried with more bits.
const MOST_ARCS: usize = 1 << 13;

impl OnSpiral {
    /// Of a closed loop in one parameter or none; `None` where a coefficient is not defined beside the parameter.
    pub fn of(p: &SymbolicPolynomial, damping: &Rational) -> Option<OnSpiral> {
        let one_more = Poly::new(vec![MultiPoly::one(), MultiPoly::one()]);
        let coefficients = [p.polynomial().clone(), p.polynomial().compose(&one_more)].map(|p| p.into_coeffs().into());
        let (symbols, usual) = (p.moving_symbols()?, p.usual().clone());
        let terms = if p.fixed_symbols().is_some() { 2 } else { p.formal_degree() + 2 };
        Some(OnSpiral { coefficients, symbols, damping: damping.clone(), usual, terms, spirals: Shared::default() })
    }

    /// The edge with so many bits.
    pub fn spiral(&self, bits: u64) -> Shared<Spiral> {
        let known = || self.spirals.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&bits) {
            return Shared::clone(found);
        }
        let found = Shared::new(Spiral::new(&self.damping, bits, bits));
        known().insert(bits, Shared::clone(&found));
        found
    }

    /// A usual value of the parameter.
    pub fn usual(&self) -> &Rational {
        &self.usual
    }

    /// The degree of the polynomial.
    pub fn degree(&self) -> usize {
        self.coefficients[0].len() - 1
    }

    /// The polynomial and its derivative by the parameter for all values; `None` where a coefficient is not defined for all of them.
    pub fn over<'s>(&self, Values([from, to]): &Values, spiral: &'s Spiral) -> Option<[BoxOnSpiral<'s>; 2]> {
        let bits = spiral.constants.bits;
        let both = |list: &[MultiPoly]| -> Option<(Vec<Linear>, Vec<Linear>)> {
            if from == to {
                let jets = self.symbols.jets(list, &Ball::from_rational(from, bits))?;
                return Some(
                    jets.iter().map(|[value, slope]| (Linear::anywhere(value), Linear::anywhere(slope))).unzip(),
                );
            }
            // f(from + t (to - from)) = f + s t + ...: terms that cancel do so in each coefficient.
            let taylor = self.symbols.taylor_from_end(list, from, to, self.terms, bits)?;
            let part = Ball::between(&Rational::ZERO, &Rational::ONE, bits);
            let length = Ball::from_rational(&(to - from), bits);
            let slope = |terms: &[Ball]| {
                let own = terms.iter().enumerate().skip(1).map(|(i, c)| c.scaled(&Integer::from(i as i64)));
                own.rev().fold(Ball::zero(bits), |sum, c| sum.mul(&part).add(&c)).div(&length)
            };
            taylor.iter().map(|terms| Some((Linear::of_share(terms), Linear::anywhere(&slope(terms)?)))).collect()
        };
        let [(from_zero, slopes_from_zero), (from_one, slopes_from_one)] =
            [both(&self.coefficients[0])?, both(&self.coefficients[1])?];
        let values = BoxOnSpiral::of([from_zero, from_one], spiral);
        Some([values, BoxOnSpiral::of([slopes_from_zero, slopes_from_one], spiral)])
    }

    /// The number of roots inside at a rational value at which 1 is no root.
    ///
    /// Cost: two evaluations of the polynomial on each arc; arcs shrink in proportion to the distance of the nearest root.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn count_at(&self, value: &Rational, budget: &Budget) -> Result<usize, Exhausted> {
        ROOTS_IN_SPIRAL.decide("counting roots inside a spiral", |bits| {
            budget.check()?;
            let spiral = self.spiral(bits);
            budget.enter(|| self.over(&Values::of(value), &spiral)?[0].count_by(MOST_ARCS))
        })
    }

    /// Function and derivatives at an angle, in parts of pi, and a value; `None` where a coefficient is not defined.
    pub fn at_point(&self, angle: &Rational, value: &Rational, bits: u64) -> Option<Jet> {
        // Only its numbers are asked for.
        let spiral = Spiral::new(&self.damping, bits, FIRST_LEVEL);
        let angles = [angle.clone(), angle.clone()];
        let [function, by_parameter] = self.over(&Values::of(value), &spiral)?.map(|own| own.on_arc(&angles));
        let ([value, by_angle], [by_parameter, _]) = (function, by_parameter);
        Some(Jet { value, by_angle, by_parameter })
    }
}

/// Whether a function vanishes at most once in a box of angles (in parts of pi) and values: its derivatives are independent, whatever they are
/// inside, which makes it one to one on a convex set.
pub(super) fn is_one_to_one([function, by_parameter]: &[BoxOnSpiral; 2], angles: &[Rational; 2]) -> bool {
    let ([_, by_angle], [by_parameter, _]) = (function.on_arc(angles), by_parameter.on_arc(angles));
    let determinant = by_angle.re.mul(&by_parameter.im).sub(&by_angle.im.mul(&by_parameter.re));
    !determinant.contains_zero()
}

/// `z` at an angle, in parts of pi.
pub(super) fn point(angle: &Rational, with: &Constants) -> Complex {
    let angle = Ball::from_rational(angle, with.bits).mul(&with.pi);
    let size = exp(&with.decay.mul(&angle).neg());
    let (cos, sin) = cos_sin(&angle);
    Complex { re: size.mul(&cos), im: size.mul(&sin) }
}
