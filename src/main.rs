//! The `jurist` program: hands the command line to [`jurist::cli`] and returns its exit status.

#![deny(unsafe_code)]

use cap::Cap;
use std::alloc::System;
use std::sync::Arc;

/// The allocator of the system, which counts what is in use.
#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// What the allocator counts, for `--memory`.
struct Allocated;

impl jurist_algebra::limits::Gauge for Allocated {
    fn bytes(&self) -> u64 {
        ALLOCATOR.allocated() as u64
    }
}

fn main() -> std::process::ExitCode {
    jurist_algebra::limits::measure_by(Arc::new(Allocated));
    #[cfg(unix)]
    let closed = standard_output::was_closed();
    #[cfg(not(unix))]
    let closed = false;
    jurist::cli::main(closed)
}

/// Whether standard output was closed (`>&-`) when the program began.
///
/// Before `main`, Rust opens `/dev/null` in its place, in which every answer is lost without an error; so this is
/// looked at earlier, by a constructor. It makes one system call and stores one flag.
#[cfg(unix)]
mod standard_output {
    use std::sync::atomic::{AtomicBool, Ordering};

    static CLOSED: AtomicBool = AtomicBool::new(false);

    ctor::declarative::ctor! {
        #[ctor(unsafe)]
        fn look() {
            CLOSED.store(rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err(), Ordering::Relaxed);
        }
    }

    pub fn was_closed() -> bool {
        CLOSED.load(Ordering::Relaxed)
    }
}
