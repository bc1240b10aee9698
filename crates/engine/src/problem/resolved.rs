//! A question resolved: every name known, every value in its place, the algebra computed once.

use super::delayed::DelayedLoop;
use super::evaluation::{Algebra, parametric};
use super::{Plan, Region};
use crate::coverage::CoefficientRing;
use crate::error::{Code, Diagnostic, Error};
use crate::model::{ClosedLoop, InNumbers, Model, Symbols, Time};
use crate::stability::plane::PlanePolynomial;
use crate::stability::{ParametricPolynomial, Range, Shape};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction, UniPoly};
use std::sync::{Arc, OnceLock};

/// A parameter that a question leaves free.
///
/// ```
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let problem = model.ask().free("K").problem()?;
/// let free = problem.parameter();
/// assert_eq!((free.name.as_str(), free.nominal.clone()), ("K", Some(1.into())));
/// assert!(free.domain.contains(&(-7).into()));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Free {
    /// Its name; `radius` or `decay` for the bound of the region.
    pub name: String,
    /// Its unit, if the model gives one.
    pub unit: Option<String>,
    /// Its nominal value, if there is one.
    pub nominal: Option<Rational>,
    /// Between which values it may lie: the model's bounds or those of the question.
    pub domain: Range,
    /// Whether the lower and the upper end of the domain themselves belong to it: only where the model says so.
    pub closed: [bool; 2],
    /// Whether the domain ends where the pulses of a modulator have no length, or no pause between them.
    pub is_duty: [bool; 2],
}

impl Free {
    /// A name with an open domain, without a unit and without a nominal value.
    pub(super) fn of(name: &str, domain: Range) -> Free {
        let neither = [false; 2];
        Free { name: name.to_owned(), unit: None, nominal: None, domain, closed: neither, is_duty: neither }
    }

    /// The same with an open domain: maps and the lines in them are about the inside of domains.
    fn open(&self) -> Free {
        Free { closed: [false; 2], ..self.clone() }
    }

    /// The ends of the domain that belong to it.
    pub fn closed_ends(&self) -> impl Iterator<Item = &Rational> {
        let ends = [&self.domain.lower, &self.domain.upper].into_iter().zip(self.closed);
        ends.filter(|(_, closed)| *closed).filter_map(|(end, _)| end.as_ref())
    }
}

/// One question about one model. It is made by [`Question::problem`](super::Question::problem) and shared by all its answers.
///
/// The algebra is computed when it is first needed, once; whoever needs it again is given the same.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let problem = model.ask().set("K", 2).problem()?;
/// assert_eq!(problem.set(), [("K".to_owned(), 2.into())]);
/// assert!(problem.evaluated().is_none());
/// let verdict = problem.verdict(&Budget::unlimited())?;
/// assert!(verdict.problem().evaluated().is_some());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Debug)]
pub struct Problem {
    model: Arc<Model>,
    set: Vec<(String, Rational)>,
    free: Vec<Free>,
    region: Region,
    warnings: Vec<Diagnostic>,
    /// Functions of what is free that are positive where the model has a meaning.
    positive: Vec<RationalFunction>,
    algebra: OnceLock<Algebra>,
    parametric: OnceLock<Option<ParametricPolynomial>>,
    plane: OnceLock<Option<PlanePolynomial>>,
    delayed: OnceLock<Option<DelayedLoop>>,
    in_numbers: OnceLock<Option<InNumbers>>,
    /// The same problem with coefficients that are known by enclosures, for boxes; `None` where exact ones are short.
    pub(super) in_boxes: OnceLock<Option<Arc<Problem>>>,
    pub(super) plan: OnceLock<Plan>,
}

impl Problem {
    pub(super) fn new(
        model: Arc<Model>,
        set: Vec<(String, Rational)>,
        free: Vec<Free>,
        region: Region,
        warnings: Vec<Diagnostic>,
    ) -> Problem {
        let (algebra, parametric, plane) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        let (delayed, in_numbers, plan) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        let (positive, in_boxes) = (Vec::new(), OnceLock::new());
        Problem {
            model,
            set,
            free,
            region,
            warnings,
            positive,
            algebra,
            parametric,
            plane,
            delayed,
            in_numbers,
            in_boxes,
            plan,
        }
    }

