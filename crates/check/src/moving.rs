//! Numbers that depend on the parameters of a box: functions in expressions, and what a block does behind a hold.
//!
//! In polynomials each is a variable behind the parameters of the box. Over a box they are [`Taylor`] models.

mod exponential;

use super::clock::Clock;
use super::interval::Interval;
use super::multivariate::{Fraction, Multi};
use super::number::Q;
use super::over_symbols::substituted;
use super::taylor::{Precision, Taylor};
use exponential::{Matrix, exponential, flow, held, prewarped};
pub(super) use exponential::{pi, turned};
use num_traits::{One, Signed};

/// A function that expressions know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Root,
    Exponential,
    Sine,
    Cosine,
    Tangent,
}

impl Function {
    pub fn named(name: &str) -> Option<Function> {
        Some(match name {
            "sqrt" => Function::Root,
            "exp" => Function::Exponential,
            "sin" => Function::Sine,
            "cos" => Function::Cosine,
            "tan" => Function::Tangent,
            _ => return None,
        })
    }
}

/// What one or several variables stand for. A quotient is its numerator and its denominator.
#[derive(Clone, Debug, PartialEq)]
enum Source<F> {
    Pi,
    Of(Function, F),
    /// `exp(-T s)` of a dead time `T`.
    Delay(F),
    /// The factor of Tustin's rule that is exact at a frequency.
    Prewarp {
        frequency: F,
        time: F,
    },
    /// The matrices [`HeldMatrix`] of a hold, row by row.
    Hold {
        a: Vec<Vec<F>>,
        time: F,
        share: Q,
        matrices: Vec<HeldMatrix>,
    },
    /// `exp(A r T)`, row by row, where the duty ratio of a modulator is between 0 and 1.
    Flow {
        a: Vec<Vec<F>>,
        time: F,
        rest: F,
        duty: F,
    },
}

/// A matrix of a block behind a hold, with `A`, the sample time `T` and the share `f` of it by which the input comes late. With
/// `F(t) = exp(A t)`, `G(t)` its integral from 0 and `H(t)` that one's over `T`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HeldMatrix {
    /// `F(T)`.
    State,
    /// `G((1 - f) T)`: of a constant input what enters at once.
    Now,
    /// `F((1 - f) T) G(f T)`: of a constant input what enters a sample later.
    Early,
    /// `F((1 - f) T) ((1 - f) G(f T) + H(f T)) + G((1 - f) T) - H((1 - f) T)`: of a ramp.
    NowOfRamp,
    /// `H((1 - f) T)`.
    LateOfRamp,
    /// `F((1 - f) T) (f G(f T) - H(f T))`.
    EarlyOfRamp,
}

/// All of them in the order of their variables.
pub(super) struct Moving {
    /// The number of the next variable.
    next: usize,
    /// Whether the loop's variable is `s`, so that it may have dead time.
    is_continuous: bool,
    sources: Vec<(usize, Source<Fraction>)>,
}

impl Moving {
    pub fn new(first: usize, is_continuous: bool) -> Self {
        Moving { next: first, is_continuous, sources: Vec::new() }
    }

    pub fn is_continuous(&self) -> bool {
        self.is_continuous
    }

    fn variables(&mut self, source: Source<Fraction>, count: usize) -> usize {
        if let Some((known, _)) = self.sources.iter().find(|(_, s)| *s == source) {
            return *known;
        }
        let first = self.next;
        self.next += count;
        self.sources.push((first, source));
        first
    }

    pub fn pi(&mut self) -> Fraction {
        Fraction::variable(self.variables(Source::Pi, 1))
    }

    /// A function of something without the loop's variable, or `exp` of `s` times a dead time.
    pub fn of(&mut self, function: Function, argument: Fraction) -> Result<Fraction, String> {
        if argument.numerator.degree(0) > 0 || argument.denominator.degree(0) > 0 {
            let mut powers = argument.numerator.coefficients(0);
            let slope = powers.pop().filter(|_| powers.len() == 1 && powers[0].is_zero());
            return match slope.filter(|_| argument.denominator.degree(0) == 0) {
                Some(slope) if self.is_continuous && function == Function::Exponential => {
                    self.delayed(Fraction { numerator: slope, ..argument }.negated())
                }
                _ => Err("a function of the loop's variable".into()),
            };
        }
        Ok(Fraction::variable(self.variables(Source::Of(function, argument), 1)))
    }

    /// `exp(-T s)`.
    pub fn delayed(&mut self, time: Fraction) -> Result<Fraction, String> {
        if time.as_number().is_some_and(|time| time.is_negative()) {
            return Err("a negative dead time".into());
        }
        Ok(Fraction::variable(self.variables(Source::Delay(time), 1)))
    }

