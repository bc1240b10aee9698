use super::reference;
use super::{AbsoluteSum, ImpulseResponse};
use jurist_algebra::ball::{Ball, exp};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational, to_decimal};
use jurist_algebra::poly::{Domain, UniPoly};
use proptest::prelude::*;

fn sum_of(numerator: &UniPoly, denominator: &UniPoly, digits: usize) -> AbsoluteSum {
    ImpulseResponse::of_integers(numerator, denominator).absolute_sum(digits, &Budget::unlimited()).unwrap()
}

fn sum(numerator: &[i64], denominator: &[i64], digits: usize) -> AbsoluteSum {
    sum_of(&UniPoly::from_i64(numerator), &UniPoly::from_i64(denominator), digits)
}

fn exactly(numerator: &[i64], denominator: &[i64]) -> String {
    sum(numerator, denominator, 9).exact.expect("exactly").to_string()
}

fn rational(text: &str) -> Rational {
    text.parse().unwrap()
}

#[test]
fn sums_that_are_rational_are_found() {
    // 1/(z - 1/2), and the same with the other sign of the pole.
    assert_eq!(exactly(&[2], &[-1, 2]), "2");
    assert_eq!(exactly(&[-6], &[1, 2]), "6");
    // Nothing, a constant, a delay, a difference of samples; common factors, also one that is not stable.
    assert_eq!(exactly(&[], &[-1, 2]), "0");
    assert_eq!(exactly(&[-3], &[7]), "3/7");
    assert_eq!(exactly(&[2], &[0, 0, 0, 3]), "2/3");
    assert_eq!(exactly(&[1, -3, 2], &[0, 0, -5]), "6/5");
    assert_eq!(exactly(&[-4, 2], &[2, -5, 2]), "2");
    // 1/((z - 9/10)(z - 1/2)): all samples are positive.
    assert_eq!(exactly(&[20], &[9, -28, 20]), "20");
    // (z - 9/10)/((z - 1/2)(z + 4/5)): signs alternate in the end, and the first two are 1 and -6/5.
    let found = sum(&[-9, 10], &[-4, 3, 10], 9);
    let [lower, upper] = reference::bracket(&UniPoly::from_i64(&[-9, 10]), &UniPoly::from_i64(&[-4, 3, 10]), 60);
    assert!(lower <= found.lower && found.upper <= upper && found.exact.is_some());
    // (z - 1)/(z - 1/2): h_0 = 1, and all later samples are negative.
    assert_eq!(exactly(&[-2, 2], &[-1, 2]), "2");
}

/// `z (z - 0.9)/D` with the controller (4096 z - 4095)/(8192 (z - 1)) and the plant 0.1/(z - 0.9).
#[test]
#[ignore = "long: CI runs it"]
fn a_slow_integrator_of_few_bits_has_its_gain_at_frequency_0() {
    // D = 81920 (z - 1)(z - 9/10) + 4096 z - 4095.
    let d = UniPoly::from_i64(&[73728 - 4095, -155648 + 4096, 81920]);
    let n = UniPoly::from_i64(&[0, -73728, 81920]);
    assert_eq!(sum_of(&n, &d, 20).exact, Some(8192.into()));
    assert_eq!(n.eval_rational(&Rational::ONE).checked_div(&d.eval_rational(&Rational::ONE)), Some(8192.into()));
    // The other way: without the proof of signs.
    let bracket = enclosed(&n, &d, 20);
    assert!(bracket.exact.is_none() && bracket.lower <= 8192.into() && bracket.upper >= 8192.into());
    assert!(&bracket.upper - &bracket.lower < rational("1/1000000000000000000"));
}

/// The bracket, also where the sum is known as a rational number.
fn enclosed(numerator: &UniPoly, denominator: &UniPoly, digits: usize) -> AbsoluteSum {
    if numerator.is_zero() {
        return sum_of(numerator, denominator, digits);
    }
    let both = [numerator.clone(), denominator.clone()];
    let balls = |p: &UniPoly, bits| p.coeffs().iter().map(|c| Ball::from_integer(c, bits)).collect();
    let response = ImpulseResponse::by_enclosures(move |bits| Some(both.each_ref().map(|p| balls(p, bits))));
    response.absolute_sum(digits, &Budget::unlimited()).unwrap()
}

