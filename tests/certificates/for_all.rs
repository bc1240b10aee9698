//! Certificates of requirements, of maps for all values, and of tolerances over every ring (`jurist/certificate/10`).

use crate::helpers::certificates::checkers::{accept, reject, reject_in_rust};
use crate::helpers::certificates::with;
use crate::helpers::folder::Folder;
use crate::helpers::model::read;
use crate::helpers::number::{number, ratio};
use crate::helpers::thorough::tried;
use jurist::certified::{certify_boxes, certify_required_intervals, certify_requirements, certify_tolerance};
use jurist::{Ask, Budget, Model, Rational, Requirement, Source, ToleranceRequest};
use jurist_check::{Limits, Step, check};
use jurist_engine::answer::BoxRequest;
use jurist_engine::response::{AllOf, MapForAll};
use jurist_engine::stability::Range;
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

/// A gain `K` and a plant with a parameter `a`, cut at the signal between them.
fn loop_of(time: &str, plant: &str, how: &str) -> String {
    format!(
        "time = '{time}'\nparameters = {{ K = {{ nominal = 1, min = 0 }}, a = {{ nominal = 1, min = '1/4', max = 6 }} }}\n\
         loop = {{ inputs = ['r'], outputs = ['y'] }}\n[[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
         [[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\n{how}"
    )
}

/// Rational in either time, over constants of a hold, and with dead time.
fn loops() -> [String; 4] {
    [
        loop_of("continuous", "(s + 2)/((s + 1)*(s^2 + a*s + 4))", ""),
        loop_of("discrete", "(z + 1/3)/(z*(z - 3/4)*(1 + a))", ""),
        loop_of("discrete", "1/(s*(a*s + 1))", "discretize = { method = 'zoh', T = 0.2 }\n"),
        loop_of("continuous", "exp(-0.2*s)/(s + a)", ""),
    ]
}

fn budget() -> Budget {
    Budget::unlimited()
}

/// Each margin is certified below its value and refuted above it, and the certificates do not prove each other's bounds.
#[test]
#[ignore = "long: CI runs it"]
fn margins_are_certified_from_both_sides() {
    let mut certified = 0;
    for (text, delayed) in loops().iter().zip([false, false, false, true]) {
        let problem = read(text).ask().set("K", number("3/2")).problem().unwrap();
        let margins = problem.margins(Some("u"), &Rational::ZERO, &budget()).unwrap();
        let stable = margins.value().stable.as_ref().unwrap();
        let degrees = stable.phase.degrees(40).map(|angle| angle.lower().clone());
        let modulus = stable.modulus.refined_to_digits(8).enclosure().0;
        let disk = stable.disk.alpha.as_ref().map(|alpha| alpha.refined_to_digits(8).enclosure().0);
        let peak = stable.peak_complementary.refined_to_digits(8).enclosure().0;
        let upper = stable.gain.upper.as_ref().map(|end| end.value.refined_to_digits(8).enclosure().0);
        let hundredths = |x: &Rational, share: i64| Rational::from((x * &ratio(share, 1)).floor()) * ratio(1, 100);
        let mut asked: Vec<(Requirement, bool)> = Vec::new();
        let mut both = |x: Option<Rational>, of: &dyn Fn(Rational) -> Option<Requirement>, more_is_less: bool| {
            for (share, is_less) in [(90, true), (112, false)] {
                let bound = x.as_ref().map(|x| hundredths(x, share));
                asked.extend(bound.and_then(of).map(|requirement| (requirement, is_less != more_is_less)));
            }
        };
        // Whole multiples of five degrees.
        let angle = |x: Rational| {
            let five = Rational::from((&x * &ratio(1, 5)).floor()) * ratio(5, 1);
            Requirement::phase_margin(&five).ok()
        };
        both(degrees, &angle, false);
        both(Some(modulus), &|x| Requirement::modulus_margin(x).ok(), false);
        both(disk, &|x| Requirement::disk_margin(x).ok(), false);
        both(Some(peak), &|x| Requirement::complementary_peak(x).ok(), true);
        both(upper, &|x| Requirement::gain_margin(&x).ok(), false);
        for (requirement, met) in asked {
            let one = std::slice::from_ref(&requirement);
            let found = problem.requirements_met(one, Some("u"), &budget()).unwrap()[0].met;
            if found != met {
                // The gain margin may be bound from below.
                assert_eq!(requirement.name(), "gain_margin");
                continue;
            }
            let certificate = match certify_requirements(&problem, one, Some("u"), met, &budget()) {
                Ok(certificate) => certificate,
                Err(refused) => {
                    assert!(refused.to_string().contains("E-no-certificate"), "{refused}");
                    let is_beyond = ["modulus_margin", "disk_margin"].contains(&requirement.name()) && !met;
                    assert!(delayed || is_beyond, "{}: {refused}", requirement.text());
                    continue;
                }
            };
            accept(text, &certificate);
            if requirement.name() == "phase_margin" {
                let opposite = certify_requirements(&problem, one, Some("u"), !met, &budget());
                assert!(opposite.is_err(), "{}", requirement.text());
            }
            certified += 1;
        }
    }
    assert!(certified >= 28, "{certified}");
}

/// The ranges of a statement in which something holds, and those in which it does for no value.
fn ends(statement: &str) -> Vec<Rational> {
    let words = statement.split_whitespace().map(|word| word.trim_end_matches(['.', ',']));
    let decimal =
        |word: &str| (word.contains('.') || word.contains('/')).then(|| jurist::parse_number(word).ok()).flatten();
    words.filter_map(decimal).collect()
}

/// `K/(s (s + 1))` has a phase margin of 60 degrees up to `K = 2/3`.
#[test]
fn sets_with_requirements_are_certified_up_to_narrow_gaps() {
    let text = "time = 'continuous'\nparameters.K = { nominal = 1, min = 0 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
        [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(s + 1))'\n";
    let requirement = [Requirement::phase_margin(&number("60")).unwrap()];
    let answer = read(text).ask().free("K").problem().unwrap().required_set(&requirement, None, &budget()).unwrap();
    let found = certify_required_intervals(&answer, &requirement, None, &budget()).unwrap();
    accept(text, &found.text);
    assert!(found.proved > number("999/1000"), "{found:?}");
    let statement = check(text, &found.text, &LIMITS).unwrap().statement;
    let near = |x: &Rational| (x - &number("2/3")).abs() < number("1/1000");
    assert_eq!(ends(&statement).iter().filter(|x| near(x)).count(), 2, "{statement}");
    // The bound is part of what is proved.
    reject(text, &with(&found.text, "\"bound\": \"60\"", "\"bound\": \"61\""), Step::Statement);
    let [_, high] = found.window.unwrap();
    let moved = with(&found.text, &format!("[\"0\", \"{high}\"]"), &format!("[\"1/100\", \"{high}\"]"));
    reject(text, &moved, Step::Stable);
}

#[test]
#[ignore = "long: CI runs it"]
fn maps_for_all_values_and_with_requirements_are_certified() {
    let side = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let phase = || vec![Requirement::phase_margin(&number("45")).unwrap()];
    for (text, requirements, least) in [
        (&loops()[0], Vec::new(), "4/5"),
        (&loops()[1], phase(), "7/10"),
        (&loops()[2], Vec::new(), "4/5"),
        (&loops()[3], Vec::new(), "7/10"),
    ] {
        let text = text.replace("input = 'r - y'", "input = 'r - b*y'").replace("max = 6 }", "max = 6 }, b = 1");
        let request = BoxRequest::new([side("1/10", "3"), side("1/2", "2")], number("1/8"));
        let all = vec![AllOf::new("b", number("4/5"), number("6/5")).unwrap()];
        let asked = MapForAll::new(all).with_requirements(requirements, Some("u".to_owned()));
        let map = asked.boxes(read(&text).ask().free("K").free("a"), &request, &budget()).unwrap();
        let found = certify_boxes(&map, &budget()).unwrap();
        accept(&text, &found.text);
        assert!(&found.stable + &found.unstable > number(least) && found.stable.sign().is_gt(), "{text}: {found:?}");
        let wider = with(&found.text, "\"between\": [\"4/5\", \"6/5\"]", "\"between\": [\"1/5\", \"9/5\"]");
        reject(&text, &wider, Step::Stable);
    }
}

/// Tolerances inside of functions, with dead time, and with a requirement: the box and a point beyond.
#[test]
#[ignore = "long: CI runs it"]
fn tolerances_over_every_ring_are_certified() {
    let cases = [(&loops()[3], None), (&loops()[2], None), (&loops()[2], Some("45")), (&loops()[0], Some("40"))];
    for (text, requirement) in tried(cases, 2) {
        let request = ToleranceRequest::new([("K", "20%".parse().unwrap()), ("a", "10%".parse().unwrap())]);
        let requirement = requirement.map(|degrees| Requirement::phase_margin(&number(degrees)).unwrap());
        let request = request.require(requirement.clone(), Some("u".to_owned()));
        let answer = read(text).ask().tolerance(&request, &budget()).unwrap();
        let found = certify_tolerance(&answer, Some("u"), &budget()).unwrap_or_else(|e| panic!("{text}: {e}"));
        accept(text, &found.text);
        let statement = check(text, &found.text, &LIMITS).unwrap().statement;
        assert_eq!(requirement.is_some(), statement.contains("phase margin"), "{statement}");
        let lower = &answer.value().factor.as_ref().unwrap().lower;
        assert!(found.factor.unwrap() >= lower * &number("9/10"), "{statement}");
        assert!(found.text.contains("\"not\""), "a point beyond: {}", found.text);
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn the_program_certifies_requirements() {
    let text = &loops()[2];
    let folder = Folder::new(&[("loop.toml", text)]);
    let (model, file) = ("loop.toml", "loop.cert");
    let cases = [
        (vec!["verdict", model, "--phase-margin", "30 deg", "--gain-margin", "6 dB"], 0),
        (vec!["verdict", model, "--phase-margin", "85 deg"], 1),
        (vec!["intervals", model, "--param", "K", "--phase-margin", "45 deg"], 0),
        (
            vec![
                "map",
                model,
                "-x",
                "K=1/10..3",
                "-y",
                "a=1/2..2",
                "--phase-margin",
                "45 deg",
                "--at",
                "u",
                "--undecided",
                "1/5",
            ],
            0,
        ),
        (vec!["tolerance", model, "--tol", "a=10%", "--phase-margin", "30 deg"], 0),
    ];
    for (arguments, status) in tried(cases, 2) {
        let run = folder.jurist(&[arguments.as_slice(), &["--certificate", file]].concat());
        assert_eq!(run.status, status, "{arguments:?}: {}", run.stderr);
        assert!(!run.stderr.contains("W-certificate"), "{arguments:?}: {}", run.stderr);
        let run = folder.jurist(&["verify", model, file]);
        assert_eq!(run.status, 0, "{arguments:?}: {}", run.stdout);
        assert!(run.stdout.contains("margin of"), "{}", run.stdout);
    }
    // Only margins are proved, of the plain region.
    for (options, word) in [
        (vec!["--damping", "0.2"], "damping"),
        (vec!["--phase-margin", "30 deg", "--radius", "9/10"], "smaller region"),
    ] {
        let run = folder.jurist(&[&["verdict", model, "--certificate", file][..], &options].concat());
        assert_eq!(run.status, 2, "{}", run.stdout);
        assert!(run.stderr.contains("E-no-certificate") && run.stderr.contains(word), "{}", run.stderr);
    }
}

#[test]
fn statements_that_ask_for_something_else_are_rejected() {
    let text = &loops()[0];
    let problem = read(text).ask().set("K", number("3/2")).problem().unwrap();
    let requirement = [Requirement::phase_margin(&number("30")).unwrap()];
    let certificate = certify_requirements(&problem, &requirement, Some("u"), true, &budget()).unwrap();
    accept(text, &certificate);
    for (from, to, step) in [
        ("\"signal\": \"u\"", "\"signal\": \"w\"", Step::Model),
        ("\"signal\": \"u\"", "\"input\": \"w\"", Step::Model),
        ("\"decay\": \"0\"", "\"decay\": \"1/10\"", Step::Statement),
        ("\"time\": \"continuous\"", "\"time\": \"discrete\"", Step::Statement),
        ("certificate/10", "certificate/7", Step::Statement),
        ("\"bound\": \"30\"", "\"bound\": \"180\"", Step::Statement),
        ("\"bound\": \"30\"", "\"bound\": \"-30\"", Step::Statement),
        ("\"K\": \"3/2\"", "\"K\": \"30000\"", Step::Stable),
    ] {
        reject_in_rust(text, &with(&certificate, from, to), step);
    }
}

/// Three blocks: a filter before the loop, a gain and a plant. No block has a name, or the gain alone has the name that the filter would get.
#[test]
fn blocks_without_names_are_told_apart() {
    let text = |name: &str| {
        format!(
            "time = 'continuous'\n[parameters]\nK = {{ nominal = 1, min = 0, max = 20 }}\n[loop]\ninputs = ['w']\noutputs = ['y']\n\
             [[block]]\ninput = 'w'\noutput = 'r'\ntransfer = '1/(s + 1)'\n[[block]]\n{name}input = 'r - y'\noutput = 'u'\ngain = 'K'\n\
             [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 1)^3'\n"
        )
    };
    for (name, cut) in [("", "block 2"), ("name = 'block'\n", "block")] {
        let text = text(name);
        let problem = read(&text).ask().set("K", 1).problem().unwrap();
        // The gain margin is 8.
        let stable = problem.margins(None, &Rational::ZERO, &budget()).unwrap().into_value().stable.unwrap();
        assert_eq!(stable.gain.upper.unwrap().value.exact(), Some(8.into()));
        for (factor, is_met) in [("7", true), ("9", false)] {
            let asked = [Requirement::gain_margin(&number(factor)).unwrap()];
            let certificate = certify_requirements(&problem, &asked, None, is_met, &budget()).unwrap();
            let words = check(&text, &certificate, &LIMITS).unwrap().statement;
            assert!(words.contains(&format!("'{cut}'")), "{words}");
            accept(&text, &certificate);
            reject(&text, &with(&certificate, &format!("\"{cut}\""), "\"block 9\""), Step::Model);
        }
    }
    let message = |text: &str| Model::from_toml(&Source::new("model.toml", text)).unwrap_err().to_string();
    assert!(message(&text("name = 'block 3'\n")).contains("the block without a name is called 'block 3'"));
}
