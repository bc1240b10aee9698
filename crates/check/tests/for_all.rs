//! Certificates for all values: requirements whose margins are known by hand, and forgeries.

#[path = "for_all/changes.rs"]
mod changes;
#[path = "for_all/discs.rs"]
mod discs;
#[path = "for_all/python.rs"]
mod python;
#[path = "for_all/samples.rs"]
mod samples;
#[path = "for_all/truth.rs"]
mod truth;
#[path = "for_all/writer.rs"]
mod writer;

use jurist_check::{Step, check};
use writer::{Asked, LIMITS, accepted, proof, written};

/// Whether all cases are tried, as in CI.
fn is_thorough() -> bool {
    std::env::var_os("JURIST_THOROUGH").is_some()
}

/// Unity feedback around a transfer function.
fn loop_of(time: &str, transfer: &str, more: &str) -> String {
    format!(
        "time = '{time}'\n{more}\n[loop]\ninputs = ['r']\n[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\ntransfer = '{transfer}'\n"
    )
}

/// `sin` and `cos` of half of the bound are not needed: numbers just below and above its tangent.
fn phase(at: &str, degrees: f64) -> String {
    let tangent = (degrees.to_radians() / 2.0).tan();
    let [below, above] = [(tangent * 1e6).floor(), (tangent * 1e6).ceil()];
    let bound = format!("{}/1000", (degrees * 1000.0).round());
    format!(
        r#"{{"kind": "phase_margin", "at": {at}, "bound": "{bound}", "turns": ["{below}/1000000", "{above}/1000000"]}}"#
    )
}

