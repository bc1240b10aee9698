//! The greatest modulus, along the imaginary axis, of a quotient of polynomials in `s` and `exp(-tau s)`.
//!
//! The square of the modulus is a function of `omega`, `cos(tau omega)` and `sin(tau omega)`; its extremes are zeros of another one. Beyond some frequency
//! the modulus is proved to be below a value that it has somewhere: there the part of the denominator without delay outweighs all else.

use super::delayed_axis::DelayedAxis;
use super::parts::without_denominators;
use super::{Extreme, Place, Value};
use crate::coverage::refusals::BESIDE_DEAD_TIME;
use crate::error::Error;
use crate::model::Symbols;
use crate::problem::{BaseDelay, base_delay};
use crate::stability::{Range, zeros_in};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// Frequencies at which the modulus is looked at first, as powers of two over the dead time, and so many between two of them.
const OCTAVES: std::ops::Range<i64> = -10..12;
const IN_AN_OCTAVE: i64 = 4;

/// Peaks are looked for up to these powers of two over the dead time, where values come down to a limit.
const PERIODS: [i64; 3] = [3, 5, 7];

/// Digits of the square of such a peak.
const DIGITS_OF_PEAK: usize = 20;

/// Bits of these values.
const BITS: u64 = 96;

/// `A/B`, the coefficients of `exp(-tau s)^k` at `[k]`, without a root of `B` on the axis.
pub(super) struct DelayedQuotient {
    axis: DelayedAxis,
    above: Vec<UniPoly>,
    below: Vec<UniPoly>,
}

impl DelayedQuotient {
    /// From coefficients of powers of `s`, the denominator first, in which the symbols are exponentials of dead times.
    ///
    /// # Errors
    /// [`Error::Refused`] where there are other symbols, and for dead times that are not multiples of one.
    pub fn of(
        below: Vec<RationalFunction>,
        above: Vec<RationalFunction>,
        symbols: &Symbols,
    ) -> Result<DelayedQuotient, Error> {
        let delays = symbols.delays();
        if symbols.iter().count() > delays.len() {
            return Err(BESIDE_DEAD_TIME.diagnostic(&[]).into());
        }
        let (BaseDelay::Number(tau), powers) = base_delay(&delays)? else { unreachable!("no name is free") };
        let [below, above] = without_denominators([below, above]);
        let multiple = |variable: usize| {
            delays.iter().position(|(v, _)| *v - symbols.first() == variable).map_or(0, |i| powers[i])
        };
        let [below, above] = [&below, &above].map(|p| by_powers(p, multiple));
        Ok(DelayedQuotient::new(tau, above, below))
    }

    /// From the coefficients of `exp(-tau s)^k` at `[k]`; `below` has no root on the axis.
    pub fn new(tau: Rational, above: Vec<UniPoly>, below: Vec<UniPoly>) -> DelayedQuotient {
        DelayedQuotient { axis: DelayedAxis::new(tau), above, below }
    }

    /// The extreme of the square of the modulus.
    ///
    /// Cost: the zeros of its slope up to the frequency beyond which a bound tells.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where the greatest modulus may be one that is approached at high frequencies.
    pub fn peak(&self, budget: &Budget) -> Result<Extreme, Exhausted> {
        let [above, below] = [&self.above, &self.below].map(|parts| square(parts));
        let slope = self.axis.derivative(&above).times(&below).minus(&above.times(&self.axis.derivative(&below)));
        let at_zero = |p: &MultiPoly| p.eval(&[Rational::ZERO, Rational::ONE, Rational::ZERO]);
        let lowest = at_zero(&above).checked_div(&at_zero(&below)).expect("no root is at 0");
        let slope = without_squares_of_sine(&slope);
        if slope.is_zero() {
            return Ok(Extreme::Constant(Value::from(lowest)));
        }
        let (end, limit) = match (self.end(&self.known(&lowest, [&above, &below]), budget), self.limit()) {
            // Moduli may rise to a limit.
            (Err(stopped), Some(limit)) if !stopped.stop.is_budget() => match self.end(&limit, budget) {
                // Moduli may also fall to it: then there is a greater one.
                Err(stopped) if !stopped.stop.is_budget() => {
                    (self.end_above((&limit, stopped), [&above, &below], &slope, budget)?, None)
                }
                end => (end?, Some(limit)),
            },
            (end, _) => (end?, None),
        };
        let mut best = (Place::Lowest, Real::from(lowest));
        for omega in self.axis.zeros(&slope, &end, budget)? {
            let value = self.axis.quotient(&above, &below, &omega);
            if value.compare(&best.1, budget)? == Ordering::Greater {
                best = (DelayedAxis::place(&omega), value);
            }
        }
        if let Some(square) = limit.map(|limit| &limit * &limit)
            && best.1.compare_rational(&square).is_le()
        {
            return Ok(Extreme::At { place: Place::Highest, value: Value::from(square), attained: false });
        }
        Ok(Extreme::At { place: best.0, value: Value::Number(best.1), attained: true })
    }

