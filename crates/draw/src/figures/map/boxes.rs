//! The picture of boxes: a rectangle each, filled by its verdict. Positions are floating point, the
//! verdicts are not.

use super::super::axes::{BELOW, Frame};
use super::super::facts::heading;
use super::super::legend::{self, Entry, Sample};
use super::super::panel::Shape;
use super::super::{Figure, INK};
use super::draw::{inside, what};
use super::window::AxisWindow;
use super::{MET, REGION, UNDECIDED, UNSTABLE};
use crate::scene::{Colour, Item, Rectangle, Scene, Stroke, through};
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::{Answer, MapBoxes};
use jurist_engine::response::RequiredBoxes;
use jurist_engine::stability::plane::boxes::{BoxMap, BoxVerdict, PlaneBox, Window};
use jurist_show::for_all_text;
use jurist_show::region::goal_or_stable;

/// Digits of the ends of ranges in the legend.
const DIGITS: usize = 6;

/// The window with its boxes, both axes linear.
pub fn boxes_figure(answer: &Answer<MapBoxes>, width: f64, height: f64) -> Figure {
    let map = &answer.value().boxes;
    let problem = answer.problem();
    let windows = [axis(&map.window.x), axis(&map.window.y)];
    let nominal = nominal(answer, &windows);
    let [x, y] = [0, 1].map(|k: usize| windows[k].axis(&problem.free()[k]));
    let mut scene = Scene::new(width, height);
    let mut top = heading(&what(problem), problem).draw(&mut scene);
    let required = answer.value().required.as_ref();
    let goal = goal_or_stable(problem);
    let [good, bad] = match for_all_text(&answer.value().for_all, DIGITS) {
        Some(all) => [format!("{goal} {all}"), "not for all".to_owned()],
        None if goal == "stable" => [goal, "unstable".to_owned()],
        None => [goal.clone(), format!("not {goal}")],
    };
    let mut entries = entries(map, [&good, &bad]);
    entries.extend(required.into_iter().flat_map(|found| required_entries(found, &map.window)));
    entries.extend(nominal.map(|_| (Sample::Mark(Shape::Diamond, INK), "nominal".to_owned())));
    top = legend::in_rows(&mut scene, &entries, (14.0, top + 2.0), width - 28.0) + 6.0;
    let left = Frame::left_of(&y, height - top - BELOW);
    let plot = Rectangle { left, top, width: width - left - 18.0, height: height - top - BELOW };
    let frame = Frame { x, y, plot, equal: false };
    let mut fill = |boxes: &mut dyn Iterator<Item = &Window>, fill: Colour| {
        let mut segments = Vec::new();
        for window in boxes {
            let at = |k: usize| frame.at((window.x[k].to_f64_approximate(), window.y[k].to_f64_approximate()));
            let ((x0, y0), (x1, y1)) = (at(0), at(1));
            segments.extend(through(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)], true));
        }
        if !segments.is_empty() {
            // A thin edge of the same colour leaves no seams between neighbouring boxes.
            scene.add(Item::Path { segments, fill: Some(fill), stroke: Some(Stroke::new(fill, 0.5)) });
        }
    };
    for (verdict, ground) in [
        (BoxVerdict::Unstable { outside: None }, UNSTABLE),
        (BoxVerdict::Stable, REGION),
        (BoxVerdict::Undecided, UNDECIDED),
    ] {
        let with = |b: &&PlaneBox| b.verdict.name() == verdict.name();
        fill(&mut map.boxes.iter().filter(with).map(|b| &b.window), ground);
    }
    for (met, ground) in [(Some(true), MET), (None, UNDECIDED)] {
        let boxes = required.into_iter().flat_map(|found| &found.boxes).filter(|b| b.met == met);
        fill(&mut boxes.map(|b| &b.window), ground);
    }
    frame.draw(&mut scene);
    if let Some(at) = nominal {
        legend::mark(&mut scene, Shape::Diamond, INK, frame.at_places(at));
    }
    scene.into()
}

/// Where the nominal point is, if the window shows it.
fn nominal(answer: &Answer<MapBoxes>, windows: &[AxisWindow; 2]) -> Option<(f64, f64)> {
    let place = |k: usize| {
        let nominal = answer.problem().free()[k].nominal.as_ref()?;
        Some(windows[k].place(nominal.to_f64_approximate()))
    };
    Some((place(0)?, place(1)?)).filter(|at| inside(*at))
}

fn axis([lower, upper]: &[Rational; 2]) -> AxisWindow {
    AxisWindow { lower: lower.clone(), upper: upper.clone(), logarithmic: false }
}

/// The ground where requirements are met, and the share of the window that is open.
fn required_entries(found: &RequiredBoxes, window: &Window) -> [Entry; 2] {
    let name = match found.requirements.as_slice() {
        [one] => one.text().replace('_', " ").replace(">=", "\u{2265}").replace("<=", "\u{2264}"),
        _ => "all requirements met".to_owned(),
    };
    let share = |area: &Rational| {
        let percent = area.checked_div(&window.area()).map(|share| to_decimal(&(share * Rational::from(100)), 4));
        percent.unwrap_or_default()
    };
    [
        (Sample::Area(MET), format!("{name} {} %", share(&found.areas.met))),
        (Sample::Area(UNDECIDED), format!("undecided whether met {} %", share(&found.areas.undecided))),
    ]
}

/// Colours with their meaning and the share of the window.
fn entries(map: &BoxMap, [good, bad]: [&str; 2]) -> Vec<Entry> {
    let whole = map.window.area();
    let entry = |(name, fill, area): (&str, Colour, &Rational)| {
        let percent = area.checked_div(&whole).map(|share| to_decimal(&(share * Rational::from(100)), 4));
        (Sample::Area(fill), format!("{name} {} %", percent.unwrap_or_default()))
    };
    [
        (good, REGION, &map.areas.stable),
        (bad, UNSTABLE, &map.areas.unstable),
        ("undecided", UNDECIDED, &map.areas.undecided),
    ]
    .map(entry)
    .to_vec()
}
