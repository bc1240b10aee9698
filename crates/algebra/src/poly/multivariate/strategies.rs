//! Random polynomials in several variables, for property tests.

use super::MultiPoly;
use crate::number::Integer;
use crate::poly::RationalFunction;
use proptest::prelude::*;

/// Coefficients: mostly small, sometimes of about 200 bits.
fn coefficient() -> impl Strategy<Value = Integer> {
    prop_oneof![
        8 => (-9i64..=9).prop_map(Integer::from),
        1 => any::<i64>().prop_map(Integer::from),
        1 => prop::array::uniform3(any::<i64>()).prop_map(|[a, b, c]| {
            &(&Integer::from(a) * &Integer::from(b)) * &Integer::from(c)
        }),
    ]
}

/// A polynomial in variables `0..variables` with exponents up to `max_exponent` and at most
/// `max_terms` terms; may be zero or constant.
pub fn multi_poly(variables: usize, max_exponent: u32, max_terms: usize) -> impl Strategy<Value = MultiPoly> {
    let term = (prop::collection::vec(0..=max_exponent, variables), coefficient());
    prop::collection::vec(term, 0..=max_terms).prop_map(MultiPoly::from_terms)
}

/// As [`multi_poly`], but never zero.
pub fn nonzero_multi_poly(variables: usize, max_exponent: u32, max_terms: usize) -> impl Strategy<Value = MultiPoly> {
    use crate::poly::Domain;
    multi_poly(variables, max_exponent, max_terms).prop_map(|p| if p.is_zero() { MultiPoly::one() } else { p })
}

/// A rational function with numerator and denominator like [`multi_poly`]; one in two has an
/// integer as its denominator.
pub fn rational_function(
    variables: usize,
    max_exponent: u32,
    max_terms: usize,
) -> impl Strategy<Value = RationalFunction> {
    let denominator =
        prop_oneof![(1i64..=60).prop_map(MultiPoly::from), nonzero_multi_poly(variables, max_exponent, max_terms),];
    (multi_poly(variables, max_exponent, max_terms), denominator)
        .prop_map(|(n, d)| RationalFunction::new(n, d).expect("the denominator is not zero"))
}
