//! Whether a claim about a loop holds, and by how much.

use super::{Line, percent};
use crate::cli::status::Error;
use crate::cli::table::Point;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::real::Real;
use jurist_check::{Limits, check};
use jurist_engine::answer::{ToleranceRequest, Verdict};
use jurist_engine::error::{Code, Diagnostic};
use jurist_engine::model::{ClaimKind, Model, RequirementText, Tolerance};
use jurist_engine::problem::{Ask, Question};
use jurist_engine::response::Requirements;
use jurist_engine::stability::boxes::BoxDecision;
use jurist_engine::stability::{Cause, End, Range, StableInterval, StableSet};
use jurist_show::documents::TestStatus;
use jurist_show::layout::short;
use jurist_show::margins::margin;
use jurist_show::{Text, margin_left, required_value};
use std::path::Path;

/// Digits of numbers in what was found.
const DIGITS: usize = 6;

/// Digits of the distance to an end.
const DISTANCE_DIGITS: usize = 15;

/// The lines of a claim: one, but of requirements one each.
pub(super) fn judge(claim: &ClaimKind, model: &Model, point: &Point, folder: &Path, budget: &Budget) -> Vec<Line> {
    let found = match claim {
        ClaimKind::Require(further) => requirements(further, model, point, budget),
        other => one(other, model, point, folder, budget).map(|line| vec![line]),
    };
    let outside: Vec<&str> = point
        .iter()
        .filter(|(name, value)| model.parameter(name).is_some_and(|p| !p.contains(value)))
        .map(|(name, _)| name.as_str())
        .collect();
    let remark =
        if outside.is_empty() { String::new() } else { format!("; outside of its domain: {}", outside.join(", ")) };
    let lines = found.unwrap_or_else(|error| vec![failure(words(claim), error)]);
    lines.into_iter().map(|line| Line { text: line.text + &remark, ..line }).collect()
}

/// What a claim says.
pub(super) fn words(claim: &ClaimKind) -> String {
    match claim {
        ClaimKind::Verdict(word) => format!("verdict {word}"),
        ClaimKind::Stable { param, low, high } => match (low, high) {
            (None, None) => format!("stable for every {}", param.name),
            (Some(low), None) => format!("stable for {} >= {}", param.name, short(low)),
            (None, Some(high)) => format!("stable for {} <= {}", param.name, short(high)),
            (Some(low), Some(high)) => format!("stable for {} <= {} <= {}", short(low), param.name, short(high)),
        },
        ClaimKind::Limit { param, is_upper, value, within } => {
            let side = if *is_upper { "upper" } else { "lower" };
            let none = if *is_upper { "inf" } else { "-inf" };
            let expected = value.as_ref().map_or_else(|| none.to_owned(), short);
            let within = match within {
                _ if value.is_none() => String::new(),
                Tolerance::Width(width) => format!(" within {}", short(width)),
                Tolerance::Share { above, .. } => format!(" within {}", percent(above)),
                Tolerance::Range { .. } => String::new(),
            };
            format!("{side} limit of {} is {expected}{within}", param.name)
        }
        ClaimKind::Require(_) => "requirements".to_owned(),
        ClaimKind::Tolerance(factor) if factor.is_one() => "stable within all tolerances".to_owned(),
        ClaimKind::Tolerance(factor) => format!("stable within {} times all tolerances", short(factor)),
        ClaimKind::Certificate(file) => format!("certificate {file}"),
    }
}

