//! Polynomials in the frequency's variable that are combined of others and of their derivatives: their coefficients are enclosed and not expanded.

use super::ground::Constants;
use crate::precisions::SIGN_AT_NUMBER;
use crate::stability::Range;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, isolate_real_roots_in};
use jurist_algebra::real::{Origin, Real};
use jurist_algebra::symbols::{EnclosedPoly, common_factor, enclosed_roots};
use std::sync::{Arc, Mutex, PoisonError};

/// Coefficients, and the bits that they were enclosed with.
type LastCoefficients = (u64, Vec<Ball>);

/// How polynomials `a`, `b`, `c` are combined.
#[derive(Clone, Debug)]
pub(super) enum Combination {
    /// `a` alone.
    First,
    /// `a b' - a' b`: zero where the quotient of two has an extreme.
    Slope,
    /// `(a c' - a' c)^2 - (a b' - a' b)(b c' - b' c)`: zero where `a K^2 + b K + c` and its derivative by the frequency are zero at one `K`.
    Eliminated,
    /// `b^2 - alpha^2 a c`, with the number `alpha`.
    Square(RealAlgebraic),
}

/// A combination of polynomials over symbols.
#[derive(Clone, Debug)]
pub(super) struct Combined {
    ground: Constants,
    parts: Vec<Poly<MultiPoly>>,
    how: Combination,
    /// Powers of `x - 2` and of `x + 2` that are known to divide it: with an integrator it is zero at rest.
    at_ends: [usize; 2],
    /// Coefficients with the bits that they were enclosed with last: neighbouring zeros are refined with the same.
    known: Arc<Mutex<Option<LastCoefficients>>>,
}

impl Combined {
    /// Combines polynomials that are not zero. `None` where a polynomial has algebraic zeros in `(-2, 2)`: these may be repeated, and another
    /// method isolates them.
    pub fn new(ground: &Constants, parts: &[&Poly<MultiPoly>], how: Combination) -> Option<Combined> {
        if parts.iter().any(|p| has_exact_zeros(p)) {
            return None;
        }
        let parts: Vec<_> = parts.iter().map(|p| (*p).clone()).collect();
        let at_ends = [2, -2].map(|end| {
            let orders: Vec<usize> = parts.iter().map(|p| order_at(p, end)).collect();
            how.order(&orders)
        });
        Some(Combined { ground: ground.clone(), parts, how, at_ends, known: Arc::default() })
    }

    /// Its zeros in a range between two numbers, ascending.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where the greatest precision does not separate two zeros.
    pub fn zeros(&self, range: &Range, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        let p: Arc<dyn EnclosedPoly> = Arc::new(self.clone());
        enclosed_roots(&p, range.lower.as_ref(), range.upper.as_ref(), budget)
    }

    /// The value at a number, with so many bits.
    pub fn at_real(&self, x: &Real, bits: u64) -> Ball {
        let (lo, hi) = x.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
        let x = Ball::between(&lo, &hi, bits);
        let value = |p: &[Ball]| p.iter().rev().fold(Ball::zero(bits), |sum, c| sum.mul(&x).add(c));
        let both: Vec<[Vec<Ball>; 2]> =
            self.enclosed(bits).iter().map(|p| [vec![value(p)], vec![value(&derivative(p))]]).collect();
        self.how.of(&both, bits).into_iter().next().unwrap_or_else(|| Ball::zero(bits))
    }

    /// The sign at a number, where it is not zero.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where no bits tell.
    pub fn sign_at(&self, x: &Real, budget: &Budget) -> Result<Sign, Exhausted> {
        SIGN_AT_NUMBER.decide("a polynomial at a frequency", |bits| {
            budget.check()?;
            Ok(budget.enter(|| self.at_real(x, bits))?.sign())
        })
    }

    fn enclosed(&self, bits: u64) -> Vec<Vec<Ball>> {
        let of = |p: &Poly<MultiPoly>| p.coeffs().iter().map(|c| self.ground.0.enclose(c, bits)).collect();
        self.parts.iter().map(of).collect()
    }
}

impl EnclosedPoly for Combined {
    fn enclose(&self, bits: u64) -> Vec<Ball> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = known().as_ref().filter(|(with, _)| *with == bits) {
            return found.clone();
        }
        let both: Vec<[Vec<Ball>; 2]> = self.enclosed(bits).into_iter().map(|p| [p.clone(), derivative(&p)]).collect();
        let mut whole = self.how.of(&both, bits);
        for (end, count) in [2, -2].into_iter().zip(self.at_ends) {
            (0..count).for_each(|_| whole = without_root(&whole, end));
        }
        *known() = Some((bits, whole.clone()));
        whole
    }

    fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        SIGN_AT_NUMBER.decide("a polynomial at a frequency", |bits| {
            budget.check()?;
            let value = budget.enter(|| {
                let at = Ball::from_rational(x, bits);
                self.enclose(bits).iter().rev().fold(Ball::zero(bits), |sum, c| sum.mul(&at).add(c))
            })?;
            Ok(value.sign().map(Sign::is_eq))
        })
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "polynomial in the frequency's variable".to_owned(), details: Vec::new() }
    }
}

