//! Whether cells on either side of a wall touch, where the wall is a zero of a polynomial over symbols.

use super::curves::{Curve, X, Y};
use super::decompose::Branch;
use super::glue::{Links, Wall, cell_of, separates};
use super::ground::{Corner, Ground, Projected, put};
use super::over_symbols::{OverSymbols, in_one};
use crate::Range;
use crate::precisions::TOUCHING_CELLS;
use jurist_algebra::ball::{Ball, common_root};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, simplest_between};
use jurist_algebra::real::Real;
use std::collections::BTreeMap;

/// All pairs of cells that touch along a piece of a wall, beyond those that clear segments showed.
///
/// Clear heights cut the neighbourhood of the wall into boxes. In a box in which the curves meet the wall in one point only, cells
/// strictly inside touch nothing along a piece. That is so
/// * of one curve with two branches in the box, on one side or on both: a limit of one branch alone is a simple zero on the wall or one
///   of odd order, from which the curve goes on to the other side;
/// * of two such curves whose branches change places, or which are known to have one common zero on the wall and have it there;
/// * of a curve with two branches on both sides that is known to have a double zero there, and no third one in the box;
/// * in a box that reaches to one edge of the domain, or to infinity, of curves with one branch on one side only: it leaves there; and of
///   any curves where these are seen not to meet a rational wall in the box.
///
/// # Errors
/// [`Exhausted`] when the budget runs out, and where none of this shows.
pub(super) fn links_over_symbols(
    ground: &OverSymbols,
    wall: &Wall<'_>,
    pairs: &[(usize, usize)],
    budget: &Budget,
) -> Result<Links, Exhausted> {
    let mut links = Links::new();
    if !wall.strips[0].lines[1].is_empty() {
        // A curve that contains the whole wall separates the strips.
        return Ok(links);
    }
    let mut open = pairs.to_vec();
    for bits in TOUCHING_CELLS.bits() {
        let near = Near::new(wall, bits, budget)?;
        for (cells, y) in near.clear.iter() {
            if open.contains(cells) {
                links.insert(*cells, [near.x[0].clone(), near.x[1].clone(), y.clone()]);
            }
            open.retain(|pair| pair != cells && !separates(*cells, *pair));
        }
        let mut left = Vec::new();
        for pair in open {
            if !near.holds_one_point(ground, near.box_of(pair), budget)? {
                left.push(pair);
            }
        }
        if left.is_empty() {
            return Ok(links);
        }
        open = left;
    }
    let place = wall.value.decimal(10);
    Err(TOUCHING_CELLS.exhausted(format!("whether cells touch at x = {place}")))
}

/// The neighbourhood of a wall.
struct Near<'a> {
    wall: &'a Wall<'a>,
    /// On the left and on the right of it.
    x: [Rational; 2],
    branches: [Vec<(Real, Branch)>; 2],
    /// Heights at which no curve meets the wall or what is between `x`, ascending, with the cells that hold them.
    clear: Vec<((usize, usize), Rational)>,
}

