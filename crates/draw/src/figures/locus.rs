//! The root locus: the whole of it, and magnified where roots cross the boundary.

mod beyond;
mod marks;
mod range;
mod windows;

use super::engineering::quantity;
use super::facts::heading;
use super::panel::{Corner, Curve, Panel, Text, side_by_side};
use super::{COLOURS, Figure};
use crate::simulate::{Crossing, LocusOptions, ParameterScale, RootLocus, trace_root_locus};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_algebra::poly::{Poly, UniPoly};
use jurist_engine::answer::Answer;
use jurist_engine::error::Error;
use jurist_engine::model::Time;
use jurist_engine::problem::{Problem, RoundedLoop};
use jurist_engine::stability::{Cause, End, ParametricPolynomial, Rounding, StableSet, SymbolicPolynomial};
use jurist_show::layout::{short, visible};
pub use range::locus_range;

use marks::Ends;
use nalgebra::Complex;
use std::borrow::Cow;
use windows::Square;

/// What a locus figure shows.
#[derive(Clone, Debug)]
pub struct LocusFigure<'a> {
    /// Discrete or continuous time.
    pub time: Time,
    /// The roots.
    pub locus: &'a RootLocus,
    /// The same outside of the range, drawn thin.
    pub beyond: &'a RootLocus,
    /// Parameter ranges that are certified stable (ends rounded), lower and upper.
    pub stable: &'a [(f64, f64)],
    /// Certified points of the boundary.
    pub crossings: &'a [Crossing],
    /// Marks: poles and zeros of the open loop, the nominal closed loop, or where the locus begins and ends.
    pub marks: &'a [LocusMark],
}

/// Roots that are marked on a locus.
#[derive(Clone, Debug)]
pub struct LocusMark {
    /// What they are, for the legend.
    pub label: String,
    /// What the marks look like.
    pub shape: super::Shape,
    /// Where they are.
    pub at: Vec<Complex<f64>>,
}

/// A locus with its picture.
#[derive(Debug)]
pub struct DrawnLocus {
    /// The roots.
    pub locus: RootLocus,
    /// The same of a gain outside of the range.
    pub beyond: RootLocus,
    /// The poles and the zeros of the open loop, each once, where the parameter is a gain.
    pub open_loop: Option<[Vec<Complex<f64>>; 2]>,
    /// The certified crossings that lie in the range.
    pub crossings: Vec<Crossing>,
    /// The whole picture and the magnified one, if anything crosses, side by side.
    pub figure: Figure,
    /// The same pictures, each alone, for a page that may be narrow.
    pub parts: Vec<Figure>,
}

/// The characteristic polynomial, exact or with constants rounded far beyond what is seen.
enum Polynomial<'p> {
    Exact(Option<&'p ParametricPolynomial>),
    Rounded(Option<Rounding>),
    /// Of many modes behind holds: a polynomial at each value.
    AtValues(RoundedLoop),
}

impl Polynomial<'_> {
    fn of<'p>(problem: &'p Problem, budget: &Budget) -> Result<Polynomial<'p>, Error> {
        if let Some(rounded) = problem.rounded_loop(budget)? {
            return Ok(Polynomial::AtValues(rounded));
        }
        if problem.algebra_over_symbols(budget)?.symbols().is_empty() {
            return Ok(Polynomial::Exact(problem.parametric(budget)?));
        }
        Ok(Polynomial::Rounded(problem.symbolic(budget)?.map(SymbolicPolynomial::rounding)))
    }

    /// At a value of the parameter; `None` where it is undefined.
    fn at(&self, value: &Rational) -> Option<UniPoly> {
        match self {
            Polynomial::Exact(p) => p.filter(|p| !p.is_undefined_at(value)).map(|p| p.specialised(value)),
            Polynomial::Rounded(p) => p.as_ref()?.at(value),
            Polynomial::AtValues(p) => p.at(value),
        }
    }

    /// With the parameter; `None` where that is inside of functions.
    fn whole(&self) -> Option<Cow<'_, Poly<UniPoly>>> {
        match self {
            Polynomial::Exact(p) => p.map(|p| Cow::Borrowed(p.polynomial())),
            Polynomial::Rounded(p) => p.as_ref()?.whole().map(Cow::Owned),
            Polynomial::AtValues(_) => None,
        }
    }
}

