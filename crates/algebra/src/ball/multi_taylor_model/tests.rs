//! Taylor models in several variables, against balls at points.

use super::super::{Series, fundamental_solutions};
use super::*;
use crate::number::{Rational, parse_number};
use proptest::prelude::*;

const BITS: u64 = 160;

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn ball(x: &Rational) -> Ball {
    Ball::from_rational(x, BITS)
}

/// Where the value at a point is.
fn value(model: &MultiTaylorModel, point: &[Rational]) -> Ball {
    let polynomial = model.terms().fold(Ball::zero(BITS), |sum, (exponents, c)| {
        let powers = exponents.iter().zip(point).map(|(&e, x)| ball(x).power(u64::from(e)));
        sum.add(&powers.fold(Ball::from_units(c.clone(), c.clone(), BITS), |product, p| product.mul(&p)))
    });
    polynomial.widened(model.rest_units())
}

/// The same of a model and of balls, at points of the polydisc.
fn holds(
    f: impl Fn(&[MultiTaylorModel]) -> Option<MultiTaylorModel>,
    g: impl Fn(&[Ball]) -> Option<Ball>,
    lines: &[[Rational; 2]; 2],
) -> usize {
    let mut seen = 0;
    for degree in [1, 3, 6] {
        let own: Vec<(Ball, Ball)> = lines.iter().map(|[m, r]| (ball(m), ball(r))).collect();
        let Some(model) = f(&MultiTaylorModel::linear(&own, degree)) else { continue };
        for (x, y) in [("-1", "1"), ("1", "1"), ("0", "-1"), ("-3/7", "2/5"), ("1/3", "0")] {
            let point = [number(x), number(y)];
            let there: Vec<Ball> = lines.iter().zip(&point).map(|([m, r], x)| ball(&(m + &(r * x)))).collect();
            let exact = g(&there).expect("defined on the polydisc");
            assert!(value(&model, &point).intersection(&exact).is_some(), "{lines:?} {x} {y} to degree {degree}");
            seen += 1;
        }
    }
    seen
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if std::env::var_os("JURIST_THOROUGH").is_some() { 32 } else { 8 }))]

    #[test]
    fn models_hold_the_values_of_what_they_stand_for(m in prop::array::uniform2(-40i64..40), r in prop::array::uniform2(0i64..10), a in -9i64..9) {
        let lines = [0, 1].map(|i| [Rational::new(m[i].into(), 8.into()), Rational::new(r[i].into(), 8.into())]);
        let a = Integer::from(a);
        let polynomial = |p: &[MultiTaylorModel]| p[0].mul(&p[1]).sub(&p[1].scaled(&a)).add(&p[0].integer(&a));
        let at_point = |p: &[Ball]| p[0].mul(&p[1]).sub(&p[1].scaled(&a)).add(&Ball::from_integer(&a, BITS));
        prop_assert!(holds(|p| Some(polynomial(p)), |p| Some(at_point(p)), &lines) == 15);
        holds(|p| p[0].div(&polynomial(p)), |p| p[0].div(&at_point(p)), &lines);
        holds(|p| polynomial(p).sqrt(), |p| at_point(p).sqrt(), &lines);
        holds(|p| Some(p[0].mul(&p[1]).exp().mul(&p[1])), |p| Some(exp(&p[0].mul(&p[1])).mul(&p[1])), &lines);
    }

    /// The solutions of `y'' + x y' + y x = 0`, at times about `y`, against exponentials at points.
    #[test]
    fn models_of_solutions_hold_those_at_points(m in prop::array::uniform2(1i64..24), r in prop::array::uniform2(0i64..6)) {
        let lines = [0, 1].map(|i| [Rational::new(m[i].into(), 8.into()), Rational::new(r[i].into(), 16.into())]);
        for k in 0..2 {
            let constant = |c: &Ball| Series::constant(c, 1);
            holds(
                |p| Some(p[1].solutions(&[p[0].mul(&p[1]), p[0].clone()]).swap_remove(k)),
                |p| Some(fundamental_solutions(&[constant(&p[0].mul(&p[1])), constant(&p[0])], &constant(&p[1]))[k].coefficients()[0].clone()),
                &lines,
            );
        }
    }
}

