//! The way along the parameter's domain: pieces that the checker in `proofs/` can follow.

use super::checker::{Open, positive_primitive};
use super::refused;
use crate::emit::coprime_basis;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, RealAlgebraic, UniPoly};
use jurist_model::error::Error;
use jurist_stability::{Range, StableSet, zeros_in};
use std::cmp::Ordering;

/// Digits of a limit, unless another root is too near.
const DIGITS: u64 = 12;
/// The most digits that are tried.
const MOST_DIGITS: u64 = 400;
/// How often a piece is halved before it is given up.
const DEPTH: usize = 24;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Up,
    Down,
    Touch,
}

/// A limit: a root of a polynomial that rises through it, between two decimals, or a rational number.
#[derive(Clone, Debug)]
pub(super) enum Limit {
    Root { factor: UniPoly, low: Rational, high: Rational },
    Rational(Rational),
}

#[derive(Clone, Debug)]
pub(super) enum Piece {
    Along(Rational),
    /// The limit with this index.
    Limit(Kind, usize, Rational),
    From,
    Until(Rational),
}

#[derive(Default)]
pub(super) struct Way {
    pub(super) starts: bool,
    pub(super) limits: Vec<(Kind, Limit)>,
    pub(super) pieces: Vec<Piece>,
}

/// Finds the pieces for the set that is shown.
pub(super) fn way(conditions: &[UniPoly], set: &StableSet, domain: &Range, budget: &Budget) -> Result<Way, Error> {
    let (starts, events) = events(set, domain);
    // The limits' own polynomials split the conditions as far as a limit needs it.
    let ends = events.iter().filter(|(_, x)| x.exact().is_none()).map(|(_, x)| x.polynomial());
    let split: Vec<UniPoly> = conditions.iter().filter(|c| !c.is_zero()).chain(ends).cloned().collect();
    let basis = coprime_basis(&split, budget)?;
    let zeros = conditions.iter().map(|c| zeros_in(c, domain, budget)).collect::<Result<Vec<_>, _>>()?;
    let mut search = Search { conditions, basis, zeros, domain, budget, at: domain.lower.clone(), way: Way::default() };
    search.way.starts = starts;
    let mut on = starts;
    for (kind, value) in events {
        budget.check()?;
        search.event(on, kind, &value)?;
        on = kind != Kind::Down;
    }
    search.lead(on, domain.upper.clone())?;
    Ok(search.way)
}

/// Whether the set begins with the domain, and its ends inside the domain.
fn events(set: &StableSet, domain: &Range) -> (bool, Vec<(Kind, RealAlgebraic)>) {
    let inside = |end: &Option<jurist_stability::End>, of: &Option<Rational>| {
        let value = end.as_ref()?.value.algebraic()?.clone();
        of.as_ref().is_none_or(|q| value.compare_rational(q) != Ordering::Equal).then_some(value)
    };
    let mut starts = false;
    let mut events: Vec<(Kind, RealAlgebraic)> = Vec::new();
    for (i, interval) in set.intervals().iter().enumerate() {
        match inside(&interval.lower, &domain.lower) {
            None => starts |= i == 0,
            Some(x) => match events.last_mut() {
                Some((kind, y)) if y.compare(&x) == Ordering::Equal => *kind = Kind::Touch,
                _ => events.push((Kind::Up, x)),
            },
        }
        events.extend(inside(&interval.upper, &domain.upper).map(|x| (Kind::Down, x)));
    }
    (starts, events)
}

struct Search<'a> {
    conditions: &'a [UniPoly],
    basis: Vec<UniPoly>,
    zeros: Vec<Vec<RealAlgebraic>>,
    domain: &'a Range,
    budget: &'a Budget,
    at: Option<Rational>,
    way: Way,
}

/// A stretch on which a condition is negative.
struct Negative<'a> {
    condition: usize,
    low: Option<&'a RealAlgebraic>,
    high: Option<&'a RealAlgebraic>,
}

