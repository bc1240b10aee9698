//! Root locus and step response.

use super::limits::{Limits, by_margin};
use super::part::{Part, Parts, Work};
use crate::document::SimulationAnswer;
use crate::figures::{Figure, locus_of, locus_range, response_figure};
use crate::page::{figure, math, paragraph};
use crate::simulate::Course;
use jurist_algebra::limits::Budget;
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::problem::Problem;
use jurist_engine::stability::StableSet;
use std::sync::Arc;

/// About half a second of one core.
const WORK: Work = Work::Units(50_000_000);

/// Longer responses make no better picture.
const MOST_SAMPLES: f64 = 1e6;

pub(super) fn locus(limits: &[Limits], parts: &Parts<'_>) -> String {
    // A gain is what a locus is about; a time comes after.
    let order = by_margin(limits);
    let is_time =
        |a: &&Answer<StableSet>| a.problem().sample_time().is_some_and(|(n, d)| !(n.is_constant() && d.is_constant()));
    let gain = order.iter().copied().find(|a| !is_time(a));
    let Some(answer) = gain.or(order.first().copied()) else {
        return paragraph("No stable set of a parameter is known, so there is no locus to draw.");
    };
    let drawn = parts.part("root locus", WORK, |budget| {
        let range =
            locus_range(answer).ok_or_else(|| refused("the parameter has neither a limit nor a nominal value"))?;
        locus_of(answer, &range, None, budget)
    });
    let drawn = match drawn {
        Err(missing) => return missing.html(),
        Ok(drawn) => drawn,
    };
    let captions = [
        ("locus-whole", "The roots are floating point; colours and crossings are those of the exact answer"),
        ("locus-near", "The same, magnified where roots cross the boundary"),
    ];
    let parts = drawn.parts.iter().zip(captions).map(|(part, (name, caption))| figure(name, part, caption));
    let mut html = format!("<div class=\"grid two\">{}</div>\n", parts.collect::<String>());
    if !drawn.crossings.is_empty() {
        let lines: String = drawn.crossings.iter().map(|c| format!("<li>{}</li>", math(&c.label))).collect();
        html.push_str(&format!("<p>The boundary is crossed at</p><ul>{lines}</ul>\n"));
    }
    html
}

fn refused(why: &str) -> Error {
    Diagnostic::error(Code::Usage, why).into()
}

pub(super) fn response(
    problem: &Part<Arc<Problem>>,
    verdict: &Part<Answer<PointVerdict>>,
    parts: &Parts<'_>,
) -> String {
    let drawn = problem.as_ref().map_err(Clone::clone).and_then(|problem| {
        let verdict = verdict.as_ref().map_err(Clone::clone)?;
        parts.part("response", WORK, |budget| draw_response(problem, verdict, budget))
    });
    match drawn {
        Err(missing) => missing.html(),
        Ok((drawn, said)) => {
            paragraph(&math(&said)) + &figure("response", &drawn, "Response of the linear loop; floating point")
        }
    }
}

fn draw_response(
    problem: &Arc<Problem>,
    verdict: &Answer<PointVerdict>,
    budget: &Budget,
) -> Result<(Figure, String), Error> {
    let mut course = Course::of(problem, None, budget)?;
    if course.is_at_rest() {
        let first = course.step_first_input(problem.model());
        first.ok_or_else(|| refused("the model names no inputs and no initial values: nothing moves the loop"))?;
    }
    let words = |name: &str, value: f64| format!("{name} = {value}");
    let inputs = course.inputs.iter().filter(|(_, _, value)| *value != 0.0).map(|(n, _, v)| words(n, *v));
    let initial = course.initial.iter().filter(|(_, v)| *v != 0.0).map(|(n, v)| format!("{} at first", words(n, *v)));
    let said: Vec<String> = inputs.chain(initial).collect();
    let said = if said.is_empty() { "All inputs are 0.".to_owned() } else { format!("With {}.", said.join(", ")) };
    let run = course.run_within(problem, MOST_SAMPLES, budget)?;
    let answer = SimulationAnswer { trace: run.trace, sample_time: run.sample_time, circuit: None };
    Ok((response_figure(problem, &answer, &run.finals, verdict.value().verdict, course.is_duration_asked()), said))
}
