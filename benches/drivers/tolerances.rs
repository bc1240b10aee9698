//! Boxes by the number of their parameters: `cargo run --release -p jurist-benches --example tolerances`.
//!
//! The drive's components with 20 % each, and random loops of order 5 whose matrices move with each parameter along one
//! direction. Of each: the proof of the box of half the largest factor, the bracket of the largest factor to a millionth, and
//! random points: how many could have been tested in the time of the proof, and how many of 1000 are not stable in the box that
//! is a thousandth larger than the largest stable one. A point that is stable proves nothing about its neighbours.
//!
//! With `--questions`, one JSON object a line: the questions of `benches/peers/codac_tolerances.py`, each with the time of the
//! library call that answers it.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_engine::problem::{Ask, Problem};
use jurist_engine::stability::boxes::{BoxDecision, BoxPolynomial, Side, ToleranceProblem};
use std::sync::Arc;
use std::time::{Duration, Instant};

const NAMES: [&str; 12] = ["R_a", "L_a", "J", "B_v", "K_a", "k_1", "k_2", "E_sw", "K_pi", "K_ii", "K_ps", "K_is"];

/// The order of the random loops.
const ORDER: usize = 5;

/// Random points beyond the largest stable box.
const POINTS: usize = 1000;

/// Knuth's generator (MMIX), the same numbers every time.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }

    fn between(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low + 1) as u64) as i64
    }
}

/// A loop with its tolerances.
struct Family {
    name: String,
    problem: Arc<Problem>,
    sides: Vec<Side>,
}

fn drive(count: usize) -> Family {
    let names = &NAMES[..count];
    let drive = Model::drive();
    let problem = names.iter().fold(drive.ask(), |question, name| question.free(*name)).problem().expect("known names");
    let share = Rational::new(1.into(), 5.into());
    let nominal = problem.free().iter().map(|free| free.nominal.clone().expect("a number"));
    let sides = nominal.map(|x| Side::scaled(x.clone(), [&x * &share, &x * &share])).collect();
    Family { name: "drive".to_owned(), problem, sides }
}

/// `x' = (A + sum q_i b_i c_i^T) x` with a stable `A` and `|q_i| <= 1/10`.
fn random(count: usize, seed: u64) -> Family {
    let mut random = Random(seed);
    let vectors: Vec<Vec<i64>> = (0..2 * count).map(|_| (0..ORDER).map(|_| random.between(-2, 2)).collect()).collect();
    let entry = |row: usize, column: usize, random: &mut Random| {
        let a = if row == column { -random.between(12, 30) } else { random.between(-3, 3) };
        let terms = (0..count).filter_map(|i| {
            let product = vectors[2 * i][row] * vectors[2 * i + 1][column];
            (product != 0).then(|| format!(" + ({product})*q{i}"))
        });
        format!("\"{a}{}\"", terms.collect::<String>())
    };
    let rows: Vec<String> = (0..ORDER)
        .map(|row| format!("[{}]", (0..ORDER).map(|c| entry(row, c, &mut random)).collect::<Vec<_>>().join(", ")))
        .collect();
    let parameters: String = (0..count).map(|i| format!("q{i} = {{ nominal = 0 }}\n")).collect();
    let text = format!("time = 'continuous'\n[parameters]\n{parameters}[loop]\nmatrix = [{}]\n", rows.join(", "));
    let (model, _) = Model::from_toml(&Source::new("random.toml", text)).expect("a model");
    let question = (0..count).fold(model.ask(), |question, i| question.free(format!("q{i}")));
    let tenth = Rational::new(1.into(), 10.into());
    let sides = vec![Side::scaled(Rational::ZERO, [tenth.clone(), tenth]); count];
    Family { name: "random".to_owned(), problem: question.problem().expect("known names"), sides }
}

/// The least time of some runs, and the last value.
fn least<T>(runs: usize, work: impl Fn() -> T) -> (Duration, T) {
    let run = || {
        let start = Instant::now();
        let value = work();
        (start.elapsed(), value)
    };
    let (mut time, mut value) = run();
    for _ in 1..runs {
        let (again, other) = run();
        (time, value) = (time.min(again), other);
    }
    (time, value)
}