impl Search<'_> {
    fn event(&mut self, on: bool, kind: Kind, value: &RealAlgebraic) -> Result<(), Error> {
        if let Some(q) = value.exact() {
            self.way.limits.push((kind, Limit::Rational(q.clone())));
            // 'Until' leads there itself.
            self.lead(on, Some(q.clone()))?;
            match on {
                true => self.way.pieces.push(Piece::Until(q.clone())),
                false => self.way.pieces.push(Piece::Along(q.clone())),
            }
            if kind != Kind::Down {
                self.way.pieces.push(Piece::From);
            }
            self.at = Some(q);
            return Ok(());
        }
        let factor = self.basis.iter().find(|f| value.sign_of(f).is_eq());
        let factor = positive_primitive(factor.ok_or_else(|| refused("a limit is no zero of a condition", REPORT))?);
        for digits in DIGITS..MOST_DIGITS {
            self.budget.check()?;
            let (low, high) = decimals(value, digits);
            let rising = if factor.sign_at(&high).is_lt() { factor.negated() } else { factor.clone() };
            if self.at.as_ref().is_some_and(|at| *at >= low)
                || self.domain.upper.as_ref().is_some_and(|upper| *upper <= high)
                || !self.separates(kind, &rising, &low, &high)
            {
                continue;
            }
            self.lead(on, Some(low.clone()))?;
            self.way.pieces.push(Piece::Along(low.clone()));
            self.way.pieces.push(Piece::Limit(kind, self.way.limits.len(), high.clone()));
            self.at = Some(high.clone());
            self.way.limits.push((kind, Limit::Root { factor: rising, low, high }));
            return Ok(());
        }
        Err(refused(format!("a limit is not told from its neighbours by {MOST_DIGITS} digits"), NARROW))
    }

    /// The checker's tests of a limit.
    fn separates(&self, kind: Kind, factor: &UniPoly, low: &Rational, high: &Rational) -> bool {
        let open = Open { low: Some(low), high: Some(high) };
        let values_agree = match kind {
            Kind::Down => self.conditions.iter().any(|c| !c.sign_at(high).is_gt()),
            Kind::Up | Kind::Touch => self.conditions.iter().all(|c| c.sign_at(high).is_gt()),
        };
        if !values_agree || !factor.sign_at(low).is_lt() || !factor.sign_at(high).is_gt() {
            return false;
        }
        let mut changes = false;
        let edge = self.conditions.iter().all(|c| {
            let (power, rest) = stripped(c, factor);
            changes |= if kind == Kind::Touch { power > 0 } else { power % 2 == 1 };
            let flipped = kind == Kind::Down && power % 2 == 1;
            (kind != Kind::Touch || power % 2 == 0) && open.is_positive(&if flipped { rest.negated() } else { rest })
        });
        edge && changes && open.is_positive(&factor.derivative())
    }

    /// Pieces without a change up to `to`, the last of which is not written.
    fn lead(&mut self, on: bool, to: Option<Rational>) -> Result<(), Error> {
        let from = self.at.clone();
        if on {
            return self.halved(&|open| self.conditions.iter().all(|c| open.is_positive(c)), from, to);
        }
        let mut at = from.clone();
        loop {
            self.budget.check()?;
            let (condition, until) = self.failing(at.as_ref(), to.as_ref())?;
            let end = until.clone().or_else(|| to.clone());
            self.at = at;
            let c = self.conditions[condition].clone();
            self.halved(&|open| open.is_not_positive(&c), self.at.clone(), end)?;
            match until {
                None => return Ok(()),
                Some(until) => {
                    self.way.pieces.push(Piece::Along(until.clone()));
                    at = Some(until);
                }
            }
        }
    }

    /// A condition that fails from a value on as far as one does, and a value up to which it is looked at; none where it fails up to the goal.
    fn failing(&self, at: Option<&Rational>, to: Option<&Rational>) -> Result<(usize, Option<Rational>), Error> {
        let cells = self.negative();
        let reaches = |high: Option<&RealAlgebraic>| match (high, to) {
            (None, _) => true,
            (Some(x), Some(to)) => x.compare_rational(to).is_ge(),
            (Some(_), None) => false,
        };
        let starts_here = |low: Option<&RealAlgebraic>| match (low, at) {
            (None, _) => true,
            (Some(x), Some(at)) => x.compare_rational(at).is_le(),
            (Some(_), None) => false,
        };
        let lasts = |high: Option<&RealAlgebraic>| match (high, at) {
            (Some(x), Some(at)) => x.compare_rational(at).is_gt(),
            _ => true,
        };
        let here = cells.iter().filter(|c| starts_here(c.low) && lasts(c.high));
        let Some(best) = here.max_by(|a, b| later(a.high, b.high)) else {
            return Err(refused("no single condition fails beside a value of the parameter", NARROW));
        };
        if reaches(best.high) {
            Ok((best.condition, None))
        } else {
            let high = best.high.expect("it ends before the goal");
            let onward = |c: &&Negative| {
                later(c.high, Some(high)).is_gt() && c.low.is_none_or(|x| x.compare(high) != Ordering::Greater)
            };
            let next = cells.iter().filter(onward).max_by(|a, b| {
                let open = |c: &Negative| c.low.is_none_or(|x| x.compare(high) == Ordering::Less);
                open(a).cmp(&open(b)).then_with(|| later(a.high, b.high))
            });
            let Some(next) = next else {
                return Err(refused("two conditions change places at one value of the parameter", NARROW));
            };
            let until = match next.low {
                Some(low) if low.compare(high) == Ordering::Equal => low.exact(),
                low => Some(decimal_inside(low, at, high)),
            };
            let until = until.ok_or_else(|| refused("two conditions change places at one irrational value", NARROW))?;
            Ok((best.condition, Some(until)))
        }
    }

    /// The stretches between the zeros of each condition on which it is negative.
    fn negative(&self) -> Vec<Negative<'_>> {
        let mut out = Vec::new();
        for (condition, (c, zeros)) in self.conditions.iter().zip(&self.zeros).enumerate() {
            let ends: Vec<Option<&RealAlgebraic>> =
                std::iter::once(None).chain(zeros.iter().map(Some)).chain([None]).collect();
            for pair in ends.windows(2) {
                let cell = jurist_stability::AlgebraicInterval {
                    lower: pair[0].cloned().or(self.domain.lower.clone().map(RealAlgebraic::from_rational)),
                    upper: pair[1].cloned().or(self.domain.upper.clone().map(RealAlgebraic::from_rational)),
                };
                if !c.sign_at(&cell.sample()).is_gt() {
                    out.push(Negative { condition, low: pair[0], high: pair[1] });
                }
            }
        }
        out
    }

    /// Halves the interval until the test succeeds on each part.
    fn halved(
        &mut self,
        test: &dyn Fn(Open) -> bool,
        from: Option<Rational>,
        to: Option<Rational>,
    ) -> Result<(), Error> {
        let mut cuts = Vec::new();
        if !halve(test, from.as_ref(), to.as_ref(), DEPTH, &mut cuts, self.budget)? {
            return Err(refused("the signs of the conditions are not seen within the checker's subdivisions", NARROW));
        }
        self.way.pieces.extend(cuts.into_iter().map(Piece::Along));
        Ok(())
    }
}

