//! A continuous block behind a hold or a pulse-width modulator, its inputs delayed by dead time: the exact discrete system.
//!
//! With dead time `(m + f) T` the input that acts in a step is that of samples `k - m - 1` (during `f T`) and `k - m`;
//! behind a first-order hold the next one as well [FranklinPowellWorkman1998]. Earlier samples are further states, named
//! after the block.

use super::exponential::Modes;
use super::state_space::{NotConnected, Substitution, System, substituted, undefined};
use crate::complex::ports_as_written;
use crate::discretization::Inputs;
use crate::error::{Code, Diagnostic, Span};
use crate::evaluate::transfer::MAX_ORDER;
use crate::evaluate::values::{BlockValues, Hold};
use crate::presupposed::{Presupposed, Presupposition};
use crate::refusals::NO_FIXED_ORDER;
use crate::symbols::Symbols;
use crate::text::names::shorten;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use std::cell::RefCell;

fn refused(code: Code, message: String, span: Span, label: &str) -> Diagnostic {
    Diagnostic::error(code, message).at(span, label)
}

/// The response of a block to its inputs over a span of time: `x(t) = state x + input u + slope w`, where the input goes
/// from `u` by `w` in a whole step.
struct Response {
    state: RationalMatrix,
    input: RationalMatrix,
    slope: RationalMatrix,
}

/// What a block does behind a hold or a modulator: in each sample the same, or in even samples and in odd ones. Without `symbols` a system
/// that passes on at once what the block does, for checks that need no more.
pub(crate) fn held(
    s: System,
    hold: &Hold,
    block: &BlockValues,
    set: &Substitution<'_>,
    symbols: Option<&RefCell<Symbols>>,
    budget: &Budget,
) -> Result<Vec<System>, NotConnected> {
    let (time, delay) = (substituted(&hold.time, set)?, substituted(&hold.delay, set)?);
    positive(&time, &delay, hold)?;
    let Some(symbols) = symbols else { return Ok(vec![stand_in(s, hold, &delay)]) };
    let mut symbols = symbols.borrow_mut();
    // Where only numbers are asked for the exponential stays whole.
    let stays_whole = symbols.keeps_flows();
    let mut making = Making { s: &s, hold, block, time, delay, symbols: &mut symbols, budget };
    let alternates = hold.pulses.iter().flatten().any(|pulse| pulse.alternates);
    let found = match hold.inputs {
        Inputs::Pulses if alternates => vec![making.behind_pulses(set, 0)?, making.behind_pulses(set, 1)?],
        Inputs::Pulses => vec![making.behind_pulses(set, 0)?],
        _ => vec![making.behind_hold()?],
    };
    let mut out = Vec::with_capacity(found.len());
    for (phi, aged) in found {
        let System { a, b, c, d } =
            Parts { phi, c: &s.c, direct: &s.d, aged, inputs: ports_as_written(block).0 }.system();
        let mut short = |m: RationalMatrix| if stays_whole { symbols.shortened(&m) } else { m };
        out.push(System { a: short(a), b: short(b), c: short(c), d: short(d) });
    }
    Ok(out)
}

/// How the inputs of an age, in samples, enter the next state, and what share of each passes on at once.
struct Aged {
    age: i64,
    enters: RationalMatrix,
    direct: Vec<RationalFunction>,
}

/// What is needed to say what a block does behind a hold.
struct Making<'a> {
    s: &'a System,
    hold: &'a Hold,
    block: &'a BlockValues,
    time: RationalFunction,
    delay: RationalFunction,
    symbols: &'a mut Symbols,
    budget: &'a Budget,
}