#[test]
fn what_may_vanish_in_the_polydisc_is_no_divisor() {
    let at = |m: &str, r: &str| {
        let [x, y] = [("0", "1/2"), (m, r)].map(|(m, r)| (ball(&number(m)), ball(&number(r))));
        let [x, y]: [MultiTaylorModel; 2] = MultiTaylorModel::linear(&[x, y], 3).try_into().unwrap();
        x.add(&y)
    };
    let one = at("1", "0").integer(&Integer::ONE);
    assert!(one.div(&at("1", "1/2")).is_none() && one.div(&at("1", "-5/8")).is_none());
    assert!(one.div(&at("1", "3/8")).is_some() && at("-3", "1/8").sqrt().is_none());
}

/// Of `1/(1 - (x + y)/8)` and `sqrt(1 - (x + y)/8)` to degree 5, what is left out is the sixth powers and beyond.
#[test]
fn what_is_left_out_is_as_small_as_the_first_powers() {
    let lines = [("1/2", "1/8"), ("1/2", "1/8")].map(|(m, r)| (ball(&number(m)), ball(&number(r))));
    let [x, y]: [MultiTaylorModel; 2] = MultiTaylorModel::linear(&lines, 5).try_into().unwrap();
    let sum = x.add(&y);
    let rest = |model: MultiTaylorModel| Rational::dyadic(model.rest_units(), BITS);
    // 4^-6 (1 + 1/4 + ..) = 0.000325...
    let quotient = rest(x.integer(&Integer::ONE).div(&sum).unwrap());
    assert!(quotient > number("0.0003") && quotient < number("0.0006"), "{quotient}");
    let root = rest(sum.sqrt().unwrap());
    assert!(root < number("0.00005"), "{root}");
}

#[test]
fn models_of_parts_hold_what_the_whole_ones_do() {
    let lines = [("3/2", "1/2"), ("1/3", "1/8")].map(|(m, r)| (ball(&number(m)), ball(&number(r))));
    let [x, y]: [MultiTaylorModel; 2] = MultiTaylorModel::linear(&lines, 4).try_into().unwrap();
    let whole = x.mul(&y).exp().mul(&x).sub(&y);
    // A quarter of the one side, five sixteenths from its middle; a third of the other one.
    let inner = [("-5/16", "1/4"), ("2/3", "1/3")].map(|(m, r)| (ball(&number(m)), ball(&number(r))));
    let part = whole.along(&whole.lines(&inner));
    assert!(
        part.rest_units() < &(whole.rest_units() + &Integer::from(1000)) && part.rest_units() >= whole.rest_units()
    );
    for (u, v) in [("-1", "1"), ("1", "1"), ("0", "-1"), ("-3/7", "2/5")].map(|(u, v)| (number(u), number(v))) {
        let outer = [number("-5/16") + &number("1/4") * &u, number("2/3") + &number("1/3") * &v];
        let there = [number("3/2") + &number("1/2") * &outer[0], number("1/3") + &number("1/8") * &outer[1]];
        let [a, b] = there.map(|x| ball(&x));
        let exact = exp(&a.mul(&b)).mul(&a).sub(&b);
        assert!(value(&part, &[u, v]).intersection(&exact).is_some());
    }
    // The same lines in three variables: another one comes first.
    let like =
        MultiTaylorModel::linear(&[(ball(&number("0")), ball(&number("1"))), inner[0].clone(), inner[1].clone()], 4);
    let again = whole.along(&like[1..]);
    assert!(again.terms().filter(|(e, _)| e[0] == 0).map(|(_, c)| c).eq(part.terms().map(|(_, c)| c)));
    assert!(again.terms().filter(|(e, _)| e[0] > 0).all(|(_, c)| c.is_zero()));
    let half = ball(&number("1/4")).to_enclosure().upper().clone();
    assert_eq!(whole.lines(&inner)[0].as_line(), Some((number("-5/16"), half)));
    assert!(whole.as_line().is_none() && whole.shifted(3).shifted(-3).terms().eq(whole.terms()));
    let none = whole.nothing();
    assert_eq!(none.along(&whole.lines(&inner)), none);
}

#[test]
fn values_at_corners_are_those_of_the_polynomial() {
    let lines = [("3/2", "1/2"), ("1/3", "1/8")].map(|(m, r)| (ball(&number(m)), ball(&number(r))));
    let [x, y]: [MultiTaylorModel; 2] = MultiTaylorModel::linear(&lines, 4).try_into().unwrap();
    let f = x.mul(&y).exp().mul(&x).sub(&y);
    for [u, v] in [[0, 0], [1, -1], [-1, -1], [0, 1], [-1, 0]] {
        let expected = value(&f, &[Rational::from(i64::from(u)), Rational::from(i64::from(v))]);
        let found = f.at_corner(&[u, v]);
        assert!(found.intersection(&expected).is_some() && found.width_units() <= expected.width_units());
    }
}