const NARROW: &str = "narrow the domain with '--domain', or take '--certificate' or '--smt2'";
const REPORT: &str = "take '--certificate' or '--smt2', and report the model";

fn halve(
    test: &dyn Fn(Open) -> bool,
    from: Option<&Rational>,
    to: Option<&Rational>,
    depth: usize,
    cuts: &mut Vec<Rational>,
    budget: &Budget,
) -> Result<bool, Error> {
    budget.check()?;
    if test(Open { low: from, high: to }) {
        return Ok(true);
    }
    if depth == 0 {
        return Ok(false);
    }
    let middle = match (from, to) {
        (Some(a), Some(b)) => {
            let quarter = (b - a) * Rational::new(Integer::ONE, Integer::from(4));
            shortest_decimal(&(a + &quarter), &(b - &quarter))
        }
        (Some(a), None) => beyond(a),
        (None, Some(b)) => -beyond(&-b),
        (None, None) => Rational::ZERO,
    };
    if !halve(test, from, Some(&middle), depth - 1, cuts, budget)? {
        return Ok(false);
    }
    cuts.push(middle.clone());
    halve(test, Some(&middle), to, depth - 1, cuts, budget)
}

/// A number well above `a`.
fn beyond(a: &Rational) -> Rational {
    let far = a.abs() + a.abs() + Rational::ONE;
    shortest_decimal(&far, &(&far + &far))
}

