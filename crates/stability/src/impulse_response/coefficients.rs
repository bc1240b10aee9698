//! Coefficients of a transfer function as enclosures, over the leading one of the denominator.

use jurist_algebra::ball::Ball;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;

/// `H = (b_0 + b_1 z^-1 + ... + b_n z^-n)/(1 + a_1 z^-1 + ... + a_n z^-n)`.
#[derive(Clone, Debug)]
pub(super) struct Monic {
    /// `b_0, ..., b_n`.
    pub above: Vec<Ball>,
    /// `a_1, ..., a_n`.
    pub below: Vec<Ball>,
}

impl Monic {
    /// From integers, from the constant term up.
    pub fn of_integers(numerator: &UniPoly, denominator: &UniPoly, bits: u64) -> Monic {
        let leading = denominator.leading().expect("the denominator is not zero");
        let n = denominator.coeffs().len() - 1;
        let over = |p: &UniPoly, k: usize| Ball::from_rational(&Rational::new(p.coeff(k), leading.clone()), bits);
        Monic {
            above: (0..=n).map(|k| over(numerator, n - k)).collect(),
            below: (1..=n).map(|k| over(denominator, n - k)).collect(),
        }
    }

    /// From balls, from the constant term up; `None` where the last of the denominator may be zero.
    pub fn of_balls(numerator: Vec<Ball>, denominator: Vec<Ball>) -> Option<Monic> {
        let (leading, rest) = denominator.split_last()?;
        let zero = Ball::zero(leading.bits());
        let over = |p: Option<&Ball>| p.unwrap_or(&zero).div(leading);
        let n = rest.len();
        Some(Monic {
            above: (0..=n).map(|k| over(numerator.get(n - k))).collect::<Option<_>>()?,
            below: (1..=n).map(|k| over(rest.get(n - k))).collect::<Option<_>>()?,
        })
    }

    /// The number of poles.
    pub fn order(&self) -> usize {
        self.below.len()
    }

    /// The number of bits after the point.
    pub fn bits(&self) -> u64 {
        self.above[0].bits()
    }
}
