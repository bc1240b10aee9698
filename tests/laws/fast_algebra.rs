//! The fast ways of the algebra against their references.

use crate::helpers::budget::spent;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{RationalMatrix, characteristic_polynomial_multimodular};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::modular::gcd::primitive_gcd_modular;
use jurist_algebra::poly::modular::multimodular_resultant::{
    resultant_by_minors, resultant_multimodular, resultant_multimodular_integers, resultant_multimodular_multivariate,
};
use jurist_algebra::poly::modular::square_free_resultant::square_free_decomposition;
use jurist_algebra::poly::multivariate::strategies::multi_poly;
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RationalFunction, SquareFree, UniPoly, discriminant, resultant, resultant_formal,
    resultant_formal_subresultant, resultant_square_free_decomposition, resultant_subresultant,
};
use jurist_engine::stability::{HalfSizePair, Shape};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

/// Zero, small, word-size, and 500-digit integers of either sign.
fn integer() -> impl Strategy<Value = Integer> {
    prop_oneof![
        2 => Just(Integer::ZERO),
        6 => (-9i64..=9).prop_map(Integer::from),
        3 => any::<i64>().prop_map(Integer::from),
        1 => (any::<i64>(), any::<i64>()).prop_map(|(a, b)| {
            Integer::from(a) * Integer::from(10).pow(490) + Integer::from(b)
        }),
    ]
}

fn uni_poly(max_degree: usize) -> impl Strategy<Value = UniPoly> {
    prop::collection::vec(integer(), 0..=max_degree + 1).prop_map(UniPoly::new)
}

