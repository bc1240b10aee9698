//! A piece of the range of a parameter, and the share of it that a value is.

use super::family::{FamilyLoop, piece};
use super::family_function::Line;
use super::gain::{GainCells, NotSolved};
use super::moving::{BITS, MORE_BITS};
use super::windows::Never;
use crate::Range;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};

/// A piece in which `z` turns by more radians below the frequency beyond which no root is on the line is given up: next to a pole crossings have no end.
const MOST_TURNS: i64 = 256;

/// Where a piece is cut; nothing is likely to happen there.
const CUT: [i64; 2] = [509, 1024];

/// A piece of the range.
#[derive(Clone, Debug)]
pub(super) struct Share {
    pub lower: Rational,
    pub length: Rational,
}

impl Share {
    pub fn at(&self, share: &Rational) -> Rational {
        &self.lower + &(&self.length * share)
    }

    /// The upper half first.
    pub fn halves(&self) -> [Share; 2] {
        let part = Rational::new(CUT[0].into(), CUT[1].into());
        let middle = self.at(&part);
        let upper = Share { length: &self.length * &(Rational::ONE - &part), lower: middle };
        [upper, Share { lower: self.lower.clone(), length: &self.length * &part }]
    }

    /// A line in the parameter as one in the share.
    pub fn line(&self, line: &Line) -> Line {
        Line { slope: &line.slope * &self.length, offset: line.at(&self.lower) }
    }

    /// A polynomial in the parameter as one in the share.
    pub fn moved(&self, c: &UniPoly) -> Vec<Rational> {
        let line = Poly::new(vec![self.lower.clone(), self.length.clone()]);
        let zero = Poly::new(Vec::new());
        let sum = c
            .coeffs()
            .iter()
            .rev()
            .fold(zero, |sum: Poly<Rational>, c| sum.times(&line).plus(&Poly::new(vec![Rational::from(c)])));
        sum.into_coeffs()
    }

    /// The cells in the parameter; `None` where the piece is to be cut.
    pub fn cells(&self, family: &FamilyLoop, budget: &Budget) -> Result<Option<Result<GainCells, Never>>, NotSolved> {
        let ends = [Rational::ZERO, Rational::ONE];
        let range = Range::between(Some(Rational::ZERO), Some(Rational::ONE));
        let weights = budget.enter(|| family.weights(ends.each_ref()))?;
        let most = ends.iter().map(|end| family.dead_time(end)).max().expect("two ends");
        let turns = family.beyond_crossings(&weights, &range, budget)?.map(|frequency| frequency * most);
        if turns.is_some_and(|turns| turns > Rational::from(MOST_TURNS)) {
            return Ok(None);
        }
        for bits in [BITS, MORE_BITS] {
            match piece(&family.with_bits(bits), &range, budget) {
                Err(NotSolved::Coincidence | NotSolved::Unbounded) => {}
                Ok(Ok(mut cells)) => {
                    for point in &mut cells.points {
                        point.value = self.parameter(&point.value);
                    }
                    return Ok(Some(Ok(cells)));
                }
                found => return found.map(Some),
            }
        }
        Ok(None)
    }

    /// The value of the parameter at a share.
    pub fn parameter(&self, share: &Real) -> Real {
        match share.exact() {
            Some(share) => Real::from(self.at(&share)),
            None => Real::from(Transcendental::new(AtShare { piece: self.clone(), share: share.clone() })),
        }
    }
}

/// The value of the parameter at a share of a piece.
#[derive(Debug)]
struct AtShare {
    piece: Share,
    share: Real,
}

impl Enclosing for AtShare {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let narrow = Rational::dyadic(&Integer::ONE, bits) / &self.piece.length;
        let (lo, hi) = self.share.refined(&narrow).enclosure();
        Enclosure::new(self.piece.at(&lo), self.piece.at(&hi))
    }

    fn origin(&self) -> Origin {
        match &self.share {
            Real::Transcendental(share) => share.origin(),
            Real::Algebraic(_) => {
                Origin::Function { function: "the characteristic function".into(), details: Vec::new() }
            }
        }
    }
}
