//! A continuous block behind a hold, its inputs delayed by dead time: the exact discrete system.
//!
//! With dead time `(m + f) T` the input that acts in a step is that of samples `k - m - 1` (during `f T`) and `k - m`;
//! behind a first-order hold the next one as well [FranklinPowellWorkman1998]. Earlier samples are further states, named
//! after the block.

use super::exponential::Modes;
use super::state_space::{NotConnected, Substitution, System, substituted};
use crate::coverage::refusals::NO_FIXED_ORDER;
use crate::error::{Code, Diagnostic, Span};
use crate::model::evaluate::symbolic::{BlockValues, Hold};
use crate::model::evaluate::transfer::MAX_ORDER;
use crate::model::presupposed::{Presupposed, Presupposition};
use crate::model::symbols::Symbols;
use crate::model::text::names::shorten;
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

/// What a block does behind a hold. Without `symbols` a system that passes on at once what the block does, for checks that
/// need no more.
pub(in crate::model) fn held(
    s: System,
    hold: &Hold,
    block: &BlockValues,
    set: &Substitution<'_>,
    symbols: Option<&RefCell<Symbols>>,
    budget: &Budget,
) -> Result<System, NotConnected> {
    let (time, delay) = (substituted(&hold.time, set)?, substituted(&hold.delay, set)?);
    positive(&time, &delay, hold)?;
    let Some(symbols) = symbols else { return Ok(stand_in(s, hold, &delay)) };
    let mut symbols = symbols.borrow_mut();
    let (samples, fraction) = samples(&delay, &time, hold, block, &mut symbols)?;
    let zeros = if hold.is_first_order { 2 } else { 1 };
    // Where only numbers are asked for the exponential stays whole, and nobody asks for modes.
    let flows_stay_whole = symbols.keeps_flows();
    let modes = if flows_stay_whole { None } else { Some(Modes::of(&s.a, zeros, budget)?) };
    let mut respond =
        |share: &RationalFunction| response(&s, modes.as_ref(), &(&time * share), hold, &time, &mut symbols, budget);
    let one = RationalFunction::one();
    let (n, inputs) = (s.a.rows(), block.inputs.len());
    let none = || RationalMatrix::zeros(n, inputs);
    // x+ = phi x + early u[k-m-1] + now u[k-m] + late u[k-m+1]
    let (phi, early, now, late) = if fraction.is_zero() {
        let r = respond(&one)?;
        (r.state, none(), &r.input - &r.slope, r.slope)
    } else if flows_stay_whole && !hold.is_first_order {
        // Sums in place of products of exponentials: u[k-m-1] acts during the whole step, and u[k-m] - u[k-m-1] from the switch to its end.
        let (whole, second) = (respond(&one)?, respond(&(&one - &fraction))?);
        (whole.state, &whole.input - &second.input, second.input, none())
    } else {
        let (first, second) = (respond(&fraction)?, respond(&(&one - &fraction))?);
        let share = |m: &RationalMatrix, c: &RationalFunction| m.scaled(c);
        let phi = product(&second.state, &first.state);
        if hold.is_first_order {
            let early = product(&second.state, &(&share(&first.input, &fraction) - &first.slope));
            let now = product(&second.state, &(&share(&first.input, &(&one - &fraction)) + &first.slope));
            (phi, early, &(&now + &second.input) - &second.slope, second.slope)
        } else {
            (phi, product(&second.state, &first.input), second.input, none())
        }
    };
    // What passes on at once: the input at the sample.
    let (early_direct, now_direct) = match (fraction.is_zero(), hold.is_first_order) {
        (true, _) => (RationalFunction::zero(), one.clone()),
        (false, false) => (one.clone(), RationalFunction::zero()),
        (false, true) => (fraction.clone(), &one - &fraction),
    };
    let parts = Parts {
        phi,
        c: s.c,
        // By age of the input: -1 is the next sample.
        by_age: [(-1, late, RationalFunction::zero()), (0, now, now_direct), (1, early, early_direct)],
        direct: s.d,
        samples: samples as i64,
        past: samples + usize::from(!fraction.is_zero()),
        inputs,
    };
    let System { a, b, c, d } = parts.system();
    if !flows_stay_whole {
        return Ok(System { a, b, c, d });
    }
    let mut short = |m: &RationalMatrix| symbols.shortened(m);
    Ok(System { a: short(&a), b: short(&b), c: short(&c), d: short(&d) })
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
    let d = if !delay.is_zero() {
        RationalMatrix::zeros(s.d.rows(), s.d.columns())
    } else if hold.is_first_order && n > 0 && inputs > 0 && outputs > 0 {
        &s.d + &product(&s.c, &s.b)
    } else {
        s.d.clone()
    };
    System { d, ..s }
}

