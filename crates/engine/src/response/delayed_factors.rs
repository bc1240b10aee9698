//! The stable factors of a loop with dead time, of complex loops and of others.
//!
//! The characteristic function is `A + k N exp(-m tau s)`, where `A` may have the dead time, too. A root is on the axis where `N exp(-m tau s)/A` is real, `k = -A/N exp(m tau s)`;
//! one count of roots in each of the gaps between such factors tells which are stable. As `k` grows the root there moves by
//! `ds/d log k = 1/(m tau + A'/A - N'/N)`: beyond some frequency always to the right. So from a factor on that is not stable and above all those of lower
//! frequencies none is stable.

use super::Frequencies;
use super::complex_loop::lowest_zero;
use super::complex_poly::{ComplexPoly, take_common};
use super::delayed_axis::DelayedAxis;
use super::delayed_cells::{Cut, FactorCells, Happening, between};
use super::delayed_peak::{DelayedQuotient, frequencies_of};
use super::enclosed::within;
use super::ground::Ground;
use super::value::square_root;
use crate::coverage::refusals::COMPLEX_FACTORS;
use crate::error::Error;
use crate::stability::dead_time::{FamilyLoop, NotCounted};
use crate::stability::{Range, Shape, Side, StableSet};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// Two factors count as one where their enclosures with so many bits overlap.
const BITS: u64 = 256;

/// Bits of bounds.
const BITS_OF_BOUND: u64 = 64;

/// Factors are looked at up to a first one, and up to so many powers of ten more. Where the difference operator is unstable from some factor on, crossings may
/// come near to it without end.
const ATTEMPTS: i64 = 16;
const ATTEMPTS_AT_A_LIMIT: i64 = 4;

/// `A + k N exp(-m tau s)`.
pub(super) struct DelayedFactors<G: Ground> {
    axis: DelayedAxis<G>,
    /// The coefficient of `exp(-tau s)^k` in `A` at `[k]`.
    open: Vec<ComplexPoly<G::Number>>,
    back: ComplexPoly<G::Number>,
    /// `m`.
    power: usize,
    /// The loop in the factor, by which roots are counted.
    family: FamilyLoop,
}

/// Functions of the frequency, its cosine and its sine.
struct OnAxis<R: Domain> {
    /// Zero where the open loop is real.
    imaginary: MultiPoly,
    /// The factor that makes it -1 there is a quotient.
    factor: [MultiPoly; 2],
    /// What is zero at zeros of `A`, and of `N`, whatever the dead time is.
    fixed: [Poly<R>; 2],
}

/// All crossings of factors up to a size.
struct Reached {
    crossings: Vec<Cut>,
    /// Those of greater frequencies have greater factors.
    reach: Rational,
    /// At least the factors of low frequencies; `None` where nothing is known of the motion of roots.
    inner: Option<Rational>,
}

impl<G: Ground> DelayedFactors<G> {
    /// From the coefficients of `exp(-tau s)^k` in `A` at `[k]`, and from `N` with the power of `exp(-tau s)` beside it; neither `A` nor `N` is zero. The
    /// family is that loop in the factor, of a complex one with conjugate roots.
    pub fn new(
        ground: &G,
        tau: Rational,
        open: Vec<ComplexPoly<G::Number>>,
        (back, power): (ComplexPoly<G::Number>, usize),
        family: FamilyLoop,
    ) -> DelayedFactors<G> {
        let frequencies = frequencies_of(open.iter().chain([&back]));
        DelayedFactors { axis: DelayedAxis::new(ground, tau, frequencies), open, back, power, family }
    }

