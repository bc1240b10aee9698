//! The stable factors of a loop with dead time, of complex loops and of others.
//!
//! With the factor `k` a root is on the axis where the open loop is real, `k = -1/L`; one count of roots in each of the gaps between such factors tells which are
//! stable. As `k` grows the root there moves by `ds/d log k = 1/(tau + D0'/D0 - N'/N)`: beyond some frequency always to the right. So from a factor on that is not
//! stable and above all those of lower frequencies none is stable.

use super::Value;
use super::complex_loop::lowest_root;
use super::complex_poly::ComplexPoly;
use super::dead_time::DeadTime;
use super::enclosed::{greater, within};
use super::ground::Ground;
use crate::coverage::refusals::COMPLEX_FACTORS;
use crate::error::Error;
use crate::stability::dead_time::{FamilyLoop, NotCounted};
use crate::stability::{Cause, ComplexPair, End, Side, StableInterval, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly};
use jurist_algebra::real::{Real, rational_between};
use std::cmp::Ordering;

/// Two factors count as one where their enclosures with so many bits overlap.
const BITS: u64 = 256;

/// Factors up to so many powers of ten are looked at. Where the modulus of the open loop goes to a limit that is not 0, they come near to one without end.
const ATTEMPTS: u32 = 16;
const ATTEMPTS_AT_A_LIMIT: u32 = 3;

/// A factor with a root on the axis.
#[derive(Clone)]
struct Crossing {
    factor: Real,
    /// 0 for a root at `s = 0`.
    omega: Real,
    enclosure: Enclosure,
}

impl Crossing {
    /// Bounds of the size of the factor.
    fn sizes(&self) -> [Rational; 2] {
        let [low, high] = [self.enclosure.lower().abs(), self.enclosure.upper().abs()];
        if low < high { [low, high] } else { [high, low] }
    }
}

