//! The classical table: numeric at a point, or in one parameter with its conditions solved.

use super::{Answer, Verdict};
use crate::error::{Code, Diagnostic, Error};
use crate::problem::{Problem, Question};
use crate::stability::{
    ClassicalTest, EnclosedTable, End, Range, RealIntervals, Shape, StableSet, SymbolicTest, classical_test,
    stable_set, symbolic_stable_set,
};
use jurist_algebra::limits::{Budget, Stop};
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// The table of a loop with one parameter, its conditions, and the check against the boundary way.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let answer = model.ask().free("K").parametric_table(&Budget::unlimited())?;
/// let test = answer.value().test.as_ref().unwrap();
/// let names: Vec<&str> = test.conditions.iter().map(|condition| condition.name.as_str()).collect();
/// assert_eq!(names, ["Q(1) > 0", "(-1)^2*Q(-1) > 0", "|a_0| < a_2"]);
/// assert!(test.intersection.same_as(&answer.value().stable.to_interval_set().unwrap()));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ParametricTable {
    /// The table and the solved conditions; `None` when the loop is undefined for every value.
    pub test: Option<ClassicalTest>,
    /// The table where the loop has functions of constants, as behind a hold: its coefficients are enclosed. `test` is `None`
    /// then.
    pub enclosed: Option<SymbolicTest>,
    /// The stable set found independently, from the boundary polynomials. Its ends are those of the
    /// conditions' intersection: a difference is a defect and refuses the answer.
    pub stable: StableSet,
}

/// Bits to which ends of the two ways are compared where they are no algebraic numbers.
const COMPARED_BITS: u64 = 256;

/// Digits to which entries are enclosed.
pub(super) const ENCLOSED_DIGITS: usize = 60;

/// The table at a point.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let budget = Budget::unlimited();
/// assert!(model.ask().set("K", 1).point_table(&budget)?.value().holds());
/// assert!(!model.ask().set("K", 3).point_table(&budget)?.value().holds());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PointTable {
    /// The table with constant entries: each condition holds everywhere or nowhere. `None` where the
    /// loop is undefined.
    pub test: Option<ClassicalTest>,
    /// The table where the loop has functions, as behind a hold: its entries are enclosed. `test` is `None` then.
    pub enclosed: Option<EnclosedTable>,
    /// The verdict on the point; `None` where the loop is undefined, or where its roots cannot be counted.
    pub verdict: Option<Verdict>,
}

impl PointTable {
    /// Whether all conditions hold: the loop is defined and stable.
    pub fn holds(&self) -> bool {
        if let Some(table) = &self.enclosed {
            return table.holds();
        }
        self.test.as_ref().is_some_and(|test| !test.intersection.intervals().is_empty())
    }
}

impl Question {
    /// The table with polynomial entries in the one free parameter and each condition's own exact solution set.
    ///
    /// Cost: that of [`Problem::parametric_table`].
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`], or stopped.
    pub fn parametric_table(self, budget: &Budget) -> Result<Answer<ParametricTable>, Error> {
        Problem::parametric_table(&self.problem()?, budget)
    }

    /// The table with every parameter at its set or nominal value.
    ///
    /// Cost: that of [`Problem::point_table`].
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`], or stopped.
    pub fn point_table(self, budget: &Budget) -> Result<Answer<PointTable>, Error> {
        Problem::point_table(&self.problem()?, budget)
    }
}

impl Problem {
    /// The table with polynomial entries. The intersection of the conditions is compared with the stable set from the
    /// boundary polynomials, each time; where ends are transcendental numbers, to 256 bits.
    ///
    /// Cost: that of [`Problem::algebra`], once, of [`classical_test`], and of [`stable_set`] for the comparison. Behind a hold
    /// that of [`SymbolicPolynomial::classical_test`](crate::stability::SymbolicPolynomial::classical_test) and of
    /// [`symbolic_stable_set`].
    ///
    /// # Errors
    /// [`Error::Stopped`]; [`Error::Refused`] where the two ways disagree (a defect of this program), and with `E-function`
    /// where functions depend on the parameter.
    pub fn parametric_table(self: &Arc<Self>, budget: &Budget) -> Result<Answer<ParametricTable>, Error> {
        budget.enter(|| {
            if let Some(table) = self.complex_table(budget)? {
                return Ok(Answer::new(Arc::clone(self), table));
            }
            let symbols = self.algebra_over_symbols(budget)?.symbols();
            if !symbols.is_empty() && symbols.delays().is_empty() && !symbols.is_moving() {
                return self.symbolic_table(budget);
            }
            let Some(p) = self.parametric(budget)? else {
                return Ok(Answer::new(Arc::clone(self), ParametricTable::undefined()));
            };
            let domain = &self.parameter().domain;
            let stable = stable_set(p, domain, self.shape(), budget)?;
            let test = classical_test(p, domain, self.shape(), budget)?;
            Ok(Answer::new(Arc::clone(self), agreed(test, stable)?))
        })?
    }

