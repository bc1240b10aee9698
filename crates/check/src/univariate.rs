//! Polynomials in one variable over the integers, and what the check asks of them.

use super::clock::Clock;
use super::number::{Q, Z};
use num_bigint::Sign;
use num_traits::{One, Signed, Zero};

/// Coefficients from the constant term up, without zeros at the top.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(super) struct Uni(pub Vec<Z>);

impl Uni {
    pub fn new(mut coefficients: Vec<Z>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Uni(coefficients)
    }

    pub fn constant(value: Z) -> Self {
        Uni::new(vec![value])
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// The degree, 0 for zero.
    pub fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    pub fn leading(&self) -> Z {
        self.0.last().cloned().unwrap_or_default()
    }

    pub fn at(&self, k: usize) -> Z {
        self.0.get(k).cloned().unwrap_or_default()
    }

    pub fn plus(&self, other: &Uni) -> Uni {
        let n = self.0.len().max(other.0.len());
        Uni::new((0..n).map(|k| self.at(k) + other.at(k)).collect())
    }

    pub fn minus(&self, other: &Uni) -> Uni {
        self.plus(&other.scaled(&-Z::one()))
    }

    pub fn scaled(&self, factor: &Z) -> Uni {
        Uni::new(self.0.iter().map(|c| c * factor).collect())
    }

    /// The longest coefficient's bits.
    pub fn longest(&self) -> u64 {
        self.0.iter().map(Z::bits).max().unwrap_or(0)
    }

    /// The product, counted before it is computed.
    pub fn product(&self, other: &Uni, clock: &Clock) -> Result<Uni, String> {
        let (bits, others) = (self.longest(), other.longest());
        clock.hold(self.0.len() + other.0.len(), bits + others)?;
        clock.spend(self.0.len() * other.0.len(), bits, others)?;
        Ok(self.times(other))
    }

    pub fn times(&self, other: &Uni) -> Uni {
        if self.is_zero() || other.is_zero() {
            return Uni::default();
        }
        let mut out = vec![Z::zero(); self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, b) in other.0.iter().enumerate() {
                out[i + j] += a * b;
            }
        }
        Uni::new(out)
    }

    /// `p^k` times the polynomial.
    pub fn shifted_up(&self, k: usize) -> Uni {
        if self.is_zero() {
            return Uni::default();
        }
        Uni(std::iter::repeat_n(Z::zero(), k).chain(self.0.iter().cloned()).collect())
    }

    /// The greatest common divisor of the coefficients.
    pub fn content(&self, clock: &Clock) -> Result<Z, String> {
        gcd_of(self.0.iter(), clock)
    }

    /// Divided by the content; the sign stays.
    pub fn primitive(&self, clock: &Clock) -> Result<Uni, String> {
        let content = self.content(clock)?;
        if content.is_zero() || content.is_one() {
            return Ok(self.clone());
        }
        clock.spend(self.0.len(), self.longest(), content.bits())?;
        Ok(Uni(self.0.iter().map(|c| c / &content).collect()))
    }

    /// The value at a rational number, times the denominator of that number to the power of the degree.
    pub fn numerator_at(&self, value: &Q, clock: &Clock) -> Result<Z, String> {
        let (mut result, mut q_power) = (Z::zero(), Z::one());
        let (top, below) = (value.numer().bits(), value.denom().bits());
        for (i, c) in self.0.iter().rev().enumerate() {
            clock.spend(1, result.bits(), top)?;
            clock.spend(1, q_power.bits(), below.max(c.bits()))?;
            if i > 0 {
                q_power *= value.denom();
            }
            result = result * value.numer() + c * &q_power;
        }
        Ok(result)
    }

    pub fn sign_at(&self, value: &Q, clock: &Clock) -> Result<Sign, String> {
        Ok(self.numerator_at(value, clock)?.sign())
    }

    pub fn vanishes_at(&self, value: &Q, clock: &Clock) -> Result<bool, String> {
        Ok(self.numerator_at(value, clock)?.is_zero())
    }

    /// The quotient over the rationals, made primitive, if the division leaves no remainder.
    pub fn divided(&self, divisor: &Uni, clock: &Clock) -> Result<Option<Uni>, String> {
        if divisor.is_zero() || self.0.len() < divisor.0.len() {
            return Ok(None);
        }
        // Gauss: a quotient of primitive polynomials is primitive over the integers.
        let (mut rest, divisor) = (self.primitive(clock)?.0, divisor.primitive(clock)?);
        let (lead, longest) = (divisor.leading(), divisor.longest());
        let n = divisor.degree();
        let mut quotient = vec![Z::zero(); rest.len() - n];
        for k in (0..quotient.len()).rev() {
            clock.spend(n + 1, rest[k + n].bits(), longest)?;
            let q = &rest[k + n] / &lead;
            if &q * &lead != rest[k + n] {
                return Ok(None);
            }
            if !q.is_zero() {
                for (j, c) in divisor.0.iter().enumerate() {
                    rest[k + j] -= c * &q;
                }
            }
            quotient[k] = q;
        }
        Ok(rest.iter().all(Zero::is_zero).then(|| Uni::new(quotient)))
    }

