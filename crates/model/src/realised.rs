//! The blocks of a diagram where numbers are all that is asked for, each as a system of its own.

use super::connect::realise::realised;
use super::connect::state_space::{Connecting, System, part};
use super::definition::Model;
use super::evaluate::values::Values;
use super::evaluated::substituted;
use super::symbols::Symbols;
use crate::error::Error;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use std::cell::RefCell;

/// The systems of the blocks, in the order of the model.
#[derive(Clone, Debug)]
pub struct RealisedBlocks {
    /// For each block the matrices A, B, C, D: once, or for even and for odd samples. Their entries are in the symbols.
    pub systems: Vec<Vec<[RationalMatrix; 4]>>,
    /// A row for each input of the blocks, and a row for each output of the loop: coefficients of the signals that blocks drive, and then of
    /// the external ones.
    pub wiring: [RationalMatrix; 2],
    /// What the variables stand for.
    pub symbols: Symbols,
}

impl Model {
    /// The blocks with these values, discrete where the loop is, and what is kept as variables; `None` of a complex loop, and for
    /// other forms than block diagrams.
    ///
    /// Cost: that of [`Model::closed_loop_in_numbers`] without the connection.
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn realised_blocks(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<RealisedBlocks>, Error> {
        let answer = self.answer(kept, values, budget)?;
        let Values::Blocks { blocks, outputs } = &answer.values else { return Ok(None) };
        if answer.wiring.is_complex {
            return Ok(None);
        }
        let symbols = RefCell::new(answer.symbols.borrow().clone().keeping_flows());
        let set = |f: &RationalFunction| substituted(f, &answer.images);
        let how = Connecting { set: &set, symbols: Some(&symbols), start: None, budget };
        let systems = realised(blocks, &how, &mut Vec::new(), &mut RationalFunction::one());
        let systems = systems.map_err(|why| self.not_connected(why))?;
        let signals = answer.wiring.driven + answer.wiring.inputs.len();
        let inputs: Vec<_> = blocks.iter().flat_map(|b| b.inputs.iter().cloned()).collect();
        let rows = |list| part(list, 0, signals, &set).map_err(|why| self.not_connected(why));
        let wiring = [rows(&inputs)?, rows(outputs)?];
        let matrices = |System { a, b, c, d }: System| [a, b, c, d];
        let systems = systems.into_iter().map(|of_samples| of_samples.into_iter().map(matrices).collect()).collect();
        Ok(Some(RealisedBlocks { systems, wiring, symbols: symbols.into_inner() }))
    }
}