    fn symbolic_table(self: &Arc<Self>, budget: &Budget) -> Result<Answer<ParametricTable>, Error> {
        let Some(p) = self.symbolic(budget)? else {
            return Ok(Answer::new(Arc::clone(self), ParametricTable::undefined()));
        };
        let domain = &self.parameter().domain;
        let stable = symbolic_stable_set(&p, domain, self.shape(), budget)?;
        let test = p.classical_test(domain, self.shape(), ENCLOSED_DIGITS, budget)?;
        Ok(Answer::new(Arc::clone(self), agreed_over_symbols(test, stable, budget)?))
    }

    /// The table at the point that the values of all parameters are.
    ///
    /// Cost: that of [`Problem::algebra`], once, and of a table of numbers: `O(n^2)` operations. Behind a hold that of
    /// [`SymbolicPolynomial::jury_table`](crate::stability::SymbolicPolynomial::jury_table), with enough digits for what is shown.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; `E-dead-time`.
    pub fn point_table(self: &Arc<Self>, budget: &Budget) -> Result<Answer<PointTable>, Error> {
        budget.enter(|| {
            if let Some(table) = self.complex_point(budget)? {
                return Ok(Answer::new(Arc::clone(self), self.with_verdict(table, budget)?));
            }
            let symbols = self.algebra_over_symbols(budget)?.symbols();
            if !symbols.is_empty() && symbols.delays().is_empty() {
                let enclosed = match (self.symbolic(budget)?, self.shape()) {
                    (Some(p), Shape::UnitDisc) => p.jury_table(ENCLOSED_DIGITS, budget)?,
                    (Some(p), Shape::LeftHalfPlane) => p.routh_table(ENCLOSED_DIGITS, budget)?,
                    (None, _) => None,
                };
                let table = PointTable { test: None, enclosed, verdict: None };
                return Ok(Answer::new(Arc::clone(self), self.with_verdict(table, budget)?));
            }
            // A coefficient or a pole of a point is a number.
            let defined = self.parametric(budget)?.filter(|p| !p.is_undefined_at(&Rational::ZERO));
            let test = defined.map(|p| classical_test(p, &Range::all(), self.shape(), budget)).transpose()?;
            let table = PointTable { test, enclosed: None, verdict: None };
            Ok(Answer::new(Arc::clone(self), self.with_verdict(table, budget)?))
        })?
    }

    /// The table with the verdict: conditions that do not all hold do not say if the loop is marginal or unstable.
    fn with_verdict(self: &Arc<Self>, mut table: PointTable, budget: &Budget) -> Result<PointTable, Error> {
        if table.holds() {
            table.verdict = Some(Verdict::Stable);
        } else if table.test.is_some() || table.enclosed.is_some() {
            table.verdict = match self.verdict(budget) {
                Ok(answer) => Some(answer.value().verdict),
                // The table is known all the same.
                Err(Error::Stopped(stopped)) if matches!(stopped.stop, Stop::Precision(_)) => None,
                Err(error) => return Err(error),
            };
        }
        Ok(table)
    }
}

impl ParametricTable {
    /// Of a loop that is undefined for every value.
    pub(super) fn undefined() -> ParametricTable {
        ParametricTable { test: None, enclosed: None, stable: StableSet::default() }
    }
}

/// The table, if its conditions and the boundary polynomials say the same.
pub(super) fn agreed(test: ClassicalTest, stable: StableSet) -> Result<ParametricTable, Error> {
    if !stable.to_interval_set().is_some_and(|set| test.intersection.same_as(&set)) {
        return Err(ways_disagree());
    }
    Ok(ParametricTable { test: Some(test), enclosed: None, stable })
}

/// The same over symbols.
pub(super) fn agreed_over_symbols(
    test: SymbolicTest,
    stable: StableSet,
    budget: &Budget,
) -> Result<ParametricTable, Error> {
    let real = |end: &Option<End>| end.as_ref().map(|end| end.value.clone());
    let intervals = stable.intervals().iter().map(|i| [real(&i.lower), real(&i.upper)]).collect();
    if !budget.enter(|| RealIntervals { intervals }.agree(&test.intersection, COMPARED_BITS))? {
        return Err(ways_disagree());
    }
    Ok(ParametricTable { test: None, enclosed: Some(test), stable })
}

fn ways_disagree() -> Error {
    Diagnostic::error(Code::Internal, "the table's conditions and the boundary polynomials disagree")
        .help("this is a defect of jurist: please report it with the model")
        .into()
}
