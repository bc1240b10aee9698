//! TOML values to typed parts of a model, with an error for whatever does not fit.

use super::keys::Key;
use crate::definition::{Matrix, Name, Output};
use crate::error::{Code, Diagnostic, Severity, Span};
use crate::evaluate::work::constant_value;
use crate::text::Expression;
use crate::text::Text;
use crate::text::names::{did_you_mean, list, nearest_name, shorten};
use crate::text::toml_value::{Entry, Kind, Table, Value};
use crate::text::{is_blank_letter, is_name};
use jurist_algebra::number::{Rational, parse_number};
use std::collections::HashSet;

/// Collects what is wrong while it reads on.
#[derive(Default)]
pub(super) struct Reader {
    pub diagnostics: Vec<Diagnostic>,
    /// Names whose definitions were refused: using them is no second mistake.
    pub refused: HashSet<String>,
    /// The constants that are matrices.
    pub matrices: Vec<NamedMatrix>,
    /// Whether the imaginary unit is in an expression.
    pub has_unit: bool,
}

/// A constant that is a matrix: blocks use it by its name.
pub(super) struct NamedMatrix {
    pub name: Name,
    pub matrix: Matrix,
    pub is_used: bool,
}

/// The keys that misspelt keys of a table were probably meant to be: these are not missing as well.
#[derive(Debug, Default)]
pub(super) struct Meant(Vec<String>);

impl Meant {
    pub fn includes(&self, key: &str) -> bool {
        self.0.iter().any(|k| k == key)
    }
}

/// Where a key belongs that stands in another table, and that table's name.
fn misplaced(key: &str, place: &str) -> Option<(&'static str, &'static str)> {
    match (place, key) {
        ("the model", "characteristic" | "matrix" | "inputs" | "outputs" | "states") => {
            Some(("it belongs below a line '[loop]'", "loop"))
        }
        ("the model", "transfer" | "input" | "output" | "discretize") => {
            Some(("it belongs below a line '[[block]]'", "block"))
        }
        ("[loop]" | "[simulation]" | "[require]", "time" | "sample_time" | "title") => {
            Some(("it belongs at the top of the file, above the first line in brackets", "time"))
        }
        _ => None,
    }
}

impl Reader {
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// A part of the model that has no effect.
    pub fn unused(&mut self, message: impl Into<String>, span: Span) {
        self.report(Diagnostic::warning(Code::UnusedWarning, message).at(span, "not used"));
    }

