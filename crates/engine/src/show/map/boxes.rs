//! The answer by boxes for people.

use super::super::intervals::{heading, undecided_text};
use super::super::region::goal_or_stable;
use super::text::axis_text;
use crate::answer::{Answer, MapBoxes};
use crate::problem::Problem;
use crate::stability::plane::boxes::{BoxMap, BoxVerdict, Window};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Rational, to_decimal};

impl Answer<MapBoxes> {
    /// The answer for people: areas by verdict, and the extent of the stable boxes.
    pub fn text(&self, digits: usize) -> String {
        map_boxes_text(self.problem(), Ok(self.value()), digits)
    }
}

/// The answer for people, also one that the budget did not allow.
pub fn map_boxes_text(problem: &Problem, answer: Result<&MapBoxes, &Exhausted>, digits: usize) -> String {
    let [x, y] = problem.axes();
    let mut out = format!("{}\n{} against {}, by boxes: ", heading(problem), axis_text(x), axis_text(y));
    match answer {
        Err(stopped) => out.push_str(&format!("{}\n", undecided_text(stopped))),
        Ok(answer) => {
            boxes_text(&mut out, &answer.boxes, &goal_or_stable(problem), [&x.name, &y.name], digits);
            if let Some(stopped) = &answer.no_exact_map {
                out.push_str(&format!("    no exact map: {stopped}\n"));
            }
        }
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
