//! Singular models, read from text and decided: each with its answer derived by hand. Every answer has a certificate that both
//! checkers accept.

use crate::helpers::certificates::checkers::{certified_set_of, certified_verdict_of};
use crate::helpers::loops::{assert_stable, with};
use crate::helpers::model::{continuous, discrete, load};
use crate::helpers::number::number;
use jurist_engine::answer::{PointVerdict, Verdict};
use jurist_engine::model::Loop;
use jurist_engine::stability::Range;

fn assert_discrete(characteristic: &str, parameter: &str, expected: &[(&str, &str)]) {
    assert_stable(discrete(characteristic, parameter).ask().free("k"), expected);
}

fn assert_continuous(characteristic: &str, parameter: &str, expected: &[(&str, &str)]) {
    assert_stable(continuous(characteristic, parameter).ask().free("k"), expected);
}

fn at(lp: &Loop, k: &str) -> PointVerdict {
    certified_verdict_of(with(lp, &[("k", k)]))
}

/// (verdict, inside, on, outside, infinite)
fn counted(lp: &Loop, k: &str) -> (Verdict, usize, usize, usize, usize) {
    let v = at(lp, k);
    let count = v.count.unwrap_or_default();
    (v.verdict, count.inside, count.on, count.outside, v.infinite)
}

use Verdict::{Marginal, Stable, Undefined, Unstable};

// ---- degree 0 and 1, the zero polynomial

#[test]
fn degree_zero_is_stable_wherever_it_is_not_zero() {
    assert_discrete(
        "k^2 - 2",
        "",
        &[
            ("-inf", "root -2 0 1 near -1.41421356: infinity"),
            ("root -2 0 1 near -1.41421356: infinity", "root -2 0 1 near 1.41421356: infinity"),
            ("root -2 0 1 near 1.41421356: infinity", "inf"),
        ],
    );
    assert_continuous("k - 3", "", &[("-inf", "3: infinity"), ("3: infinity", "inf")]);
    assert_discrete("1/(k - 3)", "", &[("-inf", "3: pole"), ("3: pole", "inf")]);
    assert_discrete("5 + 0*k", "", &[("-inf", "inf")]);
    let lp = discrete("k - 3", "");
    assert_eq!(counted(&lp, "4"), (Stable, 0, 0, 0, 0));
    assert_eq!(at(&lp, "3").verdict, Unstable);
}

#[test]
fn degree_one() {
    // z = -k
    assert_discrete("z + k", "", &[("-1: z=1", "1: z=-1")]);
    // z = -1/k: inside for |k| > 1; at k = 0 the root is at infinity, between unstable intervals.
    assert_discrete("k*z + 1", "", &[("-inf", "-1: z=1"), ("1: z=-1", "inf")]);
    assert_continuous("s + k", "", &[("0: s=0", "inf")]);
    // s = -1/k
    assert_continuous("k*s + 1", "", &[("0: infinity", "inf")]);
    // s = -k/k: no parameter left, but nothing is left at k = 0.
    assert_continuous("k*s + k", "", &[("-inf", "0: infinity"), ("0: infinity", "inf")]);
    assert_eq!(counted(&continuous("k*s + 1", ""), "0"), (Unstable, 0, 0, 0, 1));
}

#[test]
fn identically_zero_is_stable_nowhere() {
    assert_discrete("0*k", "", &[]);
    assert_discrete("(k - k)*z^2 + k*z - z*k", "", &[]);
    assert_continuous("0*k*s", "", &[]);
    assert_eq!(at(&discrete("0*k", ""), "1").verdict, Unstable);
    // Zero for one value only: (k - 2)(z - 1/2).
    assert_discrete("(k - 2)*z - (k - 2)/2", "", &[("-inf", "2: infinity"), ("2: infinity", "inf")]);
    assert_eq!(at(&discrete("(k - 2)*z - (k - 2)/2", ""), "2").verdict, Unstable);
}

