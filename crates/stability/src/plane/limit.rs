//! Where a stable region ends in either parameter, and what limits it there.

use super::curves::{Curve, PlanePolynomial, exchanged};
use super::decompose::{StabilityMap, Strip, branches_at, in_y, swapped_curve};
use super::ground::Beside;
use crate::precisions::LIMIT_OF_CELL;
use crate::{Cause, Causes, ComplexPair, End, HalfSizePair, Range, RealInterval, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{MultiPoly, Poly};
use jurist_algebra::real::Real;

/// An extreme value of one parameter on a region's boundary, and what happens there.
#[derive(Clone, Debug)]
pub struct Limit {
    /// The exact value.
    pub value: Real,
    /// The mechanisms of the walls that meet there.
    pub causes: Causes,
    /// Enclosures of the places, `x` first: one for each cell that ends there. None where the region ends along
    /// a whole line or at infinity of the other parameter.
    pub at: Vec<[Enclosure; 2]>,
    /// Whether the region ends along a line: an edge of the domain, or a line that is part of a curve.
    pub along_line: bool,
    /// For a complex pair, an enclosure of `2 cos(theta)` or of `-omega^2` there; of the lowest frequency, if
    /// there are several.
    pub half_size_root: Option<Enclosure>,
}

/// The extreme values of one region; `None` where it is unbounded.
#[derive(Clone, Debug)]
pub struct RegionLimits {
    /// The least and the greatest `x`.
    pub x: [Option<Limit>; 2],
    /// The least and the greatest `y`.
    pub y: [Option<Limit>; 2],
}

/// What limits each region of a map, places and frequencies to about so many digits.
///
/// A place is enclosed by two lines that the walls of the last cell do not cross between a point close to
/// the end and the end itself, and a frequency by two values that the half-size pair excludes on that box:
/// both are proved, by isolation of real roots and by interval arithmetic.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn region_limits(
    map: &StabilityMap,
    p: &PlanePolynomial,
    domain: &[Range; 2],
    region: Shape,
    digits: usize,
    budget: &Budget,
) -> Result<Vec<RegionLimits>, Exhausted> {
    budget.step("limits of the regions");
    let budget = &budget.silent();
    let pair = HalfSizePair::new(p.polynomial(), p.formal_degree().max(1), region);
    let swapped_pair = [pair.a.map(exchanged), pair.b.map(exchanged)];
    let (swapped, swapped_curves) = (p.swapped(), map.curves.iter().map(swapped_curve).collect::<Vec<_>>());
    let swapped_domain = [domain[1].clone(), domain[0].clone()];
    let along_x =
        Search { p, curves: &map.curves, strips: &map.strips, domain, region, pair: &[pair.a, pair.b], digits, budget };
    let along_y = Search {
        p: &swapped,
        curves: &swapped_curves,
        strips: &map.exchanged,
        domain: &swapped_domain,
        region,
        pair: &swapped_pair,
        digits,
        budget,
    };
    let mut out = Vec::with_capacity(map.regions.len());
    for r in &map.regions {
        let x = [along_x.limit(&r.cells, false)?, along_x.limit(&r.cells, true)?];
        let exchanged = |limit: Option<Limit>| {
            limit.map(|limit| Limit { at: limit.at.into_iter().map(|[y, x]| [x, y]).collect(), ..limit })
        };
        let y = [along_y.limit(&r.exchanged_cells, false)?, along_y.limit(&r.exchanged_cells, true)?];
        out.push(RegionLimits { x, y: y.map(exchanged) });
    }
    Ok(out)
}

/// The search for limits in the first parameter of a decomposition.
pub(super) struct Search<'a> {
    pub(super) p: &'a PlanePolynomial,
    pub(super) curves: &'a [Curve],
    pub(super) strips: &'a [Strip],
    pub(super) domain: &'a [Range; 2],
    pub(super) region: Shape,
    /// The half-size pair.
    pub(super) pair: &'a [Poly<MultiPoly>; 2],
    digits: usize,
    pub(super) budget: &'a Budget,
}

