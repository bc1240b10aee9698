//! Functions of the angular frequency with `cos(tau omega)` and `sin(tau omega)` in them: variables 0, 1 and 2 of polynomials. Symbols of the coefficients
//! follow.

use super::crossings::COMPARED_BITS;
use super::enclosed::{enclosed, within};
use super::ground::Ground;
use super::{Frequencies, Place};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, MovingSymbols};
use std::sync::Arc;

/// The cosine and the sine of `tau omega`. The function at a negative frequency is that of the mirrored one at the positive frequency.
pub(super) struct DelayedAxis<G> {
    ground: G,
    tau: Rational,
    is_signed: bool,
    turning: Arc<MovingSymbols>,
}

/// The range of frequencies is cut at fractions of its end. A zero at a short number, as at the speed of a frame, has no sign there that enclosures tell: a prime
/// in the end keeps such numbers inside of a part.
const BEYOND: i64 = 1010;

/// A zero is enclosed to so many digits before it is compared with the end of the frequencies.
const DIGITS: usize = 20;

/// So many variables are before the symbols of the coefficients.
const BEFORE: usize = 3;

impl<G: Ground> DelayedAxis<G> {
    pub fn new(ground: &G, tau: Rational, frequencies: Frequencies) -> DelayedAxis<G> {
        let time = &RationalFunction::variable(0) * &RationalFunction::from(tau.clone());
        let polynomial = vec![RationalFunction::one(), RationalFunction::zero(), RationalFunction::one()];
        let part = |name: &str, index| {
            (name.to_owned(), Definition::Fundamental { polynomial: polynomial.clone(), index, time: time.clone() })
        };
        let mut table = vec![part("cos", 0), part("sin", 1)];
        table.extend(ground.symbols_after(BEFORE));
        let is_signed = frequencies.are_signed();
        DelayedAxis { ground: ground.clone(), tau, is_signed, turning: Arc::new(MovingSymbols::new(table)) }
    }

    pub fn ground(&self) -> &G {
        &self.ground
    }

    pub fn tau(&self) -> &Rational {
        &self.tau
    }

    /// Whether negative frequencies are looked at.
    pub fn is_signed(&self) -> bool {
        self.is_signed
    }

    /// A polynomial in `omega`.
    pub fn of_omega(&self, p: &Poly<G::Number>) -> MultiPoly {
        self.ground.in_variable(p, BEFORE)
    }

    /// A polynomial in the variable of the frequencies, `omega` or `x = -omega^2`, as one in `omega`.
    pub fn even(&self, p: &Poly<G::Number>) -> MultiPoly {
        if self.is_signed {
            return self.of_omega(p);
        }
        let mut spread = Vec::new();
        for (i, c) in p.coeffs().iter().enumerate() {
            let sign = if i.is_multiple_of(2) { Integer::ONE } else { -Integer::ONE };
            spread.extend([c.times(&G::Number::from_integer(&sign)), G::Number::zero()]);
        }
        self.of_omega(&Poly::new(spread))
    }

    /// The same of an imaginary part, which is divided by `omega` where frequencies have no sign.
    pub fn odd(&self, p: &Poly<G::Number>) -> MultiPoly {
        match self.is_signed {
            true => self.of_omega(p),
            false => self.even(p).times(&MultiPoly::variable(0)),
        }
    }

    /// The real and the imaginary part, polynomials in `omega`, times `exp(-j omega tau)` to some power.
    pub fn turned(&self, [re, im]: &[Poly<G::Number>; 2], power: i64) -> [MultiPoly; 2] {
        let (cos, sin) = (MultiPoly::variable(1), MultiPoly::variable(2));
        let mut turn = [MultiPoly::one(), MultiPoly::zero()];
        for _ in 0..power.abs() {
            turn = [turn[0].times(&cos).minus(&turn[1].times(&sin)), turn[1].times(&cos).plus(&turn[0].times(&sin))]
                .map(|p| without_squares_of_sine(&p));
        }
        let [cos, sin] = turn;
        let sin = if power < 0 { sin.scaled_by(&-Integer::ONE) } else { sin };
        let [re, im] = [re, im].map(|p| self.of_omega(p));
        [re.times(&cos).plus(&im.times(&sin)), im.times(&cos).minus(&re.times(&sin))]
    }

