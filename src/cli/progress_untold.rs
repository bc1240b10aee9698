//! Where there is no terminal and no clock (WebAssembly) nothing is drawn: who captures a command listens by its budget.

use crate::cli::arguments::RunOptions;
use jurist_algebra::limits::Budget;
use std::sync::Arc;
use std::time::Duration;

/// Listens to nothing.
pub(super) struct Reporter;

impl Reporter {
    /// One that is never asked anything.
    pub fn new(_: &RunOptions) -> Arc<Self> {
        Arc::new(Reporter)
    }

    /// The budget that the options grant.
    pub fn budget(self: &Arc<Self>, options: &RunOptions) -> Budget {
        let budget = options.timeout.map_or_else(Budget::unlimited, Budget::with_timeout);
        let budget = budget.within_memory(options.memory());
        options.work.map_or(budget.clone(), |units| budget.within_work(units))
    }

    /// No time passes.
    pub fn elapsed(&self) -> Duration {
        Duration::ZERO
    }

    /// There is nothing in the way.
    pub fn aside<T>(&self, write: impl FnOnce() -> T) -> T {
        write()
    }

    /// There is nothing to take away.
    pub fn finish(&self) {}

    /// Nobody is told.
    pub fn tell_work(&self, _: &Budget) {}
}
