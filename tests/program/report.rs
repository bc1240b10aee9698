//! `jurist report`: one page about one's own loop, whose numbers are those of the program's other answers.

use crate::helpers::program::{json, jurist, jurist_with_input, refused};
use crate::helpers::thorough::tried;
use serde_json::Value;

/// Every part of the page.
const SECTIONS: [&str; 11] = [
    "model",
    "limits",
    "margins",
    "sensitivity",
    "tolerance",
    "locus",
    "bode",
    "response",
    "map",
    "certificates",
    "proved",
];

/// The page of a model file.
fn page(model: &str) -> String {
    let run = jurist(&["report", model, "-o", "-", "-q"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{model}");
    run.stdout
}

/// The part of a page with this name.
pub(super) fn section<'p>(html: &'p str, id: &str) -> &'p str {
    let begin = html.find(&format!("<section id=\"{id}\">")).unwrap_or_else(|| panic!("there is no {id}"));
    let length = html[begin..].find("</section>").expect("it ends");
    &html[begin..begin + length]
}

/// Text without marks, its powers of ten as the program writes them.
pub(super) fn plain(html: &str) -> String {
    let mut out = String::new();
    let text = html.replace("·10<sup>", "e").replace('−', "-");
    let mut inside = false;
    for c in text.chars() {
        match c {
            '<' => inside = true,
            '>' => inside = false,
            c if !inside => out.push(c),
            _ => {}
        }
    }
    out.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}

/// The rows of the tables with this caption in a part, cell by cell.
pub(super) fn rows(html: &str, caption: &str) -> Vec<Vec<String>> {
    let cell = |c: &str| plain(c).trim().to_owned();
    let table = |part: &str| -> Vec<Vec<String>> {
        let body = part.split("<tbody>").nth(1).and_then(|b| b.split("</tbody>").next()).expect("a body");
        let cells = |row: &str| row.split("</td>").filter(|c| c.contains("<td")).map(cell).collect::<Vec<_>>();
        body.split("</tr>").filter(|r| r.contains("<td")).map(cells).collect()
    };
    html.split(&format!("<caption>{caption}</caption>")).skip(1).flat_map(table).collect()
}

/// Complete, well formed, fetches nothing, no name twice.
pub(super) fn check_page(html: &str, what: &str) {
    for id in SECTIONS {
        let part = section(html, id);
        assert!(html.contains(&format!("href=\"#{id}\"")), "{what}: {id}");
        assert!(plain(part).split_whitespace().count() > 5, "{what}: {id} says nothing");
        assert!(!part.contains("NaN") && !part.contains("inf "), "{what}: {id}");
    }
    for tag in ["section", "table", "figure", "svg", "div", "details", "ul", "pre", "p", "b", "code", "h3", "tr", "td"]
    {
        let count = |text: &str| html.matches(text).count();
        let opened = count(&format!("<{tag} ")) + count(&format!("<{tag}>"));
        assert_eq!(opened, count(&format!("</{tag}>")), "{what}: {tag}");
    }
    // Names of XML vocabularies are no addresses, and a model file may name a schema.
    let bare = html.replace("http://www.w3.org/2000/svg", "").replace("http://www.w3.org/1999/xlink", "");
    for trace in ["src=", "<script", "<link", "<img", "<iframe", "@import", "url(http", "href=\"http"] {
        assert!(!bare.contains(trace), "{what}: {trace}");
    }
    assert!(html.contains("default-src 'none'") && html.contains("name=\"viewport\"") && html.contains("@media print"));
    assert!(html.contains("prefers-color-scheme:dark"));
    let mut names: Vec<&str> = html.split(" id=\"").skip(1).filter_map(|p| p.split('"').next()).collect();
    let referred: Vec<&str> = html.split("url(#").skip(1).filter_map(|p| p.split(')').next()).collect();
    assert!(referred.iter().all(|r| names.contains(r)), "{what}");
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count, "{what}: a name is given twice");
}

