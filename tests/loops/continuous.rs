//! The continuous loops of `examples/`: their answers against those derived by hand in each test.

use crate::helpers::loops::{assert_stable, stable_set_of, with};
use crate::helpers::model::{continuous, example};
use crate::helpers::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Answer;
use jurist_engine::problem::{DECAY, Region};
use jurist_engine::stability::{End, StableSet};

fn asked(name: &str, parameter: &str) -> Answer<StableSet> {
    example(name).ask().free(parameter).stable_set(&Budget::unlimited()).unwrap()
}

/// The square of the angular frequency at an end lies in the enclosure.
fn assert_frequency_squared(answer: &Answer<StableSet>, end: &End, expected: &Rational) {
    let rate = answer.problem().frequency(end, 60).unwrap().radians_per_second.unwrap();
    assert!(rate.lower() * rate.lower() <= *expected && *expected <= rate.upper() * rate.upper());
}

/// s^4 + 3 s^3 + 3 s^2 + 2 s + K: Routh's first column 1, 3, 7/3, 2 - 9 K/7, K. At K = 14/9 the row of s^2 is 7/3 s^2 + 14/9.
#[test]
fn ogata_hurwitz() {
    assert_stable(example("ogata-hurwitz").ask().free("K"), &[("0: s=0", "14/9: complex pair")]);
    let answer = asked("ogata-hurwitz", "K");
    let end = answer.value().intervals()[0].upper.clone().unwrap();
    assert_frequency_squared(&answer, &end, &number("2/3"));
}

/// s^3 + 5 s^2 + (K - 6) s + K: 5 (K - 6) > K.
#[test]
fn franklin_hurwitz() {
    assert_stable(example("franklin-hurwitz").ask().free("K"), &[("15/2: complex pair", "inf")]);
    let answer = asked("franklin-hurwitz", "K");
    let end = answer.value().intervals()[0].lower.clone().unwrap();
    assert_frequency_squared(&answer, &end, &number("3/2"));
}

/// L_1 L_2 C s^3 + K_ad L_2 C s^2 + (L_1 + L_2) s + K_p: K_ad L_2 C (L_1 + L_2) > L_1 L_2 C K_p.
#[test]
fn lcl_grid_current() {
    let lp = example("lcl-grid-current");
    assert_stable(lp.ask().free("K_p"), &[("0: s=0", "30: complex pair")]);
    assert_stable(lp.ask().free("K_ad"), &[("20/3: complex pair", "inf")]);
    assert_stable(with(&lp, &[("L_1", "1e-3")]).free("K_p"), &[("0: s=0", "40: complex pair")]);
    // Degree is lost at L_1 = 0 only in a polynomial; here the model divides by L_1.
    assert_stable(lp.ask().free("L_1"), &[("0: pole", "inf")]);
    let answer = asked("lcl-grid-current", "K_p");
    let end = answer.value().intervals()[0].upper.clone().unwrap();
    assert_frequency_squared(&answer, &end, &number("1.5e8"));
}

/// The loop is k B(s) + A(s) s^2 (s^2 + 2 k) with the compensator B/A. On the axis x = s^2 satisfies, the even against
/// the odd part, (l_0 + l_2 x)(k_1 + k_3 x) = (l_1 + l_3 x)(k_0 + k_2 x), and then
/// k = -x^2 (l_0 + l_2 x)/(2 x (l_0 + l_2 x) + k_0 + k_2 x). The engine eliminates x instead.
#[test]
fn acc_benchmark() {
    let lp = example("acc-benchmark");
    let polynomial = "9111997632 -28709773789 7962286032";
    let ends = (
        format!("root {polynomial} near 0.351684783595: complex pair"),
        format!("root {polynomial} near 3.2540351909: complex pair"),
    );
    assert_stable(lp.ask().free("k"), &[(&ends.0, &ends.1)]);

    let n = |v: i64| Rational::from(v);
    let mut a = vec![n(1), n(6)];
    for gamma in ["5/2", "2", "2", "2", "2", "2"] {
        let (last, before) = (a[a.len() - 1].clone(), a[a.len() - 2].clone());
        a.push(&last * &last / (number(gamma) * before));
    }
    let [l3, l2] = [a[7].clone(), a[6].clone()];
    let [l1, l0] = [&a[5] - n(2) * &l3, &a[4] - n(2) * &l2];
    let [k3, k2, k1, k0] = [&a[3] - n(2) * &l1, &a[2] - n(2) * &l0, a[1].clone(), a[0].clone()];
    let difference = |x: &Rational| (&l0 + &l2 * x) * (&k1 + &k3 * x) - (&l1 + &l3 * x) * (&k0 + &k2 * x);
    let spring = |x: &Rational| {
        let even = &l0 + &l2 * x;
        -(x * x * &even / (n(2) * x * &even + &k0 + &k2 * x))
    };
    let interval = stable_set_of(lp.ask().free("k")).intervals()[0].clone();
    // omega^2 of each end, bracketed from the quadratic's roots -22.22... and -0.447...
    for (end, bracket) in [(interval.lower.unwrap(), ["-1/2", "-2/5"]), (interval.upper.unwrap(), ["-23", "-22"])] {
        let [mut lo, mut hi] = bracket.map(number);
        for _ in 0..150 {
            let middle = lo.midpoint(&hi);
            if difference(&middle).sign() == difference(&lo).sign() { lo = middle } else { hi = middle }
        }
        let (k, near) = (spring(&lo), end.value.refined(&number("1e-40")).enclosure().0);
        assert!((k - near).abs() < number("1e-35"), "{}", end.value.decimal(12));
        let x = end.pair.unwrap().half_size_root(80);
        assert!(*x.lower() < hi && lo < *x.upper());
    }
}

/// s^2 + 2 s + K shifted: all roots left of -S where (s - S)^2 + 2 (s - S) + K is Hurwitz: S < 1 and S^2 - 2 S + K > 0.
#[test]
fn decay_rate() {
    let lp = continuous("s^2 + 2*s + k", "nominal = 2");
    assert_stable(lp.ask().free(DECAY), &[("0: domain", "1: complex pair")]);
    assert_stable(with(&lp, &[("k", "3/4")]).free(DECAY), &[("0: domain", "1/2: s=0")]);
    assert_stable(with(&lp, &[("k", "1")]).free(DECAY), &[("0: domain", "1: s=0")]);
    assert_stable(lp.ask().free("k").within(Region::half_plane(number("1/2"))), &[("3/4: s=0", "inf")]);
}
