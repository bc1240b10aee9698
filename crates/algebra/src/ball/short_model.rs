//! Taylor models with coefficients of two words: many times faster than those of any length, and known to 88 bits.

use super::bezout::determinant_by_minors;
use super::solutions::{Summed, Units, row_by_taylor};
use super::{Ball, Elementary, Enclosed, TaylorModel, hybrid_bezout};
use crate::limits::checkpoint;
use crate::number::Integer;

/// Bits after the point.
const BITS: u32 = 88;

/// Numbers are smaller than `2^116` units, so that sums of products fit four words.
const LIMIT: i128 = 1 << 116;

/// The sums of products of so many terms do.
const MOST_TERMS: usize = 16;

/// A power series in `x` of which the first coefficients are known but for rounding, with a bound of the sum of the absolute values of
/// all others: a [`TaylorModel`] with short numbers. A number that does not fit makes all that is computed with it unknown.
///
/// ```
/// use jurist_algebra::ball::{Ball, Enclosed, ShortModel, TaylorModel};
/// let [one, tenth] = ["1", "1/10"].map(|x| Ball::from_rational(&x.parse().unwrap(), 128));
/// let x = ShortModel::of(&TaylorModel::linear(&one, &tenth, 4), 0);
/// let known = x.times(&x).known().unwrap(); // 1 + x/5 + x^2/100
/// assert!(known.coefficients[1].widened(&known.noise).contains(&"1/5".parse().unwrap()));
/// ```
#[derive(Clone, Debug)]
pub struct ShortModel {
    coefficients: Vec<i128>,
    /// `None` where a number did not fit.
    errors: Option<Errors>,
}

/// Bounds in units, as sums of absolute values.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    /// Of the powers beyond the polynomial's.
    rest: i128,
    /// Of what all coefficients are wrong by.
    noise: i128,
}

/// What is known of a function on the disc `|x| <= 1`.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Known {
    /// A polynomial, exactly.
    pub coefficients: Vec<Ball>,
    /// The sum of the absolute values of all coefficients of its difference to the function is at most this, in units of the last place.
    pub rest: Integer,
    /// The part of this that is rounding.
    pub noise: Integer,
}

impl ShortModel {
    /// The function over `2^exponent`.
    pub fn of(model: &TaylorModel, exponent: i64) -> ShortModel {
        let mut list = model.coefficients();
        let rest = list.pop().expect("a model has a rest");
        let by = i64::from(BITS) - rest.bits() as i64 - exponent;
        let ends = |c: &Ball| Some((shifted_down(&c.lo, by)?, shifted_up(&c.hi, by)?));
        let ends: Option<Vec<(i128, i128)>> = list.iter().map(ends).collect();
        let errors = ends.as_ref().filter(|ends| ends.len() <= MOST_TERMS).and_then(|ends| {
            let noise = ends.iter().map(|(lo, hi)| hi - lo).sum();
            Errors { rest: shifted_up(&rest.hi, by)?, noise }.fitting()
        });
        let coefficients =
            ends.map_or_else(|| vec![0; list.len()], |ends| ends.into_iter().map(|(lo, _)| lo).collect());
        ShortModel { coefficients, errors }
    }

    /// The constant `c 2^exponent`.
    pub fn constant(&self, c: &Integer, exponent: i64) -> ShortModel {
        let by = i64::from(BITS) + exponent;
        let mut out = self.nothing();
        out.errors = shifted_down(c, by).zip(shifted_up(c, by)).map(|(lo, hi)| {
            out.coefficients[0] = lo;
            Errors { rest: 0, noise: hi - lo }
        });
        out
    }

    /// What is known of the function; `None` where numbers did not fit.
    pub fn known(&self) -> Option<Known> {
        let errors = self.errors?;
        let ball = |c: &i128| Ball::from_units(Integer::from(*c), Integer::from(*c), u64::from(BITS));
        let (rest, noise) = (Integer::from(errors.rest + errors.noise), Integer::from(errors.noise));
        Some(Known { coefficients: self.coefficients.iter().map(ball).collect(), rest, noise })
    }

    /// The power of two that is nearest above all absolute values on the disc; `None` where that is not known, or all are zero.
    pub fn exponent(&self) -> Option<i64> {
        let norm = self.norm() + self.errors.map(|e| e.rest + e.noise)?;
        (norm > 0).then(|| i64::from(128 - norm.leading_zeros()) - i64::from(BITS))
    }

