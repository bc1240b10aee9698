//! Values of rational functions at algebraic frequencies, as algebraic numbers.

use super::enclosed::{enclosed, within};
use jurist_algebra::limits::{Budget, Exhausted, try_until_shown, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots, resultant};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// A real number: known as such, or as the value of a quotient of polynomials at an algebraic number, of which enclosures are
/// cheap and the polynomial is only computed when it is asked for.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{SquareFree, UniPoly, isolate_real_roots};
/// use jurist_engine::response::Value;
/// let budget = Budget::unlimited();
/// let p = SquareFree::new(UniPoly::from_i64(&[-2, 0, 1])).unwrap();
/// let root = isolate_real_roots(&p, &budget).unwrap().pop().unwrap(); // the square root of 2
/// let value = Value::quotient(&UniPoly::from_i64(&[1, 1]), &UniPoly::from_i64(&[0, 1]), &root); // 1 + 1/x
/// let number = value.number(&budget).unwrap();
/// assert_eq!(number.algebraic().unwrap().polynomial(), &UniPoly::from_i64(&[1, -4, 2]));
/// assert_eq!(value.enclosure(80).decimal(10).unwrap(), "1.707106781");
/// ```
#[derive(Clone, Debug)]
pub enum Value {
    /// The number.
    Number(Real),
    /// `numerator/denominator` at a number that is not rational; neither is zero there.
    Quotient {
        /// The numerator.
        numerator: UniPoly,
        /// The denominator.
        denominator: UniPoly,
        /// Where.
        at: RealAlgebraic,
    },
}

impl Value {
    /// The value at a number.
    ///
    /// # Panics
    /// When numerator and denominator divided by all that they have in common leave a zero of the denominator there.
    pub fn quotient(numerator: &UniPoly, denominator: &UniPoly, at: &RealAlgebraic) -> Value {
        let common = numerator.gcd(denominator);
        let divided = |p: &UniPoly| p.div_exact(&common).expect("a gcd divides");
        let (numerator, denominator) = (divided(numerator), divided(denominator));
        if let Some(x) = at.exact() {
            return Value::from(numerator.eval_rational(&x) / denominator.eval_rational(&x));
        }
        if at.sign_of(&numerator).is_eq() {
            return Value::from(Rational::ZERO);
        }
        assert!(at.sign_of(&denominator).is_ne(), "the denominator has a zero there");
        Value::Quotient { numerator, denominator, at: at.clone() }
    }

    /// Whether it is known to be zero: what is not zero is never zero by its enclosures alone.
    pub(super) fn is_zero(&self) -> bool {
        matches!(self, Value::Number(x) if x.exact().is_some_and(|x| x.is_zero()))
    }

    /// An enclosure with about `bits` significant bits.
    pub fn enclosure(&self, bits: u64) -> Enclosure {
        let narrow = |e: &Enclosure| {
            let size = e.lower().abs().min(e.upper().abs());
            e.lower() == e.upper()
                || (e.lower().sign() == e.upper().sign()
                    && (e.upper() - e.lower()) * Rational::from(&Integer::ONE << bits) <= size)
        };
        match self {
            Value::Number(x) => {
                let (lo, hi) = x.refined_to_digits(bits as usize / 3 + 1).enclosure();
                Enclosure::new(lo, hi)
            }
            Value::Quotient { numerator, denominator, at } => until_shown(bits + 32, |working| {
                let (lo, hi) = at.refined(&Rational::dyadic(&Integer::ONE, working)).enclosure();
                let x = Enclosure::new(lo, hi);
                let value = |p: &UniPoly| p.eval_enclosure(&x, working);
                let quotient = value(numerator).div(&value(denominator), working).filter(&narrow)?;
                Some(quotient.rounded(bits + 2))
            }),
        }
    }

    /// The number with its polynomial.
    ///
    /// Of a quotient the polynomial is the resultant of `y q(x) - p(x)` and the polynomial of `x`.
    ///
    /// Cost: nothing for a number; else a resultant of the degree of `x` and isolation of its roots.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn number(&self, budget: &Budget) -> Result<Real, Exhausted> {
        let (numerator, denominator, at) = match self {
            Value::Number(x) => return Ok(x.clone()),
            Value::Quotient { numerator, denominator, at } => (numerator, denominator, at),
        };
        let terms = numerator.coeffs().len().max(denominator.coeffs().len());
        let coefficient = |i| Poly::new(vec![numerator.coeff(i).negated(), denominator.coeff(i)]);
        let difference: Poly<UniPoly> = Poly::new((0..terms).map(coefficient).collect());
        let over: Poly<UniPoly> = at.polynomial().map(|c| UniPoly::constant(c.clone()));
        let image = resultant(&over, &difference, budget)?;
        let image = budget.enter(|| SquareFree::part_of(&image))?.expect("the quotient is in lowest terms");
        root_within(&image, |bits| self.enclosure(bits), budget).map(Real::from)
    }

    /// The order of two values, decided exactly.
    ///
    /// Cost: enclosures where the values differ clearly; else that of [`Value::number`] for both.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn compare(&self, other: &Value, budget: &Budget) -> Result<Ordering, Exhausted> {
        for bits in [48, 160] {
            let (a, b) = budget.enter(|| (self.enclosure(bits), other.enclosure(bits)))?;
            if a.upper() < b.lower() {
                return Ok(Ordering::Less);
            }
            if a.lower() > b.upper() {
                return Ok(Ordering::Greater);
            }
        }
        self.number(budget)?.compare(&other.number(budget)?, budget)
    }
}

