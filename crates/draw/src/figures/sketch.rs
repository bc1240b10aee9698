//! Boxes, wires and words: what block diagrams and circuits are drawn with.

use super::{Figure, INK};
use crate::scene::{Anchor, Colour, Item, Rectangle, Scene, Segment, Stroke, Words};

/// Ground of boxes.
const GROUND: Colour = Colour::css("#f4f7fb");
/// Width of wires and outlines.
const WIRE: f64 = 1.4;

/// A drawing in the making; coordinates in pixels from the upper left corner.
#[derive(Debug)]
pub struct Sketch {
    scene: Scene,
}

impl Sketch {
    /// An empty drawing, in pixels.
    pub fn new(width: f64, height: f64) -> Sketch {
        Sketch { scene: Scene::new(width, height) }
    }

    /// The drawing as a figure.
    pub fn finish(self) -> Figure {
        self.scene.into()
    }

    /// Straight wires through points.
    pub fn wire(&mut self, points: &[(f64, f64)]) {
        self.scene.polyline(points, Stroke::new(INK, WIRE));
    }

    /// Straight lines through points, in a colour and a width; the lengths of dashes and gaps, if it has any.
    pub fn line(&mut self, points: &[(f64, f64)], colour: &str, width: f64, dashes: Option<&[f64]>) {
        self.scene.polyline(points, Stroke::new(Colour::css(colour), width).dashed(dashes.unwrap_or_default()));
    }

    /// A wire with an arrow head at its last point.
    pub fn arrow(&mut self, points: &[(f64, f64)]) {
        let [.., a, b] = points else { return };
        let length = (b.0 - a.0).hypot(b.1 - a.1).max(1e-9);
        let (ux, uy) = ((b.0 - a.0) / length, (b.1 - a.1) / length);
        let base = (b.0 - 9.0 * ux, b.1 - 9.0 * uy);
        let mut shaft = points.to_vec();
        if let Some(last) = shaft.last_mut() {
            *last = base;
        }
        self.wire(&shaft);
        let corner = |side: f64| (base.0 - side * 4.0 * uy, base.1 + side * 4.0 * ux);
        self.filled(&[*b, corner(1.0), corner(-1.0)]);
    }

    /// A filled polygon.
    pub fn filled(&mut self, points: &[(f64, f64)]) {
        self.scene.polygon(points, Some(INK), None);
    }

    /// Cubic curves from a point on, each with two control points and its end.
    pub fn curves(&mut self, from: (f64, f64), curves: &[[(f64, f64); 3]]) {
        let segments = curves.iter().map(|[a, b, end]| Segment::Cubic(*a, *b, *end));
        let segments = std::iter::once(Segment::Move(from)).chain(segments).collect();
        self.scene.add(Item::Path { segments, fill: None, stroke: Some(Stroke::new(INK, WIRE)) });
    }

    /// A box around lines of text, centred at a point.
    pub fn block(&mut self, centre: (f64, f64), size: (f64, f64), lines: &[&str]) {
        let (width, height) = size;
        let outline = Rectangle { left: centre.0 - width / 2.0, top: centre.1 - height / 2.0, width, height };
        self.scene.rectangle(&outline, Some(GROUND), Some(Stroke::new(INK, WIRE)));
        let first = centre.1 - 8.5 * (lines.len() as f64 - 1.0) + 4.5;
        for (k, line) in lines.iter().enumerate() {
            self.words((centre.0, first + 17.0 * k as f64), line, 13.0, Anchor::Middle);
        }
    }

    /// A summing point.
    pub fn sum(&mut self, at: (f64, f64)) {
        self.circle(at, 11.0, "white");
        self.wire(&[(at.0 - 5.0, at.1), (at.0 + 5.0, at.1)]);
        self.wire(&[(at.0, at.1 - 5.0), (at.0, at.1 + 5.0)]);
    }

    /// A dot where wires join.
    pub fn joint(&mut self, at: (f64, f64)) {
        self.scene.circle(at, 2.8, Some(INK), None);
    }

    /// A circle, filled.
    pub fn circle(&mut self, at: (f64, f64), r: f64, fill: &str) {
        self.scene.circle(at, r, Some(Colour::css(fill)), Some(Stroke::new(INK, WIRE)));
    }

    /// Words around a point.
    pub fn label(&mut self, at: (f64, f64), text: &str) {
        self.words(at, text, 12.0, Anchor::Middle);
    }

    /// Words that begin at a point.
    pub fn label_left(&mut self, at: (f64, f64), text: &str) {
        self.words(at, text, 12.0, Anchor::Start);
    }

    /// Words that end at a point.
    pub fn label_right(&mut self, at: (f64, f64), text: &str) {
        self.words(at, text, 12.0, Anchor::End);
    }

    fn words(&mut self, at: (f64, f64), text: &str, size: f64, anchor: Anchor) {
        self.scene.words(Words::new(text, at, size, INK).anchored(anchor));
    }
}