#[test]
fn sums_with_turning_signs_have_certified_digits() {
    let found = sum(&[0, 2], &[1, -2, 2], 40); // z/(z^2 - z + 1/2)
    let third = Rational::new(10.into(), 3.into());
    assert!(found.lower < third && third < found.upper && found.exact.is_none());
    let width = &found.upper - &found.lower;
    assert!(width < rational("1/1000000000000000000000000000000000000000"));
    let found = sum(&[10], &[7, -15, 10], 24); // 1/(z^2 - 1.5 z + 0.7)
    let known = jurist_algebra::number::parse_number("9.2732747328169420907119971").unwrap();
    let last = jurist_algebra::number::parse_number("1e-25").unwrap();
    assert!(&known - &last < found.lower && found.upper < known + last);
}

#[test]
fn a_slow_pair_has_twenty_digits() {
    // |z| = 0.999, with an angle of about a tenth: (z - 0.994)^2 + 0.0998^2, in 1e-8.
    let d = UniPoly::from_i64(&[98803600 + 996004, -198800000, 100000000]);
    let found = sum_of(&UniPoly::from_i64(&[100000000]), &d, 20);
    assert!(found.terms > 10_000);
    assert_eq!(jurist_algebra::number::enclosed_decimal(&found.lower, &found.upper, 20).unwrap().len(), 21);
}

#[test]
#[ignore = "long: CI runs it"]
fn a_pole_next_to_the_circle_obeys_the_budget() {
    // (z - 1 + 1e-6)^2 + 1e-14: a pair next to 1.
    let d = UniPoly::from_i64(&[99_999_800_000_101, -199_999_800_000_000, 100_000_000_000_000]);
    let response = ImpulseResponse::of_integers(&UniPoly::from_i64(&[1]), &d);
    assert!(response.absolute_sum(20, &Budget::with_work(20_000_000)).is_err());
    assert!(response.signs(1 << 30, &Budget::with_work(20_000_000)).is_err());
}

#[test]
fn a_small_gain_has_as_many_digits() {
    let small = Integer::from(10).pow(60);
    let d = UniPoly::from_i64(&[7, -15, 10]).scaled(&small);
    let found = sum_of(&UniPoly::from_i64(&[10]), &d, 12);
    let scaled = found.lower.midpoint(&found.upper) * Rational::from(small);
    assert_eq!(to_decimal(&scaled, 12), "9.27327473282");
}

#[test]
fn signs_are_those_of_the_samples() {
    let (n, d) = (UniPoly::from_i64(&[0, 2]), UniPoly::from_i64(&[1, -2, 2]));
    let signs = ImpulseResponse::of_integers(&n, &d).signs(40, &Budget::unlimited()).unwrap();
    let expected: Vec<i8> = reference::samples(&n, &d, 40).iter().map(|h| h.sign() as i8).collect();
    assert_eq!(signs, expected);
    assert_eq!(signs[..9], [0, 1, 1, 1, 0, -1, -1, -1, 0]);
}

/// 1/(2 z^2 - e z + 1) with `e = exp(-1/10)`, which is next to 0.904837.
#[test]
fn coefficients_that_are_not_rational_are_enclosed() {
    let response = ImpulseResponse::by_enclosures(|bits| {
        let whole = |n: i64| Ball::from_integer(&n.into(), bits);
        let e = exp(&Ball::from_rational(&rational("-1/10"), bits));
        Some([vec![whole(1)], vec![whole(1), e.neg(), whole(2)]])
    });
    let found = response.absolute_sum(12, &Budget::unlimited()).unwrap();
    let near = sum(&[1_000_000], &[1_000_000, -904_837, 2_000_000], 12);
    assert!((found.lower - near.lower).abs() < rational("1/100000"));
    assert_eq!(response.signs(5, &Budget::unlimited()).unwrap(), [0, 0, 1, 1, -1]);
}

