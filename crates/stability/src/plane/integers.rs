//! Curves whose coefficients are integers.

use super::content::separated;
use super::curves::{Curve, PlanePolynomial};
use super::decompose::{at_y, in_y};
use super::glue::{Links, Wall};
use super::ground::{Beside, Corner, Ground, Projected};
use super::limit::multi_value;
use super::sturm_at::SturmAt;
use crate::interval_set::merge_points;
use crate::{AtPoint, Cause, Causes, End, Range, Shape, complex_pair_at, end_at};
use jurist_algebra::limits::{Budget, Exhausted, parallel_map, try_until_shown};
use jurist_algebra::number::{Enclosure, Rational, Sign};
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, SquareFree, UniPoly, isolate_real_roots_in, resultant_square_free_decomposition,
};
use jurist_algebra::real::Real;

/// The integers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Integers;

/// A polynomial in one parameter.
fn in_one(f: &MultiPoly, parameter: usize) -> UniPoly {
    f.to_univariate(parameter).expect("the other one is set")
}

impl Ground for Integers {
    fn vanishes(&self, f: &MultiPoly, _: &Budget) -> Result<bool, Exhausted> {
        Ok(f.is_zero())
    }

    fn separated(&self, f: &MultiPoly, budget: &Budget) -> Result<Vec<MultiPoly>, Exhausted> {
        budget.enter(|| separated(f))
    }

    fn sign(&self, f: &MultiPoly, _: &Budget) -> Result<Sign, Exhausted> {
        Ok(f.leading_coefficient().sign())
    }

    fn zeros(
        &self,
        f: &MultiPoly,
        parameter: usize,
        [lower, upper]: [Option<&Rational>; 2],
        budget: &Budget,
    ) -> Result<Option<Vec<Real>>, Exhausted> {
        let Some(f) = SquareFree::part_of(&in_one(f, parameter)) else { return Ok(None) };
        let roots = isolate_real_roots_in(&f, lower, upper, budget)?;
        Ok(Some(roots.into_iter().map(Real::from).collect()))
    }

