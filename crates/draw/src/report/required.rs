//! What the model's section `[require]` asks for, met or not, and what is left.

use super::limits::PLACES;
use super::part::{Part, Parts, Work};
use crate::page::{Table, math, paragraph};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::Verdict;
use jurist_engine::error::Error;
use jurist_engine::problem::{Problem, Question};
use jurist_engine::response::Requirements;
use jurist_show::{margin_left, required_value};
use std::sync::Arc;

/// About half a second of one core.
const WORK: Work = Work::Units(50_000_000);

/// One requirement at the nominal point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Met {
    /// `phase margin >= 45 deg`
    what: String,
    /// What the loop has.
    found: Option<String>,
    /// How much more than required that is, in percent.
    left: Option<String>,
    is_met: bool,
}

/// All of them; none where the model requires nothing.
pub(super) fn find(
    question: &Question,
    problem: &Part<Arc<Problem>>,
    at: Option<&str>,
    parts: &Parts<'_>,
) -> Part<Vec<Met>> {
    let problem = problem.as_ref().map_err(Clone::clone)?;
    let model = question.model();
    if model.require().is_empty() {
        return Ok(Vec::new());
    }
    parts.part("the requirements", WORK, |budget| {
        let asked = Requirements::of(model, &[], problem.set(), budget)?;
        let percent = |left: &Rational| to_decimal(&(left * &Rational::from(100)), 3);
        let mut out = Vec::new();
        for one in problem.requirements_met(&asked.list, at, budget)? {
            out.push(Met {
                what: one.requirement.text().replace('_', " "),
                found: required_value(&one, PLACES),
                left: margin_left(&one).map(|left| format!("{} %", percent(&left))),
                is_met: one.met,
            });
        }
        out.extend(of_region(question, &asked, budget)?);
        Ok(out)
    })
}

/// Requirements that say where all roots have to lie.
fn of_region(question: &Question, asked: &Requirements, budget: &Budget) -> Result<Vec<Met>, Error> {
    let Some(region) = asked.region.clone() else { return Ok(Vec::new()) };
    let within = question.clone().within(region).problem()?.verdict(budget)?;
    let is_met = within.value().verdict == Verdict::Stable;
    let met = |(name, text): &(String, String)| Met {
        what: format!("{} {text}", name.replace('_', " ")),
        found: None,
        left: None,
        is_met,
    };
    Ok(asked.regional.iter().map(met).collect())
}

/// ` Required: all 2 met.`, for the head of the page.
pub(super) fn sentence(required: &Part<Vec<Met>>) -> Option<String> {
    let all = match required {
        Err(missing) => return Some(format!("What is required of it is not decided here: {}", missing.sentence())),
        Ok(all) => all,
    };
    let failed: Vec<&str> = all.iter().filter(|one| !one.is_met).map(|one| one.what.as_str()).collect();
    Some(match (all.as_slice(), failed.as_slice()) {
        ([], _) => return None,
        ([one], []) => format!("It meets its requirement, {}{}.", one.what, left(one)),
        (all, []) => {
            let named: Vec<String> = all.iter().map(|one| format!("{}{}", one.what, left(one))).collect();
            format!("It meets all {} requirements: {}.", all.len(), named.join("; "))
        }
        (_, failed) => format!("It does not meet {}.", failed.join("; ")),
    })
}

fn left(one: &Met) -> String {
    one.left.as_ref().map(|left| format!(" ({left} left)")).unwrap_or_default()
}

/// The table of them, below the verdict.
pub(super) fn html(required: &Part<Vec<Met>>) -> String {
    let heading = "<h3>What is required</h3>\n".to_owned();
    let all = match required {
        Ok(all) if all.is_empty() => return String::new(),
        Ok(all) => all,
        Err(missing) => return heading + &missing.html(),
    };
    let mut table = Table::new("Requirements", &["required", "at the nominal point", "found", "left"]);
    for one in all {
        let verdict = if one.is_met { "met" } else { "not met" };
        let cell = |text: &Option<String>| text.clone().unwrap_or_else(|| "–".to_owned());
        table.rows.push(vec![one.what.clone(), verdict.to_owned(), cell(&one.found), cell(&one.left)]);
    }
    let note = "The section [require] of the model asks for these. What is left is the share of the required number by which the \
                loop has more, or less where a number bounds it from above. Limits below are those of stability alone.";
    heading + &table.html() + &paragraph(&math(note))
}