/// Bits to which the ends of the stable set are known for a picture.
const PICTURE_BITS: u64 = 60;

/// What a picture has of the answer.
struct Certified {
    /// Ranges that are stable, rounded.
    stable: Vec<(f64, f64)>,
    /// Points of the boundary with an end in the range, and the ends.
    crossings: Vec<Crossing>,
    through: Vec<Rational>,
}

impl Certified {
    fn of(answer: &Answer<StableSet>, range: &(Rational, Rational)) -> Certified {
        let problem = answer.problem();
        let (mut through, mut crossings, mut stable) = (Vec::new(), Vec::new(), Vec::new());
        for interval in answer.value().intervals() {
            let mut ends = [f64::NEG_INFINITY, f64::INFINITY];
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
        Certified { stable, crossings, through }
    }
}

/// The locus of the parameter of a decided question over a range, with all certified ends in it.
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out.
pub fn locus_of(
    answer: &Answer<StableSet>,
    range: &(Rational, Rational),
    scale: Option<ParameterScale>,
    budget: &Budget,
) -> Result<DrawnLocus, Error> {
    let problem = answer.problem();
    problem.refuse_complex(budget)?;
    let discrete = problem.time() == Time::Discrete;
    let focus = Complex::new(if discrete { 1.0 } else { 0.0 }, 0.0);
    let Certified { stable, crossings, mut through } = Certified::of(answer, range);
    let wide = {
        let (a, b) = (range.0.to_f64_approximate(), range.1.to_f64_approximate());
        a > 0.0 && b / a > 100.0
    };
    let scale = scale.unwrap_or(if wide { ParameterScale::Logarithmic } else { ParameterScale::Linear });
    let polynomial = Polynomial::of(problem, budget)?;
    let of = |value: &Rational| polynomial.at(value);
    // How far a continuous locus reaches is seen at its ends.
    let mut reach = 2.0f64;
    if !discrete {
        let ends = [&range.0, &range.1].into_iter().chain(&through).filter_map(of);
        let far = ends.flat_map(|p| crate::simulate::roots(&p)).map(|r| r.value.norm()).fold(0.0, f64::max);
        reach = if far > 0.0 { far } else { 1.0 };
    }
    through.extend(problem.parameter().nominal.clone());
    let options = LocusOptions { lower: range.0.clone(), upper: range.1.clone(), scale, focus, through, reach };
    let locus = trace_root_locus(of, &options, budget)?;
    let whole = polynomial.whole();
    let gain = whole.as_deref().and_then(marks::as_gain);
    let beyond = match &gain {
        Some((_, zeros)) => beyond::of(of, zeros, &problem.parameter().domain, &options, budget)?,
        None => RootLocus::default(),
    };
    let shown = |value: &Rational| quantity(&to_decimal(value, 4), &unit_of(problem));
    let nominal = problem.parameter().nominal.as_ref().and_then(|value| Some((value, of(value)?)));
    let name = &problem.parameter().name;
    let nominal = nominal
        .map(|(value, p)| (format!("closed loop at {name} = {}", quantity(&short(value), &unit_of(problem))), p));
    let ends = Ends { parameter: name, range: [shown(&range.0), shown(&range.1)] };
    let marks = marks::of(gain.as_ref(), nominal, &locus, &ends);
    let mut heading = heading(&format!("Root locus in {name}"), problem);
    let thin = if beyond.pieces.is_empty() { "" } else { "; thin lines are beyond" };
    heading.notes.insert(0, format!("{name} from {} to {}{thin}", shown(&range.0), shown(&range.1)));
    let figure = LocusFigure {
        time: problem.time(),
        locus: &locus,
        beyond: &beyond,
        stable: &stable,
        crossings: &crossings,
        marks: &marks,
    };
    let panels = locus_panels(&figure);
    let figure = side_by_side(&panels, SIDE, HEIGHT).headed(&heading);
    let parts = panels.iter().map(|p| p.figure(SIDE, HEIGHT).headed(&heading)).collect();
    let open_loop = gain.as_ref().map(|(poles, zeros)| [marks::places(poles), marks::places(zeros)]);
    Ok(DrawnLocus { locus, beyond, open_loop, crossings, figure, parts })
}

/// The unit of the parameter, empty if it has none.
fn unit_of(problem: &Problem) -> String {
    visible(problem.parameter().unit.as_deref().unwrap_or_default()).into_owned()
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
    let hertz = rate.and_then(|r| r.hertz).map(|h| approximate(&h));
    let hertz = hertz.map(|f| format!(", {}", super::engineering::frequency_text(f, "Hz"))).unwrap_or_default();
    let free = problem.parameter();
    let unit = visible(free.unit.as_deref().unwrap_or_default());
    let label = format!("{} = {}{hertz}", free.name, quantity(&to_decimal(value, 5), &unit));
    (!at.is_empty()).then(|| Crossing { parameter: value.to_f64_approximate(), at, label })
}

/// Colour where the answer says stable, and where it does not.
const STABLE: &str = COLOURS[0];
const OTHER: &str = COLOURS[1];

/// Width of what lies outside of the range.
const THIN: f64 = 0.9;

/// Width and height of a panel.
const SIDE: f64 = 520.0;
const HEIGHT: f64 = 580.0;

/// The locus in panels of equal axes, first the whole, then magnified where roots cross the boundary, if they do.
///
/// The colour follows the certified intervals, not the drawn roots; crossings are drawn where the
/// certified answer has them, on the circle or the axis. Each is labelled in one panel.
pub fn locus_panels(figure: &LocusFigure<'_>) -> Vec<Panel> {
    let whole_window = windows::whole(figure);
    let outside = windows::outside(figure, &whole_window);
    let mut whole = frame(figure, &whole_window, "whole locus".to_owned());
    whole.legend = Some(Corner::Above);
    if outside > 0 {
        let lie = if outside == 1 { "mark lies" } else { "marks lie" };
        whole.notes.push(format!("{outside} {lie} outside the picture"));
    }
    if figure.crossings.is_empty() {
        whole.title = String::new();
        return vec![whole];
    }
    let near_window = windows::near(figure, &whole_window);
    let times = whole_window.half / near_window.half;
    let times = if times < 9.5 { format!("{times:.1}") } else { format!("{times:.0}") };
    let mut near = frame(figure, &near_window, format!("{times} times larger"));
    whole.texts = labels(figure, &whole_window, |z| !near_window.contains(z));
    near.texts = labels(figure, &near_window, |z| near_window.contains(z));
    if whole_window.half > 1.5 * near_window.half {
        outlined(&mut whole, &whole_window, &near_window);
    }
    near.legend = Some(Corner::Above);
    vec![whole, near]
}

/// What the other panel shows, as a rectangle with its name.
fn outlined(whole: &mut Panel, window: &Square, near: &Square) {
    let (x, y) = (near.x(), near.y());
    whole.curves.push(Curve {
        points: vec![(x.0, y.0), (x.1, y.0), (x.1, y.1), (x.0, y.1), (x.0, y.0)],
        colour: "#555555".into(),
        width: 0.9,
        ..Curve::default()
    });
    // Towards the middle of the picture, where there is room.
    let (right, up) = (near.centre.0 > window.centre.0, near.centre.1 > window.centre.1);
    let side = if right { -0.4 } else { 0.4 };
    let down = if up { -0.12 } else { 0.16 };
    let edge = if up { y.0 } else { y.1 };
    whole.texts.push(Text {
        text: "magnified".into(),
        at: (near.centre.0 + side * window.half, edge + down * window.half),
        target: Some((near.centre.0, edge)),
    });
}

/// The labels of the crossings that are wanted in a panel, none over another.
fn labels(figure: &LocusFigure<'_>, window: &Square, wanted: impl Fn((f64, f64)) -> bool) -> Vec<Text> {
    let half = window.half;
    let mut texts: Vec<Text> = Vec::new();
    for crossing in figure.crossings {
        // Of a pair the upper one.
        for z in crossing.at.iter().map(|z| (z.re, z.im)).filter(|z| wanted(*z) && window.contains(*z)) {
            if texts.iter().any(|t| t.text == crossing.label) {
                continue;
            }
            // Beside the point, on the side where there is room.
            let side = if z.0 > window.centre.0 { -0.5 } else { 0.5 };
            let mut at = (window.centre.0 + side * half, (z.1 + 0.2 * half).min(window.centre.1 + 0.9 * half));
            while texts.iter().any(|t| (t.at.0 - at.0).abs() < half && (t.at.1 - at.1).abs() < 0.07 * half) {
                at.1 -= 0.08 * half;
            }
            texts.push(Text { text: crossing.label.clone(), at, target: Some(z) });
        }
    }
    texts
}

fn frame(figure: &LocusFigure<'_>, window: &Square, title: String) -> Panel {
    let discrete = figure.time == Time::Discrete;
    let mut panel = Panel {
        title,
        x_label: if discrete { "Re z" } else { "Re s (rad/s)" }.into(),
        y_label: if discrete { "Im z" } else { "Im s (rad/s)" }.into(),
        x: window.x(),
        y: window.y(),
        equal: true,
        ..Panel::default()
    };
    panel.curves.push(boundary(discrete, window));
    let is_stable = |value: f64| figure.stable.iter().any(|(a, b)| value >= *a && value <= *b);
    for (locus, width) in [(figure.beyond, THIN), (figure.locus, 1.8)] {
        for branch in locus.branches() {
            for (inside, points) in runs(&branch.points, is_stable) {
                let (colour, word) = if inside { (STABLE, "stable (certified)") } else { (OTHER, "not stable") };
                let label = (width > THIN).then(|| word.to_owned());
                panel.curves.push(Curve { points, label, colour: colour.into(), width, ..Curve::default() });
            }
        }
    }
    panel.marks = marks::drawn(figure);
    panel
}

/// The unit circle or the imaginary axis.
fn boundary(discrete: bool, window: &Square) -> Curve {
    let points = if discrete {
        // Fine enough to be round also where the panel shows a millionth of it.
        let towards = window.centre.1.atan2(window.centre.0);
        let fine = |k: i32| towards + f64::from(k) / 2000.0 * window.half.min(3.0);
        let mut angles: Vec<f64> = (-360..=360).map(|k| f64::from(k).to_radians() / 2.0).collect();
        angles.extend((-2000..=2000).map(fine));
        angles.sort_by(f64::total_cmp);
        angles.into_iter().map(|a| (a.cos(), a.sin())).collect()
    } else {
        vec![(0.0, window.y().0), (0.0, window.y().1)]
    };
    Curve {
        points,
        label: Some(if discrete { "unit circle" } else { "imaginary axis" }.into()),
        colour: "#777777".into(),
        width: 1.0,
        ..Curve::default()
    }
}

/// The branch cut where it passes from certified stable to not, each part with its first point
/// shared so that no gap is seen.
fn runs(points: &[(f64, Complex<f64>)], is_stable: impl Fn(f64) -> bool) -> Vec<(bool, Vec<(f64, f64)>)> {
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