impl Combination {
    /// Of polynomials, each with its derivative.
    fn of(&self, both: &[[Vec<Ball>; 2]], bits: u64) -> Vec<Ball> {
        let slope = |i: usize, j: usize| slope(&both[i], &both[j]);
        match self {
            Combination::First => both[0][0].clone(),
            Combination::Slope => slope(0, 1),
            Combination::Eliminated => {
                let outer = slope(0, 2);
                difference(&product(&outer, &outer), &product(&slope(0, 1), &slope(1, 2)))
            }
            Combination::Square(alpha) => {
                let (lo, hi) = alpha.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
                let square = Ball::between(&lo, &hi, bits).square();
                let [a, b, c] = [0, 1, 2].map(|i| &both[i][0]);
                let others: Vec<Ball> = product(a, c).iter().map(|x| x.mul(&square)).collect();
                difference(&product(b, b), &others)
            }
        }
    }

    /// A lower bound of the order of a zero, from those of the polynomials.
    fn order(&self, orders: &[usize]) -> usize {
        let slope = |i: usize, j: usize| (orders[i] + orders[j]).saturating_sub(1);
        match self {
            Combination::First => orders[0],
            Combination::Slope => slope(0, 1),
            Combination::Eliminated => (2 * slope(0, 2)).min(slope(0, 1) + slope(1, 2)),
            Combination::Square(_) => (2 * orders[1]).min(orders[0] + orders[2]),
        }
    }
}

/// Whether the factor with rational coefficients has zeros between -2 and 2.
fn has_exact_zeros(p: &Poly<MultiPoly>) -> bool {
    let exact = common_factor(&Constants::over_unknown(p));
    let ends = [-2, 2].map(Rational::from);
    let zeros = SquareFree::part_of(&exact)
        .map(|part| isolate_real_roots_in(&part, Some(&ends[0]), Some(&ends[1]), &Budget::unlimited()));
    !matches!(zeros, Some(Ok(zeros)) if zeros.is_empty())
}

/// The order of the zero of a polynomial that is not zero.
fn order_at(p: &Poly<MultiPoly>, end: i64) -> usize {
    let root = Poly::new(vec![MultiPoly::from(-end), MultiPoly::one()]);
    std::iter::successors(p.div_exact(&root), |p| p.div_exact(&root)).count()
}

/// `a b' - a' b`, of which the highest coefficients cancel if both have as many. Of values, each a list of one number, nothing does.
fn slope([a, da]: &[Vec<Ball>; 2], [b, db]: &[Vec<Ball>; 2]) -> Vec<Ball> {
    let mut out = difference(&product(a, db), &product(da, b));
    if a.len() == b.len() && a.len() == da.len() + 1 && out.len() > 1 {
        out.pop();
    }
    out
}

fn derivative(p: &[Ball]) -> Vec<Ball> {
    p.iter().enumerate().skip(1).map(|(k, c)| c.scaled(&Integer::from(k as u64))).collect()
}

fn product(p: &[Ball], q: &[Ball]) -> Vec<Ball> {
    let (Some(first), false) = (p.first(), q.is_empty()) else { return Vec::new() };
    let mut out = vec![Ball::zero(first.bits()); p.len() + q.len() - 1];
    for (i, x) in p.iter().enumerate() {
        for (j, y) in q.iter().enumerate() {
            out[i + j] = out[i + j].add(&x.mul(y));
        }
    }
    out
}

fn difference(p: &[Ball], q: &[Ball]) -> Vec<Ball> {
    let bits = p.first().or(q.first()).map_or(1, Ball::bits);
    let zero = Ball::zero(bits);
    let at = |list: &[Ball], k: usize| list.get(k).unwrap_or(&zero).clone();
    (0..p.len().max(q.len())).map(|k| at(p, k).sub(&at(q, k))).collect()
}

/// The quotient by `x - root`, which divides: the remainder is left out.
fn without_root(p: &[Ball], root: i64) -> Vec<Ball> {
    let root = Integer::from(root);
    let mut out: Vec<Ball> = Vec::with_capacity(p.len());
    for c in p.iter().skip(1).rev() {
        let next = out.last().map_or_else(|| c.clone(), |last: &Ball| c.add(&last.scaled(&root)));
        out.push(next);
    }
    out.reverse();
    out
}
