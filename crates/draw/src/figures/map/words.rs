//! Words beside the walls, where nothing else is.

use super::super::INK;
use super::super::clip::Window;
use super::super::engineering::frequency_text;
use super::super::legend::mark;
use super::super::panel::Shape;
use super::draw::{Drawing, inside};
use super::labels::{frequency_unit, spaced, words};
use super::lines::{Role, Wall, mechanism_colour};
use crate::scene::{Anchor, Colour, Point, Stroke, Words, width};

/// Frequencies along a wall are this far apart.
const LABEL_SPACING: f64 = 170.0;
/// Size of the letters.
const SIZE: f64 = 11.0;

impl Drawing<'_> {
    /// A dot and the exact value at a limit on a line through the nominal point and at extreme points.
    pub(super) fn limits_on_lines(&mut self) {
        let contents = self.contents;
        let windows = &contents.trace.windows;
        for ((x, y), text) in &contents.on_lines {
            let at = (windows[0].place(*x), windows[1].place(*y));
            if !inside(at) || self.said.contains(text) {
                continue;
            }
            self.said.push(text.clone());
            let at = self.at(at);
            if !self.place_words(at, text, INK, true) && !self.place_words_far(at, text) {
                self.dot(at, INK);
            }
        }
    }

    /// The frequency at some points of a wall, and the mechanism once.
    pub(super) fn labels(&mut self, k: usize) {
        let contents = self.contents;
        let wall = &contents.walls[k];
        let name = words(contents.answer, contents.map, wall);
        let colour = Colour::css(mechanism_colour(&contents.map.curves[wall.curve].causes).0);
        let known = &contents.frequencies[k];
        let unit = frequency_unit(contents.answer);
        let chosen = spaced(wall, (self.frame.plot.width, self.frame.plot.height), LABEL_SPACING);
        for point in chosen {
            let nearest = known.iter().min_by_key(|f| f.point.abs_diff(point));
            let frequency = nearest.map(|f| frequency_text(f.value, unit));
            let point = nearest.map_or(point, |f| f.point);
            // Once in the picture is enough, and the legend has the name too.
            let unsaid_name = Some(&name).filter(|n| !self.said.contains(n));
            let unsaid_frequency = frequency.filter(|f| !self.said.contains(f));
            let at = self.at(wall.points[point]);
            // Beside an exact limit another frequency says nothing new.
            if self.dots.iter().any(|d| (d.0 - at.0).hypot(d.1 - at.1) < 45.0) {
                continue;
            }
            let tries: Vec<Vec<String>> = match (unsaid_name, unsaid_frequency) {
                (Some(n), Some(f)) => vec![vec![n.clone(), f.clone()], vec![f]],
                (Some(n), None) if known.is_empty() => vec![vec![n.clone()]],
                (_, Some(f)) => vec![vec![f]],
                _ => continue,
            };
            for parts in tries {
                if self.place_words(at, &parts.join(", "), colour, !known.is_empty()) {
                    self.said.extend(parts);
                    break;
                }
            }
        }
    }

    /// Words beside a point of a wall where nothing else is: outside the region first.
    pub(super) fn place_words(&mut self, at: Point, text: &str, colour: Colour, dot: bool) -> bool {
        let half = width(text, SIZE) / 2.0 + 3.0;
        let (beside, over, under) = (half + 8.0, -15.0, 19.0);
        let offsets = [
            (0.0, over),
            (0.0, under),
            (beside, 3.0),
            (-beside, 3.0),
            (half, over),
            (half, under),
            (-half, over),
            (-half, under),
            (beside, over),
            (beside, under),
            (-beside, over),
            (-beside, under),
        ];
        let plot = self.frame.plot;
        for (dx, dy) in offsets {
            let centre = (at.0 + dx, at.1 + dy);
            let room = (centre.0 - half, centre.1 - 12.0, centre.0 + half, centre.1 + 4.0);
            let inside = room.0 > plot.left + 2.0
                && room.2 < plot.right() - 2.0
                && room.1 > plot.top + 2.0
                && room.3 < plot.bottom() - 2.0;
            if inside && self.is_free(room) && !self.is_crossed(room) {
                self.taken.push(room);
                if dot {
                    self.dot(at, colour);
                }
                self.scene.words(Words::new(text, centre, SIZE, INK).anchored(Anchor::Middle));
                return true;
            }
        }
        false
    }

    /// Words farther away, with a thin line to their point.
    pub(super) fn place_words_far(&mut self, at: Point, text: &str) -> bool {
        let half = width(text, SIZE) / 2.0 + 3.0;
        for distance in [36.0, 60.0, 90.0, 130.0] {
            for (side, down) in [(0.0, -1.0), (0.0, 1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let centre = (at.0 + side * half * 1.2, at.1 + down * distance);
                let room = (centre.0 - half, centre.1 - 12.0, centre.0 + half, centre.1 + 4.0);
                let y = if down > 0.0 { room.1 + 1.0 } else { room.3 };
                let end = (at.0.clamp(room.0 + 4.0, room.2 - 4.0), y);
                let window = Window { x: (room.0, room.2), y: (room.1, room.3) };
                let over_words = |t: &(f64, f64, f64, f64)| {
                    let words = Window { x: (t.0, t.2), y: (t.1, t.3) };
                    !words.contains(at) && !words.pieces(&[at, end]).is_empty()
                };
                let plot = Window {
                    x: (self.frame.plot.left + 2.0, self.frame.plot.right() - 2.0),
                    y: (self.frame.plot.top + 2.0, self.frame.plot.bottom() - 2.0),
                };
                let inside = plot.contains((room.0, room.1)) && plot.contains((room.2, room.3));
                if inside
                    && self.is_free(room)
                    && !self.is_crossed(room)
                    && !window.contains(at)
                    && !self.taken.iter().any(over_words)
                {
                    self.taken.push(room);
                    self.leaders.push((at, end));
                    self.scene.line(at, end, Stroke::new(INK, 0.7));
                    self.dot(at, INK);
                    self.scene.words(Words::new(text, centre, SIZE, INK).anchored(Anchor::Middle));
                    return true;
                }
            }
        }
        false
    }

    fn dot(&mut self, at: Point, colour: Colour) {
        self.dots.push(at);
        self.taken.push((at.0 - 3.0, at.1 - 3.0, at.0 + 3.0, at.1 + 3.0));
        mark(&mut self.scene, Shape::Dot, colour, at);
    }

    fn is_free(&self, room: (f64, f64, f64, f64)) -> bool {
        self.taken.iter().all(|t| room.2 < t.0 || room.0 > t.2 || room.3 < t.1 || room.1 > t.3)
    }

    /// Whether a wall, a line through the nominal point or a line to a word runs under a rectangle.
    fn is_crossed(&self, room: (f64, f64, f64, f64)) -> bool {
        let window = Window { x: (room.0, room.2), y: (room.1, room.3) };
        let crossed = |w: &Wall| {
            let points: Vec<Point> = w.points.iter().map(|p| self.at(*p)).collect();
            !window.pieces(&points).is_empty()
        };
        let nominal = self.nominal().map(|at| self.at(at));
        nominal.is_some_and(|at| (at.0 > room.0 && at.0 < room.2) || (at.1 > room.1 && at.1 < room.3))
            || self.leaders.iter().any(|(a, b)| !window.pieces(&[*a, *b]).is_empty())
            || self.contents.walls.iter().filter(|w| w.role != Role::Nothing).any(crossed)
    }
}
