//! De Casteljau's triangle in fixed width: both halves of a polynomial in the Bernstein basis by
//! additions alone.

use super::limbs::{add, add_assign, shift_right, shift_right_assign};
use crate::limits::checkpoint;

use std::ops::Range;

/// Triangles of fewer numbers are counted at once, others row by row.
const COUNTED_ROW: usize = 128;

/// Bits that must be free above every coefficient (the sign's included) before [`split`].
pub const HEADROOM: u64 = 34;

/// After so many stages of doubling the numbers are halved as often.
const STAGES: u32 = 32;

/// The Bernstein coefficients on both halves, each up to an error of
/// `error + stages / 32 + 1` units for `stages` the degree: means of neighbours never amplify an
/// error, and each shift to the right adds less than a unit.
pub fn split(coeffs: &mut [u64], limbs: usize, left: &mut [u64], right: &mut [u64]) {
    let n = coeffs.len() / limbs;
    if n < COUNTED_ROW {
        checkpoint((n * n * limbs / 16) as u64);
    }
    macro_rules! by_width {
        ($($l:literal),*) => {
            match limbs {
                $($l => split_fixed::<$l>(
                    coeffs.as_chunks_mut().0,
                    left.as_chunks_mut().0,
                    right.as_chunks_mut().0,
                ),)*
                _ => split_any(coeffs, limbs, left, right),
            }
        };
    }
    by_width!(2, 3, 4, 5, 6, 7, 8, 10, 12, 16);
}

/// The width of at least `limbs` limbs that [`split`] is fastest at.
pub fn fitting_width(limbs: usize) -> usize {
    match limbs {
        0..=2 => 2,
        9 => 10,
        11 => 12,
        13..=15 => 16,
        _ => limbs,
    }
}

/// The error of the halves, in units, for coefficients with `error`.
pub fn error_of_halves(error: u64, degree: usize) -> u64 {
    error + degree as u64 / u64::from(STAGES) + 1
}

fn split_fixed<const L: usize>(work: &mut [[u64; L]], left: &mut [[u64; L]], right: &mut [[u64; L]]) {
    let n = work.len() - 1;
    (left[0], right[n]) = (work[0], work[n]);
    let (mut stage, mut pending) = (0, 0);
    while stage < n {
        let m = n - stage;
        if n >= COUNTED_ROW {
            checkpoint((m * L / 4) as u64);
        }
        if m >= 2 {
            // Two stages in one sweep.
            let mut before = work[1];
            let mut mean = add(&work[0], &before);
            left[stage + 1] = shift_right(&mean, pending + 1);
            for j in 2..=m {
                let x = work[j];
                let next = add(&before, &x);
                work[j - 2] = add(&mean, &next);
                (before, mean) = (x, next);
            }
            right[m - 1] = shift_right(&mean, pending + 1);
            left[stage + 2] = shift_right(&work[0], pending + 2);
            right[m - 2] = shift_right(&work[m - 2], pending + 2);
            (stage, pending) = (stage + 2, pending + 2);
        } else {
            let mean = shift_right(&add(&work[0], &work[1]), pending + 1);
            (left[n], right[0]) = (mean, mean);
            stage += 1;
        }
        if pending == STAGES {
            for x in &mut work[..=n - stage] {
                *x = shift_right(x, STAGES);
            }
            pending = 0;
        }
    }
}

fn split_any(work: &mut [u64], limbs: usize, left: &mut [u64], right: &mut [u64]) {
    let n = work.len() / limbs - 1;
    let at = |i: usize| i * limbs..(i + 1) * limbs;
    left[at(0)].copy_from_slice(&work[at(0)]);
    right[at(n)].copy_from_slice(&work[at(n)]);
    let mut pending = 0;
    for stage in 1..=n {
        let m = n - stage;
        if n >= COUNTED_ROW {
            checkpoint((m * limbs / 4) as u64);
        }
        for i in 0..=m {
            let (low, high) = work.split_at_mut((i + 1) * limbs);
            add_assign(&mut low[i * limbs..], &high[..limbs]);
        }
        pending += 1;
        left[at(stage)].copy_from_slice(&work[at(0)]);
        shift_right_assign(&mut left[at(stage)], pending);
        right[at(m)].copy_from_slice(&work[at(m)]);
        shift_right_assign(&mut right[at(m)], pending);
        if pending == STAGES {
            for i in 0..=m {
                shift_right_assign(&mut work[at(i)], STAGES);
            }
            pending = 0;
        }
    }
}

