//! An open loop over a ring in which parameters are, with real or with complex coefficients.

use super::boundaries::{Along, Boundaries, Elimination, integer};
use super::complex_poly::ComplexPoly;
use super::family::Quotient;
use super::parts::Reduced;
use super::requirement::Requirement;
use crate::error::Error;
use crate::model::Opened;
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};

/// `N/D0`.
pub(super) enum AnyQuotient<R: Domain> {
    /// With real coefficients.
    Real(Quotient<R>),
    /// With complex ones.
    Complex(ComplexQuotient<R>),
}

/// `N/D0` with complex coefficients.
pub(super) struct ComplexQuotient<R: Domain> {
    pub denominator: ComplexPoly<R>,
    pub numerator: ComplexPoly<R>,
    pub shape: Shape,
}

impl<R: Domain> AnyQuotient<R> {
    /// From the cut to the cut, and the common denominator of all coefficients.
    pub fn of(
        opened: &Opened,
        shape: Shape,
        ring: impl Fn(&MultiPoly) -> R,
        budget: &Budget,
    ) -> Result<(AnyQuotient<R>, R), Error> {
        if opened.system.is_complex {
            let (quotient, undefined) = ComplexQuotient::of(opened, shape, ring, budget)?;
            return Ok((AnyQuotient::Complex(quotient), undefined));
        }
        let (quotient, undefined) = Quotient::of(opened, shape, ring, budget)?;
        Ok((AnyQuotient::Real(quotient), undefined))
    }

    pub fn shape(&self) -> Shape {
        match self {
            AnyQuotient::Real(quotient) => quotient.shape,
            AnyQuotient::Complex(quotient) => quotient.shape,
        }
    }

    /// Whether nothing comes back.
    pub fn is_open(&self) -> bool {
        match self {
            AnyQuotient::Real(quotient) => quotient.numerator.is_zero(),
            AnyQuotient::Complex(quotient) => quotient.numerator.is_zero(),
        }
    }

    /// The real and the imaginary parts of the denominator's coefficients, and of the numerator's.
    pub fn lists(&self) -> [&[R]; 4] {
        match self {
            AnyQuotient::Real(quotient) => [quotient.denominator.coeffs(), &[], quotient.numerator.coeffs(), &[]],
            AnyQuotient::Complex(ComplexQuotient { denominator: d, numerator: n, .. }) => {
                [&d.re, &d.im, &n.re, &n.im].map(Poly::coeffs)
            }
        }
    }

    /// Where a requirement may begin or cease to be met.
    pub fn boundaries<E: Elimination<R>>(
        &self,
        by: &E,
        requirement: &Requirement,
        budget: &Budget,
    ) -> Result<Boundaries<E::Left>, Exhausted> {
        let (reduced, at_ends) = match self {
            AnyQuotient::Real(quotient) => budget.enter(|| quotient.reduced())?,
            AnyQuotient::Complex(quotient) => budget.enter(|| quotient.reduced())?,
        };
        Along { by, reduced, at_ends, budget }.boundaries(requirement)
    }

    /// With other coefficients.
    pub fn map<S: Domain>(&self, f: impl Fn(&R) -> S) -> AnyQuotient<S> {
        let both = |p: &ComplexPoly<R>| ComplexPoly { re: p.re.map(&f), im: p.im.map(&f) };
        match self {
            AnyQuotient::Real(quotient) => AnyQuotient::Real(quotient.map(&f)),
            AnyQuotient::Complex(quotient) => AnyQuotient::Complex(ComplexQuotient {
                denominator: both(&quotient.denominator),
                numerator: both(&quotient.numerator),
                shape: quotient.shape,
            }),
        }
    }
}

/// The products along the boundary, and what [`Along::at_ends`] is.
type AtEnds<R> = (Reduced<R>, Vec<(R, R)>);

impl<R: Domain> Quotient<R> {
    fn reduced(&self) -> AtEnds<R> {
        let common = self.denominator.gcd(&self.numerator);
        let [d, n] = [&self.denominator, &self.numerator].map(|p| p.div_exact(&common).expect("a gcd divides"));
        let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
        let at = |x: i64| (d.eval(&integer(x)), n.eval(&integer(x)));
        let mut ends = match self.shape {
            Shape::UnitDisc => vec![at(1), at(-1)],
            Shape::LeftHalfPlane => vec![at(0), (d.coeff(degree), n.coeff(degree))],
        };
        ends.retain(|(a, b)| !a.is_zero() && !b.is_zero());
        (Reduced::of(&n, &d, self.shape), ends)
    }
}

impl<R: Domain> ComplexQuotient<R> {
    /// From the cut to the cut, and the common denominator of all coefficients. A closed loop `N/D` is that of `N/(D - N)`.
    fn of(
        Opened { system, is_closed, .. }: &Opened,
        shape: Shape,
        ring: impl Fn(&MultiPoly) -> R,
        budget: &Budget,
    ) -> Result<(ComplexQuotient<R>, R), Error> {
        let [below, above] = system.complex_transfer(0, system.inputs.len() / 2 - 1, budget)?;
        let lists = [below.re, below.im, above.re, above.im];
        let found = budget.enter(|| {
            let all = || lists.iter().flatten();
            let common = all().fold(R::one(), |l, f| {
                let d = ring(f.denominator());
                l.times(&d.div_exact(&l.gcd(&d)).expect("a gcd divides"))
            });
            let cleared = |f: &RationalFunction| {
                let factor = common.div_exact(&ring(f.denominator())).expect("a common multiple");
                ring(f.numerator()).times(&factor)
            };
            let [re, im, numerator_re, numerator_im] =
                lists.each_ref().map(|list| Poly::new(list.iter().map(cleared).collect()));
            let denominator = ComplexPoly { re, im };
            let numerator = ComplexPoly { re: numerator_re, im: numerator_im };
            let (denominator, numerator) = match is_closed {
                true => (denominator.plus(&numerator.negated()), numerator),
                false => (denominator, numerator.negated()),
            };
            (ComplexQuotient { denominator, numerator, shape }, common)
        });
        Ok(found?)
    }

    /// Frequencies of both signs have one end, the limit of `x`.
    fn reduced(&self) -> AtEnds<R> {
        let reduced = Reduced::complex(&self.numerator, &self.denominator, self.shape);
        let squares = [&reduced.numerator_squared, &reduced.denominator_squared];
        let degree = squares.map(|p| p.coeffs().len()).into_iter().max().unwrap_or(0).saturating_sub(1);
        let two = integer::<R>(2);
        let end = (reduced.denominator_squared.coeff(degree).times(&two), reduced.twice_real.coeff(degree));
        let is_real = reduced.imaginary.coeff(degree).is_zero() && !end.0.is_zero() && !end.1.is_zero();
        let ends = if is_real { vec![end] } else { Vec::new() };
        (reduced, ends)
    }
}
