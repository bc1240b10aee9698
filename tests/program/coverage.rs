//! The table of what is answered: every question is asked of a loop over each ring, and its outcome is the one that the table says.

use crate::helpers::thorough::is_tried;
use jurist::Ask;
use jurist::cli::captured;
use jurist_algebra::limits::{Budget, parallel_map};
use jurist_engine::coverage::{Asked, CoefficientRing, Coverage, Refusal, rows};
use jurist_engine::error::{Code, Diagnostic, Error, Source};
use jurist_engine::model::{Between, Cut, Model, Time};
use std::path::Path;

/// A loop over a ring with the names `K`, which decides the ring, `L` and `W`.
struct Loop {
    ring: CoefficientRing,
    model: Model,
}

/// Unity feedback of a plant with a gain `K*W`, discrete where it is made so.
fn of_blocks(ring: CoefficientRing, transfer: &str, discretize: &str) -> Loop {
    let time = if transfer.contains('z') || !discretize.is_empty() { "discrete" } else { "continuous" };
    let (sample_time, gain) = match ring {
        CoefficientRing::VaryingOrder => ("sample_time = 'K'\n", "W"),
        _ => ("", "K*W"),
    };
    let text = format!(
        "time = '{time}'\n{sample_time}[parameters]\nK = {{ nominal = '1/2', min = '1/10', max = 10 }}\n\
         L = {{ nominal = 1, min = 0, max = 10 }}\nW = {{ nominal = 1, min = '1/2', max = 3 }}\n\
         [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'plant'\ninput = '{gain}*(r - y)'\noutput = 'y'\n\
         transfer = '{transfer}'\n{discretize}"
    );
    Loop { ring, model: Model::from_toml(&Source::new("loop.toml", &text)).expect("a model").0 }
}

fn loops() -> Vec<Loop> {
    use CoefficientRing::*;
    let zoh = "discretize = { method = 'zoh', T = '1/10' }\n";
    vec![
        of_blocks(Rational, "1/(z - L/2)", ""),
        of_blocks(Rational, "1/((s + L)*(s + 1)*(s + 2))", ""),
        of_blocks(Constants, "L/(s + 1)", zoh),
        of_blocks(Constants, "L/((s + sqrt(2))*(s + 1)*(s + 2))", ""),
        of_blocks(Functions, "L/(s + K)", zoh),
        of_blocks(Functions, "L/((s + sqrt(K + 1))*(s + 1)*(s + 2))", ""),
        of_blocks(DeadTime, "L*exp(-s/2)/(s + 1)", ""),
        of_blocks(DeadTimeBesideConstants, "L*exp(-s/2)/(s + sqrt(2))", ""),
        of_blocks(DeadTimeBesideFunctions, "L*exp(-s/2)/(s + sqrt(K + 1))", ""),
        of_blocks(VaryingOrder, "L/(5*(s + 1))", "discretize = { method = 'zoh', delay = '13/10' }\n"),
    ]
}

/// The arguments of a row's command, about the names of [`Loop`].
fn arguments(command: &str, time: Time, file: &str) -> Vec<String> {
    let (region, bound) = match time {
        Time::Discrete => ("--radius=9/10", "radius"),
        Time::Continuous => ("--decay=1/100", "decay"),
    };
    let mut names = ["K", "L"].into_iter().cycle();
    let mut words = command.split(' ');
    let mut out: Vec<String> = words.by_ref().take(1).map(str::to_owned).collect();
    out.push("-".to_owned());
    if out[0] == "norm" {
        out.extend(["r", "y"].map(str::to_owned));
    }
    let mut third = false;
    for word in words {
        let word = match word {
            "REGION" => region.to_owned(),
            "BOUND" => bound.to_owned(),
            "FILE" => file.to_owned(),
            "INPUT" => "r".to_owned(),
            "OUTPUT" => "y".to_owned(),
            "NAME" if out[0] == "map" => format!("{}=0.1..2", names.next().expect("without end")),
            "NAME" => names.next().expect("without end").to_owned(),
            _ if third => "W=1..2:2".to_owned(),
            _ if word.contains("NAME") => word.replace("NAME", names.next().expect("without end")),
            _ => word.to_owned(),
        };
        third = word == "-z";
        out.push(word);
    }
    let further: &[&str] = match out[0].as_str() {
        "bode" | "nyquist" | "simulate" => &["--json"],
        "locus" => &["--range", "0.1..2", "--json"],
        "report" => &["-o", file],
        "map" if command.contains("boxes") => &["--undecided", "3/10"],
        _ => &[],
    };
    out.extend(further.iter().map(|&word| word.to_owned()));
    out
}

