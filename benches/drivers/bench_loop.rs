//! Times the algebra of a family of loops: the drive with a chain of filters in its current feedback.
//!
//! Columns, in milliseconds (medians): the characteristic polynomial in both parameters; from it all real
//! roots of the critical constraint in `K` at `T = 1e-4` and in `T` at `K = 110`, refined to a relative
//! width of `2^-128`; the critical constraint in both parameters.
//!
//! `cargo run --release -p jurist-benches --example bench_loop [SECONDS_PER_FIGURE] [STEPS]`: one thread with `RAYON_NUM_THREADS=1`;
//! with `STEPS` the parts of the limits are shown too. `BENCH_ORDER=n` leaves out all other orders.

use families::RELATIVE_BITS;
use families::loops::{boundary, characteristic, closed_loop, limits, substituted};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::SquareFree;
use jurist_algebra::poly::real_roots::isolate_real_roots_fixed;
use std::hint::black_box;
use std::time::{Duration, Instant};

#[path = "../families/mod.rs"]
mod families;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let seconds = arguments.next().and_then(|s| s.parse().ok()).unwrap_or(1.0);
    let steps = arguments.next().is_some();
    let time = Duration::from_secs_f64(seconds);
    let only: Option<usize> = std::env::var("BENCH_ORDER").ok().and_then(|n| n.parse().ok());
    for filters in [0, 2, 4, 6, 10, 14, 18, 26, 34] {
        let n = 6 + filters;
        if only.is_some_and(|only| only != n) {
            continue;
        }
        let m = closed_loop(filters);
        let p = characteristic(&m);
        let (t, k) = (Rational::new(1.into(), 10_000.into()), Rational::from(110));
        print!(
            "n={n:2}  charpoly(K,T) {:9.4} ms   K at T=1e-4 {:9.4} ms   T at K=110 {:9.4} ms",
            median(time, || characteristic(&m)),
            median(time, || limits(&p, 1, &t)),
            median(time, || limits(&p, 0, &k)),
        );
        if filters <= 10 {
            let (numerator, _) = p.cleared();
            print!("   boundary in (K,T) {:10.4} ms", median(time, || boundary(&numerator, n)));
        }
        println!();
        if steps {
            for (name, variable, value) in [("K", 1, &t), ("T", 0, &k)] {
                let special = substituted(&p, variable, value);
                let constraint = boundary(&special, n);
                let square_free = SquareFree::part_of(&constraint).expect("not zero");
                println!(
                    "      {name}: substitution {:.4}  constraint {:.4} (degree {}, {} bits)  square-free part {:.4}  isolation to {RELATIVE_BITS} bits {:.4}",
                    median(time, || substituted(&p, variable, value)),
                    median(time, || boundary(&special, n)),
                    constraint.degree().unwrap_or(0),
                    constraint.height_bits(),
                    median(time, || SquareFree::part_of(&constraint)),
                    median(time, || isolate_real_roots_fixed(&square_free, RELATIVE_BITS, &Budget::unlimited())),
                );
            }
        }
    }
    if let Some(peak) = peak_memory() {
        println!("peak memory {peak}");
    }
}

/// As the operating system tells it, where it does.
fn peak_memory() -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    Some(status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().to_owned())
}

/// The median of the times of repeated calls in milliseconds.
fn median<T>(time: Duration, f: impl Fn() -> T) -> f64 {
    let begin = Instant::now();
    let mut times = Vec::new();
    while times.len() < 3 || begin.elapsed() < time {
        let start = Instant::now();
        black_box(f());
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    if least() { times[0] } else { times[times.len() / 2] }
}

/// On a busy machine the least time says more: `BENCH_LEAST=1`.
fn least() -> bool {
    std::env::var_os("BENCH_LEAST").is_some()
}
