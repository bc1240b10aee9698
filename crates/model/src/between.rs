//! The closed loop between two signals.

use super::closed_loop::ClosedLoop;
use super::definition::Model;
use super::evaluated::Answer;
use super::open_loop::Opened;
use crate::error::{Code, Diagnostic, Error};
use crate::refusals::COMPLEX_BETWEEN;
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
        if system.is_complex {
            return Err(COMPLEX_BETWEEN.diagnostic(&[]).into());
        }
        let (i, j) = system.ports(&between.input, &between.output)?;
        let n = system.a.rows();
        let system = ClosedLoop {
            e: system.e.block(0..n, j..j + 1),
            c: system.c.block(i..i + 1, 0..n),
            d: system.d.block(i..i + 1, j..j + 1),
            inputs: vec![between.input.clone()],
            outputs: vec![between.output.clone()],
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
