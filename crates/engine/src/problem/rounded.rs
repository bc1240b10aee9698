//! Systems with matrices of floating-point numbers, for other programs.

use super::Problem;
use crate::error::Error;
use crate::model::{Symbols, quotient_at};
use crate::precisions::ROUNDED_ENTRIES;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// A linear system `x' = A x + B u`, `y = C x + D u`, where `x'` is the next sample or the derivative. Each entry is the
/// floating-point number nearest to its exact value, but for the last bit; one that 4096 bits do not tell from 0 is 0.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("plant", "r - y", "y").transfer("1/(s + 1)").held("1/10", "0"))
///     .build()?;
/// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
/// let plant = &problem.rounded_blocks(&budget)?[0][0];
/// assert!((plant.a[0][0] - (-0.1f64).exp()).abs() < 1e-15);
/// let closed_loop = problem.rounded_closed_loop(&budget)?.unwrap();
/// assert!((closed_loop.a[0][0] - (2.0 * (-0.1f64).exp() - 1.0)).abs() < 1e-15);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RoundedSystem {
    /// State matrix, n x n.
    pub a: Vec<Vec<f64>>,
    /// Input matrix, n x inputs.
    pub b: Vec<Vec<f64>>,
    /// Output matrix, outputs x n.
    pub c: Vec<Vec<f64>>,
    /// Direct matrix, outputs x inputs.
    pub d: Vec<Vec<f64>>,
}

/// How the blocks of a diagram are connected: coefficients of the signals that blocks drive, in their order, and then of the external ones,
/// rounded as the entries of a [`RoundedSystem`] are.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RoundedWiring {
    /// A row for each input of the blocks, in their order.
    pub inputs: Vec<Vec<f64>>,
    /// A row for each output of the loop.
    pub outputs: Vec<Vec<f64>>,
}

/// Bits of an entry that have to be known before it is rounded.
const KNOWN_BITS: u64 = 64;

impl Problem {
    /// The blocks of the diagram, in their order, discrete where the loop is: one system for each, or one for even samples and one for
    /// odd ones where the edges of its pulses alternate. None for a loop that is no block diagram.
    ///
    /// Cost: that of the closed loop without a characteristic polynomial.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    ///
    /// # Panics
    /// When a name is free.
    pub fn rounded_blocks(&self, budget: &Budget) -> Result<Vec<Vec<RoundedSystem>>, Error> {
        assert!(self.free().is_empty(), "every name has a value");
        let Some(found) = budget.enter(|| self.realised_blocks(&[], self.set(), budget))?? else {
            return Ok(Vec::new());
        };
        let of = |[a, b, c, d]: &[RationalMatrix; 4]| rounded([a, b, c, d], &found.symbols);
        let all = || found.systems.iter().map(|of_samples| of_samples.iter().map(of).collect()).collect();
        budget.enter(all)?
    }

    /// How these blocks are connected; `None` for a loop that is no block diagram.
    ///
    /// Cost: that of [`Problem::rounded_blocks`].
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    ///
    /// # Panics
    /// When a name is free.
    pub fn rounded_wiring(&self, budget: &Budget) -> Result<Option<RoundedWiring>, Error> {
        assert!(self.free().is_empty(), "every name has a value");
        let Some(found) = budget.enter(|| self.realised_blocks(&[], self.set(), budget))?? else {
            return Ok(None);
        };
        let ([inputs, outputs], none) = (&found.wiring, RationalMatrix::zeros(0, 0));
        let RoundedSystem { a, b, .. } =
            budget.enter(|| rounded([inputs, outputs, &none, &none], &found.symbols))??;
        Ok(Some(RoundedWiring { inputs: a, outputs: b }))
    }

    /// The closed loop; `None` for a loop that is given by its characteristic polynomial. Of a loop with several rates a step is a
    /// hyperperiod.
    ///
    /// Cost: that of the closed loop without a characteristic polynomial.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`]; a loop with dead time in continuous time has no matrices of numbers.
    ///
    /// # Panics
    /// When a name is free.
    pub fn rounded_closed_loop(&self, budget: &Budget) -> Result<Option<RoundedSystem>, Error> {
        assert!(self.free().is_empty(), "every name has a value");
        let Some(found) = self.in_numbers(budget)? else { return Ok(None) };
        let of = &found.closed_loop;
        budget.enter(|| rounded([&of.a, &of.e, &of.c, &of.d], &found.symbols))?.map(Some)
    }

    /// The coefficients of the characteristic polynomial from the constant term up, each rounded as an entry of a [`RoundedSystem`] is; `None`
    /// where the loop is undefined.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`].
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; a characteristic function with dead time has no coefficients that are numbers.
    ///
    /// # Panics
    /// When a name is free.
    pub fn rounded_polynomial(&self, budget: &Budget) -> Result<Option<Vec<f64>>, Error> {
        assert!(self.free().is_empty(), "every name has a value");
        let algebra = self.algebra_over_symbols(budget)?;
        let Some(polynomial) = algebra.polynomial() else { return Ok(None) };
        let row = RationalMatrix::from_fn(1, polynomial.coefficients.len(), |_, k| polynomial.coefficients[k].clone());
        let none = RationalMatrix::zeros(0, 0);
        let found = budget.enter(|| rounded([&row, &none, &none, &none], algebra.symbols()))??;
        Ok(found.a.into_iter().next())
    }
}

fn undefined() -> Error {
    Error::Undefined("an entry of the loop's matrices has no value there".into())
}

fn rounded(matrices: [&RationalMatrix; 4], symbols: &Symbols) -> Result<RoundedSystem, Error> {
    let mut values = Vec::new();
    for bits in ROUNDED_ENTRIES.bits() {
        values.push((bits, symbols.enclosed(bits)));
        if matrices.iter().all(|m| m.entries().iter().all(|f| of_entry(f, &values).is_some())) {
            break;
        }
    }
    let entry = |f: &RationalFunction| match of_entry(f, &values) {
        Some(value) => Ok(value.to_f64_approximate()),
        // As many bits as are asked for do not tell it from zero.
        None => last(f, &values).filter(Ball::contains_zero).map(|_| 0.0).ok_or_else(undefined),
    };
    let matrix = |m: &RationalMatrix| -> Result<Vec<Vec<f64>>, Error> {
        (0..m.rows()).map(|i| (0..m.columns()).map(|j| entry(&m[(i, j)])).collect()).collect()
    };
    let [a, b, c, d] = matrices;
    Ok(RoundedSystem { a: matrix(a)?, b: matrix(b)?, c: matrix(c)?, d: matrix(d)? })
}

/// The values of symbols with so many bits.
type Enclosed = (u64, Option<Vec<Ball>>);

fn last(f: &RationalFunction, values: &[Enclosed]) -> Option<Ball> {
    let (bits, values) = values.last()?;
    quotient_at(f, values.as_ref()?, *bits)
}

/// A number near an entry, where enough of its bits are known.
fn of_entry(f: &RationalFunction, values: &[Enclosed]) -> Option<Rational> {
    if let Some(value) = f.as_constant() {
        return Some(value);
    }
    let value = last(f, values)?;
    let is_known = value.least_magnitude_units().bit_length() > value.width_units().bit_length() + KNOWN_BITS;
    is_known.then(|| value.lower().midpoint(&value.upper()))
}
