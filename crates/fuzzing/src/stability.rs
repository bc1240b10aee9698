//! The tests of stability against each other, on arbitrary polynomials.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use jurist_engine::stability::{
    ParametricPolynomial, Range, Shape, classical_test, count_roots, is_hurwitz_routh, is_schur_jury, is_stable,
    stable_set,
};
use std::time::Duration;

/// Reads a polynomial from bytes and compares the tables of Jury and Routh with the root count, and
/// the count with that of the reversed polynomial.
///
/// # Panics
/// When two ways disagree.
pub fn jury_against_count(data: &[u8]) {
    let Some((&kind, data)) = data.split_first() else { return };
    let mut p = UniPoly::new(data.iter().take(18).map(|&b| Integer::from(i64::from(b as i8))).collect());
    // A product with its reversal is all mirror pairs.
    if kind & 1 == 1
        && let Some(n) = p.degree()
    {
        p = p.times(&p.reversed(n));
    }
    let Some(n) = p.degree() else { return };
    let disc = count_roots(&p, Shape::UnitDisc);
    assert_eq!(disc.total(), n);
    assert_eq!(is_schur_jury(&p), is_stable(&p, Shape::UnitDisc));
    assert_eq!(is_hurwitz_routh(&p), is_stable(&p, Shape::LeftHalfPlane));
    if !p.coeff(0).is_zero() {
        let mirrored = count_roots(&p.reversed(n), Shape::UnitDisc);
        assert_eq!((disc.inside, disc.on, disc.outside), (mirrored.outside, mirrored.on, mirrored.inside));
    }
}

/// Reads a polynomial with one parameter from bytes, finds its stable set in both ways, and compares it
/// with exact tests at parameter values from the bytes.
///
/// # Panics
/// When two ways disagree.
pub fn interval_answer(data: &[u8]) {
    let [kind, degree, rest @ ..] = data else { return };
    let region = if kind & 1 == 0 { Shape::UnitDisc } else { Shape::LeftHalfPlane };
    let n = usize::from(degree % 6);
    let (coefficients, values) = rest.split_at(rest.len().min(3 * (n + 1)));
    let rows = coefficients.chunks(3).map(|c| c.iter().map(|&b| i64::from(b as i8)).collect::<Vec<_>>());
    let d: Poly<UniPoly> = Poly::new(rows.map(|row| UniPoly::from_i64(&row)).collect());
    let formal_degree = d.degree().unwrap_or(0).max(if kind & 2 == 0 { 0 } else { n });
    let p = ParametricPolynomial::from_integral(&d, formal_degree);
    let bound = |b: u8| Rational::from(i64::from(b as i8));
    let range = match values {
        [a, b, ..] if kind & 4 != 0 && (*a as i8) < (*b as i8) => Range::between(Some(bound(*a)), Some(bound(*b))),
        _ => Range::all(),
    };
    // Degenerate inputs may be slow to test; what the budget cuts off is no finding.
    let budget = Budget::with_timeout(Duration::from_secs(5));
    let Ok(set) = stable_set(&p, &range, region, &budget) else { return };
    for pair in values.chunks(2).filter(|c| c.len() == 2) {
        let value = Rational::new(Integer::from(i64::from(pair[0] as i8)), Integer::from(u64::from(pair[1] % 16) + 1));
        if range.contains(&value) {
            assert_eq!(set.contains(&value), p.is_stable_at(&value, region), "at {value}");
        }
    }
    for interval in set.intervals() {
        for end in [&interval.lower, &interval.upper].into_iter().flatten() {
            assert!(end.causes.iter().next().is_some(), "an end without a cause");
            if let Some(exact) = end.value.exact() {
                assert!(!range.contains(&exact) || !p.is_stable_at(&exact, region));
            }
        }
    }
    if let Ok(test) = classical_test(&p, &range, region, &budget) {
        assert!(test.intersection.same_as(&set.to_interval_set().unwrap()));
    }
}
