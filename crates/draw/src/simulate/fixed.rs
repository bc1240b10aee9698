//! Complex numbers in fixed point: both parts times `2^bits`, of any precision.

use jurist_algebra::number::{Integer, Rational};
use nalgebra::Complex;

/// `(re + i im) / 2^bits`; the precision `bits` is known to whoever computes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fixed {
    pub re: Integer,
    pub im: Integer,
}

impl Fixed {
    pub fn zero() -> Fixed {
        Fixed { re: Integer::ZERO, im: Integer::ZERO }
    }

    pub fn one(bits: u64) -> Fixed {
        Fixed { re: &Integer::ONE << bits, im: Integer::ZERO }
    }

    /// The nearest below; parts that are not finite become 0.
    pub fn from_f64(value: Complex<f64>, bits: u64) -> Fixed {
        Fixed { re: integer_times_power(value.re, bits), im: integer_times_power(value.im, bits) }
    }

    pub fn to_f64(&self, bits: u64) -> Complex<f64> {
        let part = |v: &Integer| {
            let drop = v.bit_length().saturating_sub(64);
            // In two steps, as the power alone may be too small for a number.
            let half = ((drop as f64 - bits as f64) / 2.0).floor();
            (v >> drop).to_f64_approximate() * half.exp2() * (drop as f64 - bits as f64 - half).exp2()
        };
        Complex::new(part(&self.re), part(&self.im))
    }

    pub fn is_zero(&self) -> bool {
        self.re.is_zero() && self.im.is_zero()
    }

    pub fn widened(&self, more: u64) -> Fixed {
        Fixed { re: &self.re << more, im: &self.im << more }
    }

    pub fn plus(&self, other: &Fixed) -> Fixed {
        Fixed { re: &self.re + &other.re, im: &self.im + &other.im }
    }

    pub fn minus(&self, other: &Fixed) -> Fixed {
        Fixed { re: &self.re - &other.re, im: &self.im - &other.im }
    }

    pub fn times(&self, other: &Fixed, bits: u64) -> Fixed {
        let mut re = &self.re * &other.re;
        re.sub_mul_assign(&self.im, &other.im);
        let mut im = &self.re * &other.im;
        im.add_mul_assign(&self.im, &other.re);
        Fixed { re: &re >> bits, im: &im >> bits }
    }

    /// The quotient; `None` for a zero divisor.
    pub fn over(&self, other: &Fixed, bits: u64) -> Option<Fixed> {
        let mut norm = &other.re * &other.re;
        norm.add_mul_assign(&other.im, &other.im);
        if norm.is_zero() {
            return None;
        }
        let mut re = &self.re * &other.re;
        re.add_mul_assign(&self.im, &other.im);
        let mut im = &self.im * &other.re;
        im.sub_mul_assign(&self.re, &other.im);
        let part = |v: Integer| (&v << bits).div_mod_floor(&norm).0;
        Some(Fixed { re: part(re), im: part(im) })
    }

    /// Bits of the larger part: `|z| 2^bits < 2^(size + 1/2)`.
    pub fn size(&self) -> u64 {
        self.re.bit_length().max(self.im.bit_length())
    }
}

/// `floor(value * 2^bits)`.
fn integer_times_power(value: f64, bits: u64) -> Integer {
    let exact = Rational::from_f64(value).unwrap_or_default();
    (exact.numerator() << bits).div_mod_floor(&exact.denominator()).0
}

/// The exact value of a finite `f64`, cut to `keep` bits after its first one; 0 if not finite.
pub(super) fn rational_from_f64(value: f64, keep: u64) -> Rational {
    if !value.is_finite() || value == 0.0 {
        return Rational::ZERO;
    }
    let bits = (keep as i64 - value.abs().log2().floor() as i64).max(0) as u64;
    Rational::dyadic(&integer_times_power(value, bits), bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f64_comes_through_unchanged() {
        for v in [0.0, 1.0, -0.1, 1e-300, -3.5e200, f64::MIN_POSITIVE, 5e-324] {
            let there = Fixed::from_f64(Complex::new(v, -v), 1200);
            assert_eq!(there.to_f64(1200), Complex::new(v, -v));
            assert_eq!(rational_from_f64(v, 60).to_f64_approximate(), v);
        }
        assert!(rational_from_f64(f64::NAN, 60).is_zero());
    }

    #[test]
    fn division_undoes_multiplication() {
        let bits = 100;
        let (a, b) = (Fixed::from_f64(Complex::new(3.0, -4.0), bits), Fixed::from_f64(Complex::new(-0.5, 2.0), bits));
        assert_eq!(a.times(&b, bits).over(&b, bits), Some(a.clone()));
        assert_eq!(a.over(&Fixed::zero(), bits), None);
    }
}
