//! The open loop of a problem with its free names left in it, wherever it is cut.

use super::any_quotient::{AnyQuotient, ComplexQuotient};
use super::complex_poly::ComplexPoly;
use super::family::{Quotient, nothing_comes_back};
use crate::coverage::refusals::{COMPLEX_REQUIRED, MARGINS_IN_ONE};
use crate::error::{Code, Diagnostic, Error};
use crate::model::{ComplexPolynomial, Cut, Evaluated, Opened, Symbols};
use crate::problem::{OpenedByValues, Problem};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};

/// An open loop of which the polynomials are not made yet.
pub(super) struct OpenedLoop<'p> {
    problem: &'p Problem,
    pub cut: Cut,
    pub sample_time: Option<RationalFunction>,
    /// What follows the free names.
    pub symbols: Symbols,
    of: Of,
}

enum Of {
    /// The system from the cut to the cut.
    System(Box<Opened>),
    /// The characteristic polynomial without the gain, what the gain adds to it, and where they are undefined.
    Polynomials { open: Box<ComplexPoly<MultiPoly>>, back: Box<ComplexPoly<MultiPoly>>, undefined: MultiPoly },
}

impl<'p> OpenedLoop<'p> {
    /// Cost: that of evaluating the model.
    ///
    /// # Errors
    /// As [`Model::cut`](crate::model::Model::cut); `E-cut` where a parameter does not enter as a gain.
    pub fn of(problem: &'p Problem, cut: Cut, budget: &Budget) -> Result<OpenedLoop<'p>, Error> {
        let kept: Vec<String> = problem.free().iter().map(|free| free.name.clone()).collect();
        let (of, sample_time, symbols) = match &cut {
            Cut::Gain(name) => with_gain(problem, name, &kept, budget)?,
            _ => {
                let opened = problem.model().opened(&cut, &kept, problem.set(), budget)?;
                let (sample_time, symbols) = (opened.sample_time.clone(), opened.symbols.clone());
                (Of::System(Box::new(opened)), sample_time, symbols)
            }
        };
        Ok(OpenedLoop { problem, cut, sample_time, symbols, of })
    }

    /// The same where nothing but values is known of the polynomials; `None` as in [`Problem::opened_by_values`].
    ///
    /// # Errors
    /// As [`Problem::opened_by_values`].
    pub fn by_values(problem: &'p Problem, cut: Cut, budget: &Budget) -> Result<Option<OpenedLoop<'p>>, Error> {
        let Some(found) = problem.opened_by_values(&cut, budget)? else { return Ok(None) };
        let OpenedByValues { denominator: open, numerator: back, undefined, sample_time, symbols } = found;
        let [open, back] = [open, back].map(|p| Box::new(ComplexPoly::from(p)));
        Ok(Some(OpenedLoop { problem, cut, sample_time, symbols, of: Of::Polynomials { open, back, undefined } }))
    }

    /// Refuses symbols, where polynomials have none.
    pub fn without_symbols(self) -> Result<Self, Error> {
        if self.symbols.is_empty() { Ok(self) } else { Err(MARGINS_IN_ONE.diagnostic(&[]).into()) }
    }

    /// `N/D0` over a ring, and the common denominator of all coefficients.
    ///
    /// # Errors
    /// `E-cut` where nothing comes back to the cut; `E-complex` of a complex loop; [`Error::Stopped`].
    pub fn quotient<R: Domain>(
        &self,
        ring: impl Fn(&MultiPoly) -> R,
        budget: &Budget,
    ) -> Result<(Quotient<R>, R), Error> {
        match self.any_quotient(ring, budget)? {
            (AnyQuotient::Real(quotient), undefined) => Ok((quotient, undefined)),
            (AnyQuotient::Complex(_), _) => Err(COMPLEX_REQUIRED.diagnostic(&[]).into()),
        }
    }

    /// The same of a loop with real or with complex coefficients.
    ///
    /// # Errors
    /// `E-cut` where nothing comes back to the cut; [`Error::Stopped`].
    pub fn any_quotient<R: Domain>(
        &self,
        ring: impl Fn(&MultiPoly) -> R,
        budget: &Budget,
    ) -> Result<(AnyQuotient<R>, R), Error> {
        let shape = self.problem.shape();
        let (quotient, undefined) = match &self.of {
            Of::System(opened) => AnyQuotient::of(opened, shape, ring, budget)?,
            Of::Polynomials { open, back, undefined } => {
                let over = |p: &Poly<MultiPoly>| Poly::new(p.coeffs().iter().map(&ring).collect());
                let quotient = if open.is_real() && back.is_real() {
                    AnyQuotient::Real(Quotient { denominator: over(&open.re), numerator: over(&back.re), shape })
                } else {
                    let [denominator, numerator] =
                        [open, back].map(|p| ComplexPoly { re: over(&p.re), im: over(&p.im) });
                    AnyQuotient::Complex(ComplexQuotient { denominator, numerator, shape })
                };
                (quotient, ring(undefined))
            }
        };
        if quotient.is_open() {
            return Err(nothing_comes_back(&self.cut));
        }
        Ok((quotient, undefined))
    }
}

/// `D0 + K N` of a parameter `K` that enters to the first power: free itself, or with its value.
fn with_gain(
    problem: &Problem,
    name: &str,
    kept: &[String],
    budget: &Budget,
) -> Result<(Of, Option<RationalFunction>, Symbols), Error> {
    let refused = |why: &str| -> Error {
        let message = format!("'{}' is not a gain of the loop: {why}", crate::model::shorten(name));
        let help = "a parameter is one where it enters the characteristic polynomial to the first power and is not 0";
        Diagnostic::error(Code::Cut, message).help(help).into()
    };
    let own = kept.iter().position(|free| free == name);
    let (names, at) = match own {
        Some(at) => (kept.to_vec(), at),
        None => (kept.iter().cloned().chain([name.to_owned()]).collect(), kept.len()),
    };
    let others: Vec<(String, Rational)> = problem.set().iter().filter(|(n, _)| n != name).cloned().collect();
    let Evaluated { polynomial, complex, sample_time, symbols, .. } =
        problem.model().evaluate(&names, &others, budget)?;
    let ([re, im], denominator) = budget.enter(|| cleared(&polynomial, complex.as_ref()))?;
    let is_inside = |f: &MultiPoly| f.degree_in(at) > 0;
    let is_in_time = sample_time.iter().any(|t| is_inside(t.numerator()) || is_inside(t.denominator()));
    // Where the divisor of the connection of blocks vanishes the highest coefficient does: such a factor at the gain is not stable either way.
    let order = re.coeffs().len().max(im.coeffs().len()).saturating_sub(1);
    let highest = [&re, &im].map(|p| p.coeff(order));
    let rest = |f: &MultiPoly, highest: &MultiPoly| f.div_exact(&f.gcd(highest)).expect("a gcd divides");
    let is_highest = |f: &MultiPoly| highest.iter().any(|c| !c.is_zero() && !is_inside(&rest(f, c)));
    let divisors = || polynomial.poles.iter().chain([&denominator]).filter(|f| is_inside(f));
    if is_in_time || !divisors().all(is_highest) {
        return Err(refused("it is in the sample time, or in a divisor other than that of the connection of blocks"));
    }
    if own.is_none() && symbols.is_moving() {
        return Err(refused("beside functions of what is free it has to be free itself"));
    }
    let parts = [re, im].map(|p| p.coeffs().iter().map(|c| c.as_poly_in(at)).collect::<Vec<Poly<MultiPoly>>>());
    let all = || parts.iter().flatten();
    if all().any(|c| c.coeffs().len() > 2) || all().all(|c| c.coeff(0).is_zero()) {
        return Err(refused("it enters in another way"));
    }
    // What stands in the place of the parameter, which has no variable then.
    let factor = match own {
        Some(_) => (MultiPoly::variable(at), Rational::ONE),
        None => match value_of(problem, name).filter(|value| !value.is_zero()) {
            Some(value) => (MultiPoly::one(), value),
            None => return Err(refused("it has no value, or is zero")),
        },
    };
    let beside = |f: MultiPoly| if own.is_some() { f } else { f.map_variables(|i| if i > at { i - 1 } else { i }) };
    let part = |k: usize, scale: &Integer, times: &MultiPoly| {
        let of = |c: &Poly<MultiPoly>| beside(c.coeff(k)).scaled_by(scale).times(times);
        let [re, im] = parts.each_ref().map(|part| Poly::new(part.iter().map(of).collect()));
        Box::new(ComplexPoly { re, im })
    };
    let open = part(0, &factor.1.denominator(), &MultiPoly::one());
    let back = part(1, &factor.1.numerator(), &factor.0);
    let undefined = polynomial.poles.iter().fold(denominator, |product, pole| product.times(pole));
    let undefined = match own {
        Some(_) => undefined,
        None => undefined.substitute(at, &factor.1).0,
    };
    Ok((Of::Polynomials { open, back, undefined: beside(undefined) }, sample_time, symbols))
}

/// The value that a parameter or a constant has.
fn value_of(problem: &Problem, name: &str) -> Option<Rational> {
    let constant = || problem.model().constant(name).and_then(|c| c.number.clone());
    problem.set().iter().find(|(n, _)| n == name).map(|(_, value)| value.clone()).or_else(constant)
}

/// The real and the imaginary parts of a characteristic polynomial times the common denominator of all coefficients, and that.
fn cleared(
    polynomial: &CharacteristicPolynomial,
    complex: Option<&ComplexPolynomial>,
) -> ([Poly<MultiPoly>; 2], MultiPoly) {
    let Some(whole) = complex else {
        let (p, denominator) = polynomial.cleared();
        return ([p, Poly::zero()], denominator);
    };
    let coefficients = whole.re.iter().chain(&whole.im).cloned().collect();
    let (all, denominator) = CharacteristicPolynomial { coefficients, ..polynomial.clone() }.cleared();
    let coefficient = |k: usize| all.coeff(k);
    let count = whole.re.len();
    let [re, im] = [0..count, count..count + whole.im.len()].map(|of| Poly::new(of.map(coefficient).collect()));
    ([re, im], denominator)
}
