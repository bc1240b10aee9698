//! Roots of discrete loops inside the logarithmic spiral of a damping, counted by the principle of the argument.
//!
//! A continuous pair `s = w (-d +- j sqrt(1 - d^2))` is sampled to `z = exp(s T)`: a damping of at least `d` is
//! `|z| <= exp(-c |arg z|)`, `c = d/sqrt(1 - d^2)`. The edge is `z = exp((-c + j) phi)`, `0 <= phi <= pi`, with its conjugate. But
//! for `z = 1` no point of it is algebraic, by the theorem of Gelfond and Schneider (`|z| = exp(j phi)^(j c)`), so that the
//! roots of a polynomial with rational coefficients are never on it: a count at a rational point ends.

use crate::precisions::ROOTS_IN_SPIRAL;
use jurist_algebra::ball::{Ball, cos_sin, exp};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Poly, UniPoly};

/// A complex number in balls.
#[derive(Clone, Debug)]
pub(super) struct Complex {
    pub re: Ball,
    pub im: Ball,
}

impl Complex {
    fn zero(bits: u64) -> Complex {
        Complex { re: Ball::zero(bits), im: Ball::zero(bits) }
    }

    pub fn plus(&self, other: &Complex) -> Complex {
        Complex { re: self.re.add(&other.re), im: self.im.add(&other.im) }
    }

