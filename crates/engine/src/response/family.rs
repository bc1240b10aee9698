//! The open loop with a parameter left in it, and where its margins may pass a required value.

use super::any_quotient::AnyQuotient;
use super::boundaries::{Boundaries, Elimination};
use super::open_loop::OpenLoop;
use super::opened::OpenedLoop;
use super::requirement::Requirement;
use crate::error::{Code, Diagnostic, Error};
use crate::model::{Cut, Opened};
use crate::problem::{Problem, fixed_symbols};
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic, UniPoly, discriminant, resultant,
};
use jurist_algebra::symbols::{Symbols, common_scale};
use std::sync::Arc;

/// Polynomials in what is free: in one parameter, or in two.
pub(crate) trait Parameters: Domain {
    /// True if symbols may follow the parameters.
    const HAS_SYMBOLS: bool;
    /// With the parameters as the first variables.
    fn lifted(&self) -> MultiPoly;
    /// From one in the first variables only.
    fn lowered(p: &MultiPoly) -> Self;
    /// Polynomials at a point, all times one positive integer, in symbols as their table numbers them.
    fn at_point(list: &[Self], point: &[Rational]) -> Vec<MultiPoly>;
}

impl Parameters for UniPoly {
    const HAS_SYMBOLS: bool = false;

    fn lifted(&self) -> MultiPoly {
        MultiPoly::from_univariate(self, 0)
    }
    fn lowered(p: &MultiPoly) -> Self {
        p.to_univariate(0).expect("one variable is left")
    }
    fn at_point(list: &[Self], point: &[Rational]) -> Vec<MultiPoly> {
        common_scale(&list.iter().map(Self::lifted).collect::<Vec<_>>(), &point[0])
    }
}

impl Parameters for MultiPoly {
    const HAS_SYMBOLS: bool = true;

    fn lifted(&self) -> MultiPoly {
        self.clone()
    }
    fn lowered(p: &MultiPoly) -> Self {
        p.clone()
    }
    fn at_point(list: &[Self], point: &[Rational]) -> Vec<MultiPoly> {
        point.iter().fold(list.to_vec(), |list, value| common_scale(&list, value))
    }
}

/// The open loop with what is free left in it: polynomials in the frequency's variable over those in the parameters.
pub(crate) struct Family<R: Domain> {
    quotient: AnyQuotient<R>,
    sample_time: Option<Rational>,
    cut: Cut,
    /// The number of parameters.
    free: usize,
    /// The symbols that follow them.
    pub symbols: Arc<Symbols>,
    /// Where the open loop is undefined.
    pub undefined: R,
}

/// `N/D0` over a ring in which the parameters are.
pub(super) struct Quotient<R> {
    pub denominator: Poly<R>,
    pub numerator: Poly<R>,
    pub shape: Shape,
}

/// By resultants that are expanded; conjugates of the required number come with it.
struct Expanded {
    /// The variable of the required number.
    variable: usize,
}

impl<R: Parameters> Family<R> {
    pub fn of(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<Family<R>, Error> {
        Family::of_cut(problem, problem.model().cut(at)?, budget)
    }

    pub fn of_cut(problem: &Problem, cut: Cut, budget: &Budget) -> Result<Family<R>, Error> {
        let mut opened = OpenedLoop::of(problem, cut, budget)?;
        if !R::HAS_SYMBOLS {
            opened = opened.without_symbols()?;
        }
        let symbols = Arc::new(fixed_symbols(&opened.symbols)?);
        let (quotient, undefined) = opened.any_quotient(R::lowered, budget)?;
        let sample_time = opened.sample_time.and_then(|t| t.as_constant());
        Ok(Family { quotient, sample_time, cut: opened.cut, free: problem.free().len(), symbols, undefined })
    }

    /// `D0` and `N` with the open loop `N/D0`, in the variable of the closed loop.
    ///
    /// # Panics
    /// Where they have complex coefficients.
    pub fn parts(&self) -> [&Poly<R>; 2] {
        let AnyQuotient::Real(quotient) = &self.quotient else { panic!("complex loops are refused before") };
        [&quotient.denominator, &quotient.numerator]
    }

    /// `N/D0`.
    pub(super) fn quotient(&self) -> &AnyQuotient<R> {
        &self.quotient
    }

    /// The open loop at a point.
    pub fn at(&self, point: &[Rational]) -> OpenLoop {
        let [re, im, numerator_re, numerator_im] = self.quotient.lists();
        let lengths = [re, im, numerator_re].map(|list| list.len());
        let all: Vec<R> = [re, im, numerator_re, numerator_im].concat();
        let mut rest = R::at_point(&all, point).into_iter();
        let mut next = |count: usize| Poly::new(rest.by_ref().take(count).collect());
        let [re, im, numerator_re] = lengths.map(&mut next);
        let lists = [re, im, numerator_re, next(usize::MAX)];
        let (shape, sample_time) = (self.quotient.shape(), self.sample_time.clone());
        OpenLoop::over_symbols(self.cut.clone(), lists, &self.symbols, shape, sample_time)
    }

    pub fn boundaries(&self, requirement: &Requirement, budget: &Budget) -> Result<Boundaries<R>, Exhausted> {
        self.quotient.boundaries(&Expanded { variable: self.free + self.symbols.len() }, requirement, budget)
    }
}

impl<R: Domain> Quotient<R> {
    /// From the cut to the cut, and the common denominator of all coefficients. A closed loop `N/D` is that of `N/(D - N)`.
    pub fn of(
        Opened { system, is_closed, .. }: &Opened,
        shape: Shape,
        ring: impl Fn(&MultiPoly) -> R,
        budget: &Budget,
    ) -> Result<(Quotient<R>, R), Error> {
        let column = system.inputs.len().max(system.e.columns()) - 1;
        let transfer = system.between(0, column).transfer_function_at(0, column, budget)?;
        let signed = |f: &RationalFunction| if *is_closed { f.clone() } else { -f };
        let all: Vec<RationalFunction> =
            transfer.denominator.coefficients.iter().cloned().chain(transfer.numerator.iter().map(signed)).collect();
        budget
            .enter(|| {
                let common = all.iter().fold(R::one(), |l, f| {
                    let d = ring(f.denominator());
                    l.times(&d.div_exact(&l.gcd(&d)).expect("a gcd divides"))
                });
                let cleared = |f: &RationalFunction| {
                    let factor = common.div_exact(&ring(f.denominator())).expect("a common multiple");
                    ring(f.numerator()).times(&factor)
                };
                let split = transfer.denominator.coefficients.len();
                let denominator: Poly<R> = Poly::new(all[..split].iter().map(cleared).collect());
                let numerator: Poly<R> = Poly::new(all[split..].iter().map(cleared).collect());
                let denominator = if *is_closed { denominator.minus(&numerator) } else { denominator };
                (Quotient { denominator, numerator, shape }, common)
            })
            .map_err(Error::from)
    }

