//! The rows of blocks behind a hold.

use super::{Diagram, Matrices, Row, Rule, Values};
use crate::clock::Clock;
use crate::complex::{doubled_matrix, has_unit};
use crate::hold::{self, Enters, Held, Hold, MovingHold, Pulse, Pulses};
use crate::multivariate::{Fraction, Multi};
use crate::number::Q;
use crate::over_symbols::substituted;
use crate::toml::Toml;
use num_traits::{One, Signed, Zero};
use std::ops::Range;

impl Diagram<'_, '_> {
    /// The rule of a block. Its sample time is that of the loop unless it has its own. To the dead time of a hold come exponents of the
    /// transfer function.
    pub(super) fn rule(&mut self, how: &Toml, exponents: &[String], inputs: &[Row]) -> Result<Rule, String> {
        let clock = self.scope.clock;
        let mut get = |key: &str| -> Result<Option<Fraction>, String> {
            let Some(value) = how.get(key) else { return Ok(None) };
            let value = self.scope.scalar(value)?;
            self.scope.real(value).map(Some)
        };
        let (mut time, factor, prewarp, mut delay) = (get("T")?, get("c")?, get("prewarp")?, get("delay")?);
        let (frame, advance) = (get("frame")?, get("advance")?);
        let method = method(how)?;
        let pulses = self.pulses(how, method, inputs)?;
        for exponent in exponents {
            let own = self.scope.time_of_exponent(exponent).and_then(|time| self.scope.real(time))?;
            delay = Some(delay.map_or(Ok(own.clone()), |delay| delay.plus(&own, clock))?);
        }
        if time.is_none() && factor.is_none() {
            time = self.period()?;
        }
        if (frame.is_some() && method != "zoh") || (advance.is_some() && frame.is_none()) {
            return Err("only 'zoh' has a 'frame', and an 'advance' goes with it".into());
        }
        if is_hold(how)? && self.rate.every > 1 {
            return Err("a continuous plant has no rate of its own".into());
        }
        if !is_hold(how)? {
            if delay.is_some() {
                return Err("only a hold has a 'delay'".into());
            }
            return match (prewarp, method, time, factor) {
                (None, method, time, factor) => self.substitution(method, time, factor).map(Rule::Quotient),
                (Some(frequency), "tustin", Some(time), None) => self.prewarped(&frequency, &time),
                _ => Err("'prewarp' goes with tustin and a sample time, without 'c'".into()),
            };
        }
        let (Some(time), None, None) = (time, factor, prewarp) else {
            return Err("'discretize' is not complete".into());
        };
        let Some(values) = self.values else { return Ok(Rule::Unknown) };
        if let Some(speed) = frame {
            let turn = self.scope.rotation(&speed.times(&time, clock)?)?;
            let ahead = advance.map_or_else(|| Ok(Fraction::number(&Q::one())), |angle| self.scope.rotation(&angle))?;
            self.frame = Some([turn, ahead]);
        }
        if self.scope.moving.is_some() {
            let ratio = delay.map_or(Ok(Q::zero()), |delay| ratio(&delay, &time, &values, clock))?;
            return Ok(Rule::Moving(MovingHold { is_first_order: method == "foh", time, ratio, pulses }));
        }
        let delay = delay.map_or(Ok(Q::zero()), |delay| numbered(&delay, &values, clock))?;
        let number = |f: &Fraction| numbered(f, &values, clock);
        let pulses = numbered_pulses(&pulses, number)?;
        Ok(Rule::Hold(Hold { is_first_order: method == "foh", time: number(&time)?, delay, pulses }))
    }

    /// The time between the samples of a block, if the loop has one: a slower block has its own.
    fn period(&mut self) -> Result<Option<Fraction>, String> {
        let Some(time) = self.sample_time else { return Ok(None) };
        let time = self.scope.scalar(time).and_then(|time| self.scope.real(time))?;
        time.times(&Fraction::number(&Q::from_integer(self.rate.every.into())), self.scope.clock).map(Some)
    }