impl Making<'_> {
    /// The next state without inputs, and how inputs enter it.
    fn behind_hold(&mut self) -> Result<(RationalMatrix, Vec<Aged>), NotConnected> {
        let is_first_order = self.hold.inputs == Inputs::Straight;
        let delay = self.delay.clone();
        let (samples, fraction) = self.samples(&delay)?;
        let zeros = if is_first_order { 2 } else { 1 };
        // Nobody asks for the modes of exponentials that stay whole.
        let stays_whole = self.symbols.keeps_flows();
        let modes = if stays_whole { None } else { Some(Modes::of(&self.s.a, zeros, self.budget)?) };
        let mut respond = |share: &RationalFunction| self.response(modes.as_ref(), &(&self.time * share));
        let one = RationalFunction::one();
        // x+ = phi x + early u[k-m-1] + now u[k-m] + late u[k-m+1]
        let (phi, early, now, late) = if fraction.is_zero() {
            let r = respond(&one)?;
            (r.state, None, &r.input - &r.slope, Some(r.slope))
        } else if stays_whole && !is_first_order {
            // Sums in place of products of exponentials: u[k-m-1] acts during the whole step, and u[k-m] - u[k-m-1] from the switch
            // to its end.
            let (whole, second) = (respond(&one)?, respond(&(&one - &fraction))?);
            (whole.state, Some(&whole.input - &second.input), second.input, None)
        } else {
            let (first, second) = (respond(&fraction)?, respond(&(&one - &fraction))?);
            let share = |m: &RationalMatrix, c: &RationalFunction| m.scaled(c);
            let phi = product(&second.state, &first.state);
            if is_first_order {
                let early = product(&second.state, &(&share(&first.input, &fraction) - &first.slope));
                let now = product(&second.state, &(&share(&first.input, &(&one - &fraction)) + &first.slope));
                (phi, Some(early), &(&now + &second.input) - &second.slope, Some(second.slope))
            } else {
                (phi, Some(product(&second.state, &first.input)), second.input, None)
            }
        };
        // What passes on at once: the input at the sample.
        let (early_direct, now_direct) = match (fraction.is_zero(), is_first_order) {
            (true, _) => (RationalFunction::zero(), one),
            (false, false) => (one, RationalFunction::zero()),
            (false, true) => (fraction.clone(), &one - &fraction),
        };
        let (inputs, _) = ports_as_written(self.block);
        let aged = |age: usize, enters: RationalMatrix, direct: RationalFunction| Aged {
            age: age as i64,
            enters,
            direct: vec![direct; inputs],
        };
        let mut all = vec![aged(samples, now, now_direct)];
        if !fraction.is_zero() {
            all.extend(early.map(|early| aged(samples + 1, early, early_direct)));
        }
        if is_first_order {
            let late = late.map(|late| aged(samples, late, RationalFunction::zero()));
            all.extend(late.map(|late| Aged { age: late.age - 1, ..late }));
        }
        Ok((phi, all))
    }

    /// The same of inputs that are pulses, beside those that are held: an edge that stands `m + f` sample times behind a sample lets the
    /// input of `m` samples ago enter by `T exp(A (1 - f) T) B`.
    /// Where edges alternate, those count that were commanded at a sample of the parity that belongs to them; `parity` is that of
    /// the sample at which the period begins.
    fn behind_pulses(
        &mut self,
        set: &Substitution<'_>,
        parity: usize,
    ) -> Result<(RationalMatrix, Vec<Aged>), NotConnected> {
        let is_held = |j: usize| self.hold.pulses[j].is_none();
        let (n, inputs) = (self.s.a.rows(), ports_as_written(self.block).0);
        let of_held = if (0..inputs).any(is_held) { Some(self.behind_hold()?) } else { None };
        let modes = if self.symbols.keeps_flows() { None } else { Some(Modes::of(&self.s.a, 0, self.budget)?) };
        let (phi, mut all) = match of_held {
            Some(of_held) => of_held,
            None => (self.flow(modes.as_ref(), &self.time.clone())?, Vec::new()),
        };
        for part in &mut all {
            for j in (0..inputs).filter(|&j| !is_held(j)) {
                (0..n).for_each(|i| part.enters[(i, j)] = RationalFunction::zero());
                part.direct[j] = RationalFunction::zero();
            }
        }
        let one = RationalFunction::one();
        for (j, pulse) in self.hold.pulses.iter().enumerate() {
            let Some(pulse) = pulse else { continue };
            self.is_within_a_period(&substituted(&pulse.duty, set)?)?;
            let weight = RationalFunction::from(Rational::new(1.into(), (pulse.edges[0].len() as i64).into()));
            let column = self.s.b.block(0..n, j..j + 1).scaled(&(&self.time * &weight));
            let of_odd = if pulse.alternates { pulse.edges[1].as_slice() } else { &[] };
            let edges = pulse.edges[0].iter().map(|edge| (edge, 0)).chain(of_odd.iter().map(|edge| (edge, 1)));
            for (edge, commanded) in edges {
                let (samples, fraction) = self.place(substituted(edge, set)?)?;
                if fraction.is_zero() && !self.is_unseen(j) {
                    return Err(undefined(
                        format!("a sample stands on an edge of the pulse of '{}'", shorten(&self.block.name)),
                        self.hold.span,
                    ));
                }
                let direct = vec![RationalFunction::zero(); inputs];
                if pulse.alternates && (parity + samples) % 2 != commanded {
                    // It is remembered all the same, so that the states are those of the other samples.
                    all.push(Aged { age: samples as i64, enters: RationalMatrix::zeros(n, inputs), direct });
                    continue;
                }
                let rest = &self.time * &(&one - &fraction);
                let enters = product(&self.flow(modes.as_ref(), &rest)?, &column);
                let enters = RationalMatrix::from_fn(n, inputs, |i, k| match k == j {
                    true => enters[(i, 0)].clone(),
                    false => RationalFunction::zero(),
                });
                all.push(Aged { age: samples as i64, enters, direct });
            }
        }
        Ok((phi, all))
    }

    /// Refuses a duty ratio that is a number and not between 0 and 1.
    fn is_within_a_period(&self, duty: &RationalFunction) -> Result<(), NotConnected> {
        match duty.as_constant().filter(|duty| *duty <= Rational::ZERO || *duty >= Rational::ONE) {
            Some(duty) => Err(undefined(format!("duty {duty} of '{}'", shorten(&self.block.name)), self.hold.span)),
            None => Ok(()),
        }
    }

    /// How many whole samples an edge stands behind what commands it, and the fraction of one that is left; in a period it stands there.
    fn place(&mut self, edge: RationalFunction) -> Result<(usize, RationalFunction), NotConnected> {
        let whole =
            self.delay.checked_div(&self.time).and_then(|ratio| ratio.as_constant()).filter(Rational::is_integer);
        if let Some(whole) = whole.filter(|_| edge.as_constant().is_none()) {
            // As long as the duty ratio is between 0 and 1 it passes no sample.
            let (samples, _) = self.samples(&(&self.time * &whole.into()))?;
            return Ok((samples, edge));
        }
        let place = &self.delay + &(&self.time * &edge);
        self.samples(&place)
    }

    /// Whole samples and the fraction of one in the dead time. Where that varies against the sample time, the whole samples are
    /// those near the values that the symbols know of.
    fn samples(&mut self, delay: &RationalFunction) -> Result<(usize, RationalFunction), NotConnected> {
        let Making { hold, time, symbols, .. } = self;
        let name = shorten(&self.block.name);
        let ratio = delay.checked_div(time);
        let near = ratio.as_ref().and_then(|ratio| match ratio.as_constant() {
            Some(ratio) => Some(ratio),
            None => symbols.near_value(ratio).or_else(|| symbols.whole_part(ratio)),
        });
        let (Some(ratio), Some(near)) = (ratio, near) else {
            if hold.inputs == Inputs::Pulses {
                let message =
                    format!("an edge of the pulse of '{name}' may pass a sample: the loop has no fixed order");
                let error = Diagnostic::error(Code::Function, message).at(hold.span, "edge and dead time vary");
                let help = "set the duty ratio, or give a dead time of whole samples; 'intervals' may ask about either";
                return Err(NotConnected::Refused(Box::new(error.help(help))));
            }
            let error = NO_FIXED_ORDER.diagnostic(&[("name", &name)]);
            let error = error.at(hold.span, "the dead time varies against the sample time");
            return Err(NotConnected::Refused(Box::new(error)));
        };
        if symbols.moves(&ratio) {
            symbols.note_samples(&ratio);
        }
        let whole = near.floor();
        let fraction = &ratio - &RationalFunction::from(Rational::from(whole.clone()));
        match whole.to_i64().and_then(|m| usize::try_from(m).ok()).filter(|&m| m < MAX_ORDER) {
            Some(samples) => Ok((samples, fraction)),
            None => {
                let message = format!("the dead time of '{name}' is more than {MAX_ORDER} samples");
                Err(NotConnected::Refused(Box::new(refused(Code::Value, message, hold.span, "this hold"))))
            }
        }
    }

    /// The response over a span.
    fn response(&mut self, modes: Option<&Modes>, span: &RationalFunction) -> Result<Response, NotConnected> {
        let Making { s, hold, time, symbols, budget, .. } = self;
        let (n, m) = (s.a.rows(), s.b.columns());
        let is_first_order = hold.inputs == Inputs::Straight;
        let size = n + m * if is_first_order { 2 } else { 1 };
        let slope = time.recip().unwrap_or_default();
        let matrix = RationalMatrix::from_fn(size, size, |i, j| match (i < n, j) {
            (true, j) if j < n => s.a[(i, j)].clone(),
            (true, j) if j < n + m => s.b[(i, j - n)].clone(),
            // The input's own slope.
            (false, j) if j >= n + m && i + m == j => slope.clone(),
            _ => RationalFunction::zero(),
        });
        let whole = match modes {
            Some(modes) => modes.exponential(&matrix, span, symbols, budget)?,
            None => symbols.flow(&matrix, span),
        };
        let part = |from: usize, count: usize| RationalMatrix::from_fn(n, count, |i, j| whole[(i, from + j)].clone());
        let slope = if is_first_order { part(n + m, m) } else { RationalMatrix::zeros(n, m) };
        Ok(Response { state: part(0, n), input: part(n, m), slope })
    }

    /// Whether no output changes at an edge of an input: then a sample may stand on it.
    fn is_unseen(&self, j: usize) -> bool {
        let System { b, c, d, .. } = self.s;
        product(c, &b.block(0..b.rows(), j..j + 1)).entries().iter().all(RationalFunction::is_zero)
            && (0..d.rows()).all(|i| d[(i, j)].is_zero())
    }

    /// `exp(A t)`.
    fn flow(&mut self, modes: Option<&Modes>, time: &RationalFunction) -> Result<RationalMatrix, NotConnected> {
        match modes {
            _ if time.is_zero() => Ok(RationalMatrix::identity(self.s.a.rows())),
            Some(modes) => modes.exponential(&self.s.a, time, self.symbols, self.budget),
            None => Ok(self.symbols.flow(&self.s.a, time)),
        }
    }
}

