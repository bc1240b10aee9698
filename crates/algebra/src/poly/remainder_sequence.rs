//! The remainder sequence of subresultants.

use super::{Domain, Poly};

/// The remainder sequence of two polynomials whose members are subresultants up to sign
/// ([BrownTraub1971](crate::bibliography#browntraub1971); Cohen, A Course in Computational Algebraic Number Theory, 3.3.7).
///
/// With `a`, `b` neighbours, `delta` the difference of their degrees and `l` the leading coefficient of `b`, the next
/// member is `(l^(delta + 1) a - q b) / (g h^delta)`, a division without rest that keeps the coefficients minors of the
/// matrix of Sylvester. The sequence ends before the member that is zero; the last one is then similar to the greatest
/// common divisor. `O(n m)` operations on coefficients in all.
///
/// ```
/// use jurist_algebra::poly::{RemainderSequence, UniPoly};
/// let (a, b) = (UniPoly::from_i64(&[-1, 0, 0, 1]), UniPoly::from_i64(&[-1, 0, 1]));
/// let mut sequence = RemainderSequence::new(a, b); // x^3 - 1 and x^2 - 1
/// assert!(sequence.advance());
/// assert_eq!(sequence.last(), &UniPoly::from_i64(&[-1, 1]));
/// assert!(!sequence.advance());
/// ```
#[derive(Clone, Debug)]
pub struct RemainderSequence<R: Domain> {
    a: Poly<R>,
    b: Poly<R>,
    g: R,
    h: R,
}

impl<R: Domain> RemainderSequence<R> {
    /// The sequence that begins with `a` and `b`.
    ///
    /// # Panics
    /// When `b` is zero or `deg a < deg b`.
    pub fn new(a: Poly<R>, b: Poly<R>) -> Self {
        assert!(!b.is_zero() && a.degree() >= b.degree(), "the first polynomial has the higher degree");
        RemainderSequence { a, b, g: R::one(), h: R::one() }
    }

    /// The last member but one.
    pub fn previous(&self) -> &Poly<R> {
        &self.a
    }

    /// The last member; never zero.
    pub fn last(&self) -> &Poly<R> {
        &self.b
    }

    /// Adds a member; `false` when it would be zero.
    pub fn advance(&mut self) -> bool {
        let remainder = self.a.pseudo_rem(&self.b);
        !remainder.is_zero() && self.push(remainder)
    }

    /// Adds a member, unless it would be zero, and tells how it was made.
    pub fn advance_with_quotient(&mut self) -> Step<R> {
        let delta = self.delta();
        let factor = self.b.leading().expect("not zero").power(delta + 1);
        let (quotient, remainder) = self.a.pseudo_div_rem(&self.b);
        let divisor = self.g.times(&self.h.power(delta));
        let is_end = remainder.is_zero() || !self.push(remainder);
        Step { factor, quotient, divisor, is_end }
    }

    fn delta(&self) -> u64 {
        (self.a.coeffs().len() - self.b.coeffs().len()) as u64
    }

    fn push(&mut self, remainder: Poly<R>) -> bool {
        let delta = self.delta();
        let divisor = self.g.times(&self.h.power(delta));
        let next = remainder.div_exact_scalar(&divisor).expect("the subresultant theorem");
        self.a = std::mem::replace(&mut self.b, next);
        self.g = self.a.leading().expect("not zero").clone();
        self.h = self.raised(&self.g, delta);
        true
    }

    /// `x^delta / h^(delta - 1)`, which is `h` for `delta = 0`: the resultant, when the last member is the constant `x`
    /// and the one before has the degree `delta`.
    pub(super) fn raised(&self, x: &R, delta: u64) -> R {
        match delta {
            0 => self.h.clone(),
            1 => x.clone(),
            _ => x.power(delta).div_exact(&self.h.power(delta - 1)).expect("the subresultant theorem"),
        }
    }
}

/// How a member of a [`RemainderSequence`] was made: it is `(factor a - quotient b) / divisor` with `a`, `b` the two
/// members before it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Step<R: Domain> {
    /// A power of the leading coefficient of `b`.
    pub factor: R,
    /// The pseudo-quotient.
    pub quotient: Poly<R>,
    /// What divides every coefficient of `factor a - quotient b`.
    pub divisor: R,
    /// Whether the difference is zero: no member was added, and `b` is similar to the greatest common divisor.
    pub is_end: bool,
}
