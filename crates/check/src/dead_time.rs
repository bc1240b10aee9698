//! Stable dead times: from the roots without delay, counted on over all crossings of the imaginary axis.

use super::characteristic::Form;
use super::clock::Clock;
use super::crossing::{Crossing, square_of_modulus};
use super::expression::Base;
use super::interval::Interval;
use super::intervals::Statement;
use super::multivariate::Multi;
use super::number::{Q, Z, rational};
use super::over_symbols::{determinant, primitive, substituted};
use super::roots::{count_of_positive_roots, places_by_axis};
use super::statement::{Extent, count, list, number, object, pair, polynomial, polynomials};
use super::symbols::Table;
use super::univariate::Uni;
use super::words::{DIGITS, shared_digits};
use super::{Proved, Rejection, Step, is_same_time, model};
use crate::format::Json;
use num_traits::{One, Signed, Zero};

/// More switches are refused.
const MAX_SWITCHES: usize = 100_000;

/// A dead time at which roots are on the axis.
struct Switch {
    at: Interval,
    change: i64,
    crossing: usize,
    turns: usize,
}

/// Where a stable interval ends.
#[derive(Clone)]
enum Limit {
    Infinite,
    Number(Q),
    /// A crossing, its number of turns, and an enclosure.
    Switch(usize, usize, Q, Q),
}

pub(super) fn check(text_of_model: &str, json: &Json, statement: &Json, clock: &Clock) -> Result<Proved, Rejection> {
    let keys = ["schema", "statement", "bits", "delay", "parts", "crossings"];
    let [_, _, bits, base, parts, crossings] = Step::Format.of(object(json, "the certificate", keys, &["model"]))?;
    let bits = Step::Format.of(count(bits, "'bits'").and_then(|bits| match bits {
        64..=32768 => Ok(bits),
        _ => Err("'bits' is not from 64 to 32768".into()),
    }))?;
    let base = Step::Format.of(number(base, "'delay'"))?;
    let s = Step::Statement.of(Statement::read(statement))?;
    let lower = Step::Statement.of(lower_end(&s, &base))?;
    let upper = s.domain.1.as_ref();
    let own = Step::Model.of(clock.reading(|| quasi_polynomial(text_of_model, s.parameter, &s.set, &base, clock)))?;
    let given = Step::Characteristic.of(polynomials(parts, "'parts'", polynomial))?;
    let negative: Vec<Uni> = own.iter().map(|p| p.scaled(&-Z::one())).collect();
    let [p, q] = match given.as_slice() {
        [p, q] if given == own || given == negative => [p, q],
        _ => {
            let reason = "the parts are not those of the model, or there is more than one delay";
            return Step::Characteristic.fails(reason);
        }
    };
    let found = Step::Boundary.of(counted(p, q, crossings, bits, upper.map(|u| u * &base), clock))?;
    let limits = Step::Line.of(walk(&found, lower, upper, &base, bits, clock))?;
    Step::Stable.of(same(s.stable, &limits, &found, &(&base * Q::from(Z::one() << bits))))?;
    Ok(Proved { statement: s.in_words(&in_words(&limits)), kind: "intervals" })
}

/// The least dead time, of a region whose boundary is the imaginary axis.
fn lower_end<'s>(s: &'s Statement<'_>, base: &Q) -> Result<&'s Q, String> {
    if s.discrete || s.extent != Extent::Number(Q::zero()) || !base.is_positive() {
        return Err("the boundary is not the imaginary axis, or the dead time is not positive".to_owned());
    }
    s.domain.0.as_ref().filter(|l| !l.is_negative()).ok_or_else(|| "a dead time is not negative".into())
}

