//! Resultants of low degree as determinants, expanded by minors: numbers are a few machine words, modulo a power of two
//! above a bound of the result.

use super::resultant::DensePair;
use crate::limits::{checkpoint, claim};
use crate::number::Integer;

/// Beyond this degree there are too many minors.
const MOST_DEGREE: usize = 6;

/// There is code for numbers of so many words.
const MOST_WORDS: usize = 8;

/// Beyond so many coefficients of the resultant their products take too long.
const MOST_PLACES: usize = 1 << 16;

/// The time of a point modulo a prime beside a fraction of that of a product of single words (`words^2 + 4` for one of numbers of
/// many), and how it grows with the product of the degrees: 60 ns and 8 ns against 0.09 ns. Drive with 0 to 4 filters in two
/// parameters: 7.9, 13.8, 52, 162 and 682 us by minors, 46, 87, 146, 256 and 490 us modulo primes.
const PRODUCTS_PER_POINT: u64 = 660;
const PRODUCTS_PER_STEP: u64 = 88;

/// A sparse polynomial: places in the array of the resultant, ascending, and two's complement coefficients modulo `2^(64 L)`.
#[derive(Clone)]
struct Terms<const L: usize> {
    terms: Vec<(usize, [u64; L])>,
    /// Whether all coefficients are at most `2^62` in magnitude.
    narrow: bool,
}

impl<const L: usize> Terms<L> {
    fn new(terms: Vec<(usize, [u64; L])>) -> Self {
        let narrow = terms.iter().all(|(_, c)| {
            let sign = (c[0] as i64 >> 63) as u64;
            c[1..].iter().all(|&limb| limb == sign) && c[0].wrapping_add(1 << 62) <= 1 << 63
        });
        Terms { terms, narrow }
    }
}

/// A dense polynomial that sums are gathered in.
struct Sum<const L: usize> {
    coefficients: Vec<[u64; L]>,
    /// All places from here on are zero.
    end: usize,
}

impl<const L: usize> Sum<L> {
    fn add(&mut self, p: &Terms<L>) {
        for (place, c) in &p.terms {
            add(&mut self.coefficients[*place], c, false);
        }
        self.end = self.end.max(p.terms.last().map_or(0, |(place, _)| place + 1));
    }

    /// Adds `p q`, or subtracts it.
    fn add_product(&mut self, p: &Terms<L>, q: &Terms<L>, subtract: bool) {
        let (Some((last_p, _)), Some((last_q, _))) = (p.terms.last(), q.terms.last()) else { return };
        checkpoint((p.terms.len() * q.terms.len() / 8) as u64 + 2);
        self.end = self.end.max(last_p + last_q + 1);
        let (p, q) = if p.narrow { (q, p) } else { (p, q) };
        for (i, y) in &q.terms {
            let sums = &mut self.coefficients[*i..];
            if p.narrow {
                let y = if subtract { -(y[0] as i64) } else { y[0] as i64 };
                for (j, x) in &p.terms {
                    let product = i128::from(x[0] as i64) * i128::from(y);
                    let mut limbs = [(product >> 127) as u64; L];
                    limbs[0] = product as u64;
                    if L > 1 {
                        limbs[1] = (product >> 64) as u64;
                    }
                    add(&mut sums[*j], &limbs, false);
                }
            } else if q.narrow {
                let y = y[0] as i64;
                for (j, x) in &p.terms {
                    add(&mut sums[*j], &times_word(x, y.unsigned_abs()), (y < 0) != subtract);
                }
            } else {
                for (j, x) in &p.terms {
                    add(&mut sums[*j], &times(x, y), subtract);
                }
            }
        }
    }

    /// The sum, leaving zero.
    fn take(&mut self) -> Terms<L> {
        let mut terms = Vec::with_capacity(self.end);
        for (place, c) in self.coefficients[..self.end].iter_mut().enumerate() {
            if *c != [0; L] {
                terms.push((place, std::mem::replace(c, [0; L])));
            }
        }
        self.end = 0;
        Terms::new(terms)
    }
}

/// `x += y`, or `x -= y`.
#[inline(always)]
fn add<const L: usize>(x: &mut [u64; L], y: &[u64; L], subtract: bool) {
    // -y is the complement of y - 1.
    let (mask, mut carry) = if subtract { (u64::MAX, true) } else { (0, false) };
    for (x, &y) in x.iter_mut().zip(y) {
        let (sum, first) = x.overflowing_add(y ^ mask);
        let (sum, second) = sum.overflowing_add(u64::from(carry));
        *x = sum;
        carry = first | second;
    }
}

