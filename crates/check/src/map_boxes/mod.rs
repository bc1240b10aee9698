//! Maps by boxes: a window of two parameters cut into boxes, of which each is stable everywhere, or nowhere, or unknown.

mod axis;
mod delayed;
mod functions;
mod judge;
mod one_loop;
mod polynomial;

use crate::clock::Clock;
use crate::factor::Factor;
use crate::format::Json;
use crate::multivariate::Multi;
use crate::number::Q;
use crate::over_box::FIRST;
use crate::statement::{Extent, axes, count, fixed_extent, list, number, object, text, values};
use crate::words::{inward, with_values};
use crate::{Proved, Rejection, Step, is_discrete, verdict};
pub(crate) use delayed::is_long;
pub use judge::BoxJudge;
pub(super) use judge::on_a_large_stack;
use num_traits::{One, Zero};
pub use one_loop::JudgedBox;
pub(super) use one_loop::OneLoop;
use std::fmt::Write;

/// Trees with longer branches are refused.
pub(super) const MAX_DEPTH: usize = 160;

/// See [`Parts::share`].
const SHARE: usize = 4;

/// The ends of a box, for each of its parameters.
pub(super) type Sides = [[Q; 2]];

/// What is asked of a loop: of which parameters, between which ends, and with which region.
pub(super) struct Question {
    pub discrete: bool,
    pub names: Vec<String>,
    pub set: Vec<(String, Q)>,
    pub extent: Extent,
    /// A factor at a cut of the loop, whose own names follow.
    pub factor: Option<Factor>,
    /// Of all names.
    pub window: Vec<[Q; 2]>,
}

pub(super) struct Statement {
    /// Of two parameters.
    pub question: Question,
    tree: String,
}

/// How the functions over a box are written.
pub(super) struct Parts {
    pub order: usize,
    pub bits: usize,
    /// A half has the functions of the whole where what they leave out is less than this power of two of what they change.
    pub share: usize,
}

impl Parts {
    /// Of a certificate.
    pub fn read(order: &Json, bits: &Json, share: usize) -> Result<Self, String> {
        match (count(order, "'order'")?, count(bits, "'bits'")?) {
            (order @ 1..=8, bits @ 64..=1024) => Ok(Parts { order, bits, share }),
            _ => Err("'order' is not from 1 to 8, or 'bits' not from 64 to 1024".to_owned()),
        }
    }
}

impl Question {
    /// Whether an own name of the factor is in one of these polynomials.
    pub fn has_own_name(&self, all: &[Vec<Multi>]) -> bool {
        let own = FIRST + self.names.len()..FIRST + self.window.len();
        all.iter().flatten().any(|p| own.clone().any(|name| p.degree(name) > 0))
    }
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
        let window = vec![ends(x, false)?, ends(y, true)?];
        Ok(Statement { question: Question { discrete, names, set: values(set)?, extent, factor: None, window }, tree })
    }

    /// Whether the second parameter has one value.
    fn is_line(&self) -> bool {
        self.question.window[1][0] == self.question.window[1][1]
    }

    fn in_words(&self, walked: &Walked) -> String {
        let mut out = String::from("For ");
        let Question { discrete, names, set, extent, window, .. } = &self.question;
        let sides = names.iter().zip(window);
        for (i, (name, [low, high])) in sides.take(if self.is_line() { 1 } else { 2 }).enumerate() {
            let [low, high] = inward(low, high);
            let _ = write!(out, "{}{name} from {low} to {high}", if i == 0 { "" } else { " and " });
        }
        let one = self.is_line().then(|| (names[1].clone(), window[1][0].clone()));
        let set: Vec<(String, Q)> = one.into_iter().chain(set.iter().cloned()).collect();
        out.push_str(&with_values(&set));
        let within = verdict::within(extent, *discrete);
        if self.is_line() {
            let name = &names[0];
            let (stable, unstable) = (walked.ranges('+', name), walked.ranges('-', name));
            let _ = match (stable.is_empty(), unstable.is_empty()) {
                (true, true) => write!(out, ", nothing is said of the loop."),
                (true, false) => write!(out, ", the loop is not stable{within} for any value in {unstable}."),
                (false, true) => write!(out, ", the loop is stable{within} for {stable}."),
                (false, false) => {
                    write!(
                        out,
                        ", the loop is stable{within} for {stable}, and not stable for any value in {unstable}."
                    )
                }
            };
            out.push_str(" Nothing is said of the rest.");
            return out;
        }
        let [stable, unstable, _] = walked.shares.each_ref().map(percent);
        let _ = write!(
            out,
            ", the loop is stable{within} in all boxes '+' of the tree, and nowhere in its boxes '-': at least {stable} % and {unstable} % of the \
             window. Nothing is said of the rest."
        );
        out
    }
}

/// A share of a whole in per cent, rounded down: no more is claimed than is proved.
pub(super) fn percent(q: &Q) -> String {
    let tenths = (q * Q::from(num_bigint::BigInt::from(1000))).floor().to_integer();
    format!("{}.{}", &tenths / 10, tenths % 10)
}

