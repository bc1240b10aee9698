//! The open loop as two polynomials.

use super::Frequencies;
use super::by_gain::{by_gain, only_gain};
use super::family::nothing_comes_back;
use super::ground::{Constants, Ground, Integers};
use super::parts::{Parts, Reduced, integral, with_parts, without_denominators};
use crate::coverage::refusals::{BESIDE_DEAD_TIME, ONE_FACTOR};
use crate::error::{Code, Error};
use crate::model::{ClosedLoop, Cut, Opened};
use crate::problem::{EnclosedQuotient, Problem, exact_or_enclosed};
use crate::stability::Shape;
use jurist_algebra::ball::{Ball, cos_sin};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use jurist_algebra::symbols::{Definition, Symbols};
use std::sync::Arc;

/// `D(z; k) = D0 + k N`: the characteristic polynomial with the factor `k` at the cut, nominally 1.
///
/// The coefficients are integers, or polynomials in the constants of a plant behind a hold.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
/// use jurist_engine::problem::Ask;
/// use jurist_engine::response::OpenLoop;
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/z"))
///     .build()?;
/// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
/// let open_loop = OpenLoop::of(&problem, None, &budget)?; // 0.5/z
/// assert_eq!(open_loop.denominator(), Some(&UniPoly::from_i64(&[0, 2])));
/// assert_eq!(open_loop.numerator(), Some(&UniPoly::from_i64(&[1])));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct OpenLoop {
    cut: Cut,
    shape: Shape,
    sample_time: Option<Rational>,
    over: Over,
    dead_time: Option<Rational>,
}

/// The polynomials over what their coefficients are.
#[derive(Clone, Debug)]
pub(crate) enum Over {
    Integers(Parts<Integers>),
    Constants(Parts<Constants>),
}

/// The polynomials and the dead time of a factor `exp(-tau s)`, and the sample time.
pub(super) type WithTimes = ((Over, Option<Rational>), Option<Rational>);

