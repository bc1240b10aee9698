//! What is shown of single boxes of a loop with dead time.

mod headings;
mod local;
mod terms;
mod turn;

use super::functions::Functions;
use super::polynomial::are_defined;
use super::{Parts, Question, Sides, largest, share_of_window};
use crate::clock::Clock;
use crate::moving::Sources;
use crate::multivariate::Multi;
use crate::number::{Q, Z};
use crate::over_box::{OverBox, separated};
use crate::over_symbols::primitive;
use crate::statement::Extent;
use crate::taylor::{Precision, Taylor};
use headings::{Headings, Piece, push_clear, roots_to_the_right};
use local::{FREQUENCY_BITS, Local, Part, Stretch};
use num_traits::{Signed, Zero};
use std::ops::{Range, RangeInclusive};
pub(crate) use terms::is_long;
use terms::{Terms, Time};
use turn::Turns;

/// Powers of two, relative to the size of the roots in the middle of the window, between which the highest power of `s` is to outweigh the rest.
const BOUNDS: RangeInclusive<i64> = -20..=40;

/// The way is first cut at so many powers of two, and each part between them into four.
const OCTAVES: i64 = 8;

/// These are halved so often at most.
const MOST_HALVINGS: usize = 24;

/// No more stretches are looked at for one box.
const MOST_STRETCHES: usize = 2000;

/// A stretch is halved where one that is short would leave more than one part in two to this power of the value in its middle.
const WORTH: Option<u32> = Some(3);

/// The size of the roots is looked for between these powers of two.
const MOST_SCALE: i64 = 1000;

/// The characteristic function over the window, in frequencies of the size of its roots.
pub(super) struct Delayed {
    /// The dead times of the parts, none for the first.
    delays: Vec<Time>,
    /// Two to this power is the unit of frequencies.
    scale: i64,
    order: usize,
    times: Vec<Time>,
    sources: Sources,
    /// The coefficients of all parts, then lists of divisors.
    functions: Functions,
    divisors: Vec<Range<usize>>,
    /// Whether one of them depends on the factor.
    pub divides_by_factor: bool,
    is_nowhere: bool,
    precision: Precision,
    turns: Turns,
}

/// A stretch of the axis: where it begins, in units, and the power of two that is its length.
#[derive(Clone, Debug)]
struct Cell {
    low: Z,
    length: usize,
}

/// The way along the axis for all points of a box.
#[derive(Clone, Debug)]
struct Way {
    /// Whether the highest power of `s`, which outweighs the rest at the end of the way, has a negative coefficient.
    is_negative: bool,
    pieces: Vec<Piece<Cell>>,
}

/// What is known of a box.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    way: Option<Way>,
    is_looked_at: bool,
    verdict: Option<bool>,
    /// The axis to cut.
    axis: Option<usize>,
}

impl Known {
    /// What is known of a half before it is looked at.
    pub fn of_a_half(&self) -> Known {
        Known { way: self.way.clone(), ..Known::default() }
    }

    /// Whether the box is stable everywhere, or nowhere.
    pub fn verdict(&self) -> Option<bool> {
        self.verdict
    }

    pub fn axis(&self, sides: &Sides, window: &Sides) -> usize {
        self.axis.unwrap_or_else(|| share_of_window(sides, window))
    }
}

