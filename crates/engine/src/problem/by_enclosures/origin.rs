//! Roots at the origin that a loop has for every value of the parameter `K`, from combinations of rational rows that vanish.

use crate::model::{Samples, SamplesPart};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::RationalFunction;

/// A loop of more samples is not looked at.
const MOST_SAMPLES: u64 = 200;

/// A row whose entries are functions of `K`, which is variable 0.
type Row = Vec<RationalFunction>;

/// The number of rational rows of `A + K B` less their rank over the rational functions of `K`.
pub(super) fn dependent_rows(constant: &RationalMatrix, linear: &RationalMatrix) -> usize {
    let rows: Vec<Row> = rational_rows(constant, linear).into_iter().flatten().collect();
    vanishing_on(rows, &(0..constant.rows()).collect::<Vec<_>>()).len()
}

/// A bound from below of the number of roots at the origin of a part of a loop over its hyperperiod.
///
/// A combination of states that vanishes after some hyperperiods, whatever the states were before, has one. These combinations are followed back
/// from sample to sample, as long as they meet rational rows alone: such as a register of a dead time that has the value that a slow block holds.
pub(super) fn roots_at_origin(samples: &Samples, of: &SamplesPart) -> usize {
    let n = of.at_sample.len();
    if samples.runs.iter().map(|(_, length)| length).sum::<u64>() > MOST_SAMPLES {
        return 0;
    }
    let known = |[a, b]: &[RationalMatrix; 2]| rational_rows(&a.principal(&of.at_sample), &b.principal(&of.at_sample));
    let patterns: Vec<Vec<Option<Row>>> = samples.patterns.iter().map(known).collect();
    let mut rows: Vec<Row> = vec![vec![RationalFunction::zero(); n]; of.kept.len()];
    for (row, &at) in rows.iter_mut().zip(&of.kept) {
        row[at] = RationalFunction::one();
    }
    let mut found = 0;
    for _ in 0..of.kept.len() {
        for (pattern, length) in samples.runs.iter().rev() {
            let next = &patterns[*pattern];
            let others: Vec<usize> = (0..n).filter(|&i| next[i].is_none()).collect();
            for _ in 0..*length {
                rows = vanishing_on(rows, &others).iter().map(|row| before(row, next)).collect();
            }
        }
        let vanishing = vanishing_on(rows.clone(), &(0..n).collect::<Vec<_>>()).len();
        if vanishing == found {
            break;
        }
        found = vanishing;
    }
    found
}

/// The rows of `A + K B` that are rational.
fn rational_rows(constant: &RationalMatrix, linear: &RationalMatrix) -> Vec<Option<Row>> {
    let n = constant.rows();
    let k = RationalFunction::variable(0);
    let entry = |i: usize, j: usize| {
        let [a, b] = [constant, linear].map(|m| m[(i, j)].as_constant());
        Some(&RationalFunction::from(a?) + &(&RationalFunction::from(b?) * &k))
    };
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// A combination of states after a sample as one of the states before it; it is zero where a row is not rational.
fn before(row: &Row, next: &[Option<Row>]) -> Row {
    let mut out = vec![RationalFunction::zero(); row.len()];
    for (factor, next) in row.iter().zip(next).filter(|(factor, _)| !factor.is_zero()) {
        for (entry, x) in out.iter_mut().zip(next.as_ref().expect("a rational row")).filter(|(_, x)| !x.is_zero()) {
            *entry = &*entry + &(factor * x);
        }
    }
    out
}

/// Independent combinations of rows that are zero in some columns, as many as there are, by elimination.
pub(super) fn vanishing_on(mut rows: Vec<Row>, columns: &[usize]) -> Vec<Row> {
    for &column in columns {
        let Some(at) = rows.iter().position(|row| !row[column].is_zero()) else { continue };
        let pivot = rows.swap_remove(at);
        for row in rows.iter_mut().filter(|row| !row[column].is_zero()) {
            let factor = row[column].checked_div(&pivot[column]).expect("a pivot is not zero");
            for (entry, p) in row.iter_mut().zip(&pivot).filter(|(_, p)| !p.is_zero()) {
                *entry = &*entry - &(&factor * p);
            }
        }
    }
    rows
}
