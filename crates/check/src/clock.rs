//! What bounds a check: the time it takes, and the work that reading a model may be.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The work of reading a model, in units of about a nanosecond. It is counted and not timed: whether a text is a model must not
/// depend on how busy the machine is.
const MODEL_WORK: u64 = 20_000_000_000;

/// The work of a check in the same units: so much for every text, and so much for each byte of it. What the engine writes takes a
/// tenth at most.
const WORK: u64 = 6_000_000_000;
const WORK_OF_BYTE: u64 = 2_000_000;

/// The bytes that the numbers of one step may take.
const MEMORY: u64 = 48 << 20;

/// About what a number takes beside its digits.
const BYTES_OF_NUMBER: u64 = 32;

/// Says when the time is over.
trait Timer {
    /// Whether it is, after so much work.
    fn is_over(&self, work: u64) -> bool;
}

/// The machine's clock.
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
struct Wall(Option<std::time::Instant>);

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
impl Timer for Wall {
    fn is_over(&self, _: u64) -> bool {
        self.0.is_some_and(|end| std::time::Instant::now() >= end)
    }
}

/// Where there is no clock, work stands for time: a unit for a nanosecond.
#[cfg(any(test, all(target_family = "wasm", target_os = "unknown")))]
struct Counted(u64);

#[cfg(any(test, all(target_family = "wasm", target_os = "unknown")))]
impl Timer for Counted {
    fn is_over(&self, work: u64) -> bool {
        work >= self.0
    }
}

/// Ends the work when its time is up.
pub(super) struct Clock {
    timer: Box<dyn Timer + Send>,
    timeout: Duration,
    work: Cell<u64>,
    /// The work at which the reading of a model is given up.
    limit: Cell<u64>,
    /// The work at which the whole check is.
    total: u64,
    /// Whether a bound of work or of memory was reached.
    is_refused: Arc<AtomicBool>,
}

impl Clock {
    fn with(timer: impl Timer + Send + 'static, timeout: Duration) -> Self {
        let (work, limit, is_refused) = (Cell::new(0), Cell::new(u64::MAX), Arc::default());
        Clock { timer: Box::new(timer), timeout, work, limit, total: u64::MAX, is_refused }
    }

    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    pub fn new(timeout: Duration) -> Self {
        Clock::with(Wall(std::time::Instant::now().checked_add(timeout)), timeout)
    }

    #[cfg(all(target_family = "wasm", target_os = "unknown"))]
    pub fn new(timeout: Duration) -> Self {
        Clock::counted(timeout)
    }

    #[cfg(any(test, all(target_family = "wasm", target_os = "unknown")))]
    pub fn counted(timeout: Duration) -> Self {
        Clock::with(Counted(u64::try_from(timeout.as_nanos()).unwrap_or(u64::MAX)), timeout)
    }

    /// With the work that texts of so many bytes may be: a short text costs seconds at most.
    pub fn of_texts(timeout: Duration, bytes: usize) -> Self {
        let mut clock = Clock::new(timeout);
        clock.total = Clock::allowed(bytes);
        clock
    }

    /// The work that a check of texts of so many bytes may be.
    pub fn allowed(bytes: usize) -> u64 {
        WORK.saturating_add(WORK_OF_BYTE.saturating_mul(bytes as u64))
    }

    /// An error for what would be too much, which is told from what is wrong.
    pub fn refuse(&self, reason: &str) -> String {
        self.is_refused.store(true, Ordering::Relaxed);
        reason.to_owned()
    }

    /// Says whether a bound of work or of memory was reached.
    pub fn refusals(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.is_refused)
    }

    /// Refuses numbers that take too many bytes together, before they are computed.
    pub fn hold(&self, count: usize, bits: u64) -> Result<(), String> {
        let bytes = (count as u64).saturating_mul(bits / 8 + BYTES_OF_NUMBER);
        if bytes > MEMORY { Err(self.refuse("the numbers of a step would take too much memory")) } else { Ok(()) }
    }

    /// One small step.
    pub fn tick(&self) -> Result<(), String> {
        self.spend(1, 0, 0)
    }

    /// Counts operations on numbers of so many bits before they are done.
    pub fn spend(&self, count: usize, bits: u64, others: u64) -> Result<(), String> {
        let words = (1 + bits / 64).saturating_mul(1 + others / 64);
        let work = self.work.get().saturating_add((count as u64).saturating_mul(words.saturating_add(100)));
        self.work.set(work);
        if work >= self.limit.get() {
            return Err(self.refuse("the model takes too much work to read"));
        }
        if work >= self.total {
            return Err(self.refuse("the check is more work than texts of this length may ask for"));
        }
        if self.timer.is_over(work) { Err(out_of_time(self.timeout)) } else { Ok(()) }
    }

    /// The work counted so far.
    pub fn work(&self) -> u64 {
        self.work.get()
    }

    /// The reading of a model, by counted work.
    pub fn reading<T>(&self, read: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
        self.limit.set(self.work.get().saturating_add(MODEL_WORK));
        let result = read();
        self.limit.set(u64::MAX);
        result
    }
}

pub(super) fn out_of_time(timeout: Duration) -> String {
    format!("the check takes longer than {} s", timeout.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counted_work_ends_where_it_is_said_to() {
        let clock = Clock::counted(Duration::from_micros(1));
        // 101 units each: the tenth is beyond 1000.
        assert_eq!((0..20).take_while(|_| clock.tick().is_ok()).count(), 9);
        assert!(Clock::counted(Duration::MAX).spend(usize::MAX, 1, 1).is_err());
    }

    #[test]
    fn the_reading_of_a_model_ends_by_its_work() {
        let clock = Clock::new(Duration::MAX);
        let long = || clock.spend(1, 1 << 30, 1 << 30);
        assert!(clock.reading(long).is_err());
        assert!(long().is_ok());
    }
}