    /// The factor of Tustin's rule that is exact at a frequency, as a variable.
    pub fn prewarped(&mut self, frequency: &Fraction, time: &Fraction) -> Fraction {
        let source = Source::Prewarp { frequency: frequency.clone(), time: time.clone() };
        Fraction::variable(self.variables(source, 1))
    }

    /// The matrices of a hold, as variables.
    pub fn held(
        &mut self,
        a: &[Vec<Fraction>],
        time: &Fraction,
        share: &Q,
        matrices: Vec<HeldMatrix>,
    ) -> Vec<Vec<Vec<Multi>>> {
        let (n, count) = (a.len(), matrices.len());
        let source = Source::Hold { a: a.to_vec(), time: time.clone(), share: share.clone(), matrices };
        let first = self.variables(source, count * n * n);
        let entry = |k: usize, i: usize, j: usize| Multi::variable(first + (k * n + i) * n + j);
        (0..count).map(|k| (0..n).map(|i| (0..n).map(|j| entry(k, i, j)).collect()).collect()).collect()
    }

    /// `exp(A r T)` for the rest `r` of a sample time behind an edge of a pulse with this duty ratio, as variables.
    pub fn flow(&mut self, a: &[Vec<Fraction>], time: &Fraction, rest: &Fraction, duty: &Fraction) -> Vec<Vec<Multi>> {
        let n = a.len();
        let source = Source::Flow { a: a.to_vec(), time: time.clone(), rest: rest.clone(), duty: duty.clone() };
        let first = self.variables(source, n * n);
        (0..n).map(|i| (0..n).map(|j| Multi::variable(first + i * n + j)).collect()).collect()
    }

    /// With values for the parameters: these variables are left out, so that others come before.
    pub fn with_values(self, values: &[Q], clock: &Clock) -> Result<Sources, String> {
        let quotient = |f: &Fraction| -> Result<Quotient, String> {
            let mut both = substituted(&[f.numerator.clone(), f.whole_denominator(clock)?], values, clock)?;
            let below = both.pop().unwrap_or_default();
            Ok(Quotient(both.pop().unwrap_or_default(), below))
        };
        let mut sources = Vec::with_capacity(self.sources.len());
        for (_, source) in &self.sources {
            sources.push(match source {
                Source::Pi => Source::Pi,
                Source::Of(function, f) => Source::Of(*function, quotient(f)?),
                Source::Delay(f) => Source::Delay(quotient(f)?),
                Source::Prewarp { frequency, time } => {
                    Source::Prewarp { frequency: quotient(frequency)?, time: quotient(time)? }
                }
                Source::Hold { a, time, share, matrices } => Source::Hold {
                    a: a.iter().map(|row| row.iter().map(quotient).collect()).collect::<Result<_, _>>()?,
                    time: quotient(time)?,
                    share: share.clone(),
                    matrices: matrices.clone(),
                },
                Source::Flow { a, time, rest, duty } => Source::Flow {
                    a: a.iter().map(|row| row.iter().map(quotient).collect()).collect::<Result<_, _>>()?,
                    time: quotient(time)?,
                    rest: quotient(rest)?,
                    duty: quotient(duty)?,
                },
            });
        }
        Ok(Sources { functions: sources, numbers: Vec::new() })
    }
}

/// Numerator and denominator.
#[derive(Clone, Debug, PartialEq)]
struct Quotient(Multi, Multi);

/// What the variables behind the parameters of a box stand for, in order.
#[derive(Default)]
pub(super) struct Sources {
    functions: Vec<Source<Quotient>>,
    /// Enclosed coefficients: the check knows no formula of them. Their unit is the one of the functions.
    numbers: Vec<Interval>,
}

impl Sources {
    /// How many variables there are.
    pub fn len(&self) -> usize {
        let count = |source: &Source<Quotient>| match source {
            Source::Pi | Source::Of(..) | Source::Delay(_) | Source::Prewarp { .. } => 1,
            Source::Hold { a, matrices, .. } => matrices.len() * a.len() * a.len(),
            Source::Flow { a, .. } => a.len() * a.len(),
        };
        self.functions.iter().map(count).sum::<usize>() + self.numbers.len()
    }

    /// With further variables.
    pub fn with_numbers(self, numbers: Vec<Interval>) -> Self {
        Sources { numbers, ..self }
    }

    pub fn have_dead_time(&self) -> bool {
        self.functions.iter().any(|source| matches!(source, Source::Delay(_)))
    }

    /// The dead times that variables stand for: the place of each among all variables, numerator and denominator. What else there is depends on none.
    pub fn dead_times(&self) -> Result<Vec<(usize, &Multi, &Multi)>, String> {
        let is_single = |source| matches!(source, &Source::Pi | &Source::Of(..) | &Source::Delay(_));
        if !self.numbers.is_empty() || !self.functions.iter().all(is_single) {
            return Err("beside dead time the loop has several rates, or a hold".to_owned());
        }
        let time = |(place, source)| match source {
            &Source::Delay(Quotient(ref top, ref below)) => Some((place, top, below)),
            _ => None,
        };
        Ok(self.functions.iter().enumerate().filter_map(time).collect())
    }

