//! Scenes in characters: lines as dots of Braille letters, words as words.

use super::words::Anchor;
use super::{Colour, Item, Point, Scene, Segment, Words};

/// Dots of a letter: two across, four down.
const DOTS: (usize, usize) = (2, 4);

/// Words are put so many letters further right at most, where others stand in their place.
const FURTHER: usize = 16;

/// What a place of the screen shows.
#[derive(Clone, Copy, Default)]
struct Cell {
    dots: u8,
    letter: Option<char>,
    colour: Option<Colour>,
}

struct Screen {
    columns: usize,
    rows: usize,
    cells: Vec<Cell>,
    /// Columns and rows per unit.
    scale: (f64, f64),
}

impl Scene {
    /// The scene in characters, for a terminal of that many columns and rows. Areas, and lines in a colour of
    /// `hidden`, would hide what is behind them and are left out; a colour of `plain` is left to the terminal, whose
    /// own text may be white. Without `colours` there are no escape sequences at all.
    pub fn characters(&self, size: (usize, usize), colours: bool, hidden: &[Colour], plain: &[Colour]) -> String {
        let (columns, rows) = (size.0.max(1), size.1.max(1));
        let scale = (columns as f64 / self.width.max(1.0), rows as f64 / self.height.max(1.0));
        let mut screen = Screen { columns, rows, cells: vec![Cell::default(); columns * rows], scale };
        // Words after lines, which would strike them through; turned ones last, for they find room at the sides of others.
        for layer in [Layer::Lines, Layer::Words, Layer::Turned] {
            screen.items(&self.items, (0.0, 0.0), hidden, layer);
        }
        let mut entries = Vec::new();
        legends(&self.items, &mut entries);
        screen.legend(&entries);
        screen.text(colours, plain)
    }
}

/// What is drawn in one pass.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Layer {
    Lines,
    Words,
    Turned,
}

/// An entry of a legend: its sample, the sample's colour, its name.
type Entry = (&'static str, Colour, String);

/// The entries of all legends, each once.
fn legends<'a>(items: &'a [Item], out: &mut Vec<&'a Entry>) {
    for item in items {
        match item {
            Item::Legend { entries, .. } => {
                let new = entries.iter().filter(|e| !out.iter().any(|known| known.2 == e.2)).collect::<Vec<_>>();
                out.extend(new);
            }
            Item::Group { items, .. } => legends(items, out),
            _ => {}
        }
    }
}

/// Letters from where an axis begins to its title, at most.
const ASIDE: usize = 4;

impl Screen {
    fn items(&mut self, items: &[Item], at: Point, hidden: &[Colour], layer: Layer) {
        let is_lines = layer == Layer::Lines;
        for item in items {
            match item {
                Item::Path { segments, fill, stroke } => {
                    let colour = stroke.as_ref().map(|s| s.colour).or(*fill);
                    let colour = colour.filter(|c| is_lines && *c != Colour::WHITE && !hidden.contains(c));
                    if let Some(colour) = colour {
                        self.path(segments, at, colour);
                    }
                }
                Item::Circle { centre, fill, stroke, .. } => {
                    let colour = fill.filter(|c| *c != Colour::WHITE).or(stroke.as_ref().map(|s| s.colour));
                    if let Some(colour) = colour.filter(|_| is_lines) {
                        let letter = if fill.is_some_and(|c| c != Colour::WHITE) { '●' } else { '○' };
                        self.letter((centre.0 + at.0, centre.1 + at.1), letter, colour);
                    }
                }
                Item::Words(line) if line.turned && layer == Layer::Turned => self.turned(line, at),
                Item::Words(line) if !line.turned && layer == Layer::Words => self.words(line, at),
                Item::Words(_) | Item::Legend { .. } => {}
                Item::Sign { letter, colour, at: (x, y), .. } => {
                    for letter in letter.chars().take(if is_lines { 1 } else { 0 }) {
                        self.letter((x + at.0, y + at.1), letter, *colour);
                    }
                }
                Item::Group { offset, items, .. } => {
                    self.items(items, (at.0 + offset.0, at.1 + offset.1), hidden, layer);
                }
            }
        }
    }

    fn cell(&mut self, column: f64, row: f64) -> Option<&mut Cell> {
        let inside = column >= 0.0 && row >= 0.0 && column < self.columns as f64 && row < self.rows as f64;
        inside.then(|| &mut self.cells[row as usize * self.columns + column as usize])
    }

    fn letter(&mut self, at: Point, letter: char, colour: Colour) {
        let (column, row) = (at.0 * self.scale.0, at.1 * self.scale.1);
        if let Some(cell) = self.cell(column, row) {
            *cell = Cell { letter: Some(letter), colour: Some(colour), ..*cell };
        }
    }

