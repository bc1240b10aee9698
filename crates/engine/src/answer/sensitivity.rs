//! How the limits of a parameter move with everything else in the model.

use super::Answer;
use crate::error::Error;
use crate::problem::{Ask, Problem, fixed_symbols};
use crate::response::ground::{Constants, Ground, Integers};
use crate::response::{Place, Value};
use crate::stability::{Cause, End, HalfSizePair, Shape, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// The derivatives of the limits of one parameter with respect to the other names of the model that are numbers.
///
/// At a limit one boundary polynomial `b(p, c)` is zero, so `dp/dc = -b_c/b_p` there: a quotient of polynomials at the limit,
/// exact as the limit itself.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .constant("a", "1/2")
///     .characteristic("z^2 - z + a*K")
///     .build()?;
/// let budget = Budget::unlimited();
/// let answer = model.ask().free("K").stable_set(&budget)?; // a K < 1
/// let table = answer.sensitivities(&budget)?;
/// let upper = &table.rows[1];
/// assert_eq!((upper.limit.decimal(6), upper.name.as_str()), ("2".into(), "a"));
/// assert_eq!(upper.derivative.as_ref().unwrap().decimal(6), "-4"); // d(1/a)/da
/// assert_eq!(upper.relative.as_ref().unwrap().decimal(6), "-1");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Sensitivities {
    /// For each limit, and within it for each name in the order of the model.
    pub rows: Vec<Sensitivity>,
}

/// How one limit moves with one name.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Sensitivity {
    /// The limit.
    pub limit: Real,
    /// The parameter or constant.
    pub name: String,
    /// Its value.
    pub value: Rational,
    /// The derivative of the limit; `None` where the limit has none, or the name is inside of a function.
    pub derivative: Option<Real>,
    /// The derivative times the value over the limit: percent of the limit for a percent of the value. `None` at a limit of 0.
    pub relative: Option<Real>,
}

impl Answer<StableSet> {
    /// The derivatives of all limits but those of the domain.
    ///
    /// Cost: for each other name an evaluation of the model and the boundary polynomials in two variables.
    ///
    /// # Errors
    /// [`Error`]: refused for loops with dead time, or stopped.
    pub fn sensitivities(&self, budget: &Budget) -> Result<Sensitivities, Error> {
        let problem = self.problem();
        problem.refuse_complex(budget)?;
        let mut ends: Vec<&End> =
            self.value().intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().collect();
        ends.retain(|end| end.causes.is_limit());
        ends.dedup_by(|b, a| a.value.is_same(&b.value));
        let mut columns = Vec::new();
        for (name, value) in others(problem) {
            budget.check()?;
            let family = match Family::of(problem, &name, &value, budget) {
                Ok(family) => family,
                // Where the order changes with it, or the loop is not defined around it, there is no derivative.
                Err(Error::Refused(_) | Error::Undefined(_)) => None,
                Err(error) => return Err(error),
            };
            columns.push((name, value, family));
        }
        let mut out = Sensitivities::default();
        for end in ends {
            for (name, value, family) in &columns {
                let found = family.as_ref().map(|family| family.derivative(end, budget)).transpose()?.flatten();
                let (derivative, relative) = found.map_or((None, None), |(own, relative)| (Some(own), relative));
                let (limit, name, value) = (end.value.clone(), name.clone(), value.clone());
                out.rows.push(Sensitivity { limit, name, value, derivative, relative });
            }
        }
        Ok(out)
    }
}

/// The other names that are numbers, with their values.
fn others(problem: &Problem) -> Vec<(String, Rational)> {
    let asked = &problem.parameter().name;
    let model = problem.model();
    let set = |name: &str| problem.set().iter().find(|(n, _)| n == name).map(|(_, value)| value.clone());
    let parameters = model.parameters().iter().filter_map(|p| Some((p.name.clone(), set(&p.name)?)));
    let constants = model.constants().iter().filter_map(|c| Some((c.name.clone(), set(&c.name).or(c.number.clone())?)));
    parameters.chain(constants).filter(|(name, _)| name != asked).collect()
}

/// The boundary conditions in the parameter (variable 0) and another name (variable 1), symbols after them.
struct Family {
    conditions: Vec<(Cause, MultiPoly)>,
    constants: Option<Constants>,
    /// The value of the other name.
    value: Rational,
    shape: Shape,
}

