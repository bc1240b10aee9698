//! Diagnostics with the source line, carets and help, as compilers draw them.

use super::layout::is_unseen;
use annotate_snippets::{Annotation, AnnotationKind, Level, Origin, Renderer, Snippet};
use jurist_engine::error::{Diagnostic, Diagnostics, Severity, Source, Span};
use std::borrow::Cow;

/// Characters of a line that are shown at most.
const SHOWN: usize = 120;

/// Characters shown before the caret when a line is cut.
const BEFORE: usize = 40;

/// Bytes of source between the first and the last label that are drawn as one piece.
const MAX_REGION: usize = 100_000;

/// Characters of a message, label or help that are shown at most.
const MAX_TEXT: usize = 600;

/// Draws every diagnostic of an error, one after the other.
///
/// ```
/// use jurist_engine::error::Source;
/// use jurist_engine::model::Model;
/// use jurist_show::diagnostics::render_error;
/// let text = "time = 'discrete'\nparameters.K_pwm = {}\nloop.characteristic = 'z - K_pmw'";
/// let error = Model::from_toml(&Source::new("model.toml", text)).unwrap_err();
/// let drawn = render_error(&error, false);
/// assert!(drawn.starts_with("error[E-unknown-name]: unknown name 'K_pmw'"));
/// assert!(drawn.contains("model.toml:3:28"));
/// assert!(drawn.contains("^^^^^ not defined"));
/// assert!(drawn.contains("help: did you mean 'K_pwm'?"));
/// ```
pub fn render_error(error: &Diagnostics, color: bool) -> String {
    render(error.diagnostics(), error.source_text().map(AsRef::as_ref), color)
}

/// Draws diagnostics about `source`, one after the other, with a newline after each.
pub fn render(diagnostics: &[Diagnostic], source: Option<&Source>, color: bool) -> String {
    let mut out = String::new();
    for (i, diagnostic) in diagnostics.iter().enumerate() {
        if i > 0 {
            out.push('\n');
        }
        out.push_str(&render_one(diagnostic, source, color));
        out.push('\n');
    }
    out
}

/// A line of the source, cut to what is shown, with the labels in it.
struct Line<'d> {
    number: usize,
    text: String,
    /// The byte of the source where the shown part begins and ends.
    start: usize,
    end: usize,
    /// Bytes put in front of the shown part.
    prefix: usize,
    /// Whether nothing is cut off.
    whole: bool,
    labels: Vec<(AnnotationKind, Span, &'d str)>,
}

impl<'d> Line<'d> {
    /// The labels, in a text in which the shown part of the line begins at `offset`.
    fn annotations(&self, offset: usize) -> Vec<Annotation<'static>> {
        let annotation = |(kind, span, text): &(AnnotationKind, Span, &'d str)| {
            let end = span.end.min(self.end).max(span.start);
            kind.span(span.start - self.start + offset..end - self.start + offset).label(plain(text))
        };
        self.labels.iter().map(annotation).collect()
    }
}

fn render_one(diagnostic: &Diagnostic, source: Option<&Source>, color: bool) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut group =
        level.primary_title(plain(&diagnostic.message)).id(diagnostic.code.as_str()).elements(Vec::<Origin>::new());
    if let Some(source) = source {
        let primary = diagnostic.primary.iter().map(|l| (AnnotationKind::Primary, l));
        let secondary = diagnostic.secondary.iter().map(|l| (AnnotationKind::Context, l));
        for (kind, label) in primary.chain(secondary) {
            let span = snapped(&source.text, label.span);
            match lines.iter_mut().find(|l| l.start <= span.start && span.start <= l.end) {
                Some(line) => line.labels.push((kind, span, &label.text)),
                None => lines.push(line_at(source, span, (kind, span, &label.text))),
            }
        }
        lines.sort_by_key(|l| (l.number, l.start));
        if let (Some(first), Some(last)) = (lines.first(), lines.last())
            && lines.iter().all(|l| l.whole)
            && last.end - first.start <= MAX_REGION
        {
            let (start, number) = (first.start, first.number);
            let annotations = lines.iter().flat_map(|l| l.annotations(l.start - start));
            let text: String = source.text[start..last.end].chars().map(visible).collect();
            let snippet = Snippet::source(text).line_start(number).path(source.name.clone());
            group = group.element(snippet.annotations(annotations));
        } else {
            if let Some(label) = &diagnostic.primary {
                let (line, column) = source.line_column(label.span.start);
                group = group.element(Origin::path(&source.name).line(line).char_column(column));
            }
            for line in &lines {
                let annotations = line.annotations(line.prefix);
                group =
                    group.element(Snippet::source(line.text.clone()).line_start(line.number).annotations(annotations));
            }
        }
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(plain(help)));
    }
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    renderer.render(&[group])
}

/// Control characters, a carriage return among them, would move the cursor; they are replaced by
/// blanks of the same length.
fn visible(c: char) -> Cow<'static, str> {
    match c {
        '\n' => "\n".into(),
        '\t' => "\t".into(),
        c if is_unseen(c) => " ".repeat(c.len_utf8()).into(),
        c => c.to_string().into(),
    }
}

/// One line of text without control characters, not longer than is shown.
fn plain(text: &str) -> String {
    let visible = |c: char| if is_unseen(c) { ' ' } else { c };
    let mut out: String = text.chars().take(MAX_TEXT).map(visible).collect();
    if text.chars().nth(MAX_TEXT).is_some() {
        out.push_str("...");
    }
    out
}

/// The span moved to character boundaries inside the text.
fn snapped(text: &str, span: Span) -> Span {
    let snap = |mut at: usize| {
        at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    Span::new(snap(span.start), snap(span.end))
}

fn line_at<'d>(source: &Source, span: Span, label: (AnnotationKind, Span, &'d str)) -> Line<'d> {
    let text = &source.text;
    let (number, _) = source.line_column(span.start);
    let line_start = text[..span.start].rfind('\n').map_or(0, |i| i + 1);
    let line_end = text[span.start..].find('\n').map_or(text.len(), |i| span.start + i);
    let before = text[line_start..span.start].char_indices().rev().nth(BEFORE - 1);
    let long = text[line_start..line_end].chars().nth(SHOWN).is_some();
    let start = if long { before.map_or(line_start, |(i, _)| line_start + i) } else { line_start };
    let end = text[start..line_end].char_indices().nth(SHOWN).map_or(line_end, |(i, _)| start + i);
    let mut shown = String::new();
    let prefix = if start > line_start { "..." } else { "" };
    shown.push_str(prefix);
    shown.extend(text[start..end].chars().map(visible));
    if end < line_end {
        shown.push_str("...");
    }
    let whole = start == line_start && end == line_end;
    Line { number, text: shown, start, end, prefix: prefix.len(), whole, labels: vec![label] }
}
