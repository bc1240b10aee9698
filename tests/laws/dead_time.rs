//! Random loops: the counts that the crossings give, against the walk along the axis and against Pade's approximations.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly, simplest_between};
use jurist_algebra::real::{Real, rational_between};
use jurist_engine::stability::dead_time::{
    DelayCells, GainLoop, Kind, QuasiPolynomial, count_delayed_roots, delay_cells, gain_cells,
};
use jurist_engine::stability::{Range, Shape, count_roots};
use proptest::prelude::*;

fn coefficients(terms: usize) -> impl Strategy<Value = UniPoly> {
    prop::collection::vec(-6i64..=6, terms).prop_map(|c| UniPoly::from_i64(&c))
}

/// A loop of retarded type, or of neutral type with a small difference operator: order one to three, one or two delays.
fn delayed_loop() -> impl Strategy<Value = QuasiPolynomial> {
    (1usize..=3, 1usize..=2, any::<bool>())
        .prop_flat_map(|(order, delays, neutral)| {
            let first = coefficients(order).prop_map(move |p| {
                let mut c = p.into_coeffs();
                c.resize(order, Integer::ZERO);
                c.push(Integer::from(5));
                UniPoly::new(c)
            });
            let others = prop::collection::vec(coefficients(order), delays);
            (first, others, Just((order, neutral)), -2i64..=2)
        })
        .prop_filter_map("a function", |(first, mut others, (order, neutral), top)| {
            if neutral {
                others[0] = others[0].plus(&UniPoly::monomial(Integer::from(top), order));
            }
            QuasiPolynomial::new(std::iter::once(first).chain(others).collect())
        })
}

/// Rational points, one in each cell below a bound.
fn samples(cells: &DelayCells, end: &Rational) -> Vec<Rational> {
    let mut ends = vec![Rational::ZERO];
    for switch in &cells.switches {
        let place = switch.dead_time(120);
        ends.extend([place.lower().clone(), place.upper().clone()]);
    }
    ends.push(end.clone());
    ends.chunks(2).map(|pair| simplest_between(&pair[0], &pair[1]).unwrap()).collect()
}

/// `z` replaced by Pade's approximation of order `m`: a polynomial, in which every root of a low frequency is nearly one of
/// the loop.
fn pade(p: &QuasiPolynomial, tau: &Rational, m: usize) -> UniPoly {
    // sum (2m - k)!/(k! (m - k)!) (tau s)^k, cleared of the denominators of tau.
    let factorial = |n: usize| (1..=n).fold(Integer::ONE, |f, k| f * Integer::from(k as i64));
    let coefficient = |k: usize| {
        let weight = factorial(2 * m - k).div_exact(&(factorial(k) * factorial(m - k)));
        weight * tau.numerator().pow(k as u64) * tau.denominator().pow((m - k) as u64)
    };
    let below = UniPoly::new((0..=m).map(coefficient).collect());
    let above = below.negated_argument();
    p.parts().iter().enumerate().fold(UniPoly::zero(), |sum, (k, part)| {
        let rest = (p.delays() - k) as u64;
        sum.plus(&part.times(&above.power(k as u64)).times(&below.power(rest)))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn counts_by_crossings_and_along_the_axis_agree(p in delayed_loop()) {
        let (budget, end) = (Budget::unlimited(), Rational::from(4));
        if let Ok(cells) = delay_cells(&p, &Rational::ZERO, Some(&end), &budget).unwrap() {
            for (sample, right) in samples(&cells, &end).iter().zip(&cells.right) {
                let count = count_delayed_roots(&p, sample, &budget).unwrap();
                prop_assert_eq!((count.on, count.right), (0, Some(*right)), "{:?} at {}", &p, sample);
            }
        }
    }

    #[test]
    fn small_dead_times_are_those_of_pade(p in delayed_loop()) {
        let (budget, end) = (Budget::unlimited(), Rational::ONE);
        prop_assume!(p.kind() == Kind::Retarded);
        if let Ok(cells) = delay_cells(&p, &Rational::ZERO, Some(&end), &budget).unwrap() {
            for (sample, right) in samples(&cells, &end).iter().zip(&cells.right) {
                let approximation = count_roots(&pade(&p, sample, 12), Shape::LeftHalfPlane);
                prop_assert_eq!(approximation.outside, *right, "{:?} at {}", &p, sample);
            }
        }
    }

    #[test]
    fn gains_have_the_counts_of_their_cells(a in delayed_loop(), b in coefficients(2), tau in 1i64..=6) {
        let budget = Budget::unlimited();
        let zero = UniPoly::zero();
        let mut parts = a.parts().to_vec();
        parts.resize(3, zero.clone());
        let tau = Rational::new(Integer::from(tau), Integer::from(4));
        let gain = GainLoop::new(parts, vec![zero.clone(), b, zero], tau.clone());
        let range = Range::between(Some((-7).into()), Some(7.into()));
        if let Ok(Ok(cells)) = gain_cells(&gain, &range, &budget) {
            let mut ends = vec![Real::from(Rational::from(-7))];
            ends.extend(cells.points.iter().map(|p| p.value.clone()));
            ends.push(Rational::from(7).into());
            for (pair, right) in ends.windows(2).zip(&cells.right) {
                let sample = rational_between(&pair[0], &pair[1], &budget).unwrap().unwrap();
                let count = count_delayed_roots(&gain.at(&sample).unwrap(), &tau, &budget).unwrap();
                // Near the neutral boundary ever more roots lie to the right: they are not counted there.
                let uncounted = right.is_none() && count.right != Some(0);
                prop_assert!(uncounted || count.right == *right, "{:?} at {}: {:?} {:?}", &gain, sample, count.right, right);
            }
        }
    }
}
