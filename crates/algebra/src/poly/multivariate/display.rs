//! Text such as `3*K^2*T - 1`.

use super::{Monomial, MultiPoly};
use std::fmt;

/// A polynomial together with the names of its variables, ready to be formatted.
#[derive(Clone, Copy, Debug)]
pub struct DisplayMultiPoly<'a, S> {
    polynomial: &'a MultiPoly,
    names: &'a [S],
}

impl MultiPoly {
    /// Text such as `3*K^2*T - 1`: terms in descending order. Variables beyond the names are
    /// written `x_i`.
    pub fn display<'a, S: AsRef<str>>(&'a self, names: &'a [S]) -> DisplayMultiPoly<'a, S> {
        DisplayMultiPoly { polynomial: self, names }
    }
}

impl<S: AsRef<str>> fmt::Display for DisplayMultiPoly<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.polynomial.terms.is_empty() {
            return f.write_str("0");
        }
        for (k, (m, c)) in self.polynomial.terms.iter().enumerate() {
            match (k, c.is_negative()) {
                (0, true) => f.write_str("-")?,
                (0, false) => {}
                (_, true) => f.write_str(" - ")?,
                (_, false) => f.write_str(" + ")?,
            }
            let magnitude = c.abs();
            if m.is_one() {
                write!(f, "{magnitude}")?;
            } else if magnitude.is_one() {
                write_monomial(f, m, self.names)?;
            } else {
                write!(f, "{magnitude}*")?;
                write_monomial(f, m, self.names)?;
            }
        }
        Ok(())
    }
}

fn write_monomial<S: AsRef<str>>(f: &mut fmt::Formatter<'_>, m: &Monomial, names: &[S]) -> fmt::Result {
    let mut first = true;
    for (i, &e) in m.exponents().iter().enumerate().filter(|(_, e)| **e > 0) {
        if !first {
            f.write_str("*")?;
        }
        first = false;
        match names.get(i) {
            Some(name) => f.write_str(name.as_ref())?,
            None => write!(f, "x_{i}")?,
        }
        if e > 1 {
            write!(f, "^{e}")?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Integer;

    #[test]
    fn text() {
        let p = MultiPoly::from_terms([
            (vec![2, 1], Integer::from(-3)),
            (vec![0, 1], Integer::from(1)),
            (vec![], Integer::from(-12)),
        ]);
        assert_eq!(p.display(&["K", "T"]).to_string(), "-3*K^2*T + T - 12");
        assert_eq!(format!("{p:?}"), "-3*x_0^2*x_1 + x_1 - 12");
        assert_eq!(MultiPoly::default().display(&["K"]).to_string(), "0");
        assert_eq!(MultiPoly::from(1).display(&["K"]).to_string(), "1");
    }
}