/// The ends of a stable set in a document, each once.
fn ends(set: &Value) -> Vec<&Value> {
    let mut ends: Vec<&Value> = Vec::new();
    let intervals = set["stable"].as_array().into_iter().flatten();
    for end in intervals.flat_map(|i| [&i["lower"], &i["upper"]]).filter(|end| !end.is_null()) {
        if ends.last().is_none_or(|last| last["enclosure"] != end["enclosure"]) {
            ends.push(end);
        }
    }
    ends
}

/// Every limit, cause and frequency of the page is that of `jurist analyze`, and none is missing.
fn check_limits(html: &str, model: &str) {
    // What is not decided for one parameter (status 3) is for another.
    let analysis = |digits: &str| -> Value {
        let run = jurist(&["analyze", model, "--json", "--digits", digits]);
        assert!([0, 3].contains(&run.status), "{model}: {}", run.stderr);
        serde_json::from_str(&run.stdout).unwrap()
    };
    let (long, short) = (analysis("12"), analysis("7"));
    let part = section(html, "limits");
    let verdict = long["verdict"]["verdict"].as_str();
    if let Some(verdict) = verdict {
        assert!(plain(part).contains(&format!("the loop is {verdict}")), "{model}: {verdict}");
    }
    let list = |document: &Value| document["parameters"].as_array().cloned().unwrap_or_default();
    let expected: Vec<[Value; 2]> = list(&long)
        .iter()
        .zip(&list(&short))
        .flat_map(|(a, b)| ends(a).into_iter().cloned().zip(ends(b).into_iter().cloned()).collect::<Vec<_>>())
        .map(|(a, b)| [a, b])
        .collect();
    let found = rows(part, "Limits");
    assert_eq!(found.len(), expected.len(), "{model}: {found:?}");
    for (row, [long, short]) in found.iter().zip(&expected) {
        let decimal = long["decimal"].as_str().expect("a decimal");
        assert_eq!(row[0].split(' ').next(), Some(decimal), "{model}");
        assert!(row[1].starts_with(long["cause"].as_str().expect("a cause")), "{model}: {row:?}");
        match &short["frequency_hz"] {
            Value::Null => assert!(!row[2].contains("Hz"), "{model}: {row:?}"),
            hertz => assert!(row[2].starts_with(&format!("{hertz} Hz")), "{model}: {row:?}, {hertz}"),
        }
        match &short["margin_db"] {
            Value::Null => assert!(!row[3].contains("dB"), "{model}: {row:?}"),
            db if row[3].contains("dB") => assert!(row[3].ends_with(&format!("({db} dB)")), "{model}: {row:?}, {db}"),
            _ => {}
        }
    }
}

/// The margins of the page are those of `jurist margins`; where that refuses, the page says why.
fn check_margins(html: &str, model: &str) {
    let part = plain(section(html, "margins"));
    let run = jurist(&["margins", model, "--json", "--digits", "7"]);
    if run.status > 1 {
        assert!(rows(section(html, "margins"), "Margins").is_empty(), "{model}");
        return;
    }
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    // An index stands below the line, without its underscore.
    assert!(part.contains(&document["at"].as_str().unwrap().replace('_', "")), "{model}");
    for place in
        [&document["phase"]["degrees"], &document["gain"]["upper"]["decimal"], &document["modulus"]["value"]["decimal"]]
    {
        if let Some(decimal) = place.as_str() {
            assert!(part.contains(decimal), "{model}: {decimal}");
        }
    }
}