#[test]
fn a_numerator_that_is_zero_by_an_identity_is_not_decided() {
    let response = ImpulseResponse::by_enclosures(|bits| {
        let root = Ball::from_integer(&2.into(), bits).sqrt()?;
        let zero = root.square().sub(&Ball::from_integer(&2.into(), bits));
        Some([vec![zero], vec![Ball::from_integer(&(-1).into(), bits), Ball::from_integer(&2.into(), bits)]])
    });
    assert!(response.absolute_sum(6, &Budget::unlimited()).unwrap_err().stop.is_precision());
}

/// Stable denominators from their roots: rational ones, and pairs `a +- b i` with `a^2 + b^2 < 1`.
fn stable() -> impl Strategy<Value = UniPoly> {
    let real = (-19i64..20).prop_map(|a| UniPoly::from_i64(&[-a, 20]));
    let pair = (-13i64..14, 1i64..14).prop_map(|(a, b)| UniPoly::from_i64(&[a * a + b * b, -40 * a, 400]));
    let factor = prop_oneof![2 => real, 1 => pair];
    proptest::collection::vec(factor, 0..4).prop_map(|all| all.iter().fold(UniPoly::one(), |p, q| p.times(q)))
}

/// A proper transfer function.
fn transfer() -> impl Strategy<Value = [UniPoly; 2]> {
    (stable(), proptest::collection::vec(-9i64..10, 1..8)).prop_map(|(d, mut n)| {
        n.truncate(d.coeffs().len());
        [UniPoly::from_i64(&n), d]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if std::env::var_os("JURIST_THOROUGH").is_some() { 64 } else { 20 }))]

    #[test]
    fn a_single_pole_has_the_sum_of_a_geometric_series(c in -50i64..51, p in -39i64..40) {
        let closed = Rational::new((40 * c.abs()).into(), (40 - p.abs()).into());
        prop_assert_eq!(sum(&[40 * c], &[-p, 40], 10).exact, Some(closed));
    }

    #[test]
    fn the_fast_bracket_overlaps_the_slow_one([n, d] in transfer()) {
        let [lower, upper] = reference::bracket(&n, &d, 120);
        for found in [sum_of(&n, &d, 8), enclosed(&n, &d, 8)] {
            prop_assert!(found.lower <= upper && lower <= found.upper);
            prop_assert!(n.is_zero() || &(&found.upper - &found.lower) * &Rational::from(10i64.pow(10)) <= found.lower);
        }
        let (exact, narrow) = (sum_of(&n, &d, 8), enclosed(&n, &d, 25));
        if let Some(exact) = exact.exact {
            prop_assert!(narrow.lower <= exact && exact <= narrow.upper);
        }
    }

    #[test]
    fn a_factor_scales_and_a_delay_leaves_the_sum([n, d] in transfer(), c in 1i64..9, k in 0usize..4) {
        let (plain, scaled) = (enclosed(&n, &d, 12), enclosed(&n.scaled(&Integer::from(-c)), &d.shifted_up(k), 12));
        let factor = Rational::from(c);
        prop_assert!(&plain.lower * &factor <= scaled.upper && scaled.lower <= &plain.upper * &factor);
    }

    #[test]
    fn a_cascade_has_at_most_the_product_of_the_sums([n, d] in transfer(), [a, b] in transfer()) {
        let (first, second, both) = (sum_of(&n, &d, 12), sum_of(&a, &b, 12), sum_of(&n.times(&a), &d.times(&b), 12));
        prop_assert!(both.lower <= first.upper * second.upper);
    }

    #[test]
    fn the_sum_is_not_below_the_gain_at_both_ends_of_the_frequencies([n, d] in transfer()) {
        let found = sum_of(&n, &d, 12);
        for end in [Rational::ONE, Rational::from(-1)] {
            let gain = n.eval_rational(&end).checked_div(&d.eval_rational(&end)).unwrap();
            prop_assert!(gain.abs() <= found.upper);
        }
    }

    #[test]
    fn the_input_of_signs_reaches_the_sum([n, d] in transfer()) {
        let response = ImpulseResponse::of_integers(&n, &d);
        let signs = response.signs(60, &Budget::unlimited()).unwrap();
        for (sign, sample) in signs.iter().zip(reference::samples(&n, &d, 60)) {
            prop_assert!(*sign == sample.sign() as i8 || *sign == 0);
        }
    }
}

