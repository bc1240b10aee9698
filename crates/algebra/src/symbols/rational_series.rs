//! Power series over the rational numbers of symbols at a point where their arguments vanish, as at the sample time 0.

use super::Definition;
use crate::number::{Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};

/// A power series by its coefficients.
type Series = Vec<Rational>;

fn constant(c: Rational, terms: usize) -> Series {
    let mut out = vec![Rational::ZERO; terms];
    out[0] = c;
    out
}

pub(super) fn product(a: &Series, b: &Series) -> Series {
    let coefficient = |k: usize| (0..=k).fold(Rational::ZERO, |sum, j| sum + &a[j] * &b[k - j]);
    (0..a.len()).map(coefficient).collect()
}

fn sum(a: &Series, b: &Series) -> Series {
    a.iter().zip(b).map(|(x, y)| x + y).collect()
}

pub(super) fn quotient(a: &Series, b: &Series) -> Option<Series> {
    let inverse = b[0].recip()?;
    let mut out: Series = Vec::with_capacity(a.len());
    for (k, first) in a.iter().enumerate() {
        let rest = out.iter().enumerate().fold(first.clone(), |rest, (j, q)| rest - q * &b[k - j]);
        out.push(&rest * &inverse);
    }
    Some(out)
}

/// A polynomial in series.
pub(super) fn polynomial_at(p: &MultiPoly, values: &[Series]) -> Series {
    let terms = values[0].len();
    let mut total = vec![Rational::ZERO; terms];
    for (monomial, c) in p.terms() {
        let mut term = constant(Rational::from(c), terms);
        for (i, value) in values.iter().enumerate() {
            for _ in 0..monomial.exponent(i) {
                term = product(&term, value);
            }
        }
        total = sum(&total, &term);
    }
    total
}

/// The parameter and the symbols around a value of the parameter; `None` unless all series are rational for a reason: because
/// arguments of exponentials vanish there.
pub(super) fn values(table: &[(String, Definition)], at: &Rational, terms: usize) -> Option<Vec<Series>> {
    let mut parameter = constant(at.clone(), terms);
    if terms > 1 {
        parameter[1] = Rational::ONE;
    }
    let mut out = vec![parameter];
    for (_, definition) in table {
        let value = |f: &RationalFunction| -> Option<Series> {
            quotient(&polynomial_at(f.numerator(), &out), &polynomial_at(f.denominator(), &out))
        };
        let next = match definition {
            Definition::Pi
            | Definition::Algebraic(_)
            | Definition::Enclosed(_)
            | Definition::Root(_)
            | Definition::Duty(_)
            | Definition::Family(_) => return None,
            Definition::Exponential(x) => exponential(1, &[value(x)?])?.swap_remove(0),
            Definition::Tangent { square, time } => {
                let (w, t) = (value(square)?, value(time)?);
                let zero = vec![Rational::ZERO; terms];
                let below: Series = product(&w, &t).iter().map(|c| -c).collect();
                let e = exponential(2, &[zero.clone(), t, below, zero])?;
                quotient(&e[1], &e[0])?
            }
            Definition::Fundamental { polynomial, index, time } => {
                let (n, t) = (polynomial.len() - 1, value(time)?);
                let mut entries = vec![vec![Rational::ZERO; terms]; n * n];
                for i in 0..n - 1 {
                    entries[i * n + i + 1] = t.clone();
                }
                for (j, c) in polynomial[..n].iter().enumerate() {
                    entries[(n - 1) * n + j] = product(&value(c)?, &t).iter().map(|c| -c).collect();
                }
                exponential(n, &entries)?.swap_remove(*index)
            }
        };
        out.push(next);
    }
    Some(out)
}

/// The exponential of a matrix of series without constant terms: its powers vanish in the end.
fn exponential(size: usize, entries: &[Series]) -> Option<Vec<Series>> {
    let terms = entries[0].len();
    if entries.iter().any(|s| !s[0].is_zero()) {
        return None;
    }
    let identity = |k: usize| constant(if k / size == k % size { Rational::ONE } else { Rational::ZERO }, terms);
    let mut total: Vec<Series> = (0..size * size).map(identity).collect();
    let mut power = total.clone();
    for k in 1..terms {
        let scale = Rational::new(Integer::ONE, Integer::from(k as u64));
        let entry = |i: usize, j: usize| {
            let products = (0..size).map(|l| product(&power[i * size + l], &entries[l * size + j]));
            let sum = products.reduce(|a, b| sum(&a, &b)).expect("the size is positive");
            sum.iter().map(|c| c * &scale).collect::<Series>()
        };
        power = (0..size * size).map(|m| entry(m / size, m % size)).collect();
        total = total.iter().zip(&power).map(|(a, b)| sum(a, b)).collect();
    }
    Some(total)
}
