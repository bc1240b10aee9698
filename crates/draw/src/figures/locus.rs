//! The root locus: the whole of it, and magnified where the action is.

use super::panel::{Corner, Curve, Mark, Panel, Shape, Text, side_by_side};
use super::{COLOURS, Figure};
use crate::simulate::{Crossing, LocusOptions, ParameterScale, RootLocus, trace_root_locus};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::Answer;
use jurist_engine::error::Failure;
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;
use jurist_engine::show::layout::visible;
use jurist_engine::stability::{Cause, End, StableSet};
use nalgebra::Complex;

/// What a locus figure shows.
#[derive(Clone, Debug)]
pub struct LocusFigure<'a> {
    /// Discrete or continuous time.
    pub time: Time,
    /// Heading.
    pub title: &'a str,
    /// The parameter's name.
    pub parameter: &'a str,
    /// The roots.
    pub locus: &'a RootLocus,
    /// Parameter ranges that are certified stable (ends rounded), lower and upper.
    pub stable: &'a [(f64, f64)],
    /// Certified points of the boundary.
    pub crossings: &'a [Crossing],
    /// Half the width of the magnified panel; `None` for what shows the crossings near the focus.
    pub magnified: Option<f64>,
}

/// A locus with its picture.
#[derive(Debug)]
pub struct DrawnLocus {
    /// The roots.
    pub locus: RootLocus,
    /// The certified crossings that lie in the range.
    pub crossings: Vec<Crossing>,
    /// The whole picture and the magnified one, side by side.
    pub figure: Figure,
    /// The two pictures, each alone, for a page that may be narrow.
    pub parts: [Figure; 2],
}

/// Bits to which the ends of the stable set are known for a picture.
const PICTURE_BITS: u64 = 60;

/// The locus of the parameter of a decided question over a range, with all certified ends in it.
///
/// # Errors
/// [`Failure::Stopped`] when the budget runs out.
pub fn locus_of(
    answer: &Answer<StableSet>,
    range: &(Rational, Rational),
    scale: Option<ParameterScale>,
    budget: &Budget,
) -> Result<DrawnLocus, Failure> {
    let problem = answer.problem();
    let discrete = problem.time() == Time::Discrete;
    let focus = Complex::new(if discrete { 1.0 } else { 0.0 }, 0.0);
    let (mut through, mut crossings, mut stable) = (Vec::new(), Vec::new(), Vec::new());
    {
        for interval in answer.value().intervals() {
            let mut ends = [range.0.to_f64_approximate(), range.1.to_f64_approximate()];
            for (end, slot) in [(&interval.lower, 0), (&interval.upper, 1)] {
                let Some(end) = end else { continue };
                let (lo, hi) = end.value.refined_to_digits(15).enclosure();
                let value = lo.midpoint(&hi);
                ends[slot] = value.to_f64_approximate();
                if value < range.0 || value > range.1 {
                    continue;
                }
                crossings.extend(crossing(end, &value, problem));
                through.push(value);
            }
            stable.push((ends[0], ends[1]));
        }
    }
    let wide = {
        let (a, b) = (range.0.to_f64_approximate(), range.1.to_f64_approximate());
        a > 0.0 && b / a > 100.0
    };
    let scale = scale.unwrap_or(if wide { ParameterScale::Logarithmic } else { ParameterScale::Linear });
    let polynomial = problem.parametric(budget)?;
    let of = |value: &Rational| {
        let p = polynomial?;
        (!p.is_undefined_at(value)).then(|| p.specialised(value))
    };
    // How far a continuous locus reaches is seen at its ends.
    let mut reach = 2.0f64;
    if !discrete {
        let ends = [&range.0, &range.1].into_iter().chain(&through).filter_map(of);
        let far = ends.flat_map(|p| crate::simulate::roots(&p)).map(|r| r.value.norm()).fold(0.0, f64::max);
        reach = if far > 0.0 { far } else { 1.0 };
    }
    let options = LocusOptions { lower: range.0.clone(), upper: range.1.clone(), scale, focus, through, reach };
    let locus = trace_root_locus(of, &options, budget)?;
    let unit = problem.parameter().unit.as_deref().map(|u| format!(" {}", visible(u))).unwrap_or_default();
    let title = format!(
        "{} from {}{unit} (×) to {}{unit} (○)",
        problem.parameter().name,
        to_decimal(&range.0, 4),
        to_decimal(&range.1, 4)
    );
    let panels = locus_panels(&LocusFigure {
        time: problem.time(),
        title: &title,
        parameter: &problem.parameter().name,
        locus: &locus,
        stable: &stable,
        crossings: &crossings,
        magnified: None,
    });
    let figure = side_by_side(&panels, SIDE, SIDE);
    let parts = panels.map(|p| p.figure(SIDE, SIDE));
    Ok(DrawnLocus { locus, crossings, figure, parts })
}

