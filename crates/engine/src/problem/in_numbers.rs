//! A loop whose parameters all have values, decided by enclosures of its numbers.

use super::by_enclosures::{quotient, steady_state};
use super::{Bound, Problem, Region, exact_or_enclosed};
use crate::error::Error;
use crate::model::{ClosedLoop, InNumbers, Symbols, quotient_at};
use crate::precisions::LOOP_IN_NUMBERS;
use crate::stability::{AtPoint, EnclosedLoop, RootCount, Shape, open_equation};
use jurist_algebra::ball::{Ball, BallMatrix};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction, UniPoly};

/// What enclosures say of a loop.
#[derive(Clone, Debug)]
pub(crate) enum FromNumbers {
    /// Where the roots are, of how many, whether an odd number of real ones lies beyond the boundary, and whether each has been counted with
    /// its conjugate.
    Known { at: AtPoint, degree: usize, drifts: bool, is_complex: bool },
    /// What is not known: whether an equation holds.
    Open(String),
}

impl Problem {
    /// The closed loop in a form of which only numbers are to be asked: the closed loop, what its variables stand for, and the sample
    /// time. Without holds, and where a name is free, they are those of [`Problem::closed_loop_over_symbols`].
    ///
    /// Cost: on the first call that of the closed loop without a characteristic polynomial.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    pub fn closed_loop_in_numbers(
        &self,
        budget: &Budget,
    ) -> Result<(&ClosedLoop, &Symbols, Option<&RationalFunction>), Error> {
        if let Some(found) = self.in_numbers(budget)?.filter(|found| found.symbols.has_flows()) {
            return Ok((&found.closed_loop, &found.symbols, found.sample_time.as_ref()));
        }
        let (closed_loop, symbols) = self.closed_loop_over_symbols(budget)?;
        Ok((closed_loop, symbols, self.algebra_over_symbols(budget)?.sample_time()))
    }

    /// Where the roots are as far as enclosures tell; `None` for a loop that is rational, has dead time, or is given by its
    /// characteristic polynomial.
    ///
    /// Cost: enclosures of the closed loop's matrix and of its characteristic polynomial, with twice as many bits until the boundary is
    /// left aside for certain.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    pub(crate) fn roots_in_numbers(&self, budget: &Budget) -> Result<Option<FromNumbers>, Error> {
        let is_asked = |found: &&InNumbers| !found.symbols.is_empty() && found.symbols.delays().is_empty();
        let Some(found) = self.in_numbers(budget)?.filter(is_asked) else { return Ok(None) };
        budget.step("counting the roots");
        let shape = self.shape();
        let mut open: Option<String> = None;
        let known = LOOP_IN_NUMBERS.find(|bits| {
            let attempt = budget.enter(|| attempt(found, self.region(), shape, bits));
            match attempt.and_then(|found| budget.check().map(|()| found)) {
                Ok(FromNumbers::Open(question)) => {
                    open = Some(question);
                    Ok(None)
                }
                Ok(known) => Ok(Some(known)),
                Err(stopped) => Err(match &open {
                    Some(question) => stopped.with_open(question),
                    None => stopped,
                }),
            }
        })?;
        Ok(known.or(open.map(FromNumbers::Open)))
    }
}

impl Problem {
    /// The order of the closed loop in the form of which only numbers are asked, and its sample time; `None` where there is no such form.
    pub(crate) fn size_in_numbers(&self, budget: &Budget) -> Result<Option<(usize, Option<Rational>)>, Error> {
        let is_asked = |found: &&InNumbers| !found.symbols.is_empty() && found.symbols.delays().is_empty();
        let found = self.in_numbers(budget)?.filter(is_asked);
        let time = |found: &InNumbers| found.sample_time.as_ref().and_then(|t| t.as_constant());
        Ok(found.map(|found| (found.closed_loop.a.rows(), time(found))))
    }

    /// The characteristic polynomial of that form in balls of so many bits; `None` where a divisor may vanish.
    pub(crate) fn polynomial_in_numbers(&self, bits: u64, budget: &Budget) -> Option<Vec<Ball>> {
        let found = self.in_numbers(budget).ok().flatten()?;
        let values = found.symbols.enclosed(bits)?;
        enclosed(&found.closed_loop.a, &found.closed_loop.poles, &values, &Region::of(self.time()), bits)
    }
}

/// A loop behind holds in one parameter, for pictures: rounded coefficients at any value.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{BlockBuilder, Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let plant = BlockBuilder::new("plant", "K*(r - y)", "y").transfer("1/(s + 1)").discretize("zoh", "1");
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .block(plant)
///     .build()?;
/// // One mode is short enough for exact polynomials.
/// assert!(model.ask().free("K").problem()?.rounded_loop(&Budget::unlimited())?.is_none());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Debug)]
pub struct RoundedLoop {
    a: RationalMatrix,
    poles: Vec<MultiPoly>,
    /// The values of the symbols, which follow the parameter.
    symbols: Vec<Ball>,
    region: Region,
}

/// Bits of rounded coefficients.
const PICTURE_BITS: u64 = 512;

impl RoundedLoop {
    /// The characteristic polynomial at a value of the parameter, times a power of two and rounded; `None` where it is not defined.
    ///
    /// Cost: that of the characteristic polynomial of a matrix of numbers.
    pub fn at(&self, value: &Rational) -> Option<UniPoly> {
        let values: Vec<Ball> =
            std::iter::once(Ball::from_rational(value, PICTURE_BITS)).chain(self.symbols.iter().cloned()).collect();
        let polynomial = enclosed(&self.a, &self.poles, &values, &self.region, PICTURE_BITS)?;
        Some(UniPoly::new(polynomial.iter().map(Ball::middle_units).collect()))
    }
}

