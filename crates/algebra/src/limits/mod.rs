//! Budgets and progress: long work takes a [`Budget`] and asks it, step by step, whether to go on; what runs inside
//! one that was [entered](Budget::enter) asks it by [`checkpoint`].
//!
//! A budget never changes an answer: work either ends with the exact result or stops with
//! [`Exhausted`], which names the budget that ran out.

mod ambient;
mod clock;
mod memory;
mod precisions;
mod stop;

pub(crate) use ambient::is_limited;
pub use ambient::{apart, checkpoint, claim, join, parallel_map};
pub use clock::Clock;
pub use memory::{Gauge, gauge_of_the_process, measure_by};
pub use precisions::{Precisions, doubling, try_until_shown, until_shown};
pub use stop::{Exhausted, Stop};

use memory::Memory;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Receives the name of the step that begins and, where known, its share done (0 to 1).
///
/// ```
/// use jurist_algebra::limits::{Budget, Progress};
/// use std::sync::{Arc, Mutex};
///
/// #[derive(Default)]
/// struct Log(Mutex<Vec<String>>);
/// impl Progress for Log {
///     fn step(&self, name: &str) {
///         self.0.lock().unwrap().push(name.to_owned());
///     }
///     fn advance(&self, _done: u64, _total: u64) {}
/// }
///
/// let log = Arc::new(Log::default());
/// Budget::unlimited().reporting_to(log.clone()).step("isolating");
/// assert_eq!(*log.0.lock().unwrap(), ["isolating"]);
/// ```
pub trait Progress: Send + Sync {
    /// A new step begins.
    fn step(&self, name: &str);
    /// `done` of `total` parts of the current step are finished.
    fn advance(&self, done: u64, total: u64);
}

/// How much time, work or memory a computation may take, and whom it tells how far it is.
///
/// Algorithms that name their steps take a budget and ask it between them; kernels (products, divisors, resultants,
/// isolation) ask the one that was [entered](Budget::enter) on their thread.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use std::time::Duration;
/// assert!(Budget::unlimited().check().is_ok());
/// assert!(Budget::with_timeout(Duration::ZERO).check().is_err());
/// ```
#[derive(Clone, Default)]
pub struct Budget {
    /// `None` where there is no limit.
    limits: Option<Arc<Limits>>,
    progress: Option<Arc<dyn Progress>>,
    reached: Arc<Mutex<Reached>>,
    /// Steps are told to nobody.
    silent: bool,
}

/// The step that began last, and how much of it is done.
#[derive(Default)]
struct Reached {
    step: String,
    done: u64,
    total: u64,
    /// How often somebody was told that the budget is over.
    refusals: u64,
}

/// When a budget ends.
#[derive(Clone, Default)]
struct Limits {
    deadline: Option<Deadline>,
    /// The innermost share first: work counts for all of them.
    work: Vec<Arc<Work>>,
    memory: Option<Memory>,
    cancelled: Option<Arc<AtomicBool>>,
}

#[derive(Clone)]
struct Deadline {
    clock: Arc<dyn Clock>,
    end: Duration,
    /// The whole time, for the message.
    timeout: Duration,
}

/// A count of work.
struct Work {
    left: AtomicU64,
    /// The whole, for the message.
    units: u64,
}

impl Limits {
    /// Counts work and asks whether more may be done.
    fn spend(&self, units: u64) -> Result<(), Exhausted> {
        self.spend_once(units, &mut Vec::new())
    }

    /// The same for several limits of one piece of work: what `counted` holds has it already.
    fn spend_once(&self, units: u64, counted: &mut Vec<*const Work>) -> Result<(), Exhausted> {
        let mut out = None;
        for work in &self.work {
            if counted.contains(&Arc::as_ptr(work)) {
                continue;
            }
            counted.push(Arc::as_ptr(work));
            let rest =
                work.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| Some(left.saturating_sub(units)));
            if rest.is_ok_and(|before| before < units) {
                out = Some(work.units);
            }
        }
        if let Some(units) = out {
            return Err(Exhausted::of(Stop::Work(units)));
        }
        if let Some(Deadline { clock, end, timeout }) = &self.deadline
            && clock.now() >= *end
        {
            return Err(Exhausted::of(Stop::Time(*timeout)));
        }
        self.room(0)?;
        if self.cancelled.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return Err(Exhausted::of(Stop::Cancelled));
        }
        Ok(())
    }

    /// Whether there is a limit of something else than memory.
    fn hurry(&self) -> bool {
        self.deadline.is_some() || !self.work.is_empty() || self.cancelled.is_some()
    }

    /// Asks whether so many bytes may be taken.
    fn room(&self, bytes: u64) -> Result<(), Exhausted> {
        self.memory.as_ref().map_or(Ok(()), |memory| memory.room(bytes))
    }

    fn work_left(&self) -> u64 {
        self.work.iter().map(|work| work.left.load(Ordering::Relaxed)).min().unwrap_or(u64::MAX)
    }
}

impl Budget {
    /// No limit of time or work, no progress reports.
    pub fn unlimited() -> Self {
        Budget::default()
    }

    fn limited(limits: Limits) -> Self {
        Budget { limits: Some(Arc::new(limits)), ..Budget::default() }
    }

    /// Work may go on for `timeout` from now, by the clock of the system; without end where there is none that may be
    /// read (`wasm32-unknown-unknown`: see [`Budget::with_timeout_on`]), and for a time beyond counting.
    pub fn with_timeout(timeout: Duration) -> Self {
        match clock::system() {
            Some(clock) => Budget::with_timeout_on(clock, timeout),
            None => Budget::unlimited(),
        }
    }