/// Replaces the forward differences at the first of some numbers by the numbers: `n^2 / 2` additions.
pub fn sum_differences(flat: &mut [u64], limbs: usize) {
    let n = flat.len() / limbs;
    // Pascal's triangle as a product of running sums from the last place, the last but one, ...:
    // C(j, i) is the sum of C(m - 1, i - 1) over m up to j.
    running_sums(flat, limbs, (1..n).rev().map(|start| start - 1..n));
}

/// Sums of neighbours, again and again: the first ones of all stages, and the last ones, each from the first stage on.
/// They must fit; what is in between may overflow.
pub fn sum_from_both_ends(work: &mut [u64], limbs: usize, first: &mut [u64], last: &mut [u64]) {
    let n = work.len() / limbs;
    if n < COUNTED_ROW {
        checkpoint((n * n * limbs / 16) as u64);
    }
    macro_rules! by_width {
        ($($l:literal),*) => {
            match limbs {
                $($l => sum_from_both_ends_fixed::<$l>(
                    work.as_chunks_mut().0,
                    first.as_chunks_mut().0,
                    last.as_chunks_mut().0,
                ),)*
                _ => sum_from_both_ends_any(work, limbs, first, last),
            }
        };
    }
    by_width!(2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32);
}

fn sum_from_both_ends_fixed<const L: usize>(work: &mut [[u64; L]], first: &mut [[u64; L]], last: &mut [[u64; L]]) {
    let n = work.len() - 1;
    (first[0], last[0]) = (work[0], work[n]);
    let mut stage = 0;
    while stage + 2 <= n {
        let m = n - stage;
        if n >= COUNTED_ROW {
            checkpoint((m * L / 4) as u64);
        }
        // Two stages in one sweep.
        let mut before = work[1];
        let mut sum = add(&work[0], &before);
        first[stage + 1] = sum;
        for j in 2..=m {
            let x = work[j];
            let next = add(&before, &x);
            work[j - 2] = add(&sum, &next);
            (before, sum) = (x, next);
        }
        last[stage + 1] = sum;
        stage += 2;
        (first[stage], last[stage]) = (work[0], work[m - 2]);
    }
    if stage < n {
        let sum = add(&work[0], &work[1]);
        (first[n], last[n]) = (sum, sum);
    }
}

fn sum_from_both_ends_any(work: &mut [u64], limbs: usize, first: &mut [u64], last: &mut [u64]) {
    let n = work.len() / limbs - 1;
    let at = |i: usize| i * limbs..(i + 1) * limbs;
    for stage in 0..=n {
        let m = n - stage;
        if n >= COUNTED_ROW {
            checkpoint((m * limbs / 4) as u64);
        }
        first[at(stage)].copy_from_slice(&work[at(0)]);
        last[at(stage)].copy_from_slice(&work[at(m)]);
        for i in 0..m {
            let (low, high) = work.split_at_mut((i + 1) * limbs);
            add_assign(&mut low[i * limbs..], &high[..limbs]);
        }
    }
}

/// The coefficients of `p(x + 1)` from those of `p`, both from the leading one down (Horner's rule).
pub fn shift_by_one(flat: &mut [u64], limbs: usize) {
    let n = flat.len() / limbs;
    running_sums(flat, limbs, (2..=n).rev().map(|end| 0..end));
}

fn running_sums(flat: &mut [u64], limbs: usize, ranges: impl Iterator<Item = Range<usize>>) {
    let n = flat.len() / limbs;
    if n < COUNTED_ROW {
        checkpoint((n * n * limbs / 16) as u64);
    }
    macro_rules! by_width {
        ($($l:literal),*) => {
            match limbs {
                $($l => {
                    let c = flat.as_chunks_mut::<$l>().0;
                    ranges.for_each(|range| {
                        if n >= COUNTED_ROW {
                            checkpoint((range.len() * limbs / 8) as u64);
                        }
                        running_sum(&mut c[range]);
                    });
                })*
                _ => {
                    for range in ranges {
                        if n >= COUNTED_ROW {
                            checkpoint((range.len() * limbs / 8) as u64);
                        }
                        for i in range.skip(1) {
                            let (low, high) = flat.split_at_mut(i * limbs);
                            add_assign(&mut high[..limbs], &low[(i - 1) * limbs..]);
                        }
                    }
                }
            }
        };
    }
    by_width!(2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32);
}

fn running_sum<const L: usize>(c: &mut [[u64; L]]) {
    let Some((first, rest)) = c.split_first_mut() else { return };
    let mut sum = *first;
    for x in rest {
        sum = add(&sum, x);
        *x = sum;
    }
}

