//! The clock behind a budget.

use std::time::Duration;

/// A clock that never goes backwards.
///
/// [`Budget::with_timeout`](super::Budget::with_timeout) reads the system's; another one is for tests, which hold it
/// themselves, and for hosts that have their own, as a page in a browser has.
///
/// ```
/// use jurist_algebra::limits::{Budget, Clock, Stop};
/// use std::sync::Arc;
/// use std::sync::atomic::{AtomicU64, Ordering};
/// use std::time::Duration;
///
/// struct Held(AtomicU64);
/// impl Clock for Held {
///     fn now(&self) -> Duration {
///         Duration::from_secs(self.0.load(Ordering::Relaxed))
///     }
/// }
/// let clock = Arc::new(Held(AtomicU64::new(100)));
/// let budget = Budget::with_timeout_on(clock.clone(), Duration::from_secs(5));
/// assert!(budget.check().is_ok());
/// clock.0.store(105, Ordering::Relaxed);
/// assert_eq!(budget.check().unwrap_err().stop, Stop::Time(Duration::from_secs(5)));
/// ```
pub trait Clock: Send + Sync {
    /// The time since some fixed moment.
    fn now(&self) -> Duration;
}

/// The clock of the system; `None` where there is none that may be read (`wasm32-unknown-unknown`).
pub(super) fn system() -> Option<std::sync::Arc<dyn Clock>> {
    #[cfg(all(target_family = "wasm", target_os = "unknown"))]
    return None;
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    {
        struct System(std::time::Instant);
        impl Clock for System {
            fn now(&self) -> Duration {
                self.0.elapsed()
            }
        }
        Some(std::sync::Arc::new(System(std::time::Instant::now())))
    }
}
