//! Plants behind a pulse-width modulator. Numbers of the tables were computed with mpmath at 45 digits, as eigenvalues of the map over a
//! period on both sides of each end.

use crate::helpers::model::{example_text, load, read};
use crate::helpers::number::ratio;
use crate::helpers::program::{jurist, jurist_with_input};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::error::{Code, Error, Source};
use jurist_engine::model::Model;
use jurist_engine::stability::{Cause, StableSet};

pub(super) fn set(text: &str, name: &str) -> StableSet {
    read(text).ask().free(name).stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value()
}

/// The ends of the only interval, in so many digits.
pub(super) fn ends(set: &StableSet, digits: usize) -> [String; 2] {
    let [interval] = set.intervals() else { panic!("{set:?}") };
    [&interval.lower, &interval.upper].map(|end| end.as_ref().map_or("none".into(), |end| end.value.decimal(digits)))
}

fn drive(edge: &str, duty: &str) -> String {
    let text = example_text("drive-pwm");
    text.replace("\"trailing\", duty = \"V_0/K_pwm\"", &format!("\"{edge}\", duty = \"{duty}\""))
}

fn buck(duty: &str, delay: &str) -> String {
    let text = example_text("buck-pwm");
    text.replace("duty = \"D\"", &format!("duty = \"{duty}\", delay = \"{delay}\""))
}

#[test]
#[ignore = "long: CI runs it"]
fn the_drive_of_the_paper_with_its_own_chopper() {
    for (edge, gain, time) in [
        ("trailing", "551.741369819322624593841149", "0.000499220684418385492073297063"),
        ("leading", "551.012244749542107318159083", "0.000498523151319993622412167224"),
        ("double", "551.376682867604529917298902", "0.000498870893862668598728173887"),
    ] {
        assert_eq!(ends(&set(&drive(edge, "V_0/K_pwm"), "T"), 27)[1], time, "{edge}");
        let by_gain = set(&drive(edge, "V_0/K_pwm"), "K_pwm");
        assert_eq!(ends(&by_gain, 27)[1], gain, "{edge}");
        let lower = by_gain.intervals()[0].lower.as_ref().unwrap();
        assert_eq!(lower.value.exact(), Some(ratio(2484, 55)), "{edge}");
        assert_eq!(lower.causes.to_string(), "duty", "{edge}");
    }
    for (duty, lower, upper) in [
        ("0.1", "0.0381811769341115881949524982", "551.725542763575021978930842"),
        ("0.5", "0.0381144445290132312256500489", "551.376684128042504470930287"),
        ("0.9", "0.0380477765145971801430480436", "551.027964499380265687059788"),
    ] {
        assert_eq!(ends(&set(&drive("trailing", duty), "K_pwm"), 27), [lower, upper], "{duty}");
    }
    let by_duty = drive("trailing", "D").replace("[parameters]", "[parameters]\nD = { nominal = 0.4 }");
    let by_duty = by_duty.replace("K_pwm = { nominal = 110", "K_pwm = { nominal = 551.4");
    let found = set(&by_duty, "D");
    assert_eq!(ends(&found, 27), ["0", "0.473261138987622887175059385"]);
    assert!(found.intervals()[0].lower.as_ref().unwrap().causes.contains(Cause::Duty));
}

#[test]
fn a_buck_converter_at_several_duty_ratios_and_dead_times() {
    for (duty, delay, lower, upper) in [
        ("0.1", "0", "-0.0523317152501631912495707563", "0.123332974760687860586809891"),
        ("0.5", "0", "-0.0549908197092195068837507076", "0.0864480663792146311923298457"),
        ("0.9", "0", "-0.0573869581803769391417303640", "0.0656331291434851794189977949"),
        ("0.3", "T/2", "-0.0568099996719399385359993428", "0.0699085891861870222576463591"),
        ("0.7", "T/2", "-0.0588551049968904053150021848", "0.0555895605617575539610195769"),
    ] {
        assert_eq!(ends(&set(&buck(duty, delay), "K_p"), 27), [lower, upper], "{duty}, {delay}");
    }
    let by_duty = example_text("buck-pwm").replace("nominal = 0.05", "nominal = 0.1");
    assert_eq!(ends(&set(&by_duty, "D"), 27)[1], "0.322387063537267858610945927");
}

