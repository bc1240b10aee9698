//! The stable set of one parameter.

use super::layout::{Columns, fraction, headline, named_values, short, visible};
use super::map::never_stable_text;
use super::margins::margin;
use super::{real, region};
use crate::Text;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Rational, parse_number, to_decimal};
use jurist_algebra::poly::RealAlgebraic;
use jurist_algebra::real::Real;
use jurist_engine::answer::Answer;
use jurist_engine::problem::{Free, Problem, range_text};
use jurist_engine::stability::{
    Cause, End, IntervalSet, Range, RealInterval, RealIntervals, StableSet, UndecidedBracket,
};

impl Text for Answer<StableSet> {
    /// The answer for people.
    fn text(&self, digits: usize) -> String {
        intervals_text(self.problem(), Ok(self.value()), digits)
    }
}

/// The answer for people, also one that the budget did not allow.
pub fn intervals_text(problem: &Problem, set: Result<&StableSet, &Exhausted>, digits: usize) -> String {
    format!("{}\n{}", heading(problem), answer_lines(problem, set, digits))
}

/// The model and the values of the other parameters.
pub fn heading(problem: &Problem) -> String {
    let mut line = headline(problem.model());
    if !problem.set().is_empty() {
        line.push_str(&format!(", {}", named_values(problem.set())));
    }
    line
}

/// What is asked for is not decided, and why.
pub fn undecided_text(stopped: &Exhausted) -> String {
    format!("undecided, {stopped}")
}

/// The intervals, and a line for each end.
pub fn answer_lines(problem: &Problem, set: Result<&StableSet, &Exhausted>, digits: usize) -> String {
    let free = problem.parameter();
    let name = &free.name;
    let goal = region::goal_or_stable(problem);
    let mut asked = name.clone();
    if let Some(unit) = &free.unit {
        asked.push_str(&format!(" in {}", visible(unit)));
    }
    let domain = free_domain_text(free);
    if domain != "all" {
        asked.push_str(&format!(", domain {domain}"));
    }
    match set {
        Err(stopped) => format!("{asked}: {}\n", undecided_text(stopped)),
        Ok(set) if set.is_empty() && problem.evaluated().is_some_and(|a| a.undefined().is_some()) => {
            format!("{asked}: {goal} nowhere, undefined for every {name}\n")
        }
        Ok(set) if set.is_empty() => {
            let why = problem.root_that_stays().filter(|_| set.undecided().is_empty());
            let why = why.map(|cause| never_stable_text(cause.name())).unwrap_or_default();
            let undecided = undecided_lines(set.undecided(), digits);
            format!("{asked}: {goal} {}{why}\n{undecided}", nowhere(set.undecided()))
        }
        Ok(set) => {
            let mut out = format!("{asked}: {goal} for\n");
            for interval in nominal_first(stable_lines(name, set, digits), nominal_place(set, problem)) {
                out.push_str(&format!("    {interval}\n"));
            }
            out.push_str(&end_lines(set, problem, digits));
            out.push_str(&undecided_lines(set.undecided(), digits));
            out
        }
    }
}

/// Where a set without intervals is: nowhere, or in what is undecided at most.
pub fn nowhere(undecided: &[UndecidedBracket]) -> &'static str {
    if undecided.is_empty() { "nowhere" } else { "nowhere outside of what is undecided" }
}

/// Which interval has the nominal value.
fn nominal_place(set: &StableSet, problem: &Problem) -> Option<usize> {
    let nominal = problem.parameter().nominal.as_ref()?;
    set.intervals().iter().position(|interval| interval.contains(nominal))
}

/// In ascending order but for that with the nominal value, which comes first.
pub(super) fn nominal_first<T>(mut ascending: Vec<T>, nominal: Option<usize>) -> Vec<T> {
    if let Some(k) = nominal {
        ascending[..=k].rotate_right(1);
    }
    ascending
}

/// `K > 0`, `0 < K < 3`, `all`.
pub fn domain_text(name: &str, range: &Range) -> String {
    range_text(name, range, [false; 2], short)
}

/// The same with the ends that belong to the domain: `K >= 0`, `0 <= K <= 3`.
pub fn free_domain_text(free: &Free) -> String {
    range_text(&free.name, &free.domain, free.closed, short)
}

fn less(closed: bool) -> &'static str {
    if closed { "<=" } else { "<" }
}

fn more(closed: bool) -> &'static str {
    if closed { ">=" } else { ">" }
}

/// `0.038 < K < 550.9`, one line for each interval.
pub fn set_lines(name: &str, set: &IntervalSet, digits: usize) -> Vec<String> {
    let real = |end: &Option<RealAlgebraic>| end.clone().map(Real::from);
    lines(name, set.intervals().iter().map(|i| [real(&i.lower), real(&i.upper)]).collect(), digits)
}

