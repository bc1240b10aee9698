//! What a question costs in this process, in milliseconds: `cargo run --release -p jurist-benches --example question [REPETITIONS]`.
//!
//! Columns, the least of all repetitions: the stable set of a parameter; the same with its document as JSON. The Python package is measured against this:
//! `python/tests/overhead.py` asks the same questions there.

use jurist::documents::to_text;
use jurist::{Ask, Budget, Document, Model};
use std::time::Instant;

/// Name, model, parameter; the first needs next to no work.
const QUESTIONS: [(&str, &str, &str); 2] = [("small", include_str!("../data/small.toml"), "K"), ("drive", "", "K_pwm")];

fn main() {
    let repetitions = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(200);
    let pool = rayon::ThreadPoolBuilder::new().stack_size(64 << 20).build().expect("threads");
    for (name, text, parameter) in QUESTIONS {
        let model =
            if text.is_empty() { Model::drive() } else { Model::from_bytes(name, text.as_bytes()).expect("a model").0 };
        let answer = || {
            let problem = model.ask().free(parameter).problem().expect("a question");
            problem.stable_set(&Budget::unlimited()).expect("an answer")
        };
        let [alone, written] = pool.install(|| {
            [least(repetitions, || drop(answer())), least(repetitions, || drop(to_text(&answer().json(12))))]
        });
        println!("{name} {alone:.4} {written:.4}");
    }
}

/// Milliseconds; what else the machine does only makes it longer.
fn least(repetitions: usize, work: impl Fn()) -> f64 {
    let time = |_| {
        let begun = Instant::now();
        work();
        begun.elapsed().as_secs_f64() * 1e3
    };
    (0..repetitions).map(time).fold(f64::INFINITY, f64::min)
}
