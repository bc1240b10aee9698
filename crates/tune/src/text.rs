//! The answer for people.

use crate::answer::{Best, Optimum, Outcome, Place, TuneAnswer};
use crate::asked::Objective;
use crate::decimals::on_side;
use crate::reading::Reading;
use jurist_algebra::number::{Enclosure, Rational, parse_number, to_decimal};
use jurist_algebra::poly::{MultiPoly, RealAlgebraic};
use jurist_algebra::real::Real;
use jurist_engine::problem::Bound;
use jurist_engine::response::Level;
use jurist_show::intervals::heading;
use jurist_show::layout::{self, short};
use jurist_show::real::{enclosed, rounded};
use jurist_show::region::causes_text;
use jurist_show::{Text, for_all_text};
use jurist_stability::Cause;
use std::fmt::Write;

/// What a text takes.
const TAKES: &str = "a text takes all text";

/// Digits of a share that is lost.
const FEW: usize = 3;

/// Bits of a number that is rounded to few digits.
const BITS: u64 = 64;

/// Digits of the level of the gains that are typed in.
const MOST_OF_TYPED: usize = 12;

/// Polynomials of a greater degree or with longer coefficients are not printed.
const MOST_DEGREE: usize = 8;
const MOST_BITS: u64 = 64;

impl TuneAnswer {
    /// The answer for people.
    pub fn text(&self, digits: usize) -> String {
        let mut out = format!("{}\n", heading(&self.problem));
        let asked = &self.asked;
        let names: Vec<&str> = asked.gains.iter().map(|gain| gain.name.as_str()).collect();
        let required: Vec<String> = self.required();
        let whole =
            if required.is_empty() { "stability".to_owned() } else { format!("stability, {}", required.join(", ")) };
        writeln!(out, "{} free, required: {whole}", names.join(", ")).expect(TAKES);
        if let Some(all) = for_all_text(&asked.for_all, digits) {
            writeln!(out, "{all}").expect(TAKES);
        }
        match &self.outcome {
            Outcome::Infeasible { conflict, cells } => self.conflict_text(&mut out, conflict, *cells),
            Outcome::Optimum(optimum) => self.optimum_text(&mut out, optimum, digits),
            Outcome::Open { proved, .. } => self.open_text(&mut out, proved.as_ref(), digits),
        }
        if self.are_bounds_missing {
            let gains = names.iter().map(|name| format!("--bound {name}=LO..HI")).collect::<Vec<_>>().join(" ");
            writeln!(out, "with bounds for both gains the search is another one, which mostly ends sooner: {gains}")
                .expect(TAKES);
        }
        out
    }

    /// What is required, in words.
    pub(crate) fn required(&self) -> Vec<String> {
        let list = &self.asked.requirements;
        let mut out: Vec<String> = list.regional.iter().map(|(name, text)| regional(name, text)).collect();
        if out.is_empty()
            && let Some(region) = &list.region
            && let Bound::Number(bound) = region.bound()
        {
            out.push(regional(region.bound_name(), &short(bound)));
        }
        out.extend(list.list.iter().map(jurist_engine::response::Requirement::text));
        out
    }

    fn open_text(&self, out: &mut String, proved: Option<&Rational>, digits: usize) {
        writeln!(out, "whether any gains meet this was not decided").expect(TAKES);
        if let Some(proved) = proved {
            let value = Reading::of(&self.asked).shown(&Real::from(proved.clone()), digits);
            writeln!(out, "    {}: none better than {value}", self.asked.wanted()).expect(TAKES);
        }
    }

    fn conflict_text(&self, out: &mut String, conflict: &[String], cells: Option<usize>) {
        let (within, proof) = match cells {
            Some(cells) => (" within the bounds", format!(" (proof: {})", counted(cells))),
            None => ("", String::new()),
        };
        writeln!(out, "no gains{within} meet all of this{proof}").expect(TAKES);
        match conflict {
            [] => writeln!(out, "    not even stability is reached{within}"),
            [one] => writeln!(out, "    no stable loop{within} has {one}"),
            _ => writeln!(out, "    these exclude each other: {}", conflict.join(", ")),
        }
        .expect(TAKES);
    }

    fn optimum_text(&self, out: &mut String, optimum: &Optimum, digits: usize) {
        self.value_text(out, optimum, digits);
        if !matches!(optimum.value, Best::Nothing) {
            self.places_text(out, optimum, digits);
        }
        if !optimum.binding.is_empty() && !matches!(optimum.value, Best::Nothing) {
            let words: Vec<String> = optimum.binding.iter().map(|name| self.binding_text(name)).collect();
            writeln!(out, "    binds: {}", words.join(", ")).expect(TAKES);
        }
        self.typed_text(out, optimum, digits);
    }

