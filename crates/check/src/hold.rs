//! What a continuous block of numbers does behind a hold.

mod pulses;
mod response;

use super::blocks::Values;
use super::clock::Clock;
use super::moving::{HeldMatrix, Moving};
use super::multivariate::{Fraction, Multi};
use super::number::Q;
use num_traits::{One, ToPrimitive, Zero};
pub(super) use pulses::{Pulse, Pulses};
use pulses::{held_inputs, moving_with_pulses, with_pulses};
use response::{Response, response};

/// Dead times of more samples are refused.
const MAX_SAMPLES: usize = 2000;

type Numbers = Vec<Vec<Q>>;

/// Matrices of polynomials in symbols.
type Entries = Vec<Vec<Multi>>;

/// A hold with its numbers.
pub(super) struct Hold {
    pub is_first_order: bool,
    pub time: Q,
    pub delay: Q,
    /// Inputs that are pulses; none of a mere hold.
    pub pulses: Pulses<Q>,
}

/// A hold whose sample time, and whose plant, may depend on the parameters of a box; the delay is a multiple of the sample time.
#[derive(Clone)]
pub(super) struct MovingHold {
    pub is_first_order: bool,
    pub time: Fraction,
    pub ratio: Q,
    /// Inputs that are pulses; none of a mere hold.
    pub pulses: Pulses<Fraction>,
}

/// How inputs of some age, in samples, enter: the matrix before `B`, and the share of it that passes on at once.
pub(super) struct Enters {
    pub age: i64,
    pub matrix: Entries,
    pub direct: Q,
    /// The inputs that enter so.
    pub inputs: Vec<usize>,
}

/// `over x[k+1] = state x[k] + sum matrix B u[k - age]`.
pub(super) struct Held {
    pub state: Entries,
    pub enters: Vec<Enters>,
    /// The common denominator of all entries.
    pub over: Multi,
    /// How many past inputs are remembered.
    pub past: usize,
    /// What was divided by.
    pub divisors: Vec<Multi>,
    /// Inputs with a sample on an edge of their pulse: no output may change there.
    pub on_edge: Vec<usize>,
}

/// How many whole samples a delay is, and the share of one that is left.
fn samples_of(ratio: &Q) -> Result<(usize, Q), String> {
    let samples = ratio.floor().to_integer().to_usize().filter(|k| *k <= MAX_SAMPLES);
    Ok((samples.ok_or("a dead time has too many samples")?, ratio.fract()))
}

/// The same with matrices as variables.
pub(super) fn moving(
    a: &[Vec<Fraction>],
    inputs: usize,
    hold: &MovingHold,
    moving: &mut Moving,
    clock: &Clock,
) -> Result<Held, String> {
    if hold.pulses.is_empty() {
        return moving_hold(a, (0..inputs).collect(), hold, moving);
    }
    let held = held_inputs(&hold.pulses);
    let of = if held.is_empty() { None } else { Some(moving_hold(a, held, hold, moving)?) };
    moving_with_pulses(of, a, hold, moving, clock)
}

fn moving_hold(
    a: &[Vec<Fraction>],
    inputs: Vec<usize>,
    hold: &MovingHold,
    moving: &mut Moving,
) -> Result<Held, String> {
    let (samples, fraction) = samples_of(&hold.ratio)?;
    let kinds = match (fraction.is_zero(), hold.is_first_order) {
        (true, false) => vec![HeldMatrix::State, HeldMatrix::Now],
        (false, false) => vec![HeldMatrix::State, HeldMatrix::Now, HeldMatrix::Early],
        (true, true) => vec![HeldMatrix::State, HeldMatrix::NowOfRamp, HeldMatrix::LateOfRamp],
        (false, true) => {
            vec![HeldMatrix::State, HeldMatrix::NowOfRamp, HeldMatrix::LateOfRamp, HeldMatrix::EarlyOfRamp]
        }
    };
    let found = moving.held(a, &hold.time, &fraction, kinds.clone());
    let nothing = vec![vec![Multi::default(); a.len()]; a.len()];
    let of = |wanted: [HeldMatrix; 2]| {
        let at = kinds.iter().position(|kind| wanted.contains(kind));
        at.map_or_else(|| nothing.clone(), |k| found[k].clone())
    };
    let parts = [
        of([HeldMatrix::Early, HeldMatrix::EarlyOfRamp]),
        of([HeldMatrix::Now, HeldMatrix::NowOfRamp]),
        of([HeldMatrix::LateOfRamp; 2]),
    ];
    let shares = Shares { samples, fraction, is_first_order: hold.is_first_order, inputs };
    Ok(assembled(found[0].clone(), Multi::one(), parts, shares, Vec::new()))
}

/// Of a block with so many inputs.
pub(super) fn held(
    a: &Numbers,
    inputs: usize,
    hold: &Hold,
    values: &Values<'_>,
    clock: &Clock,
) -> Result<Held, String> {
    let zero = Q::zero();
    if hold.time <= zero || hold.delay < zero {
        return Err("the times of a hold are not positive".into());
    }
    if hold.pulses.is_empty() {
        return behind_hold(a, (0..inputs).collect(), hold, values, clock);
    }
    let held = held_inputs(&hold.pulses);
    let of = if held.is_empty() { None } else { Some(behind_hold(a, held, hold, values, clock)?) };
    with_pulses(of, a, hold, values, clock)
}

