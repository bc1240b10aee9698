//! What is known of functions beyond all frequencies, of their chains of roots, and where they are known up to a bound.

use super::plane_function::{PlaneFunction, Shares};
use super::{DeadTime, PlaneLoop};
use crate::plane::boxes::{BoxVerdict, Place, Seen, Window};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::MultiPoly;

/// `a + b x + c y`
fn polynomial([a, b, c]: [i64; 3]) -> MultiPoly {
    MultiPoly::from_terms([(vec![0, 0], a), (vec![1, 0], b), (vec![0, 1], c)].map(|(e, c)| (e, Integer::from(c))))
}

fn polynomials(list: &[[i64; 3]]) -> Vec<MultiPoly> {
    list.iter().copied().map(polynomial).collect()
}

fn time([a, b, c]: [i64; 3]) -> DeadTime {
    DeadTime { offset: a.into(), slopes: [b.into(), c.into()] }
}

/// Coefficients with their dead times, and bounds of those of the first part.
fn function(parts: &[(&[[i64; 3]], [i64; 3])], slack: &[i64]) -> PlaneFunction {
    PlaneFunction::new(Shares {
        parts: parts.iter().map(|(part, _)| polynomials(part)).collect(),
        slack: slack.iter().copied().map(Integer::from).collect(),
        slack_axis: 0,
        poles: Vec::new(),
        delays: parts.iter().map(|(_, delay)| time(*delay)).collect(),
        times: Vec::new(),
    })
}

fn decided(function: &PlaneFunction) -> Option<BoxVerdict> {
    match function.look(&Place::whole(), None).0 {
        Seen::Decided(verdict) => Some(verdict),
        Seen::Cut(_) => None,
    }
}

#[test]
fn beyond_its_bound_the_highest_power_outweighs_the_rest_at_every_corner() {
    let own: [&[[i64; 3]]; 6] = [
        &[[9, 0, 0], [1, 0, 0]],
        &[[100, 0, 0], [0, 0, 0], [1, 0, 0]],
        &[[-20, 40, 0], [3, 0, 0], [2, 0, -1]],
        &[[0, 0, 0], [50, 0, 7], [2, -9, 0], [-4, 1, 1]],
        &[[1, 0, 0], [0, 0, 0], [0, 0, 3], [0, 0, 0], [2, 0, 0]],
        &[[5, 0, 0], [2, -1, 0]],
    ];
    let delayed: [&[[i64; 3]]; 6] = [
        &[[0, 0, 0]],
        &[[12, 0, 0]],
        &[[4, 0, 0], [3, 0, 0]],
        &[[0, 90, 0], [0, 0, 8]],
        &[[30, 0, -60], [0, -40, 0], [1, 0, 0]],
        &[[7, 0, 0], [0, 3, 0]],
    ];
    let (mut bounds, mut none) = (0, 0);
    for own in own {
        for delayed in delayed {
            for slack in [0, 3, 200] {
                let slack = [slack; 1];
                let function = function(&[(own, [0; 3]), (delayed, [1, 0, 0])], &slack);
                let Some((e, is_negative)) = function.bound(&Place::whole()) else {
                    none += 1;
                    continue;
                };
                bounds += 1;
                for [x, y] in [[0, 0], [0, 1], [1, 0], [1, 1]] {
                    let at = |list: &[[i64; 3]], j: usize| list.get(j).map_or(0, |[a, b, c]| a + b * x + c * y);
                    let n = own.len() - 1;
                    assert_eq!(at(own, n) < 0, is_negative, "{own:?} {delayed:?}");
                    for w in [1_i128 << e, 3 << e, 1 << (e + 4)] {
                        // The parts that are in line with the highest power, and those across, each with its sign.
                        let sum = |list: &[[i64; 3]], parity: usize| {
                            let signed = |j: usize| if j % 4 == n % 4 || j % 4 == (n + 1) % 4 { 1 } else { -1 };
                            (0..list.len())
                                .filter(|j| j % 2 == parity)
                                .fold(0, |sum, j| sum + signed(j) * i128::from(at(list, j)) * w.pow(j as u32))
                        };
                        let off = if n % 2 == 0 { i128::from(slack[0]) } else { 0 };
                        let line = sum(own, n % 2) * if is_negative { -1 } else { 1 } - off;
                        let square = sum(delayed, 0).pow(2) + sum(delayed, 1).pow(2);
                        assert!(line > 0 && line * line > square, "{own:?} {delayed:?} {slack:?} at {w}: 2^{e}");
                    }
                }
            }
        }
    }
    assert!(bounds > 20 && none > 5, "{bounds} {none}");
}

