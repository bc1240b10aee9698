//! Boxes of two parameters: against exact counts, against the exact decomposition, against known areas.

use crate::helpers::budget::{cancelled_after, spent};
use crate::helpers::number::number;
use crate::helpers::plane::{c, first_order, polynomial, small_loop, square, x, y};
use crate::helpers::thorough::{count, tried};
use jurist_algebra::limits::{Budget, Stop};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_engine::stability::plane::boxes::{BoxMap, BoxVerdict, Window, stability_boxes};
use jurist_engine::stability::plane::{PlanePolynomial, stability_map};
use jurist_engine::stability::{AtPoint, Range, Shape};
use proptest::prelude::*;

fn window(x: [&str; 2], y: [&str; 2]) -> Window {
    let side = |[low, high]: [&str; 2]| Range::between(Some(number(low)), Some(number(high)));
    Window::new(&side(x), &side(y)).unwrap()
}

fn boxes(p: &PlanePolynomial, w: &Window, region: Shape, goal: &str) -> BoxMap {
    let map = stability_boxes(p, w, region, &number(goal), &Budget::unlimited()).unwrap();
    tiles_the_window(&map);
    map
}

/// Areas add up, the boxes lie inside and none begins where another does.
fn tiles_the_window(map: &BoxMap) {
    let sum = &(&map.areas.stable + &map.areas.unstable) + &map.areas.undecided;
    assert_eq!(sum, map.window.area());
    let of_boxes = map.boxes.iter().fold(Rational::ZERO, |sum, b| sum + b.window.area());
    assert_eq!(of_boxes, map.window.area());
    for pair in map.boxes.windows(2) {
        let corner = |k: usize| (&pair[k].window.x[0], &pair[k].window.y[0]);
        assert!(corner(0) < corner(1));
    }
    for b in &map.boxes {
        assert!(b.window.x[0] >= map.window.x[0] && b.window.x[1] <= map.window.x[1]);
        assert!(b.window.y[0] >= map.window.y[0] && b.window.y[1] <= map.window.y[1]);
    }
}

/// Whether the loop is stable at a point, and its roots outside where it is defined.
fn at(p: &PlanePolynomial, x: &Rational, y: &Rational, region: Shape) -> (bool, Option<usize>) {
    match p.at(x, y, region) {
        AtPoint::Defined { count, infinite } => {
            (infinite == 0 && count.inside == p.formal_degree(), Some(count.outside + infinite))
        }
        AtPoint::Undefined | AtPoint::Zero | AtPoint::Delayed { .. } => (false, None),
    }
}

/// Every box says of some points inside what the exact count says.
fn agrees_with_counts(map: &BoxMap, p: &PlanePolynomial, region: Shape) {
    let shares = [("1/7", "2/3"), ("12/13", "1/11"), ("1/1000", "999/1000")];
    for b in &map.boxes {
        for (s, t) in shares {
            let inside = |[low, high]: &[Rational; 2], share: &str| low + &((high - low) * number(share));
            let (x, y) = (inside(&b.window.x, s), inside(&b.window.y, t));
            let (stable, outside) = at(p, &x, &y, region);
            match b.verdict {
                BoxVerdict::Stable => assert!(stable, "({x}, {y})"),
                BoxVerdict::Unstable { outside: Some(k) } => {
                    assert!(!stable && outside == Some(k), "({x}, {y}): {outside:?} for {k}");
                }
                BoxVerdict::Unstable { outside: None } => assert!(!stable, "({x}, {y})"),
                BoxVerdict::Undecided => {}
            }
        }
    }
}

#[test]
fn the_triangle_has_its_area() {
    // z^2 + x z + y: stable in the triangle |y| < 1, |x| < 1 + y, of area 4.
    let p = polynomial(vec![y(), x(), c("1")]);
    let w = window(["-3", "3"], ["-7/3", "2"]);
    let map = boxes(&p, &w, Shape::UnitDisc, "1/100");
    assert!(map.stopped.is_none());
    assert!(&map.areas.undecided / &w.area() <= number("1/100"));
    assert!(map.areas.stable <= number("4") && &map.areas.stable + &map.areas.undecided >= number("4"));
    agrees_with_counts(&map, &p, Shape::UnitDisc);
}