impl Family {
    /// `None` where the name is inside of a function.
    fn of(problem: &Problem, name: &str, value: &Rational, budget: &Budget) -> Result<Option<Family>, Error> {
        let others = problem.set().iter().filter(|(n, _)| n != name).cloned();
        let question = problem.model().ask().set_all(others).within(problem.region().clone());
        let free = &problem.parameter().name;
        if problem.region().is_free() {
            return Ok(None);
        }
        let both = question.free(free.clone()).free(name).problem()?;
        let algebra = both.algebra_over_symbols(budget)?;
        let symbols = algebra.symbols();
        let Some(d) = algebra.polynomial().filter(|_| !symbols.is_moving() && symbols.delays().is_empty()) else {
            return Ok(None);
        };
        let constants = if symbols.is_empty() { None } else { Some(Constants(Arc::new(fixed_symbols(symbols)?))) };
        let shape = problem.shape();
        budget.enter(|| {
            let (p, _) = d.cleared();
            let at = |x: i64| p.eval(&MultiPoly::constant(Integer::from(x)));
            let mut conditions = match shape {
                Shape::UnitDisc => vec![(Cause::RootAtOne, at(1)), (Cause::RootAtMinusOne, at(-1))],
                Shape::LeftHalfPlane => vec![(Cause::RootAtZero, at(0))],
            };
            let n = d.formal_degree;
            if n > 1 {
                let pair = HalfSizePair::new(&p, n, shape).critical_constraint(budget)?;
                conditions.push((Cause::ComplexPair, pair));
            }
            conditions.push((Cause::DegreeLost, p.coeff(n)));
            Ok(Some(Family { conditions, constants, value: value.clone(), shape }))
        })?
    }

    /// The derivative of a limit, and the relative one.
    fn derivative(&self, end: &End, budget: &Budget) -> Result<Option<(Real, Option<Real>)>, Exhausted> {
        let held = |(cause, b): &&(Cause, MultiPoly)| end.causes.iter().any(|c| c == *cause) && !b.is_zero();
        let Some((_, boundary)) = self.conditions.iter().find(held) else { return Ok(None) };
        // A factor that is repeated has a derivative of zero.
        for boundary in [boundary.clone(), budget.enter(|| boundary.square_free_part())?] {
            let (by_parameter, by_name) = (boundary.derivative(0), boundary.derivative(1));
            let [(below, below_scale), (above, above_scale)] =
                [by_parameter, by_name].map(|p| p.substitute(1, &self.value));
            // Both over the same denominator.
            let (below, above) = (below.scaled_by(&above_scale), above.scaled_by(&(-below_scale)));
            let found = match &self.constants {
                None => {
                    let plain = |p: &MultiPoly| p.to_univariate(0).expect("one variable is left");
                    self.quotients(&Integers, &plain(&above), &plain(&below), end, budget)?
                }
                Some(constants) => {
                    let over = |p: &MultiPoly| p.as_poly_in(0).map(|c| c.map_variables(|i| i.saturating_sub(2)));
                    self.quotients(constants, &over(&above), &over(&below), end, budget)?
                }
            };
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// `above/below` at a limit, and the same times the name's value over the limit; `None` where `below` is zero there.
    fn quotients<G: Ground>(
        &self,
        ground: &G,
        above: &Poly<G::Number>,
        below: &Poly<G::Number>,
        end: &End,
        budget: &Budget,
    ) -> Result<Option<(Real, Option<Real>)>, Exhausted> {
        let place = Place::Inside(end.value.clone());
        let at = |a: &Poly<G::Number>, b: &Poly<G::Number>| -> Result<Option<Real>, Exhausted> {
            let found: Option<Value> = ground.value(a, b, &place, self.shape.into(), budget)?;
            found.map(|found| found.number(budget)).transpose()
        };
        let Some(derivative) = at(above, below)? else { return Ok(None) };
        let number = |n: Integer| G::Number::from_integer(&n);
        let scaled = above.scaled(&number(self.value.numerator()));
        let by_limit = below.shifted_up(1).scaled(&number(self.value.denominator()));
        let relative = if end.value.sign().is_eq() { None } else { at(&scaled, &by_limit)? };
        Ok(Some((derivative, relative)))
    }
}
