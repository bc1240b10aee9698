//! Which parts of the plane a locus shows.

use super::LocusFigure;
use jurist_engine::model::Time;

/// A square part of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Square {
    pub centre: (f64, f64),
    pub half: f64,
}

impl Square {
    pub fn x(&self) -> (f64, f64) {
        (self.centre.0 - self.half, self.centre.0 + self.half)
    }

    pub fn y(&self) -> (f64, f64) {
        (self.centre.1 - self.half, self.centre.1 + self.half)
    }

    pub fn contains(&self, z: (f64, f64)) -> bool {
        (z.0 - self.centre.0).abs() <= self.half && (z.1 - self.centre.1).abs() <= self.half
    }
}

/// A discrete picture shows no more than this.
const MOST_DISCRETE: f64 = 3.0;
/// A continuous picture shows what is this many times as far as the farthest crossing, or the slowest nominal root.
const MOST_CONTINUOUS: f64 = 8.0;

/// A mark that is nearer to 0 than this share of the farthest one says nothing of the picture's size.
const LEAST_SHARE: f64 = 1e-3;

fn crossings(figure: &LocusFigure<'_>) -> Vec<(f64, f64)> {
    figure.crossings.iter().flat_map(|c| &c.at).map(|z| (z.re, z.im)).collect()
}

fn marks(figure: &LocusFigure<'_>) -> impl Iterator<Item = (f64, f64)> {
    figure.marks.iter().flat_map(|m| &m.at).map(|z| (z.re, z.im))
}

/// How many marks the picture does not show.
pub(super) fn outside(figure: &LocusFigure<'_>, window: &Square) -> usize {
    marks(figure).filter(|z| !window.contains(*z)).count()
}

/// What is outside of the smallest rectangle of poles, zeros and crossings is shown this far, as a share of its size.
const AROUND: f64 = 0.25;
/// Branches are shown as far as this many times the farthest pole, zero or crossing.
const BRANCHES: f64 = 3.3;
/// The same in a discrete picture, where the unit circle tells the size.
const MOST_BRANCHES: f64 = 1.6;

/// The window that a picture begins with. It holds all crossings, and the poles, zeros and branches that are near enough to leave the
/// crossings apart.
pub(super) fn whole(figure: &LocusFigure<'_>) -> Square {
    let is_finite = |z: &(f64, f64)| z.0.is_finite() && z.1.is_finite();
    let branches = || figure.locus.samples().flat_map(|s| s.roots.iter()).map(|z| (z.re, z.im)).filter(is_finite);
    let crossings = crossings(figure);
    if figure.time == Time::Discrete {
        let far = |z: (f64, f64)| z.0.abs().max(z.1.abs());
        let of_branches = branches().map(far).filter(|r| *r <= MOST_BRANCHES).fold(0.0, f64::max);
        let of_marks = marks(figure).filter(is_finite).map(far).filter(|r| *r <= MOST_DISCRETE).fold(0.0, f64::max);
        let farthest = (1.08 * of_branches).max(1.15 * of_marks);
        return Square { centre: (0.0, 0.0), half: farthest.clamp(1.25, MOST_DISCRETE) };
    }
    let size = |z: &(f64, f64)| z.0.hypot(z.1);
    let scale = scale(figure, &crossings);
    let of_marks = marks(figure).filter(|z| is_finite(z) && size(z) <= MOST_CONTINUOUS * scale);
    let features: Vec<(f64, f64)> = of_marks.chain(crossings).chain([(0.0, 0.0)]).collect();
    let reach = features.iter().map(size).fold(0.0, f64::max);
    let reach = if reach > 0.0 { reach } else { scale };
    let shown: Vec<(f64, f64)> = branches().filter(|z| size(z) <= BRANCHES * reach).collect();
    let bounds = |points: &[(f64, f64)]| {
        let all =
            points.iter().fold((0.0f64, 0.0f64, 0.0f64), |(l, r, h), z| (l.min(z.0), r.max(z.0), h.max(z.1.abs())));
        (all, (all.1 - all.0).max(2.0 * all.2).max(1e-9 * reach))
    };
    let ((left, right, height), width) = bounds(&features);
    let room = AROUND * width;
    let ((l, r, h), width) = bounds(&shown);
    let (left, right) = ((left - room).min(l - 0.05 * width), (right + room).max(r + 0.05 * width));
    let height = (height + room).max(h + 0.05 * width);
    Square { centre: (f64::midpoint(left, right), 0.0), half: ((right - left) / 2.0).max(height) }
}