/// `P_0, P_1, ...`: coefficients of powers of `z = exp(-tau s)`, polynomials in `s`.
fn quasi_polynomial(
    text: &str,
    parameter: &str,
    set: &[(String, Q)],
    base: &Q,
    clock: &Clock,
) -> Result<Vec<Uni>, String> {
    let found = characteristic_function(text, Some(parameter), set, Base::OfParameter(base), clock)?;
    if found.divisors.iter().any(|p| p.degree(1) > 0) || found.function.degree(1) > 0 {
        return Err("the loop, or a divisor of the model, depends on the parameter beside its dead time".into());
    }
    let parts = found.function.coefficients(2).into_iter().map(|part| {
        let coefficients = part.coefficients(0);
        Uni::new(coefficients.iter().map(|c| c.0.values().next().cloned().unwrap_or_default()).collect())
    });
    Ok(parts.skip_while(Uni::is_zero).collect())
}

/// The characteristic function of a continuous loop with dead time.
pub(super) struct CharacteristicFunction {
    /// In `s`, the parameter and `z`, of the model's degree in `s`; without common integer factor.
    pub function: Multi,
    /// The loop is undefined where one of them is zero for all `s`; none is zero for all values of the parameter, or has `z`.
    pub divisors: Vec<Multi>,
}

pub(super) fn characteristic_function(
    text: &str,
    parameter: Option<&str>,
    set: &[(String, Q)],
    base: Base<'_>,
    clock: &Clock,
) -> Result<CharacteristicFunction, String> {
    let asked = model::asked(text, parameter, set, &Table::empty(), Some(base), clock)?;
    is_same_time(asked.discrete, false)?;
    if asked.is_doubled {
        return Err("a loop with dead time has complex coefficients".into());
    }
    let at_values = |row: &[Multi]| substituted(row, &asked.values, clock);
    let mut divisors = Vec::new();
    for divisor in &asked.divisors {
        divisors.extend(at_values(std::slice::from_ref(divisor))?);
    }
    let (d, degree) = match &asked.form {
        Form::Written(f) => {
            let row = at_values(&[f.numerator.clone(), f.whole_denominator(clock)?])?;
            if row[1].degree(0) > 0 {
                return Err("the characteristic function has a denominator".into());
            }
            divisors.push(row[1].clone());
            (row[0].clone(), f.numerator.degree(0))
        }
        Form::System((rows, degree), alone) => {
            for (rows, degree) in alone {
                let rows = rows.iter().map(|r| at_values(r)).collect::<Result<Vec<_>, _>>()?;
                let lead = determinant(&rows, clock)?.coefficients(0).into_iter().nth(*degree);
                divisors.push(lead.ok_or("a block loses its order")?);
            }
            let rows = rows.iter().map(|r| at_values(r)).collect::<Result<Vec<_>, _>>()?;
            (determinant(&rows, clock)?, *degree)
        }
        _ => return Err("a matrix has no dead time".into()),
    };
    if divisors.iter().any(|p| p.is_zero() || p.degree(2) > 0) {
        return Err("a divisor depends on the dead time, or is zero".into());
    }
    if d.is_zero() || d.degree(0) != degree {
        return Err("the loop is not well posed".into());
    }
    let function = primitive(vec![d], clock)?.swap_remove(0);
    Ok(CharacteristicFunction { function, divisors })
}

/// The roots to the right for small dead times, and the switches up to the last that matters.
struct Counted {
    right: i64,
    switches: Vec<Switch>,
    /// Whether there are roots to the right for good beyond the last switch.
    grows: bool,
    /// Each crossing with the upper ends of its switches, ascending.
    crossings: Vec<(Crossing, Vec<Z>)>,
}

impl Counted {
    fn without_crossings(right: i64, grows: bool) -> Self {
        Counted { right, switches: Vec::new(), grows, crossings: Vec::new() }
    }

