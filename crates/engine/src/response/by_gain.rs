//! A parameter as the loop's gain.

use super::ground::Integers;
use super::open_loop::{Over, WithTimes};
use super::parts::{Parts, integral, without_denominators};
use crate::error::{Code, Diagnostic, Error};
use crate::model::ComplexPolynomial;
use crate::problem::Problem;
use crate::stability::ParametricPolynomial;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};

/// The polynomial in the parameter, if it is affine there.
fn affine(problem: &Problem, name: &str, budget: &Budget) -> Result<Option<WithTimes>, Error> {
    let model = problem.model();
    let constant = model.constant(name).and_then(|c| c.number.clone());
    let nominal = problem.set().iter().find(|(n, _)| n == name).map(|(_, v)| v.clone()).or(constant);
    let Some(nominal) = nominal.filter(|v| !v.is_zero()) else { return Ok(None) };
    let others: Vec<(String, Rational)> = problem.set().iter().filter(|(n, _)| n != name).cloned().collect();
    let evaluated = model.evaluate(&[name.to_owned()], &others, budget)?;
    // Where the sample time depends on it, a parameter is no gain.
    let sample_time = evaluated.sample_time.map(|t| t.as_constant());
    if sample_time == Some(None) || evaluated.symbols.is_moving() {
        return Ok(None);
    }
    let d = &evaluated.polynomial;
    let over = match (&evaluated.complex, evaluated.symbols.is_empty()) {
        (Some(whole), _) => over_complex(whole, &d.poles, &nominal, &evaluated.symbols, problem)?,
        (None, true) => over_integers(d, &nominal, problem)?,
        (None, false) => over_constants(d, &nominal, &evaluated.symbols, problem)?,
    };
    Ok(over.map(|over| (over, sample_time.flatten())))
}

fn over_integers(
    d: &CharacteristicPolynomial,
    nominal: &Rational,
    problem: &Problem,
) -> Result<Option<(Over, Option<Rational>)>, Error> {
    let side = |p: &MultiPoly| p.to_univariate(0).expect("one variable is kept");
    let coefficients: Vec<_> = d.coefficients.iter().map(|c| (side(c.numerator()), side(c.denominator()))).collect();
    let parametric = ParametricPolynomial::new(&coefficients, d.formal_degree, Vec::new());
    let is_affine = |p: &Poly<UniPoly>| p.coeffs().iter().all(|c| c.coeffs().len() <= 2);
    // A factor that all coefficients share is part of the loop where that is affine, else it is a pole.
    let whole = parametric.polynomial().scaled(parametric.content());
    let (p, shared) = match is_affine(&whole) {
        true => (&whole, UniPoly::one()),
        false => (parametric.polynomial(), parametric.content().clone()),
    };
    if !is_affine(p) || p.coeffs().iter().all(|c| c.coeff(0).is_zero()) {
        return Ok(None);
    }
    let part = |k: usize| (0..=d.formal_degree).map(move |i| Rational::from(p.coeff(i).coeff(k)));
    let [below, above] = integral([part(0).collect(), part(1).map(|c| c * nominal).collect()]);
    let poles = d.poles.iter().map(side).chain([parametric.denominator().clone(), shared]);
    let poles = poles.filter(|p| !p.is_constant()).map(|p| in_factor(&p, nominal)).collect();
    Ok(Some((Over::Integers(Parts::new(Integers, below, above, poles, problem.shape())), None)))
}

/// A polynomial in the factor: the parameter is the factor times its nominal value `p/q`.
fn in_factor<R: Domain>(p: &Poly<R>, nominal: &Rational) -> Poly<R> {
    let (up, down) = (nominal.numerator(), nominal.denominator());
    let n = p.coeffs().len().saturating_sub(1);
    let scale = |i: usize| R::from_integer(&(up.pow(i as u64) * down.pow((n - i) as u64)));
    Poly::new(p.coeffs().iter().enumerate().map(|(i, c)| c.times(&scale(i))).collect())
}

