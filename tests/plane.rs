//! The decomposition of two parameters: hand-derived maps and singular cases.

use jurist::limits::Budget;
use jurist::matrix::CharacteristicPolynomial;
use jurist::number::{Rational, parse_number};
use jurist::poly::RationalFunction;
use jurist::stability::plane::{PlanePolynomial, StabilityMap, stability_map};
use jurist::stability::{AtPoint, Range, Region};

fn q(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn x() -> RationalFunction {
    RationalFunction::variable(0)
}

fn y() -> RationalFunction {
    RationalFunction::variable(1)
}

fn c(text: &str) -> RationalFunction {
    q(text).into()
}

fn polynomial(coefficients: Vec<RationalFunction>) -> PlanePolynomial {
    let formal_degree = coefficients.len() - 1;
    let poles = coefficients.iter().map(|f| f.denominator().clone()).collect();
    let variables = vec!["x".to_string(), "y".to_string()];
    PlanePolynomial::new(&CharacteristicPolynomial { variables, coefficients, formal_degree, poles, monic: false })
}

fn map(p: &PlanePolynomial, domain: [Range; 2], region: Region) -> StabilityMap {
    stability_map(p, &domain, region, &Budget::unlimited()).unwrap()
}

fn ends(r: &jurist::stability::AlgebraicInterval) -> (Option<String>, Option<String>) {
    let text = |e: &Option<jurist::poly::RealAlgebraic>| e.as_ref().map(|e| e.decimal(8));
    (text(&r.lower), text(&r.upper))
}

fn some(a: &str, b: &str) -> (Option<String>, Option<String>) {
    (Some(a.into()), Some(b.into()))
}

#[test]
fn the_triangle_of_second_order() {
    // z^2 + x z + y: stable in the triangle |y| < 1, |x| < 1 + y.
    let p = polynomial(vec![y(), x(), c("1")]);
    let m = map(&p, [Range::all(), Range::all()], Region::UnitDisc);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), some("-2", "2"));
    assert_eq!(ends(&m.regions[0].y), some("-1", "1"));
    for i in -12..=12 {
        for j in -8..=8 {
            let (x, y) = (Rational::from(i) / Rational::from(5), Rational::from(j) / Rational::from(6));
            let expected = y.abs() < Rational::ONE && x.abs() < Rational::ONE + &y;
            let stable =
                matches!(p.at(&x, &y, Region::UnitDisc), AtPoint::Defined { count, infinite: 0 } if count.inside == 2);
            assert_eq!(stable, expected);
        }
    }
}

#[test]
fn two_discs_and_one_ring() {
    // z + (x^2 + y^2 - 4): stable in the ring 3 < x^2 + y^2 < 5, which is one region.
    let f = &(&(&x() * &x()) + &(&y() * &y())) - &c("4");
    let p = polynomial(vec![f, c("1")]);
    let m = map(&p, [Range::all(), Range::all()], Region::UnitDisc);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), some("-2.2360680", "2.2360680"));
    assert_eq!(ends(&m.regions[0].y), some("-2.2360680", "2.2360680"));
    // z + (x^2 - 1)^2 + y^2 - 1: a lemniscate-like pair of discs |(x^2-1)^2 + y^2 - 1| < 1 joined at x = 0.
    let g = &(&x() * &x()) - &c("1");
    let f = &(&(&g * &g) + &(&y() * &y())) - &c("1");
    let p = polynomial(vec![f, c("1")]);
    let m = map(&p, [Range::all(), Range::all()], Region::UnitDisc);
    // 0 < (x^2-1)^2 + y^2 < 2: one region without two points (isolated points (+-1, 0) are not stable).
    assert_eq!(m.regions.len(), 1);
    // The extent in y is known although the sample's y = 0 is a critical value of y.
    assert_eq!(ends(&m.regions[0].y), some("-1.4142136", "1.4142136"));
    let p = polynomial(vec![&(&(&g * &g) + &(&y() * &y())) + &c("1/2"), c("1")]);
    // -3/2 < (x^2-1)^2 + y^2 < 1/2: two discs.
    let m = map(&p, [Range::all(), Range::all()], Region::UnitDisc);
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
    let m = map(&PlanePolynomial::new(&p), [Range::all(), Range::all()], Region::UnitDisc);
    assert_eq!(m.regions.len(), 2);
    p.poles = vec![y().numerator().clone()];
    let m = map(&PlanePolynomial::new(&p), [Range::all(), Range::all()], Region::UnitDisc);
    assert_eq!(m.regions.len(), 2);
}

#[test]
fn identically_vanishing_boundaries() {
    // (z - 1)(z - x): never stable.
    let p = polynomial(vec![x(), -&(&x() + &c("1")), c("1")]);
    let m = map(&p, [Range::all(), Range::all()], Region::UnitDisc);
    assert!(m.never_stable && m.regions.is_empty());
}

#[test]
fn continuous_time() {
    // s^2 + x s + y: the open first quadrant.
    let p = polynomial(vec![y(), x(), c("1")]);
    let m = map(&p, [Range::all(), Range::all()], Region::LeftHalfPlane);
    assert_eq!(m.regions.len(), 1);
    assert_eq!(ends(&m.regions[0].x), (Some("0".into()), None));
    assert_eq!(ends(&m.regions[0].y), (Some("0".into()), None));
}
