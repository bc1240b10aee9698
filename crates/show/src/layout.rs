//! Aligned columns and short numbers in text for people.

use jurist_algebra::number::{BinaryFormat, Rational, parse_number, to_decimal};
use jurist_engine::model::Model;
use jurist_engine::model::is_blank_letter;
use std::borrow::Cow;
use std::fmt;

/// Digits up to which a number is written as a decimal rather than as a fraction.
const SHORT_DIGITS: usize = 15;

/// The same for numbers of binary floating point: those of single precision next to 1 have 24 to 28.
const BINARY_DIGITS: usize = 28;

/// Digits of a number or a fraction that are written out for people.
const WHOLE_DIGITS: usize = 60;

/// A smaller share is not told apart from others, in percent.
const LEAST_PERCENT: (i64, i64) = (1, 10_000);

/// A share in percent with so many digits; what is too small to matter has a bound.
///
/// ```
/// use jurist_show::layout::percent;
/// assert_eq!(percent(&"1/3".parse()?, 3), "33.3 %");
/// assert_eq!(percent(&"2e-19".parse()?, 3), "below 0.0001 %");
/// # Ok::<(), jurist_algebra::number::ParseNumberError>(())
/// ```
pub fn percent(share: &Rational, digits: usize) -> String {
    let (least, percent) =
        (Rational::new(LEAST_PERCENT.0.into(), LEAST_PERCENT.1.into()), share * &Rational::from(100));
    match percent.sign().is_gt() && percent < least {
        true => format!("below {} %", to_decimal(&least, 1)),
        false => format!("{} %", to_decimal(&percent, digits)),
    }
}

/// Text of a model (titles, units, descriptions) on one line, with every character that would move the cursor, colour
/// the terminal or turn the direction of writing shown by its escape: nothing of a model can pass for an answer, and
/// XML and HTML, where such characters are illegal, stay readable. JSON keeps the exact text.
///
/// ```
/// use jurist_show::layout::visible;
/// assert_eq!(visible("K_pwm in V"), "K_pwm in V");
/// assert_eq!(visible("loop\n\u{1b}[1Astable"), "loop\\n\\u{1b}[1Astable");
/// ```
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unseen) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            _ if !is_unseen(c) => out.push(c),
            '\n' | '\t' | '\r' => out.extend(c.escape_default()),
            _ => out.extend(c.escape_unicode()),
        }
    }
    Cow::Owned(out)
}

/// The headline of an answer: the loop, its kind of time, and by what its continuous blocks are made discrete.
pub fn headline(model: &Model) -> String {
    let line = format!("{}, {} time", called(model.title()), model.time().name());
    match model.rules() {
        rules if rules.is_empty() => line,
        rules => format!("{line}, {}", visible(&rules)),
    }
}

/// What a loop is called in text for people: its title, made [`visible`].
pub fn called(title: Option<&str>) -> Cow<'_, str> {
    visible(title.unwrap_or("the loop"))
}

/// Whether a character does something else than being seen: controls, other ends of lines, marks of direction.
pub(crate) fn is_unseen(c: char) -> bool {
    let is_mark = |c: char| matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}');
    c.is_control() || is_mark(c) || is_blank_letter(c)
}

/// The number as a short decimal if it is one, else as a fraction; a very long one with its first digits only.
pub fn short(value: &Rational) -> String {
    let decimal = to_decimal(value, SHORT_DIGITS);
    if parse_number(&decimal).as_ref() == Ok(value) {
        return decimal;
    }
    if let Some(name) = of_floating_point(value) {
        return name;
    }
    // A number of binary floating point says more as a decimal.
    let below = value.denominator();
    if below.trailing_zeros().is_some_and(|bits| bits + 1 == below.bit_length()) {
        let whole = to_decimal(value, BINARY_DIGITS);
        if parse_number(&whole).as_ref() == Ok(value) {
            return whole;
        }
    }
    match fraction(value) {
        Ok(whole) => whole,
        Err(size) => format!("{decimal}... ({size})"),
    }
}

/// `0.1 as float32`: the decimal that a compiler rounds to this number, where it is short enough to be what was written.
fn of_floating_point(value: &Rational) -> Option<String> {
    let formats = [(BinaryFormat::Single, 6, "float32"), (BinaryFormat::Double, 14, "float64")];
    formats.into_iter().find_map(|(format, digits, name)| {
        let written = parse_number(&to_decimal(value, digits)).ok()?;
        let is_nearest = format.nearest(&written).is_some_and(|nearest| nearest == *value);
        // It is written as short as it may be.
        let least =
            (1..digits).find(|&d| parse_number(&to_decimal(value, d)).as_ref() == Ok(&written)).unwrap_or(digits);
        is_nearest.then(|| format!("{} as {name}", to_decimal(value, least)))
    })
}

