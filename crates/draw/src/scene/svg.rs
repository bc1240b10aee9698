//! Scenes as SVG: words stay words, numbers are short.

use super::words::{Anchor, INDEX_DROP, INDEX_SIZE, runs};
use super::{Colour, Item, Point, Scene, Segment, Stroke, Words};
use std::fmt::Write;

/// Fonts in order of preference; the first is also the one that is measured.
const FONTS: &str = "DejaVu Sans, Verdana, Arial, Helvetica, sans-serif";

impl Scene {
    /// The scene as an SVG document that scales with the page. Its identifiers begin with `name`: a page has one set
    /// of them.
    pub fn svg(&self, name: &str) -> String {
        let (w, h) = (number(self.width), number(self.height));
        let mut out = format!(
            "<svg viewBox=\"0 0 {w} {h}\" xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" \
             font-family=\"{FONTS}\"><rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>"
        );
        let mut writer = Writer { out: &mut out, name, clips: 0 };
        writer.items(&self.items);
        out.push_str("</svg>\n");
        out
    }
}

struct Writer<'a> {
    out: &'a mut String,
    name: &'a str,
    clips: usize,
}

impl Writer<'_> {
    fn items(&mut self, items: &[Item]) {
        for item in items {
            self.item(item);
        }
    }

    fn item(&mut self, item: &Item) {
        match item {
            Item::Path { segments, fill, stroke } => {
                let _ = write!(self.out, "<path d=\"{}\"", data(segments));
                self.paint(*fill, stroke.as_ref());
            }
            Item::Circle { centre, radius, fill, stroke } => {
                let (x, y, r) = (number(centre.0), number(centre.1), number(*radius));
                let _ = write!(self.out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"");
                self.paint(*fill, stroke.as_ref());
            }
            Item::Words(words) => self.words(words),
            Item::Sign { items, .. } | Item::Legend { items, .. } => self.items(items),
            Item::Group { offset, clip, items } => {
                let mut attributes = String::new();
                if *offset != (0.0, 0.0) {
                    attributes = format!(" transform=\"translate({} {})\"", number(offset.0), number(offset.1));
                }
                if let Some(clip) = clip {
                    let id = format!("{}-clip-{}", self.name, self.clips);
                    self.clips += 1;
                    let _ =
                        write!(self.out, "<clipPath id=\"{id}\"><path d=\"{}\"/></clipPath>", data(&clip.outline()));
                    let _ = write!(attributes, " clip-path=\"url(#{id})\"");
                }
                let _ = write!(self.out, "<g{attributes}>");
                self.items(items);
                self.out.push_str("</g>");
            }
        }
    }

    /// The end of an element: its colours.
    fn paint(&mut self, fill: Option<Colour>, stroke: Option<&Stroke>) {
        match fill {
            Some(colour) => {
                let _ = write!(self.out, " fill=\"{colour}\"");
            }
            None => self.out.push_str(" fill=\"none\""),
        }
        if let Some(stroke) = stroke {
            let _ = write!(self.out, " stroke=\"{}\"", stroke.colour);
            if stroke.width != 1.0 {
                let _ = write!(self.out, " stroke-width=\"{}\"", number(stroke.width));
            }
            if !stroke.dashes.is_empty() {
                let dashes: Vec<String> = stroke.dashes.iter().map(|d| number(*d)).collect();
                let _ = write!(self.out, " stroke-dasharray=\"{}\"", dashes.join(" "));
            }
        }
        self.out.push_str("/>");
    }

    fn words(&mut self, words: &Words) {
        let (x, y) = (number(words.at.0), number(words.at.1));
        let _ = write!(self.out, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"", number(words.size));
        match words.anchor {
            Anchor::Start => {}
            Anchor::Middle => self.out.push_str(" text-anchor=\"middle\""),
            Anchor::End => self.out.push_str(" text-anchor=\"end\""),
        }
        if words.turned {
            let _ = write!(self.out, " transform=\"rotate(-90 {x} {y})\"");
        }
        if let Some(halo) = words.halo {
            let _ = write!(self.out, " stroke=\"{halo}\" stroke-width=\"3\" paint-order=\"stroke\"");
        }
        let _ = write!(self.out, " fill=\"{}\">", words.colour);
        let mut lowered = false;
        for run in runs(&words.text) {
            let text = escaped(run.text);
            // A shift holds for all that follows in the line, so it is taken back by the next run.
            let _ = match (run.lowered, lowered) {
                (true, _) => {
                    let drop = number(INDEX_DROP * words.size);
                    let size = number(INDEX_SIZE * words.size);
                    write!(self.out, "<tspan dy=\"{drop}\" font-size=\"{size}\">{text}</tspan>")
                }
                (false, true) => {
                    write!(self.out, "<tspan dy=\"{}\">{text}</tspan>", number(-INDEX_DROP * words.size))
                }
                (false, false) => write!(self.out, "{text}"),
            };
            lowered = run.lowered;
        }
        self.out.push_str("</text>");
    }
}

/// A path's `d`, with two decimals at most, which no screen and no printer shows more of.
fn data(segments: &[Segment]) -> String {
    let mut d = String::with_capacity(segments.len() * 12);
    // A letter holds until another comes.
    let mut letter = ' ';
    for segment in segments {
        let (next, points): (char, &[Point]) = match segment {
            Segment::Move(p) => ('M', &[*p]),
            Segment::Line(p) => ('L', &[*p]),
            Segment::Cubic(a, b, p) => ('C', &[*a, *b, *p]),
            Segment::Close => ('Z', &[]),
        };
        if next != letter || next == 'M' {
            d.push(next);
        } else {
            d.push(' ');
        }
        letter = next;
        for (k, p) in points.iter().enumerate() {
            let _ = write!(d, "{}{} {}", if k > 0 { " " } else { "" }, number(p.0), number(p.1));
        }
    }
    d
}

/// At most two decimals.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::super::Rectangle;
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [number(40.300_000_000_4), number(-7.99999), number(-0.001), number(300.0)],
            ["40.3", "-8", "0", "300"]
        );
    }

    #[test]
    fn indices_stand_below_and_what_follows_stands_up_again() {
        let mut scene = Scene::new(10.0, 10.0);
        scene.words(Words::new("K_pwm < 3", (1.0, 2.0), 10.0, Colour::BLACK));
        let svg = scene.svg("f");
        let line = "fill=\"#000000\">K<tspan dy=\"2.2\" font-size=\"7.5\">pwm</tspan><tspan dy=\"-2.2\"> &lt; 3</tspan></text>";
        assert!(svg.contains(line), "{svg}");
    }

    #[test]
    fn clips_have_names_of_their_figure() {
        let mut scene = Scene::new(10.0, 10.0);
        let clip = Rectangle { left: 0.0, top: 0.0, width: 5.0, height: 5.0 };
        for _ in 0..2 {
            scene.clipped(clip, |s| s.circle((5.0, 5.0), 3.0, Some(Colour::BLACK), None));
        }
        let svg = scene.svg("fig-3");
        assert!(svg.contains("id=\"fig-3-clip-1\"") && svg.contains("url(#fig-3-clip-1)"), "{svg}");
    }
}