/// The line of a claim without an answer.
pub(super) fn failure(name: String, error: Error) -> Line {
    match error {
        // How far the work was depends on what other threads did.
        Error::Stopped(stopped) => Line::new(name, TestStatus::Undecided, format!("not decided: {}", stopped.stop)),
        Error::Refused(refused) => {
            // A picture of the place would not fit into a line.
            let said = refused.diagnostics().iter().map(|d| {
                let place = refused
                    .source_text()
                    .zip(d.primary.as_ref())
                    .map(|(source, label)| format!("{}:{}: ", source.name, source.line_column(label.span.start).0));
                let label = d.primary.as_ref().map(|l| l.text.as_str()).filter(|text| !text.is_empty());
                let label = label.map(|label| format!(" ({label})")).unwrap_or_default();
                let help = d.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
                format!("{}{}: {}{label}{help}", place.unwrap_or_default(), d.code, d.message)
            });
            Line::new(name, TestStatus::Error, said.collect::<Vec<_>>().join("; "))
        }
        other => Line::new(name, TestStatus::Error, other.to_string()),
    }
}

fn asked(model: &Model, point: &Point) -> Question {
    model.ask().set_all(point.iter().map(|(name, value)| (name.clone(), value.clone())))
}

fn one(claim: &ClaimKind, model: &Model, point: &Point, folder: &Path, budget: &Budget) -> Result<Line, Error> {
    let name = words(claim);
    match claim {
        ClaimKind::Verdict(expected) => {
            let found = asked(model, point).verdict(budget)?;
            let text = found.text(DIGITS);
            let line = text.lines().nth(1).unwrap_or_default();
            Ok(Line::new(name, passed_if(found.value().verdict.name() == expected), line))
        }
        ClaimKind::Stable { param, low, high } => {
            let set = stable_set(model, point, &param.name, budget)?;
            Ok(in_range(name, &param.name, &set, low.as_ref(), high.as_ref()))
        }
        ClaimKind::Limit { param, is_upper, value, within } => {
            let set = stable_set(model, point, &param.name, budget)?;
            let nominal = asked(model, point).nominal(&param.name)?;
            let nominal = nominal.or_else(|| model.constant(&param.name)?.number.clone());
            Ok(limit(name, &param.name, &set, *is_upper, (value.as_ref(), within), nominal.as_ref()))
        }
        ClaimKind::Tolerance(factor) => tolerance(name, factor, model, point, budget),
        ClaimKind::Certificate(file) => certificate(name, &folder.join(file), model),
        ClaimKind::Require(_) => unreachable!("requirements have lines of their own"),
    }
}

fn passed_if(holds: bool) -> TestStatus {
    if holds { TestStatus::Passed } else { TestStatus::Failed }
}

fn stable_set(model: &Model, point: &Point, name: &str, budget: &Budget) -> Result<StableSet, Error> {
    let mut question = asked(model, point).without_value(name).free(name);
    if model.constant(name).is_some() {
        // A range is about all of its values, whatever sign a constant has.
        question = question.domain(name, Range::all());
    }
    Ok(question.stable_set(budget)?.value().clone())
}

/// The intervals of a set in words.
fn shown(set: &StableSet, name: &str) -> String {
    let sign = |end: &End| if end.closed { "<=" } else { "<" };
    let interval = |i: &StableInterval| {
        let lower = i.lower.as_ref().map(|end| format!("{} {} ", end.value.decimal(DIGITS), sign(end)));
        let upper = i.upper.as_ref().map(|end| format!(" {} {}", sign(end), end.value.decimal(DIGITS)));
        match (lower, upper) {
            (None, None) => format!("every {name}"),
            (lower, upper) => format!("{}{name}{}", lower.unwrap_or_default(), upper.unwrap_or_default()),
        }
    };
    match set.intervals() {
        [] => "stable nowhere".to_owned(),
        intervals => format!("stable for {}", intervals.iter().map(interval).collect::<Vec<_>>().join(", and for ")),
    }
}

/// An end, exactly where it is rational, else rounded: for what is said beside a verdict, which compares the end itself.
fn rounded(end: &End) -> Option<Rational> {
    end.value.exact().or_else(|| parse_number(&end.value.decimal(DISTANCE_DIGITS)).ok())
}

/// The distance from a value to an end in units of the greater of both; positive on the stable side.
fn distance(value: &Rational, end: &End, is_upper: bool) -> Option<Rational> {
    let end = rounded(end)?;
    let size = value.abs().max(end.abs());
    let distance = if is_upper { &end - value } else { value - &end };
    if distance.is_zero() { Some(distance) } else { distance.checked_div(&size) }
}

