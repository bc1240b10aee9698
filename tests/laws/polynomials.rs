//! Laws of polynomials: ring axioms, divisors, resultants, decompositions, values.

use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{Matrix, determinant_bareiss};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::multivariate::strategies::{multi_poly, nonzero_multi_poly, rational_function};
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RationalFunction, UniPoly, discriminant, resultant, resultant_formal, subresultant_chain,
};
use proptest::prelude::*;

/// Degree below `max_length`, coefficients of the given size; one in four zero.
fn uni_poly(max_length: usize, bound: i64) -> impl Strategy<Value = UniPoly> {
    prop::collection::vec(prop_oneof![1 => Just(0), 3 => -bound..=bound], 0..=max_length)
        .prop_map(|c| UniPoly::from_i64(&c))
}

fn nonzero_uni_poly(max_length: usize, bound: i64) -> impl Strategy<Value = UniPoly> {
    uni_poly(max_length, bound).prop_map(|p| if p.is_zero() { UniPoly::one() } else { p })
}

fn linear_factors(roots: &[i64], lead: i64) -> UniPoly {
    roots.iter().fold(UniPoly::from_i64(&[lead]), |p, &r| p.times(&UniPoly::from_i64(&[-r, 1])))
}

/// The Sylvester matrix of formal degrees `n` and `m`.
fn sylvester<R: Domain>(a: &Poly<R>, n: usize, b: &Poly<R>, m: usize) -> Matrix<R> {
    Matrix::from_fn(n + m, n + m, |i, j| {
        let (p, degree, shift) = if i < m { (a, n, i) } else { (b, m, i - m) };
        if j >= shift && j - shift <= degree { p.coeff(degree - (j - shift)) } else { R::zero() }
    })
}

fn ring_axioms<R: Domain>(a: &R, b: &R, c: &R) {
    assert_eq!(a.plus(b), b.plus(a));
    assert_eq!(a.times(b), b.times(a));
    assert_eq!(a.plus(b).plus(c), a.plus(&b.plus(c)));
    assert_eq!(a.times(b).times(c), a.times(&b.times(c)));
    assert_eq!(a.times(&b.plus(c)), a.times(b).plus(&a.times(c)));
    assert_eq!(a.minus(b), a.plus(&b.negated()));
    assert!(a.minus(a).is_zero() && a.plus(&R::zero()) == *a && a.times(&R::one()) == *a);
    assert!(a.times(&R::zero()).is_zero());
    assert_eq!(a.power(3), a.times(a).times(a));
    assert!(a.power(0).is_one());
    let mut sum = a.clone();
    sum.add_times(b, c);
    assert_eq!(sum, a.plus(&b.times(c)));
    sum.sub_times(b, c);
    assert_eq!(&sum, a);
}

fn gcd_laws<R: Domain>(f: &R, a: &R, b: &R) {
    let g = a.gcd(b);
    assert_eq!(g, b.gcd(a));
    assert!(!g.needs_negation());
    if g.is_zero() {
        assert!(a.is_zero() && b.is_zero());
        return;
    }
    let (ca, cb) = (a.div_exact(&g).unwrap(), b.div_exact(&g).unwrap());
    assert!(ca.gcd(&cb).is_one(), "cofactors are coprime: {ca:?}, {cb:?}");
    let scaled = f.times(a).gcd(&f.times(b));
    let expected = f.times(&g);
    assert_eq!(scaled, if expected.needs_negation() { expected.negated() } else { expected });
    assert_eq!(a.gcd(a), if a.needs_negation() { a.negated() } else { a.clone() });
}