/// Whole samples and the fraction of one in the dead time. Where that varies against the sample time, the whole samples are
/// those near the values that the symbols know of.
fn samples(
    delay: &RationalFunction,
    time: &RationalFunction,
    hold: &Hold,
    block: &BlockValues,
    symbols: &mut Symbols,
) -> Result<(usize, RationalFunction), NotConnected> {
    let name = shorten(&block.name);
    let ratio = delay.checked_div(time);
    if let (Some(ratio), Some(whole)) = (&ratio, hold.whole) {
        return Ok((whole, ratio - &RationalFunction::from(whole as i64)));
    }
    let near = ratio.as_ref().and_then(|ratio| match ratio.as_constant() {
        Some(ratio) => Some(ratio),
        None => symbols.near_value(ratio),
    });
    let (Some(ratio), Some(near)) = (ratio, near) else {
        let error = NO_FIXED_ORDER.diagnostic(&[("name", &name)]);
        let error = error.at(hold.span, "the dead time varies against the sample time");
        return Err(NotConnected::Refused(Box::new(error)));
    };
    if ratio.as_constant().is_none() {
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
fn response(
    s: &System,
    modes: Option<&Modes>,
    span: &RationalFunction,
    hold: &Hold,
    step: &RationalFunction,
    symbols: &mut Symbols,
    budget: &Budget,
) -> Result<Response, NotConnected> {
    let (n, m) = (s.a.rows(), s.b.columns());
    let size = n + m * if hold.is_first_order { 2 } else { 1 };
    let slope = step.recip().unwrap_or_default();
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
    let slope = if hold.is_first_order { part(n + m, m) } else { RationalMatrix::zeros(n, m) };
    Ok(Response { state: part(0, n), input: part(n, m), slope })
}

/// `left * right`, also where one has no rows or columns.
fn product(left: &RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    if left.rows() == 0 || left.columns() == 0 || right.columns() == 0 {
        return RationalMatrix::zeros(left.rows(), right.columns());
    }
    left * right
}

/// The parts of a held block before its past inputs become states.
struct Parts {
    phi: RationalMatrix,
    c: RationalMatrix,
    /// For the age of an input against whole samples of delay: how it enters the next state, and what passes on at once.
    by_age: [(i64, RationalMatrix, RationalFunction); 3],
    direct: RationalMatrix,
    samples: i64,
    /// How many past inputs are states.
    past: usize,
    inputs: usize,
}

impl Parts {
    /// The system with states `x, u[k-1], .., u[k-past]`.
    fn system(self) -> System {
        let (n, m, outputs) = (self.phi.rows(), self.inputs, self.c.rows());
        let size = n + self.past * m;
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
        put(&mut c, 0, 0, &self.c);
        for (age, enters, share) in &self.by_age {
            let direct = self.direct.scaled(share);
            match self.samples + age {
                // The next sample is not there yet: the state is x minus its part, which comes later.
                -1 => {
                    put(&mut b, 0, 0, &product(&self.phi, enters));
                    put(&mut d, 0, 0, &product(&self.c, enters));
                }
                0 => {
                    put(&mut b, 0, 0, enters);
                    put(&mut d, 0, 0, &direct);
                }
                k if (k as usize) <= self.past => {
                    let column = n + (k as usize - 1) * m;
                    put(&mut a, 0, column, enters);
                    put(&mut c, 0, column, &direct);
                }
                // Only what is zero is older than the oldest input that is kept.
                _ => {}
            }
        }
        for i in 0..self.past * m {
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
