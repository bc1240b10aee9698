//! The greatest modulus, along the imaginary axis, of a quotient of polynomials in `s` and `exp(-tau s)`.
//!
//! The square of the modulus is a function of `omega`, `cos(tau omega)` and `sin(tau omega)`; its extremes are zeros of another one. Beyond some frequency
//! the modulus is proved to be below a value that it has somewhere: there the part of the denominator without delay outweighs all else.

use super::delayed_axis::{DelayedAxis, place_of};
use super::ground::{Constants, Ground, Integers};
use super::parts::without_denominators;
use super::{Extreme, Place, Value};
use crate::error::Error;
use crate::model::Symbols;
use crate::problem::{BaseDelay, base_delay};
use crate::stability::Range;
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
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

/// Two polynomials in `s` and `exp(-tau s)`: the coefficients of `exp(-tau s)^k` at `[k]`, polynomials in constants.
pub(super) struct DelayedTransfer {
    tau: Rational,
    parts: [Vec<Poly<MultiPoly>>; 2],
    ground: Constants,
}

impl DelayedTransfer {
    /// From coefficients of powers of `s`, the denominator first, in which symbols are constants and exponentials of dead times.
    ///
    /// # Errors
    /// [`Error::Refused`] for dead times that are not multiples of one.
    pub fn new(lists: [Vec<RationalFunction>; 2], symbols: &Symbols) -> Result<DelayedTransfer, Error> {
        let delays = symbols.delays();
        let (BaseDelay::Number(tau), powers) = base_delay(&delays)? else { unreachable!("no name is free") };
        let multiple = |variable: usize| {
            delays.iter().position(|(v, _)| *v - symbols.first() == variable).map_or(0, |i| powers[i])
        };
        let parts = without_denominators(lists).map(|p| by_powers(&p, multiple));
        Ok(DelayedTransfer { tau, parts, ground: Constants::beside_delays(symbols)? })
    }

    /// The extreme of the square of the modulus, as [`DelayedQuotient::peak`].
    ///
    /// # Errors
    /// As [`DelayedQuotient::peak`].
    pub fn peak(&self, budget: &Budget) -> Result<Extreme, Exhausted> {
        let number = |c: &MultiPoly| c.as_constant();
        let numbers = |p: &Poly<MultiPoly>| p.coeffs().iter().map(number).collect::<Option<_>>().map(Poly::new);
        let all = |parts: &Vec<Poly<MultiPoly>>| parts.iter().map(numbers).collect::<Option<Vec<UniPoly>>>();
        let [below, above] = &self.parts;
        match (all(below), all(above)) {
            (Some(below), Some(above)) => DelayedQuotient::new(&Integers, self.tau.clone(), above, below).peak(budget),
            _ => DelayedQuotient::new(&self.ground, self.tau.clone(), above.clone(), below.clone()).peak(budget),
        }
    }
}

/// The coefficients of each power of `exp(-tau s)`; `multiple` is the power that a variable stands for.
fn by_powers(p: &Poly<MultiPoly>, multiple: impl Fn(usize) -> usize) -> Vec<Poly<MultiPoly>> {
    let mut parts = vec![Poly::zero()];
    for (j, c) in p.coeffs().iter().enumerate() {
        for (monomial, c) in c.terms() {
            let (mut k, mut own) = (0, monomial.exponents().to_vec());
            for (variable, e) in own.iter_mut().enumerate().filter(|(variable, _)| multiple(*variable) > 0) {
                k += multiple(variable) * std::mem::take(e) as usize;
            }
            while parts.len() <= k {
                parts.push(Poly::zero());
            }
            let term = MultiPoly::from_terms([(own, c.clone())]);
            parts[k] = parts[k].plus(&Poly::monomial(term, j));
        }
    }
    parts
}

/// `A/B`, the coefficients of `exp(-tau s)^k` at `[k]`, without a root of `B` on the axis.
pub(super) struct DelayedQuotient<G: Ground> {
    axis: DelayedAxis<G>,
    above: Vec<Poly<G::Number>>,
    below: Vec<Poly<G::Number>>,
}

impl<G: Ground> DelayedQuotient<G> {
    /// From the coefficients of `exp(-tau s)^k` at `[k]`; `below` has no root on the axis.
    pub fn new(
        ground: &G,
        tau: Rational,
        above: Vec<Poly<G::Number>>,
        below: Vec<Poly<G::Number>>,
    ) -> DelayedQuotient<G> {
        DelayedQuotient { axis: DelayedAxis::new(ground, tau), above, below }
    }

