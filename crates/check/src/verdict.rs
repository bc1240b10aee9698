//! The verdict at one point, and statements in words.

use super::clock::Clock;
use super::number::Q;
use super::roots::{Places, is_hurwitz, is_schur, places_by_axis, places_by_circle};
use super::statement::{self, End, Extent, count, extent, list, object, polynomials, text, values};
use super::univariate::Uni;
use super::{Proved, Rejection, Step, is_discrete, model, region, same_characteristic};
use crate::format::Json;
use num_traits::Zero;
use std::fmt::Write;

pub(super) fn check(model: &str, json: &Json, statement: &Json, clock: &Clock) -> Result<Proved, Rejection> {
    let [_, _, characteristic] =
        Step::Format.of(object(json, "the certificate", ["schema", "statement", "characteristic"], &["model"]))?;
    let keys = ["kind", "time", "set", "region", "verdict", "degree", "inside", "on", "outside", "infinite"];
    let [_, time, set, region, verdict, degree, inside, on, outside, infinite] =
        Step::Statement.of(object(statement, "the statement", keys, &[]))?;
    let discrete = Step::Statement.of(is_discrete(time))?;
    let set = Step::Statement.of(values(set))?;
    let extent = Step::Statement.of(extent(region, discrete))?;
    if extent == Extent::Parameter {
        return Err(Rejection { step: Step::Statement, reason: "the region has no parameter here".into() });
    }
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
    let d = Step::Model.of(model::read(model, None, &set, clock))?;
    if d.discrete != discrete {
        return Err(Rejection { step: Step::Model, reason: "the model's time is not that of the statement".into() });
    }
    let coefficients = region::transformed(&d.coefficients, discrete, &extent);
    let given = Step::Characteristic.of(polynomials(characteristic, "'characteristic'"))?;
    Step::Characteristic.of(same_characteristic(&given, &coefficients))?;
    let undefined = d.poles.iter().any(Uni::is_zero);
    let polynomial = Uni::new(coefficients.iter().map(|c| c.at(0)).collect());
    let (name, places, infinite) = if undefined {
        ("undefined", Places::default(), 0)
    } else if polynomial.is_zero() {
        ("unstable", Places::default(), d.degree)
    } else {
        let places = if discrete { places_by_circle(&polynomial, clock) } else { places_by_axis(&polynomial, clock) };
        let places = Step::Stable.of(places)?;
        let infinite = d.degree - polynomial.degree();
        let quick = if discrete { is_schur(&polynomial, clock) } else { is_hurwitz(&polynomial, clock) };
        if Step::Stable.of(quick)? != (places.on + places.outside == 0) {
            return Err(Rejection { step: Step::Stable, reason: "internal: two tests disagree".into() });
        }
        let name = match (places.outside + infinite, places.on) {
            (0, 0) => "stable",
            (0, _) => "marginal",
            _ => "unstable",
        };
        (name, places, infinite)
    };
    if verdict != name {
        return Err(Rejection { step: Step::Stable, reason: format!("the verdict is '{name}'") });
    }
    let found = [d.degree, places.inside, places.on, places.outside, infinite];
    if claimed != found {
        let [n, i, o, x, l] = found;
        let reason = format!("degree {n}: {i} roots are inside, {o} on the boundary, {x} outside, {l} infinite");
        return Err(Rejection { step: Step::Stable, reason });
    }
    let mut sentence = String::new();
    let values: Vec<String> = set.iter().map(|(n, v)| format!("{n} = {v}")).collect();
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

/// The region, if it is not the usual one.
fn within(extent: &Extent, discrete: bool) -> String {
    match extent {
        Extent::Parameter if discrete => " with all |z| < radius".into(),
        Extent::Parameter => " with all Re s < -decay".into(),
        Extent::Number(r) if discrete && *r != Q::from(num_bigint::BigInt::from(1)) => format!(" with all |z| < {r}"),
        Extent::Number(s) if !discrete && *s != Q::from(num_bigint::BigInt::from(0)) => {
            format!(" with all Re s < -({s})")
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
        (Some(l), None) => write!(out, " > {l}"),
        (None, Some(u)) => write!(out, " < {u}"),
        (Some(l), Some(u)) => write!(out, " in ({l}, {u})"),
    };
    for (i, (name, value)) in set.iter().enumerate() {
        let _ = write!(out, "{}{name} = {value}", if i == 0 { ", with " } else { ", " });
    }
    let _ = write!(out, ", the loop is stable{}", within(extent, discrete));
    let intervals = list(stable, "").unwrap_or_default();
    if intervals.is_empty() {
        out.push_str(" nowhere.");
        return out;
    }
    out.push_str(" exactly for ");
    for (i, interval) in intervals.iter().enumerate() {
        if i > 0 {
            out.push_str(" or ");
        }
        let [lower, upper] = ["lower", "upper"].map(|key| interval.get(key).and_then(|e| end(e, parameter)));
        out.push_str(&match (lower, upper) {
            (None, None) => "all of them".to_owned(),
            (Some(l), None) => format!("{parameter} > {l}"),
            (None, Some(u)) => format!("{parameter} < {u}"),
            (Some(l), Some(u)) => format!("{l} < {parameter} < {u}"),
        });
    }
    out.push('.');
    out
}

/// Polynomials that take more characters than this are not written out.
const SHOWN: usize = 500;

/// An end in words; `None` for an infinite one.
fn end(json: &Json, parameter: &str) -> Option<String> {
    match statement::end(json).ok()? {
        End::Infinite => None,
        End::Rational(q) => Some(q.to_string()),
        End::Root(f, a, b) => {
            let terms = f.0.iter().enumerate().filter(|(_, c)| !c.is_zero()).map(|(k, c)| match k {
                0 => c.to_string(),
                1 => format!("{c}*{parameter}"),
                _ => format!("{c}*{parameter}^{k}"),
            });
            let mut polynomial = terms.collect::<Vec<_>>().join(" + ").replace("+ -", "- ");
            if polynomial.len() > SHOWN {
                polynomial = format!("the polynomial of degree {} in 'stable'", f.degree());
            }
            Some(format!("[the root in ({a}, {b}) of {polynomial}]"))
        }
    }
}
