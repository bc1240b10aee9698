//! Strips and cells: the plane cut along the boundary curves, one exact sample in each cell.

use super::curves::{Curve, PlanePolynomial, X, Y, boundary_curves, exchanged as exchanged_in};
use super::glue::glue_stable_cells;
use super::ground::{Ground, put};
use super::integers::Integers;
use super::projection::projection;
use crate::interval_set::real_cells;
use crate::{AtPoint, Range, RealInterval, Shape};
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use jurist_algebra::real::Real;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A branch of a curve over a strip: the root of the curve's polynomial in `y`, counted from 0 from
/// below over the real roots inside the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Branch {
    /// The number of the curve.
    pub curve: usize,
    /// The number of the root.
    pub root: usize,
}

/// An open cell of a strip, between two neighbouring branches or the domain's edge (`None`).
#[derive(Clone, Debug)]
pub struct Cell {
    /// Below.
    pub lower: Option<Branch>,
    /// Above.
    pub upper: Option<Branch>,
    /// A rational `y` inside the cell at the strip's sample.
    pub sample: Rational,
    /// Whether all roots are strictly inside.
    pub stable: bool,
    /// Roots outside the region.
    pub outside: usize,
    /// Roots on its boundary.
    pub on: usize,
}

/// An open strip of the domain between two neighbouring critical values of `x`.
#[derive(Clone, Debug)]
pub struct Strip {
    /// The ends.
    pub x: RealInterval,
    /// The numbers of the curves that contain the line at the lower and at the upper end.
    pub lines: [Vec<usize>; 2],
    /// A rational `x` inside.
    pub sample: Rational,
    /// The cells from below.
    pub cells: Vec<Cell>,
}

/// A connected region of stable points.
#[derive(Clone, Debug)]
pub struct StableRegion {
    /// Its cells: number of the strip, number of the cell.
    pub cells: Vec<(usize, usize)>,
    /// The smallest and the greatest `x` on its boundary.
    pub x: RealInterval,
    /// The smallest and the greatest `y` on its boundary.
    pub y: RealInterval,
    /// Its cells in the decomposition with the parameters exchanged ([`StabilityMap::exchanged`]).
    pub exchanged_cells: Vec<(usize, usize)>,
}

/// The decomposition of a rectangle (bounded or not) of two parameters.
#[derive(Clone, Debug)]
pub struct StabilityMap {
    /// The boundary curves; empty when the loop is stable nowhere for one reason.
    pub curves: Vec<Curve>,
    /// The strips from left to right; empty when a boundary polynomial vanishes identically, so that the
    /// loop is stable at no point.
    pub strips: Vec<Strip>,
    /// The connected stable regions.
    pub regions: Vec<StableRegion>,
    /// The strips of the same domain with the parameters exchanged, from which the extents in `y` are read;
    /// empty when there is no stable region.
    pub exchanged: Vec<Strip>,
    /// Whether a boundary polynomial vanishes identically.
    pub never_stable: bool,
    /// What the coefficients of the curves are.
    pub(super) ground: Arc<dyn Ground>,
}

/// Decomposes the domain of two parameters into cells of constant root count, exactly.
///
/// The critical values of `x` are the real zeros of leading coefficients, discriminants and resultants
/// with respect to `y` of the boundary curves, and of the curves on the domain's edges: between them
/// the branches do not meet, vanish or leave, so one sample decides a cell (the open part of Collins's
/// decomposition, [Collins1975](jurist_algebra::bibliography#collins1975), [McCallum1998](jurist_algebra::bibliography#mccallum1998)). Extreme values in `y` come from the same
/// decomposition with the parameters exchanged.
///
/// Of a loop over symbols it is the same with polynomials in these as coefficients. Their zeros are isolated with enclosed
/// coefficients, and whatever is zero is so by an identity.
///
/// # Errors
/// [`Exhausted`] when the budget runs out. Of a loop over symbols also where a polynomial has too many terms, where two numbers are
/// the same to some thousand bits and no identity shows it, and where it is not found whether two cells touch.
pub fn stability_map(
    p: &PlanePolynomial,
    domain: &[Range; 2],
    region: Shape,
    budget: &Budget,
) -> Result<StabilityMap, Exhausted> {
    budget.step("boundary curves");
    let Some(curves) = boundary_curves(p, region, budget)? else {
        return Ok(StabilityMap::never_stable());
    };
    let strips = decompose(p, &curves, domain, region, budget)?;
    let ground = p.ground();
    let groups = glue_stable_cells(&**ground, &curves, &strips, &domain[1], false, budget)?;
    let mut regions: Vec<StableRegion> = groups.into_iter().map(|cells| region_of(&strips, cells)).collect();
    let mut exchanged = Vec::new();
    if !regions.is_empty() {
        budget.step("extreme values");
        let swapped_curves: Vec<Curve> = curves.iter().map(swapped_curve).collect();
        let swapped_domain = [domain[1].clone(), domain[0].clone()];
        exchanged = decompose(&p.swapped(), &swapped_curves, &swapped_domain, region, budget)?;
        let groups = glue_stable_cells(&**ground, &swapped_curves, &exchanged, &domain[0], false, budget)?;
        for r in &mut regions {
            let place =
                place_in_exchanged(&**ground, r, [&curves, &swapped_curves], [&strips, &exchanged], domain, budget)?;
            let group = groups.iter().find(|g| g.contains(&place)).expect("a stable point is in a stable cell");
            r.y = region_of(&exchanged, group.clone()).x;
            r.exchanged_cells.clone_from(group);
        }
    }
    Ok(StabilityMap { curves, strips, regions, exchanged, never_stable: false, ground: Arc::clone(ground) })
}

