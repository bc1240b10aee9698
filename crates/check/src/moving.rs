//! Numbers that depend on the parameters of a box: functions in expressions, and what a block does behind a hold.
//!
//! In polynomials each is a variable behind the parameters of the box. Over a box they are [`Taylor`] models.

use super::clock::Clock;
use super::multivariate::{Fraction, Multi};
use super::number::{Q, Z};
use super::over_symbols::substituted;
use super::taylor::{Precision, Taylor};
use num_traits::{One, Signed, Zero};

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
    /// The matrices [`HeldMatrix`] of a hold, row by row.
    Hold {
        a: Vec<Vec<F>>,
        time: F,
        share: Q,
        matrices: Vec<HeldMatrix>,
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
                Source::Hold { a, time, share, matrices } => Source::Hold {
                    a: a.iter().map(|row| row.iter().map(quotient).collect()).collect::<Result<_, _>>()?,
                    time: quotient(time)?,
                    share: share.clone(),
                    matrices: matrices.clone(),
                },
            });
        }
        Ok(Sources(sources))
    }
}

/// Numerator and denominator.
#[derive(Clone, Debug, PartialEq)]
struct Quotient(Multi, Multi);

/// What the variables behind the parameters of a box stand for, in order.
pub(super) struct Sources(Vec<Source<Quotient>>);

type Matrix = Vec<Vec<Taylor>>;

impl Sources {
    pub fn none() -> Self {
        Sources(Vec::new())
    }

    pub fn have_dead_time(&self) -> bool {
        self.0.iter().any(|source| matches!(source, Source::Delay(_)))
    }

    /// The dead times that the variables stand for, as numerators and denominators.
    pub fn dead_times(&self) -> Result<Vec<(&Multi, &Multi)>, String> {
        let time = |source| match source {
            &Source::Delay(Quotient(ref top, ref below)) => Ok((top, below)),
            _ => Err("beside dead time the loop has other functions".to_owned()),
        };
        self.0.iter().map(time).collect()
    }

    /// The parameters and all the other variables over a box.
    pub fn values(&self, parameters: Vec<Taylor>, p: &Precision, clock: &Clock) -> Result<Vec<Taylor>, String> {
        let mut known = parameters;
        for source in &self.0 {
            let new = match source {
                Source::Pi => vec![pi(p)],
                Source::Of(function, f) => vec![function.at(f.over(&known, p, clock)?, p, clock)?],
                Source::Delay(_) => return Err("internal: a dead time is no number".into()),
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
            };
            known.extend(new);
        }
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
fn value(f: &Multi, known: &[Taylor], p: &Precision, clock: &Clock) -> Result<Taylor, String> {
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
        let turned = |x: Taylor| -> Result<[Taylor; 2], String> {
            let m = vec![vec![Taylor::zero(), x.clone()], vec![x.scaled(&-Z::one()), Taylor::zero()]];
            let [mut whole, ..] = exponential(&m, p, clock)?;
            let mut first = whole.swap_remove(0);
            let sine = first.pop().unwrap_or_else(Taylor::zero);
            Ok([first.pop().unwrap_or_else(Taylor::zero), sine])
        };
        Ok(match self {
            Function::Root => x.root(p, clock)?,
            Function::Exponential => {
                let [mut whole, ..] = exponential(&vec![vec![x]], p, clock)?;
                whole.swap_remove(0).swap_remove(0)
            }
            Function::Sine => turned(x)?[1].clone(),
            Function::Cosine => turned(x)?[0].clone(),
            Function::Tangent => {
                let [cosine, sine] = turned(x)?;
                sine.times(&cosine.inverse(p, clock)?, p, clock)?
            }
        })
    }
}

/// The circle number by Machin's formula, `16 atan(1/5) - 4 atan(1/239)`.
pub(super) fn pi(p: &Precision) -> Taylor {
    // 64 bits more than are asked for, so that no rounding is seen in them.
    let one = Z::one() << (p.bits + 64);
    let inverse_tangent = |n: u32| {
        let (mut power, mut sum, mut k) = (&one / n, Z::zero(), 1_u32);
        while !power.is_zero() {
            let term = &power / k;
            sum = if k % 4 == 1 { sum + term } else { sum - term };
            power /= n * n;
            k += 2;
        }
        sum
    };
    Taylor::units((inverse_tangent(5) * 16 - inverse_tangent(239) * 4) >> 64_usize, Z::from(2))
}

fn product(a: &Matrix, b: &Matrix, p: &Precision, clock: &Clock) -> Result<Matrix, String> {
    let n = a.len();
    let mut out = vec![vec![Taylor::zero(); n]; n];
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                out[i][j] = out[i][j].plus(&a[i][k].times(&b[k][j], p, clock)?);
            }
        }
    }
    Ok(out)
}

fn mapped(a: &Matrix, f: impl Fn(&Taylor) -> Taylor) -> Matrix {
    a.iter().map(|row| row.iter().map(&f).collect()).collect()
}

