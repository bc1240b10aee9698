//! The closed loop between two signals.

use super::closed_loop::ClosedLoop;
use super::definition::Model;
use super::evaluated::Answer;
use super::open_loop::Opened;
use crate::error::{Code, Diagnostic, Error};
use jurist_algebra::limits::Budget;

/// An input and an output of the closed loop.
///
/// ```
/// use jurist_model::Between;
/// assert_eq!(Between::new("d", "y").name(), "d y");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Between {
    /// The input.
    pub input: String,
    /// The output.
    pub output: String,
    name: String,
}

impl Between {
    /// Of an input and an output.
    pub fn new(input: impl Into<String>, output: impl Into<String>) -> Between {
        let (input, output) = (input.into(), output.into());
        let name = format!("{input} {output}");
        Between { input, output, name }
    }

    /// Both names.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl Model {
    /// The closed loop from one input to one output.
    pub(super) fn closed_between(
        &self,
        answer: Answer<'_>,
        between: &Between,
        budget: &Budget,
    ) -> Result<Opened, Error> {
        if self.hyperperiod() > 1 {
            return Err(no_transfer_of_several_rates());
        }
        let (system, sample_time, symbols) = self.connected(answer, budget)?;
        // Of a complex loop a signal is two, the real and the imaginary part.
        let (i, j) = match system.is_complex {
            true => system.complex_ports(&between.input, &between.output)?,
            false => system.ports(&between.input, &between.output)?,
        };
        let (n, of) = (system.a.rows(), |k: usize| if system.is_complex { 2 * k..2 * k + 2 } else { k..k + 1 });
        let (rows, columns) = (of(i), of(j));
        let system = ClosedLoop {
            e: system.e.block(0..n, columns.clone()),
            c: system.c.block(rows.clone(), 0..n),
            d: system.d.block(rows.clone(), columns.clone()),
            inputs: system.inputs[columns].to_vec(),
            outputs: system.outputs[rows].to_vec(),
            ..system
        };
        Ok(Opened { system, sample_time, symbols, is_closed: true })
    }
}

/// The refusal of a transfer function of several rates.
pub fn no_transfer_of_several_rates() -> Error {
    let message = "a loop of several rates has no transfer function from sample to sample, so no peak gain";
    let error = Diagnostic::error(Code::RateMargin, message);
    error.help("'margins' has the loop at a signal that is used once in a hyperperiod").into()
}
