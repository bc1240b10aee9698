//! How far the stable points of slices reach together, and between which slices they begin and end.

use super::{Asked, BodySlice};
use crate::answer::MapLimit;
use crate::error::Error;
use crate::stability::RealInterval;
use crate::stability::plane::StableRegion;
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// An extreme value of a parameter over the slices.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Extreme {
    /// The value; `None` where a region is unbounded.
    pub value: Option<Real>,
    /// The numbers of the slices that reach it.
    pub slices: Vec<usize>,
    /// What limits the first of them there; `None` where that is not known, and of what is unbounded.
    pub limit: Option<MapLimit>,
}

/// The least and the greatest value of the two parameters of the slices.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Extremes {
    /// Of each parameter the least and the greatest.
    pub ends: [[Extreme; 2]; 2],
}

/// Slices with stable points that follow each other.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Stretch {
    /// The number of the first of them.
    pub first: usize,
    /// The number of the last of them.
    pub last: usize,
    /// What is known of either end in the third parameter.
    pub ends: [StretchEnd; 2],
}

/// Where a stretch ends.
#[derive(Clone, Debug)]
pub enum StretchEnd {
    /// With the slices that were asked for.
    Range,
    /// Beside a slice that the budget did not allow.
    Open,
    /// Between two values, both decided by exact maps.
    Between {
        /// Here there are stable points.
        stable: Rational,
        /// Here there are none.
        none: Rational,
        /// Why it was not narrowed as far as it was asked for.
        stopped: Option<Exhausted>,
    },
}

impl StretchEnd {
    /// Why it is not known as well as it was asked for.
    pub(super) fn stopped(&self) -> Option<&Exhausted> {
        match self {
            StretchEnd::Between { stopped, .. } => stopped.as_ref(),
            StretchEnd::Range | StretchEnd::Open => None,
        }
    }
}

/// Of several regions the least and the greatest value of either parameter.
pub(super) fn of_regions(regions: &[StableRegion]) -> Option<[RealInterval; 2]> {
    let hull = |parts: Vec<&RealInterval>| RealInterval {
        lower: outermost(parts.iter().map(|i| i.lower.as_ref()), Ordering::Less),
        upper: outermost(parts.iter().map(|i| i.upper.as_ref()), Ordering::Greater),
    };
    let of = |side: fn(&StableRegion) -> &RealInterval| hull(regions.iter().map(side).collect());
    (!regions.is_empty()).then(|| [of(|r| &r.x), of(|r| &r.y)])
}

/// The order of two ends; those that are the same to some thousand bits count as one.
fn order(a: &Real, b: &Real) -> Ordering {
    a.compare(b, &Budget::unlimited()).unwrap_or(Ordering::Equal)
}

/// The least or greatest end; `None` where one is infinite.
fn outermost<'a>(ends: impl Iterator<Item = Option<&'a Real>>, wanted: Ordering) -> Option<Real> {
    let all: Vec<&Real> = ends.collect::<Option<_>>()?;
    let further = |a: &'a Real, b: &'a Real| if order(b, a) == wanted { b } else { a };
    all.into_iter().reduce(further).cloned()
}

impl Extremes {
    /// Over the slices that are decided.
    pub(super) fn of(slices: &[BodySlice]) -> Option<Extremes> {
        let known: Vec<(usize, &[RealInterval; 2])> =
            slices.iter().enumerate().filter_map(|(k, s)| Some((k, s.extent.as_ref()?))).collect();
        if known.is_empty() {
            return None;
        }
        let extreme = |parameter: usize, side: usize| {
            let end = |extent: &[RealInterval; 2]| match side {
                0 => extent[parameter].lower.clone(),
                _ => extent[parameter].upper.clone(),
            };
            let ends: Vec<(usize, Option<Real>)> = known.iter().map(|(k, e)| (*k, end(e))).collect();
            let value = outermost(ends.iter().map(|e| e.1.as_ref()), [Ordering::Less, Ordering::Greater][side]);
            let reaches = |end: &Option<Real>| match (end, &value) {
                (None, None) => true,
                (Some(a), Some(b)) => order(a, b).is_eq(),
                _ => false,
            };
            let reached: Vec<usize> = ends.iter().filter(|(_, end)| reaches(end)).map(|(k, _)| *k).collect();
            let limit = value.as_ref().and_then(|value| limit_at(&slices[*reached.first()?], parameter, side, value));
            Extreme { value, slices: reached, limit }
        };
        Some(Extremes { ends: [0, 1].map(|parameter| [0, 1].map(|side| extreme(parameter, side))) })
    }
}

