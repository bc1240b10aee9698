//! Analytic functions as polynomials with a bound of all that is left out.

use super::implicit::Approximate;
use super::short_model::short_solutions;
use super::solutions::{Scaled, Summed, solutions_by_taylor};
use super::{Ball, Elementary, Enclosed, Known, Series, exp, fundamental_solutions};
use crate::number::Integer;

/// A power series in `x` of which the first coefficients are enclosed, and the sum of the absolute values of all others is bounded: a
/// function that is known on the disc `|x| <= 1`.
///
/// These series are an algebra in which the norm of a product is at most the product of the norms (Wiener's), so that all that is left
/// out is followed through a computation by one number, as in a Taylor model ([MakinoBerz2003](crate::bibliography#makinoberz2003)). Coefficients are those
/// at one point, where terms that cancel do so but for rounding; what is left out does not cancel, but is as small as the first power left out.
///
/// ```
/// use jurist_algebra::ball::{Ball, TaylorModel};
/// // exp(x/4): what is left out after five terms is below 4^-5/5! (1 + 1/20)
/// let [zero, one] = [0, 1].map(|n| Ball::from_integer(&n.into(), 64));
/// let model = TaylorModel::linear(&zero, &one.shifted(-2), 5).exp();
/// let rest = model.coefficients().pop().unwrap();
/// assert!(rest.contains(&"0.00000813".parse().unwrap()) && !rest.contains(&"0.0000086".parse().unwrap()));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TaylorModel {
    polynomial: Series,
    /// In units of the last place.
    rest: Integer,
}

/// With so many bits or fewer, short numbers are as good for the solutions of an equation.
const SHORT_BITS: u64 = 176;

impl TaylorModel {
    /// `c + r x` with so many terms, at least two.
    ///
    /// # Panics
    /// With fewer terms.
    pub fn linear(c: &Ball, r: &Ball, terms: usize) -> TaylorModel {
        assert!(terms > 1, "a line has two coefficients");
        TaylorModel { polynomial: Series::linear(c, r, terms), rest: Integer::ZERO }
    }

    /// The coefficients from the constant term up, and last a ball around zero whose ends bound the sum of the absolute values of all others.
    pub fn coefficients(&self) -> Vec<Ball> {
        let rest = Ball::from_units(-&self.rest, self.rest.clone(), self.bits());
        self.polynomial.coefficients().iter().cloned().chain([rest]).collect()
    }

    /// Where all values on the disc are that are real.
    pub fn range(&self) -> Ball {
        self.first().widened(&self.around())
    }

    /// A power of two that no value on the disc is larger than, the least but for a factor of two; that of one for the function 0.
    pub fn exponent(&self) -> i64 {
        let norm = Scaled::norm_units(self);
        if norm.is_zero() { 0 } else { norm.bit_length() as i64 - self.bits() as i64 }
    }

    /// How far from the first coefficient values are at most.
    fn around(&self) -> Integer {
        self.norm_units() - self.first().magnitude_units()
    }

    /// A lower bound of the absolute value on the disc, in units; zero where there may be a zero.
    fn least_units(&self) -> Integer {
        let least = self.first().least_magnitude_units() - self.around();
        if least.is_negative() { Integer::ZERO } else { least }
    }

    /// A function of which nothing is left out.
    pub(super) fn from_series(polynomial: Series) -> TaylorModel {
        TaylorModel { polynomial, rest: Integer::ZERO }
    }

    /// A polynomial and what it is wrong by, times a power of two, with so many bits.
    pub(super) fn from_known(known: &Known, exponent: i64, bits: u64) -> TaylorModel {
        let coefficients = known.coefficients.iter().map(|c| c.widened(&known.noise)).collect();
        TaylorModel::with(Series::new(coefficients), known.rest.clone()).rescaled(bits, exponent)
    }

    pub(super) fn polynomial(&self) -> &Series {
        &self.polynomial
    }