/// Two numbers in order, which may be the same where one parameter alone is asked about.
pub(super) fn ends(json: &Json, may_be_one: bool) -> Result<[Q; 2], String> {
    match list(json, "a side of the window")? {
        [low, high] => {
            let side = [number(low, "a side of the window")?, number(high, "a side of the window")?];
            if side[0] < side[1] || may_be_one && side[0] == side[1] {
                Ok(side)
            } else {
                Err("the window is empty".into())
            }
        }
        _ => Err("a side of the window has two ends".into()),
    }
}

/// What is said, and how it is to be shown.
fn read(json: &Json) -> Result<(Statement, Parts), Rejection> {
    read_with(json, SHARE, Statement::read)
}

/// The same of a certificate whose statement is read so.
pub(super) fn read_with<S>(
    json: &Json,
    share: usize,
    read: impl FnOnce(&Json) -> Result<S, String>,
) -> Result<(S, Parts), Rejection> {
    let keys = ["schema", "statement", "order", "bits"];
    let [_, statement, order, bits] = Step::Format.of(object(json, "the certificate", keys, &["model"]))?;
    let parts = Step::Format.of(Parts::read(order, bits, share))?;
    Ok((Step::Statement.of(read(statement))?, parts))
}

pub(super) fn check(model: &str, json: &Json, clock: Clock) -> Result<Proved, Rejection> {
    let (statement, parts) = read(json)?;
    let judge = BoxJudge::of(model, statement, &parts, clock)?;
    let walked = judge.walk()?;
    Ok(Proved { statement: judge.statement().in_words(&walked), kind: "boxes" })
}

/// The axis along which a box is widest, in shares of the window.
fn share_of_window(sides: &Sides, window: &Sides) -> usize {
    let width = |[low, high]: &[Q; 2]| high - low;
    let share = |(side, whole)| {
        let whole = width(whole);
        if whole.is_zero() { whole } else { width(side) / whole }
    };
    largest(sides.iter().zip(window).map(share)).unwrap_or(0)
}

/// The place of the first of the largest, where not all are the same.
fn largest<T: Ord>(all: impl Iterator<Item = T>) -> Option<usize> {
    let all: Vec<T> = all.collect();
    let most = all.iter().max()?;
    if all.iter().all(|x| x == most) { None } else { all.iter().position(|x| x == most) }
}

/// What the leaves of a tree say.
pub(super) struct Walked {
    /// The shares of the window that are stable, not stable, and unknown.
    pub shares: [Q; 3],
    /// Where one parameter alone is asked about, its ranges that are stable or not, ascending, what follows each other taken together.
    pub pieces: Vec<(char, [Q; 2])>,
}

impl Walked {
    pub fn new() -> Self {
        Walked { shares: [Q::zero(), Q::zero(), Q::zero()], pieces: Vec::new() }
    }

    /// The ranges of a parameter that have this letter.
    pub fn ranges(&self, letter: char, name: &str) -> String {
        let own = self.pieces.iter().filter(|(l, _)| *l == letter);
        let range = |[low, high]: [String; 2]| format!("{low} <= {name} <= {high}");
        own.map(|(_, [low, high])| range(inward(low, high))).collect::<Vec<_>>().join(" and ")
    }

    pub fn add(&mut self, letter: char, [low, high]: &[Q; 2]) {
        match self.pieces.last_mut() {
            Some((last, [_, end])) if *last == letter && end == low => *end = high.clone(),
            _ => self.pieces.push((letter, [low.clone(), high.clone()])),
        }
    }
}

impl BoxJudge {
    /// That each leaf of the tree is what it says.
    fn walk(&self) -> Result<Walked, Rejection> {
        let mut stack = vec![(self.whole(), 0)];
        let is_line = self.statement().is_line();
        let mut walked = Walked::new();
        let stable = |reason: String| Rejection { step: Step::Stable, reason };
        for letter in self.statement().tree.chars() {
            Step::Line.of(self.clock().tick())?;
            let Some((mut cell, depth)) = stack.pop() else {
                return Step::Line.fails("something follows the tree");
            };
            let share = || Q::new_raw(One::one(), num_bigint::BigInt::one() << depth);
            match letter {
                'y' if is_line => return Step::Line.fails("a side without a width is halved"),
                'x' | 'y' => {
                    if depth >= MAX_DEPTH {
                        return Step::Line.fails("the tree is too deep");
                    }
                    let [low, high] = Step::Line.of(self.halved(&mut cell, usize::from(letter == 'y')))?;
                    stack.extend([(high, depth + 1), (low, depth + 1)]);
                }
                '+' | '-' => {
                    if !self.shown(&mut cell, letter == '+').map_err(stable)? {
                        return Err(stable(format!("a leaf '{letter}' is not shown: {cell}")));
                    }
                    walked.shares[usize::from(letter == '-')] += share();
                    if is_line {
                        walked.add(letter, &cell.sides()[0]);
                    }
                }
                '?' => walked.shares[2] += share(),
                other => return Step::Line.fails(format!("'{}' is no part of a tree", other.escape_debug())),
            }
        }
        if stack.is_empty() { Ok(walked) } else { Step::Line.fails("the tree ends too early") }
    }
}
