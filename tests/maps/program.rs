//! The map of two parameters of the built-in drive, against answers in one parameter and root counts.

use crate::helpers::model::{example, keeping};
use crate::helpers::number::number;
use crate::helpers::plane::{algebraic, cell_agrees};
use crate::helpers::program::{command, json, jurist, jurist_with_input, refused};
use crate::helpers::thorough::{count, is_thorough, is_tried};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::model::Model;
use jurist_engine::stability::RealInterval;
use jurist_engine::stability::plane::StabilityMap;
use proptest::prelude::*;

const TIP: &str = "0.0620651373";

fn drive(x: &str, y: &str) -> Answer<Map> {
    keeping(&Model::drive(), &[x, y]).map(10, &Budget::unlimited()).unwrap()
}

fn decided(answer: &Answer<Map>) -> &StabilityMap {
    &answer.value().decomposition
}

#[test]
fn the_drive_has_one_region_with_a_tip() {
    let answer = json(&["map", "-x", "T", "-y", "K_pwm", "--json", "--digits", "20"]);
    assert_eq!(answer["schema"], "jurist/map/1");
    assert_eq!((&answer["x"], &answer["y"]), (&"T".into(), &"K_pwm".into()));
    let regions = answer["regions"].as_array().unwrap();
    assert_eq!(regions.len(), 1);
    assert_eq!(regions[0]["x"]["lower"]["decimal"], "0");
    let tip = regions[0]["x"]["upper"]["decimal"].as_str().unwrap();
    assert!(tip.starts_with(TIP), "{tip}");
    for strip in answer["strips"].as_array().unwrap() {
        let cells = strip["cells"].as_array().unwrap();
        assert!(cells[0]["lower"].is_null() && cells[cells.len() - 1]["upper"].is_null());
        for pair in cells.windows(2) {
            assert_eq!(pair[0]["upper"], pair[1]["lower"]);
        }
        for cell in cells {
            let outside = cell["outside"].as_u64().unwrap();
            assert_eq!(cell["verdict"] == "stable", outside == 0);
        }
    }
    let text = jurist(&["map", "-x", "T", "-y", "K_pwm"]);
    assert_eq!(text.status, 0, "{}", text.stderr);
    assert!(text.stdout.contains("1 region") && text.stdout.contains(TIP), "{}", text.stdout);
}

#[test]
fn slices_are_the_stable_sets_of_one_parameter() {
    let budget = Budget::unlimited();
    for (x, y, at) in [("T", "K_pwm", "1e-4"), ("K_pwm", "T", "110")] {
        let answer = drive(x, y);
        let slice = decided(&answer).slice(&number(at), &answer.problem().axes()[1].domain, &budget).unwrap().unwrap();
        let one = Model::drive().ask().free(y).stable_set(&budget).unwrap();
        assert!(algebraic(&slice).same_as(&one.value().to_interval_set().unwrap()), "{y} at {x} = {at}");
    }
}

/// A positive rational number spread over decades.
fn over_decades(from: i64, to: i64) -> impl Strategy<Value = Rational> {
    (1i64..10_000, from..to)
        .prop_map(|(m, e)| Rational::from(m) / Rational::from(1000) * Rational::from(10).pow(e).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(2, 12) as u32))]

    #[test]
    fn every_point_of_the_drive_has_the_root_count_of_its_cell(
        points in prop::collection::vec((over_decades(-7, 1), over_decades(-4, 4)), 8),
    ) {
        let (answer, swapped) = (drive("T", "K_pwm"), drive("K_pwm", "T"));
        let (one, other) = (decided(&answer), decided(&swapped));
        let problem = answer.problem();
        let p = problem.plane(&Budget::unlimited()).unwrap().unwrap();
        let domain = problem.axes().map(|axis| axis.domain.clone());
        for (x, y) in &points {
            prop_assert_ne!(cell_agrees(one, p, x, y, &domain, problem.shape()), Some(false));
            let place = one.locate(x, y, &domain[1], &Budget::unlimited()).unwrap();
            let there = other.locate(y, x, &domain[0], &Budget::unlimited()).unwrap();
            if let (Some((s, c)), Some((t, d))) = (place, there) {
                let (here, there) = (&one.strips[s].cells[c], &other.strips[t].cells[d]);
                prop_assert_eq!((here.stable, here.outside), (there.stable, there.outside));
            }
        }
    }

    #[test]
    fn slices_of_the_drive_are_what_intervals_says(x in over_decades(-6, 0), y in over_decades(-3, 4)) {
        let (answer, budget) = (drive("T", "K_pwm"), Budget::unlimited());
        for (fixed, at, name, other) in [(0, &x, "T", "K_pwm"), (1, &y, "K_pwm", "T")] {
            let one = Model::drive().ask().set(name, at.clone()).free(other).stable_set(&budget).unwrap();
            let expected = one.value().to_interval_set().unwrap();
            let slice = answer.slice(fixed, at, &budget).unwrap();
            prop_assert!(slice.value().to_interval_set().unwrap().same_as(&expected));
            if fixed == 0 && let Some(cut) = decided(&answer).slice(at, &answer.problem().axes()[1].domain, &budget).unwrap() {
                prop_assert!(algebraic(&cut).same_as(&expected));
            }
        }
    }
}