    /// The factors in a range for which the loop is stable; it is undefined at the zeros of some polynomials in the factor.
    ///
    /// Cost: the frequencies at which the open loop is real, and a count of roots between any two of the factors.
    ///
    /// # Errors
    /// [`COMPLEX_FACTORS`] where no factor is found from which on the loop is not stable; [`Error::Stopped`].
    pub fn stable_set(&self, range: &Range, poles: &[UniPoly], budget: &Budget) -> Result<StableSet, Error> {
        budget.step("crossings of the imaginary axis");
        let on_axis = self.on_axis(budget)?;
        let neutral = self.neutral(budget)?;
        let limit = neutral.as_ref().map(|limit| budget.enter(|| within(limit, BITS))).transpose()?;
        let is_stable = |value: &Rational| is_stable(&self.family, value, budget);
        let cells = |mut cuts: Vec<Cut>, inside: Range| {
            cuts.extend(self.without_loop(&on_axis.fixed[0], &is_stable, budget)?);
            let mut cells = FactorCells { range: inside, cuts, is_signed: self.axis.is_signed() };
            cells.cut_at_ends(range, neutral.as_ref(), BITS);
            cells.cut_at_poles(poles, BITS, budget)?;
            cells.stable_set(&is_stable, budget)
        };
        let sizes = [&range.lower, &range.upper].map(|end| end.as_ref().map(Rational::abs));
        let most = match sizes {
            [Some(a), Some(b)] => Some(a.max(b)),
            _ => None,
        };
        let most = most.filter(|most| limit.as_ref().is_none_or(|limit| most < limit.lower()));
        if let (Some(limit), None) = (&limit, &most)
            && let Some(end) = self.falling_from(budget)?
        {
            let crossings = self.crossings(&on_axis, &end, budget)?;
            let lower = range.lower.clone().map_or(-limit.upper(), |lower| lower.max(-limit.upper()));
            let upper = range.upper.iter().chain([limit.upper()]).min().cloned();
            return cells(crossings, Range::between(Some(lower), upper));
        }
        let outward = match self.outward(budget) {
            Err(stopped) if most.is_some() && !stopped.stop.is_budget() => None,
            outward => Some(outward?),
        };
        for attempt in 0..if limit.is_some() { ATTEMPTS_AT_A_LIMIT } else { ATTEMPTS } {
            let reach = self.reach(attempt, outward.as_ref(), limit.as_ref());
            let reach = reach.into_iter().chain(most.clone()).min().expect("one of them is known");
            let reached = self.reached(&on_axis, reach, outward.as_ref(), budget)?;
            if let Some(inside) = reached.looked_at(range, &is_stable, budget)? {
                return cells(reached.crossings, inside);
            }
        }
        Err(COMPLEX_FACTORS.diagnostic(&[]).into())
    }

    /// How far factors are looked at; `None` where there is nothing to begin with.
    fn reach(&self, attempt: i64, outward: Option<&Rational>, limit: Option<&Enclosure>) -> Option<Rational> {
        let power = |exponent: i64| Rational::from(10).pow(exponent).expect("ten is not zero");
        match limit {
            Some(limit) => Some(limit.lower() * &(Rational::ONE - power(-1 - attempt))),
            None => Some(power(self.exponent(outward?) + attempt)),
        }
    }

    /// The power of ten near the factors of crossings at a frequency.
    fn exponent(&self, omega: &Rational) -> i64 {
        let both = [omega.clone(), -omega];
        let quotient = self.open_loop();
        let square = both.iter().filter_map(|omega| quotient.square_at(omega, BITS_OF_BOUND));
        let square = square.map(|square| square.upper().clone()).filter(|x| x.sign().is_gt()).max();
        let octaves = |x: &Rational| x.denominator().bit_length() as i64 - x.numerator().bit_length() as i64;
        // log10(2)/2 for each octave of the square.
        square.map_or(0, |square| octaves(&square) * 30_103 / 200_000)
    }

    /// `N/A`, whose modulus is that of the open loop.
    fn open_loop(&self) -> DelayedQuotient<G> {
        DelayedQuotient::new(self.ground(), self.axis.tau().clone(), vec![self.back.clone()], self.open.clone())
    }

