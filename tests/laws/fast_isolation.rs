//! Isolation in fixed-point arithmetic against the exact reference.

use crate::helpers::polynomial::{mignotte, product};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::real_roots::{isolate_real_roots_descartes, isolate_real_roots_fixed};
use jurist_algebra::poly::strategies::{nasty_polynomial, polynomial_with_known_roots, small_polynomial};
use jurist_algebra::poly::{Domain, RealAlgebraic, SquareFree, UniPoly};
use proptest::prelude::*;

fn fast(p: &UniPoly, bits: u64) -> Vec<RealAlgebraic> {
    let roots = isolate_real_roots_fixed(&SquareFree::part_of(p).unwrap(), bits, &Budget::unlimited()).unwrap();
    for root in &roots {
        let (lo, hi) = root.enclosure();
        assert_eq!(root.exact().is_some(), lo == hi);
        if lo != hi {
            // Strictly on one side of zero, ends of opposite sign, as narrow as promised.
            let least = lo.abs().min(hi.abs());
            assert!(lo.sign() == hi.sign() && !least.is_zero());
            assert!((&hi - &lo) * Rational::from(&Integer::ONE << bits) <= least, "{lo} {hi}");
            let (a, b) = (root.polynomial().sign_at(&lo), root.polynomial().sign_at(&hi));
            assert!(a.is_ne() && a == b.reverse());
        }
    }
    for w in roots.windows(2) {
        assert!(w[0].enclosure().1 < w[1].enclosure().0);
    }
    roots
}

fn same_as_reference(p: &UniPoly, bits: u64) -> usize {
    let square_free = SquareFree::part_of(p).unwrap();
    let found = fast(p, bits);
    let reference = isolate_real_roots_descartes(&square_free, None, None, &Budget::unlimited()).unwrap();
    assert_eq!(found.len(), reference.len(), "{p:?}");
    assert_eq!(found, reference, "{p:?}");
    found.len()
}

fn z(text: &str) -> Integer {
    Integer::from_decimal(text).unwrap()
}

#[test]
fn constants_and_lines() {
    assert!(fast(&UniPoly::from_i64(&[5]), 10).is_empty());
    assert_eq!(fast(&UniPoly::from_i64(&[0, 1]), 10).len(), 1);
    assert_eq!(fast(&UniPoly::from_i64(&[3, -7]), 10)[0].exact().unwrap().to_string(), "3/7");
    assert!(fast(&UniPoly::from_i64(&[1, 0, 1]), 10).is_empty());
}

#[test]
fn roots_beside_split_points() {
    // (2^k x - c)^2 = 2 and its like: both roots close to a dyadic number.
    for k in [1u64, 3, 20, 64, 200] {
        let lead = &Integer::ONE << k;
        for c in [1i64, 3, 5] {
            let linear = UniPoly::new(vec![Integer::from(-c), lead.clone()]);
            let tiny = UniPoly::constant(z("-2"));
            let p = &(&linear * &linear).scaled(&(&Integer::ONE << 300)) + &tiny;
            same_as_reference(&p, 128);
            let wiggly = &p * &UniPoly::from_i64(&[-1, 7, 0, 3, 1]);
            same_as_reference(&wiggly, 64);
        }
    }
}

#[test]
fn clusters() {
    assert_eq!(same_as_reference(&mignotte(12, 1 << 20), 128), 4);
    assert_eq!(same_as_reference(&mignotte(13, 1 << 20), 128), 3);
    assert_eq!(same_as_reference(&mignotte(12, 1_000_003), 128), 4);
    assert_eq!(same_as_reference(&mignotte(24, -1003), 128), 4);
    assert_eq!(fast(&mignotte(60, 1_000_003), 128).len(), 4);
    // Four roots together, and complex ones beside the axis.
    let near = |a: i64, e: i64| {
        &(&UniPoly::from_i64(&[-1, a]) * &UniPoly::from_i64(&[-1, a])).scaled(&z("1000000000000000000000000000000"))
            + &UniPoly::from_i64(&[e])
    };
    let p = product([near(7, -3), near(7, -5), near(7, 2), near(-11, 1), near(3, -7)]);
    assert_eq!(same_as_reference(&p, 40), 6);
}

