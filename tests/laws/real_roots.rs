//! Laws of real root isolation and of real algebraic numbers, on generated polynomials.

use crate::helpers::budget::spent;
use crate::helpers::thorough::count;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational, parse_number};
use jurist_algebra::poly::real_roots::{Bound, budan_fourier_bound, count_roots_sturm};
use jurist_algebra::poly::strategies::{
    ChosenRoot, awkward_rational, nasty_polynomial, polynomial_with_known_roots, small_polynomial,
};
use jurist_algebra::poly::{
    Domain, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots, isolate_real_roots_in, rational_between,
};
use jurist_fuzzing::isolation_against_sturm;
use proptest::prelude::*;
use std::cmp::Ordering;

fn roots(p: &UniPoly) -> Vec<RealAlgebraic> {
    SquareFree::part_of(p).map_or(Vec::new(), |p| isolate_real_roots(&p, &Budget::unlimited()).unwrap())
}

/// Whether an isolated root is the chosen number, seen from the enclosure alone.
fn encloses(root: &RealAlgebraic, chosen: &ChosenRoot) -> bool {
    let (lo, hi) = root.enclosure();
    chosen.compare_rational(&lo).is_ge() && chosen.compare_rational(&hi).is_le()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(40, 200) as u32))]

    #[test]
    fn chosen_roots_are_found(known in polynomial_with_known_roots()) {
        let found = roots(&known.polynomial);
        prop_assert_eq!(found.len(), known.roots.len());
        for chosen in &known.roots {
            let matching: Vec<_> = found.iter().filter(|root| encloses(root, chosen)).collect();
            prop_assert_eq!(matching.len(), 1);
            prop_assert_eq!(matching[0].exact().is_some(), chosen.is_rational());
        }
    }

    #[test]
    fn sturm_agrees_on_nasty_polynomials(p in nasty_polynomial()) {
        let found = roots(&p);
        let count = |lo: Bound, hi: Bound| count_roots_sturm(&p, lo, hi, &Budget::unlimited()).unwrap();
        prop_assert_eq!(found.len(), count(Bound::Unbounded, Bound::Unbounded));
        for root in &found {
            let (lo, hi) = root.enclosure();
            prop_assert_eq!(count(Bound::Closed(&lo), Bound::Closed(&hi)), 1);
        }
        prop_assert!(found.windows(2).all(|w| w[0].enclosure().1 < w[1].enclosure().0));
    }

    #[test]
    fn windows_hold_what_sturm_counts(p in small_polynomial(9), a in awkward_rational(), b in awkward_rational()) {
        prop_assume!(!p.coeffs().is_empty());
        let budget = Budget::unlimited();
        let square_free = SquareFree::part_of(&p).unwrap();
        let inside = |lo: Option<&Rational>, hi: Option<&Rational>| isolate_real_roots_in(&square_free, lo, hi, &budget).unwrap().len();
        let count = |lo: Bound, hi: Bound| count_roots_sturm(&p, lo, hi, &budget).unwrap();
        prop_assert_eq!(inside(Some(&a), Some(&b)), count(Bound::Open(&a), Bound::Open(&b)));
        prop_assert_eq!(inside(Some(&a), None), count(Bound::Open(&a), Bound::Unbounded));
        prop_assert_eq!(inside(None, Some(&b)), count(Bound::Unbounded, Bound::Open(&b)));
        if a <= b {
            prop_assert!(budan_fourier_bound(&p, &a, &b) >= count(Bound::Open(&a), Bound::Closed(&b)));
        }
    }

    #[test]
    fn windows_of_polynomials_in_a_power(p in nasty_polynomial(), a in awkward_rational()) {
        prop_assume!(!p.coeffs().is_empty());
        let budget = Budget::unlimited();
        let square_free = SquareFree::part_of(&p).unwrap();
        let below = isolate_real_roots_in(&square_free, None, Some(&a), &budget).unwrap().len();
        let above = isolate_real_roots_in(&square_free, Some(&a), None, &budget).unwrap().len();
        let at = usize::from(p.sign_at(&a).is_eq());
        prop_assert_eq!(below + at + above, roots(&p).len());
    }

    #[test]
    fn the_order_is_total_and_kept_by_refinement(p in small_polynomial(6), q in small_polynomial(6)) {
        // Common factors make equal numbers with different polynomials.
        let mut all = roots(&p);
        all.extend(roots(&q));
        all.extend(roots(&(&p * &q)).into_iter().take(4));
        for a in &all {
            prop_assert_eq!(a.compare(a), Ordering::Equal);
            for b in &all {
                let order = a.compare(b);
                prop_assert_eq!(b.compare(a), order.reverse());
                let (fine_a, fine_b) = (a.refined_to_digits(30), b.refined_to_digits(30));
                prop_assert_eq!(fine_a.compare(&fine_b), order);
                if order.is_lt() {
                    prop_assert!(fine_a.enclosure().0 < fine_b.enclosure().1);
                    let between = rational_between(a, b).unwrap();
                    prop_assert!(a.compare_rational(&between).is_lt() && b.compare_rational(&between).is_gt());
                } else if order.is_eq() {
                    prop_assert_eq!(a.exact(), b.exact());
                    prop_assert!(a.sign_of(b.polynomial()).is_eq());
                }
                prop_assert_eq!(a.negated().compare(&b.negated()), order.reverse());
                for c in &all {
                    prop_assert!(!(order.is_le() && b.compare(c).is_le()) || a.compare(c).is_le());
                }
            }
        }
    }

    #[test]
    fn signs_agree_with_the_order_of_roots(p in small_polynomial(6), q in small_polynomial(6)) {
        prop_assume!(!q.coeffs().is_empty());
        let zeros = roots(&q);
        let decomposition = q.square_free_decomposition();
        let multiplicity = |z: &RealAlgebraic| {
            decomposition.iter().filter(|(f, _)| z.sign_of(f).is_eq()).map(|(_, m)| *m).sum::<usize>()
        };
        for a in roots(&p) {
            // From the sign at infinity, one change for each odd root passed.
            let mut sign = q.leading().unwrap().sign();
            for z in zeros.iter().rev() {
                match z.compare(&a) {
                    Ordering::Greater if multiplicity(z) % 2 == 1 => sign = sign.reverse(),
                    Ordering::Equal => sign = Ordering::Equal,
                    _ => {}
                }
                if sign.is_eq() {
                    break;
                }
            }
            prop_assert_eq!(a.sign_of(&q), sign);
        }
    }

    #[test]
    fn decimals_are_correctly_rounded(p in nasty_polynomial(), digits in 1usize..30) {
        for root in roots(&p) {
            let text = root.decimal(digits);
            let value = parse_number(&text).unwrap();
            // Half a unit in the last place: the exponent of the leading digit decides.
            let magnitude = value.abs();
            if magnitude.is_zero() {
                prop_assert_eq!(root.exact(), Some(Rational::ZERO));
                continue;
            }
            let ten = Rational::from(10);
            let (mut unit, mut exponent) = (Rational::ONE, 0i64);
            while magnitude < unit { unit = unit.checked_div(&ten).unwrap(); exponent -= 1; }
            while magnitude >= &unit * &ten { unit = &unit * &ten; exponent += 1; }
            let half = ten.pow(exponent - digits as i64 + 1).unwrap() * Rational::new(Integer::ONE, 2.into());
            prop_assert!(root.compare_rational(&(&value - &half)).is_ge());
            prop_assert!(root.compare_rational(&(&value + &half)).is_le());
        }
    }

    #[test]
    fn floors_are_below(p in nasty_polynomial()) {
        for root in roots(&p) {
            let floor = root.floor();
            prop_assert!(root.compare_rational(&Rational::from(&floor)).is_ge());
            prop_assert!(root.compare_rational(&Rational::from(floor + Integer::ONE)).is_lt());
            let (below, above) = (root.rational_below(), root.rational_above());
            prop_assert!(root.compare_rational(&below).is_gt() && root.compare_rational(&above).is_lt());
            prop_assert!(&above - &below <= Rational::from(2));
        }
    }

    #[test]
    fn bytes_make_no_trouble(data in proptest::collection::vec(any::<u8>(), 0..60)) {
        isolation_against_sturm(&data);
    }

    #[test]
    fn square_free_parts_have_the_same_roots(p in small_polynomial(5), q in small_polynomial(4)) {
        prop_assume!(!p.coeffs().is_empty() && !q.coeffs().is_empty());
        let product = &(&p * &p) * &q;
        let part = SquareFree::part_of(&product).unwrap();
        prop_assert_eq!(part.poly(), &product.square_free_part());
        prop_assert!(SquareFree::new(part.poly().clone()).is_some());
        prop_assert_eq!(SquareFree::new(product.clone()).is_none(), part.degree() < product.degree().unwrap());
        prop_assert!(part.poly().gcd(&part.poly().derivative()).is_constant());
    }
}