#[test]
fn a_disc_in_continuous_time() {
    // s + 1 - x^2 - y^2: the open unit disc, of area between 3.14159 and 3.1416.
    let f = &c("1") - &(&square(&x()) + &square(&y()));
    let p = polynomial(vec![f, c("1")]);
    let map = boxes(&p, &window(["-2", "2"], ["-2", "2"]), Shape::LeftHalfPlane, "1/1000");
    assert!(map.areas.stable <= number("3.1416") && &map.areas.stable + &map.areas.undecided >= number("3.14159"));
    agrees_with_counts(&map, &p, Shape::LeftHalfPlane);
}

/// The corner at 0 is no mere touching: both edges of the first quadrant are boundary curves of the loop.
#[test]
fn edges_of_the_window_that_are_curves_leave_nothing_undecided() {
    // s^2 + x s + y: the open first quadrant.
    let p = polynomial(vec![y(), x(), c("1")]);
    let map = boxes(&p, &window(["0", "5"], ["0", "7"]), Shape::LeftHalfPlane, "1/1000000");
    assert_eq!(map.areas.stable, number("35"));
    assert_eq!(map.boxes.len(), 1);
    // The second quadrant, whose upper end in x is a curve.
    let map = boxes(&p, &window(["-5", "0"], ["0", "7"]), Shape::LeftHalfPlane, "1/1000000");
    assert_eq!((map.areas.unstable, map.boxes.len()), (number("35"), 1));
}

#[test]
fn touching_curves_stay_undecided_where_they_touch() {
    // z + 1 - (y - x^2)^2: |f| = 1 is touched along a parabola, stable on both sides of it.
    let f = &c("1") - &square(&(&y() - &square(&x())));
    let p = first_order(f);
    let map = boxes(&p, &window(["-1", "1"], ["-1/3", "1"]), Shape::UnitDisc, "1/100");
    agrees_with_counts(&map, &p, Shape::UnitDisc);
    for k in -9..=9 {
        // Points of the parabola are not stable: no box that is decided holds one, and this window has no other.
        let x = Rational::from(k) / Rational::from(10);
        let found = map.locate(&x, &(&x * &x));
        assert!(found.is_none_or(|b| b.verdict == BoxVerdict::Undecided), "x = {x}");
    }
    assert_eq!(map.areas.unstable, Rational::ZERO);
    assert!(map.areas.stable > Rational::ZERO);
}

#[test]
fn a_region_thinner_than_a_box_is_never_called_unstable() {
    // Stable for 0 < y - x < 1/part only.
    let part = count(100, 1000);
    let share = |of: usize| number(&format!("1/{of}"));
    let f = &c("1") - &(&c(&(2 * part).to_string()) * &(&y() - &x()));
    let p = first_order(f);
    let map = boxes(&p, &window(["0", "1"], ["-1/7", "6/5"]), Shape::UnitDisc, &format!("1/{}", part / 20));
    for k in 1..40 {
        let x = Rational::from(k) / Rational::from(41);
        let inside = map.locate(&x, &(&x + &share(2 * part)));
        assert!(inside.is_none_or(|b| !matches!(b.verdict, BoxVerdict::Unstable { .. })));
    }
    agrees_with_counts(&map, &p, Shape::UnitDisc);
    // The area is about 1/part; a finer goal finds most of it.
    let fine = boxes(&p, &window(["0", "1"], ["-1/7", "6/5"]), Shape::UnitDisc, &format!("1/{}", 4 * part));
    assert!(fine.stopped.is_none());
    assert!(fine.areas.stable > share(2 * part) && fine.areas.stable <= share(part));
}

#[test]
fn never_stable_is_one_box() {
    // (z - 1)(z - x)
    let p = polynomial(vec![x(), -&(&x() + &c("1")), c("1")]);
    let map = boxes(&p, &window(["0", "1"], ["0", "2"]), Shape::UnitDisc, "1/100");
    assert_eq!((map.areas.unstable.clone(), map.boxes.len()), (number("2"), 1));
}

#[test]
fn poles_inside_the_window() {
    // z + 1/x: undefined on x = 0, stable for |x| > 1.
    let p = first_order(RationalFunction::new(MultiPoly::from(1), MultiPoly::variable(0)).unwrap());
    let map = boxes(&p, &window(["-3", "7/3"], ["0", "1"]), Shape::UnitDisc, "1/100");
    agrees_with_counts(&map, &p, Shape::UnitDisc);
    assert!(map.areas.stable <= number("10/3") && &map.areas.stable + &map.areas.undecided >= number("10/3"));
}