    fn path(&mut self, segments: &[Segment], at: Point, colour: Colour) {
        let (mut first, mut last) = ((0.0, 0.0), (0.0, 0.0));
        for segment in segments {
            let to = match segment {
                Segment::Move(p) => {
                    (first, last) = (*p, *p);
                    continue;
                }
                Segment::Line(p) | Segment::Cubic(_, _, p) => *p,
                Segment::Close => first,
            };
            self.line((last.0 + at.0, last.1 + at.1), (to.0 + at.0, to.1 + at.1), colour);
            last = to;
        }
    }

    fn line(&mut self, a: Point, b: Point, colour: Colour) {
        let dots = |p: Point| (p.0 * self.scale.0 * DOTS.0 as f64, p.1 * self.scale.1 * DOTS.1 as f64);
        let (a, b) = (dots(a), dots(b));
        let length = (b.0 - a.0).abs().max((b.1 - a.1).abs());
        if !length.is_finite() {
            return;
        }
        let steps = length.ceil().clamp(1.0, 1e4) as usize;
        for k in 0..=steps {
            let t = k as f64 / steps as f64;
            let (x, y) = (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
            if let Some(cell) = self.cell(x / DOTS.0 as f64, y / DOTS.1 as f64) {
                // The order of the dots in a Braille letter: three down on both sides, then the last row.
                let (column, row) = (x as usize % DOTS.0, y as usize % DOTS.1);
                cell.dots |= 1 << if row < 3 { row + 3 * column } else { 6 + column };
                cell.colour = Some(colour);
            }
        }
    }

    fn words(&mut self, words: &Words, at: Point) {
        let letters: Vec<char> = words.text.chars().collect();
        let length = letters.len() as f64;
        let before = match words.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => length / 2.0,
            Anchor::End => length,
        };
        let (x, y) = ((words.at.0 + at.0) * self.scale.0, (words.at.1 + at.1) * self.scale.1);
        // The middle of a letter's height is above its base line.
        let wanted = (x.floor() - before.floor(), (y - 0.25 * words.size * self.scale.1).floor());
        // Words for which there is no place would hide others.
        let Some((column, row)) = self.free_place(wanted, letters.len()) else { return };
        for (k, letter) in letters.into_iter().enumerate() {
            self.put((column + k as f64, row), letter, words.colour);
        }
    }

    /// Words along a vertical axis, left of where others stand.
    fn turned(&mut self, words: &Words, at: Point) {
        let letters: Vec<char> = words.text.chars().collect();
        let (x, y) = ((words.at.0 + at.0) * self.scale.0, (words.at.1 + at.1) * self.scale.1);
        let row = |k: usize| (y + (letters.len() as f64 / 2.0).floor() - k as f64 - 0.5).floor();
        let columns = (0..=ASIDE).map(|by| x.floor() - by as f64).filter(|c| *c >= 0.0);
        let mut free = columns.filter(|c| (0..letters.len()).all(|k| !self.is_lettered((*c, row(k)))));
        let column = free.next().unwrap_or(x.floor());
        for (k, letter) in letters.iter().enumerate() {
            self.put((column, row(k)), *letter, words.colour);
        }
    }

    /// Rows below the picture with samples and their names.
    fn legend(&mut self, entries: &[&Entry]) {
        let mut column = self.columns;
        for (sample, colour, name) in entries {
            let letters: Vec<char> = sample.chars().chain(" ".chars()).chain(name.chars()).collect();
            if column + letters.len() > self.columns {
                self.rows += 1;
                self.cells.resize(self.rows * self.columns, Cell::default());
                column = 1;
            }
            let row = self.rows as f64 - 1.0;
            let of_sample = sample.chars().count();
            for (k, letter) in letters.iter().enumerate() {
                let colour = if k < of_sample { *colour } else { Colour::BLACK };
                self.put(((column + k) as f64, row), *letter, colour);
            }
            column += letters.len() + 3;
        }
    }

    fn put(&mut self, place: Point, letter: char, colour: Colour) {
        if let Some(cell) = self.cell(place.0, place.1) {
            *cell = Cell { letter: Some(letter), colour: Some(colour), ..*cell };
        }
    }

    fn is_lettered(&mut self, place: Point) -> bool {
        self.cell(place.0, place.1).is_some_and(|cell| cell.letter.is_some())
    }

