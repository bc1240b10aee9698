//! The key `nominal` of parameters: a number, or a formula in constants and other parameters.

use super::domain;
use super::reader::Reader;
use crate::definition::{Model, Parameter};
use crate::error::{Code, Diagnostic, Severity, Span};
use crate::evaluate::work::constant_value;
use crate::nominal::Nominal;
use crate::text::names::shorten;
use crate::text::toml_value::Value;

/// Reads the value, or the formula as long as other names are not known.
pub(super) fn read(value: &Value, parameter: &mut Parameter, what: &str, reader: &mut Reader) {
    let Some(expression) = reader.expression(value, what) else { return };
    match constant_value(&expression) {
        Ok(number) => parameter.nominal = Some(number),
        Err(Some(diagnostic)) => reader.report(diagnostic),
        Err(None) => parameter.nominal_formula = Some(expression),
    }
}

/// The warning about a nominal value outside the domain.
pub(super) fn outside(parameter: &Parameter, at: Span, label: &str) -> Diagnostic {
    let message = format!("the nominal value of '{}' is outside its domain", shorten(&parameter.name));
    Diagnostic::warning(Code::OutsideDomainWarning, message).at(at, label)
}

/// Gives formulas their values for the model's own numbers. One that depends on a parameter without a value has none yet.
pub(super) fn values(model: &mut Model, reader: &mut Reader) {
    if model.parameters.iter().all(|p| p.nominal_formula.is_none()) {
        return;
    }
    let values = model.nominal_values(&|_| None);
    for (parameter, nominal) in model.parameters.iter_mut().zip(values) {
        let Some(formula) = &parameter.nominal_formula else { continue };
        match nominal {
            Nominal::Value(value) => {
                if !parameter.contains(&value) {
                    let label =
                        format!("{} is not in the {} domain", shorten(&value.to_string()), domain::kind(parameter));
                    reader.report(outside(parameter, formula.span, &label));
                }
                parameter.nominal = Some(value);
            }
            // Formulas that need the same wrong constant are wrong for one reason.
            Nominal::Wrong(error) => {
                let is_known = |d: &Diagnostic| d.severity == Severity::Error && d.primary == error.primary;
                if !reader.diagnostics.iter().any(is_known) {
                    reader.report(*error);
                }
            }
            Nominal::Missing | Nominal::Needs(_) => {}
        }
    }
}
