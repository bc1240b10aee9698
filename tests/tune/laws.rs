//! Laws of best gains: on random loops, against sets of requirements, and against closed forms.

use crate::helpers::model::read;
use crate::helpers::number::ratio;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Poly, UniPoly};
use jurist_algebra::real::Real;
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use jurist_engine::response::{Level, LevelAsked, Requirements};
use jurist_tune::answer::{Best, Optimum, Outcome, Place, TuneAnswer};
use jurist_tune::asked::{Asked, Gain};
use proptest::prelude::*;

/// A loop `K num/den` in one line's notation, with real poles.
fn loop_of(time: &str, variable: &str, zero: Option<Rational>, poles: &[Rational]) -> Model {
    let factor = |x: &Rational| format!("({variable} - ({x}))");
    let numerator = zero.as_ref().map_or("1".into(), factor);
    let denominator: Vec<String> = poles.iter().map(factor).collect();
    read(&format!(
        "time = '{time}'\nparameters.K = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'loop'\n\
         input = 'r - y'\noutput = 'y'\ntransfer = 'K*{numerator}/({})'\n",
        denominator.join("*")
    ))
}

fn answer(model: &Model, objective: &str, bounds: [Option<Rational>; 2], requirements: Requirements) -> TuneAnswer {
    let gains = vec![Gain::new("K").within(bounds)];
    let asked = Asked::of(model, gains, objective, requirements).unwrap();
    TuneAnswer::of(&model.ask(), asked, &Budget::unlimited()).unwrap()
}

fn optimum(answer: &TuneAnswer) -> Option<&Optimum> {
    match &answer.outcome {
        Outcome::Optimum(optimum) => Some(optimum),
        _ => None,
    }
}

/// Whether some gain has a level.
fn is_had(model: &Model, level: Level, scale: &Rational) -> bool {
    let question = model.ask().free("K");
    let budget = Budget::unlimited();
    let set = |question: Question, list: &[_]| {
        question.problem().unwrap().required_set(list, None, &budget).unwrap().into_value()
    };
    let found = match level.asked(scale).unwrap() {
        LevelAsked::Region(region) => set(question.within(region), &[]),
        LevelAsked::Requirement(requirement) => set(question, &[requirement]),
    };
    assert!(found.undecided.is_empty());
    !found.intervals.is_empty()
}

fn poles(discrete: bool) -> impl Strategy<Value = Vec<Rational>> {
    let one = if discrete {
        (-18_i64..=24).prop_map(|k| ratio(k, 20)).boxed()
    } else {
        (-12_i64..=3).prop_map(|k| ratio(k, 2)).boxed()
    };
    proptest::collection::vec(one, 2..4)
}

fn beyond(value: &Real, share: i64, is_greater: bool) -> Rational {
    let (low, high) = value.refined_to_digits(20).enclosure();
    let size = low.abs().max(ratio(1, 1000));
    let step = size * ratio(1, share);
    if is_greater { high + step } else { low - step }
}