/// What came of a question: no refusal, or what was refused.
fn outcome(arguments: &[String], model: &Model) -> Result<String, Error> {
    let words = arguments.iter().map(String::as_str);
    let run = captured(words, model, &Budget::unlimited())?;
    match run.notes.iter().find(|note| note.starts_with("undecided")) {
        Some(note) => Ok(note.clone()),
        None => Ok(run.output),
    }
}

/// Whether a diagnostic may be a refusal: the texts between braces are in it, in their order.
fn is_of(found: &Diagnostic, refusal: &Refusal) -> bool {
    let mut rest = found.message.as_str();
    let mut parts = refusal.message.split(['{', '}']).step_by(2);
    refusal.code == found.code && parts.all(|part| rest.find(part).map(|at| rest = &rest[at + part.len()..]).is_some())
}

/// Whether every name in braces of a refusal was replaced.
fn is_filled(found: &Diagnostic) -> bool {
    ![Some(&found.message), found.help.as_ref()].into_iter().flatten().any(|text| text.contains(['{', '}']))
}

fn check(row: &jurist_engine::coverage::Row, of: &Loop, file: &str) -> Result<(), String> {
    let arguments = arguments(row.command, of.model.time(), file);
    let coverage = row.asked.over(of.ring);
    let what = format!("{} of {}: {arguments:?}", row.command, of.ring.name());
    let found = outcome(&arguments, &of.model);
    let is_boxes = |text: &str| text.contains("boxes");
    match (coverage, found) {
        (Coverage::Refused(refusal) | Coverage::InPart(_, refusal), Err(Error::Refused(found))) => {
            let first = &found.diagnostics()[0];
            match is_of(first, refusal) && is_filled(first) {
                true => Ok(()),
                false => Err(format!("{what}: the table says {refusal:?}, and it is {first:?}")),
            }
        }
        // A part of an analysis that is refused is said to be open.
        (Coverage::Refused(refusal), Ok(note)) if row.asked == Asked::Analyze && note.contains(refusal.message) => {
            Ok(())
        }
        (Coverage::ByBoxes(_), Ok(text)) if is_boxes(&text) => Ok(()),
        (Coverage::Answered(_), Ok(text)) if !text.starts_with("undecided") && !is_boxes(&text) => Ok(()),
        (Coverage::InPart(..), Ok(text)) if !text.starts_with("undecided") => Ok(()),
        (coverage, found) => Err(format!("{what}: the table says {}, and it is {found:?}", coverage.name())),
    }
}

