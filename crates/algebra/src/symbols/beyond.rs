//! Bounds of symbols for all large values of a parameter they die away with.

use super::{Definition, MovingSymbols};
use crate::ball::{Ball, BallMatrix, exp, exponential};
use crate::number::{Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};

/// Bits of the bounds.
pub(super) const BITS: u64 = 256;

/// The pieces into which a time is divided at least.
const PIECES: u64 = 64;

/// Doublings of a piece after which a time is too long for what happens in it.
const MOST_DOUBLINGS: u32 = 24;

/// Bounds of more bits than this are of no use.
const LARGEST_BITS: u64 = 48;

impl MovingSymbols {
    /// A bound of a polynomial in symbols, without the parameter itself, for every value of the parameter from `start` on;
    /// `None` where a symbol does not die away or is not bounded yet.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
    /// use jurist_algebra::symbols::{Definition, MovingSymbols};
    /// let minus = -&RationalFunction::variable(0);
    /// let symbols = MovingSymbols::new(vec![("X".into(), Definition::Exponential(minus))]);
    /// let p = MultiPoly::one().plus(&MultiPoly::variable(1)); // 1 + exp(-T)
    /// let bound = symbols.beyond(&p, &Rational::from(10)).unwrap();
    /// assert!(bound.lower() >= Rational::ONE && bound.upper() < "1.0001".parse().unwrap());
    /// ```
    ///
    /// Cost: exponentials of small matrices.
    pub fn beyond(&self, p: &MultiPoly, start: &Rational) -> Option<Ball> {
        if p.degree_in(0) > 0 {
            return None;
        }
        let mut values = vec![Ball::zero(BITS)];
        for (_, definition) in self.table() {
            values.push(bound(definition, start)?);
        }
        let mut sum = Ball::zero(BITS);
        for (monomial, c) in p.terms() {
            let factors = values.iter().enumerate().skip(1).map(|(i, v)| v.power(u64::from(monomial.exponent(i))));
            sum = sum.add(&factors.fold(Ball::from_integer(c, BITS), |a, b| a.mul(&b)));
        }
        Some(sum)
    }
}

/// `a` and `b` of `a T + b`.
pub(super) fn linear(f: &RationalFunction) -> Option<(Rational, Rational)> {
    let scale = Rational::from(&f.denominator().as_constant()?).recip()?;
    let p = f.numerator().to_univariate(0)?;
    (p.degree() <= Some(1)).then(|| (&Rational::from(&p.coeff(1)) * &scale, &Rational::from(&p.coeff(0)) * &scale))
}

fn bound(definition: &Definition, start: &Rational) -> Option<Ball> {
    match definition {
        Definition::Exponential(x) => {
            let (slope, constant) = linear(x)?;
            if slope.sign().is_gt() {
                return None;
            }
            let at_start = exp(&Ball::from_rational(&(&(&slope * start) + &constant), BITS));
            let still = slope.is_zero();
            Some(if still { at_start } else { at_start.union(&Ball::zero(BITS)) })
        }
        Definition::Fundamental { polynomial, time, .. } => {
            let (slope, constant) = linear(time)?;
            if slope.sign().is_le() || constant.is_negative() {
                return None;
            }
            let n = polynomial.len() - 1;
            let c: Vec<Rational> = polynomial[..n].iter().map(RationalFunction::as_constant).collect::<Option<_>>()?;
            let least = dies_away(&c, &(&(&slope * start) + &constant))?;
            Some(least.neg().union(&least))
        }
        Definition::Root(x) => Ball::from_rational(&x.as_constant()?, BITS).sqrt(),
        Definition::Algebraic(x) => Some(Definition::enclosed(x, BITS)),
        Definition::Enclosed(x) => Some(x.at(BITS)),
        Definition::Pi | Definition::Tangent { .. } | Definition::Duty(_) | Definition::Family(_) => None,
    }
}

/// A bound of the entries of `exp(companion t)` for all `t` from a time on, where its norm has become less than 1/2.
fn dies_away(coefficients: &[Rational], time: &Rational) -> Option<Ball> {
    let (q, within) = decay(coefficients, time)?;
    (q.upper() < Rational::dyadic(&Integer::ONE, 1)).then(|| Ball::from_rational(&q.mul(&within).upper(), BITS))
}

/// The norm `q` of `exp(companion t)` at a time and the greatest norm `M` before it, as upper bounds: the norm from `j` times
/// that time on to the next multiple is at most `q^j M`.
pub(super) fn decay(coefficients: &[Rational], time: &Rational) -> Option<(Ball, Ball)> {
    let n = coefficients.len();
    let at = |t: &Ball| {
        exponential(&BallMatrix::from_fn(n, |i, j| {
            if i + 1 == n {
                Ball::from_rational(&coefficients[j], BITS).mul(t).neg()
            } else if j == i + 1 {
                t.clone()
            } else {
                Ball::zero(BITS)
            }
        }))
    };
    let norm = |m: &BallMatrix| {
        let row = |i: usize| (0..n).fold(Integer::ZERO, |sum, j| sum + m.at(i, j).magnitude_units());
        let units = (0..n).map(row).max().unwrap_or(Integer::ZERO);
        Ball::from_units(units.clone(), units, BITS)
    };
    let too_large = Rational::from(&(Integer::ONE << LARGEST_BITS));
    // A piece short enough for its exponential to be near one, and how often it is doubled to make the whole.
    let size = coefficients.iter().fold(Rational::ONE, |sum, c| sum + c.abs());
    let mut doublings = PIECES.ilog2();
    let mut piece = time * &Rational::new(Integer::ONE, Integer::from(PIECES));
    while &piece * &size > Rational::ONE {
        piece *= Rational::dyadic(&Integer::ONE, 1);
        doublings += 1;
        if doublings > MOST_DOUBLINGS {
            return None;
        }
    }
    let mut whole = at(&Ball::from_rational(&piece, BITS));
    // The norm within the first piece, within twice as much, and so on.
    let mut within = norm(&at(&Ball::between(&Rational::ZERO, &piece, BITS)));
    let one = Ball::from_integer(&Integer::ONE, BITS);
    for _ in 0..doublings {
        // What lies in the second half is what lies in the first, times the step to the middle.
        let step = norm(&whole);
        within = within.union(&within.mul(&step)).union(&one);
        whole = whole.mul(&whole);
        if within.upper() > too_large {
            return None;
        }
    }
    Some((norm(&whole), within))
}