#[test]
fn either_order_gives_the_same_extents() {
    let (answer, swapped) = (drive("T", "K_pwm"), drive("K_pwm", "T"));
    let (one, other) = (decided(&answer), decided(&swapped));
    assert_eq!(one.regions.len(), other.regions.len());
    for (a, b) in one.regions.iter().zip(&other.regions) {
        for (one, other) in [(&a.x, &b.y), (&a.y, &b.x)] {
            assert!(algebraic(std::slice::from_ref(one)).same_as(&algebraic(std::slice::from_ref(other))));
        }
    }
}

#[test]
fn the_ends_say_what_limits_the_region() {
    let answer = json(&["map", "-x", "T", "-y", "K_pwm", "--json"]);
    let region = &answer["regions"][0];
    assert_eq!(region["x"]["lower"]["cause"], "z=1+domain");
    let tip = &region["x"]["upper"];
    assert_eq!(tip["cause"], "complex pair");
    assert_eq!(tip["at"][0]["decimal"], "0.471281705101");
    // Two pairs meet at the tip: in floating point at 1.15057615 and 3.22070744 Hz; the lower one is told.
    assert_eq!(tip["frequency_hz"].as_f64().unwrap(), 1.15057615011);
    let enclosure = tip["frequency_enclosure"].as_array().unwrap();
    let (lo, hi) = (number(enclosure[0].as_str().unwrap()), number(enclosure[1].as_str().unwrap()));
    assert!(lo < number("1.150576150115") && number("1.150576150105") < hi && &hi - &lo < number("1e-12"));
    assert!(region["y"]["upper"].is_null());
    assert_eq!(answer["strips"][0]["x"]["lower"]["cause"], "z=1+complex pair+domain");
    assert_eq!(answer["strips"][0]["x"]["upper"]["cause"], "critical point");
    assert_eq!(answer["never_stable"], false);
    assert_eq!(answer["nominal"]["x"], "1/10000");
}

#[test]
fn constants_become_parameters_in_every_form_of_a_model() {
    // The matrix form and the block form of the drive are the same loop up to cancellation.
    let places = |model: &[&str]| {
        let mut arguments = vec!["map"];
        arguments.extend(model);
        arguments.extend(["-x", "R_a", "-y", "L_a", "--domain", "L_a=0..", "--json"]);
        let answer = json(&arguments);
        let region = &answer["regions"][0];
        ["x", "y"].map(|k| ["lower", "upper"].map(|e| region[k][e]["decimal"].clone()))
    };
    assert_eq!(places(&[]), places(&["examples/drive-blocks.toml"]));
    // A constant that others are made of.
    let model = b"time = 'discrete'\n[constants]\na = 2\nb = 'a/4'\n[parameters]\nk = { nominal = 1 }\n\
        [loop]\nmatrix = [['b*k', 0], [0, 'a - 2']]\n";
    let run = jurist_with_input(&["map", "-", "-x", "a", "-y", "k", "--json"], model);
    let answer: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    // |a k| < 4 and 1 < a < 3.
    assert_eq!(answer["regions"].as_array().unwrap().len(), 1);
    assert_eq!(
        (&answer["regions"][0]["x"]["lower"]["exact"], &answer["regions"][0]["x"]["upper"]["exact"]),
        (&"1".into(), &"3".into())
    );
    assert_eq!(answer["regions"][0]["y"]["upper"]["exact"], "4");
    let run = jurist_with_input(&["map", "-", "-x", "b", "-y", "k"], model);
    assert!(run.status == 2 && run.stderr.contains("E-not-a-number"), "{}", run.stderr);
}