#[test]
fn always_and_never_stable() {
    assert_discrete("z^2 - z/2 + 0*k", "", &[("-inf", "inf")]);
    assert_discrete("z^2 - 4 + 0*k", "", &[]);
    // |z|^2 = (k^2 + 1)/(k^2 + 2) < 1 for every k.
    assert_discrete("z^2 + (k^2 + 1)/(k^2 + 2)", "", &[("-inf", "inf")]);
    assert_discrete("z^2 + (k^2 + 2)/(k^2 + 1)", "", &[]);
    assert_continuous("s^2 + (k^2 + 1)*s + 1", "", &[("-inf", "inf")]);
    assert_continuous("s^2 - (k^2 + 1)*s + 1", "", &[]);
    assert_discrete("z^2 - z/2 + 0*k", "min = 1, max = 2", &[("1: domain", "2: domain")]);
}

// ---- roots that stay on the boundary or in mirror pairs

#[test]
fn permanent_root_at_one() {
    assert_discrete("(z - 1)*(z + k)", "", &[]);
    assert_eq!(counted(&discrete("(z - 1)*(z + k)", ""), "1/2"), (Marginal, 1, 1, 0, 0));
    assert_eq!(counted(&discrete("(z - 1)*(z + k)", ""), "-1"), (Marginal, 0, 2, 0, 0));
    assert_continuous("s*(s + k)", "", &[]);
}

#[test]
fn permanent_root_at_minus_one() {
    assert_discrete("(z + 1)*(z^2 + k)", "", &[]);
    assert_eq!(counted(&discrete("(z + 1)*(z^2 + k)", ""), "1/2"), (Marginal, 2, 1, 0, 0));
    assert_eq!(counted(&discrete("(z + 1)*(z^2 + k)", ""), "2"), (Unstable, 0, 1, 2, 0));
}

#[test]
fn permanent_pair_on_the_boundary() {
    assert_discrete("(z^2 + 1)*(z - k)", "", &[]);
    assert_eq!(counted(&discrete("(z^2 + 1)*(z - k)", ""), "1/2"), (Marginal, 1, 2, 0, 0));
    assert_continuous("(s^2 + 2)*(s + k)", "", &[]);
    assert_eq!(counted(&continuous("(s^2 + 2)*(s + k)", ""), "1"), (Marginal, 1, 2, 0, 0));
}

#[test]
fn permanent_mirror_pair_off_the_boundary() {
    // Roots 2 and 1/2, -3 and 3, and a quadruple e^(+-i) r^(+-1).
    assert_discrete("(2*z^2 - 5*z + 2)*(z - k)", "", &[]);
    assert_eq!(counted(&discrete("(2*z^2 - 5*z + 2)*(z - k)", ""), "1/3"), (Unstable, 2, 0, 1, 0));
    assert_continuous("(s^2 - 9)*(s + k)", "", &[]);
    // (z^2 - z + 2)(2 z^2 - z + 1)
    assert_discrete("(z^2 - z + 2)*(2*z^2 - z + 1)*(z - k)", "", &[]);
    assert_eq!(counted(&discrete("(z^2 - z + 2)*(2*z^2 - z + 1)*(z - k)", ""), "0"), (Unstable, 3, 0, 2, 0));
}

#[test]
fn moving_mirror_pair_never_ends_stability_inside() {
    // (z - k)(k z - 1)(z - 1/2): roots k and 1/k.
    assert_discrete("(z - k)*(k*z - 1)*(z - 1/2)", "", &[]);
    // Roots 1/2 and k: a mirror pair at k = 2 only, in the unstable part.
    assert_discrete("(z - 1/2)*(z - k)", "", &[("-1: z=-1", "1: z=1")]);
}

// ---- the leading coefficient vanishes

