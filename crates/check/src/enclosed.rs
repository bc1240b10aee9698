//! The determinant of a loop whose numbers are only enclosed: of long hyperperiods, and of functions that the model has written.
//!
//! Elimination with enclosures gives the values of the determinant at integers. Divided differences of these values give enclosures of its coefficients.

use super::clock::Clock;
use super::interval::{Interval, balanced};
use super::moving::Sources;
use super::multivariate::Multi;
use super::number::{Q, Z};
use super::over_box::FIRST;
use super::taylor::{Precision, Taylor};
use num_traits::One;
use std::collections::BTreeMap;

/// Elimination has so many bits beside twice those of the certificate.
const MORE_BITS: usize = 128;

/// Determinants of more values are refused.
const MAX_VALUES: usize = 800;

/// So many more integers are tried than are needed.
const MORE_TRIES: usize = 8;

/// The exponents of the loop's variable and of the parameters.
type Powers = Vec<usize>;

/// A row of a matrix: its entries by columns, each by powers.
type Row = BTreeMap<usize, BTreeMap<Powers, Interval>>;

/// A determinant over a window, times a number that is not zero. Variables are the loop's, the parameters of the window from [`FIRST`] on, and the
/// sources.
pub(super) struct Determinant<'d> {
    pub rows: &'d [Vec<Multi>],
    /// The degree in the loop's variable.
    pub degree: usize,
    pub window: &'d [[Q; 2]],
    pub sources: &'d Sources,
    pub bits: usize,
    pub clock: &'d Clock,
}

/// Polynomials with a list of coefficients each, all times `2^exponent`.
struct Scaled {
    lists: Vec<Interval>,
    exponent: i64,
}

