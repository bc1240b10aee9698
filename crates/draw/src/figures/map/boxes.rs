//! The picture of boxes: a rectangle each, filled by its verdict. Positions are floating point, the
//! verdicts are not.

use super::super::Figure;
use super::axes::ticks;
use super::draw::{FAINT, INK, PAPER, REGION, axis_name};
use super::window::AxisWindow;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::{Answer, MapBoxes};
use jurist_engine::show::layout::called;
use jurist_engine::show::region::goal_or_stable;
use jurist_engine::stability::plane::boxes::{BoxMap, BoxVerdict};
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};
use std::fmt::Write;

/// The fills of unstable and undecided boxes.
const UNSTABLE: &str = "#f4f4f4";
const UNDECIDED: &str = "#e69f00";

/// The window with its boxes, both axes linear; `None` while nothing is known.
pub fn boxes_figure(answer: &Answer<MapBoxes>, width: f64, height: f64) -> Figure {
    let map = &answer.value().boxes;
    let (left, top) = (66.0, 52.0);
    let plot = Plot {
        x: axis(&map.window.x),
        y: axis(&map.window.y),
        left,
        top,
        width: width - left - 18.0,
        height: height - top - 50.0,
    };
    let mut scene = Scene::new(width, height);
    let title = called(answer.problem().title());
    scene.add(text((width / 2.0, 20.0), &title, 14, TextAnchor::Middle, None));
    legend(&mut scene, map, &goal_or_stable(answer.problem()), (left, 40.0));
    for (verdict, fill, edge) in [
        (BoxVerdict::Unstable { outside: None }, UNSTABLE, PAPER),
        (BoxVerdict::Stable, REGION, PAPER),
        (BoxVerdict::Undecided, UNDECIDED, UNDECIDED),
    ] {
        let mut d = String::new();
        for b in map.boxes.iter().filter(|b| b.verdict.name() == verdict.name()) {
            let at = |k: usize| plot.point(&b.window.x[k], &b.window.y[k]);
            let ((x0, y0), (x1, y1)) = (at(0), at(1));
            let _ = write!(d, "M{x0:.2} {y0:.2}H{x1:.2}V{y1:.2}H{x0:.2}Z");
        }
        scene.add(path(d, fill, edge, 0.3));
    }
    frame(&mut scene, &plot);
    let [x_name, y_name] = [0, 1].map(|k: usize| axis_name(&answer.problem().free()[k]));
    scene.add(text((left + plot.width / 2.0, height - 10.0), &x_name, 12, TextAnchor::Middle, None));
    scene.add(text((16.0, top + plot.height / 2.0), &y_name, 12, TextAnchor::Middle, Some(-90.0)));
    Figure::new(scene)
}

/// The rectangle between the axes.
struct Plot {
    x: AxisWindow,
    y: AxisWindow,
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Plot {
    fn point(&self, x: &Rational, y: &Rational) -> (f64, f64) {
        let (across, up) = (self.x.place(x.to_f64_approximate()), self.y.place(y.to_f64_approximate()));
        (self.left + across * self.width, self.top + (1.0 - up) * self.height)
    }
}

fn axis([lower, upper]: &[Rational; 2]) -> AxisWindow {
    AxisWindow { lower: lower.clone(), upper: upper.clone(), logarithmic: false }
}

/// Colours with their meaning and the share of the window.
fn legend(scene: &mut Scene, map: &BoxMap, goal: &str, (mut x, y): (f64, f64)) {
    let whole = map.window.area();
    for (name, fill, area) in [
        (goal, REGION, &map.areas.stable),
        ("unstable", UNSTABLE, &map.areas.unstable),
        ("undecided", UNDECIDED, &map.areas.undecided),
    ] {
        let percent = area.checked_div(&whole).map(|share| to_decimal(&(share * Rational::from(100)), 4));
        let words = format!("{name} {} %", percent.unwrap_or_default());
        scene.add(path(format!("M{x:.2} {:.2}h12v12h-12Z", y - 10.0), fill, FAINT, 0.5));
        scene.add(text((x + 18.0, y), &words, 11, TextAnchor::Start, None));
        x += 40.0 + 6.2 * words.chars().count() as f64;
    }
}

/// Frame and ticks.
fn frame(scene: &mut Scene, plot: &Plot) {
    let (right, bottom) = (plot.left + plot.width, plot.top + plot.height);
    let outline = format!("M{:.2} {:.2}H{right:.2}V{bottom:.2}H{:.2}Z", plot.left, plot.top, plot.left);
    scene.add(path(outline, "none", INK, 1.0));
    for tick in ticks(&plot.x, (plot.width / 90.0).max(2.0)) {
        let x = plot.left + tick.place * plot.width;
        scene.add(path(format!("M{x:.2} {bottom:.2}v5"), "none", INK, 1.0));
        if let Some(label) = &tick.label {
            scene.add(text((x, bottom + 18.0), label, 11, TextAnchor::Middle, None));
        }
    }
    for tick in ticks(&plot.y, (plot.height / 60.0).max(2.0)) {
        let y = bottom - tick.place * plot.height;
        scene.add(path(format!("M{:.2} {y:.2}h-5", plot.left), "none", INK, 1.0));
        if let Some(label) = &tick.label {
            scene.add(text((plot.left - 8.0, y + 4.0), label, 11, TextAnchor::End, None));
        }
    }
}

fn path(d: String, fill: &str, stroke: &str, stroke_width: f64) -> Primitive {
    let fill = (fill != "none").then(|| Color::from(fill));
    let stroke = Color::from(stroke);
    Primitive::Path(Box::new(PathData { d, fill, stroke, stroke_width, opacity: None, stroke_dasharray: None }))
}

fn text((x, y): (f64, f64), words: &str, size: u32, anchor: TextAnchor, rotate: Option<f64>) -> Primitive {
    let color = Some(Color::from(INK));
    Primitive::Text { x, y, content: words.to_owned(), size, anchor, rotate, bold: false, color }
}
