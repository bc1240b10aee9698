//! The root locus: continuity of branches, the cluster at z = 1, crossings, gaps.

use crate::helpers::budget::spent;
use crate::helpers::drive::drive_polynomial;
use crate::helpers::number::ratio;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;
use jurist_draw::simulate::{LocusOptions, ParameterScale, RootLocus, trace_root_locus};
use nalgebra::Complex;

fn drive_locus(through: Vec<Rational>) -> RootLocus {
    let t = ratio(1, 10_000);
    let options = LocusOptions {
        lower: ratio(1, 1000),
        upper: ratio(1000, 1),
        scale: ParameterScale::Logarithmic,
        focus: Complex::new(1.0, 0.0),
        through,
        reach: 2.0,
    };
    trace_root_locus(|k| Some(drive_polynomial(k, &t)), &options, &Budget::unlimited()).unwrap()
}

/// The first place where a branch moves further than a tenth of its distance from z = 1.
fn first_jump(locus: &RootLocus) -> Option<(f64, Complex<f64>)> {
    for branch in locus.branches() {
        for pair in branch.points.windows(2) {
            let ((k, a), (next, b)) = (pair[0], pair[1]);
            assert!(k < next);
            let near = (a - 1.0).norm().min((b - 1.0).norm());
            if (a - b).norm() > (0.1 * near).max(1e-4) {
                return Some((k, a));
            }
        }
    }
    None
}

#[test]
fn branches_that_exchange_their_roots_are_seen_to_jump() {
    let mut locus = drive_locus(vec![]);
    let middle = locus.pieces[0].len() / 2;
    locus.pieces[0][middle].roots.reverse();
    let before = locus.pieces[0][middle - 1].parameter.to_f64_approximate();
    assert_eq!(first_jump(&locus).map(|(k, _)| k), Some(before));
}

#[test]
fn branches_are_continuous_and_pass_through_the_crossings() {
    let (lower, upper) = (ratio(381_005_333_483, 10_000_000_000_000), ratio(550_941_166_686_675, 1_000_000_000_000));
    let locus = drive_locus(vec![lower.clone(), upper.clone()]);
    assert_eq!(locus.pieces.len(), 1);
    assert_eq!(locus.branches().len(), 6);
    assert_eq!(first_jump(&locus), None);
    for (value, frequency) in [(lower, 0.505696), (upper, 1664.0)] {
        let sample = locus.samples().find(|s| s.parameter == value).unwrap();
        let on = |z: &&Complex<f64>| (z.norm() - 1.0).abs() < 1e-12 && z.im > 0.0;
        let z = sample.roots.iter().find(on).unwrap();
        let found = z.arg() / std::f64::consts::TAU * 10_000.0;
        assert!((found / frequency - 1.0).abs() < 1e-3, "{found}");
    }
}

#[test]
fn inside_the_certified_limits_every_drawn_root_is_inside_the_circle() {
    for sample in drive_locus(vec![]).samples() {
        let k = sample.parameter.to_f64_approximate();
        let largest = sample.roots.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let stable = k > 0.0381005333482991 && k < 550.941166686674;
        assert_eq!(largest < 1.0, stable, "K = {k}: {largest}");
    }
}

/// From 0 to 2, evenly, nothing in particular looked at.
fn plain_options() -> LocusOptions {
    LocusOptions {
        lower: ratio(0, 1),
        upper: ratio(2, 1),
        scale: ParameterScale::Linear,
        focus: Complex::new(1.0, 0.0),
        through: vec![],
        reach: 3.0,
    }
}

#[test]
fn a_degree_that_is_lost_makes_a_gap_and_not_a_jump() {
    // (k - 1) z^2 + z + 1: a root passes through infinity at k = 1.
    let of = |k: &Rational| {
        let p = jurist_algebra::poly::Poly::new(vec![ratio(1, 1), ratio(1, 1), k - &ratio(1, 1)]);
        Some(UniPoly::from_rational_poly(&p).1)
    };
    let locus = trace_root_locus(of, &plain_options(), &Budget::unlimited()).unwrap();
    assert_eq!(locus.pieces.len(), 2);
    assert!(locus.to_csv("k").starts_with("k,re_1,im_1,re_2,im_2\n"));
}

/// Both roots of `(z - k)^2`, and those of `(z - k)(z - k - 10^-30)`, go together: no step is halved for their sake.
#[test]
fn roots_that_go_together_are_followed_in_few_steps() {
    let tiny: Rational = "1e-30".parse().unwrap();
    for apart in [ratio(0, 1), tiny] {
        let of = |k: &Rational| {
            let other = k + &apart;
            let p = jurist_algebra::poly::Poly::new(vec![k * &other, -(k + &other), ratio(1, 1)]);
            Some(UniPoly::from_rational_poly(&p).1)
        };
        let locus = trace_root_locus(of, &plain_options(), &Budget::unlimited()).unwrap();
        assert!(locus.samples().count() < 2000, "{}", locus.samples().count());
    }
}

#[test]
fn a_budget_ends_the_tracing() {
    let none = spent();
    assert!(trace_root_locus(|k| Some(drive_polynomial(k, &ratio(1, 100))), &plain_options(), &none).is_err());
}
