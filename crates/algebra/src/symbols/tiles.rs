//! Taylor models of the values of a family of matrices over boxes of a grid, from which those over parts of these boxes follow.
//!
//! Which box of the grid serves for a part depends on the part alone, and not on what was asked before.

use super::family::MatrixFamily;
use crate::ball::{Ball, MultiTaylorModel, Series};
use crate::number::{Integer, Rational};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Models have at most so many coefficients, and this degree at most. With 60 and steps of one octave the largest factor of two tolerances of a plant of order 8
/// took ten times as long.
const TERMS: usize = 100;
const DEGREE: usize = 16;

/// Boxes of the grid are tried from those of half the size of the values down, each so many octaves shorter.
const STEP: i64 = 2;
const STEPS: i64 = 12;

/// Models over a box serve for a part where they leave out less than this share of the function there, in bits: with a thousandth of what the function
/// varies in a part, factors of tolerances were not found to six digits.
const FINE_BITS: u64 = 20;

/// The same as a share of the greatest of all functions: some are zero.
const SMALL_BITS: u64 = 36;

/// What is left beyond a line on a side of the grid, as a share of half the side, in bits.
const MARGIN_BITS: u64 = 6;

/// Bits after the point of models come in multiples of this number.
const BITS: u64 = 128;

/// No more boxes are kept.
const MOST: usize = 256;

/// A side of a box of the grid from `number 2^octave` to `(number + 2) 2^octave`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Side {
    number: Integer,
    octave: i64,
}

/// Sides, and bits after the point.
type Key = (Vec<Side>, u64);

/// What was found over boxes of the grid; `None` where something may not be defined.
#[derive(Debug, Default)]
pub(super) struct Tiles {
    models: Mutex<HashMap<Key, Found<MultiTaylorModel>>>,
    /// Of a family without parameters, by bits after the point.
    numbers: Mutex<HashMap<u64, Found<Ball>>>,
}

type Found<S> = Option<Arc<Vec<S>>>;

impl Clone for Tiles {
    fn clone(&self) -> Self {
        Tiles::default()
    }
}

impl Tiles {
    /// All values where the parameters are these lines; `None` where they are no lines, are numbers, or a box that is much larger leaves out too much.
    pub fn values(&self, family: &MatrixFamily, parameters: &[MultiTaylorModel]) -> Option<Vec<MultiTaylorModel>> {
        let lines = parameters.iter().map(MultiTaylorModel::as_line).collect::<Option<Vec<_>>>()?;
        let bits = parameters.first()?.value_bits();
        let least = Rational::dyadic(&Integer::ONE, bits / 2);
        if lines.iter().all(|(_, around)| *around < least) {
            return None;
        }
        for step in 0..STEPS {
            let key = lines.iter().map(|line| side_of(line, step)).collect::<Option<Vec<Side>>>()?;
            let tile = self.tile(family, (key.clone(), bits.next_multiple_of(BITS)));
            if let Some(found) = tile.and_then(|tile| on_part(&tile, &key, parameters, bits)) {
                return Some(found);
            }
        }
        None
    }

    /// All values of a family without parameters.
    pub fn numbers(&self, family: &MatrixFamily, bits: u64) -> Option<Arc<Vec<Ball>>> {
        let known = || self.numbers.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&bits) {
            return found.clone();
        }
        let values = family.values(&[], &Series::constant(&Ball::zero(bits), 1));
        let found = values.map(|all| Arc::new(all.iter().map(|value| value.coefficients()[0].clone()).collect()));
        known().insert(bits, found.clone());
        found
    }

    fn tile(&self, family: &MatrixFamily, key: Key) -> Option<Arc<Vec<MultiTaylorModel>>> {
        let known = || self.models.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&key) {
            return found.clone();
        }
        let (sides, bits) = &key;
        let line = |side: &Side| {
            let ball = |x: &Rational| Ball::from_rational(x, *bits);
            (ball(&side.middle()), ball(&unit(side.octave)))
        };
        let terms = |degree: usize| (1..=sides.len()).fold(1, |n, i| n * (degree + i) / i);
        let degree = (1..=DEGREE).rev().find(|&degree| terms(degree) <= TERMS).unwrap_or(1);
        let models = MultiTaylorModel::linear(&sides.iter().map(line).collect::<Vec<_>>(), degree);
        let found = models.first().and_then(|like| family.values(&models, like)).map(Arc::new);
        let mut known = known();
        if known.len() >= MOST {
            known.clear();
        }
        known.insert(key, found.clone());
        found
    }
}

