//! The factors at which zeros of the pair meet while one parameter moves.
//!
//! On a line of corners with one parameter free, let `R(rho, p)` be the resultant of the pair by the frequency. For a fixed
//! factor the order of a zero of `R` in `p` is at least the multiplicity of the zero of the pair, which is two or more where
//! the determinant of its derivatives by frequency and `p` vanishes. So the factor of such a zero is a root of the resultant
//! of `R` and its derivative by `p`.

use super::polynomial::Bundle;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, isolate_real_roots, resultant};

/// The factor on a line of corners.
const FACTOR: usize = 0;

/// The parameter that is free.
const FREE: usize = 1;

/// The one such factor above `from` and up to `to`; `None` unless there is exactly one.
///
/// `line` is a base and a step for each parameter; those of the free one are not looked at. Cost: a resultant of two
/// polynomials of half the degree over polynomials in two variables, and one over polynomials in one.
pub(super) fn touching(
    pair: &Bundle,
    line: &(Vec<Rational>, Vec<Rational>),
    free: usize,
    [from, to]: [&Rational; 2],
    budget: &Budget,
) -> Result<Option<RealAlgebraic>, Exhausted> {
    budget.step("eliminating the parameter inside");
    let [even, odd] = budget.enter(|| on_corners(pair, line, free))?;
    let meeting = resultant(&even, &odd, budget)?;
    let in_free = meeting.as_poly_in(FREE);
    if in_free.degree().is_none_or(|degree| degree == 0) {
        return Ok(None);
    }
    let double = resultant(&in_free, &in_free.derivative(), budget)?;
    let Some(double) = double.to_univariate(FACTOR) else { return Ok(None) };
    let Some(double) = budget.enter(|| SquareFree::part_of(&double))? else { return Ok(None) };
    let mut roots = isolate_real_roots(&double, budget)?;
    roots.retain(|root| root.compare_rational(from).is_gt() && root.compare_rational(to).is_le());
    Ok(if roots.len() == 1 { roots.pop() } else { None })
}

/// The pair as polynomials in the frequency over those in the factor and the free parameter.
fn on_corners(pair: &Bundle, (base, step): &(Vec<Rational>, Vec<Rational>), free: usize) -> [Poly<MultiPoly>; 2] {
    let tables: Vec<Vec<MultiPoly>> = pair
        .degrees
        .iter()
        .enumerate()
        .map(|(i, &degree)| {
            let (b, s) = (&base[i], &step[i]);
            let q = b.denominator().lcm(&s.denominator());
            let whole = |v: &Rational| MultiPoly::constant((v * &Rational::from(&q)).numerator());
            let moved = || whole(b).plus(&whole(s).times(&MultiPoly::variable(FACTOR)));
            let (value, scale) = match i == free {
                true => (MultiPoly::variable(FREE), MultiPoly::one()),
                false => (moved(), MultiPoly::constant(q.clone())),
            };
            let power = |f: &MultiPoly, e: usize| (0..e).fold(MultiPoly::one(), |product, _| product.times(f));
            (0..=degree).map(|e| power(&value, e).times(&power(&scale, degree - e))).collect()
        })
        .collect();
    let mut values = vec![MultiPoly::zero(); pair.width];
    for (exponents, coefficients) in &pair.terms {
        let factor = exponents.iter().zip(&tables).fold(MultiPoly::one(), |f, (&e, table)| f.times(&table[e as usize]));
        for (value, c) in values.iter_mut().zip(coefficients).filter(|(_, c)| !c.is_zero()) {
            *value = value.plus(&factor.scaled_by(c));
        }
    }
    let odd = values.split_off(pair.width / 2);
    [Poly::new(values), Poly::new(odd)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;

    /// `E = 1 - v + (p - 1/2)^2 - r`, `O = v - 1`: zeros at `(p - 1/2)^2 = r`, which meet at `r = 0`... shifted to `r = 3`.
    #[test]
    fn zeros_meet_where_their_parabola_has_its_vertex() {
        let (r, p) = (MultiPoly::variable(0), MultiPoly::variable(1));
        let n = |n: i64| MultiPoly::constant(n.into());
        // 4 E: 4 - 4 v + (2 p - 1)^2 - 4 (r - 3)
        let vertex = p.scaled_by(&2.into()).minus(&n(1));
        let e0 = n(16).plus(&vertex.times(&vertex)).minus(&r.scaled_by(&4.into()));
        let pair = Bundle::new(&[&e0, &n(-4), &n(-1), &n(1)], 2);
        let line = (vec![Rational::ZERO; 2], vec![Rational::ONE; 2]);
        let (from, to) = (parse_number("2").unwrap(), parse_number("4").unwrap());
        let found = touching(&pair, &line, 1, [&from, &to], &Budget::unlimited()).unwrap().unwrap();
        assert_eq!(found.exact(), Some(Rational::from(3)));
    }
}