fn row(family: &Family) {
    let budget = Budget::unlimited();
    let d = family.problem.algebra(&budget).expect("no budget").polynomial().expect("defined");
    let p = BoxPolynomial::new(d, family.problem.shape());
    let count = family.sides.len();
    let Some(boxes) = ToleranceProblem::new(&p, family.sides.clone()) else {
        println!("{:7} {count:3}  not stable at the nominal point", family.name);
        return;
    };
    let gap = Rational::new(1.into(), 1_000_000.into());
    let (bracket, factor) = least(2, || boxes.largest_factor(&gap, None, &budget).expect("no budget"));
    let upper = factor.upper.clone().unwrap_or(factor.lower.clone());
    let half = &factor.lower * &Rational::new(1.into(), 2.into());
    let (proof, decision) = least(3, || boxes.decide(&half, &budget).expect("no budget"));
    let BoxDecision::Stable(tree) = decision else { panic!("half of a stable box is stable") };
    let nominal: Vec<Rational> = family.sides.iter().map(|side| side.nominal().clone()).collect();
    let (point, _) = least(20, || p.is_stable_at(&nominal));
    let wider = &upper * &Rational::new(1001.into(), 1000.into());
    let mut random = Random(7);
    let not_stable = (0..POINTS)
        .filter(|_| {
            let share = |side: &Side| {
                let [low, high] = side.at(&wider);
                &low + &(&(&high - &low) * &Rational::new(random.below(1 << 20).into(), (1 << 20).into()))
            };
            !p.is_stable_at(&family.sides.iter().map(share).collect::<Vec<_>>())
        })
        .count();
    println!(
        "{:7} {count:3} {:13} {:>14} {:6} {:9.2} {:14} {:11.1} {:10.0} {not_stable:10}",
        family.name,
        boxes.coefficients().unwrap_or(0),
        to_decimal(&factor.lower, 9),
        tree.cells(),
        proof.as_secs_f64() * 1e3,
        factor.proof.map_or(0, |p| p.cells()),
        bracket.as_secs_f64() * 1e3,
        proof.as_secs_f64() / point.as_secs_f64(),
    );
}

/// A question of zero exclusion over the box of a factor, for another program.
fn question(name: &str, family: &Family, factor: &str) {
    let budget = Budget::unlimited();
    let d = family.problem.algebra(&budget).expect("no budget").polynomial().expect("defined");
    let p = BoxPolynomial::new(d, family.problem.shape());
    let boxes = ToleranceProblem::new(&p, family.sides.clone()).expect("stable");
    let factor: Rational = jurist_algebra::number::parse_number(factor).expect("a number");
    let (time, decision) = least(5, || boxes.decide(&factor, &budget).expect("no budget"));
    let cells = match decision {
        BoxDecision::Stable(proof) => proof.cells(),
        _ => 0,
    };
    let coefficient = |c: &jurist_algebra::poly::MultiPoly| {
        let terms = c.terms().iter().map(|(monomial, a)| format!("[{:?},\"{a}\"]", monomial.exponents()));
        format!("[{}]", terms.collect::<Vec<_>>().join(","))
    };
    let coefficients: Vec<String> = p.in_half_plane().iter().map(coefficient).collect();
    let sides: Vec<String> =
        family.sides.iter().map(|side| format!("[\"{}\",\"{}\"]", side.at(&factor)[0], side.at(&factor)[1])).collect();
    println!(
        "{{\"name\":\"{name}\",\"seconds\":{},\"cells\":{cells},\"box\":[{}],\"coefficients\":[{}]}}",
        time.as_secs_f64(),
        sides.join(","),
        coefficients.join(",")
    );
}

/// An example of the repository with the tolerances that stand in it.
fn example(name: &str) -> Family {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("an example");
    let (model, _) = Model::from_toml(&Source::new(path, text)).expect("a model");
    let request = jurist_engine::answer::ToleranceRequest::of_model(&model);
    let answer = model.ask().tolerance(&request, &Budget::unlimited()).expect("an answer");
    Family { name: name.to_owned(), problem: Arc::clone(answer.problem()), sides: answer.value().sides.clone() }
}

fn main() {
    if std::env::args().any(|argument| argument == "--questions") {
        for (name, factor) in [
            ("de-gaston-safonov", "3.4173"),
            ("vicino-tesi-milanese", "6"),
            ("vicino-tesi-milanese", "6.274"),
            ("bus-steering", "0.988"),
            ("fiat-dedra", "1"),
        ] {
            question(name, &example(name), factor);
        }
        for (count, factor) in [(4, "1"), (4, "4"), (8, "1"), (8, "2.2")] {
            question(&format!("drive-{count}"), &drive(count), factor);
        }
        return;
    }
    println!(
        "family    m  coefficients         factor  cells  proof ms  cells at 1e-6  bracket ms     points not stable"
    );
    [2, 4, 6, 8, 10, 12].into_iter().for_each(|count| row(&drive(count)));
    for count in [2, 4, 6, 8, 10, 12, 14, 16] {
        row(&random(count, 1));
    }
}
