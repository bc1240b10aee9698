//! Laws of margins, on generated loops: each margin against a second way.

use crate::helpers::model::read;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use jurist_engine::model::{Model, Time};
use jurist_engine::response::{DelayMargin, Margins, PhaseMargin, RequiredEnd, Requirement};
use jurist_engine::stability::{ParametricPolynomial, Range, Shape, count_roots, is_stable, stable_set};
use proptest::collection::vec;
use proptest::prelude::*;

fn text(p: &UniPoly, variable: &str) -> String {
    let terms: Vec<String> = p.coeffs().iter().enumerate().map(|(i, c)| format!("({c})*{variable}^{i}")).collect();
    if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") }
}

/// A loop by `D0 + k N`, `k` nominally 1.
fn model(denominator: &UniPoly, numerator: &UniPoly, time: Time) -> Model {
    let (d, n) = (text(denominator, time.variable()), text(numerator, time.variable()));
    let form = format!("characteristic = '{d} + k*({n})'");
    read(&format!("time = '{}'\n[parameters]\nk = {{ nominal = 1 }}\n[loop]\n{form}\n", time.name()))
}

fn margins(denominator: &UniPoly, numerator: &UniPoly, time: Time) -> Margins {
    let asked = model(denominator, numerator, time).ask();
    asked.margins(Some("k"), &Rational::ZERO, &Budget::unlimited()).unwrap().into_value()
}

/// The same as a loop of one block, with a factor in front of the numerator.
fn closed(denominator: &UniPoly, numerator: &UniPoly, time: Time, factor: &str) -> Model {
    let (d, n) = (text(denominator, time.variable()), text(numerator, time.variable()));
    read(&format!(
        "time = '{}'\n[parameters]\nK = {{ nominal = 1 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\n\
         input = 'r - y'\noutput = 'y'\ntransfer = '{factor}({n})/({d})'\n",
        time.name()
    ))
}

/// `|p|^2` on the boundary as a polynomial that mirrors itself.
fn squared(p: &UniPoly, degree: usize, time: Time) -> UniPoly {
    match time {
        Time::Discrete => p.times(&p.reversed(degree)),
        Time::Continuous => p.times(&p.negated_argument()),
    }
}

fn shape(time: Time) -> Shape {
    match time {
        Time::Discrete => Shape::UnitDisc,
        Time::Continuous => Shape::LeftHalfPlane,
    }
}

fn polynomial(terms: std::ops::Range<usize>) -> impl Strategy<Value = UniPoly> {
    vec(-9i64..=9, terms).prop_map(|c| UniPoly::from_i64(&c)).prop_filter("not zero", |p| !p.is_zero())
}

