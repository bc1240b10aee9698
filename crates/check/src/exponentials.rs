//! Dead time of a plant behind a hold, where it is a factor of the transfer function's text.

use super::expression::{MAX_NESTING, name_length, names_in, number_length};

/// The text of a product without those factors of the whole that are exponentials of `s`, and their exponents. What is no product stays as it is, and so
/// does what cannot be read.
pub(super) fn without_exponentials(text: &str) -> (String, Vec<&str>) {
    let (mut rest, mut exponents) = (String::with_capacity(text.len()), Vec::new());
    take_out(text, &mut rest, &mut exponents, 0);
    (rest, exponents)
}

fn take_out<'t>(text: &'t str, rest: &mut String, exponents: &mut Vec<&'t str>, nesting: usize) {
    let Some(factors) = factors(text).filter(|_| nesting <= MAX_NESTING) else { return rest.push_str(text) };
    for (operator, factor) in factors {
        rest.extend(operator);
        let body = factor.trim_start_matches(|c: char| c == '+' || c == '-' || c.is_whitespace());
        rest.push_str(&factor[..factor.len() - body.len()]);
        match body.strip_prefix("exp").and_then(in_parentheses) {
            Some(exponent) if operator != Some('/') && names_in(exponent).contains(&"s") => {
                exponents.push(exponent);
                rest.push('1');
            }
            _ => match in_parentheses(body) {
                Some(inner) if operator != Some('/') => {
                    rest.push('(');
                    take_out(inner, rest, exponents, nesting + 1);
                    rest.push(')');
                }
                _ => rest.push_str(body),
            },
        }
    }
}

/// What is in the parentheses that a text is all of.
fn in_parentheses(text: &str) -> Option<&str> {
    let inner = text.trim().strip_prefix('(')?;
    let mut depth = 1;
    for (i, c) in inner.char_indices() {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if depth == 0 {
            return Some(&inner[..i]).filter(|_| i + 1 == inner.len());
        }
    }
    None
}

/// The factors of a product and what is before each; `None` of a sum.
fn factors(text: &str) -> Option<Vec<(Option<char>, &str)>> {
    let (mut out, mut operator, mut begin, mut depth) = (Vec::new(), None, 0, 0);
    let (mut at, mut is_operand) = (0, false);
    while let Some(c) = text[at..].chars().next() {
        let word = name_length(&text[at..]).max(number_length(&text[at..]));
        if depth == 0 && word == 0 {
            match c {
                '+' | '-' if is_operand => return None,
                '*' | '/' => {
                    out.push((operator, &text[begin..at]));
                    (operator, begin) = (Some(c), at + 1);
                }
                _ => {}
            }
        }
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if !c.is_whitespace() {
            is_operand = word > 0 || c == ')';
        }
        at += word.max(c.len_utf8());
    }
    out.push((operator, &text[begin..]));
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_of_the_whole_are_taken_out() {
        for (text, rest, exponents) in [
            ("exp(-d*s)*1.5/(90*s + 1)", "1*1.5/(90*s + 1)", vec!["-d*s"]),
            ("-(2e-3*exp(-s)/(s+1)) * exp(-(a + b)*s)", "-(2e-3*1/(s+1))* 1", vec!["-s", "-(a + b)*s"]),
            ("K/(s + 1)*-exp( -s )", "K/(s + 1)*-1", vec![" -s "]),
            ("((exp(-s)))", "((1))", vec!["-s"]),
        ] {
            assert_eq!(without_exponentials(text), (rest.to_owned(), exponents));
        }
        let deep = format!("{}exp(-s){}", "(".repeat(300), ")".repeat(300));
        for text in [
            "exp(-s) + 1",
            "1/exp(-s)",
            "1/(2*exp(-s))",
            "2*exp(-s)*3 + 1",
            "(1 - 2*exp(-s)/(s + 1))",
            "exp(-s)^2",
            "exp(-2)/s",
            "exp2(s)*a",
            "exp(-s",
            "(exp(-s)",
            "",
            "a*",
            "*",
            "2*(1 - exp(-s))",
            "exp(-s)*",
            "exp",
            "exp()*s",
            "1 - -exp(-s)",
            &deep,
        ] {
            let (rest, exponents) = without_exponentials(text);
            assert!(exponents.is_empty() || text == "exp(-s)*", "{text}");
            assert!(rest == text || text == "exp(-s)*", "{text}");
        }
    }
}