impl<G: Ground> DeadTime<'_, G> {
    /// The factors at the cut for which the loop is stable.
    ///
    /// Cost: the frequencies at which the open loop is real, and a count of roots between any two of the factors.
    pub(super) fn stable_factors(&self, budget: &Budget) -> Result<StableSet, Error> {
        let family = self.parts.ground.family_of_factors(&self.parts.in_factor(), self.tau);
        let outward = self.beyond_zeros(&self.motion(), budget)?;
        let r = &self.parts.reduced;
        let attempts = match r.numerator_squared.degree() == r.denominator_squared.degree() {
            true => ATTEMPTS_AT_A_LIMIT,
            false => ATTEMPTS,
        };
        let is_stable = |value: &Rational| is_stable(&family, value, budget);
        for attempt in 1..=attempts {
            let [end, square] = self.beyond(&Integer::from(10).pow(attempt.into()), budget)?;
            // Of a frequency beyond the end the factor is greater.
            let reach = Enclosure::from_rational(square).sqrt(BITS).upper().recip().expect("a modulus is not 0");
            let all = self.all_crossings(&end.max(outward.clone()), budget)?;
            let is_within = |c: &&Crossing| {
                let (low, high) = c.omega.refined_to_digits(2).enclosure();
                low.abs().min(high.abs()) <= outward
            };
            let inner = all.iter().filter(is_within).map(|c| c.sizes()[1].clone()).max().unwrap_or(Rational::ZERO);
            let last = |sign: i64| unstable_from([&inner, &reach], &all, sign, &is_stable, budget);
            let (Some(least), Some(greatest)) = (last(-1)?, last(1)?) else { continue };
            let is_kept = |c: &Crossing| *c.enclosure.lower() > least && *c.enclosure.upper() < greatest;
            let kept = all.into_iter().filter(is_kept).collect();
            return self.set_of(kept, &is_stable, budget);
        }
        Err(COMPLEX_FACTORS.diagnostic(&[]).into())
    }

    /// All crossings up to a frequency, ascending by their factors as far as enclosures tell.
    fn all_crossings(&self, end: &Rational, budget: &Budget) -> Result<Vec<Crossing>, Error> {
        let mut found = self.factors(end, budget)?;
        found.extend(self.factor_at_rest(budget)?.map(|factor| (Real::from(Rational::ZERO), factor)));
        let mut out = Vec::with_capacity(found.len());
        for (omega, factor) in found {
            let enclosure = budget.enter(|| within(&factor, BITS))?;
            out.push(Crossing { factor, omega, enclosure });
        }
        out.sort_by(|a, b| a.enclosure.lower().cmp(b.enclosure.lower()));
        Ok(out)
    }

    /// The factor with which a root is at `s = 0`.
    fn factor_at_rest(&self, budget: &Budget) -> Result<Option<Real>, Exhausted> {
        let (r, ground, rest) = (&self.parts.reduced, &self.parts.ground, self.axis.at_rest());
        let vanishes = |p: &Poly<G::Number>| Ok(ground.sign(&p.coeff(0), budget)?.is_eq());
        let is_turned = r.frequencies.are_signed() && !vanishes(&r.imaginary)?;
        if vanishes(&r.denominator_squared)? || vanishes(&r.twice_real)? || is_turned {
            return Ok(None);
        }
        let above = r.denominator_squared.scaled(&G::Number::from_integer(&Integer::from(-2)));
        let value = ground.value(&above, &r.twice_real, &rest, r.frequencies, budget)?;
        value.map(|value: Value| value.number(budget)).transpose()
    }

    /// A polynomial in the frequency that is positive where roots move to the right as the factor grows: `Re(tau + D0'/D0 - N'/N)` times the
    /// squares of both moduli.
    fn motion(&self) -> Poly<G::Number> {
        let (d, n) = (&self.parts.denominator, &self.parts.numerator);
        let [d, n] = [d, n].map(|p| p.along(p.len().saturating_sub(1), self.parts.shape));
        let [below, above] = [d.squared(), n.squared()];
        // p'/p = -j (dp/domega)/p. Its real part is Im(dp/domega conj(p))/|p|^2.
        let turned = |p: &ComplexPoly<G::Number>| {
            let slope = ComplexPoly { re: p.re.derivative(), im: p.im.derivative() };
            let [_, imaginary] = slope.times_conjugate(p);
            imaginary
        };
        let [up, down] = [self.tau.numerator(), self.tau.denominator()].map(|c| G::Number::from_integer(&c));
        let own = turned(&d).times(&above).minus(&turned(&n).times(&below));
        let in_frequency = below.times(&above).scaled(&up).plus(&own.scaled(&down));
        if self.parts.frequencies().are_signed() {
            return in_frequency;
        }
        // Of a real loop it is even in the frequency, and the variable is -omega^2.
        let even = in_frequency.coeffs().iter().step_by(2).enumerate();
        Poly::new(even.map(|(i, c)| if i % 2 == 0 { c.clone() } else { G::Number::zero().minus(c) }).collect())
    }

    /// The stable set, where the loop is stable for no factor below the least crossing and for none above the greatest. A stable gap that is shorter than the
    /// enclosures of its ends, about `2^-256`, is left out.
    fn set_of(
        &self,
        mut crossings: Vec<Crossing>,
        is_stable: &dyn Fn(&Rational) -> Result<bool, Error>,
        budget: &Budget,
    ) -> Result<StableSet, Error> {
        let zero = Enclosure::from_rational(Rational::ZERO);
        if !self.parts.ground.is_stable(&self.parts.denominator.with_conjugate(), self.parts.shape, budget)? {
            let at = crossings.partition_point(|c| c.enclosure.lower().sign().is_lt());
            let factor = Real::from(Rational::ZERO);
            crossings.insert(at, Crossing { omega: factor.clone(), factor, enclosure: zero });
        }
        // Those that enclosures do not tell apart are one.
        let mut groups: Vec<Vec<Crossing>> = Vec::new();
        for crossing in crossings {
            match groups.last_mut() {
                Some(group) if group.iter().any(|c| c.enclosure.upper() >= crossing.enclosure.lower()) => {
                    group.push(crossing);
                }
                _ => groups.push(vec![crossing]),
            }
        }
        let mut intervals: Vec<StableInterval> = Vec::new();
        for (below, above) in groups.iter().zip(groups.iter().skip(1)) {
            let greatest = below.iter().map(|c| c.enclosure.upper()).max().expect("not empty");
            let least = above.iter().map(|c| c.enclosure.lower()).min().expect("not empty");
            if is_stable(&between(greatest, least, budget)?)? {
                let ends = [self.end(below, Ordering::Greater, budget)?, self.end(above, Ordering::Less, budget)?];
                let [lower, upper] = ends.map(Some);
                intervals.push(StableInterval::new(lower, upper));
            }
        }
        Ok(StableSet::from_intervals(intervals, Vec::new()))
    }

    /// The end of an interval at crossings: the least or the greatest of their factors.
    fn end(&self, group: &[Crossing], wanted: Ordering, budget: &Budget) -> Result<End, Exhausted> {
        let first = &group[0];
        if let Some(open) = group.iter().find(|c| c.factor.exact().is_some_and(|x| x.is_zero())) {
            return self.end_without_loop(open, budget);
        }
        let value = group[1..].iter().fold(first.factor.clone(), |known, c| one_of(known, c.factor.clone(), wanted));
        Ok(self.end_at(value, &first.omega))
    }

    fn end_at(&self, value: Real, omega: &Real) -> End {
        let side = match omega.sign() {
            Ordering::Equal => return End::new(value, Cause::RootAtZero.into(), None),
            _ if !self.parts.frequencies().are_signed() => {
                let pair = ComplexPair::at_angular_frequency(omega.clone());
                return End::new(value, Cause::ComplexPair.into(), Some(pair));
            }
            Ordering::Less => Side::Lower,
            Ordering::Greater => Side::Upper,
        };
        let size = if side == Side::Lower { omega.negated() } else { omega.clone() };
        End::new(value, Cause::ComplexRoot.into(), Some(ComplexPair::at_angular_frequency(size).on_side(side)))
    }

    /// The factor 0, at which poles of the open loop are on the axis.
    fn end_without_loop(&self, open: &Crossing, budget: &Budget) -> Result<End, Exhausted> {
        let (d, ground) = (&self.parts.denominator, &self.parts.ground);
        let at_zero = d.coeff(0).squared().coeff(0);
        if !ground.sign(&at_zero, budget)?.is_eq()
            && let Some((omega, side)) = lowest_root(ground, d.clone(), self.parts.shape, budget)?
        {
            let mut end = self.end_at(open.factor.clone(), &omega);
            if side == Side::Both {
                end.causes = Cause::ComplexPair.into();
            }
            end.pair = end.pair.map(|pair| pair.on_side(side));
            return Ok(end);
        }
        Ok(self.end_at(open.factor.clone(), &open.omega))
    }
}