/// Whether a bound of a range is on the stable side of an end.
fn is_within(bound: Option<&Rational>, end: Option<&End>, is_upper: bool) -> bool {
    match (bound, end) {
        (_, None) => true,
        // A range without an end goes as far as the domain does.
        (None, Some(end)) => end.causes.contains(Cause::Domain),
        (Some(bound), Some(end)) => {
            let order = end.value.compare_rational(bound);
            order.is_eq() && end.closed || if is_upper { order.is_gt() } else { order.is_lt() }
        }
    }
}

/// Whether a part of a range is decided and not stable: neither in a stable interval nor in a bracket.
fn has_gap(set: &StableSet, low: Option<&Rational>, high: Option<&Rational>) -> bool {
    let outer = |end: &Option<End>, is_upper: bool| {
        let (lower, upper) = end.as_ref()?.value.refined_to_digits(DIGITS).enclosure();
        Some(if is_upper { upper } else { lower })
    };
    let stable = set.intervals().iter().map(|i| (outer(&i.lower, false), outer(&i.upper, true)));
    let brackets = set.undecided().iter().map(|b| (b.lower.clone(), b.upper.clone()));
    let mut covered: Vec<(Option<Rational>, Option<Rational>)> = stable.chain(brackets).collect();
    covered.sort(); // no end is the least of all
    let mut reached = low.cloned();
    for (from, to) in covered {
        let is_gap = matches!((&reached, &from), (Some(reached), Some(from)) if reached < from);
        if is_gap && high.is_none_or(|high| reached.as_ref().is_some_and(|r| r < high)) {
            return true;
        }
        let Some(to) = to else { return false };
        reached = Some(reached.map_or(to.clone(), |reached| reached.max(to)));
    }
    matches!((reached, high), (Some(reached), Some(high)) if reached < *high)
}

fn in_range(name: String, param: &str, set: &StableSet, low: Option<&Rational>, high: Option<&Rational>) -> Line {
    let holds =
        |i: &&StableInterval| is_within(low, i.lower.as_ref(), false) && is_within(high, i.upper.as_ref(), true);
    let text = shown(set, param);
    if let Some(interval) = set.intervals().iter().find(holds) {
        let sides = [(low, &interval.lower, false), (high, &interval.upper, true)];
        let left = sides.into_iter().filter_map(|(bound, end, is_upper)| distance(bound?, end.as_ref()?, is_upper));
        return Line::new(name, TestStatus::Passed, text).with_margin(left.min());
    }
    let is_open = set.undecided().iter().any(|bracket| {
        let below = |a: Option<&Rational>, b: Option<&Rational>| a.is_none() || b.is_none() || a <= b;
        below(low, bracket.upper.as_ref()) && below(bracket.lower.as_ref(), high)
    });
    if is_open && !has_gap(set, low, high) {
        let text = format!("{text}; not everything in this range is decided");
        return Line::new(name, TestStatus::Undecided, text);
    }
    // The interval that leaves out the least of the range, and by how much its worst end is too near.
    let missing = |i: &&StableInterval| {
        let beyond = |bound: Option<&Rational>, end: &Option<End>, is_upper: bool| -> Option<Rational> {
            let (bound, end) = (bound?, rounded(end.as_ref()?)?);
            Some(if is_upper { bound - &end } else { &end - bound }.max(Rational::ZERO))
        };
        let sides = [beyond(low, &i.lower, false), beyond(high, &i.upper, true)];
        sides.into_iter().flatten().fold(Rational::ZERO, |sum, side| sum + side)
    };
    let nearest = set.intervals().iter().min_by_key(missing);
    let sides = nearest.map(|i| [(low, &i.lower, false), (high, &i.upper, true)]);
    let distances =
        sides.into_iter().flatten().filter_map(|(bound, end, is_upper)| distance(bound?, end.as_ref()?, is_upper));
    let margin = distances.min().filter(|m| !m.sign().is_gt());
    Line::new(name, TestStatus::Failed, text).with_margin(margin)
}

