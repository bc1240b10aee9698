//! Frequencies as points of the boundary of stability, and polynomials there.

use super::Value;
use crate::answer::Frequency;
use crate::stability::{ComplexPair, HalfSizePair, Range, Shape};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly};
use jurist_algebra::real::Real;

/// The frequencies that are looked at, and the variable that runs along them.
///
/// ```
/// use jurist_engine::response::Frequencies;
/// use jurist_engine::stability::Shape;
/// assert_eq!(Frequencies::from(Shape::UnitDisc), Frequencies::Positive(Shape::UnitDisc));
/// assert!(Frequencies::Signed(Shape::UnitDisc).are_signed());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frequencies {
    /// From 0 up, as of a loop with real coefficients, whose response at negative frequencies is the conjugate one: `x = z + 1/z` from 2
    /// down to -2, or `x = s^2` from 0 down.
    Positive(Shape),
    /// Of either sign, as of a loop with complex coefficients: `x = tan(theta/2)` or `x = omega`, from minus to plus infinity. Both ends are one
    /// point, `z = -1` or the limit of high frequencies.
    Signed(Shape),
}

impl From<Shape> for Frequencies {
    fn from(shape: Shape) -> Frequencies {
        Frequencies::Positive(shape)
    }
}

impl Frequencies {
    /// The disc or the half plane.
    pub fn shape(self) -> Shape {
        match self {
            Frequencies::Positive(shape) | Frequencies::Signed(shape) => shape,
        }
    }

    /// Whether negative frequencies are looked at.
    pub fn are_signed(self) -> bool {
        matches!(self, Frequencies::Signed(_))
    }

    /// The values of `x` strictly inside of the range of frequencies.
    pub(crate) fn inner(self) -> Range {
        match self {
            Frequencies::Positive(Shape::UnitDisc) => Range::between(Some(Rational::from(-2)), Some(Rational::from(2))),
            Frequencies::Positive(Shape::LeftHalfPlane) => Range::between(None, Some(Rational::ZERO)),
            Frequencies::Signed(_) => Range::all(),
        }
    }

    /// Values of `x` that ascend, by ascending frequency.
    pub(crate) fn ascending<T>(self, mut values: Vec<T>) -> Vec<T> {
        if !self.are_signed() {
            values.reverse();
        }
        values
    }

    /// The lowest frequency, if it is an end of the range, these values of `x`, which ascend, and the highest frequency.
    pub(crate) fn places(self, inside: Vec<Real>) -> Vec<Place> {
        let lowest = (!self.are_signed()).then_some(Place::Lowest);
        let inside = self.ascending(inside).into_iter().map(Place::Inside);
        lowest.into_iter().chain(inside).chain([Place::Highest]).collect()
    }
}

/// A frequency: a point of the unit circle or of the imaginary axis.
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
    /// Between the ends, given by the variable of [`Frequencies`]: `x = z + 1/z` in `(-2, 2)` or `x = s^2 < 0`, or where frequencies have a
    /// sign `x = tan(theta/2)` or `x = omega`.
    Inside(Real),
    /// `z = -1`, half the sampling frequency; the limit of high frequencies in continuous time.
    Highest,
}

impl Place {
    /// Whether it is the frequency 0.
    pub(super) fn is_at_rest(&self, frequencies: Frequencies) -> bool {
        match self {
            Place::Lowest => true,
            Place::Inside(x) => frequencies.are_signed() && x.sign().is_eq(),
            Place::Highest => false,
        }
    }

    /// Angle and frequency, enclosed with about `bits` significant bits; `None` for the limit of high frequencies.
    pub fn frequency(
        &self,
        frequencies: impl Into<Frequencies>,
        sample_time: Option<&Rational>,
        bits: u64,
    ) -> Option<Frequency> {
        let frequencies = frequencies.into();
        let shape = frequencies.shape();
        let working = bits + 16;
        let step = sample_time.filter(|t| t.sign().is_gt()).map(|t| Enclosure::from_rational(t.clone()));
        let zero = || Enclosure::from_rational(Rational::ZERO);
        let of = |angle| Some(Frequency::new(Some(angle), step.as_ref(), None, bits));
        match (self, shape) {
            (Place::Lowest, Shape::UnitDisc) => of(zero()),
            (Place::Lowest, Shape::LeftHalfPlane) => Some(Frequency::new(None, None, Some(zero()), bits)),
            (Place::Highest, Shape::UnitDisc) => of(Enclosure::pi(working)),
            (Place::Highest, Shape::LeftHalfPlane) => None,
            (Place::Inside(x), Shape::UnitDisc) if frequencies.are_signed() => {
                let half = Value::Number(x.clone()).enclosure(working).atan(working);
                of(half.mul(&Enclosure::from_rational(Rational::from(2)), working))
            }
            (Place::Inside(x), Shape::LeftHalfPlane) if frequencies.are_signed() => {
                Some(Frequency::new(None, None, Some(Value::Number(x.clone()).enclosure(working)), bits))
            }
            (Place::Inside(x), Shape::UnitDisc) => of(ComplexPair::at_half_size_root(shape, x.clone()).angle(working)?),
            (Place::Inside(x), Shape::LeftHalfPlane) => {
                let rate = ComplexPair::at_half_size_root(shape, x.clone()).angular_frequency(working)?;
                Some(Frequency::new(None, None, Some(rate), bits))
            }
        }
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
