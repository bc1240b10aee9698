//! Loops with dead time: the characteristic function as a polynomial in `s`, `exp(-tau s)` and what is free.

use super::beside_dead_time::{Constants, refused_beside, refused_in_delay};
use super::evaluation::Algebra;
use super::region::Bound;
use super::resolved::Problem;
use crate::error::{Code, Diagnostic, Error};
use crate::stability::ParametricPolynomial;
use crate::stability::dead_time::{ConstantParts, FamilyLoop, GainLoop, Line, QuasiPolynomial};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use jurist_algebra::symbols::Symbols;

/// The characteristic function `sum P_k(s) z^k`, `z = exp(-tau s)`, of a loop with dead times that are multiples of one.
#[derive(Clone, Debug, PartialEq)]
pub struct DelayedLoop {
    /// The coefficient of `z^k s^j` as a polynomial in the free parameter, at `[k][j]`; none where there are constants that are not rational.
    parts: Vec<Vec<UniPoly>>,
    /// The same where there are such constants.
    over_constants: Option<ConstantParts>,
    delay: BaseDelay,
    /// The roots are to lie left of `Re s = -decay`; `s` is counted from there.
    decay: Line,
    /// The loop is undefined where one of these vanishes.
    poles: Vec<UniPoly>,
}

/// The dead time of which the others are multiples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BaseDelay {
    /// A positive number.
    Number(Rational),
    /// `slope p + offset` in the free parameter.
    Line {
        /// The slope, not zero.
        slope: Rational,
        /// The value at zero.
        offset: Rational,
    },
}

/// The refusal of a question about a loop with dead time.
pub(crate) fn refused(message: impl Into<String>, help: impl Into<String>) -> Error {
    Diagnostic::error(Code::DeadTime, message).help(help).into()
}

impl DelayedLoop {
    /// The loop with dead time that the algebra of a question is; `None` without dead time.
    pub(super) fn of(problem: &Problem, algebra: &Algebra, budget: &Budget) -> Result<Option<DelayedLoop>, Error> {
        let delays = algebra.symbols().delays();
        let Some(polynomial) = algebra.polynomial().filter(|_| !delays.is_empty()) else { return Ok(None) };
        let free = problem.free().len();
        if free > 1 {
            let help = "ask for one parameter, 'intervals --param NAME', or for a map by boxes";
            return Err(refused("this cannot be asked of two parameters in a loop with dead time", help));
        }
        // A decay rate that is asked for is one more variable before the symbols.
        let room = usize::from(problem.region().is_free());
        let constants = Constants::of(algebra.symbols(), room)?;
        if constants.are_in(&delays, room) {
            return Err(refused_in_delay());
        }
        let (delay, powers) = base_delay(&delays)?;
        let power_of = |variable: usize| delays.iter().position(|(v, _)| *v + room == variable).map(|i| powers[i]);
        let decay = match problem.region().bound() {
            Bound::Number(decay) => Line::constant(decay.clone()),
            Bound::Free => Line { slope: Rational::ONE, offset: Rational::ZERO },
        };
        budget.enter(|| {
            let (parts, common) =
                sorted(&polynomial.coefficients, constants.len(), |v| constants.position(v), power_of)?;
            let divisors = || polynomial.poles.iter().chain([&common]);
            if !constants.is_empty() {
                let placed = |p: &MultiPoly| p.map_variables(|v| constants.position(v).map_or(0, |i| i + 1));
                let divisors = divisors().map(placed).collect();
                return DelayedLoop::with_constants(parts, divisors, constants.table, (delay, decay)).map(Some);
            }
            let in_parameter = |c: &MultiPoly| c.to_univariate(0).expect("the parameter alone is left");
            let parts = parts.iter().map(|part| part.iter().map(in_parameter).collect()).collect();
            let pole = |p: &MultiPoly| p.to_univariate(0).filter(|p| !p.is_constant());
            let poles = divisors().filter_map(pole).collect();
            Ok(Some(DelayedLoop { parts, over_constants: None, delay, decay, poles }.without_content()))
        })?
    }