#[test]
fn leading_coefficient_vanishes_discrete() {
    // k z^2 + z/4 + ... root leaves through infinity on both sides of 0: unstable near 0. Q(1) = k + 1/4, Q(-1) = k - 1/4.
    assert_discrete("k*z^2 + z/4", "", &[("-inf", "-1/4: z=1"), ("1/4: z=-1", "inf")]);
    // K (z - 1/2): the root stays at 1/2, only the equation is lost.
    assert_discrete("k*(z - 1/2)", "", &[("-inf", "0: infinity"), ("0: infinity", "inf")]);
    assert_eq!(counted(&discrete("k*(z - 1/2)", ""), "1"), (Stable, 1, 0, 0, 0));
    assert_eq!(at(&discrete("k*(z - 1/2)", ""), "0").verdict, Unstable);
    // The degree is that with all parameters symbolic, before any --set.
    let lp =
        load("time = 'discrete'\n[parameters]\nk = {}\nm = { nominal = 0 }\n[loop]\ncharacteristic = 'm*z^2 + z - k'");
    assert_stable(lp.ask().free("k"), &[]);
    assert_eq!(counted(&lp, "0"), (Unstable, 1, 0, 0, 1));
}

#[test]
fn leading_coefficient_vanishes_continuous() {
    // k s^2 + s + 1: for k > 0 stable, at 0 a root goes to -infinity and is missing, for k < 0 it is at +infinity.
    assert_continuous("k*s^2 + s + 1", "", &[("0: infinity", "inf")]);
    assert_continuous("(k - 1)^2*s^2 + s + 1", "", &[("-inf", "1: infinity"), ("1: infinity", "inf")]);
    assert_eq!(counted(&continuous("(k - 1)^2*s^2 + s + 1", ""), "1"), (Unstable, 1, 0, 0, 1));
    // Two roots leave as a pair: k s^2 + k^2 s + 1 has real part -k/2 and modulus^2 1/k.
    assert_continuous("k*s^2 + k^2*s + 1", "", &[("0: infinity", "inf")]);
    // Degree and a root at 0 together: k s^2 + s + k.
    assert_continuous("k*s^2 + s + k", "", &[("0: s=0+infinity", "inf")]);
}

// ---- poles

#[test]
fn poles_of_the_coefficients_inside_the_range() {
    // z = 1/(k - 1)/4: inside for |k - 1| > 1/4.
    assert_discrete("z - 1/(4*(k - 1))", "", &[("-inf", "3/4: z=-1"), ("5/4: z=1", "inf")]);
    // The pole lies in the stable part when the coefficient is small on its other side: constant term 1/(3 + 1/(k - 2)).
    assert_discrete("z - 1/(3 + 1/(k - 2))", "", &[("-inf", "3/2: z=1"), ("7/4: z=-1", "2: pole"), ("2: pole", "inf")]);
    assert_eq!(at(&discrete("z - 1/(3 + 1/(k - 2))", ""), "2").verdict, Undefined);
    assert_eq!(at(&discrete("z - 1/(3 + 1/(k - 2))", ""), "5/3").verdict, Undefined);
}

#[test]
fn cancelled_poles_stay_undefined() {
    assert_discrete("z - k/k/2", "", &[("-inf", "0: pole"), ("0: pole", "inf")]);
    assert_discrete("z - (k^2 - 4)/(k - 2)/8", "", &[("-10: z=-1", "2: pole"), ("2: pole", "6: z=1")]);
    assert_discrete("z + 0/(k - 1)", "", &[("-inf", "1: pole"), ("1: pole", "inf")]);
    assert_discrete(
        "z - 1/2 + 1/(k^2 - 2) - 1/(k^2 - 2)",
        "",
        &[
            ("-inf", "root -2 0 1 near -1.4142135: pole"),
            ("root -2 0 1 near -1.4142135: pole", "root -2 0 1 near 1.4142135: pole"),
            ("root -2 0 1 near 1.4142135: pole", "inf"),
        ],
    );
    // A pole at an end for another reason: z + k + 1/(k - 1) - 1/(k - 1).
    assert_discrete("z + k + (k - 1)/(k - 1) - 1", "", &[("-1: z=1", "1: z=-1+pole")]);
    // (k - 1)^(-1) as a power, and a pole in a constant that is used.
    assert_discrete("z - (k - 1)*(k - 1)^(-1)/2", "", &[("-inf", "1: pole"), ("1: pole", "inf")]);
    let lp =
        load("time = 'discrete'\n[constants]\ng = '1/k'\n[parameters]\nk = {}\n[loop]\ncharacteristic = 'z - g*k/2'");
    assert_stable(lp.ask().free("k"), &[("-inf", "0: pole"), ("0: pole", "inf")]);
}

