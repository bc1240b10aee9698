//! A requirement as a family of loops over tolerances: "stable" is read as "meets the requirement".

use super::requirement_boxes::{OverPoints, RequirementBoxes};
use crate::stability::AtPoint;
use crate::stability::boxes::{BoxLook, BoxProof, Family, Gradient, OpenReason, Outcome, Path};
use crate::stability::subdivision::{BoxPart, Look, Order, Tally, decided, subdivide};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};

/// Work of a look, in units of a budget.
const WORK: u64 = 2000;

/// A box is cut into so many parts at most.
const MOST_PARTS: usize = 600;

/// A part is not halved more often along one parameter.
const MOST_HALVINGS: u32 = 40;

/// After so many parts a point of the present one is tested.
const TESTED_EVERY: usize = 4;

/// The search begins towards all corners of so many parameters.
const MOST_FOR_CORNERS: usize = 4;

/// A parameter is moved by this share of its place on the line, where it is asked how the end moves with it.
const MOVED: u64 = 8;

/// Halvings that find an end, beside a moved one.
const HALVINGS: u32 = 24;

/// One requirement of stable loops.
pub(crate) struct RequiredFamily<'a> {
    boxes: RequirementBoxes,
    parameters: usize,
    budget: &'a Budget,
}

impl<'a> RequiredFamily<'a> {
    /// Of so many parameters.
    pub fn new(boxes: RequirementBoxes, parameters: usize, budget: &'a Budget) -> Self {
        RequiredFamily { boxes, parameters, budget }
    }

    /// Whether a point is seen to meet the requirement. A budget that runs out is noticed by who asks next.
    fn meets(&self, point: &[Rational]) -> bool {
        self.told(point) == Some(true)
    }

    /// Whether a point meets the requirement, where that is seen.
    fn told(&self, point: &[Rational]) -> Option<bool> {
        checkpoint(WORK);
        self.boxes.meets(point, self.budget).ok().flatten()
    }
}

impl Family for RequiredFamily<'_> {
    type Line<'l>
        = RequiredLine<'l>
    where
        Self: 'l;

    fn parameters(&self) -> usize {
        self.parameters
    }

    fn count(&self, _point: &[Rational]) -> Option<AtPoint> {
        None
    }

    fn is_stable_at(&self, point: &[Rational]) -> bool {
        self.meets(point)
    }

    fn signs_at(&self, _point: &[Rational]) -> Option<(Vec<Sign>, i64)> {
        Some((Vec::new(), 0))
    }

    fn line<'l>(&'l self, base: Vec<Rational>, step: Vec<Rational>, _reference: &'l [Sign]) -> RequiredLine<'l> {
        RequiredLine { of: self, base, step }
    }

    /// Towards the corners of few parameters, and along each of many: what a margin is near to is not known before it ends.
    fn pulls(&self, point: &[Rational], _scale: i64) -> Vec<Vec<Rational>> {
        let n = point.len();
        let unit = |is_up: bool| if is_up { Rational::ONE } else { -Rational::ONE };
        if n <= MOST_FOR_CORNERS {
            return (0..1usize << n).map(|mask| (0..n).map(|i| unit(mask >> i & 1 == 1)).collect()).collect();
        }
        let along = |k: usize| (0..n).map(|i| if i == k / 2 { unit(k % 2 == 1) } else { Rational::ZERO }).collect();
        (0..2 * n).map(along).collect()
    }

    /// A box all of whose parts meet the requirement.
    fn prove(
        &self,
        sides: &[[Rational; 2]],
        _known: (&[Sign], i64),
        cells: usize,
        budget: &Budget,
    ) -> Result<Outcome, Exhausted> {
        let most = cells.min(MOST_PARTS);
        let look = |part: &mut BoxPart, tally: Tally| {
            checkpoint(WORK);
            let middle = || part.sides.iter().map(|[low, high]| low.midpoint(high)).collect::<Vec<Rational>>();
            match self.boxes.look(&part.sides, budget)? {
                OverPoints::All => return Ok(Look::Decided(())),
                OverPoints::None => return Ok(Look::Open(Outcome::Refuted(middle()))),
                OverPoints::Open { .. } => {}
            }
            let is_last = tally.cells() >= most;
            if (is_last || tally.halved.is_multiple_of(TESTED_EVERY)) && self.told(&middle()) == Some(false) {
                return Ok(Look::Open(Outcome::Refuted(middle())));
            }
            let axis = axis_to_cut(part);
            let why = if is_last { OpenReason::Cells } else { OpenReason::Small };
            let open = || Look::Open(Outcome::Open { why, cell: part.sides.clone() });
            Ok(axis.filter(|_| !is_last).map_or_else(open, Look::Cut))
        };
        let whole = BoxPart::whole(sides.to_vec());
        Ok(match subdivide([whole], Order::Depth, budget, look)? {
            Ok(steps) => Outcome::Stable(BoxProof::of_cells(0, decided(steps).count())),
            Err(outcome) => outcome,
        })
    }

    fn looks(&self) -> impl Fn(&BoxPart, &Budget) -> Result<BoxLook, Exhausted> {
        |part, budget| {
            checkpoint(WORK);
            Ok(match self.boxes.look(&part.sides, budget)? {
                OverPoints::All => BoxLook::Stable,
                OverPoints::None => BoxLook::Unstable,
                OverPoints::Open { .. } => BoxLook::Open(axis_to_cut(part).unwrap_or(0)),
            })
        }
    }
}

