//! The rows of Jury's and Routh's tables in a parameter, each coefficient enclosed.

use super::SymbolicPolynomial;
use crate::precisions::{ENTRIES_AS_ZERO, TABLE_ROWS};
use crate::{Shape, UNDIVIDED_ORDER, row_name};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer};
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_algebra::symbols::Symbols;

/// Rows with more terms are not looked through for coefficients that are zero.
const MOST_TERMS: usize = 2_000;

/// A polynomial in the parameter, its coefficients from the constant term up, without zeros at the end.
pub(super) type Enclosed = Vec<Ball>;

/// A row of a table in one parameter.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SymbolicRow {
    /// `a`, `b`, ... of Jury's table, `s^n`, ... of Routh's.
    pub name: String,
    /// The entries, each a polynomial in the parameter, its coefficients from the constant term up.
    pub entries: Vec<Vec<Enclosure>>,
    /// The entry that the row was divided by, such as `a_0`.
    pub divided_by: Option<String>,
}

/// Which coefficients are zero by an identity, by row and entry.
type Zeros = Vec<Vec<Vec<bool>>>;

/// A table of polynomials with enclosed coefficients.
pub(super) struct EnclosedRows {
    pub rows: Vec<Vec<Enclosed>>,
    /// What the coefficients were multiplied by, where that depends on the parameter.
    pub cleared_by: Option<Enclosed>,
}

/// Which table is asked for.
pub(super) struct Asked {
    pub region: Shape,
    /// Rows of Routh's table, whose first entries are not zero but for the last; all of Jury's.
    pub rows: usize,
    /// The degrees of the first entries by which others are divided, by row.
    pub divisors: Vec<usize>,
    /// Digits of the coefficients.
    pub digits: usize,
}

/// The table of `p`.
///
/// # Errors
/// [`Exhausted`] when the budget runs out, and where a divisor is not told from zero.
pub(super) fn enclosed_rows(
    p: &SymbolicPolynomial,
    symbols: &Symbols,
    asked: &Asked,
    budget: &Budget,
) -> Result<EnclosedRows, Exhausted> {
    let mut zeros = Zeros::new();
    TABLE_ROWS.decide("the entries of the table", |bits| {
        budget.check()?;
        let is_fine = |table: &EnclosedRows| {
            bits >= ENTRIES_AS_ZERO || table.rows.iter().flatten().flatten().all(|c| is_narrow(c, asked.digits))
        };
        let table = budget.enter(|| attempt(p, symbols, asked, &zeros, bits))?.filter(is_fine);
        if table.is_none() && zeros.is_empty() {
            zeros = zero_coefficients(p, symbols, asked, budget)?;
        }
        Ok(table)
    })
}

/// A polynomial in the parameter over a number, its coefficients known to so many digits.
///
/// # Errors
/// [`Exhausted`] when the budget runs out, and where the divisor is not told from zero.
pub(super) fn enclosed_quotient(
    above: &MultiPoly,
    below: &MultiPoly,
    symbols: &Symbols,
    digits: usize,
    budget: &Budget,
) -> Result<Enclosed, Exhausted> {
    let number = |c: &MultiPoly| c.map_variables(|i| i.saturating_sub(1));
    let coefficients: Vec<MultiPoly> = above.as_poly_in(0).coeffs().iter().map(number).collect();
    let zeros: Vec<bool> = coefficients.iter().map(|c| symbols.is_zero(c, budget)).collect::<Result<_, _>>()?;
    let below = number(below);
    TABLE_ROWS.decide("the entries of the table", |bits| {
        budget.check()?;
        let all = budget.enter(|| {
            let below = symbols.enclose(&below, bits);
            let value = |(c, is_zero): (&MultiPoly, &bool)| match is_zero {
                true => Some(Ball::zero(bits)),
                false => symbols.enclose(c, bits).div(&below),
            };
            coefficients.iter().zip(&zeros).map(value).collect::<Option<Enclosed>>()
        })?;
        Ok(all.filter(|all| bits >= ENTRIES_AS_ZERO || all.iter().all(|c| is_narrow(c, digits))))
    })
}

/// Whether the coefficient is zero, or known to so many digits.
fn is_narrow(b: &Ball, digits: usize) -> bool {
    b.is_zero() || b.width_units() * Integer::from(10).pow(digits as u64 + 2) <= b.least_magnitude_units()
}

