//! The last line of `--timeout` and `--memory`: a thread that ends the program where the work does not notice in time that its
//! budget is over.
//!
//! Work looks at its budget every millisecond or so and is answered for then, with what is known. A single operation of a library
//! that takes longer cannot look, and neither can a read of a pipe that nobody writes to.

use super::arguments::RunOptions;
use super::commands::Context;
use super::output::{instead_of_an_answer, note};
use super::progress::Reporter;
use super::status::Status;
use jurist_algebra::limits::{Budget, Exhausted, Gauge, Stop, gauge_of_the_process};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time between two looks.
const TICK: Duration = Duration::from_millis(10);

/// Work done after the time was over, in processor time, before the program is ended: on a busy machine nothing is late that only
/// waits for its turn.
const LATE: Duration = Duration::from_millis(100);

/// Looks at which the time must be over where no work is done, as in a read that waits.
const WAITING: u32 = 300;

/// Looks at which far too much memory must be in use: what takes memory without looking may take a gigabyte in a second.
const FULL: u32 = 3;

/// Memory beyond the limit, and an eighth of it, that work which looks may take between two looks.
const SLACK: u64 = 32_000_000;

/// What is watched.
struct Watch {
    end: Option<Instant>,
    timeout: Duration,
    bytes: u64,
    gauge: Option<Arc<dyn Gauge>>,
    budget: Budget,
    reporter: Arc<Reporter>,
    /// How the program ends where there is no answer.
    status: Status,
}

/// Begins to watch. It ends with the process, or when an answer has been written.
pub(super) fn begin(context: &Context, options: &RunOptions, status: Status) {
    let watch = Watch {
        end: options.timeout.and_then(|timeout| Instant::now().checked_add(timeout)),
        timeout: options.timeout.unwrap_or_default(),
        bytes: options.memory(),
        gauge: gauge_of_the_process(),
        budget: context.budget.clone(),
        reporter: Arc::clone(&context.reporter),
        status,
    };
    // Without the thread the work still looks at its budget.
    let _ = std::thread::Builder::new().name("watch".into()).stack_size(256 << 10).spawn(move || watch.run());
}

impl Watch {
    fn run(&self) {
        let (mut late, mut full, mut refusals, mut at_end) = (0, 0, 0, processor_time());
        let most = self.bytes.saturating_add(self.bytes / 8).saturating_add(SLACK);
        loop {
            std::thread::sleep(TICK);
            let is_over = self.end.is_some_and(|end| Instant::now() >= end);
            if !is_over {
                (refusals, at_end) = (self.budget.refusals(), processor_time());
            }
            // Work that was told to end is about to say what is known.
            late = if is_over && self.budget.refusals() == refusals { late + 1 } else { 0 };
            full = if self.gauge.as_ref().is_some_and(|gauge| gauge.bytes() > most) { full + 1 } else { 0 };
            let is_late = late > 0 && (late >= WAITING || processor_time().saturating_sub(at_end) >= LATE);
            if !is_late && full < FULL {
                continue;
            }
            // Nothing is left half written.
            let Some(_held) = instead_of_an_answer() else { return };
            self.say(is_late);
            std::process::exit(self.status as i32);
        }
    }

    fn say(&self, is_late: bool) {
        self.reporter.finish();
        let stop = if is_late { Stop::Time(self.timeout) } else { Stop::Memory(self.bytes) };
        let stopped = Exhausted::new(stop, format!("{} (which did not end by itself)", self.budget.reached()));
        match self.status {
            Status::Rejected if is_late => {
                let seconds = self.timeout.as_secs_f64();
                note(&format!("the certificate is rejected: the check takes longer than {seconds} s"));
            }
            Status::Rejected => note(&format!("the certificate is rejected: {stopped}")),
            _ => note(&format!("undecided: {stopped}")),
        }
    }
}

/// The processor time that this process has used.
#[cfg(unix)]
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(u64::try_from(time.tv_sec).unwrap_or(0), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// The time, where no other is known.
#[cfg(not(unix))]
fn processor_time() -> Duration {
    static BEGUN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    BEGUN.get_or_init(Instant::now).elapsed()
}
