//! The duty ratio of the periodic orbit, `duty = "steady"`: a number with enclosures of any width.
//!
//! The equation is that of [`Orbit`]. Its left side falls in the duty ratio wherever its slope is shown to be negative, so that there is one
//! solution; it is between 0 and 1 if the mean over a period is.

use super::connect::orbit::{Orbit, orbit};
use super::connect::state_space::{Connecting, NotConnected};
use super::definition::Model;
use super::evaluated::Answer;
use super::symbols::{Symbols, beside, quotient_at};
use super::text::names::{list, shorten};
use crate::error::{Code, Diagnostic, Diagnostics, Error};
use crate::precisions::STEADY_DUTY;
use jurist_algebra::ball::{Ball, BallMatrix, exponential};
use jurist_algebra::limits::{Budget, Stop, checkpoint, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign, to_decimal};
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::real::{Enclosing, Origin, Transcendental};
use jurist_algebra::symbols::{DutyRatio, EnclosedNumber};
use std::cell::RefCell;

/// Work that exact functions of the plant's constants may take before its exponentials stay whole.
const WORK_BEFORE: u64 = 30_000_000;

/// A bracket of the duty ratio is halved so often before the slope has to show its sign.
const MOST_HALVINGS: u64 = 12;

/// The norm of a plant's matrix times the period up to which an orbit is looked for: the exponential of more has some ten thousand bits, and
/// of a billion more than there is memory.
const MOST_EXPONENT: i64 = 1 << 14;

/// Bits beside those that are asked for.
const GUARD_BITS: u64 = 64;

/// What the duty ratio of the loop at rest is.
pub(crate) enum SteadyDuty {
    /// It is not asked for.
    Any,
    /// This number.
    Number(EnclosedNumber),
    /// This function of the kept names, over symbols of its own.
    Moving(Box<(DutyRatio, Symbols)>),
}

/// Where nothing asks for a duty ratio.
pub(crate) fn no_duty() -> Result<SteadyDuty, Error> {
    Err(Error::Undefined("the duty ratio of the loop at rest is not looked for".into()))
}

/// The equation where all names have values: symbol `i` is variable `i`.
#[derive(Debug)]
struct Equation {
    symbols: Symbols,
    mean: RationalFunction,
    answers: Vec<RationalFunction>,
    /// `[A b; 0 0]`, row by row.
    plant: Vec<RationalFunction>,
    time: RationalFunction,
    late: Rational,
    /// Twice the ends of the parts of the pulse, `[begin, slope]` each.
    parts: Vec<[[i64; 2]; 2]>,
}