/// Refuses times that cannot be: a sample time that is not positive, dead time that is negative.
fn positive(time: &RationalFunction, delay: &RationalFunction, hold: &Hold) -> Result<(), NotConnected> {
    let not_positive = |f: &RationalFunction| f.as_constant().is_some_and(|v| v.is_negative() || v.is_zero());
    let error = if not_positive(time) {
        let time = time.clone();
        Presupposition { of: Presupposed::SampleTime, function: time, span: hold.span }.not_positive()
    } else if delay.as_constant().is_some_and(|v| v.is_negative()) {
        refused(Code::Value, "dead time must not be negative".into(), hold.span, "this hold")
    } else {
        return Ok(());
    };
    Err(NotConnected::Refused(Box::new(error)))
}

fn stand_in(s: System, hold: &Hold, delay: &RationalFunction) -> System {
    let (n, inputs, outputs) = (s.a.rows(), s.b.columns(), s.c.rows());
    let is_pulse = |j: usize| matches!(hold.pulses.get(j), Some(Some(_)));
    let d = if !delay.is_zero() {
        RationalMatrix::zeros(s.d.rows(), s.d.columns())
    } else if hold.inputs == Inputs::Pulses {
        let held = |i: usize, j: usize| if is_pulse(j) { RationalFunction::zero() } else { s.d[(i, j)].clone() };
        RationalMatrix::from_fn(s.d.rows(), s.d.columns(), held)
    } else if hold.inputs == Inputs::Straight && n > 0 && inputs > 0 && outputs > 0 {
        &s.d + &product(&s.c, &s.b)
    } else {
        s.d.clone()
    };
    System { d, ..s }
}

