//! The methods of `jurist map`: exact, boxes, and the choice between them; loops of high order.

use crate::helpers::model::keeping;
use crate::helpers::number::number;
use crate::helpers::plane::algebraic;
use crate::helpers::program::{given_time, json, jurist, number_in, refused};
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use serde_json::Value;

/// Pairs of the drive's quantities, with windows that show the bounded part of the stable region.
const PAIRS: [[&str; 2]; 5] = [
    ["T=0..0.07", "K_pwm=0..600"],
    ["K_pi=-1..60", "K_ii=0..130000"],
    ["K_ps=-1..600", "K_is=0..270000"],
    ["L_a=0..0.2", "R_a=-100..1100"],
    ["J=0..0.2", "T=0..0.001"],
];

#[test]
#[ignore = "long: CI runs it"]
fn boxes_of_pairs_of_the_drive_agree_with_the_exact_map() {
    for [x, y] in PAIRS {
        let answer = json(&["map", "-x", x, "-y", y, "--method", "boxes", "--json"]);
        assert_eq!(answer["schema"], "jurist/map-boxes/1");
        assert!(answer["stopped"].is_null());
        let areas = &answer["areas"];
        let of = |name: &str| number_in(&areas[name]);
        assert_eq!(of("stable") + of("unstable") + of("undecided"), of("window"), "{x} {y}");
        assert!(of("undecided") / of("window") <= number_in(&answer["goal"]), "{x} {y}");
        let names = [x, y].map(|text| text.split('=').next().unwrap());
        let budget = Budget::unlimited();
        let exact = keeping(&Model::drive(), &names).map(12, &budget).unwrap();
        let exact_map = &exact.value().decomposition;
        let mut seen = [0; 2];
        for b in answer["boxes"].as_array().unwrap().iter().filter(|b| b["verdict"] != "undecided").step_by(5) {
            let middle = |side: &str| number_in(&b[side][0]).midpoint(&number_in(&b[side][1]));
            let place =
                exact_map.locate(&middle("x"), &middle("y"), &exact.problem().axes()[1].domain, &budget).unwrap();
            let Some((strip, cell)) = place else { continue };
            let cell = &exact_map.strips[strip].cells[cell];
            assert_eq!(b["verdict"] == "stable", cell.stable, "{x} {y}: {b}");
            assert!(b["outside"].is_null() || b["outside"] == cell.outside as u64, "{x} {y}: {b}");
            seen[usize::from(cell.stable)] += 1;
        }
        assert!(seen[0] > 2 && seen[1] > 0, "{x} {y}: {seen:?}");
    }
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let boxes = ["map", "-x", "T=0..0.07", "-y", "K_pwm=0..600", "--method", "boxes", "--json"];
    let exact = ["map", "examples/drive-filters-2.toml", "-x", "T", "-y", "K_pwm", "--json"];
    for arguments in [&boxes[..], &exact[..]] {
        let with = |threads: &str| {
            let run = jurist(&[arguments, &["--threads", threads]].concat());
            assert_eq!(run.status, 0, "{}", run.stderr);
            run.stdout
        };
        let one = with("1");
        assert!(tried(["5", "2"], 2).all(|threads| one == with(threads)));
    }
    refused(&["map", "-x", "T", "-y", "K_pwm", "--threads", "0"], "E-usage");
}

#[test]
fn boxes_need_a_bounded_window() {
    let run = refused(&["map", "-x", "T=0..1", "-y", "K_pwm", "--method", "boxes"], "E-usage");
    assert!(run.stderr.contains("window of 'K_pwm'"), "{}", run.stderr);
    refused(&["map", "-x", "T=-2..-1", "-y", "K_pwm=0..1", "--method", "boxes"], "E-empty-domain");
    refused(&["map", "-x", "T=0..1", "-y", "K_pwm=0..1", "--undecided", "2"], "E-option-value");
    refused(&["map", "-x", "T=0..1", "-y", "K_pwm=0..1", "--undecided", "no"], "E-number");
    // The domain bounds what the window leaves open.
    let domain = ["map", "-x", "T=..1", "-y", "K_pwm", "--domain", "K_pwm=0..600", "--method", "boxes"];
    assert_eq!(jurist(&domain).status, 0);
}

#[test]
fn auto_is_exact_where_that_is_in_time() {
    let answer = json(&["map", "-x", "T=0..0.07", "-y", "K_pwm=0..600", "--timeout", "inf", "--json"]);
    assert_eq!(answer["schema"], "jurist/map/1");
    assert_eq!(answer["regions"].as_array().unwrap().len(), 1);
}

