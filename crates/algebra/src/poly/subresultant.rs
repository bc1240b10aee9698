//! Resultants and subresultants without fractions.

use super::{Domain, Poly, RemainderSequence};
use crate::limits::{Budget, Exhausted};

/// The resultant of two polynomials of the degrees they have.
///
/// Zero when either is zero; a constant `c` and a polynomial of degree `n` give `c^n`. Chooses between
/// [`resultant_subresultant`] and the faster way that the domain may have ([`Domain::resultant_fast`]).
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn resultant<R: Domain>(a: &Poly<R>, b: &Poly<R>, budget: &Budget) -> Result<R, Exhausted> {
    let (Some(n), Some(m)) = (a.degree(), b.degree()) else { return Ok(R::zero()) };
    match budget.enter(|| R::resultant_fast(a, n, b, m))? {
        Some(value) => Ok(value),
        None => resultant_subresultant(a, b, budget),
    }
}

/// The resultant of two polynomials of the degrees they have, by the subresultant sequence
/// ([BrownTraub1971](crate::bibliography#browntraub1971); Cohen, A Course in Computational Algebraic Number Theory, 3.3.7).
///
/// Zero when either is zero; a constant `c` and a polynomial of degree `n` give `c^n`.
/// `O(n m)` operations on coefficients that are themselves minors of the Sylvester matrix.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn resultant_subresultant<R: Domain>(a: &Poly<R>, b: &Poly<R>, budget: &Budget) -> Result<R, Exhausted> {
    budget.enter(|| by_remainders(a, b))
}

fn by_remainders<R: Domain>(a: &Poly<R>, b: &Poly<R>) -> R {
    let (Some(n), Some(m)) = (a.degree(), b.degree()) else { return R::zero() };
    let odd = |n: usize, m: usize| n % 2 == 1 && m % 2 == 1;
    let (mut negative, mut sequence) = if n >= m {
        (false, RemainderSequence::new(a.clone(), b.clone()))
    } else {
        (odd(n, m), RemainderSequence::new(b.clone(), a.clone()))
    };
    let degree = |p: &Poly<R>| p.coeffs().len() - 1;
    while degree(sequence.last()) > 0 {
        negative ^= odd(degree(sequence.previous()), degree(sequence.last()));
        if !sequence.advance() {
            return R::zero();
        }
    }
    let value = match degree(sequence.previous()) {
        0 => R::one(),
        n => sequence.raised(&sequence.last().coeffs()[0], n as u64),
    };
    if negative { value.negated() } else { value }
}

/// The resultant of two polynomials read with the formal degrees `n` and `m`: the determinant of
/// the Sylvester matrix of size `n + m`, in which leading coefficients may be zero.
///
/// It is the value that specialises: setting a parameter in the coefficients and taking this
/// determinant commute. Zero when both leading coefficients are zero (unless `n + m = 0`, when it is 1).
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When a formal degree is below the degree.
pub fn resultant_formal<R: Domain>(
    a: &Poly<R>,
    n: usize,
    b: &Poly<R>,
    m: usize,
    budget: &Budget,
) -> Result<R, Exhausted> {
    assert!(a.coeffs().len() <= n + 1 && b.coeffs().len() <= m + 1, "the formal degree is below the degree");
    match budget.enter(|| R::resultant_fast(a, n, b, m))? {
        Some(value) => Ok(value),
        None => resultant_formal_subresultant(a, n, b, m, budget),
    }
}

/// [`resultant_formal`] by the subresultant sequence: the reference.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When a formal degree is below the degree.
pub fn resultant_formal_subresultant<R: Domain>(
    a: &Poly<R>,
    n: usize,
    b: &Poly<R>,
    m: usize,
    budget: &Budget,
) -> Result<R, Exhausted> {
    assert!(a.coeffs().len() <= n + 1 && b.coeffs().len() <= m + 1, "the formal degree is below the degree");
    if n + m == 0 {
        return Ok(R::one());
    }
    let (Some(deg_a), Some(deg_b)) = (a.degree(), b.degree()) else {
        // A zero polynomial fills rows with zeros, unless the other's formal degree leaves it none.
        return Ok(match (m, n) {
            (0, _) if a.is_zero() => b.coeff(0).power(n as u64),
            (_, 0) if b.is_zero() => a.coeff(0).power(m as u64),
            _ => R::zero(),
        });
    };
    if deg_a == n && deg_b == m {
        return resultant_subresultant(a, b, budget);
    }
    if deg_a < n && deg_b < m {
        return Ok(R::zero());
    }
    if deg_a < n {
        // Expanding along the first columns: each missing degree of `a` contributes (-1)^m lc(b).
        let factor = b.leading().expect("not zero").power((n - deg_a) as u64);
        let value = factor.times(&resultant_subresultant(a, b, budget)?);
        return Ok(if m % 2 == 1 && (n - deg_a) % 2 == 1 { value.negated() } else { value });
    }
    let factor = a.leading().expect("not zero").power((m - deg_b) as u64);
    Ok(factor.times(&resultant_subresultant(a, b, budget)?))
}

/// The discriminant `(-1)^(n(n-1)/2) Res(p, p') / lc(p)`; 1 for degree 1, zero below.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn discriminant<R: Domain>(p: &Poly<R>, budget: &Budget) -> Result<R, Exhausted> {
    let Some(n) = p.degree().filter(|&n| n > 0) else { return Ok(R::zero()) };
    let r = resultant(p, &p.derivative(), budget)?;
    let value = r.div_exact(p.leading().expect("not zero")).expect("the leading coefficient divides");
    Ok(if n * (n - 1) / 2 % 2 == 1 { value.negated() } else { value })
}

/// The polynomial remainder sequence of subresultants of two non-zero polynomials with
/// `deg a >= deg b`: `a`, `b`, and then the subresultants up to sign, the last one being similar
/// to the greatest common divisor ([BrownTraub1971](crate::bibliography#browntraub1971)).
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When `b` is zero or `deg a < deg b`.
pub fn subresultant_chain<R: Domain>(a: &Poly<R>, b: &Poly<R>, budget: &Budget) -> Result<Vec<Poly<R>>, Exhausted> {
    let mut sequence = RemainderSequence::new(a.clone(), b.clone());
    budget.enter(|| {
        let mut chain = vec![a.clone(), b.clone()];
        while !sequence.last().is_constant() && sequence.advance() {
            chain.push(sequence.last().clone());
        }
        chain
    })
}
