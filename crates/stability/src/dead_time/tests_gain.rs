//! Gains at a fixed dead time: known limits, and every cell counted once more.

use super::tests_cells::{interval, range};
use super::*;
use crate::Range;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::parse_number;
use jurist_algebra::poly::UniPoly;

fn gain(a: &[&[i64]], b: &[&[i64]], tau: &str) -> GainLoop {
    let list = |parts: &[&[i64]]| parts.iter().map(|p| UniPoly::from_i64(p)).collect();
    GainLoop::new(list(a), list(b), parse_number(tau).unwrap())
}

/// The stable intervals as decimals, after every cell has been counted once more along the axis.
fn stable(gain: &GainLoop, range: &Range, digits: usize) -> Vec<[Option<String>; 2]> {
    let budget = Budget::unlimited();
    let cells = gain_cells(gain, range, &budget).unwrap().unwrap();
    tests_cells::stable(&cells, range, digits, |sample| {
        count_delayed_roots(&gain.at(sample).unwrap(), &gain.tau, &budget).unwrap()
    })
}

#[test]
fn a_first_order_lag_with_dead_time_has_its_two_limits_to_34_digits() {
    let lag = gain(&[&[1, 1], &[]], &[&[], &[1]], "1"); // s + 1 + K z
    let limit = "2.261826334114651437542573924426004";
    assert_eq!(stable(&lag, &range(None, None), 34), [interval("-1", limit)]);
    assert_eq!(stable(&lag, &range(Some("0"), Some("50")), 34), [interval("0", limit)]);
    assert_eq!(stable(&lag, &range(Some("0"), None), 34), [interval("0", limit)]);
}

#[test]
fn an_integrator_with_dead_time_bears_half_a_turn_over_it() {
    let integrator = gain(&[&[0, 1], &[]], &[&[], &[1]], "2"); // s + K exp(-2 s): K < pi/4
    assert_eq!(stable(&integrator, &range(None, None), 20), [interval("0", "0.78539816339744830962")]);
}

#[test]
fn a_gain_can_be_stable_in_a_window_of_delayed_feedback() {
    // s^2 + 1 + K z, tau = 3/2 and 4: the sign that damps alternates.
    for tau in ["3/2", "4", "9"] {
        let oscillator = gain(&[&[1, 0, 1], &[]], &[&[], &[1]], tau);
        assert_eq!(stable(&oscillator, &range(None, None), 10).len(), 1, "{tau}");
    }
}

#[test]
fn the_integral_gain_stays_while_the_proportional_one_is_asked_for() {
    // PI and a lag: s (s + 1) + (K s + 1/2) z at tau = 1/2, in a bounded and in an unbounded domain.
    let pi = gain(&[&[0, 2, 2], &[1]], &[&[], &[0, 2]], "1/2");
    let bounded = stable(&pi, &range(Some("-20"), Some("20")), 12);
    assert_eq!(bounded, stable(&pi, &range(None, None), 12));
    assert_eq!(bounded.len(), 1);
}

#[test]
fn a_neutral_loop_ends_where_its_difference_operator_does_or_before() {
    // s + 1 + K (s - 3) z: |P/N| comes up to one from below: limits from pairs; with s + 3 and s + 1 it comes from above.
    let below = gain(&[&[1, 1], &[]], &[&[], &[-3, 1]], "1");
    let found = stable(&below, &range(None, None), 6);
    assert_eq!(found.len(), 1);
    let above = gain(&[&[3, 1], &[]], &[&[], &[1, 1]], "1");
    assert_eq!(stable(&above, &range(None, None), 6), [interval("-1", "1")]);
}

#[test]
#[ignore = "long: CI runs it"]
fn a_plant_constant_is_asked_for_like_a_gain() {
    // T s + 1 + 4 exp(-s): stable for T beyond a limit; T < 0 never.
    let lag = gain(&[&[1], &[4]], &[&[0, 1], &[]], "1");
    let found = stable(&lag, &range(Some("1/100"), Some("100")), 8);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0][1].as_deref(), Some("100"));
    assert_eq!(gain_cells(&lag, &range(None, None), &Budget::unlimited()).unwrap_err(), NotSolved::Unbounded);
}

#[test]
fn an_integral_time_is_asked_for_by_its_reciprocal() {
    // K_c = 1, 2 exp(-3 s)/(10 s + 1): T_i (10 s^2 + s + 2 s z) + 2 z.
    let time = gain(&[&[], &[2]], &[&[0, 1, 10], &[0, 2]], "3");
    let limit = Some("2.375784199948079302446349182".to_owned());
    assert_eq!(stable(&time, &range(Some("0"), None), 28), [[limit.clone(), None]]);
    assert_eq!(stable(&time, &range(None, None), 28).last(), Some(&[limit, None]));
}

#[test]
fn gains_that_no_value_helps_say_why() {
    let never = |g: &GainLoop| gain_cells(g, &range(None, None), &Budget::unlimited()).unwrap().unwrap_err();
    assert_eq!(never(&gain(&[&[0, 1], &[]], &[&[], &[0, 1]], "1")), Never::FixedRoot);
    assert_eq!(never(&gain(&[&[0, 1, 1], &[]], &[&[], &[0, 1]], "1")), Never::FixedRoot);
    assert_eq!(never(&gain(&[&[1, 1], &[-1]], &[&[0, 1], &[]], "1")), Never::RootAtZero);
}

#[test]
fn a_pole_cuts_a_cell_once_and_a_point_that_is_there_keeps_its_change() {
    let budget = Budget::unlimited();
    let integrator = gain(&[&[0, 1], &[]], &[&[], &[1]], "2"); // a root at s = 0 for K = 0
    let all = range(None, None);
    let mut cells = gain_cells(&integrator, &all, &budget).unwrap().unwrap();
    let (points, right) = (cells.points.len(), cells.right.clone());
    let zero = cells.points.iter().position(|p| p.value.exact().is_some_and(|x| x.is_zero())).unwrap();
    let change = cells.points[zero].change;
    // 2 K - 1 twice, and K, where there is a point already.
    let poles = [UniPoly::from_i64(&[-1, 2]), UniPoly::from_i64(&[0, -1, 2])];
    cells.cut_at_poles(&poles, &all, &budget).unwrap();
    assert_eq!((cells.points.len(), cells.right.len()), (points + 1, right.len() + 1));
    assert_eq!(cells.right[zero + 1], cells.right[zero + 2]);
    assert!(matches!(cells.points[zero + 1].happening, Happening::Pole));
    assert!(matches!(cells.points[zero].happening, Happening::Several(_)) && cells.points[zero].change == change);
}