    /// `D0 + N exp(-tau s)` in one parameter (0) and constants behind it, at a dead time that is not zero, and what must not vanish; `None` where the dead
    /// time is no straight line in the parameter.
    ///
    /// # Errors
    /// `E-dead-time` where nothing is known of what constants divide by.
    pub(crate) fn of_factor(
        [denominator, numerator]: [&Poly<MultiPoly>; 2],
        tau: &RationalFunction,
        undefined: &MultiPoly,
        constants: &Symbols,
    ) -> Result<Option<DelayedLoop>, Error> {
        let is_in_one = tau.variables().iter().all(|variable| *variable == 0);
        let Some((delay, _)) = base_delay(&[(0, tau.clone())]).ok().filter(|_| is_in_one) else { return Ok(None) };
        let order = denominator.coeffs().len().max(numerator.coeffs().len());
        let parts: Vec<Vec<MultiPoly>> =
            [denominator, numerator].map(|p| (0..order).map(|j| p.coeff(j)).collect()).into();
        let decay = Line::constant(Rational::ZERO);
        let in_one = |p: &MultiPoly| p.to_univariate(0);
        let exact = parts.iter().map(|part| part.iter().map(in_one).collect()).collect::<Option<Vec<Vec<UniPoly>>>>();
        match (exact, in_one(undefined)) {
            (Some(parts), Some(undefined)) => {
                let poles = vec![undefined];
                Ok(Some(DelayedLoop { parts, over_constants: None, delay, decay, poles }.without_content()))
            }
            _ => {
                let divisors = vec![undefined.clone()];
                DelayedLoop::with_constants(parts, divisors, constants.clone(), (delay, decay)).map(Some)
            }
        }
    }

    /// Where a common factor of all coefficients vanishes the function does so identically.
    fn without_content(mut self) -> DelayedLoop {
        let content = self.parts.iter().flatten().fold(UniPoly::zero(), |g, p| g.gcd(p));
        if !content.is_constant() {
            for p in self.parts.iter_mut().flatten() {
                *p = p.div_exact(&content).expect("the content divides");
            }
            self.poles.push(content);
        }
        self
    }

    /// The loop whose coefficients have constants that are not rational behind the parameter, beside what it is divided by.
    fn with_constants(
        mut parts: Vec<Vec<MultiPoly>>,
        divisors: Vec<MultiPoly>,
        table: Symbols,
        (delay, decay): (BaseDelay, Line),
    ) -> Result<DelayedLoop, Error> {
        let content = parts.iter().flatten().fold(MultiPoly::zero(), |g, p| g.gcd(p));
        if !content.is_constant() {
            parts.iter_mut().flatten().for_each(|p| *p = p.div_exact(&content).expect("the content divides"));
        }
        // Where the dead times cancel, and where a pole depends on constants, nothing is known.
        if parts.iter().skip(1).flatten().all(MultiPoly::is_zero) {
            return Err(refused_beside());
        }
        let mut poles = Vec::new();
        for divisor in divisors.into_iter().chain([content]) {
            poles.extend(pole_beside(&divisor, &table)?);
        }
        let over_constants = Some(ConstantParts::new(parts, table));
        Ok(DelayedLoop { parts: Vec::new(), over_constants, delay, decay, poles })
    }

    /// The coefficients where there are constants that are not rational.
    pub fn over_constants(&self) -> Option<&ConstantParts> {
        self.over_constants.as_ref()
    }

    /// Whether all coefficients are rational.
    pub fn is_exact(&self) -> bool {
        self.over_constants.is_none()
    }

    /// The dead time of which the others are multiples.
    pub fn delay(&self) -> &BaseDelay {
        &self.delay
    }

    /// The line `Re s = -decay` left of which the roots are to lie, and from which `s` is counted.
    pub fn decay(&self) -> &Line {
        &self.decay
    }

    /// Whether the dead times cancel.
    pub fn is_rational(&self) -> bool {
        self.is_exact() && self.parts.iter().skip(1).flatten().all(UniPoly::is_zero)
    }

    /// The polynomial in `s` of a loop whose dead times cancel, its coefficients polynomials in the free parameter.
    ///
    /// # Panics
    /// When they do not [cancel](DelayedLoop::is_rational).
    pub fn polynomial(&self) -> ParametricPolynomial {
        assert!(self.is_rational(), "the dead times cancel");
        let part = self.parts.first().cloned().unwrap_or_default();
        let order = part.iter().rposition(|c| !c.is_zero()).unwrap_or(0);
        let coefficients: Vec<_> = part.into_iter().take(order + 1).map(|c| (c, UniPoly::one())).collect();
        ParametricPolynomial::new(&coefficients, order, self.poles.clone())
    }