impl Delayed {
    pub fn new(own: OverBox, sources: Sources, of: &Question, parts: &Parts, clock: &Clock) -> Result<Self, String> {
        if own.discrete || of.extent != Extent::Number(Q::zero()) {
            return Err("a loop with dead time is not continuous, or its boundary is not the imaginary axis".into());
        }
        if of.window.iter().flatten().any(is_long) {
            return Err("an end of the window has too many digits".into());
        }
        let parameters = of.window.len();
        let own = own.doubled(clock)?;
        let positive = own.positive.clone();
        let terms = Terms::new(own, &sources, parameters, clock)?;
        let farthest: Vec<Q> = of.window.iter().map(|[low, high]| low.abs().max(high.abs())).collect();
        let scale = terms.scale(&farthest);
        if scale.abs() > MOST_SCALE {
            return Err("the frequencies are too low or too high".into());
        }
        let is_nowhere = terms.divisors.iter().any(|list| list.iter().all(Multi::is_zero));
        let (delays, coefficients): (Vec<Time>, Vec<Vec<Multi>>) = terms.terms.into_iter().unzip();
        let order = coefficients[0].len() - 1;
        // With s = 2^scale x, times a positive number.
        let size = scale.unsigned_abs() as usize;
        let factor = |j: usize| Z::from(1) << (size * if scale >= 0 { j } else { order - j });
        let scaled =
            |part: Vec<Multi>| part.into_iter().enumerate().map(|(j, c)| c.scaled(&factor(j))).collect::<Vec<_>>();
        let mut all: Vec<Multi> = primitive(coefficients.into_iter().flat_map(scaled).collect(), clock)?;
        let mut divisors = Vec::with_capacity(terms.divisors.len());
        let lists = separated(terms.divisors, &positive, clock)?;
        let divides_by_factor = of.has_own_name(&lists);
        for list in lists {
            divisors.push(all.len()..all.len() + list.len());
            all.extend(primitive(list, clock)?);
        }
        Ok(Delayed {
            delays,
            scale,
            order,
            times: terms.times,
            sources,
            functions: Functions::new(&all, parameters),
            divisors,
            divides_by_factor,
            is_nowhere,
            precision: Precision::new(parameters, parts.order, parts.bits),
            turns: Turns::new(parts.bits),
        })
    }

    /// Looks at a box once.
    pub fn look(&self, sides: &Sides, known: &mut Known, clock: &Clock) -> Result<(), String> {
        if !known.is_looked_at {
            known.is_looked_at = true;
            known.verdict = self.seen(sides, known, clock)?;
        }
        Ok(())
    }

    fn seen(&self, sides: &Sides, known: &mut Known, clock: &Clock) -> Result<Option<bool>, String> {
        let way = known.way.take();
        if self.is_nowhere {
            return Ok(Some(false));
        }
        let times: Vec<[Q; 2]> = self.times.iter().map(|time| time.range(sides)).collect();
        if times.iter().any(|[_, most]| most.is_negative()) {
            // No loop has a negative dead time.
            return Ok(Some(false));
        }
        if times.iter().any(|[least, _]| least.is_negative())
            || self.delays.iter().any(|time| time.range(sides)[0].is_negative())
        {
            return Ok(None);
        }
        clock.tick()?;
        let p = &self.precision;
        let parameters = sides.iter().enumerate().map(|(i, side)| Taylor::coordinate(side, i, p)).collect();
        let functions = self.sources.values(parameters, p, clock).and_then(|v| self.functions.at(&v, p, clock));
        clock.tick()?;
        // A box may be too wide for a series; then it is not shown.
        let Ok(functions) = functions else { return Ok(None) };
        let count = (self.order + 1) * self.delays.len();
        let coefficients: Vec<&[Taylor]> = functions[..count].chunks(self.order + 1).collect();
        let top = &coefficients[0][self.order];
        let Some(is_positive) = top.sign() else { return Ok(Self::cut_at_top(&coefficients, sides.len(), known)) };
        let zero = coefficients.iter().fold(Taylor::zero(), |sum, part| sum.plus(&part[0]));
        let mut way = match way {
            Some(way) => way,
            None => {
                let Some(bound) = self.bound(&coefficients) else {
                    if self.has_chain_on_the_right(&coefficients, sides) {
                        return Ok(Some(false));
                    }
                    return Ok(Self::cut_at_top(&coefficients, sides.len(), known));
                };
                let pieces = cells_up_to(bound).map(|cell| Piece::Open { cell, slopes: 0 }).collect();
                Way { is_negative: !is_positive, pieces }
            }
        };
        if zero.sign().is_some_and(|sign| sign != is_positive) {
            // A real root is to the right.
            return Ok(Some(false));
        }
        let parts = self.parts(&coefficients, sides);
        let votes = [(); 2].map(|()| vec![0; sides.len()]);
        let mut walk = Walk { judge: self, parts: &parts, clock, pieces: Vec::new(), votes, looked_at: 0 };
        let is_whole = walk.along(std::mem::take(&mut way.pieces))?;
        known.axis = walk.axis();
        way.pieces = walk.pieces;
        let right = is_whole.then(|| roots_to_the_right(&way.pieces, self.order, way.is_negative)).flatten();
        known.way = Some(way);
        Ok(match right {
            Some(right) if right.least > 0 => Some(false),
            Some(right) if right.is_exact && right.least == 0 && are_defined(&self.divisors, &functions) => Some(true),
            _ => None,
        })
    }

