//! How far the imaginary axis has to be looked at for all values of a parameter in a range.

use crate::Range;
use crate::interval_set::zeros_in;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, SquareFree, UniPoly, isolate_real_roots_in, resultant_formal};
use std::cmp::Ordering;

/// A frequency beyond which no root lies on the axis for any value of the parameter in a closed range, however wide; `None`
/// where none is known.
///
/// The coefficient of `z^k s^j` is the polynomial in the parameter at `[k][j]`; on the axis `|z^k|` is at most `weights[k]`.
/// Beyond the largest zero of the leading coefficient, of the discriminant and of the values at the ends, the real zeros
/// in the parameter of `|P_0|^2 - q sum w_k^2 |P_k|^2` keep their number in the range, so that one look tells whether there
/// are any. For one delayed part that is the very condition `|P_0| = |P_1|`, for more it is sufficient
/// (Cauchy-Schwarz).
///
/// Where coefficients are off by `errors` at most, for the modulus of the parameter, `|P_0| > A + e` with their sum `e` follows from
/// `|P_0|^2 > (1 + d) A^2 + (1 + 1/d) e^2` for any `d`.
///
/// Cost: a discriminant in two variables and the isolation of its roots.
pub(super) fn frequency_bound_over(
    parts: &[Vec<UniPoly>],
    errors: &[Vec<UniPoly>],
    weights: &[Rational],
    range: &Range,
    budget: &Budget,
) -> Result<Option<Rational>, Exhausted> {
    let difference = budget.enter(|| difference_of_squares(parts, errors, weights, range))?;
    if difference.is_zero() {
        return Ok(None);
    }
    let in_parameter = budget.enter(|| difference.square_free_part())?.as_poly_in(1);
    let degree = in_parameter.coeffs().len() - 1;
    let mut critical: Vec<UniPoly> = Vec::new();
    let univariate = |p: &MultiPoly| p.to_univariate(0).expect("the square of the frequency alone is left");
    critical.push(univariate(in_parameter.leading().expect("not zero")));
    if degree > 0 {
        let slope = in_parameter.derivative();
        let discriminant = resultant_formal(&in_parameter, degree, &slope, degree - 1, budget)?;
        critical.push(univariate(&discriminant));
    }
    for end in [&range.lower, &range.upper].into_iter().flatten() {
        let (value, _) = difference.substitute_univariate(1, end, 0).expect("two variables");
        critical.push(value);
    }
    let mut beyond = Rational::ONE;
    for p in &critical {
        if p.is_zero() {
            return Ok(None);
        }
        let Some(part) = budget.enter(|| SquareFree::part_of(p))? else { continue };
        if let Some(largest) = isolate_real_roots_in(&part, Some(&Rational::ZERO), None, budget)?.pop() {
            let width = Rational::dyadic(&Integer::ONE, 4);
            let upper = budget.enter(|| largest.refined(&width).enclosure().1)?;
            beyond = beyond.max(upper + Rational::dyadic(&Integer::ONE, 4));
        }
    }
    let (at, _) = difference.substitute_univariate(0, &beyond, 1).expect("two variables");
    if at.is_zero() || !zeros_in(&at, range, budget)?.is_empty() {
        return Ok(None);
    }
    let inside = match (&range.lower, &range.upper) {
        (Some(l), Some(u)) => l.midpoint(u),
        (Some(l), None) => l + &Rational::ONE,
        (None, Some(u)) => u - &Rational::ONE,
        (None, None) => Rational::ZERO,
    };
    let positive = at.sign_at(&inside).is_gt();
    Ok(positive.then(|| Enclosure::from_rational(beyond).sqrt(16).upper().ceil()).map(|w| Rational::from(&w)))
}

