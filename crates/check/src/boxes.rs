//! Boxes of tolerances that are stable at every point, and points beyond that are not.

mod ground;

pub(super) use ground::Ground;

use super::bernstein::{Claim, Tensor, walk};
use super::clock::Clock;
use super::multivariate::Multi;
use super::number::{Q, Z, integer};
use super::over_box::{FIRST, OverBox, common_factor, in_half_plane, in_region, over_box};
use super::over_symbols::{primitive, substituted};
use super::roots::Places;
use super::statement::{Extent, count, fixed_extent, identifier, list, number, object, text, values};
use super::symbols::Table;
use super::univariate::Uni;
use super::words::{self, exact, inward, with_values};
use super::{Proved, Rejection, Step, further_keys, is_discrete, is_same_time, table, verdict};
use crate::format::Json;
use num_traits::{Signed, Zero};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A higher power of a parameter is refused.
const MAX_EXPONENT: usize = 4000;

/// The values of one parameter.
struct Tolerance {
    nominal: Q,
    between: [Q; 2],
}

impl Tolerance {
    /// The interval that is a factor times as wide, on both sides of the nominal value.
    fn times(&self, factor: &Q) -> [Q; 2] {
        self.between.each_ref().map(|end| &self.nominal + factor * (end - &self.nominal))
    }
}

/// A point that is not stable.
struct Beyond {
    factor: Q,
    point: Vec<Q>,
    counts: [usize; 5],
}

impl Beyond {
    fn read(json: &Json) -> Result<Self, String> {
        let keys = ["factor", "point", "degree", "inside", "on", "outside", "infinite"];
        let [factor, point, counts @ ..] = object(json, "'beyond'", keys, &[])?;
        let point = list(point, "'point'")?.iter().map(|x| number(x, "'point'")).collect::<Result<Vec<_>, _>>()?;
        let mut numbers = [0; 5];
        for (target, json) in numbers.iter_mut().zip(counts) {
            *target = count(json, "a count")?;
        }
        Ok(Beyond { factor: number(factor, "'factor'")?, point, counts: numbers })
    }
}

struct Statement {
    discrete: bool,
    set: Vec<(String, Q)>,
    extent: Extent,
    names: Vec<String>,
    sides: Vec<Tolerance>,
    factor: Q,
    /// Beyond the range of this one alone the points are, in the tolerances of the others.
    limit: Option<usize>,
    beyond: Vec<Beyond>,
}

impl Statement {
    fn read(json: &Json) -> Result<Self, String> {
        let keys = ["kind", "time", "set", "region", "tolerances", "factor", "limit", "beyond"];
        let [_, time, set, region, tolerances, factor, limit, beyond] = object(json, "the statement", keys, &[])?;
        let discrete = is_discrete(time)?;
        let extent = fixed_extent(region, discrete)?;
        let (mut names, mut sides) = (Vec::new(), Vec::new());
        for tolerance in list(tolerances, "'tolerances'")? {
            let [name, nominal, between] = object(tolerance, "a tolerance", ["name", "nominal", "between"], &[])?;
            names.push(identifier(text(name, "'name'")?)?.to_owned());
            let nominal = number(nominal, "'nominal'")?;
            let [low, high] = list(between, "'between'")? else { return Err("'between' has two ends".into()) };
            let between = [number(low, "'between'")?, number(high, "'between'")?];
            if between[0] > nominal || nominal > between[1] {
                return Err("a nominal value is not within its tolerance".into());
            }
            sides.push(Tolerance { nominal, between });
        }
        let factor = number(factor, "'factor'")?;
        if names.is_empty() || factor.is_negative() {
            return Err("there is no box, or its factor is negative".into());
        }
        let limit = match limit {
            Json::Null => None,
            name => {
                let name = text(name, "'limit'")?;
                Some(names.iter().position(|n| n == name).ok_or("the limit is that of no tolerance")?)
            }
        };
        let beyond = list(beyond, "'beyond'")?.iter().map(Beyond::read).collect::<Result<_, _>>()?;
        Ok(Statement { discrete, set: values(set)?, extent, names, sides, factor, limit, beyond })
    }

    /// The box of a factor.
    fn at(&self, factor: &Q) -> Vec<[Q; 2]> {
        self.sides.iter().map(|side| side.times(factor)).collect()
    }

