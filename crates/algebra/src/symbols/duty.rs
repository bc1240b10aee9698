//! The duty ratio of a periodic orbit as a function: the zero of a function that falls.

use crate::ball::{Ball, Elementary, Series};
use crate::number::{Integer, Rational, Sign};
use crate::poly::RationalFunction;

/// Where the duty ratio is looked for, in halves: beyond 0 and 1 the function goes on, so that it has no edge at the ends of a domain.
const RANGES: [[i64; 2]; 2] = [[-2, 4], [0, 2]];

/// The slope over a range is looked at in so many pieces, as powers of two: an exponential at a time that is an interval is known badly.
const MOST_PIECES: std::ops::RangeInclusive<u64> = 0..=4;

/// Where a root of the plant times the period may be larger than two to this power there is no enclosure: exponentials would be too long.
const MOST_OCTAVES: i64 = 14;

/// Newton's method is repeated so often in one dimension at most.
const MOST_STEPS: usize = 64;

/// The number `d` with `mean + sum (Q(end) - Q(begin)) - d g(T) - d = 0`, the sum being over the parts of a pulse and `Q(p) = g(T) - g(T (1 - p))`.
///
/// With a row `r` and a matrix `A`, a column `b` and the integral `R(t)` of `exp(A s) b` from 0 to `t`, `g(t) = r R(t)`. All of it is known by the numbers
/// `r A^k b` and the characteristic polynomial of `A`. Arguments are rational functions of earlier symbols, numbered as in the table.
#[derive(Clone, Debug, PartialEq)]
pub struct DutyRatio {
    /// What the duty ratio would be if a pulse added to the state what its mean does.
    pub mean: RationalFunction,
    /// `r b`, `r A b`, .., `r A^n b`, for a matrix of order `n`.
    pub weights: Vec<RationalFunction>,
    /// The characteristic polynomial of `A` from the constant term up, without the leading 1: `n` coefficients.
    pub polynomial: Vec<RationalFunction>,
    /// The period `T`.
    pub time: RationalFunction,
    /// Twice the beginning and twice the end of each part of the pulse, `[a, b]` of `a + b d`, in periods.
    pub parts: Vec<[[i64; 2]; 2]>,
}

impl DutyRatio {
    /// The functions it is made of.
    pub(super) fn arguments(&self) -> impl Iterator<Item = &RationalFunction> {
        [&self.mean, &self.time].into_iter().chain(&self.weights).chain(&self.polynomial)
    }

    /// The same with other arguments; `None` where one of them has none.
    pub fn with(&self, mut f: impl FnMut(&RationalFunction) -> Option<RationalFunction>) -> Option<Self> {
        Some(DutyRatio {
            mean: f(&self.mean)?,
            weights: self.weights.iter().map(&mut f).collect::<Option<_>>()?,
            polynomial: self.polynomial.iter().map(&mut f).collect::<Option<_>>()?,
            time: f(&self.time)?,
            parts: self.parts.clone(),
        })
    }

    /// The duty ratio where the arguments have these values; `None` where it is not shown to be there.
    ///
    /// Cost: fundamental solutions for each edge, as often as the enclosure's terms ask for.
    pub(super) fn value<S: Elementary>(&self, at: impl Fn(&RationalFunction) -> Option<S>) -> Option<S> {
        let list = |fs: &[RationalFunction]| fs.iter().map(&at).collect::<Option<Vec<S>>>();
        let (weights, polynomial, time) = (list(&self.weights)?, list(&self.polynomial)?, at(&self.time)?);
        if octaves(&polynomial, &time) > MOST_OCTAVES {
            return None;
        }
        let equation = Equation::new(at(&self.mean)?, weights, polynomial, time, &self.parts);
        let start = equation.in_ranges().bracket()?;
        equation.mean.implicit(&start, &|duty| equation.at(duty))
    }
}

/// A bound of the binary logarithm of the largest root of a monic polynomial times a time.
fn octaves<S: Elementary>(polynomial: &[S], time: &S) -> i64 {
    let size = |s: &S| s.range().magnitude_units().bit_length() as i64 - s.bits() as i64;
    let n = polynomial.len() as i64;
    let root = |(j, c): (usize, &S)| (size(c).max(0) as u64).div_ceil(n as u64 - j as u64) as i64;
    // No root is larger than twice the greatest |c_j|^(1/(n - j)).
    1 + polynomial.iter().enumerate().map(root).max().unwrap_or(0) + size(time)
}