    fn first(&self) -> &Ball {
        &self.polynomial.coefficients()[0]
    }

    pub(super) fn rest_units(&self) -> &Integer {
        &self.rest
    }

    pub(super) fn with(polynomial: Series, rest: Integer) -> TaylorModel {
        TaylorModel { polynomial, rest }
    }

    /// Two functions with all that a product leaves out: the powers beyond the last of the polynomials' product, and what each has left out.
    fn left_out(&self, other: &TaylorModel) -> Integer {
        let sizes = |model: &TaylorModel| -> Vec<Integer> {
            model.polynomial.coefficients().iter().map(Ball::magnitude_units).collect()
        };
        let (a, b) = (sizes(self), sizes(other));
        let n = a.len();
        // The sums of the last coefficients of the other one.
        let mut last = vec![Integer::ZERO; n + 1];
        for k in (0..n).rev() {
            last[k] = &last[k + 1] + &b[k];
        }
        let mut sum = Integer::ZERO;
        for (i, a) in a.iter().enumerate().skip(1) {
            sum.add_mul_assign(a, &last[n - i]);
        }
        if !other.rest.is_zero() {
            let all = a.iter().fold(self.rest.clone(), |sum, a| sum + a);
            sum.add_mul_assign(&all, &other.rest);
        }
        sum.add_mul_assign(&last[0], &self.rest);
        up(sum, self.bits())
    }

    /// The sum.
    pub fn add(&self, other: &TaylorModel) -> TaylorModel {
        TaylorModel::with(self.polynomial.add(&other.polynomial), &self.rest + &other.rest)
    }

    /// The difference.
    pub fn sub(&self, other: &TaylorModel) -> TaylorModel {
        TaylorModel::with(self.polynomial.sub(&other.polynomial), &self.rest + &other.rest)
    }

    /// The product: `n^2 / 2` products of balls.
    pub fn mul(&self, other: &TaylorModel) -> TaylorModel {
        TaylorModel::with(self.polynomial.mul(&other.polynomial), self.left_out(other))
    }

    /// The quotient; `None` where the divisor may have a zero in the disc.
    ///
    /// With `q` the first terms, `a/b - q = (a - q b)/b`, and `a - q b` has none of the first powers.
    pub fn div(&self, other: &TaylorModel) -> Option<TaylorModel> {
        let least = other.least_units();
        if least.is_zero() {
            return None;
        }
        let quotient = TaylorModel::with(self.polynomial.div(&other.polynomial)?, Integer::ZERO);
        let missed = quotient.left_out(other) + &self.rest;
        let rest = ratio_up(&missed, &least, self.bits());
        Some(TaylorModel { rest, ..quotient })
    }

    /// The square root; `None` where the function may have a zero in the disc or is negative.
    ///
    /// With `s` the first terms and `e = a - s^2`, `sqrt(a) - s = s (sqrt(1 + e/s^2) - 1)`, whose norm is at most that of `e/s` times
    /// that of `1/s` times that of `s`, as long as `e/s^2` has at most the norm 1.
    pub fn sqrt(&self) -> Option<TaylorModel> {
        let root = TaylorModel::with(self.polynomial.sqrt()?, Integer::ZERO);
        let least = root.least_units();
        if least.is_zero() {
            return None;
        }
        let bits = self.bits();
        let missed = root.left_out(&root) + &self.rest;
        let relative = ratio_up(&ratio_up(&missed, &least, bits), &least, bits);
        if relative > &Integer::ONE << bits {
            return None;
        }
        let rest = up(relative * root.norm_units(), bits);
        Some(TaylorModel { rest, ..root })
    }

    /// The exponential.
    pub fn exp(&self) -> TaylorModel {
        let out = self.polynomial.exp();
        let sizes = Growth::of(&self.polynomial, 0, &self.rest);
        let rest = up(exp(self.first()).magnitude_units() * sizes.left_out, self.bits());
        TaylorModel::with(out, rest)
    }