/// The size of a continuous picture: the farthest crossing, or the slowest nominal root.
fn scale(figure: &LocusFigure<'_>, crossings: &[(f64, f64)]) -> f64 {
    let size = |z: &(f64, f64)| z.0.hypot(z.1);
    let farthest_crossing = crossings.iter().map(size).fold(0.0, f64::max);
    // Marks are poles and zeros; where the gain begins at 0, a root of the first sample may be as near to 0 as it is small.
    let farthest_mark = marks(figure).map(|z| size(&z)).filter(|r| r.is_finite()).fold(0.0, f64::max);
    let is_slow = |r: &f64| r.is_finite() && *r > farthest_mark * LEAST_SHARE;
    let of_marks = marks(figure).map(|z| size(&z)).filter(is_slow).min_by(f64::total_cmp);
    let first = figure.locus.samples().next();
    let of_roots = || first.and_then(|s| s.roots.iter().map(|z| z.norm()).filter(|r| *r > 0.0).min_by(f64::total_cmp));
    let slowest = of_marks.or_else(of_roots);
    if farthest_crossing > 0.0 { farthest_crossing } else { slowest.unwrap_or(1.0) }
}

/// Where the crossings lie closest: two of them that the whole picture hardly tells apart, else around one.
pub(super) fn near(figure: &LocusFigure<'_>, whole: &Square) -> Square {
    let upper = crossings(figure);
    let all: Vec<(f64, f64)> = upper.iter().flat_map(|z| [*z, (z.0, -z.1)]).collect();
    let mut best: Option<(f64, Square)> = None;
    for z in &upper {
        for w in &all {
            let gap = (z.0 - w.0).hypot(z.1 - w.1);
            if gap > 1e-9 * whole.half && best.is_none_or(|b| gap < b.0) {
                let centre = (f64::midpoint(z.0, w.0), f64::midpoint(z.1, w.1));
                best = Some((gap, Square { centre, half: gap }));
            }
        }
    }
    let smallest = whole.half / 1e7;
    match best {
        Some((gap, square)) if gap < whole.half / 3.0 => Square { half: square.half.max(smallest), ..square },
        _ => {
            let fallback = if figure.time == Time::Discrete { (1.0, 0.0) } else { (0.0, 0.0) };
            // A pair that crosses says more than a root at the origin of a loop that is open.
            let pair = upper.iter().find(|z| z.1 > 0.0).or(upper.first());
            let centre = pair.copied().unwrap_or(fallback);
            Square { centre, half: whole.half / 4.0 }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::LocusMark;
    use super::*;
    use crate::figures::Shape;
    use crate::simulate::{Crossing, RootLocus};
    use nalgebra::Complex;

    fn windows(time: Time, crossings: &[(f64, f64)], marks: &[(f64, f64)]) -> (Square, Square, usize) {
        let complex = |z: &(f64, f64)| Complex::new(z.0, z.1);
        let crossing = |z: &(f64, f64)| Crossing { parameter: 1.0, at: vec![complex(z)], label: "K = 1".into() };
        let crossings: Vec<Crossing> = crossings.iter().map(crossing).collect();
        let at = marks.iter().map(complex).collect();
        let marks = [LocusMark { label: "poles".into(), shape: Shape::Cross, at }];
        let locus = RootLocus::default();
        let (locus, beyond) = (&locus, &RootLocus::default());
        let figure = LocusFigure { time, locus, beyond, stable: &[], crossings: &crossings, marks: &marks };
        let whole = whole(&figure);
        let near = near(&figure, &whole);
        assert!(crossings.iter().all(|c| whole.contains((c.at[0].re, c.at[0].im))));
        (whole, near, outside(&figure, &whole))
    }

    #[test]
    fn the_closest_crossings_are_magnified() {
        let (_, near, _) = windows(Time::Discrete, &[(0.5, 0.75f64.sqrt()), (1.0, 3e-4)], &[(0.9, 0.0)]);
        assert_eq!(near.centre, (1.0, 0.0));
        assert!((near.half - 6e-4).abs() < 1e-9);
    }

    #[test]
    fn a_lone_crossing_is_in_the_middle_of_the_magnified_part() {
        let (whole, near, _) = windows(Time::Discrete, &[(0.0, 1.0)], &[]);
        assert_eq!((near.centre, near.half), ((0.0, 1.0), whole.half / 4.0));
    }

    #[test]
    fn a_crossing_at_the_origin_does_not_shrink_the_picture() {
        let (whole, _, outside) = windows(Time::Continuous, &[(0.0, 0.0)], &[(-0.5, 0.87), (-0.5, -0.87), (0.0, 0.0)]);
        assert!(whole.half > 0.8 && outside == 0, "{whole:?}");
    }

    /// The root of `s + 10^500 K` is beyond the largest double.
    #[test]
    fn a_mark_beyond_all_doubles_says_nothing_of_the_size() {
        let (whole, near, outside) = windows(Time::Continuous, &[(0.0, 0.0)], &[(f64::NEG_INFINITY, 0.0), (0.0, 0.0)]);
        assert!(whole.half.is_finite() && near.half.is_finite() && outside == 1, "{whole:?}");
    }

    #[test]
    fn a_far_pole_does_not_squeeze_the_picture() {
        let (whole, _, outside) = windows(Time::Continuous, &[(0.0, 10.0)], &[(-1.0, 0.0), (-5000.0, 0.0)]);
        assert!(whole.half < 100.0 && outside == 1, "{whole:?}");
        assert!(whole.contains((-1.0, 0.0)) && whole.contains((0.0, -10.0)));
    }
}
