//! Reading the parts of a certificate, strictly: no key is missing, none is unknown.

use super::number::{Q, integer, rational, shorten};
use super::univariate::Uni;
use crate::format::Json;

/// Polynomials of a higher degree are refused.
const MAX_DEGREE: usize = 20_000;

/// The region all roots have to lie in.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Extent {
    /// The radius of the disc, or the decay rate.
    Number(Q),
    /// The parameter is the radius or the decay rate.
    Parameter,
}

/// An end of an interval.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum End<P> {
    Infinite,
    Rational(Q),
    /// The only root of a polynomial in an open interval.
    Root(P, Q, Q),
}

/// The values of an object's keys; `optional` keys may be missing.
pub(super) fn object<'j, const N: usize>(
    json: &'j Json,
    what: &str,
    keys: [&str; N],
    optional: &[&str],
) -> Result<[&'j Json; N], String> {
    let Json::Object(pairs) = json else { return Err(format!("{what} is not an object")) };
    for (key, _) in pairs {
        if !keys.contains(&key.as_str()) && !optional.contains(&key.as_str()) {
            return Err(format!("{what} has an unknown key '{}'", shorten(key)));
        }
    }
    let mut out = [json; N];
    for (place, key) in out.iter_mut().zip(keys) {
        *place = json.get(key).ok_or_else(|| format!("{what} has no '{key}'"))?;
    }
    Ok(out)
}

pub(super) fn list<'j>(json: &'j Json, what: &str) -> Result<&'j [Json], String> {
    match json {
        Json::List(items) => Ok(items),
        _ => Err(format!("{what} is not a list")),
    }
}

pub(super) fn text<'j>(json: &'j Json, what: &str) -> Result<&'j str, String> {
    match json {
        Json::Text(text) => Ok(text),
        _ => Err(format!("{what} is not a string")),
    }
}

pub(super) fn count(json: &Json, what: &str) -> Result<usize, String> {
    match json {
        Json::Count(n) => Ok(*n as usize),
        _ => Err(format!("{what} is not a count")),
    }
}

pub(super) fn boolean(json: &Json, what: &str) -> Result<bool, String> {
    match json {
        Json::Bool(b) => Ok(*b),
        _ => Err(format!("{what} is not true or false")),
    }
}

pub(super) fn number(json: &Json, what: &str) -> Result<Q, String> {
    rational(text(json, what)?)
}

/// A number, or nothing where the domain does not end.
pub(super) fn bound(json: &Json, what: &str) -> Result<Option<Q>, String> {
    match json {
        Json::Null => Ok(None),
        other => number(other, what).map(Some),
    }
}

/// The ends of an open interval; none where it does not end.
pub(super) type Domain = (Option<Q>, Option<Q>);

/// An open interval that is not empty.
pub(super) fn interval(json: &Json) -> Result<Domain, String> {
    let [lower, upper] = object(json, "'domain'", ["lower", "upper"], &[])?;
    let (lower, upper) = (bound(lower, "'lower'")?, bound(upper, "'upper'")?);
    match (&lower, &upper) {
        (Some(l), Some(u)) if l >= u => Err("the domain is empty".to_owned()),
        _ => Ok((lower, upper)),
    }
}

/// Two numbers, the first below the second.
pub(super) fn pair(json: &Json, what: &str) -> Result<(Q, Q), String> {
    match list(json, what)? {
        [a, b] => {
            let (a, b) = (number(a, what)?, number(b, what)?);
            if a < b { Ok((a, b)) } else { Err(format!("{what} is not in order")) }
        }
        _ => Err(format!("{what} is not a pair")),
    }
}

/// A polynomial in the parameter, coefficients from the constant term up, no zero at the top.
pub(super) fn polynomial(json: &Json, what: &str) -> Result<Uni, String> {
    let items = list(json, what)?;
    if items.len() > MAX_DEGREE {
        return Err(format!("{what} has too high a degree"));
    }
    let coefficients = items.iter().map(|c| integer(text(c, what)?)).collect::<Result<Vec<_>, _>>()?;
    let length = coefficients.len();
    let p = Uni::new(coefficients);
    if p.0.len() < length { Err(format!("{what} has a zero at the top")) } else { Ok(p) }
}

/// A list of polynomials, each as `read` reads it.
pub(super) fn polynomials<P>(
    json: &Json,
    what: &str,
    read: impl Fn(&Json, &str) -> Result<P, String>,
) -> Result<Vec<P>, String> {
    list(json, what)?.iter().map(|p| read(p, what)).collect()
}

/// Names with their values.
pub(super) fn values(json: &Json) -> Result<Vec<(String, Q)>, String> {
    let Json::Object(pairs) = json else { return Err("'set' is not an object".into()) };
    pairs.iter().map(|(name, value)| Ok((identifier(name)?.to_owned(), number(value, "a value in 'set'")?))).collect()
}

/// A name; anything else could make the proved sentence say something else.
pub(super) fn identifier(name: &str) -> Result<&str, String> {
    let first = name.starts_with(|c: char| c == '_' || c.is_alphabetic());
    if first && name.chars().all(|c| c == '_' || c.is_alphanumeric()) {
        return Ok(name);
    }
    Err(format!("'{}' is not a name", shorten(&name.replace(char::is_control, " "))))
}

pub(super) fn extent(json: &Json, discrete: bool) -> Result<Extent, String> {
    let [value] = object(json, "'region'", [if discrete { "radius" } else { "decay" }], &[])?;
    match text(value, "'region'")? {
        "parameter" => Ok(Extent::Parameter),
        other => {
            let value = rational(other)?;
            if discrete && value <= Q::from(num_bigint::BigInt::from(0)) {
                return Err("the radius is not positive".into());
            }
            Ok(Extent::Number(value))
        }
    }
}

/// A region whose bound is a number.
pub(super) fn fixed_extent(json: &Json, discrete: bool) -> Result<Extent, String> {
    match extent(json, discrete)? {
        Extent::Parameter => Err("the region has no parameter here".into()),
        fixed @ Extent::Number(_) => Ok(fixed),
    }
}

/// The names of two parameters.
pub(super) fn axes(x: &Json, y: &Json) -> Result<Vec<String>, String> {
    [(x, "'x'"), (y, "'y'")].map(|(json, what)| Ok(identifier(text(json, what)?)?.to_owned())).into_iter().collect()
}

pub(super) fn end<P>(json: &Json, read: impl Fn(&Json, &str) -> Result<P, String>) -> Result<End<P>, String> {
    match json {
        Json::Null => Ok(End::Infinite),
        Json::Text(text) => rational(text).map(End::Rational),
        other => {
            let [p, between] = object(other, "an end", ["polynomial", "between"], &[])?;
            let (a, b) = pair(between, "'between' of an end")?;
            Ok(End::Root(read(p, "'polynomial' of an end")?, a, b))
        }
    }
}