    /// The power with a natural exponent.
    pub fn power(&self, exponent: u64) -> TaylorModel {
        let mut out = self.integer(&Integer::ONE);
        let (mut base, mut rest) = (self.clone(), exponent);
        while rest > 0 {
            if rest % 2 == 1 {
                out = out.mul(&base);
            }
            rest /= 2;
            if rest > 0 {
                base = base.mul(&base);
            }
        }
        out
    }

    /// As [`fundamental_solutions`].
    ///
    /// For constant coefficients `y' = y C t'`, the companion matrix `C` being at most `2 w` in the unit of time in which the roots are at most 1,
    /// so that the powers left out are at most those of the exponential of `2 w` times the sizes of the coefficients of time.
    pub fn solutions(coefficients: &[TaylorModel], time: &TaylorModel) -> Vec<TaylorModel> {
        let is_constant =
            |c: &TaylorModel| c.rest.is_zero() && c.polynomial.coefficients()[1..].iter().all(Ball::is_zero);
        if !coefficients.iter().all(is_constant) {
            let short = (time.bits() <= SHORT_BITS).then(|| short_solutions(coefficients, time)).flatten();
            return short.unwrap_or_else(|| solutions_by_taylor(coefficients, time));
        }
        let (n, bits) = (coefficients.len(), time.bits());
        let series: Vec<Series> = coefficients.iter().map(|c| c.polynomial.clone()).collect();
        let row = fundamental_solutions(&series, &time.polynomial);
        let octaves = |(j, c): (usize, &TaylorModel)| {
            (c.norm_units().bit_length() as i64 - bits as i64).max(0).unsigned_abs().div_ceil((n - j) as u64)
        };
        let octaves = coefficients.iter().enumerate().map(octaves).max().unwrap_or(0);
        let sizes = Growth::of(&time.polynomial, octaves + 1, &time.rest);
        // The greatest entry where the powers begin, in that unit of time.
        let entries =
            row.iter().enumerate().map(|(j, y)| y.coefficients()[0].magnitude_units() << (octaves * j as u64));
        let all = up(entries.max().unwrap_or(Integer::ZERO) * sizes.left_out, bits);
        let rest = |j: usize| up(all.clone(), octaves * j as u64);
        row.into_iter().enumerate().map(|(j, y)| TaylorModel::with(y, rest(j))).collect()
    }
}

/// The exponential of the sizes of all coefficients but the first, as one of what bounds them.
struct Growth {
    /// The sum of the coefficients that are left out, in units.
    left_out: Integer,
}

impl Growth {
    /// Of `2^octaves` times the polynomial less its first coefficient, and a rest in units.
    fn of(polynomial: &Series, octaves: u64, rest: &Integer) -> Growth {
        let bits = polynomial.bits();
        let size = |n: Integer| Ball::from_units(n.clone(), n, bits);
        let mut sizes: Vec<Integer> =
            polynomial.coefficients().iter().map(|c| c.magnitude_units() << octaves).collect();
        sizes[0] = Integer::ZERO;
        let all = exp(&size(sizes.iter().fold(Integer::ZERO, |sum, c| sum + c)));
        let first = Series::new(sizes.into_iter().map(size).collect()).exp();
        let first = first.coefficients().iter().fold(Ball::zero(bits), |sum, c| sum.add(c));
        let beyond = all.sub(&first).magnitude_units();
        let by_rest = exp(&size(rest << octaves)).sub(&Ball::from_integer(&Integer::ONE, bits)).magnitude_units();
        Growth { left_out: beyond + up(all.magnitude_units() * by_rest, bits) }
    }
}

/// `n 2^-bits`, rounded up.
fn up(n: Integer, bits: u64) -> Integer {
    -(-n >> bits)
}

/// `a/b` in units, rounded up, for positive `b`.
fn ratio_up(a: &Integer, b: &Integer, bits: u64) -> Integer {
    -(-(a << bits)).div_mod_floor(b).0
}

