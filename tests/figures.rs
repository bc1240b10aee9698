//! Figures: deterministic bytes, certified crossings on the locus, PNGs that decode, a small snapshot.

mod common;

use jurist::analysis::{Settings, intervals};
use jurist::limits::Budget;
use jurist::model::{Loop, Question};
use jurist::report::figures::{Curve, Figure, Panel, chopper, drive_blocks, locus_of, pwm_signal, tracker};
use jurist::simulate::{Excitation, Pulse, SampledModel, SwitchedModel};
use nalgebra::dvector;

fn small_panel() -> Panel {
    Panel {
        title: "step".into(),
        x_label: "time / s".into(),
        y_label: "ω / (rad/s)".into(),
        x: (0.0, 2.0),
        y: (0.0, 100.0),
        curves: vec![Curve {
            points: vec![(0.0, 0.0), (1.0, 80.0), (2.0, 80.0)],
            label: None,
            colour: "#0072B2".into(),
            width: 1.5,
            dashed: false,
        }],
        ..Panel::default()
    }
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
    let svg = figure.svg();
    assert!(svg.starts_with(&format!("<svg viewBox=\"0 0 {width} {height}\"")), "{}", &svg[..80]);
    assert!(svg.trim_end().ends_with("</svg>") && !svg.contains("NaN") && !svg.contains("inf\""));
}

#[test]
fn a_small_figure_looks_as_it_did() {
    insta::assert_snapshot!(small_panel().figure(320.0, 200.0).svg());
}

#[test]
fn the_same_data_give_the_same_bytes() {
    let draw = || small_panel().figure(320.0, 200.0);
    assert_eq!(draw().svg(), draw().svg());
    assert_eq!(draw().png(1.0), draw().png(1.0));
    assert_eq!(draw().terminal(60, 20), draw().terminal(60, 20));
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
fn the_locus_of_the_drive_shows_every_certified_crossing() {
    let budget = Budget::unlimited();
    let answer = intervals(&Loop::drive(), &Settings::default(), "K_pwm", &budget).unwrap();
    let range = (common::q(1, 1000), common::q(1000, 1));
    let drawn = locus_of(&answer, &range, None, &budget).unwrap();
    let labels: Vec<&str> = drawn.crossings.iter().map(|c| c.label.as_str()).collect();
    assert_eq!(labels, ["K_pwm = 0.0381 (0.506 Hz)", "K_pwm = 550.94 (1664 Hz)"]);
    let svg = drawn.figure.svg();
    for label in labels {
        assert!(svg.contains(label), "{label}");
    }
    check(&drawn.figure, 1040, 520);
}

#[test]
fn the_block_model_gives_the_circuit_and_the_matrix_model_the_sampled_loop() {
    let text = include_str!("../examples/drive-blocks.toml");
    let (blocks, _) = Loop::from_toml(&jurist::error::Source::new("drive-blocks.toml", text)).unwrap();
    let (question, budget) = (Question::default(), Budget::unlimited());
    let circuit = SwitchedModel::from_loop(&blocks, &question, Pulse::Beginning, &budget).unwrap();
    let expected = common::switched_drive(110.0, 1e-4, Pulse::Beginning);
    let r = dvector![80.0, 0.0];
    let (a, b) = (circuit.periodic_steady_state(&r).unwrap(), expected.periodic_steady_state(&r).unwrap());
    assert!((a.state.plant - b.state.plant).norm() < 1e-9);
    assert_eq!(circuit.plant_states(), ["i_a", "omega"]);
    let (x, y) = (circuit.small_signal_eigenvalues(&r).unwrap(), expected.small_signal_eigenvalues(&r).unwrap());
    for z in x.iter().filter(|z| z.norm() > 1e-6) {
        assert!(y.iter().any(|w| (z - w).norm() < 1e-7), "{z} {y:?}");
    }
    assert!(SwitchedModel::from_loop(&Loop::drive(), &question, Pulse::End, &budget).is_err());
    let sampled = SampledModel::from_loop(&Loop::drive(), &question, 1.0, &budget).unwrap();
    let fixture = common::sampled_drive(110.0, 1e-4);
    assert!((&sampled.transition - &fixture.transition).norm() < 1e-15);
    assert_eq!(sampled.sample_time, 1e-4);
    let run = fixture.simulate(&Excitation::default(), 3);
    assert_eq!(run.peak("omega"), 0.0);
}
