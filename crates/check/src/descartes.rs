//! Descartes' rule of signs on an interval \[CollinsAkritas1976\]: in fixed point with bounds of the errors where that is much less work, and exactly.

use super::clock::Clock;
use super::number::{Q, Z};
use super::univariate::Uni;
use num_bigint::Sign;
use num_traits::{One, Signed, Zero};

/// From this degree on fixed point is tried first.
const LEAST_DEGREE: usize = 12;

/// Bits beyond those that the errors may take.
const GUARD: u64 = 128;

/// The sign of a polynomial at a number.
pub(super) type SignAt<'s> = dyn Fn(&Q) -> Result<Sign, String> + 's;

impl Uni {
    /// Descartes' bound for the open interval `(a, b)`, where `None` is an infinite end: at least the
    /// number of roots in it with multiplicity, and equal to it when it is 0 or 1. `None` when both
    /// ends are infinite and the polynomial is not constant.
    ///
    /// Cost: as many additions as the square of the degree, of numbers of some bits for each degree; of all digits of the coefficients, and of
    /// the ends for each degree, where the signs do not show.
    pub fn descartes(&self, a: Option<&Q>, b: Option<&Q>, clock: &Clock) -> Result<Option<usize>, String> {
        self.descartes_with((a, b), &|x| self.sign_at(x, clock), clock)
    }

    /// The same, asking for the signs at the ends, which may be known.
    pub fn descartes_with(
        &self,
        (a, b): (Option<&Q>, Option<&Q>),
        sign_at: &SignAt<'_>,
        clock: &Clock,
    ) -> Result<Option<usize>, String> {
        let d = self.degree() as u64;
        if d == 0 {
            return Ok(Some(0));
        }
        if a.is_none() && b.is_none() {
            return Ok(None);
        }
        if self.degree() >= LEAST_DEGREE {
            let of_end = |q: &Q| q.numer().bits() + q.denom().bits();
            let longest = self.0.iter().map(Z::bits).max().unwrap_or(0);
            let exact = longest + d * [a, b].into_iter().flatten().map(of_end).max().unwrap_or(0);
            for bits in [3 * d + GUARD, 6 * d + 4 * GUARD] {
                if 2 * bits < exact
                    && let Some(count) = self.rounded_variations((a, b), bits, sign_at, clock)?
                {
                    return Ok(Some(count));
                }
            }
        }
        self.exact_variations(a, b, clock)
    }

    fn exact_variations(&self, a: Option<&Q>, b: Option<&Q>, clock: &Clock) -> Result<Option<usize>, String> {
        let coefficients = match (a, b) {
            (None, None) => return Ok(None),
            // y > 0 in f(a + y)
            (Some(a), None) => self.along(a, &Q::one(), clock)?,
            // y > 0 in f(b - y)
            (None, Some(b)) => self.along(b, &-Q::one(), clock)?,
            // y > 0 in (1 + y)^d f(a + (b - a)/(1 + y))
            (Some(a), Some(b)) => {
                let mut c = self.along(a, &(b - a), clock)?;
                c.reverse();
                shift(&mut c, &Z::one(), clock)?;
                c
            }
        };
        let signs: Vec<Option<Sign>> = coefficients.iter().map(|c| Some(c.sign())).collect();
        Ok(variations(&signs))
    }

    /// Coefficients of a positive multiple of `f(a + w t)` in `t`, zeros at the top included.
    fn along(&self, a: &Q, w: &Q, clock: &Clock) -> Result<Vec<Z>, String> {
        // With a = A/D and w = W/D: D^d f((A + W t)/D) = sum f_k D^(d-k) (A + W t)^k.
        let d = a.denom() * w.denom();
        let big_a = a.numer() * w.denom();
        let big_w = w.numer() * a.denom();
        let bits = self.0.len() as u64 * (d.bits() + big_a.bits().max(big_w.bits()) + 1) + self.longest();
        clock.hold(self.0.len(), bits)?;
        clock.spend(2 * self.0.len(), bits, d.bits().max(big_w.bits()))?;
        let mut c = self.0.clone();
        let mut scale = Z::one();
        for coefficient in c.iter_mut().rev() {
            *coefficient *= &scale;
            scale *= &d;
        }
        shift(&mut c, &big_a, clock)?;
        let mut scale = Z::one();
        for coefficient in &mut c {
            *coefficient *= &scale;
            scale *= &big_w;
        }
        Ok(c)
    }

