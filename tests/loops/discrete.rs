//! The discrete loops of `examples/`: their answers against those derived by hand in each test.

use crate::helpers::loops::{assert_changes_sign, assert_stable, stable_set_of, with};
use crate::helpers::model::{discrete, example, load};
use crate::helpers::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::problem::RADIUS;
use jurist_engine::show::margins::margin;
use jurist_engine::stability::Cause;

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
    let page = include_str!("../../crates/engine/src/model/examples.md");
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(!name.ends_with(".toml") || page.contains(&name), "{name} is not on the page");
    }
}

/// z^2 - (1 + beta - alpha L) z + beta: Q(1) = alpha L > 0, Q(-1) = 2 (1 + beta) - alpha L > 0, |beta| < 1.
#[test]
fn heavy_ball() {
    let lp = example("heavy-ball");
    assert_stable(lp.ask().free("alpha"), &[("0: z=1", "19/50: z=-1")]);
    assert_stable(lp.ask().free("beta"), &[("-1/2: z=-1", "1: complex pair")]);
    assert_stable(lp.ask().free("L"), &[("0: z=1+domain", "38: z=-1")]);
    for (beta, l) in [("0", "1"), ("1/3", "7"), ("-1/2", "3/5"), ("99/100", "1000")] {
        let upper = number("2") * (number("1") + number(beta)) / number(l);
        let found = stable_set_of(with(&lp, &[("beta", beta), ("L", l)]).free("alpha"));
        assert_eq!(found.intervals().len(), 1);
        assert_eq!(found.intervals()[0].upper.as_ref().unwrap().value.exact(), Some(upper));
    }
    // beta = 1: the product of the roots is 1, never stable.
    assert_stable(with(&lp, &[("beta", "1")]).free("alpha"), &[]);
    // z^2 - 9/10 z + 9/10 has complex roots of modulus sqrt(9/10).
    assert_stable(lp.ask().free(RADIUS), &[("root -9 0 10 near 0.948683298050513: complex pair", "inf")]);
}

/// On q = rho/sigma: at z = 1 q = 0, at z = -1 q = -2/(44/12) = -6/11; no other real value is taken on the circle.
#[test]
fn adams_bashforth_3() {
    assert_stable(example("adams-bashforth-3").ask().free("q"), &[("-6/11: z=-1", "0: z=1")]);
}

/// q = 11/6 - 3 w + 3/2 w^2 - 1/3 w^3 with w = 1/z. On the circle Im q = sin t (4 c^2 - 9 c + 8)/3 with c = cos t, and
/// 81 < 128: q is real at w = 1 (0) and w = -1 (20/3) only. Degree is lost at 11/6, where it is unstable on both sides.
#[test]
fn bdf_3() {
    let lp = example("bdf-3");
    assert_stable(lp.ask().free("q"), &[("-inf", "0: z=1"), ("20/3: z=-1", "inf")]);
    let at = with(&lp, &[("q", "11/6")]).verdict(&Budget::unlimited()).unwrap().into_value();
    assert_eq!((at.verdict, at.degree, at.infinite), (Verdict::Unstable, 3, 1));
}

/// z (z - 1)^2 + K_p (z - 1) + K_i z: Q(1) = K_i > 0, |K_p| < 1, and 1 - K_p^2 > |K_p - 1 - K_i| gives K_i < K_p (1 - K_p).
/// At K_p = 1/4, K_i = 3/16: (z - 1/4)(z^2 - 7/4 z + 1).
#[test]
fn digital_pll() {
    let lp = example("digital-pll");
    assert_stable(lp.ask().free("K_i"), &[("0: z=1", "3/16: complex pair")]);
    let (low, high) =
        ("root 1 -10 10 near 0.112701665379: complex pair", "root 1 -10 10 near 0.887298334620: complex pair");
    assert_stable(lp.ask().free("K_p"), &[(low, high)]);
    // K_p (1 - K_p) <= 1/4.
    assert_stable(with(&lp, &[("K_i", "1/4")]).free("K_p"), &[]);
    assert_stable(with(&lp, &[("K_i", "6/25")]).free("K_p"), &[("2/5: complex pair", "3/5: complex pair")]);
    let answer = lp.ask().free("K_i").stable_set(&Budget::unlimited()).unwrap();
    let end = answer.value().intervals()[0].upper.clone().unwrap();
    let place = end.pair.as_ref().unwrap().half_size_root(50);
    assert_eq!((place.lower(), place.upper()), (&number("7/4"), &number("7/4")));
    // arccos(7/8) = 0.50536051...
    assert_eq!(answer.problem().frequency(&end, 60).unwrap().angle.unwrap().decimal(8).unwrap(), "0.50536051");
}

