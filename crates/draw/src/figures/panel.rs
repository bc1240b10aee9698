//! A panel: axes with curves, marks and words; and figures of several panels.

use super::axes::{Axis, BELOW, Frame, Heading, Scale};
use super::clip::Window;
use super::legend::{self, Entry, Sample};
use super::placing::Occupied;
use super::{FAINT_INK, Figure, INK};
use crate::scene::{Anchor, Colour, Point, Rectangle, Scene, Stroke, Words, width};

/// A line through points.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// The points.
    pub points: Vec<(f64, f64)>,
    /// Its entry in the legend, if it has one.
    pub label: Option<String>,
    /// Colour, as in CSS.
    pub colour: String,
    /// Width in units of the picture.
    pub width: f64,
    /// Whether it is dashed.
    pub dashed: bool,
    /// Whether arrow heads say in which direction it goes.
    pub arrows: bool,
}

/// Shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// x, a pole of an open loop.
    Cross,
    /// o, a zero of an open loop.
    Circle,
    /// +
    Plus,
    /// A small filled circle.
    Dot,
    /// A filled square.
    Square,
    /// A filled triangle.
    Triangle,
    /// A filled diamond.
    Diamond,
}

/// A mark at a point.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Where.
    pub at: (f64, f64),
    /// What it looks like.
    pub shape: Shape,
    /// Colour, as in CSS.
    pub colour: String,
    /// Its entry in the legend, if it has one.
    pub label: Option<String>,
}

/// Words in the panel, with an arrow to what they are about.
#[derive(Clone, Debug)]
pub struct Text {
    /// The words.
    pub text: String,
    /// Where they stand: the middle of the line.
    pub at: (f64, f64),
    /// What they point at.
    pub target: Option<(f64, f64)>,
}

/// Axes with what is drawn between them.
///
/// Labels of axes end with their unit in parentheses: `frequency (Hz)`. On a linear axis the numbers are given with a
/// prefix that suits them, and the label says so; on a logarithmic axis each number has its own.
///
/// ```
/// use jurist_draw::figures::{Curve, Panel, Scale};
/// let gain = Curve { points: vec![(1.0, 0.0), (1e4, -80.0)], colour: "#0072B2".into(), width: 1.5, ..Curve::default() };
/// let panel = Panel {
///     x_label: "frequency (Hz)".into(),
///     y_label: "gain (dB)".into(),
///     x: (1.0, 1e4),
///     y: (-80.0, 20.0),
///     x_scale: Scale::Logarithmic,
///     curves: vec![gain],
///     levels: vec![(0.0, "0 dB".into())],
///     ..Panel::default()
/// };
/// assert!(panel.figure(500.0, 300.0).svg().contains(">10 kHz</text>"));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Above the axes.
    pub title: String,
    /// Smaller words below the title.
    pub notes: Vec<String>,
    /// Along x, with the unit; as [`Axis::labelled`].
    pub x_label: String,
    /// Along y, with the unit.
    pub y_label: String,
    /// Ends of the x axis.
    pub x: (f64, f64),
    /// Ends of the y axis.
    pub y: (f64, f64),
    /// How values lie along x.
    pub x_scale: Scale,
    /// How values lie along y.
    pub y_scale: Scale,
    /// The curves, drawn in order.
    pub curves: Vec<Curve>,
    /// The marks, drawn over the curves.
    pub marks: Vec<Mark>,
    /// The words, drawn over all.
    pub texts: Vec<Text>,
    /// Horizontal dashed lines with their labels.
    pub levels: Vec<(f64, String)>,
    /// Vertical dashed lines with their labels.
    pub verticals: Vec<(f64, String)>,
    /// Whether a unit is as long in x as in y.
    pub equal: bool,
    /// Where the legend stands; none if `None`.
    pub legend: Option<Corner>,
}

/// Where a legend stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Upper right.
    TopRight,
    /// Lower right.
    BottomRight,
    /// Upper left.
    TopLeft,
    /// Lower left.
    BottomLeft,
    /// In rows above the axes, where it covers nothing.
    Above,
}

/// Right of the axes.
const RIGHT: f64 = 20.0;
const DASHES: [f64; 2] = [5.0, 4.0];
const TEXT: f64 = 11.0;

impl Panel {
    fn axes(&self) -> (Axis, Axis) {
        (Axis::labelled(&self.x_label, self.x, self.x_scale), Axis::labelled(&self.y_label, self.y, self.y_scale))
    }

    /// How much room the left side needs at a height.
    fn left(&self, height: f64) -> f64 {
        Frame::left_of(&self.axes().1, height - BELOW)
    }

