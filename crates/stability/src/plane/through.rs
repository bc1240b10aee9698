//! Curves that touch a region in an extreme point alone, and bound it nowhere.

use super::curves::Curve;
use super::ground::Corner;
use super::limit::{Approach, Limit, Search, lower_frequency};
use crate::{Cause, Shape};
use jurist_algebra::ball::{Ball, common_root};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::MultiPoly;

impl Search<'_> {
    /// Adds the causes of curves other than the walls that pass through the extreme point, which is in a box.
    pub(super) fn add_touching(
        &self,
        limit: &mut Limit,
        approach: &Approach<'_>,
        (strip, greatest): (usize, bool),
        [x, y]: [&Enclosure; 2],
        bits: u64,
    ) -> Result<(), Exhausted> {
        let Some(wall) = approach.sides.iter().flatten().next() else { return Ok(()) };
        let edges = [&self.domain[1].lower, &self.domain[1].upper];
        let edge = (0..2).find(|&side| approach.sides[side].is_none()).and_then(|side| edges[side].as_ref());
        let corner = Corner {
            wall: approach.wall,
            sides: self.beside(strip, greatest, approach),
            heights: [y.lower(), y.upper()],
            edge,
        };
        let mut found: Vec<&Curve> = Vec::new();
        for (k, curve) in self.curves.iter().enumerate() {
            let is_known = approach.sides.contains(&Some(k)) || curve.polynomial.degree_in(1) == 0;
            let brings_none = curve.causes.iter().all(|cause| limit.causes.contains(cause));
            if is_known || brings_none || !self.may_vanish(&curve.polynomial, x, y, bits) {
                continue;
            }
            if self.p.ground().passes(self.curves, [*wall, k], &corner, self.budget)? {
                found.push(curve);
            }
        }
        let all = || found.iter().flat_map(|curve| curve.causes.iter()).chain(limit.causes.iter());
        // Where the loop is undefined no root can be named.
        let is_defined = !all().any(|cause| cause == Cause::Pole);
        let has_real = all().any(|cause| !matches!(cause, Cause::ComplexPair | Cause::Domain));
        for cause in found.iter().flat_map(|curve| curve.causes.iter()) {
            match cause {
                Cause::ComplexPair if is_defined && !limit.causes.contains(cause) => {
                    let root = self.common_root(x, y, bits);
                    // All roots are in the closed region: mirror pairs are on its boundary, and may be double real roots there.
                    if root.is_some() || !has_real {
                        limit.causes.insert(cause);
                        limit.half_size_root = lower_frequency(limit.half_size_root.take(), root);
                    }
                }
                Cause::ComplexPair => {}
                Cause::Pole | Cause::DegreeLost => limit.causes.insert(cause),
                _ if is_defined => limit.causes.insert(cause),
                _ => {}
            }
        }
        Ok(())
    }

    /// Numbers on either side of a wall, between which there is no other one.
    fn beside(&self, strip: usize, greatest: bool, approach: &Approach<'_>) -> [Rational; 2] {
        let next = if greatest { strip.checked_add(1) } else { strip.checked_sub(1) };
        let next = next.and_then(|k| self.strips.get(k));
        let beyond = match (next, approach.wall.exact()) {
            (None, Some(end)) => end,
            (None, None) => approach.far.clone(),
            (Some(next), _) => {
                let mut step = &approach.near - &approach.far;
                loop {
                    let point = &approach.far - &step;
                    if next.x.contains(&point) {
                        break point;
                    }
                    step *= &Rational::new(1.into(), 2.into());
                }
            }
        };
        if greatest { [approach.near.clone(), beyond] } else { [beyond, approach.near.clone()] }
    }

    fn may_vanish(&self, f: &MultiPoly, x: &Enclosure, y: &Enclosure, bits: u64) -> bool {
        self.p.ground().enclose(f, x, y, bits).contains(&Rational::ZERO)
    }

    /// The common root of the half-size pair on a box, where it is seen that there is one only, strictly inside the boundary.
    fn common_root(&self, x: &Enclosure, y: &Enclosure, bits: u64) -> Option<Enclosure> {
        let ball = |c: &MultiPoly| Ball::from_enclosure(&self.p.ground().enclose(c, x, y, bits), bits);
        let [a, b] = self.pair.each_ref().map(|f| f.coeffs().iter().map(ball).collect::<Vec<Ball>>());
        let root = common_root(&a, &b)?.to_enclosure();
        let is_inside = match self.region {
            Shape::UnitDisc => *root.lower() > Rational::from(-2) && *root.upper() < Rational::from(2),
            Shape::LeftHalfPlane => root.upper().is_negative(),
        };
        is_inside.then_some(root)
    }
}