/// The exact fraction, or how many digits it has where these are too many to read.
pub fn fraction(value: &Rational) -> Result<String, String> {
    let (above, below) = (value.numerator().abs().to_string().len(), value.denominator().to_string().len());
    if above + below <= WHOLE_DIGITS {
        Ok(value.to_string())
    } else if value.is_integer() {
        Err(format!("a number of {above} digits"))
    } else {
        Err(format!("a fraction of {above} over {below} digits"))
    }
}

/// `K = 110, T = 0.0001`.
pub fn named_values(values: &[(String, Rational)]) -> String {
    let list: Vec<String> = values.iter().map(|(name, value)| format!("{name} = {}", short(value))).collect();
    list.join(", ")
}

/// Rows of cells that are printed in columns, left-aligned.
#[derive(Clone, Debug)]
pub struct Columns {
    indent: String,
    rows: Vec<Vec<String>>,
}

impl Columns {
    /// No rows yet; each will begin with `indent`.
    pub fn new(indent: &str) -> Self {
        Columns { indent: indent.to_owned(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |k: usize| self.rows.iter().filter_map(|r| r.get(k)).map(|c| c.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..count).map(width).collect();
        for row in &self.rows {
            let mut line = self.indent.clone();
            for (cell, width) in row.iter().zip(&widths) {
                if *width > 0 {
                    // Not by a format's width, which has an upper limit.
                    line.push_str(cell);
                    line.extend(std::iter::repeat_n(' ', width - cell.chars().count() + 3));
                }
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// The text in lines of at most `width` characters, broken at blanks; later lines begin with `indent`.
pub fn wrapped(text: &str, width: usize, indent: &str) -> String {
    let mut out = String::new();
    let mut column = 0;
    for word in text.split(' ') {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > width {
            out.push('\n');
            out.push_str(indent);
            column = indent.chars().count();
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += length;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Document, Text};
    use jurist_engine::problem::Ask;

    #[test]
    fn columns_are_aligned() {
        let mut columns = Columns::new("  ");
        columns.row(["a", "", "x"].map(String::from));
        columns.row(["long", "", "y"].map(String::from));
        assert_eq!(columns.to_string(), "  a      x\n  long   y\n");
    }

    #[test]
    fn short_numbers() {
        assert_eq!(short(&parse_number("1e-4").unwrap()), "0.0001");
        assert_eq!(short(&parse_number("1/3").unwrap()), "1/3");
        let long = format!("{}/7", "1".repeat(500));
        assert_eq!(short(&parse_number(&long).unwrap()), "1.58730158730159e498... (a fraction of 500 over 1 digits)");
        assert_eq!(fraction(&parse_number("-1e99").unwrap()), Err("a number of 100 digits".into()));
    }

    #[test]
    fn wrapping() {
        assert_eq!(wrapped("aa bb cc dd", 5, " "), "aa bb\n cc\n dd");
    }

    #[test]
    fn what_is_not_seen_is_shown_by_its_escape() {
        assert_eq!(visible("ω_ref in rad/s, 20 °C"), "ω_ref in rad/s, 20 °C");
        assert_eq!(visible("a\r\n\tb"), "a\\r\\n\\tb");
        assert_eq!(visible("\u{1b}[2J\u{7f}\u{9b}\u{0}"), "\\u{1b}[2J\\u{7f}\\u{9b}\\u{0}");
        assert_eq!(visible("\u{202e}elbats\u{2028}\u{feff}"), "\\u{202e}elbats\\u{2028}\\u{feff}");
    }

    #[test]
    fn no_title_or_unit_passes_for_an_answer() {
        use jurist_algebra::limits::Budget;
        let text = "title = \"loop\\n\\u001b[1Astable for all K\\n\"\ntime = 'discrete'\n[parameters]\n\
            K = { nominal = 1, unit = \"V\\nstable\\u009b\" }\n[loop]\ncharacteristic = 'z - K'\n";
        let (model, _) =
            jurist_engine::model::Model::from_toml(&jurist_engine::error::Source::new("m.toml", text)).unwrap();
        let budget = Budget::unlimited();
        let one = model.ask().free("K").stable_set(&budget).unwrap();
        let texts = [
            one.text(12),
            model.ask().verdict(&budget).unwrap().text(12),
            model.ask().analyze(&budget).unwrap().text(12),
        ];
        for text in texts {
            assert!(text.starts_with("loop\\n\\u{1b}[1Astable for all K\\n, discrete time"), "{text}");
            assert!(!text.contains(|c: char| is_unseen(c) && c != '\n'), "{text}");
            assert!(!text.lines().any(|line| line.starts_with("stable")), "{text}");
        }
        let exact = crate::documents::to_text(&one.json(12));
        assert!(exact.contains("loop\\n\\u001b[1Astable for all K\\n"), "{exact}");
    }
}
