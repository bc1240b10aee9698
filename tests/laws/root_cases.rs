//! Real root isolation against Sturm's theorem and against roots known by construction.

use crate::helpers::budget::spent;
use crate::helpers::number::ratio;
use crate::helpers::polynomial::{mignotte, product};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::algebraic::{RealAlgebraic, rational_between, simplest_between};
use jurist_algebra::poly::real_roots::{
    Bound, SquareFree, budan_fourier_bound, count_roots_sturm, descartes_sign_variations, isolate_real_roots,
    isolate_real_roots_in, root_bound_bits,
};
use jurist_algebra::poly::{Domain, UniPoly};

fn poly(coeffs: &[i64]) -> UniPoly {
    UniPoly::from_i64(coeffs)
}

fn linear(root: &Rational) -> UniPoly {
    UniPoly::new(vec![-root.numerator(), root.denominator()])
}

fn roots(p: &UniPoly) -> Vec<RealAlgebraic> {
    isolate_real_roots(&SquareFree::part_of(p).unwrap(), &Budget::unlimited()).unwrap()
}

fn sturm(p: &UniPoly, lo: Bound, hi: Bound) -> usize {
    count_roots_sturm(p, lo, hi, &Budget::unlimited()).unwrap()
}

/// Everything that an isolation must satisfy, checked by Sturm's theorem and exact signs.
fn check(p: &UniPoly) -> Vec<RealAlgebraic> {
    let found = roots(p);
    assert_eq!(found.len(), sturm(p, Bound::Unbounded, Bound::Unbounded), "number of roots of {p:?}");
    for root in &found {
        let (lo, hi) = root.enclosure();
        assert_eq!(lo == hi, root.exact().is_some());
        assert_eq!(sturm(p, Bound::Closed(&lo), Bound::Closed(&hi)), 1, "roots of {p:?} in {lo}..{hi}");
        assert_eq!(sturm(root.polynomial(), Bound::Closed(&lo), Bound::Closed(&hi)), 1);
        assert!(SquareFree::new(root.polynomial().clone()).unwrap().poly() == root.polynomial());
        if let Some(x) = root.exact() {
            assert!(p.sign_at(&x).is_eq());
            assert_eq!(root.polynomial(), &linear(&x));
        } else {
            let strictly_inside = root.polynomial().sign_at(&lo) != root.polynomial().sign_at(&hi);
            assert!(strictly_inside && lo < hi);
        }
        assert!(root.sign_of(p).is_eq());
    }
    for pair in found.windows(2) {
        assert!(pair[0].enclosure().1 < pair[1].enclosure().0, "enclosures are disjoint and ascending");
        assert!(pair[0] < pair[1]);
    }
    found
}

/// Chebyshev polynomial of the first kind.
fn chebyshev(n: usize) -> UniPoly {
    let (mut a, mut b) = (UniPoly::one(), UniPoly::x());
    for _ in 0..n {
        let next = &(&poly(&[0, 2]) * &b) - &a;
        (a, b) = (b, next);
    }
    a
}

fn wilkinson(n: i64) -> UniPoly {
    product((1..=n).map(|k| poly(&[-k, 1])))
}

#[test]
fn constants_and_zero() {
    assert!(SquareFree::part_of(&poly(&[])).is_none());
    assert!(roots(&poly(&[-7])).is_empty());
    assert_eq!(sturm(&poly(&[]), Bound::Unbounded, Bound::Unbounded), 0);
}

#[test]
fn degree_one_is_exact() {
    let found = check(&poly(&[-6, 4]));
    assert_eq!(found[0].exact(), Some(ratio(3, 2)));
    assert_eq!(found[0].polynomial(), &poly(&[-3, 2]));
}

#[test]
fn powers_of_x() {
    for n in 1..6 {
        let found = check(&UniPoly::monomial(Integer::from(-3), n));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].exact(), Some(Rational::ZERO));
    }
}

#[test]
fn rational_roots_are_recognised_beside_irrational_ones() {
    let chosen = [ratio(-7, 3), ratio(-1, 1), ratio(0, 1), ratio(1, 1024), ratio(5, 7), ratio(1_000_003, 17)];
    let p = product(chosen.iter().map(linear).chain([poly(&[-2, 0, 1]), poly(&[1, 1, 1]), poly(&[-3, 0, 0, 2])]));
    let found = check(&p);
    let exact: Vec<Rational> = found.iter().filter_map(RealAlgebraic::exact).collect();
    assert_eq!(exact, chosen);
    assert_eq!(found.len(), chosen.len() + 3);
}

#[test]
fn rational_roots_with_long_numbers() {
    let big = Rational::new(Integer::from(10).pow(500) + Integer::from(7), Integer::from(3).pow(700));
    let small = big.recip().unwrap();
    let p = product([linear(&big), linear(&small), linear(&-&big), poly(&[-5, 0, 0, 1])]);
    let found = check(&p);
    let exact: Vec<Rational> = found.iter().filter_map(RealAlgebraic::exact).collect();
    assert_eq!(exact, [-&big, small, big]);
}

