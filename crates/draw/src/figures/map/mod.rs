//! The picture of a map of two parameters.
//!
//! What is drawn is floating point; which cell is stable, where strips begin and end and how many branches
//! are in them comes from the exact decomposition, and every point of a curve is an isolated root.

mod boxes;
mod draw;
mod labels;
mod layers;
mod legend;
mod lines;
mod multiples;
mod trace;
mod window;
mod words;

pub use boxes::boxes_figure;
pub use draw::{Legend, MapContents, MapFigure};
pub use labels::{FrequencyPoint, frequency_unit};
pub use lines::{Role, Wall, mechanism_colour, mechanism_words};
pub use multiples::{common_legend, slice_name, small_multiples};
pub use trace::{MapTrace, TracedLine, TracedStrip, trace_map};
pub use window::{AxisWindow, WindowRequest, choose_windows, common_windows};

use crate::scene::Colour;

/// The ground of stable points.
pub(crate) const REGION: Colour = Colour::css("#cfe8d8");
/// The ground of stable points that meet all that is required.
pub(crate) const MET: Colour = Colour::css("#7cc79d");
/// The ground of unstable points.
pub(crate) const UNSTABLE: Colour = Colour::css("#f7ece6");
/// The ground of points outside the domain.
pub(crate) const OUTSIDE: Colour = Colour::css("#ececec");
/// The ground of boxes without a verdict.
const UNDECIDED: Colour = Colour::css("#e69f00");