fn later(a: Option<&RealAlgebraic>, b: Option<&RealAlgebraic>) -> Ordering {
    match (a, b) {
        (None, None) => Ordering::Equal,
        (None, _) => Ordering::Greater,
        (_, None) => Ordering::Less,
        (Some(a), Some(b)) => a.compare(b),
    }
}

/// How often `factor` divides, and what is left.
fn stripped(c: &UniPoly, factor: &UniPoly) -> (usize, UniPoly) {
    let (mut power, mut rest) = (0, c.clone());
    while !rest.is_zero() {
        let Some(quotient) = rest.div_exact(factor) else { break };
        (power, rest) = (power + 1, quotient);
    }
    (power, rest)
}

fn ten_to(k: i64) -> Rational {
    Rational::from(10).pow(k).expect("10 is not 0")
}

/// Two decimals that differ by one unit of the last of `digits` digits, the number between them.
fn decimals(x: &RealAlgebraic, digits: u64) -> (Rational, Rational) {
    let mut more = digits as usize;
    loop {
        let (low, high) = x.refined_to_digits(more).enclosure();
        let least = low.abs().min(high.abs());
        let mut magnitude: i64 = 0;
        while ten_to(magnitude) > least {
            magnitude -= 1;
        }
        while ten_to(magnitude + 1) <= least {
            magnitude += 1;
        }
        let unit = ten_to(magnitude + 1 - digits as i64);
        let floor = |q: &Rational| q.checked_div(&unit).expect("a power of 10").floor();
        let (below, other) = (floor(&low), floor(&high));
        if below == other {
            let at = |n: &Integer| Rational::from(n.clone()) * &unit;
            let (low, high) = (at(&below), at(&(&below + &Integer::ONE)));
            if x.compare_rational(&low).is_gt() {
                return (low, high);
            }
        }
        more += 3;
    }
}

/// A short decimal between `low` (or `at`, what is larger) and `high`, away from both.
fn decimal_inside(low: Option<&RealAlgebraic>, at: Option<&Rational>, high: &RealAlgebraic) -> Rational {
    let start = match (low, at) {
        (Some(x), Some(q)) if x.compare_rational(q).is_lt() => Some(RealAlgebraic::from_rational(q.clone())),
        (Some(x), _) => Some(x.clone()),
        (None, Some(q)) => Some(RealAlgebraic::from_rational(q.clone())),
        (None, None) => None,
    };
    let Some(mut low) = start else { return -beyond(&-high.rational_below()) };
    let mut high = high.clone();
    loop {
        let ((a, b), (c, d)) = (low.enclosure(), high.enclosure());
        let gap = &c - &b;
        let eight = Rational::from(8);
        if gap.sign().is_gt() && (&b - &a) + (&d - &c) <= gap {
            let part = gap.checked_div(&eight).expect("8 is not 0");
            return shortest_decimal(&(&b + &part), &(&c - &part));
        }
        let width = (&d - &a).checked_div(&eight).expect("8 is not 0");
        (low, high) = (low.refined(&width), high.refined(&width));
    }
}

/// The decimal with the fewest places strictly between two numbers.
fn shortest_decimal(low: &Rational, high: &Rational) -> Rational {
    if low.is_negative() && high.sign().is_gt() {
        return Rational::ZERO;
    }
    let most = low.abs().max(high.abs());
    let mut k: i64 = 0;
    while ten_to(k) <= most {
        k += 1;
    }
    loop {
        let unit = ten_to(k);
        let n = low.checked_div(&unit).expect("a power of 10").floor();
        let candidate = Rational::from(&n + &Integer::ONE) * &unit;
        if candidate < *high {
            return candidate;
        }
        k -= 1;
    }
}
