//! Elementary functions of what enclosures are: what symbols are computed with.

use super::flow::exponential_of;
use super::implicit::implicit;
use super::{Ball, BallMatrix, Enclosed, MultiTaylorModel, Series, TaylorModel, exponential, fundamental_solutions};
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

    /// The zero `d` of a function of enclosures of this kind. The closure says its value and its slope at `d`, and has one zero in a ball
    /// at each point. `None` where it is not shown to have enclosures.
    fn implicit(&self, start: &Ball, f: &dyn Fn(&Self) -> Option<[Self; 2]>) -> Option<Self>;
    /// The list as Taylor models in several variables, where it is one.
    fn as_models(_list: &[Self]) -> Option<&[MultiTaylorModel]> {
        None
    }
    /// These models as a list of this kind, where they are.
    fn of_models(_models: Vec<MultiTaylorModel>) -> Option<Vec<Self>> {
        None
    }
    /// The exponential of a matrix of so many rows, given row by row; `None` where it may have too many bits to be of use.
    fn exponential_of(n: usize, matrix: &[Self]) -> Option<Vec<Self>>;
    /// The line `a + b y` in one variable that this number is, with a bound of its distance from the line; `None` of other functions.
    fn line(&self) -> Option<Along>;
    /// The sum of `c_k y^k` with the variable of a line, or with none for a constant.
    fn of_powers(&self, variable: Option<usize>, coefficients: &[Ball]) -> Self;

    /// An integer.
    fn integer(&self, n: &Integer) -> Self {
        self.constant(&Ball::from_integer(n, self.bits()))
    }

    /// One over this; `None` where there may be a zero.
    fn reciprocal(&self) -> Option<Self> {
        self.integer(&Integer::ONE).over(self)
    }
}

/// A line `a + b y` in one of the variables, or a constant.
#[derive(Clone, Debug)]
pub struct Along {
    /// The constant term.
    pub first: Ball,
    /// The slope.
    pub slope: Ball,
    /// The number of the variable.
    pub variable: Option<usize>,
    /// The number of powers of a variable that numbers of this kind keep.
    pub terms: usize,
    /// A bound of the distance from the line, in units.
    pub rest: Integer,
}

impl Along {
    /// Of a series in one variable.
    fn of_series(s: &Series, rest: Integer) -> Option<Along> {
        let (first, others) = s.coefficients().split_first()?;
        let slope = others.first().cloned().unwrap_or_else(|| Ball::zero(first.bits()));
        let is_line = others.iter().skip(1).all(Ball::is_zero);
        let (variable, terms) = ((!slope.is_zero()).then_some(0), s.terms());
        is_line.then(|| Along { first: first.clone(), variable, slope, terms, rest })
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
    /// One coefficient after the other: where all lower ones are known, the value's coefficient is what the slope times the next one is to cancel.
    fn exponential_of(n: usize, matrix: &[Series]) -> Option<Vec<Series>> {
        if matrix.iter().any(|s| s.terms() > 1) {
            return exponential_of(n, matrix);
        }
        let m = BallMatrix::from_fn(n, |i, j| matrix[i * n + j].coefficients()[0].clone());
        let e = m.is_of_use().then(|| exponential(&m))?;
        Some((0..n * n).map(|k| Series::constant(e.at(k / n, k % n), 1)).collect())
    }
    fn line(&self) -> Option<Along> {
        Along::of_series(self, Integer::ZERO)
    }
    fn of_powers(&self, _variable: Option<usize>, coefficients: &[Ball]) -> Series {
        let zero = Ball::zero(self.coefficients()[0].bits());
        Series::new((0..self.terms()).map(|k| coefficients.get(k).unwrap_or(&zero).clone()).collect())
    }
    fn implicit(&self, start: &Ball, f: &dyn Fn(&Series) -> Option<[Series; 2]>) -> Option<Series> {
        let mut known = Series::constant(start, self.terms());
        for k in 1..self.terms() {
            let [value, slope] = f(&known)?;
            let next = value.coefficients()[k].div(&slope.coefficients()[0])?;
            let with = |(i, c): (usize, &Ball)| if i == k { c.sub(&next) } else { c.clone() };
            known = Series::new(known.coefficients().iter().enumerate().map(with).collect());
        }
        Some(known)
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
    fn exponential_of(n: usize, matrix: &[TaylorModel]) -> Option<Vec<TaylorModel>> {
        exponential_of(n, matrix)
    }
    fn line(&self) -> Option<Along> {
        Along::of_series(self.polynomial(), self.rest_units().clone())
    }
    fn of_powers(&self, variable: Option<usize>, coefficients: &[Ball]) -> TaylorModel {
        let terms = self.polynomial().terms();
        let beyond = coefficients.iter().skip(terms).fold(Integer::ZERO, |sum, c| sum + c.magnitude_units());
        TaylorModel::with(self.polynomial().of_powers(variable, coefficients), beyond)
    }
    fn implicit(&self, start: &Ball, f: &dyn Fn(&TaylorModel) -> Option<[TaylorModel; 2]>) -> Option<TaylorModel> {
        implicit(self, start, self.polynomial().terms(), f)
    }
}
