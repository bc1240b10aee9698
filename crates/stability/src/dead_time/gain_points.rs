//! The values of a gain at which a loop with a fixed dead time has roots on the imaginary axis.

use super::gain::{GainLoop, NotSolved};
use super::gain_axis::{Axis, Fixture, Forms, Frequency, GainAt, algebraic_frequencies};
use super::gain_bounds::Neutral;
use super::gain_inverse::reciprocal;
use super::strip::frequency_bound_over;
use super::trigonometric::{Jet, Zeros};
use super::windows::Never;
use crate::Range;
use jurist_algebra::limits::{Budget, Exhausted, try_until_shown};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::RealAlgebraic;
use jurist_algebra::real::{Real, Transcendental};
use std::sync::Arc;

/// What happens at a value of the parameter.
#[derive(Clone, Debug)]
pub enum Happening {
    /// A root at `s = 0`.
    RootAtZero,
    /// A pair at `+-i omega`.
    Pair(Real),
    /// The difference operator has a zero on the unit circle, or loses a degree.
    Neutral,
    /// The highest power of `s` vanishes.
    DegreeLost,
    /// The loop is undefined.
    Pole,
    /// More than one of them.
    Several(Vec<Happening>),
}

/// A value of the parameter at which roots may cross the axis.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GainPoint {
    /// The value.
    pub value: Real,
    /// What happens there.
    pub happening: Happening,
    /// By how much the number of roots to the right grows there; `None` where it has to be counted.
    pub change: Option<i64>,
    /// The reciprocal of the value, where it is at hand.
    pub(super) inverse: Option<Real>,
}

impl GainPoint {
    /// A value beside which the roots have to be counted.
    pub(super) fn counted(value: Real, happening: Happening) -> GainPoint {
        GainPoint { value, happening, change: None, inverse: None }
    }

    /// The same for an algebraic value, with its reciprocal.
    pub(super) fn algebraic(
        value: RealAlgebraic,
        happening: Happening,
        budget: &Budget,
    ) -> Result<GainPoint, Exhausted> {
        let value = Real::from(value);
        let is_zero = value.exact().is_some_and(|x| x.is_zero());
        let inverse = if is_zero { None } else { Some(reciprocal(&value, budget)?) };
        Ok(GainPoint { value, happening, change: None, inverse })
    }

    /// Takes in what else happens at the same value.
    pub(super) fn join(&mut self, other: GainPoint) {
        self.change = self.change.zip(other.change).map(|(x, y)| x + y);
        let list = |h: Happening| match h {
            Happening::Several(list) => list,
            one => vec![one],
        };
        let mut all = list(std::mem::replace(&mut self.happening, Happening::Neutral));
        all.extend(list(other.happening));
        self.happening = Happening::Several(all);
    }
}

/// The parts of the range in which the loop is known not to be stable without looking further.
#[derive(Clone, Debug, Default)]
pub(super) struct Beyond {
    /// At this value and below.
    below: Option<Real>,
    /// At this value and above.
    above: Option<Real>,
}

impl Beyond {
    /// Whether a cell lies in one of them.
    pub fn covers(&self, lower: Option<&Real>, upper: Option<&Real>, budget: &Budget) -> Result<bool, Exhausted> {
        if let (Some(bound), Some(lower)) = (&self.above, lower)
            && lower.compare(bound, budget)?.is_ge()
        {
            return Ok(true);
        }
        if let (Some(bound), Some(upper)) = (&self.below, upper)
            && upper.compare(bound, budget)?.is_le()
        {
            return Ok(true);
        }
        Ok(false)
    }
}

type Found = Result<(Vec<GainPoint>, Beyond), Never>;

