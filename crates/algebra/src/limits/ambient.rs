//! How a budget reaches the kernels: it is installed on the thread, and inner loops ask it now and then.

use super::{Budget, Exhausted, Limits};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Units of work between two looks at the limits: about a millisecond.
const QUANTUM: u64 = 1 << 16;

/// Pieces of memory below this many bytes are not asked about.
const CLAIMED: u64 = 1 << 20;

/// A limit that holds on this thread, and those around it.
struct Frame {
    limits: Arc<Limits>,
    outer: Option<Arc<Frame>>,
}

thread_local! {
    /// Units that may be used before the next look.
    static LEFT: Cell<u64> = const { Cell::new(u64::MAX) };
    /// What `LEFT` was at the last look.
    static GRANTED: Cell<u64> = const { Cell::new(u64::MAX) };
    static INNERMOST: RefCell<Option<Arc<Frame>>> = const { RefCell::new(None) };
    /// Whether work may be ended at any time, and not for its memory alone.
    static HURRIED: Cell<bool> = const { Cell::new(false) };
}

/// What leaves a kernel: the message, and whose door it is to leave by.
struct Unwinding {
    exhausted: Exhausted,
    limits: Arc<Limits>,
}

/// Counts work against the budgets that hold on this thread and leaves the computation, through the door
/// [`Budget::enter`], when one of them has run out.
///
/// A unit is about ten nanoseconds: an operation on small integers, or a handful of operations on machine words. Loops
/// in the kernels call this with an estimate; a call costs a subtraction and a comparison, and every 2^16 units a look
/// at the clock and the flag of cancellation. Without a budget it does nothing.
///
/// The computation is left by unwinding, as a panic does, but without a message and without the panic hook; where
/// programs are built to abort on panic (`wasm32-unknown-unknown`) it is not left: there budgets end between the
/// steps of an algorithm.
///
/// ```
/// use jurist_algebra::limits::{Budget, checkpoint};
/// let endless = || -> u64 {
///     loop {
///         checkpoint(1)
///     }
/// };
/// assert!(Budget::with_work(100_000).enter(endless).is_err());
/// ```
#[inline]
pub fn checkpoint(units: u64) {
    LEFT.with(|left| match left.get().checked_sub(units) {
        Some(rest) => left.set(rest),
        None => look(units),
    });
}

/// Announces that so many bytes are about to be taken in one piece, and leaves the computation as [`checkpoint`] does
/// where a budget does not allow them.
///
/// What grows bit by bit is seen by the looks that [`checkpoint`] takes; this is for what would be there at once: a
/// table, the terms of an expansion. Less than a megabyte is not asked about, so that a claim costs a comparison.
///
/// ```
/// use jurist_algebra::limits::{Budget, claim};
/// let table = |rows: u64| {
///     claim(8 * rows * rows);
///     vec![0u64; (rows * rows) as usize]
/// };
/// let budget = Budget::with_memory(100_000_000);
/// assert!(budget.enter(|| table(1000)).is_ok());
/// assert!(budget.enter(|| table(1_000_000)).is_err());
/// ```
#[inline]
pub fn claim(bytes: u64) {
    if bytes >= CLAIMED {
        ask(bytes);
    }
}

#[cold]
#[inline(never)]
fn ask(bytes: u64) {
    let Some(frame) = INNERMOST.with_borrow(Option::clone) else { return };
    let refused = frame.first(|limits| limits.room(bytes));
    if let (Some(stop), true) = (refused, cfg!(panic = "unwind")) {
        resume_unwind(Box::new(stop));
    }
}

/// Whether a budget of time or work holds on this thread, so that it pays to do work in pieces.
#[inline]
pub(crate) fn is_limited() -> bool {
    HURRIED.with(Cell::get)
}

#[cold]
#[inline(never)]
fn look(units: u64) {
    let Some(frame) = INNERMOST.with_borrow(Option::clone) else {
        return grant(u64::MAX);
    };
    let spent = GRANTED.with(Cell::get) - LEFT.with(Cell::get);
    let stop = frame.charge(spent.saturating_add(units));
    grant(frame.quantum());
    if let (Some(stop), true) = (stop, cfg!(panic = "unwind")) {
        resume_unwind(Box::new(stop));
    }
}