    /// The loop with the free parameter wherever it enters; `None` where it vanishes identically.
    pub fn family(&self) -> Option<FamilyLoop> {
        let tau = match &self.delay {
            BaseDelay::Number(tau) => Line::constant(tau.clone()),
            BaseDelay::Line { slope, offset } => Line { slope: slope.clone(), offset: offset.clone() },
        };
        if let Some(over) = &self.over_constants {
            return Some(FamilyLoop::enclosed(over.clone(), tau, self.decay.clone()));
        }
        if self.parts.iter().flatten().all(UniPoly::is_zero) {
            return None;
        }
        Some(FamilyLoop::new(self.parts.clone(), tau, self.decay.clone()))
    }

    /// Polynomials in the free parameter at whose zeros the loop is undefined, or its function vanishes identically.
    pub fn poles(&self) -> &[UniPoly] {
        &self.poles
    }

    /// The function without parameter; `None` where it is zero.
    ///
    /// # Panics
    /// When its coefficients depend on the free parameter.
    pub fn quasi_polynomial(&self) -> Option<QuasiPolynomial> {
        assert!(self.degree_in_parameter() == 0, "the coefficients are numbers");
        let part = |list: &Vec<UniPoly>| UniPoly::new(list.iter().map(|c| c.coeff(0)).collect());
        QuasiPolynomial::new(self.parts.iter().map(part).collect())
    }

    /// The degree of the coefficients in the free parameter.
    pub fn degree_in_parameter(&self) -> usize {
        self.parts.iter().flatten().filter_map(UniPoly::degree).max().unwrap_or(0)
    }

    /// The loop with the free parameter as a gain; `None` unless it enters affinely and the dead time is a number.
    pub fn gain_loop(&self) -> Option<GainLoop> {
        let BaseDelay::Number(tau) = &self.delay else { return None };
        if self.degree_in_parameter() > 1 || self.parts.is_empty() {
            return None;
        }
        let part = |k: usize| {
            let of = move |list: &Vec<UniPoly>| UniPoly::new(list.iter().map(|c| c.coeff(k)).collect());
            self.parts.iter().map(of).collect()
        };
        Some(GainLoop::new(part(0), part(1), tau.clone()))
    }
}

/// The coefficients of `z^k s^j` at `[k][j]` times their common denominator, in the parameter (0) and in so many constants behind it, and that denominator;
/// `position` is the number of the constant and `power_of` the power of `z` that a variable stands for.
///
/// # Errors
/// `E-dead-time` where the loop divides by a delay, and for dead times that are too large multiples of their greatest common divisor.
pub(super) fn sorted(
    coefficients: &[RationalFunction],
    constants: usize,
    position: impl Fn(usize) -> Option<usize>,
    power_of: impl Fn(usize) -> Option<usize>,
) -> Result<(Vec<Vec<MultiPoly>>, MultiPoly), Error> {
    let (scaled, common) = cleared(coefficients, |v| power_of(v).is_some())?;
    let mut parts: Vec<Vec<MultiPoly>> = Vec::new();
    for (j, f) in scaled.iter().enumerate() {
        // Numerator over an integer: numbers are put in only now.
        let bottom = f.denominator().as_constant().expect("the common denominator is divided out");
        assert!(bottom.is_one(), "a numerator takes the integers");
        for (monomial, c) in f.numerator().terms() {
            let mut own = vec![0u32; 1 + constants];
            let mut k = 0usize;
            for (variable, &e) in monomial.exponents().iter().enumerate() {
                match (power_of(variable), position(variable)) {
                    (Some(multiple), _) => k += multiple * e as usize,
                    (None, Some(constant)) => own[1 + constant] += e,
                    (None, None) => own[0] += e,
                }
            }
            if k > MOST_MULTIPLES {
                return Err(too_many());
            }
            while parts.len() <= k {
                parts.push(vec![MultiPoly::zero(); scaled.len()]);
            }
            parts[k][j] = parts[k][j].plus(&MultiPoly::from_terms([(own, c.clone())]));
        }
    }
    Ok((parts, common))
}