    /// Whether a function is one of what has these variables in it.
    pub fn are_inside(&self, variables: &[usize]) -> bool {
        self.functions.iter().any(|source| match source {
            Source::Of(_, Quotient(top, below)) => variables.iter().any(|&v| top.degree(v) + below.degree(v) > 0),
            _ => false,
        })
    }

    /// The parameters and all the other variables over a box.
    pub fn values(&self, parameters: Vec<Taylor>, p: &Precision, clock: &Clock) -> Result<Vec<Taylor>, String> {
        let mut known = parameters;
        for source in &self.functions {
            let new = match source {
                Source::Pi => vec![pi(p)],
                Source::Of(function, f) => vec![function.at(f.over(&known, p, clock)?, p, clock)?],
                // No number: polynomials are sorted by it before they have values.
                Source::Delay(_) => vec![Taylor::zero()],
                Source::Prewarp { frequency, time } => {
                    let (w, time) = (frequency.over(&known, p, clock)?, time.over(&known, p, clock)?);
                    vec![prewarped(&w, &time, p, clock)?]
                }
                Source::Hold { a, time, share, matrices } => {
                    let a: Matrix = a
                        .iter()
                        .map(|row| row.iter().map(|f| f.over(&known, p, clock)).collect())
                        .collect::<Result<_, _>>()?;
                    let time = time.over(&known, p, clock)?;
                    if time.sign() != Some(true) {
                        return Err("a sample time is not shown to be positive".into());
                    }
                    held(&a, &time, share, matrices, p, clock)?
                }
                Source::Flow { a, time, rest, duty } => {
                    let a: Matrix = a
                        .iter()
                        .map(|row| row.iter().map(|f| f.over(&known, p, clock)).collect())
                        .collect::<Result<_, _>>()?;
                    let [time, rest, duty] = [time, rest, duty].map(|f| f.over(&known, p, clock));
                    let (time, duty) = (time?, duty?);
                    if time.sign() != Some(true) {
                        return Err("a sample time is not shown to be positive".into());
                    }
                    let pause = Taylor::number(&Q::one(), p).minus(&duty);
                    if duty.sign() != Some(true) || pause.sign() != Some(true) {
                        return Err("a duty ratio is not shown to be between 0 and 1".into());
                    }
                    flow(&a, &time.times(&rest?, p, clock)?, p, clock)?
                }
            };
            known.extend(new);
        }
        known.extend(self.numbers.iter().map(Taylor::enclosing));
        Ok(known)
    }
}

impl Quotient {
    fn over(&self, known: &[Taylor], p: &Precision, clock: &Clock) -> Result<Taylor, String> {
        let (top, below) = (value(&self.0, known, p, clock)?, value(&self.1, known, p, clock)?);
        if let (true, Some(c)) = (self.1.is_constant(), self.1.0.values().next())
            && c.is_positive()
        {
            return Ok(top.over(c));
        }
        top.times(&below.inverse(p, clock)?, p, clock)
    }
}

/// A polynomial in the variables from [`FIRST`](super::over_box::FIRST) on.
pub(super) fn value(f: &Multi, known: &[Taylor], p: &Precision, clock: &Clock) -> Result<Taylor, String> {
    let mut sum = Taylor::zero();
    for (e, c) in &f.0 {
        let mut term = Taylor::number(&Q::one(), p);
        for (x, &k) in known.iter().zip(e.iter().skip(super::over_box::FIRST)) {
            for _ in 0..k {
                term = term.times(x, p, clock)?;
            }
        }
        sum.add_scaled(&term, c);
    }
    Ok(sum)
}

impl Function {
    fn at(self, x: Taylor, p: &Precision, clock: &Clock) -> Result<Taylor, String> {
        Ok(match self {
            Function::Root => x.root(p, clock)?,
            Function::Exponential => {
                let [mut whole, ..] = exponential(&vec![vec![x]], p, clock)?;
                whole.swap_remove(0).swap_remove(0)
            }
            Function::Sine => turned(x, p, clock)?[1].clone(),
            Function::Cosine => turned(x, p, clock)?[0].clone(),
            Function::Tangent => {
                let [cosine, sine] = turned(x, p, clock)?;
                sine.times(&cosine.inverse(p, clock)?, p, clock)?
            }
        })
    }
}

/// `exp(x)` of a number.
pub(super) fn exponential_of(x: &Q, p: &Precision, clock: &Clock) -> Result<Taylor, String> {
    Function::Exponential.at(Taylor::number(x, p), p, clock)
}

#[cfg(test)]
mod tests;
