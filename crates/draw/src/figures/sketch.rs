//! Boxes, wires and words: what block diagrams and circuits are drawn with.

use super::Figure;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

const INK: &str = "#222222";

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
        Figure::new(self.scene)
    }

    /// Straight wires through points.
    pub fn wire(&mut self, points: &[(f64, f64)]) {
        self.line(points, INK, 1.4, None);
    }

    /// Straight lines through points, in a colour and a width, dashed on demand.
    pub fn line(&mut self, points: &[(f64, f64)], colour: &str, width: f64, dashes: Option<&str>) {
        for pair in points.windows(2) {
            self.scene.add(Primitive::Line {
                x1: pair[0].0,
                y1: pair[0].1,
                x2: pair[1].0,
                y2: pair[1].1,
                stroke: Color::from(colour),
                stroke_width: width,
                stroke_dasharray: dashes.map(str::to_string),
            });
        }
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
        let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
        self.path(format!("M{}Z", path.join("L")), Some(INK));
    }

    /// A path in SVG notation, drawn or filled.
    pub fn path(&mut self, d: String, fill: Option<&str>) {
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: fill.map(Color::from),
            stroke: Color::from(INK),
            stroke_width: if fill.is_some() { 0.5 } else { 1.4 },
            opacity: None,
            stroke_dasharray: None,
        })));
    }

    /// A box around lines of text, centred at a point.
    pub fn block(&mut self, centre: (f64, f64), size: (f64, f64), lines: &[&str]) {
        self.scene.add(Primitive::Rect {
            x: centre.0 - size.0 / 2.0,
            y: centre.1 - size.1 / 2.0,
            width: size.0,
            height: size.1,
            fill: Color::from("#f4f7fb"),
            stroke: Some(Color::from(INK)),
            stroke_width: Some(1.4),
            opacity: None,
        });
        let first = centre.1 - 8.5 * (lines.len() as f64 - 1.0) + 4.5;
        for (k, line) in lines.iter().enumerate() {
            self.words((centre.0, first + 17.0 * k as f64), line, 13, TextAnchor::Middle);
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
        self.circle(at, 2.8, INK);
    }

    /// A circle, filled.
    pub fn circle(&mut self, at: (f64, f64), r: f64, fill: &str) {
        self.scene.add(Primitive::Circle {
            cx: at.0,
            cy: at.1,
            r,
            fill: Color::from(fill),
            fill_opacity: None,
            stroke: Some(Color::from(INK)),
            stroke_width: Some(1.4),
        });
    }

    /// Words around a point.
    pub fn label(&mut self, at: (f64, f64), text: &str) {
        self.words(at, text, 12, TextAnchor::Middle);
    }

    /// Words that begin at a point.
    pub fn label_left(&mut self, at: (f64, f64), text: &str) {
        self.words(at, text, 12, TextAnchor::Start);
    }

    /// Words that end at a point.
    pub fn label_right(&mut self, at: (f64, f64), text: &str) {
        self.words(at, text, 12, TextAnchor::End);
    }

    fn words(&mut self, at: (f64, f64), text: &str, size: u32, anchor: TextAnchor) {
        self.scene.add(Primitive::Text {
            x: at.0,
            y: at.1,
            content: text.to_string(),
            size,
            anchor,
            rotate: None,
            bold: false,
            color: Some(Color::from(INK)),
        });
    }
}
