use super::*;
use crate::answer::Verdict;
use crate::error::Source;
use crate::model::Model;
use crate::problem::Ask;
use crate::response::OpenLoop;
use crate::stability::{Shape, StableSet, stable_set_of_parts};
use jurist_algebra::number::Integer;
use nodes::interpolation;

/// A unity feedback loop: the controller's transfer function and that of the plant behind a zero-order hold.
fn problem(controller: &str, plant: &str, sample_time: &str, domain: &str) -> Arc<Problem> {
    problem_with_delay(controller, plant, sample_time, "0", domain)
}

/// The same with dead time.
fn problem_with_delay(controller: &str, plant: &str, sample_time: &str, delay: &str, domain: &str) -> Arc<Problem> {
    let text = format!(
        r#"
        time = "discrete"
        sample_time = "{sample_time}"
        [parameters]
        K = {{ nominal = 1{domain} }}
        [loop]
        inputs = ["r"]
        outputs = ["y"]
        [[block]]
        input = "r - y"
        output = "u"
        transfer = "{controller}"
        [[block]]
        input = "u"
        output = "y"
        transfer = "{plant}"
        discretize = {{ method = "zoh", delay = "{delay}" }}
        "#
    );
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    model.ask().free("K").problem().unwrap()
}

/// The set by enclosures, which has to be known.
fn by_enclosures(problem: &Problem) -> StableSet {
    let budget = Budget::unlimited();
    match problem.enclosed_parts(&budget).unwrap().expect("a loop of this form") {
        EnclosedParts::Unstable => StableSet::from_intervals(Vec::new(), Vec::new()),
        EnclosedParts::Parts(parts) => {
            stable_set_of_parts(&parts, &problem.parameter().domain, Shape::UnitDisc, &budget).unwrap()
        }
    }
}

/// Ends with their causes, to twelve digits.
pub(super) fn ends(set: &StableSet) -> Vec<[Option<(String, String)>; 2]> {
    assert!(set.undecided().is_empty());
    let shown = |end: &Option<crate::stability::End>| {
        end.as_ref().map(|end| (end.value.decimal(12), format!("{} {:?}", end.causes, end.pair.is_some())))
    };
    set.intervals().iter().map(|i| [shown(&i.lower), shown(&i.upper)]).collect()
}

#[test]
fn small_loops_have_the_set_of_the_exact_polynomial() {
    let loops = [
        ("K", "1/(s*(s + 1))", "1/10", ", min = 0"),
        ("K", "1/(s*(s + 1))", "1", ""),
        ("K*(z + 1/2)/(z - 1)", "1/((s + 1)*(s + 2))", "1/5", ", min = 0"),
        ("K/(z - 1/2)", "(s - 1)/(s^2 + s/5 + 3)", "1/3", ""),
        ("(K*z + 1 - K)/(z - 1/3)", "1/(s^2 + 4)", "1/7", ", min = -3, max = 5"),
        ("K*(z + 1/3)/(z - 1)", "2/(s + 1)", "1/4", ", max = 3"),
        ("K + 1/(z - 1/2)", "1/(s - 1)", "1/4", ""),
        // Zeros of the controller, at which the value does not depend on K.
        ("K*(z + 1)/(z - 1)", "2/((s + 1)*(s + 3))", "1/4", ""),
        ("K*z/(z - 1)", "1/((s + 1)*(s + 2))", "1/5", ""),
        ("K*z^2/((z - 1/2)*(z + 1/3))", "1/(s + 1)", "1/5", ""),
    ];
    let mut known = 0;
    for (controller, plant, time, domain) in loops {
        let problem = problem(controller, plant, time, domain);
        let budget = Budget::unlimited();
        let exact = problem.stable_set(&budget).unwrap();
        let Some(EnclosedParts::Parts(parts)) = problem.enclosed_parts(&budget).unwrap() else { panic!("one part") };
        match stable_set_of_parts(&parts, &problem.parameter().domain, Shape::UnitDisc, &budget) {
            Ok(set) => {
                assert_eq!(ends(&set), ends(exact.value()), "{controller} {plant}");
                known += 1;
            }
            Err(stopped) => assert!(stopped.stop.is_precision(), "{controller} {plant}: {stopped}"),
        }
    }
    assert!(known >= 8, "{known}");
}

