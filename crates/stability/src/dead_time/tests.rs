//! Known loops, and two algorithms held against each other.

use super::*;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::poly::{Domain, UniPoly};

fn quasi(parts: &[&[i64]]) -> QuasiPolynomial {
    QuasiPolynomial::new(parts.iter().map(|p| UniPoly::from_i64(p)).collect()).unwrap()
}

fn cells(p: &QuasiPolynomial, upper: Option<&str>) -> DelayCells {
    let upper = upper.map(|u| parse_number(u).unwrap());
    delay_cells(p, &Rational::ZERO, upper.as_ref(), &Budget::unlimited()).unwrap().unwrap()
}

fn places(cells: &DelayCells, digits: usize) -> Vec<String> {
    cells.switches.iter().map(|s| s.dead_time(160).decimal(digits).unwrap()).collect()
}

/// Every cell is counted once more along the axis, at a point inside.
fn counts_agree(p: &QuasiPolynomial, cells: &DelayCells) {
    let budget = Budget::unlimited();
    let mut ends = vec![Rational::ZERO];
    for switch in &cells.switches {
        let place = switch.dead_time(120);
        ends.push(place.lower().clone());
        ends.push(place.upper().clone());
    }
    let last = ends.last().unwrap() + &Rational::dyadic(&1.into(), 3);
    ends.push(last);
    for (i, pair) in ends.chunks(2).enumerate() {
        let sample = jurist_algebra::poly::simplest_between(&pair[0], &pair[1]).unwrap();
        let count = count_delayed_roots(p, &sample, &budget).unwrap();
        assert_eq!((count.on, count.right), (0, Some(cells.right[i])), "cell {i} at {sample}");
    }
}

#[test]
fn an_undamped_oscillator_with_delayed_feedback_has_three_windows() {
    // s^2 + 1 - 0.2 z
    let p = quasi(&[&[5, 0, 5], &[-1]]);
    let cells = cells(&p, None);
    assert_eq!(cells.right[..7], [0, 2, 0, 2, 0, 2, 4]);
    let places = places(&cells, 9);
    assert_eq!(
        places[..6],
        ["2.86786860", "7.02481473", "8.60360581", "14.0496295", "14.3393430", "20.0750802"].map(str::to_owned)
    );
    assert!(cells.right[5..].iter().all(|&c| c > 0));
    counts_agree(&p, &cells);
}

#[test]
fn a_double_zero_of_the_resultant_is_two_crossings_of_one_frequency() {
    // (a - 3z/10)(a (s + 1) - 3 (1 - s) z/10), a = s^2 + s/10 + 1
    let a = UniPoly::from_i64(&[10, 1, 10]); // 10 a
    let first = [a.clone(), UniPoly::from_i64(&[-3])];
    let second = [a.times(&UniPoly::from_i64(&[1, 1])), UniPoly::from_i64(&[-3, 3])];
    let parts = vec![
        first[0].times(&second[0]),
        first[0].times(&second[1]).plus(&first[1].times(&second[0])),
        first[1].times(&second[1]),
    ];
    let p = QuasiPolynomial::new(parts).unwrap();
    let cells = cells(&p, Some("10"));
    assert_eq!(cells.right[..7], [0, 2, 4, 2, 0, 2, 4]);
    counts_agree(&p, &cells);
}

#[test]
fn the_example_of_olgac_and_sipahi_has_two_windows() {
    // x' = A x + B x(t - tau), 3 x 3 of the paper
    let a = [[-1.0, 13.5, -1.0], [-3.0, -1.0, -2.0], [-2.0, -1.0, -4.0]];
    let b = [[-5.9, 7.1, -70.3], [2.0, -1.0, 5.0], [2.0, 0.0, 6.0]];
    // det(s I - A - B z) by its minors over polynomials in s and z, times 1000.
    type Bi = Vec<Vec<i64>>; // by z, then s
    let entry = |i: usize, j: usize| -> Bi {
        let first = vec![(-a[i][j] * 10.0f64).round() as i64, if i == j { 10 } else { 0 }];
        vec![first, vec![(-b[i][j] * 10.0f64).round() as i64]]
    };
    let times = |x: &Bi, y: &Bi| -> Bi {
        let mut out = vec![vec![0i64; 4]; 4];
        for (k, p) in x.iter().enumerate() {
            for (l, q) in y.iter().enumerate() {
                for (i, c) in p.iter().enumerate() {
                    for (j, d) in q.iter().enumerate().filter(|(_, d)| **d != 0 && *c != 0) {
                        out[k + l][i + j] += c * d;
                    }
                }
            }
        }
        out
    };
    let plus = |x: &Bi, y: &Bi, sign: i64| -> Bi {
        let at = |p: &Bi, k: usize, i: usize| p.get(k).and_then(|p| p.get(i)).copied().unwrap_or(0);
        (0..4).map(|k| (0..4).map(|i| at(x, k, i) + sign * at(y, k, i)).collect()).collect()
    };
    let mut determinant: Bi = vec![vec![0; 4]; 4];
    for (order, sign) in
        [([0, 1, 2], 1), ([1, 2, 0], 1), ([2, 0, 1], 1), ([2, 1, 0], -1), ([1, 0, 2], -1), ([0, 2, 1], -1)]
    {
        let product = times(&times(&entry(0, order[0]), &entry(1, order[1])), &entry(2, order[2]));
        determinant = plus(&determinant, &product, sign);
    }
    let p = QuasiPolynomial::new(determinant.iter().map(|p| UniPoly::from_i64(p)).collect()).unwrap();
    assert_eq!((p.order(), p.delays(), p.kind()), (3, 3, Kind::Retarded));
    let cells = cells(&p, None);
    let places = places(&cells, 4);
    assert_eq!(cells.right[..4], [0, 2, 0, 2]);
    assert_eq!(places[..3], ["0.1623", "0.1859", "0.2220"].map(str::to_owned));
    counts_agree(&p, &cells);
}

