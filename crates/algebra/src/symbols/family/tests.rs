//! Families of matrices against the characteristic polynomials of their matrices at points.

use super::super::ParametricSymbols;
use super::*;
use crate::ball::{BallMatrix, MultiTaylorModel, Series, exponential};
use crate::poly::{Domain, MultiPoly};

const BITS: u64 = 192;

fn number(text: &str) -> Rational {
    text.parse().unwrap()
}

fn ball(x: &Rational) -> Ball {
    Ball::from_rational(x, BITS)
}

/// The matrix `[[e00, e01, K e01], [e10, e11, L + K], [-1, 0, a]]` with the exponential of `[[0, t], [-a t, -1]]`: two parameters, two gains.
fn family() -> MatrixFamily {
    let x = RationalFunction::variable;
    let flow = RationalMatrix::from_fn(2, 2, |i, j| match (i, j) {
        (0, 0) => RationalFunction::zero(),
        (0, 1) => x(1),
        (1, 0) => -(&x(0) * &x(1)),
        _ => RationalFunction::from(number("-1")),
    });
    let steps = (0..4).map(|k| Step::Flow { of: 0, row: k / 2, column: k % 2 }).collect();
    let of = |entries: [RationalFunction; 9]| RationalMatrix::from_fn(3, 3, |i, j| entries[3 * i + j].clone());
    let zero = RationalFunction::zero;
    let constant = of([x(2), x(3), zero(), x(4), x(5), zero(), -RationalFunction::one(), zero(), x(0)]);
    let first = of([zero(), zero(), x(3), zero(), zero(), 1.into(), zero(), zero(), zero()]);
    let second = of([zero(), zero(), zero(), zero(), zero(), 1.into(), zero(), zero(), zero()]);
    let variables = FamilyVariables { parameters: 2, steps, flows: vec![flow] };
    MatrixFamily::new(variables, constant, vec![first, second], 2, vec![&x(2) * &x(0)]).unwrap()
}

/// `det((w + 1) I - A)` at numbers.
fn exact(a: &Rational, t: &Rational, [k, l]: [i64; 2]) -> Vec<Ball> {
    let zero = || ball(&Rational::ZERO);
    let e = exponential(&BallMatrix::from_fn(2, |i, j| match (i, j) {
        (0, 0) => zero(),
        (0, 1) => ball(t),
        (1, 0) => ball(&-(a * t)),
        _ => ball(&number("-1")),
    }));
    let n = |x: i64| ball(&x.into());
    let rows = [
        [e.at(0, 0).clone(), e.at(0, 1).clone(), e.at(0, 1).mul(&n(k))],
        [e.at(1, 0).clone(), e.at(1, 1).clone(), n(k + l)],
        [n(-1), zero(), ball(a)],
    ];
    BallMatrix::from_fn(3, |i, j| if i == j { rows[i][j].sub(&n(1)) } else { rows[i][j].clone() })
        .characteristic_polynomial(BITS)
}

fn sum(family: &MatrixFamily, values: &[Ball], gains: [i64; 2], power: usize) -> Ball {
    let terms = family.monomials().iter().enumerate().map(|(m, e)| {
        let factor = gains.iter().zip(e).fold(Integer::ONE, |p, (k, e)| &p * &Integer::from(*k).pow(u64::from(*e)));
        values[3 * m + power].scaled(&factor)
    });
    terms.fold(Ball::zero(BITS), |sum, t| sum.add(&t))
}

#[test]
fn values_are_the_coefficients_at_points_and_in_boxes() {
    let family = family();
    assert_eq!(family.monomials(), [vec![0, 0], vec![1, 0], vec![0, 1], vec![2, 0], vec![1, 1], vec![0, 2]]);
    let lines = [(ball(&number("2")), ball(&number("1/8"))), (ball(&number("1/2")), ball(&number("1/16")))];
    let models = MultiTaylorModel::linear(&lines, 5);
    let found = family.values(&models, &models[0]).unwrap();
    assert_eq!(found.len(), 6 * 3 + 1);
    for (x, y) in [("0", "0"), ("1", "-1"), ("-1/3", "1"), ("-1", "-1")].map(|(x, y)| (number(x), number(y))) {
        let (a, t) = (number("2") + &number("1/8") * &x, number("1/2") + &number("1/16") * &y);
        let at = |model: &MultiTaylorModel| {
            model
                .terms()
                .fold(Ball::zero(BITS), |sum, (e, c)| {
                    let powers = ball(&x).power(u64::from(e[0])).mul(&ball(&y).power(u64::from(e[1])));
                    sum.add(&powers.mul(&Ball::from_units(c.clone(), c.clone(), BITS)))
                })
                .widened(model.rest_units())
        };
        let in_box: Vec<Ball> = found.iter().map(at).collect();
        let point = [&a, &t].map(|x| Series::constant(&ball(x), 1));
        let at_point = family.values(&point, &point[0]).unwrap();
        let at_point: Vec<Ball> = at_point.iter().map(|s| s.coefficients()[0].clone()).collect();
        for gains in [[0, 0], [1, 0], [2, -3], [-5, 7]] {
            let expected = exact(&a, &t, gains);
            for (power, expected) in expected.iter().enumerate().take(3) {
                let value = sum(&family, &at_point, gains, power);
                assert!(value.intersection(expected).is_some() && value.width_units().bit_length() < 40);
                let value = sum(&family, &in_box, gains, power);
                assert!(value.intersection(expected).is_some());
                assert!(value.width_units().bit_length() < BITS - 8, "{value:?}");
            }
        }
    }
}

