//! The worst corner of the tolerances that stand in the model.

use super::limits::PLACES;
use super::part::{Missing, Parts, Work};
use crate::page::{Table, escaped, math, paragraph};
use jurist_algebra::number::{parse_number, to_decimal};
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use jurist_engine::problem::Question;
use jurist_show::documents::{Answered, Exact, Tolerance, ToleranceFound};
use jurist_show::{Document, Text};

/// About half a second of one core.
const WORK: Work = Work::Units(50_000_000);

pub(super) fn section(question: &Question, parts: &Parts<'_>) -> String {
    let request = ToleranceRequest::of_model(question.model());
    if request.tolerances.is_empty() {
        return paragraph(
            "The model names no tolerances, so there is no worst corner. <code>tolerance = \"10%\"</code> beside a value \
             gives one; <code>jurist tolerance --all 10%</code> asks without changing the model.",
        );
    }
    let ask = |request: &ToleranceRequest| {
        parts.part("the box of tolerances", WORK, |budget| question.clone().tolerance(request, budget))
    };
    match ask(&request) {
        Err(missing @ Missing::TooLong) => {
            // The box alone may be decided where its greatest factor is long.
            let decision =
                ask(&request.clone().box_alone()).map(|answer| decision(&answer.text(PLACES))).unwrap_or_default();
            let help = "<code>jurist tolerance</code> finds how far they can grow, and the worst corner.";
            decision + &missing.html() + &paragraph(help)
        }
        Err(missing) => missing.html(),
        Ok(answer) => of_answer(&answer),
    }
}

/// The decision, which stands below the title of the text.
fn decision(text: &str) -> String {
    paragraph(&format!("<b>{}</b>.", math(text.lines().nth(1).unwrap_or_default())))
}

fn of_answer(answer: &Answer<ToleranceAnswer>) -> String {
    let text = answer.text(PLACES);
    let lines: Vec<&str> = text.lines().collect();
    let mut html = decision(&text);
    let Tolerance { answer: Answered::Known(found), .. } = answer.json(PLACES) else { return html };
    let growth = found.factor.as_ref().map(|factor| {
        let upper = factor.upper.as_ref().map(|u| format!(", not at {}", at_least(u))).unwrap_or_default();
        format!("Proved stable while all tolerances are scaled by up to {}{upper}.", factor.decimal)
    });
    html.extend(growth.map(|text| paragraph(&math(&text))));
    html.push_str(&table(&found).html());
    let worst = found.worst.as_ref().and_then(|worst| {
        let cause = worst.cause.as_ref()?;
        let at = worst.frequency.frequency_hz.as_ref().map(|f| format!(" at {f} Hz")).unwrap_or_default();
        Some(format!("What happens at the worst point, scaled until stability is lost: {cause}{at}."))
    });
    html.extend(worst.map(|text| paragraph(&math(&text))));
    let all = lines.iter().map(|line| escaped(line)).collect::<Vec<_>>().join("\n");
    html + &format!("<details><summary>The whole answer</summary><pre>{all}</pre></details>\n")
}

/// A bound as a decimal that is long enough to be told from its neighbour.
fn at_least(value: &Exact) -> String {
    parse_number(value.as_str()).map_or_else(|_| value.as_str().to_owned(), |v| to_decimal(&v, PLACES + 2))
}

fn table(found: &ToleranceFound) -> Table {
    let mut table = Table::new(
        "The box of tolerances and its worst corner",
        &["name", "least", "greatest", "worst", "share of the margin"],
    );
    let shown = |value: &Exact| parse_number(value.as_str()).map_or_else(|_| String::new(), |v| to_decimal(&v, PLACES));
    for (name, [low, high]) in found.bounds.entries() {
        let worst =
            found.worst.as_ref().and_then(|w| w.signs.entries().iter().find(|(n, _)| n == name).map(|(_, sign)| sign));
        let worst = match worst.map(String::as_str) {
            Some("-") => "least",
            Some("+") => "greatest",
            Some(_) => "inside",
            None => "not known",
        };
        let share = found.shares.as_ref().and_then(|s| s.entries().iter().find(|(n, _)| n == name)?.1.as_f64());
        let share = share.map_or_else(String::new, |s| format!("{:.3} %", 100.0 * s));
        table.rows.push(vec![name.clone(), shown(low), shown(high), worst.to_owned(), share]);
    }
    table
}
