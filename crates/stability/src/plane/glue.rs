//! Which stable cells of neighbouring strips are parts of one region.

use super::curves::{Curve, Y};
use super::decompose::{Branch, Strip, branches_at};
use super::ground::Ground;
use super::integers::Integers;
use crate::interval_set::real_cells;
use crate::{Range, RealInterval};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::merged;
use std::collections::{BTreeMap, BTreeSet};

/// Branches that agree to so many bits are taken for one where a height between two is looked for.
const SAME_BITS: u64 = 640;

/// A horizontal segment through the wall between a strip and the next one that meets no curve.
#[derive(Clone, Debug)]
pub struct Join {
    /// The number of the strip on the left.
    pub strip: usize,
    /// Its ends, one in each of the two strips.
    pub x: [Rational; 2],
    /// Its height.
    pub y: Rational,
}

/// Segments that join the stable cells of each region, of a loop without symbols: one less than it has cells.
///
/// Cost: that of gluing once more.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn joins(curves: &[Curve], strips: &[Strip], y_domain: &Range, budget: &Budget) -> Result<Vec<Join>, Exhausted> {
    Ok(glued(&Integers, curves, strips, y_domain, false, budget)?.1)
}

/// The stable cells grouped into connected regions, each group ascending.
///
/// Two neighbouring cells of one strip are parts of one region where `across` is asked for: then curves inside a region
/// are no boundaries of it. Two cells on either side of a wall are parts of one region when a horizontal segment leads from one
/// to the other without meeting a curve: that is proved by root counts. They do not touch there when a segment that meets no curve
/// leads to the wall and beyond it between them. Where a few trials settle not all pairs, it is decided otherwise ([`Ground::links`]).
pub(super) fn glue_stable_cells(
    ground: &dyn Ground,
    curves: &[Curve],
    strips: &[Strip],
    y_domain: &Range,
    across: bool,
    budget: &Budget,
) -> Result<Groups, Exhausted> {
    Ok(glued(ground, curves, strips, y_domain, across, budget)?.0)
}

/// The cells of each region.
type Groups = Vec<Vec<(usize, usize)>>;

/// The regions, and the segments by which they were found to be connected.
fn glued(
    ground: &dyn Ground,
    curves: &[Curve],
    strips: &[Strip],
    y_domain: &Range,
    across: bool,
    budget: &Budget,
) -> Result<(Groups, Vec<Join>), Exhausted> {
    budget.step("connecting cells");
    // A line on which nothing happens to the roots is no boundary either.
    let is_wall = |curve: &&Curve| !across || curve.causes.iter().next().is_some() || curve.polynomial.degree_in(Y) > 0;
    let kept: Vec<Curve> = curves.iter().filter(is_wall).cloned().collect();
    let curves = kept.as_slice();
    let mut regions = Regions::of(strips, across);
    let mut joins = Vec::new();
    for (s, pair) in strips.windows(2).enumerate() {
        let wall = pair[0].x.upper.as_ref().expect("a wall between strips is finite");
        // Clear heights so far, and the pairs of which it is not known whether the wall connects them.
        let mut heights: BTreeSet<(usize, usize)> = BTreeSet::new();
        let mut join = |regions: &mut Regions, ((left, right), [x, other, y]): ((usize, usize), [Rational; 3])| {
            if regions.join((s, left), (s + 1, right)) {
                joins.push(Join { strip: s, x: [x, other], y });
            }
        };
        let search = Wall { ground, curves, strips: pair, value: wall, y_domain };
        for bits in [8, 16, 32] {
            let pairs = regions.apart(s, &heights);
            if pairs.is_empty() {
                break;
            }
            for link in search.nearby_links(bits, &pairs, budget)? {
                heights.insert(link.0);
                join(&mut regions, link);
            }
        }
        let pairs = regions.apart(s, &heights);
        if !pairs.is_empty() {
            for link in ground.links(&search, &pairs, budget)? {
                join(&mut regions, link);
            }
        }
    }
    Ok((regions.groups(), joins))
}

