//! The drawing: region, walls, labels, marks, axes, legend.

use super::super::Figure;
use super::super::clip::Window;
use super::axes::{Tick, ticks};
use super::labels::{FrequencyPoint, extreme_points, frequencies, limits_on_lines, spaced};
use super::lines::{Role, Wall, mechanism_colour, walls};
use super::shapes::{broken, dashed, path, thinned};
use super::trace::MapTrace;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::error::Failure;
use jurist_engine::problem::Free;
use jurist_engine::show::layout::visible;
use jurist_engine::show::region::goal_or_stable;
use jurist_engine::stability::plane::StabilityMap;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

pub(super) const INK: &str = "#222222";
pub(super) const FAINT: &str = "#999999";
const GRID: &str = "#e4e4e4";
pub(super) const PAPER: &str = "#ffffff";
pub(super) const REGION: &str = "#cfe8d8";
/// Width of a character of the text in the figure, on average.
pub(super) const CHARACTER: f64 = 5.8;
/// Frequencies for the page are this far apart.
const FINE_SPACING: f64 = 14.0;

/// A picture of a map, with what is needed to look things up in it.
#[derive(Debug)]
pub struct MapFigure {
    /// The picture.
    pub figure: Figure,
    /// The rectangle between the axes: left, top, width, height.
    pub plot: (f64, f64, f64, f64),
}

/// The contents of a picture, drawn at any size.
#[derive(Debug)]
pub struct MapContents<'a> {
    pub(super) answer: &'a Answer<Map>,
    pub(super) map: &'a StabilityMap,
    pub(super) trace: &'a MapTrace,
    /// The walls.
    pub walls: Vec<Wall>,
    /// For each wall, frequencies along it.
    pub frequencies: Vec<Vec<FrequencyPoint>>,
    /// The exact limits on the lines through the nominal point, and the extreme values of the regions.
    pub(super) on_lines: Vec<((f64, f64), String)>,
    /// Published limits to compare with, in the parameters' units.
    pub published: Vec<(f64, f64)>,
}

impl<'a> MapContents<'a> {
    /// Walls and frequencies of a traced map.
    ///
    /// # Errors
    /// [`Failure::Stopped`] when the budget runs out.
    pub fn new(
        answer: &'a Answer<Map>,
        trace: &'a MapTrace,
        published: Vec<(f64, f64)>,
        budget: &Budget,
    ) -> Result<Self, Failure> {
        let map = &answer.value().decomposition;
        let walls = walls(answer, map, trace);
        budget.step("frequencies along the walls");
        let mut found = Vec::with_capacity(walls.len());
        for wall in &walls {
            budget.check()?;
            let points = spaced(wall, (760.0, 440.0), FINE_SPACING);
            found.push(frequencies(answer, map, wall, &points, budget)?);
        }
        let mut on_lines = limits_on_lines(answer);
        on_lines.extend(extreme_points(answer));
        Ok(MapContents { answer, map, trace, walls, frequencies: found, on_lines, published })
    }

    /// The picture at a size, with or without its title.
    pub fn draw(&self, width: f64, height: f64, titled: bool) -> MapFigure {
        Drawing::new(self, width, height, titled).finish()
    }
}

/// A picture in the making.
pub(super) struct Drawing<'a> {
    pub contents: &'a MapContents<'a>,
    pub scene: Scene,
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    /// Rectangles that words stand in: left, top, right, bottom.
    pub taken: Vec<(f64, f64, f64, f64)>,
    /// Where dots are.
    pub dots: Vec<(f64, f64)>,
    /// Mechanisms that are named beside a wall.
    pub named: Vec<String>,
}

impl<'a> Drawing<'a> {
    fn new(contents: &'a MapContents<'a>, width: f64, height: f64, titled: bool) -> Self {
        let mut drawing = Drawing {
            contents,
            scene: Scene::new(width, height),
            left: 66.0,
            top: 0.0,
            width: width - 66.0 - 18.0,
            height: 0.0,
            taken: Vec::new(),
            dots: Vec::new(),
            named: Vec::new(),
        };
        let narrow = width < 500.0;
        let title = if titled { drawing.title() } else { String::new() };
        let size = if narrow { 13 } else { 14 };
        let mut y = if titled { 22.0 } else { 14.0 };
        for line in broken(&title, (width - 20.0) / (f64::from(size) * 0.6)).iter().filter(|l| !l.is_empty()) {
            drawing.text((width / 2.0, y), line, size, TextAnchor::Middle, INK);
            y += 18.0;
        }
        y = drawing.legend(y + 2.0);
        drawing.top = y + 8.0;
        drawing.height = height - drawing.top - 50.0;
        drawing
    }