/// The side that was halved least, of those that are wide.
fn axis_to_cut(part: &BoxPart) -> Option<usize> {
    let is_wide = |i: &usize| part.sides[*i][0] < part.sides[*i][1] && part.halvings[*i] < MOST_HALVINGS;
    (0..part.sides.len()).filter(is_wide).min_by_key(|&i| part.halvings[i])
}

/// The requirement on the line `base + t step`.
pub(crate) struct RequiredLine<'l> {
    of: &'l RequiredFamily<'l>,
    base: Vec<Rational>,
    step: Vec<Rational>,
}

impl RequiredLine<'_> {
    /// Where the requirement ceases to be met between two places, with one parameter moved; `None` where it does not.
    fn end(&self, (lo, hi): (&Rational, &Rational), moved: Option<(usize, &Rational)>) -> Option<Rational> {
        let meets = |t: &Rational| {
            let mut point = self.point(t);
            if let Some((i, by)) = moved {
                point[i] = &point[i] + by;
            }
            self.of.meets(&point)
        };
        let (mut lo, mut hi) = (lo.clone(), hi.clone());
        if !meets(&lo) || meets(&hi) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = lo.midpoint(&hi);
            if meets(&middle) { lo = middle } else { hi = middle }
        }
        Some(lo.midpoint(&hi))
    }
}

impl Path for RequiredLine<'_> {
    fn point(&self, t: &Rational) -> Vec<Rational> {
        self.base.iter().zip(&self.step).map(|(b, s)| b + &(s * t)).collect()
    }

    fn is_good(&self, t: &Rational) -> bool {
        self.of.meets(&self.point(t))
    }

    fn is_stable(&self, t: &Rational) -> bool {
        self.is_good(t)
    }

    /// By how the end moves with each parameter: a share of the way there.
    fn gradient(&self, lo: &Rational, hi: &Rational) -> Option<Gradient> {
        let share = Rational::dyadic(&Integer::ONE, MOVED);
        let room = hi * &Rational::dyadic(&Integer::ONE, 2);
        let ends = ((lo - &room).max(Rational::ZERO), hi + &room);
        let here = self.end((&ends.0, &ends.1), None)?;
        let slope = |(i, step): (usize, &Rational)| {
            let by = &(step * hi) * &share;
            if by.is_zero() {
                return Some(Rational::ZERO);
            }
            let there = self.end((&ends.0, &ends.1), Some((i, &by)))?;
            (&there - &here).checked_div(&by)
        };
        let slopes = self.step.iter().enumerate().map(slope).collect::<Option<Vec<Rational>>>()?;
        Gradient::new(slopes, &self.step)
    }
}