impl From<Rational> for Value {
    fn from(value: Rational) -> Value {
        Value::Number(Real::from(value))
    }
}

/// The root that ever narrower enclosures hold.
fn root_within(
    p: &SquareFree,
    enclose: impl Fn(u64) -> Enclosure,
    budget: &Budget,
) -> Result<RealAlgebraic, Exhausted> {
    let mut roots = isolate_real_roots(p, budget)?;
    try_until_shown(64, |bits| {
        let e = budget.enter(|| enclose(bits))?;
        roots.retain(|x| x.compare_rational(e.lower()).is_ge() && x.compare_rational(e.upper()).is_le());
        assert!(!roots.is_empty(), "the enclosed number is a root");
        Ok((roots.len() == 1).then(|| roots.swap_remove(0)))
    })
}

/// The square root of a number that is not negative.
pub(crate) fn square_root(x: &Real, budget: &Budget) -> Result<Real, Exhausted> {
    let Some(algebraic) = x.algebraic() else {
        let x = x.clone();
        return Ok(enclosed("square root", move |bits| Some(within(&x, bits).sqrt(bits))));
    };
    let mut spread = Vec::new();
    for c in algebraic.polynomial().coeffs() {
        spread.extend([c.clone(), Integer::ZERO]);
    }
    let squared = budget.enter(|| SquareFree::part_of(&Poly::new(spread)))?.expect("not zero");
    let enclose = |bits: u64| {
        let (lo, hi) = algebraic.refined_to_digits(bits as usize / 3 + 1).enclosure();
        Enclosure::new(lo, hi).sqrt(bits)
    };
    root_within(&squared, enclose, budget).map(Real::from)
}

/// The inverse of a number that is not zero.
pub(crate) fn reciprocal(x: &Real, budget: &Budget) -> Result<Real, Exhausted> {
    let one = Enclosure::from_rational(Rational::ONE);
    let Some(algebraic) = x.algebraic() else {
        let x = x.clone();
        return Ok(enclosed("inverse", move |bits| one.div(&within(&x, bits), bits)));
    };
    let Some(n) = algebraic.polynomial().degree().filter(|_| x.exact().is_none()) else {
        return Ok(Real::from(x.exact().and_then(|x| x.recip()).expect("not zero")));
    };
    let inverted = budget.enter(|| SquareFree::part_of(&algebraic.polynomial().reversed(n)))?.expect("not zero");
    let enclose = |bits: u64| {
        let (lo, hi) = algebraic.refined_to_digits(bits as usize / 3 + 1).enclosure();
        one.div(&Enclosure::new(lo, hi), bits).expect("digits tell the sign")
    };
    root_within(&inverted, enclose, budget).map(Real::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roots(coeffs: &[i64]) -> Vec<RealAlgebraic> {
        let p = SquareFree::part_of(&UniPoly::from_i64(coeffs)).unwrap();
        isolate_real_roots(&p, &Budget::unlimited()).unwrap()
    }

    #[test]
    fn roots_and_inverses_undo_squares_and_inverses() {
        let budget = Budget::unlimited();
        for x in roots(&[1, -7, 3, 5, -9, 2]).into_iter().filter(|x| x.sign().is_gt()) {
            let x = Real::from(x);
            let root = square_root(&x, &budget).unwrap();
            let square = Value::quotient(&UniPoly::from_i64(&[0, 0, 1]), &UniPoly::one(), root.algebraic().unwrap());
            assert!(square.number(&budget).unwrap().is_same(&x));
            let inverse = reciprocal(&x, &budget).unwrap();
            assert!(reciprocal(&inverse, &budget).unwrap().is_same(&x));
            assert!(inverse.sign().is_gt());
        }
        let four = Real::from(Rational::from(4));
        assert_eq!(square_root(&four, &budget).unwrap().exact(), Some(Rational::from(2)));
        let zero = Real::from(Rational::ZERO);
        assert_eq!(square_root(&zero, &budget).unwrap().exact(), Some(Rational::ZERO));
    }

    #[test]
    fn equal_values_at_different_places_are_equal() {
        // x^2 at both roots of x^2 - 2, and x^2 - 3 x at both roots of x^2 - 3 x + 1
        let budget = Budget::unlimited();
        let square = UniPoly::from_i64(&[0, 0, 1]);
        let of = |x| Value::quotient(&square, &UniPoly::one(), x);
        let both = roots(&[-2, 0, 1]);
        assert!(of(&both[0]).compare(&of(&both[1]), &budget).unwrap().is_eq());
        let both = roots(&[1, -3, 1]);
        assert!(of(&both[0]).compare(&of(&both[1]), &budget).unwrap().is_lt());
    }
}
