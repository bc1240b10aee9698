//! `jurist map -z`: the command, its text, document, page and pictures.

use crate::helpers::model::example;
use crate::helpers::number::number;
use crate::helpers::program::{command, json, jurist, jurist_with_input, refused};
use crate::helpers::schema::fits;
use jurist::{Ask, Document, Text};
use jurist_algebra::limits::Budget;
use jurist_draw::figures::map::{MapContents, WindowRequest, common_windows, small_multiples, trace_map};
use jurist_draw::page::body_page;
use jurist_engine::answer::{Answer, Body, SliceValues};
use serde_json::Value;

const PID: [&str; 8] = ["map", "examples/pid-body.toml", "-x", "K_i", "-y", "K_d", "-z", "K_p=-1..2:13"];

/// What `map` says of curves, strips and regions.
fn decomposition(document: &Value) -> [&Value; 4] {
    ["curves", "strips", "regions", "never_stable"].map(|key| &document[key])
}

#[test]
fn each_slice_is_the_map_with_its_value_set() {
    let model = "time = 'discrete'\n[constants]\nc = 1\n[parameters]\na = {}\nb = { min = -1 }\n\
        [loop]\ncharacteristic = '(c - 1/2)*z^3 + a*z^2 + b*z + c/4'\n";
    let axes = |third: &'static str, model: &'static str, x: &'static str, y: &'static str| [model, x, y, third];
    // A parameter, a quantity with a unit, and a constant, which counts in the degree only where it is free.
    for [file, x, y, third] in [
        axes("K_p=0..1:3", "examples/pid-body.toml", "K_i", "K_d"),
        axes("K_d=-1/2..1/2:2", "examples/pid-body.toml", "K_p", "K_i"),
        axes("T=1e-4..3e-4:2", "examples/drive.toml", "K_pi", "K_pwm"),
        axes("c=0..1:3", "-", "a", "b"),
    ] {
        let ask = |more: &[&str]| -> Value {
            let run = jurist_with_input(&[&["map", file, "-x", x, "-y", y, "--json"], more].concat(), model.as_bytes());
            assert_eq!(run.status, 0, "{}", run.stderr);
            serde_json::from_str(&run.stdout).unwrap()
        };
        let slices = ask(&["-z", third]);
        let name = third.split('=').next().unwrap();
        for slice in slices["slices"].as_array().unwrap() {
            let set = format!("{name}={}", slice["at"].as_str().unwrap());
            let map = ask(&["--set", &set]);
            assert_eq!(decomposition(slice), decomposition(&map), "{file} {set}");
        }
    }
}

#[test]
fn exchanged_axes_give_the_same_body() {
    let of =
        |x: &str, y: &str| json(&["map", "examples/pid-body.toml", "-x", x, "-y", y, "-z", "K_p=-1..2:5", "--json"]);
    let (one, other) = (of("K_i", "K_d"), of("K_d", "K_i"));
    let places = |document: &Value, axis: &str| {
        let end = |side: &str| document["extremes"][axis][side]["end"]["exact"].clone();
        [end("lower"), end("upper"), document["extremes"][axis]["upper"]["slices"].clone()]
    };
    assert_eq!(places(&one, "x"), places(&other, "y"));
    assert_eq!(places(&one, "y"), places(&other, "x"));
    assert_eq!(one["stretches"], other["stretches"]);
    for (a, b) in one["slices"].as_array().unwrap().iter().zip(other["slices"].as_array().unwrap()) {
        assert_eq!(a["regions"].as_array().unwrap().len(), b["regions"].as_array().unwrap().len());
    }
}

#[test]
fn slices_are_among_twice_as_many() {
    let of = |count: &str| {
        let third = format!("K_p=-1..2:{count}");
        json(&["map", "examples/pid-body.toml", "-x", "K_i", "-y", "K_d", "-z", &third, "--json"])["slices"].clone()
    };
    let (few, many) = (of("4"), of("7"));
    let (few, many) = (few.as_array().unwrap(), many.as_array().unwrap());
    assert_eq!((few.len(), many.len()), (4, 7));
    for (k, slice) in few.iter().enumerate() {
        assert_eq!(slice, &many[2 * k]);
    }
}

#[test]
fn the_text_tells_slices_extremes_and_ends() {
    let run = jurist(&PID);
    assert_eq!(run.status, 0, "{}", run.stderr);
    insta::assert_snapshot!(run.stdout);
    let one = jurist(&[&PID[..], &["--threads", "1"]].concat());
    assert_eq!(one.stdout, run.stdout);
}