impl Enclosed for TaylorModel {
    fn nothing(&self) -> TaylorModel {
        TaylorModel::from_series(self.polynomial.nothing())
    }
    fn plus(&self, other: &TaylorModel) -> TaylorModel {
        self.add(other)
    }
    fn minus(&self, other: &TaylorModel) -> TaylorModel {
        self.sub(other)
    }
    fn times(&self, other: &TaylorModel) -> TaylorModel {
        self.mul(other)
    }
    fn over(&self, other: &TaylorModel) -> Option<TaylorModel> {
        self.div(other)
    }
    fn is_nothing(&self) -> bool {
        self.rest.is_zero() && self.polynomial.is_nothing()
    }
    fn least(&self) -> Integer {
        self.least_units()
    }
}

impl Summed for TaylorModel {
    fn one(&self) -> TaylorModel {
        self.integer(&Integer::ONE)
    }
    fn divided_by(&self, n: u64) -> TaylorModel {
        let rest = -(-&self.rest).div_mod_floor(&Integer::from(n)).0;
        TaylorModel::with(self.polynomial.divided_by(n), rest)
    }
    fn widened(&self) -> TaylorModel {
        TaylorModel::with(self.polynomial.widened(), &self.rest + &Integer::ONE)
    }
}

impl Approximate for TaylorModel {
    fn near(&self) -> TaylorModel {
        let bits = self.bits();
        let middle = |c: &Ball| Ball::from_units(c.middle_units(), c.middle_units(), bits);
        TaylorModel::from_series(self.polynomial.map(middle))
    }
    fn around(&self, radius: &Integer) -> TaylorModel {
        TaylorModel::with(self.polynomial.map(|c| c.widened(radius)), &self.rest + radius)
    }
    fn size(&self) -> Integer {
        self.norm_units()
    }
}