fn grant(units: u64) {
    GRANTED.set(units);
    LEFT.set(units);
}

impl Frame {
    /// Counts work; the first limit that has run out, from the inside.
    fn charge(&self, units: u64) -> Option<Unwinding> {
        // A share counts for the whole, whose own frame may be further out.
        let mut counted = Vec::new();
        self.first(|limits| limits.spend_once(units, &mut counted))
    }

    /// Asks all limits from the inside; the first that has run out.
    fn first(&self, mut ask: impl FnMut(&Limits) -> Result<(), Exhausted>) -> Option<Unwinding> {
        let mut stop = None;
        let mut next = Some(self);
        while let Some(frame) = next {
            if let Err(exhausted) = ask(&frame.limits)
                && stop.is_none()
            {
                stop = Some(Unwinding { exhausted, limits: Arc::clone(&frame.limits) });
            }
            next = frame.outer.as_deref();
        }
        stop
    }

    /// Units until the next look: fewer when a count is about to end.
    fn quantum(&self) -> u64 {
        let mut least = QUANTUM;
        let mut next = Some(self);
        while let Some(frame) = next {
            least = least.min(frame.limits.work_left());
            next = frame.outer.as_deref();
        }
        least
    }

    fn hurries(&self) -> bool {
        self.limits.hurry() || self.outer.as_ref().is_some_and(|outer| outer.hurries())
    }

    fn holds(&self, limits: &Arc<Limits>) -> bool {
        Arc::ptr_eq(&self.limits, limits) || self.outer.as_ref().is_some_and(|outer| outer.holds(limits))
    }
}

/// Puts back what held on the thread before, also when the computation is left.
struct Installed {
    before: Option<Arc<Frame>>,
}

impl Installed {
    fn new(frame: Option<Arc<Frame>>) -> Installed {
        settle();
        let before = INNERMOST.replace(frame);
        renew();
        Installed { before }
    }
}

impl Drop for Installed {
    fn drop(&mut self) {
        settle();
        INNERMOST.set(self.before.take());
        renew();
    }
}

/// Counts what was used since the last look, without leaving.
fn settle() {
    let spent = GRANTED.get() - LEFT.get();
    if spent > 0 {
        INNERMOST.with_borrow(|frame| frame.as_ref().map(|frame| frame.charge(spent)));
    }
}

fn renew() {
    INNERMOST.with_borrow(|frame| {
        grant(frame.as_ref().map_or(u64::MAX, |frame| frame.quantum()));
        HURRIED.set(frame.as_ref().is_some_and(|frame| frame.hurries()));
    });
}

impl Budget {
    /// Does work that this budget ends: the door through which kernels are left when it runs out.
    ///
    /// Inside, every [`checkpoint`] asks this budget and those entered before it; budgets in signatures further down
    /// need not be passed on. Work on several threads has to be started by [`join`] or [`parallel_map`].
    /// Entering costs some tens of nanoseconds. What the work has changed when it is left stays changed: it should
    /// build values, not alter them.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::{Domain, UniPoly};
    /// let (a, b) = (UniPoly::from_i64(&[-1, 0, 1]), UniPoly::from_i64(&[1, 2, 1]));
    /// let g = Budget::unlimited().enter(|| a.gcd(&b)).unwrap();
    /// assert_eq!(g, UniPoly::from_i64(&[1, 1]));
    /// ```
    ///
    /// # Errors
    /// [`Exhausted`] when this budget runs out, also when its time is up before the work begins.
    pub fn enter<T>(&self, work: impl FnOnce() -> T) -> Result<T, Exhausted> {
        let mut work = Work::new(work);
        self.enter_with(&mut || work.run())?;
        Ok(work.done())
    }