    /// The variations that the exact coefficients have, from enclosures of them of so many bits; `None` where these do not tell.
    ///
    /// About an end `e` that is not zero, the farther one from zero where there are two, with `x = e (1 + u)`: the shift by one takes additions
    /// only, and multiplies an error by a power of two at most. With `u = r t` for `t` from 0 to 1 the ratio `r` is at most 2, so that the
    /// second shift, by one again, begins with errors that have hardly grown.
    fn rounded_variations(
        &self,
        (a, b): (Option<&Q>, Option<&Q>),
        bits: u64,
        sign_at: &SignAt<'_>,
        clock: &Clock,
    ) -> Result<Option<usize>, String> {
        let (end, other) = match (a, b) {
            (Some(a), Some(b)) if a.abs() < b.abs() => (b, Some(a)),
            (Some(a), other) => (a, other),
            (None, Some(b)) => (b, None),
            (None, None) => return Ok(None),
        };
        if end.is_zero() {
            return Ok(None);
        }
        let n = self.0.len();
        let doubled = |error: &Z| error << n;
        let Some(Scaled { mut values, errors }) = scaled(&self.0, &Z::zero(), end, bits, clock)? else {
            return Ok(None);
        };
        shift_by_one(&mut values, bits, clock)?;
        let mut error = doubled(&largest(&errors));
        // The signs of the first and the last coefficient, which tell whether an end is a root.
        let known;
        if let Some(other) = other {
            // Not in lowest terms, which would cost more than it saves.
            let (n, d) = (end.numer() * other.denom(), other.numer() * end.denom() - end.numer() * other.denom());
            let ratio = if n.is_negative() { Q::new_raw(-d, -n) } else { Q::new_raw(d, n) };
            let Some(second) = scaled(&values, &error, &ratio, bits, clock)? else { return Ok(None) };
            values = second.values;
            values.reverse();
            shift_by_one(&mut values, bits, clock)?;
            error = doubled(&largest(&second.errors));
            known = [sign_at(other)?, sign_at(end)?];
        } else {
            // u = y/e to the right of a, -y/e to the left of b
            if a.is_some() != end.is_positive() {
                values.iter_mut().skip(1).step_by(2).for_each(|c| *c = -&*c);
            }
            let leading = self.leading().sign();
            let is_mirrored = a.is_none() && self.degree() % 2 == 1;
            known = [sign_at(end)?, if is_mirrored { -leading } else { leading }];
        }
        let sign = |c: &Z| (c.magnitude() > error.magnitude()).then(|| c.sign());
        let mut signs: Vec<Option<Sign>> = values.iter().map(sign).collect();
        [signs[0], signs[n - 1]] = known.map(Some);
        Ok(variations(&signs))
    }
}

/// The number of sign changes between successive signs, zeros left out; `None` where it depends on those that are not known.
fn variations(signs: &[Option<Sign>]) -> Option<usize> {
    let (mut last, mut count, mut unknown) = (Sign::NoSign, 0, 0);
    for sign in signs {
        match *sign {
            None => unknown += 1,
            Some(Sign::NoSign) => {}
            Some(sign) => {
                let is_change = last != Sign::NoSign && last != sign;
                // Whatever a single one is between two that differ, there is one change.
                if unknown > 1 || unknown == 1 && !is_change {
                    return None;
                }
                count += usize::from(is_change);
                (last, unknown) = (sign, 0);
            }
        }
    }
    (unknown == 0).then_some(count)
}

/// Numbers in a common unit, and how far they may be off.
struct Scaled {
    values: Vec<Z>,
    errors: Vec<Z>,
}

/// Positive multiples of `c_k q^k`, the multiple being the same for all, where the `c_k` are off by up to `error`: below `2^bits`, at least one of
/// them half of that. `None` if all are zero.
fn scaled(c: &[Z], error: &Z, q: &Q, bits: u64, clock: &Clock) -> Result<Option<Scaled>, String> {
    // Of 2 d roundings of powers each takes off one part in 2^(working - 1): together less than half a unit.
    let working = bits + 4 + u64::from(c.len().ilog2());
    let is_negative = q.is_negative();
    let (above, below) = (powers(q.numer(), c.len(), working, clock)?, powers(q.denom(), c.len(), working, clock)?);
    let mut terms = Vec::with_capacity(c.len());
    for (k, (x, (above, below))) in c.iter().zip(above.iter().zip(below.iter().rev())).enumerate() {
        clock.spend(2, working + x.bits(), working)?;
        let power = &above.0 * &below.0;
        let term = if is_negative && k % 2 == 1 { -x * &power } else { x * &power };
        terms.push((term, power, above.1 + below.1));
    }
    let top = terms.iter().filter(|(term, ..)| !term.is_zero()).map(|(term, _, e)| term.bits() + e).max();
    let Some(top) = top else { return Ok(None) };
    let in_units = |x: &Z, e: u64| match (e + bits).checked_sub(top) {
        Some(up) => x << up,
        None => x >> (top - e - bits),
    };
    let off = Z::from(4);
    Ok(Some(Scaled {
        values: terms.iter().map(|(term, _, e)| in_units(term, *e)).collect(),
        errors: terms.iter().map(|(_, power, e)| in_units(&(error * power), *e) + &off).collect(),
    }))
}