impl OpenLoop {
    /// The loop of a problem without free parameters, cut at a name as in [`Model::cut`](crate::model::Model::cut).
    ///
    /// Cost: that of evaluating the model, and two characteristic polynomials.
    ///
    /// # Errors
    /// [`Error::Refused`] as [`Model::cut`](crate::model::Model::cut), and where a parameter does not enter affinely or is nominally 0, or nothing
    /// comes back to the cut; [`Error::Undefined`], [`Error::Stopped`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn of(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<OpenLoop, Error> {
        let open_loop = OpenLoop::of_any(problem, at, budget)?;
        if open_loop.is_zero() {
            return Err(nothing_comes_back(&open_loop.cut));
        }
        Ok(open_loop)
    }

    /// The same with polynomials over the constants of holds, however long they are.
    pub(super) fn exact(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<OpenLoop, Error> {
        OpenLoop::with(problem, at, false, budget)
    }

    /// The same as [`OpenLoop::of`], also where nothing comes back, as at one value of a gain.
    pub(super) fn of_any(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<OpenLoop, Error> {
        OpenLoop::with(problem, at, true, budget)
    }

    fn with(problem: &Problem, at: Option<&str>, or_enclosed: bool, budget: &Budget) -> Result<OpenLoop, Error> {
        assert!(problem.free().is_empty(), "every parameter has a value");
        let model = problem.model();
        let cut = match (model.cut(at), at) {
            (Ok(cut), _) => cut,
            // Of several parameters, one that enters as a gain is meant if it is the only one.
            (Err(refused), None) if refused.code() == Code::Cut => match only_gain(problem, budget)? {
                Some(name) => Cut::Gain(name),
                None => return Err(refused.into()),
            },
            (Err(refused), _) => return Err(refused.into()),
        };
        OpenLoop::cut_at(problem, cut, or_enclosed, budget)
    }

    /// The loop of a problem without free parameters at a cut, also where nothing comes back.
    pub(super) fn of_cut(problem: &Problem, cut: Cut, budget: &Budget) -> Result<OpenLoop, Error> {
        OpenLoop::cut_at(problem, cut, true, budget)
    }

    fn cut_at(problem: &Problem, cut: Cut, or_enclosed: bool, budget: &Budget) -> Result<OpenLoop, Error> {
        let model = problem.model();
        let shape = problem.shape();
        let or_enclosed = or_enclosed && !matches!(cut, Cut::Between(_));
        let ((over, dead_time), sample_time) = match &cut {
            Cut::Gain(name) => by_gain(problem, name, budget)?,
            _ if or_enclosed && model.has_holds() => exact_or_enclosed(
                budget,
                |budget| opened_exactly(problem, &cut, budget),
                |budget| {
                    let opened = model.opened_in_numbers(&cut, &[], problem.set(), budget)?;
                    if opened.system.is_complex {
                        return Ok(None);
                    }
                    let sample_time = opened.sample_time.as_ref().and_then(RationalFunction::as_constant);
                    let over = budget.enter(|| Some(Over::of_enclosed(EnclosedQuotient::of(&opened)?, shape)))?;
                    Ok(over.map(|over| ((over, None), sample_time)))
                },
            )?,
            _ => opened_exactly(problem, &cut, budget)?,
        };
        Ok(OpenLoop { cut, shape, sample_time, over, dead_time })
    }

    /// The loop with the open loop times a number: `D0` and `N` times its denominator and its numerator.
    pub(super) fn times(&self, factor: &Rational) -> OpenLoop {
        let over = match &self.over {
            Over::Integers(parts) => Over::Integers(parts.times(factor)),
            Over::Constants(parts) => Over::Constants(parts.times(factor)),
        };
        OpenLoop { over, ..self.clone() }
    }

    /// True if nothing comes back to the cut.
    pub(super) fn is_zero(&self) -> bool {
        self.over.is_open()
    }

    /// True if a coefficient is known by enclosures alone.
    pub(super) fn is_enclosed(&self) -> bool {
        let Over::Constants(parts) = &self.over else { return false };
        let symbols = &parts.ground.0;
        (0..symbols.len()).any(|i| matches!(symbols.definition(i), Definition::Enclosed(_)))
    }

    /// From coefficients that are known by enclosures.
    #[cfg(test)]
    pub(super) fn enclosed(cut: Cut, found: EnclosedQuotient, shape: Shape) -> OpenLoop {
        OpenLoop { cut, shape, sample_time: None, over: Over::of_enclosed(found, shape), dead_time: None }
    }

    /// From the real and the imaginary parts of the denominator's coefficients, and of the numerator's, polynomials in symbols.
    pub(super) fn over_symbols(
        cut: Cut,
        lists: [Poly<MultiPoly>; 4],
        symbols: &Arc<Symbols>,
        shape: Shape,
        sample_time: Option<Rational>,
    ) -> OpenLoop {
        let is_real = lists[1].is_zero() && lists[3].is_zero();
        let over = if symbols.is_empty() {
            let lists = integral(lists.map(|p| p.coeffs().iter().map(|c| c.eval(&[])).collect()));
            Over::Integers(if is_real {
                let [denominator, _, numerator, _] = lists;
                Parts::new(Integers, denominator, numerator, Vec::new(), shape)
            } else {
                Parts::complex(Integers, lists, Vec::new(), shape)
            })
        } else {
            let ground = Constants(Arc::clone(symbols));
            Over::Constants(if is_real {
                let [denominator, _, numerator, _] = lists;
                Parts::new(ground, denominator, numerator, Vec::new(), shape)
            } else {
                Parts::complex(ground, lists, Vec::new(), shape)
            })
        };
        OpenLoop { cut, over, shape, sample_time, dead_time: None }
    }

    /// Where the loop is cut.
    pub fn cut(&self) -> &Cut {
        &self.cut
    }

    /// `D0`, primitive together with `N`; hidden modes stay. `None` where its coefficients are not rational numbers.
    pub fn denominator(&self) -> Option<&UniPoly> {
        match &self.over {
            Over::Integers(parts) if parts.denominator.is_real() => Some(&parts.denominator.re),
            _ => None,
        }
    }

    /// `N`; `None` where its coefficients are not rational numbers.
    pub fn numerator(&self) -> Option<&UniPoly> {
        match &self.over {
            Over::Integers(parts) if parts.numerator.is_real() => Some(&parts.numerator.re),
            _ => None,
        }
    }

    /// The coefficients of `D0` and of `N` from the constant term up, with an absolute error of at most about `2^-bits`. Of complex ones, those of
    /// the polynomial with the conjugate roots.
    pub fn coefficients(&self, bits: u64) -> [Vec<Rational>; 2] {
        fn middles<G: Ground>(ground: &G, p: &Poly<G::Number>, bits: u64) -> Vec<Rational> {
            let value = |c: &G::Number| ground.values(&Poly::constant(c.clone()), bits)(&Rational::ZERO);
            p.coeffs().iter().map(value).map(|e| e.lower().midpoint(e.upper())).collect()
        }
        with_parts!(self, parts => {
            [&parts.denominator, &parts.numerator].map(|p| middles(&parts.ground, &p.with_conjugate(), bits))
        })
    }

    /// The disc or the half plane.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The frequencies that are looked at, and their variable `x`.
    pub fn frequencies(&self) -> Frequencies {
        self.over.frequencies()
    }

    /// The sample time, of a discrete loop that has one.
    pub fn sample_time(&self) -> Option<&Rational> {
        self.sample_time.as_ref()
    }

    /// Dead time of a continuous loop: `L = N/D0 exp(-tau s)`.
    pub fn dead_time(&self) -> Option<&Rational> {
        self.dead_time.as_ref()
    }

    /// `L` at a point of the boundary, given by the variable of its [`Frequencies`]: the real part, and the imaginary part, computed with some bits;
    /// `None` at a pole. For `x = z + 1/z` and `x = s^2` the imaginary part is divided by `sin theta` or `omega`. Exact where the coefficients are
    /// rational.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::number::Rational;
    /// use jurist_engine::model::{BlockBuilder, Model, Time};
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::response::OpenLoop;
    /// let plant = BlockBuilder::new("plant", "r - y", "y").transfer("1/(s + 1)");
    /// let (model, _) = Model::builder(Time::Continuous).inputs(["r"]).outputs(["y"]).block(plant).build()?;
    /// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
    /// let open_loop = OpenLoop::of(&problem, None, &budget)?;
    /// let (real, imaginary) = open_loop.value_at(&Rational::from(-4), 64).unwrap(); // 1/(1 + 2j) = 1/5 - 2/5 j
    /// assert_eq!((real.decimal(3), imaginary.decimal(3)), (Some("0.200".to_owned()), Some("-0.200".to_owned())));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    pub fn value_at(&self, x: &Rational, bits: u64) -> Option<(Enclosure, Enclosure)> {
        self.values_at(std::slice::from_ref(x), bits).pop()?
    }

    /// [`Self::value_at`] at many points; constants are enclosed once.
    pub fn values_at(&self, points: &[Rational], bits: u64) -> Vec<Option<(Enclosure, Enclosure)>> {
        let found = points.iter().zip(self.undelayed_values_at(points, bits));
        found.map(|(x, value)| value.map(|(real, imaginary)| self.delayed(x, real, imaginary, bits))).collect()
    }

    /// [`Self::values_at`] of the open loop without its dead time.
    pub fn undelayed_values_at(&self, points: &[Rational], bits: u64) -> Vec<Option<(Enclosure, Enclosure)>> {
        with_parts!(self, parts => {
            let reduced = &parts.reduced;
            let [below, twice_real, imaginary] = [&reduced.denominator_squared, &reduced.twice_real, &reduced.imaginary]
                .map(|p| parts.ground.values(p, bits));
            let value = |x: &Rational| {
                let below = below(x);
                let real = twice_real(x).div(&below.add(&below, bits), bits)?;
                Some((real, imaginary(x).div(&below, bits)?))
            };
            points.iter().map(value).collect()
        })
    }

    /// A value multiplied by that of the dead time.
    fn delayed(&self, x: &Rational, real: Enclosure, imaginary: Enclosure, bits: u64) -> (Enclosure, Enclosure) {
        let Some(tau) = &self.dead_time else { return (real, imaginary) };
        let is_signed = self.frequencies().are_signed();
        let rate =
            if is_signed { Enclosure::from_rational(x.clone()) } else { Enclosure::from_rational(-x).sqrt(bits) };
        let turned = rate.mul(&Enclosure::from_rational(tau.clone()), bits);
        let (cos, sin) = cos_sin(&Ball::from_enclosure(&turned, bits));
        let (cos, sin) = (cos.to_enclosure(), sin.to_enclosure());
        if is_signed {
            let along = real.mul(&cos, bits).add(&imaginary.mul(&sin, bits), bits);
            return (along, imaginary.mul(&cos, bits).sub(&real.mul(&sin, bits), bits));
        }
        let over_rate = sin.div(&rate, bits).unwrap_or_else(|| Enclosure::from_rational(tau.clone()));
        let along = real.mul(&cos, bits).add(&imaginary.mul(&rate, bits).mul(&sin, bits), bits);
        (along, imaginary.mul(&cos, bits).sub(&real.mul(&over_rate, bits), bits))
    }

    pub(crate) fn over(&self) -> &Over {
        &self.over
    }

    /// Whether this is the same function of frequency: the same loop, cut elsewhere.
    pub(crate) fn is_same(&self, other: &OpenLoop) -> bool {
        fn equal<R: Domain>(a: &Reduced<R>, b: &Reduced<R>) -> bool {
            let is_same = |p: &Poly<R>, q: &Poly<R>| p.times(&b.denominator_squared) == q.times(&a.denominator_squared);
            a.frequencies == b.frequencies
                && is_same(&a.twice_real, &b.twice_real)
                && is_same(&a.imaginary, &b.imaginary)
        }
        if self.dead_time != other.dead_time {
            return false;
        }
        match (&self.over, &other.over) {
            (Over::Integers(a), Over::Integers(b)) => equal(&a.reduced, &b.reduced),
            (Over::Constants(a), Over::Constants(b)) => a.ground.0 == b.ground.0 && equal(&a.reduced, &b.reduced),
            _ => false,
        }
    }
}