impl Problem {
    /// The loop in its one free parameter for pictures, where exact polynomials over the constants of its holds would be long; `None` where
    /// they are short, and where the parameter is inside of the constants.
    ///
    /// Cost: less than a second of exact algebra, and then the closed loop without a characteristic polynomial.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    pub fn rounded_loop(&self, budget: &Budget) -> Result<Option<RoundedLoop>, Error> {
        let [free] = self.free() else { return Ok(None) };
        if !self.model().has_holds() || self.evaluated().is_some() {
            return Ok(None);
        }
        let kept = [free.name.clone()];
        exact_or_enclosed(
            budget,
            |budget| self.algebra_over_symbols(budget).map(|_| None),
            |budget| {
                let found = budget.enter(|| self.model().closed_loop_in_numbers(&kept, self.set(), budget))??;
                let Some(found) = found.filter(|found| found.symbols.has_flows()) else { return Ok(None) };
                let values = budget.enter(|| found.symbols.without_kept()?.enclosed(PICTURE_BITS))?;
                Ok(values.map(|symbols| {
                    let InNumbers { closed_loop: ClosedLoop { a, poles, .. }, .. } = found;
                    Some(RoundedLoop { a, poles, symbols, region: self.region().clone() })
                }))
            },
        )
    }
}

/// What is known with so many bits.
fn attempt(of: &InNumbers, region: &Region, shape: Shape, bits: u64) -> FromNumbers {
    let polynomial = of.symbols.enclosed(bits);
    let polynomial = polynomial.and_then(|v| enclosed(&of.closed_loop.a, &of.closed_loop.poles, &v, region, bits));
    let Some(polynomial) = polynomial else {
        return FromNumbers::Open("whether something is divided by zero".to_owned());
    };
    match EnclosedLoop::of(&polynomial, shape) {
        Some(EnclosedLoop { count, drifts }) => {
            let at = AtPoint::Defined { count, infinite: 0 };
            FromNumbers::Known { at, degree: polynomial.len() - 1, drifts, is_complex: of.closed_loop.is_complex }
        }
        None => {
            let drifting = at_rest(of, region, &polynomial).and_then(|rest| EnclosedLoop::of(&rest, shape));
            match drifting {
                Some(EnclosedLoop { count, .. }) => {
                    let at = AtPoint::Defined { count: RootCount { on: count.on + 1, ..count }, infinite: 0 };
                    let (degree, is_complex) = (polynomial.len() - 1, of.closed_loop.is_complex);
                    FromNumbers::Known { at, degree, drifts: false, is_complex }
                }
                None => FromNumbers::Open(open_equation(&polynomial, shape)),
            }
        }
    }
}

/// The polynomial without a root at 1, where the loop at rest shows that there is one: an integrator without feedback.
fn at_rest(of: &InNumbers, region: &Region, polynomial: &[Ball]) -> Option<Vec<Ball>> {
    let value = polynomial.iter().fold(Ball::zero(polynomial[0].bits()), |sum, c| sum.add(c));
    if *region != Region::Disc(Bound::Number(Rational::ONE)) || !value.contains_zero() {
        return None;
    }
    let n = of.closed_loop.a.rows();
    let rest = steady_state(&of.closed_loop.a, &RationalMatrix::zeros(n, n), &of.symbols)?;
    rest.is_zero().then(|| quotient(polynomial.to_vec(), &UniPoly::from_i64(&[-1, 1])))
}

/// The characteristic polynomial with the bound of the region put in, as balls; `None` where a divisor may vanish.
fn enclosed(a: &RationalMatrix, poles: &[MultiPoly], values: &[Ball], region: &Region, bits: u64) -> Option<Vec<Ball>> {
    let mut poles = poles.iter().chain(a.entries().iter().map(RationalFunction::denominator));
    let may_vanish = |p: &MultiPoly| quotient_at(&p.clone().into(), values, bits).is_none_or(|v| v.contains_zero());
    if poles.any(|p| !p.is_one() && may_vanish(p)) {
        return None;
    }
    let n = a.rows();
    let entries = a.entries().iter().map(|f| quotient_at(f, values, bits)).collect::<Option<Vec<Ball>>>()?;
    let matrix = BallMatrix::from_fn(n, |i, j| entries[i * n + j].clone());
    Some(match region {
        Region::Disc(Bound::Number(r)) if !r.is_one() => in_disc(matrix.characteristic_polynomial(bits), r, bits),
        Region::HalfPlane(Bound::Number(decay)) if !decay.is_zero() => {
            let decay = Ball::from_rational(decay, bits);
            let moved = |i: usize, j: usize| if i == j { matrix.at(i, i).add(&decay) } else { matrix.at(i, j).clone() };
            BallMatrix::from_fn(n, moved).characteristic_polynomial(bits)
        }
        _ => matrix.characteristic_polynomial(bits),
    })
}

/// `D(r z)`.
fn in_disc(polynomial: Vec<Ball>, r: &Rational, bits: u64) -> Vec<Ball> {
    let r = Ball::from_rational(r, bits);
    polynomial.iter().enumerate().map(|(k, c)| c.mul(&r.power(k as u64))).collect()
}

#[cfg(test)]
mod tests;