    /// The function over `2^exponent`.
    pub fn over_power(&self, exponent: i64) -> ShortModel {
        let by = u32::try_from(exponent.unsigned_abs()).unwrap_or(u32::MAX).min(127);
        let larger = |n: i128| (n == 0 || n.unsigned_abs().leading_zeros() > by + 1).then(|| n << by);
        let above = |n: i128| -(-n >> by);
        let (coefficients, errors): (Option<Vec<i128>>, _) = if exponent <= 0 {
            let errors = self.errors.and_then(|e| Some(Errors { rest: larger(e.rest)?, noise: larger(e.noise)? }));
            (self.coefficients.iter().map(|c| larger(*c)).collect(), errors)
        } else {
            let lost = self.coefficients.len() as i128;
            let errors = self.errors.map(|e| Errors { rest: above(e.rest), noise: above(e.noise) + lost });
            (Some(self.coefficients.iter().map(|c| c >> by).collect()), errors)
        };
        match coefficients {
            Some(coefficients) => ShortModel { coefficients, errors }.fitting(),
            None => self.unknown(),
        }
    }

    fn unknown(&self) -> ShortModel {
        ShortModel { coefficients: vec![0; self.coefficients.len()], errors: None }
    }

    /// The function itself where all its numbers fit.
    fn fitting(self) -> ShortModel {
        let fits = self.coefficients.iter().all(|c| c.abs() < LIMIT);
        let errors = self.errors.filter(|_| fits).and_then(Errors::fitting);
        match errors {
            Some(_) => ShortModel { errors, ..self },
            None => self.unknown(),
        }
    }

    /// The sum of the absolute values of the coefficients.
    fn norm(&self) -> i128 {
        self.coefficients.iter().map(|c| c.abs()).sum()
    }

    fn with(&self, other: &ShortModel, f: impl Fn(i128, i128) -> i128) -> ShortModel {
        let coefficients = self.coefficients.iter().zip(&other.coefficients).map(|(a, b)| f(*a, *b)).collect();
        let errors = self.errors.zip(other.errors);
        let errors = errors.map(|(a, b)| Errors { rest: a.rest + b.rest, noise: a.noise + b.noise });
        ShortModel { coefficients, errors }.fitting()
    }
}

/// As [`fundamental_solutions`](super::fundamental_solutions()), of the order of one; `None` where numbers are too short.
pub(super) fn short_solutions(coefficients: &[TaylorModel], time: &TaylorModel) -> Option<Vec<TaylorModel>> {
    let units = Units::of(coefficients, time);
    let of_coefficient = |j| units.of_coefficient(coefficients.len(), j) as i64;
    let polynomial = coefficients.iter().enumerate().map(|(j, c)| ShortModel::of(c, of_coefficient(j)));
    let t = ShortModel::of(time, units.halvings as i64 - units.octaves as i64);
    let row = row_by_taylor(&polynomial.collect::<Vec<_>>(), &t, u64::from(BITS), units.halvings);
    let of_entry = |(j, s): (usize, &ShortModel)| {
        Some(TaylorModel::from_known(&s.known()?, -((units.octaves * j as u64) as i64), time.bits()))
    };
    row.iter().enumerate().map(of_entry).collect()
}

impl Summed for ShortModel {
    fn one(&self) -> ShortModel {
        self.constant(&Integer::ONE, 0)
    }

    fn divided_by(&self, n: u64) -> ShortModel {
        let n = i128::from(n);
        let above = |x: i128| -(-x).div_euclid(n);
        let lost = self.coefficients.len() as i128;
        let errors = self.errors.map(|e| Errors { rest: above(e.rest), noise: above(e.noise) + lost });
        ShortModel { coefficients: self.coefficients.iter().map(|c| c.div_euclid(n)).collect(), errors }
    }

    fn widened(&self) -> ShortModel {
        let errors = self.errors.map(|e| Errors { noise: e.noise + 1, ..e });
        ShortModel { errors, ..self.clone() }
    }
}

