//! Figures: maps, time responses, root loci, block diagrams; as SVG, PNG, PDF, on a terminal.
//!
//! All axes are those of one [`Axis`], all drawings are a [`Scene`]. The same data give the same bytes on every
//! machine: no font of the machine is measured, and nothing of the time or place enters.

mod axes;
mod clip;
mod engineering;
mod facts;
mod frequency;
mod legend;
mod locus;
pub mod map;
mod nyquist;
mod panel;
mod placing;
mod ranges;
mod response;
mod response_figure;
mod responses;
mod sketch;
mod tolerances;

pub use axes::{Axis, Heading, Scale, Tick};
pub use engineering::{quantity, unit_text};
pub use facts::{facts, heading};
pub use frequency::{FrequencyResponse, ResponsePoint, frequency_response};
pub use locus::{DrawnLocus, LocusFigure, locus_of, locus_panels, locus_range};
pub use nyquist::nyquist;
pub use panel::{Corner, Curve, Mark, Panel, Shape, Text, side_by_side, stacked};
pub use ranges::ranges_figure;
pub use response::bode;
pub use response_figure::response_figure;
pub use responses::{ResponseCurve, axis_label, response_panel, response_panels, stairs, thinned, thinned_to};
pub use sketch::Sketch;
pub use tolerances::tolerance_figure;

use crate::scene::{Colour, Scene};

/// Colours that stay apart for every kind of colour vision [Wong2011](jurist_algebra::bibliography#wong2011), darkest first.
pub const COLOURS: [&str; 6] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"];

/// Words and marks.
pub(crate) const INK: Colour = Colour::css("#222222");
/// Words that matter less.
pub(crate) const FAINT_INK: Colour = Colour::css("#555555");
/// Lines that matter less.
pub(crate) const FAINT: Colour = Colour::css("#999999");
/// Axes.
pub(crate) const FRAME: Colour = Colour::css("#333333");
/// Lines of the grid.
pub(crate) const GRID: Colour = Colour::css("#e4e4e4");

/// What a colour becomes on dark ground.
const DARK: [(&str, &str); 14] = [
    ("#ffffff", "#15171a"),
    ("#222222", "#e3e3e3"),
    ("#555555", "#b5b5b5"),
    ("#777777", "#a0a4a8"),
    ("#999999", "#8a8f95"),
    ("#333333", "#c8c8c8"),
    ("#e4e4e4", "#2d3237"),
    ("#cfe8d8", "#1d4534"),
    ("#f7ece6", "#33241d"),
    ("#ececec", "#2a2d31"),
    ("#f4f7fb", "#1e2530"),
    ("#0072b2", "#5db8ee"),
    ("#d55e00", "#ff9149"),
    ("#009e73", "#35c99b"),
];

/// The CSS rules that turn figures inside `scope` dark; for a page that itself turns dark.
///
/// ```
/// let css = jurist_draw::figures::dark_style(".figure");
/// assert!(css.contains(".figure [fill=\"#ffffff\"]{fill:#15171a}"));
/// ```
pub fn dark_style(scope: &str) -> String {
    let rule = |(light, dark): &(&str, &str)| {
        format!("{scope} [fill=\"{light}\"]{{fill:{dark}}}{scope} [stroke=\"{light}\"]{{stroke:{dark}}}\n")
    };
    DARK.iter().map(rule).collect()
}

/// A drawn figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    scene: Scene,
}

impl From<Scene> for Figure {
    fn from(scene: Scene) -> Figure {
        Figure { scene }
    }
}

impl Figure {
    /// Width and height in the units of the SVG, which are pixels at scale 1.
    pub fn size(&self) -> (f64, f64) {
        (self.scene.width, self.scene.height)
    }

    /// What is drawn.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The figure as an SVG document that scales with the page.
    pub fn svg(&self) -> String {
        self.svg_named("figure")
    }

    /// The figure as an SVG to stand in a page beside others: its identifiers begin with `name`,
    /// for a page has one set of them, and the first clip path of that name would cut all figures.
    pub fn svg_named(&self, name: &str) -> String {
        self.scene.svg(name)
    }

    /// The figure as a PNG, `scale` pixels per unit (2 is right for most screens and for print).
    ///
    /// # Errors
    /// The encoder's message, which does not come for figures of sane size; in a build without the feature `png` always.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, String> {
        #[cfg(feature = "png")]
        return self.scene.png(scale);
        #[cfg(not(feature = "png"))]
        return Err(format!("this build draws no PNG, neither {scale} times nor at all"));
    }

    /// The figure as a PDF of one page; its words can be selected.
    ///
    /// # Errors
    /// In a build without the feature `pdf`.
    pub fn pdf(&self) -> Result<Vec<u8>, String> {
        #[cfg(feature = "pdf")]
        return Ok(self.scene.pdf());
        #[cfg(not(feature = "pdf"))]
        return Err("this build draws no PDF".into());
    }

    /// The figure in characters, for a terminal of that many columns; a character counts as twice as
    /// high as wide, so equal axes stay equal. Ink is left to the terminal, whose own text may be
    /// white; without `colours` there are no escape sequences at all.
    pub fn terminal(&self, columns: usize, colours: bool) -> String {
        let (w, h) = self.size();
        let rows = (columns as f64 * h / w / 2.0).ceil().clamp(12.0, 120.0) as usize;
        self.scene.characters(
            (columns, rows),
            colours,
            &[GRID, map::UNSTABLE, map::OUTSIDE, map::REGION],
            &[INK, FRAME, FAINT_INK, Colour::BLACK],
        )
    }

    /// The figure under a heading.
    pub fn headed(self, heading: &Heading) -> Figure {
        let (w, h) = self.size();
        let mut scene = Scene::new(w, h);
        let top = heading.draw(&mut scene);
        scene.height = h + top;
        scene.place((0.0, top), self.scene);
        Figure { scene }
    }
}
