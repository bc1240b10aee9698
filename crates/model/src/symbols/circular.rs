//! Sines, cosines and tangents: by the tangent of half the angle, and exactly at multiples of the circle number.

use super::{Definition, Symbols};
use crate::text::Function;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};

impl Symbols {
    /// A function of the symbols with `sin^2 = 1 - cos^2` put in, of angles that depend on kept names; `None` where it divides by zero then.
    pub(crate) fn on_circle(&self, f: &RationalFunction) -> Option<RationalFunction> {
        let circle = [1.into(), RationalFunction::zero(), 1.into()];
        let of = |wanted: usize, t: Option<&RationalFunction>| {
            let is_it = |(i, symbol): (usize, &super::Symbol)| match symbol.definition()? {
                Definition::Fundamental { polynomial, time, index } => {
                    let is_it = *polynomial == circle && *index == wanted && t.is_none_or(|t| t == time);
                    is_it.then(|| (self.first() + i, time.clone()))
                }
                _ => None,
            };
            self.table.iter().enumerate().filter_map(is_it).collect::<Vec<_>>()
        };
        let mut f = f.clone();
        for (sine, time) in of(1, None) {
            let Some((cosine, _)) = of(0, Some(&time)).pop() else { continue };
            let cosine = MultiPoly::variable(cosine);
            let square = &MultiPoly::one() - &(&cosine * &cosine);
            let reduced = |p: &MultiPoly| {
                let mut sum = MultiPoly::zero();
                for (k, c) in p.as_poly_in(sine).into_coeffs().into_iter().enumerate() {
                    let even = (0..k / 2).fold(c, |product, _| &product * &square);
                    sum = &sum + &if k % 2 == 0 { even } else { &even * &MultiPoly::variable(sine) };
                }
                sum
            };
            f = RationalFunction::new(reduced(f.numerator()), reduced(f.denominator()))?;
        }
        Some(f)
    }

    /// Sine, cosine or tangent.
    pub(super) fn circular(&mut self, function: Function, x: RationalFunction) -> Option<RationalFunction> {
        let (sine, cosine) = match self.multiple_of_pi(&x) {
            Some(turns) => self.at_multiple_of_pi(&turns)?,
            None if let Some((quarters, rest)) = self.beside_right_angles(&x) => {
                // Two symbols for one angle and the same one turned would not be known to belong together.
                let sine = self.circular(Function::Sin, rest.clone())?;
                let cosine = self.circular(Function::Cos, rest)?;
                turned_by(quarters, (sine, cosine))
            }
            None if self.moves(&x) => {
                // A tangent would leave the line where the angle passes a right one.
                let circle = [1.into(), RationalFunction::zero(), 1.into()].to_vec();
                (self.fundamental(circle.clone(), x.clone(), 1), self.fundamental(circle, x, 0))
            }
            None if function == Function::Tan => return Some(self.tangent(RationalFunction::one(), x)),
            None => {
                let half = &x * &RationalFunction::from(Rational::new(Integer::ONE, 2.into()));
                let t = self.tangent(RationalFunction::one(), half);
                half_angle(&t)?
            }
        };
        match function {
            Function::Sin => Some(sine),
            Function::Cos => Some(cosine),
            _ => sine.checked_div(&cosine),
        }
    }

    /// `q` where `x = q pi`.
    fn multiple_of_pi(&self, x: &RationalFunction) -> Option<Rational> {
        if x.is_zero() {
            return Some(Rational::ZERO);
        }
        let at = self.table.iter().position(|s| s.definition() == Some(&Definition::Pi))?;
        let at = self.kept.len() + at;
        if !x.variables().contains(&at) {
            return None;
        }
        self.as_rational(&x.checked_div(&RationalFunction::variable(at))?)
    }

    /// Sine and cosine of `sqrt(w) t`, the sine over `sqrt(w)`, where the angle is a rational multiple of the circle number.
    pub(crate) fn turned(
        &mut self,
        w: &Rational,
        t: &RationalFunction,
    ) -> Option<(RationalFunction, RationalFunction)> {
        let is_pi = |i: &usize| {
            let symbol = i.checked_sub(self.kept.len()).and_then(|i| self.table.get(i));
            symbol.is_some_and(|s| s.definition() == Some(&Definition::Pi))
        };
        if w.is_negative() || w.is_zero() || !t.variables().iter().any(is_pi) {
            return None;
        }
        // No symbol is left behind where it is none.
        let mut symbols = self.clone();
        let root = symbols.root(w.clone().into())?;
        let turns = symbols.multiple_of_pi(&(&root * t))?;
        let (sine, cosine) = symbols.at_multiple_of_pi(&turns)?;
        *self = symbols;
        Some((sine.checked_div(&root)?, cosine))
    }

    /// Sine and cosine of `q pi`.
    fn at_multiple_of_pi(&mut self, q: &Rational) -> Option<(RationalFunction, RationalFunction)> {
        // Reduced to [0, 2), then to the first quadrant.
        let two = Rational::from(2);
        let q = q - &(&two * &Rational::from((q * &Rational::new(1.into(), 2.into())).floor()));
        let half = Rational::new(1.into(), 2.into());
        let quadrant = (&q * &two).floor().to_i64()?;
        let rest = &q - &(&half * &Rational::from(quadrant));
        let twelfths = &rest * &Rational::from(12);
        let over_two = |root: RationalFunction| &root * &RationalFunction::from(half.clone());
        let (sine, cosine): (RationalFunction, RationalFunction) = match twelfths.numerator().to_i64() {
            _ if rest.is_zero() => (RationalFunction::zero(), RationalFunction::one()),
            Some(2) if twelfths.is_integer() => (half.clone().into(), over_two(self.root(3.into())?)),
            Some(3) if twelfths.is_integer() => {
                let root = over_two(self.root(2.into())?);
                (root.clone(), root)
            }
            Some(4) if twelfths.is_integer() => (over_two(self.root(3.into())?), half.clone().into()),
            _ => {
                let pi = self.pi();
                let t = self.tangent(RationalFunction::one(), &pi * &RationalFunction::from(&rest * &half));
                half_angle(&t)?
            }
        };
        Some(turned_by(quadrant, (sine, cosine)))
    }

    /// `x` as a number of right angles, not a multiple of four of them, and what is left.
    fn beside_right_angles(&self, x: &RationalFunction) -> Option<(i64, RationalFunction)> {
        let at = self.table.iter().position(|s| s.definition() == Some(&Definition::Pi))?;
        let pi = RationalFunction::variable(self.kept.len() + at);
        let coefficients = x.numerator().as_poly_in(self.kept.len() + at).into_coeffs();
        let [_, slope] = &coefficients[..] else { return None };
        let slope = RationalFunction::new(slope.clone(), x.denominator().clone())?.as_constant()?;
        let quarters = &slope * &Rational::from(2);
        let rest = x - &(&pi * &RationalFunction::from(slope));
        let quarters = quarters.is_integer().then(|| quarters.floor())?;
        Some((quarters.div_mod_floor(&Integer::from(4)).1.to_i64()?, rest))
    }
}

/// Sine and cosine of an angle and so many right ones, from 0 to 3.
fn turned_by(
    quarters: i64,
    (sine, cosine): (RationalFunction, RationalFunction),
) -> (RationalFunction, RationalFunction) {
    match quarters {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// Sine and cosine by the tangent of half the angle.
fn half_angle(t: &RationalFunction) -> Option<(RationalFunction, RationalFunction)> {
    let square = t * t;
    let one = RationalFunction::one();
    let below = &one + &square;
    Some(((t + t).checked_div(&below)?, (&one - &square).checked_div(&below)?))
}
