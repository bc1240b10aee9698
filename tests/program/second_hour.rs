//! What a user meets after the first limit: words, places and helps that were found wanting when models of one's own were tried.

use crate::helpers::program::{jurist, jurist_with_input, refused, refused_model};

/// The text of the answer to a question about a model on standard input.
fn text(arguments: &[&str], model: &str) -> String {
    let run = jurist_with_input(arguments, model.as_bytes());
    assert!(run.status <= 1, "{arguments:?}: {}", run.stderr);
    run.stdout
}

/// Two loops, one inside of the other: without a word about the cut it is not clear where margins are taken.
const CASCADE: &str = "time = 'discrete'\nsample_time = 1e-3\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'outer'\ninput = 'r - y'\noutput = 'c'\ntransfer = '1/20'\n\
    [[block]]\nname = 'inner'\ninput = 'c - i'\noutput = 'u'\ntransfer = '1/2'\n\
    [[block]]\nname = 'fast'\ninput = 'u'\noutput = 'i'\ntransfer = '1/(z - 1)'\n\
    [[block]]\nname = 'slow'\ninput = 'i'\noutput = 'y'\ntransfer = '1/(z - 1)'\n";

#[test]
fn margins_and_diagrams_are_taken_where_require_says() {
    let required = format!("{CASCADE}[require]\nphase_margin = '30 deg'\nat = 'u'\n");
    assert!(text(&["margins", "-"], &required).contains("\ncut at the signal 'u'\n"));
    assert!(text(&["margins", "-", "--at", "i"], &required).contains("\ncut at the signal 'i'\n"));
    for command in ["bode", "nyquist"] {
        let run = jurist_with_input(&[command, "-", "-o", "-", "--format", "json"], required.as_bytes());
        let run = if run.status == 2 { jurist_with_input(&[command, "-"], required.as_bytes()) } else { run };
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert_eq!(jurist_with_input(&[command, "-"], CASCADE.as_bytes()).status, 2);
    }
    let nowhere = required.replace("at = 'u'", "at = 'w'");
    let run = jurist_with_input(&["margins", "-"], nowhere.as_bytes());
    assert!(run.stderr.contains("the loop has no signal 'w' to cut"), "{}", run.stderr);
}

#[test]
fn a_word_comes_before_the_code_that_ends_like_it_and_joined_causes_are_all_explained() {
    for (asked, begins) in [
        ("domain", "domain\n\nThe interval of values"),
        ("nominal", "nominal\n\nThe value of a parameter"),
        ("E-cut", "E-cut\n"),
        ("W-domain", "W-domain\n"),
        ("coq", "E-coq\n"),
        ("GM", "GM\n\nThe factor by which a gain may grow"),
        ("quasi-polynomial", "quasi-polynomial\n"),
    ] {
        let said = jurist(&["explain", asked]);
        assert!(said.status == 0 && said.stdout.starts_with(begins), "{asked}: {}", said.stdout);
    }
    let said = jurist(&["explain", "infinity+pole+domain"]).stdout;
    assert!(["infinity\n\n", "\n\npole\n\n", "\n\ndomain\n\n"].iter().all(|part| said.contains(part)), "{said}");
    refused(&["explain", "z=1+nonsense"], "E-unknown-code");
}

#[test]
fn keys_in_the_wrong_table_are_told_their_place() {
    let run = refused_model(b"time = 'discrete'\ncharacteristic = 'z - 1/2'\n", "E-unknown-key");
    assert!(run.stderr.contains("it belongs below a line '[loop]'"), "{}", run.stderr);
    assert!(!run.stderr.contains("E-missing"), "{}", run.stderr);
    let run = refused_model(b"time = 'discrete'\ntransfer = '1/z'\n[loop]\ninputs = ['r']\n", "E-unknown-key");
    assert!(run.stderr.contains("it belongs below a line '[[block]]'"), "{}", run.stderr);
    let run = jurist_with_input(&["check", "-"], b"[loop]\ntime = 'discrete'\ncharacteristic = 'z - 1/2'\n");
    assert!(run.stderr.contains("it belongs at the top of the file"), "{}", run.stderr);
}

#[test]
fn the_sample_time_is_asked_about_by_a_name() {
    let run = jurist_with_input(&["intervals", "-", "--param", "sample_time"], CASCADE.as_bytes());
    assert!(run.status == 2 && run.stderr.contains("sample_time = \"T\", and a constant T"), "{}", run.stderr);
}

#[test]
fn times_that_cannot_be_are_told_of_the_option() {
    for (option, value, message) in [
        ("--hold", "0", "the sample time of a hold is positive"),
        ("--hold", "1/3-1", "the sample time of a hold is positive"),
        ("--delay", "-1", "a dead time is not negative"),
    ] {
        let run = refused(&["K/(s+1)", &format!("{option}={value}")], "E-value");
        assert!(run.stderr.contains(message) && run.stderr.contains(option), "{}", run.stderr);
        assert!(!run.stderr.contains("model of the line"), "{}", run.stderr);
    }
    assert_eq!(jurist(&["K/(s+1)", "--delay", "0"]).status, 0);
}

