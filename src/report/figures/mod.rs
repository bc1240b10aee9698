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
        let svg = indexed(&renumbered(&drawn, "kuva-clip-", &format!("{name}-clip-")));
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

/// The text with `prefix` and the number behind it replaced by `new` and a number that is counted
/// from 0 in the order of appearance: the plotting library counts through the whole process, and
/// equal data shall give equal bytes.
fn renumbered(text: &str, prefix: &str, new: &str) -> String {
    let mut parts = text.split(prefix);
    let mut out = parts.next().unwrap_or_default().to_string();
    let mut seen: Vec<&str> = Vec::new();
    for part in parts {
        let digits = part.len() - part.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (number, rest) = part.split_at(digits);
        let place = seen.iter().position(|s| *s == number).unwrap_or_else(|| {
            seen.push(number);
            seen.len() - 1
        });
        out.push_str(&format!("{new}{place}{rest}"));
    }
    out
}

/// The SVG with names of one letter and an index, such as `K_pwm`, set with the index below.
fn indexed(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some(begin) = rest.find("<text ").and_then(|at| Some(at + rest[at..].find('>')? + 1)) {
        let end = rest[begin..].find('<').map_or(rest.len(), |n| begin + n);
        out.push_str(&rest[..begin]);
        out.push_str(&with_indices(&rest[begin..end]));
        rest = &rest[end..];
    }
    out + rest
}

/// Words with their indices lowered: `K_pwm` becomes K and a smaller, lower pwm.
fn with_indices(words: &str) -> String {
    let mut out = String::new();
    let mut lowered = false;
    for word in words.split_inclusive(|c: char| !c.is_alphanumeric() && c != '_') {
        let name = word.trim_end_matches(|c: char| !c.is_alphanumeric() && c != '_');
        let after = &word[name.len()..];
        match name.split_once('_') {
            Some((base, index)) if base.chars().count() == 1 && !index.is_empty() && !index.contains('_') => {
                raised(&mut out, base, lowered);
                out.push_str(&format!("<tspan dy=\"0.25em\" font-size=\"75%\">{index}</tspan>"));
                lowered = true;
                raised(&mut out, after, lowered);
                lowered = after.is_empty();
            }
            _ => {
                raised(&mut out, word, lowered);
                lowered = lowered && word.is_empty();
            }
        }
    }
    out
}

/// Text at the usual height, after an index back up from it (0.25 of 75 % of the size).
fn raised(out: &mut String, text: &str, lowered: bool) {
    if lowered && !text.is_empty() {
        out.push_str(&format!("<tspan dy=\"-0.1875em\">{text}</tspan>"));
    } else {
        out.push_str(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clip_paths_are_counted_anew_under_a_new_name() {
        assert_eq!(renumbered("id=c-7 #c-7 id=c-9 #c-7", "c-", "f-"), "id=f-0 #f-0 id=f-1 #f-0");
        assert_eq!(renumbered("nothing", "c-", "f-"), "nothing");
    }

    #[test]
    fn indices_stand_below_in_words_and_nowhere_else() {
        let svg = indexed("<g id=\"a_b\"><text x=\"1\">K_pwm = 3</text><text>no_index, my_long_name</text></g>");
        assert!(svg.starts_with("<g id=\"a_b\"><text x=\"1\">K<tspan "), "{svg}");
        assert!(svg.contains(">pwm</tspan><tspan dy=\"-0.1875em\"> </tspan>= 3</text>"), "{svg}");
        assert!(svg.ends_with("<text>no_index, my_long_name</text></g>"), "{svg}");
        assert_eq!(with_indices("T"), "T");
    }
}
