//! Answers about loops with dead time.

use super::verdict::PointVerdict;
use crate::error::Error;
use crate::problem::{BaseDelay, DelayedLoop, Problem, refused};
use crate::stability::dead_time::{
    Crossing, DelayCells, FamilyLoop, GainCells, GainLoop, GainPoint, Happening, NotCounted, NotSolved, Switch,
    count_delayed_roots, delay_cells, family_cells, gain_cells,
};
use crate::stability::line::{Common, Held, Line, Place, Ring};
use crate::stability::{
    Cause, Causes, ComplexPair, End, HalfSizePair, Range, RealInterval, Shape, StableSet, zeros_in,
};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Domain, UniPoly};
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};
use std::cmp::Ordering;
use std::sync::Arc;

/// The verdict at a point.
pub(super) fn verdict(problem: &Problem, delayed: &DelayedLoop, budget: &Budget) -> Result<PointVerdict, Error> {
    let degree = problem.algebra_over_symbols(budget)?.formal_degree();
    let count = match delayed.family() {
        Some(family) => family.count(&Rational::ZERO, budget).map_err(not_counted)?,
        None => None,
    };
    let Some(count) = count else {
        return Ok(PointVerdict::with_dead_time(degree, 0, None));
    };
    Ok(PointVerdict::with_dead_time(degree, count.on, count.right))
}

fn not_counted(reason: NotCounted) -> Error {
    match reason {
        NotCounted::Stopped(exhausted) => exhausted.into(),
        NotCounted::Neutral => undecided("its difference operator is too large for the bounds known"),
    }
}

fn undecided(why: &str) -> Error {
    Exhausted::by_method(format!("what is known of loops of neutral type: {why}"), "counting roots").into()
}

/// The stable set of the free parameter.
pub(super) fn stable_set(problem: &Problem, delayed: &DelayedLoop, budget: &Budget) -> Result<StableSet, Error> {
    let set = with_positive_dead_time(problem, delayed, budget)?;
    // Where the dead time is zero nothing is beside: what holds for small ones need not hold there.
    let BaseDelay::Line { slope, offset } = delayed.delay() else { return Ok(set) };
    let zero = -offset / slope;
    let is_pole = delayed.poles().iter().any(|pole| pole.sign_at(&zero).is_eq());
    if delayed.is_rational() || is_pole || !problem.parameter().domain.contains(&zero) {
        return Ok(set);
    }
    let Some(family) = delayed.family() else { return Ok(set) };
    // The degree is to be that of all other dead times.
    if family.at(&zero).is_none_or(|p| p.without_delay().degree() != Some(family.order())) {
        return Ok(set);
    }
    match family.count(&zero, budget).map_err(not_counted)? {
        Some(count) if count.is_stable() => Ok(set.with_value(End::new(zero, Cause::Domain.into(), None))),
        _ => Ok(set),
    }
}

/// The values at which no dead time is zero.
fn with_positive_dead_time(problem: &Problem, delayed: &DelayedLoop, budget: &Budget) -> Result<StableSet, Error> {
    let domain = &problem.parameter().domain;
    if delayed.is_rational() {
        return Ok(crate::stability::stable_set(&delayed.polynomial(), domain, Shape::LeftHalfPlane, budget)?);
    }
    let from_the_axis = delayed.decay().is_zero();
    match delayed.delay() {
        BaseDelay::Line { slope, offset } if from_the_axis && delayed.degree_in_parameter() == 0 => {
            windows(delayed, domain, slope, offset, budget)
        }
        BaseDelay::Line { slope, offset } => {
            // A dead time is not negative, whatever the domain says.
            let zero = -offset / slope;
            let Range { mut lower, mut upper } = domain.clone();
            match slope.sign().is_gt() {
                true => lower = Some(lower.map_or(zero.clone(), |lower| lower.max(zero))),
                false => upper = Some(upper.map_or(zero.clone(), |upper| upper.min(zero))),
            }
            let domain = Range { lower, upper };
            anywhere(problem, delayed, &domain, budget)
        }
        BaseDelay::Number(_) => match delayed.gain_loop().filter(|_| from_the_axis) {
            Some(gain) => gains(problem, delayed, &gain, domain, budget),
            None => anywhere(problem, delayed, domain, budget),
        },
    }
}

