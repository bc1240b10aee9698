//! The drawing: region, walls, labels, marks, axes, legend.

use super::super::Figure;
use super::super::clip::Window;
use super::axes::{Tick, ticks};
use super::labels::{FrequencyPoint, extreme_points, frequencies, frequency_text, frequency_unit, limits_on_lines, spaced, words};
use super::lines::{Role, Wall, mechanism_colour, walls};
use super::trace::MapTrace;
use crate::analysis::{Axis, Intervals, Map, RegionExtent};
use crate::limits::{Budget, Exhausted};
use crate::number::Rational;
use crate::report::layout::goal;
use crate::stability::plane::StabilityMap;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

pub(super) const INK: &str = "#222222";
const FAINT: &str = "#999999";
const GRID: &str = "#e4e4e4";
const PAPER: &str = "#ffffff";
const REGION: &str = "#cfe8d8";
/// Width of a character of the text in the figure, on average.
const CHARACTER: f64 = 5.8;
/// What a wall under words weighs; less is bearable.
const WORST: usize = 4;
/// Frequencies along a wall are this far apart.
const LABEL_SPACING: f64 = 170.0;
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
    answer: &'a Map,
    map: &'a StabilityMap,
    trace: &'a MapTrace,
    /// The walls.
    pub walls: Vec<Wall>,
    /// For each wall, frequencies along it.
    pub frequencies: Vec<Vec<FrequencyPoint>>,
    /// The exact limits on the lines through the nominal point, and the extreme values of the regions.
    on_lines: Vec<((f64, f64), String)>,
    /// Published limits to compare with, in the parameters' units.
    pub published: Vec<(f64, f64)>,
}

impl<'a> MapContents<'a> {
    /// Walls and frequencies of a traced map; `None` while it is undecided. `slices` are the stable sets on the
    /// lines through the nominal point, `limits` the extreme values of the regions, as far as they are known.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn new(
        answer: &'a Map,
        trace: &'a MapTrace,
        slices: &[Intervals],
        limits: &[RegionExtent],
        published: Vec<(f64, f64)>,
        budget: &Budget,
    ) -> Result<Option<Self>, Exhausted> {
        let Some(map) = answer.map.decided() else { return Ok(None) };
        let walls = walls(answer, map, trace);
        budget.step("frequencies along the walls");
        let mut found = Vec::with_capacity(walls.len());
        for wall in &walls {
            budget.check()?;
            let points = spaced(wall, (760.0, 440.0), FINE_SPACING);
            found.push(frequencies(answer, map, wall, &points, budget)?);
        }
        let mut on_lines = limits_on_lines(slices, answer);
        on_lines.extend(extreme_points(limits, answer));
        Ok(Some(MapContents { answer, map, trace, walls, frequencies: found, on_lines, published }))
    }

    /// The picture at a size, with or without its title.
    pub fn draw(&self, width: f64, height: f64, titled: bool) -> MapFigure {
        Drawing::new(self, width, height, titled).finish()
    }
}