/// The same where the coefficients (parameter: variable 0) contain symbols.
fn over_constants(
    d: &CharacteristicPolynomial,
    nominal: &Rational,
    symbols: &crate::model::Symbols,
    problem: &Problem,
) -> Result<Option<(Over, Option<Rational>)>, Error> {
    let (cleared, denominator) = d.cleared();
    let beside = |c: &MultiPoly| c.map_variables(|i| i.saturating_sub(1));
    let in_parameter = |c: &MultiPoly| in_factor(&c.as_poly_in(0).map(beside), nominal);
    let parts: Vec<Poly<MultiPoly>> = cleared.coeffs().iter().map(|c| c.as_poly_in(0).map(beside)).collect();
    if parts.iter().any(|c| c.coeffs().len() > 2) || parts.iter().all(|c| c.coeff(0).is_zero()) {
        return Ok(None);
    }
    let scaled = |c: MultiPoly| &RationalFunction::from(c) * &RationalFunction::from(nominal.clone());
    let below = parts.iter().map(|c| c.coeff(0).into()).collect();
    let above = parts.iter().map(|c| scaled(c.coeff(1))).collect();
    let poles = d.poles.iter().chain([&denominator]).filter(|p| p.degree_in(0) > 0).map(in_parameter).collect();
    Over::new(below, above, poles, symbols, problem.shape()).map(Some)
}

/// The same of a polynomial with complex coefficients.
fn over_complex(
    whole: &ComplexPolynomial,
    poles: &[MultiPoly],
    nominal: &Rational,
    symbols: &crate::model::Symbols,
    problem: &Problem,
) -> Result<Option<(Over, Option<Rational>)>, Error> {
    if whole.re.iter().chain(&whole.im).any(|f| f.denominator().degree_in(0) > 0) {
        return Ok(None);
    }
    let Some(lists) = affine_parts(whole, nominal) else { return Ok(None) };
    let beside = |c: &MultiPoly| c.map_variables(|i| i.saturating_sub(1));
    let poles = poles.iter().filter(|p| p.degree_in(0) > 0).map(|p| in_factor(&p.as_poly_in(0).map(beside), nominal));
    Over::of_complex(lists, poles.collect(), symbols, problem.shape()).map(Some)
}

/// The real and the imaginary parts of `D0`, and of `N` times a number, of a polynomial `D0 + k N` in the parameter `k` (variable 0), without denominators;
/// `None` of another one.
pub(super) fn affine_parts(whole: &ComplexPolynomial, factor: &Rational) -> Option<[Vec<RationalFunction>; 4]> {
    let beside = |c: &MultiPoly| c.map_variables(|i| i.saturating_sub(1));
    let cleared = without_denominators([whole.re.clone(), whole.im.clone()]);
    let parts = cleared.map(|p| p.coeffs().iter().map(|c| c.as_poly_in(0).map(beside)).collect::<Vec<_>>());
    let all = || parts.iter().flatten();
    if all().any(|c| c.coeffs().len() > 2) || all().all(|c| c.coeff(0).is_zero()) {
        return None;
    }
    let factor = RationalFunction::from(factor.clone());
    let below = |part: &[Poly<MultiPoly>]| part.iter().map(|c| c.coeff(0).into()).collect();
    let above = |part: &[Poly<MultiPoly>]| part.iter().map(|c| &RationalFunction::from(c.coeff(1)) * &factor).collect();
    Some([below(&parts[0]), below(&parts[1]), above(&parts[0]), above(&parts[1])])
}

pub(super) fn by_gain(problem: &Problem, name: &str, budget: &Budget) -> Result<WithTimes, Error> {
    affine(problem, name, budget)?.ok_or_else(|| {
        let message = format!("'{}' is not a gain of the loop", crate::model::shorten(name));
        Diagnostic::error(Code::Cut, message)
            .help("a parameter is one where it enters the characteristic polynomial to the first power and is not 0")
            .into()
    })
}

/// The only parameter that enters as a gain, of a loop that has no signals.
pub(super) fn only_gain(problem: &Problem, budget: &Budget) -> Result<Option<String>, Error> {
    if matches!(problem.model().form(), crate::model::Form::Blocks(_)) {
        return Ok(None);
    }
    let mut found = None;
    for parameter in problem.model().parameters() {
        if affine(problem, &parameter.name, budget)?.is_some_and(|((over, _), _)| !over.is_open()) {
            if found.is_some() {
                return Ok(None);
            }
            found = Some(parameter.name.clone());
        }
    }
    Ok(found)
}
