//! Products of polynomials in several variables, which take much of the time of a check.

use super::clock::Clock;
use super::multivariate::Multi;
use super::number::Z;
use num_traits::Zero;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// So many exponents fit into a word, each and the sum of two of them below 2 to the power of [`PACKED_BITS`].
const PACKED: usize = 4;

const PACKED_BITS: usize = 16;

/// The exponents of a packed term, without zeros at the end.
fn unpacked(e: u64) -> Vec<u32> {
    let mut out: Vec<u32> =
        (0..PACKED).rev().map(|k| (e >> (PACKED_BITS * k)) as u32 & ((1 << PACKED_BITS) - 1)).collect();
    while out.last() == Some(&0) {
        out.pop();
    }
    out
}

/// The exponents of the product of two terms.
pub(super) fn added(e: &[u32], f: &[u32]) -> Vec<u32> {
    let (long, short) = if e.len() < f.len() { (f, e) } else { (e, f) };
    let mut sum = long.to_vec();
    sum.iter_mut().zip(short).for_each(|(a, b)| *a += b);
    sum
}

/// The terms of a product of polynomials whose numbers have at most so many bits.
fn product<E: Ord>(
    a: &[(E, &Z)],
    b: &[(E, &Z)],
    add: impl Fn(&E, &E) -> E,
    bits: [u64; 2],
    most: usize,
    clock: &Clock,
) -> Result<Option<BTreeMap<E, Z>>, String> {
    let mut out: BTreeMap<E, Z> = BTreeMap::new();
    for (e, c) in a {
        clock.spend(b.len(), bits[0], bits[1])?;
        for (f, d) in b {
            match out.entry(add(e, f)) {
                Entry::Vacant(place) => {
                    place.insert(*c * *d);
                }
                Entry::Occupied(mut place) => *place.get_mut() += *c * *d,
            }
        }
        if out.len() > most {
            out.retain(|_, c| !c.is_zero());
            if out.len() > most {
                return Ok(None);
            }
        }
    }
    out.retain(|_, c| !c.is_zero());
    Ok(Some(out))
}

/// The product of polynomials whose numbers have at most so many bits, and whose exponents have sums below 2 to the power of
/// [`PACKED_BITS`]; `None` where it has more than so many terms.
///
/// Cost: a product of numbers for each two terms, and a search among the terms of the result.
pub(super) fn times(a: &Multi, b: &Multi, bits: [u64; 2], most: usize, clock: &Clock) -> Result<Option<Multi>, String> {
    if let (Some(a), Some(b)) = (packed(a), packed(b)) {
        let found = product(&a, &b, |e, f| e + f, bits, most, clock)?;
        return Ok(found.map(|terms| Multi(terms.into_iter().map(|(e, c)| (unpacked(e), c)).collect())));
    }
    let [a, b] = [a, b].map(|m| m.0.iter().map(|(e, c)| (e.clone(), c)).collect::<Vec<_>>());
    Ok(product(&a, &b, |e, f| added(e, f), bits, most, clock)?.map(Multi))
}

/// The terms with their exponents in one word, in the same order; `None` where there are more variables than fit.
fn packed(m: &Multi) -> Option<Vec<(u64, &Z)>> {
    let word = |e: &[u32]| {
        let places = e.iter().rev().zip(PACKED.checked_sub(e.len())?..);
        Some(places.fold(0, |word, (e, k)| word | u64::from(*e) << (PACKED_BITS * k)))
    };
    m.0.iter().map(|(e, c)| Some((word(e)?, c))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn terms_in_words_have_the_same_products() {
        let of = |list: &[(&[u32], i64)]| Multi(list.iter().map(|(e, c)| (e.to_vec(), Z::from(*c))).collect());
        let clock = Clock::new(Duration::MAX);
        let polynomials = [
            of(&[(&[], 3), (&[1], -2), (&[0, 0, 0, 7], 1), (&[2000, 0, 5], -4)]),
            of(&[(&[], -3), (&[1], 2), (&[0, 1], 1)]),
            of(&[(&[1], 1), (&[0, 1], 1)]),
            of(&[(&[1], 1), (&[0, 1], -1)]),
            of(&[(&[0, 0, 1999, 3], 5)]),
            of(&[]),
        ];
        for a in &polynomials {
            for b in &polynomials {
                let found = times(a, b, [1; 2], 100, &clock).unwrap().unwrap();
                // The other way, where there are more variables.
                let wide = |m: &Multi| {
                    let key = |e: &Vec<u32>| {
                        [1].into_iter().chain(std::iter::repeat_n(0, 4)).chain(e.iter().copied()).collect()
                    };
                    Multi(m.0.iter().map(|(e, c)| (key(e), c.clone())).collect())
                };
                let other = times(&wide(a), &wide(b), [1; 2], 100, &clock).unwrap().unwrap();
                assert_eq!(wide(&found).0.len(), other.0.len());
                assert!(
                    wide(&found).0.iter().zip(&other.0).all(|((e, c), (f, d))| e[5..] == f[5..] && f[0] == 2 && c == d)
                );
                assert!(found.0.iter().all(|(e, c)| e.last() != Some(&0) && !c.is_zero()));
            }
        }
        assert_eq!(times(&polynomials[0], &polynomials[1], [1; 2], 9, &clock).unwrap(), None);
    }
}