/// Where on the boundary the roots are at an end, and its label; nothing for ends without a root
/// there (degree lost, undefined, end of the domain).
fn crossing(end: &End, value: &Rational, problem: &Problem) -> Option<Crossing> {
    let rate = problem.frequency(end, PICTURE_BITS);
    let mut at = Vec::new();
    let approximate = |e: &jurist_algebra::number::Enclosure| e.lower().midpoint(e.upper()).to_f64_approximate();
    if let Some(rate) = &rate {
        if let Some(angle) = &rate.angle {
            at.push(Complex::from_polar(1.0, approximate(angle)));
        } else if let Some(w) = &rate.radians_per_second {
            at.push(Complex::new(0.0, approximate(w)));
        }
    }
    for (cause, z) in [(Cause::RootAtOne, 1.0), (Cause::RootAtMinusOne, -1.0), (Cause::RootAtZero, 0.0)] {
        if end.causes.contains(cause) {
            at.push(Complex::new(z, 0.0));
        }
    }
    let hertz = rate.and_then(|r| r.hertz).map(|h| {
        let f = h.lower().midpoint(h.upper());
        let digits = if f < Rational::from(1000) { 3 } else { 4 };
        format!(" ({} Hz)", to_decimal(&f, digits))
    });
    let digits = if value.abs() < Rational::from(1) { 3 } else { 5 };
    let label = format!("{} = {}{}", problem.parameter().name, to_decimal(value, digits), hertz.unwrap_or_default());
    (!at.is_empty()).then(|| Crossing { parameter: value.to_f64_approximate(), at, label })
}

/// Colour where the answer says stable, and where it does not.
const STABLE: &str = COLOURS[0];
const OTHER: &str = COLOURS[1];

/// Width and height of a panel.
const SIDE: f64 = 520.0;

/// The locus in two panels of equal axes, first the whole, then magnified at z = 1 (or s = 0).
///
/// The colour follows the certified intervals, not the drawn roots; crossings are drawn where the
/// certified answer has them, on the circle or the axis. Each is labelled in at least one panel.
pub fn locus_panels(figure: &LocusFigure<'_>) -> [Panel; 2] {
    let discrete = figure.time == Time::Discrete;
    let focus = if discrete { (1.0, 0.0) } else { (0.0, 0.0) };
    let farthest = figure
        .locus
        .samples()
        .flat_map(|s| s.roots.iter())
        .map(|z| if discrete { z.re.abs().max(z.im.abs()) } else { z.norm() })
        .filter(|v| v.is_finite())
        .fold(0.0, f64::max);
    let reach = if discrete { (farthest * 1.08).clamp(1.25, 3.0) } else { (farthest * 1.08).max(1e-9) };
    let half = figure.magnified.unwrap_or_else(|| magnification(figure, focus, reach));
    let name = if discrete { "z = 1" } else { "s = 0" };
    let mut whole = frame(figure, (0.0, 0.0), reach, figure.title.to_string());
    let mut near = frame(figure, focus, half, format!("near {name}, {:.0} times larger", reach / half));
    let distance = |z: &Complex<f64>| (z.re - focus.0).abs().max((z.im - focus.1).abs());
    // In the whole picture a crossing at the focus is a dot among dots: its label is in the other.
    let in_both = |z: &Complex<f64>| distance(z) > reach / 50.0;
    whole.texts = labels(figure, &whole, |z| in_both(z) || distance(z) >= half);
    near.texts = labels(figure, &near, |z| distance(z) < half);
    let right = (focus.0 + 0.55 * (reach - focus.0), -0.2 * reach);
    whole.texts.push(Text { text: "magnified".into(), at: right, target: Some(focus) });
    near.legend = Some(Corner::BottomRight);
    [whole, near]
}

/// The labels of the crossings that are wanted in a panel, none over another.
fn labels(figure: &LocusFigure<'_>, panel: &Panel, wanted: impl Fn(&Complex<f64>) -> bool) -> Vec<Text> {
    let centre = (f64::midpoint(panel.x.0, panel.x.1), f64::midpoint(panel.y.0, panel.y.1));
    let half = (panel.x.1 - panel.x.0) / 2.0;
    let mut texts: Vec<Text> = Vec::new();
    for crossing in figure.crossings {
        for z in crossing.at.iter().filter(|z| wanted(z)) {
            // Beside the point, on the side where there is room; above the middle, where no legend is.
            let side = if z.re > centre.0 { -0.5 } else { 0.52 };
            let mut at = (centre.0 + side * half, (z.im + 0.2 * half).min(centre.1 + 0.9 * half));
            while texts.iter().any(|t| (t.at.0 - at.0).abs() < half && (t.at.1 - at.1).abs() < 0.07 * half) {
                at.1 -= 0.08 * half;
            }
            texts.push(Text { text: crossing.label.clone(), at, target: Some((z.re, z.im)) });
        }
    }
    texts
}

