//! The map of two parameters as areas and lines in the unit square of a window, or as boxes of it. Which cell or box is stable is exact;
//! where a line is drawn is floating point.

use crate::model::{number, problem};
use crate::told::budget;
use jurist::{Answer, BoxRequest, Budget, Error, Map, MapBoxes, MapMethod, MapOrBoxes, Range, Rational};
use jurist_algebra::number::to_decimal;
use jurist_draw::figures::map::{
    AxisWindow, MapContents, MapTrace, Role, WindowRequest, choose_windows, mechanism_words, trace_map,
};
use jurist_engine::stability::plane::boxes::Window;
use jurist_show::{map_boxes_text, map_text};
use serde::Deserialize;
use serde_json::{Value, json};

/// Digits to which limits are enclosed.
const DIGITS: usize = 12;
/// Points of a line closer than this, in sizes of the picture, are one.
const CLOSE: f64 = 0.0015;
/// Digits of the shares of the window.
const SHARE_DIGITS: usize = 3;

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
    #[serde(default)]
    method: Method,
    /// The share of the window that boxes may leave undecided.
    #[serde(default)]
    undecided: Option<String>,
    /// Units of work for the exact map, and for the boxes; without end where it is left out.
    #[serde(default)]
    work: Option<u64>,
}

/// How the map is made.
#[derive(Deserialize, Clone, Copy, Default, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Method {
    /// Exact, of a loop that has such a map.
    #[default]
    Exact,
    /// Boxes.
    Boxes,
    /// Exact; boxes where there is no such map, or it is not there after the work that is allowed.
    Auto,
}

/// Areas of stable cells and lines, or boxes; and the text of `jurist map`.
pub(crate) fn map(request: &MapRequest) -> Result<Value, Error> {
    let problem = problem(&request.model, &request.set, &[&request.x, &request.y])?;
    let limited = || request.work.map_or_else(budget, |units| budget().within_work(units));
    let mut windows = [WindowRequest::default(), WindowRequest::default()];
    for (window, ends) in windows.iter_mut().zip(request.window.iter().flatten()) {
        (window.lower, window.upper) = (Some(number(&ends[0])?), Some(number(&ends[1])?));
    }
    let sides = windows.each_ref().map(|w| Range::between(w.lower.clone(), w.upper.clone()));
    let share = request.undecided.as_deref().map_or_else(|| Ok(Rational::new(1.into(), 100.into())), number)?;
    let wanted = BoxRequest::new(sides, share);
    let boxes = |budget: &Budget| {
        let around = problem.around_nominal(&wanted, budget)?;
        problem.map_by(MapMethod::Boxes, &around, DIGITS, budget)
    };
    let (found, long) = match request.method {
        Method::Exact => (problem.map_by(MapMethod::Exact, &wanted, DIGITS, &budget())?, false),
        Method::Boxes => (boxes(&limited())?, false),
        Method::Auto => match problem.map_by(MapMethod::Auto, &wanted, DIGITS, &limited()) {
            // What looking for an exact map has taken is not missing for the boxes.
            Err(Error::Stopped(stopped)) if stopped.stop.is_budget() => (boxes(&limited())?, true),
            Ok(MapOrBoxes::Boxes(answer))
                if answer.value().no_exact_map.is_some() && answer.value().boxes.stopped.is_some() =>
            {
                (boxes(&limited())?, true)
            }
            found => (found?, false),
        },
    };
    match found {
        MapOrBoxes::Exact(answer) => exact(&answer, windows, &budget()),
        MapOrBoxes::Boxes(answer) => Ok(by_boxes(&answer, long)),
    }
}

/// Areas and lines.
fn exact(answer: &Answer<Map>, windows: [WindowRequest; 2], budget: &Budget) -> Result<Value, Error> {
    let trace = trace_map(answer, choose_windows(answer, &[], &windows), budget)?;
    let contents = MapContents::new(answer, &trace, Vec::new(), budget)?;
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
            "words": mechanism_words(causes, answer), "causes": causes.to_string(),
            "limits": wall.role == Role::Stable, "points": spaced(&wall.points),
        })
    });
    Ok(json!({
        "x": axis(0), "y": axis(1), "floating_point": true,
        "walls": walls.collect::<Vec<_>>(),
        "areas": areas(answer, &trace),
        "never": answer.value().decomposition.never_stable,
        "regions": answer.value().decomposition.regions.len(),
        "text": map_text(answer.problem(), Ok(answer.value()), DIGITS),
    }))
}

/// The boxes by their verdicts, each by its lower left and upper right corner, and the shares of the window in percent.
fn by_boxes(answer: &Answer<MapBoxes>, long: bool) -> Value {
    let MapBoxes { boxes: map, no_exact_map, .. } = answer.value();
    let window = &map.window;
    let axis = |k: usize, [lower, upper]: &[Rational; 2]| {
        let free = &answer.problem().free()[k];
        let [lower, upper] = [lower, upper].map(Rational::to_f64_approximate);
        json!({ "name": free.name, "unit": free.unit, "log": false, "lower": lower, "upper": upper })
    };
    let place = |value: &Rational, [lower, upper]: &[Rational; 2]| {
        let share = (value - lower).checked_div(&(upper - lower)).map_or(0.0, |share| share.to_f64_approximate());
        (share * 1e5).round() / 1e5
    };
    let with = |verdict: &str| -> Vec<[f64; 4]> {
        let all = map.boxes.iter().filter(|b| b.verdict.name() == verdict).map(|b| &b.window);
        let corner = |w: &Window, k: usize| [place(&w.x[k], &window.x), place(&w.y[k], &window.y)];
        all.map(|w| [corner(w, 0), corner(w, 1)].concat().try_into().unwrap_or_default()).collect()
    };
    let whole = window.area();
    let share = |area: &Rational| {
        let percent = area.checked_div(&whole).map(|share| share * Rational::from(100));
        percent.map(|percent| to_decimal(&percent, SHARE_DIGITS))
    };
    json!({
        "x": axis(0, &window.x), "y": axis(1, &window.y), "floating_point": true,
        "boxes": { "stable": with("stable"), "unstable": with("unstable"), "undecided": with("undecided") },
        "shares": {
            "stable": share(&map.areas.stable), "unstable": share(&map.areas.unstable),
            "undecided": share(&map.areas.undecided),
        },
        "stopped": map.stopped.is_some(),
        // There is an exact map, which takes more work.
        "long": long || no_exact_map.is_some(),
        "text": map_boxes_text(answer.problem(), Ok(answer.value()), DIGITS),
    })
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
