//! The verdict at the nominal point, and every limit of every parameter.

use super::around_nominal;
use super::part::{Part, Parts, Work};
use crate::page::{Table, math, paragraph};
use jurist_algebra::limits::{join, parallel_map};
use jurist_algebra::number::{Rational, parse_number, to_decimal};
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::problem::{Problem, Question};
use jurist_engine::stability::{Cause, StableSet};
use jurist_show::documents::{Answered, End, Intervals};
use jurist_show::intervals::{free_domain_text, nowhere, stable_lines};
use jurist_show::layout::short;
use jurist_show::{Document, Text};

/// Significant digits of limits, as the program prints them.
pub(super) const DIGITS: usize = 12;
/// Significant digits of frequencies and margins.
pub(super) const PLACES: usize = 7;

/// Work of the limits of all parameters together, which they share evenly, and the least of one: about a second of one core, and a fifth.
const WORK: u64 = 100_000_000;
const LEAST_WORK: u64 = 20_000_000;

/// A parameter with what is known of it.
pub(super) struct Limits {
    /// Its name.
    pub name: String,
    /// Its stable set, the others at their values.
    pub set: Part<Answer<StableSet>>,
    shown: Shown,
}

/// The ends of a stable set as its document has them: many parts of a report speak of them, and to find their frequencies is work.
#[derive(Default)]
struct Shown {
    /// With [`DIGITS`] digits.
    exact: Vec<End>,
    /// With [`PLACES`] digits.
    rounded: Vec<End>,
    /// How near those around the nominal value are, in decibels either way; infinite where there is none.
    nearest: f64,
}

impl Shown {
    fn of(answer: &Answer<StableSet>) -> Shown {
        let (exact, rounded) = join(|| ends(answer, DIGITS), || ends(answer, PLACES));
        let nearest = nearest(answer, &rounded);
        Shown { exact, rounded, nearest }
    }
}

/// The stable set of every parameter that is not set.
pub(super) fn find(question: &Question, parts: &Parts<'_>) -> Vec<Limits> {
    let names = question.model().parameters().iter().map(|p| p.name.clone());
    let names: Vec<String> = names.filter(|name| !question.values_set().contains_key(name)).collect();
    let work = Work::Units((WORK / names.len().max(1) as u64).max(LEAST_WORK));
    parallel_map(names, |name: String| {
        let question = question.clone().free(&name);
        let found = parts.part(&format!("limits of {name}"), work, |budget| {
            let answer = question.stable_set(budget)?;
            let shown = Shown::of(&answer);
            Ok((answer, shown))
        });
        match found {
            Ok((answer, shown)) => Limits { name, set: Ok(answer), shown },
            Err(missing) => Limits { name, set: Err(missing), shown: Shown::default() },
        }
    })
}

/// `stable: all 6 roots are inside the unit circle`, or why nothing is known.
pub(super) fn verdict_sentence(verdict: &Part<Answer<PointVerdict>>) -> String {
    match verdict {
        Err(missing) => missing.sentence(),
        Ok(answer) => {
            let text = answer.text(DIGITS);
            text.lines().nth(1).unwrap_or_default().to_owned()
        }
    }
}

pub(super) fn section(verdict: &Part<Answer<PointVerdict>>, required: &str, limits: &[Limits]) -> String {
    let mut html = paragraph(&format!("At the nominal point the loop is <b>{}</b>.", math(&verdict_sentence(verdict))));
    html.push_str(required);
    if limits.is_empty() {
        html.push_str(&paragraph("No parameter is open, so there is no limit to ask for."));
    }
    html.extend(limits.iter().map(of_parameter));
    html
}

