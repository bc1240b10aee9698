//! A coefficient vector with the highest power first, for `roots` and `polyval`.

use super::code::{FloatLiteral, identifiers};
use super::terms::Syntax;
use super::{Coefficient, PolynomialReport};

/// The keywords of MATLAB.
///
/// ```
/// assert!(jurist_show::notation::MATLAB_KEYWORDS.contains(&"parfor"));
/// ```
pub const MATLAB_KEYWORDS: &[&str] = &[
    "break",
    "case",
    "catch",
    "classdef",
    "continue",
    "else",
    "elseif",
    "end",
    "for",
    "function",
    "global",
    "if",
    "otherwise",
    "parfor",
    "persistent",
    "return",
    "spmd",
    "switch",
    "try",
    "while",
];

/// Names that mean something in MATLAB, or in what is written here.
const OWN: [&str; 8] = ["pi", "i", "j", "eps", "inf", "Q", "num", "den"];

pub(super) fn write(report: &PolynomialReport, digits: Option<usize>) -> String {
    let names = identifiers(&report.parameters, &[MATLAB_KEYWORDS, &OWN].concat());
    let syntax = Syntax {
        number: &|v| match FloatLiteral::new(v, digits) {
            FloatLiteral::Decimal(text) => text,
            FloatLiteral::Fraction(n, d) if d == "1" => n,
            FloatLiteral::Fraction(n, d) => format!("{n}/{d}"),
        },
        power: &|i, e| if e == 1 { names[i].clone() } else { format!("{}^{e}", names[i]) },
        times: "*",
        quotient: &|(n, _), (d, _)| format!("({n})/({d})"),
    };
    let mut out: String = report.remarks(digits).iter().map(|r| format!("% {r}\n")).collect();
    out.push_str(&format!("% highest power of {} first\n", report.variable));
    for polynomial in &report.polynomials {
        let arguments = if names.is_empty() { String::new() } else { format!("@({}) ", names.join(", ")) };
        out.push_str(&format!("{} = {arguments}[ ...\n", polynomial.name));
        let entries = polynomial.coefficients.iter().rev().map(|c| {
            let c = Coefficient::new(c, report.parameters.len());
            format!("    {}", syntax.coefficient(&c))
        });
        out.push_str(&entries.collect::<Vec<_>>().join(", ...\n"));
        out.push_str("];\n");
    }
    out
}
