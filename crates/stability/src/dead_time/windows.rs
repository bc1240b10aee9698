//! All dead times for which a loop is stable.

use super::crossing::{Crossing, commensurate, crossings};
use super::mikhailov::{NotCounted, roots_right};
use super::{Kind, QuasiPolynomial};
use crate::precisions::ORDER_OF_DEAD_TIMES;
use crate::{Shape, count_roots};
use jurist_algebra::limits::{Budget, Exhausted, try_until_shown, until_shown};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::simplest_between;
use std::cell::RefCell;
use std::cmp::Ordering;
use std::sync::Arc;

/// Why no dead time at all lets the loop be stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Never {
    /// The function is zero.
    Zero,
    /// A root that does not depend on the dead time lies on the axis or to the right of it.
    FixedRoot,
    /// `s = 0` is a root for every dead time.
    RootAtZero,
    /// The highest power of `s` is delayed only: infinitely many roots lie far to the right.
    Advanced,
    /// The difference operator has a zero in the closed unit disc.
    Neutral,
}

/// A dead time at which roots are on the imaginary axis.
#[derive(Clone, Debug)]
pub struct Switch {
    /// The crossings that meet there, each with its number of turns; mostly one.
    pub members: Vec<(Arc<Crossing>, u64)>,
    /// How many roots are gained on the right.
    pub change: i64,
}

impl Switch {
    /// The dead time, with about `bits` significant bits.
    pub fn dead_time(&self, bits: u64) -> Enclosure {
        let (crossing, k) = &self.members[0];
        crossing.dead_time(*k, bits)
    }
}

/// How the dead times of an open range fall into cells of constant root count.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DelayCells {
    /// The switches between the cells, ascending.
    pub switches: Vec<Switch>,
    /// The number of roots to the right of the axis in each cell; one more than switches.
    pub right: Vec<usize>,
    /// Roots that touch the axis again and again for all dead times beyond the last switch listed: none of them is in the
    /// cells. Only with a range that has no upper end.
    pub touching_for_ever: bool,
}

/// The cells of all dead times between two bounds, `0 <= lower`; or why there is none in which the loop is stable.
///
/// Roots can be on the axis at the crossings only, each at `(theta + 2 pi k)/omega` for all
/// `k`, and move in one direction at all of them. From the roots of the loop without delay the count therefore follows by
/// addition. It grows, too: with the directions `d_j` the number of roots to the right is at least
/// `tau/pi sum d_j omega_j - 2 m` for `m` crossings, and the sum is positive where there is any crossing that is not a
/// touch, as it measures where a branch `|z_j(i omega)|` is below one. So the range that has to be looked at is finite
/// ([OlgacSipahi2002](jurist_algebra::bibliography#olgacsipahi2002)).
///
/// Cost: that of the crossings, an enclosure of each switch up to the bound, and where a direction does not show in a first
/// derivative, a count at two dead times beside it.
///
/// # Errors
/// [`NotCounted`]: the budget; a neutral loop in which a direction has to be counted.
pub fn delay_cells(
    p: &QuasiPolynomial,
    lower: &Rational,
    upper: Option<&Rational>,
    budget: &Budget,
) -> Result<Result<DelayCells, Never>, NotCounted> {
    assert!(!lower.is_negative(), "a dead time is not negative");
    budget.step("quasi-polynomial");
    if let Some(never) = budget.enter(|| never_stable(p))? {
        return Ok(Err(never));
    }
    let rest = budget.enter(|| p.primitive())?;
    if rest.delays() == 0 {
        return Ok(Ok(DelayCells { switches: Vec::new(), right: vec![0], touching_for_ever: false }));
    }
    let found: Vec<Arc<Crossing>> = crossings(&rest, budget)?.into_iter().map(Arc::new).collect();
    let line = Line { p: &rest, found: &found, budget };
    let motions = line.motions()?;
    let at_zero = line.right_of_zero(&motions)?;
    let bound = budget.enter(|| growth_bound(&found, &motions))?;
    let last = match (upper, &bound) {
        (Some(upper), Some(bound)) => Some(upper.min(bound).clone()),
        (Some(upper), None) => Some(upper.clone()),
        (None, Some(bound)) => Some(bound.clone()),
        (None, None) => None,
    };
    let touching_for_ever = last.is_none() && !found.is_empty();
    let last = last.unwrap_or_else(|| lower.clone());
    let mut right = at_zero as i64;
    let mut open = Vec::new();
    for (j, crossing) in found.iter().enumerate() {
        let first = u64::from(crossing.at_zero_delay());
        let before = budget.enter(|| turns_before(crossing, lower))?;
        right += 2 * motions[j] * (before.saturating_sub(first) as i64);
        let mut k = before.max(first);
        loop {
            budget.check()?;
            let place = budget.enter(|| crossing.dead_time(k, ORDER_OF_DEAD_TIMES.first))?;
            if *place.lower() >= last {
                break;
            }
            // Where the bound is an end of the range, a switch is on one side of it: it is not rational.
            if let Some(upper) = upper
                && budget.enter(|| is_beyond(crossing, k, upper))?
            {
                break;
            }
            open.push((j, k, place));
            k += 1;
        }
    }
    let switches = line.sorted(open, &motions)?;
    let mut counts = vec![right];
    for switch in &switches {
        counts.push(counts.last().expect("there is a first cell") + switch.change);
    }
    let right = counts.into_iter().map(|c| usize::try_from(c).expect("a count is not negative")).collect();
    Ok(Ok(DelayCells { switches, right, touching_for_ever }))
}

