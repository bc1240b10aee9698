//! The verdict at one point, and statements in words.

use super::clock::Clock;
use super::complex::{Meant, meant};
use super::number::Q;
use super::roots::{Places, is_hurwitz, is_schur, places_by_axis, places_by_circle};
use super::statement::{self, End, Extent, count, fixed_extent, list, object, polynomial, polynomials, text, values};
use super::univariate::Uni;
use super::words::{exact, shared_digits, with_decimal};
use super::{Proved, Rejection, Step, by_enclosures, further_keys, held, is_discrete, model, region, table};
use crate::format::{Json, SCHEMA_BY_ENCLOSURES};
use num_traits::Zero;
use std::fmt::Write;

/// What shows a verdict.
enum Shown<'j> {
    /// The characteristic polynomial.
    Polynomial(&'j Json),
    /// Enclosures with so many bits.
    Enclosures(usize),
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
    let keys = ["kind", "time", "set", "region", "verdict", "degree", "inside", "on", "outside", "infinite"];
    let [_, time, set, region, verdict, degree, inside, on, outside, infinite] =
        Step::Statement.of(object(statement, "the statement", keys, &[]))?;
    let discrete = Step::Statement.of(is_discrete(time))?;
    let set = Step::Statement.of(values(set))?;
    let extent = Step::Statement.of(fixed_extent(region, discrete))?;
    let verdict = Step::Statement.of(text(verdict, "'verdict'"))?;
    let claimed = Step::Statement.of((|| {
        Ok([
            count(degree, "'degree'")?,
            count(inside, "'inside'")?,
            count(on, "'on'")?,
            count(outside, "'outside'")?,
            count(infinite, "'infinite'")?,
        ])
    })())?;
    let (degree, name, places, infinite) = match (shown, &table) {
        (Shown::Polynomial(characteristic), None) => rational(model, discrete, &set, &extent, characteristic, clock)?,
        (Shown::Enclosures(_), _) | (_, Some(_)) if !discrete => {
            let reason = "the model's time is not that of the statement".into();
            return Err(Rejection { step: Step::Model, reason });
        }
        (Shown::Enclosures(bits), _) => {
            let (degree, places) = by_enclosures::places(model, &set, &extent, bits, clock)?;
            (degree, named(&places, 0), places, 0)
        }
        (Shown::Polynomial(characteristic), Some(table)) => {
            let (d, poles, is_doubled) =
                held::characteristic(model, None, &set, &extent, characteristic, table, clock)?;
            let found = Step::Stable.of(held::places(&d, &poles, table, clock))?;
            let (degree, places) = match is_doubled {
                true => ((d.len() - 1) / 2, Step::Stable.of(found.halved())?),
                false => (d.len() - 1, found),
            };
            (degree, named(&places, 0), places, 0)
        }
    };
    if verdict != name {
        return Err(Rejection { step: Step::Stable, reason: format!("the verdict is '{name}'") });
    }
    let found = [degree, places.inside, places.on, places.outside, infinite];
    if claimed != found {
        let [n, i, o, x, l] = found;
        let reason = format!("degree {n}: {i} roots are inside, {o} on the boundary, {x} outside, {l} infinite");
        return Err(Rejection { step: Step::Stable, reason });
    }
    let mut sentence = String::new();
    let values: Vec<String> = set.iter().map(|(n, v)| format!("{n} = {}", exact(v))).collect();
    if !values.is_empty() {
        let _ = write!(sentence, "At {}, ", values.join(", "));
    }
    let _ = match name {
        "undefined" => write!(sentence, "the loop is undefined."),
        _ => write!(
            sentence,
            "the loop is {name}{}: {} roots inside, {} on the boundary, {} outside, {infinite} infinite.",
            within(&extent, discrete),
            places.inside,
            places.on,
            places.outside
        ),
    };
    Ok(Proved { statement: sentence, kind: "verdict" })
}

