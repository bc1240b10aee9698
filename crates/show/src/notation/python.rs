//! Lists of `fractions.Fraction`, constant term first.

use super::code::identifiers;
use super::terms::{Syntax, plain_number};
use super::{Coefficient, PolynomialReport};

/// The keywords of Python.
///
/// ```
/// assert!(jurist_show::notation::PYTHON_KEYWORDS.contains(&"lambda"));
/// ```
pub const PYTHON_KEYWORDS: &[&str] = &[
    "False", "None", "True", "and", "as", "assert", "async", "await", "break", "class", "continue", "def", "del",
    "elif", "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is", "lambda", "nonlocal",
    "not", "or", "pass", "raise", "return", "try", "while", "with", "yield",
];

/// Names of what is written here.
const OWN: [&str; 4] = ["Fraction", "Q", "num", "den"];

pub(super) fn write(report: &PolynomialReport, digits: Option<usize>) -> String {
    let names = identifiers(&report.parameters, &[PYTHON_KEYWORDS, &OWN].concat());
    let syntax = Syntax {
        number: &|v| match digits {
            None if !v.is_integer() => format!("Fraction({}, {})", v.numerator(), v.denominator()),
            _ => plain_number(v, digits),
        },
        power: &|i, e| if e == 1 { names[i].clone() } else { format!("{}**{e}", names[i]) },
        times: "*",
        quotient: &|(n, _), (d, _)| format!("({n})/({d})"),
    };
    let mut out: String = report.remarks(digits).iter().map(|r| format!("# {r}\n")).collect();
    out.push_str(&format!("# coefficients from {}^0 up\n", report.variable));
    if digits.is_none() {
        out.push_str("from fractions import Fraction\n");
    }
    for polynomial in &report.polynomials {
        out.push('\n');
        let (indent, close) = if names.is_empty() {
            out.push_str(&format!("{} = [\n", polynomial.name));
            ("", "]\n")
        } else {
            out.push_str(&format!("\ndef {}({}):\n    return [\n", polynomial.name, names.join(", ")));
            ("    ", "    ]\n")
        };
        for c in &polynomial.coefficients {
            let c = syntax.coefficient(&Coefficient::new(c, report.parameters.len()));
            out.push_str(&format!("{indent}    {c},\n"));
        }
        out.push_str(close);
    }
    out
}
