//! What is known of the roots of a loop from its coefficients as they are, before they are enclosed.

use super::family::trimmed;
use super::windows::Never;
use crate::{RootCount, Shape, count_roots};
use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};
use std::collections::BTreeMap;

/// What enclosures of the coefficients do not show.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Known {
    /// The roots of the factor that is [left out](without_fixed_factor).
    pub fixed: RootCount,
    /// Whether a root of the rest is at `s = 0`, whatever the parameter is.
    pub is_at_zero: bool,
}

impl Known {
    /// Of the coefficients that are left, and of the factor.
    pub fn new(coefficients: &[Vec<MultiPoly>], factor: &UniPoly) -> Known {
        let at_zero = coefficients.iter().filter_map(|part| part.first());
        Known {
            fixed: count_roots(factor, Shape::LeftHalfPlane),
            is_at_zero: at_zero.fold(MultiPoly::zero(), |sum, c| sum.plus(c)).is_zero(),
        }
    }

    /// Why the loop is stable for no value of the parameter, where roots are counted from the imaginary axis or from another line.
    pub fn never(&self, is_from_axis: bool) -> Option<Never> {
        if self.fixed.on + self.fixed.outside > 0 {
            return Some(Never::FixedRoot);
        }
        (is_from_axis && self.is_at_zero).then_some(Never::RootAtZero)
    }
}

/// The coefficients of `z^k s^j` at `[k][j]` without the greatest factor that is a polynomial in `s` with integer coefficients, and this factor: its roots depend
/// neither on a dead time nor on a parameter.
///
/// Cost: a greatest common divisor for each monomial in the parameter and the symbols.
///
/// # Panics
/// When all coefficients are zero.
pub(super) fn without_fixed_factor(coefficients: Vec<Vec<MultiPoly>>) -> (UniPoly, Vec<Vec<MultiPoly>>) {
    let coefficients = trimmed(coefficients);
    let parts: Vec<_> = coefficients.iter().map(|part| by_monomials(part)).collect();
    let all = parts.iter().flat_map(BTreeMap::values);
    let common = all.fold(UniPoly::zero(), |common, p| match common.degree() {
        Some(0) => common,
        _ => common.gcd(p),
    });
    if common.degree() == Some(0) {
        return (UniPoly::one(), coefficients);
    }
    let factor = common.primitive_part();
    let order = coefficients[0].len() - factor.degree().expect("it is not zero");
    let rest = parts.iter().map(|part| {
        let mut list = vec![MultiPoly::zero(); order];
        for (exponents, p) in part {
            let rest = p.div_exact(&factor).expect("it divides");
            for (c, term) in list.iter_mut().zip(rest.coeffs()) {
                *c = c.plus(&MultiPoly::from_terms([(exponents.clone(), term.clone())]));
            }
        }
        list
    });
    let rest = rest.collect();
    (factor, rest)
}

/// The polynomial in `s` beside each monomial in the other variables.
fn by_monomials(part: &[MultiPoly]) -> BTreeMap<Vec<u32>, UniPoly> {
    let mut lists: BTreeMap<Vec<u32>, Vec<Integer>> = BTreeMap::new();
    for (j, c) in part.iter().enumerate() {
        for (monomial, number) in c.terms() {
            let list = lists.entry(monomial.exponents().to_vec()).or_insert_with(|| vec![Integer::ZERO; part.len()]);
            list[j] = number.clone();
        }
    }
    lists.into_iter().map(|(exponents, list)| (exponents, UniPoly::new(list))).collect()
}