    /// With functions of what is free that are positive where the model has a meaning; the domains are within these of one name.
    pub(super) fn with_positive(self, positive: Vec<RationalFunction>) -> Problem {
        Problem { positive, ..self }
    }

    /// Polynomials in what is free that are positive where the model has a meaning: numerators times denominators of what is presupposed.
    pub fn positive(&self) -> Vec<MultiPoly> {
        self.positive.iter().map(|f| f.numerator() * f.denominator()).collect()
    }

    /// Refuses what cannot be asked where several of the free names decide together whether the model has a meaning.
    fn presupposes_of_one(&self) -> Result<(), Error> {
        if self.positive.iter().all(|f| f.variables().len() < 2) {
            return Ok(());
        }
        let message = "for which values the sample time of a hold is positive, or the frequency of 'prewarp' below half the sampling rate, depends on both names together";
        Err(Diagnostic::error(Code::Discretize, message).help("set one of them").into())
    }

    /// The model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The model's title.
    pub fn title(&self) -> Option<&str> {
        self.model.title()
    }

    /// Discrete or continuous time.
    pub fn time(&self) -> Time {
        self.model.time()
    }

    /// The values of all other parameters and of the constants that were set, in the order of the model.
    pub fn set(&self) -> &[(String, Rational)] {
        &self.set
    }

    /// What is free, in the order in which it was asked for.
    pub fn free(&self) -> &[Free] {
        &self.free
    }

    /// The only free parameter.
    ///
    /// # Panics
    /// When none is free.
    pub fn parameter(&self) -> &Free {
        &self.free[0]
    }

    /// The two free parameters of a map.
    ///
    /// # Panics
    /// Unless two are free.
    pub fn axes(&self) -> [&Free; 2] {
        let [x, y] = self.free.as_slice() else { panic!("two parameters are free") };
        [x, y]
    }

    /// The region in which all roots have to lie.
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// The region once its bound is put into the polynomial.
    pub fn shape(&self) -> Shape {
        self.region.shape()
    }

