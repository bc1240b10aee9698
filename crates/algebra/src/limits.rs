//! Budgets and progress: long work takes a [`Budget`] and asks it, step by step, whether to go on.
//!
//! A budget never changes an answer: work either ends with the exact result or stops with
//! [`Exhausted`], which names the budget that ran out.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Receives the name of the step that begins and, where known, its share done (0 to 1).
pub trait Progress: Send + Sync {
    /// A new step begins.
    fn step(&self, name: &str);
    /// `done` of `total` parts of the current step are finished.
    fn advance(&self, done: u64, total: u64);
}

/// How much time a computation may take, and whom it tells how far it is.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use std::time::Duration;
/// assert!(Budget::unlimited().check().is_ok());
/// assert!(Budget::with_timeout(Duration::ZERO).check().is_err());
/// ```
#[derive(Clone, Default)]
pub struct Budget {
    deadline: Option<(Instant, Duration)>,
    cancelled: Option<Arc<AtomicBool>>,
    progress: Option<Arc<dyn Progress>>,
    reached: Arc<Mutex<Reached>>,
    silent: bool,
}

/// The step that began last, and how much of it is done.
#[derive(Default)]
struct Reached {
    step: String,
    done: u64,
    total: u64,
}

impl Budget {
    /// No limit of time, no progress reports.
    pub fn unlimited() -> Self {
        Budget::default()
    }

    /// Work may go on for `timeout` from now.
    pub fn with_timeout(timeout: Duration) -> Self {
        let deadline = Instant::now().checked_add(timeout).map(|end| (end, timeout));
        Budget { deadline, ..Budget::default() }
    }

    /// A budget that ends when `part / of` of the time that is left is used up; without end where there is no
    /// limit. When it runs out it names the whole.
    ///
    /// # Panics
    /// When `of` is 0.
    pub fn share(&self, part: u32, of: u32) -> Self {
        let mut share = self.clone();
        if let Some((end, timeout)) = self.deadline {
            let now = Instant::now();
            let time = end.saturating_duration_since(now) / of * part;
            // A time that the clock cannot count is as good as no limit.
            share.deadline = now.checked_add(time).map(|end| (end, timeout));
        }
        share
    }

    /// The same budget, reporting to `progress`.
    pub fn reporting_to(mut self, progress: Arc<dyn Progress>) -> Self {
        self.progress = Some(progress);
        self
    }

    /// The same limits for a part of a step: what it begins is told to nobody.
    pub fn silent(&self) -> Self {
        Budget { silent: true, ..self.clone() }
    }

    /// The same budget, also ended by setting `flag`.
    pub fn cancelled_by(mut self, flag: Arc<AtomicBool>) -> Self {
        self.cancelled = Some(flag);
        self
    }

    /// Whether work may go on.
    ///
    /// # Errors
    /// [`Exhausted`] when the time is up or the work was cancelled.
    pub fn check(&self) -> Result<(), Exhausted> {
        if let Some((end, timeout)) = self.deadline
            && Instant::now() >= end
        {
            return Err(self.exhausted(format!("time ({} s)", timeout.as_secs_f64())));
        }
        if self.cancelled.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return Err(self.exhausted("cancelled".into()));
        }
        Ok(())
    }

    fn exhausted(&self, budget: String) -> Exhausted {
        Exhausted { budget, reached: self.reached() }
    }

    /// The last step that began and, where known, how much of it is done: what an exhausted budget had reached.
    pub fn reached(&self) -> String {
        let reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        match (reached.step.as_str(), reached.total) {
            ("", _) => "nothing was begun".to_owned(),
            (step, 0) => step.to_owned(),
            (step, total) => format!("{step} ({} of {total})", reached.done),
        }
    }

    /// Notes that a step begins and tells the listener, if there is one.
    pub fn step(&self, name: &str) {
        if self.silent {
            return;
        }
        *self.reached.lock().unwrap_or_else(PoisonError::into_inner) =
            Reached { step: name.to_owned(), ..Reached::default() };
        if let Some(progress) = &self.progress {
            progress.step(name);
        }
    }

    /// Tells the listener, if there is one, how much of the step is done.
    pub fn advance(&self, done: u64, total: u64) {
        if self.silent {
            return;
        }
        let mut reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        (reached.done, reached.total) = (done, total);
        drop(reached);
        if let Some(progress) = &self.progress {
            progress.advance(done, total);
        }
    }
}

impl fmt::Debug for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Budget").field("deadline", &self.deadline).finish_non_exhaustive()
    }
}

/// A budget ran out before the exact answer was reached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exhausted {
    /// Which budget, e.g. `time (2 s)`.
    pub budget: String,
    /// The last step that began and, where known, how much of it was done.
    pub reached: String,
}

impl fmt::Display for Exhausted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the budget ran out: {}; reached: {}", self.budget, self.reached)
    }
}

impl std::error::Error for Exhausted {}