    /// The box in which a point beyond is: of its factor, in the limit's range alone where there is one.
    fn around(&self, beyond: &Beyond) -> Vec<[Q; 2]> {
        let own = |i: usize| if self.limit.is_none_or(|at| at == i) { &beyond.factor } else { &self.factor };
        self.sides.iter().enumerate().map(|(i, side)| side.times(own(i))).collect()
    }

    fn in_words(&self) -> String {
        let mut out = String::from("For all ");
        for (i, (name, [low, high])) in self.names.iter().zip(self.at(&self.factor)).enumerate() {
            let [low, high] = inward(&low, &high);
            let _ = write!(out, "{}{name} from {low} to {high}", if i == 0 { "" } else { ", " });
        }
        let (with, within) = (with_values(&self.set), verdict::within(&self.extent, self.discrete));
        let _ =
            write!(out, "{with}, the loop is stable{within}; these are the tolerances times {}.", exact(&self.factor));
        for Beyond { factor, point, counts: [degree, inside, on, outside, infinite] } in &self.beyond {
            let (point, factor) = (words::values(self.names.iter().zip(point)), exact(factor));
            let _ = match self.limit {
                None => write!(out, " At {point}, within the tolerances times {factor}, it is not: "),
                Some(at) => {
                    let name = &self.names[at];
                    write!(out, " At {point}, the range of {name} alone times {factor}, it is not: ")
                }
            };
            let _ = match inside + on + outside + infinite < *degree {
                true => write!(out, "it is undefined there."),
                false => write!(
                    out,
                    "{inside} roots are inside, {on} on the boundary, {outside} outside, {infinite} infinite."
                ),
            };
        }
        out
    }
}

pub(super) fn check(model: &str, json: &Json, statement: &Json, clock: &Clock) -> Result<Proved, Rejection> {
    let table = table(json)?;
    let keys = ["schema", "statement", "characteristic", "factors", "pair"];
    let [_, _, characteristic, factors, pair] =
        Step::Format.of(object(json, "the certificate", keys, further_keys(table.as_ref())))?;
    let s = Step::Statement.of(Statement::read(statement))?;
    let none = Table::empty();
    let own = Step::Model.of(over_box(model, &s.names, &s.set, table.as_deref().unwrap_or(&none), clock))?;
    Step::Model.of(is_same_time(own.discrete, s.discrete))?;
    if table.is_some() && !s.discrete {
        return Step::Model.fails("only sampled loops have symbols");
    }
    let ground = Ground::new(s.names.len(), table);
    let in_this_region = Step::Model.of(in_region(&own.coefficients, s.discrete, &s.extent, clock))?;
    let read = |json: &Json| polynomial(json, ground.variables());
    let (given, common) = Step::Characteristic.of((|| {
        let given = list(characteristic, "'characteristic'")?.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let common = common_factor(&given, &in_this_region, own.is_doubled, clock)?;
        Ok((given, common))
    })())?;
    let p = if s.discrete { Step::Characteristic.of(in_half_plane(&given, clock))? } else { given.clone() };
    let sides = s.at(&s.factor);
    Step::Factors.of((|| {
        let known = factors_without_zero(factors, &sides, &ground, clock)?;
        let ends = [&common, &p[0], &p[p.len() - 1]].map(|p| vec![p.clone()]);
        for parts in own.divisors.iter().chain(&ends) {
            let mut is_known = false;
            for part in parts {
                is_known = is_known || ground.vanishes_only_with(part, &known, clock)?;
            }
            if !is_known {
                return Err("what must not vanish is not a product of the factors".to_owned());
            }
        }
        Ok(())
    })())?;
    Step::Boundary.of((|| {
        let [v0, weight, tree] = object(pair, "'pair'", ["v0", "weight", "tree"], &[])?;
        let (v0, weight) = (number(v0, "'v0'")?, number(weight, "'weight'")?);
        if !v0.is_positive() || !weight.is_positive() {
            return Err("'v0' or 'weight' is not positive".to_owned());
        }
        let whole = Tensor::of_pair(&p, &sides, [&v0, &weight], &ground, clock)?;
        walk(text(tree, "'tree'")?, whole, Claim::Pair, clock)
    })())?;
    Step::Stable.of((|| {
        let nominal: Vec<Q> = s.sides.iter().map(|side| side.nominal.clone()).collect();
        if !ground.is_stable(&given, &nominal, s.discrete, clock)? {
            return Err("the nominal point is not stable".to_owned());
        }
        s.beyond.iter().try_for_each(|beyond| s.is_beyond(beyond, &own, &in_this_region, &ground, clock))
    })())?;
    Ok(Proved { statement: s.in_words(), kind: "tolerance" })
}

