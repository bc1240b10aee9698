//! Determinants in the coefficients of a polynomial whose signs are the conditions of Jury and of Routh.

use super::basis::Unexpanded;
use super::interpolation::{coefficients_of, likely_scale};
use crate::precisions::{DETERMINANT_AT_POINT, ENDS_OF_DETERMINANT};
use jurist_algebra::ball::{Ball, determinant_enclosed};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::{Matrix, determinant_bareiss};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};
use jurist_algebra::real::Origin;
use jurist_algebra::symbols::{EnclosedPoly, Symbols, common_scale};
use std::sync::Arc;

/// A coefficient is proved to be zero on a grid of no more points than this.
const MOST_POINTS: u64 = 20_000;

/// A square matrix of polynomials in the parameter (variable 0) and symbols, of which the determinant is asked for.
#[derive(Clone, Debug)]
pub(super) struct Minor {
    rows: Vec<Vec<MultiPoly>>,
}

impl Minor {
    /// The matrix of one entry.
    pub fn of(entry: MultiPoly) -> Minor {
        Minor { rows: vec![vec![entry]] }
    }

    /// The sum or the difference of Jury's matrices of size `k`, of coefficients from the constant term up:
    /// `X` has `a_(j - i)` on and above its diagonal, `Y` has `a_(n + 1 + i + j - k)`, zero beyond `a_n`.
    ///
    /// With `D+_k` and `D-_k` their determinants, the entries at either end of row `i` of the divided table satisfy
    /// `first + last = D+_(i + 1) D-_(i - 1)`, `first - last = D-_(i + 1) D+_(i - 1)` ([Jury1964](jurist_algebra::bibliography#jury1964)).
    pub fn inner(a: &[MultiPoly], k: usize, is_sum: bool) -> Minor {
        let n = a.len() - 1;
        let entry = |i: usize, j: usize| {
            let x = j.checked_sub(i).map_or_else(MultiPoly::zero, |at| a[at].clone());
            let y = a.get(n + 1 + i + j - k).cloned().unwrap_or_default();
            if is_sum { x.plus(&y) } else { x.minus(&y) }
        };
        Minor { rows: (0..k).map(|i| (0..k).map(|j| entry(i, j)).collect()).collect() }
    }

    /// Hurwitz's matrix of size `k`, of coefficients from the constant term up.
    pub fn hurwitz(a: &[MultiPoly], k: usize) -> Minor {
        let n = a.len() - 1;
        // Row i, column j: the coefficient at distance 2 j - i + 1 from the leading one.
        let entry = |i: usize, j: usize| {
            let at = (2 * j + 1).checked_sub(i).and_then(|distance| n.checked_sub(distance));
            at.map_or_else(MultiPoly::zero, |at| a[at].clone())
        };
        Minor { rows: (0..k).map(|i| (0..k).map(|j| entry(i, j)).collect()).collect() }
    }

    /// A bound of the degree in each variable.
    fn degrees(&self) -> Vec<u64> {
        let mut all: Vec<u64> = Vec::new();
        for row in &self.rows {
            let mut highest: Vec<u64> = Vec::new();
            for entry in row {
                for (v, d) in entry.degrees().into_iter().enumerate() {
                    highest.resize(highest.len().max(v + 1), 0);
                    highest[v] = highest[v].max(u64::from(d));
                }
            }
            all.resize(all.len().max(highest.len()), 0);
            all.iter_mut().zip(highest).for_each(|(sum, d)| *sum += d);
        }
        all
    }

    /// A bound of the number of terms of the determinant.
    pub fn expanded_size(&self) -> u64 {
        self.degrees().into_iter().fold(1, |size, d| size.saturating_mul(d + 1))
    }

    /// The determinant as a polynomial.
    pub fn expanded(&self, budget: &Budget) -> Result<MultiPoly, Exhausted> {
        determinant_bareiss(&Matrix::from_fn(self.rows.len(), self.rows.len(), |i, j| self.rows[i][j].clone()), budget)
    }