fn limit(
    name: String,
    param: &str,
    set: &StableSet,
    is_upper: bool,
    (expected, within): (Option<&Rational>, &Tolerance),
    nominal: Option<&Rational>,
) -> Line {
    let end = |i: &'_ StableInterval| if is_upper { i.upper.clone() } else { i.lower.clone() };
    let around = nominal.and_then(|x| set.intervals().iter().find(|i| i.contains(x)));
    let ends: Vec<Option<End>> = match (around, set.intervals()) {
        (Some(interval), _) => vec![end(interval)],
        (None, intervals) => intervals.iter().map(end).collect(),
    };
    // Where no end is expected, none is the nearest.
    let far = |end: &Option<End>| (end.is_none() == expected.is_some(), moved(end.as_ref(), expected));
    let Some(nearest) = ends.into_iter().min_by_key(far) else {
        let is_open = !set.undecided().is_empty();
        let status = if is_open { TestStatus::Undecided } else { TestStatus::Failed };
        return Line::new(name, status, shown(set, param));
    };
    let text = nearest
        .as_ref()
        .map_or_else(|| "there is none".to_owned(), |end| format!("is {} ({})", end.value.decimal(DIGITS), end.causes));
    if nearest.as_ref().is_some_and(|end| end.causes.contains(Cause::Undecided)) {
        return Line::new(name, TestStatus::Undecided, format!("{text}; beyond, nothing is decided"));
    }
    let (Some(end), Some(expected)) = (&nearest, expected) else {
        let is_domain = |end: &End| end.causes.contains(Cause::Domain);
        let none = nearest.as_ref().is_none_or(is_domain);
        return Line::new(name, passed_if(none && expected.is_none()), text);
    };
    let Ok([below, above]) = within.widths(expected) else {
        return Line::new(name, TestStatus::Error, "no distance follows from 'within'");
    };
    let (low, high) = (expected - &below, expected + &above);
    let holds = end.value.compare_rational(&low).is_ge() && end.value.compare_rational(&high).is_le();
    let moved = moved(Some(end), Some(expected)).unwrap_or(Rational::ZERO);
    let allowed = below.max(above);
    let left = moved.checked_div(&allowed).map(|used| Rational::ONE - used);
    let text = match moved.checked_div(&expected.abs()) {
        Some(share) if !share.is_zero() => format!("{text}, moved by {}", percent(&share)),
        _ => text,
    };
    Line::new(name, passed_if(holds), text).with_margin(left)
}

/// How far an end is from where it is expected; `None` where one of them is infinite.
fn moved(end: Option<&End>, expected: Option<&Rational>) -> Option<Rational> {
    Some((&rounded(end?)? - expected?).abs())
}

fn requirements(
    further: &[RequirementText],
    model: &Model,
    point: &Point,
    budget: &Budget,
) -> Result<Vec<Line>, Error> {
    let values = asked(model, point).problem()?.set().to_vec();
    let further: Vec<(&str, &str)> = further.iter().map(|r| (r.name.as_str(), r.text.as_str())).collect();
    let required = Requirements::of(model, &further, &values, budget)?;
    if required.is_empty() {
        let error = Diagnostic::error(Code::Require, "nothing is required: the model has no [require]");
        return Err(error.help("name the requirements here: require = { phase_margin = \"45 deg\" }").into());
    }
    let mut question = asked(model, point);
    if let Some(region) = required.region.clone() {
        question = question.within(region);
    }
    let problem = question.problem()?;
    let mut lines = Vec::new();
    for met in problem.requirements_met(&required.list, required.at.as_deref(), budget)? {
        let text = match (required_value(&met, DIGITS), met.met) {
            (Some(value), _) => format!("is {}", with_unit(&value, met.requirement.name())),
            (None, true) => "met".to_owned(),
            (None, false) => "not met".to_owned(),
        };
        lines.push(Line::new(met.requirement.text(), passed_if(met.met), text).with_margin(margin_left(&met)));
    }
    if !required.regional.is_empty() {
        let holds = problem.verdict(budget)?.value().verdict == Verdict::Stable;
        for (name, text) in &required.regional {
            lines.push(Line::new(format!("{name} {text}"), passed_if(holds), if holds { "met" } else { "not met" }));
        }
    }
    Ok(lines)
}

