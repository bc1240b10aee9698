//! Coefficients over constants: the cells of the same loop with rational coefficients, and limits in closed form.

use super::tests_cells::{range, stable};
use super::*;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};
use jurist_algebra::symbols::{Definition, Symbols};

type Parts<'a> = &'a [&'a [&'a [i64]]];

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn line([slope, offset]: [&str; 2]) -> Line {
    Line { slope: number(slope), offset: number(offset) }
}

/// The loop with rational coefficients, and the same with each coefficient times a constant whose square is 1.
fn both(parts: Parts<'_>, tau: [&str; 2], decay: [&str; 2]) -> [FamilyLoop; 2] {
    let exact: Vec<Vec<UniPoly>> =
        parts.iter().map(|part| part.iter().map(|c| UniPoly::from_i64(c)).collect()).collect();
    let mut symbols = Symbols::new();
    let one = MultiPoly::variable(symbols.insert("r", Definition::root(1)) + 1);
    let over = |c: &UniPoly| MultiPoly::from_univariate(c, 0).times(&one);
    let coefficients = exact.iter().map(|part| part.iter().map(over).collect()).collect();
    let (tau, decay) = (line(tau), line(decay));
    let enclosed = FamilyLoop::enclosed(ConstantParts::new(coefficients, symbols), tau.clone(), decay.clone());
    [FamilyLoop::new(exact, tau, decay), enclosed]
}

#[test]
fn a_constant_that_is_a_number_changes_no_cell() {
    let none = ["0", "0"];
    let cases: [(Parts<'_>, [[&str; 2]; 3]); 7] = [
        (&[&[&[1], &[1]], &[&[0, 0, 1]]], [["0", "1"], none, ["-5", "5"]]),
        (&[&[&[1], &[0, 2], &[0, 0, 1]], &[&[2]]], [["0", "1"], none, ["1/10", "100"]]),
        (&[&[&[1], &[2]], &[&[0, 2]]], [["1", "0"], none, ["0", "6"]]),
        (&[&[&[1], &[2]], &[&[0, 2]]], [["0", "1"], ["0", "1/2"], ["-4", "4"]]),
        (&[&[&[4], &[5]], &[&[10]]], [["1", "0"], ["0", "1/5"], ["0", "3"]]),
        (&[&[&[5], &[1], &[5]], &[&[0, 5], &[0, -5]]], [["0", "6"], none, ["1/10", "3"]]),
        (&[&[&[2, 0], &[3, 1], &[1]], &[&[1, 3], &[1]]], [["0", "3/7"], none, ["-9", "9"]]),
    ];
    // Some of the loops by default, all in CI.
    let every = if std::env::var_os("JURIST_THOROUGH").is_some() { 1 } else { 3 };
    for (parts, [tau, decay, [lower, upper]]) in cases.into_iter().step_by(every) {
        let ([exact, enclosed], budget) = (both(parts, tau, decay), Budget::unlimited());
        let range = range(Some(lower), Some(upper));
        let [one, two] = [&exact, &enclosed].map(|family| family_cells(family, &range, &budget).unwrap().unwrap());
        assert_eq!(one.right, two.right, "{parts:?}");
        // More digits than the first enclosures of the coefficients have.
        let places = |cells: &GainCells| cells.points.iter().map(|p| number(&p.value.decimal(100))).collect::<Vec<_>>();
        assert_eq!(places(&one), places(&two), "{parts:?}");
        let counted = |family: &FamilyLoop, cells: &GainCells| {
            stable(cells, &range, 30, |x| family.count(x, &budget).unwrap().unwrap()).len()
        };
        assert_eq!(counted(&exact, &two), counted(&enclosed, &one), "{parts:?}");
    }
}

#[test]
fn gains_without_end_are_those_of_the_exact_loop() {
    let cases: [(Parts<'_>, &str); 5] = [
        (&[&[&[1], &[1]], &[&[0, 1]]], "1"),
        (&[&[&[0], &[1], &[1]], &[&[0, 1]]], "1/3"),
        (&[&[&[-1], &[1]], &[&[0, 1]]], "1/2"),
        (&[&[&[4], &[3], &[2], &[1]], &[&[0, 1], &[0, 2]]], "5"),
        (&[&[&[1], &[2], &[1]], &[&[0, 1], &[0, 1]]], "1/7"),
    ];
    let budget = Budget::unlimited();
    for (parts, tau) in cases {
        let [exact, enclosed] = both(parts, ["0", tau], ["0", "0"]);
        let range = range(Some("0"), None);
        let part = |i: usize| {
            parts
                .iter()
                .map(|p| UniPoly::from_i64(&p.iter().map(|c| c.get(i).copied().unwrap_or(0)).collect::<Vec<_>>()))
                .collect()
        };
        let gain = GainLoop::new(part(0), part(1), number(tau));
        let one = gain_cells(&gain, &range, &budget).unwrap().unwrap();
        let two = family_cells(&enclosed, &range, &budget).unwrap().unwrap();
        let intervals = |cells: &GainCells| {
            let found = stable(cells, &range, 40, |x| exact.count(x, &budget).unwrap().unwrap());
            found.into_iter().map(|ends| ends.map(|end| end.map(|end| number(&end)))).collect::<Vec<_>>()
        };
        assert_eq!(intervals(&one), intervals(&two), "{parts:?}");
    }
}

#[test]
fn limits_over_pi_are_those_in_closed_form() {
    // s + pi K exp(-s/2): K pi < pi
    let mut symbols = Symbols::new();
    let pi = MultiPoly::variable(symbols.insert("pi", Definition::Pi) + 1);
    let gain = MultiPoly::variable(0);
    let parts = vec![vec![MultiPoly::zero(), MultiPoly::one()], vec![gain.times(&pi)]];
    let of = |tau: &str| {
        FamilyLoop::enclosed(ConstantParts::new(parts.clone(), symbols.clone()), line(["0", tau]), line(["0", "0"]))
    };
    let (budget, gains) = (Budget::unlimited(), range(Some("0"), None));
    let family = of("1/2");
    let cells = family_cells(&family, &gains, &budget).unwrap().unwrap();
    assert_eq!(number(&cells.points[0].value.decimal(60)), Rational::ONE);
    assert_eq!((cells.right[0], *cells.right.last().unwrap()), (Some(0), None));
    // At the limit the count stays undecided, and beside it every count is known.
    assert!(matches!(family.count(&1.into(), &budget), Err(NotCounted::Stopped(_))));
    let near = number("1e-60");
    for (value, right) in [(Rational::ONE - &near, 0), (Rational::ONE + &near, 2)] {
        assert_eq!(family.count(&value, &budget).unwrap().unwrap().right, Some(right));
        // The same without parameter.
        let undelayed = vec![MultiPoly::zero(), MultiPoly::constant(value.denominator())];
        let alone = ConstantParts::new(vec![undelayed, vec![pi.scaled_by(&value.numerator())]], symbols.clone());
        let alone = FamilyLoop::enclosed(alone, line(["0", "1/2"]), line(["0", "0"]));
        assert_eq!(alone.count(&0.into(), &budget).unwrap().unwrap().right, Some(right));
    }
}
