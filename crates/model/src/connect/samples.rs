//! The degree in one name of the characteristic polynomial of a loop over its hyperperiod.
//!
//! In each sample the loop is a matrix `A + K B`. The polynomial over a hyperperiod is, up to powers of `w`, the determinant of the matrix that
//! has these matrices around a circle: `K` enters in rows that are as many as the ranks of all `B` together. That bounds the degree
//! in `K`; no product of polynomials is made for it.

use super::rates::{Hyperperiod, Run};
use super::realise::realised;
use super::state_space::{Connecting, NotConnected, closed};
use crate::definition::Model;
use crate::evaluate::values::{Values, Wiring};
use crate::evaluate::work::count_work;
use crate::symbols::{Symbols, beside};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// A loop with several rates by the matrices of its samples, which are `A + K B` in a kept name `K`.
#[derive(Clone, Debug)]
pub struct Samples {
    /// The matrices `[A, B]` of each pattern of active blocks, registers of slower blocks among the states.
    pub patterns: Vec<[RationalMatrix; 2]>,
    /// The samples of a hyperperiod: a pattern, and how many times it comes in a row.
    pub runs: Vec<(usize, u64)>,
    /// The parts that act on no other part that acts on them.
    pub parts: Vec<SamplesPart>,
    /// What the variables of the matrices stand for.
    pub symbols: Symbols,
}

/// A part of such a loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SamplesPart {
    /// Its states at a sample, registers among them.
    pub at_sample: Vec<usize>,
    /// Which of these are states of the hyperperiod: not a register that the first sample overwrites.
    pub kept: Vec<usize>,
    /// Which states of the loop over a hyperperiod these are.
    pub states: Vec<usize>,
    /// A bound of the degree in `K` of its characteristic polynomial.
    pub degree: usize,
    /// So many roots are 1 where `K` is 0, at least.
    pub at_one: usize,
}

/// The samples of a loop with several rates. `None` where the kept name is in a divisor or a function, or not linear in the matrix of a sample.
///
/// Cost: the closed loop of each pattern of active blocks.
///
/// # Errors
/// As the connected loop.
pub(crate) fn samples(
    model: &Model,
    wiring: &Wiring<'_>,
    values: &Values,
    how: &Connecting<'_>,
) -> Result<Option<Samples>, NotConnected> {
    let (Values::Blocks { blocks, outputs }, Some(symbols)) = (values, how.symbols) else { return Ok(None) };
    let (mut poles, mut leading) = (Vec::new(), RationalFunction::one());
    let systems = realised(blocks, how, &mut poles, &mut leading)?;
    let of = Hyperperiod::new(&systems, blocks, model.hyperperiod(), how.start);
    let (mut known, mut patterns, mut all) = (Vec::<Vec<bool>>::new(), Vec::new(), Vec::new());
    for Run { sample, length, active } in of.runs() {
        how.budget.check()?;
        let at = known.iter().position(|pattern| *pattern == active);
        if at.is_none() {
            let (system, determinant) = closed(wiring, blocks, &of.at_sample(sample), outputs, how.set, how.budget)?;
            poles.push(determinant.numerator().clone());
            let Some(split) = linear(&system.a) else { return Ok(None) };
            known.push(active);
            patterns.push(split);
        }
        all.push((at.unwrap_or(patterns.len() - 1), length));
    }
    let symbols = symbols.borrow().without_kept();
    let Some(symbols) = symbols.filter(|_| poles.iter().all(|pole: &MultiPoly| pole.degree_in(0) == 0)) else {
        return Ok(None);
    };
    let parts = parts(&patterns, &all, &of.kept_places());
    Ok(Some(Samples { patterns, runs: all, parts, symbols }))
}

/// `A + K B` as `[A, B]`.
fn linear(m: &RationalMatrix) -> Option<[RationalMatrix; 2]> {
    let powers = m.entries().iter().map(in_powers).collect::<Option<Vec<_>>>()?;
    Some([0, 1].map(|k| RationalMatrix::from_fn(m.rows(), m.rows(), |i, j| powers[i * m.rows() + j][k].clone())))
}

fn parts(patterns: &[[RationalMatrix; 2]], runs: &[(usize, u64)], places: &[Option<usize>]) -> Vec<SamplesPart> {
    let acts = |i: usize, j: usize| patterns.iter().flatten().any(|m| !m[(i, j)].is_zero());
    let action = RationalMatrix::from_fn(places.len(), places.len(), |i, j| match acts(i, j) {
        true => RationalFunction::one(),
        false => RationalFunction::zero(),
    });
    let part = |at_sample: Vec<usize>| {
        let ranks: Vec<usize> = patterns.iter().map(|[_, b]| rank_of(&b.principal(&at_sample))).collect();
        let kept: Vec<usize> = (0..at_sample.len()).filter(|&k| places[at_sample[k]].is_some()).collect();
        SamplesPart {
            states: kept.iter().filter_map(|&k| places[at_sample[k]]).collect(),
            kept,
            degree: runs.iter().map(|(pattern, length)| ranks[*pattern] * *length as usize).sum(),
            at_one: resting(patterns, &at_sample, &Rational::ZERO),
            at_sample,
        }
    };
    action.decoupled_parts().into_iter().map(part).filter(|part| !part.states.is_empty()).collect()
}