fn tolerance(name: String, factor: &Rational, model: &Model, point: &Point, budget: &Budget) -> Result<Line, Error> {
    /// The bracket of the largest factor is no wider, as a share.
    const GAP: i64 = 10_000;
    let request = ToleranceRequest::of_model(model);
    // The box itself is asked first: it may be decided where no bracket of the largest factor is close enough.
    let mut scaled = Vec::new();
    for (name, tolerance) in &request.tolerances {
        let nominal = match point.iter().find(|(n, _)| n == name) {
            Some((_, value)) => Some(value.clone()),
            None => asked(model, point).nominal(name)?.or_else(|| model.constant(name)?.number.clone()),
        };
        let widths = nominal.as_ref().and_then(|nominal| tolerance.widths(nominal).ok());
        let own = match (nominal, widths) {
            (Some(nominal), Some([below, above])) => {
                Tolerance::Range { low: &nominal - &(factor * &below), high: &nominal + &(factor * &above) }
            }
            _ => tolerance.clone(),
        };
        scaled.push((name.clone(), own));
    }
    let alone = asked(model, point).tolerance(&ToleranceRequest::new(scaled).box_alone(), budget)?;
    let status = match &alone.value().decision {
        BoxDecision::Stable(_) => TestStatus::Passed,
        BoxDecision::Undecided { .. } => TestStatus::Undecided,
        _ => TestStatus::Failed,
    };
    let request = request.gap(Rational::new(1.into(), GAP.into()));
    let found = asked(model, point).tolerance(&request, budget);
    let Some(bracket) = found.ok().and_then(|answer| answer.value().factor.clone()) else {
        let text = match status {
            TestStatus::Passed => "proved",
            TestStatus::Failed => "not stable for some values",
            _ => "neither proved nor refuted",
        };
        return Ok(Line::new(name, status, text));
    };
    let proved = short_digits(&bracket.lower);
    let text = match &bracket.upper {
        Some(upper) => format!("they can grow by a factor of {proved}, not of {}", short_digits(upper)),
        None => format!("they can grow by a factor of {proved} at least"),
    };
    let left = (&bracket.lower - factor).checked_div(factor);
    // What is proved of the box is proved, however near the bracket comes.
    let left = left.map(|left| if status == TestStatus::Passed { left.max(Rational::ZERO) } else { left });
    Ok(Line::new(name, status, text).with_margin(left))
}

/// A number in the unit of its requirement.
fn with_unit(value: &str, requirement: &str) -> String {
    let decibels = || {
        let value = Real::from(parse_number(value).ok()?);
        margin(&value, Some(&Rational::ONE), 4)?.decibels
    };
    match requirement {
        "gain_margin" => decibels().map_or_else(|| value.to_owned(), |db| format!("{value} ({db} dB)")),
        "phase_margin" => format!("{value} deg"),
        _ => value.to_owned(),
    }
}

fn short_digits(x: &Rational) -> String {
    jurist_algebra::number::to_decimal(x, DIGITS)
}

fn certificate(name: String, path: &Path, model: &Model) -> Result<Line, Error> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) => return Ok(Line::new(name, TestStatus::Error, format!("cannot be read: {error}"))),
    };
    Ok(match check(&model.source().text, &text, &Limits::default()) {
        Ok(proved) => Line::new(name, TestStatus::Passed, format!("proves: {}", proved.statement)),
        Err(rejection) => Line::new(name, TestStatus::Failed, rejection.to_string()),
    })
}
