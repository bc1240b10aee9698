//! Polynomials near a point whose coefficients are nearly linear in a box of parameters.

use super::affine::Affine;
use super::along_circle::NearlyLinear;
use super::spiral::Complex;
use jurist_algebra::ball::{Ball, MultiTaylorModel};
use jurist_algebra::number::{Integer, Rational};

/// A coefficient near a linear function of coordinates from -1 to 1.
pub(super) struct Linear {
    pub middle: Ball,
    pub slopes: Vec<Ball>,
    /// A bound of how far it is off.
    pub rest: Ball,
}

impl Linear {
    /// In the box of a Taylor model, with so many bits.
    pub fn of(model: &MultiTaylorModel, with_bits: u64) -> Linear {
        let Affine { middle, slopes, rest, bits } = model.affine();
        let ball = |n: &Integer| Ball::from_units(n.clone(), n.clone(), bits).with_bits(with_bits);
        Linear { middle: ball(&middle), slopes: slopes.iter().map(ball).collect(), rest: ball(&rest) }
    }

    /// A linear function of `2 t - 1`, and how far a polynomial in `t` is from it for `t` from 0 to 1. The error of a Taylor polynomial is in its last coefficient.
    pub fn of_share(terms: &[Ball]) -> Linear {
        let (bits, half) = (terms[0].bits(), |x: &Ball| x.shifted(-1));
        let Linear { mut middle, mut rest, .. } = Linear::anywhere(&terms[0]);
        let mut slope = Ball::zero(bits);
        for (k, term) in terms.iter().enumerate().skip(1) {
            let own = Linear::anywhere(term);
            // t^k is below its chord t by (k - 1)/(k + 2) at most.
            let below = Rational::new(Integer::from(k as u64 - 1), Integer::from(k as u64 + 2));
            let below = half(&own.middle.mul(&Ball::from_rational(&below, bits)));
            middle = middle.add(&half(&own.middle)).sub(&below);
            slope = slope.add(&half(&own.middle));
            rest = rest.add(&own.rest).add(&magnitude(&below));
        }
        Linear { middle, slopes: vec![slope], rest }
    }

    /// A number that is anywhere in a ball.
    pub fn anywhere(in_ball: &Ball) -> Linear {
        let (middle, width, bits) = (in_ball.middle_units(), in_ball.width_units(), in_ball.bits());
        let rest = Ball::from_units(width.clone(), width, bits);
        Linear { middle: Ball::from_units(middle.clone(), middle, bits), slopes: Vec::new(), rest }
    }
}

/// A polynomial in the distance from a point: its coefficients near linear functions. By the powers of that distance it is bounded as well as the
/// distance of its roots allows, however much the powers of `z` cancel.
pub(super) struct Shifted {
    pub middles: Vec<Complex>,
    pub slopes: Vec<Vec<Complex>>,
    pub rests: Vec<Ball>,
}

impl Shifted {
    /// Cost: half the square of the degree in products, for each parameter.
    pub fn new(list: &[Linear], to: &Complex, parameters: usize, bits: u64) -> Shifted {
        let shifted = |coefficient: &dyn Fn(&Linear) -> Ball| {
            let zero = Ball::zero(bits);
            let complex = |c: &Linear| Complex { re: coefficient(c), im: zero.clone() };
            let mut all: Vec<Complex> = list.iter().map(complex).collect();
            for j in 0..all.len() {
                for k in (j..all.len() - 1).rev() {
                    all[k] = all[k].plus(&to.times(&all[k + 1]));
                }
            }
            all
        };
        let size = modulus(to);
        let mut rests: Vec<Ball> = list.iter().map(|c| c.rest.clone()).collect();
        for j in 0..rests.len() {
            for k in (j..rests.len() - 1).rev() {
                rests[k] = rests[k].add(&size.mul(&rests[k + 1]));
            }
        }
        Shifted {
            middles: shifted(&|c| c.middle.clone()),
            slopes: (0..parameters).map(|i| shifted(&|c| c.slopes[i].clone())).collect(),
            rests,
        }
    }

