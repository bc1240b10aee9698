//! The drawing: region, domain, walls, marks, axes.

use super::super::axes::{BELOW, Frame, Heading};
use super::super::clip::Window;
use super::super::facts::heading;
use super::super::legend::{self, hatched};
use super::super::panel::{Shape, apart};
use super::super::{FAINT, Figure, INK};
use super::labels::{FrequencyPoint, extreme_points, frequencies, limits_on_lines, spaced};
use super::layers::Layers;
use super::lines::{Role, Wall, mechanism_colour, walls};
use super::trace::MapTrace;
use super::window::AxisWindow;
use super::{REGION, UNSTABLE};
use crate::scene::{Item, Point, Rectangle, Scene, Segment, Stroke, through};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::error::Error;
use jurist_engine::problem::Problem;
use jurist_engine::stability::plane::{StabilityMap, Strip};
use jurist_show::region::goal_or_stable;

/// Frequencies for the page are this far apart.
const FINE_SPACING: f64 = 14.0;
/// Right of the axes.
const RIGHT: f64 = 18.0;

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
    pub(super) layers: Option<Layers<'a>>,
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
    /// [`Error::Stopped`] when the budget runs out.
    pub fn new(
        answer: &'a Answer<Map>,
        trace: &'a MapTrace,
        published: Vec<(f64, f64)>,
        budget: &Budget,
    ) -> Result<Self, Error> {
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
        let layers = |found| Layers::new(found, &answer.problem().free()[1].domain, trace.windows.clone(), budget);
        let layers = answer.value().required.as_ref().map(layers).transpose()?;
        Ok(MapContents { answer, map, trace, layers, walls, frequencies: found, on_lines, published })
    }

    /// The windows of both axes.
    pub fn windows(&self) -> &[AxisWindow; 2] {
        &self.trace.windows
    }

    /// The picture at a size, with or without its title.
    pub fn draw(&self, width: f64, height: f64, titled: bool) -> MapFigure {
        let entries = self.legend().0;
        let head = if titled { Head::Title(&entries) } else { Head::Legend(&entries) };
        Drawing::new(self, width, height, &head).finish()
    }

    /// The picture under a legend that several have, so that their axes are in the same place.
    pub fn draw_under(&self, width: f64, height: f64, legend: &Legend) -> MapFigure {
        Drawing::new(self, width, height, &Head::Legend(&legend.0)).finish()
    }

    /// The picture as one of several on common axes: a caption above it, no legend, no words beside walls.
    pub(super) fn draw_among(&self, width: f64, height: f64, caption: &str) -> Scene {
        let mut drawing = Drawing::new(self, width, height, &Head::Caption(caption));
        drawing.shapes();
        drawing.scene
    }

    /// The legend of the picture.
    pub(super) fn legend(&self) -> Legend {
        Legend(self.entries())
    }

    /// Where the nominal point is, if the window shows it.
    pub(super) fn nominal(&self) -> Option<Point> {
        let [Some(x), Some(y)] = [0, 1].map(|k| self.answer.problem().free()[k].nominal.as_ref()) else {
            return None;
        };
        let windows = &self.trace.windows;
        let at = (windows[0].place(x.to_f64_approximate()), windows[1].place(y.to_f64_approximate()));
        inside(at).then_some(at)
    }

    /// The domain in places of the window: left, lower, right, upper, each from 0 to 1.
    pub(super) fn domain(&self) -> [f64; 4] {
        let end = |k: usize, end: &Option<Rational>, otherwise: f64| {
            end.as_ref().map_or(otherwise, |e| self.trace.windows[k].place(e.to_f64_approximate())).clamp(0.0, 1.0)
        };
        let of = |k: usize| &self.answer.problem().free()[k].domain;
        [end(0, &of(0).lower, 0.0), end(1, &of(1).lower, 0.0), end(0, &of(0).upper, 1.0), end(1, &of(1).upper, 1.0)]
    }

    /// Whether the window shows points outside the domain.
    pub(super) fn leaves_domain(&self) -> bool {
        self.domain() != [0.0, 0.0, 1.0, 1.0]
    }
}