    /// All crossings of factors up to a size.
    fn reached(
        &self,
        on_axis: &OnAxis<G::Number>,
        reach: Rational,
        outward: Option<&Rational>,
        budget: &Budget,
    ) -> Result<Reached, Error> {
        let end = self.open_loop().end(&reach.recip().expect("a size is positive"), budget)?;
        let end = outward.map_or(end.clone(), |outward| end.max(outward.clone()));
        let crossings = self.crossings(on_axis, &end, budget)?;
        let inner = outward.map(|outward| {
            let is_within = |c: &&Cut| {
                let Happening::Root(omega) = &c.what else { return false };
                let (low, high) = omega.refined_to_digits(2).enclosure();
                low.abs().min(high.abs()) <= *outward
            };
            crossings.iter().filter(is_within).map(|c| c.sizes()[1].clone()).max().unwrap_or(Rational::ZERO)
        });
        Ok(Reached { crossings, reach, inner })
    }

    /// The functions whose zeros are crossings.
    fn on_axis(&self, budget: &Budget) -> Result<OnAxis<G::Number>, Exhausted> {
        budget.enter(|| {
            let along = |p: &ComplexPoly<G::Number>| p.along(0, Shape::LeftHalfPlane);
            let (mut open, mut back) = (self.open.iter().map(along).collect::<Vec<_>>(), vec![along(&self.back)]);
            let fixed = [&mut open, &mut back].map(take_common);
            let [mut real, mut imaginary] = [MultiPoly::zero(), MultiPoly::zero()];
            for (k, part) in open.iter().enumerate() {
                let [re, im] = self.axis.turned(&back[0].times_conjugate(part), self.power as i64 - k as i64);
                (real, imaginary) = (real.plus(&re), imaginary.plus(&im));
            }
            let [of_open, of_back] = [&fixed[0], &fixed[1]].map(|p| self.axis.of_omega(p));
            let above = of_open.times(&real).scaled_by(&-Integer::ONE);
            let below = of_back.times(&self.axis.of_omega(&back[0].squared()));
            OnAxis { imaginary, factor: [above, below], fixed }
        })
    }

    /// All crossings up to a frequency, ascending by their factors as far as enclosures tell.
    fn crossings(&self, on_axis: &OnAxis<G::Number>, end: &Rational, budget: &Budget) -> Result<Vec<Cut>, Exhausted> {
        if on_axis.imaginary.is_zero() {
            let why = "the open loop is real on the whole axis";
            return Err(Exhausted::new(Stop::Method(why.into()), "crossings of the imaginary axis"));
        }
        let zeros = self.axis.zeros(&on_axis.imaginary, end, budget)?;
        for p in &on_axis.fixed {
            self.axis.keep_clear(&zeros, p, Frequencies::Signed(Shape::LeftHalfPlane), budget)?;
        }
        let [above, below] = &on_axis.factor;
        let mut out = Vec::with_capacity(zeros.len() + 1);
        for omega in zeros {
            let factor = self.axis.quotient(above, below, &omega);
            out.push(budget.enter(|| Cut::new(factor, Happening::Root(omega), BITS))?);
        }
        if let Some(factor) = self.factor_at_rest(budget)? {
            out.push(budget.enter(|| Cut::new(factor, Happening::Root(Real::from(Rational::ZERO)), BITS))?);
        }
        Ok(out)
    }

    /// The factor with which a root is at `s = 0`, where it is not 0.
    fn factor_at_rest(&self, budget: &Budget) -> Result<Option<Real>, Exhausted> {
        let (open, back) = (self.at_rest(), self.back.coeff(0));
        let [real, imaginary] = open.times_conjugate(&back).map(|p| p.coeff(0));
        let below = back.squared().coeff(0);
        let is_zero = |c: &G::Number| Ok::<_, Exhausted>(self.ground().sign(c, budget)?.is_eq());
        if is_zero(&below)? || is_zero(&real)? || !is_zero(&imaginary)? {
            return Ok(None);
        }
        self.ground().quotient(&real.negated(), &below, budget)?.number(budget).map(Some)
    }

