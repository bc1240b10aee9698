//! Rounded controllers of random loops against a criterion of Schur and Cohn in rationals.

use crate::helpers::certificates::checkers::accept;
use crate::helpers::model::read;
use crate::helpers::number::ratio;
use crate::helpers::random::Random;
use crate::helpers::schur::{closed, is_schur};
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::response::Requirements;
use jurist_engine::stability::boxes::BoxDecision;
use jurist_ship::answer::{Beside, ShipAnswer};
use jurist_ship::asked::{Asked, Overrides};

/// Whether all roots are inside of the circle of radius 7/8.
fn is_far_inside(polynomial: &[Rational]) -> bool {
    let mut power = Rational::ONE;
    let scaled: Vec<Rational> = polynomial
        .iter()
        .map(|c| {
            let out = c * &power;
            power = &power * &ratio(8, 7);
            out
        })
        .collect();
    is_schur(&scaled)
}

/// A stable loop with a root near the circle: a controller of order one or two, a plant of order one or two.
fn a_loop(random: &mut Random) -> [[Vec<Rational>; 2]; 2] {
    let mut value = |scale: i64| ratio(random.below(401) as i64 - 200, scale);
    loop {
        let order = 1 + usize::from(value(1).is_negative());
        let mut fraction = |order: usize, scale: i64| -> [Vec<Rational>; 2] {
            let above: Vec<Rational> = (0..=order).map(|_| value(scale)).collect();
            let below = std::iter::once(Rational::ONE).chain((0..order).map(|_| value(130))).collect();
            [above, below]
        };
        let (controller, mut plant) = (fraction(order, 700), fraction(3 - order, 300));
        plant[0][0] = Rational::ZERO;
        let closed = closed(&controller, &plant);
        if is_schur(&closed) && !is_far_inside(&closed) && !controller[0][0].is_zero() {
            return [controller, plant];
        }
    }
}

fn list(coefficients: &[Rational]) -> String {
    let texts: Vec<String> = coefficients.iter().map(|c| format!("\"{c}\"")).collect();
    format!("[{}]", texts.join(", "))
}

fn model_of([controller, plant]: &[[Vec<Rational>; 2]; 2]) -> String {
    let block = |name: &str, wiring: &str, f: &[Vec<Rational>; 2]| {
        format!("[[block]]\nname = '{name}'\n{wiring}\nnum = {}\nden = {}\n", list(&f[0]), list(&f[1]))
    };
    format!(
        "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n{}{}",
        block("controller", "input = 'r - y'\noutput = 'u'", controller),
        block("plant", "input = 'u'\noutput = 'y'", plant)
    )
}

fn shipped(model: &str, format: &str, realisation: &str) -> Option<ShipAnswer> {
    let model = read(model);
    let overrides = Overrides {
        block: Some("controller".into()),
        format: Some(format.into()),
        realisation: Some(realisation.into()),
        ..Overrides::default()
    };
    let asked = Asked::of(&model, &overrides).unwrap();
    let problem = model.ask().problem().unwrap();
    let beside = Beside { fewest: true, ..Beside::default() };
    ShipAnswer::of(&problem, asked, &Requirements::default(), &beside, &Budget::unlimited()).ok()
}

/// The fraction of the stored controller.
fn stored(answer: &ShipAnswer) -> [Vec<Rational>; 2] {
    let after = &answer.shipped.after;
    [&after.numerator, &after.denominator].map(|row| row.iter().map(|c| c.lower().clone()).collect())
}

