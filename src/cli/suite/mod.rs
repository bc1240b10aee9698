//! Expectations that are tried: which files have them, what became of each, and how that is told.

pub(super) mod collect;
pub(super) mod judge;
pub(super) mod junit;
pub(super) mod lock;
pub(super) mod tell;
mod try_all;

pub(super) use try_all::{Outcomes, try_all};

use jurist_algebra::number::Rational;
use jurist_engine::error::{Source, Span};
use jurist_show::documents::TestStatus;
use std::sync::Arc;

/// A place in a text.
pub(super) type InText = (Arc<Source>, Span);

/// What became of one expectation.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// What is expected.
    pub name: String,
    pub status: TestStatus,
    /// What was found.
    pub text: String,
    /// How far that is from failing, as a share of what is expected.
    pub margin: Option<Rational>,
    /// The worst row of a table of operating points.
    pub row: Option<usize>,
    /// Where it is expected.
    pub place: Option<InText>,
}

impl Line {
    pub fn new(name: impl Into<String>, status: TestStatus, text: impl Into<String>) -> Line {
        Line { name: name.into(), status, text: text.into(), margin: None, row: None, place: None }
    }

    pub fn with_margin(self, margin: Option<Rational>) -> Line {
        Line { margin, ..self }
    }
}

/// A share in percent, with three digits.
pub(super) fn percent(share: &Rational) -> String {
    format!("{} %", jurist_algebra::number::to_decimal(&(share * &Rational::from(100)), 3))
}
