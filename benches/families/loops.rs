//! The drive with a chain of filters in its current feedback, that of `pari/loop.gp`, and the steps
//! from its matrix to the limits.

use super::RELATIVE_BITS;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::real_roots::isolate_real_roots_fixed;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic, SquareFree, UniPoly};
use jurist_engine::stability::{HalfSizePair, Shape};

pub fn characteristic(m: &RationalMatrix) -> CharacteristicPolynomial {
    m.characteristic_polynomial(vec!["K".into(), "T".into()], &Budget::unlimited()).expect("no budget")
}

pub fn substituted(p: &CharacteristicPolynomial, variable: usize, value: &Rational) -> Poly<UniPoly> {
    p.on_line(variable, value).expect("defined there").0
}

pub fn boundary<R: Domain>(p: &Poly<R>, n: usize) -> R {
    HalfSizePair::new(p, n, Shape::UnitDisc).critical_constraint(&Budget::unlimited()).expect("no budget")
}

pub fn limits(p: &CharacteristicPolynomial, variable: usize, value: &Rational) -> Vec<RealAlgebraic> {
    let constraint = boundary(&substituted(p, variable, value), p.formal_degree);
    let square_free = SquareFree::part_of(&constraint).expect("not zero");
    isolate_real_roots_fixed(&square_free, RELATIVE_BITS, &Budget::unlimited()).expect("no budget")
}

/// The closed loop of the drive, variables `K` and `T`, with `filters` sections
/// `x' = (1 - a) x + a u`, `a = 3/10`, between the current and its comparison.
pub fn closed_loop(filters: usize) -> RationalMatrix {
    let n = 6 + filters;
    let (k, t) = (MultiPoly::variable(0), MultiPoly::variable(1));
    let kt = &k * &t;
    let number = |p: i64, q: i64| RationalFunction::from(Rational::new(p.into(), q.into()));
    // p/q times a monomial.
    let times = |m: &MultiPoly, p: i64, q: i64| RationalFunction::from(m.clone()) * number(p, q);
    let mut a = RationalMatrix::zeros(n, n);
    // Armature 1 ohm, 46 mH; 0.55 V s; 12 V carrier; current controller 10 and 500.
    a[(0, 0)] = number(1, 1) + times(&t, -1000, 46);
    a[(0, 1)] = times(&t, -550, 46);
    a[(0, 2)] = times(&kt, 10_000, 46 * 12);
    a[(0, 3)] = times(&kt, 500_000, 46 * 12);
    // Inertia 0.093, friction 0.008.
    a[(1, 0)] = times(&t, 550, 93);
    a[(1, 1)] = number(1, 1) + times(&t, -8, 93);
    // The current that is compared: measured, or behind the last filter.
    let current = if filters == 0 { 0 } else { n - 1 };
    a[(2, current)] = number(-1, 1);
    a[(2, 4)] = number(1, 1);
    a[(2, 5)] = number(5, 1);
    a[(3, current)] = times(&t, -1, 2);
    a[(3, 2)] = times(&t, 1, 2);
    a[(3, 3)] = number(1, 1);
    a[(3, 4)] = times(&t, 1, 2);
    a[(3, 5)] = times(&t, 5, 2);
    a[(4, 1)] = number(-1, 1);
    a[(5, 1)] = times(&t, -1, 2);
    a[(5, 4)] = times(&t, 1, 2);
    a[(5, 5)] = number(1, 1);
    for i in 0..filters {
        a[(6 + i, if i == 0 { 0 } else { 5 + i })] = number(3, 10);
        a[(6 + i, 6 + i)] = number(7, 10);
    }
    a
}
