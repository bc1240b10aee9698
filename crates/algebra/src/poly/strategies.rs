//! Generators of polynomials for property tests, with the roots that they were made from.

use super::{Domain, UniPoly};
use crate::number::{Integer, Rational};
use proptest::collection::vec;
use proptest::prelude::*;
use std::cmp::Ordering;

/// A real number `a + s sqrt(d)` with `s` one of -1, 0 and 1: rational when `s = 0`, otherwise `d`
/// is a positive non-square integer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChosenRoot {
    /// The rational part.
    pub rational: Rational,
    /// The sign of the square root.
    pub sign: i8,
    /// What stands under the root.
    pub radicand: u32,
}

impl ChosenRoot {
    /// Exact comparison with a rational number.
    pub fn compare_rational(&self, x: &Rational) -> Ordering {
        // The sign of s sqrt(d) - t with t = x - a.
        let t = x - &self.rational;
        let squares = || Rational::from(self.radicand).cmp(&(&t * &t));
        match (self.sign, t.sign()) {
            (0, t) => t.reverse(),
            (1, Ordering::Greater) => squares(),
            (-1, Ordering::Less) => squares().reverse(),
            (s, _) => s.cmp(&0),
        }
    }

    /// Whether the number is rational.
    pub fn is_rational(&self) -> bool {
        self.sign == 0
    }
}

/// A polynomial and all its real roots, each once, in no particular order.
#[derive(Clone, Debug)]
pub struct KnownRoots {
    /// The polynomial; its roots may be multiple.
    pub polynomial: UniPoly,
    /// Its distinct real roots.
    pub roots: Vec<ChosenRoot>,
}

/// Rational numbers of every kind that gives trouble: small, dyadic, long, close to each other.
pub fn awkward_rational() -> impl Strategy<Value = Rational> {
    let near = |n: i64, k: u64| Rational::from(n) + Rational::new(Integer::ONE, Integer::from(10).pow(k));
    prop_oneof![
        4 => (-20i64..=20, 1i64..=12).prop_map(|(p, q)| Rational::new(p.into(), q.into())),
        2 => (-64i64..=64, 0u64..8).prop_map(|(p, k)| Rational::dyadic(&p.into(), k)),
        1 => (-3i64..=3, 1u64..40).prop_map(move |(n, k)| near(n, k)),
        1 => (any::<i64>(), 1i64..).prop_map(|(p, q)| Rational::new(p.into(), q.into())),
        1 => Just(Rational::ZERO),
        1 => Just(Rational::ONE),
        1 => Just(-Rational::ONE),
    ]
}

/// A non-zero polynomial with exactly the given real roots: a product of linear factors, pairs of
/// quadratic surds, multiplicities up to 3, and a factor without real roots.
pub fn polynomial_with_known_roots() -> impl Strategy<Value = KnownRoots> {
    let rational = vec((awkward_rational(), 1usize..=3), 0..5);
    let surds = vec((awkward_rational(), 2u32..60, 1usize..=2), 0..3);
    let rootless = vec((-9i64..=9, 1u32..40), 0..2);
    let factor = (1i64..1000, any::<bool>());
    (rational, surds, rootless, factor).prop_map(|(rational, surds, rootless, (factor, negative))| {
        let mut polynomial = UniPoly::constant(Integer::from(if negative { -factor } else { factor }));
        let mut roots: Vec<ChosenRoot> = Vec::new();
        let add = |root: ChosenRoot, roots: &mut Vec<ChosenRoot>| {
            if !roots.contains(&root) {
                roots.push(root);
            }
        };
        for (a, multiplicity) in rational {
            let linear = UniPoly::new(vec![-a.numerator(), a.denominator()]);
            polynomial = &polynomial * &linear.power(multiplicity as u64);
            add(ChosenRoot { rational: a, sign: 0, radicand: 0 }, &mut roots);
        }
        for (a, d, multiplicity) in surds {
            let root = d.isqrt();
            if root * root == d {
                continue;
            }
            polynomial = &polynomial * &shifted_square(&a, -i64::from(d)).power(multiplicity as u64);
            for sign in [-1, 1] {
                add(ChosenRoot { rational: a.clone(), sign, radicand: d }, &mut roots);
            }
        }
        for (a, d) in rootless {
            polynomial = &polynomial * &shifted_square(&Rational::from(a), i64::from(d));
        }
        KnownRoots { polynomial, roots }
    })
}

/// A primitive multiple of `(x - a)^2 + d`.
fn shifted_square(a: &Rational, d: i64) -> UniPoly {
    let linear = UniPoly::new(vec![-a.numerator(), a.denominator()]);
    let q = a.denominator();
    &(&linear * &linear) + &UniPoly::constant(&(&q * &q) * &Integer::from(d))
}

/// Any polynomial of degree below `terms` with small coefficients, zero included.
pub fn small_polynomial(terms: usize) -> impl Strategy<Value = UniPoly> {
    vec(-12i64..=12, 0..=terms).prop_map(|c| UniPoly::from_i64(&c))
}

/// Polynomials that are hard on isolation: Mignotte's clusters, nearly double roots, roots at
/// split points, sparse ones, powers of the variable, long coefficients.
pub fn nasty_polynomial() -> impl Strategy<Value = UniPoly> {
    let mignotte = (5usize..16, 2i64..2000).prop_map(|(n, a)| {
        let square = UniPoly::from_i64(&[1, -2 * a, a * a]);
        &UniPoly::monomial(Integer::ONE, n) - &square.scaled(&Integer::from(2))
    });
    let nearly_double = (small_polynomial(5), 1u64..60)
        .prop_map(|(p, k)| &(&p * &p).scaled(&Integer::from(2).pow(k)) - &UniPoly::one());
    let split_points = vec((-16i64..=16, 0u64..5), 1..6).prop_map(|points| {
        let linear = |(p, k): (i64, u64)| UniPoly::new(vec![Integer::from(-p), Integer::from(2).pow(k)]);
        let product = points.into_iter().map(linear).fold(UniPoly::one(), |acc, f| &acc * &f);
        &product * &UniPoly::from_i64(&[-3, 0, 1])
    });
    let in_a_power = (small_polynomial(5), 2usize..5, 0usize..3).prop_map(|(p, h, v)| {
        let mut coeffs = vec![Integer::ZERO; v];
        for c in p.coeffs() {
            coeffs.push(c.clone());
            coeffs.extend(std::iter::repeat_n(Integer::ZERO, h - 1));
        }
        UniPoly::new(coeffs)
    });
    let long = vec((any::<i64>(), 0u64..400), 1..7)
        .prop_map(|c| UniPoly::new(c.into_iter().map(|(a, k)| &Integer::from(a) << k).collect()));
    prop_oneof![mignotte, nearly_double, split_points, in_a_power, long]
}