impl Model {
    /// The duty ratio of the loop at rest with the inputs of `[simulation]`.
    ///
    /// Cost: that of the closed loop behind a hold, a linear system of its order, and exponentials of the plant's matrix.
    ///
    /// # Errors
    /// Undefined where the duty ratio is not between 0 and 1; refused (`E-duty`) where it depends on a kept name, or is not unique.
    pub(crate) fn steady_duty(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<SteadyDuty, Error> {
        let share = budget.clone().within_work(WORK_BEFORE);
        let (orbit, symbols) = match self.orbit(kept, given, false, &share) {
            Err(Error::Stopped(stopped)) if matches!(stopped.stop, Stop::Work(_)) && budget.check().is_ok() => {
                self.orbit(kept, given, true, budget)?
            }
            found => found?,
        };
        let refused = |message: String, help: &str| -> Error {
            let error = Diagnostic::error(Code::Duty, message).at(orbit.span, "duty = \"steady\"").help(help);
            Diagnostics::new(Some(self.source().clone()), vec![error]).into()
        };
        let block = shorten(&orbit.block).into_owned();
        let fixed = symbols.of_fixed().filter(|_| !orbit.functions().any(|f| symbols.moves(f)));
        let Some(fixed) = fixed else {
            if orbit.late.is_zero() && !symbols.keeps_flows() {
                return Ok(SteadyDuty::Moving(Box::new((orbit.moving(budget)?, symbols))));
            }
            let names = list(kept.iter().map(String::as_str));
            return Err(refused(
                format!(
                    "the duty ratio of '{block}' at rest depends on {names}, and its pulse begins between samples: this is not solved"
                ),
                "set what moves it (--set), or write the duty ratio as an expression from the mean over a period, such as duty = \"V_0/K_pwm\"",
            ));
        };
        let equation =
            Equation::of(&orbit, fixed, symbols.first()).ok_or_else(|| Error::Undefined("a divisor is zero".into()))?;
        if equation.is_long() {
            let why = format!(
                "the duty ratio of the orbit of '{block}' is not looked for: in one period its states may change by more than exp({MOST_EXPONENT})"
            );
            return Err(refused(why, "choose a shorter period, or write the duty ratio as a number or an expression"));
        }
        equation.is_between(&block)?;
        let Some(bracket) = equation.bracket() else {
            let why = format!("the orbit of '{block}' may not be the only one");
            return Err(refused(
                why,
                "give the duty ratio as a number: 'jurist simulate --switched --steady' shows it",
            ));
        };
        let words = format!("the duty ratio of '{block}' at rest");
        let value = Transcendental::within(equation, bracket);
        Ok(SteadyDuty::Number(EnclosedNumber { words, value }))
    }

    /// The duty ratio that the mean over a period has, where it is a function of the kept names alone; `None` where it is not.
    ///
    /// # Errors
    /// As [`Model::steady_duty`].
    pub(super) fn mean_duty(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<RationalFunction>, Error> {
        let (orbit, symbols) = self.orbit(kept, given, false, budget)?;
        let is_known = orbit.mean.variables().last().is_none_or(|last| *last < symbols.first());
        Ok(is_known.then_some(orbit.mean))
    }

    fn orbit(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        stays_whole: bool,
        budget: &Budget,
    ) -> Result<(Orbit, Symbols), Error> {
        let any = || Ok(SteadyDuty::Any);
        let mut answer = self.answer_with(kept, given, &any, budget)?;
        if stays_whole {
            answer.symbols = RefCell::new(answer.symbols.into_inner().keeping_flows());
        }
        let Answer { mut wiring, mut values, images, symbols, .. } = answer;
        let set = |f: &RationalFunction| super::evaluated::substituted(f, &images);
        let how = Connecting { set: &set, symbols: Some(&symbols), start: None, budget };
        let found = budget.enter(|| orbit(self, &mut wiring, &mut values, &how))?;
        let found = found.map_err(|why: NotConnected| self.not_connected(why))?;
        Ok((found, symbols.into_inner()))
    }
}

impl Orbit {
    fn functions(&self) -> impl Iterator<Item = &RationalFunction> {
        let lists = self.answers.iter().chain(&self.b).chain(self.a.entries());
        [&self.mean, &self.time].into_iter().chain(lists)
    }
}

impl Orbit {
    /// The duty ratio as a function of the names and symbols that the orbit has.
    fn moving(&self, budget: &Budget) -> Result<DutyRatio, Error> {
        let mut polynomial = self.a.characteristic_polynomial(Vec::new(), budget)?.coefficients;
        polynomial.pop();
        let n = self.a.rows();
        let mut row = self.answers.clone();
        let mut weights = Vec::with_capacity(n + 1);
        for _ in 0..=n {
            budget.check()?;
            let dot = |column: &mut dyn Iterator<Item = &RationalFunction>| {
                row.iter().zip(column).fold(RationalFunction::zero(), |sum, (x, y)| &sum + &(x * y))
            };
            weights.push(dot(&mut self.b.iter()));
            row = (0..n).map(|j| dot(&mut (0..n).map(|i| &self.a[(i, j)]))).collect();
        }
        let (mean, time) = (self.mean.clone(), self.time.clone());
        Ok(DutyRatio { mean, weights, polynomial, time, parts: self.edges.parts().collect() })
    }
}

impl Equation {
    /// `None` where a function of what is kept is left.
    fn of(orbit: &Orbit, symbols: Symbols, kept: usize) -> Option<Equation> {
        let moved = |f: &RationalFunction| beside(f, kept);
        let n = orbit.a.rows();
        let mut plant = Vec::with_capacity((n + 1) * (n + 1));
        for i in 0..=n {
            for j in 0..=n {
                plant.push(match (i < n, j < n) {
                    (true, true) => moved(&orbit.a[(i, j)])?,
                    (true, false) => moved(&orbit.b[i])?,
                    (false, _) => RationalFunction::zero(),
                });
            }
        }
        Some(Equation {
            symbols,
            mean: moved(&orbit.mean)?,
            answers: orbit.answers.iter().map(moved).collect::<Option<_>>()?,
            plant,
            time: moved(&orbit.time)?,
            late: orbit.late.clone(),
            parts: orbit.edges.parts().collect(),
        })
    }

    /// Refuses a mean over a period that is not between 0 and 1.
    ///
    /// # Errors
    /// Undefined, with the duty ratio that would be needed.
    fn is_between(&self, block: &str) -> Result<(), Error> {
        let one = RationalFunction::one();
        let outside = |value: String| Err(Error::Undefined(format!("duty {value} of '{block}'")));
        if let Some(mean) = self.mean.as_constant() {
            let is_inside = mean > Rational::ZERO && mean < Rational::ONE;
            return if is_inside { Ok(()) } else { outside(mean.to_string()) };
        }
        if self.mean.is_zero() || self.mean == one {
            return outside(if self.mean.is_zero() { "0" } else { "1" }.to_owned());
        }
        let found = STEADY_DUTY.decide("the duty ratio at rest beside 0 and 1", |bits| {
            let Some(values) = self.symbols.enclosed(bits) else { return Ok::<_, Error>(None) };
            let Some(mean) = quotient_at(&self.mean, &values, bits) else { return Ok(None) };
            let rest = Ball::from_integer(&Integer::ONE, bits).sub(&mean);
            Ok(match (mean.sign(), rest.sign()) {
                (Some(Sign::Greater), Some(Sign::Greater)) => Some(None),
                (Some(Sign::Less), _) | (_, Some(Sign::Less)) => Some(Some(mean)),
                _ => None,
            })
        })?;
        match found {
            None => Ok(()),
            Some(mean) => outside(to_decimal(&mean.lower().midpoint(&mean.upper()), 6)),
        }
    }

    /// Whether the norm of the plant's matrix times the period is a large number, so that its exponential may be longer than memory.
    fn is_long(&self) -> bool {
        let number = |f: &RationalFunction| f.as_constant().map(|x| x.abs());
        let Some((entries, time)) = self.plant.iter().map(number).collect::<Option<Vec<_>>>().zip(number(&self.time))
        else {
            return false;
        };
        let row = |row: &[Rational]| row.iter().fold(Rational::ZERO, |sum, entry| &sum + entry);
        let norm = entries.chunks(self.answers.len() + 1).map(row).max().unwrap_or(Rational::ZERO);
        &norm * &time > Rational::from(MOST_EXPONENT)
    }

    /// An interval that holds the only solution: the left side falls on it, and has no zero in the rest of [0, 1]. `None` where that is not shown.
    fn bracket(&self) -> Option<Enclosure> {
        let (mut lo, mut hi) = (Rational::ZERO, Rational::ONE);
        // The left side falls on both halves, so that it has no other zero.
        let falls = |lo: &Rational, hi: &Rational| self.slope_is_negative(lo, hi);
        let mut open = vec![(Rational::ZERO, Rational::ONE, 0)];
        while let Some((lo, hi, halvings)) = open.pop() {
            if falls(&lo, &hi) {
                continue;
            }
            if halvings == MOST_HALVINGS {
                return None;
            }
            let middle = lo.midpoint(&hi);
            open.push((lo, middle.clone(), halvings + 1));
            open.push((middle, hi, halvings + 1));
        }
        while !falls(&lo, &hi) {
            let middle = lo.midpoint(&hi);
            match self.at(&Ball::from_rational(&middle, 4 * GUARD_BITS))?.0.sign()? {
                Sign::Less => hi = middle,
                _ => lo = middle,
            }
        }
        Some(Enclosure::new(lo, hi))
    }

    fn slope_is_negative(&self, lo: &Rational, hi: &Rational) -> bool {
        let slope = self.at(&Ball::between(lo, hi, 4 * GUARD_BITS)).map(|(_, slope)| slope);
        slope.is_some_and(|slope| slope.sign() == Some(Sign::Less))
    }

    /// The left side of the equation and its slope where the duty ratio is anywhere in a ball; `None` where a divisor may vanish.
    fn at(&self, duty: &Ball) -> Option<(Ball, Ball)> {
        let bits = duty.bits();
        let values = self.symbols.enclosed(bits)?;
        let number = |f: &RationalFunction| quotient_at(f, &values, bits);
        let n = self.answers.len();
        let plant = self.plant.iter().map(number).collect::<Option<Vec<Ball>>>()?;
        let time = number(&self.time)?;
        let answers = self.answers.iter().map(number).collect::<Option<Vec<Ball>>>()?;
        let row = |column: &[Ball]| answers.iter().zip(column).fold(Ball::zero(bits), |sum, (r, c)| sum.add(&r.mul(c)));
        let flow = |share: &Ball| {
            let time = time.mul(share);
            exponential(&BallMatrix::from_fn(n + 1, |i, j| plant[i * (n + 1) + j].mul(&time)))
        };
        let one = Ball::from_integer(&Integer::ONE, bits);
        let integral = |e: &BallMatrix| (0..n).map(|i| e.at(i, n).clone()).collect::<Vec<Ball>>();
        let whole = row(&integral(&flow(&one)));
        let (mut sum, mut slope) = (Ball::zero(bits), Ball::zero(bits));
        for [begin, end] in &self.parts {
            for ([place, moves], is_end) in [(begin, false), (end, true)] {
                let at = Ball::from_integer(&Integer::from(*place), bits).add(&duty.scaled(&Integer::from(*moves)));
                let at = at.divided_by(2).add(&Ball::from_rational(&self.late, bits));
                let of_edge = |at: &Ball, turns: bool| {
                    // From the beginning of the period to a place: what is left out is the rest of the period.
                    let e = flow(&one.sub(at));
                    let part = whole.sub(&row(&integral(&e)));
                    let column: Vec<Ball> = (0..n)
                        .map(|i| {
                            (0..n).fold(Ball::zero(bits), |sum, j| sum.add(&e.at(i, j).mul(&plant[j * (n + 1) + n])))
                        })
                        .collect();
                    let part = if turns { part.add(&whole) } else { part };
                    (part, row(&column).mul(&time).scaled(&Integer::from(*moves)).divided_by(2))
                };
                // A pulse that goes on in the next period begins it: on the orbit all are alike.
                let (part, change) = match (at.sub(&one).sign(), at.sub(&one)) {
                    (Some(Sign::Less), _) => of_edge(&at, false),
                    (Some(_), rest) => of_edge(&rest, true),
                    (None, rest) => {
                        let (a, b) = (of_edge(&at, false), of_edge(&rest, true));
                        (a.0.union(&b.0), a.1.union(&b.1))
                    }
                };
                (sum, slope) = match is_end {
                    true => (sum.add(&part), slope.add(&change)),
                    false => (sum.sub(&part), slope.sub(&change)),
                };
            }
        }
        let mean = number(&self.mean)?;
        Some((mean.add(&sum.sub(&duty.mul(&whole))).sub(duty), slope.sub(&whole).sub(&one)))
    }
}

impl Enclosing for Equation {
    /// Newton's method, which does not leave the bracket.
    fn enclose(&self, bits: u64, known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        let start = known.cloned().unwrap_or_else(|| Enclosure::new(Rational::ZERO, Rational::ONE));
        until_shown(bits + GUARD_BITS, |working| {
            checkpoint(working);
            let (mut lo, mut hi) = (start.lower().clone(), start.upper().clone());
            loop {
                if &hi - &lo <= width {
                    return Some(Enclosure::new(lo, hi));
                }
                let middle = Ball::from_rational(&lo.midpoint(&hi), working);
                let (value, slope) = (self.at(&middle)?.0, self.at(&Ball::between(&lo, &hi, working))?.1);
                let next = middle.sub(&value.div(&slope)?);
                let (below, above) = (next.lower().max(lo.clone()), next.upper().min(hi.clone()));
                // Rounding is all that is left.
                if &(&above - &below) + &(&above - &below) > &hi - &lo {
                    return None;
                }
                (lo, hi) = (below, above);
            }
        })
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "duty ratio at rest".to_owned(), details: Vec::new() }
    }
}
