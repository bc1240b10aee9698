//! Cofactors of a pair of polynomials: `U A + V B = value`.

use crate::stability::{HalfSizePair, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, Poly, RemainderSequence, Step};

/// `U A + V B = value`, with `U` and `V` coefficients in `x` from the constant term up.
pub(super) struct Identity<P> {
    pub u: Vec<P>,
    pub v: Vec<P>,
    pub value: P,
}

/// The identity of the half-size pair of a polynomial in `z` or `s` of degree `n`.
pub(super) fn of_half_size_pair<P: Domain>(
    d: &Poly<P>,
    n: usize,
    shape: Shape,
    budget: &Budget,
) -> Result<Identity<P>, Exhausted> {
    let pair = HalfSizePair::new(d, n, shape);
    identity(&pair.a, &pair.b, budget)
}

/// The identity by subresultants with their cofactors [BrownTraub1971](jurist_algebra::bibliography#browntraub1971), divided by all that `U` and `V` have
/// in common; `value` is zero if and only if `A` and `B` have a common factor.
fn identity<P: Domain>(a: &Poly<P>, b: &Poly<P>, budget: &Budget) -> Result<Identity<P>, Exhausted> {
    let swapped = a.coeffs().len() < b.coeffs().len();
    let (first, second) = if swapped { (b, a) } else { (a, b) };
    // The last members are s0 first + t0 second and s1 first + t1 second.
    let (mut s0, mut t0, mut s1, mut t1) = (Poly::one(), Poly::zero(), Poly::zero(), Poly::one());
    let mut value = P::zero();
    let mut sequence = (!second.is_zero()).then(|| RemainderSequence::new(first.clone(), second.clone()));
    while let Some(members) = &mut sequence {
        budget.check()?;
        if members.last().is_constant() {
            value = members.last().coeff(0);
            break;
        }
        let Step { factor, quotient, divisor, is_end, .. } = members.advance_with_quotient();
        let next = |x0: &Poly<P>, x1: &Poly<P>| {
            let combined = x0.scaled(&factor).minus(&quotient.times(x1));
            combined.div_exact_scalar(&divisor).expect("the subresultant theorem")
        };
        (s0, s1, t0, t1) = (s1.clone(), next(&s0, &s1), t1.clone(), next(&t0, &t1));
        if is_end {
            break;
        }
    }
    let mut common = P::zero();
    for c in s1.coeffs().iter().chain(t1.coeffs()) {
        if common.is_one() {
            break;
        }
        common = budget.enter(|| common.gcd(c))?;
    }
    let reduced = |p: &Poly<P>| p.div_exact_scalar(&common).expect("a common divisor").into_coeffs();
    let (first, second) = (reduced(&s1), reduced(&t1));
    let (u, v) = if swapped { (second, first) } else { (first, second) };
    Ok(Identity { u, v, value: value.div_exact(&common).expect("a common divisor of both cofactors") })
}