    /// A bound of how far a coefficient is from its middle.
    pub fn off(&self, k: usize) -> Ball {
        self.slopes.iter().fold(self.rests[k].clone(), |sum, slopes| sum.add(&modulus(&slopes[k])))
    }

    /// A bound of what powers from one on add to the value, or to the derivative, within a radius.
    pub fn beyond(&self, first: usize, is_derivative: bool, radius: &Ball) -> Ball {
        let mut power = Ball::from_integer(&Integer::ONE, radius.bits());
        let mut sum = Ball::zero(radius.bits());
        let lowest = usize::from(is_derivative);
        for k in lowest..self.middles.len() {
            if k >= first {
                let size = modulus(&self.middles[k]).add(&self.off(k)).mul(&power);
                sum = sum.add(&if is_derivative { size.scaled(&Integer::from(k as u64)) } else { size });
            }
            power = power.mul(radius);
        }
        sum
    }

    /// The value and the derivative within a radius.
    pub fn within(&self, radius: &Ball) -> [Complex; 2] {
        [0, 1].map(|k| {
            let Some(middle) = self.middles.get(k) else { return Complex::zero(radius.bits()) };
            let off = self.off(k).add(&self.beyond(k + 1, k == 1, radius)).magnitude_units();
            Complex { re: middle.re.widened(&off), im: middle.im.widened(&off) }
        })
    }
}

/// A bound of the modulus: the sum of those of both parts.
pub(super) fn modulus(z: &Complex) -> Ball {
    magnitude(&z.re).add(&magnitude(&z.im))
}

pub(super) fn magnitude(x: &Ball) -> Ball {
    let units = x.magnitude_units();
    Ball::from_units(units.clone(), units, x.bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::poly::Poly;
    use proptest::prelude::*;

    const BITS: u64 = 96;

    proptest! {
        /// A polynomial in a share is where the linear function of `2 t - 1` says.
        #[test]
        fn powers_of_a_share_are_near_a_linear_function(terms in prop::collection::vec(-50i64..50, 1..8), share in 0i64..=16) {
            let numbers: Vec<Rational> = terms.iter().map(|c| Rational::from(*c)).collect();
            let balls: Vec<Ball> = numbers.iter().map(|c| Ball::from_rational(c, BITS)).collect();
            let Linear { middle, slopes, rest } = Linear::of_share(&balls);
            let share = Rational::new(share.into(), 16.into());
            let aside = &share + &share - Rational::ONE;
            let line = middle.add(&slopes[0].mul(&Ball::from_rational(&aside, BITS)));
            let range = line.widened(&rest.magnitude_units());
            prop_assert!(range.contains(&Poly::new(numbers).eval(&share)));
        }

        /// The values and the derivatives at points of a disc and a box are in what is said of all of them.
        #[test]
        fn values_near_a_point_are_enclosed(
            middles in prop::collection::vec(-20i64..20, 1..7), slopes in prop::collection::vec(-3i64..3, 7), at in -8i64..8, aside in -4i64..=4, parameter in -4i64..=4
        ) {
            let ball = |n: i64| Ball::from_integer(&n.into(), BITS);
            let list: Vec<Linear> = middles.iter().zip(&slopes)
                .map(|(c, s)| Linear { middle: ball(*c), slopes: vec![ball(*s)], rest: Ball::zero(BITS) }).collect();
            let share = |n: i64, of: i64| Rational::new(n.into(), of.into());
            let to = Complex { re: Ball::from_rational(&share(at, 4), BITS), im: Ball::zero(BITS) };
            let radius = Ball::from_rational(&share(1, 4), BITS);
            let [value, slope] = Shifted::new(&list, &to, 1, BITS).within(&radius);
            let x = share(parameter, 4);
            let p = Poly::new(middles.iter().zip(&slopes).map(|(c, s)| Rational::from(*c) + Rational::from(*s) * &x).collect());
            let z = share(at, 4) + share(aside, 16);
            prop_assert!(value.re.contains(&p.eval(&z)) && value.im.contains_zero());
            prop_assert!(slope.re.contains(&p.derivative().eval(&z)) && slope.im.contains_zero());
        }
    }
}