/// What is positive where `|P_0|` outweighs the delayed parts, in `omega^2` (0) and the parameter (1).
fn difference_of_squares(
    parts: &[Vec<UniPoly>],
    errors: &[Vec<UniPoly>],
    weights: &[Rational],
    range: &Range,
) -> MultiPoly {
    let delayed: Vec<usize> = (1..parts.len()).filter(|&k| parts[k].iter().any(|c| !c.is_zero())).collect();
    let common = weights.iter().fold(Integer::ONE, |l, w| l.lcm(&w.denominator()));
    let scaled = |w: &Rational| (w * &Rational::from(&common)).numerator();
    let own = modulus_squared(&parts[0]).scaled_by(&(&common * &common));
    let mut others = MultiPoly::zero();
    for &k in &delayed {
        let w = scaled(&weights[k]);
        let factor = &(&w * &w) * &Integer::from(delayed.len() as i64);
        others = &others + &modulus_squared(&parts[k]).scaled_by(&factor);
    }
    if errors.is_empty() {
        return &own - &others;
    }
    let greatest = weights.iter().map(scaled).fold(common.clone(), |a, b| a.max(b));
    let off = squares_of_errors(errors, range).scaled_by(&(&(&greatest * &greatest) << BITS_FOR_ERRORS));
    let one_more = (Integer::ONE << BITS_FOR_ERRORS) + Integer::ONE;
    &own.scaled_by(&(Integer::ONE << BITS_FOR_ERRORS)) - &(&others + &off).scaled_by(&one_more)
}

/// The number `d` beside errors is one over two to this.
const BITS_FOR_ERRORS: u64 = 20;

/// In `omega^2` (0) and the parameter (1) at least the square of the sum of all errors, where the parameter is in the range.
fn squares_of_errors(errors: &[Vec<UniPoly>], range: &Range) -> MultiPoly {
    let all = || errors.iter().flat_map(|part| part.iter().enumerate()).filter(|(_, e)| !e.is_zero());
    let is_from = |end: &Option<Rational>, sign: Ordering| end.as_ref().is_some_and(|end| end.sign() != sign);
    let at_modulus =
        |e: &UniPoly| match (is_from(&range.lower, Ordering::Less), is_from(&range.upper, Ordering::Greater)) {
            (true, _) => e.clone(),
            (_, true) => e.negated_argument(),
            // Even powers of the parameter, which outweigh the odd ones.
            _ => UniPoly::new(with_even_powers(e)),
        };
    let count = Integer::from(all().count() as i64);
    all().fold(MultiPoly::zero(), |sum, (j, e)| {
        let e = MultiPoly::from_univariate(&at_modulus(e), 1);
        let frequency = MultiPoly::variable(0).power(j as u64);
        &sum + &(&(&e * &e) * &frequency).scaled_by(&count)
    })
}

/// Coefficients of a polynomial in even powers that is at least the one at the modulus: `2 |p|^k <= |p|^(k - 1) + |p|^(k + 1)`.
fn with_even_powers(e: &UniPoly) -> Vec<Integer> {
    let mut out = vec![Integer::ZERO; e.coeffs().len() + 1];
    for (k, c) in e.coeffs().iter().enumerate() {
        match k % 2 {
            0 => out[k] += c,
            _ => [k - 1, k + 1].into_iter().for_each(|k| out[k] += c),
        }
    }
    out
}

/// `|P(i omega)|^2` in `omega^2` (0) and the parameter (1), of the coefficients of the powers of `s`.
fn modulus_squared(coefficients: &[UniPoly]) -> MultiPoly {
    let part = |from: usize| {
        let terms = coefficients.iter().skip(from).step_by(2).enumerate().map(|(i, c)| {
            let c = if i % 2 == 1 { c.negated() } else { c.clone() };
            MultiPoly::from_univariate(&c, 1)
        });
        MultiPoly::from_poly_in(&Poly::new(terms.collect()), 0)
    };
    let (even, odd) = (part(0), part(1));
    &(&even * &even) + &(&(&odd * &odd) * &MultiPoly::variable(0))
}
