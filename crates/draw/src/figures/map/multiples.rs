//! Slices of a body beside each other, on common axes.

use super::super::facts::heading;
use super::super::legend;
use super::super::{FAINT_INK, Figure, engineering::quantity};
use super::draw::{Legend, MapContents, what};
use crate::scene::{Anchor, Scene, Words};
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, Body};
use jurist_show::layout::{short, visible};

/// Width and height of a slice.
const PANEL: (f64, f64) = (300.0, 250.0);
/// Slices in a row, at most.
const MOST_COLUMNS: usize = 6;

/// `K = 0.5 V`: a slice by its value of the third parameter.
pub fn slice_name(answer: &Answer<Body>, value: &Rational) -> String {
    let third = &answer.problem().free()[2];
    let unit = visible(third.unit.as_deref().unwrap_or_default());
    format!("{} = {}", third.name, quantity(&short(value), &unit))
}

/// The legend of all of several pictures.
pub fn common_legend(contents: &[Option<MapContents<'_>>]) -> Legend {
    // The longest legend first: it has them in the usual order.
    let mut legends: Vec<Legend> = contents.iter().flatten().map(MapContents::legend).collect();
    legends.sort_by_key(|legend| std::cmp::Reverse(legend.0.len()));
    let mut common: Vec<legend::Entry> = Vec::new();
    for entry in legends.into_iter().flat_map(|legend| legend.0) {
        if !common.iter().any(|known| known.1 == entry.1) {
            common.push(entry);
        }
    }
    Legend(common)
}

/// All slices beside each other under one heading and one legend; one that is not decided says so in its place.
///
/// # Panics
/// Unless each slice has its contents, or none.
pub fn small_multiples(answer: &Answer<Body>, contents: &[Option<MapContents<'_>>]) -> Figure {
    let slices = &answer.value().slices;
    assert_eq!(slices.len(), contents.len(), "each slice has its place");
    let columns = (slices.len() as f64).sqrt().ceil() as usize;
    let columns = columns.clamp(2, MOST_COLUMNS);
    let rows = slices.len().div_ceil(columns);
    let mut scene = Scene::new(columns as f64 * PANEL.0, 0.0);
    let problem = answer.problem();
    let top = heading(&what(problem), problem).draw(&mut scene);
    let room = scene.width - 28.0;
    let top = legend::in_rows(&mut scene, &common_legend(contents).0, (14.0, top + 2.0), room) + 6.0;
    scene.height = top + rows as f64 * PANEL.1;
    for (k, (slice, contents)) in slices.iter().zip(contents).enumerate() {
        let place = ((k % columns) as f64 * PANEL.0, top + (k / columns) as f64 * PANEL.1);
        let name = slice_name(answer, &slice.value);
        let panel = match contents {
            Some(contents) => contents.draw_among(PANEL.0, PANEL.1, &name),
            None => {
                let mut panel = Scene::new(PANEL.0, PANEL.1);
                let middle = (PANEL.0 / 2.0, PANEL.1 / 2.0);
                let words = Words::new(format!("{name}: not decided"), middle, 13.0, FAINT_INK);
                panel.words(words.anchored(Anchor::Middle));
                panel
            }
        };
        scene.place(place, panel);
    }
    scene.into()
}
