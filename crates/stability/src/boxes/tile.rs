//! Taylor models of functions over a box, which serve for its parts as long as what they leave out is small there.

use super::moving::MovingPolynomial;
use super::parts::{coordinates, model_degree};
use crate::subdivision::{BoxPart, Halves, Octaves};
use jurist_algebra::ball::{Ball, Elementary, MultiTaylorModel};
use jurist_algebra::number::{Integer, Rational};
use std::sync::Arc;

/// Bits after the point of coefficients in a part of the box.
pub(super) const BITS: u64 = 192;

/// Taylor models have about so many coefficients.
const MODEL_TERMS: usize = 130;

/// The greatest degree of a Taylor model.
const MODEL_DEGREE: usize = 12;

/// The same where each value is that of a matrix: a third of the terms takes a tenth of the time, and leaves out little that matters.
const OF_MATRICES: (usize, usize) = (36, 8);

/// Models of a box serve for a part where they leave out less than this share of the function there, in bits.
const FINE_BITS: u64 = 24;

/// What is left out by rounding is as little, in bits after the point.
const ROUNDED_BITS: u64 = 144;

/// Models of all functions, each by its parts.
pub(super) type Models = Vec<Vec<MultiTaylorModel>>;

/// Models that were made for a box.
#[derive(Debug)]
struct Tile {
    /// The sides of what is inside of functions.
    sides: Vec<[Rational; 2]>,
    models: Models,
}

/// Models over a part of a box.
#[derive(Clone, Debug)]
pub(super) struct OverPart {
    tile: Arc<Tile>,
    /// Those over the part, where it is not the whole box.
    own: Option<Arc<Models>>,
}

impl OverPart {
    /// The models over the part.
    pub fn models(&self) -> &Models {
        self.own.as_ref().map_or(&self.tile.models, |own| own)
    }
}

impl MovingPolynomial {
    /// The parts of all functions over sides of what is inside of functions: other sides do not change them. Those over a box around serve, where
    /// they are fine enough.
    pub(super) fn models(&self, sides: &[[Rational; 2]], around: Option<&OverPart>) -> Option<OverPart> {
        let wanted: Vec<[Rational; 2]> = self.inside.iter().map(|&i| sides[i].clone()).collect();
        if let Some(found) = around.and_then(|around| around.tile.over(&wanted)) {
            return Some(found);
        }
        let (most, highest) = if self.is_of_matrices { OF_MATRICES } else { (MODEL_TERMS, MODEL_DEGREE) };
        let degree = model_degree(self.inside.len(), 2..=highest, most);
        let moving = coordinates(sides, &self.inside, BITS, degree);
        // What is not inside of functions is not looked at here.
        let mut parameters = vec![moving[0].integer(&Integer::ZERO); sides.len()];
        for (&i, model) in self.inside.iter().zip(moving) {
            parameters[i] = model;
        }
        let models = self.parts_at(&parameters)?;
        Some(OverPart { tile: Arc::new(Tile { sides: wanted, models }), own: None })
    }
}

impl Tile {
    /// The models over a part; `None` where they are not fine enough, or it is no part.
    fn over(self: &Arc<Self>, part: &[[Rational; 2]]) -> Option<OverPart> {
        if self.sides == part {
            return Some(OverPart { tile: Arc::clone(self), own: None });
        }
        let like = self.models.iter().flatten().next()?;
        let line = |([from, to], [low, high]): (&[Rational; 2], &[Rational; 2])| {
            let half = &(to - from) * &Rational::new(Integer::ONE, 2.into());
            let place = |x: &Rational| (x - &from.midpoint(to)).checked_div(&half);
            let (low, high) = if half.is_zero() && low == from && high == to {
                (Rational::ZERO, Rational::ZERO)
            } else {
                (place(low)?, place(high)?)
            };
            let is_inside = low >= -Rational::ONE && high <= Rational::ONE;
            let middle = low.midpoint(&high);
            let ball = |x: &Rational| Ball::from_rational(x, BITS);
            is_inside.then(|| (ball(&middle), ball(&(&high - &middle))))
        };
        let lines = self.sides.iter().zip(part).map(line).collect::<Option<Vec<_>>>()?;
        let lines = like.lines(&lines);
        let on_part = |f: &Vec<MultiTaylorModel>| {
            let parts: Vec<MultiTaylorModel> = f.iter().map(|model| model.on_part(&lines)).collect();
            parts.iter().all(is_fine).then_some(parts)
        };
        let own = self.models.iter().map(on_part).collect::<Option<Models>>()?;
        Some(OverPart { tile: Arc::clone(self), own: Some(Arc::new(own)) })
    }
}

/// Whether a model leaves out little.
fn is_fine(model: &MultiTaylorModel) -> bool {
    let largest = model.terms().map(|(_, c)| c.abs()).max().unwrap_or(Integer::ZERO);
    let rest = model.rest_units();
    rest.bit_length() + ROUNDED_BITS <= BITS || &(rest << FINE_BITS) <= &largest
}

/// A part of a box with the models over the box that it comes from.
pub(super) struct Tiled {
    pub part: Octaves,
    pub around: Option<OverPart>,
}

impl Tiled {
    /// A whole box.
    pub fn whole(sides: &[[Rational; 2]]) -> Tiled {
        Tiled { part: Octaves(BoxPart::whole(sides)), around: None }
    }
}

impl Halves for Tiled {
    fn halves(self, axis: usize) -> [Tiled; 2] {
        let around = self.around;
        self.part.halves(axis).map(|part| Tiled { part, around: around.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_have_the_degree_that_the_number_of_variables_allows() {
        let degree = |variables| model_degree(variables, 2..=MODEL_DEGREE, MODEL_TERMS);
        assert_eq!([1, 2, 3, 4, 5, 6, 9, 30].map(degree), [12, 12, 7, 5, 4, 3, 2, 2]);
        let (most, highest) = OF_MATRICES;
        assert_eq!([1, 2, 3, 4].map(|n| model_degree(n, 2..=highest, most)), [8, 7, 4, 3]);
    }
}
