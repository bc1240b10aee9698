//! For people: a line per coefficient.

use super::super::layout::visible;
use super::terms::{Syntax, plain_number};
use super::{Coefficient, PolynomialReport};
use jurist_algebra::number::Rational;

pub(super) fn write(report: &PolynomialReport, digits: Option<usize>) -> String {
    let mut out = format!("{}\n", report.headline());
    let mut about = Vec::new();
    if !report.title.is_empty() {
        about.push(visible(&report.title).into_owned());
    }
    if !report.set.is_empty() {
        let number = |v: &Rational| plain_number(v, digits);
        let values: Vec<String> = report.set.iter().map(|(name, v)| format!("{name} = {}", number(v))).collect();
        about.push(format!("at {}", values.join(", ")));
    }
    if !about.is_empty() {
        out.push_str(&format!("({})\n", about.join(", ")));
    }
    for (name, definition) in &report.symbols {
        out.push_str(&format!("{name} = {definition}\n"));
    }
    for polynomial in &report.polynomials {
        out.push('\n');
        let width = (polynomial.coefficients.len().max(1) - 1).to_string().len();
        for (k, c) in polynomial.coefficients.iter().enumerate() {
            let c = coefficient_text(&Coefficient::new(c, report.parameters.len()), &report.parameters, digits);
            out.push_str(&format!("{}_{k:<width$} = {c}\n", polynomial.letter));
        }
    }
    out
}

/// A coefficient such as `46684/2139*T - 4`.
pub fn coefficient_text(c: &Coefficient, parameters: &[String], digits: Option<usize>) -> String {
    let syntax = Syntax {
        number: &|v| plain_number(v, digits),
        power: &|i, e| if e == 1 { parameters[i].clone() } else { format!("{}^{e}", parameters[i]) },
        times: "*",
        quotient: &|(n, single), (d, _)| if single { format!("{n}/({d})") } else { format!("({n})/({d})") },
    };
    syntax.coefficient(c)
}
