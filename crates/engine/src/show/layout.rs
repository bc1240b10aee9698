//! Aligned columns and short numbers in text for people.

use jurist_algebra::number::{Rational, parse_number, to_decimal};
use std::fmt;

/// Digits up to which a number is written as a decimal rather than as a fraction.
const SHORT_DIGITS: usize = 15;

/// Digits of a number or a fraction that are written out for people.
const WHOLE_DIGITS: usize = 60;

/// The number as a short decimal if it is one, else as a fraction; a very long one with its first digits only.
pub fn short(value: &Rational) -> String {
    let decimal = to_decimal(value, SHORT_DIGITS);
    if parse_number(&decimal).as_ref() == Ok(value) {
        return decimal;
    }
    match fraction(value) {
        Ok(whole) => whole,
        Err(size) => format!("{decimal}... ({size})"),
    }
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
}
