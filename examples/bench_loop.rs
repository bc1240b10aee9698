//! Times the algebra of a family of loops: the drive with a chain of filters in its current feedback.
//!
//! Columns, in milliseconds (medians): the characteristic polynomial in both parameters; from it all real
//! roots of the critical constraint in `K` at `T = 1e-4` and in `T` at `K = 110`, refined to a relative
//! width of `2^-128`; the critical constraint in both parameters.
//!
//! `cargo run --release --example bench_loop [SECONDS_PER_FIGURE] [STEPS]`: one thread with `RAYON_NUM_THREADS=1`;
//! with `STEPS` the parts of the limits are shown too.

use jurist::limits::Budget;
use jurist::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist::number::{Integer, Rational};
use jurist::poly::{Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};
use jurist::stability::{HalfSizePair, Region};
use std::hint::black_box;
use std::time::{Duration, Instant};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let seconds = arguments.next().and_then(|s| s.parse().ok()).unwrap_or(1.0);
    let steps = arguments.next().is_some();
    let time = Duration::from_secs_f64(seconds);
    for filters in [0, 2, 4, 6, 10, 14, 18, 34] {
        let n = 6 + filters;
        if filters == 34 && !steps {
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
                    "      {name}: substitution {:.4}  constraint {:.4} (degree {}, {} bits)  square-free part {:.4}  isolation {:.4}  refinement {:.4}",
                    median(time, || substituted(&p, variable, value)),
                    median(time, || boundary(&special, n)),
                    constraint.degree().unwrap_or(0),
                    constraint.height_bits(),
                    median(time, || SquareFree::part_of(&constraint)),
                    median(time, || isolate_real_roots(&square_free, &Budget::unlimited())),
                    {
                        let roots = isolate_real_roots(&square_free, &Budget::unlimited()).expect("no budget");
                        median(time, || refined(&roots))
                    }
                );
            }
        }
    }
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

fn characteristic(m: &RationalMatrix) -> CharacteristicPolynomial {
    m.characteristic_polynomial(vec!["K".into(), "T".into()], &Budget::unlimited()).expect("no budget")
}

fn substituted(p: &CharacteristicPolynomial, variable: usize, value: &Rational) -> Poly<UniPoly> {
    p.substitute(variable, value).and_then(|p| p.univariate()).expect("defined there").0
}

fn boundary<R: Domain>(p: &Poly<R>, n: usize) -> R {
    HalfSizePair::new(p, n, Region::UnitDisc).critical_constraint(&Budget::unlimited()).expect("no budget")
}

fn refined(roots: &[RealAlgebraic]) -> Vec<RealAlgebraic> {
    let fraction = Rational::new(Integer::ONE, Integer::from(2).pow(129));
    let refine = |root: &RealAlgebraic| {
        if root.exact().is_some() {
            return root.clone();
        }
        let mut root = root.clone();
        loop {
            let (lo, hi) = root.enclosure();
            let near = if lo.abs() < hi.abs() { lo.abs() } else { hi.abs() };
            let target = &near * &fraction;
            if !near.is_zero() && &hi - &lo <= target {
                return root;
            }
            let width = if near.is_zero() { &(&hi - &lo) * &fraction } else { target };
            root = root.refined(&width);
        }
    };
    roots.iter().map(refine).collect()
}

fn limits(p: &CharacteristicPolynomial, variable: usize, value: &Rational) -> Vec<RealAlgebraic> {
    let constraint = boundary(&substituted(p, variable, value), p.formal_degree);
    let square_free = SquareFree::part_of(&constraint).expect("not zero");
    refined(&isolate_real_roots(&square_free, &Budget::unlimited()).expect("no budget"))
}

/// The closed loop of the drive, variables `K` and `T`, with `filters` sections
/// `x' = (1 - a) x + a u`, `a = 3/10`, between the current and its comparison.
fn closed_loop(filters: usize) -> RationalMatrix {
    let n = 6 + filters;
    let (k, t) = (MultiPoly::variable(0), MultiPoly::variable(1));
    let kt = &k * &t;
    let number = |p: i64, q: i64| RationalFunction::from(Rational::new(p.into(), q.into()));
    // p/q times a monomial.
    let times = |m: &MultiPoly, p: i64, q: i64| RationalFunction::from(m.clone()) * number(p, q);
    let mut a = RationalMatrix::zeros(n, n);
    // Armature 1 ohm, 46 mH; 0.55 V s; 12 V carrier; current controller 10 and 500.
    a[(0, 0)] = number(1, 1) + times(&t, -1000, 46);
    a[(0, 1)] = times(&t, -550, 46);
    a[(0, 2)] = times(&kt, 10_000, 46 * 12);
    a[(0, 3)] = times(&kt, 500_000, 46 * 12);
    // Inertia 0.093, friction 0.008.
    a[(1, 0)] = times(&t, 550, 93);
    a[(1, 1)] = number(1, 1) + times(&t, -8, 93);
    // The current that is compared: measured, or behind the last filter.
    let current = if filters == 0 { 0 } else { n - 1 };
    a[(2, current)] = number(-1, 1);
    a[(2, 4)] = number(1, 1);
    a[(2, 5)] = number(5, 1);
    a[(3, current)] = times(&t, -1, 2);
    a[(3, 2)] = times(&t, 1, 2);
    a[(3, 3)] = number(1, 1);
    a[(3, 4)] = times(&t, 1, 2);
    a[(3, 5)] = times(&t, 5, 2);
    a[(4, 1)] = number(-1, 1);
    a[(5, 1)] = times(&t, -1, 2);
    a[(5, 4)] = times(&t, 1, 2);
    a[(5, 5)] = number(1, 1);
    for i in 0..filters {
        a[(6 + i, if i == 0 { 0 } else { 5 + i })] = number(3, 10);
        a[(6 + i, 6 + i)] = number(7, 10);
    }
    a
}
