//! What a certificate says of one parameter.

use crate::format::Json;
use crate::is_discrete;
use crate::number::Q;
use crate::statement::{
    Domain, End, Extent, end as read_end, extent, identifier, interval, list, object, polynomial, text, values,
};
use crate::verdict::within;
use crate::words::{digits_apart, exact, shared_digits, with_decimal, with_values};
use num_traits::Zero;
use std::fmt::Write;

/// For which values of a parameter a loop is stable.
pub(crate) struct Statement<'j> {
    pub discrete: bool,
    pub parameter: &'j str,
    pub set: Vec<(String, Q)>,
    pub extent: Extent,
    pub domain: Domain,
    pub stable: &'j Json,
}

impl<'j> Statement<'j> {
    pub fn read(json: &'j Json) -> Result<Self, String> {
        let keys = ["kind", "time", "parameter", "set", "region", "domain", "stable"];
        let [_, time, parameter, set, region, domain, stable] = object(json, "the statement", keys, &[])?;
        let discrete = is_discrete(time)?;
        let (parameter, set) = (identifier(text(parameter, "'parameter'")?)?, values(set)?);
        let (extent, domain) = (extent(region, discrete)?, interval(domain)?);
        if extent == Extent::Parameter {
            if parameter != if discrete { "radius" } else { "decay" } {
                return Err("the region depends on the parameter, which is not its radius or decay".into());
            }
            if discrete && domain.0.as_ref().is_none_or(|l| *l < Q::zero()) {
                return Err("a radius is positive".into());
            }
            if set.iter().any(|(name, _)| name == parameter) {
                return Err(format!("'{parameter}' is also a parameter of the model"));
            }
        }
        Ok(Statement { discrete, parameter, set, extent, domain, stable })
    }

    /// The statement about one parameter in words. An irrational end is given by its enclosure.
    pub fn in_words(&self, stable: &Json) -> String {
        let parameter = self.parameter;
        let mut out = format!("For all real {parameter}");
        let _ = match &self.domain {
            (None, None) => Ok(()),
            (Some(l), None) => write!(out, " > {}", exact(l)),
            (None, Some(u)) => write!(out, " < {}", exact(u)),
            (Some(l), Some(u)) => write!(out, " in ({}, {})", exact(l), exact(u)),
        };
        let within = within(&self.extent, self.discrete);
        let _ = write!(out, "{}, the loop is stable{within}", with_values(&self.set));
        let intervals = list(stable, "").unwrap_or_default();
        if intervals.is_empty() {
            out.push_str(" nowhere.");
            return out;
        }
        out.push_str(" exactly for ");
        let ends = intervals.iter().flat_map(|interval| ["lower", "upper"].map(|key| interval.get(key)));
        let digits = digits_apart(&ends.flatten().filter_map(enclosed).collect::<Vec<_>>());
        let mut origins: Vec<String> = Vec::new();
        for (i, interval) in intervals.iter().enumerate() {
            if i > 0 {
                out.push_str(" or ");
            }
            let [lower, upper] = ["lower", "upper"].map(|key| {
                let (number, origin) = interval.get(key).and_then(|e| end(e, parameter, digits))?;
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
}

/// Polynomials that take more characters than this are not written out.
const SHOWN: usize = 200;

/// The numbers between which an end is; `None` for an infinite one, and for a dead time, whose digits are given.
fn enclosed(json: &Json) -> Option<[Q; 2]> {
    match read_end(json, |_: &Json, _: &str| Ok(())).ok()? {
        End::Infinite => None,
        End::Rational(q) => Some([q.clone(), q]),
        End::Root((), a, b) => Some([a, b]),
    }
}

/// An end as a number to so many digits, and for an irrational one what it is; `None` for an infinite one.
fn end(json: &Json, parameter: &str, digits: i64) -> Option<(String, Option<String>)> {
    if let Some(Json::Text(number)) = json.get("switch") {
        return Some((number.clone(), Some("a dead time with roots on the axis".into())));
    }
    let (f, a, b) = match read_end(json, |p: &Json, _: &str| Ok(p.clone())).ok()? {
        End::Infinite => return None,
        End::Rational(q) => return Some((with_decimal(&q, digits), None)),
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
    Some((shared_digits(&a, &b, digits), Some(format!("a root of {polynomial}"))))
}
