//! The threads that questions are answered on: a pool of the package's own, begun anew after a fork.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Expressions and matrices nest deeper than a default stack allows.
const STACK: usize = 64 << 20;

/// Pools are never taken down, since after a fork their threads do not exist and could not be waited for: the one in
/// use is that of the present generation.
struct Generation {
    pool: OnceLock<Result<ThreadPool, String>>,
    next: OnceLock<Box<Generation>>,
}

impl Generation {
    const fn new() -> Generation {
        Generation { pool: OnceLock::new(), next: OnceLock::new() }
    }
}

static FIRST: Generation = Generation::new();
static GENERATION: AtomicUsize = AtomicUsize::new(0);
/// How many threads are wished for; 0 for as many as there are cores.
static WISHED: AtomicUsize = AtomicUsize::new(0);

/// The pool of the present generation.
pub(crate) fn pool() -> PyResult<&'static ThreadPool> {
    let mut generation = &FIRST;
    for _ in 0..GENERATION.load(Ordering::Acquire) {
        generation = generation.next.get_or_init(|| Box::new(Generation::new()));
    }
    let made = generation.pool.get_or_init(|| {
        let builder = ThreadPoolBuilder::new().num_threads(WISHED.load(Ordering::Acquire)).stack_size(STACK);
        builder.thread_name(|i| format!("jurist-{i}")).build().map_err(|e| e.to_string())
    });
    made.as_ref().map_err(|why| PyRuntimeError::new_err(format!("no threads can be started: {why}")))
}

/// The number of threads from now on; 0 for as many as there are cores.
#[pyfunction]
pub(crate) fn set_threads(count: usize) {
    WISHED.store(count, Ordering::Release);
    renew_threads();
}

/// Forgets the pool, whose threads a forked process does not have.
#[pyfunction]
pub(crate) fn renew_threads() {
    GENERATION.fetch_add(1, Ordering::AcqRel);
}

/// The number of threads that questions are answered on.
#[pyfunction]
pub(crate) fn threads() -> PyResult<usize> {
    Ok(pool()?.current_num_threads())
}