/// Powers of the modulus of a number from the zeroth on, as `m 2^e` with `m` of at most so many bits, rounded down.
fn powers(base: &Z, count: usize, bits: u64, clock: &Clock) -> Result<Vec<(Z, u64)>, String> {
    let base = base.abs();
    let mut out = vec![(Z::one(), 0)];
    while out.len() < count {
        let (m, e) = &out[out.len() - 1];
        clock.spend(1, m.bits(), base.bits())?;
        let next = m * &base;
        let down = next.bits().saturating_sub(bits);
        out.push((next >> down, e + down));
    }
    Ok(out)
}

fn largest(values: &[Z]) -> Z {
    values.iter().max().cloned().unwrap_or_default()
}

/// `f(t + a)` by repeated synthetic division.
fn shift(c: &mut [Z], a: &Z, clock: &Clock) -> Result<(), String> {
    if a.is_zero() {
        return Ok(());
    }
    let n = c.len();
    for i in 0..n {
        let longest = c[i..].iter().map(Z::bits).max().unwrap_or(0);
        clock.spend(n - i, longest, a.bits())?;
        for j in (i..n - 1).rev() {
            let (lower, upper) = c.split_at_mut(j + 1);
            if a.is_one() {
                lower[j] += &upper[0];
            } else {
                lower[j] += &upper[0] * a;
            }
        }
    }
    Ok(())
}

