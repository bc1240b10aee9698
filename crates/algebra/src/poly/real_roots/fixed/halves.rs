//! Both halves of the real axis, each as the unit interval and its reversal.

use super::super::bounds::positive_root_bound_bits;
use super::super::bracket::Bracket;
use super::super::sign_variations::descartes_sign_variations;
use super::piece::{Cell, Piece, binomial_row};
use super::refine::Half;
use super::search::{Found, first_precision, search};
use crate::number::Integer;
use crate::poly::UniPoly;
use std::rc::Rc;

/// Strictly disjoint brackets, ascending, of the roots of a square-free polynomial without rational
/// roots, refined to `2^-relative` of the root; of the positive ones only, unless `both`.
pub fn brackets(p: &UniPoly, both: bool, relative: u64) -> Vec<Bracket> {
    if p.is_constant() {
        return Vec::new();
    }
    let mut binomials = None;
    let mut out = Vec::new();
    if both {
        let mut negative = positive_brackets(p.negated_argument(), relative, &mut binomials);
        negative.reverse();
        out = negative;
        for b in &mut out {
            *b = Bracket { lo: -&b.hi, hi: -&b.lo, bits: b.bits, rising: !b.rising };
        }
    }
    out.append(&mut positive_brackets(p.clone(), relative, &mut binomials));
    out
}

fn positive_brackets(p: UniPoly, relative: u64, binomials: &mut Option<Rc<Vec<Integer>>>) -> Vec<Bracket> {
    let most = descartes_sign_variations(&p);
    if most == 0 {
        return Vec::new();
    }
    let bound = positive_root_bound_bits(&p).expect("the signs vary");
    let positive_at_infinity = !p.leading().expect("not zero").is_negative();
    let mut half = Half::new(p);
    let mut out = Vec::new();
    if most == 1 {
        // The only positive root.
        let (hi, bits) = power_of_two(bound);
        out.push(Bracket { lo: Integer::ZERO, hi, bits, rising: positive_at_infinity });
    } else {
        let n = half.coeffs.len() - 1;
        let row = Rc::clone(binomials.get_or_insert_with(|| Rc::new(binomial_row(n))));
        // Twos to the power of the mean logarithm of the roots: half of them are in the unit interval.
        let lengths = (half.coeffs[0].bit_length() as i64, half.coeffs[n].bit_length() as i64);
        let scale = (2 * (lengths.0 - lengths.1) + n as i64).div_euclid(2 * n as i64);
        let mut direct = Piece::new(Rc::clone(&half.coeffs), scale, Rc::clone(&row));
        let (first, first_reversed) = direct.bernstein_of_both(first_precision(most));
        for found in search(&mut direct, most, first) {
            out.push(direct_bracket(&found, scale));
        }
        let left = most - out.len().min(most);
        if left > 0 {
            let coeffs = half.coeffs.iter().rev().cloned().collect();
            let mut reversed = Piece::new(coeffs, -scale, row);
            for found in search(&mut reversed, left, first_reversed).iter().rev() {
                let bracket = reversed_bracket(found, scale, bound, positive_at_infinity, &mut half);
                out.push(bracket);
            }
        }
    }
    for b in &mut out {
        half.refine(b, relative);
    }
    separate(&mut half, &mut out);
    out
}

/// `2^exponent` as numerator and bits behind the point.
fn power_of_two(exponent: i64) -> (Integer, u64) {
    (&Integer::ONE << exponent.max(0) as u64, (-exponent).max(0) as u64)
}

/// `t / 2^bits 2^scale` for both ends.
fn direct_bracket(found: &Found, scale: i64) -> Bracket {
    let Cell { lo, bits, .. } = &found.cell;
    let exponent = scale - *bits as i64;
    let up = exponent.max(0) as u64;
    Bracket { lo: lo << up, hi: &found.cell.hi() << up, bits: (-exponent).max(0) as u64, rising: found.rising }
}

/// The bracket of `2^scale / t`: its ends are rounded inwards, where signs show that the root is
/// still between them.
fn reversed_bracket(found: &Found, scale: i64, bound: i64, at_infinity: bool, half: &mut Half) -> Bracket {
    let Cell { lo, bits, log_width } = &found.cell;
    let hi = found.cell.hi();
    // Towards the end of t the sign of the reversal is that of p; x falls when t grows.
    let positive_low = found.rising;
    let rising = !positive_low;
    // Enough bits to tell the ends apart.
    let mut extra = 2 * (bits - log_width.min(bits)) as i64 + 8;
    loop {
        // Units of 2^-fraction: x = 2^(scale + bits) / t.
        let fraction = (extra - scale).max(0) as u64;
        let shift = scale + *bits as i64 + fraction as i64;
        let rounded = |t: &Integer, up: bool| {
            let one = &Integer::ONE << shift.max(0) as u64;
            let t = t << (-shift).max(0) as u64;
            let (q, r) = one.div_mod_floor(&t);
            if up && !r.is_zero() { q + Integer::ONE } else { q }
        };
        let low = rounded(&hi, true);
        let high = if lo.is_zero() {
            let exponent = bound + fraction as i64;
            if exponent >= 0 { Some(&Integer::ONE << exponent as u64) } else { None }
        } else {
            Some(rounded(lo, false))
        };
        extra *= 2;
        let Some(high) = high else { continue };
        if low.is_zero() || low >= high {
            continue;
        }
        let high_right = if lo.is_zero() { at_infinity == rising } else { half.positive_at(&high, fraction) == rising };
        if high_right && half.positive_at(&low, fraction) == positive_low {
            return Bracket { lo: low, hi: high, bits: fraction, rising };
        }
    }
}

/// Refines neighbours, in ascending order, until there is a gap between them.
fn separate(half: &mut Half, brackets: &mut [Bracket]) {
    for i in 1..brackets.len() {
        loop {
            let (left, right) = brackets.split_at_mut(i);
            let (a, b) = (&mut left[i - 1], &mut right[0]);
            let bits = a.bits.max(b.bits);
            if (&a.hi << (bits - a.bits)) < (&b.lo << (bits - b.bits)) {
                break;
            }
            for x in [a, b] {
                let width = &x.hi - &x.lo;
                let now = x.bits as i64 - width.bit_length() as i64;
                let more = now.abs().max(8);
                half.narrow(x, now + more, more as u64 / 2);
            }
        }
    }
}
