//! The common factor of all coefficients of a characteristic polynomial. Each reader brings a loop to one denominator in its own way, so each reader has
//! a factor of its own. Without that factor the signs over a box are the signs of the loop.

use super::{FIRST, OverBox};
use crate::clock::Clock;
use crate::multivariate::Multi;
use crate::number::Z;
use crate::over_symbols::primitive;
use num_traits::ToPrimitive;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Images are taken modulo this number.
const PRIME: u64 = (1 << 31) - 1;

/// And at these values of the other variables.
const POINTS: [u64; 2] = [1_000_003, 7_654_321];

impl OverBox {
    /// Without the factor that all coefficients have in common, which becomes a divisor of the loop: where it vanishes, all coefficients do. Only
    /// variables below a bound are in it.
    pub fn without_common(mut self, below: usize, clock: &Clock) -> Result<Self, String> {
        let all: Vec<Multi> = self.coefficients.iter().chain(self.imaginary.iter().flatten()).cloned().collect();
        let common = common(&all, below, clock)?;
        if common.is_constant() {
            return Ok(self);
        }
        let both = self.coefficients.iter_mut().chain(self.imaginary.iter_mut().flatten());
        for c in both.filter(|c| !c.is_zero()) {
            *c = c.quotient(&common, clock)?;
        }
        // The last divisor has a meaning of its own.
        self.divisors.insert(0, vec![common]);
        Ok(self)
    }

    /// With the square of the modulus in the place of complex coefficients: the polynomial times the conjugated one.
    pub fn doubled(mut self, clock: &Clock) -> Result<Self, String> {
        let Some(imaginary) = self.imaginary.take() else { return Ok(self) };
        let mut squares = vec![Multi::default(); 2 * self.coefficients.len() - 1];
        for part in [&self.coefficients, &imaginary] {
            for (i, x) in part.iter().enumerate() {
                for (k, y) in part.iter().enumerate() {
                    squares[i + k].add_all(&x.times(y, clock)?);
                }
            }
        }
        self.coefficients = squares;
        Ok(self)
    }
}

/// Lists of which not all polynomials may vanish together, without factors that others say already: a sign of a product is harder to see than those of
/// its factors. A list of one polynomial is divided by the variables and by those that come before it in the order of their degrees. Nothing is said of
/// polynomials that are known to be positive.
pub fn separated(lists: Vec<Vec<Multi>>, positive: &[Multi], clock: &Clock) -> Result<Vec<Vec<Multi>>, String> {
    let is_single = |list: &Vec<Multi>| list.len() == 1 && !list[0].is_zero();
    let (single, several): (Vec<_>, Vec<_>) = lists.into_iter().partition(is_single);
    let mut single = single
        .into_iter()
        .flatten()
        .map(|p| Ok(primitive(vec![p], clock)?.swap_remove(0)))
        .collect::<Result<Vec<_>, String>>()?;
    let degree = |p: &Multi| p.0.keys().map(|e| e.iter().sum::<u32>()).max().unwrap_or(0);
    single.sort_by_cached_key(|p| (degree(p), p.clone()));
    let mut known: Vec<Multi> = positive.to_vec();
    for p in single {
        let last = p.0.keys().map(Vec::len).max().unwrap_or(0);
        let variables =
            (FIRST..last).filter(|v| p.0.keys().all(|e| e.get(*v).is_some_and(|k| *k > 0))).map(Multi::variable);
        let new: Vec<Multi> = variables.filter(|v| !known.contains(v)).collect();
        known.extend(new);
        let rest = known.iter().try_fold(vec![p], |rest, f| divided_by(rest, f, clock))?;
        known.extend(rest.into_iter().filter(|p| !p.is_constant()));
    }
    let mut out: Vec<Vec<Multi>> = Vec::with_capacity(known.len() + several.len());
    for list in several {
        let rest = known.iter().try_fold(primitive(list, clock)?, |rest, f| divided_by(rest, f, clock))?;
        if !rest.iter().any(|p| p.is_constant() && !p.is_zero()) {
            out.push(rest);
        }
    }
    out.extend(known.into_iter().skip(positive.len()).map(|p| vec![p]));
    Ok(out)
}

/// All of a list divided by a polynomial, as often as that leaves nothing.
fn divided_by(mut list: Vec<Multi>, f: &Multi, clock: &Clock) -> Result<Vec<Multi>, String> {
    while list.iter().any(|p| !p.is_zero()) && !list.iter().any(|p| p.is_constant() && !p.is_zero()) {
        let mut quotients = Vec::with_capacity(list.len());
        for p in &list {
            match if p.is_zero() { Some(Multi::default()) } else { p.divided(f, clock)? } {
                Some(quotient) => quotients.push(quotient),
                None => return Ok(list),
            }
        }
        list = quotients;
    }
    Ok(list)
}