    /// Does work that this budget ends, as [`Budget::enter`] does, but begins it also when the budget has run out already.
    ///
    /// A program does all its work inside of this call. A budget that runs out inside of an inner [`Budget::enter`] ends that
    /// call, which answers with its partial result; all other work ends here.
    ///
    /// ```
    /// use jurist_algebra::limits::{Budget, checkpoint};
    /// use std::time::Duration;
    /// let spent = Budget::with_timeout(Duration::ZERO);
    /// assert_eq!(spent.surround(|| spent.enter(|| 1).is_err()), Ok(true));
    /// assert!(spent.surround(|| checkpoint(1 << 20)).is_err());
    /// ```
    ///
    /// # Errors
    /// [`Exhausted`] when this budget runs out.
    pub fn surround<T>(&self, work: impl FnOnce() -> T) -> Result<T, Exhausted> {
        let mut work = Work::new(work);
        self.leave_by_this_door(&mut || work.run())?;
        Ok(work.done())
    }

    /// One function for all work: hundreds of copies would be a tenth of the program.
    fn enter_with(&self, work: &mut dyn FnMut()) -> Result<(), Exhausted> {
        if let Some(limits) = &self.limits {
            limits.spend(0).map_err(|e| self.at_step(e))?;
        }
        self.leave_by_this_door(work)
    }

    fn leave_by_this_door(&self, work: &mut dyn FnMut()) -> Result<(), Exhausted> {
        let Some(limits) = &self.limits else {
            work();
            return Ok(());
        };
        let frame = INNERMOST.with_borrow(|frame| match frame {
            Some(frame) if frame.holds(limits) => Arc::clone(frame),
            outer => Arc::new(Frame { limits: Arc::clone(limits), outer: outer.clone() }),
        });
        let work = || {
            let _installed = Installed::new(Some(frame));
            work()
        };
        // A value that was being altered is dropped with the closure or seen by a caller who was told so above.
        catch_unwind(AssertUnwindSafe(work)).map_err(|payload| match payload.downcast::<Unwinding>() {
            Ok(stop) if Arc::ptr_eq(&stop.limits, limits) => self.at_step(stop.exhausted),
            Ok(stop) => resume_unwind(stop),
            Err(panic) => resume_unwind(panic),
        })
    }
}

/// Work that is done once, through a door that knows nothing of its value.
struct Work<F, T> {
    work: Option<F>,
    value: Option<T>,
}

impl<T, F: FnOnce() -> T> Work<F, T> {
    fn new(work: F) -> Self {
        Work { work: Some(work), value: None }
    }

    fn run(&mut self) {
        if let Some(work) = self.work.take() {
            self.value = Some(work());
        }
    }

    fn done(self) -> T {
        self.value.expect("a door that is not left by unwinding has done the work")
    }
}

/// What holds on a thread, to be taken to another one.
struct Ambient(Option<Arc<Frame>>);

impl Ambient {
    fn current() -> Ambient {
        Ambient(INNERMOST.with_borrow(Option::clone))
    }

    fn run(&self, work: impl FnOnce()) {
        let _installed = Installed::new(self.0.clone());
        work()
    }
}

/// Does two pieces of work, on two threads where there are as many; the budgets that hold here hold for both.
///
/// ```
/// use jurist_algebra::limits::{Budget, checkpoint, join};
/// let endless = || -> u64 {
///     loop {
///         checkpoint(1)
///     }
/// };
/// assert!(Budget::with_work(100_000).enter(|| join(endless, endless)).is_err());
/// ```
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    let (mut a, mut b) = (Work::new(a), Work::new(b));
    join_both(&mut || a.run(), &mut || b.run());
    (a.done(), b.done())
}

fn join_both(a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
    let ambient = Ambient::current();
    rayon::join(|| ambient.run(a), || ambient.run(b));
}

