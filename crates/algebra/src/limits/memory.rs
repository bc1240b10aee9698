//! The limit of memory, and the gauge behind it.

use super::{Exhausted, Stop};
use std::sync::{Arc, OnceLock};

/// Shows how much memory is in use.
///
/// Only an allocator knows that, so it is the program that has one: see [`measure_by`]. Tests hold a gauge themselves.
///
/// ```
/// use jurist_algebra::limits::{Budget, Gauge, Stop};
/// use std::sync::Arc;
/// use std::sync::atomic::{AtomicU64, Ordering};
///
/// struct Held(AtomicU64);
/// impl Gauge for Held {
///     fn bytes(&self) -> u64 {
///         self.0.load(Ordering::Relaxed)
///     }
/// }
/// let gauge = Arc::new(Held(AtomicU64::new(0)));
/// let budget = Budget::unlimited().within_memory_on(gauge.clone(), 5_000_000);
/// assert!(budget.check().is_ok());
/// gauge.0.store(5_000_001, Ordering::Relaxed);
/// assert_eq!(budget.check().unwrap_err().stop, Stop::Memory(5_000_000));
/// ```
pub trait Gauge: Send + Sync {
    /// The bytes that are allocated now.
    fn bytes(&self) -> u64;
}

static OF_THE_PROCESS: OnceLock<Arc<dyn Gauge>> = OnceLock::new();

/// Makes a gauge the one of this process: budgets of memory that are made from now on read it. The first one stays.
pub fn measure_by(gauge: Arc<dyn Gauge>) {
    let _ = OF_THE_PROCESS.set(gauge);
}

/// The gauge of this process, where there is one.
pub fn gauge_of_the_process() -> Option<Arc<dyn Gauge>> {
    OF_THE_PROCESS.get().cloned()
}

/// A limit of memory.
#[derive(Clone)]
pub(super) struct Memory {
    pub gauge: Option<Arc<dyn Gauge>>,
    /// The most that may be in use.
    pub bytes: u64,
}

impl Memory {
    /// Asks whether so many bytes may be taken beside those that are in use.
    pub fn room(&self, bytes: u64) -> Result<(), Exhausted> {
        let used = self.gauge.as_ref().map_or(0, |gauge| gauge.bytes());
        if used.saturating_add(bytes) > self.bytes { Err(self.exhausted()) } else { Ok(()) }
    }

    fn exhausted(&self) -> Exhausted {
        Exhausted::of(Stop::Memory(self.bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::{Budget, checkpoint, claim, join};
    use crate::matrix::Matrix;
    use crate::number::Integer;
    use crate::poly::{MultiPoly, Poly};
    use std::sync::atomic::{AtomicU64, Ordering};

    #[derive(Default)]
    struct Held(AtomicU64);

    impl Held {
        fn take(&self, bytes: u64) {
            self.0.fetch_add(bytes, Ordering::Relaxed);
        }
    }

    impl Gauge for Held {
        fn bytes(&self) -> u64 {
            self.0.load(Ordering::Relaxed)
        }
    }

    #[test]
    fn work_that_takes_memory_without_end_is_ended() {
        let gauge = Arc::new(Held::default());
        let budget = Budget::unlimited().within_memory_on(gauge.clone(), 1000);
        budget.step("filling");
        let fill = || -> u64 {
            loop {
                gauge.take(1);
                checkpoint(1 << 20);
            }
        };
        let end = budget.enter(|| join(fill, || ()).0).unwrap_err();
        assert_eq!((end.stop, end.step.as_str()), (Stop::Memory(1000), "filling"));
        // It looks at each of so long steps, and at the first over the limit.
        assert_eq!(gauge.bytes(), 1001);
        assert!(budget.check().is_err() && budget.share(1, 2).check().is_err());
    }

    /// Without a gauge: each asks for what it is about to take, and nothing of the kind is taken.
    #[test]
    fn kernels_ask_before_they_take() {
        let budget = Budget::with_memory(1 << 24);
        let sparse = |variable: usize, step: u32| {
            let exponents = |k: u32| (0..=variable).map(|i| if i == variable { k * step } else { 0 }).collect();
            MultiPoly::from_terms((0..3000).map(|k| (exponents(k), Integer::ONE)))
        };
        let (p, q) = (sparse(0, 1_000_003), sparse(1, 999_983));
        let dense = Poly::new(vec![&Integer::ONE << 4000u64; 20_000]);
        let long = &Integer::ONE << (1u64 << 22);
        let kernels: [(&str, &dyn Fn()); 6] = [
            ("a product of nine million terms", &|| drop(&p * &q)),
            ("a product through packed integers", &|| drop(&dense * &dense)),
            ("a dense list of sparse coefficients", &|| drop(sparse(0, 1_000_003).as_poly_in(0))),
            ("a dense list of numbers", &|| drop(sparse(0, 1_000_003).to_univariate(0))),
            ("a matrix", &|| drop(Matrix::<Integer>::zeros(30_000, 30_000))),
            ("a power", &|| drop(long.pow(1 << 20))),
        ];
        for (what, kernel) in kernels {
            let end = budget.enter(kernel).map_err(|end| end.stop);
            assert_eq!(end, Err(Stop::Memory(1 << 24)), "{what}");
        }
        assert!(budget.enter(|| &sparse(0, 1) + &sparse(1, 1)).is_ok());
    }

    #[test]
    fn what_is_too_large_is_refused_before_it_is_made() {
        let gauge = Arc::new(Held::default());
        let budget = Budget::with_work(1000).within_memory_on(gauge.clone(), 1 << 30);
        let asks = |bytes: u64| budget.enter(|| claim(bytes)).map_err(|end| end.stop);
        assert_eq!(asks(1 << 30), Ok(()));
        assert_eq!(asks((1 << 30) + 1), Err(Stop::Memory(1 << 30)));
        assert!(asks(u64::MAX).is_err());
        gauge.take(1 << 29);
        assert_eq!(asks(1 << 29), Ok(()));
        assert!(asks((1 << 29) + 1).is_err());
        // An outer limit holds inside of an inner one, and nothing holds outside.
        let inner = Budget::with_memory(u64::MAX);
        assert!(budget.enter(|| inner.enter(|| claim(1 << 30))).is_err());
        claim(u64::MAX);
    }
}
