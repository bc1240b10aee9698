//! The polynomials in the parameter at whose zeros the number of stable roots may change.

use super::{Cause, HalfSizePair, ParametricPolynomial, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, SquareFree, UniPoly};

/// One boundary: a square-free polynomial in the parameter and what happens at its zeros.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{Cause, ParametricPolynomial, Shape, boundary_polynomials};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let boundaries = boundary_polynomials(&p, Shape::UnitDisc, &Budget::unlimited()).unwrap().unwrap();
/// assert_eq!(boundaries[0].cause, Cause::RootAtOne);
/// assert_eq!(boundaries[0].polynomial.poly(), &UniPoly::from_i64(&[0, 1])); // D(1) = K
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Boundary {
    /// What happens at the zeros; for `complex pair` it may also be a mirror pair off the boundary.
    pub cause: Cause,
    /// The polynomial.
    pub polynomial: SquareFree,
}

/// The boundaries of a loop with one parameter, or `None` when the loop is stable nowhere because
/// a root lies on the boundary, a mirror pair exists, or degree is lost for every parameter value.
///
/// Between two neighbouring zeros of these polynomials no root crosses the region's boundary, so one
/// exact count decides the whole gap. Conversely a zero next to a stable gap is never stable: there all
/// roots are in the closed region by continuity, and two roots that mirror each other in the boundary
/// then lie on it.
///
/// Of a root at the ends of the boundary the values of the polynomial there tell, of complex pairs the critical
/// constraint ([JuryPavlidis1963](jurist_algebra::bibliography#jurypavlidis1963),
/// [Orlando1911](jurist_algebra::bibliography#orlando1911)).
///
/// Cost: one resultant ([`HalfSizePair::critical_constraint`]) of degree up to `(n - 1) d` for order `n` and
/// coefficients of degree `d`, and a square-free part of each boundary.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Shape, boundary_polynomials};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let boundaries = boundary_polynomials(&p, Shape::UnitDisc, &Budget::unlimited()).unwrap().unwrap();
/// let causes: Vec<&str> = boundaries.iter().map(|boundary| boundary.cause.name()).collect();
/// assert_eq!(causes, ["z=1", "z=-1"]);
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn boundary_polynomials(
    p: &ParametricPolynomial,
    region: Shape,
    budget: &Budget,
) -> Result<Option<Vec<Boundary>>, Exhausted> {
    let n = p.formal_degree();
    if p.is_zero() || p.polynomial().degree() != Some(n) {
        return Ok(None);
    }
    budget.step("boundary polynomials");
    let mut found = Vec::new();
    if n > 0 {
        let value = |x: i64| p.polynomial().eval(&UniPoly::constant(Integer::from(x)));
        match region {
            Shape::UnitDisc => {
                found.push((Cause::RootAtOne, value(1)));
                found.push((Cause::RootAtMinusOne, value(-1)));
            }
            Shape::LeftHalfPlane => found.push((Cause::RootAtZero, value(0))),
        }
        if found.iter().any(|(_, b)| b.is_zero()) {
            return Ok(None);
        }
        let pair = HalfSizePair::new(p.polynomial(), n, region);
        found.push((Cause::ComplexPair, pair.critical_constraint(budget)?));
    }
    found.push((Cause::DegreeLost, p.degree_loss().clone()));
    found.push((Cause::Pole, p.denominator().clone()));
    found.extend(p.poles().iter().map(|q| (Cause::Pole, q.clone())));
    let mut boundaries: Vec<Boundary> = Vec::new();
    for (cause, polynomial) in found {
        budget.check()?;
        let Some(polynomial) = budget.enter(|| SquareFree::part_of(&polynomial))? else { return Ok(None) };
        if polynomial.degree() > 0 && !boundaries.iter().any(|b| b.cause == cause && b.polynomial == polynomial) {
            boundaries.push(Boundary { cause, polynomial });
        }
    }
    Ok(Some(boundaries))
}
