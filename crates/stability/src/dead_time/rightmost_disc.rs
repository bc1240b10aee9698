//! Discs that are proved to hold one root of a quasi-polynomial.

use super::QuasiPolynomial;
use super::mikhailov::derivatives;
use super::rightmost_search::Approximate;
use crate::precisions::ROOT_OF_QUASI_POLYNOMIAL;
use jurist_algebra::ball::{Ball, cos_sin, exp};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{RootDisc, UniPoly};

/// A complex number in balls.
type Complex = [Ball; 2];

fn times([a, b]: &Complex, [c, d]: &Complex) -> Complex {
    [a.mul(c).sub(&b.mul(d)), a.mul(d).add(&b.mul(c))]
}

fn plus([a, b]: &Complex, [c, d]: &Complex) -> Complex {
    [a.add(c), b.add(d)]
}

/// An upper bound of the modulus.
fn at_most([re, im]: &Complex) -> Rational {
    let units = re.magnitude_units() + im.magnitude_units();
    Rational::dyadic(&units, re.bits())
}

/// A lower bound of the modulus.
fn at_least([re, im]: &Complex) -> Rational {
    Rational::dyadic(&re.least_magnitude_units().max(im.least_magnitude_units()), re.bits())
}

/// `f`, `d f'` and `d^2 f''`, where `d` is the denominator of the dead time.
pub(super) struct Enclosed<'p> {
    sets: Vec<Vec<UniPoly>>,
    /// How far the coefficients of the function may be off from those of `f`; none where they are exact.
    errors: &'p [UniPoly],
    tau: &'p Rational,
}

/// A centre in units of `2^-bits`.
struct Centre {
    re: Integer,
    im: Integer,
    bits: u64,
}

impl Centre {
    fn of(start: Approximate, bits: u64) -> Centre {
        let units = |x: f64| {
            let x = Rational::from_f64(x).unwrap_or(Rational::ZERO);
            (x * Rational::from(&(&Integer::ONE << bits))).floor()
        };
        Centre { re: units(start.re), im: units(start.im), bits }
    }

    fn ball(&self) -> Complex {
        [&self.re, &self.im].map(|x| Ball::from_units(x.clone(), x.clone(), self.bits))
    }

    fn with_bits(self, bits: u64) -> Centre {
        let more = bits - self.bits;
        Centre { re: self.re << more, im: self.im << more, bits }
    }

    /// Without the last bits, which depend on where the way began.
    fn rounded(&self, dropped: u64) -> Centre {
        let round = |x: &Integer| ((x + &(&Integer::ONE << (dropped - 1))) >> dropped) << dropped;
        Centre { re: round(&self.re), im: round(&self.im), bits: self.bits }
    }

    fn rational(&self) -> [Rational; 2] {
        [&self.re, &self.im].map(|x| Rational::dyadic(x, self.bits))
    }
}

