//! Figures: deterministic bytes, certified crossings on the locus, PNGs that decode, a small snapshot.

use crate::helpers::drive::{sampled_drive, switched_drive};
use crate::helpers::number::ratio;
use crate::helpers::program::jurist_with_input;
use crate::helpers::thorough::{count, is_tried};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_draw::figures::{
    Curve, DrawnLocus, Figure, Mark, Panel, Scale, Shape, dark_style, facts, locus_of, stacked,
};
use jurist_draw::simulate::{Excitation, Pulse, SampledModel, SwitchedModel};
use jurist_drive::{chopper, drive_blocks, pwm_signal, tracker};
use jurist_engine::answer::Verdict;
use jurist_engine::error::Error;
use jurist_engine::model::{Model, Time};
use nalgebra::DVector;

fn small_panel() -> Panel {
    Panel {
        title: "step".into(),
        x_label: "time (s)".into(),
        y_label: "ω (rad/s)".into(),
        x: (0.0, 2.0),
        y: (0.0, 100.0),
        curves: vec![Curve {
            points: vec![(0.0, 0.0), (1.0, 80.0), (2.0, 80.0)],
            colour: "#0072B2".into(),
            width: 1.5,
            ..Curve::default()
        }],
        ..Panel::default()
    }
}

/// An SVG with a line for each element, so that a change can be read.
fn line_by_line(svg: &str) -> String {
    svg.replace("><", ">\n<")
}

/// What a figure says: its text without tags.
fn words(svg: &str) -> String {
    let pieces = svg.split("</text>").map(|part| {
        let text = part.rsplit_once("<text ").map_or("", |(_, text)| text);
        let tagless = text.split('<').map(|p| p.split_once('>').map_or(p, |(_, t)| t));
        tagless.collect::<String>()
    });
    pieces.collect::<Vec<_>>().join("\n")
}

/// Width and height in the header of a PNG.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let number = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    (bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.get(12..16)? == b"IHDR").then_some(())?;
    Some((number(16)?, number(20)?))
}

fn check(figure: &Figure, width: u32, height: u32) {
    let png = figure.png(2.0).unwrap();
    assert_eq!(png_size(&png), Some((2 * width, 2 * height)));
    assert!(png.ends_with(b"IEND\xaeB`\x82"));
    let pdf = figure.pdf().unwrap();
    assert!(pdf.starts_with(b"%PDF-") && pdf.ends_with(b"%%EOF") && pdf == figure.pdf().unwrap());
    let svg = figure.svg();
    assert!(svg.starts_with(&format!("<svg viewBox=\"0 0 {width} {height}\"")), "{}", &svg[..80]);
    assert!(svg.trim_end().ends_with("</svg>") && !svg.contains("NaN") && !svg.contains("inf\""));
}

#[test]
fn a_small_figure_looks_as_it_did() {
    insta::assert_snapshot!(line_by_line(&small_panel().figure(320.0, 200.0).svg()));
}

#[test]
fn a_small_locus_looks_as_it_did() {
    // z^2 - z + k: two real roots meet at k = 1/4, leave as a pair, and cross the circle at k = 1, 1/6 of a turn.
    let text = "time = 'discrete'\nsample_time = 1\nparameters.k = { nominal = 0.5, min = 0 }\n\
                loop.characteristic = 'z^2 - z + k'\n";
    let (model, _) = Model::from_toml(&jurist_engine::error::Source::new("model.toml", text)).unwrap();
    let budget = Budget::unlimited();
    let answer = model.ask().free("k").stable_set(&budget).unwrap();
    let drawn = locus_of(&answer, &(ratio(1, 100), ratio(2, 1)), None, &budget).unwrap();
    // The curves are followed elsewhere; here it is axes, marks and labels that are looked at.
    let svg: String = line_by_line(&drawn.parts[0].svg())
        .lines()
        .filter(|l| !l.starts_with("<path") && !l.starts_with("<polyline"))
        .map(|l| format!("{l}\n"))
        .collect();
    assert_eq!(drawn.crossings.len(), 1);
    assert!(words(&svg).contains("crossing (certified)"), "{}", words(&svg));
    insta::assert_snapshot!(svg);
}