/// All values in the range with a pair on the axis, up to where the loop is unstable for good.
pub(super) fn crossings_of_gain(
    gain: &GainLoop,
    range: &Range,
    others: &[GainPoint],
    budget: &Budget,
) -> Result<Found, NotSolved> {
    let axis = Axis::new(gain);
    if axis.trace.is_empty() {
        // Im(A conj B) vanishes identically: the parameter is real on the whole axis.
        return Err(NotSolved::Coincidence);
    }
    let Forms { content, finite, other } = budget.enter(|| axis.forms())?;
    let fixed = algebraic_frequencies(&content, budget)?;
    let points = match at_fixed_frequencies(&axis, &fixed, range, budget)? {
        Ok(points) => points,
        Err(never) => return Ok(Err(never)),
    };
    let axis = Arc::new(axis);
    let Some(form) = finite else { return Ok(Ok((points, Beyond::default()))) };
    let other = other.map(Jet::new);
    let mut walk = Walk { zeros: Zeros::new(form), axis: &axis, fixed: &fixed, other: other.as_ref(), points, budget };
    if let (Some(low), Some(high)) = (&range.lower, &range.upper)
        && let Some(limit) = gain.frequency_bound(&low.abs().max(high.abs()))
    {
        return walk.all_within(&limit, range, Beyond::default());
    }
    let weights = vec![Rational::ONE; gain.a.len()];
    if let Some(limit) = frequency_bound_over(&gain.coefficients(), &[], &weights, range, budget)? {
        return walk.all_within(&limit, range, Beyond::default());
    }
    let Some(turns) = gain.single_delay() else { return Err(NotSolved::Unbounded) };
    let Some(growing) = gain.growing_beyond(turns, None) else { return Err(NotSolved::Neutral) };
    let (from, largest) = match gain.neutral_bound(turns) {
        None => (growing, None),
        Some(Neutral { approached: false, limit, largest }) => {
            // Beyond the limit no value below the largest one puts a root on the axis.
            return walk.all_within(&limit, &range_within(range, &largest), Beyond::default());
        }
        Some(Neutral { limit, largest, .. }) => (growing.max(limit), Some(largest)),
    };
    let inner = largest.as_ref().map_or_else(|| range.clone(), |largest| range_within(range, largest));
    let beyond = walk.first_beyond(&from, &inner, largest.as_ref(), others)?;
    // All values up to the ends that were found, or that the range has.
    let limit = try_until_shown(16, |bits| {
        budget.check()?;
        let width = Rational::dyadic(&Integer::ONE, bits);
        let ends = [&beyond.below, &beyond.above].into_iter().flatten().map(|end| {
            let (lo, hi) = end.refined(&width).enclosure();
            lo.abs().max(hi.abs())
        });
        let own = [&inner.lower, &inner.upper].into_iter().flatten().map(Rational::abs);
        let own = own.filter(|x| largest.as_ref().is_none_or(|l| x < l));
        let greatest = ends.chain(own).max().unwrap_or(Rational::ZERO);
        Ok::<_, Exhausted>(gain.frequency_bound(&greatest))
    })?;
    walk.all_within(&limit, &inner, beyond)
}

/// The values for which a pair is on the axis at a frequency where `Im(A conj B)` vanishes: only 0.
fn at_fixed_frequencies(
    axis: &Axis,
    fixed: &[RealAlgebraic],
    range: &Range,
    budget: &Budget,
) -> Result<Result<Vec<GainPoint>, Never>, NotSolved> {
    let mut points = Vec::new();
    for omega in fixed.iter().cloned() {
        match axis.fixed_frequency(&omega, budget)? {
            Fixture::Never => return Ok(Err(Never::FixedRoot)),
            Fixture::NoGain => {}
            Fixture::Zero(change) if range.contains(&Rational::ZERO) => points.push(GainPoint {
                value: Rational::ZERO.into(),
                happening: Happening::Pair(Real::from(omega)),
                change: Some(change),
                inverse: None,
            }),
            Fixture::Zero(_) => {}
            Fixture::Unknown => return Err(NotSolved::Coincidence),
        }
    }
    Ok(Ok(points))
}

/// The part of a range between two numbers of opposite sign.
fn range_within(range: &Range, largest: &Rational) -> Range {
    let lower = range.lower.clone().map_or(-largest, |l| l.max(-largest));
    let upper = range.upper.clone().map_or(largest.clone(), |u| u.min(largest.clone()));
    Range { lower: Some(lower), upper: Some(upper) }
}

