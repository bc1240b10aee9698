//! Polynomials over symbols that are algebraic numbers, without these symbols.

use super::{Definition, Function, Symbols};
use crate::limits::{Budget, Exhausted};
use crate::number::Integer;
use crate::poly::{Domain, MultiPoly, Poly, UniPoly, resultant_formal};

/// A symbol stays where a polynomial without it may have more terms.
const MOST_TERMS: u64 = 30_000;

impl Symbols {
    /// A polynomial that is zero wherever this one is, without the symbols that are algebraic numbers, or algebraic over others: its norm
    /// over them. Symbol `i` is variable `first + i`. Numbers that coincide because of what these symbols are, as over a
    /// square root, are zeros of a common factor then.
    ///
    /// A symbol stays without which the polynomial would be too long, or zero.
    ///
    /// Cost: a resultant with the polynomial of each such symbol ([Loos1983](crate::bibliography#loos1983)).
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::{Domain, MultiPoly};
    /// use jurist_algebra::symbols::{Definition, Symbols};
    /// let mut symbols = Symbols::new();
    /// symbols.insert("r", Definition::root(2));
    /// // K - r, with K as variable 0: K^2 - 2.
    /// let p = MultiPoly::variable(0).minus(&MultiPoly::variable(1));
    /// let norm = symbols.norm(&p, 1, &Budget::unlimited()).unwrap();
    /// assert_eq!(norm.display(&["K".to_owned()]).to_string(), "K^2 - 2");
    /// ```
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn norm(&self, f: &MultiPoly, first: usize, budget: &Budget) -> Result<MultiPoly, Exhausted> {
        let mut norm = f.clone();
        // Later symbols may be made of earlier ones.
        for i in (0..self.len()).rev() {
            let own = norm.as_poly_in(first + i);
            let degree = own.degree().unwrap_or(0);
            let Some(minimal) = polynomial_of(self.definition(i), first).filter(|_| degree > 0) else { continue };
            let terms = Function::resultant(own.coeffs().to_vec(), minimal.coeffs().to_vec()).expanded_size();
            if terms > MOST_TERMS {
                continue;
            }
            let found = resultant_formal(&own, degree, &minimal, minimal.degree().unwrap_or(0), budget)?;
            if !found.is_zero() {
                norm = budget.enter(|| found.primitive_over_integers())?;
            }
        }
        Ok(norm)
    }

    /// Whether all symbols are algebraic numbers.
    pub fn are_algebraic(&self) -> bool {
        let is_algebraic = |i| matches!(self.definition(i), Definition::Algebraic(_) | Definition::Root(_));
        (0..self.len()).all(is_algebraic)
    }

    /// Whether of some symbols nothing but enclosures is known: then no identity shows that a polynomial in them is zero.
    pub fn has_enclosed_numbers(&self) -> bool {
        (0..self.len()).any(|i| matches!(self.definition(i), Definition::Enclosed(_) | Definition::Family(_)))
    }
}

/// A polynomial that the symbol is a zero of, over symbols that are variables from `first` on.
fn polynomial_of(definition: &Definition, first: usize) -> Option<Poly<MultiPoly>> {
    match definition {
        Definition::Algebraic(x) => Some(x.polynomial().map(|c: &Integer| MultiPoly::constant(c.clone()))),
        Definition::Root(x) => {
            let [above, below] = [x.numerator(), x.denominator()].map(|p| p.map_variables(|i| first + i));
            Some(Poly::new(vec![above.negated(), MultiPoly::zero(), below]))
        }
        _ => None,
    }
}

impl Symbols {
    /// The polynomial in the unknown (variable 0, symbols from 1 on) that a polynomial's zeros are zeros of; `None` where symbols remain.
    pub(super) fn norm_in_unknown(&self, p: &MultiPoly, budget: &Budget) -> Result<Option<UniPoly>, Exhausted> {
        let is_algebraic = |i: usize| i == 0 || polynomial_of(self.definition(i - 1), 1).is_some();
        if !p.variables().into_iter().all(is_algebraic) {
            return Ok(None);
        }
        Ok(self.norm(p, 1, budget)?.to_univariate(0))
    }
}