#[test]
fn the_same_data_give_the_same_bytes() {
    let draw = || small_panel().figure(320.0, 200.0);
    assert_eq!(draw().svg(), draw().svg());
    assert_eq!(draw().png(1.0), draw().png(1.0));
    let plain = draw().terminal(60, false);
    assert_eq!(plain, draw().terminal(60, false));
    assert!(!plain.contains('\u{1b}') && draw().terminal(60, true).contains('\u{1b}'));
    assert!(plain.lines().all(|l| l.chars().count() <= 60) && plain.contains("time (s)"), "{plain}");
}

#[test]
fn panels_below_each_other_begin_at_the_same_place() {
    let wide = Panel { y: (-100_000.0, 100_000.0), y_label: "u".into(), ..small_panel() };
    let svg = stacked(&[small_panel(), wide], 400.0, 200.0).svg();
    let frames = svg.split("<path d=\"M").filter(|p| p.contains("Z\" fill=\"none\" stroke=\"#333333\""));
    let left: Vec<&str> = frames.filter_map(|p| p.split(' ').next()).collect();
    assert!(left.len() == 2 && left[0] == left[1], "{left:?}");
}

#[test]
fn every_colour_of_a_picture_has_one_for_dark_pages() {
    let budget = Budget::unlimited();
    let answer = Model::drive().ask().free("K_pwm").stable_set(&budget).unwrap();
    let drawn = locus_of(&answer, &(ratio(1, 1000), ratio(1000, 1)), None, &budget).unwrap();
    let css = dark_style(".figure");
    for svg in [drawn.figure.svg(), drive_blocks().svg(), small_panel().figure(300.0, 200.0).svg()] {
        for colour in svg.split("=\"#").skip(1).filter_map(|p| p.get(..6)) {
            assert!(css.contains(&format!("=\"#{colour}\"")), "#{colour}");
        }
    }
}

#[test]
fn a_picture_says_what_is_fixed_and_how_blocks_were_made_discrete() {
    let text = include_str!("../../examples/drive-blocks.toml");
    let (blocks, _) = Model::from_toml(&jurist_engine::error::Source::new("drive-blocks.toml", text)).unwrap();
    let facts = facts(&blocks.ask().free("K_pwm").problem().unwrap());
    assert_eq!(facts.len(), 2, "{facts:?}");
    assert_eq!(facts[0], "T = 100 µs");
    assert!(facts[1].ends_with(" made discrete by: forward rule"), "{facts:?}");
}

#[test]
fn on_a_logarithmic_axis_decades_are_equally_far_apart() {
    let panel = Panel {
        x_label: "frequency (Hz)".into(),
        x: (1.0, 1000.0),
        x_scale: Scale::Logarithmic,
        marks: [1.0, 10.0, 100.0, 1000.0]
            .map(|f| Mark { at: (f, 50.0), shape: Shape::Dot, colour: "#d55e00".into(), label: None })
            .to_vec(),
        ..small_panel()
    };
    let svg = panel.figure(400.0, 200.0).svg();
    let dots = svg.split("<circle cx=\"").skip(1).filter_map(|p| p.split('"').next()?.parse::<f64>().ok());
    let places: Vec<f64> = dots.collect();
    assert_eq!(places.len(), 4);
    for pair in places.windows(3) {
        assert!((pair[2] - 2.0 * pair[1] + pair[0]).abs() < 0.03, "{places:?}");
    }
    for label in [">1 Hz<", ">10 Hz<", ">1000 Hz<"] {
        assert!(svg.contains(label), "{label}");
    }
}

