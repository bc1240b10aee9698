//! Times real root isolation on the families of the comparison with PARI/GP: square-free part,
//! rational roots, isolation and refinement to a relative width of `2^-128`, one thread.
//!
//! `cargo run --release -p jurist-benches --example bench_roots [part of a name]`; the random families are read from
//! `benches/data/random.txt`, which PARI wrote.

use families::RELATIVE_BITS;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::real_roots::isolate_real_roots_fixed;
use jurist_algebra::poly::{SquareFree, UniPoly};
use std::time::{Duration, Instant};

#[path = "../families/mod.rs"]
mod families;

/// Median time and number of roots.
fn measured(p: &UniPoly) -> (Duration, usize) {
    let budget = Budget::unlimited();
    let run = || {
        let start = Instant::now();
        let p = SquareFree::part_of(p).expect("not zero");
        let roots = isolate_real_roots_fixed(&p, RELATIVE_BITS, &budget).expect("the budget is unlimited");
        (start.elapsed(), roots.len())
    };
    let begin = Instant::now();
    let mut times = vec![run()];
    while begin.elapsed() < Duration::from_secs(1) && times.len() < 500 {
        times.push(run());
    }
    times.sort();
    times[times.len() / 2]
}

fn main() {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    for (name, p) in families::roots::all().iter().filter(|(name, _)| name.contains(&wanted)) {
        let (time, roots) = measured(p);
        let degree = p.degree().unwrap_or(0);
        println!("{name:<20} degree {degree:>4}  roots {roots:>4}  {:>10.3} ms", time.as_secs_f64() * 1e3);
    }
}