/// The less or the greater of two numbers that enclosures do not tell apart.
fn one_of(a: Real, b: Real, wanted: Ordering) -> Real {
    match wanted {
        Ordering::Less => greater(a.negated(), b.negated()).negated(),
        _ => greater(a, b),
    }
}

/// A factor of this sign, whose size is between two numbers, at which the loop is not stable; the least that is found between two crossings.
fn unstable_from(
    [from, to]: [&Rational; 2],
    all: &[Crossing],
    sign: i64,
    is_stable: &dyn Fn(&Rational) -> Result<bool, Error>,
    budget: &Budget,
) -> Result<Option<Rational>, Error> {
    let is_own = |c: &&Crossing| (sign > 0) == c.enclosure.lower().sign().is_gt();
    let mut sizes: Vec<[Rational; 2]> = all.iter().filter(is_own).map(Crossing::sizes).collect();
    sizes.sort();
    let mut from = from.clone();
    for [low, high] in sizes.into_iter().chain([[to.clone(), to.clone()]]).take_while(|[low, _]| low <= to) {
        if low > from {
            let value = between(&from, &low, budget)? * Rational::from(sign);
            if !is_stable(&value)? {
                return Ok(Some(value));
            }
        }
        from = from.max(high);
    }
    Ok(None)
}

/// A short rational number between two others.
fn between(low: &Rational, high: &Rational, budget: &Budget) -> Result<Rational, Exhausted> {
    let found = rational_between(&Real::from(low.clone()), &Real::from(high.clone()), budget)?;
    Ok(found.expect("they are apart"))
}

fn is_stable(family: &FamilyLoop, value: &Rational, budget: &Budget) -> Result<bool, Error> {
    match family.count(value, budget) {
        Ok(count) => Ok(count.is_some_and(|count| count.is_stable())),
        Err(NotCounted::Neutral) => Err(COMPLEX_FACTORS.diagnostic(&[]).into()),
        Err(NotCounted::Stopped(stopped)) => Err(stopped.into()),
    }
}
