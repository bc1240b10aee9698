//! The greatest modulus, along the imaginary axis, of a quotient of polynomials in `s` and `exp(-tau s)`.
//!
//! The square of the modulus is a function of `omega`, `cos(tau omega)` and `sin(tau omega)`; its extremes are zeros of another one. Beyond some frequency
//! the modulus is proved to be below a value that it has somewhere: there the part of the denominator without delay outweighs all else.

use super::complex_poly::ComplexPoly;
use super::crossings::COMPARED_BITS;
use super::delayed_axis::{DelayedAxis, without_squares_of_sine};
use super::enclosed::{greater, within};
use super::ground::Ground;
use super::{Extreme, Frequencies, Place, Value};
use crate::stability::{Range, Shape};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};

/// Frequencies at which the modulus is looked at first, as powers of two over the dead time, and so many between two of them.
const OCTAVES: std::ops::Range<i64> = -10..12;
const IN_AN_OCTAVE: i64 = 4;

/// Peaks are looked for up to these powers of two over the dead time, where values come down to a limit.
const PERIODS: [i64; 3] = [3, 5, 7];

/// Digits of the square of such a peak.
const DIGITS_OF_PEAK: usize = 20;

/// Bits of these values.
const BITS: u64 = 96;

/// Those of either sign, of complex coefficients.
pub(super) fn frequencies_of<'a, R: Domain + 'a>(mut parts: impl Iterator<Item = &'a ComplexPoly<R>>) -> Frequencies {
    match parts.all(ComplexPoly::is_real) {
        true => Frequencies::Positive(Shape::LeftHalfPlane),
        false => Frequencies::Signed(Shape::LeftHalfPlane),
    }
}

/// `A/B`, the coefficients of `exp(-tau s)^k` at `[k]`, without a root of `B` on the axis.
pub(super) struct DelayedQuotient<G: Ground> {
    axis: DelayedAxis<G>,
    above: Vec<ComplexPoly<G::Number>>,
    below: Vec<ComplexPoly<G::Number>>,
}