/// Of order 30: nobody waits for the exact map, boxes take seconds.
#[test]
#[ignore = "long: CI runs it"]
fn auto_falls_back_on_boxes() {
    let file = std::env::temp_dir().join(format!("jurist-filters-{}.toml", std::process::id()));
    std::fs::write(&file, filtered_drive(24)).unwrap();
    let path = file.to_str().unwrap();
    let window = ["-x", "T=0..0.02", "-y", "K_pwm=0..600"];
    let exact_only = jurist(&[&["map", path][..], &window, &["--timeout", "0.25", "--method", "exact"]].concat());
    assert_eq!(exact_only.status, 3);
    let no_window = jurist(&["map", path, "-x", "T", "-y", "K_pwm", "--timeout", "0.25"]);
    assert_eq!(no_window.status, 3);
    // The hint is missing where a single step outlasts the time and the program is ended.
    assert!(no_window.stderr.contains("undecided"), "{}", no_window.stderr);
    let (status, answer) = given_time(|seconds| {
        let timeout = ["--timeout", seconds, "--undecided", "0.2", "--json"];
        let run = jurist(&[&["map", path][..], &window, &timeout].concat());
        // In too little time nothing is known, or only what was asked.
        let answer = serde_json::from_str::<Value>(&run.stdout).ok()?;
        assert_eq!(answer["schema"], "jurist/map-boxes/1", "{}", run.stderr);
        answer["boxes"].is_array().then_some((run.status, answer))
    });
    assert_eq!(status, if answer["stopped"].is_null() { 0 } else { 3 });
    assert!(!answer["boxes"].as_array().unwrap().is_empty());
    std::fs::remove_file(&file).unwrap();
}

/// The drive of `examples/drive-blocks.toml` with first-order filters in its current feedback.
fn filtered_drive(filters: usize) -> String {
    let blocks = include_str!("../../examples/drive-blocks.toml");
    let mut chain = String::new();
    for k in 1..=filters {
        let input = if k == 1 { "i_a".to_owned() } else { format!("f_{}", k - 1) };
        chain += &format!(
            "[[block]]\nname = \"current filter {k}\"\ninput = \"{input}\"\noutput = \"f_{k}\"\ntransfer = \"(1 - a)/(z - a)\"\n\n"
        );
    }
    blocks
        .replace("i_ref - k_1*i_a", &format!("i_ref - k_1*f_{filters}"))
        .replace("[parameters]", "a = \"1/2\"\n\n[parameters]")
        .replace("[simulation]", &format!("{chain}[simulation]"))
}

/// The exact maps of orders 8 and 10: one region, whose extent ends where the stable sets of one parameter
/// end and whose slices are those sets. The examples are the models of [`filtered_drive`].
#[test]
fn exact_maps_of_filtered_drives() {
    let budget = Budget::unlimited();
    let drives = [
        (2, include_str!("../../examples/drive-filters-2.toml"), "0.02915692109", "0.03791842924"),
        (4, include_str!("../../examples/drive-filters-4.toml"), "0.02215130685", "0.03791842924"),
    ];
    for (filters, text, tip, low) in tried(drives, 2) {
        let read = |text: &str| Model::from_toml(&Source::new("filters.toml", text.to_owned())).unwrap().0;
        let (lp, generated) = (read(text), read(&filtered_drive(filters)));
        let answer = keeping(&lp, &["T", "K_pwm"]).map(12, &budget).unwrap();
        let (problem, exact) = (answer.problem(), &answer.value().decomposition);
        assert_eq!(problem.plane(&budget).unwrap().unwrap().formal_degree(), 6 + filters);
        assert_eq!(exact.regions.len(), 1);
        assert_eq!(exact.regions[0].x.upper.as_ref().unwrap().decimal(10), tip);
        assert_eq!(exact.regions[0].y.lower.as_ref().unwrap().decimal(10), low);
        let at = number("1e-4");
        let slice = exact.slice(&at, &problem.axes()[1].domain, &budget).unwrap().unwrap();
        let one = generated.ask().free("K_pwm").stable_set(&budget).unwrap();
        assert!(algebraic(&slice).same_as(&one.value().to_interval_set().unwrap()));
    }
}

#[test]
fn text_of_boxes() {
    let run = jurist(&["map", "-x", "T=0..0.07", "-y", "K_pwm=0..600", "--method", "boxes"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    for part in ["by boxes", "stable:", "undecided:", "% of the window", "the stable boxes reach over 0 < T <"] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn pictures_of_boxes() {
    let folder = std::env::temp_dir().join(format!("jurist-boxes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let draw = |name: &str| {
        let file = folder.join(name);
        let output = file.to_str().unwrap();
        let run = jurist(&["map", "-x", "K_pi=-1..60", "-y", "K_ii=0..130000", "--method", "boxes", "-o", output]);
        assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
        std::fs::read(&file).unwrap()
    };
    let svg = String::from_utf8(draw("boxes.svg")).unwrap();
    for part in ["<svg", "undecided", "stable 5"] {
        assert!(svg.contains(part), "{part}");
    }
    assert!(draw("boxes.png").starts_with(b"\x89PNG"));
    let page = String::from_utf8(draw("boxes.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("</svg>") && page.contains("% of the window"));
    let document: Value = serde_json::from_slice(&draw("boxes.json")).unwrap();
    assert_eq!(document["schema"], "jurist/map-boxes/1");
    std::fs::remove_dir_all(&folder).unwrap();
}