    /// What binds, in words: the name of a requirement, of the number that is best, of a cause or a bound.
    fn binding_text(&self, name: &str) -> String {
        if self.asked.level().is_some_and(|level| level.name() == name) {
            return format!("{} itself", Reading::of(&self.asked).name());
        }
        let Some(cause) = Cause::named(name) else { return name.to_owned() };
        let at = causes_text(&cause.into(), &self.problem);
        match cause {
            Cause::RootAtOne | Cause::RootAtMinusOne | Cause::RootAtZero => format!("stability (a root at {at})"),
            Cause::Domain => "the end of a gain's domain".to_owned(),
            Cause::Undecided => "nothing that is known: what lies beyond is undecided".to_owned(),
            Cause::Pole => "the loop, which is undefined there".to_owned(),
            Cause::SquareRoot => "a square root: the number under it is negative beyond".to_owned(),
            Cause::Duty => "the duty ratio: no pulse, or no pause, is left".to_owned(),
            Cause::ComplexPair | Cause::ComplexRoot | Cause::DegreeLost | Cause::Neutral => format!("stability ({at})"),
        }
    }

    fn value_text(&self, out: &mut String, optimum: &Optimum, digits: usize) {
        let asked = &self.asked;
        let wanted = asked.wanted();
        let reading = Reading::of(asked);
        match &optimum.value {
            Best::Nothing if asked.objective == Objective::Anything => {
                writeln!(out, "there are gains that meet all of this")
            }
            Best::Nothing => writeln!(out, "{wanted}: not decided; there are gains that meet all of this"),
            Best::Unbounded if asked.level() == Some(Level::PhaseMargin) => {
                writeln!(
                    out,
                    "{wanted}: no phase limits the loop, since the open loop is smaller than 1 at all frequencies"
                )
            }
            Best::Unbounded if matches!(asked.objective, Objective::Tolerance(_)) && optimum.at.is_empty() => {
                writeln!(out, "{wanted}: it has no bound, since gains near to 0 may be multiplied by any factor")
            }
            Best::Unbounded if asked.level() == Some(Level::DelayMargin) => {
                writeln!(out, "{wanted}: none, the loop is stable with any delay")
            }
            Best::Unbounded => writeln!(out, "{wanted}: it has no bound"),
            Best::Zero => writeln!(out, "{wanted}: 0"),
            Best::Exact(value) => {
                let reached = if optimum.attained == Some(false) { ", which is not reached" } else { "" };
                writeln!(out, "{wanted}: {}{}{reached}", reading.shown(value, digits), reading.unit())
            }
            Best::Between([found, proved]) => {
                let [low, high] = bracket(&reading, found, proved);
                let proof = optimum.cells.map(proof).unwrap_or_default();
                writeln!(out, "{wanted}: between {low} and {high}{}{proof}", reading.unit())
            }
        }
        .expect(TAKES);
        if let Best::Exact(value) = &optimum.value
            && let Some(polynomial) = reading.is_its_own_scale().then(|| root_of(value)).flatten()
        {
            writeln!(out, "    exactly a root of {polynomial}").expect(TAKES);
        }
    }

    fn places_text(&self, out: &mut String, optimum: &Optimum, digits: usize) {
        let asked = &self.asked;
        if matches!(asked.objective, Objective::Anything) {
            return;
        }
        let places = asked.gains.iter().zip(&optimum.at).enumerate();
        let is_own = |i: usize| matches!(asked.objective, Objective::Greatest(k) | Objective::Least(k) if k == i);
        let places = places.filter(|(i, _)| !is_own(*i)).map(|(_, (gain, place))| match place {
            Place::Exact(x) => format!("{} = {}", gain.name, rounded(x, digits).decimal),
            Place::Between([low, high]) => format!("{} {}", gain.name, enclosed_number(low, high, digits)),
            Place::From((Some(low), Some(high))) => format!("any {} {}", gain.name, range(low, high)),
            Place::From((Some(low), None)) => format!("any {} from {}", gain.name, to_decimal(low, 6)),
            Place::From((None, Some(high))) => format!("any {} up to {}", gain.name, to_decimal(high, 6)),
            Place::From((None, None)) => format!("any {}", gain.name),
            Place::Unbounded => format!("{} that grows without end", gain.name),
        });
        let places: Vec<String> = places.collect();
        if !places.is_empty() {
            let word = match (&optimum.value, optimum.attained) {
                (Best::Between(_), _) => "found",
                (_, Some(false)) => "approached at",
                _ => "at",
            };
            writeln!(out, "    {word} {}", places.join(", ")).expect(TAKES);
        }
    }

