//! Words beside the walls, where nothing else is.

use super::super::clip::Window;
use super::draw::{CHARACTER, Drawing, INK};
use super::labels::{frequency_text, frequency_unit, spaced, words};
use super::lines::{Role, Wall, mechanism_colour};
use kuva::render::render::TextAnchor;

/// Frequencies along a wall are this far apart.
const LABEL_SPACING: f64 = 170.0;
/// What a wall under words weighs; less is bearable.
const WORST: usize = 4;

impl Drawing<'_> {
    /// A dot and the exact value at a limit on a line through the nominal point and at extreme points.
    pub(super) fn limits_on_lines(&mut self) {
        let contents = self.contents;
        let windows = &contents.trace.windows;
        let mut done: Vec<((f64, f64), &str)> = Vec::new();
        for ((x, y), text) in &contents.on_lines {
            let at = (windows[0].place(*x), windows[1].place(*y));
            let shown = (0.0..=1.0).contains(&at.0) && (0.0..=1.0).contains(&at.1);
            let again = |d: &((f64, f64), &str)| d.1 == text && (d.0.0 - at.0).abs().max((d.0.1 - at.1).abs()) < 0.01;
            if shown && !done.iter().any(again) {
                done.push((at, text));
                let at = self.at(at);
                if !self.place_words(at, text, INK, true) && !self.place_words_far(at, text) {
                    self.dot(at, INK);
                }
            }
        }
    }

    /// The frequency at some points of a wall, and the mechanism once.
    pub(super) fn labels(&mut self, k: usize) {
        let contents = self.contents;
        let wall = &contents.walls[k];
        let name = words(contents.answer, contents.map, wall);
        let (colour, _) = mechanism_colour(&contents.map.curves[wall.curve].causes);
        // Once in the picture is enough, and the legend has it too.
        let mut named = self.named.contains(&name);
        let known = &contents.frequencies[k];
        let unit = frequency_unit(contents.answer);
        let chosen = spaced(wall, (self.width, self.height), LABEL_SPACING);
        for point in chosen {
            let nearest = known.iter().min_by_key(|f| f.point.abs_diff(point));
            let (point, text) = match nearest {
                Some(f) if named => (f.point, frequency_text(f.value, unit)),
                Some(f) => (f.point, format!("{name}, {}", frequency_text(f.value, unit))),
                None if named => continue,
                None => (point, name.clone()),
            };
            let at = self.at(wall.points[point]);
            // Beside an exact limit another frequency says nothing new.
            if self.dots.iter().any(|d| (d.0 - at.0).hypot(d.1 - at.1) < 45.0) {
                continue;
            }
            if self.place_words(at, &text, colour, !known.is_empty()) {
                if !named {
                    self.named.push(name.clone());
                }
                named = true;
            } else if let Some(f) = nearest {
                // Without the name there may be room.
                self.place_words(at, &frequency_text(f.value, unit), colour, true);
            }
        }
    }

    /// Words beside a point of a wall where nothing else is: outside the region first.
    pub(super) fn place_words(&mut self, at: (f64, f64), text: &str, colour: &str, dot: bool) -> bool {
        let half = text.chars().count() as f64 * CHARACTER / 2.0 + 3.0;
        let mut best: Option<(usize, (f64, f64))> = None;
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
        ];
        for (dx, dy) in offsets {
            let centre = (at.0 + dx, at.1 + dy);
            let room = (centre.0 - half, centre.1 - 12.0, centre.0 + half, centre.1 + 4.0);
            let inside = room.0 > self.left + 2.0
                && room.2 < self.left + self.width - 2.0
                && room.1 > self.top + 2.0
                && room.3 < self.top + self.height - 2.0;
            let free = self.taken.iter().all(|t| room.2 < t.0 || room.0 > t.2 || room.3 < t.1 || room.1 > t.3);
            if inside && free {
                let crossed = self.crossings(room);
                if best.as_ref().is_none_or(|b| crossed < b.0) {
                    best = Some((crossed, centre));
                }
            }
        }
        let Some((_, centre)) = best.filter(|b| b.0 < WORST) else { return false };
        self.taken.push((centre.0 - half, centre.1 - 12.0, centre.0 + half, centre.1 + 4.0));
        if dot {
            self.dot(at, colour);
        }
        self.text(centre, text, 11, TextAnchor::Middle, INK);
        true
    }

    /// Words farther away, with a thin line to their point.
    pub(super) fn place_words_far(&mut self, at: (f64, f64), text: &str) -> bool {
        let half = text.chars().count() as f64 * CHARACTER / 2.0 + 3.0;
        for distance in [36.0, 60.0, 90.0] {
            for (side, down) in [(0.0, -1.0), (0.0, 1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let target = (at.0 + side * half * 0.8, at.1 + down * distance);
                let taken = self.taken.len();
                if self.place_words((target.0, target.1 + 12.0), text, INK, false) {
                    let room = self.taken[taken];
                    let y = if room.1 > at.1 { room.1 + 1.0 } else { room.3 };
                    let x = at.0.clamp(room.0 + 4.0, room.2 - 4.0);
                    self.line(at, (x, y), INK, 0.7, None);
                    self.dot(at, INK);
                    return true;
                }
            }
        }
        false
    }

    /// How much lies under a rectangle: the length of walls, and the lines through the nominal point.
    pub(super) fn crossings(&self, room: (f64, f64, f64, f64)) -> usize {
        let window = Window { x: (room.0, room.2), y: (room.1, room.3) };
        let walls = self.contents.walls.iter().filter(|w| w.role != Role::Nothing);
        let crossed = |w: &Wall| {
            let points: Vec<(f64, f64)> = w.points.iter().map(|p| self.at(*p)).collect();
            window.pieces(&points).len()
        };
        let lines = self
            .nominal()
            .map(|at| self.at(at))
            .map_or(0, |at| usize::from(at.0 > room.0 && at.0 < room.2) + usize::from(at.1 > room.1 && at.1 < room.3));
        WORST * walls.map(crossed).sum::<usize>() + lines
    }
}
