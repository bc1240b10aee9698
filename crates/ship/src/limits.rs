//! How a limit moves with the number of bits.

use crate::format::{Fixed, Format};
use crate::realise::Entry;
use crate::shipped::{Shipped, with_controller};
use jurist_algebra::limits::Budget;
use jurist_engine::answer::Answer;
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::problem::Ask;
use jurist_engine::stability::{Range, StableSet};

/// The stable sets of a parameter with the controller stored in more and more bits.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LimitsByBits {
    /// The parameter.
    pub parameter: String,
    /// The set of the controller as it is written.
    pub exact: Answer<StableSet>,
    /// Bits behind the point with the set; one without a number for a controller in floating point.
    pub rows: Vec<(Option<i64>, Answer<StableSet>)>,
}

/// Bits beyond those that were asked for.
const MORE: i64 = 6;

/// The most rows.
const MOST_ROWS: i64 = 40;

impl Shipped {
    /// The limits of a parameter that is no part of the controller, from the first number of bits at which some coefficient is not 0 to a few more
    /// than those that were asked for. The range of the format is not looked at.
    ///
    /// Cost: a stable set for each number of bits.
    ///
    /// # Errors
    /// `E-ship-block` for a parameter of the controller itself; as [`Question::stable_set`](jurist_engine::problem::Question::stable_set).
    pub fn limits_by_bits(
        &self,
        parameter: &str,
        domain: Option<&Range>,
        budget: &Budget,
    ) -> Result<LimitsByBits, Error> {
        let block = &self.asked.block;
        if self.exact.block_depends_on(block, parameter, budget)? {
            let message =
                format!("'{parameter}' is part of the controller '{block}', which is stored for one value of it");
            let error = Diagnostic::error(Code::ShipBlock, message);
            return Err(error.help("ask for a parameter of the plant, or set another value with --set").into());
        }
        let free = |question: jurist_engine::problem::Question| {
            let question = question.without_value(parameter).free(parameter);
            match domain {
                Some(range) => question.domain(parameter, range.clone()).stable_set(budget),
                None => question.stable_set(budget),
            }
        };
        let written = self.exact.model().ask().set_all(self.exact.set().iter().cloned());
        let exact = free(written.within(self.exact.region().clone()))?;
        let of = |values: Vec<Entry>| free(with_controller(&self.exact, block, &self.realised.keys(&values))?);
        let mut rows = Vec::new();
        match self.asked.format {
            Format::Binary(_) => {
                rows.push((None, of(self.coefficients.iter().map(|c| Entry::Number(c.value.clone())).collect())?));
            }
            Format::Fixed(fixed) => {
                let last = i64::from(fixed.fraction) + MORE;
                let first = self.first_that_tells(&fixed).max(last - MOST_ROWS);
                for bits in first..=last {
                    budget.step(&format!("limits with {bits} bits behind the point"));
                    let fixed = Fixed { bits: 64, fraction: bits as i32, ..fixed };
                    rows.push((Some(bits), of(self.values_in(&fixed)?)?));
                }
            }
        }
        Ok(LimitsByBits { parameter: parameter.to_owned(), exact, rows })
    }
}
