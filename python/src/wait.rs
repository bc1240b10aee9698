//! Work on the pool while Python waits: without the GIL, open to Ctrl-C, and safe from panics.

use crate::errors::defect_of;
use crate::pool::pool;
use jurist::{Budget, Error, Progress};
use jurist_algebra::limits::apart;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How often Python is asked whether to go on.
const LOOK: Duration = Duration::from_millis(40);

/// How long work that was cancelled is waited for. It looks at the flag every millisecond or so; what does not end by then
/// is left to end by itself.
const GRACE: Duration = Duration::from_millis(40);

/// How long the work may take, and who is told how far it is.
pub(crate) struct Patience {
    pub timeout: Option<f64>,
    /// Called with the name of the step and the share done, or `None`.
    pub progress: Option<Py<PyAny>>,
}

impl Patience {
    /// No end of it.
    pub fn unlimited() -> Patience {
        Patience { timeout: None, progress: None }
    }
}

/// The step that the work has reached.
#[derive(Default)]
struct Reached(Mutex<Option<(String, Option<f64>)>>);

impl Progress for Reached {
    fn step(&self, name: &str) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((name.to_owned(), None));
    }

    fn advance(&self, done: u64, total: u64) {
        if let Some((_, share)) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            *share = (total > 0).then(|| done as f64 / total as f64);
        }
    }
}

/// Runs work on the pool and gives its result. The outer error is Python's: an interrupt, a panic as `InternalError`, or what
/// the listener raised.
pub(crate) fn waited<T: Send + 'static>(
    py: Python<'_>,
    patience: &Patience,
    work: impl FnOnce(&Budget) -> Result<T, Error> + Send + 'static,
) -> PyResult<Result<T, Error>> {
    let timeout = patience.timeout.map(|s| Duration::try_from_secs_f64(s.max(0.0)).unwrap_or(Duration::MAX));
    let cancelled = Arc::new(AtomicBool::new(false));
    let reached = Arc::new(Reached::default());
    let mut budget = timeout.map_or_else(Budget::unlimited, Budget::with_timeout).cancelled_by(Arc::clone(&cancelled));
    if patience.progress.is_some() {
        budget = budget.reporting_to(Arc::clone(&reached) as Arc<dyn Progress>);
    }
    let (sender, receiver) = sync_channel(1);
    let receiver = Mutex::new(receiver);
    let receive = |time| receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(time);
    pool()?.spawn(move || {
        // This thread may be waiting for a part of another question, whose budget is none of this one's.
        let result = catch_unwind(AssertUnwindSafe(|| apart(|| work(&budget))));
        // Nobody listens any more where the wait was given up.
        let _ = sender.send(result);
    });
    let stop = |error: PyErr| {
        cancelled.store(true, Ordering::Relaxed);
        py.detach(|| drop(receive(GRACE)));
        Err(error)
    };
    loop {
        match py.detach(|| receive(LOOK)) {
            Ok(Ok(result)) => return Ok(result),
            Ok(Err(payload)) => return Err(defect_of(py, payload.as_ref())),
            Err(RecvTimeoutError::Disconnected) => return Err(defect_of(py, &"the work broke off")),
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Err(interrupt) = py.check_signals() {
            return stop(interrupt);
        }
        if let Some(listener) = &patience.progress {
            let news = reached.0.lock().unwrap_or_else(PoisonError::into_inner).take();
            if let Some((step, share)) = news
                && let Err(raised) = listener.call1(py, (&step, share))
            {
                return stop(raised);
            }
        }
    }
}

/// Runs short work on the calling thread; a panic becomes `InternalError`.
pub(crate) fn guarded<T>(py: Python<'_>, work: impl FnOnce() -> T) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| defect_of(py, payload.as_ref()))
}
