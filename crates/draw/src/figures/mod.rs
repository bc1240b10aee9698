//! Figures: time responses, root loci, block diagrams; as SVG, PNG, on a terminal.
//!
//! Drawn with kuva. The same data give the same bytes on every machine: no font of the machine is
//! measured, and nothing of the time or place enters. PNGs carry their own font, SVGs name a list of
//! fonts that ends in `sans-serif`.

mod clip;
mod locus;
pub mod map;
mod panel;
mod response;
mod responses;
mod sketch;
mod svg;

pub use locus::{DrawnLocus, LocusFigure, locus_of, locus_panels};
pub use panel::{Corner, Curve, Mark, Panel, Shape, Text, side_by_side, stacked};
pub use response::{FrequencyResponse, ResponsePoint, bode, frequency_response, nyquist};
pub use responses::{ResponseCurve, axis_label, response_panel, response_panels, thinned};
pub use sketch::Sketch;

use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene};
use kuva::{RasterBackend, TerminalBackend};

/// Fonts in order of preference; the first is also the one that PNGs are drawn with.
const FONTS: &str = "DejaVu Sans, Verdana, Arial, Helvetica, sans-serif";

/// Colours that stay apart for every kind of colour vision [Wong2011](jurist_algebra::bibliography#wong2011), darkest first.
pub const COLOURS: [&str; 6] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"];

/// A drawn figure.
#[derive(Debug)]
pub struct Figure {
    scene: Scene,
}

impl Figure {
    fn new(mut scene: Scene) -> Figure {
        scene.font_family = Some(FONTS.into());
        scene.background_color = Some("white".into());
        Figure { scene }
    }

    /// Width and height in the units of the SVG, which are pixels at scale 1.
    pub fn size(&self) -> (f64, f64) {
        (self.scene.width, self.scene.height)
    }

    /// The figure as an SVG document that scales with the page.
    pub fn svg(&self) -> String {
        self.svg_named("figure")
    }

    /// The figure as an SVG to stand in a page beside others: its identifiers begin with `name`,
    /// for a page has one set of them, and the first clip path of that name would cut all figures.
    pub fn svg_named(&self, name: &str) -> String {
        let drawn = SvgBackend::new().render_scene(&self.scene);
        let svg = svg::indexed(&svg::rounded(&svg::renumbered(&drawn, "kuva-clip-", &format!("{name}-clip-"))));
        let (w, h) = self.size();
        let view = format!("<svg viewBox=\"0 0 {w:.0} {h:.0}\" ");
        if svg.contains("viewBox") { svg } else { svg.replacen("<svg ", &view, 1) }
    }

    /// The figure as a PNG, `scale` pixels per unit (2 is right for most screens and for print).
    ///
    /// # Errors
    /// The encoder's message; it does not fail for figures of sane size.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, String> {
        RasterBackend::new().with_scale(scale).render_scene(&self.scene)
    }

    /// The figure in characters, for a terminal of that many columns; a character counts as twice as
    /// high as wide, so equal axes stay equal. Black is left to the terminal, whose own text may be
    /// white; without `colours` there are no escape sequences at all.
    pub fn terminal(&self, columns: usize, colours: bool) -> String {
        let (w, h) = self.size();
        let rows = (columns as f64 * h / w / 2.0).ceil().clamp(12.0, 120.0) as usize;
        let mut bare = Scene::new(w, h);
        bare.elements = self.scene.elements.iter().filter(|e| !is_background(e)).cloned().collect();
        bare.defs.clone_from(&self.scene.defs);
        let drawn = TerminalBackend::new(columns, rows).render_scene(&bare);
        let ink = ["\u{1b}[38;2;0;0;0m", "\u{1b}[38;2;34;34;34m"];
        if colours { ink.iter().fold(drawn, |text, code| text.replace(code, "")) } else { without_colours(&drawn) }
    }
}

/// Grid lines and the legend's white ground: in characters they hide what they are behind.
fn is_background(element: &Primitive) -> bool {
    let is = |colour: &Color, text: &str| colour.to_svg_string() == Color::from(text).to_svg_string();
    match element {
        Primitive::Line { stroke, .. } => is(stroke, "#cccccc"),
        Primitive::Rect { fill, .. } => is(fill, "white"),
        _ => false,
    }
}

/// The text without the escape sequences `ESC [ ... letter` that give colours.
fn without_colours(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut parts = text.split("\u{1b}[");
    out.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let end = part.find(|c: char| c.is_ascii_alphabetic()).map_or(part.len(), |k| k + 1);
        out.push_str(&part[end..]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_taken_away() {
        assert_eq!(without_colours("a\u{1b}[38;2;1;2;3mb\u{1b}[0m c"), "ab c");
    }
}