    /// The entries of the legend, each once; what is not to be seen brings none.
    fn entries(&self, window: &Window) -> Vec<Entry> {
        let mut out: Vec<Entry> = Vec::new();
        let mut enter = |sample: Sample, label: &str| {
            if !label.is_empty() && !out.iter().any(|e| e.1 == label) {
                out.push((sample, label.to_owned()));
            }
        };
        for curve in &self.curves {
            if let Some(label) = curve.label.as_deref().filter(|_| !window.pieces(&self.placed(curve)).is_empty()) {
                enter(Sample::Line(stroke(curve)), label);
            }
        }
        for mark in self.marks.iter().filter(|m| window.contains(self.place(m.at))) {
            if let Some(label) = &mark.label {
                enter(Sample::Mark(mark.shape, Colour::css(&mark.colour)), label);
            }
        }
        out
    }

    /// Places from 0 to 1 of values.
    fn place(&self, (x, y): Point) -> Point {
        let (x_axis, y_axis) = self.axes();
        (x_axis.place(x), y_axis.place(y))
    }

    fn placed(&self, curve: &Curve) -> Vec<Point> {
        let (x, y) = self.axes();
        curve.points.iter().map(|p| (x.place(p.0), y.place(p.1))).collect()
    }

    /// The panel in a scene of its own; the axes begin at `left` where that is given.
    fn render(&self, width: f64, height: f64, left: Option<f64>) -> Scene {
        let mut scene = Scene::new(width, height);
        let window = Window { x: (0.0, 1.0), y: (0.0, 1.0) };
        let entries = if self.legend.is_some() { self.entries(&window) } else { Vec::new() };
        let heading = Heading { title: self.title.clone(), notes: self.notes.clone() };
        let mut top = heading.draw(&mut scene);
        let left = left.unwrap_or_else(|| self.left(height));
        let room = width - left - RIGHT;
        if self.legend == Some(Corner::Above) {
            top = legend::in_rows(&mut scene, &entries, (left, top), room);
        }
        top += 6.0;
        let mut plot = Rectangle { left, top, width: room.max(20.0), height: (height - top - BELOW).max(20.0) };
        if self.equal {
            let (across, up) = (self.x.1 - self.x.0, self.y.1 - self.y.0);
            let unit = (plot.width / across).min(plot.height / up);
            plot.left += (plot.width - unit * across) / 2.0;
            (plot.width, plot.height) = (unit * across, unit * up);
        }
        let (x, y) = self.axes();
        let frame = Frame { x, y, plot, equal: self.equal };
        frame.draw(&mut scene);
        self.reference_lines(&mut scene, &frame);
        let mut occupied = self.lines_across(&frame);
        for curve in &self.curves {
            for piece in window.pieces(&self.placed(curve)) {
                let points = apart(piece.into_iter().map(|p| frame.at_places(p)).collect());
                scene.polyline(&points, stroke(curve));
                if curve.arrows {
                    arrow_heads(&mut scene, &points, Colour::css(&curve.colour));
                }
                occupied.curve(points);
            }
        }
        for mark in self.marks.iter().filter(|m| window.contains(self.place(m.at))) {
            legend::mark(&mut scene, mark.shape, Colour::css(&mark.colour), frame.at(mark.at));
            occupied.mark(frame.at(mark.at));
        }
        self.labels(&mut scene, &frame, occupied);
        if let Some(corner) = self.legend.filter(|c| *c != Corner::Above && !entries.is_empty()) {
            let (w, h) = legend::box_size(&entries);
            let right = plot.right() - w - 8.0;
            let bottom = plot.bottom() - h - 8.0;
            let at = match corner {
                Corner::TopRight | Corner::Above => (right, plot.top + 8.0),
                Corner::BottomRight => (right, bottom),
                Corner::TopLeft => (plot.left + 8.0, plot.top + 8.0),
                Corner::BottomLeft => (plot.left + 8.0, bottom),
            };
            legend::in_box(&mut scene, &entries, at);
        }
        scene
    }

    fn reference_lines(&self, scene: &mut Scene, frame: &Frame) {
        let (left, right, top, bottom) = (frame.plot.left, frame.plot.right(), frame.plot.top, frame.plot.bottom());
        let line = || Stroke::new(FAINT_INK, 0.9).dashed(&DASHES);
        let inside = |v: f64| (0.0..=1.0).contains(&v);
        let words = |text: &str, at: Point| Words::new(text, at, TEXT, FAINT_INK).with_halo(Colour::WHITE);
        for (level, label) in self.levels.iter().filter(|(v, _)| inside(frame.y.place(*v))) {
            let y = frame.at((self.x.0, *level)).1;
            scene.line((left, y), (right, y), line());
            let above = if y - 16.0 > top { y - 4.0 } else { y + 13.0 };
            scene.words(words(label, (right - 6.0, above)).anchored(Anchor::End));
        }
        for (value, label) in self.verticals.iter().filter(|(v, _)| inside(frame.x.place(*v))) {
            let x = frame.at((*value, self.y.0)).0;
            scene.line((x, top), (x, bottom), line());
            let length = width(label, TEXT);
            let fits = x + length + 10.0 < right;
            let (at, anchor) = if fits { (x + 5.0, Anchor::Start) } else { (x - 5.0, Anchor::End) };
            scene.words(words(label, (at, bottom - 7.0)).anchored(anchor));
        }
    }