/// "5000 Hz" at the end of an axis was wider than the margin.
#[test]
fn words_at_the_ends_of_axes_are_inside_of_the_picture() {
    let model = include_str!("../../src/cli/templates/lcl-filter.toml");
    for name in ["bode", "nyquist"] {
        let file = std::env::temp_dir().join(format!("jurist-{}-{name}.svg", std::process::id()));
        jurist_with_input(&[name, "-", "-o", file.to_str().unwrap(), "-q"], model.as_bytes());
        let svg = std::fs::read_to_string(&file).unwrap();
        std::fs::remove_file(&file).unwrap();
        let number = |text: &str, key: &str| -> Option<f64> {
            let rest = &text[text.find(&format!("{key}=\""))? + key.len() + 2..];
            rest[..rest.find('"')?].parse().ok()
        };
        let width = number(&svg, " width").unwrap();
        let mut seen = 0;
        for part in svg.split("<text ").skip(1).filter(|t| t.contains("middle") && !t.contains("rotate")) {
            let (Some(x), Some(size)) = (number(part, "x"), number(part, "font-size")) else { continue };
            let words = &part[part.find('>').unwrap() + 1..part.find("</text>").unwrap()];
            // Titles are broken by their true width.
            if words.chars().count() > 12 {
                continue;
            }
            // Letters of these fonts are rarely wider than six tenths of their size.
            let half = words.chars().count() as f64 * 0.6 * size / 2.0;
            assert!(x - half >= 0.0 && x + half <= width, "{name}: {words:?} at {x} of {width}");
            seen += 1;
        }
        assert!(seen > 4, "{name}: {seen}");
    }
}

#[test]
fn diagrams_are_drawn() {
    check(&small_panel().figure(320.0, 200.0), 320, 200);
    check(&drive_blocks(), 1000, 240);
    check(&chopper(), 900, 360);
    check(&pwm_signal(), 760, 330);
    check(&tracker(), 820, 280);
}

#[test]
#[ignore = "long: CI runs it"]
fn the_locus_of_the_drive_shows_every_certified_crossing() {
    let budget = Budget::unlimited();
    let answer = Model::drive().ask().free("K_pwm").stable_set(&budget).unwrap();
    let range = (ratio(1, 1000), ratio(1000, 1));
    let drawn = locus_of(&answer, &range, None, &budget).unwrap();
    let labels: Vec<&str> = drawn.crossings.iter().map(|c| c.label.as_str()).collect();
    assert_eq!(labels, ["K_pwm = 38.101 mV, 0.506 Hz", "K_pwm = 550.94 V, 1664 Hz"]);
    let said = words(&drawn.figure.svg());
    for label in ["Kpwm = 38.101 mV, 0.506 Hz", "Kpwm = 550.94 V, 1664 Hz", "Kpwm from 1 mV to 1000 V"] {
        assert_eq!(said.matches(label).count(), 1, "{label}: {said}");
    }
    for other in ["T = 100 µs", "open-loop poles (Kpwm = 0)", "closed loop at Kpwm = 110 V"] {
        assert!(said.contains(other), "{other}: {said}");
    }
    let (width, height) = drawn.figure.size();
    check(&drawn.figure, width as u32, height as u32);
}

#[test]
fn the_block_model_gives_the_circuit_and_the_matrix_model_the_sampled_loop() {
    let text = include_str!("../../examples/drive-blocks.toml");
    let (blocks, _) = Model::from_toml(&jurist_engine::error::Source::new("drive-blocks.toml", text)).unwrap();
    let budget = Budget::unlimited();
    let [blocks, drive] = [blocks, Model::drive()].map(|model| model.ask().problem().unwrap());
    let circuit = SwitchedModel::from_loop(&blocks, Some(Pulse::Beginning), &budget).unwrap();
    let expected = switched_drive(110.0, 1e-4, Pulse::Beginning);
    let r = DVector::from_vec(vec![80.0, 0.0]);
    let (a, b) = (circuit.periodic_steady_state(&r).unwrap(), expected.periodic_steady_state(&r).unwrap());
    assert!((a.state.plant - b.state.plant).norm() < 1e-9);
    assert_eq!(circuit.plant_states(), ["i_a", "omega"]);
    let (x, y) = (circuit.small_signal_eigenvalues(&r).unwrap(), expected.small_signal_eigenvalues(&r).unwrap());
    for z in x.iter().filter(|z| z.norm() > 1e-6) {
        assert!(y.iter().any(|w| (z - w).norm() < 1e-7), "{z} {y:?}");
    }
    assert!(SwitchedModel::from_loop(&drive, Some(Pulse::End), &budget).is_err());
    let sampled = SampledModel::from_loop(&drive, 1.0, &budget).unwrap();
    let fixture = sampled_drive(110.0, 1e-4);
    assert!((&sampled.transition - &fixture.transition).norm() < 1e-15);
    assert_eq!(sampled.sample_time, 1e-4);
    let run = fixture.simulate(&Excitation::default(), 3);
    assert_eq!(run.peak("omega"), 0.0);
}

