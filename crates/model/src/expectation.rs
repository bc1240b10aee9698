//! What is expected of a loop, as data: the entries `[[expect]]` of a model file, or of a file of expectations beside it.

use super::Model;
use super::definition::{Name, RequirementText};
use super::text::names::{did_you_mean, known_names, shorten};
use super::tolerance::Tolerance;
use crate::error::{Code, Diagnostic, Source, Span};
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// One entry `[[expect]]`: claims about a loop, at the nominal point or at given values.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Expectation {
    /// What it is called, for people.
    pub name: Option<String>,
    /// The text that it stands in.
    pub source: Arc<Source>,
    /// Where it stands there.
    pub span: Span,
    /// The model file, relative to the file of expectations; `None` in a model file, which speaks of itself.
    pub model: Option<(String, Span)>,
    /// A table of operating points, relative to the file that it is named in.
    pub cases: Option<(String, Span)>,
    /// Values of parameters and constants.
    pub set: Vec<(Name, Rational)>,
    /// What is expected, in the order of the text.
    pub claims: Vec<Claim>,
}

/// A claim, and where it stands.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Claim {
    /// What is claimed.
    pub kind: ClaimKind,
    /// Where.
    pub span: Span,
}

/// What is claimed of a loop.
#[derive(Clone, Debug)]
pub enum ClaimKind {
    /// A word of verdicts: `stable`, `marginal`, `unstable`.
    Verdict(String),
    /// Stable for every value of a parameter from one to another, both included.
    Stable {
        /// The parameter.
        param: Name,
        /// The least value; `None` where there is none.
        low: Option<Rational>,
        /// The greatest value; `None` where there is none.
        high: Option<Rational>,
    },
    /// Where stability ends.
    Limit {
        /// The parameter.
        param: Name,
        /// Whether it is the upper end.
        is_upper: bool,
        /// The expected end; `None` where none is expected.
        value: Option<Rational>,
        /// How far the end may be away.
        within: Tolerance,
    },
    /// Requirements: those of the model, and these in addition or in their place.
    Require(Vec<RequirementText>),
    /// Stable for all values within the model's tolerances, each widened by this factor.
    Tolerance(Rational),
    /// A certificate, relative to the file that it is named in, is accepted.
    Certificate(String),
}

impl Expectation {
    /// The names that the model does not have, each with its place in the text of the expectation.
    pub fn unknown_names(&self, model: &Model) -> Vec<Diagnostic> {
        let known = || {
            let parameters = model.parameters().iter().map(|p| p.name.as_str());
            parameters.chain(model.constants().iter().filter(|c| c.number.is_some()).map(|c| c.name.as_str()))
        };
        let params = self.claims.iter().filter_map(|claim| match &claim.kind {
            ClaimKind::Stable { param, .. } | ClaimKind::Limit { param, .. } => Some(param),
            _ => None,
        });
        let mut out: Vec<Diagnostic> = Vec::new();
        for name in self.set.iter().map(|(name, _)| name).chain(params) {
            if known().any(|k| k == name.name)
                || out.iter().any(|d| d.primary.as_ref().is_some_and(|l| l.span == name.span))
            {
                continue;
            }
            let message = format!("'{}' is no parameter and no number of the model", shorten(&name.name));
            let mut error = Diagnostic::error(Code::UnknownName, message).at(name.span, "not known");
            error.help = did_you_mean(&name.name, known()).or_else(|| known_names(known()));
            out.push(error);
        }
        out
    }
}
