//! Numbers and formulas in names of coefficients, added and multiplied as text.

use jurist_algebra::number::Rational;
use std::fmt;

/// A number, or a formula.
///
/// ```
/// use jurist_ship::realise::Entry;
/// let [one, name] = [Entry::Number(1.into()), Entry::Formula("b0".into())];
/// assert_eq!(one.times(&name).plus(&one).to_string(), "b0 + 1");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// A number.
    Number(Rational),
    /// A formula, a sum of products.
    Formula(String),
}

impl Entry {
    /// Zero.
    pub const ZERO: Entry = Entry::Number(Rational::ZERO);

    /// The sum.
    pub fn plus(&self, other: &Entry) -> Entry {
        match (self, other) {
            (Entry::Number(a), Entry::Number(b)) => Entry::Number(a + b),
            (Entry::Number(zero), entry) | (entry, Entry::Number(zero)) if zero.is_zero() => entry.clone(),
            _ => Entry::Formula(format!("{self} + {other}")),
        }
    }

    /// The product.
    pub fn times(&self, other: &Entry) -> Entry {
        match (self, other) {
            (Entry::Number(a), Entry::Number(b)) => Entry::Number(a * b),
            (Entry::Number(c), entry) | (entry, Entry::Number(c)) if c.is_zero() || c.is_one() => {
                if c.is_zero() {
                    Entry::ZERO
                } else {
                    entry.clone()
                }
            }
            _ => Entry::Formula(format!("{}*{}", self.factor(), other.factor())),
        }
    }

    /// The entry as a factor.
    fn factor(&self) -> String {
        match self {
            Entry::Number(value) if value.is_integer() && !value.is_negative() => value.to_string(),
            Entry::Formula(text) if !text.contains(' ') => text.clone(),
            _ => format!("({self})"),
        }
    }

    /// The entry as a value in TOML.
    pub fn toml(&self) -> String {
        match self {
            Entry::Number(value) if value.is_integer() && value.numerator().bit_length() < 50 => value.to_string(),
            _ => format!("\"{self}\""),
        }
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Entry::Number(value) => write!(f, "{value}"),
            Entry::Formula(text) => f.write_str(text),
        }
    }
}

/// The product of polynomials, highest power first.
pub(super) fn product(a: &[Entry], b: &[Entry]) -> Vec<Entry> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut out = vec![Entry::ZERO; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] = out[i + j].plus(&x.times(y));
        }
    }
    out
}

/// The sum of polynomials, highest power first.
pub(super) fn sum(a: &[Entry], b: &[Entry]) -> Vec<Entry> {
    let length = a.len().max(b.len());
    let at = |p: &[Entry], k: usize| (k + p.len()).checked_sub(length).map_or(Entry::ZERO, |k| p[k].clone());
    (0..length).map(|k| at(a, k).plus(&at(b, k))).collect()
}