    /// The factor 0, where the open loop is not stable.
    fn without_loop(
        &self,
        fixed: &Poly<G::Number>,
        is_stable: &dyn Fn(&Rational) -> Result<bool, Error>,
        budget: &Budget,
    ) -> Result<Option<Cut>, Error> {
        let at_rest = self.at_rest();
        let root = match self.ground().sign(&at_rest.squared().coeff(0), budget)? {
            Ordering::Equal => Some((Real::from(Rational::ZERO), Side::Both)),
            _ => lowest_zero(self.ground(), fixed, budget)?,
        };
        let is_open_stable = || match &self.open[..] {
            [open] => Ok(self.ground().is_stable(&open.with_conjugate(), Shape::LeftHalfPlane, budget)?),
            _ => is_stable(&Rational::ZERO),
        };
        if root.is_none() && is_open_stable()? {
            return Ok(None);
        }
        Ok(Some(Cut::new(Real::from(Rational::ZERO), Happening::Open(root), BITS)))
    }

    /// `A` at `s = 0`.
    fn at_rest(&self) -> ComplexPoly<G::Number> {
        self.open.iter().fold(ComplexPoly::from(Poly::zero()), |sum, p| sum.plus(&p.coeff(0)))
    }

    /// The size of the factors from which on the difference operator is not stable; `None` where the factor is not in it.
    fn neutral(&self, budget: &Budget) -> Result<Option<Real>, Error> {
        let order = self.open[0].len();
        if self.back.len() < order {
            return Ok(None);
        }
        if self.back.len() > order || self.open[1..].iter().any(|p| p.len() >= order) {
            return Err(COMPLEX_FACTORS.diagnostic(&[]).into());
        }
        let [a, n] = [&self.open[0], &self.back].map(|p| p.leading().expect("not zero").squared().coeff(0));
        let square = self.ground().quotient(&a, &n, budget)?.number(budget)?;
        Ok(Some(square_root(&square, budget)?))
    }

    /// A frequency beyond which the modulus of the open loop is not above its limit at high ones; `None` where that is not so, or not told.
    fn falling_from(&self, budget: &Budget) -> Result<Option<Rational>, Exhausted> {
        let [open] = &self.open[..] else { return Ok(None) };
        let [below, above] = [open, &self.back].map(|p| p.along(0, Shape::LeftHalfPlane).squared());
        let [limit_below, limit_above] = [&below, &above].map(|p| p.leading().cloned().expect("not zero"));
        let mut excess = above.scaled(&limit_below).minus(&below.scaled(&limit_above));
        let sign = loop {
            let Some(leading) = excess.leading() else { return Ok(Some(self.unit())) };
            match self.ground().sign(leading, budget)? {
                Ordering::Equal => excess = Poly::new(excess.coeffs()[..excess.coeffs().len() - 1].to_vec()),
                sign => break sign,
            }
        };
        match sign.is_lt() && excess.degree().is_some_and(|n| n % 2 == 0) {
            true => self.beyond_zeros(&excess, budget).map(Some),
            false => Ok(None),
        }
    }

    /// A frequency beyond which roots on the axis move to the right as the factor grows.
    fn outward(&self, budget: &Budget) -> Result<Rational, Exhausted> {
        if let ([open], 1) = (&self.open[..], self.power) {
            return self.beyond_zeros(&self.motion(open), budget);
        }
        let [up, down] = [self.axis.tau().numerator(), self.axis.tau().denominator()];
        let by = |c: Integer| G::Number::from_integer(&c);
        // (p exp(-k tau s))' = (p' - k tau p) exp(-k tau s)
        let slope = |(k, p): (usize, &ComplexPoly<G::Number>)| {
            p.derivative().scaled(&by(down.clone())).plus(&p.scaled(&by(&up * &Integer::from(-(k as i64)))))
        };
        let own: Vec<_> = self.open.iter().enumerate().map(slope).collect();
        let half = Rational::new(&up * &Integer::from(self.power as i64), 2.into());
        let quotient = |above, below| DelayedQuotient::new(self.ground(), self.axis.tau().clone(), above, below);
        let beside = quotient(own, self.open.clone()).end(&half, budget)?;
        let back = quotient(vec![self.back.derivative().scaled(&by(down.clone()))], vec![self.back.clone()]);
        Ok(beside.max(back.end(&half, budget)?))
    }

