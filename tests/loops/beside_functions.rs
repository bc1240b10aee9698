//! Dead time beside functions of the free parameter: the set in the parameter is that of the same loop in the value of the function.

use crate::helpers::model::{keeping, read};
use crate::helpers::number::{number, ratio};
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::ball::{Ball, cos_sin, exp};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::answer::Verdict;
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::stability::{Range, StableSet};

/// A loop with the characteristic function `function` of a parameter `p`.
fn of(function: &str) -> Model {
    read(&format!("time = 'continuous'\n[parameters]\np = 1\n[loop]\ncharacteristic = '{function}'\n"))
}

fn within(model: &Model, [low, high]: [&Rational; 2]) -> StableSet {
    let domain = Range::between(Some(low.clone()), Some(high.clone()));
    keeping(model, &["p"]).domain("p", domain).stable_set(&Budget::unlimited()).unwrap().into_value()
}

/// The ends that are no ends of the domain, with what happens there.
fn ends(set: &StableSet) -> Vec<(Real, String)> {
    assert!(set.undecided().is_empty());
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    let ends = ends.filter(|end| end.causes.to_string() != "domain");
    ends.map(|end| (end.value.clone(), end.causes.to_string())).collect()
}

const BITS: u64 = 80;

fn ball(x: &Real) -> Ball {
    let (lo, hi) = x.refined(&Rational::dyadic(&1.into(), BITS)).enclosure();
    Ball::between(&lo, &hi, BITS)
}

