//! The map of two parameters as areas and lines in the unit square of a window. Which cell is stable is exact; where a line is
//! drawn is floating point.

use crate::model::{number, problem};
use crate::told::budget;
use jurist::{Answer, Error, Map};
use jurist_draw::figures::map::{
    AxisWindow, MapContents, MapTrace, Role, WindowRequest, choose_windows, mechanism_words, trace_map,
};
use jurist_engine::show::map_text;
use serde::Deserialize;
use serde_json::{Value, json};

/// Digits to which limits are enclosed.
const DIGITS: usize = 12;
/// Points of a line closer than this, in sizes of the picture, are one.
const CLOSE: f64 = 0.0015;

/// Which map.
#[derive(Deserialize)]
pub(crate) struct MapRequest {
    model: String,
    /// Names with their values as written.
    set: Vec<(String, String)>,
    x: String,
    y: String,
    /// Lower and upper end of each axis where they are not to be chosen.
    #[serde(default)]
    window: Option<[[String; 2]; 2]>,
}

/// Areas of stable cells, lines, and the text of `jurist map`.
pub(crate) fn map(request: &MapRequest) -> Result<Value, Error> {
    let budget = budget();
    let problem = problem(&request.model, &request.set, &[&request.x, &request.y])?;
    let answer = problem.map(DIGITS, &budget)?;
    let mut requests = [WindowRequest::default(), WindowRequest::default()];
    for (request, ends) in requests.iter_mut().zip(request.window.iter().flatten()) {
        (request.lower, request.upper) = (Some(number(&ends[0])?), Some(number(&ends[1])?));
    }
    let trace = trace_map(&answer, choose_windows(&answer, &[], &requests), &budget)?;
    let contents = MapContents::new(&answer, &trace, Vec::new(), &budget)?;
    let axis = |k: usize| {
        let window: &AxisWindow = &trace.windows[k];
        let free = &answer.problem().free()[k];
        json!({
            "name": free.name, "unit": free.unit, "log": window.logarithmic,
            "lower": window.lower.to_f64_approximate(), "upper": window.upper.to_f64_approximate(),
        })
    };
    let walls = contents.walls.iter().filter(|wall| wall.role != Role::Nothing).map(|wall| {
        let causes = &answer.value().decomposition.curves[wall.curve].causes;
        json!({
            "words": mechanism_words(causes, &answer), "causes": causes.to_string(),
            "limits": wall.role == Role::Stable, "points": spaced(&wall.points),
        })
    });
    Ok(json!({
        "x": axis(0), "y": axis(1), "floating_point": true,
        "walls": walls.collect::<Vec<_>>(),
        "areas": areas(&answer, &trace),
        "never": answer.value().decomposition.never_stable,
        "regions": answer.value().decomposition.regions.len(),
        "text": map_text(answer.problem(), Ok(answer.value()), DIGITS),
    }))
}

/// The stable cells that the window shows: the lower edge from left to right, then the upper edge back.
fn areas(answer: &Answer<Map>, trace: &MapTrace) -> Vec<Vec<[f64; 2]>> {
    let mut areas = Vec::new();
    for traced in &trace.strips {
        let strip = &answer.value().decomposition.strips[traced.strip];
        for (number, _) in strip.cells.iter().enumerate().filter(|(_, cell)| cell.stable) {
            let edge = |upper: bool| -> Vec<(f64, f64)> {
                let branch = |v: &[f64]| match (upper, number.checked_sub(1)) {
                    (true, _) => v.get(number).copied().unwrap_or(1.0),
                    (false, Some(below)) => v.get(below).copied().unwrap_or(0.0),
                    (false, None) => 0.0,
                };
                traced.lines.iter().map(|line| (line.u, branch(&line.v))).collect()
            };
            let mut outline = spaced(&edge(false));
            let mut above = spaced(&edge(true));
            above.reverse();
            outline.extend(above);
            areas.push(outline);
        }
    }
    areas
}

/// A line without points that a picture cannot tell apart, cut to a little more than the window.
fn spaced(points: &[(f64, f64)]) -> Vec<[f64; 2]> {
    let near = |v: f64| if v.is_finite() { v.clamp(-0.05, 1.05) } else { v.signum().clamp(-0.05, 1.05) };
    let rounded = |v: f64| (near(v) * 1e5).round() / 1e5;
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for (k, p) in points.iter().enumerate() {
        let at = [rounded(p.0), rounded(p.1)];
        let close = kept.last().is_some_and(|l| (l[0] - at[0]).abs() < CLOSE && (l[1] - at[1]).abs() < CLOSE);
        if !close || k + 1 == points.len() {
            kept.push(at);
        }
    }
    kept
}
