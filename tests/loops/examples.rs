//! The loops of `examples/`: all of them load, and formulas derived by hand give the ends that the corpus has digits of.

use crate::helpers::loops::{assert_changes_sign, stable_set_of, with};
use crate::helpers::model::{example, load};
use crate::helpers::number::number;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_show::margins::margin;

#[test]
fn every_example_loads_without_a_warning_and_is_stable_at_nominal() {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        names.extend(name.strip_suffix(".toml").map(str::to_string));
    }
    assert!(names.len() >= 16, "{names:?}");
    for name in names {
        let answer = example(&name).ask().verdict(&Budget::unlimited()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(answer.value().verdict, Verdict::Stable, "{name}");
        assert!(answer.problem().warnings().is_empty(), "{name}");
    }
}

#[test]
fn every_example_is_on_the_page_of_examples() {
    let page = include_str!("../../crates/model/src/examples.md");
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(!name.ends_with(".toml") || page.contains(&name), "{name} is not on the page");
    }
}

/// 1 + k L(z) = 0 has its root at -1 for k = 2 (z + k/2), 3/2 (z - 1/2 + k), 40 (z - 1 + k/20).
#[test]
fn gain_margins_that_a_strict_inequality_loses() {
    for (transfer, expected, decibels) in
        [("0.5/z", "2", "6.02"), ("1/(z - 0.5)", "3/2", "3.52"), ("0.05/(z - 1)", "40", "32.0")]
    {
        let lp = load(&format!(
            "time = 'discrete'\n[parameters]\nk = {{ nominal = 1, min = 0 }}\n[loop]\n[[block]]\nname = 'controller'\n\
             input = '-y'\noutput = 'u'\ngain = 'k'\n[[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '{transfer}'"
        ));
        let found = stable_set_of(lp.ask().free("k"));
        assert_eq!(found.intervals().len(), 1, "{transfer}");
        let end = found.intervals()[0].upper.clone().unwrap();
        assert_eq!(end.causes.to_string(), "z=-1", "{transfer}");
        let margin = margin(&end.value, Some(&number("1")), 3).unwrap();
        assert_eq!((margin.factor.as_str(), margin.decibels.as_deref()), (expected, Some(decibels)), "{transfer}");
    }
}

/// Dividing z^4 + a_3 z^3 + a_2 z^2 + a_1 z + a_0 by z^2 - x z + 1 leaves x = (a_1 - a_3)/(1 - a_0) and the condition
/// (a_2 - a_0 - 1)(1 - a_0)^2 + (a_1 - a_3)(a_1 - a_0 a_3) = 0.
#[test]
fn buck_converter() {
    let lp = example("buck-converter");
    let n = |v: i64| Rational::from(v);
    // z (z - 1) (a (z - 1)^2 + b (z^2 - 1) + w (z + 1)^2) + 12 w (K (z - 1) + 1/1000)(z + 1)^2, with a = 4/T^2, b = 2/(T R C), w = 1/(L C).
    let (t, lc, rc) = (number("5e-6"), number("2e-9"), number("2e-4"));
    let condition = |k: &Rational| {
        let (a, b, w) = (n(4) / (&t * &t), n(2) / (&t * &rc), n(1) / lc.clone());
        let (d2, d1, d0) = (&a + &b + &w, (&w - &a) * n(2), &a - &b + &w);
        let g = n(12) * &w;
        let e = number("1/1000") - k; // the constant term of K (z - 1) + K_i T
        let c3 = &d1 - &d2 + &g * k;
        let c2 = &d0 - &d1 + &g * (n(2) * k + &e);
        let c1 = &g * (k + n(2) * &e) - &d0;
        let c0 = &g * &e;
        let [a3, a2, a1, a0] = [c3, c2, c1, c0].map(|c| c / d2.clone());
        let q = n(1) - &a0;
        (&a2 - &a0 - n(1)) * (&q * &q) + (&a1 - &a3) * (&a1 - &a0 * &a3)
    };
    for end in [0, 1] {
        let interval = stable_set_of(lp.ask().free("K_p")).intervals()[0].clone();
        let value = if end == 0 { interval.lower } else { interval.upper }.unwrap().value;
        assert_changes_sign(&value, condition);
    }
}

/// With i = i_d + j i_q the loop is z (z - 1)(z - a + j W) + g (z - 1) + h, W = omega_e T. On the circle the real part of
/// the quotient by z (z - 1) gives c = (a + h/2)/(1 + g - h), the imaginary part
/// W = g s - h (s/2 - c (1 + c)/(2 s)) - s.
#[test]
fn pmsm_current_loop() {
    let lp = example("pmsm-current-loop");
    let (a, g, h, t) = (number("0.99"), number("0.2"), number("0.002"), number("1e-4"));
    let (one, two) = (number("1"), number("2"));
    let c = (&a + &h / &two) / (&one + &g - &h);
    assert_eq!(c, number("991/1198"));
    let s2 = &one - &c * &c;
    let w_s = &s2 * (&g - &h / &two - &one) + &h * &c * (&one + &c) / &two;
    let omega_squared = &w_s * &w_s / (&s2 * &t * &t);
    assert_eq!(omega_squared, number("1486567075769600/74271807"));
    let interval = stable_set_of(lp.ask().free("omega_e")).intervals()[0].clone();
    let place = interval.upper.unwrap().pair.unwrap().half_size_root(80);
    let cosine = &c * &two;
    assert!(*place.lower() <= cosine && cosine <= *place.upper());

    // At standstill, twice z^3 - (1 + a) z^2 + (a + g) z + h - g: every root is double.
    let standing = stable_set_of(with(&lp, &[("omega_e", "0")]).free("K_p"));
    assert_eq!(standing.intervals().len(), 1);
    let (lower, upper) =
        (standing.intervals()[0].lower.clone().unwrap(), standing.intervals()[0].upper.clone().unwrap());
    assert_eq!((lower.value.exact(), lower.causes.to_string().as_str()), (Some(number("0")), "domain"));
    assert_eq!(upper.causes.to_string(), "complex pair");
    assert_changes_sign(&upper.value, |k| {
        let g = k / number("50");
        &g * &g - (&two * &h + &a) * &g - (&one - &a - &h * &h - &h * (&one + &a))
    });
}

/// The loop is k B(s) + A(s) s^2 (s^2 + 2 k) with the compensator B/A. On the axis x = s^2 satisfies, the even against
/// the odd part, (l_0 + l_2 x)(k_1 + k_3 x) = (l_1 + l_3 x)(k_0 + k_2 x), and then
/// k = -x^2 (l_0 + l_2 x)/(2 x (l_0 + l_2 x) + k_0 + k_2 x). The engine eliminates x instead.
#[test]
fn acc_benchmark() {
    let lp = example("acc-benchmark");
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