/// The factors of a certificate. They have no zero in the box.
fn factors_without_zero(json: &Json, sides: &[[Q; 2]], ground: &Ground, clock: &Clock) -> Result<Vec<Multi>, String> {
    let mut known = Vec::new();
    for factor in list(json, "'factors'")? {
        let [p, tree] = object(factor, "a factor", ["polynomial", "tree"], &[])?;
        let f = primitive(vec![polynomial(p, ground.variables())?], clock)?.swap_remove(0);
        if !ground.is_in_parameters(&f) {
            return Err("a factor is constant".to_owned());
        }
        walk(text(tree, "'tree'")?, Tensor::of_one(&f, sides, ground, clock)?, Claim::Sign, clock)?;
        known.push(f);
    }
    Ok(known)
}

impl Statement {
    /// Whether the point is in its box, has these counts, and is not stable.
    fn is_beyond(
        &self,
        beyond: &Beyond,
        own: &OverBox,
        d: &[Multi],
        ground: &Ground,
        clock: &Clock,
    ) -> Result<(), String> {
        let sides = self.around(beyond);
        let is_inside = |(x, [low, high]): (&Q, &[Q; 2])| low <= x && x <= high;
        if beyond.factor.is_negative()
            || beyond.point.len() != sides.len()
            || !beyond.point.iter().zip(&sides).all(is_inside)
        {
            return Err("the point is not in its box".into());
        }
        let mut n = d.len() - 1;
        let mut is_undefined = false;
        for parts in &own.divisors {
            is_undefined = is_undefined || ground.vanish_at(parts, &beyond.point, clock)?;
        }
        let (mut places, mut infinite) = match is_undefined {
            true => (Places::default(), 0),
            false => ground.places(d, &beyond.point, self.discrete, clock)?,
        };
        if own.is_doubled {
            (n, places, infinite) = (n / 2, places.halved()?, infinite / 2);
        }
        let Places { inside, on, outside } = places;
        if beyond.counts != [n, inside, on, outside, infinite] {
            return Err(verdict::told_counts([n, inside, on, outside, infinite]));
        }
        // The zero polynomial of degree 0 has no roots to count, and is not stable.
        let is_zero = !is_undefined && n == 0 && ground.vanish_at(d, &beyond.point, clock)?;
        if !is_undefined && !is_zero && on + outside + infinite == 0 {
            return Err("the point beyond is stable".into());
        }
        Ok(())
    }
}

/// Polynomials at a point, together times a positive number; symbols become the variables from [`FIRST`] on.
fn values_at(list: &[Multi], point: &[Q], clock: &Clock) -> Result<Vec<Multi>, String> {
    // Variables 0 and 1 are not there.
    let values: Vec<Q> = (0..FIRST).map(|_| Q::zero()).chain(point.iter().cloned()).collect();
    substituted(list, &values, clock)
}

/// The same without symbols, as coefficients of one polynomial.
pub(super) fn at(list: &[Multi], point: &[Q], clock: &Clock) -> Result<Uni, String> {
    let constant = |p: Multi| p.0.into_values().next().unwrap_or_default();
    Ok(Uni::new(values_at(list, point, clock)?.into_iter().map(constant).collect()))
}

/// Reads a list of terms: each its coefficient and the exponents of the parameters of the box, and of the symbols.
pub(super) fn polynomial(json: &Json, variables: usize) -> Result<Multi, String> {
    let mut terms: BTreeMap<Vec<u32>, Z> = BTreeMap::new();
    for term in list(json, "a polynomial")? {
        let [c, exponents @ ..] = list(term, "a term")? else { return Err("a term is empty".into()) };
        let c = integer(text(c, "a coefficient")?)?;
        let exponents = exponents.iter().map(|e| count(e, "an exponent")).collect::<Result<Vec<_>, _>>()?;
        if c.is_zero() || exponents.last() == Some(&0) || exponents.len() > variables {
            return Err("a term is not in its shortest form".into());
        }
        if exponents.iter().any(|e| *e > MAX_EXPONENT) {
            return Err("a polynomial has too high a degree".into());
        }
        let key = match exponents.is_empty() {
            true => Vec::new(),
            false => std::iter::repeat_n(0, FIRST).chain(exponents.into_iter().map(|e| e as u32)).collect(),
        };
        if terms.insert(key, c).is_some() {
            return Err("a polynomial has a term twice".into());
        }
    }
    Ok(Multi(terms))
}
