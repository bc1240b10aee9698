//! Roots of discrete loops inside the logarithmic spiral of a damping, counted by the principle of the argument.
//!
//! A continuous pair `s = w (-d +- j sqrt(1 - d^2))` is sampled to `z = exp(s T)`: a damping of at least `d` is
//! `|z| <= exp(-c |arg z|)`, `c = d/sqrt(1 - d^2)`. The edge is `z = exp((-c + j) phi)`, `0 <= phi <= pi`, with its conjugate. But
//! for `z = 1` no point of it is algebraic, by the theorem of Gelfond and Schneider (`|z| = exp(j phi)^(j c)`), so that the
//! roots of a polynomial with rational coefficients are never on it: a count at a rational point ends. With other coefficients it may
//! end without an answer.

use crate::precisions::ROOTS_IN_SPIRAL;
use crate::stability::SymbolicPolynomial;
use jurist_algebra::ball::{Ball, cos_sin, exp};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::symbols::MovingSymbols;
use std::collections::HashMap;
use std::sync::{Arc as Shared, Mutex, PoisonError};

/// A complex number in balls.
#[derive(Clone, Debug)]
pub(super) struct Complex {
    pub re: Ball,
    pub im: Ball,
}

impl Complex {
    pub fn zero(bits: u64) -> Complex {
        Complex { re: Ball::zero(bits), im: Ball::zero(bits) }
    }

    pub fn plus(&self, other: &Complex) -> Complex {
        Complex { re: self.re.add(&other.re), im: self.im.add(&other.im) }
    }

    pub fn times(&self, other: &Complex) -> Complex {
        let re = self.re.mul(&other.re).sub(&self.im.mul(&other.im));
        let im = self.re.mul(&other.im).add(&self.im.mul(&other.re));
        Complex { re, im }
    }

    pub fn scaled(&self, by: &Ball) -> Complex {
        Complex { re: self.re.mul(by), im: self.im.mul(by) }
    }

    /// A half plane that holds it: 0, 1, 2, 3 for that of 1, j, -1, -j.
    fn half_plane(&self) -> Option<u8> {
        let of = |part: &Ball, positive: u8| match part.sign() {
            Some(sign) if sign.is_gt() => Some(positive),
            Some(sign) if sign.is_lt() => Some(positive + 2),
            _ => None,
        };
        of(&self.re, 0).or_else(|| of(&self.im, 1))
    }
}

/// A part of the edge: `phi/pi` from `at 2^-level` to `(at + 1) 2^-level`.
#[derive(Clone, Debug)]
pub(super) struct Arc {
    pub at: Integer,
    pub level: u64,
}

impl Arc {
    /// The lower and the upper half.
    pub fn parts(&self) -> [Arc; 2] {
        let first = &self.at << 1;
        let second = &first + &Integer::ONE;
        [first, second].map(|at| Arc { at, level: self.level + 1 })
    }

    /// The ends in parts of `pi`.
    pub fn ends(&self) -> [Rational; 2] {
        [self.at.clone(), &self.at + &Integer::ONE].map(|k| Rational::dyadic(&k, self.level))
    }
}

/// A value of the parameter, or all of an interval.
#[derive(Clone, Debug)]
pub(super) struct Values([Rational; 2]);

impl Values {
    pub fn of(value: &Rational) -> Values {
        Values([value.clone(), value.clone()])
    }

    pub fn between(lower: &Rational, upper: &Rational) -> Values {
        Values([lower.clone(), upper.clone()])
    }
}

/// The function of the angle and the parameter, and its derivatives, with balls of some width.
pub(super) struct Jet {
    pub value: Complex,
    pub by_angle: Complex,
    pub by_parameter: Complex,
}

/// `P(exp((-c + j) phi); K)`.
#[derive(Clone, Debug)]
pub(super) struct OnSpiral {
    /// Of the powers of `z`, and of those of `z - 1`: polynomials in the parameter and symbols. The roots of a loop with a short sample
    /// time are near to 1, where only the second ones tell how small the function is.
    coefficients: [Shared<[MultiPoly]>; 2],
    symbols: Shared<MovingSymbols>,
    damping: Rational,
    usual: Rational,
    /// Terms of the Taylor polynomials in the parameter: with a sample time that goes to 0 all coefficients vanish but one.
    terms: usize,
    /// Points of the edge: all walks begin with the same arcs.
    points: Shared<Mutex<HashMap<(Rational, u64), Complex>>>,
}

