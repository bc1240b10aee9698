//! The verdict at one point.

use super::characteristic::Characteristic;
use super::clock::Clock;
use super::complex::Meant;
use super::held::{self, Question};
use super::number::Q;
use super::roots::{Places, is_hurwitz, is_schur, places_by_axis, places_by_circle};
use super::statement::{Extent, count, fixed_extent, object, text, values};
use super::univariate::Uni;
use super::words::{self, exact};
use super::{Proved, Rejection, Step, by_enclosures, further_keys, is_discrete, is_same_time, table};
use crate::format::{Json, SCHEMA_BY_ENCLOSURES};

/// What shows a verdict.
enum Shown<'j> {
    /// The characteristic polynomial.
    Polynomial(&'j Json),
    /// Enclosures with so many bits.
    Enclosures(usize),
}

/// What is said of a loop whose parameters all have values.
struct Statement<'j> {
    discrete: bool,
    set: Vec<(String, Q)>,
    extent: Extent,
    verdict: &'j str,
    /// The degree, and how many roots are inside, on the boundary, outside and infinite.
    counts: [usize; 5],
}

impl<'j> Statement<'j> {
    fn read(json: &'j Json) -> Result<Self, String> {
        let keys = ["kind", "time", "set", "region", "verdict", "degree", "inside", "on", "outside", "infinite"];
        let [_, time, set, region, verdict, numbers @ ..] = object(json, "the statement", keys, &[])?;
        let discrete = is_discrete(time)?;
        let (set, extent) = (values(set)?, fixed_extent(region, discrete)?);
        let verdict = text(verdict, "'verdict'")?;
        let mut counts = [0; 5];
        for ((target, json), key) in counts.iter_mut().zip(numbers).zip(&keys[5..]) {
            *target = count(json, &format!("'{key}'"))?;
        }
        Ok(Statement { discrete, set, extent, verdict, counts })
    }

    fn in_words(&self) -> String {
        let (name, [_, inside, on, outside, infinite]) = (self.verdict, self.counts);
        let at = match self.set.as_slice() {
            [] => String::new(),
            set => format!("At {}, ", words::values(set.iter().map(|(name, value)| (name, value)))),
        };
        let within = within(&self.extent, self.discrete);
        match name {
            "undefined" => format!("{at}the loop is undefined."),
            _ => format!(
                "{at}the loop is {name}{within}: {inside} roots inside, {on} on the boundary, {outside} outside, {infinite} infinite."
            ),
        }
    }
}

/// What is found of a loop.
struct Found {
    name: &'static str,
    degree: usize,
    places: Places,
    infinite: usize,
}

impl Found {
    /// Of a loop without infinite roots.
    fn of(degree: usize, places: Places) -> Self {
        Found { name: named(&places, 0), degree, places, infinite: 0 }
    }
}

pub(super) fn check(model: &str, json: &Json, statement: &Json, clock: &Clock) -> Result<Proved, Rejection> {
    let table = table(json)?;
    let shown = Step::Format.of((|| {
        if json.get("schema") == Some(&Json::Text(SCHEMA_BY_ENCLOSURES.into())) {
            let [_, _, bits] = object(json, "the certificate", ["schema", "statement", "bits"], &["model"])?;
            return match count(bits, "'bits'")? {
                bits @ 64..=1024 => Ok(Shown::Enclosures(bits)),
                _ => Err("'bits' is not from 64 to 1024".to_owned()),
            };
        }
        let parts = ["schema", "statement", "characteristic"];
        let [_, _, polynomial] = object(json, "the certificate", parts, further_keys(table.as_ref()))?;
        Ok(Shown::Polynomial(polynomial))
    })())?;
    let s = Step::Statement.of(Statement::read(statement))?;
    let question = Question { model, kept: None, set: &s.set, extent: &s.extent, discrete: s.discrete };
    let Found { name, degree, places, infinite } = match (shown, &table) {
        (Shown::Polynomial(characteristic), None) => rational(&question, characteristic, clock)?,
        (Shown::Enclosures(bits), _) => {
            Step::Model.of(is_same_time(true, s.discrete))?;
            let (degree, places) = by_enclosures::places(model, &s.set, &s.extent, bits, clock)?;
            Found::of(degree, places)
        }
        (Shown::Polynomial(characteristic), Some(table)) => {
            Step::Model.of(is_same_time(true, s.discrete))?;
            let d = question.over_symbols(characteristic, table, clock)?;
            let places = Step::Stable.of(held::places(&d.coefficients, &d.poles, table, clock))?;
            let degree = d.coefficients.len() - 1;
            match d.is_doubled {
                true => Found::of(degree / 2, Step::Stable.of(places.halved())?),
                false => Found::of(degree, places),
            }
        }
    };
    if s.verdict != name {
        return Step::Stable.fails(format!("the verdict is '{name}'"));
    }
    let found = [degree, places.inside, places.on, places.outside, infinite];
    if s.counts != found {
        return Step::Stable.fails(told_counts(found));
    }
    Ok(Proved { statement: s.in_words(), kind: "verdict" })
}

/// Where a degree's roots are.
pub(super) fn told_counts([n, inside, on, outside, infinite]: [usize; 5]) -> String {
    format!("degree {n}: {inside} roots are inside, {on} on the boundary, {outside} outside, {infinite} infinite")
}

/// The verdict of a loop without symbols.
fn rational(question: &Question<'_>, characteristic: &Json, clock: &Clock) -> Result<Found, Rejection> {
    let (d, meant) = question.rational(characteristic, clock)?;
    let Characteristic { discrete, degree, .. } = d;
    let polynomial = Uni::new(d.coefficients.iter().map(|c| c.at(0)).collect());
    let (name, places, infinite) = if d.poles.iter().any(Uni::is_zero) {
        ("undefined", Places::default(), 0)
    } else if polynomial.is_zero() {
        ("unstable", Places::default(), degree)
    } else {
        let places = if discrete { places_by_circle(&polynomial, clock) } else { places_by_axis(&polynomial, clock) };
        let places = Step::Stable.of(places)?;
        let infinite = degree - polynomial.degree();
        let quick = if discrete { is_schur(&polynomial, clock) } else { is_hurwitz(&polynomial, clock) };
        if Step::Stable.of(quick)? != (places.on + places.outside == 0) {
            return Step::Stable.fails("internal: two tests disagree");
        }
        (named(&places, infinite), places, infinite)
    };
    Ok(match meant {
        Meant::Doubled => {
            let places = Step::Stable.of(places.halved())?;
            Found { name, degree: degree / 2, places, infinite: infinite / 2 }
        }
        Meant::Own | Meant::Root => Found { name, degree, places, infinite },
    })
}

/// What the verdict is called.
fn named(places: &Places, infinite: usize) -> &'static str {
    match (places.outside + infinite, places.on) {
        (0, 0) => "stable",
        (0, _) => "marginal",
        _ => "unstable",
    }
}

/// The region, if it is not the usual one.
pub(super) fn within(extent: &Extent, discrete: bool) -> String {
    match extent {
        Extent::Parameter if discrete => " with all |z| < radius".into(),
        Extent::Parameter => " with all Re s < -decay".into(),
        Extent::Number(r) if discrete && *r != Q::from(num_bigint::BigInt::from(1)) => {
            format!(" with all |z| < {}", exact(r))
        }
        Extent::Number(s) if !discrete && *s != Q::from(num_bigint::BigInt::from(0)) => {
            format!(" with all Re s < {}", exact(&-s))
        }
        Extent::Number(_) => String::new(),
    }
}