/// `Stable region`, or the region that was asked for.
pub(super) fn what(problem: &Problem) -> String {
    let asked = goal_or_stable(problem);
    if asked == "stable" { "Stable region".to_owned() } else { format!("Region of {asked}") }
}

/// Samples of what is drawn with their names.
#[derive(Debug)]
pub struct Legend(pub(super) Vec<legend::Entry>);

/// What stands above the axes.
enum Head<'a> {
    /// Title, values, legend.
    Title(&'a [legend::Entry]),
    /// The legend.
    Legend(&'a [legend::Entry]),
    /// A line of words.
    Caption(&'a str),
}

/// A picture in the making.
pub(super) struct Drawing<'a> {
    pub contents: &'a MapContents<'a>,
    pub scene: Scene,
    pub frame: Frame,
    /// Rectangles that words stand in: left, top, right, bottom.
    pub taken: Vec<(f64, f64, f64, f64)>,
    /// Lines from words to their points.
    pub leaders: Vec<(Point, Point)>,
    /// Where dots are.
    pub dots: Vec<Point>,
    /// What is written beside walls: each once.
    pub said: Vec<String>,
}

impl<'a> Drawing<'a> {
    fn new(contents: &'a MapContents<'a>, width: f64, height: f64, head: &Head<'_>) -> Self {
        let problem = contents.answer.problem();
        let [x, y] = [0, 1].map(|k| contents.trace.windows[k].axis(&problem.free()[k]));
        let mut scene = Scene::new(width, height);
        let mut top = match head {
            Head::Title(_) => heading(&what(problem), problem).draw(&mut scene),
            Head::Legend(_) => 4.0,
            Head::Caption(text) => Heading { title: (*text).to_owned(), notes: Vec::new() }.draw(&mut scene) + 5.0,
        };
        let left = Frame::left_of(&y, height - top - BELOW);
        let plot = Rectangle { left, top: 0.0, width: width - left - RIGHT, height: 0.0 };
        let mut drawing = Drawing {
            contents,
            scene,
            frame: Frame { x, y, plot, equal: false },
            taken: Vec::new(),
            leaders: Vec::new(),
            dots: Vec::new(),
            said: Vec::new(),
        };
        if let Head::Title(entries) | Head::Legend(entries) = head {
            top = legend::in_rows(&mut drawing.scene, entries, (14.0, top + 2.0), width - 28.0) + 6.0;
        }
        drawing.frame.plot.top = top;
        drawing.frame.plot.height = (height - top - BELOW).max(20.0);
        drawing
    }

    fn finish(mut self) -> MapFigure {
        self.shapes();
        self.limits_on_lines();
        for k in (0..self.contents.walls.len()).filter(|k| self.contents.walls[*k].role == Role::Stable) {
            self.labels(k);
        }
        let plot = self.frame.plot;
        MapFigure { figure: self.scene.into(), plot: (plot.left, plot.top, plot.width, plot.height) }
    }

    /// Everything but the words beside walls.
    fn shapes(&mut self) {
        self.ground();
        self.region();
        self.layers();
        let frame = self.frame.clone();
        frame.draw(&mut self.scene);
        self.lines_through_nominal();
        let edges: Vec<usize> = (0..self.contents.walls.len()).collect();
        for role in [Role::Count, Role::Stable] {
            for &k in edges.iter().filter(|k| self.contents.walls[**k].role == role) {
                self.wall(k);
            }
        }
        self.layer_edges();
        self.marks();
    }

    pub(super) fn at(&self, place: Point) -> Point {
        self.frame.at_places(place)
    }

    /// Unstable is what lies in the domain and is nothing else; beside it the domain ends, with a line.
    fn ground(&mut self) {
        let [left, lower, right, upper] = self.contents.domain();
        let rectangle = |a: Point, b: Point| Rectangle { left: a.0, top: a.1, width: b.0 - a.0, height: b.1 - a.1 };
        let whole = self.frame.plot;
        let inside = rectangle(self.at((left, upper)), self.at((right, lower)));
        if self.contents.leaves_domain() {
            hatched(&mut self.scene, &whole);
        }
        if inside.width > 0.0 && inside.height > 0.0 {
            self.scene.rectangle(&inside, Some(UNSTABLE), None);
            if self.contents.leaves_domain() {
                self.scene.rectangle(&inside, None, Some(Stroke::new(FAINT, 1.5)));
            }
        }
    }

    /// The stable cells, filled as one path so that no seams show between strips.
    fn region(&mut self) {
        let contents = self.contents;
        let strips = &contents.map.strips;
        let segments = self.cells(contents.trace, strips, |strip, cell| strips[strip].cells[cell].stable);
        if !segments.is_empty() {
            self.scene.add(Item::Path { segments, fill: Some(REGION), stroke: None });
        }
    }

    /// The outlines of the cells that are kept, by the numbers of their strip and of themselves in it.
    pub(super) fn cells(
        &self,
        trace: &MapTrace,
        strips: &[Strip],
        keep: impl Fn(usize, usize) -> bool,
    ) -> Vec<Segment> {
        let [_, bottom, _, top] = self.contents.domain();
        let mut segments = Vec::new();
        for traced in &trace.strips {
            for number in (0..strips[traced.strip].cells.len()).filter(|&cell| keep(traced.strip, cell)) {
                let below = |v: &[f64]| number.checked_sub(1).map_or(bottom, |k| v[k]);
                let above = |v: &[f64]| v.get(number).copied().unwrap_or(top);
                let upper = traced.lines.iter().map(|l| (l.u, above(&l.v)));
                let lower = traced.lines.iter().rev().map(|l| (l.u, below(&l.v)));
                let points: Vec<Point> = upper.chain(lower).map(|(u, v)| self.at((u, v.clamp(0.0, 1.0)))).collect();
                if traced.lines.iter().any(|l| above(&l.v) > 0.0 && below(&l.v) < 1.0) {
                    segments.extend(through(&apart(points), true));
                }
            }
        }
        segments
    }

    pub(super) fn nominal(&self) -> Option<Point> {
        self.contents.nominal()
    }

    fn lines_through_nominal(&mut self) {
        let Some((u, v)) = self.nominal() else { return };
        for (a, b) in [((u, 0.0), (u, 1.0)), ((0.0, v), (1.0, v))] {
            self.scene.line(
                self.frame.at_places(a),
                self.frame.at_places(b),
                Stroke::new(FAINT, 0.8).dashed(&[2.0, 3.0]),
            );
        }
    }

    fn marks(&mut self) {
        let windows = &self.contents.trace.windows;
        let published = self.contents.published.iter().map(|&(x, y)| (windows[0].place(x), windows[1].place(y)));
        let marks = published.filter(|at| inside(*at)).map(|at| (at, Shape::Circle));
        for (at, shape) in marks.chain(self.nominal().map(|at| (at, Shape::Diamond))) {
            let at = self.at(at);
            legend::mark(&mut self.scene, shape, INK, at);
            self.taken.push((at.0 - 7.0, at.1 - 7.0, at.0 + 7.0, at.1 + 7.0));
        }
    }

    fn wall(&mut self, k: usize) {
        let wall = &self.contents.walls[k];
        let stroke = wall_stroke(wall, self.contents.map);
        let window = Window { x: (0.0, 1.0), y: (0.0, 1.0) };
        for piece in window.pieces(&wall.points) {
            let points = apart(piece.into_iter().map(|p| self.at(p)).collect());
            self.scene.add(Item::Path { segments: through(&points, false), fill: None, stroke: Some(stroke.clone()) });
        }
    }
}

/// How a wall is drawn.
pub(super) fn wall_stroke(wall: &Wall, map: &StabilityMap) -> Stroke {
    let (colour, dashes) = mechanism_colour(&map.curves[wall.curve].causes);
    let width = if wall.role == Role::Stable { 2.2 } else { 0.9 };
    Stroke::new(crate::scene::Colour::css(colour), width).dashed(dashes)
}

/// Whether a place is in the window.
pub(super) fn inside((u, v): Point) -> bool {
    (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)
}
