//! What the coefficients of the boundary curves are: integers, or polynomials in transcendental constants.

use super::curves::{Curve, PlanePolynomial};
use super::glue::{Links, Wall};
use crate::{AtPoint, End, Range, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational, Sign};
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::real::Real;
use std::fmt;

/// A polynomial in `x` whose real zeros cut the domain into strips, before it is computed. Curves are given by their numbers.
#[derive(Clone, Copy, Debug)]
pub enum Projected<'a> {
    /// The coefficient of the highest power of `y`.
    Leading(usize),
    /// The curve on an edge of the domain of `y`.
    AtEdge(usize, &'a Rational),
    /// The discriminant in `y`, times the leading coefficient.
    Discriminant(usize),
    /// The resultant of two curves in `y`.
    Resultant(usize, usize),
}

/// The walls of a cell on a vertical line.
pub struct Beside<'a> {
    /// The walls below and above that are curves.
    pub walls: [Option<&'a Real>; 2],
    /// Whether nothing but a complex pair can be on the boundary there.
    pub only_pair: [bool; 2],
    /// A point of the cell.
    pub inside: Rational,
    /// Points of the cells below and above, where those are stable too.
    pub beyond: [Option<Rational>; 2],
}

/// The point of a wall that a curve ends in, as a wall between numbers on either side and an interval of heights.
pub struct Corner<'a> {
    pub wall: &'a Real,
    /// Numbers on either side of the wall, between which no other wall is; one is the wall itself at the end of the domain.
    pub sides: [Rational; 2],
    pub heights: [&'a Rational; 2],
    /// The height where that is an edge of the domain.
    pub edge: Option<&'a Rational>,
}

/// What is asked of coefficients. `x` and `y` are the variables 0 and 1 of all polynomials, constants those from 2 on.
pub trait Ground: fmt::Debug + Send + Sync {
    /// Whether a polynomial is zero for all values of both parameters.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where the sign of a constant is not found; so for all that follow.
    fn vanishes(&self, f: &MultiPoly, budget: &Budget) -> Result<bool, Exhausted>;

    /// Factors of a polynomial that does not vanish: those in which one parameter alone occurs, and what is left. Numbers are left out.
    fn separated(&self, f: &MultiPoly, budget: &Budget) -> Result<Vec<MultiPoly>, Exhausted>;

    /// The sign of a polynomial in which no parameter occurs.
    fn sign(&self, f: &MultiPoly, budget: &Budget) -> Result<Sign, Exhausted>;

    /// The real zeros strictly between two numbers of a polynomial in one parameter, ascending, each once; `None` where it is zero
    /// for every value.
    fn zeros(
        &self,
        f: &MultiPoly,
        parameter: usize,
        between: [Option<&Rational>; 2],
        budget: &Budget,
    ) -> Result<Option<Vec<Real>>, Exhausted>;

    /// The zeros of all these polynomials in a range of `x`, ascending, each once.
    fn critical_values(
        &self,
        p: &PlanePolynomial,
        curves: &[Curve],
        wanted: &[Projected<'_>],
        within: (&Range, Shape),
        budget: &Budget,
    ) -> Result<Vec<Real>, Exhausted>;

    /// The exact root counts on a vertical line at some heights.
    fn counts(
        &self,
        p: &PlanePolynomial,
        x: &Rational,
        heights: &[Rational],
        region: Shape,
        budget: &Budget,
    ) -> Result<Vec<AtPoint>, Exhausted>;

    /// Whether a curve does not meet a horizontal segment.
    fn is_clear(&self, f: &MultiPoly, x: [&Rational; 2], y: &Rational, budget: &Budget) -> Result<bool, Exhausted>;

    /// All pairs of a cell on the left and a cell on the right of a wall that touch along a piece of it, beyond those that clear
    /// segments showed; the given ones are not known.
    fn links(&self, wall: &Wall<'_>, pairs: &[(usize, usize)], budget: &Budget) -> Result<Links, Exhausted>;

    /// What happens on the walls of a stable cell on a vertical line.
    fn ends(
        &self,
        p: &PlanePolynomial,
        x: &Rational,
        beside: &Beside<'_>,
        within: (&Range, Shape),
        budget: &Budget,
    ) -> Result<Vec<End>, Exhausted>;

    /// Whether it is seen that the second of two curves passes through the point that the first one ends in. The numbers of both are
    /// given.
    fn passes(
        &self,
        curves: &[Curve],
        pair: [usize; 2],
        corner: &Corner<'_>,
        budget: &Budget,
    ) -> Result<bool, Exhausted>;

    /// All values of a polynomial on a box.
    fn enclose(&self, f: &MultiPoly, x: &Enclosure, y: &Enclosure, bits: u64) -> Enclosure;

    /// The polynomial with integer coefficients: as it is, or times `2^bits` and rounded.
    fn rounded(&self, f: &MultiPoly, bits: u64) -> MultiPoly;
}

/// The polynomial with a value in the place of a parameter, times a positive integer.
pub fn put(f: &MultiPoly, parameter: usize, value: &Rational) -> MultiPoly {
    f.substitute(parameter, value).0
}