    fn times(&self, other: &Complex) -> Complex {
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
    fn halves(&self) -> [Arc; 2] {
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
pub(super) struct Values {
    middle: Rational,
    whole: [Rational; 2],
}

impl Values {
    pub fn of(value: &Rational) -> Values {
        Values { middle: value.clone(), whole: [value.clone(), value.clone()] }
    }

    pub fn between(lower: &Rational, upper: &Rational) -> Values {
        Values { middle: lower.midpoint(upper), whole: [lower.clone(), upper.clone()] }
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
    /// In `z` over the polynomials in the parameter.
    polynomial: Poly<UniPoly>,
    slope: Poly<UniPoly>,
    damping: Rational,
}

/// The balls that depend on the precision alone.
struct Constants {
    bits: u64,
    pi: Ball,
    /// `c`.
    decay: Ball,
}

/// What a walk along the edge gave.
pub(super) enum Walk {
    /// The number of roots inside.
    Count(usize),
    /// The arcs, from the first on, on which the function was not told from zero.
    Open(Vec<Arc>),
}

/// The edge is cut into `2^FIRST_LEVEL` arcs at first.
const FIRST_LEVEL: u64 = 5;
/// So far all open arcs are halved, however many.
const EVERYWHERE: u64 = 8;

impl OnSpiral {
    /// Of a polynomial in `z` over those in the parameter.
    pub fn new(polynomial: &Poly<UniPoly>, damping: &Rational) -> OnSpiral {
        let slope = polynomial.map(UniPoly::derivative);
        OnSpiral { polynomial: polynomial.clone(), slope, damping: damping.clone() }
    }

    /// Of a polynomial without parameter.
    pub fn without_parameter(p: &UniPoly, damping: &Rational) -> OnSpiral {
        OnSpiral::new(&p.map(|c| UniPoly::constant(c.clone())), damping)
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
        let constants = self.constants(bits);
        let plane = |arc: &Arc| {
            checkpoint(bits * self.polynomial.coeffs().len() as u64);
            self.on(&arc.ends(), values, &constants).half_plane()
        };
        let first = (0..1i64 << FIRST_LEVEL).map(|k| Arc { at: Integer::from(k), level: FIRST_LEVEL });
        let mut arcs: Vec<(Arc, Option<u8>)> = first.map(|arc| (plane(&arc), arc)).map(|(p, arc)| (arc, p)).collect();
        for level in FIRST_LEVEL..halvings {
            let open = arcs.iter().filter(|(_, plane)| plane.is_none()).count();
            if open == 0 || (open > most_open && level >= EVERYWHERE) {
                break;
            }
            let halved = |(arc, known): (Arc, Option<u8>)| match known {
                Some(_) => vec![(arc, known)],
                None => arc.halves().map(|half| (plane(&half), half)).map(|(p, half)| (half, p)).to_vec(),
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

    /// Function and derivatives at the middle of a range of angles and values.
    pub fn at_middle(&self, angles: &[Rational; 2], values: &Values, bits: u64) -> Jet {
        let with = self.constants(bits);
        let z = self.point(&angles[0].midpoint(&angles[1]), &with);
        self.jet(&z, &Values::of(&values.middle), &with)
    }

    /// Whether the function vanishes at most once in a box of angles (in parts of pi) and values: its derivatives are
    /// independent, whatever they are inside, which makes it one to one on a convex set.
    pub fn is_one_to_one(&self, angles: &[Rational; 2], values: &Values, bits: u64) -> bool {
        let with = self.constants(bits);
        let z = self.around(&self.point(&angles[0].midpoint(&angles[1]), &with), angles, &with);
        let Jet { by_angle, by_parameter, .. } = self.jet(&z, values, &with);
        let determinant = by_angle.re.mul(&by_parameter.im).sub(&by_angle.im.mul(&by_parameter.re));
        !determinant.contains_zero()
    }

    fn constants(&self, bits: u64) -> Constants {
        let square = &self.damping * &self.damping;
        let ratio = square.checked_div(&(Rational::ONE - &square)).expect("a damping is below 1");
        let decay = Ball::from_rational(&ratio, bits).sqrt().expect("positive");
        Constants { bits, pi: Ball::from_enclosure(&Enclosure::pi(bits + 4), bits), decay }
    }

    /// `z` at an angle, in parts of pi.
    fn point(&self, angle: &Rational, with: &Constants) -> Complex {
        let angle = Ball::from_rational(angle, with.bits).mul(&with.pi);
        let size = exp(&with.decay.mul(&angle).neg());
        let (cos, sin) = cos_sin(&angle);
        Complex { re: size.mul(&cos), im: size.mul(&sin) }
    }

    /// `z` for all angles of a range, from that in the middle.
    fn around(&self, z: &Complex, [from, to]: &[Rational; 2], with: &Constants) -> Complex {
        // |dz/dphi| = |z| |-c + j| <= 1 + c.
        let half = Ball::from_rational(&(to - from), with.bits).mul(&with.pi).shifted(-1);
        let radius = half.mul(&with.decay.add(&Ball::from_integer(&Integer::ONE, with.bits))).magnitude_units();
        Complex { re: z.re.widened(&radius), im: z.im.widened(&radius) }
    }

    fn jet(&self, z: &Complex, values: &Values, with: &Constants) -> Jet {
        let k = Ball::between(&values.whole[0], &values.whole[1], with.bits);
        let at = |c: &UniPoly| {
            let number = |c: &Integer| Ball::from_integer(c, with.bits);
            c.coeffs().iter().rev().fold(Ball::zero(with.bits), |sum, c| sum.mul(&k).add(&number(c)))
        };
        let horner = |c: &[Ball]| {
            c.iter().rev().fold(Complex::zero(with.bits), |sum, c| {
                let product = sum.times(z);
                Complex { re: product.re.add(c), im: product.im }
            })
        };
        let coefficients: Vec<Ball> = self.polynomial.coeffs().iter().map(at).collect();
        let weighted: Vec<Ball> =
            coefficients.iter().enumerate().map(|(i, c)| c.scaled(&Integer::from(i as i64))).collect();
        let slopes: Vec<Ball> = self.slope.coeffs().iter().map(at).collect();
        let one = Ball::from_integer(&Integer::ONE, with.bits);
        let turn = Complex { re: with.decay.neg(), im: one };
        Jet { value: horner(&coefficients), by_angle: horner(&weighted).times(&turn), by_parameter: horner(&slopes) }
    }

    /// The function on an arc: by its value in the middle and its derivatives on the whole.
    fn on(&self, angles: &[Rational; 2], values: &Values, with: &Constants) -> Complex {
        let z = self.point(&angles[0].midpoint(&angles[1]), with);
        let value = self.jet(&z, &Values::of(&values.middle), with).value;
        let whole = self.jet(&self.around(&z, angles, with), values, with);
        let side = |from: &Rational, to: &Rational| {
            let half = (to - from) * Rational::dyadic(&Integer::ONE, 1);
            Ball::between(&-&half, &half, with.bits)
        };
        let aside = side(&angles[0], &angles[1]).mul(&with.pi);
        let along = side(&values.whole[0], &values.whole[1]);
        value.plus(&whole.by_angle.scaled(&aside)).plus(&whole.by_parameter.scaled(&along))
    }
}