/// The resultant of two polynomials for their formal degrees, up to a power of two and the sign: lists and rows of the matrix are scaled so
/// that the greatest of their numbers are about one.
///
/// Cost: as of [`enclosed_resultant_by_minors`](super::enclosed_resultant_by_minors).
///
/// # Panics
/// When a list is empty, or both are constants.
pub fn short_resultant(a: &[ShortModel], b: &[ShortModel]) -> ShortModel {
    let (a, b) = if a.len() >= b.len() { (a, b) } else { (b, a) };
    let rows = hybrid_bezout(&of_size_one(a), &of_size_one(b));
    determinant_by_minors(&rows.iter().map(|row| of_size_one(row)).collect::<Vec<_>>())
}

fn of_size_one(list: &[ShortModel]) -> Vec<ShortModel> {
    let exponent = list.iter().filter_map(ShortModel::exponent).max().unwrap_or(0);
    list.iter().map(|x| x.over_power(exponent)).collect()
}

impl Errors {
    fn fitting(self) -> Option<Errors> {
        (self.rest < LIMIT && self.noise < LIMIT).then_some(self)
    }
}

/// `n 2^by`, rounded down; `None` where it does not fit.
fn shifted_down(n: &Integer, by: i64) -> Option<i128> {
    if n.bit_length() as i64 + by > i64::from(LIMIT.ilog2()) {
        return None;
    }
    let n = if by >= 0 { n << by.unsigned_abs() } else { n >> by.unsigned_abs() };
    let limbs = n.as_limbs();
    let limb = |i: usize| i128::from(limbs.get(i).copied().unwrap_or(0));
    let magnitude = limb(0) | limb(1) << 64;
    Some(if n.is_negative() { -magnitude } else { magnitude })
}

/// `n 2^by`, rounded up; `None` where it does not fit.
fn shifted_up(n: &Integer, by: i64) -> Option<i128> {
    shifted_down(&-n, by).map(|n| -n)
}

/// A sum of products of four words, from up to 32 factors below `2^120`.
#[derive(Clone, Copy, Default)]
struct Sum {
    /// Of products of the lower words, of mixed ones, and of the upper ones with what was carried.
    lower: u128,
    mixed: i128,
    upper: i128,
}

impl Sum {
    #[inline]
    fn add(&mut self, a: i128, b: i128) {
        let (a0, a1) = (a as u64, (a >> 64) as i64);
        let (b0, b1) = (b as u64, (b >> 64) as i64);
        let (lower, carried) = self.lower.overflowing_add(u128::from(a0) * u128::from(b0));
        self.lower = lower;
        self.mixed += i128::from(a1) * i128::from(b0) + i128::from(a0) * i128::from(b1);
        self.upper += i128::from(a1) * i128::from(b1) + i128::from(carried);
    }

    /// The sum in units, rounded down; `None` where it does not fit.
    #[inline]
    fn rounded(self) -> Option<i128> {
        let (lower, carried) = self.lower.overflowing_add((self.mixed as u128) << 64);
        let upper = self.upper + (self.mixed >> 64) + i128::from(carried);
        let room = LIMIT >> (128 - BITS);
        (-room <= upper && upper < room).then_some(upper << (128 - BITS) | (lower >> BITS) as i128)
    }
}

/// A sum of products of bounds, rounded up; `None` where it does not fit.
fn bound<const N: usize>(pairs: [(i128, i128); N]) -> Option<i128> {
    let mut sum = Sum::default();
    pairs.into_iter().for_each(|(a, b)| sum.add(a, b));
    sum.rounded().map(|n| n + 1)
}

impl Enclosed for ShortModel {
    fn nothing(&self) -> ShortModel {
        ShortModel { coefficients: vec![0; self.coefficients.len()], errors: Some(Errors::default()) }
    }

    fn plus(&self, other: &ShortModel) -> ShortModel {
        self.with(other, |a, b| a + b)
    }

    fn minus(&self, other: &ShortModel) -> ShortModel {
        self.with(other, |a, b| a - b)
    }