impl<G: Ground> DelayedQuotient<G> {
    /// From the coefficients of `exp(-tau s)^k` at `[k]`; `below` has no root on the axis.
    pub fn new(
        ground: &G,
        tau: Rational,
        above: Vec<ComplexPoly<G::Number>>,
        below: Vec<ComplexPoly<G::Number>>,
    ) -> DelayedQuotient<G> {
        let frequencies = frequencies_of(above.iter().chain(&below));
        DelayedQuotient { axis: DelayedAxis::new(ground, tau, frequencies), above, below }
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
        let at_zero = |parts: &[ComplexPoly<G::Number>]| {
            let none = ComplexPoly::from(Poly::zero());
            parts.iter().fold(none, |sum, p| sum.plus(&p.coeff(0))).squared().coeff(0)
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
        let mut best = (self.axis.at_rest(), lowest.number(budget)?);
        for omega in self.axis.zeros(&slope, &end, budget)? {
            let value = self.axis.quotient(&above, &below, &omega);
            let [own, known] = budget.enter(|| [&value, &best.1].map(|x| within(x, COMPARED_BITS)))?;
            if own.lower() > known.upper() {
                best = (self.axis.place_of(&omega), value);
            } else if own.upper() >= known.lower() {
                // A loop that is a real one seen from a frame that turns has the same peak at two frequencies.
                best.1 = greater(best.1, value);
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
        let all = all.flat_map(|place| self.signs().iter().map(move |sign| (place, Rational::from(*sign))));
        let at = |((octave, k), sign)| self.axis.quotient_at(squares, &(frequency(octave, k) * sign), BITS);
        let found = all.filter_map(at).map(|value| value.lower().clone()).max();
        let square = found.into_iter().chain([lowest.enclosure(BITS).lower().clone()]).max().expect("there is one");
        Enclosure::from_rational(square).sqrt(BITS).lower().clone().max(Rational::ZERO)
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
                best = best.max(Enclosure::from_rational(least).sqrt(BITS).lower().clone());
            }
            match self.end(&best, budget) {
                Err(stopped) if !stopped.stop.is_budget() => {}
                end => return end,
            }
        }
        Err(stopped)
    }

    /// A frequency beyond which the modulus is below a value: there `A` and the delayed terms of `B` are outweighed.
    pub fn end(&self, value: &Rational, budget: &Budget) -> Result<Rational, Exhausted> {
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
        let ends = self.signs().iter().map(|sign| self.end_on_side(&weights, *sign, budget));
        Ok(ends.collect::<Result<Vec<_>, _>>()?.into_iter().max().expect("there is one"))
    }

    /// A size beyond which, at frequencies of one sign, the first polynomial times its weight is greater than all others.
    fn end_on_side(
        &self,
        weights: &[(&ComplexPoly<G::Number>, Rational)],
        sign: i64,
        budget: &Budget,
    ) -> Result<Rational, Exhausted> {
        let common = weights.iter().fold(Integer::ONE, |l, (_, weight)| l.lcm(&weight.denominator()));
        let whole = |weight: &Rational| G::Number::from_integer(&(weight * &Rational::from(&common)).numerator());
        let modulus = |(p, weight): &(&ComplexPoly<G::Number>, Rational)| {
            let square = along_axis(p).squared().scaled(&whole(weight).times(&whole(weight)));
            if sign < 0 { square.negated_argument() } else { square }
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
        let Some(order) = self.below[0].len().checked_sub(1) else { return Ok(None) };
        if self.above.iter().chain(&self.below).any(|p| p.len() > order + 1) {
            return Ok(None);
        }
        let unit = self.below[0].coeff(order);
        let mut highest = Vec::new();
        for p in self.above.iter().chain(&self.below) {
            // Relative to that of the denominator without delay, a real number where all are in phase.
            let [c, aside] = match unit.is_real() && p.is_real() {
                true => [p.re.coeff(order), G::Number::zero()],
                false => p.coeff(order).times_conjugate(&unit).map(|c| c.coeff(0)),
            };
            if self.ground().sign(&aside, budget)?.is_ne() {
                return Ok(None);
            }
            highest.push(c);
        }
        let below = highest.split_off(self.above.len());
        let above = highest;
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
    fn ratio(
        &self,
        p: &ComplexPoly<G::Number>,
        own: &ComplexPoly<G::Number>,
        budget: &Budget,
    ) -> Result<Rational, Exhausted> {
        let [a, b] = [p, own].map(|p| p.leading().expect("not zero"));
        if a.is_real() && b.is_real() {
            let [a, b] = [self.size(&a.re.coeff(0), budget)?, self.size(&b.re.coeff(0), budget)?];
            let ratio = self.ground().quotient(&a, &b, budget)?;
            return budget.enter(|| ratio.enclosure(BITS).upper().clone());
        }
        let square = self.ground().quotient(&a.squared().coeff(0), &b.squared().coeff(0), budget)?;
        budget.enter(|| square.enclosure(BITS).sqrt(BITS).upper().clone())
    }

    /// The absolute value.
    fn size(&self, c: &G::Number, budget: &Budget) -> Result<G::Number, Exhausted> {
        Ok(if self.ground().sign(c, budget)?.is_lt() { c.negated() } else { c.clone() })
    }

    /// A polynomial with coefficients that are at least the absolute values of these.
    fn sizes(&self, p: &ComplexPoly<G::Number>, budget: &Budget) -> Result<Poly<G::Number>, Exhausted> {
        let sizes = |p: &Poly<G::Number>| -> Result<Poly<G::Number>, Exhausted> {
            Ok(Poly::new(p.coeffs().iter().map(|c| self.size(c, budget)).collect::<Result<_, _>>()?))
        };
        Ok(sizes(&p.re)?.plus(&sizes(&p.im)?))
    }

    /// The square of the modulus of `sum a_k z^k` at `s = j omega`: the sum of `2 Re(a_k conj(a_l) z^(k - l))`.
    fn square(&self, parts: &[ComplexPoly<G::Number>]) -> MultiPoly {
        let along: Vec<ComplexPoly<G::Number>> = parts.iter().map(along_axis).collect();
        let mut out = MultiPoly::zero();
        for m in 0..parts.len() {
            let (mut re, mut im) = (Poly::zero(), Poly::zero());
            for (a, b) in along[m..].iter().zip(&along) {
                let [own_re, own_im] = a.times_conjugate(b);
                (re, im) = (re.plus(&own_re), im.plus(&own_im));
            }
            let [term, _] = self.axis.turned(&[re, im], m as i64);
            out = out.plus(&term.scaled_by(&Integer::from(if m == 0 { 1 } else { 2 })));
        }
        without_squares_of_sine(&out)
    }

    /// The square of the modulus at a rational frequency, with some bits; `None` where they tell nothing.
    pub fn square_at(&self, omega: &Rational, bits: u64) -> Option<Enclosure> {
        let [above, below] = [&self.above, &self.below].map(|parts| self.square(parts));
        self.axis.quotient_at([&above, &below], omega, bits)
    }

    /// The signs of the frequencies.
    fn signs(&self) -> &'static [i64] {
        if self.axis.is_signed() { &[1, -1] } else { &[1] }
    }

    /// The inverse of the dead time.
    fn unit(&self) -> Rational {
        self.axis.tau().recip().expect("a dead time is not 0")
    }
}

/// Whether one polynomial is the other times a number.
fn is_multiple<R: Domain>(p: &ComplexPoly<R>, own: &ComplexPoly<R>) -> bool {
    match (p.leading(), own.leading()) {
        (Some(a), Some(b)) => p.times(&b) == own.times(&a),
        _ => false,
    }
}

/// The polynomial at `s = j omega`.
fn along_axis<R: Domain>(p: &ComplexPoly<R>) -> ComplexPoly<R> {
    p.along(0, Shape::LeftHalfPlane)
}
