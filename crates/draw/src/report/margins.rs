//! The loop's margins, its Bode diagram and its Nyquist curve, where it is clear where the loop is cut.

use super::limits::{DIGITS, PLACES};
use super::part::{Missing, Part, Parts, Work};
use crate::figures::{bode, frequency_response, nyquist};
use crate::page::{Table, escaped, figure, math, paragraph};
use jurist_algebra::number::Rational;
use jurist_engine::answer::Answer;
use jurist_engine::problem::Problem;
use jurist_engine::response::Margins;
use jurist_show::{Text, margin_sentences};
use std::sync::Arc;

/// About half a second of one core.
const WORK: Work = Work::Units(50_000_000);

pub(super) fn find(problem: &Part<Arc<Problem>>, at: Option<&str>, parts: &Parts<'_>) -> Part<Answer<Margins>> {
    let problem = problem.as_ref().map_err(Clone::clone)?;
    let all = parts.part("margins", WORK, |budget| problem.margins(at, &Rational::ZERO, budget));
    match all {
        // What takes the longest is the dead time behind a hold.
        Err(Missing::TooLong) => {
            parts.part("margins", WORK, |budget| problem.margins_without_held_delay(at, &Rational::ZERO, budget))
        }
        all => all,
    }
}

pub(super) fn section(margins: &Part<Answer<Margins>>, parts: &Parts<'_>) -> String {
    let answer = match margins {
        Err(missing) => return missing.html(),
        Ok(answer) => answer,
    };
    let cut = answer.value().open_loop.cut().name();
    let mut html = paragraph(&format!(
        "The loop is cut at <b>{}</b>: what comes back there is the open loop; 1 is its nominal factor.",
        math(cut)
    ));
    // The digits of a margin are found here: that is work as well.
    let written =
        parts.part("digits of the margins", WORK, |_| Ok((margin_sentences(answer, PLACES), answer.text(DIGITS))));
    let (sentences, text) = match written {
        Err(missing) => return html + &missing.html(),
        Ok(written) => written,
    };
    if sentences.is_empty() {
        html.push_str(&paragraph("The loop is not stable at the nominal point: only a stable loop has margins."));
    } else {
        let mut table = Table::new("Margins", &["margin", "value, and where it binds"]);
        table.rows.extend(sentences.into_iter().map(|(name, text)| vec![name.to_owned(), text]));
        html.push_str(&table.html());
    }
    let text = text.lines().map(escaped).collect::<Vec<_>>().join("\n");
    html + &format!("<details><summary>All crossings of the open loop</summary><pre>{text}</pre></details>\n")
}

pub(super) fn bode_section(margins: &Part<Answer<Margins>>, parts: &Parts<'_>) -> String {
    let answer = match margins {
        Err(missing) => return missing.html(),
        Ok(answer) => answer,
    };
    let drawn = parts.part("Bode diagram", WORK, |budget| {
        let response = frequency_response(answer.value(), budget)?;
        Ok([bode(answer, &response), nyquist(answer, &response)])
    });
    match drawn {
        Err(missing) => missing.html(),
        Ok([first, second]) => {
            let drawn = "the curves are floating point, the marked crossings are exact";
            figure("bode", &first, &format!("Magnitude and phase of the open loop; {drawn}"))
                + &figure("nyquist", &second, &format!("The open loop around -1; {drawn}"))
        }
    }
}
