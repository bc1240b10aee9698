//! Where on the boundary a complex pair sits at a limit of stability.

use super::interval_set::zeros_in;
use super::{HalfSizePair, ParametricPolynomial, Range, Shape};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, UniPoly, subresultant_chain};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// A pair of complex conjugate roots on the boundary, located by the half-size variable
/// `x = 2 cos(theta)` (unit disc) or `x = -omega^2` (left half plane).
///
/// It is found as the common root of the half-size pair: where the parameter is not rational, by Euclid's algorithm on enclosures
/// if that is the only one, else by subresultants ([BrownTraub1971](jurist_algebra::bibliography#browntraub1971)).
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, stable_set};
/// // z^2 - z + K: stable for 0 < K < 1, where the pair has the angle pi/3
/// let d = Poly::new(vec![UniPoly::from_i64(&[0, 1]), UniPoly::from_i64(&[-1]), UniPoly::from_i64(&[1])]);
/// let p = ParametricPolynomial::from_integral(&d, 2);
/// let set = stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// let pair = set.intervals()[0].upper.as_ref().unwrap().pair.as_ref().unwrap();
/// assert_eq!(pair.angle(64).unwrap().decimal(10).unwrap(), "1.047197551");
/// ```
#[derive(Clone, Debug)]
pub struct ComplexPair {
    region: Shape,
    x: HalfSizeRoot,
    side: Side,
}

/// Which roots of a pair of conjugates are roots of the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Both, as always where coefficients are real.
    Both,
    /// The one with a positive imaginary part.
    Upper,
    /// The other one.
    Lower,
}

#[derive(Clone, Debug)]
enum HalfSizeRoot {
    /// A real number of its own, such as an algebraic one where the parameter value is rational.
    Number(Real),
    /// The angular frequency instead.
    Frequency(Real),
    /// The only common root of two polynomials, whose coefficients are polynomials in an algebraic parameter value.
    Common { pair: [Poly<UniPoly>; 2], parameter: RealAlgebraic },
    /// The largest root of a polynomial with only real roots, whose coefficients are polynomials in
    /// an algebraic parameter value.
    Over { polynomial: Poly<UniPoly>, parameter: RealAlgebraic },
}

/// The complex pair of lowest frequency at an end of a stable interval, if there is one.
///
/// `value` must be a limit of stable parameter values at which the coefficients are finite and not
/// all zero: all roots are then in the closed region, so every mirror pair of roots is on the
/// boundary, and every common root `x` of the half-size pair lies in the closed interval `[-2, 2]`
/// or `(-inf, 0]`; the ends of the interval stand for double roots at `1`, `-1` and `0`. The greatest
/// common divisor at `value` is the first subresultant, from the lowest degree up, that does not vanish there.
pub(super) fn complex_pair_at(
    p: &ParametricPolynomial,
    value: &RealAlgebraic,
    region: Shape,
    budget: &Budget,
) -> Result<Option<ComplexPair>, Exhausted> {
    let ends: &[i64] = match region {
        Shape::UnitDisc => &[2, -2],
        Shape::LeftHalfPlane => &[0],
    };
    if let Some(exact) = value.exact() {
        return pair_at_rational(p, &exact, region, budget);
    }
    let pair = HalfSizePair::new(p.polynomial(), p.formal_degree(), region);
    let (first, second) = if pair.a.degree() >= pair.b.degree() { (pair.a, pair.b) } else { (pair.b, pair.a) };
    if second.is_zero() {
        return Ok(None);
    }
    let both = [first, second];
    let only =
        budget.enter(|| (0..PRECISIONS).any(|k| common_divisor(&both, value, FIRST_PRECISION << k).is_some()))?;
    if only {
        for &end in ends {
            let end = UniPoly::constant(Integer::from(end));
            if budget.enter(|| both.iter().all(|f| value.sign_of(&f.eval(&end)).is_eq()))? {
                return Ok(None);
            }
        }
        let x = HalfSizeRoot::Common { pair: both, parameter: value.clone() };
        return Ok(Some(ComplexPair::of(region, x)));
    }
    let chain = subresultant_chain(&both[0], &both[1], budget)?;
    let mut common = Poly::zero();
    for subresultant in chain.iter().rev() {
        common = at_parameter(subresultant, value, budget)?;
        if !common.is_zero() {
            break;
        }
    }
    for &end in ends {
        while !common.is_constant() {
            let (quotient, rest) = divide_by_linear(&common, end);
            if budget.enter(|| value.sign_of(&rest))? != Ordering::Equal {
                break;
            }
            common = quotient;
        }
    }
    let over = |polynomial| ComplexPair::of(region, HalfSizeRoot::Over { polynomial, parameter: value.clone() });
    Ok((!common.is_constant()).then(|| over(common)))
}

