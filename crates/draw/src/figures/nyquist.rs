//! Nyquist diagrams: the curve of the open loop around -1.

use super::frequency::{FrequencyResponse, ResponsePoint};
use super::panel::{Corner, Curve, Mark, Panel, Shape, Text};
use super::response::{Crossing, crossings, labelled, margins_line, title};
use super::{COLOURS, Figure};
use jurist_engine::answer::Answer;
use jurist_engine::response::Margins;

/// A curve that stays this near to 0 is shown whole; of another the part that is nearer than [`PART`].
const WHOLE: f64 = 5.0;
const PART: f64 = 2.4;

/// A crossing of the real axis further from 0 than this is not shown: the unit circle would be small.
const FARTHEST_CROSSING: f64 = 8.0;

/// Room around what is shown, as a share of it.
const ROOM: f64 = 0.07;

const SIZE: f64 = 640.0;

/// Ends of both axes, equally far apart: around the unit circle and -1, the crossings that matter and the part of the curve near to them.
fn window(response: &FrequencyResponse, exact: &[Crossing], modulus: Option<f64>) -> [(f64, f64); 2] {
    let values = || response.all().map(|p| (p.real, p.imaginary)).filter(|p| p.0.hypot(p.1).is_finite());
    let farthest = values().map(|(x, y)| x.hypot(y)).fold(0.0, f64::max);
    let reach = if farthest <= WHOLE { WHOLE } else { PART };
    let shown = values().filter(|(x, y)| x.hypot(*y) <= reach);
    let crossed = exact.iter().filter(|m| !m.is_gain && m.is_binding).map(|m| (m.at.real, 0.0));
    let crossed = crossed.filter(|(x, _)| x.abs() <= FARTHEST_CROSSING);
    let circles = [(-1.0, 1.0), (1.0, 1.0)].into_iter().chain(modulus.map(|r| (-1.0 - r, r)));
    let points: Vec<(f64, f64)> = shown.chain(crossed).chain(circles).collect();
    let (left, right) = points.iter().fold((0.0f64, 0.0f64), |(a, b), p| (a.min(p.0), b.max(p.0)));
    let height = points.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
    let half = (1.0 + 2.0 * ROOM) * height.max((right - left) / 2.0);
    let middle = f64::midpoint(left, right);
    [(middle - half, middle + half), (-half, half)]
}

/// The curve of the open loop around -1 with arrows towards higher frequencies, for negative frequencies dashed, of a real loop the mirror image, the
/// unit circle, and the exact crossings with their margins.
pub fn nyquist(answer: &Answer<Margins>, response: &FrequencyResponse) -> Figure {
    let margins = answer.value();
    let exact = crossings(margins, response);
    let modulus = margins.stable.as_ref().map(|stable| {
        let (lo, hi) = stable.modulus.refined_to_digits(9).enclosure();
        lo.midpoint(&hi).to_f64_approximate()
    });
    let [x, y] = window(response, &exact, modulus);
    let inside = |m: &Crossing| (x.0..=x.1).contains(&m.at.real) && (y.0..=y.1).contains(&m.at.imaginary);
    let chosen: Vec<&Crossing> = exact.iter().filter(|m| inside(m)).collect();
    let mut said = labelled(&chosen);
    // A curve that goes there and back has the same words twice.
    let is_same = |a: &Crossing, b: &Crossing| {
        a.words == b.words && (a.at.real - b.at.real).hypot(a.at.imaginary - b.at.imaginary) < 1e-3 * (x.1 - x.0)
    };
    said = (0..said.len()).filter(|&k| !said[..k].iter().any(|m| is_same(m, said[k]))).map(|k| said[k]).collect();
    let marks = chosen.iter().filter(|m| m.is_binding || said.iter().any(|s| std::ptr::eq(*s, **m))).map(|m| Mark {
        at: (m.at.real, m.at.imaginary),
        shape: Shape::Diamond,
        colour: COLOURS[1].to_owned(),
        label: None,
    });
    let critical =
        Mark { at: (-1.0, 0.0), shape: Shape::Cross, colour: COLOURS[1].to_owned(), label: Some("\u{2212}1".into()) };
    // Away from the middle of the picture, where the curve is not.
    let text = |m: &&Crossing| Text {
        text: m.words.clone(),
        at: (m.at.real - 0.2 * (x.1 - x.0), m.at.imaginary + if m.is_gain { -0.06 } else { 0.06 } * (y.1 - y.0)),
        target: Some((m.at.real, m.at.imaginary)),
    };
    let mut notes = margins_line(margins);
    let hidden = exact.iter().filter(|m| m.is_binding && !inside(m)).map(|m| m.words.clone());
    let hidden: Vec<String> = hidden.collect();
    if !hidden.is_empty() && hidden.len() <= 3 {
        notes.push(format!("outside of the picture: {}", hidden.join(", ")));
    }
    let panel = Panel {
        title: title(answer),
        notes,
        x_label: "real part".to_owned(),
        y_label: "imaginary part".to_owned(),
        x,
        y,
        curves: curves(response, modulus),
        marks: std::iter::once(critical).chain(still(response)).chain(marks).collect(),
        texts: said.iter().map(text).collect(),
        equal: true,
        legend: Some(Corner::Above),
        ..Panel::default()
    };
    panel.figure(SIZE, SIZE)
}