/// A denominator, and a numerator of lower or equal degree that leaves the loop stable.
fn stable_loop() -> impl Strategy<Value = (UniPoly, UniPoly, Time)> {
    let time = prop_oneof![Just(Time::Discrete), Just(Time::Continuous)];
    (polynomial(3..6), polynomial(1..5), time)
        .prop_map(|(closed, numerator, time)| {
            // A closed loop that is stable, less the numerator: about half of all polynomials in continuous time.
            let made = match time {
                Time::Discrete => closed.plus(&UniPoly::from_i64(&[0, 0, 0, 0, 0, 20])),
                Time::Continuous => closed.map(|c| c.abs()).plus(&UniPoly::from_i64(&[1, 7, 12, 8, 2])),
            };
            (made.minus(&numerator), numerator, time)
        })
        .prop_filter("a stable closed loop", |(d, n, time)| is_stable(&d.plus(n), shape(*time)) && !d.is_zero())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(40, 96) as u32))]

    /// `(1 + j t) (D0 + N) + ...`: rotations both ways at once are `(D0 + N)^2 + t^2 (D0 - N)^2`, decided in `t^2`.
    #[test]
    fn the_phase_margin_is_the_first_end_of_the_stable_rotations((d, n, time) in stable_loop()) {
        let found = margins(&d, &n, time).stable.unwrap();
        let (sum, difference) = (d.plus(&n), d.minus(&n));
        let (below, above) = (sum.times(&sum), difference.times(&difference));
        let degree = below.coeffs().len().max(above.coeffs().len()) - 1;
        let coefficient = |i| (Poly::new(vec![below.coeff(i), above.coeff(i)]), UniPoly::one());
        let coefficients: Vec<_> = (0..=degree).map(coefficient).collect();
        let rotations = ParametricPolynomial::new(&coefficients, degree, Vec::new());
        let range = Range::between(Some(Rational::ZERO), None);
        let set = stable_set(&rotations, &range, shape(time), &Budget::unlimited()).unwrap();
        let first = set.intervals().first().and_then(|i| i.upper.clone());
        match (found.phase, first) {
            (PhaseMargin::Unbounded, first) => prop_assert!(first.is_none()),
            (PhaseMargin::Angle { tangent: Some(tangent), .. }, Some(first)) => {
                let tangent = tangent.algebraic().unwrap();
                let square = tangent.polynomial().clone();
                let spread: Vec<Integer> = first.value.algebraic().unwrap().polynomial().coeffs().iter().flat_map(|c| [c.clone(), Integer::ZERO]).collect();
                prop_assert!(tangent.sign_of(&Poly::new(spread)).is_eq(), "{square:?}");
            }
            (PhaseMargin::Angle { tangent: None, .. }, first) => prop_assert!(first.is_none()),
            (phase, first) => prop_assert!(false, "{phase:?} {first:?}"),
        }
    }

    /// `|1 + L|` is above `m` everywhere if `|D0 + N|^2 - m^2 |D0|^2`, a polynomial that mirrors itself, has no root on the boundary.
    #[test]
    fn the_modulus_margin_is_bracketed_by_counts_on_the_boundary((d, n, time) in stable_loop()) {
        let found = margins(&d, &n, time).stable.unwrap();
        let (lo, hi) = found.modulus.refined_to_digits(12).enclosure();
        let step = Rational::dyadic(&Integer::ONE, 40);
        let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
        let on_boundary = |m: Rational| {
            let (up, down) = (m.numerator(), m.denominator());
            let left = squared(&d.plus(&n), degree, time).scaled(&(&down * &down));
            let excess = left.minus(&squared(&d, degree, time).scaled(&(&up * &up)));
            if excess.is_zero() { 0 } else { count_roots(&excess, shape(time)).on }
        };
        prop_assert_eq!(on_boundary(&lo - &step), 0);
        if matches!(found.modulus_at, jurist_engine::response::Extreme::At { attained: true, .. }) {
            prop_assert!(on_boundary(&hi + &step) > 0);
        }
    }

    /// The samples that are borne, by one root count for each number.
    #[test]
    fn whole_samples_are_borne_up_to_the_delay_margin((d, n, time) in stable_loop()) {
        prop_assume!(time == Time::Discrete);
        let found = margins(&d, &n, time).stable.unwrap();
        let is_borne = |m: u64| is_stable(&d.shifted_up(m as usize).plus(&n), Shape::UnitDisc);
        match found.delay {
            DelayMargin::Samples(m) => {
                prop_assert!((0..=m.min(40)).all(is_borne));
                prop_assert!(m > 40 || !is_borne(m + 1));
            }
            DelayMargin::Unbounded | DelayMargin::SamplesAtLeast(_) => prop_assert!((0..20).all(is_borne)),
            other => prop_assert!(false, "{:?}", other),
        }
    }

    /// Three halves of the open loop have two thirds of its gain margins.
    #[test]
    fn gain_margins_scale((d, n, time) in stable_loop()) {
        let (one, two) = (margins(&d, &n, time), margins(&d.scaled(&Integer::from(2)), &n.scaled(&Integer::from(3)), time));
        let (Some(one), Some(two)) = (one.stable, two.stable) else { return Ok(()) };
        let ends = |s: &jurist_engine::stability::StableSet| s.intervals().len();
        prop_assert_eq!(ends(&one.gain.set), ends(&two.gain.set));
        // With more intervals, 1 and 3/2 may lie in different ones.
        let single = one.gain.set.intervals().len() == 1;
        if let (true, Some(a), Some(b)) = (single, &one.gain.upper, &two.gain.upper) {
            // a = 3/2 b
            let scaled = a.value.algebraic().unwrap().polynomial().scaled_argument(&Integer::from(3));
            let k = a.value.algebraic().unwrap().polynomial().coeffs().len() - 1;
            let scaled = Poly::new(scaled.coeffs().iter().enumerate().map(|(i, c)| c * &Integer::from(2).pow((k - i) as u64)).collect::<Vec<_>>());
            prop_assert!(b.value.algebraic().unwrap().sign_of(&scaled).is_eq());
        }
    }

    /// To sixty bits.
    #[test]
    fn the_peak_of_the_sensitivity_is_the_inverse_of_the_modulus_margin((d, n, time) in stable_loop()) {
        let found = margins(&d, &n, time).stable.unwrap();
        let product = found.modulus.refined_to_digits(20).enclosure().0 * found.peak_sensitivity.refined_to_digits(20).enclosure().0;
        let error = (product - Rational::ONE).abs();
        prop_assert!(error < Rational::dyadic(&Integer::ONE, 60));
    }

}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// `|T| < g` everywhere if `|N|^2 - g^2 |D0 + N|^2` has no root on the boundary.
    #[test]
    fn the_peak_gain_is_bracketed_by_counts_on_the_boundary((d, n, time) in stable_loop()) {
        prop_assume!(n.degree() <= d.degree());
        let asked = closed(&d, &n, time, "").ask();
        let peak = asked.norm("r", "y", &Budget::unlimited()).unwrap().into_value().peak.unwrap();
        // From r to y goes the complementary sensitivity.
        let own = margins(&d, &n, time).stable.unwrap().peak_complementary;
        prop_assert!(own.compare(&peak.value, &Budget::unlimited()).unwrap().is_eq());
        let (lo, hi) = peak.value.refined_to_digits(12).enclosure();
        let step = &lo * &Rational::dyadic(&Integer::ONE, 40);
        let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
        let on_boundary = |g: Rational| {
            let (up, down) = (g.numerator(), g.denominator());
            let below = squared(&d.plus(&n), degree, time).scaled(&(&up * &up));
            let excess = squared(&n, degree, time).scaled(&(&down * &down)).minus(&below);
            if excess.is_zero() { 0 } else { count_roots(&excess, shape(time)).on }
        };
        prop_assert_eq!(on_boundary(&hi + &step), 0);
        if matches!(peak.extreme, jurist_engine::response::Extreme::At { attained: true, .. }) {
            prop_assert!(on_boundary(&lo - &step) > 0);
        }
    }

    /// `|H(1)| <= ||H||_oo <= ||H||_1 <= (2 n + 1) ||H||_oo`.
    #[test]
    fn the_peak_to_peak_gain_is_between_the_peak_gain_and_its_multiple((d, n, time) in stable_loop()) {
        prop_assume!(n.degree() <= d.degree());
        let (problem, budget) = (closed(&d, &n, time, "").ask().problem().unwrap(), Budget::unlimited());
        let peak = problem.norm("r", "y", &budget).unwrap().into_value().peak.unwrap().value;
        let sum = problem.peak_to_peak("r", "y", 15, &budget).unwrap().into_value().gain.unwrap();
        let (least, most) = peak.refined_to_digits(30).enclosure();
        let order = d.coeffs().len() as i64 - 1;
        prop_assert!(least <= sum.upper && sum.lower <= most * Rational::from(2 * order + 1));
    }

    /// Inside of the stable set, and a stricter requirement leaves less.
    #[test]
    fn a_required_set_is_inside_the_stable_set((d, n, time) in stable_loop()) {
        prop_assume!(n.degree() <= d.degree());
        let problem = closed(&d, &n, time, "K*").ask().free("K").problem().unwrap();
        let budget = Budget::unlimited();
        let set = |least: i64| {
            let requirement = Requirement::modulus_margin(Rational::new(least.into(), 4.into())).unwrap();
            problem.required_set(&[requirement], None, &budget).unwrap().into_value()
        };
        let (weak, strict) = (set(1), set(3));
        let inside = |i: &jurist_engine::response::RequiredInterval| {
            let end = |end: &Option<RequiredEnd>| end.as_ref().map(|e| e.value().refined_to_digits(9).enclosure());
            match (end(&i.lower), end(&i.upper)) {
                (Some(a), Some(b)) => a.1.midpoint(&b.0),
                (Some(a), None) => a.1 + Rational::ONE,
                (None, Some(b)) => b.0 - Rational::ONE,
                (None, None) => Rational::ZERO,
            }
        };
        for k in weak.intervals.iter().chain(&strict.intervals).map(inside) {
            let at = d.scaled(&k.denominator()).plus(&n.scaled(&k.numerator()));
            prop_assert!(is_stable(&at, shape(time)), "{}", k);
        }
        for k in strict.intervals.iter().map(inside) {
            let holds = |end: &Option<RequiredEnd>, above: bool| {
                end.as_ref().is_none_or(|e| e.value().compare_rational(&k).is_lt() == above)
            };
            prop_assert!(weak.intervals.iter().any(|i| holds(&i.lower, true) && holds(&i.upper, false)), "{}", k);
        }
    }
}