    /// Whether an interval of dead times holds one switch and no other. A crossing has many switches: the first one that does not lie before the
    /// interval decides.
    fn is_alone(&self, (crossing, turns): (usize, usize), [a, b]: [&Q; 2]) -> Result<bool, String> {
        for (i, (c, ends)) in self.crossings.iter().enumerate() {
            let before = ends.partition_point(|hi| hi * a.denom() < *a.numer());
            let mut next = usize::from(c.is_one) + before;
            if i == crossing {
                if next != turns {
                    return Ok(false);
                }
                next += 1;
            }
            if Q::from(c.dead_time(next)?.lo) <= *b {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

fn counted(p: &Uni, q: &Uni, crossings: &Json, bits: usize, last: Option<Q>, clock: &Clock) -> Result<Counted, String> {
    let n = p.degree();
    let is_fit = !p.is_zero() && !q.is_zero() && (q.degree() < n || (q.degree() == n && q.at(n).abs() < p.at(n).abs()));
    if !is_fit {
        return Err("the loop is advanced, or of neutral type with roots to the right".into());
    }
    let enclosures = list(crossings, "'crossings'")?;
    let total = p.plus(q);
    if total.at(0).is_zero() {
        // s = 0 is a root for every dead time.
        return match enclosures {
            [] => Ok(Counted::without_crossings(1, true)),
            _ => Err("there is nothing to cross".into()),
        };
    }
    let f = square_of_modulus(p).minus(&square_of_modulus(q));
    let f = Uni::new(f.0.into_iter().skip_while(Zero::is_zero).collect());
    if f.is_zero() || f.gcd(&f.derivative(), clock)?.degree() > 0 {
        return Err("a crossing is not simple".into());
    }
    if count_of_positive_roots(&f, clock)? != enclosures.len() {
        return Err("there are not as many crossings as positive roots".into());
    }
    let mut found: Vec<Crossing> = Vec::with_capacity(enclosures.len());
    let mut before: Option<Q> = None;
    for enclosure in enclosures {
        let (a, b) = pair(enclosure, "a crossing")?;
        if before.is_some_and(|before| a < before) {
            return Err("the crossings are not in order".into());
        }
        found.push(Crossing::new([p, q], &f, &a, &b, bits, clock)?);
        before = Some(b);
    }
    let places = places_by_axis(&total, clock)?;
    let at_zero = found.iter().filter(|c| c.is_one).count();
    if places.on != 2 * at_zero || places.inside + places.on + places.outside != n {
        return Err("the roots without delay are not those of the crossings".into());
    }
    let right = (places.outside + 2 * found.iter().filter(|c| c.is_one && c.is_gain).count()) as i64;
    // The count exceeds tau/pi sum of +-omega - 2 m.
    let Some(turn) = found.first().map(|c| c.turn.clone()) else {
        return Ok(Counted::without_crossings(right, right > 0));
    };
    let growth =
        found.iter().fold(Interval::zero(), |sum, c| if c.is_gain { sum.plus(&c.omega) } else { sum.minus(&c.omega) });
    if !growth.lo.is_positive() {
        return Err("the count of roots is not shown to grow".into());
    }
    let bound = Q::new(&turn.hi * Z::from(found.len()), growth.lo);
    let last = last.map_or_else(|| bound.clone(), |last| last.min(bound.clone()));
    let last = (last * Q::from(Z::one() << bits)).ceil().to_integer();
    let switches = switches_before(&last, &found, bits, clock)?;
    let ends = |i: usize| switches.iter().filter(|s| s.crossing == i).map(|s| s.at.hi.clone()).collect();
    let crossings = found.into_iter().enumerate().map(|(i, c)| (c, ends(i))).collect();
    Ok(Counted { right, switches, grows: true, crossings })
}

/// The dead times at which roots are on the axis, ascending.
fn switches_before(last: &Z, found: &[Crossing], bits: usize, clock: &Clock) -> Result<Vec<Switch>, String> {
    let mut switches = Vec::new();
    for (crossing, c) in found.iter().enumerate() {
        for turns in usize::from(c.is_one).. {
            clock.spend(4, bits as u64, bits as u64)?;
            let at = c.dead_time(turns)?;
            if at.lo >= *last {
                break;
            }
            switches.push(Switch { at, change: if c.is_gain { 2 } else { -2 }, crossing, turns });
            if switches.len() > MAX_SWITCHES {
                return Err("there are too many switches".into());
            }
        }
    }
    switches.sort_by(|a, b| a.at.lo.cmp(&b.at.lo));
    if switches.windows(2).any(|w| w[0].at.hi >= w[1].at.lo) {
        return Err("the order of two switches is not certain".into());
    }
    Ok(switches)
}

/// The stable intervals.
fn walk(
    found: &Counted,
    lower: &Q,
    upper: Option<&Q>,
    base: &Q,
    bits: usize,
    clock: &Clock,
) -> Result<Vec<(Limit, Limit)>, String> {
    let scale = base * Q::from(Z::one() << bits);
    let (lower_end, upper_end) = (lower * &scale, upper.map(|u| u * &scale));
    let mut right = found.right;
    let mut before = Limit::Number(lower.clone());
    let mut stable = Vec::new();
    for switch in &found.switches {
        clock.spend(4, bits as u64, bits as u64)?;
        let compared = |x: &Z, end: &Q| (x * end.denom()).cmp(end.numer());
        if compared(&switch.at.hi, &lower_end).is_lt() {
            right += switch.change;
            continue;
        }
        if upper_end.as_ref().is_some_and(|u| compared(&switch.at.lo, u).is_gt()) {
            break;
        }
        if compared(&switch.at.lo, &lower_end).is_le()
            || upper_end.as_ref().is_some_and(|u| compared(&switch.at.hi, u).is_ge())
        {
            return Err("a switch is not told from an end of the domain".into());
        }
        let [lo, hi] = [&switch.at.lo, &switch.at.hi].map(|x| Q::new_raw(x * scale.denom(), scale.numer().clone()));
        let at = Limit::Switch(switch.crossing, switch.turns, lo, hi);
        if right == 0 {
            stable.push((before, at.clone()));
        }
        right += switch.change;
        before = at;
    }
    if right == 0 {
        if upper.is_none() && found.grows {
            return Err("the count of roots does not grow as it must".into());
        }
        stable.push((before, upper.map_or(Limit::Infinite, |u| Limit::Number(u.clone()))));
    }
    Ok(stable)
}

/// Whether the claim has these ends; an enclosure in it may be wider, but holds no other switch. The scale is that of switches.
fn same(claim: &Json, limits: &[(Limit, Limit)], found: &Counted, scale: &Q) -> Result<(), String> {
    let claim = list(claim, "'stable'")?;
    if claim.len() != limits.len() {
        return Err(format!("there are {} stable intervals", limits.len()));
    }
    for (interval, (lower, upper)) in claim.iter().zip(limits) {
        let claimed = object(interval, "an interval", ["lower", "upper"], &[])?;
        for (json, limit) in claimed.into_iter().zip([lower, upper]) {
            let fits = match limit {
                Limit::Infinite => *json == Json::Null,
                Limit::Number(q) => matches!(json, Json::Text(text) if rational(text)? == *q),
                Limit::Switch(crossing, turns, lo, hi) => {
                    let [c, k, between] = object(json, "an end", ["crossing", "turns", "between"], &[])?;
                    let (a, b) = pair(between, "'between'")?;
                    let is_own =
                        count(c, "'crossing'")? == *crossing && count(k, "'turns'")? == *turns && a <= *lo && *hi <= b;
                    is_own && found.is_alone((*crossing, *turns), [&(a * scale), &(b * scale)])?
                }
            };
            if !fits {
                return Err("an end of the claimed set is not the one that is found".into());
            }
        }
    }
    Ok(())
}

/// The intervals for a sentence: a switch by its first digits.
fn in_words(limits: &[(Limit, Limit)]) -> Json {
    let end = |limit: &Limit| match limit {
        Limit::Infinite => Json::Null,
        Limit::Number(q) => q.to_string().into(),
        Limit::Switch(_, _, lo, hi) => Json::Object(vec![("switch".to_owned(), shared_digits(lo, hi, DIGITS).into())]),
    };
    let interval = |(lower, upper): &(Limit, Limit)| {
        Json::Object(vec![("lower".to_owned(), end(lower)), ("upper".to_owned(), end(upper))])
    };
    Json::List(limits.iter().map(interval).collect())
}