    fn title(&self) -> String {
        let answer = self.contents.answer;
        let asked = goal_or_stable(answer.problem());
        let what = if asked == "stable" { "Stable region".to_owned() } else { format!("Region of {asked}") };
        match answer.problem().title().filter(|t| !t.is_empty()) {
            Some(title) => format!("{what}: {}", visible(title)),
            None => what,
        }
    }

    fn finish(mut self) -> MapFigure {
        self.region();
        self.frame();
        self.lines_through_nominal();
        let edges: Vec<usize> = (0..self.contents.walls.len()).collect();
        for role in [Role::Count, Role::Stable] {
            for &k in edges.iter().filter(|k| self.contents.walls[**k].role == role) {
                self.wall(k);
            }
        }
        self.marks();
        self.limits_on_lines();
        for &k in edges.iter().filter(|k| self.contents.walls[**k].role == Role::Stable) {
            self.labels(k);
        }
        let plot = (self.left, self.top, self.width, self.height);
        MapFigure { figure: Figure::new(self.scene), plot }
    }

    pub(super) fn at(&self, (u, v): (f64, f64)) -> (f64, f64) {
        (self.left + u * self.width, self.top + (1.0 - v) * self.height)
    }

    /// The stable cells, filled as one path so that no seams show between strips.
    fn region(&mut self) {
        let (contents, mut d) = (self.contents, String::new());
        let edge = |end: &Option<Rational>, otherwise: f64| {
            end.as_ref().map_or(otherwise, |e| contents.trace.windows[1].place(e.to_f64_approximate()))
        };
        let domain = &contents.answer.problem().free()[1].domain;
        let (bottom, top) = (edge(&domain.lower, -1.0), edge(&domain.upper, 2.0));
        for traced in &contents.trace.strips {
            let cells = &contents.map.strips[traced.strip].cells;
            for (number, _) in cells.iter().enumerate().filter(|(_, cell)| cell.stable) {
                let below = |v: &[f64]| number.checked_sub(1).map_or(bottom, |k| v[k]);
                let above = |v: &[f64]| v.get(number).copied().unwrap_or(top);
                let upper = traced.lines.iter().map(|l| (l.u, above(&l.v)));
                let lower = traced.lines.iter().rev().map(|l| (l.u, below(&l.v)));
                let points: Vec<(f64, f64)> =
                    upper.chain(lower).map(|(u, v)| self.at((u, v.clamp(0.0, 1.0)))).collect();
                let visible = traced.lines.iter().any(|l| above(&l.v) > 0.0 && below(&l.v) < 1.0);
                if visible {
                    d.push_str(&path(&points));
                    d.push('Z');
                }
            }
        }
        if !d.is_empty() {
            self.scene.add(Primitive::Path(Box::new(PathData {
                d,
                fill: Some(Color::from(REGION)),
                stroke: Color::from("none"),
                stroke_width: 0.0,
                opacity: None,
                stroke_dasharray: None,
            })));
        }
    }