struct Drawing<'a> {
    contents: &'a MapContents<'a>,
    scene: Scene,
    left: f64,
    top: f64,
    width: f64,
    height: f64,
    /// Rectangles that words stand in: left, top, right, bottom.
    taken: Vec<(f64, f64, f64, f64)>,
    /// Mechanisms that are named beside a wall.
    named: Vec<String>,
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
        let asked = goal(answer);
        let what = if asked == "stable" { "Stable region".to_owned() } else { format!("Region of {asked}") };
        match answer.title.as_deref().filter(|t| !t.is_empty()) {
            Some(title) => format!("{what}: {title}"),
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

    fn at(&self, (u, v): (f64, f64)) -> (f64, f64) {
        (self.left + u * self.width, self.top + (1.0 - v) * self.height)
    }

    /// The stable cells, filled as one path so that no seams show between strips.
    fn region(&mut self) {
        let (contents, mut d) = (self.contents, String::new());
        let edge = |end: &Option<Rational>, otherwise: f64| {
            end.as_ref().map_or(otherwise, |e| contents.trace.windows[1].place(e.to_f64_approximate()))
        };
        let domain = &contents.answer.axes[1].domain;
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
        let axes = &self.contents.answer.axes;
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

    fn nominal(&self) -> Option<(f64, f64)> {
        let [Some(x), Some(y)] = [0, 1].map(|k| self.contents.answer.axes[k].nominal.as_ref()) else { return None };
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

    /// A dot and the exact value at a limit on a line through the nominal point and at extreme points.
    fn limits_on_lines(&mut self) {
        let contents = self.contents;
        let windows = &contents.trace.windows;
        let mut done: Vec<((f64, f64), &str)> = Vec::new();
        for ((x, y), text) in &contents.on_lines {
            let at = (windows[0].place(*x), windows[1].place(*y));
            let shown = (0.0..=1.0).contains(&at.0) && (0.0..=1.0).contains(&at.1);
            let again = |d: &((f64, f64), &str)| d.1 == text && (d.0.0 - at.0).abs().max((d.0.1 - at.1).abs()) < 0.01;
            if shown && !done.iter().any(again) {
                done.push((at, text));
                let at = self.at(at);
                if !self.place_words(at, text, INK, true) {
                    self.place_words_far(at, text);
                }
            }
        }
    }

    fn circle(&mut self, at: (f64, f64)) {
        self.scene.add(Primitive::Circle {
            cx: at.0,
            cy: at.1,
            r: 4.5,
            fill: Color::from(PAPER),
            fill_opacity: None,
            stroke: Some(Color::from(INK)),
            stroke_width: Some(1.5),
        });
    }

    fn diamond(&mut self, (x, y): (f64, f64)) {
        let d = format!("{}Z", path(&[(x, y - 6.0), (x + 6.0, y), (x, y + 6.0), (x - 6.0, y)]));
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: Some(Color::from(INK)),
            stroke: Color::from(PAPER),
            stroke_width: 1.0,
            opacity: None,
            stroke_dasharray: None,
        })));
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

    /// The frequency at some points of a wall, and the mechanism once.
    fn labels(&mut self, k: usize) {
        let contents = self.contents;
        let wall = &contents.walls[k];
        let name = words(contents.answer, contents.map, wall);
        let (colour, _) = mechanism_colour(&contents.map.curves[wall.curve].causes);
        // Once in the picture is enough, and the legend has it too.
        let mut named = self.named.contains(&name);
        let known = &contents.frequencies[k];
        let unit = frequency_unit(contents.answer);
        let chosen = spaced(wall, (self.width, self.height), LABEL_SPACING);
        for point in chosen {
            let nearest = known.iter().min_by_key(|f| f.point.abs_diff(point));
            let (point, text) = match nearest {
                Some(f) if named => (f.point, frequency_text(f.value, unit)),
                Some(f) => (f.point, format!("{name}, {}", frequency_text(f.value, unit))),
                None if named => continue,
                None => (point, name.clone()),
            };
            let at = self.at(wall.points[point]);
            if self.place_words(at, &text, colour, !known.is_empty()) {
                if !named {
                    self.named.push(name.clone());
                }
                named = true;
            } else if let Some(f) = nearest {
                // Without the name there may be room.
                self.place_words(at, &frequency_text(f.value, unit), colour, true);
            }
        }
    }

    /// Words beside a point of a wall where nothing else is: outside the region first.
    fn place_words(&mut self, at: (f64, f64), text: &str, colour: &str, dot: bool) -> bool {
        let half = text.chars().count() as f64 * CHARACTER / 2.0 + 3.0;
        let mut best: Option<(usize, (f64, f64))> = None;
        let (beside, over, under) = (half + 8.0, -15.0, 19.0);
        let offsets = [
            (0.0, over),
            (0.0, under),
            (beside, 3.0),
            (-beside, 3.0),
            (half, over),
            (half, under),
            (-half, over),
            (-half, under),
        ];
        for (dx, dy) in offsets {
            let centre = (at.0 + dx, at.1 + dy);
            let room = (centre.0 - half, centre.1 - 12.0, centre.0 + half, centre.1 + 4.0);
            let inside = room.0 > self.left + 2.0
                && room.2 < self.left + self.width - 2.0
                && room.1 > self.top + 2.0
                && room.3 < self.top + self.height - 2.0;
            let free = self.taken.iter().all(|t| room.2 < t.0 || room.0 > t.2 || room.3 < t.1 || room.1 > t.3);
            if inside && free {
                let crossed = self.crossings(room);
                if best.as_ref().is_none_or(|b| crossed < b.0) {
                    best = Some((crossed, centre));
                }
            }
        }
        let Some((_, centre)) = best.filter(|b| b.0 < WORST) else { return false };
        self.taken.push((centre.0 - half, centre.1 - 12.0, centre.0 + half, centre.1 + 4.0));
        if dot {
            self.dot(at, colour);
        }
        self.text(centre, text, 11, TextAnchor::Middle, INK);
        true
    }

    /// Words farther away, with a thin line to their point.
    fn place_words_far(&mut self, at: (f64, f64), text: &str) {
        let half = text.chars().count() as f64 * CHARACTER / 2.0 + 3.0;
        for distance in [36.0, 60.0, 90.0] {
            for (side, down) in [(0.0, -1.0), (0.0, 1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let target = (at.0 + side * half * 0.8, at.1 + down * distance);
                let taken = self.taken.len();
                if self.place_words((target.0, target.1 + 12.0), text, INK, false) {
                    let room = self.taken[taken];
                    let y = if room.1 > at.1 { room.1 + 1.0 } else { room.3 };
                    let x = at.0.clamp(room.0 + 4.0, room.2 - 4.0);
                    self.line(at, (x, y), INK, 0.7, None);
                    self.dot(at, INK);
                    return;
                }
            }
        }
        self.dot(at, INK);
    }

    fn dot(&mut self, at: (f64, f64), colour: &str) {
        self.scene.add(Primitive::Circle {
            cx: at.0,
            cy: at.1,
            r: 2.6,
            fill: Color::from(colour),
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        });
    }

    /// How much lies under a rectangle: the length of walls, and the lines through the nominal point.
    fn crossings(&self, room: (f64, f64, f64, f64)) -> usize {
        let window = Window { x: (room.0, room.2), y: (room.1, room.3) };
        let walls = self.contents.walls.iter().filter(|w| w.role != Role::Nothing);
        let crossed = |w: &Wall| {
            let points: Vec<(f64, f64)> = w.points.iter().map(|p| self.at(*p)).collect();
            window.pieces(&points).len()
        };
        let lines = self.nominal().map(|at| self.at(at)).map_or(0, |at| {
            usize::from(at.0 > room.0 && at.0 < room.2) + usize::from(at.1 > room.1 && at.1 < room.3)
        });
        WORST * walls.map(crossed).sum::<usize>() + lines
    }

    /// Samples of what is drawn with their names; returns where the next line of text would stand.
    fn legend(&mut self, from: f64) -> f64 {
        let contents = self.contents;
        let mut entries: Vec<(Entry, String)> = Vec::new();
        if !contents.map.regions.is_empty() {
            entries.push((Entry::Region, format!("{} (certified)", goal(contents.answer))));
        }
        let seen = |role: Role| {
            let on_screen = |w: &&Wall| w.points.iter().any(|p| (0.0..=1.0).contains(&p.0) && (0.0..=1.0).contains(&p.1));
            contents.walls.iter().filter(move |w| w.role == role).filter(on_screen)
        };
        for wall in seen(Role::Stable) {
            let causes = &contents.map.curves[wall.curve].causes;
            let name = words(contents.answer, contents.map, wall);
            if !entries.iter().any(|e| e.1 == name) {
                let (colour, dashes) = mechanism_colour(causes);
                entries.push((Entry::Line(colour, dashes, 2.2), name));
            }
        }
        if seen(Role::Count).next().is_some() {
            entries.push((Entry::Line(FAINT, None, 0.9), "other changes of the root count".into()));
        }
        if self.nominal().is_some() {
            entries.push((Entry::Nominal, "nominal".into()));
        }
        if !contents.published.is_empty() {
            entries.push((Entry::Published, "published limits".into()));
        }
        let (start, end) = (14.0, self.left + self.width + 10.0);
        let (mut x, mut y) = (start, from);
        for (entry, name) in entries {
            let length = 30.0 + name.chars().count() as f64 * CHARACTER + 16.0;
            if x > start && x + length > end + 14.0 {
                (x, y) = (start, y + 17.0);
            }
            let middle = (x + 12.0, y - 4.0);
            match entry {
                Entry::Region => self.scene.add(Primitive::Rect {
                    x,
                    y: y - 10.0,
                    width: 24.0,
                    height: 12.0,
                    fill: Color::from(REGION),
                    stroke: None,
                    stroke_width: None,
                    opacity: None,
                }),
                Entry::Line(colour, dashes, width) => {
                    for dash in dashed(vec![(x, y - 4.0), (x + 24.0, y - 4.0)], dashes) {
                        self.line(dash[0], dash[1], colour, width, None);
                    }
                }
                Entry::Nominal => self.diamond(middle),
                Entry::Published => self.circle(middle),
            }
            self.text((x + 30.0, y), &name, 11, TextAnchor::Start, INK);
            x += length;
        }
        y
    }

    fn line(&mut self, a: (f64, f64), b: (f64, f64), colour: &str, width: f64, dashes: Option<&str>) {
        self.scene.add(Primitive::Line {
            x1: a.0,
            y1: a.1,
            x2: b.0,
            y2: b.1,
            stroke: Color::from(colour),
            stroke_width: width,
            stroke_dasharray: dashes.map(str::to_owned),
        });
    }

    fn text(&mut self, at: (f64, f64), text: &str, size: u32, anchor: TextAnchor, colour: &str) {
        self.scene.add(Primitive::Text {
            x: at.0,
            y: at.1,
            content: text.to_owned(),
            size,
            anchor,
            rotate: None,
            bold: false,
            color: Some(Color::from(colour)),
        });
    }
}