#[test]
fn undecided_and_never_stable_documents_say_what_was_asked() {
    let run = jurist(&["map", "-x", "T", "-y", "K_pwm", "--json", "--timeout", "0"]);
    assert_eq!(run.status, 3);
    let answer: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((&answer["x"], &answer["y"], &answer["schema"]), (&"T".into(), &"K_pwm".into(), &"jurist/map/1".into()));
    assert_eq!(answer["domain"]["x"]["lower"], "0");
    assert!(answer["title"].as_str().unwrap().starts_with("PWM DC motor drive") && answer["regions"].is_null());
    assert!(answer["undecided"]["budget"].as_str().unwrap().contains("time"));
    let model = |characteristic: &str| {
        format!("time = 'discrete'\n[parameters]\na = {{}}\nb = {{}}\n[loop]\ncharacteristic = '{characteristic}'\n")
    };
    let run = jurist_with_input(&["map", "-", "-x", "a", "-y", "b", "--json"], model("(z-1)*(z-a*b)").as_bytes());
    let answer: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((&answer["never_stable"], &answer["never_stable_cause"]), (&true.into(), &"z=1".into()));
    assert_eq!((run.status, answer["regions"].as_array().unwrap().len()), (0, 0));
    let run = jurist_with_input(&["map", "-", "-x", "a", "-y", "b"], model("(z-1)*(z-a*b)").as_bytes());
    assert!(run.stdout.contains("stable nowhere: a root stays at z = 1"), "{}", run.stdout);
}

#[test]
fn wrong_questions_are_refused() {
    refused(&["map", "-x", "T", "-y", "T"], "E-usage");
    refused(&["map", "-x", "T", "-y", "nothing"], "E-unknown-parameter");
    refused(&["map", "-x", "T", "-y", "K_pwm", "--set", "T=1"], "E-kept-and-set");
    for (window, code) in [
        ("T=1", "E-option-value"),
        ("T=2..1", "E-option-value"),
        ("T=1..1", "E-option-value"),
        ("=1..2", "E-option-value"),
        ("T=a..2", "E-number"),
        ("T=1..2x", "E-number"),
        ("T=inf..2", "E-number"),
        ("t=1..2", "E-unknown-parameter"),
    ] {
        let run = refused(&["map", "-x", window, "-y", "K_pwm"], code);
        assert!(run.stderr.contains('^'), "{window}: {}", run.stderr);
    }
    refused(&["map", "-x", "T", "-y", "K_pwm", "-o", "map.gif"], "E-output-format");
    refused(&["map", "-x", "T", "-y", "K_pwm", "--log-x", "--linear-x"], "E-usage");
}

/// Draws to a file of a fresh name and gives its bytes.
fn drawn(name: &str, arguments: &[&str]) -> Vec<u8> {
    let file = std::env::temp_dir().join(format!("jurist-map-{}-{name}", std::process::id()));
    let run = command(&["map"]).args(arguments).arg("-o").arg(&file).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let bytes = std::fs::read(&file).unwrap();
    std::fs::remove_file(&file).unwrap();
    bytes
}

const DRIVE: [&str; 4] = ["-x", "T", "-y", "K_pwm"];

#[test]
fn pictures_have_the_same_bytes_every_time() {
    let svg = String::from_utf8(drawn("a.svg", &DRIVE)).unwrap();
    assert_eq!(svg, String::from_utf8(drawn("b.svg", &DRIVE)).unwrap());
    for words in ["complex pair on the circle", "= 550.94 V, 1664 Hz", "= 38.101 mV, 0.506 Hz", "unstable", "333 Hz"] {
        assert!(svg.contains(words), "{words}");
    }
    assert!(svg.contains("T = 62.065 ms, 1.15 Hz") && svg.contains("published limits") && !svg.contains("NaN"));
    let one_thread = command(&["map", "-o", "-"]).args(DRIVE).env("RAYON_NUM_THREADS", "1").output().unwrap();
    assert!(one_thread.status.success());
    if is_thorough() {
        assert_eq!(drawn("a.png", &DRIVE)[..8], *b"\x89PNG\r\n\x1a\n");
    }
}

#[test]
fn a_small_picture_looks_as_it_did() {
    let model = std::env::temp_dir().join(format!("jurist-map-{}.toml", std::process::id()));
    let text = "time = 'discrete'\n[parameters]\na = { nominal = 0 }\nb = { nominal = 0 }\n\
        [loop]\ncharacteristic = 'z^2 + a*z + b'\n";
    std::fs::write(&model, text).unwrap();
    let svg = drawn("c.svg", &[model.to_str().unwrap(), "-x", "a", "-y", "b"]);
    std::fs::remove_file(&model).unwrap();
    // The curves are followed elsewhere; here it is axes, marks and labels that are looked at.
    let svg = String::from_utf8(svg).unwrap().replace("><", ">\n<");
    let looked_at = svg.lines().filter(|l| !l.starts_with("<path")).map(|l| format!("{l}\n"));
    insta::assert_snapshot!(looked_at.collect::<String>());
}

