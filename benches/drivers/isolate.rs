//! Isolates the real roots of the polynomials of a file, one a line: integer coefficients from the
//! constant term up, separated by blanks. Prints degree, number of roots and the median time in
//! milliseconds of square-free part, isolation and refinement to a relative width of `2^-128`.
//!
//! `cargo run --release -p jurist-benches --example isolate FILE`

use jurist_algebra::limits::Budget;
use jurist_algebra::number::Integer;
use jurist_algebra::poly::real_roots::isolate_real_roots_fixed;
use jurist_algebra::poly::{SquareFree, UniPoly};
use std::process::ExitCode;
use std::time::{Duration, Instant};

fn main() -> ExitCode {
    let Some(path) = std::env::args().nth(1) else {
        eprintln!("usage: isolate FILE");
        return ExitCode::FAILURE;
    };
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) => {
            eprintln!("{path}: {error}");
            return ExitCode::FAILURE;
        }
    };
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let coeffs: Option<Vec<Integer>> = line.split_whitespace().map(Integer::from_decimal).collect();
        let Some(p) = coeffs.map(UniPoly::new).filter(|p| p.degree().is_some()) else {
            eprintln!("{path}:{}: not a polynomial other than zero", number + 1);
            return ExitCode::FAILURE;
        };
        let (time, roots) = measured(&p);
        println!("{} {roots} {:.6}", p.degree().unwrap_or(0), time.as_secs_f64() * 1e3);
    }
    ExitCode::SUCCESS
}

/// Median time and number of roots.
fn measured(p: &UniPoly) -> (Duration, usize) {
    let run = || {
        let start = Instant::now();
        let p = SquareFree::part_of(p).expect("not zero");
        let roots = isolate_real_roots_fixed(&p, 128, &Budget::unlimited()).expect("the budget is unlimited");
        (start.elapsed(), roots.len())
    };
    let begin = Instant::now();
    let mut times = vec![run()];
    while begin.elapsed() < Duration::from_millis(500) && times.len() < 1000 {
        times.push(run());
    }
    times.sort();
    times[times.len() / 2]
}