    /// How many errors there are so far; warnings do not count.
    pub fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Error).count()
    }

    /// A value of another kind than was expected.
    pub fn wrong_type(&mut self, value: &Value, what: &str, expected: &str) {
        let error = Diagnostic::error(Code::Type, format!("{what} must be {expected}"));
        self.report(error.at(value.span, format!("this is {}", value.describe())));
    }

    /// Reports every key that is not among `known`.
    pub fn unknown_keys(&mut self, table: &Table, known: &[Key], place: &str) -> Meant {
        let known: Vec<&str> = known.iter().map(|key| key.name).collect();
        let mut meant = Meant::default();
        for entry in table.iter().filter(|e| !known.contains(&e.key.as_str())) {
            let message = format!("unknown key '{}' in {place}", shorten(&entry.key));
            let mut error = Diagnostic::error(Code::UnknownKey, message).at(entry.key_span, "not known here");
            let is_rate = ["sample_rate", "sampling_rate", "fs", "f_s"].contains(&entry.key.as_str());
            let rate = (is_rate && known.contains(&"sample_time"))
                .then(|| "give the sample time, 1 over the rate: sample_time = \"1/10000\"".to_owned());
            let misplaced = misplaced(&entry.key, place);
            meant.0.extend(misplaced.map(|(_, table)| table.to_owned()));
            error.help = rate
                .or_else(|| misplaced.map(|(help, _)| help.to_owned()))
                .or_else(|| did_you_mean(&entry.key, known.iter().copied()))
                .or_else(|| Some(format!("known here: {}", list(known.iter().copied()))));
            self.report(error);
            // What stands in the wrong place is not unknown as well where it is used.
            self.refused.insert(entry.key.clone());
            self.refuse_names(&entry.value);
            meant.0.extend(nearest_name(&entry.key, known.iter().copied()).map(str::to_owned));
        }
        meant
    }

    /// What a value that was not read would have defined: the keys of a table, the names of an array.
    fn refuse_names(&mut self, value: &Value) {
        match &value.kind {
            Kind::Table(table) => self.refused.extend(table.iter().map(|e| e.key.clone())),
            Kind::String(text) => {
                self.refused.insert(text.as_str().to_owned());
            }
            Kind::Array(items) => {
                for item in items {
                    match &item.kind {
                        // The signals of a block.
                        Kind::Table(table) => table.iter().for_each(|e| self.refuse_strings(&e.value)),
                        _ => self.refuse_strings(item),
                    }
                }
            }
            _ => {}
        }
    }

    fn refuse_strings(&mut self, value: &Value) {
        for item in self.items(value) {
            if let Kind::String(text) = &item.kind {
                self.refused.insert(text.as_str().to_owned());
            }
        }
    }

    pub fn string<'v>(&mut self, value: &'v Value, what: &str) -> Option<&'v Text> {
        let Kind::String(text) = &value.kind else {
            self.wrong_type(value, what, "a string");
            return None;
        };
        Some(text)
    }

    pub fn plain_string(&mut self, table: &Table, key: &str) -> Option<String> {
        let value = table.get(key)?;
        self.string(value, &format!("'{key}'")).map(|t| t.as_str().to_owned())
    }

    pub fn table<'v>(&mut self, entry: &'v Entry) -> Option<&'v Table> {
        let Kind::Table(table) = &entry.value.kind else {
            self.wrong_type(&entry.value, &format!("'{}'", shorten(&entry.key)), "a table");
            return None;
        };
        Some(table)
    }

    /// A number or a string with an expression.
    pub fn expression(&mut self, value: &Value, what: &str) -> Option<Expression> {
        match &value.kind {
            Kind::String(text) => match crate::text::parse(text) {
                Ok(expression) => Some(expression),
                Err(diagnostic) => {
                    self.report(diagnostic);
                    None
                }
            },
            Kind::Number(text) => self.literal(text, value.span).map(|n| Expression::number(n).at(value.span)),
            _ => {
                self.wrong_type(value, what, "a number or a string with an expression");
                None
            }
        }
    }

    fn literal(&mut self, text: &str, span: Span) -> Option<Rational> {
        let word = text.trim_start_matches(['+', '-']);
        if word.eq_ignore_ascii_case("inf") || word.eq_ignore_ascii_case("nan") {
            let error = Diagnostic::error(Code::Number, format!("{word} is not a number of a model"));
            self.report(error.at(span, "not finite").help("leave the key out where there is no bound"));
            return None;
        }
        match parse_number(text) {
            Ok(number) => Some(number),
            Err(error) => {
                self.report(Diagnostic::error(Code::Number, error.to_string()).at(span, "not accepted"));
                None
            }
        }
    }

    /// A number, or an expression of numbers only.
    pub fn number(&mut self, value: &Value, what: &str) -> Option<Rational> {
        let expression = self.expression(value, what)?;
        match constant_value(&expression) {
            Ok(number) => Some(number),
            Err(Some(diagnostic)) => {
                self.report(diagnostic);
                None
            }
            Err(None) => {
                let error = Diagnostic::error(Code::NotANumber, format!("{what} must be a number"));
                let help = "write a number, or a formula of numbers such as \"1/3\"";
                let label = if expression.has_function() { "contains a function" } else { "contains a name" };
                self.report(error.at(expression.span, label).help(help));
                None
            }
        }
    }

    /// A name that expressions can use.
    pub fn name(&mut self, text: &str, span: Span, what: &str) -> Option<Name> {
        if is_name(text) {
            return Some(Name { name: text.to_owned(), span });
        }
        if let Some(blank) = text.chars().find(|c| is_blank_letter(*c)) {
            let message =
                format!("the name of {what} has a character that cannot be seen, '{}'", blank.escape_unicode());
            self.report(
                Diagnostic::error(Code::Name, message).at(span, "not a name").help("delete it, or write the name anew"),
            );
            return None;
        }
        let message = format!("'{}' is no name for {what}", shorten(text));
        let error = Diagnostic::error(Code::Name, message).at(span, "not a name");
        self.report(error.help("names are made of letters, digits and '_', and do not begin with a digit"));
        None
    }

    /// An array, or a single value standing for an array of one.
    pub fn items<'v>(&mut self, value: &'v Value) -> &'v [Value] {
        match &value.kind {
            Kind::Array(items) => items,
            _ => std::slice::from_ref(value),
        }
    }

    /// One name or an array of names.
    pub fn names(&mut self, value: &Value, what: &str) -> Vec<Name> {
        let items = self.items(value);
        let mut names = Vec::new();
        for item in items {
            if let Some(text) = self.string(item, what) {
                let span = text.source_span(0, text.as_str().len());
                names.extend(self.name(text.as_str(), span, what));
            }
        }
        names
    }

    /// One expression or an array of expressions.
    pub fn expressions(&mut self, value: &Value, what: &str) -> Vec<Expression> {
        let items = self.items(value);
        items.iter().filter_map(|item| self.expression(item, what)).collect()
    }

    pub fn outputs(&mut self, value: &Value) -> Vec<Output> {
        let mut outputs = Vec::new();
        for item in self.items(value) {
            let Some(text) = self.string(item, "an output") else { continue };
            if let Some(expression) = self.expression(item, "an output") {
                // A name is one line, however the expression is broken.
                let name = text.as_str().trim().replace(char::is_control, " ");
                outputs.push(Output { name: Name { name, span: expression.span }, expression });
            }
        }
        outputs
    }

    /// The matrix that a constant of this name is.
    fn named_matrix(&mut self, text: &Text, what: &str) -> Option<Matrix> {
        let (name, span) = (text.as_str().trim(), text.span());
        if let Some(found) = self.matrices.iter_mut().find(|m| m.name.name == name) {
            found.is_used = true;
            return Some(found.matrix.clone());
        }
        if self.refused.contains(name) {
            return None;
        }
        let names = || self.matrices.iter().map(|m| m.name.name.as_str());
        let error = if is_name(name) {
            let error = Diagnostic::error(Code::UnknownName, format!("no constant '{}' is a matrix", shorten(name)));
            let help = || format!("write rows, or name them in [constants]: {name} = [[0, 1], [\"-k\", -2]]");
            error.at(span, "not a matrix").help(did_you_mean(name, names()).unwrap_or_else(help))
        } else {
            let error = Diagnostic::error(Code::Type, format!("{what} must be an array of rows"));
            let help = "rows in brackets, expressions in quotes: [[0, 1], [\"-k\", -2]]; or the name of a matrix";
            error.at(span, "this is a string").help(help)
        };
        self.report(error);
        None
    }

    /// A rectangle of expressions, or the name of a constant that is one.
    pub fn matrix(&mut self, value: &Value, what: &str) -> Option<Matrix> {
        if let Kind::String(text) = &value.kind {
            return self.named_matrix(text, what);
        }
        let Kind::Array(rows) = &value.kind else {
            self.wrong_type(value, what, "an array of rows");
            return None;
        };
        let before = self.diagnostics.len();
        let mut out: Vec<Vec<Expression>> = Vec::with_capacity(rows.len());
        let mut first: Option<(usize, Span)> = None;
        for row in rows {
            let Kind::Array(items) = &row.kind else {
                let error = Diagnostic::error(Code::Type, format!("a row of {what} must be an array"));
                let error = error.at(row.span, format!("this is {}", row.describe()));
                self.report(error.help("rows in brackets, expressions in quotes: [[0, 1], [\"-k\", -2]]"));
                continue;
            };
            match first {
                None => first = Some((items.len(), row.span)),
                Some((length, span)) if length != items.len() => {
                    let message = format!("the rows of {what} differ in length");
                    self.report(
                        Diagnostic::error(Code::Size, message)
                            .at(row.span, format!("{} here", count(items.len(), "entry", "entries")))
                            .also(span, format!("{} here", count(length, "entry", "entries"))),
                    );
                }
                Some(_) => {}
            }
            out.push(items.iter().filter_map(|item| self.expression(item, &format!("an entry of {what}"))).collect());
        }
        (self.diagnostics.len() == before).then_some(Matrix { rows: out, span: value.span })
    }

    /// Whether a matrix has the wanted size; if not, that is reported with the place that asks for it.
    pub fn size(&mut self, matrix: &Matrix, what: &str, rows: usize, columns: usize, because: (Span, &str)) -> bool {
        let (r, c) = matrix.size();
        // A matrix without rows has no columns to count.
        if r == rows && (c == columns || r == 0) {
            return true;
        }
        let message = format!("{what} is {r} x {c}, but must be {rows} x {columns}");
        let error = Diagnostic::error(Code::Size, message).at(matrix.span, format!("{r} x {c}"));
        self.report(error.also(because.0, because.1));
        false
    }
}

/// `1 entry`, `2 entries`.
pub(super) fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}