    fn typed_text(&self, out: &mut String, optimum: &Optimum, digits: usize) {
        let asked = &self.asked;
        let reading = Reading::of(asked);
        let values = |values: &[Rational]| -> String {
            let named = asked.gains.iter().zip(values);
            named.map(|(gain, x)| format!("{} = {}", gain.name, short(x))).collect::<Vec<_>>().join(", ")
        };
        match &optimum.typed {
            Some(typed) => {
                let mut line = format!("type in {}", values(&typed.values));
                if let Some(value) = &typed.value {
                    let value = || enclosed(digits.min(MOST_OF_TYPED), |_| Some(value.clone())).unwrap_or_default();
                    match &asked.objective {
                        Objective::Level(_) | Objective::SettlingTime(_) | Objective::Norm(_) => {
                            line.push_str(&format!(": {} {}{}", reading.name(), value(), reading.unit()));
                        }
                        Objective::Formula { text, .. } => line.push_str(&format!(": {text} = {}", value())),
                        Objective::Greatest(_)
                        | Objective::Least(_)
                        | Objective::Tolerance(_)
                        | Objective::Anything => {}
                    }
                }
                writeln!(out, "{line}{}", self.loss_text(optimum)).expect(TAKES);
                for found in &typed.requirements {
                    writeln!(out, "    {}", found.text(digits)).expect(TAKES);
                }
            }
            None => {
                let least = optimum.found_value.as_ref().filter(|_| asked.level().is_some());
                let least = least.and_then(|scale| {
                    let is_below = reading.is_greatest_best();
                    let value = to_decimal(&one_sided(&reading, scale, FEW as i64, is_below)?, FEW);
                    let word = if is_below { "at least" } else { "at most" };
                    Some(format!(", which has {word} {value}{}", reading.unit()))
                });
                writeln!(out, "for example {}{}", values(&optimum.found), least.unwrap_or_default()).expect(TAKES);
            }
        }
    }

    fn loss_text(&self, optimum: &Optimum) -> String {
        match (self.share_lost(optimum), &optimum.value) {
            (None, _) => String::new(),
            (Some(lost), _) if lost.is_zero() => ", no loss".to_owned(),
            (Some(lost), value) => match (layout::percent(&lost, FEW), value) {
                (shown, Best::Between(_)) if !shown.starts_with("below") => {
                    format!(", loss at most {} %", percent_above(&lost))
                }
                (shown, _) => format!(", loss {shown}"),
            },
        }
    }

    /// What the gains that are typed in lose, in per cent; `None` where it is not a number, and of a bracket.
    pub(crate) fn lost(&self, optimum: &Optimum) -> Option<String> {
        let is_exact = matches!(optimum.value, Best::Exact(_));
        self.share_lost(optimum).filter(|_| is_exact).map(|lost| percent(&lost))
    }

    /// What they lose as a share; of a bracket the most that it may be.
    fn share_lost(&self, optimum: &Optimum) -> Option<Rational> {
        let typed = optimum.typed.as_ref()?;
        let is_best =
            |(place, x): (&Place, &Rational)| matches!(place, Place::Exact(best) if best.compare_rational(x).is_eq());
        let is_exact = matches!(optimum.value, Best::Exact(_)) && optimum.attained == Some(true);
        if is_exact && optimum.at.len() == typed.values.len() && optimum.at.iter().zip(&typed.values).all(is_best) {
            return Some(Rational::ZERO);
        }
        let value = typed.value.as_ref()?.lower().clone();
        let best = match &optimum.value {
            Best::Exact(best) => {
                let (low, high) = best.refined_to_digits(20).enclosure();
                Enclosure::new(low, high)
            }
            Best::Between([_, proved]) => Enclosure::from_rational(proved.clone()),
            Best::Unbounded | Best::Zero | Best::Nothing => return None,
        };
        let best = Reading::of(&self.asked).enclosure(&best, 64)?.lower().clone();
        let lost = (&best - value).abs();
        if lost.is_zero() {
            return Some(lost);
        }
        // Next to zero a bracket knows of no share.
        let knows_share = |lost: &Rational| is_exact_value(&optimum.value) || *lost < Rational::ONE;
        lost.checked_div(&best.abs()).filter(knows_share)
    }
}

