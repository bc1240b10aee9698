//! Complex roots in discs, against polynomials with known roots and against Sturm's theorem.

use crate::helpers::polynomial::{mignotte, product};
use crate::helpers::thorough::count;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{RootDisc, SquareFree, UniPoly, complex_roots, isolate_real_roots, root_discs};
use proptest::prelude::*;

const BITS: u64 = 60;

fn narrow() -> Rational {
    Rational::dyadic(&1.into(), BITS)
}

fn roots(p: &UniPoly) -> Vec<RootDisc> {
    complex_roots(p, &narrow(), &Budget::unlimited()).unwrap()
}

/// `(x - a)^2 + b^2`, or `x - a` where b is zero.
fn of_root(a: i64, b: i64) -> UniPoly {
    if b == 0 { UniPoly::from_i64(&[-a, 1]) } else { UniPoly::from_i64(&[a * a + b * b, -2 * a, 1]) }
}

fn holds(disc: &RootDisc, a: i64, b: i64) -> bool {
    let (x, y) = (&disc.re - &Rational::from(a), &disc.im - &Rational::from(b));
    &x * &x + &y * &y <= &disc.radius * &disc.radius
}

#[test]
fn singular_polynomials() {
    let of = |coefficients: &[i64]| UniPoly::from_i64(coefficients);
    assert!(roots(&of(&[7])).is_empty());
    let zero = roots(&of(&[0, 0, 0, 3]));
    assert_eq!((zero.len(), zero[0].count, zero[0].radius.is_zero(), zero[0].re.is_zero()), (1, 3, true, true));
    let linear = roots(&of(&[-1, 3]));
    assert_eq!((linear[0].re.to_string().as_str(), linear[0].radius.is_zero()), ("1/3", true));
    // (x^2 + 1)^3 (x - 1)^2.
    let many = roots(&product([of_root(0, 1), of_root(0, 1), of_root(0, 1), of_root(1, 0), of_root(1, 0)]));
    let mut counts: Vec<(usize, bool)> = many.iter().map(|d| (d.count, d.is_pair)).collect();
    counts.sort();
    assert_eq!(counts, [(2, false), (3, true)]);
    // Roots 10^-8 apart, and roots from 10^-12 to 10^12.
    for p in [
        mignotte(12, 40),
        product([
            of_root(1, 0),
            UniPoly::new(vec![Integer::ONE, Integer::from(10).pow(12)]),
            UniPoly::new(vec![Integer::from(10).pow(12), Integer::ONE]),
        ]),
    ] {
        check(&p);
    }
    // All roots on a circle, and Wilkinson's polynomial.
    let mut unity = vec![Integer::ZERO; 25];
    unity[0] = -Integer::ONE;
    unity[24] = Integer::ONE;
    check(&UniPoly::new(unity));
    check(&product((1..=20).map(|k| of_root(k, 0))));
}

/// As many as the degree, apart, narrow, and as many real ones as Sturm's theorem counts.
fn check(p: &UniPoly) {
    let found = roots(p);
    let total: usize = found.iter().map(|d| d.count * if d.is_pair { 2 } else { 1 }).sum();
    assert_eq!(Some(total), p.degree(), "{p:?}");
    assert!(found.iter().all(|d| d.is_fine(&narrow())), "{p:?}");
    let real: Vec<&RootDisc> = found.iter().filter(|d| !d.is_pair).collect();
    let isolated = isolate_real_roots(&SquareFree::part_of(p).unwrap(), &Budget::unlimited()).unwrap();
    assert_eq!(real.len(), isolated.len(), "{p:?}");
    for root in isolated {
        let (lo, hi) = root.refined(&Rational::dyadic(&1.into(), 300)).enclosure();
        let is_in = |d: &&&RootDisc| &d.re - &d.radius <= hi && lo <= &d.re + &d.radius;
        assert_eq!(real.iter().filter(is_in).count(), 1, "{p:?}");
    }
}

/// Coefficients that are not known well share a disc among roots that may be equal, and never lose one.
#[test]
fn enclosed_coefficients_of_a_double_root_share_a_disc() {
    let p = product([of_root(1, 0), of_root(1, 0), of_root(-3, 2)]);
    let bits = 256;
    let balls: Vec<Ball> =
        p.coeffs().iter().map(|c| Ball::from_integer(c, bits).widened(&(Integer::ONE << 100))).collect();
    let found = root_discs(&balls, bits).unwrap();
    let double = found.iter().find(|d| !d.is_pair).unwrap();
    assert_eq!((double.count, double.is_one), (2, false));
    assert!(holds(double, 1, 0) && found.iter().any(|d| d.is_pair && holds(d, -3, 2)));
    let leading = [Ball::from_integer(&1.into(), bits), Ball::zero(bits).widened(&1.into())];
    assert!(root_discs(&leading, bits).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(64, 256) as u32))]

    #[test]
    fn known_roots_are_found_with_their_multiplicity(known in prop::collection::vec((-9i64..10, 0i64..5), 1..9)) {
        let p = product(known.iter().map(|(a, b)| of_root(*a, *b)));
        let found = roots(&p);
        for (a, b) in &known {
            let here: Vec<&RootDisc> = found.iter().filter(|d| holds(d, *a, *b)).collect();
            prop_assert_eq!(here.len(), 1);
            prop_assert_eq!(here[0].count, known.iter().filter(|other| *other == &(*a, *b)).count());
            prop_assert_eq!(here[0].is_pair, *b > 0);
        }
        let total: usize = found.iter().map(|d| d.count * if d.is_pair { 2 } else { 1 }).sum();
        prop_assert_eq!(Some(total), p.degree());
    }

    #[test]
    fn random_polynomials_have_as_many_real_roots_as_sturm_counts(coefficients in prop::collection::vec(-1000i64..1000, 2..14)) {
        let p = UniPoly::from_i64(&coefficients);
        prop_assume!(p.degree().is_some_and(|n| n > 0));
        check(&p);
    }
}