/// An increasing function of a parameter, with a range of the parameter whose images are rational bounds of nearly the range of values.
struct Inner {
    text: &'static str,
    at: fn(&Ball) -> Ball,
    range: [&'static str; 2],
}

const INNER: [Inner; 4] = [
    Inner { text: "exp(p)", at: exp, range: ["-2", "3/2"] },
    Inner { text: "sqrt(p)", at: |p| p.sqrt().expect("not negative"), range: ["1", "20"] },
    Inner { text: "sin(p/2)*4", at: |p| cos_sin(&half(p)).1.scaled(&4.into()), range: ["1/20", "3"] },
    Inner { text: "(p + exp(p/3))", at: |p| p.add(&exp(&third(p))), range: ["-1/2", "4"] },
];

fn half(p: &Ball) -> Ball {
    p.mul(&Ball::from_rational(&ratio(1, 2), BITS))
}

fn third(p: &Ball) -> Ball {
    p.mul(&Ball::from_rational(&ratio(1, 3), BITS))
}

/// A characteristic function in `#` with dead time.
fn random_function(random: &mut Random) -> String {
    let tau = ratio(1 + random.below(12) as i64, 10);
    let (a, b) = (1 + random.below(4), ratio(1 + random.below(8) as i64, 4));
    match random.below(5) {
        0 => format!("(s + {a})*(s + #) + {b}*exp(-{tau}*s)*(2*s + 3)"),
        1 => format!("s*(s^2 + {b}*s + {a}) + #*exp(-{tau}*s)*(s + 1/3)"),
        2 => format!("(#*s + 1)*(s + {b}) + {a}*exp(-{tau}*s) + exp(-2*{tau}*s)/3"),
        3 => format!("s^2 + {b}*s + # + (#^2/4 - {a})*exp(-{tau}*s)"),
        _ => format!("(s - 1/2)*(s + {b}*#) + {a}*#*exp(-{tau}*s/4)"),
    }
}

fn agree(function: &str, inner: &Inner) {
    let range = inner.range.map(number);
    let [low, high] = range.each_ref().map(|x| (inner.at)(&Ball::from_rational(x, BITS)));
    let found = ends(&within(&of(&function.replace('#', inner.text)), range.each_ref().map(|x| x)));
    // The values of the function reach as far, up to a part of a million million.
    let known = ends(&within(&of(&function.replace('#', "p")), [&low.lower(), &high.upper()]));
    assert_eq!(found.len(), known.len(), "{function} {}", inner.text);
    for ((p, causes), (value, others)) in found.iter().zip(&known) {
        let image = (inner.at)(&ball(p));
        assert!(image.intersection(&ball(value)).is_some(), "{function} {}: {}", inner.text, p.decimal(20));
        assert!(image.width_units().bit_length() < 16, "{function} {}", inner.text);
        assert_eq!(causes, others, "{function} {}", inner.text);
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn the_set_is_that_of_the_values_of_the_function() {
    let mut random = Random::new(20_261_129);
    for i in 0..count(4, 12) {
        let function = random_function(&mut random);
        agree(&function, &INNER[i % INNER.len()]);
    }
}

#[test]
fn a_gain_that_is_an_exponential_has_its_limit_at_a_logarithm() {
    let set = within(&of("s + exp(p)*exp(-s)"), [&number("-1"), &number("1")]);
    let [(value, causes)] = ends(&set).try_into().unwrap();
    // ln(pi/2)
    assert_eq!((value.decimal(30).as_str(), causes.as_str()), ("0.451582705289454864726195229895", "complex pair"));
}

/// The first piece, with too long a series for `exp(-3p)`, is cut just where the root is at `s = 0`.
#[test]
fn a_root_at_zero_where_two_pieces_meet() {
    let set = within(&of("s + p - 509/1024 + exp(-3*p)*s*exp(-s)/4"), [&number("0"), &number("1")]);
    let [(value, causes)] = ends(&set).try_into().unwrap();
    assert_eq!((value.exact(), causes.as_str()), (Some(ratio(509, 1024)), "s=0"));
    assert!(set.contains(&number("3/4")) && !set.contains(&number("1/4")));
}

/// Where a gain begins at 0 a root is at `s = 0`.
#[test]
fn gains_that_begin_at_zero() {
    let all = [number("0"), number("6")];
    let range = all.each_ref();
    for (function, value) in [("s + sin(p)*exp(-s)", "3.141592654"), ("s + p*exp(-p/100)*exp(-s)", "1.596068455")] {
        let set = within(&of(function), range);
        let last = ends(&set).last().unwrap().0.clone();
        assert_eq!(
            (set.intervals()[0].lower.as_ref().unwrap().value.decimal(3), last.decimal(10)),
            ("0".into(), value.into())
        );
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn square_roots_have_no_series_at_zero() {
    let all = [number("0"), number("6")];
    let range = all.each_ref();
    let set = within(&of("s + sqrt(p)*exp(-s)"), range);
    let [open] = set.undecided() else { panic!("{:?}", set.undecided()) };
    assert!(open.lower == Some(number("0")) && open.upper.clone().unwrap() < number("1e-7"));
    // (pi/2)^2
    assert_eq!(set.intervals()[0].upper.as_ref().unwrap().value.decimal(12), "2.46740110027");
    let set = within(&of("s + 1 + exp(-s)*sqrt(p - 2)"), range);
    assert!(set.contains(&number("2.001")) && !set.contains(&number("1")) && set.undecided().len() == 1);
}

/// Two functions of one parameter, in coefficients and beside the parameter itself: points are decided one by one.
#[test]
#[ignore = "long: CI runs it"]
fn sets_beside_functions_agree_with_decisions_at_points() {
    let mut seen = [0, 0];
    for function in [
        "(s + cos(p))*(s + 2) + p*exp(-s/3)",
        "s^2 + sqrt(p + 1)*s + exp(-p) + sin(3*p)*exp(-s/2)",
        "s*(s + 1) + exp(-p/2)*(p*s + 1)*exp(-s*(1/10 + p/5))",
    ] {
        let model = of(function);
        let set = within(&model, [&number("1/10"), &number("6")]);
        assert!(set.undecided().is_empty());
        for k in 0..24 {
            let value = ratio(1 + 4 * k, 17) + ratio(1, 10);
            let verdict = model.ask().set("p", value.clone()).verdict(&Budget::unlimited()).unwrap();
            let stable = verdict.value().verdict == Verdict::Stable;
            assert_eq!(set.contains(&value), stable, "{function} {value}");
            seen[usize::from(stable)] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 8), "{seen:?}");
}

#[test]
fn a_domain_without_an_end_is_asked_for_both() {
    let question = keeping(&of("s + exp(p)*exp(-s)"), &["p"]);
    match question.stable_set(&Budget::unlimited()) {
        Err(Error::Refused(found)) => {
            let help = found.diagnostics()[0].help.as_deref().unwrap();
            assert!(help.contains("--domain p=LO..HI"), "{help}");
        }
        _ => panic!("the domain has no end"),
    }
}

#[test]
fn a_root_at_zero_for_all_values_is_stable_nowhere() {
    let all = [number("1"), number("2")];
    for function in ["(s - 1/2)*(s + 2*sqrt(p)) + sqrt(p)*exp(-s/10)", "s*(s + exp(p)*exp(-s))"] {
        assert!(ends(&within(&of(function), all.each_ref())).is_empty(), "{function}");
        assert!(within(&of(function), all.each_ref()).intervals().is_empty(), "{function}");
    }
    // Beside constants, too.
    let set = within(&of("(s - sqrt(2)/2)*(s + 2*p) + sqrt(2)*p*exp(-s/10)"), all.each_ref());
    assert!(set.intervals().is_empty() && set.undecided().is_empty());
}

/// The roots of a factor depend neither on the parameter nor on the dead time.
#[test]
fn a_factor_without_the_parameter_is_judged_exactly() {
    let all = [number("0"), number("1")];
    let whole = |factor: &str| within(&of(&format!("({factor})*(s + exp(p)*exp(-s))")), all.each_ref());
    for factor in ["s^2 + 4", "s", "s - 1/1000000", "s + 1/1000000"] {
        let set = whole(factor);
        assert_eq!(set.intervals().is_empty(), factor != "s + 1/1000000", "{factor}");
        assert!(set.undecided().is_empty(), "{factor}");
    }
    let [stable, with_another] = ["1", "s^2 + s/1000000 + 4"].map(|factor| ends(&whole(factor)));
    assert_eq!(stable[0].0.decimal(30), with_another[0].0.decimal(30));
}
