//! How many roots of a polynomial lie inside, on and outside the boundary: exactly, in all cases.

use super::{HalfSizePair, Shape};
use jurist_algebra::number::{Integer, Sign};
use jurist_algebra::poly::real_roots::{sign_variations, signed_remainder_sequence};
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use std::cmp::Ordering;

/// Numbers of roots with respect to a region, counted with multiplicity.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::{RootCount, Shape, count_roots};
/// let count = count_roots(&UniPoly::from_i64(&[0, 1, 0, 1]), Shape::LeftHalfPlane); // s (s^2 + 1)
/// assert_eq!(count, RootCount { inside: 0, on: 3, outside: 0 });
/// assert_eq!(count.total(), 3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct RootCount {
    /// Roots in the open region: strictly stable.
    pub inside: usize,
    /// Roots on its boundary.
    pub on: usize,
    /// Roots beyond it: unstable.
    pub outside: usize,
}

impl RootCount {
    /// The number of all roots: the degree.
    pub fn total(self) -> usize {
        self.inside + self.on + self.outside
    }
}

/// The exact root count of a non-zero polynomial; a constant has none.
///
/// By the Cauchy index of the half-size pair. After the roots at the ends of the boundary (`1` and `-1`, or `0`) are
/// split off and the degree is made even by a root known to be inside, the argument of the polynomial grows along the
/// boundary's upper half by `pi/2 (inside - outside)`, which is `pi` times the Cauchy index of
/// `B/A` ([Gantmacher1959](jurist_algebra::bibliography#gantmacher1959), ch. XV). Common roots of the pair are mirror pairs:
/// those in the interval are on the boundary, the others have one root on either side.
/// `O(n^2)` operations on integers that grow to `O(n)` times the input's length, within the budget that holds on the thread.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::{Shape, RootCount, count_roots};
/// // (2z - 1)(z - 1)(z - 3)
/// let p = UniPoly::from_i64(&[-3, 10, -9, 2]);
/// let count = count_roots(&p, Shape::UnitDisc);
/// assert_eq!(count, RootCount { inside: 1, on: 1, outside: 1 });
/// ```
///
/// # Panics
/// When `p` is zero.
pub fn count_roots(p: &UniPoly, region: Shape) -> RootCount {
    assert!(!p.is_zero(), "the zero polynomial has no root count");
    let mut count = RootCount::default();
    let mut d = p.clone();
    match region {
        Shape::UnitDisc => {
            for root in [1, -1] {
                while d.eval(&Integer::from(root)).is_zero() {
                    d = d.div_exact(&UniPoly::from_i64(&[-root, 1])).expect("a root's factor divides");
                    count.on += 1;
                }
            }
        }
        Shape::LeftHalfPlane => {
            let zeros = d.coeffs().iter().take_while(|c| c.is_zero()).count();
            d = Poly::new(d.coeffs()[zeros..].to_vec());
            count.on += zeros;
        }
    }
    let n = d.coeffs().len() - 1;
    if n == 0 {
        return count;
    }
    let padded = n % 2 == 1;
    if padded {
        d = match region {
            Shape::UnitDisc => d.shifted_up(1),
            Shape::LeftHalfPlane => &d * &UniPoly::from_i64(&[1, 1]),
        };
    }
    let even = n + usize::from(padded);
    let pair = HalfSizePair::new(&d, even, region);
    let ends = match region {
        Shape::UnitDisc => [End::Finite(-2), End::Finite(2)],
        Shape::LeftHalfPlane => [End::MinusInfinity, End::Finite(0)],
    };
    let sequence = signed_remainder_sequence(&pair.a, &pair.b);
    // The signs are taken before the division by the gcd, which has no root at the ends: it changes
    // all signs of the sequence at an end together, so the variations stay.
    let variations = ends.map(|end| sign_variations(sequence.iter().map(|s| end.sign(s))));
    let index = variations[0] as i64 - variations[1] as i64;
    let gcd = sequence.last().expect("the sequence is not empty");
    let mirrored = gcd.coeffs().len() - 1;
    let on_boundary = roots_with_multiplicity(gcd, ends);
    let regular = even - 2 * mirrored;
    // inside - outside = 2 index, inside + outside = regular.
    let inside = (regular as i64 + 2 * index) / 2;
    count.inside += inside as usize + (mirrored - on_boundary) - usize::from(padded);
    count.outside += regular - inside as usize + (mirrored - on_boundary);
    count.on += 2 * on_boundary;
    count
}

