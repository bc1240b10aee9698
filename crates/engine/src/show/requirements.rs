//! Requirements for people.

use super::intervals::{free_domain_text, heading, nominal_first, nowhere, undecided_lines};
use super::layout::Columns;
use super::{real, region};
use crate::answer::Answer;
use crate::response::{Found, RequiredEnd, RequiredSet, Requirement, RequirementMet};
use jurist_algebra::number::{Rational, parse_number};

impl Answer<RequiredSet> {
    /// The set for people: the intervals, and a line for each end.
    pub fn text(&self, requirements: &[Requirement], digits: usize) -> String {
        let problem = self.problem();
        let name = &problem.parameter().name;
        let mut asked = name.clone();
        let domain = free_domain_text(problem.parameter());
        if domain != "all" {
            asked.push_str(&format!(", domain {domain}"));
        }
        let wanted: Vec<String> = requirements.iter().map(Requirement::text).collect();
        let goal = format!("{}, {}", region::goal_or_stable(problem), wanted.join(", "));
        let mut out = format!("{}\n{asked}: {goal}", heading(problem));
        let undecided = undecided_lines(&self.value().undecided, digits);
        if self.value().intervals.is_empty() {
            return out + " " + nowhere(&self.value().undecided) + "\n" + &undecided;
        }
        out.push_str(" for\n");
        let mut columns = Columns::new("    ");
        let intervals = &self.value().intervals;
        let nominal = problem.parameter().nominal.as_ref();
        let place = nominal.and_then(|x| intervals.iter().position(|interval| interval.contains(x)));
        for interval in nominal_first(intervals.iter().collect(), place) {
            let decimal = |end: &RequiredEnd| real::rounded(&end.value(), digits).decimal;
            let sign = |end: &RequiredEnd| {
                let is_closed = match end {
                    RequiredEnd::Requirement { closed, .. } => *closed,
                    RequiredEnd::Stability(end) => end.closed,
                };
                if is_closed { "<=" } else { "<" }
            };
            let line = match (&interval.lower, &interval.upper) {
                (None, None) => format!("every {name}"),
                (Some(l), None) => format!("{} {} {name}", decimal(l), sign(l)),
                (None, Some(u)) => format!("{name} {} {}", sign(u), decimal(u)),
                (Some(l), Some(u)) => format!("{} {} {name} {} {}", decimal(l), sign(l), sign(u), decimal(u)),
            };
            out.push_str(&format!("    {line}\n"));
            for end in [&interval.lower, &interval.upper].into_iter().flatten() {
                let why = match end {
                    RequiredEnd::Stability(end) => region::causes_text(&end.causes, problem),
                    RequiredEnd::Requirement { names, .. } => names.join("+"),
                };
                columns.row([decimal(end), why]);
            }
        }
        format!("{out}ends\n{columns}{undecided}")
    }
}

impl RequirementMet {
    /// How far the loop is from the required number, as a share of that: positive where it is met, rounded; `None` where there is no
    /// bound, where it is about roots, and of a loop that is not stable.
    pub fn margin_left(&self) -> Option<Rational> {
        /// Significant digits that it is made of.
        const DIGITS: usize = 12;
        let found = parse_number(&self.value(DIGITS)?).ok()?;
        let required = self.requirement.required_number(DIGITS)?;
        let more = (&found - &required).checked_div(&required)?;
        Some(if self.requirement.is_least() { more } else { -more })
    }

    /// The margin that the loop has, rounded; `None` where there is no bound, and of a loop that is not stable.
    pub fn value(&self, digits: usize) -> Option<String> {
        let all = self.margins.as_ref()?;
        let margins = all.stable.as_ref()?;
        match self.requirement.found(all, margins)? {
            Found::Number(number) => Some(real::rounded(&number, digits).decimal),
            Found::Enclosed(enclose) => real::enclosed(digits, enclose),
        }
    }

    /// `phase_margin >= 45 deg: met (57.07)`.
    pub fn text(&self, digits: usize) -> String {
        // A gain margin is found as a factor, whatever it was asked in.
        let unit = if self.requirement.required().ends_with("dB") { " as a factor" } else { "" };
        let value = self.value(digits).map(|v| format!(" ({v}{unit})")).unwrap_or_default();
        let verdict = if self.met { "met" } else { "not met" };
        format!("{}: {verdict}{value}", self.requirement.text())
    }
}