/// `y' = -a y + u` under `u = -K y`: `-(1 - A)/(T c) < K < (1 + A)/(T c)` with `A = exp(-a T)` and `c = exp(-a (1 - D) T)`.
#[test]
fn one_pole_has_limits_in_closed_form() {
    for duty in ["1/10", "1/2", "9/10"] {
        let text = format!(
            "time = 'discrete'\nsample_time = '1/2'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'K*(r - y)'\n\
             output = 'y'\ntransfer = '1/(s + 3)'\ndiscretize = {{ method = 'pwm', edge = 'trailing', duty = '{duty}' }}\n"
        );
        let found = set(&text, "K");
        let rest = format!("(1 - {duty})");
        for (end, sign, cause) in [
            (&found.intervals()[0].lower, "-(1 - exp(-3/2))", Cause::RootAtOne),
            (&found.intervals()[0].upper, "(1 + exp(-3/2))", Cause::RootAtMinusOne),
        ] {
            let end = end.as_ref().unwrap();
            assert!(end.causes.contains(cause));
            let at = |shift: &str| {
                let gain = format!("{sign}*2/exp(-3/2*{rest})*(1 {shift})");
                let text = text.replace("K*(r - y)", &format!("{gain}*(r - y)"));
                read(&text).ask().verdict(&Budget::unlimited()).unwrap().into_value().verdict
            };
            assert_eq!([at("- 1e-30"), at("+ 1e-30")], [Verdict::Stable, Verdict::Unstable], "{duty} {sign}");
            assert_eq!(at("+ 0"), Verdict::Marginal, "{duty} {sign}");
        }
    }
}

/// A plant in state space behind a modulator, with a delayed controller.
fn plant(a: &str, b: &str, c: &str, discretize: &str) -> String {
    format!(
        "time = 'discrete'\nsample_time = 'T'\n[constants]\nT = '1/4'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\n[[block]]\n\
         input = 'r - y'\noutput = 'u'\ntransfer = 'K*(z - 1/2)/z'\n[[block]]\ninput = 'u'\noutput = 'y'\nA = {a}\nB = {b}\nC = {c}\n\
         discretize = {discretize}\n"
    )
}

#[test]
fn leading_edges_are_trailing_ones_of_the_rest() {
    let [a, b, c] = ["[[0, 1], [-5, -1]]", "[[1], [2]]", "[[1, 1]]"];
    for k in [1, 3, 7] {
        let one = plant(a, b, c, &format!("{{ method = 'pwm', edge = 'leading', duty = '{k}/10' }}"));
        let other = plant(a, b, c, &format!("{{ method = 'pwm', edge = 'trailing', duty = '{}/10' }}", 10 - k));
        assert_eq!(ends(&set(&one, "K"), 40), ends(&set(&other, "K"), 40));
        let one = plant(a, b, c, &format!("{{ method = 'pwm', edge = 'double', duty = '{k}/10' }}"));
        let other = plant(a, b, c, &format!("{{ method = 'pwm', edge = 'double-ends', duty = '{}/10' }}", 10 - k));
        assert_eq!(ends(&set(&one, "K"), 40), ends(&set(&other, "K"), 40));
    }
}

/// With equal pulses and pauses the two edges of a double update stand at the same place: its map is the square of one sample's.
#[test]
fn alternating_edges_of_half_a_period_are_one_edge() {
    let [a, b, c] = ["[[0, 1], [-5, -1]]", "[[1], [2]]", "[[1, 1]]"];
    for delay in ["0", "T/4", "T"] {
        let how = |edge: &str| format!("{{ method = 'pwm', edge = '{edge}', duty = 0.5, delay = '{delay}' }}");
        let value = |edge: &str| {
            let found = set(&plant(a, b, c, &how(edge)), "K");
            (ends(&found, 40), found.intervals().len())
        };
        assert_eq!(value("alternating"), value("trailing"), "{delay}");
    }
    let text = plant(a, b, c, "{ method = 'pwm', edge = 'alternating', duty = 0.3 }");
    assert_eq!(read(&text).hyperperiod(), 2);
    assert_ne!(ends(&set(&text, "K"), 10), ends(&set(&text.replace("alternating", "trailing"), "K"), 10));
}

