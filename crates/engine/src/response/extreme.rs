//! The least and the greatest value of a modulus over all frequencies.

use super::place::inner;
use super::{Place, Value};
use crate::stability::{Shape, zeros_in};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, UniPoly};
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
    Constant(Rational),
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
        extreme(a, b, shape, Ordering::Greater, budget)
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
        extreme(a, b, shape, Ordering::Less, budget)
    }

    /// The value; `None` where it is infinite.
    pub fn value(&self) -> Option<Value> {
        match self {
            Extreme::Constant(value) => Some(Value::from(value.clone())),
            Extreme::Infinite(_) => None,
            Extreme::At { value, .. } => Some(value.clone()),
        }
    }

    /// Where it is; `None` for a constant.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Extreme::Constant(_) => None,
            Extreme::Infinite(place) | Extreme::At { place, .. } => Some(place),
        }
    }
}

fn extreme(a: &UniPoly, b: &UniPoly, shape: Shape, wanted: Ordering, budget: &Budget) -> Result<Extreme, Exhausted> {
    assert!(!b.is_zero(), "a modulus over zero");
    let common = budget.enter(|| a.gcd(b))?;
    let divided = |p: &UniPoly| p.div_exact(&common).expect("a gcd divides");
    let (a, b) = (divided(a), divided(b));
    let slope = a.derivative().times(&b).minus(&a.times(&b.derivative()));
    if slope.is_zero() {
        let constant = |p: &UniPoly| p.coeff(0);
        return Ok(Extreme::Constant(Rational::new(constant(&a), constant(&b))));
    }
    let critical = zeros_in(&slope, &inner(shape), budget)?;
    let places = critical.into_iter().rev().map(Place::Inside);
    let places = std::iter::once(Place::Lowest).chain(places).chain(std::iter::once(Place::Highest));
    let mut best: Option<(Place, Value, bool)> = None;
    for place in places {
        // A zero of the denominator inside is a double one, hence critical.
        let Some(value) = budget.enter(|| Value::at_place(&a, &b, &place, shape))? else {
            if wanted == Ordering::Greater {
                return Ok(Extreme::Infinite(place));
            }
            continue;
        };
        let attained = !matches!((&place, shape), (Place::Highest, Shape::LeftHalfPlane));
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
