//! From a loop and a question to a polynomial in one parameter.

use super::Failure;
use super::prepare::prepare;
use super::region::{scaled_by_radius, shifted_by_decay};
use crate::error::Diagnostic;
use crate::model::{Loop, Question, Time};
use crate::stability::{ParametricPolynomial, Range, Region};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, RationalFunction, UniPoly};
use std::collections::BTreeMap;

/// The parameter that stands for the radius of the disc in which all roots have to lie.
pub const RADIUS: &str = "radius";
/// The parameter that stands for the decay rate that all roots have to have.
pub const DECAY: &str = "decay";

/// What is asked besides the parameter itself.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Values of parameters in place of their nominal values, and numbers of constants in place of the model's.
    pub set: BTreeMap<String, Rational>,
    /// Domains in place of the model's.
    pub domain: BTreeMap<String, Range>,
    /// All roots have to lie in `|z| < radius` (discrete time only).
    pub radius: Option<Rational>,
    /// All roots have to lie in `Re s < -decay` (continuous time only).
    pub decay: Option<Rational>,
}

impl Settings {
    /// Values that lie outside their domains, those of the settings before those of the model.
    ///
    /// A nominal value outside the model's own domain is remarked upon when the model is read.
    pub fn warnings(&self, lp: &Loop, keep: &[String]) -> Vec<Diagnostic> {
        let parameters = lp.parameters().iter().map(|p| &p.name);
        let names = parameters.chain(lp.constants().iter().map(|c| &c.name)).filter(|name| !keep.contains(name));
        let mut warnings = Vec::new();
        for name in names {
            let set = self.set.get(name).cloned();
            let outside = match self.domain.get(name) {
                Some(range) => set.or_else(|| nominal(lp, name)).filter(|v| !range.contains(v)),
                None => set.filter(|v| lp.parameter(name).is_some_and(|p| !p.contains(v))),
            };
            if let Some(value) = outside {
                let message = format!("{name} = {value} is outside its domain");
                warnings.push(Diagnostic::warning("W-outside-domain", message));
            }
        }
        warnings
    }
}

/// What is known of a question at a point before any work is done.
#[derive(Clone, Debug)]
pub struct Point {
    /// The loop's title.
    pub title: Option<String>,
    /// Discrete or continuous time.
    pub time: Time,
    /// The values of all parameters that are not kept.
    pub set: Vec<(String, Rational)>,
    /// The radius asked for, if any.
    pub radius: Option<Rational>,
    /// The decay rate asked for, if any.
    pub decay: Option<Rational>,
}

impl Point {
    /// The loop at its set and nominal values, but for the parameters kept.
    ///
    /// # Errors
    /// [`Failure::Refused`] for names the model does not know and values that are missing.
    pub fn of(lp: &Loop, settings: &Settings, keep: &[String]) -> Result<Point, Failure> {
        region_of(lp, settings)?;
        Ok(Point {
            title: lp.title().map(str::to_string),
            time: lp.time(),
            set: lp.resolve(&Question { keep: keep.to_vec(), set: settings.set.clone() })?.values,
            radius: settings.radius.clone(),
            decay: settings.decay.clone(),
        })
    }
}

/// A question about one parameter, reduced to algebra.
#[derive(Clone, Debug)]
pub struct OneParameter {
    /// The loop's title.
    pub title: Option<String>,
    /// Discrete or continuous time.
    pub time: Time,
    /// The parameter's name.
    pub parameter: String,
    /// Its unit, if the model gives one.
    pub unit: Option<String>,
    /// Its nominal value, if there is one.
    pub nominal: Option<Rational>,
    /// The values of all other parameters.
    pub set: Vec<(String, Rational)>,
    /// Where the parameter may lie: the model's bounds or those of the question.
    pub domain: Range,
    /// The region of stability after the substitution for radius or decay.
    pub region: Region,
    /// The radius asked for, if any.
    pub radius: Option<Rational>,
    /// The decay rate asked for, if any.
    pub decay: Option<Rational>,
    /// The polynomial; `None` when the loop is undefined for every value of the parameter, or beside an
    /// answer that is undecided because the budget ran out before it.
    pub polynomial: Option<ParametricPolynomial>,
    /// Numerator and denominator of the sample time in the parameter, in discrete time and if the
    /// model gives one.
    pub sample_time: Option<(UniPoly, UniPoly)>,
    /// Remarks on the question, e.g. a value outside its domain.
    pub warnings: Vec<Diagnostic>,
}

