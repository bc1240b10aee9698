//! How a question is decided: what `--explain` prints.

use super::{Algebra, Problem};
use crate::coverage::{Asked, CoefficientRing, Coverage};
use crate::error::Error;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::MultiPoly;

/// How a question is decided, or with which words it is refused.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::coverage::{Asked, CoefficientRing};
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// let problem = Model::drive().ask().free("K_pwm").problem()?;
/// let plan = problem.plan(Asked::Intervals, &Budget::unlimited())?;
/// assert_eq!((plan.ring, plan.order), (CoefficientRing::Rational, Some(6)));
/// assert_eq!(plan.coverage.method().unwrap().name, "zeros of boundary polynomials");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Plan {
    /// The question.
    pub asked: Asked,
    /// What the coefficients of the characteristic function are made of.
    pub ring: CoefficientRing,
    /// The symbols of that ring with their definitions.
    pub symbols: Vec<(String, String)>,
    /// The degree of the characteristic polynomial while all parameters are symbolic, with dead time the highest power of `s`; `None` where it
    /// depends on what is free.
    pub order: Option<usize>,
    /// What becomes of the question.
    pub coverage: &'static Coverage,
    /// Inequalities in the free names that hold where the model has a meaning.
    pub presupposed: Vec<String>,
}

impl Problem {
    /// How a question about this problem is decided.
    ///
    /// Cost: that of [`Problem::coefficient_ring`].
    ///
    /// # Errors
    /// As [`Problem::coefficient_ring`].
    pub fn plan(&self, asked: Asked, budget: &Budget) -> Result<Plan, Error> {
        let ring = self.coefficient_ring(budget)?;
        let algebra: Option<&Algebra> = self.evaluated();
        let is_plain = self.region() == &super::Region::of(self.time());
        let asked = if is_plain { asked } else { asked.in_region() };
        let names: Vec<&str> = self.free().iter().map(|free| free.name.as_str()).collect();
        Ok(Plan {
            asked,
            ring,
            symbols: algebra.map(|algebra| algebra.symbols().definitions()).unwrap_or_default(),
            order: algebra.map(Algebra::formal_degree),
            coverage: asked.over(ring),
            presupposed: self.positive().iter().map(|p| format!("{} > 0", plain(p).display(&names))).collect(),
        })
    }

    /// The same, kept: documents of the problem have it from now on.
    ///
    /// Cost: that of [`Problem::plan`] on the first call, then nothing.
    ///
    /// # Errors
    /// As [`Problem::plan`].
    pub fn explain(&self, asked: Asked, budget: &Budget) -> Result<&Plan, Error> {
        if let Some(plan) = self.explained() {
            return Ok(plan);
        }
        let plan = self.plan(asked, budget)?;
        Ok(self.plan.get_or_init(|| plan))
    }

    /// The plan that [`Problem::explain`] made.
    pub fn explained(&self) -> Option<&Plan> {
        self.plan.get()
    }
}

/// A polynomial with the same sign and no common factor of its coefficients.
fn plain(p: &MultiPoly) -> MultiPoly {
    p.div_exact_integer(&p.integer_content()).unwrap_or_default()
}
