//! The roots of a closed loop for people.

use super::intervals::heading;
use super::layout::Columns;
use crate::Text;
use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal, to_decimal, to_scientific};
use jurist_engine::answer::{Answer, BeyondRoots, ClosedLoopRoot, Roots};
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;
use std::cmp::Ordering;

/// Bits beyond those of the digits.
const SPARE_BITS: u64 = 64;

/// Bits for what is computed of a root of so many digits.
pub(super) fn bits_of(digits: usize) -> u64 {
    super::real::bits_for(digits) + SPARE_BITS
}

/// The decimal of as many of these digits as are certain; 0 of a number that may be 0.
pub(super) fn certain_digits(x: &Enclosure, digits: usize) -> String {
    let certain = (1..=digits).rev().find_map(|digits| enclosed_decimal(x.lower(), x.upper(), digits));
    certain.unwrap_or_else(|| "0".to_owned())
}

/// The same with a bound of a number that may be 0.
fn certain(x: &Enclosure, digits: usize) -> String {
    let decimal = certain_digits(x, digits);
    if decimal != "0" {
        return decimal;
    }
    let most = x.lower().abs().max(x.upper().abs());
    if most.is_zero() { "0".to_owned() } else { format!("0 (within {})", to_scientific(&(&most + &most), 1)) }
}

/// `1 - 2 j`; a real number alone.
fn with_imaginary(real: String, imaginary: &str) -> String {
    match imaginary.strip_prefix('-') {
        _ if imaginary == "0" => real,
        Some(size) => format!("{real} - {size} j"),
        None => format!("{real} + {imaginary} j"),
    }
}

impl Text for ClosedLoopRoot {
    /// `0.5`, `-1 +- 2 j`, `-1 (2 times)`, `3 roots within 1e-9 of 0.5`.
    fn text(&self, digits: usize) -> String {
        let disc = &self.disc;
        if !disc.is_one {
            let centre = [&disc.re, &disc.im].map(|x| certain(&Enclosure::from_rational(x.clone()), digits.min(6)));
            let place = match disc.is_pair {
                true => format!("{} +- {} j", centre[0], centre[1]),
                false => with_imaginary(centre[0].clone(), &centre[1]),
            };
            let each = if disc.is_pair { " each" } else { "" };
            return format!(
                "{} roots{each} within {} of {place}",
                disc.count,
                to_scientific(&(&disc.radius + &disc.radius), 1)
            );
        }
        let real = certain(&self.real(), digits);
        let text = match disc.is_pair {
            true => format!("{real} +- {} j", certain(&self.imaginary(), digits)),
            false => with_imaginary(real, &certain(&self.imaginary(), digits)),
        };
        if disc.count > 1 { format!("{text} ({} times)", disc.count) } else { text }
    }
}

impl Text for Answer<Roots> {
    /// The roots for people, one or a pair a line.
    fn text(&self, digits: usize) -> String {
        let (problem, roots) = (self.problem(), self.value());
        let mut out = format!("{}\n", heading(problem));
        out.push_str(&match &roots.beyond {
            Some(beyond) => rightmost(roots, beyond),
            None => number_of(roots),
        });
        let mut columns = Columns::new("    ");
        columns.row(titles(problem));
        for root in &roots.list {
            columns.row(cells(root, problem.time(), digits));
        }
        if !roots.list.is_empty() {
            out.push_str(&columns.to_string());
        }
        if let Some(beyond) = &roots.beyond {
            out.push_str(&others(roots.list.is_empty(), beyond));
        }
        out
    }
}

/// How many roots there are.
fn number_of(roots: &Roots) -> String {
    let infinite = match roots.infinite {
        0 => String::new(),
        n => format!(", {n} of them at infinity"),
    };
    match roots.degree {
        0 => "the characteristic polynomial is a constant: no roots\n".to_owned(),
        1 => format!("1 root{infinite}\n"),
        n => format!("{n} roots{infinite}, the slowest first\n"),
    }
}

/// How many of infinitely many roots are listed.
fn rightmost(roots: &Roots, beyond: &BeyondRoots) -> String {
    let (wanted, listed) = (beyond.wanted, roots.list.len());
    let why = match listed.cmp(&wanted) {
        Ordering::Equal => String::new(),
        Ordering::Greater => format!(" ({wanted} were asked for; the next ones have nearly the same real part)"),
        Ordering::Less => format!(" ({wanted} were asked for: nearer to the line below roots are not counted)"),
    };
    match listed {
        0 => format!("infinitely many roots{why}\n"),
        1 => format!("infinitely many roots, the rightmost{why}\n"),
        n if roots.list.iter().any(|root| root.disc.is_pair) => {
            format!("infinitely many roots, the {n} rightmost{why}; a pair counts as one\n")
        }
        n => format!("infinitely many roots, the {n} rightmost{why}\n"),
    }
}

/// Where the roots are that are not listed.
fn others(none: bool, beyond: &BeyondRoots) -> String {
    let line = to_decimal(&beyond.others_left_of, MOST_DIGITS_OF_LINE);
    let other = if none { "no root" } else { "no other root" };
    let mut out = format!("{other} lies right of Re s = {line}\n");
    if let Some(chain) = &beyond.chain {
        let place = certain(chain, DERIVED_DIGITS);
        out.push_str(&format!(
            "neutral type: infinitely many roots come as near as one likes to the line Re s = {place}\n"
        ));
    }
    out
}

fn titles(problem: &Problem) -> Vec<String> {
    let mut titles = vec!["root".to_owned()];
    if problem.time() == Time::Discrete {
        titles.push("|z|".to_owned());
    }
    titles.extend(["damping", "natural frequency"].map(str::to_owned));
    titles
}

/// The line is a decimal number with fewer digits.
const MOST_DIGITS_OF_LINE: usize = 60;

/// Digits of what is computed of a root.
const DERIVED_DIGITS: usize = 7;

fn cells(root: &ClosedLoopRoot, time: Time, digits: usize) -> Vec<String> {
    let bits = bits_of(digits);
    let derived = digits.min(DERIVED_DIGITS);
    let mut cells = vec![root.text(digits)];
    if time == Time::Discrete {
        cells.push(certain(&root.magnitude(bits), derived));
    }
    cells.push(root.damping(bits).map_or_else(|| "-".to_owned(), |damping| certain(&damping, derived)));
    cells.push(root.natural_frequency(bits).map_or_else(
        || "-".to_owned(),
        |rate| match hertz(&rate, bits) {
            Some(hertz) => format!("{} rad/s, {} Hz", certain(&rate, derived), certain(&hertz, derived)),
            None => format!("{} rad/s", certain(&rate, derived)),
        },
    ));
    cells
}

/// Radians per second in hertz.
pub(super) fn hertz(rate: &Enclosure, bits: u64) -> Option<Enclosure> {
    rate.div(&Enclosure::pi(bits).mul(&Enclosure::from_rational(Rational::from(2)), bits), bits)
}
