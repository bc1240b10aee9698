//! The stable regions in the plane of two parameters.

mod bounds;
mod isolation;
mod residues;
mod resultant;
mod strips;

use crate::boxes::{Ground, polynomial};
use crate::clock::Clock;
use crate::format::Json;
use crate::intervals::{Loop, boundaries};
use crate::multivariate::Multi;
use crate::number::Q;
use crate::over_box::{OverBox, common_factor, in_region, over_box};
use crate::over_symbols::primitive;
use crate::statement::{Domain, Extent, axes, count, fixed_extent, interval, list, object, polynomials, values};
use crate::symbols::Table;
use crate::words::{exact, outward, with_values};
use crate::{Proved, Rejection, Step, is_discrete, is_same_time, verdict};
use isolation::Place;
use std::collections::BTreeMap;
use std::fmt::Write;
use strips::{Curve, Strips, covered, in_y, walls};

struct Statement {
    discrete: bool,
    names: Vec<String>,
    set: Vec<(String, Q)>,
    extent: Extent,
    domain: [Domain; 2],
    /// The cells of each region: number of the strip, number of the cell.
    regions: Vec<Vec<(usize, usize)>>,
}

impl Statement {
    fn read(json: &Json) -> Result<Self, String> {
        let keys = ["kind", "time", "x", "y", "set", "region", "domain", "regions"];
        let [_, time, x, y, set, region, domain, regions] = object(json, "the statement", keys, &[])?;
        let discrete = is_discrete(time)?;
        let extent = fixed_extent(region, discrete)?;
        let names = axes(x, y)?;
        let [x, y] = object(domain, "'domain'", ["x", "y"], &[])?;
        let mut cells = Vec::new();
        for region in list(regions, "'regions'")? {
            let cell = |json: &Json| match list(json, "a cell")? {
                [strip, cell] => Ok((count(strip, "a strip")?, count(cell, "a cell")?)),
                _ => Err("a cell is not a pair".to_owned()),
            };
            cells.push(list(region, "a region")?.iter().map(cell).collect::<Result<Vec<_>, _>>()?);
        }
        Ok(Statement {
            discrete,
            names,
            set: values(set)?,
            extent,
            domain: [interval(x)?, interval(y)?],
            regions: cells,
        })
    }

    fn in_words(&self, places: &[Place]) -> String {
        let mut out = String::from("For all real ");
        for (name, (lower, upper)) in self.names.iter().zip(&self.domain) {
            let and = if *name == self.names[0] { "" } else { " and " };
            let _ = match (lower, upper) {
                (None, None) => write!(out, "{and}{name}"),
                (Some(l), None) => write!(out, "{and}{name} > {}", exact(l)),
                (None, Some(u)) => write!(out, "{and}{name} < {}", exact(u)),
                (Some(l), Some(u)) => write!(out, "{and}{name} in ({}, {})", exact(l), exact(u)),
            };
        }
        out.push_str(&with_values(&self.set));
        let within = verdict::within(&self.extent, self.discrete);
        if self.regions.is_empty() {
            let _ = write!(out, ", the loop is stable{within} nowhere off its boundary curves.");
            return out;
        }
        let (n, [x, _]) = (self.regions.len(), [&self.names[0], &self.names[1]]);
        let _ = write!(out, ", the loop is stable{within}, off its boundary curves and ");
        let several = |n: usize| if n == 1 { "" } else { "s" };
        let _ = write!(out, "{0} line{1} of constant {x}, ", places.len(), several(places.len()));
        let _ = write!(out, "exactly in {n} connected region{}: ", several(n));
        for (i, region) in self.regions.iter().enumerate() {
            let first = region.iter().map(|c| c.0).min().unwrap_or(0);
            let last = region.iter().map(|c| c.0).max().unwrap_or(0);
            let end = |place: Option<&Place>, outer: &Option<Q>, infinite: &str| match (place, outer) {
                (Some(p), _) if p.is_rational() => exact(&p.left),
                (Some(p), _) => {
                    let [a, b] = outward(&p.left, &p.right);
                    format!("[a number between {a} and {b}]")
                }
                (None, Some(q)) => exact(q),
                (None, None) => infinite.to_owned(),
            };
            let lower = end(first.checked_sub(1).and_then(|k| places.get(k)), &self.domain[0].0, "-infinity");
            let upper = end(places.get(last), &self.domain[0].1, "infinity");
            let cells = format!("{} cell{}", region.len(), several(region.len()));
            let _ = write!(out, "{}{cells} for {x} from {lower} to {upper}", if i == 0 { "" } else { "; " });
        }
        out.push('.');
        out
    }
}

