//! Which stable cells of neighbouring strips are parts of one region.

use super::curves::{Curve, X};
use super::decompose::{Strip, at_y, branches_at, in_y};
use super::sturm_at::count_distinct_roots_at;
use crate::limits::{Budget, Exhausted};
use crate::number::{Integer, Rational};
use crate::poly::{Domain, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in};
use crate::stability::Range;
use crate::stability::interval_set::cells;
use std::collections::BTreeSet;

/// The stable cells grouped into connected regions, each group ascending.
///
/// Two cells on either side of a wall are parts of one region when a horizontal segment leads from one
/// to the other without meeting a curve: that is proved by root counts. The segments found are all there
/// are when their number, over all cells, is one more than that of the distinct roots of the
/// curves on the wall itself, counted by Sturm's theorem over the wall's algebraic number.
pub(super) fn glue_stable_cells(
    curves: &[Curve],
    strips: &[Strip],
    y_domain: &Range,
    budget: &Budget,
) -> Result<Vec<Vec<(usize, usize)>>, Exhausted> {
    budget.step("connecting cells");
    let stable: Vec<(usize, usize)> = strips
        .iter()
        .enumerate()
        .flat_map(|(s, strip)| strip.cells.iter().enumerate().filter(|c| c.1.stable).map(move |(c, _)| (s, c)))
        .collect();
    let mut parent: Vec<usize> = (0..stable.len()).collect();
    let index = |cell: (usize, usize)| stable.binary_search(&cell).ok();
    for (s, pair) in strips.windows(2).enumerate() {
        if !pair.iter().all(|strip| strip.cells.iter().any(|c| c.stable)) {
            continue;
        }
        let wall = pair[0].x.upper.as_ref().expect("a wall between strips is finite");
        let mut search = Wall::new(curves, pair, wall, y_domain);
        for (left, right) in search.links(budget)? {
            if let (Some(a), Some(b)) = (index((s, left)), index((s + 1, right))) {
                let (a, b) = (root(&parent, a), root(&parent, b));
                parent[a.max(b)] = a.min(b);
            }
        }
    }
    let mut groups: Vec<Vec<(usize, usize)>> = Vec::new();
    let mut number = vec![usize::MAX; stable.len()];
    for i in 0..stable.len() {
        let r = root(&parent, i);
        if number[r] == usize::MAX {
            number[r] = groups.len();
            groups.push(Vec::new());
        }
        groups[number[r]].push(stable[i]);
    }
    Ok(groups)
}

fn root(parent: &[usize], mut i: usize) -> usize {
    while parent[i] != i {
        i = parent[i];
    }
    i
}

/// The wall between two strips.
struct Wall<'a> {
    curves: &'a [Curve],
    polynomials: Vec<Poly<UniPoly>>,
    strips: &'a [Strip],
    value: &'a RealAlgebraic,
    y_domain: &'a Range,
}

impl<'a> Wall<'a> {
    fn new(curves: &'a [Curve], strips: &'a [Strip], value: &'a RealAlgebraic, y_domain: &'a Range) -> Self {
        let polynomials = curves.iter().map(|c| in_y(&c.polynomial)).collect();
        Wall { curves, polynomials, strips, value, y_domain }
    }

    /// All pairs of a cell on the left and a cell on the right that touch along a piece of the wall.
    fn links(&mut self, budget: &Budget) -> Result<BTreeSet<(usize, usize)>, Exhausted> {
        let product = self.polynomials.iter().fold(Poly::one(), |p, f| p.times(f));
        let (lower, upper) = (self.y_domain.lower.as_ref(), self.y_domain.upper.as_ref());
        // A curve that contains the whole wall separates the strips.
        let Some(roots) = count_distinct_roots_at(&product, self.value, lower, upper, budget)? else {
            return Ok(BTreeSet::new());
        };
        let mut links = BTreeSet::new();
        let mut bits = 8u64;
        // One link for each piece of the wall, each found in the end because every piece has length.
        while links.len() < roots + 1 {
            budget.check()?;
            let (left, right) = self.either_side(bits);
            self.search(&left, &right, &mut links, budget)?;
            bits *= 2;
        }
        Ok(links)
    }

    /// Rationals close to the wall in the strip on either side.
    fn either_side(&self, bits: u64) -> (Rational, Rational) {
        let width = Rational::dyadic(&Integer::ONE, bits);
        let (lo, hi) = self.value.refined(&width).enclosure();
        let (mut left, mut right) = (&lo - &width, &hi + &width);
        let mut step = width;
        while !self.strips[0].x.contains(&left) {
            step = step * Rational::new(Integer::ONE, Integer::from(2));
            left = &self.value.refined(&step).enclosure().0 - &step;
        }
        while !self.strips[1].x.contains(&right) {
            step = step * Rational::new(Integer::ONE, Integer::from(2));
            right = &self.value.refined(&step).enclosure().1 + &step;
        }
        (left, right)
    }

    fn search(
        &self,
        left: &Rational,
        right: &Rational,
        links: &mut BTreeSet<(usize, usize)>,
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        let values = |x: &Rational| -> Result<Vec<RealAlgebraic>, Exhausted> {
            Ok(branches_at(self.curves, x, self.y_domain, budget)?.into_iter().map(|b| b.0).collect())
        };
        let sides = [values(left)?, values(right)?];
        let cell_of =
            |side: &[RealAlgebraic], y: &Rational| side.iter().take_while(|v| v.compare_rational(y).is_lt()).count();
        // Every piece of the wall lies, close by, within a cell of the merged order of both sides.
        let mut merged: Vec<RealAlgebraic> = sides.iter().flatten().cloned().collect();
        merged.sort_by(|a, b| a.compare(b));
        merged.dedup_by(|a, b| a.compare(b).is_eq());
        for gap in cells(self.y_domain, &merged) {
            let y = gap.sample();
            let link = (cell_of(&sides[0], &y), cell_of(&sides[1], &y));
            if !links.contains(&link) && self.is_clear(left, right, &y, budget)? {
                links.insert(link);
            }
        }
        Ok(())
    }

    /// Whether no curve meets the horizontal segment.
    fn is_clear(&self, left: &Rational, right: &Rational, y: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        for (f, curve) in self.polynomials.iter().zip(self.curves) {
            let restricted = at_y(f, y);
            let Some(restricted) = SquareFree::part_of(&restricted) else { return Ok(false) };
            debug_assert!(curve.polynomial.degree_in(X) as usize + 1 >= restricted.poly().coeffs().len());
            let touches = |x: &Rational| restricted.poly().sign_at(x).is_eq();
            if touches(left)
                || touches(right)
                || !isolate_real_roots_in(&restricted, Some(left), Some(right), budget)?.is_empty()
            {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
