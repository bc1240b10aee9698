//! Generators for property tests: polynomials and parametric loops whose verdict is known by construction.

use super::{RootCount, Shape};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use proptest::collection::vec;
use proptest::prelude::*;
use std::cmp::Ordering;

/// A factor with known roots.
#[derive(Clone, Debug)]
pub enum ChosenFactor {
    /// The root `p/q`, `q > 0`.
    Real(i64, i64),
    /// The roots `(a +- b i)/c`, `b > 0`, `c > 0`.
    Pair(i64, i64, i64),
}

impl ChosenFactor {
    /// The integer polynomial with these roots.
    pub fn polynomial(&self) -> UniPoly {
        match *self {
            ChosenFactor::Real(p, q) => UniPoly::from_i64(&[-p, q]),
            ChosenFactor::Pair(a, b, c) => UniPoly::from_i64(&[a * a + b * b, -2 * a * c, c * c]),
        }
    }

    /// Where the roots lie with respect to a region: `Less` inside, `Equal` on, `Greater` outside.
    pub fn place(&self, region: Shape) -> Ordering {
        match (self, region) {
            (ChosenFactor::Real(p, q), Shape::UnitDisc) => p.abs().cmp(q),
            (ChosenFactor::Real(p, _), Shape::LeftHalfPlane) => p.cmp(&0),
            (ChosenFactor::Pair(a, b, c), Shape::UnitDisc) => (a * a + b * b).cmp(&(c * c)),
            (ChosenFactor::Pair(a, _, _), Shape::LeftHalfPlane) => a.cmp(&0),
        }
    }

    /// How many roots it has.
    pub fn degree(&self) -> usize {
        match self {
            ChosenFactor::Real(..) => 1,
            ChosenFactor::Pair(..) => 2,
        }
    }
}

/// One factor; roots at 0, 1, -1, on the circle, on the imaginary axis and in mirror pairs are frequent.
pub fn chosen_factor() -> impl Strategy<Value = ChosenFactor> {
    prop_oneof![
        3 => (-12i64..=12, 1i64..=9).prop_map(|(p, q)| ChosenFactor::Real(p, q)),
        1 => prop_oneof![Just((0, 1)), Just((1, 1)), Just((-1, 1)), Just((2, 1)), Just((1, 2))]
            .prop_map(|(p, q)| ChosenFactor::Real(p, q)),
        3 => (-9i64..=9, 1i64..=9, 1i64..=9).prop_map(|(a, b, c)| ChosenFactor::Pair(a, b, c)),
        // Pythagorean triples: pairs exactly on the unit circle; and pairs on the imaginary axis.
        1 => prop_oneof![Just((3, 4, 5)), Just((-5, 12, 13)), Just((0, 1, 1)), Just((0, 2, 3)), Just((8, 15, 17))]
            .prop_map(|(a, b, c)| ChosenFactor::Pair(a, b, c)),
    ]
}

/// A polynomial of degree 0 to about `2 * factors` as a constant times chosen factors, and the factors.
pub fn polynomial_with_chosen_roots(factors: usize) -> impl Strategy<Value = (UniPoly, Vec<ChosenFactor>)> {
    let constant = prop_oneof![Just(1i64), Just(-1), 2i64..=30, -30i64..=-2];
    (constant, vec(chosen_factor(), 0..=factors)).prop_map(|(c, factors)| {
        let p = factors.iter().fold(UniPoly::constant(Integer::from(c)), |p, f| p.times(&f.polynomial()));
        (p, factors)
    })
}

/// The root count that follows from the chosen factors.
pub fn expected_count(factors: &[ChosenFactor], region: Shape) -> RootCount {
    let mut count = RootCount::default();
    for f in factors {
        match f.place(region) {
            Ordering::Less => count.inside += f.degree(),
            Ordering::Equal => count.on += f.degree(),
            Ordering::Greater => count.outside += f.degree(),
        }
    }
    count
}

/// A root, or a pair of roots, that moves with the parameter `K`: the chosen factor's roots times
/// `alpha + beta K` (unit disc), or shifted by it (left half plane).
#[derive(Clone, Debug)]
pub struct MovingFactor {
    /// The factor at rest.
    pub factor: ChosenFactor,
    /// The constant part.
    pub alpha: i64,
    /// The slope.
    pub beta: i64,
}

/// A loop in one parameter as a product of moving factors.
#[derive(Clone, Debug)]
pub struct ChosenLoop {
    /// The region of stability.
    pub region: Shape,
    /// The factors.
    pub factors: Vec<MovingFactor>,
}

impl ChosenLoop {
    /// The characteristic polynomial over the integers.
    pub fn polynomial(&self) -> Poly<UniPoly> {
        self.factors.iter().fold(Poly::one(), |product, f| {
            let motion = UniPoly::from_i64(&[f.alpha, f.beta]);
            let constants = f.factor.polynomial().map(|c| UniPoly::constant(c.clone()));
            product.times(&match self.region {
                // c^2 z^2 - 2 a c m z + (a^2 + b^2) m^2: the roots times m.
                Shape::UnitDisc => {
                    let n = f.factor.degree();
                    let scaled = constants.coeffs().iter().enumerate();
                    Poly::new(scaled.map(|(k, c)| c.times(&motion.power((n - k) as u64))).collect())
                }
                Shape::LeftHalfPlane => constants.taylor_shift(&motion.negated()),
            })
        })
    }

    /// Whether all roots are strictly inside the region at a value of the parameter.
    pub fn is_stable_at(&self, k: &Rational) -> bool {
        self.factors.iter().all(|f| {
            let m = Rational::from(f.alpha) + Rational::from(f.beta) * k;
            match (&f.factor, self.region) {
                (ChosenFactor::Real(p, q), Shape::UnitDisc) => (Rational::from(*p) * m).abs() < Rational::from(*q),
                (ChosenFactor::Pair(a, b, c), Shape::UnitDisc) => {
                    Rational::from(a * a + b * b) * &m * &m < Rational::from(c * c)
                }
                (ChosenFactor::Real(p, q), Shape::LeftHalfPlane) => {
                    (Rational::from(*p) / Rational::from(*q) + m).is_negative()
                }
                (ChosenFactor::Pair(a, _, c), Shape::LeftHalfPlane) => {
                    (Rational::from(*a) / Rational::from(*c) + m).is_negative()
                }
            }
        })
    }
}

/// A loop of up to `factors` moving factors.
pub fn chosen_loop(region: Shape, factors: usize) -> impl Strategy<Value = ChosenLoop> {
    let moving =
        (chosen_factor(), -3i64..=3, -3i64..=3).prop_map(|(factor, alpha, beta)| MovingFactor { factor, alpha, beta });
    vec(moving, 0..=factors).prop_map(move |factors| ChosenLoop { region, factors })
}