impl Samples {
    /// How many roots of a part are 1 at a value of `K`, at least: so many of its states stay what they are in all samples.
    pub fn resting(&self, of: &SamplesPart, value: &Rational) -> usize {
        resting(&self.patterns, &of.at_sample, value)
    }
}

/// How many independent states stay what they are in all samples at a value of `K`, such as at 0 that of an integrator nobody reads; or how many
/// combinations of states do, such as that of an integrator nothing drives.
fn resting(patterns: &[[RationalMatrix; 2]], at_sample: &[usize], value: &Rational) -> usize {
    let n = at_sample.len();
    let moved = |transposed: bool| {
        let rows = patterns.iter().flat_map(|[a, b]| {
            let (a, b) = (a.principal(at_sample), b.principal(at_sample));
            let own = if value.is_zero() { a } else { &a + &b.scaled(&RationalFunction::from(value.clone())) };
            let entry = move |i: usize, j: usize| if transposed { own[(j, i)].clone() } else { own[(i, j)].clone() };
            let less_one =
                move |i: usize, j: usize| if i == j { &entry(i, j) - &RationalFunction::one() } else { entry(i, j) };
            (0..n).map(move |i| (0..n).map(|j| less_one(i, j)).collect::<Vec<_>>()).collect::<Vec<_>>()
        });
        n - rank(rows.collect(), n)
    };
    moved(false).max(moved(true))
}

fn rank_of(m: &RationalMatrix) -> usize {
    let n = m.rows();
    rank((0..n).map(|i| (0..n).map(|j| m[(i, j)].clone()).collect()).collect(), n)
}

/// The rank of a matrix by Gaussian elimination.
fn rank(mut rows: Vec<Vec<RationalFunction>>, columns: usize) -> usize {
    let mut found = 0;
    for column in 0..columns {
        let size = |f: &RationalFunction| f.numerator().terms().len() + f.denominator().terms().len();
        let candidates = (found..rows.len()).filter(|&i| !rows[i][column].is_zero());
        let Some(pivot) = candidates.min_by_key(|&i| size(&rows[i][column])) else { continue };
        rows.swap(found, pivot);
        let (above, below) = rows.split_at_mut(found + 1);
        let pivot = &above[found];
        for row in below.iter_mut().filter(|row| !row[column].is_zero()) {
            let factor = row[column].checked_div(&pivot[column]).expect("a pivot is not zero");
            for (entry, p) in row.iter_mut().zip(pivot).filter(|(_, p)| !p.is_zero()) {
                count_work(&factor, p);
                *entry = &*entry - &(&factor * p);
            }
        }
        found += 1;
    }
    found
}

/// `p + q K` as `[p, q]` in the other variables; `None` for another function of `K`, which is the first variable.
pub fn in_powers(f: &RationalFunction) -> Option<[RationalFunction; 2]> {
    let powers = f.numerator().as_poly_in(0);
    if powers.degree() > Some(1) {
        return None;
    }
    let below: RationalFunction = f.denominator().clone().into();
    let over = |p: MultiPoly| beside(&RationalFunction::from(p).checked_div(&below)?, 1);
    Some([over(powers.coeff(0))?, over(powers.coeff(1))?])
}

/// A bound of the rank: 1 where all minors of order 2 are zero, else the number of rows or columns that are not zero.
pub fn rank_bound(m: &RationalMatrix) -> usize {
    let n = m.rows();
    let rows = (0..n).filter(|&i| (0..n).any(|j| !m[(i, j)].is_zero())).count();
    let columns = (0..n).filter(|&j| (0..n).any(|i| !m[(i, j)].is_zero())).count();
    let bound = rows.min(columns);
    let Some(pivot) = (0..n * n).map(|at| (at / n, at % n)).find(|&at| !m[at].is_zero()) else { return 0 };
    // Beside a pivot that is not zero the others' minors are combinations of those with it.
    let is_minor_zero =
        |i: usize, j: usize| (&(&m[pivot] * &m[(i, j)]) - &(&m[(pivot.0, j)] * &m[(i, pivot.1)])).is_zero();
    let is_one = bound > 1 && (0..n).all(|i| (0..n).all(|j| is_minor_zero(i, j)));
    if is_one { 1 } else { bound }
}
