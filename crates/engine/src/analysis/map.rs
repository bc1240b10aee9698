//! The stable region in two parameters.

use super::prepare::{Prepared, prepare};
use super::question::{in_region, nominal, region_of};
use super::{Decision, Failure, Settings};
use crate::error::Diagnostic;
use crate::model::{Loop, Question, Time};
use crate::stability::plane::{PlanePolynomial, StabilityMap, stability_map};
use crate::stability::{Range, Region};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// One of the two parameters of a map.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The parameter's name.
    pub name: String,
    /// Its unit, if the model gives one.
    pub unit: Option<String>,
    /// Its nominal value, if there is one.
    pub nominal: Option<Rational>,
    /// Where the parameter may lie: the model's bounds or those of the question.
    pub domain: Range,
}

/// For which values of two parameters the loop is stable.
#[derive(Clone, Debug)]
pub struct Map {
    /// The loop's title.
    pub title: Option<String>,
    /// Discrete or continuous time.
    pub time: Time,
    /// The parameters, `x` and `y`.
    pub axes: [Axis; 2],
    /// The values of all other parameters.
    pub set: Vec<(String, Rational)>,
    /// The region of stability after the substitution for radius or decay.
    pub region: Region,
    /// The radius asked for, if any.
    pub radius: Option<Rational>,
    /// The decay rate asked for, if any.
    pub decay: Option<Rational>,
    /// The polynomial; `None` when the loop is undefined for all values of both parameters, or when the budget
    /// ran out before.
    pub polynomial: Option<PlanePolynomial>,
    /// The exact decomposition of the domain.
    pub map: Decision<StabilityMap>,
    /// The sample time in the two parameters, in discrete time and if the model gives one.
    pub sample_time: Option<RationalFunction>,
    /// Remarks on the question, e.g. a value outside its domain.
    pub warnings: Vec<Diagnostic>,
}

/// The exact stable region in the plane of two parameters, all others at their set or nominal values.
///
/// A radius or decay rate of the settings is put into the polynomial before it is decomposed. A loop that
/// is undefined for all values of both parameters is stable nowhere.
///
/// # Errors
/// [`Failure`] when the question is refused; a budget that runs out makes an undecided map.
pub fn map(lp: &Loop, settings: &Settings, names: [&str; 2], budget: &Budget) -> Result<Map, Failure> {
    let (mut answer, exhausted) = map_question(lp, settings, names, budget)?;
    answer.map = match exhausted {
        Some(exhausted) => Decision::from_result(Err(exhausted), budget),
        None => answer.decomposed(budget),
    };
    Ok(answer)
}

/// The question of a map without its answer, and why there is no polynomial if the budget is to blame.
pub(super) fn map_question(
    lp: &Loop,
    settings: &Settings,
    names: [&str; 2],
    budget: &Budget,
) -> Result<(Map, Option<Exhausted>), Failure> {
    if names[0] == names[1] {
        return Err(Diagnostic::error("E-usage", format!("'{}' is asked for on both axes", names[0]))
            .help("name two different parameters with '-x' and '-y'")
            .into());
    }
    let region = region_of(lp, settings)?;
    let axes = [axis(lp, settings, names[0])?, axis(lp, settings, names[1])?];
    budget.step("characteristic polynomial");
    let question = Question { keep: names.map(str::to_string).to_vec(), set: settings.set.clone() };
    let (answer, exhausted) = match prepare(lp, &question, budget) {
        Ok(answer) => (answer, None),
        Err(Failure::Undecided(exhausted)) => (Prepared::without_polynomial(lp.resolve(&question)?), Some(exhausted)),
        Err(refused) => return Err(refused),
    };
    let polynomial = answer.polynomial.map(|d| PlanePolynomial::new(&in_region(d, settings)));
    let map = Decision::Undecided { budget: "none".to_owned(), reached: "the question".to_owned() };
    let answer = Map {
        title: lp.title().map(str::to_string),
        time: lp.time(),
        axes,
        set: answer.values,
        region,
        radius: settings.radius.clone(),
        decay: settings.decay.clone(),
        polynomial,
        map,
        sample_time: answer.sample_time.filter(|_| region == Region::UnitDisc),
        warnings: answer.warnings,
    };
    Ok((answer, exhausted))
}

impl Map {
    /// The exact decomposition of the domain.
    pub(super) fn decomposed(&self, budget: &Budget) -> Decision<StabilityMap> {
        match &self.polynomial {
            None => Decision::Decided(StabilityMap::never_stable()),
            Some(p) => {
                let domain = [self.axes[0].domain.clone(), self.axes[1].domain.clone()];
                Decision::from_result(stability_map(p, &domain, self.region, budget), budget)
            }
        }
    }
}

fn axis(lp: &Loop, settings: &Settings, name: &str) -> Result<Axis, Failure> {
    let parameter = lp.parameter(name);
    let domain = match settings.domain.get(name) {
        Some(range) => range.clone(),
        None => parameter.map_or_else(Range::all, |p| Range::between(p.min.clone(), p.max.clone())),
    };
    if domain.is_empty() {
        return Err(Diagnostic::error("E-empty-domain", format!("the domain of '{name}' is empty"))
            .help("the lower bound has to be below the upper one; both are excluded")
            .into());
    }
    Ok(Axis {
        name: name.to_string(),
        unit: parameter.and_then(|p| p.unit.clone()),
        nominal: nominal(lp, name),
        domain,
    })
}
