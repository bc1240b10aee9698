//! Lines, words and marks in the picture.

use super::draw::{Drawing, INK, PAPER};
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, TextAnchor};

impl Drawing<'_> {
    pub(super) fn circle(&mut self, at: (f64, f64)) {
        self.scene.add(Primitive::Circle {
            cx: at.0,
            cy: at.1,
            r: 4.5,
            fill: Color::from(PAPER),
            fill_opacity: None,
            stroke: Some(Color::from(INK)),
            stroke_width: Some(1.5),
        });
    }

    pub(super) fn diamond(&mut self, (x, y): (f64, f64)) {
        let d = format!("{}Z", path(&[(x, y - 6.0), (x + 6.0, y), (x, y + 6.0), (x - 6.0, y)]));
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: Some(Color::from(INK)),
            stroke: Color::from(PAPER),
            stroke_width: 1.0,
            opacity: None,
            stroke_dasharray: None,
        })));
    }

    pub(super) fn dot(&mut self, at: (f64, f64), colour: &str) {
        self.dots.push(at);
        self.scene.add(Primitive::Circle {
            cx: at.0,
            cy: at.1,
            r: 2.6,
            fill: Color::from(colour),
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        });
    }

    pub(super) fn line(&mut self, a: (f64, f64), b: (f64, f64), colour: &str, width: f64, dashes: Option<&str>) {
        self.scene.add(Primitive::Line {
            x1: a.0,
            y1: a.1,
            x2: b.0,
            y2: b.1,
            stroke: Color::from(colour),
            stroke_width: width,
            stroke_dasharray: dashes.map(str::to_owned),
        });
    }

    pub(super) fn text(&mut self, at: (f64, f64), text: &str, size: u32, anchor: TextAnchor, colour: &str) {
        self.scene.add(Primitive::Text {
            x: at.0,
            y: at.1,
            content: text.to_owned(),
            size,
            anchor,
            rotate: None,
            bold: false,
            color: Some(Color::from(colour)),
        });
    }
}

pub(super) fn path(points: &[(f64, f64)]) -> String {
    let mut d = String::with_capacity(points.len() * 14);
    for (k, (x, y)) in thinned(points.to_vec()).iter().enumerate() {
        d.push_str(if k == 0 { "M" } else { "L" });
        d.push_str(&format!("{x:.2},{y:.2}"));
    }
    d
}

/// Without points that are nowhere near a pixel from the one before.
pub(super) fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut out: Vec<(f64, f64)> = Vec::with_capacity(points.len());
    let last = points.len().saturating_sub(1);
    for (k, p) in points.into_iter().enumerate() {
        let near = out.last().is_some_and(|q: &(f64, f64)| (q.0 - p.0).hypot(q.1 - p.1) < 0.3);
        if !near || k == last {
            out.push(p);
        }
    }
    out
}

/// A line cut into its dashes, whose lengths and gaps are given as in SVG.
pub(super) fn dashed(points: Vec<(f64, f64)>, pattern: Option<&str>) -> Vec<Vec<(f64, f64)>> {
    let lengths: Vec<f64> = pattern.map_or_else(Vec::new, |p| p.split(' ').filter_map(|v| v.parse().ok()).collect());
    if lengths.is_empty() {
        return vec![points];
    }
    let (mut k, mut left) = (0, lengths[0]);
    let mut out: Vec<Vec<(f64, f64)>> = points.first().map(|p| vec![*p]).into_iter().collect();
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            let t = if length > left { left / length } else { 1.0 };
            let reached = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            if k % 2 == 0
                && let Some(dash) = out.last_mut()
            {
                dash.push(reached);
            }
            if length <= left {
                left -= length;
                break;
            }
            k = (k + 1) % lengths.len();
            left = lengths[k];
            if k % 2 == 0 {
                out.push(vec![reached]);
            }
            from = reached;
        }
    }
    out.retain(|dash| dash.len() > 1);
    out
}

/// Lines of at most `width` characters.
pub(super) fn broken(text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().expect("there is a line");
        if !last.is_empty() && (last.chars().count() + 1 + word.chars().count()) as f64 > width {
            lines.push(word.to_owned());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}