fn exact_division_laws<R: Domain>(a: &R, b: &R) {
    if !b.is_zero() {
        assert_eq!(a.times(b).div_exact(b), Some(a.clone()));
        if let Some(q) = a.div_exact(b) {
            assert_eq!(&q.times(b), a);
        }
    }
    assert_eq!(a.div_exact(&R::zero()), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn rings(
        (a, b, c) in (uni_poly(8, 30), uni_poly(8, 30), uni_poly(4, 30)),
        (x, y, z) in (multi_poly(3, 3, 5), multi_poly(3, 3, 5), multi_poly(3, 2, 3))
    ) {
        ring_axioms(&a, &b, &c);
        ring_axioms(&x, &y, &z);
    }

    #[test]
    fn many_variables_ring(x in multi_poly(7, 2, 4), y in multi_poly(6, 2, 4), z in multi_poly(2, 9, 3)) {
        ring_axioms(&x, &y, &z);
        exact_division_laws(&x, &y);
    }

    #[test]
    fn divisors(
        (f, a, b) in (nonzero_uni_poly(5, 20), uni_poly(6, 20), uni_poly(6, 20)),
        (g, x, y) in (nonzero_multi_poly(3, 2, 3), multi_poly(3, 2, 3), multi_poly(3, 2, 3))
    ) {
        gcd_laws(&f, &a, &b);
        exact_division_laws(&a, &f);
        gcd_laws(&g, &x, &y);
        exact_division_laws(&x, &g);
    }

    #[test]
    fn large_univariate_divisors(f in nonzero_uni_poly(14, i64::MAX / 2), a in uni_poly(20, i64::MAX / 2), b in uni_poly(20, 3)) {
        gcd_laws(&f, &a, &b);
    }

    #[test]
    fn pseudo_division(a in uni_poly(9, 50), b in nonzero_uni_poly(6, 50)) {
        let (q, r) = a.pseudo_div_rem(&b);
        let steps = (a.coeffs().len() + 1).saturating_sub(b.coeffs().len()) as u64;
        let factor = b.leading().unwrap().power(steps);
        prop_assert_eq!(a.scaled(&factor), q.times(&b).plus(&r));
        prop_assert!(r.coeffs().len() < b.coeffs().len());
        prop_assert_eq!(a.pseudo_rem(&b), r);
    }

    #[test]
    fn resultants_of_known_roots(
        (r, s) in (prop::collection::vec(-6i64..=6, 0..5), prop::collection::vec(-6i64..=6, 0..5)),
        (c, d) in (prop_oneof![-3i64..=-1, 1i64..=3], prop_oneof![-3i64..=-1, 1i64..=3])
    ) {
        let (a, b) = (linear_factors(&r, c), linear_factors(&s, d));
        let mut expected = &Integer::from(c).pow(s.len() as u64) * &Integer::from(d).pow(r.len() as u64);
        for x in &r {
            for y in &s {
                expected = &expected * &Integer::from(x - y);
            }
        }
        prop_assert_eq!(resultant(&a, &b, &Budget::unlimited()).unwrap(), expected);
        let mut disc = Integer::from(c).pow((2 * r.len()).saturating_sub(2) as u64);
        for i in 0..r.len() {
            for j in 0..i {
                disc = &disc * &Integer::from((r[i] - r[j]) * (r[i] - r[j]));
            }
        }
        prop_assert_eq!(discriminant(&a, &Budget::unlimited()).unwrap(), if r.is_empty() { Integer::ZERO } else { disc });
    }

    #[test]
    fn formal_resultants_are_sylvester_determinants(a in uni_poly(5, 9), b in uni_poly(5, 9), up in 0usize..3, vp in 0usize..3) {
        let n = a.coeffs().len().saturating_sub(1) + up;
        let m = b.coeffs().len().saturating_sub(1) + vp;
        let expected = determinant_bareiss(&sylvester(&a, n, &b, m), &Budget::unlimited()).unwrap();
        prop_assert_eq!(resultant_formal(&a, n, &b, m, &Budget::unlimited()).unwrap(), expected);
    }

    #[test]
    fn formal_resultants_specialise(a in multi_poly(2, 3, 6), b in multi_poly(2, 3, 6), x in -4i64..=4) {
        let (n, m) = (a.degree_in(1) as usize, b.degree_in(1) as usize);
        let (p, q) = (a.as_poly_in(1), b.as_poly_in(1));
        let symbolic = resultant_formal(&p, n, &q, m, &Budget::unlimited()).unwrap();
        let at = |c: &MultiPoly| c.eval_integers(&[Integer::from(x)]);
        let special = resultant_formal(&p.map(at), n, &q.map(at), m, &Budget::unlimited()).unwrap();
        prop_assert_eq!(at(&symbolic), special);
    }

    #[test]
    fn the_last_subresultant_is_the_gcd(f in nonzero_uni_poly(4, 9), a in nonzero_uni_poly(5, 9), b in nonzero_uni_poly(5, 9)) {
        let (a, b) = (f.times(&a), f.times(&b));
        let (a, b) = if a.degree() >= b.degree() { (a, b) } else { (b, a) };
        let chain = subresultant_chain(&a, &b, &Budget::unlimited()).unwrap();
        prop_assert_eq!(chain.last().unwrap().primitive_part(), a.gcd(&b).primitive_part());
    }

    #[test]
    fn square_free_decomposition_reassembles(a in nonzero_uni_poly(4, 6), b in nonzero_uni_poly(3, 6), c in nonzero_uni_poly(3, 6)) {
        let p = a.times(&b.power(2)).times(&c.power(3));
        let parts = p.square_free_decomposition();
        let product = parts.iter().fold(UniPoly::one(), |q, (f, i)| q.times(&f.power(*i as u64)));
        prop_assert_eq!(&product, &p.primitive_part());
        for (k, (f, i)) in parts.iter().enumerate() {
            prop_assert!(f.degree() > Some(0) && *i > 0 && f.gcd(&f.derivative()).is_constant());
            prop_assert!(parts[..k].iter().all(|(g, j)| j < i && f.gcd(g).is_constant()));
        }
        let radical = parts.iter().fold(UniPoly::one(), |q, (f, _)| q.times(f));
        prop_assert_eq!(p.square_free_part(), radical);
    }

    #[test]
    fn multivariate_square_free_part(a in nonzero_multi_poly(2, 2, 3), b in nonzero_multi_poly(2, 2, 2)) {
        let p = &(&a * &b) * &b;
        let s = p.square_free_part();
        prop_assert_eq!(s.square_free_part(), s.clone());
        prop_assert_eq!((&a * &b).square_free_part(), s.clone());
        prop_assert!(p.div_exact(&s).is_some() && s.power(p.total_degree().max(1)).div_exact(&p.primitive_over_integers()).is_some());
    }

    #[test]
    fn values_respect_the_operations(
        p in multi_poly(3, 3, 5), q in multi_poly(3, 3, 5), point in prop::collection::vec((-9i64..=9, 1i64..=9), 3)
    ) {
        let point: Vec<Rational> = point.iter().map(|&(a, b)| Rational::new(a.into(), b.into())).collect();
        prop_assert_eq!((&p * &q).eval(&point), p.eval(&point) * q.eval(&point));
        prop_assert_eq!((&p - &q).eval(&point), p.eval(&point) - q.eval(&point));
        let (set, d) = p.substitute(1, &point[1]);
        prop_assert_eq!(set.degree_in(1), 0);
        prop_assert_eq!(Rational::new(Integer::ONE, d) * set.eval(&point), p.eval(&point));
    }

    #[test]
    fn views_go_back_and_forth(p in multi_poly(5, 3, 6), i in 0usize..5) {
        let view = p.as_poly_in(i);
        prop_assert!(view.coeffs().iter().all(|c| c.degree_in(i) == 0));
        prop_assert_eq!(MultiPoly::from_poly_in(&view, i), p.clone());
        prop_assert_eq!(MultiPoly::from_poly_in(&view.derivative(), i), p.derivative(i));
        prop_assert_eq!(p.map_variables(|j| (j + 3) % 5).map_variables(|j| (j + 2) % 5), p.clone());
        let single = p.map_variables(|_| i);
        let uni = single.to_univariate(i).unwrap();
        prop_assert_eq!(MultiPoly::from_univariate(&uni, i), single);
        prop_assert_eq!(p.to_univariate(i).is_some(), p.variables().iter().all(|&j| j == i));
    }

    #[test]
    fn rational_functions_are_a_field(
        a in rational_function(2, 2, 2), b in rational_function(2, 2, 2), c in rational_function(2, 1, 2)
    ) {
        prop_assert_eq!(&a + &b, &b + &a);
        prop_assert_eq!(&(&a + &b) + &c, &a + &(&b + &c));
        prop_assert_eq!(&a * &(&b + &c), &(&a * &b) + &(&a * &c));
        prop_assert!((&a - &a).is_zero() && &a + &RationalFunction::zero() == a);
        match a.recip() {
            Some(r) => prop_assert!((&a * &r).is_one() && b.checked_div(&a).unwrap() == &b * &r),
            None => prop_assert!(a.is_zero()),
        }
        for f in [&a + &b, &a * &b, &a - &c] {
            prop_assert!(f.numerator().gcd(f.denominator()).is_one());
            prop_assert!(!f.denominator().needs_negation() && !f.denominator().is_zero());
        }
    }

    #[test]
    fn rational_function_values(a in rational_function(2, 2, 2), b in rational_function(2, 2, 2), x in -5i64..=5, y in -5i64..=5) {
        let point = [Rational::from(x), Rational::new(y.into(), 3.into())];
        if let (Some(u), Some(v)) = (a.eval(&point), b.eval(&point)) {
            prop_assert_eq!((&a + &b).eval(&point), Some(&u + &v));
            prop_assert_eq!((&a * &b).eval(&point), Some(&u * &v));
        }
        if let Some(f) = a.substitute(0, &point[0]) {
            if let Some(value) = a.eval(&point) {
                prop_assert_eq!(f.eval(&point), Some(value));
            }
        } else {
            prop_assert_eq!(a.eval(&point), None);
        }
    }
}

#[test]
fn long_coefficients() {
    let big = Integer::from(10).pow(500);
    let k = MultiPoly::variable(0);
    let f = &k.scaled_by(&big) + &MultiPoly::from(7);
    let (a, b) = (&f * &(&k - &MultiPoly::from(1)), &f * &(&MultiPoly::variable(1) + &k));
    assert_eq!(a.gcd(&b), f);
    assert_eq!((&a * &b).square_free_part(), a.div_exact(&f).unwrap().times(&b));
}