/// The only root of an odd power below zero was enclosed with the signs at the ends exchanged, and
/// refined to nothing.
#[test]
fn negative_root_of_an_odd_power() {
    for (p, expected) in [
        (UniPoly::from_i64(&[1, 0, 0, 0, 0, 0, 0, 0, 0, 2]), "-0.925874712287290429205"),
        (UniPoly::from_i64(&[-1, 0, 0, 0, 0, 0, 0, 0, 0, -2]), "-0.925874712287290429205"),
        (UniPoly::from_i64(&[2, 0, 0, 1]), "-1.25992104989487316477"),
    ] {
        let found = roots(&p);
        assert_eq!(found.len(), 1, "{p:?}");
        assert_eq!(found[0].decimal(21), expected, "{p:?}");
    }
}

/// A budget that has run out stops comparisons and signs before they begin to refine.
#[test]
fn comparisons_keep_the_budget() {
    use jurist_algebra::limits::Budget;
    use jurist_algebra::poly::{Domain, SquareFree, UniPoly, isolate_real_roots};
    let roots = |coeffs: &[i64]| {
        let p = SquareFree::part_of(&UniPoly::from_i64(coeffs)).unwrap();
        isolate_real_roots(&p, &Budget::unlimited()).unwrap()
    };
    // The root of 2 in two polynomials: only a common divisor decides.
    let (a, b) = (roots(&[-2, 0, 1]), roots(&[2, -2, -1, 1]));
    let spent = spent();
    let (x, y) = (&a[1], b.iter().find(|y| y.decimal(5) == "1.4142").unwrap());
    assert!(spent.enter(|| x.compare(y)).is_err());
    assert!(x.compare(y).is_eq());
    let q = UniPoly::from_i64(&[2, -2, -1, 1]);
    assert!(spent.enter(|| x.sign_of(&q)).is_err());
    assert!(x.sign_of(&q).is_eq());
    assert!(spent.enter(|| q.times(&q).gcd(&q)).is_err());
    assert!(spent.enter(|| SquareFree::part_of(&q.times(&q))).is_err());
}
