//! Which requirements and bounds exclude each other.

use crate::answer::Outcome;
use crate::asked::{Asked, Gain, Objective};
use crate::lines::Lines;
use crate::{many_gains, one_gain, two_gains};
use jurist_engine::error::Error;
use jurist_engine::problem::Bound;
use jurist_show::layout::short;

/// What may be left out.
#[derive(Clone, Copy)]
enum Part {
    Requirement(usize),
    Region,
    Bound(usize, usize),
}

/// A set of requirements and bounds that exclude each other: without any one of them there are gains, or it is not known.
///
/// Where boxes prove it, so many of them, all bounds are kept and not named.
///
/// Cost: one question for each requirement and each bound.
pub(crate) fn conflict(lines: &Lines<'_>, cells: Option<usize>) -> Result<Vec<String>, Error> {
    let asked = lines.asked;
    let mut parts: Vec<Part> = (0..asked.requirements.list.len()).map(Part::Requirement).collect();
    parts.extend(asked.requirements.region.is_some().then_some(Part::Region));
    for (gain, Gain { bounds, .. }) in asked.gains.iter().enumerate().filter(|_| cells.is_none()) {
        parts.extend((0..2).filter(|side| bounds[*side].is_some()).map(|side| Part::Bound(gain, side)));
    }
    let mut kept = parts.clone();
    for k in (0..parts.len()).rev() {
        lines.budget.step("which requirements exclude each other");
        let without: Vec<Part> = kept.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, part)| *part).collect();
        let is_infeasible = match lines.part(|| is_infeasible(lines, &without, cells)) {
            // It is not known.
            Err(Error::Stopped(_)) => false,
            found => found?,
        };
        if is_infeasible {
            kept = without;
        }
    }
    let name = |part: &Part| match part {
        Part::Requirement(k) => asked.requirements.list[*k].text(),
        Part::Region => {
            let regional = asked.requirements.regional.first();
            let own = || match asked.requirements.region.as_ref().map(|region| (region.bound_name(), region.bound())) {
                Some((name, Bound::Number(bound))) => crate::text::regional(name, &short(bound)),
                _ => "the region".to_owned(),
            };
            regional.map_or_else(own, |(name, text)| crate::text::regional(name, text))
        }
        Part::Bound(gain, side) => {
            let Gain { name, bounds } = &asked.gains[*gain];
            let bound = bounds[*side].as_ref().expect("a bound that is there");
            format!("{name} {} {}", if *side == 0 { ">=" } else { "<=" }, short(bound))
        }
    };
    Ok(kept.iter().map(name).collect())
}

/// Without a part of the question boxes are tried so many times as many as with all of them, and so many more.
const SO_MUCH_LONGER: usize = 4;
const LEAST_PARTS: usize = 100;

/// Whether there are no gains with these parts of the question.
fn is_infeasible(lines: &Lines<'_>, parts: &[Part], cells: Option<usize>) -> Result<bool, Error> {
    let mut asked = Asked { objective: Objective::Anything, ..lines.asked.clone() };
    let whole = std::mem::take(&mut asked.requirements.list);
    let region = asked.requirements.region.take();
    let bounds: Vec<_> = match cells {
        None => asked.gains.iter_mut().map(|gain| std::mem::take(&mut gain.bounds)).collect(),
        Some(_) => Vec::new(),
    };
    for part in parts {
        match part {
            Part::Requirement(k) => asked.requirements.list.push(whole[*k].clone()),
            Part::Region => asked.requirements.region.clone_from(&region),
            Part::Bound(gain, side) => asked.gains[*gain].bounds[*side].clone_from(&bounds[*gain][*side]),
        }
    }
    let lines = lines.with(&asked)?;
    if let Some(cells) = cells {
        return many_gains::is_infeasible(&lines, SO_MUCH_LONGER * cells + LEAST_PARTS);
    }
    let found = if asked.gains.len() == 1 { one_gain::best(&lines)? } else { two_gains::best(&lines)? };
    Ok(matches!(found, Outcome::Infeasible { .. }))
}