/// Stable denominators in `s`: real roots and pairs of any damping, and a numerator of at most their degree.
fn continuous() -> impl Strategy<Value = [UniPoly; 2]> {
    let real = (1i64..30, 1i64..10).prop_map(|(a, b)| UniPoly::from_i64(&[a, b]));
    let pair = (1i64..10, 0i64..20).prop_map(|(a, b)| UniPoly::from_i64(&[a * a + b * b, 2 * a, 1]));
    let factors = proptest::collection::vec(prop_oneof![real, pair], 1..4);
    (factors, proptest::collection::vec(-9i64..10, 1..7)).prop_map(|(factors, mut n)| {
        let d = factors.iter().fold(UniPoly::one(), |p, q| p.times(q));
        n.truncate(d.coeffs().len());
        [UniPoly::from_i64(&n), d]
    })
}

fn integral_of(n: &UniPoly, d: &UniPoly, digits: usize) -> AbsoluteSum {
    ImpulseResponse::of_integers(n, d).absolute_integral(digits, &Budget::unlimited()).unwrap()
}

fn integral(n: &[i64], d: &[i64], digits: usize) -> String {
    let found = integral_of(&UniPoly::from_i64(n), &UniPoly::from_i64(d), digits);
    assert!(found.exact.is_some() || &found.upper - &found.lower <= found.lower.clone() * rational("1/1000"));
    jurist_algebra::number::enclosed_decimal(&found.lower, &found.upper, digits)
        .unwrap_or_else(|| to_decimal(&found.lower.midpoint(&found.upper), digits))
}

#[test]
fn integrals_that_are_known_are_found() {
    // Nothing, a constant, one pole, equal poles, a factor that is not stable and cancels.
    assert_eq!(integral(&[], &[1, 2], 9), "0");
    assert_eq!(integral(&[-3], &[7], 3), "0.429");
    assert_eq!(integral(&[2], &[1, 2], 12), "2.00000000000");
    assert_eq!(integral(&[-1], &[1, 4, 6, 4, 1], 12), "1.00000000000");
    assert_eq!(integral(&[-1, 1], &[-1, 0, 1], 12), "1.00000000000");
    // (1 - s)/(1 + s) is -1 and twice a lag: 1 + 2. (2 - s)/(1 + s) is -1 and three times a lag.
    assert_eq!(integral(&[1, -1], &[1, 1], 12), "3.00000000000");
    assert_eq!(integral(&[2, -1], &[1, 1], 12), "4.00000000000");
    // s/(s + 1)^2 is (1 - t) exp(-t): 2/e. 1/(s + 1) - 1/(s + 2) is of one sign.
    assert_eq!(integral(&[0, 1], &[1, 2, 1], 20), "0.73575888234288464319");
    assert_eq!(integral(&[1], &[2, 3, 1], 12), "0.500000000000");
    // (s^2 + 1)/(s + 1)^3 is exp(-t) (t - 1)^2, whose zero touches: 1.
    assert_eq!(integral(&[1, 0, 1], &[1, 3, 3, 1], 15), "1.00000000000000");
}

#[test]
fn a_pair_has_the_integral_of_its_overshoots() {
    // 1/(s^2 + s + 1): coth(pi/(2 sqrt(3))); time in other units is the same.
    let known = "1.389582";
    assert_eq!(integral(&[1], &[1, 1, 1], 7), known);
    assert_eq!(integral(&[1_000_000_000_000], &[1_000_000_000_000, 1_000_000, 1], 7), known);
    assert_eq!(integral(&[1], &[1, 1_000_000, 1_000_000_000_000], 7), known);
}

#[test]
fn poles_far_from_each_other_have_their_integral() {
    // 1/((s + 1)(s/1000 + 1)) - 2/(s + 1) has the integral of its gain at 0, which is 1: the response is negative from its start.
    assert_eq!(integral(&[-1000, -2], &[1000, 1001, 1], 12), "1.00000000000");
    let response = ImpulseResponse::of_integers(&UniPoly::from_i64(&[1]), &UniPoly::from_i64(&[1, 1_000_000_000, 1]));
    assert!(response.absolute_integral(9, &Budget::with_work(1_000_000)).is_err());
}

