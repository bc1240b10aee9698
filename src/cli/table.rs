//! Tables of numbers: CSV, names in the head, values below.

use super::status::Error;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source, Span};
use jurist_engine::model::{Model, nearest_name};
use std::sync::Arc;

/// More rows are refused.
const MOST_ROWS: usize = 1_000_000;

/// Values by name.
pub(in crate::cli) type Point = Vec<(String, Rational)>;

/// A table of numbers.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Table {
    pub names: Vec<(String, Span)>,
    pub points: Vec<Point>,
    pub source: Arc<Source>,
}

impl Table {
    /// Reads a table: cells are parted by commas or semicolons, may be in double quotes, and are numbers as in a model. Empty lines and lines that
    /// begin with `#` are left out.
    pub fn read(source: &Arc<Source>) -> Result<Table, Error> {
        let text = source.text.strip_prefix('\u{feff}').unwrap_or(&source.text);
        let skipped = source.text.len() - text.len();
        let mut start = skipped;
        let mut names: Vec<(String, Span)> = Vec::new();
        let (mut points, mut errors) = (Vec::new(), Vec::new());
        // The head decides what parts cells.
        let head = text.lines().find(|line| !is_left_out(line));
        let comma = if head.is_some_and(|head| head.contains(';') && !head.contains(',')) { ';' } else { ',' };
        for line in text.split_inclusive('\n') {
            let at = start;
            start += line.len();
            let content = line.trim_end_matches(['\n', '\r']);
            if is_left_out(content) {
                continue;
            }
            let cells = cells(content, at, comma);
            if names.is_empty() {
                names = cells;
                for (i, (name, span)) in names.iter().enumerate() {
                    if names[..i].iter().any(|(other, _)| other == name) {
                        let error = Diagnostic::error(Code::SetTwice, format!("two columns are called '{name}'"));
                        errors.push(error.at(*span, "a second time"));
                    }
                }
                continue;
            }
            match point(&names, &cells, Span::new(at, at + content.len())) {
                Ok(point) => points.push(point),
                Err(error) => errors.push(error),
            }
            if points.len() > MOST_ROWS || errors.len() > 10 {
                break;
            }
        }
        if points.len() > MOST_ROWS {
            errors.push(Diagnostic::error(Code::TooLarge, format!("the table has more than {MOST_ROWS} rows")));
        }
        if points.is_empty() && errors.is_empty() {
            let error = Diagnostic::error(Code::Missing, "the table has no row of numbers");
            errors.push(error.help("a head with names, and below it rows of numbers"));
        }
        match errors.is_empty() {
            true => Ok(Table { names, points, source: Arc::clone(source) }),
            false => Err(Diagnostics::new(Some(Arc::clone(source)), errors).into()),
        }
    }

    /// The columns that the model does not have.
    pub fn check(&self, model: &Model) -> Result<(), Error> {
        let known = || {
            let constants = model.constants().iter().filter(|c| c.number.is_some()).map(|c| c.name.as_str());
            model.parameters().iter().map(|p| p.name.as_str()).chain(constants)
        };
        let unknown = self.names.iter().filter(|(name, _)| !known().any(|k| k == name));
        let errors: Vec<Diagnostic> = unknown
            .map(|(name, span)| {
                let message = format!("'{name}' is no parameter and no number of the model");
                let error = Diagnostic::error(Code::UnknownName, message).at(*span, "not known");
                match nearest_name(name, known()) {
                    Some(near) => error.help(format!("did you mean '{near}'?")),
                    None => error,
                }
            })
            .collect();
        if errors.is_empty() { Ok(()) } else { Err(Diagnostics::new(Some(Arc::clone(&self.source)), errors).into()) }
    }
}

/// Empty lines and comments.
fn is_left_out(line: &str) -> bool {
    line.trim().is_empty() || line.trim_start().starts_with('#')
}

/// The cells of a line, each with its place.
fn cells(line: &str, at: usize, comma: char) -> Vec<(String, Span)> {
    let mut out = Vec::new();
    let (mut start, mut quoted) = (0, false);
    let ends = line.char_indices().filter(|(_, c)| {
        quoted ^= *c == '"';
        *c == comma && !quoted
    });
    let ends: Vec<usize> = ends.map(|(i, _)| i).chain([line.len()]).collect();
    for end in ends {
        let cell = &line[start..end];
        let inner = cell.trim();
        let from = at + start + (cell.len() - cell.trim_start().len());
        let span = Span::new(from, from + inner.len());
        let text = inner.strip_prefix('"').and_then(|t| t.strip_suffix('"')).unwrap_or(inner);
        out.push((text.replace("\"\"", "\""), span));
        start = (end + 1).min(line.len());
    }
    out
}

fn point(names: &[(String, Span)], cells: &[(String, Span)], line: Span) -> Result<Point, Diagnostic> {
    if cells.len() != names.len() {
        let message = format!("this row has {} cells, and the head {}", cells.len(), names.len());
        return Err(Diagnostic::error(Code::Size, message).at(line, "this row"));
    }
    let mut out = Point::new();
    for ((name, _), (text, span)) in names.iter().zip(cells) {
        let value = parse_number(text).map_err(|_| {
            let error = Diagnostic::error(Code::Number, "this is not a number").at(*span, format!("a value of {name}"));
            error.help("numbers look like 12, 0.046, 46e-3 or 1/3")
        })?;
        out.push((name.clone(), value));
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_both_kinds_are_read() {
        for text in [
            "# a; b\nL,R\n1e-3,1/2\n2e-3,3\n",
            "L,R\n1e-3,1/2\n2e-3,3\n",
            "\u{feff}\"L\"; R\r\n# none\r\n1e-3; 1/2\r\n\r\n2e-3;\"3\"\r\n",
        ] {
            let cases = Table::read(&Source::new("cases.csv", text)).unwrap();
            let shown: Vec<String> = cases
                .points
                .iter()
                .map(|p| p.iter().map(|(n, v)| format!("{n}={v}")).collect::<Vec<_>>().join(" "))
                .collect();
            assert_eq!(shown, ["L=1/1000 R=1/2", "L=1/500 R=3"], "{text}");
        }
    }

    #[test]
    fn mistakes_are_shown_where_they_stand() {
        for (text, code, place) in [
            ("L,R\n1\n", Code::Size, "1"),
            ("L,R\n1,x\n", Code::Number, "x"),
            ("L,L\n1,2\n", Code::SetTwice, "L"),
            ("L,R\n", Code::Missing, ""),
            ("", Code::Missing, ""),
        ] {
            let Err(Error::Refused(refused)) = Table::read(&Source::new("cases.csv", text)) else { panic!("{text}") };
            let first = &refused.diagnostics()[0];
            assert_eq!(first.code, code, "{text}");
            let at = first.primary.as_ref().map_or("", |l| &text[l.span.start..l.span.end]);
            assert_eq!(at, place, "{text}");
        }
    }
}
