//! Cosine and sine of many angles.

use crate::moving;
use crate::number::{Q, Z};
use crate::taylor::Precision;
use num_traits::{Euclid, One, ToPrimitive, Zero};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Bits beside those that are asked for.
const GUARD: usize = 32;

/// An angle has no more quarters: what is off in one is off so many times.
const MOST_QUARTERS: u32 = 1 << 16;

/// Most angles come again: for the boxes beside, and those around.
const MOST_KNOWN: usize = 1 << 14;

/// In units of `2^-bits`, off by less than two of them.
pub(super) struct Turns {
    bits: usize,
    /// A quarter of a turn, in units of `2^-(bits + GUARD)`.
    quarter: Z,
    known: RefCell<BTreeMap<Z, [Z; 2]>>,
}

impl Turns {
    pub fn new(bits: usize) -> Self {
        let pi = moving::pi(&Precision::new(0, 1, bits + GUARD)).constant();
        Turns { bits, quarter: pi >> 1, known: RefCell::default() }
    }

    /// Cosine and sine of a time, not negative, and a frequency in units of `2^-frequency_bits`; `None` for angles that are too large.
    pub fn of(&self, time: &Q, frequency: &Z, frequency_bits: usize) -> Option<[Z; 2]> {
        let angle = ((time.numer() * frequency) << (self.bits + GUARD)).div_euclid(&(time.denom() << frequency_bits));
        if let Some(found) = self.known.borrow().get(&angle) {
            return Some(found.clone());
        }
        let (quarters, rest) = (angle.div_euclid(&self.quarter), angle.rem_euclid(&self.quarter));
        let quarters = quarters.to_u32().filter(|k| *k < MOST_QUARTERS)?;
        let [c, s] = self.series(&rest).map(|x| x >> GUARD);
        let found = match quarters % 4 {
            0 => [c, s],
            1 => [-s, c],
            2 => [-c, -s],
            _ => [s, -c],
        };
        let mut known = self.known.borrow_mut();
        if known.len() >= MOST_KNOWN {
            known.clear();
        }
        known.insert(angle, found.clone());
        Some(found)
    }

    /// Both series together, term by term, up to an angle that is less than two: the terms fall by more than a half from the third on.
    fn series(&self, angle: &Z) -> [Z; 2] {
        let bits = self.bits + GUARD;
        let (mut sums, mut term, mut k) = ([Z::zero(), Z::zero()], Z::one() << bits, 0_usize);
        while !term.is_zero() {
            match k % 4 {
                0 | 1 => sums[k % 2] += &term,
                _ => sums[k % 2] -= &term,
            }
            k += 1;
            term = ((term * angle) >> bits) / Z::from(k);
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_those_of_the_machine() {
        let turns = Turns::new(80);
        for k in 0..2000_i64 {
            let (time, frequency) = (Q::new((k * 7919 % 1000).into(), 37.into()), Z::from(k) << 30);
            let [c, s] = turns.of(&time, &frequency, 34).unwrap();
            let angle = (k * 7919 % 1000) as f64 / 37.0 * k as f64 / 16.0;
            let unit = 2f64.powi(-80);
            // What the machine's own angle is off by.
            let off = 1e-15 * (angle + 10.0);
            assert!((c.to_f64().unwrap() * unit - angle.cos()).abs() < off, "{k}");
            assert!((s.to_f64().unwrap() * unit - angle.sin()).abs() < off, "{k}");
            // More digits than the machine has: the sum of the squares.
            let off: Z = ((&c * &c + &s * &s) >> 80) - (Z::one() << 80);
            assert!(off > Z::from(-8) && off < Z::from(8), "{k}");
        }
        assert_eq!(turns.of(&Q::from(Z::from(200_000)), &(Z::one() << 34), 34), None);
    }
}