/// The point where an open loop stays that is the same at all frequencies: a curve has no length there.
fn still(response: &FrequencyResponse) -> Option<Mark> {
    let place = |p: &ResponsePoint| (p.real, p.imaginary);
    let first = place(response.points.first()?);
    let near = |p: &ResponsePoint| (p.real - first.0).hypot(p.imaginary - first.1) <= 1e-9 * first.0.hypot(first.1);
    let mark = Mark { at: first, shape: Shape::Dot, colour: COLOURS[0].to_owned(), label: None };
    response.all().all(near).then_some(mark)
}

fn curves(response: &FrequencyResponse, modulus: Option<f64>) -> Vec<Curve> {
    let curve = |points, colour: &str, width, label: &str| Curve {
        points,
        colour: colour.to_owned(),
        width,
        label: Some(label.to_owned()),
        ..Curve::default()
    };
    let turn = 2.0 * std::f64::consts::PI;
    let circle = |centre: f64, r: f64| {
        (0..=240).map(|i| f64::from(i) * turn / 240.0).map(|a| (centre + r * a.cos(), r * a.sin())).collect::<Vec<_>>()
    };
    let positive: Vec<(f64, f64)> = response.points.iter().map(|p| (p.real, p.imaginary)).collect();
    let negative: Vec<(f64, f64)> = match response.negative.is_empty() {
        true => positive.iter().rev().map(|p| (p.0, -p.1)).collect(),
        false => response.negative.iter().map(|p| (p.real, p.imaginary)).collect(),
    };
    let mut curves = vec![
        Curve { dashed: true, ..curve(circle(0.0, 1.0), "#999999", 1.2, "unit circle") },
        Curve { dashed: true, arrows: true, ..curve(negative, COLOURS[4], 1.2, "ω < 0") },
        Curve { arrows: true, ..curve(positive, COLOURS[0], 1.8, "ω > 0") },
    ];
    curves.extend(modulus.map(|r| Curve { dashed: true, ..curve(circle(-1.0, r), COLOURS[2], 1.2, "modulus margin") }));
    curves
}

#[cfg(test)]
mod tests {
    use super::super::frequency::frequency_response;
    use super::super::response::bode;
    use super::*;
    use jurist_algebra::limits::Budget;
    use jurist_algebra::number::Rational;
    use jurist_engine::model::{BlockBuilder, Model, Time};
    use jurist_engine::problem::Ask;

    fn response(values: &[(f64, f64)]) -> FrequencyResponse {
        let point = |(real, imaginary): &(f64, f64)| ResponsePoint {
            frequency: 1.0,
            real: *real,
            imaginary: *imaginary,
            phase: 0.0,
        };
        FrequencyResponse { hertz: true, points: values.iter().map(point).collect(), negative: Vec::new() }
    }

