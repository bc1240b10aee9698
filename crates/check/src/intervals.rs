//! The stable set of one parameter: the one forward pass over the line.

mod statement;

use super::characteristic::Characteristic;
use super::clock::Clock;
use super::coefficient::{Coefficient, Ring};
use super::half_size::{InX, pair, times};
use super::held::Question;
use super::number::Q;
use super::over::Over;
use super::statement::{Domain, End, Extent, boolean, count, end, list, number, object, polynomial, polynomials, text};
use super::{Proved, Rejection, Step, further_keys, is_same_time, table};
use crate::format::Json;
pub(super) use statement::Statement;

/// How a polynomial is written in the certificate; the text says which one it is.
pub(super) type Reader<'r, P> = &'r dyn Fn(&Json, &str) -> Result<P, String>;

/// An open interval of the line between two ends.
type Stretch<P> = (End<P>, End<P>);

/// A loop in one parameter.
pub(super) struct Loop<'l, P> {
    pub discrete: bool,
    /// Whether it is a complex loop, doubled: its divisors are squares of moduli, which factors need not divide.
    pub is_doubled: bool,
    pub degree: usize,
    /// The coefficients of the characteristic polynomial, as many as its degree and one; none where it is undefined.
    pub coefficients: &'l [P],
    /// The loop is undefined at the zeros of these.
    pub poles: &'l [P],
}

/// What the certificate gives as proof.
pub(super) struct Proof<'j> {
    pub boundary: &'j Json,
    pub factors: &'j Json,
    pub line: &'j Json,
    pub stable: &'j Json,
}

/// Everything whose zeros can change the number of stable roots.
pub(super) struct Boundaries<P> {
    /// At a zero of one of these the loop is not stable, or not defined.
    pub certain: Vec<P>,
    /// The identity `U A + V B = value`, for a degree of at least 2.
    pub pair: Option<Identity<P>>,
}

pub(super) struct Identity<P> {
    u: InX<P>,
    v: InX<P>,
    pub value: P,
}

/// Where one stretch of the line ends and the next begins.
struct Separator<P> {
    end: End<P>,
    /// The limits of the stretches on its two sides, and whether these belong to the stretches.
    left: Option<Q>,
    right: Option<Q>,
    regular: bool,
    factor: Option<usize>,
    touch: Option<(bool, usize)>,
}

pub(super) fn check(model: &str, json: &Json, statement: &Json, clock: &Clock) -> Result<Proved, Rejection> {
    let table = table(json)?;
    let parts = ["schema", "statement", "characteristic", "boundary", "factors", "line"];
    let [_, _, characteristic, boundary, factors, line] =
        Step::Format.of(object(json, "the certificate", parts, further_keys(table.as_ref())))?;
    let s = Step::Statement.of(Statement::read(statement))?;
    let (discrete, kept) = (s.discrete, if s.extent == Extent::Parameter { None } else { Some(s.parameter) });
    let proof = Proof { boundary, factors, line, stable: s.stable };
    let question = Question { model, kept, set: &s.set, extent: &s.extent, discrete };
    match table {
        None => {
            let (d, _) = question.rational(characteristic, clock)?;
            let Characteristic { is_doubled, degree, coefficients, poles, .. } = &d;
            let d = Loop { discrete, is_doubled: *is_doubled, degree: *degree, coefficients, poles };
            is_proved(&d, &s.domain, &proof, &polynomial, clock)?;
        }
        Some(table) => {
            Step::Model.of(is_same_time(true, discrete))?;
            let read = |json: &Json, what: &str| Over::read(json, what, &table);
            let own = question.over_symbols(characteristic, &table, clock)?;
            let (degree, coefficients) = (own.coefficients.len() - 1, own.coefficients.as_slice());
            let d = Loop { discrete, is_doubled: own.is_doubled, degree, coefficients, poles: &own.poles };
            is_proved(&d, &s.domain, &proof, &read, clock)?;
        }
    }
    Ok(Proved { statement: s.in_words(s.stable), kind: "intervals" })
}

