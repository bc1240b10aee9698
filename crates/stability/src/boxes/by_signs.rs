//! A family of polynomials that is told by signs of polynomials in its parameters alone.
//!
//! The Hurwitz determinant of the second highest order is up to its sign the product of the sums of any two roots
//! ([Orlando1911](jurist_algebra::bibliography#orlando1911)), and the resultant of the pair by the square of the frequency. It does not
//! vanish where a loop is stable, and vanishes where a pair of roots is on the axis. So a connected set with a stable point is
//! stable where no divisor, no constant, no leading coefficient and no determinant vanishes in it, and no point is stable at which
//! one of them does. That needs no cells of frequency, and repeated factors count once: where boundaries meet at a corner or are
//! touched and not crossed, signs tell what cells do not. Of many parameters the determinant is too long.

use super::polynomial::{BoxPolynomial, Bundle, without_squares};
use crate::Cause;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, resultant};

/// A determinant with more Bernstein coefficients is not made.
const MOST_COEFFICIENTS: usize = 1 << 11;

/// Factors of a polynomial of more terms are not looked for.
const MOST_TERMS: usize = 256;

impl BoxPolynomial {
    /// The same family, told by signs; `None` where a proof excludes something else, or the determinant is too long.
    ///
    /// Cost: one resultant over the polynomials in the parameters.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub(super) fn by_determinant(&self, budget: &Budget) -> Result<Option<BoxPolynomial>, Exhausted> {
        if !self.has_short_determinant() {
            return Ok(None);
        }
        let [even, odd] = self.even_and_odd();
        budget.step("the determinant of the boundary");
        let determinant = resultant(&even, &odd, budget)?;
        budget
            .enter(|| {
                let factors = |(cause, f): &(Cause, MultiPoly)| factors(f).into_iter().map(|f| (*cause, f)).collect();
                let mut apart: Vec<Vec<(Cause, MultiPoly)>> = self.certain.iter().map(factors).collect();
                apart.push(factors(&(Cause::ComplexPair, determinant)));
                let divisors = apart[..self.divisors].iter().map(Vec::len).sum();
                let mut told = self.clone();
                (told.certain, told.divisors, told.by_signs) = (apart.concat(), divisors, true);
                told
            })
            .map(Some)
    }

    /// Whether the determinant is short, and nothing else is excluded.
    pub(super) fn has_short_determinant(&self) -> bool {
        let [even, odd] = self.even_and_odd();
        !self.by_signs && self.instead.is_none() && is_short(&even, &odd, self.parameters())
    }

    /// `E` and `O` as polynomials in the square of the frequency.
    fn even_and_odd(&self) -> [Poly<MultiPoly>; 2] {
        let all = self.in_half_plane();
        [0, 1].map(|odd| {
            let signed = |(j, c): (usize, &MultiPoly)| if j % 2 == 1 { c.negated() } else { c.clone() };
            Poly::new(all.iter().skip(odd).step_by(2).enumerate().map(signed).collect())
        })
    }
}

/// Whether the resultant of two polynomials has few Bernstein coefficients, by the degrees of theirs.
fn is_short(even: &Poly<MultiPoly>, odd: &Poly<MultiPoly>, parameters: usize) -> bool {
    let (Some(n), Some(m)) = (even.degree(), odd.degree()) else { return false };
    let degrees = |p: &Poly<MultiPoly>| Bundle::new(&p.coeffs().iter().collect::<Vec<_>>(), parameters).degrees;
    let of_both = degrees(even).into_iter().zip(degrees(odd));
    let count = of_both.map(|(e, o)| m * e + n * o + 1).try_fold(1usize, usize::checked_mul);
    count.is_some_and(|count| count <= MOST_COEFFICIENTS)
}

/// Polynomials that vanish together where one does: its variables, what does not depend on one of the others, and the rest.
fn factors(f: &MultiPoly) -> Vec<MultiPoly> {
    if f.terms().len() > MOST_TERMS {
        return vec![without_squares(f)];
    }
    let f = without_squares(f);
    for i in f.variables() {
        let content = f.as_poly_in(i).content();
        if !content.is_constant()
            && let Some(rest) = f.div_exact(&content)
        {
            return [factors(&content), factors(&rest)].concat();
        }
        let variable = MultiPoly::variable(i);
        if let Some(rest) = f.div_exact(&variable).filter(|rest| !rest.is_constant()) {
            return [vec![variable], factors(&rest)].concat();
        }
    }
    vec![f]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;
    use crate::boxes::{Family, Outcome};
    use jurist_algebra::number::Rational;
    use proptest::prelude::*;

    #[test]
    fn factors_are_taken_once_and_apart() {
        let [a, b, c] = [0, 1, 2].map(MultiPoly::variable);
        let difference = a.minus(&b);
        let apart = factors(&c.times(&c).times(&difference).times(&difference).times(&a));
        assert_eq!(apart.len(), 3, "{apart:?}");
        for f in [a, c, difference] {
            assert!(apart.contains(&f) || apart.contains(&f.negated()), "{apart:?}");
        }
    }

    /// `s^3 + a s^2 + b s + a b c`: a pair is on the axis at `a b (1 - c) = 0`.
    #[test]
    fn the_determinant_is_that_of_hurwitz() {
        let [a, b, c] = [0, 1, 2].map(MultiPoly::variable);
        let p = Poly::new(vec![a.times(&b).times(&c), b, a, MultiPoly::one()]);
        let p = BoxPolynomial::of_parts(p, 3, [], 3, Shape::LeftHalfPlane);
        let told = p.by_determinant(&Budget::unlimited()).unwrap().unwrap();
        let of_pair = told.certain().iter().filter(|(cause, _)| *cause == Cause::ComplexPair);
        assert_eq!(of_pair.count(), 3);
        assert!(told.by_determinant(&Budget::unlimited()).unwrap().is_none());
    }
    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Cells of frequency prove and refute the same boxes of `s^4 + a s^3 + (b + 3) s^2 + (a b + c) s + 1`.
        #[test]
        fn signs_agree_with_cells_of_frequency(low in [0i64..=8, 0i64..=8, -4i64..=8], width in [0i64..=4, 0i64..=4, 0i64..=4]) {
            let [a, b, c] = [0, 1, 2].map(MultiPoly::variable);
            let second = b.plus(&MultiPoly::constant(3.into()));
            let p = Poly::new(vec![MultiPoly::one(), a.times(&b).plus(&c), second, a, MultiPoly::one()]);
            let p = BoxPolynomial::of_parts(p, 4, [], 3, Shape::LeftHalfPlane);
            let told = p.by_determinant(&Budget::unlimited()).unwrap().unwrap();
            let quarter = |n: i64| Rational::new(n.into(), 4.into());
            let sides: Vec<[Rational; 2]> = (0..3).map(|i| [low[i], low[i] + width[i]].map(quarter)).collect();
            let nominal: Vec<Rational> = sides.iter().map(|[low, high]| low.midpoint(high)).collect();
            prop_assume!(p.is_stable_at(&nominal));
            let found = |p: &BoxPolynomial| {
                let (signs, scale) = p.signs_at(&nominal).unwrap();
                p.prove(&sides, (&signs, scale), 4000, &Budget::unlimited()).unwrap()
            };
            match (found(&p), found(&told)) {
                (Outcome::Stable(_), other) => prop_assert!(!matches!(other, Outcome::Refuted(_)), "{other:?}"),
                (Outcome::Refuted(_), other) => prop_assert!(!matches!(other, Outcome::Stable(_)), "{other:?}"),
                _ => {}
            }
        }
    }
}