/// What limits the region of a slice that reaches a value.
fn limit_at(slice: &BodySlice, parameter: usize, side: usize, value: &Real) -> Option<MapLimit> {
    let limits = slice.map.as_ref().ok()?.value().limits();
    let ends = limits.iter().filter_map(|extent| extent.ends[parameter][side].as_ref());
    ends.into_iter().find(|end| order(&end.limit.value, value).is_eq()).cloned()
}

impl Asked<'_> {
    /// Where slices with stable points begin and end; the brackets of all ends are narrowed at once.
    pub(super) fn stretches(
        &self,
        slices: &[BodySlice],
        narrow: &Rational,
        told: &Budget,
    ) -> Result<Vec<Stretch>, Error> {
        let mut stretches: Vec<Stretch> = Vec::new();
        for number in (0..slices.len()).filter(|&k| slices[k].has_stable_points() == Some(true)) {
            match stretches.last_mut().filter(|stretch| stretch.last + 1 == number) {
                Some(stretch) => stretch.last = number,
                None => {
                    stretches.push(Stretch {
                        first: number,
                        last: number,
                        ends: [StretchEnd::Range, StretchEnd::Range],
                    });
                }
            }
        }
        told.step("brackets of the ends of stability");
        let sides: Vec<(usize, Option<usize>)> =
            stretches.iter().flat_map(|s| [(s.first, s.first.checked_sub(1)), (s.last, Some(s.last + 1))]).collect();
        let ends: Vec<Result<StretchEnd, Error>> = parallel_map(&sides, |(stable, beside)| {
            match beside.and_then(|k| slices.get(k)).map(|slice| (slice, slice.has_stable_points())) {
                None => Ok(StretchEnd::Range),
                Some((_, None)) => Ok(StretchEnd::Open),
                Some((none, _)) => self.narrowed(slices[*stable].value.clone(), none.value.clone(), narrow),
            }
        });
        let mut ends = ends.into_iter();
        for stretch in &mut stretches {
            for end in &mut stretch.ends {
                *end = ends.next().expect("each stretch has two ends")?;
            }
        }
        Ok(stretches)
    }

    /// The bracket of an end of stability: values between both are decided until they are near enough.
    fn narrowed(&self, mut stable: Rational, mut none: Rational, narrow: &Rational) -> Result<StretchEnd, Error> {
        loop {
            let width = (&none - &stable).abs();
            if width <= *narrow {
                return Ok(StretchEnd::Between { stable, none, stopped: None });
            }
            let between = near_the_middle(&stable, &none);
            match self.has_stable_points(&between) {
                Ok(true) => stable = between,
                Ok(false) => none = between,
                Err(failure) => {
                    let stopped = Some(failure.stopped()?);
                    return Ok(StretchEnd::Between { stable, none, stopped });
                }
            }
        }
    }
}

/// The shortest decimal in the middle quarter between two numbers.
fn near_the_middle(a: &Rational, b: &Rational) -> Rational {
    let (middle, eighth) = (a.midpoint(b), (b - a).abs() / Rational::from(8));
    let half = Rational::dyadic(&Integer::ONE, 1);
    let (mut unit, tenth) = (Rational::ONE, Rational::new(1.into(), 10.into()));
    loop {
        let rounded = Rational::from((&middle / &unit + &half).floor()) * &unit;
        if (&rounded - &middle).abs() < eighth {
            return rounded;
        }
        unit *= &tenth;
    }
}
