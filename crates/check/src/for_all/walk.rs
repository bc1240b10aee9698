//! The walk over the tree of a certificate for all values.

use super::{Beyond, ForAllJudge, Part, Told};
use crate::clock::Clock;
use crate::map_boxes::{JudgedBox, MAX_DEPTH, OneLoop, Parts, Walked};
use crate::number::{Q, Z};
use crate::{Rejection, Step};
use num_traits::One;
use std::str::Chars;

/// The names by their letters.
pub(crate) fn axis(letter: char) -> Option<usize> {
    ('a'..='h').position(|own| own == letter)
}

pub(crate) fn line(reason: impl Into<String>) -> Rejection {
    Rejection { step: Step::Line, reason: reason.into() }
}

fn stable(reason: String) -> Rejection {
    Rejection { step: Step::Stable, reason }
}

impl ForAllJudge {
    /// That each leaf of the tree is what it says, and the point beyond.
    pub(super) fn walk(&self, told: &Told) -> Result<Walked, Rejection> {
        let of = self.asked();
        let mut letters = told.tree.chars();
        let mut walked = Walked::new();
        let mut stack = vec![(of.window[..of.axes].to_vec(), 0)];
        while let Some((axes, depth)) = stack.pop() {
            Step::Line.of(self.clock().tick())?;
            let letter = letters.next().ok_or_else(|| line("the tree ends too early"))?;
            match letter {
                '+' => (0..self.loops()).try_for_each(|k| self.proofs_of(k, &axes, &mut letters))?,
                '-' => self.refutation(&axes, self.loops(), &mut letters)?,
                '?' => {}
                other => {
                    let axis = axis(other).filter(|axis| *axis < axes.len());
                    let axis = axis.ok_or_else(|| line(format!("'{}' is no part of a tree", other.escape_debug())))?;
                    deeper(depth)?;
                    let [low, high] = halves(&axes[axis]).map(|side| {
                        let mut half = axes.clone();
                        half[axis] = side;
                        (half, depth + 1)
                    });
                    stack.extend([high, low]);
                    continue;
                }
            }
            let place = ['+', '-', '?'].iter().position(|own| *own == letter).unwrap_or(2);
            walked.shares[place] += Q::new_raw(Z::one(), Z::one() << depth);
            if let ([side], '+' | '-') = (axes.as_slice(), letter) {
                walked.add(letter, side);
            } else if axes.is_empty() {
                walked.pieces.push((letter, [Q::one(), Q::one()]));
            }
        }
        if letters.next().is_some() {
            return Err(line("something follows the tree"));
        }
        Ok(walked)
    }

    /// That a loop is stable for all values of what is no axis.
    pub(crate) fn proofs_of(&self, k: usize, axes: &[[Q; 2]], letters: &mut Chars<'_>) -> Result<(), Rejection> {
        self.proofs_over(axes, k).into_iter().try_for_each(|own| self.proof(k, own, letters))
    }

    /// That a loop is stable in a box.
    fn proof(&self, k: usize, of: JudgedBox, letters: &mut Chars<'_>) -> Result<(), Rejection> {
        let mut stack = vec![(of, 0)];
        while let Some((mut part, depth)) = stack.pop() {
            Step::Line.of(self.clock().tick())?;
            match letters.next().ok_or_else(|| line("a proof ends too early"))? {
                '.' => {
                    if !self.shown(k, &mut part, true).map_err(stable)? {
                        return Err(stable(format!("a leaf '+' is not shown for loop {k}: {part}")));
                    }
                }
                letter => {
                    let axis = axis(letter).filter(|axis| *axis < self.names(k));
                    let axis =
                        axis.ok_or_else(|| line(format!("'{}' is no part of a proof", letter.escape_debug())))?;
                    deeper(depth)?;
                    has_width(&part, axis)?;
                    Step::Line.of(self.of_number(k).keep(stack.len() + 3, self.clock()))?;
                    let [low, high] = Step::Line.of(self.halved(k, &mut part, axis))?;
                    stack.extend([(high, depth + 1), (low, depth + 1)]);
                }
            }
        }
        Ok(())
    }

