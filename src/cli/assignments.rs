//! `NAME=VALUE` and `NAME=LO..HI` on the command line.

use super::command_line::{CommandLine, Place};
use jurist_algebra::number::{ParseNumberErrorKind, Rational, parse_number};
use jurist_engine::answer::SliceValues;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Span};
use std::sync::Arc;

/// A name with its value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Assignment {
    pub name: String,
    pub value: Rational,
    /// Where the name stands in the command line's text.
    pub name_span: Span,
}

/// A name with its domain, which is open.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DomainChange {
    pub name: String,
    pub lower: Option<Rational>,
    pub upper: Option<Rational>,
    /// Where the name stands in the command line's text.
    pub name_span: Span,
}

/// Reads all values of an option such as `--set`; every mistake is reported.
pub(super) fn assignments(line: &CommandLine, option: &str, values: &[String]) -> Result<Vec<Assignment>, Diagnostics> {
    let mut out: Vec<Assignment> = Vec::new();
    let mut wrong = Vec::new();
    for text in values {
        let place = line.option_value(option, text);
        let read = split_name(text, place, option, "VALUE").and_then(|(name, value)| {
            let value = number(text, value, place)?;
            Ok(Assignment { name: name.to_owned(), value, name_span: place.part(0, text.find('=').unwrap_or(0)) })
        });
        match read {
            Err(d) => wrong.push(d),
            Ok(new) => match out.iter().find(|old| old.name == new.name) {
                Some(old) if old.value != new.value => wrong.push(
                    Diagnostic::error(Code::SetTwice, format!("'{}' is set to two values", new.name))
                        .at(new.name_span, "a second value")
                        .also(old.name_span, "the first value"),
                ),
                Some(_) => {}
                None => out.push(new),
            },
        }
    }
    refuse(line, wrong).map(|()| out)
}

/// Reads all values of `--domain`; every mistake is reported.
pub(super) fn domains(line: &CommandLine, values: &[String]) -> Result<Vec<DomainChange>, Diagnostics> {
    let mut out: Vec<DomainChange> = Vec::new();
    let mut wrong = Vec::new();
    for text in values {
        let place = line.option_value("--domain", text);
        match domain(text, place) {
            Err(d) => wrong.push(d),
            Ok(new) => match out.iter().find(|old| old.name == new.name) {
                Some(old) => wrong.push(
                    Diagnostic::error(Code::SetTwice, format!("'{}' is given two domains", new.name))
                        .at(new.name_span, "a second domain")
                        .also(old.name_span, "the first domain"),
                ),
                None => out.push(new),
            },
        }
    }
    refuse(line, wrong).map(|()| out)
}

/// A parameter on an axis of a picture, with the ends of the window that are given.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AxisRequest {
    pub name: String,
    pub lower: Option<Rational>,
    pub upper: Option<Rational>,
    /// Where the name stands in the command line's text.
    pub name_span: Span,
}

/// Reads `NAME` or `NAME=LO..HI`; an end that is left out or infinite is chosen later.
pub(super) fn axis(line: &CommandLine, option: &str, text: &str) -> Result<AxisRequest, Diagnostics> {
    let place = line.option_value(option, text);
    let Some(equals) = text.find('=') else {
        return Ok(AxisRequest { name: text.trim().to_owned(), lower: None, upper: None, name_span: place.span });
    };
    let read = range(text, place, option).and_then(|(name, lower, upper)| match (&lower, &upper) {
        (Some(l), Some(u)) if l >= u => Err(Diagnostic::error(Code::OptionValue, empty(option))
            .at(place.part(equals + 1, text.len()), "the lower end is not below the upper end")),
        _ => Ok(AxisRequest { name, lower, upper, name_span: place.part(0, equals) }),
    });
    read.map_err(|d| in_line(line, vec![d]))
}