/// Which number the powers are counted from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    Zero,
    One,
}

impl Origin {
    /// The nearer one to the points at some angles, in parts of pi: of less than a quarter all are nearer to 1.
    pub fn of(angles: &[Rational; 2]) -> Origin {
        if angles[1] <= Rational::dyadic(&Integer::ONE, 2) { Origin::One } else { Origin::Zero }
    }

    /// The distance from it.
    pub fn to(self, z: &Complex) -> Complex {
        let one = Ball::from_integer(&Integer::ONE, z.re.bits());
        match self {
            Origin::Zero => z.clone(),
            Origin::One => Complex { re: z.re.sub(&one), im: z.im.clone() },
        }
    }
}

/// The coefficients at a value, or over an interval.
struct Coefficients {
    origin: Origin,
    middle: Vec<Ball>,
    /// With the derivatives by the parameter.
    whole: Vec<[Ball; 2]>,
}

/// The balls that depend on the precision alone.
pub(super) struct Constants {
    pub bits: u64,
    pub pi: Ball,
    /// `c`.
    pub decay: Ball,
}

impl Constants {
    /// Of a damping, with so many bits.
    pub fn new(damping: &Rational, bits: u64) -> Constants {
        let square = damping * damping;
        let ratio = square.checked_div(&(Rational::ONE - &square)).expect("a damping is below 1");
        let decay = Ball::from_rational(&ratio, bits).sqrt().expect("positive");
        Constants { bits, pi: Ball::from_enclosure(&Enclosure::pi(bits + 4), bits), decay }
    }
}

/// What a walk along the edge gave.
pub(super) enum Walk {
    /// The number of roots inside.
    Count(usize),
    /// The arcs, from the first on, on which the function was not told from zero.
    Open(Vec<Arc>),
}

/// The edge is cut into `2^FIRST_LEVEL` arcs at first.
pub(super) const FIRST_LEVEL: u64 = 5;
/// No more points are remembered.
const MOST_POINTS: usize = 1 << 15;
/// So far all open arcs are halved, however many.
const EVERYWHERE: u64 = 8;

impl OnSpiral {
    /// Of a closed loop in one parameter or none; `None` where a coefficient is not defined beside the parameter.
    pub fn of(p: &SymbolicPolynomial, damping: &Rational) -> Option<OnSpiral> {
        let one_more = Poly::new(vec![MultiPoly::one(), MultiPoly::one()]);
        let coefficients = [p.polynomial().clone(), p.polynomial().compose(&one_more)].map(|p| p.into_coeffs().into());
        let (symbols, usual) = (p.moving_symbols()?, p.usual().clone());
        let terms = if p.fixed_symbols().is_some() { 2 } else { p.formal_degree() + 2 };
        Some(OnSpiral { coefficients, symbols, damping: damping.clone(), usual, terms, points: Shared::default() })
    }

    /// [`point`], remembered.
    fn known_point(&self, angle: Rational, with: &Constants) -> Complex {
        let known = || self.points.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (angle, with.bits);
        if let Some(found) = known().get(&key) {
            return found.clone();
        }
        let found = point(&key.0, with);
        let mut known = known();
        if known.len() >= MOST_POINTS {
            known.clear();
        }
        known.insert(key, found.clone());
        found
    }

    /// A usual value of the parameter.
    pub fn usual(&self) -> &Rational {
        &self.usual
    }

    /// The degree of the polynomial.
    pub fn degree(&self) -> usize {
        self.coefficients[0].len() - 1
    }