    /// Where so many letters meet no others: at the place that is wanted, else further right, else in the rows next to it. Letters are larger
    /// than the words of a scene, so that what stands side by side there may not do so here.
    fn free_place(&mut self, wanted: Point, length: usize) -> Option<Point> {
        let right = (0..=FURTHER).map(|k| (wanted.0 + k as f64, wanted.1));
        let rows = [1.0, -1.0, 2.0, 3.0, 4.0].map(|by| (wanted.0, wanted.1 + by));
        let is_inside = |(column, row): Point, screen: &Screen| {
            column >= 0.0 && column + length as f64 <= screen.columns as f64 && row >= 0.0 && row < screen.rows as f64
        };
        right.chain(rows).enumerate().map(|(k, place)| (k == 0, place)).find_map(|(is_first, (column, row))| {
            let is_clear = (0..length + 2).all(|k| !self.is_lettered((column + k as f64 - 1.0, row)));
            // What is cut off at the edge of the screen stays where it is.
            (is_clear && (is_first || is_inside((column, row), self))).then_some((column, row))
        })
    }

    fn text(&self, colours: bool, plain: &[Colour]) -> String {
        let mut out = String::new();
        for row in self.cells.chunks(self.columns) {
            let end = row.iter().rposition(|c| c.dots != 0 || c.letter.is_some_and(|l| l != ' ')).map_or(0, |k| k + 1);
            let mut current = None;
            for cell in &row[..end] {
                let shown = cell.letter.unwrap_or_else(|| match cell.dots {
                    0 => ' ',
                    dots => char::from_u32(0x2800 + u32::from(dots)).unwrap_or(' '),
                });
                let colour = cell.colour.filter(|c| colours && shown != ' ' && !plain.contains(c));
                if colour != current && shown != ' ' {
                    if current.is_some() {
                        out.push_str("\u{1b}[0m");
                    }
                    if let Some(Colour(r, g, b)) = colour {
                        out.push_str(&format!("\u{1b}[38;2;{r};{g};{b}m"));
                    }
                    current = colour;
                }
                out.push(shown);
            }
            if current.is_some() {
                out.push_str("\u{1b}[0m");
            }
            out.push('\n');
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::super::Stroke;
    use super::*;

    #[test]
    fn lines_are_dots_and_words_are_words() {
        let mut scene = Scene::new(8.0, 8.0);
        scene.line((0.1, 0.1), (7.9, 0.1), Stroke::new(Colour(1, 2, 3), 1.0));
        scene.words(Words::new("ab", (0.0, 7.0), 2.0, Colour::BLACK));
        assert_eq!(scene.characters((4, 2), false, &[], &[]), "⠉⠉⠉⠉\nab\n");
        let coloured = scene.characters((4, 2), true, &[], &[Colour::BLACK]);
        assert_eq!(coloured, "\u{1b}[38;2;1;2;3m⠉⠉⠉⠉\u{1b}[0m\nab\n");
    }

    #[test]
    fn words_do_not_run_into_one_another() {
        let mut scene = Scene::new(40.0, 8.0);
        for (text, x) in [("unit circle", 0.0), ("stable", 8.0), ("not stable", 16.0)] {
            scene.words(Words::new(text, (x, 3.0), 2.0, Colour::BLACK));
        }
        let shown = scene.characters((32, 4), false, &[], &[]);
        assert!(["unit circle", "stable", "not stable"].iter().all(|text| shown.contains(text)), "{shown}");
        assert!(shown.contains("unit circle stable"), "{shown}");
    }

    #[test]
    fn a_legend_stands_below_and_signs_are_letters() {
        let mut scene = Scene::new(30.0, 4.0);
        let entries = vec![("──", Colour(1, 2, 3), "unit circle".to_owned()), ("×", Colour::BLACK, "poles".to_owned())];
        for _ in 0..2 {
            scene.legend(entries.clone(), |s| s.words(Words::new("unit circle", (0.0, 3.0), 2.0, Colour::BLACK)));
        }
        scene.sign("×", Colour::BLACK, (10.0, 1.0), |s| {
            s.line((0.0, 0.0), (30.0, 4.0), Stroke::new(Colour::BLACK, 1.0))
        });
        assert_eq!(scene.characters((30, 2), false, &[], &[]), "          ×\n\n ── unit circle   × poles\n");
        assert_eq!(scene.characters((16, 1), false, &[], &[]), "     ×\n ── unit circle\n × poles\n");
        assert!(scene.svg("f").contains("unit circle") && scene.svg("f").contains("M0 0L30 4"));
    }

    #[test]
    fn the_title_of_an_axis_stands_beside_its_numbers() {
        let mut scene = Scene::new(8.0, 8.0);
        scene.words(Words::new("y", (3.0, 4.0), 1.0, Colour::BLACK).turned());
        scene.words(Words::new("1.5", (2.0, 4.0), 1.0, Colour::BLACK));
        assert_eq!(scene.characters((8, 8), false, &[], &[]).lines().nth(3), Some(" y1.5"));
    }
}