fn empty(option: &str) -> &'static str {
    if option == "--for-all" { "the range needs a lower end and a greater one" } else { "the window is empty" }
}

/// Slices along a third axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SlicesRequest {
    pub values: SliceValues,
    /// Where the name stands in the command line's text.
    pub name_span: Span,
    /// Where the range and the number of slices stand.
    pub range_span: Span,
}

/// Reads `NAME=LO..HI:N`, both ends included.
pub(super) fn slices(line: &CommandLine, option: &str, text: &str) -> Result<SlicesRequest, Diagnostics> {
    let place = line.option_value(option, text);
    let start = text.find('=').map_or(0, |i| i + 1);
    let expects = |from: usize, what: &str| {
        Diagnostic::error(Code::OptionValue, format!("{option} expects NAME=LO..HI:N"))
            .at(place.part(from, text.len()), what)
            .help(format!("for example {option} K=0..10:11, for 11 slices, both ends included"))
    };
    let read = || {
        if start == 0 {
            return Err(expects(0, "there is no '='"));
        }
        let colon = text.rfind(':').filter(|&i| i >= start).ok_or_else(|| expects(start, "there is no ':N'"))?;
        let count = text[colon + 1..].trim().parse().map_err(|_| expects(colon + 1, "not a number of slices"))?;
        let (name, lower, upper) = range(&text[..colon], place, option).map_err(|d| match d.code {
            Code::OptionValue => expects(start, "there is no '..'"),
            _ => d,
        })?;
        let (Some(lower), Some(upper)) = (lower, upper) else {
            return Err(expects(start, "both ends have to be numbers"));
        };
        let values = SliceValues::evenly(name, &lower, &upper, count).map_err(|d| {
            let (from, to, label) = match lower < upper {
                true => (colon + 1, text.len(), "the number of slices"),
                false => (start, colon, "the lower end is not below the upper end"),
            };
            d.at(place.part(from, to), label)
        })?;
        let name_span = place.part(0, start - 1);
        Ok(SlicesRequest { values, name_span, range_span: place.part(start, text.len()) })
    };
    read().map_err(|d| in_line(line, vec![d]))
}

/// Reads a plain number, such as that of `--radius`.
pub(super) fn plain_number(line: &CommandLine, option: &str, text: &str) -> Result<Rational, Diagnostics> {
    let place = line.option_value(option, text);
    number(text, 0, place).map_err(|d| in_line(line, vec![d]))
}

/// An error about the command line.
pub(super) fn in_line(line: &CommandLine, diagnostics: Vec<Diagnostic>) -> Diagnostics {
    Diagnostics::new(Some(Arc::clone(line.source())), diagnostics)
}

fn refuse(line: &CommandLine, wrong: Vec<Diagnostic>) -> Result<(), Diagnostics> {
    if wrong.is_empty() { Ok(()) } else { Err(in_line(line, wrong)) }
}

/// The name, and where the value begins.
fn split_name<'t>(text: &'t str, place: Place, option: &str, value: &str) -> Result<(&'t str, usize), Diagnostic> {
    let malformed = |span, label: &str| {
        Diagnostic::error(Code::OptionValue, format!("{option} expects NAME={value}"))
            .at(span, label)
            .help(format!("for example {option} {}", if value == "VALUE" { "K=1/3" } else { "K=0..10" }))
    };
    let Some(equals) = text.find('=') else { return Err(malformed(place.span, "there is no '='")) };
    let name = text[..equals].trim();
    if name.is_empty() {
        return Err(malformed(place.part(0, equals), "the name is missing"));
    }
    Ok((name, equals + 1))
}

/// The number that begins at `start` of an option's value.
fn number(text: &str, start: usize, place: Place) -> Result<Rational, Diagnostic> {
    number_between(text, start, text.len(), place)
}