/// The images of all items in their order, computed on as many threads as there are; the budgets that hold here hold
/// for all of them. All are computed, also where `C` is a `Result`: then the first error in their order is returned.
///
/// ```
/// use jurist_algebra::limits::parallel_map;
/// let squares: Vec<u64> = parallel_map(0..4u64, |x| x * x);
/// assert_eq!(squares, [0, 1, 4, 9]);
/// ```
pub fn parallel_map<I, T, C>(items: I, f: impl Fn(I::Item) -> T + Send + Sync) -> C
where
    I: IntoIterator<Item: Send>,
    T: Send,
    C: FromIterator<T>,
{
    let works: Vec<_> = items.into_iter().map(|item| Mutex::new(Work::new(|| f(item)))).collect();
    // Each is locked by the one thread that does it.
    parallel_each(works.len(), &|k| works[k].lock().unwrap_or_else(PoisonError::into_inner).run());
    works.into_iter().map(|work| work.into_inner().unwrap_or_else(PoisonError::into_inner).done()).collect()
}

fn parallel_each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    let ambient = Ambient::current();
    // Rayon begins what waits also when a part has been left: a thousand parts that each end at their first look take a second together.
    let is_left = AtomicBool::new(false);
    (0..count).into_par_iter().for_each(|k| {
        if !is_left.load(Ordering::Relaxed) {
            let leaving = Leaving(&is_left);
            ambient.run(|| work(k));
            std::mem::forget(leaving);
        }
    });
}

/// Tells others when it is dropped: when its part of the work is left.
struct Leaving<'a>(&'a AtomicBool);

impl Drop for Leaving<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Does work that no budget of this thread ends: as if it began on a thread of its own.
///
/// A thread that waits for its part of parallel work takes up other work meanwhile, whoever gave it. What begins there is
/// nobody's part: a question of its own has to begin with this, where questions share the threads of a pool.
///
/// ```
/// use jurist_algebra::limits::{Budget, apart, checkpoint};
/// let budget = Budget::with_work(100);
/// assert_eq!(budget.enter(|| apart(|| checkpoint(1_000_000))), Ok(()));
/// ```
pub fn apart<T>(work: impl FnOnce() -> T) -> T {
    let mut work = Work::new(work);
    apart_with(&mut || work.run());
    work.done()
}

