//! Tolerances for people.

use super::bounded::{at_least, at_most};
use super::for_all_text;
use super::intervals::{heading, undecided_text};
use super::layout::{percent, short};
use super::real;
use super::verdict::verdict_line;
use crate::Text;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::{
    Answer, DelayedRoots, ExactFactor, PointVerdict, ToleranceAnswer, ToleranceLimit, Verdict, WorstEnd,
};
use jurist_engine::problem::Problem;
use jurist_engine::stability::AtPoint;
use jurist_engine::stability::boxes::{BoxDecision, LargestFactor, Side, Witness};
use std::fmt::Write;

/// A share below this does not matter.
const LEAST_SHARE: (i64, i64) = (1, 1000);

impl Text for Answer<ToleranceAnswer> {
    /// The answer for people: what is proved is rounded inwards, what is refuted outwards.
    fn text(&self, digits: usize) -> String {
        tolerance_text(self.problem(), Ok(self.value()), digits)
    }
}

/// The answer for people, also one that the budget did not allow.
pub fn tolerance_text(problem: &Problem, answer: Result<&ToleranceAnswer, &Exhausted>, digits: usize) -> String {
    let mut out = format!("{}\n", heading(problem));
    match answer {
        Err(stopped) => writeln!(out, "tolerances: {}", undecided_text(stopped)),
        Ok(answer) => write!(out, "{}", Shown { problem, answer, digits }.text()),
    }
    .expect("a text takes all text");
    out
}

struct Shown<'a> {
    problem: &'a Problem,
    answer: &'a ToleranceAnswer,
    digits: usize,
}