impl<'a> Near<'a> {
    fn new(wall: &'a Wall<'a>, bits: u64, budget: &Budget) -> Result<Near<'a>, Exhausted> {
        let (left, right) = wall.either_side(bits);
        let branches = [wall.branches(&left, budget)?, wall.branches(&right, budget)?];
        let sides = branches.each_ref().map(|list| list.iter().map(|b| b.0.clone()).collect::<Vec<Real>>());
        let mut clear = Vec::new();
        for y in wall.gaps(&sides, budget)? {
            let cells = (cell_of(&sides[0], &y), cell_of(&sides[1], &y));
            // On the wall there may be a point of a curve that has no branch beside it, at this height, and at few others.
            let step = Rational::dyadic(&1.into(), bits / 4);
            for height in [y.clone(), &y + &step, &y - &step] {
                let is_same = wall.y_domain.contains(&height)
                    && cells == (cell_of(&sides[0], &height), cell_of(&sides[1], &height));
                if is_same && wall.is_clear(&left, &right, &height, budget)? {
                    clear.push((cells, height));
                    break;
                }
            }
        }
        Ok(Near { wall, x: [left, right], branches, clear })
    }

    /// The box in which a pair that no clear height joins or separates could touch, by the number of the height above it.
    fn box_of(&self, pair: (usize, usize)) -> usize {
        // The heights that are not below both cells or in one of them and below the other.
        self.clear.iter().take_while(|((l, r), _)| *l <= pair.0 && *r <= pair.1).count()
    }

    /// Whether the curves meet the wall in one point at most in a box, or at an edge of the domain only.
    fn holds_one_point(&self, ground: &OverSymbols, number: usize, budget: &Budget) -> Result<bool, Exhausted> {
        let below = number.checked_sub(1).map(|k| &self.clear[k]);
        let above = self.clear.get(number);
        // The branches in the box: as many as there are between the cells of both heights.
        let inside = |side: usize| {
            let cell = |height: &((usize, usize), Rational)| [height.0.0, height.0.1][side];
            let all = &self.branches[side];
            &all[below.map_or(0, cell)..above.map_or(all.len(), cell)]
        };
        let mut counts: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
        for side in [0, 1] {
            for (_, branch) in inside(side) {
                counts.entry(branch.curve).or_default()[side] += 1;
            }
        }
        let (below, above) = match (below, above) {
            (None, None) => return Ok(false),
            (Some((_, below)), Some((_, above))) => (below, above),
            (below, above) => {
                let leave = counts.values().all(|[l, r]| l + r <= 1);
                return Ok(leave || self.is_empty(ground, [below, above].map(|end| end.map(|(_, y)| y)), budget)?);
            }
        };
        for (&curve, [l, r]) in &counts {
            let is_one = l + r <= 2 || (*l.max(r) == 2 && self.is_double(ground, curve, [below, above], budget)?);
            if !is_one {
                return Ok(false);
            }
        }
        let curves: Vec<usize> = counts.keys().copied().collect();
        for pair in curves.windows(2) {
            let single = pair.iter().all(|curve| counts[curve] == [1, 1]);
            let order = |side: usize| inside(side).iter().position(|(_, branch)| branch.curve == pair[0]);
            let other = |side: usize| inside(side).iter().position(|(_, branch)| branch.curve == pair[1]);
            let changes_places = single && (order(0) < other(0)) != (order(1) < other(1));
            if !changes_places && !self.meet(ground, [pair[0], pair[1]], [below, above], budget)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether the wall is a rational number, and no curve meets it between two heights.
    fn is_empty(
        &self,
        ground: &OverSymbols,
        [below, above]: [Option<&Rational>; 2],
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let Some(x) = self.wall.value.exact() else { return Ok(false) };
        let Range { lower, upper } = self.wall.y_domain;
        let between = [below.or(lower.as_ref()), above.or(upper.as_ref())];
        for curve in self.wall.curves.iter().filter(|c| c.polynomial.degree_in(Y) > 0) {
            let zeros = ground.zeros(&put(&curve.polynomial, X, &x), Y, between, budget)?;
            if zeros.is_none_or(|zeros| !zeros.is_empty()) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether two curves have exactly one common zero on the wall, and that in a box.
    fn meet(
        &self,
        ground: &OverSymbols,
        [i, j]: [usize; 2],
        inside: [&Rational; 2],
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        meet_on(ground, self.wall.curves, [i, j], (self.wall.value, &self.x), inside, budget)
    }

    /// Whether a curve has a double zero on the wall in a box, and no other zero there.
    fn is_double(
        &self,
        ground: &OverSymbols,
        curve: usize,
        inside: [&Rational; 2],
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let curves = self.wall.curves;
        if !ground.changes_sign(Projected::Discriminant(curve), curves, [&self.x[0], &self.x[1]], budget)? {
            return Ok(false);
        }
        let x = narrow(self.wall.value, &self.x);
        let f = curves[curve].polynomial.as_poly_in(Y);
        let slope = f.derivative();
        let (value, first) = (ground.over(&f, &x), ground.over(&slope, &x));
        let root = budget.enter(|| common_root(&value, &first))?;
        if !root.is_some_and(|root| is_between(&root, inside)) {
            return Ok(false);
        }
        // The second derivative keeps its sign: there are two zeros at most.
        let y = Ball::between(inside[0], inside[1], x.bits());
        let second = ground.over(&slope.derivative(), &x);
        let zero = Ball::zero(x.bits());
        Ok(second.iter().rev().fold(zero, |sum, c| sum.mul(&y).add(c)).sign().is_some())
    }
}

/// Whether two curves have exactly one common zero on a wall, and that between two heights.
fn meet_on(
    ground: &OverSymbols,
    curves: &[Curve],
    [i, j]: [usize; 2],
    (wall, x): (&Real, &[Rational; 2]),
    inside: [&Rational; 2],
    budget: &Budget,
) -> Result<bool, Exhausted> {
    if !ground.changes_sign(Projected::Resultant(i, j), curves, [&x[0], &x[1]], budget)? {
        return Ok(false);
    }
    let x = narrow(wall, x);
    let over = |k: usize| ground.over(&curves[k].polynomial.as_poly_in(Y), &x);
    let root = budget.enter(|| common_root(&over(i), &over(j)))?;
    Ok(root.is_some_and(|root| is_between(&root, inside)))
}

/// Whether the second curve passes through the point that the first one ends in ([`Ground::passes`]).
pub(super) fn passes_over_symbols(
    ground: &OverSymbols,
    curves: &[Curve],
    [i, j]: [usize; 2],
    corner: &Corner<'_>,
    budget: &Budget,
) -> Result<bool, Exhausted> {
    match (corner.wall.exact(), corner.edge) {
        (Some(x), Some(y)) => Ok(ground.sign(&put(&put(&curves[j].polynomial, X, &x), Y, y), budget)?.is_eq()),
        (None, Some(y)) => {
            let [left, right] = &corner.sides;
            ground.changes_sign(Projected::AtEdge(j, y), curves, [left, right], budget)
        }
        (Some(x), None) => {
            has_common_zero(ground, [i, j].map(|k| (&curves[k].polynomial, X, &x, Y)), corner.heights, budget)
        }
        (None, None) => {
            // Curves that mirror themselves meet the wall twice at once, at a height that is a short number.
            let [below, above] = corner.heights;
            let [left, right] = &corner.sides;
            let at = |y: &Rational| {
                let both = [i, j].map(|k| (&curves[k].polynomial, Y, y, X));
                has_common_zero(ground, both, [left, right], budget)
            };
            Ok(simplest_between(below, above).map_or(Ok(false), |y| at(&y))?
                || meet_on(ground, curves, [i, j], (corner.wall, &corner.sides), corner.heights, budget)?)
        }
    }
}

/// Whether two curves, each with a number in the place of one parameter, have a common zero in the other one between two numbers, where
/// the first curve has one zero.
fn has_common_zero(
    ground: &OverSymbols,
    both: [(&MultiPoly, usize, &Rational, usize); 2],
    [below, above]: [&Rational; 2],
    budget: &Budget,
) -> Result<bool, Exhausted> {
    let both = both.map(|(f, set, value, free)| in_one(&put(f, set, value), free));
    if both.iter().any(MultiPoly::is_zero) {
        return Ok(false);
    }
    let common = ground.symbols.greatest_common_divisor(&both, budget)?;
    let simple = ground.symbols.square_free_part(&common, budget)?;
    let sign = |value: &Rational| {
        let (number, _) = simple.substitute(0, value);
        ground.symbols.sign(&number.map_variables(|i| i.saturating_sub(1)), budget)
    };
    let below = sign(below)?;
    Ok(below.is_eq() || below != sign(above)?)
}

/// A wall between two numbers, as narrowly as it is known there.
fn narrow(wall: &Real, [left, right]: &[Rational; 2]) -> Ball {
    let bits = 128 + 2 * (right - left).denominator().bit_length();
    let width = Rational::dyadic(&1.into(), bits);
    let (lo, hi) = wall.refined(&width).enclosure();
    Ball::between(&lo, &hi, bits)
}

/// Whether a number is between two others for certain.
fn is_between(x: &Ball, [below, above]: [&Rational; 2]) -> bool {
    *below < x.lower() && x.upper() < *above
}