/// The verdict of a loop without symbols: its degree, name, and where the roots are.
fn rational(
    model: &str,
    discrete: bool,
    set: &[(String, Q)],
    extent: &Extent,
    characteristic: &Json,
    clock: &Clock,
) -> Result<(usize, &'static str, Places, usize), Rejection> {
    let d = Step::Model.of(model::read(model, None, set, clock))?;
    if d.discrete != discrete {
        return Err(Rejection { step: Step::Model, reason: "the model's time is not that of the statement".into() });
    }
    let coefficients = Step::Model.of(region::transformed(&d.coefficients, discrete, extent, clock))?;
    let given = Step::Characteristic.of(polynomials(characteristic, "'characteristic'", polynomial))?;
    let meant = Step::Characteristic.of(meant(&given, &coefficients, d.is_doubled, clock))?;
    let (coefficients, degree) = match meant {
        Meant::Root => (given, d.degree / 2),
        Meant::Own | Meant::Doubled => (coefficients, d.degree),
    };
    let undefined = d.poles.iter().any(Uni::is_zero);
    let polynomial = Uni::new(coefficients.iter().map(|c| c.at(0)).collect());
    let (name, places, infinite) = if undefined {
        ("undefined", Places::default(), 0)
    } else if polynomial.is_zero() {
        ("unstable", Places::default(), degree)
    } else {
        let places = if discrete { places_by_circle(&polynomial, clock) } else { places_by_axis(&polynomial, clock) };
        let places = Step::Stable.of(places)?;
        let infinite = degree - polynomial.degree();
        let quick = if discrete { is_schur(&polynomial, clock) } else { is_hurwitz(&polynomial, clock) };
        if Step::Stable.of(quick)? != (places.on + places.outside == 0) {
            return Err(Rejection { step: Step::Stable, reason: "internal: two tests disagree".into() });
        }
        (named(&places, infinite), places, infinite)
    };
    Ok(match meant {
        Meant::Doubled => (degree / 2, name, Step::Stable.of(places.halved())?, infinite / 2),
        Meant::Own | Meant::Root => (degree, name, places, infinite),
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

/// The statement about one parameter in words. An irrational end is given by its enclosure.
pub(super) fn sentence_of_intervals(
    parameter: &str,
    set: &[(String, Q)],
    extent: &Extent,
    discrete: bool,
    domain: &(Option<Q>, Option<Q>),
    stable: &Json,
) -> String {
    let mut out = String::from("For all real ");
    out.push_str(parameter);
    let _ = match domain {
        (None, None) => Ok(()),
        (Some(l), None) => write!(out, " > {}", exact(l)),
        (None, Some(u)) => write!(out, " < {}", exact(u)),
        (Some(l), Some(u)) => write!(out, " in ({}, {})", exact(l), exact(u)),
    };
    for (i, (name, value)) in set.iter().enumerate() {
        let _ = write!(out, "{}{name} = {}", if i == 0 { ", with " } else { ", " }, exact(value));
    }
    let _ = write!(out, ", the loop is stable{}", within(extent, discrete));
    let intervals = list(stable, "").unwrap_or_default();
    if intervals.is_empty() {
        out.push_str(" nowhere.");
        return out;
    }
    out.push_str(" exactly for ");
    let mut origins: Vec<String> = Vec::new();
    for (i, interval) in intervals.iter().enumerate() {
        if i > 0 {
            out.push_str(" or ");
        }
        let [lower, upper] = ["lower", "upper"].map(|key| {
            let (number, origin) = interval.get(key).and_then(|e| end(e, parameter))?;
            origins.extend(origin.map(|o| format!("{number} is {o}")).filter(|o| !origins.contains(o)));
            Some(number)
        });
        out.push_str(&match (lower, upper) {
            (None, None) => "all of them".to_owned(),
            (Some(l), None) => format!("{parameter} > {l}"),
            (None, Some(u)) => format!("{parameter} < {u}"),
            (Some(l), Some(u)) => format!("{l} < {parameter} < {u}"),
        });
    }
    if !origins.is_empty() {
        let _ = write!(out, ", where {}", origins.join(", and "));
    }
    out.push('.');
    out
}

/// Polynomials that take more characters than this are not written out.
const SHOWN: usize = 200;

/// An end as a number, and for an irrational one what it is; `None` for an infinite one.
fn end(json: &Json, parameter: &str) -> Option<(String, Option<String>)> {
    if let Some(Json::Text(number)) = json.get("switch") {
        return Some((number.clone(), Some("a dead time with roots on the axis".into())));
    }
    let (f, a, b) = match statement::end(json, |p: &Json, _: &str| Ok(p.clone())).ok()? {
        End::Infinite => return None,
        End::Rational(q) => return Some((with_decimal(&q), None)),
        End::Root(f, a, b) => (f, a, b),
    };
    let polynomial = match polynomial(&f, "") {
        Err(_) => "a polynomial over exponentials in 'stable'".to_owned(),
        Ok(f) => {
            let terms = f.0.iter().enumerate().filter(|(_, c)| !c.is_zero()).map(|(k, c)| match k {
                0 => c.to_string(),
                1 => format!("{c}*{parameter}"),
                _ => format!("{c}*{parameter}^{k}"),
            });
            let polynomial = terms.collect::<Vec<_>>().join(" + ").replace("+ -", "- ");
            if polynomial.len() > SHOWN {
                format!("a polynomial of degree {} in 'stable'", f.degree())
            } else {
                polynomial
            }
        }
    };
    Some((shared_digits(&a, &b), Some(format!("a root of {polynomial}"))))
}