#[test]
fn coefficients_known_up_to_a_bound_are_not_told_from_zero_within_it() {
    let part = [[40, 0, 0], [30, 0, 0], [20, 0, 0], [0, 0, 0]];
    let whole = |slack: &[i64]| decided(&function(&[(&part, [0; 3])], slack));
    assert_eq!(whole(&[]), Some(BoxVerdict::Stable));
    assert_eq!(whole(&[1, 1, 1, 0]), Some(BoxVerdict::Stable));
    for slack in [[40, 0, 0, 0], [0, 30, 0, 0], [0, 0, 20, 0], [50, 40, 30, 0]] {
        assert_eq!(whole(&slack), None, "{slack:?}");
    }
    // Nor beyond all frequencies.
    let bound = |slack: &[i64]| function(&[(&part, [0; 3])], slack).bound(&Place::whole());
    assert_eq!((bound(&[0, 0, 15, 0]), bound(&[0, 0, 20, 0])), (Some((2, false)), None));
    // A power that only its bound is known of may be there.
    assert_eq!(whole(&[0, 0, 0, 1]), None);
}

#[test]
fn poles_known_up_to_a_bound_may_be_in_the_box() {
    let stable = |pole: [i64; 3], slack: i64| {
        let mut shares = Shares {
            parts: vec![polynomials(&[[1, 0, 0], [1, 0, 0]])],
            slack: Vec::new(),
            slack_axis: 0,
            poles: Vec::new(),
            delays: vec![DeadTime::default()],
            times: Vec::new(),
        };
        shares.poles.push((polynomial(pole), slack.into()));
        decided(&PlaneFunction::new(shares)) == Some(BoxVerdict::Stable)
    };
    assert!(stable([3, 0, 0], 2) && stable([3, -1, -1], 0) && stable([-9, 1, 1], 6));
    assert!(!stable([3, 0, 0], 3) && !stable([3, -1, -1], 1) && !stable([3, -2, -1], 0) && !stable([-1, 3, 0], 0));
}

/// `(1 + 3 x) s + 9 + 3 s exp(-s)`: a chain of roots to the right for `x < 2/3`; stable beyond.
#[test]
fn a_chain_of_roots_is_there_for_all_points_of_a_box_or_not_said() {
    let of = |own: [i64; 3], top: [i64; 3]| {
        decided(&function(&[(&[[9, 0, 0], own], [0; 3]), (&[[0, 0, 0], top], [1, 0, 0])], &[]))
    };
    assert_eq!(of([1, 3, 0], [3, 0, 0]), None);
    assert_eq!(of([1, 1, 0], [3, 0, 0]), Some(BoxVerdict::Unstable { outside: None }));
    assert_eq!(of([4, 0, 0], [3, 0, 0]), Some(BoxVerdict::Stable));
    assert_eq!(of([2, 0, 0], [1, 3, 0]), None);
    assert_eq!(of([4, 0, 0], [3, 2, 0]), None);
    // 10 s + 15 s z + 6 s z^2, z = exp(-s): no z of at most one makes that zero, though 15 is above 10.
    let three = function(
        &[
            (&[[50, 0, 0], [10, 0, 0]], [0; 3]),
            (&[[0, 0, 0], [15, 0, 0]], [1, 0, 0]),
            (&[[0, 0, 0], [6, 0, 0]], [2, 0, 0]),
        ],
        &[],
    );
    assert_eq!(decided(&three), None);
}

/// `x + s exp(-y s)` is `s + x exp(y s)`, with infinitely many roots to the right: no walk along the axis counts them.
#[test]
fn a_prediction_is_never_stable() {
    let terms =
        [(DeadTime::default(), polynomials(&[[0, 1, 0]])), (time([0, 0, 1]), polynomials(&[[0, 0, 0], [1, 0, 0]]))];
    let plane = PlaneLoop::new(terms.into(), vec![time([0, 0, 1])], Vec::new());
    let side = [Rational::ONE, Rational::from(2)];
    let window = Window { x: side.clone(), y: side };
    let budget = Budget::with_work(200_000);
    let map = plane.boxes(&window, &"1/2".parse().unwrap(), &budget).unwrap();
    assert!(map.boxes.iter().all(|b| b.verdict == BoxVerdict::Undecided));
}

/// `s + x exp(-(2 - y) s)`: of a dead time that falls over the box both ends are in its range.
#[test]
fn a_dead_time_that_falls_below_zero_is_no_loop() {
    let terms =
        [(DeadTime::default(), polynomials(&[[0, 0, 0], [1, 0, 0]])), (time([2, 0, -1]), polynomials(&[[0, 1, 0]]))];
    let plane = PlaneLoop::new(terms.into(), vec![time([2, 0, -1])], Vec::new());
    let of = |y: [i64; 2]| {
        let window = Window { x: ["1/8".parse().unwrap(), "1/4".parse().unwrap()], y: y.map(Rational::from) };
        let map = plane.boxes(&window, &"1/100".parse().unwrap(), &Budget::unlimited()).unwrap();
        (map.areas.stable.clone(), map.areas.unstable.clone(), map.window.area())
    };
    let (stable, unstable, area) = of([0, 1]);
    assert!(stable == area && unstable.is_zero());
    let (stable, unstable, area) = of([2, 3]);
    assert!(stable.is_zero() && unstable == area);
    let (stable, unstable, area) = of([1, 3]);
    assert!(&stable + &stable == area && &unstable + &unstable == area, "{stable} {unstable}");
}