fn pair_at_rational(
    p: &ParametricPolynomial,
    value: &Rational,
    region: Shape,
    budget: &Budget,
) -> Result<Option<ComplexPair>, Exhausted> {
    let special = p.specialised(value);
    let Some(n) = special.degree().filter(|&n| n > 0) else { return Ok(None) };
    let pair = HalfSizePair::new(&special, n, region);
    let common = budget.enter(|| pair.a.gcd(&pair.b))?;
    let range = match region {
        Shape::UnitDisc => Range::between(Some(Rational::from(-2)), Some(Rational::from(2))),
        Shape::LeftHalfPlane => Range::between(None, Some(Rational::ZERO)),
    };
    let roots = zeros_in(&common, &range, budget)?;
    Ok(roots.into_iter().last().map(|x| ComplexPair::of(region, HalfSizeRoot::Number(x.into()))))
}

/// Bits of the first attempt to see that there is only one common root, and how often they are doubled.
const FIRST_PRECISION: u64 = 192;
const PRECISIONS: u32 = 4;

/// Enclosures of the coefficients of a linear common divisor `c_0 + c_1 x` at the parameter value, `c_1` not zero: Euclid's
/// algorithm until the degree is 1, if all leading coefficients on the way are seen not to be zero. `None` otherwise.
///
/// Of two polynomials that have a common root it is the greatest common divisor. `O(m^2)` operations for degree `m`.
fn common_divisor(pair: &[Poly<UniPoly>; 2], value: &RealAlgebraic, bits: u64) -> Option<[Enclosure; 2]> {
    let (lo, hi) = value.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
    let at = Enclosure::new(lo, hi);
    let enclosed =
        |f: &Poly<UniPoly>| -> Vec<Enclosure> { f.coeffs().iter().map(|c| c.eval_enclosure(&at, bits)).collect() };
    let (mut u, mut v) = (enclosed(&pair[0]), enclosed(&pair[1]));
    while v.len() > 2 {
        checkpoint(64 * (v.len() * (u.len() - v.len() + 1)) as u64);
        let top = v.pop()?;
        while u.len() > v.len() {
            let q = u.pop()?.div(&top, bits)?;
            let shift = u.len() - v.len();
            for (x, y) in u[shift..].iter_mut().zip(&v) {
                *x = x.sub(&q.mul(y, bits), bits);
            }
        }
        v.push(top);
        (u, v) = (v, u);
    }
    let [c0, c1] = <[Enclosure; 2]>::try_from(v).ok()?;
    (!c1.contains(&Rational::ZERO)).then_some([c0, c1])
}

/// The polynomial without the leading coefficients that vanish at the parameter value.
fn at_parameter(p: &Poly<UniPoly>, value: &RealAlgebraic, budget: &Budget) -> Result<Poly<UniPoly>, Exhausted> {
    let mut coeffs = p.coeffs().to_vec();
    while let Some(last) = coeffs.last() {
        if budget.enter(|| value.sign_of(last))?.is_ne() {
            break;
        }
        coeffs.pop();
    }
    Ok(Poly::new(coeffs))
}

