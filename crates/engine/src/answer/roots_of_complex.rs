//! The roots of a loop with complex coefficients. `D = g h` with the greatest factor `g` that has real coefficients. The roots of `g` are real or
//! conjugate pairs. No root of `h` is real, and no two roots of `h` are conjugate. So each conjugate pair of roots of `h conj(h)` contains exactly one
//! root of `h`.

use super::roots::discs;
use crate::error::Error;
use crate::model::{ComplexPolynomial, quotient_at};
use crate::precisions::ROOTS;
use crate::problem::Algebra;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, RootDisc, UniPoly, complex_roots};

/// How often discs are made narrower, by the square of their radius each time, until it shows which of two conjugates is a root.
const MOST_ATTEMPTS: usize = 5;

/// The roots of a complex loop at a point, and how many there are; a disc below the real axis is one by itself.
pub(super) fn roots_of_complex(
    whole: &ComplexPolynomial,
    algebra: &Algebra,
    narrow: &Rational,
    budget: &Budget,
) -> Result<Vec<RootDisc>, Error> {
    let point = Point { algebra, budget };
    let is_undefined = |p: &MultiPoly| p.is_zero();
    if algebra.polynomial().is_some_and(|p| p.poles.iter().any(is_undefined)) {
        return Err(Error::Undefined("an expression divides by zero".into()));
    }
    let (real, others) = budget.enter(|| whole.real_factor())?;
    let mut found = point.roots(&real, narrow)?;
    let product = others.with_conjugate();
    let mut radius = narrow.clone();
    for _ in 0..MOST_ATTEMPTS {
        let pairs = point.roots(&product, &radius)?;
        let sided: Option<Vec<RootDisc>> = pairs.into_iter().map(|disc| point.on_its_side(disc, &others)).collect();
        if let Some(sided) = sided {
            found.extend(sided);
            return Ok(found);
        }
        radius = &radius * &radius;
    }
    Err(ROOTS.exhausted("which of two conjugates is a root").into())
}

/// The values at a point.
struct Point<'a> {
    algebra: &'a Algebra,
    budget: &'a Budget,
}

impl Point<'_> {
    fn enclosed(&self, coefficients: &[RationalFunction], bits: u64) -> Option<Vec<Ball>> {
        let values = match self.algebra.symbols().is_empty() {
            true => Vec::new(),
            false => self.algebra.symbols().enclosed(bits)?,
        };
        coefficients.iter().map(|c| quotient_at(c, &values, bits)).collect()
    }

    /// The roots of a polynomial with real coefficients.
    fn roots(&self, coefficients: &[RationalFunction], narrow: &Rational) -> Result<Vec<RootDisc>, Error> {
        let numbers: Option<Vec<Rational>> = coefficients.iter().map(RationalFunction::as_constant).collect();
        if let Some(numbers) = numbers {
            let (_, integral) = UniPoly::from_rational_poly(&Poly::new(numbers));
            return Ok(complex_roots(&integral, narrow, self.budget)?);
        }
        let zeros = coefficients.iter().take_while(|c| c.is_zero()).count();
        discs(|bits| self.enclosed(coefficients, bits), zeros, narrow, self.budget)
    }

    /// The disc of those roots of `D` that lie in it or in its mirror image; `None` where it does not show in which.
    fn on_its_side(&self, disc: RootDisc, whole: &ComplexPolynomial) -> Option<RootDisc> {
        let bits = 64 + disc.radius.denominator().bit_length();
        let [re, im] = [&whole.re, &whole.im].map(|list| self.enclosed(list, bits));
        let (re, im) = (re?, im?);
        let around = |centre: &Rational| Ball::between(&(centre - &disc.radius), &(centre + &disc.radius), bits);
        let x = around(&disc.re);
        let vanishes = |y: &Ball| {
            let mut value = [Ball::zero(bits), Ball::zero(bits)];
            for (re, im) in re.iter().zip(&im).rev() {
                let [u, v] = &value;
                value = [u.mul(&x).sub(&v.mul(y)).add(re), u.mul(y).add(&v.mul(&x)).add(im)];
            }
            value.iter().all(Ball::contains_zero)
        };
        let y = around(&disc.im);
        match [vanishes(&y), vanishes(&y.neg())] {
            [true, false] => Some(RootDisc { is_pair: false, ..disc }),
            [false, true] => Some(RootDisc { is_pair: false, im: -disc.im, ..disc }),
            _ => None,
        }
    }
}