    /// The matrix at a value of the parameter, times a positive integer.
    fn at(&self, value: &Rational) -> Vec<Vec<MultiPoly>> {
        let flat: Vec<MultiPoly> = self.rows.iter().flatten().cloned().collect();
        common_scale(&flat, value).chunks(self.rows.len()).map(<[MultiPoly]>::to_vec).collect()
    }

    /// A number with the sign that the determinant has at a value of the parameter.
    pub fn enclosed_at(&self, value: &Rational, symbols: &Symbols, bits: u64) -> Ball {
        let rows = self.at(value);
        determinant_enclosed(rows.iter().map(|row| row.iter().map(|c| symbols.enclose(c, bits)).collect()).collect())
    }

    /// Whether the determinant is zero for every value of the parameter.
    pub fn vanishes(&self, symbols: &Symbols, budget: &Budget) -> Result<bool, Exhausted> {
        if !self.on_line(0, budget)?.is_zero() {
            // Not zero for the symbols as unknowns; for their values it shows where it is not.
            for k in 1..=4 {
                if budget
                    .enter(|| self.enclosed_at(&Rational::from(k), symbols, ENDS_OF_DETERMINANT.first))?
                    .sign()
                    .is_some_and(|s| s.is_ne())
                {
                    return Ok(false);
                }
            }
        }
        let expanded = self.expanded(budget)?;
        for coefficient in expanded.as_poly_in(0).coeffs() {
            if !symbols.is_zero(&coefficient.map_variables(|i| i.saturating_sub(1)), budget)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The determinant in the parameter alone, small integers in the place of the symbols, different for each line.
    pub fn on_line(&self, line: u64, budget: &Budget) -> Result<UniPoly, Exhausted> {
        let on = |p: &MultiPoly| {
            let place = |i: u64| Integer::from(3 + (i * 7 + line * 11) % 23);
            let point: Vec<Integer> = (0..p.degrees().len() as u64).map(place).collect();
            UniPoly::new(p.as_poly_in(0).coeffs().iter().map(|c| c.eval_integers(&point)).collect())
        };
        determinant_bareiss(&Matrix::from_fn(self.rows.len(), self.rows.len(), |i, j| on(&self.rows[i][j])), budget)
    }
}

/// The determinant as a polynomial in the parameter with enclosed coefficients, without those at either end that are zero.
#[derive(Debug)]
pub(super) struct EnclosedMinor {
    minor: Minor,
    symbols: Arc<Symbols>,
    /// The entries by powers of the parameter.
    parts: Vec<Vec<Vec<MultiPoly>>>,
    /// The orders of the first and the last coefficient that are not zero.
    low: usize,
    high: usize,
    /// The parameter is about a power of two with this exponent where the loop changes.
    scale: i64,
}

impl EnclosedMinor {
    /// Finds out which coefficients at the ends are zero: those that are so on a grid of values of the symbols with more points
    /// along each axis than the degree.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where a coefficient seems to be zero and is not proved to be.
    pub fn new(minor: Minor, symbols: &Arc<Symbols>, budget: &Budget) -> Result<EnclosedMinor, Exhausted> {
        let split = |p: &MultiPoly| -> Vec<MultiPoly> {
            p.as_poly_in(0).coeffs().iter().map(|c| c.map_variables(|i| i.saturating_sub(1))).collect()
        };
        let parts: Vec<Vec<Vec<MultiPoly>>> = minor.rows.iter().map(|row| row.iter().map(split).collect()).collect();
        let degree = |row: &Vec<Vec<MultiPoly>>| row.iter().map(Vec::len).max().unwrap_or(1).max(1) - 1;
        let high = parts.iter().map(degree).sum();
        let symbols = Arc::clone(symbols);
        let mut out = EnclosedMinor { minor, symbols, parts, low: 0, high, scale: 0 };
        out.scale =
            budget.enter(|| likely_scale(out.parts.iter().flatten(), &out.symbols, ENDS_OF_DETERMINANT.first))?;
        let mut proved = (0, 0);
        let step = "zeros among the coefficients of a determinant";
        let (low, high) = ENDS_OF_DETERMINANT.decide(step, |bits| {
            let all = budget.enter(|| out.coefficients(bits))?;
            let ends = (all.iter().position(|c| !c.contains_zero()), all.iter().rposition(|c| !c.contains_zero()));
            let (Some(low), Some(last)) = ends else { return Ok(None) };
            let above = high - last;
            if proved.0 < low && out.lowest_vanish(low, false, budget)? {
                proved.0 = low;
            }
            if proved.1 < above && out.lowest_vanish(above, true, budget)? {
                proved.1 = above;
            }
            Ok::<_, Exhausted>((proved == (low, above)).then_some((low, last)))
        })?;
        Ok(EnclosedMinor { low, high, ..out })
    }

    /// The degree in the parameter.
    pub fn degree(&self) -> usize {
        self.high
    }

    /// Whether so many coefficients at the lower end, or the upper one, are zero whatever the symbols are.
    fn lowest_vanish(&self, count: usize, from_above: bool, budget: &Budget) -> Result<bool, Exhausted> {
        let sides: Vec<u64> = self.minor.degrees().into_iter().skip(1).map(|d| d + 1).collect();
        let points = sides.iter().fold(1, |size: u64, d| size.saturating_mul(*d));
        if points > MOST_POINTS {
            return Ok(false);
        }
        let size = self.parts.len();
        for index in 0..points {
            let mut rest = index;
            let point: Vec<Integer> = sides
                .iter()
                .map(|side| {
                    let at = rest % side;
                    rest /= side;
                    Integer::from(at)
                })
                .collect();
            // Only the lowest powers of the entries matter.
            let entry = |i: usize, j: usize| {
                let degree = self.parts[i].iter().map(Vec::len).max().unwrap_or(0);
                let value = |k: usize| self.parts[i][j].get(k).map_or(Integer::ZERO, |c| c.eval_integers(&point));
                let place = |k: usize| if from_above { degree.checked_sub(k + 1) } else { Some(k) };
                UniPoly::new((0..count).map(|k| place(k).map_or(Integer::ZERO, value)).collect())
            };
            let value = determinant_bareiss(&Matrix::from_fn(size, size, entry), budget)?;
            if (0..count).any(|k| !value.coeff(k).is_zero()) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// All coefficients.
    fn coefficients(&self, bits: u64) -> Vec<Ball> {
        let size = self.parts.len();
        let degree = |row: &Vec<Vec<MultiPoly>>| row.iter().map(Vec::len).max().unwrap_or(1).max(1) - 1;
        let count = self.parts.iter().map(degree).sum::<usize>() + 1;
        coefficients_of(self.parts.iter().flatten(), &self.symbols, (self.scale, count, bits), |entries| {
            determinant_enclosed(entries.chunks(size).map(<[Ball]>::to_vec).collect())
        })
    }
}

impl Unexpanded for EnclosedMinor {
    fn vanishes_at_zero(&self) -> bool {
        self.low > 0
    }
}

impl EnclosedPoly for EnclosedMinor {
    fn enclose(&self, bits: u64) -> Vec<Ball> {
        self.coefficients(bits).drain(self.low..=self.high).map(|c| c.with_bits(bits)).collect()
    }

    fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        let differs = DETERMINANT_AT_POINT.find(|bits| {
            let sign = budget.enter(|| self.minor.enclosed_at(x, &self.symbols, bits))?.sign();
            Ok::<_, Exhausted>(sign.filter(|s| s.is_ne()))
        })?;
        if differs.is_some() {
            return Ok(false);
        }
        self.symbols.is_zero(&Minor { rows: self.minor.at(x) }.expanded(budget)?, budget)
    }

    fn origin(&self) -> Origin {
        let symbols =
            (0..self.symbols.len()).map(|i| (self.symbols.names()[i].clone(), self.symbols.definition_text(i)));
        Origin::Function { function: "minor of the table".to_owned(), details: symbols.collect() }
    }
}