/// A polynomial in the parameter (0) and in constants as what must not vanish; `None` where it does not anyway. The constants may be in a factor, as in `2 pi f`.
///
/// # Errors
/// `E-dead-time` where the rest depends on constants, too, and where the factor may vanish.
fn pole_beside(pole: &MultiPoly, constants: &Symbols) -> Result<Option<UniPoly>, Error> {
    let factor = pole.as_poly_in(0).content();
    let rest = pole.div_exact(&factor).expect("the content divides").to_univariate(0).ok_or_else(refused_beside)?;
    let value = || constants.enclose(&factor.map_variables(|v| v - 1), BITS_OF_POLE);
    if !factor.is_constant() && value().contains_zero() {
        return Err(refused_beside());
    }
    Ok(Some(rest).filter(|rest| !rest.is_constant()))
}

/// Bits with which a divisor is to be seen different from 0.
const BITS_OF_POLE: u64 = 256;

/// The coefficients times their common denominator, and that.
pub(super) fn cleared(
    coefficients: &[RationalFunction],
    is_delay: impl Fn(usize) -> bool,
) -> Result<(Vec<RationalFunction>, MultiPoly), Error> {
    let mut common = MultiPoly::one();
    for f in coefficients {
        let d = f.denominator();
        let g = common.gcd(d);
        common = common.times(&d.div_exact(&g).expect("a common divisor divides"));
    }
    if common.variables().into_iter().any(is_delay) {
        let help = "multiply the equation by its denominators";
        return Err(refused("the characteristic function divides by an expression in exp(-tau*s)", help));
    }
    let factor = RationalFunction::from(common.clone());
    Ok((coefficients.iter().map(|f| f * &factor).collect(), common))
}

/// Dead times that are larger multiples of their greatest common divisor are refused.
const MOST_MULTIPLES: usize = 256;

fn too_many() -> Error {
    let help = format!("round them: the largest may be {MOST_MULTIPLES} times their greatest common divisor");
    refused("the dead times have no common divisor that is large enough", help)
}

/// The greatest common divisor of the dead times, and what multiples of it they are.
pub(crate) fn base_delay(delays: &[(usize, RationalFunction)]) -> Result<(BaseDelay, Vec<usize>), Error> {
    let first = &delays[0].1;
    let mut ratios = Vec::with_capacity(delays.len());
    for (_, delay) in delays {
        match delay.checked_div(first).and_then(|ratio| ratio.as_constant()) {
            Some(ratio) if ratio.sign().is_gt() => ratios.push(ratio),
            _ => {
                let help = "give all dead times but one base as numbers, or as multiples of one parameter; where that is \
                            not so, ask 'map' with windows, 'tolerance --tol NAME=LO..HI', or 'verdict --set NAME=VALUE'";
                return Err(refused("the dead times are not rational multiples of one of them", help));
            }
        }
    }
    // The ratios are n_i/d_i: their greatest common divisor is gcd(n_i L/d_i)/L.
    let common = ratios.iter().fold(Integer::ONE, |l, r| l.lcm(&r.denominator()));
    let scaled: Vec<Integer> = ratios.iter().map(|r| (r * &Rational::from(&common)).numerator()).collect();
    let divisor = scaled.iter().fold(Integer::ZERO, |g, n| g.gcd(n));
    let mut powers = Vec::with_capacity(scaled.len());
    for n in &scaled {
        let multiple = n.div_exact(&divisor).to_i64().and_then(|m| usize::try_from(m).ok());
        powers.push(multiple.filter(|&m| m <= MOST_MULTIPLES).ok_or_else(too_many)?);
    }
    let unit = Rational::new(divisor, common);
    if let Some(number) = first.as_constant() {
        return Ok((BaseDelay::Number(number * unit), powers));
    }
    let line = || {
        let (n, d) = (first.numerator().to_univariate(0)?, first.denominator().as_constant()?);
        let over = |c: Integer| Rational::new(c, d.clone()) * unit.clone();
        (n.degree() == Some(1)).then(|| (over(n.coeff(1)), over(n.coeff(0))))
    };
    match line() {
        Some((slope, offset)) => Ok((BaseDelay::Line { slope, offset }, powers)),
        None => {
            let help = "the parameter may enter a dead time as a*p + b with numbers a and b";
            Err(refused("the dead time is not a straight line in the free parameter", help))
        }
    }
}
