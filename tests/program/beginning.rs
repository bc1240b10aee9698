//! The first minutes: templates, a model that is only read, a model without a command, words of other programs.

use crate::helpers::program::{json, jurist, jurist_with_input, refused};
use crate::helpers::schema::fits;
use crate::helpers::thorough::is_tried;
use serde_json::Value;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The names that `jurist new --list` prints.
fn templates() -> Vec<String> {
    let run = jurist(&["new", "--list"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    run.stdout.lines().map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

#[test]
fn every_template_is_a_model_without_remarks_that_is_stable_at_its_nominal_point() {
    let names = templates();
    assert!(names.len() >= 8, "{names:?}");
    for name in names {
        let text = jurist(&["new", &name]).stdout;
        let checked = jurist_with_input(&["check", "-", "--json"], text.as_bytes());
        let document: Value = serde_json::from_str(&checked.stdout).unwrap();
        fits(&document).unwrap();
        assert_eq!((checked.status, &document["diagnostics"]), (0, &Value::Array(Vec::new())), "{name}");
        let verdict = jurist_with_input(&["verdict", "-"], text.as_bytes());
        assert_eq!((verdict.status, verdict.stderr.as_str()), (0, ""), "{name}: {}", verdict.stdout);
    }
}

/// But for `analyze` and `report`, which others ask of templates, and with coarse boxes for exact maps, which take their time.
#[test]
fn the_commands_that_templates_name_answer() {
    let folder = tempfile();
    for name in templates() {
        let text = jurist(&["new", &name]).stdout;
        let lines = text.lines().filter_map(|line| line.strip_prefix("# jurist "));
        let lines = lines.filter(|line| !line.starts_with("analyze") && !line.starts_with("report"));
        for (_, line) in lines.enumerate().filter(|(i, _)| is_tried(i + name.len(), 5)) {
            // What follows two blanks says what the command is for.
            let (words, _) = line.split_once("  ").unwrap_or((line, ""));
            let file = |word: &str| folder.join(word).to_str().unwrap().to_owned();
            let words = words.split(' ').map(|word| match word {
                "FILE" => "-".to_owned(),
                _ if word.contains('.') => file(word),
                _ => word.to_owned(),
            });
            let mut words: Vec<String> = words.collect();
            // Of a domain without end there are no boxes.
            if words[0] == "map" && name != "polynomial" {
                words.extend(["--method", "boxes", "--undecided", "0.3"].map(str::to_owned));
            }
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            let run = jurist_with_input(&words, text.as_bytes());
            assert_eq!(run.status, 0, "{name}: {line}: {}", run.stderr);
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn templates_replace_nothing() {
    let folder = tempfile();
    let file = folder.join("loop.toml");
    let name = file.to_str().unwrap();
    assert_eq!(jurist(&["new", "polynomial", "-o", name]).status, 0);
    let written = std::fs::read(&file).unwrap();
    let run = refused(&["new", "matrix", "-o", name], "E-write");
    assert!(run.stderr.contains("exists already"), "{}", run.stderr);
    assert_eq!(std::fs::read(&file).unwrap(), written);
    let run = refused(&["new", "cascade"], "E-unknown-template");
    assert!(run.stderr.contains("gain-loop"), "{}", run.stderr);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
#[cfg(not(feature = "page"))]
fn a_program_without_the_page_says_what_makes_it() {
    let folder = tempfile();
    let run = refused(&["page", "-o", folder.join("page").to_str().unwrap()], "E-no-page");
    assert!(run.stderr.contains("web/build"), "{}", run.stderr);
    assert!(!folder.join("page").exists());
    std::fs::remove_dir_all(folder).unwrap();
}

/// Tests run side by side: each has a folder of its own.
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// A new folder of this process.
fn tempfile() -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!(
        "jurist-beginning-{}-{}",
        std::process::id(),
        COUNT.fetch_add(1, Ordering::Relaxed)
    ));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_model_alone_is_analysed_and_one_parameter_needs_no_name() {
    let file = "examples/heavy-ball.toml";
    assert_eq!(jurist(&[file]).stdout, jurist(&["analyze", file]).stdout);
    assert_eq!(jurist(&[file, "--json"]).stdout, jurist(&["analyze", file, "--json"]).stdout);
    let one = b"time = 'discrete'\nparameters.K = { nominal = 1 }\nloop.characteristic = 'z - K/2'\n";
    for command in ["intervals", "locus"] {
        let (left_out, named) = ([command, "-", "--json"], [command, "-", "--json", "--param", "K"]);
        assert_eq!(jurist_with_input(&left_out, one).stdout, jurist_with_input(&named, one).stdout);
        assert_eq!(jurist_with_input(&left_out, one).status, 0);
    }
    let run = refused(&["intervals"], "E-usage");
    assert!(run.stderr.contains("'--param K_pwm', '--param T'"), "{}", run.stderr);
    let none = b"time = 'discrete'\nconstants.a = 0.5\nloop.characteristic = 'z - a'\n";
    assert!(jurist_with_input(&["intervals", "-"], none).stderr.contains("0 parameters"));
}

#[test]
fn words_of_other_programs_lead_to_commands_of_this_one() {
    for (word, command) in [
        ("rlocus", "jurist locus"),
        ("step", "jurist simulate"),
        ("c2d", "discretize"),
        ("isstable", "jurist verdict"),
        ("routh", "jurist jury"),
        ("lint", "jurist check"),
    ] {
        let run = refused(&[word], "E-usage");
        assert!(run.stderr.contains(command), "{word}: {}", run.stderr);
    }
}

#[test]
fn words_of_the_answers_are_explained() {
    for word in ["complex pair", "z=-1", "gain margin", "Marginal"] {
        let run = jurist(&["explain", word]);
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{word}");
    }
    assert_eq!(jurist(&["explain", "complex", "pair"]).stdout, jurist(&["explain", "complex pair"]).stdout);
    assert!(jurist(&["explain"]).stdout.contains("complex pair"));
    refused(&["explain", "hodograph"], "E-unknown-code");
}

#[test]
fn a_model_is_only_read() {
    let good = json(&["check", "--json"]);
    assert_eq!(good["accepted"], true);
    assert_eq!(jurist(&["check"]).stdout, "<built-in drive>: no mistakes found\n");
    let bad =
        "time = 'discrete'\n[parameters]\nK = { nominal = 1, maximum = 2 }\n[loop]\ncharacteristic = 'z - k + Q'\n";
    let run = jurist_with_input(&["check", "-", "--json"], bad.as_bytes());
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    fits(&document).unwrap();
    assert_eq!((run.status, &document["accepted"]), (2, &Value::Bool(false)));
    let place = &document["diagnostics"][0]["place"];
    assert_eq!((&place["line"], &place["column"]), (&3.into(), &20.into()), "{document}");
    let text = jurist_with_input(&["check", "-"], bad.as_bytes());
    assert_eq!((text.status, text.stdout.as_str()), (2, ""));
    assert!(text.stderr.contains("<stdin>:3:20"), "{}", text.stderr);
    let log = jurist_with_input(&["check", "-", "--sarif"], bad.as_bytes());
    let log: Value = serde_json::from_str(&log.stdout).unwrap();
    let results = log["runs"][0]["results"].as_array().unwrap();
    assert_eq!(results.len(), document["diagnostics"].as_array().unwrap().len());
    assert_eq!(results[0]["level"], "error");
    assert_eq!(results[0]["locations"][0]["physicalLocation"]["region"]["startColumn"], 20);
}

/// 1/(s (s + 1)) has a phase margin of 51.8 degrees.
#[test]
fn a_sarif_log_has_the_requirements_that_are_not_met() {
    let model = |required: &str| {
        format!(
            "time = 'continuous'\n[loop]\ninputs = ['r']\n[[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\n\
             transfer = '1/(s*(s + 1))'\n[require]\n{required}"
        )
    };
    let log = |required: &str| -> (i32, Vec<Value>) {
        let run = jurist_with_input(&["check", "-", "--sarif"], model(required).as_bytes());
        let log: Value = serde_json::from_str(&run.stdout).unwrap();
        (run.status, log["runs"][0]["results"].as_array().unwrap().clone())
    };
    assert_eq!(log("phase_margin = '45 deg'\n"), (0, Vec::new()));
    let (status, found) = log("gain_margin = '6 dB'\nphase_margin = '60 deg'\ndecay = 0.1\n");
    assert_eq!((status, found.len()), (1, 1), "{found:?}");
    assert_eq!((&found[0]["ruleId"], &found[0]["level"]), (&"W-not-met".into(), &"warning".into()));
    assert!(found[0]["message"]["text"].as_str().unwrap().starts_with("phase_margin"), "{found:?}");
    assert_eq!(found[0]["locations"][0]["physicalLocation"]["region"]["startLine"], 11);
    let (status, found) = log("decay = 0.6\n");
    assert_eq!((status, found.len()), (1, 1), "{found:?}");
    // A model that is only read says nothing of it.
    let run = jurist_with_input(&["check", "-", "--json"], model("phase_margin = '60 deg'\n").as_bytes());
    assert_eq!(run.status, 0, "{}", run.stdout);
}

/// What every question about the model would be refused for is told where the model is only read.
#[test]
fn a_model_is_checked_for_requirements_and_for_expressions_that_grow() {
    let model = |plant: &str, rest: &str| {
        format!(
            "time = 'continuous'\nparameters.K = {{ nominal = '1/2' }}\nparameters.b = {{}}\nloop.inputs = ['r']\n[[block]]\n\
             input = 'r - y'\noutput = 'y'\n{plant}\n[require]\n{rest}"
        )
    };
    let found = |plant: &str, rest: &str| -> Vec<(String, u64)> {
        let run = jurist_with_input(&["check", "-", "--json"], model(plant, rest).as_bytes());
        let document: Value = serde_json::from_str(&run.stdout).unwrap();
        let mut findings = document["diagnostics"].as_array().unwrap().clone();
        findings.retain(|found| found["severity"] == "error");
        assert_eq!(run.status == 0, findings.is_empty(), "{document}");
        findings
            .iter()
            .map(|f| (f["code"].as_str().unwrap().to_owned(), f["place"]["line"].as_u64().unwrap()))
            .collect()
    };
    let at = |code: &str, lines: &[u64]| lines.iter().map(|line| (code.to_owned(), *line)).collect::<Vec<_>>();
    let lag = "transfer = 'K/(s*(s + 1))'";
    // To read such a model takes little work: the constant has no value before it is needed.
    let long = "time = 'continuous'\nconstants.a = '((1 + b)^1000)^200'\nparameters = { K = {}, b = { nominal = 2 } }\n\
        loop.characteristic = 's + K + a'\n";
    let run = jurist_with_input(&["check", "-"], long.as_bytes());
    assert!(
        run.status == 2 && run.stderr.contains("E-too-large") && run.stderr.contains("<stdin>:2:16"),
        "{}",
        run.stderr
    );
    let wrong = "gain_margin = '0.5'\nphase_margin = '200 deg'\nradius = 0.5\ndamping = 0.1\n";
    assert_eq!(found(lag, wrong), at("E-require", &[10, 11, 12]));
    assert_eq!(found(lag, "damping = 0.1\n"), []);
    // A value can be given with the question.
    assert_eq!(found(lag, "damping = 'b'\ngain_margin = '6 dB'\n"), []);
    let fixed = |rest: &str| found("transfer = '1/(s*(s + 1))'", rest);
    assert_eq!(fixed("gain_margin = '6 dB'\n"), []);
    let no_b = |plant: &str, rest: &str| {
        let text = model(plant, rest).replace("parameters.b = {}\n", "");
        jurist_with_input(&["check", "-"], text.as_bytes()).stderr
    };
    let unknown = no_b(lag, "gain_margin = '6 dB'\nat = 'Q'\n");
    assert!(unknown.contains("no signal 'Q'") && unknown.contains("<stdin>:10:6"), "{unknown}");
    let delayed = no_b("transfer = 'K*exp(-s)/(s*(s + 1))'", "damping = 0.1\n");
    assert!(delayed.contains("E-dead-time") && delayed.contains("<stdin>:9:11"), "{delayed}");
}
