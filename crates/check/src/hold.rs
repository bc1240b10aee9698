//! What a continuous block of numbers does behind a hold.
//!
//! `exp(M t) = sum_b b(t) Z_b`, where the `b` are a basis of the solutions of a linear differential equation whose polynomial
//! annihilates `M`: both sides solve it, and have the same derivatives at 0 if `sum_b b^(l)(0) Z_b = M^l` below its order
//! [Leonard1996]. With `M = [[A, I, 0], [0, 0, I/T], [0, 0, 0]]` the first row holds `exp(A t)` and its integrals, and `s^2` times
//! the characteristic polynomial of `A` annihilates it.

#![expect(clippy::needless_range_loop, reason = "matrix indices, as in the formulas")]

mod pulses;

use super::clock::Clock;
use super::moving::{HeldMatrix, Moving};
use super::multivariate::{Fraction, Multi};
use super::number::{Q, power};
use super::symbols::Table;
use super::univariate::common_denominator;
use num_traits::{One, ToPrimitive, Zero};
pub(super) use pulses::{Pulse, Pulses};
use pulses::{held_inputs, moving_with_pulses, with_pulses};

/// A product of rational numbers and a sum are so many operations: their common divisors are looked for.
const RATIONAL: usize = 20;

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

/// `exp(A t)`, its integral, and the integral's integral over `T`, all over one denominator.
struct Response {
    parts: [Entries; 3],
    over: Multi,
}

/// A solution `t^power phi_index` for a factor.
struct Solution<'m> {
    monic: &'m [Q],
    power: usize,
    index: usize,
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

/// Of a block with so many inputs; symbols are the variables from `first` on.
pub(super) fn held(
    a: &Numbers,
    inputs: usize,
    hold: &Hold,
    table: &Table,
    first: usize,
    clock: &Clock,
) -> Result<Held, String> {
    let zero = Q::zero();
    if hold.time <= zero || hold.delay < zero {
        return Err("the times of a hold are not positive".into());
    }
    if hold.pulses.is_empty() {
        return behind_hold(a, (0..inputs).collect(), hold, table, first, clock);
    }
    let held = held_inputs(&hold.pulses);
    let of = if held.is_empty() { None } else { Some(behind_hold(a, held, hold, table, first, clock)?) };
    with_pulses(of, a, hold, table, first, clock)
}

fn behind_hold(
    a: &Numbers,
    inputs: Vec<usize>,
    hold: &Hold,
    table: &Table,
    first: usize,
    clock: &Clock,
) -> Result<Held, String> {
    let (samples, fraction) = samples_of(&(&hold.delay / &hold.time))?;
    let mut divisors = Vec::new();
    let mut respond = |share: &Q| response(a, hold, &(share * &hold.time), table, first, &mut divisors, clock);
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
    let mut over = Multi::one();
    for (_, own) in &parts {
        let g = over.gcd(own, clock)?;
        let rest = own.divided(&g, clock)?.ok_or("internal: a gcd does not divide")?;
        over = over.times(&rest, clock)?;
    }
    let whole = |(matrix, own): (Entries, Multi)| {
        let factor = over.divided(&own, clock)?.ok_or("internal: a common multiple is none")?;
        scaled(&matrix, &factor, clock)
    };
    let parts = parts.into_iter().map(whole).collect::<Result<_, String>>()?;
    Ok((parts, over))
}

/// The characteristic polynomial, monic and without the leading coefficient, by Faddeev and LeVerrier; and the powers of the matrix
/// up to its size.
fn characteristic(a: &Numbers, clock: &Clock) -> Result<(Vec<Q>, Vec<Numbers>), String> {
    let n = a.len();
    let unit = |c: &Q| -> Numbers {
        (0..n).map(|i| (0..n).map(|j| if i == j { c.clone() } else { Q::zero() }).collect()).collect()
    };
    let mut powers = vec![unit(&Q::one())];
    let mut out = vec![Q::zero(); n];
    let mut m = unit(&Q::one());
    for k in 1..=n {
        let am = numbers_product(a, &m, clock)?;
        let trace = (0..n).fold(Q::zero(), |sum, i| sum + &am[i][i]);
        let c = -trace / Q::from(num_bigint::BigInt::from(k));
        out[n - k] = c.clone();
        m = am.iter().zip(unit(&c)).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x + y).collect()).collect();
        let last = &powers[k - 1];
        let next = numbers_product(a, last, clock)?;
        powers.push(next);
    }
    Ok((out, powers))
}

