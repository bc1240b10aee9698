//! Maps of two parameters for all values of others, against the exact set of the other one at points.

use crate::helpers::certificates::checkers::accept;
use crate::helpers::model::{example_text, keeping, load, read};
use crate::helpers::number::{number, ratio};
use crate::helpers::program::{json, jurist, jurist_with_input};
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, is_thorough, tried};
use jurist::Ask;
use jurist::certified::certify_required_intervals;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, BoxRequest, MapBoxes, Verdict};
use jurist_engine::model::Model;
use jurist_engine::response::{AllOf, MapForAll, RequiredEnd, Requirement};
use jurist_engine::stability::plane::boxes::{BoxVerdict, Window};
use jurist_engine::stability::{Range, StableSet, UndecidedBracket};

fn boxes(
    model: &Model,
    [x, y]: [(&str, [&str; 2]); 2],
    (name, [least, greatest]): (&str, [&str; 2]),
    undecided: &str,
    requirements: &[Requirement],
) -> Answer<MapBoxes> {
    let range = |[lower, upper]: [&str; 2]| Range::between(Some(number(lower)), Some(number(upper)));
    let request = BoxRequest::new([range(x.1), range(y.1)], number(undecided));
    let all = AllOf::new(name, number(least), number(greatest)).expect("a range");
    let at = (!requirements.is_empty()).then(|| "u".to_owned());
    let asked = MapForAll::new(vec![all]).with_requirements(requirements.to_vec(), at);
    asked.boxes(keeping(model, &[x.0, y.0]), &request, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"))
}

/// Whether a set holds a closed range: one of its intervals does, no end lies on the range.
fn holds(set: &StableSet, [least, greatest]: [&str; 2]) -> bool {
    let (least, greatest) = (number(least), number(greatest));
    set.intervals().iter().any(|interval| {
        let below = interval.lower.as_ref().is_none_or(|end| end.value.compare_rational(&least).is_lt());
        below && interval.upper.as_ref().is_none_or(|end| end.value.compare_rational(&greatest).is_gt())
    })
}

fn inside(b: &Window, random: &mut Random) -> [Rational; 2] {
    [&b.x, &b.y].map(|[low, high]| low + &(&(high - low) * &ratio(1 + random.below(998) as i64, 1000)))
}

/// Points of decided boxes against what is known of points; how many of either kind were looked at.
fn agrees(found: &Answer<MapBoxes>, random: &mut Random, is_good: impl Fn(&[Rational; 2]) -> bool) -> [usize; 2] {
    let map = &found.value().boxes;
    assert!(map.stopped.is_none(), "{:?}", map.stopped);
    let decided: Vec<_> = map.boxes.iter().filter(|b| b.verdict != BoxVerdict::Undecided).collect();
    let mut seen = [0, 0];
    for _ in 0..12.min(decided.len()) {
        let b = decided[random.below(decided.len())];
        let point = inside(&b.window, random);
        let is_stable = b.verdict == BoxVerdict::Stable;
        assert_eq!(is_good(&point), is_stable, "{point:?} in {b:?}\n{}", found.problem().model().source().text);
        seen[usize::from(is_stable)] += 1;
    }
    seen
}

/// `FOR_ALL_CASES=300` asks for so many.
#[test]
fn points_of_decided_boxes_agree_with_the_set_of_the_third_name() {
    let cases = std::env::var("FOR_ALL_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(6);
    let (mut random, mut seen) = (Random::new(37), [0, 0]);
    for case in 0..cases {
        let mut number = |bound: usize| random.below(2 * bound + 1) as i64 - bound as i64;
        let (time, variable) = if case % 2 == 0 { ("continuous", "s") } else { ("discrete", "z") };
        let order = 2 + case % 2;
        let scale = if time == "discrete" { 12 } else { 4 };
        let terms: Vec<String> = (0..order)
            .map(|k| {
                let [c, x, y, l, both] = [number(8), number(3), number(3), number(3), number(2)];
                let shift = if time == "continuous" { 4 } else { 0 };
                let bend = number(6);
                format!(
                    "({c} + {shift} + ({x})*x + ({y})*y + ({l})*L + ({both})*x*L + ({bend})*L^2)/{scale}*{variable}^{k}"
                )
            })
            .collect();
        let text = format!(
            "time = '{time}'\nparameters = {{ x = 0, y = 0, L = 0 }}\nloop.characteristic = '{variable}^{order} + {}'\n",
            terms.join(" + ")
        );
        let (side, all, model) = (["-1", "1"], ["-1/3", "1/2"], read(&text));
        let found = boxes(&model, [("x", side), ("y", side)], ("L", all), "0.3", &[]);
        let [bad, good] = agrees(&found, &mut random, |[x, y]| {
            let wide = Range::between(Some((-2).into()), Some(2.into()));
            let question = model.ask().set("x", x.clone()).set("y", y.clone()).free("L").domain("L", wide);
            holds(question.stable_set(&Budget::unlimited()).unwrap().value(), all)
        });
        seen = [seen[0] + bad, seen[1] + good];
    }
    println!("{cases} loops, {seen:?} points");
    assert!(seen.iter().all(|n| 2 * *n > cases), "{seen:?}");
}

/// A constant of the plant, inside of functions, varies while a gain and the sample time are looked for.
#[test]
#[ignore = "long: CI runs it"]
fn a_constant_of_a_plant_behind_a_hold_may_be_the_third_name() {
    let model = load(&example_text("dc-servo"));
    let axes = [("K", ["1", "150"]), ("T", ["0.001", "0.008"])];
    let found = boxes(&model, axes, ("T_m", ["0.02", "0.05"]), "0.3", &[]);
    let [bad, good] = agrees(&found, &mut Random::new(5), |[gain, time]| {
        (0..=6).all(|k| {
            let constant = number("0.02") + number("0.005") * Rational::from(k);
            let question = model.ask().set("K", gain.clone()).set("T", time.clone()).set("T_m", constant);
            question.verdict(&Budget::unlimited()).unwrap().value().verdict == Verdict::Stable
        })
    });
    assert!(bad > 0 && good > 0, "{bad} {good}");
}

/// `|1 + L|` is least at `z = -1`, where it is `1 - a b K/2`: for every `b` up to 2 it is half at least where `a K <= 1/2`.
#[test]
fn a_requirement_for_all_values_is_that_of_the_worst_one() {
    let model = read(
        "time = 'discrete'\n[parameters]\nK = 1\na = 1\nb = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'c'\n\
         input = 'r - y'\noutput = 'u'\ngain = 'K'\n[[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\ntransfer = 'a*b/(z - 1)'\n",
    );
    let margin = Requirement::modulus_margin("1/2".parse().unwrap()).unwrap();
    let axes = [("K", ["0", "2"]), ("a", ["0", "1"])];
    let undecided = if is_thorough() { "0.05" } else { "0.6" };
    let found = boxes(&model, axes, ("b", ["1/2", "2"]), undecided, &[margin]);
    let areas = &found.value().required.as_ref().unwrap().areas;
    // Below the hyperbola a K = 1/2 the area is 1/2 + ln(4)/2.
    let area = number("1.19314718");
    let boxes = &found.value().boxes.areas;
    assert!(areas.met < area && &areas.met + &areas.undecided + &boxes.undecided > area, "{areas:?}");
    // Stable where a b K < 2 for all b: a K < 1.
    let area = number("1.69314718");
    assert!(boxes.stable < area && &boxes.stable + &boxes.undecided > area, "{boxes:?}");
}

/// The worst value lies inside of the range, not at an end: `s + x - 1 + 4 (L - 1/2)^2` is stable for all `L` from 0 to 1 where `x > 1`, at both ends where
/// `x > 0`. The resonance of `s^2 + (x + 4 (L - 1/3)^2) s + 1` is not damped at `L = 1/3` alone.
#[test]
fn the_worst_value_may_be_inside_of_a_range() {
    let loops = [("s + x - 1 + 4*(L - 1/2)^2", "1"), ("s^2 + (x + 4*(L - 1/3)^2)*s + 1", "0")];
    for (characteristic, least) in tried(loops, 2) {
        let text = format!(
            "time = 'continuous'\nparameters = {{ x = 0, y = 0, L = 0 }}\nloop.characteristic = '{characteristic}'\n"
        );
        let axes = [("x", ["-1", "2"]), ("y", ["0", "1"])];
        let found = boxes(&read(&text), axes, ("L", ["0", "1"]), "0.02", &[]);
        let limit = number(least);
        for b in &found.value().boxes.boxes {
            match b.verdict {
                BoxVerdict::Stable => assert!(b.window.x[0] >= limit, "{characteristic}: {b:?}"),
                BoxVerdict::Unstable { .. } => assert!(b.window.x[1] <= limit, "{characteristic}: {b:?}"),
                BoxVerdict::Undecided => {}
            }
        }
        let areas = &found.value().boxes.areas;
        assert!(areas.undecided <= number("0.06"), "{characteristic}: {areas:?}");
    }
}

/// Two names at once: `s + x - b c` for all `b` and `c` from -1 to 2 is stable where `x > 4`.
#[test]
#[ignore = "long: CI runs it"]
fn several_names_vary_together() {
    let text =
        "time = 'continuous'\nparameters = { x = 5, y = 1, b = 0, c = 0 }\nloop.characteristic = 's + x - b*c'\n";
    let arguments =
        ["map", "-", "-x", "x=0..8", "-y", "y=0..1", "--for-all", "b=-1..2", "--for-all", "c=-1..2", "--json"];
    let run = jurist_with_input(&arguments, text.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let found: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(found["for_all"][1]["name"], "c");
    let stable = found["areas"]["stable"].as_str().unwrap().parse::<Rational>().unwrap();
    assert!(stable <= 4.into() && stable > number("3.9"), "{stable}");
    assert!(found["set"].as_object().is_some_and(serde_json::Map::is_empty), "{found}");
    let shown = jurist_with_input(&arguments[..arguments.len() - 1], text.as_bytes()).stdout;
    assert!(shown.contains("for all b from -1 to 2, c from -1 to 2") && shown.contains("not for all: "), "{shown}");
}

#[test]
fn mistakes_are_shown_where_they_stand() {
    let drive = |arguments: &[&str]| {
        let run = jurist(&[&["map", "-x", "K_pwm=1..600", "-y", "T=5e-5..2e-4"], arguments].concat());
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stdout);
        run.stderr
    };
    for (arguments, what) in [
        (&["--for-all", "L_a"][..], "expects NAME=LO..HI"),
        (&["--for-all", "L_a=1..2", "--for-all", "L_a=1..3"], "two ranges"),
        (&["--for-all", "L_a=2..1"], "a lower end and a greater one"),
        (&["--for-all", "L_a=1..2", "--set", "L_a=1"], "L_a"),
        (&["--for-all", "L_b=1..2"], "L_b"),
        (&["--for-all", "L_a=1..2", "--method", "exact"], "made of boxes"),
        (&["--for-all", "K_pwm=1..2"], "K_pwm"),
    ] {
        let said = drive(arguments);
        assert!(said.contains(what), "{arguments:?}: {said}");
    }
}

/// `s + K L exp(-tau s)`, for all gains `L` of the plant.
#[test]
#[ignore = "long: CI runs it"]
fn loops_with_dead_time_have_such_maps() {
    let text =
        "time = 'continuous'\nparameters = { K = 1, tau = 1, L = 1 }\nloop.characteristic = 's + K*L*exp(-tau*s)'\n";
    let axes = [("K", ["1/10", "3/2"]), ("tau", ["1/10", "2"])];
    let undecided = if is_thorough() { "0.05" } else { "0.3" };
    let found = boxes(&read(text), axes, ("L", ["1/2", "2"]), undecided, &[]);
    let map = &found.value().boxes;
    // Stable where K L tau < pi/2 for all L: K tau < pi/4.
    let limit = number("0.78539816339744830961");
    for b in &map.boxes {
        let [low, high] = [0, 1].map(|end| &b.window.x[end] * &b.window.y[end]);
        match b.verdict {
            BoxVerdict::Stable => assert!(high < limit, "{b:?}"),
            BoxVerdict::Unstable { .. } => assert!(low > limit, "{b:?}"),
            BoxVerdict::Undecided => {}
        }
    }
    assert!(map.stopped.is_none() && map.areas.stable.sign().is_gt() && map.areas.unstable.sign().is_gt());
}

/// A loop in one line has no nominal values: the third name needs none.
#[test]
fn a_loop_in_one_line_has_such_a_map() {
    let line =
        ["map", "K/(s*(s + a)*(s + b))", "-x", "K=0..10", "-y", "a=0..5", "--for-all", "b=1..2", "--undecided", "0.1"];
    let run = jurist(&line);
    // Stable where K < a b (a + b) for all b: at b = 1.
    assert!(run.status == 0 && run.stdout.contains("for all b from 1 to 2"), "{}{}", run.stdout, run.stderr);
    let complex = "time = 'continuous'\nparameters = { x = 1, y = 1, w = 0 }\nloop.characteristic = 's + x + j*y*w'\n";
    let arguments = ["map", "-", "-x", "x=0..1", "-y", "y=0..1", "--for-all", "w=0..1"];
    let run = jurist_with_input(&arguments, complex.as_bytes());
    assert!(run.status == 2 && run.stderr.contains("for all values of other names"), "{}", run.stderr);
}

/// `z - 1 + K (a + b)^2` has its root inside for either sign of the sample time `a + b`; with a negative one there is no loop.
#[test]
fn a_sample_time_that_is_not_positive_for_some_values_is_not_for_all() {
    let text = "time = 'discrete'\nsample_time = 'a + b'\nparameters = { a = 1, b = 1, K = 0.5 }\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'r - y'\n\
        output = 'u'\ngain = 'K*(a + b)'\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/s'\ndiscretize = 'zoh'\n";
    let axes = [("a", ["1/10", "1/2"]), ("K", ["1/10", "1/2"])];
    let areas = |range: [&str; 2]| boxes(&read(text), axes, ("b", range), "0.05", &[]).value().boxes.areas.clone();
    let whole = areas(["-1", "1"]);
    assert_eq!(whole.unstable, number("4/25"), "{whole:?}");
    let positive = areas(["1/10", "1"]);
    assert_eq!(positive.stable, number("4/25"), "{positive:?}");
}

/// One name in the place of two: closed forms, and ends that both programs of `verify` see nearly as far.
#[test]
fn one_parameter_is_good_up_to_ends_that_are_known() {
    let cases = [
        (
            "time = 'continuous'\nparameters = { K = 2, c = 0 }\nloop.characteristic = 's + K - 1 + 4*(c - 1/2)^2'\n",
            "c",
            ["0", "1"],
            None,
            "1",
        ),
        (
            "time = 'continuous'\nparameters = { K = { nominal = 1, min = 0 }, c = 1 }\nloop.characteristic = 's + K*exp(-c*s)'\n",
            "c",
            ["1/2", "1"],
            None,
            "1.57079632679489661923",
        ),
        (
            "time = 'discrete'\nparameters = { K = { nominal = 1, min = 0 }, c = 1 }\nloop.characteristic = 'z - 1 + K*c'\n",
            "c",
            ["1/2", "4"],
            None,
            "1/2",
        ),
        // The phase margin of K/(s (s + 1)) is 60 degrees at 2/3, with the gain c that of K c.
        (
            "time = 'continuous'\nparameters = { K = { nominal = 1, min = 0 }, c = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
             [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*c/(s*(s + 1))'\n",
            "c",
            ["1", "2"],
            Some("60"),
            "1/3",
        ),
    ];
    for (text, name, range, requirement, expected) in tried(cases, 2) {
        let requirements: Vec<Requirement> =
            requirement.iter().map(|degrees| Requirement::phase_margin(&number(degrees)).unwrap()).collect();
        let all = vec![AllOf::new(name, number(range[0]), number(range[1])).unwrap()];
        let asked = MapForAll::new(all).with_requirements(requirements.clone(), None);
        let found = asked.intervals(read(text).ask().free("K"), &Budget::unlimited()).unwrap();
        let set = found.value();
        let expected = number(expected);
        let near = |end: &RequiredEnd| (end.value().exact().unwrap() - expected.clone()).abs() < number("1e-7");
        let ends: Vec<&RequiredEnd> = set.intervals.iter().flat_map(|i| [&i.lower, &i.upper]).flatten().collect();
        assert!(set.intervals.len() == 1 && ends.iter().any(|end| near(end)), "{text}: {set:?}");
        // The true end is in what is undecided.
        let holds = |b: &UndecidedBracket| {
            b.lower.as_ref().is_some_and(|low| *low <= expected)
                && b.upper.as_ref().is_some_and(|high| *high >= expected)
        };
        assert!(set.undecided.iter().any(holds), "{text}: {set:?}");
        let certified = certify_required_intervals(&found, &requirements, None, &Budget::unlimited()).unwrap();
        accept(text, &certified.text);
        assert!(certified.proved > number("99/100"), "{text}: {certified:?}");
    }
}

/// At random values of a set for all values, the exact set of the other name covers its range, and beside the set it does not.
#[test]
fn sets_of_one_parameter_for_all_values_agree_with_the_set_of_the_other_name() {
    let mut random = Random::new(41);
    let (mut good, mut spoiled) = (0, 0);
    for _ in 0..count(5, 12) {
        let mut number = |most: usize| random.below(most) as i64 - most as i64 / 2;
        let [a, b, c, d, e, f] = [number(8), number(6), number(6), number(8), number(6), number(6)];
        let text = format!(
            "time = 'continuous'\nparameters = {{ K = {{ nominal = 0, min = -3, max = 3 }}, c = 0 }}\n\
             loop.characteristic = 's^3 + ({a} + 5 + ({b})*K + ({c})*c)*s^2 + ({d} + 4 + ({e})*c^2 - K*c)*s + 3 + ({f})*K'\n"
        );
        let all = vec![AllOf::new("c", ratio(-1, 2), ratio(1, 2)).unwrap()];
        let found = MapForAll::new(all).intervals(read(&text).ask().free("K"), &Budget::unlimited()).unwrap();
        let set = found.value();
        for k in -29..30 {
            let x = ratio(k, 10) + ratio(1, 97);
            let is_open = |b: &UndecidedBracket| {
                b.lower.as_ref().is_none_or(|low| *low <= x) && b.upper.as_ref().is_none_or(|high| *high >= x)
            };
            if set.undecided.iter().any(is_open) {
                continue;
            }
            let of_c = read(&text).ask().set("K", x.clone()).free("c").stable_set(&Budget::unlimited()).unwrap();
            let [low, high] = [ratio(-1, 2), ratio(1, 2)];
            let covers = of_c.value().intervals().iter().any(|i| {
                i.lower.as_ref().is_none_or(|end| end.value.compare_rational(&low).is_lt())
                    && i.upper.as_ref().is_none_or(|end| end.value.compare_rational(&high).is_gt())
            });
            assert_eq!(set.intervals.iter().any(|i| i.contains(&x)), covers, "{text} at {x}");
            if covers { good += 1 } else { spoiled += 1 }
        }
    }
    assert!(good > count(10, 40) && spoiled > count(30, 100), "{good} {spoiled}");
}

/// A loop in one line has no values of its names: a requirement is asked of it all the same, and the name that is asked about has no range.
#[test]
#[ignore = "long: CI runs it"]
fn a_loop_in_one_line_is_asked_with_requirements() {
    let line = "K*(s+L)/(s*(s+1)*(s+2))";
    let run = jurist(&["intervals", line, "--param", "K", "--for-all", "L=1..6", "--phase-margin", "45 deg", "-q"]);
    assert!(
        run.status == 0 && run.stdout.contains("for all L from 1 to 6: stable, phase_margin >= 45 deg"),
        "{}",
        run.stderr
    );
    let run = jurist(&["intervals", line, "--param", "K", "--for-all", "K=1..6"]);
    assert!(run.status == 2 && run.stderr.contains("'K' is what is asked about"), "{}", run.stderr);
}

/// `s + x - 1 + 4 (L - 1/2)^2` again, with work for some pieces only: what is proved of them is printed, and that it is not all.
#[test]
fn what_is_known_of_one_parameter_is_printed_when_the_budget_ends() {
    let text = "time = 'continuous'\nparameters = { K = { nominal = 2, min = -8, max = 8 }, c = 0 }\n\
        loop.characteristic = 's + K - 1 + 4*(c - 1/2)^2'\n";
    let arguments =
        |work: &'static str| ["intervals", "-", "--param", "K", "--for-all", "c=0..1", "--work", work, "-q"];
    let (mut partial, mut nothing) = (0, 0);
    for work in ["3000", "7000", "20000", "50000", "100000"] {
        let run = jurist_with_input(&arguments(work), text.as_bytes());
        assert!(run.status == 3 && run.stderr.contains("undecided: the budget ran out: work"), "{}", run.stderr);
        assert!(run.stdout.contains("the budget ran out") && run.stdout.contains("undecided in"), "{}", run.stdout);
        if run.stdout.contains("<= K <") {
            partial += 1
        } else {
            nothing += 1
        }
        let json = jurist_with_input(&[&arguments(work)[..], &["--json"]].concat(), text.as_bytes());
        let found: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
        assert!(json.status == 3 && !found["undecided"].as_array().unwrap().is_empty(), "{found}");
    }
    assert!(partial > 0 && nothing > 0, "{partial} {nothing}");
    assert_eq!(jurist_with_input(&arguments("100000000"), text.as_bytes()).status, 0);
}

/// One value of a range may spoil all values of the parameter: where a pole is cancelled, or where there is no damping whatever the gain.
#[test]
fn a_single_value_that_spoils_all_is_named() {
    let loops = [
        ("s^2 + (1 + L)*s + K*L/L - 1", "L=-1/2..1", "undefined at L = 0"),
        ("s^2 + (1 + L)*s + K*L/L - 1", "L=0..1", "undefined at L = 0"),
        ("s^2 + (L - 1/3)^2*s + K + 1", "L=0..1", "roots on the boundary at L = 1/3"),
    ];
    for (characteristic, range, why) in tried(loops, 2) {
        let text = format!(
            "time = 'continuous'\nparameters = {{ K = {{ nominal = 1, min = 0, max = 10 }}, L = 1 }}\nloop.characteristic = '{characteristic}'\n"
        );
        let arguments = ["intervals", "-", "--param", "K", "--for-all", range, "--work", "300000000"];
        let run = jurist_with_input(&arguments, text.as_bytes());
        assert!(run.status == 0 && run.stdout.contains(why), "{characteristic}: {}{}", run.stdout, run.stderr);
        assert!(run.stdout.contains("undecided in") && !run.stdout.contains("for\n"), "{}", run.stdout);
    }
}

/// Where the domain has no end the search stops at a number of its own: `domain` was said of this number in the list of ends, and `undecided` below.
#[test]
fn an_end_at_which_the_search_stopped_is_no_end_of_the_domain() {
    let asked = ["intervals", "K/(s*(s+a))", "--param", "K", "--for-all", "a=1..2", "--domain"];
    let run = jurist(&[&asked[..], &["K=0.5.."]].concat());
    let (ends, undecided) = run.stdout.split_once("undecided from ").unwrap_or_else(|| panic!("{}", run.stdout));
    let far = undecided.split(' ').next().unwrap();
    assert!(ends.contains(&format!("{far}   no limit: what lies beyond is undecided\n")), "{}", run.stdout);
    assert!(ends.contains("0.5   domain\n") && ends.matches("domain\n").count() == 1, "{}", run.stdout);
    let document = json(&[&asked[..], &["K=0.5..", "--json"]].concat());
    let interval = &document["stable"][0];
    assert_eq!((&interval["upper"]["cause"], &interval["lower"]["cause"]), (&"undecided".into(), &"domain".into()));
    assert!(interval["upper"]["requirement"].is_null() && interval["upper"]["closed"] == true, "{document}");
    // The ends of the domain are excluded, as they are without other names.
    assert!(run.stdout.contains("\n    0.5 < K <= "), "{}", run.stdout);
    assert_eq!(interval["lower"]["closed"], false, "{document}");
}

/// The corner's limit is exactly where the search ended: what lies beyond was called open.
#[test]
fn an_end_where_the_search_ends_is_one_that_a_corner_spoils() {
    // (a - 1)/(s + 1) behind a hold: -2 < K < 2 at the corners, which lie on either side of a = 1.
    let model = load(
        "time = 'discrete'\nsample_time = '3/10'\nparameters = { K = 1, a = 1 }\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'r - y'\noutput = 'u'\n\
         gain = 'K'\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '(a - 1)/(s + 1)'\ndiscretize = 'zoh'\n",
    );
    let all = vec![AllOf::new("a", number("1/2"), number("3/2")).unwrap()];
    let found = MapForAll::new(all).intervals(model.ask().free("K"), &Budget::unlimited()).unwrap();
    let set = found.value();
    assert!(
        set.intervals.len() == 1 && set.undecided.iter().all(|b| b.lower.is_some() && b.upper.is_some()),
        "{set:?}"
    );
    let ends = [&set.intervals[0].lower, &set.intervals[0].upper];
    assert!(
        ends.iter().all(|end| matches!(end, Some(RequiredEnd::Requirement { names, .. }) if names == &["stability"]))
    );
}

/// Behind a hold the worst value is an end of its range. The exact set there bounds the set for all values: no bracket was left between values that are
/// spoiled, and nothing beyond the window is open.
#[test]
fn an_end_that_a_corner_spoils_is_next_to_its_exact_end() {
    let model = load(&example_text("drive-hold"));
    let range = ["0.8", "1.2"];
    let all = vec![AllOf::new("R_a", number(range[0]), number(range[1])).unwrap()];
    let found = MapForAll::new(all).intervals(model.ask().free("K_pwm"), &Budget::unlimited()).unwrap();
    let set = found.value();
    assert!(set.intervals.len() == 1 && set.undecided.len() == 2, "{set:?}");
    let of = |value: Rational| {
        let answer = model.ask().set("R_a", value).free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
        let interval = answer.value().intervals()[0].clone();
        [interval.lower, interval.upper].map(|end| end.expect("two ends").value)
    };
    let (own, bounds) = (&set.intervals[0], [&set.undecided[0], &set.undecided[1]]);
    let [low, high] = [&own.lower, &own.upper].map(|end| end.as_ref().unwrap().value().exact().unwrap());
    for k in 0..=4 {
        let [lower, upper] = of(number(range[0]) + &(number("0.1") * Rational::from(k)));
        assert!(lower.compare_rational(&low).is_lt() && upper.compare_rational(&high).is_gt(), "{k}");
    }
    // The nearest ends of the corners are in the brackets, which are short.
    let corners = range.map(|x| of(number(x)));
    let [from, to] = [&bounds[0].lower, &bounds[1].upper].map(|end| end.clone().unwrap());
    assert!(corners.iter().any(|[lower, _]| lower.compare_rational(&from).is_gt()), "{set:?}");
    assert!(corners.iter().any(|[_, upper]| upper.compare_rational(&to).is_lt()), "{set:?}");
    assert!(&low - &from < number("1e-6") && &to - &high < number("1e-5"), "{set:?}");
}