fn is_exact_value(value: &Best) -> bool {
    matches!(value, Best::Exact(_))
}

/// A requirement that a region is, as a relation.
pub(crate) fn regional(name: &str, text: &str) -> String {
    let sign = if name == "decay" { ">=" } else { "<=" };
    format!("{name} {sign} {text}")
}

/// What proves a bracket.
fn proof(cells: usize) -> String {
    match cells {
        0 => " (a bracket, its better end by the bounds of the gains alone)".to_owned(),
        cells => format!(" (a bracket, proof: {})", counted(cells)),
    }
}

/// `1 cell`, `214 cells`.
fn counted(cells: usize) -> String {
    if cells == 1 { "1 cell".to_owned() } else { format!("{cells} cells") }
}

fn percent(share: &Rational) -> String {
    to_decimal(&(share * &Rational::from(100)), FEW)
}

/// The same, not less than the share.
fn percent_above(share: &Rational) -> String {
    let text = percent(share);
    let shown = parse_number(&text).map(|x| x * Rational::new(1.into(), 100.into()));
    if shown.is_ok_and(|shown| shown >= *share) {
        return text;
    }
    percent(&(share * &Rational::new(201.into(), 200.into())))
}

/// A bracket, ascending, in so many digits that its ends differ, each rounded outwards.
fn bracket(reading: &Reading, found: &Rational, proved: &Rational) -> [String; 2] {
    let text = |x: &Rational, digits: usize| reading.shown(&Real::from(x.clone()), digits);
    let digits = (4..20).find(|digits| text(found, *digits) != text(proved, *digits)).unwrap_or(20) + 1;
    let is_sorted = match reading {
        Reading::Plain => found <= proved,
        _ => reading.is_greatest_best(),
    };
    let [low, high] = if is_sorted { [found, proved] } else { [proved, found] };
    let rounded = |x: &Rational, is_below: bool| {
        let outwards = one_sided(reading, x, digits as i64, is_below);
        outwards.map_or_else(|| text(x, digits), |x| to_decimal(&x, digits))
    };
    [rounded(low, true), rounded(high, false)]
}

/// What is shown of a number of the scale, in so many digits and not above it, or not below it; `None` where it is not finite.
fn one_sided(reading: &Reading, scale: &Rational, digits: i64, is_below: bool) -> Option<Rational> {
    let found = reading.enclosure(&Enclosure::from_rational(scale.clone()), BITS)?;
    Some(on_side(if is_below { found.lower() } else { found.upper() }, digits, is_below))
}

/// A number between two others, in the digits that are known; what it lies between where no digits are.
fn enclosed_number(low: &Rational, high: &Rational, digits: usize) -> String {
    let known = (3..=digits).rev().find(|n| to_decimal(low, *n) == to_decimal(high, *n));
    known.map_or_else(|| format!("between {}", ends(low, high, "and")), |n| format!("= {}", to_decimal(low, n)))
}

/// All numbers from one to another.
fn range(low: &Rational, high: &Rational) -> String {
    format!("from {}", ends(low, high, "to"))
}

fn ends(low: &Rational, high: &Rational, word: &str) -> String {
    let digits = (6..20).find(|n| to_decimal(low, *n) != to_decimal(high, *n)).unwrap_or(20);
    format!("{} {word} {}", to_decimal(low, digits), to_decimal(high, digits))
}

/// The polynomial of an algebraic number, if it is short.
fn root_of(value: &Real) -> Option<String> {
    let number: &RealAlgebraic = value.algebraic()?;
    let polynomial = number.polynomial();
    let is_short =
        polynomial.degree()? > 1 && polynomial.degree()? <= MOST_DEGREE && polynomial.height_bits() <= MOST_BITS;
    is_short.then(|| MultiPoly::from_univariate(polynomial, 0).display(&["x"]).to_string())
}

#[cfg(test)]
mod tests {
    use super::proof;

    /// `proof: 0 cells` was said of an end that is only that of the bounds.
    #[test]
    fn a_bracket_without_cells_says_that_the_bounds_are_its_end() {
        assert!(proof(0).contains("by the bounds of the gains alone"));
        assert_eq!([proof(1), proof(2)], [" (a bracket, proof: 1 cell)", " (a bracket, proof: 2 cells)"]);
    }
}