impl Over {
    pub(super) fn frequencies(&self) -> Frequencies {
        match self {
            Over::Integers(parts) => parts.frequencies(),
            Over::Constants(parts) => parts.frequencies(),
        }
    }

    /// Whether nothing comes back.
    pub(super) fn is_open(&self) -> bool {
        match self {
            Over::Integers(parts) => parts.numerator.is_zero(),
            Over::Constants(parts) => parts.numerator.is_zero(),
        }
    }

    /// From coefficients that are known by enclosures.
    fn of_enclosed(found: EnclosedQuotient, shape: Shape) -> Over {
        let EnclosedQuotient { symbols, denominator, numerator } = found;
        let mut parts = Parts::new(Constants(Arc::clone(&symbols)), denominator, numerator, Vec::new(), shape);
        let (reduced, symbols) = parts.reduced.shortened(&symbols);
        (parts.reduced, parts.ground) = (reduced, Constants(symbols));
        Over::Constants(parts)
    }

    /// From coefficients in symbols, none of which is a parameter, and the dead time that is a factor of the numerator.
    pub(super) fn new(
        denominator: Vec<RationalFunction>,
        numerator: Vec<RationalFunction>,
        poles: Vec<Poly<MultiPoly>>,
        symbols: &crate::model::Symbols,
        shape: Shape,
    ) -> Result<(Over, Option<Rational>), Error> {
        let [denominator, numerator] = without_denominators([denominator, numerator]);
        let ([numerator], dead_time) = without_delay([&denominator], [numerator], symbols)?;
        let is_rational = |p: &Poly<MultiPoly>| p.coeffs().iter().all(MultiPoly::is_constant);
        if is_rational(&denominator) && is_rational(&numerator) && poles.iter().all(is_rational) {
            let plain = |p: &Poly<MultiPoly>| p.map(|c| c.as_constant().expect("every parameter has a value"));
            let poles = poles.iter().map(plain).collect();
            let parts = Parts::new(Integers, plain(&denominator), plain(&numerator), poles, shape);
            return Ok((Over::Integers(parts), dead_time));
        }
        let ground = constants_of(&poles, symbols)?;
        Ok((Over::Constants(Parts::new(ground, denominator, numerator, poles, shape)), dead_time))
    }
}