/// Whether all roots lie in the open region. A non-zero constant is stable, zero is not.
///
/// Cost: that of [`count_roots`].
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::{Shape, is_stable};
/// assert!(is_stable(&UniPoly::from_i64(&[4, 3, 2, 1]), Shape::LeftHalfPlane));
/// ```
pub fn is_stable(p: &UniPoly, region: Shape) -> bool {
    if p.is_zero() {
        return false;
    }
    let count = count_roots(p, region);
    count.inside == count.total()
}

/// An end of the interval that the boundary's upper half is mapped to.
#[derive(Clone, Copy)]
enum End {
    MinusInfinity,
    Finite(i64),
}

impl End {
    fn sign(self, p: &UniPoly) -> Sign {
        match self {
            End::Finite(x) => p.eval(&Integer::from(x)).sign(),
            End::MinusInfinity => {
                let sign = p.leading().map_or(Ordering::Equal, Integer::sign);
                if p.coeffs().len().is_multiple_of(2) { sign.reverse() } else { sign }
            }
        }
    }
}

/// Real roots of `g` between the ends, with multiplicity, by Sturm's theorem on its square-free factors.
fn roots_with_multiplicity(g: &UniPoly, ends: [End; 2]) -> usize {
    let mut roots = 0;
    for (factor, multiplicity) in g.square_free_decomposition() {
        let sequence = signed_remainder_sequence(&factor, &factor.derivative());
        let [low, high] = ends.map(|end| sign_variations(sequence.iter().map(|s| end.sign(s))));
        roots += multiplicity * (low - high);
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(factors: &[&[i64]]) -> UniPoly {
        factors.iter().fold(UniPoly::one(), |p, f| &p * &UniPoly::from_i64(f))
    }

    fn disc(factors: &[&[i64]]) -> (usize, usize, usize) {
        let c = count_roots(&product(factors), Shape::UnitDisc);
        (c.inside, c.on, c.outside)
    }

    fn half_plane(factors: &[&[i64]]) -> (usize, usize, usize) {
        let c = count_roots(&product(factors), Shape::LeftHalfPlane);
        (c.inside, c.on, c.outside)
    }

    #[test]
    fn singular_cases_of_the_disc() {
        assert_eq!(disc(&[&[7]]), (0, 0, 0));
        assert_eq!(disc(&[&[0, 1]]), (1, 0, 0));
        assert_eq!(disc(&[&[-1, 1]]), (0, 1, 0));
        assert_eq!(disc(&[&[1, 1], &[1, 1], &[-1, 1]]), (0, 3, 0));
        // A reciprocal real pair, a reciprocal pair on the circle, twice.
        assert_eq!(disc(&[&[-2, 1], &[-1, 2]]), (1, 0, 1));
        assert_eq!(disc(&[&[1, 1, 1], &[1, 1, 1], &[-2, 1], &[-1, 2]]), (1, 4, 1));
        // A reciprocal complex quadruple: z^2 + z/2 + 1/2 and its mirror image.
        assert_eq!(disc(&[&[1, 1, 2], &[2, 1, 1]]), (2, 0, 2));
        assert_eq!(disc(&[&[0, 1], &[0, 1], &[1, 0, 0, 0, 1]]), (2, 4, 0));
        assert_eq!(disc(&[&[-1, 2], &[-1, 3], &[-3, 1], &[0, 1], &[-1, 1]]), (3, 1, 1));
        assert_eq!(disc(&[&[5, -6, 5], &[-1, 1], &[1, 1], &[-3, 1]]), (0, 4, 1));
    }

    #[test]
    fn singular_cases_of_the_half_plane() {
        assert_eq!(half_plane(&[&[-3]]), (0, 0, 0));
        assert_eq!(half_plane(&[&[0, 1]]), (0, 1, 0));
        assert_eq!(half_plane(&[&[1, 0, 1], &[1, 0, 1], &[1, 1]]), (1, 4, 0));
        assert_eq!(half_plane(&[&[-1, 0, 1]]), (1, 0, 1));
        assert_eq!(half_plane(&[&[1, 1, 1], &[1, -1, 1], &[0, 0, 1], &[-5, 1], &[-7, 1]]), (2, 2, 4));
        assert_eq!(half_plane(&[&[1, 1], &[2, 1], &[3, 1], &[-4, -1]]), (4, 0, 0));
    }
}