/// The width of at least `limbs` limbs that [`sum_differences`] is fastest at.
pub fn summing_width(limbs: usize) -> usize {
    match limbs {
        0..=2 => 2,
        9 | 11 | 13 | 15 | 17 | 19 => limbs + 1,
        21..=32 => limbs.next_multiple_of(4),
        _ => limbs,
    }
}

#[cfg(test)]
mod tests {
    use super::super::limbs::{rescale, write_shifted};
    use super::*;
    use crate::number::Integer;

    /// Means of all neighbours, exactly, times `2^n`.
    fn exact(coeffs: &[Integer]) -> (Vec<Integer>, Vec<Integer>) {
        let n = coeffs.len() - 1;
        let mut work = coeffs.to_vec();
        let (mut left, mut right) = (vec![Integer::ZERO; n + 1], vec![Integer::ZERO; n + 1]);
        for r in 0..=n {
            left[r] = &work[0] << (n - r) as u64;
            right[n - r] = &work[n - r] << (n - r) as u64;
            for i in 0..n - r {
                work[i] = &work[i] + &work[i + 1];
            }
        }
        (left, right)
    }

    #[test]
    fn differences_sum_to_binomials() {
        // Differences 1, 1, 1, ... belong to powers of two, and 0, ..., 0, -1 to one number.
        for limbs in [2, 3, 16, 33] {
            let mut flat = vec![0; 40 * limbs];
            flat.chunks_exact_mut(limbs).for_each(|c| c[0] = 1);
            sum_differences(&mut flat, limbs);
            for (j, c) in flat.chunks_exact(limbs).enumerate() {
                assert_eq!(Integer::from_twos_complement(c), &Integer::ONE << j as u64);
            }
            let mut flat = vec![0; 7 * limbs];
            flat[6 * limbs..].fill(u64::MAX);
            sum_differences(&mut flat, limbs);
            assert!(flat[..6 * limbs].iter().all(|&x| x == 0) && flat[6 * limbs..].iter().all(|&x| x == u64::MAX));
        }
    }

    /// The first ones are what [`sum_differences`] makes of the numbers, the last ones what it makes of them backwards.
    #[test]
    fn sums_from_both_ends_are_those_of_differences() {
        for limbs in [2, 3, 8, 16, 33] {
            for n in [1usize, 2, 3, 4, 9, 40, 131] {
                let numbers: Vec<u64> =
                    (1..=n * limbs).map(|k| (k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)).collect();
                let mut expected_first = numbers.clone();
                sum_differences(&mut expected_first, limbs);
                let mut expected_last: Vec<u64> = numbers.chunks_exact(limbs).rev().flatten().copied().collect();
                sum_differences(&mut expected_last, limbs);
                let (mut first, mut last) = (vec![0; n * limbs], vec![0; n * limbs]);
                sum_from_both_ends(&mut numbers.clone(), limbs, &mut first, &mut last);
                assert!(first == expected_first && last == expected_last, "{n} numbers of {limbs} limbs");
            }
        }
    }

    #[test]
    fn halves_are_within_their_error() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state
        };
        for limbs in [2, 3, 4, 7, 9, 16, 17] {
            for n in [1usize, 2, 3, 31, 32, 33, 64, 67] {
                let numbers: Vec<Integer> = (0..=n)
                    .map(|_| {
                        let mut raw: Vec<u64> = (0..limbs).map(|_| next()).collect();
                        shift_right_assign(&mut raw, HEADROOM as u32 - 1);
                        Integer::from_twos_complement(&raw)
                    })
                    .collect();
                let mut flat = vec![0; (n + 1) * limbs];
                for (c, place) in numbers.iter().zip(flat.chunks_exact_mut(limbs)) {
                    write_shifted(c, 0, place);
                }
                let mut halves = (vec![0; flat.len()], vec![0; flat.len()]);
                split(&mut flat, limbs, &mut halves.0, &mut halves.1);
                let (left, right) = exact(&numbers);
                let bound = &Integer::from(error_of_halves(0, n)) << n as u64;
                for (flat, exact) in [(halves.0, left), (halves.1, right)] {
                    let wide = rescale(&flat, limbs, limbs + 2, -(n as i64));
                    for (got, want) in wide.chunks_exact(limbs + 2).zip(exact) {
                        assert!(
                            (Integer::from_twos_complement(got) - want).abs() <= bound,
                            "{limbs} limbs, degree {n}"
                        );
                    }
                }
            }
        }
    }
}
