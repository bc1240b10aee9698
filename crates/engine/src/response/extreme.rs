//! The least and the greatest value of a modulus over all frequencies.

use super::ground::{Ground, Integers};
use super::open_loop::OpenLoop;
use super::parts::with_parts;
use super::value::square_root;
use super::{Frequencies, Place, Value};
use crate::stability::{Range, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// An extreme value of the square of a modulus.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_engine::response::{Extreme, Place};
/// use jurist_engine::stability::Shape;
/// // |1/(s + 1)|^2 = 1/(1 - x) with x = s^2: 1 at s = 0
/// let (one, below) = (UniPoly::from_i64(&[1]), UniPoly::from_i64(&[1, -1]));
/// let budget = Budget::unlimited();
/// let greatest = Extreme::greatest(&one, &below, Shape::LeftHalfPlane, &budget).unwrap();
/// assert!(matches!(greatest, Extreme::At { place: Place::Lowest, attained: true, .. }));
/// let least = Extreme::least(&one, &below, Shape::LeftHalfPlane, &budget).unwrap();
/// assert!(matches!(least, Extreme::At { place: Place::Highest, attained: false, .. }));
/// ```
#[derive(Clone, Debug)]
pub enum Extreme {
    /// The same at all frequencies.
    Constant(Value),
    /// Infinite, at a pole on the boundary.
    Infinite(Place),
    /// At one frequency, the lowest of several.
    At {
        /// Where.
        place: Place,
        /// The value.
        value: Value,
        /// `false` where it is only approached, as the frequency grows without end.
        attained: bool,
    },
}

impl Extreme {
    /// The greatest value of `a/b`, polynomials in `x` that are squares of moduli on the boundary.
    ///
    /// Cost: isolation of the zeros of `a' b - a b'`.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    ///
    /// # Panics
    /// When `b` is zero.
    pub fn greatest(a: &UniPoly, b: &UniPoly, shape: Shape, budget: &Budget) -> Result<Extreme, Exhausted> {
        extreme_over(&Integers, [a, b], &UniPoly::gcd, shape.into(), Ordering::Greater, budget)
    }

    /// The least value, of a quotient that is not infinite at all frequencies.
    ///
    /// Cost: that of [`Extreme::greatest`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    ///
    /// # Panics
    /// When `b` is zero.
    pub fn least(a: &UniPoly, b: &UniPoly, shape: Shape, budget: &Budget) -> Result<Extreme, Exhausted> {
        extreme_over(&Integers, [a, b], &UniPoly::gcd, shape.into(), Ordering::Less, budget)
    }

    /// The value; `None` where it is infinite.
    pub fn value(&self) -> Option<Value> {
        match self {
            Extreme::Infinite(_) => None,
            Extreme::Constant(value) | Extreme::At { value, .. } => Some(value.clone()),
        }
    }

    /// The square root of the value, which is not infinite: of a modulus whose square it is the extreme of.
    pub(super) fn root(&self, budget: &Budget) -> Result<Real, Exhausted> {
        square_root(&self.value().expect("a finite extreme").number(budget)?, budget)
    }

    /// Where it is; `None` for a constant.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Extreme::Constant(_) => None,
            Extreme::Infinite(place) | Extreme::At { place, .. } => Some(place),
        }
    }
}

/// A greatest common divisor of two polynomials.
type Common<'c, R> = &'c dyn Fn(&Poly<R>, &Poly<R>) -> Poly<R>;

