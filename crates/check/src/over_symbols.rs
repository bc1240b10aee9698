//! The characteristic polynomial of a sampled loop over the symbols of its held blocks.

use super::characteristic::Form;
use super::clock::Clock;
use super::multivariate::Multi;
use super::number::{Q, Z};
use super::statement::Extent;
use super::univariate::{Uni, gcd_of};
use num_traits::{One, Zero};
use std::collections::{BTreeMap, BTreeSet};

/// More sets of columns are refused.
const MAX_SETS: usize = 20_000;

/// More terms of all minors together are refused.
const MAX_TERMS: usize = 400_000;

/// Polynomials in the parameter (variable 1) and the symbols (from variable 2 on).
pub(super) struct OverSymbols {
    /// One more than the degree, from the constant term up, up to a factor that has no zero where the loop is defined.
    pub coefficients: Vec<Multi>,
    /// The loop is undefined at the zeros of these.
    pub poles: Vec<Multi>,
}

/// With all parameters but the one in question replaced by their values.
pub(super) fn over_symbols(
    form: &Form,
    divisors: &BTreeSet<Multi>,
    values: &[Q],
    clock: &Clock,
) -> Result<OverSymbols, String> {
    let Form::System(whole, alone) = form else {
        return Err("only a diagram of blocks has symbols".into());
    };
    let mut poles = Vec::new();
    for divisor in divisors {
        let of_symbols = divisor.0.keys().any(|e| e.len() > values.len());
        if of_symbols && divisor.degree(0) > 0 {
            return Err("a divisor has symbols and the variable".into());
        }
        // Undefined where all coefficients in variable 0 vanish together.
        let parts = if of_symbols { vec![divisor.clone()] } else { divisor.coefficients(0) };
        let parts = substituted(&parts, values, clock)?;
        poles.push(match parts.as_slice() {
            [part] => part.clone(),
            parts => common(parts, clock)?,
        });
    }
    let specialised = |rows: &[Vec<Multi>]| -> Result<Multi, String> {
        let rows = rows.iter().map(|row| substituted(row, values, clock)).collect::<Result<Vec<_>, _>>()?;
        determinant(&rows, clock)
    };
    let lead = |d: &Multi, degree: usize| d.coefficients(0).into_iter().nth(degree).unwrap_or_default();
    for (rows, degree) in alone {
        poles.push(lead(&specialised(rows)?, *degree));
    }
    let (rows, degree) = whole;
    let d = specialised(rows)?;
    if d.degree(0) > *degree {
        return Err("a determinant has a higher degree than the model".into());
    }
    poles.push(lead(&d, *degree));
    if poles.iter().any(Multi::is_zero) {
        return Err("the loop is undefined for every value".into());
    }
    let mut coefficients = d.coefficients(0);
    coefficients.resize(degree + 1, Multi::default());
    Ok(OverSymbols { coefficients, poles })
}

/// The greatest common divisor of polynomials in the parameter alone.
fn common(parts: &[Multi], clock: &Clock) -> Result<Multi, String> {
    let mut out = Uni::default();
    for part in parts {
        let list = part.coefficients(1).iter().map(|c| c.0.values().next().cloned().unwrap_or_default()).collect();
        out = out.gcd(&Uni::new(list), clock)?;
    }
    let terms = out.0.into_iter().enumerate().filter(|(_, c)| !c.is_zero());
    Ok(Multi(terms.map(|(k, c)| (if k == 0 { Vec::new() } else { vec![0, k as u32] }, c)).collect()))
}

/// Polynomials with values for the variables from 2 up, together times a positive number; symbols become variables from 2 on.
pub(super) fn substituted(row: &[Multi], values: &[Q], clock: &Clock) -> Result<Vec<Multi>, String> {
    let known = |e: &[u32]| values.len().min(e.len());
    let mut greatest = vec![0; values.len()];
    for e in row.iter().flat_map(|p| p.0.keys()) {
        for i in 2..known(e) {
            greatest[i] = greatest[i].max(e[i]);
        }
    }
    // A value n/d to the power k is n^k d^(m - k), times d^m for the greatest power m.
    let mut weights: Vec<BTreeMap<u32, Z>> = vec![BTreeMap::new(); values.len()];
    let mut out = Vec::with_capacity(row.len());
    for p in row {
        let mut sum = Multi::default();
        for (e, c) in &p.0 {
            let mut term = c.clone();
            for i in (2..values.len()).filter(|&i| greatest[i] > 0) {
                let (k, most) = (e.get(i).copied().unwrap_or(0), greatest[i]);
                let (n, d) = (values[i].numer(), values[i].denom());
                clock.spend(1, n.bits() * u64::from(k) + d.bits() * u64::from(most - k), term.bits())?;
                term *= &*weights[i].entry(k).or_insert_with(|| n.pow(k) * d.pow(most - k));
            }
            let mut key: Vec<u32> = e.iter().take(2).copied().collect();
            key.extend(&e[known(e)..]);
            sum.add(key, term);
        }
        out.push(sum);
    }
    primitive(out, clock)
}