/// A share of a sample: the exact polynomial has products of exponentials, the enclosed one their sums.
#[test]
fn dead_time_of_a_share_of_a_sample_is_an_identity_at_rest() {
    for (plant, time, delay) in [
        ("1/(s*(s + 1))", "1/10", "3/100"),
        ("1/(s + 1)", "1/2", "4/5"),
        ("(2 - s)/((s + 1)*(s + 2))", "1/5", "1/10"),
        ("1/(s^2 + s/5 + 1)", "1/3", "1/4"),
    ] {
        let problem = problem_with_delay("K", plant, time, delay, "");
        let exact = problem.stable_set(&Budget::unlimited()).unwrap();
        assert_eq!(ends(&by_enclosures(&problem)), ends(exact.value()), "{plant}");
    }
    // Two modes: exact polynomials took more than a minute, or more memory than there was.
    let problem = problem_with_delay("K", "1/((s^2 + s/5 + 1)*(s^2 + s/10 + 9))", "1/5", "13/100", "");
    limits_are_right(&problem, false, true);
}

/// The open loop from enclosures is the exact one.
#[test]
fn open_loops_are_those_of_exact_polynomials() {
    for (controller, plant, delay) in [
        ("2*(z - 9/10)/(z - 1)", "1/(s + 1)", "0"),
        ("z/(z - 1)", "1/((s + 1)*(s + 2))", "3/100"),
        ("1", "2/(s*(s + 1))", "7/100"),
        ("1/2", "1/(s^2 + s/5 + 1)", "0"),
    ] {
        let problem = problem_with_delay(controller, plant, "1/10", delay, "");
        let problem = problem.model().ask().problem().unwrap();
        let budget = Budget::unlimited();
        let exact = OpenLoop::of(&problem, None, &budget).unwrap();
        let opened = problem.model().opened_in_numbers(exact.cut(), &[], problem.set(), &budget).unwrap();
        let found = EnclosedQuotient::of(&opened).expect("a loop of this form");
        let enclosed = [&found.denominator, &found.numerator].map(|p| {
            let value = |c| found.symbols.enclose(c, 300).lower();
            p.coeffs().iter().map(value).collect::<Vec<Rational>>()
        });
        let monic = |[d, n]: [Vec<Rational>; 2]| {
            let lead = d.last().unwrap().recip().unwrap();
            d.iter().chain(&n).map(|c| c * &lead).collect::<Vec<Rational>>()
        };
        let (exact, enclosed) = (monic(exact.coefficients(300)), monic(enclosed));
        let is_close = |(a, b): (&Rational, &Rational)| (a - b).abs() < Rational::dyadic(&Integer::ONE, 250);
        assert_eq!(exact.len(), enclosed.len(), "{controller} {plant}");
        assert!(exact.iter().zip(&enclosed).all(is_close), "{controller} {plant}: {exact:?} {enclosed:?}");
    }
}

/// Two modes: the gain margin is the limit of a gain, which another polynomial has.
#[test]
#[ignore = "long: CI runs it"]
fn the_gain_margin_of_several_modes_is_the_limit_of_the_gain() {
    let plant = "1/((s^2 + s/5 + 1)*(s^2 + s/10 + 9))";
    let problem = problem_with_delay("K*(z - 9/10)/(2*(z - 1))", plant, "1/20", "1/50", "");
    let set = by_enclosures(&problem);
    let limit = set.intervals()[0].upper.as_ref().unwrap().value.decimal(12);
    let nominal = problem.model().ask().problem().unwrap();
    let margins = nominal.margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap();
    let stable = margins.value().stable.as_ref().expect("a stable loop");
    assert_eq!(stable.gain.upper.as_ref().unwrap().value.decimal(12), limit);
}

#[test]
fn parts_without_the_parameter_are_counted() {
    // A second plant that nothing acts on.
    let with = |own: &str| {
        let text = format!(
            r#"
            time = "discrete"
            sample_time = 0.1
            [parameters]
            K = 1
            [loop]
            inputs = ["r", "d"]
            outputs = ["y"]
            [[block]]
            input = "K*(r - y - x)"
            output = "y"
            transfer = "1/(s + 1)"
            discretize = "zoh"
            [[block]]
            input = "d"
            output = "x"
            transfer = "{own}"
            discretize = "zoh"
            "#
        );
        let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
        by_enclosures(&model.ask().free("K").problem().unwrap())
    };
    assert!(with("1/(s^2 - s/10 + 2)").is_empty());
    assert_eq!(with("1/(s^2 + s/10 + 2)").intervals().len(), 1);
}