/// A cell of the exchanged strips that is part of a region: that of a point of its first cell, moved up
/// from the sample until it is on none of the finitely many walls.
pub(super) fn place_in_exchanged(
    ground: &dyn Ground,
    region: &StableRegion,
    [curves, swapped_curves]: [&[Curve]; 2],
    [strips, exchanged]: [&[Strip]; 2],
    domain: &[Range; 2],
    budget: &Budget,
) -> Result<(usize, usize), Exhausted> {
    let (strip, cell) = region.cells[0];
    let x = &strips[strip].sample;
    let branches = branches_at(ground, curves, x, &domain[1], budget)?;
    let values: Vec<Real> = branches.into_iter().map(|b| b.0).collect();
    let ceiling = real_cells(&domain[1], &values).swap_remove(cell).upper;
    let mut y = strips[strip].cells[cell].sample.clone();
    loop {
        budget.check()?;
        if let Some(place) = locate(ground, swapped_curves, exchanged, [&y, x], &domain[0], budget)? {
            return Ok(place);
        }
        y = RealInterval { lower: Some(Real::from(y)), upper: ceiling.clone() }.sample(budget)?;
    }
}

impl StabilityMap {
    /// The map of a loop that is stable at no point because a boundary polynomial vanishes identically or
    /// the loop is undefined everywhere.
    pub fn never_stable() -> Self {
        StabilityMap {
            curves: Vec::new(),
            strips: Vec::new(),
            regions: Vec::new(),
            exchanged: Vec::new(),
            never_stable: true,
            ground: Arc::new(Integers),
        }
    }
}

/// The curve with the parameters exchanged.
pub(super) fn swapped_curve(curve: &Curve) -> Curve {
    Curve { causes: curve.causes.clone(), polynomial: exchanged_in(&curve.polynomial) }
}

/// The region made of some cells; the extent in `y` is filled in later.
pub(super) fn region_of(strips: &[Strip], cells: Vec<(usize, usize)>) -> StableRegion {
    let first = cells.iter().map(|c| c.0).min().expect("a region has cells");
    let last = cells.iter().map(|c| c.0).max().expect("a region has cells");
    let x = RealInterval { lower: strips[first].x.lower.clone(), upper: strips[last].x.upper.clone() };
    let y = RealInterval { lower: None, upper: None };
    StableRegion { cells, x, y, exchanged_cells: Vec::new() }
}

/// The polynomial as one in `y` over `Z[x]`.
pub(super) fn in_y(f: &MultiPoly) -> Poly<UniPoly> {
    let coefficients = f.as_poly_in(Y);
    coefficients.map(|c| c.to_univariate(X).expect("only x is left"))
}

/// The curve's polynomial at a rational `x`, in `y`, up to a factor.
pub(super) fn at_x(f: &MultiPoly, x: &Rational) -> UniPoly {
    f.substitute(X, x).0.to_univariate(Y).expect("x is set")
}

pub(super) fn decompose(
    p: &PlanePolynomial,
    curves: &[Curve],
    domain: &[Range; 2],
    region: Shape,
    budget: &Budget,
) -> Result<Vec<Strip>, Exhausted> {
    budget.step("projecting the curves");
    let ground = &**p.ground();
    let wanted = projection(curves, &domain[1]);
    let points = ground.critical_values(p, curves, &wanted, (&domain[0], region), budget)?;
    budget.step("testing a sample of each cell");
    let intervals = real_cells(&domain[0], &points);
    let (total, done) = (intervals.len() as u64, AtomicU64::new(0));
    let strip = |x: RealInterval| {
        budget.check()?;
        let sample = x.sample(budget)?;
        let cells = cells_at(p, curves, &sample, &domain[1], region, budget)?;
        budget.advance(done.fetch_add(1, Ordering::Relaxed) + 1, total);
        Ok(Strip { x, lines: Default::default(), sample, cells })
    };
    let strips: Result<Vec<Strip>, Exhausted> = parallel_map(intervals, strip);
    let mut strips = strips?;
    find_lines(ground, curves, &mut strips, budget)?;
    Ok(strips)
}