#[test]
fn the_page_needs_nothing_from_outside() {
    let page = String::from_utf8(drawn("a.html", &DRIVE)).unwrap();
    let from = page.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let to = from + page[from..].find("</script>").unwrap();
    let data: serde_json::Value = serde_json::from_str(&page[from..to]).unwrap();
    assert_eq!(data["degree"], 6);
    assert_eq!(data["strips"].as_array().unwrap().len(), decided(&drive("T", "K_pwm")).strips.len());
    let other = page.replace("http://www.w3.org/2000/svg", "");
    assert!(
        !other.contains("http:") && !other.contains("https:") && !other.contains("src=") && !other.contains("url(")
    );
    assert!(page.contains("default-src 'none'") && page.contains("drawn in floating point"));
}

#[test]
fn a_wall_between_strips_has_its_own_cells() {
    // T = 1/25 is a critical value of the drive's map; there and beside the exact counts decide.
    let (answer, budget) = (drive("T", "K_pwm"), Budget::unlimited());
    let wall = number("1/25");
    assert!(decided(&answer).slice(&wall, &answer.problem().axes()[1].domain, &budget).unwrap().is_none());
    let cells = answer.fibre(&wall, &budget).unwrap().unwrap();
    assert_eq!(cells, [(false, 2), (true, 0), (false, 2)]);
    let slice = answer.slice(0, &wall, &budget).unwrap();
    assert_eq!(slice.value().intervals().len(), 1);
    // Off the walls a line has the cells of its strip.
    let strip = decided(&answer).strips.iter().find(|s| s.x.contains(&number("1/3"))).unwrap();
    let cells = answer.fibre(&number("1/3"), &budget).unwrap().unwrap();
    assert_eq!(cells, strip.cells.iter().map(|c| (c.stable, c.outside)).collect::<Vec<_>>());
}

#[test]
#[ignore = "long: CI runs it"]
fn a_smaller_region_names_its_own_boundary() {
    // |z| < 1/2 for z^2 + a z + b: |b| < 1/4 and |a| < 1/2 + 2 b, with real roots at 1/2 and -1/2.
    let model = b"time = 'discrete'\n[parameters]\na = {}\nb = {}\n[loop]\ncharacteristic = 'z^2 + a*z + b'\n";
    let ask = |more: &[&str]| {
        let mut arguments = vec!["map", "-", "-x", "a", "-y", "b", "--radius", "1/2"];
        arguments.extend(more);
        jurist_with_input(&arguments, model).stdout
    };
    let text = ask(&[]);
    assert!(text.contains("all |z| < 0.5 in 1 region") && text.contains("-1 < a < 1"), "{text}");
    assert!(text.contains("z=0.5") && text.contains("complex pair on |z|=0.5") && !text.contains("z=1"), "{text}");
    let answer: serde_json::Value = serde_json::from_str(&ask(&["--json"])).unwrap();
    let least = &answer["regions"][0]["x"]["lower"];
    assert_eq!((&least["exact"], &least["cause"]), (&"-1".into(), &"z=1+complex pair".into()));
    assert_eq!(least["boundary"], "z=0.5+complex pair on |z|=0.5");
    let svg = drawn("r.svg", &["-x", "T", "-y", "K_pwm", "--radius", "0.9999"]);
    let svg = String::from_utf8(svg).unwrap();
    assert!(svg.contains("complex pair on |z| = 0.9999") && svg.contains("Region of all |z| &lt; 0.9999"));
    assert!(!svg.contains("published limits"));
}

#[test]
fn windows_are_those_asked_for() {
    let svg = |window: &str, more: &[&str]| {
        let mut arguments = vec!["-x", window, "-y", "K_pwm=0..5"];
        arguments.extend(more);
        String::from_utf8(drawn("w.svg", &arguments)).unwrap()
    };
    // An end at or below zero has no logarithm: the axis stays linear.
    let linear = svg("T=0..0.07", &["--log-x"]);
    assert!(!is_thorough() || linear == svg("T=0..0.07", &[]));
    assert!(linear.contains(">70<") && linear.contains(">T (ms)<"));
    assert!(linear.contains("root at z = 1"));
    let logarithmic = svg("T=1e-4..0.1", &["--log-x"]);
    assert!(logarithmic.contains(">100 µs<") && logarithmic.contains(">1 ms<"));
    assert!(!is_thorough() || svg("T=..inf", &[]).contains("T ("));
}

