//! Newton's method for a single root: in one machine word, then in as few limbs as the digits need.
//!
//! Nothing here is certain but the end: two signs certify the bracket, and whatever goes wrong before
//! only costs time.

use super::super::bracket::Bracket;
use super::evaluate::Evaluator;
use crate::number::Integer;

/// Below so many missing bits the first stage does not pay.
const LEAST_MISSING: u64 = 24;

/// Newton steps in one word, bisections included.
const MOST_STEPS: usize = 24;

/// A Newton step that gains fewer bits is left to the secant.
const LEAST_GAIN: i64 = 10;

/// Where Newton's method in one word ended.
struct Start {
    /// About the root times `2^64`.
    t: u64,
    /// The slope in the units of the word.
    slope: i64,
    /// Bits of the root that are right.
    bits: i64,
    /// Bits of the slope that are right.
    slope_bits: i64,
    /// Bits of the root below which values in one word are noise.
    noise_bits: i64,
}

/// Narrows a bracket of positive ends within the unit interval of the evaluator, `2^k` of its own, to
/// a width of at most `2^-target`. May leave it wider; never loses the root.
pub fn leap(evaluator: &mut Evaluator, k: i64, b: &mut Bracket, target: i64) {
    if b.bits_missing(target) < LEAST_MISSING {
        return;
    }
    let Ok(bits) = u64::try_from(target + 3) else { return };
    // Bits of the argument in the unit interval.
    let wanted = target + k;
    let Some(start) = in_one_word(evaluator, k, b) else { return };
    let gain = start.bits.min(start.slope_bits) - 3;
    if gain < LEAST_GAIN {
        return;
    }
    let limbs = |bits: i64| 1 + usize::try_from(bits + 6 - start.noise_bits).unwrap_or(0).div_ceil(64);
    let mut x = Integer::from(start.t);
    let mut x_bits = 64;
    let mut right = start.bits;
    while right < wanted + 2 {
        let next = (right + gain).min(wanted + 2);
        // Digits that are wrong cost time.
        let short = (right + 4).max(1);
        if short < x_bits {
            x = x >> (x_bits - short) as u64;
            x_bits = short;
        }
        let limbs = limbs(next).max(2);
        let value = evaluator.value(&x, x_bits as u64, limbs);
        // The value over the slope, in units of 2^-fine.
        let fine = next + 6;
        let shift = fine - 64 * (limbs as i64 - 1) - evaluator.word_extra();
        let value = Integer::from_twos_complement(&value.limbs);
        let value = if shift >= 0 { value << shift as u64 } else { value >> shift.unsigned_abs() };
        let step = value.div_mod_floor(&Integer::from(start.slope)).0;
        x = (x << (fine - x_bits) as u64) - step;
        x_bits = fine;
        right = next;
    }
    // A bracket of four units of 2^-(wanted + 3) around it.
    let fine = wanted + 3;
    let x = if x_bits >= fine { x >> (x_bits - fine) as u64 } else { x << (fine - x_bits) as u64 };
    let two = Integer::from(2);
    enclose(evaluator, k, b, (&x - &two, &x + &two), bits, limbs(wanted + 1).max(2));
}

/// Takes over those of two points, units of `2^-bits`, that lie in the bracket, as signs there allow.
fn enclose(evaluator: &mut Evaluator, k: i64, b: &mut Bracket, points: (Integer, Integer), bits: u64, limbs: usize) {
    if bits < b.bits {
        return;
    }
    let (lo, hi) = (&b.lo << (bits - b.bits), &b.hi << (bits - b.bits));
    let mut positive = |x: &Integer| evaluator.positive_from(x, (bits as i64 + k) as u64, limbs);
    // Whether the root is above the lower point, and below the upper one.
    let above = points.0 <= lo || (points.0 < hi && positive(&points.0) != b.rising);
    if !above {
        if points.0 < hi {
            (b.lo, b.hi, b.bits) = (lo, points.0, bits);
        }
        return;
    }
    let below = points.1 >= hi || (points.1 > lo && positive(&points.1) == b.rising);
    let lower = if points.0 > lo { points.0 } else { lo.clone() };
    if below {
        let upper = if points.1 < hi { points.1 } else { hi };
        (b.lo, b.hi, b.bits) = (lower, upper, bits);
    } else if points.1 > lo {
        (b.lo, b.hi, b.bits) = (points.1, hi, bits);
    }
}

fn in_one_word(evaluator: &mut Evaluator, k: i64, b: &Bracket) -> Option<Start> {
    let word = |x: &Integer| {
        let shift = 64 - (b.bits as i64 + k);
        let x = if shift >= 0 { x << shift as u64 } else { x >> shift.unsigned_abs() };
        x.limbs().first().copied().filter(|_| x.bit_length() <= 64).unwrap_or(u64::MAX)
    };
    let (mut lo, mut hi) = (word(&b.lo), word(&b.hi));
    let table = evaluator.word_table();
    // A step adds a unit for the coefficient and one for the product; the derivative takes that up again.
    let noise = 2 * table.len() as i64 + 2;
    let mut t = lo / 2 + hi / 2;
    let mut last = 0i64;
    for _ in 0..MOST_STEPS {
        let (value, slope) = value_and_slope(table, t);
        let uphill = (slope > 0) == b.rising;
        if value.abs() <= noise || (last >= 40 && uphill) {
            if !uphill {
                return None;
            }
            let size = bit_length(slope);
            let noise_bits = size - bit_length(noise) - 1;
            let slope_bits = size - bit_length(noise.saturating_mul(table.len() as i64));
            return Some(Start { t, slope, bits: noise_bits.min(62), slope_bits, noise_bits });
        }
        let above = (value > 0) == b.rising;
        if above {
            hi = t
        } else {
            lo = t
        }
        let newton = (slope != 0)
            .then(|| i128::from(t) - (i128::from(value) << 64) / i128::from(slope))
            .filter(|next| uphill && *next > i128::from(lo) && *next < i128::from(hi));
        let next = match newton {
            Some(next) => next as u64,
            None => lo / 2 + hi / 2,
        };
        last = if newton.is_some() { 64 - i64::from(64 - next.abs_diff(t).leading_zeros()) } else { 0 };
        if next == t || hi - lo < 4 {
            return None;
        }
        t = next;
    }
    None
}

fn bit_length(x: i64) -> i64 {
    i64::from(64 - x.unsigned_abs().leading_zeros())
}

/// The values of the polynomial and of its derivative at `t / 2^64`, in the units of the table.
fn value_and_slope(table: &[i64], t: u64) -> (i64, i64) {
    let times = |a: i64| ((i128::from(a) * i128::from(t)) >> 64) as i64;
    let (mut value, mut slope) = (0i64, 0i64);
    for c in table.iter().rev() {
        slope = times(slope) + value;
        value = times(value) + c;
    }
    (value, slope)
}