/// Divided by the greatest common divisor of all integers in it.
pub(super) fn primitive(row: Vec<Multi>, clock: &Clock) -> Result<Vec<Multi>, String> {
    let g = gcd_of(row.iter().flat_map(|p| p.0.values()), clock)?;
    if g.is_zero() || g.is_one() {
        return Ok(row);
    }
    clock.spend(row.iter().map(|p| p.0.len()).sum(), g.bits(), 64)?;
    Ok(row.into_iter().map(|p| Multi(p.0.into_iter().map(|(e, c)| (e, c / &g)).collect())).collect())
}

/// The determinant, row by row: for each set of columns that the rows so far can take, the determinant of these rows in these
/// columns [Laplace's expansion]. Most entries of a system matrix are zero.
pub(super) fn determinant(rows: &[Vec<Multi>], clock: &Clock) -> Result<Multi, String> {
    let n = rows.len();
    if n > 64 {
        return Err("a loop with symbols has too many signals".into());
    }
    let mut minors: BTreeMap<u64, Multi> = BTreeMap::from([(0, Multi::one())]);
    for row in rows {
        let mut next: BTreeMap<u64, Multi> = BTreeMap::new();
        for (columns, minor) in &minors {
            for (j, entry) in row.iter().enumerate().filter(|(j, e)| columns >> j & 1 == 0 && !e.is_zero()) {
                let after = (columns >> j).count_ones();
                let product = minor.times(entry, clock)?;
                let sum = next.entry(columns | 1 << j).or_default();
                *sum = if after % 2 == 1 { sum.minus(&product) } else { sum.plus(&product) };
            }
        }
        next.retain(|_, minor| !minor.is_zero());
        let terms: usize = next.values().map(|minor| minor.0.len()).sum();
        if next.len() > MAX_SETS || terms > MAX_TERMS {
            return Err(clock.refuse("a loop with symbols is too large for the check"));
        }
        minors = next;
    }
    Ok(minors.into_values().next().unwrap_or_default())
}

/// `D(R z)`, times a positive number.
pub(super) fn in_disc(d: &[Multi], extent: &Extent) -> Vec<Multi> {
    let n = d.len().saturating_sub(1) as u32;
    let term = |k: u32| match extent {
        Extent::Parameter if k == 0 => (Vec::new(), Z::one()),
        Extent::Parameter => (vec![0, k], Z::one()),
        Extent::Number(r) => (Vec::new(), r.numer().pow(k) * r.denom().pow(n - k)),
    };
    let times = |c: &Multi, (e, factor): (Vec<u32>, Z)| {
        let moved = |key: &Vec<u32>| {
            let length = key.len().max(e.len());
            let at = |list: &[u32], i: usize| list.get(i).copied().unwrap_or(0);
            (0..length).map(|i| at(key, i) + at(&e, i)).collect()
        };
        Multi(c.0.iter().map(|(key, c)| (moved(key), c * &factor)).collect())
    };
    d.iter().enumerate().map(|(k, c)| times(c, term(k as u32))).collect()
}

/// Whether the polynomial that is given is the model's divided by something that has no zero where the loop is defined.
pub(super) fn same(given: &[Multi], own: &[Multi], clock: &Clock) -> Result<(), String> {
    if given.len() != own.len() {
        return Err(format!("there are {} coefficients, but the model's polynomial has {}", given.len(), own.len()));
    }
    let (given, own) = (primitive(given.to_vec(), clock)?, primitive(own.to_vec(), clock)?);
    let (Some(last), Some(own_last)) = (given.last(), own.last()) else { return Ok(()) };
    // Gauss: the quotient by a polynomial without common integers is integral.
    let quotient = own_last.divided(last, clock)?.ok_or("the leading coefficient is not that of the model")?;
    for (k, (g, o)) in given.iter().zip(&own).enumerate() {
        if g.times(&quotient, clock)? != *o {
            return Err(format!("coefficient {k} is not that of the model"));
        }
    }
    Ok(())
}