/// The extreme value of `a/b` that is `wanted` of all others.
pub(crate) fn extreme_over<G: Ground>(
    ground: &G,
    [a, b]: [&Poly<G::Number>; 2],
    common: Common<'_, G::Number>,
    frequencies: Frequencies,
    wanted: Ordering,
    budget: &Budget,
) -> Result<Extreme, Exhausted> {
    assert!(!b.is_zero(), "a modulus over zero");
    let both = budget.enter(|| common(a, b))?;
    let divided = |p: &Poly<G::Number>| p.div_exact(&both).expect("a gcd divides");
    let (a, b) = (divided(a), divided(b));
    // Without a common factor the quotient is constant where both are.
    if a.is_constant() && b.is_constant() {
        return Ok(match ground.sign(&a.coeff(0), budget)?.is_eq() {
            true => Extreme::Constant(Value::from(Rational::ZERO)),
            false => Extreme::Constant(ground.quotient(&a.coeff(0), &b.coeff(0), budget)?),
        });
    }
    let Critical { places, zeros, infinite } = Critical::of(ground, [&a, &b], common, &frequencies.inner(), budget)?;
    let mut best: Option<(Place, Value, bool)> = None;
    for (i, place) in frequencies.places(places).into_iter().enumerate() {
        let Some(value) = ground.value(&a, &b, &place, frequencies, budget)? else {
            if wanted == Ordering::Greater {
                return Ok(Extreme::Infinite(place));
            }
            continue;
        };
        if let (Ordering::Greater, 0, Some(pole)) = (wanted, i, infinite.last()) {
            return Ok(Extreme::Infinite(Place::Inside(pole.clone())));
        }
        if let (Ordering::Less, 0, Some(zero)) = (wanted, i, zeros.last())
            && !value.is_zero()
        {
            return Ok(Extreme::At {
                place: Place::Inside(zero.clone()),
                value: Rational::ZERO.into(),
                attained: true,
            });
        }
        let attained = !matches!((&place, frequencies.shape()), (Place::Highest, Shape::LeftHalfPlane));
        let better = match &best {
            None => true,
            Some((_, known, _)) => value.compare(known, budget)? == wanted,
        };
        if better {
            best = Some((place, value, attained));
        }
    }
    let (place, value, attained) = best.expect("not infinite at all frequencies");
    Ok(Extreme::At { place, value, attained })
}

/// Where a quotient of squares of moduli may have its extremes.
struct Critical {
    /// Zeros of the slope at which neither polynomial is zero.
    places: Vec<Real>,
    /// The double zeros of the numerator.
    zeros: Vec<Real>,
    /// The double zeros of the denominator.
    infinite: Vec<Real>,
}

impl Critical {
    /// A zero of either polynomial inside is a double one, hence critical: what the slope a' b - a b' and b have in common is what b' and b
    /// have, since a and b have nothing, and so for a. The sign of a there would be that of zero, which constants do not show.
    fn of<G: Ground>(
        ground: &G,
        [a, b]: [&Poly<G::Number>; 2],
        common: Common<'_, G::Number>,
        range: &Range,
        budget: &Budget,
    ) -> Result<Critical, Exhausted> {
        let [nulls, poles] = budget.enter(|| [a, b].map(|p| common(&p.derivative(), p)))?;
        let inside =
            |p: &Poly<G::Number>| if p.is_constant() { Ok(Vec::new()) } else { ground.zeros(p, range, budget) };
        let (zeros, infinite) = (inside(&nulls)?, inside(&poles)?);
        let are_plain = nulls.is_constant() && poles.is_constant();
        let unexpanded = if are_plain { ground.extremes([a, b], range, budget)? } else { None };
        let places = match unexpanded {
            Some(places) => places,
            None => {
                let slope = a.derivative().times(b).minus(&a.times(&b.derivative()));
                let divided = slope.div_exact(&nulls.times(&poles)).expect("both divide the slope");
                ground.zeros(&divided, range, budget)?
            }
        };
        Ok(Critical { places, zeros, infinite })
    }
}

/// The least value of `|1 + L|^2`.
pub(super) fn modulus_extreme(open_loop: &OpenLoop, budget: &Budget) -> Result<Extreme, Exhausted> {
    with_parts!(open_loop, parts => {
        let r = &parts.reduced;
        let quotient = [&r.sum_squared, &r.denominator_squared];
        extreme_over(&parts.ground, quotient, &|a, b| r.common(a, b), r.frequencies, Ordering::Less, budget)
    })
}

/// The greatest value of `|L/(1 + L)|^2`.
pub(super) fn complementary_extreme(open_loop: &OpenLoop, budget: &Budget) -> Result<Extreme, Exhausted> {
    with_parts!(open_loop, parts => {
        let r = &parts.reduced;
        let quotient = [&r.numerator_squared, &r.sum_squared];
        extreme_over(&parts.ground, quotient, &|a, b| r.common(a, b), r.frequencies, Ordering::Greater, budget)
    })
}
