//! Boxes of two parameters against the exact count at points, and against a walk that has to keep away from zero everywhere.

use super::dyadic::{Dyadic, Step};
use super::plane_function::PlaneFunction;
use super::plane_walk::{Known, Walk};
use super::{DeadTime, PlaneLoop, QuasiPolynomial, count_delayed_roots};
use crate::Range;
use crate::plane::boxes::{BoxMap, BoxVerdict, Place, PlaneBox, Seen, Window};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{MultiPoly, UniPoly};
use proptest::prelude::*;

/// `P_0 + P_1 exp(-tau s)` with coefficients `a + b x + c y`, and `tau = t_0 + t_1 x + t_2 y`.
#[derive(Clone, Debug)]
struct Case {
    parts: [Vec<[i64; 3]>; 2],
    time: [i64; 3],
    /// Where this vanishes the loop is undefined.
    pole: Option<[i64; 3]>,
}

fn case(first: &[[i64; 3]], second: &[[i64; 3]], time: [i64; 3]) -> Case {
    Case { parts: [first.to_vec(), second.to_vec()], time, pole: None }
}

fn polynomial([a, b, c]: [i64; 3]) -> MultiPoly {
    let constant = |c: i64| MultiPoly::constant(c.into());
    &constant(a) + &(&(&constant(b) * &MultiPoly::variable(0)) + &(&constant(c) * &MultiPoly::variable(1)))
}

fn window(x: [i64; 2], y: [i64; 2]) -> Window {
    let side = |[low, high]: [i64; 2]| Range::between(Some(low.into()), Some(high.into()));
    Window::new(&side(x), &side(y)).unwrap()
}

impl Case {
    fn plane(&self) -> PlaneLoop {
        let [a, b, c] = self.time.map(Rational::from);
        let time = DeadTime { offset: a, slopes: [b, c] };
        let part = |k: usize| self.parts[k].iter().copied().map(polynomial).collect();
        let terms = [(DeadTime::default(), part(0)), (time.clone(), part(1))];
        PlaneLoop::new(terms.into(), vec![time], self.pole.map(polynomial).into_iter().collect())
    }

    /// The roots on the axis and to the right of it; `None` where the loop is undefined, and of infinitely many.
    fn right(&self, x: &Rational, y: &Rational) -> Option<usize> {
        let at = |[a, b, c]: [i64; 3]| Rational::from(a) + &Rational::from(b) * x + &Rational::from(c) * y;
        let values = self.parts.each_ref().map(|part| part.iter().copied().map(at).collect::<Vec<_>>());
        let common = values.iter().flatten().fold(Integer::ONE, |l, v| l.lcm(&v.denominator()));
        let whole = |v: &Rational| (v * &Rational::from(&common)).numerator();
        let parts = values.iter().map(|part| UniPoly::new(part.iter().map(whole).collect())).collect();
        if self.pole.is_some_and(|pole| at(pole).is_zero()) {
            return None;
        }
        let count = count_delayed_roots(&QuasiPolynomial::new(parts)?, &at(self.time), &Budget::unlimited()).ok()?;
        Some(count.right? + count.on)
    }

    fn map(&self, window: &Window, goal: &str) -> BoxMap {
        self.plane().boxes(window, &goal.parse().unwrap(), &Budget::unlimited()).unwrap()
    }

    /// Of some boxes, chosen evenly, points have what is said of all.
    fn agrees(&self, map: &BoxMap, boxes: usize) {
        let decided: Vec<&PlaneBox> = map.boxes.iter().filter(|b| b.verdict != BoxVerdict::Undecided).collect();
        let inner = |[low, high]: &[Rational; 2], share: usize| {
            low + &((high - low) * Rational::new((share as i64).into(), 101.into()))
        };
        for (k, b) in decided.iter().enumerate().step_by(1 + decided.len() / boxes) {
            let (x, y) = (inner(&b.window.x, 1 + k * 37 % 100), inner(&b.window.y, 1 + k * 53 % 100));
            let right = self.right(&x, &y);
            match b.verdict {
                BoxVerdict::Stable => assert_eq!(right, Some(0), "{self:?} ({x}, {y})"),
                BoxVerdict::Unstable { outside: Some(n) } => assert_eq!(right, Some(n), "{self:?} ({x}, {y})"),
                _ => assert_ne!(right, Some(0), "{self:?} ({x}, {y})"),
            }
        }
    }
}

fn share(map: &BoxMap, verdict: fn(&BoxVerdict) -> bool) -> f64 {
    let area = map.boxes.iter().filter(|b| verdict(&b.verdict)).fold(Rational::ZERO, |sum, b| sum + b.window.area());
    (area / map.window.area()).to_f64_approximate()
}