impl<'p> Enclosed<'p> {
    pub fn new(p: &QuasiPolynomial, errors: &'p [UniPoly], tau: &'p Rational) -> Enclosed<'p> {
        Enclosed { sets: derivatives(p, tau, 2), errors, tau }
    }

    /// A disc about the root that an approximation is near to, whose radius is at most `relative` times its distance from zero: with
    /// exactly one root of the function, which is real if the centre is. `None` where no precision shows one.
    ///
    /// On a circle of radius `r` about `c` the function differs from `f(c) + f'(c) (s - c)` by at most `r^2/2` times the largest
    /// `|f''|`, and by how far it is off from `f`. Where that is less than the modulus of the linear function, both have as many zeros inside
    /// (Rouché).
    ///
    /// # Errors
    /// [`Exhausted`].
    pub fn disc(
        &self,
        start: Approximate,
        relative: &Rational,
        budget: &Budget,
    ) -> Result<Option<RootDisc>, Exhausted> {
        let mut last: Option<Centre> = None;
        ROOT_OF_QUASI_POLYNOMIAL.find(|bits| {
            budget.check()?;
            budget.enter(|| {
                let first = last.take().map_or_else(|| Centre::of(start, bits), |centre| centre.with_bits(bits));
                let centre = self.newton(first);
                let disc = self.proved(&centre, relative);
                last = Some(centre);
                disc
            })
        })
    }

    /// The same centre after steps of Newton's method.
    fn newton(&self, mut centre: Centre) -> Centre {
        let d = self.tau.denominator();
        // From 40 certain bits on they double.
        for _ in 0..4 + centre.bits.ilog2() {
            checkpoint(centre.bits / 16 + 1);
            let [value, slope] = self.values(&centre);
            let square = slope[0].square().add(&slope[1].square());
            let conjugate = [slope[0].clone(), slope[1].neg()];
            let step = times(&value, &conjugate);
            let [Some(re), Some(im)] = [step[0].scaled(&d).div(&square), step[1].scaled(&d).div(&square)] else {
                break;
            };
            let [re, im] = [re.middle_units(), im.middle_units()];
            let small = re.bit_length().max(im.bit_length()) < 8;
            centre = Centre { re: centre.re - re, im: centre.im - im, bits: centre.bits };
            if small {
                break;
            }
        }
        centre
    }

    /// A disc about a centre, if it is proved to hold one root and small.
    fn proved(&self, centre: &Centre, relative: &Rational) -> Option<RootDisc> {
        let centre = centre.rounded(centre.bits / 4);
        let [re, im] = centre.rational();
        let radius = self.radius(&centre)?;
        if !im.is_zero() && im.abs() <= radius {
            // Nearer to the real axis than it is known: real, or to be asked with more bits.
            let on_axis = Centre { re: centre.re, im: Integer::ZERO, bits: centre.bits };
            let radius = self.radius(&on_axis)?;
            let disc = RootDisc { re, im: Rational::ZERO, radius, count: 1, is_one: true, is_pair: false };
            return disc.is_fine(relative).then_some(disc);
        }
        let disc = RootDisc { re, is_pair: !im.is_zero(), im: im.abs(), radius, count: 1, is_one: true };
        disc.is_fine(relative).then_some(disc)
    }

    /// The radius of a disc with exactly one root; a power of two.
    fn radius(&self, centre: &Centre) -> Option<Rational> {
        let [value, slope] = self.values(centre);
        let d = Rational::from(&self.tau.denominator());
        let (value, slope) = (at_most(&value), at_least(&slope).checked_div(&d)?);
        // What the errors are in a disc that is hardly larger.
        let near = Rational::dyadic(&Integer::ONE, 4);
        let value = match self.errors.is_empty() {
            true => value,
            false => value + most(self.errors, self.tau, centre, &near),
        };
        let least = (&value + &value).checked_div(&slope)?.max(Rational::dyadic(&Integer::ONE, centre.bits));
        let exponent = least.numerator().bit_length() as i64 - least.denominator().bit_length() as i64 + 1;
        let radius = Rational::from(2).pow(exponent).expect("two is not zero");
        if !self.errors.is_empty() && radius > near {
            return None;
        }
        let curved = most(&self.sets[2], self.tau, centre, &radius).checked_div(&(&d * &d))?;
        let half = Rational::dyadic(&Integer::ONE, 1);
        (value + &radius * &radius * curved * half < slope * &radius).then_some(radius)
    }

    /// The function and `d` times its derivative.
    fn values(&self, centre: &Centre) -> [Complex; 2] {
        let bits = centre.bits;
        let s = centre.ball();
        let tau = Ball::from_rational(&-self.tau, bits);
        let size = exp(&s[0].mul(&tau));
        let (cos, sin) = cos_sin(&s[1].mul(&tau));
        let z = [size.mul(&cos), size.mul(&sin)];
        let zero = [Ball::zero(bits), Ball::zero(bits)];
        let at = |set: &Vec<UniPoly>| {
            // By Horner's scheme in both variables.
            set.iter().rev().fold(zero.clone(), |sum, part| {
                checkpoint(bits / 64 + 1);
                let value = part.coeffs().iter().rev().fold(zero.clone(), |value, c| {
                    let [re, im] = times(&value, &s);
                    [re.add(&Ball::from_integer(c, bits)), im]
                });
                plus(&times(&sum, &z), &value)
            })
        };
        [at(&self.sets[0]), at(&self.sets[1])]
    }
}

/// An upper bound of the modulus on a disc.
fn most(parts: &[UniPoly], tau: &Rational, centre: &Centre, radius: &Rational) -> Rational {
    /// Bits of a bound.
    const BITS: u64 = 64;
    let [re, im] = centre.rational();
    let size = Ball::from_rational(&(re.abs() + im.abs() + radius), BITS);
    let z = exp(&Ball::from_rational(&(-tau * (re - radius)), BITS));
    let zero = Ball::zero(BITS);
    let sum = parts.iter().rev().fold(zero.clone(), |sum, part| {
        let value = part
            .coeffs()
            .iter()
            .rev()
            .fold(zero.clone(), |value, c| value.mul(&size).add(&Ball::from_integer(&c.abs(), BITS)));
        sum.mul(&z).add(&value)
    });
    sum.upper()
}
