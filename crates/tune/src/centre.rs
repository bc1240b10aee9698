//! The middle of the good gains: how far all gains may go from a point while everything is met.
//!
//! Of a box of middles none has a tolerance if some point that is bad lies within that tolerance of all of them: bad points that were seen once refute
//! later boxes.

use crate::for_all::Sides;
use jurist_algebra::number::Rational;
use std::cell::RefCell;

/// What a tolerance is counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A share of each gain.
    Relative,
    /// The same number of each gain.
    Absolute,
    /// A factor by which each gain is multiplied or divided.
    Ratio,
}

impl Measure {
    /// All of them.
    pub const ALL: [Measure; 3] = [Measure::Relative, Measure::Absolute, Measure::Ratio];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Measure::Relative => "relative",
            Measure::Absolute => "absolute",
            Measure::Ratio => "ratio",
        }
    }

    /// The value of no tolerance.
    pub fn least(self) -> Rational {
        if self == Measure::Ratio { Rational::ONE } else { Rational::ZERO }
    }

    /// The values of a gain within a tolerance.
    pub fn around(self, gain: &Rational, value: &Rational) -> [Rational; 2] {
        match self {
            Measure::Relative => {
                let by = gain.abs() * value;
                [gain - &by, gain + &by]
            }
            Measure::Absolute => [gain - value, gain + value],
            Measure::Ratio => {
                let less = gain.checked_div(value).expect("a factor is 1 at least");
                let more = gain * value;
                if gain.is_negative() { [more, less] } else { [less, more] }
            }
        }
    }

    /// What the values within a tolerance of all gains of a side have in common; nothing where the first is above the second.
    fn core(self, [low, high]: &[Rational; 2], value: &Rational) -> [Rational; 2] {
        // Both ends are linear on each side of zero.
        let is_inside = low.is_negative() && high.sign().is_gt();
        let zero = is_inside.then_some(Rational::ZERO);
        let all: Vec<[Rational; 2]> =
            [Some(low), Some(high), zero.as_ref()].into_iter().flatten().map(|gain| self.around(gain, value)).collect();
        let ends = [all.iter().map(|[low, _]| low).max(), all.iter().map(|[_, high]| high).min()];
        ends.map(|end| end.expect("a side has ends").clone())
    }
}

/// Bad points that refute boxes of middles.
pub(crate) struct Centre {
    pub measure: Measure,
    /// The bounds: what is beyond them is bad as well.
    whole: Sides,
    bad: RefCell<Vec<Vec<Rational>>>,
}

/// More bad points are not kept.
const MOST_POINTS: usize = 256;

impl Centre {
    pub fn new(measure: Measure, whole: &Sides) -> Centre {
        Centre { measure, whole: whole.clone(), bad: RefCell::new(Vec::new()) }
    }

    /// The box of a point; `None` where it leaves the bounds.
    pub fn around(&self, point: &[Rational], value: &Rational) -> Option<Sides> {
        let sides: Sides = point.iter().map(|gain| self.measure.around(gain, value)).collect();
        let is_within = |([low, high], [least, most]): (&[Rational; 2], &[Rational; 2])| least <= low && high <= most;
        sides.iter().zip(&self.whole).all(is_within).then_some(sides)
    }

    /// A point that does not meet all.
    pub fn is_bad_at(&self, point: Vec<Rational>) {
        let mut bad = self.bad.borrow_mut();
        bad.insert(0, point);
        bad.truncate(MOST_POINTS);
    }

    /// Whether no middle in a box has a tolerance: its values leave the bounds, or hold a bad point.
    pub fn is_refuted(&self, middles: &[[Rational; 2]], value: &Rational) -> bool {
        let core: Sides = middles.iter().map(|side| self.measure.core(side, value)).collect();
        // Beyond a bound for all middles; the two ends of the core need no order for that.
        let leaves = |([low, high], [least, most]): (&[Rational; 2], &[Rational; 2])| low < least || high > most;
        if core.iter().zip(&self.whole).any(leaves) {
            return true;
        }
        let holds = |point: &Vec<Rational>| point.iter().zip(&core).all(|(x, [low, high])| low <= x && x <= high);
        let mut bad = self.bad.borrow_mut();
        let Some(first) = bad.iter().position(holds) else { return false };
        let point = bad.remove(first);
        bad.insert(0, point);
        true
    }
}
