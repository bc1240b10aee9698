//! Answers about loops with dead time.

use super::verdict::PointVerdict;
use crate::error::Error;
use crate::problem::{BaseDelay, DelayedFunctions, DelayedLoop, Free, Problem, refused};
use crate::stability::dead_time::{
    FamilyLoop, GainCells, GainLoop, Line, Never, NotCounted, NotSolved, count_delayed_roots, delay_cells,
    family_cells, gain_cells,
};
use crate::stability::{Cause, End, Range, Shape, StableSet, UndecidedBracket};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;

/// The verdict at a point.
pub(super) fn verdict(problem: &Problem, delayed: &DelayedLoop, budget: &Budget) -> Result<PointVerdict, Error> {
    let algebra = problem.algebra_over_symbols(budget)?;
    let counted = |on, right| {
        PointVerdict::with_dead_time(algebra.formal_degree(), on, right).without_conjugates_if(algebra.is_complex())
    };
    let count = delayed.family().map(|family| family.count(&Rational::ZERO, budget).map_err(not_counted));
    let Some(count) = count.transpose()?.flatten() else { return Ok(counted(0, None)) };
    Ok(counted(count.on, count.right))
}

pub(super) fn not_counted(reason: NotCounted) -> Error {
    match reason {
        NotCounted::Stopped(exhausted) => exhausted.into(),
        NotCounted::Neutral => undecided("its difference operator is too large for the bounds known"),
    }
}

fn undecided(why: &str) -> Error {
    Exhausted::by_method(format!("what is known of loops of neutral type: {why}"), "counting roots").into()
}

/// The stable set of the free parameter.
pub(crate) fn stable_set_with_dead_time(
    parameter: &Free,
    delayed: &DelayedLoop,
    budget: &Budget,
) -> Result<StableSet, Error> {
    let set = with_positive_dead_time(parameter, delayed, budget)?;
    // Where the dead time is zero nothing is beside: what holds for small ones need not hold there.
    let BaseDelay::Line { slope, offset } = delayed.delay() else { return Ok(set) };
    let zero = -offset / slope;
    let is_pole = delayed.poles().iter().any(|pole| pole.sign_at(&zero).is_eq());
    if delayed.is_rational() || is_pole || !parameter.domain.contains(&zero) {
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

/// The stable set of a free parameter that is inside of functions.
pub(super) fn stable_set_beside_functions(
    parameter: &Free,
    delayed: &DelayedFunctions,
    budget: &Budget,
) -> Result<StableSet, Error> {
    let Range { mut lower, mut upper } = parameter.domain.clone();
    // A dead time is not negative, whatever the domain says.
    match &delayed.without_dead_time {
        Some((zero, true)) => lower = Some(lower.map_or(zero.clone(), |lower| lower.max(zero.clone()))),
        Some((zero, false)) => upper = Some(upper.map_or(zero.clone(), |upper| upper.min(zero.clone()))),
        None => {}
    }
    match delayed.family.stable_set(&Range { lower, upper }, budget) {
        Ok(found) => Ok(found.unwrap_or_else(|_| StableSet::from_intervals(Vec::new(), Vec::new()))),
        Err(NotSolved::Unbounded) => {
            let name = &parameter.name;
            let message = format!("'{name}' is inside of functions beside dead time, and its domain has no end");
            Err(refused(message, format!("give the domain both ends: --domain {name}=LO..HI")))
        }
        Err(reason) => Err(not_solved(reason)),
    }
}

/// The values at which no dead time is zero.
fn with_positive_dead_time(parameter: &Free, delayed: &DelayedLoop, budget: &Budget) -> Result<StableSet, Error> {
    let domain = &parameter.domain;
    if delayed.is_rational() {
        return Ok(crate::stability::stable_set(&delayed.polynomial(), domain, Shape::LeftHalfPlane, budget)?);
    }
    let from_the_axis = delayed.decay().is_zero() && delayed.is_exact();
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
            anywhere(&parameter.name, delayed, &domain, budget)
        }
        BaseDelay::Number(_) => match delayed.gain_loop().filter(|_| from_the_axis) {
            Some(gain) => gains(&parameter.name, delayed, &gain, domain, budget),
            None => anywhere(&parameter.name, delayed, domain, budget),
        },
    }
}

/// A parameter that enters in more than one way, or the decay rate.
fn anywhere(name: &str, delayed: &DelayedLoop, domain: &Range, budget: &Budget) -> Result<StableSet, Error> {
    let Some(family) = delayed.family().filter(|_| !domain.is_empty()) else {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    };
    let (domain, open) = family.apart_from_multiple_zeros(domain);
    match family_cells(&family, &domain, budget) {
        Ok(Ok(cells)) => {
            let set = cells.stable_set(&family, delayed.poles(), &domain, budget)?;
            let why = "a multiple root is at s = 0 at the end of the domain";
            let open = open.into_iter().map(|[lower, upper]| UndecidedBracket::new(Some(lower), Some(upper), why));
            match open.collect::<Vec<_>>() {
                none if none.is_empty() => Ok(set),
                open => Ok(StableSet::from_intervals(set.intervals().to_vec(), open)),
            }
        }
        Ok(Err(_)) => Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        Err(NotSolved::Unbounded) => {
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
    if cells.touching_for_ever && cells.right.last() == Some(&0) {
        let message = "roots touch the imaginary axis at infinitely many dead times, and cross it nowhere";
        return Err(refused(
            message,
            "give the domain two ends, --domain NAME=0..10: the touches between them are listed",
        ));
    }
    let line = Line { slope: slope.clone(), offset: offset.clone() };
    Ok(cells.stable_set(&p, [Some(&lower), upper.as_ref()], &line, budget)?)
}

/// A parameter at a fixed dead time.
fn gains(
    name: &str,
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
            Some(family) => Ok(cells.stable_set(&family, delayed.poles(), domain, budget)?),
            None => Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        };
    }
    let first = match gain_cells(gain, domain, budget) {
        Ok(Ok(cells)) => {
            let family = delayed.family().expect("the parameter enters");
            return Ok(cells.stable_set(&family, delayed.poles(), domain, budget)?);
        }
        Ok(Err(_)) => return Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        Err(NotSolved::NotCounted(reason)) => return Err(not_counted(reason)),
        Err(reason) => reason,
    };
    // What is special about an affine parameter does not help: as any other.
    match anywhere(name, delayed, domain, budget) {
        Err(Error::Refused(_)) => {}
        Err(Error::Stopped(_)) if budget.check().is_ok() => {}
        other => return other,
    }
    match first {
        NotSolved::Unbounded => {
            let message =
                format!("'{name}' enters in several terms with different dead times, and its domain has no end");
            Err(refused(message, format!("give the domain both ends: --domain {name}=LO..HI")))
        }
        reason => Err(not_solved(reason)),
    }
}

/// The stable set of a factor of the open loop, from its cells.
pub(crate) fn stable_factors(
    cells: Result<Result<GainCells, Never>, NotSolved>,
    family: &FamilyLoop,
    budget: &Budget,
) -> Result<StableSet, Error> {
    match cells {
        Ok(Ok(cells)) => Ok(cells.stable_set(family, &[], &Range::all(), budget)?),
        Ok(Err(_)) => Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        Err(NotSolved::NotCounted(reason)) => Err(not_counted(reason)),
        Err(reason) => Err(not_solved(reason)),
    }
}

#[cfg(test)]
mod tests;
