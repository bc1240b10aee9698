//! Polynomials whose coefficients may be complex, as two over the same ring.

use super::Frequencies;
use super::place::modulus_squared;
use crate::stability::Shape;
use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, Poly};

/// The real and the imaginary parts of the coefficients.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ComplexPoly<R: Domain> {
    pub re: Poly<R>,
    pub im: Poly<R>,
}

impl<R: Domain> From<Poly<R>> for ComplexPoly<R> {
    fn from(re: Poly<R>) -> Self {
        ComplexPoly { re, im: Poly::zero() }
    }
}

impl<R: Domain> ComplexPoly<R> {
    /// Whether all coefficients are real.
    pub fn is_real(&self) -> bool {
        self.im.is_zero()
    }

    /// Whether all coefficients are zero.
    pub fn is_zero(&self) -> bool {
        self.re.is_zero() && self.im.is_zero()
    }

    /// The number of coefficients.
    pub fn len(&self) -> usize {
        self.re.coeffs().len().max(self.im.coeffs().len())
    }

    /// `p q*` of two polynomials and `q* = conj(q)` with conjugated coefficients: the real and the imaginary part.
    pub fn times_conjugate(&self, other: &Self) -> [Poly<R>; 2] {
        let product = |a: &Poly<R>, b: &Poly<R>| {
            if a.is_zero() || b.is_zero() { Poly::zero() } else { a.times(b) }
        };
        [
            product(&self.re, &other.re).plus(&product(&self.im, &other.im)),
            product(&self.im, &other.re).minus(&product(&self.re, &other.im)),
        ]
    }

    /// `p p*`.
    pub fn squared(&self) -> Poly<R> {
        let [square, _] = self.times_conjugate(self);
        square
    }

    /// A polynomial with real coefficients that has the same roots inside of the boundary, on it and outside: itself, or with the conjugate roots.
    pub fn with_conjugate(&self) -> Poly<R> {
        if self.is_real() { self.re.clone() } else { self.squared() }
    }

    /// `p + q`.
    pub fn plus(&self, other: &Self) -> Self {
        ComplexPoly { re: self.re.plus(&other.re), im: self.im.plus(&other.im) }
    }

    /// The polynomial times a power of its variable.
    pub fn shifted_up(&self, power: usize) -> Self {
        ComplexPoly { re: self.re.shifted_up(power), im: self.im.shifted_up(power) }
    }

    /// The values on the boundary as a polynomial in the real variable of signed frequencies: in `t = tan(theta/2)`, times `(1 - jt)^n`, or in
    /// `omega`.
    ///
    /// With `z = (1 + jt)/(1 - jt)` each power `z^k` becomes `(1 + jt)^k (1 - jt)^(n - k)`: by Horner's scheme, with one more factor `1 - jt` in each step.
    pub fn along(&self, n: usize, shape: Shape) -> Self {
        let constant = |re: R, im: R| ComplexPoly { re: Poly::constant(re), im: Poly::constant(im) };
        let coefficient = |k: usize| constant(self.re.coeff(k), self.im.coeff(k));
        let linear = |slope: i64| ComplexPoly {
            re: Poly::one(),
            im: Poly::new(vec![R::zero(), R::from_integer(&Integer::from(slope))]),
        };
        match shape {
            Shape::UnitDisc => {
                let (up, down) = (linear(1), linear(-1));
                let (mut sum, mut factor) = (coefficient(n), ComplexPoly::from(Poly::one()));
                for k in (0..n).rev() {
                    factor = factor.times(&down);
                    sum = sum.times(&up).plus(&factor.times(&coefficient(k)));
                }
                sum
            }
            Shape::LeftHalfPlane => {
                let turned = |k: usize| {
                    let (re, im) = (self.re.coeff(k), self.im.coeff(k));
                    match k % 4 {
                        0 => [re, im],
                        1 => [im.negated(), re],
                        2 => [re.negated(), im.negated()],
                        _ => [im, re.negated()],
                    }
                };
                let (re, im) = (0..self.len()).map(turned).map(|[re, im]| (re, im)).unzip();
                ComplexPoly { re: Poly::new(re), im: Poly::new(im) }
            }
        }
    }

