//! Where words stand so that nothing is drawn through them.

use super::clip::Window;
use crate::scene::{Point, Rectangle, width};

/// Room around words.
const ROOM: f64 = 2.0;

/// Half the size of a mark.
const MARK: f64 = 7.0;

/// Distances from what words are about, and directions in which they are tried.
const DISTANCES: [f64; 5] = [16.0, 26.0, 40.0, 58.0, 80.0];
const DIRECTIONS: usize = 16;

/// What words must not cover: curves, marks, other words; lines across the panel they had rather not.
#[derive(Clone, Debug, Default)]
pub(super) struct Occupied {
    curves: Vec<Vec<Point>>,
    marks: Vec<Point>,
    words: Vec<Rectangle>,
    levels: Vec<f64>,
    verticals: Vec<f64>,
}

impl Occupied {
    pub fn curve(&mut self, points: Vec<Point>) {
        self.curves.push(points);
    }

    pub fn mark(&mut self, at: Point) {
        self.marks.push(at);
    }

    /// A horizontal line.
    pub fn level(&mut self, y: f64) {
        self.levels.push(y);
    }

    pub fn vertical(&mut self, x: f64) {
        self.verticals.push(x);
    }

    /// Where the middle of the line of words is put, `wanted` or nearby, within the plot; no words are put there any more.
    pub fn place(&mut self, text: &str, size: f64, wanted: Point, target: Option<Point>, plot: &Rectangle) -> Point {
        let half = width(text, size) / 2.0;
        let inside = |(x, y): Point| {
            let (low, high) = (plot.left + half + 4.0, plot.right() - half - 4.0);
            let x = if low < high { x.clamp(low, high) } else { f64::midpoint(low, high) };
            (x, y.clamp(plot.top + size + 3.0, plot.bottom() - 5.0))
        };
        let rectangle = |(x, y): Point| Rectangle {
            left: x - half - ROOM,
            top: y - size - ROOM,
            width: 2.0 * (half + ROOM),
            height: size + 3.0 + 2.0 * ROOM,
        };
        let around = target.into_iter().flat_map(|(x, y)| {
            let turn = |k: usize| std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
            // The middle of the words is this far from the target, and half their length aside.
            let at = move |r: f64, k: usize| (x + (r + half) * turn(k).cos(), y + 4.0 - r * turn(k).sin());
            DISTANCES.into_iter().flat_map(move |r| (0..DIRECTIONS).map(move |k| at(r, k)))
        });
        let cost = |at: Point| {
            let far = target.map_or(0.0, |t| (at.0 - t.0).hypot(at.1 - t.1) / 200.0);
            self.covered(&rectangle(at)) + far
        };
        let best = std::iter::once(wanted).chain(around).map(inside).map(|at| (cost(at), at));
        let (_, at) = best.min_by(|a, b| a.0.total_cmp(&b.0)).expect("the wanted place is one");
        self.words.push(rectangle(at));
        at
    }

    /// How much a rectangle covers: a curve counts as much as ten lines across.
    fn covered(&self, r: &Rectangle) -> f64 {
        let window = Window { x: (r.left, r.right()), y: (r.top, r.bottom()) };
        let crossed = |points: &Vec<Point>| points.windows(2).any(|pair| window.cut(pair[0], pair[1]).is_some());
        let curves = self.curves.iter().filter(|points| crossed(points)).count();
        let overlaps =
            |l: f64, t: f64, w: f64, h: f64| l < r.right() && r.left < l + w && t < r.bottom() && r.top < t + h;
        let on_mark = |m: &&Point| overlaps(m.0 - MARK, m.1 - MARK, 2.0 * MARK, 2.0 * MARK);
        let marks = self.marks.iter().filter(on_mark).count();
        let words = self.words.iter().filter(|w| overlaps(w.left, w.top, w.width, w.height)).count();
        let levels = self.levels.iter().filter(|y| (r.top..=r.bottom()).contains(*y)).count();
        let verticals = self.verticals.iter().filter(|x| (r.left..=r.right()).contains(*x)).count();
        10.0 * (curves + marks + words) as f64 + (levels + verticals) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLOT: Rectangle = Rectangle { left: 0.0, top: 0.0, width: 400.0, height: 300.0 };

    /// A steep curve right of the target, and one through the wanted place.
    #[test]
    fn words_go_where_no_curve_mark_or_other_words_are() {
        let mut occupied = Occupied::default();
        let target = (200.0, 150.0);
        occupied.curve(vec![(0.0, 140.0), target, (210.0, 155.0), (211.0, 20.0), (400.0, 60.0)]);
        occupied.mark(target);
        for _ in 0..4 {
            let words = occupied.words.clone();
            let at = occupied.place("PM -137.02°", 11.0, (225.0, 130.0), Some(target), &PLOT);
            let placed = *occupied.words.last().unwrap();
            let before = Occupied { words, ..occupied.clone() };
            assert!(before.covered(&placed) < 1.0, "{at:?}");
            assert!(placed.left >= 0.0 && placed.right() <= 400.0 && placed.top >= 0.0 && placed.bottom() <= 300.0);
        }
    }

    #[test]
    fn words_stay_where_they_are_wanted_if_nothing_is_there() {
        let mut occupied = Occupied::default();
        assert_eq!(occupied.place("a", 11.0, (50.0, 60.0), None, &PLOT), (50.0, 60.0));
        assert_eq!(occupied.place("far out", 11.0, (-50.0, 600.0), None, &PLOT).1, 295.0);
    }
}