    /// The extreme of the square of the modulus.
    ///
    /// Cost: the zeros of its slope up to the frequency beyond which a bound tells.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where the greatest modulus may be one that is approached at high frequencies.
    pub fn peak(&self, budget: &Budget) -> Result<Extreme, Exhausted> {
        let [above, below] = [&self.above, &self.below].map(|parts| self.square(parts));
        let slope = self.axis.derivative(&above).times(&below).minus(&above.times(&self.axis.derivative(&below)));
        let at_zero = |parts: &[Poly<G::Number>]| {
            let sum = parts.iter().fold(G::Number::zero(), |sum, p| sum.plus(&p.coeff(0)));
            sum.times(&sum)
        };
        let lowest = self.ground().quotient(&at_zero(&self.above), &at_zero(&self.below), budget)?;
        let slope = without_squares_of_sine(&slope);
        if slope.is_zero() {
            return Ok(Extreme::Constant(lowest));
        }
        let known = budget.enter(|| self.known(&lowest, [&above, &below]))?;
        let (end, limit) = match (self.end(&known, budget), self.limit(budget)?) {
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
        let mut best = (Place::Lowest, lowest.number(budget)?);
        for omega in self.axis.zeros(&slope, &end, budget)? {
            let value = self.axis.quotient(&above, &below, &omega);
            if value.compare(&best.1, budget)? == Ordering::Greater {
                best = (place_of(&omega), value);
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
    fn known(&self, lowest: &Value, squares: [&MultiPoly; 2]) -> Rational {
        let unit = self.unit();
        let frequency = |octave: i64, k: i64| {
            let part = Rational::ONE + Rational::new(k.into(), IN_AN_OCTAVE.into());
            &(&unit * &part) * &Rational::from(2).pow(octave).expect("two is not zero")
        };
        let all = OCTAVES.flat_map(|octave| (0..IN_AN_OCTAVE).map(move |k| (octave, k)));
        let at = |(octave, k)| self.axis.quotient_at(squares, &frequency(octave, k), BITS);
        let found = all.filter_map(at).map(|value| value.lower().clone()).max();
        let square = found.into_iter().chain([lowest.enclosure(BITS).lower().clone()]).max().expect("there is one");
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
            match weights.iter().position(|(own, _)| is_multiple(p, own)) {
                Some(i) => {
                    let ratio = self.ratio(p, weights[i].0, budget)?;
                    weights[i].1 += &ratio * &weight;
                }
                None => weights.push((p, weight)),
            }
        }
        weights[0].1 = value - &weights[0].1;
        let common = weights.iter().fold(Integer::ONE, |l, (_, weight)| l.lcm(&weight.denominator()));
        let whole = |weight: &Rational| G::Number::from_integer(&(weight * &Rational::from(&common)).numerator());
        let modulus = |(p, weight): &(&Poly<G::Number>, Rational)| {
            let [re, im] = along_axis(p);
            re.times(&re).plus(&im.times(&im)).scaled(&whole(weight).times(&whole(weight)))
        };
        let outweighed = match &weights[1..] {
            [one] => modulus(one),
            several => {
                let mut sum = Poly::zero();
                for (p, weight) in several {
                    sum = sum.plus(&self.sizes(p, budget)?.scaled(&whole(weight)));
                }
                sum.times(&sum)
            }
        };
        let excess = modulus(&weights[0]).minus(&outweighed);
        let leading = excess.leading().map(|c| self.ground().sign(c, budget)).transpose()?;
        if !weights[0].1.sign().is_gt() || !leading.is_some_and(|sign| sign.is_gt()) {
            let why = "the peak gain may be approached at high frequencies only";
            return Err(Exhausted::new(Stop::Method(why.into()), "peak gain"));
        }
        let zeros = self.ground().zeros(&excess, &Range::between(Some(Rational::ZERO), None), budget)?;
        let last = zeros.last().map_or(Rational::ZERO, |x| x.refined_to_digits(2).enclosure().1);
        Ok(&last + &(&(&last + &self.unit()) * &Rational::new(1.into(), 64.into())))
    }

    /// The modulus that is come near to, again and again, at high frequencies: there `exp(-j omega tau)` is 1 and -1 in turn. `None` where the terms with the
    /// highest power of `s` are not all in phase at one of these, and where it is not rational.
    fn limit(&self, budget: &Budget) -> Result<Option<Rational>, Exhausted> {
        let Some(order) = self.below[0].degree() else { return Ok(None) };
        if self.above.iter().chain(&self.below).any(|p| p.degree().is_some_and(|degree| degree > order)) {
            return Ok(None);
        }
        let highest = |parts: &[Poly<G::Number>]| -> Vec<G::Number> { parts.iter().map(|p| p.coeff(order)).collect() };
        let (above, below) = (highest(&self.above), highest(&self.below));
        let sum = |list: &[G::Number]| -> Result<G::Number, Exhausted> {
            let sizes = list.iter().map(|c| self.size(c, budget)).collect::<Result<Vec<_>, _>>()?;
            Ok(sizes.iter().fold(G::Number::zero(), |sum, c| sum.plus(c)))
        };
        let outweighing = self.size(&below[0], budget)?.minus(&sum(&below[1..])?);
        let sum_above = sum(&above)?;
        if self.ground().sign(&outweighing, budget)?.is_eq() || self.ground().sign(&sum_above, budget)?.is_eq() {
            return Ok(None);
        }
        let at = |list: &[G::Number], sign: i64| {
            let power = |k: usize| G::Number::from_integer(&Integer::from(if k.is_multiple_of(2) { 1 } else { sign }));
            list.iter().enumerate().fold(G::Number::zero(), |sum, (k, c)| sum.plus(&c.times(&power(k))))
        };
        for sign in [1, -1] {
            let [own_above, own_below] = [at(&above, sign), at(&below, sign)];
            let [p, q] = [own_above.times(&outweighing), own_below.times(&sum_above)];
            if self.ground().sign(&p.times(&p).minus(&q.times(&q)), budget)?.is_eq() {
                let limit = self.ground().quotient(&sum_above, &outweighing, budget)?.number(budget)?.exact();
                return Ok(limit.filter(|limit| limit.sign().is_gt()));
            }
        }
        Ok(None)
    }

    fn ground(&self) -> &G {
        self.axis.ground()
    }

    /// At least the size of the factor that makes the first polynomial of the second one.
    fn ratio(&self, p: &Poly<G::Number>, own: &Poly<G::Number>, budget: &Budget) -> Result<Rational, Exhausted> {
        let leading = |p: &Poly<G::Number>| self.size(p.leading().expect("not zero"), budget);
        let ratio = self.ground().quotient(&leading(p)?, &leading(own)?, budget)?;
        budget.enter(|| ratio.enclosure(BITS).upper().clone())
    }

    /// The absolute value.
    fn size(&self, c: &G::Number, budget: &Budget) -> Result<G::Number, Exhausted> {
        Ok(if self.ground().sign(c, budget)?.is_lt() { c.negated() } else { c.clone() })
    }

    /// The polynomial with the absolute values of the coefficients.
    fn sizes(&self, p: &Poly<G::Number>, budget: &Budget) -> Result<Poly<G::Number>, Exhausted> {
        let sizes = p.coeffs().iter().map(|c| self.size(c, budget)).collect::<Result<_, _>>()?;
        Ok(Poly::new(sizes))
    }

    /// The square of the modulus of `sum a_k z^k` at `s = j omega`: the sum of `2 Re(a_k conj(a_l) z^(k - l))`.
    fn square(&self, parts: &[Poly<G::Number>]) -> MultiPoly {
        let along: Vec<[Poly<G::Number>; 2]> = parts.iter().map(along_axis).collect();
        let (cos, sin) = (MultiPoly::variable(1), MultiPoly::variable(2));
        let (mut turn, mut out) = ([MultiPoly::one(), MultiPoly::zero()], MultiPoly::zero());
        for m in 0..parts.len() {
            let (mut re, mut im) = (Poly::zero(), Poly::zero());
            for [a, b] in along[m..].iter().zip(&along).map(|(a, b)| [a, b]) {
                re = re.plus(&a[0].times(&b[0])).plus(&a[1].times(&b[1]));
                im = im.plus(&a[1].times(&b[0])).minus(&a[0].times(&b[1]));
            }
            let [re, im] = [&re, &im].map(|p| self.axis.of_omega(p));
            let term = re.times(&turn[0]).plus(&im.times(&turn[1]));
            out = out.plus(&term.scaled_by(&Integer::from(if m == 0 { 1 } else { 2 })));
            turn = [turn[0].times(&cos).minus(&turn[1].times(&sin)), turn[1].times(&cos).plus(&turn[0].times(&sin))]
                .map(|p| without_squares_of_sine(&p));
        }
        without_squares_of_sine(&out)
    }

    /// The inverse of the dead time.
    fn unit(&self) -> Rational {
        self.axis.tau().recip().expect("a dead time is not 0")
    }
}

/// Whether one polynomial is the other times a number.
fn is_multiple<R: Domain>(p: &Poly<R>, own: &Poly<R>) -> bool {
    match (p.leading(), own.leading()) {
        (Some(a), Some(b)) => p.scaled(b) == own.scaled(a),
        _ => false,
    }
}

/// The real and the imaginary part at `s = j omega`.
fn along_axis<R: Domain>(p: &Poly<R>) -> [Poly<R>; 2] {
    [0, 1].map(|odd| {
        let of = |(i, c): (usize, &R)| match (i % 2 == odd, (i / 2).is_multiple_of(2)) {
            (true, true) => c.clone(),
            (true, false) => c.negated(),
            (false, _) => R::zero(),
        };
        Poly::new(p.coeffs().iter().enumerate().map(of).collect())
    })
}

/// The same function of the frequency with the sine to the first power at most.
fn without_squares_of_sine(p: &MultiPoly) -> MultiPoly {
    let square = MultiPoly::one().minus(&MultiPoly::variable(1).power(2));
    let mut out = MultiPoly::zero();
    for (monomial, c) in p.terms() {
        let mut exponents = monomial.exponents().to_vec();
        exponents.resize(exponents.len().max(3), 0);
        let pairs = exponents[2] / 2;
        exponents[2] %= 2;
        let rest = MultiPoly::from_terms([(exponents, c.clone())]);
        out = out.plus(&rest.times(&square.power(u64::from(pairs))));
    }
    out
}
