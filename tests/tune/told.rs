//! What `jurist tune` tells people: one number as a number, a range as one, what binds, and what is known where the work ended.

use crate::helpers::folder::Folder;
use crate::helpers::program::jurist;
use crate::helpers::thorough::is_thorough;

/// A PI controller for three equal lags.
const PI: &str = "examples/pi-sensitivity.toml";

fn told(arguments: &[&str]) -> (i32, String, String) {
    let run = jurist(&[&["tune"], arguments].concat());
    (run.status, run.stdout, run.stderr)
}

fn line(text: &str, objective: &str, options: &[&str]) -> String {
    let (status, out, err) = told(&[&[text, "--free", "K", "--objective", objective], options].concat());
    assert_eq!(status, 0, "{text} {objective}: {err}");
    out
}

#[test]
fn a_gain_that_is_one_number_is_printed_as_one() {
    let (_, out, _) = told(&[PI]);
    assert!(out.contains("\n    at k = 0.632974269436\n"), "{out}");
    let (_, out, _) = told(&[PI, "--digits", "16"]);
    assert!(out.contains("\n    at k = 0.6329742694363943\n"), "{out}");
}

#[test]
fn a_best_value_of_a_whole_interval_says_so() {
    // Below the largest integral gain many proportional gains do.
    let (_, out, _) = told(&[PI, "--bound", "ki=0..0.2"]);
    assert!(out.contains("\n    at any k from 0.106519 to 1.07993\n"), "{out}");
    // The closed loop K/(z - 1 + K) has its peak, 1, at frequency 0 for all K up to 1.
    let out = line("K/(z-1)", "min complementary_peak", &[]);
    assert!(out.contains("smallest complementary_peak: 1\n    at any K from 0 to 1\n"), "{out}");
    // From the double root on the decay is half of the damping: of one gain that is known, of an interval it is not.
    let out = line("K/(s^2+0.2*s+1)", "max decay", &["--bound", "K=-0.9..3"]);
    assert!(out.contains("largest decay: 0.1\n    at K = ") && !out.contains("any K"), "{out}");
}

/// At the end of a scale an interval of gains near to it was printed once as if all of them had the best value.
#[test]
fn the_end_of_a_scale_is_not_said_of_gains_that_only_come_close() {
    // The open loop is above 1 at frequency 0 for all K > 1.
    let out = line("K/(s+1)", "max phase_margin", &["--bound", "K=1..3"]);
    assert!(
        !out.contains("at any K") && !out.contains("no phase limits") && out.contains("at least 179 degrees"),
        "{out}"
    );
    let out = line("K/(s+1)^3", "max phase_margin", &["--bound", "K=1/2..30"]);
    assert!(!out.contains("at any K") && out.contains("no phase limits") && out.contains("example K = 0."), "{out}");
    let out = line("K/(s+1)", "min complementary_peak", &["--bound", "K=0..5"]);
    assert!(out.contains("smallest complementary_peak: 0\n    at K = 0\n"), "{out}");
    let out = line("K/(z*(z+1/2)^2)", "min norm r y", &["--bound", "K=-1..3"]);
    assert!(out.contains("smallest norm r y: 0\n    at K = 0\n"), "{out}");
    // Of negative gains the margin is finite, and as large as one likes.
    let out = line("K/(s+1)", "max gain_margin", &["--bound", "K=-1/2..3"]);
    assert!(out.contains("it has no bound\nfor example K = 1\n"), "{out}");
}

/// What some gains have at least is not rounded up.
#[test]
fn a_level_that_is_found_is_rounded_to_its_safe_side() {
    let (_, out, _) = told(&[PI, "--objective", "max k*ki", "--gap", "0.1"]);
    let ends: Vec<f64> = out
        .split("between ")
        .nth(1)
        .unwrap()
        .split(" (")
        .next()
        .unwrap()
        .split(" and ")
        .map(|x| x.parse().unwrap())
        .collect();
    assert!(ends[0] <= 0.2544 && ends[1] >= 0.2544, "{out}");
}