/// Over parts of a box on one side of a grid the values come from those over the box of the grid: they hold the same numbers, and not many more.
#[test]
fn values_over_parts_hold_those_at_points() {
    let family = family();
    for (radius, other) in [("1/16", "1/32"), ("1/100", "0"), ("1/5000", "1/900")] {
        let middles = [number("7/3"), number("5/9")];
        let lines = [radius, other].map(number);
        let own: Vec<(Ball, Ball)> = middles.iter().zip(&lines).map(|(m, r)| (ball(m), ball(r))).collect();
        let models = MultiTaylorModel::linear(&own, 5);
        let [near, own] =
            [family.values_near(&models, &models[0]), family.values(&models, &models[0])].map(Option::unwrap);
        for (x, y) in [("0", "0"), ("1", "-1"), ("-1/3", "1"), ("-1", "-1")].map(|(x, y)| (number(x), number(y))) {
            let point = [&middles[0] + &(&lines[0] * &x), &middles[1] + &(&lines[1] * &y)]
                .map(|x| Series::constant(&ball(&x), 1));
            let exact = family.values(&point, &point[0]).unwrap();
            for ((near, own), exact) in near.iter().zip(&own).zip(&exact) {
                let at = |model: &MultiTaylorModel| {
                    let value = model.terms().fold(Ball::zero(BITS), |sum, (e, c)| {
                        let powers = ball(&x).power(u64::from(e[0])).mul(&ball(&y).power(u64::from(e[1])));
                        sum.add(&powers.mul(&Ball::from_units(c.clone(), c.clone(), BITS)))
                    });
                    value.widened(model.rest_units())
                };
                let [found, direct] = [near, own].map(at);
                assert!(found.intersection(&exact.coefficients()[0]).is_some());
                // Fine to 2^-10 of what the function varies.
                let most =
                    (direct.width_units() << 4) + (own.range().width_units() >> 9) + (Integer::ONE << (BITS - 30));
                assert!(found.width_units() <= most, "{found:?} {direct:?}");
            }
        }
    }
}

#[test]
fn values_are_symbols_like_others() {
    let of = Arc::new(family());
    let [a, t] = [0, 1].map(RationalFunction::variable);
    // The first parameter is twice a name, the second one 1/2.
    let at = vec![&a + &a, number("1/2").into()];
    let own = |index: usize| Definition::Family(FamilyValue { of: Arc::clone(&of), index, at: at.clone() });
    let table = ParametricSymbols::new((0..19).map(|i| (format!("d{i}"), own(i))).collect());
    assert_eq!(table.parameters_inside(2), [0]);
    let name = Series::constant(&ball(&Rational::ONE), 1);
    let values = table.values(&[name.clone(), name]).unwrap();
    let p = MultiPoly::variable(2).plus(&MultiPoly::variable(5));
    let value = table.value(&p, &values).coefficients()[0].clone();
    let expected = [[0, 0], [1, 0]].map(|gains| exact(&number("2"), &number("1/2"), gains)[0].clone());
    // The sum of the coefficients beside 1 and K; that of K^2 is zero.
    assert!(value.intersection(&expected[1]).is_some() && value.intersection(&expected[0]).is_none());
    // Numbers, without names.
    let mut fixed = super::super::Symbols::new();
    let number_at = own(0).try_map(|f| f.substitute(0, &Rational::ONE)).unwrap();
    fixed.push("d", number_at);
    assert!(fixed.enclose(&MultiPoly::variable(0), BITS).intersection(&expected[0]).is_some());
    assert!(t != a && fixed.has_enclosed_numbers());
}

#[test]
fn many_gains_are_refused() {
    assert!(monomials(5, 3).is_none() && monomials(0, 9).is_some_and(|m| m.len() == 1));
    let lattice = monomials(2, 3).unwrap();
    let weights = weights(&lattice).unwrap();
    // x^2 y at the nodes: the weights give back its coefficient.
    let at = |node: &Vec<u32>| Rational::from(i64::from(node[0] * node[0] * node[1]));
    for (e, weights) in lattice.iter().zip(&weights) {
        let c = lattice.iter().zip(weights).fold(Rational::ZERO, |sum, (node, w)| sum + at(node) * w.clone());
        assert_eq!(c, if *e == [2, 1] { Rational::ONE } else { Rational::ZERO });
    }
}