fn plus(a: &Matrix, b: &Matrix) -> Matrix {
    a.iter().zip(b).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x.plus(y)).collect()).collect()
}

fn minus(a: &Matrix, b: &Matrix) -> Matrix {
    plus(a, &mapped(b, |x| x.scaled(&-Z::one())))
}

fn by(a: &Matrix, factor: &Taylor, p: &Precision, clock: &Clock) -> Result<Matrix, String> {
    a.iter().map(|row| row.iter().map(|x| x.times(factor, p, clock)).collect()).collect()
}

fn by_number(a: &Matrix, q: &Q) -> Matrix {
    mapped(a, |x| x.scaled(q.numer()).over(q.denom()))
}

/// `sum M^k/k!`, `sum M^k/(k + 1)!` and `sum M^k/(k + 2)!`: of `M/2^s`, with rows that add up to at most `2^-8`, then doubled `s` times.
fn exponential(m: &Matrix, p: &Precision, clock: &Clock) -> Result<[Matrix; 3], String> {
    let n = m.len();
    let norm = m.iter().map(|row| row.iter().map(Taylor::magnitude).sum::<Z>()).max().unwrap_or_default();
    let eighth = Z::one() << (p.bits - 8);
    let mut doublings = 0_usize;
    while (&norm >> doublings) >= eighth {
        doublings += 1;
        if doublings > 64 {
            return Err("an exponent is too large to be enclosed".into());
        }
    }
    let m = mapped(m, |x| x.halved(doublings));
    let one = Taylor::number(&Q::one(), p);
    let unit: Matrix =
        (0..n).map(|i| (0..n).map(|j| if i == j { one.clone() } else { Taylor::zero() }).collect()).collect();
    // The terms M^k/k!, and their sums divided by 1, k + 1, and (k + 1)(k + 2).
    let mut term = unit.clone();
    let mut sums = [unit.clone(), unit.clone(), mapped(&unit, |x| x.over(&Z::from(2)))];
    let (mut k, mut bound) = (0_usize, Z::one());
    while bound <= Z::one() << p.bits {
        k += 1;
        bound = (bound * Z::from(k)) << 8;
        term = mapped(&product(&term, &m, p, clock)?, |x| x.over(&Z::from(k)));
        let divisors = [1, k + 1, (k + 1) * (k + 2)];
        for (sum, divisor) in sums.iter_mut().zip(divisors) {
            *sum = plus(sum, &mapped(&term, |x| x.over(&Z::from(divisor))));
        }
    }
    // What is left out is below twice one over the bound, which is less than a unit.
    for x in sums.iter_mut().flatten().flatten() {
        x.rest += 2;
    }
    let [mut whole, mut first, mut second] = sums;
    for _ in 0..doublings {
        second = mapped(&plus(&plus(&second, &first), &product(&whole, &second, p, clock)?), |x| x.halved(2));
        first = mapped(&plus(&first, &product(&whole, &first, p, clock)?), |x| x.halved(1));
        whole = product(&whole, &whole, p, clock)?;
    }
    Ok([whole, first, second])
}

/// The entries of the matrices of a hold.
fn held(
    a: &Matrix,
    time: &Taylor,
    share: &Q,
    matrices: &[HeldMatrix],
    p: &Precision,
    clock: &Clock,
) -> Result<Vec<Taylor>, String> {
    // F, G and H over a share of the sample time.
    let over = |share: &Q| -> Result<[Matrix; 3], String> {
        let span = time.scaled(share.numer()).over(share.denom());
        let [whole, first, second] = exponential(&by(a, &span, p, clock)?, p, clock)?;
        Ok([whole, by(&first, &span, p, clock)?, by_number(&by(&second, &span, p, clock)?, share)])
    };
    let rest = Q::one() - share;
    let ([s0, s1, s2], late) = (over(&rest)?, if share.is_zero() { None } else { Some(over(share)?) });
    let then = |late: &Matrix| product(&s0, late, p, clock);
    let mut out = Vec::new();
    for kind in matrices {
        let matrix = match (kind, &late) {
            (HeldMatrix::State, None) => s0.clone(),
            (HeldMatrix::State, Some([r0, ..])) => then(r0)?,
            (HeldMatrix::Now, _) => s1.clone(),
            (HeldMatrix::LateOfRamp, _) => s2.clone(),
            (HeldMatrix::NowOfRamp, None) => minus(&s1, &s2),
            (HeldMatrix::NowOfRamp, Some([_, r1, r2])) => {
                plus(&then(&plus(&by_number(r1, &rest), r2))?, &minus(&s1, &s2))
            }
            (HeldMatrix::Early, Some([_, r1, _])) => then(r1)?,
            (HeldMatrix::EarlyOfRamp, Some([_, r1, r2])) => then(&minus(&by_number(r1, share), r2))?,
            (HeldMatrix::Early | HeldMatrix::EarlyOfRamp, None) => return Err("internal: nothing is late".into()),
        };
        out.extend(matrix.into_iter().flatten());
    }
    Ok(out)
}

#[cfg(test)]
mod tests;