    /// A polynomial in the frequency that is positive where roots move to the right as the factor grows: `Re(tau + A'/A - N'/N)` times the
    /// squares of both moduli.
    fn motion(&self, open: &ComplexPoly<G::Number>) -> Poly<G::Number> {
        let [d, n] = [open, &self.back].map(|p| p.along(0, Shape::LeftHalfPlane));
        let [below, above] = [d.squared(), n.squared()];
        // p'/p = -j (dp/domega)/p. Its real part is Im(dp/domega conj(p))/|p|^2.
        let turned = |p: &ComplexPoly<G::Number>| {
            let [_, imaginary] = p.derivative().times_conjugate(p);
            imaginary
        };
        let tau = self.axis.tau();
        let [up, down] = [tau.numerator(), tau.denominator()].map(|c| G::Number::from_integer(&c));
        let own = turned(&d).times(&above).minus(&turned(&n).times(&below));
        below.times(&above).scaled(&up).plus(&own.scaled(&down))
    }

    /// A size beyond all zeros of a polynomial in the frequency.
    fn beyond_zeros(&self, p: &Poly<G::Number>, budget: &Budget) -> Result<Rational, Exhausted> {
        let zeros = self.ground().zeros(p, &Range::all(), budget)?;
        let size = |x: &Real| {
            let (low, high) = x.refined(&self.unit()).enclosure();
            low.abs().max(high.abs())
        };
        let furthest = zeros.first().into_iter().chain(zeros.last()).map(size).max();
        Ok(furthest.unwrap_or(Rational::ZERO) + self.unit())
    }

    /// The inverse of the dead time.
    fn unit(&self) -> Rational {
        self.axis.tau().recip().expect("a dead time is not 0")
    }

    fn ground(&self) -> &G {
        self.axis.ground()
    }
}

impl Reached {
    /// The part of a range outside of which the loop is not stable; `None` where more factors have to be looked at.
    fn looked_at(
        &self,
        range: &Range,
        is_stable: &dyn Fn(&Rational) -> Result<bool, Error>,
        budget: &Budget,
    ) -> Result<Option<Range>, Error> {
        let mut ends = Vec::new();
        for (end, sign) in [(&range.lower, -1), (&range.upper, 1)] {
            let known = end.as_ref().filter(|end| *end * &Rational::from(sign) <= self.reach).cloned();
            let found = match (known, &self.inner) {
                (None, Some(inner)) => self.unstable_from(inner, sign, is_stable, budget)?,
                (known, _) => known,
            };
            let Some(found) = found else { return Ok(None) };
            ends.push(found);
        }
        let upper = ends.pop();
        Ok(Some(Range::between(ends.pop(), upper)))
    }

    /// A factor of this sign, with a greater size than a number, at which the loop is not stable; the least that is found between two crossings.
    fn unstable_from(
        &self,
        from: &Rational,
        sign: i64,
        is_stable: &dyn Fn(&Rational) -> Result<bool, Error>,
        budget: &Budget,
    ) -> Result<Option<Rational>, Error> {
        let (to, mut from) = (&self.reach, from.clone());
        let is_own = |c: &&Cut| (sign > 0) == c.enclosure.lower().sign().is_gt();
        let mut sizes: Vec<[Rational; 2]> = self.crossings.iter().filter(is_own).map(Cut::sizes).collect();
        sizes.sort();
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
}

fn is_stable(family: &FamilyLoop, value: &Rational, budget: &Budget) -> Result<bool, Error> {
    match family.count(value, budget) {
        Ok(count) => Ok(count.is_some_and(|count| count.is_stable())),
        Err(NotCounted::Neutral) => Err(COMPLEX_FACTORS.diagnostic(&[]).into()),
        Err(NotCounted::Stopped(stopped)) => Err(stopped.into()),
    }
}
