//! Aligned equations for `amsmath`.

use super::terms::Syntax;
use super::{Coefficient, NamedPolynomial, PolynomialReport, Relation};
use jurist_algebra::number::{Rational, to_decimal};

pub(super) fn write(report: &PolynomialReport, digits: Option<usize>) -> String {
    let v = &report.variable;
    let mut lines = Vec::new();
    match &report.relation {
        Relation::Characteristic => {}
        Relation::Complex => {
            lines.push(format!("Q({v}) &= \\mathrm{{re}}({v}) + j \\, \\mathrm{{im}}({v})"));
        }
        Relation::RootLocus { parameter } => {
            lines
                .push(format!("1 + {} \\frac{{\\mathrm{{num}}({v})}}{{\\mathrm{{den}}({v})}} &= 0", symbol(parameter)));
        }
        Relation::Transfer { input, output } => {
            let (input, output) = (symbol(input), symbol(output));
            lines.push(format!(
                "\\frac{{{output}({v})}}{{{input}({v})}} &= \\frac{{\\mathrm{{num}}({v})}}{{\\mathrm{{den}}({v})}}"
            ));
        }
    }
    for polynomial in &report.polynomials {
        lines.extend(equations(polynomial, report, digits));
    }
    let mut out: String = report.remarks(digits).iter().map(|r| format!("% {r}\n")).collect();
    out.push_str("\\begin{align*}\n");
    out.push_str(&lines.join(" \\\\\n"));
    out.push_str("\n\\end{align*}\n");
    out
}

/// The polynomial with letters for its coefficients, and a line for each of them.
fn equations(polynomial: &NamedPolynomial, report: &PolynomialReport, digits: Option<usize>) -> Vec<String> {
    let v = &report.variable;
    let letter = |k: usize| format!("{}_{{{k}}}", polynomial.letter);
    let monomial = |k: usize| match k {
        0 => letter(0),
        1 => format!("{} {v}", letter(1)),
        _ => format!("{} {v}^{{{k}}}", letter(k)),
    };
    let sum: Vec<String> = (0..polynomial.coefficients.len()).rev().map(monomial).collect();
    let name =
        if polynomial.name.len() == 1 { polynomial.name.clone() } else { format!("\\mathrm{{{}}}", polynomial.name) };
    let mut lines = vec![format!("{name}({v}) &= {}", sum.join(" + "))];
    let syntax = Syntax {
        number: &|value| number(value, digits),
        power: &|i, e| {
            let name = symbol(&report.parameters[i]);
            if e == 1 { name } else { format!("{name}^{{{e}}}") }
        },
        times: " \\, ",
        quotient: &|(n, _), (d, _)| format!("\\frac{{{n}}}{{{d}}}"),
    };
    for (k, c) in polynomial.coefficients.iter().enumerate() {
        let c = syntax.coefficient(&Coefficient::new(c, report.parameters.len()));
        lines.push(format!("{} &= {c}", letter(k)));
    }
    lines
}

fn number(value: &Rational, digits: Option<usize>) -> String {
    match digits {
        None if value.is_integer() => value.to_string(),
        None => format!("\\frac{{{}}}{{{}}}", value.numerator(), value.denominator()),
        Some(digits) => {
            let text = to_decimal(value, digits);
            match text.split_once('e') {
                Some((mantissa, exponent)) => format!("{mantissa} \\cdot 10^{{{exponent}}}"),
                None => text,
            }
        }
    }
}

/// A name as mathematics: `K_pwm` becomes `K_{\mathrm{pwm}}`, `omega` the letter.
pub fn symbol(name: &str) -> String {
    const GREEK: [&str; 24] = [
        "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu", "nu",
        "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega", "Omega",
    ];
    let part = |part: &str| {
        if GREEK.contains(&part) {
            format!("\\{part}")
        } else if (part != "_" && part.chars().count() == 1) || part.chars().all(|c| c.is_ascii_digit()) {
            part.to_owned()
        } else {
            format!("\\mathrm{{{}}}", part.replace('_', "\\_"))
        }
    };
    match name.split_once('_') {
        Some((base, index)) if !base.is_empty() && !index.is_empty() => format!("{}_{{{}}}", part(base), part(index)),
        _ => part(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether braces are balanced, no group is empty, and at most one `_` is an index, which has braces.
    fn is_sound(latex: &str) -> bool {
        let bare = latex.replace("\\_", "u");
        let (mut depth, mut lowest) = (0_i32, 0);
        for c in bare.chars() {
            depth += i32::from(c == '{') - i32::from(c == '}');
            lowest = lowest.min(depth);
        }
        let indices = bare.matches('_').count();
        depth == 0 && lowest == 0 && indices <= 1 && bare.matches("_{").count() == indices && !bare.contains("{}")
    }

    #[test]
    fn every_legal_name_is_sound_mathematics() {
        let letters = ["_", "a", "K", "1", "\u{e9}", "omega"];
        let mut names = vec![String::new()];
        for _ in 0..5 {
            let longer: Vec<String> = names.iter().flat_map(|n| letters.map(|l| format!("{n}{l}"))).collect();
            for name in longer.iter().filter(|n| !n.starts_with('1')) {
                let latex = symbol(name);
                assert!(is_sound(&latex), "{name}: {latex}");
            }
            names = longer;
        }
        assert_eq!(symbol("_"), "\\mathrm{\\_}");
        assert_eq!(symbol("K__"), "K_{\\mathrm{\\_}}");
        assert_eq!(symbol("K_pwm"), "K_{\\mathrm{pwm}}");
        assert_eq!(symbol("omega_1"), "\\omega_{1}");
    }
}