fn apart_with(work: &mut dyn FnMut()) {
    Ambient(None).run(work)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Stop;
    use std::panic::panic_any;
    use std::sync::atomic::AtomicU64;

    fn endless() -> u64 {
        loop {
            checkpoint(7);
        }
    }

    /// The door of the whole is around that of a share: as at the outermost door of the program.
    #[test]
    fn the_work_of_a_share_is_counted_once() {
        let whole = Budget::with_work(10_000_000);
        let counted = whole.surround(|| {
            whole.share(1, 2).share(1, 2).enter(|| checkpoint(1_000_000)).unwrap();
            whole.work_done().unwrap()
        });
        assert_eq!(counted, Ok(1_000_000));
    }

    #[test]
    fn counted_work_ends_at_its_count() {
        for units in [1, 10, QUANTUM - 1, QUANTUM, 10 * QUANTUM + 3] {
            let done = Cell::new(0);
            let work = || {
                loop {
                    checkpoint(1);
                    done.set(done.get() + 1);
                }
            };
            let end: Result<(), Exhausted> = Budget::with_work(units).enter(work);
            assert_eq!(end.unwrap_err().stop, Stop::Work(units));
            assert_eq!(done.get(), units);
        }
        let enough = Budget::with_work(100);
        assert_eq!(enough.enter(|| checkpoint(100)), Ok(()));
        assert!(enough.enter(|| checkpoint(1)).is_err());
    }

    #[test]
    fn a_door_lets_out_only_its_own() {
        let outer = Budget::with_work(1000);
        let inner = Budget::with_work(1_000_000_000);
        // The outer budget ends inside the inner door, and leaves by its own.
        assert!(outer.enter(|| inner.enter(endless).is_ok()).is_err());
        // The inner budget ends, and what is around it goes on.
        let (outer, inner) = (Budget::with_work(1_000_000_000), Budget::with_work(1000));
        assert_eq!(outer.enter(|| inner.enter(endless).is_err()), Ok(true));
        // The same budget again: the inner door is as good as the outer.
        let budget = Budget::with_work(1000);
        assert_eq!(budget.enter(|| budget.enter(endless).is_err()), Ok(true));
        assert!(Budget::unlimited().enter(|| outer.share(1, 1000).enter(endless).is_err()).unwrap());
    }

    #[test]
    fn what_is_done_apart_has_its_own_budget_only() {
        let (other, own) = (Budget::with_work(1000), Budget::with_work(1_000_000));
        let ended = other.enter(|| apart(|| own.enter(endless)));
        assert_eq!(ended.unwrap().unwrap_err().stop, Stop::Work(1_000_000));
        // What is around it counts on as before.
        assert!(other.enter(|| (checkpoint(900), apart(|| checkpoint(1_000_000)))).is_ok());
        assert!(other.enter(|| checkpoint(200)).is_err());
        assert!(!is_limited());
    }

    #[test]
    fn work_inside_counts_outside_once() {
        let outer = Budget::with_work(1000);
        let inner = outer.clone();
        assert!(outer.enter(|| inner.enter(|| checkpoint(600))).is_ok());
        assert!(outer.enter(|| checkpoint(300)).is_ok());
        assert!(outer.enter(|| checkpoint(200)).is_err());
    }

    #[test]
    fn panics_pass_through_and_the_thread_is_as_before() {
        let budget = Budget::with_work(1000);
        let panic = catch_unwind(AssertUnwindSafe(|| budget.enter(|| panic_any(42u8))));
        assert_eq!(panic.unwrap_err().downcast_ref(), Some(&42u8));
        assert!(!is_limited());
        assert!(budget.enter(endless).is_err());
        assert!(!is_limited());
        checkpoint(u64::MAX);
        checkpoint(u64::MAX);
    }

    #[test]
    fn leaving_does_not_call_the_panic_hook() {
        // The hook belongs to all tests of the process: it only counts, and asks whose thread it is.
        static CALLS: AtomicU64 = AtomicU64::new(0);
        let here = std::thread::current().id();
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if std::thread::current().id() == here {
                CALLS.fetch_add(1, Ordering::Relaxed);
            }
            before(info);
        }));
        assert!(Budget::with_work(10).enter(endless).is_err());
        assert_eq!(CALLS.load(Ordering::Relaxed), 0);
    }

    #[test]
    fn other_threads_inherit_the_budget() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("threads");
        let budget = Budget::with_work(1_000_000);
        let work = || pool.install(|| budget.enter(|| parallel_map::<_, _, Vec<u64>>(0..8, |_: i32| endless())));
        assert!(work().is_err());
        let flag = Arc::new(AtomicBool::new(false));
        let cancelled = Budget::unlimited().cancelled_by(Arc::clone(&flag));
        let begun = AtomicBool::new(false);
        let wait = || {
            begun.store(true, Ordering::SeqCst);
            endless()
        };
        std::thread::scope(|scope| {
            let end = scope.spawn(|| pool.install(|| cancelled.enter(|| join(wait, endless))));
            while !begun.load(Ordering::SeqCst) {
                std::thread::yield_now();
            }
            flag.store(true, Ordering::Relaxed);
            assert_eq!(end.join().expect("no panic").unwrap_err().stop, Stop::Cancelled);
        });
    }

    #[test]
    fn what_waits_is_not_begun_when_a_part_is_left() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
        let begun = AtomicU64::new(0);
        let part = |_: i32| {
            begun.fetch_add(1, Ordering::Relaxed);
            checkpoint(1 << 20)
        };
        let work = || Budget::with_work(1000).enter(|| parallel_map::<_, _, Vec<()>>(0..10_000, part));
        assert!(pool.install(work).is_err());
        assert!(begun.into_inner() <= 2, "each of two threads begins one part at most");
    }

    #[test]
    fn work_of_all_threads_is_counted_to_the_unit() {
        for threads in [1, 2, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let run = |units| {
                let budget = Budget::with_work(units);
                pool.install(|| budget.enter(|| parallel_map::<_, _, Vec<()>>(0..100, |_: i32| checkpoint(1000))))
            };
            assert!(run(100_000).is_ok());
            assert!(run(99_000).is_err());
        }
    }
}