#[test]
fn wrong_slices_are_refused_where_they_stand() {
    let ask = |z: &str, more: &[&str], code: &str| {
        let run =
            refused(&[&["map", "examples/pid-body.toml", "-x", "K_i", "-y", "K_d", "-z", z], more].concat(), code);
        run.stderr
    };
    for (z, code, help) in [
        ("K_i=0..1:3", "E-usage", "three different parameters"),
        ("K_q=0..1:3", "E-unknown-parameter", "K_p"),
        ("K_p=0..1", "E-option-value", "for 11 slices"),
        ("K_p=0..1:1", "E-option-value", "it is 2 to 100"),
        ("K_p=0..1:1000", "E-option-value", "it is 2 to 100"),
        ("K_p=1..0:3", "E-option-value", "below the upper end"),
        ("K_p=0..:3", "E-option-value", "for 11 slices"),
        ("K_p=0..1x:3", "E-number", ""),
    ] {
        let said = ask(z, &[], code);
        assert!(said.contains('^') && said.contains(help), "{z}: {said}");
    }
    let outside = ask("K_p=0..1:3", &["--domain", "K_p=0.."], "E-value");
    assert!(
        outside.contains("K_p = 0 is outside") && outside.contains('^') && outside.contains("--domain K_p=.."),
        "{outside}"
    );
    let same =
        refused(&["map", "examples/pid-body.toml", "-x", "K_i", "-y", "K_i", "-z", "K_p=0..1:3"], "E-usage").stderr;
    assert!(same.contains("'K_i' is asked for") && same.contains("-y K_i") && same.contains("^^^"), "{same}");
    ask("K_p=0..1:3", &["--set", "K_p=1"], "E-kept-and-set");
    ask("K_p=0..1:3", &["--method", "boxes"], "E-usage");
    ask("K_p=0..1:3", &["--phase-margin", "45 deg"], "E-require");
    ask("K_p=0..1:3", &["-o", "body.gif"], "E-output-format");
    // A sample time inside of exponentials.
    let held =
        refused(&["map", "examples/dc-servo.toml", "-x", "K", "-y", "T_m", "-z", "T=0.01..0.02:2"], "E-function");
    let help = "map -x K=LO..HI -y T_m=LO..HI --set T=1/100";
    assert!(held.stderr.contains(help) && held.stderr.contains("^^^"), "{}", held.stderr);
}

#[test]
fn slices_that_were_not_reached_are_told() {
    let run = jurist(&[&PID[..], &["--timeout", "0"]].concat());
    assert_eq!(run.status, 3);
    assert_eq!(run.stdout.matches("undecided, the budget ran out: time (0 s)").count(), 14, "{}", run.stdout);
    assert!(run.stderr.contains("reached: 0 of 13 slices"), "{}", run.stderr);
    let file = std::env::temp_dir().join(format!("jurist-body-none-{}.svg", std::process::id()));
    let picture = command(&PID).args(["--timeout", "0", "-o"]).arg(&file).output().unwrap();
    assert_eq!(picture.status.code(), Some(3));
    assert!(!file.exists(), "there is nothing to draw");
}

/// With more and more work on one thread, until some slices are decided, one with stable points among them, and others are not.
fn partly_decided() -> Answer<Body> {
    let model = example("pid-body");
    let values = SliceValues::evenly("K_p", &number("-1"), &number("2"), 13).unwrap();
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut work = 100;
    loop {
        let question = model.ask().free("K_i").free("K_d");
        let budget = Budget::with_work(work);
        let answer = alone.install(|| question.body(&values, &number("1/10"), 8, &budget)).unwrap();
        let open = answer.value().open_slices().count();
        assert!(open > 0, "no budget ends between two slices");
        if answer.value().slices.iter().any(|slice| slice.has_stable_points() == Some(true)) {
            return answer;
        }
        work += work / 8;
    }
}