/// `left * right`, also where one has no rows or columns.
fn product(left: &RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    if left.rows() == 0 || left.columns() == 0 || right.columns() == 0 {
        return RationalMatrix::zeros(left.rows(), right.columns());
    }
    left * right
}

/// The parts of a held block before its past inputs become states.
struct Parts<'s> {
    phi: RationalMatrix,
    c: &'s RationalMatrix,
    direct: &'s RationalMatrix,
    aged: Vec<Aged>,
    inputs: usize,
}

impl Parts<'_> {
    /// The system with states `x, u[k-1], .., u[k-past]`.
    fn system(self) -> System {
        let (n, m, outputs) = (self.phi.rows(), self.inputs, self.c.rows());
        // How many past inputs are states.
        let past = self.aged.iter().map(|part| part.age.max(0) as usize).max().unwrap_or(0);
        let size = n + past * m;
        let mut a = RationalMatrix::zeros(size, size);
        let mut b = RationalMatrix::zeros(size, m);
        let mut c = RationalMatrix::zeros(outputs, size);
        let mut d = RationalMatrix::zeros(outputs, m);
        let put = |to: &mut RationalMatrix, row: usize, column: usize, from: &RationalMatrix| {
            for i in 0..from.rows() {
                for j in 0..from.columns() {
                    let entry = &mut to[(row + i, column + j)];
                    *entry = &*entry + &from[(i, j)];
                }
            }
        };
        put(&mut a, 0, 0, &self.phi);
        put(&mut c, 0, 0, self.c);
        for Aged { age, enters, direct } in &self.aged {
            let direct = RationalMatrix::from_fn(outputs, m, |i, j| &self.direct[(i, j)] * &direct[j]);
            match *age {
                // The next sample is not there yet: the state is x minus its part, which comes later.
                -1 => {
                    put(&mut b, 0, 0, &product(&self.phi, enters));
                    put(&mut d, 0, 0, &product(self.c, enters));
                }
                0 => {
                    put(&mut b, 0, 0, enters);
                    put(&mut d, 0, 0, &direct);
                }
                age => {
                    let column = n + (age as usize - 1) * m;
                    put(&mut a, 0, column, enters);
                    put(&mut c, 0, column, &direct);
                }
            }
        }
        for i in 0..past * m {
            let one = RationalFunction::one();
            if i < m {
                b[(n + i, i)] = one;
            } else {
                a[(n + i, n + i - m)] = one;
            }
        }
        System { a, b, c, d }
    }
}
