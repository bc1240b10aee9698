//! The document `jurist/map-boxes/1`, and the answer by boxes for people.
//!
//! The document has the question's fields as `jurist/map/1` has them, then
//! `window` (`{x: [LO, HI], y: [LO, HI]}`), `goal` (the share of its area that may stay undecided), `curves` (as in
//! `jurist/map/1`), `areas` (`window`, `stable`, `unstable`, `undecided`, which add up), `boxes` (sorted by lower `x`, then
//! lower `y`; each `{x: [LO, HI], y: [LO, HI], verdict, outside}`, open, `outside` being the number of roots outside where
//! it is known to be the same at all points, else `null`) and `stopped` (`null`, or the budget that ran out before
//! the goal). All numbers are exact. `boxes` is `null` with `undecided` where not even the curves were found.

use super::super::intervals::{heading, undecided_text};
use super::super::json;
use super::super::region::goal_or_stable;
use super::document::{curve_json, question_fields};
use super::text::axis_text;
use crate::answer::{Answer, MapBoxes};
use crate::problem::Problem;
use crate::stability::plane::boxes::{BoxMap, BoxVerdict, PlaneBox, Window};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Rational, to_decimal};
use serde_json::{Value, json};

impl Answer<MapBoxes> {
    /// The document `jurist/map-boxes/1`.
    pub fn json(&self) -> Value {
        map_boxes_json(self.problem(), Ok(self.value()))
    }

    /// The answer for people: areas by verdict, and the extent of the stable boxes.
    pub fn text(&self, digits: usize) -> String {
        map_boxes_text(self.problem(), Ok(self.value()), digits)
    }
}

/// The document `jurist/map-boxes/1`, also of an answer that the budget did not allow.
pub fn map_boxes_json(problem: &Problem, answer: Result<&MapBoxes, &Exhausted>) -> Value {
    let mut out = question_fields(problem, "jurist/map-boxes/1");
    match answer {
        Ok(MapBoxes { goal, boxes: map }) => {
            out.insert("window".into(), window_json(&map.window));
            out.insert("goal".into(), goal.to_string().into());
            out.insert("curves".into(), map.curves.iter().map(curve_json).collect::<Vec<_>>().into());
            out.insert(
                "areas".into(),
                json!({
                    "window": map.window.area().to_string(),
                    "stable": map.areas.stable.to_string(),
                    "unstable": map.areas.unstable.to_string(),
                    "undecided": map.areas.undecided.to_string(),
                }),
            );
            out.insert("boxes".into(), map.boxes.iter().map(box_json).collect::<Vec<_>>().into());
            out.insert("stopped".into(), map.stopped.as_deref().map_or(Value::Null, Value::from));
        }
        Err(stopped) => json::undecided(&mut out, &["boxes"], stopped),
    }
    Value::Object(out)
}

fn window_json(window: &Window) -> Value {
    let side = |[low, high]: &[Rational; 2]| json!([low.to_string(), high.to_string()]);
    json!({ "x": side(&window.x), "y": side(&window.y) })
}

fn box_json(b: &PlaneBox) -> Value {
    let mut out = window_json(&b.window);
    let outside = match b.verdict {
        BoxVerdict::Stable => json!(0),
        BoxVerdict::Unstable { outside } => outside.map_or(Value::Null, Value::from),
        BoxVerdict::Undecided => Value::Null,
    };
    out["verdict"] = b.verdict.name().into();
    out["outside"] = outside;
    out
}

/// The answer for people, also one that the budget did not allow.
pub fn map_boxes_text(problem: &Problem, answer: Result<&MapBoxes, &Exhausted>, digits: usize) -> String {
    let [x, y] = problem.axes();
    let mut out = format!("{}\n{} against {}, by boxes: ", heading(problem), axis_text(x), axis_text(y));
    match answer {
        Err(stopped) => out.push_str(&format!("{}\n", undecided_text(stopped))),
        Ok(answer) => boxes_text(&mut out, &answer.boxes, &goal_or_stable(problem), [&x.name, &y.name], digits),
    }
    out
}

fn boxes_text(out: &mut String, map: &BoxMap, goal: &str, names: [&str; 2], digits: usize) {
    let ([x, y], window) = (names, &map.window);
    let span = |name: &str, [low, high]: &[Rational; 2]| {
        format!("{} < {name} < {}", to_decimal(low, digits), to_decimal(high, digits))
    };
    out.push_str(&format!("{}, {}\n", span(x, &window.x), span(y, &window.y)));
    let whole = window.area();
    for (name, area, wanted) in [
        (goal, &map.areas.stable, BoxVerdict::Stable.name()),
        ("unstable", &map.areas.unstable, "unstable"),
        ("undecided", &map.areas.undecided, "undecided"),
    ] {
        let share = area.checked_div(&whole).expect("a window has an area") * Rational::from(100);
        let count = map.boxes.iter().filter(|b| b.verdict.name() == wanted).count();
        let percent = to_decimal(&share, 4);
        out.push_str(&format!(
            "    {name}: {percent} % of the window, in {count} box{}\n",
            if count == 1 { "" } else { "es" }
        ));
    }
    let stable: Vec<&Window> =
        map.boxes.iter().filter(|b| b.verdict == BoxVerdict::Stable).map(|b| &b.window).collect();
    let extent = |side: fn(&Window) -> &[Rational; 2]| {
        let low = stable.iter().map(|w| &side(w)[0]).min()?;
        let high = stable.iter().map(|w| &side(w)[1]).max()?;
        Some([low.clone(), high.clone()])
    };
    if let (Some(across), Some(up)) = (extent(|w| &w.x), extent(|w| &w.y)) {
        out.push_str(&format!("    the stable boxes reach over {}, {}\n", span(x, &across), span(y, &up)));
    }
    if let Some(budget) = &map.stopped {
        out.push_str(&format!("    stopped early, the budget ran out: {budget}\n"));
    }
}