/// Bits that an algebraic number is computed with beyond the bound of its polynomial's zeros.
const GUARD_BITS: u64 = 64;

/// Bits beyond which numbers are not computed.
const MOST_BITS: u64 = 1 << 16;

impl Symbols {
    /// Whether a polynomial in symbols that are algebraic numbers, roots of roots among them, is shown to be zero: it is a zero of its
    /// norm, and nearer to 0 than all zeros of that but 0.
    pub(super) fn is_zero_algebraic_number(&self, p: &MultiPoly, budget: &Budget) -> Result<bool, Exhausted> {
        let difference = MultiPoly::variable(0).minus(&p.map_variables(|i| i + 1));
        let Some(norm) = self.norm_in_unknown(&difference, budget)? else { return Ok(false) };
        let zeros = norm.coeffs().iter().take_while(|c| c.is_zero()).count();
        let Some((least, rest)) = norm.coeffs()[zeros..].split_first().filter(|_| zeros > 0) else { return Ok(false) };
        // Cauchy's bound: other zeros are at least |c_0|/(|c_0| + max |c_k|), which is more than 2^-bits.
        let most = rest.iter().map(Integer::bit_length).max().unwrap_or(0).max(least.bit_length());
        let bits = (most + 2).saturating_sub(least.bit_length()) + 1;
        let working = bits + GUARD_BITS;
        if working > MOST_BITS {
            return Ok(false);
        }
        let value = budget.enter(|| self.enclose(p, working))?;
        Ok(value.magnitude_units().bit_length() + bits < working)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Rational;
    use crate::poly::RationalFunction;

    /// `sqrt(3 + 2 sqrt(2)) - 1 - sqrt(2)` is zero, and with `3 + 2^-40` it is not.
    #[test]
    fn roots_of_roots_are_zero_where_their_polynomial_says_so() {
        let budget = Budget::unlimited();
        for (more, is_zero) in [(0, true), (1, false)] {
            let mut symbols = Symbols::new();
            symbols.insert("a", Definition::root(2));
            let three = Rational::new((Integer::from(3) << 40) + Integer::from(more), Integer::ONE << 40);
            let inner = &RationalFunction::from(three) + &(&RationalFunction::from(2) * &RationalFunction::variable(0));
            symbols.insert("b", Definition::Root(inner));
            let [a, b] = [0, 1].map(MultiPoly::variable);
            let p = b.minus(&a).minus(&MultiPoly::one());
            assert_eq!(symbols.is_zero(&p, &budget).unwrap(), is_zero);
            assert_eq!(symbols.is_zero_algebraic_number(&p, &budget).unwrap(), is_zero);
            assert!(!symbols.is_zero_algebraic_number(&b, &budget).unwrap());
        }
    }

    #[test]
    fn symbols_made_of_others_are_eliminated_before_them() {
        // a = sqrt(2), b = sqrt(1 + a), x = exp(-1); K - b: K^4 - 2 K^2 - 1.
        let mut symbols = Symbols::new();
        symbols.insert("a", Definition::root(2));
        symbols.insert("b", Definition::Root(&RationalFunction::one() + &RationalFunction::variable(0)));
        symbols.insert("x", Definition::exponential(-1));
        let [k, a, b, x] = [0, 1, 2, 3].map(MultiPoly::variable);
        let budget = Budget::unlimited();
        let shown = |p: &MultiPoly| {
            let norm = symbols.norm(p, 1, &budget).unwrap();
            norm.display(&["K".to_owned(), "a".to_owned(), "b".to_owned(), "x".to_owned()]).to_string()
        };
        assert_eq!(shown(&k.minus(&b)), "K^4 - 2*K^2 - 1");
        assert_eq!(shown(&k.minus(&a.times(&x))), "K^2 - 2*x^2");
        assert!(symbols.norm_in_unknown(&k.minus(&x), &budget).unwrap().is_none());
        // Zero for one of both square roots: the symbol stays.
        let zero = a.times(&a).minus(&MultiPoly::from(2)).times(&k);
        assert_eq!(symbols.norm(&zero, 1, &budget).unwrap(), zero);
    }
}