/// Stable cells. Some are known to be parts of one region.
struct Regions {
    cells: Vec<(usize, usize)>,
    /// For each cell another one of its region, or itself.
    parent: Vec<usize>,
}

impl Regions {
    /// Each cell for itself; neighbours in a strip together where `across` is asked for.
    fn of(strips: &[Strip], across: bool) -> Self {
        let of_strip = |(s, strip): (usize, &Strip)| {
            let stable = strip.cells.iter().enumerate().filter(|c| c.1.stable).map(|(c, _)| (s, c));
            stable.collect::<Vec<_>>()
        };
        let cells: Vec<(usize, usize)> = strips.iter().enumerate().flat_map(of_strip).collect();
        let mut parent: Vec<usize> = (0..cells.len()).collect();
        for i in (1..cells.len()).filter(|_| across) {
            let (below, above) = (cells[i - 1], cells[i]);
            if below.0 == above.0 && below.1 + 1 == above.1 {
                parent[i] = parent[i - 1];
            }
        }
        Regions { cells, parent }
    }

    fn root(&self, mut i: usize) -> usize {
        while self.parent[i] != i {
            i = self.parent[i];
        }
        i
    }

    /// Makes the regions of two cells one; `false` where they are that already, or a cell is not stable.
    fn join(&mut self, left: (usize, usize), right: (usize, usize)) -> bool {
        let [a, b] = [left, right].map(|cell| self.cells.binary_search(&cell).ok().map(|i| self.root(i)));
        match a.zip(b).filter(|(a, b)| a != b) {
            Some((a, b)) => {
                self.parent[a.max(b)] = a.min(b);
                true
            }
            None => false,
        }
    }

    /// The pairs of cells beside the wall behind a strip whose connection is not known. `heights` are clear heights.
    fn apart(&self, strip: usize, heights: &BTreeSet<(usize, usize)>) -> Vec<(usize, usize)> {
        let side = |strip: usize| self.cells.iter().enumerate().filter(move |c| c.1.0 == strip).map(|c| (c.0, c.1.1));
        let pairs = side(strip).flat_map(|a| side(strip + 1).map(move |b| (a, b)));
        let apart = pairs.filter(|(a, b)| self.root(a.0) != self.root(b.0)).map(|(a, b)| (a.1, b.1));
        apart.filter(|pair| !heights.iter().any(|height| separates(*height, *pair))).collect()
    }

    fn groups(&self) -> Groups {
        let mut groups: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (i, cell) in self.cells.iter().enumerate() {
            groups.entry(self.root(i)).or_default().push(*cell);
        }
        groups.into_values().collect()
    }
}

/// Whether a clear height in these cells on the left and on the right shows that a pair of cells does not touch at the wall: it is
/// above the one and below the other, on the whole way to the wall.
pub(super) fn separates(height: (usize, usize), pair: (usize, usize)) -> bool {
    (height.0 > pair.0 && height.1 < pair.1) || (height.0 < pair.0 && height.1 > pair.1)
}

/// The cells that are joined, by their numbers in the two strips, and the segment: its ends and its height.
pub type Links = BTreeMap<(usize, usize), [Rational; 3]>;

/// The wall between two strips.
pub struct Wall<'a> {
    pub ground: &'a dyn Ground,
    pub curves: &'a [Curve],
    pub strips: &'a [Strip],
    pub value: &'a Real,
    pub y_domain: &'a Range,
}