/// That the claimed set is the stable one.
fn is_proved<P: Coefficient>(
    d: &Loop<'_, P>,
    domain: &Domain,
    proof: &Proof<'_>,
    read: Reader<'_, P>,
    clock: &Clock,
) -> Result<usize, Rejection> {
    let stable = Step::Stable.of((|| {
        let mut out = Vec::new();
        for interval in list(proof.stable, "'stable'")? {
            let [lower, upper] = object(interval, "an interval", ["lower", "upper"], &[])?;
            out.push((end(lower, read)?, end(upper, read)?));
        }
        Ok(out)
    })())?;
    let boundaries = Step::Boundary.of(boundaries(d, proof.boundary, read, clock))?;
    let factors = Step::Factors.of(polynomials(proof.factors, "'factors'", read))?;
    let Some(boundaries) = boundaries else {
        // Stable nowhere: a boundary condition holds for every value.
        Step::Factors.of(if factors.is_empty() { Ok(()) } else { Err("there is nothing to factor".into()) })?;
        Step::Line.of(match list(proof.line, "'line'") {
            Ok([]) => Ok(()),
            Ok(_) => Err("there is no line to walk".into()),
            Err(e) => Err(e),
        })?;
        return Step::Stable.of(if stable.is_empty() { Ok(0) } else { Err("the loop is stable nowhere".into()) });
    };
    Step::Factors.of(covered(&boundaries, &factors, d.is_doubled, clock))?;
    let found = Step::Line.of(walk(d, domain, &boundaries, &factors, proof.line, clock))?;
    let count = found.len();
    Step::Stable.of(if found == stable {
        Ok(count)
    } else {
        Err("the claimed set is not the one that the line shows".into())
    })
}

/// The boundary polynomials; `None` when one of them vanishes identically, so that no value is stable.
pub(super) fn boundaries<P: Ring>(
    d: &Loop<'_, P>,
    given: &Json,
    read: Reader<'_, P>,
    clock: &Clock,
) -> Result<Option<Boundaries<P>>, String> {
    let (n, coefficients) = (d.degree, d.coefficients);
    let mut certain = d.poles.to_vec();
    certain.extend(coefficients.get(n).cloned());
    if n > 0 && !coefficients.is_empty() {
        if d.discrete {
            let zero = coefficients[0].zero();
            let sum = |from: usize| coefficients.iter().skip(from).step_by(2).fold(zero.clone(), |s, c| s.plus(c));
            certain.push(sum(0).plus(&sum(1)));
            certain.push(sum(0).minus(&sum(1)));
        } else {
            certain.push(coefficients[0].clone());
        }
    }
    let vanishes = coefficients.len() <= n || certain.iter().any(P::is_zero);
    if n < 2 || vanishes {
        if *given != Json::Null {
            return Err("'boundary' must be null here".into());
        }
        return Ok(if vanishes { None } else { Some(Boundaries { certain, pair: None }) });
    }
    let [u, v, value] = object(given, "'boundary'", ["u", "v", "value"], &[])?;
    let (u, v) = (polynomials(u, "'u'", read)?, polynomials(v, "'v'", read)?);
    let value = read(value, "'value'")?;
    let (a, degree_a, b, degree_b) = pair(coefficients, d.discrete);
    // deg U < deg B and deg V < deg A make U A + V B the Sylvester matrix of formal degrees times (U, V).
    if u.len() > degree_b || v.len() > degree_a {
        return Err("a cofactor has too high a degree in x".into());
    }
    let mut is_there = false;
    for w in u.iter().chain(&v) {
        is_there = is_there || w.is_nonzero(clock)?;
    }
    if !is_there {
        return Err("both cofactors are zero".into());
    }
    clock.tick()?;
    let left = times(&u, &a, clock)?;
    clock.tick()?;
    let right = times(&v, &b, clock)?;
    let zero = value.zero();
    let at = |p: &InX<P>, k: usize| p.get(k).cloned().unwrap_or_else(|| zero.clone());
    for k in 0..left.len().max(right.len()).max(1) {
        let sum = at(&left, k).plus(&at(&right, k));
        if sum != if k == 0 { value.clone() } else { zero.clone() } {
            return Err(format!("U A + V B = value does not hold in the coefficient of x^{k}"));
        }
    }
    if value.is_zero() {
        return Ok(None);
    }
    Ok(Some(Boundaries { certain, pair: Some(Identity { u, v, value }) }))
}

