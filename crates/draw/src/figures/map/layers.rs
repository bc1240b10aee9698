//! Where requirements are met: shades of the stable ground, and a line around each.

use super::super::legend::{Entry, Sample};
use super::super::panel::apart;
use super::super::{COLOURS, clip::Window};
use super::draw::{Drawing, MapContents};
use super::trace::{MapTrace, TracedStrip, trace};
use super::window::AxisWindow;
use super::{MET, REGION};
use crate::scene::{Colour, Item, Point, Stroke, through};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_engine::response::{RequiredMap, Requirement};
use jurist_engine::stability::Range;
use jurist_engine::stability::plane::Strip;

/// Vertical edges shorter than this, in heights of the picture, come of lines that are drawn beside walls.
const SHORTEST: f64 = 0.004;

/// The traced curves of requirements and of stability together.
#[derive(Debug)]
pub(super) struct Layers<'a> {
    found: &'a RequiredMap,
    trace: MapTrace,
    /// For each requirement the lines around its regions, in places of the window.
    edges: Vec<Vec<Vec<Point>>>,
}

impl<'a> Layers<'a> {
    pub fn new(
        found: &'a RequiredMap,
        y_domain: &Range,
        windows: [AxisWindow; 2],
        budget: &Budget,
    ) -> Result<Self, Exhausted> {
        let trace = trace(&found.all().map, y_domain, windows, budget)?;
        let edges = found.regions.iter().take(found.requirements.len());
        let edges = edges.map(|set| edges_of(&set.map.strips, &trace)).collect();
        Ok(Layers { found, trace, edges })
    }

    /// The greatest number of requirements that are met together somewhere in the picture.
    fn most(&self) -> usize {
        let strips = &self.found.all().map.strips;
        let cells = self.trace.strips.iter().flat_map(|t| (0..strips[t.strip].cells.len()).map(|c| (t.strip, c)));
        cells.map(|cell| self.found.met(cell).len()).max().unwrap_or(0)
    }

    fn name(&self, k: usize) -> String {
        let words = |r: &Requirement| r.text().replace('_', " ").replace(">=", "\u{2265}").replace("<=", "\u{2264}");
        words(&self.found.requirements[k])
    }
}

/// The ground where some of several requirements are met.
fn shade(met: usize, of: usize) -> Colour {
    let part = met as f64 / of as f64;
    let mix = |from: u8, to: u8| (f64::from(from) + (f64::from(to) - f64::from(from)) * part).round() as u8;
    Colour(mix(REGION.0, MET.0), mix(REGION.1, MET.1), mix(REGION.2, MET.2))
}

fn stroke(k: usize) -> Stroke {
    let dashes: [&[f64]; 4] = [&[], &[7.0, 3.0], &[2.0, 2.0], &[9.0, 3.0, 2.0, 3.0]];
    // The first colour is that of complex pairs on walls.
    Stroke::new(Colour::css(COLOURS[1 + k % (COLOURS.len() - 1)]), 1.4).dashed(dashes[(k / 5) % dashes.len()])
}

/// Where cells of the set end at others.
fn edges_of(strips: &[Strip], trace: &MapTrace) -> Vec<Vec<Point>> {
    let mut out: Vec<Vec<Point>> = Vec::new();
    for traced in &trace.strips {
        for (number, pair) in strips[traced.strip].cells.windows(2).enumerate() {
            if pair[0].stable != pair[1].stable {
                out.push(traced.lines.iter().map(|l| (l.u, l.v[number])).collect());
            }
        }
    }
    for pair in trace.strips.windows(2).filter(|p| p[0].strip + 1 == p[1].strip) {
        out.extend(vertical(strips, &pair[0], &pair[1]));
    }
    joined(out)
}

/// Where one side of a wall between strips is in the set and the other is not.
fn vertical(strips: &[Strip], left: &TracedStrip, right: &TracedStrip) -> Vec<Vec<Point>> {
    let (Some(a), Some(b)) = (left.lines.last(), right.lines.first()) else { return Vec::new() };
    let mut cuts: Vec<f64> = a.v.iter().chain(&b.v).copied().filter(|v| (0.0..=1.0).contains(v)).collect();
    cuts.extend([0.0, 1.0]);
    cuts.sort_by(f64::total_cmp);
    let within = |strip: &TracedStrip, v: &[f64], at: f64| {
        let cell = v.iter().filter(|w| **w < at).count();
        strips[strip.strip].cells.get(cell).is_some_and(|c| c.stable)
    };
    let differs = |p: &&[f64]| {
        let at = f64::midpoint(p[0], p[1]);
        p[1] - p[0] > SHORTEST && within(left, &a.v, at) != within(right, &b.v, at)
    };
    cuts.windows(2).filter(differs).map(|p| vec![(a.u, p[0]), (a.u, p[1])]).collect()
}

/// Lines that go on where others end, as one.
fn joined(lines: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    let close = |a: &Point, b: &Point| (a.0 - b.0).abs() < 1e-5 && (a.1 - b.1).abs() < SHORTEST;
    let mut out: Vec<Vec<Point>> = Vec::new();
    for line in lines {
        let goes_on = |known: &&mut Vec<Point>| known.last().zip(line.first()).is_some_and(|(a, b)| close(a, b));
        match out.iter_mut().rev().find(goes_on) {
            Some(known) => known.extend(line),
            None => out.push(line),
        }
    }
    out
}

impl Drawing<'_> {
    /// The ground of cells, darker the more requirements are met.
    pub(super) fn layers(&mut self) {
        let contents = self.contents;
        let Some(layers) = &contents.layers else { return };
        let found = layers.found;
        for level in 1..=found.requirements.len() {
            let strips = &found.all().map.strips;
            let segments = self.cells(&layers.trace, strips, |strip, cell| found.met((strip, cell)).len() == level);
            if !segments.is_empty() {
                let fill = shade(level, found.requirements.len());
                // A thin edge of the same colour leaves no seams between neighbouring cells.
                self.scene.add(Item::Path { segments, fill: Some(fill), stroke: Some(Stroke::new(fill, 0.5)) });
            }
        }
    }

    /// The line around the regions of each requirement.
    pub(super) fn layer_edges(&mut self) {
        let contents = self.contents;
        let Some(layers) = &contents.layers else { return };
        let window = Window { x: (0.0, 1.0), y: (0.0, 1.0) };
        for (k, edges) in layers.edges.iter().enumerate() {
            for piece in edges.iter().flat_map(|line| window.pieces(line)) {
                let points = apart(piece.into_iter().map(|p| self.at(p)).collect());
                self.scene.add(Item::Path { segments: through(&points, false), fill: None, stroke: Some(stroke(k)) });
            }
        }
    }
}

impl MapContents<'_> {
    /// The samples of layers for the legend.
    pub(super) fn layer_entries(&self) -> Vec<Entry> {
        let Some(layers) = &self.layers else { return Vec::new() };
        let (of, most) = (layers.found.requirements.len(), layers.most());
        let mut out = Vec::new();
        for met in 1..=most {
            let words = match (met == of, of) {
                (true, 1) => "requirement met".to_owned(),
                (true, _) => "all requirements met".to_owned(),
                (false, _) => format!("{met} of {of} met"),
            };
            out.push((Sample::Area(shade(met, of)), words));
        }
        for (k, edges) in layers.edges.iter().enumerate() {
            let name = layers.name(k);
            out.push((Sample::Line(stroke(k)), if edges.is_empty() { format!("{name}: nowhere here") } else { name }));
        }
        out
    }
}
