//! Maps by boxes: a window of two parameters cut into boxes, of which each is stable everywhere, or nowhere, or unknown.

mod axis;
mod delayed;
mod functions;
mod judge;
mod polynomial;

use crate::clock::Clock;
use crate::format::Json;
use crate::number::Q;
use crate::statement::{Extent, axes, count, fixed_extent, list, number, object, text, values};
use crate::{Proved, Rejection, Step, is_discrete, verdict};
pub use judge::{BoxJudge, JudgedBox};
use num_traits::{One, Zero};
use std::fmt::Write;

/// Trees with longer branches are refused.
const MAX_DEPTH: usize = 160;

/// The ends of a box in `x` and in `y`.
pub(super) type Sides = [[Q; 2]; 2];

pub(super) struct Statement {
    pub discrete: bool,
    pub names: Vec<String>,
    pub set: Vec<(String, Q)>,
    pub extent: Extent,
    pub window: Sides,
    tree: String,
}

/// How the functions over a box are written.
pub(super) struct Parts {
    pub order: usize,
    pub bits: usize,
}

impl Statement {
    fn read(json: &Json) -> Result<Self, String> {
        let keys = ["kind", "time", "x", "y", "set", "region", "window", "tree"];
        let [_, time, x, y, set, region, window, tree] = object(json, "the statement", keys, &[])?;
        let discrete = is_discrete(time)?;
        let extent = fixed_extent(region, discrete)?;
        let names = axes(x, y)?;
        let [x, y] = object(window, "'window'", ["x", "y"], &[])?;
        let tree = text(tree, "'tree'")?.to_owned();
        Ok(Statement { discrete, names, set: values(set)?, extent, window: [ends(x)?, ends(y)?], tree })
    }

    fn in_words(&self, shares: &[Q; 3]) -> String {
        let mut out = String::from("For ");
        for (i, (name, [low, high])) in self.names.iter().zip(&self.window).enumerate() {
            let _ = write!(out, "{}{name} from {low} to {high}", if i == 0 { "" } else { " and " });
        }
        for (i, (name, value)) in self.set.iter().enumerate() {
            let _ = write!(out, "{}{name} = {value}", if i == 0 { ", with " } else { ", " });
        }
        let within = verdict::within(&self.extent, self.discrete);
        let percent = |q: &Q| {
            // Rounded down: no more is claimed than is proved.
            let tenths = (q * Q::from(num_bigint::BigInt::from(1000))).floor().to_integer();
            format!("{}.{}", &tenths / 10, tenths % 10)
        };
        let [stable, unstable, _] = shares.each_ref().map(percent);
        let _ = write!(
            out,
            ", the loop is stable{within} in all boxes '+' of the tree, and nowhere in its boxes '-': at least {stable} % and {unstable} % of the \
             window. Nothing is said of the rest."
        );
        out
    }
}

/// Two numbers in order.
fn ends(json: &Json) -> Result<[Q; 2], String> {
    match list(json, "a side of the window")? {
        [low, high] => {
            let side = [number(low, "a side of the window")?, number(high, "a side of the window")?];
            if side[0] < side[1] { Ok(side) } else { Err("the window is empty".into()) }
        }
        _ => Err("a side of the window has two ends".into()),
    }
}

/// What is said, and how it is to be shown.
fn read(json: &Json) -> Result<(Statement, Parts), Rejection> {
    let keys = ["schema", "statement", "order", "bits"];
    let [_, statement, order, bits] = Step::Format.of(object(json, "the certificate", keys, &["model"]))?;
    let parts = Step::Format.of((|| match (count(order, "'order'")?, count(bits, "'bits'")?) {
        (order @ 1..=16, bits @ 64..=4096) => Ok(Parts { order, bits }),
        _ => Err("'order' is not from 1 to 16, or 'bits' not from 64 to 4096".to_owned()),
    })())?;
    Ok((Step::Statement.of(Statement::read(statement))?, parts))
}

pub(super) fn check(model: &str, json: &Json, clock: Clock) -> Result<Proved, Rejection> {
    let (statement, parts) = read(json)?;
    let judge = BoxJudge::of(model, statement, &parts, clock)?;
    let shares = judge.walk()?;
    Ok(Proved { statement: judge.statement().in_words(&shares), kind: "boxes" })
}

/// The axis along which a box is wider, in shares of the window.
fn share_of_window(sides: &Sides, window: &Sides) -> usize {
    let share = |k: usize| (&sides[k][1] - &sides[k][0]) / (&window[k][1] - &window[k][0]);
    usize::from(share(1) > share(0))
}

impl BoxJudge {
    /// That each leaf of the tree is what it says; the shares of the window that are stable, not stable, and unknown.
    fn walk(&self) -> Result<[Q; 3], Rejection> {
        let mut stack = vec![(self.whole(), 0)];
        let mut shares = [Q::zero(), Q::zero(), Q::zero()];
        let stable = |reason: String| Rejection { step: Step::Stable, reason };
        for letter in self.statement().tree.chars() {
            Step::Line.of(self.clock().tick())?;
            let Some((mut cell, depth)) = stack.pop() else {
                return Err(Rejection { step: Step::Line, reason: "something follows the tree".into() });
            };
            let share = || Q::new_raw(One::one(), num_bigint::BigInt::one() << depth);
            match letter {
                'x' | 'y' => {
                    if depth >= MAX_DEPTH {
                        return Err(Rejection { step: Step::Line, reason: "the tree is too deep".into() });
                    }
                    let [low, high] = Step::Line.of(self.halved(&mut cell, usize::from(letter == 'y')))?;
                    stack.extend([(high, depth + 1), (low, depth + 1)]);
                }
                '+' | '-' => {
                    if !self.shown(&mut cell, letter == '+').map_err(stable)? {
                        return Err(stable(format!("a leaf '{letter}' is not shown: {cell}")));
                    }
                    shares[usize::from(letter == '-')] += share();
                }
                '?' => shares[2] += share(),
                other => {
                    let reason = format!("'{}' is no part of a tree", other.escape_debug());
                    return Err(Rejection { step: Step::Line, reason });
                }
            }
        }
        if stack.is_empty() {
            return Ok(shares);
        }
        Err(Rejection { step: Step::Line, reason: "the tree ends too early".into() })
    }
}