    fn critical_values(
        &self,
        _: &PlanePolynomial,
        curves: &[Curve],
        wanted: &[Projected<'_>],
        (range, _): (&Range, Shape),
        budget: &Budget,
    ) -> Result<Vec<Real>, Exhausted> {
        let curves: Vec<Poly<UniPoly>> = curves.iter().map(|c| in_y(&c.polynomial)).collect();
        let derivatives: Vec<Poly<UniPoly>> = curves.iter().map(Poly::derivative).collect();
        let computed: Result<Vec<Vec<SquareFree>>, Exhausted> =
            parallel_map(wanted, |q| computed(*q, &curves, &derivatives, budget));
        let mut projection: Vec<SquareFree> = Vec::new();
        for q in computed?.into_iter().flatten() {
            if !projection.contains(&q) {
                projection.push(q);
            }
        }
        budget.step("isolating critical values");
        let (lower, upper) = (range.lower.as_ref(), range.upper.as_ref());
        let lists: Result<_, _> = parallel_map(&projection, |q| isolate_real_roots_in(q, lower, upper, budget));
        Ok(merge_points(lists?, budget)?.into_iter().map(Real::from).collect())
    }

    fn counts(
        &self,
        p: &PlanePolynomial,
        x: &Rational,
        heights: &[Rational],
        region: Shape,
        _: &Budget,
    ) -> Result<Vec<AtPoint>, Exhausted> {
        Ok(heights.iter().map(|y| p.at(x, y, region)).collect())
    }

    fn is_clear(
        &self,
        f: &MultiPoly,
        [left, right]: [&Rational; 2],
        y: &Rational,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let Some(restricted) = SquareFree::part_of(&at_y(&in_y(f), y)) else { return Ok(false) };
        let touches = |x: &Rational| restricted.poly().sign_at(x).is_eq();
        Ok(!touches(left)
            && !touches(right)
            && (left == right || isolate_real_roots_in(&restricted, Some(left), Some(right), budget)?.is_empty()))
    }

    /// One height in each piece between the distinct roots of the curves on the wall, found by Sturm's theorem, and a segment at
    /// that height short enough to meet no curve.
    fn links(&self, wall: &Wall<'_>, _: &[(usize, usize)], budget: &Budget) -> Result<Links, Exhausted> {
        let product = wall.curves.iter().fold(Poly::one(), |p, c| p.times(&in_y(&c.polynomial)));
        let mut links = Links::new();
        let (lower, upper) = (wall.y_domain.lower.as_ref(), wall.y_domain.upper.as_ref());
        let value = wall.value.algebraic().expect("zeros of polynomials over the integers");
        // A curve that contains the whole wall separates the strips.
        let Some(sturm) = SturmAt::new(&product, value, lower, upper, budget)? else { return Ok(links) };
        for y in sturm.points_between_roots(budget)? {
            let (left, right) = try_until_shown(8, |bits| {
                budget.check()?;
                let (left, right) = wall.either_side(bits);
                Ok::<_, Exhausted>(wall.is_clear(&left, &right, &y, budget)?.then_some((left, right)))
            })?;
            let cell = |x: &Rational| wall.cell_at(x, &y, budget);
            links.insert((cell(&left)?, cell(&right)?), [left, right, y]);
        }
        Ok(links)
    }

    fn ends(
        &self,
        p: &PlanePolynomial,
        x: &Rational,
        beside: &Beside<'_>,
        (range, region): (&Range, Shape),
        budget: &Budget,
    ) -> Result<Vec<End>, Exhausted> {
        let mut ends = Vec::new();
        let Some(p) = p.at_x(x) else { return Ok(ends) };
        for (value, only_pair) in beside.walls.into_iter().zip(beside.only_pair) {
            let Some(value) = value.and_then(Real::algebraic) else { continue };
            if only_pair {
                // Away from all other curves nothing else can happen.
                let pair = complex_pair_at(&p, value, region, budget)?;
                let mut causes = Causes::default();
                if pair.is_some() {
                    causes.insert(Cause::ComplexPair);
                }
                ends.push(End::new(value.clone(), causes, pair));
            } else {
                ends.extend(end_at(&p, value, range, region, budget)?);
            }
        }
        Ok(ends)
    }

    /// By Sturm's theorem: of the zeros of both curves on the wall, how many are those of their product.
    fn passes(
        &self,
        curves: &[Curve],
        pair: [usize; 2],
        corner: &Corner<'_>,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let Some(wall) = corner.wall.algebraic() else { return Ok(false) };
        let [f, g] = pair.map(|k| in_y(&curves[k].polynomial));
        if let Some(edge) = corner.edge {
            return budget.enter(|| wall.sign_of(&at_y(&g, edge)).is_eq());
        }
        let zeros = |h: &Poly<UniPoly>| -> Result<Option<usize>, Exhausted> {
            let [lower, upper] = corner.heights.map(Some);
            Ok(SturmAt::new(h, wall, lower, upper, budget)?.and_then(|sturm| sturm.count_inside()))
        };
        // The first curve has one zero there; of several it is not told which one is the point.
        let (Some(1), Some(own), Some(all)) = (zeros(&f)?, zeros(&g)?, zeros(&f.times(&g))?) else { return Ok(false) };
        Ok(all == own)
    }

    fn enclose(&self, f: &MultiPoly, x: &Enclosure, y: &Enclosure, bits: u64) -> Enclosure {
        multi_value(f, x, y, bits)
    }

    fn rounded(&self, f: &MultiPoly, _: u64) -> MultiPoly {
        f.clone()
    }
}

/// Square-free factors of positive degree.
fn computed(
    wanted: Projected<'_>,
    curves: &[Poly<UniPoly>],
    derivatives: &[Poly<UniPoly>],
    budget: &Budget,
) -> Result<Vec<SquareFree>, Exhausted> {
    budget.check()?;
    let of = |value: &UniPoly| budget.enter(|| SquareFree::part_of(value)).map(|part| part.into_iter().collect());
    let resultant = |f: &Poly<UniPoly>, g: &Poly<UniPoly>| -> Result<Vec<SquareFree>, Exhausted> {
        let factors = resultant_square_free_decomposition(f, g, budget)?.unwrap_or_default();
        Ok(factors.into_iter().filter_map(|(q, _)| SquareFree::new(q)).collect())
    };
    let parts: Vec<SquareFree> = match wanted {
        Projected::Leading(i) => of(curves[i].leading().expect("a curve is not zero"))?,
        Projected::AtEdge(i, y) => of(&at_y(&curves[i], y))?,
        Projected::Discriminant(i) => resultant(&curves[i], &derivatives[i])?,
        Projected::Resultant(i, j) => resultant(&curves[i], &curves[j])?,
    };
    Ok(parts.into_iter().filter(|q| q.degree() > 0).collect())
}