/// In Routh's table row `k` begins with two rows of coefficients.
fn first_rows<T: Clone>(a: &[T], region: Shape) -> Vec<Vec<T>> {
    match region {
        Shape::UnitDisc => vec![a.to_vec()],
        Shape::LeftHalfPlane => {
            let line = |from: usize| a.iter().rev().skip(from).step_by(2).cloned().collect::<Vec<T>>();
            if a.len() > 1 { vec![line(0), line(1)] } else { vec![line(0)] }
        }
    }
}

/// The row after these, before it is divided; `None` where the table ends.
fn next_row<T: Clone>(
    rows: &[Vec<T>],
    region: Shape,
    order: usize,
    zero: &T,
    minor: impl Fn([&T; 4]) -> T,
) -> Option<Vec<T>> {
    let last = rows.last()?;
    match region {
        Shape::UnitDisc => {
            let m = last.len() - 1;
            (m > 2).then(|| (0..m).map(|k| minor([&last[0], &last[k], &last[m], &last[m - k]])).collect())
        }
        Shape::LeftHalfPlane => {
            let k = rows.len();
            if k < 2 || k > order {
                return None;
            }
            let (up2, up1) = (&rows[k - 2], &rows[k - 1]);
            let entry = |j: usize| minor([&up1[0], up2.get(j).unwrap_or(zero), &up2[0], up1.get(j).unwrap_or(zero)]);
            Some((1..=(order - k) / 2 + 1).map(entry).collect())
        }
    }
}

/// The row whose first entry divides the row of this number.
fn divisor(row: usize, region: Shape, order: usize) -> Option<usize> {
    match region {
        Shape::UnitDisc => (order > UNDIVIDED_ORDER && row >= 3).then(|| row - 2),
        Shape::LeftHalfPlane => (row >= 4).then(|| row - 3),
    }
}

fn attempt(p: &SymbolicPolynomial, symbols: &Symbols, asked: &Asked, zeros: &Zeros, bits: u64) -> Option<EnclosedRows> {
    let (n, region, count) = (p.formal_degree, asked.region, asked.rows);
    let in_parameter = |c: &MultiPoly| -> Enclosed {
        let number = |c: &MultiPoly| symbols.enclose(&c.map_variables(|i| i.saturating_sub(1)), bits);
        c.as_poly_in(0).coeffs().iter().map(number).collect()
    };
    let denominator = &p.poles[0];
    let mut a: Vec<Enclosed> = (0..=n).map(|k| in_parameter(&p.polynomial.coeff(k))).collect();
    let cleared_by = (denominator.degree_in(0) > 0).then(|| in_parameter(denominator));
    if cleared_by.is_none() {
        let denominator = in_parameter(denominator).swap_remove(0);
        a = a.iter().map(|c| c.iter().map(|b| b.div(&denominator)).collect()).collect::<Option<_>>()?;
    }
    let known = |row: Vec<Enclosed>, i: usize| -> Vec<Enclosed> {
        let known = |(j, entry): (usize, Enclosed)| {
            // Beyond the degree that the entry has all is zero.
            let is_zero = |k: usize| zeros.get(i).is_some_and(|row| row[j].get(k).is_none_or(|z| *z));
            let known = entry.into_iter().enumerate().map(|(k, b)| if is_zero(k) { Ball::zero(bits) } else { b });
            trimmed(known.collect())
        };
        let mut row: Vec<Enclosed> = row.into_iter().enumerate().map(known).collect();
        if let Some(degree) = asked.divisors.get(i).filter(|_| i > 0) {
            row[0].truncate(degree + 1);
        }
        row
    };
    let mut rows: Vec<Vec<Enclosed>> =
        first_rows(&a, region).into_iter().enumerate().map(|(i, row)| known(row, i)).collect();
    let minor = |[a, b, c, d]: [&Enclosed; 4]| minus(&times(a, b, bits), &times(c, d, bits), bits);
    while region == Shape::UnitDisc || rows.len() < count {
        let Some(row) = next_row(&rows, region, n, &Vec::new(), minor) else { break };
        let row = match divisor(rows.len(), region, n) {
            Some(k) => row.iter().map(|e| quotient(e, &rows[k][0])).collect::<Option<_>>()?,
            None => row,
        };
        rows.push(known(row, rows.len()));
    }
    rows.truncate(count);
    Some(EnclosedRows { rows, cleared_by })
}

