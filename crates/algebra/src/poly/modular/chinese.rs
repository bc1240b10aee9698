//! From integers to residues modulo several primes, and back.

use super::prime_field::{PrimeField, largest_primes, primes_for_bits};
use crate::limits::{checkpoint, parallel_map};
use crate::number::Integer;
use std::sync::{Arc, Mutex, PoisonError};

/// Signed integers as limbs, laid out to be reduced modulo many primes.
pub struct Limbs {
    limbs: Vec<u64>,
    /// For each integer where its limbs end, and whether it is negative.
    ends: Vec<(usize, bool)>,
    longest: usize,
}

impl Limbs {
    /// Takes integers apart.
    pub fn new<'a>(integers: impl IntoIterator<Item = &'a Integer>) -> Limbs {
        let mut out = Limbs { limbs: Vec::new(), ends: Vec::new(), longest: 0 };
        for c in integers {
            let before = out.limbs.len();
            match c.to_i64() {
                Some(0) => {}
                Some(small) => out.limbs.push(small.unsigned_abs()),
                None => out.limbs.extend(c.limbs()),
            }
            out.longest = out.longest.max(out.limbs.len() - before);
            out.ends.push((out.limbs.len(), c.is_negative()));
        }
        out
    }

    /// The residues of the integers, in the form of the field.
    pub fn residues(&self, f: &PrimeField) -> Vec<u64> {
        checkpoint((self.limbs.len() / 2 + self.ends.len()) as u64);
        // The forms of 2^64, 2^128, ..., one place ahead because the reduction divides by 2^64.
        let mut place = f.residue(f.one());
        let mut places = Vec::with_capacity(self.longest);
        let shift = place;
        for _ in 0..self.longest {
            places.push(place);
            place = f.mul(place, shift);
        }
        let mut start = 0;
        let residue = |&(end, negative): &(usize, bool)| {
            let limbs = &self.limbs[start..end];
            start = end;
            let value = match limbs {
                [] => 0,
                &[limb] => f.residue(limb),
                _ => limbs
                    .iter()
                    .zip(&places)
                    .fold(0, |sum, (&limb, &place)| f.add(sum, f.reduce(u128::from(limb) * u128::from(place)))),
            };
            if negative { f.negated(value) } else { value }
        };
        self.ends.iter().map(residue).collect()
    }
}

/// Primes whose product determines every integer of a known size, and what is needed to find it.
pub struct Chinese {
    tables: Arc<Tables>,
    count: usize,
    /// Half the product of the primes, rounded down.
    half: Vec<u64>,
}

/// What belongs to a sequence of primes; any beginning of it can be used.
struct Tables {
    fields: Vec<PrimeField>,
    /// For each prime the products of the earlier ones modulo it: 1, p_0, p_0 p_1, ...
    places: Vec<Vec<u64>>,
    /// For each prime the inverse of the product of the earlier ones.
    inverses: Vec<u64>,
    /// The products of the earlier primes as limbs; the last is that of all.
    products: Vec<Vec<u64>>,
}

/// The tables of up to this many primes are kept for the life of the process: about 300 kB.
const KEPT_PRIMES: usize = 128;

impl Tables {
    fn new(fields: Vec<PrimeField>) -> Tables {
        let mut places = Vec::with_capacity(fields.len());
        let mut inverses = Vec::with_capacity(fields.len());
        let mut products = vec![vec![1u64]];
        for (k, f) in fields.iter().enumerate() {
            checkpoint(k as u64 + 20);
            let mut place = f.one();
            let mut row = Vec::with_capacity(k);
            for earlier in &fields[..k] {
                row.push(place);
                place = f.mul(place, f.residue(earlier.prime()));
            }
            places.push(row);
            inverses.push(f.inverse(place));
            let mut product = products[k].clone();
            multiply_by_word(&mut product, f.prime());
            products.push(product);
        }
        Tables { fields, places, inverses, products }
    }

    /// For at least `count` of the largest primes.
    fn of_largest(count: usize) -> Arc<Tables> {
        static KEPT: Mutex<Option<Arc<Tables>>> = Mutex::new(None);
        if count > KEPT_PRIMES {
            return Arc::new(Tables::new(largest_primes(count)));
        }
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        match &*kept {
            Some(tables) if tables.fields.len() >= count => Arc::clone(tables),
            _ => {
                let enough = count.next_power_of_two().max(8);
                Arc::clone(kept.insert(Arc::new(Tables::new(largest_primes(enough)))))
            }
        }
    }
}

impl Chinese {
    /// For integers of magnitude below `2^bits`.
    pub fn for_bits(bits: u64) -> Chinese {
        // One bit for the sign.
        let count = primes_for_bits(bits + 1);
        Chinese::beginning(Tables::of_largest(count), count)
    }

    /// For distinct primes.
    pub fn new(fields: Vec<PrimeField>) -> Chinese {
        let count = fields.len();
        Chinese::beginning(Arc::new(Tables::new(fields)), count)
    }

