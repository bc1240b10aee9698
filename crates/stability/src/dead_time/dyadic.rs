//! Points and steps on the positive axis with few bits.

use jurist_algebra::number::{Integer, Rational};

/// A number `m 2^-e`.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    pub m: Integer,
    pub e: u64,
}

/// The length `2^power` of an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step(pub i64);

impl Step {
    pub fn half(self) -> Rational {
        Rational::from(2).pow(self.0 - 1).expect("two is not zero")
    }
}

impl Dyadic {
    pub fn zero() -> Dyadic {
        Dyadic { m: Integer::ZERO, e: 0 }
    }

    pub fn rational(&self) -> Rational {
        Rational::dyadic(&self.m, self.e)
    }

    /// The power of two that is not above a positive number; `None` of zero.
    pub fn floor_log2(&self) -> Option<i64> {
        (!self.m.is_zero()).then(|| self.m.bit_length() as i64 - 1 - self.e as i64)
    }

    /// The point a step further, or a half (`halves = 1`) of it.
    pub fn plus(&self, step: Step, halves: i64) -> Dyadic {
        let power = step.0 - halves;
        if power >= 0 {
            return Dyadic { m: &self.m + &(&Integer::ONE << (power as u64 + self.e)), e: self.e };
        }
        let e = self.e.max(power.unsigned_abs());
        Dyadic { m: (&self.m << (e - self.e)) + (&Integer::ONE << (e - power.unsigned_abs())), e }.reduced()
    }

    fn reduced(mut self) -> Dyadic {
        let zeros = self.m.trailing_zeros().unwrap_or(self.e).min(self.e);
        self.m = self.m >> zeros;
        self.e -= zeros;
        self
    }

    /// A dyadic number in a closed interval of positive length, of about the bits that the length needs.
    pub fn within(lo: &Rational, hi: &Rational) -> Dyadic {
        let middle = lo.midpoint(hi);
        let quarter = (hi - lo) * Rational::dyadic(&Integer::ONE, 2);
        let mut e = 0;
        while Rational::dyadic(&Integer::ONE, e) > quarter {
            e += 8;
        }
        Dyadic { m: (middle * Rational::from(&Integer::ONE << e)).floor(), e }.reduced()
    }
}
