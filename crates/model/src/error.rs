//! The one error type, in three forms ([`Error`]); what is wrong with an input are diagnostics with a stable code, a place in the text, and help.
//!
//! [`Diagnostics`] are one or more [`Diagnostic`]s about one [`Source`] text. How they look on a
//! terminal is decided elsewhere (the command line draws them with carets); `Display` gives one
//! line each.

mod code;
mod codes;
mod kinds;
mod origin;
mod refusal;
#[doc = include_str!("error/codes.md")]
pub mod code_list {}

pub use code::Code;
pub use codes::codes;
pub use kinds::Error;
pub(crate) use origin::Origin;
pub use refusal::Refusal;

use std::fmt;
use std::sync::Arc;

/// A half-open range of bytes in a source text.
///
/// ```
/// use jurist_model::error::Span;
/// assert_eq!(Span::new(3, 5).to(Span::new(8, 9)), Span::new(3, 9));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// The range `start..end`.
    pub fn new(start: usize, end: usize) -> Self {
        Span { start, end: end.max(start) }
    }

    /// Whether another range lies in this one.
    pub fn covers(self, other: Span) -> bool {
        self.start <= other.start && other.end <= self.end
    }

    /// The smallest range that holds both.
    pub fn to(self, other: Span) -> Span {
        Span { start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

/// A text that diagnostics point into, with the name to show for it.
///
/// ```
/// use jurist_model::error::Source;
/// let source = Source::new("model.toml", "time = 'discrete'\nK = 1");
/// assert_eq!(source.line_column(18), (2, 1));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Source {
    /// File name, `<stdin>`, `<command line>`, ...
    pub name: String,
    /// The whole text.
    pub text: String,
    /// What a part of the text was copied from: diagnostics about that part point there.
    origin: Option<Origin>,
}

impl Source {
    /// A named text, ready to be shared.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Source> {
        Arc::new(Source { name: name.into(), text: text.into(), origin: None })
    }

    /// A named text with a part that was copied from another one.
    pub(crate) fn copied(name: impl Into<String>, text: impl Into<String>, origin: Origin) -> Arc<Source> {
        Arc::new(Source { name: name.into(), text: text.into(), origin: Some(origin) })
    }

    /// Line and column, both counted from 1, columns in characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }
}

/// A place in the text and what is to be said about it.
///
/// ```
/// use jurist_model::error::{Code, Diagnostic, Span};
/// let error = Diagnostic::error(Code::UnknownName, "unknown name 'k'").at(Span::new(4, 5), "not defined");
/// let label = error.primary.unwrap();
/// assert_eq!((label.span.start, label.text.as_str()), (4, "not defined"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What, in a few words; may be empty.
    pub text: String,
}

/// Whether the input is refused or only remarked upon.
///
/// ```
/// use jurist_model::error::{Code, Diagnostic, Severity};
/// assert_eq!(Diagnostic::warning(Code::UnusedWarning, "the constant 'c' is not used").severity, Severity::Warning);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The input is refused.
    Error,
    /// The input is accepted.
    Warning,
}

/// One thing that is wrong, where, and what to do about it.
///
/// ```
/// use jurist_model::error::{Code, Diagnostic, Span};
/// let error = Diagnostic::error(Code::UnknownName, "unknown name 'k'").at(Span::new(4, 5), "not defined");
/// let error = error.help("did you mean 'K'?");
/// assert_eq!(error.to_string(), "error[E-unknown-name]: unknown name 'k'");
/// assert_eq!(error.help.as_deref(), Some("did you mean 'K'?"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// Stable code such as `E-unknown-name`; every code is listed in [`code_list`].
    pub code: Code,
    /// One sentence, no full stop.
    pub message: String,
    /// The place the message is about.
    pub primary: Option<Label>,
    /// Other places that matter, e.g. the first of two definitions.
    pub secondary: Vec<Label>,
    /// What to do.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error without a place.
    pub fn error(code: Code, message: impl Into<String>) -> Self {
        Diagnostic {
            severity: Severity::Error,
            code,
            message: message.into(),
            primary: None,
            secondary: Vec::new(),
            help: None,
        }
    }

    /// A warning without a place.
    pub fn warning(code: Code, message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, message) }
    }

    /// The same, about `span`, with a few words under the caret.
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Self {
        self.primary = Some(Label { span, text: text.into() });
        self
    }

    /// The same, with a further place.
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Self {
        self.secondary.push(Label { span, text: text.into() });
        self
    }

    /// The same, about no place.
    pub fn without_places(self) -> Self {
        Diagnostic { primary: None, secondary: Vec::new(), ..self }
    }

    /// The same, with advice.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{severity}[{}]: {}", self.code, self.message)
    }
}

/// Why an input was refused: at least one diagnostic, and the text they point into.
///
/// ```
/// use jurist_model::error::{Code, Diagnostic, Diagnostics, Source, Span};
/// let error = Diagnostic::error(Code::UnknownName, "unknown name 'k'").at(Span::new(4, 5), "not defined");
/// let errors = Diagnostics::from(error).in_source(&Source::new("model.toml", "z - k"));
/// assert_eq!(errors.to_string(), "model.toml:1:5: error[E-unknown-name]: unknown name 'k'");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    source: Option<Arc<Source>>,
    diagnostics: Vec<Diagnostic>,
}

impl Diagnostics {
    /// An error about `source`, or about no text.
    pub fn new(source: Option<Arc<Source>>, diagnostics: Vec<Diagnostic>) -> Self {
        assert!(!diagnostics.is_empty());
        let origin = source.as_ref().and_then(|s| s.origin.as_ref());
        match origin.and_then(|o| Some((Arc::clone(&o.source), o.trace(&diagnostics)?))) {
            Some((source, diagnostics)) => Diagnostics { source: Some(source), diagnostics },
            None => Diagnostics { source, diagnostics },
        }
    }

    /// The text the spans refer to.
    pub fn source_text(&self) -> Option<&Arc<Source>> {
        self.source.as_ref()
    }

    /// Everything that is wrong, in the order found.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The code of the first diagnostic.
    pub fn code(&self) -> Code {
        self.diagnostics.first().map_or(Code::Internal, |d| d.code)
    }

    /// The same diagnostics, about `source` where none was set.
    pub fn in_source(self, source: &Arc<Source>) -> Self {
        match self.source {
            Some(_) => self,
            None => Diagnostics::new(Some(Arc::clone(source)), self.diagnostics),
        }
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Diagnostics::new(None, vec![diagnostic])
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, d) in self.diagnostics.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            if let (Some(source), Some(label)) = (&self.source, &d.primary) {
                let (line, column) = source.line_column(label.span.start);
                write!(f, "{}:{line}:{column}: ", source.name)?;
            }
            write!(f, "{d}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}