/// Quotient and remainder by `x - a`.
fn divide_by_linear(p: &Poly<UniPoly>, a: i64) -> (Poly<UniPoly>, UniPoly) {
    let a = UniPoly::constant(Integer::from(a));
    let mut coeffs = p.coeffs().to_vec();
    for i in (1..coeffs.len()).rev() {
        coeffs[i - 1] = coeffs[i - 1].plus(&coeffs[i].times(&a));
    }
    let rest = coeffs.remove(0);
    (Poly::new(coeffs), rest)
}

impl ComplexPair {
    fn of(region: Shape, x: HalfSizeRoot) -> ComplexPair {
        ComplexPair { region, x, side: Side::Both }
    }

    /// The pair of a polynomial with each root and its conjugate, of which a complex loop has the roots on this side.
    pub fn on_side(self, side: Side) -> ComplexPair {
        ComplexPair { side, ..self }
    }

    /// Which of the two are roots of the loop.
    pub fn side(&self) -> Side {
        self.side
    }

    /// The pair with a given `2 cos(theta)` in `(-2, 2)`, or `-omega^2 < 0`.
    pub fn at_half_size_root(region: Shape, x: impl Into<Real>) -> ComplexPair {
        ComplexPair::of(region, HalfSizeRoot::Number(x.into()))
    }

    /// The pair `+-i omega` with a given positive `omega`.
    pub fn at_angular_frequency(omega: impl Into<Real>) -> ComplexPair {
        ComplexPair::of(Shape::LeftHalfPlane, HalfSizeRoot::Frequency(omega.into()))
    }

    /// The region on whose boundary the pair sits.
    pub fn region(&self) -> Shape {
        self.region
    }

    /// A certified enclosure of `2 cos(theta)`, or of `-omega^2`, whose width is about `2^-bits`
    /// relative to the distance from the nearest end of the interval.
    ///
    /// Cost: that of refining the parameter's value to a few times as many bits; where several pairs meet on the
    /// boundary, bisection instead, with `O(m)` exact signs at the parameter's value for each bit, `m` the number
    /// of pairs.
    pub fn half_size_root(&self, bits: u64) -> Enclosure {
        match &self.x {
            HalfSizeRoot::Number(x) => {
                let (lo, hi) = self.refine_number(x, bits);
                Enclosure::new(lo, hi)
            }
            HalfSizeRoot::Frequency(omega) => {
                let (lo, hi) = self.refine_square(omega, bits);
                Enclosure::new(lo, hi)
            }
            HalfSizeRoot::Common { pair, parameter } => {
                let (lo, hi) = self.refine_quotient(bits, |working| common_divisor(pair, parameter, working));
                Enclosure::new(lo, hi)
            }
            HalfSizeRoot::Over { polynomial, parameter } => {
                let (lo, hi) = match polynomial.coeffs() {
                    [c0, c1] => self.refine_quotient(bits, |working| {
                        let (lo, hi) = parameter.refined(&Rational::dyadic(&Integer::ONE, working)).enclosure();
                        let at = Enclosure::new(lo, hi);
                        Some([c0, c1].map(|c| c.eval_enclosure(&at, working)))
                    }),
                    _ => self.bisect(polynomial, parameter, bits),
                };
                Enclosure::new(lo, hi)
            }
        }
    }

    /// The angle of the upper root in radians, in `(0, pi)`, whichever [side](ComplexPair::side) counts; `None` in continuous time.
    pub fn angle(&self, bits: u64) -> Option<Enclosure> {
        match self.region {
            Shape::UnitDisc => {
                let x = self.half_size_root(bits + 8);
                let half = Enclosure::from_rational(Rational::new(Integer::ONE, Integer::from(2)));
                Some(x.mul(&half, 2 * bits + 64).acos(bits + 8))
            }
            Shape::LeftHalfPlane => None,
        }
    }

    /// The angular frequency in radians per second; `None` in discrete time.
    pub fn angular_frequency(&self, bits: u64) -> Option<Enclosure> {
        match self.region {
            Shape::UnitDisc => None,
            Shape::LeftHalfPlane => {
                let x = self.half_size_root(bits + 8);
                Some(x.neg().sqrt(bits + 8))
            }
        }
    }