impl Wall<'_> {
    /// Clear heights, as their cells on the left and on the right, that connect or separate one of the given pairs of cells: one is
    /// tried in each gap between the branches close to the wall.
    pub fn nearby_links(&self, bits: u64, pairs: &[(usize, usize)], budget: &Budget) -> Result<Links, Exhausted> {
        let (left, right) = self.either_side(bits);
        let sides = [self.values(&left, budget)?, self.values(&right, budget)?];
        let mut links = Links::new();
        for y in self.gaps(&sides, budget)? {
            let link = (cell_of(&sides[0], &y), cell_of(&sides[1], &y));
            let helps = pairs.contains(&link) || pairs.iter().any(|pair| separates(link, *pair));
            if helps && !links.contains_key(&link) && self.is_clear(&left, &right, &y, budget)? {
                links.insert(link, [left.clone(), right.clone(), y]);
            }
        }
        Ok(links)
    }

    /// A height in each gap between the branches on either side.
    pub fn gaps(&self, sides: &[Vec<Real>; 2], budget: &Budget) -> Result<Vec<Rational>, Exhausted> {
        let all = sides.iter().flatten();
        if all.clone().any(|value| value.algebraic().is_none()) {
            return self.gaps_between_enclosures(all, budget);
        }
        let both = merged(sides[0].clone(), sides[1].clone(), budget)?;
        real_cells(self.y_domain, &both).iter().map(|gap| gap.sample(budget)).collect()
    }

    /// The same where equal numbers are not recognised as such: those that are very near count as one.
    fn gaps_between_enclosures<'r>(
        &self,
        values: impl Iterator<Item = &'r Real>,
        budget: &Budget,
    ) -> Result<Vec<Rational>, Exhausted> {
        let width = Rational::dyadic(&Integer::ONE, SAME_BITS);
        let mut places = budget.enter(|| values.map(|v| v.refined(&width).enclosure()).collect::<Vec<_>>())?;
        places.sort();
        let mut heights = Vec::with_capacity(places.len() + 1);
        let mut below: Option<Rational> = self.y_domain.lower.clone();
        for (lo, hi) in places {
            if below.as_ref().is_none_or(|below| *below < lo) {
                let gap = RealInterval { lower: below.clone().map(Real::from), upper: Some(lo.into()) };
                heights.push(gap.sample(budget)?);
            }
            below = Some(below.map_or_else(|| hi.clone(), |below| below.max(hi.clone())));
        }
        let gap = RealInterval { lower: below.map(Real::from), upper: self.y_domain.upper.clone().map(Real::from) };
        heights.push(gap.sample(budget)?);
        Ok(heights)
    }

    /// The branches over an `x`, from below.
    pub fn branches(&self, x: &Rational, budget: &Budget) -> Result<Vec<(Real, Branch)>, Exhausted> {
        branches_at(self.ground, self.curves, x, self.y_domain, budget)
    }

    fn values(&self, x: &Rational, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        Ok(self.branches(x, budget)?.into_iter().map(|b| b.0).collect())
    }

    /// The number of the cell over an `x` that holds a height, which is not one of a curve.
    pub fn cell_at(&self, x: &Rational, y: &Rational, budget: &Budget) -> Result<usize, Exhausted> {
        Ok(cell_of(&self.values(x, budget)?, y))
    }

    /// Rationals close to the wall in the strip on either side.
    pub fn either_side(&self, bits: u64) -> (Rational, Rational) {
        let half = Rational::dyadic(&Integer::ONE, 1);
        let mut step = Rational::dyadic(&Integer::ONE, bits);
        loop {
            let (lo, hi) = self.value.refined(&step).enclosure();
            let (left, right) = (&lo - &step, &hi + &step);
            if self.strips[0].x.contains(&left) && self.strips[1].x.contains(&right) {
                return (left, right);
            }
            step *= &half;
        }
    }

    /// Whether no curve meets the horizontal segment.
    pub fn is_clear(
        &self,
        left: &Rational,
        right: &Rational,
        y: &Rational,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        for curve in self.curves {
            if !self.ground.is_clear(&curve.polynomial, [left, right], y, budget)? {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The number of the cell that holds a height: how many branches are below.
pub(super) fn cell_of(branches: &[Real], y: &Rational) -> usize {
    branches.iter().take_while(|v| v.compare_rational(y).is_lt()).count()
}

#[cfg(test)]
mod tests {
    use super::super::curves::{PlanePolynomial, boundary_curves};
    use super::super::decompose::decompose;
    use super::*;
    use crate::Shape;
    use jurist_engine::model::{Model, ParameterBuilder, Time};
    use jurist_engine::problem::Ask;

    /// The groups when every wall is asked by Sturm's theorem.
    fn glued_exactly(
        curves: &[Curve],
        strips: &[Strip],
        y_domain: &Range,
        budget: &Budget,
    ) -> Vec<Vec<(usize, usize)>> {
        let stable: Vec<(usize, usize)> = strips
            .iter()
            .enumerate()
            .flat_map(|(s, strip)| (0..strip.cells.len()).filter(|&c| strip.cells[c].stable).map(move |c| (s, c)))
            .collect();
        let mut groups: Vec<Vec<(usize, usize)>> = stable.iter().map(|&cell| vec![cell]).collect();
        for (s, pair) in strips.windows(2).enumerate() {
            let value = pair[0].x.upper.as_ref().unwrap();
            let wall = Wall { ground: &Integers, curves, strips: pair, value, y_domain };
            for (left, right) in Integers.links(&wall, &[], budget).unwrap().into_keys() {
                let place = |cell| groups.iter().position(|g: &Vec<(usize, usize)>| g.contains(&cell));
                if let (Some(a), Some(b)) = (place((s, left)), place((s + 1, right)))
                    && a != b
                {
                    let moved = groups.swap_remove(a.max(b));
                    groups[a.min(b)].extend(moved);
                }
            }
        }
        for group in &mut groups {
            group.sort_unstable();
        }
        groups.sort();
        groups
    }

    /// Regions that touch at a point, that stand one above the other, that begin where others end.
    #[test]
    fn groups_are_those_of_the_exact_walls() {
        let loops = [
            "z^2 + (a*b)*z + a^2 - b^2 + 1/2",
            "z^2 + (a^2 + b^2 - 1)*z + a*b + 1/5",
            "z^3 + (a*b - 1/2)*z^2 + (b^2 - a)*z + a^2 - 1/3",
            "(z - a^2 + 2)*(z - b^2 + 2)",
            "z^2 + (a^3 - 3*a - b)*z + 1/4 + b/3",
            "(z - a*b + 2)*(z - b + a)",
            "(z - a^2 + b^2 + 2)*(z - b/3)",
            "(z - a^2 + 2)*(z - a*b)",
            "(z + (a - b)*(a + b))*(z - a*b)",
            "z^3 + (3/10)*a*b*z^2 + (a^2 - b - 7/10)*z + b*a^2/2",
        ];
        let budget = Budget::unlimited();
        let mut several = 0;
        for text in loops {
            let parameter = |name| ParameterBuilder::new(name).nominal("0");
            let model = Model::builder(Time::Discrete).parameter(parameter("a")).parameter(parameter("b"));
            let (model, _) = model.characteristic(text).build().unwrap();
            let problem = model.ask().free("a").free("b").plane_problem().unwrap();
            let p = PlanePolynomial::new(problem.algebra(&budget).unwrap().polynomial().unwrap());
            let domain = [Range::all(), Range::all()];
            let curves = boundary_curves(&p, Shape::UnitDisc, &budget).unwrap().unwrap();
            let strips = decompose(&p, &curves, &domain, Shape::UnitDisc, &budget).unwrap();
            let found = glue_stable_cells(&Integers, &curves, &strips, &domain[1], false, &budget).unwrap();
            assert_eq!(found, glued_exactly(&curves, &strips, &domain[1], &budget), "{text}");
            several += usize::from(found.len() > 1);
        }
        assert!(several >= 3, "{several} maps of several regions");
    }
}