fn of_parameter(limits: &Limits) -> String {
    let heading = format!("<h3>{}</h3>\n", math(&limits.name));
    let answer = match &limits.set {
        Err(missing) => return heading + &missing.html(),
        Ok(answer) => answer,
    };
    let free = answer.problem().parameter();
    let unit = free.unit.as_deref().map(|u| format!(" {u}")).unwrap_or_default();
    let nominal = free.nominal.as_ref().map(|n| format!("Nominal {}{unit}; ", short(n))).unwrap_or_default();
    let domain = match free_domain_text(free) {
        all if all == "all" => "asked about all values".to_owned(),
        domain => format!("asked about {domain}"),
    };
    let stable = match stable_lines(&free.name, answer.value(), DIGITS) {
        lines if lines.is_empty() => format!("stable {}", nowhere(answer.value().undecided())),
        lines => format!("stable for {}", lines.join(" or ")),
    };
    let unit = free.unit.as_deref().map(|u| format!(" ({u})")).unwrap_or_default();
    let sentence = format!("{nominal}{domain}: {stable}{unit}.");
    heading
        + &paragraph(&math(&sentence))
        + &table(limits, answer.problem()).map(|t| t.html()).unwrap_or_default()
        + &undecided(answer)
}

fn undecided(answer: &Answer<StableSet>) -> String {
    let line = |b: &jurist_engine::stability::UndecidedBracket| {
        let shown =
            |x: &Option<Rational>, infinite: &str| x.as_ref().map_or(infinite.to_owned(), |x| to_decimal(x, DIGITS));
        let (low, high) = (shown(&b.lower, "-∞"), shown(&b.upper, "∞"));
        format!("<li>{}</li>", math(&format!("undecided in [{low}, {high}]: {}", b.why)))
    };
    let lines: String = answer.value().undecided().iter().map(line).collect();
    if lines.is_empty() { lines } else { format!("<ul>{lines}</ul>\n") }
}

/// The ends of an answer as its document has them.
fn ends(answer: &Answer<StableSet>, digits: usize) -> Vec<End> {
    let Intervals { answer: Answered::Known(known), .. } = answer.json(digits) else { return Vec::new() };
    let mut ends: Vec<End> = known.stable.into_iter().flat_map(|i| [i.lower, i.upper]).flatten().collect();
    // Two intervals that touch share an end.
    ends.dedup_by(|b, a| a.number.enclosure == b.number.enclosure);
    ends
}

fn table(limits: &Limits, problem: &Problem) -> Option<Table> {
    let Shown { exact, rounded, .. } = &limits.shown;
    if exact.is_empty() {
        return None;
    }
    let nominal = problem.parameter().nominal.as_ref().map(short).unwrap_or_default();
    let margin = if nominal.is_empty() { "margin".to_owned() } else { format!("margin from nominal {nominal}") };
    let mut table = Table::new("Limits", &["limit", "what happens there", "frequency", &margin]);
    for (end, places) in exact.iter().zip(rounded) {
        let fraction = end.number.exact.as_ref().filter(|f| {
            let same = parse_number(f.as_str()).ok() == parse_number(&end.number.decimal).ok();
            !same && f.as_str().len() <= 24
        });
        let fraction = fraction.map(|f| format!(" = {}", f.as_str())).unwrap_or_default();
        let cause = end.boundary.as_deref().unwrap_or(&end.cause);
        let row = [
            format!("{}{fraction}", end.number.decimal),
            format!("{cause}{}", gloss(cause)),
            frequency(places).unwrap_or_else(|| NONE.to_owned()),
            margin_text(places, problem).unwrap_or_else(|| NONE.to_owned()),
        ];
        table.rows.push(row.to_vec());
    }
    Some(table)
}

/// A cause in the words of an engineer, behind its name.
fn gloss(cause: &str) -> &'static str {
    match cause {
        "z=1" => " (a root at rest: drift)",
        "s=0" => " (a root at rest: drift)",
        "z=-1" => " (half the sampling frequency)",
        "complex pair" => " (oscillation)",
        "infinity" => " (the degree is lost)",
        "pole" => " (undefined: a division by zero)",
        "duty" => " (no pulse, or no pause, is left)",
        "square root" => " (undefined beyond: the number under it is negative)",
        "domain" => " (end of what was asked, no limit of the loop)",
        _ => "",
    }
}