/// The region, and the refusal of options that do not fit the kind of time.
pub(super) fn region_of(lp: &Loop, settings: &Settings) -> Result<Region, Failure> {
    let positive = |value: &Option<Rational>| value.as_ref().is_none_or(|v| v.sign().is_gt());
    match lp.time() {
        Time::Discrete if settings.decay.is_some() => {
            Err(Diagnostic::error("E-region", "a decay rate applies to continuous time, and this loop is discrete")
                .help("ask for '--radius R': all roots in |z| < R")
                .into())
        }
        Time::Continuous if settings.radius.is_some() => {
            Err(Diagnostic::error("E-region", "a radius applies to discrete time, and this loop is continuous")
                .help("ask for '--decay S': all roots in Re s < -S")
                .into())
        }
        _ if !positive(&settings.radius) => Err(Diagnostic::error("E-region", "the radius has to be positive").into()),
        Time::Discrete => Ok(Region::UnitDisc),
        Time::Continuous => Ok(Region::LeftHalfPlane),
    }
}

/// The polynomial with the radius or the decay rate of the settings put in.
pub(super) fn in_region(d: CharacteristicPolynomial, settings: &Settings) -> CharacteristicPolynomial {
    match (&settings.radius, &settings.decay) {
        (Some(r), _) => scaled_by_radius(&d, &RationalFunction::from(r.clone())),
        (None, Some(s)) => shifted_by_decay(&d, &RationalFunction::from(s.clone())),
        (None, None) => d,
    }
}

/// Reduces the question for which values of `parameter` the loop is stable, all other parameters at
/// their set or nominal values.
///
/// `parameter` may be [`RADIUS`] or [`DECAY`], which ask how far inside all roots are.
///
/// # Errors
/// [`Failure::Refused`] for names the model does not know, values that are missing, options that
/// contradict each other; [`Failure::Undecided`] when the budget runs out.
pub fn one_parameter(
    lp: &Loop,
    settings: &Settings,
    parameter: &str,
    budget: &Budget,
) -> Result<OneParameter, Failure> {
    one_parameter_or_stopped(lp, settings, parameter, budget)?.map_err(|(_, stopped)| stopped.into())
}

/// [`one_parameter`], or what is known of the question without the polynomial when the budget runs out.
pub(super) fn one_parameter_or_stopped(
    lp: &Loop,
    settings: &Settings,
    parameter: &str,
    budget: &Budget,
) -> Result<Result<OneParameter, (OneParameter, Exhausted)>, Failure> {
    let mut question = asked(lp, settings, parameter)?;
    match reduce(&mut question, lp, settings, budget) {
        Ok(()) => Ok(Ok(question)),
        Err(Failure::Undecided(stopped)) => Ok(Err((question, stopped))),
        Err(refused) => Err(refused),
    }
}

/// Whether the question is how far inside all roots are.
fn is_relative(parameter: &str, time: Time) -> Result<bool, Failure> {
    match (parameter, time) {
        (RADIUS, Time::Discrete) | (DECAY, Time::Continuous) => Ok(true),
        (RADIUS, Time::Continuous) => {
            Err(Diagnostic::error("E-region", "the radius of a continuous loop's region is not a question")
                .help("ask for '--param decay'")
                .into())
        }
        (DECAY, Time::Discrete) => {
            Err(Diagnostic::error("E-region", "the decay rate of a discrete loop is not a question")
                .help("ask for '--param radius'")
                .into())
        }
        _ => Ok(false),
    }
}