    /// Nothing is seen, and the axis to cut is that on which the highest power depends.
    fn cut_at_top(coefficients: &[&[Taylor]], parameters: usize, known: &mut Known) -> Option<bool> {
        let top = |part: &&[Taylor], axis: usize| part.last().map(|top| top.linear(axis).abs()).unwrap_or_default();
        let by = |axis: usize| coefficients.iter().map(|part| top(part, axis)).sum::<Z>();
        known.axis = largest((0..parameters).map(by));
        None
    }

    /// A power of two beyond which the highest power of `s` outweighs, on the axis, all that may point against it.
    fn bound(&self, coefficients: &[&[Taylor]]) -> Option<i64> {
        let n = self.order;
        let top = &coefficients[0][n];
        let least = top.constant().abs() - top.variation();
        // What is an odd number of powers below it in its own part points across.
        let is_against = |k: usize, j: usize| k > 0 || (j < n && (n - j).is_multiple_of(2));
        let sum = |j: usize| {
            let parts = coefficients.iter().enumerate().filter(|(k, _)| is_against(*k, j));
            parts.map(|(_, part)| part[j].magnitude()).sum::<Z>()
        };
        let others: Vec<Z> = (0..=n).map(sum).collect();
        if others[n] >= least {
            return None;
        }
        // Everything times 2^(-first n).
        let first = BOUNDS.start().unsigned_abs() as usize;
        BOUNDS.clone().find(|e| {
            let power = |j: usize| (e + first as i64) as usize * j + first * (n - j);
            let rest = others.iter().enumerate().map(|(j, c)| c << power(j)).sum::<Z>();
            rest < &least << power(n)
        })
    }

    /// Whether one delayed highest power of `s`, the only one, outweighs that without delay at all points: infinitely many roots are to the
    /// right then.
    fn has_chain_on_the_right(&self, coefficients: &[&[Taylor]], sides: &Sides) -> bool {
        let [own, delayed @ ..] = coefficients else { return false };
        let tops = delayed.iter().map(|part| &part[self.order]).zip(&self.delays[1..]);
        let mut tops = tops.filter(|(top, _)| !top.magnitude().is_zero());
        match (tops.next(), tops.next()) {
            (Some((top, time)), None) => {
                let is_larger = top.constant().abs() - top.variation() > own[self.order].magnitude();
                is_larger && time.range(sides)[0].is_positive()
            }
            _ => false,
        }
    }

    fn parts(&self, coefficients: &[&[Taylor]], sides: &Sides) -> Vec<Part> {
        let bits = self.precision.bits;
        let longest = coefficients.iter().flat_map(|part| part.iter()).map(|c| c.magnitude().bits()).max().unwrap_or(0);
        let down = longest.saturating_sub(bits as u64) as usize;
        let size = Z::from(1) << self.scale.unsigned_abs();
        let factor = if self.scale >= 0 { Q::from(size) } else { Q::new(Z::from(1), size) };
        let part = |(coefficients, time): (&&[Taylor], &Time)| {
            let short: Vec<Taylor> = coefficients.iter().map(|c| c.halved(down)).collect();
            let delay = (!time.is_zero()).then(|| time.about_middle(sides, &factor));
            Part::new(&short, sides.len(), delay, bits)
        };
        coefficients.iter().zip(&self.delays).map(part).collect()
    }
}

/// The parts of the axis from 0 to a power of two.
fn cells_up_to(bound: i64) -> impl Iterator<Item = Cell> {
    let last = (bound + FREQUENCY_BITS as i64) as usize;
    let first = last - OCTAVES as usize;
    let fourths =
        (first..last).flat_map(|e| (4_u32..8).map(move |k| Cell { low: Z::from(k) << (e - 2), length: e - 2 }));
    std::iter::once(Cell { low: Z::zero(), length: first }).chain(fourths)
}