impl Determinant<'_> {
    fn working(&self) -> usize {
        2 * self.bits + MORE_BITS
    }

    /// The polynomial's coefficients by powers of the loop's variable. Each number in them is a further variable, and stands behind.
    pub fn as_further_variables(&self) -> Result<(Vec<Multi>, Vec<Interval>), String> {
        let (found, first) = (self.coefficients()?, FIRST + self.window.len() + self.sources.len());
        let mut coefficients = vec![Multi::default(); self.degree + 1];
        for (i, powers) in found.keys().enumerate() {
            let mut e = vec![0; first + i + 1];
            e[FIRST..].iter_mut().zip(&powers[1..]).for_each(|(place, k)| *place = *k as u32);
            e[first + i] = 1;
            coefficients[powers[0]].add(e, Z::one());
        }
        Ok((coefficients, found.into_values().collect()))
    }

    /// The coefficients by powers, in units of `2^-bits`; the longest has about as many bits.
    fn coefficients(&self) -> Result<BTreeMap<Powers, Interval>, String> {
        let rows = self.enclosed_rows()?;
        let mut counts = vec![self.degree + 1];
        counts.extend((1..=self.window.len()).map(|v| 1 + bound(&rows, v)));
        if counts.iter().try_fold(1, |all: usize, count| all.checked_mul(*count)).is_none_or(|all| all > MAX_VALUES) {
            return Err(self.clock.refuse("a determinant by enclosures has too many values"));
        }
        let mut point = vec![0; self.window.len()];
        let Scaled { mut lists, .. } = self.in_parameters(&rows, &counts, &mut point, self.window.len())?;
        balanced(&mut lists, self.bits);
        let at = |mut k: usize| {
            let mut powers = Powers::with_capacity(counts.len());
            for count in &counts {
                powers.push(k % count);
                k /= count;
            }
            powers
        };
        Ok(lists.into_iter().enumerate().map(|(k, c)| (at(k), c)).collect())
    }

    /// The coefficients in the loop's variable and in so many first parameters, the others being at a point.
    fn in_parameters(
        &self,
        rows: &[Row],
        counts: &[usize],
        point: &mut [i64],
        parameters: usize,
    ) -> Result<Scaled, String> {
        if parameters == 0 {
            return self.in_variable(rows, point, counts[0]);
        }
        let mut values = Vec::new();
        for k in 0..counts[parameters] as i64 {
            let value = if k % 2 == 1 { k / 2 + 1 } else { -k / 2 };
            point[parameters - 1] = value;
            values.push((value, self.in_parameters(rows, counts, point, parameters - 1)?));
        }
        self.interpolated(values)
    }

    /// The variables behind the loop's and the one that is not used there, over the whole window.
    fn values(&self) -> Result<Vec<Interval>, String> {
        let p = Precision::new(self.window.len(), 1, self.working());
        let parameters = self.window.iter().enumerate().map(|(i, side)| Taylor::coordinate(side, i, &p)).collect();
        let all = self.sources.values(parameters, &p, self.clock)?;
        Ok(all.iter().map(Taylor::range).collect())
    }

    /// The rows, each times a power of two. Every name beside the free ones has a value.
    fn enclosed_rows(&self) -> Result<Vec<Row>, String> {
        let bits = self.working();
        let values = self.values()?;
        // A parameter that has one value is a number.
        let is_number = |v: usize| self.window.get(v).is_none_or(|[low, high]| low == high);
        let mut out = Vec::with_capacity(self.rows.len());
        for row in self.rows {
            let mut entries = Row::new();
            for (column, p) in row.iter().enumerate() {
                for (e, c) in &p.0 {
                    let mut of = Interval::integer(c, bits);
                    for (v, (x, k)) in values.iter().zip(e.iter().skip(FIRST)).enumerate() {
                        if !is_number(v) {
                            continue;
                        }
                        for _ in 0..*k {
                            self.clock.spend(4, of.magnitude().bits(), bits as u64)?;
                            of = of.times(x, bits);
                        }
                    }
                    let power = |v: usize| e.get(v).copied().unwrap_or(0) as usize;
                    let of_parameter = |v: usize| if is_number(v) { 0 } else { power(FIRST + v) };
                    let powers = [power(0)].into_iter().chain((0..self.window.len()).map(of_parameter)).collect();
                    let sum = entries.entry(column).or_default().entry(powers).or_insert_with(Interval::zero);
                    *sum = sum.plus(&of);
                }
            }
            let mut all: Vec<Interval> = entries.values().flat_map(BTreeMap::values).cloned().collect();
            balanced(&mut all, bits);
            entries.values_mut().flat_map(BTreeMap::values_mut).zip(all).for_each(|(place, x)| *place = x);
            out.push(entries);
        }
        Ok(out)
    }

    /// The coefficients in the loop's variable at values of the parameters, from its values at integers that no usual root is at.
    fn in_variable(&self, rows: &[Row], point: &[i64], count: usize) -> Result<Scaled, String> {
        let mut found = Vec::with_capacity(count);
        let nodes = (2..).flat_map(|k: i64| [k, -k]).take(count + MORE_TRIES);
        for z in nodes {
            if found.len() == count {
                break;
            }
            let at = || [z].into_iter().chain(point.iter().copied());
            let power = |powers: &Powers| {
                at().zip(powers).map(|(x, k)| Z::from(x).pow(*k as u32)).fold(Z::one(), |all, own| all * own)
            };
            let mut numbers = Vec::with_capacity(rows.len());
            for row in rows {
                let mut entries = BTreeMap::new();
                for (column, terms) in row {
                    self.clock.spend(terms.len(), self.working() as u64, 64)?;
                    let sum = terms.iter().fold(Interval::zero(), |sum, (e, c)| sum.plus(&c.scaled(&power(e))));
                    if sum != Interval::zero() {
                        entries.insert(*column, sum);
                    }
                }
                numbers.push(entries);
            }
            if let Some(value) = self.eliminated(numbers)? {
                found.push((z, value));
            }
        }
        if found.len() < count {
            return Err("a determinant by enclosures is not told from zero".into());
        }
        self.interpolated(found)
    }

    /// A determinant of numbers; `None` where what is to be divided by may be zero.
    fn eliminated(&self, mut rows: Vec<BTreeMap<usize, Interval>>) -> Result<Option<Scaled>, String> {
        let bits = self.working();
        let mut product = Scaled { lists: vec![Interval::integer(&Z::one(), bits)], exponent: 0 };
        let mut taken: Vec<(usize, usize)> = Vec::with_capacity(rows.len());
        let mut left: Vec<usize> = (0..rows.len()).collect();
        while !left.is_empty() {
            self.clock.hold(left.iter().map(|&r| rows[r].len()).sum(), 2 * bits as u64)?;
            if left.iter().any(|&r| rows[r].is_empty()) {
                return Ok(Some(Scaled { lists: vec![Interval::zero()], exponent: 0 }));
            }
            // The shortest row fills up least; its largest entry keeps numbers short.
            left.sort_by_key(|&r| rows[r].len());
            let certain = |row: &BTreeMap<usize, Interval>| {
                let certain = row.iter().filter(|(_, x)| !x.contains_zero());
                certain.max_by(|a, b| a.1.magnitude().cmp(&b.1.magnitude())).map(|(column, _)| *column)
            };
            let pivot = left.iter().enumerate().find_map(|(at, &r)| Some((at, certain(&rows[r])?)));
            let (at, column) = match (pivot, left.as_slice()) {
                (Some(found), _) => found,
                // Nothing is divided by the last one.
                (None, [last]) => (0, rows[*last].keys().next().copied().unwrap_or(0)),
                (None, _) => return Ok(None),
            };
            let r = left.remove(at);
            let mut row = std::mem::take(&mut rows[r]);
            let pivot = row.remove(&column).unwrap_or_else(Interval::zero);
            taken.push((r, column));
            product.lists[0] = product.lists[0].times(&pivot, bits);
            let length = product.lists[0].magnitude().bits() as i64;
            balanced(&mut product.lists, bits);
            product.exponent += length - bits as i64;
            if left.iter().all(|&other| !rows[other].contains_key(&column)) {
                continue;
            }
            let mut shares = Vec::with_capacity(row.len());
            for (k, x) in &row {
                self.clock.spend(8, bits as u64, bits as u64)?;
                shares.push((*k, x.divided(&pivot, bits).ok_or("internal: a pivot is zero")?));
            }
            for &other in &left {
                let Some(factor) = rows[other].remove(&column) else { continue };
                self.clock.spend(4 * shares.len(), bits as u64, bits as u64)?;
                for (k, share) in &shares {
                    let step = factor.times(share, bits);
                    let entry = rows[other].entry(*k).or_insert_with(Interval::zero);
                    *entry = entry.minus(&step);
                }
            }
        }
        if is_odd(taken) {
            product.lists[0] = product.lists[0].negated();
        }
        Ok(Some(product))
    }

    /// From lists of values at integers the lists of coefficients, one after the other, by Newton's divided differences.
    fn interpolated(&self, values: Vec<(i64, Scaled)>) -> Result<Scaled, String> {
        let bits = self.working();
        let size = |s: &Scaled| s.lists.iter().map(|x| x.magnitude().bits() as i64).max().unwrap_or(0);
        let longest = values.iter().filter(|(_, s)| size(s) > 0).map(|(_, s)| size(s) + s.exponent).max().unwrap_or(0);
        let exponent = longest - bits as i64;
        let aligned = |s: &Scaled| -> Vec<Interval> {
            let shift = s.exponent - exponent;
            let moved = |x: &Interval| match usize::try_from(shift) {
                Ok(up) => x.scaled(&(Z::one() << up)),
                Err(_) => x.narrowed(shift.unsigned_abs() as usize),
            };
            // Of nothing but zeros no shift is known.
            if size(s) == 0 { s.lists.clone() } else { s.lists.iter().map(moved).collect() }
        };
        let nodes: Vec<i64> = values.iter().map(|(node, _)| *node).collect();
        let lists: Vec<Vec<Interval>> = values.iter().map(|(_, s)| aligned(s)).collect();
        let mut out: Vec<Vec<Interval>> = vec![Vec::new(); nodes.len()];
        for k in 0..lists.first().map_or(0, Vec::len) {
            self.clock.spend(nodes.len() * nodes.len(), bits as u64, 64)?;
            let mut d: Vec<Interval> = lists.iter().map(|list| list[k].clone()).collect();
            for step in 1..d.len() {
                for i in (step..d.len()).rev() {
                    let gap = nodes[i] - nodes[i - step];
                    let difference = if gap > 0 { d[i].minus(&d[i - 1]) } else { d[i - 1].minus(&d[i]) };
                    d[i] = difference.over(&Z::from(gap.abs()));
                }
            }
            let mut polynomial: Vec<Interval> = Vec::with_capacity(d.len());
            for (difference, node) in d.iter().zip(&nodes).rev() {
                // polynomial <- polynomial (t - node) + difference
                polynomial.insert(0, difference.clone());
                for i in 1..polynomial.len() {
                    let times = polynomial[i].scaled(&Z::from(*node));
                    polynomial[i - 1] = polynomial[i - 1].minus(&times);
                }
            }
            for (list, c) in out.iter_mut().zip(polynomial) {
                list.push(c);
            }
        }
        Ok(Scaled { lists: out.into_iter().flatten().collect(), exponent })
    }
}

