//! What moves the limits: every one computed again, exactly, with one number a tenth smaller or larger.

use super::limit::CHANGE_DIGITS;
use super::limits::Limits;
use super::part::{Missing, Part, Parts, Work};
use super::{around_nominal, limit_text, percent_change};
use crate::page::{Table, math, paragraph};
use jurist_algebra::limits::{Budget, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
use jurist_engine::answer::Answer;
use jurist_engine::error::Error;
use jurist_engine::problem::Question;
use jurist_engine::stability::{End, Range, StableSet};
use jurist_show::layout::short;

/// Digits of the limits in the tables, and those to which a limit counts as not moved.
const DIGITS: (usize, usize) = (7, 12);

/// Work of all questions together, which they share evenly, and the least and most of one: about seven tenths of a second of one core,
/// a hundredth and three tenths.
const WORK: (u64, u64, u64) = (70_000_000, 1_000_000, 30_000_000);

/// Ends of the interval around the nominal value; `None` where that is not stable.
type Ends = Option<[Option<Real>; 2]>;

/// A number that is changed.
struct Changed {
    name: String,
    nominal: Rational,
}

/// The numbers of the model that a limit of `of` can depend on.
fn changed(question: &Question, of: &str) -> Vec<Changed> {
    let model = question.model();
    let set = |name: &str| question.values_set().get(name).cloned();
    let constants = model.constants().iter().filter_map(|c| Some((&c.name, c.number.clone()?)));
    let parameters = model.parameters().iter().filter_map(|p| Some((&p.name, set(&p.name)?)));
    constants
        .chain(parameters)
        .map(|(name, number)| Changed { nominal: set(name).unwrap_or(number), name: name.clone() })
        .filter(|c| c.name != of && !c.nominal.is_zero())
        .collect()
}

/// Whether an end is more than the end of what was asked.
fn binds(end: Option<&End>) -> bool {
    end.is_some_and(|e| e.causes.is_limit())
}

/// Refined once for all that is printed of it.
fn value(end: &Option<End>) -> Option<Real> {
    end.as_ref().map(|e| e.value.refined_to_digits(CHANGE_DIGITS))
}

fn ends(answer: &Answer<StableSet>) -> Ends {
    around_nominal(answer).map(|i| [&i.lower, &i.upper].map(value))
}

pub(super) fn section(question: &Question, limits: &[Limits], parts: &Parts<'_>) -> String {
    let mut html = paragraph(
        "Each limit once more with one number of the model 10 % smaller and 10 % larger, all others as they are. Nothing is \
         estimated: every value is computed again from the model and correctly rounded.",
    );
    // One number alone is changed: nominal values that are formulas do not follow it.
    let pinned = question.clone().with_nominal_values();
    let question = pinned.as_ref().unwrap_or(question);
    let questions: usize = limits.iter().map(|l| 2 * changed(question, &l.name).len()).sum();
    let (total, least, most) = WORK;
    let work = (total / questions.max(1) as u64).clamp(least, most);
    let before = html.len();
    for one in limits {
        html.push_str(&of_parameter(question, one, work, parts));
    }
    if html.len() == before {
        html.push_str(&paragraph("There is no limit around the nominal point that could move."));
    }
    html
}

fn of_parameter(question: &Question, limits: &Limits, work: u64, parts: &Parts<'_>) -> String {
    let heading = format!("<h3>Limits of {}</h3>\n", math(&limits.name));
    let answer = match &limits.set {
        Err(missing) => return heading + &missing.html(),
        Ok(answer) => answer,
    };
    let Some(around) = around_nominal(answer) else {
        return heading + &paragraph("The nominal value is not inside of a stable interval: nothing is compared.");
    };
    let shown = [binds(around.lower.as_ref()), binds(around.upper.as_ref())];
    if shown == [false, false] {
        return String::new();
    }
    let base = ends(answer).unwrap_or_default();
    let list = changed(question, &limits.name);
    if list.is_empty() {
        return heading + &paragraph("The model has no other number that could move them.");
    }
    let near = Near::of(answer, &base, shown);
    parts.budget().step(&format!("what moves the limits of {}", limits.name));
    let share = parts.budget().share(1, 2).silent();
    let jobs: Vec<(usize, i64)> = (0..list.len()).flat_map(|k| [(k, 90), (k, 110)]).collect();
    let found: Vec<Part<Ends>> = parallel_map(jobs, |(k, percent): (usize, i64)| {
        let value = &list[k].nominal * &Rational::new(percent.into(), 100.into());
        let asked = question.clone().without_value(&limits.name).set(&list[k].name, value).free(&limits.name);
        parts.within(&share, Work::Units(work), |budget| match &near {
            Some(near) => near.ends(&asked, budget),
            None => Ok(ends(&asked.stable_set(budget)?)),
        })
    });
    let (table, still) = table(&limits.name, &base, shown, &list, &found);
    let mut html = heading + &table.html();
    if !still.is_empty() {
        let names = math(&still.join(", "));
        html.push_str(&paragraph(&format!("To {} digits these do not move them: {names}.", DIGITS.1)));
    }
    let missing = found.iter().find_map(|f| f.as_ref().err());
    html + &missing.map(Missing::html).unwrap_or_default()
}

/// How far windows reach beyond the limits, one after the other: so many quarters of what is smaller, the limit or its distance to the
/// nominal value.
const QUARTERS: [i64; 3] = [1, 2, 4];

/// Where a limit that has moved is looked for first: mostly it moves little, and what happens far away is another question, which may be a
/// long one.
struct Near {
    name: String,
    /// By side, the ends of windows from the nominal value outwards, the last one that of the domain; a single one where no limit is asked for.
    ends: [Vec<Option<Rational>>; 2],
}

impl Near {
    fn of(answer: &Answer<StableSet>, base: &[Option<Real>; 2], shown: [bool; 2]) -> Option<Near> {
        let free = answer.problem().parameter();
        let nominal = free.nominal.as_ref()?;
        // The limit, and how far it is at least.
        let limit = |side: usize| {
            let (lo, hi) = base[side].as_ref().filter(|_| shown[side])?.refined_to_digits(3).enclosure();
            Some(if side == 0 { (lo.clone(), nominal - lo) } else { (hi.clone(), hi - nominal) })
        };
        let known = [limit(0), limit(1)];
        let least = known.iter().flatten().map(|(_, distance)| distance.clone()).min()?;
        let ends = |side: usize| -> Vec<Option<Rational>> {
            let domain = if side == 0 { &free.domain.lower } else { &free.domain.upper };
            let within = |x: Rational| match domain {
                Some(end) if side == 0 => x.max(end.clone()),
                Some(end) => x.min(end.clone()),
                None => x,
            };
            let at = |distance: Rational| Some(within(if side == 0 { nominal - distance } else { nominal + distance }));
            let Some((limit, distance)) = &known[side] else {
                return vec![at(&least * &Rational::dyadic(&Integer::ONE, 4))];
            };
            let scale = if limit.is_zero() { distance.clone() } else { limit.abs().min(distance.clone()) };
            let quarter = scale * Rational::dyadic(&Integer::ONE, 2);
            let windows = QUARTERS.iter().map(|n| at(distance + &(&quarter * &Rational::from(*n))));
            windows.chain([domain.clone()]).collect()
        };
        Some(Near { name: free.name.clone(), ends: [ends(0), ends(1)] })
    }

    /// The ends of the interval around the nominal value, asked for in one window, and from there outwards where that goes on.
    fn ends(&self, asked: &Question, budget: &Budget) -> Result<Ends, Error> {
        let within = |lower: &Option<Rational>, upper: &Option<Rational>| {
            let window = Range::between(lower.clone(), upper.clone());
            asked.clone().domain(&self.name, window).stable_set(budget)
        };
        let (lower, upper) = (&self.ends[0][0], &self.ends[1][0]);
        let answer = within(lower, upper)?;
        let Some(around) = around_nominal(&answer) else { return Ok(None) };
        let mut found = [&around.lower, &around.upper].map(Clone::clone);
        for side in [0, 1] {
            let mut reached = self.ends[side][0].clone();
            for next in &self.ends[side][1..] {
                let (Some(from), false) = (&reached, binds(found[side].as_ref()) || reached == *next) else { break };
                // Windows overlap, so that nothing is between them.
                let inner = if side == 0 { upper } else { lower };
                let (Some(inner), Some(most)) = (inner, &self.ends[side][0]) else { break };
                let overlap = from + &((inner - most) * Rational::dyadic(&Integer::ONE, 6));
                let answer = if side == 0 { within(next, &Some(overlap))? } else { within(&Some(overlap), next)? };
                let Some(goes_on) = answer.value().intervals().iter().find(|i| i.contains(from)) else {
                    return Ok(ends(&asked.clone().stable_set(budget)?));
                };
                found[side] = if side == 0 { goes_on.lower.clone() } else { goes_on.upper.clone() };
                reached = next.clone();
            }
        }
        Ok(Some(found.each_ref().map(value)))
    }
}

/// The rows of the numbers that move a limit, and the names of those that do not.
fn table(
    name: &str,
    base: &[Option<Real>; 2],
    shown: [bool; 2],
    list: &[Changed],
    found: &[Part<Ends>],
) -> (Table, Vec<String>) {
    let mut head = vec!["changed".to_owned(), "to".to_owned()];
    for (word, _) in ["lower", "upper"].into_iter().zip(shown).filter(|(_, shown)| *shown) {
        head.extend([format!("{word} limit"), "change / %".to_owned()]);
    }
    let caption = format!("Limits of {name} with one number changed by a tenth");
    let mut table = Table { caption, head, rows: Vec::new() };
    let cells = |now: &Ends| -> Vec<String> {
        let sides = (0..2).filter(|side| shown[*side]);
        match now {
            None => sides.flat_map(|_| ["not stable at nominal".to_owned(), String::new()]).collect(),
            Some(now) => sides
                .flat_map(|side| {
                    let (x, x0) = (now[side].as_ref(), base[side].as_ref());
                    let change = x.zip(x0).and_then(|(x, x0)| percent_change(x, x0));
                    [limit_text(x, DIGITS.0), change.unwrap_or_default()]
                })
                .collect(),
        }
    };
    let mut first = vec!["nothing".to_owned(), "nominal".to_owned()];
    first.extend(cells(&Some(base.clone())));
    table.rows.push(first);
    let long = |ends: &[Option<Real>; 2]| -> Vec<String> {
        (0..2).filter(|s| shown[*s]).map(|s| limit_text(ends[s].as_ref(), DIGITS.1)).collect()
    };
    let nominal = long(base);
    let mut still = Vec::new();
    for (k, changed) in list.iter().enumerate() {
        let pair = &found[2 * k..2 * k + 2];
        let same = |f: &Part<Ends>| matches!(f, Ok(Some(ends)) if long(ends) == nominal);
        if pair.iter().all(same) {
            still.push(changed.name.clone());
            continue;
        }
        for (one, (percent, sign)) in pair.iter().zip([(90, "-10 %"), (110, "+10 %")]) {
            let value = &changed.nominal * &Rational::new(percent.into(), 100.into());
            let mut row = vec![changed.name.clone(), format!("{} ({sign})", short(&value))];
            match one {
                Ok(ends) => row.extend(cells(ends)),
                Err(_) => row.extend(shown.iter().filter(|s| **s).flat_map(|_| ["left out".to_owned(), String::new()])),
            }
            table.rows.push(row);
        }
    }
    (table, still)
}
