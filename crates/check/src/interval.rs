//! Intervals with ends in fixed point, and exponentials of matrices in them. All rounding is outward.

use super::clock::Clock;
use super::number::{Q, Z};
use num_bigint::Sign;
use num_traits::{Euclid, One, Signed, Zero};

/// `lo <= x 2^bits <= hi`, where `bits` is known from the context.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Interval {
    pub lo: Z,
    pub hi: Z,
}

fn up(x: Z, bits: usize) -> Z {
    -((-x) >> bits)
}

/// The quotient by a positive divisor, rounded down. A rational number would cost a common divisor.
fn floor(x: &Z, divisor: &Z) -> Z {
    x.div_euclid(divisor)
}

impl Interval {
    pub fn zero() -> Self {
        Interval { lo: Z::zero(), hi: Z::zero() }
    }

    pub fn integer(n: &Z, bits: usize) -> Self {
        let n = n << bits;
        Interval { lo: n.clone(), hi: n }
    }

    pub fn rational(q: &Q, bits: usize) -> Self {
        Interval { lo: q.numer() << bits, hi: q.numer() << bits }.over(q.denom())
    }

    pub fn plus(&self, other: &Self) -> Self {
        Interval { lo: &self.lo + &other.lo, hi: &self.hi + &other.hi }
    }

    pub fn negated(&self) -> Self {
        Interval { lo: -&self.hi, hi: -&self.lo }
    }

    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    /// Times an integer, exactly.
    pub fn scaled(&self, n: &Z) -> Self {
        let (a, b) = (&self.lo * n, &self.hi * n);
        if n.is_negative() { Interval { lo: b, hi: a } } else { Interval { lo: a, hi: b } }
    }

    /// The product with twice the bits.
    fn full(&self, other: &Self) -> Self {
        let all = [&self.lo * &other.lo, &self.lo * &other.hi, &self.hi * &other.lo, &self.hi * &other.hi];
        let lo = all.iter().min().cloned().unwrap_or_default();
        let hi = all.iter().max().cloned().unwrap_or_default();
        Interval { lo, hi }
    }

    pub fn times(&self, other: &Self, bits: usize) -> Self {
        self.full(other).narrowed(bits)
    }

    /// With so many bits less.
    pub fn narrowed(&self, bits: usize) -> Self {
        Interval { lo: &self.lo >> bits, hi: up(self.hi.clone(), bits) }
    }

    /// With so many bits more, exactly; the number is times a power of two if the context's bits stay.
    fn widened(&self, bits: usize) -> Self {
        Interval { lo: &self.lo << bits, hi: &self.hi << bits }
    }

    /// The quotient; `None` where the divisor may be zero.
    pub fn divided(&self, other: &Self, bits: usize) -> Option<Self> {
        if other.hi.is_negative() {
            return self.negated().divided(&other.negated(), bits);
        }
        if !other.lo.is_positive() {
            return None;
        }
        let ends = |x: &Z| [floor(&(x << bits), &other.lo), floor(&(x << bits), &other.hi)];
        let below = ends(&self.lo).into_iter().min()?;
        let above = ends(&-&self.hi).into_iter().min()?;
        Some(Interval { lo: below, hi: -above })
    }

    /// Divided by a positive integer.
    pub fn over(&self, n: &Z) -> Self {
        Interval { lo: floor(&self.lo, n), hi: -floor(&-&self.hi, n) }
    }

    /// The sign, if all numbers in it have one.
    pub fn sign(&self) -> Option<Sign> {
        let (lo, hi) = (self.lo.sign(), self.hi.sign());
        if lo == hi { Some(lo) } else { None }
    }

    pub fn contains_zero(&self) -> bool {
        !self.lo.is_positive() && !self.hi.is_negative()
    }

    pub fn magnitude(&self) -> Z {
        self.lo.abs().max(self.hi.abs())
    }
}

/// All of them times one power of two, so that the longest has `bits` bits: products of them neither vanish nor grow.
pub(super) fn balanced(numbers: &mut [Interval], bits: usize) {
    let longest = numbers.iter().map(|x| x.magnitude().bits() as usize).max().unwrap_or(0);
    for x in numbers.iter_mut() {
        *x = if longest > bits { x.narrowed(longest - bits) } else { x.widened(bits - longest) };
    }
}

type Matrix = Vec<Vec<Interval>>;

fn product(a: &Matrix, b: &Matrix, bits: usize, clock: &Clock) -> Result<Matrix, String> {
    let n = a.len();
    // Large arguments make long numbers.
    let [of_a, of_b] = [a, b].map(|m| m.iter().flatten().map(|x| x.lo.bits().max(x.hi.bits())).max().unwrap_or(0));
    clock.hold(2 * n * n, of_a + of_b)?;
    clock.spend(n * n * n, of_a.max(bits as u64), of_b.max(bits as u64))?;
    let entry = |i: usize, j: usize| (0..n).fold(Interval::zero(), |sum, k| sum.plus(&a[i][k].full(&b[k][j])));
    Ok((0..n).map(|i| (0..n).map(|j| entry(i, j).narrowed(bits)).collect()).collect())
}

