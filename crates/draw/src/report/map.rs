//! The map of the two numbers whose limits are nearest: exact, or of boxes where that is long.

use super::around_nominal;
use super::limits::{Limits, by_margin};
use super::part::{Missing, Part, Parts, Work};
use crate::figures::Figure;
use crate::figures::map::{MapContents, WindowRequest, boxes_figure, choose_windows, trace_map};
use crate::page::{escaped, figure, math, paragraph};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::{Answer, BoxRequest, MapBoxes, MapMethod, MapOrBoxes};
use jurist_engine::error::Error;
use jurist_engine::problem::Question;
use jurist_engine::stability::{Cause, End, Range, StableSet};
use jurist_show::region::goal_or_stable;

/// Width and height of a map.
const SIZE: (f64, f64) = (860.0, 600.0);

/// Of the exact map, about half a second of one core.
const WORK: Work = Work::Units(50_000_000);

/// Boxes end with nine tenths of this, and are drawn as far as they are decided; with the other number the part is left out. About three quarters of a second of
/// one core.
const BOXES: (u64, Work) = (75_000_000, Work::Units(71_000_000));

/// The share of the window that boxes may leave undecided.
const UNDECIDED: (i64, i64) = (1, 50);

pub(super) fn section(question: &Question, limits: &[Limits], parts: &Parts<'_>) -> String {
    let order = by_margin(limits);
    let (names, why) = match order.as_slice() {
        [first, second, ..] => (
            [*first, *second].map(|a| a.problem().parameter().name.clone()),
            "the limits are nearest to the nominal point",
        ),
        [only] => match second(question, &only.problem().parameter().name) {
            Some(second) => {
                ([only.problem().parameter().name.clone(), second], "there is one parameter and one number beside it")
            }
            None => {
                return paragraph("One number is open: a map needs two. <code>jurist map</code> takes constants too.");
            }
        },
        [] => return paragraph("No stable set of a parameter is known, so it is not clear which two would matter."),
    };
    let shown = names.join(" and ");
    let chosen = paragraph(&math(&format!("Of {shown} {why}.")));
    match drawn(question, &names, &order, parts) {
        Err(missing) => {
            let [x, y] = names.each_ref().map(|name| escaped(name));
            let help = format!("<code>jurist map -x {x} -y {y}</code> has no limit of work.");
            chosen + &missing.html() + &paragraph(&help)
        }
        Ok((picture, caption)) => chosen + &figure("map", &picture, &caption),
    }
}

/// The number beside the only parameter: the first with a tolerance, else the first.
fn second(question: &Question, parameter: &str) -> Option<String> {
    let numbers = || {
        let constants = question.model().constants().iter();
        constants.filter(|c| c.name != parameter && c.number.as_ref().is_some_and(|number| !number.is_zero()))
    };
    let found = numbers().find(|c| c.tolerance.is_some()).or_else(|| numbers().next());
    found.map(|constant| constant.name.clone())
}

/// The picture and its caption.
fn drawn(
    question: &Question,
    names: &[String; 2],
    order: &[&Answer<StableSet>],
    parts: &Parts<'_>,
) -> Part<(Figure, String)> {
    let shown = names.join(" and ");
    let goal = order.first().map_or_else(|| "stable".to_owned(), |a| goal_or_stable(a.problem()));
    let exact = parts.part("map", WORK, |budget| exact(question, names, budget));
    match exact {
        Ok(picture) => {
            let drawn = "drawn in floating point around cells decided exactly";
            Ok((picture, format!("Where the loop is {goal} in the plane of {shown}: {drawn}")))
        }
        Err(Missing::Stopped(stop)) => Err(Missing::Stopped(stop)),
        // It is long, or there is none.
        Err(_) => parts.part("map by boxes", BOXES.1, |budget| {
            let found = by_boxes(question, names, order, &budget.clone().within_work(BOXES.0))?;
            let picture = boxes_figure(&found, SIZE.0, SIZE.1);
            Ok((picture, format!("Where the loop is {goal} in the plane of {shown}: {}", said(&found))))
        }),
    }
}

fn exact(question: &Question, [first, second]: &[String; 2], budget: &Budget) -> Result<Figure, Error> {
    let answer = question.clone().free(first).free(second).map(10, budget)?;
    let windows = choose_windows(&answer, &[], &[WindowRequest::default(), WindowRequest::default()]);
    let trace = trace_map(&answer, windows, budget)?;
    Ok(MapContents::new(&answer, &trace, Vec::new(), budget)?.draw(SIZE.0, SIZE.1, true).figure)
}

fn by_boxes(
    question: &Question,
    names: &[String; 2],
    order: &[&Answer<StableSet>],
    budget: &Budget,
) -> Result<Answer<MapBoxes>, Error> {
    let problem = question.clone().free(&names[0]).free(&names[1]).plane_problem()?;
    let window = |name: &String| {
        let known = order.iter().find(|a| a.problem().parameter().name == *name);
        known.map_or_else(Range::all, |answer| window_of(answer))
    };
    let undecided = Rational::new(UNDECIDED.0.into(), UNDECIDED.1.into());
    let request = BoxRequest::new(names.each_ref().map(window), undecided);
    match problem.map_by(MapMethod::Boxes, &request, 10, budget)? {
        MapOrBoxes::Boxes(found) => Ok(*found),
        // Undefined everywhere.
        MapOrBoxes::Exact(_) => unreachable!("boxes were asked for"),
    }
}

/// A window around the stable interval of the nominal value, a quarter wider where stability ends; open where that has no end.
fn window_of(answer: &Answer<StableSet>) -> Range {
    let Some(interval) = around_nominal(answer) else { return Range::all() };
    let middle = |end: &End| {
        let (low, high) = end.value.refined_to_digits(4).enclosure();
        low.midpoint(&high)
    };
    let (Some(lower), Some(upper)) = (&interval.lower, &interval.upper) else { return Range::all() };
    let [low, high] = [lower, upper].map(middle);
    let more = (&high - &low) / Rational::from(4);
    let wider = |end: &End| {
        if end.causes.contains(Cause::Domain) { Rational::ZERO } else { more.clone() }
    };
    Range::between(Some(&low - &wider(lower)), Some(&high + &wider(upper)))
}

/// What the boxes say, and how much of the window they leave open.
fn said(found: &Answer<MapBoxes>) -> String {
    let areas = &found.value().boxes.areas;
    let whole = &(&areas.stable + &areas.unstable) + &areas.undecided;
    let share = areas.undecided.checked_div(&whole).unwrap_or(Rational::ZERO) * Rational::from(100);
    let open = to_decimal(&share, 2);
    let end = match found.value().boxes.stopped {
        None => "",
        Some(_) => ", where the work that one page is worth ended",
    };
    format!("boxes proved stable, boxes proved not stable; {open} % of the window is undecided{end}")
}