    fn beginning(tables: Arc<Tables>, count: usize) -> Chinese {
        let mut half = tables.products[count].clone();
        let mut carry = 0;
        for limb in half.iter_mut().rev() {
            (*limb, carry) = ((*limb >> 1) | (carry << 63), *limb & 1);
        }
        Chinese { tables, count, half }
    }

    /// The primes.
    pub fn fields(&self) -> &[PrimeField] {
        &self.tables.fields[..self.count]
    }

    /// The images under `f` for each prime in their order, on several threads if `parallel`.
    pub fn images<T: Send>(&self, parallel: bool, f: impl Fn(&PrimeField) -> T + Send + Sync) -> Vec<T> {
        // With one thread there is nobody to hand work to.
        if parallel && self.count > 1 && rayon::current_num_threads() > 1 {
            parallel_map(self.fields(), f)
        } else {
            self.fields().iter().map(f).collect()
        }
    }

    /// The integer of magnitude below half the product of the primes with the given residues, which
    /// are in the form of the field of each prime ([Garner1959](crate::bibliography#garner1959)).
    ///
    /// # Panics
    /// When there are not as many residues as primes.
    pub fn integer(&self, residues: impl IntoIterator<Item = u64>) -> Integer {
        let Tables { places, inverses, products, .. } = &*self.tables;
        checkpoint((self.count * self.count / 8 + 1) as u64);
        let mut digits = Vec::with_capacity(self.count);
        for (((f, row), &inverse), x) in self.fields().iter().zip(places).zip(inverses).zip(residues) {
            // The digits are plain integers, the places forms: the sum is a plain residue.
            let known = f.dot(&digits, row);
            digits.push(f.mul(f.sub(f.integer(x), known), inverse));
        }
        assert_eq!(digits.len(), self.count, "a residue for each prime");
        let used = digits.iter().rposition(|&d| d != 0).map_or(0, |last| last + 1);
        let product = &products[self.count];
        let mut value = vec![0u64; product.len()];
        for (&digit, place) in digits[..used].iter().zip(products) {
            add_product(&mut value, place, digit);
        }
        if value.iter().rev().le(self.half.iter().rev()) {
            return Integer::from_limbs(value);
        }
        let mut borrow = false;
        for (x, &p) in value.iter_mut().zip(product) {
            let (d, first) = p.overflowing_sub(*x);
            let (d, second) = d.overflowing_sub(u64::from(borrow));
            (*x, borrow) = (d, first || second);
        }
        -Integer::from_limbs(value)
    }
}

fn multiply_by_word(x: &mut Vec<u64>, word: u64) {
    let mut carry = 0u64;
    for limb in x.iter_mut() {
        let t = u128::from(*limb) * u128::from(word) + u128::from(carry);
        (*limb, carry) = (t as u64, (t >> 64) as u64);
    }
    if carry > 0 {
        x.push(carry);
    }
}

/// `value += x word`; the sum is known to fit.
fn add_product(value: &mut [u64], x: &[u64], word: u64) {
    let mut carry = 0u64;
    let (low, high) = value.split_at_mut(x.len());
    for (v, &limb) in low.iter_mut().zip(x) {
        let t = u128::from(limb) * u128::from(word) + u128::from(*v) + u128::from(carry);
        (*v, carry) = (t as u64, (t >> 64) as u64);
    }
    for v in high {
        if carry == 0 {
            break;
        }
        let (sum, over) = v.overflowing_add(carry);
        (*v, carry) = (sum, u64::from(over));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for bits in [0u64, 1, 61, 62, 63, 64, 123, 124, 125, 300, 1661] {
            let top = &(&Integer::ONE << bits) - &Integer::ONE;
            let values = [Integer::ZERO, Integer::ONE, top.clone(), &top >> 1, &(&top >> (bits / 2)) << (bits / 2)];
            let chinese = Chinese::for_bits(bits);
            for value in values.iter().filter(|v| v.bit_length() <= bits).flat_map(|v| [v.clone(), -v]) {
                let residues: Vec<u64> = chinese.fields().iter().map(|f| Limbs::new([&value]).residues(f)[0]).collect();
                for (f, &r) in chinese.fields().iter().zip(&residues) {
                    assert_eq!(f.integer(r), value.mod_u64(f.prime()));
                }
                assert_eq!(chinese.integer(residues), value, "{bits} bits");
            }
        }
    }

    #[test]
    fn small_primes_cover_exactly_their_range() {
        let chinese = Chinese::new([3, 5, 7].map(|p| PrimeField::new(p).unwrap()).to_vec());
        for n in -52i64..=52 {
            let value = Integer::from(n);
            let residues = chinese.fields().iter().map(|f| Limbs::new([&value]).residues(f)[0]);
            assert_eq!(chinese.integer(residues.collect::<Vec<_>>()), value);
        }
    }
}
