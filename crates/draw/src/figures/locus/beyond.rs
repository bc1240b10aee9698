//! The locus of a gain outside of the range that is drawn: from the poles of the open loop, and to its zeros.

use crate::simulate::{LocusOptions, LocusSample, ParameterScale, RootLocus, roots, trace_root_locus};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;
use jurist_engine::stability::Range;
use nalgebra::Complex;

/// The roots are followed to this many times the upper end; there, all that end are near their zeros.
const FARTHEST: i64 = 100_000;

/// Roots that are nearer to a zero than this share of the reach end in it.
const NEAR: f64 = 0.1;

/// Positive values within the domain: from 0 to the range, and from the range on, to the `zeros` where there is no upper end.
pub(super) fn of(
    polynomial: impl Fn(&Rational) -> Option<UniPoly>,
    zeros: &UniPoly,
    domain: &Range,
    options: &LocusOptions,
    budget: &Budget,
) -> Result<RootLocus, Exhausted> {
    let zero = Rational::ZERO;
    let trace = |lower: &Rational, upper: &Rational, scale: ParameterScale| {
        let (lower, upper) = (lower.clone(), upper.clone());
        trace_root_locus(&polynomial, &LocusOptions { lower, upper, scale, through: Vec::new(), ..*options }, budget)
    };
    let mut found = RootLocus::default();
    if options.lower > zero && domain.lower.as_ref().is_none_or(|l| *l <= zero) {
        found.pieces.extend(trace(&zero, &options.lower, ParameterScale::Linear)?.pieces);
    }
    let far = &options.upper * Rational::from(FARTHEST);
    let end = domain.upper.clone().filter(|u| *u < far);
    let is_endless = domain.upper.is_none();
    let last = end.unwrap_or(far);
    if options.upper > zero && last > options.upper {
        let mut above = trace(&options.upper, &last, ParameterScale::Logarithmic)?;
        if is_endless && let Some(piece) = above.pieces.last_mut() {
            ended(piece, zeros, NEAR * options.reach);
        }
        found.pieces.extend(above.pieces);
    }
    Ok(found)
}

/// Adds the zeros themselves, each to the branch that is nearest to it; branches that go elsewhere end in nothing.
fn ended(piece: &mut Vec<LocusSample>, zeros: &UniPoly, near: f64) {
    let Some(last) = piece.last() else { return };
    let nowhere = Complex::new(f64::NAN, f64::NAN);
    let mut ends = vec![nowhere; last.roots.len()];
    for zero in roots(zeros) {
        for _ in 0..zero.multiplicity {
            let free = (0..ends.len()).filter(|&k| ends[k].re.is_nan());
            let distance = |k: &usize| (last.roots[*k] - zero.value).norm();
            let nearest = free.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(k) = nearest.filter(|k| distance(k) <= near) {
                ends[k] = zero.value;
            }
        }
    }
    let parameter = &last.parameter * Rational::from(2);
    piece.push(LocusSample { parameter, roots: ends });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `s^2 (s + 3) + k (s + 1)`: a double pole at 0, and one zero.
    #[test]
    fn branches_begin_in_poles_and_end_in_zeros() {
        let of = |k: &Rational| {
            let c = [k.clone(), k.clone(), Rational::from(3), Rational::from(1)];
            Some(UniPoly::from_rational_poly(&jurist_algebra::poly::Poly::new(c.to_vec())).1)
        };
        let options = LocusOptions {
            lower: Rational::from(1),
            upper: Rational::from(2),
            scale: ParameterScale::Linear,
            focus: Complex::new(0.0, 0.0),
            through: Vec::new(),
            reach: 3.0,
        };
        let trace = |lower: Option<i64>, upper: Option<i64>| {
            let domain = Range { lower: lower.map(Rational::from), upper: upper.map(Rational::from) };
            super::of(of, &UniPoly::from_i64(&[1, 1]), &domain, &options, &Budget::unlimited()).unwrap()
        };
        let whole = trace(None, None);
        assert_eq!(whole.pieces.len(), 2);
        let (first, last) = (&whole.pieces[0][0], whole.pieces[1].last().unwrap());
        assert_eq!(first.roots.iter().filter(|z| z.norm() == 0.0).count(), 2);
        assert_eq!(last.roots.iter().filter(|z| **z == Complex::new(-1.0, 0.0)).count(), 1);
        assert_eq!(last.roots.iter().filter(|z| z.re.is_nan()).count(), 2);
        let within = trace(Some(1), Some(4));
        assert_eq!(within.pieces.len(), 1);
        assert_eq!(within.samples().last().unwrap().parameter, Rational::from(4));
    }
}