fn number_between(text: &str, start: usize, end: usize, place: Place) -> Result<Rational, Diagnostic> {
    let value = &text[start..end];
    parse_number(value).map_err(|e| {
        let whole = place.part(start, end);
        let (span, label) = match e.kind {
            ParseNumberErrorKind::Empty => (whole, "a number is missing".to_owned()),
            ParseNumberErrorKind::UnexpectedCharacter => {
                let at = e.offset.min(value.len());
                let width = value[at..].chars().next().map_or(0, char::len_utf8);
                (place.part(start + at, start + at + width), "not part of a number".to_owned())
            }
            _ => (whole, e.to_string()),
        };
        let diagnostic = Diagnostic::error(Code::Number, "this is not a number").at(span, label);
        match e.kind {
            ParseNumberErrorKind::Empty | ParseNumberErrorKind::UnexpectedCharacter => {
                diagnostic.help("numbers look like 12, 0.046, 46e-3 or 1/3")
            }
            _ => diagnostic,
        }
    })
}

/// Reads `NAME=LO..HI` of an option, both ends included; either side left out or infinite.
pub(super) fn bound(
    line: &CommandLine,
    option: &str,
    text: &str,
) -> Result<(String, Option<Rational>, Option<Rational>), Diagnostics> {
    range(text, line.option_value(option, text), option).map_err(|d| in_line(line, vec![d]))
}

/// `NAME=LO..HI`, either side left out or infinite.
fn range(text: &str, place: Place, option: &str) -> Result<(String, Option<Rational>, Option<Rational>), Diagnostic> {
    let (name, start) = split_name(text, place, option, "LO..HI")?;
    let Some(dots) = text[start..].find("..").map(|i| start + i) else {
        return Err(Diagnostic::error(Code::OptionValue, format!("{option} expects NAME=LO..HI"))
            .at(place.part(start, text.len()), "there is no '..'")
            .help(match option {
                // Its range needs two ends.
                "--for-all" => format!("for example {option} K=0..10"),
                _ => format!("for example {option} K=0..10, {option} K=0.. or {option} K=..10"),
            }));
    };
    let side = |from: usize, to: usize, infinite: &[&str]| -> Result<Option<Rational>, Diagnostic> {
        let part = text[from..to].trim();
        if part.is_empty() || infinite.contains(&part) {
            return Ok(None);
        }
        number_between(text, from, to, place).map(Some)
    };
    let lower = side(start, dots, &["-inf"])?;
    let upper = side(dots + 2, text.len(), &["inf", "+inf"])?;
    Ok((name.to_owned(), lower, upper))
}