    /// A modulus that is not above the greatest one of some frequencies.
    fn known(&self, lowest: &Rational, squares: [&MultiPoly; 2]) -> Rational {
        let unit = self.unit();
        let frequency = |octave: i64, k: i64| {
            let part = Rational::ONE + Rational::new(k.into(), IN_AN_OCTAVE.into());
            &(&unit * &part) * &Rational::from(2).pow(octave).expect("two is not zero")
        };
        let all = OCTAVES.flat_map(|octave| (0..IN_AN_OCTAVE).map(move |k| (octave, k)));
        let at = |(octave, k)| self.axis.quotient_at(squares, &frequency(octave, k), BITS);
        let found = all.filter_map(at).map(|value| value.lower().clone()).max();
        let square = found.into_iter().chain([lowest.clone()]).max().expect("there is one");
        jurist_algebra::number::Enclosure::from_rational(square).sqrt(BITS).lower().clone().max(Rational::ZERO)
    }

    /// A frequency beyond which the modulus is below one that is above the limit; the error where no such modulus is found.
    fn end_above(
        &self,
        (limit, stopped): (&Rational, Exhausted),
        [above, below]: [&MultiPoly; 2],
        slope: &MultiPoly,
        budget: &Budget,
    ) -> Result<Rational, Exhausted> {
        for octave in PERIODS {
            let reach = self.unit() * Rational::from(2).pow(octave).expect("two is not zero");
            let mut best = limit.clone();
            for omega in self.axis.zeros(slope, &reach, budget)? {
                let square = self.axis.quotient(above, below, &omega);
                let least = budget.enter(|| square.refined_to_digits(DIGITS_OF_PEAK).enclosure().0)?;
                best = best.max(jurist_algebra::number::Enclosure::from_rational(least).sqrt(BITS).lower().clone());
            }
            match self.end(&best, budget) {
                Err(stopped) if !stopped.stop.is_budget() => {}
                end => return end,
            }
        }
        Err(stopped)
    }

    /// A frequency beyond which the modulus is below a value: there `A` and the delayed terms of `B` are outweighed.
    fn end(&self, value: &Rational, budget: &Budget) -> Result<Rational, Exhausted> {
        // Moduli of polynomials with their weights, those that are multiples of each other together.
        let mut weights = vec![(&self.below[0], Rational::ZERO)];
        let all = self.above.iter().map(|p| (p, Rational::ONE));
        for (p, weight) in all.chain(self.below[1..].iter().map(|p| (p, value.clone()))).filter(|(p, _)| !p.is_zero()) {
            match weights.iter_mut().find_map(|(own, sum)| Some((multiple(p, own)?, sum))) {
                Some((ratio, sum)) => *sum += &ratio * &weight,
                None => weights.push((p, weight)),
            }
        }
        weights[0].1 = value - &weights[0].1;
        let common = weights.iter().fold(Integer::ONE, |l, (_, weight)| l.lcm(&weight.denominator()));
        let whole = |weight: &Rational| (weight * &Rational::from(&common)).numerator();
        let modulus = |(p, weight): &(&UniPoly, Rational)| {
            let [re, im] = along_axis(p);
            re.times(&re).plus(&im.times(&im)).scaled(&(&whole(weight) * &whole(weight)))
        };
        let outweighed = match &weights[1..] {
            [one] => modulus(one),
            several => {
                let sizes = several.iter().map(|(p, weight)| sizes(p).scaled(&whole(weight)));
                let sum = sizes.fold(UniPoly::zero(), |sum, one| sum.plus(&one));
                sum.times(&sum)
            }
        };
        let excess = modulus(&weights[0]).minus(&outweighed);
        if !weights[0].1.sign().is_gt() || !excess.leading().is_some_and(|c| c.sign().is_gt()) {
            let why = "the peak gain may be approached at high frequencies only";
            return Err(Exhausted::new(Stop::Method(why.into()), "peak gain"));
        }
        let zeros = zeros_in(&excess, &Range::between(Some(Rational::ZERO), None), budget)?;
        let last = zeros.last().map_or(Rational::ZERO, |x| x.refined_to_digits(2).enclosure().1);
        Ok(&last + &(&(&last + &self.unit()) * &Rational::new(1.into(), 64.into())))
    }

