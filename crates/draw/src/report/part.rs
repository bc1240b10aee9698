//! A part of the report: found, or missing for a reason that stands in its place.

use crate::page::{escaped, paragraph};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_engine::error::Error;
use std::sync::Mutex;

/// Why a part is missing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Missing {
    /// It is not asked, or not answered yet, for this loop: the reason.
    Refused(String),
    /// It takes more work than one page is worth.
    TooLong,
    /// The budget of the whole report ran out.
    Stopped(Stop),
}

/// What a part found.
pub(super) type Part<T> = Result<T, Missing>;

impl Missing {
    /// One sentence, plain text.
    pub fn sentence(&self) -> String {
        match self {
            Missing::Refused(why) => {
                let mut letters = why.chars();
                let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
                let end = if why.ends_with(['.', '!', '?', ')']) { "" } else { "." };
                format!("{first}{}{end}", letters.as_str())
            }
            Missing::TooLong => {
                "Left out: it takes longer than one page is worth; its own command has no such limit.".into()
            }
            Missing::Stopped(stop) => format!("Left out: the budget of the report ran out ({stop})."),
        }
    }

    /// The sentence as a paragraph.
    pub fn html(&self) -> String {
        paragraph(&escaped(&self.sentence()))
    }
}

impl From<Error> for Missing {
    fn from(error: Error) -> Self {
        match error {
            Error::Refused(refused) => Missing::Refused(match refused.diagnostics().first() {
                Some(first) => match &first.help {
                    Some(help) => format!("{} ({help})", first.message),
                    None => first.message.clone(),
                },
                None => "it was refused".to_owned(),
            }),
            Error::Stopped(stopped) => Missing::Stopped(stopped.stop),
            other => Missing::Refused(other.to_string()),
        }
    }
}

/// Units of work, about ten nanoseconds each, after which a part is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Work {
    /// The verdict: only the budget of the whole ends it.
    Any,
    /// Counted, not timed: the same report on every machine.
    Units(u64),
}

/// Runs the parts one after the other.
pub(super) struct Parts<'b> {
    budget: &'b Budget,
    stopped: Mutex<Option<Exhausted>>,
}

impl<'b> Parts<'b> {
    pub fn new(budget: &'b Budget) -> Self {
        Parts { budget, stopped: Mutex::default() }
    }

    /// What ended the first part that the budget of the whole did not allow.
    pub fn stopped(self) -> Option<Exhausted> {
        self.stopped.into_inner().ok().flatten()
    }

    /// A part that may use half of the time that is left.
    pub fn part<T>(&self, step: &str, work: Work, find: impl FnOnce(&Budget) -> Result<T, Error>) -> Part<T> {
        self.budget.step(step);
        self.within(&self.budget.share(1, 2).silent(), work, find)
    }

    /// Work that a budget ends, and a count of its own.
    pub fn within<T>(&self, budget: &Budget, work: Work, find: impl FnOnce(&Budget) -> Result<T, Error>) -> Part<T> {
        let counted = match work {
            Work::Any => Budget::unlimited(),
            Work::Units(units) => Budget::with_work(units),
        };
        let found = budget.enter(|| counted.enter(|| find(budget)));
        let stopped = match found {
            Ok(Ok(Ok(value))) => return Ok(value),
            Ok(Ok(Err(Error::Stopped(stopped)))) | Err(stopped) => stopped,
            Ok(Ok(Err(error))) => return Err(error.into()),
            Ok(Err(_)) => return Err(Missing::TooLong),
        };
        let missing = Missing::Stopped(stopped.stop.clone());
        if let Ok(mut first) = self.stopped.lock() {
            first.get_or_insert(stopped);
        }
        Err(missing)
    }

    /// The budget of the whole.
    pub fn budget(&self) -> &Budget {
        self.budget
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::limits::checkpoint;
    use jurist_engine::error::{Code, Diagnostic};

    fn endless(_: &Budget) -> Result<(), Error> {
        loop {
            checkpoint(1);
        }
    }

    #[test]
    fn a_part_is_found_refused_left_out_or_stopped_and_only_the_last_is_remembered() {
        let unlimited = Budget::unlimited();
        let parts = Parts::new(&unlimited);
        assert_eq!(parts.part("a", Work::Any, |_| Ok(1)), Ok(1));
        let refuse =
            |_: &Budget| -> Result<(), Error> { Err(Diagnostic::error(Code::Cut, "no cut").help("cut").into()) };
        let refused = parts.part("b", Work::Any, refuse).unwrap_err();
        assert_eq!(refused.sentence(), "No cut (cut)");
        assert_eq!(parts.part("c", Work::Units(1000), endless), Err(Missing::TooLong));
        assert!(parts.stopped().is_none());
        let limited = Budget::with_work(1000);
        let parts = Parts::new(&limited);
        let stopped = parts.part("d", Work::Any, endless).unwrap_err();
        assert!(matches!(&stopped, Missing::Stopped(Stop::Work(1000))), "{stopped:?}");
        assert!(parts.stopped().is_some());
    }
}