/// A walk along the axis for a box.
struct Walk<'a> {
    judge: &'a Delayed,
    parts: &'a [Part],
    clock: &'a Clock,
    pieces: Vec<Piece<Cell>>,
    /// How much each parameter moves the function where it may vanish: where nothing is known, and where its direction is.
    votes: [Vec<u64>; 2],
    looked_at: usize,
}

impl Walk<'_> {
    /// Over all pieces of the way, where they are not clear; whether something is known everywhere.
    fn along(&mut self, pieces: Vec<Piece<Cell>>) -> Result<bool, String> {
        let mut pieces = pieces.into_iter();
        while let Some(piece) = pieces.next() {
            let is_seen = match piece {
                Piece::Clear { first, last } => match self.pieces.last_mut() {
                    Some(Piece::Clear { .. }) => {
                        let is_joined = push_clear(&mut self.pieces, first).is_some();
                        if let Some(Piece::Clear { last: own, .. }) = self.pieces.last_mut() {
                            *own += last - first;
                        }
                        is_joined
                    }
                    _ => {
                        self.pieces.push(Piece::Clear { first, last });
                        true
                    }
                },
                Piece::Open { cell, .. } => self.over(cell)?,
            };
            if !is_seen {
                // The rest of the way is of no use to this box.
                self.pieces.extend(pieces);
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn over(&mut self, cell: Cell) -> Result<bool, String> {
        let shortest = cell.length.saturating_sub(MOST_HALVINGS).max(1);
        let mut cells = vec![cell];
        while let Some(cell) = cells.pop() {
            let half = Z::from(1) << (cell.length - 1);
            let middle = &cell.low + &half;
            let before = match self.pieces.last() {
                Some(Piece::Clear { last, .. }) => Some(*last),
                _ => None,
            };
            let local = self.local(&middle, &half)?;
            if let Some(k) = local.clear(before, None) {
                if push_clear(&mut self.pieces, k).is_some() {
                    continue;
                }
                return Ok(self.leave(cell, cells));
            }
            let slopes = local.slopes(None);
            if cell.length > shortest && self.looked_at < MOST_STRETCHES {
                let point = self.local(&middle, &Z::zero())?;
                if point.clear(None, WORTH).is_some() || (slopes == 0 && point.slopes(WORTH) != 0) {
                    let length = cell.length - 1;
                    cells.push(Cell { low: middle, length });
                    cells.push(Cell { low: cell.low, length });
                    continue;
                }
            }
            let votes = self.votes[usize::from(slopes != 0)].iter_mut();
            votes.zip(local.shares(slopes)).for_each(|(sum, own)| *sum += own);
            self.pieces.push(Piece::Open { cell, slopes });
            if self.open_slopes() == 0 {
                self.pieces.extend(cells.into_iter().rev().map(|cell| Piece::Open { cell, slopes: 0 }));
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Gives a stretch up, and those behind it.
    fn leave(&mut self, cell: Cell, cells: Vec<Cell>) -> bool {
        let all = std::iter::once(cell).chain(cells.into_iter().rev());
        self.pieces.extend(all.map(|cell| Piece::Open { cell, slopes: 0 }));
        false
    }

    /// The headings of the derivative on the last pieces, as far as they are open.
    fn open_slopes(&self) -> Headings {
        let open = self.pieces.iter().rev().map_while(|piece| match piece {
            Piece::Open { slopes, .. } => Some(slopes),
            Piece::Clear { .. } => None,
        });
        open.fold(Headings::MAX, |all, own| all & own)
    }

    fn local(&mut self, middle: &Z, half: &Z) -> Result<Local, String> {
        self.looked_at += 1;
        let bits = self.judge.precision.bits;
        // By the time that the slower checker takes.
        let vectors = 2 + self.votes[0].len();
        let operations = 250 + 15 * vectors * (self.judge.order + 1) * self.parts.len();
        self.clock.spend(operations, bits as u64, FREQUENCY_BITS as u64)?;
        Ok(Local::new(self.parts, &Stretch { middle, half, turns: &self.judge.turns, bits }))
    }

    fn axis(&self) -> Option<usize> {
        self.votes.iter().find_map(|votes| largest(votes.iter().copied()))
    }
}
