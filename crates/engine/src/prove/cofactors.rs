//! Cofactors of a pair of polynomials: `U A + V B = value`.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, Poly, UniPoly};

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
    let (mut r0, mut r1) = if swapped { (b.clone(), a.clone()) } else { (a.clone(), b.clone()) };
    // r0 = s0 first + t0 second, r1 = s1 first + t1 second
    let (mut s0, mut t0, mut s1, mut t1) = (InX::one(), InX::zero(), InX::zero(), InX::one());
    let (mut g, mut h) = (UniPoly::one(), UniPoly::one());
    while !r1.is_constant() {
        budget.check()?;
        let delta = (r0.coeffs().len() - r1.coeffs().len()) as u64;
        let (quotient, rest) = r0.pseudo_div_rem(&r1);
        let lead = r1.leading().expect("not zero").power(delta + 1);
        let divisor = g.times(&h.power(delta));
        let exact = |p: InX| p.div_exact_scalar(&divisor).expect("the subresultant theorem");
        let s2 = exact(s0.scaled(&lead).minus(&quotient.times(&s1)));
        let t2 = exact(t0.scaled(&lead).minus(&quotient.times(&t1)));
        let r2 = exact(rest);
        (r0, r1, s0, s1, t0, t1) = (r1, r2, s1, s2, t1, t2);
        g = r0.leading().expect("not zero").clone();
        h = match delta {
            0 => h,
            1 => g.clone(),
            _ => g.power(delta).div_exact(&h.power(delta - 1)).expect("the subresultant theorem"),
        };
    }
    let value = r1.coeff(0);
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
