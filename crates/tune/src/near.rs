//! Gains near to a best value.

use crate::answer::Place;
use crate::lines::Lines;
use crate::one_gain::GAIN;
use crate::sets::{is_closed, outer, widest};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{RealAlgebraic, simplest_between};
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::response::{RequiredEnd, RequiredInterval, RequiredSet};
use std::cmp::Ordering;

/// What is near to a best value.
pub(crate) struct Near {
    /// A value that some gains have.
    pub height: Rational,
    /// Gains that have it.
    pub interval: RequiredInterval,
    /// The gain at the best value.
    pub place: Place,
}

/// An enclosure narrower than this, as a share, is of one gain.
const NARROW: i64 = 6;

impl Near {
    /// Whether one gain alone has the best value, known exactly or by an enclosure.
    pub fn is_point(&self) -> bool {
        match &self.place {
            Place::Exact(_) => true,
            Place::Between([low, high]) => is_narrow(low, high),
            Place::From(_) | Place::Unbounded => false,
        }
    }
}

/// Whether two numbers enclose one.
pub(crate) fn is_narrow(low: &Rational, high: &Rational) -> bool {
    let unit = Rational::from(10).pow(-NARROW).expect("ten is not zero");
    high - low <= low.abs().max(high.abs()) * unit
}

/// Whether the gain is in the set in which everything but the level is met: then it has the best value. `None` where the gain is not known exactly.
pub(crate) fn is_attained(lines: &Lines<'_>, place: &Place, plain: &RequiredSet) -> Result<Option<bool>, Error> {
    let Place::Exact(x) = place else { return Ok(None) };
    if let Some(value) = x.exact() {
        if plain.intervals.iter().any(|interval| interval.contains(&value)) {
            return Ok(Some(true));
        }
        // A bound that is given is included.
        let gain = &lines.asked.gains[GAIN];
        let is_bound = gain.bounds.iter().flatten().any(|bound| *bound == value);
        return Ok(Some(is_bound && lines.is_met(&[(gain.name.clone(), value)], None)?));
    }
    let is_inside = |end: &Option<RequiredEnd>, side: Ordering| -> Result<bool, Error> {
        let Some(end) = end else { return Ok(true) };
        let order = end.value().compare(x, lines.budget)?;
        Ok(order == side || (order.is_eq() && is_closed(end)))
    };
    for interval in &plain.intervals {
        if is_inside(&interval.lower, Ordering::Less)? && is_inside(&interval.upper, Ordering::Greater)? {
            return Ok(Some(true));
        }
    }
    Ok(Some(false))
}

/// So many digits of the best value are gone towards.
const DIGITS: [usize; 4] = [4, 10, 20, 40];

/// Goes towards a best value from inside: the gains that have values near to it, until one of the places at which a curve turns or meets another one is
/// left among them.
///
/// # Errors
/// As `Lines::set`.
pub(crate) fn approach(
    lines: &Lines<'_>,
    value: &Real,
    inside: &Rational,
    places: &[RealAlgebraic],
    set_at: &dyn Fn(&Rational) -> Result<RequiredSet, Error>,
) -> Result<Near, Error> {
    let mut last = None;
    for digits in DIGITS {
        lines.budget.step("gains near the best value");
        let height = toward(value, inside, digits);
        let set = set_at(&height)?;
        let Some(interval) = widest(&set) else { break };
        let (low, high) = outer(interval);
        let ends = [lines.range(0).lower.clone(), lines.range(0).upper.clone()];
        let is_in = |x: &RealAlgebraic| {
            low.as_ref().is_none_or(|low| x.compare_rational(low).is_ge())
                && high.as_ref().is_none_or(|high| x.compare_rational(high).is_le())
        };
        let candidates: Vec<RealAlgebraic> = lines.budget.enter(|| {
            let ends = ends.into_iter().flatten().map(RealAlgebraic::from_rational);
            places.iter().cloned().chain(ends).filter(is_in).collect()
        })?;
        let place = match (&candidates[..], &low, &high) {
            ([one], Some(low), Some(high)) if (high - low).abs() < width_for(digits, one) => {
                Place::Exact(one.clone().into())
            }
            (_, Some(low), Some(high)) => Place::Between([low.clone(), high.clone()]),
            _ => Place::Unbounded,
        };
        let is_exact = matches!(place, Place::Exact(_));
        last = Some(Near { height, interval: interval.clone(), place });
        if is_exact {
            break;
        }
    }
    Ok(last.expect("what is inside is met"))
}

/// Gains near a smooth optimum are as far apart as the square root of what is lost.
fn width_for(digits: usize, place: &RealAlgebraic) -> Rational {
    let unit = Rational::from(10).pow(-(digits as i64) / 4).expect("ten is not zero");
    let (low, high) = place.enclosure();
    let size = low.abs().max(high.abs());
    if size.is_zero() { unit } else { size * unit }
}

/// A rational number between a value inside and the best one, near to the latter by so many digits.
pub(crate) fn toward(value: &Real, inside: &Rational, digits: usize) -> Rational {
    let (low, high) = value.refined_to_digits(digits + 4).enclosure();
    let share = Rational::from(10).pow(-(digits as i64)).expect("ten is not zero");
    let inner = if *inside < low { &low } else { &high };
    let step = (inner - inside) * &share;
    let nearest = inner - step;
    // Few digits, strictly between.
    let half = Rational::new(1.into(), 2.into());
    let middle = (&nearest + inner) * half;
    let (a, b) = if nearest < middle { (&nearest, &middle) } else { (&middle, &nearest) };
    simplest_between(a, b).unwrap_or(nearest)
}