/// The first row of `exp(companion t)` for a monic polynomial, its coefficients from the constant term up without the leading
/// one: the solutions of its differential equation with the derivatives of the unit matrix at 0.
pub(super) fn solutions(monic: &[Q], t: &Q, bits: usize, clock: &Clock) -> Result<Vec<Interval>, String> {
    let mut working = bits + 64;
    loop {
        let row = attempt(monic, t, working, clock)?;
        let row: Vec<Interval> = row.iter().map(|x| x.narrowed(working - bits)).collect();
        if row.iter().all(|x| &x.hi - &x.lo <= Z::from(4)) {
            return Ok(row);
        }
        if working > 64 * (bits + 64) {
            return Err("a symbol is too large to be enclosed".into());
        }
        working *= 2;
    }
}

/// The same with a number of bits: Taylor's polynomial of `exp(M/2^s)`, where the sums of the rows of `|M|/2^s` are at most
/// 1/4, then `s` squarings. The remainder after the term of order `k` is at most twice the first term left out.
fn attempt(monic: &[Q], t: &Q, bits: usize, clock: &Clock) -> Result<Vec<Interval>, String> {
    let d = monic.len();
    let mut norm = Q::zero();
    let mut m = vec![vec![Q::zero(); d]; d];
    for i in 0..d {
        if i + 1 < d {
            m[i][i + 1] = t.clone();
        } else {
            m[i] = monic.iter().map(|c| -(c * t)).collect();
        }
        norm = norm.max(m[i].iter().fold(Q::zero(), |sum, x| sum + x.abs()));
    }
    let quarter = Q::new(Z::one(), Z::from(4));
    let mut halvings = 0_usize;
    while norm > quarter {
        norm /= Q::from(Z::from(2));
        halvings += 1;
        if halvings > 4096 {
            return Err("a symbol is too large to be enclosed".into());
        }
    }
    let scale = Q::new(Z::one(), Z::one() << halvings);
    let m: Matrix = m.iter().map(|row| row.iter().map(|x| Interval::rational(&(x * &scale), bits)).collect()).collect();
    let one = Interval::integer(&Z::one(), bits);
    let mut sum: Matrix =
        (0..d).map(|i| (0..d).map(|j| if i == j { one.clone() } else { Interval::zero() }).collect()).collect();
    let mut term = sum.clone();
    let mut k = 0_usize;
    // Row sums of |M| are at most 1/least, those of |M^k|/k! at most 1/(least^k k!): few terms where M is small.
    let least = if norm.is_zero() { Z::one() << bits } else { norm.recip().floor().to_integer() };
    let (mut bound, unit) = (Z::one(), Z::one() << bits);
    while bound <= unit {
        k += 1;
        let divisor = Z::from(k);
        bound *= &least * &divisor;
        term = product(&term, &m, bits, clock)?;
        term.iter_mut().flatten().for_each(|x| *x = x.over(&divisor));
        for (row, more) in sum.iter_mut().zip(&term) {
            for (x, y) in row.iter_mut().zip(more) {
                *x = x.plus(y);
            }
        }
    }
    // What is left out: at most twice one over the bound, which is less than a unit.
    for x in sum.iter_mut().flatten() {
        x.lo -= 2;
        x.hi += 2;
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum, bits, clock)?;
    }
    Ok(sum.swap_remove(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn q(n: i64, d: i64) -> Q {
        Q::new(n.into(), d.into())
    }

    fn encloses(x: &Interval, digits: &str) {
        let (whole, fraction) = digits.split_once('.').unwrap();
        let below: Z = format!("{whole}{fraction}").parse().unwrap();
        let unit = Z::from(10).pow(fraction.len() as u32);
        let (lo, hi) = (Q::new(below.clone(), unit.clone()), Q::new(below + 1, unit));
        let bits = Q::from(Z::one() << 128_usize);
        assert!(Q::from(x.hi.clone()) / &bits >= lo && Q::from(x.lo.clone()) / &bits <= hi, "{digits}");
        assert!(&x.hi - &x.lo <= Z::from(4));
    }

    /// e, exp(-1000/3), cos 10, sin 10, cosh 2, and a solution of `y''' = y`.
    #[test]
    fn solutions_have_known_digits() {
        let clock = Clock::new(Duration::MAX);
        let at = |f: &[Q], t: Q, k: usize| solutions(f, &t, 128, &clock).unwrap().swap_remove(k);
        encloses(&at(&[q(-1, 1)], q(1, 1), 0), "2.71828182845904523536028747135266249775");
        encloses(&at(&[q(1, 1)], q(1, 2), 0), "0.60653065971263342360379953499118045344");
        encloses(&at(&[q(0, 1), q(-1, 1)], q(2, 1), 0), "1.00000000000000000000000000000000000000");
        encloses(&at(&[q(-1, 1), q(0, 1)], q(2, 1), 0), "3.76219569108363145956221347777374610829");
        encloses(&at(&[q(100, 1), q(0, 1)], q(1, 10), 0), "0.54030230586813971740093660744297660373");
        encloses(&at(&[q(100, 1), q(0, 1)], q(1, 10), 1), "0.08414709848078965066525023216302989996");
    }
}