/// Half the width of the inset: it shows the crossing nearest the focus, the focus, and what
/// surrounds them.
fn magnification(figure: &LocusFigure<'_>, focus: (f64, f64), reach: f64) -> f64 {
    let distance = |z: &nalgebra::Complex<f64>| (z.re - focus.0).hypot(z.im - focus.1);
    let nearest = figure
        .crossings
        .iter()
        .flat_map(|c| c.at.iter())
        .map(distance)
        .filter(|d| *d > 1e-12)
        .fold(f64::INFINITY, f64::min);
    let half = if nearest.is_finite() { 3.0 * nearest } else { reach / 20.0 };
    half.clamp(reach / 1e7, reach / 8.0)
}

fn frame(figure: &LocusFigure<'_>, centre: (f64, f64), half: f64, title: String) -> Panel {
    let discrete = figure.time == Time::Discrete;
    let mut panel = Panel {
        title,
        x_label: if discrete { "Re z" } else { "Re s / (1/s)" }.into(),
        y_label: if discrete { "Im z" } else { "Im s / (rad/s)" }.into(),
        x: (centre.0 - half, centre.0 + half),
        y: (centre.1 - half, centre.1 + half),
        equal: true,
        ..Panel::default()
    };
    let boundary = if discrete {
        // Fine enough to be round also where the panel shows a millionth of it.
        let fine = |k: i32| f64::from(k) / 2000.0 * half.min(3.0);
        let mut angles: Vec<f64> = (-360..=360).map(|k| f64::from(k).to_radians() / 2.0).collect();
        angles.extend((-2000..=2000).map(fine));
        angles.sort_by(f64::total_cmp);
        angles.into_iter().map(|a| (a.cos(), a.sin())).collect()
    } else {
        vec![(0.0, -1e12_f64.max(half * 2.0)), (0.0, 1e12_f64.max(half * 2.0))]
    };
    panel.curves.push(Curve {
        points: boundary,
        label: Some(if discrete { "unit circle" } else { "imaginary axis" }.into()),
        colour: "#777777".into(),
        width: 1.0,
        dashed: false,
    });
    let is_stable = |value: f64| figure.stable.iter().any(|(a, b)| value >= *a && value <= *b);
    for branch in figure.locus.branches() {
        for (inside, points) in runs(&branch.points, is_stable) {
            let (colour, word) = if inside { (STABLE, "stable (certified)") } else { (OTHER, "not stable") };
            panel.curves.push(Curve {
                points,
                label: Some(word.into()),
                colour: colour.into(),
                width: 1.8,
                dashed: false,
            });
        }
    }
    for piece in &figure.locus.pieces {
        for (sample, shape) in [(piece.first(), Shape::Cross), (piece.last(), Shape::Circle)] {
            for z in sample.iter().flat_map(|s| &s.roots) {
                panel.marks.push(Mark { at: (z.re, z.im), shape, colour: "#222222".into(), label: None });
            }
        }
    }
    for crossing in figure.crossings {
        for z in &crossing.at {
            for im in if z.im == 0.0 { vec![0.0] } else { vec![z.im, -z.im] } {
                let at = (z.re, im);
                panel.marks.push(Mark { at, shape: Shape::Diamond, colour: "#000000".into(), label: None });
            }
        }
    }
    panel
}

/// The branch cut where it passes from certified stable to not, each part with its first point
/// shared so that no gap is seen.
fn runs(points: &[(f64, nalgebra::Complex<f64>)], is_stable: impl Fn(f64) -> bool) -> Vec<(bool, Vec<(f64, f64)>)> {
    let mut out: Vec<(bool, Vec<(f64, f64)>)> = Vec::new();
    for pair in points.windows(2) {
        let inside = is_stable(f64::midpoint(pair[0].0, pair[1].0));
        let (a, b) = ((pair[0].1.re, pair[0].1.im), (pair[1].1.re, pair[1].1.im));
        match out.last_mut().filter(|last| last.0 == inside) {
            Some(last) => last.1.push(b),
            None => out.push((inside, vec![a, b])),
        }
    }
    out
}