/// Which coefficients of the first rows are zero: no enclosure shows that. As far as rows stay short that are not divided.
fn zero_coefficients(
    p: &SymbolicPolynomial,
    symbols: &Symbols,
    asked: &Asked,
    budget: &Budget,
) -> Result<Zeros, Exhausted> {
    let (n, region, count) = (p.formal_degree, asked.region, asked.rows);
    let a: Vec<MultiPoly> = (0..=n).map(|k| p.polynomial.coeff(k)).collect();
    let is_zero = |c: &MultiPoly| match symbols.is_zero(&c.map_variables(|i| i.saturating_sub(1)), budget) {
        Err(stopped) if stopped.stop.is_precision() => Ok(false),
        found => found,
    };
    let mut rows = first_rows(&a, region);
    loop {
        let terms: usize = rows[rows.len() - 1].iter().map(|entry| entry.terms().len()).sum();
        if terms > MOST_TERMS || rows.len() >= count || divisor(rows.len(), region, n).is_some() {
            break;
        }
        let minor = |[a, b, c, d]: [&MultiPoly; 4]| a.times(b).minus(&c.times(d));
        let Some(row) = budget.enter(|| next_row(&rows, region, n, &MultiPoly::zero(), minor))? else { break };
        rows.push(row);
    }
    let of_entry = |entry: &MultiPoly| entry.as_poly_in(0).coeffs().iter().map(is_zero).collect::<Result<_, _>>();
    rows.iter().map(|row| row.iter().map(of_entry).collect()).collect()
}

fn trimmed(mut p: Enclosed) -> Enclosed {
    while p.last().is_some_and(Ball::is_zero) {
        p.pop();
    }
    p
}

pub(super) fn times(a: &Enclosed, b: &Enclosed, bits: u64) -> Enclosed {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut out = vec![Ball::zero(bits); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        for (j, y) in b.iter().enumerate().filter(|(_, y)| !y.is_zero()) {
            out[i + j] = out[i + j].add(&x.mul(y));
        }
    }
    trimmed(out)
}

fn minus(a: &Enclosed, b: &Enclosed, bits: u64) -> Enclosed {
    let zero = Ball::zero(bits);
    let at = |p: &Enclosed, k: usize| p.get(k).unwrap_or(&zero).clone();
    trimmed((0..a.len().max(b.len())).map(|k| at(a, k).sub(&at(b, k))).collect())
}

pub(super) fn plus(a: &Enclosed, b: &Enclosed, bits: u64) -> Enclosed {
    let negated: Enclosed = b.iter().map(Ball::neg).collect();
    minus(a, &negated, bits)
}

/// The quotient by a polynomial that is known to divide; `None` where its leading coefficient is not told from zero.
fn quotient(a: &Enclosed, divisor: &Enclosed) -> Option<Enclosed> {
    let lead = divisor.last()?;
    let mut rest = a.clone();
    let mut out = Vec::new();
    while rest.len() >= divisor.len() {
        let c = rest.pop()?.div(lead)?;
        let from = rest.len() + 1 - divisor.len();
        for (k, d) in divisor[..divisor.len() - 1].iter().enumerate() {
            rest[from + k] = rest[from + k].sub(&c.mul(d));
        }
        out.push(c);
    }
    out.reverse();
    Some(trimmed(out))
}

impl EnclosedRows {
    /// The rows with their names.
    pub fn named(&self, region: Shape, order: usize, digits: usize) -> Vec<SymbolicRow> {
        let name = |i: usize| match region {
            Shape::UnitDisc => row_name(i),
            Shape::LeftHalfPlane => format!("s^{}", order.saturating_sub(i)),
        };
        let row = |(i, entries): (usize, &Vec<Enclosed>)| SymbolicRow {
            name: name(i),
            entries: entries.iter().map(|e| shown(e, digits)).collect(),
            divided_by: match region {
                Shape::UnitDisc => divisor(i, region, order).map(|k| format!("{}_0", row_name(k))),
                Shape::LeftHalfPlane => None,
            },
        };
        self.rows.iter().enumerate().map(row).collect()
    }
}

/// Coefficients with no more bits than their digits need.
pub(super) fn shown(p: &Enclosed, digits: usize) -> Vec<Enclosure> {
    p.iter().map(|c| super::jury::shortened(c, digits).to_enclosure()).collect()
}
