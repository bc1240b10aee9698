//! A characteristic polynomial with one parameter left, ready to be decided.

use super::{RootCount, Shape, count_roots};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, UniPoly};

/// A polynomial in `z` (or `s`) whose coefficients are rational functions of one parameter `p`.
///
/// It is held as `content * polynomial / denominator` with `polynomial` over the integers and
/// without a common factor in `p`, together with the parameter values at which the loop is
/// undefined and the degree the polynomial is meant to have.
///
/// ```
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Shape};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// assert!(p.is_stable_at(&1.into(), Shape::UnitDisc) && !p.is_stable_at(&2.into(), Shape::UnitDisc));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ParametricPolynomial {
    polynomial: Poly<UniPoly>,
    content: UniPoly,
    denominator: UniPoly,
    degree_loss: UniPoly,
    formal_degree: usize,
    poles: Vec<UniPoly>,
}

/// What is known of the polynomial at one value of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum AtPoint {
    /// An expression of the model divides by zero.
    Undefined,
    /// The polynomial vanishes identically.
    Zero,
    /// The polynomial with its root count; `infinite` roots are missing from the formal degree.
    Defined {
        /// Finite roots by place.
        count: RootCount,
        /// How many degrees are lost.
        infinite: usize,
    },
    /// A loop with dead time, whose roots to the left are infinitely many.
    Delayed {
        /// Roots on the imaginary axis.
        on: usize,
        /// Roots to the right of it; `None` where infinitely many lie there or come as near to it as one likes.
        right: Option<usize>,
    },
}

impl AtPoint {
    /// Whether all roots of a polynomial of this degree are inside.
    pub fn is_stable(&self, degree: usize) -> bool {
        match self {
            AtPoint::Defined { count, infinite: 0 } => count.inside == degree,
            AtPoint::Delayed { on, right } => (*on, *right) == (0, Some(0)),
            _ => false,
        }
    }
}

impl ParametricPolynomial {
    /// From coefficients `numerator / denominator` for `z^0` first, the polynomials whose zeros make
    /// the loop undefined, and the degree of the polynomial in all parameters.
    ///
    /// Cost: `O(n)` greatest common divisors of polynomials in the parameter.
    ///
    /// # Panics
    /// When a denominator or a pole polynomial is zero, or a coefficient above `formal_degree` is not.
    pub fn new(coefficients: &[(UniPoly, UniPoly)], formal_degree: usize, poles: Vec<UniPoly>) -> Self {
        assert!(poles.iter().all(|p| !p.is_zero()), "a pole polynomial vanishes identically");
        let mut reduced = Vec::with_capacity(coefficients.len());
        let mut denominator = UniPoly::one();
        for (numerator, den) in coefficients {
            assert!(!den.is_zero(), "a denominator is zero");
            let g = numerator.gcd(den);
            let divide = |p: &UniPoly| p.div_exact(&g).expect("a gcd divides");
            let (mut num, mut den) =
                if numerator.is_zero() { (UniPoly::zero(), UniPoly::one()) } else { (divide(numerator), divide(den)) };
            if den.needs_negation() {
                (num, den) = (num.negated(), den.negated());
            }
            let common = denominator.gcd(&den);
            denominator = denominator.times(&den.div_exact(&common).expect("a gcd divides"));
            reduced.push((num, den));
        }
        let cleared =
            |(num, den): &(UniPoly, UniPoly)| num.times(&denominator.div_exact(den).expect("a common multiple"));
        let full = Poly::new(reduced.iter().map(cleared).collect());
        assert!(full.coeffs().len() <= formal_degree + 1, "the formal degree is below the degree");
        let content = full.content();
        let polynomial = if content.is_one() || full.is_zero() {
            full
        } else {
            full.div_exact_scalar(&content).expect("the content divides")
        };
        let degree_loss = reduced.get(formal_degree).map_or_else(UniPoly::zero, |(num, _)| num.clone());
        ParametricPolynomial { polynomial, content, denominator, degree_loss, formal_degree, poles }
    }

