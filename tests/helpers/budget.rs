//! Budgets that end at a place in the work, not at a time; and work that has no end.

use super::random::Random;
use jurist_algebra::limits::{Budget, Progress};
use std::fmt::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// A budget that is spent before the work begins.
pub fn spent() -> Budget {
    Budget::with_timeout(Duration::ZERO)
}

/// Listens to the work and cancels it.
struct Canceller {
    flag: Arc<AtomicBool>,
    step: Option<&'static str>,
    reports: AtomicU64,
}

impl Progress for Canceller {
    fn step(&self, name: &str) {
        if self.step == Some(name) {
            self.flag.store(true, Ordering::Relaxed);
        }
    }

    fn advance(&self, _: u64, _: u64) {
        // The count wraps where a step is waited for: that is after more reports than anybody makes.
        if self.step.is_none() && self.reports.fetch_sub(1, Ordering::Relaxed) == 1 {
            self.flag.store(true, Ordering::Relaxed);
        }
    }
}

fn cancelled(step: Option<&'static str>, reports: u64) -> Budget {
    let flag = Arc::new(AtomicBool::new(false));
    let canceller = Canceller { flag: Arc::clone(&flag), step, reports: AtomicU64::new(reports) };
    Budget::unlimited().cancelled_by(flag).reporting_to(Arc::new(canceller))
}

/// A budget that is cancelled when the step of this name begins.
pub fn cancelled_at(step: &'static str) -> Budget {
    cancelled(Some(step), 0)
}

/// A budget that is cancelled at the report of this number on how much of a step is done.
pub fn cancelled_after(reports: u64) -> Budget {
    cancelled(None, reports)
}

/// A model whose answers no machine will see: the curve of complex pairs alone is of degree 3000, with
/// coefficients of thousands of digits, and is still to be isolated. Reading it is little work.
pub fn endless_model() -> String {
    let mut random = Random::new(7);
    let mut text = String::from("time = 'discrete'\nparameters.K = 1\nloop.characteristic = '0");
    for i in 0..=100 {
        for j in 0..=30 {
            let _ = write!(text, " + {}*K^{j}*z^{i}", 1_000_000_000 + random.below(1_000_000_000));
        }
    }
    text + "'\n"
}