#[test]
fn roots_closer_than_1e_minus_30() {
    let ten = Integer::from(10);
    let a = ratio(1, 3);
    let b = &a + &Rational::new(Integer::ONE, ten.pow(30));
    // Surds 1e-40 apart: x^2 = 2 and x^2 = 2 + 1e-40.
    let scale = ten.pow(40);
    let close = UniPoly::new(vec![-(&(&scale * &2.into()) + &Integer::ONE), Integer::ZERO, scale]);
    let p = product([linear(&a), linear(&b), poly(&[-2, 0, 1]), close]);
    let found = check(&p);
    assert_eq!(found.len(), 6);
    assert_eq!(found.iter().filter_map(RealAlgebraic::exact).collect::<Vec<_>>(), [a, b]);
}

#[test]
fn multiple_roots_count_once() {
    let p = product([poly(&[-1, 1]), poly(&[-1, 1]), poly(&[-1, 1]), poly(&[-2, 0, 1]), poly(&[-2, 0, 1])]);
    assert_eq!(check(&p).len(), 3);
    let one = Rational::ONE;
    assert_eq!(sturm(&p, Bound::Open(&one), Bound::Unbounded), 1);
    assert_eq!(sturm(&p, Bound::Closed(&one), Bound::Unbounded), 2);
    assert_eq!(sturm(&p, Bound::Closed(&one), Bound::Closed(&one)), 1);
    assert_eq!(sturm(&p, Bound::Open(&one), Bound::Closed(&one)), 0);
    assert_eq!(sturm(&p, Bound::Unbounded, Bound::Open(&one)), 1);
    assert_eq!(sturm(&p, Bound::Unbounded, Bound::Closed(&one)), 2);
}

#[test]
fn chebyshev_polynomials() {
    for n in [1, 2, 7, 16, 31] {
        assert_eq!(check(&chebyshev(n)).len(), n);
    }
    assert_eq!(roots(&chebyshev(64)).len(), 64);
}

#[test]
fn wilkinson_20_and_50() {
    for n in [20, 50] {
        let found = roots(&wilkinson(n));
        let exact: Vec<Rational> = found.iter().filter_map(RealAlgebraic::exact).collect();
        assert_eq!(exact, (1..=n).map(|k| ratio(k, 1)).collect::<Vec<_>>());
    }
    let perturbed = &wilkinson(20) + &UniPoly::one();
    check(&perturbed);
}

#[test]
fn mignotte_clusters() {
    for (n, a) in [(20, 1 << 20), (20, 1_000_003), (31, 1001)] {
        assert_eq!(check(&mignotte(n, a)).len(), if n % 2 == 0 { 4 } else { 3 });
    }
}

#[test]
fn five_hundred_digit_coefficients() {
    let big = Integer::from(10).pow(500);
    let p = UniPoly::new(vec![-(&big + &Integer::ONE), Integer::from(3), -(&big * &7.into()), Integer::ONE, big]);
    check(&p);
}

#[test]
fn a_polynomial_in_a_power_of_x() {
    check(&poly(&[-2, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 3]));
    check(&poly(&[-2, 0, 0, 0, 3, 0, 0, 0, -1]));
    check(&poly(&[0, 0, 0, -2, 0, 0, 1]));
    // x^2 = 4/9 and x^2 = 2: the rational square has rational roots.
    let found = check(&product([poly(&[-4, 0, 9]), poly(&[-2, 0, 1])]));
    assert_eq!(found.iter().filter_map(RealAlgebraic::exact).collect::<Vec<_>>(), [ratio(-2, 3), ratio(2, 3)]);
}

#[test]
fn intervals_leave_out_roots_at_their_ends() {
    let p = product([linear(&ratio(1, 2)), linear(&ratio(3, 4)), poly(&[-2, 0, 1]), linear(&ratio(5, 1))]);
    let p = SquareFree::part_of(&p).unwrap();
    let count = |lo: Option<Rational>, hi: Option<Rational>| {
        isolate_real_roots_in(&p, lo.as_ref(), hi.as_ref(), &Budget::unlimited()).unwrap().len()
    };
    assert_eq!(count(None, None), 5);
    assert_eq!(count(Some(ratio(1, 2)), Some(ratio(5, 1))), 2);
    assert_eq!(count(Some(ratio(1, 2)), None), 3);
    assert_eq!(count(None, Some(ratio(1, 2))), 1);
    assert_eq!(count(Some(ratio(1, 1)), Some(ratio(7, 5))), 0);
    assert_eq!(count(Some(ratio(7, 5)), Some(ratio(3, 2))), 1);
    assert_eq!(count(Some(ratio(3, 2)), Some(ratio(7, 5))), 0);
    assert_eq!(count(Some(ratio(-2, 1)), Some(ratio(-7, 5))), 1);
}

#[test]
fn a_budget_of_nothing_ends_the_work() {
    let p = SquareFree::part_of(&mignotte(60, 1_000_003)).unwrap();
    assert!(isolate_real_roots(&p, &spent()).is_err());
    assert!(count_roots_sturm(p.poly(), Bound::Unbounded, Bound::Unbounded, &spent()).is_err());
}

