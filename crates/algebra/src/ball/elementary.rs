//! Elementary functions of what enclosures are: what symbols are computed with.

use super::{Ball, Enclosed, Series, TaylorModel, fundamental_solutions};
use crate::number::Integer;

/// Enclosures of functions that elementary functions are known of.
pub trait Elementary: Enclosed {
    /// Bits after the point.
    fn bits(&self) -> u64;
    /// A constant of the same kind.
    fn constant(&self, c: &Ball) -> Self;
    /// Where the values are.
    fn range(&self) -> Ball;
    /// The square root; `None` where it may not be defined.
    fn square_root(&self) -> Option<Self>;
    /// The exponential.
    fn exponential(&self) -> Self;
    /// The [`fundamental_solutions`] at this time.
    fn solutions(&self, coefficients: &[Self]) -> Vec<Self>;

    /// An integer.
    fn integer(&self, n: &Integer) -> Self {
        self.constant(&Ball::from_integer(n, self.bits()))
    }

    /// One over this; `None` where there may be a zero.
    fn reciprocal(&self) -> Option<Self> {
        self.integer(&Integer::ONE).over(self)
    }
}

/// The values are those at the point, or at every point of the ball that the constant term is.
impl Elementary for Series {
    fn bits(&self) -> u64 {
        self.coefficients()[0].bits()
    }
    fn constant(&self, c: &Ball) -> Series {
        Series::constant(c, self.terms())
    }
    fn range(&self) -> Ball {
        self.coefficients()[0].clone()
    }
    fn square_root(&self) -> Option<Series> {
        match self.coefficients() {
            // At zero there is a value, but no series.
            [value] if value.lower().is_zero() => Some(Series::constant(&value.sqrt()?, 1)),
            _ => self.sqrt(),
        }
    }
    fn exponential(&self) -> Series {
        self.exp()
    }
    fn solutions(&self, coefficients: &[Series]) -> Vec<Series> {
        fundamental_solutions(coefficients, self)
    }
}

impl Elementary for TaylorModel {
    fn bits(&self) -> u64 {
        self.polynomial().coefficients()[0].bits()
    }
    fn constant(&self, c: &Ball) -> TaylorModel {
        TaylorModel::from_series(Series::constant(c, self.polynomial().terms()))
    }
    fn range(&self) -> Ball {
        TaylorModel::range(self)
    }
    fn square_root(&self) -> Option<TaylorModel> {
        self.sqrt()
    }
    fn exponential(&self) -> TaylorModel {
        self.exp()
    }
    fn solutions(&self, coefficients: &[TaylorModel]) -> Vec<TaylorModel> {
        TaylorModel::solutions(coefficients, self)
    }
}