fn numbers_product(a: &Numbers, b: &Numbers, clock: &Clock) -> Result<Numbers, String> {
    let n = a.len();
    let mut out = vec![vec![Q::zero(); n]; n];
    for i in 0..n {
        for j in 0..n {
            for k in (0..n).filter(|&k| !a[i][k].is_zero() && !b[k][j].is_zero()) {
                clock.spend(RATIONAL, a[i][k].numer().bits() + a[i][k].denom().bits(), b[k][j].numer().bits())?;
                out[i][j] += &a[i][k] * &b[k][j];
            }
        }
    }
    Ok(out)
}

fn response(
    a: &Numbers,
    hold: &Hold,
    span: &Q,
    table: &Table,
    first: usize,
    divisors: &mut Vec<Multi>,
    clock: &Clock,
) -> Result<Response, String> {
    let n = a.len();
    let (monic, mut powers) = characteristic(a, clock)?;
    let zeros = if hold.is_first_order { 2 } else { 1 };
    let mut factors = table.factored(&monic)?;
    match factors.first_mut() {
        Some((monic, multiplicity)) if *monic == [Q::zero()] => *multiplicity += zeros,
        _ => factors.insert(0, (vec![Q::zero()], zeros)),
    }
    let mut solutions = Vec::new();
    for (monic, multiplicity) in &factors {
        for power in 0..*multiplicity {
            solutions.extend((0..monic.len()).map(|index| Solution { monic, power, index }));
        }
    }
    let order = solutions.len();
    let derivatives: Vec<Vec<Q>> = solutions.iter().map(|s| s.derivatives(order)).collect();
    let weights = inverse((0..order).map(|l| derivatives.iter().map(|d| d[l].clone()).collect()).collect(), clock)?;
    while powers.len() < order {
        let next = numbers_product(a, &powers[powers.len() - 1], clock)?;
        powers.push(next);
    }
    // The basis over one denominator.
    let mut basis = Vec::with_capacity(order);
    for s in &solutions {
        basis.push(s.value(span, table, first, divisors, clock)?);
    }
    let mut over = Multi::one();
    for b in &basis {
        let g = over.gcd(&b.scalar, clock)?;
        let rest = b.scalar.divided(&g, clock)?.ok_or("internal: a gcd does not divide")?;
        over = over.times(&rest, clock)?;
    }
    let mut tops = Vec::with_capacity(order);
    for b in &basis {
        let factor = over.divided(&b.scalar, clock)?.ok_or("internal: a common multiple is none")?;
        tops.push(b.numerator.times(&factor, clock)?);
    }
    // Z_b = sum_l weights[b][l] M^l, whose first row is A^l, A^(l-1), A^(l-2)/T.
    let part = |b: usize, j: usize, r: usize, c: usize| {
        let scale = if j == 2 { hold.time.recip() } else { Q::one() };
        (j..order).fold(Q::zero(), |sum, l| sum + &weights[b][l] * &powers[l - j][r][c]) * scale
    };
    let mut z = vec![[vec![vec![Q::zero(); n]; n], vec![vec![Q::zero(); n]; n], vec![vec![Q::zero(); n]; n]]; order];
    for b in 0..order {
        for j in 0..3 {
            for r in 0..n {
                for c in 0..n {
                    clock.spend(RATIONAL, 1, 1)?;
                    z[b][j][r][c] = part(b, j, r, c);
                }
            }
        }
    }
    let common = common_denominator(z.iter().flatten().flatten().flatten());
    let mut parts: [Entries; 3] = std::array::from_fn(|_| vec![vec![Multi::default(); n]; n]);
    for (j, entries) in parts.iter_mut().enumerate() {
        for r in 0..n {
            for c in 0..n {
                for b in (0..order).filter(|&b| !z[b][j][r][c].is_zero()) {
                    let q = &z[b][j][r][c];
                    entries[r][c] = entries[r][c].plus(&tops[b].scaled(&(q.numer() * (&common / q.denom()))));
                }
            }
        }
    }
    Ok(Response { parts, over: over.scaled(&common) })
}

