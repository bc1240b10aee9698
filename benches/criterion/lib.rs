//! Benchmarks of single steps: `cargo bench -p jurist-benches`.