/// The equation with values for its arguments.
struct Equation<'p, S> {
    mean: S,
    weights: Vec<S>,
    polynomial: Vec<S>,
    time: S,
    /// `g` at the period.
    whole: S,
    parts: &'p [[[i64; 2]; 2]],
}

impl<'p, S: Elementary> Equation<'p, S> {
    fn new(mean: S, weights: Vec<S>, polynomial: Vec<S>, time: S, parts: &'p [[[i64; 2]; 2]]) -> Self {
        let mut out = Equation { mean, weights, polynomial, whole: time.clone(), time, parts };
        out.whole = out.integral_and_flow(&out.time).0;
        out
    }

    /// The same where each argument is anywhere in its range.
    fn in_ranges(&self) -> Equation<'p, Series> {
        let range = |s: &S| Series::constant(&s.range(), 1);
        let list = |all: &[S]| all.iter().map(range).collect();
        let (weights, polynomial) = (list(&self.weights), list(&self.polynomial));
        Equation::new(range(&self.mean), weights, polynomial, range(&self.time), self.parts)
    }

    /// `g` and `r exp(A t) b` at a time.
    fn integral_and_flow(&self, time: &S) -> (S, S) {
        // The polynomial of the matrix with the input as one more state.
        let coefficients: Vec<S> = std::iter::once(time.nothing()).chain(self.polynomial.iter().cloned()).collect();
        let row = time.solutions(&coefficients);
        let sum = |weights: &[S], row: &[S]| {
            weights.iter().zip(row).fold(time.nothing(), |sum, (w, y)| sum.plus(&w.times(y)))
        };
        (sum(&self.weights[..self.polynomial.len()], &row[1..]), sum(&self.weights, &row))
    }

    /// The left side and its slope.
    fn at(&self, duty: &S) -> Option<[S; 2]> {
        let half = duty.constant(&Ball::from_integer(&Integer::ONE, duty.bits()).shifted(-1));
        let number = |n: i64| duty.integer(&Integer::from(n));
        let one = number(1);
        let whole = &self.whole;
        let (mut sum, mut slope) = (duty.nothing(), duty.nothing());
        for [begin, end] in self.parts {
            for ([place, moves], is_end) in [(begin, false), (end, true)] {
                let (part, change) = match (moves, place) {
                    (0, 0) => (duty.nothing(), duty.nothing()),
                    (0, 2) => (whole.clone(), duty.nothing()),
                    _ => {
                        let moves = number(*moves).times(&half);
                        let at = number(*place).times(&half).plus(&moves.times(duty));
                        let (integral, flow) = self.integral_and_flow(&self.time.times(&one.minus(&at)));
                        (whole.minus(&integral), self.time.times(&flow).times(&moves))
                    }
                };
                (sum, slope) = match is_end {
                    true => (sum.plus(&part), slope.plus(&change)),
                    false => (sum.minus(&part), slope.minus(&change)),
                };
            }
        }
        let value = self.mean.plus(&sum).minus(&duty.times(whole)).minus(duty);
        Some([value, slope.minus(whole).minus(&one)])
    }
}