/// Whether every zero of every boundary polynomial is a zero of a factor.
fn covered<P: Coefficient>(
    boundaries: &Boundaries<P>,
    factors: &[P],
    is_doubled: bool,
    clock: &Clock,
) -> Result<(), String> {
    if factors.iter().any(|f| f.degree() == 0) {
        return Err("a factor is constant".into());
    }
    let all = boundaries.certain.iter().chain(boundaries.pair.iter().map(|i| &i.value));
    for (i, boundary) in all.enumerate() {
        let mut rest = boundary.clone();
        for f in factors {
            while rest.degree() > 0
                && let Some(quotient) = rest.divided(f, clock)?
            {
                rest = quotient;
            }
        }
        for f in factors.iter().filter(|_| is_doubled) {
            while rest.degree() > 0
                && let Some(common) = rest.common(f, clock)?
                && common.degree() > 0
            {
                rest = rest.divided(&common, clock)?.ok_or("internal: a gcd does not divide")?;
            }
        }
        if !rest.is_unit(clock)? {
            return Err(format!("boundary polynomial {i} is not a product of the factors"));
        }
    }
    Ok(())
}

fn separator<P: Coefficient>(json: &Json, factors: &[P], clock: &Clock) -> Result<Separator<P>, String> {
    let touch = match json.get("touch") {
        None => None,
        Some(t) => match list(t, "'touch'")? {
            [which, k] => match text(which, "'touch'")? {
                "u" => Some((true, count(k, "'touch'")?)),
                "v" => Some((false, count(k, "'touch'")?)),
                _ => return Err("'touch' names neither u nor v".into()),
            },
            _ => return Err("'touch' is not a pair".into()),
        },
    };
    if json.get("at").is_some() {
        let [at] = object(json, "a root", ["at"], &["touch"])?;
        let q = number(at, "'at'")?;
        if !any_vanishes(factors, &q, clock)? {
            return Err("no factor vanishes at 'at'".into());
        }
        return Ok(Separator {
            end: End::Rational(q.clone()),
            left: Some(q.clone()),
            right: Some(q),
            regular: false,
            factor: None,
            touch,
        });
    }
    let [between, factor] = object(json, "a root", ["between", "factor"], &["touch"])?;
    let (a, b) = super::statement::pair(between, "'between'")?;
    let index = count(factor, "'factor'")?;
    let polynomial = factors.get(index).ok_or("there is no such factor")?;
    for (i, f) in factors.iter().enumerate() {
        if f.vanishes_at(&a, clock)? || f.vanishes_at(&b, clock)? {
            return Err(format!("factor {i} vanishes at an end of 'between'"));
        }
        let expected = usize::from(i == index);
        if f.descartes(Some(&a), Some(&b), clock)? != Some(expected) {
            return Err(format!("factor {i} is not shown to have {expected} roots in 'between'"));
        }
    }
    let end = End::Root(polynomial.clone(), a.clone(), b.clone());
    Ok(Separator { end, left: Some(a), right: Some(b), regular: true, factor: Some(index), touch })
}

/// Goes along the line from left to right and returns the stable intervals.
fn walk<P: Coefficient>(
    d: &Loop<'_, P>,
    domain: &(Option<Q>, Option<Q>),
    boundaries: &Boundaries<P>,
    factors: &[P],
    line: &Json,
    clock: &Clock,
) -> Result<Vec<Stretch<P>>, String> {
    let line = list(line, "'line'")?;
    if line.len() % 2 == 0 {
        return Err("the line does not begin and end with a stretch".into());
    }
    let outer = |bound: &Option<Q>| Separator {
        end: bound.clone().map_or(End::Infinite, End::Rational),
        left: bound.clone(),
        right: bound.clone(),
        regular: false,
        factor: None,
        touch: None,
    };
    let mut before = outer(&domain.0);
    let mut before_is_stable = false;
    let mut found: Vec<Stretch<P>> = Vec::new();
    for (i, item) in line.iter().enumerate().step_by(2) {
        let after = match line.get(i + 1) {
            Some(json) => separator(json, factors, clock),
            None => Ok(outer(&domain.1)),
        };
        let after = after.map_err(|e| format!("part {}: {e}", i + 1))?;
        let stable = stretch(d, &before, &after, factors, item, clock).map_err(|e| format!("part {i}: {e}"))?;
        if stable && before_is_stable && !is_excluded(&before, boundaries, clock)? {
            return Err(format!("part {}: the point between two stable stretches is not shown to be unstable", i - 1));
        }
        if stable {
            found.push((before.end.clone(), after.end.clone()));
        }
        before = after;
        before_is_stable = stable;
    }
    Ok(found)
}