    fn times(&self, other: &ShortModel) -> ShortModel {
        let (Some(e), Some(f)) = (self.errors, other.errors) else { return self.unknown() };
        let (a, b) = (&self.coefficients, &other.coefficients);
        let n = a.len();
        checkpoint(n as u64);
        let coefficient = |k: usize| {
            let mut sum = Sum::default();
            (0..=k).for_each(|j| sum.add(a[j], b[k - j]));
            sum.rounded()
        };
        let product: Option<Vec<i128>> = (0..n).map(coefficient).collect();
        // The powers beyond: those of both polynomials, and each polynomial's with the other's rest.
        let (mut beyond, mut last) = (Sum::default(), 0);
        for i in 1..n {
            last += b[n - i].abs();
            beyond.add(a[i].abs(), last);
        }
        let (size_a, size_b) = (self.norm(), last + b[0].abs());
        let rest = beyond.rounded().zip(bound([(size_a + e.rest, f.rest), (size_b, e.rest)]));
        let noise = bound([(size_a + e.rest + e.noise, f.noise), (size_b + f.rest, e.noise)]);
        match (product, rest, noise) {
            (Some(coefficients), Some((beyond, rest)), Some(noise)) => {
                let errors = Errors { rest: beyond + 1 + rest, noise: noise + n as i128 };
                ShortModel { coefficients, errors: Some(errors) }.fitting()
            }
            _ => self.unknown(),
        }
    }

    /// Not known: short numbers are for what needs no quotients.
    fn over(&self, _: &ShortModel) -> Option<ShortModel> {
        None
    }

    fn is_nothing(&self) -> bool {
        self.errors.is_some_and(|e| e.rest == 0 && e.noise == 0) && self.coefficients.iter().all(|c| *c == 0)
    }