/// A greatest common divisor of polynomials, in variables from [`FIRST`] on and below a bound.
///
/// In most variables it has none: a greatest common divisor of images in one variable alone, which is cheap, is a number then.
fn common(all: &[Multi], below: usize, clock: &Clock) -> Result<Multi, String> {
    let some: Vec<Multi> = primitive(all.iter().filter(|p| !p.is_zero()).cloned().collect(), clock)?;
    let last = some.iter().flat_map(|p| p.0.keys().map(Vec::len)).max().unwrap_or(0);
    let mut suspects = BTreeSet::new();
    for v in FIRST..last.min(below) {
        if some.iter().all(|p| p.degree(v) > 0) && POINTS.iter().any(|point| is_in_images(&some, v, *point)) {
            suspects.insert(v);
        }
        clock.spend(some.iter().map(|p| p.0.len()).sum(), 64, 64)?;
    }
    if suspects.is_empty() {
        return Ok(Multi::one());
    }
    // Polynomials in these variables alone: the coefficients of all monomials in the others.
    let mut parts: BTreeSet<(usize, Multi)> = BTreeSet::new();
    for p in &some {
        let mut of_rest: BTreeMap<Vec<u32>, Multi> = BTreeMap::new();
        for (e, c) in &p.0 {
            let only = |is_kept: bool| -> Vec<u32> {
                let of = |(v, k): (usize, &u32)| if suspects.contains(&v) == is_kept { *k } else { 0 };
                let end = e.iter().enumerate().rposition(|at| of(at) > 0).map_or(0, |last| last + 1);
                e.iter().enumerate().take(end).map(of).collect()
            };
            of_rest.entry(only(false)).or_default().add(only(true), c.clone());
        }
        for part in of_rest.into_values() {
            let part = primitive(vec![part], clock)?.swap_remove(0);
            parts.insert((part.0.len(), part));
        }
    }
    let mut found = Multi::default();
    for (_, part) in parts {
        found = primitive(vec![found.gcd(&part, clock)?], clock)?.swap_remove(0);
        if found.is_constant() {
            return Ok(Multi::one());
        }
    }
    Ok(found)
}

/// Whether two polynomials may have a factor in common in which one of some variables occurs: their images say so.
pub fn may_share(p: &Multi, f: &Multi, variables: Range<usize>, clock: &Clock) -> Result<bool, String> {
    let both = [p.clone(), f.clone()];
    for v in variables.filter(|v| both.iter().all(|p| p.degree(*v) > 0)) {
        clock.spend(both.iter().map(|p| p.0.len()).sum::<usize>() + p.degree(v) * f.degree(v), 64, 64)?;
        if is_in_images(&both, v, POINTS[0]) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether the images in one variable have a common factor.
fn is_in_images(all: &[Multi], v: usize, point: u64) -> bool {
    let mut found: Vec<u64> = Vec::new();
    for p in all {
        found = common_image(found, image(p, v, point));
        if found.len() == 1 {
            return false;
        }
    }
    true
}

/// Coefficients of the powers of a variable, the others at values of their own.
fn image(p: &Multi, v: usize, point: u64) -> Vec<u64> {
    let mut out = vec![0; p.degree(v) + 1];
    let prime = Z::from(PRIME);
    for (e, c) in &p.0 {
        let residue = ((c % &prime) + &prime) % &prime;
        let others = e.iter().enumerate().filter(|(u, _)| *u != v);
        let start = residue.to_u64().unwrap_or(0);
        let value = others.fold(start, |value, (u, k)| value * power(point + u as u64, u64::from(*k)) % PRIME);
        let k = e.get(v).copied().unwrap_or(0) as usize;
        out[k] = (out[k] + value) % PRIME;
    }
    trimmed(out)
}

fn trimmed(mut p: Vec<u64>) -> Vec<u64> {
    while p.last() == Some(&0) {
        p.pop();
    }
    p
}

fn power(base: u64, exponent: u64) -> u64 {
    let (mut out, mut base, mut rest) = (1, base % PRIME, exponent);
    while rest > 0 {
        if rest % 2 == 1 {
            out = out * base % PRIME;
        }
        base = base * base % PRIME;
        rest /= 2;
    }
    out
}

/// Euclid's algorithm modulo the prime.
fn common_image(mut a: Vec<u64>, mut b: Vec<u64>) -> Vec<u64> {
    while let Some(lead) = b.last() {
        let inverse = power(*lead, PRIME - 2);
        while a.len() >= b.len() {
            let (shift, factor) = (a.len() - b.len(), a[a.len() - 1] * inverse % PRIME);
            for (x, y) in a[shift..].iter_mut().zip(&b) {
                *x = (*x + (PRIME - factor) * y) % PRIME;
            }
            a = trimmed(a);
        }
        (a, b) = (b, a);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_common_factor_is_found_and_none_is_invented() {
        let clock = &Clock::new(Duration::MAX);
        let [x, y, t] = [2, 3, 5].map(Multi::variable);
        let number = |n: i64| Multi::constant(Z::from(n));
        let f = x.times(&x, clock).unwrap().plus(&t.scaled(&Z::from(3)));
        let g = [x.plus(&y), y.times(&t, clock).unwrap().plus(&number(7)), Multi::default(), t.minus(&x)];
        let product = |f: &Multi| g.each_ref().map(|g| g.times(f, clock).unwrap());
        let found = common(&product(&f), usize::MAX, clock).unwrap();
        assert!(found == f || found == f.scaled(&Z::from(-1)), "{found:?}");
        assert_eq!(common(&product(&f), 5, clock).unwrap(), Multi::one());
        assert_eq!(common(&g, usize::MAX, clock).unwrap(), Multi::one());
        assert_eq!(common(&product(&number(12)), usize::MAX, clock).unwrap(), Multi::one());
        for (with, variables, is_shared) in [(&f, 2..6, true), (&f, 3..4, false), (&x, 2..6, false)] {
            assert_eq!(may_share(&product(&f)[0], with, variables, clock), Ok(is_shared));
        }
    }
}