/// Why the loop is stable for no dead time other than zero, where that shows without looking for crossings.
fn never_stable(p: &QuasiPolynomial) -> Option<Never> {
    if p.without_delay().coeff(0).is_zero() {
        return Some(Never::RootAtZero);
    }
    let content = p.content();
    let fixed = count_roots(&content, Shape::LeftHalfPlane);
    if fixed.inside < fixed.total() {
        return Some(Never::FixedRoot);
    }
    match p.kind() {
        Kind::Advanced => Some(Never::Advanced),
        Kind::Neutral if !p.has_stable_difference() => Some(Never::Neutral),
        _ => None,
    }
}

/// How many of the crossing's dead times, counted from `k = 0` on, lie below a bound.
fn turns_before(crossing: &Crossing, bound: &Rational) -> u64 {
    if bound.is_zero() {
        return 0;
    }
    // k < (omega bound - theta)/(2 pi), which is no integer.
    until_shown(64, |bits| {
        let angle = crossing.omega(bits).mul(&Enclosure::from_rational(bound.clone()), bits);
        let turn = Enclosure::pi(bits).mul(&Enclosure::from_rational(Rational::from(2)), bits);
        let turns = angle.sub(&crossing.theta(bits), bits).div(&turn, bits).expect("pi is positive");
        let (low, high) = (turns.lower().ceil(), turns.upper().ceil());
        let count = || if low.is_negative() { 0 } else { low.to_i64().unwrap_or(i64::MAX) as u64 };
        (low == high).then(count)
    })
}

/// Whether a dead time, which is not rational, lies above a bound.
fn is_beyond(crossing: &Crossing, k: u64, bound: &Rational) -> bool {
    until_shown(ORDER_OF_DEAD_TIMES.first, |bits| {
        let place = crossing.dead_time(k, bits);
        let is_beyond = place.lower() >= bound;
        (is_beyond || place.upper() <= bound).then_some(is_beyond)
    })
}

