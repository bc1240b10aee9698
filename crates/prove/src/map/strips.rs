//! The strips of a map, in a form that checkers verify without search.

use super::isolation::{Enclosed, Place, list, separate};
use crate::statement::{number, object};
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in};
use jurist_stability::Range;
use jurist_stability::plane::{Join, Strip, at_height, over};
use serde_json::Value;

/// Irrational walls are enclosed to this many digits: they are the extents of the regions.
const DIGITS: usize = 12;

/// A decomposition and what it was made by.
pub(super) struct Decomposed<'a> {
    pub factors: &'a [MultiPoly],
    pub x_factors: &'a [UniPoly],
    pub strips: &'a [Strip],
    pub joins: &'a [Join],
    pub domain: [&'a Range; 2],
}

/// The roots of several polynomials in an interval, ascending, each with the number of its polynomial.
fn all_roots(
    polynomials: &[UniPoly],
    lower: Option<&Rational>,
    upper: Option<&Rational>,
    budget: &Budget,
) -> Result<Vec<(RealAlgebraic, usize)>, Exhausted> {
    let mut all = Vec::new();
    for (i, f) in polynomials.iter().enumerate() {
        let Some(f) = SquareFree::part_of(f) else { continue };
        let roots = isolate_real_roots_in(&f, lower, upper, budget)?;
        all.extend(roots.into_iter().map(|root| (root, i)));
    }
    budget.enter(|| all.sort_by(|a, b| a.0.compare(&b.0)))?;
    Ok(all)
}

/// The list of each polynomial's roots.
fn lists(
    polynomials: &[UniPoly],
    lower: &Option<Rational>,
    upper: &Option<Rational>,
    roots: &[(usize, Place)],
    budget: &Budget,
) -> Result<Vec<Value>, Exhausted> {
    let own = |i: usize| roots.iter().filter(move |r| r.0 == i).map(|r| r.1.clone()).collect::<Vec<Place>>();
    let each = polynomials.iter().enumerate();
    each.map(|(i, f)| list(f, lower, upper, &own(i), budget)).collect()
}

impl Decomposed<'_> {
    /// The factors in `x` with their roots. The numbers at which something is tested are not within the roots' enclosures.
    pub fn walls(&self, budget: &Budget) -> Result<Value, Exhausted> {
        let Range { lower, upper } = self.domain[0];
        let roots = all_roots(self.x_factors, lower.as_ref(), upper.as_ref(), budget)?;
        let used: Vec<&Rational> =
            self.strips.iter().map(|s| &s.sample).chain(self.joins.iter().flat_map(|j| &j.x)).collect();
        let mut owners = Vec::with_capacity(roots.len());
        let mut places = Vec::with_capacity(roots.len());
        for (root, owner) in roots {
            let root = budget.enter(|| root.refined_to_digits(DIGITS))?;
            let mut enclosed = Enclosed::new(root, None);
            enclosed.alone(&self.x_factors[owner], budget)?;
            for q in &used {
                enclosed.away_from(q, budget)?;
            }
            for end in [lower, upper].into_iter().flatten() {
                enclosed.away_from(end, budget)?;
            }
            owners.push(owner);
            places.push(enclosed);
        }
        separate(&mut places, budget)?;
        let roots: Vec<(usize, Place)> = owners.into_iter().zip(places.into_iter().map(|p| p.place)).collect();
        let lists = lists(self.x_factors, lower, upper, &roots, budget)?;
        let factors = self.x_factors.iter().zip(lists).map(|(f, roots)| {
            let polynomial: Value = f.coeffs().iter().map(|c| Value::from(c.to_string())).collect();
            object([("polynomial", polynomial), ("roots", roots)])
        });
        Ok(factors.collect())
    }

    /// The factors that depend on `y`, over one `x`.
    fn over(&self, x: &Rational) -> Vec<UniPoly> {
        self.factors.iter().filter(|f| f.degree_in(1) > 0).map(|f| over(f, x)).collect()
    }

    /// The branches over each strip's sample, and the samples of its cells.
    pub fn strips(&self, budget: &Budget) -> Result<Value, Exhausted> {
        let strip = |strip: &Strip| -> Result<Value, Exhausted> {
            budget.check()?;
            let Range { lower, upper } = self.domain[1];
            let polynomials = self.over(&strip.sample);
            let roots = all_roots(&polynomials, lower.as_ref(), upper.as_ref(), budget)?;
            let mut found = Vec::with_capacity(roots.len());
            for ((root, owner), around) in roots.into_iter().zip(strip.cells.windows(2)) {
                // Between the samples of two cells there is one branch: their numbers are short.
                let wide = Place { left: around[0].sample.clone(), right: around[1].sample.clone() };
                let mut enclosed = Enclosed::new(root, Some(wide));
                enclosed.alone(&polynomials[owner], budget)?;
                found.push((owner, enclosed.place));
            }
            let lists = lists(&polynomials, lower, upper, &found, budget)?;
            Ok(object([
                ("x", number(&strip.sample)),
                ("roots", Value::Array(lists)),
                ("cells", strip.cells.iter().map(|cell| number(&cell.sample)).collect()),
            ]))
        };
        let all: Result<Vec<Value>, Exhausted> = parallel_map(self.strips, strip);
        Ok(Value::Array(all?))
    }

    /// The segments through the walls, and the branches below either end.
    pub fn joins(&self, budget: &Budget) -> Result<Value, Exhausted> {
        let join = |join: &Join| -> Result<Value, Exhausted> {
            budget.check()?;
            let [left, right] = join.x.each_ref();
            let below = [self.below(left, &join.y, budget)?, self.below(right, &join.y, budget)?];
            let along = |f: &MultiPoly| {
                let (left, right) = (Some(left.clone()), Some(right.clone()));
                list(&at_height(f, &join.y), &left, &right, &[], budget)
            };
            let clear = self.factors.iter().map(along).collect::<Result<Vec<Value>, Exhausted>>()?;
            Ok(object([
                ("strip", join.strip.into()),
                ("x", join.x.iter().map(number).collect()),
                ("y", number(&join.y)),
                ("below", below.into_iter().map(Value::Array).collect()),
                ("clear", Value::Array(clear)),
            ]))
        };
        let all: Result<Vec<Value>, Exhausted> = parallel_map(self.joins, join);
        Ok(Value::Array(all?))
    }

    /// The branches below a height over one `x`.
    fn below(&self, x: &Rational, y: &Rational, budget: &Budget) -> Result<Vec<Value>, Exhausted> {
        let (lower, upper) = (&self.domain[1].lower, Some(y.clone()));
        let mut out = Vec::new();
        for f in self.over(x) {
            let roots = all_roots(std::slice::from_ref(&f), lower.as_ref(), upper.as_ref(), budget)?;
            let mut places = Vec::with_capacity(roots.len());
            for (root, _) in roots {
                let mut enclosed = Enclosed::new(root, None);
                enclosed.alone(&f, budget)?;
                for end in [lower, &upper].into_iter().flatten() {
                    enclosed.away_from(end, budget)?;
                }
                places.push(enclosed);
            }
            separate(&mut places, budget)?;
            let places: Vec<Place> = places.into_iter().map(|p| p.place).collect();
            out.push(list(&f, lower, &upper, &places, budget)?);
        }
        Ok(out)
    }
}