/// `f(t + 1)` where no coefficient of `f` is longer than so many bits: additions in two's complement, all numbers of one length.
fn shift_by_one(c: &mut [Z], bits: u64, clock: &Clock) -> Result<(), String> {
    let n = c.len();
    // A coefficient of the result is a sum of binomial coefficients times those before, below 2^n together; one bit is the sign.
    let words = ((bits + n as u64 + 1) / 64 + 1) as usize;
    let mut all = Vec::with_capacity(n * words);
    for x in c.iter() {
        let fill = if x.is_negative() { u64::MAX } else { 0 };
        let low = x.magnitude().iter_u64_digits();
        // -x = !(x - 1)
        let mut borrow = x.is_negative();
        all.extend(low.chain(std::iter::repeat(0)).take(words).map(|word| {
            let (less, over) = word.overflowing_sub(u64::from(borrow));
            borrow = over;
            less ^ fill
        }));
    }
    for i in 0..n {
        clock.spend(n - i, bits, 0)?;
        for j in (i..n - 1).rev() {
            let (lower, upper) = all[j * words..(j + 2) * words].split_at_mut(words);
            let mut carry = false;
            for (x, y) in lower.iter_mut().zip(upper) {
                let (sum, first) = x.overflowing_add(*y);
                let (sum, second) = sum.overflowing_add(u64::from(carry));
                (*x, carry) = (sum, first | second);
            }
        }
    }
    for (x, words) in c.iter_mut().zip(all.chunks(words)) {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        *x = Z::from_signed_bytes_le(&bytes);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn rounded(f: &Uni, a: Option<&Q>, b: Option<&Q>, bits: u64, clock: &Clock) -> Result<Option<usize>, String> {
        f.rounded_variations((a, b), bits, &|x| f.sign_at(x, clock), clock)
    }

    fn uni(c: &[i64]) -> Uni {
        Uni::new(c.iter().map(|&c| Z::from(c)).collect())
    }

    fn q(n: i64, d: i64) -> Q {
        Q::new(n.into(), d.into())
    }

    #[test]
    fn descartes_counts_roots_in_open_intervals() {
        let clock = Clock::new(Duration::MAX);
        let f = uni(&[-6, 11, -6, 1]); // 1, 2, 3
        let count = |a: Option<Q>, b: Option<Q>| f.descartes(a.as_ref(), b.as_ref(), &clock).unwrap();
        assert_eq!(count(Some(q(1, 2)), Some(q(3, 2))), Some(1));
        assert_eq!(count(Some(q(1, 1)), Some(q(2, 1))), Some(0));
        assert_eq!(count(Some(q(1, 1)), Some(q(3, 1))), Some(1));
        assert_eq!(count(Some(q(3, 1)), None), Some(0));
        assert_eq!(count(Some(q(5, 2)), None), Some(1));
        assert_eq!(count(None, Some(q(1, 1))), Some(0));
        assert_eq!(count(None, Some(q(4, 3))), Some(1));
        assert_eq!(count(None, None), None);
        assert_eq!(uni(&[7]).descartes(None, None, &clock).unwrap(), Some(0));
    }

    /// Numbers that look random, below a bound.
    struct Draw(u64);

    impl Draw {
        fn below(&mut self, bound: u64) -> i64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 33) % bound) as i64
        }

        /// A root, or an end of an interval, on either side of zero.
        fn number(&mut self) -> Q {
            let scale = [1, 7, 1_000, 1_000_003][self.below(4) as usize];
            q(self.below(41) - 20, scale)
        }
    }

    /// Few and many bits, ends at roots, roots at zero and beside each other: what fixed point says is what the exact coefficients have, and it says
    /// something nearly always where bits are not spared.
    #[test]
    fn rounded_signs_are_the_exact_ones() {
        let (clock, mut draw) = (Clock::new(Duration::MAX), Draw(20_020_326));
        let (mut told, mut asked) = (0, 0);
        for _ in 0..150 {
            let mut f = uni(&[1 + draw.below(9)]);
            for _ in 0..1 + draw.below(14) {
                let root = draw.number();
                let linear = Uni::new(vec![-root.numer().clone(), root.denom().clone()]);
                // Pairs that are all but real, too.
                let near = linear.times(&linear).scaled(&(Z::one() << 40)).plus(&uni(&[1]));
                f = f.times(if draw.below(4) == 0 { &near } else { &linear });
            }
            let (a, b) = (draw.number(), draw.number());
            let (a, b) = (a.clone().min(b.clone()), a.max(b));
            for (a, b) in [(Some(&a), Some(&b)), (Some(&a), None), (None, Some(&b))] {
                if a == b {
                    continue;
                }
                let exact = f.exact_variations(a, b, &clock).unwrap();
                for bits in [8, 2 * f.degree() as u64 + 4, 2 * f.degree() as u64 + 5 * GUARD] {
                    let rounded = rounded(&f, a, b, bits, &clock).unwrap();
                    assert!(rounded.is_none() || rounded == exact, "{f:?} on {a:?} {b:?}: {rounded:?}, not {exact:?}");
                    let is_wide = bits > 5 * GUARD && a.or(b).is_some_and(|end| !end.is_zero());
                    told += usize::from(is_wide && rounded.is_some());
                    asked += usize::from(is_wide);
                }
            }
        }
        assert!(told * 10 > asked * 9, "{told} of {asked}");
    }

    /// Chebyshev's polynomial of degree 200, whose roots are cosines: by its recurrence. In fixed point, as the exact one has thousands of bits.
    #[test]
    fn long_polynomials_are_decided_in_fixed_point() {
        let clock = Clock::new(Duration::MAX);
        let (mut f, mut g) = (uni(&[1]), uni(&[0, 1]));
        for _ in 1..200 {
            let next = g.shifted_up(1).scaled(&Z::from(2)).minus(&f);
            (f, g) = (g, next);
        }
        // cos(pi (2 k - 1)/400) for k = 1, 2, 3: 0.99996..., 0.99972..., 0.99923...
        let bits = 3 * 200 + GUARD;
        for (a, b, roots) in
            [((99_970, 99_973), 1), ((99_980, 99_990), 0), ((99_922, 99_924), 1)].map(|((a, b), n)| (a, b, n))
        {
            let (a, b) = (q(a, 100_000), q(b, 100_000));
            assert_eq!(rounded(&g, Some(&a), Some(&b), bits, &clock).unwrap(), Some(roots));
            assert_eq!(g.descartes(Some(&a), Some(&b), &clock).unwrap(), Some(roots));
        }
        assert_eq!(rounded(&g, Some(&q(1, 1)), None, bits, &clock).unwrap(), Some(0));
        assert_eq!(rounded(&g, None, Some(&q(-1, 1)), bits, &clock).unwrap(), Some(0));
        assert_eq!(rounded(&g, None, Some(&q(-99_990, 100_000)), bits, &clock).unwrap(), Some(1));
    }

    #[test]
    fn signs_that_are_not_known_do_not_count() {
        let of = |text: &str| {
            let sign = |c: char| match c {
                '+' => Some(Sign::Plus),
                '-' => Some(Sign::Minus),
                '0' => Some(Sign::NoSign),
                _ => None,
            };
            variations(&text.chars().map(sign).collect::<Vec<_>>())
        };
        for (signs, count) in
            [("+?-", Some(1)), ("+0?-+", Some(2)), ("+-0-", Some(1)), ("000", Some(0)), ("-", Some(0))]
        {
            assert_eq!(of(signs), count, "{signs}");
        }
        for signs in ["+?+", "?-", "-?", "+??-", "0?-", "+?0?-"] {
            assert_eq!(of(signs), None, "{signs}");
        }
    }
}