#[test]
fn dead_time_and_the_duty_ratio_add_up() {
    let [a, b, c] = ["[[0, 1], [-5, -1]]", "[[1], [2]]", "[[1, 1]]"];
    let late = plant(a, b, c, "{ method = 'pwm', edge = 'trailing', duty = 0.3, delay = '0.45*T' }");
    let long = plant(a, b, c, "{ method = 'pwm', edge = 'trailing', duty = 0.75 }");
    assert_eq!(ends(&set(&late, "K"), 40), ends(&set(&long, "K"), 40));
    // A dead time in the transfer function is one of the inputs.
    let text = |transfer: &str, delay: &str| {
        format!(
            "time = 'discrete'\nsample_time = '1/4'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'K*(r - y)'\n\
             output = 'y'\ntransfer = '{transfer}'\ndiscretize = {{ method = 'pwm', edge = 'double', duty = 0.4{delay} }}\n"
        )
    };
    let [inside, beside] = [text("exp(-0.3*s)/(s + 1)^2", ""), text("1/(s + 1)^2", ", delay = 0.3")];
    assert_eq!(ends(&set(&inside, "K"), 40), ends(&set(&beside, "K"), 40));
}

/// Of integrators the column is rational: `T [(1 - D) T, 1]` of two, and that of the hold of one, whatever the pulse is.
#[test]
fn integrators_behind_a_modulator_are_rational() {
    let pulse = |edge: &str, duty: &str| format!("{{ method = 'pwm', edge = '{edge}', duty = '{duty}' }}");
    let one = |how: &str| ends(&set(&plant("[[0]]", "[[1]]", "[[1]]", how), "K"), 40);
    for edge in ["trailing", "leading", "double", "double-ends"] {
        for duty in ["1/9", "1/2", "4/5"] {
            assert_eq!(one(&pulse(edge, duty)), one("'zoh'"), "{edge}, {duty}");
        }
    }
    let two = set(&plant("[[0, 1], [0, 0]]", "[[0], [1]]", "[[1, 3]]", &pulse("trailing", "1/5")), "K");
    let by_hand =
        plant("[[1, 'T'], [0, 1]]", "[['T^2*4/5'], ['T']]", "[[1, 3]]", "'zoh'").replace("discretize = 'zoh'\n", "");
    assert_eq!(two.intervals().len(), 1);
    assert_eq!(ends(&two, 40), ends(&set(&by_hand, "K"), 40));
}

/// A load torque is no pulse: with one word for both inputs it is held, and changes nothing.
#[test]
fn inputs_that_nothing_controls_are_held() {
    let text = drive("trailing", "1/2");
    let lists =
        text.replace("edge = \"trailing\", duty = \"1/2\"", "edge = [\"trailing\", \"hold\"], duty = [0.5, 0.1]");
    assert_ne!(text, lists);
    assert_eq!(ends(&set(&text, "K_pwm"), 30), ends(&set(&lists, "K_pwm"), 30));
    let both = text.replace("edge = \"trailing\"", "edge = [\"trailing\", \"trailing\"]");
    assert_eq!(ends(&set(&text, "K_pwm"), 30), ends(&set(&both, "K_pwm"), 30));
}

#[test]
fn a_sample_on_an_edge_is_undefined_but_where_no_output_changes_there() {
    let how = "{ method = 'pwm', edge = 'trailing', duty = 0.5, delay = 'T/2' }";
    let of = |c: &str| load(&plant("[[0, 1], [-5, -1]]", "[[0], [2]]", c, how)).ask().verdict(&Budget::unlimited());
    let undefined = of("[[0, 1]]");
    assert!(matches!(&undefined, Err(Error::Undefined(text)) if text.contains("on an edge")), "{undefined:?}");
    // The position behind a speed: C B = 0.
    assert_ne!(of("[[1, 0]]").unwrap().into_value().verdict, Verdict::Undefined);
    // A little before and behind it the loop is nearly the same.
    let near = |delay: &str| {
        let how = format!("{{ method = 'pwm', edge = 'trailing', duty = 0.5, delay = '{delay}' }}");
        ends(&set(&plant("[[0, 1], [-5, -1]]", "[[0], [2]]", "[[1, 0]]", &how), "K"), 8)
    };
    assert_eq!(near("T/2"), near("T/2 + 1e-12"));
    assert_eq!(near("T/2"), near("T/2 - 1e-12"));
}