impl Scaled for TaylorModel {
    fn norm_units(&self) -> Integer {
        self.polynomial.norm_units() + &self.rest
    }
    fn rescaled(&self, bits: u64, exponent: i64) -> TaylorModel {
        // One shift for the rest: units of the new last place.
        let by = exponent + bits as i64 - self.bits() as i64;
        let rest = if by >= 0 { &self.rest << by.unsigned_abs() } else { up(self.rest.clone(), by.unsigned_abs()) };
        TaylorModel::with(self.polynomial.rescaled(bits, exponent), rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{Rational, parse_number};
    use proptest::prelude::*;

    const BITS: u64 = 160;

    fn number(text: &str) -> Rational {
        parse_number(text).unwrap()
    }

    fn at(text: &str, radius: &str, terms: usize) -> TaylorModel {
        TaylorModel::linear(
            &Ball::from_rational(&number(text), BITS),
            &Ball::from_rational(&number(radius), BITS),
            terms,
        )
    }

    /// Where the value at a point is.
    fn value(model: &TaylorModel, x: &Rational) -> Ball {
        let point = Ball::from_rational(x, BITS);
        let mut coefficients = model.coefficients();
        let rest = coefficients.pop().unwrap();
        let power = point.power(coefficients.len() as u64).magnitude_units() + Integer::ONE;
        let polynomial = coefficients.iter().rev().fold(Ball::zero(BITS), |sum, c| sum.mul(&point).add(c));
        polynomial.widened(&up(rest.magnitude_units() * power, BITS))
    }

    /// The same of a series that is one number, at the points `m + r x`.
    fn holds(f: impl Fn(&TaylorModel) -> Option<TaylorModel>, g: impl Fn(&Ball) -> Option<Ball>, m: &str, r: &str) {
        for terms in [2, 5, 9] {
            let Some(model) = f(&at(m, r, terms)) else { continue };
            for x in ["-1", "-3/7", "0", "1/5", "1"].map(number) {
                let there = Ball::from_rational(&(number(m) + &(&number(r) * &x)), BITS);
                let exact = g(&there).expect("defined on the disc");
                assert!(value(&model, &x).intersection(&exact).is_some(), "{m} {r} {x} with {terms} terms");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if std::env::var_os("JURIST_THOROUGH").is_some() { 48 } else { 12 }))]

        #[test]
        fn models_hold_the_values_of_what_they_stand_for(m in -40i64..40, r in 1i64..12, a in -9i64..9, b in 1i64..9) {
            let (m, r) = (format!("{m}/8"), format!("{r}/8"));
            let (a, b) = (Integer::from(a), Integer::from(b));
            let polynomial = |p: &TaylorModel| p.mul(p).sub(&p.mul(&p.integer(&a))).add(&p.integer(&b));
            let at_point = |p: &Ball| p.mul(p).sub(&p.scaled(&a)).add(&Ball::from_integer(&b, BITS));
            holds(|p| Some(polynomial(p)), |p| Some(at_point(p)), &m, &r);
            holds(|p| p.div(&polynomial(p)), |p| p.div(&at_point(p)), &m, &r);
            holds(|p| polynomial(p).sqrt(), |p| at_point(p).sqrt(), &m, &r);
            holds(|p| Some(p.exp().mul(&polynomial(p)).exp()), |p| Some(exp(&exp(p).mul(&at_point(p)))), &m, &r);
            holds(|p| Some(polynomial(p).power(5)), |p| Some(at_point(p).power(5)), &m, &r);
        }

        /// The solutions of `y'' + a y' + p y = 0` and of the same with a constant `b` at times about `p`, against exponentials at points.
        #[test]
        fn models_of_solutions_hold_those_at_points(m in 1i64..24, r in 1i64..6, a in -6i64..6, b in 1i64..60) {
            let (m, r) = (format!("{m}/8"), format!("{r}/16"));
            let (a, b) = (Integer::from(a), Integer::from(b));
            for k in 0..2 {
                let moving = |p: &TaylorModel| Some(TaylorModel::solutions(&[p.clone(), p.integer(&a)], &p.mul(p)).swap_remove(k));
                let fixed = |p: &TaylorModel| {
                    let time = p.exp().sub(&p.integer(&Integer::ONE));
                    Some(TaylorModel::solutions(&[p.integer(&b), p.integer(&a)], &time).swap_remove(k))
                };
                let constant = |c: &Ball| Series::constant(c, 1);
                let solution = |c: Ball, t: Ball| {
                    let list = [constant(&c), constant(&Ball::from_integer(&a, BITS))];
                    Some(fundamental_solutions(&list, &constant(&t))[k].coefficients()[0].clone())
                };
                let one = Ball::from_integer(&Integer::ONE, BITS);
                holds(moving, |p| solution(p.clone(), p.mul(p)), &m, &r);
                holds(fixed, |p| solution(Ball::from_integer(&b, BITS), exp(p).sub(&one)), &m, &r);
            }
        }
    }

    #[test]
    fn what_may_vanish_in_the_disc_is_no_divisor() {
        let one = at("1", "0", 4);
        assert!(one.div(&at("1", "1", 4)).is_none() && one.div(&at("1", "-9/8", 4)).is_none());
        assert!(one.div(&at("1", "7/8", 4)).is_some() && at("-3", "1/8", 4).sqrt().is_none());
    }

    /// `exp(x)` to 12 terms: as small as the first power that is left out, and 48 bits of what cancels are no more.
    #[test]
    fn what_is_left_out_is_as_small_as_the_first_power() {
        let x = at("0", "1", 12);
        let one = x.integer(&Integer::ONE);
        let cancelled = x.exp().mul(&x.sub(&x).sub(&x).exp()).sub(&one);
        let rest = cancelled.coefficients().pop().unwrap().upper();
        assert!(rest < number("1e-4"), "{rest}");
        let left_out = x.exp().coefficients().pop().unwrap().upper();
        assert!(left_out > number("2.08e-9") && left_out < number("2.3e-9"), "{left_out}");
    }
}
