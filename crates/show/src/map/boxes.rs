//! The answer by boxes for people.

use super::super::intervals::{heading, undecided_text};
use super::super::layout::percent;
use super::super::region::goal_or_stable;
use super::text::axis_text;
use crate::Text;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::{Answer, MapBoxes};
use jurist_engine::problem::Problem;
use jurist_engine::response::{AllOf, RequiredBoxes};
use jurist_engine::stability::plane::boxes::{BoxVerdict, Window};

impl Text for Answer<MapBoxes> {
    /// The answer for people: areas by verdict, and the extent of the stable boxes.
    fn text(&self, digits: usize) -> String {
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
            boxes_text(&mut out, answer, &goal_or_stable(problem), [&x.name, &y.name], digits);
            if let Some(found) = &answer.required {
                required_text(&mut out, found, &answer.boxes.window, [&x.name, &y.name], digits);
            }
            if let Some(stopped) = &answer.no_exact_map {
                out.push_str(&format!("    no exact map: {stopped}\n"));
            }
        }
    }
    out
}

/// The names for all of whose values the answer holds: `for all b from -1 to 2`; `None` where there are none.
pub fn for_all_text(ranges: &[AllOf], digits: usize) -> Option<String> {
    let closed = |all: &AllOf| {
        let [least, greatest] = all.range.each_ref().map(|x| to_decimal(x, digits));
        format!("{} from {least} to {greatest}", all.name)
    };
    let all: Vec<String> = ranges.iter().map(closed).collect();
    (!all.is_empty()).then(|| format!("for all {}", all.join(", ")))
}

fn boxes_text(out: &mut String, answer: &MapBoxes, goal: &str, names: [&str; 2], digits: usize) {
    let map = &answer.boxes;
    let window = &map.window;
    out.push_str(&format!("{}, {}\n", span(names[0], &window.x, digits), span(names[1], &window.y, digits)));
    if let Some(all) = for_all_text(&answer.for_all, digits) {
        out.push_str(&format!("    {all}\n"));
    }
    let unstable = if answer.for_all.is_empty() { "unstable" } else { "not for all" };
    for (name, area, wanted) in [
        (goal, &map.areas.stable, BoxVerdict::Stable.name()),
        (unstable, &map.areas.unstable, "unstable"),
        ("undecided", &map.areas.undecided, "undecided"),
    ] {
        let count = map.boxes.iter().filter(|b| b.verdict.name() == wanted).count();
        out.push_str(&share_line(name, area, &window.area(), count));
    }
    let stable = map.boxes.iter().filter(|b| b.verdict == BoxVerdict::Stable).map(|b| &b.window);
    out.push_str(&extent(&format!("the {} boxes", BoxVerdict::Stable.name()), stable, names, digits));
    if let Some(budget) = &map.stopped {
        out.push_str(&format!("    stopped early, the budget ran out: {budget}\n"));
    }
}

/// In how much of the window the stable loop meets what is required.
fn required_text(out: &mut String, found: &RequiredBoxes, window: &Window, names: [&str; 2], digits: usize) {
    let at = found.at.as_ref().map(|at| format!(", the loop cut at '{at}'")).unwrap_or_default();
    let asked: Vec<String> = found.requirements.iter().map(|r| r.text()).collect();
    out.push_str(&format!("inside the stable boxes{at}: {}\n", asked.join(", ")));
    for (name, area, met) in [
        ("met", &found.areas.met, Some(true)),
        ("not met", &found.areas.unmet, Some(false)),
        ("undecided", &found.areas.undecided, None),
    ] {
        let count = found.boxes.iter().filter(|b| b.met == met).count();
        out.push_str(&share_line(name, area, &window.area(), count));
    }
    let met = found.boxes.iter().filter(|b| b.met == Some(true)).map(|b| &b.window);
    out.push_str(&extent("the boxes that meet it", met, names, digits));
    if let Some(budget) = &found.stopped {
        out.push_str(&format!("    stopped early, the budget ran out: {budget}\n"));
    }
}

fn share_line(name: &str, area: &Rational, whole: &Rational, count: usize) -> String {
    let share = area.checked_div(whole).expect("a window has an area");
    let boxes = if count == 1 { "box" } else { "boxes" };
    format!("    {name}: {} of the window, in {count} {boxes}\n", percent(&share, 4))
}

/// How far boxes reach; nothing where there are none.
fn extent<'w>(what: &str, boxes: impl Iterator<Item = &'w Window>, names: [&str; 2], digits: usize) -> String {
    let boxes: Vec<&Window> = boxes.collect();
    let along = |side: fn(&Window) -> &[Rational; 2]| {
        let low = boxes.iter().map(|w| &side(w)[0]).min()?;
        let high = boxes.iter().map(|w| &side(w)[1]).max()?;
        Some([low.clone(), high.clone()])
    };
    match (along(|w| &w.x), along(|w| &w.y)) {
        (Some(across), Some(up)) => {
            format!("    {what} reach over {}, {}\n", span(names[0], &across, digits), span(names[1], &up, digits))
        }
        _ => String::new(),
    }
}

fn span(name: &str, [low, high]: &[Rational; 2], digits: usize) -> String {
    format!("{} < {name} < {}", to_decimal(low, digits), to_decimal(high, digits))
}
