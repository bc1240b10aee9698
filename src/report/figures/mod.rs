//! Figures: time responses, root loci, block diagrams; as SVG, PNG, on a terminal.
//!
//! Drawn with kuva. The same data give the same bytes on every machine: no font of the machine is
//! measured, and nothing of the time or place enters. PNGs carry their own font, SVGs name a list of
//! fonts that ends in `sans-serif`.

mod clip;
mod diagrams;
mod locus;
mod panel;
mod responses;
mod sketch;
mod svg;

pub use diagrams::{chopper, current_controller, drive_blocks, pwm_signal, speed_controller, tracker};
pub use locus::{DrawnLocus, LocusFigure, locus_of, locus_panels};
pub use panel::{Corner, Curve, Mark, Panel, Shape, Text, side_by_side, stacked};
pub use responses::{ResponseCurve, axis_label, response_panel, response_panels, thinned};

use kuva::backend::svg::SvgBackend;
use kuva::render::render::Scene;
use kuva::{RasterBackend, TerminalBackend};

/// Fonts in order of preference; the first is also the one that PNGs are drawn with.
const FONTS: &str = "DejaVu Sans, Verdana, Arial, Helvetica, sans-serif";

/// Colours that stay apart for every kind of colour vision [Wong2011](crate::bibliography#wong2011), darkest first.
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

    /// The figure in characters, for a terminal of that size.
    pub fn terminal(&self, columns: usize, rows: usize) -> String {
        TerminalBackend::new(columns, rows).render_scene(&self.scene)
    }
}
