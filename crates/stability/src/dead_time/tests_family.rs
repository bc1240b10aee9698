//! A parameter anywhere: limits found by Newton's method with 45 digits elsewhere, and the affine case both ways.

use super::tests_cells::{interval, range};
use super::*;
use crate::Range;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::poly::UniPoly;

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn line(slope: &str, offset: &str) -> Line {
    Line { slope: number(slope), offset: number(offset) }
}

/// The coefficient of `z^k s^j` at `[k][j]`, as coefficients of the powers of the parameter.
fn family(parts: &[&[&[i64]]], tau: Line, decay: Line) -> FamilyLoop {
    let list = parts.iter().map(|part| part.iter().map(|c| UniPoly::from_i64(c)).collect()).collect();
    FamilyLoop::new(list, tau, decay)
}

/// The stable intervals, after every cell has been counted once more along the line.
fn stable(family: &FamilyLoop, range: &Range, digits: usize) -> Vec<[Option<String>; 2]> {
    let budget = Budget::unlimited();
    let cells = family_cells(family, range, &budget).unwrap().unwrap();
    tests_cells::stable(&cells, range, digits, |sample| family.count(sample, &budget).unwrap().unwrap())
}

#[test]
fn the_square_of_a_gain_has_the_root_of_its_limit() {
    // s + 1 + K^2 exp(-s)
    let lag = family(&[&[&[1], &[1]], &[&[0, 0, 1]]], line("0", "1"), line("0", "0"));
    let limit = "1.503936944859940408779224861496129";
    assert_eq!(stable(&lag, &range(Some("0"), Some("5")), 34), [interval("0", limit)]);
    assert_eq!(stable(&lag, &range(Some("-5"), Some("5")), 34), [interval(&format!("-{limit}"), limit)]);
}

#[test]
fn a_double_time_constant_is_decided_in_a_domain_without_end() {
    // (T s + 1)^2 + 2 exp(-s): T > 2/pi, at pi/2.
    let parts: &[&[&[i64]]] = &[&[&[1], &[0, 2], &[0, 0, 1]], &[&[2]]];
    let two_lags = family(parts, line("0", "1"), line("0", "0"));
    let limit = Some("0.6366197723675813430755350534900574".to_owned());
    assert_eq!(stable(&two_lags, &range(Some("1/10"), Some("100")), 34), [[limit.clone(), Some("100".into())]]);
    // Both roots come to s = 0 in the end, at the rate of 1/T.
    let open = range(Some("1/10"), None);
    assert_eq!(stable(&two_lags, &open, 34), [[limit, None]]);
    let cells = family_cells(&two_lags, &open, &Budget::unlimited()).unwrap().unwrap();
    let Some(Happening::Pair(omega)) = cells.points.last().map(|p| &p.happening) else { panic!("{:?}", cells.points) };
    assert_eq!(omega.decimal(20), "1.5707963267948966192");
    // Another line than the axis would move in units of 1/T.
    let shifted = family(parts, line("0", "1"), line("0", "1/10"));
    assert_eq!(family_cells(&shifted, &open, &Budget::unlimited()).unwrap_err(), NotSolved::Coincidence);
    // Down to zero, where the highest power is lost, there are crossings without end.
    let refused = family_cells(&two_lags, &range(Some("0"), Some("1")), &Budget::unlimited());
    assert_eq!(refused.unwrap_err(), NotSolved::Unbounded);
}

#[test]
fn a_parameter_may_be_a_dead_time_and_a_gain_at_once() {
    // s + 1/2 + p exp(-p s), doubled
    let loops = family(&[&[&[1], &[2]], &[&[0, 2]]], line("1", "0"), line("0", "0"));
    let limit = "1.433887247660506150483282816590963";
    assert_eq!(stable(&loops, &range(Some("0"), Some("6")), 34), [interval("0", limit)]);
}

#[test]
fn a_decay_rate_is_asked_of_a_gain() {
    // s + 1 + K exp(-s) left of -1/2: s + 1/2 + K exp(1/2) exp(-s)
    let lag = family(&[&[&[1], &[2]], &[&[0, 2]]], line("0", "1"), line("0", "1/2"));
    let (lower, upper) = ("-0.3032653298563167118018997674955902", "1.154495587725778169183638253504985");
    assert_eq!(stable(&lag, &range(Some("-4"), Some("4")), 34), [interval(lower, upper)]);
}

