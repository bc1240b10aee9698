//! Whether requirements on margins are met for all values of a parameter in an interval at once.

use super::affine::Affine;
use super::along_circle::{Coefficient, NearlyLinear};
use super::family::Quotient;
use super::loop_functions::LoopFunctions;
use super::requirement::Rule;
use crate::stability::Shape;
use crate::stability::subdivision::{BoxPart, Look, Octaves, Order, Tally, subdivide};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::symbols::MovingSymbols;

/// Terms of the Taylor polynomials in the parameter.
const TERMS: usize = 3;

/// Bits, beside those that the interval's width takes away.
const BITS: u64 = 256;

/// One requirement on an open loop over a parameter and symbols.
pub(super) struct OverBoxes {
    symbols: MovingSymbols,
    functions: LoopFunctions,
}

impl OverBoxes {
    /// `None` in continuous time, and for a requirement of another kind. `symbols` has the number that is asked for as the last one.
    pub fn new(
        quotient: &Quotient<MultiPoly>,
        undefined: &MultiPoly,
        asked: &Rule,
        symbols: MovingSymbols,
    ) -> Option<OverBoxes> {
        let is_known = matches!(asked, Rule::Turned { .. } | Rule::Factors(_) | Rule::Circle(_));
        if quotient.shape != Shape::UnitDisc || !is_known {
            return None;
        }
        let functions = LoopFunctions::new((quotient, None), undefined, asked, MultiPoly::variable(symbols.len()));
        Some(OverBoxes { symbols, functions })
    }

    /// Whether the requirement is met by all stable loops of a closed interval of the parameter, or by none; `None` where that is not
    /// seen.
    ///
    /// Cost: Taylor polynomials of the coefficients, and values on some hundred pieces of the circle.
    pub fn certain(&self, lower: &Rational, upper: &Rational) -> Option<bool> {
        let width = upper - lower;
        let small = width.denominator().bit_length().saturating_sub(width.numerator().bit_length());
        let bits = BITS + small.min(1 << 12);
        let taylor: Vec<Share> = if width.is_zero() {
            let balls = self.symbols.enclose(&self.functions.all, &Ball::from_rational(lower, bits))?;
            balls.into_iter().map(|c| Share(vec![c])).collect()
        } else {
            let taylor = self.symbols.taylor_from_end(&self.functions.all, lower, upper, TERMS, bits)?;
            taylor.into_iter().map(Share).collect()
        };
        self.functions.asked(&taylor, |both| both.map(<[Share]>::to_vec))?.certain()
    }
}

/// A part of the interval is not halved more often.
const MOST_HALVINGS: u32 = 48;

/// Values between two numbers, and whether all requirements are met by all of them, or not all by any; `None` where that is not seen.
pub(super) type Segment = (Rational, Rational, Option<bool>);

/// The whole interval as segments, ascending; neighbours differ in what is known. So many parts of it are looked at.
pub(super) fn segments(
    boxes: &[OverBoxes],
    lower: &Rational,
    upper: &Rational,
    most: usize,
    budget: &Budget,
) -> Result<Vec<Segment>, Exhausted> {
    budget.step("requirements for intervals of the parameter");
    let mut all: Vec<Segment> = Vec::new();
    let look = |Octaves(part): &mut Octaves, tally: Tally| {
        budget.advance(tally.looks() as u64, most as u64);
        let [lo, hi] = &part.sides[0];
        let is_last = tally.looks() >= most || part.halvings[0] >= MOST_HALVINGS;
        let found = if is_last { None } else { budget.enter(|| certain(boxes, lo, hi))? };
        if found.is_none() && !is_last {
            return Ok(Look::<(), ()>::Cut(0));
        }
        all.push((lo.clone(), hi.clone(), found));
        Ok(Look::Decided(()))
    };
    let whole = Octaves(BoxPart::whole([[lower.clone(), upper.clone()]]));
    subdivide([whole], Order::Breadth, budget, look)?.ok();
    all.sort_by(|a, b| a.0.cmp(&b.0));
    let mut out: Vec<Segment> = Vec::new();
    for (lo, hi, is_met) in all {
        match out.last_mut().filter(|last| last.2 == is_met) {
            Some(last) => last.1 = hi,
            None => out.push((lo, hi, is_met)),
        }
    }
    Ok(out)
}

/// Whether all requirements are met by all values of a closed interval, or not all by any.
pub(super) fn certain(boxes: &[OverBoxes], lower: &Rational, upper: &Rational) -> Option<bool> {
    let mut all = !boxes.is_empty();
    for of in boxes {
        match of.certain(lower, upper) {
            Some(false) => return Some(false),
            Some(true) => {}
            None => all = false,
        }
    }
    all.then_some(true)
}

/// A function of the share `u` of an interval, from 0 to 1: a polynomial, whose last coefficient holds what is left out.
#[derive(Clone)]
struct Share(Vec<Ball>);

impl Coefficient for Share {
    fn plus(&self, other: &Share) -> Share {
        Share(self.0.iter().zip(&other.0).map(|(x, y)| x.add(y)).collect())
    }

    fn scaled(&self, n: &Integer) -> Share {
        Share(self.0.iter().map(|c| c.scaled(n)).collect())
    }

    /// Higher powers of the share are numbers from 0 to 1 times the last one.
    fn times(&self, other: &Share) -> Share {
        let last = self.0.len() - 1;
        let bits = self.0[0].bits();
        let less = Ball::between(&Rational::ZERO, &Rational::ONE, bits);
        let mut out = vec![Ball::zero(bits); last + 1];
        for (i, x) in self.0.iter().enumerate() {
            for (j, y) in other.0.iter().enumerate() {
                let product = x.mul(y);
                let product = if i + j > last { product.mul(&less) } else { product };
                let k = (i + j).min(last);
                out[k] = out[k].add(&product);
            }
        }
        Share(out)
    }

    fn is_zero(&self) -> bool {
        self.0.iter().all(|c| c.sign().is_some_and(Sign::is_eq))
    }
}

impl NearlyLinear for Share {
    /// With the share as `(1 + x)/2`.
    fn affine(&self) -> Affine {
        let bits = self.0[0].bits();
        let mut affine = Affine { middle: Integer::ZERO, slopes: vec![Integer::ZERO], rest: Integer::ZERO, bits };
        for (k, c) in self.0.iter().enumerate() {
            let half = |n: Integer| n >> 1;
            let (middle, size) = (c.middle_units(), c.magnitude_units());
            affine.rest += &(half(c.width_units()) + Integer::ONE);
            match k {
                0 => affine.middle += &middle,
                1 => {
                    affine.middle += &half(middle.clone());
                    affine.slopes[0] += &half(middle);
                    affine.rest += &Integer::from(2);
                }
                // u^2 = 3/8 + x/2 + (2 x^2 - 1)/8
                2 => {
                    affine.middle += &(&(&middle * &Integer::from(3)) >> 3);
                    affine.slopes[0] += &half(middle);
                    affine.rest += &((size >> 3) + Integer::from(3));
                }
                _ => affine.rest += &size,
            }
        }
        affine
    }
}
