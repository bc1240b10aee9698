//! Requirements for people.

use super::intervals::{
    UNDECIDED_BEYOND, free_domain_text, heading, intervals_text, nominal_first, nowhere, undecided_lines,
};
use super::layout::Columns;
use super::map::for_all_text;
use super::{real, region};
use crate::Text;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::Answer;
use jurist_engine::problem::Problem;
use jurist_engine::response::{Found, MarginRanges, RequiredEnd, RequiredSet, Requirement, RequirementMet};
use jurist_engine::stability::Cause;

/// The set for people: the intervals, and a line for each end.
pub fn required_text(answer: &Answer<RequiredSet>, requirements: &[Requirement], digits: usize) -> String {
    let problem = answer.problem();
    let name = &problem.parameter().name;
    let mut asked = name.clone();
    let domain = free_domain_text(problem.parameter());
    if domain != "all" {
        asked.push_str(&format!(", domain {domain}"));
    }
    if let Some(all) = for_all_text(&answer.value().for_all, digits) {
        asked.push_str(&format!(", {all}"));
    }
    let wanted = requirements.iter().map(|r| format!(", {}", r.text()));
    let goal = wanted.fold(region::goal_or_stable(problem).to_string(), |goal, one| goal + &one);
    let mut out = format!("{}\n{asked}: {goal}", heading(problem));
    let undecided = undecided_lines(&answer.value().undecided, digits);
    if answer.value().intervals.is_empty() {
        return out + " " + nowhere(&answer.value().undecided) + "\n" + &undecided;
    }
    let (lines, ends) = interval_lines(answer.value(), problem, digits);
    out.push_str(" for\n");
    lines.iter().for_each(|line| out.push_str(&format!("    {line}\n")));
    let mut columns = Columns::new("    ");
    ends.into_iter().for_each(|end| columns.row(end));
    format!("{out}ends\n{columns}{undecided}")
}

/// The intervals, that with the nominal value first, and each end with what binds there.
fn interval_lines(set: &RequiredSet, problem: &Problem, digits: usize) -> (Vec<String>, Vec<[String; 2]>) {
    let (name, nominal) = (&problem.parameter().name, problem.parameter().nominal.as_ref());
    let place = nominal.and_then(|x| set.intervals.iter().position(|interval| interval.contains(x)));
    let decimal = |end: &RequiredEnd| real::rounded(&end.value(), digits).decimal;
    let (mut lines, mut ends) = (Vec::new(), Vec::new());
    for interval in nominal_first(set.intervals.iter().collect(), place) {
        let sign = |end: &RequiredEnd| if end.is_closed() { "<=" } else { "<" };
        lines.push(match (&interval.lower, &interval.upper) {
            (None, None) => format!("every {name}"),
            (Some(l), None) => format!("{} {} {name}", decimal(l), sign(l)),
            (None, Some(u)) => format!("{name} {} {}", sign(u), decimal(u)),
            (Some(l), Some(u)) => format!("{} {} {name} {} {}", decimal(l), sign(l), sign(u), decimal(u)),
        });
        for end in [&interval.lower, &interval.upper].into_iter().flatten() {
            let why = match end {
                RequiredEnd::Stability(end) if end.causes.contains(Cause::Undecided) => UNDECIDED_BEYOND.to_owned(),
                RequiredEnd::Stability(end) => region::causes_text(&end.causes, problem),
                RequiredEnd::Requirement { names, .. } => names.join("+"),
            };
            ends.push([decimal(end), why]);
        }
    }
    (lines, ends)
}

impl Text for Answer<MarginRanges> {
    /// The ranges for people: of stability, and of each margin.
    fn text(&self, digits: usize) -> String {
        let problem = self.problem();
        let mut out = intervals_text(problem, Ok(&self.value().stable), digits);
        for level in &self.value().levels {
            let asked = level.requirement.text();
            let set = match &level.found {
                Ok(set) => set,
                Err(why) => {
                    out.push_str(&format!("{asked}: not decided: {why}\n"));
                    continue;
                }
            };
            if set.intervals.is_empty() {
                out.push_str(&format!("{asked} {}\n", nowhere(&set.undecided)));
            } else {
                out.push_str(&format!("{asked} for\n"));
                let lines = interval_lines(set, problem, digits).0;
                lines.iter().for_each(|line| out.push_str(&format!("    {line}\n")));
            }
            out.push_str(&undecided_lines(&set.undecided, digits));
        }
        out
    }
}

/// How far the loop is from the required number, as a share of that: positive where it is met, rounded; `None` where there is no
/// bound, where it is about roots, and of a loop that is not stable.
pub fn margin_left(met: &RequirementMet) -> Option<Rational> {
    /// Significant digits that it is made of.
    const DIGITS: usize = 12;
    let found = parse_number(&required_value(met, DIGITS)?).ok()?;
    let required = met.requirement.required_number(DIGITS)?;
    let more = (&found - &required).checked_div(&required)?;
    Some(if met.requirement.is_least() { more } else { -more })
}

/// The margin that the loop has, rounded; `None` where there is no bound, and of a loop that is not stable.
pub fn required_value(met: &RequirementMet, digits: usize) -> Option<String> {
    match met.found()? {
        Found::Number(number) => Some(real::rounded(&number, digits).decimal),
        Found::Enclosed(enclose) => real::enclosed(digits, enclose),
    }
}

impl Text for RequirementMet {
    /// `phase_margin >= 45 deg: met (57.07)`.
    fn text(&self, digits: usize) -> String {
        // A gain margin is found as a factor, whatever it was asked in.
        let unit = if self.requirement.required().contains(" dB") { " as a factor" } else { "" };
        let value = required_value(self, digits).map(|v| format!(" ({v}{unit})")).unwrap_or_default();
        let verdict = if self.met { "met" } else { "not met" };
        format!("{}: {verdict}{value}", self.requirement.text())
    }
}
