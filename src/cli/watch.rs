//! The last resort of `--timeout`.
//!
//! Long work asks its budget whether to go on, but some single steps (a greatest common divisor of huge
//! polynomials, a row of a table, the digits of an answer) do not. Where one of them runs on after the time is
//! up, the program says what it knows and ends.

use super::output::{note, unless_answered, write_locked};
use super::progress::Reporter;
use super::status::Status;
use std::ffi::OsString;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long a step may take to notice that the time is up.
const GRACE: Duration = Duration::from_millis(250);

/// Writes what is known, given the budget and how far the work came.
type Known = Box<dyn FnOnce(String, String) -> Option<String> + Send>;

/// The same with the file it goes to, if not to standard output.
type ToFile = (Known, Option<OsString>);

/// What is said when the time is up in the middle of a step.
#[derive(Clone, Default)]
pub(super) struct Watch {
    known: Arc<Mutex<Option<ToFile>>>,
}

impl Watch {
    /// Ends the program soon after `timeout`, unless it has answered by then.
    pub fn after(timeout: Option<Duration>, reporter: &Arc<Reporter>) -> Watch {
        let watch = Watch::default();
        let Some(timeout) = timeout else { return watch };
        let (known, reporter) = (Arc::clone(&watch.known), Arc::clone(reporter));
        std::thread::spawn(move || {
            std::thread::sleep(timeout.saturating_add(GRACE));
            unless_answered(|| {
                reporter.finish();
                let budget = format!("time ({} s)", timeout.as_secs_f64());
                let reached = reporter.reached();
                let known = known.lock().unwrap_or_else(PoisonError::into_inner).take();
                if let Some((document, file)) = known
                    && let Some(text) = document(budget.clone(), reached.clone())
                {
                    // Nobody is left to be told that this cannot be written.
                    let _ = write_locked(&text, file.as_ref());
                }
                note(&format!("undecided: the budget ran out: {budget}; reached: {reached}"));
                std::process::exit(i32::from(Status::Undecided as u8));
            });
        });
        watch
    }

    /// Says what is to be written when the time is up: from the budget and how far the work came.
    pub fn know(
        &self,
        file: Option<&OsString>,
        document: impl FnOnce(String, String) -> Option<String> + Send + 'static,
    ) {
        *self.known.lock().unwrap_or_else(PoisonError::into_inner) = Some((Box::new(document), file.cloned()));
    }
}
