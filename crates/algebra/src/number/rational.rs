//! Rational numbers of any size.

use super::Integer;
use malachite_base::num::arithmetic::traits::{Abs, Ceiling, Floor, Pow, Reciprocal, Sign as _};
use malachite_base::num::conversion::traits::{IsInteger as _, RoundingFrom};
use malachite_base::rounding_modes::RoundingMode;
use malachite_nz::integer::Integer as InnerInteger;
use malachite_q::Rational as Inner;
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A rational number in lowest terms with a positive denominator.
///
/// ```
/// use jurist_algebra::number::{Integer, Rational};
/// let a = Rational::new(Integer::from(46), Integer::from(1000));
/// assert_eq!(a.to_string(), "23/500");
/// assert_eq!((&a + &a).to_string(), "23/250");
/// ```
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Rational(pub(super) Inner);

impl Rational {
    /// Zero.
    pub const ZERO: Rational = Rational(<Inner as malachite_base::num::basic::traits::Zero>::ZERO);
    /// One.
    pub const ONE: Rational = Rational(<Inner as malachite_base::num::basic::traits::One>::ONE);

    /// The quotient of two integers.
    ///
    /// # Panics
    /// When `denominator` is zero.
    pub fn new(numerator: Integer, denominator: Integer) -> Rational {
        Rational(Inner::from_integers(numerator.0, denominator.0))
    }

    /// `numerator / 2^bits`.
    pub fn dyadic(numerator: &Integer, bits: u64) -> Rational {
        Rational(Inner::from(&numerator.0) >> bits)
    }

    /// The numerator, with the sign.
    pub fn numerator(&self) -> Integer {
        Integer(InnerInteger::from_sign_and_abs_ref(self.0 >= 0u32, self.0.numerator_ref()))
    }

    /// The denominator, positive.
    pub fn denominator(&self) -> Integer {
        Integer(InnerInteger::from(self.0.denominator_ref()))
    }

    /// Whether this is 0.
    pub fn is_zero(&self) -> bool {
        self.0 == 0u32
    }

    /// Whether this is 1.
    pub fn is_one(&self) -> bool {
        self.0 == 1u32
    }

    /// Whether the denominator is 1.
    pub fn is_integer(&self) -> bool {
        (&self.0).is_integer()
    }

    /// The sign.
    pub fn sign(&self) -> Ordering {
        self.0.sign()
    }

    /// Whether this is below zero.
    pub fn is_negative(&self) -> bool {
        self.sign() == Ordering::Less
    }

    /// The magnitude.
    pub fn abs(&self) -> Rational {
        Rational((&self.0).abs())
    }

    /// `1 / self`; `None` for 0.
    pub fn recip(&self) -> Option<Rational> {
        (!self.is_zero()).then(|| Rational((&self.0).reciprocal()))
    }

    /// The power; `0^0 = 1`; `None` for 0 to a negative power.
    pub fn pow(&self, exponent: i64) -> Option<Rational> {
        let power = Rational((&self.0).pow(exponent.unsigned_abs()));
        if exponent < 0 { power.recip() } else { Some(power) }
    }

    /// The quotient; `None` when `other` is 0.
    pub fn checked_div(&self, other: &Rational) -> Option<Rational> {
        (!other.is_zero()).then(|| Rational(&self.0 / &other.0))
    }

    /// The greatest integer that is not above this.
    pub fn floor(&self) -> Integer {
        Integer((&self.0).floor())
    }

    /// The least integer that is not below this.
    pub fn ceil(&self) -> Integer {
        Integer((&self.0).ceiling())
    }

    /// The mean of two numbers.
    pub fn midpoint(&self, other: &Rational) -> Rational {
        Rational((&self.0 + &other.0) >> 1u64)
    }

    /// The nearest `f64`: for pictures, never for decisions.
    pub fn to_f64_approximate(&self) -> f64 {
        f64::rounding_from(&self.0, RoundingMode::Nearest).0
    }
}

impl From<Integer> for Rational {
    fn from(value: Integer) -> Self {
        Rational(Inner::from(value.0))
    }
}

impl From<&Integer> for Rational {
    fn from(value: &Integer) -> Self {
        Rational(Inner::from(&value.0))
    }
}

macro_rules! from_primitive {
    ($($t:ty),*) => {$(
        impl From<$t> for Rational {
            fn from(value: $t) -> Self {
                Rational(Inner::from(value))
            }
        }
    )*};
}
from_primitive!(i32, i64, u32, u64, usize);

macro_rules! binary {
    ($trait:ident, $method:ident) => {
        impl $trait for Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                Rational($trait::$method(self.0, other.0))
            }
        }
        impl $trait<&Rational> for Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                Rational($trait::$method(self.0, &other.0))
            }
        }
        impl $trait<Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                Rational($trait::$method(&self.0, other.0))
            }
        }
        impl $trait for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                Rational($trait::$method(&self.0, &other.0))
            }
        }
    };
}
binary!(Add, add);
binary!(Sub, sub);
binary!(Mul, mul);
binary!(Div, div);

macro_rules! assign {
    ($trait:ident, $method:ident) => {
        impl $trait<&Rational> for Rational {
            fn $method(&mut self, other: &Rational) {
                $trait::$method(&mut self.0, &other.0);
            }
        }
        impl $trait for Rational {
            fn $method(&mut self, other: Rational) {
                $trait::$method(&mut self.0, other.0);
            }
        }
    };
}
assign!(AddAssign, add_assign);
assign!(SubAssign, sub_assign);
assign!(MulAssign, mul_assign);

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational(-self.0)
    }
}

impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational(-&self.0)
    }
}

impl fmt::Display for Rational {
    /// `p/q`, integers without `/1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}
