//! What is to be best: a rational function of the gains, or a level.

use crate::bernstein::Tensor;
use crate::boxes::Ground;
use crate::clock::Clock;
use crate::for_all::{Requirement, short};
use crate::format::Json;
use crate::multivariate::Multi;
use crate::number::{Q, Z, integer};
use crate::over_box::FIRST;
use crate::statement::{Extent, count, fixed_extent, list, number, object, text};
use num_traits::{One, Signed, Zero};

/// Functions of a greater degree, with more terms or with longer numbers are refused.
const MAX_DEGREE: usize = 32;
const MAX_TERMS: usize = 1000;
const MAX_BITS: u64 = 1 << 15;

/// What is to be best.
pub(super) enum Objective {
    None,
    /// No gains of the box that are good have this value, or a better one.
    Formula {
        formula: Formula,
        is_greatest: bool,
        proved: Q,
    },
    /// No gains that are good have this level.
    Level(Level),
}

impl Objective {
    pub fn read(json: &Json, gains: usize, discrete: bool) -> Result<Self, String> {
        if *json == Json::Null {
            return Ok(Objective::None);
        }
        if json.get("level").is_some() {
            let [level] = object(json, "'objective'", ["level"], &[])?;
            return Ok(Objective::Level(Level::read(level, discrete)?));
        }
        let is_greatest = json.get("greatest").is_some();
        let keys = [if is_greatest { "greatest" } else { "least" }, "proved"];
        let [formula, proved] = object(json, "'objective'", keys, &[])?;
        let proved = short(number(proved, "'proved'")?)?;
        Ok(Objective::Formula { formula: Formula::read(formula, gains)?, is_greatest, proved })
    }

    /// Whether all values over a cell are shown to be worse than the value of which there is none, and defined.
    pub fn is_worse(&self, cell: &[[Q; 2]], clock: &Clock) -> Result<bool, String> {
        let Objective::Formula { formula, is_greatest, proved } = self else { return Ok(false) };
        let [above, below] = [&formula.above, &formula.below].map(Polynomial::multi);
        let difference = above.scaled(proved.denom()).minus(&below.scaled(proved.numer()));
        let sign = |p: &Multi| -> Result<Option<bool>, String> {
            let of = Tensor::of_one(p, cell, &Ground::integers(cell.len()), clock)?;
            Ok([true, false].into_iter().find(|positive| of.has_sign(*positive)))
        };
        let Some(is_positive) = sign(&below)? else { return Ok(false) };
        Ok(sign(&difference)? == Some(is_positive != *is_greatest))
    }
}

/// A quotient of two polynomials of the gains.
pub(super) struct Formula {
    pub above: Polynomial,
    pub below: Polynomial,
}

/// Coefficients and exponents of the gains, terms of the highest degree first.
pub(super) struct Polynomial(pub Vec<(Z, Vec<usize>)>);

impl Polynomial {
    fn read(json: &Json, gains: usize) -> Result<Self, String> {
        let mut terms: Vec<(Z, Vec<usize>)> = Vec::new();
        for term in list(json, "a polynomial")? {
            let [c, exponents @ ..] = list(term, "a term")? else { return Err("a term is empty".into()) };
            let c = integer(text(c, "a coefficient")?)?;
            let mut exponents = exponents.iter().map(|e| count(e, "an exponent")).collect::<Result<Vec<_>, _>>()?;
            if c.is_zero() || exponents.last() == Some(&0) || exponents.len() > gains {
                return Err("a term is not in its shortest form".into());
            }
            exponents.resize(gains, 0);
            if exponents.iter().any(|e| *e > MAX_DEGREE)
                || exponents.iter().sum::<usize>() > MAX_DEGREE
                || c.bits() > MAX_BITS
            {
                return Err("a polynomial has too high a degree, or too long numbers".into());
            }
            terms.push((c, exponents));
        }
        terms.sort_by(|(_, a), (_, b)| (b.iter().sum::<usize>(), b).cmp(&(a.iter().sum::<usize>(), a)));
        if terms.windows(2).any(|two| two[0].1 == two[1].1) {
            return Err("a polynomial has a term twice".into());
        }
        if terms.is_empty() || terms.len() > MAX_TERMS {
            return Err("a polynomial is zero, or has too many terms".into());
        }
        Ok(Polynomial(terms))
    }

    fn multi(&self) -> Multi {
        let mut out = Multi::default();
        for (c, exponents) in &self.0 {
            let of = std::iter::repeat_n(0, FIRST).chain(exponents.iter().map(|e| *e as u32)).collect();
            out.add(of, c.clone());
        }
        out
    }

    fn at(&self, point: &[Q]) -> Q {
        let power = |(x, k): (&Q, &usize)| num_traits::pow(x.clone(), *k);
        let term = |(c, exponents): &(Z, Vec<usize>)| {
            point.iter().zip(exponents).map(power).fold(Q::from(c.clone()), |product, x| product * x)
        };
        self.0.iter().map(term).fold(Q::zero(), |sum, x| sum + x)
    }

    pub fn is_one(&self) -> bool {
        matches!(self.0.as_slice(), [(c, exponents)] if c.is_one() && exponents.iter().all(Zero::is_zero))
    }
}

impl Formula {
    fn read(json: &Json, gains: usize) -> Result<Self, String> {
        let [above, below] = object(json, "what is to be best", ["above", "below"], &[])?;
        Ok(Formula { above: Polynomial::read(above, gains)?, below: Polynomial::read(below, gains)? })
    }

    /// The number of the gain that it is, if it is one.
    pub fn gain(&self) -> Option<usize> {
        match self.above.0.as_slice() {
            [(c, exponents)] if c.is_one() && self.below.is_one() && exponents.iter().sum::<usize>() == 1 => {
                exponents.iter().position(|e| *e == 1)
            }
            _ => None,
        }
    }

    /// Its value, if there is one.
    pub fn at(&self, point: &[Q]) -> Option<Q> {
        let below = self.below.at(point);
        if below.is_zero() { None } else { Some(self.above.at(point) / below) }
    }
}

/// A number of the loop.
#[derive(Clone)]
pub(super) enum Level {
    /// A decay rate or a radius.
    Region(Q),
    Requirement(Box<Requirement>),
}

impl Level {
    pub fn read(json: &Json, discrete: bool) -> Result<Self, String> {
        if json.get("kind").is_some() {
            return Ok(Level::Requirement(Box::new(Requirement::read(json, discrete)?)));
        }
        let Extent::Number(bound) = fixed_extent(json, discrete)? else { return Err("a level is a number".into()) };
        let bound = short(bound)?;
        // Otherwise it is none beside stability.
        if if discrete { bound < Q::one() } else { bound.is_positive() } {
            Ok(Level::Region(bound))
        } else {
            Err("a level is no more than stability".into())
        }
    }

    /// Whether both are of the same kind, and this one asks for more.
    pub fn is_better_than(&self, other: &Level, discrete: bool) -> bool {
        match (self, other) {
            (Level::Region(a), Level::Region(b)) => a != b && is_within(a, b, discrete),
            (Level::Requirement(a), Level::Requirement(b)) => a.asks_for_more_than(b),
            _ => false,
        }
    }
}

/// Whether a region is inside of another one.
pub(super) fn is_within(inner: &Q, outer: &Q, discrete: bool) -> bool {
    if discrete { inner <= outer } else { inner >= outer }
}