pub(super) fn check(model: &str, json: &Json, statement: &Json, clock: &Clock) -> Result<Proved, Rejection> {
    let keys = ["schema", "statement", "characteristic", "boundary", "factors", "x_factors", "strips", "joins"];
    let [_, _, characteristic, boundary, factors, x_factors, strips, joins] =
        Step::Format.of(object(json, "the certificate", keys, &["model"]))?;
    let s = Step::Statement.of(Statement::read(statement))?;
    let own = Step::Model.of(over_box(model, &s.names, &s.set, &Table::empty(), clock))?;
    Step::Model.of(is_same_time(own.discrete, s.discrete))?;
    let read = |json: &Json, _: &str| polynomial(json, s.names.len());
    let given = Step::Characteristic.of(polynomials(characteristic, "'characteristic'", read))?;
    let common = Step::Characteristic.of(common(&given, &own, &s, clock))?;
    // A divisor that is zero everywhere leaves nothing defined.
    let nowhere = own.divisors.iter().any(|parts| parts.iter().all(Multi::is_zero));
    let poles = if nowhere { vec![Multi::default()] } else { Vec::new() };
    // Of the root of a doubled polynomial it is half as large.
    let degree = if given.is_empty() { own.coefficients.len() - 1 } else { given.len() - 1 };
    let d = Loop { discrete: s.discrete, is_doubled: own.is_doubled, degree, coefficients: &given, poles: &poles };
    let found = Step::Boundary.of(boundaries(&d, boundary, &read, clock))?;
    let Some(found) = found else {
        let empty = |step: Step, json: &Json, what: &str| {
            step.of(match list(json, what) {
                Ok([]) => Ok(()),
                Ok(_) => Err(format!("{what} is not empty, but the loop is stable nowhere")),
                Err(e) => Err(e),
            })
        };
        empty(Step::Factors, factors, "'factors'")?;
        empty(Step::Projection, x_factors, "'x_factors'")?;
        empty(Step::Strips, strips, "'strips'")?;
        empty(Step::Joins, joins, "'joins'")?;
        let is_empty = if s.regions.is_empty() { Ok(()) } else { Err("the loop is stable nowhere".to_owned()) };
        Step::Stable.of(is_empty)?;
        return Ok(Proved { statement: s.in_words(&[]), kind: "map" });
    };
    let mut all: Vec<Vec<Multi>> = own.divisors.clone();
    all.push(vec![common]);
    all.extend(found.certain.into_iter().chain(found.pair.map(|pair| pair.value)).map(|p| vec![p]));
    let curves = Step::Factors.of(curves(factors, &all, clock))?;
    let (x_factors, places) = Step::Projection.of(walls(x_factors, &s.domain[0], clock))?;
    Step::Projection.of(covered(&curves, &x_factors, &s.domain[1], clock))?;
    let decomposed =
        Strips { discrete: s.discrete, characteristic: &given, curves: &curves, walls: &places, domain: &s.domain };
    let verdicts = Step::Strips.of(decomposed.cells(strips, clock))?;
    let regions = Step::Stable.of(numbered(&s.regions, &verdicts))?;
    Step::Joins.of((|| {
        let join = |(i, join)| decomposed.join(join, clock).map_err(|e| format!("join {i}: {e}"));
        let pairs = list(joins, "'joins'")?.iter().enumerate().map(join).collect::<Result<Vec<_>, _>>()?;
        connected(&s.regions, &regions, &pairs)
    })())?;
    Ok(Proved { statement: s.in_words(&places), kind: "map" })
}