#[test]
fn a_duty_ratio_outside_is_undefined_at_a_point_and_refused_elsewhere() {
    let model = read(&drive("trailing", "V_0/K_pwm"));
    let at = |x: i64| model.ask().set("K_pwm", Rational::from(x)).verdict(&Budget::unlimited()).unwrap().into_value();
    assert_eq!(at(46).verdict, Verdict::Stable);
    let outside = at(45);
    assert_eq!(outside.verdict, Verdict::Undefined);
    assert!(outside.undefined.as_deref().is_some_and(|text| text.contains("duty") && text.contains("motor")));
    let wrong = read(&drive("trailing", "6/5")).ask().free("K_pwm").stable_set(&Budget::unlimited());
    let Err(Error::Refused(diagnostics)) = wrong else { panic!("{wrong:?}") };
    assert_eq!(diagnostics.code(), Code::Duty);
}

#[test]
fn mistakes_are_shown_where_they_stand() {
    let with = |how: &str| {
        let text = example_text("drive-pwm");
        let old = "{ method = \"pwm\", edge = \"trailing\", duty = \"V_0/K_pwm\" }";
        assert!(text.contains(old));
        text.replace(old, how)
    };
    for (how, code, help) in [
        ("\"pwm\"", Code::Discretize, "edge = \"trailing\""),
        ("{ method = \"pwm\", edge = \"trailing\" }", Code::Duty, "between 0 and 1"),
        ("{ method = \"pwm\", duty = 0.5 }", Code::Edge, "trailing"),
        ("{ method = \"pwm\", edge = \"trailling\", duty = 0.5 }", Code::Edge, "did you mean 'trailing'"),
        ("{ method = \"pwm\", edge = \"natural\", duty = 0.5 }", Code::Edge, "once in a period"),
        ("{ method = \"pwm\", edge = [\"trailing\", \"hold\", \"hold\"], duty = 0.5 }", Code::Edge, ""),
        ("{ method = \"pwm\", edge = \"trailing\", duty = [0.5, 0.5, 0.5] }", Code::Duty, ""),
        ("{ method = \"pwm\", edge = [\"hold\", \"hold\"], duty = 0.5 }", Code::Edge, "zoh"),
        ("{ method = \"pwm\", edge = \"trailing\", duty = 0.5, T = \"T\" }", Code::Discretize, "leave it out"),
        ("{ method = \"pwm\", edge = \"trailing\", duty = 0.5, prewarp = 3 }", Code::Discretize, "leave it out"),
        ("{ method = \"zoh\", edge = \"trailing\" }", Code::Discretize, "leave it out"),
        ("{ method = \"zoh\", duty = 0.5 }", Code::Discretize, "leave it out"),
        ("{ method = \"pmw\", edge = \"trailing\", duty = 0.5 }", Code::Discretize, "did you mean 'pwm'"),
    ] {
        let found = Model::from_toml(&Source::new("model.toml", with(how)));
        let Err(diagnostics) = found else { panic!("{how} is accepted") };
        assert_eq!(diagnostics.code(), code, "{how}: {diagnostics}");
        let helps: Vec<String> = diagnostics.diagnostics().iter().filter_map(|d| d.help.clone()).collect();
        assert!(help.is_empty() || helps.iter().any(|text| text.contains(help)), "{how}: {helps:?}");
    }
    let misspelled = with("{ method = \"pwm\", edg = \"trailing\", dity = 0.5 }");
    let Err(diagnostics) = Model::from_toml(&Source::new("model.toml", misspelled)) else { panic!("it is accepted") };
    let codes: Vec<Code> = diagnostics.diagnostics().iter().map(|d| d.code).collect();
    assert_eq!(codes, [Code::UnknownKey; 2], "a misspelled key is not missing as well");
    let direct = plant("[[-1]]", "[[1]]", "[[1]]\nD = [[1]]", "{ method = 'pwm', edge = 'trailing', duty = 0.5 }");
    let (_, warnings) = Model::from_toml(&Source::new("model.toml", direct)).unwrap();
    assert!(warnings.iter().any(|w| w.code == Code::FeedthroughWarning), "{warnings:?}");
}

