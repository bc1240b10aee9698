//! Common factors of polynomials in an unknown (variable 0) whose coefficients are numbers, polynomials in symbols (symbol `i` is
//! variable `i + 1`).
//!
//! With the symbols as variables `(K - sqrt(2))^2` has no repeated factor once it is expanded and `sqrt(2)^2` written as 2. Euclid's
//! algorithm over the numbers themselves finds it: a coefficient is zero where [`Symbols::is_zero`] proves it.

use super::roots::of_symbols;
use super::{Definition, Symbols};
use crate::limits::{Budget, Exhausted, Stop};
use crate::poly::{Domain, MultiPoly, Poly};

/// Polynomials with more terms are given up: over several symbols that are not square roots nothing keeps them short.
const MOST_TERMS: usize = 4000;

impl Symbols {
    /// A polynomial with the same zeros, all of them simple. Zero for zero.
    ///
    /// Cost: a remainder sequence over polynomials in the symbols, and the sign of each leading coefficient.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::{Domain, MultiPoly};
    /// use jurist_algebra::symbols::{Definition, Symbols};
    /// let mut symbols = Symbols::new();
    /// symbols.insert("r", Definition::root(2));
    /// // K^2 - 2 r K + 2 with K as variable 0 and r = sqrt(2) as variable 1
    /// let [k, r, two] = [MultiPoly::variable(0), MultiPoly::variable(1), MultiPoly::from(2)];
    /// let p = k.times(&k).minus(&two.times(&r).times(&k)).plus(&two);
    /// assert_eq!(symbols.square_free_part(&p, &Budget::unlimited()).unwrap().degree_in(0), 1);
    /// ```
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where the sign of a coefficient is not found.
    pub fn square_free_part(&self, p: &MultiPoly, budget: &Budget) -> Result<MultiPoly, Exhausted> {
        let p = self.trimmed(p.as_poly_in(0), budget)?;
        if p.is_zero() {
            return Ok(MultiPoly::zero());
        }
        let repeated = self.common(p.clone(), p.derivative(), budget)?;
        self.quotient(&p, &repeated, budget)
    }

    /// Polynomials without a common zero that have the zeros of all given ones, which are square-free.
    ///
    /// Cost: as of [`Symbols::square_free_part`] for each pair.
    ///
    /// # Errors
    /// As [`Symbols::square_free_part`].
    pub fn coprime_basis(&self, polynomials: &[MultiPoly], budget: &Budget) -> Result<Vec<MultiPoly>, Exhausted> {
        let mut basis: Vec<MultiPoly> = Vec::new();
        for p in polynomials {
            let mut part = p.clone();
            for k in 0..basis.len() {
                let known = basis[k].as_poly_in(0);
                let common = self.common(known.clone(), part.as_poly_in(0), budget)?;
                if common.is_constant() {
                    continue;
                }
                let rest = self.quotient(&known, &common, budget)?;
                part = self.quotient(&part.as_poly_in(0), &common, budget)?;
                basis[k] = MultiPoly::from_poly_in(&common, 0);
                if rest.degree_in(0) > 0 {
                    basis.push(rest);
                }
            }
            if part.degree_in(0) > 0 {
                basis.push(part);
            }
        }
        Ok(basis)
    }

    /// Whether two polynomials have a common zero, complex ones included.
    ///
    /// Cost: as of [`Symbols::square_free_part`].
    ///
    /// # Errors
    /// As [`Symbols::square_free_part`].
    pub fn have_common_zero(&self, p: &MultiPoly, q: &MultiPoly, budget: &Budget) -> Result<bool, Exhausted> {
        Ok(!self.common(p.as_poly_in(0), q.as_poly_in(0), budget)?.is_constant())
    }

    /// The greatest common divisor of polynomials that are not all zero, up to a number that is not zero.
    ///
    /// Cost: as of [`Symbols::square_free_part`] for each polynomial.
    ///
    /// # Errors
    /// As [`Symbols::square_free_part`].
    pub fn greatest_common_divisor(&self, polynomials: &[MultiPoly], budget: &Budget) -> Result<MultiPoly, Exhausted> {
        let mut divisor = Poly::zero();
        for p in polynomials {
            let p = self.trimmed(p.as_poly_in(0), budget)?;
            divisor = if divisor.is_zero() { p } else { self.common(divisor, p, budget)? };
        }
        Ok(MultiPoly::from_poly_in(&divisor, 0))
    }

    /// The greatest common divisor up to a number that is not zero.
    fn common(
        &self,
        mut a: Poly<MultiPoly>,
        b: Poly<MultiPoly>,
        budget: &Budget,
    ) -> Result<Poly<MultiPoly>, Exhausted> {
        let mut b = self.trimmed(b, budget)?;
        while !b.is_zero() {
            let rest = budget.enter(|| a.pseudo_rem(&b))?;
            (a, b) = (b, self.trimmed(rest, budget)?);
        }
        Ok(a)
    }

    /// The quotient by a divisor, times a number that is not zero.
    fn quotient(&self, a: &Poly<MultiPoly>, b: &Poly<MultiPoly>, budget: &Budget) -> Result<MultiPoly, Exhausted> {
        let (quotient, _) = budget.enter(|| a.pseudo_div_rem(b))?;
        Ok(MultiPoly::from_poly_in(&self.trimmed(quotient, budget)?, 0))
    }

