//! A drawing as data: paths, circles, words, groups; written as SVG, PNG, PDF or in characters.
//!
//! Lengths are in units that are pixels at scale 1, counted from the upper left corner. The same scene gives the
//! same bytes on every machine: nothing of the machine is measured, words are set with the font in this crate.

mod colour;
pub(crate) mod font;
#[cfg(feature = "pdf")]
mod pdf;
#[cfg(feature = "png")]
mod png;
mod svg;
mod terminal;
mod words;

pub use colour::Colour;
pub use words::{Anchor, Words, width};

/// A place: to the right, and down.
pub type Point = (f64, f64);

/// A part of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    /// Begins a new part.
    Move(Point),
    /// A straight line.
    Line(Point),
    /// A cubic curve: two control points and the end.
    Cubic(Point, Point, Point),
    /// Back to the beginning of the part.
    Close,
}

/// How a line is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub colour: Colour,
    /// Width.
    pub width: f64,
    /// Lengths of dashes and gaps in turn; a whole line where empty.
    pub dashes: Vec<f64>,
}

impl Stroke {
    /// A whole line.
    pub fn new(colour: Colour, width: f64) -> Stroke {
        Stroke { colour, width, dashes: Vec::new() }
    }

    /// The same in dashes.
    pub fn dashed(self, dashes: &[f64]) -> Stroke {
        Stroke { dashes: dashes.to_vec(), ..self }
    }
}

/// A rectangle: left, top, width, height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Rectangle {
    /// Right edge.
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Lower edge.
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Its outline.
    pub fn outline(&self) -> Vec<Segment> {
        let (l, t, r, b) = (self.left, self.top, self.right(), self.bottom());
        vec![Segment::Move((l, t)), Segment::Line((r, t)), Segment::Line((r, b)), Segment::Line((l, b)), Segment::Close]
    }
}

/// A thing that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// Lines and areas; areas are filled where the winding number is not 0.
    Path {
        /// Its parts.
        segments: Vec<Segment>,
        /// The colour inside.
        fill: Option<Colour>,
        /// The line along it.
        stroke: Option<Stroke>,
    },
    /// A circle.
    Circle {
        /// Centre.
        centre: Point,
        /// Radius.
        radius: f64,
        /// The colour inside.
        fill: Option<Colour>,
        /// The line along it.
        stroke: Option<Stroke>,
    },
    /// A line of words.
    Words(Words),
    /// Things that are one letter where letters are all there is.
    Sign {
        /// The letter.
        letter: &'static str,
        /// Its colour.
        colour: Colour,
        /// Where it stands.
        at: Point,
        /// The things.
        items: Vec<Item>,
    },
    /// What samples mean. In characters it stands below the picture, where its names do not run into one another.
    Legend {
        /// The samples as letters, with their colours and names.
        entries: Vec<(&'static str, Colour, String)>,
        /// The same as it is drawn elsewhere.
        items: Vec<Item>,
    },
    /// Things that are moved together, and cut at a rectangle (in their own coordinates).
    Group {
        /// How far they are moved.
        offset: Point,
        /// What of them is seen; all if `None`.
        clip: Option<Rectangle>,
        /// The things.
        items: Vec<Item>,
    },
}

/// A drawing in the making: the later covers the earlier.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
    /// What is drawn, in order.
    pub items: Vec<Item>,
}

impl Scene {
    /// An empty drawing on white ground.
    ///
    /// ```
    /// use jurist_draw::scene::{Colour, Scene, Stroke};
    /// let mut scene = Scene::new(100.0, 50.0);
    /// scene.polyline(&[(0.0, 0.0), (100.0, 50.0)], Stroke::new(Colour::BLACK, 1.0));
    /// assert!(scene.svg("figure").contains("<path d=\"M0 0L100 50\""));
    /// ```
    pub fn new(width: f64, height: f64) -> Scene {
        Scene { width, height, items: Vec::new() }
    }

    /// Adds a thing.
    pub fn add(&mut self, item: Item) {
        self.items.push(item);
    }

    /// A straight line.
    pub fn line(&mut self, a: Point, b: Point, stroke: Stroke) {
        self.polyline(&[a, b], stroke);
    }

    /// Straight lines through points; nothing for fewer than two.
    pub fn polyline(&mut self, points: &[Point], stroke: Stroke) {
        if points.len() > 1 {
            self.add(Item::Path { segments: through(points, false), fill: None, stroke: Some(stroke) });
        }
    }

    /// A polygon.
    pub fn polygon(&mut self, points: &[Point], fill: Option<Colour>, stroke: Option<Stroke>) {
        self.add(Item::Path { segments: through(points, true), fill, stroke });
    }

    /// A rectangle.
    pub fn rectangle(&mut self, rectangle: &Rectangle, fill: Option<Colour>, stroke: Option<Stroke>) {
        self.add(Item::Path { segments: rectangle.outline(), fill, stroke });
    }

    /// A circle.
    pub fn circle(&mut self, centre: Point, radius: f64, fill: Option<Colour>, stroke: Option<Stroke>) {
        self.add(Item::Circle { centre, radius, fill, stroke });
    }

    /// Words; an index is written `K_pwm` and stands below.
    pub fn words(&mut self, words: Words) {
        self.add(Item::Words(words));
    }

    /// All of another scene, its upper left corner at a place.
    pub fn place(&mut self, offset: Point, other: Scene) {
        self.add(Item::Group { offset, clip: None, items: other.items });
    }

    /// What `draw` adds is a letter in characters.
    pub fn sign(&mut self, letter: &'static str, colour: Colour, at: Point, draw: impl FnOnce(&mut Scene)) {
        let mut inner = Scene::new(self.width, self.height);
        draw(&mut inner);
        self.add(Item::Sign { letter, colour, at, items: inner.items });
    }

    /// What `draw` adds is a legend.
    pub fn legend(&mut self, entries: Vec<(&'static str, Colour, String)>, draw: impl FnOnce(&mut Scene)) {
        let mut inner = Scene::new(self.width, self.height);
        draw(&mut inner);
        self.add(Item::Legend { entries, items: inner.items });
    }

    /// What `draw` adds is seen inside the rectangle only.
    pub fn clipped(&mut self, clip: Rectangle, draw: impl FnOnce(&mut Scene)) {
        let mut inner = Scene::new(self.width, self.height);
        draw(&mut inner);
        self.add(Item::Group { offset: (0.0, 0.0), clip: Some(clip), items: inner.items });
    }
}

/// The segments through points.
pub fn through(points: &[Point], closed: bool) -> Vec<Segment> {
    let mut segments: Vec<Segment> =
        points.iter().enumerate().map(|(k, p)| if k == 0 { Segment::Move(*p) } else { Segment::Line(*p) }).collect();
    if closed && !segments.is_empty() {
        segments.push(Segment::Close);
    }
    segments
}