/// The number of roots to the right in a box where the function stays within a cone about its value in the middle of each step: quarter
/// turns are counted, and no step may come near to zero.
fn by_cones(function: &PlaneFunction, place: &Place) -> Option<usize> {
    let (bound, is_negative) = function.bound(place)?;
    let walk = Walk::new(function, place);
    let (mut at, mut step) = (Dyadic::zero(), Step(bound as i64 - 4));
    let end = Rational::from(&(&Integer::ONE << bound));
    let nearer = |last: i64, next: i64| match (next - last).rem_euclid(4) {
        2 => None,
        turn => Some(last + if turn == 3 { -1 } else { turn }),
    };
    let mut way: Option<(i64, i64)> = None;
    while at.rational() < end {
        match walk.local(&at.plus(step, 1), step).quarter() {
            Some(next) => {
                let (first, last) = way.unwrap_or((next, next));
                way = Some((first, nearer(last, next)?));
                at = at.plus(step, 0);
            }
            None if step.0 < -12 => return None,
            None => step = Step(step.0 - 1),
        }
    }
    let (first, last) = way?;
    let n = function.order as i64;
    // The value at zero is real.
    let first = if first.rem_euclid(2) == 0 { first } else { nearer(first, if walk.starts_below() { 2 } else { 0 })? };
    let last = nearer(last, (n + if is_negative { 2 } else { 0 }).rem_euclid(4))?;
    Some(((n - (last - first)) / 2) as usize)
}

#[test]
#[ignore = "long: CI runs it"]
fn what_keeps_away_from_zero_is_decided_as_by_cones() {
    // Chatter, and a gain and a dead time.
    for case in [
        case(&[[5, 5, 0], [1, 0, 0], [5, 0, 0]], &[[0, -5, 0]], [0, 0, 1]),
        case(&[[0, 0, 0], [8, 0, 0], [80, 0, 0]], &[[0, 2, 0], [0, 16, 0]], [0, 0, 1]),
    ] {
        let function = PlaneFunction::new(case.plane().in_shares(&window([0, 4], [0, 8])));
        let mut seen = [0; 2];
        for k in 0..128u128 {
            let place = Place { at: [k % 16, 5 * k % 64], halvings: [4, 6] };
            let decided = function.look(&place, None).0;
            if let Some(right) = by_cones(&function, &place) {
                let verdict = match right {
                    0 => BoxVerdict::Stable,
                    right => BoxVerdict::Unstable { outside: Some(right) },
                };
                assert_eq!(decided, Seen::Decided(verdict), "{place:?}");
                seen[usize::from(right > 0)] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n > 0), "{seen:?}");
    }
}

#[test]
fn a_part_of_a_box_is_decided_alike_with_what_is_known_of_the_whole() {
    let case = case(&[[5, 5, 0], [1, 0, 0], [5, 0, 0]], &[[0, -5, 0]], [0, 0, 1]);
    let function = PlaneFunction::new(case.plane().in_shares(&window([0, 3], [0, 12])));
    let mut both = 0;
    for k in 0..24u128 {
        let (seen, known): (Seen, Option<Known>) =
            function.look(&Place { at: [k % 8, 7 * k % 16], halvings: [3, 4] }, None);
        let Seen::Cut(_) = seen else { continue };
        for part in [0, 1] {
            let place = Place { at: [2 * (k % 8) + part, 2 * (7 * k % 16)], halvings: [4, 5] };
            let is_stable = |seen: Seen| match seen {
                Seen::Decided(verdict) => Some(verdict == BoxVerdict::Stable),
                Seen::Cut(_) => None,
            };
            let [with, without] = [known.as_ref(), None].map(|known| is_stable(function.look(&place, known).0));
            assert!(with == without || with.is_none() || without.is_none(), "{place:?}");
            both += usize::from(with.is_some() && without.is_some());
        }
    }
    assert!(both > 5, "{both}");
}

#[test]
fn curves_of_further_roots_leave_nothing_undecided() {
    // s + x exp(-y s): pairs cross at x y = pi/2 + 2 pi k; beyond the first curve all is unstable.
    let case = case(&[[0, 0, 0], [1, 0, 0]], &[[0, 1, 0]], [0, 0, 1]);
    let window = window([5, 9], [4, 8]);
    let map = case.map(&window, "0");
    let cut_by_curves = |b: &&PlaneBox| b.verdict == BoxVerdict::Unstable { outside: None };
    assert!(map.boxes.iter().filter(cut_by_curves).count() > 5);
    assert!(
        map.areas.undecided.is_zero() && map.areas.stable.is_zero() && map.boxes.len() < 2000,
        "{}",
        map.boxes.len()
    );
    case.agrees(&map, 20);
}

#[test]
fn a_root_that_crosses_at_zero_is_one_root() {
    // s + 2 + x exp(-y s): a root at zero where x = -2, unstable below; with more roots where y is large and x > 2.
    let case = case(&[[2, 0, 0], [1, 0, 0]], &[[0, 1, 0]], [0, 0, 1]);
    let map = case.map(&window([-5, 3], [0, 3]), "1/20");
    let unstable = share(&map, |v| matches!(v, BoxVerdict::Unstable { .. }));
    assert!((0.35..0.5).contains(&unstable) && map.stopped.is_none(), "{unstable}");
    case.agrees(&map, 40);
}