    /// Remarks on the question, e.g. a value outside its domain.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// The characteristic polynomial and what goes with it; computed on the first call.
    ///
    /// Cost: on the first call that of [`Model::evaluate`] with what is free kept, and of putting the region's
    /// bound into the polynomial, `O(n^2)` operations on its coefficients; then nothing.
    ///
    /// # Errors
    /// [`Error::Refused`] where the model is not complete, and with `E-function` where it is not rational in what is free
    /// (see [`Problem::algebra_over_symbols`]); [`Error::Stopped`] when the budget runs out. A model that is undefined at
    /// the values set has algebra without a polynomial.
    pub fn algebra(&self, budget: &Budget) -> Result<&Algebra, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        if algebra.symbols().is_empty() {
            return Ok(algebra);
        }
        Err(CoefficientRing::of(algebra.symbols()).not_rational(algebra.symbols()).into())
    }

    /// The characteristic polynomial and what goes with it, for a question that can treat symbols: variables beyond those
    /// that are free are the [symbols](Algebra::symbols).
    ///
    /// Cost: that of [`Problem::algebra`], with the symbols as further variables.
    ///
    /// # Errors
    /// As [`Problem::algebra`], without `E-function` for symbols.
    pub fn algebra_over_symbols(&self, budget: &Budget) -> Result<&Algebra, Error> {
        if let Some(algebra) = self.algebra.get() {
            return Ok(algebra);
        }
        let algebra = budget.enter(|| Algebra::of(self, budget))??;
        Ok(self.algebra.get_or_init(|| algebra))
    }

    /// What the coefficients of the characteristic function are made of.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`]; twice that where the order varies.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`], but for a dead time of no fixed number of samples.
    pub fn coefficient_ring(&self, budget: &Budget) -> Result<CoefficientRing, Error> {
        match self.algebra_over_symbols(budget) {
            Ok(algebra) => Ok(CoefficientRing::of(algebra.symbols())),
            Err(Error::Refused(_)) if self.is_of_varying_order(budget)? => Ok(CoefficientRing::VaryingOrder),
            Err(failure) => Err(failure),
        }
    }

    /// The algebra, if it has been computed.
    pub fn evaluated(&self) -> Option<&Algebra> {
        self.algebra.get()
    }

    /// True if the loop may be complex: the imaginary unit is written somewhere in the model, or a plant is held in another frame.
    pub fn is_written_complex(&self) -> bool {
        self.model.is_written_complex()
    }

    /// Whether the loop is complex, as far as its algebra is known: each of its roots is then counted with its conjugate.
    pub fn is_complex(&self) -> bool {
        self.algebra.get().is_some_and(Algebra::is_complex)
    }

    /// The closed loop in state space.
    ///
    /// Cost: that of [`Problem::algebra`].
    ///
    /// # Errors
    /// As [`Problem::algebra`]; `E-no-states` for a model given by its characteristic polynomial, [`Error::Undefined`].
    pub fn closed_loop(&self, budget: &Budget) -> Result<&ClosedLoop, Error> {
        self.algebra(budget)?.closed_loop(&self.model)
    }

    /// The characteristic function of a loop with dead time; `None` for any other loop.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`]; on the first call also a common denominator.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for what cannot be treated.
    pub fn delayed(&self, budget: &Budget) -> Result<Option<&DelayedLoop>, Error> {
        if let Some(delayed) = self.delayed.get() {
            return Ok(delayed.as_ref());
        }
        let delayed = DelayedLoop::of(self, self.algebra_over_symbols(budget)?, budget)?;
        Ok(self.delayed.get_or_init(|| delayed).as_ref())
    }

    /// The closed loop in state space with what its variables beyond the free names stand for, for one who can treat
    /// [`Symbols`].
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`].
    ///
    /// # Errors
    /// As [`Problem::closed_loop`], without `E-function` for symbols.
    pub fn closed_loop_over_symbols(&self, budget: &Budget) -> Result<(&ClosedLoop, &Symbols), Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        Ok((algebra.closed_loop(&self.model)?, algebra.symbols()))
    }

    /// The closed loop with exponentials of matrices whole, if it has been asked for.
    pub(super) fn known_in_numbers(&self) -> Option<&InNumbers> {
        self.in_numbers.get()?.as_ref()
    }

    /// The closed loop with exponentials of matrices whole; `None` where a name is free, and for the form `characteristic`.
    pub(super) fn in_numbers(&self, budget: &Budget) -> Result<Option<&InNumbers>, Error> {
        if let Some(found) = self.in_numbers.get() {
            return Ok(found.as_ref());
        }
        let found = match self.free.is_empty() {
            true => budget.enter(|| self.model.closed_loop_in_numbers(&[], &self.set, budget))??,
            false => None,
        };
        Ok(self.in_numbers.get_or_init(|| found).as_ref())
    }

    /// The polynomial in the one free parameter (or none) in the form that is decided; `None` where the loop is undefined
    /// for every value.
    ///
    /// Cost: that of [`Problem::algebra`]; on the first call also `O(n)` greatest common divisors of polynomials in
    /// the parameter.
    ///
    /// # Errors
    /// As [`Problem::algebra`].
    ///
    /// # Panics
    /// When more than one parameter is free.
    pub fn parametric(&self, budget: &Budget) -> Result<Option<&ParametricPolynomial>, Error> {
        assert!(self.free.len() <= 1, "one parameter is free");
        let algebra = self.algebra(budget)?;
        Ok(self.parametric.get_or_init(|| algebra.polynomial().map(parametric)).as_ref())
    }

    /// The polynomial in the two free parameters; `None` where the loop is undefined for all values.
    ///
    /// Cost: that of [`Problem::algebra`]; on the first call also `O(n)` least common multiples of polynomials in
    /// the parameters.
    ///
    /// # Errors
    /// As [`Problem::algebra`].
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn plane(&self, budget: &Budget) -> Result<Option<&PlanePolynomial>, Error> {
        assert_eq!(self.free.len(), 2, "two parameters are free");
        self.presupposes_of_one()?;
        let algebra = self.algebra(budget)?;
        Ok(self.plane.get_or_init(|| algebra.polynomial().map(PlanePolynomial::new)).as_ref())
    }

    /// The polynomial in the two free parameters, also of a loop with functions, as behind a hold, if neither parameter is inside of
    /// one; `None` where the loop is undefined for all values.
    ///
    /// Cost: that of [`Problem::plane`].
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time`; `E-function` where functions depend on a parameter.
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn plane_over_symbols(&self, budget: &Budget) -> Result<Option<&PlanePolynomial>, Error> {
        assert_eq!(self.free.len(), 2, "two parameters are free");
        if let Some(plane) = self.plane.get() {
            return Ok(plane.as_ref());
        }
        let algebra = self.algebra_over_symbols(budget)?;
        if algebra.symbols().is_empty() {
            return self.plane(budget);
        }
        self.presupposes_of_one()?;
        let symbols = Arc::new(self.symbols_outside(budget)?);
        let over = |d| PlanePolynomial::over_symbols(d, &symbols);
        Ok(self.plane.get_or_init(|| algebra.polynomial().map(over)).as_ref())
    }

    /// Numerator and denominator of the sample time in the one free parameter; `None` in continuous time, without a sample
    /// time, and where it depends on the parameter before the algebra is computed.
    pub fn sample_time(&self) -> Option<(UniPoly, UniPoly)> {
        let Some(algebra) = self.algebra.get() else {
            // Enclosures may have answered.
            let kept: Vec<String> = self.free.iter().map(|free| free.name.clone()).collect();
            let time = self.model.fixed_sample_time(&kept, &self.set).filter(|_| self.time() == Time::Discrete)?;
            let constant = |n| UniPoly::new(vec![n]);
            return Some((constant(time.numerator()), constant(time.denominator())));
        };
        let f = algebra.sample_time()?;
        Some((f.numerator().to_univariate(0)?, f.denominator().to_univariate(0)?))
    }

    /// The same problem with plain stability in the place of a smaller region; its polynomial's roots are the loop's own.
    pub(crate) fn without_region(self: &Arc<Self>) -> Arc<Problem> {
        let plain = Region::of(self.time());
        if self.region == plain {
            return Arc::clone(self);
        }
        let problem = Problem::new(Arc::clone(&self.model), self.set.clone(), self.free.clone(), plain, Vec::new());
        Arc::new(problem.with_positive(self.positive.clone()))
    }

    /// The same problem with algebra that is known.
    pub(super) fn with_algebra(&self, algebra: Algebra) -> Problem {
        let (model, set, free) = (Arc::clone(&self.model), self.set.clone(), self.free.clone());
        let problem = Problem::new(model, set, free, self.region.clone(), self.warnings.clone());
        problem.algebra.get_or_init(|| algebra);
        problem.with_positive(self.positive.clone())
    }

    /// The same problem where some names have no value, for an answer that is about all of their values.
    pub(crate) fn without_values_of(&self, is_one: impl Fn(&str) -> bool) -> Arc<Problem> {
        let set = self.set.iter().filter(|(name, _)| !is_one(name)).cloned().collect();
        let (model, free, region) = (Arc::clone(&self.model), self.free.clone(), self.region.clone());
        Arc::new(Problem::new(model, set, free, region, self.warnings.clone()).with_positive(self.positive.clone()))
    }

    /// The problem that is left of one in two parameters when one of them (0 for the first) has a value. Its algebra follows
    /// from what is known.
    ///
    /// Cost: that of [`Problem::algebra`], and of putting the value into the `n + 1` coefficients.
    ///
    /// # Errors
    /// As [`Problem::algebra`].
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn on_line(&self, fixed: usize, value: &Rational, budget: &Budget) -> Result<Problem, Error> {
        if !self.algebra_over_symbols(budget)?.symbols().is_empty() {
            return self.on_line_over_symbols(fixed, value, budget);
        }
        let algebra = self.algebra(budget)?.on_line(fixed, value);
        self.line_with(algebra, fixed, value, budget)
    }

    /// The problem that is left where all free parameters move along the line `base + t step`: its one parameter is `t`, of this
    /// name. Its algebra follows from what is known.
    ///
    /// Cost: that of [`Problem::algebra`], and of putting the line into the `n + 1` coefficients.
    ///
    /// # Errors
    /// As [`Problem::algebra`].
    ///
    /// # Panics
    /// Unless base and step have one number for each free parameter.
    pub fn on_ray(
        &self,
        name: &str,
        base: &[Rational],
        step: &[Rational],
        domain: Range,
        budget: &Budget,
    ) -> Result<Problem, Error> {
        assert_eq!((base.len(), step.len()), (self.free.len(), self.free.len()), "each free parameter moves");
        let algebra = self.algebra_over_symbols(budget)?;
        let algebra = budget.enter(|| algebra.on_ray(name, base, step))?;
        let free = vec![Free::of(name, domain)];
        let problem = Problem::new(Arc::clone(&self.model), self.set.clone(), free, self.region.clone(), Vec::new());
        problem.algebra.get_or_init(|| algebra);
        Ok(problem)
    }

    /// The same of a loop with functions that do not depend on what is free.
    fn on_line_over_symbols(&self, fixed: usize, value: &Rational, budget: &Budget) -> Result<Problem, Error> {
        let left = &self.free[1 - fixed].open();
        let (mut base, mut step) = ([Rational::ZERO, Rational::ZERO], [Rational::ZERO, Rational::ZERO]);
        base[fixed] = value.clone();
        step[1 - fixed] = Rational::ONE;
        let algebra = self.algebra_over_symbols(budget)?;
        let algebra = budget.enter(|| algebra.on_ray(&left.name, &base, &step))?;
        let mut set = self.set.clone();
        set.push((self.free[fixed].name.clone(), value.clone()));
        let free = vec![left.clone()];
        let problem = Problem::new(Arc::clone(&self.model), set, free, self.region.clone(), Vec::new());
        problem.algebra.get_or_init(|| algebra);
        Ok(problem)
    }

    /// The problem with another domain of its one free parameter, its algebra as it is known.
    ///
    /// # Panics
    /// Unless one parameter is free.
    pub fn over_domain(&self, domain: Range) -> Problem {
        let free = vec![Free { domain, ..self.parameter().open() }];
        let problem = Problem::new(Arc::clone(&self.model), self.set.clone(), free, self.region.clone(), Vec::new());
        if let Some(algebra) = self.algebra.get() {
            problem.algebra.get_or_init(|| algebra.clone());
        }
        problem
    }

    /// The problem with its one free parameter at a value.
    pub(crate) fn with_value(&self, value: &Rational) -> Problem {
        let mut set = self.set.clone();
        set.push((self.parameter().name.clone(), value.clone()));
        Problem::new(Arc::clone(&self.model), set, Vec::new(), self.region.clone(), Vec::new())
    }

    /// [`Problem::on_line`] for one who needs the polynomial only in the form that is decided.
    pub(crate) fn line(&self, fixed: usize, value: &Rational, budget: &Budget) -> Result<Problem, Error> {
        let algebra = self.algebra(budget)?.beside_polynomial(fixed, value);
        self.line_with(algebra, fixed, value, budget)
    }

    fn line_with(&self, algebra: Algebra, fixed: usize, value: &Rational, budget: &Budget) -> Result<Problem, Error> {
        let plane = self.plane(budget)?;
        let polynomial = plane.and_then(|p| if fixed == 0 { p.at_x(value) } else { p.swapped().at_x(value) });
        let mut set = self.set.clone();
        set.push((self.free[fixed].name.clone(), value.clone()));
        let free = vec![self.free[1 - fixed].open()];
        let problem = Problem::new(Arc::clone(&self.model), set, free, self.region.clone(), Vec::new());
        problem.algebra.get_or_init(|| algebra);
        problem.parametric.get_or_init(|| polynomial);
        Ok(problem)
    }
}