/// A parameter that enters in more than one way, or the decay rate.
fn anywhere(problem: &Problem, delayed: &DelayedLoop, domain: &Range, budget: &Budget) -> Result<StableSet, Error> {
    let Some(family) = delayed.family().filter(|_| !domain.is_empty()) else {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    };
    match family_cells(&family, domain, budget) {
        Ok(Ok(cells)) => assembled(delayed.poles(), &family, !delayed.decay().is_zero(), cells, domain, budget),
        Ok(Err(_)) => Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        Err(NotSolved::Unbounded) => {
            let name = &problem.parameter().name;
            let message = format!("roots can be on the boundary at frequencies without end in the domain of '{name}'");
            let help = format!(
                "give the domain both ends, away from where the highest power of s vanishes: --domain {name}=LO..HI"
            );
            Err(refused(message, help))
        }
        Err(reason) => Err(not_solved(reason)),
    }
}

fn not_solved(reason: NotSolved) -> Error {
    let why = match reason {
        NotSolved::NotCounted(reason) => return not_counted(reason),
        NotSolved::Neutral => return undecided("the difference operator depends on the parameter, or is too large"),
        NotSolved::Unbounded => "infinitely many values with roots on the boundary",
        NotSolved::Coincidence => "roots stay on the boundary, meet there, or only touch it",
    };
    Exhausted::by_method(format!("what is known of such loops: {why}"), "crossings of the imaginary axis").into()
}

/// The dead time `(theta + 2 pi k)/omega` as a value of the parameter, `(tau - offset)/slope`.
#[derive(Debug)]
struct SwitchTime {
    crossing: Arc<Crossing>,
    turns: u64,
    slope: Rational,
    offset: Rational,
}

impl Enclosing for SwitchTime {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let goal = Rational::dyadic(&1.into(), bits);
        let mut working = bits + 32;
        loop {
            let tau = self.crossing.dead_time(self.turns, working);
            let at = |x: &Rational| (x - &self.offset) / &self.slope;
            let (mut lo, mut hi) = (at(tau.lower()), at(tau.upper()));
            if self.slope.is_negative() {
                (lo, hi) = (hi, lo);
            }
            if &hi - &lo <= goal {
                return Enclosure::new(lo, hi);
            }
            working += working / 2;
        }
    }

    fn origin(&self) -> Origin {
        Origin::Crossing {
            omega_squared: self.crossing.omega_squared(),
            theta: self.crossing.theta(64),
            turns: self.turns,
            // As the parameter grows.
            leaves: match self.crossing.motion() {
                Ordering::Equal => None,
                motion => Some(motion.is_gt() != self.slope.is_negative()),
            },
        }
    }
}

/// Adds the roots of a polynomial on the imaginary axis to what happens at an end: `s = 0`, and the pair of lowest
/// frequency.
fn note_axis(end: &mut End, p: &UniPoly, budget: &Budget) -> Result<(), Exhausted> {
    if p.is_constant() {
        return Ok(());
    }
    if p.coeff(0).is_zero() {
        end.causes.insert(Cause::RootAtZero);
    }
    let pair = HalfSizePair::new(p, p.degree().unwrap_or(1), Shape::LeftHalfPlane);
    let common = budget.enter(|| pair.a.gcd(&pair.b))?;
    let below_zero = Range { lower: None, upper: Some(Rational::ZERO) };
    if let Some(lowest) = zeros_in(&common, &below_zero, budget)?.pop() {
        end.causes.insert(Cause::ComplexPair);
        end.pair = Some(ComplexPair::at_half_size_root(Shape::LeftHalfPlane, Real::from(lowest)));
    }
    Ok(())
}

/// The end of the domain of a parameter, with the roots that are on the axis there.
fn domain_end_of_loop(family: &FamilyLoop, value: &Rational, decay: bool, budget: &Budget) -> Result<End, Exhausted> {
    let mut end = End::new(value.clone(), Causes::default(), None);
    let Some(p) = family.at(value).filter(|_| !decay) else { return Ok(end) };
    if family.dead_time(value).is_zero() {
        note_axis(&mut end, &p.without_delay(), budget)?;
        return Ok(end);
    }
    note_axis(&mut end, &p.content(), budget)?;
    if p.without_delay().coeff(0).is_zero() {
        end.causes.insert(Cause::RootAtZero);
    }
    if p.order() < family.order() {
        end.causes.insert(Cause::DegreeLost);
    } else if !budget.enter(|| p.has_stable_difference())? {
        end.causes.insert(Cause::Neutral);
    }
    Ok(end)
}