impl Solution<'_> {
    /// The derivatives at 0, from the function itself up: `(t^j phi)^(l) = l!/(l - j)! phi^(l - j)` there.
    fn derivatives(&self, count: usize) -> Vec<Q> {
        let d = self.monic.len();
        let mut phi: Vec<Q> = Vec::with_capacity(count);
        for l in 0..count {
            let value = match l.checked_sub(d) {
                None if l == self.index => Q::one(),
                None => Q::zero(),
                Some(rest) => (0..d).fold(Q::zero(), |sum, k| sum - &self.monic[k] * &phi[rest + k]),
            };
            phi.push(value);
        }
        let falling =
            |l: usize| (l - self.power + 1..=l).fold(Q::one(), |f, k| f * Q::from(num_bigint::BigInt::from(k)));
        (0..count).map(|l| if l < self.power { Q::zero() } else { &phi[l - self.power] * falling(l) }).collect()
    }

    /// The value over the symbols. A pair of conjugate rates is written by the tangent of half the angle: with `w = c - b^2/4` and
    /// `X = exp(-b t/2)` the solutions are `X 2x/(1 + w x^2)` and `X (1 - w x^2)/(1 + w x^2)` with `b/2` times the former.
    fn value(
        &self,
        t: &Q,
        table: &Table,
        first: usize,
        divisors: &mut Vec<Multi>,
        clock: &Clock,
    ) -> Result<Fraction, String> {
        let half = Q::new(1.into(), 2.into());
        let base = match self.monic {
            [rate] if rate.is_zero() => Fraction::number(&Q::one()),
            [rate] => table.exponential(&-(rate * t), first, clock)?,
            [c, b] if *c != b * b * &half * &half => {
                let w = c - b * b * &half * &half;
                let decay = table.exponential(&-(b * t * &half), first, clock)?;
                let (x, divided) = table.tangent(&w, &(t * &half), first, clock)?;
                divisors.extend(divided);
                let square = x.times(&x, clock)?.times(&Fraction::number(&w), clock)?;
                let one = Fraction::number(&Q::one());
                let below = one.plus(&square, clock)?;
                divisors.push(below.numerator.clone());
                let over = below.inverse(clock)?.times(&decay, clock)?;
                let sine = x.plus(&x, clock)?.times(&over, clock)?;
                if self.index == 1 {
                    sine
                } else {
                    let cosine = one.plus(&square.negated(), clock)?.times(&over, clock)?;
                    cosine.plus(&sine.times(&Fraction::number(&(b * &half)), clock)?, clock)?
                }
            }
            monic => table.solution(monic, t, self.index, first)?,
        };
        base.times(&Fraction::number(&power(t, self.power as u32)), clock)
    }
}

/// The inverse of a matrix of numbers.
fn inverse(mut m: Numbers, clock: &Clock) -> Result<Numbers, String> {
    let n = m.len();
    for (i, row) in m.iter_mut().enumerate() {
        row.extend((0..n).map(|j| if i == j { Q::one() } else { Q::zero() }));
    }
    for k in 0..n {
        let pivot = (k..n).find(|&i| !m[i][k].is_zero()).ok_or("the modes of a held block are not coprime")?;
        m.swap(k, pivot);
        let scale = m[k][k].recip();
        m[k].iter_mut().for_each(|x| *x *= &scale);
        for i in (0..n).filter(|&i| i != k) {
            let factor = m[i][k].clone();
            if factor.is_zero() {
                continue;
            }
            for j in k..2 * n {
                clock.spend(RATIONAL, 1, 1)?;
                let step = &factor * &m[k][j];
                m[i][j] -= step;
            }
        }
    }
    Ok(m.into_iter().map(|row| row[n..].to_vec()).collect())
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