impl Side {
    fn middle(&self) -> Rational {
        &Rational::from(&self.number + &Integer::ONE) * &unit(self.octave)
    }
}

/// A power of two.
fn unit(octave: i64) -> Rational {
    Rational::from(2).pow(octave).unwrap_or(Rational::ONE)
}

/// The side of the grid around a line; `None` where that is not much longer.
fn side_of((middle, around): &(Rational, Rational), step: i64) -> Option<Side> {
    let size = middle.abs() + around;
    let exponent = |x: &Rational| x.numerator().bit_length() as i64 - x.denominator().bit_length() as i64;
    let octave = if size.is_zero() { 0 } else { exponent(&size) - 1 } - STEP * step;
    // A side of a unit fits into two of the grid's; rounding is to stay inside.
    let units = |x: &Rational| x * &unit(-octave);
    let margin = Rational::dyadic(&Integer::ONE, MARGIN_BITS);
    if units(&(around + around)) > Rational::ONE - &(&margin + &margin) {
        return None;
    }
    let number = (units(&(middle - around)) - margin).floor();
    Some(Side { number, octave })
}

/// The values over a part of a box; `None` where they are not fine enough.
fn on_part(
    tile: &[MultiTaylorModel],
    key: &[Side],
    parameters: &[MultiTaylorModel],
    bits: u64,
) -> Option<Vec<MultiTaylorModel>> {
    let working = bits.next_multiple_of(BITS);
    let line = |(side, own): (&Side, &MultiTaylorModel)| {
        let moved = own.with_bits(working).less(&Ball::from_rational(&side.middle(), working));
        moved.shifted(-side.octave)
    };
    let lines: Vec<MultiTaylorModel> = key.iter().zip(parameters).map(line).collect();
    let found: Vec<MultiTaylorModel> = tile.iter().map(|model| model.along(&lines)).collect();
    let largest = |model: &MultiTaylorModel| model.terms().map(|(_, c)| c.abs()).max().unwrap_or(Integer::ZERO);
    let least = found.iter().map(largest).max().unwrap_or(Integer::ZERO) >> SMALL_BITS;
    let is_fine = |model: &MultiTaylorModel| {
        let rest = model.rest_units();
        *rest <= least || rest << FINE_BITS <= largest(model)
    };
    found.iter().all(is_fine).then(|| found.iter().map(|model| model.with_bits(bits)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_of_the_grid_hold_the_lines_they_are_chosen_for() {
        let number = |text: &str| text.parse::<Rational>().unwrap();
        for (middle, around) in [("3", "1/10"), ("-7/3", "1/100"), ("0", "1/1000"), ("5", "1/7"), ("1/3", "0")] {
            let line = (number(middle), number(around));
            let mut lengths = Vec::new();
            for side in (0..STEPS).map_while(|step| side_of(&line, step)) {
                let (middle, half) = (side.middle(), unit(side.octave));
                let most = &half * &number("63/64");
                assert!(&middle - &most <= &line.0 - &line.1 && &line.0 + &line.1 <= &middle + &most);
                lengths.push(half);
            }
            assert!(lengths.windows(2).all(|pair| pair[0] == &pair[1] * &Rational::from(4)));
            assert_eq!(lengths.is_empty(), line.0.is_zero(), "{middle} {around}");
        }
    }
}
