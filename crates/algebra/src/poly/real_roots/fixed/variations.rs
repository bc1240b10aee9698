//! What is known of the number of sign variations when some signs are not.

use super::limbs::{is_negative, within};

/// Certified bounds of the number of sign variations; equal when enough signs are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variations {
    pub least: usize,
    pub most: usize,
}

/// Bounds of the sign variations of numbers known up to `error`, whose first and last are known to
/// be positive or not: neither is zero.
pub fn variations(flat: &[u64], limbs: usize, error: u64, first: bool, last: bool) -> Variations {
    let count = flat.len() / limbs;
    let mut out = Variations { least: 0, most: 0 };
    let (mut sign, mut unknown) = (first, 0);
    let mut close = |sign: &mut bool, unknown: &mut usize, next: bool| {
        // Between signs that differ the number is odd, otherwise even, and no more than the gaps.
        let change = usize::from(*sign != next);
        out.least += change;
        out.most += if *unknown == 0 { change } else { *unknown + 1 - (*unknown + 1 + change) % 2 };
        (*sign, *unknown) = (next, 0);
    };
    for c in flat.chunks_exact(limbs).skip(1).take(count.saturating_sub(2)) {
        if within(c, error) {
            unknown += 1;
        } else {
            close(&mut sign, &mut unknown, !is_negative(c));
        }
    }
    close(&mut sign, &mut unknown, last);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All sign vectors that fit, by trial: -1, 0 and 1 at the unknown places.
    fn by_trial(known: &[Option<bool>]) -> Variations {
        let (mut least, mut most) = (usize::MAX, 0);
        let choices = 3usize.pow(known.iter().filter(|k| k.is_none()).count() as u32);
        for mut choice in 0..choices {
            let signs: Vec<i32> = known
                .iter()
                .map(|k| match k {
                    Some(positive) => {
                        if *positive {
                            1
                        } else {
                            -1
                        }
                    }
                    None => {
                        let s = (choice % 3) as i32 - 1;
                        choice /= 3;
                        s
                    }
                })
                .filter(|&s| s != 0)
                .collect();
            let v = signs.windows(2).filter(|w| w[0] != w[1]).count();
            (least, most) = (least.min(v), most.max(v));
        }
        Variations { least, most }
    }

    #[test]
    fn bounds_are_attained() {
        // Numbers -9, 9 and 1 with the error 3: the last is unknown.
        for n in 2..8u32 {
            for mut code in 0..3u32.pow(n) {
                let known: Vec<Option<bool>> = (0..n)
                    .map(|_| {
                        let k = code % 3;
                        code /= 3;
                        [None, Some(false), Some(true)][k as usize]
                    })
                    .collect();
                let (Some(first), Some(last)) = (known[0], known[n as usize - 1]) else { continue };
                let flat: Vec<u64> = known
                    .iter()
                    .flat_map(|k| match k {
                        None => [1, 0],
                        Some(true) => [9, 0],
                        Some(false) => [(-9i64) as u64, u64::MAX],
                    })
                    .collect();
                assert_eq!(variations(&flat, 2, 3, first, last), by_trial(&known), "{known:?}");
            }
        }
    }
}
