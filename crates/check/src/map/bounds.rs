//! Bounds of a resultant before it is computed: its exponents, a number that divides it, and its height.
//!
//! A term of Sylvester's determinant takes one entry of each row and each column. Whatever number is added to each column, a term's
//! weights sum up to at most the sum of the rows' greatest, less what was added. Numbers that make this close are read off the
//! polygons of both polynomials.

use crate::clock::Clock;
use crate::number::Z;
use crate::univariate::Uni;
use num_traits::{One, Signed, Zero};

/// Numbers with a few digits after the point have denominators of such factors.
const PRIMES: [u64; 11] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31];

/// Weights are counted in parts of this many, so that slopes of polygons lose little in integers.
const PARTS: i64 = 64;

/// What is known of a resultant in `x`.
pub(super) struct Frame {
    /// It is a multiple of this power of `x`.
    pub lowest: usize,
    /// And has so many coefficients from that on, at most.
    pub count: usize,
    /// It is a multiple of this number.
    pub divisor: Z,
    /// And its coefficients, divided by that, are below `2^bits`.
    pub bits: u64,
}

impl Frame {
    /// Of polynomials in `y`, coefficients from the constant term up; `None` where every term of the determinant is zero.
    pub fn of(f: &[Uni], g: &[Uni], clock: &Clock) -> Result<Option<Frame>, String> {
        let contents = |p: &[Uni]| p.iter().map(|c| c.content(clock)).collect::<Result<Vec<Z>, _>>();
        let contents = [contents(f)?, contents(g)?];
        Ok(Frame::with(f, g, &contents))
    }

    fn with(f: &[Uni], g: &[Uni], contents: &[Vec<Z>; 2]) -> Option<Frame> {
        let highest = greatest([f, g].map(|p| weights(p, |c| Some(c.degree() as i64).filter(|_| !c.is_zero()))))?;
        let lowest = -greatest([f, g].map(|p| weights(p, |c| Some(-(order(c) as i64)).filter(|_| !c.is_zero()))))?;
        let lowest = lowest.max(0);
        if highest < lowest {
            return None;
        }
        let mut divisor = Z::one();
        for prime in PRIMES.map(Z::from) {
            let of_content = |c: &Z| (!c.is_zero()).then(|| -valuation(c, &prime));
            let power = -greatest(contents.each_ref().map(|p| weights(p, of_content)))?;
            divisor *= prime.pow(u32::try_from(power.max(0)).ok()?);
        }
        let bits = (height(f, g) + 1).saturating_sub(divisor.bits());
        Some(Frame { lowest: lowest as usize, count: (highest - lowest) as usize + 1, divisor, bits })
    }
}

/// The weights of coefficients in parts; none of zero.
fn weights<C>(coefficients: &[C], weight: impl Fn(&C) -> Option<i64>) -> Vec<Option<i64>> {
    coefficients.iter().map(|c| Some(weight(c)? * PARTS)).collect()
}

/// The exponent of the lowest power of `x`.
fn order(c: &Uni) -> usize {
    c.0.iter().take_while(|c| c.is_zero()).count()
}

/// How often a prime divides a number that is not zero.
fn valuation(number: &Z, prime: &Z) -> i64 {
    let (mut rest, mut count) = (number.clone(), 0);
    while (&rest % prime).is_zero() {
        rest /= prime;
        count += 1;
    }
    count
}

/// An upper bound of the sum of weights of any term, the parts made whole; `None` if a row has no entry.
fn greatest([f, g]: [Vec<Option<i64>>; 2]) -> Option<i64> {
    let added = columns(&f, &g);
    let mut sum = -added.iter().sum::<i64>();
    for (row, shifts) in [(&f, g.len() - 1), (&g, f.len() - 1)] {
        for shift in 0..shifts {
            sum += row.iter().zip(&added[shift..]).filter_map(|(w, c)| w.map(|w| w + c)).max()?;
        }
    }
    Some(sum.div_euclid(PARTS))
}

/// What is added to the columns: less the greatest sum of the polygons above both polynomials' weights.
fn columns(f: &[Option<i64>], g: &[Option<i64>]) -> Vec<i64> {
    let (a, b) = (polygon(f), polygon(g));
    let sum = |k: usize| {
        let pairs = a.iter().enumerate().filter_map(|(i, x)| Some((*x)? + (*b.get(k.checked_sub(i)?)?)?));
        -pairs.max().unwrap_or(0)
    };
    (0..f.len() + g.len() - 2).map(sum).collect()
}

/// The least concave function that is not below the weights, rounded down.
fn polygon(weights: &[Option<i64>]) -> Vec<Option<i64>> {
    let mut corners: Vec<(i64, i64)> = Vec::new();
    for next in weights.iter().zip(0..).filter_map(|(w, k)| Some((k, (*w)?))) {
        // A corner that is not above the line from the one before it to the next is none.
        while let [.., before, last] = corners[..]
            && (last.1 - before.1) * (next.0 - before.0) <= (next.1 - before.1) * (last.0 - before.0)
        {
            corners.pop();
        }
        corners.push(next);
    }
    let at = |k: i64| {
        let right = corners.iter().position(|corner| corner.0 >= k)?;
        let (p, q) = (corners[right.saturating_sub(1)], corners[right]);
        match q.0 - p.0 {
            0 => (q.0 == k).then_some(q.1),
            width => Some((p.1 * (q.0 - k) + q.1 * (k - p.0)).div_euclid(width)),
        }
    };
    (0..weights.len() as i64).map(at).collect()
}

/// `e` such that all coefficients are below `2^e`: Hadamard's bound on the circle `|x| = 1`, the columns multiplied by powers of two.
fn height(f: &[Uni], g: &[Uni]) -> u64 {
    let norms = |p: &[Uni]| p.iter().map(|c| c.0.iter().map(Signed::abs).sum::<Z>()).collect::<Vec<Z>>();
    let (f, g) = (norms(f), norms(g));
    let sizes = |norms: &[Z]| weights(norms, |n| (!n.is_zero()).then(|| n.bits() as i64));
    let added: Vec<i64> = columns(&sizes(&f), &sizes(&g)).iter().map(|c| c.div_euclid(PARTS)).collect();
    let least = added.iter().copied().min().unwrap_or(0);
    let mut twice = 0;
    for (row, shifts) in [(&f, g.len() - 1), (&g, f.len() - 1)] {
        for shift in 0..shifts {
            let entries = row.iter().zip(&added[shift..]);
            let square: Z = entries.map(|(n, c)| (n * n) << (2 * (c - least)) as u64).sum();
            twice += square.bits() as i64;
        }
    }
    // As many columns as rows: the least comes off as often as it was left out.
    let shifts: i64 = added.iter().map(|c| c - least).sum();
    (twice / 2 + 1 - shifts).max(0) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_are_above_the_weights() {
        assert_eq!(polygon(&[Some(0), None, Some(1), Some(6), None]), [Some(0), Some(2), Some(4), Some(6), None]);
        assert_eq!(polygon(&[None, Some(3)]), [None, Some(3)]);
    }

    #[test]
    fn terms_have_at_most_the_greatest_weight() {
        // y^2 + x y + x^3 and y + x^2: the terms x^4, x^3 and x^3.
        let parts = |list: &[i64]| list.iter().map(|w| Some(w * PARTS)).collect::<Vec<_>>();
        assert_eq!(greatest([parts(&[3, 1, 0]), parts(&[2, 0])]), Some(4));
        assert_eq!(greatest([vec![None, None], parts(&[2, 0])]), None);
    }
}
