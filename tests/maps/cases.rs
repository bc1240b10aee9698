//! The decomposition of two parameters: hand-derived maps and singular cases.

use crate::helpers::number::number;
use crate::helpers::plane::{
    c, disc, ends, first_order, is_stable, limits, map, plane, polynomial, said, says, some, square, x, y,
};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use jurist_engine::stability::plane::{PlanePolynomial, vanishing_boundary};
use jurist_engine::stability::{Cause, Range, Shape};

#[test]
fn the_triangle_of_second_order() {
    // z^2 + x z + y: stable in the triangle |y| < 1, |x| < 1 + y.
    let p = polynomial(vec![y(), x(), c("1")]);
    let m = disc(&p);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), some("-2", "2"));
    assert_eq!(ends(&m.regions[0].y), some("-1", "1"));
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    assert_eq!(said(&all[0].x[0]), says("-2", "z=1+complex pair"));
    assert_eq!(said(&all[0].x[1]), says("2", "z=-1+complex pair"));
    assert_eq!(said(&all[0].y[0]), says("-1", "z=1+z=-1"));
    assert_eq!(said(&all[0].y[1]), says("1", "complex pair"));
    // The corner at the left is (-2, 1), the side at the top a whole line.
    let corner = &all[0].x[0].as_ref().unwrap().at;
    assert!(corner.len() == 1 && corner[0][0].contains(&number("-2")) && corner[0][1].contains(&number("1")));
    assert!(all[0].y[1].as_ref().unwrap().along_line);
    for i in -12..=12 {
        for j in -8..=8 {
            let (x, y) = (Rational::from(i) / Rational::from(5), Rational::from(j) / Rational::from(6));
            let expected = y.abs() < Rational::ONE && x.abs() < Rational::ONE + &y;
            assert_eq!(is_stable(&p, &x, &y, Shape::UnitDisc), expected);
        }
    }
}

#[test]
fn two_discs_and_one_ring() {
    // z + (x^2 + y^2 - 4): stable in the ring 3 < x^2 + y^2 < 5, which is one region.
    let f = &(&(&x() * &x()) + &(&y() * &y())) - &c("4");
    let p = polynomial(vec![f, c("1")]);
    let m = disc(&p);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), some("-2.2360680", "2.2360680"));
    assert_eq!(ends(&m.regions[0].y), some("-2.2360680", "2.2360680"));
    // z + (x^2 - 1)^2 + y^2 - 1: a lemniscate-like pair of discs |(x^2-1)^2 + y^2 - 1| < 1 joined at x = 0.
    let g = &(&x() * &x()) - &c("1");
    let f = &(&(&g * &g) + &(&y() * &y())) - &c("1");
    let p = polynomial(vec![f, c("1")]);
    let m = disc(&p);
    // 0 < (x^2-1)^2 + y^2 < 2: one region without two points (isolated points (+-1, 0) are not stable).
    assert_eq!(m.regions.len(), 1);
    // The extent in y is known although the sample's y = 0 is a critical value of y.
    assert_eq!(ends(&m.regions[0].y), some("-1.4142136", "1.4142136"));
    let p = polynomial(vec![&(&(&g * &g) + &(&y() * &y())) + &c("1/2"), c("1")]);
    // -3/2 < (x^2-1)^2 + y^2 < 1/2: two discs.
    let m = disc(&p);
    assert_eq!(m.regions.len(), 2);
    assert_eq!(ends(&m.regions[0].y), some("-0.70710678", "0.70710678"));
}

#[test]
fn a_vertical_wall_separates() {
    // z^1 with pole on x = 0: z - 1/2 + 0/x.
    let zero_over_x = RationalFunction::zero();
    let mut p = CharacteristicPolynomial {
        variables: vec!["x".into(), "y".into()],
        coefficients: vec![&c("1/2") + &zero_over_x, c("1")],
        formal_degree: 1,
        poles: vec![x().numerator().clone()],
        monic: true,
    };
    let m = disc(&PlanePolynomial::new(&p));
    assert_eq!(m.regions.len(), 2);
    p.poles = vec![y().numerator().clone()];
    let m = disc(&PlanePolynomial::new(&p));
    assert_eq!(m.regions.len(), 2);
}

