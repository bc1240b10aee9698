//! Factors of a characteristic polynomial over symbols, each of which is decided alone.
//!
//! Where two parts of a loop do not act on each other, or one drives the other only, the resultant of the whole polynomial's
//! half-size pair has factors for pairs of one root of each part. The zeros of these factors mean nothing. Where the parts are nearly equal, they crowd
//! around the zeros of the parts.

use super::SymbolicPolynomial;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::poly::multivariate::{are_coprime_in, is_square_free_in};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};

/// Factors are looked for in polynomials with no more terms: a greatest common divisor in several variables takes long.
const MOST_TERMS: usize = 400;

impl SymbolicPolynomial {
    /// This polynomial as that of several parts of the loop, given by their own polynomials in the variables that this one was made
    /// of; together they have its roots. Where the whole is undefined the first one is.
    ///
    /// Cost: that of making each polynomial, and of [`SymbolicPolynomial::split`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn in_parts(
        &self,
        parts: &[CharacteristicPolynomial],
        free: usize,
        budget: &Budget,
    ) -> Result<Vec<SymbolicPolynomial>, Exhausted> {
        let mut out: Vec<SymbolicPolynomial> = Vec::new();
        for part in parts {
            let part = SymbolicPolynomial::over(part, free, self.symbols.clone());
            for mut factor in part.with_usual_value(self.usual.clone()).split(budget)? {
                if out.is_empty() {
                    factor.poles.clone_from(&self.poles);
                } else {
                    // Its own denominator alone.
                    factor.poles.truncate(1);
                }
                let is_known = |other: &SymbolicPolynomial| {
                    other.polynomial == factor.polynomial && other.degree_loss == factor.degree_loss
                };
                if !out.iter().any(is_known) {
                    out.push(factor);
                }
            }
        }
        Ok(out)
    }

    /// Factors with the same roots, each of them once: those in which one of the variables does not occur, and without repeated
    /// factors. Where the whole is undefined or loses its degree one of them does.
    ///
    /// Cost: tests on lines for common factors of the coefficients of each variable, and greatest common divisors where there are some.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn split(&self, budget: &Budget) -> Result<Vec<SymbolicPolynomial>, Exhausted> {
        let terms: usize = self.polynomial.coeffs().iter().map(|c| c.terms().len()).sum();
        if self.polynomial.degree() != Some(self.formal_degree) || self.formal_degree < 2 || terms > MOST_TERMS {
            return Ok(vec![self.clone()]);
        }
        // The unknown is variable 0.
        let lifted = self.polynomial.map(|c| c.map_variables(|i| i + 1));
        let whole = MultiPoly::from_poly_in(&lifted, 0);
        let factors = budget.enter(|| square_free(by_contents(whole)))?;
        let lowered = |p: &MultiPoly| -> Poly<MultiPoly> { p.as_poly_in(0).map(|c| c.map_variables(|i| i.max(1) - 1)) };
        if let [_] = factors.as_slice()
            && factors[0].degree_in(0) as usize == self.formal_degree
        {
            return Ok(vec![self.clone()]);
        }
        let part = |p: &MultiPoly| {
            let polynomial = lowered(p);
            let formal_degree = p.degree_in(0) as usize;
            let degree_loss = polynomial.leading().map_or_else(MultiPoly::zero, |lead| lead.gcd(&self.degree_loss));
            SymbolicPolynomial { polynomial, degree_loss, formal_degree, ..self.clone() }
        };
        budget.enter(|| factors.iter().map(part).collect())
    }
}

/// Factors of a polynomial in each of which other variables than the unknown, variable 0, do not occur; the unknown occurs in all.
fn by_contents(p: MultiPoly) -> Vec<MultiPoly> {
    let (mut rest, mut out) = (p, Vec::new());
    for j in rest.variables().into_iter().filter(|&j| j > 0) {
        let coefficients: Vec<MultiPoly> =
            rest.as_poly_in(j).into_coeffs().into_iter().filter(|c| !c.is_zero()).collect();
        let are_coprime = |pair: &[MultiPoly]| are_coprime_in(&pair[0], &pair[1], 0);
        if coefficients.len() < 2 || coefficients.windows(2).any(are_coprime) {
            continue;
        }
        let content = coefficients.iter().fold(MultiPoly::zero(), |g, c| g.gcd(c));
        // What the unknown does not occur in stays, as a loss of degree.
        let own = content.as_poly_in(0).primitive_part();
        let content = MultiPoly::from_poly_in(&own, 0);
        if content.degree_in(0) == 0 || content.degree_in(0) == rest.degree_in(0) {
            continue;
        }
        if let Some(quotient) = rest.div_exact(&content) {
            out.extend(by_contents(content));
            rest = quotient;
        }
    }
    out.insert(0, rest);
    out
}

/// The same without repeated factors in the unknown.
fn square_free(factors: Vec<MultiPoly>) -> Vec<MultiPoly> {
    let part = |p: MultiPoly| {
        if is_square_free_in(&p, 0) {
            return p;
        }
        let in_unknown = p.as_poly_in(0);
        let common = MultiPoly::from_poly_in(&in_unknown.gcd(&in_unknown.derivative()).primitive_part(), 0);
        if common.degree_in(0) == 0 { p } else { p.div_exact(&common).unwrap_or(p) }
    };
    factors.into_iter().map(part).collect()
}