#[test]
fn a_bound_that_is_best_is_named_and_typed_in() {
    let out = line("K/(s*(s+1)*(s+2))", "max modulus_margin", &["--bound", "K=0.37..1"]);
    for part in ["at K = 0.37\n", "binds: bound of K\n", "type in K = 0.37: ", ", no loss\n"] {
        assert!(out.contains(part), "{part}: {out}");
    }
    let (_, out, _) = told(&[PI, "--bound", "ki=0..0.2"]);
    assert!(out.contains("binds: bound of ki\n") && out.contains("type in ki = 0.2, k = 1, no loss\n"), "{out}");
    // The requirement is what binds where no bound is reached.
    let (_, out, _) = told(&[PI]);
    assert!(out.contains("binds: modulus_margin\n"), "{out}");
}

/// In a bracket the loss is what it may be at most.
#[test]
fn the_loss_of_a_bracket_is_an_upper_one() {
    let (status, out, _) = told(&[PI, "--objective", "max k*ki", "--gap", "0.1"]);
    let words = ", loss at most ";
    let share = out.split(words).nth(1).and_then(|rest| rest.split(' ').next()).map(str::parse::<f64>);
    let Some(Ok(share)) = share else { panic!("{out}") };
    // One per cent of what was found, and the gap.
    assert!(status == 0 && share > 0.0 && share < 11.5, "{out}");
}

/// Next to zero a share of the best value says nothing: it was 59400 % once.
#[test]
fn next_to_zero_a_bracket_has_no_share() {
    let (status, out, _) =
        told(&["(s+a)*(s+k)", "--free", "k", "--bound", "k=0..10", "--objective", "min k", "--for-all", "a=1..2"]);
    assert!(status == 0 && out.contains("type in k = ") && !out.contains('%'), "{out}");
}

/// Wherever the work ends, what is known is said.
#[test]
#[ignore = "long: CI runs it"]
fn an_early_end_leaves_the_bracket_so_far() {
    let three = [
        "(kd*s^2+kp*s+ki)/(s*(s+1)^3)",
        "--free",
        "kp",
        "--free",
        "ki",
        "--free",
        "kd",
        "--bound",
        "kp=0..4",
        "--bound",
        "ki=0..2",
    ];
    let three = [&three[..], &["--bound", "kd=0..1", "--objective", "max ki", "--modulus-margin", "0.6"]].concat();
    let margin =
        ["K/(s*(s+1)*(s+2)*(s+3)*(s+5))", "--free", "K", "--objective", "max modulus_margin", "--bound", "K=0..100"];
    for arguments in [&[PI][..], &three, &margin] {
        let mut ends = 0;
        for work in (0..9).map(|k| (2000_u64 << (2 * k)).to_string()) {
            let (status, out, err) = told(&[arguments, &["--work", &work]].concat());
            if status == 0 {
                break;
            }
            // Reading the model may take what there is.
            assert!(status == 3 && (out.contains("free, required: ") || ends == 0), "{work}: {out}{err}");
            ends += 1;
        }
        assert!(ends > 1, "{arguments:?}");
    }
    let (_, out, _) = told(&[PI, "--work", "100000"]);
    assert!(out.contains("largest ki: none better than 5\n"), "{out}");
}

#[test]
fn the_refusal_of_complex_loops_says_what_to_ask() {
    let (status, _, err) = told(&["examples/pmsm-frame.toml", "--free", "K_p", "--objective", "min radius"]);
    assert!(status == 2 && err.contains("the best gains of a loop with complex coefficients are not known"), "{err}");
    assert!(err.contains("'jurist intervals' says which values of one gain are good"), "{err}");
}

/// A report has the best gains of a model that asks for them, in the words of the command.
#[test]
fn a_report_has_the_best_gains() {
    let run = jurist(&["report", PI, "-o", "-", "-q"]);
    let begin = run.stdout.find("<section id=\"best\">").expect("the model has a section [tune]");
    let part = &run.stdout[begin..begin + run.stdout[begin..].find("</section>").unwrap()];
    let (_, out, _) = told(&[PI]);
    for line in out.lines().skip(2) {
        assert!(part.contains(&line.replace('>', "&gt;")), "{line}: {part}");
    }
    assert!(!jurist(&["report", "examples/de-gaston-safonov.toml", "-o", "-", "-q"]).stdout.contains("id=\"best\""));
}

