//! The characteristic polynomial of a complex loop.

use super::{Parts, parts_of};
use crate::evaluate::zpoly::ZPoly;
use jurist_algebra::poly::RationalFunction;

/// The characteristic polynomial `D` of a complex loop.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ComplexPolynomial {
    /// The real parts of the coefficients, from the constant term up.
    pub re: Vec<RationalFunction>,
    /// The imaginary parts, as many.
    pub im: Vec<RationalFunction>,
}

impl ComplexPolynomial {
    /// From the real and the imaginary parts of the coefficients, of each as many.
    pub fn new(re: Vec<RationalFunction>, im: Vec<RationalFunction>) -> ComplexPolynomial {
        ComplexPolynomial { re, im }
    }

    /// From coefficients in which a variable of this number is the imaginary unit; `None` where one divides by zero.
    pub(crate) fn of(coefficients: &[RationalFunction], unit: usize) -> Option<ComplexPolynomial> {
        let parts = coefficients.iter().map(|c| parts_of(c, Some(unit))).collect::<Option<Vec<Parts>>>()?;
        let (re, im) = parts.into_iter().map(|p| (p.re, p.im)).unzip();
        Some(ComplexPolynomial { re, im })
    }

    /// `p - q` of two polynomials with as many coefficients.
    pub fn minus(&self, other: &ComplexPolynomial) -> ComplexPolynomial {
        let difference = |a: &[RationalFunction], b: &[RationalFunction]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        ComplexPolynomial { re: difference(&self.re, &other.re), im: difference(&self.im, &other.im) }
    }

    /// `p + c q` of two polynomials with as many coefficients.
    pub(crate) fn plus_multiple(&self, c: &Parts, other: &ComplexPolynomial) -> ComplexPolynomial {
        let pairs = || other.re.iter().zip(&other.im);
        let re = self.re.iter().zip(pairs()).map(|(p, (x, y))| &(p + &(&c.re * x)) - &(&c.im * y)).collect();
        let im = self.im.iter().zip(pairs()).map(|(p, (x, y))| &(p + &(&c.re * y)) + &(&c.im * x)).collect();
        ComplexPolynomial { re, im }
    }

    /// Whether no imaginary part is left.
    pub fn is_real(&self) -> bool {
        self.im.iter().all(RationalFunction::is_zero)
    }

    /// The real polynomial `D conj(D)` of twice the degree, `conj(D)` with conjugated coefficients: its roots are those of `D` and their
    /// conjugates.
    pub fn with_conjugate(&self) -> Vec<RationalFunction> {
        let n = self.re.len();
        let mut out = vec![RationalFunction::zero(); (2 * n).saturating_sub(1)];
        for list in [&self.re, &self.im] {
            for (i, a) in list.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
                for (k, b) in list.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                    out[i + k] = &out[i + k] + &(a * b);
                }
            }
        }
        out
    }

    /// The real polynomial that is asked: the polynomial itself where it is real; else that with the conjugate roots, beside it.
    pub(crate) fn real_or_complex(self) -> (Vec<RationalFunction>, Option<ComplexPolynomial>) {
        if self.is_real() { (self.re, None) } else { (self.with_conjugate(), Some(self)) }
    }

    /// The polynomial without its greatest factor that has real coefficients; `None` where it has no such factor.
    ///
    /// Cost: Euclid's algorithm over the field of rational functions.
    pub fn without_real_factor(&self) -> Option<ComplexPolynomial> {
        let (factor, others) = self.real_factor();
        (factor.len() > 1).then_some(others)
    }

    /// The greatest factor with real coefficients, and the other one.
    ///
    /// Cost: Euclid's algorithm over the field of rational functions.
    pub fn real_factor(&self) -> (Vec<RationalFunction>, ComplexPolynomial) {
        let any = |f: RationalFunction| Some(f);
        let [re, im] = [&self.re, &self.im].map(|list| ZPoly::new(list.clone()));
        let split = || {
            let factor = re.gcd(&im, &any)?;
            let [re, im] = [re.divide(&factor, &any)?.0, im.divide(&factor, &any)?.0];
            let list = |p: &ZPoly| (0..=re.degree().max(im.degree())).map(|k| p.coefficient(k)).collect();
            Some((factor.coefficients().to_vec(), ComplexPolynomial { re: list(&re), im: list(&im) }))
        };
        split().unwrap_or_else(|| (vec![RationalFunction::one()], self.clone()))
    }

    /// The coefficients with images in the place of their parts; `None` where one has none.
    pub fn try_map(&self, image: impl Fn(&RationalFunction) -> Option<RationalFunction>) -> Option<ComplexPolynomial> {
        let [re, im] = [&self.re, &self.im].map(|list| list.iter().map(&image).collect::<Option<Vec<_>>>());
        Some(ComplexPolynomial { re: re?, im: im? })
    }
}
