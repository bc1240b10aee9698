//! The least margins for people.

use super::for_all_text;
use super::intervals::heading;
use super::layout::named_values;
use super::real;
use super::response::cut_text;
use crate::Text;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::Answer;
use jurist_engine::response::{AllOf, Everywhere, LeastMargin, LeastMargins, Level};

/// What is proved has fewer digits than this: it is shown as it is.
const PROVED: usize = 12;

impl Text for Answer<LeastMargins> {
    /// A line for each margin: what all values have, and one value that has little more.
    fn text(&self, digits: usize) -> String {
        let found = self.value();
        let mut out = heading(self.problem()) + "\n";
        if let Some(cut) = &found.cut {
            out.push_str(&format!("cut {}\n", cut_text(cut)));
        }
        out.push_str(&for_all_text(&found.all, digits).expect("there is a name"));
        out.push_str(&match &found.stable {
            Everywhere::All => ": stable\n".to_owned(),
            Everywhere::NotAt(point) => format!(": not stable, as at {}\n", at_text(&found.all, point)),
            Everywhere::Open => ": not decided, too many parts of the ranges are open\n".to_owned(),
        });
        for margin in &found.margins {
            out.push_str(&line(margin, &found.all, digits));
        }
        out
    }
}

fn at_text(all: &[AllOf], point: &[Rational]) -> String {
    let named: Vec<(String, Rational)> = all.iter().map(|all| all.name.clone()).zip(point.iter().cloned()).collect();
    named_values(&named)
}

fn line(margin: &LeastMargin, all: &[AllOf], digits: usize) -> String {
    let unit = match margin.level {
        Level::PhaseMargin => " degrees",
        Level::DelayMargin => " s",
        _ => "",
    };
    let name = match margin.level {
        Level::ComplementaryPeak => "peak of the complementary sensitivity".to_owned(),
        level => level.name().replace('_', " "),
    };
    let bound = if margin.level.is_greatest_best() { "at least" } else { "at most" };
    let proved =
        margin.proved.as_ref().map(|proved| format!("{bound} {}{unit}", to_decimal(proved, digits.max(PROVED))));
    let found = margin.found.as_ref().map(|(value, point)| {
        let value = real::enclosed(digits, |_| Some(value.clone())).unwrap_or_else(|| to_decimal(value.lower(), 6));
        format!("{value}{unit} at {}", at_text(all, point))
    });
    let said = match (proved, found) {
        (Some(proved), Some(found)) => format!("{proved}; {found}"),
        (Some(proved), None) => format!("{proved}; no value that was looked at has a limit"),
        (None, found) => {
            let why = margin.why.as_deref().unwrap_or("not looked at");
            let found = found.map(|found| format!("; {found}")).unwrap_or_default();
            format!("not proved: {why}{found}")
        }
    };
    format!("{name}: {said}\n")
}
