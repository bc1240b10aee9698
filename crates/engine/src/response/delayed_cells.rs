//! The line of a factor, cut where roots are on the axis: one count of roots in each gap makes the stable set.

use super::enclosed::{greater, within};
use crate::error::Error;
use crate::stability::{Cause, Causes, ComplexPair, End, Range, Side, StableInterval, StableSet, zeros_in};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::UniPoly;
use jurist_algebra::real::{Real, rational_between};
use std::cmp::Ordering;

/// What happens at a factor.
#[derive(Clone)]
pub(super) enum Happening {
    /// A root is on the axis, at this frequency; its sign tells the side of a complex loop's root.
    Root(Real),
    /// The factor is 0: the loop is open, and not stable. Its root of lowest frequency on the axis, if there is one.
    Open(Option<(Real, Side)>),
    /// The difference operator ceases to be stable.
    Neutral,
    /// The loop is undefined.
    Pole,
    /// The range that is asked for ends.
    Domain,
}

/// A factor at which something happens.
#[derive(Clone)]
pub(super) struct Cut {
    pub factor: Real,
    pub what: Happening,
    pub enclosure: Enclosure,
}

impl Cut {
    /// Enclosed with some bits.
    pub fn new(factor: Real, what: Happening, bits: u64) -> Cut {
        let enclosure = within(&factor, bits);
        Cut { factor, what, enclosure }
    }

    /// Bounds of the size of the factor.
    pub fn sizes(&self) -> [Rational; 2] {
        sizes(&self.enclosure)
    }
}

/// Bounds of the size of a number other than 0.
fn sizes(x: &Enclosure) -> [Rational; 2] {
    let [low, high] = [x.lower().abs(), x.upper().abs()];
    if low < high { [low, high] } else { [high, low] }
}

/// A range of factors that contains all stable ones, with the factors at which the set of stable factors may begin or end.
pub(super) struct FactorCells {
    pub range: Range,
    pub cuts: Vec<Cut>,
    /// Whether frequencies have a sign.
    pub is_signed: bool,
}

impl FactorCells {
    /// Adds the ends of the domain as cuts, and the factors at which the difference operator ceases to be stable.
    pub fn cut_at_ends(&mut self, asked: &Range, neutral: Option<&Real>, bits: u64) {
        for end in [&asked.lower, &asked.upper].into_iter().flatten() {
            self.cuts.push(Cut::new(Real::from(end.clone()), Happening::Domain, bits));
        }
        if let Some(limit) = neutral {
            self.cuts.extend([limit.clone(), limit.negated()].map(|limit| Cut::new(limit, Happening::Neutral, bits)));
        }
    }

    /// Cuts where the loop is undefined.
    pub fn cut_at_poles(&mut self, poles: &[UniPoly], bits: u64, budget: &Budget) -> Result<(), Exhausted> {
        for pole in poles {
            for zero in zeros_in(pole, &self.range, budget)? {
                self.cuts.push(Cut::new(Real::from(zero), Happening::Pole, bits));
            }
        }
        Ok(())
    }

    /// The stable set. A stable gap that is shorter than the enclosures of its ends is left out.
    pub fn stable_set(
        mut self,
        is_stable: &dyn Fn(&Rational) -> Result<bool, Error>,
        budget: &Budget,
    ) -> Result<StableSet, Error> {
        let [least, greatest] = [&self.range.lower, &self.range.upper].map(|end| end.clone().expect("both are known"));
        if least < greatest {
            self.cuts.retain(|c| *c.enclosure.upper() >= least && *c.enclosure.lower() <= greatest);
        } else {
            self.cuts.clear();
        }
        self.cuts.sort_by(|a, b| a.enclosure.lower().cmp(b.enclosure.lower()));
        // Those that enclosures do not tell apart are one.
        let mut groups: Vec<Vec<Cut>> = Vec::new();
        for cut in std::mem::take(&mut self.cuts) {
            match groups.last_mut() {
                Some(group) if group.iter().any(|c| c.enclosure.upper() >= cut.enclosure.lower()) => group.push(cut),
                _ => groups.push(vec![cut]),
            }
        }
        budget.step("counting roots in the gaps");
        let mut intervals: Vec<StableInterval> = Vec::new();
        for (i, (below, above)) in groups.iter().zip(groups.iter().skip(1)).enumerate() {
            budget.check()?;
            budget.advance(i as u64, groups.len() as u64);
            let from = below.iter().map(|c| c.enclosure.upper()).max().expect("not empty");
            let to = above.iter().map(|c| c.enclosure.lower()).min().expect("not empty");
            if is_stable(&between(from, to, budget)?)? {
                let lower = self.end(below, Ordering::Greater);
                intervals.push(StableInterval::new(Some(lower), Some(self.end(above, Ordering::Less))));
            }
        }
        Ok(StableSet::from_intervals(intervals, Vec::new()))
    }

    /// The end of an interval at cuts: the least or the greatest of their factors, with all that happens there.
    fn end(&self, group: &[Cut], wanted: Ordering) -> End {
        let others = group[1..].iter().map(|c| c.factor.clone());
        let value = others.fold(group[0].factor.clone(), |known, factor| one_of(known, factor, wanted));
        let (mut causes, mut roots) = (Causes::default(), Vec::new());
        for cut in group {
            match &cut.what {
                Happening::Root(omega) => roots.push((omega.clone(), None)),
                Happening::Open(root) => roots.extend(root.clone().map(|(omega, side)| (omega, Some(side)))),
                Happening::Neutral => causes.insert(Cause::Neutral),
                Happening::Pole => causes.insert(Cause::Pole),
                Happening::Domain => causes.insert(Cause::Domain),
            }
        }
        let (at_rest, mut moving): (Vec<_>, Vec<_>) = roots.into_iter().partition(|(omega, _)| omega.sign().is_eq());
        if !at_rest.is_empty() {
            causes.insert(Cause::RootAtZero);
        }
        moving.sort_by_key(|(omega, _)| sizes(&within(omega, BITS_OF_FREQUENCY)));
        let pair = moving.into_iter().next().map(|(omega, side)| {
            let own = if omega.sign().is_lt() { Side::Lower } else { Side::Upper };
            let side = if self.is_signed { side.unwrap_or(own) } else { Side::Both };
            causes.insert(if side == Side::Both { Cause::ComplexPair } else { Cause::ComplexRoot });
            let size = if own == Side::Lower { omega.negated() } else { omega };
            ComplexPair::at_angular_frequency(size).on_side(side)
        });
        End::new(value, causes, pair)
    }
}

/// Frequencies are enclosed with so many bits before they are compared; an answer names the lowest one.
const BITS_OF_FREQUENCY: u64 = 64;

/// The less or the greater of two numbers that enclosures do not tell apart.
fn one_of(a: Real, b: Real, wanted: Ordering) -> Real {
    if let (Some(x), Some(y)) = (a.exact(), b.exact()) {
        return if x.cmp(&y) == wanted { a } else { b };
    }
    match wanted {
        Ordering::Less => greater(a.negated(), b.negated()).negated(),
        _ => greater(a, b),
    }
}

/// A short rational number between two others.
pub(super) fn between(low: &Rational, high: &Rational, budget: &Budget) -> Result<Rational, Exhausted> {
    let found = rational_between(&Real::from(low.clone()), &Real::from(high.clone()), budget)?;
    Ok(found.expect("they are apart"))
}
