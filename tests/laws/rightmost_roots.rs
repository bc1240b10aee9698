//! Random loops with dead time: the listed roots against Newton's method in floating point, from them and from a grid, and against the count along
//! the axis.

use crate::helpers::thorough::count;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::UniPoly;
use jurist_engine::stability::dead_time::{QuasiPolynomial, RightmostRoots, count_delayed_roots, rightmost_roots};
use proptest::prelude::*;

/// A loop of retarded type of order one to five, with one or two delays, and its dead time.
fn retarded_loop() -> impl Strategy<Value = (QuasiPolynomial, Rational)> {
    let coefficients = |n| prop::collection::vec(-9i64..=9, n);
    (1usize..=5, 1usize..=2, 1usize..=3, 1i64..=12).prop_flat_map(move |(order, delays, gap, tau)| {
        let tau = Rational::new(Integer::from(tau), Integer::from(4));
        let others = prop::collection::vec((1..=order).prop_flat_map(coefficients), delays);
        (coefficients(order), others, 1i64..=4, Just((gap, tau))).prop_filter_map(
            "a delay",
            |(mut first, mut others, top, (gap, tau))| {
                first.push(top);
                // The second delay is one, two or three times the first one.
                let last = others.pop().expect("there is a delay");
                others.resize(others.len() * gap, Vec::new());
                others.push(last);
                let parts = std::iter::once(first).chain(others).map(|c| UniPoly::from_i64(&c)).collect();
                QuasiPolynomial::new(parts).filter(|p| p.delays() > 0).map(|p| (p, tau))
            },
        )
    })
}

type Complex = (f64, f64);

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn plus(a: Complex, b: Complex) -> Complex {
    (a.0 + b.0, a.1 + b.1)
}

/// Where Newton's method comes to rest.
fn newton(p: &QuasiPolynomial, tau: f64, mut s: Complex) -> Option<Complex> {
    for _ in 0..60 {
        let (mut value, mut slope) = ((0.0, 0.0), (0.0, 0.0));
        for (k, part) in p.parts().iter().enumerate() {
            let (mut own, mut own_slope) = ((0.0, 0.0), (0.0, 0.0));
            for c in part.coeffs().iter().rev() {
                own_slope = plus(times(own_slope, s), own);
                own = plus(times(own, s), (c.to_f64_approximate(), 0.0));
            }
            let delay = k as f64 * tau;
            let (size, angle) = ((-delay * s.0).exp(), -delay * s.1);
            let z = (size * angle.cos(), size * angle.sin());
            value = plus(value, times(own, z));
            slope = plus(slope, times(plus(own_slope, (-delay * own.0, -delay * own.1)), z));
        }
        let square = slope.0 * slope.0 + slope.1 * slope.1;
        let step = times(value, (slope.0 / square, -slope.1 / square));
        s = (s.0 - step.0, s.1 - step.1);
        if !s.0.is_finite() || !s.1.is_finite() {
            return None;
        }
        if step.0.hypot(step.1) <= 1e-11 * (1.0 + s.0.hypot(s.1)) {
            return Some((s.0, s.1.abs()));
        }
    }
    None
}

fn listed(found: &RightmostRoots) -> Vec<(Complex, usize)> {
    let rounded = |x: &Rational| x.to_f64_approximate();
    found.list.iter().map(|disc| ((rounded(&disc.re), rounded(&disc.im)), disc.count)).collect()
}

fn near(a: Complex, b: Complex) -> bool {
    (a.0 - b.0).hypot(a.1 - b.1) <= 1e-5 * (1.0 + a.0.hypot(a.1))
}

fn holds(p: &QuasiPolynomial, tau: &Rational) -> Result<(), TestCaseError> {
    let budget = Budget::unlimited();
    let relative = Rational::dyadic(&Integer::ONE, 50);
    let found = rightmost_roots(p, tau, 6, &relative, &budget).unwrap().unwrap();
    let (roots, rounded) = (listed(&found), tau.to_f64_approximate());
    prop_assert!(roots.len() >= 6, "{:?}", found);
    for (root, count) in &roots {
        let own = newton(p, rounded, *root);
        prop_assert!(*count > 1 || own.is_some_and(|own| near(own, *root)), "{:?}: {:?} {:?}", p, root, own);
    }
    let line = found.others_left_of.to_f64_approximate();
    let high = 1.5 * roots.iter().fold(1.0, |most: f64, (root, _)| most.max(root.1));
    for i in 0..40 {
        for j in 0..8 {
            let start = (line + f64::from(j) / rounded.max(0.5), high * f64::from(i) / 40.0 + 1e-3);
            let Some(root) = newton(p, rounded, start).filter(|root| root.0 > line + 1e-5) else { continue };
            prop_assert!(
                roots.iter().any(|(known, _)| near(*known, root)),
                "{:?} at {}: {:?} of {:?}",
                p,
                tau,
                root,
                roots
            );
        }
    }
    if !found.others_left_of.sign().is_gt() {
        let count = count_delayed_roots(p, tau, &budget).unwrap();
        let right = found.list.iter().filter(|disc| disc.re > disc.radius);
        let right: usize = right.map(|disc| disc.count * if disc.is_pair { 2 } else { 1 }).sum();
        prop_assert_eq!(count.right, Some(right), "{:?} at {}", p, tau);
    }
    Ok(())
}

proptest! {
    // ROOTS_CASES=400 tries more.
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    #[test]
    fn the_rightmost_roots_are_roots_and_no_others_are_right_of_the_line((p, tau) in retarded_loop()) {
        holds(&p, &tau)?;
    }
}

/// How many loops are tried.
fn cases() -> u32 {
    std::env::var("ROOTS_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(count(16, 40) as u32)
}
