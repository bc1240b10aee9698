//! Cofactors of a pair of polynomials: `U A + V B = value`.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, Poly, RemainderSequence, Step, UniPoly};

/// `U A + V B = value`, with `U` and `V` coefficients in `x` from the constant term up.
pub(super) struct Identity {
    pub u: Vec<UniPoly>,
    pub v: Vec<UniPoly>,
    pub value: UniPoly,
}

type InX = Poly<UniPoly>;

/// The identity by subresultants with their cofactors [BrownTraub1971](jurist_algebra::bibliography#browntraub1971), divided by all that `U` and `V` have
/// in common; `value` is zero if and only if `A` and `B` have a common factor.
pub(super) fn identity(a: &InX, b: &InX, budget: &Budget) -> Result<Identity, Exhausted> {
    let swapped = a.coeffs().len() < b.coeffs().len();
    let (first, second) = if swapped { (b, a) } else { (a, b) };
    // The last members are s0 first + t0 second and s1 first + t1 second.
    let (mut s0, mut t0, mut s1, mut t1) = (InX::one(), InX::zero(), InX::zero(), InX::one());
    let mut value = UniPoly::zero();
    let mut sequence = (!second.is_zero()).then(|| RemainderSequence::new(first.clone(), second.clone()));
    while let Some(members) = &mut sequence {
        budget.check()?;
        if members.last().is_constant() {
            value = members.last().coeff(0);
            break;
        }
        let Step { factor, quotient, divisor, is_end, .. } = members.advance_with_quotient();
        let next = |x0: &InX, x1: &InX| {
            let combined = x0.scaled(&factor).minus(&quotient.times(x1));
            combined.div_exact_scalar(&divisor).expect("the subresultant theorem")
        };
        (s0, s1, t0, t1) = (s1.clone(), next(&s0, &s1), t1.clone(), next(&t0, &t1));
        if is_end {
            break;
        }
    }
    let mut common = UniPoly::zero();
    for c in s1.coeffs().iter().chain(t1.coeffs()) {
        budget.check()?;
        common = common.gcd(c);
    }
    let reduced = |p: &InX| p.div_exact_scalar(&common).expect("a common divisor").into_coeffs();
    let (first, second) = (reduced(&s1), reduced(&t1));
    let (u, v) = if swapped { (second, first) } else { (first, second) };
    Ok(Identity { u, v, value: value.div_exact(&common).expect("a common divisor of both cofactors") })
}