#[test]
fn the_imaginary_unit_of_a_line_is_j_and_another_letter_is_told() {
    let run = jurist(&["verdict", "2*i/(s+1)", "--set", "i=1"]);
    assert!(
        run.status == 0 && run.stderr.contains("'i' is a parameter; the imaginary unit is written 'j'"),
        "{}",
        run.stderr
    );
    assert!(!jurist(&["verdict", "2*i/(s+1)", "--set", "i=1", "-q"]).stderr.contains("imaginary"));
    // s = -1 - 2j
    let run = jurist(&["verdict", "2*j/(s+1)"]);
    assert!(run.status == 0 && !run.stderr.contains("imaginary"), "{}", run.stderr);
    assert!(
        jurist(&["roots", "2*j/(s+1)"]).stdout.contains("-1.00000000000 - 2.00000000000 j"),
        "{}",
        jurist(&["roots", "2*j/(s+1)"]).stdout
    );
    assert!(!jurist(&["verdict", "2*k/(s+1)", "--set", "k=1"]).stderr.contains("imaginary"));
}

/// Stable for K < 7, of which 1 is the nominal value.
const SQUARE: &str = "time = 'discrete'\n[parameters]\nK = { nominal = 1, min = 0, max = 5, closed = true }\n[loop]\ncharacteristic = 'z^2 + z/10 + K/7'\n";

#[test]
fn tolerances_of_nothing_and_of_an_unstable_loop_are_told_as_that() {
    let said = text(&["tolerance", "-", "--tol", "K=0%"], SQUARE);
    assert!(said.ends_with("\nall tolerances are 0: stable at the nominal point (proof: 1 cell)\n"), "{said}");
    let outside = SQUARE.replace("nominal = 1", "nominal = 8").replace(", max = 5, closed = true", "");
    let run = jurist_with_input(&["tolerance", "-", "--tol", "K=10%"], outside.as_bytes());
    assert!(run.stdout.contains("not at K = 8, the nominal point: unstable"), "{}", run.stdout);
    let other = outside.replace("K/7'", "K/7 + L'").replace("[loop]", "L = { nominal = 0.1 }\n[loop]");
    let run = jurist_with_input(&["tolerance", "-", "--tol", "K=10%", "--limit", "L"], other.as_bytes());
    assert!(run.stderr.contains("'jurist intervals --param L' finds one"), "{}", run.stderr);
}

#[test]
fn rows_of_a_sweep_say_which_ends_belong_to_the_interval() {
    let model = SQUARE.replace("[loop]", "a = 1\n[loop]").replace("K/7", "a*K/7");
    let rows = text(&["sweep", "-", "--param", "K", "--over", "a=1,2"], &model);
    let rows: Vec<serde_json::Value> = rows.lines().map(|row| serde_json::from_str(row).unwrap()).collect();
    assert_eq!((&rows[0]["lower_closed"], &rows[0]["upper_closed"]), (&true.into(), &true.into()));
    assert_eq!((&rows[1]["lower_closed"], &rows[1]["upper_closed"]), (&true.into(), &false.into()));
}

#[test]
fn numbers_of_binary_floating_point_are_written_as_what_they_were() {
    let model = "time = 'discrete'\n[parameters]\nK = { nominal = 0.100000001490116119384765625 }\n[loop]\ncharacteristic = 'z^2 + z/10 + K/7'\n";
    assert!(text(&["-"], model).contains("\nat K = 0.1 as float32\n"));
    let double = model.replace("0.100000001490116119384765625", "'3602879701896397/36028797018963968'");
    assert!(text(&["-"], &double).contains("\nat K = 0.1 as float64\n"));
    let neither = model.replace("0.100000001490116119384765625", "0.1000000014901161");
    assert!(text(&["-"], &neither).contains("\nat K = 1000000014901161/10000000000000000\n"));
}

#[test]
#[ignore = "long: CI runs it"]
fn a_delay_margin_that_ends_at_an_edge_of_the_pulse_says_so() {
    let template = jurist(&["new", "digital-power"]).stdout;
    let said = text(&["margins", "-"], &template);
    let words =
        "at the input of 'power stage', where a sample falls on an edge of its pulse and the model is undefined\n";
    assert!(said.contains(words), "{said}");
}

#[test]
fn tolerances_with_dead_time_among_them_have_a_certificate() {
    let model = "time = 'continuous'\n[parameters]\nK = { nominal = 1, tolerance = '10%' }\nd = { nominal = 0.2, tolerance = '10%' }\n\
        [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*exp(-d*s)/(s + 1)'\n";
    let file = std::env::temp_dir().join(format!("jurist-hour-{}.json", std::process::id()));
    let run = jurist_with_input(&["tolerance", "-", "--certificate", file.to_str().unwrap()], model.as_bytes());
    assert!(run.stdout.contains("stable for all values"), "{}", run.stdout);
    assert!(run.status == 0 && !run.stderr.contains("W-certificate"), "{}", run.stderr);
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_file(&file).unwrap();
    let proved = jurist_check::check(model, &text, &jurist_check::Limits::within(std::time::Duration::MAX)).unwrap();
    assert!(proved.statement.contains("d from"), "{}", proved.statement);
}