/// Just worse than the best a gain has the level, just better none.
fn check_level(model: &Model, level: Level) -> Result<bool, TestCaseError> {
    let word = if level.is_greatest_best() { "max" } else { "min" };
    let answer = answer(model, &format!("{word} {}", level.name()), [None, None], Requirements::default());
    let Some(found) = optimum(&answer) else { return Ok(false) };
    let Best::Exact(value) = &found.value else { return Ok(false) };
    let [low, high] = level.scale();
    let inside = |x: &Rational| *x > low && *x < high;
    let (worse, better) = (beyond(value, 1000, !level.is_rising()), beyond(value, 1000, level.is_rising()));
    if inside(&better) {
        prop_assert!(!is_had(model, level, &better), "{}: {better} is better than {}", level.name(), value.decimal(12));
    }
    if inside(&worse) {
        prop_assert!(is_had(model, level, &worse), "{}: nothing has {worse}, best {}", level.name(), value.decimal(12));
    }
    // What is said to be found is found.
    let scale = found.found_value.clone().expect("a level");
    let place = &found.found[0];
    let question = model.ask().set("K", place.clone());
    let budget = Budget::unlimited();
    let met = match level.asked(&scale).unwrap() {
        LevelAsked::Region(region) => {
            question.within(region).problem().unwrap().verdict(&budget).unwrap().value().verdict
                == jurist_engine::answer::Verdict::Stable
        }
        LevelAsked::Requirement(requirement) => {
            question.problem().unwrap().requirements_met(&[requirement], None, &budget).unwrap()[0].met
        }
    };
    prop_assert!(met, "{place} has not {scale}");
    Ok(true)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(12, 24) as u32))]

    #[test]
    fn best_levels_of_continuous_loops(poles in poles(false), zero in proptest::option::of(-9_i64..9), level in 0_usize..7) {
        let level = [Level::Decay, Level::ModulusMargin, Level::PhaseMargin, Level::GainMargin, Level::DiskMargin, Level::ComplementaryPeak, Level::Damping][level];
        let model = loop_of("continuous", "s", zero.filter(|z| *z != 0).map(|z| ratio(z, 4)), &poles);
        check_level(&model, level)?;
    }

    #[test]
    fn best_levels_of_discrete_loops(poles in poles(true), zero in proptest::option::of(-9_i64..9), level in 0_usize..6) {
        let level = [Level::Radius, Level::ModulusMargin, Level::PhaseMargin, Level::GainMargin, Level::DiskMargin, Level::ComplementaryPeak][level];
        let model = loop_of("discrete", "z", zero.map(|z| ratio(z, 10)), &poles);
        check_level(&model, level)?;
    }

    /// `K/(s (s + p) (s + q))`: the largest decay is the root of `3 x^2 - 2 (p + q) x + p q` that is nearer to 0.
    #[test]
    fn the_break_point_of_three_poles(p in 1_i64..30, q in 1_i64..30) {
        let model = loop_of("continuous", "s", None, &[Rational::ZERO, ratio(-p, 3), ratio(-q, 3)]);
        let answer = answer(&model, "max decay", [None, None], Requirements::default());
        let found = optimum(&answer).expect("some gains are stable");
        let Best::Exact(value) = &found.value else { panic!("{:?}", found.value) };
        let known: UniPoly = Poly::from_i64(&[p * q, -6 * (p + q), 27]);
        let algebraic = value.algebraic().unwrap();
        prop_assert!(algebraic.sign_of(&known).is_eq());
        // The nearer root is below the middle of both.
        prop_assert!(value.compare_rational(&ratio(p + q, 9)).is_le());
        prop_assert!(matches!(found.at[0], Place::Exact(_)));
    }

    /// `K/(z (z - a))`: both roots at `a/2`, with the gain `a^2/4`.
    #[test]
    fn the_double_root_of_two_poles(a in 1_i64..40) {
        let model = loop_of("discrete", "z", None, &[Rational::ZERO, ratio(a, 20)]);
        let answer = answer(&model, "min radius", [None, None], Requirements::default());
        let found = optimum(&answer).expect("some gains are stable");
        let (Best::Exact(value), Place::Exact(place)) = (&found.value, &found.at[0]) else { panic!("{found:?}") };
        prop_assert_eq!((value.exact(), place.exact()), (Some(ratio(a, 40)), Some(ratio(a * a, 1600))));
    }

    /// A smaller box is not better, and a requirement beyond the optimum cannot be met.
    #[test]
    #[ignore = "long: CI runs it"]
    fn bounds_and_requirements_beyond_the_best(poles in poles(false), low in -20_i64..20, width in 1_i64..40) {
        let model = loop_of("continuous", "s", None, &poles);
        let whole = answer(&model, "max modulus_margin", [None, None], Requirements::default());
        let bounds = [Some(ratio(low, 2)), Some(ratio(low + width, 2))];
        let part = answer(&model, "max modulus_margin", bounds.clone(), Requirements::default());
        let Some(Best::Exact(best)) = optimum(&whole).map(|o| &o.value) else { return Ok(()) };
        if let Some(Best::Exact(inside)) = optimum(&part).map(|o| &o.value) {
            prop_assert!(inside.compare(best, &Budget::unlimited()).unwrap().is_le());
        }
        let required = |least: Rational| -> Option<bool> {
            let text = least.to_string();
            let list = Requirements::without_section(&model, &[("modulus_margin", &text)], &[], &Budget::unlimited()).unwrap();
            answer(&model, "none", [None, None], list).is_feasible()
        };
        prop_assert_eq!(required(beyond(best, 100, true)), Some(false));
        prop_assert_eq!(required(beyond(best, 100, false)), Some(true));
    }
}