/// What the model's own polynomial has beside the given one.
fn common(given: &[Multi], own: &OverBox, s: &Statement, clock: &Clock) -> Result<Multi, String> {
    let own_in_region = in_region(&own.coefficients, s.discrete, &s.extent, clock)?;
    let is_undefined = own.divisors.iter().any(|parts| parts.iter().all(Multi::is_zero));
    if given.is_empty() && is_undefined {
        return Ok(Multi::one());
    }
    if own_in_region.iter().all(Multi::is_zero) {
        return if given == own_in_region { Ok(Multi::one()) } else { Err("the model's polynomial is zero".into()) };
    }
    common_factor(given, &own_in_region, own.is_doubled, clock)
}

/// The curves: polynomials off whose zeros all the given ones are other than zero; of each list one.
fn curves(json: &Json, all: &[Vec<Multi>], clock: &Clock) -> Result<Vec<Curve>, String> {
    let mut factors = Vec::new();
    for factor in list(json, "'factors'")? {
        let f = primitive(vec![polynomial(factor, 2)?], clock)?.swap_remove(0);
        if f.is_constant() {
            return Err("a factor is constant".into());
        }
        factors.push(f);
    }
    for (i, parts) in all.iter().enumerate() {
        let mut is_known = false;
        for part in parts {
            is_known = is_known || Ground::integers(2).vanishes_only_with(part, &factors, clock)?;
        }
        if !is_known {
            return Err(format!("boundary polynomial {i} is not a product of the factors"));
        }
    }
    Ok(factors.iter().map(in_y).collect())
}

/// The region of each of its cells: exactly the stable ones have one.
fn numbered(
    regions: &[Vec<(usize, usize)>],
    verdicts: &[Vec<bool>],
) -> Result<BTreeMap<(usize, usize), usize>, String> {
    let mut out = BTreeMap::new();
    for (i, region) in regions.iter().enumerate() {
        if region.is_empty() {
            return Err(format!("region {i} has no cell"));
        }
        for cell in region {
            if verdicts.get(cell.0).and_then(|strip| strip.get(cell.1)) != Some(&true) {
                return Err(format!("cell {} of strip {} is not stable", cell.1, cell.0));
            }
            if out.insert(*cell, i).is_some() {
                return Err(format!("cell {} of strip {} is listed twice", cell.1, cell.0));
            }
        }
    }
    if out.len() == verdicts.iter().flatten().filter(|v| **v).count() {
        return Ok(out);
    }
    Err("a stable cell is in no region".into())
}

/// That the cells of each region are joined to one another.
fn connected(
    regions: &[Vec<(usize, usize)>],
    numbers: &BTreeMap<(usize, usize), usize>,
    joins: &[[(usize, usize); 2]],
) -> Result<(), String> {
    let mut parent: BTreeMap<(usize, usize), (usize, usize)> = numbers.keys().map(|c| (*c, *c)).collect();
    fn root(parent: &BTreeMap<(usize, usize), (usize, usize)>, mut cell: (usize, usize)) -> (usize, usize) {
        while parent[&cell] != cell {
            cell = parent[&cell];
        }
        cell
    }
    for (i, [a, b]) in joins.iter().enumerate() {
        if !numbers.contains_key(a) || numbers.get(a) != numbers.get(b) {
            return Err(format!("join {i} is not between cells of one region"));
        }
        let (a, b) = (root(&parent, *a), root(&parent, *b));
        parent.insert(a, b);
    }
    for (i, region) in regions.iter().enumerate() {
        let first = root(&parent, region[0]);
        if region.iter().any(|cell| root(&parent, *cell) != first) {
            return Err(format!("the cells of region {i} are not all joined"));
        }
    }
    Ok(())
}