/// The step response sampled at many times: its differences have a sum that is not above its variation, which is the integral.
fn variation_of_samples(n: &UniPoly, d: &UniPoly) -> f64 {
    let number = |p: &UniPoly, k: usize| Rational::from(p.coeff(k)).to_f64_approximate();
    let order = d.coeffs().len() - 1;
    let (lead, mut x) = (number(d, order), vec![0.0; order]);
    let direct = number(n, order) / lead;
    let rate: f64 = (0..order).map(|k| (number(d, k) / lead).abs().powf(1.0 / (order - k) as f64)).fold(0.0, f64::max);
    let step = 0.01 / rate;
    let slope = |x: &[f64]| -> Vec<f64> {
        let last = 1.0 - (0..order).map(|k| number(d, k) / lead * x[k]).sum::<f64>();
        x[1..].iter().copied().chain([last]).collect()
    };
    let output =
        |x: &[f64]| (0..order).map(|k| (number(n, k) / lead - direct * number(d, k) / lead) * x[k]).sum::<f64>();
    let (mut sum, mut before, mut lately) = (direct.abs(), 0.0, 0.0);
    for k in 1..10_000_000 {
        let moved = |k: &[f64], h: f64| x.iter().zip(k).map(|(x, k)| x + h * k).collect::<Vec<_>>();
        let a = slope(&x);
        let b = slope(&moved(&a, step / 2.0));
        let c = slope(&moved(&b, step / 2.0));
        let d = slope(&moved(&c, step));
        for (i, x) in x.iter_mut().enumerate() {
            *x += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
        let now = output(&x);
        sum += f64::abs(now - before);
        lately += f64::abs(now - before);
        before = now;
        // A pole that is a thousand times slower than the fastest still loses a hundredth of its part meanwhile.
        if k % 5000 == 0 {
            if k >= 20_000 && lately <= 1e-7 * sum {
                break;
            }
            lately = 0.0;
        }
    }
    sum
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if std::env::var_os("JURIST_THOROUGH").is_some() { 40 } else { 3 }))]

    #[test]
    fn the_integral_is_the_variation_of_the_step_response([n, d] in continuous()) {
        let found = integral_of(&n, &d, 8);
        let middle = found.lower.midpoint(&found.upper).to_f64_approximate();
        let sampled = variation_of_samples(&n, &d);
        prop_assert!((middle - sampled).abs() <= 2e-4 * middle, "{n:?} {d:?}: {middle} {sampled}");
        prop_assert!(n.is_zero() || &(&found.upper - &found.lower) * &Rational::from(10i64.pow(10)) <= found.lower);
    }

    #[test]
    fn more_digits_are_inside_and_gains_are_below([n, d] in continuous()) {
        let (few, many) = (integral_of(&n, &d, 4), integral_of(&n, &d, 20));
        prop_assert!(few.lower <= many.upper && many.lower <= few.upper);
        let [low, high] = [(0, 0), (d.coeffs().len() - 1, d.coeffs().len() - 1)]
            .map(|(i, j)| Rational::new(n.coeff(i), d.coeff(j)).abs());
        prop_assert!(low <= many.upper && high <= many.upper);
    }

    #[test]
    fn other_units_of_time_and_of_the_output_change_nothing_else([n, d] in continuous(), c in 1i64..9) {
        let faster = |p: &UniPoly| {
            let scaled = p.coeffs().iter().enumerate().map(|(k, x)| x * &Integer::from(3).pow(k as u64));
            UniPoly::new(scaled.collect())
        };
        let (plain, other) = (integral_of(&n, &d, 10), integral_of(&faster(&n).scaled(&Integer::from(-c)), &faster(&d), 10));
        let factor = Rational::from(c);
        prop_assert!(&plain.lower * &factor <= other.upper && other.lower <= &plain.upper * &factor);
    }
}