/// The constants of an open loop; refuses dead times in the poles of a factor.
pub(super) fn constants_of(poles: &[Poly<MultiPoly>], symbols: &crate::model::Symbols) -> Result<Constants, Error> {
    let is_delay = |variable: &usize| symbols.delays().iter().any(|(own, _)| *own - symbols.first() == *variable);
    if poles.iter().flat_map(|p| p.coeffs()).any(|c| c.variables().iter().any(is_delay)) {
        return Err(BESIDE_DEAD_TIME.diagnostic(&[]).into());
    }
    Constants::beside_delays(symbols)
}

/// The parts of the numerator without the dead time that is a factor of all of them, and that dead time; the parts of the denominator have none.
pub(super) fn without_delay<const N: usize>(
    denominator: [&Poly<MultiPoly>; N],
    numerator: [Poly<MultiPoly>; N],
    symbols: &crate::model::Symbols,
) -> Result<([Poly<MultiPoly>; N], Option<Rational>), Error> {
    if symbols.delays().is_empty() {
        return Ok((numerator, None));
    }
    let (rest, tau) = split_delay(denominator, &numerator, symbols).ok_or_else(|| ONE_FACTOR.diagnostic(&[]))?;
    Ok((rest, Some(tau).filter(|tau| !tau.is_zero())))
}

