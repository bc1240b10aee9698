//! Laws of maps on random loops: cells against exact counts, slices against one parameter, either order.

use crate::helpers::number::number;
use crate::helpers::plane::{algebraic, cell_agrees, ends, is_stable, map, plane, small_loop};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{SquareFree, isolate_real_roots};
use jurist_engine::stability::{Range, Shape, stable_set};
use proptest::collection::vec;
use proptest::prelude::*;

fn region() -> impl Strategy<Value = Shape> {
    prop_oneof![2 => Just(Shape::UnitDisc), 1 => Just(Shape::LeftHalfPlane)]
}

/// A rational number of modest size, round ones often.
fn coordinate() -> impl Strategy<Value = Rational> {
    prop_oneof![
        2 => (-400i64..=400, 1i64..=97).prop_map(|(p, q)| Rational::new(p.into(), q.into())),
        1 => (-4i64..=4).prop_map(Rational::from),
    ]
}

fn domain() -> impl Strategy<Value = [Range; 2]> {
    let range = prop_oneof![
        Just(Range::all()),
        Just(Range::between(Some(number("0")), None)),
        Just(Range::between(Some(number("-3/2")), Some(number("2")))),
    ];
    (range.clone(), range).prop_map(|(a, b)| [a, b])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn every_point_has_the_verdict_of_its_cell_in_either_order(
        p in small_loop(), region in region(), domain in domain(), points in vec((coordinate(), coordinate()), 8),
    ) {
        let budget = Budget::unlimited();
        let m = map(&p, &domain, region);
        let swapped_domain = [domain[1].clone(), domain[0].clone()];
        let swapped = map(&p.swapped(), &swapped_domain, region);
        prop_assert_eq!((m.never_stable, m.regions.len()), (swapped.never_stable, swapped.regions.len()));
        for (x, y) in &points {
            if m.never_stable {
                prop_assert!(!is_stable(&p, x, y, region));
                continue;
            }
            let (inside, open) = (domain[0].contains(x) && domain[1].contains(y), is_stable(&p, x, y, region));
            match cell_agrees(&m, &p, x, y, &domain, region) {
                Some(agrees) => prop_assert!(agrees && inside, "{x} {y}"),
                // A stable point that no cell holds is on a wall between strips.
                None => prop_assert!(!inside || !open || m.slice(x, &domain[1], &budget).unwrap().is_none()),
            }
            if let Some((s, k)) = swapped.locate(y, x, &swapped_domain[1], &budget).unwrap() {
                prop_assert_eq!(swapped.strips[s].cells[k].stable, open);
            }
        }
        for region in &m.regions {
            let same = |r: &jurist_engine::stability::plane::StableRegion| {
                ends(&r.x) == ends(&region.y) && ends(&r.y) == ends(&region.x)
            };
            prop_assert!(swapped.regions.iter().any(same));
        }
    }

    #[test]
    fn slices_are_the_exact_sets_of_one_parameter(
        p in small_loop(), region in region(), domain in domain(), xs in vec(coordinate(), 6),
    ) {
        let budget = Budget::unlimited();
        let m = map(&p, &domain, region);
        for x in xs.iter().filter(|x| domain[0].contains(x)) {
            let Some(one) = p.at_x(x) else { continue };
            let set = stable_set(&one, &domain[1], region, &budget).unwrap().to_interval_set().unwrap();
            if m.never_stable {
                prop_assert!(set.intervals().is_empty());
            } else if let Some(slice) = m.slice(x, &domain[1], &budget).unwrap() {
                prop_assert!(algebraic(&slice).same_as(&set), "x = {x}: {slice:?} {set:?}");
            }
        }
    }

    #[test]
    fn vertical_lines_cut_as_brute_force_does(p in small_loop(), region in region(), xs in vec(coordinate(), 6)) {
        let budget = Budget::unlimited();
        let m = map(&p, &plane(), region);
        for x in &xs {
            let Some(strip) = m.strips.iter().find(|s| s.x.contains(x)) else { continue };
            // All curves at once, as one polynomial in y.
            let mut product = jurist_algebra::poly::UniPoly::from_i64(&[1]);
            for curve in &m.curves {
                let line = curve.polynomial.substitute(0, x).0.to_univariate(1).unwrap();
                product = jurist_algebra::poly::Domain::times(&product, &line);
            }
            let roots = isolate_real_roots(&SquareFree::part_of(&product).unwrap(), &budget).unwrap();
            prop_assert_eq!(strip.cells.len(), roots.len() + 1);
            for (k, cell) in strip.cells.iter().enumerate() {
                let lower = k.checked_sub(1).and_then(|k| roots.get(k)).cloned();
                let between = jurist_engine::stability::AlgebraicInterval { lower, upper: roots.get(k).cloned() };
                prop_assert_eq!(is_stable(&p, x, &between.sample(), region), cell.stable);
            }
        }
    }
}