#[test]
fn undefined_everywhere_for_the_values_set() {
    let lp =
        load("time = 'discrete'\n[parameters]\nk = {}\nm = { nominal = 1 }\n[loop]\ncharacteristic = 'z - k/(m - 1)'");
    assert_stable(lp.ask().free("k"), &[]);
    assert_eq!((at(&lp, "0").verdict, at(&lp, "0").degree), (Undefined, 1));
    assert_stable(with(&lp, &[("m", "3")]).free("k"), &[("-2: z=-1", "2: z=1")]);
}

#[test]
fn algebraic_loop_that_is_ill_posed_at_one_value() {
    // u = -k y, y = (z + 1)/(z - 1/2)... u: 1 + k (direct part) = 0 at k = -1; the pole is (1/2 - k)/(1 + k).
    // |1/2 - k| < |1 + k| for k > -1/4, without an upper limit.
    let lp = load(
        "time = 'discrete'\n[parameters]\nk = {}\n[loop]\n[[block]]\nname = 'g'\ninput = 'u'\noutput = 'y'\n\
         transfer = '(z + 1)/(z - 1/2)'\n[[block]]\nname = 'c'\ninput = '-y'\noutput = 'u'\ngain = 'k'",
    );
    assert_stable(lp.ask().free("k"), &[("-1/4: z=1", "inf")]);
    assert_eq!(at(&lp, "-1").verdict, Undefined);
    // y = u, u = -k y + z^-1...: two gains only, the loop 1 + k has no state; defined but at k = -1.
    let lp = load(
        "time = 'discrete'\n[parameters]\nk = {}\n[loop]\n[[block]]\nname = 'g'\ninput = 'u'\noutput = 'y'\ngain = 2\n\
         [[block]]\nname = 'c'\ninput = '-y'\noutput = 'u'\ngain = 'k'",
    );
    assert_stable(lp.ask().free("k"), &[("-inf", "-1/2: pole"), ("-1/2: pole", "inf")]);
}

// ---- tangency, several intervals, shared ends

#[test]
fn tangency_splits_an_interval_in_two_that_share_an_end() {
    // Root at 1 - (k - 1)^2, so at k = 1 it touches 1; it reaches -1 at (k - 1)^2 = 2.
    assert_discrete(
        "z - 1 + (k - 1)^2",
        "",
        &[("root -1 -2 1 near -0.41421356: z=-1", "1: z=1"), ("1: z=1", "root -1 -2 1 near 2.41421356: z=-1")],
    );
    // A pair touches the circle: z^2 + 1 - (k - 3)^2; at (k - 3)^2 = 2 both roots +-1.
    assert_discrete(
        "z^2 + 1 - (k - 3)^2",
        "",
        &[
            ("root 7 -6 1 near 1.58578643: z=1+z=-1", "3: complex pair"),
            ("3: complex pair", "root 7 -6 1 near 4.41421356: z=1+z=-1"),
        ],
    );
    assert_continuous("s^2 + k^2*s + 1", "", &[("-inf", "0: complex pair"), ("0: complex pair", "inf")]);
    assert_continuous(
        "s + (k^2 - 2)^2",
        "",
        &[
            ("-inf", "root -2 0 1 near -1.41421356: s=0"),
            ("root -2 0 1 near -1.41421356: s=0", "root -2 0 1 near 1.41421356: s=0"),
            ("root -2 0 1 near 1.41421356: s=0", "inf"),
        ],
    );
    // From outside: stable nowhere, though marginal at k = 0.
    assert_discrete("z - 1 - k^2", "", &[]);
    assert_eq!(counted(&discrete("z - 1 - k^2", ""), "0"), (Marginal, 0, 1, 0, 0));
}

