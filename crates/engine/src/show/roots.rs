//! The roots of a closed loop for people.

use super::intervals::heading;
use super::layout::Columns;
use crate::answer::{Answer, ClosedLoopRoot, Roots};
use crate::model::Time;
use crate::problem::Problem;
use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal, to_scientific};

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

impl ClosedLoopRoot {
    /// `0.5`, `-1 +- 2 j`, `-1 (2 times)`, `3 roots within 1e-9 of 0.5`.
    pub fn text(&self, digits: usize) -> String {
        let disc = &self.disc;
        if !disc.is_one {
            let centre = [&disc.re, &disc.im].map(|x| certain(&Enclosure::from_rational(x.clone()), digits.min(6)));
            let place = if disc.is_pair { format!("{} +- {} j", centre[0], centre[1]) } else { centre[0].clone() };
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
            false => real,
        };
        if disc.count > 1 { format!("{text} ({} times)", disc.count) } else { text }
    }
}

impl Answer<Roots> {
    /// The roots for people, one or a pair a line.
    pub fn text(&self, digits: usize) -> String {
        let (problem, roots) = (self.problem(), self.value());
        let mut out = format!("{}\n", heading(problem));
        let infinite = match roots.infinite {
            0 => String::new(),
            n => format!(", {n} of them at infinity"),
        };
        out.push_str(&match roots.degree {
            0 => "the characteristic polynomial is a constant: no roots\n".to_owned(),
            1 => format!("1 root{infinite}\n"),
            n => format!("{n} roots{infinite}, the slowest first\n"),
        });
        let mut columns = Columns::new("    ");
        columns.row(titles(problem));
        for root in &roots.list {
            columns.row(cells(root, problem.time(), digits));
        }
        if !roots.list.is_empty() {
            out.push_str(&columns.to_string());
        }
        out
    }
}

fn titles(problem: &Problem) -> Vec<String> {
    let mut titles = vec!["root".to_owned()];
    if problem.time() == Time::Discrete {
        titles.push("|z|".to_owned());
    }
    titles.extend(["damping", "natural frequency"].map(str::to_owned));
    titles
}

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