#[test]
fn bounds_hold() {
    for p in [wilkinson(12), mignotte(12, 1001), chebyshev(9), poly(&[-1_000_000, 1]), poly(&[-1, 1 << 40])] {
        let bound = Rational::from(Integer::from(2).pow(root_bound_bits(&p).max(0).unsigned_abs()));
        assert_eq!(
            sturm(&p, Bound::Open(&-&bound), Bound::Open(&bound)),
            sturm(&p, Bound::Unbounded, Bound::Unbounded)
        );
        let positive = sturm(&p, Bound::Open(&Rational::ZERO), Bound::Unbounded);
        assert!(descartes_sign_variations(&p) >= positive);
        assert!(budan_fourier_bound(&p, &Rational::ZERO, &bound) >= positive);
    }
}

#[test]
fn equality_needs_no_refinement_of_the_impossible_kind() {
    // sqrt 2 as a root of three polynomials, and a neighbour 1e-60 away.
    let budget = Budget::unlimited();
    let of = |p: &UniPoly| {
        let p = SquareFree::part_of(p).unwrap();
        RealAlgebraic::in_interval(&p, &ratio(1, 1), &ratio(3, 2), &budget).unwrap().unwrap()
    };
    let a = of(&poly(&[-2, 0, 1]));
    let b = of(&product([poly(&[-2, 0, 1]), poly(&[-3, 0, 0, 1])]).clone().div_exact(&poly(&[-3, 0, 0, 1])).unwrap());
    let c = of(&product([poly(&[-2, 0, 1]), poly(&[-7, 0, 1])]));
    assert!(a == b && b == c && c == a);
    let scale = Integer::from(10).pow(60);
    let near = of(&UniPoly::new(vec![-(&(&scale * &2.into()) + &Integer::ONE), Integer::ZERO, scale]));
    assert!(a < near && near > c);
    let between = rational_between(&a, &near).unwrap();
    assert!(a.compare_rational(&between).is_lt() && near.compare_rational(&between).is_gt());
}

#[test]
fn signs_at_an_algebraic_number() {
    let root = roots(&poly(&[-2, 0, 1])).pop().unwrap();
    assert_eq!(root.sign_of(&poly(&[-2, 0, 1])), Sign::Equal);
    assert_eq!(root.sign_of(&product([poly(&[-2, 0, 1]), poly(&[5, 3])])), Sign::Equal);
    assert_eq!(root.sign_of(&poly(&[-1_414_213, 1_000_000])), Sign::Greater);
    assert_eq!(root.sign_of(&poly(&[-1_414_214, 1_000_000])), Sign::Less);
    assert_eq!(root.sign_of(&poly(&[])), Sign::Equal);
    assert_eq!(root.sign_of(&poly(&[-4])), Sign::Less);
    assert_eq!(root.negated().sign(), Sign::Less);
    assert_eq!(root.floor(), Integer::ONE);
    assert_eq!(root.negated().floor(), Integer::from(-2));
}

#[test]
fn refinement_to_digits_is_relative() {
    // A root near 1e-40 and one near 1e40.
    let huge = Integer::from(10).pow(80);
    for p in [
        UniPoly::new(vec![Integer::from(-2), Integer::ZERO, huge.clone()]),
        UniPoly::new(vec![-(&huge * &2.into()), Integer::ZERO, Integer::ONE]),
    ] {
        for root in roots(&p) {
            for digits in [1, 12, 100] {
                let fine = root.refined_to_digits(digits);
                let (lo, hi) = fine.enclosure();
                let tolerance = Rational::new(Integer::ONE, Integer::from(10).pow(digits as u64 + 2));
                assert!(&hi - &lo <= lo.abs().min(hi.abs()) * tolerance);
                assert!(fine == root && lo < hi);
            }
        }
    }
}

#[test]
fn the_simplest_rational_in_between() {
    assert_eq!(simplest_between(&ratio(3141, 1000), &ratio(3142, 1000)), Some(ratio(245, 78)));
    assert_eq!(simplest_between(&ratio(1, 1), &ratio(2, 1)), Some(ratio(3, 2)));
    assert_eq!(simplest_between(&ratio(0, 1), &ratio(1, 1)), Some(ratio(1, 2)));
    assert_eq!(simplest_between(&ratio(0, 1), &ratio(1, 9)), Some(ratio(1, 10)));
    assert_eq!(simplest_between(&ratio(5, 1), &ratio(9, 1)), Some(ratio(6, 1)));
    assert_eq!(simplest_between(&ratio(-9, 1), &ratio(-5, 1)), Some(ratio(-6, 1)));
    assert_eq!(simplest_between(&ratio(-1, 5), &ratio(1, 9)), Some(ratio(0, 1)));
    assert_eq!(simplest_between(&ratio(1, 1), &ratio(1, 1)), None);
    let found = roots(&poly(&[-2, 0, 1]));
    assert_eq!(rational_between(&found[1], &found[0]), Some(ratio(0, 1)));
    assert_eq!(rational_between(&found[1], &RealAlgebraic::from(ratio(3, 2))), Some(ratio(10, 7)));
    assert_eq!(rational_between(&found[1], &found[1]), None);
}
