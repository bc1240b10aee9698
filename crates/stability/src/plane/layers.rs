//! Regions inside the stable ones: where more is met than stability.

use super::curves::{Curve, PlanePolynomial, add_curves, boundary_curves};
use super::decompose::{StabilityMap, StableRegion, Strip, decompose, place_in_exchanged, region_of, swapped_curve};
use super::glue::glue_stable_cells;
use crate::{Range, Shape};
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::MultiPoly;
use std::sync::Arc;

/// Which of several things a stable point meets.
type Met<'a> = dyn Fn(&[Rational; 2]) -> Result<Vec<bool>, Exhausted> + Sync + 'a;

/// What each cell of each strip meets.
type MetInStrips = Vec<Vec<Vec<bool>>>;

/// What is asked of the stable points.
pub struct Asked<'a> {
    /// Polynomials at whose zeros it may begin or cease to be met.
    pub curves: Vec<MultiPoly>,
    /// What is met at a point.
    pub met: &'a Met<'a>,
    /// The sets of things whose common regions are wanted, by their numbers.
    pub sets: &'a [Vec<usize>],
}

/// For each set the decomposition in which the cells that meet all of it are the stable ones. All have the same curves and
/// strips. Curves inside a region are no boundaries of it; their points are not decided. Nothing of a loop that is never stable.
///
/// Cost: that of [`stability_map`](super::stability_map) with all curves together, and one test for each stable cell.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn layers(
    p: &PlanePolynomial,
    asked: &Asked<'_>,
    domain: &[Range; 2],
    shape: Shape,
    budget: &Budget,
) -> Result<Vec<StabilityMap>, Exhausted> {
    budget.step("boundary curves");
    let Some(mut curves) = boundary_curves(p, shape, budget)? else {
        return Ok(asked.sets.iter().map(|_| StabilityMap::never_stable()).collect());
    };
    add_curves(&mut curves, &asked.curves, &**p.ground(), budget)?;
    let strips = decompose(p, &curves, domain, shape, budget)?;
    let met = met_in(&strips, asked.met, false, budget)?;
    let swapped_curves: Vec<Curve> = curves.iter().map(swapped_curve).collect();
    let swapped_domain = [domain[1].clone(), domain[0].clone()];
    let mut exchanged: Option<(Vec<Strip>, MetInStrips)> = None;
    let mut out = Vec::with_capacity(asked.sets.len());
    for set in asked.sets {
        let strips = restricted(&strips, &met, set);
        let groups = glue_stable_cells(&**p.ground(), &curves, &strips, &domain[1], true, budget)?;
        let mut regions: Vec<StableRegion> = groups.into_iter().map(|cells| region_of(&strips, cells)).collect();
        let mut map_exchanged = Vec::new();
        if !regions.is_empty() {
            let (other, other_met) = match exchanged.take() {
                Some(known) => known,
                None => {
                    budget.step("extreme values");
                    let other = decompose(&p.swapped(), &swapped_curves, &swapped_domain, shape, budget)?;
                    let met = met_in(&other, asked.met, true, budget)?;
                    (other, met)
                }
            };
            map_exchanged = restricted(&other, &other_met, set);
            let groups = glue_stable_cells(&**p.ground(), &swapped_curves, &map_exchanged, &domain[0], true, budget)?;
            for r in &mut regions {
                let (curves, strips) = ([curves.as_slice(), &swapped_curves], [strips.as_slice(), &map_exchanged]);
                let place = place_in_exchanged(&**p.ground(), r, curves, strips, domain, budget)?;
                let group = groups.iter().find(|g| g.contains(&place)).expect("the point is in a cell of the set");
                r.y = region_of(&map_exchanged, group.clone()).x;
                r.exchanged_cells.clone_from(group);
            }
            exchanged = Some((other, other_met));
        }
        let curves = curves.clone();
        out.push(StabilityMap {
            curves,
            strips,
            regions,
            exchanged: map_exchanged,
            never_stable: false,
            ground: Arc::clone(p.ground()),
        });
    }
    Ok(out)
}

/// What is met in each stable cell; nothing in the others.
fn met_in(strips: &[Strip], met: &Met<'_>, is_exchanged: bool, budget: &Budget) -> Result<MetInStrips, Exhausted> {
    budget.step("testing what is required in each stable cell");
    let of = |strip: &Strip| {
        let one = |cell: &super::Cell| {
            budget.check()?;
            let (mut x, mut y) = (strip.sample.clone(), cell.sample.clone());
            if is_exchanged {
                std::mem::swap(&mut x, &mut y);
            }
            if cell.stable { met(&[x, y]) } else { Ok(Vec::new()) }
        };
        strip.cells.iter().map(one).collect()
    };
    parallel_map(strips, of)
}

/// The strips in which the cells that meet a set are the stable ones.
fn restricted(strips: &[Strip], met: &[Vec<Vec<bool>>], set: &[usize]) -> Vec<Strip> {
    let mut out = strips.to_vec();
    for (strip, met) in out.iter_mut().zip(met) {
        for (cell, met) in strip.cells.iter_mut().zip(met) {
            cell.stable = cell.stable && set.iter().all(|k| met[*k]);
        }
    }
    out
}
