//! Stable ranges of a parameter side by side, one for each value of something that is counted.

use super::axes::Scale;
use super::facts::heading;
use super::panel::{Curve, Mark, Panel, Shape};
use super::{COLOURS, Figure};
use jurist_engine::answer::Answer;
use jurist_engine::stability::{End, StableSet};

/// Width and height of the picture.
const SIZE: (f64, f64) = (760.0, 460.0);

/// From this quotient of the ends on, positive values lie on a logarithmic axis.
const LOGARITHMIC: f64 = 30.0;

/// Digits of ends in a picture.
const DIGITS: usize = 9;

/// The stable sets of a parameter, one upright line for each, and the ends of one set as levels. `counted` says what the numbers of the rows are.
///
/// Numbers in the picture are floating point.
pub fn ranges_figure(what: &str, counted: &str, exact: &Answer<StableSet>, rows: &[(i64, &StableSet)]) -> Figure {
    let free = exact.problem().parameter();
    let unit = exact.problem().model().parameter(&free.name).and_then(|p| p.unit.clone()).unwrap_or_default();
    let ends = |set: &StableSet| -> Vec<[Option<f64>; 2]> {
        set.intervals().iter().map(|i| [value(&i.lower), value(&i.upper)]).collect()
    };
    let exact_ends = ends(exact.value());
    let all: Vec<f64> =
        rows.iter().flat_map(|(_, set)| ends(set)).chain(exact_ends.clone()).flatten().flatten().collect();
    let (y, y_scale) = span(&all);
    let inside = |end: Option<f64>, other: f64| end.unwrap_or(other).clamp(y.0, y.1);
    let mut panel = Panel {
        x_label: counted.to_owned(),
        y_label: super::axis_label(&free.name, &unit),
        x: (rows.first().map_or(0.0, |r| r.0 as f64) - 0.7, rows.last().map_or(1.0, |r| r.0 as f64) + 3.0),
        y,
        y_scale,
        ..Panel::default()
    };
    for (count, set) in rows {
        let at = *count as f64;
        for [low, high] in ends(set) {
            let points = vec![(at, inside(low, y.0)), (at, inside(high, y.1))];
            panel.curves.push(Curve { points, colour: COLOURS[2].into(), width: 5.0, ..Curve::default() });
        }
        if set.intervals().is_empty() {
            let middle = if y_scale == Scale::Logarithmic { (y.0 * y.1).sqrt() } else { (y.0 + y.1) / 2.0 };
            panel.marks.push(Mark { at: (at, middle), shape: Shape::Cross, colour: COLOURS[1].into(), label: None });
        }
    }
    for end in exact_ends.into_iter().flatten().flatten() {
        panel.levels.push((end, format!("exact {end:.6}")));
    }
    let mut heading = heading(what, exact.problem());
    heading.notes.push("green: stable; a cross: stable nowhere".into());
    panel.figure(SIZE.0, SIZE.1).headed(&heading)
}

fn value(end: &Option<End>) -> Option<f64> {
    end.as_ref()?.value.decimal(DIGITS).parse().ok()
}

/// The axis that shows all ends, with some room.
fn span(ends: &[f64]) -> ((f64, f64), Scale) {
    let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let high = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return ((0.0, 1.0), Scale::Linear);
    }
    let least = ends.iter().copied().filter(|end| *end > 0.0).fold(f64::INFINITY, f64::min);
    if low >= 0.0 && high / least > LOGARITHMIC {
        return ((least / 2.0, high * 2.0), Scale::Logarithmic);
    }
    let room = 0.12 * if high > low { high - low } else { high.abs().max(1.0) };
    ((low - room, high + room), Scale::Linear)
}