/// The end of a cell: a vertical line from `near`, inside the strip, to `far`, on or just beyond the wall.
pub(super) struct Approach<'a> {
    pub(super) wall: &'a Real,
    pub(super) near: Rational,
    pub(super) far: Rational,
    below: Option<Real>,
    above: Option<Real>,
    /// The curves below and above.
    pub(super) sides: [Option<usize>; 2],
    /// Points of the cells below and above, where those are stable too.
    beyond: [Option<Rational>; 2],
}

impl Search<'_> {
    /// The limit of a region made of these cells, greatest or least.
    fn limit(&self, cells: &[(usize, usize)], greatest: bool) -> Result<Option<Limit>, Exhausted> {
        let numbers = cells.iter().map(|c| c.0);
        let Some(strip) = (if greatest { numbers.max() } else { numbers.min() }) else { return Ok(None) };
        let x = &self.strips[strip].x;
        let Some(wall) = (if greatest { x.upper.as_ref() } else { x.lower.as_ref() }) else { return Ok(None) };
        let mut found: Option<Limit> = None;
        for cell in cells.iter().filter(|c| c.0 == strip) {
            let limit = self.limit_of_cell(strip, cell.1, wall, greatest)?;
            found = Some(match found {
                None => limit,
                Some(mut first) => {
                    for cause in limit.causes.iter() {
                        first.causes.insert(cause);
                    }
                    first.at.extend(limit.at);
                    first.along_line |= limit.along_line;
                    first.half_size_root = lower_frequency(first.half_size_root, limit.half_size_root);
                    first
                }
            });
        }
        Ok(found)
    }

    fn limit_of_cell(&self, strip: usize, cell: usize, wall: &Real, greatest: bool) -> Result<Limit, Exhausted> {
        let end = if greatest { &self.domain[0].upper } else { &self.domain[0].lower };
        let at_domain = end.is_some() && *end == wall.exact();
        let on_wall = &self.strips[strip].lines[usize::from(greatest)];
        let lines: Vec<bool> = (0..self.curves.len()).map(|k| on_wall.contains(&k)).collect();
        let along_line = at_domain || lines.contains(&true);
        let mut limit = Limit {
            value: wall.clone(),
            causes: Causes::default(),
            at: Vec::new(),
            along_line: false,
            half_size_root: None,
        };
        // Roots on a line do not depend on the other parameter; a pair's constraint may be that of a double root.
        let on_lines = self.curves.iter().zip(&lines).filter(|(_, line)| **line).flat_map(|(c, _)| c.causes.iter());
        let on_lines: Vec<Cause> = on_lines.filter(|cause| *cause != Cause::ComplexPair).collect();
        // As many places of the wall as other curves can end in, at least one.
        let corners = 1 + self.curves.iter().map(|c| c.polynomial.degree_in(1)).sum::<u32>();
        for bits in LIMIT_OF_CELL.bits() {
            self.budget.check()?;
            let approach = self.approach(strip, cell, wall, greatest, bits)?;
            let last = bits >= LIMIT_OF_CELL.last;
            let rounds = if last { corners.ilog2() + 2 } else { 2 };
            if along_line && let Some(end) = self.end_on_line(&approach, &lines, rounds)? {
                limit.causes = end.causes;
                limit.along_line = true;
                return Ok(limit);
            }
            let place = self.place(&approach)?.filter(|y| last || self.is_fine(y));
            if let Some(y) = place {
                let ends = self.walls_beside(&approach)?;
                let x = ordered(&approach.near, &approach.far);
                let roots: Vec<Option<Enclosure>> =
                    ends.iter().filter_map(|e| e.pair.as_ref()).map(|pair| self.tracked(pair, &x, &y, bits)).collect();
                if last || roots.iter().all(Option::is_some) {
                    self.add_causes(&mut limit, &ends, &approach, at_domain);
                    on_lines.iter().for_each(|cause| limit.causes.insert(*cause));
                    limit.half_size_root = roots.into_iter().fold(None, lower_frequency);
                    self.add_touching(&mut limit, &approach, (strip, greatest), [&x, &y], 4 * bits + 256)?;
                    limit.at.push([x, y]);
                    return Ok(limit);
                }
            } else if last {
                // The walls run to infinity.
                let ends = self.walls_beside(&approach)?;
                self.add_causes(&mut limit, &ends, &approach, at_domain);
                on_lines.iter().for_each(|cause| limit.causes.insert(*cause));
                return Ok(limit);
            }
        }
        unreachable!("the last attempt ends with a limit")
    }

    fn add_causes(&self, limit: &mut Limit, ends: &[End], approach: &Approach<'_>, at_domain: bool) {
        for cause in ends.iter().flat_map(|e| e.causes.iter()) {
            limit.causes.insert(cause);
        }
        let edge = |side: usize, end: &Option<Rational>| approach.sides[side].is_none() && end.is_some();
        if at_domain || edge(0, &self.domain[1].lower) || edge(1, &self.domain[1].upper) {
            limit.causes.insert(Cause::Domain);
        }
    }

    /// A vertical line through the cell about `2^-bits` from the wall.
    fn approach<'w>(
        &self,
        strip: usize,
        cell: usize,
        wall: &'w Real,
        greatest: bool,
        bits: u64,
    ) -> Result<Approach<'w>, Exhausted> {
        let mut bits = bits;
        let (near, far) = loop {
            let step = Rational::dyadic(&Integer::ONE, bits);
            let (lo, hi) = wall.refined(&step).enclosure();
            let (near, far) = if greatest { (&lo - &step, hi) } else { (&hi + &step, lo) };
            if self.strips[strip].x.contains(&near) {
                break (near, far);
            }
            bits += 2;
        };
        let branches = branches_at(&**self.p.ground(), self.curves, &near, &self.domain[1], self.budget)?;
        let beside = |i: Option<usize>| i.and_then(|i| branches.get(i));
        let (below, above) = (beside(cell.checked_sub(1)), beside(Some(cell)));
        let sides = [below.map(|b| b.1.curve), above.map(|b| b.1.curve)];
        let edge = |end: &Option<Rational>| end.clone().map(Real::from);
        let value = |b: Option<&(Real, _)>, end| b.map(|b| b.0.clone()).or_else(|| edge(end));
        let point = |cell: Option<usize>| -> Result<Option<Rational>, Exhausted> {
            let Some(cell) = cell.filter(|&k| self.strips[strip].cells.get(k).is_some_and(|c| c.stable)) else {
                return Ok(None);
            };
            let lower = value(beside(cell.checked_sub(1)), &self.domain[1].lower);
            let upper = value(beside(Some(cell)), &self.domain[1].upper);
            RealInterval { lower, upper }.sample(self.budget).map(Some)
        };
        let beyond = [point(cell.checked_sub(1))?, point(Some(cell + 1))?];
        let (below, above) = (value(below, &self.domain[1].lower), value(above, &self.domain[1].upper));
        Ok(Approach { wall, near, far, below, above, sides, beyond })
    }

    /// A point of the cell on the near line.
    fn inside(&self, approach: &Approach<'_>) -> Result<Rational, Exhausted> {
        RealInterval { lower: approach.below.clone(), upper: approach.above.clone() }.sample(self.budget)
    }

    /// Where a line or the domain's edge ends the region: what `intervals` says on a horizontal line from
    /// the cell to the wall that no other curve meets. Another curve may end in the wall right there, so that lines halfway
    /// between those tried and the walls of the cell are tried too, as often as is said.
    fn end_on_line(&self, approach: &Approach<'_>, lines: &[bool], rounds: u32) -> Result<Option<End>, Exhausted> {
        let mut tried = vec![approach.below.clone(), approach.above.clone()];
        for _ in 0..rounds {
            let mut next = Vec::with_capacity(2 * tried.len());
            for k in 1..tried.len() {
                let (lower, upper) = (tried[k - 1].clone(), tried[k].clone());
                let middle = RealInterval { lower: lower.clone(), upper }.sample(self.budget)?;
                if self.is_clear_beside(lines, &middle, approach)? {
                    return self.end_at(&middle, approach);
                }
                next.extend([lower, Some(middle.into())]);
            }
            next.push(approach.above.clone());
            tried = next;
        }
        Ok(None)
    }

    /// Whether no curve that is not part of the wall meets a horizontal line between the near point and the wall.
    fn is_clear_beside(&self, lines: &[bool], y: &Rational, approach: &Approach<'_>) -> Result<bool, Exhausted> {
        for (curve, _) in self.curves.iter().zip(lines).filter(|(_, line)| !**line) {
            if !self.is_clear(curve, y, approach)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// What happens on the wall at the end of a horizontal line that is clear.
    fn end_at(&self, y: &Rational, approach: &Approach<'_>) -> Result<Option<End>, Exhausted> {
        let swapped = self.p.swapped();
        let mut walls = [None, None];
        walls[usize::from(approach.near < approach.far)] = Some(approach.wall);
        let inside = approach.near.clone();
        let beside = Beside { walls, only_pair: [false; 2], inside, beyond: [None, None] };
        let ends = swapped.ground().ends(&swapped, y, &beside, (&self.domain[0], self.region), self.budget)?;
        Ok(ends.into_iter().next())
    }

    /// Whether a curve does not meet a horizontal line between the near point and the wall.
    fn is_clear(&self, curve: &Curve, y: &Rational, approach: &Approach<'_>) -> Result<bool, Exhausted> {
        let mut ends = [&approach.near, &approach.far];
        ends.sort();
        self.p.ground().is_clear(&curve.polynomial, ends, y, self.budget)
    }

    /// An interval of the other parameter that holds the ends of both walls of the cell: their values at
    /// the near point, with as much to either side as it takes for the lines to be clear.
    fn place(&self, approach: &Approach<'_>) -> Result<Option<Enclosure>, Exhausted> {
        let (Some(below), Some(above)) = (&approach.below, &approach.above) else { return Ok(None) };
        let (low, high) = apart(below, above);
        let width = &high - &low;
        for factor in [1, 4, 16, 64, 256] {
            let room = &width * Rational::from(factor);
            let side = |side: usize, y: Rational| -> Result<Option<Rational>, Exhausted> {
                match approach.sides[side] {
                    // An edge of the domain stays where it is.
                    None => Ok(Some(if side == 0 { low.clone() } else { high.clone() })),
                    Some(curve) => Ok(self.is_clear(&self.curves[curve], &y, approach)?.then_some(y)),
                }
            };
            if let (Some(a), Some(b)) = (side(0, &low - &room)?, side(1, &high + &room)?) {
                return Ok(Some(Enclosure::new(a, b)));
            }
        }
        Ok(None)
    }

    fn is_fine(&self, y: &Enclosure) -> bool {
        let scale = y.lower().abs().max(y.upper().abs()).min(Rational::ONE);
        let tolerance = Rational::new(Integer::ONE, Integer::from(10).pow(self.digits as u64 + 3));
        y.upper() - y.lower() <= scale * tolerance
    }

    /// The walls of the cell at the near point, with what happens on them.
    fn walls_beside(&self, approach: &Approach<'_>) -> Result<Vec<End>, Exhausted> {
        let curve = |side: usize| approach.sides[side].map(|curve| &self.curves[curve]);
        let only_pair =
            [0, 1].map(|side| curve(side).is_some_and(|curve| curve.causes.iter().eq([Cause::ComplexPair])));
        let value = |side: usize| curve(side).and([&approach.below, &approach.above][side].as_ref());
        let inside = self.inside(approach)?;
        let beside = Beside { walls: [value(0), value(1)], only_pair, inside, beyond: approach.beyond.clone() };
        self.p.ground().ends(self.p, &approach.near, &beside, (&self.domain[1], self.region), self.budget)
    }

    /// The half-size root of a pair, followed from the near point to the end: it stays between two values
    /// that are no common roots of the half-size pair anywhere on the box.
    fn tracked(&self, pair: &ComplexPair, x: &Enclosure, y: &Enclosure, bits: u64) -> Option<Enclosure> {
        // log2(10) < 10/3
        let wanted = (self.digits as u64 + 3) * 10 / 3 + 4;
        let root = pair.half_size_root(wanted + 2);
        let two = Rational::from(2);
        let from_end = |t: &Rational| match self.region {
            Shape::UnitDisc => (&two - t).min(t + &two),
            Shape::LeftHalfPlane => -t,
        };
        let room = from_end(root.lower()).min(from_end(root.upper())) * Rational::dyadic(&Integer::ONE, wanted);
        let (lo, hi) = (root.lower() - &room, root.upper() + &room);
        let working = 4 * bits + 4 * wanted + 256;
        let excluded = |t: &Rational| {
            self.pair.iter().any(|f| {
                let value = self.value_on_box(f, t, x, y, working);
                value.lower().sign().is_gt() || value.upper().sign().is_lt()
            })
        };
        (excluded(&lo) && excluded(&hi)).then(|| Enclosure::new(lo, hi))
    }

    /// All values of `f(t; x, y)` on a box.
    fn value_on_box(&self, f: &Poly<MultiPoly>, t: &Rational, x: &Enclosure, y: &Enclosure, bits: u64) -> Enclosure {
        let zero = Enclosure::from_rational(Rational::ZERO);
        let t = Enclosure::from_rational(t.clone());
        let value = |c: &MultiPoly| self.p.ground().enclose(c, x, y, bits);
        f.coeffs().iter().rev().fold(zero, |sum, c| sum.mul(&t, bits).add(&value(c), bits))
    }
}

/// Rationals `low <= below < above <= high`, not much farther apart than the numbers.
fn apart(below: &Real, above: &Real) -> (Rational, Rational) {
    let (mut a, mut b) = (below.clone(), above.clone());
    let half = Rational::dyadic(&Integer::ONE, 1);
    let mut width = Rational::ONE;
    loop {
        let (inner, outer) = (a.enclosure(), b.enclosure());
        let gap = &outer.0 - &inner.1;
        if gap.sign().is_gt() && &outer.1 - &inner.0 <= &gap + &gap {
            return (inner.0, outer.1);
        }
        width *= &half;
        (a, b) = (a.refined(&width), b.refined(&width));
    }
}

fn ordered(a: &Rational, b: &Rational) -> Enclosure {
    if a <= b { Enclosure::new(a.clone(), b.clone()) } else { Enclosure::new(b.clone(), a.clone()) }
}

/// Of two half-size roots the greater: `2 cos(theta)` and `-omega^2` fall as the frequency rises.
pub(super) fn lower_frequency(a: Option<Enclosure>, b: Option<Enclosure>) -> Option<Enclosure> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if a.lower() >= b.lower() { a } else { b }),
        (a, b) => a.or(b),
    }
}

/// All values of a polynomial in two variables on a box, by Horner's rule in both.
pub(super) fn multi_value(f: &MultiPoly, x: &Enclosure, y: &Enclosure, bits: u64) -> Enclosure {
    let zero = Enclosure::from_rational(Rational::ZERO);
    let rows = in_y(f);
    rows.coeffs().iter().rev().fold(zero, |sum, row| sum.mul(y, bits).add(&row.eval_enclosure(x, bits), bits))
}