#[test]
fn a_double_root_on_the_axis_stays_undecided() {
    // (s^2 + 1)^2 + x (s + 1) exp(-y s): twice s = i where x = 0, with no slope there.
    let case = case(&[[1, 0, 0], [0; 3], [2, 0, 0], [0; 3], [1, 0, 0]], &[[0, 1, 0], [0, 1, 0]], [0, 0, 1]);
    let map = case.map(&window([-1, 2], [0, 4]), "1/5");
    let at_axis = |b: &&PlaneBox| b.window.x[0] < 0.into() && b.window.x[1] > 0.into();
    assert!(map.boxes.iter().filter(at_axis).all(|b| b.verdict != BoxVerdict::Stable));
    case.agrees(&map, 40);
}

#[test]
fn roots_that_stay_on_the_axis_are_never_stable() {
    // s (s + x + exp(-y s)) and (s^2 + 1)(s + x + exp(-y s)).
    let cases = [
        case(&[[0; 3], [0, 1, 0], [1, 0, 0]], &[[0; 3], [1, 0, 0]], [0, 0, 1]),
        case(&[[0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]], &[[1, 0, 0], [0; 3], [1, 0, 0]], [0, 0, 1]),
    ];
    for case in cases {
        let budget = Budget::with_work(3_000_000);
        let map = case.plane().boxes(&window([-2, 2], [0, 4]), &"1/4".parse().unwrap(), &budget).unwrap();
        assert!(map.areas.stable.is_zero());
        case.agrees(&map, 20);
    }
}

#[test]
fn a_parameter_on_which_nothing_depends_is_not_cut() {
    // s + x exp(-s), stable for 0 < x < pi/2.
    let case = case(&[[0, 0, 0], [1, 0, 0]], &[[0, 1, 0]], [1, 0, 0]);
    let map = case.map(&window([0, 4], [0, 1]), "1/100");
    assert!(map.boxes.iter().all(|b| b.window.y == [0.into(), 1.into()]), "{}", map.boxes.len());
    case.agrees(&map, 20);
}

#[test]
#[ignore = "long: CI runs it"]
fn a_loop_of_neutral_type_is_unstable_where_its_difference_operator_is() {
    // s + 1 + x (s + 4) exp(-y s).
    let case = case(&[[1, 0, 0], [1, 0, 0]], &[[0, 4, 0], [0, 1, 0]], [0, 0, 1]);
    let map = case.map(&window([-3, 3], [1, 2]), "1/10");
    let is_beyond = |b: &&PlaneBox| b.window.x[0] >= 1.into() || b.window.x[1] <= (-1).into();
    let decided = |b: &&PlaneBox| b.verdict == BoxVerdict::Unstable { outside: None };
    let beyond = || map.boxes.iter().filter(is_beyond);
    assert!(beyond().filter(decided).fold(Rational::ZERO, |sum, b| sum + b.window.area()) > "3.5".parse().unwrap());
    assert!(beyond().all(|b| b.verdict != BoxVerdict::Stable));
    case.agrees(&map, 20);
}

#[test]
fn a_box_with_a_pole_is_never_stable_and_may_be_unstable() {
    // s + x exp(-y s), undefined at x + y = 3, which is in both parts.
    let pole = Some([-3, 1, 1]);
    let case = Case { pole, ..case(&[[0, 0, 0], [1, 0, 0]], &[[0, 1, 0]], [0, 0, 1]) };
    let map = case.map(&window([0, 4], [0, 4]), "1/20");
    let holds = |b: &&PlaneBox| {
        let sum = |k: usize| &b.window.x[k] + &b.window.y[k];
        sum(0) < 3.into() && sum(1) > 3.into()
    };
    let held = || map.boxes.iter().filter(holds);
    assert!(held().all(|b| matches!(b.verdict, BoxVerdict::Undecided | BoxVerdict::Unstable { outside: None })));
    assert!(held().any(|b| b.verdict == BoxVerdict::Unstable { outside: None }));
    case.agrees(&map, 20);
}

#[test]
fn a_dead_time_that_is_zero_everywhere_is_no_negative_one() {
    // s + x + y, with a dead time of zero beside.
    let terms = [(DeadTime::default(), vec![polynomial([0, 1, 1]), polynomial([1, 0, 0])])];
    let plane = PlaneLoop::new(terms.into(), vec![DeadTime::default()], Vec::new());
    let map = plane.boxes(&window([0, 1], [1, 2]), &"1/10".parse().unwrap(), &Budget::unlimited()).unwrap();
    assert_eq!(map.areas.stable, map.window.area());
}

fn coefficient() -> impl Strategy<Value = [i64; 3]> {
    [-3i64..=3, -2i64..=2, -2i64..=2]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    #[ignore = "long: CI runs it"]
    fn points_of_boxes_have_their_count(
        first in prop::collection::vec(coefficient(), 2..4),
        second in prop::collection::vec(coefficient(), 1..3),
        time in [0i64..=1, 0i64..=1, 0i64..=2],
    ) {
        prop_assume!(time != [0; 3]);
        let mut first = first;
        first.push([4, 0, 1]);
        let case = case(&first, &second, time);
        let budget = Budget::with_work(2_000_000);
        if let Ok(map) = case.plane().boxes(&window([0, 2], [0, 2]), &"1/3".parse().unwrap(), &budget) {
            case.agrees(&map, 8);
        }
    }
}