/// Errors named a text `<expression>` or `<objective>` that nobody wrote, or no place at all.
#[test]
fn an_error_in_an_objective_underlines_the_word_that_is_wrong() {
    let quantities = "'max' may be followed by K, by an expression such as 2*K, or by one of gain_margin, phase_margin";
    for (objective, underlined, help) in [
        ("max K K", "expected an operator", quantities),
        ("max foo", "^^^ unknown", quantities),
        ("max delaymargin", "^^^^^^^^^^^ unknown", "did you mean 'delay_margin'?"),
        ("max", "^^^ something is missing", quantities),
        ("biggest K", "^^^^^^^ unknown", "'min' may be followed by K"),
        ("min radius + K", "^^^^^^ stands alone", "known in expressions: K"),
        ("max sin(K)", "^^^^^^ a function", "rational expression"),
        ("max K/K", "^^^ a constant", "an expression of the free gains"),
        ("max 1/0*K", "^ zero for all gains", ""),
        ("max radius", "^^^ the other way round", "write 'min radius'"),
        ("min norm r foo", "^^^ unknown", "known here: y"),
    ] {
        let (status, _, err) = told(&["K/(z-1/2)", "--free", "K", "--objective", objective]);
        assert!(status == 2 && err.contains("--> <command line>:1:"), "{objective}: {err}");
        assert!(err.contains(underlined) && err.contains(help), "{objective}: {err}");
    }
    let model = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/pi-sensitivity.toml")).unwrap();
    let folder = Folder::new(&[("loop.toml", &model.replace("\"max ki\"", "\"max ki*kj\""))]);
    let err = folder.jurist(&["tune", "loop.toml"]).stderr;
    assert!(err.contains("\"max ki*kj\"\n") && err.contains("--> loop.toml:") && err.contains("^^ unknown"), "{err}");
    // A name that has a value.
    let (_, _, err) = told(&[PI, "--free", "k", "--objective", "max ki"]);
    assert!(err.contains("'ki' is not free") && err.contains("free it too: --free ki"), "{err}");
}

/// The radius 0 of a deadbeat loop stayed a bracket: gains of few digits were never 0.
#[test]
fn gains_that_are_nearly_zero_are_tried_as_zero() {
    let polynomial = if is_thorough() { "z^3+k*z^2+q" } else { "z^2+k*z+q" };
    let out = told(&[polynomial, "--free", "k", "--free", "q", "--objective", "min radius"]).1;
    assert!(out.contains("smallest radius: 0\n    at k = 0, q = 0\n"), "{out}");
    assert!(out.contains("type in k = 0, q = 0: radius 0, no loss\n") && !out.contains("between"), "{out}");
}

/// An example was as near to an end that no gain has as the search had come: `K = 1/5000001`.
#[test]
fn an_example_beside_an_end_is_a_short_number() {
    let out = line("K/(z^2*(z-1))", "min K", &[]);
    assert!(out.contains("smallest K: 0, which is not reached\n") && out.contains("type in K = 0.01\n"), "{out}");
    let two = ["K*(s+a)/(s*s*(s+3))", "--free", "K", "--free", "a", "--objective"];
    let (_, out, _) = told(&[&two[..], &["min a"]].concat());
    assert!(out.contains("type in K = 2, a = 0.01\n"), "{out}");
    let (_, out, _) = told(&[&two[..], &["max a"]].concat());
    assert!(out.contains("largest a: 3, which is not reached\n    approached at any K from 0\n"), "{out}");
    assert!(out.contains("type in K = 2, a = 2.99, loss 0.333 %\n"), "{out}");
}

/// `binds: s=0+domain` had to be looked up, and on a plateau it named what ends the other gain.
#[test]
fn what_binds_is_said_in_words() {
    for (objective, options, words) in [
        ("min K", &["--domain", "K=0.."][..], "stability (a root at z=1), the end of a gain's domain"),
        ("max K", &[], "stability (complex pair)"),
        ("max modulus_margin", &[], "modulus_margin itself"),
    ] {
        let out = line("K/(z^2*(z-1))", objective, options);
        assert!(out.contains(&format!("    binds: {words}\n")), "{out}");
    }
    // Stable for K > -1 and q > -1: the least q is that of a root at 0.
    let (_, out, _) = told(&["(K*s+q)/(s^2+s+1)", "--free", "K", "--free", "q", "--objective", "min q"]);
    assert!(out.contains("smallest q: -1, which is not reached\n") && out.contains("(a root at s=0)\n"), "{out}");
    for (word, part) in [("tune", "--objective"), ("binds", "a bound of a gain")] {
        let out = jurist(&["explain", word]).stdout;
        assert!(out.contains(part), "{out}");
    }
}