/// The switched circuit takes the place of its pulses from the model, and its own small-signal multipliers are on the two sides of the
/// exact limit.
#[test]
fn the_switched_circuit_agrees_with_the_exact_limit() {
    let run = |gain: &str, more: &[&str]| {
        let set = format!("K_pwm={gain}");
        let mut words =
            vec!["simulate", "examples/drive-pwm.toml", "--switched", "--steady", "--duration", "0.01", "--set", &set];
        words.extend(more);
        jurist(&words)
    };
    for (gain, is_stable) in [("551.7", true), ("551.8", false)] {
        let text = run(gain, &[]).stderr;
        let multiplier = text.split("largest multiplier ").nth(1).and_then(|rest| rest.split(' ').next());
        let multiplier: f64 = multiplier.unwrap_or_else(|| panic!("{text}")).parse().unwrap();
        assert_eq!(multiplier < 1.0, is_stable, "{gain}: {multiplier}");
    }
    let wrong = run("551.7", &["--pulse", "end"]);
    assert_eq!(wrong.status, 2);
    assert!(wrong.stderr.contains("edge = \"trailing\""), "{}", wrong.stderr);
    assert_eq!(run("551.7", &["--pulse", "beginning"]).status, 0);
}

/// Where a sample stands on an edge the loop is undefined: the value is none of the set, also where the loop is stable on both sides.
#[test]
fn a_value_with_a_sample_on_an_edge_is_left_out_of_the_set() {
    let text = "time = 'discrete'\nsample_time = 1\n[parameters]\ng = 0.3\nD = 0.4\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'g*(r - y)'\n\
        output = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = 'D', delay = 0.5 }\n";
    let half: Rational = "1/2".parse().unwrap();
    let found = set(text, "D");
    assert_eq!(found.intervals().len(), 2, "{found:?}");
    assert!(
        !found.contains(&half)
            && found.contains(&"49/100".parse().unwrap())
            && found.contains(&"51/100".parse().unwrap())
    );
    let end = found.intervals()[0].upper.as_ref().unwrap();
    assert_eq!((end.value.exact(), end.causes.to_string()), (Some(half.clone()), "pole".to_owned()));
    // The loop jumps there: unstable before, stable behind.
    let jumps = set(&text.replace("g = 0.3", "g = 1.8"), "D");
    assert_eq!(jumps.intervals().len(), 2, "{jumps:?}");
    let lower = jumps.intervals()[1].lower.as_ref().unwrap();
    assert_eq!((lower.value.exact(), lower.causes.to_string()), (Some(half), "pole".to_owned()));
    // A hold's dead time passes a sample without a jump.
    let hold =
        text.replace("method = 'pwm', edge = 'trailing', duty = 'D', delay = 0.5", "method = 'zoh', delay = '2*D'");
    assert_eq!(set(&hold, "D").intervals().len(), 1);
}

/// A map is divided where a sample stands on an edge, and its boxes say what the verdicts on either side say.
#[test]
fn boxes_of_a_map_end_where_a_sample_stands_on_an_edge() {
    let text = "time = 'discrete'\nsample_time = 1\n[parameters]\ng = 1.8\nD = 0.4\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'g*(r - y)'\n\
        output = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = 'D', delay = 0.5 }\n";
    let line = ["map", "-", "-x", "D=0.2..0.8", "-y", "g=0..3", "--undecided", "0.1", "--json"];
    let map = jurist_with_input(&line, text.as_bytes());
    let document: serde_json::Value =
        serde_json::from_str(&map.stdout).unwrap_or_else(|e| panic!("{e} {}", map.stderr));
    let half: Rational = "1/2".parse().unwrap();
    let mut seen = [0, 0];
    for found in document["boxes"].as_array().unwrap() {
        let side = |axis: &str| [0, 1].map(|k| found[axis][k].as_str().unwrap().parse::<Rational>().unwrap());
        let ([from, to], [low, high]) = (side("x"), side("y"));
        assert!(to <= half || half <= from, "{found}");
        let (duty, gain) = (from.midpoint(&to), low.midpoint(&high));
        let asked = read(text).ask().set("D", duty).set("g", gain);
        let is_stable = asked.verdict(&Budget::unlimited()).unwrap().value().verdict == Verdict::Stable;
        match found["verdict"].as_str() {
            Some("undecided") => {}
            told => assert_eq!(told == Some("stable"), is_stable, "{found}"),
        }
        seen[usize::from(is_stable)] += 1;
    }
    assert!(seen[0] > 3 && seen[1] > 3, "{seen:?}");
}