/// What stands in an empty cell.
const NONE: &str = "–";

/// `1664.067 Hz, 1.045564 rad per sample`; `None` where no complex pair is there.
fn frequency(end: &End) -> Option<String> {
    let at = &end.frequency;
    let mut parts = Vec::new();
    parts.extend(at.frequency_hz.as_ref().map(|f| format!("{f} Hz")));
    match (&at.angle, &at.radians_per_second) {
        (Some(angle), _) => parts.push(format!("{angle} rad per sample")),
        (None, Some(rate)) => parts.push(format!("{rate} rad/s")),
        (None, None) => {}
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// Whether a limit is only that of the question, or of what is known.
fn is_domain(end: &End) -> bool {
    [Cause::Domain, Cause::Undecided].iter().any(|cause| end.cause == cause.name())
}

/// `5.008556 × nominal (13.99424 dB)`; no decibels where the parameter is a time of the loop.
fn margin_text(end: &End, problem: &Problem) -> Option<String> {
    if is_domain(end) {
        return None;
    }
    let decibels = end.margin_db.as_ref()?;
    let factor = end.margin_factor.as_deref()?;
    let factor = parse_number(factor).map_or_else(|_| factor.to_owned(), |f| to_decimal(&f, PLACES));
    let is_time = problem.sample_time().is_some_and(|(n, d)| !(n.is_constant() && d.is_constant()));
    Some(if is_time { format!("{factor} × nominal") } else { format!("{factor} × nominal ({decibels} dB)") })
}

/// How near the limits around the nominal value are, in decibels either way; infinite where there is none. Only the order
/// of parameters follows from it.
fn nearest(answer: &Answer<StableSet>, rounded: &[End]) -> f64 {
    let Some(interval) = around_nominal(answer) else { return f64::INFINITY };
    let around = [&interval.lower, &interval.upper];
    let values: Vec<String> = around.into_iter().flatten().map(|e| super::limit_text(Some(&e.value), PLACES)).collect();
    let near = rounded.iter().filter(|e| !is_domain(e) && values.contains(&e.number.decimal));
    near.filter_map(|e| e.margin_db.as_ref()?.as_f64()).map(f64::abs).fold(f64::INFINITY, f64::min)
}

/// The parameters by how near their limits are, the nearest first.
fn ordered(limits: &[Limits]) -> Vec<(&Limits, &Answer<StableSet>)> {
    let mut known: Vec<_> = limits.iter().filter_map(|l| Some((l, l.set.as_ref().ok()?))).collect();
    known.sort_by(|a, b| a.0.shown.nearest.total_cmp(&b.0.shown.nearest));
    known
}

/// The stable sets of the parameters by how near their limits are, the nearest first.
pub(super) fn by_margin(limits: &[Limits]) -> Vec<&Answer<StableSet>> {
    ordered(limits).into_iter().map(|(_, answer)| answer).collect()
}

/// `nearest limit: T < 0.000496939 (4.969395 × nominal)`: plain text for the head of the page.
pub(super) fn nearest_sentence(limits: &[Limits]) -> Option<String> {
    let (known, answer) = *ordered(limits).first()?;
    let Shown { exact, rounded, nearest } = &known.shown;
    if !nearest.is_finite() {
        return None;
    }
    let is_nearest =
        |e: &&End| e.margin_db.as_ref().and_then(|m| m.as_f64()).is_some_and(|m| m.abs() == *nearest && !is_domain(e));
    let places = rounded.iter().find(is_nearest)?;
    let at = rounded.iter().position(|e| e == places)?;
    let free = answer.problem().parameter();
    let unit = free.unit.as_deref().map(|u| format!(" {u}")).unwrap_or_default();
    let cause = &exact.get(at)?.cause;
    let frequency = frequency(places).map(|text| format!(" at {text}")).unwrap_or_default();
    Some(format!(
        "The nearest limit is {} = {}{unit}, {}: {cause}{frequency}.",
        free.name,
        places.number.decimal,
        margin_text(places, answer.problem())?,
    ))
}