/// Order 7 with three modes, and order 12 with five: exact polynomials over all constants are not to be had.
#[test]
#[ignore = "long: CI runs it"]
fn several_modes_have_their_limits() {
    let plants = [
        "1/((s+1)*(s^2+0.4*s+4)*(s^2+0.66*s+11)*(s^2+s+26))",
        "1/(s*(s+1)*(s^2+0.4*s+4)*(s^2+0.66*s+11)*(s^2+s+26)*(s^2+1.3*s+40)*(s^2+2*s+71))",
    ];
    let domains = ["", ", min = 0"];
    for (i, plant) in plants.into_iter().enumerate() {
        for (j, domain) in domains.into_iter().enumerate() {
            // One domain of each by default, both in CI.
            if i == j || std::env::var_os("JURIST_THOROUGH").is_some() {
                limits_are_right(&problem("K", plant, "0.1", domain), plant.contains("s*(s"), domain.is_empty());
            }
        }
    }
}

fn limits_are_right(problem: &Problem, is_integrating: bool, is_free: bool) {
    let set = by_enclosures(problem);
    let [interval] = set.intervals() else { panic!("{set:?}") };
    let [lower, upper] = [&interval.lower, &interval.upper].map(|end| end.as_ref().unwrap());
    if !is_free {
        assert_eq!(lower.causes.to_string(), if is_integrating { "z=1+domain" } else { "domain" });
    }
    assert!(upper.pair.is_some());
    let (lo, hi) = upper.value.refined(&Rational::dyadic(&Integer::ONE, 60)).enclosure();
    let nearby = Rational::dyadic(&Integer::ONE, 40);
    let verdict = |k: Rational| {
        let point = problem.model().ask().set("K", k).verdict(&Budget::unlimited()).unwrap();
        point.value().verdict
    };
    assert_eq!(verdict(lo - &nearby), Verdict::Stable);
    assert_eq!(verdict(hi + &nearby), Verdict::Unstable);
    let (lo, hi) = lower.value.refined(&Rational::dyadic(&Integer::ONE, 60)).enclosure();
    assert_eq!(verdict(hi + &nearby), Verdict::Stable);
    assert!(verdict(lo - &nearby) == Verdict::Unstable || !is_free && !is_integrating);
}

#[test]
fn a_loop_with_an_inner_region_is_scaled() {
    let plain = problem("K", "1/(s*(s + 1))", "1/10", "");
    let region = Region::Disc(Bound::Number(Rational::new(9.into(), 10.into())));
    let bounded = plain.model().ask().free("K").within(region).problem().unwrap();
    let exact = bounded.stable_set(&Budget::unlimited()).unwrap();
    assert_eq!(ends(&by_enclosures(&bounded)), ends(exact.value()));
}

#[test]
fn powers_follow_from_whole_numbers() {
    // 2 - 3 K + 5 K^3 at 0, 1, 2, 3.
    let at = |k: i64| Rational::from(2 - 3 * k + 5 * k * k * k);
    let found: Vec<Rational> = interpolation(3)
        .iter()
        .map(|weights| weights.iter().zip(0..).fold(Rational::ZERO, |sum, (w, k)| sum + w * &at(k)))
        .collect();
    assert_eq!(found, [2, -3, 0, 5].map(Rational::from));
}

#[test]
fn what_is_not_linear_is_left_to_algebra() {
    let known = |controller: &str| {
        problem(controller, "1/(s + 1)", "1", "").enclosed_parts(&Budget::unlimited()).unwrap().is_some()
    };
    assert!(known("K") && known("1/(z - K)"));
    assert!(!known("K^2") && !known("1/K"));
}

/// For `1/s^2` the value at -1 does not depend on `K`: exact numbers show that, and enclosures never.
#[test]
fn identities_of_other_numbers_are_left_to_algebra() {
    let problem = problem("K", "1/s^2", "1/2", "");
    let budget = Budget::unlimited();
    let Some(EnclosedParts::Parts(parts)) = problem.enclosed_parts(&budget).unwrap() else { panic!("one part") };
    let stopped = stable_set_of_parts(&parts, &problem.parameter().domain, Shape::UnitDisc, &budget).unwrap_err();
    assert!(stopped.stop.is_precision());
    assert!(problem.stable_set(&budget).unwrap().value().undecided().is_empty());
}
