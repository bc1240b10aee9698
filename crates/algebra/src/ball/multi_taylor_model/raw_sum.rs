//! Sums of products of Taylor models that are rounded once.

use super::{MultiTaylorModel, up};
use crate::limits::checkpoint;
use crate::number::Integer;

/// A sum of products with twice the bits after the point.
pub(super) struct RawSum {
    coefficients: Vec<Integer>,
    left_out: Integer,
}

impl RawSum {
    pub fn of(like: &MultiTaylorModel) -> RawSum {
        RawSum { coefficients: vec![Integer::ZERO; like.coefficients.len()], left_out: Integer::ZERO }
    }

    pub fn add_product(&mut self, one: &MultiTaylorModel, other: &MultiTaylorModel) {
        let monomials = &one.monomials;
        let filled = other.coefficients.iter().rposition(|c| !c.is_zero()).map_or(0, |i| i + 1);
        for (a, places) in one.coefficients.iter().zip(&monomials.products).filter(|(a, _)| !a.is_zero()) {
            checkpoint((4 * places.len().min(filled)) as u64);
            for (b, &place) in other.coefficients[..filled].iter().zip(places) {
                if !b.is_zero() {
                    self.coefficients[place as usize].add_mul_assign(a, b);
                }
            }
        }
        let (a, b) = (one.sizes(), other.sizes());
        for (i, a) in a.iter().enumerate() {
            for b in &b[monomials.degree + 1 - i.min(monomials.degree)..] {
                if i > 0 {
                    self.left_out.add_mul_assign(a, b);
                }
            }
        }
        if !other.rest.is_zero() {
            self.left_out.add_mul_assign(&a.iter().fold(one.rest.clone(), |sum, a| sum + a), &other.rest);
        }
        if !one.rest.is_zero() {
            self.left_out.add_mul_assign(&b.iter().fold(Integer::ZERO, |sum, b| sum + b), &one.rest);
        }
    }

    pub fn model(self, like: &MultiTaylorModel) -> MultiTaylorModel {
        let coefficients = self.coefficients.into_iter().map(|c| c >> like.bits).collect();
        like.with(coefficients, up(self.left_out, like.bits) + like.roundings())
    }
}