    /// With other coefficients.
    pub fn map<S: Domain>(&self, f: impl Fn(&R) -> S) -> Quotient<S> {
        Quotient { denominator: self.denominator.map(&f), numerator: self.numerator.map(&f), shape: self.shape }
    }
}

impl<R: Parameters> Elimination<R> for Expanded {
    type Left = R;

    fn function(&self, f: R) -> R {
        f
    }

    fn common_root(
        &self,
        p: &Poly<R>,
        a: &Poly<R>,
        b: &Poly<R>,
        alpha: &RealAlgebraic,
        budget: &Budget,
    ) -> Result<R, Exhausted> {
        if let Some(alpha) = alpha.exact() {
            return resultant(p, &plus_multiple(a, b, &alpha), budget);
        }
        let lift = |p: &Poly<R>| p.map(R::lifted);
        let with = lift(a).plus(&lift(b).scaled(&MultiPoly::variable(self.variable)));
        let value = resultant(&lift(p), &with, budget)?;
        self.norm_of(&value, alpha, budget)
    }

    fn sum(&self, a: &R, b: &R, alpha: &RealAlgebraic, budget: &Budget) -> Result<R, Exhausted> {
        if let Some(alpha) = alpha.exact() {
            return Ok(plus_multiple_of(a, b, &alpha));
        }
        self.norm_of(&a.lifted().plus(&b.lifted().times(&MultiPoly::variable(self.variable))), alpha, budget)
    }

    fn discriminant(&self, p: &Poly<R>, budget: &Budget) -> Result<R, Exhausted> {
        discriminant(p, budget)
    }
}

impl Expanded {
    /// The resultant with the polynomial of `alpha`, the variable after those that are free.
    fn norm_of<R: Parameters>(
        &self,
        value: &MultiPoly,
        alpha: &RealAlgebraic,
        budget: &Budget,
    ) -> Result<R, Exhausted> {
        let in_alpha = value.as_poly_in(self.variable);
        let polynomial = alpha.polynomial().map(|c| MultiPoly::constant(c.clone()));
        let left = if in_alpha.is_constant() { in_alpha.coeff(0) } else { resultant(&in_alpha, &polynomial, budget)? };
        Ok(R::lowered(&left))
    }
}

/// The refusal of a cut through which there is no loop.
pub(super) fn nothing_comes_back(cut: &Cut) -> Error {
    let message = match cut {
        Cut::Between(between) => format!("nothing comes from '{}' to '{}'", between.input, between.output),
        _ => format!("nothing comes back to '{}': there is no loop through it", cut.name()),
    };
    Diagnostic::error(Code::Cut, message).into()
}

/// `a + alpha b` times the denominator of `alpha`.
pub(super) fn plus_multiple<R: Domain>(a: &Poly<R>, b: &Poly<R>, alpha: &Rational) -> Poly<R> {
    a.scaled(&R::from_integer(&alpha.denominator())).plus(&b.scaled(&R::from_integer(&alpha.numerator())))
}

/// The same of numbers.
pub(super) fn plus_multiple_of<R: Domain>(a: &R, b: &R, alpha: &Rational) -> R {
    a.times(&R::from_integer(&alpha.denominator())).plus(&b.times(&R::from_integer(&alpha.numerator())))
}
