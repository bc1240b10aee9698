//! The steps from a matrix to the stable set, each alone.

#[path = "../families/mod.rs"]
mod families;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use families::RELATIVE_BITS;
use families::loops::{boundary, characteristic, closed_loop, substituted};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::SquareFree;
use jurist_algebra::poly::real_roots::isolate_real_roots_fixed;
use jurist_engine::stability::{Shape, count_roots, jury_table};
use std::hint::black_box;

fn steps(c: &mut Criterion) {
    for filters in [0, 6, 18] {
        let n = 6 + filters;
        let mut group = c.benchmark_group(format!("order {n}"));
        let matrix = closed_loop(filters);
        group.bench_function("characteristic polynomial in (K, T)", |b| b.iter(|| characteristic(black_box(&matrix))));
        let p = characteristic(&matrix);
        if n <= 12 {
            let (numerator, _) = p.cleared();
            group.bench_function("boundary in (K, T)", |b| b.iter(|| boundary(black_box(&numerator), n)));
        }
        for (name, variable, value) in [("K", 1, Rational::new(1.into(), 10_000.into())), ("T", 0, Rational::from(110))]
        {
            group.bench_function(BenchmarkId::new("substitution", name), |b| {
                b.iter(|| substituted(black_box(&p), variable, &value))
            });
            let special = substituted(&p, variable, &value);
            group.bench_function(BenchmarkId::new("boundary", name), |b| b.iter(|| boundary(black_box(&special), n)));
            let constraint = boundary(&special, n);
            group.bench_function(BenchmarkId::new("square-free part", name), |b| {
                b.iter(|| SquareFree::part_of(black_box(&constraint)))
            });
            let square_free = SquareFree::part_of(&constraint).expect("not zero");
            group.bench_function(BenchmarkId::new("isolation", name), |b| {
                b.iter(|| isolate_real_roots_fixed(black_box(&square_free), RELATIVE_BITS, &Budget::unlimited()))
            });
        }
        let at_nominal = substituted(&p, 1, &Rational::new(1.into(), 10_000.into()));
        let numeric = at_nominal.map(|c| c.eval(&110.into()));
        group.bench_function("root count at the nominal point", |b| {
            b.iter(|| count_roots(black_box(&numeric), Shape::UnitDisc))
        });
        group.bench_function("Jury table at the nominal point", |b| b.iter(|| jury_table(black_box(&numeric), n)));
        group.finish();
    }
    let half = Enclosure::from_rational(Rational::new(1.into(), 2.into()));
    c.bench_function("arc cosine to 200 bits", |b| b.iter(|| black_box(&half).acos(200)));
}

criterion_group!(benches, steps);
criterion_main!(benches);