    /// Whether an enclosure is narrow enough: within the open interval and of small width relative
    /// to the distance from its ends.
    fn is_fine(&self, lo: &Rational, hi: &Rational, bits: u64) -> bool {
        let distance = match self.region {
            Shape::UnitDisc => {
                let two = Rational::from(2);
                (&two - hi).min(lo + &two)
            }
            Shape::LeftHalfPlane => -hi,
        };
        distance.sign() == Ordering::Greater && (hi - lo) * Rational::from(&Integer::ONE << bits) <= distance
    }

    /// `-omega^2`.
    fn refine_square(&self, omega: &Real, bits: u64) -> (Rational, Rational) {
        let mut omega = omega.clone();
        until_shown(bits + 8, |width_bits| {
            omega = omega.refined(&Rational::dyadic(&Integer::ONE, width_bits));
            let (lo, hi) = omega.enclosure();
            let (a, b) = (-(&hi * &hi), -(&lo * &lo));
            (lo.sign().is_gt() && (lo == hi || self.is_fine(&a, &b, bits))).then_some((a, b))
        })
    }

    fn refine_number(&self, x: &Real, bits: u64) -> (Rational, Rational) {
        let mut x = x.clone();
        until_shown(bits + 4, |width_bits| {
            x = x.refined(&Rational::dyadic(&Integer::ONE, width_bits));
            let (lo, hi) = x.enclosure();
            (lo == hi || self.is_fine(&lo, &hi, bits)).then_some((lo, hi))
        })
    }

    /// `-c0/c1`, of enclosures that are made with more and more bits.
    fn refine_quotient(&self, bits: u64, enclosed: impl Fn(u64) -> Option<[Enclosure; 2]>) -> (Rational, Rational) {
        until_shown(2 * bits + 64, |working| {
            let [c0, c1] = enclosed(working)?;
            let x = c0.neg().div(&c1, working).filter(|x| self.is_fine(x.lower(), x.upper(), bits))?;
            Some((x.lower().clone(), x.upper().clone()))
        })
    }

    /// Bisection for the largest root: of a polynomial with only real roots, the number of roots above
    /// `c` is exactly the number of sign variations of its coefficients about `c`.
    fn bisect(&self, polynomial: &Poly<UniPoly>, parameter: &RealAlgebraic, bits: u64) -> (Rational, Rational) {
        let degree = polynomial.coeffs().len() - 1;
        let above = |c: &Rational| roots_above(polynomial, parameter, c);
        let (mut lo, mut hi) = match self.region {
            Shape::UnitDisc => (Rational::from(-2), Rational::from(2)),
            Shape::LeftHalfPlane => {
                let mut lo = Rational::from(-1);
                while above(&lo) < degree {
                    lo *= Rational::from(2);
                }
                (lo, Rational::ZERO)
            }
        };
        while !self.is_fine(&lo, &hi, bits) {
            let mid = lo.midpoint(&hi);
            if above(&mid) > 0 {
                lo = mid;
            } else {
                hi = mid;
            }
        }
        (lo, hi)
    }
}

fn roots_above(polynomial: &Poly<UniPoly>, parameter: &RealAlgebraic, c: &Rational) -> usize {
    // q^d g(x + a/q) has the coefficients of (q^d g(x/q)) shifted by a, up to positive factors.
    let (a, q) = (c.numerator(), c.denominator());
    let degree = polynomial.coeffs().len() - 1;
    let scaled = polynomial.coeffs().iter().enumerate().map(|(k, g)| g.scaled(&q.pow((degree - k) as u64)));
    let shifted = Poly::new(scaled.collect()).taylor_shift(&UniPoly::constant(a));
    let mut last: Option<Sign> = None;
    let mut variations = 0;
    for sign in shifted.coeffs().iter().map(|g| parameter.sign_of(g)).filter(|s| s.is_ne()) {
        variations += usize::from(last.is_some_and(|l| l != sign));
        last = Some(sign);
    }
    variations
}