    /// The primitive greatest common divisor over the rationals, with a positive leading coefficient.
    pub fn gcd(&self, other: &Uni, clock: &Clock) -> Result<Uni, String> {
        let (mut a, mut b) = (self.primitive(clock)?, other.primitive(clock)?);
        if a.degree() < b.degree() {
            std::mem::swap(&mut a, &mut b);
        }
        while !b.is_zero() {
            if b.degree() == 0 {
                return Ok(Uni(vec![Z::one()]));
            }
            let rest = a.pseudo_remainder(&b, clock)?.primitive(clock)?;
            a = std::mem::replace(&mut b, rest);
        }
        Ok(if a.leading().is_negative() { a.scaled(&-Z::one()) } else { a })
    }

    /// A multiple of the remainder by a non-zero integer; the multiple is positive.
    pub fn pseudo_remainder(&self, divisor: &Uni, clock: &Clock) -> Result<Uni, String> {
        let mut rest = self.clone();
        let lead = divisor.leading();
        let (size, longest) = (lead.abs(), divisor.longest());
        while !rest.is_zero() && rest.0.len() >= divisor.0.len() {
            let bits = rest.longest();
            clock.hold(rest.0.len(), bits + longest)?;
            clock.spend(rest.0.len() + divisor.0.len(), bits, longest)?;
            let shift = rest.0.len() - divisor.0.len();
            let mut top = rest.leading();
            if lead.is_negative() {
                top = -top;
            }
            rest = rest.scaled(&size).minus(&divisor.scaled(&top).shifted_up(shift));
        }
        Ok(rest)
    }

    pub fn derivative(&self) -> Uni {
        Uni::new(self.0.iter().enumerate().skip(1).map(|(k, c)| c * Z::from(k)).collect())
    }
}

/// The greatest common divisor, 0 of none.
pub(super) fn gcd_of<'a>(values: impl Iterator<Item = &'a Z> + Clone, clock: &Clock) -> Result<Z, String> {
    // The shortest first: all others are reduced to its length by a division.
    let mut g = values.clone().filter(|v| !v.is_zero()).min_by_key(|v| v.bits()).map(Z::abs).unwrap_or_default();
    for v in values {
        if g.is_one() {
            break;
        }
        g = gcd_counted(&g, v, clock)?;
    }
    Ok(g)
}

/// The greatest common divisor, counted before it is computed: a division, then a subtraction for each bit of the shorter number.
pub(super) fn gcd_counted(a: &Z, b: &Z, clock: &Clock) -> Result<Z, String> {
    let (short, long) = (a.bits().min(b.bits()), a.bits().max(b.bits()));
    clock.spend(1, short, long)?;
    clock.spend(1, short.saturating_mul(64), short)?;
    Ok(gcd(a, b))
}

/// The greatest common divisor, not negative.
pub(super) fn gcd(a: &Z, b: &Z) -> Z {
    if a.is_zero() || b.is_zero() {
        return (a + b).abs();
    }
    // One division first: the binary algorithm takes off a bit at a time where one number is much longer.
    let (short, long) = if a.bits() <= b.bits() { (a.abs(), b) } else { (b.abs(), a) };
    let rest = (long % &short).abs();
    if rest.is_zero() {
        return short;
    }
    // Reducing a fraction is the greatest common divisor of num-integer, at the price of a division.
    let reduced = Q::new(rest, short.clone());
    short / reduced.denom()
}

/// The least positive integer that clears all denominators.
pub(super) fn common_denominator<'a>(values: impl Iterator<Item = &'a Q>) -> Z {
    values.fold(Z::one(), |l, v| &l / gcd(&l, v.denom()) * v.denom())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn uni(c: &[i64]) -> Uni {
        Uni::new(c.iter().map(|&c| Z::from(c)).collect())
    }

    #[test]
    fn division_and_gcd() {
        let clock = Clock::new(Duration::MAX);
        let (f, g) = (uni(&[-2, 2]), uni(&[1, 3, 2]));
        assert_eq!(f.times(&g).divided(&g, &clock).unwrap(), Some(uni(&[-1, 1])));
        assert_eq!(uni(&[1, 1]).divided(&uni(&[2, 1]), &clock).unwrap(), None);
        assert_eq!(f.times(&g).gcd(&g.times(&uni(&[5, 1])), &clock).unwrap(), g);
        assert_eq!(f.gcd(&Uni::default(), &clock).unwrap(), uni(&[-1, 1]));
    }
}
