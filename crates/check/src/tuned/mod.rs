//! Best gains: that no gains of a box meet what is required, or none that are better than a value, and that some gains do.

mod judge;
mod objective;
mod sentence;

use crate::clock::Clock;
use crate::for_all::{ForAllJudge, Loops, MAX_NAMES, MAX_REQUIREMENTS, Requirement, Wanted};
use crate::for_all::{axis, deeper, halves, line, ranges, short};
use crate::format::Json;
use crate::map_boxes::{Parts, read_with};
use crate::number::Q;
use crate::statement::{Extent, fixed_extent, list, number, object, text, values};
use crate::{Proved, Rejection, Step, is_discrete};
pub use judge::TuneJudge;
use num_traits::{One, Zero};
use objective::{Level, Objective};
use std::str::Chars;

/// So many gains at most.
const MAX_GAINS: usize = 5;

/// Lines are moved by no greater and no smaller power of two.
const MAX_EXPONENT: i64 = 100;

struct Statement {
    asked: Loops,
    objective: Objective,
    found: Option<Found>,
    tree: String,
}

/// Gains that are good.
struct Found {
    point: Vec<Q>,
    /// The level that they have, if a level is to be best.
    level: Option<Level>,
    proof: String,
}

impl Statement {
    fn read(json: &Json) -> Result<Self, String> {
        let keys = ["kind", "time", "gains", "set", "region", "require", "objective", "found", "tree"];
        let [_, time, gains, set, region, require, objective, found, tree] = object(json, "the statement", keys, &[])?;
        let discrete = is_discrete(time)?;
        let extent = fixed_extent(region, discrete)?;
        let (names, window): (Vec<String>, Vec<_>) = ranges(gains, "'gains'", false)?.into_iter().unzip();
        if names.is_empty() || names.len() > MAX_GAINS {
            return Err(format!("there are no gains, or more than {MAX_GAINS}"));
        }
        if names.iter().enumerate().any(|(i, name)| names[..i].contains(name)) {
            return Err("a gain has two ranges".into());
        }
        let require = list(require, "'require'")?
            .iter()
            .map(|own| Requirement::read(own, discrete))
            .collect::<Result<Vec<_>, _>>()?;
        if require.len() + 2 > MAX_REQUIREMENTS {
            return Err("there are too many requirements".into());
        }
        let objective = Objective::read(objective, names.len(), discrete)?;
        let found = match found {
            Json::Null => None,
            json => Some(Found::read(json, &window, discrete)?),
        };
        let each = wanted(discrete, extent, require, &objective, found.as_ref())?;
        let own_names = each.iter().filter_map(|own| own.requirement.as_ref()).map(Requirement::names).max();
        if names.len() + own_names.unwrap_or(0) > MAX_NAMES {
            return Err(format!("there are more than {MAX_NAMES} names"));
        }
        let axes = names.len();
        let asked = Loops { discrete, names, axes, window, set: values(set)?, each };
        Ok(Statement { asked, objective, found, tree: text(tree, "'tree'")?.to_owned() })
    }

    /// The numbers of the loops for which the found gains must be good: all loops without the level that no gains have.
    fn loops_of_found(&self) -> Vec<usize> {
        let all = self.asked.each.len();
        match (&self.objective, self.found.as_ref().and_then(|found| found.level.as_ref())) {
            (Objective::Level(Level::Region(_)), Some(_)) => (1..all).collect(),
            (Objective::Level(Level::Requirement(_)), Some(_)) => (0..all).filter(|k| k + 2 != all).collect(),
            _ => (0..all).collect(),
        }
    }

    /// The number of loops, from the first one on, by which a cell of gains may be refuted: all without the level that the found gains have.
    fn refutable(&self) -> usize {
        self.asked.each.len() - usize::from(self.found.as_ref().is_some_and(|found| found.level.is_some()))
    }

    /// The box that the tree cuts: where a gain is to be best, what of it is not worse than the value, if anything is.
    fn cells(&self) -> Vec<[Q; 2]> {
        let mut window = self.asked.window.clone();
        if let Objective::Formula { formula, is_greatest, proved } = &self.objective
            && let Some(gain) = formula.gain()
        {
            let [low, high] = &mut window[gain];
            if *is_greatest && *low < *proved && *proved <= *high {
                low.clone_from(proved);
            } else if !*is_greatest && *low <= *proved && *proved < *high {
                high.clone_from(proved);
            }
        }
        window
    }
}

/// What is wanted of the loops, in this order: stability, each requirement, the level that no gains have, and the level that the found gains have.
fn wanted(
    discrete: bool,
    extent: Extent,
    require: Vec<Requirement>,
    objective: &Objective,
    found: Option<&Found>,
) -> Result<Vec<Wanted>, String> {
    let usual = if discrete { Q::one() } else { Q::zero() };
    let plain = |extent: &Extent| Wanted { extent: extent.clone(), requirement: None };
    let with = |own: Requirement| Wanted { extent: Extent::Number(usual.clone()), requirement: Some(own) };
    let level = found.and_then(|found| found.level.as_ref());
    let none = match (objective, level) {
        (Objective::Level(none), level) => {
            if found.is_some() && !level.is_some_and(|level| none.is_better_than(level, discrete)) {
                return Err(
                    "the level that is found is missing, of another kind, or not worse than the level that no gains have"
                        .into(),
                );
            }
            Some(none)
        }
        (_, Some(_)) => return Err("a level is found, and none is asked for".into()),
        (Objective::None, None) if found.is_some() => return Err("gains are found, and nothing is to be best".into()),
        _ => None,
    };
    let mut each = vec![plain(&extent)];
    each.extend(require.into_iter().map(with));
    for (place, level) in [none, level].into_iter().enumerate() {
        match level {
            Some(Level::Requirement(own)) => each.push(with((**own).clone())),
            Some(Level::Region(bound)) => {
                let own = Extent::Number(bound.clone());
                if matches!(&extent, Extent::Number(base) if !objective::is_within(bound, base, discrete)) {
                    return Err("the region of a level is not inside of the one that is required".into());
                }
                if place == 0 {
                    each[0] = plain(&own);
                } else {
                    each.push(plain(&own));
                }
            }
            None => {}
        }
    }
    Ok(each)
}

