//! What became of expectations: lines for people, the document, and findings for code hosts.

use super::{Line, Outcomes, percent};
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::error::{Code, Diagnostic, Source};
use jurist_show::documents::{Check, Test, TestStatus, Tested, TestedFile};
use jurist_show::layout::{visible, wrapped};
use serde_json::Value;
use std::sync::Arc;

impl Outcomes {
    /// The document.
    pub fn document(&self) -> Test {
        let tested = |line: &Line| Tested {
            name: line.name.clone(),
            status: line.status,
            text: line.text.clone(),
            margin_percent: line.margin.as_ref().and_then(in_percent),
            row: line.row,
            line: line.line_number(),
        };
        let file = |(file, lines): &(String, Vec<Line>)| TestedFile {
            file: file.clone(),
            tests: lines.iter().map(tested).collect(),
        };
        Test::new(self.files.iter().map(file).collect())
    }

    /// Lines as of a test runner; those that pass can be left out.
    pub fn text(&self, only_bad: bool) -> String {
        let mut out = String::new();
        for (file, lines) in &self.files {
            let shown = lines.iter().filter(|line| !only_bad || line.status != TestStatus::Passed);
            let shown: Vec<String> = shown.map(Line::shown).collect();
            if !shown.is_empty() {
                out.push_str(&format!("{}\n{}", visible(file), shown.concat()));
            }
        }
        let Test { passed, failed, undecided, errors, .. } = self.document();
        let mut counts = vec![format!("{passed} passed"), format!("{failed} failed")];
        if undecided > 0 {
            counts.push(format!("{undecided} undecided"));
        }
        if errors > 0 {
            counts.push(format!("{errors} with errors"));
        }
        format!("{out}{}\n", counts.join(", "))
    }

    /// What does not pass, as a log of SARIF with places.
    pub fn sarif(&self) -> Value {
        let mut checks = Vec::new();
        for (file, lines) in &self.files {
            // An expectation may stand in a file of its own.
            let mut of_source: Vec<(Option<Arc<Source>>, Vec<Diagnostic>)> = Vec::new();
            for line in lines.iter().filter(|line| line.status != TestStatus::Passed) {
                let source = line.place.as_ref().map(|(source, _)| Arc::clone(source));
                let known =
                    of_source.iter().position(|(s, _)| s.as_ref().map(|s| &s.name) == source.as_ref().map(|s| &s.name));
                let k = known.unwrap_or_else(|| {
                    of_source.push((source, Vec::new()));
                    of_source.len() - 1
                });
                of_source[k].1.push(line.diagnostic());
            }
            for (source, diagnostics) in of_source {
                let name = source.as_ref().map_or(file.as_str(), |source| source.name.as_str()).to_owned();
                checks.push(Check::new(&name, source.as_deref(), &diagnostics));
            }
        }
        Check::sarif_of(&checks)
    }
}

/// Characters of a line.
const WIDTH: usize = 100;

/// Where what was found begins, where it has lines of its own.
const INDENT: usize = 12;

impl Line {
    fn line_number(&self) -> Option<usize> {
        self.place.as_ref().map(|(source, span)| source.line_column(span.start).0)
    }

    fn shown(&self) -> String {
        let status = match self.status {
            TestStatus::Passed => "passed",
            TestStatus::Failed => "FAILED",
            TestStatus::Undecided => "UNDECIDED",
            TestStatus::Error => "ERROR",
        };
        let is_decided = matches!(self.status, TestStatus::Passed | TestStatus::Failed);
        let left = match self.margin.as_ref().filter(|_| is_decided) {
            Some(margin) if margin.is_zero() && self.status == TestStatus::Failed => ", nothing left".to_owned(),
            Some(margin) if margin.is_negative() => format!(", {} too little", percent(&margin.abs())),
            Some(margin) => format!(", {} left", percent(margin)),
            None => String::new(),
        };
        let line = match (self.status, self.line_number()) {
            // An error says itself where it is.
            (TestStatus::Passed | TestStatus::Error, _) | (_, None) => String::new(),
            (_, Some(line)) => format!(" (line {line})"),
        };
        let (name, found) = (visible(&self.name), format!("{}{left}{line}", visible(&self.text)));
        let whole = format!("  {status:<9} {name}: {found}");
        if whole.chars().count() <= WIDTH {
            return whole + "\n";
        }
        let indent = " ".repeat(INDENT);
        format!("  {status:<9} {name}:\n{indent}{}\n", wrapped(&found, WIDTH - INDENT, &indent))
    }

    fn diagnostic(&self) -> Diagnostic {
        let message = format!("{}: {}", self.name, self.text);
        let found = match self.status {
            TestStatus::Undecided => Diagnostic::warning(Code::ExpectWarning, message),
            _ => Diagnostic::error(Code::Expect, message),
        };
        match &self.place {
            Some((_, span)) => found.at(*span, "expected here"),
            None => found,
        }
    }
}

/// A share in percent as a number of JSON.
fn in_percent(share: &Rational) -> Option<serde_json::Number> {
    to_decimal(&(share * &Rational::from(100)), 6).parse().ok()
}