impl Shown<'_> {
    fn text(&self) -> String {
        let mut out = self.decision();
        for found in &self.answer.required {
            let what = match &found.decision {
                BoxDecision::Stable(_) if found.cells == 1 => "met for all values (proof: 1 cell)".to_owned(),
                BoxDecision::Stable(_) => format!("met for all values (proof: {} cells)", found.cells),
                BoxDecision::NotStable { .. } => "not met for all values".to_owned(),
                BoxDecision::Undecided { why, .. } => format!("undecided ({why})"),
            };
            let _ = writeln!(out, "    {}: {what}", found.requirement.text());
        }
        if let Some(factor) = self.answer.factor.as_ref().filter(|_| self.has_width()) {
            out.push_str(&self.factor(factor));
        }
        if let Some(volume) = &self.answer.volume {
            let _ = writeln!(
                out,
                "of the box       {} stable, {} not, {} undecided ({} {})",
                percent(&volume.stable, 4),
                percent(&volume.unstable, 4),
                percent(&volume.undecided, 4),
                volume.boxes,
                if volume.boxes == 1 { "box" } else { "boxes" }
            );
            if let Some(stopped) = &volume.stopped {
                let _ = writeln!(out, "                 stopped early: {stopped}");
            }
        }
        if let Some(limit) = &self.answer.limit {
            out.push_str(&self.limit(limit));
        }
        out
    }

    /// `8 tolerances of 20 %`.
    fn asked(&self) -> String {
        let with_width: Vec<&Side> = self.tolerances().collect();
        let count = with_width.len();
        let share = |side: &Side| {
            let [low, high] = side.widths();
            (low == high).then(|| low.checked_div(&side.nominal().abs())).flatten()
        };
        let shares: Option<Vec<Rational>> = with_width.iter().map(|side| share(side)).collect();
        let noun = if count == 1 { "tolerance" } else { "tolerances" };
        match shares.as_deref() {
            Some([first, rest @ ..]) if rest.iter().all(|s| s == first) => {
                let percent = first * &Rational::from(100);
                let text = short(&percent);
                // A fraction comes of a tolerance that is a number.
                let text = if text.contains('/') { format!("about {}", to_decimal(&percent, 4)) } else { text };
                format!("{count} {noun} of {text} %")
            }
            _ => format!("{count} {noun}"),
        }
    }

    /// The tolerances that are more than a point.
    fn tolerances(&self) -> impl Iterator<Item = &Side> {
        self.answer.sides.iter().filter(|side| side.grows() && side.has_width())
    }

    /// Whether any tolerance is more than a point.
    fn has_width(&self) -> bool {
        self.tolerances().next().is_some()
    }

    /// Whether a point is the nominal one.
    fn is_nominal(&self, point: &[Rational]) -> bool {
        self.answer.sides.iter().zip(point).all(|(side, value)| side.nominal() == value)
    }

    fn decision(&self) -> String {
        let mut asked = match self.has_width() {
            true => self.asked(),
            false => "all tolerances are 0".to_owned(),
        };
        let ranges = self.answer.ranges(self.problem);
        if let Some(ranges) = for_all_text(&ranges, self.digits.min(12)) {
            asked = format!("{ranges}: {asked}");
        }
        match &self.answer.decision {
            BoxDecision::Stable(proof) => {
                let cells = proof.cells();
                let noun = if cells == 1 { "cell" } else { "cells" };
                let with = if self.answer.required.is_empty() { "" } else { ", and meets all requirements," };
                let is_point = !self.answer.sides.iter().any(Side::has_width);
                let what = if is_point { "at the nominal point" } else { "for all values" };
                format!("{asked}: stable{with} {what} (proof: {cells} {noun})\n")
            }
            BoxDecision::NotStable { witness } => {
                let what =
                    if self.answer.required.is_empty() { "not stable" } else { "not stable with all requirements met" };
                let mut out = format!("{asked}: {what} for all values\n");
                if let Some(witness) = witness {
                    let point: Vec<String> = self
                        .names()
                        .zip(&witness.point)
                        .map(|(name, value)| format!("{name} = {}", with_decimal(value)))
                        .collect();
                    let found = PointVerdict::of_witness(witness, self.problem);
                    let line = match found.verdict {
                        Verdict::Stable => "stable, but not all requirements are met".to_owned(),
                        _ => verdict_line(self.problem, &found),
                    };
                    let what = if self.is_nominal(&witness.point) { ", the nominal point" } else { "" };
                    let _ = writeln!(out, "    not at {}{what}: {line}", point.join(", "));
                }
                out
            }
            BoxDecision::Undecided { why, cell } => {
                let cell: Vec<String> = self
                    .names()
                    .zip(cell)
                    .map(|(name, [low, high])| format!("{} <= {name} <= {}", to_decimal(low, 6), to_decimal(high, 6)))
                    .collect();
                format!("{asked}: undecided ({why}), last in {}\n", cell.join(", "))
            }
        }
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.problem.free().iter().map(|free| free.name.as_str())
    }

    fn factor(&self, factor: &LargestFactor) -> String {
        let digits = self.digits.min(12);
        let mut out = String::new();
        let lower = at_most(&factor.lower, digits);
        match &factor.upper {
            Some(upper) => {
                let label = if *upper <= Rational::ONE { "they must shrink" } else { "they can grow   " };
                let _ = writeln!(out, "{label} {lower} < factor <= {}", at_least(upper, digits));
            }
            None => {
                let _ = writeln!(out, "they can grow    {lower} <= factor; no worse point was found");
            }
        }
        if let Some(exact) = &self.answer.exact {
            let _ = writeln!(out, "                 exactly {}", self.exactly(exact));
        }
        if let Some(domain) = &self.answer.domain_factor
            && factor.upper.as_ref().is_none_or(|upper| upper >= domain)
        {
            let _ = writeln!(out, "                 at {} a parameter reaches the end of its domain", short(domain));
        }
        if let Some((why, _)) = &factor.open {
            let _ = writeln!(out, "                 a narrower bracket is undecided: {why}");
        }
        if let Some(direction) = &factor.direction {
            let beyond = factor.witness.as_ref().map(|w| self.beyond(w)).unwrap_or_default();
            let signs = self.signs(direction, factor.shares.as_deref());
            let end = self.answer.worst.as_ref().map(end_words).unwrap_or_default();
            let binding = self.answer.binding.map(|k| &self.answer.required[k].requirement);
            let what = binding.map_or(end, |requirement| format!("    {}", requirement.text()));
            let beyond = if binding.is_some() { ", not met just beyond" } else { beyond.as_str() };
            let _ = writeln!(out, "worst point      {signs}{what}{beyond}");
        }
        if let Some(shares) = self.answer.shares() {
            let _ = writeln!(out, "the margin is used by    {}", self.shares(shares));
        }
        out
    }

    /// `the root 2.61.. of a polynomial of degree 2 (proof: 5 cells)`
    fn exactly(&self, exact: &ExactFactor) -> String {
        let digits = self.digits.max(12);
        let number = match (exact.value.exact(), exact.value.algebraic().and_then(|v| v.polynomial().degree())) {
            (Some(number), _) => short(&number),
            (None, Some(degree)) => {
                format!("the root {} of a polynomial of degree {degree}", exact.value.decimal(digits))
            }
            (None, None) => format!("{}.., known to any digits", exact.value.decimal(digits)),
        };
        match &exact.proof {
            Some(proof) => format!("{number} (proof: {} cells)", proof.cells()),
            None => number,
        }
    }

    /// `, 2 roots outside just beyond`; `, 1 root at infinity there` where the degree is lost.
    fn beyond(&self, witness: &Witness) -> String {
        let Some(at) = &witness.at else { return String::new() };
        let own = PointVerdict::of_witness(witness, self.problem);
        if let Some(DelayedRoots { on, right, .. }) = own.delayed {
            return match (right, on) {
                (Some(0), 0) => String::new(),
                (Some(0), _) => ", on the boundary there".to_owned(),
                (Some(n), _) => format!(", {} to the right just beyond", number_of_roots(n)),
                (None, _) => ", infinitely many roots to the right just beyond".to_owned(),
            };
        }
        match (at, own.count) {
            (AtPoint::Defined { .. }, Some(count)) if own.infinite > 0 => {
                let beside = if count.outside > 0 {
                    format!(", {} outside", number_of_roots(count.outside))
                } else {
                    String::new()
                };
                format!("{beside}, {} at infinity there", number_of_roots(own.infinite))
            }
            (AtPoint::Defined { .. }, Some(count)) if count.outside > 0 => {
                format!(", {} outside just beyond", number_of_roots(count.outside))
            }
            (AtPoint::Defined { .. }, Some(count)) if count.on > 0 => format!(", {} on the boundary there", count.on),
            (AtPoint::Undefined, _) => ", undefined there".to_owned(),
            _ => String::new(),
        }
    }

    /// The signs of the parameters in the order of their shares, each behind its name.
    fn signs(&self, direction: &[Rational], shares: Option<&[Rational]>) -> String {
        let mut order: Vec<usize> = (0..direction.len()).collect();
        if let Some(shares) = shares {
            order.sort_by(|&i, &j| shares[j].cmp(&shares[i]));
        }
        let names: Vec<&str> = self.names().collect();
        let sign = |i: usize| {
            let name = names[i];
            match sign_name(&direction[i]) {
                "inside" => format!("{name} inside"),
                sign => format!("{name} {sign}"),
            }
        };
        order.into_iter().map(sign).collect::<Vec<_>>().join(", ")
    }

    fn shares(&self, mut shares: Vec<(usize, Rational)>) -> String {
        let names: Vec<&str> = self.names().collect();
        shares.sort_by(|(_, a), (_, b)| b.cmp(a));
        let least = Rational::new(LEAST_SHARE.0.into(), LEAST_SHARE.1.into());
        let (large, small): (Vec<_>, Vec<_>) = shares.into_iter().partition(|(_, share)| *share >= least);
        let mut parts: Vec<String> =
            large.iter().map(|(i, share)| format!("{} {}", names[*i], percent(share, 3))).collect();
        if !small.is_empty() {
            let rest = small.iter().fold(Rational::ZERO, |sum, (_, share)| sum + share);
            let which = match small.as_slice() {
                [(only, _)] => names[*only].to_owned(),
                several => format!("the other {}", several.len()),
            };
            parts.push(format!("{which} {}", percent(&rest, 1)));
        }
        parts.join("   ")
    }

    fn limit(&self, limit: &ToleranceLimit) -> String {
        let name = &limit.parameter;
        let digits = self.digits.min(12);
        let [Some(lower), Some(upper)] = &limit.sides else {
            return format!("{name}: not stable for all values of the others even at {}\n", short(&limit.nominal));
        };
        let mut out = format!(
            "{name}: stable for all values of the others while    {} <= {name} <= {}\n",
            at_least(&lower.safe, digits),
            at_most(&upper.safe, digits)
        );
        for (side, is_upper) in [(lower, false), (upper, true)] {
            let Some(value) = &side.unsafe_at else {
                let _ = writeln!(out, "    {}", self.no_end(name, &side.safe, is_upper));
                continue;
            };
            let shown = if is_upper { at_least(value, digits) } else { at_most(value, digits) };
            let what = side.worst.as_ref().map(end_words).unwrap_or_default();
            let direction = side.factor.direction.as_deref().unwrap_or_default();
            let signs = self.signs(direction, side.factor.shares.as_deref());
            let _ = writeln!(out, "    not at {shown}: {signs}{what}");
        }
        out
    }

    /// What is said of a side on which no value is known that is not stable.
    fn no_end(&self, name: &str, safe: &Rational, is_upper: bool) -> String {
        let domain = self.problem.free().iter().find(|free| free.name == name).map(|free| &free.domain);
        let end = domain.and_then(|domain| if is_upper { domain.upper.as_ref() } else { domain.lower.as_ref() });
        let digits = self.digits.min(12);
        let shown = if is_upper { at_most(safe, digits) } else { at_least(safe, digits) };
        let side = if is_upper { "above" } else { "below" };
        match end {
            Some(end) if end == safe => format!("{shown} is the end of its domain"),
            Some(end) => {
                format!("{side} {shown}: no value was found that is not stable; its domain ends at {}", short(end))
            }
            None => format!("{side} {shown}: no value was found that is not stable"),
        }
    }
}

