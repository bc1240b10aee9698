//! The font: widths and outlines of its glyphs.

#[cfg(any(feature = "pdf", feature = "png"))]
use super::{Point, Segment};
use std::sync::OnceLock;
#[cfg(any(feature = "pdf", feature = "png"))]
use ttf_parser::OutlineBuilder;
use ttf_parser::{Face, GlyphId};

/// A part of DejaVu Sans; its licence is beside it.
pub(super) const FILE: &[u8] = include_bytes!("../../fonts/DejaVuSans-subset.ttf");

/// The font.
pub(super) fn face() -> &'static Face<'static> {
    static FACE: OnceLock<Face<'static>> = OnceLock::new();
    FACE.get_or_init(|| Face::parse(FILE, 0).expect("the font is part of this crate"))
}

/// The glyph of a character; that of a missing one where the font has none.
pub(super) fn glyph(c: char) -> GlyphId {
    face().glyph_index(c).unwrap_or(GlyphId(0))
}

/// The width of a line of one size.
pub(super) fn advance(text: &str, size: f64) -> f64 {
    let units: u32 = text.chars().map(|c| u32::from(face().glyph_hor_advance(glyph(c)).unwrap_or(0))).sum();
    f64::from(units) * size / f64::from(face().units_per_em())
}

#[cfg(any(feature = "pdf", feature = "png"))]
/// The outlines of a line that begins at a place on its base line, to the right and down.
pub(super) fn outlines(text: &str, size: f64, (mut x, y): Point) -> Vec<Segment> {
    let scale = size / f64::from(face().units_per_em());
    let mut outline = Outline { scale, origin: (x, y), last: (x, y), segments: Vec::new() };
    for c in text.chars() {
        outline.origin = (x, y);
        face().outline_glyph(glyph(c), &mut outline);
        x += f64::from(face().glyph_hor_advance(glyph(c)).unwrap_or(0)) * scale;
    }
    outline.segments
}

#[cfg(any(feature = "pdf", feature = "png"))]
struct Outline {
    scale: f64,
    origin: Point,
    last: Point,
    segments: Vec<Segment>,
}

#[cfg(any(feature = "pdf", feature = "png"))]
impl Outline {
    fn at(&self, x: f32, y: f32) -> Point {
        (self.origin.0 + f64::from(x) * self.scale, self.origin.1 - f64::from(y) * self.scale)
    }
}

#[cfg(any(feature = "pdf", feature = "png"))]
impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.last = self.at(x, y);
        self.segments.push(Segment::Move(self.last));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.last = self.at(x, y);
        self.segments.push(Segment::Line(self.last));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        // A quadratic curve is a cubic one whose control points are two thirds of the way.
        let (from, control, to) = (self.last, self.at(x1, y1), self.at(x, y));
        let towards = |p: Point| (p.0 + (control.0 - p.0) * 2.0 / 3.0, p.1 + (control.1 - p.1) * 2.0 / 3.0);
        self.last = to;
        self.segments.push(Segment::Cubic(towards(from), towards(to), to));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (a, b, to) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.last = to;
        self.segments.push(Segment::Cubic(a, b, to));
    }

    fn close(&mut self) {
        self.segments.push(Segment::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_what_pictures_say() {
        for c in "Kω µΩ−·×○⁰¹²³⁴⁵⁶⁷⁸⁹⁻≤≥°…φöéж".chars() {
            assert!(face().glyph_index(c).is_some(), "{c}");
        }
        assert!(
            (advance("mm", 12.0) - 2.0 * advance("m", 12.0)).abs() < 1e-12 && advance("i", 12.0) < advance("m", 12.0)
        );
        assert!(outlines("o", 12.0, (0.0, 0.0)).iter().filter(|s| matches!(s, Segment::Close)).count() == 2);
    }
}