#[test]
fn verdicts_of_random_roundings_are_those_of_schur_and_cohn() {
    let random = &mut Random::new(41);
    let mut counts = [0, 0, 0];
    for case in 0..count(24, 60) {
        let parts = a_loop(random);
        let text = model_of(&parts);
        let realisation = ["df1", "df2", "df2t", "delta"][case % 4];
        let format = ["Q3.1", "Q3.2", "Q3.3", "float32"][random.below(4)];
        let Some(answer) = shipped(&text, format, realisation) else {
            // Out of range in the delta operator, whose coefficients are large.
            assert!(realisation == "delta" && format != "float32", "{text}");
            continue;
        };
        let expected = is_schur(&closed(&stored(&answer), &parts[1]));
        let found = answer.rounded.verdict.value().verdict == Verdict::Stable;
        assert_eq!(found, expected, "{text}{realisation} {format}");
        counts[usize::from(found)] += 1;
        if realisation == "delta" {
            continue;
        }
        // Direct forms store what stands in the fraction: every rounding is a box of fractions.
        let every = answer.every_rounding.as_ref().map(|part| part.as_ref().unwrap());
        let Some(every) = every else { continue };
        let at = |point: &[Rational]| {
            let mut next = point.iter();
            let mut fraction = parts[0].clone();
            for c in fraction.iter_mut().flatten().filter(|c| !(c.is_zero() || c.abs().is_one())) {
                *c = next.next().unwrap().clone();
            }
            is_schur(&closed(&fraction, &parts[1]))
        };
        match &every.value().decision {
            BoxDecision::Stable(_) => {
                assert!(found, "the nearest rounding is one of all");
                for _ in 0..12 {
                    let point: Vec<Rational> = every
                        .value()
                        .sides
                        .iter()
                        .map(|side| {
                            let [low, high] = side.widths();
                            let share = ratio(random.below(9) as i64 - 4, 4);
                            side.nominal() + &(&share * if share.is_negative() { low } else { high })
                        })
                        .collect();
                    assert!(at(&point), "{text}{format} {point:?}");
                }
                counts[2] += 1;
            }
            BoxDecision::NotStable { witness: Some(witness) } => assert!(!at(&witness.point), "{text}{format}"),
            other => panic!("{other:?}"),
        }
    }
    assert!(counts.iter().all(|seen| *seen > count(1, 5)), "{counts:?}");
}

/// Whether every rounding holds; `None` where that is not decided. Of a controller without coefficients to round it is so where the loop is
/// stable.
fn every_rounding_holds(answer: &ShipAnswer) -> Option<bool> {
    match &answer.every_rounding {
        None => Some(answer.exact.verdict.value().verdict == Verdict::Stable),
        Some(Err(_)) => None,
        Some(Ok(answer)) => match &answer.value().decision {
            BoxDecision::Stable(_) => Some(true),
            BoxDecision::NotStable { .. } => Some(false),
            _ => None,
        },
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn fewest_bits_are_those_that_a_search_finds() {
    let random = &mut Random::new(43);
    for _ in 0..count(1, 6) {
        let parts = a_loop(random);
        let text = model_of(&parts);
        let holds = |bits: i64| {
            let answer = shipped(&text, &format!("Q8.{bits}"), "df1").unwrap();
            (every_rounding_holds(&answer), answer.rounded.verdict.value().verdict == Verdict::Stable)
        };
        let answer = shipped(&text, "Q8.9", "df1").unwrap();
        let Some(Ok(fewest)) = &answer.fewest else { panic!("fixed point has fewest bits") };
        let proved = fewest.every_rounding.unwrap();
        let last = (proved + 2).max(4);
        for bits in 0..=last {
            let (every, nearest) = holds(bits);
            if shipped(&text, &format!("Q8.{bits}"), "df1")
                .unwrap()
                .shipped
                .coefficients
                .iter()
                .all(|c| c.value.is_zero())
            {
                continue;
            }
            if bits >= proved {
                assert_eq!((every, nearest), (Some(true), true), "{text}{bits}");
            } else {
                assert_eq!(nearest, fewest.nearest.contains(&bits), "{text}{bits} {fewest:?}");
            }
            if fewest.refuted.is_some_and(|refuted| bits <= refuted) {
                assert_eq!(every, Some(false), "{text}{bits} {fewest:?}");
            }
        }
    }
}

#[test]
fn certificates_of_every_rounding_are_accepted() {
    let random = &mut Random::new(47);
    for _ in 0..3 {
        let answer = shipped(&model_of(&a_loop(random)), "Q8.20", "df1").unwrap();
        let every = answer.every_rounding.unwrap().unwrap();
        let text = every.problem().model().source().text.clone();
        accept(&text, &every.certificate(&Budget::unlimited()).unwrap());
        let verdict = &answer.rounded.verdict;
        accept(&verdict.problem().model().source().text, &verdict.certificate(&Budget::unlimited()).unwrap());
    }
}
