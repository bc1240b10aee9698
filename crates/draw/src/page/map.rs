//! A self-contained page: the picture, and the verdict at the pointer, looked up exactly.

use super::{document, escaped};
use crate::figures::dark_style;
use crate::figures::map::{FrequencyPoint, MapContents, MapFigure, Role, Wall, frequency_unit, mechanism_words};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::Monomial;
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::error::Error;
use jurist_engine::problem::Free;
use jurist_engine::stability::plane::Strip;
use jurist_show::documents::Exact;
use jurist_show::layout::{named_values, short};
use jurist_show::region::goal_or_stable;
use serde_json::{Value, json};

/// What of a page of maps is exact.
const CERTAIN: &str = "The picture is drawn in floating point. The verdict, the number of roots and the values of one \
    parameter at which the verdict changes (rounded to four digits) are not: they hold for exactly the numbers shown in the two \
    fields, which this page looks up with integers of any size in strips and cells that were computed and proved by exact algebra. A \
    point on a boundary is not stable.";
/// The same of a loop with constants that are not rational.
const CERTAIN_TO_BITS: &str = "The picture is drawn in floating point. The strips and cells, and with them the verdicts and the numbers \
    of roots, were computed and proved with exact constants, such as exp(-T/T_m). This page looks up the numbers shown in the two \
    fields with these constants rounded to more than a hundred digits: nearer than that to a boundary it may take one side for the other. A \
    point on a boundary is not stable.";
const STYLE: &str = include_str!("page.css");
pub(super) const SCRIPT: &str = include_str!("page.js");

/// The map as an HTML page that needs nothing from outside: the picture for wide and for narrow screens,
/// `text` below it, and a script that looks a point up in the exact strips with integers of any size.
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out.
pub fn map_page(
    answer: &Answer<Map>,
    contents: &MapContents<'_>,
    figures: &[MapFigure; 2],
    text: &str,
    budget: &Budget,
) -> Result<String, Error> {
    let [x, y] = answer.problem().axes();
    let title = match answer.problem().title().filter(|t| !t.is_empty()) {
        Some(title) => format!("Stability map: {title}"),
        None => "Stability map".to_owned(),
    };
    let others = if answer.problem().set().is_empty() {
        "Every other quantity has its value in the model.".to_owned()
    } else {
        format!("With {}.", named_values(answer.problem().set()))
    };
    let data = data(answer, contents, figures, budget)?.to_string().replace('<', "\\u003c");
    let body = format!(
        "<h1>{title}</h1>\n\
         <p class=\"small\">{x_name} from left to right, {y_name} upwards. {others}</p>\n\
         <div class=\"slice\"><div class=\"figure wide\">{wide}</div>\n<div class=\"figure narrow\">{narrow}</div></div>\n\
         {fields}\
         <p class=\"small screen\">Move the pointer, tap, use the arrow keys (with Shift in larger steps), or enter exact \
         values: 110, 1e-4, 1/3.</p>\n\
         <h2>What is certain</h2>\n\
         <p class=\"small\">{certain}</p>\n\
         <h2>Limits</h2>\n<pre>{text}</pre>\n\
         <script type=\"application/json\" id=\"data\">{data}</script>\n<script>\n{SCRIPT}</script>\n",
        title = escaped(&title),
        x_name = escaped(&x.name),
        y_name = escaped(&y.name),
        others = escaped(&others),
        wide = figures[0].figure.svg(),
        narrow = figures[1].figure.svg(),
        fields = fields(x, y),
        text = escaped(text),
        certain = certain(std::iter::once(answer)),
    );
    Ok(document(&title, &style(), &body, true))
}

/// What of a page of these maps is exact.
pub(super) fn certain<'a>(mut answers: impl Iterator<Item = &'a Answer<Map>>) -> &'static str {
    let has_symbols = answers.any(|answer| answer.value().decomposition.has_symbols());
    if has_symbols { CERTAIN_TO_BITS } else { CERTAIN }
}

/// The style of pages of maps.
pub(super) fn style() -> String {
    format!("{STYLE}@media screen and (prefers-color-scheme:dark){{\n{}}}\n", dark_style(".figure"))
}

/// Two fields for exact values, and where the script writes what holds there.
pub(super) fn fields(x: &Free, y: &Free) -> String {
    let field = |id: &str, axis: &Free| {
        format!(
            "<label for=\"{id}\">{}</label><input id=\"{id}\" autocomplete=\"off\" spellcheck=\"false\"><span>{}</span>\n",
            escaped(&axis.name),
            escaped(axis.unit.as_deref().unwrap_or_default()),
        )
    };
    format!(
        "<div class=\"panel\"><div class=\"inputs\">\n{}{}</div>\n\
         <div aria-live=\"polite\"><div id=\"verdict\"></div><div id=\"roots\"></div><div id=\"near\"></div></div></div>\n",
        field("x", x),
        field("y", y)
    )
}