#[test]
fn several_disjoint_intervals() {
    // z = (k^2 - 1)(k^2 - 4): |w| < 1 where w = x^2 - 5 x + 4, x = k^2: 5 >< x^2.. two bands on each side.
    // w = 1: x = (5 +- sqrt 13)/2, w = -1: x = (5 +- sqrt 5)/2; k^4 - 5 k^2 + 3 and k^4 - 5 k^2 + 5.
    let (one, minus) = ("root 3 0 -5 0 1", "root 5 0 -5 0 1");
    let end = |p: &str, digits: &str, cause: &str| format!("{p} near {digits}: {cause}");
    let e = [
        end(one, "-2.07431", "z=1"),
        end(minus, "-1.90211", "z=-1"),
        end(minus, "-1.17557", "z=-1"),
        end(one, "-0.83499", "z=1"),
        end(one, "0.83499", "z=1"),
        end(minus, "1.17557", "z=-1"),
        end(minus, "1.90211", "z=-1"),
        end(one, "2.07431", "z=1"),
    ];
    assert_discrete("z - (k^2 - 1)*(k^2 - 4)", "", &[(&e[0], &e[1]), (&e[2], &e[3]), (&e[4], &e[5]), (&e[6], &e[7])]);
    // Cut by a domain.
    assert_discrete(
        "z - (k^2 - 1)*(k^2 - 4)",
        "min = -2, max = 1",
        &[("-2: domain", &e[1]), (&e[2], &e[3]), (&e[4], "1: domain")],
    );
}

#[test]
fn several_causes_at_one_end() {
    // z^2 - k: roots +-sqrt k; +-i sqrt|k| below 0.
    assert_discrete("z^2 - k", "", &[("-1: complex pair", "1: z=1+z=-1")]);
    // All at once at k = 1: roots k, -k and a pair of modulus^2 k.
    assert_discrete("(z - k)*(z + k)*(z^2 + k)", "min = 0", &[("0: domain", "1: z=1+z=-1+complex pair")]);
    // Also degree (1 - k) and pole.
    assert_discrete("(z - k)*(z^2 + k^2)", "min = 0, max = 1", &[("0: domain", "1: z=1+complex pair+domain")]);
    // A double root at 1 is not a complex pair: (z - k)^2.
    assert_discrete("(z - k)^2", "", &[("-1: z=-1", "1: z=1")]);
    // A double complex pair: the lowest frequency of two pairs at k = 1, angles pi/3 and 2 pi/3.
    let lp = discrete("(z^2 - z + k)*(z^2 + z + k)", "");
    assert_stable(lp.ask().free("k"), &[("0: z=1+z=-1", "1: complex pair")]);
    let x = certified_set_of(lp.ask().free("k")).intervals()[0].upper.clone().unwrap().pair.unwrap().half_size_root(60);
    assert!(*x.lower() <= number("1") && number("1") <= *x.upper());
    // s = 0 and a pair together.
    assert_continuous("(s + k)*(s^2 + k*s + 1)", "", &[("0: complex pair+s=0", "inf")]);
}