/// `1 root`, `2 roots`.
fn number_of_roots(n: usize) -> String {
    format!("{n} {}", if n == 1 { "root" } else { "roots" })
}

/// `+`, `-` or `inside`.
pub(crate) fn sign_name(share: &Rational) -> &'static str {
    if share.abs() != Rational::ONE {
        "inside"
    } else if share.is_negative() {
        "-"
    } else {
        "+"
    }
}

/// `    complex pair at 1664.067 Hz, 1.045564 rad`
fn end_words(worst: &WorstEnd) -> String {
    let mut out = format!("    {}", worst.end.causes);
    let at = |bits: u64| worst.problem.frequency(&worst.end, bits);
    if let Some(first) = at(64) {
        let shown = |part: fn(&jurist_engine::answer::Frequency) -> Option<jurist_algebra::number::Enclosure>| {
            part(&first)?;
            real::enclosed(7, |bits| at(bits).as_ref().and_then(part))
        };
        let parts = [
            shown(|f| f.hertz.clone()).map(|t| format!("{t} Hz")),
            shown(|f| f.radians_per_second.clone()).map(|t| format!("{t} rad/s")),
            shown(|f| f.angle.clone()).map(|t| format!("{t} rad")),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        if !parts.is_empty() {
            let _ = write!(out, " at {}", parts.join(", "));
        }
    }
    out
}

/// The number, and a decimal beside what is a fraction.
fn with_decimal(value: &Rational) -> String {
    /// Digits of the decimal.
    const DIGITS: usize = 6;
    let exact = short(value);
    if exact.contains('/') { format!("{exact} ({}..)", to_decimal(value, DIGITS)) } else { exact }
}
