//! Isolation in fixed point beside the exact reference.

#[path = "../families/mod.rs"]
mod families;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use families::roots::{chebyshev, mignotte};
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::SquareFree;
use jurist_algebra::poly::real_roots::{isolate_real_roots_descartes, isolate_real_roots_fixed};
use std::hint::black_box;

fn isolation(c: &mut Criterion) {
    let budget = Budget::unlimited();
    let families =
        [("chebyshev 12", chebyshev(12)), ("chebyshev 50", chebyshev(50)), ("mignotte 20", mignotte(20, 1_000_003))];
    let mut group = c.benchmark_group("isolation");
    for (name, p) in families {
        let p = SquareFree::part_of(&p).expect("not zero");
        group.bench_with_input(BenchmarkId::new("fixed, 128 bits", name), &p, |b, p| {
            b.iter(|| isolate_real_roots_fixed(black_box(p), 128, &budget))
        });
        group.bench_with_input(BenchmarkId::new("fixed, 40 bits", name), &p, |b, p| {
            b.iter(|| isolate_real_roots_fixed(black_box(p), 40, &budget))
        });
        group.bench_with_input(BenchmarkId::new("exact, isolation alone", name), &p, |b, p| {
            b.iter(|| isolate_real_roots_descartes(black_box(p), None, None, &budget))
        });
    }
    group.finish();
}

criterion_group!(benches, isolation);
criterion_main!(benches);