/// What stands before a name of the legend.
enum Entry {
    Region,
    Line(&'static str, Option<&'static str>, f64),
    Nominal,
    Published,
}

/// `K_pwm / V`.
pub(super) fn axis_name(axis: &Axis) -> String {
    match axis.unit.as_deref().filter(|u| !u.is_empty()) {
        Some(unit) => format!("{} / {unit}", axis.name),
        None => axis.name.clone(),
    }
}

fn path(points: &[(f64, f64)]) -> String {
    let mut d = String::with_capacity(points.len() * 14);
    for (k, (x, y)) in thinned(points.to_vec()).iter().enumerate() {
        d.push_str(if k == 0 { "M" } else { "L" });
        d.push_str(&format!("{x:.2},{y:.2}"));
    }
    d
}

/// Without points that are nowhere near a pixel from the one before.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut out: Vec<(f64, f64)> = Vec::with_capacity(points.len());
    let last = points.len().saturating_sub(1);
    for (k, p) in points.into_iter().enumerate() {
        let near = out.last().is_some_and(|q: &(f64, f64)| (q.0 - p.0).hypot(q.1 - p.1) < 0.3);
        if !near || k == last {
            out.push(p);
        }
    }
    out
}

/// A line cut into its dashes, whose lengths and gaps are given as in SVG.
fn dashed(points: Vec<(f64, f64)>, pattern: Option<&str>) -> Vec<Vec<(f64, f64)>> {
    let lengths: Vec<f64> = pattern.map_or_else(Vec::new, |p| p.split(' ').filter_map(|v| v.parse().ok()).collect());
    if lengths.is_empty() {
        return vec![points];
    }
    let (mut k, mut left) = (0, lengths[0]);
    let mut out: Vec<Vec<(f64, f64)>> = points.first().map(|p| vec![*p]).into_iter().collect();
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            let t = if length > left { left / length } else { 1.0 };
            let reached = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            if k % 2 == 0 && let Some(dash) = out.last_mut() {
                dash.push(reached);
            }
            if length <= left {
                left -= length;
                break;
            }
            k = (k + 1) % lengths.len();
            left = lengths[k];
            if k % 2 == 0 {
                out.push(vec![reached]);
            }
            from = reached;
        }
    }
    out.retain(|dash| dash.len() > 1);
    out
}

/// Lines of at most `width` characters.
fn broken(text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().expect("there is a line");
        if !last.is_empty() && (last.chars().count() + 1 + word.chars().count()) as f64 > width {
            lines.push(word.to_owned());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}
