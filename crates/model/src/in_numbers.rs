//! Closed loops whose answer needs numbers only.

use super::closed_loop::ClosedLoop;
use super::connect::samples::{Samples, samples};
use super::connect::state_space::Connecting;
use super::definition::Model;
use super::evaluate::values::Values;
use super::evaluated::{Evaluated, substituted};
use super::steady::no_duty;
use super::symbols::Symbols;
use crate::error::Error;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use std::cell::RefCell;

/// Units of work that the expression of a sample time may take.
const WORK_OF_A_TIME: u64 = 1_000_000;

/// A closed loop of whose constants only numbers are asked for.
#[derive(Clone, Debug)]
pub struct InNumbers {
    /// The closed loop, its entries in the symbols.
    pub closed_loop: ClosedLoop,
    /// The sample time.
    pub sample_time: Option<RationalFunction>,
    /// What the variables stand for.
    pub symbols: Symbols,
}

impl InNumbers {
    /// The evaluated model, where all is rational and nothing has stayed whole.
    pub fn evaluated(&self, budget: &Budget) -> Result<Option<Evaluated>, Error> {
        if !self.symbols.is_empty() {
            return Ok(None);
        }
        Evaluated::of(self.closed_loop.clone(), self.sample_time.clone(), self.symbols.clone(), budget).map(Some)
    }
}

impl Model {
    /// The closed loop where numbers are all that is asked for of its constants: the exponentials of matrices behind holds stay whole.
    /// Names that are kept are the first variables. `None` for the form `characteristic`, which has no closed loop.
    ///
    /// Cost: that of [`Model::evaluate`] without a characteristic polynomial, and without an expansion of what blocks do behind holds.
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn closed_loop_in_numbers(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<InNumbers>, Error> {
        self.connected_in_numbers(kept, values, Symbols::keeping_flows, budget)
    }

    /// The same where numbers are all that is asked for of the kept names, too: of a loop with several rates a long entry of the product of its
    /// samples becomes a symbol, whatever is in it.
    ///
    /// Cost: as [`Model::closed_loop_in_numbers`].
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn closed_loop_by_values(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<InNumbers>, Error> {
        self.connected_in_numbers(kept, values, |symbols| symbols.keeping_flows().shortening_names(), budget)
    }

    fn connected_in_numbers(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        kept_whole: impl Fn(Symbols) -> Symbols,
        budget: &Budget,
    ) -> Result<Option<InNumbers>, Error> {
        let mut answer = self.answer(kept, values, budget)?;
        if let Values::Characteristic(_) = &answer.values {
            return Ok(None);
        }
        answer.symbols = RefCell::new(kept_whole(answer.symbols.into_inner()));
        let (closed_loop, sample_time, symbols) = self.connected(answer, budget)?;
        Ok(Some(InNumbers { closed_loop, sample_time, symbols }))
    }

    /// The time of a hyperperiod, where that is a number whatever the kept names are.
    pub fn fixed_sample_time(&self, kept: &[String], values: &[(String, Rational)]) -> Option<Rational> {
        let budget = Budget::with_work(WORK_OF_A_TIME);
        let time = budget.enter(|| {
            let mut scope = self.scope(kept, values, &budget, &mut |_| {});
            let time = scope.scalar(self.sample_time_expression()?).ok()?;
            let (images, _) = Model::images(&scope.variables, kept, values, &no_duty).ok()?;
            substituted(&time, &images)?.as_constant()
        });
        Some(time.ok()?? * Rational::from(self.hyperperiod() as i64))
    }

    /// A loop with several rates by the matrices of its samples. `None` where the name is in a divisor or a function, or not linear in the matrix
    /// of a sample.
    ///
    /// Cost: that of the closed loop in numbers, without products of matrices.
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn samples_in(
        &self,
        name: &str,
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<Samples>, Error> {
        let mut answer = self.answer(&[name.to_owned()], values, budget)?;
        answer.symbols = RefCell::new(answer.symbols.into_inner().keeping_flows());
        let set = |f: &RationalFunction| answer.substituted(f);
        let how = Connecting { set: &set, symbols: Some(&answer.symbols), start: None, budget };
        let found = budget.enter(|| samples(self, &answer.wiring, &answer.values, &how))?;
        let found = found.map_err(|why| self.not_connected(why))?;
        Ok(found.filter(|_| answer.poles.iter().all(|pole| pole.degree_in(0) == 0)))
    }
}