/// Near the corner the values of `x^12 + y^12` sink far below a unit of the fixed point of the whole window.
#[test]
fn precision_is_found_again() {
    let power = |v: &RationalFunction| square(&(&square(&square(v)) * &square(v)));
    let tiny = c("1e-40");
    // 1 - (x^12 + y^12 - 1e-40): stable outside of a small round square with half the side 10^(-10/3).
    let f = &c("1") - &(&(&power(&x()) + &power(&y())) - &tiny);
    let p = first_order(f);
    let map = boxes(&p, &window(["-1/3", "1"], ["-1/3", "1"]), Shape::UnitDisc, "1/10000000");
    assert!(map.stopped.is_none(), "{:?}", map.stopped);
    assert!(matches!(map.locate(&number("1e-5"), &number("1e-5")).unwrap().verdict, BoxVerdict::Unstable { .. }));
    assert_eq!(map.locate(&number("1e-3"), &number("1e-3")).unwrap().verdict, BoxVerdict::Stable);
    agrees_with_counts(&map, &p, Shape::UnitDisc);
}

#[test]
fn a_budget_that_runs_out_leaves_more_undecided() {
    let p = polynomial(vec![y(), x(), c("1")]);
    let w = window(["-3", "3"], ["-2", "2"]);
    assert!(stability_boxes(&p, &w, Shape::UnitDisc, &number("1/2"), &spent()).is_err());
    let map = stability_boxes(&p, &w, Shape::UnitDisc, &number("1e-12"), &cancelled_after(20)).unwrap();
    tiles_the_window(&map);
    assert_eq!(map.stopped, Some(Stop::Cancelled));
    assert!(map.areas.undecided > Rational::ZERO);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let f = &(&square(&(&square(&x()) - &c("1"))) + &square(&y())) + &c("1/2");
    let p = polynomial(vec![f, &x() * &y(), c("3")]);
    let w = window(["-2", "2"], ["-2", "5/3"]);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| boxes(&p, &w, Shape::UnitDisc, "1/500"))
    };
    let one = with(1);
    for threads in tried([3, 2], 2) {
        assert_eq!(one.boxes, with(threads).boxes);
    }
}

#[test]
fn windows_are_bounded() {
    let some = Range::between(Some(number("0")), Some(number("1")));
    assert!(Window::new(&some, &Range::all()).is_none());
    assert!(Window::new(&some, &Range::between(Some(number("1")), Some(number("1")))).is_none());
    assert!(Window::new(&some, &some).is_some());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(16, 48) as u32))]

    /// Boxes of random loops: exact counts in them agree, and so do the cells of the exact decomposition.
    #[test]
    fn random_loops(p in small_loop(), discrete in any::<bool>(), low in -3i64..=0, wide in 1i64..=4) {
        let region = if discrete { Shape::UnitDisc } else { Shape::LeftHalfPlane };
        let end = |v: i64| Some(Rational::from(v) / Rational::from(2));
        let sides = [Range::between(end(low), end(low + wide)), Range::between(end(-2), end(3))];
        let w = Window::new(&sides[0], &sides[1]).unwrap();
        let map = boxes(&p, &w, region, "1/40");
        agrees_with_counts(&map, &p, region);
        let budget = Budget::unlimited();
        let exact = stability_map(&p, &sides, region, &budget).unwrap();
        prop_assert!(!exact.never_stable || map.areas.unstable == w.area());
        for b in map.boxes.iter().step_by(7) {
            let (x, y) = (b.window.x[0].midpoint(&b.window.x[1]), b.window.y[0].midpoint(&b.window.y[1]));
            let Some((strip, cell)) = exact.locate(&x, &y, &sides[1], &budget).unwrap() else { continue };
            let cell = &exact.strips[strip].cells[cell];
            match b.verdict {
                BoxVerdict::Stable => prop_assert!(cell.stable),
                BoxVerdict::Unstable { .. } => prop_assert!(!cell.stable),
                BoxVerdict::Undecided => {}
            }
        }
        // Regions and boxes agree on whether anything is stable, as far as the boxes can tell.
        if map.areas.stable > Rational::ZERO {
            prop_assert!(!exact.regions.is_empty());
        }
    }
}
