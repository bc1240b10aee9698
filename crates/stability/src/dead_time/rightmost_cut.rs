//! Where a line is put between roots that are listed and roots that are not.

use jurist_algebra::number::{Integer, Rational};

/// A place between two real parts.
#[derive(Clone, Debug)]
pub(super) struct Gap {
    pub lower: Rational,
    pub upper: Rational,
}

/// A gap is to be at least this share of the real parts beside it: along a line that is nearer to roots there is no end of steps.
const LEAST_BITS: u64 = 10;

/// So many roots more than were asked for are listed at most, where real parts are nearly the same.
pub(super) const MOST_MORE: usize = 8;

impl Gap {
    fn width(&self) -> Rational {
        &self.upper - &self.lower
    }

    fn is_wide(&self) -> bool {
        let beside = self.lower.abs().max(self.upper.abs());
        self.lower < self.upper && self.width() >= beside * Rational::dyadic(&Integer::ONE, LEAST_BITS)
    }

    /// The decimal number with the fewest digits in the middle third.
    pub fn decimal(&self) -> Rational {
        let third = self.width() * Rational::new(Integer::ONE, Integer::from(3));
        let (low, high) = (&self.lower + &third, &self.upper - &third);
        let ten = |digits: i64| Rational::from(10).pow(digits).expect("ten is not zero");
        let mut digits = 0i64;
        while ten(-digits) < third {
            digits -= 1;
        }
        loop {
            let unit = ten(-digits);
            let x = Rational::from(&low.checked_div(&unit).expect("not zero").ceil()) * unit;
            if x <= high {
                return x;
            }
            digits += 1;
        }
    }
}

/// Real parts as intervals, from the right; the last of them is known to be followed by others further left.
///
/// After how many of them to cut, and in which gap: after as many as are wanted, or some more where real parts are nearly the same. Left of
/// the `floor` nothing can be said; then there may be fewer, and the line is near to it, in units of `unit`. `None` where too few are known.
pub(super) fn cut(
    reals: &[[Rational; 2]],
    wanted: usize,
    floor: Option<&Rational>,
    unit: &Rational,
) -> Option<(usize, Gap)> {
    let before = |i: usize| reals[..i].iter().map(|[low, _]| low).min().cloned();
    let after = |i: usize| reals[i..].iter().map(|[_, high]| high).max().cloned();
    let gap = |i: usize| -> Option<Gap> {
        let lower = match (after(i), floor) {
            (Some(x), Some(floor)) => x.max(floor.clone()),
            (Some(x), None) => x,
            (None, Some(floor)) => floor.clone(),
            (None, None) => return None,
        };
        let upper = before(i).unwrap_or_else(|| &lower + unit * Rational::dyadic(&Integer::ONE, 5));
        Some(Gap { lower, upper })
    };
    let most = reals.len().min(wanted + MOST_MORE);
    let wide = (wanted..=most).find_map(|i| gap(i).filter(Gap::is_wide).map(|gap| (i, gap)));
    if wide.is_some() {
        return wide;
    }
    if floor.is_some() {
        let fewer = (0..wanted.min(reals.len() + 1)).rev().find_map(|i| gap(i).filter(Gap::is_wide).map(|g| (i, g)));
        if fewer.is_some() {
            return fewer;
        }
    }
    let widest = (wanted..=most).filter_map(|i| gap(i).map(|gap| (i, gap))).filter(|(_, gap)| gap.lower < gap.upper);
    widest.max_by(|(_, a), (_, b)| a.width().cmp(&b.width()))
}
