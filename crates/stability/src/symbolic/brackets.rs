//! Brackets in which a boundary function may vanish, looked at once more: whether roots cross the boundary is told by counting
//! them for all values of a short interval at once.

use super::SymbolicPolynomial;
use super::count::certain_count;
use crate::line::{Bracket, Decided};
use crate::{Range, Shape};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::symbols::MovingSymbols;

/// So many intervals of one bracket are counted.
const MOST_COUNTS: usize = 48;

/// So many brackets are looked at, those near the usual value first.
const MOST_BRACKETS: usize = 24;

/// An interval around the usual value is made shorter so often.
const MOST_HALVINGS: u64 = 96;

/// Terms of the Taylor polynomials of the coefficients.
const TERMS: usize = 4;

/// Bits, beside those that the interval's width takes away.
const BITS: u64 = 160;

/// The circles beyond the unit circle on which roots are counted, as `1 + 2^-k`: a pair of roots that are mirror images in the unit circle
/// is none in these.
const CIRCLES: [u64; 4] = [3, 7, 12, 20];

/// The scales that are tried where the usual value is zero: powers of two up to this one, and down to its reciprocal.
const SCALES: i64 = 64;

/// The steps between them at first.
const STEP: i64 = 8;

/// Counts roots for all values of an interval at once.
pub(super) struct Counter<'a> {
    pub polynomial: &'a SymbolicPolynomial,
    pub symbols: &'a MovingSymbols,
    pub region: Shape,
    /// The coefficients, and then what must not vanish.
    functions: Vec<MultiPoly>,
}

impl<'a> Counter<'a> {
    pub fn new(polynomial: &'a SymbolicPolynomial, symbols: &'a MovingSymbols, region: Shape) -> Self {
        let mut functions = polynomial.polynomial.coeffs().to_vec();
        functions.extend(polynomial.poles.iter().cloned());
        functions.extend(symbols.signs_under_roots().iter().map(|sign| MultiPoly::from_univariate(&sign.function, 0)));
        Counter { polynomial, symbols, region, functions }
    }

    /// What is certain in a bracket, ascending: an interval around the usual value first, if that lies inside, then halves of what is
    /// left.
    pub fn decided(
        &self,
        lower: &Rational,
        upper: &Rational,
        usual: &Rational,
        budget: &Budget,
    ) -> Result<Vec<Decided>, Exhausted> {
        let mut found = Vec::new();
        let mut todo = vec![(lower.clone(), upper.clone())];
        if lower < usual && usual < upper {
            let mut reach = (usual - lower).min(upper - usual);
            for _ in 0..MOST_HALVINGS {
                budget.check()?;
                let (lo, hi) = (usual - &reach, usual + &reach);
                if let Some(is_stable) = budget.enter(|| self.certain(&lo, &hi))? {
                    todo = vec![(lower.clone(), lo.clone()), (hi.clone(), upper.clone())];
                    found.push(Decided { lower: lo, upper: hi, is_stable });
                    break;
                }
                reach *= Rational::dyadic(&Integer::ONE, 1);
            }
        }
        let distance =
            |(lo, hi): &(Rational, Rational)| if usual < lo { lo - usual } else { (usual - hi).max(Rational::ZERO) };
        for _ in 0..MOST_COUNTS {
            todo.retain(|(lo, hi)| lo < hi || lower == upper);
            // Those next to what matters first, the long ones of these before the short ones.
            let key = |k: &usize| {
                let (lo, hi) = &todo[*k];
                (hi - lo).checked_div(&(distance(&todo[*k]) + (hi - lo))).unwrap_or(Rational::ONE)
            };
            let Some(next) = (0..todo.len()).max_by_key(key) else { break };
            let (lo, hi) = todo.swap_remove(next);
            budget.check()?;
            match budget.enter(|| self.certain(&lo, &hi))? {
                Some(is_stable) => found.push(Decided { lower: lo, upper: hi, is_stable }),
                None if lo == hi => break,
                None => {
                    let middle = lo.midpoint(&hi);
                    todo.extend([(lo, middle.clone()), (middle, hi)]);
                }
            }
        }
        found.sort_by(|a, b| a.lower.cmp(&b.lower));
        Ok(found)
    }