    /// The coefficients that are used at some angles; `None` where one is not defined for all values.
    fn coefficients(&self, origin: Origin, values: &Values, bits: u64) -> Option<Coefficients> {
        let list = &self.coefficients[origin as usize];
        let Values([from, to]) = values;
        if from == to {
            let whole = self.symbols.jets(list, &Ball::from_rational(from, bits))?;
            return Some(Coefficients {
                origin,
                middle: whole.iter().map(|[value, _]| value.clone()).collect(),
                whole,
            });
        }
        // f(from + t (to - from)) = f + s t + ...: terms that cancel do so in each coefficient.
        let taylor = self.symbols.taylor_from_end(list, from, to, self.terms, bits)?;
        let part = Ball::between(&Rational::ZERO, &Rational::ONE, bits);
        let length = Ball::from_rational(&(to - from), bits);
        let at = |terms: &[Ball], t: &Ball| terms.iter().rev().fold(Ball::zero(bits), |sum, c| sum.mul(t).add(c));
        let half = Ball::from_rational(&Rational::dyadic(&Integer::ONE, 1), bits);
        let (mut middle, mut whole) = (Vec::with_capacity(list.len()), Vec::with_capacity(list.len()));
        for terms in taylor {
            let slope = terms.iter().enumerate().skip(1).map(|(i, c)| c.scaled(&Integer::from(i as i64)));
            middle.push(at(&terms, &half));
            whole.push([at(&terms, &part), at(&slope.collect::<Vec<_>>(), &part).div(&length)?]);
        }
        Some(Coefficients { origin, middle, whole })
    }

    /// The number of roots inside at a rational value at which 1 is no root.
    ///
    /// Cost: two evaluations of the polynomial on each arc; arcs shrink in proportion to the distance of the nearest root.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn count_at(&self, value: &Rational, budget: &Budget) -> Result<usize, Exhausted> {
        ROOTS_IN_SPIRAL.decide("counting roots inside a spiral", |bits| {
            budget.check()?;
            Ok(match budget.enter(|| self.walk(&Values::of(value), bits, bits, usize::MAX))? {
                Walk::Count(count) => Some(count),
                Walk::Open(_) => None,
            })
        })
    }

    /// Walks along the edge, halving arcs so often at most, and only while no more of them are open.
    pub fn walk(&self, values: &Values, bits: u64, halvings: u64, most_open: usize) -> Walk {
        let constants = Constants::new(&self.damping, bits);
        let first = (0..1i64 << FIRST_LEVEL).map(|k| Arc { at: Integer::from(k), level: FIRST_LEVEL });
        let known = [Origin::Zero, Origin::One].map(|origin| self.coefficients(origin, values, bits));
        let [Some(from_zero), Some(from_one)] = known else { return Walk::Open(first.collect()) };
        let plane = |arc: &Arc| {
            checkpoint(bits * self.degree() as u64);
            let angles = arc.ends();
            let coefficients = if Origin::of(&angles) == Origin::One { &from_one } else { &from_zero };
            let z = self.known_point(angles[0].midpoint(&angles[1]), &constants);
            on(coefficients, &z, (&angles, values), &constants).half_plane()
        };
        let mut arcs: Vec<(Arc, Option<u8>)> = first.map(|arc| (plane(&arc), arc)).map(|(p, arc)| (arc, p)).collect();
        for level in FIRST_LEVEL..halvings {
            let open = arcs.iter().filter(|(_, plane)| plane.is_none()).count();
            if open == 0 || (open > most_open && level >= EVERYWHERE) {
                break;
            }
            let halved = |(arc, known): (Arc, Option<u8>)| match known {
                Some(_) => vec![(arc, known)],
                None => arc.parts().map(|half| (plane(&half), half)).map(|(p, half)| (half, p)).to_vec(),
            };
            arcs = arcs.into_iter().flat_map(halved).collect();
        }
        if arcs.iter().any(|(_, plane)| plane.is_none()) {
            return Walk::Open(arcs.into_iter().filter(|(_, plane)| plane.is_none()).map(|(arc, _)| arc).collect());
        }
        let planes: Vec<u8> = arcs.iter().filter_map(|(_, plane)| *plane).collect();
        // Neighbouring arcs share a point: one half plane is never followed by the opposite one.
        let turn = |pair: &[u8]| match (pair[1] + 4 - pair[0]) % 4 {
            1 => 1,
            3 => -1,
            _ => 0i64,
        };
        let quarters: i64 = planes.windows(2).map(turn).sum();
        // The function is real at both ends, so that the argument turns by half turns.
        Walk::Count(usize::try_from(quarters / 2).unwrap_or(0))
    }

    /// Function and derivatives at an angle, in parts of pi, and a value; `None` where a coefficient is not defined.
    pub fn at_point(&self, angle: &Rational, value: &Rational, bits: u64) -> Option<Jet> {
        let with = Constants::new(&self.damping, bits);
        let origin = Origin::of(&[angle.clone(), angle.clone()]);
        let coefficients = self.coefficients(origin, &Values::of(value), bits)?;
        Some(jet(&point(angle, &with), &coefficients, &with))
    }

    /// Whether the function vanishes at most once in a box of angles (in parts of pi) and values: its derivatives are
    /// independent, whatever they are inside, which makes it one to one on a convex set.
    pub fn is_one_to_one(&self, angles: &[Rational; 2], values: &Values, bits: u64) -> bool {
        let with = Constants::new(&self.damping, bits);
        let Some(coefficients) = self.coefficients(Origin::of(angles), values, bits) else { return false };
        let z = around(&point(&angles[0].midpoint(&angles[1]), &with), angles, &with);
        let Jet { by_angle, by_parameter, .. } = jet(&z, &coefficients, &with);
        let determinant = by_angle.re.mul(&by_parameter.im).sub(&by_angle.im.mul(&by_parameter.re));
        !determinant.contains_zero()
    }
}

