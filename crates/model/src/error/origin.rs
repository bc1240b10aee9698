//! Places in a text that was made of another one, as places in that one.

use super::{Diagnostic, Source, Span};
use std::sync::Arc;

/// Which parts of a text were copied from another text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    /// What was copied from.
    pub source: Arc<Source>,
    /// Where the copy of its beginning stands.
    pub copy: Span,
    /// The bytes of the source before which the copy has one byte more, in order.
    pub added: Vec<usize>,
    /// Further places in the text, each with what it stands for in the source.
    pub names: Vec<(Span, Span)>,
}

impl Origin {
    /// The diagnostics about the text, as diagnostics about its origin; `None` where one points at something else.
    pub fn trace(&self, diagnostics: &[Diagnostic]) -> Option<Vec<Diagnostic>> {
        diagnostics.iter().map(|d| self.diagnostic(d)).collect()
    }

    fn diagnostic(&self, diagnostic: &Diagnostic) -> Option<Diagnostic> {
        let mut traced = diagnostic.clone();
        for label in traced.primary.iter_mut().chain(&mut traced.secondary) {
            label.span = match self.names.iter().find(|(place, _)| *place == label.span) {
                Some((_, name)) => *name,
                None => Span::new(self.place(label.span.start)?, self.place(label.span.end)?),
            };
        }
        Some(traced)
    }

    fn place(&self, offset: usize) -> Option<usize> {
        if offset < self.copy.start || offset > self.copy.end {
            return None;
        }
        let offset = offset - self.copy.start;
        // The byte added before `added[i]` stands at `added[i] + i`.
        let before = self.added.iter().enumerate().take_while(|(i, at)| *at + i < offset).count();
        Some(offset - before)
    }
}