#[test]
fn irrational_end_with_several_causes() {
    // w = k^2 - 2: roots w + 1 ... (z - k^2 + 1)(z^2 + k^2 - 1): at k = sqrt 2 a root at 1 and the pair +-i.
    let (low, high) = ("root -2 0 1 near -1.41421356", "root -2 0 1 near 1.41421356");
    let ends = (format!("{low}: z=1+complex pair"), format!("{high}: z=1+complex pair"));
    // At k = 0: root at -1 and z^2 = 1.
    assert_discrete("(z - k^2 + 1)*(z^2 + k^2 - 1)", "", &[(&ends.0, "0: z=1+z=-1"), ("0: z=1+z=-1", &ends.1)]);
    // Pole and degree at an irrational end: (k^2 - 2) s + 1, and the same with a hidden pole.
    assert_continuous(
        "(k^2 - 2)*s + 1",
        "",
        &[("-inf", "root -2 0 1 near -1.41421356: infinity"), ("root -2 0 1 near 1.41421356: infinity", "inf")],
    );
    assert_continuous(
        "(k^2 - 2)*s + 1 + 0/(k^2 - 2)",
        "",
        &[
            ("-inf", "root -2 0 1 near -1.41421356: infinity+pole"),
            ("root -2 0 1 near 1.41421356: infinity+pole", "inf"),
        ],
    );
}

// ---- size

#[test]
fn ends_1e_minus_30_apart() {
    // z - 1 + (k - 1)(k - 1 - 1e-30): outside between 1 and 1 + 1e-30 only.
    let found = certified_set_of(discrete("z - 1 + (k - 1)*(k - 1 - 1e-30)", "min = 0, max = 2").ask().free("k"));
    assert_eq!(found.intervals().len(), 2);
    let end = |e: &Option<jurist_engine::stability::End>| e.as_ref().unwrap().value.exact().unwrap();
    assert_eq!(end(&found.intervals()[0].upper), number("1"));
    assert_eq!(end(&found.intervals()[1].lower), number("1") + number("1e-30"));
    // The other way round: stable only between.
    assert_discrete(
        "z - 1 - (k - 1)*(k - 1 - 1e-30)",
        "",
        &[("1: z=1", "1000000000000000000000000000001/1000000000000000000000000000000: z=1")],
    );
    // Irrational: z - 1 + (k^2 - 2)^2 - 1e-60 is outside within about 3.5e-31 of sqrt 2.
    let found = certified_set_of(discrete("z - 1 + (k^2 - 2)^2 - 1e-60", "min = 0").ask().free("k"));
    assert_eq!(found.intervals().len(), 2);
    let (a, b) = (found.intervals()[0].upper.clone().unwrap(), found.intervals()[1].lower.clone().unwrap());
    let gap = b.value.refined(&number("1e-60")).enclosure().0 - a.value.refined(&number("1e-60")).enclosure().1;
    assert!(number("7e-31") < gap && gap < number("8e-31"));
    assert_ne!(a.value.decimal(40), b.value.decimal(40));
}

#[test]
fn coefficients_of_500_digits() {
    let big = format!("1{}7", "0".repeat(498));
    // big z - k
    assert_discrete(&format!("{big}*z - k"), "", &[(&format!("-{big}: z=-1"), &format!("{big}: z=1"))]);
    assert_discrete(&format!("z - k/{big}"), "", &[(&format!("-{big}: z=-1"), &format!("{big}: z=1"))]);
    assert_continuous(&format!("s^2 + {big}*s + k - {big}"), "", &[(&format!("{big}: s=0"), "inf")]);
    // A distance of 1e-500 from the circle decides.
    let lp = discrete(&format!("z - 1 + k/{big}"), "");
    assert_eq!(counted(&lp, "1").0, Stable);
    assert_eq!(counted(&lp, "0").0, Marginal);
    assert_eq!(counted(&lp, "-1").0, Unstable);
}

