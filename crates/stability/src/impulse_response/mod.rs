//! The impulse response of a stable transfer function, and the sum or the integral of its absolute values.
//!
//! Of a transfer function in `s` the integral has a module of its own (`integral`); the rest of this is of samples.
//!
//! `H = N/D = sum h_k z^-k`. The sum `|h_0| + |h_1| + ...` is the norm of `H` as a map of bounded signals: from rest
//! `sup |y| <= sum |h_k| sup |u|`, and no smaller number does, as the input `u_(k-i) = sign h_i` shows.
//!
//! With the companion matrix `A` of `D` the windows `w_k = (h_k, ..., h_(k+n-1))` obey `w_(k+1) = A w_k` from `k = 1` on, and
//! `A^p` has a norm below 1 for some `p` where all roots are inside of the unit circle (`powers`). So what follows after a
//! block of `p` windows is bounded by that block, and samples are computed until it is small (`bracket`). A sample is an
//! integer over a power of two (`recursion`): no rational number grows. Where it is proved which samples have which sign, the
//! sum is a rational number (`one_sign`).

mod bracket;
mod coefficients;
mod integral;
mod one_sign;
mod powers;
mod recursion;
#[cfg(test)]
mod reference;
#[cfg(test)]
mod tests;

use bracket::Brackets;
use coefficients::Monic;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, UniPoly};
use std::fmt;
use std::sync::Arc;

/// The impulse response of a transfer function `N/D`: in `z` with all poles inside of the unit circle, or in `s` with all of them left of the axis.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::ImpulseResponse;
/// let pole = ImpulseResponse::of_integers(&UniPoly::from_i64(&[2]), &UniPoly::from_i64(&[-1, 2])); // 1/(z - 1/2)
/// let sum = pole.absolute_sum(20, &Budget::unlimited())?;
/// assert_eq!(sum.exact, Some(2.into()));
/// # Ok::<(), jurist_algebra::limits::Exhausted>(())
/// ```
#[derive(Clone, Debug)]
pub struct ImpulseResponse {
    over: Over,
}

/// What the coefficients are.
#[derive(Clone)]
enum Over {
    Integers { numerator: UniPoly, denominator: UniPoly },
    Enclosed(Arc<dyn Fn(u64) -> Option<[Vec<Ball>; 2]> + Send + Sync>),
}

impl fmt::Debug for Over {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Over::Integers { numerator, denominator } => write!(f, "({numerator:?})/({denominator:?})"),
            Over::Enclosed(_) => f.write_str("enclosed coefficients"),
        }
    }
}

/// The sum, or the integral, of the absolute values of an impulse response, between two numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AbsoluteSum {
    /// The sum is not below this: a number over a power of two, or the sum itself.
    pub lower: Rational,
    /// The sum is not above this.
    pub upper: Rational,
    /// The sum itself, where it is proved to be this rational number; then both bounds are equal to it.
    pub exact: Option<Rational>,
    /// How many samples were computed, from `h_0` on; of an integral how many steps of time.
    pub terms: usize,
}

impl AbsoluteSum {
    fn exactly(sum: Rational, terms: usize) -> AbsoluteSum {
        AbsoluteSum { lower: sum.clone(), upper: sum.clone(), exact: Some(sum), terms }
    }
}

impl ImpulseResponse {
    /// Of a quotient of polynomials with integer coefficients; common factors are divided out.
    ///
    /// What is left of the denominator has to be stable, as [`is_stable`](crate::is_stable) proves: else the sum is not finite, and only a budget
    /// ends its computation.
    ///
    /// Cost: that of a greatest common divisor.
    ///
    /// # Panics
    /// When the denominator is zero, or of a lower degree than the numerator.
    pub fn of_integers(numerator: &UniPoly, denominator: &UniPoly) -> ImpulseResponse {
        assert!(!denominator.is_zero(), "a transfer function has a denominator");
        assert!(numerator.coeffs().len() <= denominator.coeffs().len(), "a bounded transfer function is proper");
        let common = numerator.gcd(denominator);
        let divided = |p: &UniPoly| p.div_exact(&common).expect("a gcd divides");
        ImpulseResponse { over: Over::Integers { numerator: divided(numerator), denominator: divided(denominator) } }
    }