#[test]
fn even_odd_and_sparse() {
    assert_eq!(same_as_reference(&UniPoly::from_i64(&[-4, 0, 0, 0, 9]), 100), 2);
    assert_eq!(same_as_reference(&UniPoly::from_i64(&[6, 0, -5, 0, 1]), 100), 4);
    assert_eq!(same_as_reference(&UniPoly::from_i64(&[-2, 0, 0, 0, 0, 1]), 100), 1);
    assert_eq!(same_as_reference(&UniPoly::from_i64(&[2, 0, 0, -3, 0, 0, 1]), 100), 2);
    assert_eq!(same_as_reference(&UniPoly::from_i64(&[0, -2, 0, 0, 0, 0, 0, 1]), 100), 3);
    assert_eq!(same_as_reference(&UniPoly::from_i64(&[2, 0, 0, 3, 0, 0, 1]), 100), 2);
}

#[test]
fn huge_and_tiny() {
    let big = &Integer::ONE << 1700;
    let p = UniPoly::new(vec![-&big, Integer::from(3), Integer::from(-5), big.clone()]);
    same_as_reference(&p, 128);
    let p = UniPoly::new(vec![Integer::from(1), -&big, Integer::from(7), Integer::from(1)]);
    same_as_reference(&p, 128);
    // Roots near 10^-30, 1 and 10^30.
    let p = product([
        UniPoly::new(vec![z("-2"), Integer::ZERO, z("1000000000000000000000000000000").pow(2)]),
        UniPoly::from_i64(&[-3, 0, 1]),
        UniPoly::new(vec![-z("1000000000000000000000000000000").pow(2), Integer::ZERO, Integer::from(5)]),
        UniPoly::from_i64(&[1, 1, 1]),
    ]);
    assert_eq!(same_as_reference(&p, 128), 6);
}

#[test]
fn ends_close_together() {
    // Square roots of 2 and of 2 + 10^-30, and rational numbers beside them.
    let unit = z("1000000000000000000000000000000");
    let two = UniPoly::from_i64(&[-2, 0, 1]);
    let more = UniPoly::new(vec![-(&(&unit << 1) + &Integer::ONE), Integer::ZERO, unit.clone()]);
    let rational = UniPoly::new(vec![z("-1414213562373095048801688724210"), unit]);
    assert_eq!(same_as_reference(&product([two, more, rational, UniPoly::from_i64(&[-7, 1])]), 60), 6);
}

#[test]
fn classical_families() {
    let mut chebyshev = (UniPoly::one(), UniPoly::x());
    for _ in 1..31 {
        let next = &(&UniPoly::from_i64(&[0, 2]) * &chebyshev.1) - &chebyshev.0;
        chebyshev = (chebyshev.1, next);
    }
    assert_eq!(same_as_reference(&chebyshev.1, 128), 31);
    let wilkinson = (1..=20).fold(UniPoly::one(), |p, i| &p * &UniPoly::from_i64(&[-i, 1]));
    assert_eq!(same_as_reference(&wilkinson, 128), 20);
    assert_eq!(same_as_reference(&(&wilkinson + &UniPoly::one()), 128), 20);
    same_as_reference(&(&wilkinson + &UniPoly::monomial(Integer::ONE, 19)), 128);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn nasty_polynomials(p in nasty_polynomial(), bits in 0u64..200) {
        prop_assume!(p.degree().is_some());
        same_as_reference(&p, bits);
    }

    #[test]
    fn small_polynomials(p in small_polynomial(14), bits in 0u64..80) {
        prop_assume!(p.degree().is_some());
        same_as_reference(&p, bits);
    }

    #[test]
    fn chosen_roots(known in polynomial_with_known_roots()) {
        prop_assert_eq!(fast(&known.polynomial, 70).len(), known.roots.len());
    }

    #[test]
    fn perturbed_squares(p in small_polynomial(7), shift in 0u64..400) {
        prop_assume!(p.degree().is_some());
        let q = &(&p * &p).scaled(&(&Integer::ONE << shift)) - &UniPoly::one();
        prop_assume!(q.degree().is_some());
        same_as_reference(&q, 30);
    }

    #[test]
    #[ignore = "long: CI runs it"]
    fn wide_coefficients(c in proptest::collection::vec((any::<i64>(), 0u64..300), 2..40)) {
        let p = UniPoly::new(c.into_iter().map(|(c, s)| &Integer::from(c) << s).collect());
        prop_assume!(p.degree().is_some());
        same_as_reference(&p, 50);
    }
}
