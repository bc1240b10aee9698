//! What to write instead, for text that is not TOML: expressions without quotes, units, comments and whole files of other
//! programs.

use super::names::shorten;

/// The remedy for a syntax error at this byte, from the line it stands in.
pub(super) fn hint(text: &str, at: usize) -> Option<String> {
    let at = (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i))?;
    let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
    let line = text[start..].lines().next().unwrap_or_default().trim();
    if line.contains(['\u{201c}', '\u{201d}', '\u{2018}', '\u{2019}']) {
        return Some("write straight quotes: \"..\"".into());
    }
    if line.starts_with('%') || line.starts_with("//") {
        return Some("comments begin with '#'".into());
    }
    let statement = line.split(['%', '#']).next().unwrap_or_default().trim_end();
    if statement.ends_with(';') || is_call(statement) {
        return Some("this looks like MATLAB; 'jurist new' writes a model to begin with".into());
    }
    let (key, value) = line.split_once('=')?;
    let (key, value) = (key.trim(), value.trim());
    if !key.is_ascii() && !key.starts_with(['"', '\'']) {
        return Some("names are made of the letters a-z and A-Z, digits and '_': 'omega_0' for a Greek letter".into());
    }
    of_value(key, value)
}

/// `margin(G)`.
fn is_call(statement: &str) -> bool {
    let name = statement.split('(').next().unwrap_or_default();
    let is_name = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    is_name && statement.len() > name.len() && statement.ends_with(')')
}

fn of_value(key: &str, value: &str) -> Option<String> {
    let key = shorten(key);
    if value.starts_with(['"', '\'']) {
        let quote = value.chars().next()?;
        let is_closed = value.len() > 1 && value[1..].contains(quote);
        return (!is_closed).then(|| "a string ends with the quote that it begins with, in the same line".into());
    }
    if has_decimal_comma(value) {
        return Some("the decimal point is '.'".into());
    }
    if value.starts_with(['[', '{']) {
        let inner = value.chars().any(|c| c.is_ascii_alphabetic() || "*/^(".contains(c));
        return inner.then(|| "expressions go in quotes, numbers need none: [[0, 1], [\"-k\", -2]]".into());
    }
    let value = value.split('#').next().unwrap_or_default().trim();
    if value.is_empty() {
        return Some(format!("give a value: {key} = 1"));
    }
    let number = value.chars().take_while(|c| c.is_ascii_digit() || "+-.eE".contains(*c)).count();
    let rest = value[number..].trim_start();
    if number > 0 && !rest.is_empty() && rest.chars().all(|c| c.is_alphabetic() || c == '%' || c == '/') {
        return Some(format!(
            "a number has no unit: {key} = {}; a parameter may have one: unit = \"{rest}\"",
            value[..number].trim()
        ));
    }
    if value.contains(['\u{b7}', '\u{d7}']) {
        return Some("powers of ten are written 1e-4".into());
    }
    let is_word = value.chars().all(|c| c.is_ascii_alphabetic());
    let shown = shorten(value);
    (is_word || value.contains(['+', '-', '*', '/', '^', '(', '.']))
        .then(|| format!("words and expressions go in quotes: {key} = \"{shown}\""))
}

/// `2,5` where it is not an element of a list of its own.
fn has_decimal_comma(value: &str) -> bool {
    let bytes = value.as_bytes();
    let comma = |i: &usize| {
        bytes[*i] == b',' && *i > 0 && bytes[i - 1].is_ascii_digit() && bytes.get(i + 1).is_some_and(u8::is_ascii_digit)
    };
    (0..bytes.len()).any(|i| comma(&i)) && !value.starts_with('[')
}

#[cfg(test)]
mod tests {
    use super::hint;

    #[test]
    fn what_is_no_toml_has_a_remedy() {
        for (line, remedy) in [
            ("T = 0.0001 s", "a number has no unit: T = 0.0001; a parameter may have one: unit = \"s\""),
            ("Kp = { nominal = 2,5, min = 0 }", "the decimal point is '.'"),
            ("transfer = 0.1/(z-0.9)", "words and expressions go in quotes: transfer = \"0.1/(z-0.9)\""),
            ("time = discrete", "words and expressions go in quotes: time = \"discrete\""),
            ("T = 1\u{b7}10^-4", "powers of ten are written 1e-4"),
            ("% my model", "comments begin with '#'"),
            ("G = 1/(s^2 + 2*s + 1);", "this looks like MATLAB; 'jurist new' writes a model to begin with"),
            ("margin(G)", "this looks like MATLAB; 'jurist new' writes a model to begin with"),
            (
                "\u{3c9}_0 = 5",
                "names are made of the letters a-z and A-Z, digits and '_': 'omega_0' for a Greek letter",
            ),
            ("input = \u{201c}r - y\u{201d}", "write straight quotes: \"..\""),
            ("input = \"r - y", "a string ends with the quote that it begins with, in the same line"),
            ("matrix = [[0, 1], [-k, -2]]", "expressions go in quotes, numbers need none: [[0, 1], [\"-k\", -2]]"),
            ("K =", "give a value: K = 1"),
        ] {
            let text = format!("title = 't'\n{line}\nx = 1\n");
            assert_eq!(hint(&text, text.find(line).unwrap() + 2).as_deref(), Some(remedy), "{line}");
        }
        assert_eq!(hint("", 7), None);
        assert_eq!(hint("a = \"b\" c", 8), None);
    }
}
