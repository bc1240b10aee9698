//! Everything that is said about a loop one parameter at a time.

use super::intervals::{answer_lines, undecided_text};
use super::layout::{headline, named_values, short};
use super::verdict::verdict_line;
use crate::Text;
use jurist_engine::answer::Analysis;

impl Text for Analysis {
    /// The analysis for people.
    fn text(&self, digits: usize) -> String {
        let mut out = String::new();
        if let Some((point, verdict)) = &self.verdict {
            out.push_str(&format!("{}\n", headline(point.model())));
            if !point.set().is_empty() {
                out.push_str(&format!("at {}\n", named_values(point.set())));
            }
            let line = match verdict {
                Ok(verdict) => verdict_line(point, verdict),
                Err(stopped) => undecided_text(stopped),
            };
            out.push_str(&format!("    {line}\n"));
        } else if let Some((first, _)) = self.sets.first() {
            out.push_str(&format!("{}\n", headline(first.model())));
            // One parameter alone may be without a value: the one that is asked about.
            out.push_str(&format!("    no verdict: parameter {} has no nominal value\n", first.parameter().name));
        }
        for (problem, set) in &self.sets {
            let free = problem.parameter();
            let nominal = free.nominal.as_ref().map(|n| format!("{} = {} varied", free.name, short(n)));
            let nominal = nominal.unwrap_or_else(|| format!("{} varied", free.name));
            let others = match problem.set() {
                [] => String::new(),
                set => format!(", {}", named_values(set)),
            };
            out.push_str(&format!("\n{nominal}{others}\n"));
            out.push_str(&answer_lines(problem, set.as_ref(), digits));
        }
        out
    }
}