    /// That a loop is not stable for some values of the names that are no axes, the same for all points of the axes.
    pub(crate) fn refutation(&self, axes: &[[Q; 2]], loops: usize, letters: &mut Chars<'_>) -> Result<(), Rejection> {
        let k = self.number(loops, letters)?;
        let part = self.stepped(k, self.over_axes(axes, k), letters)?;
        not_stable(self.of_number(k), k, part, self.clock())
    }

    /// That a loop has a root beyond the boundary by more than a power of two, in the same way.
    pub(crate) fn far_refutation(
        &self,
        axes: &[[Q; 2]],
        exponent: i64,
        loops: usize,
        letters: &mut Chars<'_>,
    ) -> Result<(), Rejection> {
        let k = self.number(loops, letters)?;
        let mut part = self.stepped(k, self.over_axes(axes, k), letters)?;
        if !self.of_number(k).has_root_beyond(&mut part, exponent, self.clock()).map_err(stable)? {
            return Err(stable(format!("a leaf 's' is not shown for loop {k}: {part}")));
        }
        Ok(())
    }

    /// The number of a loop, one of the first ones.
    fn number(&self, loops: usize, letters: &mut Chars<'_>) -> Result<usize, Rejection> {
        let k = letters.next().and_then(|digit| digit.to_digit(10)).map(|k| k as usize);
        k.filter(|k| *k < loops).ok_or_else(|| line("a leaf '-' does not say of which loop it is"))
    }

    /// The part of a box to which steps lead.
    fn stepped(&self, k: usize, mut part: JudgedBox, letters: &mut Chars<'_>) -> Result<JudgedBox, Rejection> {
        for depth in 0.. {
            Step::Line.of(self.clock().tick())?;
            let letter = letters.next().ok_or_else(|| line("a leaf '-' ends too early"))?;
            if letter == '.' {
                break;
            }
            let step = Part::named(letter).ok_or_else(|| line(format!("'{}' is no step", letter.escape_debug())))?;
            let axis = letters.next().and_then(axis);
            let own = self.asked().axes..self.names(k);
            let axis = axis.filter(|axis| own.contains(axis)).ok_or_else(|| line("a step has no name, or an axis"))?;
            deeper(depth)?;
            part = self.part(&part, step, axis);
        }
        Ok(part)
    }

    /// That the point beyond is not good.
    pub(super) fn walk_beyond(&self, beyond: &Beyond, model: &str, parts: &Parts) -> Result<(), Rejection> {
        let mut letters = beyond.not.chars();
        let k = self.number(self.loops(), &mut letters)?;
        let part = self.stepped(k, self.at_point(&beyond.point, k), &mut letters)?;
        match self.beyond(k, beyond, model, parts)? {
            Some(of) => not_stable(&of, k, part, self.clock())?,
            None => not_stable(self.of_number(k), k, part, self.clock())?,
        }
        if letters.next().is_some() { Err(line("something follows the point beyond")) } else { Ok(()) }
    }
}

/// That a loop is stable nowhere in a part of a box.
fn not_stable(of: &OneLoop, k: usize, mut part: JudgedBox, clock: &Clock) -> Result<(), Rejection> {
    if !of.shown(&mut part, false, clock).map_err(stable)? {
        return Err(stable(format!("a leaf '-' is not shown for loop {k}: {part}")));
    }
    Ok(())
}

pub(crate) fn halves([low, high]: &[Q; 2]) -> [[Q; 2]; 2] {
    let middle = (low + high) / Q::from(Z::from(2));
    [[low.clone(), middle.clone()], [middle, high.clone()]]
}

pub(crate) fn deeper(depth: usize) -> Result<(), Rejection> {
    if depth < MAX_DEPTH { Ok(()) } else { Err(line("the tree is too deep")) }
}

fn has_width(of: &JudgedBox, axis: usize) -> Result<(), Rejection> {
    let [low, high] = &of.sides()[axis];
    if low < high { Ok(()) } else { Err(line("a side without a width is cut")) }
}