    /// A polynomial over the integers in `z` and the parameter, defined everywhere.
    ///
    /// # Panics
    /// When `formal_degree` is below the degree.
    pub fn from_integral(polynomial: &Poly<UniPoly>, formal_degree: usize) -> Self {
        let coefficients: Vec<_> = polynomial.coeffs().iter().map(|c| (c.clone(), UniPoly::one())).collect();
        ParametricPolynomial::new(&coefficients, formal_degree, Vec::new())
    }

    /// The polynomial without denominators and without content.
    pub fn polynomial(&self) -> &Poly<UniPoly> {
        &self.polynomial
    }

    /// What was divided out of the numerator: zero where all coefficients vanish.
    pub fn content(&self) -> &UniPoly {
        &self.content
    }

    /// The least common denominator of the coefficients in lowest terms.
    pub fn denominator(&self) -> &UniPoly {
        &self.denominator
    }

    /// The numerator of the coefficient of the formal degree: zero where degree is lost.
    pub fn degree_loss(&self) -> &UniPoly {
        &self.degree_loss
    }

    /// The degree the polynomial is meant to have.
    pub fn formal_degree(&self) -> usize {
        self.formal_degree
    }

    /// Polynomials whose zeros make the loop undefined, the denominator aside.
    pub fn poles(&self) -> &[UniPoly] {
        &self.poles
    }

    /// Whether all coefficients vanish for every parameter value.
    pub fn is_zero(&self) -> bool {
        self.polynomial.is_zero()
    }

    /// The polynomial at a value of the parameter, as an integer polynomial up to a non-zero factor;
    /// meaningful where the loop is defined and the content does not vanish.
    ///
    /// Cost: `O(n d)` products of numbers up to `d` times as long as the value, `d` the degree in the parameter,
    /// and `O(n)` greatest common divisors.
    pub fn specialised(&self, value: &Rational) -> UniPoly {
        let height = self.polynomial.coeffs().iter().filter_map(UniPoly::degree).max().unwrap_or(0);
        let (p, q) = (value.numerator(), value.denominator());
        let mut q_powers = vec![Integer::ONE];
        for k in 1..=height {
            q_powers.push(if q.is_one() { Integer::ONE } else { &q_powers[k - 1] * &q });
        }
        let at = |c: &UniPoly| {
            let Some(d) = c.degree() else { return Integer::ZERO };
            let mut acc = Integer::ZERO;
            for (k, a) in c.coeffs().iter().enumerate().rev() {
                acc *= &p;
                acc.add_mul_assign(a, &q_powers[d - k]);
            }
            if d == height { acc } else { acc * &q_powers[height - d] }
        };
        let special = self.polynomial.map(at);
        let content = special.content();
        if content.is_zero() { special } else { special.div_exact_scalar(&content).expect("the content divides") }
    }

    /// Whether an expression of the model divides by zero at this value.
    pub fn is_undefined_at(&self, value: &Rational) -> bool {
        let vanishes = |p: &UniPoly| p.sign_at(value).is_eq();
        vanishes(&self.denominator) || self.poles.iter().any(vanishes)
    }

    /// The exact root count at a value of the parameter.
    ///
    /// Cost: that of [`ParametricPolynomial::specialised`] and of [`count_roots`].
    pub fn at(&self, value: &Rational, region: Shape) -> AtPoint {
        if self.is_undefined_at(value) {
            return AtPoint::Undefined;
        }
        let special = self.specialised(value);
        if special.is_zero() || self.content.sign_at(value).is_eq() {
            return AtPoint::Zero;
        }
        let count = count_roots(&special, region);
        AtPoint::Defined { count, infinite: self.formal_degree - count.total() }
    }

    /// Whether the loop is stable at a value of the parameter: defined, of full degree, all roots
    /// inside the region.
    ///
    /// Cost: that of [`ParametricPolynomial::at`].
    pub fn is_stable_at(&self, value: &Rational, region: Shape) -> bool {
        matches!(self.at(value, region), AtPoint::Defined { count, infinite: 0 } if count.inside == self.formal_degree)
    }
}
