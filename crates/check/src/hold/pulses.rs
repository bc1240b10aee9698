//! What a block of numbers does with inputs that are pulses.
//!
//! An edge that stands `m + f` sample times behind a sample lets a small change of what was commanded `m` samples ago enter by
//! `w T exp((1 - f) A T) B`, where `w` is its share of the edges: the derivative of `x(T)` by the place of the edge.

use super::{Enters, Entries, Held, Hold, MovingHold, Numbers, Response, common_over, response, samples_of, scaled};
use crate::blocks::Values;
use crate::clock::Clock;
use crate::moving::Moving;
use crate::multivariate::{Fraction, Multi};
use crate::number::Q;
use num_traits::{One, Zero};

/// The pulse of an input: its duty ratio, and where its edges stand, in sample times.
#[derive(Clone)]
pub(crate) struct Pulse<F> {
    pub duty: F,
    pub edges: Vec<F>,
}

/// Inputs that are pulses, beside those that are held.
pub(crate) type Pulses<F> = Vec<Option<Pulse<F>>>;

/// Those of the inputs that are held.
pub(super) fn held_inputs<F>(pulses: &Pulses<F>) -> Vec<usize> {
    (0..pulses.len()).filter(|&j| pulses[j].is_none()).collect()
}

/// Adds the pulses to what a block does with its held inputs, if it has any.
pub(super) fn with_pulses(
    of: Option<Held>,
    a: &Numbers,
    hold: &Hold,
    values: &Values<'_>,
    clock: &Clock,
) -> Result<Held, String> {
    let (mut parts, mut enters, mut past, mut divisors) = (Vec::new(), Vec::new(), 0, Vec::new());
    if let Some(of) = of {
        parts.push((of.state, of.over.clone()));
        parts.extend(of.enters.iter().map(|enters| (enters.matrix.clone(), of.over.clone())));
        (enters, past, divisors) = (of.enters, of.past, of.divisors);
    }
    let mut flow = |share: Q| -> Result<(Entries, Multi), String> {
        let Response { parts: [state, ..], over } =
            response(a, hold, &(share * &hold.time), values, &mut divisors, clock)?;
        Ok((state, over))
    };
    if parts.is_empty() {
        parts.push(flow(Q::one())?);
    }
    let mut on_edge = Vec::new();
    for (j, pulse) in hold.pulses.iter().enumerate() {
        let Some(pulse) = pulse else { continue };
        for edge in &pulse.edges {
            let (age, share) = samples_of(&(&hold.delay / &hold.time + edge))?;
            if share.is_zero() {
                on_edge.push(j);
            }
            let (state, over) = flow(Q::one() - share)?;
            // T/k of it, for k edges.
            let weight = &hold.time / Q::from(num_bigint::BigInt::from(pulse.edges.len()));
            let state = scaled(&state, &Multi::constant(weight.numer().clone()), clock)?;
            parts.push((state, over.scaled(weight.denom())));
            past = past.max(age);
            enters.push(Enters { age: age as i64, matrix: Vec::new(), direct: Q::zero(), inputs: vec![j] });
        }
    }
    let (mut parts, over) = common_over(parts, clock)?;
    let state = parts.remove(0);
    for (enters, matrix) in enters.iter_mut().zip(parts) {
        enters.matrix = matrix;
    }
    Ok(Held { state, enters, over, past, divisors, on_edge })
}

/// The same with matrices as variables.
pub(super) fn moving_with_pulses(
    of: Option<Held>,
    a: &[Vec<Fraction>],
    hold: &MovingHold,
    moving: &mut Moving,
    clock: &Clock,
) -> Result<Held, String> {
    let one = || Fraction::number(&Q::one());
    let mut flow = |rest: &Fraction, duty: &Fraction| moving.flow(a, &hold.time, rest, duty);
    let half = Fraction::number(&Q::new(1.into(), 2.into()));
    let mut of = match of {
        Some(of) => of,
        None => {
            let (enters, divisors, on_edge) = (Vec::new(), Vec::new(), Vec::new());
            Held { state: flow(&one(), &half), enters, over: Multi::one(), past: 0, divisors, on_edge }
        }
    };
    let mut columns = Vec::new();
    for (j, pulse) in hold.pulses.iter().enumerate() {
        let Some(pulse) = pulse else { continue };
        for edge in &pulse.edges {
            let (age, share) = match edge.as_number() {
                Some(edge) => {
                    let (age, share) = samples_of(&(&hold.ratio + edge))?;
                    if share.is_zero() {
                        of.on_edge.push(j);
                    }
                    (age, Fraction::number(&share))
                }
                // The edge is within the period as long as the duty ratio is between 0 and 1.
                None if hold.ratio.is_integer() => (samples_of(&hold.ratio)?.0, edge.clone()),
                None => return Err("an edge of a pulse may pass a sample".into()),
            };
            let rest = one().plus(&share.negated(), clock)?;
            let weight = hold.time.times(&Fraction::number(&Q::new(1.into(), pulse.edges.len().into())), clock)?;
            columns.push((age, j, flow(&rest, &pulse.duty), weight));
        }
    }
    // All over the denominator of the sample time and the number of edges.
    let parts = std::iter::once((of.state, of.over.clone()))
        .chain(of.enters.iter().map(|enters| (enters.matrix.clone(), of.over.clone())))
        .map(Ok)
        .chain(columns.iter().map(|(_, _, matrix, weight)| {
            Ok::<_, String>((scaled(matrix, &weight.numerator, clock)?, weight.whole_denominator(clock)?))
        }))
        .collect::<Result<Vec<_>, _>>()?;
    for (age, j, ..) in &columns {
        of.past = of.past.max(*age);
        of.enters.push(Enters { age: *age as i64, matrix: Vec::new(), direct: Q::zero(), inputs: vec![*j] });
    }
    let (mut parts, over) = common_over(parts, clock)?;
    let state = parts.remove(0);
    for (enters, matrix) in of.enters.iter_mut().zip(parts) {
        enters.matrix = matrix;
    }
    Ok(Held { state, over, ..of })
}