/// The same for one interval with ends of any kind.
pub fn extent_line(name: &str, extent: &RealInterval, digits: usize) -> String {
    lines(name, vec![[extent.lower.clone(), extent.upper.clone()]], digits).remove(0)
}

/// The same for a stable set.
pub fn stable_lines(name: &str, set: &StableSet, digits: usize) -> Vec<String> {
    let real = |end: &Option<End>| end.as_ref().map(|end| end.value.clone());
    let intervals: Vec<_> = set.intervals().iter().map(|i| [real(&i.lower), real(&i.upper)]).collect();
    let is_closed = |end: &Option<End>| end.as_ref().is_some_and(|end| end.closed);
    let closed: Vec<[bool; 2]> = set.intervals().iter().map(|i| [is_closed(&i.lower), is_closed(&i.upper)]).collect();
    lines_with(name, intervals, |i| closed[i], digits)
}

/// The same for ends of any kind.
pub(super) fn real_lines(name: &str, set: &RealIntervals, digits: usize) -> Vec<String> {
    lines(name, set.intervals.clone(), digits)
}

fn lines(name: &str, intervals: Vec<[Option<Real>; 2]>, digits: usize) -> Vec<String> {
    lines_with(name, intervals, |_| [false; 2], digits)
}

/// The same with ends that belong to the set.
fn lines_with(
    name: &str,
    intervals: Vec<[Option<Real>; 2]>,
    closed: impl Fn(usize) -> [bool; 2],
    digits: usize,
) -> Vec<String> {
    let ends: Vec<&Real> = intervals.iter().flatten().flatten().collect();
    let mut decimals = distinct_decimals(&ends, digits).into_iter();
    let mut decimal = |end: &Option<Real>| end.as_ref().and_then(|_| decimals.next());
    let line = |(i, [lower, upper]): (usize, &[Option<Real>; 2])| {
        let [from, to] = closed(i);
        match (decimal(lower), decimal(upper)) {
            (None, None) => format!("every {name}"),
            (Some(l), None) => format!("{name} {} {l}", more(from)),
            (None, Some(u)) => format!("{name} {} {u}", less(to)),
            (Some(l), Some(u)) if from && to && l == u => format!("{name} = {l}"),
            (Some(l), Some(u)) => format!("{l} {} {name} {} {u}", less(from), less(to)),
        }
    };
    intervals.iter().enumerate().map(line).collect()
}

/// Digits up to which two ends that are close are told apart.
const MOST_DIGITS: usize = 100;

/// Decimals of ascending values. Different values that round to the same decimal have more digits, so many
/// that all of them can be told apart.
fn distinct_decimals(values: &[&Real], digits: usize) -> Vec<String> {
    let decimals =
        |values: &[&Real], digits| -> Vec<String> { values.iter().map(|x| real::rounded(x, digits).decimal).collect() };
    let mut out = decimals(values, digits);
    let mut first = 0;
    while first < values.len() {
        let same = out[first..].iter().take_while(|d| **d == out[first]).count();
        let group = &values[first..first + same];
        let differ: Vec<bool> = group.windows(2).map(|pair| !pair[0].is_same(pair[1])).collect();
        if differ.contains(&true) {
            // Exact decimals have no trailing zeros, so that only their values tell.
            let tell = |d: &Vec<String>| {
                let apart =
                    |(pair, differ): (&[String], &bool)| !differ || parse_number(&pair[0]) != parse_number(&pair[1]);
                d.windows(2).zip(&differ).all(apart)
            };
            if let Some(longer) = (digits + 1..=MOST_DIGITS).map(|more| decimals(group, more)).find(tell) {
                out.splice(first..first + same, longer);
            }
        }
        first += same;
    }
    out
}

/// A line for each bracket in which nothing is known.
pub(super) fn undecided_lines(brackets: &[UndecidedBracket], digits: usize) -> String {
    let line = |b: &UndecidedBracket| {
        let shown = |x: &Rational| to_decimal(x, digits);
        match (&b.lower, &b.upper) {
            (Some(lo), Some(hi)) => {
                let width = to_decimal(&(hi - lo), 2);
                format!("undecided in [{}, {}] (width {width}): {}\n", shown(lo), shown(hi), b.why)
            }
            (Some(lo), None) => format!("undecided from {} on: {}\n", shown(lo), b.why),
            (None, Some(hi)) => format!("undecided up to {}: {}\n", shown(hi), b.why),
            (None, None) => format!("undecided: {}\n", b.why),
        }
    };
    brackets.iter().map(line).collect()
}

