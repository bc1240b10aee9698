//! Conversions from and to `num-bigint` and `num-rational`, limb by limb.

use super::{Integer, Rational};
use num_bigint::{BigInt, BigUint, Sign};
use num_rational::Ratio;

impl From<&BigInt> for Integer {
    fn from(value: &BigInt) -> Self {
        let magnitude = Integer::from_limbs(value.magnitude().to_u64_digits());
        if value.sign() == Sign::Minus { -magnitude } else { magnitude }
    }
}

impl From<BigInt> for Integer {
    fn from(value: BigInt) -> Self {
        Integer::from(&value)
    }
}

impl From<&Integer> for BigInt {
    fn from(value: &Integer) -> Self {
        let digits = value.limbs().into_iter().flat_map(|limb| [limb as u32, (limb >> 32) as u32]).collect();
        let sign = if value.is_negative() { Sign::Minus } else { Sign::Plus };
        BigInt::from_biguint(sign, BigUint::new(digits))
    }
}

impl From<Integer> for BigInt {
    fn from(value: Integer) -> Self {
        BigInt::from(&value)
    }
}

impl TryFrom<&Ratio<BigInt>> for Rational {
    type Error = DivisionByZero;
    fn try_from(value: &Ratio<BigInt>) -> Result<Self, DivisionByZero> {
        let denominator = Integer::from(value.denom());
        if denominator.is_zero() { Err(DivisionByZero) } else { Ok(Rational::new(value.numer().into(), denominator)) }
    }
}

impl From<&Rational> for Ratio<BigInt> {
    fn from(value: &Rational) -> Self {
        Ratio::new_raw(value.numerator().into(), value.denominator().into())
    }
}

impl TryFrom<Ratio<BigInt>> for Rational {
    type Error = DivisionByZero;
    fn try_from(value: Ratio<BigInt>) -> Result<Self, DivisionByZero> {
        Rational::try_from(&value)
    }
}

impl From<Rational> for Ratio<BigInt> {
    fn from(value: Rational) -> Self {
        Ratio::from(&value)
    }
}

/// A ratio made by `Ratio::new_raw` with a zero denominator is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DivisionByZero;

impl std::fmt::Display for DivisionByZero {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the denominator is zero")
    }
}

impl std::error::Error for DivisionByZero {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raw_ratios() {
        let raw = |n: i32, d: i32| Ratio::new_raw(BigInt::from(n), BigInt::from(d));
        assert_eq!(Rational::try_from(raw(1, 0)), Err(DivisionByZero));
        assert_eq!(Rational::try_from(raw(6, -4)).map(|v| v.to_string()), Ok("-3/2".into()));
    }
}