/// A loop with dead time whose open loop is below 1 at all frequencies has no phase margin to bracket.
#[test]
#[ignore = "long: CI runs it"]
fn no_phase_limits_a_small_gain_with_dead_time() {
    let out = line("K/(s+1)", "max phase_margin", &["--delay", "1"]);
    assert!(out.contains("no phase limits the loop") && !out.contains("undecided"), "{out}");
}

/// The refusal was that of a gain margin with one gain, and of more gains nothing was said but that no value was found.
#[test]
fn a_norm_with_dead_time_is_refused_with_what_to_ask() {
    for gains in [
        &["--free", "K", "--set", "q=1", "--bound", "K=0..1"][..],
        &["--free", "K", "--free", "q", "--bound", "K=0..1", "--bound", "q=0..1"],
    ] {
        let asked = [&["(K*s+q)/(s*(s+1))", "--delay", "1", "--objective", "min norm r y"][..], gains].concat();
        let (status, _, err) = told(&asked);
        assert!(status == 2 && err.contains("E-dead-time") && err.contains("jurist norm"), "{err}");
    }
}

/// A map of two gains behind a hold with a margin takes minutes: its end left nothing said, though the nominal gains are good, and with bounds boxes are searched.
#[test]
fn an_early_end_without_bounds_has_the_nominal_gains_and_asks_for_bounds() {
    let model = "time = 'discrete'\nsample_time = 2\nparameters = { Kp = 1, Ki = 0.02 }\n[loop]\ninputs = ['r']\noutputs = ['h']\n\
        [[block]]\nname = 'pi'\ninput = 'r - h'\noutput = 'u'\ntransfer = 'Kp + Ki*2*z/(z - 1)'\n\
        [[block]]\nname = 'tank'\ninput = 'u'\noutput = 'h'\ntransfer = '1/(60*s + 1)'\ndiscretize = { method = 'zoh', delay = 5 }\n";
    let folder = Folder::new(&[("loop.toml", model)]);
    let asked =
        ["tune", "loop.toml", "--free", "Kp", "--free", "Ki", "--objective", "max Ki", "--modulus-margin", "0.5"];
    let run = folder.jurist(&[&asked[..], &["--work", "10000000"]].concat());
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stdout.contains("for example Kp = 1, Ki = 0.02\n"), "{}", run.stdout);
    assert!(run.stdout.contains("ends sooner: --bound Kp=LO..HI --bound Ki=LO..HI\n"), "{}", run.stdout);
}

/// The shortest number from 0 on is 0, which no tolerance has: `K = 9111/2375` was the example.
#[test]
fn the_middle_of_gains_from_zero_on_is_a_short_number() {
    let out = line("K/(s*(s+1)^2)", "max tolerance", &["--domain", "K=0.."]);
    assert!(out.contains("type in K = 1") && !out.contains("for example"), "{out}");
}

/// `(Kp s + Ki)/(s (s + 1))` is stable for all positive factors.
#[test]
fn a_margin_of_several_gains_that_nothing_limits_says_so() {
    let options = ["--json", "--free", "Ki", "--free", "Kd", "--bound", "K=1..3", "--bound", "Ki=1..3"];
    let two = told(&[&["(K+Ki/s)/(s+1)", "--free", "K", "--objective", "max gain_margin"], &options[..3]].concat());
    assert!(two.0 == 0 && two.1.contains("\"unbounded\": true"), "{two:?}");
    let three = [&["(K+Ki/s+Kd*s)/(s+1)", "--free", "K", "--objective", "max gain_margin"], &options[1..]].concat();
    let (status, out, _) = told(&[&three[..], &["--bound", "Kd=0..2"]].concat());
    assert!(status == 0 && out.contains("gain_margin: it has no bound\n") && !out.contains("at least"), "{out}");
}

#[test]
fn what_is_missing_or_written_in_two_words_is_said() {
    let (status, _, error) = told(&["K/(s+1)", "--objective", "max K", "--phase-margin", "45 deg"]);
    assert!(status == 2 && error.contains("E-tune-free") && error.contains("--free K"), "{error}");
    let (status, _, error) = told(&["K/(s+1)", "--free", "K", "--objective", "max phase margin"]);
    assert!(status == 2 && error.contains("write 'phase_margin'"), "{error}");
}