    /// Without leading coefficients that are zero, and without a common divisor of the others as far as it is found fast.
    fn trimmed(&self, p: Poly<MultiPoly>, budget: &Budget) -> Result<Poly<MultiPoly>, Exhausted> {
        let mut coefficients = p.into_coeffs();
        while let Some(lead) = coefficients.last()
            && self.is_zero(&of_symbols(lead), budget)?
        {
            coefficients.pop();
        }
        let p = MultiPoly::from_poly_in(&Poly::new(coefficients), 0);
        budget.enter(|| {
            let p = self.with_low_powers(&p).primitive_over_integers();
            if p.terms().len() > MOST_TERMS {
                // As where bits do not suffice: it is not told whether zeros are apart.
                let reached = "common factors over numbers that are long";
                return Err(Exhausted::new(Stop::Terms(MOST_TERMS as u64), reached));
            }
            let is_simple = p.variables().len() <= 2;
            let p = p.as_poly_in(0);
            if !is_simple {
                return Ok(p);
            }
            // A divisor that is zero would have made the leading coefficient zero.
            let content = p.coeffs().iter().fold(MultiPoly::zero(), |g, c| g.gcd(c));
            Ok(p.div_exact_scalar(&content).unwrap_or_else(Poly::zero))
        })?
    }

    /// A positive multiple in which square roots of rational numbers occur to the first power only.
    fn with_low_powers(&self, p: &MultiPoly) -> MultiPoly {
        let mut p = p.clone();
        for i in 0..self.len() {
            let Definition::Root(square) = self.definition(i) else { continue };
            let Some(square) = square.as_constant().filter(|_| p.degree_in(i + 1) > 1) else { continue };
            let [n, d] = [square.numerator(), square.denominator()];
            let own = p.as_poly_in(i + 1);
            let most = own.degree().unwrap_or(0) / 2;
            let mut low = [MultiPoly::zero(), MultiPoly::zero()];
            for (k, c) in own.coeffs().iter().enumerate() {
                let factor = n.pow(k as u64 / 2) * d.pow((most - k / 2) as u64);
                low[k % 2] = low[k % 2].plus(&c.scaled_by(&factor));
            }
            p = MultiPoly::from_poly_in(&Poly::new(low.to_vec()), i + 1);
        }
        p
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With `sqrt(2)`, `sqrt(3)` and `sqrt(6)` as the variables 1 to 3.
    fn table() -> Symbols {
        let mut symbols = Symbols::new();
        for (name, square) in [("a", 2), ("b", 3), ("c", 6)] {
            symbols.insert(name, Definition::root(square));
        }
        symbols
    }

    fn linear(i: usize) -> MultiPoly {
        MultiPoly::variable(0).minus(&MultiPoly::variable(i))
    }

    #[test]
    fn factors_are_repeated_where_numbers_make_them_so() {
        let (symbols, budget) = (table(), Budget::unlimited());
        let [k, a, b, c] = [0, 1, 2, 3].map(MultiPoly::variable);
        let degree = |p: &MultiPoly| symbols.square_free_part(p, &budget).unwrap().degree_in(0);
        // (K - a)^2 (K - b), the square with 2 for a^2.
        let square = k.times(&k).minus(&a.times(&k).times(&MultiPoly::from(2))).plus(&MultiPoly::from(2));
        assert_eq!(degree(&square.times(&linear(2))), 2);
        // (K - a b)(K - c) is a square, (K - a)(K - b) is none.
        assert_eq!(degree(&k.minus(&a.times(&b)).times(&linear(3))), 1);
        assert_eq!(degree(&linear(1).times(&linear(2))), 2);
        // A leading coefficient that is zero: (a b - c) K^3 + K + 1. Zero, and numbers.
        let vanishing = a.times(&b).minus(&c).times(&k.power(3)).plus(&k).plus(&MultiPoly::one());
        assert_eq!(degree(&vanishing), 1);
        assert_eq!(degree(&a.times(&a).minus(&MultiPoly::one())), 0);
        assert!(symbols.square_free_part(&a.times(&b).minus(&c).times(&k), &budget).unwrap().is_zero());
    }

    #[test]
    fn a_divisor_is_common_to_the_numbers() {
        let (symbols, budget) = (table(), Budget::unlimited());
        let [k, a] = [0, 1].map(MultiPoly::variable);
        // K - a, 2 - a K, and 0 = K (a^2 - 2).
        let zero = k.times(&a.times(&a).minus(&MultiPoly::from(2)));
        let list = [zero, k.minus(&a), MultiPoly::from(2).minus(&a.times(&k))];
        assert_eq!(symbols.greatest_common_divisor(&list, &budget).unwrap().degree_in(0), 1);
        let list = [list[1].clone(), list[2].clone(), k];
        assert_eq!(symbols.greatest_common_divisor(&list, &budget).unwrap().degree_in(0), 0);
    }

    #[test]
    fn a_basis_has_no_common_zero_and_all_zeros() {
        let (symbols, budget) = (table(), Budget::unlimited());
        let [k, a, b] = [0, 1, 2].map(MultiPoly::variable);
        // K^2 - 2, (K - a)(K - b), K - c and K - a b.
        let given =
            [k.times(&k).minus(&MultiPoly::from(2)), linear(1).times(&linear(2)), linear(3), k.minus(&a.times(&b))];
        let basis = symbols.coprime_basis(&given, &budget).unwrap();
        let degrees: Vec<u32> = basis.iter().map(|p| p.degree_in(0)).collect();
        assert_eq!(degrees, [1, 1, 1, 1]);
        let shares = |p: &MultiPoly, q: &MultiPoly| symbols.have_common_zero(p, q, &budget).unwrap();
        for (i, p) in basis.iter().enumerate() {
            assert!(basis[..i].iter().all(|q| !shares(p, q)));
        }
        let counts = given.each_ref().map(|p| basis.iter().filter(|q| shares(p, q)).count());
        assert_eq!(counts, [2, 2, 1, 1]);
    }
}