    /// States of `num/den`: the companion matrix of the denominator.
    pub(super) fn realised(&self, num: &Multi, den: &Multi) -> Result<Matrices, String> {
        let clock = self.scope.clock;
        let Some(values) = self.values else { return Err("internal: a hold without values".into()) };
        let whole = |m: &Multi| Fraction::from(m.clone());
        // Numbers, where only numbers can be in an exponential.
        let read = |c: &Multi| match self.scope.moving {
            Some(_) => Ok(whole(c)),
            None => self.complex_number(&whole(c), &values),
        };
        let den: Vec<Fraction> = den.coefficients(0).iter().map(read).collect::<Result<_, _>>()?;
        let Some((lead, below)) = den.split_last().filter(|(lead, _)| !lead.numerator.is_zero()) else {
            return Err("a held block loses its order".into());
        };
        let lead = lead.inverse(clock)?;
        let (n, zero) = (below.len(), || Fraction::number(&Q::zero()));
        let mut num: Vec<Fraction> = num.coefficients(0).iter().map(whole).collect();
        num.resize_with(n + 1, zero);
        for c in &mut num {
            *c = c.times(&lead, clock)?;
        }
        let direct = num.pop().unwrap_or_else(zero);
        let mut a = vec![vec![zero(); n]; n];
        let mut c = Vec::with_capacity(n);
        for k in 0..n {
            if k > 0 {
                a[k - 1][k] = Fraction::number(&Q::one());
            }
            let ratio = below[k].times(&lead, clock)?;
            a[n - 1][k] = ratio.clone().negated();
            c.push(num[k].plus(&direct.times(&ratio.negated(), clock)?, clock)?);
        }
        let b = (0..n).map(|k| vec![Fraction::number(&if k + 1 == n { Q::one() } else { Q::zero() })]).collect();
        Ok([a, b, vec![c], vec![vec![direct]]])
    }

    /// What a block does behind a hold with its numbers.
    pub(super) fn enclosed(&mut self, a: &[Vec<Fraction>], inputs: usize, hold: &Hold) -> Result<Held, String> {
        let clock = self.scope.clock;
        let Some(values) = self.values else { return Err("internal: a hold without values".into()) };
        let number = |f: &Fraction| numbered(f, &values, clock);
        let in_parts = self.in_parts(a)?;
        let a = in_parts.as_deref().unwrap_or(a);
        let numbers = a.iter().map(|row| row.iter().map(number).collect()).collect::<Result<Vec<Vec<Q>>, _>>()?;
        let of = hold::held(&numbers, inputs, hold, &values, clock)?;
        self.scope.divisors.extend(of.divisors.iter().filter(|m| !m.is_constant()).cloned());
        if in_parts.is_some() { self.joined(of) } else { Ok(of) }
    }

    /// The number that a fraction is, with an imaginary part if it has one.
    fn complex_number(&self, f: &Fraction, values: &Values<'_>) -> Result<Fraction, String> {
        let clock = self.scope.clock;
        let [re, im] = f.parts(values.unit(), clock)?;
        let [re, im] = [numbered(&re, values, clock)?, numbered(&im, values, clock)?];
        match im.is_zero() {
            true => Ok(Fraction::number(&re)),
            false => Fraction::number(&re)
                .plus(&Fraction::number(&im).times(&Fraction::variable(values.unit()), clock)?, clock),
        }
    }