    fn crossing(real: f64) -> Crossing {
        let at = ResponsePoint { frequency: 1.0, real, imaginary: 0.0, phase: -180.0 };
        Crossing { at, is_gain: false, is_binding: true, words: "GM".into() }
    }

    fn drawn(transfer: &str) -> (String, String) {
        let plant = BlockBuilder::new("P", "r - y", "y").transfer(transfer);
        let (model, _) = Model::builder(Time::Continuous).inputs(["r"]).outputs(["y"]).block(plant).build().unwrap();
        let budget = Budget::unlimited();
        let answer = model.ask().margins(None, &Rational::ZERO, &budget).unwrap();
        let response = frequency_response(answer.value(), &budget).unwrap();
        (nyquist(&answer, &response).svg(), bode(&answer, &response).svg())
    }

    #[test]
    fn both_pictures_say_the_margins_at_their_crossings() {
        // The real axis is crossed at -1/2, after 60 degrees each.
        let (curve, bode) = drawn("4/(s + 1)^3");
        for svg in [&curve, &bode] {
            assert!(
                svg.contains(">GM 6.02 dB<") && svg.contains(">PM 27.14°<") && svg.contains(">gain margin 6.02 dB")
            );
        }
        assert!(curve.contains(">ω &gt; 0<") && curve.contains(">unit circle<"), "{curve}");
        assert!(bode.contains(">\u{2212}180<") && bode.contains(">\u{2212}270<"));
        // What binds at frequency 0 has no place on a logarithm, but one on the curve.
        let (curve, bode) = drawn("2/(s - 1)");
        assert!(curve.contains(">GM \u{2212}6.02 dB<") && !bode.contains(">GM"));
        // Three integrators begin at -270 degrees.
        let (_, bode) = drawn("(s + 1)^2/s^3");
        assert!(bode.contains(">\u{2212}270<") && !bode.contains(">90<"));
    }

    /// Nothing was drawn of it, and its title said "open loop" twice.
    #[test]
    fn a_constant_open_loop_is_a_point() {
        let (curve, bode) = drawn("(s + 1)/(2*s + 2)");
        assert!(curve.matches("<circle").count() > drawn("4/(s + 1)^3").0.matches("<circle").count(), "{curve}");
        for svg in [&curve, &bode] {
            assert!(svg.contains(">open loop at 'P'<") && !svg.contains("open loop: open loop"));
        }
    }

    #[test]
    fn the_window_holds_the_unit_circle_and_what_matters_of_the_curve() {
        let holds = |window: [(f64, f64); 2], (x, y): (f64, f64)| {
            (window[0].0..=window[0].1).contains(&x) && (window[1].0..=window[1].1).contains(&y)
        };
        let small = window(&response(&[(0.1, -0.1), (0.0, 0.0)]), &[], Some(0.9));
        assert!([(-1.9, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].into_iter().all(|p| holds(small, p)), "{small:?}");
        let whole = window(&response(&[(4.5, 0.0), (1.0, -2.5), (0.0, 0.0)]), &[], None);
        assert!(holds(whole, (4.5, 0.0)) && holds(whole, (1.0, 2.5)));
        let cut = window(&response(&[(-5.0, -1000.0), (-2.0, -1.0), (0.0, 0.0)]), &[], None);
        assert!(holds(cut, (-2.0, -1.0)) && cut[1].1 < 3.0);
        assert!(holds(window(&response(&[(-100.0, 1.0)]), &[crossing(-6.0)], None), (-6.0, 0.0)));
        assert!(!holds(window(&response(&[(-100.0, 1.0)]), &[crossing(-3000.0)], None), (-3000.0, 0.0)));
        for [x, y] in [small, whole, cut] {
            assert!(((x.1 - x.0) - (y.1 - y.0)).abs() < 1e-12, "a unit is as long in x as in y");
        }
    }
}