fn other(kind: &str, at: &str, bound: &str) -> String {
    format!(r#"{{"kind": "{kind}", "at": {at}, "bound": "{bound}"}}"#)
}

const SIGNAL: &str = r#"{"signal": "y"}"#;
const INPUT: &str = r#"{"input": "plant"}"#;

/// That the one requirement is told to be met, and the other one not to be.
fn told(model: &str, asked: &Asked, [yes, no]: [String; 2]) {
    for (require, expected) in [(yes, '+'), (no, '-')] {
        let (found, statement) = accepted(model, &asked.clone().require(&require));
        assert_eq!(found, expected, "{require}: {statement}");
    }
}

fn both(kind: &str, at: &str, [yes, no]: [&str; 2]) -> [String; 2] {
    [yes, no].map(|bound| other(kind, at, bound))
}

fn phases(at: &str, bounds: [f64; 2]) -> [String; 2] {
    bounds.map(|degrees| phase(at, degrees))
}

/// The phase margin of `1/(s (s + 1))` is 51.827 degrees; the peak is `2/sqrt(3)` and the disk margin `2/sqrt(5)`.
#[test]
fn margins_of_a_second_order_are_told_from_both_sides() {
    let model = loop_of("continuous", "1/(s*(s + 1))", "");
    let asked = Asked::of("continuous");
    told(&model, &asked, phases(INPUT, [51.7, 52.0]));
    told(&model, &asked, phases(SIGNAL, [51.7, 52.0]));
    told(&model, &asked, both("complementary_peak", INPUT, ["117/100", "115/100"]));
    told(&model, &asked, both("disk_margin", INPUT, ["88/100", "95/100"]));
}

#[test]
fn gain_and_modulus_margins_are_told_from_both_sides() {
    let asked = Asked::of("continuous");
    let third = loop_of("continuous", "2/(s*(s + 1)*(s + 2))", "");
    told(&third, &asked, both("gain_margin", INPUT, ["299/100", "301/100"]));
    let unstable = loop_of("continuous", "2/((s - 1)*(s/10 + 1))", "");
    told(&unstable, &asked, both("modulus_margin", INPUT, ["81/100", "85/100"]));
    // Below as well: the loop needs some gain.
    told(&unstable, &asked, both("gain_margin", SIGNAL, ["199/100", "201/100"]));
}

/// The same numbers of `1/(z - 1)`, and of an integrator behind a hold.
#[test]
fn margins_of_sampled_loops_are_told_from_both_sides() {
    let hold = "discretize = 'zoh'\n";
    let held = loop_of("discrete", "1/s", "sample_time = 1") + hold;
    let sum = loop_of("discrete", "1/(z - 1)", "");
    let asked = Asked::of("discrete");
    for model in [&sum, &held] {
        told(model, &asked, phases(INPUT, [59.5, 60.5]));
        told(model, &asked, both("modulus_margin", INPUT, ["49/100", "51/100"]));
        told(model, &asked, both("gain_margin", INPUT, ["199/100", "201/100"]));
    }
}

/// `exp(-s/2)/s` has the phase margin 90 degrees less half a radian, and the gain margin `pi`.
#[test]
#[ignore = "long: CI runs it"]
fn margins_of_a_loop_with_dead_time_are_told_from_both_sides() {
    let model = loop_of("continuous", "exp(-s/2)/s", "");
    let asked = Asked { order: 1, ..Asked::of("continuous") };
    told(&model, &asked, both("gain_margin", INPUT, ["314/100", "315/100"]));
    told(&model, &asked, phases(INPUT, [60.5, 62.0]));
    // The least distance to -1, and the largest of the other sensitivity, on a grid.
    let open = |w: f64| [-(w / 2.0).sin() / w, -(w / 2.0).cos() / w];
    let grid = || (1..4000).map(|k| open(f64::from(k) / 200.0));
    let least = grid().map(|[x, y]| (1.0 + x).hypot(y)).fold(f64::INFINITY, f64::min);
    let most = grid().map(|[x, y]| x.hypot(y) / (1.0 + x).hypot(y)).fold(0.0, f64::max);
    let hundredths = |x: f64| format!("{}/100", (100.0 * x).round());
    told(&model, &asked, [0.96, 1.1].map(|x| other("modulus_margin", INPUT, &hundredths(x * least))));
    told(&model, &asked, [1.3, 0.9].map(|x| other("complementary_peak", INPUT, &hundredths(x * most))));
}

/// At a parameter the margins are those at the input that it multiplies.
#[test]
fn a_parameter_is_cut_wherever_it_stands() {
    let at = r#"{"parameter": "K"}"#;
    let block = loop_of("continuous", "K/(s*(s + a))", "parameters = { K = {}, a = 1 }");
    let written = "time = 'continuous'\nparameters = { K = {}, a = 1 }\nloop.characteristic = 's^2 + a*s + K'";
    let matrix = "time = 'continuous'\nparameters = { K = {}, a = 1 }\n[loop]\nA = [[0, 1], [0, '-a']]\nB = [[0], [1]]\nC = [[1, 0]]\nK = [['K']]";
    // Behind constants too, and as a divisor.
    let behind = "time = 'continuous'\nparameters = { K = {}, a = 1 }\nconstants.c = 'K + 0'\nloop.characteristic = 's^2/c + a*s/c + 1'";
    let all = [&block, written, matrix, behind];
    // One way of writing by default, all in CI.
    for model in &all[..if is_thorough() { 4 } else { 1 }] {
        let asked = Asked::of("continuous").set(r#""K": "1", "a": "1""#);
        told(model, &asked, phases(at, [51.7, 52.0]));
        told(model, &asked, both("complementary_peak", at, ["118/100", "115/100"]));
        told(model, &asked, both("modulus_margin", at, ["60/100", "80/100"]));
        let (found, _) = accepted(model, &asked.clone().require(other("gain_margin", at, "100")));
        assert_eq!(found, '+');
    }
}

/// A complex loop bears less to one side than to the other.
#[test]
fn complex_loops_are_asked_about_both_sides() {
    let model = loop_of("continuous", "(1 + j)/s", "");
    told(&model, &Asked::of("continuous"), phases(INPUT, [44.5, 45.5]));
    let mirrored = loop_of("continuous", "(1 - j)/s", "");
    told(&mirrored, &Asked::of("continuous"), phases(INPUT, [44.5, 45.5]));
    let asked = Asked::of("continuous").set(r#""K": "1""#);
    // A factor is one of the whole loop: what is made of it in a function is none.
    for within in ["re(K)", "conj(K)", "K + im(K)", "exp(K)", "K*sqrt(K)"] {
        let model = format!("time = 'continuous'\nparameters.K = {{}}\nloop.characteristic = 's + {within}'");
        let asked = asked.clone().require(phase(r#"{"parameter": "K"}"#, 30.0));
        let rejected = check(&model, &asked.certificate("+."), &LIMITS).unwrap_err();
        assert_eq!(rejected.step, Step::Model, "{rejected}");
        // A gain is real.
        let asked = asked.require(other("gain_margin", r#"{"parameter": "K"}"#, "2"));
        assert_eq!(accepted(&model, &asked).0, '+', "{within}");
    }
    let written = "time = 'continuous'\nparameters.K = {}\nloop.characteristic = 's + K*(1 - j)'";
    told(written, &asked, phases(r#"{"parameter": "K"}"#, [44.5, 45.5]));
    // Nor is one to the power of two.
    let matrix = "time = 'continuous'\nparameters.K = {}\nloop.matrix = [['-K', '-K'], ['K', '-K']]";
    let twice = asked.clone().require(phase(r#"{"parameter": "K"}"#, 30.0));
    assert_eq!(check(matrix, &twice.certificate("+."), &LIMITS).unwrap_err().step, Step::Model);
    let gain = asked.require(other("gain_margin", r#"{"parameter": "K"}"#, "2"));
    assert_eq!(accepted(matrix, &gain).0, '+');
}

/// A name of the model that is the imaginary unit elsewhere keeps its meaning.
#[test]
fn a_parameter_called_j_is_a_parameter() {
    let model = loop_of("continuous", "j/(s*(s + 1))", "parameters.j = {}");
    let asked = Asked::of("continuous").set(r#""j": "1""#);
    told(&model, &asked, phases(INPUT, [51.7, 52.0]));
    told(&model, &asked, phases(r#"{"parameter": "j"}"#, [51.7, 52.0]));
    let undeclared = loop_of("continuous", "1/(s*(s + 1))", "").replace("r - y", "r - y*(1 + i*0)");
    let rejected = check(&undeclared, &asked.set("").require(phase(INPUT, 51.7)).certificate("+."), &LIMITS);
    assert_eq!(rejected.unwrap_err().step, Step::Model);
}

#[test]
#[ignore = "long: CI runs it"]
fn what_holds_for_all_values_of_names_is_told() {
    let model = loop_of("continuous", "K/(s*(s + a)*(s/b + 1))", "parameters = { K = {}, a = {}, b = {} }");
    let three = r#"{"name": "K", "between": ["1/2", "1"]}, {"name": "a", "between": ["1", "2"]}, {"name": "b", "between": ["9", "10"]}"#;
    let asked = Asked::of("continuous").for_all(three);
    let (found, statement) = accepted(&model, &asked);
    assert_eq!(found, '+');
    assert_eq!(statement, "For all K from 1/2 to 1 and a from 1 to 2 and b from 9 to 10, the loop is stable.");
    let with = asked.clone().require(format!("{}, {}", phase(INPUT, 45.0), other("gain_margin", INPUT, "4")));
    let (found, statement) = accepted(&model, &with);
    let words = "stable, with a phase margin of at least 45 degrees at the input of 'plant' and a gain margin of at least 4 both ways at the \
                 input of 'plant'";
    assert_eq!(
        (found, statement),
        ('+', format!("For all K from 1/2 to 1 and a from 1 to 2 and b from 9 to 10, the loop is {words}."))
    );
    let beyond = with.beyond(r#"{"point": ["20", "1", "10"], "not": "0<d."}"#);
    let (_, statement) = accepted(&model, &beyond);
    assert!(statement.ends_with(&" At K = 20, a = 1, b = 10, it is not."), "{statement}");
    let not_beyond = beyond.beyond(r#"{"point": ["1/2", "1", "10"], "not": "0."}"#);
    let (certificate, _) = written(&model, &not_beyond, 0, 300);
    assert_eq!(check(&model, &certificate, &LIMITS).unwrap_err().step, Step::Stable);
    // One of the values is too much.
    let more = r#"{"name": "K", "between": ["1/2", "30"]}, {"name": "a", "between": ["1", "2"]}, {"name": "b", "between": ["9", "10"]}"#;
    let (found, statement) = accepted(&model, &Asked::of("continuous").for_all(more));
    assert_eq!(
        (found, statement.as_str()),
        ('-', "Not for all K from 1/2 to 30 and a from 1 to 2 and b from 9 to 10, the loop is stable.")
    );
}

#[test]
#[ignore = "long: CI runs it"]
fn axes_have_parts_of_both_kinds() {
    // Of s^2 + a s + K the phase margin falls with K, and grows with a.
    let model = loop_of("continuous", "K/(s*(s + a))", "parameters = { K = {}, a = {} }");
    let k = r#"{"name": "K", "between": ["1/4", "4"]}"#;
    let a = r#"{"name": "a", "between": ["1", "2"]}"#;
    let one = Asked::of("continuous").axes(k).for_all(a).require(phase(INPUT, 45.0));
    let (certificate, tree) = written(&model, &one, 6, 20);
    let statement = check(&model, &certificate, &LIMITS).unwrap().statement;
    assert!(tree.contains('+') && tree.contains('-'), "{tree}");
    // For a = 1 the bound is K = sqrt(2).
    let words = "For K from 1/4 to 4, for all a from 1 to 2, the loop is stable, with a phase margin of at least 45 degrees at the input of 'plant', \
                 for 1/4 <= K <= 349/256, and not so for any value in 91/64 <= K <= 4. Nothing is said of the rest.";
    assert_eq!(statement, words);
    if !is_thorough() {
        return;
    }
    let two = Asked {
        axes: r#"{"name": "K", "between": ["1/4", "4"]}, {"name": "a", "between": ["1", "2"]}"#,
        for_all: "",
        ..one
    };
    let (certificate, tree) = written(&model, &two, 4, 20);
    let statement = check(&model, &certificate, &LIMITS).unwrap().statement;
    assert!(tree.contains('+') && tree.contains('-'), "{tree}");
    assert!(statement.contains("in all boxes '+' of the tree, and nowhere in its boxes '-': at least"), "{statement}");
}

/// A loop with two rates: gains are real, and other factors are not read.
#[test]
fn loops_of_several_rates_have_gain_margins_alone() {
    let model = "time = 'discrete'\nparameters.K = {}\n[loop]\ninputs = ['r']\n[[block]]\nname = 'slow'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\nevery = 2\n\
                 [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(z - 1)'\n";
    // Every second sample y goes on by -2 K y: |1 - 2 K| < 1.
    let asked = Asked::of("discrete").set(r#""K": "1/2""#);
    for at in [r#"{"signal": "u"}"#, r#"{"signal": "y"}"#, r#"{"input": "slow"}"#, r#"{"parameter": "K"}"#] {
        told(model, &asked, both("gain_margin", at, ["199/100", "201/100"]));
        let complex = asked.clone().require(phase(at, 10.0)).certificate("+.");
        let rejected = check(model, &complex, &LIMITS).unwrap_err();
        assert!(rejected.reason.contains("several rates"), "{rejected}");
    }
    let range = Asked::of("discrete").for_all(r#"{"name": "K", "between": ["1/4", "3/4"]}"#);
    told(model, &range, both("gain_margin", INPUT_OF_SLOW, ["13/10", "14/10"]));
    let beyond = range.require(other("gain_margin", INPUT_OF_SLOW, "13/10")).beyond(r#"{"point": ["2"], "not": "0."}"#);
    assert_eq!(accepted(model, &beyond).0, '+');
}

const INPUT_OF_SLOW: &str = r#"{"input": "slow"}"#;

/// What a judge does not see is asked of it by halves, and by parts.
#[test]
fn texts_that_break_a_rule_are_rejected_where_they_do() {
    let model = loop_of("continuous", "K/(s*(s + a))", "parameters = { K = {}, a = {} }\nconstants.c = 1");
    let asked = Asked::of("continuous").for_all(r#"{"name": "K", "between": ["1/2", "3/4"]}"#).set(r#""a": "1""#);
    let asked = asked.require(format!("{}, {}", phase(INPUT, 45.0), other("gain_margin", SIGNAL, "2")));
    let good = asked.certificate("+..");
    assert!(check(&model, &good, &LIMITS).is_ok());
    let range = r#"{"name": "K", "between": ["1/2", "3/4"]}"#;
    let turns = &phase(INPUT, 45.0);
    let one = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        good.replacen(from, to, 1)
    };
    for (step, certificate) in [
        (Step::Format, one("\"order\": 3", "\"order\": 9")),
        (Step::Format, one("\"bits\": 128", "\"bits\": 32")),
        (Step::Format, one("\"order\": 3", "\"order\": 3, \"more\": 1")),
        (Step::Statement, one("\"beyond\": null", "\"beyond\": {\"point\": [], \"not\": \"0.\"}")),
        (Step::Statement, one("[\"1/2\", \"3/4\"]", &format!("[\"1/2\", \"{}\"]", "9".repeat(1400)))),
        (Step::Statement, one("\"kind\": \"for_all\"", "\"kind\": \"boxes\"")),
        (Step::Statement, one("[\"1/2\", \"3/4\"]", "[\"3/4\", \"1/2\"]")),
        (Step::Statement, one("\"axes\": []", &format!("\"axes\": [{0}, {0}, {0}]", range.replace('K', "c")))),
        (Step::Statement, one("\"decay\": \"0\"", "\"decay\": \"1/9\"")),
        (Step::Statement, one("\"decay\": \"0\"", "\"decay\": \"-1\"")),
        (Step::Statement, one("\"decay\": \"0\"", "\"radius\": \"1\"")),
        (Step::Statement, one("\"bound\": \"2\"", "\"bound\": \"1\"")),
        (Step::Statement, one("gain_margin", "modulus_margin")),
        (Step::Statement, one("gain_margin", "disk_margin")),
        (Step::Statement, one("gain_margin", "stability")),
        (Step::Statement, one("{\"signal\": \"y\"}", "{\"signal\": \"y\", \"input\": \"plant\"}")),
        (Step::Statement, one("{\"signal\": \"y\"}", "{\"signal\": \"y y\"}")),
        (Step::Statement, one("{\"signal\": \"y\"}", "{\"output\": \"y\"}")),
        (Step::Model, one("{\"input\": \"plant\"}", "{\"input\": \"plant' and more\"}")),
        // Below the tangent, above it, and no range of angles at all.
        (Step::Statement, one("\"414213/1000000\", \"414214/1000000\"", "\"414213/1000000\", \"414213/1000000\"")),
        (Step::Statement, one("\"414213/1000000\", \"414214/1000000\"", "\"414214/1000000\", \"414214/1000000\"")),
        (Step::Statement, one("\"414213/1000000\", \"414214/1000000\"", "\"0\", \"1/1000000\"")),
        (Step::Statement, one("\"414213/1000000\", \"414214/1000000\"", "\"-1\", \"414214/1000000\"")),
        (Step::Statement, one(turns, &[turns.as_str(); 10].join(", "))),
        (Step::Model, one("{\"signal\": \"y\"}", "{\"signal\": \"r\"}")),
        (Step::Model, one("{\"signal\": \"y\"}", "{\"signal\": \"K\"}")),
        (Step::Model, one("{\"signal\": \"y\"}", "{\"parameter\": \"y\"}")),
        (Step::Model, one("{\"input\": \"plant\"}", "{\"input\": \"y\"}")),
        (Step::Model, one("\"set\": {\"a\": \"1\"}", "\"set\": {}")),
        (Step::Model, one("\"set\": {\"a\": \"1\"}", "\"set\": {\"a\": \"1\", \"K\": \"1\"}")),
        (Step::Model, one("\"for_all\": [", &format!("\"for_all\": [{range}, "))),
        (Step::Model, one("\"axes\": []", &format!("\"axes\": [{range}]"))),
        (Step::Model, one("\"name\": \"K\"", "\"name\": \"t\"")),
        (Step::Line, one("+..", "")),
        (Step::Line, one("+..", "+.")),
        (Step::Line, one("+..", "+...")),
        (Step::Line, one("+..", "a+..+..")),
        (Step::Line, one("+..", "+c...")),
        (Step::Line, one("+..", "-.")),
        (Step::Line, one("+..", "-2.")),
        (Step::Line, one("+..", "-0ma")),
        (Step::Line, one("+..", "-0mc.")),
        (Step::Line, one("+..", "-0xa.")),
        (Step::Line, one("+..", "*")),
        (Step::Stable, one("+..", "-0.")),
        (Step::Stable, one("+..", "-1>b.")),
        (Step::Stable, one("\"bound\": \"2\"", "\"bound\": \"100000000\"")),
    ] {
        match check(&model, &certificate, &LIMITS) {
            Err(e) => assert_eq!(e.step, step, "{e}\n{certificate}"),
            // A loop of the second order bears every gain.
            Ok(proved) => assert!(certificate.contains("100000000"), "{proved:?}\n{certificate}"),
        }
    }
    // Halvings count up to a depth of 160.
    for (depth, is_read) in [(160, true), (161, false)] {
        let steps = format!("-1{}.", "lb".repeat(depth));
        let e = check(&model, &asked.certificate(&steps), &LIMITS).unwrap_err();
        assert_eq!(e.step, if is_read { Step::Stable } else { Step::Line }, "{e}");
    }
}

/// Names of the model and those of a requirement do not meet.
#[test]
fn names_of_the_model_may_be_any() {
    for (case, [k, a, y]) in [["r", "t", "k"], ["t", "r", "d"], ["f", "g", "t"]].into_iter().enumerate() {
        let model = loop_of("continuous", "K/(s*(s + A))", &format!("parameters = {{ {k} = {{}}, {a} = {{}} }}"));
        let model =
            model.replace("'r'", "'ref'").replace("r - y", &format!("ref - {y}")).replace("'y'", &format!("'{y}'"));
        let model = model.replace("K/(s*(s + A))", &format!("{k}/(s*(s + {a}))"));
        let set = format!(r#""{k}": "1", "{a}": "1""#);
        let asked = Asked { set: set.leak(), ..Asked::of("continuous") };
        told(&model, &asked, phases(&format!(r#"{{"parameter": "{k}"}}"#), [51.7, 52.0]));
        if case == 0 || is_thorough() {
            told(&model, &asked, both("disk_margin", &format!(r#"{{"signal": "{y}"}}"#), ["80/100", "110/100"]));
        }
    }
}

/// A signal that several blocks use is cut for all of them; the input of one block is its own.
#[test]
fn a_signal_is_cut_where_it_is_used_and_an_input_where_it_enters() {
    let model = "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y', 'y - r']\n[[block]]\nname = 'slow'\ninput = 'r - y'\noutput = 'v'\n\
                 transfer = '3/s'\n[[block]]\nname = 'fast'\ninput = ['v - y']\noutput = 'u'\ntransfer = '3/(s/100 + 1)'\n[[block]]\nname = 'plant'\n\
                 input = '2*u - u'\noutput = 'y'\ntransfer = '1/(s + 1)'\n";
    let asked = Asked::of("continuous");
    let limit = |at: &str| {
        let is_met = |k: i64| {
            let asked = asked.clone().require(other("gain_margin", at, &format!("{k}/10")));
            check(model, &asked.certificate("+."), &LIMITS).is_ok() || accepted(model, &asked).0 == '+'
        };
        [is_met(440), is_met(460)]
    };
    // Around the inner loop s^3 + 101 s^2 + 400 s + 900 k has a limit at k = 44.9; else it is s^3 + 101 s^2 + (100 + 300 k) s + 900 k.
    assert_eq!(limit(r#"{"input": "slow"}"#), [true, false]);
    assert_eq!(limit(r#"{"signal": "v"}"#), [true, false]);
    for at in [r#"{"input": "fast"}"#, r#"{"signal": "u"}"#, r#"{"input": "plant"}"#, r#"{"signal": "y"}"#] {
        assert_eq!(limit(at), [true, true], "{at}");
    }
    let nobody = r#"{"kind": "gain_margin", "at": {"signal": "r"}, "bound": "2"}"#;
    assert_eq!(check(model, &asked.require(nobody).certificate("+."), &LIMITS).unwrap_err().step, Step::Model);
}

/// A loop that does not go through the cut bears every factor, and a factor that is zero opens a loop.
#[test]
fn cuts_beside_the_loop_and_factors_of_zero() {
    let model = loop_of("continuous", "1/(s*(s + 1))", "")
        + "[[block]]\nname = 'filter'\ninput = 'y'\noutput = 'w'\ntransfer = '1/(s + 3)'\n";
    let asked = Asked::of("continuous");
    for require in [
        phase(r#"{"signal": "w"}"#, 170.0),
        other("modulus_margin", r#"{"signal": "w"}"#, "99/100"),
        other("disk_margin", r#"{"input": "filter"}"#, "1/2"),
    ] {
        assert_eq!(accepted(&model, &asked.clone().require(require)).0, '+');
    }
    // Of K/(s + 1) the peak is K/(K + 1), less than one.
    let small = loop_of("continuous", "1/(s + 1)", "");
    told(&small, &asked, both("complementary_peak", INPUT, ["6/10", "4/10"]));
}

/// A short text asks for little work and memory, however many names it has.
#[test]
fn what_is_too_much_is_refused() {
    let names: Vec<String> = (1..=7).map(|k| format!("k{k}")).collect();
    let declared = names.iter().map(|name| format!("{name} = {{}}")).collect::<Vec<_>>().join(", ");
    let model = format!(
        "time = 'continuous'\nparameters = {{ {declared} }}\nloop.characteristic = '(s + {})^5 + s + 1'",
        names.join(" + ")
    );
    let ranges = names
        .iter()
        .map(|name| format!(r#"{{"name": "{name}", "between": ["1", "2"]}}"#))
        .collect::<Vec<_>>()
        .join(", ");
    let require = other("gain_margin", r#"{"parameter": "k1"}"#, "2");
    let asked = Asked { for_all: ranges.leak(), order: 8, ..Asked::of("continuous") }.require(require);
    for tree in ["+.".to_owned(), format!("+{}", "abcdefgh".repeat(16)), "-0mambmcmd.".to_owned()] {
        let rejected = check(&model, &asked.certificate(&tree), &LIMITS).unwrap_err();
        println!("{rejected}");
        assert!(matches!(rejected.step, Step::Work), "{rejected}");
    }
}