    /// The real matrix of a complex one: of `x + jy` the rows `x, -y` and `y, x`.
    fn in_parts(&self, a: &[Vec<Fraction>]) -> Result<Option<Vec<Vec<Fraction>>>, String> {
        match self.scope.unit {
            Some(unit) if !a.iter().flatten().all(|f| f.is_real(unit)) => {
                doubled_matrix(a, unit, self.scope.clock).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// What a complex block does, from what its real matrix does: `exp(At)` and its integrals have the same form as that.
    fn joined(&self, of: Held) -> Result<Held, String> {
        let unit = Multi::variable(self.scope.unit.ok_or("internal: no imaginary unit")?);
        let clock = self.scope.clock;
        let whole = |m: &Vec<Vec<Multi>>| -> Result<Vec<Vec<Multi>>, String> {
            let n = m.len() / 2;
            let entry = |i: usize, j: usize| Ok(m[2 * i][2 * j].plus(&m[2 * i + 1][2 * j].times(&unit, clock)?));
            (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
        };
        let enters = of.enters.iter().map(|enters| {
            let matrix = whole(&enters.matrix)?;
            Ok(Enters { matrix, direct: enters.direct.clone(), inputs: enters.inputs.clone(), age: enters.age })
        });
        Ok(Held { enters: enters.collect::<Result<_, String>>()?, state: whole(&of.state)?, ..of })
    }

    /// The same where it depends on the parameters of a box.
    pub(super) fn moving(&mut self, a: &[Vec<Fraction>], inputs: usize, hold: &MovingHold) -> Result<Held, String> {
        let clock = self.scope.clock;
        a.iter().flatten().try_for_each(|f| self.scope.without_factor(f))?;
        let in_parts = self.in_parts(a)?;
        let moving = self.scope.moving.as_mut().ok_or("internal: a hold with numbers")?;
        let of = hold::moving(in_parts.as_deref().unwrap_or(a), inputs, hold, moving, clock)?;
        if in_parts.is_some() { self.joined(of) } else { Ok(of) }
    }

    /// The rows of a block behind a hold: its states, then the past inputs it remembers.
    pub(super) fn held(
        &mut self,
        matrices: Matrices,
        of: Held,
        inputs: &[Row],
        outputs: Range<usize>,
    ) -> Result<(), String> {
        let clock = self.scope.clock;
        for &j in &of.on_edge {
            is_smooth(&matrices, j, clock)?;
        }
        let [a, b, c, d] = matrices;
        let (n, m) = (a.len(), inputs.len());
        let (states, past) = (self.unknowns, self.unknowns + n);
        self.unknowns += n + of.past * m;
        self.degree += n + of.past * m;
        // Seen from a frame that turns: exp(ja) G(z exp(jwT)).
        let one = Fraction::number(&Q::one());
        let [turn, ahead] = self.frame.take().unwrap_or_else(|| [one.clone(), one]);
        let turned = |(k, c): (&usize, &Fraction)| Ok((*k, c.times(&ahead, clock)?));
        let inputs =
            inputs.iter().map(|input| input.iter().map(turned).collect()).collect::<Result<Vec<Row>, String>>()?;
        let later = turn.times(&Fraction::variable(0), clock)?;
        let aged = Aged { inputs, later: later.clone(), past };
        let over = |m: &Multi| Fraction::over(m.clone(), of.over.clone());
        for i in 0..n {
            // z x - state x - sum matrix B u = 0
            let mut row = Row::from([(states + i, later.clone())]);
            for j in 0..n {
                self.add(&mut row, states + j, over(&of.state[i][j]).negated())?;
            }
            for enters in &of.enters {
                for &j in &enters.inputs {
                    for k in (0..n).filter(|&k| !enters.matrix[i][k].is_zero() && !b[k][j].numerator.is_zero()) {
                        let factor = over(&enters.matrix[i][k]).times(&b[k][j], clock)?.negated();
                        self.feed_aged(&mut row, &factor, (enters.age, j), &aged)?;
                    }
                }
            }
            self.rows.push(row);
        }
        for i in 0..of.past * m {
            // z p - (what came a sample later) = 0
            let mut row = Row::from([(past + i, later.clone())]);
            self.feed_aged(&mut row, &Fraction::number(&-Q::one()), ((i / m) as i64, i % m), &aged)?;
            self.rows.push(row);
        }
        for (i, output) in outputs.enumerate() {
            // y - C x - sum direct D u = 0
            let mut row = Row::from([(output, Fraction::number(&Q::one()))]);
            for (j, c) in c[i].iter().enumerate() {
                self.add(&mut row, states + j, c.clone().negated())?;
            }
            for enters in of.enters.iter().filter(|enters| !enters.direct.is_zero()) {
                for &j in enters.inputs.iter().filter(|&&j| !d[i][j].numerator.is_zero()) {
                    let factor = d[i][j].times(&Fraction::number(&-enters.direct.clone()), clock)?;
                    self.feed_aged(&mut row, &factor, (enters.age, j), &aged)?;
                }
            }
            self.rows.push(row);
        }
        Ok(())
    }

    /// Adds a multiple of an input of some age.
    fn feed_aged(&mut self, row: &mut Row, factor: &Fraction, (age, j): (i64, usize), of: &Aged) -> Result<(), String> {
        match age {
            -1 => self.feed(row, &factor.times(&of.later, self.scope.clock)?, &of.inputs[j]),
            0 => self.feed(row, factor, &of.inputs[j]),
            k => self.add(row, of.past + (k as usize - 1) * of.inputs.len() + j, factor.clone()),
        }
    }
}

/// Inputs at a sample, and what stands for a sample later; from an unknown on there are the inputs of the samples before.
struct Aged {
    inputs: Vec<Row>,
    later: Fraction,
    past: usize,
}

/// Refuses an input that steps at a sample, if an output steps with it.
fn is_smooth([_, b, c, d]: &Matrices, input: usize, clock: &Clock) -> Result<(), String> {
    for (row, direct) in c.iter().zip(d) {
        let mut step = Fraction::number(&Q::zero());
        for (c, b) in row.iter().zip(b) {
            step = step.plus(&c.times(&b[input], clock)?, clock)?;
        }
        if !step.numerator.is_zero() || !direct[input].numerator.is_zero() {
            return Err("a sample stands on an edge of a pulse".into());
        }
    }
    Ok(())
}

/// The pulses of inputs with their numbers.
fn numbered_pulses(
    pulses: &Pulses<Fraction>,
    number: impl Fn(&Fraction) -> Result<Q, String>,
) -> Result<Pulses<Q>, String> {
    let pulse = |pulse: &Option<Pulse<Fraction>>| {
        let Some(Pulse { duty, edges }) = pulse else { return Ok(None) };
        let duty = number(duty)?;
        if duty <= Q::zero() || duty >= Q::one() {
            return Err("the duty ratio of a modulator is not between 0 and 1".to_owned());
        }
        Ok(Some(Pulse { duty, edges: edges.iter().map(&number).collect::<Result<_, _>>()? }))
    };
    pulses.iter().map(pulse).collect()
}

fn method(how: &Toml) -> Result<&str, String> {
    match how {
        Toml::Text(method) => Ok(method.as_str()),
        table => table.get("method").ok_or("'discretize' has no method")?.text(),
    }
}

pub(super) fn is_hold(how: &Toml) -> Result<bool, String> {
    Ok(matches!(method(how)?, "zoh" | "foh" | "pwm"))
}

/// The delay over the sample time, a number that is not negative.
fn ratio(delay: &Fraction, time: &Fraction, values: &Values<'_>, clock: &Clock) -> Result<Q, String> {
    let top = delay.numerator.times(&time.whole_denominator(clock)?, clock)?;
    let below = time.numerator.times(&delay.whole_denominator(clock)?, clock)?;
    let both = substituted(&[top, below], values.numbers, clock)?;
    let [top, below] = both.as_slice() else { return Err("internal: a quotient has two parts".into()) };
    let Some((key, c)) = below.0.last_key_value() else { return Err("a sample time is zero".into()) };
    let q = Q::new(top.0.get(key).cloned().unwrap_or_default(), c.clone());
    if top.scaled(q.denom()) != below.scaled(q.numer()) || q.is_negative() {
        return Err("a dead time is not a fixed multiple of the sample time".into());
    }
    Ok(q)
}

/// The number that a fraction is for the values of the parameters.
pub(super) fn numbered(f: &Fraction, values: &Values<'_>, clock: &Clock) -> Result<Q, String> {
    let number = |m: &Multi| -> Result<Q, String> {
        if has_unit(m, values.unit()) {
            return Err("the matrix of a plant behind a hold is complex".into());
        }
        let at = m.specialised(1, values.numbers, clock)?;
        let mut all = at.into_iter().flatten();
        let first = all.next().unwrap_or_default();
        if all.any(|q| !q.is_zero()) {
            return Err("a held block depends on the parameter in question within its exponential".into());
        }
        Ok(first)
    };
    let below = number(&f.whole_denominator(clock)?)?;
    if below.is_zero() {
        return Err("a held block divides by zero".into());
    }
    Ok(number(&f.numerator)? / below)
}