/// A rational dead time beyond which roots lie to the right for good; `None` where no root ever crosses.
fn growth_bound(found: &[Arc<Crossing>], motions: &[i64]) -> Option<Rational> {
    if motions.iter().all(|&m| m == 0) {
        return None;
    }
    Some(until_shown(32, |bits| {
        let growth = found.iter().zip(motions).fold(Enclosure::from_rational(Rational::ZERO), |sum, (c, &m)| {
            sum.add(&c.omega(bits).mul(&Enclosure::from_rational(Rational::from(m)), bits), bits)
        });
        if !growth.lower().sign().is_gt() {
            return None;
        }
        let crossings: i64 = motions.iter().map(|m| m.abs()).sum();
        let turns = Enclosure::pi(bits).mul(&Enclosure::from_rational(Rational::from(2 * crossings)), bits);
        let bound = turns.div(&growth, bits).expect("positive");
        Some(bound.upper().clone())
    }))
}

struct Line<'a> {
    p: &'a QuasiPolynomial,
    found: &'a [Arc<Crossing>],
    budget: &'a Budget,
}

impl Line<'_> {
    /// By how many pairs the count of roots to the right grows at each of a crossing's dead times.
    fn motions(&self) -> Result<Vec<i64>, NotCounted> {
        self.found
            .iter()
            .enumerate()
            .map(|(j, crossing)| match crossing.motion() {
                Ordering::Greater => Ok(1),
                Ordering::Less => Ok(-1),
                Ordering::Equal => self.counted_motion(j),
            })
            .collect()
    }

    /// The same by counting on both sides of one of the dead times.
    fn counted_motion(&self, j: usize) -> Result<i64, NotCounted> {
        /// Turns that are tried until one is found at which nothing else happens.
        const TRIED: u64 = 8;
        let first = u64::from(self.found[j].at_zero_delay());
        for k in first..first + TRIED {
            let Some((below, above)) = self.budget.enter(|| self.neighbourhood(j, k))?? else { continue };
            let before = roots_right(self.p, &below, 0, self.budget)? as i64;
            let after = roots_right(self.p, &above, 0, self.budget)? as i64;
            return Ok((after - before) / 2);
        }
        let reached = "telling a touch of the axis from a crossing";
        Err(Exhausted::by_method(format!("{TRIED} dead times at which roots meet"), reached).into())
    }

    /// Rational dead times on both sides of one, with no other switch between; `None` where another one is equal to it.
    fn neighbourhood(&self, j: usize, k: u64) -> Result<Option<(Rational, Rational)>, Exhausted> {
        let crossing = &self.found[j];
        try_until_shown(ORDER_OF_DEAD_TIMES.first, |bits| {
            self.budget.check()?;
            let place = crossing.dead_time(k, bits);
            let (mut below, mut above) = (Rational::ZERO, place.upper() + place.upper() + Rational::ONE);
            let others = self.found.iter().enumerate().flat_map(|(i, other)| {
                let near = turns_before(other, place.lower());
                let from = near.saturating_sub(2).max(u64::from(other.at_zero_delay()));
                (from..near + 3).map(move |l| (i, l))
            });
            for (i, l) in others.filter(|&(i, l)| (i, l) != (j, k)) {
                let other = self.found[i].dead_time(l, bits);
                if other.upper() < place.lower() {
                    below = below.max(other.upper().clone());
                } else if other.lower() > place.upper() {
                    above = above.min(other.lower().clone());
                } else if self.meet((j, k), (i, l))? {
                    return Ok(Some(None));
                } else {
                    return Ok(None);
                }
            }
            let between = |lo: &Rational, hi: &Rational| simplest_between(lo, hi);
            // Rational points strictly between the neighbours and this one.
            Ok(between(&below, place.lower()).zip(between(place.upper(), &above)).map(Some))
        })
    }

    /// Whether two dead times are equal whose enclosures overlap.
    fn meet(&self, one: (usize, u64), two: (usize, u64)) -> Result<bool, Exhausted> {
        let (a, b) = (&self.found[one.0], &self.found[two.0]);
        // One root on the axis at one dead time has one z.
        if one.0 == two.0 || a.half_size_root().compare(b.half_size_root()).is_eq() {
            return Ok(false);
        }
        let common = commensurate(a, b, self.budget)?;
        ORDER_OF_DEAD_TIMES.decide("the order of two dead times with roots on the axis", |bits| {
            let (x, y) = (a.dead_time(one.1, bits), b.dead_time(two.1, bits));
            if x.upper() < y.lower() || y.upper() < x.lower() {
                return Ok(Some(false));
            }
            if let Some(Some(multiple)) = &common {
                // They differ by a multiple of 2 pi/(b omega), or not at all.
                let apart = (x.upper() - y.lower()).abs().max((y.upper() - x.lower()).abs());
                let scale = Rational::from(multiple) * a.omega(64).upper();
                if apart * scale < Rational::from(6) {
                    return Ok(Some(true));
                }
            }
            Ok(None)
        })
    }

    /// The roots to the right for small dead times.
    fn right_of_zero(&self, motions: &[i64]) -> Result<usize, NotCounted> {
        let count = self.budget.enter(|| count_roots(&self.p.without_delay(), Shape::LeftHalfPlane))?;
        let at_zero: Vec<usize> = (0..self.found.len()).filter(|&j| self.found[j].at_zero_delay()).collect();
        if at_zero.iter().any(|&j| self.found[j].motion().is_eq()) {
            // Where a root moves along the axis at first, or several move apart, it is counted a little later.
            let mut small = Rational::ONE;
            for crossing in self.found {
                let k = u64::from(crossing.at_zero_delay());
                small = small.min(crossing.dead_time(k, ORDER_OF_DEAD_TIMES.first).lower().clone());
            }
            let sample = simplest_between(&Rational::ZERO, &small).expect("dead times are positive");
            return roots_right(self.p, &sample, 0, self.budget);
        }
        let gained = at_zero.iter().filter(|&&j| motions[j] > 0).count();
        Ok(count.outside + 2 * gained)
    }

    /// The switches in ascending order, those that are equal taken together.
    fn sorted(&self, mut open: Vec<(usize, u64, Enclosure)>, motions: &[i64]) -> Result<Vec<Switch>, Exhausted> {
        let failed = RefCell::new(None);
        let order = |a: &(usize, u64, Enclosure), b: &(usize, u64, Enclosure)| {
            if (a.0, a.1) == (b.0, b.1) || failed.borrow().is_some() {
                return Ordering::Equal;
            }
            if a.2.upper() < b.2.lower() {
                return Ordering::Less;
            }
            if b.2.upper() < a.2.lower() {
                return Ordering::Greater;
            }
            match self
                .meet((a.0, a.1), (b.0, b.1))
                .and_then(|equal| if equal { Ok(Ordering::Equal) } else { self.budget.enter(|| self.told_apart(a, b)) })
            {
                Ok(order) => order,
                Err(exhausted) => {
                    *failed.borrow_mut() = Some(exhausted);
                    Ordering::Equal
                }
            }
        };
        open.sort_by(order);
        let mut switches: Vec<Switch> = Vec::new();
        let mut last: Option<&(usize, u64, Enclosure)> = None;
        for entry in &open {
            let member = (Arc::clone(&self.found[entry.0]), entry.1);
            let change = 2 * motions[entry.0];
            match switches.last_mut() {
                Some(switch) if last.is_some_and(|last| order(last, entry).is_eq()) => {
                    switch.members.push(member);
                    switch.change += change;
                }
                _ => switches.push(Switch { members: vec![member], change }),
            }
            last = Some(entry);
        }
        match failed.into_inner() {
            Some(exhausted) => Err(exhausted),
            None => Ok(switches),
        }
    }

    /// The order of two dead times that are known to differ.
    fn told_apart(&self, a: &(usize, u64, Enclosure), b: &(usize, u64, Enclosure)) -> Ordering {
        until_shown(2 * ORDER_OF_DEAD_TIMES.first, |bits| {
            let (x, y) = (self.found[a.0].dead_time(a.1, bits), self.found[b.0].dead_time(b.1, bits));
            match x.upper() < y.lower() {
                true => Some(Ordering::Less),
                false => (y.upper() < x.lower()).then_some(Ordering::Greater),
            }
        })
    }
}