/// A stretch without zeros of factors: every piece by Descartes' rule, one sample exactly.
fn stretch<P: Coefficient>(
    d: &Loop<'_, P>,
    before: &Separator<P>,
    after: &Separator<P>,
    factors: &[P],
    json: &Json,
    clock: &Clock,
) -> Result<bool, String> {
    let [split, sample, stable] = object(json, "a stretch", ["split", "sample", "stable"], &[])?;
    let point = |q| clock.tick().and_then(|()| number(q, "'split'"));
    let split = list(split, "'split'")?.iter().map(point).collect::<Result<Vec<_>, _>>()?;
    let (left, right) = (&before.right, &after.left);
    let touching = matches!((left, right), (Some(a), Some(b)) if a == b && before.regular && after.regular);
    let mut ends: Vec<Option<Q>> = vec![left.clone()];
    ends.extend(split.iter().cloned().map(Some));
    ends.push(right.clone());
    for (i, piece) in ends.windows(2).enumerate() {
        if let [Some(a), Some(b)] = piece
            && a >= b
            && !(touching && split.is_empty())
        {
            return Err("the points are not in order".into());
        }
        if touching {
            continue;
        }
        for (k, f) in factors.iter().enumerate() {
            if f.descartes(piece[0].as_ref(), piece[1].as_ref(), clock)? != Some(0) {
                return Err(format!("factor {k} is not shown to have no root in piece {i}"));
            }
        }
    }
    for q in &split {
        if any_vanishes(factors, q, clock)? {
            return Err("a factor vanishes at a point of 'split'".into());
        }
    }
    let sample = number(sample, "'sample'")?;
    let above = left.as_ref().is_none_or(|l| *l < sample || (before.regular && *l == sample));
    let below = right.as_ref().is_none_or(|r| sample < *r || (after.regular && *r == sample));
    if !(above && below) {
        return Err("the sample is not in the stretch".into());
    }
    let actual = P::is_stable_at(d.coefficients, &sample, d.discrete, clock)?;
    if actual != boolean(stable, "'stable'")? {
        return Err(format!("at the sample the loop is {}stable", if actual { "" } else { "not " }));
    }
    Ok(actual)
}

fn any_vanishes<P: Coefficient>(polynomials: &[P], q: &Q, clock: &Clock) -> Result<bool, String> {
    for f in polynomials {
        if f.vanishes_at(q, clock)? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether a separator between two stable stretches is shown not to be stable itself.
fn is_excluded<P: Coefficient>(
    separator: &Separator<P>,
    boundaries: &Boundaries<P>,
    clock: &Clock,
) -> Result<bool, String> {
    let witness = |identity: &Identity<P>, touch: Option<(bool, usize)>| {
        let (in_u, k) = touch?;
        (if in_u { &identity.u } else { &identity.v }).get(k).cloned()
    };
    match (&separator.end, separator.factor) {
        (End::Rational(q), _) => {
            if any_vanishes(&boundaries.certain, q, clock)? {
                return Ok(true);
            }
            let Some(identity) = &boundaries.pair else { return Ok(false) };
            let Some(w) = witness(identity, separator.touch) else { return Ok(false) };
            Ok(identity.value.vanishes_at(q, clock)? && !w.vanishes_at(q, clock)?)
        }
        (End::Root(f, a, b), Some(_)) => {
            for c in &boundaries.certain {
                if c.divided(f, clock)?.is_some() {
                    return Ok(true);
                }
            }
            let Some(identity) = &boundaries.pair else { return Ok(false) };
            let Some(w) = witness(identity, separator.touch) else { return Ok(false) };
            if w.is_zero() || identity.value.divided(f, clock)?.is_none() {
                return Ok(false);
            }
            if w.degree() == 0 {
                return w.is_nonzero(clock);
            }
            Ok(w.descartes(Some(a), Some(b), clock)? == Some(0))
        }
        _ => Ok(false),
    }
}
