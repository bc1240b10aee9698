//! Arrays of `f64` expressions, constant term first.

use super::code::{FloatLiteral, identifiers};
use super::terms::Syntax;
use super::{Coefficient, PolynomialReport};

const RESERVED: [&str; 51] = [
    "Self", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn",
    "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro",
    "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super",
    "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where", "while",
];

pub(super) fn write(report: &PolynomialReport, digits: Option<usize>) -> String {
    let names = identifiers(&report.parameters, &RESERVED);
    let syntax = Syntax {
        number: &|v| match FloatLiteral::new(v, digits) {
            FloatLiteral::Decimal(text) => float(&text),
            FloatLiteral::Fraction(n, d) if d == "1" => float(&n),
            FloatLiteral::Fraction(n, d) => format!("{} / {}", float(&n), float(&d)),
        },
        power: &|i, e| if e == 1 { names[i].clone() } else { format!("{}.powi({e})", names[i]) },
        times: " * ",
        quotient: &|(n, _), (d, _)| format!("({n}) / ({d})"),
    };
    let mut out: String = report.remarks(digits).iter().map(|r| format!("// {r}\n")).collect();
    for polynomial in &report.polynomials {
        let (n, name) = (polynomial.coefficients.len(), &polynomial.name);
        out.push_str(&format!("\n/// Coefficients of `{name}` from `{}^0` up.\n", report.variable));
        let (indent, close) = if names.is_empty() {
            out.push_str(&format!("pub const {}: [f64; {n}] = [\n", name.to_uppercase()));
            ("", "];\n")
        } else {
            let arguments: Vec<String> = names.iter().map(|name| format!("{name}: f64")).collect();
            out.push_str("#[allow(non_snake_case)]\n");
            out.push_str(&format!(
                "pub fn {}({}) -> [f64; {n}] {{\n    [\n",
                name.to_lowercase(),
                arguments.join(", ")
            ));
            ("    ", "    ]\n}\n")
        };
        for c in &polynomial.coefficients {
            let c = syntax.coefficient(&Coefficient::new(c, report.parameters.len()));
            out.push_str(&format!("{indent}    {c},\n"));
        }
        out.push_str(close);
    }
    out
}

/// A literal of type `f64`.
fn float(text: &str) -> String {
    if text.contains(['.', 'e']) { text.to_owned() } else { format!("{text}.0") }
}
