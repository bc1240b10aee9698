//! For programs.

use super::terms::{Terms, plain_number};
use super::{Coefficient, PolynomialReport, Relation};
use jurist_algebra::poly::RationalFunction;
use serde_json::{Map, Value, json};

pub(super) fn write(report: &PolynomialReport, digits: Option<usize>) -> String {
    let mut document = Map::new();
    let schema = match report.relation {
        Relation::Characteristic => "jurist/charpoly/1",
        Relation::RootLocus { .. } => "jurist/root-locus-form/1",
        Relation::Transfer { .. } => "jurist/transfer/1",
    };
    document.insert("schema".into(), schema.into());
    document.insert("title".into(), report.title.as_str().into());
    document.insert("variable".into(), report.variable.as_str().into());
    document.insert("parameters".into(), report.parameters.clone().into());
    let set: Map<String, Value> = report.set.iter().map(|(n, v)| (n.clone(), v.to_string().into())).collect();
    document.insert("set".into(), set.into());
    // Without this key the coefficients are exact.
    if let Some(digits) = digits {
        document.insert("rounded_to_digits".into(), digits.into());
    }
    match &report.relation {
        Relation::Characteristic => {}
        Relation::RootLocus { parameter } => {
            document.insert("parameter".into(), parameter.as_str().into());
        }
        Relation::Transfer { input, output } => {
            document.insert("input".into(), input.as_str().into());
            document.insert("output".into(), output.as_str().into());
        }
    }
    for polynomial in &report.polynomials {
        let key = match polynomial.name.as_str() {
            "num" => "numerator",
            "den" => "denominator",
            _ => "coefficients",
        };
        let list = polynomial.coefficients.iter().map(|c| coefficient(c, report.parameters.len(), digits));
        document.insert(key.into(), Value::Array(list.collect()));
    }
    let mut text = serde_json::to_string_pretty(&Value::Object(document)).unwrap_or_default();
    text.push('\n');
    text
}

fn coefficient(function: &RationalFunction, parameters: usize, digits: Option<usize>) -> Value {
    let c = Coefficient::new(function, parameters);
    let list = |terms: &Terms| -> Value {
        terms.iter().map(|(powers, v)| json!([powers, plain_number(v, digits)])).collect::<Vec<_>>().into()
    };
    let one = vec![(vec![0; parameters], jurist_algebra::number::Rational::ONE)];
    json!({ "numerator": list(&c.numerator), "denominator": list(c.denominator.as_ref().unwrap_or(&one)) })
}