/// z^3 - 2 c z^2 + (1 + k) z - k: 1 - k^2 > |1 + k - 2 c k| gives k (k + 1 - 2 c) < 0 and, with the other sign,
/// k^2 - k - 2 + 2 c k < 0; further c < 1, 1 + c + k > 0, |k| < 1.
#[test]
fn lcl_active_damping() {
    let lp = example("lcl-active-damping");
    assert_stable(lp.ask().free("k"), &[("0: complex pair", "3/5: complex pair")]);
    assert_stable(lp.ask().free("c"), &[("3/5: complex pair", "1: z=1+domain")]);
    // Above a sixth of the sampling frequency only negative gains damp.
    assert_stable(with(&lp, &[("c", "1/2")]).free("k"), &[]);
    assert_stable(with(&lp, &[("c", "2/5")]).free("k"), &[("-1/5: complex pair", "0: complex pair")]);
    assert_stable(with(&lp, &[("k", "-1/5")]).free("c"), &[("-4/5: z=-1", "2/5: complex pair")]);
}

/// Q(1) = 0.6321 K, Q(-1) = 2.7358 - 0.1037 K, and 0.3679 + 0.2642 K < 1. Printed: 2.3925, 1.3244 rad/s.
#[test]
fn ogata_jury() {
    let lp = example("ogata-jury");
    assert_stable(lp.ask().free("K"), &[("0: z=1", "6321/2642: complex pair")]);
    let answer = lp.ask().free("K").stable_set(&Budget::unlimited()).unwrap();
    let end = answer.value().intervals()[0].upper.clone().unwrap();
    assert_eq!(end.value.decimal(5), "2.3925");
    let rate = answer.problem().frequency(&end, 60).unwrap().radians_per_second.unwrap();
    assert!(number("1.3244") < *rate.lower() && *rate.upper() < number("1.3245"));
}

/// Dividing z^4 + a_3 z^3 + a_2 z^2 + a_1 z + a_0 by z^2 - x z + 1 leaves x = (a_1 - a_3)/(1 - a_0) and the condition
/// (a_2 - a_0 - 1)(1 - a_0)^2 + (a_1 - a_3)(a_1 - a_0 a_3) = 0.
#[test]
fn buck_converter() {
    let lp = example("buck-converter");
    let polynomial = "-20633081 -251067000 2898000000";
    let ends = (
        format!("root {polynomial} near -0.0515307650235: complex pair"),
        format!("root {polynomial} near 0.138165340592: complex pair"),
    );
    assert_stable(lp.ask().free("K_p"), &[(&ends.0, &ends.1)]);
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
    let polynomial = format!("{} 0 {}", -omega_squared.numerator(), omega_squared.denominator());
    let ends = (
        format!("root {polynomial} near -4473.83805988: complex pair"),
        format!("root {polynomial} near 4473.83805988: complex pair"),
    );
    assert_stable(lp.ask().free("omega_e"), &[(&ends.0, &ends.1)]);
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

/// The printed coefficients of the paper: Q(1) = 2.67978e-12 K - 8e-12.
#[test]
fn printed_equation_23() {
    let lp = example("equation-23-as-printed");
    let found = stable_set_of(lp.ask().free("K_pwm"));
    let lower = found.intervals()[0].lower.clone().unwrap();
    assert_eq!(lower.value.exact(), Some(number("8") / number("2.67978")));
    assert!(lower.causes.contains(Cause::RootAtOne) && !lower.causes.contains(Cause::ComplexPair));
    assert!(found.intervals()[0].upper.as_ref().unwrap().value.decimal(12).starts_with("550.941166686"));
}

/// The digits of Eq. 37 move the lower end of T away from 0, to 3.8557e-5 s.
#[test]
fn printed_equation_37() {
    let found = stable_set_of(example("equation-37-as-printed").ask().free("T"));
    assert_eq!(found.intervals().len(), 1);
    assert_eq!(found.intervals()[0].lower.as_ref().unwrap().value.decimal(5), "0.000038557");
}

/// A loop and its square have the same stable set: every boundary is met twice.
#[test]
fn doubled_polynomial() {
    let once = discrete("z^2 - 3/2*z + k", "");
    let twice = discrete("(z^2 - 3/2*z + k)^2", "");
    for lp in [once, twice] {
        assert_stable(lp.ask().free("k"), &[("1/2: z=1", "1: complex pair")]);
    }
}
