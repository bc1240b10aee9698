//! One job, run a fixed number of times, for counting instructions: `benches/instructions.sh` runs it
//! under callgrind and compares with `benches/instructions.txt`.
//!
//! `cargo run --release -p jurist-benches --example instructions JOB`, where JOB is one of those listed without it.

#[path = "../families/mod.rs"]
mod families;

use families::loops::{boundary, characteristic, closed_loop, limits};
use families::{RELATIVE_BITS, roots};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::SquareFree;
use jurist_algebra::poly::real_roots::isolate_real_roots_fixed;
use std::hint::black_box;
use std::process::ExitCode;

const JOBS: [(&str, fn()); 6] = [
    ("drive-charpoly", || repeat(100, || characteristic(&closed_loop(0)))),
    ("drive-limits-k", || drive_limits(1, Rational::new(1.into(), 10_000.into()))),
    ("drive-limits-t", || drive_limits(0, Rational::from(110))),
    ("order-24-limits-t", || {
        let p = characteristic(&closed_loop(18));
        repeat(3, || limits(&p, 0, &Rational::from(110)));
    }),
    ("order-12-boundary", || {
        let (p, _) = characteristic(&closed_loop(6)).cleared();
        repeat(3, || boundary(&p, 12));
    }),
    ("laguerre-100-roots", || {
        let p = SquareFree::part_of(&roots::laguerre(100)).expect("not zero");
        repeat(3, || isolate_real_roots_fixed(&p, RELATIVE_BITS, &Budget::unlimited()));
    }),
];

fn drive_limits(variable: usize, value: Rational) {
    let p = characteristic(&closed_loop(0));
    repeat(100, || limits(&p, variable, &value));
}

fn repeat<T>(times: usize, f: impl Fn() -> T) {
    for _ in 0..times {
        black_box(f());
    }
}

fn main() -> ExitCode {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    let Some((_, job)) = JOBS.iter().find(|(name, _)| *name == wanted) else {
        JOBS.iter().for_each(|(name, _)| println!("{name}"));
        return if wanted.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    };
    job();
    ExitCode::SUCCESS
}
