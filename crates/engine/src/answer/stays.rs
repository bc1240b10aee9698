//! A root that stays on the boundary whatever the free parameters are.

use crate::model::Time;
use crate::problem::{Problem, Region};
use crate::stability::Cause;
use jurist_algebra::poly::{Domain, RationalFunction};

impl Problem {
    /// The real root that stays on the boundary of plain stability for all values of what is free; `None` where none is seen in the
    /// coefficients, or the algebra is not computed yet.
    ///
    /// Cost: the sum of the coefficients in discrete time.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Model, ParameterBuilder, Time};
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::stability::Cause;
    /// let (model, _) = Model::builder(Time::Discrete)
    ///     .parameter(ParameterBuilder::new("K").nominal("1"))
    ///     .characteristic("(z - 1)*(z - K)")
    ///     .build()?;
    /// let answer = model.ask().free("K").stable_set(&Budget::unlimited())?;
    /// assert_eq!(answer.problem().root_that_stays(), Some(Cause::RootAtOne));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    pub fn root_that_stays(&self) -> Option<Cause> {
        if *self.region() != Region::of(self.time()) || self.is_complex() {
            return None;
        }
        let p = self.evaluated()?.polynomial().filter(|p| p.formal_degree > 0)?;
        let sum = |is_alternating: bool| {
            let add = |sum: RationalFunction, (k, c): (usize, &RationalFunction)| match is_alternating && k % 2 == 1 {
                true => sum.minus(c),
                false => sum.plus(c),
            };
            p.coefficients.iter().enumerate().fold(RationalFunction::zero(), add)
        };
        match self.time() {
            Time::Continuous => p.coefficients.first()?.is_zero().then_some(Cause::RootAtZero),
            Time::Discrete if sum(false).is_zero() => Some(Cause::RootAtOne),
            Time::Discrete => sum(true).is_zero().then_some(Cause::RootAtMinusOne),
        }
    }
}