#[test]
fn identically_vanishing_boundaries() {
    // (z - 1)(z - x): never stable.
    let p = polynomial(vec![x(), -&(&x() + &c("1")), c("1")]);
    let m = disc(&p);
    assert!(m.never_stable && m.regions.is_empty());
    let why = |p: &PlanePolynomial, region| vanishing_boundary(p, region, &Budget::unlimited()).unwrap();
    assert_eq!(why(&p, Shape::UnitDisc), Some(Cause::RootAtOne));
    // (z + 1)(z - x); (z - 2)(z - 1/2); 0 z + x.
    let p = polynomial(vec![-&x(), &c("1") - &x(), c("1")]);
    assert_eq!(why(&p, Shape::UnitDisc), Some(Cause::RootAtMinusOne));
    let p = polynomial(vec![c("1"), c("-5/2"), c("1")]);
    assert_eq!(why(&p, Shape::UnitDisc), Some(Cause::ComplexPair));
    assert!(disc(&p).never_stable);
    let p = polynomial(vec![x(), RationalFunction::zero()]);
    assert_eq!(why(&p, Shape::UnitDisc), Some(Cause::DegreeLost));
    // s (s + x).
    let p = polynomial(vec![RationalFunction::zero(), x(), c("1")]);
    assert_eq!(why(&p, Shape::LeftHalfPlane), Some(Cause::RootAtZero));
    assert_eq!(why(&polynomial(vec![y(), x(), c("1")]), Shape::LeftHalfPlane), None);
}

#[test]
fn continuous_time() {
    // s^2 + x s + y: the open first quadrant.
    let p = polynomial(vec![y(), x(), c("1")]);
    let m = map(&p, &plane(), Shape::LeftHalfPlane);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), (Some("0".into()), None));
    assert_eq!(ends(&m.regions[0].y), (Some("0".into()), None));
}

#[test]
fn a_curve_that_is_only_touched_splits_the_region() {
    // f = 1 - (y - x^2)^2: stable for 0 < (y - x^2)^2 < 2, on either side of the parabola.
    let p = first_order(&c("1") - &square(&(&y() - &square(&x()))));
    let m = disc(&p);
    assert_eq!(m.regions.len(), 2);
    // Below: -sqrt(2) < y - x^2 < 0; above: 0 < y - x^2 < sqrt(2).
    assert_eq!(ends(&m.regions[0].x), (None, None));
    assert_eq!(ends(&m.regions[0].y), (Some("-1.4142136".into()), None));
    assert_eq!(ends(&m.regions[1].y), (Some("0".into()), None));
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    assert_eq!(said(&all[0].y[0]), says("-1.4142136", "z=1"));
    assert_eq!(said(&all[1].y[0]), says("0", "z=-1"));
    assert!(all[1].y[0].as_ref().unwrap().at[0][0].contains(&number("0")));
}

#[test]
fn curves_that_touch_do_not_split_the_region() {
    // (z - 1 + (y - x^2))(z + 1 - y): stable for x^2 < y < x^2 + 2 and 0 < y < 2; the two lower walls touch at
    // the origin, and the mirror pairs r1 r2 = 1 off the circle make a curve on which nothing happens.
    let first = &(&y() - &square(&x())) - &c("1");
    let second = &c("1") - &y();
    let p = polynomial(vec![&first * &second, &first + &second, c("1")]);
    let m = disc(&p);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), some("-1.4142136", "1.4142136"));
    assert_eq!(ends(&m.regions[0].y), some("0", "2"));
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    assert_eq!(said(&all[0].x[1]), says("1.4142136", "z=1"));
    // At (0, 0) y = 0 is touched from above by the parabola; there the roots are 1 and -1.
    assert_eq!(said(&all[0].y[0]), says("0", "z=1+z=-1"));
    for (i, j) in (-15..=15).flat_map(|i| (-2..=24).map(move |j| (i, j))) {
        let (x, y) = (Rational::from(i) / Rational::from(10), Rational::from(j) / Rational::from(11));
        let above = &y - &x * &x;
        let expected = above.sign().is_gt() && above < number("2") && y.sign().is_gt() && y < number("2");
        assert_eq!(is_stable(&p, &x, &y, Shape::UnitDisc), expected);
    }
}

#[test]
fn an_isolated_point_is_not_stable_and_does_not_split() {
    // f = 1 - x^2 - y^2: stable for 0 < x^2 + y^2 < 2.
    let p = first_order(&(&c("1") - &square(&x())) - &square(&y()));
    let m = disc(&p);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), some("-1.4142136", "1.4142136"));
    assert_eq!(ends(&m.regions[0].y), some("-1.4142136", "1.4142136"));
    let budget = Budget::unlimited();
    assert_eq!(m.locate(&number("0"), &number("0"), &Range::all(), &budget).unwrap(), None);
    let (s, k) = m.locate(&number("1e-9"), &number("0"), &Range::all(), &budget).unwrap().unwrap();
    assert!(m.strips[s].cells[k].stable);
    // x = 0 is a wall between strips: there the exact set in y has a hole.
    let set =
        jurist_engine::stability::stable_set(&p.at_x(&number("0")).unwrap(), &Range::all(), Shape::UnitDisc, &budget);
    let set = set.unwrap().to_interval_set().unwrap();
    assert_eq!(set.intervals().len(), 2);
    assert!(!set.contains(&number("0")) && set.contains(&number("1e-9")));
}

