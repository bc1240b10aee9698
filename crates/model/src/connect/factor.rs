//! Factors of a polynomial over the rationals: those of degree 1 and 2, and what is left.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::real_roots::rational_roots;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, SquareFree, UniPoly, resultant};

/// Above this degree quadratic factors are not looked for: the polynomial of sums of two roots has its square as degree.
const GREATEST_SEARCHED: usize = 8;

/// Pairwise coprime monic factors with their multiplicities; their product is the monic polynomial given, from the constant
/// term up. Factors of degree 1 and, up to [`GREATEST_SEARCHED`], of degree 2 are split off; the rest of each multiplicity
/// is one factor.
pub(crate) fn factors(monic: &[Rational], budget: &Budget) -> Result<Vec<(Vec<Rational>, usize)>, Exhausted> {
    let (_, integral) = UniPoly::from_rational_poly(&Poly::new(monic.to_vec()));
    let mut out = Vec::new();
    for (part, multiplicity) in integral.square_free_decomposition() {
        let Some(part) = SquareFree::new(part).filter(|p| p.degree() > 0) else { continue };
        let (roots, rest) = rational_roots(&part, budget)?;
        out.extend(roots.iter().map(|root| (vec![-root, Rational::ONE], multiplicity)));
        let mut rest = rest.poly().primitive_part();
        if rest.degree().is_some_and(|d| (3..=GREATEST_SEARCHED).contains(&d)) {
            for quadratic in quadratic_factors(&rest, budget)? {
                let (quotient, _) = rest.pseudo_div_rem(&quadratic);
                rest = quotient.primitive_part();
                out.push((monic_of(&quadratic), multiplicity));
            }
        }
        if rest.degree().is_some_and(|d| d > 0) {
            out.push((monic_of(&rest), multiplicity));
        }
    }
    Ok(out)
}

fn monic_of(p: &UniPoly) -> Vec<Rational> {
    let leading = p.leading().cloned().unwrap_or_default();
    p.coeffs().iter().map(|c| Rational::new(c.clone(), leading.clone())).collect()
}

/// The quadratic factors of a square-free polynomial without rational roots: `-b` is a rational sum of two roots, and the
/// two are common roots of `f(x)` and `f(-b - x)`.
fn quadratic_factors(f: &UniPoly, budget: &Budget) -> Result<Vec<UniPoly>, Exhausted> {
    let mut found: Vec<UniPoly> = Vec::new();
    let mut rest = f.clone();
    // Res_x(f(x), f(y - x)) as a polynomial in y (variable 0).
    let y = MultiPoly::variable(0);
    let lift = |p: &UniPoly| p.map(|c| MultiPoly::constant(c.clone()));
    let mirrored = lift(f).compose(&Poly::new(vec![y, MultiPoly::from(-1)]));
    let sums = resultant(&lift(f), &mirrored, budget)?;
    let Some(sums) = sums.to_univariate(0).and_then(|p| SquareFree::part_of(&p)) else { return Ok(found) };
    let (sums, _) = rational_roots(&sums, budget)?;
    for sum in sums {
        budget.check()?;
        let (_, mirrored) = UniPoly::from_rational_poly(
            &rest.map(|c| Rational::from(c.clone())).compose(&Poly::new(vec![sum, -Rational::ONE])),
        );
        let common = rest.gcd(&mirrored).primitive_part();
        if common.degree() == Some(2) {
            let (quotient, remainder) = rest.pseudo_div_rem(&common);
            if remainder.is_zero() {
                rest = quotient.primitive_part();
                found.push(common);
            }
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(factors: &[(Vec<Rational>, usize)]) -> Poly<Rational> {
        factors.iter().fold(Poly::constant(Rational::ONE), |product, (f, multiplicity)| {
            (0..*multiplicity).fold(product, |product, _| product.times(&Poly::new(f.clone())))
        })
    }

    #[test]
    fn lines_and_quadratics_are_split_off_and_the_product_is_the_polynomial() {
        // (degrees of the factors, the polynomial's own factors)
        type Case = (&'static [usize], &'static [&'static [i64]]);
        let cases: [Case; 5] = [
            (&[1, 1, 2], &[&[0, 1], &[3, 1], &[2, 1, 1]]),
            (&[2, 2], &[&[5, 1, 1], &[7, -2, 1]]),
            (&[2, 2], &[&[5, 1, 1], &[6, 1, 1]]),
            (&[1, 3], &[&[1, 1], &[-2, 0, 0, 1]]),
            (&[4], &[&[1, 0, 0, 0, 1]]),
        ];
        for (degrees, parts) in cases {
            let rational = |p: &&[i64]| Poly::new(p.iter().map(|&c| Rational::from(c)).collect());
            let whole = parts.iter().map(rational).fold(Poly::constant(Rational::ONE), |a, b| a.times(&b));
            let found = factors(whole.coeffs(), &Budget::unlimited()).unwrap();
            assert_eq!(product(&found), whole);
            let mut sizes: Vec<usize> = found.iter().map(|(f, _)| f.len() - 1).collect();
            sizes.sort_unstable();
            // Two quadratics with the same sum of roots stay together.
            let together = parts.len() == 2 && parts[0][1] == parts[1][1] && parts[0].len() == 3;
            assert_eq!(sizes, if together { vec![4] } else { degrees.to_vec() }, "{parts:?}");
        }
    }

    #[test]
    fn multiplicities_are_kept() {
        let line = Poly::new(vec![Rational::from(2), Rational::ONE]);
        let pair = Poly::new(vec![Rational::from(5), Rational::ONE, Rational::ONE]);
        let whole = line.times(&line).times(&pair).times(&pair).times(&Poly::x());
        let found = factors(whole.coeffs(), &Budget::unlimited()).unwrap();
        assert_eq!(product(&found), whole);
        assert_eq!(found.len(), 3);
    }
}