/// The numerator without the one product of powers of `exp(-tau s)` that all its terms have, and its dead time; symbols are
/// numbered as in their table.
fn split_delay<const N: usize>(
    denominator: [&Poly<MultiPoly>; N],
    numerator: &[Poly<MultiPoly>; N],
    symbols: &crate::model::Symbols,
) -> Option<([Poly<MultiPoly>; N], Rational)> {
    let delays: Vec<(usize, RationalFunction)> =
        symbols.delays().into_iter().map(|(variable, delay)| (variable - symbols.first(), delay)).collect();
    let is_free = |p: &MultiPoly| delays.iter().all(|(variable, _)| p.degree_in(*variable) == 0);
    let mut exponents: Option<Vec<u32>> = None;
    for (monomial, _) in numerator.iter().flat_map(|p| p.coeffs()).flat_map(|c| c.terms()) {
        let found: Vec<u32> = delays.iter().map(|(variable, _)| monomial.exponent(*variable)).collect();
        if exponents.get_or_insert_with(|| found.clone()) != &found {
            return None;
        }
    }
    let exponents = exponents.unwrap_or_else(|| vec![0; delays.len()]);
    let (mut tau, mut factor) = (Rational::ZERO, MultiPoly::one());
    for ((variable, delay), exponent) in delays.iter().zip(exponents) {
        if exponent > 0 {
            tau += delay.as_constant()? * Rational::from(i64::from(exponent));
            factor = factor.times(&MultiPoly::variable(*variable).power(u64::from(exponent)));
        }
    }
    let rest = numerator.each_ref().map(|p| p.map(|c| c.div_exact(&factor).expect("every term has the factor")));
    denominator.iter().flat_map(|p| p.coeffs()).all(is_free).then_some((rest, tau))
}

/// The loop opened at a signal, with polynomials over the constants of holds, and the sample time.
fn opened_exactly(problem: &Problem, cut: &Cut, budget: &Budget) -> Result<WithTimes, Error> {
    let Opened { system, sample_time, symbols, is_closed } = problem.model().opened(cut, &[], problem.set(), budget)?;
    let shape = problem.shape();
    let over = if system.is_complex {
        let [denominator, numerator] = system.complex_transfer(0, system.inputs.len() / 2 - 1, budget)?;
        let lists = match is_closed {
            // L = T/(1 - T)
            true => {
                let open = denominator.minus(&numerator);
                [open.re, open.im, numerator.re, numerator.im]
            }
            false => [denominator.re, denominator.im, negated(&numerator.re), negated(&numerator.im)],
        };
        budget.enter(|| Over::of_complex(lists, Vec::new(), &symbols, shape))??
    } else {
        let (mut denominator, mut numerator) = returned(&system, budget)?;
        if is_closed {
            // L = T/(1 - T)
            numerator = negated(&numerator);
            denominator = differences(&denominator, &numerator);
        }
        budget.enter(|| Over::new(denominator, numerator, Vec::new(), &symbols, shape))??
    };
    Ok((over, sample_time.and_then(|t| t.as_constant())))
}

/// `D0` and `N` of a system from the cut to the cut: what comes back has the sign of the feedback, so `L = -P`.
fn returned(system: &ClosedLoop, budget: &Budget) -> Result<(Vec<RationalFunction>, Vec<RationalFunction>), Error> {
    let column = system.inputs.len().max(system.e.columns()) - 1;
    let transfer = system.transfer_function_at(0, column, budget)?;
    Ok((transfer.denominator.coefficients, negated(&transfer.numerator)))
}

/// The coefficients of the difference of two polynomials.
fn differences(a: &[RationalFunction], b: &[RationalFunction]) -> Vec<RationalFunction> {
    let coefficient = |list: &[RationalFunction], k: usize| list.get(k).cloned().unwrap_or_default();
    (0..a.len().max(b.len())).map(|k| &coefficient(a, k) - &coefficient(b, k)).collect()
}

fn negated(list: &[RationalFunction]) -> Vec<RationalFunction> {
    list.iter().map(|f| -f).collect()
}