fn domain(text: &str, place: Place) -> Result<DomainChange, Diagnostic> {
    let (name, lower, upper) = range(text, place, "--domain")?;
    let start = text.find('=').map_or(0, |i| i + 1);
    if let (Some(l), Some(u)) = (&lower, &upper)
        && l >= u
    {
        let message = if l == u { "the domain is empty: it is open" } else { "the domain is empty" };
        return Err(Diagnostic::error(Code::EmptyDomain, message)
            .at(place.part(start, text.len()), "the lower end is not below the upper end"));
    }
    let name_span = place.part(0, text.find('=').unwrap_or(0));
    Ok(DomainChange { name, lower, upper, name_span })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    fn line(arguments: &[&str]) -> CommandLine {
        CommandLine::new(std::iter::once("jurist").chain(arguments.iter().copied()).map(OsString::from))
    }

    fn set(values: &[&str]) -> Result<Vec<Assignment>, Diagnostics> {
        let arguments: Vec<&str> = values.iter().flat_map(|v| ["--set", v]).collect();
        assignments(&line(&arguments), "--set", &values.iter().map(|v| (*v).to_owned()).collect::<Vec<_>>())
    }

    fn domain_of(value: &str) -> Result<DomainChange, Diagnostics> {
        domains(&line(&["--domain", value]), &[value.to_owned()]).map(|mut d| d.remove(0))
    }

    /// The text under the first caret.
    fn marked(error: &Diagnostics) -> String {
        let source = error.source_text().unwrap();
        let span = error.diagnostics()[0].primary.as_ref().unwrap().span;
        source.text[span.start..span.end].to_owned()
    }

    #[test]
    fn values_are_exact() {
        let read = set(&["K=1e-4", "T=1/3", "L=-0.5", "T=2/6"]).unwrap();
        let shown: Vec<String> = read.iter().map(|a| format!("{}={}", a.name, a.value)).collect();
        assert_eq!(shown, ["K=1/10000", "T=1/3", "L=-1/2"]);
    }

    #[test]
    fn mistakes_are_marked() {
        for (value, code, mark) in [
            ("K", Code::OptionValue, "K"),
            ("=1", Code::OptionValue, ""),
            ("K=", Code::Number, ""),
            ("K=1.x", Code::Number, "x"),
            ("K=1/0", Code::Number, "1/0"),
            ("K=1e999999999", Code::Number, "1e999999999"),
            ("K=ü", Code::Number, "ü"),
        ] {
            let error = set(&[value]).unwrap_err();
            assert_eq!((error.code(), marked(&error).as_str()), (code, mark), "{value}");
        }
        assert_eq!(set(&["K=1", "K=2", "x"]).unwrap_err().diagnostics().len(), 2);
    }

    #[test]
    fn slices_are_exact_and_their_mistakes_are_marked() {
        let read = |text: &str| slices(&line(&["-z", text]), "-z", text);
        let found = read("K=0..1:4").unwrap();
        let values: Vec<String> = found.values.values().iter().map(ToString::to_string).collect();
        assert_eq!((found.values.name(), values.join(" ")), ("K", "0 1/3 2/3 1".to_owned()));
        for (value, code, mark) in [
            ("K", Code::OptionValue, "K"),
            ("K=0..1", Code::OptionValue, "0..1"),
            ("K=0.1:3", Code::OptionValue, "0.1:3"),
            ("K=0..:3", Code::OptionValue, "0..:3"),
            ("K=0..inf:3", Code::OptionValue, "0..inf:3"),
            ("K=0..1:x", Code::OptionValue, "x"),
            ("K=0..1:", Code::OptionValue, ""),
            ("K=0..1:1", Code::OptionValue, "1"),
            ("K=0..1:101", Code::OptionValue, "101"),
            ("K=0..1:99999999999999999999999", Code::OptionValue, "99999999999999999999999"),
            ("K=1..0:3", Code::OptionValue, "1..0"),
            ("K=1..1:3", Code::OptionValue, "1..1"),
            ("K=a..1:3", Code::Number, "a"),
            ("=0..1:3", Code::OptionValue, "0..1:3"),
        ] {
            let error = read(value).unwrap_err();
            assert_eq!((error.code(), marked(&error).as_str()), (code, mark), "{value}");
        }
    }

    #[test]
    fn domains_are_open_on_either_side() {
        let shown = |value| {
            let d = domain_of(value).unwrap();
            (d.lower.map(|v| v.to_string()), d.upper.map(|v| v.to_string()))
        };
        assert_eq!(shown("K=0..1/2"), (Some("0".into()), Some("1/2".into())));
        assert_eq!(shown("K=.."), (None, None));
        assert_eq!(shown("K=-1.."), (Some("-1".into()), None));
        assert_eq!(shown("K=...5"), (None, Some("1/2".into())));
        for (value, code, mark) in [
            ("K=1", Code::OptionValue, "1"),
            ("K=2..1", Code::EmptyDomain, "2..1"),
            ("K=1..1", Code::EmptyDomain, "1..1"),
            ("K=a..1", Code::Number, "a"),
            ("K=1..b", Code::Number, "b"),
        ] {
            let error = domain_of(value).unwrap_err();
            assert_eq!((error.code(), marked(&error).as_str()), (code, mark), "{value}");
        }
    }
}
