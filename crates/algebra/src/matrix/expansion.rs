//! The characteristic polynomial of a sparse matrix by its minors.

use crate::limits::{checkpoint, claim};
use crate::number::Integer;
use std::collections::BTreeMap;

/// More columns than this do not fit a set.
const MOST_COLUMNS: usize = u64::BITS as usize;

/// Exponents as one number, digits of a mixed radix in which no sum of exponents of a minor carries, with the coefficient.
pub(super) type Terms = Vec<(usize, Integer)>;

/// A square matrix in rows, each with the columns of the entries that are not zero.
pub(super) struct SparseRows(pub Vec<Vec<(usize, Terms)>>);

/// In which order rows are taken.
pub(super) struct Plan {
    order: Vec<usize>,
    #[cfg(test)]
    products: usize,
}

impl SparseRows {
    /// How to expand the determinant by at most so many products of terms.
    ///
    /// The minors of the first rows are indexed by their columns; a set of columns that the other rows cannot complete is left out.
    pub fn plan(&self, most: usize) -> Option<Plan> {
        let n = self.0.len();
        if n > MOST_COLUMNS {
            return None;
        }
        let columns: Vec<u64> = self.0.iter().map(|row| row.iter().fold(0, |set, (j, _)| set | 1 << j)).collect();
        let (mut order, mut seen) = (Vec::with_capacity(n), 0u64);
        while order.len() < n {
            // The row with the fewest new columns: few sets of them.
            let rest = (0..n).filter(|i| !order.contains(i));
            let next = rest.min_by_key(|&i| ((seen | columns[i]).count_ones(), columns[i].count_ones()))?;
            seen |= columns[next];
            order.push(next);
        }
        let mut minors = BTreeMap::from([(0u64, 1usize)]);
        let mut products = 0usize;
        for (k, &row) in order.iter().enumerate() {
            let completed = self.completable(&order[k + 1..]);
            let mut next: BTreeMap<u64, usize> = BTreeMap::new();
            for (&set, &terms) in &minors {
                for (j, entry) in self.0[row].iter().filter(|(j, _)| set >> j & 1 == 0) {
                    let larger = set | 1 << j;
                    if completed(larger) {
                        let more = terms.saturating_mul(entry.len());
                        products = products.saturating_add(more);
                        let sum = next.entry(larger).or_default();
                        *sum = sum.saturating_add(more);
                    }
                }
                if products > most {
                    return None;
                }
            }
            checkpoint(minors.len() as u64 * 8);
            minors = next;
        }
        Some(Plan {
            order,
            #[cfg(test)]
            products,
        })
    }

    /// Whether the columns beside a set are among those of these rows.
    fn completable(&self, rows: &[usize]) -> impl Fn(u64) -> bool {
        let all = if self.0.len() == MOST_COLUMNS { u64::MAX } else { (1 << self.0.len()) - 1 };
        let within = rows.iter().flat_map(|&i| &self.0[i]).fold(0u64, |set, (j, _)| set | 1 << j);
        move |set| (all & !set) & !within == 0
    }

    /// The terms of the determinant, ascending; all sums of exponents of a minor are below `size`.
    pub fn determinant(&self, Plan { order, .. }: &Plan, size: usize) -> Terms {
        let mut minors: BTreeMap<u64, Terms> = BTreeMap::from([(0, vec![(0, Integer::ONE)])]);
        // A sum is gathered in place of its exponents.
        claim((size * size_of::<Integer>()) as u64);
        let mut sums = vec![Integer::ZERO; size];
        for (k, &row) in order.iter().enumerate() {
            let completed = self.completable(&order[k + 1..]);
            let mut sources: BTreeMap<u64, Vec<(bool, &Terms, &Terms)>> = BTreeMap::new();
            for (&set, minor) in &minors {
                for (j, entry) in self.0[row].iter().filter(|(j, _)| set >> j & 1 == 0) {
                    let larger = set | 1 << j;
                    if completed(larger) {
                        // Columns behind this one that the rows before have.
                        let negative = (set >> j).count_ones() % 2 == 1;
                        sources.entry(larger).or_default().push((negative, entry, minor));
                    }
                }
            }
            let next = sources.into_iter().map(|(set, parts)| (set, sum_of_products(&parts, &mut sums))).collect();
            minors = next;
        }
        let mut terms = minors.into_values().next().unwrap_or_default();
        if is_odd(order) {
            for (_, c) in &mut terms {
                *c = -std::mem::take(c);
            }
        }
        terms
    }
}

fn sum_of_products(parts: &[(bool, &Terms, &Terms)], sums: &mut [Integer]) -> Terms {
    let mut places = Vec::new();
    for &(negative, entry, minor) in parts {
        checkpoint((4 * entry.len() * minor.len()) as u64);
        for (shift, c) in entry {
            let negated;
            let c = if negative {
                negated = -c;
                &negated
            } else {
                c
            };
            for (at, x) in minor {
                places.push(at + shift);
                sums[at + shift].add_mul_assign(c, x);
            }
        }
    }
    places.sort_unstable();
    places.dedup();
    let taken = places.into_iter().map(|at| (at, std::mem::take(&mut sums[at])));
    taken.filter(|(_, c)| !c.is_zero()).collect()
}

/// Whether a permutation is odd.
fn is_odd(order: &[usize]) -> bool {
    let inversions = order.iter().enumerate().map(|(k, a)| order[k + 1..].iter().filter(|b| *b < a).count());
    inversions.sum::<usize>() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::{Matrix, determinant_leibniz};

    fn sparse(m: &Matrix<Integer>) -> SparseRows {
        let row = |i: usize| (0..m.columns()).filter(move |&j| !m[(i, j)].is_zero());
        SparseRows((0..m.rows()).map(|i| row(i).map(|j| (j, vec![(0, m[(i, j)].clone())])).collect()).collect())
    }

    #[test]
    fn determinants_are_those_of_leibniz() {
        let mut state = 3u64;
        for round in 0..200u64 {
            let n = (round % 7) as usize;
            let m = Matrix::from_fn(n, n, |_, _| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                let value = (state >> 33) % (9 + 4 * (round % 5));
                Integer::from(if value < 9 { value as i64 - 4 } else { 0 })
            });
            let matrix = sparse(&m);
            let plan = matrix.plan(usize::MAX).expect("no bound");
            let found = matrix.determinant(&plan, 1);
            let expected = determinant_leibniz(&m);
            assert_eq!(found.first().map_or(Integer::ZERO, |(_, c)| c.clone()), expected, "{m:?}");
        }
    }

    /// Two products: the diagonal, and the one beside it.
    #[test]
    fn sets_that_cannot_be_completed_are_left_out() {
        let n = 11;
        let ring = Matrix::from_fn(n, n, |i, j| Integer::from(i64::from(i == j || (i + 1) % n == j)));
        let matrix = sparse(&ring);
        let plan = matrix.plan(2 * n).expect("two products for each row");
        assert_eq!(plan.products, 2 * n);
        assert_eq!(matrix.determinant(&plan, 1), [(0, Integer::from(2))]);
        assert!(matrix.plan(2 * n - 1).is_none());
    }
}