/// `z` at an angle, in parts of pi.
pub(super) fn point(angle: &Rational, with: &Constants) -> Complex {
    let angle = Ball::from_rational(angle, with.bits).mul(&with.pi);
    let size = exp(&with.decay.mul(&angle).neg());
    let (cos, sin) = cos_sin(&angle);
    Complex { re: size.mul(&cos), im: size.mul(&sin) }
}

/// `z` for all angles of a range, from that in the middle.
fn around(z: &Complex, [from, to]: &[Rational; 2], with: &Constants) -> Complex {
    // |dz/dphi| = |z| |-c + j| <= 1 + c.
    let half = Ball::from_rational(&(to - from), with.bits).mul(&with.pi).shifted(-1);
    let radius = half.mul(&with.decay.add(&Ball::from_integer(&Integer::ONE, with.bits))).magnitude_units();
    Complex { re: z.re.widened(&radius), im: z.im.widened(&radius) }
}

/// The value of the polynomial with these coefficients, from the constant term up.
fn horner<'c>(coefficients: impl DoubleEndedIterator<Item = &'c Ball>, z: &Complex, bits: u64) -> Complex {
    coefficients.rev().fold(Complex::zero(bits), |sum, c| {
        let product = sum.times(z);
        Complex { re: product.re.add(c), im: product.im }
    })
}

fn jet(z: &Complex, coefficients: &Coefficients, with: &Constants) -> Jet {
    let (whole, at) = (&coefficients.whole, coefficients.origin.to(z));
    let derivative: Vec<Ball> =
        whole.iter().enumerate().skip(1).map(|(i, [c, _])| c.scaled(&Integer::from(i as i64))).collect();
    let one = Ball::from_integer(&Integer::ONE, with.bits);
    // dz/dphi
    let turn = Complex { re: with.decay.neg(), im: one }.times(z);
    Jet {
        value: horner(whole.iter().map(|[c, _]| c), &at, with.bits),
        by_angle: horner(derivative.iter(), &at, with.bits).times(&turn),
        by_parameter: horner(whole.iter().map(|[_, slope]| slope), &at, with.bits),
    }
}

/// The function on an arc with this point in the middle: by its value in the middle and its derivatives on the whole.
fn on(
    coefficients: &Coefficients,
    z: &Complex,
    (angles, values): (&[Rational; 2], &Values),
    with: &Constants,
) -> Complex {
    let value = horner(coefficients.middle.iter(), &coefficients.origin.to(z), with.bits);
    let whole = jet(&around(z, angles, with), coefficients, with);
    let side = |from: &Rational, to: &Rational| {
        let half = (to - from) * Rational::dyadic(&Integer::ONE, 1);
        Ball::between(&-&half, &half, with.bits)
    };
    let aside = side(&angles[0], &angles[1]).mul(&with.pi);
    let along = side(&values.0[0], &values.0[1]);
    value.plus(&whole.by_angle.scaled(&aside)).plus(&whole.by_parameter.scaled(&along))
}
