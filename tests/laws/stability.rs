//! Laws of stability: counts against roots known by construction, every algorithm against every other.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use jurist_engine::stability::strategies::{chosen_loop, expected_count, polynomial_with_chosen_roots};
use jurist_engine::stability::*;
use proptest::collection::vec;
use proptest::prelude::*;

const DISC: Shape = Shape::UnitDisc;
const HALF_PLANE: Shape = Shape::LeftHalfPlane;

/// `(1 - s)^n p((1 + s)/(1 - s))`: the unit disc onto the left half plane; a root at -1 goes to infinity.
fn bilinear(p: &UniPoly) -> UniPoly {
    let n = p.degree().unwrap_or(0);
    let (plus, minus) = (UniPoly::from_i64(&[1, 1]), UniPoly::from_i64(&[1, -1]));
    let mut sum = UniPoly::zero();
    for (k, c) in p.coeffs().iter().enumerate() {
        sum = sum.plus(&plus.power(k as u64).times(&minus.power((n - k) as u64)).scaled(c));
    }
    sum
}

fn any_polynomial() -> impl Strategy<Value = UniPoly> {
    prop_oneof![vec(-9i64..=9, 1..12), vec(-2i64..=2, 1..10), vec(-1_000_000_000i64..=1_000_000_000, 1..8),]
        .prop_map(|c| UniPoly::from_i64(&c))
        .prop_filter("zero has no count", |p| !p.is_zero())
}

proptest! {
    #[test]
    fn count_equals_the_chosen_roots((p, factors) in polynomial_with_chosen_roots(7)) {
        for region in [DISC, HALF_PLANE] {
            prop_assert_eq!(count_roots(&p, region), expected_count(&factors, region));
        }
    }

    #[test]
    fn jury_and_routh_agree_with_the_count(p in any_polynomial()) {
        prop_assert_eq!(is_schur_jury(&p), is_stable(&p, DISC));
        prop_assert_eq!(is_hurwitz_routh(&p), is_stable(&p, HALF_PLANE));
    }

    #[test]
    fn jury_and_routh_agree_on_chosen_roots((p, _) in polynomial_with_chosen_roots(6)) {
        prop_assert_eq!(is_schur_jury(&p), is_stable(&p, DISC));
        prop_assert_eq!(is_hurwitz_routh(&p), is_stable(&p, HALF_PLANE));
    }

    #[test]
    fn bilinear_map_carries_the_count(p in any_polynomial()) {
        let disc = count_roots(&p, DISC);
        let mapped = bilinear(&p);
        let half_plane = count_roots(&mapped, HALF_PLANE);
        let at_infinity = disc.total() - half_plane.total();
        prop_assert_eq!(disc.inside, half_plane.inside);
        prop_assert_eq!(disc.outside, half_plane.outside);
        prop_assert_eq!(disc.on, half_plane.on + at_infinity);
    }

    #[test]
    fn reversal_exchanges_inside_and_outside(p in any_polynomial()) {
        prop_assume!(!p.coeff(0).is_zero());
        let n = p.degree().unwrap();
        let (a, b) = (count_roots(&p, DISC), count_roots(&p.reversed(n), DISC));
        prop_assert_eq!((a.inside, a.on, a.outside), (b.outside, b.on, b.inside));
    }

    #[test]
    fn count_is_additive(p in any_polynomial(), q in any_polynomial()) {
        for region in [DISC, HALF_PLANE] {
            let (a, b, c) = (count_roots(&p, region), count_roots(&q, region), count_roots(&p.times(&q), region));
            prop_assert_eq!((a.inside + b.inside, a.on + b.on, a.outside + b.outside), (c.inside, c.on, c.outside));
        }
    }

    #[test]
    fn divided_and_plain_jury_tables_have_the_same_signs(p in any_polynomial()) {
        // |first| against |last| of each row is not changed by dividing the row by a number that is not zero.
        let n = p.degree().unwrap();
        let (plain, divided) = (jury_table_with(&p, n, false), jury_table_with(&p, n, true));
        let signs = |t: &JuryTable<Integer>| -> Vec<_> {
            t.end_entries().map(|(f, l)| f.abs().cmp(&l.abs())).collect()
        };
        let vanished = plain.rows.iter().position(|r| r.entries[0].is_zero()).unwrap_or(plain.rows.len());
        prop_assert_eq!(&signs(&plain)[..vanished], &signs(&divided)[..vanished]);
    }
}

