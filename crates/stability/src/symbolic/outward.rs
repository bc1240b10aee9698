//! How far a parameter without bounds is looked at: from its usual value outward, as long as that is cheap.

use super::boundary_zeros::{Boundary, Reach, Zero, disjoint, zeros_within};
use crate::line::Bracket;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Rational, Sign};
use jurist_algebra::symbols::{Function, MovingSymbols};
use std::sync::Arc;

/// Where nothing bounds a parameter and nothing dies away, it is looked at up to these multiples of its usual value. Those beyond the
/// first are only looked at while there is little to see.
pub(super) const MULTIPLES: [i64; 3] = [8, 64, 1024];

/// The same where the usual value is zero: then the unit is a range in which no root reaches the boundary, which may be short.
const OF_SCALE: [i64; 12] = [8, 32, 128, 512, 1 << 11, 1 << 13, 1 << 15, 1 << 17, 1 << 19, 1 << 21, 1 << 23, 1 << 25];

/// With more zeros than this no more is looked at: the boundary repeats itself, as with an angle.
const MOST_ZEROS: usize = 24;

/// With more open brackets than this no more is looked at.
const MOST_OPEN: usize = 8;

/// So much work each step outward may take, in the units of [`checkpoint`](jurist_algebra::limits::checkpoint): about a second.
const MOST_WORK: u64 = 20_000_000;

/// What was found as far as was looked.
pub(super) struct Found {
    pub reach: Reach,
    pub zeros: Vec<Zero>,
    pub undecided: Vec<Bracket>,
}

/// The functions of which zeros are looked for.
pub(super) struct Looked<'a> {
    pub boundaries: &'a [Boundary],
    pub basis: &'a [Function],
    pub symbols: &'a Arc<MovingSymbols>,
    /// A value on whose scale the loop changes.
    pub usual: &'a Rational,
    /// Whether that is no value that was given.
    pub is_scale: bool,
    pub budget: &'a Budget,
}

impl Looked<'_> {
    /// The zeros as far as a reach goes, and further out where it is open.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn outward(&self, reach: Reach) -> Result<Found, Exhausted> {
        let (zeros, undecided) = self.zeros(&reach)?;
        let mut found = Found { reach, zeros, undecided };
        let multiples = if self.is_scale { &OF_SCALE[1..] } else { &MULTIPLES[1..] };
        for &multiple in multiples {
            let open = found.undecided.iter().filter(|(lo, hi)| lo.is_some() && hi.is_some()).count();
            if found.zeros.len() > MOST_ZEROS || open > MOST_OPEN || !self.goes_on(&mut found, multiple)? {
                break;
            }
        }
        Ok(found)
    }

    fn zeros(&self, reach: &Reach) -> Result<(Vec<Zero>, Vec<Bracket>), Exhausted> {
        zeros_within((self.boundaries, self.basis), self.symbols, reach, self.usual, &|_| true, self.budget)
    }

    /// Looks as far as a multiple; `false` where that is too much work, or not further out.
    fn goes_on(&self, found: &mut Found, multiple: i64) -> Result<bool, Exhausted> {
        let far = self.usual.abs() * Rational::from(multiple);
        let (from, to) = (found.reach.from.clone(), found.reach.to.clone());
        let before = (from.clone(), to.clone());
        let below = (found.reach.is_open_below() && -&far < from).then(|| (-&far, from));
        let above = (found.reach.is_open_above() && to < far).then(|| (to, far.clone()));
        let parts = [below, above];
        // A zero where two parts meet would be in neither.
        for seam in [parts[0].as_ref().map(|(_, hi)| hi), parts[1].as_ref().map(|(lo, _)| lo)].into_iter().flatten() {
            if !self.is_clear(seam)? {
                return Ok(false);
            }
        }
        let work = Budget::with_work(MOST_WORK);
        let mut lists = [(Vec::new(), Vec::new()), (Vec::new(), Vec::new())];
        for (part, list) in parts.iter().zip(&mut lists) {
            let Some((lo, hi)) = part else { continue };
            match work.enter(|| self.zeros(&Reach::between(lo, hi))) {
                Ok(zeros) => *list = zeros?,
                Err(_) => return Ok(false),
            }
        }
        if parts.iter().all(Option::is_none) {
            return Ok(false);
        }
        let [(mut zeros, mut brackets), (after, more)] = lists;
        zeros.append(&mut found.zeros);
        zeros.extend(after);
        brackets.append(&mut found.undecided);
        brackets.extend(more);
        // A bracket without an end may begin inside of the range that was searched: that part stays undecided.
        for (lo, hi) in &mut brackets {
            if lo.is_none() && hi.as_ref().is_none_or(|x| *x > before.0) {
                *lo = Some(before.0.clone());
            }
            if hi.is_none() && lo.as_ref().is_none_or(|x| *x < before.1) {
                *hi = Some(before.1.clone());
            }
        }
        brackets.retain(|(lo, hi)| lo.is_some() && hi.is_some());
        if parts[0].is_some() {
            found.reach.widen_below(-&far);
        }
        if parts[1].is_some() {
            found.reach.widen_above(far);
        }
        brackets.extend(found.reach.undecided.iter().cloned());
        (found.zeros, found.undecided) = (zeros, disjoint(brackets));
        Ok(true)
    }

    fn is_clear(&self, x: &Rational) -> Result<bool, Exhausted> {
        for boundary in self.boundaries {
            let vanishes = boundary.algebraic.sign_at(x) == Sign::Equal;
            if vanishes || self.symbols.may_vanish_at(&boundary.function, x, self.budget)? {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
