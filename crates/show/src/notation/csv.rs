//! A row per monomial.

use super::terms::plain_number;
use super::{Coefficient, PolynomialReport};

pub(super) fn write(report: &PolynomialReport, digits: Option<usize>) -> String {
    let mut header = vec!["polynomial".to_owned(), format!("{}_power", report.variable), "part".to_owned()];
    header.extend(report.parameters.iter().map(|p| format!("{p}_power")));
    header.push("coefficient".to_owned());
    let mut out = row(&header);
    for polynomial in &report.polynomials {
        for (k, c) in polynomial.coefficients.iter().enumerate() {
            let c = Coefficient::new(c, report.parameters.len());
            let parts = [("numerator", Some(&c.numerator)), ("denominator", c.denominator.as_ref())];
            for (part, terms) in parts {
                for (powers, value) in terms.into_iter().flatten() {
                    let mut cells = vec![polynomial.name.clone(), k.to_string(), part.to_owned()];
                    cells.extend(powers.iter().map(u32::to_string));
                    cells.push(plain_number(value, digits));
                    out.push_str(&row(&cells));
                }
            }
        }
    }
    out
}

fn row(cells: &[String]) -> String {
    let quoted = |cell: &String| {
        if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.clone() }
    };
    let mut line = cells.iter().map(quoted).collect::<Vec<_>>().join(",");
    line.push('\n');
    line
}