#[inline(always)]
fn times_word<const L: usize>(x: &[u64; L], word: u64) -> [u64; L] {
    let mut out = [0; L];
    let mut carry = 0;
    for (place, &x) in out.iter_mut().zip(x) {
        let t = u128::from(x) * u128::from(word) + u128::from(carry);
        (*place, carry) = (t as u64, (t >> 64) as u64);
    }
    out
}

#[inline(always)]
fn times<const L: usize>(x: &[u64; L], y: &[u64; L]) -> [u64; L] {
    let mut out = [0u64; L];
    for (i, &y) in y.iter().enumerate() {
        let mut carry = 0;
        for (place, &x) in out[i..].iter_mut().zip(x) {
            let t = u128::from(x) * u128::from(y) + u128::from(*place) + u128::from(carry);
            (*place, carry) = (t as u64, (t >> 64) as u64);
        }
    }
    out
}

impl DensePair<'_> {
    /// The resultant for the formal degrees in an array of the shape [`DensePair::lengths`], as the determinant of a matrix of the
    /// size of the higher degree `n`; `None` when it needs more words than there is code for, or a degree is 0.
    ///
    /// With `m` the lower degree and `p_k = (a_n x^k + ... + a_(n-k)) x^(n-m) b - (b_m x^k + ... + b_(m-k)) a`, which has a degree below
    /// `n`, the rows are `p_0, ..., p_(m-1), x^(n-m-1) b, ..., b`: by operations on the rows of Sylvester's
    /// matrix the first are put in the place of `x^(n-m) b, ...`, which multiplies by as many leading coefficients `a_n` as the rows of `a`
    /// then have on the diagonal ([DiazTocaGonzalezVega2004](crate::bibliography#diaztocagonzalezvega2004)). Minors of the first
    /// rows are computed once.
    /// `n 2^(n-1)` products of polynomials.
    pub fn resultant_by_minors(&self) -> Option<Vec<Integer>> {
        let (n, m) = self.degrees;
        if n.min(m) == 0 || n.max(m) > MOST_DEGREE { None } else { self.in_words(self.words()) }
    }

    fn in_words(&self, words: usize) -> Option<Vec<Integer>> {
        macro_rules! by_width {
            ($($l:literal),*) => {
                match words {
                    $($l => Some(self.determinant::<$l>()),)*
                    _ => None,
                }
            };
        }
        by_width!(1, 2, 3, 4, 5, 6, 7, 8)
    }

    /// The same; `None` also where residues modulo primes are expected to be faster.
    pub fn resultant_by_minors_if_fast(&self) -> Option<Vec<Integer>> {
        let (n, m) = self.degrees;
        let (n, m) = (n.max(m), n.min(m));
        if m == 0 || n > MOST_DEGREE {
            return None;
        }
        let lengths = self.lengths();
        let points = lengths.iter().try_fold(1usize, |size, l| size.checked_mul(*l)).filter(|&p| p <= MOST_PLACES)?;
        let words = self.words();
        if words > MOST_WORDS {
            return None;
        }
        // Products of coefficients, were no coefficient of a minor zero.
        let places = |rows: usize| lengths.iter().map(|l| (1 + ((l - 1) * rows).div_ceil(n)) as u64).product::<u64>();
        let given = self.terms.iter().product::<usize>() as u64;
        let (degrees, words) = ((n * m) as u64, words as u64);
        let (mut products, mut minors) = (2 * degrees * given * given, n as u64);
        for rows in 2..=n {
            minors = minors * (n + 1 - rows) as u64 / rows as u64;
            products += minors * rows as u64 * places(rows - 1) * places(1);
        }
        let by_minors = products * (words * words + 4);
        let by_primes = points as u64 * words * (PRODUCTS_PER_POINT + PRODUCTS_PER_STEP * degrees);
        if by_minors < by_primes { self.in_words(words as usize) } else { None }
    }

    /// Enough for any coefficient of the resultant: at most the product of the sums of the magnitudes in the rows.
    fn words(&self) -> usize {
        let norms = self.norms();
        let (a, b) = norms.split_at(self.degrees.0 + 1);
        let bits = |norms: &[Integer]| norms.iter().fold(Integer::ZERO, |sum, c| &sum + c).bit_length();
        let bits = bits(a) * self.degrees.1 as u64 + bits(b) * self.degrees.0 as u64;
        // And a sign.
        usize::try_from(bits / 64 + 1).unwrap_or(usize::MAX)
    }

    fn determinant<const L: usize>(&self) -> Vec<Integer> {
        let lengths = self.lengths();
        let size = lengths.iter().product();
        let (mut a, mut b) = self.packed::<L>(&lengths);
        let (mut n, mut m) = self.degrees;
        let mut negative = (m * m.saturating_sub(1) / 2) % 2 == 1;
        if n < m {
            std::mem::swap(&mut a, &mut b);
            std::mem::swap(&mut n, &mut m);
            negative = (m * (m - 1) / 2 + n * m) % 2 == 1;
        }
        let mut sum = Sum { coefficients: vec![[0; L]; size], end: 0 };
        // The minors of the rows so far, by the set of their columns; column j is that of x^j.
        let mut minors: Vec<Terms<L>> = vec![Terms::new(Vec::new()); 1 << n];
        let mut row: Vec<Terms<L>> = Vec::new();
        for k in 0..n {
            row = if k < m { bezout_row(&a, &b, k, &row, &mut sum) } else { shifted(&b, n - 1 - k, n) };
            if k == 0 {
                row.iter().enumerate().for_each(|(j, entry)| minors[1 << j] = entry.clone());
                continue;
            }
            for columns in (0..1usize << n).filter(|columns| columns.count_ones() as usize == k + 1) {
                for j in (0..n).filter(|j| columns >> j & 1 == 1) {
                    // Columns descend, and the row is the last.
                    let before = (columns >> (j + 1)).count_ones() as usize;
                    sum.add_product(&minors[columns & !(1 << j)], &row[j], (k + before) % 2 == 1);
                }
                minors[columns] = sum.take();
            }
        }
        claim((size * size_of::<Integer>()) as u64);
        let mut out = vec![Integer::ZERO; size];
        for (place, c) in minors.pop().map_or(Vec::new(), |all| all.terms) {
            let value = Integer::from_twos_complement(&c);
            out[place] = if negative { -value } else { value };
        }
        out
    }

    /// The coefficients of both polynomials, from the constant term up.
    fn packed<const L: usize>(&self, lengths: &[usize]) -> (Vec<Terms<L>>, Vec<Terms<L>>) {
        let rows = self.degrees.0 + self.degrees.1 + 2;
        let mut all = vec![Vec::new(); rows];
        for (k, c) in self.coefficients.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
            let (mut rest, mut place, mut inner) = (k / rows, 0, 1);
            for (&terms, &length) in self.terms.iter().zip(lengths).rev() {
                place += rest % terms * inner;
                rest /= terms;
                inner *= length;
            }
            let mut limbs = [0; L];
            for (limb, &magnitude) in limbs.iter_mut().zip(c.as_limbs()) {
                *limb = magnitude;
            }
            if c.is_negative() {
                let magnitude = std::mem::replace(&mut limbs, [0; L]);
                add(&mut limbs, &magnitude, true);
            }
            all[k % rows].push((place, limbs));
        }
        let mut a: Vec<Terms<L>> = all.into_iter().map(Terms::new).collect();
        let b = a.split_off(self.degrees.0 + 1);
        (a, b)
    }
}

/// The coefficients of `p_k` from those of `p_(k-1)`: `p_k = x p_(k-1) + a_(n-k) x^(n-m) b - b_(m-k) a`.
fn bezout_row<const L: usize>(
    a: &[Terms<L>],
    b: &[Terms<L>],
    k: usize,
    before: &[Terms<L>],
    sum: &mut Sum<L>,
) -> Vec<Terms<L>> {
    let (n, m) = (a.len() - 1, b.len() - 1);
    let entry = |j: usize| {
        if let Some(above) = j.checked_sub(1).and_then(|j| before.get(j)) {
            sum.add(above);
        }
        if let Some(i) = j.checked_sub(n - m) {
            sum.add_product(&a[n - k], &b[i], false);
        }
        sum.add_product(&b[m - k], &a[j], true);
        sum.take()
    };
    (0..n).map(entry).collect()
}

/// The coefficients of `x^by b` below `x^n`.
fn shifted<const L: usize>(b: &[Terms<L>], by: usize, n: usize) -> Vec<Terms<L>> {
    let zero = || Terms::new(Vec::new());
    (0..n).map(|j| j.checked_sub(by).and_then(|i| b.get(i)).cloned().unwrap_or_else(zero)).collect()
}
