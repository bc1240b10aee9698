//! A block by itself, with its numbers enclosed: what a processor is to compute.

use super::Problem;
use crate::error::Error;
use crate::model::{ClosedLoop, Form, Symbols, quotient_at};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Enclosure;
use jurist_algebra::poly::RationalFunction;

/// A block as a discrete or continuous system, in enclosures: of width zero where no function of a number is in them.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .block(BlockBuilder::new("controller", "r - y", "u").transfer("(2*z - 1)/(z - 1)"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/z"))
///     .build()?;
/// let block = model.ask().problem()?.block("controller", 64, &Budget::unlimited())?.unwrap();
/// let numbers: Vec<String> = block.numerator.iter().map(|c| c.lower().to_string()).collect();
/// assert_eq!(numbers, ["2", "-1"]);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct EnclosedBlock {
    /// The rows of the state matrix.
    pub a: Vec<Vec<Enclosure>>,
    /// The rows of the input matrix.
    pub b: Vec<Vec<Enclosure>>,
    /// The rows of the output matrix.
    pub c: Vec<Vec<Enclosure>>,
    /// The rows of the direct matrix.
    pub d: Vec<Vec<Enclosure>>,
    /// The numerator of a block with one input and one output, highest power first, as many coefficients as the denominator; nothing is
    /// cancelled. Empty for other blocks.
    pub numerator: Vec<Enclosure>,
    /// The denominator, highest power first; its leading coefficient is 1.
    pub denominator: Vec<Enclosure>,
}

impl Problem {
    /// A block as a system, discrete where the loop is, in enclosures with so many bits behind the point. `None` for a loop that has no such
    /// block, and for one whose pulses alternate from sample to sample.
    ///
    /// Cost: that of the closed loop without a characteristic polynomial, and two characteristic polynomials of the block.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    ///
    /// # Panics
    /// When a name is free.
    pub fn block(&self, name: &str, bits: u64, budget: &Budget) -> Result<Option<EnclosedBlock>, Error> {
        assert!(self.free().is_empty(), "every name has a value");
        let Form::Blocks(diagram) = self.model().form() else { return Ok(None) };
        let Some(at) = diagram.blocks.iter().position(|block| block.name == name) else { return Ok(None) };
        let Some(found) = budget.enter(|| self.realised_blocks(&[], self.set(), budget))?? else {
            return Ok(None);
        };
        let Some([matrices]) = found.systems.get(at).map(Vec::as_slice) else { return Ok(None) };
        let values = Values { of: found.symbols.enclosed(bits), bits };
        let [a, b, c, d] = matrices;
        let (mut numerator, mut denominator) = (Vec::new(), Vec::new());
        if (b.columns(), c.rows()) == (1, 1) {
            let transfer = alone(matrices, &found.symbols, self).transfer_function_at(0, 0, budget)?;
            numerator = values.row(transfer.numerator.iter().rev())?;
            denominator = values.row(transfer.denominator.coefficients.iter().rev())?;
        }
        let block = EnclosedBlock {
            a: values.rows(a)?,
            b: values.rows(b)?,
            c: values.rows(c)?,
            d: values.rows(d)?,
            numerator,
            denominator,
        };
        Ok(Some(block))
    }
}

impl Problem {
    /// Whether a block depends on a parameter.
    ///
    /// Cost: that of [`Problem::block`], with the parameter as a variable.
    ///
    /// # Errors
    /// As [`Problem::block`].
    pub fn block_depends_on(&self, name: &str, parameter: &str, budget: &Budget) -> Result<bool, Error> {
        let Form::Blocks(diagram) = self.model().form() else { return Ok(false) };
        let Some(at) = diagram.blocks.iter().position(|block| block.name == name) else { return Ok(false) };
        let values: Vec<_> = self.set().iter().filter(|(known, _)| known != parameter).cloned().collect();
        let found = budget.enter(|| self.realised_blocks(&[parameter.to_owned()], &values, budget))??;
        let Some(found) = found else { return Ok(false) };
        let moving: Vec<usize> = std::iter::once(0).chain(found.symbols.moving()).collect();
        let of_samples = found.systems.get(at).into_iter().flatten();
        let mut entries = of_samples.flatten().flat_map(RationalMatrix::entries);
        Ok(entries.any(|f| f.variables().iter().any(|v| moving.contains(v))))
    }
}

/// The block as a loop of its own.
fn alone(matrices: &[RationalMatrix; 4], symbols: &Symbols, problem: &Problem) -> ClosedLoop {
    ClosedLoop::of_matrices(matrices.clone(), symbols.variables(), problem.time())
}

/// The values of symbols.
struct Values {
    of: Option<Vec<Ball>>,
    bits: u64,
}

impl Values {
    fn entry(&self, f: &RationalFunction) -> Result<Enclosure, Error> {
        if let Some(value) = f.as_constant() {
            return Ok(Enclosure::from_rational(value));
        }
        let value = self.of.as_ref().and_then(|values| quotient_at(f, values, self.bits));
        let undefined = || Error::Undefined("a coefficient of the block has no value there".into());
        value.map(|ball| ball.to_enclosure()).ok_or_else(undefined)
    }

    fn row<'f>(&self, row: impl Iterator<Item = &'f RationalFunction>) -> Result<Vec<Enclosure>, Error> {
        row.map(|f| self.entry(f)).collect()
    }

    fn rows(&self, matrix: &RationalMatrix) -> Result<Vec<Vec<Enclosure>>, Error> {
        (0..matrix.rows()).map(|i| (0..matrix.columns()).map(|j| self.entry(&matrix[(i, j)])).collect()).collect()
    }
}