/// The points in a range that lie not beyond.
fn within(
    points: Vec<GainPoint>,
    range: &Range,
    beyond: &Beyond,
    budget: &Budget,
) -> Result<Vec<GainPoint>, Exhausted> {
    let mut out = Vec::with_capacity(points.len());
    for point in points {
        let inside = budget.enter(|| {
            range.lower.as_ref().is_none_or(|l| point.value.compare_rational(l).is_gt())
                && range.upper.as_ref().is_none_or(|u| point.value.compare_rational(u).is_lt())
        })?;
        if !inside {
            continue;
        }
        let beside = |end: &Option<Real>| end.as_ref().map(|end| point.value.compare(end, budget)).transpose();
        let (below, above) = (beside(&beyond.below)?, beside(&beyond.above)?);
        if below.is_none_or(|side| side.is_ge()) && above.is_none_or(|side| side.is_le()) {
            out.push(point);
        }
    }
    Ok(out)
}

/// Goes along the axis and notes the values.
struct Walk<'a> {
    zeros: Zeros,
    axis: &'a Arc<Axis>,
    /// Algebraic frequencies at which `Im(A conj B)` vanishes, too.
    fixed: &'a [RealAlgebraic],
    /// Vanishes where `A` or `B` does with a factor that is its own mirror image.
    other: Option<&'a Jet>,
    points: Vec<GainPoint>,
    budget: &'a Budget,
}

impl Walk<'_> {
    fn up_to(&mut self, limit: &Rational) -> Result<(), Exhausted> {
        self.budget.step("crossings of the imaginary axis");
        while let Some(zero) = self.zeros.next_below(limit, self.budget)? {
            let change = self.budget.enter(|| self.axis.change(&zero, self.fixed, self.other))?;
            let zero = Arc::new(zero);
            let value = GainAt { axis: Arc::clone(self.axis), zero: Arc::clone(&zero) };
            let value = Real::from(Transcendental::new(value));
            let omega = Real::from(Transcendental::new(Frequency { zero }));
            self.points.push(GainPoint {
                value,
                happening: Happening::Pair(omega),
                change: Some(change),
                inverse: None,
            });
        }
        Ok(())
    }

    /// The values up to a frequency that are in a range and not beyond.
    fn all_within(mut self, limit: &Rational, range: &Range, beyond: Beyond) -> Result<Found, NotSolved> {
        self.up_to(limit)?;
        Ok(Ok((within(self.points, range, &beyond, self.budget)?, beyond)))
    }

    /// The first values beyond a frequency, on either side where the range has no end of its own there, that are larger than
    /// all that belong to lower frequencies and to `s = 0`: from there on roots only go right.
    fn first_beyond(
        &mut self,
        from: &Rational,
        range: &Range,
        largest: Option<&Rational>,
        others: &[GainPoint],
    ) -> Result<Beyond, Exhausted> {
        self.up_to(from)?;
        let width = Rational::dyadic(&Integer::ONE, 64);
        let mut top = Rational::ZERO;
        let real_root = others.iter().filter(|p| matches!(p.happening, Happening::RootAtZero));
        for point in self.points.iter().chain(real_root) {
            let (lo, hi) = self.budget.enter(|| point.value.refined(&width).enclosure())?;
            let modulus = lo.abs().max(hi.abs());
            if largest.is_none_or(|l| modulus < *l) {
                top = top.max(modulus);
            }
        }
        let ends_here = |end: &Option<Rational>| match (end, largest) {
            (Some(end), Some(largest)) => end.abs() < *largest,
            (end, None) => end.is_some(),
            _ => false,
        };
        let (mut upper, mut lower) = (ends_here(&range.upper), ends_here(&range.lower));
        let mut beyond = Beyond::default();
        let mut limit = from.clone();
        while !upper || !lower {
            self.budget.check()?;
            let known = self.points.len();
            limit = &limit + &limit;
            self.up_to(&limit)?;
            for point in &self.points[known..] {
                if !upper && self.budget.enter(|| point.value.compare_rational(&top).is_gt())? {
                    beyond.above = Some(point.value.clone());
                    upper = true;
                }
                if !lower && self.budget.enter(|| point.value.compare_rational(&-&top).is_lt())? {
                    beyond.below = Some(point.value.clone());
                    lower = true;
                }
            }
        }
        Ok(beyond)
    }
}