/// What the script needs: the exact strips, and the walls as they are drawn.
pub(super) fn data(
    answer: &Answer<Map>,
    contents: &MapContents<'_>,
    figures: &[MapFigure; 2],
    budget: &Budget,
) -> Result<Value, Error> {
    let axis = |k: usize| {
        let (axis, window) = (&answer.problem().free()[k], &contents.windows()[k]);
        let (from, to) = window.ends();
        json!({
            "name": axis.name,
            "lower": axis.domain.lower.as_ref().map(Exact::from),
            "upper": axis.domain.upper.as_ref().map(Exact::from),
            "nominal": axis.nominal.as_ref().map(short),
            "from": from,
            "to": to,
            "log": window.logarithmic,
        })
    };
    let map = &answer.value().decomposition;
    let strips = map.strips.iter().map(|s| strip(s, answer, budget)).collect::<Result<Vec<_>, _>>()?;
    let walls = contents.walls.iter().zip(&contents.frequencies).filter(|(w, _)| w.role != Role::Nothing);
    let plot = |f: &MapFigure| json!([f.plot.0, f.plot.1, f.plot.2, f.plot.3]);
    Ok(json!({
        "label": format!("stable region of {} and {}", answer.problem().free()[0].name, answer.problem().free()[1].name),
        "goal": goal_or_stable(answer.problem()),
        "unit": frequency_unit(answer),
        "degree": answer.problem().evaluated().map_or(0, |a| a.order()),
        "never": map.never_stable,
        "axes": [axis(0), axis(1)],
        "plots": figures.iter().map(plot).collect::<Vec<_>>(),
        "curves": (0..map.curves.len()).map(|k| curve(k, answer)).collect::<Vec<_>>(),
        "strips": strips,
        "walls": walls.flat_map(|(w, f)| wall(w, f)).collect::<Vec<_>>(),
    }))
}

/// Bits after the point of coefficients that are not rational, and of walls that are not algebraic.
const BITS: u64 = 640;

fn curve(number: usize, answer: &Answer<Map>) -> Value {
    let map = &answer.value().decomposition;
    let polynomial = map.rounded_curve(number, BITS);
    let term = |(m, c): &(Monomial, Integer)| json!([m.exponent(0), m.exponent(1), c.to_string()]);
    json!({
        "words": mechanism_words(&map.curves[number].causes, answer),
        "terms": polynomial.terms().iter().map(term).collect::<Vec<_>>(),
    })
}

fn strip(strip: &Strip, answer: &Answer<Map>, budget: &Budget) -> Result<Value, Error> {
    let end = |value: &Option<Real>| {
        value.as_ref().map_or(Value::Null, |value| {
            let polynomial = value.algebraic().map(|x| Exact::coefficients(x.polynomial()));
            // Without a polynomial the page knows what is outside of the enclosure only.
            let known = match polynomial {
                Some(_) => value.clone(),
                None => value.refined(&Rational::dyadic(&Integer::ONE, BITS)),
            };
            let (lo, hi) = known.enclosure();
            json!({ "enclosure": [lo.to_string(), hi.to_string()], "polynomial": polynomial })
        })
    };
    let cells: Vec<Value> = strip.cells.iter().map(|c| json!([u8::from(c.stable), c.outside])).collect();
    // On a wall that a user can type the cells are others than beside it.
    let wall = strip.x.upper.as_ref().and_then(Real::exact);
    let fibre = wall.map(|x| answer.fibre(&x, budget)).transpose()?.flatten();
    let fibre = fibre.map(|cells| cells.iter().map(|c| json!([u8::from(c.0), c.1])).collect::<Vec<_>>());
    Ok(json!({ "lower": end(&strip.x.lower), "upper": end(&strip.x.upper), "cells": cells, "wall": fibre }))
}

/// Rounded to four significant digits.
fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// The visible parts of a wall, places to four decimals.
fn wall(wall: &Wall, frequencies: &[FrequencyPoint]) -> Vec<Value> {
    let near = |p: &(f64, f64)| (-0.02..=1.02).contains(&p.0) && (-0.02..=1.02).contains(&p.1);
    let numbered: Vec<(usize, (f64, f64))> = wall.points.iter().copied().enumerate().collect();
    let parts = numbered.chunk_by(|a, b| near(&a.1) == near(&b.1)).filter(|part| near(&part[0].1));
    parts.filter_map(|part| visible_part(wall.curve, part, frequencies)).collect()
}

fn visible_part(curve: usize, part: &[(usize, (f64, f64))], frequencies: &[FrequencyPoint]) -> Option<Value> {
    let rounded = |v: f64| (v * 1e4).round() / 1e4;
    let (mut points, mut kept) = (Vec::new(), Vec::new());
    let mut last: Option<(f64, f64)> = None;
    let (first, end) = (part.first()?.0, part.last()?.0);
    for (k, p) in part {
        let at = (rounded(p.0), rounded(p.1));
        let close = last.is_some_and(|l| (l.0 - at.0).abs() < 2e-3 && (l.1 - at.1).abs() < 2e-3);
        if close && *k != end {
            continue;
        }
        last = Some(at);
        points.extend([at.0, at.1]);
        kept.push(*k);
    }
    if kept.len() < 2 {
        return None;
    }
    let place = |point: usize| kept.partition_point(|k| *k < point);
    let inside = frequencies.iter().filter(|f| (first..=end).contains(&f.point));
    let frequencies: Vec<Value> = inside.map(|f| json!([place(f.point), four_digits(f.value)])).collect();
    Some(json!({ "curve": curve, "points": points, "frequencies": frequencies }))
}
