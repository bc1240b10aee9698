//! What the model says to a question: polynomial, values, sample time.

use super::Failure;
use crate::error::Diagnostic;
use crate::model::{Loop, ModelError, Question};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// A question put to a model.
pub(super) struct Prepared {
    /// The polynomial; `None` when the loop is undefined whatever the kept parameters are.
    pub polynomial: Option<CharacteristicPolynomial>,
    /// Why the loop is undefined whatever the kept parameters are.
    pub undefined: Option<String>,
    /// The degree while all parameters are symbolic.
    pub formal_degree: usize,
    /// The values of all parameters that are not kept.
    pub values: Vec<(String, Rational)>,
    /// The sample time in the kept parameters.
    pub sample_time: Option<RationalFunction>,
    /// Remarks, e.g. a value outside its domain.
    pub warnings: Vec<Diagnostic>,
}

impl Prepared {
    /// What is known of a question whose polynomial is not.
    pub fn without_polynomial(resolved: crate::model::Resolved) -> Self {
        Prepared {
            polynomial: None,
            undefined: None,
            formal_degree: 0,
            values: resolved.values,
            sample_time: None,
            warnings: resolved.warnings,
        }
    }
}

pub(super) fn prepare(lp: &Loop, question: &Question, budget: &Budget) -> Result<Prepared, Failure> {
    let resolved = lp.resolve(question)?;
    let mut undefined = None;
    let (polynomial, formal_degree) = match lp.characteristic_polynomial(question, budget) {
        Ok(polynomial) => {
            let degree = polynomial.formal_degree;
            (Some(polynomial), degree)
        }
        Err(ModelError::Undefined(why)) => {
            undefined = Some(why);
            (None, symbolic_degree(lp, question, budget)?)
        }
        Err(error) => return Err(error.into()),
    };
    let sample_time = match lp.sample_time(question, budget) {
        Ok(sample_time) => sample_time,
        Err(ModelError::Undefined(_)) => None,
        Err(error) => return Err(error.into()),
    };
    Ok(Prepared {
        polynomial,
        undefined,
        formal_degree,
        values: resolved.values,
        sample_time,
        warnings: resolved.warnings,
    })
}

/// The degree where the values set leave the loop undefined: that of the polynomial before any was set.
fn symbolic_degree(lp: &Loop, question: &Question, budget: &Budget) -> Result<usize, Failure> {
    let parameters = lp.parameters().iter().map(|p| p.name.clone());
    let freed = question.keep.iter().filter(|name| lp.parameter(name).is_none()).cloned();
    let mut symbolic = Question::keeping(parameters.chain(freed));
    let is_constant = |name: &String| lp.parameter(name).is_none();
    symbolic.set =
        question.set.iter().filter(|(name, _)| is_constant(name)).map(|(n, v)| (n.clone(), v.clone())).collect();
    let question = symbolic;
    Ok(lp.characteristic_polynomial(&question, budget)?.formal_degree)
}

impl From<ModelError> for Failure {
    fn from(error: ModelError) -> Self {
        match error {
            ModelError::Input(error) => Failure::Refused(error),
            ModelError::Exhausted(exhausted) => Failure::Undecided(exhausted),
            ModelError::Undefined(what) => {
                Diagnostic::error("E-undefined", format!("the model is undefined at these values: {what}")).into()
            }
        }
    }
}
