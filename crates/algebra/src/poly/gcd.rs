//! Content, primitive part, greatest common divisor, square-free decomposition.

use super::{Domain, Poly, RemainderSequence};
use crate::limits::checkpoint;

impl<R: Domain> Poly<R> {
    /// The greatest common divisor of the coefficients; zero for the zero polynomial.
    pub fn content(&self) -> R {
        checkpoint(4 * self.coeffs().len() as u64);
        let mut content = R::zero();
        for c in self.coeffs().iter().rev() {
            content = content.gcd(c);
            if content.is_one() {
                break;
            }
        }
        content
    }

    /// The polynomial divided by its content, its leading coefficient normalised
    /// (positive over the integers).
    pub fn primitive_part(&self) -> Poly<R> {
        if self.is_zero() {
            return self.clone();
        }
        let primitive = self.div_exact_scalar(&self.content()).expect("the content divides every coefficient");
        if primitive.needs_negation() { primitive.negated() } else { primitive }
    }

    /// The product of the distinct irreducible factors of positive degree, primitive
    /// (characteristic 0: `p / gcd(p, p')`). Zero stays zero, a non-zero constant becomes 1.
    ///
    /// Cost: a greatest common divisor with the derivative, and an exact division.
    pub fn square_free_part(&self) -> Poly<R> {
        if self.is_zero() {
            return self.clone();
        }
        let p = self.primitive_part();
        let g = gcd(&p, &p.derivative());
        if g.is_constant() { p } else { p.div_exact_poly(&g).expect("the gcd divides").primitive_part() }
    }

    /// The square-free decomposition `p = c f_1 f_2^2 f_3^3 ...`: the pairs `(f_i, i)` with `f_i`
    /// of positive degree, primitive, square-free and pairwise coprime (Yun's algorithm [Yun1976](crate::bibliography#yun1976)).
    /// Empty for a constant.
    ///
    /// Cost: a greatest common divisor with the derivative, then one for each multiplicity up to the greatest.
    pub fn square_free_decomposition(&self) -> Vec<(Poly<R>, usize)> {
        let mut out = Vec::new();
        if self.is_constant() {
            return out;
        }
        let exact = |a: &Poly<R>, b: &Poly<R>| a.div_exact_poly(b).expect("a gcd divides both");
        let p = self.primitive_part();
        let derivative = p.derivative();
        let g = gcd(&p, &derivative);
        let mut b = exact(&p, &g);
        let mut d = exact(&derivative, &g).minus(&b.derivative());
        let mut i = 1;
        while !b.is_constant() {
            let f = gcd(&b, &d);
            b = exact(&b, &f);
            d = exact(&d, &f).minus(&b.derivative());
            if !f.is_constant() {
                out.push((f.primitive_part(), i));
            }
            i += 1;
        }
        out
    }
}

/// The greatest common divisor, contents included, normalised.
pub(super) fn gcd<R: Domain>(a: &Poly<R>, b: &Poly<R>) -> Poly<R> {
    let normalise = |p: &Poly<R>| if p.needs_negation() { p.negated() } else { p.clone() };
    if a.is_zero() {
        return normalise(b);
    }
    if b.is_zero() {
        return normalise(a);
    }
    let (content_a, content_b) = (a.content(), b.content());
    let content = content_a.gcd(&content_b);
    if a.is_constant() || b.is_constant() {
        return Poly::constant(content);
    }
    let divide = |p: &Poly<R>, c: &R| p.div_exact_scalar(c).expect("the content divides every coefficient");
    let (a, b) = (divide(a, &content_a), divide(b, &content_b));
    let g = R::primitive_gcd_fast(&a, &b).unwrap_or_else(|| primitive_gcd_subresultant(&a, &b));
    g.primitive_part().scaled(&content)
}

/// The last non-zero subresultant of two primitive polynomials, made primitive: the reference
/// algorithm (Brown and Traub [BrownTraub1971](crate::bibliography#browntraub1971)).
pub(super) fn primitive_gcd_subresultant<R: Domain>(a: &Poly<R>, b: &Poly<R>) -> Poly<R> {
    let (a, b) = if a.degree() >= b.degree() { (a, b) } else { (b, a) };
    let mut sequence = RemainderSequence::new(a.clone(), b.clone());
    while sequence.advance() {
        if sequence.last().is_constant() {
            return Poly::one();
        }
    }
    sequence.last().primitive_part()
}
