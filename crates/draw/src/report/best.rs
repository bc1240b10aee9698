//! The best gains, where the model asks for them.

use super::ReportRequest;
use super::part::{Parts, Work};
use crate::page::{escaped, paragraph};

/// About a second of one core.
const WORK: Work = Work::Units(100_000_000);

pub(super) fn section(request: &ReportRequest<'_>, parts: &Parts<'_>) -> String {
    let Some(best) = request.best else { return String::new() };
    match parts.part("the best gains", WORK, best) {
        Ok(text) => {
            let lead = "What the section <code>[tune]</code> asks for, as <code>jurist tune</code> answers it.";
            let lines: Vec<String> = text.lines().map(escaped).collect();
            format!("{}<pre>{}</pre>\n", paragraph(lead), lines.join("\n"))
        }
        Err(missing) => missing.html(),
    }
}