/// The curves that contain the lines between strips and at the ends of the domain. A curve that does not depend on `y` has simple
/// zeros, all of which are such lines: it changes its sign between the samples beside one.
fn find_lines(ground: &dyn Ground, curves: &[Curve], strips: &mut [Strip], budget: &Budget) -> Result<(), Exhausted> {
    for (number, curve) in curves.iter().enumerate().filter(|(_, c)| c.polynomial.degree_in(Y) == 0) {
        let sign = |x: &Rational| ground.sign(&put(&curve.polynomial, X, x), budget);
        let signs = strips.iter().map(|s| sign(&s.sample)).collect::<Result<Vec<_>, Exhausted>>()?;
        for (k, pair) in signs.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]) {
            assert!(pair.iter().all(|sign| !sign.is_eq()));
            strips[k].lines[1].push(number);
            strips[k + 1].lines[0].push(number);
        }
        let Some(last) = strips.len().checked_sub(1) else { continue };
        for (k, side) in [(0, 0), (last, 1)] {
            let end = [&strips[k].x.lower, &strips[k].x.upper][side].as_ref().and_then(Real::exact);
            if let Some(end) = end
                && sign(&end)?.is_eq()
            {
                strips[k].lines[side].push(number);
            }
        }
    }
    Ok(())
}

/// `q^d f(x, a/q)`.
pub(super) fn at_y(f: &Poly<UniPoly>, y: &Rational) -> UniPoly {
    let (a, q) = (y.numerator(), y.denominator());
    let mut acc = UniPoly::zero();
    let mut power = jurist_algebra::number::Integer::ONE;
    for c in f.coeffs().iter().rev() {
        acc = acc.scaled(&a).plus(&c.scaled(&power));
        power = &power * &q;
    }
    acc
}

/// The branches over a rational `x` from below, with their values.
pub(super) fn branches_at(
    ground: &dyn Ground,
    curves: &[Curve],
    x: &Rational,
    y_domain: &Range,
    budget: &Budget,
) -> Result<Vec<(Real, Branch)>, Exhausted> {
    let between = [y_domain.lower.as_ref(), y_domain.upper.as_ref()];
    let mut all: Vec<(Real, Branch)> = Vec::new();
    for (curve, c) in curves.iter().enumerate().filter(|(_, c)| c.polynomial.degree_in(Y) > 0) {
        let Some(roots) = ground.zeros(&put(&c.polynomial, X, x), Y, between, budget)? else { continue };
        for (root, value) in roots.into_iter().enumerate() {
            // Equal ones of different curves, as on a wall, in the order of these.
            let mut at = all.len();
            while at > 0 && all[at - 1].0.compare(&value, budget)?.is_gt() {
                at -= 1;
            }
            all.insert(at, (value, Branch { curve, root }));
        }
    }
    Ok(all)
}

fn cells_at(
    p: &PlanePolynomial,
    curves: &[Curve],
    x: &Rational,
    y_domain: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<Vec<Cell>, Exhausted> {
    let ground = &**p.ground();
    let branches = branches_at(ground, curves, x, y_domain, budget)?;
    let values: Vec<Real> = branches.iter().map(|b| b.0.clone()).collect();
    let cells = real_cells(y_domain, &values);
    let samples = cells.iter().map(|cell| cell.sample(budget)).collect::<Result<Vec<Rational>, Exhausted>>()?;
    let counts = ground.counts(p, x, &samples, region, budget)?;
    let mut out = Vec::with_capacity(samples.len());
    for (i, (sample, count)) in samples.into_iter().zip(counts).enumerate() {
        let (stable, outside, on) = match count {
            AtPoint::Defined { count, infinite } => {
                (infinite == 0 && count.inside == p.formal_degree(), count.outside + infinite, count.on)
            }
            // Not in an open cell: these points lie on curves.
            AtPoint::Undefined | AtPoint::Zero | AtPoint::Delayed { .. } => (false, 0, 0),
        };
        let branch = |i: usize| branches.get(i).map(|b| b.1);
        out.push(Cell { lower: i.checked_sub(1).and_then(branch), upper: branch(i), sample, stable, outside, on });
    }
    Ok(out)
}

/// The cell that contains a point; `None` when it lies on a curve or between strips.
pub(super) fn locate(
    ground: &dyn Ground,
    curves: &[Curve],
    strips: &[Strip],
    [x, y]: [&Rational; 2],
    y_domain: &Range,
    budget: &Budget,
) -> Result<Option<(usize, usize)>, Exhausted> {
    let Some(strip) = strips.iter().position(|s| s.x.contains(x)) else { return Ok(None) };
    for curve in curves.iter().filter(|c| c.polynomial.degree_in(Y) > 0) {
        // Before branches are compared with it, which are refined until they part from it.
        if ground.sign(&put(&put(&curve.polynomial, X, x), Y, y), budget)?.is_eq() {
            return Ok(None);
        }
    }
    let mut below = 0;
    for (value, _) in &branches_at(ground, curves, x, y_domain, budget)? {
        if value.compare_rational(y).is_gt() {
            break;
        }
        below += 1;
    }
    Ok(Some((strip, below)))
}
