//! The derivatives of the pair, and ranges of their products.

use super::polynomial::Bundle;
use jurist_algebra::number::Integer;
use std::collections::BTreeMap;

/// The derivatives of the pair by the frequency, which is one more variable, and by each parameter: `E_v, O_v, E_1, O_1, ...`.
pub(super) fn derivatives(pair: &Bundle) -> Bundle {
    let count = pair.width / 2;
    let parameters = pair.degrees.len();
    let width = 2 + 2 * parameters;
    let mut terms: BTreeMap<Vec<u32>, Vec<Integer>> = BTreeMap::new();
    let mut add = |exponents: Vec<u32>, which: usize, c: Integer| {
        terms.entry(exponents).or_insert_with(|| vec![Integer::ZERO; width])[which] += &c;
    };
    for (exponents, coefficients) in &pair.terms {
        for (at, c) in coefficients.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
            let (odd, j) = (at / count, at % count);
            let with = |power: usize| exponents.iter().copied().chain([power as u32]).collect::<Vec<u32>>();
            if j > 0 {
                add(with(j - 1), odd, c * &Integer::from(j as u64));
            }
            for (i, &e) in exponents.iter().enumerate().filter(|(_, e)| **e > 0) {
                let mut lower = with(j);
                lower[i] -= 1;
                add(lower, 2 + 2 * i + odd, c * &Integer::from(u64::from(e)));
            }
        }
    }
    let mut degrees = pair.degrees.clone();
    degrees.push(count - 1);
    Bundle { width, degrees, terms: terms.into_iter().collect() }
}

/// The range of a product of two ranges.
pub(super) fn product(a: &(Integer, Integer), b: &(Integer, Integer)) -> (Integer, Integer) {
    let all = [&a.0 * &b.0, &a.0 * &b.1, &a.1 * &b.0, &a.1 * &b.1];
    let least = all.iter().min().expect("four").clone();
    let greatest = all.iter().max().expect("four").clone();
    (least, greatest)
}