/// Every parameter of every example with its certified answer, and the picture around it.
fn pictures(mut see: impl FnMut(&str, &Model, &str, &DrawnLocus)) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut names: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    // Of the drive with filters the one of order 8: twelve roots as fixed-point numbers take half of the time of all others.
    let is_long = |name: &str| ["drive-filters-4", "drive-filters-6"].contains(&name);
    names.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    names.retain(|p| p.file_stem().is_some_and(|name| !is_long(&name.to_string_lossy())));
    names.sort();
    assert!(names.len() > 10);
    let budget = Budget::unlimited();
    for path in names.into_iter().enumerate().filter(|(i, _)| is_tried(*i, 6)).map(|(_, path)| path) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let (model, _) = Model::from_toml(&jurist_engine::error::Source::new(name.as_str(), text)).unwrap();
        for p in model.parameters() {
            // Loops behind a hold and with dead time are not drawn yet, and their limits may take long.
            if !model.ask().free(&p.name).problem().is_ok_and(|problem| problem.algebra(&budget).is_ok()) {
                continue;
            }
            let answer = match model.ask().free(&p.name).stable_set(&budget) {
                Ok(answer) => answer,
                // A tie behind a hold may stay undecided.
                Err(Error::Refused(_) | Error::Stopped(_)) => continue,
                Err(other) => panic!("{name}: {other}"),
            };
            let ends = answer.value().intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
            let values: Vec<Rational> = ends.map(|e| e.value.refined_to_digits(6).enclosure().0.clone()).collect();
            let (Some(low), Some(high)) = (values.iter().min(), values.iter().max()) else { continue };
            let width = if low < high { high - low } else { high.abs() + ratio(1, 10) };
            let mut from = low - &(&width * &ratio(1, 5));
            if answer.problem().parameter().domain.lower.as_ref().is_some_and(|l| from <= *l) {
                from = low + &(&width * &ratio(1, 1000));
            }
            let range = (from, high + &(&width * &ratio(1, 5)));
            let Ok(drawn) = locus_of(&answer, &range, None, &budget) else {
                assert!(!answer.value().is_algebraic(), "{name}");
                continue;
            };
            see(&name, &model, &p.name, &drawn);
        }
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn pictures_show_every_certified_crossing_and_contradict_no_certified_answer() {
    let mut labels = 0;
    pictures(|name, model, parameter, drawn| {
        let said = words(&drawn.figure.svg());
        for crossing in &drawn.crossings {
            // A name of one letter stands before its index without the line between them.
            let value = crossing.label.split_once(" = ").unwrap().1;
            assert!(said.contains(value), "{name}, {parameter}: {} in {said}", crossing.label);
            labels += 1;
        }
        for sample in drawn.locus.samples().step_by(300) {
            // At a crossing itself the roots are on the boundary.
            let value = sample.parameter.to_f64_approximate();
            if drawn.crossings.iter().any(|c| (c.parameter - value).abs() <= 1e-9 * value.abs()) {
                continue;
            }
            let point = model.ask().set(parameter, sample.parameter.clone());
            let certified = point.verdict(&Budget::unlimited()).unwrap().value().verdict == Verdict::Stable;
            let discrete = model.time() == Time::Discrete;
            let excess = sample.roots.iter().map(|z| if discrete { z.norm() - 1.0 } else { z.re });
            let farthest = excess.fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(farthest < 0.0, certified, "{name}, {parameter} = {value}: {farthest:e}");
        }
    });
    assert!(labels >= count(2, 20), "{labels}");
}
