//! Budgets end kernels from the inside, in work that would take hours: at a count, and cancelled from another thread.

use crate::helpers::thorough::count;
use jurist_algebra::limits::{Budget, Stop};
use jurist_fuzzing::endless::JOBS;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

#[test]
fn counted_work_ends_in_the_middle_of_every_kernel() {
    for (name, work) in JOBS {
        for units in [1_000, count(1_000_000, 3_000_000) as u64] {
            let end = Budget::with_work(units).enter(work);
            assert_eq!(end.expect_err(name).stop, Stop::Work(units), "{name}");
        }
    }
}

#[test]
fn another_thread_cancels_every_kernel() {
    for (name, work) in JOBS {
        let flag = Arc::new(AtomicBool::new(false));
        let budget = Budget::unlimited().cancelled_by(Arc::clone(&flag));
        let begun = AtomicBool::new(false);
        let end = std::thread::scope(|scope| {
            let end = scope.spawn(|| {
                budget.enter(|| {
                    begun.store(true, Ordering::SeqCst);
                    work();
                })
            });
            while !begun.load(Ordering::SeqCst) {
                std::thread::yield_now();
            }
            flag.store(true, Ordering::SeqCst);
            end.join().expect("no panic")
        });
        assert_eq!(end.expect_err(name).stop, Stop::Cancelled, "{name}");
    }
}