    /// Grid, frame, ticks and names of the axes.
    fn frame(&mut self) {
        let windows = &self.contents.trace.windows;
        let x_ticks = ticks(&windows[0], (self.width / 90.0).max(3.0));
        let y_ticks = ticks(&windows[1], (self.height / 50.0).max(3.0));
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        let length = |t: &Tick| if t.label.is_some() { 6.0 } else { 3.0 };
        for t in &x_ticks {
            let x = self.left + t.place * self.width;
            if t.label.is_some() && t.place > 0.001 && t.place < 0.999 {
                self.line((x, self.top), (x, bottom), GRID, 0.6, None);
            }
            self.line((x, bottom), (x, bottom + length(t)), INK, 1.0, None);
        }
        for t in &y_ticks {
            let y = bottom - t.place * self.height;
            if t.label.is_some() && t.place > 0.001 && t.place < 0.999 {
                self.line((self.left, y), (right, y), GRID, 0.6, None);
            }
            self.line((self.left - length(t), y), (self.left, y), INK, 1.0, None);
        }
        let mut last = f64::NEG_INFINITY;
        for (t, label) in x_ticks.iter().filter_map(|t| Some((t, t.label.as_ref()?))) {
            let x = self.left + t.place * self.width;
            let half = label.chars().count() as f64 * CHARACTER / 2.0;
            if x - half > last + 6.0 {
                self.text((x, bottom + 19.0), label, 11, TextAnchor::Middle, INK);
                last = x + half;
            }
        }
        for (t, label) in y_ticks.iter().filter_map(|t| Some((t, t.label.as_ref()?))) {
            let y = bottom - t.place * self.height;
            self.text((self.left - 9.0, y + 4.0), label, 11, TextAnchor::End, INK);
        }
        for (a, b) in [
            ((self.left, self.top), (right, self.top)),
            ((right, self.top), (right, bottom)),
            ((self.left, bottom), (right, bottom)),
            ((self.left, self.top), (self.left, bottom)),
        ] {
            self.line(a, b, INK, 1.0, None);
        }
        let axes = &self.contents.answer.problem().free();
        let (x_name, y_name) = (axis_name(&axes[0]), axis_name(&axes[1]));
        self.text((self.left + self.width / 2.0, bottom + 40.0), &x_name, 12, TextAnchor::Middle, INK);
        self.scene.add(Primitive::Text {
            x: 16.0,
            y: self.top + self.height / 2.0,
            content: y_name,
            size: 12,
            anchor: TextAnchor::Middle,
            rotate: Some(-90.0),
            bold: false,
            color: Some(Color::from(INK)),
        });
    }

    pub(super) fn nominal(&self) -> Option<(f64, f64)> {
        let [Some(x), Some(y)] = [0, 1].map(|k| self.contents.answer.problem().free()[k].nominal.as_ref()) else {
            return None;
        };
        let windows = &self.contents.trace.windows;
        let at = (windows[0].place(x.to_f64_approximate()), windows[1].place(y.to_f64_approximate()));
        let inside = |v: f64| (0.0..=1.0).contains(&v);
        (inside(at.0) && inside(at.1)).then_some(at)
    }

    fn lines_through_nominal(&mut self) {
        let Some((u, v)) = self.nominal() else { return };
        for (a, b) in [((u, 0.0), (u, 1.0)), ((0.0, v), (1.0, v))] {
            let (a, b) = (self.at(a), self.at(b));
            self.line(a, b, FAINT, 0.8, Some("2 3"));
        }
    }

    fn marks(&mut self) {
        let windows = &self.contents.trace.windows;
        for &(x, y) in &self.contents.published {
            let at = (windows[0].place(x), windows[1].place(y));
            if (0.0..=1.0).contains(&at.0) && (0.0..=1.0).contains(&at.1) {
                let at = self.at(at);
                self.circle(at);
                self.taken.push((at.0 - 6.0, at.1 - 6.0, at.0 + 6.0, at.1 + 6.0));
            }
        }
        if let Some(at) = self.nominal() {
            let at = self.at(at);
            self.diamond(at);
            self.taken.push((at.0 - 7.0, at.1 - 7.0, at.0 + 7.0, at.1 + 7.0));
        }
    }

    fn wall(&mut self, k: usize) {
        let wall = &self.contents.walls[k];
        let (colour, dashes) = mechanism_colour(&self.contents.map.curves[wall.curve].causes);
        let width = if wall.role == Role::Stable { 2.2 } else { 0.9 };
        let window = Window { x: (0.0, 1.0), y: (0.0, 1.0) };
        for piece in window.pieces(&wall.points) {
            let points = thinned(piece.into_iter().map(|p| self.at(p)).collect());
            for points in dashed(points, dashes) {
                self.scene.add(Primitive::PolyLine {
                    points,
                    stroke: Color::from(colour),
                    stroke_width: width,
                    stroke_dasharray: None,
                });
            }
        }
    }
}

/// `K_pwm / V`.
pub(super) fn axis_name(axis: &Free) -> String {
    match axis.unit.as_deref().filter(|u| !u.is_empty()) {
        Some(unit) => format!("{} / {}", axis.name, visible(unit)),
        None => axis.name.clone(),
    }
}