    /// Of a quotient whose coefficients are known by enclosures: those of the numerator and of the denominator, from the constant term
    /// up, with so many bits after the point; `None` where they cannot be had with so few.
    ///
    /// The denominator is to be stable, and its degree not below that of the numerator. A common factor makes nothing wrong. The numerator is to
    /// have a coefficient other than 0: that all are is not seen.
    ///
    /// ```
    /// use jurist_algebra::ball::{Ball, exp};
    /// use jurist_algebra::limits::Budget;
    /// use jurist_stability::ImpulseResponse;
    /// // (1 - e)/(z - e) with e = exp(-1/10)
    /// let response = ImpulseResponse::by_enclosures(|bits| {
    ///     let (e, one) = (exp(&Ball::from_rational(&"-1/10".parse().unwrap(), bits)), Ball::from_integer(&1.into(), bits));
    ///     Some([vec![one.sub(&e)], vec![e.neg(), one]])
    /// });
    /// let sum = response.absolute_sum(20, &Budget::unlimited())?;
    /// assert!(sum.lower < 1.into() && sum.upper > 1.into() && sum.exact.is_none());
    /// # Ok::<(), jurist_algebra::limits::Exhausted>(())
    /// ```
    pub fn by_enclosures(
        coefficients: impl Fn(u64) -> Option<[Vec<Ball>; 2]> + Send + Sync + 'static,
    ) -> ImpulseResponse {
        ImpulseResponse { over: Over::Enclosed(Arc::new(coefficients)) }
    }

    /// That is 0 at all times.
    pub fn zero() -> ImpulseResponse {
        ImpulseResponse::of_integers(&UniPoly::zero(), &UniPoly::one())
    }

    /// The sum of the absolute values of the samples, of a transfer function in `z`: exactly, or between two numbers that differ by at most
    /// `10^-(digits + 2)` of it.
    ///
    /// It is a rational number for certain where all poles are 0, and where one real pole is greater in modulus than the others
    /// and few samples come before its sign (or, of a negative pole, its alternation) is that of all that follow.
    ///
    /// Cost: for `n` poles of modulus at most `r`, `O(n^3 log 1/(1-r))` products for the norms of powers and
    /// `O(n digits/(1-r))` for the samples, of integers of `O(digits)` bits.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where no number of bits tells the sum from zero.
    pub fn absolute_sum(&self, digits: usize, budget: &Budget) -> Result<AbsoluteSum, Exhausted> {
        budget.step("impulse response");
        budget.enter(|| {
            if let Over::Integers { numerator, denominator } = &self.over
                && let Some((sum, terms)) = one_sign::sum(numerator, denominator)
            {
                return Ok(AbsoluteSum::exactly(sum, terms));
            }
            Brackets::new(&|bits| self.monic(bits)).sum(digits)
        })?
    }

    /// The integral of the absolute value, of a transfer function in `s`, and that of what is direct: between two numbers that differ by at most
    /// `10^-(digits + 2)` of it. Exactly only of a constant.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::UniPoly;
    /// use jurist_stability::ImpulseResponse;
    /// // 1/(s^2 + s + 1): coth(pi/(2 sqrt(3))), as of all pairs of poles with a damping of 1/2.
    /// let pair = ImpulseResponse::of_integers(&UniPoly::from_i64(&[1]), &UniPoly::from_i64(&[1, 1, 1]));
    /// let gain = pair.absolute_integral(9, &Budget::unlimited())?;
    /// assert!(gain.lower > "1.3895".parse().unwrap() && gain.upper < "1.3896".parse().unwrap());
    /// # Ok::<(), jurist_algebra::limits::Exhausted>(())
    /// ```
    ///
    /// Cost: with `r` for the greatest modulus of a pole over the least distance of one from the axis, `O(r n digits)` steps of `n` products, of integers of
    /// `O(digits)` bits; at each zero of the response `O(digits)` steps more.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where no number of bits tells the integral from zero.
    pub fn absolute_integral(&self, digits: usize, budget: &Budget) -> Result<AbsoluteSum, Exhausted> {
        budget.step("impulse response");
        budget.enter(|| {
            if let Over::Integers { numerator, denominator } = &self.over
                && denominator.coeffs().len() == 1
            {
                let direct = Rational::new(numerator.coeff(0), denominator.coeff(0));
                return Ok(AbsoluteSum::exactly(direct.abs(), 0));
            }
            integral::integral(&|bits| self.monic(bits), digits)
        })?
    }

    /// The signs of the first samples, of a transfer function in `z`: 1, -1, and 0 where a sample is zero or so small beside the others that thirty digits do not tell.
    ///
    /// From rest the input `u_(k-i) = sign h_i` makes the output `|h_0| + ... + |h_k|` at step `k`: the greatest that inputs of
    /// modulus 1 can.
    ///
    /// Cost: that of the powers in [`Self::absolute_sum`], and `O(n)` products for each sample.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn signs(&self, count: usize, budget: &Budget) -> Result<Vec<i8>, Exhausted> {
        budget.step("signs of the impulse response");
        budget.enter(|| Brackets::new(&|bits| self.monic(bits)).signs(count))
    }

    /// The coefficients over the leading one of the denominator; `None` where bits do not tell that from zero.
    fn monic(&self, bits: u64) -> Option<Monic> {
        match &self.over {
            Over::Integers { numerator, denominator } => Some(Monic::of_integers(numerator, denominator, bits)),
            Over::Enclosed(coefficients) => {
                let [numerator, denominator] = coefficients(bits)?;
                Monic::of_balls(numerator, denominator)
            }
        }
    }
}