    fn least(&self) -> Integer {
        let around = self.errors.map(|e| self.norm() - self.coefficients[0].abs() + e.rest + e.noise);
        around.map_or(Integer::ZERO, |around| Integer::from((self.coefficients[0].abs() - around).max(0)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::enclosed_resultant_by_minors;
    use super::*;
    use crate::number::Rational;
    use proptest::prelude::*;

    const TERMS: usize = 5;

    /// A polynomial with small rational coefficients.
    fn polynomial() -> impl Strategy<Value = Vec<Rational>> {
        let number = (-999i64..999, 1i64..99, -60i64..3);
        let scaled = |(n, d, e): (i64, i64, i64)| {
            Rational::new(Integer::from(n), Integer::from(d)) * Rational::from(2).pow(e).unwrap()
        };
        prop::collection::vec(number.prop_map(scaled), TERMS)
    }

    fn model(p: &[Rational]) -> TaylorModel {
        let x = TaylorModel::linear(&Ball::zero(200), &Ball::from_integer(&Integer::ONE, 200), TERMS);
        let constant = |c: &Rational| TaylorModel::linear(&Ball::from_rational(c, 200), &Ball::zero(200), TERMS);
        p.iter().rev().fold(constant(&Rational::ZERO), |sum, c| sum.mul(&x).add(&constant(c)))
    }

    fn product(p: &[Rational], q: &[Rational]) -> Vec<Rational> {
        let mut out = vec![Rational::ZERO; p.len() + q.len() - 1];
        for (i, a) in p.iter().enumerate() {
            for (j, b) in q.iter().enumerate() {
                out[i + j] = &out[i + j] + &(a * b);
            }
        }
        out
    }

    /// The difference to an exact polynomial is not larger than what is said.
    fn holds(found: &ShortModel, exact: &[Rational]) {
        let known = found.known().unwrap();
        let unit = Rational::dyadic(&Integer::ONE, u64::from(BITS));
        let at = |k: usize| known.coefficients.get(k).map_or(Rational::ZERO, Ball::lower);
        let missed = |range: std::ops::Range<usize>| {
            range.fold(Rational::ZERO, |sum, k| sum + (exact.get(k).cloned().unwrap_or_default() - at(k)).abs())
        };
        let [rest, noise] = [&known.rest, &known.noise].map(|n| Rational::from(n.clone()) * &unit);
        let count = exact.len().max(TERMS);
        assert!(missed(0..TERMS) <= noise && missed(0..count) <= rest, "{found:?} {exact:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn sums_products_and_scalings_hold_the_exact_ones(p in polynomial(), q in polynomial(), c in -99i64..99, e in -40i64..20) {
            let [a, b] = [&p, &q].map(|p| ShortModel::of(&model(p), 0));
            holds(&a, &p);
            let both = |f: fn(&Rational, &Rational) -> Rational| p.iter().zip(&q).map(|(x, y)| f(x, y)).collect::<Vec<_>>();
            holds(&a.plus(&b), &both(|x, y| x + y));
            holds(&a.minus(&b), &both(|x, y| x - y));
            let (square, exact) = (a.times(&b), product(&p, &q));
            holds(&square, &exact);
            // What is cut off is said to be no more than it is without cancellation.
            let sizes = [&p, &q].map(|p| p.iter().map(Rational::abs).collect::<Vec<_>>());
            let beyond = product(&sizes[0], &sizes[1]).into_iter().skip(TERMS).fold(Rational::ZERO, |sum, c| sum + c);
            let known = square.known().unwrap();
            let said = Rational::from(&known.rest - &known.noise) * Rational::dyadic(&Integer::ONE, u64::from(BITS));
            let number = |text: &str| text.parse::<Rational>().unwrap();
            prop_assert!(said <= beyond * number("1.001") + number("1/100000000000000000000"));
            let known = square.times(&a).known();
            if let Some(known) = known {
                let exact = product(&exact, &p);
                let missed = exact.iter().enumerate().fold(Rational::ZERO, |sum, (k, c)| {
                    sum + (c - &known.coefficients.get(k).map_or(Rational::ZERO, Ball::lower)).abs()
                });
                prop_assert!(missed <= Rational::from(known.rest) * Rational::dyadic(&Integer::ONE, u64::from(BITS)));
            }
            let power = Rational::from(2).pow(-e).unwrap();
            let scaled: Vec<Rational> = p.iter().map(|x| x * &power).collect();
            for found in [a.over_power(e), ShortModel::of(&model(&p), e)] {
                if found.known().is_some() {
                    holds(&found, &scaled);
                }
            }
            let mut constant = vec![Rational::ZERO; TERMS];
            constant[0] = Rational::from(c) * Rational::from(2).pow(e).unwrap();
            holds(&a.constant(&Integer::from(c), e), &constant);
            prop_assert!(a.exponent().is_none_or(|e| p.iter().all(|x| x.abs() <= Rational::from(2).pow(e).unwrap())));
        }
    }

    #[test]
    fn what_does_not_fit_is_not_known_nor_what_is_made_of_it() {
        let one = ShortModel::of(&model(&[Rational::ONE]), 0);
        let large = one.constant(&Integer::ONE, 27);
        assert!(large.known().is_some() && one.constant(&Integer::ONE, 28).known().is_none());
        let lost = large.times(&large);
        assert!(lost.known().is_none() && lost.exponent().is_none());
        assert!(lost.minus(&lost).known().is_none() && one.times(&lost).known().is_none());
        assert!(one.over_power(-200).known().is_none() && !lost.is_nothing());
        assert!(one.nothing().over_power(-200).is_nothing());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(50))]

        #[test]
        fn short_resultants_are_those_of_long_numbers(a in prop::collection::vec(polynomial(), 2..5), b in prop::collection::vec(polynomial(), 1..4)) {
            let long = |list: &[Vec<Rational>]| list.iter().map(|p| model(p)).collect::<Vec<_>>();
            let short = |list: &[Vec<Rational>]| list.iter().map(|p| ShortModel::of(&model(p), 0)).collect::<Vec<_>>();
            let exact = enclosed_resultant_by_minors(&long(&a), &long(&b));
            let found = short_resultant(&short(&a), &short(&b)).known().unwrap();
            // The same power of two for all coefficients: that at which the greatest ones agree.
            let greatest = exact.coefficients()[..TERMS].iter().map(Ball::upper).max_by_key(Rational::abs).unwrap();
            let unit = Rational::dyadic(&Integer::ONE, u64::from(BITS));
            let noise = Rational::from(found.noise) * &unit;
            let at = |k: usize| (exact.coefficients()[k].upper(), found.coefficients[k].lower());
            let fits = |e: i64| {
                let power = Rational::from(2).pow(e).unwrap();
                (0..TERMS).all(|k| {
                    let (x, y) = at(k);
                    (&x * &power - &y).abs() <= &noise + &unit || (&x * &power + &y).abs() <= &noise + &unit
                })
            };
            prop_assert!(greatest.is_zero() || (-400..400).any(fits), "{:?} {:?}", exact, found.coefficients);
        }
    }

    #[test]
    fn nothing_is_left_of_what_is_far_too_small() {
        let one = ShortModel::of(&model(&[Rational::ONE]), 0);
        let small = one.over_power(300).known().unwrap();
        assert!(small.coefficients.iter().all(Ball::is_zero) && small.rest.sign().is_gt());
    }
}