    /// The square of the modulus on the boundary, in the variable of these frequencies; real coefficients where they have no sign.
    pub fn modulus_squared(&self, n: usize, frequencies: Frequencies) -> Poly<R> {
        match frequencies {
            Frequencies::Positive(shape) => modulus_squared(&self.re, n, shape),
            Frequencies::Signed(shape) => self.along(n, shape).squared(),
        }
    }

    /// The coefficient of a power.
    pub fn coeff(&self, power: usize) -> Self {
        ComplexPoly { re: Poly::constant(self.re.coeff(power)), im: Poly::constant(self.im.coeff(power)) }
    }

    /// The coefficient of the highest power; `None` of zero.
    pub fn leading(&self) -> Option<Self> {
        Some(self.coeff(self.len().checked_sub(1)?))
    }

    /// `-p`.
    pub fn negated(&self) -> Self {
        ComplexPoly { re: Poly::zero().minus(&self.re), im: Poly::zero().minus(&self.im) }
    }

    /// The derivative.
    pub fn derivative(&self) -> Self {
        ComplexPoly { re: self.re.derivative(), im: self.im.derivative() }
    }

    /// Times a real number.
    pub fn scaled(&self, by: &R) -> Self {
        ComplexPoly { re: self.re.scaled(by), im: self.im.scaled(by) }
    }

    /// `p q`.
    pub fn times(&self, other: &Self) -> Self {
        let conjugate = ComplexPoly { re: other.re.clone(), im: Poly::zero().minus(&other.im) };
        let [re, im] = self.times_conjugate(&conjugate);
        ComplexPoly { re, im }
    }
}

/// Divides polynomials on the axis by all that their parts have in common, and returns that.
pub(super) fn take_common<R: Domain>(parts: &mut Vec<ComplexPoly<R>>) -> Poly<R> {
    let all = parts.iter().flat_map(|p| [&p.re, &p.im]);
    let common = all.fold(Poly::zero(), |g: Poly<R>, p| g.gcd(p));
    let divided = |p: &Poly<R>| p.div_exact(&common).expect("a gcd divides");
    *parts = parts.iter().map(|p| ComplexPoly { re: divided(&p.re), im: divided(&p.im) }).collect();
    common
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::poly::UniPoly;

    fn complex(re: &[i64], im: &[i64]) -> ComplexPoly<Integer> {
        ComplexPoly { re: UniPoly::from_i64(re), im: UniPoly::from_i64(im) }
    }

    /// `p = (1 + 2j) + z`.
    #[test]
    fn along_the_boundary_by_hand() {
        let p = complex(&[1, 1], &[2]);
        // z = j at t = 1: (1 + 3j)(1 - j) = 4 + 2j
        let along = p.along(1, Shape::UnitDisc);
        let at = |p: &UniPoly, x: i64| p.eval(&Integer::from(x));
        assert_eq!((at(&along.re, 1), at(&along.im, 1)), (4.into(), 2.into()));
        // z = -1 in the limit: 2j (-jt)
        assert_eq!((along.re.coeff(1), along.im.coeff(1)), (2.into(), 0.into()));
        // s = -3j
        let along = p.along(1, Shape::LeftHalfPlane);
        assert_eq!((at(&along.re, -3), at(&along.im, -3)), (1.into(), (-1).into()));
    }

    #[test]
    fn products_with_conjugates_by_hand() {
        // (1 + 2j + z)(1 - 2j + z) = z^2 + 2z + 5
        let p = complex(&[1, 1], &[2]);
        assert_eq!(p.with_conjugate(), UniPoly::from_i64(&[5, 2, 1]));
        // (1 + 2j + z)(-j z) = (2 - j) z - j z^2, times the conjugate of j z
        assert_eq!(
            p.times_conjugate(&complex(&[], &[0, 1])),
            [UniPoly::from_i64(&[0, 2]), UniPoly::from_i64(&[0, -1, -1])]
        );
    }
}