    /// Ends where one of these frequencies may be a zero of a polynomial in the variable of some frequencies.
    pub fn keep_clear(
        &self,
        omegas: &[Real],
        p: &Poly<G::Number>,
        frequencies: Frequencies,
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        for zero in self.ground.zeros(p, &frequencies.inner(), budget)? {
            let zero = budget.enter(|| within(&zero, COMPARED_BITS))?;
            let is_near = |omega: &Real| {
                let omega = within(omega, COMPARED_BITS);
                let x = if frequencies.are_signed() { omega } else { omega.mul(&omega, COMPARED_BITS).neg() };
                x.lower() <= zero.upper() && x.upper() >= zero.lower()
            };
            if budget.enter(|| omegas.iter().any(is_near))? {
                return Err(Exhausted::new(Stop::Separation, "the open loop at its pole on the axis"));
            }
        }
        Ok(())
    }

    /// The derivative by `omega`, times the denominator of the dead time.
    pub fn derivative(&self, p: &MultiPoly) -> MultiPoly {
        let (up, down) = (self.tau.numerator(), self.tau.denominator());
        let by_cos = p.derivative(1).times(&MultiPoly::variable(2)).scaled_by(&(-up.clone()));
        let by_sin = p.derivative(2).times(&MultiPoly::variable(1)).scaled_by(&up);
        p.derivative(0).scaled_by(&down).plus(&by_cos).plus(&by_sin)
    }

    /// The frequencies of a size above 0 and below `end` at which a function vanishes, ascending.
    pub fn zeros(&self, p: &MultiPoly, end: &Rational, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        let above = self.zeros_above(p, end, budget)?;
        if !self.is_signed {
            return Ok(above);
        }
        let below = self.zeros_above(&mirrored(p), end, budget)?;
        Ok(below.iter().rev().map(Real::negated).chain(above).collect())
    }

    fn zeros_above(&self, p: &MultiPoly, end: &Rational, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        let beyond = end * &Rational::new(BEYOND.into(), (BEYOND - 1).into());
        let mut found = self.turning.zeros_in(&p.clone().into(), &Rational::ZERO, &beyond, &beyond, budget)?;
        budget.enter(|| found.zeros.retain(|x| x.refined_to_digits(DIGITS).enclosure().0 < *end))?;
        match found.undecided.is_empty() {
            true => Ok(found.zeros),
            false => Err(Exhausted::new(Stop::Separation, "frequencies of a loop with dead time")),
        }
    }

    /// An angular frequency as a place.
    pub fn place_of(&self, omega: &Real) -> Place {
        let omega = omega.clone();
        if self.is_signed {
            return Place::Inside(omega);
        }
        Place::Inside(enclosed("minus the square of a frequency", move |bits| {
            let omega = within(&omega, bits);
            Some(omega.mul(&omega, bits).neg())
        }))
    }

    /// The frequency 0 as a place.
    pub fn at_rest(&self) -> Place {
        if self.is_signed { Place::Inside(Real::from(Rational::ZERO)) } else { Place::Lowest }
    }

    /// `above/below` at an angular frequency.
    pub fn quotient(&self, above: &MultiPoly, below: &MultiPoly, at: &Real) -> Real {
        let (above, below, at, turning) = (above.clone(), below.clone(), at.clone(), Arc::clone(&self.turning));
        enclosed("quotient at a frequency", move |bits| {
            let (lo, hi) = at.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
            quotient(&turning, [&above, &below], &Ball::between(&lo, &hi, bits))
        })
    }

    /// The same at a rational frequency, with some bits; `None` where they tell nothing.
    pub fn quotient_at(&self, parts: [&MultiPoly; 2], omega: &Rational, bits: u64) -> Option<Enclosure> {
        quotient(&self.turning, parts, &Ball::between(omega, omega, bits))
    }
}

/// The same function of the frequency with the sine to the first power at most.
pub(super) fn without_squares_of_sine(p: &MultiPoly) -> MultiPoly {
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

/// A function at the opposite frequency.
fn mirrored(p: &MultiPoly) -> MultiPoly {
    MultiPoly::from_terms(p.terms().iter().map(|(monomial, c)| {
        let is_odd = (monomial.exponent(0) + monomial.exponent(2)) % 2 == 1;
        (monomial.exponents().to_vec(), if is_odd { -c.clone() } else { c.clone() })
    }))
}

fn quotient(turning: &MovingSymbols, [above, below]: [&MultiPoly; 2], omega: &Ball) -> Option<Enclosure> {
    let values = turning.enclose(&[above.clone(), below.clone()], omega)?;
    Some(values[0].div(&values[1])?.to_enclosure())
}
