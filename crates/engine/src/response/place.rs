//! Frequencies as points of the boundary of stability, and polynomials there.

use crate::answer::Frequency;
use crate::stability::{ComplexPair, HalfSizePair, Range, Shape};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly};
use jurist_algebra::real::Real;

/// A frequency: a point of the upper half of the unit circle or of the imaginary axis.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::real::Real;
/// use jurist_engine::response::Place;
/// use jurist_engine::stability::Shape;
/// let place = Place::Inside(Real::from(Rational::ZERO)); // z + 1/z = 0: z = j
/// let step = Rational::new(1.into(), 4.into());
/// let frequency = place.frequency(Shape::UnitDisc, Some(&step), 64).unwrap();
/// assert!(frequency.hertz.unwrap().contains(&1.into()));
/// assert!(Place::Highest.frequency(Shape::LeftHalfPlane, None, 64).is_none());
/// ```
#[derive(Clone, Debug)]
pub enum Place {
    /// `z = 1`, `s = 0`.
    Lowest,
    /// Between the ends, given by `x = z + 1/z` in `(-2, 2)`, or by `x = s^2 < 0`.
    Inside(Real),
    /// `z = -1`, half the sampling frequency; the limit of high frequencies in continuous time.
    Highest,
}

impl Place {
    /// Angle and frequency, enclosed with about `bits` significant bits; `None` for the limit of high frequencies.
    pub fn frequency(&self, shape: Shape, sample_time: Option<&Rational>, bits: u64) -> Option<Frequency> {
        let working = bits + 16;
        let step = sample_time.filter(|t| t.sign().is_gt()).map(|t| Enclosure::from_rational(t.clone()));
        let zero = || Enclosure::from_rational(Rational::ZERO);
        let of = |angle| Some(Frequency::new(Some(angle), step.as_ref(), None, bits));
        match (self, shape) {
            (Place::Lowest, Shape::UnitDisc) => of(zero()),
            (Place::Lowest, Shape::LeftHalfPlane) => Some(Frequency::new(None, None, Some(zero()), bits)),
            (Place::Highest, Shape::UnitDisc) => of(Enclosure::pi(working)),
            (Place::Highest, Shape::LeftHalfPlane) => None,
            (Place::Inside(x), Shape::UnitDisc) => of(ComplexPair::at_half_size_root(shape, x.clone()).angle(working)?),
            (Place::Inside(x), Shape::LeftHalfPlane) => {
                let rate = ComplexPair::at_half_size_root(shape, x.clone()).angular_frequency(working)?;
                Some(Frequency::new(None, None, Some(rate), bits))
            }
        }
    }
}

/// The values of `x` strictly inside of the range of frequencies.
pub(crate) fn inner(shape: Shape) -> Range {
    match shape {
        Shape::UnitDisc => Range::between(Some(Rational::from(-2)), Some(Rational::from(2))),
        Shape::LeftHalfPlane => Range::between(None, Some(Rational::ZERO)),
    }
}

/// `p` times the conjugate of `q` on the boundary: twice the real part, and the imaginary part divided by `sin theta` or
/// `omega`, both as polynomials in `x`. On the circle both of `p`, `q` are read with formal degree `n`.
pub(crate) fn product<R: Domain>(p: &Poly<R>, q: &Poly<R>, n: usize, shape: Shape) -> (Poly<R>, Poly<R>) {
    let two = R::from_integer(&Integer::from(2));
    if n == 0 {
        return (p.times(q).scaled(&two), Poly::zero());
    }
    match shape {
        Shape::UnitDisc => {
            let pair = HalfSizePair::new(&p.times(&q.reversed(n)), 2 * n, shape);
            (pair.a, pair.b)
        }
        Shape::LeftHalfPlane => {
            let pair = HalfSizePair::new(&p.times(&q.negated_argument()), 2 * n, shape);
            (pair.a.scaled(&two), pair.b)
        }
    }
}

/// The square of the modulus on the boundary.
pub(crate) fn modulus_squared<R: Domain>(p: &Poly<R>, n: usize, shape: Shape) -> Poly<R> {
    let twice = product(p, p, n, shape).0;
    twice.div_exact_scalar(&R::from_integer(&Integer::from(2))).expect("the sum of a number and itself is even")
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::poly::UniPoly;

    /// At `z = j` and at `s = 2j`, by hand.
    #[test]
    fn products_by_hand() {
        let (p, q) = (UniPoly::from_i64(&[1, 2, 3]), UniPoly::from_i64(&[5, -1]));
        // p(j) = -2 + 2j, q(j) = 5 - j, p conj(q) = (-2 + 2j)(5 + j) = -12 + 8j; x = 0, sin = 1
        let (real, imaginary) = product(&p, &q, 2, Shape::UnitDisc);
        let zero = Integer::ZERO;
        assert_eq!((real.eval(&zero), imaginary.eval(&zero)), (Integer::from(-24), Integer::from(8)));
        assert_eq!(modulus_squared(&q, 2, Shape::UnitDisc).eval(&zero), Integer::from(26));
        // p(2j) = -11 + 4j, q(2j) = 5 - 2j, p conj(q) = (-11 + 4j)(5 + 2j) = -63 - 2j; x = -4, omega = 2
        let (real, imaginary) = product(&p, &q, 2, Shape::LeftHalfPlane);
        let x = Integer::from(-4);
        assert_eq!((real.eval(&x), imaginary.eval(&x)), (Integer::from(-126), Integer::from(-1)));
        assert_eq!(modulus_squared(&p, 2, Shape::LeftHalfPlane).eval(&x), Integer::from(137));
    }

    #[test]
    fn constants_are_real() {
        let (three, two) = (UniPoly::from_i64(&[3]), UniPoly::from_i64(&[2]));
        for shape in [Shape::UnitDisc, Shape::LeftHalfPlane] {
            assert_eq!(product(&three, &two, 0, shape), (UniPoly::from_i64(&[12]), UniPoly::zero()));
            assert_eq!(modulus_squared(&three, 0, shape), UniPoly::from_i64(&[9]));
        }
    }
}