/// A polynomial and a formal degree that may be above its degree.
fn with_formal_degree<R: Domain>(
    coefficient: impl Strategy<Value = R> + Clone,
    max: usize,
) -> impl Strategy<Value = (Poly<R>, usize)> {
    (0..=max, prop_oneof![4 => Just(0usize), 1 => 1..=2usize, 1 => Just(9)]).prop_flat_map(move |(n, drop)| {
        prop::collection::vec(coefficient.clone(), (n + 1).saturating_sub(drop)).prop_map(move |c| (Poly::new(c), n))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn integer_resultants((a, n) in with_formal_degree(integer().boxed(), 7), (b, m) in with_formal_degree(integer().boxed(), 7)) {
        let expected = resultant_formal_subresultant(&a, n, &b, m, &Budget::unlimited()).unwrap();
        prop_assert_eq!(resultant_multimodular_integers(&a, n, &b, m), expected.clone());
        prop_assert_eq!(resultant_formal(&a, n, &b, m, &Budget::unlimited()).unwrap(), expected);
        let expected = resultant_subresultant(&a, &b, &Budget::unlimited()).unwrap();
        prop_assert_eq!(resultant(&a, &b, &Budget::unlimited()).unwrap(), expected);
    }

    #[test]
    fn gcds((a, b, g) in (uni_poly(5), uni_poly(5), uni_poly(4))) {
        let (a, b) = (a.times(&g), b.times(&g));
        if a.is_zero() || b.is_zero() {
            prop_assert_eq!(a.gcd(&b), if a.is_zero() { b.gcd(&b) } else { a.gcd(&a) });
            return Ok(());
        }
        let over_rationals = |p: &UniPoly| p.map(|c| Rational::from(c));
        let (_, expected) = UniPoly::from_rational_poly(&over_rationals(&a).gcd(&over_rationals(&b)));
        let (pa, pb) = (a.primitive_part(), b.primitive_part());
        prop_assert_eq!(primitive_gcd_modular(&pa, &pb).primitive_part(), expected.primitive_part());
        let content = a.content().gcd(&b.content());
        prop_assert_eq!(a.gcd(&b), expected.primitive_part().scaled(&content));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn resultants_over_univariate_polynomials(
        (a, n) in with_formal_degree(uni_poly(3).boxed(), 5), (b, m) in with_formal_degree(uni_poly(2).boxed(), 5)
    ) {
        let expected = resultant_formal_subresultant(&a, n, &b, m, &Budget::unlimited()).unwrap();
        prop_assert_eq!(resultant_multimodular(&a, n, &b, m), expected.clone());
        prop_assert_eq!(resultant_formal(&a, n, &b, m, &Budget::unlimited()).unwrap(), expected);
    }

    #[test]
    fn resultants_over_multivariate_polynomials(
        (a, n) in with_formal_degree(multi_poly(3, 2, 3).boxed(), 3), (b, m) in with_formal_degree(multi_poly(3, 2, 3).boxed(), 3)
    ) {
        let expected = resultant_formal_subresultant(&a, n, &b, m, &Budget::unlimited()).unwrap();
        let got = resultant_multimodular_multivariate(&a, n, &b, m).unwrap();
        prop_assert_eq!(&got, &expected);
        prop_assert_eq!(resultant_formal(&a, n, &b, m, &Budget::unlimited()).unwrap(), expected);
    }

    #[test]
    fn resultants_by_minors(
        (a, n) in with_formal_degree(multi_poly(2, 2, 4).boxed(), 5), (b, m) in with_formal_degree(multi_poly(2, 2, 4).boxed(), 5)
    ) {
        let expected = resultant_formal_subresultant(&a, n, &b, m, &Budget::unlimited()).unwrap();
        let long = a.coeffs().iter().chain(b.coeffs()).any(|c| c.height_bits() > 32);
        match resultant_by_minors(&a, n, &b, m) {
            Some(got) => prop_assert_eq!(got, expected.clone()),
            None => prop_assert!(n.min(m) == 0 || long),
        }
        prop_assert_eq!(resultant_formal(&a, n, &b, m, &Budget::unlimited()).unwrap(), expected);
    }

    #[test]
    fn resultants_have_the_common_roots(roots in prop::collection::vec(-3i64..=3, 2..9), split in 1usize..8) {
        // x - (r + K^2): the resultant is the product of the differences, zero when a root is shared.
        let (left, right) = roots.split_at(split.min(roots.len() - 1));
        let from = |roots: &[i64], sign: i64| roots.iter().fold(Poly::<UniPoly>::one(), |p, &r| {
            p.times(&Poly::new(vec![UniPoly::from_i64(&[-r, 0, -sign]), UniPoly::one()]))
        });
        let mut expected = UniPoly::one();
        for l in left {
            for r in right {
                expected = expected.times(&UniPoly::from_i64(&[l - r, 0, 2]));
            }
        }
        let (a, b) = (from(left, 1), from(right, -1));
        prop_assert_eq!(resultant_multimodular(&a, left.len(), &b, right.len()), expected);
        let (a, b) = (from(left, 1), from(&[right, left].concat(), 1));
        let zero = resultant_multimodular(&a, left.len(), &b, roots.len());
        prop_assert!(zero.is_zero());
    }

    #[test]
    fn critical_constraints(
        c in prop::collection::vec(uni_poly(2), 1..10), continuous in any::<bool>()
    ) {
        let (d, n) = (Poly::new(c.clone()), c.len() - 1);
        prop_assume!(n > 0);
        let region = if continuous { Shape::LeftHalfPlane } else { Shape::UnitDisc };
        let pair = HalfSizePair::new(&d, n, region);
        let expected = resultant_formal_subresultant(&pair.a, pair.degree_a, &pair.b, pair.degree_b, &Budget::unlimited());
        prop_assert_eq!(pair.critical_constraint(&Budget::unlimited()), expected);
    }

    #[test]
    fn discriminants(p in with_formal_degree(multi_poly(2, 2, 2).boxed(), 4)) {
        let p = p.0;
        if let Some(n) = p.degree().filter(|&n| n > 0) {
            let r = resultant_subresultant(&p, &p.derivative(), &Budget::unlimited()).unwrap();
            let d = discriminant(&p, &Budget::unlimited()).unwrap().times(p.leading().unwrap());
            prop_assert_eq!(if n * (n - 1) / 2 % 2 == 1 { d.negated() } else { d }, r);
        }
    }

    #[test]
    fn characteristic_polynomials(m in rational_matrix(4)) {
        prop_assert_eq!(
            m.characteristic_polynomial(names(), &Budget::unlimited()),
            m.characteristic_polynomial_faddeev_leverrier(names(), &Budget::unlimited())
        );
    }
}

fn names() -> Vec<String> {
    vec!["K".into(), "T".into()]
}

/// Entries in two variables, many zero, some with poles.
fn rational_matrix(max: usize) -> impl Strategy<Value = RationalMatrix> {
    let fraction =
        |p: MultiPoly, q: MultiPoly| RationalFunction::new(p, if q.is_zero() { MultiPoly::one() } else { q });
    let entry = prop_oneof![
        4 => Just(RationalFunction::zero()),
        3 => integer().prop_map(RationalFunction::from),
        3 => (multi_poly(2, 2, 2), -9i64..=9).prop_map(move |(p, q)| fraction(p, MultiPoly::from(q)).unwrap()),
        1 => (multi_poly(2, 1, 1), 0usize..2, -2i64..=2).prop_map(move |(p, i, c)| {
            fraction(p, MultiPoly::variable(i).minus(&MultiPoly::from(c))).unwrap()
        }),
    ];
    (0..=max).prop_flat_map(move |n| {
        prop::collection::vec(entry.clone(), n * n)
            .prop_map(move |e| RationalMatrix::from_fn(n, n, |i, j| e[i * n + j].clone()))
    })
}

/// The poles of the entries lie on the grid: at every point of one line a denominator vanishes.
#[test]
fn denominators_that_vanish_on_the_grid() {
    let (k, t) = (RationalFunction::variable(0), RationalFunction::variable(1));
    let shifted = &t - &RationalFunction::from(1);
    let m = RationalMatrix::from_rows(vec![
        vec![k.recip().unwrap(), t.clone(), shifted.recip().unwrap()],
        vec![&k * &t, t.recip().unwrap(), k.clone()],
        vec![RationalFunction::from(3), (&k - &t).recip().unwrap(), RationalFunction::from(-2)],
    ])
    .unwrap();
    assert_eq!(
        m.characteristic_polynomial(names(), &Budget::unlimited()),
        m.characteristic_polynomial_faddeev_leverrier(names(), &Budget::unlimited())
    );
}

/// Denominators divisible by the very primes that are used.
#[test]
fn denominators_that_vanish_modulo_the_primes() {
    let p = jurist_algebra::poly::modular::prime_field::largest_primes(2);
    let product = Integer::from(p[0].prime()) * Integer::from(p[1].prime());
    let k = RationalFunction::variable(0);
    let entry = |c: i64| &RationalFunction::from(Rational::new(Integer::from(c), product.clone())) * &k;
    let m = RationalMatrix::from_fn(3, 3, |i, j| entry((3 * i + j * j) as i64 - 4));
    assert_eq!(
        m.characteristic_polynomial(names(), &Budget::unlimited()),
        m.characteristic_polynomial_faddeev_leverrier(names(), &Budget::unlimited())
    );
    // Leading coefficients divisible by them.
    let a = Poly::new([7, 3, -2, 5].map(Integer::from).into_iter().chain([product.clone()]).collect());
    let b = Poly::new(vec![Integer::from(4), Integer::from(-9), Integer::from(11), -product.clone()]);
    let expected = resultant_subresultant(&a, &b, &Budget::unlimited()).unwrap();
    assert_eq!(resultant_multimodular_integers(&a, 4, &b, 3), expected);
    let (ga, gb) = (a.times(&b), b.times(&UniPoly::from_i64(&[1, 1])));
    assert_eq!(primitive_gcd_modular(&ga, &gb).primitive_part(), b.primitive_part());
}

#[test]
fn sizes_zero_and_one() {
    let none = RationalMatrix::identity(0);
    let (p, d) = characteristic_polynomial_multimodular(&none, &Budget::unlimited()).unwrap().unwrap();
    assert!(p.is_one() && d.is_one());
    let zero = RationalMatrix::zeros(3, 3);
    let (p, _) = characteristic_polynomial_multimodular(&zero, &Budget::unlimited()).unwrap().unwrap();
    assert_eq!(p, Poly::monomial(MultiPoly::one(), 3));
    let pole = RationalMatrix::from_fn(1, 1, |_, _| RationalFunction::variable(0).recip().unwrap());
    let (p, d) = characteristic_polynomial_multimodular(&pole, &Budget::unlimited()).unwrap().unwrap();
    assert_eq!((p.coeffs()[0].clone(), d), (MultiPoly::from(-1), MultiPoly::variable(0)));
}

/// Zero and equal polynomials, lost degrees, a common content, degrees out of order, and coefficients of all widths up to those
/// that have no room.
#[test]
fn small_determinants_of_singular_pairs() {
    let (k, t) = (MultiPoly::variable(0), MultiPoly::variable(1));
    let number = |c: i64| MultiPoly::from(c);
    let kt = &(&k * &t) - &number(3);
    let a = Poly::new(vec![kt.clone(), &k + &t, number(-2), &t * &t]);
    let b = Poly::new(vec![&k - &number(1), t.clone(), number(7)]);
    let zero = Poly::new(Vec::new());
    let content = |p: &Poly<MultiPoly>| p.map(|c| c * &kt);
    let expected = |a: &Poly<MultiPoly>, n, b: &Poly<MultiPoly>, m| {
        resultant_formal_subresultant(a, n, b, m, &Budget::unlimited()).unwrap()
    };
    let (ca, cb) = (content(&a), content(&b));
    let cases = [
        (&a, 3, &b, 2),
        (&b, 2, &a, 3),
        (&a, 3, &a, 3),
        (&zero, 3, &b, 2),
        (&a, 3, &zero, 1),
        (&zero, 2, &zero, 2),
        (&a, 4, &b, 2),
        (&a, 3, &b, 4),
        (&a, 5, &b, 5),
        (&ca, 3, &cb, 2),
        (&ca, 3, &b, 3),
    ];
    for (a, n, b, m) in cases {
        assert_eq!(resultant_by_minors(a, n, b, m), Some(expected(a, n, b, m)), "{a:?} {n} {b:?} {m}");
    }
    // At the ends of words: 2^62 and its neighbours, 2^63, 2^64, and longer.
    for bits in [30, 31, 61, 62, 63, 64, 80] {
        for add in [-1, 0, 1] {
            let c = MultiPoly::from((Integer::ONE << bits) + Integer::from(add));
            let a = Poly::new(vec![c.clone(), &k * &c, c.negated()]);
            let b = Poly::new(vec![c.negated(), &t * &c, &k + &c]);
            assert_eq!(resultant_by_minors(&a, 2, &b, 2), Some(expected(&a, 2, &b, 2)), "2^{bits} + {add}");
        }
    }
    let long = Poly::new(vec![MultiPoly::from(Integer::ONE << 600), k]);
    assert_eq!(resultant_by_minors(&long, 1, &b, 2), None);
    assert_eq!(resultant_formal(&long, 1, &b, 2, &Budget::unlimited()).unwrap(), expected(&long, 1, &b, 2));
    assert_eq!(resultant_by_minors(&Poly::one(), 0, &b, 2), None);
    assert_eq!(resultant_by_minors(&a, 7, &b, 2), None);
}

#[test]
fn a_spent_budget_is_reported() {
    let budget = spent();
    let p: Poly<UniPoly> = Poly::new((0..5).map(|k| UniPoly::from_i64(&[k, 1])).collect());
    assert!(resultant_formal(&p, 4, &p.derivative(), 3, &budget).is_err());
    assert!(RationalMatrix::identity(3).characteristic_polynomial(names(), &budget).is_err());
}

/// Large enough to be distributed over threads: the same for any number of them.
#[test]
fn threads_do_not_matter() {
    let coefficient = |k: usize| {
        MultiPoly::from_terms((0..3u32).flat_map(|i| {
            (0..3u32).map(move |j| {
                (vec![i, j], Integer::from((k * 37 + (i * 11 + j * 5) as usize * 101 % 17) as i64 % 23 - 11))
            })
        }))
    };
    let a: Poly<MultiPoly> = Poly::new((0..9).map(coefficient).collect());
    let b: Poly<MultiPoly> = Poly::new((20..28).map(coefficient).collect());
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| resultant_multimodular_multivariate(&a, 8, &b, 7).unwrap())
    };
    let one = run(1);
    assert_eq!(one, run(3));
    // Setting the variables first is the same.
    for point in [[2i64, -3], [0, 1], [-5, 7]] {
        let point = point.map(Integer::from);
        let at = |p: &Poly<MultiPoly>| p.map(|c| c.eval_integers(&point));
        let expected = resultant_formal_subresultant(&at(&a), 8, &at(&b), 7, &Budget::unlimited()).unwrap();
        assert_eq!(one.eval_integers(&point), expected);
    }
}

/// A curve in `y` over `Z[x]` whose discriminant has double zeros: the resultant of two polynomials in a third variable.
fn crossing_branches() -> impl Strategy<Value = Poly<UniPoly>> {
    let coefficient = || {
        prop::collection::vec(prop::collection::vec(-999i64..=999, 0..=2), 1..=2)
            .prop_map(|c| Poly::new(c.iter().map(|c| UniPoly::from_i64(c)).collect()))
    };
    let side = |n: usize| prop::collection::vec(coefficient(), n + 1).prop_map(Poly::<Poly<UniPoly>>::new);
    (side(4), side(4), 0u32..3, 0u32..3).prop_filter_map("no curve", |(a, b, power_x, power_y)| {
        let curve = resultant_subresultant(&a, &b, &Budget::unlimited()).unwrap();
        // Units: x and y in tenths, which powers of 2 and 5 in the coefficients follow.
        let scaled = |c: &UniPoly, k: usize| {
            let ten = |e: usize, power: u32| Integer::from(10).pow(e as u64 * u64::from(power));
            let c = c.coeffs().iter().enumerate().map(|(e, x)| x * &ten(e, power_x) * ten(k, power_y));
            UniPoly::new(c.collect())
        };
        let coefficients = curve.coeffs().iter().enumerate().map(|(k, c)| scaled(c, k)).collect();
        (curve.degree()? > 1).then(|| Poly::new(coefficients))
    })
}

/// Long discriminants with many crossings are found by their factors, not whole.
#[test]
fn factors_of_long_discriminants_are_found_by_their_images() {
    let mut runner = TestRunner::deterministic();
    let found = (0..12).filter(|_| {
        let f = crossing_branches().new_tree(&mut runner).unwrap().current();
        square_free_decomposition(&f, &f.derivative()).is_some()
    });
    let found = found.count();
    assert!(found >= 4, "{found} of 12");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The factors of a discriminant are coprime, and their powers multiply to it.
    #[test]
    fn factors_of_discriminants_multiply_to_them(f in crossing_branches()) {
        let derivative = f.derivative();
        let whole = resultant(&f, &derivative, &Budget::unlimited()).unwrap();
        let found = resultant_square_free_decomposition(&f, &derivative, &Budget::unlimited()).unwrap();
        let Some(factors) = found else {
            prop_assert!(whole.is_zero());
            return Ok(());
        };
        let power = |(f, e): &(UniPoly, usize)| (0..*e).fold(UniPoly::one(), |p, _| p.times(f));
        let product = factors.iter().fold(UniPoly::one(), |p, f| p.times(&power(f)));
        prop_assert_eq!(product.primitive_part(), whole.primitive_part());
        let radical = factors.iter().fold(UniPoly::one(), |p, (f, _)| p.times(f));
        prop_assert!(SquareFree::new(radical.clone()).is_some(), "{radical:?}");
        // A zero 0 may stand apart.
        let away_from_zero = |factors: Vec<(UniPoly, usize)>| {
            let without = |f: UniPoly| if f.coeff(0).is_zero() { f.div_exact(&UniPoly::x()).expect("0 is a zero") } else { f };
            let mut rest: Vec<(usize, UniPoly)> = factors.into_iter().map(|(f, e)| (e, without(f))).collect();
            rest.retain(|(_, f)| !f.is_constant());
            rest.sort_by_key(|(e, _)| *e);
            rest
        };
        prop_assert_eq!(away_from_zero(factors), away_from_zero(whole.square_free_decomposition()));
    }
}