/// A bound of the degree of a determinant in a parameter.
fn bound(rows: &[Row], v: usize) -> usize {
    let degree = |terms: &BTreeMap<Powers, Interval>| terms.keys().map(|e| e[v]).max().unwrap_or(0);
    let of_rows = rows.iter().map(|row| row.values().map(degree).max().unwrap_or(0)).sum::<usize>();
    let mut columns: BTreeMap<usize, usize> = BTreeMap::new();
    for (column, terms) in rows.iter().flatten() {
        let most = columns.entry(*column).or_default();
        *most = (*most).max(degree(terms));
    }
    of_rows.min(columns.values().sum())
}

/// Whether rows and columns that belong together are an odd permutation.
fn is_odd(mut pairs: Vec<(usize, usize)>) -> bool {
    pairs.sort_unstable();
    let mut columns: Vec<usize> = pairs.into_iter().map(|(_, column)| column).collect();
    let mut odd = false;
    for i in 0..columns.len() {
        while columns.get(columns[i]).is_some() && columns[i] != i {
            let to = columns[i];
            columns.swap(i, to);
            odd = !odd;
        }
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_symbols::determinant;
    use num_traits::ToPrimitive;
    use std::time::Duration;

    /// A matrix of small polynomials in the loop's variable and three parameters, most of them zero.
    fn matrix(n: usize, seed: &mut u64) -> Vec<Vec<Multi>> {
        let mut below = |bound: u64| {
            *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*seed >> 33) % bound
        };
        let mut entry = |i: usize, j: usize| {
            let mut p = Multi::default();
            for _ in 0..if i == j { 2 } else { below(5) / 3 } {
                let e = vec![below(2) as u32, 0, below(8) as u32 / 7, below(6) as u32 / 5, below(9) as u32 / 8];
                p.add(e, Z::from(below(19) as i64 - 9));
            }
            p
        };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }

    /// All coefficients are those of the expanded determinant, times one number.
    #[test]
    #[ignore = "long: CI runs it"]
    fn coefficients_are_those_of_the_expanded_determinant() {
        let (clock, mut seed, sources) = (Clock::new(Duration::MAX), 7, Sources::default());
        let side = |a: i64, b: i64| [a, b].map(|x| Q::from(Z::from(x)));
        let window = [side(-1, 2), side(3, 4), side(0, 5)];
        let mut told = 0;
        for case in 0..60 {
            let rows = matrix(2 + case % 6, &mut seed);
            let exact = determinant(&rows, &clock).unwrap();
            let degree = rows.len();
            let of = Determinant { rows: &rows, degree, window: &window, sources: &sources, bits: 96, clock: &clock };
            let Ok(found) = of.coefficients() else { continue };
            let number = |x: &Z| x.to_f64().unwrap();
            let value = |key: &Powers| {
                let mut e: Vec<u32> = vec![key[0] as u32, 0, key[1] as u32, key[2] as u32, key[3] as u32];
                while e.last() == Some(&0) {
                    e.pop();
                }
                exact.0.get(&e).map_or(0.0, number)
            };
            assert!(exact.0.keys().all(|e| {
                let at = |i: usize| e.get(i).copied().unwrap_or(0) as usize;
                found.contains_key(&vec![at(0), at(2), at(3), at(4)])
            }));
            let largest = found.iter().max_by_key(|(_, x)| x.magnitude()).unwrap();
            let scale = if exact.is_zero() { 0.0 } else { number(&largest.1.lo) / value(largest.0) };
            for (key, x) in &found {
                let (lo, hi, expected) = (number(&x.lo), number(&x.hi), value(key) * scale);
                let slack = number(&largest.1.magnitude()) * 1e-12;
                assert!(lo - slack <= expected && expected <= hi + slack, "{key:?}: {lo} {hi} {expected}");
                assert!(hi - lo <= slack, "{key:?}: {lo} {hi}");
            }
            told += 1;
        }
        assert!(told > 50, "{told}");
    }

    #[test]
    fn permutations_have_their_sign() {
        assert!(!is_odd(vec![(0, 0), (1, 1)]) && is_odd(vec![(0, 1), (1, 0)]) && !is_odd(vec![(2, 0), (0, 1), (1, 2)]));
    }
}
