//! Legends: samples of what is drawn with their names.

use super::INK;
use super::panel::Shape;
use crate::scene::{Colour, Item, Point, Rectangle, Scene, Stroke, Words, width};

/// What stands before a name of a legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Sample {
    /// An area.
    Area(Colour),
    /// A hatched area.
    Hatched,
    /// A line.
    Line(Stroke),
    /// A mark.
    Mark(Shape, Colour),
}

/// A sample and its name.
pub(super) type Entry = (Sample, String);

const SIZE: f64 = 11.0;
/// Width of a sample with the gap behind it.
const SAMPLE: f64 = 28.0;
/// Between two entries in a row, and two rows.
const GAP: f64 = 16.0;
const ROW: f64 = 17.0;

/// The rows that entries take in a width.
fn rows(entries: &[Entry], room: f64) -> Vec<Vec<&Entry>> {
    let mut out: Vec<Vec<&Entry>> = Vec::new();
    let mut x = f64::INFINITY;
    for entry in entries {
        let length = SAMPLE + width(&entry.1, SIZE);
        if x + length > room {
            out.push(Vec::new());
            x = 0.0;
        }
        x += length + GAP;
        if let Some(row) = out.last_mut() {
            row.push(entry);
        }
    }
    out
}

/// Entries with their samples as letters.
fn in_letters(entries: &[Entry]) -> Vec<(&'static str, Colour, String)> {
    let letter = |sample: &Sample| match sample {
        Sample::Area(colour) => ("██", *colour),
        Sample::Hatched => ("▒▒", super::FAINT),
        Sample::Line(stroke) if stroke.dashes.is_empty() => ("──", stroke.colour),
        Sample::Line(stroke) => ("╌╌", stroke.colour),
        Sample::Mark(shape, colour) => (sign(*shape), *colour),
    };
    let entry = |(sample, name): &Entry| {
        let (letters, colour) = letter(sample);
        (letters, colour, name.clone())
    };
    entries.iter().map(entry).collect()
}

/// A mark as a letter.
fn sign(shape: Shape) -> &'static str {
    match shape {
        Shape::Cross => "×",
        Shape::Circle => "○",
        Shape::Plus => "+",
        Shape::Dot => "●",
        Shape::Square => "■",
        Shape::Triangle => "▲",
        Shape::Diamond => "◆",
    }
}

/// Rows of entries from a place (left, top) on; returns where they end.
pub(super) fn in_rows(scene: &mut Scene, entries: &[Entry], (left, top): Point, room: f64) -> f64 {
    let rows = rows(entries, room);
    let end = top + ROW * rows.len() as f64;
    scene.legend(in_letters(entries), |scene| {
        let mut y = top;
        for row in rows {
            let mut x = left;
            for (sample, name) in row {
                draw(scene, sample, (x, y + ROW / 2.0));
                scene.words(Words::new(name, (x + SAMPLE, y + ROW / 2.0 + 4.0), SIZE, INK));
                x += SAMPLE + width(name, SIZE) + GAP;
            }
            y += ROW;
        }
    });
    end
}

/// The size of a box with the entries one below the other.
pub(super) fn box_size(entries: &[Entry]) -> (f64, f64) {
    let widest = entries.iter().map(|e| width(&e.1, SIZE)).fold(0.0, f64::max);
    (SAMPLE + widest + 16.0, ROW * entries.len() as f64 + 8.0)
}

/// Entries one below the other in a box.
pub(super) fn in_box(scene: &mut Scene, entries: &[Entry], (left, top): Point) {
    let (width, height) = box_size(entries);
    let outline = Rectangle { left, top, width, height };
    scene.legend(in_letters(entries), |scene| {
        scene.rectangle(&outline, Some(Colour::WHITE), Some(Stroke::new(super::GRID, 1.0)));
        for (k, (sample, name)) in entries.iter().enumerate() {
            let y = top + 4.0 + ROW * (k as f64 + 0.5);
            draw(scene, sample, (left + 8.0, y));
            scene.words(Words::new(name, (left + 8.0 + SAMPLE, y + 4.0), SIZE, INK));
        }
    });
}

/// A sample from the left, about a height.
fn draw(scene: &mut Scene, sample: &Sample, (x, y): Point) {
    let area = Rectangle { left: x, top: y - 6.0, width: 22.0, height: 12.0 };
    match sample {
        Sample::Area(colour) => scene.rectangle(&area, Some(*colour), Some(Stroke::new(super::FAINT, 0.5))),
        Sample::Hatched => hatched(scene, &area),
        Sample::Line(stroke) => scene.line((x, y), (x + 22.0, y), stroke.clone()),
        Sample::Mark(shape, colour) => mark(scene, *shape, *colour, (x + 11.0, y)),
    }
}

/// An area where nothing is defined.
pub(super) fn hatched(scene: &mut Scene, area: &Rectangle) {
    scene.rectangle(area, Some(super::map::OUTSIDE), None);
    let step = 7.0;
    let mut segments = Vec::new();
    let mut at = step / 2.0;
    // From the left or lower edge upwards to the right, each line cut at the area.
    while at < area.width + area.height {
        let from = (area.left + (at - area.height).max(0.0), area.top + at.min(area.height));
        let to = (area.left + at.min(area.width), area.top + (at - area.width).max(0.0));
        segments.extend([crate::scene::Segment::Move(from), crate::scene::Segment::Line(to)]);
        at += step;
    }
    scene.add(Item::Path { segments, fill: None, stroke: Some(Stroke::new(super::FAINT, 0.6)) });
}

/// A mark at a place.
pub(super) fn mark(scene: &mut Scene, shape: Shape, colour: Colour, at: Point) {
    scene.sign(sign(shape), colour, at, |scene| outlined(scene, shape, colour, at));
}

fn outlined(scene: &mut Scene, shape: Shape, colour: Colour, (x, y): Point) {
    let line = |w: f64| Some(Stroke::new(colour, w));
    let edge = Some(Stroke::new(Colour::WHITE, 1.0));
    let strokes = |scene: &mut Scene, pairs: &[(Point, Point)]| {
        for ((a, b), (c, d)) in pairs {
            scene.line((x + a, y + b), (x + c, y + d), Stroke::new(colour, 1.6));
        }
    };
    match shape {
        Shape::Cross => strokes(scene, &[((-4.5, -4.5), (4.5, 4.5)), ((-4.5, 4.5), (4.5, -4.5))]),
        Shape::Plus => strokes(scene, &[((-5.5, 0.0), (5.5, 0.0)), ((0.0, -5.5), (0.0, 5.5))]),
        Shape::Circle => scene.circle((x, y), 4.5, None, line(1.6)),
        Shape::Dot => scene.circle((x, y), 2.8, Some(colour), None),
        Shape::Square => {
            let corners = [(x - 4.0, y - 4.0), (x + 4.0, y - 4.0), (x + 4.0, y + 4.0), (x - 4.0, y + 4.0)];
            scene.polygon(&corners, Some(colour), edge);
        }
        Shape::Triangle => {
            scene.polygon(&[(x, y - 5.5), (x + 5.0, y + 4.0), (x - 5.0, y + 4.0)], Some(colour), edge);
        }
        Shape::Diamond => {
            scene.polygon(&[(x, y - 6.0), (x + 6.0, y), (x, y + 6.0), (x - 6.0, y)], Some(colour), edge);
        }
    }
}