    /// The dashed lines as what words had rather not cover.
    fn lines_across(&self, frame: &Frame) -> Occupied {
        let mut occupied = Occupied::default();
        self.levels.iter().for_each(|(level, _)| occupied.level(frame.at((self.x.0, *level)).1));
        self.verticals.iter().for_each(|(value, _)| occupied.vertical(frame.at((*value, self.y.0)).0));
        occupied
    }

    /// The words with their arrows, kept inside the axes and off the curves.
    fn labels(&self, scene: &mut Scene, frame: &Frame, mut occupied: Occupied) {
        for text in &self.texts {
            let half = width(&text.text, TEXT) / 2.0;
            let target = text.target.map(|t| frame.at(t));
            let (x, y) = occupied.place(&text.text, TEXT, frame.at(text.at), target, &frame.plot);
            if let Some(target) = target {
                // From the nearest point of the words' rectangle.
                let beside = target.1.clamp(y - 10.0, y + 4.0);
                let from_side = (target.0 - x).abs() > half;
                let from = (
                    target.0.clamp(x - half, x + half),
                    if from_side {
                        beside
                    } else if target.1 > y {
                        y + 4.0
                    } else {
                        y - 10.0
                    },
                );
                pointer(scene, from, target);
            }
            let words = Words::new(&text.text, (x, y), TEXT, INK).anchored(Anchor::Middle);
            scene.words(words.with_halo(Colour::WHITE));
        }
    }

    /// The panel alone as a figure.
    pub fn figure(&self, width: f64, height: f64) -> Figure {
        self.render(width, height, None).into()
    }
}

fn stroke(curve: &Curve) -> Stroke {
    let stroke = Stroke::new(Colour::css(&curve.colour), curve.width);
    if curve.dashed { stroke.dashed(&DASHES) } else { stroke }
}

/// Pixels from arrow head to arrow head along a curve; a shorter curve has one in its middle, a very short one none.
const BETWEEN_HEADS: f64 = 200.0;
const LEAST_WITH_HEAD: f64 = 30.0;

/// Arrow heads along a polyline.
fn arrow_heads(scene: &mut Scene, points: &[Point], colour: Colour) {
    let length_of = |pair: &[Point]| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
    let whole: f64 = points.windows(2).map(length_of).sum();
    if whole < LEAST_WITH_HEAD {
        return;
    }
    let count = (whole / BETWEEN_HEADS).round().max(1.0);
    let (mut next, mut passed) = (0.5 * whole / count, 0.0);
    for pair in points.windows(2) {
        let length = length_of(pair);
        while length > 0.0 && next <= passed + length {
            let t = (next - passed) / length;
            let (ux, uy) = ((pair[1].0 - pair[0].0) / length, (pair[1].1 - pair[0].1) / length);
            let (x, y) = (pair[0].0 + t * (pair[1].0 - pair[0].0), pair[0].1 + t * (pair[1].1 - pair[0].1));
            let corner = |along: f64, aside: f64| (x + along * ux - aside * uy, y + along * uy + aside * ux);
            scene.polygon(&[corner(5.5, 0.0), corner(-4.5, 4.0), corner(-4.5, -4.0)], Some(colour), None);
            next += whole / count;
        }
        passed += length;
    }
}

/// A thin line that ends beside what it points at.
fn pointer(scene: &mut Scene, from: Point, target: Point) {
    let (dx, dy) = (target.0 - from.0, target.1 - from.1);
    let length = dx.hypot(dy);
    if length > 14.0 {
        let end = (target.0 - 7.0 * dx / length, target.1 - 7.0 * dy / length);
        scene.line(from, end, Stroke::new(INK, 0.8));
    }
}

/// Without points that are nowhere near a pixel from the one before.
pub(super) fn apart(points: Vec<Point>) -> Vec<Point> {
    let mut out: Vec<Point> = Vec::with_capacity(points.len());
    let last = points.len().saturating_sub(1);
    for (k, p) in points.into_iter().enumerate() {
        let near = out.last().is_some_and(|q: &Point| (q.0 - p.0).hypot(q.1 - p.1) < 0.3);
        if !near || k == last {
            out.push(p);
        }
    }
    out
}

/// Panels one below the other, each `width` by `height`; their axes begin at the same place.
pub fn stacked(panels: &[Panel], width: f64, height: f64) -> Figure {
    let left = panels.iter().map(|p| p.left(height)).fold(0.0, f64::max);
    let mut whole = Scene::new(width, height * panels.len().max(1) as f64);
    for (k, panel) in panels.iter().enumerate() {
        whole.place((0.0, k as f64 * height), panel.render(width, height, Some(left)));
    }
    whole.into()
}

/// Panels side by side, each `width` by `height`.
pub fn side_by_side(panels: &[Panel], width: f64, height: f64) -> Figure {
    let mut whole = Scene::new(width * panels.len().max(1) as f64, height);
    for (k, panel) in panels.iter().enumerate() {
        whole.place((k as f64 * width, 0.0), panel.render(width, height, None));
    }
    whole.into()
}