#[test]
fn unstable_points_and_points_outside_the_domain_are_told_apart() {
    let svg = |window: &str| String::from_utf8(drawn("d.svg", &["-x", window, "-y", "K_pwm=0.01..600"])).unwrap();
    let (inside, beyond) = (svg("T=1e-5..0.07"), svg("T=-0.02..0.07"));
    assert!(inside.contains(">unstable<") && !inside.contains("outside the domain"));
    assert!(beyond.contains(">unstable<") && beyond.contains(">outside the domain<"));
    // Each label stands once.
    for svg in [inside, beyond] {
        let mut labels: Vec<&str> = svg.split("</text>").filter_map(|t| t.rsplit('>').next()).collect();
        labels.retain(|l| l.contains("Hz") && !l.is_empty());
        let count = labels.len();
        labels.sort_unstable();
        labels.dedup();
        assert!(count > 2 && labels.len() == count, "{labels:?}");
    }
}

#[test]
fn drawn_points_lie_on_the_curves() {
    use jurist_draw::figures::map::{WindowRequest, choose_windows, trace_map};
    let budget = Budget::unlimited();
    let answer = drive("T", "K_pwm");
    assert!(answer.value().limits.is_ok());
    let windows = choose_windows(&answer, &[], &[WindowRequest::default(), WindowRequest::default()]);
    let trace = trace_map(&answer, windows, &budget).unwrap();
    let (p, m) = (answer.problem().plane(&budget).unwrap().unwrap(), decided(&answer));
    let mut seen = 0;
    for strip in &trace.strips {
        for line in strip.lines.iter().step_by(17) {
            for (k, v) in line.v.iter().enumerate().filter(|(_, v)| (0.0..=1.0).contains(*v)) {
                // A thousandth of the picture below and above, well under a pixel, the counts are the cells'.
                for (cell, away) in [(k, -1e-3), (k + 1, 1e-3)] {
                    let near = line.v.iter().enumerate().any(|(j, w)| j != k && (w - v).abs() < 2e-3);
                    if near {
                        continue;
                    }
                    let y = number(&format!("{:e}", trace.windows[1].value(v + away)));
                    let jurist_engine::stability::AtPoint::Defined { count, .. } =
                        p.at(&line.x, &y, answer.problem().shape())
                    else {
                        panic!()
                    };
                    assert_eq!(count.outside, m.strips[strip.strip].cells[cell].outside, "T = {}, K = {y}", line.x);
                    seen += 1;
                }
            }
        }
        for pair in strip.lines.windows(2) {
            assert!(pair[0].u < pair[1].u && pair[1].u - pair[0].u < 0.004);
        }
    }
    assert!(seen > 60, "{seen}");
}

/// The examples whose maps are exact, in both orders of the axes: over two points of every strip the stable cells are the stable set
/// of one parameter, which knows nothing of maps.
#[test]
fn maps_of_the_examples_are_cut_by_lines_into_stable_sets() {
    let maps = [
        ("acc-benchmark", "k", "m_1"),
        ("buck-converter", "K_p", "V_g"),
        ("bus-steering", "q1", "q2"),
        ("de-gaston-safonov", "p1", "p2"),
        ("digital-pll", "K_p", "K_i"),
        ("drive", "T", "K_pwm"),
        ("fiat-dedra", "q1", "q2"),
        ("heavy-ball", "alpha", "beta"),
        ("lcl-active-damping", "k", "c"),
        ("pid-body", "K_i", "K_d"),
        ("pmsm-current-loop", "K_p", "omega_e"),
        ("vicino-tesi-milanese", "q1", "q2"),
    ];
    let budget = Budget::unlimited();
    let mut lines = 0;
    for (number, (name, a, b)) in maps.into_iter().enumerate() {
        for (_, [x, y]) in [[a, b], [b, a]].into_iter().enumerate().filter(|(k, _)| is_tried(number + k, 3)) {
            let answer = example(name).ask().free(x).free(y).map(6, &budget).unwrap();
            let domain = answer.problem().free()[1].domain.clone();
            for strip in &decided(&answer).strips {
                let further = RealInterval { lower: Some(strip.sample.clone().into()), upper: strip.x.upper.clone() };
                for at in [strip.sample.clone(), further.sample(&budget).unwrap()] {
                    let cut = decided(&answer).slice(&at, &domain, &budget).unwrap().unwrap();
                    let line = answer.slice(0, &at, &budget).unwrap();
                    let set = line.value().to_interval_set().unwrap();
                    assert!(algebraic(&cut).same_as(&set), "{name}, {x} = {at}: {cut:?} {set:?}");
                    lines += 1;
                }
            }
        }
    }
    assert!(lines > count(80, 300), "{lines}");
}