#[test]
fn every_question_of_a_loop_over_each_ring_has_the_outcome_of_the_table() {
    let folder = std::env::temp_dir().join(format!("jurist-coverage-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let loops = loops();
    let wrong: Vec<Vec<String>> = parallel_map(rows(), |row| {
        let file = folder.join(format!("{:?}.html", row.asked));
        let of_time = |of: &&Loop| row.time.is_none_or(|time| time == of.model.time());
        let tried = loops.iter().enumerate().filter(|(i, _)| is_tried(i + row.asked as usize, 48)).map(|(_, of)| of);
        let asked = tried.filter(of_time).map(|of| check(row, of, file.to_str().expect("a path")));
        asked.filter_map(Result::err).collect::<Vec<_>>()
    });
    let wrong = wrong.concat();
    std::fs::remove_dir_all(Path::new(&folder)).expect("removed");
    assert!(wrong.is_empty(), "{} cells:\n{}", wrong.len(), wrong.join("\n"));
}

/// The closed loop between two signals was refused; it is a system with both parts of each signal.
#[test]
fn complex_loops_are_opened_and_their_refusals_have_no_names_in_braces() {
    let between = Cut::Between(Between::new("r", "y"));
    for of in complex_loops() {
        let unit = ["K", "L", "W"].map(|name| (name.to_owned(), jurist_algebra::number::Rational::ONE));
        let opened = of.model.opened(&between, &[], &unit, &Budget::unlimited()).unwrap();
        assert_eq!((opened.system.inputs, opened.system.outputs), (names("r"), names("y")));
        for words in [&["charpoly", "-", "--transfer", "r", "y"][..], &["jury", "-", "--param", "K"]] {
            let words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
            if let Err(Error::Refused(found)) = outcome(&words, &of.model) {
                assert!(found.diagnostics().iter().all(is_filled), "{words:?}: {found:?}");
            }
        }
    }
}

fn names(signal: &str) -> Vec<String> {
    [".re", ".im"].map(|part| format!("{signal}{part}")).into()
}

/// Loops with complex coefficients over each ring that they may have.
fn complex_loops() -> Vec<Loop> {
    use CoefficientRing::*;
    let zoh = "discretize = { method = 'zoh', T = '1/10' }\n";
    let frame = "discretize = { method = 'zoh', T = '1/10', frame = 'K' }\n";
    vec![
        of_blocks(Rational, "(3 + 4*j)/5/(z - L/2)", ""),
        of_blocks(Rational, "(3 + 4*j)/5/((s + L)*(s + 1)*(s + 2))", ""),
        of_blocks(Constants, "L/(s + 1 + j)", zoh),
        of_blocks(Functions, "L/(s + 1)", frame),
        of_blocks(DeadTime, "L*(3 + 4*j)/5*exp(-s/2)/(s + 1)", ""),
        of_blocks(DeadTimeBesideConstants, "L*exp(j/3)*exp(-s/2)/(s + 1)", ""),
    ]
}

#[test]
#[ignore = "long: CI runs it"]
fn every_question_of_a_complex_loop_is_answered_or_refused_as_the_table_says() {
    let folder = std::env::temp_dir().join(format!("jurist-complex-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let loops = complex_loops();
    let wrong: Vec<Vec<String>> = parallel_map(rows(), |row| {
        let file = folder.join(format!("{:?}.html", row.asked));
        let check = |of: &Loop| {
            let arguments = arguments(row.command, of.model.time(), file.to_str().expect("a path"));
            let found = outcome(&arguments, &of.model);
            let is_refused =
                matches!(&found, Err(Error::Refused(found)) if found.diagnostics()[0].code == Code::Complex);
            // What is refused of every loop over the ring may say so first.
            let is_never =
                matches!(row.asked.over(of.ring), Coverage::Refused(_)) && matches!(found, Err(Error::Refused(_)));
            let agrees = is_refused == row.asked.of_complex_loop().is_some() || is_never;
            (!agrees).then(|| format!("{} of {}: {found:?}", row.command, of.ring.name()))
        };
        loops.iter().filter(|of| row.time.is_none_or(|time| time == of.model.time())).filter_map(check).collect()
    });
    let wrong = wrong.concat();
    std::fs::remove_dir_all(Path::new(&folder)).expect("removed");
    assert!(wrong.is_empty(), "{} cells:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn the_ring_of_a_loop_is_seen() {
    for of in loops() {
        let problem = of.model.ask().free("K").problem().unwrap();
        assert_eq!(problem.coefficient_ring(&Budget::unlimited()).unwrap(), of.ring);
    }
}

#[test]
fn explain_says_how_a_question_of_a_loop_over_each_ring_is_decided() {
    for (i, of) in loops().into_iter().enumerate().filter(|(i, _)| is_tried(*i, 3)) {
        let asked = |further: &[&str]| {
            let arguments = ["intervals", "-", "--param", "K", "--domain", "K=1/10..1"].iter().chain(further).copied();
            captured(arguments, &of.model, &Budget::unlimited())
        };
        let coverage = Asked::Intervals.over(of.ring);
        let (Some(method), Ok(run)) = (coverage.method(), asked(&["--explain"])) else {
            assert!(coverage.method().is_none(), "{}", of.ring.name());
            continue;
        };
        let plain = asked(&[]).unwrap().output;
        let plan = run.output.strip_prefix(&plain).expect("the answer comes first");
        assert!(plan.starts_with("\nhow it is decided\n    question      intervals --param NAME\n"), "{plan}");
        assert!(plan.contains(&format!("    coefficients  {}: ", of.ring.name())), "{plan}");
        assert!(plan.contains(&format!("    method        {} ({})\n", method.name, method.place)), "{plan}");
        if !is_tried(i, 4) {
            continue;
        }
        let document: serde_json::Value =
            serde_json::from_str(&asked(&["--explain", "--json"]).unwrap().output).unwrap();
        assert_eq!(document["plan"]["ring"], of.ring.name());
        assert_eq!(document["plan"]["method"]["name"], method.name);
        assert!(asked(&["--json"]).unwrap().output.find("\"plan\"").is_none());
    }
}
