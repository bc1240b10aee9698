//! Expected answers: their words, and whether an answer is the one expected.

use super::{Found, FoundEnd};
use crate::helpers::number::number;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};

/// Irrational ends are known to so many digits at least.
const LEAST_DIGITS: usize = 20;

/// What a question is answered with.
#[derive(Clone, Debug)]
pub enum Expected {
    /// Lower and upper ends.
    Stable(Vec<[ExpectedEnd; 2]>),
    Verdict {
        verdict: String,
        /// `2 inside, 1 on, 1 outside, 1 infinite`; what is not said is zero. `None` does not say.
        roots: Option<String>,
    },
}

/// An end in words: see `tests/corpus/README.md`.
#[derive(Clone, Debug)]
pub enum ExpectedEnd {
    Infinite,
    Finite {
        value: ExpectedValue,
        causes: String,
        /// Digits and unit.
        frequency: Option<(String, String)>,
    },
}

#[derive(Clone, Debug)]
pub enum ExpectedValue {
    Exact(Rational),
    /// The first digits of an irrational number, and a polynomial that it is a root of.
    Root {
        digits: String,
        polynomial: Option<UniPoly>,
    },
}

impl ExpectedEnd {
    /// Reads an end; `infinite` is the word for no end on this side.
    pub fn read(case: &str, text: &str, infinite: &str) -> ExpectedEnd {
        if text == infinite {
            return ExpectedEnd::Infinite;
        }
        let (value, rest) = text.split_once(": ").unwrap_or_else(|| panic!("{case}: no causes in '{text}'"));
        let (causes, frequency) = match rest.split_once(" at ") {
            None => (rest, None),
            Some((causes, frequency)) => {
                let (digits, unit) = frequency.split_once(' ').unwrap_or_else(|| panic!("{case}: no unit in '{text}'"));
                (causes, Some((digits.to_owned(), unit.to_owned())))
            }
        };
        let value = match value.split_once("near ") {
            None => ExpectedValue::Exact(number(value)),
            Some((root, digits)) => {
                let known = digits.bytes().skip_while(|b| b"-0.".contains(b)).filter(u8::is_ascii_digit).count();
                assert!(known >= LEAST_DIGITS, "{case}: only {known} digits of '{text}'");
                let coefficients =
                    root.strip_prefix("root ").map(|c| c.trim_end().split(' ').map(|c| number(c).numerator()));
                assert!(coefficients.is_some() || root.is_empty(), "{case}: '{root}' of '{text}' is not understood");
                let polynomial = coefficients.map(|c| UniPoly::new(c.collect()));
                ExpectedValue::Root { digits: digits.to_owned(), polynomial }
            }
        };
        ExpectedEnd::Finite { value, causes: causes.to_owned(), frequency }
    }
}

/// The numbers that begin with these digits: between them and one unit in the last place further from zero.
fn numbers_with(digits: &str) -> [Rational; 2] {
    let places = digits.split_once('.').map_or(0, |(_, places)| places.len()) as u64;
    let unit = Rational::new(Integer::ONE, Integer::from(10).pow(places));
    let value = number(digits);
    if digits.starts_with('-') { [&value - &unit, value] } else { [value.clone(), &value + &unit] }
}

fn overlap(a: &[Rational; 2], b: &[Rational; 2]) -> bool {
    a[0] <= b[1] && b[0] <= a[1]
}

fn difference(what: &str, expected: impl std::fmt::Debug, found: impl std::fmt::Debug) -> Result<(), String> {
    Err(format!("{what}: expected {expected:?}, found {found:?}"))
}

impl Expected {
    /// # Errors
    /// The first difference between the answer and the one expected.
    pub fn compare(&self, found: &Found) -> Result<(), String> {
        match (self, found) {
            (Expected::Stable(expected), Found::Stable(found)) => {
                if expected.len() != found.len() {
                    return difference("number of intervals", expected.len(), found);
                }
                for (i, (expected, found)) in expected.iter().zip(found).enumerate() {
                    for (side, (expected, found)) in ["lower", "upper"].iter().zip(expected.iter().zip(found)) {
                        expected
                            .compare(found.as_ref())
                            .map_err(|e| format!("{side} end of interval {}: {e}", i + 1))?;
                    }
                }
                Ok(())
            }
            (Expected::Verdict { verdict, roots }, Found::Verdict { verdict: given, roots: counted }) => {
                let names = ["inside", "on", "outside", "infinite"];
                let shown = counted.iter().zip(names).filter(|(n, _)| **n > 0).map(|(n, name)| format!("{n} {name}"));
                let shown = shown.collect::<Vec<_>>().join(", ");
                if verdict != given {
                    difference("verdict", verdict, given)
                } else if roots.as_ref().is_some_and(|roots| *roots != shown) {
                    difference("roots", roots, shown)
                } else {
                    Ok(())
                }
            }
            _ => difference("kind of answer", self, found),
        }
    }
}

impl ExpectedEnd {
    fn compare(&self, found: Option<&FoundEnd>) -> Result<(), String> {
        let (value, causes, frequency, found) = match (self, found) {
            (ExpectedEnd::Infinite, None) => return Ok(()),
            (ExpectedEnd::Finite { value, causes, frequency }, Some(end)) => (value, causes, frequency, end),
            _ => return difference("end", self, found),
        };
        match value {
            ExpectedValue::Exact(value) if found.exact.as_ref() == Some(value) => {}
            ExpectedValue::Root { digits, polynomial } if found.exact.is_none() => {
                // The zero of the answer's polynomial that the enclosure isolates is the one with these digits.
                let place = numbers_with(digits);
                let changes = |p: &UniPoly| p.sign_at(&place[0]) != p.sign_at(&place[1]);
                let isolated = found.polynomial.is_zero() || changes(&found.polynomial);
                if !overlap(&place, &found.enclosure) || !isolated {
                    return difference("value", digits, found);
                }
                if polynomial.as_ref().is_some_and(|p| !changes(&p.gcd(&found.polynomial))) {
                    return difference("polynomial", polynomial, found);
                }
            }
            _ => return difference("value", value, found),
        }
        if found.causes.as_ref().is_some_and(|given| given != causes) {
            return difference("causes", causes, &found.causes);
        }
        if let (Some((digits, unit)), Some(given)) = (frequency, &found.frequencies) {
            let of_unit = given.iter().find(|(name, _)| name == unit);
            if !of_unit.is_some_and(|(_, enclosure)| overlap(enclosure, &numbers_with(digits))) {
                return difference("frequency", frequency, given);
            }
        }
        Ok(())
    }
}