#[test]
fn every_template_gives_a_complete_page_with_the_programs_own_numbers() {
    let folder = std::env::temp_dir().join(format!("jurist-report-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let list = jurist(&["new", "--list"]).stdout;
    let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() >= 8, "{names:?}");
    for name in tried(names, 2) {
        let file = folder.join(format!("{name}.toml"));
        let file = file.to_str().unwrap();
        assert_eq!(jurist(&["new", name, "-o", file]).status, 0);
        if ["two-mass", "lcl-filter", "held-plant", "cascaded-drive", "digital-power", "cascade-two-rates"]
            .contains(&name)
        {
            // A parameter inside of exponentials and a map of high order take long: what the budget ends is a sentence.
            let run = jurist(&["report", file, "-o", "-", "-q", "--timeout", "0"]);
            assert!([0, 3].contains(&run.status), "{name}: {}", run.stderr);
            check_page(&run.stdout, name);
            continue;
        }
        let html = page(file);
        check_page(&html, name);
        check_limits(&html, file);
        check_margins(&html, file);
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_example_gives_a_complete_page() {
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let name = path.to_str().unwrap();
            // Some are long: what the budget ends is a sentence of a page that is whole all the same.
            let run = jurist(&["report", name, "-o", "-", "-q", "--timeout", "0"]);
            assert!([0, 3].contains(&run.status), "{name}: {}", run.stderr);
            check_page(&run.stdout, name);
        }
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn limits_and_margins_are_those_of_the_other_commands() {
    for name in ["drive", "digital-pll", "buck-converter", "dead-time-pi"] {
        let file = format!("{}/examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let html = page(&file);
        check_limits(&html, &file);
        check_margins(&html, &file);
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn what_moves_a_limit_is_computed_again_exactly() {
    let html = page("examples/drive.toml");
    let moved =
        rows(section(&html, "sensitivity"), "Limits of <i>K</i><sub>pwm</sub> with one number changed by a tenth");
    let row = moved.iter().find(|r| r[0] == "L_a" || r[0] == "La").expect("the inductance moves it");
    assert!(row[1].starts_with("0.0414"), "{row:?}");
    let again = json(&[
        "intervals",
        "examples/drive.toml",
        "--param",
        "K_pwm",
        "--set",
        "L_a=0.0414",
        "--json",
        "--digits",
        "7",
    ]);
    let upper = again["stable"][0]["upper"]["decimal"].as_str().unwrap();
    assert_eq!(row[4], upper, "{row:?}");
    let base: f64 = moved[0][4].parse().unwrap();
    let change: f64 = row[5].parse().unwrap();
    assert!((upper.parse::<f64>().unwrap() / base - 1.0 - change / 100.0).abs() < 1e-4, "{row:?}");
}

#[test]
fn the_worst_corner_is_that_of_the_command_tolerance() {
    let html = page("examples/de-gaston-safonov.toml");
    let document = json(&["tolerance", "examples/de-gaston-safonov.toml", "--json", "--digits", "7"]);
    let part = section(&html, "tolerance");
    assert!(plain(part).contains(document["factor"]["decimal"].as_str().unwrap()));
    let found = rows(part, "The box of tolerances and its worst corner");
    let signs = document["worst"]["signs"].as_object().unwrap();
    assert_eq!(found.len(), signs.len());
    for (row, (name, sign)) in found.iter().zip(signs) {
        let word = match sign.as_str().unwrap() {
            "-" => "least",
            "+" => "greatest",
            _ => "inside",
        };
        assert_eq!((row[0].as_str(), row[3].as_str()), (name.as_str(), word));
    }
}

#[test]
fn certificates_are_accepted_and_their_command_lines_write_them() {
    let html = page("examples/digital-pll.toml");
    let part = section(&html, "certificates");
    let said = rows(part, "Certificates of this report&#39;s answers");
    let said = if said.is_empty() { rows(part, "Certificates of this report's answers") } else { said };
    assert!(said.len() > 1 && said.iter().all(|row| row[2] == "accepted"), "{said:?}");
    let text = plain(part);
    let line = text.lines().find(|l| l.starts_with("jurist intervals")).unwrap();
    let words: Vec<&str> = line.split(' ').collect();
    let written = jurist(&["intervals", words[2], "--param", words[4], "--certificate", "-", "-o", "/dev/null", "-q"]);
    let parameter = said.iter().find(|row| row[0].ends_with(&words[4].replace('_', ""))).unwrap_or(&said[1]);
    assert_eq!(parameter[1], format!("{} bytes", written.stdout.len()), "{}", written.stderr);
}

#[test]
#[ignore = "long: CI runs it"]
fn parts_that_a_loop_has_not_are_one_sentence_with_the_reason() {
    let html = page("examples/dead-time-pi.toml");
    let part = section(&html, "locus");
    assert!(!part.contains("<svg") && plain(part).contains("dead time"), "{}", plain(part));
    let part = section(&html, "response");
    assert!(part.contains("<svg") && plain(part).contains("floating point"), "{}", plain(part));
    let held = jurist(&["new", "held-plant"]).stdout;
    let html = jurist_with_input(&["report", "-", "-o", "-", "-q"], held.as_bytes()).stdout;
    assert!(plain(section(&html, "limits")).contains("roots are inside the unit circle"));
    assert!(plain(section(&html, "model")).contains("zero-order hold"));
    assert!(section(&html, "response").contains("<svg"));
    assert!(plain(section(&html, "proved")).contains("behind a zero-order hold"));
    // A rule in place of a hold is named as what it is.
    let html = page("examples/drive-blocks.toml");
    assert!(plain(section(&html, "proved")).contains("made discrete by the forward rule"));
}

#[test]
fn nothing_of_a_model_is_read_as_part_of_the_page() {
    let hostile = "</pre></section><script>alert(1)</script><img src=x onerror=alert(2)>&amp;";
    let text = format!(
        "title = \"{hostile}\"\ntime = 'discrete'\n[constants]\na = 0.5 # {hostile}\n[parameters]\n\
         K = {{ nominal = 0.1, unit = \"{hostile}\", description = \"{hostile}\" }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = \"{hostile}\"\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(z - a)'\n"
    );
    let run = jurist_with_input(&["report", "-", "-o", "-", "-q"], text.as_bytes());
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    check_page(&run.stdout.replace("src=", ""), "hostile");
    assert!(plain(&run.stdout).contains("<script>alert(1)</script>"), "it is shown as text");
}

#[test]
fn a_budget_ends_parts_and_not_the_page() {
    let run = jurist(&["report", "-o", "-", "--timeout", "0"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stderr.contains("undecided"), "{}", run.stderr);
    check_page(&run.stdout, "no time");
    assert!(plain(section(&run.stdout, "limits")).contains("the budget of the report ran out"));
}

#[test]
fn the_page_is_an_html_file_and_no_input() {
    refused(&["report", "-o", "report.pdf"], "E-output-format");
    refused(&["report", "examples/drive.toml", "-o", "examples/drive.toml"], "E-output-name");
    refused(&["report", "--set", "K_pmw=1", "-o", "-"], "E-unknown-parameter");
}

#[test]
fn values_that_are_set_are_those_of_the_page_and_of_its_command_lines() {
    let run = jurist(&["report", "-o", "-", "-q", "--set", "K_pwm=600"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let limits = plain(section(&run.stdout, "limits"));
    assert!(limits.contains("the loop is unstable"), "{limits}");
    assert!(
        plain(section(&run.stdout, "margins")).contains("only a stable loop has margins")
            || limits.contains("unstable")
    );
    assert!(plain(section(&run.stdout, "certificates")).contains("--set K_pwm=600"));
}

/// One integrator in a loop inside of another: which loop is meant has to be said.
pub(super) const CASCADE: &str = "time = 'continuous'\n[parameters]\nK = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'outer'\ninput = 'r - y'\noutput = 'v'\ngain = 'K'\n\
    [[block]]\nname = 'inner'\ninput = '10*(v - w)'\noutput = 'w'\ntransfer = '1/s'\n\
    [[block]]\nname = 'rest'\ninput = 'w'\noutput = 'y'\ntransfer = '1/s'\n";

#[test]
fn a_report_has_the_margins_of_the_loop_that_is_named_or_required() {
    let asked = |text: &str, options: &[&str]| {
        let run = jurist_with_input(&[&["report", "-", "-o", "-", "-q"], options].concat(), text.as_bytes());
        assert_eq!(run.status, 0, "{}", run.stderr);
        let (margins, bode) =
            (plain(section(&run.stdout, "margins")), section(&run.stdout, "bode").matches("<svg").count() == 2);
        (margins, bode)
    };
    let (margins, drawn) = asked(CASCADE, &[]);
    assert!(margins.contains("where it is cut") && !drawn, "{margins}");
    let required = format!("{CASCADE}[require]\nphase_margin = '45 deg'\nat = 'w'\n");
    for (text, options, at) in
        [(CASCADE, &["--at", "v"][..], "v"), (&required, &[], "w"), (&required, &["--at", "v"], "v")]
    {
        let (margins, drawn) = asked(text, options);
        assert!(margins.contains(&format!("cut at {at}:")) && drawn, "{margins}");
    }
    let wrong = jurist_with_input(&["report", "-", "-o", "-", "-q", "--at", "V"], CASCADE.as_bytes());
    assert!(plain(section(&wrong.stdout, "margins")).contains("'V'"), "{}", wrong.stderr);
}

/// A gain of one, at which the loop's modulus is one at the frequency 0.
#[test]
fn a_loop_with_dead_time_and_a_phase_margin_of_half_a_turn_is_reported_on() {
    let text = "time = 'continuous'\n[parameters]\nK = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*exp(-s)/(s+1)'\n";
    let run = jurist_with_input(&["report", "-", "-o", "-", "-q"], text.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let margins = plain(section(&run.stdout, "margins"));
    assert!(margins.contains("180") && margins.contains("2.261826"), "{margins}");
}

#[test]
#[ignore = "long: CI runs it"]
fn certificates_by_boxes_are_those_of_the_command() {
    let part = page("examples/dc-servo.toml");
    let part = section(&part, "certificates");
    let said = rows(part, "Certificates of this report&#39;s answers");
    let said = if said.is_empty() { rows(part, "Certificates of this report's answers") } else { said };
    let row = said.iter().find(|row| row[0] == "all limits of T").unwrap_or_else(|| panic!("{said:?}"));
    assert!(row[1].contains("by boxes") && row[2] == "accepted", "{row:?}");
}

/// What is said for all values is what the commands say; without ranges there is no such part.
#[test]
fn what_holds_for_all_values_is_that_of_the_commands() {
    let model = "time = 'continuous'\nparameters = { K = '1/4', c = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
        [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(c*s + 1)^2)'\n";
    let all = ["--for-all", "c=1/2..1"];
    let answer = |line: &[&str]| jurist_with_input(line, model.as_bytes()).stdout;
    assert!(!answer(&["report", "-", "-o", "-", "-q"]).contains("id=\"for-all\""));
    let html = answer(&[&["report", "-", "-o", "-", "-q"][..], &all].concat());
    let part = plain(section(&html, "for-all"));
    let below = |line: &[&str]| {
        let text = answer(&[line, &all].concat());
        text.split_once('\n').expect("a title").1.trim_end().to_owned()
    };
    let margins = below(&["margins", "-", "--digits", "7"]);
    assert!(part.contains(&margins), "{margins}\n{part}");
    let gains = below(&["intervals", "-", "--param", "K", "--digits", "12"]);
    assert!(part.contains(&gains), "{gains}\n{part}");
    refused(&["report", "examples/dc-servo.toml", "--for-all", "Q=1..2", "-o", "-"], "E-unknown-parameter");
}