/// A dead time that is free: all its windows, ascending in the parameter, in which it may fall.
fn windows(
    delayed: &DelayedLoop,
    domain: &Range,
    slope: &Rational,
    offset: &Rational,
    budget: &Budget,
) -> Result<StableSet, Error> {
    let Some(p) = delayed.quasi_polynomial() else { return Ok(StableSet::default()) };
    // A dead time is not negative, whatever the domain says.
    let to_tau = |x: &Rational| x * slope + offset;
    let falls = slope.is_negative();
    let (near, far) = if falls { (&domain.upper, &domain.lower) } else { (&domain.lower, &domain.upper) };
    let zero = Rational::ZERO;
    let lower = near.as_ref().map_or(zero.clone(), |x| to_tau(x).max(zero));
    let upper = far.as_ref().map(to_tau);
    if upper.as_ref().is_some_and(|upper| *upper <= lower) {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    }
    let cells = match delay_cells(&p, &lower, upper.as_ref(), budget).map_err(not_counted)? {
        Ok(cells) => cells,
        Err(_) => return Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
    };
    let DelayCells { switches, right, touching_for_ever, .. } = &cells;
    if *touching_for_ever && right.last() == Some(&0) {
        let message = "roots touch the imaginary axis at infinitely many dead times, and cross it nowhere";
        return Err(refused(
            message,
            "give the domain two ends, --domain NAME=0..10: the touches between them are listed",
        ));
    }
    let to_parameter = |tau: &Rational| (tau - offset) / slope;
    let mut first = End::new(to_parameter(&lower), Causes::default(), None);
    if lower.is_zero() {
        note_axis(&mut first, &p.without_delay(), budget)?;
    }
    let end = |switch: &Switch| {
        let (crossing, turns) = &switch.members[0];
        let time =
            SwitchTime { crossing: Arc::clone(crossing), turns: *turns, slope: slope.clone(), offset: offset.clone() };
        let lowest = switch.members.iter().map(|(c, _)| c).max_by(|a, b| a.half_size_root().cmp(b.half_size_root()));
        let pair = lowest
            .map(|c| ComplexPair::at_half_size_root(Shape::LeftHalfPlane, Real::from(c.half_size_root().clone())));
        End::new(Transcendental::new(time), Cause::ComplexPair.into(), pair)
    };
    let mut ends: Vec<End> = switches.iter().map(end).collect();
    let mut stable: Vec<bool> = right.iter().map(|&count| count == 0).collect();
    let mut range = Range::between(first.value.exact(), upper.as_ref().map(to_parameter));
    if falls {
        ends.reverse();
        stable.reverse();
        std::mem::swap(&mut range.lower, &mut range.upper);
    }
    Ok(Counted { ends, stable, bounds: vec![first] }.stable_set(&range, budget)?)
}

/// What cuts the line of a loop with dead time, where the roots in each cell are counted.
struct Counted {
    /// What happens between the cells, ascending.
    ends: Vec<End>,
    /// True for each cell in which the loop is stable.
    stable: Vec<bool>,
    /// What happens at the ends of the domain.
    bounds: Vec<End>,
}

impl Counted {
    fn stable_set(&self, range: &Range, budget: &Budget) -> Result<StableSet, Exhausted> {
        let zeros = self.ends.iter().map(|end| end.value.clone()).collect();
        Line::new(range, zeros, self, budget).stable_set()
    }

    fn at(&self, place: Place<'_>) -> Option<&End> {
        match place.zero {
            Some(zero) => self.ends.get(zero),
            None => self.bounds.iter().find(|end| end.value.is_same(place.value)),
        }
    }
}

impl Ring for Counted {
    fn is_stable(&self, below: usize, _cell: &RealInterval) -> Result<(Option<Rational>, bool), Exhausted> {
        Ok((None, self.stable[below]))
    }

    fn held(&self, place: Place<'_>) -> Result<Held, Exhausted> {
        let causes = self.at(place).map_or_else(Vec::new, |end| end.causes.iter().collect());
        Ok(Held { causes, has_roots: true })
    }

    fn common_roots(&self, place: Place<'_>) -> Result<Common, Exhausted> {
        Ok(self.at(place).and_then(|end| end.pair.clone()).map_or(Common::Beyond, Common::Pair))
    }
}

