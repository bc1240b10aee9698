//! What follows a zero at the lower end of a range.

use super::moving::{FIRST_BITS, MOST_HALVINGS, TERMS};
use super::{Definition, Function, MovingSymbols};
use crate::ball::{Ball, Series};
use crate::number::{Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};
use std::collections::BTreeMap;

/// The orders of a zero at the lower end that are looked for.
const MOST_ORDER: usize = 32;

impl MovingSymbols {
    /// A number above `lower`, at which the function is zero, up to which it has no other zero. Where that it is zero is all that is known
    /// for certain, the zero may turn out to be a simple one.
    pub(super) fn clear_above(
        &self,
        f: &Function,
        lower: &Rational,
        upper: &Rational,
        is_zero: bool,
    ) -> Option<Rational> {
        let order = self.order_at(f, lower).or_else(|| self.order_beside_constants(f, lower));
        let order = order.or_else(|| is_zero.then(|| self.least_order(f, lower)))?;
        // f = (T - lower)^order (a + ...): the later coefficients on a short interval are less than the first one.
        let mut step = (upper - lower) * Rational::dyadic(&Integer::ONE, 3);
        for _ in 0..MOST_HALVINGS {
            let small = step.denominator().bit_length().saturating_sub(step.numerator().bit_length());
            let bits = FIRST_BITS + small * (2 * order as u64 + 4);
            let terms = order + TERMS;
            let radius = Ball::from_rational(&step, bits);
            let series = |at: &Ball, terms| {
                Some(f.at_series(&self.series(&Series::linear(at, &radius, terms))?).coefficients().to_vec())
            };
            let point = series(&Ball::from_rational(lower, bits), terms);
            let whole = series(&Ball::between(lower, &(lower + &step), bits), terms + 1);
            if let (Some(point), Some(mut whole)) = (point, whole) {
                let rest = whole.pop().map_or(Integer::ZERO, |c| c.magnitude_units());
                let later = point[order + 1..].iter().fold(rest, |sum, c| sum + c.magnitude_units());
                if point[order].least_magnitude_units() > later {
                    return Some(lower + &step);
                }
            }
            step *= Rational::dyadic(&Integer::ONE, 1);
        }
        None
    }

    /// The least order that a zero at this number can have: a function of a power of the parameter has zeros of multiples of its order at 0.
    fn least_order(&self, f: &Function, at: &Rational) -> usize {
        let depends = |d: &Definition| d.arguments().iter().any(|x| x.variables().contains(&0));
        if !at.is_zero() || self.table().iter().any(|(_, d)| depends(d)) {
            return 1;
        }
        let exponents = f.polynomials().flat_map(|p| p.terms().iter().map(|(m, _)| Integer::from(m.exponent(0))));
        exponents
            .fold(Integer::ZERO, |g, e| g.gcd(&e))
            .to_i64()
            .map_or(1, |step| step.clamp(1, MOST_ORDER as i64) as usize)
    }

    /// The order of the zero at a rational number, where the series there is rational: then that of its first coefficient that
    /// is not zero.
    fn order_at(&self, f: &Function, at: &Rational) -> Option<usize> {
        let mut terms = 4;
        while terms <= MOST_ORDER {
            let values = super::rational_series::values(self.table(), at, terms)?;
            let series = f.at_rational_series(&values);
            if let Some(order) = series.iter().position(|c| !c.is_zero()) {
                return Some(order);
            }
            terms *= 2;
        }
        None
    }

    /// The same where the series are rational but for symbols that do not depend on the parameter: the order of the first coefficient that is not zero as
    /// a polynomial in these. Its value may still be zero.
    fn order_beside_constants(&self, f: &Function, at: &Rational) -> Option<usize> {
        // Variables that depend on the parameter, by their new numbers.
        let mut moving = vec![0];
        let mut table: Vec<(String, Definition)> = Vec::new();
        for (variable, (name, definition)) in (1..).zip(self.table()) {
            let place = |v: usize| moving.iter().position(|own| *own == v);
            let arguments: Vec<usize> = definition.arguments().iter().flat_map(|f| f.variables()).collect();
            if arguments.iter().all(|v| place(*v).is_none()) {
                continue;
            }
            let moved = |f: &RationalFunction| match f.variables().iter().all(|v| place(*v).is_some()) {
                true => f.map_variables(|v| place(v).expect("it moves")),
                false => None,
            };
            table.push((name.clone(), definition.try_map(moved)?));
            moving.push(variable);
        }
        // For each monomial in the constants the polynomial beside it.
        let mut beside: BTreeMap<Vec<u32>, Vec<(Vec<u32>, Integer)>> = BTreeMap::new();
        for (monomial, c) in f.polynomial()?.terms() {
            let mut constants = monomial.exponents().to_vec();
            moving.iter().filter(|v| **v < monomial.exponents().len()).for_each(|v| constants[*v] = 0);
            constants.truncate(constants.iter().rposition(|e| *e > 0).map_or(0, |last| last + 1));
            let own = moving.iter().map(|v| monomial.exponent(*v)).collect();
            beside.entry(constants).or_default().push((own, c.clone()));
        }
        let polynomials: Vec<MultiPoly> = beside.into_values().map(MultiPoly::from_terms).collect();
        let mut terms = 4;
        while terms <= MOST_ORDER {
            let values = super::rational_series::values(&table, at, terms)?;
            let order =
                |p: &MultiPoly| super::rational_series::polynomial_at(p, &values).iter().position(|c| !c.is_zero());
            if let Some(order) = polynomials.iter().filter_map(order).min() {
                return Some(order);
            }
            terms *= 2;
        }
        None
    }
}