fn behind_hold(
    a: &Numbers,
    inputs: Vec<usize>,
    hold: &Hold,
    values: &Values<'_>,
    clock: &Clock,
) -> Result<Held, String> {
    let (samples, fraction) = samples_of(&(&hold.delay / &hold.time))?;
    let mut divisors = Vec::new();
    let mut respond = |share: &Q| response(a, hold, &(share * &hold.time), values, &mut divisors, clock);
    let one = Q::one();
    if fraction.is_zero() {
        let Response { parts: [state, whole, slope], over } = respond(&one)?;
        let nothing = scaled(&whole, &Multi::default(), clock)?;
        let parts = match hold.is_first_order {
            true => [nothing, minus(&whole, &slope), slope],
            false => [nothing.clone(), whole, nothing],
        };
        let shares = Shares { samples, fraction, is_first_order: hold.is_first_order, inputs };
        return Ok(assembled(state, over, parts, shares, divisors));
    }
    let (r, s) = (respond(&fraction)?, respond(&(&one - &fraction))?);
    let [[r0, r1, r2], [s0, s1, s2]] = [&r.parts, &s.parts];
    // All over both denominators and that of the fraction.
    let (n, d) = (Multi::constant(fraction.numer().clone()), Multi::constant(fraction.denom().clone()));
    let over = r.over.times(&s.over, clock)?.times(&d, clock)?;
    let state = scaled(&product(s0, r0, clock)?, &d, clock)?;
    let by = r.over.times(&d, clock)?;
    let parts = if hold.is_first_order {
        let begin = minus(&scaled(r1, &n, clock)?, &scaled(r2, &d, clock)?);
        let then = plus(&scaled(r1, &d.minus(&n), clock)?, &scaled(r2, &d, clock)?);
        let now = plus(&product(s0, &then, clock)?, &scaled(&minus(s1, s2), &by, clock)?);
        [product(s0, &begin, clock)?, now, scaled(s2, &by, clock)?]
    } else {
        let nothing = scaled(s1, &Multi::default(), clock)?;
        [scaled(&product(s0, r1, clock)?, &d, clock)?, scaled(s1, &by, clock)?, nothing]
    };
    let shares = Shares { samples, fraction, is_first_order: hold.is_first_order, inputs };
    Ok(assembled(state, over, parts, shares, divisors))
}

/// The dead time of inputs: whole samples and the share of one that is left.
struct Shares {
    samples: usize,
    fraction: Q,
    is_first_order: bool,
    inputs: Vec<usize>,
}

/// The parts by the age of the input, `early`, `now` and `late` in this order.
fn assembled(
    state: Entries,
    over: Multi,
    [early, now, late]: [Entries; 3],
    Shares { samples, fraction, is_first_order, inputs }: Shares,
    divisors: Vec<Multi>,
) -> Held {
    // What passes on at once is the input at the sample.
    let (one, zero) = (Q::one(), Q::zero());
    let shares = match (fraction.is_zero(), is_first_order) {
        (true, _) => [zero.clone(), one],
        (false, false) => [one, zero.clone()],
        (false, true) => [fraction.clone(), Q::one() - &fraction],
    };
    let [early_share, now_share] = shares;
    let age = samples as i64;
    let mut enters = vec![Enters { age, matrix: now, direct: now_share, inputs: inputs.clone() }];
    if is_first_order {
        enters.push(Enters { age: age - 1, matrix: late, direct: zero, inputs: inputs.clone() });
    }
    if !fraction.is_zero() {
        enters.push(Enters { age: age + 1, matrix: early, direct: early_share, inputs });
    }
    let past = samples + usize::from(!fraction.is_zero());
    Held { state, enters, over, past, divisors, on_edge: Vec::new() }
}

/// Matrices with a denominator each, over one.
fn common_over(parts: Vec<(Entries, Multi)>, clock: &Clock) -> Result<(Vec<Entries>, Multi), String> {
    let over = Multi::common_multiple(parts.iter().map(|(_, own)| own), clock)?;
    let whole = |(matrix, own): (Entries, Multi)| scaled(&matrix, &over.quotient(&own, clock)?, clock);
    let parts = parts.into_iter().map(whole).collect::<Result<_, _>>()?;
    Ok((parts, over))
}

fn scaled(m: &Entries, by: &Multi, clock: &Clock) -> Result<Entries, String> {
    m.iter().map(|row| row.iter().map(|x| x.times(by, clock)).collect()).collect()
}

fn plus(a: &Entries, b: &Entries) -> Entries {
    a.iter().zip(b).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x.plus(y)).collect()).collect()
}

fn minus(a: &Entries, b: &Entries) -> Entries {
    a.iter().zip(b).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x.minus(y)).collect()).collect()
}

fn product(a: &Entries, b: &Entries, clock: &Clock) -> Result<Entries, String> {
    let n = a.len();
    let mut out = vec![vec![Multi::default(); n]; n];
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                out[i][j] = out[i][j].plus(&a[i][k].times(&b[k][j], clock)?);
            }
        }
    }
    Ok(out)
}