#[test]
fn vertical_lines_are_curves() {
    // z - 1 + x: stable for 0 < x < 2 whatever y is.
    let p = polynomial(vec![&x() - &c("1"), c("1")]);
    let m = disc(&p);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), some("0", "2"));
    assert_eq!(ends(&m.regions[0].y), (None, None));
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    assert_eq!(said(&all[0].x[0]), says("0", "z=1"));
    assert_eq!(said(&all[0].x[1]), says("2", "z=-1"));
    assert!(all[0].x[1].as_ref().unwrap().along_line);
    // The same with the parameters exchanged: horizontal lines.
    let m = disc(&p.swapped());
    assert_eq!(ends(&m.regions[0].y), some("0", "2"));
}

#[test]
fn curves_that_coincide_carry_both_causes() {
    // z^2 - (1 + x - y): roots 1 and -1 together on y = x, i and -i on y = x + 2.
    let p = polynomial(vec![&(&y() - &x()) - &c("1"), RationalFunction::zero(), c("1")]);
    let m = disc(&p);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(m.curves.iter().filter(|c| c.causes.to_string().starts_with("z=1+z=-1")).count(), 1);
    let slice = m.slice(&number("1/3"), &Range::all(), &Budget::unlimited()).unwrap().unwrap();
    assert_eq!(ends(&slice[0]), some("0.33333333", "2.3333333"));
    assert_eq!(ends(&m.regions[0].x), (None, None));
}

#[test]
fn a_region_without_bounds() {
    // z + x y: stable for |x y| < 1, one region around both axes.
    let p = first_order(&x() * &y());
    let m = disc(&p);
    assert_eq!(m.regions.len(), 1);
    assert_eq!((ends(&m.regions[0].x), ends(&m.regions[0].y)), ((None, None), (None, None)));
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    assert!(all[0].x.iter().chain(&all[0].y).all(Option::is_none));
    // In the open first quadrant it ends at both axes, which are edges and no walls.
    let quadrant = [Range::between(Some(number("0")), None), Range::between(Some(number("0")), None)];
    let m = map(&p, &quadrant, Shape::UnitDisc);
    let all = limits(&m, &p, &quadrant, Shape::UnitDisc);
    assert_eq!((m.regions.len(), said(&all[0].x[0])), (1, says("0", "domain")));
}

#[test]
fn regions_that_touch_in_a_point_are_two() {
    // f = y^2 - x^2 - 1: stable for 0 < y^2 - x^2 < 2, above and below, touching at the origin.
    let p = first_order(&(&square(&y()) - &square(&x())) - &c("1"));
    let m = disc(&p);
    assert_eq!(m.regions.len(), 2);
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    assert_eq!(said(&all[0].y[1]), says("0", "z=1"));
    assert_eq!(said(&all[1].y[0]), says("0", "z=1"));
    assert_eq!(ends(&m.regions[1].x), (None, None));
}

#[test]
fn an_extreme_value_at_infinity_of_the_other_parameter() {
    // z - 1 + x - 1/(y^2 + 1): stable for 0 < x - 1/(y^2 + 1) < 2; the least x is approached as y grows.
    let below = &square(&y()) + &c("1");
    let hump = RationalFunction::new(c("1").numerator().clone(), below.numerator().clone()).unwrap();
    let p = first_order(&(&x() - &hump) - &c("1"));
    let m = disc(&p);
    assert_eq!(ends(&m.regions[0].x), some("0", "3"));
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    let least = all[0].x[0].as_ref().unwrap();
    assert!(least.at.is_empty() && !least.along_line, "{least:?}");
    assert_eq!(said(&all[0].x[1]), says("3", "z=-1"));
    assert!(all[0].x[1].as_ref().unwrap().at[0][1].contains(&number("0")));
}

/// Found by a law, seldom: the simplest points above 5 of the line y = 0 were the corners of other curves.
#[test]
fn a_line_ends_a_region_wherever_other_curves_end_in_it() {
    // s^2 - y s + x - 5 - 5 x y: stable for y < 0 and x > 5/(1 - 5 y), which ends in the line y = 0 for x > 5.
    let least = &(&x() - &c("5")) - &(&c("5") * &(&x() * &y()));
    let p = polynomial(vec![least.clone(), &c("0") - &y(), c("1")]);
    let m = map(&p, &plane(), Shape::LeftHalfPlane);
    let greatest = |m, p| limits(m, p, &plane(), Shape::LeftHalfPlane)[0].y[1].clone().unwrap();
    let limit = greatest(&m, &p);
    assert_eq!((limit.causes.to_string().as_str(), limit.along_line), ("complex pair", true));
    // Between 5 and 6 + 7 y only.
    let most = &(&x() - &c("6")) - &(&c("-7") * &y());
    let p = polynomial(vec![&least * &(&c("0") - &most), &c("0") - &y(), c("1")]);
    let m = map(&p, &plane(), Shape::LeftHalfPlane);
    let limit = greatest(&m, &p);
    assert_eq!((limit.causes.to_string().as_str(), limit.along_line), ("complex pair", true));
}
