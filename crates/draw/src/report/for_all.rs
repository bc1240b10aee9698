//! What holds for all values of other names: the values of each parameter, and how much of each margin.

use super::ReportRequest;
use super::limits::{DIGITS, PLACES};
use super::part::{Parts, Work};
use crate::page::{escaped, paragraph};
use jurist_algebra::limits::parallel_map;
use jurist_engine::problem::Question;
use jurist_engine::response::{MapForAll, Requirements};
use jurist_show::for_all_text;
use jurist_show::{Text, required_text};

/// Work of the sets of all parameters together, which they share evenly, and the least of one: about a second of one core, and a fifth.
const WORK: u64 = 100_000_000;
const LEAST_WORK: u64 = 20_000_000;

/// About a second of one core.
const MARGINS: Work = Work::Units(100_000_000);

pub(super) fn section(question: &Question, request: &ReportRequest<'_>, at: Option<&str>, parts: &Parts<'_>) -> String {
    let ranges = request.for_all;
    let Some(all) = for_all_text(ranges, PLACES) else { return String::new() };
    let model = question.model();
    let asked = match parts.part("the requirements", MARGINS, |budget| Requirements::of(model, &[], &[], budget)) {
        Err(missing) => return missing.html(),
        Ok(asked) => asked,
    };
    let what = if model.require().is_empty() { "stable" } else { "stable and meet what is required" };
    let lead = format!(
        "What is said here holds {all}, ends included. The values of one parameter are those that are {what} for all of these."
    );
    let is_other =
        |name: &String| !question.values_set().contains_key(name) && ranges.iter().all(|range| range.name != *name);
    let names: Vec<String> = model.parameters().iter().map(|p| p.name.clone()).filter(is_other).collect();
    let work = Work::Units((WORK / names.len().max(1) as u64).max(LEAST_WORK));
    let sets: Vec<String> = parallel_map(names, |name: String| {
        let found = parts.part(&format!("{name} for all values"), work, |budget| {
            let one = MapForAll::new(ranges.to_vec()).with_requirements(asked.list.clone(), at.map(str::to_owned));
            let set = one.intervals(within(question, &asked).free(&name), budget)?;
            Ok(required_text(&set, &asked.list, DIGITS))
        });
        match found {
            Ok(text) => without_heading(&text),
            Err(missing) => format!("<p><b>{}</b>: {}</p>\n", escaped(&name), escaped(&missing.sentence())),
        }
    });
    let margins = parts.part("margins for all values", MARGINS, |budget| {
        let one = MapForAll::new(ranges.to_vec()).with_requirements(Vec::new(), at.map(str::to_owned));
        Ok(one.least_margins(question.clone(), budget)?.text(PLACES))
    });
    let margins = margins.map_or_else(|missing| missing.html(), |text| without_heading(&text));
    paragraph(&escaped(&lead)) + &sets.concat() + "<h3>Margins</h3>\n" + &margins
}

/// The question within the region that the model requires.
fn within(question: &Question, asked: &Requirements) -> Question {
    asked.region.iter().fold(question.clone(), |question, region| question.within(region.clone()))
}

/// The lines below the title of the model, which is that of the page.
fn without_heading(text: &str) -> String {
    let lines: Vec<String> = text.lines().skip(1).map(escaped).collect();
    format!("<pre>{}</pre>\n", lines.join("\n"))
}