#[test]
fn a_slice_that_is_open_stands_in_text_page_and_picture() {
    let answer = partly_decided();
    let (budget, open) = (Budget::unlimited(), answer.value().open_slices().count());
    assert_eq!(answer.text(8).matches("undecided, the budget ran out: work").count(), open, "{}", answer.text(8));
    assert!(answer.text(8).contains("over the slices that are decided"));
    let document = serde_json::to_value(answer.json(8)).unwrap();
    assert!(fits(&document).is_ok() && document["undecided"]["budget"].as_str().unwrap().contains("work"));
    let maps: Vec<_> = answer.value().slices.iter().map(|slice| slice.map.as_ref().ok()).collect();
    let known: Vec<_> = maps.iter().copied().flatten().collect();
    let windows = common_windows(&known, &[], &[WindowRequest::default(), WindowRequest::default()]);
    let trace = |map| trace_map(map, windows.clone(), &budget).unwrap();
    let traces: Vec<_> = maps.iter().map(|map| map.map(trace)).collect();
    let of = |(map, trace)| MapContents::new(map, trace, Vec::new(), &budget).unwrap();
    let contents: Vec<_> = maps.iter().zip(&traces).map(|(map, trace)| map.zip(trace.as_ref()).map(of)).collect();
    let svg = small_multiples(&answer, &contents).svg();
    assert_eq!(svg.matches("not decided").count(), open);
    let page = body_page(&answer, &contents, [(860.0, 600.0), (400.0, 470.0)], 8, &budget).unwrap();
    assert_eq!(page.matches("is not decided: the budget ran out").count(), open);
    let from = page.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let data: Value = serde_json::from_str(&page[from..from + page[from..].find("</script>").unwrap()]).unwrap();
    let slices = data["slices"].as_array().unwrap();
    assert_eq!(slices.iter().filter(|slice| slice.is_null()).count(), open);
    assert!(!slices[data["first"].as_u64().unwrap() as usize].is_null());
}

/// Draws to a file of a fresh name and gives its text.
fn drawn(name: &str, arguments: &[&str], model: &str) -> String {
    let folder = std::env::temp_dir();
    let place = |what: &str| folder.join(format!("jurist-body-{}-{what}", std::process::id()));
    let (input, output) = (place(&format!("{name}.toml")), place(name));
    std::fs::write(&input, model).unwrap();
    let run = command(&["map"]).arg(&input).args(arguments).arg("-o").arg(&output).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = String::from_utf8(std::fs::read(&output).unwrap()).unwrap();
    std::fs::remove_file(&input).unwrap();
    std::fs::remove_file(&output).unwrap();
    text
}

/// The triangle of `z^2 + a z + b` where `|c| < 1`, with a title and a unit that would be HTML.
const HOSTILE: &str = "title = '</script><script>alert(1)</script><b>'\ntime = 'discrete'\n[parameters]\na = {}\nb = {}\n\
    c = { nominal = 0, unit = '<i>' }\n[loop]\ncharacteristic = '(z^2 + a*z + b)*(z - c)'\n";

#[test]
fn the_page_has_every_slice_and_needs_nothing_from_outside() {
    let page = drawn("page.html", &["-x", "a", "-y", "b", "-z", "c=-2..2:5"], HOSTILE);
    let from = page.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let to = from + page[from..].find("</script>").unwrap();
    let data: Value = serde_json::from_str(&page[from..to]).unwrap();
    assert_eq!((data["slices"].as_array().unwrap().len(), &data["first"], &data["name"]), (5, &2.into(), &"c".into()));
    assert_eq!(data["values"][0], "-2");
    assert!(!page.contains("alert(1)</script>") && !page.contains("<b>") && !page.contains("<i>"));
    assert_eq!(page.matches("<div class=\"slice\"").count(), 5);
    assert_eq!(page.matches("<div class=\"slice\" hidden>").count(), 4);
    assert!(page.contains("type=\"range\" id=\"slice\" min=\"0\" max=\"4\"") && page.contains("<table id=\"slices\">"));
    assert!(page.contains("stable points on the slice at c = 0") && page.contains("default-src 'none'"));
    let other = page.replace("http://www.w3.org/2000/svg", "");
    assert!(
        !other.contains("http:") && !other.contains("https:") && !other.contains("src=") && !other.contains("url(")
    );
}

#[test]
fn small_multiples_share_their_axes() {
    let svg = drawn("slices.svg", &["-x", "a", "-y", "b", "-z", "c=-2..2:5"], HOSTILE);
    for k in ["2", "1", "0"] {
        assert!(svg.contains(&format!("= {k}")), "{k}");
    }
    let labels = |text: &str| svg.matches(&format!(">{text}<")).count();
    assert_eq!((labels("0"), labels("unstable"), labels("stable (certified)")), (10, 1, 1));
    assert!(!svg.contains("NaN") && !svg.contains("<b>"));
}
