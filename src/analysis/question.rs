//! From a loop and a question to a polynomial in one parameter.

use super::Failure;
use super::prepare::prepare;
use super::region::{scaled_by_radius, shifted_by_decay};
use crate::error::Diagnostic;
use crate::limits::Budget;
use crate::matrix::CharacteristicPolynomial;
use crate::model::{Loop, Question, Time};
use crate::number::Rational;
use crate::poly::{Domain, RationalFunction, UniPoly};
use crate::stability::{ParametricPolynomial, Range, Region};
use std::collections::BTreeMap;

/// The parameter that stands for the radius of the disc in which all roots have to lie.
pub const RADIUS: &str = "radius";
/// The parameter that stands for the decay rate that all roots have to have.
pub const DECAY: &str = "decay";

/// What is asked besides the parameter itself.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Values of parameters and freed constants, in place of their nominal values.
    pub set: BTreeMap<String, Rational>,
    /// Domains in place of the model's.
    pub domain: BTreeMap<String, Range>,
    /// All roots have to lie in `|z| < radius` (discrete time only).
    pub radius: Option<Rational>,
    /// All roots have to lie in `Re s < -decay` (continuous time only).
    pub decay: Option<Rational>,
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
    /// The polynomial; `None` when the loop is undefined for every value of the parameter.
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
    let region = region_of(lp, settings)?;
    let relative = match (parameter, lp.time()) {
        (RADIUS, Time::Discrete) | (DECAY, Time::Continuous) => true,
        (RADIUS, Time::Continuous) => {
            return Err(Diagnostic::error("E-region", "the radius of a continuous loop's region is not a question")
                .help("ask for '--param decay'")
                .into());
        }
        (DECAY, Time::Discrete) => {
            return Err(Diagnostic::error("E-region", "the decay rate of a discrete loop is not a question")
                .help("ask for '--param radius'")
                .into());
        }
        _ => false,
    };
    if relative && (settings.radius.is_some() || settings.decay.is_some()) {
        return Err(Diagnostic::error("E-kept-and-set", format!("'{parameter}' is the question and is also set"))
            .help(format!("leave out either '--param {parameter}' or '--{parameter}'"))
            .into());
    }
    budget.step("characteristic polynomial");
    let keep = if relative { Vec::new() } else { vec![parameter.to_string()] };
    let question = Question { keep, set: settings.set.clone() };
    let answer = prepare(lp, &question, budget)?;
    let polynomial = answer.polynomial.map(|d| {
        if !relative {
            return in_region(d, settings);
        }
        let d = CharacteristicPolynomial { variables: vec![parameter.to_string()], ..d };
        let variable = RationalFunction::variable(0);
        match region {
            Region::UnitDisc => scaled_by_radius(&d, &variable),
            Region::LeftHalfPlane => shifted_by_decay(&d, &variable),
        }
    });
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
    let univariate = |f: &RationalFunction| {
        let side = |p: &crate::poly::MultiPoly| p.to_univariate(0).expect("one variable is kept");
        (side(f.numerator()), side(f.denominator()))
    };
    let sample_time = answer.sample_time.as_ref().filter(|_| region == Region::UnitDisc).map(univariate);
    Ok(OneParameter {
        title: lp.title().map(str::to_string),
        time: lp.time(),
        parameter: parameter.to_string(),
        unit: lp.parameter(parameter).and_then(|p| p.unit.clone()),
        nominal: nominal(lp, parameter),
        set: answer.values,
        domain,
        region,
        radius: settings.radius.clone(),
        decay: settings.decay.clone(),
        polynomial: polynomial.map(|d| parametric(&d)),
        sample_time,
        warnings: answer.warnings,
    })
}

/// The nominal value of a parameter, or of a constant given as a number.
pub(super) fn nominal(lp: &Loop, name: &str) -> Option<Rational> {
    lp.free(name).ok()?.nominal
}

/// The polynomial of one kept parameter (or none) in the form that is decided.
pub(super) fn parametric(d: &CharacteristicPolynomial) -> ParametricPolynomial {
    let side = |p: &crate::poly::MultiPoly| p.to_univariate(0).expect("one variable is kept");
    let coefficients: Vec<_> = d.coefficients.iter().map(|c| (side(c.numerator()), side(c.denominator()))).collect();
    let poles = d.univariate_poles().expect("one variable is kept");
    let poles = poles.into_iter().filter(|p| !p.is_constant() || p.is_zero()).collect();
    ParametricPolynomial::new(&coefficients, d.formal_degree, poles)
}
