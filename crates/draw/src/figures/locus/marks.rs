//! What is marked on a locus.

use super::super::panel::{Mark, Shape};
use super::{LocusFigure, LocusMark};
use crate::simulate::{RootLocus, roots};
use jurist_algebra::poly::{Poly, UniPoly};
use nalgebra::Complex;

/// The colour of the nominal closed loop.
const NOMINAL: &str = super::super::COLOURS[2];

/// The range of the parameter, for the legend.
pub(super) struct Ends<'a> {
    pub parameter: &'a str,
    pub range: [String; 2],
}

/// Poles and zeros of the open loop where the parameter is a gain, else the ends of the locus; and the nominal loop.
pub(super) fn of(
    gain: Option<&(UniPoly, UniPoly)>,
    nominal: Option<(String, UniPoly)>,
    locus: &RootLocus,
    ends: &Ends<'_>,
) -> Vec<LocusMark> {
    let name = ends.parameter;
    let mut out = match gain {
        Some((poles, zeros)) => vec![
            mark(format!("open-loop poles ({name} = 0)"), Shape::Cross, places(poles)),
            mark(format!("open-loop zeros ({name} = ∞)"), Shape::Circle, places(zeros)),
        ],
        None => {
            let at =
                |sample: Option<&crate::simulate::LocusSample>| sample.map(|s| s.roots.clone()).unwrap_or_default();
            let first = at(locus.pieces.first().and_then(|p| p.first()));
            let last = at(locus.pieces.last().and_then(|p| p.last()));
            vec![
                mark(format!("at {name} = {}", ends.range[0]), Shape::Triangle, first),
                mark(format!("at {name} = {}", ends.range[1]), Shape::Plus, last),
            ]
        }
    };
    // Below the others: zeros and poles may be where the loop is closed.
    out.splice(0..0, nominal.map(|(label, p)| mark(label, Shape::Square, places(&p))));
    out.retain(|m| !m.at.is_empty());
    out
}

fn mark(label: String, shape: Shape, at: Vec<Complex<f64>>) -> LocusMark {
    LocusMark { label, shape, at }
}

pub(super) fn places(p: &UniPoly) -> Vec<Complex<f64>> {
    roots(p).into_iter().map(|r| r.value).collect()
}

/// `A` and `B` of a polynomial `A + K B`; `None` where the parameter enters otherwise, or not at all.
pub(super) fn as_gain(p: &Poly<UniPoly>) -> Option<(UniPoly, UniPoly)> {
    let part = |k: usize| UniPoly::new(p.coeffs().iter().map(|c| c.coeff(k)).collect());
    let is_affine = p.coeffs().iter().all(|c| c.degree().is_none_or(|d| d <= 1));
    let (a, b) = (part(0), part(1));
    (is_affine && a.degree().is_some() && b.degree().is_some()).then_some((a, b))
}

/// The marks of a panel: those of the locus, and the crossings.
pub(super) fn drawn(figure: &LocusFigure<'_>) -> Vec<Mark> {
    let mut out = Vec::new();
    for marks in figure.marks {
        let colour = if marks.shape == Shape::Square { NOMINAL } else { "#222222" };
        for z in &marks.at {
            let label = Some(marks.label.clone());
            out.push(Mark { at: (z.re, z.im), shape: marks.shape, colour: colour.into(), label });
        }
    }
    for z in figure.crossings.iter().flat_map(|c| &c.at) {
        for im in if z.im == 0.0 { vec![0.0] } else { vec![z.im, -z.im] } {
            let label = Some("crossing (certified)".into());
            out.push(Mark { at: (z.re, im), shape: Shape::Diamond, colour: "#222222".into(), label });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_enters_linearly() {
        let c = |v: &[i64]| UniPoly::from_i64(v);
        // z^2 - z + K z + 2 K: poles 0 and 1, zero -2.
        let p = Poly::new(vec![c(&[0, 2]), c(&[-1, 1]), c(&[1])]);
        let (a, b) = as_gain(&p).unwrap();
        assert_eq!((a, b), (c(&[0, -1, 1]), c(&[2, 1])));
        assert!(as_gain(&Poly::new(vec![c(&[0, 0, 1]), c(&[1])])).is_none());
        assert!(as_gain(&Poly::new(vec![c(&[3]), c(&[1])])).is_none());
    }
}