#[test]
fn the_largest_decay_rate_is_that_of_the_rightmost_root() {
    // s + 1 + exp(-s)/2, doubled, at s - p: 2 s + 2 - 2 p + exp(p) exp(-s)
    let lag = family(&[&[&[2, -2], &[2]], &[&[1]]], line("0", "1"), line("1", "0"));
    let limit = "1.102659476818048995988558843301097";
    let found = family_cells(&lag, &range(Some("0"), None), &Budget::unlimited()).unwrap().unwrap();
    assert_eq!(found.points[0].value.decimal(34), limit);
    assert_eq!(found.right[0], Some(0));
    assert!(found.right[1..].iter().all(|right| *right != Some(0)));
}

/// A decay of 1 was the first end that was tried, and a cancelled root lies there.
#[test]
fn a_root_at_a_round_number_does_not_hide_the_largest_decay_rate() {
    // (s + 1)(s + 2 exp(-s/2)) at s - p: (s + 1 - p)(s - p + 2 exp(p/2) exp(-s/2))
    let parts: &[&[&[i64]]] = &[&[&[0, -1, 1], &[1, -2], &[1]], &[&[2, -2], &[2]]];
    let cancelled = family(parts, line("0", "1/2"), line("1", "0"));
    let found = family_cells(&cancelled, &range(Some("0"), None), &Budget::unlimited()).unwrap().unwrap();
    // The two rightmost roots of s + 2 exp(-s/2) are 2 W(-1): of modulus above 1, so the pair is first.
    assert_eq!(found.points[0].value.decimal(20), "0.63626301040952827063");
    assert_eq!((found.right[0], found.right[1]), (Some(0), Some(2)));
}

#[test]
fn a_dead_time_is_asked_for_with_a_decay_rate() {
    // s + 1 + 2 exp(-tau s) left of -1/5: 5 s + 4 + 10 exp(tau/5) exp(-tau s)
    let lag = family(&[&[&[4], &[5]], &[&[10]]], line("1", "0"), line("0", "1/5"));
    assert_eq!(stable(&lag, &range(Some("0"), Some("3")), 34), [interval("0", DELAY_WITH_DECAY)]);
}

const DELAY_WITH_DECAY: &str = "0.8566573266244887745586626584630363";

#[test]
fn affine_parameters_have_the_same_cells_both_ways() {
    let p = |c: &[i64]| UniPoly::from_i64(c);
    let loops = [
        (vec![p(&[1, 1]), p(&[])], vec![p(&[]), p(&[1])], "1", "-6", "6"),
        (vec![p(&[5, 1, 5]), p(&[])], vec![p(&[5]), p(&[-5])], "6", "0", "3"),
        (vec![p(&[0, 2, 2]), p(&[1])], vec![p(&[]), p(&[0, 2])], "1/2", "-20", "20"),
        (vec![p(&[2, 3, 1]), p(&[1, 1])], vec![p(&[0, 1]), p(&[3])], "3/7", "-9", "9"),
    ];
    for (a, b, tau, lower, upper) in loops {
        let gain = GainLoop::new(a.clone(), b.clone(), number(tau));
        let parts = a.iter().zip(&b).map(|(a, b)| (0..3).map(|j| UniPoly::new(vec![a.coeff(j), b.coeff(j)])).collect());
        let family = FamilyLoop::new(parts.collect(), line("0", tau), line("0", "0"));
        let (range, budget) = (range(Some(lower), Some(upper)), Budget::unlimited());
        let one = gain_cells(&gain, &range, &budget).unwrap().unwrap();
        let two = family_cells(&family, &range, &budget).unwrap().unwrap();
        assert_eq!(one.right, two.right, "{gain:?}");
        let places = |cells: &GainCells| cells.points.iter().map(|p| p.value.decimal(30)).collect::<Vec<_>>();
        assert_eq!(places(&one), places(&two));
    }
}

#[test]
fn roots_that_meet_on_the_axis_are_not_told_but_end() {
    // (s^2 + 1 + (p - 1)^2 s + ...): p touches an undamped pair at 1 while nothing else moves.
    let parts: &[&[&[i64]]] = &[&[&[1], &[1, -2, 1], &[1]], &[&[0], &[0, 0, 0], &[0]], &[&[1, -2, 1]]];
    let loops = family(parts, line("0", "1"), line("0", "0"));
    let cells = family_cells(&loops, &range(Some("1/2"), Some("2")), &Budget::unlimited());
    assert_eq!(cells.unwrap_err(), NotSolved::Coincidence);
}