    /// The modulus that is come near to, again and again, at high frequencies: there `exp(-j omega tau)` is 1 and -1 in turn. `None` where the terms with the
    /// highest power of `s` are not all in phase at one of these.
    fn limit(&self) -> Option<Rational> {
        let order = self.below[0].degree()?;
        let highest = |parts: &[UniPoly]| -> Option<Vec<Rational>> {
            let is_low = parts.iter().all(|p| p.degree().is_none_or(|degree| degree <= order));
            is_low.then(|| parts.iter().map(|p| Rational::from(p.coeff(order))).collect())
        };
        let (above, below) = (highest(&self.above)?, highest(&self.below)?);
        let sum = |list: &[Rational]| list.iter().fold(Rational::ZERO, |sum, c| sum + c.abs());
        let outweighing = below[0].abs() - sum(&below[1..]);
        let limit = sum(&above).checked_div(&outweighing).filter(|limit| limit.sign().is_gt())?;
        let at = |list: &[Rational], sign: i64| {
            let power = |k: usize| Rational::from(if k.is_multiple_of(2) { 1 } else { sign });
            list.iter().enumerate().fold(Rational::ZERO, |sum, (k, c)| sum + c * &power(k)).abs()
        };
        let is_in_phase = |sign: &i64| at(&above, *sign).checked_div(&at(&below, *sign)).as_ref() == Some(&limit);
        [1, -1].iter().any(is_in_phase).then_some(limit)
    }

    /// The inverse of the dead time.
    fn unit(&self) -> Rational {
        self.axis.tau().recip().expect("a dead time is not 0")
    }
}

/// The size of a factor that makes the first polynomial of the second one.
fn multiple(p: &UniPoly, own: &UniPoly) -> Option<Rational> {
    let (a, b) = (p.leading()?, own.leading()?);
    (p.scaled(b) == own.scaled(a)).then(|| Rational::new(a.clone(), b.clone()).abs())
}

/// The coefficients of each power of `exp(-tau s)`.
fn by_powers(p: &Poly<MultiPoly>, multiple: impl Fn(usize) -> usize) -> Vec<UniPoly> {
    let mut parts = vec![UniPoly::zero()];
    for (j, c) in p.coeffs().iter().enumerate() {
        for (monomial, c) in c.terms() {
            let k: usize = monomial.exponents().iter().enumerate().map(|(v, e)| multiple(v) * *e as usize).sum();
            while parts.len() <= k {
                parts.push(UniPoly::zero());
            }
            parts[k] = parts[k].plus(&UniPoly::monomial(c.clone(), j));
        }
    }
    parts
}

/// The real and the imaginary part at `s = j omega`.
fn along_axis(p: &UniPoly) -> [UniPoly; 2] {
    [0, 1].map(|odd| {
        let sign = |i: usize| if (i / 2).is_multiple_of(2) { Integer::ONE } else { -Integer::ONE };
        let of = |(i, c): (usize, &Integer)| if i % 2 == odd { c * &sign(i) } else { Integer::ZERO };
        UniPoly::new(p.coeffs().iter().enumerate().map(of).collect())
    })
}

fn sizes(p: &UniPoly) -> UniPoly {
    UniPoly::new(p.coeffs().iter().map(Integer::abs).collect())
}

/// The square of the modulus of `sum a_k z^k` at `s = j omega`: the sum of `2 Re(a_k conj(a_l) z^(k - l))`.
fn square(parts: &[UniPoly]) -> MultiPoly {
    let along: Vec<[UniPoly; 2]> = parts.iter().map(along_axis).collect();
    let (cos, sin) = (MultiPoly::variable(1), MultiPoly::variable(2));
    let (mut turn, mut out) = ([MultiPoly::one(), MultiPoly::zero()], MultiPoly::zero());
    for m in 0..parts.len() {
        let (mut re, mut im) = (UniPoly::zero(), UniPoly::zero());
        for [a, b] in along[m..].iter().zip(&along).map(|(a, b)| [a, b]) {
            re = re.plus(&a[0].times(&b[0])).plus(&a[1].times(&b[1]));
            im = im.plus(&a[1].times(&b[0])).minus(&a[0].times(&b[1]));
        }
        let [re, im] = [&re, &im].map(DelayedAxis::of_omega);
        let term = re.times(&turn[0]).plus(&im.times(&turn[1]));
        out = out.plus(&term.scaled_by(&Integer::from(if m == 0 { 1 } else { 2 })));
        turn = [turn[0].times(&cos).minus(&turn[1].times(&sin)), turn[1].times(&cos).plus(&turn[0].times(&sin))]
            .map(|p| without_squares_of_sine(&p));
    }
    without_squares_of_sine(&out)
}

/// The same function of the frequency with the sine to the first power at most.
fn without_squares_of_sine(p: &MultiPoly) -> MultiPoly {
    let square = MultiPoly::one().minus(&MultiPoly::variable(1).power(2));
    let mut out = MultiPoly::zero();
    for (monomial, c) in p.terms() {
        let mut exponents = [0, 1, 2].map(|v| monomial.exponent(v));
        let pairs = exponents[2] / 2;
        exponents[2] %= 2;
        let rest = MultiPoly::from_terms([(exponents.to_vec(), c.clone())]);
        out = out.plus(&rest.times(&square.power(u64::from(pairs))));
    }
    out
}