impl Equation<'_, Series> {
    /// The left side and its slope, each one ball.
    fn at_ball(&self, duty: &Ball) -> Option<[Ball; 2]> {
        self.at(&Series::constant(duty, 1)).map(|both| both.map(|s| s.coefficients()[0].clone()))
    }

    /// The slope anywhere in a ball, from pieces of it, where that is negative for certain.
    fn slope_over(&self, within: &Ball, octaves: u64) -> Option<Ball> {
        let (lo, hi) = (within.lower(), within.upper());
        let width = (&hi - &lo) * Rational::dyadic(&Integer::ONE, octaves);
        let mut all: Option<Ball> = None;
        for k in 0..1i64 << octaves {
            let [from, to] = [k, k + 1].map(|k| &lo + &(&width * &Rational::from(k)));
            let slope = self.at_ball(&Ball::between(&from, &to, within.bits()))?[1].clone();
            if slope.sign() != Some(Sign::Less) {
                return None;
            }
            all = Some(all.map_or_else(|| slope.clone(), |all| all.union(&slope)));
        }
        all
    }

    /// A ball with the one zero for all values of the arguments in their ranges; `None` where that is not shown.
    fn bracket(&self) -> Option<Ball> {
        let bits = self.mean.coefficients()[0].bits();
        let half = |n: i64| Rational::new(n.into(), 2.into());
        RANGES.iter().find_map(|[lo, hi]| self.bracket_in(Ball::between(&half(*lo), &half(*hi), bits)))
    }

    fn bracket_in(&self, mut within: Ball) -> Option<Ball> {
        let mut is_shown = false;
        for _ in 0..MOST_STEPS {
            let slope = MOST_PIECES.clone().find_map(|octaves| self.slope_over(&within, octaves))?;
            let middle = Ball::from_units(within.middle_units(), within.middle_units(), within.bits());
            let next = middle.sub(&self.at_ball(&middle)?[0].div(&slope)?);
            is_shown |= within.contains(&next.lower()) && within.contains(&next.upper());
            let narrower = within.intersection(&next)?;
            let is_slow = narrower.width_units() * Integer::from(4) > within.width_units() * Integer::from(3);
            within = narrower;
            if is_slow {
                break;
            }
        }
        is_shown.then_some(within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball::MultiTaylorModel;
    use crate::symbols::{Definition, MovingSymbols, ParametricSymbols};

    /// With `r = 2`, `A = -3`, `b = 1` and `T = 1/2` the mean for which the duty ratio of this pulse is the parameter itself.
    fn table(parts: &[[[i64; 2]; 2]]) -> Vec<(String, Definition)> {
        let number = |n: i64, d: i64| RationalFunction::from(Rational::new(n.into(), d.into()));
        let p = RationalFunction::variable(0);
        let mut table: Vec<(String, Definition)> = Vec::new();
        let mut integral = |share: RationalFunction| {
            table.push((format!("E{}", table.len()), Definition::Exponential(&share * &number(-3, 2))));
            &number(2, 3) * &(&number(1, 1) - &RationalFunction::variable(table.len()))
        };
        let whole = integral(number(1, 1));
        let mut mean = &p + &(&p * &whole);
        for [begin, end] in parts {
            for ([place, moves], sign) in [(begin, -1), (end, 1)] {
                let at = &number(*place, 2) + &(&number(*moves, 2) * &p);
                let part = &whole - &integral(&number(1, 1) - &at);
                mean = &mean - &(&part * &number(sign, 1));
            }
        }
        let weights = vec![number(2, 1), number(-6, 1)];
        let duty =
            DutyRatio { mean, weights, polynomial: vec![number(3, 1)], time: number(1, 2), parts: parts.to_vec() };
        table.push(("d".to_owned(), Definition::Duty(Box::new(duty))));
        table
    }

    #[test]
    fn a_duty_ratio_that_is_known_by_construction_is_found_in_all_kinds_of_enclosures() {
        let pulses: [&[[[i64; 2]; 2]]; 4] =
            [&[[[0, 0], [0, 2]]], &[[[2, -2], [2, 0]]], &[[[1, -1], [1, 1]]], &[[[0, 0], [0, 1]], [[2, -1], [2, 0]]]];
        for parts in pulses {
            let table = table(parts);
            let last = table.len();
            let moving = MovingSymbols::new(table.clone());
            let at = |n: i64| Rational::new(n.into(), 10.into());
            for n in [1, 5, 9] {
                let jets = moving.jets(&[crate::poly::MultiPoly::variable(last)], &Ball::from_rational(&at(n), 128));
                let [value, slope] = &jets.unwrap()[0];
                assert!(value.contains(&at(n)) && slope.contains(&Rational::ONE), "{parts:?}: {value:?} {slope:?}");
                assert!(value.width_units().bit_length() < 40 && slope.width_units().bit_length() < 60);
                let fixed = moving.at(&at(n)).unwrap().values(96)[last - 1].clone();
                assert!(fixed.contains(&at(n)) && fixed.width_units().bit_length() < 16, "{fixed:?}");
            }
            // On a disc the function is 3/10 + x/100, but for a small rest.
            let line =
                (Ball::from_rational(&at(3), 128), Ball::from_rational(&Rational::new(1.into(), 100.into()), 128));
            let parameters = MultiTaylorModel::linear(std::slice::from_ref(&line), 8);
            let known = ParametricSymbols::new(table.clone()).values(&parameters).unwrap().pop().unwrap();
            let rest = known.sub(&parameters[0]);
            assert!(
                rest.range().contains_zero() && rest.range().width_units().bit_length() < 100,
                "{:?}",
                rest.range()
            );
        }
    }

    #[test]
    fn where_no_duty_ratio_is_shown_there_is_none() {
        let mut table = table(&[[[0, 0], [0, 2]]]);
        if let Some((_, Definition::Duty(duty))) = table.last_mut() {
            duty.mean = RationalFunction::from(Rational::from(40));
        }
        assert!(MovingSymbols::new(table).jets(&[], &Ball::from_rational(&Rational::ONE, 128)).is_none());
    }
}
