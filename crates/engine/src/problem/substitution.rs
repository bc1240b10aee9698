//! Relative stability: smaller regions, brought back to the unit disc and the left half plane by a
//! substitution in the polynomial's variable.

use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::poly::RationalFunction;

/// `D(r z)`: its roots are those of `D` divided by `r`, so the disc of radius `r` becomes the unit disc.
pub(super) fn scaled_by_radius(d: &CharacteristicPolynomial, r: &RationalFunction) -> CharacteristicPolynomial {
    let mut power = RationalFunction::one();
    let mut coefficients = Vec::with_capacity(d.coefficients.len());
    for c in &d.coefficients {
        coefficients.push(c * &power);
        power = &power * r;
    }
    CharacteristicPolynomial { coefficients, ..d.clone() }
}

/// `D(s - S)`: its roots are those of `D` plus `S`, so `Re s < -S` becomes the left half plane.
pub(super) fn shifted_by_decay(d: &CharacteristicPolynomial, decay: &RationalFunction) -> CharacteristicPolynomial {
    let mut coefficients = d.coefficients.clone();
    let n = coefficients.len();
    let step = -decay;
    for i in 0..n {
        for j in (i..n.saturating_sub(1)).rev() {
            coefficients[j] = &coefficients[j] + &(&coefficients[j + 1] * &step);
        }
    }
    CharacteristicPolynomial { coefficients, ..d.clone() }
}