/// The question without its polynomial: what is known before any work.
///
/// # Errors
/// [`Failure::Refused`] as [`one_parameter`].
pub fn asked(lp: &Loop, settings: &Settings, parameter: &str) -> Result<OneParameter, Failure> {
    let region = region_of(lp, settings)?;
    let relative = is_relative(parameter, lp.time())?;
    if relative && (settings.radius.is_some() || settings.decay.is_some()) {
        return Err(Diagnostic::error("E-kept-and-set", format!("'{parameter}' is the question and is also set"))
            .help(format!("leave out either '--param {parameter}' or '--{parameter}'"))
            .into());
    }
    let keep = if relative { Vec::new() } else { vec![parameter.to_string()] };
    let point = Point::of(lp, settings, &keep)?;
    let domain = match settings.domain.get(parameter) {
        // No root is nearer to 0 than by a negative radius.
        Some(range) if parameter == RADIUS && relative => {
            Range { lower: range.lower.clone().max(Some(Rational::ZERO)), upper: range.upper.clone() }
        }
        Some(range) => range.clone(),
        None if relative => Range::between(Some(Rational::ZERO), None),
        None => lp.parameter(parameter).map_or_else(Range::all, |p| Range::between(p.min.clone(), p.max.clone())),
    };
    if domain.is_empty() {
        return Err(Diagnostic::error("E-empty-domain", format!("the domain of '{parameter}' is empty"))
            .help("the lower bound has to be below the upper one; both are excluded")
            .into());
    }
    Ok(OneParameter {
        title: point.title,
        time: point.time,
        parameter: parameter.to_string(),
        unit: lp.parameter(parameter).and_then(|p| p.unit.clone()),
        nominal: nominal(lp, parameter),
        set: point.set,
        domain,
        region,
        radius: point.radius,
        decay: point.decay,
        polynomial: None,
        sample_time: None,
        warnings: settings.warnings(lp, &keep),
    })
}

/// Puts the polynomial and the sample time into the question.
fn reduce(asked: &mut OneParameter, lp: &Loop, settings: &Settings, budget: &Budget) -> Result<(), Failure> {
    budget.step("characteristic polynomial");
    let relative = is_relative(&asked.parameter, asked.time)?;
    let keep = if relative { Vec::new() } else { vec![asked.parameter.clone()] };
    let answer = prepare(lp, &Question { keep, set: settings.set.clone() }, budget)?;
    let polynomial = answer.polynomial.map(|d| {
        if !relative {
            return in_region(d, settings);
        }
        let d = CharacteristicPolynomial { variables: vec![asked.parameter.clone()], ..d };
        let variable = RationalFunction::variable(0);
        match asked.region {
            Region::UnitDisc => scaled_by_radius(&d, &variable),
            Region::LeftHalfPlane => shifted_by_decay(&d, &variable),
        }
    });
    let univariate = |f: &RationalFunction| {
        let side = |p: &jurist_algebra::poly::MultiPoly| p.to_univariate(0).expect("one variable is kept");
        (side(f.numerator()), side(f.denominator()))
    };
    asked.sample_time = answer.sample_time.as_ref().filter(|_| asked.region == Region::UnitDisc).map(univariate);
    asked.polynomial = polynomial.map(|d| parametric(&d));
    Ok(())
}

/// The nominal value of a parameter, or of a constant given as a number.
pub(super) fn nominal(lp: &Loop, name: &str) -> Option<Rational> {
    lp.free(name).ok()?.nominal
}

/// The polynomial of one kept parameter (or none) in the form that is decided.
pub(super) fn parametric(d: &CharacteristicPolynomial) -> ParametricPolynomial {
    let side = |p: &jurist_algebra::poly::MultiPoly| p.to_univariate(0).expect("one variable is kept");
    let coefficients: Vec<_> = d.coefficients.iter().map(|c| (side(c.numerator()), side(c.denominator()))).collect();
    let poles = d.univariate_poles().expect("one variable is kept");
    let poles = poles.into_iter().filter(|p| !p.is_constant() || p.is_zero()).collect();
    ParametricPolynomial::new(&coefficients, d.formal_degree, poles)
}
