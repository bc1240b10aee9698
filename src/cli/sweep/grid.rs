//! `--over NAME=LO..HI:N` and `--over NAME=V1,V2,...`: exact values, and all their combinations.

use super::key::Point;
use crate::cli::assignments::in_line;
use crate::cli::command_line::CommandLine;
use crate::cli::status::Error;
use jurist_algebra::number::{Rational, evenly_spaced, parse_number};
use jurist_engine::error::{Code, Diagnostic, Span};

/// More questions than this are refused: they would not fit into the memory.
const MOST: usize = 10_000_000;

/// A name and the values it takes.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Axis {
    pub name: String,
    pub values: Vec<Rational>,
    /// Where the name stands in the command line's text.
    pub name_span: Span,
}

/// Reads one value of `--over`.
pub(in crate::cli) fn axis(line: &CommandLine, text: &str) -> Result<Axis, Error> {
    let place = line.option_value("--over", text);
    let wrong = |start: usize, what: &str| -> Error {
        let error = Diagnostic::error(Code::OptionValue, "--over expects NAME=LO..HI:N or NAME=V1,V2,...");
        let error = error.at(place.part(start, text.len()), what).help("for example --over T=1e-5..1e-3:200");
        in_line(line, vec![error]).into()
    };
    let Some((name, given)) = text.split_once('=') else { return Err(wrong(0, "there is no '='")) };
    let start = name.len() + 1;
    let number = |part: &str| {
        parse_number(part.trim()).map_err(|e| {
            let from = start + part.as_ptr() as usize - given.as_ptr() as usize;
            let error = Diagnostic::error(Code::Number, format!("'{}' is not a number: {e}", part.trim()));
            Error::from(in_line(line, vec![error.at(place.part(from, from + part.len()), "")]))
        })
    };
    let values = match given.split_once("..") {
        None => given.split(',').map(number).collect::<Result<_, _>>()?,
        Some((low, rest)) => {
            let Some((high, count)) = rest.rsplit_once(':') else { return Err(wrong(start, "there is no ':N'")) };
            let Some(count) = count.trim().parse().ok().filter(|n| (2..=MOST).contains(n)) else {
                return Err(wrong(start, "N is a number of values, at least 2"));
            };
            evenly_spaced(&number(low)?, &number(high)?, count)
        }
    };
    Ok(Axis { name: name.trim().to_owned(), values, name_span: place.part(0, name.len()) })
}

/// All combinations, each with the values that are the same everywhere; `None` where they are too many.
pub(in crate::cli) fn points(axes: &[Axis], fixed: &Point) -> Option<Vec<Point>> {
    let count = axes.iter().try_fold(1usize, |n, axis| n.checked_mul(axis.values.len()))?;
    if count > MOST {
        return None;
    }
    let mut out = vec![fixed.clone()];
    for axis in axes {
        let with = |point: &Point, value: &Rational| {
            let mut point = point.clone();
            point.push((axis.name.clone(), value.clone()));
            point
        };
        out = out.iter().flat_map(|point| axis.values.iter().map(move |value| with(point, value))).collect();
    }
    for point in &mut out {
        point.sort_by(|a, b| a.0.cmp(&b.0));
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    fn read(text: &str) -> Result<Axis, Error> {
        axis(&CommandLine::new(["jurist", "sweep", "--over", text].map(OsString::from)), text)
    }

    fn shown(text: &str) -> String {
        let values: Vec<String> = read(text).unwrap().values.iter().map(ToString::to_string).collect();
        values.join(" ")
    }

    #[test]
    fn values_are_exact() {
        assert_eq!(shown("T=0..1:4"), "0 1/3 2/3 1");
        assert_eq!(shown("T=1e-4, 1/3,2"), "1/10000 1/3 2");
        assert_eq!(shown("T=-1..-2:2"), "-1 -2");
    }

    #[test]
    fn mistakes_are_refused() {
        for (text, code) in [
            ("T", Code::OptionValue),
            ("T=1..2", Code::OptionValue),
            ("T=1..2:1", Code::OptionValue),
            ("T=1..x:3", Code::Number),
            ("T=1,,2", Code::Number),
        ] {
            let Err(Error::Refused(error)) = read(text) else { panic!("{text}") };
            assert_eq!(error.code(), code, "{text}");
        }
    }

    #[test]
    fn all_combinations_sorted_by_name() {
        let axes = [read("b=1,2").unwrap(), read("a=3,4").unwrap()];
        let all = points(&axes, &vec![("c".into(), Rational::from(5))]).unwrap();
        let text = |p: &Point| p.iter().map(|(n, v)| format!("{n}{v}")).collect::<String>();
        assert_eq!(all.iter().map(text).collect::<Vec<_>>(), ["a3b1c5", "a4b1c5", "a3b2c5", "a4b2c5"]);
    }
}