    /// Work may go on for `timeout` from now, by the given clock.
    pub fn with_timeout_on(clock: Arc<dyn Clock>, timeout: Duration) -> Self {
        match clock.now().checked_add(timeout) {
            Some(end) => {
                Budget::limited(Limits { deadline: Some(Deadline { clock, end, timeout }), ..Limits::default() })
            }
            None => Budget::unlimited(),
        }
    }

    /// So much work may be done, in the units of [`checkpoint`], and not more, however fast the machine is; each
    /// [`check`](Budget::check) is a unit. On several threads the sum counts.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// let budget = Budget::with_work(2);
    /// assert!(budget.check().is_ok() && budget.check().is_ok());
    /// assert_eq!(budget.check().unwrap_err().to_string(), "the budget ran out: work (2 units); reached: nothing was begun");
    /// ```
    pub fn with_work(units: u64) -> Self {
        Budget::limited(Limits { work: vec![Arc::new(Work { left: units.into(), units })], ..Limits::default() })
    }

    /// No more than so many bytes may be in use, as the gauge of the process shows them ([`measure_by`]); where there is
    /// none, no value may be larger. What is in use already counts, and so does what other threads use.
    ///
    /// ```
    /// use jurist_algebra::limits::{Budget, Stop, claim};
    /// let budget = Budget::with_memory(10_000_000);
    /// assert!(budget.enter(|| claim(9_000_000)).is_ok());
    /// assert_eq!(budget.enter(|| claim(11_000_000)).unwrap_err().stop, Stop::Memory(10_000_000));
    /// ```
    pub fn with_memory(bytes: u64) -> Self {
        Budget::unlimited().within_memory(bytes)
    }

    /// The same budget, also with a limit of memory as of [`Budget::with_memory`].
    pub fn within_memory(self, bytes: u64) -> Self {
        self.limiting_memory(Memory { gauge: gauge_of_the_process(), bytes })
    }

    /// The same budget, also with a limit of memory, by the given gauge.
    pub fn within_memory_on(self, gauge: Arc<dyn Gauge>, bytes: u64) -> Self {
        self.limiting_memory(Memory { gauge: Some(gauge), bytes })
    }

    fn limiting_memory(mut self, memory: Memory) -> Self {
        let limits = self.limits.as_deref().cloned().unwrap_or_default();
        self.limits = Some(Arc::new(Limits { memory: Some(memory), ..limits }));
        self
    }

    /// A budget that ends when `part / of` of the time and of the work that are left are used up; without end where
    /// there is no limit. When it runs out it names the whole. What it uses is used of the whole.
    ///
    /// # Panics
    /// When `of` is 0.
    pub fn share(&self, part: u32, of: u32) -> Self {
        assert!(of > 0, "a share of nothing");
        let mut share = self.clone();
        if let Some(limits) = &self.limits {
            let mut limits = Limits::clone(limits);
            if let Some(Deadline { clock, end, .. }) = &mut limits.deadline {
                let now = clock.now();
                *end = now.saturating_add(end.saturating_sub(now) / of * part);
            }
            if let Some(whole) = limits.work.first() {
                let left = u128::from(limits.work_left()) * u128::from(part) / u128::from(of);
                let left = u64::try_from(left).unwrap_or(u64::MAX);
                let units = whole.units;
                limits.work.insert(0, Arc::new(Work { left: left.into(), units }));
            }
            share.limits = Some(Arc::new(limits));
        }
        share
    }

    /// The same budget, also ended by so much work in the units of [`checkpoint`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// let budget = Budget::unlimited().within_work(5);
    /// budget.check()?;
    /// assert_eq!(budget.work_done(), Some(1));
    /// # Ok::<(), jurist_algebra::limits::Exhausted>(())
    /// ```
    pub fn within_work(mut self, units: u64) -> Self {
        let mut limits = self.limits.as_deref().cloned().unwrap_or_default();
        limits.work.push(Arc::new(Work { left: units.into(), units }));
        self.limits = Some(Arc::new(limits));
        self
    }

    /// The units of work that were counted against the whole of a budget of work, and `None` where work is not counted.
    pub fn work_done(&self) -> Option<u64> {
        let whole = self.limits.as_ref()?.work.last()?;
        Some(whole.units - whole.left.load(Ordering::Relaxed))
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

    /// The same budget, also ended by setting `flag`: the way to cancel from another thread.
    pub fn cancelled_by(mut self, flag: Arc<AtomicBool>) -> Self {
        let limits = self.limits.as_deref().cloned().unwrap_or_default();
        self.limits = Some(Arc::new(Limits { cancelled: Some(flag), ..limits }));
        self
    }

    /// Whether work may go on.
    ///
    /// # Errors
    /// [`Exhausted`] when the time is up, the work is done, the memory is used, or it was cancelled.
    pub fn check(&self) -> Result<(), Exhausted> {
        self.limits.as_ref().map_or(Ok(()), |limits| limits.spend(1)).map_err(|e| self.at_step(e))
    }

    /// How often work was told that this budget is over, or a share of it.
    pub fn refusals(&self) -> u64 {
        self.reached.lock().unwrap_or_else(PoisonError::into_inner).refusals
    }

    /// What ran out, and how far the work came.
    fn at_step(&self, exhausted: Exhausted) -> Exhausted {
        self.reached.lock().unwrap_or_else(PoisonError::into_inner).refusals += 1;
        Exhausted { step: self.reached(), ..exhausted }
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
        let mut reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        *reached = Reached { step: name.to_owned(), refusals: reached.refusals, ..Reached::default() };
        drop(reached);
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
        let deadline = self.limits.as_ref().and_then(|limits| limits.deadline.as_ref());
        f.debug_struct("Budget").field("timeout", &deadline.map(|d| d.timeout)).finish_non_exhaustive()
    }
}