#[test]
fn order_twenty() {
    // z^20 - k: modulus |k|^(1/20).
    assert_discrete("z^20 - k", "", &[("-1: complex pair", "1: z=1+z=-1+complex pair")]);
    // z^19 (z - 1) + k, the delayed integrator: stable for 0 < k < 2 sin(pi/78), an algebraic number of high degree.
    let found = certified_set_of(discrete("z^19*(z - 1) + k", "").ask().free("k"));
    assert_eq!(found.intervals().len(), 1);
    let (lower, upper) = (found.intervals()[0].lower.clone().unwrap(), found.intervals()[0].upper.clone().unwrap());
    assert_eq!((lower.value.exact(), lower.causes.to_string().as_str()), (Some(number("0")), "z=1"));
    // 2 sin(pi/78) = 0.080531549...
    assert_eq!(upper.causes.to_string(), "complex pair");
    assert!(upper.value.decimal(12).starts_with("0.0805"), "{}", upper.value.decimal(12));
    // (s + 1)^20 + k leaves at the pair nearest the axis.
    let found = certified_set_of(continuous("(s + 1)^20 + k", "").ask().free("k"));
    assert_eq!(found.intervals().len(), 1);
    assert_eq!(found.intervals()[0].lower.as_ref().unwrap().causes.to_string(), "s=0");
}

// ---- domains

#[test]
fn domains_cut_through() {
    assert_discrete("z + k", "min = 0", &[("0: domain", "1: z=-1")]);
    assert_discrete("z + k", "max = '1/2'", &[("-1: z=1", "1/2: domain")]);
    assert_discrete("z + k", "min = 2, max = 3", &[]);
    assert_discrete("z + k", "min = '-1/3', max = '1/7'", &[("-1/3: domain", "1/7: domain")]);
}

#[test]
fn roots_exactly_at_the_ends_of_the_domain() {
    assert_discrete("z + k", "min = -1, max = 1", &[("-1: z=1+domain", "1: z=-1+domain")]);
    assert_discrete("z + k", "min = 1, max = 3", &[]);
    assert_discrete("z + k", "min = -5, max = -1", &[]);
    assert_continuous("k*s + 1", "min = 0", &[("0: infinity+domain", "inf")]);
    assert_discrete("z - k/k/2", "min = 0, max = 4", &[("0: pole+domain", "4: domain")]);
    // A tangency at the end of the domain.
    assert_discrete("z - 1 + (k - 1)^2", "min = 1, max = 2", &[("1: z=1+domain", "2: domain")]);
    // An end just beyond an irrational one, by 1e-40.
    let below = "1.4142135623730950488016887242096980785696";
    let above = "1.4142135623730950488016887242096980785697";
    let exact = |text: &str| format!("{}: domain", number(text));
    let root = |cause: &str| format!("root -2 0 1 near 1.41421356: {cause}");
    assert_discrete("z - 3 + k^2", &format!("min = 0, max = '{below}'"), &[]);
    assert_discrete("z - 3 + k^2", &format!("min = 0, max = '{above}'"), &[(&root("z=1"), &exact(above))]);
    assert_continuous("s + k^2 - 2", &format!("min = '{below}'"), &[(&root("s=0"), "inf")]);
    assert_continuous("s + k^2 - 2", &format!("min = '{above}'"), &[(&exact(above), "inf")]);
}

/// Both roots of z^2 - z + 1/4 are 1/2; no root is nearer to 0 than by a negative radius.
#[test]
fn negative_radii_are_never_the_answer() {
    let lp = discrete("z^2 - z + k", "nominal = 0.25");
    let domain = Range::between(Some(number("-1")), Some(number("2")));
    let set = certified_set_of(lp.ask().free("radius").domain("radius", domain));
    assert_eq!(set.intervals().len(), 1);
    assert_eq!(set.intervals()[0].lower.as_ref().unwrap().value.decimal(5), "0.5");
}

/// All roots of z^2 are 0: every positive radius holds them, and only the question's domain ends there.
#[test]
fn radius_zero_is_the_end_of_the_domain_only() {
    let lp = load("time = 'discrete'\n[loop]\ncharacteristic = 'z^2'");
    let set = certified_set_of(lp.ask().free("radius"));
    assert_eq!(set.intervals()[0].lower.as_ref().unwrap().causes.to_string(), "domain");
}
