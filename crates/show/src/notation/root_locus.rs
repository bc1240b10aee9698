//! The form `1 + K num/den` of a characteristic polynomial.

use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};

/// Coefficients from the constant term up.
type Coefficients = Vec<RationalFunction>;

/// `(num, den)` with the polynomial a multiple of `den + K num`, where `K` is variable `i`; `None` when
/// the polynomial is not linear in it. The multiple is 1 unless a coefficient's denominator contains `K`.
///
/// ```
/// use jurist_algebra::matrix::CharacteristicPolynomial;
/// use jurist_algebra::poly::RationalFunction;
/// use jurist_show::notation::root_locus_form;
/// let k = RationalFunction::variable(0);
/// // z - 1 + K/2
/// let half_k = k.checked_div(&2.into()).unwrap();
/// let p = CharacteristicPolynomial {
///     variables: vec!["K".into()],
///     coefficients: vec![&half_k - &1.into(), 1.into()],
///     formal_degree: 1,
///     poles: vec![],
///     monic: true,
/// };
/// let (num, den) = root_locus_form(&p, 0).unwrap();
/// assert_eq!(num[0].display(&["K"]).to_string(), "1/2");
/// assert_eq!(den, vec![(-1).into(), 1.into()]);
/// ```
pub fn root_locus_form(p: &CharacteristicPolynomial, i: usize) -> Option<(Coefficients, Coefficients)> {
    let free = |c: &RationalFunction| c.denominator().degree_in(i) == 0;
    if p.coefficients.iter().all(free) {
        let parts = p.coefficients.iter().map(|c| split(c.numerator(), c.denominator(), i));
        return parts.collect::<Option<Vec<_>>>().map(|parts| parts.into_iter().unzip());
    }
    let (cleared, _) = p.cleared();
    let one = MultiPoly::one();
    let parts = (0..p.coefficients.len()).map(|k| split(&cleared.coeff(k), &one, i));
    parts.collect::<Option<Vec<_>>>().map(|parts| parts.into_iter().unzip())
}

/// The factor of variable `i` and the rest of a polynomial over a denominator without that variable.
fn split(numerator: &MultiPoly, denominator: &MultiPoly, i: usize) -> Option<(RationalFunction, RationalFunction)> {
    let in_variable = numerator.as_poly_in(i);
    if in_variable.degree().is_some_and(|d| d > 1) {
        return None;
    }
    let over = |p: MultiPoly| RationalFunction::new(p, denominator.clone());
    Some((over(in_variable.coeff(1))?, over(in_variable.coeff(0))?))
}
