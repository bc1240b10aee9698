//! How long kernels go on after they are cancelled, in milliseconds: `cargo run --release -p jurist-benches --example latency`.
//!
//! Each job would take hours; another thread cancels it at some moment, several times.

use jurist_algebra::limits::Budget;
use jurist_fuzzing::endless::JOBS;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

fn main() {
    let moments = [100, 400, 900, 1500, 2300].map(Duration::from_millis);
    let mut longest = 0f64;
    for (name, work) in JOBS {
        let delays = moments.map(|moment| {
            let flag = Arc::new(AtomicBool::new(false));
            let budget = Budget::unlimited().cancelled_by(Arc::clone(&flag));
            std::thread::scope(|scope| {
                let job = scope.spawn(|| (budget.enter(work).is_err(), Instant::now()));
                std::thread::sleep(moment);
                let told = Instant::now();
                flag.store(true, Ordering::SeqCst);
                let (cancelled, end) = job.join().expect("no panic");
                if cancelled { end.duration_since(told).as_secs_f64() * 1e3 } else { f64::NAN }
            })
        });
        longest = delays.iter().fold(longest, |a, b| a.max(*b));
        let text: Vec<String> = delays.iter().map(|ms| format!("{ms:8.2}")).collect();
        println!("{name:45} {} ms", text.join(" "));
    }
    println!("longest {longest:.1} ms");
}
