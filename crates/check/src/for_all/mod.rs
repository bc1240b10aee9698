//! What holds for all values of names: that a loop is stable, and meets requirements on margins, in boxes of none, one or two further names.

mod judge;
mod requirement;
mod sentence;
mod walk;

use crate::clock::Clock;
use crate::format::Json;
use crate::map_boxes::{Parts, Question, ends, is_long, read_with};
use crate::number::Q;
use crate::statement::{Extent, fixed_extent, identifier, list, number, object, text, values};
use crate::{Proved, Rejection, is_discrete};
pub use judge::{ForAllJudge, Part};
use num_traits::{One, Zero};
pub(crate) use requirement::Requirement;
pub(crate) use sentence::wishes;
pub(crate) use walk::{axis, deeper, halves, line};

/// So many names at most: axes, those for all, and the own ones of a requirement.
pub(crate) const MAX_NAMES: usize = 8;

/// More requirements are refused.
pub(crate) const MAX_REQUIREMENTS: usize = 9;

/// See [`Parts::share`]: as in [`shown`](crate::map_boxes), so that a box is halved alike whether it was looked at or not.
pub(crate) const SHARE: usize = 10;

/// Loops over a window of names.
#[derive(Clone)]
pub(crate) struct Loops {
    pub discrete: bool,
    /// The axes, then the names for all whose values it holds.
    pub names: Vec<String>,
    pub axes: usize,
    pub window: Vec<[Q; 2]>,
    pub set: Vec<(String, Q)>,
    pub each: Vec<Wanted>,
}

/// What is wanted of one of them.
#[derive(Clone)]
pub(crate) struct Wanted {
    pub extent: Extent,
    pub requirement: Option<Requirement>,
}

/// What a certificate says of these loops.
struct Told {
    tree: String,
    beyond: Option<Beyond>,
}

/// A point that is not good.
struct Beyond {
    point: Vec<Q>,
    not: String,
}

impl Loops {
    fn read(json: &Json) -> Result<(Self, Told), String> {
        let keys = ["kind", "time", "axes", "for_all", "set", "region", "require", "tree", "beyond"];
        let [_, time, axes, for_all, set, region, require, tree, beyond] = object(json, "the statement", keys, &[])?;
        let discrete = is_discrete(time)?;
        let extent = fixed_extent(region, discrete)?;
        let (axes, for_all) = (ranges(axes, "'axes'", false)?, ranges(for_all, "'for_all'", true)?);
        let require = list(require, "'require'")?
            .iter()
            .map(|own| Requirement::read(own, discrete))
            .collect::<Result<Vec<_>, _>>()?;
        if axes.len() > 2 || require.len() > MAX_REQUIREMENTS {
            return Err("there are more than two axes, or more than nine requirements".into());
        }
        let count = axes.len() + for_all.len();
        if count + require.iter().map(Requirement::names).max().unwrap_or(0) > MAX_NAMES {
            return Err(format!("there are more than {MAX_NAMES} names"));
        }
        let usual = if discrete { Q::one() } else { Q::zero() };
        if !require.is_empty() && extent != Extent::Number(usual) {
            return Err("a requirement goes with the unit disc, or the left half plane, alone".into());
        }
        let beyond = match beyond {
            Json::Null => None,
            json => Some(Beyond::read(json, for_all.len())?),
        };
        if beyond.is_some() && !axes.is_empty() {
            return Err("a point beyond goes with no axes".into());
        }
        let axes_count = axes.len();
        let (names, window) = axes.into_iter().chain(for_all).unzip();
        let (set, tree) = (values(set)?, text(tree, "'tree'")?.to_owned());
        let wanted = |requirement| Wanted { extent: extent.clone(), requirement };
        let each = match require.is_empty() {
            true => vec![wanted(None)],
            false => require.into_iter().map(|own| wanted(Some(own))).collect(),
        };
        Ok((Loops { discrete, names, axes: axes_count, window, set, each }, Told { tree, beyond }))
    }

    /// What is asked of the loop with this number, where the names have these ranges.
    fn question(&self, number: usize, mut window: Vec<[Q; 2]>) -> Question {
        let Wanted { extent, requirement } = &self.each[number];
        window.extend(requirement.iter().flat_map(|own| own.ranges(true, false)));
        Question {
            discrete: self.discrete,
            names: self.names.clone(),
            set: self.set.clone(),
            extent: extent.clone(),
            factor: requirement.as_ref().map(|own| own.factor.clone()),
            window,
        }
    }

    fn requirement(&self, number: usize) -> Option<&Requirement> {
        self.each[number].requirement.as_ref()
    }
}

impl Beyond {
    fn read(json: &Json, names: usize) -> Result<Self, String> {
        let [point, not] = object(json, "'beyond'", ["point", "not"], &[])?;
        let point =
            list(point, "'point'")?.iter().map(|x| short(number(x, "'point'")?)).collect::<Result<Vec<_>, _>>()?;
        if point.len() != names {
            return Err("'point' has not one value for each name for all".into());
        }
        Ok(Beyond { point, not: text(not, "'not'")?.to_owned() })
    }
}

/// Names with their ranges.
pub(crate) fn ranges(json: &Json, what: &str, may_be_one: bool) -> Result<Vec<(String, [Q; 2])>, String> {
    let mut out: Vec<(String, [Q; 2])> = Vec::new();
    for range in list(json, what)? {
        let [name, between] = object(range, "a range", ["name", "between"], &[])?;
        let [low, high] = ends(between, may_be_one)?;
        out.push((identifier(text(name, "'name'")?)?.to_owned(), [short(low)?, short(high)?]));
    }
    Ok(out)
}

/// A number of a statement.
pub(crate) fn short(q: Q) -> Result<Q, String> {
    if is_long(&q) { Err("a number has too many digits".into()) } else { Ok(q) }
}

/// What is said, and how it is to be shown.
fn read(json: &Json) -> Result<((Loops, Told), Parts), Rejection> {
    read_with(json, SHARE, Loops::read)
}

pub(super) fn check(model: &str, json: &Json, clock: Clock) -> Result<Proved, Rejection> {
    let ((asked, told), parts) = read(json)?;
    let judge = ForAllJudge::of(model, asked, &parts, clock)?;
    let walked = judge.walk(&told)?;
    if let Some(beyond) = &told.beyond {
        judge.walk_beyond(beyond, model, &parts)?;
    }
    Ok(Proved { statement: judge.asked().in_words(&told, &walked), kind: "for_all" })
}