/// Unstable for T_m < 2.466; near zero nothing is decided.
const LAG: &str = "time = 'discrete'\nsample_time = 1\n[parameters]\nK = 5\nT_m = { nominal = 5, min = 0 }\n\
    [loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'plant'\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/(T_m*s + 1)'\ndiscretize = 'zoh'\n";

#[test]
fn an_expected_range_fails_where_a_part_of_it_is_surely_unstable() {
    let tried = |range: &str| {
        let folder = std::env::temp_dir().join(format!("jurist-gap-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("loop.toml");
        std::fs::write(&file, format!("{LAG}[[expect]]\nparam = 'T_m'\nstable = {range}\n")).unwrap();
        let run = jurist(&["test", file.to_str().unwrap()]);
        std::fs::remove_dir_all(&folder).unwrap();
        run.status
    };
    assert_eq!(tried("[3, 10]"), 0);
    assert_eq!(tried("[0, 10]"), 1);
    assert_eq!(tried("[2, 10]"), 1);
}

#[test]
fn a_map_of_margins_with_dead_time_has_the_boxes_in_which_they_are_met() {
    let model = "time = 'continuous'\n[parameters]\nK = { nominal = 1 }\nd = { nominal = 0.2 }\n\
        [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*exp(-d*s)/(s + 1)'\n";
    let map = ["map", "-", "-x", "K=0..2", "-y", "d=0..1", "--undecided", "0.2"];
    let run = jurist_with_input(&[&map[..], &["--phase-margin", "45 deg"]].concat(), model.as_bytes());
    assert!(
        run.status == 0 && run.stdout.contains("inside the stable boxes: phase_margin >= 45 deg"),
        "{}",
        run.stdout
    );
    let run = jurist_with_input(&[&map[..], &["--delay-margin", "0.1"]].concat(), model.as_bytes());
    assert!(run.status == 0 && run.stdout.contains("inside the stable boxes: delay_margin >= 1/10"), "{}", run.stdout);
}

/// Once the names with ranges had the middles of them where what is required was read.
#[test]
#[ignore = "long: CI runs it"]
fn what_is_required_may_not_depend_on_a_name_with_a_range() {
    let text = "time = 'discrete'\nsample_time = 'T'\nparameters = { K = { nominal = 1, min = 0, max = 4 }, T = 1, b = 1 }\n\
        loop = { inputs = ['r'], outputs = ['y'] }\n[[block]]\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = 'b/(s + 1)'\ndiscretize = 'zoh'\n";
    let line = ["intervals", "-", "--param", "K"];
    let plane = ["map", "-", "-x", "K=0..2", "-y", "b=0.5..1.5"];
    for asked in [&line[..], &plane[..]] {
        // The sample time decides the radius of a settling time.
        for required in [["--settling-time", "3"], ["--phase-margin", "40*T"]] {
            let run = jurist_with_input(&[asked, &required, &["--for-all", "T=0.8..1.2"]].concat(), text.as_bytes());
            assert!(run.status == 2 && run.stderr.contains("E-require"), "{asked:?} {required:?}: {}", run.stderr);
        }
    }
    let run = jurist_with_input(
        &[&line[..], &["--settling-time", "3", "--set", "T=0.1", "--for-all", "b=0.8..1.2"]].concat(),
        text.as_bytes(),
    );
    assert!(run.stdout.contains("0.389650249"), "{}", run.stdout);
}

/// An example of an option is one that the option takes, and a list of inputs follows one that is unknown.
#[test]
fn help_behind_an_error_is_of_use() {
    let error = |arguments: &[&str]| jurist(arguments).stderr;
    let range = error(&["margins", "K/(s+1)", "--for-all", "K=1"]);
    assert!(range.contains("for example --for-all K=0..10\n"), "{range}");
    let name = error(&["intervals", "K*a/(s+1)", "K"]);
    assert!(name.contains("'--param K'"), "{name}");
    let value = error(&["margins", "K/(s+1)", "K=3"]);
    assert!(value.contains("'--set K=3'"), "{value}");
    let input = error(&["simulate", "K/(s+1)", "--set", "K=1", "--input", "u=1"]);
    assert!(input.contains("no input 'u'") && input.contains("its inputs: r"), "{input}");
    let unit = error(&["intervals", "K/(s+1)^3", "--gain-margin", "6 db"]);
    assert!(unit.contains("a factor both ways, or decibels: \"6 dB\""), "{unit}");
    let ignored = jurist_with_input(
        &["analyze", "-"],
        b"time = 'continuous'\nparameters.K = 1\nloop.characteristic = 's + K'\nrequire.damping = 0.5\n",
    );
    assert!(ignored.stderr.contains("'tolerance', 'tune', 'report' and 'test'"), "{}", ignored.stderr);
}