    /// The greatest power of two up to which no root reaches the boundary on either side of zero, as far as this is seen at once; 1
    /// where it is seen of none.
    ///
    /// Cost: some counts.
    pub fn scale(&self, range: &Range) -> Rational {
        let power = |k: i64| Rational::from(2).pow(k).expect("two is not zero");
        let end = |x: Rational, end: &Option<Rational>| end.as_ref().map_or(x.clone(), |end| end.abs().min(x));
        let holds = |k: &i64| self.certain(&-end(power(*k), &range.lower), &end(power(*k), &range.upper)).is_some();
        let Some(least) = (-SCALES..=SCALES).rev().step_by(STEP as usize).find(holds) else { return Rational::ONE };
        let greatest = (least..least + STEP).rev().find(holds).unwrap_or(least);
        power(greatest)
    }

    /// Whether the loop is stable for all values of a closed interval, or for none; `None` where that is not seen.
    pub fn certain(&self, lower: &Rational, upper: &Rational) -> Option<bool> {
        let width = upper - lower;
        let small = width.denominator().bit_length().saturating_sub(width.numerator().bit_length());
        let bits = BITS + small.min(1 << 12);
        let balls: Vec<Ball> = if width.is_zero() {
            self.symbols.enclose(&self.functions, &Ball::from_rational(lower, bits))?
        } else {
            let taylor = self.symbols.taylor_from_end(&self.functions, lower, upper, TERMS, bits)?;
            let share = Ball::between(&Rational::ZERO, &Rational::ONE, bits);
            taylor.iter().map(|c| c.iter().rev().fold(Ball::zero(bits), |sum, c| sum.mul(&share).add(c))).collect()
        };
        let degree = self.polynomial.formal_degree;
        let (coefficients, poles) = balls.split_at_checked(degree + 1)?;
        if poles.iter().any(Ball::contains_zero) {
            return None;
        }
        if let Some(count) = certain_count(coefficients, self.region) {
            return Some(count.inside == degree);
        }
        // Where mirror images keep the count from being certain, roots further out may be.
        let is_unstable = |k: &u64| {
            let moved = self.moved(coefficients, *k);
            certain_count(&moved, self.region).is_some_and(|count| count.inside < degree)
        };
        CIRCLES.iter().any(is_unstable).then_some(false)
    }

    /// The polynomial whose roots in the region are those in one that is somewhat larger.
    fn moved(&self, coefficients: &[Ball], k: u64) -> Vec<Ball> {
        let step = Rational::dyadic(&Integer::ONE, k);
        let bits = coefficients[0].bits();
        match self.region {
            Shape::UnitDisc => {
                let ratio = Ball::from_rational(&(Rational::ONE + step), bits);
                let mut power = Ball::from_integer(&Integer::ONE, bits);
                let scaled = |c: &Ball| {
                    let found = c.mul(&power);
                    power = power.mul(&ratio);
                    found
                };
                coefficients.iter().map(scaled).collect()
            }
            Shape::LeftHalfPlane => {
                // s + d with d on the scale of the roots.
                let [.., before, last] = coefficients else { return coefficients.to_vec() };
                let Some(scale) = before.div(last) else { return coefficients.to_vec() };
                let shift = (scale.lower().abs() + Rational::ONE) * step;
                let shift = Ball::from_rational(&shift, bits);
                let mut moved = coefficients.to_vec();
                for i in 0..moved.len() {
                    for j in (i..moved.len() - 1).rev() {
                        moved[j] = moved[j].add(&moved[j + 1].mul(&shift));
                    }
                }
                moved
            }
        }
    }
}

/// The brackets that are looked at once more: finite ones, those near the usual value first.
pub(super) fn looked_at(brackets: &[Bracket], usual: &Rational) -> Vec<bool> {
    let distance = |k: &usize| match &brackets[*k] {
        (Some(lo), _) if usual < lo => lo - usual,
        (_, Some(hi)) if hi < usual => usual - hi,
        _ => Rational::ZERO,
    };
    let mut near: Vec<usize> =
        (0..brackets.len()).filter(|&k| brackets[k].0.is_some() && brackets[k].1.is_some()).collect();
    near.sort_by_key(distance);
    let mut out = vec![false; brackets.len()];
    near.into_iter().take(MOST_BRACKETS).for_each(|k| out[k] = true);
    out
}