impl Found {
    fn read(json: &Json, window: &[[Q; 2]], discrete: bool) -> Result<Self, String> {
        let [point, level, proof] = object(json, "'found'", ["point", "level", "proof"], &[])?;
        let point =
            list(point, "'point'")?.iter().map(|x| short(number(x, "'point'")?)).collect::<Result<Vec<_>, _>>()?;
        let is_inside = |(x, [low, high]): (&Q, &[Q; 2])| low <= x && x <= high;
        if point.len() != window.len() || !point.iter().zip(window).all(is_inside) {
            return Err("the gains that are found are not in the box".into());
        }
        let level = match level {
            Json::Null => None,
            json => Some(Level::read(json, discrete)?),
        };
        Ok(Found { point, level, proof: text(proof, "'proof'")?.to_owned() })
    }
}

/// What is said, and how it is to be shown.
fn read(json: &Json) -> Result<(Statement, Parts), Rejection> {
    read_with(json, crate::for_all::SHARE, Statement::read)
}

pub(super) fn check(model: &str, json: &Json, clock: Clock) -> Result<Proved, Rejection> {
    let (statement, parts) = read(json)?;
    let judge = TuneJudge::of(model, statement, &parts, clock)?;
    judge.walk()?;
    judge.walk_found()?;
    Ok(Proved { statement: judge.statement().in_words(), kind: "tune" })
}

impl TuneJudge {
    /// That no gains of a cell are good.
    fn walk(&self) -> Result<(), Rejection> {
        let (of, loops) = (self.statement(), self.loops());
        let mut letters = of.tree.chars();
        let mut stack = vec![(of.cells(), 0)];
        while let Some((cell, depth)) = stack.pop() {
            Step::Line.of(loops.clock().tick())?;
            match letters.next().ok_or_else(|| line("the tree ends too early"))? {
                'o' => {
                    if !Step::Stable.of(of.objective.is_worse(&cell, loops.clock()))? {
                        return Step::Stable.fails("a leaf 'o' is not shown");
                    }
                }
                '-' => loops.refutation(&cell, of.refutable(), &mut letters)?,
                's' => {
                    let exponent = exponent(&mut letters)?;
                    loops.far_refutation(&cell, exponent, of.refutable(), &mut letters)?;
                }
                other => {
                    let axis = axis(other).filter(|axis| *axis < cell.len());
                    let axis = axis.ok_or_else(|| line(format!("'{}' is no part of a tree", other.escape_debug())))?;
                    deeper(depth)?;
                    if cell[axis][0] == cell[axis][1] {
                        return Err(line("a side without a width is cut"));
                    }
                    let [low, high] = halves(&cell[axis]).map(|side| {
                        let mut half = cell.clone();
                        half[axis] = side;
                        (half, depth + 1)
                    });
                    stack.extend([high, low]);
                }
            }
        }
        if letters.next().is_some() { Err(line("something follows the tree")) } else { Ok(()) }
    }

    /// That the gains that are found are good.
    fn walk_found(&self) -> Result<(), Rejection> {
        let Some(found) = &self.statement().found else { return Ok(()) };
        if let Objective::Formula { formula, .. } = &self.statement().objective
            && formula.at(&found.point).is_none()
        {
            return Step::Stable.fails("what is to be best is undefined where gains are found");
        }
        let point: Vec<[Q; 2]> = found.point.iter().map(|x| [x.clone(), x.clone()]).collect();
        let mut letters = found.proof.chars();
        self.statement()
            .loops_of_found()
            .into_iter()
            .try_for_each(|k| self.loops().proofs_of(k, &point, &mut letters))?;
        if letters.next().is_some() { Err(line("something follows the proof")) } else { Ok(()) }
    }
}

/// A number up to a semicolon.
fn exponent(letters: &mut Chars<'_>) -> Result<i64, Rejection> {
    let mut digits = String::new();
    loop {
        match letters.next() {
            Some(';') => break,
            Some(digit @ ('-' | '0'..='9')) if digits.len() < 4 => digits.push(digit),
            _ => return Err(line("a leaf 's' has no exponent")),
        }
    }
    let exponent = digits.parse().ok().filter(|e: &i64| e.abs() <= MAX_EXPONENT);
    exponent.ok_or_else(|| line("a leaf 's' has no exponent"))
}

impl ForAllJudge {
    /// The axis along which a cell is to be halved, if nothing is shown of it: the widest in shares of the window.
    pub(crate) fn widest(&self, cell: &[[Q; 2]]) -> Option<usize> {
        let share = |i: usize| {
            let [low, high] = &self.asked().window[i];
            (&cell[i][1] - &cell[i][0]) / (high - low)
        };
        (0..cell.len()).filter(|&i| cell[i][0] < cell[i][1]).rev().max_by_key(|&i| share(i))
    }
}