/// A row for each end: value, cause, frequency, margin; those of the interval with the nominal value first.
fn end_lines(set: &StableSet, problem: &Problem, digits: usize) -> String {
    let mut columns = Columns::new("    ");
    let mut ends: Vec<&End> = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().collect();
    // Two intervals that touch share an end.
    ends.dedup_by(|b, a| a.value.is_same(&b.value));
    let values: Vec<&Real> = ends.iter().map(|end| &end.value).collect();
    let ends: Vec<(&End, String)> = ends.iter().copied().zip(distinct_decimals(&values, digits)).collect();
    let own = nominal_place(set, problem).map(|k| &set.intervals()[k]);
    let is_own = |(end, _): &(&End, String)| {
        let own = own.iter().flat_map(|interval| [&interval.lower, &interval.upper]).flatten();
        own.into_iter().any(|x| x.value.is_same(&end.value))
    };
    let (first, rest): (Vec<_>, Vec<_>) = ends.into_iter().partition(is_own);
    for (end, decimal) in first.into_iter().chain(rest) {
        columns.row(end_cells(end, decimal, problem, digits));
    }
    if columns.is_empty() { String::new() } else { format!("ends\n{columns}") }
}

/// What is said of an end at which the search stopped.
pub(super) const UNDECIDED_BEYOND: &str = "no limit: what lies beyond is undecided";

fn end_cells(end: &End, decimal: String, problem: &Problem, digits: usize) -> Vec<String> {
    if end.causes.contains(Cause::Undecided) {
        return vec![decimal, String::new(), UNDECIDED_BEYOND.to_owned(), String::new()];
    }
    let exact = match end.value.exact() {
        Some(exact) if !is_decimal_of(&decimal, &exact) => match fraction(&exact) {
            Ok(whole) => format!("= {whole}"),
            Err(size) => format!("{size}, --json has it"),
        },
        _ => String::new(),
    };
    let places = digits.min(7);
    let frequency = real::ShownFrequency::new(places, |bits| problem.frequency(end, bits));
    let at = frequency.map(|f| f.words(places, "rad")).unwrap_or_default();
    let causes = region::causes_text(&end.causes, problem);
    let mut cause = if at.is_empty() { causes } else { format!("{causes} at {}", at.join(", ")) };
    if end.causes.contains(Cause::Pole) {
        cause.push_str(": the model is undefined here");
    } else if end.causes.contains(Cause::SquareRoot) {
        cause.push_str(": the number under it is negative beyond");
    } else if end.causes.contains(Cause::Duty) {
        cause.push_str(": no pulse, or no pause, is left");
    }
    let nominal = problem.parameter().nominal.as_ref();
    // A gain margin of a time means nothing in decibels.
    let is_time = problem.sample_time().is_some_and(|(n, d)| !(n.is_constant() && d.is_constant()));
    // The end of a domain is no limit of the loop.
    let nominal = nominal.filter(|_| end.causes.is_limit());
    let margin = margin(&end.value, nominal, places).and_then(|m| {
        let nominal = nominal.map(short).unwrap_or_default();
        // That an end at 0 is 0 x nominal goes without saying.
        let decibels = m.decibels?;
        let factor = format!("{} x nominal {nominal}", decimal_factor(&m.factor, places));
        Some(if is_time { factor } else { format!("{factor} ({decibels} dB)") })
    });
    vec![decimal, exact, cause, margin.unwrap_or_default()]
}

/// An exact factor as a decimal.
fn decimal_factor(factor: &str, digits: usize) -> String {
    match parse_number(factor) {
        Ok(value) => to_decimal(&value, digits),
        Err(_) => factor.to_owned(),
    }
}

fn is_decimal_of(decimal: &str, value: &Rational) -> bool {
    parse_number(decimal).as_ref() == Ok(value)
}

#[cfg(test)]
mod tests {
    use crate::Text;
    use jurist_algebra::limits::Budget;
    use jurist_engine::error::Source;
    use jurist_engine::model::Model;
    use jurist_engine::problem::Ask;

    #[test]
    fn the_interval_with_the_nominal_value_is_printed_first_and_the_document_is_ascending() {
        let (model, _) = Model::from_toml(&Source::new(
            "model.toml",
            "time = 'discrete'\n[parameters]\nK = { nominal = 5 }\n[loop]\ncharacteristic = 'z - 1/2*(K - 1)*(K - 3)*(K - 5)'\n",
        ))
        .unwrap();
        let answer = model.ask().free("K").stable_set(&Budget::unlimited()).unwrap();
        let text = answer.text(6);
        let lines: Vec<&str> = text.lines().filter(|line| line.contains("< K <")).map(str::trim).collect();
        let first = |line: &str| line.split(' ').next().unwrap().parse::<f64>().unwrap();
        assert!(lines.len() == 3 && first(lines[0]) > 4.0 && first(lines[1]) < first(lines[2]), "{text}");
        let ends: Vec<&str> = text.lines().skip_while(|line| *line != "ends").skip(1).collect();
        assert!(first(ends[0].trim()) > 4.0 && first(ends[2].trim()) < 2.0, "{text}");
        let ascending: Vec<_> =
            answer.value().intervals().iter().map(|i| i.lower.as_ref().unwrap().value.decimal(6)).collect();
        assert!(ascending[0].starts_with('0') && ascending[2].starts_with('4'), "{ascending:?}");
    }
}
