//! Stable sets on lines through the plane, and points of them and beside them.

use super::loops::Loop;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::stability::{Range, StableSet};

/// A line through the plane, by one coordinate along it.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    /// `x` is a number, and `y` the coordinate.
    Vertical(Rational),
    /// `y` is a number, and `x` the coordinate.
    Horizontal(Rational),
    /// `y = slope x + offset`, and `x` the coordinate.
    Slanted(Rational, Rational),
}

impl Line {
    pub fn point(&self, t: &Rational) -> [Rational; 2] {
        match self {
            Line::Vertical(x) => [x.clone(), t.clone()],
            Line::Horizontal(y) => [t.clone(), y.clone()],
            Line::Slanted(slope, offset) => [t.clone(), &(slope * t) + offset],
        }
    }

    /// Where two lines meet, by the coordinates along either; `None` for parallel ones.
    pub fn meeting(&self, other: &Line) -> Option<[Rational; 2]> {
        match (self, other) {
            (Line::Vertical(x), Line::Horizontal(y)) => Some([y.clone(), x.clone()]),
            (Line::Horizontal(y), Line::Vertical(x)) => Some([x.clone(), y.clone()]),
            (Line::Slanted(slope, offset), Line::Vertical(x)) => Some([x.clone(), &(slope * x) + offset]),
            (Line::Vertical(x), Line::Slanted(slope, offset)) => Some([&(slope * x) + offset, x.clone()]),
            (Line::Slanted(slope, offset), Line::Horizontal(y)) => {
                let x = (y - offset).checked_div(slope)?;
                Some([x.clone(), x])
            }
            (Line::Horizontal(_), Line::Slanted(..)) => other.meeting(self).map(|[a, b]| [b, a]),
            _ => None,
        }
    }

    /// The stable set on the line, within the domain of the coordinate.
    pub fn stable_set(
        &self,
        of: &Loop,
        plane: &Model,
        domain: &[Range; 2],
        budget: &Budget,
    ) -> Result<StableSet, Error> {
        let question = match self {
            Line::Vertical(x) => plane.ask().set("x", x.clone()).free("y").domain("y", domain[1].clone()),
            Line::Horizontal(y) => plane.ask().set("y", y.clone()).free("x").domain("x", domain[0].clone()),
            Line::Slanted(slope, offset) => match of.along(slope, offset) {
                Some(model) => model.ask().free("x").domain("x", domain[0].clone()),
                None => return Ok(StableSet::default()),
            },
        };
        Ok(question.stable_set(budget)?.into_value())
    }
}

/// Numbers strictly between two others, close to either end and in the middle.
pub fn between(lower: Option<&Real>, upper: Option<&Real>) -> Vec<Rational> {
    let mut width = Rational::dyadic(&Integer::ONE, 20);
    loop {
        let low = lower.map(|x| x.refined(&width).enclosure().1);
        let high = upper.map(|x| x.refined(&width).enclosure().0);
        let (low, high) = match (low, high) {
            (None, None) => (Rational::from(-9), Rational::from(10)),
            (Some(low), None) => (low.clone(), &low + &Rational::from(7)),
            (None, Some(high)) => (&high - &Rational::from(7), high),
            (Some(low), Some(high)) => (low, high),
        };
        let gap = &high - &low;
        if gap > width {
            let at = |share: i64| &low + &(&gap * &Rational::new(share.into(), 1021.into()));
            return vec![at(1), at(523), at(1020)];
        }
        width *= &Rational::dyadic(&Integer::ONE, 20);
    }
}