/// A parameter at a fixed dead time.
fn gains(
    problem: &Problem,
    delayed: &DelayedLoop,
    gain: &GainLoop,
    domain: &Range,
    budget: &Budget,
) -> Result<StableSet, Error> {
    if delayed.degree_in_parameter() == 0 {
        // The parameter is in poles at most: one count for all values.
        let BaseDelay::Number(tau) = delayed.delay() else { unreachable!("a fixed dead time") };
        let p = delayed.quasi_polynomial();
        let stable = match p {
            Some(p) => count_delayed_roots(&p, tau, budget).map_err(not_counted)?.is_stable(),
            None => false,
        };
        let cells = GainCells::constant(stable);
        return match delayed.family() {
            Some(family) => assembled(delayed.poles(), &family, !delayed.decay().is_zero(), cells, domain, budget),
            None => Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        };
    }
    let first = match gain_cells(gain, domain, budget) {
        Ok(Ok(cells)) => {
            let family = delayed.family().expect("the parameter enters");
            return assembled(delayed.poles(), &family, !delayed.decay().is_zero(), cells, domain, budget);
        }
        Ok(Err(_)) => return Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        Err(NotSolved::NotCounted(reason)) => return Err(not_counted(reason)),
        Err(reason) => reason,
    };
    // What is special about an affine parameter does not help: as any other.
    match anywhere(problem, delayed, domain, budget) {
        Err(Error::Refused(_)) => {}
        Err(Error::Stopped(_)) if budget.check().is_ok() => {}
        other => return other,
    }
    match first {
        NotSolved::Unbounded => {
            let name = &problem.parameter().name;
            let message =
                format!("'{name}' enters in several terms with different dead times, and its domain has no end");
            Err(refused(message, format!("give the domain both ends: --domain {name}=LO..HI")))
        }
        reason => Err(not_solved(reason)),
    }
}

/// The stable factors `k` of `D0 + k N exp(-tau s)`.
pub(crate) fn stable_factors(gain: &GainLoop, budget: &Budget) -> Result<StableSet, Error> {
    match gain_cells(gain, &Range::all(), budget) {
        Ok(Ok(cells)) => assembled(&[], &gain.family(), false, cells, &Range::all(), budget),
        Ok(Err(_)) => Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        Err(NotSolved::NotCounted(reason)) => Err(not_counted(reason)),
        Err(_) => Err(undecided("the factors of the open loop have no end")),
    }
}

/// The cells cut at the poles as well, with their causes.
fn assembled(
    poles: &[UniPoly],
    family: &FamilyLoop,
    decay: bool,
    mut cells: GainCells,
    domain: &Range,
    budget: &Budget,
) -> Result<StableSet, Error> {
    let mut bounds = Vec::new();
    for value in [&domain.lower, &domain.upper].into_iter().flatten() {
        let mut end = domain_end_of_loop(family, value, decay, budget)?;
        if poles.iter().any(|pole| pole.sign_at(value).is_eq()) {
            end.causes.insert(Cause::Pole);
        }
        bounds.push(end);
    }
    let end = |point: &GainPoint| {
        let (mut causes, mut pair) = (Causes::default(), None);
        note(&point.happening, &mut causes, &mut pair, budget);
        End::new(point.value.clone(), causes, pair.map(ComplexPair::at_angular_frequency))
    };
    cells.cut_at_poles(poles, domain, budget)?;
    let ends = cells.points.iter().map(end).collect();
    let stable = cells.right.iter().map(|count| *count == Some(0)).collect();
    Ok(Counted { ends, stable, bounds }.stable_set(domain, budget)?)
}

/// The causes, and the lowest frequency of the pairs.
fn note(happening: &Happening, causes: &mut Causes, pair: &mut Option<Real>, budget: &Budget) {
    match happening {
        Happening::RootAtZero => causes.insert(Cause::RootAtZero),
        Happening::Neutral => causes.insert(Cause::Neutral),
        Happening::DegreeLost => causes.insert(Cause::DegreeLost),
        Happening::Pole => causes.insert(Cause::Pole),
        Happening::Pair(omega) => {
            causes.insert(Cause::ComplexPair);
            let lower = pair.as_ref().is_none_or(|known| omega.compare(known, budget).is_ok_and(Ordering::is_lt));
            if lower {
                *pair = Some(omega.clone());
            }
        }
        Happening::Several(all) => all.iter().for_each(|one| note(one, causes, pair, budget)),
    }
}

#[cfg(test)]
mod tests;
