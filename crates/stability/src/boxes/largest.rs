//! The largest factor as a bracket, and points that are not stable.

use super::prove::BoxProof;
use super::reason::OpenReason;
use super::search::Crossing;
use crate::AtPoint;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;

/// A point that is not stable.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Witness {
    /// The values of the parameters.
    pub point: Vec<Rational>,
    /// The certain root count there; `None` where the loop alone does not tell it, and only the model can.
    pub at: Option<AtPoint>,
}

impl Witness {
    /// A point and its certain root count.
    pub fn new(point: Vec<Rational>, at: AtPoint) -> Witness {
        Witness { point, at: Some(at) }
    }

    /// A point that is not counted yet.
    pub fn uncounted(point: Vec<Rational>) -> Witness {
        Witness { point, at: None }
    }
}

/// A bracket of the largest factor.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LargestFactor {
    /// The box of this factor is stable.
    pub lower: Rational,
    /// Its proof; none at the factor 0 of a box that is only the nominal point.
    pub proof: Option<BoxProof>,
    /// The box of this factor is not stable; `None` where no such factor was found.
    pub upper: Option<Rational>,
    /// The direction of the worst point that was found: of each parameter the share of its width, from -1 to 1.
    pub direction: Option<Vec<Rational>>,
    /// How much of the margin each parameter uses; the shares add up to 1.
    pub shares: Option<Vec<Rational>>,
    /// A point that is not stable, just beyond.
    pub witness: Option<Witness>,
    /// Where the proof of a closer bracket ended.
    pub open: Option<(OpenReason, Vec<[Rational; 2]>)>,
    pub(super) crossing: Option<Crossing>,
}

impl LargestFactor {
    /// The bracket of a factor whose line ends at a known number, of relative width `gap`. The number 1 is not inside of it.
    ///
    /// Cost: the digits of the end that `gap` asks for.
    pub fn before(end: &Real, direction: Vec<Rational>, gap: &Rational) -> LargestFactor {
        let width = &(gap * &end.refined_to_digits(1).enclosure().0) * &Rational::new(1.into(), 8.into());
        let (low, high) = end.refined(&width).enclosure();
        let (mut lower, mut upper) = (lowered(&low, gap), high);
        match end.compare_rational(&Rational::ONE).is_gt() {
            true => lower = lower.max(Rational::ONE),
            false => upper = upper.min(Rational::ONE),
        }
        let bare = LargestFactor::bare(lower, BoxProof::of_line());
        LargestFactor { upper: Some(upper), direction: Some(direction), shares: Some(vec![Rational::ONE]), ..bare }
    }

    /// What is known where all boxes below a factor are stable, and nothing of larger ones.
    pub fn at_least(factor: Rational, gap: &Rational) -> LargestFactor {
        LargestFactor::bare(lowered(&factor, gap), BoxProof::of_line())
    }

    fn bare(lower: Rational, proof: BoxProof) -> LargestFactor {
        LargestFactor {
            lower,
            proof: Some(proof),
            upper: None,
            direction: None,
            shares: None,
            witness: None,
            open: None,
            crossing: None,
        }
    }
}

/// A number of few digits that is smaller than `end` by between `gap / 2` and `gap` of it.
pub(super) fn lowered(end: &Rational, gap: &Rational) -> Rational {
    let target = end * &(&Rational::ONE - &(gap * &Rational::new(3.into(), 4.into())));
    let size = |x: &Rational| x.numerator().bit_length() as i64 - x.denominator().bit_length() as i64;
    // Rounded down to a multiple of a power of two below a quarter of the gap.
    let bits = (4 - size(&(end * gap))).max(0) as u64;
    let scaled = &target * &Rational::from(Integer::ONE << bits);
    Rational::dyadic(&scaled.floor(), bits)
}