#[test]
fn loops_that_are_never_stable_say_why() {
    let never = |p: &QuasiPolynomial| delay_cells(p, &Rational::ZERO, None, &Budget::unlimited()).unwrap().unwrap_err();
    assert_eq!(never(&quasi(&[&[1, 1], &[-1]])), Never::RootAtZero);
    assert_eq!(never(&quasi(&[&[-1, 0, 1], &[-1, 1]])), Never::FixedRoot); // s - 1 twice
    assert_eq!(never(&quasi(&[&[1, 1], &[1, 2]])), Never::Neutral);
    assert_eq!(never(&quasi(&[&[1, 1], &[2, 1]])), Never::Neutral); // |z| = 1 exactly
    assert_eq!(never(&quasi(&[&[1], &[2, 1]])), Never::Advanced);
}

#[test]
fn a_loop_with_a_small_gain_is_stable_for_all_dead_times() {
    let p = quasi(&[&[2, 2], &[1]]); // s + 1 + z/2
    let cells = cells(&p, None);
    assert!(cells.switches.is_empty() && cells.right == [0] && !cells.touching_for_ever);
    counts_agree(&p, &cells);
}

#[test]
fn a_neutral_loop_is_counted_as_its_crossings_say() {
    // (s + 1)(1 + z/2) + 3 z: 2(s + 1) + (s + 7) z
    let p = quasi(&[&[2, 2], &[7, 1]]);
    assert_eq!(p.kind(), Kind::Neutral);
    let cells = cells(&p, None);
    assert_eq!(cells.right[..2], [0, 2]);
    counts_agree(&p, &cells);
}

#[test]
fn a_pair_on_the_axis_without_delay_moves_by_its_direction() {
    // s^2 + 1 + s z/10 - s/10: the pair +-i at tau = 0
    let p = quasi(&[&[10, -1, 10], &[0, 1]]);
    let found = cells(&p, Some("20"));
    counts_agree(&p, &found);
    let p = quasi(&[&[10, 1, 10], &[0, -1]]);
    let found = cells(&p, Some("20"));
    counts_agree(&p, &found);
}

#[test]
fn roots_that_touch_the_axis_split_a_window_and_cross_nothing() {
    // |P_0|^2 - |P_1|^2 = (w + 1)^2: s^2 + s + 1 and sqrt-free numerators: (2 + s)^2 ... see the ratio below.
    // P_0 = s^2 + 2 s + 2, P_1 = 2 s + 1?: |P_0|^2 = x^4 + 4, |P_1|^2 = 4 x^2 + 1 at s = i x: difference (x^2 - 1)(x^2 - 3)
    // P_1 = 2 s: difference x^4 - 4 x^2 + 4 = (x^2 - 2)^2.
    let p = quasi(&[&[2, 2, 1], &[0, 2]]);
    let found = cells(&p, Some("12"));
    assert!(!found.switches.is_empty());
    assert!(found.right.iter().all(|&c| c == 0), "{:?}", found.right);
    counts_agree(&p, &found);
    let for_ever = cells(&p, None);
    assert!(for_ever.touching_for_ever);
}

#[test]
fn dead_times_of_commensurate_frequencies_can_be_equal() {
    // (s^2 + 1 - z/5) (s^2 + 4 - 4 z/5) : omega doubled, dead times of the second half of those of the first: all of the
    // second's odd multiples of pi/sqrt(4.8) meet none, every second of 2 pi/sqrt(3.2) meets one of 2 pi/sqrt(0.8).
    let one = [UniPoly::from_i64(&[5, 0, 5]), UniPoly::from_i64(&[-1])];
    let two = [UniPoly::from_i64(&[20, 0, 5]), UniPoly::from_i64(&[-4])];
    let parts = vec![one[0].times(&two[0]), one[0].times(&two[1]).plus(&one[1].times(&two[0])), one[1].times(&two[1])];
    let p = QuasiPolynomial::new(parts).unwrap();
    let found = cells(&p, Some("15"));
    assert!(found.switches.iter().any(|s| s.members.len() == 2));
    counts_agree(&p, &found);
}