fn parameter() -> impl Strategy<Value = Rational> {
    (-60i64..=60, 1i64..=12).prop_map(|(p, q)| Rational::new(Integer::from(p), Integer::from(q)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn stable_set_of_chosen_loops(
        disc in chosen_loop(DISC, 4),
        half_plane in chosen_loop(HALF_PLANE, 4),
        values in vec(parameter(), 24),
    ) {
        for chosen in [disc, half_plane] {
            let d = chosen.polynomial();
            let n: usize = chosen.factors.iter().map(|f| f.factor.degree()).sum();
            let p = ParametricPolynomial::from_integral(&d, n);
            let set = stable_set(&p, &Range::all(), chosen.region, &Budget::unlimited()).unwrap();
            for k in &values {
                prop_assert_eq!(set.contains(k), chosen.is_stable_at(k), "at {}", k);
            }
            for interval in set.intervals() {
                for end in [&interval.lower, &interval.upper].into_iter().flatten() {
                    prop_assert!(end.causes.iter().next().is_some(), "an end without a cause");
                    prop_assert_eq!(end.causes.contains(Cause::ComplexPair), end.pair.is_some());
                    if let Some(exact) = end.value.exact() {
                        prop_assert!(!chosen.is_stable_at(&exact));
                    }
                }
            }
        }
    }

    #[test]
    fn classical_test_equals_the_boundary_way(
        disc in chosen_loop(DISC, 3),
        half_plane in chosen_loop(HALF_PLANE, 3),
        lower in prop::option::of(parameter()),
    ) {
        for chosen in [disc, half_plane] {
            let n: usize = chosen.factors.iter().map(|f| f.factor.degree()).sum();
            let p = ParametricPolynomial::from_integral(&chosen.polynomial(), n);
            let range = Range::between(lower.clone(), None);
            let budget = Budget::unlimited();
            let set = stable_set(&p, &range, chosen.region, &budget).unwrap();
            let test = classical_test(&p, &range, chosen.region, &budget).unwrap();
            prop_assert!(test.intersection.same_as(&set.to_interval_set().unwrap()), "{:?}\n{:?}", test.intersection, set);
        }
    }

    #[test]
    fn random_parametric_polynomials_agree_in_both_ways(
        rows in vec(vec(-4i64..=4, 1..4), 2..6),
        values in vec(parameter(), 12),
    ) {
        let d = Poly::new(rows.iter().map(|r| UniPoly::from_i64(r)).collect());
        let n = rows.len() - 1;
        let p = ParametricPolynomial::from_integral(&d, n);
        let budget = Budget::unlimited();
        for region in [DISC, HALF_PLANE] {
            let set = stable_set(&p, &Range::all(), region, &budget).unwrap();
            let test = classical_test(&p, &Range::all(), region, &budget).unwrap();
            prop_assert!(test.intersection.same_as(&set.to_interval_set().unwrap()), "{:?}\n{:?}", test.intersection, set);
            for k in &values {
                let special: UniPoly = Poly::new(
                    d.coeffs().iter().map(|c| c.eval_rational(k)).collect::<Vec<_>>()
                ).map(|c| c.numerator() * Integer::from(12i64 * 11 * 10 * 9 * 8 * 7).pow(4).div_exact(&c.denominator()));
                let stable = special.degree() == Some(n) && (n == 0 || match region {
                    DISC => is_schur_jury(&special),
                    HALF_PLANE => is_hurwitz_routh(&special),
                });
                prop_assert_eq!(set.contains(k), stable, "at {}", k);
            }
        }
    }
}
